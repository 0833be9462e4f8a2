//! Checks for worlds with ray casts.

use alloc::format;

use farsa_num::{Domain, Scalar, Stream};

use crate::ports::Rays;
use crate::testing::promise::{ConformanceError, Promise, ensure};

/// Number of rays cast from every origin.
const RAYS: usize = 256;

/// Checks the port [`Rays`](crate::ports::Rays) with many rays in random directions. They start at each of the given
/// origins and have a length of `range` (in meters).
///
/// The argument `bodies` must contain all bodies of the world. At least one ray must hit something.
///
/// # Errors
/// Returns [`Promise::Ray`] with a description of the problem.
pub fn check_rays<W>(world: &W, bodies: &[W::Body], origins: &[[f32; 3]], range: f32) -> Result<(), ConformanceError>
where
    W: Rays,
    W::Body: PartialEq,
{
    let mut stream = Stream::new(0, Domain::Sensor, 0, 0, 0);
    let mut hits = 0;
    for &origin in origins {
        for _ in 0..RAYS {
            let direction = direction(&mut stream);
            let ray = || format!("ray from {origin:?} along {direction:?}");
            let cast = |range| world.cast(origin, direction, range);
            let Some(hit) = cast(range) else { continue };
            hits += 1;
            let (distance, normal) = (hit.distance, hit.normal);
            ensure((0.0..=range).contains(&distance), Promise::Ray, || format!("{}: {distance} of {range}", ray()))?;
            let listed = hit.body.as_ref().is_none_or(|body| bodies.contains(body));
            ensure(listed, Promise::Ray, || format!("{}: a body that does not exist", ray()))?;
            let length = normal.iter().fold(0.0, |sum, x| sum + x * x);
            let against = (0..3).fold(0.0, |sum, i| sum + normal[i] * direction[i]);
            ensure((length - 1.0).abs() < 1e-3 && against < 1e-3, Promise::Ray, || {
                format!("{}: normal {normal:?} is no outward unit vector", ray())
            })?;
            let same = |range| cast(range).is_some_and(|h| h.distance == distance && h.body == hit.body);
            ensure(same(range) && same(2.0 * range), Promise::Ray, || format!("{}: not met again", ray()))?;
            let short = 0.99 * distance;
            ensure(short < 1e-3 || cast(short).is_none(), Promise::Ray, || {
                format!("{}: met at {distance} and within {short}", ray())
            })?;
        }
    }
    ensure(hits > 0, Promise::Ray, || format!("none of {} rays met anything", RAYS * origins.len()))
}

/// A random unit vector.
pub(super) fn direction(stream: &mut Stream) -> [f32; 3] {
    let v = [stream.normal(), stream.normal(), stream.normal()];
    let length = Scalar::sqrt(v.iter().fold(0.0, |sum, x| sum + x * x));
    if length > 1e-3 { v.map(|x| x / length) } else { [0.0, 0.0, -1.0] }
}
