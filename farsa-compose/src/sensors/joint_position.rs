//! Positions of joints.

use farsa_body::ports::JointId;
use farsa_body::sensors;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::wrong;

/// Positions of joints or wheels, 0 at `from` and 1 at `to`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct JointPosition {
    /// Names, `left-wheel` and `right-wheel` of a robot on wheels, by default all.
    #[serde(default)]
    joints: Vec<String>,
    /// Position that reads 0 [rad or m], by default the lowest of the joint.
    #[schemars(range(min = -1e6, max = 1e6))]
    from: Option<f64>,
    /// Position that reads 1 [rad or m], by default the highest of the joint.
    #[schemars(range(min = -1e6, max = 1e6))]
    to: Option<f64>,
}

impl JointPosition {
    fn ends(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        [self.from.unwrap_or(low), self.to.unwrap_or(high)]
    }

    /// Rejects joints without a first or last position.
    fn check(&self, joints: &[JointId], scene: &PartScene<'_>) -> Result<(), Error> {
        let missing = [("from", self.from), ("to", self.to)].into_iter().find(|(_, end)| end.is_none());
        let Some((key, _)) = missing else { return Ok(()) };
        if scene.mobile_robot().is_some() {
            return Err(scene.error(format!("lacks the key `{key}`: wheels turn on and on")));
        }
        let turns_on =
            |joint: &&JointId| !self.ends(scene.0.range(**joint)).into_iter().all(|end| (end as f32).is_finite());
        let name = |joint: &JointId| scene.0.joint_name(*joint);
        let why = |joint| format!("lacks `from` or `to`: `{}` has no range of its own", name(joint));
        joints.iter().find(turns_on).map_or(Ok(()), |joint| Err(scene.error(why(joint))))
    }
}

impl SensorPart for JointPosition {
    type Sensor = Vec<sensors::JointPosition>;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Self::Sensor, Error> {
        let joints = scene.joints(&self.joints)?;
        self.check(&joints, scene)?;
        let build = |joint: JointId| {
            let [from, to] = self.ends(scene.0.range(joint)).map(|end| end as f32);
            sensors::JointPosition::new(joint, from, to).map_err(wrong)
        };
        joints.into_iter().map(build).collect()
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let joint = scene.0.joint(&self.joints, channel, &|_| true);
        let what = if scene.mobile_robot().is_some() { "angle of the" } else { "position of" };
        Quantity::new(format!("{what} {}", joint.name), joint.units[0], self.ends(joint.range)).as_label()
    }
}
