//! Motors of robots on wheels, by the speeds of the wheels and by a camera.

use crate::wheels::{SPEED, TIME_STEP};
use crate::{Trial, all_close, close, refused};

/// Kinds with a value in this file, in `senses.rs` or in `teams.rs`.
pub(crate) const MOTORS: &[&str] = &["wheels", "speed-and-turn", "leds", "signal", "attachment"];

fn file(motors: &str, bias: &[f64], rest: &str) -> String {
    format!(
        "world = {{ size = [3.1, 2.3], time_step = {TIME_STEP} }}\nmotors = [{motors}]\n\
         network = {{ kind = \"wired\", bias = {bias:?}, wires = [] }}\nepisode = {{ steps = 3, trials = 1 }}\n\
         reward = [{{ kind = \"steps\" }}]\n{rest}"
    )
}

const ALONE: &str = "robot = { kind = \"e-puck\" }\nsensors = [{ kind = \"wheel-speed\", signed = true }]\n\
    start = [{ place = \"robot\", at = \"fixed\", point = [0.8, 0.7], heading = 37 }]\n";

#[test]
fn wheels_turn_as_commanded() {
    for (motor, bias, wanted) in [
        // 2 y - 1.
        ("kind = \"wheels\"", [0.85, 0.3], [0.7, -0.4]),
        // s = 2 * 0.8 - 1, t = 2 * 0.6 - 1: s - t and s + t.
        ("kind = \"speed-and-turn\"", [0.8, 0.6], [0.4, 0.8]),
        // 0.4 and 1.6 are slowed down by the same factor.
        ("kind = \"speed-and-turn\"", [1.0, 0.8], [0.25, 1.0]),
        ("kind = \"speed-and-turn\"", [0.2, 0.45], [-0.5, -0.7]),
        // s = 0.8, t = -0.1.
        ("kind = \"speed-and-turn\", forwards = true", [0.8, 0.45], [0.9, 0.7]),
        // Wrappers of motors: the last is applied first. 0.5 * 0.4 + 0.3 is clamped to 0.45 afterwards, or before.
        (
            "kind = \"wheels\", wrappers = [{ kind = \"saturate\", low = 0.1, high = 0.45 }, { kind = \"scale\", gain = 0.5, offset = 0.3 }]",
            [0.4, 0.1],
            [-0.1, -0.3],
        ),
        (
            "kind = \"wheels\", wrappers = [{ kind = \"scale\", gain = 0.5, offset = 0.3 }, { kind = \"saturate\", low = 0.3, high = 0.45 }]",
            [0.6, 0.1],
            [0.05, -0.1],
        ),
        ("kind = \"wheels\", wrappers = [{ kind = \"threshold\", above = 0.45 }]", [0.46, 0.44], [1.0, -1.0]),
        ("kind = \"wheels\", wrappers = [{ kind = \"lesion\", channels = [1, 1] }]", [0.8, 0.7], [0.6, -1.0]),
        (
            "kind = \"wheels\", wrappers = [{ kind = \"stuck\", value = 0.65, channels = [0, 0] }]",
            [0.9, 0.7],
            [0.3, 0.4],
        ),
    ] {
        let trial = Trial::new(&file(&format!("{{ {motor} }}"), &bias, ALONE));
        all_close(&trial.sensor("wheel-speed", 2), &wanted, 1e-6, &format!("{motor} at {bias:?}"));
    }
    // Nothing is driven before the delay of two steps is over.
    let delayed = "{ kind = \"wheels\", wrappers = [{ kind = \"delay\", steps = 2 }] }";
    let trial = Trial::new(&file(delayed, &[0.85, 0.3], ALONE).replace("steps = 3", "steps = 5"));
    let speeds: Vec<f64> = (1..=5).map(|step| trial.sensor("wheel-speed", step)[0]).collect();
    all_close(&speeds, &[0.0, 0.0, 0.0, 0.7, 0.7], 1e-6, "delayed");
}

/// A greatest speed of 0.2 m/s: 0.7 and -0.4 of it move the robot at 0.03 m/s.
#[test]
fn speeds_are_shares_of_the_robots_own() {
    let rest = ALONE
        .replace("kind = \"e-puck\"", "kind = \"e-puck\", speed = 0.2")
        .replace("sensors = [", "sensors = [{ kind = \"body-velocity\" }, ");
    let trial = Trial::new(&file("{ kind = \"wheels\" }", &[0.85, 0.3], &rest));
    close(trial.sensor("body-velocity", 2)[0], 0.5 * (0.7 - 0.4) * 0.2, 1e-6, "speed");
    assert!((0.5 * (0.7 - 0.4) * SPEED - 0.03).abs() > 1e-3, "unlike that of an e-puck");
}

