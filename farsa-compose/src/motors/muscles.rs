//! Pairs of muscles.

use farsa_body::motors;
use farsa_body::ports::JointId;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::wiring::is_muscles;
use crate::part::{MotorPart, PartScene, Quantity};

/// Two muscles on each joint, one channel each: 0 slack .. 1 full tension.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Muscles {
    /// Names of joints, by default all of the robot.
    #[serde(default)]
    joints: Vec<String>,
    /// Largest tension [N], by default that of the robot's own muscles.
    #[schemars(range(min = 1e-6, max = 1e9))]
    tension: Option<f64>,
    /// Lever arm of the tension about the joint [m].
    #[schemars(range(min = 1e-6, max = 1e3))]
    moment_arm: Option<f64>,
}

impl MotorPart for Muscles {
    type Motor = Vec<motors::Muscles>;

    fn motor(&self, scene: &PartScene<'_>) -> Result<Vec<motors::Muscles>, Error> {
        let build = |joint: JointId| Ok(motors::Muscles::new(scene.muscles(joint, [self.tension, self.moment_arm])?));
        scene.driven(&self.joints, self.tension.is_some(), is_muscles)?.into_iter().map(build).collect()
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        // A pair of muscles has two channels.
        let joint = scene.driven_joint(&self.joints, channel / 2, self.tension.is_some(), is_muscles);
        let which = ["agonist", "antagonist"][channel % 2];
        Quantity::new(format!("activation of the {which} of {}", joint.name), "1", [0.0, 1.0]).as_label()
    }
}
