//! A life in a lane is the life alone: whole trials of scripts and networks, at every instruction set of this machine.
#![allow(missing_docs, clippy::unwrap_used)]

use std::sync::Arc;

use farsa_experiments::reach_grasp_lift::{Config, Lives, Scene, ScriptLife, TRIALS, Timetable, Trial};
use farsa_experiments::{Job, Lanes, Life, Outcome, Setup, Tape, Task, live, live_in_lanes};
use farsa_num::{Domain, Instructions, Stream};
use farsa_physics::articulated::{Batch, LANES, Lane, Model, World};

/// Every number of lanes at every instruction set of this machine.
fn every_batch() -> impl Iterator<Item = (usize, Instructions)> {
    Batch::instructions().flat_map(|instructions| LANES.map(|lanes| (lanes, instructions)))
}

/// A script with a number, and what came of the jobs.
struct Numbered {
    life: ScriptLife,
    number: usize,
}

impl Life<Lane<'_>> for Numbered {
    fn start(&mut self, world: &mut Lane<'_>, job: Job) {
        self.life.start(world, job);
    }
    fn tick(&mut self, world: &mut Lane<'_>) -> Option<f64> {
        self.life.tick(world)
    }
}

#[test]
fn scripted_grasps_in_lanes_are_those_alone() {
    let scene = Arc::new(Scene::new(Config::default()).unwrap());
    let model = Model::<f32>::new(&scene.robot, &scene.config.options()).unwrap();
    let script = ScriptLife::new(Arc::clone(&scene), Timetable::default()).unwrap();
    // More than lanes, and not a multiple: lanes are filled again while others are in the middle of a grasp.
    let job = |n: usize| Job { seed: 7, generation: (n / TRIALS) as u32, individual: 0, trial: (n % TRIALS) as u32 };
    let mut world = World::new(model.clone());
    let alone: Vec<(f64, Trial)> = (0..20)
        .map(|n| {
            let mut life = script.clone();
            (live(&mut life, &mut world, job(n)), *life.judge().trial())
        })
        .collect();
    assert!(alone.iter().filter(|(_, trial)| trial.held > 0).count() > 15);
    for (lanes, instructions) in every_batch() {
        let mut batch = Batch::new(model.clone(), lanes, instructions).unwrap();
        // In some lanes only: the others stay empty.
        let mut lives: Vec<_> = (0..lanes - 1).map(|_| Numbered { life: script.clone(), number: 0 }).collect();
        let (mut next, mut ended) = (0, vec![None; alone.len()]);
        let begin = |numbered: &mut Numbered| {
            numbered.number = next;
            next += 1;
            (numbered.number < alone.len()).then(|| job(numbered.number))
        };
        let end = |numbered: &mut Numbered, fitness: f64| {
            ended[numbered.number] = Some((fitness, *numbered.life.judge().trial()));
        };
        live_in_lanes(&mut lives, &mut batch, begin, end);
        let ended: Vec<_> = ended.into_iter().flatten().collect();
        assert_eq!(ended, alone, "{lanes} lanes, {instructions:?}");
    }
}

#[test]
fn lives_of_networks_in_lanes_are_those_alone() {
    let mut setup = Lives::new(Config::default()).unwrap();
    let genomes: Vec<Vec<u16>> = (0..10)
        .map(|individual| {
            let mut stream = Stream::new(3, Domain::InitialGenome, 0, individual, 0);
            (0..setup.genes()).map(|_| (65535.0 * stream.uniform()) as u16).collect()
        })
        .collect();
    let task = |number: usize| {
        let genes = genomes.get(number / TRIALS)?;
        let job = Job { seed: 3, generation: 1, individual: (number / TRIALS) as u32, trial: (number % TRIALS) as u32 };
        Some(Task { number, genes, opponents: &[], job })
    };
    let alone: Vec<Outcome> =
        (0..).map_while(task).map(|Task { genes, job, .. }| setup.live(genes, job, &mut Tape::off())).collect();
    println!("steps: {:?}", alone.iter().map(|outcome| outcome.steps).collect::<Vec<_>>());
    for (count, instructions) in every_batch().chain([(1, Instructions::detect())]) {
        assert_eq!(setup.use_lanes(Lanes::new(count, instructions).unwrap()).unwrap().count(), count);
        // Twice: nothing of the first time is left.
        for _ in 0..2 {
            let (mut next, mut ended) = (0, vec![Outcome::default(); alone.len()]);
            let mut draw = || {
                next += 1;
                task(next - 1)
            };
            setup.live_many(&mut draw, &mut |number, outcome| ended[number] = outcome);
            assert!(ended == alone, "{count} lanes, {instructions:?}");
        }
    }
}
