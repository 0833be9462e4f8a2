//! The experiments on teams: trials repeat, robots stay where they can be, and the scores are right.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../examples/by_hand/mod.rs"]
mod by_hand;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use farsa_body::ports::BodyId;
use farsa_evo::words::randomize;
use farsa_experiments::{AGGREGATION, EmbeddedExperiment, FORAGING, PREDATOR_PREY, Reflex};
use farsa_lab::advanced::{Genotype, Value};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Note, Outcome, Settings};
use farsa_num::{Domain, Stream};
use farsa_view::Recording;

use by_hand::{Aim, beacon_seeker, chaser, homing_forager};

const ALL: [(&dyn Experiment, &str); 7] = [
    (&FORAGING, "marxbot"),
    (&FORAGING, "e-puck"),
    (&FORAGING, "khepera"),
    (&AGGREGATION, "marxbot"),
    (&AGGREGATION, "e-puck"),
    (&AGGREGATION, "khepera"),
    (&PREDATOR_PREY, ""),
];

fn settings(experiment: &dyn Experiment, condition: &str, changes: &[(&str, Value)]) -> Settings {
    let mut settings = Settings::new(experiment.settings(condition)).unwrap();
    for (key, value) in changes {
        settings.set("", key, value.clone()).unwrap();
    }
    settings
}

fn prepare(experiment: &dyn Experiment, condition: &str, steps: i64) -> Box<dyn Evaluator> {
    let settings = settings(experiment, condition, &[("trial.steps", Value::Whole(steps))]);
    experiment.prepare(condition, &settings).unwrap()
}

/// The parameters of random genes. All these experiments have genes of 16 bits.
fn parameters(evaluator: &dyn Evaluator, number: u32) -> Vec<f32> {
    let genotype = Genotype::new(&evaluator.info().parameters, 16);
    let mut genes = vec![0; genotype.genes()];
    randomize(&mut genes, &mut Stream::new(5, Domain::InitialGenome, number, 0, 0));
    genotype.decode(&genes).unwrap()
}

/// A trial against other ones.
fn against<'p>(parameters: &'p [f32], opponents: &'p [&'p [f32]], id: EpisodeId) -> Evaluation<'p> {
    Evaluation { opponents, ..Evaluation::new(parameters, id) }
}

fn note(outcome: &Outcome, name: &str) -> f64 {
    match outcome.notes.iter().find(|(known, _)| *known == name) {
        Some((_, Note::Number(x))) => *x,
        other => panic!("{name}: {other:?}"),
    }
}

/// A trial, against `other` where there are two, recorded and not.
fn recorded(evaluator: &mut dyn Evaluator, own: &[f32], other: &[f32], id: EpisodeId) -> (Outcome, Recording) {
    let plain = evaluator.evaluate(against(own, &[other], id), None);
    evaluator.evaluate(against(other, &[own], EpisodeId { trial: id.trial + 1, ..id }), None);
    let mut recording = Recording::new(evaluator.info().schema);
    let recorded = evaluator.evaluate(against(own, &[other], id), Some(&mut recording));
    assert_eq!(plain, recorded);
    (plain, recording)
}

