//! The arena, and which of its bodies a name means.

use farsa_body::{BodyId, MobileParts, MobileRobot};
use farsa_lab::Error;
use farsa_physics::arena::{Area, Arena, Cylinder, Wall};

use crate::check::places::Places;
use crate::document::{Document, Object, ObjectKind, Robot, RobotKind};

/// A thing that a name means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Thing {
    /// A cylinder with its radius [m].
    Cylinder { body: BodyId, radius: f64 },
    /// An area with half its sides [m]; of a disc the radius, twice.
    Area { body: BodyId, half: [f64; 2], disc: bool },
    /// A wall, which is no body.
    Wall,
}

impl Thing {
    /// Its body and the radius of its hull [m], if it has one that is in the way.
    pub(crate) fn solid(self) -> Option<(BodyId, f64)> {
        if let Self::Cylinder { body, radius } = self { Some((body, radius)) } else { None }
    }

    /// Its body.
    pub(crate) fn body(self) -> Option<BodyId> {
        match self {
            Self::Cylinder { body, .. } | Self::Area { body, .. } => Some(body),
            Self::Wall => None,
        }
    }

    /// How far its middle keeps from walls if it is to touch none [m].
    pub(crate) fn reach(self) -> f64 {
        match self {
            Self::Cylinder { radius, .. } => radius,
            Self::Area { half, .. } => half[0].max(half[1]),
            Self::Wall => 0.0,
        }
    }
}

/// An arena made of a document.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) arena: Arena,
    pub(crate) robot: MobileRobot,
    pub(crate) robots: usize,
    pub(crate) size: [f64; 2],
    things: Vec<(String, Thing)>,
}

/// What is placed by every trial waits so far beyond the arena and from each other [m].
const BESIDE: f64 = 1.0;

impl Scene {
    /// The arena with its robots and things.
    ///
    /// # Errors
    /// [`Error::Setting`] for names that stand twice.
    pub(crate) fn new(document: &Document, places: &Places) -> Result<Self, Error> {
        let world = &document.world;
        let [width, depth] = world.size;
        let arena = if world.walls { Arena::walled(width, depth) } else { Arena::new() };
        // Without bounds for what waits outside.
        let mut arena = Arena { time_step: world.time_step, ground: world.ground, size: None, ..arena };
        let robot = mobile_robot(&document.robot);
        let robots = document.robot.count as usize;
        let apart = BESIDE + 3.0 * robot.radius;
        for number in 0..robots {
            arena.add_robot(robot.clone(), [width + apart * (number + 1) as f64, 0.0], 0.0);
        }
        let mut x = width + apart * (robots + 1) as f64;
        let mut built = Vec::new();
        for (index, object) in document.objects.iter().enumerate() {
            let path = format!("/objects/{index}/name");
            if object.name.starts_with(ROBOT) || built.iter().any(|(name, _)| *name == object.name) {
                return Err(places.wrong(&path, format!("`{}` names something else already", object.name)));
            }
            let reach = match &object.kind {
                ObjectKind::Cylinder { radius, .. } | ObjectKind::Disc { radius, .. } => *radius,
                ObjectKind::Wall { size, .. } | ObjectKind::Rectangle { size, .. } => size[0].max(size[1]),
            };
            x += BESIDE + reach;
            let at = object.at.unwrap_or([x, 0.0]);
            x += reach;
            if object.at.is_none() && matches!(object.kind, ObjectKind::Wall { .. }) {
                return Err(places.wrong(&format!("/objects/{index}"), "lacks the key `at`: no trial places walls"));
            }
            built.push((object.name.clone(), add(&mut arena, object, at)));
        }
        // Bodies are numbered when all are there.
        let [mut cylinders, mut areas] = [0, 0];
        let things = built.into_iter().map(|(name, thing)| {
            let thing = match thing {
                Thing::Cylinder { radius, .. } => {
                    cylinders += 1;
                    Thing::Cylinder { body: arena.cylinder(cylinders - 1), radius }
                }
                Thing::Area { half, disc, .. } => {
                    areas += 1;
                    Thing::Area { body: arena.area(areas - 1), half, disc }
                }
                Thing::Wall => Thing::Wall,
            };
            (name, thing)
        });
        let things = things.collect();
        Ok(Self { robot, robots, size: world.size, things, arena })
    }

    /// The thing of a name, which stands at a path of the document.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest name.
    pub(crate) fn thing(&self, name: &str, path: &str, places: &Places) -> Result<Thing, Error> {
        let found = self.things.iter().find(|(known, _)| known == name).map(|(_, thing)| *thing);
        let names = self.things.iter().map(|(name, _)| name.as_str());
        found.ok_or_else(|| Error::unknown(&places.of(path), "object", name, names))
    }

    /// The thing of a name that is a body, and its number.
    ///
    /// # Errors
    /// As [`thing`](Self::thing), and [`Error::Setting`] for a wall.
    pub(crate) fn body(&self, name: &str, path: &str, places: &Places) -> Result<BodyId, Error> {
        let body = self.thing(name, path, places)?.body();
        body.ok_or_else(|| places.wrong(path, format!("`{name}` is a wall, which has no middle to be measured")))
    }

    /// By which numbers the parts of a robot are known.
    pub(crate) fn parts(&self, robot: usize) -> MobileParts {
        self.arena.parts(robot)
    }

    /// The cylinders that stand somewhere from the beginning.
    pub(crate) fn standing<'s>(&'s self, document: &'s Document) -> impl Iterator<Item = (BodyId, f64)> + 's {
        let placed = document.objects.iter().zip(&self.things).filter(|(object, _)| object.at.is_some());
        placed.filter_map(|(_, (_, thing))| thing.solid())
    }

    /// Number of bodies.
    pub(crate) fn bodies(&self) -> u16 {
        (self.robots + self.arena.cylinders.len() + self.arena.areas.len()) as u16
    }
}

/// What the robots are called where things are named.
pub(crate) const ROBOT: &str = "robot";

fn add(arena: &mut Arena, object: &Object, at: [f64; 2]) -> Thing {
    let (heading, body) = (object.heading.to_radians(), BodyId(0));
    match object.kind {
        ObjectKind::Cylinder { radius, height, color, lamp } => {
            arena.add_cylinder(Cylinder { centre: at, radius, height, color, lamp });
            Thing::Cylinder { body, radius }
        }
        ObjectKind::Wall { size, height, color } => {
            arena.add_wall(Wall { height, color, ..Wall::cuboid(at, size, heading) });
            Thing::Wall
        }
        ObjectKind::Disc { radius, color } => {
            arena.add_area(Area { heading, ..Area::circle(at, radius, color) });
            Thing::Area { body, half: [radius; 2], disc: true }
        }
        ObjectKind::Rectangle { size, color } => {
            arena.add_area(Area::rectangle(at, size, heading, color));
            Thing::Area { body, half: size.map(|x| 0.5 * x), disc: false }
        }
    }
}

/// The named robot with what the document changes.
fn mobile_robot(robot: &Robot) -> MobileRobot {
    let mut own = match robot.kind {
        RobotKind::Khepera => MobileRobot::khepera(),
        RobotKind::EPuck => MobileRobot::e_puck(),
        RobotKind::Marxbot => MobileRobot::marxbot(),
    };
    own.radius = robot.radius.unwrap_or(own.radius);
    own.infrared.range = robot.infrared_range.unwrap_or(own.infrared.range);
    own.max_wheel_speed = robot.speed.map_or(own.max_wheel_speed, |speed| speed / own.wheel_radius);
    own
}
