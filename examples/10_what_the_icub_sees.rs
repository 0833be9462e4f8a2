//! The iCub follows a ball with its head by its left eye. The page shows the images of both eyes next to its strips.
//!
//! `cargo run --example 10_what_the_icub_sees [PAGE.html]`

use std::error::Error;
use std::fs;

use farsa::body::ports::{Actuated as _, Arrange as _, BodyId, Joints as _, Sensor as _, World as _};
use farsa::body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use farsa::body::robots::{Chain, Icub, JointControl};
use farsa::body::sensors::{Camera, ColorBand, ColorBlobs};
use farsa::body::{Pose, Recorder as _, Twist};
use farsa::physics::articulated::{Model, Options, World};
use farsa_view::{Page, Recording, Schema};

const RED: [f32; 3] = [0.9, 0.1, 0.1];
const RADIUS: f64 = 0.04;
/// The table's top, and where the ball starts [m].
const TOP: f64 = 0.12;
const START: [f64; 3] = [0.5, 0.2, TOP + RADIUS];

/// A table before the chest, a ball on it that can roll, and a board that hides a part of its way.
fn add_table(robot: &mut Robot) -> BodyId {
    let still = |name, half, at, color| Collider::new(name, None, Shape::Box { half }, Pose::at(at)).with_color(color);
    let table = robot.add_collider(still("table", [0.25, 0.45, 0.02], [0.45, 0.0, TOP - 0.02], [0.75, 0.6, 0.4]));
    robot.add_collider(still("board", [0.01, 0.06, 0.07], [0.38, -0.04, TOP + 0.07], [0.2, 0.4, 0.8]));
    let start = Joint::floating(Pose::at(START));
    let ball = robot.add_segment(Segment::new("ball", None, start, MassProperties::sphere(0.08, RADIUS)));
    let shape = Shape::Sphere { radius: RADIUS };
    let collider =
        robot.add_collider(Collider::new("ball", Some(ball), shape, Pose::identity()).with_color(RED.map(f64::from)));
    robot.add_pair([collider, table], Surface { friction: 0.5, rolling_friction: 0.0, stiffness: 1e5, damping: 100.0 });
    ball
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut icub = Icub { actuated: vec![Chain::Neck], control: JointControl::Velocity, ..Icub::default() };
    // The arms hang next to the table.
    for arm in [Chain::LeftArm, Chain::RightArm] {
        icub.posture.chain_mut(arm)[3] = icub.ranges(arm)[3][0];
    }
    let mut robot = icub.robot()?;
    robot.colliders.iter_mut().for_each(|collider| collider.color = Some([0.9, 0.9, 0.92]));
    let ball = add_table(&mut robot);
    let [yaw, pitch] = [icub.actuator("neck_yaw")?, icub.actuator("neck_pitch")?];
    let joints = [icub.joint("neck_yaw")?, icub.joint("neck_pitch")?];
    let mut world = World::new(Model::<f32>::new(&robot, &Options::default())?);

    // 32 x 24 pixels over 60 degrees, an eye each.
    let [left_eye, right_eye] = Icub::EYES.map(|eye| {
        let placement = Pose::at(eye.map(|x| x as f32));
        Camera::new(Icub::HEAD, placement, [32, 24], 60.0_f64.to_radians(), 3.0)
    });
    let mut right_eye = right_eye?;
    let mut blob = ColorBlobs::new(left_eye?, vec![ColorBand::around(RED, 0.2)])?;

    let schema = Schema::from_robot(&robot)
        .with_sensors(["to the left", "upwards", "size"])
        .with_scalars(["neck yaw [rad]", "neck pitch [rad]"])
        .with_image("left eye", [32, 24])
        .with_image("right eye", [32, 24]);
    let mut recording = Recording::new(schema);
    let slow = Twist { linear: [0.0, -0.15, 0.0], angular: [0.15 / RADIUS as f32, 0.0, 0.0] };
    // The head is turned to the ball at first, 0.4 rad to the left and 0.5 down.
    joints.iter().zip([0.4, -0.5]).for_each(|(joint, angle)| world.place_joint(*joint, angle, 0.0));
    world.place_body(ball, Pose::at(START.map(|x| x as f32)), slow);
    world.finish_placement();
    let (mut seen, mut centred, mut hidden) = ([0.0; 3], 0, 0);
    for step in 1..=80_u32 {
        blob.read(&world, &mut seen);
        right_eye.look(&world);
        let [left, up, size] = seen;
        // Where nothing red is seen, the head waits.
        world.command(yaw, [3.0 * left, 0.0]);
        world.command(pitch, [3.0 * up, 0.0]);
        (0..5).for_each(|_| world.step());
        hidden += u32::from(size == 0.0);
        centred += u32::from(size > 0.0 && left.abs() < 0.2 && up.abs() < 0.2);

        recording.world(&world).sensors(&seen);
        blob.camera().record(0, &mut recording);
        right_eye.record(1, &mut recording);
        recording.scalars(&joints.map(|joint| f64::from(world.position(joint))));
        recording.tick(0.05 * f64::from(step));
    }
    println!("the ball was in the middle of the left eye in {centred} of 80 steps, and hidden in {hidden}");
    let reds = |tick: usize| {
        let image = recording.image_at(tick, 1).into_iter().flatten();
        image.filter(|[red, green, _]| *red > 0.8 && *green < 0.2).count()
    };
    println!("the right eye saw it with {} pixels at first, {} at the end", reds(0), reds(79));
    assert!(centred > 40 && reds(79) > 5, "the head lost the ball");

    if let Some(path) = std::env::args().nth(1) {
        fs::write(path, Page::new("What the iCub sees").with("a ball that rolls by", recording).html())?;
    }
    Ok(())
}
