//! Registration of `reach-grasp-lift` as an experiment of the `farsa` command.

use farsa_physics::articulated::{Batch, Model, World};

use crate::reach_grasp_lift::config::{Config, Labels};
use crate::reach_grasp_lift::scene::Scene;
use crate::reach_grasp_lift::task::ReachTask;
use crate::worlds::Engine;
use farsa_lab::advanced::Lanes;
use farsa_lab::{Error, Evaluator, Experiment, InWorld, Setting, Settings};

/// Tests if the labels of a caretaker help a robot to learn manipulation \[Ferrauto2010, chapter 2\] \[Massera2010\].
///
/// A simulated arm and hand, similar to those of the iCub, evolve to reach for a sphere, grasp it and lift it. With the
/// condition `labels` (A), three additional inputs indicate the phase of the task. The condition `no-labels` (B)
/// removes these inputs. With the condition `self-labels`, they are outputs of the network in the previous step. All
/// values that the source does not specify are settings. They also state the reasons for the choice. See [`Config`] for
/// a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ReachGraspLift;

impl Experiment for ReachGraspLift {
    fn name(&self) -> &'static str {
        "reach-grasp-lift"
    }

    fn summary(&self) -> &'static str {
        "an arm and hand learn to reach, grasp and lift a sphere, with or without labels that name the phase"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &Labels::NAMES
    }

    // 2: contacts of palm and table are those of two boxes. 3: dynamics steps of 5 ms in halves, and sweeps that settle.
    fn values_version(&self) -> u32 {
        3
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        Config::for_condition(Labels::from_name(condition)).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        let config = Config::read(Labels::from_name(condition), settings)?;
        match config.engine {
            Engine::Articulated => Ok(Box::new(evaluator(config)?)),
            #[cfg(feature = "rapier")]
            Engine::Rapier => Ok(Box::new(evaluator_in_rapier(config)?)),
            #[cfg(not(feature = "rapier"))]
            Engine::Rapier => Err(config.engine.missing()),
        }
    }
}

fn wrong(error: &dyn std::fmt::Display) -> Error {
    Error::Other(format!("reach-grasp-lift: {error}"))
}

/// Creates an evaluator for the given configuration. It uses the articulated world.
///
/// # Errors
/// Returns [`Error::Other`] if the robot or the network cannot be built.
pub fn evaluator(config: Config) -> Result<InWorld<World<f32>, ReachTask>, Error> {
    let scene = Scene::new(config)?;
    let model = Model::new(&scene.robot, &scene.config.options()).map_err(|error| wrong(&error))?;
    let world = World::new(model.clone());
    let batch = move |lanes: Lanes| {
        Batch::new(model.clone(), lanes.count(), lanes.instructions()).map_err(|error| wrong(&error))
    };
    Ok(InWorld::new(world, ReachTask::new(scene)?).with_lanes(batch).with_displacements().with_pushes())
}

/// Creates an evaluator for the given configuration. It uses rapier.
///
/// # Errors
/// Returns the same errors as [`evaluator`].
#[cfg(feature = "rapier")]
pub fn evaluator_in_rapier(config: Config) -> Result<InWorld<farsa_physics::rapier::World, ReachTask>, Error> {
    let scene = Scene::new(config)?;
    let world = farsa_physics::rapier::World::new(&scene.robot, &scene.config.rapier_options());
    let world = world.map_err(|error| wrong(&error))?;
    Ok(InWorld::new(world, ReachTask::new(scene)?))
}

#[cfg(test)]
mod tests {
    use farsa_body::Recorder;
    use farsa_body::robots::{ArmAndHand, Tabletop};
    use farsa_lab::advanced::{Genotype, Rollout as _, run_episode};
    use farsa_lab::{EpisodeId, Evaluation, Outcome, Task as _};
    use farsa_view::Recording;

    use super::*;
    use crate::reach_grasp_lift::schema::SCALARS;

