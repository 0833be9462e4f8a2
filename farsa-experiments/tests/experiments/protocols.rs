//! Test protocols of the experiments: what a case changes, and that lanes change nothing.

use farsa_body::ports::BodyId;
use farsa_body::{Pose, Recorder};
use farsa_experiments::FORAGING;
use farsa_experiments::minimal_cognition::MinimalCognition;
use farsa_experiments::reach_grasp_lift::ReachGraspLift;
use farsa_lab::advanced::{CaseId, Genotype, Lanes, Protocol, Value};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment, Outcome, Settings};
use farsa_num::{Domain, Instructions, Stream};

/// The recording of an episode.
#[derive(Default)]
struct Seen {
    sensors: Vec<Vec<f32>>,
    outputs: Vec<Vec<f32>>,
    scalars: Vec<Vec<f64>>,
    /// Poses of the bodies, one of each at every step.
    poses: Vec<(BodyId, Pose<f32>)>,
}

impl Recorder for Seen {
    fn sensors(&mut self, values: &[f32]) {
        self.sensors.push(values.into());
    }
    fn outputs(&mut self, values: &[f32]) {
        self.outputs.push(values.into());
    }
    fn scalars(&mut self, values: &[f64]) {
        self.scalars.push(values.into());
    }
    fn pose(&mut self, body: BodyId, pose: Pose<f32>) {
        self.poses.push((body, pose));
    }
    fn tick(&mut self, _: f64) {}
}

fn evaluator(experiment: &dyn Experiment, condition: &str, changed: &[(&str, Value)]) -> Box<dyn Evaluator> {
    let mut settings = Settings::new(experiment.settings(condition)).unwrap();
    for (key, value) in changed {
        settings.set("", key, value.clone()).unwrap();
    }
    experiment.prepare(condition, &settings).unwrap()
}

/// A random individual.
fn parameters(evaluator: &dyn Evaluator) -> Vec<f32> {
    let mut stream = Stream::new(5, Domain::InitialGenome, 0, 0, 0);
    let genotype = Genotype::new(&evaluator.info().parameters, 16);
    let genes: Vec<u16> = evaluator.info().parameters.iter().map(|_| stream.below(65536) as u16).collect();
    genotype.decode(&genes).unwrap()
}

fn id(trial: u32) -> EpisodeId {
    EpisodeId { seed: 1 << 63 | 3, generation: 0, individual: 0, trial }
}

/// The case of this row and column of a protocol, as an evaluation takes it.
#[allow(clippy::unnecessary_wraps)]
fn case(evaluator: &dyn Evaluator, name: &str, row: &str, column: &str) -> Option<CaseId> {
    let protocols = evaluator.info().protocols;
    let protocol = protocols.iter().position(|protocol| protocol.name == name).unwrap();
    let wanted = |case: &farsa_lab::advanced::Case| case.row == row && case.column == column;
    let case = protocols[protocol].cases.iter().position(wanted).unwrap();
    Some(CaseId { protocol, case })
}

fn seen(evaluator: &mut dyn Evaluator, case: Option<CaseId>, trial: u32) -> (Outcome, Seen) {
    let parameters = parameters(evaluator);
    let mut seen = Seen::default();
    let outcome = evaluator.evaluate(Evaluation { case, ..Evaluation::new(&parameters, id(trial)) }, Some(&mut seen));
    (outcome, seen)
}

#[test]
fn the_protocols_of_all_experiments_can_be_run() {
    for experiment in farsa_experiments::all() {
        let conditions = experiment.conditions();
        for condition in conditions.iter().copied().chain(conditions.is_empty().then_some("")) {
            let settings = Settings::new(experiment.settings(condition)).unwrap();
            // Some need a file.
            let Ok(evaluator) = experiment.prepare(condition, &settings) else { continue };
            Protocol::check(&evaluator.info().protocols).unwrap();
        }
    }
}

