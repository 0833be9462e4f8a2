//! Rays that are not cast because they cannot hit anything: infrared groups and cameras against all of their rays.

use core::cell::{Cell, RefCell};
use core::f32::consts::PI;

use crate::shared::{GREEN, RED, read, robots};
use farsa_body::ports::{
    ActuatorId, BodyId, Handles, Hit, JointId, Kinematics, NearbySurface, PlanarHit, Rays, Sensor, Sight,
};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::infrared::{InfraredGroups, InfraredRays};
use farsa_body::sensors::{Beam, ColorBand, LinearCamera};
use farsa_body::testing::PlaneWorld;
use farsa_body::{Pose, Twist};
use proptest::prelude::*;

/// Start and direction of a ray.
type Line = [[f32; 2]; 2];

/// A world that keeps the rays that are cast in it, and may report a red wall that is not there.
struct Watched<'a> {
    world: &'a PlaneWorld,
    cast: RefCell<Vec<Line>>,
    /// The height of the last ray that was cast in space [m].
    height: Cell<f32>,
    phantom_wall: bool,
    /// True if discs are reported as bodies of another form, whose radius is 0.
    without_radius: bool,
}

impl<'a> Watched<'a> {
    fn new(world: &'a PlaneWorld) -> Self {
        Self {
            world,
            cast: RefCell::default(),
            height: Cell::new(f32::NAN),
            phantom_wall: false,
            without_radius: false,
        }
    }

    /// Returns the reading of a sensor, and the rays that it cast.
    fn read(&self, sensor: &mut impl Sensor<Self>) -> (Vec<f32>, Vec<Line>) {
        self.cast.borrow_mut().clear();
        (read(sensor, self), self.cast.take())
    }
}

impl Handles for Watched<'_> {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}
impl Kinematics for Watched<'_> {
    fn pose(&self, body: BodyId) -> Pose {
        self.world.pose(body)
    }
    fn velocity(&self, body: BodyId) -> Twist {
        self.world.velocity(body)
    }
}
impl Rays for Watched<'_> {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        self.cast.borrow_mut().push([[origin[0], origin[1]], [direction[0], direction[1]]]);
        self.height.set(origin[2]);
        self.world.cast(origin, direction, range)
    }
}
impl Sight for Watched<'_> {
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        let radius = |radius| if self.without_radius { 0.0 } else { radius };
        self.world.query_near(from, range, &mut |near| tell(NearbySurface { radius: radius(near.radius), ..near }));
        if self.phantom_wall {
            tell(NearbySurface { body: None, point: from, distance: 0.0, radius: 0.0, color: RED, signal: None });
        }
    }
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<PlanarHit<BodyId>> {
        self.cast.borrow_mut().push([from, direction]);
        self.world.cast_planar(from, direction, range, but)
    }
}

/// Where one gets from a place by a bearing and a distance.
fn from(at: [f32; 2], bearing: f32, distance: f32) -> [f32; 2] {
    let (sine, cosine) = farsa_num::sin_cos(bearing);
    [at[0] + distance * cosine, at[1] + distance * sine]
}

/// The least distance of a place from a ray of a length, found by many points of it.
fn nearest([start, along]: Line, length: f32, gap: impl Fn([f32; 2]) -> f32) -> f32 {
    let at = |k: u16| f32::from(k) / 2000.0 * length;
    (0..=2000).map(|k| gap([start[0] + at(k) * along[0], start[1] + at(k) * along[1]])).fold(f32::INFINITY, f32::min)
}

