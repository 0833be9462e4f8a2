//! Settings of an MJCF that change the robot or its world.

use crate::{close, made, measured, outcome, refused};

/// A cart of 1 kg on a rail through its box, at this height, with a motor of 10 N.
fn cart(option: &str, height: f64, world: &str) -> String {
    format!(
        "[world]\nengine = \"articulated\"\ntime_step = 0.01\n{world}\n[robot]\nkind = \"model\"\nfile = \"cart.xml\"\n\
         [[sensors]]\nkind = \"joint-position\"\nfrom = 0.0\nto = 2.0\n[[motors]]\nkind = \"joint-torque\"\n\
         [network]\nkind = \"perceptron\"\n[episode]\nsteps = 101\ntrials = 1\n\
         [[reward]]\nkind = \"sensor\"\nsensor = \"joint-position\"\nover = \"end\"\nweight = 0.0\n[files]\n\
         \"cart.xml\" = '''<mujoco><option {option}</option><worldbody>\
         <geom name=\"rail\" type=\"capsule\" size=\"0.02\" fromto=\"-2 0 {height} 2 0 {height}\"/>\
         <body pos=\"0 0 {height}\"><joint name=\"slide\" type=\"slide\" axis=\"1 0 0\" range=\"-5 5\"/>\
         <geom type=\"box\" size=\"0.2 0.15 0.1\" mass=\"1\"/></body></worldbody>\
         <actuator><motor joint=\"slide\" ctrlrange=\"-10 10\"/></actuator></mujoco>'''\n"
    )
}

#[test]
fn a_model_without_contacts_touches_neither_its_rail_nor_the_floor() {
    // MuJoCo 4.0.0: with 2 N the cart is at 1.000 m after a second. It is stuck if it touches.
    let distance = |text: &str| 2.0 * measured(&outcome(text, 0.6), "sensor");
    for (height, world) in [(1.0, "floor = false"), (1.0, ""), (0.05, "")] {
        close(distance(&cart("><flag contact=\"disable\"/>", height, world)), 1.0, 0.011);
    }
    close(distance(&cart(">", 1.0, "floor = false")), 0.0, 0.01);
}

#[test]
fn the_gravity_of_a_model_is_never_replaced_silently() {
    let without = "<flag contact=\"disable\"/>";
    for (option, gravity) in [
        (format!("gravity=\"0 0 -1.5\">{without}"), "[0.0, 0.0, -1.5]"),
        (format!("gravity=\"0 0 -9\">{without}<flag gravity=\"disable\"/>"), "[0.0, 0.0, 0.0]"),
    ] {
        let why = refused(&cart(&option, 1.0, ""));
        assert!(why.contains(&format!("that of the model {gravity}; set `gravity = {gravity}`")), "{why}");
        // A world that chooses its gravity keeps it: 2 m/s2 in addition to the 2 N on 1 kg.
        let text = cart(&option, 1.0, "gravity = [2.0, 0.0, 0.0]");
        close(2.0 * measured(&outcome(&text, 0.6), "sensor"), 2.0, 0.022);
    }
    let text = cart(&format!("gravity=\"0 0 -9.81\">{without}"), 1.0, "");
    close(2.0 * measured(&outcome(&text, 0.6), "sensor"), 1.0, 0.011);
}

#[test]
fn a_second_actuator_on_a_joint_is_warned_about() {
    let with = |model: &str, motor: &str| {
        let text = cart(">", 1.0, "floor = false").replace("<motor joint=\"slide\" ctrlrange=\"-10 10\"/>", model);
        let text = text.replace("kind = \"joint-torque\"", motor).replace("weight = 0.0", "weight = 1.0");
        made(&text).unwrap_or_else(|error| panic!("{error}\n{text}")).info().warnings
    };
    let spring = "<position name=\"spring\" joint=\"slide\" kp=\"100\"/>";
    let servo = "kind = \"servo\"\nstiffness = 50.0\ndamping = 5.0";
    let found = with(spring, servo);
    let why = "line 12: `slide` has two actuators, the new one and the model's `spring` with the command 0";
    assert!(found.len() == 1 && found[0].ends_with(why), "{found:?}");
    // A motor without a command exerts no force, and a driven servo is no second one.
    assert_eq!(with("<motor joint=\"slide\"/>", servo), Vec::<String>::new());
    assert_eq!(with(spring, "kind = \"servo\""), Vec::<String>::new());
}
