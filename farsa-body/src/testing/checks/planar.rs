//! Checks for planar worlds.

use alloc::{format, string::String, vec::Vec};

use farsa_num::{Domain, Scalar, Stream, sin_cos};

use crate::ports::{Lamp, NearbySurface, Planar, Sight};
use crate::testing::promise::{ConformanceError, Promise, ensure};

/// Number of directions looked in from every place.
const LOOKS: usize = 256;

/// The tolerance between two ways to the same point [m].
const CLOSE: f32 = 1e-4;

/// Checks the port [`Sight`](crate::ports::Sight) at the given positions (in meters) with a range of `range` (in
/// meters).
///
/// Nearby surfaces must be within the range and have the distance of their point. They must also be reported for twice
/// the range. The first surface in a random direction must be the nearest object, must be reported as nearby, and must
/// disappear if its body is ignored. A nearby round body must be visible unless something is in front of it. Colors and
/// signals must be in [0, 1].
///
/// The argument `bodies` must contain all bodies of the world. The positions must not be inside a wall. At least one
/// surface must be nearby, and at least one must be in sight.
///
/// # Errors
/// Returns [`Promise::Near`], [`Promise::Look`] or [`Promise::Shown`] with a description of the problem.
pub fn check_sight<W>(world: &W, bodies: &[W::Body], places: &[[f32; 2]], range: f32) -> Result<(), ConformanceError>
where
    W: Sight,
    W::Body: PartialEq,
{
    let mut stream = Stream::new(0, Domain::Sensor, 0, 0, 0);
    let (mut met, mut seen) = (0, 0);
    for &from in places {
        let near = surfaces(world, from, range);
        met += near.len();
        check_near(world, bodies, from, range, &near)?;
        for _ in 0..LOOKS {
            let (s, c) = sin_cos(stream.range(-core::f32::consts::PI, core::f32::consts::PI));
            seen += usize::from(check_look(world, bodies, from, [c, s], range, &near)?);
        }
    }
    ensure(met > 0, Promise::Near, || format!("nothing within {range} m of any of {} places", places.len()))?;
    ensure(seen > 0, Promise::Look, || format!("nothing in sight from any of {} places", places.len()))
}

/// Checks the port [`Planar`](crate::ports::Planar). This includes all checks of [`check_sight`] as well as the ground
/// and the lamps.
///
/// # Errors
/// Returns the same errors as [`check_sight`].
pub fn check_planar<W>(world: &W, bodies: &[W::Body], places: &[[f32; 2]], range: f32) -> Result<(), ConformanceError>
where
    W: Planar,
    W::Body: PartialEq,
{
    for &from in places {
        shown(&world.ground(from), || format!("the ground at {from:?}"))?;
    }
    check_sight(world, bodies, places, range)?;
    let mut lamps: Vec<Lamp<W::Body>> = Vec::new();
    world.lamps(&mut |lamp| lamps.push(lamp));
    for (index, lamp) in lamps.iter().enumerate() {
        let holds = bodies.contains(&lamp.body)
            && lamp.position.iter().all(|x| x.is_finite())
            && lamp.intensity.is_finite()
            && lamp.intensity >= 0.0;
        ensure(holds, Promise::Shown, || {
            format!("lamp {index} at {:?}, intensity {}, or of no body", lamp.position, lamp.intensity)
        })?;
    }
    Ok(())
}

fn surfaces<W: Sight>(world: &W, from: [f32; 2], range: f32) -> Vec<NearbySurface<W::Body>> {
    let mut surfaces = Vec::new();
    world.query_near(from, range, &mut |near| surfaces.push(near));
    surfaces
}

fn shown(values: &[f32], what: impl Fn() -> String) -> Result<(), ConformanceError> {
    let holds = values.iter().all(|x| (0.0..=1.0).contains(x));
    ensure(holds, Promise::Shown, || format!("{} shows {values:?}", what()))
}