fn apart(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Which of all rays were cast.
fn which(all: &[Line], cast: &[Line]) -> Vec<bool> {
    assert!(cast.iter().all(|ray| all.contains(ray)), "a ray that is none of the sensor's");
    all.iter().map(|ray| cast.contains(ray)).collect()
}

/// Bearing and distance from the hull [shares of the range], radius [m].
fn discs(most: usize) -> impl Strategy<Value = Vec<(f32, f32, f32)>> {
    prop::collection::vec((-PI..PI, 0.0_f32..1.4, 0.003_f32..0.2), 0..most)
}

/// Bearing and distance of a point [shares of the range], tilt against the way to it, ends on both sides of the point [m].
fn walls() -> impl Strategy<Value = Vec<(f32, f32, f32, [f32; 2])>> {
    prop::collection::vec((-PI..PI, 0.0_f32..1.4, -1.5_f32..1.5, prop::array::uniform2(0.0_f32..0.3)), 0..4)
}

/// A robot somewhere, that looks somewhere.
fn stance() -> impl Strategy<Value = ([f32; 2], f32)> {
    (prop::array::uniform2(-2.0_f32..2.0), -PI..PI)
}

proptest! {
    /// Groups read the largest of what all rays of their sensors read.
    #[test]
    fn groups_of_infrared_sensors_read_what_all_of_their_rays_read(
        (at, heading) in stance(), kind in 0_usize..3, few in discs(7), many in discs(90), crowded in 0..4, walls in walls(),
    ) {
        let robot = &robots()[kind];
        let (mut world, range) = (PlaneWorld::new(), robot.infrared.range as f32);
        let body = world.add_robot(robot, at, heading).body;
        for (bearing, share, radius) in if crowded == 0 { many } else { few } {
            world.add_disc(from(at, bearing, robot.radius as f32 + share * range + radius), radius, RED);
        }
        for (bearing, share, tilt, ends) in walls {
            let point = from(at, bearing, robot.radius as f32 + share * range);
            let [a, b] = [ends[0], -ends[1] - 0.01].map(|way| from(point, bearing + 0.5 * PI + tilt, way));
            world.add_wall([a, b], RED);
        }
        let all = read(&mut InfraredRays::for_robot(robot, body).unwrap(), &world);
        for count in (1..=all.len()).filter(|count| all.len() % count == 0) {
            let mut groups = InfraredGroups::for_robot(robot, body, count).unwrap();
            let values = read(&mut groups, &world);
            prop_assert_eq!(groups.ring(), &all[..]);
            // A sensor belongs to the group whose middle is nearest, of two to the later one.
            let size = all.len() / count;
            let mut expected = vec![0.0_f32; count];
            for (sensor, value) in all.iter().enumerate() {
                let group = (sensor + size / 2) / size % count;
                expected[group] = expected[group].max(*value);
            }
            prop_assert_eq!(&values, &expected, "{} groups of {:?}", count, all);
            let without_radius = Watched { without_radius: true, ..Watched::new(&world) };
            prop_assert_eq!(&without_radius.read(&mut groups).0, &expected, "{} groups of bodies of any form", count);
        }
    }

    /// Rays that pass the only thing that is near are not cast.
    #[test]
    fn groups_of_infrared_sensors_leave_out_rays_that_pass(
        (at, heading) in stance(), kind in 0_usize..3, (bearing, share) in (-PI..PI, 0.01_f32..0.95), radius in 0.003_f32..0.2,
        wall in any::<bool>(),
    ) {
        let robot = &robots()[kind];
        let [hull, range] = [robot.radius, robot.infrared.range].map(|x| x as f32);
        let mut world = PlaneWorld::new();
        let body = world.add_robot(robot, at, heading).body;
        let empty = world.clone();
        let (_, all) = Watched::new(&empty).read(&mut InfraredRays::for_robot(robot, body).unwrap());
        prop_assert_eq!(all.len(), robot.infrared.angles.len() * robot.infrared.rays);
        let centre = from(at, bearing, hull + share * range + radius);
        let foot = from(at, bearing, hull + share * range);
        let (sine, cosine) = farsa_num::sin_cos(bearing);
        if wall {
            world.add_wall([-5.0, 5.0].map(|way| from(foot, bearing + 0.5 * PI, way)), RED);
        } else {
            world.add_disc(centre, radius, RED);
        }
        let (_, cast) = Watched::new(&world).read(&mut InfraredGroups::for_robot(robot, body, 1).unwrap());
        for (ray, is_cast) in all.iter().zip(which(&all, &cast)) {
            let ahead = |p: [f32; 2]| (foot[0] - p[0]) * cosine + (foot[1] - p[1]) * sine;
            let gap = nearest(*ray, range + 1e-3, |p| if wall { ahead(p) } else { apart(p, centre) - radius });
            prop_assert!(is_cast || gap > 0.0, "a ray that meets is left out: {:?}", ray);
            prop_assert!(!is_cast || gap < 3e-4, "a ray that passes at {} m is cast: {:?}", gap, ray);
        }
        // A surface out of reach causes no ray.
        world.place(BodyId(1), from(at, bearing, hull + range + radius + 1e-3), 0.0);
        if !wall {
            let (values, cast) = Watched::new(&world).read(&mut InfraredGroups::for_robot(robot, body, 2).unwrap());
            prop_assert_eq!((values, cast), (vec![0.0; 2], vec![]));
        }
    }
}

#[test]
fn of_many_things_the_last_is_read_too() {
    let robot = MobileRobot::marxbot();
    // Several behind the robot, then one in front of it.
    let scene = |behind: u8| {
        let mut world = PlaneWorld::new();
        let body = world.add_robot(&robot, [0.3, -0.4], 0.0).body;
        for k in 0..behind {
            world.add_disc([0.15, -0.4 + 1e-3 * f32::from(k)], 0.01, RED);
        }
        world.add_disc([0.3 + 0.085 + 0.05 + 0.02, -0.4], 0.02, RED);
        (world, body)
    };
    for (behind, of_all) in [(3, false), (63, false), (64, true), (80, true)] {
        let (world, body) = scene(behind);
        let (values, cast) = Watched::new(&world).read(&mut InfraredGroups::for_robot(&robot, body, 8).unwrap());
        assert!((values[0] - 0.5).abs() < 1e-4 && values[4] > 0.4 && values[2] == 0.0, "{behind}: {values:?}");
        assert_eq!(cast.len() == 24 * 5, of_all, "{behind}: {} rays", cast.len());
    }
}

/// Bodies may be placed over a robot before the first step moves them apart. Rays that leave the robot next to a body
/// or wall over its middle hit it.
#[test]
fn what_lies_over_the_middle_of_the_robot_is_read_as_well() {
    let robot = MobileRobot::marxbot();
    let mut seen = 0;
    for depth in [-0.02, -1e-3, -1e-4, 0.0, 1e-6, 1e-5, 1e-4, 1e-3, 0.02] {
        for turn in 0_u8..60 {
            let (middle, bearing) = ([0.7, -0.3], 0.105 * f32::from(turn));
            for wall in [false, true] {
                let mut world = PlaneWorld::new();
                let body = world.add_robot(&robot, middle, 0.2).body;
                if wall {
                    let foot = from(middle, bearing, depth);
                    world.add_wall([-1.0, 1.0].map(|way| from(foot, bearing + 0.5 * PI, way)), RED);
                } else {
                    world.add_disc(from(middle, bearing, 1.0 - depth), 1.0, RED);
                }
                let all = read(&mut InfraredRays::for_robot(&robot, body).unwrap(), &world);
                let mut groups = InfraredGroups::for_robot(&robot, body, 24).unwrap();
                assert_eq!(read(&mut groups, &world), all, "{depth} m, {turn}, wall {wall}");
                let mut watched = Watched::new(&world);
                watched.without_radius = true;
                let mut groups = InfraredGroups::for_robot(&robot, body, 24).unwrap();
                assert_eq!(watched.read(&mut groups).0, all, "{depth} m, {turn}, wall {wall}, without a radius");
                seen += usize::from(depth > 0.0 && all.iter().any(|x| *x > 0.5));
            }
        }
    }
    assert!(seen > 0, "nothing is met beside the robot");
}

#[test]
fn rays_leave_at_half_the_height() {
    // Half of 30, 50 and 170 mm.
    for (robot, height) in robots().iter().zip([0.015, 0.025, 0.085]) {
        let mut world = PlaneWorld::new();
        let body = world.add_robot(robot, [0.0; 2], 0.0).body;
        let watched = Watched::new(&world);
        watched.read(&mut InfraredRays::for_robot(robot, body).unwrap());
        assert!((watched.height.get() - height).abs() < 1e-6, "{}: {} m", robot.name, watched.height.get());
    }
}

#[test]
fn a_group_lies_around_its_middle() {
    let robot = MobileRobot::marxbot();
    let degree = PI / 180.0;
    for bearing in [0, 14, 40, 45, 59, 90, 180, 315, 346] {
        let mut world = PlaneWorld::new();
        let body = world.add_robot(&robot, [0.1, 0.2], 0.7).body;
        world.add_disc(from([0.1, 0.2], 0.7 + f32::from(bearing as u16) * degree, 0.085 + 0.03), 0.01, RED);
        let values = read(&mut InfraredGroups::for_robot(&robot, body, 8).unwrap(), &world);
        // Groups of three sensors at 15 degrees, the first around straight ahead.
        let largest = (0..8).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap();
        assert_eq!(largest, (bearing + 22) / 45 % 8, "{bearing}: {values:?}");
        assert!((values[largest] - 0.8).abs() < 0.03, "{values:?}");
    }
}

fn eye(scale: f32, body: BodyId, aside: [f64; 2], field: f64) -> LinearCamera<Vec<Beam>, [ColorBand; 1]> {
    let beams = (0..60).map(|ray| Beam::in_view(aside.map(|x| x * f64::from(scale)), field, ray, 60)).collect();
    LinearCamera::new(body, beams, 20, [ColorBand::around(RED, 0.2)], 3.0 * scale).unwrap()
}

/// A robot among red and green discs, all lengths scaled. Bearing, distance from its center to the hull of the disc,
/// radius.
fn among(scale: f32, (at, heading): ([f32; 2], f32), discs: &[(f32, f32, f32, bool)]) -> (PlaneWorld, MobileParts) {
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&MobileRobot::khepera(), at.map(|x| x * scale), heading);
    for &(bearing, distance, radius, red) in discs {
        let centre = from(at, bearing, distance + radius).map(|x| x * scale);
        world.add_disc(centre, radius * scale, if red { RED } else { GREEN });
    }
    (world, parts)
}

