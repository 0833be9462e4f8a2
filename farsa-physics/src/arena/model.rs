//! The constant part of a planar world: checked, and every number rounded once.

use alloc::vec::Vec;

use farsa_body::ports::{ActuatorId, BodyId, JointId};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::infrared::InfraredModel;
use farsa_num::{Scalar, atan2, sin_cos};

use crate::arena::convex::{Convex, ConvexForm};
use crate::arena::description::{AreaShape, Arena, CollisionRule, Search};
use crate::arena::error::{ArenaError, ConvexFault, Part};
use crate::arena::outline::{check_turns, distance, width};
use crate::arena::slab::Slab;
use crate::arena::solid::{Face, Solid, middle, prism_faces};

/// Words of a body's pose: x, y, heading and its cosine and sine.
pub(crate) const POSE_WORDS: usize = 5;
/// Words of a robot after its pose. See [`VELOCITY`] and the following constants.
pub(crate) const ROBOT_WORDS: usize = 18;
/// More bodies than these are looked for in a grid.
const MANY: usize = 32;

/// The constants of a kind of robot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Kind {
    pub(crate) robot: MobileRobot,
    pub(crate) radius: f32,
    pub(crate) height: f32,
    pub(crate) color: [f32; 3],
    pub(crate) max_wheel_speed: f32,
    /// Half the turn in a step for a difference of the wheels' speeds [s].
    pub(crate) half_turn: f32,
    /// The way in a step for a sum of the wheels' speeds [m s].
    pub(crate) advance: f32,
    /// Velocity for a sum of the wheels' speeds [m], angular velocity for their difference.
    pub(crate) speeds: [f32; 2],
    /// Where the infrared sensors look, in the robot's frame.
    pub(crate) infrared: Vec<[f32; 2]>,
    /// Its response in infrared sensors.
    pub(crate) seen: InfraredModel,
}

/// A cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Round {
    pub(crate) radius: f32,
    pub(crate) height: f32,
    pub(crate) color: [f32; 3],
    pub(crate) lamp: f32,
    pub(crate) seen: InfraredModel,
}

/// An area.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    /// Half its sides. The radius of a disc, twice.
    pub(crate) half: [f32; 2],
    pub(crate) disc: bool,
    pub(crate) color: [f32; 3],
}

#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) kinds: Vec<Kind>,
    /// Kind and first actuator of each robot.
    pub(crate) robots: Vec<(u16, u16)>,
    pub(crate) slabs: Vec<Slab>,
    pub(crate) solids: Vec<Solid>,
    pub(crate) rounds: Vec<Round>,
    pub(crate) patches: Vec<Patch>,
    pub(crate) ground: [f32; 3],
    pub(crate) time_step: f32,
    pub(crate) collisions: CollisionRule,
    pub(crate) actuators: usize,
    /// True if any robot has an attachment device.
    pub(crate) attachments: bool,
    pub(crate) grid: bool,
    /// The response of a wall in infrared sensors.
    pub(crate) wall_seen: InfraredModel,
    /// The largest radius of a robot or cylinder [m].
    pub(crate) largest: f32,
    /// The longest way of a robot in a step [m].
    pub(crate) travel: f32,
    pub(crate) initial: Vec<f32>,
}

fn narrow<const N: usize>(x: [f64; N]) -> [f32; N] {
    x.map(|x| x as f32)
}

fn ranged(part: Part, what: &'static str, value: f64, range: [f64; 2]) -> Result<(), ArenaError> {
    if (range[0]..=range[1]).contains(&value) { Ok(()) } else { Err(ArenaError::Range { part, what, value, range }) }
}

/// Lengths from a thousandth of a millimeter to a hundred kilometers: their squares are normal numbers in `f32`.
const LENGTHS: [f64; 2] = [1e-6, 1e5];

fn colored(part: Part, color: [f64; 3]) -> Result<(), ArenaError> {
    color.into_iter().try_for_each(|x| ranged(part, "colour", x, [0.0, 1.0]))
}

fn placed(part: Part, at: [f64; 2], heading: f64) -> Result<(), ArenaError> {
    at.into_iter().try_for_each(|x| ranged(part, "place", x, [-LENGTHS[1], LENGTHS[1]]))?;
    ranged(part, "heading", heading, [-1e4, 1e4])
}

fn counted(what: &'static str, count: usize, range: [usize; 2]) -> Result<(), ArenaError> {
    if (range[0]..=range[1]).contains(&count) { Ok(()) } else { Err(ArenaError::Count { what, count, range }) }
}

