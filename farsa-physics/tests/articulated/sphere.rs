//! A ball on a plane and on a table against closed forms.

use farsa_body::ports::{Arrange, BodyId, Contacts, Kinematics, PairId, World as _};
use farsa_body::robot::{Collider, Joint, Pair, Robot, Segment, Shape, Surface};
use farsa_body::robots::Tabletop;
use farsa_body::{Pose, Twist};
use farsa_num::sin_cos;
use farsa_physics::articulated::{Model, Options, World};

const RADIUS: f64 = 0.025;
const MASS: f64 = 0.05;

fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

fn surface(friction: f64, rolling_friction: f64) -> Surface {
    Surface { friction, rolling_friction, stiffness: 1e5, damping: 300.0 }
}

fn ball_on(shape: Shape, placement: Pose<f64>, surface: Surface) -> Robot {
    let i = 0.4 * MASS * RADIUS * RADIUS;
    Robot {
        name: "ball".into(),
        segments: vec![Segment {
            name: "ball".into(),
            parent: None,
            joint: Joint::floating(Pose::at([0.0, 0.0, RADIUS])),
            mass: MASS,
            centre: [0.0; 3],
            inertia: [i, i, i, 0.0, 0.0, 0.0],
        }],
        colliders: vec![
            Collider {
                name: "ball".into(),
                body: Some(BodyId(0)),
                shape: Shape::Sphere { radius: RADIUS },
                placement: Pose::identity(),
                color: None,
            },
            Collider::new("ground", None, shape, placement),
        ],
        pairs: vec![Pair { colliders: [0, 1], surface, group: None, soft: None, restitution: 0.0 }],
        actuators: vec![],
        ..Robot::default()
    }
}

fn world(robot: &Robot, substeps: u32) -> World<f64> {
    World::new(Model::new(robot, &Options { substeps, ..Options::default() }).unwrap())
}

fn at(z: f64) -> Pose {
    Pose::at([0.0, 0.0, z as f32])
}

#[test]
fn a_falling_ball_follows_the_parabola() {
    let robot = ball_on(Shape::Plane, Pose::identity(), surface(1.0, 0.0));
    let mut w = world(&robot, 10);
    w.place_body(BodyId(0), at(5.0), Twist { linear: [1.0, 0.0, 0.0], angular: [0.0; 3] });
    w.finish_placement();
    for _ in 0..50 {
        w.step();
    }
    let p = w.pose_of(BodyId(0)).position;
    // Semi-implicit Euler falls g t h / 2 further than the parabola: 2.45 mm at 1 ms.
    assert!((p[2] - (5.0 - 0.5 * 9.81 * 0.25)).abs() < 2.5e-3, "{p:?}");
    assert!((p[0] - 0.5).abs() < 1e-9);
}

#[test]
fn a_sliding_ball_begins_to_roll_at_five_sevenths_of_its_speed() {
    for mu in [0.1, 0.3, 0.8] {
        let robot = ball_on(Shape::Plane, Pose::identity(), surface(mu, 0.0));
        let mut w = world(&robot, 5);
        w.place_body(BodyId(0), at(RADIUS), Twist { linear: [1.0, 0.0, 0.0], angular: [0.0; 3] });
        w.finish_placement();
        // Slides for 2 v / (7 mu g), then rolls.
        let slides = 2.0 / (7.0 * mu * 9.81);
        let steps = (slides / 0.01) as usize;
        for _ in 0..steps / 2 {
            w.step();
        }
        let t = (steps / 2) as f64 * 0.01;
        let v = w.velocity_of(BodyId(0));
        assert!((v.linear[0] - (1.0 - mu * 9.81 * t)).abs() < 0.01, "mu {mu}: {}", v.linear[0]);
        assert!((v.angular[1] - 2.5 * mu * 9.81 * t / RADIUS).abs() < 0.01 / RADIUS);
        for _ in 0..steps {
            w.step();
        }
        let v = w.velocity_of(BodyId(0));
        assert!((v.linear[0] - 5.0 / 7.0).abs() < 0.005, "mu {mu}: {}", v.linear[0]);
        assert!((v.angular[1] * RADIUS - v.linear[0]).abs() < 1e-4);
    }
}

