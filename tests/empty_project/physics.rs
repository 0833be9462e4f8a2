use farsa_body::{ports::Actuated, ports::Kinematics, ports::World as _, robots::MobileRobot};
use farsa_physics::arena::{Arena, ArenaError, World};

fn main() -> Result<(), ArenaError> {
    let mut arena = Arena::walled(1.0, 1.0);
    arena.add_robot(MobileRobot::e_puck(), [0.5, 0.5], 0.0);
    let (mut world, robot) = (World::new(&arena)?, arena.parts(0));
    robot.motors.iter().for_each(|motor| world.command(*motor, [5.0, 0.0]));
    (0..10).for_each(|_| world.step());
    Ok(println!("{:.3?}", world.pose(robot.body).position))
}