/// Every case of all protocols, twice, in lanes and alone. A plain trial after each is the same as before any.
fn in_lanes_as_alone(mut evaluator: Box<dyn Evaluator>, most: usize) {
    let parameters = parameters(evaluator.as_ref());
    let plain = Evaluation::new(&parameters, id(1));
    let before = evaluator.evaluate(plain, None);
    let protocols = evaluator.info().protocols;
    let all = protocols.iter().enumerate().flat_map(|(protocol, about)| {
        (0..about.cases.len().min(most)).map(move |case| Some(CaseId { protocol, case }))
    });
    let all: Vec<Evaluation<'_>> = all
        .flat_map(|case| [None, case])
        .enumerate()
        .map(|(number, case)| Evaluation { number, case, ..plain })
        .collect();
    let alone: Vec<Outcome> = all.iter().map(|evaluation| evaluator.evaluate(*evaluation, None)).collect();
    assert!(alone.iter().step_by(2).all(|outcome| *outcome == before));
    assert!(alone.iter().any(|outcome| *outcome != before));
    if let Some(lanes) = evaluator.in_lanes() {
        lanes.use_lanes(Lanes::new(8, Instructions::detect()).unwrap()).unwrap();
        let (mut rest, mut found) = (all.iter().copied(), vec![None; all.len()]);
        lanes.run_in_lanes(&mut || rest.next(), &mut |number, outcome| found[number] = Some(outcome));
        assert!(found.into_iter().eq(alone.into_iter().map(Some)));
    }
}

#[test]
fn cases_in_lanes_are_those_alone_and_leave_nothing_behind() {
    in_lanes_as_alone(evaluator(&MinimalCognition, "", &[]), 99);
    let condition = FORAGING.conditions()[0];
    in_lanes_as_alone(evaluator(&FORAGING, condition, &[("trial.steps", Value::Whole(60))]), 99);
    for condition in ["labels", "self-labels"] {
        in_lanes_as_alone(evaluator(&ReachGraspLift, condition, &[]), 3);
    }
}

#[test]
fn objects_of_psychophysics_fall_from_their_part_of_the_line() {
    let mut evaluator = evaluator(&MinimalCognition, "", &[]);
    let protocol = evaluator.info().protocols.remove(0);
    assert_eq!((protocol.name.as_str(), protocol.cases.len()), ("psychophysics", 22));
    // 100 units in 11 parts.
    for (number, about) in protocol.cases.iter().enumerate() {
        let centre: f64 = about.column.parse().unwrap();
        assert!((centre - (100.0 / 11.0) * ((number % 11) as f64 - 5.0)).abs() < 0.051, "{centre}");
        let mut places = Vec::new();
        for trial in 0..6 {
            let (outcome, seen) = seen(evaluator.as_mut(), Some(CaseId { protocol: 0, case: number }), trial);
            let object = seen.scalars[0][1];
            assert!((object - centre).abs() <= 50.0 / 11.0 + 0.051, "{object} {centre}");
            places.push(object - centre);
            assert_eq!(outcome.notes[0], ("object", about.row.as_str().into()));
        }
        // Trials differ, and they do so alike in all cases.
        assert!((places[0] - places[1]).abs() > 1e-6);
        if number > 0 {
            let (_, first) = seen(evaluator.as_mut(), Some(CaseId { protocol: 0, case: 0 }), 0);
            assert!((first.scalars[0][1] + 50.0 * 10.0 / 11.0 - places[0]).abs() < 0.11);
        }
    }
}

#[test]
fn a_team_of_one_has_one_robot() {
    let mut evaluator = evaluator(&FORAGING, FORAGING.conditions()[0], &[("trial.steps", Value::Whole(40))]);
    let cases = evaluator.info().protocols.remove(0).cases;
    let all: u16 = cases.last().unwrap().row.parse().unwrap();
    assert!(cases.iter().all(|case| case.held_out == (case.row != all.to_string())));
    for about in &cases {
        let wanted = case(evaluator.as_ref(), "team-size", &about.row, "");
        let (outcome, seen) = seen(evaluator.as_mut(), wanted, 0);
        let inside = |(body, pose): &&(BodyId, Pose<f32>)| body.0 < all && pose.position[0] >= 0.0;
        let mut there: Vec<u16> = seen.poses.iter().filter(inside).map(|(body, _)| body.0).collect();
        there.sort_unstable();
        there.dedup();
        assert_eq!(there, (0..about.row.parse().unwrap()).collect::<Vec<u16>>());
        assert!(outcome.is_finite());
    }
    // The whole team is the plain trial.
    let whole = case(evaluator.as_ref(), "team-size", &all.to_string(), "");
    assert_eq!(seen(evaluator.as_mut(), whole, 0).0, seen(evaluator.as_mut(), None, 0).0);
}

