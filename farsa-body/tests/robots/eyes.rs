//! Cameras with an image, by hand and by the kit. A head that follows a thing.

use farsa_body::motors::{HeadTracking, ServoRange};
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Handles, JointId, Kinematics, Seen, Sensor, Vision,
};
use farsa_body::sensors::{Camera, CameraImage, ColorBand, ColorBlobs, VisualOffset};
use farsa_body::testing::{PointWorld, Promise, check_sensor, check_vision};
use farsa_body::{ChannelError, Pose, Twist};
use farsa_num::sin_cos;

fn tangent(angle: f64) -> f64 {
    let (sine, cosine) = sin_cos(angle);
    sine / cosine
}

/// Three balls of 2 cm, 10 cm apart along x, 1 m above the floor.
fn balls() -> PointWorld {
    let mut world = PointWorld::new(3);
    for joint in 0..3 {
        world.place_joint(JointId(joint), 1.0, 0.0);
    }
    world
}

/// On the first ball, which turns by 10 rad per meter of height. Its own rotation turns that back.
fn ahead(size: [usize; 2], field_of_view: f64) -> Camera {
    let rotation = {
        let (sine, cosine) = sin_cos(-5.0);
        [0.0, 0.0, sine, cosine]
    };
    Camera::new(BodyId(0), Pose { position: [0.0; 3], rotation }, size, field_of_view, 5.0).unwrap()
}

fn green() -> Vec<ColorBand> {
    vec![ColorBand::around(PointWorld::COLOR, 0.1)]
}

#[test]
fn a_place_is_in_the_pixel_that_looks_at_it() {
    let world = balls();
    let mut camera = ahead([9, 7], 1.2);
    let pose = camera.pose(&world);
    let half = tangent(0.6) as f32;
    for index in 0..63 {
        let [left, up] = camera.pixel(index);
        // By hand: columns of 2/9 of half the width, the upper left first.
        let by_hand = [1.0 - (2 * (index % 9) + 1) as f32 / 9.0, (7.0 - (2 * (index / 9) + 1) as f32) / 9.0];
        assert!((left - by_hand[0]).abs() < 1e-6 && (up - by_hand[1]).abs() < 1e-6, "{index}");
        let place = pose.transform([0.7, 0.7 * left * half, 0.7 * up * half]);
        let [l, u] = camera.project(&pose, place).unwrap();
        assert!((l - left).abs() < 1e-5 && (u - up).abs() < 1e-5);
    }
    assert_eq!(camera.project(&pose, pose.transform([-0.1, 0.0, 0.0])), None);
    // The second ball hides the third: its middle pixel is 8 cm away.
    let seen = camera.look(&world)[31].unwrap();
    assert!((seen.distance - 0.08).abs() < 1e-4 && seen.body == Some(BodyId(1)), "{seen:?}");
    assert_eq!(camera.colors().nth(31), Some(Some(PointWorld::COLOR)));
}

#[test]
fn a_blob_is_as_large_as_the_ball_looks() {
    let mut world = balls();
    let mut blobs = ColorBlobs::new(ahead([200, 200], 1.0), green()).unwrap();
    let mut x = [0.0; 3];
    blobs.read(&world, &mut x);
    // A ball of radius r at distance d is a disc of radius r / sqrt(d^2 - r^2) at distance 1, in a square of half width
    // tan 0.5.
    let radius = 0.02 / (0.1_f64 * 0.1 - 0.02 * 0.02).sqrt() / tangent(0.5);
    let share = core::f64::consts::PI * radius * radius / 4.0;
    assert!((f64::from(x[2]) - share).abs() < 0.01 * share, "{x:?}, {share}");
    assert!(x[0].abs() < 2e-3 && x[1].abs() < 2e-3);
    // Raised by 2 cm: 0.2 of the distance upwards.
    world.place_joint(JointId(1), 1.02, 0.0);
    world.place_joint(JointId(2), 9.0, 0.0);
    blobs.read(&world, &mut x);
    assert!((f64::from(x[1]) - 0.2 / tangent(0.5)).abs() < 0.02 && x[0].abs() < 2e-3, "{x:?}");
    let nowhere = vec![ColorBand::around([1.0, 0.0, 0.0], 0.1)];
    ColorBlobs::new(ahead([20, 20], 1.0), nowhere).unwrap().read(&world, &mut x);
    assert_eq!(x, [0.0; 3]);
}

#[test]
fn offsets_are_those_of_the_projection() {
    let world = balls();
    let (of, from) = ((BodyId(2), [0.0, 0.0, 0.0]), (BodyId(1), [0.0, 0.0, 0.0]));
    let mut x = [7.0; 2];
    VisualOffset::new(ahead([1, 1], 1.0), of, from).read(&world, &mut x);
    assert!(x.iter().all(|x| x.abs() < 1e-5), "{x:?}");
    // The third ball's point 4 cm above its middle, 20 cm ahead: 0.2 upwards, half of that in widths.
    VisualOffset::new(ahead([1, 1], 1.0), (BodyId(2), [0.0, 0.0, 0.04]), from).read(&world, &mut x);
    assert!(x[0].abs() < 1e-5 && (x[1] - 0.1 / tangent(0.5) as f32).abs() < 1e-4, "{x:?}");
    // Far aside is 1 at most, behind is 0.
    VisualOffset::new(ahead([1, 1], 1.0), (BodyId(1), [0.0, 0.0, 9.0]), from).read(&world, &mut x);
    assert!(x[1] == 1.0, "{x:?}");
    VisualOffset::new(ahead([1, 1], 1.0), (BodyId(0), [0.0, 0.0, 0.0]), from).read(&world, &mut x);
    assert_eq!(x, [0.0; 2]);
}

