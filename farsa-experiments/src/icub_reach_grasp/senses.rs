//! The sensors of the robot. They measure the image of the left eye, four joint angles and touch.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Channels, Contacts, Handles, JointId, Joints, Kinematics, PairId, Sensor};
use farsa_body::robots::{Finger, Icub, Side};
use farsa_body::sensors::{Camera, JointPosition, Touch, VisualOffset};
use farsa_lab::{EpisodeId, Error};
use farsa_num::{Domain, Stream};

use crate::icub_reach_grasp::config::SENSORS;
use crate::icub_reach_grasp::scene::{Scene, wrong};

/// The joints that are sensed.
const JOINTS: [&str; 4] = ["neck_pitch", "neck_yaw", "torso_pitch", "torso_yaw"];
/// Range of the eye \[m\]. Nothing hides the ball.
const RANGE: f32 = 10.0;

/// The four patches of the palm that touch the ball: towards fingers or wrist, on the thumb's side or the other.
#[derive(Clone, Debug)]
struct PalmPatches {
    on_ball: PairId,
    /// Middle of the palm in its frame \[m\].
    middle: [f32; 3],
}

impl Channels for PalmPatches {
    fn channels(&self) -> usize {
        4
    }
}

impl<W: Kinematics + Contacts + Handles<Body = BodyId> + ?Sized> Sensor<W> for PalmPatches {
    /// The palm is flat: a ball touches it if its center is above.
    fn read(&mut self, world: &W, out: &mut [f32]) {
        out.fill(0.0);
        if world.touches(self.on_ball) {
            let [x, y, _] = world.pose(Scene::PALM).transform_back(world.pose(Scene::BALL).position);
            // Larger x is nearer to the fingers, and larger y is nearer to the thumb.
            let patch = 2 * usize::from(x < self.middle[0]) + usize::from(y < self.middle[1]);
            out[patch] = 1.0;
        }
    }
}

/// The sensors, in the same order as the inputs of the network.
///
/// The first two channels measure the offset of the ball from the hand in the image of the left eye. They are positive
/// to the left and upwards and range from -1 to 1. The next four channels are the pitch and yaw of the neck and the
/// trunk, scaled from 0 at the lower to 1 at the upper limit. The last nine channels are touch sensors with values of 0
/// or 1. Five of them are on the fingertips, starting with the thumb, and react to the ball and the table. The other
/// four are patches of the palm and react to the ball only.
#[derive(Clone, Debug)]
pub struct Senses {
    offset: VisualOffset,
    joints: [JointPosition; 4],
    tips: [Touch<Vec<PairId>>; 5],
    palm: PalmPatches,
    /// Largest error of each offset, and where it comes from.
    noise: f32,
    errors: Stream,
}

impl Senses {
    /// Creates the sensors for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the eye is invalid.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let eye = Self::camera(scene, [1, 1])?;
        let palm_centre = scene.icub.palm_centre(Side::Right).map(|x| x as f32);
        let offset = VisualOffset::new(eye, (Scene::BALL, [0.0; 3]), (Scene::PALM, palm_centre));
        let joint = |name: &str| {
            let [low, high] = scene.range(name)?.map(|x| x as f32);
            JointPosition::new(scene.joint(name)?, low, high).map_err(|error| wrong(&error))
        };
        let [a, b, c, d] = JOINTS.map(joint);
        let tip = |finger: Finger| {
            let fingertip = scene.icub.fingertip(Side::Right, finger).0;
            let mine = |collider: &usize| scene.robot.colliders[*collider].body == Some(fingertip);
            // Fixed colliders and the ball. Other parts of the robot do not count.
            let foreign =
                |collider: &usize| scene.robot.colliders[*collider].body.is_none_or(|body| body == Scene::BALL);
            let pairs = scene.robot.pairs.iter().enumerate();
            let pairs = pairs.filter(|(_, pair)| pair.colliders.iter().any(mine) && pair.colliders.iter().any(foreign));
            let pairs = pairs.map(|(number, _)| PairId(number as u16)).collect();
            Touch::new(pairs, 1.0).map_err(|error| wrong(&error))
        };
        let [t0, t1, t2, t3, t4] = Finger::ALL.map(tip);
        let on_ball = scene.robot.pair("ball", "r_palm").ok_or_else(|| wrong(&"no pair of ball and palm"))?;
        let middle = scene.icub.hand.palm_box.map(|x| x as f32);
        Ok(Self {
            offset,
            joints: [a?, b?, c?, d?],
            tips: [t0?, t1?, t2?, t3?, t4?],
            palm: PalmPatches { on_ball, middle },
            noise: 0.0,
            errors: Stream::new(0, Domain::Sensor, 0, 0, 0),
        })
    }

    /// The left eye in the head's frame, which it looks along.
    pub(crate) fn eye() -> Pose {
        Pose::at(Icub::EYES[0].map(|x| x as f32))
    }

    /// The left eye with an image of `size` \[columns, rows\].
    pub(crate) fn camera(scene: &Scene, size: [usize; 2]) -> Result<Camera, Error> {
        let view = scene.config.field_of_view.to_radians();
        Camera::new(Icub::HEAD, Self::eye(), size, view, RANGE).map_err(|error| wrong(&error))
    }

    /// Starts a trial. The offsets will have random errors of at most `noise`. The sensor values do not depend on
    /// earlier trials.
    pub fn start(&mut self, id: EpisodeId, noise: f32) {
        self.noise = noise;
        self.errors = Stream::new(id.seed, Domain::Sensor, id.trial, id.individual, id.generation);
    }

    /// Returns the names of the channels.
    pub fn names() -> [&'static str; SENSORS] {
        [
            "dx",
            "dy",
            "neck pitch",
            "neck yaw",
            "torso pitch",
            "torso yaw",
            "thumb tip",
            "index tip",
            "middle tip",
            "ring tip",
            "little tip",
            "palm: index",
            "palm: little",
            "palm: thumb",
            "palm: heel",
        ]
    }

    /// Reads all channels into `x`.
    pub fn read<W>(&mut self, world: &W, x: &mut [f32; SENSORS])
    where
        W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        let (offset, rest) = x.split_at_mut(2);
        let (joints, touch) = rest.split_at_mut(4);
        let (tips, palm) = touch.split_at_mut(5);
        self.offset.read(world, offset);
        self.joints.read(world, joints);
        self.tips.read(world, tips);
        self.palm.read(world, palm);
        if self.noise > 0.0 {
            for x in offset {
                *x += self.errors.range(-self.noise, self.noise);
            }
        }
    }
}
