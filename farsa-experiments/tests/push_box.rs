//! `push-box`: starts, boxes that are pushed and not launched, and what a pusher by hand and chance are worth.
#![cfg(feature = "rapier")]
#![allow(missing_docs, clippy::unwrap_used)]

use farsa_body::ports::Kinematics as _;
use farsa_experiments::push_box::{HomingPusher, PushBox, PushConfig, PushEpisode, PushTrial};
use farsa_lab::advanced::{Value, run_episode};
use farsa_lab::{EpisodeId, Experiment as _, Settings};
use farsa_nn::{Controller, Perceptron};
use farsa_num::{Domain, Stream};

/// Runs trials of a test seed and returns their outcomes.
fn trials<C: Controller>(config: &PushConfig, count: u32, mut controller: impl FnMut(u32) -> C) -> Vec<PushTrial> {
    let mut world = config.world().unwrap();
    let mut episode = PushEpisode::new(config.clone(), controller(0)).unwrap();
    let one = |trial| {
        episode.set_controller(controller(trial));
        let id = EpisodeId { seed: 1 | 1 << 63, trial, ..EpisodeId::default() };
        run_episode(&mut episode, &mut world, id, None);
        for body in [episode.parts().body, episode.cube()] {
            let pose = world.pose(body);
            assert!(pose.position[2].abs() < 2e-3 && pose.rotate([0.0, 0.0, 1.0])[2] > 0.99, "trial {trial}: {pose:?}");
        }
        *episode.trial()
    };
    (0..count).map(one).collect()
}

/// A layer whose parameters are drawn uniformly from the range of genes.
fn random(config: &PushConfig, trial: u32) -> Perceptron<Vec<f32>> {
    let mut stream = Stream::new(7, Domain::InitialGenome, trial, 0, 0);
    let range = config.weight_range as f32;
    let count = Perceptron::parameter_count(config.inputs(), 2);
    Perceptron::new(config.inputs(), 2, 1.0, (0..count).map(|_| stream.range(-range, range)).collect()).unwrap()
}

/// Mean and half of the 95 % interval.
fn mean(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    [mean, 1.96 * farsa_num::Scalar::sqrt(square / (n - 1.0) / n)]
}

#[test]
fn trials_start_where_the_rules_allow() {
    let config = PushConfig::default();
    let mut world = config.world().unwrap();
    let mut episode = PushEpisode::new(config.clone(), HomingPusher::new(&config)).unwrap();
    let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
    for trial in 0..200 {
        episode.arrange(&mut world, EpisodeId { seed: 3, trial, ..EpisodeId::default() });
        let [robot, cube] = [episode.parts().body, episode.cube()].map(|body| world.pose(body).position.map(f64::from));
        assert_eq!(cube[..2], [0.0; 2]);
        let away = robot[0].hypot(robot[1]) - config.robot.radius - config.around();
        (nearest, farthest) = (nearest.min(away), farthest.max(away));
    }
    let [low, high] = config.apart;
    assert!(nearest > low - 1e-6 && farthest < high + 1e-6, "{nearest} {farthest}");
    assert!(nearest < low + 0.01 && farthest > high - 0.01, "{nearest} {farthest}");
    let id = EpisodeId { seed: 3, trial: 5, ..EpisodeId::default() };
    let mut at = |id| {
        episode.arrange(&mut world, id);
        world.pose(episode.parts().body).position
    };
    let here = at(id);
    assert_eq!(at(EpisodeId { individual: 4, ..id }), here);
    for other in [EpisodeId { seed: 4, ..id }, EpisodeId { trial: 6, ..id }, EpisodeId { generation: 1, ..id }] {
        assert_ne!(at(other), here);
    }
}

/// The table of docs/results/push-box.md for more trials: `FARSA_TRIALS=400`.
#[test]
fn a_pusher_by_hand_is_better_than_chance_and_no_box_is_launched() {
    let count = std::env::var("FARSA_TRIALS").ok().and_then(|count| count.parse().ok()).unwrap_or(24);
    let config = PushConfig::default();
    let by_hand = trials(&config, count, |_| HomingPusher::new(&config));
    let chance = trials(&config, count, |trial| random(&config, trial));
    let mut means = Vec::new();
    for (name, trials) in [("by hand", &by_hand), ("at random", &chance)] {
        let moved: Vec<f64> = trials.iter().map(|trial| trial.moved).collect();
        let far = trials.iter().filter(|trial| trial.moved >= config.far).count();
        let fastest = trials.iter().fold(0.0_f64, |most, trial| most.max(trial.fastest));
        let [middle, off] = mean(&moved);
        println!(
            "{name}: {middle:.3} +- {off:.3} m, {far} of {count} as far as {} m, box at most {fastest:.3} m/s",
            config.far
        );
        means.push(middle);
        for trial in trials {
            assert!(!trial.failed && trial.steps == config.steps);
            // The box's middle may be faster than where it is pushed, as it turns.
            assert!(trial.fastest < 1.25 * config.speed(), "{trial:?}");
            let time = f64::from(trial.steps) * config.time_step;
            assert!(trial.moved <= trial.way + 1e-6 && trial.way <= config.speed() * time, "{trial:?}");
            assert!(trial.moved < 1e-3 || trial.touched > 0, "moved by itself: {trial:?}");
        }
    }
    assert!(means[0] > 2.0 * means[1], "{means:?}");
}

#[test]
fn settings_that_do_not_go_together_are_refused() {
    let mut settings = Settings::new(PushBox.settings("")).unwrap();
    settings.set("", "start.farthest", Value::Number(0.001)).unwrap();
    let error = PushBox.prepare("", &settings).err().unwrap().to_string();
    assert_eq!(error, "`start.farthest`: is 0.001, below start.nearest, 0.01");
    let layer = Perceptron::new(7, 2, 1.0, vec![0.0; 16]).unwrap();
    let error = PushEpisode::new(PushConfig::default(), layer).err().unwrap().to_string();
    assert_eq!(error, "push-box: a controller of 7 inputs and 2 outputs where 8 and 2 are wanted");
}
