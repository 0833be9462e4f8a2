//! Limits of joints and actuators, read and written by the rules of MuJoCo 4.0.0.

use farsa_body::Pose;
use farsa_body::actuators::{Held, Law, Servo, Torque, Velocity};
use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
use farsa_models::ReadOptions;
use farsa_models::mjcf::{self, MjcfOptions};

use crate::{message, read};

const NONE: f64 = f64::INFINITY;

fn text(joint: &str, actuators: &str, automatic: bool) -> String {
    format!(
        "<mujoco><compiler angle='radian' autolimits='{automatic}'/><default><joint range='-2 2' limited='auto'/></default>\
         <worldbody><body>\n<joint name='j' {joint}/><geom size='0.1'/></body></worldbody>\
         <actuator>\n{actuators}</actuator></mujoco>"
    )
}

#[test]
fn equal_ends_are_no_limit() {
    for (joint, range) in [
        ("", [-2.0, 2.0]),
        ("range='0 0'", [-NONE, NONE]),
        ("range='0.5 0.5'", [-NONE, NONE]),
        ("range='1 -1'", [-NONE, NONE]),
        ("range='1 -1' limited='false'", [-NONE, NONE]),
        ("range='0.5 1' limited='true'", [0.5, 1.0]),
    ] {
        let read = read(&text(joint, "", true)).unwrap();
        assert_eq!(read.robot.segments[0].joint.range, range, "{joint}");
        let reversed = joint == "range='1 -1'";
        let note = "text line 2: joint `range`: ends before it begins, which is no limit";
        assert_eq!(read.warnings.iter().any(|warning| warning.to_string() == note), reversed, "{joint}");
    }
    for range in ["0 0", "1 1", "1 -1"] {
        let error = message(&text(&format!("range='{range}' limited='true'"), "", true));
        let expected = format!("text line 2: joint `j`: range is \"{range}\", but must end after it begins");
        assert_eq!(error, expected);
    }
}

#[test]
fn a_range_alone_is_a_limit_only_if_the_compiler_says_so() {
    let why = "but `limited` is not given, and the compiler's `autolimits` is false";
    let joint = |range: &str| text(&format!("range='{range}'"), "", false);
    for range in ["-1 1", "1 1", "1 -1"] {
        assert_eq!(message(&joint(range)), format!("text line 2: joint `j`: range is \"{range}\", {why}"));
    }
    assert_eq!(read(&joint("0 0")).unwrap().robot.segments[0].joint.range, [-NONE, NONE]);
    let force = text("range='0 0'", "<motor joint='j' forcerange='-1 1'/>", false);
    let why = why.replace("limited", "forcelimited");
    assert_eq!(message(&force), format!("text line 3: motor: forcerange is \"-1 1\", {why}"));
}

#[test]
fn ranges_of_actuators_follow_the_same_rules() {
    for (range, limit) in [("0 0", NONE), ("5 5", NONE), ("5 -5", NONE), ("-5 5", 5.0), ("-5 2", 5.0)] {
        for kind in ["ctrl", "force"] {
            let law = read(&text("", &format!("<motor joint='j' gear='2' {kind}range='{range}'/>"), true)).unwrap();
            assert_eq!(law.robot.actuators[0].law, Law::Torque(Torque { limit: 2.0 * limit }), "{kind} {range}");
            if range != "-5 5" && limit.is_infinite() {
                let limited = format!("<motor joint='j' {kind}range='{range}' {kind}limited='true'/>");
                let why = format!("text line 3: motor: {kind}range is \"{range}\", but must end after it begins");
                assert_eq!(message(&text("", &limited, true)), why);
            }
        }
    }
}