#[test]
fn own_labels_are_recorded_as_inputs_and_outputs_and_can_be_removed() {
    let mut evaluator = evaluator(&ReachGraspLift, "self-labels", &[("trial.steps", Value::Whole(60))]);
    let columns = evaluator.info().schema.columns();
    for n in 1..=3 {
        for name in [format!("sensor.label {n}"), format!("output.next label {n}")] {
            assert_eq!(columns.iter().filter(|column| **column == name).count(), 1, "{name} in {columns:?}");
        }
    }
    let (plain, spoken) = seen(evaluator.as_mut(), None, 1);
    assert_eq!(spoken.sensors[0][26..], [0.0; 3]);
    for (inputs, outputs) in spoken.sensors[1..].iter().zip(&spoken.outputs) {
        assert!(inputs[26..].iter().zip(&outputs[23..]).all(|(input, output)| *input == 50.0 * output));
        assert!(outputs[23..].iter().all(|label| *label > 0.0));
    }
    let removed = case(evaluator.as_ref(), "labels", "removed", "");
    assert_ne!(seen(evaluator.as_mut(), removed, 1).0, plain);
    let trained = case(evaluator.as_ref(), "labels", "as trained", "");
    assert_eq!(seen(evaluator.as_mut(), trained, 1).0, plain);
    // There is no phase that could be wrong.
    let info = evaluator.info();
    let protocol = info.protocols.iter().find(|protocol| protocol.name == "labels").unwrap();
    assert_eq!(protocol.cases.len(), 2);
    // A silent output for a label is a label of 0 in the next step.
    let anatomy = info.anatomy.unwrap();
    assert!(anatomy.intervention("output:next label 2").is_ok());
    assert!(anatomy.intervention("sensor:label 2").is_ok());
}

#[test]
fn starts_are_paired_and_labels_removed_or_wrong() {
    let labels = ReachGraspLift.conditions()[0];
    let mut evaluator = evaluator(&ReachGraspLift, labels, &[]);
    let label = |seen: &Seen| seen.sensors[0][26..].to_vec();
    let (plain, as_it_is) = seen(evaluator.as_mut(), None, 1);
    let at = |evaluator: &dyn Evaluator, row: &str| case(evaluator, "labels", row, "");
    let trained = at(evaluator.as_ref(), "as trained");
    assert_eq!(seen(evaluator.as_mut(), trained, 1).0, plain);
    let wrong = at(evaluator.as_ref(), "of the next phase");
    let amplitude = as_it_is.sensors[0][26];
    assert!(amplitude > 0.0);
    assert_eq!(label(&as_it_is), [amplitude, 0.0, 0.0]);
    assert_eq!(label(&seen(evaluator.as_mut(), wrong, 1).1), [0.0, amplitude, 0.0]);
    let removed = at(evaluator.as_ref(), "removed");
    assert_ne!(seen(evaluator.as_mut(), removed, 1).0, plain);

    // Posture 2 with place 2 is the plain trial 1. Another place moves the sphere, and not the arm.
    let start = |evaluator: &dyn Evaluator, row: &str, column: &str| case(evaluator, "start-positions", row, column);
    let own = start(evaluator.as_ref(), "posture 2", "place 2");
    assert_eq!(seen(evaluator.as_mut(), own, 1).0, plain);
    let other = start(evaluator.as_ref(), "posture 2", "place 3");
    let moved = seen(evaluator.as_mut(), other, 1).1;
    assert_eq!(moved.sensors[0][..17], as_it_is.sensors[0][..17]);
    assert_ne!(moved.sensors[0][23..26], as_it_is.sensors[0][23..26]);
    let held_out = evaluator.info().protocols.remove(0).cases.iter().filter(|case| case.held_out).count();
    assert_eq!(held_out, 12);
}
