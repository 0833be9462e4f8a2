//! The experiment `reach-grasp-lift` as the `farsa` command runs it.

pub use crate::fitness::{ContactTerm, GRASP_CAP, Judgement, LIFT_CAP, Ledger, REACH_CAP, Trial};
pub use crate::phase::{Observation, Phase};
pub use crate::reach_grasp_lift_config::{Config, Displacement, Engine, SphereFrame, TRIALS};
pub use crate::reach_grasp_lift_life::{Judge, ReachLife};
pub use crate::reach_grasp_lift_scene::{Motors, OUTPUTS, Scene, Senses};
pub use crate::script::{Plan, ScriptLife, Statics, Timetable};

use std::sync::Arc;

use farsa_body::{Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, MjcfOptions};
use farsa_nn::Network;
use farsa_physics::articulated::{Batch, Model, World};

use crate::controller_export::{ControllerExport, NetworkExport, StartExport};
use crate::error::Error;
use crate::experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape, Task};
use crate::lanes::Lanes;
use crate::life::{Job, Life};
use crate::live_in_lanes::live_in_lanes;
use crate::reach_grasp_lift_decoder::Decoder;
use crate::reach_grasp_lift_stage::{NetworkLife, Teller};
use crate::settings::{Setting, Settings};
use crate::stage::Stage;

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
    teller: Teller,
    /// For lives side by side.
    together: Option<Together>,
}

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
        let teller = Teller::new(&scene);
        let life = ReachLife::new(Arc::new(scene), network)?;
        Ok(Self { world, model, life, decoder, teller, together: None })
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
        Teller::stage(&self.life)
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
                self.teller.tell(&self.world, &self.life, recorder);
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
            let batch = Batch::new(model.clone(), lanes.count(), lanes.instructions());
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

#[cfg(test)]
mod tests {
    use farsa_body::{ArmAndHand, Tabletop};

    use super::*;
    use crate::reach_grasp_lift_stage::SCALARS;
    use crate::recording::Recording;

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
