//! Terms of one robot on wheels.

use std::fmt::Write as _;

use crate::{Trial, close, distance, yes};

/// Start of the robot [m], its heading [deg], and the control step [s].
pub(crate) const START: [f64; 2] = [0.83, 0.61];
pub(crate) const HEADING: f64 = 37.0;
pub(crate) const TIME_STEP: f64 = 0.16;
/// Values of left wheel, right wheel and signal.
pub(crate) const OUTPUTS: [f64; 3] = [0.9, 0.7, 0.35];
/// Center of the lamp and its radius [m].
pub(crate) const LAMP: [f64; 2] = [1.05, 0.52];
pub(crate) const LAMP_RADIUS: f64 = 0.03;
/// Greatest speed, track, and radii of wheels and hull of an e-puck [m/s, m].
pub(crate) const SPEED: f64 = 0.144;
pub(crate) const TRACK: f64 = 0.053;
pub(crate) const WHEEL: f64 = 0.0205;
pub(crate) const HULL: f64 = 0.035;

/// A robot after a number of steps.
pub(crate) struct Step {
    pub(crate) number: usize,
    pub(crate) at: [f64; 2],
    pub(crate) before: [f64; 2],
    /// Heading [rad].
    pub(crate) heading: f64,
}

/// Drives along a circle: with the speeds `v_l` and `v_r` of the wheels and the track b the robot turns by
/// `w = (v_r - v_l) / b`, and the radius is `(v_l + v_r) / (2 w)`. The center of rotation stays where it is.
pub(crate) fn driven(start: [f64; 2], heading: f64, [left, right]: [f64; 2], number: usize) -> Step {
    let [left, right] = [left, right].map(|y| SPEED * (2.0 * y - 1.0));
    let turn = (right - left) / TRACK;
    let radius = 0.5 * (left + right) / turn;
    let center = [start[0] - radius * heading.sin(), start[1] + radius * heading.cos()];
    let angle = |steps: usize| heading + turn * TIME_STEP * steps as f64;
    let place = |steps| [center[0] + radius * f64::sin(angle(steps)), center[1] - radius * f64::cos(angle(steps))];
    Step { number, at: place(number), before: place(number.saturating_sub(1)), heading: angle(number) }
}

pub(crate) fn step(number: usize) -> Step {
    driven(START, HEADING.to_radians(), [OUTPUTS[0], OUTPUTS[1]], number)
}

/// The file of the robot with these outputs, sensors and terms.
pub(crate) fn file([left, right, signal]: [f64; 3], sensors: &str, terms: &str) -> String {
    format!(
        "world = {{ size = [3.1, 2.3], time_step = {TIME_STEP}, ground = [0.9, 0.7, 0.2] }}\n\
         robot = {{ kind = \"e-puck\" }}\nmotors = [{{ kind = \"wheels\" }}, {{ kind = \"signal\" }}]\n\
         network = {{ kind = \"wired\", bias = [{left}, {right}, {signal}], wires = [] }}\n\
         episode = {{ steps = 20, trials = 1 }}\n\
         start = [{{ place = \"robot\", at = \"fixed\", point = {START:?}, heading = {HEADING} }}]\n\
         [[objects]]\nname = \"lamp\"\nkind = \"cylinder\"\nradius = {LAMP_RADIUS}\nlamp = 0.7\ncolor = [0.8, 0.2, 0.1]\nat = {LAMP:?}\n\
         [[objects]]\nname = \"yard\"\nkind = \"rectangle\"\nsize = [0.22, 0.06]\nheading = 25\nat = [0.9, 0.58]\n\
         color = [0.1, 0.3, 0.8]\n\
         [[objects]]\nname = \"pond\"\nkind = \"disc\"\nradius = 0.05\nat = [0.95, 0.5]\ncolor = [0.4, 0.6, 0.3]\n\
         {sensors}{terms}"
    )
}

/// A sensor that no term reads.
pub(crate) const NOTHING: &str = "[[sensors]]\nkind = \"constant\"\nvalue = 0.3\n";

/// Returns a point in the axes of the yard, which is turned by 25 degrees about its center.
fn in_yard([x, y]: [f64; 2]) -> bool {
    let (sine, cosine) = 25_f64.to_radians().sin_cos();
    let [u, v] = [x - 0.9, y - 0.58];
    (u * cosine + v * sine).abs() <= 0.11 && (v * cosine - u * sine).abs() <= 0.03
}

fn in_pond(at: [f64; 2]) -> bool {
    distance(at, [0.95, 0.5]) <= 0.05
}

/// Components along the direction (0.3, -0.9) of the plane. The height of the direction does not matter.
fn along([x, y]: [f64; 2]) -> f64 {
    (0.3 * x - 0.9 * y) / f64::sqrt(0.09 + 0.81)
}

