//! Wheeled robots as bodies in our world.

use crate::vehicles::{Tolerance, check};
use farsa_physics::articulated::{Model, Options, World};

#[test]
fn wheeled_robots_stand_drive_and_turn() {
    let world = |robot: &_| World::<f64>::new(Model::new(robot, &Options::default()).unwrap());
    check(world, &Tolerance { height: 2e-4, drive: 0.02 });
}
