//! The experiment `reach-grasp-lift` as the `farsa` command runs it.

pub use crate::fitness::{ContactTerm, GRASP_CAP, Judgement, LIFT_CAP, Ledger, REACH_CAP, Trial};
pub use crate::phase::{Observation, Phase};
pub use crate::reach_grasp_lift_config::{Config, Displacement, Engine, SphereFrame, TRIALS};
pub use crate::reach_grasp_lift_life::{Judge, ReachLife};
pub use crate::reach_grasp_lift_scene::{Motors, OUTPUTS, Scene, Senses};
pub use crate::script::{Plan, ScriptLife, Statics, Timetable};

use std::sync::Arc;

use farsa_body::{
    Actuated, ActuatorId, ArmAndHand, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Law,
    MjcfOptions, MusclePair, PairId, Recorder, Tabletop, Twist,
};
use farsa_evo::{GeneRange, decode};
use farsa_nn::{Layout, Leak, Network, ParameterKind};
use farsa_physics::articulated::{Batch, Model, World};

use crate::controller_export::{ControllerExport, NetworkExport, StartExport};
use crate::error::Error;
use crate::experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape, Task};
use crate::lanes::Lanes;
use crate::life::{Job, Life};
use crate::live_in_lanes::live_in_lanes;
use crate::settings::{Setting, Settings};
use crate::stage::{Channel, Stage};

/// Does a caretaker's label help a robot learn to manipulate? \[Ferrauto2010, chapter 2; Massera2010\]
///
/// A simulated iCub-like arm and hand evolves to reach, grasp and lift a sphere, either told the phase of the task by three
/// more inputs (condition `labels`, A) or not (`no-labels`, B). Every value that the source does not give is a setting
/// with its reason; [`Config`] lists them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ReachGraspLift;

/// Condition A.
const LABELS: &str = "labels";
/// Condition B.
const NO_LABELS: &str = "no-labels";

impl Experiment for ReachGraspLift {
    fn name(&self) -> &'static str {
        "reach-grasp-lift"
    }

    fn summary(&self) -> &'static str {
        "an arm and hand learns to reach, grasp and lift a sphere, with or without labels that name the phase"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &[LABELS, NO_LABELS]
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        Config::of_condition(condition != NO_LABELS).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        let config = Config::read(condition != NO_LABELS, settings)?;
        match config.engine {
            Engine::Articulated => Ok(Box::new(Lives::new(config)?)),
            #[cfg(feature = "rapier")]
            Engine::Rapier => Ok(Box::new(Lives::in_rapier(config)?)),
            #[cfg(not(feature = "rapier"))]
            Engine::Rapier => Err(config.engine.missing()),
        }
    }
}

/// The scene in its world with a network that genes are decoded into: everything that a thread needs to live lives.
pub struct Lives<W = World<f32>> {
    world: W,
    /// For worlds in lanes, where there are any.
    model: Option<Model<f32>>,
    life: NetworkLife,
    decoder: Decoder,
    /// The arm's muscles, to tell their lengths and torques.
    muscles: Vec<MusclePair<f32>>,
    /// The bodies that have a shape, but for the palm and the sphere.
    other_bodies: Vec<BodyId>,
    /// For lives side by side.
    together: Option<Together>,
}

/// The controller's life in a trial.
type NetworkLife = ReachLife<Network<Vec<f32>, Vec<f32>>>;

/// Worlds in lanes, and the life in each with the number of its task.
struct Together {
    batch: Batch,
    lives: Vec<Numbered>,
}

struct Numbered {
    life: NetworkLife,
    number: usize,
}

impl<W: ?Sized> Life<W> for Numbered
where
    NetworkLife: Life<W>,
{
    fn start(&mut self, world: &mut W, job: Job) {
        self.life.start(world, job);
    }
    fn tick(&mut self, world: &mut W) -> Option<f64> {
        self.life.tick(world)
    }
}

/// Scalars of a tick: phase, 4 rewards, 6 of the judge's, 3 + 7 of palm and sphere, 27 joints, 21 of muscles, 17 forces, 27 + 6
/// speeds of joints and sphere.
const SCALARS: usize = 1 + 4 + 6 + 3 + 7 + 27 + 21 + 17 + 27 + 6;

/// Fills the first places of a slice and returns the others.
fn put<const N: usize>(places: &mut [f64], values: [f64; N]) -> &mut [f64] {
    match places.split_first_chunk_mut::<N>() {
        Some((to, rest)) => {
            *to = values;
            rest
        }
        None => &mut [],
    }
}