#[test]
fn on_a_slope_the_contact_slips_if_and_only_if_the_slope_is_steeper_than_friction() {
    // A ball rolls down any slope. It slips where tan(angle) > 7/2 mu. A block of a prismatic-free body needs none of
    // this: a box on four corners slips where tan(angle) > mu.
    for (mu, angle, slips) in [
        (0.5_f64, 24.0_f64, false),
        (0.5, 29.0, true),
        (1.0, 43.0, false),
        (1.0, 47.0, true),
        (0.2, 10.0, false),
        (0.2, 13.0, true),
    ] {
        let half_angle = angle.to_radians() / 2.0;
        let (half_sin, half_cos) = sin_cos(half_angle);
        let (sin, cos) = sin_cos(angle.to_radians());
        let tilt = [0.0, half_sin, 0.0, half_cos];
        let mut robot = ball_on(Shape::Plane, Pose { position: [0.0; 3], rotation: tilt }, surface(mu, 0.0));
        robot.colliders[0].shape = Shape::Box { half: [RADIUS, RADIUS, RADIUS / 2.0] };
        let up = [sin * RADIUS / 2.0, 0.0, cos * RADIUS / 2.0];
        let mut w = world(&robot, 5);
        let pose = Pose { position: up, rotation: tilt };
        w.place_body(BodyId(0), pose.cast(), Twist::default());
        w.finish_placement();
        for _ in 0..100 {
            w.step();
        }
        let p = w.pose_of(BodyId(0)).position;
        let moved = length(p[0] - up[0], p[2] - up[2]);
        let slides = 0.5 * 9.81 * (sin - mu * cos);
        println!("mu {mu}, {angle} deg: moved {:.4} mm, sliding predicts {:.4} mm", moved * 1e3, slides * 1e3);
        if slips {
            assert!((moved - slides).abs() < 0.05 * slides + 1e-3, "mu {mu} angle {angle}: {moved} {slides}");
        } else {
            assert!(moved < 1e-3, "mu {mu} angle {angle}: {moved}");
        }
    }
}

#[test]
fn a_ball_on_a_slope_slips_if_and_only_if_the_slope_is_steeper_than_seven_halves_of_friction() {
    for (mu, angle) in [(0.1_f64, 17.0_f64), (0.1, 21.5), (0.2, 33.0), (0.2, 37.0), (0.4, 52.0), (0.4, 57.0)] {
        let ((sin, cos), (half_sin, half_cos)) = (sin_cos(angle.to_radians()), sin_cos(angle.to_radians() / 2.0));
        let tilt = [0.0, half_sin, 0.0, half_cos];
        let robot = ball_on(Shape::Plane, Pose { position: [0.0; 3], rotation: tilt }, surface(mu, 0.0));
        let mut w = world(&robot, 5);
        w.place_body(BodyId(0), Pose::at([sin * RADIUS, 0.0, cos * RADIUS]).cast(), Twist::default());
        w.finish_placement();
        for _ in 0..50 {
            w.step();
        }
        let v = w.velocity_of(BodyId(0));
        let speeds = [length(v.linear[0], v.linear[2]), v.angular[1] * RADIUS];
        // Half a second: rolling falls by 5/7 g sin. Slipping by g (sin - mu cos), turned by the moment of mu g cos.
        let slips = sin > 3.5 * mu * cos;
        let rolling = 5.0 / 7.0 * 9.81 * sin * 0.5;
        let slipping = [9.81 * (sin - mu * cos) * 0.5, 2.5 * mu * 9.81 * cos * 0.5];
        let expected = if slips { slipping } else { [rolling; 2] };
        println!("mu {mu}, {angle} deg: {speeds:.4?} m/s where {expected:.4?} are expected");
        for (speed, expected) in speeds.into_iter().zip(expected) {
            assert!((speed / expected - 1.0).abs() < 0.01, "mu {mu} angle {angle}: {speed} {expected}");
        }
        assert_eq!((speeds[0] - speeds[1]).abs() > 1e-3, slips, "mu {mu} angle {angle}: {speeds:?}");
    }
}

