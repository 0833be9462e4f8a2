//! Arena, and the bodies that names refer to.

use farsa_body::ports::BodyId;
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_lab::Error;
use farsa_physics::arena::{Area, Arena, CollisionRule, Cylinder, Wall};

use crate::check::source::Source;
use crate::document::{Collisions, Document, Engine, Object, Robot, Shape};
use crate::part;
use crate::part::definition::Maker;
use crate::parts::constant_fitness::pulls;
use crate::parts::groups::Groups;

/// A named thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Thing {
    /// A cylinder with its radius [m].
    Cylinder { body: BodyId, radius: f64 },
    /// A robot with its radius [m].
    Robot { body: BodyId, radius: f64 },
    /// A disc or rectangle of the ground.
    Area(part::Area),
    /// A block with half the diagonal of its base [m].
    Block { body: BodyId, reach: f64 },
    /// A wall, which has no body.
    Wall,
}

impl Thing {
    /// Gets the body and the hull's radius [m] of a round obstacle.
    pub(crate) fn solid(self) -> Option<(BodyId, f64)> {
        if let Self::Cylinder { body, radius } | Self::Robot { body, radius } = self {
            Some((body, radius))
        } else {
            None
        }
    }

    /// Returns true for obstacles.
    pub(crate) fn is_solid(self) -> bool {
        matches!(self, Self::Cylinder { .. } | Self::Robot { .. } | Self::Block { .. })
    }

    /// Gets the body.
    pub(crate) fn body(self) -> Option<BodyId> {
        match self {
            Self::Cylinder { body, .. }
            | Self::Robot { body, .. }
            | Self::Area(part::Area { body, .. })
            | Self::Block { body, .. } => Some(body),
            Self::Wall => None,
        }
    }

    /// Computes the least distance of the center from a wall without contact [m].
    pub(crate) fn reach(self) -> f64 {
        match self {
            Self::Cylinder { radius, .. } | Self::Robot { radius, .. } => radius,
            Self::Block { reach, .. } => reach,
            Self::Area(part::Area { half, .. }) => half[0].max(half[1]),
            Self::Wall => 0.0,
        }
    }
}

/// Arena of a document.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) arena: Arena,
    /// Every robot.
    pub(crate) robots: Vec<MobileRobot>,
    pub(crate) groups: Groups,
    pub(crate) size: [f64; 2],
    pub(crate) blocks: Vec<Block>,
    things: Vec<(String, Thing)>,
    /// Number of things that are not robots.
    standing: usize,
    /// True with the section `foraging`.
    pub(crate) has_food: bool,
    /// True for robots that can hold something.
    pub(crate) pulls: bool,
}

/// A movable box.
#[cfg_attr(not(feature = "rapier"), allow(dead_code))]
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Initial center [m] and direction of the length [rad].
    pub(crate) centre: [f64; 2],
    pub(crate) heading: f64,
    /// Length, breadth and height [m].
    pub(crate) size: [f64; 3],
    /// [kg]
    pub(crate) mass: f64,
    pub(crate) friction: f64,
    pub(crate) color: [f64; 3],
}

/// Distance from the arena, and between things, before a trial places them [m].
const GAP: f64 = 1.0;

