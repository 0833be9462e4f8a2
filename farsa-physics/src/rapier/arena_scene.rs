//! Wheeled robots as rigid bodies and the things they can push, as data.

use alloc::format;
use alloc::vec::Vec;

use farsa_body::ports::{BodyId, PairId};
use farsa_body::robots::MobileRobot;

use crate::arena::description::{Arena, Wall};
use crate::rapier::error::RapierError;

/// Additional properties that a [`MobileRobot`] needs as a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Chassis {
    /// Total mass, including the wheels [kg].
    pub mass: f64,
    /// Fraction of the mass that belongs to the two wheels together.
    pub wheel_share: f64,
    /// Largest torque of the motor of each wheel, measured at the wheel [N m].
    pub torque: f64,
    /// Inertia of each motor including its gear, measured at the wheel [kg m2].
    pub rotor_inertia: f64,
    /// Coefficient of friction between wheels and ground.
    pub grip: f64,
    /// Coefficient of friction between the hull and the things it runs into.
    pub friction: f64,
}

impl Chassis {
    /// [`MobileRobot::DENSITY`] [kg/m3].
    pub const DENSITY: f64 = MobileRobot::DENSITY;

    /// Chooses the chassis of a robot by its size.
    ///
    /// Note that all values are our choice. The mass follows from [`Chassis::DENSITY`], and a tenth of it is in the
    /// wheels. Together, the motors push with half the weight of the robot. Because of their gears, they resist
    /// acceleration like an additional fifth of its mass. Wheels are made of rubber (0.8), and the hull is smooth
    /// (0.3).
    pub fn for_robot(robot: &MobileRobot) -> Self {
        let mass = robot.mass();
        let wheel = robot.wheel_radius;
        Self {
            mass,
            wheel_share: MobileRobot::WHEEL_SHARE,
            torque: 0.25 * 9.81 * mass * wheel,
            rotor_inertia: 0.1 * mass * wheel * wheel,
            grip: 0.8,
            friction: 0.3,
        }
    }

    /// The fields with their names and ranges.
    fn fields(&self) -> [(&'static str, f64, [f64; 2]); 6] {
        [
            ("mass", self.mass, [1e-6, 1e6]),
            ("share of the wheels", self.wheel_share, [1e-3, 0.9]),
            ("torque", self.torque, [0.0, 1e6]),
            ("rotor inertia", self.rotor_inertia, [0.0, 1e6]),
            ("grip", self.grip, [0.0, 1e3]),
            ("friction", self.friction, [0.0, 1e3]),
        ]
    }
}

/// A box on the ground that robots can push around.
///
/// In its frame, x points along the length and z points up. The origin is on the ground below its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Block {
    /// Initial position of its middle [m].
    pub centre: [f64; 2],
    /// Initial direction of its length, counter-clockwise from the x axis [rad].
    pub heading: f64,
    /// Length, breadth and height [m].
    pub size: [f64; 3],
    /// Mass [kg], which is distributed evenly.
    pub mass: f64,
    /// Coefficient of friction with the ground and with what is smoother.
    pub friction: f64,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
}

impl Block {
    /// Creates a gray block of the given size [m] and mass [kg] with its middle at `centre` [m]. It is aligned with the
    /// axes and has a coefficient of friction of 0.5.
    pub fn new(centre: [f64; 2], size: [f64; 3], mass: f64) -> Self {
        Self { centre, heading: 0.0, size, mass, friction: 0.5, color: Wall::COLOR }
    }

