//! Initial placements of robots and things.

use crate::arena::ArenaWorld;
use farsa_body::ports::BodyId;
use farsa_body::{Pose, Twist};
use farsa_lab::Error;
use farsa_num::Stream;
use farsa_physics::arena::ArenaError;
use serde_json::Map;

use crate::arena::registered::{self, PartOfPlanar};
use crate::arena::scene::{ROBOT, Scene, Thing};
use crate::check::source::Source;
use crate::document::{Document, Placing};
use crate::part::object::PlanarStart;
use crate::part::spot::Spot;
use crate::parts::rule_of::RuleOf;

/// A placement with its bodies.
#[derive(Clone, Debug)]
struct Rule {
    bodies: Vec<BodyId>,
    /// Radius of the obstacle [m].
    radius: f64,
    /// Distance from the center from which distances are measured [m].
    edge: f64,
    solid: bool,
    /// True if a heading is drawn.
    turned: bool,
    start: Box<dyn PlanarStart>,
}

/// Placements of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Starting {
    rules: Vec<Rule>,
    size: [f64; 2],
    /// Places outside the arena for robots that do not take part.
    outside: Vec<(BodyId, [f32; 2])>,
    /// Things with a fixed initial place.
    standing: Vec<BodyId>,
    before: Before,
    /// Numbers of the chosen points, by rule.
    chosen: Vec<usize>,
}

/// Bodies placed earlier, with capacity for all.
#[derive(Clone, Debug)]
struct Before {
    /// Obstacles with their least distance [m].
    others: Vec<(BodyId, f32)>,
    /// Areas, with their radius [m].
    areas: Vec<(BodyId, f64)>,
}

impl Before {
    /// Adds a body of a rule.
    fn add(&mut self, body: BodyId, rule: &Rule) {
        if rule.solid {
            self.others.push((body, 0.0));
        } else {
            self.areas.push((body, rule.edge));
        }
    }
}

impl Starting {
    /// Reads the placements of a document. Robots without one are placed last, anywhere.
    pub(crate) fn new(document: &Document, scene: &Scene, source: &Source) -> Result<Self, Error> {
        let mut rules: Vec<Rule> = Vec::new();
        let robots: Vec<BodyId> = (0..scene.robots.len()).map(|robot| scene.parts(robot).body).collect();
        let of_robots = |bodies: Vec<BodyId>, start| {
            let radii = bodies.iter().map(|body| scene.robots[usize::from(body.0)].radius);
            let radius = radii.fold(0.0_f64, f64::max);
            Rule { bodies, radius, edge: radius, solid: true, turned: true, start }
        };
        for (index, start) in document.start.iter().enumerate() {
            let path = format!("/start/{index}");
            let placed: Vec<BodyId> = rules.iter().flat_map(|rule| rule.bodies.iter().copied()).collect();
            let of = Some(RuleOf { document, number: index, placed: &placed });
            let part = PartOfPlanar { scene, robot: 0, files: None, rule: of, sensors: &[], path: &path, source };
            let made = registered::start(&start.how, part)?;
            let facts = source.registry.start(&start.how);
            let is_one_place = facts.as_ref().is_some_and(|facts| facts.is_one_place());
            let rule = if start.place == ROBOT {
                if is_one_place && scene.robots.len() > 1 {
                    return Err(source.wrong(&path, format!("puts {} robots on one point", scene.robots.len())));
                }
                of_robots(robots.clone(), made)
            } else if let Some([first, end]) = scene.groups.named(&start.place) {
                if is_one_place && end - first > 1 {
                    return Err(source.wrong(&path, format!("puts {} robots on one point", end - first)));
                }
                of_robots(robots[first..end].to_vec(), made)
            } else if let Some(robot) = numbered(&start.place) {
                let body = robot.checked_sub(1).and_then(|robot| robots.get(robot));
                let why = || source.wrong(&format!("{path}/place"), format!("is robot {robot} of {}", robots.len()));
                of_robots(vec![*body.ok_or_else(why)?], made)
            } else {
                let from_center = facts.is_some_and(|facts| facts.measures_centers());
                let thing = Placed { name: &start.place, is_one_place, from_center };
                of_thing(thing, made, &format!("{path}/place"), scene, source)?
            };
            if rules.iter().any(|other| other.bodies.iter().any(|body| rule.bodies.contains(body))) {
                return Err(source.wrong(&format!("{path}/place"), format!("`{}` is placed twice", start.place)));
            }
            rules.push(rule);
        }
        for (index, object) in document.objects.iter().enumerate() {
            let path = format!("/objects/{index}");
            let things = scene.things(&object.name, &path, source)?;
            let body = things[0].body().filter(|_| object.at.is_none());
            if body.is_some_and(|body| !rules.iter().any(|rule| rule.bodies.contains(&body))) {
                return Err(source.wrong(&path, "lacks the key `at`, and no `[[start]]` places it"));
            }
        }
        let placed = |body: &BodyId| rules.iter().any(|rule| rule.bodies.contains(body));
        let others: Vec<BodyId> = robots.iter().copied().filter(|body| !placed(body)).collect();
        if !others.is_empty() {
            let anywhere = Placing { at: "anywhere".into(), keys: Map::new() };
            let part = PartOfPlanar { scene, robot: 0, files: None, rule: None, sensors: &[], path: "/start", source };
            rules.push(of_robots(others, registered::start(&anywhere, part)?));
        }
        let moved = |body: &BodyId| rules.iter().any(|rule| rule.bodies.contains(body));
        let standing: Vec<BodyId> =
            scene.standing(document).map(|(body, _)| body).filter(|body| !moved(body)).collect();
        let most = standing.len() + rules.iter().map(|rule| rule.bodies.len()).sum::<usize>();
        let before = Before { others: Vec::with_capacity(most), areas: Vec::with_capacity(most) };
        let chosen = vec![0; rules.len()];
        Ok(Self { rules, size: scene.size, outside: outside(scene, &robots), standing, before, chosen })
    }

