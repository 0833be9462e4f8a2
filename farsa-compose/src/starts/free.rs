//! Searches of a free place.

use farsa_body::Pose;
use farsa_lab::advanced::PlanarWorld;
use farsa_num::{Scalar, Stream};
use farsa_physics::arena::{ArenaError, FreePlace};

use crate::part::spot::Spot;
use crate::starts::TRIES;

/// A search at least this far from the walls and from everything placed earlier [m].
#[derive(Clone, Debug)]
pub(super) struct Free {
    pub(super) walls: f64,
    pub(super) apart: f64,
}

impl Free {
    /// Draws a place, if there is a disc in it. Obstacles keep their distance from other bodies, and areas from other
    /// areas.
    pub(super) fn find<W: PlanarWorld>(
        &self,
        world: &W,
        disc: Option<([f32; 2], f32)>,
        spot: &mut Spot<'_>,
        stream: &mut Stream,
    ) -> Option<Pose> {
        match self.place(world, disc, spot, stream) {
            Ok([x, y]) => Some(spot.facing([x, y, 0.0], stream)),
            Err(why) => {
                spot.lacks = Some(why);
                None
            }
        }
    }

    fn place<W: PlanarWorld>(
        &self,
        world: &W,
        disc: Option<([f32; 2], f32)>,
        spot: &mut Spot<'_>,
        stream: &mut Stream,
    ) -> Result<[f32; 2], ArenaError> {
        let Self { walls, apart } = self;
        // Centers are at least radius + walls from each wall. A margin of more than half the width leaves the middle.
        let margin = spot.edge + walls;
        let low = spot.size.map(|x| margin.min(0.5 * x) as f32);
        let high = spot.size.map(|x| (x - margin).max(0.5 * x) as f32);
        // The box of the disc, cut to the allowed centers. Places outside the disc are rejected later.
        let region = disc.map_or([low, high], |(at, far)| {
            [-far, far].map(|far| [0, 1].map(|k| Scalar::clamp(at[k] + far, low[k], high[k])))
        });
        let radius = spot.radius as f32;
        if spot.solid {
            // The distance belongs to the rule that places, not to the bodies placed earlier.
            spot.others.iter_mut().for_each(|(_, far)| *far = *apart as f32);
            // The region excludes the walls exactly. The margin of 1e-6 m allows for the rounding of its ends.
            let free = FreePlace { walls: (walls - 1e-6) as f32, within: disc, ..FreePlace::new(region, radius) };
            return free.clear_of(spot.others).find(world, stream);
        }
        let mut short = f32::INFINITY;
        for _ in 0..TRIES {
            let at = [0, 1].map(|k| stream.range(region[0][k], region[1][k]));
            // The largest overlap: r_i + r_j + apart - |p_i - p_j|.
            let lacks = spot.areas.iter().fold(f32::NEG_INFINITY, |most, (other, reach)| {
                let [x, y, _] = world.pose(*other).position;
                Scalar::max(most, (spot.edge + reach + apart) as f32 - length([at[0] - x, at[1] - y]))
            });
            if disc.is_none_or(|(center, far)| length([at[0] - center[0], at[1] - center[1]]) <= far) {
                // Areas may overlap unless a distance is given.
                if *apart == 0.0 || lacks <= 0.0 {
                    return Ok(at);
                }
                // The least overlap of all attempts shows in the error how much is missing.
                short = Scalar::min(short, lacks);
            }
        }
        Err(ArenaError::NoFreePlace { tries: TRIES, radius, short })
    }
}

fn length([x, y]: [f32; 2]) -> f32 {
    Scalar::sqrt(x * x + y * y)
}
