//! Postures of models, and what depends on them, in closed form.

use farsa_num::{Domain, Stream};

use crate::{Trial, all_close, close, made, refused};

/// A free trunk that is turned about y by 60 degrees in its keyframe, with an arm whose hinge has a `ref`.
const MODEL: &str = "<mujoco><compiler angle='radian'/><worldbody>\
    <body name='trunk' pos='0 0 1'><freejoint/><geom type='sphere' size='0.1'/>\
    <body name='arm' pos='0.2 0 0'><joint name='hinge' axis='0 1 0' ref='0.3'/><geom type='sphere' size='0.05'/></body></body>\
    </worldbody><actuator><position joint='hinge' kp='9'/></actuator>\
    <keyframe><key name='bent' qpos='0.1 0.2 1.5 0.8660254037844387 0 0.5 0 -0.4'/><key/></keyframe></mujoco>";

fn file(start: &str, rest: &str) -> String {
    format!(
        "world = {{ engine = \"articulated\", floor = false, gravity = [0, 0, 0], time_step = 0.1, substeps = 1 }}\n\
         robot = {{ kind = \"model\", file = \"s.xml\", base = [0.0, 0.0, 0.5] }}\n\
         sensors = [{{ kind = \"body-pose\" }}, {{ kind = \"orientation\" }}, {{ kind = \"up\" }}, \
         {{ kind = \"joint-position\", from = 0.0, to = 1.0 }}, {{ kind = \"body-velocity\", axes = \"world\" }}, \
         {{ kind = \"joint-speed\" }}]\n\
         motors = [{{ kind = \"joint-torque\", largest = 1.0{rest} }}]\n\
         network = {{ kind = \"wired\", bias = [0.5], wires = [] }}\nepisode = {{ steps = 2, trials = 1 }}\n\
         reward = [{{ kind = \"steps\" }}]\nstart = [{start}]\n[files]\n\"s.xml\" = \"\"\"{MODEL}\"\"\"\n"
    )
}

/// Without a rule the joints are at their `ref`, which MuJoCo calls `qpos0`.
#[test]
fn a_model_starts_in_the_configuration_of_its_file() {
    for start in
        ["", "{ place = \"robot\", at = \"posture\" }", "{ place = \"robot\", at = \"posture\", keyframe = \"key1\" }"]
    {
        let trial = Trial::new(&file(start, ""));
        all_close(&trial.sensor("body-pose", 1), &[0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 1.0], 1e-6, start);
        close(trial.sensor("joint-position", 1)[0], 0.3, 1e-6, start);
    }
}

#[test]
fn a_keyframe_places_the_joints_and_the_free_body() {
    let trial = Trial::new(&file("{ place = \"robot\", at = \"posture\", keyframe = \"bent\", raised = 0.25 }", ""));
    let [x, w] = [0.5, 0.75_f64.sqrt()];
    all_close(&trial.sensor("body-pose", 1), &[0.1, 0.2, 2.25, 0.0, x, 0.0, w], 1e-6, "pose");
    all_close(&trial.sensor("orientation", 1), &[0.0, x, 0.0, w], 1e-6, "orientation");
    // R^T z for a turn about y by the angle a is (-sin a, 0, cos a).
    all_close(&trial.sensor("up", 1), &[-w, 0.0, 0.5], 1e-6, "up");
    close(trial.sensor("joint-position", 1)[0], -0.4, 1e-6, "hinge");
    all_close(&trial.sensor("body-velocity", 1), &[0.0; 6], 1e-6, "velocity");
}

/// Noise is drawn joint by joint, a position and a speed each, and then for the free body.
#[test]
fn noise_moves_positions_and_speeds() {
    for (normal, noise, speeds) in [(false, 0.02, 0.3), (true, 0.0, 0.1)] {
        let start =
            format!("{{ place = \"robot\", at = \"posture\", noise = {noise}, speeds = {speeds}, normal = {normal} }}");
        let trial = Trial::new(&file(&start, ""));
        let mut stream = Stream::new(0, Domain::Start, 0, 0, 0);
        let mut next = || {
            let moved = f64::from(stream.range(-noise, noise));
            let speed = if normal { speeds * stream.normal() } else { stream.range(-speeds, speeds) };
            [moved, f64::from(speed)]
        };
        let [hinge, speed] = next();
        close(trial.sensor("joint-position", 1)[0], 0.3 + hinge, 1e-6, "hinge");
        close(trial.sensor("joint-speed", 1)[0], speed, 1e-6, "speed of the hinge");
        let drawn: Vec<[f64; 2]> = (0..7).map(|_| next()).collect();
        let pose: Vec<f64> = drawn.iter().zip([0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 1.0]).map(|([q, _], x)| x + q).collect();
        let length = pose[3..].iter().map(|q| q * q).sum::<f64>().sqrt();
        let pose: Vec<f64> = pose.iter().enumerate().map(|(at, q)| if at < 3 { *q } else { q / length }).collect();
        all_close(&trial.sensor("body-pose", 1), &pose, 1e-6, "pose");
        let velocity: Vec<f64> = drawn[..6].iter().map(|[_, v]| *v).collect();
        all_close(&trial.sensor("body-velocity", 1), &velocity, 1e-6, "velocity");
    }
}

