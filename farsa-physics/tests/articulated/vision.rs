//! Cameras with an image in an articulated world: a march along every ray, the ports of rays, and the conformance
//! checks.

use crate::common::{POSES, scene as tabletop};
use crate::sight::{COLORS, Placed, scene, turned};
use farsa_body::Pose;
use farsa_body::ports::{Arrange, BodyId, JointId, Rays, Seen, Vision};
#[cfg(feature = "lanes")]
use farsa_body::ports::{Channels, Kinematics, Sensor};
use farsa_body::robot::Robot;
use farsa_body::sensors::Camera;
#[cfg(feature = "lanes")]
use farsa_body::sensors::{CameraImage, ColorBand, ColorBlobs};
use farsa_body::testing::check_vision;
#[cfg(feature = "lanes")]
use farsa_num::Instructions;
use farsa_num::{Domain, Stream, sin_cos};
#[cfg(feature = "lanes")]
use farsa_physics::articulated::{Batch, LANES};
use farsa_physics::articulated::{Model, Options, World};

const RANGE: f32 = 2.0;

fn world(robot: &Robot) -> World<f32> {
    World::new(Model::new(robot, &Options::default()).unwrap())
}

/// A camera on the eye of a scene, turned somehow.
fn camera(stream: &mut Stream, size: [usize; 2]) -> Camera {
    let rotation = turned(stream).map(|x| x as f32);
    Camera::new(BodyId(0), Pose { position: [0.02, -0.01, 0.03], rotation }, size, 1.4, RANGE).unwrap()
}

/// Returns number and distance of the first surface on a march along a ray, or `Err` where they depend on less than a
/// tenth of a millimeter.
fn marched(placed: &[Placed], from: [f64; 3], direction: [f64; 3]) -> Result<Option<(usize, f64)>, ()> {
    const UNSURE: f64 = 1e-4;
    let range = f64::from(RANGE);
    let place = |t: f64| [0, 1, 2].map(|k: usize| from[k] + t * direction[k]);
    if placed.iter().any(|one| one.distance(from).abs() < UNSURE) {
        return Err(());
    }
    let mut found: Vec<(usize, f64)> = Vec::new();
    for (number, one) in placed.iter().enumerate().filter(|(_, one)| one.distance(from) > 0.0) {
        let mut t = 0.0;
        let mut least = f64::INFINITY;
        while t < range + UNSURE {
            let gap = one.distance(place(t));
            least = least.min(gap);
            if gap < 1e-8 {
                found.push((number, t));
                break;
            }
            t += gap;
        }
        // A miss by less, and, by the same share of its chord, a hit that barely is one.
        if least < UNSURE && t >= range - UNSURE {
            return Err(());
        }
    }
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    if found.first().is_some_and(|(number, t)| {
        // The depth of the ray: a search for the least distance behind the place where it enters.
        let (mut low, mut high) = (*t, range + 2.0);
        let at = |t: f64| placed[*number].distance(place(t));
        for _ in 0..80 {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if at(a) > at(b) { low = a } else { high = b }
        }
        at(low) > -UNSURE
    }) {
        return Err(());
    }
    match found[..] {
        [(_, one), (_, other), ..] if other - one < UNSURE => Err(()),
        [(_, one), ..] if (one - range).abs() < UNSURE => Err(()),
        [(number, t), ..] => Ok(Some((number, t))),
        [] => Ok(None),
    }
}

#[test]
fn an_eye_sees_what_a_march_along_its_rays_meets() {
    let scenes = if std::env::var_os("FARSA_LONG").is_some() { 100_000 } else { 10_000 };
    let mut stream = Stream::new(17, Domain::General, 0, 0, 0);
    let (mut met, mut hidden, mut free, mut unsure) = (0_u32, 0_u32, 0_u32, 0_u32);
    for number in 0..scenes {
        let (robot, placed) = scene(&mut stream);
        let world = world(&robot);
        let mut camera = camera(&mut stream, [5, 4]);
        let eye = robot.segments[0].joint.placement;
        let pose = camera.pose(&world);
        let (sine, cosine) = sin_cos(0.7);
        let tangent: f64 = sine / cosine;
        let seen: Vec<Option<Seen<BodyId>>> = camera.look(&world).to_vec();
        assert!((0..3).all(|k| (f64::from(pose.position[k]) - eye.position[k]).abs() < 0.1));
        for (index, seen) in seen.iter().enumerate() {
            let [left, up] = camera.pixel(index).map(f64::from);
            let ahead = [1.0, left * tangent, up * tangent];
            let length = ahead.iter().map(|x| x * x).sum::<f64>().sqrt();
            let rotation = pose.rotation.map(f64::from);
            let pose = Pose { position: pose.position.map(f64::from), rotation };
            let direction = pose.rotate(ahead.map(|x| x / length));
            match marched(&placed, pose.position, direction) {
                Err(()) => unsure += 1,
                Ok(None) => {
                    assert_eq!(*seen, None, "scene {number}, ray {index}");
                    free += 1;
                }
                Ok(Some((which, t))) => {
                    let Some(seen) = seen else { panic!("scene {number}, ray {index}: nothing, {which} at {t}") };
                    let color = placed[which].color.map(|color| COLORS[color].map(|x| x as f32));
                    assert_eq!(seen.color, color, "scene {number}, ray {index}");
                    assert!((f64::from(seen.distance) - t).abs() < 1e-3, "scene {number}, ray {index}: {seen:?}, {t}");
                    met += u32::from(color.is_some());
                    hidden += u32::from(color.is_none());
                }
            }
        }
    }
    println!("{met} with a colour, {hidden} without, {free} free, {unsure} unsure");
    assert!(met > scenes && hidden > scenes / 5 && free > scenes);
    assert!(unsure < scenes / 100, "{unsure} rays left out");
}