fn check_near<W>(
    world: &W,
    bodies: &[W::Body],
    from: [f32; 2],
    range: f32,
    all: &[NearbySurface<W::Body>],
) -> Result<(), ConformanceError>
where
    W: Sight,
    W::Body: PartialEq,
{
    let farther = surfaces(world, from, 2.0 * range);
    for (index, near) in all.iter().enumerate() {
        let what = || format!("surface {index} near {from:?} at {:?}", near.point);
        let broken = |why: &str| format!("{}: {why}", what());
        let way = [near.point[0] - from[0], near.point[1] - from[1]];
        let apart = Scalar::sqrt(way[0] * way[0] + way[1] * way[1]);
        let distance = near.distance;
        ensure(distance <= range, Promise::Near, || broken(&format!("{distance} of {range}")))?;
        ensure((apart - distance.abs()).abs() < CLOSE, Promise::Near, || {
            broken(&format!("reported at {distance}, is at {apart}"))
        })?;
        ensure(near.radius.is_finite() && near.radius >= 0.0, Promise::Near, || {
            broken(&format!("a radius of {}", near.radius))
        })?;
        let holds = match &near.body {
            Some(body) => bodies.contains(body) && distance >= -near.radius - CLOSE,
            None => near.radius == 0.0 && near.signal.is_none() && distance >= 0.0,
        };
        ensure(holds, Promise::Near, || broken("a wall with a radius or a signal, or no body of the world"))?;
        shown(&near.color, what)?;
        shown(near.signal.as_slice(), what)?;
        ensure(farther.contains(near), Promise::Near, || broken("not reported within twice the range"))?;
        // A wall may be looked at along its edge. A round body cannot be missed in its middle.
        if near.radius > 0.0 && distance > CLOSE {
            let sight = world.cast_planar(from, way.map(|x| x / apart), 2.0 * range, None);
            ensure(sight.is_some_and(|sight| sight.distance <= distance + CLOSE), Promise::Look, || {
                broken("not in sight, nor hidden")
            })?;
        }
    }
    Ok(())
}

/// Returns whether something was seen.
fn check_look<W>(
    world: &W,
    bodies: &[W::Body],
    from: [f32; 2],
    direction: [f32; 2],
    range: f32,
    near: &[NearbySurface<W::Body>],
) -> Result<bool, ConformanceError>
where
    W: Sight,
    W::Body: PartialEq,
{
    let look = |range| world.cast_planar(from, direction, range, None);
    let Some(sight) = look(range) else { return Ok(false) };
    let what = || format!("look from {from:?} along {direction:?}");
    let (distance, body) = (sight.distance, sight.body);
    ensure((0.0..=range).contains(&distance), Promise::Look, || format!("{}: {distance} of {range}", what()))?;
    let listed = body.as_ref().is_none_or(|body| bodies.contains(body));
    ensure(listed, Promise::Look, || format!("{}: a body that does not exist", what()))?;
    shown(&sight.color, what)?;
    let same = |range| look(range).is_some_and(|s| s.distance == distance && s.body == body);
    ensure(same(range) && same(2.0 * range), Promise::Look, || format!("{}: not seen again", what()))?;
    let short = 0.99 * distance;
    ensure(short < 1e-3 || look(short).is_none(), Promise::Look, || {
        format!("{}: seen at {distance} and within {short}", what())
    })?;
    let same_surface = |near: &NearbySurface<W::Body>| {
        near.body == body && near.distance <= distance + CLOSE && near.color == sight.color
    };
    ensure(near.iter().any(same_surface), Promise::Near, || {
        format!("{}: seen at {distance}, but not reported", what())
    })?;
    if body.is_some() {
        let behind = world.cast_planar(from, direction, range, body);
        let other = behind.is_none_or(|behind| behind.body != body && behind.distance >= distance);
        ensure(other, Promise::Look, || format!("{}: not blind to the body asked for", what()))?;
    }
    Ok(true)
}
