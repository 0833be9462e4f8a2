//! The effect of wrappers on a sensor's and a motor's values, tick by tick.

use farsa_body::ChannelError;
use farsa_body::ports::{Channels, Motor, Sensor};
use farsa_body::sensors::Signal;
use farsa_body::wrappers::{Delayed, Lesioned, Noise, Noisy, Recorded, Saturated, Scaled, Stuck, StuckAt, Thresholded};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

const N: usize = 3;

/// A motor whose world is the list of all that it was driven with.
struct Log;

impl Channels for Log {
    fn channels(&self) -> usize {
        N
    }
}

impl Motor<Vec<Vec<f32>>> for Log {
    fn drive(&mut self, y: &[f32], world: &mut Vec<Vec<f32>>) {
        world.push(y.to_vec());
    }
}

/// Returns the readings of a wrapped sensor while its signal takes these values, tick by tick.
fn sensed<S: Sensor<()>>(sensor: &mut S, set: impl Fn(&mut S, [f32; N]), ticks: &[[f32; N]]) -> Vec<Vec<f32>> {
    ticks
        .iter()
        .map(|&values| {
            set(sensor, values);
            let mut out = vec![f32::NAN; N + 1];
            sensor.read(&(), &mut out);
            assert!(out.pop().is_some_and(f32::is_nan));
            out
        })
        .collect()
}

/// Returns the values at the motor in a wrapper.
fn driven(mut motor: impl Motor<Vec<Vec<f32>>>, ticks: &[[f32; N]]) -> Vec<Vec<f32>> {
    let mut log = Vec::new();
    for values in ticks {
        motor.drive(values, &mut log);
    }
    log
}

/// Reads a sensor in a wrapper over these ticks. The wrapper is made again.
macro_rules! sensed {
    ($wrapper:expr, $ticks:expr) => {{
        let mut sensor = $wrapper;
        sensed(&mut sensor, |s, values| s.inner_mut().set(values), $ticks)
    }};
}

fn signal() -> Signal<N> {
    Signal::new([0.0; N])
}

fn stream(number: u32) -> Stream {
    Stream::new(7, Domain::Sensor, 0, number, 0)
}

fn ticks() -> impl Strategy<Value = Vec<[f32; N]>> {
    prop::collection::vec(prop::array::uniform3(-100.0f32..100.0), 1..20)
}

