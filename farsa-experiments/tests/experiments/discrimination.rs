//! `discrimination`: the original's genotypes, the starts and the course of trials.

use std::path::{Path, PathBuf};
use std::process::Command;

use farsa_body::ports::{Arrange as _, Kinematics as _};
use farsa_body::{Pose, Twist};
use farsa_experiments::discrimination::{Config, CylinderEpisode, InfraredModel};
use farsa_experiments::{Discrimination, DiscriminationCylinders};
use farsa_lab::{Episode as _, EpisodeId, Evaluation, Evaluator, Experiment, Genotype, Settings, Value, run_episode};
use farsa_nn::Perceptron;
use farsa_physics::arena::World;
use farsa_view::Recording;

/// The original's measured tables and genotypes: in the folder `khepera` of `FARSA_FIXTURES`, or in that beside the repository.
///
/// They are not ours to keep. In CI they must be there; elsewhere the test says that it is skipped.
fn fixtures() -> Option<PathBuf> {
    let named = std::env::var_os("FARSA_FIXTURES").map(PathBuf::from);
    let must_be_there = named.is_some() || std::env::var_os("CI").is_some_and(|value| value == "true");
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = named.unwrap_or_else(beside).join("khepera");
    if !folder.is_dir() {
        assert!(!must_be_there, "there is no folder {}; set FARSA_FIXTURES", folder.display());
        eprintln!("skipped: the original's genotypes (set FARSA_FIXTURES)");
        return None;
    }
    Some(folder)
}

fn settings(experiment: &dyn Experiment, condition: &str, values: &[(&str, Value)]) -> Settings {
    let mut settings = Settings::new(experiment.settings(condition)).unwrap();
    for (key, value) in values {
        settings.set("", key, value.clone()).unwrap();
    }
    settings
}

fn sampled(directory: &Path) -> Vec<(&'static str, Value)> {
    let directory = directory.to_str().unwrap().to_owned();
    vec![("robot.infrared", Value::Word("sampled".into())), ("robot.infrared_tables", Value::Word(directory))]
}

/// What `farsa evaluate` prints as `name`, of 2000 random trials.
fn evaluate(options: &[&str], name: &str) -> f64 {
    let mut command = Command::new(env!("CARGO_BIN_EXE_farsa"));
    command.args(["evaluate", "discrimination", "--trials", "2000", "--seed", "1"]).args(options);
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let line = text.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_else(|| panic!("no {name}: {text}"));
    line.trim().parse().unwrap()
}

/// Tables would be read wrongly, sensors or weights be exchanged, a rule be another: each would show here.
#[test]
fn genotypes_of_the_original_stay_near_as_long_as_in_an_independent_replay() {
    let Some(directory) = fixtures() else { return };
    let tables = directory.to_str().unwrap();
    for (name, expected) in [("G500S53.gen", 0.699), ("G500S54.gen", 0.761)] {
        let file = directory.join(name);
        let genes = ["--genes-file", file.to_str().unwrap()];
        let sampled = [&genes[..], &["--ir-tables", tables]].concat();
        let mean = evaluate(&sampled, "mean_fitness");
        let collisions = evaluate(&sampled, "collisions_per_trial");
        println!("{name}: {mean:.4} by the tables, {collisions:.4} collisions per trial");
        println!("{name}: {:.4} by the formula", evaluate(&genes, "mean_fitness"));
        assert!((mean - expected).abs() < 0.02, "{name}: {mean}");
        assert!(collisions < 0.03, "{name}: {collisions}");
    }
}

/// The parameters of these genes.
fn parameters(experiment: &dyn Experiment, evaluator: &dyn Evaluator, gene: impl Fn(usize) -> u16) -> Vec<f32> {
    let genotype = Genotype::new(&evaluator.info().parameters, experiment.gene_bits());
    genotype.decode(&(0..genotype.genes()).map(gene).collect::<Vec<_>>()).unwrap()
}

fn alone(parameters: &[f32], id: EpisodeId) -> Evaluation<'_> {
    Evaluation::new(parameters, id)
}

/// A controller of the layer with all weights 0: the robot drives straight on or stands.
fn constant(config: &Config, outputs: [f32; 2]) -> Perceptron<Vec<f32>> {
    let inputs = config.inputs();
    let mut parameters = vec![0.0; Perceptron::parameter_count(inputs, 2)];
    parameters[2 * inputs..].copy_from_slice(&outputs);
    Perceptron::new(inputs, 2, 1.0, parameters).unwrap()
}

