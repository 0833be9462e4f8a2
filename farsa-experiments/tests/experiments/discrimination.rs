//! `discrimination`: the original's genotypes, the starts and the course of trials.

use std::path::{Path, PathBuf};
use std::process::Command;

use farsa_body::ports::BodyId;
use farsa_experiments::{DISCRIMINATION, DISCRIMINATION_CYLINDERS};
use farsa_lab::advanced::{Genotype, Value};
use farsa_lab::exports::NetworkExport;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Note, Outcome, Settings};
use farsa_view::Recording;

/// The original's measured tables and genotypes: in the folder `khepera` of `FARSA_FIXTURES`, or in that next to the repository.
///
/// They are not part of the repository. In CI they must be there. In other places the test prints that it is skipped.
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

/// The value that `farsa evaluate` prints as `name`, of 2000 random trials.
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

/// The parameters of a layer with all weights 0 and these biases, which come first: the robot drives straight on or does not move.
fn constant(evaluator: &dyn Evaluator, bias: f32) -> Vec<f32> {
    let mut parameters = vec![0.0; evaluator.info().parameters.len()];
    parameters[..2].fill(bias);
    parameters
}

/// A trial with its recording.
fn recorded(evaluator: &mut dyn Evaluator, parameters: &[f32], id: EpisodeId) -> (Outcome, Recording) {
    let mut recording = Recording::new(evaluator.info().schema);
    let outcome = evaluator.evaluate(alone(parameters, id), Some(&mut recording));
    (outcome, recording)
}

