//! The scene of `reach-grasp-lift`. It defines the start of a trial, the sensors and motors of the robot, and the
//! observations that are made after each step.

use farsa_body::motors::{Muscles, ServoGroup, ServoRange};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, Handles, JointId, Joints, Kinematics, Motor, PairId,
    Sensor,
};
use farsa_body::robot::{Robot, RobotError};
use farsa_body::robots::{ArmAndHand, Finger, Tabletop};
use farsa_body::sensors::{JointPosition, Point, Signal, TargetPosition, Touch};
use farsa_body::{ChannelError, Pose, Twist};
use farsa_lab::{EpisodeId, Error};
use farsa_models::mjcf::{Keyframe, MjcfOptions};
use farsa_num::{Domain, Scalar, Stream};

use crate::reach_grasp_lift::config::{Config, Displacement, LABELS, Labels, OUTPUTS, PLAIN_SENSORS, TRIALS};
use crate::reach_grasp_lift::phase::{Observation, Phase};

/// Units per meter of the sphere's position: centimeters.
pub(crate) const TARGET_SCALE: f32 = 100.0;

/// The joints of the hand that are sensed, one of every linked group.
const SENSED_HAND_JOINTS: [usize; 10] = [8, 9, 10, 13, 14, 17, 18, 21, 22, 16];

/// Touch sensors of a list of pairs each.
type TouchPatches = Vec<Touch<Vec<PairId>>>;

/// The description of the robot, together with the identifiers of its parts.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Description of the arm, the hand, the sphere and the table.
    pub robot: Robot,
    /// Arm and hand from which the description was built.
    pub arm: ArmAndHand,
    /// Configuration from which the scene was built.
    pub config: Config,
    /// Contact pairs of the sphere and the fifteen phalanges, from the thumb to the little finger.
    pub sphere_on_phalanges: [PairId; 15],
    /// Contact pair of the sphere and the palm.
    pub sphere_on_palm: PairId,
    /// Contact pair of the sphere and the table.
    pub sphere_on_table: PairId,
}

/// The sensors of the robot, in the same order as the inputs of the network. There are 29 channels with labels and 26
/// channels without \[Ferrauto2010, 2.3.3\].
///
/// The first 17 channels are proprioceptors for the joints J1..J7, J8, J9, J10, J13, J14, J17, J18, J21, J22 and J16.
/// They are followed by 6 tactile sensors on the thumb, the four other fingers from index to little finger, and the
/// palm. Then come 3 channels for the position of the sphere relative to the palm, in centimeters, and 3 labels. A
/// label indicates a phase, or repeats an output of the network for [`Labels::Own`].
///
/// Deviations: the page that contains the source's list is not available. The ten hand joints and the scales were
/// therefore chosen. Touch sensors respond to all sides of a phalanx and not only to the inner side.
#[derive(Clone, Debug)]
pub struct Senses {
    parts: (Vec<JointPosition>, TouchPatches, TargetPosition, Option<Signal<LABELS>>),
    labels: Labels,
    label_amplitude: f32,
}

/// The motors of the robot, in the same order as the outputs of the network \[Ferrauto2010, 2.3.2\].
///
/// There are 23 channels. The first 14 channels drive the agonists and antagonists of J1..J7, and the others drive the
/// nine servo groups of [`ArmAndHand::servo_groups`].
#[derive(Clone, Debug)]
pub struct Motors {
    parts: (Vec<Muscles>, Vec<ServoGroup<Vec<ServoRange>>>),
}

/// A channel that cannot be built from these values, as a mistake in the settings.
fn wrong_channel(error: ChannelError) -> Error {
    Error::Other(format!("reach-grasp-lift: {error}"))
}

fn wrong_robot(error: &RobotError) -> Error {
    Error::Other(format!("reach-grasp-lift: {error}"))
}

impl Scene {
    /// Builds the scene for a configuration.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the robot cannot be simulated.
    pub fn new(config: Config) -> Result<Self, Error> {
        let arm = config.arm();
        let robot = config.tabletop().scene(&arm).map_err(|error| wrong_robot(&error))?;
        let pair = |a: &str, b: &str| {
            robot.pair(a, b).ok_or_else(|| Error::Other(format!("reach-grasp-lift: no pair of {a} and {b}")))
        };
        let mut sphere_on_phalanges = [PairId(0); 15];
        for (finger, pairs) in Finger::ALL.into_iter().zip(sphere_on_phalanges.chunks_mut(3)) {
            for (collider, to) in ArmAndHand::phalange_colliders(finger).into_iter().zip(pairs) {
                *to = pair("sphere", &robot.colliders[collider].name)?;
            }
        }
        let (sphere_on_palm, sphere_on_table) = (pair("sphere", "palm")?, pair("sphere", "table")?);
        Ok(Self { robot, arm, config, sphere_on_phalanges, sphere_on_palm, sphere_on_table })
    }

