//! Where a trial puts things.

use core::f32::consts::PI;

use farsa_body::{BodyId, Pose, Twist};
use farsa_lab::{Error, PlanarWorld};
use farsa_num::{Stream, sin_cos};
use farsa_physics::arena::{ArenaError, FreePlace};

use crate::check::places::Places;
use crate::document::{Document, Placing};
use crate::parts::scene::{ROBOT, Scene};

/// A rule of the start with what it is about.
#[derive(Clone, Debug)]
struct Rule {
    bodies: Vec<BodyId>,
    /// Of what is in the way [m].
    radius: f64,
    solid: bool,
    robots: bool,
    how: How,
}

#[derive(Clone, Debug)]
enum How {
    Anywhere { walls: f64, apart: f64 },
    Around { of: BodyId, distance: [f64; 2] },
    Fixed { point: [f64; 2], heading: f64 },
}

/// The start of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Starting {
    rules: Vec<Rule>,
    size: [f64; 2],
    /// What stands somewhere from the beginning.
    standing: Vec<BodyId>,
    /// What things placed later keep from, with the distance: room for all.
    others: Vec<(BodyId, f32)>,
}

impl Starting {
    /// The start that a document describes; robots that it does not name are placed last, anywhere.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a thing that there is not, [`Error::Setting`] for one that is placed twice or cannot be.
    pub(crate) fn new(document: &Document, scene: &Scene, places: &Places) -> Result<Self, Error> {
        let mut rules: Vec<Rule> = Vec::new();
        let robots: Vec<BodyId> = (0..scene.robots).map(|robot| scene.parts(robot).body).collect();
        let of_robots =
            |bodies: Vec<BodyId>, how| Rule { bodies, radius: scene.robot.radius, solid: true, robots: true, how };
        for (index, start) in document.start.iter().enumerate() {
            let path = format!("/start/{index}");
            let how = match &start.how {
                Placing::Anywhere { walls, apart } => How::Anywhere { walls: *walls, apart: *apart },
                Placing::Around { of, distance } => {
                    let of = scene.body(of, &format!("{path}/of"), places)?;
                    if distance[0] > distance[1] {
                        return Err(places.wrong(&format!("{path}/distance"), "runs backwards"));
                    }
                    How::Around { of, distance: *distance }
                }
                Placing::Fixed { point, heading } => How::Fixed { point: *point, heading: heading.to_radians() },
            };
            let rule = if start.place == ROBOT {
                if let (How::Fixed { .. }, true) = (&how, scene.robots > 1) {
                    return Err(places.wrong(&path, format!("puts {} robots on one point", scene.robots)));
                }
                of_robots(robots.clone(), how)
            } else if let Some(robot) = numbered(&start.place) {
                let found = robot.checked_sub(1).and_then(|robot| robots.get(robot));
                let why = || places.wrong(&format!("{path}/place"), format!("is robot {robot} of {}", robots.len()));
                of_robots(vec![*found.ok_or_else(why)?], how)
            } else {
                let path = format!("{path}/place");
                let thing = scene.thing(&start.place, &path, places)?;
                let body = scene.body(&start.place, &path, places)?;
                Rule { bodies: vec![body], radius: thing.reach(), solid: thing.solid().is_some(), robots: false, how }
            };
            if rules.iter().any(|other| other.bodies.iter().any(|body| rule.bodies.contains(body))) {
                return Err(places.wrong(&format!("{path}/place"), format!("`{}` is placed twice", start.place)));
            }
            rules.push(rule);
        }
        for (index, object) in document.objects.iter().enumerate() {
            let path = format!("/objects/{index}");
            let body = scene.body(&object.name, &path, places).ok().filter(|_| object.at.is_none());
            if body.is_some_and(|body| !rules.iter().any(|rule| rule.bodies.contains(&body))) {
                return Err(places.wrong(&path, "lacks the key `at`, and no `[[start]]` places it"));
            }
        }
        let placed = |body: &BodyId| rules.iter().any(|rule| rule.bodies.contains(body));
        let others: Vec<BodyId> = robots.iter().copied().filter(|body| !placed(body)).collect();
        if !others.is_empty() {
            rules.push(of_robots(others, How::Anywhere { walls: 0.0, apart: 0.0 }));
        }
        let moved = |body: &BodyId| rules.iter().any(|rule| rule.bodies.contains(body));
        let standing: Vec<BodyId> =
            scene.standing(document).map(|(body, _)| body).filter(|body| !moved(body)).collect();
        let most = standing.len() + rules.iter().map(|rule| rule.bodies.len()).sum::<usize>();
        Ok(Self { rules, size: scene.size, standing, others: Vec::with_capacity(most) })
    }

    /// Puts all in its place, by draws of the stream in the order of the rules.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries.
    pub(crate) fn arrange<W: PlanarWorld>(&mut self, world: &mut W, stream: &mut Stream) -> Result<(), ArenaError> {
        world.clear();
        let Self { rules, size, standing, others } = self;
        others.clear();
        others.extend(standing.iter().map(|body| (*body, 0.0)));
        for rule in rules {
            for &body in &rule.bodies {
                let apart = if let How::Anywhere { apart, .. } = rule.how { apart } else { 0.0 };
                for (_, far) in others.iter_mut() {
                    *far = apart as f32;
                }
                let at = place(rule, *size, world, others, stream)?;
                let heading = match (rule.robots, &rule.how) {
                    (_, How::Fixed { heading, .. }) => *heading as f32,
                    (true, _) => stream.range(-PI, PI),
                    (false, _) => 0.0,
                };
                world.place_body(body, Pose::planar(at, heading), Twist::default());
                world.finish_placement();
                if rule.solid {
                    others.push((body, 0.0));
                }
            }
        }
        Ok(())
    }
}

/// The number of a robot that is named alone: `robot-2`.
fn numbered(name: &str) -> Option<usize> {
    name.strip_prefix(ROBOT)?.strip_prefix('-')?.parse().ok()
}

/// A place for one body of a rule.
fn place<W: PlanarWorld>(
    rule: &Rule,
    size: [f64; 2],
    world: &W,
    others: &[(BodyId, f32)],
    stream: &mut Stream,
) -> Result<[f32; 2], ArenaError> {
    match &rule.how {
        How::Anywhere { walls, .. } => {
            let margin = rule.radius + walls;
            let low = size.map(|x| margin.min(0.5 * x) as f32);
            let high = size.map(|x| (x - margin).max(0.5 * x) as f32);
            if !rule.solid {
                return Ok([0, 1].map(|k| stream.range(low[k], high[k])));
            }
            // The region keeps from the walls exactly; the hair's breadth is for the rounding of its ends.
            let free = FreePlace { walls: (walls - 1e-6) as f32, ..FreePlace::new([low, high], rule.radius as f32) };
            free.clear_of(others).find(world, stream)
        }
        How::Around { of, distance: [near, far] } => {
            let distance = stream.range(*near as f32, *far as f32);
            let (sine, cosine) = sin_cos(stream.range(-PI, PI));
            let [x, y, _] = world.pose(*of).position;
            Ok([x + distance * cosine, y + distance * sine])
        }
        How::Fixed { point, .. } => Ok(point.map(|x| x as f32)),
    }
}
