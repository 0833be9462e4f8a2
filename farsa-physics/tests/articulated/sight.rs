//! Sight of cameras in an articulated world: a march along every ray, the arena, and the conformance checks.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Sensor, Sight};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::{Beam, ColorBand, LinearCamera};
use farsa_body::testing::check_sight;
#[cfg(feature = "lanes")]
use farsa_num::Instructions;
use farsa_num::{Domain, Stream, sin_cos};
use farsa_physics::arena::{self, Arena, Cylinder};
#[cfg(feature = "lanes")]
use farsa_physics::articulated::{Batch, LANES};
use farsa_physics::articulated::{Model, Options, World};

const HEIGHT: f64 = 0.1;
const RANGE: f32 = 2.0;
/// Rays of the camera that is compared ray by ray.
const RAYS: usize = 15;
pub(crate) const COLORS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A shape of a scene where it is.
pub(crate) struct Placed {
    shape: Shape,
    at: Pose<f64>,
    /// None for what a camera of the plane sees through.
    pub(crate) color: Option<usize>,
}

impl Placed {
    /// Signed distance of a place, by the shape's own definition.
    pub(crate) fn distance(&self, place: [f64; 3]) -> f64 {
        let [x, y, z] = self.at.transform_back(place);
        let length = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        match self.shape {
            Shape::Sphere { radius } => length([x, y, z]) - radius,
            Shape::Capsule { radius, half_length } => length([x, y, z - z.clamp(-half_length, half_length)]) - radius,
            Shape::Box { half } => {
                let q = [x.abs() - half[0], y.abs() - half[1], z.abs() - half[2]];
                length(q.map(|x| x.max(0.0))) + q[0].max(q[1]).max(q[2]).min(0.0)
            }
            Shape::Cylinder { radius, half_length } => {
                let q = [length([x, y, 0.0]) - radius, z.abs() - half_length];
                length([q[0].max(0.0), q[1].max(0.0), 0.0]) + q[0].max(q[1]).min(0.0)
            }
            Shape::Plane => z,
        }
    }
}

pub(crate) fn turned(stream: &mut Stream) -> [f64; 4] {
    let q: [f64; 4] = core::array::from_fn(|_| stream.range_f64(-1.0, 1.0));
    let n = q.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
    let q = q.map(|x| x / n);
    let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / n)
}

/// A scene with an eye, a few shapes on bodies and in the world, some of them without a color.
pub(crate) fn scene(stream: &mut Stream) -> (Robot, Vec<Placed>) {
    let mut robot = Robot::new("scene");
    let (heading, ball) = (stream.range_f64(-3.1, 3.1), MassProperties::sphere(1.0, 0.1));
    let mut eye = Pose::planar([stream.range_f64(-0.2, 0.2), stream.range_f64(-0.2, 0.2)], heading);
    eye.position[2] = stream.range_f64(-0.3, 0.3);
    robot.add_segment(Segment::new("eye", None, Joint::floating(eye), ball));
    let mut placed = Vec::new();
    let count = 2 + stream.below(5);
    for i in 0..count {
        let mut size = || stream.range_f64(0.05, 0.3);
        let shape = match i % 5 {
            0 | 3 => Shape::Sphere { radius: size() },
            1 => Shape::Capsule { radius: size(), half_length: size() },
            4 => Shape::Cylinder { radius: size(), half_length: size() },
            _ => Shape::Box { half: [size(), size(), size()] },
        };
        let position = [stream.range_f64(-1.5, 1.5), stream.range_f64(-1.5, 1.5), stream.range_f64(-0.2, 0.4)];
        let at = Pose { position, rotation: turned(stream) };
        let color = Some(stream.below(4) as usize).filter(|color| *color < 3);
        let name = format!("thing {i}");
        let body =
            (stream.below(2) == 0).then(|| robot.add_segment(Segment::new(&name, None, Joint::floating(at), ball)));
        let placement = if body.is_some() { Pose::identity() } else { at };
        let collider = Collider::new(&name, body, shape, placement);
        robot.add_collider(match color {
            Some(color) => collider.with_color(COLORS[color]),
            None => collider,
        });
        placed.push(Placed { shape, at, color });
    }
    if stream.below(3) == 0 {
        let (s, c) = sin_cos(0.25 * core::f64::consts::PI);
        // A wall: a plane that faces against x.
        let at = Pose { position: [1.7, 0.0, 0.0], rotation: [0.0, -s, 0.0, c] };
        robot.add_collider(Collider::new("wall", None, Shape::Plane, at).with_color(COLORS[2]));
        placed.push(Placed { shape: Shape::Plane, at, color: Some(2) });
    }
    (robot, placed)
}