    /// Creates the sensors of the robot.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the range of a joint is empty.
    pub fn senses(&self) -> Result<Senses, Error> {
        let joints = self.sensed_joints().into_iter();
        let joints = joints.map(|(joint, [from, to])| JointPosition::new(joint, from, to).map_err(wrong_channel));
        let saturation = self.config.touch_saturation as f32;
        let patches = self.patches().into_iter().map(|pairs| Touch::new(pairs, saturation).map_err(wrong_channel));
        let (joints, patches) = (joints.collect::<Result<Vec<_>, _>>()?, patches.collect::<Result<TouchPatches, _>>()?);
        let palm = Point { body: ArmAndHand::PALM, at: self.arm.palm_centre.map(|x| x as f32) };
        let target = TargetPosition::new(Point::origin(Tabletop::SPHERE), palm, self.config.target_axes, TARGET_SCALE);
        let label_amplitude = self.config.label_amplitude as f32;
        let labels = self.config.labels;
        let label = match labels {
            Labels::Given => Some(Signal::one_hot(Phase::Reach.index(), label_amplitude)),
            Labels::None => None,
            Labels::Own => Some(Signal::new([0.0; LABELS])),
        };
        Ok(Senses { parts: (joints, patches, target.map_err(wrong_channel)?, label), labels, label_amplitude })
    }

    /// Returns the names of the network's outputs. These are the motors, and for [`Labels::Own`] the labels of the next
    /// step.
    pub(crate) fn output_names(&self, motors: &Motors) -> Vec<String> {
        let labels = (1..=self.config.labels.outputs()).map(|n| format!("next label {n}"));
        motors.names().into_iter().chain(labels).collect()
    }

    /// Creates the motors of the robot.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the position of a servo is not finite.
    pub fn motors(&self) -> Result<Motors, Error> {
        let muscles = (0..7).map(|i| Muscles::new(ActuatorId(i))).collect();
        let groups: Result<Vec<_>, _> = self.arm.servo_groups().into_iter().map(ServoGroup::new).collect();
        Ok(Motors { parts: (muscles, groups.map_err(wrong_channel)?) })
    }

    /// The joints that are sensed, with the positions that read 0 and 1 \[rad\].
    pub(crate) fn sensed_joints(&self) -> Vec<(JointId, [f32; 2])> {
        let arm = ArmAndHand::joints().into_iter().zip(self.arm.arm_ranges);
        let hand = SENSED_HAND_JOINTS.into_iter().map(|number| {
            // Abduction over its range. Opposition and flexion from extended, the upper limit.
            let [low, high] = match number {
                8 => self.arm.opposition_range,
                16 => self.arm.abduction_ranges[1],
                _ => self.arm.flexion_range,
            };
            (JointId(number as u16 - 1), if number == 16 { [low, high] } else { [high, low] })
        });
        arm.chain(hand).map(|(joint, range)| (joint, range.map(|x| x as f32))).collect()
    }

    /// The pairs of the tactile sensors: thumb, index, middle, ring, little finger, palm.
    pub(crate) fn patches(&self) -> Vec<Vec<PairId>> {
        let fingers = Finger::ALL.map(|finger| ArmAndHand::phalange_colliders(finger).to_vec());
        let patches = fingers.into_iter().chain([vec![ArmAndHand::ARM_COLLIDERS[2]]]);
        patches.map(|colliders| self.foreign_pairs(&colliders)).collect()
    }

    /// The pairs of these colliders with anything that is not of the arm and hand.
    fn foreign_pairs(&self, own: &[usize]) -> Vec<PairId> {
        let of_arm =
            |collider: &usize| self.robot.colliders[*collider].body.is_some_and(|body| body != Tabletop::SPHERE);
        let pairs = self.robot.pairs.iter().enumerate();
        pairs
            .filter(|(_, pair)| pair.colliders.iter().any(|c| own.contains(c)) && !pair.colliders.iter().all(of_arm))
            .map(|(i, _)| PairId(i as u16))
            .collect()
    }