/// A robot in front shows 0.7 red and 0.4 blue, whatever the order of its motor's channels. It is seen by its hull.
#[test]
fn leds_are_seen_in_their_colors() {
    let (sine, cosine) = 37_f64.to_radians().sin_cos();
    let at = [0.8 + 0.2 * cosine, 0.7 + 0.2 * sine];
    let rest = format!(
        "robot = {{ kind = \"e-puck\", count = 2 }}\n\
         sensors = [{{ kind = \"camera\", field_of_view = 10, sectors = 1, rays = 1, range = 1.0, colors = [\
         {{ name = \"lit\", low = [0.65, 0.0, 0.35], high = [0.75, 0.01, 0.45] }}, \
         {{ name = \"other\", low = [0.35, 0.0, 0.65], high = [0.45, 0.01, 0.75] }}, \
         {{ name = \"hull\", low = [0.05, 0.35, 0.05], high = [0.15, 0.45, 0.15] }}] }}]\n\
         start = [{{ place = \"robot-1\", at = \"fixed\", point = [0.8, 0.7], heading = 37 }}, \
         {{ place = \"robot-2\", at = \"fixed\", point = {at:?}, heading = -60 }}]\n"
    );
    for (colors, bias, wanted) in [
        ("\"blue\", \"red\"", &[0.5, 0.5, 0.4, 0.7][..], [1.0, 0.0, 0.0]),
        ("\"red\", \"blue\"", &[0.5, 0.5, 0.4, 0.7], [0.0, 1.0, 0.0]),
        ("\"red\", \"green\", \"blue\"", &[0.5, 0.5, 0.7, 0.0, 0.4], [1.0, 0.0, 0.0]),
        ("\"green\"", &[0.5, 0.5, 0.0], [0.0, 0.0, 1.0]),
    ] {
        let motors = format!("{{ kind = \"wheels\" }}, {{ kind = \"leds\", colors = [{colors}] }}");
        let trial = Trial::new(&file(&motors, bias, &rest));
        assert_eq!(trial.sensor("camera", 1), [0.0, 0.0, 1.0], "the hull before the first step");
        assert_eq!(trial.sensor("camera", 3), wanted, "{colors}");
    }
    let khepera = rest.replace("e-puck", "khepera");
    let motors = "{ kind = \"wheels\" }, { kind = \"leds\", colors = [\"red\"] }";
    assert!(refused(&file(motors, &[0.5, 0.5, 0.4], &khepera)).contains("needs LEDs; the Khepera has none"));
    // Outputs without LEDs are ignored on request.
    let optional = motors.replace("[\"red\"]", "[\"red\"], optional = true");
    let trial = Trial::new(&file(&optional, &[0.5, 0.5, 0.4], &khepera));
    close(trial.column("output.leds")[0], 0.4, 1e-6, "the output");
}

/// A robot that drives at 45 degrees against the wall y = 0 slides along it, or stays where it is. It moves 0.8 of 0.144
/// m/s, of which the part along the wall is cos 45 degrees.
#[test]
fn robots_slide_along_walls_or_stay() {
    for (rule, slides) in [("collisions = \"circles\", ", true), ("collisions = \"undone\", ", false), ("", false)] {
        let rest = "robot = { kind = \"e-puck\" }\nsensors = [{ kind = \"body-pose\" }]\n\
            start = [{ place = \"robot\", at = \"fixed\", point = [1.0, 0.039], heading = -45 }]\n";
        let text =
            file("{ kind = \"wheels\" }", &[0.9, 0.9], rest).replace("world = { ", &format!("world = {{ {rule}"));
        let trial = Trial::new(&text);
        for step in 1..=3 {
            let way = if slides { 0.8 * SPEED * TIME_STEP * f64::sqrt(0.5) * f64::from(step) } else { 0.0 };
            let tick = step as usize - 1;
            close(trial.column("x [m]")[tick], 1.0 + way, 1e-4, &format!("x after step {step}: {rule}"));
            let y = if slides { 0.035 } else { 0.039 };
            close(trial.column("y [m]")[tick], y, 1e-4, &format!("y after step {step}: {rule}"));
        }
    }
}