impl Scene {
    /// Builds the arena with its robots and things.
    pub(crate) fn new(document: &Document, source: &Source) -> Result<Self, Error> {
        let world = &document.world;
        if world.engine == Engine::Articulated {
            let why = "`articulated` is for robots with joints; this one is on wheels, for `arena` and `rapier`";
            return Err(source.wrong("/world/engine", why));
        }
        let (robots, groups) = robots(document, source)?;
        let [width, depth] = world.size;
        let arena = if world.walls { Arena::walled(width, depth) } else { Arena::new() };
        // Without bounds, because things wait outside before they are placed.
        let mut arena = Arena { time_step: world.time_step, ground: world.ground, size: None, ..arena };
        if world.collisions == Some(Collisions::Circles) {
            arena.collisions = CollisionRule::Circles;
        }
        let widest = robots.iter().fold(0.0_f64, |most, robot| most.max(robot.radius));
        // Robots in a row next to the arena, with more than a meter between their hulls.
        let apart = GAP + 3.0 * widest;
        for (number, robot) in robots.iter().enumerate() {
            arena.add_robot(robot.clone(), [width + GAP + apart * number as f64, 0.0], 0.0);
        }
        let mut x = width + GAP + apart * robots.len().saturating_sub(1) as f64;
        let mut last_reach = 0.0;
        let (mut built, mut blocks) = (Vec::new(), Vec::new());
        for (index, object) in document.objects.iter().enumerate() {
            let path = format!("/objects/{index}/name");
            let of_robots = object.name.starts_with(ROBOT) || groups.named(&object.name).is_some();
            if of_robots || built.iter().any(|(name, _)| *name == object.name) {
                return Err(source.wrong(&path, format!("`{}` names something else already", object.name)));
            }
            let reach = match &object.shape {
                Some(Shape::Cylinder { radius, .. } | Shape::Disc { radius, .. }) => *radius,
                Some(Shape::Wall { size, .. } | Shape::Rectangle { size, .. }) => size[0].max(size[1]),
                Some(Shape::Block { size, .. }) => size[0].max(size[1]),
                Some(Shape::Ball { .. } | Shape::Marker { .. }) | None => {
                    let why = "is for robots with joints; next to one on wheels are cylinders, discs and rectangles";
                    return Err(source.wrong(&format!("/objects/{index}"), why));
                }
            };
            let at = object.at.as_deref().map(|at| flat(at, &format!("/objects/{index}/at"), source));
            let at = at.transpose()?;
            if let Some(at) = at.filter(|_| !object.shines()) {
                within_walls(document, at, &format!("/objects/{index}/at"), source)?;
            }
            if object.at.is_none() && matches!(object.shape, Some(Shape::Wall { .. })) {
                return Err(source.wrong(&format!("/objects/{index}"), "lacks the key `at`: no trial places walls"));
            }
            if matches!(object.shape, Some(Shape::Block { .. })) && world.engine == Engine::Arena {
                let why = "is a block, which nothing pushes in the engine `arena`; `rapier` is the one for it";
                return Err(source.wrong(&format!("/objects/{index}"), why));
            }
            if at.is_some() && object.count.is_some() {
                return Err(source.wrong(&format!("/objects/{index}/count"), "is for things that a trial places"));
            }
            for _ in 0..object.count.unwrap_or(1) {
                // In rapier the order of contacts, and so the last bits, depend on these first places.
                x += (GAP + 2.0 * reach).max(last_reach + reach);
                last_reach = reach;
                built.push((object.name.clone(), add(&mut arena, &mut blocks, object, at.unwrap_or([x, 0.0]))));
            }
        }
        // Bodies are numbered after the last one is added.
        let [mut cylinders, mut areas, mut pushed] = [0; 3];
        let things = built.into_iter().map(|(name, thing)| {
            let thing = match thing {
                Thing::Cylinder { radius, .. } => {
                    cylinders += 1;
                    Thing::Cylinder { body: arena.cylinder(cylinders - 1), radius }
                }
                Thing::Area(area) => {
                    areas += 1;
                    Thing::Area(part::Area { body: arena.area(areas - 1), ..area })
                }
                Thing::Block { reach, .. } => {
                    pushed += 1;
                    let bodies = arena.robots.len() + arena.cylinders.len() + arena.areas.len();
                    Thing::Block { body: BodyId((bodies + pushed - 1) as u16), reach }
                }
                // Robots are added below.
                Thing::Wall | Thing::Robot { .. } => Thing::Wall,
            };
            (name, thing)
        });
        let mut things: Vec<(String, Thing)> = things.collect();
        let standing = things.len();
        for (number, robot) in robots.iter().enumerate() {
            let thing = Thing::Robot { body: arena.parts(number).body, radius: robot.radius };
            things.push((format!("{ROBOT}-{}", number + 1), thing));
            let group = groups.of(number);
            // A group of one robot is a thing by the name of the group, too.
            if groups.named(group) == Some([number, number + 1]) && group != ROBOT {
                things.push((group.to_owned(), thing));
            }
        }
        let has_food = document.foraging.is_some();
        let pulls = pulls(document, &source.registry);
        Ok(Self { robots, groups, size: world.size, things, standing, arena, blocks, has_food, pulls })
    }

    /// Returns the thing of a name at a path of the document.
    pub(crate) fn thing(&self, name: &str, path: &str, source: &Source) -> Result<Thing, Error> {
        match self.things(name, path, source)?[..] {
            [thing] => Ok(thing),
            _ => Err(source.wrong(path, format!("`{name}` names several things"))),
        }
    }

