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
    /// Distance of both ends from the position in a posture of the model [rad or m], instead of `from` and `to`.
    #[schemars(range(min = 0.0, max = 1e6))]
    within: Option<f64>,
    /// Keyframe of the model for `within`, by default the configuration of the file.
    around: Option<String>,
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
    fn ends(&self, joint: JointId, scene: &PartScene<'_>) -> Result<[f64; 2], Error> {
        let given = [self.from, self.to];
        match self.within {
            None if self.around.is_some() => Err(scene.error("lacks the key `within`, the distance from the posture")),
            None => {
                let [low, high] = scene.0.range(joint);
                Ok([self.from.unwrap_or(low), self.to.unwrap_or(high)])
            }
            Some(_) if given.iter().any(Option::is_some) => {
                Err(scene.error("has `within`, and therefore neither `from` nor `to`"))
            }
            Some(within) => {
                let middle = scene.0.position_in(self.around.as_deref().unwrap_or_default(), joint)?;
                Ok([middle - within, middle + within])
            }
        }
    }
}

impl MotorPart for Servo {
    type Motor = Vec<ServoGroup<Vec<ServoRange>>>;

    fn motor(&self, scene: &PartScene<'_>) -> Result<Self::Motor, Error> {
        let build = |joint: JointId| {
            let [from, to] = self.ends(joint, scene)?.map(|end| end as f32);
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
        let ends = joint.id.map_or(Ok(joint.range), |id| self.ends(id, scene)).unwrap_or(joint.range);
        Quantity::new(text, joint.units[0], ends).as_label()
    }
}