    fn evaluation(parameters: &[f32], id: EpisodeId) -> Evaluation<'_> {
        Evaluation::new(parameters, id)
    }

    #[test]
    fn the_conditions_have_their_sizes() {
        // The numbers of parameters of the first two are those of the source.
        let sizes = [("labels", 29, 23, 792), ("no-labels", 26, 23, 756), ("self-labels", 29, 26, 828)];
        for (condition, sensors, outputs, parameters) in sizes {
            let settings = Settings::new(ReachGraspLift.settings(condition)).unwrap();
            let evaluator = ReachGraspLift.prepare(condition, &settings).unwrap();
            assert_eq!(evaluator.info().parameters.len(), parameters);
            let description = evaluator.info().description;
            assert_eq!(description.parameters, parameters);
            assert_eq!(description.sensors.iter().map(|group| group.count).sum::<usize>(), sensors);
            assert_eq!(description.motors.iter().map(|group| group.count).sum::<usize>(), outputs);
            assert_eq!((description.steps, description.step_seconds), (600, 0.01));
            assert_eq!(evaluator.info().schema.columns().len(), SCALARS + sensors + 12 + outputs);
        }
    }

    #[test]
    fn an_episode_can_be_repeated_and_recorded() {
        let settings = Settings::new(ReachGraspLift.settings("labels")).unwrap();
        let mut evaluator = ReachGraspLift.prepare("labels", &settings).unwrap();
        let genes: Vec<u16> = (0..792u32).map(|i| (i * 40503) as u16).collect();
        let genotype = Genotype::new(&evaluator.info().parameters, ReachGraspLift.gene_bits());
        let parameters = genotype.decode(&genes).unwrap();
        let id = EpisodeId { seed: 3, generation: 2, individual: 7, trial: 1 };
        let schema = evaluator.info().schema;
        let mut evaluate =
            |id, recorder: Option<&mut dyn Recorder>| evaluator.evaluate(evaluation(&parameters, id), recorder);
        let plain = evaluate(id, None);
        evaluate(EpisodeId { trial: 3, ..id }, None);
        let mut recording = Recording::new(schema.clone());
        let recorded = evaluate(id, Some(&mut recording));
        assert_eq!(plain, recorded);
        assert!(plain.is_finite(), "{plain:?}");
        let ticks = plain.steps as usize;
        assert_eq!(recording.times().len(), ticks);
        assert!((0..ticks).all(|tick| recording.row(tick).all(f64::is_finite)));
        // The rewards of the steps add up to the terms.
        let columns = schema.columns();
        let value = |tick: usize, name: &str| {
            let column = columns.iter().position(|c| c == name).unwrap();
            recording.row(tick).nth(column).unwrap()
        };
        for (term, name) in ["reward.reach", "reward.grasp", "reward.lift"].into_iter().enumerate() {
            let sum = (0..ticks).fold(0.0, |sum, tick| sum + value(tick, name));
            assert_eq!(sum, plain.terms[term]);
        }
        assert_eq!(value(ticks - 1, "reward so far"), plain.terms.iter().sum::<f64>());
        assert_eq!(value(ticks - 1, "reward.bonus"), plain.terms[3]);
        // Bodies and scalars agree.
        for tick in [0, ticks / 2, ticks - 1] {
            for (body, name) in [(ArmAndHand::PALM, "palm.x [m]"), (Tabletop::SPHERE, "sphere.x [m]")] {
                assert_eq!(f64::from(recording.pose_at(tick, body).unwrap().position[0]), value(tick, name));
            }
        }
        // Shared by the generation's individuals, another in the next generation.
        assert_eq!(evaluate(EpisodeId { individual: 8, ..id }, None), plain);
        assert_ne!(evaluate(EpisodeId { generation: 3, ..id }, None), plain);
        // The episode run by hand: the same fitness.
        let mut by_hand = super::evaluator(Config::default()).unwrap();
        let (task, world) = by_hand.parts_mut();
        assert!(task.load(&evaluation(&parameters, id)));
        let fitness = run_episode(task, world, id, None);
        assert_eq!(fitness, by_hand.fitness(core::slice::from_ref(&plain)));
    }

    #[test]
    fn a_failed_trial_fails_the_individual() {
        let task = evaluator(Config::default()).unwrap();
        let good = Outcome { terms: vec![1.0, 2.0, 3.0, 300.0], ..Outcome::default() };
        assert_eq!(task.fitness(&[good.clone(), good.clone()]), 612.0);
        assert!(task.fitness(&[good, Outcome::failed()]).is_nan());
    }
}