/// Returns the first color on a march along a ray, or `Err` where the result depends on less than a tenth of a
/// millimeter.
fn marched(placed: &[Placed], from: [f64; 3], direction: [f64; 3]) -> Result<Option<usize>, ()> {
    const UNSURE: f64 = 1e-4;
    let seen: Vec<&Placed> = placed.iter().filter(|one| one.color.is_some()).collect();
    // A body around the start is invisible.
    if seen.iter().any(|one| one.distance(from).abs() < UNSURE) {
        return Err(());
    }
    let seen: Vec<&Placed> = seen.into_iter().filter(|one| one.distance(from) > 0.0).collect();
    let mut t = 0.0;
    while t < f64::from(RANGE) {
        let place = [0, 1, 2].map(|k: usize| from[k] + t * direction[k]);
        let mut gaps: Vec<(f64, usize)> =
            seen.iter().map(|one| (one.distance(place), one.color.unwrap_or(0))).collect();
        gaps.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(&(gap, color)) = gaps.first() else { return Ok(None) };
        if gap < 1e-7 {
            let close = gaps.iter().any(|(other, of)| *of != color && *other < UNSURE);
            let last = f64::from(RANGE) - t < UNSURE;
            return if close || last { Err(()) } else { Ok(Some(color)) };
        }
        t += gap;
    }
    Ok(None)
}

/// Returns whether a ray passes a shape within a tenth of a millimeter of its edge: its least distance on the way,
/// searched in steps.
fn grazes(placed: &[Placed], from: [f64; 3], direction: [f64; 3]) -> bool {
    placed.iter().filter(|one| one.color.is_some()).any(|one| {
        // The distance to a convex shape is convex along a ray: a search by thirds finds its least value.
        let at = |t: f64| one.distance([0, 1, 2].map(|k: usize| from[k] + t * direction[k]));
        let (mut low, mut high) = (0.0, f64::from(RANGE));
        for _ in 0..60 {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if at(a) > at(b) {
                low = a;
            } else {
                high = b;
            }
        }
        at(low).abs() < 1e-4
    })
}

fn world(robot: &Robot) -> World<f32> {
    World::new(Model::new(robot, &Options { sight_height: HEIGHT, ..Options::default() }).unwrap())
}

/// One colored shape that stays where it is, and a body to see it.
fn beside_an_eye(shape: Shape, at: Pose<f64>) -> World<f32> {
    let mut robot = Robot::new("one shape");
    let eye = Joint::floating(Pose::identity());
    robot.add_segment(Segment::new("eye", None, eye, MassProperties::sphere(0.1, 0.02)));
    robot.add_collider(Collider::new("shape", None, shape, at).with_color(COLORS[2]));
    world(&robot)
}

fn bands() -> Vec<ColorBand> {
    COLORS.map(|color| ColorBand::around(color.map(|x| x as f32), 0.2)).to_vec()
}

