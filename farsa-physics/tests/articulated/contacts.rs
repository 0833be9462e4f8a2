//! Where and when contacts are: the point of a pair, pairs in groups that close fast, and stops that they drive joints into.

use farsa_body::ports::{Arrange as _, BodyId, Contacts as _, JointId, Kinematics as _, World as _};
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa_body::{Pose, Twist};
use farsa_physics::articulated::{Model, Options, World};

const SURFACE: Surface = Surface { friction: 0.5, rolling_friction: 0.0, stiffness: 2e4, damping: 60.0 };

fn world(robot: &Robot, options: Options) -> World<f32> {
    World::new(Model::new(robot, &options).unwrap())
}

/// A box whose mass is off its middle presses most where the mass is. The mean over its corners, weighted by their
/// forces, is below the center of mass, or the box would turn.
#[test]
fn a_box_presses_below_its_centre_of_mass() {
    let centre = [0.03, -0.02, 0.0];
    let at = [0.7, -0.4, 0.04];
    let mut robot = Robot::new("box");
    let half = [0.1, 0.06, 0.04];
    let mass = MassProperties { mass: 0.8, centre, inertia: [0.002, 0.003, 0.004, 0.0, 0.0, 0.0] };
    let body = robot.add_segment(Segment::new("box", None, Joint::floating(Pose::at(at)), mass));
    let sides = Collider::new("box", Some(body), Shape::Box { half }, Pose::identity());
    let ground = Collider::new("ground", None, Shape::Plane, Pose::identity());
    let colliders = [sides, ground].map(|collider| robot.add_collider(collider));
    let pair = robot.add_pair(colliders, SURFACE);
    let mut world = world(&robot, Options::default());
    for _ in 0..200 {
        world.step();
    }
    let contact = world.pair_contact(pair);
    assert!(contact.points >= 4 && (contact.normal_force - 0.8 * 9.81).abs() < 0.01, "{contact:?}");
    let expected = [at[0] + centre[0], at[1] + centre[1], 0.0];
    for (x, y) in contact.point.into_iter().zip(expected) {
        assert!((f64::from(x) - y).abs() < 1e-3, "{contact:?}, not {expected:?}");
    }
}

/// A third ball hits one of two resting balls. It crosses more than the watched margin in a dynamics step, 30 mm.
fn thrown(grouped: bool, distance: f64) -> Vec<u32> {
    const RADIUS: f64 = 0.02;
    let mut robot = Robot::new("balls");
    let places = [("thrown", [0.0, 0.0, 0.0]), ("hit", [distance, 0.0, 0.0]), ("missed", [distance, 0.06, 0.0])];
    let balls = places.map(|(name, place)| {
        let ball = Collider::new(name, None, Shape::Sphere { radius: RADIUS }, Pose::identity());
        let joint = Joint::floating(Pose::at(place));
        let body = robot.add_segment(Segment::new(name, None, joint, ball.mass_properties(0.05)));
        robot.add_collider(Collider { body: Some(body), ..ball })
    });
    let pairs = [[balls[0], balls[1]], [balls[0], balls[2]]];
    if grouped {
        robot.add_pair_group(pairs, SURFACE);
    } else {
        for pair in pairs {
            robot.add_pair(pair, SURFACE);
        }
    }
    let mut world = world(&robot, Options { gravity: [0.0; 3], ..Options::default() });
    world.place_body(BodyId(0), Pose::identity(), Twist { linear: [12.0, 0.0, 0.0], angular: [0.0; 3] });
    world.finish_placement();
    let mut motion = Vec::new();
    for _ in 0..10 {
        world.step();
        motion.extend((0..3).flat_map(|body| world.velocity(BodyId(body)).linear).map(f32::to_bits));
    }
    assert!(world.velocity(BodyId(1)).linear[0] > 6.0, "{distance} m away it is not hit");
    motion
}

#[test]
fn what_is_thrown_at_a_group_meets_it_as_alone() {
    for millimetres in (500..530).step_by(3) {
        let distance = f64::from(millimetres) / 1000.0;
        assert_eq!(thrown(true, distance), thrown(false, distance), "{distance} m away");
    }
}