fn red_and_green(most: usize) -> impl Strategy<Value = Vec<(f32, f32, f32, bool)>> {
    prop::collection::vec((-PI..PI, 0.05_f32..3.0, 0.005_f32..0.5, any::<bool>()), 0..most)
}

proptest! {
    /// With a red wall anywhere a camera has to cast all of its rays. Without it, the reading is equal at every place
    /// of the camera.
    #[test]
    fn a_camera_sees_the_same_with_all_rays(
        stance in stance(), discs in red_and_green(30), aside in prop::array::uniform2(-0.3_f64..0.3),
        field in prop::sample::select(vec![0.2, 0.9, 3.0, 3.2, 6.0]),
    ) {
        let (world, parts) = among(1.0, stance, &discs);
        let mut camera = eye(1.0, parts.body, aside, field);
        let (values, cast) = Watched::new(&world).read(&mut camera);
        let (expected, all) = Watched { phantom_wall: true, ..Watched::new(&world) }.read(&mut camera);
        prop_assert_eq!(all.len(), 60);
        prop_assert_eq!(&values, &expected);
        prop_assert_eq!(&Watched { without_radius: true, ..Watched::new(&world) }.read(&mut camera).0, &expected);
        prop_assert!(discs.iter().any(|disc| disc.3) || cast.is_empty(), "nothing red, but {} rays", cast.len());
    }

    /// Twice as large or a 64th of it: the same rays see the same.
    #[test]
    fn a_camera_knows_no_length(stance in stance(), discs in red_and_green(12), aside in prop::array::uniform2(-0.3_f64..0.3)) {
        let seen = |scale: f32| {
            let (world, parts) = among(scale, stance, &discs);
            let (values, cast) = Watched::new(&world).read(&mut eye(scale, parts.body, aside, 2.0));
            (values, cast.into_iter().map(|[from, along]| [from.map(|x| x / scale), along]).collect::<Vec<_>>())
        };
        let usual = seen(1.0);
        for scale in [2.0, 0.015_625, 1024.0] {
            prop_assert_eq!(&seen(scale), &usual, "{}", scale);
        }
    }

    /// Rays that hit a red disc are cast, and hardly any other.
    #[test]
    fn a_camera_leaves_out_rays_that_pass(
        stance in stance(), bearing in -PI..PI, distance in 0.3_f32..2.9, radius in 0.005_f32..0.5, behind in 0_usize..40,
        aside in prop::array::uniform2(-0.02_f64..0.02),
    ) {
        let (at, heading) = stance;
        // Far out of the view, on both sides and behind, as many as there may be.
        let mut discs: Vec<_> =
            (0..behind).map(|k| (heading + PI + 0.04 * (k as f32 - 20.0), 1.0 + 0.03 * k as f32, 0.01, true)).collect();
        discs.push((heading + 0.4 * bearing / PI, distance, radius.min(1.9 * distance), true));
        let (world, parts) = among(1.0, stance, &discs);
        let mut camera = eye(1.0, parts.body, aside, 1.0);
        let (_, cast) = Watched::new(&world).read(&mut camera);
        let (_, all) = Watched { phantom_wall: true, ..Watched::new(&world) }.read(&mut camera);
        let (bearing, distance, radius, _) = discs[behind];
        let centre = from(at, bearing, distance + radius);
        for (ray, is_cast) in all.iter().zip(which(&all, &cast)) {
            let gap = nearest(*ray, 8.0, |p| apart(p, centre) - radius);
            prop_assert!(is_cast || gap > 0.0, "a ray that meets is left out: {:?}", ray);
            // A hundredth of the radius and 2 mm a meter are for rounding.
            let much = 0.012 * radius + 2e-3 * (distance + radius) + 1e-3;
            prop_assert!(!is_cast || gap < much, "a ray that passes at {} m is cast: {:?}", gap, ray);
        }
    }
}

