//! The arm reaches for a point by a controller written by hand: inverse kinematics, inverse statics, some feedback.
//!
//! `cargo run --example 04_reach_by_hand [seconds]`

use std::error::Error;

use farsa::body::actuators::Law;
use farsa::body::kinematics::{Goal, InverseKinematics, KinematicTree, Orientation};
use farsa::body::motors::Muscles;
use farsa::body::ports::{ActuatorId, Joints, Motor, World as _};
use farsa::body::robots::ArmAndHand;
use farsa::body::sensors::Point;
use farsa::physics::articulated::{Model, Options, World};

fn main() -> Result<(), Box<dyn Error>> {
    let seconds: f32 = std::env::args().nth(1).map_or(Ok(3.0), |text| text.parse())?;
    let arm = ArmAndHand::default();
    let robot = arm.robot()?;
    let tree = KinematicTree::new(&robot)?;
    let joints = ArmAndHand::joints();

    // Where: the palm's centre above a place on the table, facing down. Muscles at constant activations hold a joint
    // only in the middle 72 % of its range.
    let target = [0.18, -0.26, 0.10];
    let goal = Goal {
        body: ArmAndHand::PALM,
        point: arm.palm_centre,
        position: target,
        orientation: Orientation::Direction { own: ArmAndHand::PALM_NORMAL, wanted: [0.0, 0.0, -1.0] },
    };
    let search = InverseKinematics { range_fraction: 0.72, ..InverseKinematics::default() };
    let posture = search.solve(&tree, &goal, &tree.zero())?;
    println!("found a posture, {:.1e} m and {:.1e} rad off", posture.position_error, posture.angle_error);

    let mut world = World::new(Model::<f32>::new(&robot, &Options::default())?);
    let mut motors: [Muscles; 7] = std::array::from_fn(|i| Muscles::new(ActuatorId(i as u16)));
    let palm = Point { body: ArmAndHand::PALM, at: arm.palm_centre.map(|x| x as f32) };
    let miss = |world: &World<f32>| {
        let at = palm.position(world);
        let d: [f64; 3] = std::array::from_fn(|k| f64::from(at[k]) - target[k]);
        1000.0 * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
    };

    let ticks = (seconds / world.time_step()) as usize;
    let stiffness = [12.0, 40.0, 12.0, 12.0, 6.0, 4.0, 4.0];
    for tick in 0..ticks {
        if tick % 50 == 0 {
            println!("{:>5} ms: the palm is {:>6.1} mm from its place", 10 * tick, miss(&world));
        }
        let now = joints.map(|joint| f64::from(world.position(joint)));
        // The torques that hold the arm where it is, and a spring and damper towards the posture.
        let mut torques = tree.gravity_torques(&tree.poses(&now), [0.0, 0.0, -9.81]);
        let mut y = [0.0; 14];
        for i in 0..7 {
            let speed = f64::from(world.speed(joints[i]));
            torques[i] += stiffness[i] * (posture.joints[i] - now[i]) - 0.08 * stiffness[i] * speed;
            if let Law::MusclePair(pair) = robot.actuators[i].law {
                let (activations, _) = pair.activations(now[i], torques[i]);
                y[2 * i..2 * i + 2].copy_from_slice(&activations.map(|a| a as f32));
            }
        }
        motors.drive(&y, &mut world);
        world.step();
    }
    println!("after {seconds} s: {:.2} mm", miss(&world));
    assert!(miss(&world) < 5.0, "the palm did not get there");
    Ok(())
}
