//! Keys of robots on wheels for robots with joints, and the reverse, are refused.

use crate::{file, made, refused};

const MOTOR: &str = "kind = \"joint-velocity\"\nlargest = 1.0\ngain = 50.0";
const STEPS: &str = "[[reward]]\nkind = \"steps\"";

#[track_caller]
fn check(text: &str, why: &str) {
    match why {
        "ok" => assert!(made(text).is_ok(), "{}\n{text}", refused(text)),
        why => assert!(refused(text).contains(why), "{}\nwhere\n{why}\nis wanted of\n{text}", refused(text)),
    }
}

#[test]
fn parts_of_wheeled_robots_are_refused() {
    let right = file("", MOTOR, STEPS);
    let robot = |keys: &str| right.replace("kind = \"model\"", &format!("kind = \"model\"\n{keys}"));
    let wheels = "is for robots on wheels; this one has joints";
    for (text, why) in [
        (robot("count = 1"), "ok".to_owned()),
        (robot("count = 2"), format!("`robot.count`: {wheels}")),
        (robot("radius = 0.1"), format!("`robot.radius`: {wheels}")),
        (robot("speed = 0.1"), format!("`robot.speed`: {wheels}")),
        (robot("infrared_range = 0.1"), format!("`robot.infrared_range`: {wheels}")),
        (right.replace("kind = \"model\"", "kind = \"arm-and-hand\""), "`robot.file`: is for the kind `model`".into()),
        (
            right.replace("kind = \"model\"\nfile = \"bar.urdf\"", "kind = \"arm-and-hand\"\nfloating = true"),
            "`robot.floating`: is for the kind `model`".into(),
        ),
        (file("", MOTOR, &format!("{STEPS}\nrobot = 1")), "ok".into()),
        (file("", MOTOR, &format!("{STEPS}\nrobot = 2")), "`reward.1.robot`: there is one robot with joints".into()),
        (
            right.replace("trials = 1", "trials = 1\nends = [\"success\", \"death\"]"),
            format!("`episode.ends.2`: {wheels}"),
        ),
        (right.replace("trials = 1", "trials = 1\nends = [\"success\", \"collision\"]"), "ok".into()),
        (
            file("", MOTOR, &format!("{STEPS}\n[team]\ncoevolution = true")),
            "are for robots on wheels; of those with joints there is one".into(),
        ),
        (
            file(
                "",
                MOTOR,
                &format!("{STEPS}\n[[objects]]\nname = \"b\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.2\ncount = 2"),
            ),
            format!("`objects.1.count`: {wheels}"),
        ),
        (file("", MOTOR, &format!("{STEPS}\n[foraging]\nnest = \"rod\"")), format!("`foraging`: {wheels}")),
    ] {
        check(&text, &why);
    }
}

#[test]
fn parts_of_jointed_robots_are_refused_on_wheels() {
    let text = |robot: &str, rest: &str| {
        format!(
            "[robot]\nkind = \"e-puck\"\n{robot}\n[[sensors]]\nkind = \"touch\"\n[[motors]]\nkind = \"wheels\"\n\
             [network]\nkind = \"perceptron\"\n[[reward]]\nkind = \"steps\"\n{rest}"
        )
    };
    let joints = "is for robots with joints; this one is on wheels";
    for (text, why) in [
        (text("", ""), "ok".to_owned()),
        (text("floating = true", ""), format!("`robot.floating`: {joints}")),
        (text("base = [0.0, 0.1, 0.0]", ""), format!("`robot.base`: {joints}")),
        (text("base = [0.0, 0.0, 0.0]", ""), "ok".into()),
        (text("file = \"a.urdf\"", "[files]\n\"a.urdf\" = \"\""), format!("`robot.file`: {joints}")),
        (
            text("", "[[objects]]\nname = \"b\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.2\nat = [0.5, 0.5]"),
            "`objects.1`: is for robots with joints; next to one on wheels are".into(),
        ),
        (
            text("", "[[objects]]\nname = \"b\"\nkind = \"cylinder\"\nradius = 0.1\nat = [0.5, 0.5, 0.5]"),
            "`objects.1.at`: has 3 values where 2 are wanted".into(),
        ),
        (
            text("", "[[objects]]\nname = \"robot-x\"\nkind = \"cylinder\"\nradius = 0.1\nat = [0.5, 0.5]"),
            "`robot-x` names something else already".into(),
        ),
        (
            text("", "[[reward]]\nkind = \"position\"\nalong = [0.0, 0.0, 1.0]"),
            "`reward.2.along`: points nowhere in the plane".into(),
        ),
        (text("", "[[reward]]\nkind = \"position\"\nalong = [0.0, 1.0, 1.0]"), "ok".into()),
        (text("", "[[reward]]\nkind = \"speed\"\nbody = \"hull\""), "`reward.2`: names a body or point".into()),
        (text("", "[[reward]]\nkind = \"touch\"\nwith = \"hull\""), "`reward.2`: names a body or point".into()),
        (text("", "[[reward]]\nkind = \"touch\"\nbodies = [\"hull\"]"), "`reward.2`: names a body or point".into()),
        (
            text("", "[[sensors]]\nkind = \"height\"\npoint = [0.0, 0.0, 0.1]"),
            "`sensors.2`: names a body or point".into(),
        ),
        (
            text("", "[[sensors]]\nkind = \"contact-force\"\nwith = \"hull\""),
            "`sensors.2`: names a body or point".into(),
        ),
        (text("", "[[sensors]]\nkind = \"body-pose\"\nbody = \"hull\""), "`sensors.2`: names a body or point".into()),
        (text("", "[[sensors]]\nkind = \"joint-position\"\nfrom = 0.0"), "`sensors.2`: lacks the key `to`".into()),
        (text("", "[[sensors]]\nkind = \"infrared\"\ngroups = 2"), "groups of sensors by the formula".into()),
        (text("", "[[sensors]]\nkind = \"signal\"\nrange = 1.0\nsectors = 8"), "ok".into()),
        (text("", "[[sensors]]\nkind = \"signal\"\nrange = 1.0\nsectors = 3"), "sectors, of 1, 2, 4 or 8".into()),
        (
            text(
                "",
                "[foraging]\nnest = \"nest\"\n[[objects]]\nname = \"nest\"\nkind = \"rectangle\"\nsize = [0.1, 0.1]\ncolor = [0, 0, 0]\nat = [0.5, 0.5]",
            ),
            "`foraging.nest`: `nest` is no disc".into(),
        ),
        (text("", "[episode]\nends = [\"death\"]"), "`episode.ends.1`: needs the section `foraging`".into()),
        (text("", "[[reward]]\nkind = \"alive\""), "`reward.2`: needs the section `foraging`".into()),
        (text("", "[[sensors]]\nkind = \"carried\""), "`sensors.2`: needs the section `foraging`".into()),
    ] {
        check(&text, &why);
    }
}