#[test]
fn a_camera_sees_what_a_march_along_its_rays_meets() {
    let scenes = if std::env::var_os("FARSA_LONG").is_some() { 100_000 } else { 10_000 };
    let mut stream = Stream::new(7, Domain::General, 0, 0, 0);
    let (mut seen, mut free, mut unsure) = ([0_u32; 3], 0_u32, 0_u32);
    for number in 0..scenes {
        let (robot, placed) = scene(&mut stream);
        let world = world(&robot);
        let mut camera = LinearCamera::for_view(BodyId(0), 2.0, RAYS, 1, bands(), RANGE).unwrap();
        let mut x = [0.0; 3 * RAYS];
        camera.read(&world, &mut x);
        let eye = robot.segments[0].joint.placement;
        for (ray, values) in x.chunks(3).enumerate() {
            let [u, v] = Beam::in_view([0.0; 2], 2.0, ray, RAYS).direction.map(f64::from);
            let direction = eye.rotate([u, v, 0.0]);
            let from = [eye.position[0], eye.position[1], HEIGHT];
            let met = match marched(&placed, from, direction) {
                Ok(met) if !grazes(&placed, from, direction) => met,
                _ => {
                    unsure += 1;
                    continue;
                }
            };
            let mut expected = [0.0; 3];
            match met {
                Some(color) => {
                    expected[color] = 1.0;
                    seen[color] += 1;
                }
                None => free += 1,
            }
            assert_eq!(values, expected, "scene {number}, ray {ray}");
        }
    }
    println!("{seen:?} seen, {free} free, {unsure} unsure");
    assert!(seen.iter().all(|count| *count > scenes / 2) && free > scenes);
    assert!(unsure < scenes * RAYS as u32 / 100, "{unsure} rays left out");
}

/// Returns the balls as discs of the arena, and in the articulated world.
#[test]
fn the_arena_and_the_articulated_world_show_the_same() {
    let mut stream = Stream::new(8, Domain::General, 0, 0, 0);
    let (mut read, mut shown) = (0, 0.0);
    for number in 0..1000 {
        let mut arena = Arena::new();
        let robot = arena.add_robot(MobileRobot::khepera(), [0.0, 0.0], 0.0);
        assert_eq!(robot, 0);
        let mut scene = Robot::new("the same");
        let ball = MassProperties::sphere(1.0, 0.1);
        scene.add_segment(Segment::new("eye", None, Joint::floating(Pose::identity()), ball));
        let mut rounds: Vec<([f64; 2], f64)> = Vec::new();
        for i in 0..4 {
            let radius = stream.range_f64(0.05, 0.2);
            let at = [stream.range_f64(0.4, 1.6), stream.range_f64(-0.8, 0.8)];
            let apart =
                |(other, wide): &([f64; 2], f64)| (other[0] - at[0]).hypot(other[1] - at[1]) > wide + radius + 0.01;
            if !rounds.iter().all(apart) {
                continue;
            }
            rounds.push((at, radius));
            let color = COLORS[i % 3];
            arena.add_cylinder(Cylinder { color, ..Cylinder::new(at, radius) });
            let place = Pose::at([at[0], at[1], HEIGHT]);
            let body = scene.add_segment(Segment::new(&format!("ball {i}"), None, Joint::floating(place), ball));
            let shape = Shape::Sphere { radius };
            let collider = Collider::new(&format!("ball {i}"), Some(body), shape, Pose::identity());
            scene.add_collider(collider.with_color(color));
        }
        let (rays, per_sector) = (15, 5);
        // A ray within 10 micrometers of an edge, or two surfaces as near to each other, may be seen either way.
        let unsure = (0..rays).any(|ray| {
            let [u, v] = Beam::in_view([0.0; 2], 1.2, ray, rays).direction.map(f64::from);
            let edge = |(at, radius): &([f64; 2], f64)| ((at[0] * v - at[1] * u).abs() - radius).abs() < 1e-5;
            rounds.iter().any(edge)
        });
        if unsure {
            continue;
        }
        let flat = arena::World::new(&arena).unwrap();
        let solid = world(&scene);
        let mut camera = LinearCamera::for_view(BodyId(0), 1.2, 3, per_sector, bands(), RANGE).unwrap();
        let (mut x, mut y) = ([0.0_f32; 9], [0.0_f32; 9]);
        camera.read(&flat, &mut x);
        camera.read(&solid, &mut y);
        assert!(x.iter().zip(&y).all(|(a, b)| (a - b).abs() < 1e-5), "scene {number}: {x:?} and {y:?}");
        read += 1;
        shown += x.iter().sum::<f32>();
    }
    assert!(read > 900 && shown > 500.0, "{read} scenes, {shown}");
}

