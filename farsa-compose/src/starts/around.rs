//! Places in a direction from a thing.

use core::f32::consts::PI;

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_lab::Error;
use farsa_lab::advanced::PlanarWorld;
use farsa_num::{Stream, sin_cos};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::spot::Spot;
use crate::part::{PartScene, Start, StartPart};

/// In a uniformly drawn direction from a thing, at a uniformly drawn distance between the centers.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Around {
    /// Name of the thing.
    of: String,
    /// Least and greatest distance [m].
    #[schemars(inner(range(min = 0.0, max = 1000.0)))]
    distance: [f64; 2],
}

/// The thing and the distances [m].
#[derive(Clone, Debug)]
pub(super) struct AroundStart(BodyId, [f32; 2]);

impl<W: PlanarWorld> Start<W> for AroundStart {
    fn pose(&self, world: &W, spot: &mut Spot<'_>, stream: &mut Stream) -> Option<Pose> {
        // p = c + r (cos a, sin a), with r and a uniform.
        // This is denser near the center than a draw uniform in area.
        let Self(of, [near, far]) = self;
        let distance = stream.range(*near, *far);
        let (sine, cosine) = sin_cos(stream.range(-PI, PI));
        let [x, y, _] = world.pose(*of).position;
        Some(spot.facing([x + distance * cosine, y + distance * sine, 0.0], stream))
    }
}

impl StartPart for Around {
    type Start = AroundStart;

    fn start(&self, scene: &PartScene<'_>) -> Result<AroundStart, Error> {
        let of = scene.0.placed_before(&self.of, "of")?;
        if self.distance[0] > self.distance[1] {
            return Err(scene.0.error_at("distance", "runs backwards".into()));
        }
        Ok(AroundStart(of, self.distance.map(|distance| distance as f32)))
    }
}
