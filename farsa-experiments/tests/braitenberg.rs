//! `braitenberg`: what the four vehicles do, and their symmetries.
#![allow(missing_docs, clippy::unwrap_used)]

use core::f32::consts::PI;

use farsa_body::ports::{Kinematics as _, World as _};
use farsa_experiments::Braitenberg;
use farsa_experiments::braitenberg::{Config, Vehicle, VehicleEpisode};
use farsa_lab::{Episode as _, EpisodeId, Evaluation, Experiment as _, Note, Outcome, Settings, Value};
use farsa_physics::arena::World;
use proptest::prelude::*;

/// Steps a vehicle from a start to the end; its places and headings, and the episode.
fn drive(vehicle: Vehicle, [distance, direction, heading]: [f32; 3], steps: u32) -> (Vec<[f32; 3]>, VehicleEpisode) {
    let config = Config { steps, ..Config::for_vehicle(vehicle) };
    let mut world = World::new(&config.arena()).unwrap();
    let mut episode = VehicleEpisode::new(config).unwrap();
    episode.place(&mut world, distance, direction, heading);
    let mut way = Vec::new();
    loop {
        episode.act(&mut world);
        world.step();
        let end = episode.judge(&mut world);
        let pose = world.pose(episode.parts().body);
        way.push([pose.position[0] - 1.0, pose.position[1] - 1.0, pose.heading()]);
        if end.is_some() {
            return (way, episode);
        }
    }
}

#[test]
fn distances_change_as_the_names_say() {
    for vehicle in Vehicle::ALL {
        let settings = Settings::new(Braitenberg.settings(vehicle.name())).unwrap();
        let mut evaluator = Braitenberg.prepare(vehicle.name(), &settings).unwrap();
        let mut evaluate = |trial| {
            let id = EpisodeId { seed: 1, trial, ..EpisodeId::default() };
            evaluator.evaluate(Evaluation::new(&[0.0], id), None)
        };
        let mut outcomes: Vec<Outcome> = (0..400).map(&mut evaluate).collect();
        if vehicle == Vehicle::Love {
            // It comes if the lamp is before it and farther than where it comes to rest; from behind it leaves unawares.
            let number = |outcome: &Outcome, name: &str| {
                let note = outcome.notes.iter().find(|(key, _)| *key == name).unwrap();
                let Note::Number(x) = note.1 else { panic!("{note:?}") };
                x
            };
            outcomes.retain(|outcome| {
                let off = number(outcome, "lamp off ahead at the start [deg]");
                off < 90.0 && number(outcome, "distance at the start [m]") > 0.3
            });
        }
        let right = outcomes.iter().filter(|outcome| outcome.success).count();
        println!("{}: {right} of {}, approach {:.3} m", vehicle.name(), outcomes.len(), evaluator.fitness(&outcomes));
        assert!(
            outcomes.len() > 80 && 100 * right >= 95 * outcomes.len(),
            "{vehicle:?}: {right} of {}",
            outcomes.len()
        );
    }
}

#[test]
fn vehicles_end_as_they_are_known_to() {
    // The lamp is ahead, 60 degrees to the left.
    let start = [0.3, 0.0, PI - PI / 3.0];
    let end = |vehicle| drive(vehicle, start, 600).1;
    let aggression = end(Vehicle::Aggression);
    assert!(aggression.distances()[1] < 0.06 && aggression.steps()[1] > 0, "{:?}", aggression.distances());
    let love = end(Vehicle::Love);
    assert!(
        love.distances()[1] < 0.3 && love.bearings()[1].abs() < 0.2,
        "{:?} {}",
        love.distances(),
        love.bearings()[1]
    );
    assert!(love.done().iter().all(|y| (y - 0.5).abs() < 0.02), "comes to rest: {:?}", love.done());
    for vehicle in [Vehicle::Fear, Vehicle::Explorer] {
        let episode = end(vehicle);
        assert!(
            episode.distances()[1] > 0.5 && episode.bearings()[1].abs() > 2.5,
            "{vehicle:?}: {:?} {}",
            episode.distances(),
            episode.bearings()[1]
        );
    }
    // Where it is bright fear hurries and love lingers.
    let pace = |vehicle, distance: f32| {
        let (way, _) = drive(vehicle, [distance, 0.0, PI / 2.0], 1);
        (way[0][0] - distance).hypot(way[0][1])
    };
    assert!(pace(Vehicle::Fear, 0.15) > 2.0 * pace(Vehicle::Fear, 0.5));
    assert!(pace(Vehicle::Explorer, 0.15) < 0.8 * pace(Vehicle::Explorer, 0.5));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_symmetric_start_is_a_straight_line(which in 0_usize..4, distance in 0.1_f32..0.5, away: bool) {
        let heading = if away { 0.0 } else { PI };
        let (way, episode) = drive(Vehicle::ALL[which], [distance, 0.0, heading], 400);
        // Love that looks away turns from the lamp, which makes more of every rounding: of 1500 distances the worst ended
        // 3 mm and 7 mrad beside the line. All others kept to it but for 1e-5 rad.
        let unstable = away && Vehicle::ALL[which] == Vehicle::Love;
        let (aside, turn) = if unstable { (1e-2, 0.03) } else { (1e-5, 1e-4) };
        for [x, y, turned] in way {
            prop_assert!(y.abs() < aside, "{x} {y}");
            prop_assert!((turned.abs() - heading).abs() < turn, "{turned}");
        }
        let [start, end] = episode.distances();
        prop_assert!(if away { end >= start } else { end <= start }, "{start} {end}");
    }

    #[test]
    fn mirrored_starts_go_mirrored_ways(
        which in 0_usize..4, distance in 0.1_f32..0.5, direction in -3.0_f32..3.0, heading in -3.0_f32..3.0,
    ) {
        let (way, _) = drive(Vehicle::ALL[which], [distance, direction, heading], 100);
        let (mirrored, _) = drive(Vehicle::ALL[which], [distance, -direction, -heading], 100);
        for (a, b) in way.iter().zip(&mirrored) {
            prop_assert!((a[0] - b[0]).abs() < 1e-4 && (a[1] + b[1]).abs() < 1e-4, "{a:?} {b:?}");
            let turned = a[2] + b[2];
            prop_assert!(turned.abs() < 1e-3 || (turned.abs() - 2.0 * PI).abs() < 1e-3, "{a:?} {b:?}");
        }
    }
}

#[test]
fn nothing_evolves_and_bad_values_are_refused() {
    let mut settings = Settings::new(Braitenberg.settings("2a")).unwrap();
    let error = settings.set("", "evolution.generations", Value::Whole(5)).unwrap_err().to_string();
    assert_eq!(error, "`evolution.generations`: 5 is outside 1 to 1");
    settings.set("", "lamp.radius", Value::Number(0.02)).unwrap();
    for list in [vec![0.3, 0.2], vec![0.05, 0.2], vec![0.5, 5.0]] {
        settings.set("", "start.distance", Value::Numbers(list.clone())).unwrap();
        let error = Braitenberg.prepare("2a", &settings).err().unwrap().to_string();
        assert!(error.starts_with("`start.distance`: from "), "{list:?}: {error}");
    }
}
