//! Settings of an MJCF that change the robot or its world.

use crate::{close, measured, outcome, refused};

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