/// Every ray that hits a small distant thing is cast, and every ray that hits one near a robot whose rays begin far
/// behind it.
#[test]
fn a_camera_sees_small_things_to_their_edges() {
    for (distance, behind) in [(0.5, 0.0), (1.0, 0.0), (2.0, 0.0), (2.9, 0.0), (0.05, 1.0)] {
        for radius in [1e-3, 3e-3, 0.01] {
            let (world, parts) = among(1.0, ([0.4, -0.3], 0.8), &[(0.8, distance, radius, true)]);
            let field = f64::from(4.0 * radius / (distance + behind));
            let mut camera = eye(1.0, parts.body, [f64::from(-behind), 0.0], field);
            let (values, cast) = Watched::new(&world).read(&mut camera);
            let (expected, _) = Watched { phantom_wall: true, ..Watched::new(&world) }.read(&mut camera);
            // Half of the field is filled.
            let share: f32 = expected.iter().sum::<f32>() / 3.0;
            assert!((share - 0.5).abs() < 0.05 && cast.len() >= 28, "{distance} {radius}: {expected:?}");
            assert_eq!(values, expected, "{distance} {radius}");
        }
    }
}

#[test]
fn a_camera_sees_the_last_of_many_and_nothing_behind_it() {
    // Discs to the left, then one to the right.
    for count in [1, 15, 16, 17, 40] {
        let mut discs: Vec<_> = (0..count).map(|k| (0.4, 1.0 + 0.05 * f32::from(k as u8), 0.02, true)).collect();
        discs.push((-0.3, 1.0, 0.1, true));
        let (world, parts) = among(1.0, ([0.5, -0.25], 0.0), &discs);
        let (values, cast) = Watched::new(&world).read(&mut eye(1.0, parts.body, [0.0; 2], 1.0));
        assert!(values[2] > 0.3, "{count}: {values:?}");
        assert_eq!(cast.len() == 60, count > 15, "{count}: {} rays", cast.len());
    }
    // The backward extension of a ray hits the disc. The ray does not.
    let (world, parts) = among(1.0, ([0.5, -0.25], 0.3), &[(0.3 + PI, 1.0, 0.1, true)]);
    assert_eq!(Watched::new(&world).read(&mut eye(1.0, parts.body, [0.0; 2], 2.0 * f64::from(PI))).1.len(), 2);
    assert_eq!(Watched::new(&world).read(&mut eye(1.0, parts.body, [0.0; 2], 5.0)), (vec![0.0; 3], vec![]));
}
