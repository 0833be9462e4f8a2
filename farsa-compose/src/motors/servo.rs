//! Servos.

use farsa_body::motors::{ServoGroup, ServoRange};
use farsa_body::ports::JointId;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::motors::wrong;
use crate::part::wiring::is_servo;
use crate::part::{MotorPart, PartScene, Quantity};

/// Target positions of servos, one channel each: 0 `from` .. 1 `to`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Servo {
    /// Names of joints, by default all of the robot.
    #[serde(default)]
    joints: Vec<String>,
    /// Drives all joints by one channel.
    #[serde(default)]
    together: bool,
    /// Position at 0 [rad or m], by default the lowest of the joint.
    #[schemars(range(min = -1e6, max = 1e6))]
    from: Option<f64>,
    /// Position at 1 [rad or m], by default the highest of the joint.
    #[schemars(range(min = -1e6, max = 1e6))]
    to: Option<f64>,
    /// Stiffness of the servo [N m/rad or N/m], by default that of the model's own servo.
    #[schemars(range(min = 1e-9, max = 1e9))]
    stiffness: Option<f64>,
    /// Damping of the servo [N m s/rad or N s/m].
    #[schemars(range(min = 0.0, max = 1e9))]
    damping: Option<f64>,
    /// Largest effort of the servo [N m or N].
    #[schemars(range(min = 1e-9, max = 1e9))]
    limit: Option<f64>,
}

impl Servo {
    fn ends(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        [self.from.unwrap_or(low), self.to.unwrap_or(high)]
    }
}

impl MotorPart for Servo {
    type Motor = Vec<ServoGroup<Vec<ServoRange>>>;

    fn motor(&self, scene: &PartScene<'_>) -> Result<Self::Motor, Error> {
        let build = |joint: JointId| {
            let [from, to] = self.ends(scene.0.range(joint)).map(|end| end as f32);
            let servo = scene.servo(joint, [self.stiffness, self.damping, self.limit])?;
            Ok(ServoRange { servo, from, to })
        };
        let joints = scene.driven(&self.joints, self.stiffness.is_some(), is_servo)?;
        let servos = joints.into_iter().map(build).collect::<Result<Vec<_>, Error>>()?;
        let groups = if self.together { vec![servos] } else { servos.into_iter().map(|servo| vec![servo]).collect() };
        groups.into_iter().map(ServoGroup::new).collect::<Result<_, _>>().map_err(wrong)
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let joint = scene.driven_joint(&self.joints, channel, self.stiffness.is_some(), is_servo);
        let others = if self.together { " and all with it" } else { "" };
        let text = format!("position of {}{others}", joint.name);
        Quantity::new(text, joint.units[0], self.ends(joint.range)).as_label()
    }
}
