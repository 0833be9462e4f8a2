//! A planar world as data: walls, obstacles, cylinders, colored areas of the ground and wheeled robots.

use alloc::vec::Vec;

use farsa_body::ports::{ActuatorId, BodyId, JointId};
use farsa_body::robots::{MobileParts, MobileRobot};

use crate::arena::convex::{Convex, GREY};

/// A wall: a box on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Wall {
    /// Its middle [m].
    pub centre: [f64; 2],
    /// Where its length points to, counter-clockwise from the x axis [rad].
    pub heading: f64,
    /// Length and thickness [m].
    pub size: [f64; 2],
    /// Height [m].
    pub height: f64,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
}

impl Wall {
    /// Height of a wall that is given none [m].
    pub const HEIGHT: f64 = 0.1;
    /// Color of a wall that is given none.
    pub const COLOR: [f64; 3] = GREY;

    /// A box with its middle at `centre` [m], of so much length and thickness [m], its length along `heading` [rad].
    pub fn cuboid(centre: [f64; 2], size: [f64; 2], heading: f64) -> Self {
        Self { centre, heading, size, height: Self::HEIGHT, color: Self::COLOR }
    }

    /// A wall whose middle line goes from one point to another [m], so thick [m], with square ends.
    pub fn segment(from: [f64; 2], to: [f64; 2], thickness: f64) -> Self {
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        let length = farsa_num::Scalar::sqrt(x * x + y * y);
        let centre = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        Self::cuboid(centre, [length, thickness], farsa_num::atan2(y, x))
    }

    /// Returns the wall in another color.
    pub fn with_color(self, color: [f64; 3]) -> Self {
        Self { color, ..self }
    }

    /// Returns the wall of another height [m].
    pub fn with_height(self, height: f64) -> Self {
        Self { height, ..self }
    }
}

/// A cylinder on the ground that does not move by itself, optionally a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Cylinder {
    /// The initial place of its axis [m].
    pub centre: [f64; 2],
    /// Radius [m].
    pub radius: f64,
    /// Height [m].
    pub height: f64,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
    /// The intensity of its light, in a unit of your choice. A cylinder with 0 is no lamp.
    pub lamp: f64,
}

impl Cylinder {
    /// A gray cylinder as high as a wall, at `centre` [m] with `radius` [m], that does not shine.
    pub fn new(centre: [f64; 2], radius: f64) -> Self {
        Self { centre, radius, height: Wall::HEIGHT, color: Wall::COLOR, lamp: 0.0 }
    }
}

/// The form of an [`Area`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
pub enum AreaShape {
    /// A disc.
    Circle {
        /// Radius [m].
        radius: f64,
    },
    /// A rectangle.
    Rectangle {
        /// Length along the area's heading, and breadth [m].
        size: [f64; 2],
    },
}

/// A part of the ground with a color, such as a target or a nest. Nothing collides with it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Area {
    /// Its middle at first [m].
    pub centre: [f64; 2],
    /// Where it points to at first, counter-clockwise from the x axis [rad].
    pub heading: f64,
    /// Its form.
    pub shape: AreaShape,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
}

impl Area {
    /// A disc at `centre` [m] with `radius` [m].
    pub fn circle(centre: [f64; 2], radius: f64, color: [f64; 3]) -> Self {
        Self { centre, heading: 0.0, shape: AreaShape::Circle { radius }, color }
    }

    /// A rectangle with its middle at `centre` [m], so long along `heading` [rad] and so broad [m].
    pub fn rectangle(centre: [f64; 2], size: [f64; 2], heading: f64, color: [f64; 3]) -> Self {
        Self { centre, heading, shape: AreaShape::Rectangle { size }, color }
    }
}

/// The treatment of robots that would overlap something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum CollisionRule {
    /// All move. Robots that then overlap anything are set back to where it was, as often as that makes others overlap.
    ///
    /// Its wheels continue to turn, as in the original.
    #[default]
    Revert,
    /// Overlapping robots are pushed apart, half by half, and off walls and cylinders, so that they slide along.
    ///
    /// Robots that eight sweeps of pushing do not free are set back as by [`Revert`](Self::Revert). So are attached
    /// robots.
    Circles,
}

/// The search for neighbors. Results are equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Search {
    /// In a grid where there are more than 32 robots and cylinders.
    #[default]
    Auto,
    /// By looking at everything.
    All,
    /// In a uniform grid.
    Grid,
}

/// A robot and where it starts.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct RobotPlacement {
    /// The robot.
    pub robot: MobileRobot,
    /// Where it starts [m].
    pub at: [f64; 2],
    /// Where it looks to at first, counter-clockwise from the x axis [rad].
    pub heading: f64,
}