    /// The fields with their names and ranges.
    fn fields(&self) -> [(&'static str, f64, [f64; 2]); 11] {
        let (place, length, color) = ([-1e5, 1e5], [1e-4, 1e3], [0.0, 1.0]);
        let ([x, y], [a, b, c], [red, green, blue]) = (self.centre, self.size, self.color);
        [
            ("place", x, place),
            ("place", y, place),
            ("heading", self.heading, [-1e4, 1e4]),
            ("length", a, length),
            ("breadth", b, length),
            ("height", c, length),
            ("mass", self.mass, [1e-6, 1e6]),
            ("friction", self.friction, [0.0, 1e3]),
            ("colour", red, color),
            ("colour", green, color),
            ("colour", blue, color),
        ]
    }
}

/// An arena whose robots are rigid bodies on wheels, and blocks that they can push.
///
/// Bodies, joints and actuators have the numbers of the arena. Blocks come after the areas.
///
/// ```
/// use farsa_body::ports::{Actuated, Kinematics, World as _};
/// use farsa_body::robots::MobileRobot;
/// use farsa_physics::arena::Arena;
/// use farsa_physics::rapier::{ArenaOptions, ArenaScene, ArenaWorld, Block, RapierError};
///
/// fn main() -> Result<(), RapierError> {
///     let mut arena = Arena::new();
///     let robot = arena.add_robot(MobileRobot::e_puck(), [0.0, 0.0], 0.0);
///     let mut scene = ArenaScene::new(arena);
///     scene.add_block(Block::new([0.12, 0.0], [0.12, 0.12, 0.05], 0.1));
///     let mut world = ArenaWorld::new(&scene, &ArenaOptions::default())?;
///     world.parts(robot).motors.map(|motor| world.command(motor, [5.0, 0.0]));
///     for _ in 0..60 {
///         world.step();
///     }
///     // Three seconds at 0.1 m/s, less 25 mm that the robot drives alone.
///     let place = world.pose(scene.block(0)).position[0];
///     assert!((place - 0.4).abs() < 0.02, "{place} m");
///     Ok(())
/// }
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct ArenaScene {
    /// Description of the arena. Note that its rule of collisions has no effect here, since it is for the kinematic
    /// world only.
    pub arena: Arena,
    /// Chassis of each robot in the arena.
    pub chassis: Vec<Chassis>,
    /// All blocks.
    pub blocks: Vec<Block>,
}

impl ArenaScene {
    /// Creates a scene without blocks. Each robot gets the chassis that [`Chassis::for_robot`] chooses for its size.
    pub fn new(arena: Arena) -> Self {
        let chassis = arena.robots.iter().map(|placed| Chassis::for_robot(&placed.robot)).collect();
        Self { arena, chassis, blocks: Vec::new() }
    }

    /// Adds a block and returns its number.
    pub fn add_block(&mut self, block: Block) -> usize {
        self.blocks.push(block);
        self.blocks.len() - 1
    }

    /// Number of the arena's bodies.
    pub(crate) fn arena_bodies(&self) -> usize {
        self.arena.robots.len() + self.arena.cylinders.len() + self.arena.areas.len()
    }

    /// Gets the body of a block. Call this only after everything in the arena is added, since blocks come last.
    pub fn block(&self, block: usize) -> BodyId {
        BodyId((self.arena_bodies() + block) as u16)
    }

    /// Gets the pair of a block and the body that it touches, except the ground. Note that the pairs of the robots come
    /// first.
    pub fn block_pair(&self, block: usize) -> PairId {
        PairId((self.arena.robots.len() + block) as u16)
    }

    /// Looks at everything but the arena, which is looked at in other places.
    pub(crate) fn check(&self) -> Result<(), RapierError> {
        let (robots, chassis) = (self.arena.robots.len(), self.chassis.len());
        if robots != chassis {
            return Err(RapierError::Chassis { robots, chassis });
        }
        if let Some(robot) = self.arena.robots.iter().position(|placed| placed.robot.attachment.is_some()) {
            let why =
                format!("robot {robot} has an attachment device, which holds nothing in rapier: take it off (`None`)");
            return Err(RapierError::Unsupported { why });
        }
        let fits = |(_, value, [low, high]): &(&str, f64, [f64; 2])| (*low..=*high).contains(value);
        for (robot, chassis) in self.chassis.iter().enumerate() {
            if let Some((field, value, range)) = chassis.fields().into_iter().find(|field| !fits(field)) {
                return Err(RapierError::Part { part: "robot", number: robot, field, value, range });
            }
        }
        for (block, it) in self.blocks.iter().enumerate() {
            if let Some((field, value, range)) = it.fields().into_iter().find(|field| !fits(field)) {
                return Err(RapierError::Part { part: "block", number: block, field, value, range });
            }
        }
        let count = self.arena_bodies() + self.blocks.len();
        if count > usize::from(u16::MAX) {
            return Err(crate::articulated::model::ModelError::TooMany { what: "bodies and blocks", count }.into());
        }
        Ok(())
    }
}