#[test]
fn trials_start_where_the_rules_allow() {
    for config in [Config::default(), Config::e_puck(), Config::two_cylinders(true)] {
        let hull = config.robot.radius;
        let mut world = config.world().unwrap();
        let mut episode = CylinderEpisode::new(config.clone(), constant(&config, [0.0; 2])).unwrap();
        let (mut starts, mut quadrants) = (Vec::new(), [0; 4]);
        for trial in 0..1000 {
            episode.arrange(&mut world, EpisodeId { seed: 3, trial, ..EpisodeId::default() }).unwrap();
            let robot = world.pose(episode.parts().body).position.map(f64::from);
            let to_wall = |[x, y, _]: [f64; 3]| {
                let [w, h] = config.size;
                x.min(y).min(w - x).min(h - y)
            };
            let apart = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
            assert!(to_wall(robot) - hull > 0.01 - 1e-5, "{robot:?}");
            let places: Vec<_> =
                episode.cylinders().iter().map(|body| world.pose(*body).position.map(f64::from)).collect();
            for (place, radius) in places.iter().zip(&config.radii) {
                assert!(to_wall(*place) - radius > 0.05 - 1e-5, "{place:?}");
                assert!(apart(*place, robot) - radius - hull > 0.1 - 1e-5, "{place:?} {robot:?}");
            }
            if let [a, b] = places[..] {
                assert!(apart(a, b) - config.radii.iter().sum::<f64>() > config.object_to_object - 1e-5);
            }
            let heading = world.pose(episode.parts().body).heading();
            quadrants[((heading + core::f32::consts::PI) / core::f32::consts::FRAC_PI_2).min(3.0) as usize] += 1;
            starts.push(robot);
        }
        assert!(quadrants.iter().all(|count| (200..300).contains(count)), "{quadrants:?}");
        let mut again = |id| {
            episode.arrange(&mut world, id).unwrap();
            world.pose(episode.parts().body).position.map(f64::from)
        };
        let id = EpisodeId { seed: 3, trial: 5, ..EpisodeId::default() };
        assert_eq!(again(id), starts[5]);
        for other in [EpisodeId { seed: 4, ..id }, EpisodeId { individual: 1, ..id }, EpisodeId { generation: 1, ..id }]
        {
            assert_ne!(again(other), starts[5]);
        }
    }
}

#[test]
fn a_step_near_the_cylinder_counts_and_a_collision_ends_the_trial() {
    let config = Config { steps: 40, ..Config::default() };
    let mut world = config.world().unwrap();
    // Full speed ahead, 5.18 mm a step.
    let mut episode = CylinderEpisode::new(config.clone(), constant(&config, [50.0; 2])).unwrap();
    // A trial whose cylinder stands in the middle; the robot drives towards it, and from beside it to the wall.
    let place = |episode: &mut CylinderEpisode<Perceptron<Vec<f32>>>, world: &mut World, trial| {
        episode.start(world, EpisodeId { trial, ..EpisodeId::default() });
        world.pose(episode.cylinders()[0]).position
    };
    let central = |at: [f32; 3]| at[..2].iter().all(|x| (x - 0.2).abs() < 0.05);
    let trial = (0..1000).find(|trial| central(place(&mut episode, &mut world, *trial))).unwrap();
    for (start, expected) in [(-0.1, "cylinder"), (0.06, "wall")] {
        let at = place(&mut episode, &mut world, trial);
        world.place_body(episode.parts().body, Pose::planar([at[0] + start, at[1]], 0.0), Twist::default());
        world.finish_placement();
        let mut distances = Vec::new();
        let fitness = loop {
            episode.act(&mut world);
            farsa_body::ports::World::step(&mut world);
            let end = episode.judge(&mut world);
            distances.push(episode.trial().distance[0]);
            if let Some(fitness) = end {
                break fitness;
            }
        };
        let near = distances.iter().filter(|distance| **distance < 0.08).count() as u32;
        assert_eq!((episode.trial().near[0], episode.trial().steps as usize), (near, distances.len()));
        assert_eq!(fitness, f64::from(near) / 40.0);
        assert!(episode.trial().collided && distances.len() < 40, "{expected}: {distances:?}");
        assert!(distances.iter().all(|distance| *distance >= 0.0), "{expected}");
    }
}