/// The whole ring of the first robot, and of the others what met something: from the hull of a robot outwards, where it was when
/// it sensed.
fn rays_belong_to_robots(recording: &Recording, tick: usize, sensors: usize, [radius, range, height]: [f32; 3]) {
    let rays = recording.rays_at(tick);
    // Before the first step it is unknown where the robots were.
    let Some(before) = tick.checked_sub(1) else { return };
    // The dead sense nothing.
    let energy = recording.schema().columns().iter().position(|name| name == "energy 1");
    let dead = energy.is_some_and(|energy| recording.row(before).nth(energy) == Some(0.0));
    let sensors = if dead { 0 } else { sensors };
    assert!(rays.len() >= sensors, "{tick}: {}", rays.len());
    let robots: Vec<[f32; 3]> =
        (0..10).map_while(|robot| recording.pose_at(before, BodyId(robot))).map(|pose| pose.position).collect();
    let mut of_own = 0;
    for ray in rays {
        assert!([ray.from, ray.to].iter().all(|end| (end[2] - height).abs() < 1e-6), "{tick}: {ray:?}");
        let [u, v] = [0, 1].map(|k| ray.to[k] - ray.from[k]);
        let length = u.hypot(v);
        // Some meters away a single has an error of a micrometer.
        assert!(length < range + 1e-5 && (ray.met || length > range - 1e-5), "{tick}: {ray:?}");
        let to = |at: &[f32; 3]| ((ray.from[0] - at[0]).hypot(ray.from[1] - at[1]) - radius).abs();
        assert!(robots.iter().any(|at| to(at) < 1e-5), "{tick}: {ray:?}");
        of_own += usize::from(to(&robots[0]) < 1e-5);
        assert!(ray.met || to(&robots[0]) < 1e-5, "{tick}: {ray:?}");
    }
    assert_eq!(of_own, sensors, "{tick}");
}

#[test]
fn trials_repeat_and_robots_stay_between_the_walls_and_apart() {
    for (experiment, condition) in ALL {
        let mut evaluator = prepare(experiment, condition, 250);
        let (radius, size) = match condition {
            "e-puck" => (0.035, 2.5),
            "khepera" => (0.035, 2.0),
            "marxbot" => (0.085, 5.0),
            _ => (0.085, 3.0),
        };
        for number in 0..3 {
            let (own, other) = (parameters(evaluator.as_ref(), number), parameters(evaluator.as_ref(), number + 10));
            let id = EpisodeId { seed: 3, generation: 2, individual: 7, trial: number };
            let (outcome, recording) = recorded(evaluator.as_mut(), &own, &other, id);
            assert!(outcome.is_finite(), "{outcome:?}");
            let ticks = recording.times().len();
            assert_eq!(ticks, outcome.steps as usize);
            let robots = if condition.is_empty() { 2 } else { 10 };
            let (sensors, range, height) = match condition {
                "e-puck" => (8, 0.05, 0.025),
                "khepera" => (8, 0.05, 0.015),
                _ => (24, 0.1, 0.085),
            };
            for tick in 0..ticks {
                rays_belong_to_robots(&recording, tick, sensors, [radius, range, height]);
                let places: Vec<[f32; 2]> = (0..robots)
                    .map(|robot| recording.pose_at(tick, BodyId(robot)).unwrap().position)
                    .map(|at| [at[0], at[1]])
                    .collect();
                for (i, a) in places.iter().enumerate() {
                    let inside = |x: f32| (radius - 1e-5..=size - radius + 1e-5).contains(&x);
                    assert!(inside(a[0]) && inside(a[1]), "{} {tick} {i}: {a:?}", experiment.name());
                    for b in &places[..i] {
                        let gap = (a[0] - b[0]).hypot(a[1] - b[1]) - 2.0 * radius;
                        assert!(gap > -1e-5, "{} {tick} {i}: {gap}", experiment.name());
                    }
                }
            }
            // Another generation, another start.
            let next = evaluator.evaluate(against(&own, &[&other], EpisodeId { generation: 3, ..id }), None);
            assert!(next.is_finite());
        }
    }
}

