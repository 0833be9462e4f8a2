//! Descriptions of wheeled robots as bodies in rapier.

use crate::vehicles::{Tolerance, check};
use farsa_physics::rapier::{Options, World};

#[test]
fn wheeled_robots_stand_drive_and_turn() {
    check(|robot| World::new(robot, &Options::default()).unwrap(), &Tolerance { height: 1e-3, drive: 0.02 });
}