proptest! {
    #[test]
    fn scaled_is_affine(ticks in ticks(), gain in -10.0f32..10.0, offset in -10.0f32..10.0) {
        let expected: Vec<Vec<f32>> = ticks.iter().map(|t| t.iter().map(|x| gain * x + offset).collect()).collect();
        prop_assert_eq!(&sensed!(Scaled::new(signal(), gain, offset).unwrap(), &ticks), &expected);
        prop_assert_eq!(&driven(Scaled::new(Log, gain, offset).unwrap(), &ticks), &expected);
    }

    #[test]
    fn saturated_stays_within(ticks in ticks(), low in -50.0f32..0.0, high in 0.0f32..50.0) {
        let expected: Vec<Vec<f32>> = ticks.iter().map(|t| t.iter().map(|x| x.clamp(low, high)).collect()).collect();
        prop_assert_eq!(&sensed!(Saturated::new(signal(), low, high).unwrap(), &ticks), &expected);
        prop_assert_eq!(&driven(Saturated::new(Log, low, high).unwrap(), &ticks), &expected);
        prop_assert_eq!(driven(Saturated::new(Log, low, high).unwrap(), &[[f32::NAN; N]]), [[low; N]]);
        let expected: Vec<[f32; N]> = ticks.iter().map(|tick| tick.map(|x| if x > low { 1.0 } else { 0.0 })).collect();
        prop_assert_eq!(&sensed!(Thresholded::new(signal(), low).unwrap(), &ticks), &expected);
        prop_assert_eq!(&driven(Thresholded::new(Log, low).unwrap(), &ticks), &expected);
        prop_assert_eq!(driven(Thresholded::new(Log, low).unwrap(), &[[f32::NAN; N]]), [[0.0; N]]);
    }

    #[test]
    fn recorded_changes_nothing_and_remembers(ticks in ticks()) {
        prop_assert_eq!(&sensed!(Recorded::new(signal()), &ticks), &driven(Log, &ticks));
        prop_assert_eq!(&driven(Recorded::new(Log), &ticks), &driven(Log, &ticks));
        let mut recorded = Recorded::new(signal());
        prop_assert_eq!(recorded.values(), [0.0; N]);
        for values in ticks {
            recorded.inner_mut().set(values);
            Sensor::read(&mut recorded, &(), &mut [0.0; N]);
            prop_assert_eq!(recorded.values(), values);
        }
        recorded.reset();
        prop_assert_eq!(recorded.values(), [0.0; N]);
    }

    #[test]
    fn lesioned_channels_are_zero_and_the_others_as_they_were(ticks in ticks(), start in 0..N, width in 0..N) {
        let which = start..(start + width).min(N);
        let lesion = |t: &[f32; N]| (0..N).map(|c| if which.contains(&c) { 0.0 } else { t[c] }).collect();
        let expected: Vec<Vec<f32>> = ticks.iter().map(lesion).collect();
        prop_assert_eq!(&sensed!(Lesioned::new(signal(), which.clone()).unwrap(), &ticks), &expected);
        prop_assert_eq!(&driven(Lesioned::new(Log, which.clone()).unwrap(), &ticks), &expected);
    }

    #[test]
    fn stuck_channels_stay_at_a_value_or_at_their_last(ticks in ticks(), after in 0u32..25, value in -1.0f32..1.0) {
        let at = |held: &dyn Fn(usize) -> f32| -> Vec<Vec<f32>> {
            let tick = |(t, x): (usize, &[f32; N])| {
                if t < after as usize { x.to_vec() } else { vec![x[0], held(1), held(2)] }
            };
            ticks.iter().enumerate().map(tick).collect()
        };
        let expected = at(&|_| value);
        prop_assert_eq!(&sensed!(Stuck::new(signal(), 1.., StuckAt::Value(value), after).unwrap(), &ticks), &expected);
        prop_assert_eq!(&driven(Stuck::new(Log, 1.., StuckAt::Value(value), after).unwrap(), &ticks), &expected);
        let last = (after as usize).saturating_sub(1).min(ticks.len() - 1);
        let expected = at(&|c| ticks[last][c]);
        prop_assert_eq!(&sensed!(Stuck::new(signal(), 1.., StuckAt::Last, after).unwrap(), &ticks), &expected);
        prop_assert_eq!(&driven(Stuck::new(Log, 1.., StuckAt::Last, after).unwrap(), &ticks), &expected);
    }

    #[test]
    fn delayed_values_come_later(ticks in ticks(), delay in 0usize..8) {
        let expected: Vec<Vec<f32>> =
            (0..ticks.len()).map(|t| ticks[t.saturating_sub(delay)].to_vec()).collect();
        prop_assert_eq!(&sensed!(Delayed::new(signal(), delay), &ticks), &expected);
        prop_assert_eq!(&sensed!(Delayed::new_in(signal(), delay, [9.0; 8 * N]).unwrap(), &ticks), &expected);
        // A motor waits for its first value.
        let arrived = ticks.len().saturating_sub(delay);
        prop_assert_eq!(&driven(Delayed::new(Log, delay), &ticks), &driven(Log, &ticks[..arrived]));
        // After a reset nothing of the earlier episode comes through.
        let mut sensor = Delayed::new(signal(), delay);
        let set = |s: &mut Delayed<Signal<N>, Vec<f32>>, values| s.inner_mut().set(values);
        sensed(&mut sensor, set, &[[1e6; N]; 3]);
        sensor.reset();
        prop_assert_eq!(&sensed(&mut sensor, set, &ticks), &expected);
    }

    #[test]
    fn uniform_noise_is_bounded_and_of_its_stream(ticks in ticks(), amplitude in 0.0f32..5.0, number in 0u32..100) {
        let noisy = |number| Noisy::new(signal(), Noise::Uniform(amplitude), stream(number)).unwrap();
        let noise = sensed!(noisy(number), &ticks);
        for (noise, x) in noise.iter().zip(&ticks) {
            for (noise, x) in noise.iter().zip(x) {
                prop_assert!((noise - x).abs() <= amplitude + 1e-5 * x.abs());
            }
        }
        prop_assert_eq!(&driven(Noisy::new(Log, Noise::Uniform(amplitude), stream(number)).unwrap(), &ticks), &noise);
        // A reset rewinds, another stream is another noise, and reseeding is like having had that stream.
        let mut sensor = noisy(number);
        let set = |s: &mut Noisy<Signal<N>, Vec<f32>>, values| s.inner_mut().set(values);
        sensed(&mut sensor, set, &ticks);
        sensor.reset();
        prop_assert_eq!(&sensed(&mut sensor, set, &ticks), &noise);
        sensor.reseed(stream(number + 1));
        prop_assert_eq!(&sensed(&mut sensor, set, &ticks), &sensed!(noisy(number + 1), &ticks));
        prop_assert!(amplitude < 1e-3 || sensed!(noisy(number + 1), &ticks) != noise);
    }
}

