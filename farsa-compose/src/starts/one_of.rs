//! Choices among points. A choice may follow an earlier one.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_lab::Error;
use farsa_num::Stream;
use farsa_physics::arena::ArenaError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};

/// On one of these points, drawn from those without an earlier thing.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct OneOf {
    /// x and y of each point, and z for experiments with joints [m].
    #[schemars(length(min = 1, max = 100))]
    points: Vec<Vec<f64>>,
    /// An earlier placement `one-of` the same number of points. The point of the same number is taken, even if it
    /// is occupied. For several robots it is the point of the last one.
    like: Option<String>,
}

/// Points, of which a trial takes one.
#[derive(Clone, Debug)]
pub(super) struct OneOfStart {
    points: Vec<[f32; 3]>,
    /// Number of the earlier rule that this choice follows.
    like: Option<usize>,
}

impl OneOfStart {
    /// Chooses a free point, or the point of the earlier choice.
    fn choose(&self, spot: &Spot<'_>, taken: impl Fn(&[f32; 3]) -> bool, stream: &mut Stream) -> Option<usize> {
        // A choice that follows another one leaves the stream as it is.
        if let Some(rule) = self.like {
            return spot.chosen.get(rule).copied();
        }
        let free = || self.points.iter().enumerate().filter(|(_, point)| !taken(point)).map(|(number, _)| number);
        match free().count() {
            0 => None,
            count => free().nth(stream.below(count as u32) as usize),
        }
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Start<W> for OneOfStart {
    fn pose(&self, world: &W, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
        let taken = |[x, y, z]: &[f32; 3]| {
            let bodies = spot.others.iter().map(|(body, _)| body).chain(spot.areas.iter().map(|(body, _)| body));
            let mut flat = bodies.map(|body| world.pose(*body).position);
            flat.any(|at| at[..2] == [*x, *y]) || spot.earlier.iter().any(|(other, _)| *other == [*x, *y, *z])
        };
        let Some(number) = self.choose(spot, taken, stream) else {
            let (tries, radius) = (self.points.len() as u32, spot.radius as f32);
            spot.lacks = Some(ArenaError::NoFreePlace { tries, radius, short: 0.0 });
            return None;
        };
        spot.choice = Some(number);
        Some(spot.facing(self.points[number], stream))
    }
}

impl StartPart for OneOf {
    type Start = OneOfStart;

    fn start(&self, scene: &PartScene<'_>) -> Result<OneOfStart, Error> {
        let points = self.points.iter().enumerate();
        let points =
            points.map(|(index, at)| Ok(scene.0.start_point(at, &format!("points/{index}"))?.map(|x| x as f32)));
        let points = points.collect::<Result<Vec<_>, Error>>()?;
        let like = self.like.as_ref().map(|name| scene.0.earlier_choice(name, points.len())).transpose()?;
        Ok(OneOfStart { points, like })
    }

    fn is_one_place(&self) -> bool {
        self.like.is_some()
    }

    fn points(&self) -> Option<usize> {
        Some(self.points.len())
    }
}
