//! Nests as robots of a team sense them: the ground, and what shines.

use farsa_body::sensors::ColorBand;
use farsa_lab::Error;
use farsa_lab::advanced::PlanarWorld;

use crate::team::eyes::{BLUE, RED};

/// The colors in the cameras.
pub(crate) const COLORS: [ColorBand; 2] = [RED, BLUE];

/// Colour of a nest: dark on the white ground.
pub(crate) const NEST: [f64; 3] = [0.45, 0.45, 0.45];
/// The ground is darker than this in a nest.
const DARK: f32 = 0.7;

/// The reading of the ground: 1 on a nest, else 0.
pub(crate) fn on_nest<W: PlanarWorld>(world: &W, [x, y]: [f32; 2]) -> f32 {
    if world.ground([x, y])[0] < DARK { 1.0 } else { 0.0 }
}

/// Refuses a nest of no size, and one that cannot be as far from all walls. Lengths are in meters.
pub(crate) fn check(radius: f64, to_wall: f64, size: f64) -> Result<(), Error> {
    if radius <= 0.0 {
        return Err(Error::setting("nest.radius", "must be more than 0"));
    }
    let room = 0.5 * size;
    if to_wall > room {
        let why = format!("{to_wall} m from all walls of an arena of {size} m: at most {room} m");
        return Err(Error::setting("nest.to_wall", why));
    }
    Ok(())
}