fn gap(step: &Step) -> f64 {
    distance(step.at, LAMP) - HULL - LAMP_RADIUS
}

fn way(step: &Step) -> [f64; 2] {
    [step.at[0] - step.before[0], step.at[1] - step.before[1]]
}

/// Angle from the heading to the lamp [rad], 0 to pi.
fn angle(step: &Step) -> f64 {
    let bearing = f64::atan2(LAMP[1] - step.at[1], LAMP[0] - step.at[0]) - step.heading;
    f64::atan2(bearing.sin(), bearing.cos()).abs()
}

/// Kind, keys and value of a term, and true for a value that changes from step to step.
type Case = (&'static str, &'static str, fn(&Step) -> f64, bool);

pub(crate) const TERMS: &[Case] = &[
    ("near", "object = \"lamp\"\nwithin = 0.09", |step| yes(gap(step) < 0.09), true),
    ("near", "object = \"lamp\"\nwithin = 0.14", |step| yes(gap(step) < 0.14), true),
    ("distance", "object = \"lamp\"", |step| distance(step.at, LAMP), true),
    ("approach", "object = \"lamp\"", |step| distance(START, LAMP) - distance(step.at, LAMP), true),
    ("angle", "object = \"lamp\"", angle, true),
    ("touch", "", |_| 0.0, false),
    ("displacement", "", |step| distance(step.at, START), true),
    ("moved", "object = \"lamp\"", |_| 0.0, false),
    ("speed", "", |step| distance(step.at, step.before) / TIME_STEP, false),
    (
        "forward",
        "",
        |step| {
            let [x, y] = way(step);
            x * step.heading.cos() + y * step.heading.sin()
        },
        false,
    ),
    ("progress", "along = [0.3, -0.9, 0.5]", |step| along(way(step)), true),
    ("position", "along = [0.3, -0.9, 0.5]", |step| along(step.at), true),
    // Shares 2 y - 1 of the greatest speed: 0.8 and 0.4.
    ("wheel-speed", "", |_| 0.5 * (0.8 + 0.4), false),
    ("wheel-difference", "", |_| (0.8 - 0.4) * SPEED / WHEEL, false),
    ("straight-on", "", |_| 1.0 - (0.8 - 0.4) / 2.0, false),
    ("sensor", "sensor = \"constant\"", |_| 0.3, false),
    ("in-area", "area = \"yard\"", |step| yes(in_yard(step.at)), true),
    ("in-area", "area = \"pond\"", |step| yes(in_pond(step.at)), true),
    ("in-area", "area = \"yard\"\nor = [\"pond\"]", |step| yes(in_yard(step.at) || in_pond(step.at)), true),
    ("fullest-area", "area = \"yard\"", |step| yes(in_yard(step.at)), true),
    ("effort", "", |_| (0.81 + 0.49 + 0.35 * 0.35) / 3.0, false),
    ("control", "", |_| (0.64 + 0.16 + 0.09) / 3.0, false),
    ("steps", "", |_| 1.0, false),
    ("step", "", |step| step.number as f64, true),
    ("robots-in-area", "area = \"yard\"", |step| yes(in_yard(step.at)), true),
    ("formula", "formula = \"max(0, 1 - distance(lamp) / 0.3 m)\"", |step| 1.0 - distance(step.at, LAMP) / 0.3, true),
    ("time", "", |step| TIME_STEP * step.number as f64, true),
    ("gap", "object = \"lamp\"", gap, true),
    ("contact", "object = \"lamp\"\nwithin = 0.09", |step| yes(gap(step) <= 0.09), true),
    // A robot without others: no way to them, and one group.
    ("near-others", "", |_| 1.0, false),
    ("dispersion", "", |_| 0.0, false),
    ("clusters", "", |_| 1.0, false),
    ("largest-cluster", "", |_| 1.0, false),
    ("held", "", |_| 0.0, false),
];

fn rewards(cases: &[Case]) -> String {
    let mut terms = String::new();
    for (number, (kind, keys, ..)) in cases.iter().enumerate() {
        let _ = writeln!(terms, "[[reward]]\nname = \"v{number}\"\nkind = \"{kind}\"\n{keys}\nover = \"sum\"");
    }
    terms
}

#[test]
fn each_term_of_a_turning_robot_has_its_value() {
    let trial = Trial::new(&file(OUTPUTS, NOTHING, &rewards(TERMS)));
    for (number, (kind, keys, value, changes)) in TERMS.iter().enumerate() {
        let wanted: Vec<f64> = (1..=20).map(|number| value(&step(number))).collect();
        assert_eq!(wanted.iter().any(|value| (value - wanted[0]).abs() > 1e-3), *changes, "{kind} {keys}: {wanted:?}");
        let found = trial.column(&format!("v{number}"));
        for (step, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
            close(*found, *wanted, 3e-6, &format!("{kind} {keys} after step {}", step + 1));
        }
        assert_eq!(found.len(), 20);
        close(trial.outcome.terms[number], wanted.iter().sum(), 3e-5, &format!("sum of {kind} {keys}"));
    }
}