/// Ends of the motion that a robot's numbers allow.
fn check_robot(index: usize, robot: &MobileRobot, time_step: f64) -> Result<(), ArenaError> {
    let part = Part::Robot(index);
    let lengths = [
        ("radius", robot.radius),
        ("height", robot.height),
        ("wheel radius", robot.wheel_radius),
        ("track", robot.track),
    ];
    lengths.into_iter().try_for_each(|(what, x)| ranged(part, what, x, LENGTHS))?;
    ranged(part, "greatest wheel speed", robot.max_wheel_speed, [0.0, 1e6])?;
    colored(part, robot.color)?;
    robot
        .attachment
        .map_or(Ok(()), |reach| ranged(part, "reach of the attachment device", reach, [0.0, LENGTHS[1]]))?;
    robot.infrared.angles.iter().try_for_each(|x| ranged(part, "angle of an infrared sensor", *x, [-1e4, 1e4]))?;
    let travel = robot.wheel_radius * robot.max_wheel_speed * time_step;
    if travel > robot.radius {
        return Err(ArenaError::StepTooLong { robot: index, travel, radius: robot.radius });
    }
    ranged(part, "turn in a step", 2.0 * travel / robot.track, [0.0, 1e3])
}

fn kind(robot: &MobileRobot, time_step: f64) -> Kind {
    let wheel = robot.wheel_radius;
    Kind {
        radius: robot.radius as f32,
        height: robot.height as f32,
        color: narrow(robot.color),
        max_wheel_speed: robot.max_wheel_speed as f32,
        half_turn: (0.5 * wheel / robot.track * time_step) as f32,
        advance: (0.5 * wheel * time_step) as f32,
        speeds: narrow([0.5 * wheel, wheel / robot.track]),
        infrared: robot.infrared.angles.iter().map(|angle| direction(*angle)).collect(),
        seen: InfraredModel::for_radius(robot.radius as f32),
        robot: robot.clone(),
    }
}

fn direction(heading: f64) -> [f32; 2] {
    let (sine, cosine) = sin_cos(heading);
    narrow([cosine, sine])
}

/// The words of a pose: the heading brought into [-pi, pi].
pub(crate) fn pose_words(at: [f32; 2], heading: f32) -> [f32; POSE_WORDS] {
    let (sine, cosine) = sin_cos(f64::from(heading));
    let heading = if heading.abs() > core::f32::consts::PI { atan2(sine, cosine) as f32 } else { heading };
    let (sine, cosine) = sin_cos(heading);
    [at[0], at[1], heading, cosine, sine]
}

/// The least and greatest number of points of a convex obstacle, in the plane and in space.
const POINTS: [[f64; 2]; 2] = [[3.0, 1024.0], [4.0, 1024.0]];

/// A convex obstacle, checked.
fn solid(part: Part, convex: &Convex) -> Result<Solid, ArenaError> {
    colored(part, convex.color)?;
    let farthest = [-LENGTHS[1], LENGTHS[1]];
    match &convex.form {
        ConvexForm::Prism { corners, height } => {
            ranged(part, "number of corners", corners.len() as f64, POINTS[0])?;
            corners.iter().flatten().try_for_each(|x| ranged(part, "corner", *x, farthest))?;
            ranged(part, "height", *height, LENGTHS)?;
        }
        ConvexForm::Hull { points } => {
            ranged(part, "number of points", points.len() as f64, POINTS[1])?;
            points.iter().flatten().try_for_each(|x| ranged(part, "point", *x, farthest))?;
            points.iter().try_for_each(|[.., z]| ranged(part, "height of a point", *z, [0.0, LENGTHS[1]]))?;
        }
    }
    let outline = convex.outline();
    ranged(part, "width", width(&outline), LENGTHS)?;
    if let ConvexForm::Prism { corners, .. } = &convex.form {
        check_turns(part, corners, &outline)?;
    }
    let (centre, around) = middle(&outline);
    let outline: Vec<[f64; 2]> = outline.iter().map(|[x, y]| [x - centre[0], y - centre[1]]).collect();
    let faces = match &convex.form {
        ConvexForm::Prism { height, .. } => prism_faces(&outline, *height),
        ConvexForm::Hull { points } => {
            let points: Vec<[f64; 3]> = points.iter().map(|[x, y, z]| [x - centre[0], y - centre[1], *z]).collect();
            hull_faces(part, &points)?
        }
    };
    Ok(Solid::new(&outline, centre, around, faces, convex.color))
}