    /// Returns all things of a name at a path of the document, at least one.
    ///
    /// # Errors
    /// [`Error::Setting`] with the nearest name.
    pub(crate) fn things(&self, name: &str, path: &str, source: &Source) -> Result<Vec<Thing>, Error> {
        let of_name = self.things.iter().filter(|(known, _)| known == name);
        let things: Vec<Thing> = of_name.map(|(_, thing)| *thing).collect();
        if !things.is_empty() {
            return Ok(things);
        }
        // A robot alone is not offered as a thing for its measures.
        let named = if self.robots.len() > 1 { self.things.len() } else { self.standing };
        let names = self.things[..named].iter().map(|(name, _)| name.as_str());
        Err(Error::unknown(&source.of(path), "object", name, names))
    }

    /// Returns the robots of a group or a single one such as `robot-2`, from the first up to the one after the last.
    pub(crate) fn robots_named(&self, name: &str, path: &str, source: &Source) -> Result<[usize; 2], Error> {
        let robots = self.robots.len();
        let number = name.strip_prefix("robot-").and_then(|number| number.parse::<usize>().ok());
        let single = number.filter(|number| (1..=robots).contains(number)).map(|number| [number - 1, number]);
        single.map_or_else(|| self.groups.find(name, path, source), Ok)
    }

    /// Returns the body of a named thing.
    pub(crate) fn body(&self, name: &str, path: &str, source: &Source) -> Result<BodyId, Error> {
        let body = self.thing(name, path, source)?.body();
        body.ok_or_else(|| source.wrong(path, format!("`{name}` is a wall, which has no middle to be measured")))
    }

    /// Returns the name of a body.
    pub(crate) fn name_of(&self, body: BodyId) -> Option<&str> {
        if self.robots.len() == 1 && body == self.parts(0).body {
            return Some(ROBOT);
        }
        self.things.iter().find(|(_, thing)| thing.body() == Some(body)).map(|(name, _)| name.as_str())
    }

    /// Iterates over the blocks with their length and breadth [m].
    pub(crate) fn movable(&self) -> impl Iterator<Item = (BodyId, [f64; 2])> + '_ {
        let first = self.robots.len() + self.arena.cylinders.len() + self.arena.areas.len();
        self.blocks.iter().enumerate().map(move |(number, block)| {
            let [length, breadth, _] = block.size;
            (BodyId((first + number) as u16), [length, breadth])
        })
    }

    /// Returns the handles of a robot's parts.
    pub(crate) fn parts(&self, robot: usize) -> MobileParts {
        self.arena.parts(robot)
    }

    /// Iterates over the cylinders and blocks with a fixed initial place.
    pub(crate) fn standing<'s>(&'s self, document: &'s Document) -> impl Iterator<Item = (BodyId, f64)> + 's {
        let is_placed = |name: &str| document.objects.iter().any(|object| object.name == name && object.at.is_some());
        let placed = self.things[..self.standing].iter().filter(move |(name, _)| is_placed(name));
        placed.filter(|(_, thing)| thing.is_solid()).filter_map(|(_, thing)| Some((thing.body()?, thing.reach())))
    }

    /// Number of bodies.
    pub(crate) fn bodies(&self) -> u16 {
        (self.robots.len() + self.arena.cylinders.len() + self.arena.areas.len() + self.blocks.len()) as u16
    }
}

/// Name of all robots.
pub(crate) const ROBOT: &str = "robot";

fn add(arena: &mut Arena, blocks: &mut Vec<Block>, object: &Object, at: [f64; 2]) -> Thing {
    let (heading, body) = (object.heading.to_radians(), BodyId(0));
    match object.shape {
        Some(Shape::Cylinder { radius, height, color, lamp }) => {
            arena.add_cylinder(Cylinder { centre: at, radius, height, color, lamp });
            Thing::Cylinder { body, radius }
        }
        Some(Shape::Wall { size, height, color }) => {
            arena.add_wall(Wall { height, color, ..Wall::cuboid(at, size, heading) });
            Thing::Wall
        }
        Some(Shape::Block { size, mass, friction, color }) => {
            blocks.push(Block { centre: at, heading, size, mass, friction, color });
            // Half the diagonal is the greatest distance from the center at any heading.
            Thing::Block { body, reach: 0.5 * farsa_num::Scalar::sqrt(size[0] * size[0] + size[1] * size[1]) }
        }
        // Rejected by `Scene::new`.
        Some(Shape::Ball { .. } | Shape::Marker { .. }) | None => Thing::Wall,
        Some(Shape::Disc { radius, color }) => {
            arena.add_area(Area { heading, ..Area::circle(at, radius, color) });
            Thing::Area(part::Area { body, half: [radius; 2], disc: true })
        }
        Some(Shape::Rectangle { size, color }) => {
            arena.add_area(Area::rectangle(at, size, heading, color));
            Thing::Area(part::Area { body, half: size.map(|x| 0.5 * x), disc: false })
        }
    }
}