#[test]
fn the_book_of_food_is_what_the_robots_ways_tell() {
    let mut evaluator = prepare(&FORAGING, "marxbot", 400);
    let columns = evaluator.info().schema.columns();
    let column = |name: &str| columns.iter().position(|c| c == name).unwrap_or_else(|| panic!("{name}"));
    let (mut deaths, mut food) = (0.0, 0.0);
    for number in 0..6 {
        let own = parameters(evaluator.as_ref(), number);
        let (outcome, recording) =
            recorded(evaluator.as_mut(), &own, &own, EpisodeId { trial: number, ..EpisodeId::default() });
        // From the poses alone: where each robot is, from the first step on.
        let mut left = [[true; 20]; 20];
        let (mut carried, mut away, mut paid, mut lost) = ([0.0; 10], [0; 10], 0.0, 0.0);
        let mut grave: [Option<[f32; 3]>; 10] = [None; 10];
        for tick in 0..recording.times().len() {
            let nest = recording.pose_at(tick, BodyId(10)).unwrap().position.map(f64::from);
            for robot in 0..10 {
                let pose = recording.pose_at(tick, BodyId(robot as u16)).unwrap();
                if let Some(grave) = grave[robot] {
                    assert_eq!(pose.position, grave, "the dead do not move");
                    continue;
                }
                let [x, y, _] = pose.position.map(f64::from);
                away[robot] += 1;
                let [u, v] = [x - nest[0], y - nest[1]];
                let home = u * u + v * v <= 0.4 * 0.4;
                let dead = away[robot] == 100 && !home;
                let cell = &mut left[(y / 0.25) as usize][(x / 0.25) as usize];
                if !dead && std::mem::take(cell) {
                    carried[robot] += 1.0;
                }
                if home {
                    paid += std::mem::take(&mut carried[robot]);
                    away[robot] = 0;
                } else if dead {
                    lost += std::mem::take(&mut carried[robot]);
                    grave[robot] = Some(pose.position);
                }
            }
            let food: Vec<bool> = recording.image_at(tick, 0).unwrap().map(|color| color != [0.0; 3]).collect();
            assert_eq!(food, left.as_flattened(), "{number} {tick}");
            let row: Vec<f64> = recording.row(tick).collect();
            assert_eq!([row[column("food collected")], row[column("food lost with the dead")]], [paid, lost]);
            for robot in 0..10 {
                assert_eq!(row[column(&format!("carried {}", robot + 1))], carried[robot]);
                let energy = if grave[robot].is_some() { 0.0 } else { 1.0 - 0.01 * f64::from(away[robot]) };
                assert!((row[column(&format!("energy {}", robot + 1))] - energy).abs() < 1e-9);
            }
        }
        assert_eq!(outcome.terms, [paid]);
        assert_eq!(note(&outcome, "deaths"), grave.iter().flatten().count() as f64);
        assert_eq!(note(&outcome, "food carried at the end"), carried.iter().sum::<f64>());
        deaths += note(&outcome, "deaths");
        food += paid;
    }
    assert!(deaths > 0.0 && food > 0.0, "nothing happened: {deaths} {food}");
}

#[test]
fn the_reward_of_aggregation_is_that_of_the_last_places() {
    let mut evaluator = prepare(&AGGREGATION, "marxbot", 200);
    let radius = 0.085;
    for number in 0..5 {
        let own = parameters(evaluator.as_ref(), number);
        let (outcome, recording) =
            recorded(evaluator.as_mut(), &own, &own, EpisodeId { trial: number, ..EpisodeId::default() });
        let place = |body: u16| {
            let [x, y, _] = recording.pose_at(199, BodyId(body)).unwrap().position;
            [x, y]
        };
        let far = |a: [f32; 2], b: [f32; 2]| f64::from((a[0] - b[0]).hypot(a[1] - b[1]));
        let (mut reward, mut home) = (0.0, 0);
        for robot in 0..10 {
            let nests = (10..12).filter(|nest| far(place(robot), place(*nest)) <= 6.0 * radius).count();
            home += nests.min(1);
            let sum: f64 = (0..10).map(|other| far(place(robot), place(other))).sum();
            reward += 100.0 * nests.min(1) as f64 + 1.0 - sum / 9.0 / (5.0 * 2.0_f64.sqrt());
        }
        assert!((outcome.terms.iter().sum::<f64>() - reward / 10.0).abs() < 1e-5, "{outcome:?} {reward}");
        assert!((note(&outcome, "share on a nest") - home as f64 / 10.0).abs() < 1e-9);
        // Robots with less than a diameter between their hulls are of one cluster.
        let mut cluster: Vec<u16> = (0..10).collect();
        for _ in 0..10 {
            for (a, b) in (0..10).flat_map(|a| (0..10).map(move |b| (a, b))) {
                if far(place(a), place(b)) < 4.0 * radius {
                    let least = cluster[usize::from(a)].min(cluster[usize::from(b)]);
                    cluster[usize::from(a)] = least;
                    cluster[usize::from(b)] = least;
                }
            }
        }
        cluster.sort_unstable();
        cluster.dedup();
        assert_eq!(note(&outcome, "clusters"), cluster.len() as f64);
    }
}