#[test]
fn a_ball_at_rest_stays_where_it_is() {
    let table = Shape::Box { half: [0.235, 0.4, 0.15] };
    // The surface of these tests, and the stiffer and less damped one of the experiment.
    let surfaces = [surface(1.0, 5e-4), Tabletop::default().sphere_on_table];
    for (surface, substeps) in
        surfaces.into_iter().flat_map(|surface| [2, 4, 5, 10].map(|substeps| (surface, substeps)))
    {
        let robot = ball_on(table, Pose::at([0.265, -0.15, -0.15]), surface);
        let mut w = world(&robot, substeps);
        w.place_body(BodyId(0), Pose::at([0.26, -0.18, RADIUS as f32]), Twist::default());
        w.finish_placement();
        for _ in 0..500 {
            w.step();
        }
        let p = w.pose_of(BodyId(0)).position;
        let drift = length(p[0] - f64::from(0.26_f32), p[1] + f64::from(0.18_f32));
        println!("{substeps}: sinks {:.2e} m, drifts {drift:.2e} m", RADIUS - p[2]);
        assert!(RADIUS - p[2] < 5e-4 && RADIUS - p[2] > 0.0);
        assert!(drift < 1e-4);
        let c = w.pair_contact(PairId(0));
        assert_eq!(c.points, 1);
        assert!((c.normal_force - (MASS * 9.81) as f32).abs() < 1e-3);
    }
}

#[test]
fn a_ball_pushed_over_the_edge_falls() {
    let table = Shape::Box { half: [0.235, 0.4, 0.15] };
    let robot = ball_on(table, Pose::at([0.265, -0.15, -0.15]), surface(1.0, 5e-4));
    let mut w = world(&robot, 5);
    w.place_body(
        BodyId(0),
        Pose::at([0.45, -0.18, RADIUS as f32]),
        Twist { linear: [0.5, 0.0, 0.0], angular: [0.0; 3] },
    );
    w.finish_placement();
    let mut lowest: f64 = 1.0;
    for _ in 0..100 {
        w.step();
        let p = w.pose(BodyId(0)).position;
        let outside = p[0] > 0.5;
        if !outside {
            lowest = lowest.min(f64::from(p[2]));
        }
    }
    assert!(lowest > RADIUS - 1e-3);
    assert!(w.pose(BodyId(0)).position[2] < 0.0);
}

#[test]
fn rolling_friction_stops_a_rolling_ball() {
    let robot = ball_on(Shape::Plane, Pose::identity(), surface(1.0, 5e-4));
    let mut w = world(&robot, 5);
    let v = 0.2_f32;
    w.place_body(BodyId(0), at(RADIUS), Twist { linear: [v, 0.0, 0.0], angular: [0.0, v / RADIUS as f32, 0.0] });
    w.finish_placement();
    // Deceleration of a rolling ball under the moment mu_r N: 5/7 g mu_r / r.
    let a = 5.0 / 7.0 * 9.81 * 5e-4 / RADIUS;
    for _ in 0..100 {
        w.step();
    }
    let speed = w.velocity_of(BodyId(0)).linear[0];
    assert!((speed - (0.2 - a)).abs() < 2e-3, "{speed} {}", 0.2 - a);
    for _ in 0..150 {
        w.step();
    }
    assert!(w.velocity_of(BodyId(0)).linear[0].abs() < 1e-6);
}

#[test]
fn only_near_surfaces_are_looked_at() {
    let robot = ball_on(Shape::Plane, Pose::identity(), surface(1.0, 0.0));
    let options = Options { substeps: 10, gravity: [0.0; 3], ..Options::default() };
    let mut w = World::<f64>::new(Model::new(&robot, &options).unwrap());
    let h = 0.001;
    for speed in [0.0_f32, 0.5, 2.0] {
        // The approach of the bounds within a step at this speed, turning included, and the way until the last step.
        let reach = options.margin + h * (f64::from(speed) + 1.5);
        let gap = reach + 9.0 * h * f64::from(speed);
        for (gap, near) in [(gap - 1e-5, 1), (gap + 1e-5, 0), (1.0, 0)] {
            w.place_body(BodyId(0), at(RADIUS + gap), Twist { linear: [0.0, 0.0, -speed], angular: [0.0; 3] });
            w.finish_placement();
            w.step();
            assert_eq!(w.near_pairs(), near, "{gap} m at {speed} m/s");
            assert!(!w.touches(PairId(0)));
        }
    }
    // A resting body on the plane is tested in every step.
    let mut w = world(&robot, 10);
    for _ in 0..20 {
        w.step();
    }
    assert!(w.touches(PairId(0)) && w.near_pairs() == 1);
}
