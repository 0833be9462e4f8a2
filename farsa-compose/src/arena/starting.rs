//! Initial placements of robots and things.

use core::f32::consts::PI;

use crate::arena::ArenaWorld;
use farsa_body::ports::BodyId;
use farsa_body::{Pose, Twist};
use farsa_lab::Error;
use farsa_num::{Scalar, Stream, sin_cos};
use farsa_physics::arena::{ArenaError, FreePlace};

use crate::arena::registered::{self, PartOfPlanar};
use crate::arena::scene::{ROBOT, Scene, Thing, flat, within_walls};
use crate::check::source::Source;
use crate::document::{Document, Placing, Start};
use crate::part::object::PlanarStart;
use crate::parts::choice::Choice;

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
    how: How,
}

#[derive(Clone, Debug)]
enum How {
    Anywhere {
        walls: f64,
        apart: f64,
    },
    Near {
        of: BodyId,
        within: f64,
        walls: f64,
        apart: f64,
    },
    Around {
        of: BodyId,
        distance: [f64; 2],
    },
    OneOf(Choice<2>),
    /// Without a heading it is drawn.
    Fixed {
        point: [f64; 2],
        heading: Option<f64>,
    },
    Registered(Box<dyn PlanarStart>),
}

impl How {
    /// Checks if all bodies are placed at one point.
    fn is_one_point(&self) -> bool {
        match self {
            Self::Fixed { .. } => true,
            Self::OneOf(choice) => !choice.is_drawn(),
            _ => false,
        }
    }
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

    /// Checks if a body is exactly at this point.
    fn is_at<W: ArenaWorld>(&self, world: &W, point: [f32; 2]) -> bool {
        let others = self.others.iter().map(|(body, _)| body).chain(self.areas.iter().map(|(body, _)| body));
        others.map(|body| world.pose(*body).position).any(|[x, y, _]| [x, y] == point)
    }
}