/// The first surface by the port of single rays, which has no colors and culls nothing, with the same bits.
#[test]
fn many_rays_are_single_rays() {
    let mut stream = Stream::new(18, Domain::General, 0, 0, 0);
    let mut met = 0;
    for _ in 0..300 {
        let (robot, _) = scene(&mut stream);
        let world = world(&robot);
        let from = [stream.range(-1.0, 1.0), stream.range(-1.0, 1.0), stream.range(-0.3, 0.3)];
        let directions: Vec<[f32; 3]> = (0..200)
            .map(|_| {
                let v = [stream.normal(), stream.normal(), stream.normal()];
                let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
                v.map(|x| x / length)
            })
            .collect();
        let mut seen = vec![None; directions.len()];
        world.look(from, &directions, RANGE, None, &mut seen);
        for (direction, seen) in directions.iter().zip(&seen) {
            let hit = world.cast(from, *direction, RANGE);
            assert_eq!(hit.map(|hit| (hit.distance, hit.body)), seen.map(|seen| (seen.distance, seen.body)));
            met += usize::from(hit.is_some());
        }
    }
    assert!(met > 3000, "{met}");
}

#[test]
fn the_kit_finds_the_eyes_in_order() {
    let robot = tabletop();
    let model = Model::<f32>::new(&robot, &Options::default()).unwrap();
    let bodies: Vec<BodyId> = (0..robot.segments.len()).map(|body| BodyId(body as u16)).collect();
    for pose in POSES {
        let mut world = World::new(model.clone());
        for (j, degrees) in pose.into_iter().enumerate() {
            world.place_joint(JointId(j as u16), degrees.to_radians() as f32, 0.0);
        }
        world.finish_placement();
        assert_eq!(check_vision(&world, &bodies, &[[0.1, -0.3, 0.3], [0.3, 0.0, 0.1]], 1.0), Ok(()));
    }
}

#[cfg(feature = "lanes")]
#[test]
fn lanes_see_what_worlds_see() {
    let mut stream = Stream::new(19, Domain::General, 0, 0, 0);
    let mut lit = 0.0;
    for number in 0..30 {
        let (robot, _) = scene(&mut stream);
        let model = Model::new(&robot, &Options::default()).unwrap();
        let lanes = LANES[number % LANES.len()];
        let mut batch = Batch::new(model.clone(), lanes, Instructions::detect()).unwrap();
        let mut world = World::new(model);
        let camera = camera(&mut stream, [8, 6]);
        let bands = COLORS.map(|color| ColorBand::around(color.map(|x| x as f32), 0.2)).to_vec();
        let mut blobs = ColorBlobs::new(camera.clone(), bands).unwrap();
        let mut image = CameraImage::new(camera);
        for _ in 0..10 {
            // Everything falls and turns a little.
            batch.step();
            farsa_body::ports::World::step(&mut world);
            let mut x = vec![0.0_f32; image.channels() + blobs.channels()];
            let mut y = x.clone();
            let (pixels, rest) = x.split_at_mut(144);
            image.read(&world, pixels);
            blobs.read(&world, rest);
            lit += pixels.iter().sum::<f32>();
            for lane in 0..lanes {
                let lane = batch.lane(lane);
                assert_eq!(lane.pose(BodyId(0)), world.pose(BodyId(0)));
                let (pixels, rest) = y.split_at_mut(144);
                image.read(&lane, pixels);
                blobs.read(&lane, rest);
                assert!(x.iter().zip(&y).all(|(a, b)| a.to_bits() == b.to_bits()), "scene {number}");
            }
        }
    }
    assert!(lit > 100.0, "{lit}");
}