    /// Draws the initial angles of J1..J27 in radians and the initial position of the sphere on the table in meters.
    ///
    /// The displacements are drawn from the stream of [`Domain::Start`]. The joints come first, followed by x and y of
    /// the sphere. Angles are clamped to the range of the joint. Deviations: the source displaces "each joint" by up to
    /// 1 degree and the sphere by up to 1.5 cm. It does not specify the distribution (uniform here), and it
    /// does not state that the joints of the hand are displaced.
    pub fn start(&self, id: EpisodeId) -> ([f64; 27], [f64; 2]) {
        self.start_from(id, [id.trial as usize; 2])
    }

    /// Draws an initial state that combines the arm posture and the sphere position of two trials. The displacements
    /// are those of the trial in `id`.
    pub fn start_from(&self, id: EpisodeId, starts: [usize; 2]) -> ([f64; 27], [f64; 2]) {
        let config = &self.config;
        let [posture, place] = starts.map(|trial| trial % TRIALS);
        // Individual 0 for all gives one draw per generation, so that selection compares equal starts.
        let individual = match config.displacement {
            Displacement::PerGeneration => 0,
            Displacement::PerIndividual => id.individual,
        };
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, individual, id.generation);
        let mut displaced = |at: f64, by: f64| at + by * f64::from(stream.range(-1.0, 1.0));
        // Poses and displacements are in degrees. Clamping comes last, because a displaced angle may leave its range.
        let joints = core::array::from_fn(|i| {
            let pose = if i < 4 { config.arm_poses[4 * posture + i] } else { 0.0 };
            let [low, high] = self.robot.segments[i].joint.range;
            displaced(pose, config.joint_displacement).to_radians().clamp(low, high)
        });
        // The displacement is in centimeters and the start in meters.
        let sphere = config.sphere_start(place).map(|x| displaced(x, config.sphere_displacement / 100.0));
        (joints, sphere)
    }

    /// Returns the options for a MuJoCo model of the scene. They contain the dynamics step and the starts without
    /// displacements.
    pub fn mjcf_options(&self) -> MjcfOptions {
        let config = &self.config;
        let start = |trial: usize| {
            let [x, y] = config.sphere_start(trial);
            Keyframe {
                name: format!("start{}", trial + 1),
                joints: config.arm_poses[4 * trial..4 * trial + 4].iter().map(|degrees| degrees.to_radians()).collect(),
                bodies: vec![(Tabletop::SPHERE, Pose::at([x, y, config.sphere_radius]))],
            }
        };
        MjcfOptions {
            // MuJoCo steps once per dynamics step, not once per control step.
            time_step: config.time_step / f64::from(config.substeps),
            gravity: [0.0, 0.0, -config.gravity],
            keyframes: (0..TRIALS).map(start).collect(),
            ..MjcfOptions::default()
        }
    }

    /// Moves the arm and the sphere to the initial state of a trial.
    pub fn arrange<W>(&self, world: &mut W, id: EpisodeId)
    where
        W: Arrange + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        self.arrange_from(world, id, [id.trial as usize; 2]);
    }

    /// Moves the arm and the sphere to the initial state returned by [`start_from`](Self::start_from).
    pub fn arrange_from<W>(&self, world: &mut W, id: EpisodeId, starts: [usize; 2])
    where
        W: Arrange + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        let (joints, [x, y]) = self.start_from(id, starts);
        world.clear();
        for (joint, position) in ArmAndHand::joints().into_iter().zip(joints) {
            world.place_joint(joint, position as f32, 0.0);
        }
        let at = [x, y, self.config.sphere_radius].map(|x| x as f32);
        world.place_body(Tabletop::SPHERE, Pose::at(at), Twist::default());
        world.finish_placement();
    }

    /// Returns the position of the palm's center in the world (in meters).
    pub fn palm_centre<W: Kinematics<Body = BodyId> + ?Sized>(&self, world: &W) -> [f64; 3] {
        world.pose(ArmAndHand::PALM).cast::<f64>().transform(self.arm.palm_centre)
    }

    /// Returns the position of the sphere's center in the world (in meters).
    pub fn sphere_centre<W: Kinematics<Body = BodyId> + ?Sized>(&self, world: &W) -> [f64; 3] {
        world.origin(Tabletop::SPHERE).map(f64::from)
    }

    /// Computes an observation from the current state of a world.
    pub fn observe<W>(&self, world: &W) -> Observation
    where
        W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        let palm_pose = world.pose(ArmAndHand::PALM).cast::<f64>();
        let palm = palm_pose.transform(self.arm.palm_centre);
        let sphere = self.sphere_centre(world);
        let mut grasp_centre = palm;
        for finger in Finger::ALL {
            let (body, tip) = self.arm.fingertip(finger);
            let at = world.pose(body).cast::<f64>().transform(tip);
            for k in 0..3 {
                grasp_centre[k] += at[k];
            }
        }
        // Six points with equal weights, the palm and five fingertips.
        let grasp_centre = grasp_centre.map(|x| x / 6.0);
        // Fingers are extended at the upper limit, which therefore reads 1.
        let [low, high] = self.arm.flexion_range;
        let openness = |joint: &JointId| ((f64::from(world.position(*joint)) - low) / (high - low)).clamp(0.0, 1.0);
        let touches = |pair: PairId| world.touches(pair);
        Observation {
            // Lengths change from meters to centimeters. The table top is at z = 0.
            reach_distance: 100.0 * distance(palm, [sphere[0], sphere[1], sphere[2] + 0.05]),
            grasp_distance: 100.0 * distance(grasp_centre, sphere),
            contacts: self.sphere_on_phalanges.iter().filter(|pair| touches(**pair)).count() as u32,
            openness: ArmAndHand::flexion_joints().iter().map(openness).sum::<f64>() / 15.0,
            // The cosine to the downward vertical is minus the z component of the palm's unit normal.
            palm_down: -palm_pose.rotate(ArmAndHand::PALM_NORMAL)[2],
            on_table: touches(self.sphere_on_table),
            height: 100.0 * sphere[2],
            palm,
            grasp_centre,
        }
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    Scalar::sqrt(x * x + y * y + z * z)
}