/// Where a body is after a step [m].
fn place(recording: &Recording, step: usize, body: usize) -> [f64; 2] {
    let [x, y, _] = recording.pose_at(step, BodyId(body as u16)).unwrap().position;
    [x, y].map(f64::from)
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn note(outcome: &Outcome, name: &str) -> f64 {
    let (_, note) = outcome.notes.iter().find(|(known, _)| *known == name).unwrap();
    let Note::Number(number) = note else { panic!("{note:?}") };
    *number
}

/// An experiment, the condition, the radius of the hull, and those of the cylinders with the size of the arena [m].
type Case = (&'static dyn Experiment, &'static str, f64, &'static [f64], f64);

const CASES: [Case; 3] = [
    (&DISCRIMINATION, "khepera", 0.035, &[0.0125], 0.4),
    (&DISCRIMINATION, "e-puck", 0.0275, &[0.0125], 0.4),
    (&DISCRIMINATION_CYLINDERS, "wheels", 0.035, &[0.027, 0.0125], 0.5),
];

#[test]
fn trials_start_where_the_rules_allow() {
    for (experiment, condition, hull, radii, size) in CASES {
        let settings = settings(experiment, condition, &[("trial.steps", Value::Whole(1))]);
        let mut evaluator = experiment.prepare(condition, &settings).unwrap();
        let still = constant(evaluator.as_ref(), 0.0);
        let mut start = |id| recorded(evaluator.as_mut(), &still, id).1;
        let (mut starts, mut quadrants) = (Vec::new(), [0; 4]);
        for trial in 0..1000 {
            let recording = start(EpisodeId { seed: 3, trial, ..EpisodeId::default() });
            let robot = place(&recording, 0, 0);
            let to_wall = |[x, y]: [f64; 2]| x.min(y).min(size - x).min(size - y);
            assert!(to_wall(robot) - hull > 0.01 - 1e-5, "{robot:?}");
            let places: Vec<_> = (1..=radii.len()).map(|body| place(&recording, 0, body)).collect();
            for (place, radius) in places.iter().zip(radii) {
                assert!(to_wall(*place) - radius > 0.05 - 1e-5, "{place:?}");
                assert!(apart(*place, robot) - radius - hull > 0.1 - 1e-5, "{place:?} {robot:?}");
            }
            if let [a, b] = places[..] {
                assert!(apart(a, b) - radii.iter().sum::<f64>() > 0.17 - 1e-5);
            }
            let heading = recording.pose_at(0, BodyId(0)).unwrap().heading();
            quadrants[((heading + core::f32::consts::PI) / core::f32::consts::FRAC_PI_2).min(3.0) as usize] += 1;
            starts.push(robot);
        }
        assert!(quadrants.iter().all(|count| (200..300).contains(count)), "{quadrants:?}");
        let id = EpisodeId { seed: 3, trial: 5, ..EpisodeId::default() };
        assert_eq!(place(&start(id), 0, 0), starts[5]);
        for other in [EpisodeId { seed: 4, ..id }, EpisodeId { individual: 1, ..id }, EpisodeId { generation: 1, ..id }]
        {
            assert_ne!(place(&start(other), 0, 0), starts[5]);
        }
    }
}

/// Straight on at full speed: 5.18 mm a step of the Khepera, 14.4 mm of the e-puck.
#[test]
fn a_step_near_the_cylinder_counts_and_a_collision_ends_the_trial() {
    for (experiment, condition, hull, radii, _) in &CASES[..2] {
        let (near, step, most) = if *condition == "khepera" { (0.08, 0.00518, 25) } else { (0.06, 0.0144, 10) };
        let settings = settings(*experiment, condition, &[("trial.steps", Value::Whole(most))]);
        let mut evaluator = experiment.prepare(condition, &settings).unwrap();
        let ahead = constant(evaluator.as_ref(), 50.0);
        let (mut counted, mut ends) = (0, [0; 3]);
        for trial in 0..200 {
            let id = EpisodeId { seed: 1, trial, ..EpisodeId::default() };
            let (outcome, recording) = recorded(evaluator.as_mut(), &ahead, id);
            let steps = outcome.steps as usize;
            assert_eq!(recording.times().len(), steps);
            let distances: Vec<f64> = (0..steps)
                .map(|step| apart(place(&recording, step, 0), place(&recording, step, 1)) - hull - radii[0])
                .collect();
            assert!(distances.iter().all(|distance| *distance > -1e-5), "{distances:?}");
            // No distance is within rounding of the limit.
            let found = distances.iter().filter(|distance| **distance < near).count();
            counted += found;
            assert_eq!(note(&outcome, "steps near"), found as f64);
            assert_eq!(outcome.terms, [found as f64 / most as f64]);
            let collided = note(&outcome, "collisions");
            assert!(collided == 1.0 || steps == most as usize, "{steps}");
            assert_eq!(outcome.success, collided == 0.0 && distances[steps - 1] < near);
            if steps > 2 {
                let way = apart(place(&recording, 1, 0), place(&recording, 0, 0));
                assert!((way - step).abs() < 1e-4, "{way}");
            }
            let kind = if collided == 0.0 { 0 } else { 1 + usize::from(distances[steps - 1] < 0.02) };
            ends[kind] += 1;
        }
        assert!(counted > 50, "{counted}");
        assert!(ends.iter().all(|count| *count > 0), "in time, at a wall, at the cylinder: {ends:?}");
    }
}

/// Biases first and then the weights of each wheel, as FARSA wrote its genotypes.
#[test]
fn genes_are_read_as_the_original_wrote_them() {
    let evaluator = DISCRIMINATION.prepare("khepera", &settings(&DISCRIMINATION, "khepera", &[])).unwrap();
    let genes = [0, 255, 10, 20, 30, 40, 50, 60, 110, 120, 130, 140, 150, 160];
    let parameters = parameters(&DISCRIMINATION, evaluator.as_ref(), |gene| genes[gene]);
    let controller = evaluator.exports().unwrap().controller(&parameters).unwrap();
    let NetworkExport::Perceptron { parameters, .. } = controller.network else { panic!("another network") };
    // To the last bit: w = range - gene / 255 * 2 range.
    let weight = |gene: u16| (5.0 - f64::from(gene) / 255.0 * 2.0 * 5.0) as f32;
    for sensor in 0..6 {
        for wheel in 0..2 {
            assert_eq!(parameters[2 * sensor + wheel], weight(genes[2 + 6 * wheel + sensor]), "{sensor} {wheel}");
        }
    }
    assert_eq!(parameters[12..], [5.0, -5.0]);
}

#[test]
fn trials_can_be_repeated_and_recorded() {
    let cases: [(&dyn Experiment, &str, usize); 4] = [
        (&DISCRIMINATION, "khepera", 6),
        (&DISCRIMINATION, "e-puck", 6),
        (&DISCRIMINATION_CYLINDERS, "wheels", 8),
        (&DISCRIMINATION_CYLINDERS, "no-wheels", 6),
    ];
    for (experiment, condition, inputs) in cases {
        for model in ["analytic", "rays"] {
            let settings = settings(experiment, condition, &[("robot.infrared", Value::Word(model.into()))]);
            let mut evaluator = experiment.prepare(condition, &settings).unwrap();
            let parameters = parameters(experiment, evaluator.as_ref(), |i| (i * 97 % 256) as u16);
            let id = EpisodeId { seed: 9, generation: 3, individual: 1, trial: 4 };
            let plain = evaluator.evaluate(alone(&parameters, id), None);
            evaluator.evaluate(alone(&parameters, EpisodeId { trial: 7, ..id }), None);
            let (outcome, recording) = recorded(evaluator.as_mut(), &parameters, id);
            assert_eq!(outcome, plain);
            let ticks = recording.times().len();
            assert_eq!(ticks, plain.steps as usize);
            assert!((0..ticks).all(|tick| recording.row(tick).all(f64::is_finite)));
            assert_eq!(recording.rays_at(ticks - 1).len(), 6);
            let description = evaluator.info().description;
            assert_eq!(description.sensors.iter().map(|g| g.count).sum::<usize>(), inputs);
            assert_eq!(description.parameters, parameters.len());
        }
    }
}

#[test]
fn an_e_puck_has_its_own_numbers() {
    let mut settings = settings(&DISCRIMINATION, "e-puck", &[]);
    let evaluator = DISCRIMINATION.prepare("e-puck", &settings).unwrap();
    let description = evaluator.info().description;
    assert_eq!((evaluator.info().trials, description.steps, description.step_seconds), (10, 500, 0.1));
    assert_eq!(evaluator.info().schema.bodies, ["e-puck", "cylinder"]);
    // Its sensors were never measured, and a hull that the wheels stick out of is refused.
    let sampled = settings.set("", "robot.infrared", Value::Word("sampled".into())).unwrap_err().to_string();
    assert!(sampled.contains("rays") && sampled.contains("analytic"), "{sampled}");
    let thin = settings.set("", "robot.radius", Value::Number(0.02)).unwrap_err().to_string();
    assert!(thin.contains("0.0265"), "{thin}");
    settings.set("", "robot.radius", Value::Number(0.035)).unwrap();
    assert!(DISCRIMINATION.prepare("e-puck", &settings).is_ok());
}

/// In rapier the same starts and the same rules. Only the motion of the robot differs.
#[cfg(feature = "rapier")]
#[test]
fn in_rapier_a_trial_starts_and_ends_as_in_the_kinematic_arena() {
    for (condition, hull) in [("khepera", 0.035), ("e-puck", 0.0275)] {
        let [mut ours, mut theirs] = ["arena", "rapier"].map(|engine| {
            let values = [("trial.steps", Value::Whole(60)), ("world.engine", Value::Word(engine.into()))];
            DISCRIMINATION.prepare(condition, &settings(&DISCRIMINATION, condition, &values)).unwrap()
        });
        let (still, ahead) = (constant(ours.as_ref(), 0.0), constant(ours.as_ref(), 50.0));
        let mut collided = 0.0;
        for trial in 0..12 {
            let id = EpisodeId { seed: 5, trial, ..EpisodeId::default() };
            let [a, b] = [&mut ours, &mut theirs].map(|evaluator| recorded(evaluator.as_mut(), &still, id).1);
            for body in 0..2 {
                let far = apart(place(&a, 0, body), place(&b, 0, body));
                assert!(far < 5e-5, "{condition} {trial}: {far}");
                let [a, b] = [&a, &b].map(|recording| recording.pose_at(0, BodyId(body as u16)).unwrap().heading());
                // The recording begins after a step, in which the rigid robot settles on its wheels.
                assert!((a - b).abs() < 1e-3, "{condition} {trial}: {a} {b}");
            }
            let [a, b] = [&mut ours, &mut theirs].map(|evaluator| recorded(evaluator.as_mut(), &ahead, id));
            // Straight on until it runs into something: two steps later at most, for it has to get up to speed.
            let [end_a, end_b] = [&a, &b].map(|(outcome, _)| note(outcome, "collisions"));
            assert!(
                end_a == end_b && a.0.steps.abs_diff(b.0.steps) <= 2,
                "{condition} {trial}: {end_a} {end_b} {} {}",
                a.0.steps,
                b.0.steps
            );
            // The kinematic world undoes a step that collides, which is up to 14.4 mm long.
            let [far_a, far_b] = [&a, &b].map(|(outcome, recording)| {
                let last = outcome.steps as usize - 1;
                apart(place(recording, last, 0), place(recording, last, 1)) - hull - 0.0125
            });
            assert!((far_a - far_b).abs() < 0.0145, "{condition} {trial}: {far_a} {far_b}");
            collided += end_b;
        }
        assert!(collided > 6.0, "{condition}: {collided}");
        let parameters = parameters(&DISCRIMINATION, theirs.as_ref(), |i| (i * 97 % 256) as u16);
        let id = EpisodeId { seed: 9, generation: 3, individual: 1, trial: 4 };
        let plain = theirs.evaluate(alone(&parameters, id), None);
        theirs.evaluate(alone(&parameters, EpisodeId { trial: 7, ..id }), None);
        let (outcome, recording) = recorded(theirs.as_mut(), &parameters, id);
        assert_eq!(outcome, plain);
        assert!(plain.is_finite() && recording.times().len() == plain.steps as usize);
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let refused = |experiment: &dyn Experiment, condition, values: &[(&str, Value)]| {
        let settings = settings(experiment, condition, values);
        experiment.prepare(condition, &settings).err().unwrap().to_string()
    };
    let crowded = refused(&DISCRIMINATION, "", &[("object.radii", Value::Numbers(vec![0.15]))]);
    assert!(crowded.starts_with("`world.size`: no free place for a disc of 0.035 m in 1000 tries"), "{crowded}");
    let crowded = refused(&DISCRIMINATION_CYLINDERS, "wheels", &[("object.to_object", Value::Number(5.0))]);
    assert!(crowded.starts_with("`world.size`: no free place"), "{crowded}");
    let sampled = ("robot.infrared", Value::Word("sampled".into()));
    let without = refused(&DISCRIMINATION, "", core::slice::from_ref(&sampled));
    assert!(without.starts_with("`robot.infrared_tables`: names no directory"), "{without}");
    let missing = Value::Word("no/such/place".into());
    let missing = refused(&DISCRIMINATION, "", &[sampled, ("robot.infrared_tables", missing)]);
    assert!(missing.contains("wall.sam"), "{missing}");
    let slow = refused(
        &DISCRIMINATION,
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
    let settings = settings(&DISCRIMINATION, "", &sampled(&directory));
    assert!(DISCRIMINATION.prepare("", &settings).is_ok());
    assert_eq!(DISCRIMINATION.files("", &settings).unwrap().len(), 3);
    std::fs::write(directory.join("small.sam"), table("1 2 3 4 5 6 7")).unwrap();
    let error = DISCRIMINATION.prepare("", &settings).err().unwrap().to_string();
    assert!(error.contains("small.sam: line 3: 7 numbers instead of 8"), "{error}");
    std::fs::remove_dir_all(&directory).unwrap();
}