#[test]
fn ranges_of_control_are_ranges_of_commands() {
    for (actuator, range) in [
        ("<position joint='j' kp='8' ctrlrange='-1 0.5'/>", Some([-1.0, 0.5])),
        ("<position joint='j' kp='8' gear='2' ctrlrange='-1 0.5'/>", Some([-0.5, 0.25])),
        ("<position joint='j' kp='8' gear='-2' ctrlrange='-1 0.5'/>", Some([-0.25, 0.5])),
        ("<position joint='j' kp='8' ctrlrange='-1 0.5' ctrllimited='false'/>", None),
        ("<position joint='j' kp='8' inheritrange='1'/>", Some([-2.0, 2.0])),
        ("<position joint='j' kp='8' gear='4' inheritrange='0.5'/>", Some([-0.25, 0.25])),
        ("<position joint='j' kp='8' inheritrange='1' ctrllimited='false'/>", None),
        ("<position joint='j' kp='8' inheritrange='-1'/>", None),
        ("<velocity joint='j' kv='4' gear='2' ctrlrange='0 3'/>", Some([0.0, 1.5])),
        ("<general joint='j' gainprm='4' ctrlrange='0 3' biastype='affine' biasprm='0 0 -2'/>", Some([0.0, 12.0])),
        ("<motor joint='j' gear='-3' ctrlrange='-1 2'/>", Some([-6.0, 3.0])),
        ("<motor joint='j' gear='3' ctrlrange='-2 2'/>", None),
    ] {
        let robot = read(&text("", actuator, true)).unwrap().robot;
        assert_eq!(robot.actuators[0].command_range, range, "{actuator}");
        let back = read(&mjcf::write(&robot, &MjcfOptions::default()).unwrap()).unwrap().robot;
        assert_eq!(back.actuators, robot.actuators, "{actuator}");
        let unlimited = "<mujoco><option><flag clampctrl='disable'/></option>";
        let text = text("", actuator, true).replace("<mujoco>", unlimited);
        assert_eq!(read(&text).unwrap().robot.actuators[0].command_range, None, "{actuator}");
    }
    let twice = text("", "<position joint='j' inheritrange='1' ctrlrange='-1 1'/>", true);
    assert!(message(&twice).ends_with("ctrlrange is \"-1 1\", but there is `inheritrange` already"));
}

#[test]
fn the_effort_of_a_joint_limits_its_actuators() {
    let actuators = "<motor joint='j' gear='3' ctrlrange='-2 2'/><motor joint='j'/><position joint='j' kp='9'/>\
                     <velocity joint='j' forcerange='-1 1'/>";
    let read_with = |joint: &str| read(&text(joint, actuators, true)).unwrap();
    let limited = read_with("actuatorfrcrange='-4 4'");
    let laws: Vec<_> = limited.robot.actuators.iter().map(|actuator| actuator.law).collect();
    let expected = [
        Law::Torque(Torque { limit: 4.0 }),
        Law::Torque(Torque { limit: 4.0 }),
        Law::Servo(Servo { stiffness: 9.0, damping: 0.0, limit: 4.0 }),
        Law::Velocity(Velocity { gain: 1.0, limit: 1.0 }),
    ];
    assert_eq!(laws, expected);
    let note = "text line 2: joint `actuatorfrcrange`: limits each actuator of a joint, and not their sum";
    assert!(limited.warnings.iter().any(|warning| warning.to_string() == note), "{:?}", limited.warnings);
    // MuJoCo's jnt_actfrclimited is 0 for these.
    for joint in
        ["actuatorfrcrange='3 3'", "actuatorfrcrange='3 -3'", "actuatorfrcrange='-3 3' actuatorfrclimited='false'"]
    {
        assert_eq!(read_with(joint).robot.actuators[1].law, Law::Torque(Torque { limit: NONE }), "{joint}");
    }
    let damped = "<general joint='j' biastype='affine' biasprm='0 0 -5'/>";
    let read = read(&text("actuatorfrcrange='-4 4'", damped, true)).unwrap();
    let note = "text line 2: joint `actuatorfrcrange`: a damped motor has no largest effort";
    assert!(read.warnings.iter().any(|warning| warning.to_string() == note), "{:?}", read.warnings);
}

