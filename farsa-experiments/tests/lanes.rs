//! An episode in a lane is the episode alone: whole trials of scripts, networks and teams, at every instruction set of this
//! machine.
#![allow(missing_docs, clippy::unwrap_used)]

use std::sync::Arc;

use farsa_body::robots::Tabletop;
use farsa_evo::words::randomize;
use farsa_experiments::reach_grasp_lift::{Config, Scene, ScriptEpisode, TRIALS, Timetable, Trial, evaluator};
use farsa_experiments::{
    AGGREGATION, ANT, ANT_OMNI, BRAITENBERG, DISCRIMINATION, DISCRIMINATION_CYLINDERS, FORAGING, G1_WALK, GO1_JOYSTICK,
    HALF_CHEETAH, HOPPER, HUMANOID, PREDATOR_PREY, WALKER2D,
};
use farsa_lab::advanced::{Displacement, Genotype, Lanes, Push, Value, run_episode, run_in_lanes};
use farsa_lab::{Episode, EpisodeId, Evaluation, Evaluator, Experiment, Outcome, Settings};
use farsa_num::{Domain, Instructions, Stream};
use farsa_physics::articulated::{Batch, LANES, Model, World};
use farsa_physics::{arena, articulated};

/// Every number of lanes at each of these instruction sets.
fn every_batch(instructions: impl Iterator<Item = Instructions>) -> impl Iterator<Item = (usize, Instructions)> {
    instructions.flat_map(|instructions| LANES.map(|lanes| (lanes, instructions)))
}

/// A script with a number.
struct Numbered {
    episode: ScriptEpisode,
    number: usize,
}

impl<W> Episode<W> for Numbered
where
    ScriptEpisode: Episode<W>,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.episode.start(world, id);
    }
    fn act(&mut self, world: &mut W) {
        self.episode.act(world);
    }
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        Episode::judge(&mut self.episode, world)
    }
}

#[test]
fn scripted_grasps_in_lanes_are_those_alone() {
    let scene = Arc::new(Scene::new(Config::default()).unwrap());
    let model = Model::<f32>::new(&scene.robot, &scene.config.options()).unwrap();
    let script = ScriptEpisode::new(Arc::clone(&scene), Timetable::default()).unwrap();
    // More than lanes, and not a multiple: lanes are filled again while others are in the middle of a grasp.
    let id =
        |n: usize| EpisodeId { seed: 7, generation: (n / TRIALS) as u32, individual: 0, trial: (n % TRIALS) as u32 };
    let mut world = World::new(model.clone());
    let alone: Vec<(f64, Trial)> = (0..20)
        .map(|n| {
            let mut episode = script.clone();
            (run_episode(&mut episode, &mut world, id(n), None), *episode.judge().trial())
        })
        .collect();
    assert!(alone.iter().filter(|(_, trial)| trial.held > 0).count() > 15);
    for (lanes, instructions) in every_batch(articulated::Batch::instructions()) {
        let mut batch = Batch::new(model.clone(), lanes, instructions).unwrap();
        // In some lanes only: the others stay empty.
        let mut episodes: Vec<_> = (0..lanes - 1).map(|_| Numbered { episode: script.clone(), number: 0 }).collect();
        let (mut next, mut ended) = (0, vec![None; alone.len()]);
        let begin = |numbered: &mut Numbered| {
            numbered.number = next;
            next += 1;
            (numbered.number < alone.len()).then(|| id(numbered.number))
        };
        let end = |numbered: &mut Numbered, fitness: f64| {
            ended[numbered.number] = Some((fitness, *numbered.episode.judge().trial()));
        };
        run_in_lanes(&mut episodes, &mut batch, begin, end);
        let ended: Vec<_> = ended.into_iter().flatten().collect();
        assert_eq!(ended, alone, "{lanes} lanes, {instructions:?}");
    }
}

/// The parameters of random genes.
fn random_parameters(evaluator: &dyn Evaluator, bits: u32, seed: u64, individual: u32) -> Vec<f32> {
    let genotype = Genotype::new(&evaluator.info().parameters, bits);
    let mut genes = vec![0; genotype.genes()];
    randomize(&mut genes, &mut Stream::new(seed, Domain::InitialGenome, 0, individual, 0));
    for gene in &mut genes {
        *gene &= genotype.largest();
    }
    genotype.decode(&genes).unwrap()
}

