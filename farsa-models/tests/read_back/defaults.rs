//! Classes of defaults. The expected numbers are those of MuJoCo 4.0.0: `gainprm`, `biasprm`, `geom_friction`, ....

use farsa_body::actuators::{Held, Law, Servo, Torque, Velocity};
use farsa_body::robot::Shape;

use crate::{message, read};

/// Reads the law of an actuator of class B, which is within A.
fn law(outer: &str, inner: &str, actuator: &str) -> Option<Law<f64>> {
    let text = format!(
        "<mujoco><default><default class='A'>{outer}<default class='B'>{inner}</default></default></default>\
         <worldbody><body><joint name='j'/><geom size='0.1'/></body></worldbody>\
         <actuator><{actuator} class='B' joint='j'/></actuator></mujoco>"
    );
    let robot = read(&text).unwrap_or_else(|error| panic!("{error}: {text}")).robot;
    robot.actuators.first().map(|actuator| actuator.law)
}

#[expect(clippy::unnecessary_wraps, reason = "compared with what `law` returns")]
fn servo(stiffness: f64, damping: f64) -> Option<Law<f64>> {
    Some(Law::Servo(Servo { stiffness, damping, limit: f64::INFINITY }))
}

#[expect(clippy::unnecessary_wraps, reason = "compared with what `law` returns")]
fn velocity(gain: f64) -> Option<Law<f64>> {
    Some(Law::Velocity(Velocity { gain, limit: f64::INFINITY }))
}

const MOTOR: Option<Law<f64>> = Some(Law::Torque(Torque { limit: f64::INFINITY }));

#[test]
fn a_class_has_one_set_of_gains_for_all_kinds_of_actuators() {
    let general = "<general biastype='affine' gainprm='100' biasprm='0 -100 -10'/>";
    for (outer, inner, actuator, expected) in [
        (general, "", "position", servo(100.0, 10.0)),
        (general, "", "position kp='3'", servo(3.0, 10.0)),
        (general, "", "position kv='4'", servo(100.0, 4.0)),
        (general, "", "velocity", velocity(100.0)),
        (general, "", "velocity kv='3'", velocity(3.0)),
        (general, "", "motor", MOTOR),
        (general, "", "general", servo(100.0, 10.0)),
        ("<velocity kv='7'/>", "", "position", servo(1.0, 0.0)),
        ("<velocity kv='7'/>", "", "general", velocity(7.0)),
        ("<position kp='7' kv='2'/>", "", "velocity", velocity(1.0)),
        ("<position kp='7' kv='2'/>", "", "general", servo(7.0, 2.0)),
        ("<position kp='7' kv='2'/>", "<position kp='8'/>", "general", servo(8.0, 2.0)),
        ("<motor/>", "", "general", MOTOR),
        // A class that another kind has set is passed over.
        ("<velocity kv='7'/>", "<position kp='3'/>", "velocity", velocity(7.0)),
        ("<velocity kv='7'/>", "<position kp='3'/>", "position", servo(3.0, 0.0)),
        (general, "<motor/>", "position", servo(100.0, 10.0)),
        (general, "<motor/>", "general", MOTOR),
        ("<position kp='7' kv='1'/>", "<velocity/>", "position", servo(7.0, 1.0)),
        // A `general` is for all.
        ("<velocity kv='7'/>", "<general gainprm='5'/>", "position", servo(5.0, 7.0)),
        ("<velocity kv='7'/>", "<general gainprm='5'/>", "velocity", velocity(5.0)),
        ("<position kp='7'/>", "<general biasprm='0 -5 -2'/>", "position", servo(7.0, 2.0)),
        ("<position kp='7'/><velocity kv='3'/>", "", "position", servo(1.0, 0.0)),
        ("<velocity kv='3'/><position kp='7'/>", "", "velocity", velocity(1.0)),
        ("<general gainprm='2'/>", "", "position", servo(2.0, 0.0)),
        ("<general gainprm='9' gaintype='affine'/>", "", "position", servo(1.0, 0.0)),
        ("<adhesion ctrlrange='0 1' gain='4'/>", "", "velocity", velocity(1.0)),
        ("<intvelocity kp='5'/>", "", "position", servo(1.0, 0.0)),
        ("<muscle/>", "", "motor", MOTOR),
        // These have states, or gains that no law has.
        ("<general dyntype='integrator' gainprm='2'/>", "", "general", None),
        ("<muscle/>", "", "general", None),
        ("<pid kp='5'/>", "", "general", None),
    ] {
        assert_eq!(law(outer, inner, actuator), expected, "{outer} {inner} {actuator}");
    }
}

#[test]
fn gears_and_ranges_of_a_class_reach_all_kinds() {
    let law = law("<velocity kv='7' gear='2' forcerange='-1 1'/>", "", "position kp='3'");
    assert_eq!(law, Some(Law::Servo(Servo { stiffness: 12.0, damping: 0.0, limit: 2.0 })));
}

