//! A custom arm kicks a ball: described, checked, moved, drawn, exported.

use std::error::Error;
use std::fs;

use farsa::body::actuators::{Law, MusclePair, Servo};
use farsa::body::motors::{Muscles, ServoGroup, ServoRange};
use farsa::body::ports::{Contacts as _, JointId, Joints as _, Kinematics as _, Motor as _, World as _};
use farsa::body::robot::{Collider, Joint, MassProperties, Robot, RobotError, Segment, Shape, Surface};
use farsa::body::testing::{Probe, check_arrange, check_world};
use farsa::body::{Pose, Recorder as _};
use farsa::physics::articulated::{Model, Options, World};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::urdf;
use farsa_view::{Camera, Page, Recording, Schema};

const SHOULDER: [f64; 2] = [-1.5, 1.5]; // rad
const ELBOW: [f64; 2] = [0.0, 2.0];

/// Two links that swing in the plane of x and z: a pair of muscles at the shoulder, a servo at the elbow, a ball for a hand.
fn arm() -> Result<Robot, RobotError> {
    let mut robot = Robot::new("kicker");

    // Both links hang down when their joints are at 0. The axis -y makes growing angles swing ahead, along x.
    let (thick, upper, lower) = (0.02, 0.30, 0.25);
    let joint = |name, at, range| Joint::revolute(name, [0.0, -1.0, 0.0], Pose::at(at), range).with_damping(0.05);
    let link = |mass: f64, length: f64| {
        let along = Pose::at([0.0, 0.0, -0.5 * length]);
        MassProperties::capsule(mass, thick, 0.5 * length).placed(&along)
    };
    let shoulder = joint("shoulder", [0.0, 0.0, 0.62], SHOULDER);
    let upper_arm = robot.add_segment(Segment::new("upper arm", None, shoulder, link(0.6, upper)));
    let elbow = joint("elbow", [0.0, 0.0, -upper], ELBOW);
    let hand = MassProperties::sphere(0.2, 0.04).placed(&Pose::at([0.0, 0.0, -lower]));
    let forearm = robot.add_segment(Segment::new("forearm", Some(upper_arm), elbow, link(0.4, lower).with(&hand)));

    // Visible and touchable shapes. They have no mass, the segments have.
    let bone =
        |name, body, length: f64| Collider::capsule_between(name, Some(body), [0.0; 3], [0.0, 0.0, -length], thick);
    robot.add_collider(bone("upper arm", upper_arm, upper));
    robot.add_collider(bone("forearm", forearm, lower));
    let hand = Collider::new("hand", Some(forearm), Shape::Sphere { radius: 0.04 }, Pose::at([0.0, 0.0, -lower]));
    let hand = robot.add_collider(hand);

    // A ball on the ground in front of it, and which bodies may touch.
    let start = Joint::floating(Pose::at([0.12, 0.0, 0.05]));
    let ball = robot.add_segment(Segment::new("ball", None, start, MassProperties::sphere(0.1, 0.05)));
    let skin = Collider::new("ball", Some(ball), Shape::Sphere { radius: 0.05 }, Pose::identity());
    let skin = robot.add_collider(skin);
    let ground = robot.add_collider(Collider::new("ground", None, Shape::Plane, Pose::identity()));
    let rubber = Surface { friction: 0.8, rolling_friction: 5e-3, stiffness: 2e4, damping: 100.0 };
    for pair in [[skin, hand], [skin, ground], [hand, ground]] {
        robot.add_pair(pair, rubber);
    }

    // A joint has the number of the segment that it carries.
    let muscles = MusclePair::thesis(300.0, 0.03, SHOULDER);
    robot.add_actuator("shoulder", JointId(upper_arm.0), Law::MusclePair(muscles));
    let servo = Servo { stiffness: 20.0, damping: 0.5, limit: 6.0 };
    robot.add_actuator("elbow", JointId(forearm.0), Law::Servo(servo));
    robot.validate()?;
    Ok(robot)
}

fn main() -> Result<(), Box<dyn Error>> {
    let robot = arm()?;
    let model = Model::<f32>::new(&robot, &Options::default())?;
    let make = || World::new(model.clone());
    check_world(make, &Probe::for_robot(&robot))?;
    check_arrange(make, &Probe::for_robot(&robot))?;
    println!(
        "{}: {} joints, {} actuators; the world keeps its promises",
        robot.name,
        robot.joints().count(),
        robot.actuators.len()
    );

    // By name once, by number in the loop.
    let part = |name: &str| robot.actuator(name).ok_or(format!("no actuator {name}"));
    let [low, high] = ELBOW.map(|angle| angle as f32);
    let elbow = [ServoRange { servo: part("elbow")?, from: low, to: high }];
    let mut motors = (Muscles::new(part("shoulder")?), ServoGroup::new(elbow)?);
    let joints = robot.joints().collect::<Vec<_>>();
    let ball = robot.body("ball").ok_or("no ball")?;
    let kick = robot.pair("hand", "ball").ok_or("no such pair")?;

    let schema = Schema::from_robot(&robot).with_outputs(["back", "ahead", "elbow"]).with_scalars(["ball [m]"]);
    let mut recording = Recording::new(schema);
    let mut world = make();
    let (mut kicks, mut seen) = (0, 0);
    for tick in 1..=300_u32 {
        // Back with a bent elbow, then ahead with a straight one. The first muscle pulls to the lower end of the range.
        let y = if tick <= 100 { [0.5, 0.0, 0.3] } else { [0.0, 0.8, 0.1] };
        motors.drive(&y, &mut world);
        world.step(); // 10 ms
        let away = f64::from(world.pose(ball).position[0]);
        if world.touches(kick) {
            kicks += 1;
            seen = tick - 1; // of the recording, which begins at 0
        }
        recording.world(&world).outputs(&y);
        recording.scalars(&[away]);
        recording.tick(0.01 * f64::from(tick));
        if tick % 50 == 0 {
            let [shoulder, elbow] = [joints[0], joints[1]].map(|joint| world.position(joint));
            println!(
                "{:.1} s: shoulder {shoulder:>5.2}, elbow {elbow:>4.2} rad, ball at {away:.2} m",
                0.01 * f64::from(tick)
            );
        }
    }
    assert!(world.is_finite() && kicks > 0 && world.pose(ball).position[0] > 0.5, "no kick");

    let picture = recording.picture(seen as usize).ok_or("nothing to see")?;
    fs::write("kick.svg", picture.svg(Camera::named("side")?, [600, 400], "kick-"))?;
    fs::write("kick.html", Page::new("Kick").with("kicker", recording).html())?;
    fs::write("kicker.xml", mjcf::write(&robot, &MjcfOptions::default())?)?;
    fs::write("kicker.urdf", urdf::write(&robot)?)?;
    println!("{kicks} ticks of touch; kick.svg, kick.html, kicker.xml, kicker.urdf");
    Ok(())
}
