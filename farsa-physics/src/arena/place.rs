//! A search for a free place in a planar world.

use farsa_body::ports::{BodyId, Planar};
use farsa_num::Stream;

use crate::arena::error::ArenaError;

/// Requirements that a free place for a disc has to satisfy. All distances are measured from surface to surface [m].
///
/// Places are drawn uniformly from the region until one is free. Each try takes two draws from the stream.
///
/// ```
/// use farsa_body::ports::Arrange;
/// use farsa_body::robots::MobileRobot;
/// use farsa_body::{Pose, Twist};
/// use farsa_num::{Domain, Stream};
/// use farsa_physics::arena::{Arena, ArenaError, FreePlace, World};
///
/// let mut arena = Arena::walled(0.4, 0.4);
/// let robot = arena.add_robot(MobileRobot::khepera(), [0.2, 0.2], 0.0);
/// let mut world = World::new(&arena)?;
/// let mut stream = Stream::new(1, Domain::Start, 0, 0, 0);
/// let free = FreePlace { walls: 0.01, ..FreePlace::new([[0.0, 0.0], [0.4, 0.4]], 0.035) };
/// let at = free.find(&world, &mut stream)?;
/// world.place_body(world.parts(robot).body, Pose::planar(at, stream.range(-3.14, 3.14)), Twist::default());
/// world.finish_placement();
/// # Ok::<(), ArenaError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreePlace<'a> {
    /// Lowest and highest coordinates of the center of the disc [m].
    pub region: [[f32; 2]; 2],
    /// Radius of the disc [m].
    pub radius: f32,
    /// Minimum distance from every wall [m].
    pub walls: f32,
    /// If this is set, the center must also lie within a circle with this middle and radius [m].
    pub within: Option<([f32; 2], f32)>,
    /// Bodies to keep away from and the minimum distance from each [m]. Note that all other bodies are ignored.
    pub bodies: &'a [(BodyId, f32)],
    /// Maximum number of places to try.
    pub tries: u32,
}

impl<'a> FreePlace<'a> {
    /// Creates requirements for a disc that lies within a region and does not overlap a wall. It makes up to a thousand
    /// tries.
    pub fn new(region: [[f32; 2]; 2], radius: f32) -> Self {
        Self { region, radius, walls: 0.0, within: None, bodies: &[], tries: 1000 }
    }

    /// Sets the bodies that the disc has to keep away from.
    pub fn clear_of(self, bodies: &'a [(BodyId, f32)]) -> Self {
        Self { bodies, ..self }
    }

    /// Searches for a free place and returns its position [m].
    ///
    /// # Errors
    /// Returns [`ArenaError::NoFreePlace`] if none of the tries is free.
    pub fn find<W: Planar<Body = BodyId>>(&self, world: &W, stream: &mut Stream) -> Result<[f32; 2], ArenaError> {
        let [low, high] = self.region;
        let farthest = self.bodies.iter().fold(self.walls, |most, (_, far)| most.max(*far));
        let mut short = f32::INFINITY;
        for _ in 0..self.tries {
            let at = [0, 1].map(|k| stream.range(low[k], high[k]));
            let mut lacks = f32::NEG_INFINITY;
            world.query_near(at, self.radius + farthest.max(0.0), &mut |near| {
                let clearance = match near.body {
                    None => Some(self.walls),
                    Some(body) => self.bodies.iter().find(|(b, _)| *b == body).map(|(_, far)| *far),
                };
                if let Some(clearance) = clearance {
                    lacks = lacks.max(self.radius + clearance - near.distance);
                }
            });
            if lacks > 0.0 {
                short = short.min(lacks);
            } else if self.within.is_none_or(|(centre, far)| distance(at, centre) <= far) {
                return Ok(at);
            }
        }
        Err(ArenaError::NoFreePlace { tries: self.tries, radius: self.radius, short })
    }
}

fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    farsa_num::Scalar::sqrt(x * x + y * y)
}
