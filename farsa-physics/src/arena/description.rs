//! A planar world as data, with walls, obstacles, cylinders, colored areas of the ground and wheeled robots.

use alloc::vec::Vec;

use farsa_body::ports::{ActuatorId, BodyId, JointId};
use farsa_body::robots::{MobileParts, MobileRobot};

use crate::arena::convex::{Convex, GREY};

/// A wall, which is a box on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Wall {
    /// Position of its middle [m].
    pub centre: [f64; 2],
    /// Direction of its length, counter-clockwise from the x axis [rad].
    pub heading: f64,
    /// Length and thickness [m].
    pub size: [f64; 2],
    /// Height [m].
    pub height: f64,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
}

impl Wall {
    /// Default height of a wall [m].
    pub const HEIGHT: f64 = 0.1;
    /// Default color of a wall, a shade of gray.
    pub const COLOR: [f64; 3] = GREY;

    /// Creates a wall of the given length and thickness [m] with its middle at `centre` [m]. Its length points along
    /// `heading` [rad], and it has the default height and color.
    pub fn cuboid(centre: [f64; 2], size: [f64; 2], heading: f64) -> Self {
        Self { centre, heading, size, height: Self::HEIGHT, color: Self::COLOR }
    }

    /// Creates a wall whose middle line goes from one point to another [m]. The wall ends at these points, and its ends
    /// are square.
    pub fn segment(from: [f64; 2], to: [f64; 2], thickness: f64) -> Self {
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        let length = farsa_num::Scalar::sqrt(x * x + y * y);
        let centre = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        Self::cuboid(centre, [length, thickness], farsa_num::atan2(y, x))
    }

    /// Sets the color of the wall.
    pub fn with_color(self, color: [f64; 3]) -> Self {
        Self { color, ..self }
    }

    /// Sets the height of the wall [m].
    pub fn with_height(self, height: f64) -> Self {
        Self { height, ..self }
    }
}

/// A cylinder on the ground, which can also be a lamp. It does not move by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Cylinder {
    /// Initial position of its axis [m].
    pub centre: [f64; 2],
    /// Radius [m].
    pub radius: f64,
    /// Height [m].
    pub height: f64,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
    /// Intensity of its light, in a unit of your choice. If this is 0, the cylinder is not a lamp.
    pub lamp: f64,
}

impl Cylinder {
    /// Creates a gray cylinder at `centre` [m] with the given `radius` [m]. It is as high as a wall and does not shine.
    pub fn new(centre: [f64; 2], radius: f64) -> Self {
        Self { centre, radius, height: Wall::HEIGHT, color: Wall::COLOR, lamp: 0.0 }
    }
}

/// Shape of an [`Area`].
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

/// A colored part of the ground, such as a target or a nest. Since it is flat, nothing collides with it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Area {
    /// Initial position of its middle [m].
    pub centre: [f64; 2],
    /// Initial direction, counter-clockwise from the x axis [rad].
    pub heading: f64,
    /// Shape of the area.
    pub shape: AreaShape,
    /// Red, green and blue [0..1].
    pub color: [f64; 3],
}

impl Area {
    /// Creates a disc at `centre` [m] with the given `radius` [m].
    pub fn circle(centre: [f64; 2], radius: f64, color: [f64; 3]) -> Self {
        Self { centre, heading: 0.0, shape: AreaShape::Circle { radius }, color }
    }

    /// Creates a rectangle with its middle at `centre` [m]. The first number of `size` is its length along `heading`
    /// [rad], the second its breadth [m].
    pub fn rectangle(centre: [f64; 2], size: [f64; 2], heading: f64, color: [f64; 3]) -> Self {
        Self { centre, heading, shape: AreaShape::Rectangle { size }, color }
    }
}

/// Determines how robots are treated if they would overlap something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum CollisionRule {
    /// Moves all robots first. Robots that then overlap anything are set back to where they were. This is repeated as
    /// often as it makes others overlap.
    ///
    /// Wheels of such a robot continue to turn, as in the original.
    #[default]
    Revert,
    /// Pushes overlapping robots apart, each by half of the overlap. Robots are also pushed off walls and cylinders, so
    /// they slide along them.
    ///
    /// If a robot still overlaps something after eight sweeps of pushing, it is set back as by
    /// [`Revert`](Self::Revert). Attached robots that overlap something are set back in the same way.
    Circles,
}

/// Method used to search for neighbors. Note that this affects only the speed, since all methods give the same results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Search {
    /// Use a grid if there are more than 32 robots and cylinders.
    #[default]
    Auto,
    /// Always look at everything.
    All,
    /// Always use a uniform grid.
    Grid,
}

/// A robot and the pose it starts from.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct RobotPlacement {
    /// The robot.
    pub robot: MobileRobot,
    /// Initial position [m].
    pub at: [f64; 2],
    /// Initial heading, counter-clockwise from the x axis [rad].
    pub heading: f64,
}