/// Evaluates in lanes of every number and instruction set, and one after the other by the same trait. Returns the outcomes of
/// `evaluate`, with which it compares them.
fn in_lanes_as_alone(
    evaluator: &mut dyn Evaluator,
    instructions: impl Iterator<Item = Instructions>,
    evaluations: &[Evaluation<'_>],
) -> Vec<Outcome> {
    // More than lanes: they are filled again.
    assert!(evaluations.len() > LANES[1] && !evaluations.len().is_multiple_of(LANES[0]));
    let alone: Vec<Outcome> = evaluations.iter().map(|evaluation| evaluator.evaluate(*evaluation, None)).collect();
    assert!(alone.iter().all(Outcome::is_finite), "{alone:?}");
    for (count, instructions) in every_batch(instructions).chain([(1, Instructions::detect())]) {
        let lanes = evaluator.in_lanes().expect("lanes");
        lanes.use_lanes(Lanes::new(count, instructions).unwrap()).unwrap();
        // Twice: nothing of the first time is left.
        for _ in 0..2 {
            let (mut rest, mut ended) = (evaluations.iter().copied(), vec![None; alone.len()]);
            lanes.run_in_lanes(&mut || rest.next(), &mut |number, outcome| {
                assert!(ended[number].replace(outcome).is_none(), "{number} twice");
            });
            for (number, (ended, alone)) in ended.iter().zip(&alone).enumerate() {
                assert_eq!(ended.as_ref(), Some(alone), "{number}: {count} lanes, {instructions:?}");
            }
        }
    }
    alone
}

#[test]
fn trials_of_networks_in_lanes_are_those_alone() {
    let mut evaluator = evaluator(Config::default()).unwrap();
    let genotype = Genotype::new(&farsa_lab::Task::info(&evaluator).parameters, 16);
    let parameters: Vec<Vec<f32>> = (0..10)
        .map(|individual| {
            let mut stream = Stream::new(3, Domain::InitialGenome, 0, individual, 0);
            let genes: Vec<u16> = (0..genotype.genes()).map(|_| (65535.0 * stream.uniform()) as u16).collect();
            genotype.decode(&genes).unwrap()
        })
        .collect();
    // In every third the sphere is put in another place.
    let (position, rotation) = ([0.3, -0.2, 0.4], [0.0, 0.0, 0.0, 1.0]);
    let moved = [Displacement { step: 20, body: Tabletop::SPHERE.0, position, rotation }];
    // And in every fifth it is pushed.
    let pushed = [Push { steps: [5, 15], body: Tabletop::SPHERE.0, point: [0.0; 3], force: [2.0, 0.0, 1.0] }];
    let evaluation = |number: usize| {
        let (individual, trial) = (number / TRIALS, number % TRIALS);
        let id = EpisodeId { seed: 3, generation: 1, individual: individual as u32, trial: trial as u32 };
        let displacements = if number.is_multiple_of(3) { &moved[..] } else { &[] };
        let pushes = if number.is_multiple_of(5) { &pushed[..] } else { &[] };
        Evaluation { number, displacements, pushes, ..Evaluation::new(&parameters[individual], id) }
    };
    // 39, which is no multiple of the lanes.
    let evaluations: Vec<Evaluation> = (0..10 * TRIALS - 1).map(evaluation).collect();
    let alone = in_lanes_as_alone(&mut evaluator, articulated::Batch::instructions(), &evaluations);
    for (evaluation, outcome) in evaluations.iter().zip(&alone) {
        let still = evaluator.evaluate(Evaluation { displacements: &[], pushes: &[], ..*evaluation }, None);
        let untouched = evaluation.displacements.is_empty() && evaluation.pushes.is_empty();
        assert_eq!(still == *outcome, untouched, "{}", evaluation.number);
    }
    println!("steps: {:?}", alone.iter().map(|outcome| outcome.steps).collect::<Vec<_>>());
}

/// Trials of an experiment with wheeled robots, each with random parameters and its own start. Returns their outcomes.
///
/// Where there are several populations, every other trial is one of the second.
fn wheels(experiment: &dyn Experiment, condition: &str, values: &[(&str, Value)]) -> Vec<Outcome> {
    trials(experiment, condition, values, arena::Batch::instructions())
}

fn trials(
    experiment: &dyn Experiment,
    condition: &str,
    values: &[(&str, Value)],
    instructions: impl Iterator<Item = Instructions>,
) -> Vec<Outcome> {
    let mut settings = Settings::new(experiment.settings(condition)).unwrap();
    for (key, value) in values {
        settings.set("", key, value.clone()).unwrap();
    }
    let mut evaluator = experiment.prepare(condition, &settings).unwrap();
    let random = |individual| random_parameters(evaluator.as_ref(), experiment.gene_bits(), 5, individual);
    let parameters: Vec<Vec<f32>> = (0..21).map(random).collect();
    let others: Vec<[&[f32]; 1]> = (0..21).map(|number| [&parameters[20 - number][..]]).collect();
    let populations = evaluator.info().populations.len();
    let evaluation = |number: usize| {
        let population = number % populations;
        let size = if populations > 1 { settings.count("evolution.population").unwrap() } else { 0 };
        let individual = (number + population * size) as u32;
        let id = EpisodeId { seed: 3, generation: 1, individual, trial: number as u32 };
        let opponents: &[&[f32]] = if populations > 1 { &others[number] } else { &[] };
        Evaluation { number, opponents, ..Evaluation::new(&parameters[number], id) }
    };
    let evaluations: Vec<Evaluation> = (0..21).map(evaluation).collect();
    let alone = in_lanes_as_alone(evaluator.as_mut(), instructions, &evaluations);
    println!("{} {condition}: {alone:?}", experiment.name());
    assert!(alone.iter().any(|outcome| *outcome != alone[0]), "all the same: {alone:?}");
    alone
}

fn steps(steps: i64) -> (&'static str, Value) {
    ("trial.steps", Value::Whole(steps))
}

/// In some of them, not in all, something ends a trial before its time, so that lanes are filled at different steps.
fn some_end_early(outcomes: &[Outcome], steps: u32) {
    let early = outcomes.iter().filter(|outcome| outcome.steps < steps).count();
    assert!(early > 0 && early < outcomes.len(), "{early} of {} end early", outcomes.len());
}

#[test]
fn trials_of_discrimination_in_lanes_are_those_alone() {
    for model in ["analytic", "rays"] {
        let values = [steps(100), ("robot.infrared", Value::Word(model.into()))];
        for condition in DISCRIMINATION.conditions() {
            some_end_early(&wheels(&DISCRIMINATION, condition, &values), 100);
        }
        for condition in DISCRIMINATION_CYLINDERS.conditions() {
            some_end_early(&wheels(&DISCRIMINATION_CYLINDERS, condition, &values), 100);
        }
    }
}

#[test]
fn vehicles_in_lanes_are_those_alone() {
    for condition in BRAITENBERG.conditions() {
        wheels(&BRAITENBERG, condition, &[steps(100)]);
    }
}

#[test]
fn teams_in_lanes_are_those_alone() {
    let two = ("team.robots", Value::Whole(2));
    for condition in FORAGING.conditions() {
        wheels(&FORAGING, condition, &[steps(60), two.clone()]);
        wheels(&AGGREGATION, condition, &[steps(60), two.clone()]);
    }
}

#[test]
fn predators_and_prey_in_lanes_are_those_alone() {
    some_end_early(&wheels(&PREDATOR_PREY, "", &[steps(200)]), 200);
}

#[test]
fn walkers_in_lanes_are_those_alone() {
    let values = [("episode.steps", Value::Whole(20))];
    let mut all = Vec::new();
    for experiment in [&HOPPER, &WALKER2D, &HALF_CHEETAH, &ANT, &ANT_OMNI, &HUMANOID, &GO1_JOYSTICK, &G1_WALK] {
        let condition = experiment.conditions().first().copied().unwrap_or_default();
        all.extend(trials(experiment, condition, &values, articulated::Batch::instructions()));
    }
    some_end_early(&all, 20);
}
