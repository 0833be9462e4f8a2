//! `braitenberg`: what the four vehicles do, and their symmetries.
#![allow(missing_docs, clippy::unwrap_used)]

use core::f32::consts::PI;

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_experiments::BRAITENBERG;
use farsa_lab::advanced::{Displacement, Value};
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Settings};
use farsa_num::{atan2, sin_cos};
use farsa_view::Recording;
use proptest::prelude::*;

/// The lamp is in the middle of the arena [m].
const LAMP: f32 = 1.0;

fn prepared(vehicle: &str, steps: i64) -> Box<dyn Evaluator> {
    let mut settings = Settings::new(BRAITENBERG.settings(vehicle)).unwrap();
    settings.set("", "trial.steps", Value::Whole(steps)).unwrap();
    BRAITENBERG.prepare(vehicle, &settings).unwrap()
}

/// Where a vehicle is seen from the lamp [m], and its heading, after each step from a start at a distance in a direction.
fn drive(vehicle: &str, [distance, direction, heading]: [f32; 3], steps: i64) -> (Vec<[f32; 3]>, Recording) {
    let mut evaluator = prepared(vehicle, steps);
    let (sine, cosine) = sin_cos(direction);
    let at = [LAMP + distance * cosine, LAMP + distance * sine];
    let Pose { position, rotation } = Pose::planar(at, heading);
    let put = [Displacement { step: 0, body: 0, position, rotation }];
    let mut recording = Recording::new(evaluator.info().schema);
    let evaluation = Evaluation { displacements: &put, ..Evaluation::new(&[0.0], EpisodeId::default()) };
    evaluator.evaluate(evaluation, Some(&mut recording));
    let pose = |step| recording.pose_at(step, BodyId(0)).unwrap();
    let seen = |step| [pose(step).position[0] - LAMP, pose(step).position[1] - LAMP, pose(step).heading()];
    let way = (0..recording.times().len()).map(seen).collect();
    (way, recording)
}

/// Distance of the lamp [m], and its bearing to the left of ahead [rad].
fn lamp([x, y, heading]: [f32; 3]) -> [f32; 2] {
    let (sine, cosine) = sin_cos(atan2(-y, -x) - heading);
    [x.hypot(y), atan2(sine, cosine)]
}

const VEHICLES: [&str; 4] = ["2a", "2b", "3a", "3b"];

#[test]
fn distances_change_as_the_names_say() {
    for vehicle in VEHICLES {
        let mut evaluator = prepared(vehicle, 600);
        let (mut outcomes, mut right) = (Vec::new(), 0);
        for trial in 0..400 {
            let id = EpisodeId { seed: 1, trial, ..EpisodeId::default() };
            let mut recording = Recording::new(evaluator.info().schema);
            let outcome = evaluator.evaluate(Evaluation::new(&[0.0], id), Some(&mut recording));
            let first = recording.pose_at(0, BodyId(0)).unwrap();
            let [far, off] = lamp([first.position[0] - LAMP, first.position[1] - LAMP, first.heading()]);
            // Love comes if the lamp is ahead and farther than where the vehicle rests. From behind it leaves the lamp.
            if vehicle == "3a" && (off.abs() > PI / 2.0 || far < 0.3) {
                continue;
            }
            let comes = vehicle == "2b" || vehicle == "3a";
            assert_eq!(outcome.success, (outcome.terms[0] > 0.0) == comes, "{outcome:?}");
            right += usize::from(outcome.success);
            outcomes.push(outcome);
        }
        println!("{vehicle}: {right} of {}, approach {:.3} m", outcomes.len(), evaluator.fitness(&outcomes));
        assert!(outcomes.len() > 80 && 100 * right >= 95 * outcomes.len(), "{vehicle}: {right}");
    }
}