#[test]
fn the_kit_finds_them_in_order() {
    let world = balls();
    let of = (BodyId(2), [0.0, 0.01, 0.0]);
    assert_eq!(check_sensor(&mut CameraImage::new(ahead([5, 4], 1.0)), &world), Ok(()));
    assert_eq!(check_sensor(&mut ColorBlobs::new(ahead([5, 4], 1.0), green()).unwrap(), &world), Ok(()));
    assert_eq!(check_sensor(&mut VisualOffset::new(ahead([5, 4], 1.0), of, (BodyId(1), [0.0; 3])), &world), Ok(()));
    assert_eq!(CameraImage::new(ahead([5, 4], 1.0)).channels(), 60);
}

#[test]
fn what_cannot_be_is_refused() {
    let make = |placement: Pose, size, view, range| Camera::new(BodyId(0), placement, size, view, range).err();
    let here = Pose::identity();
    let none = ChannelError::Groups { field: "pixels", count: 0, size: 0 };
    assert_eq!(make(here, [0, 4], 1.0, 1.0), Some(none));
    assert!(make(here, [usize::MAX, 4], 1.0, 1.0).unwrap().to_string().contains("pixels"));
    for view in [0.0, -1.0, 3.2, f64::NAN] {
        assert!(make(here, [4, 4], view, 1.0).unwrap().to_string().starts_with("field of view is"));
    }
    for range in [0.0, f32::NAN, f32::INFINITY] {
        assert!(make(here, [4, 4], 1.0, range).unwrap().to_string().starts_with("range is"));
    }
    let long = Pose { rotation: [0.0, 0.0, 0.0, 1.1], ..here };
    assert!(make(long, [4, 4], 1.0, 1.0).unwrap().to_string().contains("rotation"));
    assert!(
        make(Pose { position: [f32::NAN, 0.0, 0.0], ..here }, [4, 4], 1.0, 1.0).unwrap().to_string().contains("place")
    );
    assert!(ColorBlobs::new(ahead([4, 4], 1.0), Vec::new()).is_err());
    let backwards = ColorBand { low: [0.5; 3], high: [0.4; 3] };
    assert_eq!(
        ColorBlobs::new(ahead([4, 4], 1.0), vec![backwards]).err(),
        Some(ChannelError::Range { from: 0.5, to: 0.4 })
    );
}

/// Ways to see wrongly.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Endless,
    OwnBody,
    Stale,
    Glaring,
    Stranger,
}

struct Broken(PointWorld, Fault);

impl Handles for Broken {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = farsa_body::ports::ActuatorId;
}

impl Vision for Broken {
    fn look(
        &self,
        from: [f32; 3],
        directions: &[[f32; 3]],
        range: f32,
        but: Option<BodyId>,
        seen: &mut [Option<Seen<BodyId>>],
    ) {
        let Self(world, fault) = self;
        let range = if matches!(fault, Fault::Endless) { 10.0 * range } else { range };
        let but = if matches!(fault, Fault::OwnBody) { None } else { but };
        let before: Vec<Option<Seen<BodyId>>> = seen.to_vec();
        world.look(from, directions, range, but, seen);
        for (seen, before) in seen.iter_mut().zip(before) {
            match fault {
                Fault::Stale => *seen = seen.or(before),
                Fault::Glaring => *seen = seen.map(|one| Seen { color: Some([2.0; 3]), ..one }),
                Fault::Stranger => *seen = seen.map(|one| Seen { body: Some(BodyId(99)), ..one }),
                Fault::Endless | Fault::OwnBody => {}
            }
        }
    }
}

#[test]
fn every_broken_promise_of_eyes_is_named() {
    let (bodies, origins) = ([BodyId(0), BodyId(1), BodyId(2)], [[0.05, 0.0, 1.0], [0.25, 0.0, 1.05]]);
    assert_eq!(check_vision(&balls(), &bodies, &origins, 1.5), Ok(()));
    for fault in [Fault::Endless, Fault::OwnBody, Fault::Stale, Fault::Glaring, Fault::Stranger] {
        let range = if matches!(fault, Fault::Endless) { 0.6 } else { 1.5 };
        let checked = check_vision(&Broken(balls(), fault), &bodies, &origins, range);
        assert_eq!(checked.map_err(|error| error.promise), Err(Promise::Vision), "{fault:?}");
    }
    let nothing = check_vision(&balls(), &bodies, &[[5.0, 5.0, 1.0]], 0.5);
    assert_eq!(nothing.map_err(|error| error.promise), Err(Promise::Vision));
}

