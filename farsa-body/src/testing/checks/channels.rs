//! Checks for sensors and motors.

use alloc::{format, vec, vec::Vec};

use crate::ports::{Actuated, Motor, Sensor, Snapshot};
use crate::testing::promise::{ConformanceError, Promise, ensure};
use crate::testing::trace::saved;

/// Number of values laid out beyond the channels, to see whether they are touched.
const BEYOND: usize = 3;

/// Checks a sensor in the current state of a world.
///
/// The sensor must write finite values to all of its channels and must not write beyond them. If the slice is too
/// short, it must write the first channels. After a reset, it must read identical bits. This also applies to noisy
/// sensors, because a reset rewinds the noise.
///
/// # Errors
/// Returns the first promise violated.
pub fn check_sensor<W, S>(sensor: &mut S, world: &W) -> Result<(), ConformanceError>
where
    W: ?Sized,
    S: Sensor<W> + ?Sized,
{
    let channels = sensor.channels();
    let mut read = |background: f32, length: usize| -> Vec<u32> {
        let mut out = vec![background; length];
        sensor.reset();
        sensor.read(world, &mut out);
        out.into_iter().map(f32::to_bits).collect()
    };
    // A value that keeps both backgrounds was not written.
    let backgrounds = [-12_345.5_f32, 0.062_5];
    let [a, b] = backgrounds.map(|background| read(background, channels + BEYOND));
    for (beyond, background) in [&a, &b].into_iter().zip(backgrounds) {
        let touched = beyond[channels..].iter().position(|&x| x != background.to_bits());
        ensure(touched.is_none(), Promise::Bounds, || {
            format!("value {} of {channels} is touched", channels + touched.unwrap_or_default())
        })?;
    }
    for channel in 0..channels {
        let unchanged = a[channel] == backgrounds[0].to_bits() && b[channel] == backgrounds[1].to_bits();
        ensure(!unchanged, Promise::SensorFills, || format!("channel {channel} of {channels} is not written"))?;
        let [x, y] = [&a, &b].map(|values| f32::from_bits(values[channel]));
        ensure(x.is_finite(), Promise::SensorFinite, || format!("channel {channel} reads {x}"))?;
        ensure(x.to_bits() == y.to_bits(), Promise::Repeats, || format!("channel {channel} reads {x:e}, then {y:e}"))?;
    }
    for length in 0..channels {
        let short = read(backgrounds[0], length);
        let other = short.iter().zip(&a).position(|(x, y)| x != y);
        ensure(other.is_none(), Promise::ShortSlice, || {
            format!("channel {} differs in a slice of {length}", other.unwrap_or_default())
        })?;
    }
    ensure(sensor.channels() == channels, Promise::Channels, || format!("{channels}, then {}", sensor.channels()))
}

/// Checks a motor. The closure `make` must always create the same world.
///
/// After a reset, equal values must lead to equal commands. Values beyond the channels are ignored, and an empty slice
/// does not change any command. Commands must be finite for all values, including NaN and infinity. The commands are
/// observed through snapshots of the world.
///
/// # Errors
/// Returns the first promise violated.
pub fn check_motor<W, M>(motor: &mut M, make: impl Fn() -> W) -> Result<(), ConformanceError>
where
    W: Actuated + Snapshot,
    M: Motor<W> + ?Sized,
{
    let channels = motor.channels();
    let idle = saved(&make());
    let mut drive = |y: &[f32]| -> Vec<u32> {
        let mut world = make();
        motor.reset();
        motor.drive(y, &mut world);
        saved(&world).into_iter().map(f32::to_bits).collect()
    };
    let nothing = drive(&[]);
    let bits = |words: &[f32]| words.iter().copied().map(f32::to_bits).collect::<Vec<_>>();
    ensure(nothing == bits(&idle), Promise::ShortSlice, || "an empty slice commands something".into())?;

    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, -0.5, 1.5, -0.0, f32::MIN_POSITIVE];
    let values = [0.0, 0.25, 0.5, 1.0].into_iter().chain(odd);
    let rows = values.map(|x| vec![x; channels]);
    // Every channel differs from its neighbor, by ordinary values and by odd ones.
    let mixed = [&[0.125, 0.75, 0.375][..], &odd[..]].map(|some| some.iter().copied().cycle().take(channels).collect());
    for mut y in rows.chain(mixed) {
        let commanded = drive(&y);
        ensure(commanded == drive(&y), Promise::Repeats, || format!("other commands the second time, for {y:?}"))?;
        for length in 0..=channels {
            let words = drive(&y[..length]);
            let words = words.iter().zip(&idle).filter(|(a, b)| **a != b.to_bits());
            let mut changed = words.map(|(a, _)| f32::from_bits(*a));
            ensure(changed.all(f32::is_finite), Promise::MotorFinite, || {
                format!("a command that is not finite, for {:?}", &y[..length])
            })?;
        }
        y.extend([f32::NAN; BEYOND]);
        ensure(commanded == drive(&y), Promise::Bounds, || format!("{channels} channels, but {y:?} differs"))?;
    }
    ensure(motor.channels() == channels, Promise::Channels, || format!("{channels}, then {}", motor.channels()))
}
