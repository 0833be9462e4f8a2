//! Every adapter over mocked pins and buses, and what happens when they fail.

use std::cell::Cell;

use embedded_hal::i2c::ErrorKind as I2cError;
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as PinTransaction};
use embedded_hal_mock::eh1::i2c::{Mock as Bus, Transaction as BusTransaction};
use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as PwmTransaction};
use farsa_body::ports::{Channels, Motor, Sensor};
use firmware_adapters::{
    Converter, Converters, CurveError, Fault, Guard, GuardError, Period, Pulses, Registers, Switches,
};

/// The calls of the mock for reading the largest duty and for setting one.
fn sets(duty: u16) -> [PwmTransaction; 3] {
    let most = || PwmTransaction::max_duty_cycle(20_000);
    [most(), most(), PwmTransaction::set_duty_cycle(duty)]
}

#[test]
fn pulses_are_as_wide_as_values_say() {
    // The pulses of a model's servo: 1 ms to 2 ms of 20 ms.
    let expected: Vec<_> = [1000, 1500, 2000, 2000, 1000, 1000].into_iter().flat_map(sets).collect();
    let mut servo = Pulses::new([Pwm::new(&expected)], 0.05, 0.1);
    for y in [0.0, 0.5, 1.0, 7.0, -1.0, f32::NAN] {
        servo.drive(&[y], &mut ());
        assert_eq!(servo.check(), Ok(()));
    }
    servo.into_pins()[0].done();
}

#[test]
fn a_pulse_that_fails_is_told_once() {
    let most = || PwmTransaction::max_duty_cycle(100);
    let broken = PwmTransaction::set_duty_cycle(50).with_error(MockError::Io(std::io::ErrorKind::Other));
    let mut stage = Pulses::new([Pwm::new(&[most(), most(), broken])], 0.0, 1.0);
    stage.drive(&[0.5], &mut ());
    assert_eq!([stage.check(), stage.check()], [Err(Fault::Write), Ok(())]);
    stage.into_pins()[0].done();
}

/// A converter with these counts. `None` fails.
struct Counts<'a>(&'a Cell<[Option<u16>; 2]>);

impl Converter for Counts<'_> {
    type Error = ();

    fn count(&mut self, sensor: usize) -> Result<u16, ()> {
        self.0.get()[sensor].ok_or(())
    }
}

/// In proportion, and measured: nothing below 100, much at 300, all at 400.
const CURVES: [&[[f32; 2]]; 2] = [&[[0.0, 0.0], [4095.0, 1.0]], &[[100.0, 0.0], [300.0, 0.5], [400.0, 1.0]]];

#[test]
fn counts_are_read_by_their_curves() {
    for (counts, expected) in [
        ([0, 0], [0.0, 0.0]),
        ([4095, 100], [1.0, 0.0]),
        ([819, 200], [0.2, 0.25]),
        ([4096, 300], [1.0, 0.5]),
        ([u16::MAX, 325], [1.0, 0.625]),
        ([1, 400], [1.0 / 4095.0, 1.0]),
        ([1, 401], [1.0 / 4095.0, 1.0]),
    ] {
        let cell = Cell::new(counts.map(Some));
        let mut sensors = Converters::new(Counts(&cell), CURVES).unwrap();
        let mut x = [f32::NAN; 2];
        sensors.read(&(), &mut x);
        assert_eq!((x, sensors.check(), sensors.channels()), (expected, Ok(()), 2), "{counts:?}");
    }
}

#[test]
fn a_conversion_that_fails_leaves_what_was_read_last() {
    let counts = Cell::new([None, Some(300)]);
    let (mut sensors, mut x) = (Converters::new(Counts(&counts), CURVES).unwrap(), [f32::NAN; 2]);
    for (now, read, found) in [
        ([None, Some(300)], [0.0, 0.5], Err(Fault::Read)),
        ([Some(819), None], [0.2, 0.5], Err(Fault::Read)),
        ([None, None], [0.2, 0.5], Err(Fault::Read)),
        ([Some(0), Some(200)], [0.0, 0.25], Ok(())),
    ] {
        counts.set(now);
        sensors.read(&(), &mut x);
        // Reported once.
        assert_eq!((x, sensors.check(), sensors.check()), (read, found, Ok(())), "{now:?}");
    }
}