#[cfg(feature = "parry")]
fn hull_faces(part: Part, points: &[[f64; 3]]) -> Result<Vec<Face>, ArenaError> {
    use crate::arena::facets::{Flaw, faces};
    faces(points).map_err(|flaw| match flaw {
        Flaw::Thin(value) => ArenaError::Range { part, what: "thickness", value, range: LENGTHS },
        Flaw::Open => ArenaError::Convex { part, fault: ConvexFault::NoHull { points: points.len() } },
    })
}

#[cfg(not(feature = "parry"))]
fn hull_faces(part: Part, _: &[[f64; 3]]) -> Result<Vec<Face>, ArenaError> {
    Err(ArenaError::Convex { part, fault: ConvexFault::NeedsFeature { feature: "parry" } })
}

/// A disc where something starts.
struct Disc {
    part: Part,
    at: [f64; 2],
    radius: f64,
}

fn check_overlaps(arena: &Arena, discs: &mut [Disc]) -> Result<(), ArenaError> {
    for disc in discs.iter() {
        for (i, wall) in arena.walls.iter().enumerate() {
            let (sine, cosine) = sin_cos(wall.heading);
            let [x, y] = [disc.at[0] - wall.centre[0], disc.at[1] - wall.centre[1]];
            let beyond = |along: f64, size: f64| Scalar::max(along.abs() - 0.5 * size, 0.0);
            let [u, v] = [beyond(x * cosine + y * sine, wall.size[0]), beyond(y * cosine - x * sine, wall.size[1])];
            let depth = disc.radius - Scalar::sqrt(u * u + v * v);
            if depth > SLACK {
                return Err(ArenaError::Overlap { parts: [disc.part, Part::Wall(i)], depth });
            }
        }
    }
    for (i, convex) in arena.convexes.iter().enumerate() {
        let outline = convex.outline();
        for disc in discs.iter() {
            let depth = disc.radius - distance(&outline, disc.at);
            if depth > SLACK {
                return Err(ArenaError::Overlap { parts: [disc.part, Part::Convex(i)], depth });
            }
        }
    }
    // Along x, so that only neighbors need be compared.
    let largest = discs.iter().fold(0.0, |most: f64, disc| Scalar::max(most, disc.radius));
    discs.sort_by(|a, b| a.at[0].total_cmp(&b.at[0]));
    for (i, a) in discs.iter().enumerate() {
        for b in discs[i + 1..].iter().take_while(|b| b.at[0] - a.at[0] < a.radius + largest) {
            let [x, y] = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
            let depth = a.radius + b.radius - Scalar::sqrt(x * x + y * y);
            if depth > SLACK {
                return Err(ArenaError::Overlap { parts: [a.part, b.part], depth });
            }
        }
    }
    Ok(())
}

/// The overlap of touching parts from rounding [m].
const SLACK: f64 = 1e-9;

impl Model {
    pub(crate) fn new(arena: &Arena) -> Result<Self, ArenaError> {
        let [robots, cylinders, areas] = [arena.robots.len(), arena.cylinders.len(), arena.areas.len()];
        let ids = usize::from(u16::MAX) + 1;
        let actuators = arena.robots.iter().map(|placed| placed.robot.actuators()).sum();
        counted("robots", robots, [1, ids / 2])?;
        counted("robots, cylinders and areas", robots + cylinders + areas, [0, ids])?;
        counted("actuators of robots", actuators, [0, ids])?;
        ranged(Part::Arena, "time step", arena.time_step, [1e-6, 1e3])?;
        colored(Part::Arena, arena.ground)?;
        if let Some(size) = arena.size {
            size.into_iter().try_for_each(|x| ranged(Part::Arena, "size", x, LENGTHS))?;
        }
        for (i, wall) in arena.walls.iter().enumerate() {
            let part = Part::Wall(i);
            placed(part, wall.centre, wall.heading)?;
            wall.size.into_iter().try_for_each(|x| ranged(part, "size", x, LENGTHS))?;
            ranged(part, "height", wall.height, LENGTHS)?;
            colored(part, wall.color)?;
        }
        let solids = arena.convexes.iter().enumerate();
        let solids = solids.map(|(i, convex)| solid(Part::Convex(i), convex)).collect::<Result<Vec<_>, _>>()?;
        for (i, cylinder) in arena.cylinders.iter().enumerate() {
            let part = Part::Cylinder(i);
            placed(part, cylinder.centre, 0.0)?;
            ranged(part, "radius", cylinder.radius, LENGTHS)?;
            ranged(part, "height", cylinder.height, LENGTHS)?;
            ranged(part, "lamp", cylinder.lamp, [0.0, 1e9])?;
            colored(part, cylinder.color)?;
        }
        for (i, area) in arena.areas.iter().enumerate() {
            let part = Part::Area(i);
            placed(part, area.centre, area.heading)?;
            match area.shape {
                AreaShape::Circle { radius } => ranged(part, "radius", radius, LENGTHS)?,
                AreaShape::Rectangle { size } => size.into_iter().try_for_each(|x| ranged(part, "size", x, LENGTHS))?,
            }
            colored(part, area.color)?;
        }
        let mut kinds: Vec<Kind> = Vec::new();
        let (mut numbers, mut first) = (Vec::with_capacity(robots), 0);
        for (i, start) in arena.robots.iter().enumerate() {
            placed(Part::Robot(i), start.at, start.heading)?;
            let known = kinds.iter().position(|kind| kind.robot == start.robot);
            let number = if let Some(number) = known {
                number
            } else {
                check_robot(i, &start.robot, arena.time_step)?;
                kinds.push(kind(&start.robot, arena.time_step));
                kinds.len() - 1
            };
            numbers.push((number as u16, first as u16));
            first += start.robot.actuators();
        }
        Self::check_places(arena)?;
        let mut model = Self::from_parts(arena, kinds, numbers, solids);
        model.actuators = actuators;
        model.initial = model.start(arena);
        Ok(model)
    }