/// A ball drives a sliding hand from just before the end of its way past it within a step. The stop acts in that step
/// by its spring, k = I f^2, at the place that the hand reaches.
#[test]
fn a_stop_answers_a_contact_in_the_same_step() {
    let (base_mass, hand_mass, ball_mass) = (1.5, 0.2, 0.5);
    for (floating, upwards) in [(false, true), (false, false), (true, true), (true, false)] {
        let side = if upwards { 1.0 } else { -1.0 };
        let mut robot = Robot::new("press");
        let start = Joint::floating(Pose::identity());
        let base = Segment::new("base", None, start, MassProperties::sphere(base_mass, 0.1));
        let base = floating.then(|| robot.add_segment(base));
        // A way that begins at 0 on one side, and ends there on the other.
        let range = if upwards { [-0.5, 0.0] } else { [0.0, 0.5] };
        let slide = Joint::prismatic("slide", [0.0, 0.0, 1.0], Pose::at([0.0, 0.0, 0.3]), range);
        let hand = robot.add_segment(Segment::new("hand", base, slide, MassProperties::sphere(hand_mass, 0.05)));
        let joint = JointId(hand.0);
        let behind = 0.3 - side * 0.0996;
        let ball = Joint::floating(Pose::at([0.0, 0.0, behind]));
        let ball = robot.add_segment(Segment::new("ball", None, ball, MassProperties::sphere(ball_mass, 0.05)));
        let pair = [("hand", hand), ("ball", ball)].map(|(name, body)| {
            robot.add_collider(Collider::new(name, Some(body), Shape::Sphere { radius: 0.05 }, Pose::identity()))
        });
        robot.add_pair(pair, Surface { friction: 0.0, ..SURFACE });
        let options = Options { gravity: [0.0; 3], time_step: 1e-3, substeps: 1, sweeps: 200, ..Options::default() };
        let model = Model::<f64>::new(&robot, &options).unwrap();
        let (place, _) = model.joint_index(joint).unwrap();
        let mut world = World::new(model);
        world.state_mut()[place] = -side * 2e-4;
        let pose = Pose::at([0.0, 0.0, behind as f32]);
        world.place_body(ball, pose, Twist { linear: [0.0, 0.0, side as f32 * 3.0], angular: [0.0; 3] });
        world.finish_placement();
        world.step();
        let speed = |body| world.velocity_of(body).linear[2];
        let (lost, gained) = (ball_mass * (side * 3.0 - speed(ball)), hand_mass * speed(hand));
        let impulse = lost - gained;
        let past = world.positions()[place];
        let frequency = options.limit_frequency;
        let expected = options.time_step * hand_mass * frequency * frequency * past;
        assert!(side * past > 1e-5 && side * lost > 0.1, "{past} m past the stop, {lost} N s from the ball");
        assert!((impulse - expected).abs() < 1e-6 * expected.abs(), "{impulse} and {expected} N s");
        let base = base.map_or(impulse, |base| base_mass * speed(base));
        assert!((base - impulse).abs() < 1e-9, "{base} and {impulse} N s");
    }
}

/// Returns whether a ball of a mass [kg] and radius [m] that hits a wall of a thickness [m] at a speed stays in front.
fn stays_in_front(mass: f64, radius: f64, thickness: f64, speed: f64, damping: f64) -> bool {
    let mut robot = Robot::new("wall");
    let ball = robot.add_segment(Segment::new(
        "ball",
        None,
        Joint::floating(Pose::at([-0.2 - radius, 0.0, 0.0])),
        MassProperties::sphere(mass, radius),
    ));
    let half = [0.5 * thickness, 1.0, 1.0];
    let skin = Collider::new("ball", Some(ball), Shape::Sphere { radius }, Pose::identity());
    let wall = Collider::new("wall", None, Shape::Box { half }, Pose::identity());
    let pair = [skin, wall].map(|collider| robot.add_collider(collider));
    robot.add_pair(pair, Surface { damping, stiffness: 1e5, ..SURFACE });
    let mut world = world(&robot, Options { gravity: [0.0; 3], ..Options::default() });
    let twist = Twist { linear: [speed as f32, 0.0, 0.0], angular: [0.0; 3] };
    world.place_body(ball, Pose::at([(-0.2 - radius) as f32, 0.0, 0.0]), twist);
    world.finish_placement();
    (0..200).for_each(|_| world.step());
    world.pose(ball).position[0] < 0.0
}

/// A spring k stops a mass m at a speed v within v sqrt(m / k). The nearest face of a wall changes in its middle, so a
/// ball stays in front up to (radius + thickness / 2) sqrt(k / m). Damping and the implicit step only add to that.
#[test]
fn a_ball_stays_in_front_of_a_wall_up_to_the_documented_speed() {
    let mut passed = 0;
    for mass in [0.02, 0.5, 1.0, 5.0, 30.0] {
        for (radius, thickness) in [(0.02, 0.01), (0.04, 0.01), (0.01, 0.05), (0.03, 0.002)] {
            let limit = (radius + 0.5 * thickness) * (1e5_f64 / mass).sqrt();
            for damping in [0.0, 300.0] {
                for share in [0.1, 0.5, 0.97] {
                    let held = stays_in_front(mass, radius, thickness, share * limit, damping);
                    assert!(held, "{mass} kg, {radius} m, {thickness} m, {share} of {limit} m/s, damping {damping}");
                }
            }
            passed += usize::from(!stays_in_front(mass, radius, thickness, 1.5 * limit, 0.0));
        }
    }
    assert!(passed >= 4, "the limit is far below the speed at which balls pass: {passed}");
}