#[test]
fn capture_is_the_same_for_both() {
    let mut evaluator = prepare(&PREDATOR_PREY, "", 400);
    let (mut captures, mut escapes) = (0, 0);
    for number in 0..24 {
        let (own, other) = (parameters(evaluator.as_ref(), number), parameters(evaluator.as_ref(), number + 100));
        let id = EpisodeId { seed: 9, individual: 4, trial: number, ..EpisodeId::default() };
        let predator = evaluator.evaluate(against(&own, &[&other], id), None);
        // The prey of the same place in its population, 40 individuals further.
        let prey = evaluator.evaluate(against(&other, &[&own], EpisodeId { individual: 44, ..id }), None);
        assert_eq!(predator.terms[0] + prey.terms[0], 1.0);
        assert_eq!((predator.steps, &predator.notes), (prey.steps, &prey.notes));
        assert_ne!(predator.success, prey.success);
        let captured = note(&predator, "captures") > 0.0;
        assert_eq!((captured, predator.success), (predator.steps < 400 || captured, captured));
        let earned = if captured { 1.0 - f64::from(predator.steps) / 400.0 } else { 0.0 };
        assert_eq!(predator.terms, [earned]);
        captures += u32::from(captured);
        escapes += u32::from(!captured);
    }
    assert!(captures > 0 && escapes > 0, "{captures} {escapes}");
}

#[test]
fn robots_that_drive_into_each_other_are_caught_wherever_they_are() {
    let settings = settings(&PREDATOR_PREY, "", &[]);
    let chase = |aims: [Aim; 2]| -> Vec<Outcome> {
        let robots = [0, 1].map(|robot| (robot, chaser(aims[robot], &settings).unwrap()));
        let mut evaluator = PREDATOR_PREY.prepare_with("", &settings, robots.into()).unwrap();
        let unused = parameters(evaluator.as_ref(), 0);
        let ids = (0..10).map(|seed| EpisodeId { seed, ..EpisodeId::default() });
        ids.map(|id| evaluator.evaluate(against(&unused, &[&unused], id), None)).collect()
    };
    for outcome in chase([Aim::To, Aim::From]) {
        // Capture leaves no gap that a step could not close. Without it there was one at every step.
        assert!(!outcome.success || note(&outcome, "gap at the end [m]") < 2.0 * 0.027, "{outcome:?}");
        assert!(outcome.is_finite());
    }
    // A predator that steers to a prey that steers to it: no chase lasts long.
    for outcome in chase([Aim::To, Aim::To]) {
        assert!(outcome.success && outcome.steps < 60, "{outcome:?}");
    }
}