#[test]
fn normal_noise_has_its_moments() {
    let ticks = vec![[2.0; N]; 20_000];
    let noise = sensed!(Noisy::new(signal(), Noise::Normal(0.5), stream(0)).unwrap(), &ticks);
    let values: Vec<f64> = noise.into_iter().flatten().map(f64::from).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
    // Five standard errors.
    assert!((mean - 2.0).abs() < 5.0 * 0.5 / n.sqrt(), "mean {mean}");
    assert!((variance - 0.25).abs() < 5.0 * 0.25 * (2.0 / n).sqrt(), "variance {variance}");
}

#[test]
fn a_threshold_is_passed_above_it() {
    let ticks = [[0.5, 0.500_1, 0.499_9]];
    assert_eq!(sensed!(Thresholded::new(signal(), 0.5).unwrap(), &ticks), [[0.0, 1.0, 0.0]]);
}

#[test]
fn uniform_noise_fills_its_range_evenly() {
    let ticks = vec![[2.0; N]; 20_000];
    let noise = sensed!(Noisy::new(signal(), Noise::Uniform(0.5), stream(0)).unwrap(), &ticks);
    let mut parts = [0_u32; 10];
    for x in noise.into_iter().flatten() {
        parts[((x - 1.5) * 10.0).clamp(0.0, 9.0) as usize] += 1;
    }
    // A tenth of the values in each tenth of the range, within five standard errors.
    let (each, error) = (6000.0, (60_000.0_f64 * 0.1 * 0.9).sqrt());
    assert!(parts.iter().all(|&count| (f64::from(count) - each).abs() < 5.0 * error), "{parts:?}");
}

#[test]
fn a_channel_can_be_made_to_stick_in_the_middle_of_a_life() {
    let mut sensor = Stuck::new(signal(), 0..1, StuckAt::Last, u32::MAX).unwrap();
    let set = |s: &mut Stuck<Signal<N>, Vec<f32>>, values| s.inner_mut().set(values);
    assert_eq!(sensed(&mut sensor, set, &[[1.0; N], [2.0; N]]), [[1.0; N], [2.0; N]]);
    sensor.stick();
    assert_eq!(sensed(&mut sensor, set, &[[3.0; N], [4.0; N]]), [[2.0, 3.0, 3.0], [2.0, 4.0, 4.0]]);
    sensor.reset();
    assert_eq!(sensed(&mut sensor, set, &[[5.0; N]]), [[5.0; N]]);
}

#[test]
fn wrappers_go_around_wrappers() {
    let inner = Saturated::new(signal(), 0.0, 1.0).unwrap();
    let mut sensor = Delayed::new(Scaled::new(inner, 10.0, 0.0).unwrap(), 1);
    let read = [[0.5, 2.0, -1.0], [0.0; N], [1.0; N]].map(|values| {
        sensor.inner_mut().inner_mut().inner_mut().set(values);
        let mut out = [f32::NAN; N];
        sensor.read(&(), &mut out);
        out
    });
    assert_eq!(read, [[5.0, 10.0, 0.0], [5.0, 10.0, 0.0], [0.0; N]]);
}

#[test]
fn what_cannot_be_built_is_told_in_numbers() {
    assert_eq!(Scaled::new_in(signal(), 1.0, 0.0, [0.0; 2]).err(), Some(ChannelError::Memory { given: 2, needed: 3 }));
    assert_eq!(Delayed::new_in(Log, 4, [0.0; 11]).err(), Some(ChannelError::Memory { given: 11, needed: 12 }));
    assert_eq!(Lesioned::new(Log, 2..5).err(), Some(ChannelError::Selection { start: 2, end: 5, channels: 3 }));
    let error = Lesioned::new(Log, ..=usize::MAX).err().map(|e| e.to_string());
    assert_eq!(error, Some(format!("channels 0..{} of 3", usize::MAX)));
    assert!(matches!(Thresholded::new(Log, f32::NAN), Err(ChannelError::Value { field: "threshold", .. })));
    assert_eq!(Saturated::new(Log, 1.0, 0.0).err(), Some(ChannelError::Range { from: 1.0, to: 0.0 }));
    assert_eq!(
        Noisy::new(Log, Noise::Normal(-1.0), stream(0)).err(),
        Some(ChannelError::Value { field: "noise deviation", value: -1.0 })
    );
    assert!(Scaled::new(Log, f32::NAN, 0.0).is_err());
    assert!(Stuck::new(Log, .., StuckAt::Value(f32::INFINITY), 0).is_err());
    assert!(Stuck::new(Log, 3.., StuckAt::Last, 0).is_ok());
}
