//! The experiment `reach-grasp-lift` as the `farsa` command runs it.

pub use crate::fitness::{ContactTerm, GRASP_CAP, Judgement, LIFT_CAP, Ledger, REACH_CAP, Trial};
pub use crate::phase::{Observation, Phase};
pub use crate::reach_grasp_lift_config::{Config, Displacement, SphereFrame, TRIALS};
pub use crate::reach_grasp_lift_life::{Judge, ReachLife};
pub use crate::reach_grasp_lift_scene::{Motors, OUTPUTS, Scene, Senses};
pub use crate::script::{Plan, ScriptLife, Statics, Timetable};

use std::sync::Arc;

use farsa_body::{ArmAndHand, Contacts, Joints, Kinematics, Tabletop, World as _};
use farsa_evo::{GeneRange, decode};
use farsa_nn::{Layout, Leak, Network, ParameterKind};
use farsa_physics::articulated::{Model, World};

use crate::error::Error;
use crate::experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape};
use crate::life::{Job, Life};
use crate::settings::{Setting, Settings};

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
        Ok(Box::new(Lives::new(Config::read(condition != NO_LABELS, settings)?)?))
    }
}

/// The scene in its world with a network that genes are decoded into: everything that a thread needs to live lives.
pub struct Lives {
    world: World<f32>,
    life: ReachLife<Network<Vec<f32>, Vec<f32>>>,
    decoder: Decoder,
    row: Vec<f64>,
}

