//! Test protocols of `icub-reach`, and the conditions of each of their cases.

use std::borrow::Cow;

use farsa_lab::Evaluation;
use farsa_lab::advanced::{CaseId, Intervention, Interventions, Protocol};
use farsa_num::Scalar;

use crate::icub_reach::config::{Config, Volume};
use crate::icub_reach::episode::Reaching;
use crate::icub_reach::network::{HIDDEN, HIDDEN_ONES, weights_on};
use crate::icub_reach::scene::CONTROLLED;

/// Number of grid points along each axis.
pub const GRID: usize = 5;
/// Distance of the targets of `outside`, in parts of the volume's surface.
const OUTSIDE: f64 = 1.1;
/// The weight on the hand in `load` \[kg\].
const LOAD: f64 = 0.5;
/// Trials of a case with separate targets.
const TRIALS: u32 = 50;

/// Maps a point of a half cube to the half ball, with x from 0 to 1, y and z from -1 to 1. The point keeps its ray and
/// its share of the radius.
fn on_ball(cube: [f64; 3]) -> [f64; 3] {
    let most = cube.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let length = Scalar::sqrt(cube.iter().fold(0.0, |sum, x| sum + x * x));
    if length > 0.0 { cube.map(|x| x * (most / length)) } else { cube }
}

/// Returns the 125 points of the grid in meters. The points form five layers from the center to the front, and each
/// layer has five by five points. The last axis varies fastest.
pub fn grid(volume: &Volume) -> Vec<[f64; 3]> {
    let part = |place: usize| place as f64 / (GRID - 1) as f64;
    let cube = |n: usize| [part(n / (GRID * GRID)), 2.0 * part(n / GRID % GRID) - 1.0, 2.0 * part(n % GRID) - 1.0];
    (0..GRID * GRID * GRID).map(|n| volume.at(on_ball(cube(n)))).collect()
}

/// Returns the points just outside the curved surface of the volume, together with their coordinates in units of the
/// semi-axes. They are a tenth farther from the center than the surface.
pub fn outside(volume: &Volume) -> Vec<([f64; 3], [f64; 3])> {
    let grid = (0..27).map(|n| [f64::from(n / 9) * 0.5, f64::from(n / 3 % 3) - 1.0, f64::from(n % 3) - 1.0]);
    let surface = grid.filter(|cube| cube.iter().any(|x| x.abs() >= 1.0));
    let farther = surface.map(|cube| on_ball(cube).map(|x| x * OUTSIDE));
    farther.map(|parts| (parts, volume.at(parts))).collect()
}

/// The protocols of a configuration, with what each case is.
#[derive(Clone, Debug)]
pub(crate) struct Protocols {
    interventions: Interventions,
    grid: Vec<[f64; 3]>,
    outside: Vec<[f64; 3]>,
    jump: u32,
}

impl Protocols {
    /// All protocols.
    pub(crate) fn new(config: &Config) -> Self {
        let rows = (0..GRID * GRID).map(|n| format!("x {} y {}", n / GRID + 1, n % GRID + 1));
        let columns = (1..=GRID).map(|z| format!("z {z}"));
        let on_grid = Protocol::from_table("grid", "5 by 5 by 5 places all over the volume", rows, columns)
            .with_axes("forwards and leftwards", "upwards")
            .with_trials(1);
        let places = outside(&config.volume);
        let names = places.iter().map(|([x, y, z], _)| format!("x {x:.2} y {y:.2} z {z:.2}"));
        let beyond = Protocol::from_list("outside", "places beyond the volume, in parts of its semi-axes", names)
            .with_held_out(|_, _| true)
            .with_trials(1);
        let of_own = |name: &str, summary: &str, cases: [&str; 2]| {
            let held_out = cases[1].to_owned();
            Protocol::from_list(name, summary, cases).with_held_out(move |row, _| row == held_out).with_trials(TRIALS)
        };
        let jump = "the target is another one from the middle of the trial on";
        let torso = "the commands of the trunk's joints stay as at the start";
        let load = "half a kilogram hangs on the hand";
        let inputs = ["x", "y", "z"]
            .into_iter()
            .enumerate()
            .map(|(i, name)| (format!("no links from {name}"), Intervention::cut(i..i + 1)));
        let hidden =
            (0..HIDDEN).map(|i| (format!("no hidden neuron {}", i + 1), Intervention::lesion(HIDDEN_ONES.first + i)));
        let motors = CONTROLLED
            .into_iter()
            .enumerate()
            .map(|(motor, name)| (format!("no links to {name}"), Intervention::cut_links(weights_on(motor))));
        let interventions = Interventions::default()
            .with_protocol(on_grid, Vec::new())
            .with_protocol(beyond, Vec::new())
            .with_protocol(of_own("target-jump", jump, ["stays", "jumps"]), Vec::new())
            .with_protocol(of_own("locked-torso", torso, ["free", "locked"]), Vec::new())
            .with_protocol(of_own("load", load, ["free", "loaded"]), Vec::new())
            .with_cases(
                "lesions",
                "one group of links is cut, or one neuron is silent",
                inputs.chain(hidden).chain(motors),
            )
            .with_noise(&Interventions::NOISE);
        let outside = places.into_iter().map(|(_, place)| place).collect();
        Self { interventions, grid: grid(&config.volume), outside, jump: config.steps / 2 }
    }

