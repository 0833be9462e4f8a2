//! The robots of the format.

use farsa_body::robots::{ArmAndHand, MobileRobot};
use farsa_lab::advanced::Part;

use crate::part::definition::{Definition, Maker};

/// Lists them under their names.
pub(crate) fn robots() -> Vec<Part> {
    let wheels = |name, about, robot| Definition::robot(name, about, Maker::Wheels(Box::new(robot)));
    let mut robots = vec![
        wheels("khepera", "35 mm radius, eight infrared sensors.", MobileRobot::khepera()),
        wheels(
            "e-puck",
            "35 mm radius, eight infrared sensors, three ground sensors, LEDs, a signal.",
            MobileRobot::e_puck(),
        ),
        wheels(
            "marxbot",
            "85 mm radius, 24 infrared sensors, twelve ground sensors, LEDs, a signal, an attachment device.",
            MobileRobot::marxbot(),
        ),
    ];
    let about = "An arm of seven joints with muscles, and a hand of twenty joints.";
    // A test builds the same robot, so an error cannot occur later.
    let arm = ArmAndHand::default().robot().ok();
    robots.extend(arm.map(|arm| Definition::robot("arm-and-hand", about, Maker::Joints(Box::new(arm)))));
    robots.push(Definition::robot("model", "A model from a URDF or MJCF file.", Maker::File));
    robots
}
