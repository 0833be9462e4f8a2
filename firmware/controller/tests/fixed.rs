//! The expected results of boards in integers, and their difference from the results in floats.

use farsa_nn::bytes::{Aligned, BytesError, Field, QuantizedNetworkBytes};
use farsa_nn::quantized::QuantizedScale;
use farsa_num::{Digest, Domain, Stream};
use firmware_controller::{
    Analog, Board, CHANNELS, Control, FixedRobot, INPUT_BITS, LAYOUT, LEAK, Robot, champion, fixed_champion,
    noise_into, self_test,
};

fn golden(name: &str) -> &'static str {
    let lines = include_str!("../../golden.txt").lines();
    lines.filter_map(|line| line.strip_prefix(name)?.strip_prefix(' ')).next().expect("the line")
}

fn fixed() -> FixedRobot {
    FixedRobot::new().expect("the champion in integers")
}

#[test]
fn the_self_test_has_its_hash() {
    assert_eq!(format!("100000 {:016x}", self_test(&mut fixed(), 100_000)), golden("hash-fixed"));
}

/// The largest difference of a motor value to that of the network in floats over the steps of the self-test, and the root mean
/// square.
#[test]
fn motor_values_are_as_far_from_those_in_floats_as_is_written() {
    let (mut robot, mut integers) = (Robot::new().expect("the champion"), fixed());
    let mut inputs = Stream::new(2010, Domain::Network, 0, 0, 0);
    let (mut largest, mut squares, mut count) = (0.0_f64, 0.0, 0);
    for _ in 0..100_000 {
        let x: [i16; LAYOUT.sensors()] = core::array::from_fn(|_| FixedRobot::random(&mut inputs));
        // The inputs are the same, so the difference comes from weights, sums and activations.
        let y = robot.step(&x.map(|x| f32::from(x) / 512.0));
        for (y, fixed) in y.iter().zip(integers.step(&x)) {
            let difference = (f64::from(*y) - f64::from(QuantizedScale::output(*fixed))).abs();
            largest = largest.max(difference);
            squares += difference * difference;
            count += 1;
        }
    }
    let mean = (squares / f64::from(count)).sqrt();
    assert_eq!(format!("{largest:.2e} {mean:.2e}"), golden("difference-fixed"));
}

#[test]
fn a_loop_drives_what_the_loop_in_floats_drives() {
    let (mut robot, mut integers) = (Robot::new().expect("the champion"), fixed());
    let (mut board, mut other) = (Board::new(), Board::new());
    let (mut noise, mut driven, mut largest) = (Stream::new(1, Domain::Sensor, 0, 0, 0), Digest::new(), 0);
    for _ in 0..1000 {
        noise_into(&mut board, &mut noise);
        other.readings = board.readings;
        robot.tick(&mut board);
        integers.tick(&mut other);
        let differences = board.widths.iter().zip(&other.widths).map(|(a, b)| a.abs_diff(*b));
        largest = differences.fold(largest, u16::max);
        // As on boards, which count instructions between.
        integers.step(&[FixedRobot::HALF; LAYOUT.sensors()]);
        robot.step(&[Robot::HALF; LAYOUT.sensors()]);
        other.widths.iter().for_each(|width| driven.add_bytes(&width.to_le_bytes()));
    }
    assert_eq!(format!("{:016x}", driven.finish()), golden("driven-fixed"));
    assert_eq!(format!("{largest}"), golden("widths-fixed"));
}

#[test]
fn every_count_is_the_nearest_sensor_value() {
    let (mut robot, mut integers) = (Robot::new().expect("the champion"), fixed());
    for count in 0..=Analog::TOP + 1 {
        let mut board = Board { readings: [count; LAYOUT.sensors()], ..Board::new() };
        robot.tick(&mut board);
        integers.tick(&mut board);
        for (x, fixed) in robot.sensed().iter().zip(integers.sensed()) {
            let off = (f64::from(*x) * 512.0 - f64::from(*fixed)).abs();
            assert!(off < 0.54, "{count} is {x}, in integers {fixed}: {off} units off");
        }
    }
}

#[test]
fn the_bytes_are_the_champion_quantised() {
    let read = QuantizedNetworkBytes::read(fixed_champion()).expect("a network");
    read.expect(LAYOUT, LEAK, INPUT_BITS).expect("the layout");
    let mut quantised = [0; LAYOUT.parameter_count()];
    let scale = QuantizedScale::quantize(&LAYOUT, INPUT_BITS, champion().expect("the champion"), &mut quantised);
    assert_eq!((Ok(read.scale()), read.parameters()), (scale, Ok(&quantised[..])));
}

/// Another network over a wire: it must be intact and fit, or nothing changes.
#[test]
fn another_network_runs_only_if_its_bytes_are_right() {
    let weights = [0.25; LAYOUT.parameter_count()];
    let mut quantised = [0; LAYOUT.parameter_count()];
    let written = |channels, input_bits, quantised: &mut [i16]| {
        let mut bytes = Aligned([0; QuantizedNetworkBytes::byte_count(LAYOUT)]);
        let scale = QuantizedScale::quantize(&LAYOUT, input_bits, &weights, quantised).expect("fits");
        QuantizedNetworkBytes::write(LAYOUT, LEAK, scale, channels, quantised, &mut bytes.0).expect("valid");
        bytes
    };
    let mut damaged = written(CHANNELS, INPUT_BITS, &mut quantised);
    damaged.0[1000] ^= 4;
    let foreign = [damaged, written(CHANNELS + 1, INPUT_BITS, &mut quantised), written(CHANNELS, 8, &mut quantised)];
    let mut robot = fixed();
    let errors = foreign.map(|bytes| robot.replace(&Box::leak(Box::new(bytes)).0).expect_err("refused"));
    assert!(matches!(
        errors,
        [
            BytesError::Mismatch { field: Field::Checksum, .. },
            BytesError::Mismatch { field: Field::Channels, .. },
            BytesError::Mismatch { field: Field::Layout, .. }
        ]
    ));
    let before = self_test(&mut robot, 100);
    assert_eq!(before, self_test(&mut fixed(), 100));
    robot.replace(&Box::leak(Box::new(written(CHANNELS, INPUT_BITS, &mut quantised))).0).expect("another network");
    assert_ne!(self_test(&mut robot, 100), before);
    robot.replace(fixed_champion()).expect("the champion");
    assert_eq!(self_test(&mut robot, 100), before);
}