#[test]
fn vehicles_end_as_their_names_say() {
    // The lamp is ahead, 60 degrees to the left.
    let start = [0.3, 0.0, PI - PI / 3.0];
    let end = |vehicle| {
        let (way, recording) = drive(vehicle, start, 600);
        (lamp(way[599]), recording)
    };
    let ([far, _], recording) = end("2b");
    let columns = recording.schema().columns();
    let touch = columns.iter().position(|column| column == "steps in collision").unwrap();
    let collisions: f64 = (0..600).filter_map(|step| recording.row(step).nth(touch)).sum();
    assert!(far < 0.06 && collisions > 0.0, "{far} {collisions}");
    let ([far, off], recording) = end("3a");
    assert!(far < 0.3 && off.abs() < 0.2, "{far} {off}");
    let first = columns.iter().position(|column| column == "output.left wheel").unwrap();
    let rest: Vec<f64> = recording.row(599).skip(first).take(2).collect();
    assert!(rest.iter().all(|y| y.abs() < 0.02), "comes to rest: {rest:?}");
    for vehicle in ["2a", "3b"] {
        let ([far, off], _) = end(vehicle);
        assert!(far > 0.5 && off.abs() > 2.5, "{vehicle}: {far} {off}");
    }
    // Where it is bright fear hurries and love lingers.
    let pace = |vehicle, distance: f32| {
        let (way, _) = drive(vehicle, [distance, 0.0, PI / 2.0], 1);
        (way[0][0] - distance).hypot(way[0][1])
    };
    assert!(pace("2a", 0.15) > 2.0 * pace("2a", 0.5));
    assert!(pace("3b", 0.15) < 0.8 * pace("3b", 0.5));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_symmetric_start_is_a_straight_line(which in 0_usize..4, distance in 0.1_f32..0.5, away: bool) {
        let heading = if away { 0.0 } else { PI };
        let (way, _) = drive(VEHICLES[which], [distance, 0.0, heading], 400);
        // Love that faces away turns from the lamp, which amplifies every rounding: of 1500 distances the worst ended 3 mm and 7
        // mrad off the line. All others kept to it within 1e-5 rad.
        let unstable = away && VEHICLES[which] == "3a";
        let (aside, turn) = if unstable { (1e-2, 0.03) } else { (1e-5, 1e-4) };
        for &[x, y, turned] in &way {
            prop_assert!(y.abs() < aside, "{x} {y}");
            prop_assert!((turned.abs() - heading).abs() < turn, "{turned}");
        }
        let [start, end] = [distance, lamp(way[way.len() - 1])[0]];
        prop_assert!(if away { end >= start - 1e-5 } else { end <= start + 1e-5 }, "{start} {end}");
    }

    #[test]
    fn mirrored_starts_go_mirrored_ways(
        which in 0_usize..4, distance in 0.1_f32..0.5, direction in -3.0_f32..3.0, heading in -3.0_f32..3.0,
    ) {
        let (way, _) = drive(VEHICLES[which], [distance, direction, heading], 100);
        let (mirrored, _) = drive(VEHICLES[which], [distance, -direction, -heading], 100);
        for (a, b) in way.iter().zip(&mirrored) {
            prop_assert!((a[0] - b[0]).abs() < 1e-4 && (a[1] + b[1]).abs() < 1e-4, "{a:?} {b:?}");
            let turned = a[2] + b[2];
            prop_assert!(turned.abs() < 1e-3 || (turned.abs() - 2.0 * PI).abs() < 1e-3, "{a:?} {b:?}");
        }
    }
}

#[test]
fn nothing_evolves_and_bad_values_are_refused() {
    let mut settings = Settings::new(BRAITENBERG.settings("2a")).unwrap();
    let error = settings.set("", "evolution.generations", Value::Whole(5)).unwrap_err().to_string();
    assert_eq!(error, "`evolution.generations`: 5 is outside 1 to 1");
    settings.set("", "lamp.radius", Value::Number(0.02)).unwrap();
    for list in [vec![0.3, 0.2], vec![0.05, 0.2], vec![0.5, 5.0]] {
        settings.set("", "start.distance", Value::Numbers(list.clone())).unwrap();
        let error = BRAITENBERG.prepare("2a", &settings).err().unwrap().to_string();
        assert!(error.starts_with("`start.distance`: from "), "{list:?}: {error}");
    }
}