#[test]
fn a_damped_motor_has_the_effort_as_its_command() {
    let law = law("", "", "general biastype='affine' biasprm='0 0 -5'");
    assert_eq!(law, Some(Law::Held(Held { stiffness: 0.0, damping: 5.0 })));
}

#[test]
fn numbers_overwrite_the_first_of_their_class() {
    let text = "<mujoco><default><geom friction='1 0.5 0.2' condim='6' size='0.1 0.2 0.25'/>\
         <joint damping='2 0.5'/><general biastype='affine' gainprm='7' biasprm='0 -5 -2'/>\
         <default class='b'><geom friction='0.4 0.3' type='box'/></default></default><worldbody>\
         <geom name='floor' type='plane' size='1 1 1'/>\
         <body pos='0 0 1'><joint name='j' type='slide' axis='0 0 1' damping='4'/>\
         <geom name='ball' size='0.1' friction='2' priority='1'/></body>\
         <body pos='0 0 1'><joint name='k'/><geom name='box' class='b' size='0.4 0.5' friction='3' priority='2'/></body>\
         </worldbody><actuator><general joint='j' biasprm='0 -7'/></actuator></mujoco>";
    let read = read(text).unwrap();
    let robot = &read.robot;
    let surface = |name: &str| robot.pairs[robot.pair("floor", name).unwrap().index()].surface;
    // geom_friction: 2 0.5 0.2 and 3 0.3 0.2. geom_size: 0.4 0.5 0.25. biasprm: 0 -7 -2.
    assert_eq!((surface("ball").friction, surface("ball").rolling_friction), (2.0, 0.2));
    assert_eq!((surface("box").friction, surface("box").rolling_friction), (3.0, 0.2));
    assert_eq!(robot.colliders[robot.collider("box").unwrap()].shape, Shape::Box { half: [0.4, 0.5, 0.25] });
    assert_eq!(robot.actuators[0].law, Law::Servo(Servo { stiffness: 7.0, damping: 2.0, limit: f64::INFINITY }));
    assert_eq!(robot.segments[0].joint.damping, 4.0);
    // The second number of the damping is inherited, and noted.
    assert!(read.warnings.iter().any(|note| note.what == "joint `damping`" && note.count == 2), "{:?}", read.warnings);
}

#[test]
fn a_short_list_of_a_pair_continues_with_mujocos_defaults() {
    let text = "<mujoco><default><default class='p'><pair friction='2 2 0.5 0.3 0.2' condim='6'/></default></default>\
         <worldbody><geom name='a' type='plane' size='1 1 1' friction='1 0.4 0.3'/><body><joint/><geom name='b' size='1'/>\
         </body></worldbody><contact><pair geom1='a' geom2='b' condim='6' PAIR/></contact></mujoco>";
    for (pair, friction, rolling) in [
        // pair_friction: 0.5 1 0.005 0.0001 0.0001, and 1 2 0.5 0.3 0.2.
        ("friction='0.5'", 0.5, 0.0001),
        ("class='p' friction='1'", 1.0, 0.3),
        ("", 1.0, 0.3),
    ] {
        let robot = read(&text.replace("PAIR", pair)).unwrap().robot;
        let surface = robot.pairs[0].surface;
        assert_eq!((surface.friction, surface.rolling_friction), (friction, rolling), "{pair}");
    }
}

#[test]
fn a_class_copies_its_parent_at_its_place() {
    // MuJoCo 4.0: `geom_friction` is 1 0.005 0.0001 for the first and 4 0.5 0.0001 for the second.
    let text = "<mujoco><default><geom size='0.1'/><default class='x'><geom density='5'/></default></default>\
         <default><geom friction='4 0.5' priority='1'/></default><worldbody><geom name='p' type='plane' size='1 1 1'/>\
         <body><joint/><geom name='a' class='x' type='sphere' priority='2'/></body>\
         <body><joint/><geom name='b' priority='2'/></body></worldbody></mujoco>";
    let robot = read(text).unwrap().robot;
    let friction = |name: &str| robot.pairs[robot.pair("p", name).unwrap().index()].surface.friction;
    assert_eq!((friction("a"), friction("b")), (1.0, 4.0));
}

#[test]
fn impossible_gains_are_refused() {
    let text = |actuator: &str| {
        format!(
            "<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody><actuator>\n<{actuator} joint='j'/>\
             </actuator></mujoco>"
        )
    };
    let why = "text line 2: position: kv is \"-1\", but must not be negative";
    assert_eq!(message(&text("position kv='-1'")), why);
    let why = "text line 2: position: dampratio is \"1\", but there is `kv` already";
    assert_eq!(message(&text("position kv='1' dampratio='1'")), why);
}
