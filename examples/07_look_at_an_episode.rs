//! Records a custom loop as a page for a browser and a picture of its end.
//!
//! `cargo run --example 07_look_at_an_episode [PAGE.html [PICTURE.svg]]`

use std::error::Error;
use std::fs;

use farsa::body::Recorder as _;
use farsa::body::motors::{ServoGroup, ServoRange};
use farsa::body::ports::{Kinematics as _, Motor as _, Sensor as _, World as _};
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::body::sensors::JointPosition;
use farsa::physics::articulated::{Model, Options, World};
use farsa_view::{Camera, Page, Picture, Recording, Schema};

fn main() -> Result<(), Box<dyn Error>> {
    let arm = ArmAndHand::default();
    let robot = Tabletop::default().scene(&arm)?;
    let mut world = World::new(Model::<f32>::new(&robot, &Options::default())?);

    // The arm hangs limp while the hand opens and closes. The sensors are the index finger's joints, 1 when straight.
    let index = ArmAndHand::joints().into_iter().skip(12).take(3).map(|joint| JointPosition::new(joint, -1.6, 0.0));
    let mut sensors = index.collect::<Result<Vec<_>, _>>()?;
    let groups = arm.servo_groups().into_iter().map(ServoGroup::<Vec<ServoRange>>::new);
    let mut motors = groups.collect::<Result<Vec<_>, _>>()?;
    let (mut x, mut y) = ([0.0; 3], [0.0; 9]);

    let schema = Schema::from_robot(&robot).with_sensors(["J13", "J14", "J15"]).with_scalars(["palm's height [m]"]);
    let outputs: Vec<String> = (1..=9).map(|group| format!("group {group}")).collect();
    let mut recording = Recording::new(schema.with_outputs(outputs));
    for tick in 1..=400_u32 {
        sensors.read(&world, &mut x);
        y.fill(if tick / 50 % 2 == 0 { 0.0 } else { 0.9 });
        motors.drive(&y, &mut world);
        world.step();

        recording.world(&world).sensors(&x);
        recording.outputs(&y);
        recording.scalars(&[f64::from(world.pose(ArmAndHand::PALM).position[2])]);
        recording.tick(0.01 * f64::from(tick));
    }

    let mut picture = Picture { caption: Some("after 4 s".into()), ..Picture::default() };
    picture.add_robot(&robot, |body| world.pose(body).cast());
    let svg = picture.svg(Camera::named("three-quarter")?, [600, 400], "end-");
    let ticks = recording.times().len();
    let closed = recording.row(99).nth(1).unwrap_or_default();
    let html = Page::new("A hand that opens and closes").with("limp arm", recording).html();
    println!("{ticks} ticks, a page of {} KB, a picture of {} KB", html.len() / 1024, svg.len() / 1024);
    assert!(ticks == 400 && closed < 0.5, "the index finger stayed open: {closed}");

    let mut paths = std::env::args().skip(1);
    if let Some(path) = paths.next() {
        fs::write(path, html)?;
    }
    if let Some(path) = paths.next() {
        fs::write(path, svg)?;
    }
    Ok(())
}