/// A head on two servos that are at once where they shall be: it turns to the left, then upwards about its own axis.
struct Neck {
    desired: [f32; 2],
    target: [f32; 3],
}

impl Handles for Neck {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl Kinematics for Neck {
    fn pose(&self, body: BodyId) -> Pose {
        if body == BodyId(1) {
            return Pose::at(self.target);
        }
        let about = |axis: [f32; 3], angle: f32| {
            let (sine, cosine) = sin_cos(0.5 * angle);
            let [x, y, z] = axis.map(|a| a * sine);
            Pose { position: [0.0; 3], rotation: [x, y, z, cosine] }
        };
        about([0.0, 0.0, 1.0], self.desired[0]).compose(&about([0.0, -1.0, 0.0], self.desired[1]))
    }
    fn velocity(&self, _: BodyId) -> Twist {
        Twist::default()
    }
}

impl Actuated for Neck {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        self.desired[actuator.index()] = value[0];
    }
}

/// Servo 0 turns to the left by 0.8 rad at most, servo 1 upwards by 0.5 rad.
fn tracking() -> HeadTracking {
    let servos =
        [(0, 0.8), (1, 0.5)].map(|(servo, most)| ServoRange { servo: ActuatorId(servo), from: -most, to: most });
    HeadTracking::new((BodyId(0), Pose::identity()), (BodyId(1), [0.0; 3]), servos, [0.0; 2], 0.5, 0.1).unwrap()
}

#[test]
fn a_head_turns_to_what_it_follows() {
    let mut reflex = tracking();
    // At 45 degrees to the left and, from there, below.
    let mut world = Neck { desired: [0.0; 2], target: [1.0, 1.0, -0.4] };
    let first = reflex.angles(&world).unwrap();
    assert!((first[0] - core::f32::consts::FRAC_PI_4).abs() < 1e-6 && first[1] < -0.3, "{first:?}");
    reflex.step(&mut world);
    assert_eq!(world.desired, [0.1, -0.1]);
    for _ in 0..60 {
        reflex.step(&mut world);
    }
    let [left, up] = reflex.angles(&world).unwrap();
    assert!(left.abs() < 1e-4 && up.abs() < 1e-4, "{left} {up}");
    assert!((world.desired[0] - core::f32::consts::FRAC_PI_4).abs() < 1e-4, "{:?}", world.desired);
    // Beyond a limit it stays there. Things behind it do not move it.
    world.target = [0.5, 1.0, 0.0];
    (0..60).for_each(|_| reflex.step(&mut world));
    assert_eq!(world.desired[0], 0.8);
    world.target = [-1.0, -1.0, 0.0];
    let before = world.desired;
    reflex.step(&mut world);
    assert_eq!((reflex.angles(&world), world.desired), (None, before));
    reflex.reset();
    assert_eq!(reflex.desired(), [0.0; 2]);
}

/// A servo whose positions grow to the right and downwards is equivalent to one with the reversed range.
#[test]
fn the_sign_of_a_servo_is_that_of_its_range() {
    let servos =
        [(0, 0.8), (1, 0.5)].map(|(servo, most)| ServoRange { servo: ActuatorId(servo), from: most, to: -most });
    let eye = (BodyId(0), Pose::identity());
    let mut turned = HeadTracking::new(eye, (BodyId(1), [0.0; 3]), servos, [0.0; 2], 0.5, 0.1).unwrap();
    let mut plain = tracking();
    let [mut a, mut b] = [0, 1].map(|_| Neck { desired: [0.0; 2], target: [1.0, 0.7, 0.2] });
    plain.step(&mut a);
    turned.step(&mut b);
    assert_eq!(a.desired, b.desired.map(|x| -x));
}

#[test]
fn a_head_that_cannot_turn_is_refused() {
    let make = |low: f32, high: f32, start: f32, gain: f32, most: f32| {
        let servos = [0, 1].map(|servo| ServoRange { servo: ActuatorId(servo), from: low, to: high });
        let eye = (BodyId(0), Pose::identity());
        HeadTracking::new(eye, (BodyId(1), [0.0; 3]), servos, [start; 2], gain, most).err()
    };
    assert_eq!(make(-1.0, 1.0, 0.5, 0.5, 0.1), None);
    assert_eq!(make(1.0, -1.0, 0.5, 1.0, 0.1), None);
    assert_eq!(make(1.0, 1.0, 1.0, 0.5, 0.1), Some(ChannelError::Range { from: 1.0, to: 1.0 }));
    assert!(matches!(make(-1.0, f32::NAN, 0.0, 0.5, 0.1), Some(ChannelError::Range { .. })));
    let value = |field, value| Some(ChannelError::Value { field, value });
    assert_eq!(make(-1.0, 1.0, 1.5, 0.5, 0.1), value("start", 1.5));
    assert_eq!(make(-1.0, 1.0, 0.0, 1.5, 0.1), value("gain", 1.5));
    assert_eq!(make(-1.0, 1.0, 0.0, 0.0, 0.1), value("gain", 0.0));
    assert_eq!(make(-1.0, 1.0, 0.0, 0.5, 0.0), value("most", 0.0));
}