/// The pairs of the sphere with the phalanges, the palm and the table.
fn on_sphere(scene: &Scene) -> impl Iterator<Item = PairId> {
    scene.sphere_on_phalanges.into_iter().chain([scene.sphere_on_palm, scene.sphere_on_table])
}

fn wrong(error: &dyn std::fmt::Display) -> Error {
    Error::Other(format!("reach-grasp-lift: {error}"))
}

impl Lives {
    /// Lives under a configuration, in our articulated world.
    ///
    /// # Errors
    /// [`Error::Other`] for a configuration whose robot or network cannot be built.
    pub fn new(config: Config) -> Result<Self, Error> {
        Self::assemble(config, |scene| {
            let model = Model::new(&scene.robot, &scene.config.options()).map_err(|error| wrong(&error))?;
            Ok((World::new(model.clone()), Some(model)))
        })
    }
}

#[cfg(feature = "rapier")]
impl Lives<farsa_physics::rapier::World> {
    /// Lives under a configuration, in rapier.
    ///
    /// # Errors
    /// [`Error::Other`] for a configuration whose robot or network cannot be built.
    pub fn in_rapier(config: Config) -> Result<Self, Error> {
        Self::assemble(config, |scene| {
            let world = farsa_physics::rapier::World::new(&scene.robot, &scene.config.rapier_options());
            Ok((world.map_err(|error| wrong(&error))?, None))
        })
    }
}

