//! `option` and `flag` of an MJCF: the settings that change the robot. The expected numbers are those of MuJoCo 4.0.0.

use farsa_body::actuators::{Law, Torque};
use farsa_body::ports::{Actuated, Joints, World as _};
use farsa_models::Imported;
use farsa_physics::articulated::{Model, Options, World};

use crate::{message, read};

/// A cart between rails, with a pole that touches a ball in the world.
fn cart(option: &str) -> Imported {
    let text = format!(
        "<mujoco>{option}<worldbody><geom name='rail' type='capsule' size='0.02' fromto='-2 0 1 2 0 1'/>\
         <body name='cart' pos='0 0 1'><joint name='slide' type='slide' axis='1 0 0' range='-1.8 1.8' damping='3' \
         stiffness='2' frictionloss='1'/><geom name='cart' type='box' size='0.2 0.15 0.1' mass='1'/>\
         <body name='pole'><joint name='hinge' axis='0 1 0'/><geom name='pole' type='capsule' size='0.05' \
         fromto='0 0 0 0 0 1' mass='0.1' friction='0.3'/></body></body></worldbody>\
         <contact><pair geom1='rail' geom2='pole'/></contact>\
         <equality><joint joint1='slide' joint2='hinge'/></equality>\
         <actuator><motor name='push' joint='slide' gear='10' ctrlrange='-1 1'/>\
         <motor joint='hinge' group='3'/></actuator></mujoco>"
    );
    read(&text).unwrap_or_else(|error| panic!("{error}"))
}

fn flag(flags: &str) -> Imported {
    cart(&format!("<option><flag {flags}/></option>"))
}

fn pairs(read: &Imported) -> Vec<[&str; 2]> {
    let name = |collider: usize| read.robot.colliders[collider].name.as_str();
    read.robot.pairs.iter().map(|pair| pair.colliders.map(name)).collect()
}

fn has_note(read: &Imported, what: &str) -> bool {
    read.warnings.iter().any(|note| note.what == what)
}

#[test]
fn flags_are_applied() {
    let plain = cart("");
    assert_eq!(pairs(&plain), [["rail", "pole"], ["rail", "cart"]]);
    assert_eq!((plain.gravity, plain.contacts, plain.robot.actuators.len()), (None, true, 2));
    assert_eq!((plain.robot.segments[0].joint.range, plain.robot.segments[0].joint.damping), ([-1.8, 1.8], 3.0));
    assert_eq!(plain.robot.actuators[0].law, Law::Torque(Torque { limit: 10.0 }));
    assert!(has_note(&plain, "equality"));
    let laws = |read: &Imported| [read.robot.segments[0].joint.stiffness, read.robot.segments[0].joint.friction];
    assert_eq!(laws(&plain), [2.0, 1.0]);

    for flags in ["contact='disable'", "constraint='disable'"] {
        let read = flag(flags);
        assert!(read.robot.pairs.is_empty() && !read.contacts, "{flags}");
        assert_eq!(read.robot.colliders.len(), 3);
    }
    for flags in ["limit='disable'", "constraint='disable'"] {
        assert_eq!(flag(flags).robot.segments[0].joint.range, [f64::NEG_INFINITY, f64::INFINITY], "{flags}");
    }
    let ungrouped = flag("actuation='disable'");
    assert!(ungrouped.robot.actuators.is_empty() && has_note(&ungrouped, "actuator motor"));
    assert_eq!(flag("clampctrl='disable'").robot.actuators[0].law, Law::Torque(Torque { limit: f64::INFINITY }));
    // The geoms of a body and its parent touch as well.
    let unfiltered = flag("filterparent='disable'");
    assert_eq!(pairs(&unfiltered), [["rail", "pole"], ["rail", "cart"], ["cart", "pole"]]);
    for flags in ["damper='disable'", "passive='disable'"] {
        assert_eq!(flag(flags).robot.segments[0].joint.damping, 0.0, "{flags}");
    }
    assert_eq!(flag("gravity='disable'").gravity, Some([0.0; 3]));
    assert!(!has_note(&flag("equality='disable'"), "equality"));
    for flags in ["spring='disable'", "passive='disable'"] {
        assert_eq!(laws(&flag(flags)), [0.0, 1.0], "{flags}");
    }
    for flags in ["frictionloss='disable'", "constraint='disable'"] {
        assert_eq!(laws(&flag(flags)), [2.0, 0.0], "{flags}");
    }
    assert!(has_note(&flag("warmstart='disable'"), "flag `warmstart`"));
    assert_eq!(flag("contact='enable' gravity='enable'").robot, plain.robot);
}