#[test]
fn curves_that_are_none_are_refused() {
    let curves: [(&'static [[f32; 2]], CurveError); 4] = [
        (&[], CurveError::Empty { sensor: 1 }),
        (&[[0.0, 0.0], [0.0, 1.0]], CurveError::Point { sensor: 1, point: 1 }),
        (&[[0.0, f32::NAN]], CurveError::Point { sensor: 1, point: 0 }),
        (&[[0.0, 0.0], [f32::INFINITY, 1.0]], CurveError::Point { sensor: 1, point: 1 }),
    ];
    for (curve, error) in curves {
        assert_eq!(Converters::new(Counts(&Cell::default()), [CURVES[0], curve]).err(), Some(error));
        assert!(error.to_string().starts_with("sensor 1: "), "{error}");
    }
}

#[test]
fn switches_have_two_thresholds() {
    let states = [State::Low, State::High, State::High, State::Low, State::Low, State::High, State::Low];
    let expected: Vec<_> = states.into_iter().map(PinTransaction::set).collect();
    let mut valve = Switches::new([Pin::new(&expected)], 0.4, 0.6);
    for y in [0.5, 0.7, 0.5, 0.3, 0.5, 0.9, f32::NAN] {
        valve.drive(&[y], &mut ());
    }
    assert_eq!(valve.check(), Ok(()));
    valve.into_pins()[0].done();
}

#[test]
fn registers_are_scaled_and_kept_when_the_device_is_silent() {
    let read = || BusTransaction::write_read(0x68, vec![0x3B], vec![0x40, 0x00, 0xFF, 0xFE]);
    let silent = read().with_error(I2cError::NoAcknowledge(embedded_hal::i2c::NoAcknowledgeSource::Address));
    let mut sensor =
        Registers::new(Bus::new(&[silent.clone(), read(), silent]), 0x68, 0x3B, [[0.0, 1.0 / 16384.0], [1.0, 0.5]]);
    assert_eq!(sensor.channels(), 2);
    let mut x = [9.0; 2];
    for (fault, values) in [(Err(Fault::Read), [0.0, 0.0]), (Ok(()), [1.0, 0.0]), (Err(Fault::Read), [1.0, 0.0])] {
        sensor.read(&(), &mut x);
        assert_eq!((sensor.check(), x), (fault, values));
    }
    assert_eq!(sensor.check(), Ok(()));
    sensor.into_bus().done();
}

#[test]
fn a_guard_limits_and_stops() {
    let mut guard = Guard::new([[0.0, 1.0], [-1.0, 1.0]], [0.25, f32::INFINITY], [0.5, 0.0]).expect("a guard");
    for (y, tick, expected) in [
        ([1.0, 1.0], Ok(()), [0.75, 1.0]),
        ([1.0, -9.0], Ok(()), [1.0, -1.0]),
        ([9.0, 0.3], Ok(()), [1.0, 0.3]),
        ([1.0, 1.0], Err(Fault::Late { by: 3 }), [0.5, 0.0]),
        ([1.0, f32::NAN], Ok(()), [0.75, 0.0]),
        ([f32::NEG_INFINITY, f32::INFINITY], Ok(()), [0.5, 1.0]),
    ] {
        assert_eq!(guard.pass(y, tick), expected);
    }
    let refused = |range, change, safe| Guard::new([range], [change], [safe]).expect_err("refused");
    assert_eq!(refused([1.0, 0.0], 1.0, 0.0), GuardError::Range { motor: 0, range: [1.0, 0.0] });
    assert!(matches!(refused([0.0, f32::NAN], 1.0, 0.0), GuardError::Range { .. }));
    assert_eq!(refused([0.0, 1.0], 0.0, 0.0), GuardError::Change { motor: 0, change: 0.0 });
    assert_eq!(refused([0.0, 1.0], 1.0, 2.0), GuardError::Safe { motor: 0, safe: 2.0 });
}

#[test]
fn a_period_that_is_missed_is_a_fault() {
    let mut period = Period::new(10_000, 500);
    let begin = u32::MAX - 5_000;
    for (now, expected) in [
        (0, Ok(())),
        (10_000, Ok(())),
        (20_500, Ok(())),
        (31_001, Err(Fault::Late { by: 501 })),
        (41_001, Ok(())),
        (45_000, Ok(())),
    ] {
        assert_eq!(period.tick(begin.wrapping_add(now)), expected, "{now} us");
    }
}