impl Senses {
    /// Sets the phase that the labels will indicate in the next reading. It has no effect unless the labels are
    /// [`Labels::Given`].
    pub fn set_label(&mut self, phase: Phase) {
        if let (Labels::Given, Some(label)) = (self.labels, &mut self.parts.3) {
            label.set_one_hot(phase.index(), self.label_amplitude);
        }
    }

    /// Sets the labels of the next reading from the outputs for labels. It has no effect unless the labels are
    /// [`Labels::Own`].
    pub fn set_own_labels(&mut self, outputs: [f32; 3]) {
        if let (Labels::Own, Some(label)) = (self.labels, &mut self.parts.3) {
            label.set(outputs.map(|output| self.label_amplitude * output));
        }
    }

    /// Returns the names of the channels.
    pub fn names(&self) -> Vec<String> {
        let joints = (1..=7).chain(SENSED_HAND_JOINTS).map(|n| format!("J{n}"));
        let touch = ["thumb", "index", "middle", "ring", "little", "palm"].map(|part| format!("touch {part}"));
        let target = ["x", "y", "z"].map(|axis| format!("sphere {axis} [cm]"));
        let labels = match self.labels {
            Labels::Given => Phase::ALL.map(|phase| format!("label {}", phase.name())).to_vec(),
            Labels::None => Vec::new(),
            Labels::Own => (1..=LABELS).map(|n| format!("label {n}")).collect(),
        };
        joints.chain(touch).chain(target).chain(labels).collect()
    }
}

impl Channels for Senses {
    fn channels(&self) -> usize {
        PLAIN_SENSORS + self.parts.3.channels()
    }
    fn reset(&mut self) {
        self.parts.reset();
    }
}

impl<W> Sensor<W> for Senses
where
    W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId> + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        self.parts.read(world, out);
    }
}

impl Motors {
    /// Returns the names of the channels.
    pub fn names(&self) -> Vec<String> {
        let muscles = (1..=7).flat_map(|n| [format!("J{n} agonist"), format!("J{n} antagonist")]);
        let groups = ["J8", "J9", "J10 J11", "J13", "J14 J15", "J17", "J18 J19", "J12 J16 J20 J24", "J21-J23 J25-J27"];
        muscles.chain(groups.map(String::from)).collect()
    }
}

impl Channels for Motors {
    fn channels(&self) -> usize {
        OUTPUTS
    }
    fn reset(&mut self) {
        self.parts.reset();
    }
}

impl<W: Actuated + Handles<Actuator = ActuatorId> + ?Sized> Motor<W> for Motors {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        self.parts.drive(y, world);
    }
}