#[test]
fn motors_lack_what_the_joint_does_not_have() {
    let motor = |motor: &str| file("", motor, STEPS);
    let endless = |text: &str| text.replace("type=\"revolute\"", "type=\"continuous\"");
    let start = |start: &str| {
        let ball = "[[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.2";
        file("", MOTOR, &format!("{ball}\n[[start]]\nplace = \"ball\"\n{start}\n{STEPS}"))
    };
    for (text, why) in [
        (
            motor("kind = \"joint-velocity\"\njoints = [\"hinge\"]\nlargest = 1.0\nlimit = 2.0"),
            "lacks the key `gain`, of the motor whose `limit` it says",
        ),
        (motor("kind = \"joint-velocity\"\nlargest = 1.0\nlimit = 2.0\ngain = 3.0"), "ok"),
        (
            motor("kind = \"joint-velocity\"\nlargest = 1.0\njoints = [\"hinge\"]"),
            "lacks the key `gain`: `hinge` has no such motor of its own",
        ),
        (motor("kind = \"servo\"\njoints = [\"hinge\"]\nlimit = 1.0"), "lacks the key `stiffness`, of the servo whose"),
        (motor("kind = \"servo\"\njoints = [\"hinge\"]\nstiffness = 3.0\nlimit = 1.0"), "ok"),
        (motor("kind = \"muscles\"\ntension = 10.0\nmoment_arm = 0.1"), "ok"),
        (
            motor("kind = \"muscles\"\njoints = [\"hinge\"]\nmoment_arm = 0.1"),
            "has one of `tension` and `moment_arm`, which go together",
        ),
        (
            endless(&motor("kind = \"muscles\"\ntension = 10.0\nmoment_arm = 0.1")),
            "`hinge` turns on and on; muscles need a joint with a range",
        ),
        (
            endless(&file(
                "",
                MOTOR,
                &format!("[[sensors]]\nname = \"own\"\nkind = \"joint-position\"\nfrom = 0.0\n{STEPS}"),
            )),
            "lacks `from` or `to`: `hinge` has no range of its own",
        ),
        (motor("kind = \"leds\"\ncolors = [\"red\"]"), "is for robots on wheels; this one has joints"),
        (start("at = \"fixed\"\npoint = [3.0, 0.0, 1.0]"), "ok"),
        (
            start("at = \"fixed\"\npoint = [3.0, 0.0, 1.0]\ndrawn_heading = true"),
            "`start.1.drawn_heading`: is for robots on wheels",
        ),
        (
            start("at = \"one-of\"\npoints = [[3.0, 0.0, 1.0], [3.0, 0.0]]"),
            "`start.1.points.2`: has 2 values where 3 are wanted",
        ),
        (start("at = \"in-box\"\nlow = [3.0, 0.0, 1.0]\nhigh = [3.0, 0.0, 1.0]"), "ok"),
    ] {
        check(&text, why);
    }
}