impl<W> Lives<W> {
    fn assemble(
        config: Config,
        world: impl FnOnce(&Scene) -> Result<(W, Option<Model<f32>>), Error>,
    ) -> Result<Self, Error> {
        let layout = config.layout();
        let decoder = Decoder::new(layout, config.leak, config.weight_range as f32)?;
        let (zeros, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
        let network = Network::new(layout, config.leak, zeros, state).map_err(|error| wrong(&error))?;
        let scene = Scene::new(config)?;
        let (world, model) = world(&scene)?;
        let laws = scene.robot.actuators.iter().map(|actuator| actuator.law.cast::<f32>());
        let muscles = laws.map_while(|law| if let Law::MusclePair(pair) = law { Some(pair) } else { None }).collect();
        let told = [Tabletop::SPHERE, ArmAndHand::PALM];
        let other_bodies = scene.robot.shaped_bodies().filter(|body| !told.contains(body)).collect();
        let life = ReachLife::new(Arc::new(scene), network)?;
        Ok(Self { world, model, life, decoder, muscles, other_bodies, together: None })
    }

    /// Tells what was sensed, computed and done before the step that has just been judged, and what it led to.
    fn tell(&self, recorder: &mut dyn Recorder)
    where
        W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId>,
    {
        let Self { world, life, muscles, .. } = self;
        let (judge, scene) = (life.judge(), life.judge().scene());
        let (trial, seen, earned) = (judge.trial(), judge.seen(), judge.earned());
        recorder.sensors(life.sensed());
        recorder.neurons(life.controller().hidden());
        recorder.outputs(life.done());
        let (sphere, palm) = (world.pose(Tabletop::SPHERE), world.pose(ArmAndHand::PALM));
        recorder.pose(Tabletop::SPHERE, sphere);
        recorder.pose(ArmAndHand::PALM, palm);
        self.other_bodies.iter().for_each(|body| recorder.pose(*body, world.pose(*body)));
        recorder.point(0, [sphere.position[0], sphere.position[1], sphere.position[2] + 0.05]);
        recorder.point(1, seen.palm.map(|x| x as f32));
        recorder.point(2, seen.grasp_centre.map(|x| x as f32));
        let mut forces = [0.0; 17];
        for pair in (0..world.pairs()).map(|pair| PairId(pair as u16)).filter(|pair| world.touches(*pair)) {
            let contact = world.pair_contact(pair);
            recorder.contact(pair, &contact);
            if let Some(at) = on_sphere(scene).position(|other| other == pair) {
                forces[at] = f64::from(contact.normal_force);
            }
        }

        let Ledger { reach, grasp, lift, .. } = trial.ledger;
        let mut scalars = [0.0; SCALARS];
        let rest = scalars.as_mut_slice();
        let rest = put(rest, [trial.phase.index() as f64]);
        let rest = put(rest, [earned.reach, earned.grasp, earned.lift, reach + grasp + lift]);
        let rest = put(rest, [seen.reach_distance, seen.grasp_distance, seen.openness, seen.palm_down, seen.height]);
        let rest = put(rest, [f64::from(seen.contacts)]);
        let rest = put(rest, palm.position.map(f64::from));
        let rest = put(rest, sphere.position.map(f64::from));
        let rest = put(rest, sphere.rotation.map(f64::from));
        let positions = ArmAndHand::joints().map(|joint| world.position(joint));
        let mut rest = put(rest, positions.map(f64::from));
        let driven = ArmAndHand::joints().into_iter().zip(positions).zip(life.done().chunks_exact(2));
        for (muscle, ((joint, q), done)) in muscles.iter().zip(driven) {
            let qdot = world.speed(joint);
            let torque = muscle.effort(q, qdot, [done[0], done[1]]).torque;
            let [agonist, antagonist] = muscle.lengths(q);
            rest = put(rest, [agonist, antagonist, torque].map(f64::from));
        }
        let rest = put(rest, forces);
        let rest = put(rest, ArmAndHand::joints().map(|joint| f64::from(world.speed(joint))));
        let Twist { linear, angular } = world.velocity(Tabletop::SPHERE);
        let rest = put(put(rest, linear.map(f64::from)), angular.map(f64::from));
        debug_assert!(rest.is_empty(), "{} scalars are missing", rest.len());
        recorder.scalars(&scalars);
        // Rounded to the nanosecond: 201 steps of 0.01 s print as 2.01.
        recorder.tick((f64::from(trial.steps) * scene.config.time_step * 1e9).round() / 1e9);
    }

    fn outcome(judge: &Judge) -> Outcome {
        let time_step = judge.scene().config.time_step;
        let trial = judge.trial();
        let Ledger { reach, grasp, lift, bonus } = trial.ledger;
        let second = judge.scene().config.steps_per_second();
        // What the printed reward alone would call a success: any height will do.
        let printed = trial.lifted >= second && !trial.fallen;
        Outcome {
            terms: vec![reach, grasp, lift, bonus],
            steps: trial.steps,
            success: judge.succeeds(),
            notes: vec![
                ("phase", Note::from(trial.phase.name())),
                ("end", Note::from(if trial.fallen { "sphere fell" } else { "time" })),
                ("off the table", Note::from(if printed { "yes" } else { "no" })),
                ("held [s]", Note::from(f64::from(trial.held) * time_step)),
                ("height [cm]", Note::from(judge.seen().height)),
                ("highest [cm]", Note::from(trial.highest)),
            ],
        }
    }
}

impl<W> Setup for Lives<W>
where
    W: farsa_body::World
        + Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + Send,
{
    fn genes(&self) -> usize {
        self.decoder.parameters.len()
    }

    fn trials(&self) -> usize {
        TRIALS
    }

    fn terms(&self) -> Vec<String> {
        ["reach", "grasp", "lift", "bonus"].map(String::from).to_vec()
    }

    fn stage(&self) -> Stage {
        let scene = self.life.judge().scene();
        let forces = on_sphere(scene).map(|pair| {
            let colliders = scene.robot.pairs[pair.index()].colliders.map(|c| scene.robot.colliders[c].name.as_str());
            let other = if colliders[0] == "sphere" { colliders[1] } else { colliders[0] };
            Channel::new(&format!("force on sphere.{other} [N]")).group("force")
        });
        let phases = Phase::ALL.map(Phase::name);
        let fitness = ["reward.reach", "reward.grasp", "reward.lift", "reward so far"];
        let judged = ["ds [cm]", "graspQ [cm]", "fOpen", "pRot", "height [cm]", "contacts"];
        let placed = ["palm.x [m]", "palm.y [m]", "palm.z [m]", "sphere.x [m]", "sphere.y [m]", "sphere.z [m]"];
        let turned = ["sphere.qx", "sphere.qy", "sphere.qz", "sphere.qw"];
        let moved = ["sphere.vx [m/s]", "sphere.vy [m/s]", "sphere.vz [m/s]"].into_iter();
        let moved = moved.chain(["sphere.wx [rad/s]", "sphere.wy [rad/s]", "sphere.wz [rad/s]"]);
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let joints = scene.robot.segments.iter().take(27).enumerate().map(|(i, segment)| {
            let [low, high] = segment.joint.range;
            Channel::new(&format!("J{} [rad]", i + 1)).group("joint").range(low, high)
        });
        let muscles = (1..=7).flat_map(|n| {
            [format!("J{n} agonist length"), format!("J{n} antagonist length"), format!("J{n} torque [N m]")]
        });
        let scalars = core::iter::once(Channel::new("phase").group("phase").words(&phases))
            .chain(fitness.into_iter().chain(judged).map(in_group("fitness")))
            .chain(placed.into_iter().chain(turned).map(in_group("place")))
            .chain(joints)
            .chain(muscles.map(|name| in_group("actuator")(&name)))
            .chain(forces)
            .chain((1..=27).map(|n| in_group("speed")(&format!("J{n} [rad/s]"))))
            .chain(moved.map(in_group("speed")))
            .collect();
        let mut stage = Stage::of_robot(&scene.robot)
            .with_sensors(self.life.senses().names())
            .with_outputs(self.life.motors().names())
            .with_network(&scene.config.layout());
        stage.outputs.iter_mut().for_each(|output| output.range = Some([0.0, 1.0]));
        Stage {
            scalars,
            points: ["palm's target", "palm's centre", "centre of the grasp"].map(String::from).into(),
            ..stage
        }
    }

    fn mjcf_options(&self) -> MjcfOptions {
        let scene = self.life.judge().scene();
        scene.mjcf_options()
    }

    fn controller(&self, genes: &[u16]) -> Option<ControllerExport> {
        let (scene, life) = (self.life.judge().scene(), &self.life);
        let config = &scene.config;
        let mut decoder = Decoder::new(config.layout(), config.leak, config.weight_range as f32).ok()?;
        let network =
            decoder.decode(genes).then(|| NetworkExport::new(&config.layout(), config.leak, &decoder.parameters));
        Some(scene.controller(network?, life.senses().names(), life.motors().names()))
    }

    fn start(&self, job: Job) -> Option<StartExport> {
        Some(self.life.judge().scene().start_by_name(job))
    }

    fn description(&self) -> Description {
        let config = &self.life.judge().scene().config;
        let saturation = config.touch_saturation;
        let mut sensors = vec![
            ChannelGroup::new("arm joints", 7, "J1..J7, 0 at the lower and 1 at the upper limit"),
            ChannelGroup::new(
                "hand joints",
                10,
                "J8 J9 J10 J13 J14 J17 J18 J21 J22, 0 extended and 1 flexed; J16, 0 at the lower and 1 at the upper limit",
            ),
            ChannelGroup::new(
                "touch",
                6,
                &format!("thumb, index, middle, ring, little finger, palm: touching pairs / {saturation}, at most 1"),
            ),
            ChannelGroup::new("sphere position", 3, "sphere's centre relative to the palm's, x, y, z [cm]"),
        ];
        if config.labels {
            let meaning = format!("{} for the present phase (reach, grasp, lift), else 0", config.label_amplitude);
            sensors.push(ChannelGroup::new("label", 3, &meaning));
        }
        let motors = vec![
            ChannelGroup::new("muscles", 14, "activation of agonist and antagonist of J1..J7, 0..1"),
            ChannelGroup::new(
                "servo groups",
                9,
                "J8; J9; J10 J11; J13; J14 J15; J17; J18 J19; abduction J12 J16 J20 J24; J21-J23 J25-J27: 0 extended or \
                 together, 1 flexed or spread",
            ),
        ];
        let layout = config.layout();
        let leak = config.leak.name();
        Description {
            sensors,
            motors,
            network: format!(
                "{}-{}-{}, recurrent hidden layer, leak {leak}",
                layout.sensors(),
                layout.hidden(),
                layout.outputs()
            ),
            parameters: layout.parameter_count(),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }

    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        if !self.decoder.decode_into(genes, &mut self.life) {
            return Outcome::failed();
        }
        if let Some(recorder) = tape.recorder() {
            recorder.parameters(&self.decoder.parameters);
        }
        self.life.start(&mut self.world, job);
        loop {
            self.life.act(&mut self.world);
            self.world.step();
            let end = self.life.judge_mut().judge(&self.world);
            if let Some(recorder) = tape.recorder() {
                self.tell(recorder);
            }
            if end.is_some() {
                return Self::outcome(self.life.judge());
            }
        }
    }

    fn use_lanes(&mut self, lanes: Lanes) -> Result<Lanes, Error> {
        self.together = None;
        let Some(model) = &self.model else { return Ok(Lanes::one()) };
        if lanes.count() > 1 {
            let batch = Batch::new(model.clone(), lanes.count(), lanes.level());
            let batch = batch.map_err(|error| Error::Other(format!("reach-grasp-lift: {error}")))?;
            let lives = (0..lanes.count()).map(|_| Numbered { life: self.life.clone(), number: 0 }).collect();
            self.together = Some(Together { batch, lives });
        }
        Ok(lanes)
    }

    fn live_many<'g>(&mut self, next: &mut dyn FnMut() -> Option<Task<'g>>, done: &mut dyn FnMut(usize, Outcome)) {
        let Self { together: Some(Together { batch, lives }), decoder, .. } = self else {
            while let Some(Task { number, genes, job, .. }) = next() {
                done(number, self.live(genes, job, &mut Tape::off()));
            }
            return;
        };
        // What came of the tasks that have no life waits until the borrowed `done` is free.
        let done = std::cell::RefCell::new(done);
        let begin = |Numbered { life, number }: &mut Numbered| {
            loop {
                let task = next()?;
                *number = task.number;
                if decoder.decode_into(task.genes, life) {
                    return Some(task.job);
                }
                done.borrow_mut()(task.number, Outcome::failed());
            }
        };
        let end = |lived: &mut Numbered, _: f64| done.borrow_mut()(lived.number, Self::outcome(lived.life.judge()));
        live_in_lanes(lives, batch, begin, end);
    }

