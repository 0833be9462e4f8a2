//! A forearm on one joint, moved by two muscles: which activations hold it where, and does it go there?
//!
//! `cargo run --example 03_muscle_on_one_joint [degrees]`

use std::error::Error;

use farsa::body::Pose;
use farsa::body::actuators::{Law, MusclePair};
use farsa::body::kinematics::KinematicTree;
use farsa::body::motors::Muscles;
use farsa::body::ports::{Actuated, JointId, Joints, Motor, World as _};
use farsa::body::robot::{Collider, Joint, Robot, Segment};
use farsa::physics::articulated::{Model, Options, World};

fn forearm(range: [f64; 2], muscles: MusclePair<f64>) -> Result<(Robot, Muscles), Box<dyn Error>> {
    let mut robot = Robot::new("forearm");
    // Hangs from the elbow, 1 m above the ground, and turns about y.
    let hinge = Joint::revolute("elbow", [0.0, 1.0, 0.0], Pose::at([0.0, 0.0, 1.0]), range)
        .with_armature(0.01)
        .with_damping(0.4);
    let shape = Collider::capsule_between("forearm", None, [0.0; 3], [0.0, 0.0, -0.25], 0.025);
    let body = robot.add_segment(Segment::new("forearm", None, hinge, shape.mass_properties(0.8)));
    let pair = robot.add_actuator("muscles", JointId(body.0), Law::MusclePair(muscles));
    robot.validate()?;
    Ok((robot, Muscles::new(pair)))
}

/// Moves any world with the port `Actuated`.
fn act<W: Actuated>(motor: &mut impl Motor<W>, activations: [f32; 2], world: &mut W) {
    motor.drive(&activations, world);
}

fn main() -> Result<(), Box<dyn Error>> {
    let degrees: f64 = std::env::args().nth(1).map_or(Ok(35.0), |text| text.parse())?;
    let goal = degrees.to_radians();
    let elbow = JointId(0);
    let range = [-1.6, 1.6];
    // Tmax 300 N at a moment arm of 1 cm.
    let muscles = MusclePair::thesis(300.0, 0.010, range);
    let (robot, mut motor) = forearm(range, muscles)?;

    // Statics first: the torque against gravity, and the activations that give it.
    let tree = KinematicTree::new(&robot)?;
    let torque = tree.gravity_torques(&tree.poses(&[goal]), [0.0, 0.0, -9.81])[0];
    let (activations, reached) = muscles.activations(goal, torque);
    println!("{degrees} deg needs {torque:.3} N m: agonist {:.3}, antagonist {:.3}", activations[0], activations[1]);
    assert!(reached, "stronger muscles are needed for {degrees} deg");

    // Then dynamics: 3 s in steps of 10 ms, from rest at 0.
    let mut world = World::new(Model::<f32>::new(&robot, &Options::default())?);
    for tick in 0..300 {
        if tick % 30 == 0 {
            let (angle, speed) = (world.position(elbow).to_degrees(), world.speed(elbow).to_degrees());
            println!("{:>5} ms {angle:>8.2} deg {speed:>8.2} deg/s", 10 * tick);
        }
        act(&mut motor, activations.map(|a| a as f32), &mut world);
        world.step();
    }
    let miss = f64::from(world.position(elbow)).to_degrees() - degrees;
    println!("after 3 s it is {miss:.3} deg from the goal");
    assert!(miss.abs() < 1.0, "{miss} deg");
    Ok(())
}