#[test]
fn postures_that_do_not_fit_are_refused() {
    for (start, why) in [
        (
            "{ place = \"robot\", at = \"posture\", keyframe = \"bend\" }",
            "unknown keyframe `bend`; the nearest is `bent`",
        ),
        ("{ place = \"hinge\", at = \"posture\" }", "is for the whole `robot`"),
        ("{ place = \"robot\", at = \"posture\" }, { place = \"robot\", at = \"posture\" }", "`robot` is placed twice"),
    ] {
        assert!(refused(&file(start, "")).contains(why), "{}", refused(&file(start, "")));
    }
    let wheels = "world = { size = [2.0, 2.0] }\nsensors = [{ kind = \"infrared\" }]\nnetwork = { kind = \"wired\", bias = [0.5, 0.5], wires = [] }\n\
                  episode = { steps = 2, trials = 1 }\nrobot = { kind = \"e-puck\" }\nmotors = [{ kind = \"wheels\" }]\nreward = [{ kind = \"steps\" }]\n\
                  start = [{ place = \"robot\", at = \"posture\" }]\n";
    assert!(refused(wheels).contains("is for robots with joints"), "{}", refused(wheels));
}

/// A servo between two positions around that of a posture: 1/2 is the posture.
#[test]
fn servos_move_around_a_posture() {
    let servo = |keys: &str| {
        let text = file("{ place = \"robot\", at = \"posture\", keyframe = \"bent\" }", "");
        text.replace("{ kind = \"joint-torque\", largest = 1.0 }", &format!("{{ kind = \"servo\"{keys} }}"))
    };
    let trial = Trial::new(&servo(", within = 0.2, around = \"bent\""));
    close(trial.sensor("joint-position", 2)[0], -0.4, 1e-6, "at rest in the posture");
    let moved = Trial::new(&servo(", within = 0.2"));
    // The target is the `ref` of 0.3, so that the hinge accelerates towards it.
    assert!(moved.sensor("joint-position", 2)[0] > -0.39);
    for (keys, why) in [
        (", within = 0.2, from = 0.1", "has `within`, and therefore neither `from` nor `to`"),
        (", around = \"bent\"", "lacks the key `within`"),
        (", within = 0.2, around = \"bend\"", "the nearest is `bent`"),
    ] {
        assert!(refused(&servo(keys)).contains(why), "{}", refused(&servo(keys)));
    }
    assert!(made(&servo(", from = -1.0, to = 1.0")).is_ok());
}

/// A constant with a number that each trial draws, and one that swings.
#[test]
fn numbers_are_drawn_and_swing() {
    let text = |wrapper: &str| {
        let text = file("", "").replace("steps = 2,", "steps = 9,");
        text.replace(
            "sensors = [",
            &format!("sensors = [{{ kind = \"constant\", value = 4.0, wrappers = [{wrapper}] }}, "),
        )
    };
    let read = |trial: &Trial, step: usize| trial.sensor("constant", step)[0];
    let trial = Trial::new(&text("{ kind = \"wave\", period = 8.0, phase = 45.0 }"));
    for step in 1..=9 {
        let turns = 0.125 * step as f64;
        close(read(&trial, step), (std::f64::consts::TAU * turns).sin(), 1e-6, "wave");
    }
    for every in [0, 4] {
        let trial = Trial::new(&text(&format!("{{ kind = \"drawn\", low = -1.0, high = 3.0, every = {every} }}")));
        let first = read(&trial, 1);
        assert!((-1.0..=3.0).contains(&first) && first != 4.0);
        for step in 2..=9 {
            let is_again = every > 0 && step > 4;
            assert_eq!(read(&trial, step) == first, !is_again, "step {step} of {every}");
        }
        assert!(every == 0 || read(&trial, 5) == read(&trial, 8) && read(&trial, 8) != read(&trial, 9));
    }
    let wrong = refused(&text("{ kind = \"drawn\", low = 1.0, high = 0.0 }"));
    assert!(wrong.contains("from 1 to 0 runs backwards"), "{wrong}");
}