    fn fitness(&self, trials: &[Outcome]) -> f64 {
        let mut sum = Ledger::default();
        for outcome in trials {
            let [reach, grasp, lift, bonus] = outcome.terms[..] else { return f64::NAN };
            sum.add(&Ledger { reach, grasp, lift, bonus });
        }
        sum.total()
    }
}

/// From genes to the network's parameters.
struct Decoder {
    layout: Layout,
    ranges: Vec<GeneRange>,
    /// Leaks are |p| / range of what is decoded like a weight, as in the original program.
    evonet: Option<f32>,
    parameters: Vec<f32>,
}

impl Decoder {
    fn new(layout: Layout, leak: Leak, range: f32) -> Result<Self, Error> {
        let evonet = (leak == Leak::Evonet).then_some(range);
        let leaks = if evonet.is_some() { (-range, range) } else { (0.0, 1.0) };
        let mut ranges = Vec::new();
        for kind in ParameterKind::ALL {
            let (low, high) = if kind == ParameterKind::Leak { leaks } else { (-range, range) };
            let genes = GeneRange::new(layout.range(kind).len(), low, high);
            ranges.push(genes.map_err(|error| Error::setting("network.range", error))?);
        }
        Ok(Self { layout, ranges, evonet, parameters: vec![0.0; layout.parameter_count()] })
    }