/// A planar world as data.
///
/// Bodies are numbered: robots first, then cylinders, then areas. The wheels of robot `r` are joints `2 r` (left) and
/// `2 r + 1` (right). Actuators follow each other robot by robot, each robot's as in [`MobileRobot::parts`].
///
/// ```
/// use farsa_body::ports::{Actuated, Kinematics, World as _};
/// use farsa_body::robots::MobileRobot;
/// use farsa_physics::arena::{Arena, Cylinder, World};
///
/// let mut arena = Arena::walled(0.4, 0.4);
/// arena.add_cylinder(Cylinder::new([0.3, 0.2], 0.0125));
/// let khepera = arena.add_robot(MobileRobot::khepera(), [0.1, 0.2], 0.0);
/// let mut world = World::new(&arena)?;
/// let parts = world.parts(khepera);
/// parts.motors.map(|motor| world.command(motor, [2.0, 0.0]));
/// for _ in 0..20 {
///     world.step();
/// }
/// assert!((world.pose(parts.body).position[0] - 0.13).abs() < 1e-6);
/// # Ok::<(), farsa_physics::arena::ArenaError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Arena {
    /// Everything starts within [0, width] x [0, depth] [m], if given.
    pub size: Option<[f64; 2]>,
    /// The walls.
    pub walls: Vec<Wall>,
    /// The convex obstacles.
    pub convexes: Vec<Convex>,
    /// The cylinders.
    pub cylinders: Vec<Cylinder>,
    /// The areas. Where several lie over each other, the last one is seen.
    pub areas: Vec<Area>,
    /// The robots.
    pub robots: Vec<RobotPlacement>,
    /// Color of the ground where no area is.
    pub ground: [f64; 3],
    /// The control step [s].
    pub time_step: f64,
    /// The treatment of robots that would overlap something.
    pub collisions: CollisionRule,
    /// The search for neighbors.
    pub search: Search,
}

impl Default for Arena {
    fn default() -> Self {
        Self::new()
    }
}

impl Arena {
    /// Thickness of the walls around [`Arena::walled`] [m].
    pub const THICKNESS: f64 = 0.03;
    /// The control step where none is given [s].
    pub const TIME_STEP: f64 = 0.05;

    /// An endless plane with nothing in it. Ground white, steps of 50 ms, collisions undone.
    pub fn new() -> Self {
        Self {
            size: None,
            walls: Vec::new(),
            convexes: Vec::new(),
            cylinders: Vec::new(),
            areas: Vec::new(),
            robots: Vec::new(),
            ground: [1.0; 3],
            time_step: Self::TIME_STEP,
            collisions: CollisionRule::Revert,
            search: Search::Auto,
        }
    }

    /// The rectangle [0, width] x [0, depth] [m] with four walls around it, their inner faces on its sides.
    pub fn walled(width: f64, depth: f64) -> Self {
        let t = Self::THICKNESS;
        let [middle, centre] = [0.5 * width, 0.5 * depth];
        let across =
            [[middle, -0.5 * t], [middle, depth + 0.5 * t]].map(|at| Wall::cuboid(at, [width + 2.0 * t, t], 0.0));
        let along =
            [[-0.5 * t, centre], [width + 0.5 * t, centre]].map(|at| Wall::cuboid(at, [t, depth + 2.0 * t], 0.0));
        Self { size: Some([width, depth]), walls: across.into_iter().chain(along).collect(), ..Self::new() }
    }

    /// Adds a wall. Its number.
    pub fn add_wall(&mut self, wall: Wall) -> usize {
        self.walls.push(wall);
        self.walls.len() - 1
    }

    /// Adds a convex obstacle. Its number.
    pub fn add_convex(&mut self, convex: Convex) -> usize {
        self.convexes.push(convex);
        self.convexes.len() - 1
    }

    /// Adds a cylinder. Its number, see [`Arena::cylinder`].
    pub fn add_cylinder(&mut self, cylinder: Cylinder) -> usize {
        self.cylinders.push(cylinder);
        self.cylinders.len() - 1
    }

    /// Adds an area. Its number, see [`Arena::area`].
    pub fn add_area(&mut self, area: Area) -> usize {
        self.areas.push(area);
        self.areas.len() - 1
    }

    /// Adds a robot that starts at `at` [m] and looks along `heading` [rad]. Its number, see [`Arena::parts`].
    pub fn add_robot(&mut self, robot: MobileRobot, at: [f64; 2], heading: f64) -> usize {
        self.robots.push(RobotPlacement { robot, at, heading });
        self.robots.len() - 1
    }

    /// Returns the numbers of a robot's parts, or those of the last robot for a number beyond it.
    ///
    /// # Panics
    /// If there are no robots.
    pub fn parts(&self, robot: usize) -> MobileParts {
        let robot = robot.min(self.robots.len().saturating_sub(1));
        let first: usize = self.robots[..robot].iter().map(|placed| placed.robot.actuators()).sum();
        self.robots[robot].robot.parts(BodyId(robot as u16), JointId(2 * robot as u16), ActuatorId(first as u16))
    }

    /// The body of a cylinder, when all robots are added.
    pub fn cylinder(&self, cylinder: usize) -> BodyId {
        BodyId((self.robots.len() + cylinder) as u16)
    }

    /// The body of an area, when all robots and cylinders are added.
    pub fn area(&self, area: usize) -> BodyId {
        BodyId((self.robots.len() + self.cylinders.len() + area) as u16)
    }
}