#[test]
fn the_kit_finds_the_world_in_order() {
    let mut stream = Stream::new(9, Domain::General, 0, 0, 0);
    let mut checked = 0;
    for _ in 0..200 {
        let (robot, placed) = scene(&mut stream);
        let world = world(&robot);
        let bodies: Vec<BodyId> = (0..robot.segments.len()).map(|body| BodyId(body as u16)).collect();
        let mut places: Vec<[f32; 2]> = Vec::new();
        while places.len() < 4 {
            let at = [stream.range_f64(-1.4, 1.4), stream.range_f64(-1.4, 1.4)];
            if placed.iter().all(|one| one.distance([at[0], at[1], HEIGHT]) > 0.02) {
                places.push(at.map(|x| x as f32));
            }
        }
        let mut met = false;
        world.query_near(places[0], 1.5, &mut |_| met = true);
        let seen = (0..64).any(|ray| {
            let [u, v] = Beam::in_view([0.0; 2], 6.2, ray, 64).direction;
            world.cast_planar(places[0], [u, v], 1.5, None).is_some()
        });
        if met && seen {
            check_sight(&world, &bodies, &places, 1.5).unwrap();
            checked += 1;
        }
    }
    assert!(checked > 100, "{checked}");
}

/// Returns the distance of a place from the section of a capsule in the plane of sight. The section consists of discs,
/// in which the plane cuts the balls about many points of the axis. The second number is the height by which the
/// capsule reaches the plane, less than 0 without a section.
fn cut_of_capsule(at: &Pose<f64>, radius: f64, half_length: f64, from: [f64; 2]) -> (f64, f64) {
    let (mut nearest, mut reach) = (f64::INFINITY, f64::NEG_INFINITY);
    for k in -2000..=2000 {
        let [x, y, z] = at.transform([0.0, 0.0, half_length * f64::from(k) / 2000.0]);
        let above = HEIGHT - z;
        reach = reach.max(radius - above.abs());
        if above.abs() <= radius {
            let cut = (radius * radius - above * above).sqrt();
            nearest = nearest.min(((x - from[0]).hypot(y - from[1]) - cut).max(0.0));
        }
    }
    (nearest, reach)
}

#[test]
fn capsules_lying_and_tilted_are_as_far_as_their_cut() {
    let (radius, half_length) = (0.05, 0.2);
    let mut stream = Stream::new(12, Domain::General, 0, 0, 0);
    let (mut met, mut missed) = ([0; 2], [0; 2]);
    for number in 0..600 {
        let lies = number % 2 == 0;
        // The axis, z, along x, and then turned about the vertical, or anyhow.
        let lying = std::f64::consts::FRAC_1_SQRT_2;
        let flat = Pose { position: [0.0; 3], rotation: [0.0, lying, 0.0, lying] };
        let heading = Pose::planar([0.0; 2], stream.range_f64(-3.1, 3.1));
        let rotation = if lies { heading.compose(&flat).rotation } else { turned(&mut stream) };
        let height = HEIGHT + stream.range_f64(-2.0, 2.0) * if lies { radius } else { half_length };
        let at = Pose { position: [stream.range_f64(-0.5, 0.5), stream.range_f64(-0.5, 0.5), height], rotation };
        let shape = Shape::Capsule { radius, half_length };
        let world = beside_an_eye(shape, at);
        let from = [stream.range_f64(-1.0, 1.0), stream.range_f64(-1.0, 1.0)];
        let mut found = Vec::new();
        world.query_near(from.map(|x| x as f32), 3.0, &mut |near| found.push(f64::from(near.distance)));
        let (expected, reach) = cut_of_capsule(&at, radius, half_length, from);
        if reach < -1e-4 {
            assert!(found.is_empty(), "{found:?}, {reach} from the plane: {at:?}");
            missed[usize::from(lies)] += 1;
        } else if reach > 1e-4 {
            assert!(found.len() == 1 && (found[0] - expected).abs() < 5e-4, "{found:?}, {expected}: {at:?}");
            met[usize::from(lies)] += 1;
        }
    }
    assert!(met.iter().chain(&missed).all(|count| *count > 50), "{met:?}, {missed:?}");
}