#[test]
fn largest_speeds_of_a_urdf_are_read_on_demand() {
    let with = |limit: &str, joint_speeds: bool| {
        let text = format!(
            "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' \
             ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j' type='continuous'><parent link='a'/><child link='b'/>\
             <limit effort='1' {limit}/></joint></robot>"
        );
        farsa_models::Imported::from_text(&text, &ReadOptions { joint_speeds, ..ReadOptions::default() })
    };
    for (limit, speed) in [
        ("velocity='2.5'", Some(2.5)),
        ("velocity='0'", None),
        ("", None),
        ("velocity='1000'", None),
        ("velocity='inf'", None),
    ] {
        let read = with(limit, true).unwrap();
        let joint = &read.robot.segments[1].joint;
        assert_eq!(joint.speed_limit, speed, "{limit}");
        assert!(read.warnings.is_empty(), "{limit}: {:?}", read.warnings);
        let written = farsa_models::urdf::write(&read.robot).unwrap();
        let options = ReadOptions { joint_speeds: true, ..ReadOptions::default() };
        let back = farsa_models::Imported::from_text(&written, &options).unwrap();
        assert_eq!(back.robot.segments[1].joint.speed_limit, speed, "{limit}");
        let ignored = with(limit, false).unwrap();
        assert_eq!(ignored.robot.segments[1].joint.speed_limit, None, "{limit}");
        assert_eq!(ignored.warnings.len(), usize::from(!limit.is_empty()), "{limit}: {:?}", ignored.warnings);
    }
    let error = with("velocity='-1'", true).unwrap_err().to_string();
    assert!(error.ends_with("velocity is \"-1\", but must not be negative"), "{error}");
}

/// A robot with limits that MuJoCo has no words for.
fn locked() -> Robot {
    let mut robot = Robot::new("locked");
    for (name, range) in [("a", [0.5, 0.5]), ("b", [0.0, 0.0]), ("c", [-1e12, -1e12]), ("d", [-NONE, 2.0])] {
        let joint = Joint::revolute(name, [0.0, 1.0, 0.0], Pose::identity(), range);
        robot.add_segment(Segment::new(name, None, joint, MassProperties::sphere(1.0, 0.1)));
        let joint = robot.joint(name).unwrap();
        for (law, number) in [
            (Law::Torque(Torque { limit: 0.0 }), 0),
            (Law::Servo(Servo { stiffness: 1.0, damping: 0.5, limit: 0.0 }), 1),
            (Law::Velocity(Velocity { gain: 2.0, limit: 0.0 }), 2),
            (Law::Velocity(Velocity { gain: 2.0, limit: NONE }), 3),
            (Law::Held(Held { stiffness: 0.0, damping: 0.25 }), 4),
        ] {
            let added = robot.add_actuator(&format!("{name}{number}"), joint, law);
            let ranges = [None, Some([0.25, 0.25]), Some([-NONE, 2.0]), Some([0.0, 0.0]), Some([-1e12, -1e12])];
            robot.actuators[added.index()].command_range = ranges[number];
        }
    }
    robot
}

#[test]
fn every_law_and_lock_is_read_back() {
    let robot = locked();
    let text = mjcf::write(&robot, &MjcfOptions::default()).unwrap();
    // MuJoCo refuses ends that are equal.
    for range in text.split("range=\"").skip(1) {
        let ends: Vec<f64> = range.split('"').next().unwrap().split(' ').map(|end| end.parse().unwrap()).collect();
        assert!(ends[0] < ends[1] && ends.iter().all(|end| *end == 0.0 || end.is_normal()), "{ends:?}");
    }
    assert!(text.contains("gainprm=\"1.0\" biastype=\"affine\" biasprm=\"0.0 0.0 -0.25\" ctrl"), "{text}");
    let back = read(&text).unwrap().robot;
    let mut actuators = robot.actuators.clone();
    // Numbers from 1e9 are endless in files.
    for actuator in actuators.iter_mut().filter(|actuator| actuator.name.ends_with('4')) {
        actuator.command_range = back.actuators[4].command_range;
    }
    assert_eq!(back.actuators, actuators);
    assert!(back.actuators[4].command_range.unwrap()[1] < -9e11);
    let ranges = |robot: &Robot| robot.segments.iter().map(|segment| segment.joint.range).collect::<Vec<_>>();
    let [.., high] = ranges(&back)[2];
    assert!(high < -9e11, "{high}");
    assert_eq!(ranges(&back)[..2], ranges(&robot)[..2]);
    assert_eq!(ranges(&back)[3], ranges(&robot)[3]);
}