impl Starting {
    /// Reads the placements of a document. Robots without one are placed last, anywhere.
    pub(crate) fn new(document: &Document, scene: &Scene, source: &Source) -> Result<Self, Error> {
        let mut rules: Vec<Rule> = Vec::new();
        let robots: Vec<BodyId> = (0..scene.robots.len()).map(|robot| scene.parts(robot).body).collect();
        let of_robots = |bodies: Vec<BodyId>, how| {
            let radii = bodies.iter().map(|body| scene.robots[usize::from(body.0)].radius);
            let radius = radii.fold(0.0_f64, f64::max);
            Rule { bodies, radius, edge: radius, solid: true, turned: true, how }
        };
        // A placement relative to a thing needs the thing placed earlier.
        let before = |name: &str, path: &str, rules: &[Rule]| {
            let body = scene.body(name, path, source)?;
            let stands = document.objects.iter().any(|object| object.name == name && object.at.is_some());
            if stands || rules.iter().any(|rule| rule.bodies.contains(&body)) {
                return Ok(body);
            }
            Err(source.wrong(path, format!("`{name}` has to be placed before")))
        };
        for (index, start) in document.start.iter().enumerate() {
            let path = format!("/start/{index}");
            let at_point = |point: &[f64], path: &str| point_of(document, &start.place, point, path, source);
            let how = match &start.how {
                Placing::Anywhere { walls, apart, .. } => How::Anywhere { walls: *walls, apart: *apart },
                Placing::Near { of, within, walls, apart } => {
                    let thing = before(of, &format!("{path}/of"), &rules)?;
                    How::Near { of: thing, within: *within, walls: *walls, apart: *apart }
                }
                Placing::Around { of, distance } => {
                    let thing = before(of, &format!("{path}/of"), &rules)?;
                    if distance[0] > distance[1] {
                        return Err(source.wrong(&format!("{path}/distance"), "runs backwards"));
                    }
                    How::Around { of: thing, distance: *distance }
                }
                Placing::OneOf { points, like } => {
                    let points = points.iter().enumerate();
                    let point = |(index, at): (usize, &Vec<f64>)| at_point(at, &format!("{path}/points/{index}"));
                    let points_of_rule =
                        points.map(|at| Ok(point(at)?.map(|x| x as f32))).collect::<Result<Vec<_>, Error>>();
                    How::OneOf(Choice::new(points_of_rule?, like.as_ref(), document, index, source)?)
                }
                Placing::Registered { at, keys } => {
                    let part = PartOfPlanar { scene, robot: 0, files: None, path: &path, source };
                    How::Registered(registered::start(at, keys, part)?)
                }
                Placing::InBox { .. } | Placing::Turned { .. } => {
                    return Err(source.wrong(&format!("{path}/at"), "is for robots with joints; this one is on wheels"));
                }
                Placing::Fixed { point, heading, drawn_heading } => {
                    let point = at_point(point, &format!("{path}/point"))?;
                    How::Fixed { point, heading: (!drawn_heading).then(|| heading.to_radians()) }
                }
            };
            let rule = if start.place == ROBOT {
                if how.is_one_point() && scene.robots.len() > 1 {
                    return Err(source.wrong(&path, format!("puts {} robots on one point", scene.robots.len())));
                }
                of_robots(robots.clone(), how)
            } else if let Some([first, end]) = scene.groups.named(&start.place) {
                if how.is_one_point() && end - first > 1 {
                    return Err(source.wrong(&path, format!("puts {} robots on one point", end - first)));
                }
                of_robots(robots[first..end].to_vec(), how)
            } else if let Some(robot) = numbered(&start.place) {
                let body = robot.checked_sub(1).and_then(|robot| robots.get(robot));
                let why = || source.wrong(&format!("{path}/place"), format!("is robot {robot} of {}", robots.len()));
                of_robots(vec![*body.ok_or_else(why)?], how)
            } else {
                of_thing(start, how, &format!("{path}/place"), scene, source)?
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
            rules.push(of_robots(others, How::Anywhere { walls: 0.0, apart: 0.0 }));
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
                let apart = match rule.how {
                    How::Anywhere { apart, .. } | How::Near { apart, .. } => apart,
                    _ => 0.0,
                };
                // The distance belongs to the rule that places, not to the bodies placed earlier.
                for (_, far) in &mut before.others {
                    *far = apart as f32;
                }
                if let How::Registered(start) = &rule.how {
                    let none = ArenaError::NoFreePlace { tries: 1, radius: rule.radius as f32, short: 0.0 };
                    let pose = world.draw(&**start, index, stream).ok_or(none)?;
                    world.place_body(body, pose, Twist::default());
                    world.finish_placement();
                    before.add(body, rule);
                    continue;
                }
                let at = place(rule, number, chosen, *size, world, before, stream)?;
                // The heading is drawn after the place. Another order would change all later draws of the stream.
                let heading = match (rule.turned, &rule.how) {
                    (_, How::Fixed { heading: Some(heading), .. }) => *heading as f32,
                    (true, _) => stream.range(-PI, PI),
                    (false, _) => 0.0,
                };
                // The search for a free place reads the world, so each body is finished before the next draw.
                world.place_body(body, Pose::planar(at, heading), Twist::default());
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

/// Builds the rule of things of one name.
///
/// # Errors
/// [`Error::Setting`] for an unknown thing, a wall, and several things on one point.
fn of_thing(start: &Start, how: How, path: &str, scene: &Scene, source: &Source) -> Result<Rule, Error> {
    let things = scene.things(&start.place, path, source)?;
    let thing = things[0];
    let bodies: Vec<BodyId> = things.iter().filter_map(|thing| thing.body()).collect();
    if bodies.len() < 2 {
        scene.body(&start.place, path, source)?;
    } else if how.is_one_point() {
        return Err(source.wrong(path, format!("puts {} things on one point", bodies.len())));
    }
    let from_center = !thing.is_solid() && matches!(start.how, Placing::Anywhere { centers: true, .. });
    Ok(Rule {
        bodies,
        radius: thing.reach(),
        edge: if from_center { 0.0 } else { thing.reach() },
        solid: thing.is_solid(),
        turned: matches!(thing, Thing::Block { .. }),
        how,
    })
}

/// Reads the point of a thing or robot. Only lamps may be beyond the walls.
fn point_of(document: &Document, name: &str, at: &[f64], path: &str, source: &Source) -> Result<[f64; 2], Error> {
    let point = flat(at, path, source)?;
    if !document.objects.iter().any(|object| object.name == name && object.shines()) {
        within_walls(document, point, path, source)?;
    }
    Ok(point)
}

/// Finds the number of a single robot, such as `robot-2`.
fn numbered(name: &str) -> Option<usize> {
    name.strip_prefix(ROBOT)?.strip_prefix('-')?.parse().ok()
}

/// Draws a place for one body of a rule. Obstacles keep their distance from other bodies, and areas from other areas.
fn place<W: ArenaWorld>(
    rule: &Rule,
    number: usize,
    chosen: &mut [usize],
    size: [f64; 2],
    world: &W,
    before: &Before,
    stream: &mut Stream,
) -> Result<[f32; 2], ArenaError> {
    let (walls, apart, near) = match &rule.how {
        How::Fixed { point, .. } => return Ok(point.map(|x| x as f32)),
        // Drawn by `arrange`.
        How::Registered(_) => return Ok([0.0; 2]),
        How::OneOf(choice) => {
            let point_number = choice.take(chosen, |point| before.is_at(world, *point), |count| stream.below(count));
            let (tries, radius) = (choice.points.len() as u32, rule.radius as f32);
            chosen[number] = point_number.ok_or(ArenaError::NoFreePlace { tries, radius, short: 0.0 })?;
            return Ok(choice.points[chosen[number]]);
        }
        How::Around { of, distance: [near, far] } => {
            // p = c + r (cos a, sin a), with r and a uniform.
            // This is denser near the center than a draw uniform in area.
            let distance = stream.range(*near as f32, *far as f32);
            let (sine, cosine) = sin_cos(stream.range(-PI, PI));
            let [x, y, _] = world.pose(*of).position;
            return Ok([x + distance * cosine, y + distance * sine]);
        }
        How::Anywhere { walls, apart } => (walls, apart, None),
        How::Near { of, within, walls, apart } => {
            let [x, y, _] = world.pose(*of).position;
            (walls, apart, Some(([x, y], *within as f32)))
        }
    };
    // Centers are at least radius + walls from each wall. A margin of more than half the width leaves the middle.
    let margin = rule.edge + walls;
    let low = size.map(|x| margin.min(0.5 * x) as f32);
    let high = size.map(|x| (x - margin).max(0.5 * x) as f32);
    // The box of the disc around the thing, cut to the allowed centers. Places outside the disc are rejected later.
    let region = near.map_or([low, high], |(at, far)| {
        [-far, far].map(|far| [0, 1].map(|k| Scalar::clamp(at[k] + far, low[k], high[k])))
    });
    if rule.solid {
        // The region excludes the walls exactly. The margin of 1e-6 m allows for the rounding of its ends.
        let free =
            FreePlace { walls: (walls - 1e-6) as f32, within: near, ..FreePlace::new(region, rule.radius as f32) };
        return free.clear_of(&before.others).find(world, stream);
    }
    let radius = rule.radius as f32;
    let mut short = f32::INFINITY;
    for _ in 0..TRIES {
        let at = [0, 1].map(|k| stream.range(region[0][k], region[1][k]));
        // The largest overlap: r_i + r_j + apart - |p_i - p_j|.
        let lacks = before.areas.iter().fold(f32::NEG_INFINITY, |most, (other, reach)| {
            let [x, y, _] = world.pose(*other).position;
            Scalar::max(most, (rule.edge + reach + apart) as f32 - length([at[0] - x, at[1] - y]))
        });
        if near.is_none_or(|(centre, far)| length([at[0] - centre[0], at[1] - centre[1]]) <= far) {
            // Areas may overlap unless a distance is given.
            if *apart == 0.0 || lacks <= 0.0 {
                return Ok(at);
            }
            // The least overlap of all attempts shows in the error how much is missing.
            short = Scalar::min(short, lacks);
        }
    }
    Err(ArenaError::NoFreePlace { tries: TRIES, radius, short })
}

/// Most attempts to find a place.
const TRIES: u32 = 1000;

fn length([x, y]: [f32; 2]) -> f32 {
    Scalar::sqrt(x * x + y * y)
}