/// Wheels in opposite directions: shares 0.8 and -0.3 of the greatest speed.
#[test]
fn terms_of_wheels_have_no_sign() {
    let cases: &[Case] = &[
        ("wheel-speed", "", |_| 0.5 * (0.8 + 0.3), false),
        ("wheel-difference", "", |_| (0.8 + 0.3) * SPEED / WHEEL, false),
        ("straight-on", "", |_| 1.0 - 0.5 * (0.8 + 0.3), false),
        ("effort", "", |_| (0.81 + 0.35 * 0.35 + 0.04) / 3.0, false),
        ("control", "", |_| (0.64 + 0.09 + 0.36) / 3.0, false),
    ];
    for outputs in [[0.9, 0.35, 0.2], [0.35, 0.9, 0.2]] {
        let trial = Trial::new(&file(outputs, NOTHING, &rewards(cases)));
        for (number, (kind, _, value, _)) in cases.iter().enumerate() {
            for found in trial.column(&format!("v{number}")) {
                close(found, value(&step(0)), 1e-6, kind);
            }
        }
    }
}

/// The largest channel, not the first, the sum or the absolute one. In the first step the wheels still rest.
#[test]
fn a_term_of_a_sensor_is_its_largest_channel() {
    let sensors = format!("{NOTHING}[[sensors]]\nkind = \"wheel-speed\"\nsigned = true\n");
    let term = "[[reward]]\nname = \"v\"\nkind = \"sensor\"\nsensor = \"wheel-speed\"\n";
    for (outputs, largest) in [([0.9, 0.7, 0.2], 0.8), ([0.6, 0.9, 0.2], 0.8), ([0.1, 0.3, 0.2], -0.4)] {
        let found = Trial::new(&file(outputs, &sensors, term)).column("v");
        close(found[0], 0.0, 0.0, "at rest");
        for found in &found[1..] {
            close(*found, largest, 1e-6, "the largest channel");
        }
    }
}

/// Straight on by 0.8 * 0.144 * 0.16 m = 0.018432 m in each step, until a cylinder is in the way. The sixth step would
/// cross the gap of 0.1 m and is undone.
#[test]
fn terms_of_a_collision_have_their_values() {
    let (sine, cosine) = 58_f64.to_radians().sin_cos();
    let far = 0.1 + HULL + 0.045;
    let at = [0.71 + far * cosine, 0.43 + far * sine];
    let terms = [
        ("touch", ""),
        ("gap", "object = \"post\""),
        ("contact", "object = \"post\""),
        ("contact", "object = \"post\"\nwithin = 0.03"),
        ("speed", ""),
        ("forward", ""),
        ("displacement", ""),
    ];
    let mut rewards = String::new();
    for (number, (kind, keys)) in terms.iter().enumerate() {
        let _ = writeln!(rewards, "[[reward]]\nname = \"v{number}\"\nkind = \"{kind}\"\n{keys}");
    }
    let text = format!(
        "world = {{ size = [3.1, 2.3], time_step = {TIME_STEP} }}\nrobot = {{ kind = \"e-puck\" }}\n\
         sensors = [{{ kind = \"touch\" }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
         network = {{ kind = \"wired\", bias = [0.9, 0.9], wires = [] }}\nepisode = {{ steps = 9, trials = 1 }}\n\
         start = [{{ place = \"robot\", at = \"fixed\", point = [0.71, 0.43], heading = 58 }}]\n\
         [[objects]]\nname = \"post\"\nkind = \"cylinder\"\nradius = 0.045\nat = {at:?}\n{rewards}"
    );
    let trial = Trial::new(&text);
    let stride = 0.8 * SPEED * TIME_STEP;
    for number in 1..=9_usize {
        let steps = number.min(5) as f64;
        let (met, moves) = (yes(number > 5), yes(number <= 5));
        let gap = 0.1 - stride * steps;
        let wanted = [met, gap, met, yes(number > 3), moves * stride / TIME_STEP, moves * stride, stride * steps];
        for (term, wanted) in wanted.into_iter().enumerate() {
            let (kind, found) = (terms[term].0, trial.column(&format!("v{term}"))[number - 1]);
            close(found, wanted, 3e-6, &format!("{kind} after step {number}"));
        }
        // The sensor is read before the step.
        assert_eq!(trial.sensor("touch", number), [yes(number > 6)], "touch in step {number}");
    }
    // A trial that ends by a collision has a sixth step.
    let ended = Trial::new(&text.replace("trials = 1", "trials = 1, ends = [\"collision\"]"));
    assert_eq!((ended.outcome.steps, ended.recording.times().len()), (6, 6));
}
