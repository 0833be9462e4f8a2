//! Checks for worlds with cameras.

use alloc::{format, vec, vec::Vec};

use farsa_num::{Domain, Stream};

use crate::ports::{Seen, Vision};
use crate::testing::checks::rays::direction;
use crate::testing::promise::{ConformanceError, Promise, ensure};

/// Number of rays of an eye.
const RAYS: usize = 256;

/// Checks the port [`Vision`](crate::ports::Vision) with many rays in random directions. They start at each of the
/// given origins and have a length of `range` (in meters).
///
/// A hit must be within the range, belong to a body of the world and have a color in [0, 1]. A single ray must produce
/// the same hit, also for twice the range. It must not produce it if the range is shorter than the distance or if the
/// body is ignored. Rays beyond the end of the shorter slice have no result.
///
/// The argument `bodies` must contain all bodies of the world. At least one ray must hit a body.
///
/// # Errors
/// Returns [`Promise::Vision`] with a description of the problem.
pub fn check_vision<W>(world: &W, bodies: &[W::Body], origins: &[[f32; 3]], range: f32) -> Result<(), ConformanceError>
where
    W: Vision,
    W::Body: PartialEq,
{
    let mut stream = Stream::new(0, Domain::Sensor, 0, 0, 0);
    let mut met = 0;
    for &from in origins {
        let directions: Vec<[f32; 3]> = (0..RAYS).map(|_| direction(&mut stream)).collect();
        // The result of an earlier look must not survive.
        let stale = Seen { distance: 0.0, body: None, color: Some([0.5; 3]) };
        let mut seen = vec![Some(stale); RAYS + 1];
        world.look(from, &directions, range, None, &mut seen);
        let beyond = seen.pop().flatten();
        ensure(beyond == Some(stale), Promise::Vision, || format!("from {from:?}: a ray that was not asked for"))?;
        for (direction, seen) in directions.iter().zip(&seen) {
            met += usize::from(check_ray(world, bodies, from, *direction, range, *seen)?);
        }
    }
    ensure(met > 0, Promise::Vision, || format!("none of {} rays met a body", RAYS * origins.len()))
}

/// Checks a ray. True if it hit a body.
fn check_ray<W>(
    world: &W,
    bodies: &[W::Body],
    from: [f32; 3],
    direction: [f32; 3],
    range: f32,
    seen: Option<Seen<W::Body>>,
) -> Result<bool, ConformanceError>
where
    W: Vision,
    W::Body: PartialEq,
{
    let ray = || format!("ray from {from:?} along {direction:?}");
    let alone = |range: f32, but: Option<W::Body>| {
        let mut one = [None];
        world.look(from, &[direction], range, but, &mut one);
        one[0]
    };
    ensure(alone(range, None) == seen, Promise::Vision, || format!("{}: another surface alone", ray()))?;
    let Some(seen) = seen else { return Ok(false) };
    let distance = seen.distance;
    ensure((0.0..=range).contains(&distance), Promise::Vision, || format!("{}: {distance} of {range}", ray()))?;
    let listed = seen.body.as_ref().is_none_or(|body| bodies.contains(body));
    ensure(listed, Promise::Vision, || format!("{}: a body that does not exist", ray()))?;
    let shades = seen.color.unwrap_or_default();
    ensure(shades.iter().all(|shade| (0.0..=1.0).contains(shade)), Promise::Vision, || {
        format!("{}: colour {shades:?}", ray())
    })?;
    ensure(alone(2.0 * range, None) == Some(seen), Promise::Vision, || format!("{}: not met from afar", ray()))?;
    let short = 0.99 * distance;
    ensure(short < 1e-3 || alone(short, None).is_none(), Promise::Vision, || {
        format!("{}: met at {distance} and within {short}", ray())
    })?;
    if seen.body.is_some() {
        let behind = alone(range, seen.body);
        let other = behind.is_none_or(|other| other.body != seen.body && other.distance >= distance);
        ensure(other, Promise::Vision, || {
            format!("{}: {:?} is seen where it should not be", ray(), behind.map(|b| b.distance))
        })?;
    }
    Ok(seen.body.is_some())
}