#[test]
fn trials_can_be_repeated_recorded_and_run_by_hand() {
    let cases: [(&dyn Experiment, &str, Config); 4] = [
        (&Discrimination, "khepera", Config::default()),
        (&Discrimination, "e-puck", Config::e_puck()),
        (&DiscriminationCylinders, "wheels", Config::two_cylinders(true)),
        (&DiscriminationCylinders, "no-wheels", Config::two_cylinders(false)),
    ];
    for (experiment, condition, config) in cases {
        for model in ["analytic", "rays"] {
            let settings = settings(experiment, condition, &[("robot.infrared", Value::Word(model.into()))]);
            let mut evaluator = experiment.prepare(condition, &settings).unwrap();
            let own = parameters(experiment, evaluator.as_ref(), |i| (i * 97 % 256) as u16);
            let id = EpisodeId { seed: 9, generation: 3, individual: 1, trial: 4 };
            let plain = evaluator.evaluate(alone(&own, id), None);
            evaluator.evaluate(alone(&own, EpisodeId { trial: 7, ..id }), None);
            let mut recording = Recording::new(evaluator.info().schema);
            assert_eq!(evaluator.evaluate(alone(&own, id), Some(&mut recording)), plain);
            let ticks = recording.times().len();
            assert_eq!(ticks, plain.steps as usize);
            assert!((0..ticks).all(|tick| recording.row(tick).all(f64::is_finite)));
            assert_eq!(recording.rays_at(ticks - 1).len(), 6);
            let description = evaluator.info().description;
            assert_eq!(description.sensors.iter().map(|g| g.count).sum::<usize>(), config.inputs());
            assert_eq!(description.parameters, own.len());
            // The same as an episode of its own controller.
            let zeros = parameters(experiment, evaluator.as_ref(), |_| 128);
            let mut world = config.world().unwrap();
            let w = 5.0 - 128.0 / 255.0 * 10.0;
            let layer = Perceptron::new(config.inputs(), 2, 1.0, vec![w as f32; zeros.len()]).unwrap();
            if model == "analytic" {
                let infrared = InfraredModel::Analytic;
                let mut episode = CylinderEpisode::new(Config { infrared, ..config.clone() }, layer).unwrap();
                let fitness = run_episode(&mut episode, &mut world, id, None);
                let evaluated = evaluator.evaluate(alone(&zeros, id), None);
                assert_eq!(fitness, evaluator.fitness(&[evaluated]));
                episode.start(&mut world, id);
                assert_eq!(episode.trial().steps, 0);
            }
        }
    }
}

/// The variant's numbers as they were told: half a second straight on, and near below 27.5 + 12.5 + 60 mm.
#[test]
fn an_e_puck_drives_and_earns_by_the_numbers_of_its_own() {
    let config = Config::e_puck();
    let mut world = config.world().unwrap();
    let mut episode = CylinderEpisode::new(config.clone(), constant(&config, [50.0; 2])).unwrap();
    let body = episode.parts().body;
    let central = |at: [f32; 3]| at[..2].iter().all(|x| (x - 0.2).abs() < 0.05);
    let trial = (0..1000).find(|&trial| {
        episode.start(&mut world, EpisodeId { trial, ..EpisodeId::default() });
        central(world.pose(episode.cylinders()[0]).position)
    });
    episode.start(&mut world, EpisodeId { trial: trial.unwrap(), ..EpisodeId::default() });
    let at = world.pose(episode.cylinders()[0]).position;
    world.place_body(body, Pose::planar([at[0] - 0.13, at[1]], 0.0), Twist::default());
    world.finish_placement();
    // Centres 130 mm apart, 14.4 mm nearer with each step: below 100 mm from the third on.
    let near: Vec<u32> = (0..5)
        .map(|step| {
            episode.act(&mut world);
            farsa_body::ports::World::step(&mut world);
            assert_eq!(episode.judge(&mut world), None, "{step}");
            let travelled = f64::from(world.pose(body).position[0] - at[0]) + 0.13;
            assert!((travelled - 0.0144 * f64::from(step + 1)).abs() < 1e-5, "{step}: {travelled}");
            episode.trial().near[0]
        })
        .collect();
    assert_eq!(near, [0, 0, 1, 2, 3]);
    let settings = settings(&Discrimination, "e-puck", &[]);
    let evaluator = Discrimination.prepare("e-puck", &settings).unwrap();
    let description = evaluator.info().description;
    assert_eq!((evaluator.info().trials, description.steps, description.step_seconds), (10, 500, 0.1));
    assert_eq!(evaluator.info().schema.bodies, ["e-puck", "cylinder"]);
    // Its sensors were never measured, and a hull that the wheels stick out of is refused.
    let mut settings = settings;
    let sampled = settings.set("", "robot.infrared", Value::Word("sampled".into())).unwrap_err().to_string();
    assert!(sampled.contains("rays") && sampled.contains("analytic"), "{sampled}");
    let thin = settings.set("", "robot.radius", Value::Number(0.02)).unwrap_err().to_string();
    assert!(thin.contains("0.0265"), "{thin}");
    settings.set("", "robot.radius", Value::Number(0.035)).unwrap();
    assert!(Discrimination.prepare("e-puck", &settings).is_ok());
}