    /// Gives a life its parameters; false for a genome of another length or a range of weights that f32 cannot hold.
    fn decode_into(&mut self, genes: &[u16], life: &mut NetworkLife) -> bool {
        let decoded = self.decode(genes) && life.controller_mut().copy_parameters(&self.parameters).is_ok();
        debug_assert!(decoded, "{} genes for {} parameters", genes.len(), self.parameters.len());
        decoded
    }

    fn decode(&mut self, genes: &[u16]) -> bool {
        let decoded = decode(genes, &self.ranges, &mut self.parameters).is_ok();
        if let Some(range) = self.evonet {
            for leak in &mut self.parameters[self.layout.range(ParameterKind::Leak)] {
                let share = leak.abs() / range;
                // A range of 0 gives NaN: no memory, as for p = 0.
                *leak = if share < 1.0 {
                    share
                } else if share >= 1.0 {
                    1.0
                } else {
                    0.0
                };
            }
        }
        decoded
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Recording;

    #[test]
    fn genes_become_parameters_of_their_kinds() {
        let layout = Config::default().layout();
        let mut decoder = Decoder::new(layout, Leak::Filter, 6.0).unwrap();
        assert!(!decoder.decode(&[0; 791]));
        let mut genes = vec![u16::MAX; 792];
        genes[791] = 0;
        assert!(decoder.decode(&genes));
        let parts = layout.split(&decoder.parameters);
        assert!(parts.sensor_weights.iter().chain(parts.biases).all(|p| *p == 6.0));
        assert_eq!(parts.leaks[..11], [1.0; 11]);
        assert_eq!(parts.leaks[11], 0.0);
        let mut decoder = Decoder::new(layout, Leak::Evonet, 6.0).unwrap();
        genes[790] = 1 << 15;
        assert!(decoder.decode(&genes));
        let leaks = layout.split(&decoder.parameters).leaks;
        assert_eq!((leaks[0], leaks[11]), (1.0, 1.0));
        assert!(leaks[10] < 1e-4);
        assert!(Decoder::new(layout, Leak::Filter, f32::NAN).is_err());
    }

    #[test]
    fn both_conditions_have_the_sizes_of_the_source() {
        for (condition, sensors, parameters) in [(LABELS, 29, 792), (NO_LABELS, 26, 756)] {
            let settings = Settings::new(ReachGraspLift.settings(condition)).unwrap();
            let setup = ReachGraspLift.prepare(condition, &settings).unwrap();
            assert_eq!(setup.genes(), parameters);
            let description = setup.description();
            assert_eq!(description.parameters, parameters);
            assert_eq!(description.sensors.iter().map(|group| group.count).sum::<usize>(), sensors);
            assert_eq!(description.motors.iter().map(|group| group.count).sum::<usize>(), 23);
            assert_eq!((description.steps, description.step_seconds), (600, 0.01));
            assert_eq!(setup.stage().columns().len(), SCALARS + sensors + 12 + 23);
        }
    }

    #[test]
    fn a_life_can_be_repeated_and_taped() {
        let settings = Settings::new(ReachGraspLift.settings(LABELS)).unwrap();
        let mut setup = ReachGraspLift.prepare(LABELS, &settings).unwrap();
        let genes: Vec<u16> = (0..792u32).map(|i| (i * 40503) as u16).collect();
        let job = Job { seed: 3, generation: 2, individual: 7, trial: 1 };
        let plain = setup.live(&genes, job, &mut Tape::off());
        setup.live(&genes, Job { trial: 3, ..job }, &mut Tape::off());
        let mut recording = Recording::new(setup.stage());
        let taped = setup.live(&genes, job, &mut Tape::to(&mut recording));
        assert_eq!(plain, taped);
        assert!(plain.is_finite(), "{plain:?}");
        let ticks = plain.steps as usize;
        assert_eq!(recording.times().len(), ticks);
        assert!((0..ticks).all(|tick| recording.row(tick).all(f64::is_finite)));
        // The rewards of the steps add up to the terms.
        let columns = setup.stage().columns();
        let value = |tick: usize, name: &str| {
            let column = columns.iter().position(|c| c == name).unwrap();
            recording.row(tick).nth(column).unwrap()
        };
        for (term, name) in ["reward.reach", "reward.grasp", "reward.lift"].into_iter().enumerate() {
            let sum = (0..ticks).fold(0.0, |sum, tick| sum + value(tick, name));
            assert_eq!(sum, plain.terms[term]);
        }
        assert_eq!(value(ticks - 1, "reward so far"), plain.terms[..3].iter().sum::<f64>());
        // Bodies and scalars tell the same.
        for tick in [0, ticks / 2, ticks - 1] {
            for (body, name) in [(ArmAndHand::PALM, "palm.x [m]"), (Tabletop::SPHERE, "sphere.x [m]")] {
                assert_eq!(f64::from(recording.pose_at(tick, body).unwrap().position[0]), value(tick, name));
            }
        }
        // The whole life as `Life` lives it: the same fitness.
        let mut lives = Lives::new(Config::default()).unwrap();
        assert!(lives.decoder.decode(&genes));
        lives.life.controller_mut().copy_parameters(&lives.decoder.parameters).unwrap();
        let fitness = crate::life::live(&mut lives.life, &mut lives.world, job);
        assert_eq!(fitness, setup.fitness(core::slice::from_ref(&plain)));
        // Shared by the generation's individuals, another in the next generation.
        let again = setup.live(&genes, Job { individual: 8, ..job }, &mut Tape::off());
        assert_eq!(again, plain);
        assert_ne!(setup.live(&genes, Job { generation: 3, ..job }, &mut Tape::off()), plain);
    }

    #[test]
    fn a_failed_trial_fails_the_individual() {
        let setup = Lives::new(Config::default()).unwrap();
        let good = Outcome { terms: vec![1.0, 2.0, 3.0, 300.0], ..Outcome::default() };
        assert_eq!(setup.fitness(&[good.clone(), good.clone()]), 612.0);
        assert!(setup.fitness(&[good, Outcome::failed()]).is_nan());
    }
}
