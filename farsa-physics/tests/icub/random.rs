//! Random starts and random commands of the iCub's actuators.

use farsa_body::actuators::Law;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, Handles, JointId};
use farsa_body::robot::{Actuator, Robot};
use farsa_body::robots::Icub;
use farsa_num::{Domain, Stream};

/// A largest commanded speed of velocity motors [rad/s], beyond what any experiment requests.
pub(crate) const SPEED: f64 = 4.0;

/// Places the joints at most this far from the posture [rad], within their limits, and at rest.
pub(crate) fn start<W>(icub: &Icub, robot: &Robot, world: &mut W, episode: u32, displacement: f64)
where
    W: Arrange + Handles<Joint = JointId> + ?Sized,
{
    let mut stream = Stream::new(3, Domain::Start, episode, 0, 0);
    world.clear();
    for (joint, angle) in robot.joints().zip(icub.start()) {
        let [low, high] = robot.segments[joint.index()].joint.range;
        let angle = (angle + stream.range_f64(-displacement, displacement)).clamp(low, high);
        world.place_joint(joint, angle as f32, 0.0);
    }
    world.finish_placement();
}

/// Postures in which both forearms touch in front of the chest: part of a joint's name, angles [deg].
const MEETING: [(&str, [f64; 2]); 4] = [
    ("shoulder_pitch", [-60.0, -10.0]),
    ("shoulder_roll", [0.0, 40.0]),
    ("shoulder_yaw", [30.0, 100.0]),
    ("elbow", [50.0, 106.0]),
];

/// Random commands in one of several manners: uniform every step, extreme every step, and both held for a while. In
/// every other six episodes the arms touch each other.
#[derive(Clone)]
pub(crate) struct Babble {
    stream: Stream,
    ranges: Vec<[f64; 2]>,
    commands: Vec<f32>,
    hold: usize,
    extreme: bool,
    left: usize,
}

impl Babble {
    /// `speed` is the largest that is commanded to velocity motors [rad/s].
    pub(crate) fn new(robot: &Robot, seed: u64, episode: u32, speed: f64) -> Self {
        let range = |actuator: &Actuator| {
            let joint = &robot.segments[actuator.joint.index()].joint;
            let meeting = MEETING.iter().find(|(name, _)| episode / 6 % 2 == 1 && joint.name.ends_with(name));
            match (&actuator.law, meeting) {
                (Law::Velocity(_), _) => [-speed, speed],
                (_, Some((_, degrees))) => degrees.map(f64::to_radians),
                _ => joint.range,
            }
        };
        Self {
            stream: Stream::new(seed, Domain::Motor, episode, 0, 0),
            ranges: robot.actuators.iter().map(range).collect(),
            commands: vec![0.0; robot.actuators.len()],
            hold: [1, 1, 20, 20, 60, 200][(episode % 6) as usize],
            extreme: episode % 2 == 1,
            left: 0,
        }
    }

    pub(crate) fn drive<W>(&mut self, world: &mut W)
    where
        W: Actuated + Handles<Actuator = ActuatorId> + ?Sized,
    {
        if self.left == 0 {
            self.left = self.hold;
            for (command, [low, high]) in self.commands.iter_mut().zip(&self.ranges) {
                let x = self.stream.uniform_f64();
                let x = if self.extreme { f64::from(u8::from(x >= 0.5)) } else { x };
                *command = (low + (high - low) * x) as f32;
            }
        }
        self.left -= 1;
        for (i, command) in self.commands.iter().enumerate() {
            world.command(ActuatorId(i as u16), [*command, 0.0]);
        }
    }
}