/// In rapier the same starts and the same rules; only how the robot moves differs.
#[cfg(feature = "rapier")]
#[test]
fn in_rapier_a_trial_starts_and_ends_as_in_the_kinematic_arena() {
    for (condition, config) in [("khepera", Config::default()), ("e-puck", Config::e_puck())] {
        let config = Config { steps: 60, ..config };
        let (mut ours, mut theirs) = (config.world().unwrap(), config.rapier_world().unwrap());
        let mut episode = CylinderEpisode::new(config.clone(), constant(&config, [50.0; 2])).unwrap();
        let mut collided = 0;
        for trial in 0..12 {
            let id = EpisodeId { seed: 5, trial, ..EpisodeId::default() };
            let mut ends = Vec::new();
            episode.arrange(&mut ours, id).unwrap();
            episode.arrange(&mut theirs, id).unwrap();
            for body in [episode.parts().body, episode.cylinders()[0]] {
                let (a, b) = (ours.pose(body), theirs.pose(body));
                assert!(
                    (0..3).all(|k| (a.position[k] - b.position[k]).abs() < 1e-6),
                    "{condition} {trial}: {a:?} {b:?}"
                );
                assert!((a.heading() - b.heading()).abs() < 1e-5, "{condition} {trial}");
            }
            run_episode(&mut episode, &mut ours, id, None);
            ends.push(*episode.trial());
            run_episode(&mut episode, &mut theirs, id, None);
            ends.push(*episode.trial());
            // Straight on until it runs into something: a step later at most, for it must get up to speed.
            let [a, b] = [&ends[0], &ends[1]];
            assert!(a.collided == b.collided && a.steps.abs_diff(b.steps) <= 2, "{condition} {trial}: {a:?} {b:?}");
            // The kinematic world undoes a step that collides, which is up to 14.4 mm long; 13.0 was seen.
            assert!((a.distance[0] - b.distance[0]).abs() < 0.0145, "{condition} {trial}: {a:?} {b:?}");
            collided += u32::from(b.collided);
        }
        assert!(collided > 6, "{condition}: {collided}");
        let settings = settings(&Discrimination, condition, &[("world.engine", Value::Word("rapier".into()))]);
        let mut evaluator = Discrimination.prepare(condition, &settings).unwrap();
        let own = parameters(&Discrimination, evaluator.as_ref(), |i| (i * 97 % 256) as u16);
        let id = EpisodeId { seed: 9, generation: 3, individual: 1, trial: 4 };
        let plain = evaluator.evaluate(alone(&own, id), None);
        evaluator.evaluate(alone(&own, EpisodeId { trial: 7, ..id }), None);
        let mut recording = Recording::new(evaluator.info().schema);
        assert_eq!(evaluator.evaluate(alone(&own, id), Some(&mut recording)), plain);
        assert!(plain.is_finite() && recording.times().len() == plain.steps as usize);
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let refused = |experiment: &dyn Experiment, condition, values: &[(&str, Value)]| {
        let settings = settings(experiment, condition, values);
        experiment.prepare(condition, &settings).err().unwrap().to_string()
    };
    let crowded = refused(&Discrimination, "", &[("object.radii", Value::Numbers(vec![0.15]))]);
    assert!(crowded.starts_with("`world.size`: no free place for a disc of 0.035 m in 1000 tries"), "{crowded}");
    let crowded = refused(&DiscriminationCylinders, "wheels", &[("object.to_object", Value::Number(5.0))]);
    assert!(crowded.starts_with("`world.size`: no free place"), "{crowded}");
    let sampled = ("robot.infrared", Value::Word("sampled".into()));
    let without = refused(&Discrimination, "", core::slice::from_ref(&sampled));
    assert!(without.starts_with("`robot.infrared_tables`: names no directory"), "{without}");
    let missing = Value::Word("no/such/place".into());
    let missing = refused(&Discrimination, "", &[sampled, ("robot.infrared_tables", missing)]);
    assert!(missing.contains("wall.sam"), "{missing}");
    let slow = refused(
        &Discrimination,
        "",
        &[("world.time_step", Value::Number(0.2)), ("world.size", Value::Numbers(vec![0.1; 2]))],
    );
    assert!(slow.starts_with("`world.size`"), "{slow}");
}

#[test]
fn a_damaged_table_is_named() {
    let directory = std::env::temp_dir().join(format!("farsa-tables-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let table = |row: &str| format!("8 1 1 5 2\nTURN 0\n{row}\nEND\n");
    for name in ["wall.sam", "small.sam", "round.sam"] {
        std::fs::write(directory.join(name), table("1 2 3 4 5 6 7 8")).unwrap();
    }
    let settings = settings(&Discrimination, "", &sampled(&directory));
    assert!(Discrimination.prepare("", &settings).is_ok());
    assert_eq!(Discrimination.files("", &settings).unwrap().len(), 3);
    std::fs::write(directory.join("small.sam"), table("1 2 3 4 5 6 7")).unwrap();
    let error = Discrimination.prepare("", &settings).err().unwrap().to_string();
    assert!(error.contains("small.sam: line 3: 7 numbers instead of 8"), "{error}");
    std::fs::remove_dir_all(&directory).unwrap();
}