#[test]
fn a_box_whose_top_lies_in_the_plane_of_sight_is_as_far_as_its_top() {
    let half = [0.15, 0.05, HEIGHT];
    let mut stream = Stream::new(13, Domain::General, 0, 0, 0);
    for _ in 0..200 {
        let place = [stream.range_f64(0.2, 0.6), stream.range_f64(0.2, 0.6)];
        let at = Pose::planar(place, stream.range_f64(-3.1, 3.1));
        let world = beside_an_eye(Shape::Box { half }, at);
        let from = [stream.range_f64(-1.0, 1.0), stream.range_f64(-1.0, 1.0)];
        let mut found = Vec::new();
        world.query_near(from.map(|x| x as f32), 3.0, &mut |near| found.push(f64::from(near.distance)));
        let [x, y, _] = at.transform_back([from[0], from[1], 0.0]);
        let expected = (x.abs() - half[0]).max(0.0).hypot((y.abs() - half[1]).max(0.0));
        assert!(found.len() == 1 && (found[0] - expected).abs() < 1e-5, "{found:?}, {expected}: {at:?}");
    }
}

#[test]
fn the_nearest_point_of_a_plane_lies_on_it_along_its_normal() {
    let mut stream = Stream::new(11, Domain::General, 0, 0, 0);
    let mut checked = 0;
    for _ in 0..500 {
        let position = [stream.range_f64(-0.5, 0.5), stream.range_f64(-0.5, 0.5), stream.range_f64(-0.2, 0.4)];
        let at = Pose { position, rotation: turned(&mut stream) };
        let world = beside_an_eye(Shape::Plane, at);
        let from = [stream.range_f64(-1.0, 1.0), stream.range_f64(-1.0, 1.0)];
        let normal = at.rotate([0.0, 0.0, 1.0]);
        let steep = normal[0].hypot(normal[1]);
        let height = |[x, y]: [f64; 2]| {
            let from = [x - position[0], y - position[1], HEIGHT - position[2]];
            (0..3).map(|k| normal[k] * from[k]).sum::<f64>()
        };
        // In the plane of sight it is a line, this far away.
        let expected = height(from) / steep;
        if steep < 0.2 || !(0.01..2.9).contains(&expected) {
            continue;
        }
        let mut found = Vec::new();
        world.query_near(from.map(|x| x as f32), 3.0, &mut |near| {
            found.push((near.point.map(f64::from), near.distance));
        });
        let [([x, y], distance)] = found[..] else { panic!("{found:?} in {at:?}") };
        let way = [x - from[0], y - from[1]];
        assert!(height([x, y]).abs() < 1e-5 && (f64::from(distance) - expected).abs() < 1e-5, "{x}, {y} on {at:?}");
        assert!((way[0] * normal[1] - way[1] * normal[0]).abs() < 1e-5, "{way:?} to {at:?}");
        checked += 1;
    }
    assert!(checked > 100, "{checked}");
}

#[cfg(feature = "lanes")]
#[test]
fn lanes_show_what_worlds_show() {
    let mut stream = Stream::new(10, Domain::General, 0, 0, 0);
    for number in 0..30 {
        let (robot, _) = scene(&mut stream);
        let model = Model::new(&robot, &Options { sight_height: HEIGHT, ..Options::default() }).unwrap();
        let lanes = LANES[number % LANES.len()];
        let mut batch = Batch::new(model.clone(), lanes, Instructions::detect()).unwrap();
        let mut world = World::new(model);
        let mut camera = LinearCamera::for_view(BodyId(0), 3.0, 6, 7, bands(), RANGE).unwrap();
        for _ in 0..10 {
            // Everything falls and turns a little.
            batch.step();
            farsa_body::ports::World::step(&mut world);
            let (mut x, mut y) = ([0.0_f32; 18], [0.0_f32; 18]);
            camera.read(&world, &mut x);
            for lane in 0..lanes {
                let lane = batch.lane(lane);
                camera.read(&lane, &mut y);
                assert_eq!(x.map(f32::to_bits), y.map(f32::to_bits));
                let (mut one, mut other) = (Vec::new(), Vec::new());
                world.query_near([0.1, 0.2], 3.0, &mut |near| one.push(near));
                lane.query_near([0.1, 0.2], 3.0, &mut |near| other.push(near));
                assert_eq!(one, other);
            }
        }
    }
}