#[test]
fn hand_written_teams_do_what_they_are_for() {
    let ids = || (0..3).map(|seed| EpisodeId { seed, ..EpisodeId::default() });
    let mean = |outcomes: &[Outcome]| {
        outcomes.iter().map(|outcome| outcome.terms.iter().sum::<f64>()).sum::<f64>() / outcomes.len() as f64
    };
    for condition in ["marxbot", "e-puck", "khepera"] {
        let mut evaluator = prepare(&FORAGING, condition, 1000);
        let mut random = Vec::new();
        for id in ids() {
            let own = parameters(evaluator.as_ref(), id.seed as u32);
            random.push(evaluator.evaluate(against(&own, &[], id), None));
        }
        let by_hand = |experiment: &'static EmbeddedExperiment, reflex: Reflex, settings: &Settings| -> Vec<Outcome> {
            let robots = (0..10).map(|robot| (robot, reflex.clone())).collect();
            let mut team = experiment.prepare_with(condition, settings, robots).unwrap();
            let unused = parameters(team.as_ref(), 0);
            ids().map(|id| team.evaluate(against(&unused, &[], id), None)).collect()
        };
        let plain = settings(&FORAGING, condition, &[]);
        let foragers = by_hand(&FORAGING, homing_forager(condition, &plain).unwrap(), &plain);
        assert!(mean(&foragers) > 2.0 * mean(&random), "{condition}: {} {}", mean(&foragers), mean(&random));
        let seekers = by_hand(&AGGREGATION, beacon_seeker(condition), &settings(&AGGREGATION, condition, &[]));
        assert!(mean(&seekers) > 30.0, "{condition}: {}", mean(&seekers));
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let refused = |experiment: &dyn Experiment, condition: &str, key: &str, value: Value| {
        let settings = settings(experiment, condition, &[(key, value)]);
        experiment.prepare(condition, &settings).err().unwrap().to_string()
    };
    let error = refused(&FORAGING, "marxbot", "team.robots", Value::Whole(200));
    assert!(error.starts_with("`team.robots`: no free place for a disc of 0.085 m in 1000 tries"), "{error}");
    let error = refused(&FORAGING, "khepera", "nest.to_wall", Value::Number(1.5));
    assert!(error.contains("`nest.to_wall`") && error.contains("at most 1 m"), "{error}");
    let error = refused(&FORAGING, "marxbot", "robot.speed", Value::Number(5.0));
    assert!(error.contains("robot 0 may go 0.5 m in a step"), "{error}");
    let error = refused(&FORAGING, "marxbot", "nest.radius", Value::Number(0.0));
    assert!(error.contains("`nest.radius`"), "{error}");
    let error = refused(&AGGREGATION, "marxbot", "nest.count", Value::Whole(50));
    assert!(error.contains("no free place for a disc of 0.51 m in 1000 tries"), "{error}");
    let error = refused(&AGGREGATION, "e-puck", "world.size", Value::Number(0.2));
    assert!(error.contains("`nest.to_wall`"), "{error}");
    let error = refused(&PREDATOR_PREY, "", "world.size", Value::Number(0.5));
    assert!(error.contains("`world.size`: no free place"), "{error}");
    for (experiment, condition) in ALL {
        let given = experiment.settings(condition);
        let source = |key: &str| given.iter().find(|setting| setting.key() == key).unwrap().source().name();
        // The source gathers MarXbots only.
        let ours = experiment.name() == "aggregation" && condition != "marxbot";
        assert_eq!((source("world.size"), source("camera.rays")), (if ours { "chosen" } else { "given" }, "chosen"));
        if !condition.is_empty() {
            let mut table = Settings::new(given.clone()).unwrap();
            assert!(table.set("", "team.robots", Value::Whole(0)).is_err());
        }
    }
}

fn directory(name: &str) -> PathBuf {
    let path = env::temp_dir().join(format!("farsa-swarm-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    path
}

fn run(experiment: &str, path: &Path, threads: &str) {
    let status = Command::new(env!("CARGO_BIN_EXE_farsa"))
        .args(["run", experiment, "--seed", "4", "--generations", "2", "--population", "6", "--quiet"])
        .args(["--set", "evolution.parents=3", "--set", "trial.steps=60", "--set", "trial.count=2"])
        .args(["--threads", threads, "--out"])
        .arg(path)
        .status()
        .unwrap();
    assert!(status.success(), "{experiment}: {status}");
}

#[test]
fn threads_do_not_show_in_a_run() {
    for experiment in ["foraging", "aggregation", "predator-prey"] {
        let [one, two] = ["1", "2"].map(|threads| {
            let path = directory(&format!("{experiment}-{threads}"));
            run(experiment, &path, threads);
            path
        });
        for file in ["champion.bin", "record.bin", "lineage.csv", "checkpoint.bin", "fitness.csv", "config.toml"] {
            assert!(fs::read(one.join(file)).unwrap() == fs::read(two.join(file)).unwrap(), "{experiment}: {file}");
        }
        for path in [one, two] {
            fs::remove_dir_all(path).unwrap();
        }
    }
}