impl Lives {
    /// Lives under a configuration.
    ///
    /// # Errors
    /// [`Error::Other`] for a configuration whose robot or network cannot be built.
    pub fn new(config: Config) -> Result<Self, Error> {
        let layout = config.layout();
        let wrong = |error: &dyn std::fmt::Display| Error::Other(format!("reach-grasp-lift: {error}"));
        let decoder = Decoder::new(layout, config.leak, config.weight_range as f32)?;
        let (zeros, state) = (vec![0.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
        let network = Network::new(layout, config.leak, zeros, state).map_err(|error| wrong(&error))?;
        let scene = Scene::new(config)?;
        let model = Model::new(&scene.robot, &scene.config.options()).map_err(|error| wrong(&error))?;
        let life = ReachLife::new(Arc::new(scene), network)?;
        Ok(Self { world: World::new(model), life, decoder, row: Vec::new() })
    }

    /// One row of the tape: what was sensed, computed and done before the step that has just been judged, and what it led to.
    fn write_row(&mut self, tape: &mut Tape<'_>) {
        let Self { world, life, row, .. } = self;
        let (judge, scene) = (life.judge(), life.judge().scene());
        row.clear();
        // Rounded to the nanosecond: 201 steps of 0.01 s print as 2.01.
        row.push((f64::from(judge.trial().steps) * scene.config.time_step * 1e9).round() / 1e9);
        row.extend(ArmAndHand::joints().map(|joint| f64::from(world.position(joint))));
        let sphere = world.pose(Tabletop::SPHERE);
        row.extend(sphere.position.iter().chain(&sphere.rotation).copied().map(f64::from));
        let (sensed, hidden, done) = (life.sensed(), life.controller().hidden(), life.done());
        row.extend(sensed.iter().chain(hidden).chain(done).copied().map(f64::from));
        let (trial, seen, earned) = (judge.trial(), judge.seen(), judge.earned());
        row.push(trial.phase.index() as f64);
        row.extend([earned.reach, earned.grasp, earned.lift]);
        row.extend([seen.reach_distance, seen.grasp_distance, seen.openness, seen.palm_down, seen.height]);
        row.push(f64::from(seen.contacts));
        let pairs = scene.sphere_on_phalanges.into_iter().chain([scene.sphere_on_palm, scene.sphere_on_table]);
        row.extend(pairs.map(|pair| f64::from(world.pair_contact(pair).normal_force)));
        tape.row(row);
    }

    fn outcome(&self) -> Outcome {
        let (judge, time_step) = (self.life.judge(), self.life.judge().scene().config.time_step);
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

impl Setup for Lives {
    fn genes(&self) -> usize {
        self.decoder.parameters.len()
    }

    fn trials(&self) -> usize {
        TRIALS
    }

    fn terms(&self) -> Vec<String> {
        ["reach", "grasp", "lift", "bonus"].map(String::from).to_vec()
    }

    fn columns(&self) -> Vec<String> {
        let scene = self.life.judge().scene();
        let joints = (1..=27).map(|n| format!("J{n} [rad]"));
        let sphere = ["x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw"].map(|part| format!("sphere.{part}"));
        let sensors = self.life.senses().names().into_iter().map(|name| format!("sensor.{name}"));
        let hidden = (1..=scene.config.hidden).map(|n| format!("hidden.{n}"));
        let outputs = self.life.motors().names().into_iter().map(|name| format!("output.{name}"));
        let judged = [
            "phase",
            "reward.reach",
            "reward.grasp",
            "reward.lift",
            "ds [cm]",
            "graspQ [cm]",
            "fOpen",
            "pRot",
            "height [cm]",
            "contacts",
        ];
        let touched = scene.sphere_on_phalanges.into_iter().chain([scene.sphere_on_palm, scene.sphere_on_table]);
        let forces = touched.map(|pair| {
            let colliders = scene.robot.pairs[pair.index()].colliders.map(|c| scene.robot.colliders[c].name.as_str());
            let other = if colliders[0] == "sphere" { colliders[1] } else { colliders[0] };
            format!("force on sphere.{other} [N]")
        });
        core::iter::once("time [s]".to_owned())
            .chain(joints)
            .chain(sphere)
            .chain(sensors)
            .chain(hidden)
            .chain(outputs)
            .chain(judged.map(String::from))
            .chain(forces)
            .collect()
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
        // A genome of another length, or a range of weights that f32 cannot hold, has no life.
        let decoded = self.decoder.decode(genes);
        if !decoded || self.life.controller_mut().copy_parameters(&self.decoder.parameters).is_err() {
            debug_assert!(false, "{} genes for {} parameters", genes.len(), self.decoder.parameters.len());
            return Outcome::failed();
        }
        self.life.start(&mut self.world, job);
        loop {
            self.life.act(&mut self.world);
            self.world.step();
            let end = self.life.judge_mut().judge(&self.world);
            if tape.is_on() {
                self.write_row(tape);
            }
            if end.is_some() {
                return self.outcome();
            }
        }
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
            assert_eq!(setup.columns().len(), 1 + 27 + 7 + sensors + 12 + 23 + 10 + 17);
        }
    }

    #[test]
    fn a_life_can_be_repeated_and_taped() {
        let settings = Settings::new(ReachGraspLift.settings(LABELS)).unwrap();
        let mut setup = ReachGraspLift.prepare(LABELS, &settings).unwrap();
        let genes: Vec<u16> = (0..792u32).map(|i| (i * 40503) as u16).collect();
        let job = Job { seed: 3, generation: 2, individual: 7, trial: 1 };
        let plain = setup.live(&genes, job, &mut Tape::off());
        let mut rows = Vec::new();
        let width = setup.columns().len();
        let mut keep = |row: &[f64]| {
            assert_eq!(row.len(), width);
            rows.push(row.to_vec());
        };
        setup.live(&genes, Job { trial: 3, ..job }, &mut Tape::off());
        let taped = setup.live(&genes, job, &mut Tape::to(&mut keep));
        assert_eq!(plain, taped);
        assert!(plain.is_finite(), "{plain:?}");
        assert_eq!(rows.len(), plain.steps as usize);
        // The rewards of the steps add up to the terms.
        let columns = setup.columns();
        for (term, name) in ["reward.reach", "reward.grasp", "reward.lift"].into_iter().enumerate() {
            let column = columns.iter().position(|c| c == name).unwrap();
            let sum = rows.iter().fold(0.0, |sum, row| sum + row[column]);
            assert_eq!(sum, plain.terms[term]);
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