/// Reads a point of the plane.
pub(crate) fn flat(at: &[f64], path: &str, source: &Source) -> Result<[f64; 2], Error> {
    let why = || format!("has {} values where 2 are wanted: robots on wheels have a plane", at.len());
    at.try_into().map_err(|_| source.wrong(path, why()))
}

/// Rejects a place beyond the walls, if there are any.
pub(crate) fn within_walls(document: &Document, at: [f64; 2], path: &str, source: &Source) -> Result<(), Error> {
    let (world, [x, y]) = (&document.world, at);
    let [width, depth] = world.size;
    if !world.walls || (0.0..=width).contains(&x) && (0.0..=depth).contains(&y) {
        return Ok(());
    }
    let why = format!("[{x}, {y}] is outside the walls, which enclose 0 to {width} m and 0 to {depth} m");
    Err(source.wrong(path, why))
}

/// Builds the robots of a document, and their groups.
fn robots(document: &Document, source: &Source) -> Result<(Vec<MobileRobot>, Groups), Error> {
    let alone = document.robot.iter().map(|robot| (ROBOT.to_owned(), None, robot, "/robot".to_owned()));
    let grouped = document.robots.iter().enumerate();
    let grouped =
        grouped.map(|(index, group)| (group.name.clone(), group.color, &group.robot, format!("/robots/{index}")));
    let groups: Vec<_> = alone.chain(grouped).collect();
    match (&document.robot, document.robots.is_empty()) {
        (None, true) => return Err(source.wrong("", "lacks the key `robot`, or `robots` for groups of them")),
        (Some(_), false) => return Err(source.wrong("/robots", "go not with `robot`: one of them")),
        (Some(_), true) if document.team.coevolution => {
            return Err(source.wrong("/team/coevolution", "is for groups of `robots`; `robot` is one group"));
        }
        _ => {}
    }
    let mut robots = Vec::new();
    for (number, (name, color, robot, path)) in groups.iter().enumerate() {
        let Robot { file, floating, base, kind, .. } = robot;
        let joints = kind.joints;
        let given = [("kind", joints), ("file", file.is_some()), ("floating", *floating), ("base", *base != [0.0; 3])];
        if let Some((key, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(source.wrong(&format!("{path}/{key}"), "is for robots with joints; this one is on wheels"));
        }
        let taken = groups[..number].iter().any(|(other, ..)| other == name);
        if taken || !document.robots.is_empty() && name.starts_with(ROBOT) {
            return Err(source.wrong(&format!("{path}/name"), format!("`{name}` names something else already")));
        }
        let mut made = mobile_robot(robot, source);
        made.color = color.unwrap_or(made.color);
        if !document.robots.is_empty() {
            made.name.clone_from(name);
        }
        let count = robots.len().saturating_add(robot.count as usize);
        let most = source.limits.robots;
        if count > most {
            let why = format!("and those before it are {count} robots; at most {most} in all");
            return Err(source.wrong(path, why));
        }
        robots.resize(count, made);
    }
    let groups = Groups::new(
        groups.into_iter().map(|(name, _, robot, _)| (name, robot.count as usize)),
        document.team.coevolution,
    );
    Ok((robots, groups))
}

/// Builds a named robot with the changes of the document.
fn mobile_robot(robot: &Robot, source: &Source) -> MobileRobot {
    // `check` has rejected robots with joints.
    let mut mobile = match source.registry.robot(&robot.kind) {
        Some(Maker::Wheels(mobile)) => (**mobile).clone(),
        _ => MobileRobot::khepera(),
    };
    mobile.radius = robot.radius.unwrap_or(mobile.radius);
    mobile.infrared.range = robot.infrared_range.unwrap_or(mobile.infrared.range);
    // From m/s to rad/s, v / r.
    mobile.max_wheel_speed = robot.speed.map_or(mobile.max_wheel_speed, |speed| speed / mobile.wheel_radius);
    mobile
}

/// Rejects named bodies and points, because a robot on wheels is one body.
pub(crate) fn one_body(
    body: Option<&String>,
    bodies: &[String],
    point: &[f64; 3],
    path: &str,
    source: &Source,
) -> Result<(), Error> {
    if body.is_none() && bodies.is_empty() && *point == [0.0; 3] {
        return Ok(());
    }
    Err(source
        .wrong(path, "names a body or point; a robot on wheels is one body, and only robots with joints have more"))
}
