//! The motors of the robot. The network moves the trunk, the right arm and the hand, and a reflex moves the head.

use farsa_body::motors::{HeadTracking, ServoGroup, ServoRange};
use farsa_body::ports::{Actuated, ActuatorId, BodyId, Channels, Handles, Kinematics, Motor};
use farsa_body::robots::Icub;
use farsa_lab::Error;

use crate::icub_reach_grasp::config::MOTORS;
use crate::icub_reach_grasp::scene::{Scene, wrong};
use crate::icub_reach_grasp::senses::Senses;

/// The joints with a motor neuron each.
pub(crate) const CONTROLLED: [&str; 9] = [
    "torso_pitch",
    "torso_yaw",
    "r_shoulder_pitch",
    "r_shoulder_roll",
    "r_shoulder_yaw",
    "r_elbow",
    "r_wrist_prosup",
    "r_wrist_pitch",
    "r_wrist_yaw",
];

/// The joints of the hand that abduct the fingers. All others follow one motor neuron.
const ABDUCTION: [u16; 4] = [12, 16, 20, 24];
/// The thumb's opposition, and its flexion.
const OPPOSITION: u16 = 8;
const THUMB: [u16; 3] = [9, 10, 11];

/// The motors, in the same order as the outputs of the network.
///
/// The first nine outputs are desired angles, scaled from the lower to the upper joint limit. They control
/// the pitch and yaw of the trunk and the seven joints of the right arm. The last output opens the hand at 0 and closes
/// it at 1. The roll of the trunk and the abduction of the fingers are constant. The neck either follows the ball by
/// means of [`HeadTracking`] or keeps its angles.
#[derive(Clone, Debug)]
pub struct Motors {
    groups: Vec<ServoGroup<Vec<ServoRange>>>,
    head: Option<HeadTracking>,
    held: Vec<(ActuatorId, f32)>,
}

impl Motors {
    /// Creates the motors for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the servos are invalid.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let config = &scene.config;
        let servo = |joint: &str, [from, to]: [f64; 2]| -> Result<ServoRange, Error> {
            Ok(ServoRange { servo: scene.actuator(joint)?, from: from as f32, to: to as f32 })
        };
        let group = |servos: Vec<ServoRange>| ServoGroup::new(servos).map_err(|error| wrong(&error));
        let mut groups = Vec::new();
        for joint in CONTROLLED {
            groups.push(group(vec![servo(joint, scene.range(joint)?)?])?);
        }
        let (mut hand, mut held) = (Vec::new(), Vec::new());
        for number in 8..=27_u16 {
            let joint = format!("r_J{number}");
            let [thumb, fingers] = config.flexion;
            match number {
                OPPOSITION => hand.push(servo(&joint, config.opposition.map(f64::to_radians))?),
                // Abduction has no channel. Its servos hold the angle 0.
                _ if ABDUCTION.contains(&number) => held.push((scene.actuator(&joint)?, 0.0)),
                // Joints are extended at 0 and flex towards negative angles.
                _ if THUMB.contains(&number) => hand.push(servo(&joint, [0.0, -thumb.to_radians()])?),
                _ => hand.push(servo(&joint, [0.0, -fingers.to_radians()])?),
            }
        }
        groups.push(group(hand)?);
        held.push((scene.actuator("torso_roll")?, config.torso[1].to_radians() as f32));
        let [pitch, roll, yaw] = config.neck.map(|angle| angle.to_radians() as f32);
        held.push((scene.actuator("neck_roll")?, roll));
        let [upwards, leftwards] = [scene.range("neck_pitch")?, scene.range("neck_yaw")?];
        let head = if config.tracking {
            let servos = [servo("neck_yaw", leftwards)?, servo("neck_pitch", upwards)?];
            // From rad/s to rad per step.
            let most = (config.head_speed * config.time_step) as f32;
            let eye = (Icub::HEAD, Senses::eye());
            let head =
                HeadTracking::new(eye, (Scene::BALL, [0.0; 3]), servos, [yaw, pitch], config.head_gain as f32, most);
            Some(head.map_err(|error| wrong(&error))?)
        } else {
            held.extend([(scene.actuator("neck_yaw")?, yaw), (scene.actuator("neck_pitch")?, pitch)]);
            None
        };
        Ok(Self { groups, head, held })
    }

    /// Returns the names of the channels.
    pub fn names() -> [&'static str; MOTORS] {
        let mut names = ["hand"; MOTORS];
        names[..CONTROLLED.len()].copy_from_slice(&CONTROLLED);
        names
    }
}

impl Channels for Motors {
    fn channels(&self) -> usize {
        MOTORS
    }

    fn reset(&mut self) {
        if let Some(head) = &mut self.head {
            head.reset();
        }
    }
}

impl<W> Motor<W> for Motors
where
    W: Kinematics + Actuated + Handles<Body = BodyId, Actuator = ActuatorId> + ?Sized,
{
    fn drive(&mut self, y: &[f32], world: &mut W) {
        self.groups.drive(y, world);
        if let Some(head) = &mut self.head {
            head.step(world);
        }
        for (servo, angle) in &self.held {
            world.command(*servo, [*angle, 0.0]);
        }
    }
}