    fn check_places(arena: &Arena) -> Result<(), ArenaError> {
        let robots = arena.robots.iter().enumerate().map(|(i, start)| Disc {
            part: Part::Robot(i),
            at: start.at,
            radius: start.robot.radius,
        });
        let cylinders = arena.cylinders.iter().enumerate().map(|(i, cylinder)| Disc {
            part: Part::Cylinder(i),
            at: cylinder.centre,
            radius: cylinder.radius,
        });
        let mut discs: Vec<Disc> = robots.chain(cylinders).collect();
        if let Some(size) = arena.size {
            let areas = arena.areas.iter().enumerate().map(|(i, area)| (Part::Area(i), area.centre, 0.0));
            let convexes = arena.convexes.iter().enumerate();
            let corners =
                convexes.flat_map(|(i, convex)| convex.outline().into_iter().map(move |at| (Part::Convex(i), at, 0.0)));
            let discs = discs.iter().map(|disc| (disc.part, disc.at, disc.radius));
            for (part, at, radius) in discs.chain(areas).chain(corners) {
                let within = |x: f64, size: f64| x - radius >= -SLACK && x + radius <= size + SLACK;
                if !(within(at[0], size[0]) && within(at[1], size[1])) {
                    return Err(ArenaError::Outside { part, at, radius, size });
                }
            }
        }
        check_overlaps(arena, &mut discs)
    }

    fn from_parts(arena: &Arena, kinds: Vec<Kind>, robots: Vec<(u16, u16)>, solids: Vec<Solid>) -> Self {
        let rounds = arena.cylinders.iter().map(|cylinder| Round {
            radius: cylinder.radius as f32,
            height: cylinder.height as f32,
            color: narrow(cylinder.color),
            lamp: cylinder.lamp as f32,
            seen: InfraredModel::for_radius(cylinder.radius as f32),
        });
        let patches = arena.areas.iter().map(|area| {
            let (half, disc) = match area.shape {
                AreaShape::Circle { radius } => ([radius; 2], true),
                AreaShape::Rectangle { size } => (size.map(|x| 0.5 * x), false),
            };
            Patch { half: narrow(half), disc, color: narrow(area.color) }
        });
        let radii = kinds.iter().map(|kind| kind.radius).chain(arena.cylinders.iter().map(|c| c.radius as f32));
        let travels = kinds.iter().map(|kind| 2.0 * kind.advance * kind.max_wheel_speed);
        let bodies = robots.len() + arena.cylinders.len();
        Self {
            largest: radii.fold(0.0, Scalar::max),
            travel: travels.fold(0.0, Scalar::max),
            attachments: kinds.iter().any(|kind| kind.robot.attachment.is_some()),
            slabs: arena.walls.iter().map(Slab::from_wall).collect(),
            solids,
            rounds: rounds.collect(),
            patches: patches.collect(),
            ground: narrow(arena.ground),
            time_step: arena.time_step as f32,
            collisions: arena.collisions,
            grid: match arena.search {
                Search::Auto => bodies > MANY,
                Search::All => false,
                Search::Grid => true,
            },
            wall_seen: InfraredModel::for_radius(0.0),
            actuators: 0,
            initial: Vec::new(),
            kinds,
            robots,
        }
    }