    /// The protocols as the command shows them.
    pub(crate) fn list(&self) -> Vec<Protocol> {
        self.interventions.protocols()
    }

    /// The change of the network in an evaluation.
    pub(crate) fn applied(&self, evaluation: &Evaluation<'_>) -> Cow<'_, Intervention> {
        self.interventions.applied(evaluation)
    }

    /// The demands of a trial in a case.
    pub(crate) fn asked(&self, case: Option<CaseId>) -> Reaching {
        let plain = Reaching::default();
        match self.interventions.named(case) {
            Some(("grid", case)) => Reaching { target: self.grid.get(case).copied(), ..plain },
            Some(("outside", case)) => Reaching { target: self.outside.get(case).copied(), ..plain },
            Some(("target-jump", 1)) => Reaching { jump: Some(self.jump), ..plain },
            Some(("locked-torso", 1)) => Reaching { locked_torso: true, ..plain },
            Some(("load", 1)) => Reaching { load: LOAD, ..plain },
            _ => plain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::icub_reach::config::Condition;
    use farsa_lab::EpisodeId;

    #[test]
    fn places_are_within_the_volume_or_beyond_it() {
        let volume = Config::for_condition(Condition::Steady).volume;
        let far = |place: [f64; 3]| {
            let parts = [0, 1, 2].map(|k| (place[k] - volume.centre[k]) / volume.semi_axes[k]);
            assert!(parts[0] > -1e-12);
            Scalar::sqrt(parts.iter().fold(0.0, |sum, x| sum + x * x))
        };
        let places = grid(&volume);
        assert_eq!(places.len(), 125);
        assert!(places.iter().all(|place| far(*place) < 1.0 + 1e-12));
        // No two are the same.
        for (n, one) in places.iter().enumerate() {
            assert!(places[..n].iter().all(|other| other != one));
        }
        let beyond = outside(&volume);
        assert_eq!(beyond.len(), 25);
        assert!(beyond.iter().all(|(_, place)| (far(*place) - OUTSIDE).abs() < 1e-9));
    }

    #[test]
    fn each_case_asks_what_its_name_says() {
        let config = Config::for_condition(Condition::Velocity);
        let all = Protocols::new(&config);
        let list = all.list();
        Protocol::check(&list).unwrap();
        let names: Vec<(&str, usize)> = list.iter().map(|one| (one.name.as_str(), one.cases.len())).collect();
        let expected = [
            ("grid", 125),
            ("outside", 25),
            ("target-jump", 2),
            ("locked-torso", 2),
            ("load", 2),
            ("lesions", 14),
            ("noise", 5),
        ];
        assert_eq!(names, expected);
        let at = |protocol, case| Some(CaseId { protocol, case });
        assert_eq!(all.asked(at(0, 7)).target, Some(all.grid[7]));
        assert_eq!(list[0].cases[7].name(), "x 1 y 2 z 3");
        assert_eq!(all.asked(at(2, 0)), Reaching::default());
        assert_eq!(all.asked(at(2, 1)).jump, Some(100));
        assert!(all.asked(at(3, 1)).locked_torso);
        assert_eq!((all.asked(at(4, 0)), all.asked(at(4, 1)).load), (Reaching::default(), 0.5));
        let plain = Evaluation::new(&[], EpisodeId::default());
        let done = |case| all.applied(&Evaluation { case, ..plain }).into_owned();
        assert_eq!(list[5].cases[9].row, "no links to torso_yaw");
        // From each of four hidden neurons, after twelve weights of inputs, to the second of six motors.
        assert_eq!(done(at(5, 9)).parameters, [13, 19, 25, 31].map(|weight| (weight, 0.0)));
        assert_eq!(done(at(5, 4)), Intervention::lesion(3));
        assert_eq!(done(None), Intervention::default());
    }
}