#[test]
fn options_are_applied_or_listed() {
    assert_eq!(cart("<option gravity='1 0 -2'/>").gravity, Some([1.0, 0.0, -2.0]));
    assert_eq!(cart("<option gravity='1 0 -2'><flag gravity='disable'/></option>").gravity, Some([0.0; 3]));
    // Later sections add to earlier ones.
    let read = cart("<option gravity='1 0 -2'/><option timestep='0.1'><flag contact='disable'/></option>");
    assert_eq!((read.gravity, read.contacts), (Some([1.0, 0.0, -2.0]), false));
    assert!(has_note(&read, "option `timestep`"));
    let read = cart("<option actuatorgroupdisable='1 3'/>");
    assert_eq!((read.robot.actuators.len(), read.robot.actuators[0].name.as_str()), (1, "push"));
    let fluid = cart("<option density='1000' viscosity='0.1' wind='1 0 0'/>");
    for what in ["option `density`", "option `viscosity`", "option `wind`"] {
        assert!(has_note(&fluid, what), "{what}");
    }
    let plain = cart("<option cone='elliptic'/>").robot.pairs[0].surface;
    let unused = cart("<option cone='elliptic' o_friction='0.5' o_solref='0.04'/>").robot.pairs[0].surface;
    assert_eq!(unused, plain);
    let read = cart("<option cone='elliptic' o_friction='0.5' o_solref='0.04'><flag override='enable'/></option>");
    for pair in &read.robot.pairs {
        assert_eq!(pair.surface.friction, 0.5);
    }
    // The stiffness is inversely proportional to the square of the time constant, which is 0.02 s by default.
    assert!((4.0 * read.robot.pairs[0].surface.stiffness / plain.stiffness - 1.0).abs() < 1e-12);
    for wrong in ["cone='round'", "impratio='0'"] {
        let name = wrong.split('=').next().unwrap();
        let error = message(&format!("<mujoco><option {wrong}/></mujoco>"));
        assert!(error.contains(name), "{wrong}: {error}");
    }
}

#[test]
fn unknown_settings_are_refused() {
    let text = |option: &str| format!("<mujoco>\n{option}<worldbody/></mujoco>");
    for (option, why) in [
        ("<option gravty='0 0 0'/>", "text line 2: unknown attribute of option `gravty`; the nearest is `gravity`"),
        (
            "<option><flag contacts='disable'/></option>",
            "text line 2: unknown attribute of flag `contacts`; the nearest is `contact`",
        ),
        (
            "<option><flag contact='disabled'/></option>",
            "text line 2: unknown contact `disabled`; the nearest is `disable`",
        ),
        ("<option><flg/></option>", "text line 2: unknown element of option `flg`; the nearest is `flag`"),
    ] {
        assert_eq!(message(&text(option)), why);
    }
}

#[test]
fn a_cart_without_contacts_moves_along_its_rail() {
    // MuJoCo 4.0.0: 2 N on 1 kg move it by t^2 = 1 m in a second. With contacts it is stuck.
    let text = "<mujoco><option><flag contact='disable'/></option><worldbody>\
         <geom name='rail' type='capsule' size='0.02' fromto='-2 0 1 2 0 1'/><body pos='0 0 1'>\
         <joint name='slide' type='slide' axis='1 0 0'/><geom type='box' size='0.2 0.15 0.1' mass='1'/></body></worldbody>\
         <actuator><motor name='push' joint='slide' ctrlrange='-10 10'/></actuator></mujoco>";
    let distance = |text: &str| {
        let robot = read(text).unwrap().robot;
        let (joint, motor) = (robot.joint("slide").unwrap(), robot.actuator("push").unwrap());
        let mut world = World::new(Model::<f32>::new(&robot, &Options::default()).unwrap());
        world.command(motor, [2.0, 0.0]);
        let steps = (1.0 / Options::default().time_step).round() as usize;
        (0..steps).for_each(|_| world.step());
        world.position(joint)
    };
    assert!((distance(text) - 1.0).abs() < 0.01, "{}", distance(text));
    assert!((0.0..1.5e-3).contains(&distance(&text.replace("disable", "enable"))));
}