    fn start(&self, arena: &Arena) -> Vec<f32> {
        let robots = arena.robots.iter().map(|start| (start.at, start.heading));
        let cylinders = arena.cylinders.iter().map(|cylinder| (cylinder.centre, 0.0));
        let areas = arena.areas.iter().map(|area| (area.centre, area.heading));
        let poses = robots.chain(cylinders).chain(areas);
        let mut words: Vec<f32> = poses.flat_map(|(at, heading)| pose_words(narrow(at), heading as f32)).collect();
        words.resize(self.len(), 0.0);
        for robot in 0..self.robots.len() {
            for word in [MET, HELD] {
                words[self.robot_word(robot, word)] = NOTHING;
            }
        }
        words
    }

    /// Number of words of a world.
    pub(crate) fn len(&self) -> usize {
        self.first_command() + self.actuators
    }

    /// Number of bodies.
    pub(crate) fn bodies(&self) -> usize {
        self.round_bodies() + self.patches.len()
    }

    /// Number of robots and cylinders.
    pub(crate) fn round_bodies(&self) -> usize {
        self.robots.len() + self.rounds.len()
    }

    /// Where the words of robots begin.
    pub(crate) fn first_robot_word(&self) -> usize {
        POSE_WORDS * self.bodies()
    }

    /// Where a word of a robot is.
    #[inline(always)]
    pub(crate) fn robot_word(&self, robot: usize, word: usize) -> usize {
        self.first_robot_word() + ROBOT_WORDS * robot + word
    }

    /// Where the words of commands begin.
    pub(crate) fn first_command(&self) -> usize {
        self.first_robot_word() + ROBOT_WORDS * self.robots.len()
    }

    /// Where the command of a robot's actuator is, by its number among the robot's.
    #[inline(always)]
    pub(crate) fn command(&self, robot: usize, actuator: usize) -> usize {
        self.first_command() + usize::from(self.robots[robot].1) + actuator
    }

    #[inline(always)]
    pub(crate) fn kind(&self, robot: usize) -> &Kind {
        &self.kinds[usize::from(self.robots[robot].0)]
    }

    /// Radius of a robot or cylinder.
    #[inline(always)]
    pub(crate) fn radius(&self, body: usize) -> f32 {
        match body.checked_sub(self.robots.len()) {
            None => self.kind(body).radius,
            Some(round) => self.rounds[round].radius,
        }
    }

    /// Returns the response of a robot or cylinder in infrared sensors.
    #[inline(always)]
    pub(crate) fn seen(&self, body: usize) -> &InfraredModel {
        match body.checked_sub(self.robots.len()) {
            None => &self.kind(body).seen,
            Some(round) => &self.rounds[round].seen,
        }
    }

    /// Height of a robot or cylinder.
    pub(crate) fn height(&self, body: usize) -> f32 {
        match body.checked_sub(self.robots.len()) {
            None => self.kind(body).height,
            Some(round) => self.rounds[round].height,
        }
    }

    /// Returns the numbers of a robot's parts, or those of the last robot for a number beyond it.
    pub(crate) fn parts(&self, robot: usize) -> MobileParts {
        let robot = robot.min(self.robots.len() - 1);
        let first = ActuatorId(self.robots[robot].1);
        self.kind(robot).robot.parts(BodyId(robot as u16), JointId(2 * robot as u16), first)
    }
}

/// Which word of a robot is what. Its first three are the velocity: x and y [m/s], about the vertical [rad/s].
pub(crate) const VELOCITY: usize = 0;
/// Positions [rad] and speeds [rad/s] of the wheels, left and right of each.
pub(crate) const WHEELS: usize = 3;
/// Depth of what was met [m] (0: nothing), the unit vector away from it, the point [m].
pub(crate) const CONTACT: usize = 7;
/// The body that was met, or [`NOTHING`].
pub(crate) const MET: usize = 12;
/// The robot that the attachment device holds, or [`NOTHING`].
pub(crate) const HELD: usize = 13;
/// Red, green and blue of the LEDs, then the signal.
pub(crate) const SHOWN: usize = 14;
/// No body. The body of the contact, here a wall.
pub(crate) const NOTHING: f32 = -1.0;