/// A planar world as data. You can change it freely and then build a [`World`](crate::arena::World) from it.
///
/// Bodies are numbered in the order of robots, cylinders and areas. Robot `r` has its wheels at joints `2 r` (left) and
/// `2 r + 1` (right). Actuators are numbered robot by robot, and those of each robot are in the order of
/// [`MobileRobot::parts`].
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
    /// Size of the arena [m]. If given, everything must start within [0, width] x [0, depth].
    pub size: Option<[f64; 2]>,
    /// All walls.
    pub walls: Vec<Wall>,
    /// All convex obstacles.
    pub convexes: Vec<Convex>,
    /// All cylinders.
    pub cylinders: Vec<Cylinder>,
    /// All areas. If several of them overlap, the last one is visible.
    pub areas: Vec<Area>,
    /// All robots and where they start.
    pub robots: Vec<RobotPlacement>,
    /// Color of the ground outside the areas.
    pub ground: [f64; 3],
    /// Duration of a control step [s].
    pub time_step: f64,
    /// Determines how robots are treated if they would overlap something.
    pub collisions: CollisionRule,
    /// Method used to search for neighbors.
    pub search: Search,
}

impl Default for Arena {
    fn default() -> Self {
        Self::new()
    }
}

impl Arena {
    /// Thickness of the walls that [`Arena::walled`] creates [m].
    pub const THICKNESS: f64 = 0.03;
    /// Default duration of a control step [s].
    pub const TIME_STEP: f64 = 0.05;

    /// Creates an endless plane with nothing in it. The ground is white, a step takes 50 ms and collisions are undone.
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

    /// Creates the rectangle [0, width] x [0, depth] [m] with four walls around it. Their inner faces lie on the sides
    /// of the rectangle, so the whole area is free.
    pub fn walled(width: f64, depth: f64) -> Self {
        let t = Self::THICKNESS;
        let [middle, centre] = [0.5 * width, 0.5 * depth];
        let across =
            [[middle, -0.5 * t], [middle, depth + 0.5 * t]].map(|at| Wall::cuboid(at, [width + 2.0 * t, t], 0.0));
        let along =
            [[-0.5 * t, centre], [width + 0.5 * t, centre]].map(|at| Wall::cuboid(at, [t, depth + 2.0 * t], 0.0));
        Self { size: Some([width, depth]), walls: across.into_iter().chain(along).collect(), ..Self::new() }
    }

    /// Adds a wall and returns its number.
    pub fn add_wall(&mut self, wall: Wall) -> usize {
        self.walls.push(wall);
        self.walls.len() - 1
    }

    /// Adds a convex obstacle and returns its number.
    pub fn add_convex(&mut self, convex: Convex) -> usize {
        self.convexes.push(convex);
        self.convexes.len() - 1
    }

    /// Adds a cylinder and returns its number. You can pass this number to [`Arena::cylinder`] to get its body.
    pub fn add_cylinder(&mut self, cylinder: Cylinder) -> usize {
        self.cylinders.push(cylinder);
        self.cylinders.len() - 1
    }

    /// Adds an area and returns its number. You can pass this number to [`Arena::area`] to get its body.
    pub fn add_area(&mut self, area: Area) -> usize {
        self.areas.push(area);
        self.areas.len() - 1
    }

    /// Adds a robot that starts at `at` [m] and looks along `heading` [rad]. This returns its number, which you can
    /// pass to [`Arena::parts`].
    pub fn add_robot(&mut self, robot: MobileRobot, at: [f64; 2], heading: f64) -> usize {
        self.robots.push(RobotPlacement { robot, at, heading });
        self.robots.len() - 1
    }

    /// Gets the numbers of the parts of a robot. If there is no such robot, the parts of the last one are returned.
    ///
    /// # Panics
    /// If there are no robots.
    pub fn parts(&self, robot: usize) -> MobileParts {
        let robot = robot.min(self.robots.len().saturating_sub(1));
        let first: usize = self.robots[..robot].iter().map(|placed| placed.robot.actuators()).sum();
        self.robots[robot].robot.parts(BodyId(robot as u16), JointId(2 * robot as u16), ActuatorId(first as u16))
    }

    /// Gets the body of a cylinder. Call this only after all robots are added, since bodies of robots come first.
    pub fn cylinder(&self, cylinder: usize) -> BodyId {
        BodyId((self.robots.len() + cylinder) as u16)
    }

    /// Gets the body of an area. Call this only after all robots and cylinders are added, since their bodies come
    /// first.
    pub fn area(&self, area: usize) -> BodyId {
        BodyId((self.robots.len() + self.cylinders.len() + area) as u16)
    }
}