    /// Returns the number of the placement of a body.
    pub(crate) fn rule_of(&self, body: BodyId) -> Option<usize> {
        self.rules.iter().position(|rule| rule.bodies.contains(&body))
    }

    /// Places all bodies, by draws in the order of the rules. Only the first `present` robots take part.
    pub(crate) fn arrange<W: ArenaWorld>(
        &mut self,
        world: &mut W,
        stream: &mut Stream,
        present: usize,
    ) -> Result<(), ArenaError> {
        world.clear();
        let Self { rules, size, outside, standing, before, chosen } = self;
        let absent = &outside[present..];
        // Absent robots move outside before any draw, so that they are no obstacles.
        for (body, at) in absent {
            world.place_body(*body, Pose::planar(*at, 0.0), Twist::default());
            world.finish_placement();
        }
        before.others.clear();
        before.areas.clear();
        before.others.extend(standing.iter().map(|body| (*body, 0.0)));
        for (number, rule) in rules.iter().enumerate() {
            let present = rule.bodies.iter().filter(|body| !absent.iter().any(|(other, _)| other == *body));
            for (index, &body) in present.enumerate() {
                let mut spot = Spot {
                    number: index,
                    radius: rule.radius,
                    edge: rule.edge,
                    solid: rule.solid,
                    turns: rule.turned,
                    size: *size,
                    others: &mut before.others,
                    areas: &before.areas,
                    earlier: &[],
                    chosen,
                    choice: None,
                    lacks: None,
                };
                let pose = world.draw(&*rule.start, &mut spot, stream);
                let none = || ArenaError::NoFreePlace { tries: 1, radius: rule.radius as f32, short: 0.0 };
                let (lacks, choice) = (spot.lacks.take(), spot.choice);
                let pose = pose.ok_or_else(|| lacks.unwrap_or_else(none))?;
                if let Some(choice) = choice {
                    chosen[number] = choice;
                }
                // The search for a free place reads the world, so each body is finished before the next draw.
                world.place_body(body, pose, Twist::default());
                world.finish_placement();
                before.add(body, rule);
            }
        }
        Ok(())
    }
}

/// Returns places outside the arena for all robots, beyond the range of sensors.
fn outside(scene: &Scene, robots: &[BodyId]) -> Vec<(BodyId, [f32; 2])> {
    let size = scene.size[0].max(scene.size[1]) as f32;
    // Five times the longer side is beyond every wall. Four radii per robot keep absent robots apart.
    let place = |robot: usize| [-5.0 * size - 4.0 * scene.robots[robot].radius as f32 * robot as f32; 2];
    robots.iter().enumerate().map(|(robot, body)| (*body, place(robot))).collect()
}

/// Name of the things of a rule. `from_center` is true if distances from areas are measured from their centers.
struct Placed<'p> {
    name: &'p str,
    is_one_place: bool,
    from_center: bool,
}

/// Builds the rule of things of one name.
///
/// # Errors
/// [`Error::Setting`] for an unknown thing, a wall, and several things on one point.
fn of_thing(
    Placed { name, is_one_place, from_center }: Placed<'_>,
    start: Box<dyn PlanarStart>,
    path: &str,
    scene: &Scene,
    source: &Source,
) -> Result<Rule, Error> {
    let things = scene.things(name, path, source)?;
    let thing = things[0];
    let bodies: Vec<BodyId> = things.iter().filter_map(|thing| thing.body()).collect();
    if bodies.len() < 2 {
        scene.body(name, path, source)?;
    } else if is_one_place {
        return Err(source.wrong(path, format!("puts {} things on one point", bodies.len())));
    }
    let from_center = from_center && !thing.is_solid();
    Ok(Rule {
        bodies,
        radius: thing.reach(),
        edge: if from_center { 0.0 } else { thing.reach() },
        solid: thing.is_solid(),
        turned: matches!(thing, Thing::Block { .. }),
        start,
    })
}

/// Finds the number of a single robot, such as `robot-2`.
fn numbered(name: &str) -> Option<usize> {
    name.strip_prefix(ROBOT)?.strip_prefix('-')?.parse().ok()
}
