//! Lamps, ground, signals, attachment and measured infrared, in the world of the plane.

use core::f32::consts::PI;
use std::path::{Path, PathBuf};

use crate::shared::{RED, bands, read};
use farsa_body::motors::{AttachmentMotor, Leds, SignalMotor};
use farsa_body::ports::{
    Actuated, ActuatorId, BodyId, Handles, JointId, Kinematics, Lamp, Motor, NearbySurface, Planar, PlanarHit, Sensor,
    Sight,
};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::infrared::{InfraredFormula, InfraredTable, InfraredTables, SampledInfrared};
use farsa_body::sensors::{AttachmentSensor, Beam, ColorBand, GroundColor, LightSensors, LinearCamera, SignalSensor};
use farsa_body::testing::{PlaneWorld, check_motor, check_sensor};
use farsa_body::{ChannelError, Pose, Twist};
use proptest::prelude::*;

/// A `MarXbot` that looks along x, with things around it.
fn scene() -> (PlaneWorld, MobileParts) {
    let mut world = PlaneWorld::new();
    world.add_wall([[2.0, -5.0], [2.0, 5.0]], [1.0; 3]);
    let parts = world.add_robot(&MobileRobot::marxbot(), [0.0, 0.0], 0.0);
    world.add_disc([1.0, 0.2], 0.2, RED);
    world.add_lamp([-1.0, 0.5], 0.01, 2.0);
    world.add_area([0.0, 0.0], 0.05, [0.2, 0.4, 0.9]);
    let other = world.add_robot(&MobileRobot::marxbot(), [0.0, -0.2], 1.0);
    world.command(other.signal.unwrap(), [0.75, 0.0]);
    world.command(other.leds.unwrap()[2], [1.0, 0.0]);
    (world, parts)
}

/// Builds a table of a Khepera's size whose readings encode their place.
fn table(sensors: usize, offset: usize) -> InfraredTable {
    let mut lines = vec![format!("{sensors} 4 3 5 2")];
    for distance in 0..3 {
        lines.push(format!("TURN {distance}"));
        for angle in 0..4 {
            let readings: Vec<String> =
                (0..sensors).map(|s| (offset + 100 * distance + 10 * angle + s).to_string()).collect();
            lines.push(readings.join(" "));
        }
    }
    lines.push("END".into());
    InfraredTable::parse(&lines.join("\n")).unwrap()
}

fn tables() -> InfraredTables {
    InfraredTables::new(table(8, 0), vec![(0.0125, table(8, 300)), (0.027, table(8, 600))]).unwrap()
}

#[test]
fn sensors_and_motors_keep_their_promises() {
    let ((world, parts), robot) = (scene(), MobileRobot::marxbot());
    let places: Vec<[f32; 2]> = robot.ground.iter().map(|place| place.map(|x| x as f32)).collect();
    let b = parts.body;
    let tables = tables();
    let view: [Beam; 6] = core::array::from_fn(|ray| Beam::in_view([0.05, 0.0], 0.6, ray, 6));
    let mut sensors: Vec<Box<dyn Sensor<PlaneWorld> + '_>> = vec![
        Box::new(GroundColor::new(b, &places).unwrap()),
        Box::new(GroundColor::new(b, [[0.0, 0.0], [1.0, 0.0]]).unwrap().rgb()),
        Box::new(LightSensors::for_robot(&robot, b, 0.5).unwrap()),
        Box::new(LinearCamera::for_view(b, 2.0, 3, 8, bands(), 4.0).unwrap()),
        Box::new(LinearCamera::new(b, view, 3, bands()[..1].to_vec(), 4.0).unwrap()),
        Box::new(SignalSensor::<4>::new(b, 1.0).unwrap()),
        Box::new(SignalSensor::<5>::new(b, 1.0).unwrap().mean()),
        Box::new(AttachmentSensor::new(b)),
        Box::new(SampledInfrared::new(b, 0.085, &tables).unwrap()),
        Box::new(SampledInfrared::new(b, 0.085, std::rc::Rc::new(tables.clone())).unwrap().first(6).unwrap()),
    ];
    for (i, sensor) in sensors.iter_mut().enumerate() {
        assert_eq!(check_sensor(sensor.as_mut(), &world), Ok(()), "sensor {i}");
    }
    let leds = parts.leds.unwrap();
    let mut motors: Vec<Box<dyn Motor<PlaneWorld>>> = vec![
        Box::new(Leds::new(leds)),
        Box::new(Leds::new([leds[0], leds[2]])),
        Box::new(SignalMotor::new(parts.signal.unwrap())),
        Box::new(AttachmentMotor::new(parts.attachment.unwrap())),
    ];
    for (i, motor) in motors.iter_mut().enumerate() {
        assert_eq!(check_motor(motor.as_mut(), || scene().0), Ok(()), "motor {i}");
    }
}

#[test]
fn the_ground_is_read_where_its_sensors_are() {
    let mut world = PlaneWorld::new();
    world.add_area([1.0, 1.0], 0.5, [0.3, 0.6, 0.9]);
    world.add_area([1.0, 1.0], 0.1, RED);
    // Looking along y, so that the robot's left is at smaller x.
    let parts = world.add_robot(&MobileRobot::khepera(), [1.0, 0.8], PI / 2.0);
    let mut ground = GroundColor::new(parts.body, [[0.0, 0.0], [0.15, 0.05], [0.0, 0.6]]).unwrap();
    let near = |a: &[f32], b: &[f32]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(near(&read(&mut ground, &world), &[0.6, 1.0 / 3.0, 0.0]));
    assert!(near(&read(&mut ground.rgb(), &world), &[0.3, 0.6, 0.9, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
}

#[test]
fn light_falls_with_the_square_of_the_distance_and_the_cosine_and_is_hidden() {
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.0);
    let angle = 0.5_f64;
    let sensors = [0.0, angle, PI.into()].map(|angle| Beam::in_cone(0.0, angle, 0.0, 0, 1));
    let mut light = LightSensors::new(parts.body, sensors, 0.1).unwrap();
    let lamp = world.add_lamp([0.4, 0.0], 0.01, 4.0);
    let values = read(&mut light, &world);
    assert!((values[0] - 0.25).abs() < 1e-6 && (values[1] - 0.25 * 0.877_58).abs() < 1e-5, "{values:?}");
    assert_eq!(values[2], 0.0);
    // A second lamp adds. Close by all is cut at 1.
    world.add_lamp([0.2, 0.0], 0.01, 1.0);
    world.place(lamp, [0.4, 0.1], 0.0);
    let both = read(&mut light, &world)[0];
    let square = 0.4 * 0.4 + 0.1 * 0.1_f32;
    assert!((both - 0.25 - 0.04 / square * 0.4 / square.sqrt()).abs() < 1e-5, "{both}");
    world.place(lamp, [0.11, 0.0], 0.0);
    assert_eq!(read(&mut light, &world)[0], 1.0);
    // Something between hides it, something behind it does not.
    let (mut world, parts) = (PlaneWorld::new(), parts);
    world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.0);
    world.add_lamp([0.4, 0.0], 0.01, 4.0);
    world.add_disc([0.6, 0.0], 0.05, RED);
    assert!(read(&mut light, &world)[0] > 0.2);
    let hider = world.add_disc([0.2, 0.0], 0.05, RED);
    assert_eq!(read(&mut light, &world), [0.0; 3]);
    world.place(hider, [0.2, 0.1], 0.0);
    assert!(read(&mut light, &world)[0] > 0.2);
    // One's own lamp is not seen.
    let mut dark = PlaneWorld::new();
    let own = dark.add_lamp([0.0, 0.0], 0.03, 1.0);
    assert_eq!(parts.body, own);
    let back = [Beam { from: [0.03, 0.0], direction: [-1.0, 0.0] }];
    assert_eq!(read(&mut LightSensors::new(own, back, 0.1).unwrap(), &dark), [0.0]);
}

#[test]
fn leds_are_seen_and_signals_heard() {
    let mut world = PlaneWorld::new();
    let [ear, left, behind] =
        [[0.0, 0.0], [0.0, 0.3], [-0.5, 0.02]].map(|at| world.add_robot(&MobileRobot::marxbot(), at, 0.0));
    for (parts, signal) in [(ear, 1.0), (left, 0.5), (behind, 0.25)] {
        SignalMotor::new(parts.signal.unwrap()).drive(&[signal], &mut world);
    }
    let mut four = SignalSensor::<4>::new(ear.body, 1.0).unwrap();
    assert_eq!(read(&mut four, &world), [0.0, 0.5, 0.25, 0.0]);
    assert_eq!(read(&mut four.mean(), &world), [0.0, 0.5, 0.25, 0.0]);
    let mut all = SignalSensor::<1>::new(ear.body, 1.0).unwrap();
    assert_eq!((read(&mut all, &world), read(&mut all.mean(), &world)), (vec![0.5], vec![0.375]));
    // The hull of the one behind is 0.4154 m away.
    assert_eq!(read(&mut SignalSensor::<4>::new(ear.body, 0.41).unwrap(), &world), [0.0, 0.5, 0.0, 0.0]);
    assert_eq!(read(&mut SignalSensor::<4>::new(ear.body, 0.42).unwrap(), &world), [0.0, 0.5, 0.25, 0.0]);

    let leds = left.leds.unwrap();
    let mut camera = LinearCamera::for_view(ear.body, 2.0 * f64::from(PI), 4, 16, bands(), 1.0).unwrap();
    assert_eq!(read(&mut camera, &world), [0.0; 8]);
    Leds::new([leds[0], leds[2]]).drive(&[0.0, 1.0], &mut world);
    let values = read(&mut camera, &world);
    assert!(values[3] > 0.0 && values[0] == 0.0 && values[2] == 0.0 && values[6] == 0.0, "{values:?}");
    Leds::new([leds[0], leds[2]]).drive(&[1.0], &mut world);
    // Magenta is neither red nor blue, but in a band that holds it.
    assert_eq!(read(&mut camera, &world), [0.0; 8]);
    let lit = ColorBand { low: [0.5, 0.0, 0.0], high: [1.0, 0.3, 1.0] };
    assert!(read(&mut LinearCamera::for_view(ear.body, 6.0, 1, 50, [lit], 1.0).unwrap(), &world)[0] > 0.0);
}

#[test]
fn a_device_holds_what_is_within_reach() {
    let mut world = PlaneWorld::new();
    let robot = world.add_robot(&MobileRobot::marxbot(), [0.0, 0.0], 0.0);
    let other = world.add_disc([0.2, 0.0], 0.1, RED);
    let (mut motor, mut sensor) = (AttachmentMotor::new(robot.attachment.unwrap()), AttachmentSensor::new(robot.body));
    for (y, held) in [(1.0, 1.0), (0.5, 0.0), (0.51, 1.0), (f32::NAN, 0.0)] {
        motor.drive(&[y], &mut world);
        assert_eq!(read(&mut sensor, &world), [held], "{y}");
    }
    motor.drive(&[1.0], &mut world);
    world.place(other, [0.21, 0.0], 0.0);
    assert_eq!(read(&mut sensor, &world), [0.0]);
}

#[test]
fn measured_readings_are_looked_up_and_added() {
    let robot = MobileRobot::khepera();
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&robot, [0.5, 0.5], PI / 4.0);
    let tables = tables();
    // Three distances of 2 mm each from 5 mm on.
    assert!((tables.range() - 0.011).abs() < 1e-6 && tables.sensors() == 8);
    let far = InfraredTable::parse("8 1 1 5 30\nTURN 0\n0 0 0 0 0 0 0 0\nEND").unwrap();
    let farther = InfraredTables::new(table(8, 0), vec![(0.01, far), (0.02, table(8, 0))]).unwrap();
    assert!((farther.range() - 0.035).abs() < 1e-6, "of several the farthest");
    let mut sensor = SampledInfrared::new(parts.body, 0.035, &tables).unwrap();
    let expect = |rows: &[usize]| -> Vec<f32> {
        (0..8).map(|s| rows.iter().map(|row| (row + s) as f32 / 1024.0).sum::<f32>().min(1.0)).collect()
    };
    assert_eq!(read(&mut sensor, &world), expect(&[]));
    // Directions at which the robot's own angle is 10, 100, 190 degrees clockwise.
    let at = |apart: f32, clockwise: f32| {
        let (s, c) = farsa_num::sin_cos(PI / 4.0 - clockwise * PI / 180.0);
        [0.5 + apart * c, 0.5 + apart * s]
    };
    let small = world.add_disc(at(0.035 + 0.0125 + 0.002, 100.0), 0.0125, RED);
    assert_eq!(read(&mut sensor, &world), expect(&[310]));
    world.place(small, at(0.035 + 0.0125 + 0.0078, 190.0), 0.0);
    assert_eq!(read(&mut sensor, &world), expect(&[420]));
    world.place(small, at(0.035 + 0.0125 + 0.0112, 190.0), 0.0);
    assert_eq!(read(&mut sensor, &world), expect(&[]));
    // The table of the nearer radius is used: the small one's for 19 mm, the large one's for 20 mm.
    for (radius, row) in [(0.001, 300), (0.019, 300), (0.020, 600), (1.0, 600)] {
        world.place(small, at(5.0, 0.0), 0.0);
        let disc = world.add_disc(at(0.035 + radius + 0.0032, 10.0), radius, RED);
        assert_eq!(read(&mut sensor, &world), expect(&[row]), "{radius}");
        world.place(disc, at(5.0, 0.0), 0.0);
    }
    // Two walls and a disc: the sum is cut at 1.
    world.place(small, at(0.035 + 0.0125 + 0.008, 10.0), 0.0);
    let before = read(&mut sensor, &world);
    assert_eq!(before, expect(&[400]));
    let wall = |apart: f32, clockwise: f32| {
        let (foot, along) = (at(apart, clockwise), at(1.0, clockwise + 90.0).map(|x| x - 0.5));
        [-1.0, 1.0].map(|side| [foot[0] + side * along[0], foot[1] + side * along[1]])
    };
    world.add_wall(wall(0.035 + 0.0101, 280.0), [1.0; 3]);
    assert_eq!(read(&mut sensor, &world), expect(&[400, 230]));
    world.add_wall(wall(0.035 + 0.0101, 260.0), [1.0; 3]);
    world.add_wall(wall(0.035 + 0.0101, 300.0), [1.0; 3]);
    assert_eq!(read(&mut sensor, &world), expect(&[400, 230, 220, 230]));
    assert_eq!(read(&mut sensor, &world)[0], 1.0);
    assert_eq!(read(&mut sensor.first(6).unwrap(), &world).len(), 6);
}

/// Returns the three measured tables of the Khepera, from the folder `khepera` of `FARSA_FIXTURES`, or of the folder
/// next to the repository.
///
/// The tables are not part of the repository. CI must have them. In other places the test reports that it is skipped.
fn fixtures(test: &str) -> Option<InfraredTables> {
    let named = std::env::var_os("FARSA_FIXTURES").map(PathBuf::from);
    let must_be_there = named.is_some() || std::env::var_os("CI").is_some_and(|value| value == "true");
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = named.unwrap_or_else(beside).join("khepera");
    if !folder.is_dir() {
        assert!(!must_be_there, "{test}: there is no folder {}; set FARSA_FIXTURES", folder.display());
        eprintln!("skipped: {test} (set FARSA_FIXTURES)");
        return None;
    }
    let read = |name: &str| InfraredTable::parse(&std::fs::read_to_string(folder.join(name)).unwrap()).unwrap();
    let bodies = vec![(0.0125, read("small.sam")), (0.027, read("round.sam"))];
    Some(InfraredTables::new(read("wall.sam"), bodies).unwrap())
}

#[test]
fn the_measured_khepera_reads_what_was_measured() {
    let Some(tables) = fixtures("the_measured_khepera_reads_what_was_measured") else { return };
    assert_eq!(tables.sensors(), 8);
    assert!((tables.range() - 0.045).abs() < 1e-6);
    // Surface, distance from the hull [mm], clockwise bearing [degrees], readings. Copied by hand from the files.
    let rows: [(f32, f32, f32, [u16; 8]); 9] = [
        (0.0, 6.0, 1.0, [2, 1023, 1023, 1023, 1023, 0, 4, 4]),
        (0.0, 2.0, 20.5, [6, 0, 1023, 1023, 1023, 753, 0, 9]),
        (0.0, 20.0, 91.0, [0, 0, 5, 4, 0, 1023, 0, 0]),
        (0.0, 30.0, 201.0, [6, 7, 3, 0, 0, 0, 8, 501]),
        (0.0125, 14.0, 1.0, [0, 2, 962, 517, 0, 1, 1, 2]),
        (0.0125, 20.0, 271.0, [105, 1, 3, 3, 3, 3, 3, 4]),
        (0.0125, 44.0, 359.0, [0, 2, 4, 0, 1, 3, 3, 1]),
        (0.027, 5.5, 161.0, [7, 0, 3, 10, 0, 0, 1023, 919]),
        (0.027, 44.0, 91.0, [0, 6, 0, 7, 8, 6, 0, 0]),
    ];
    for (radius, distance, clockwise, readings) in rows {
        let mut world = PlaneWorld::new();
        let heading = 0.7;
        let parts = world.add_robot(&MobileRobot::khepera(), [0.2, 0.3], heading);
        let (s, c) = farsa_num::sin_cos(heading - clockwise * PI / 180.0);
        let apart = 0.035 + distance / 1000.0 + radius;
        let (x, y) = (0.2 + apart * c, 0.3 + apart * s);
        if radius > 0.0 {
            world.add_disc([x, y], radius, [1.0; 3]);
        } else {
            world.add_wall([[x - s, y + c], [x + s, y - c]], [1.0; 3]);
        }
        let values = read(&mut SampledInfrared::new(parts.body, 0.035, &tables).unwrap(), &world);
        assert_eq!(values, readings.map(|r| f32::from(r) / 1024.0), "{radius} {distance} {clockwise}");
    }
    // Past the last distance there is nothing.
    assert_eq!(tables.table(0.0).response(0.0451, 0.0), None);
    assert!(tables.table(0.0).response(0.0449, 0.0).is_some());
}

#[test]
fn bad_configurations_are_refused_with_their_numbers() {
    let b = BodyId(0);
    let sensor = Beam::in_cone(0.035, 0.0, 0.0, 0, 1);
    assert!(GroundColor::new(b, [[0.0; 2]; 0]).is_err() && GroundColor::new(b, [[0.0, f32::NAN]]).is_err());
    assert!(LightSensors::new(b, [sensor; 0], 1.0).is_err());
    let view = |field, sectors, rays| LinearCamera::for_view(b, field, sectors, rays, bands(), 1.0);
    for (field, sectors, rays) in
        [(0.0, 2, 2), (7.0, 2, 2), (f64::NAN, 2, 2), (1.0, 0, 2), (1.0, 2, 0), (1.0, usize::MAX, 2), (1.0, 2, 1 << 20)]
    {
        assert!(view(field, sectors, rays).is_err(), "{field} {sectors} {rays}");
    }
    let backwards = ColorBand { low: [0.5; 3], high: [0.4; 3] };
    for bad in [&[backwards][..], &[ColorBand::around(RED, f32::NAN)], &[]] {
        assert!(LinearCamera::for_view(b, 1.0, 2, 2, bad, 1.0).is_err());
    }
    assert_eq!(
        LinearCamera::new(b, [sensor; 5], 2, bands(), 1.0).unwrap_err(),
        ChannelError::Groups { field: "rays", count: 5, size: 2 }
    );
    assert!(SignalSensor::<0>::new(b, 1.0).is_err());
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(LightSensors::new(b, [sensor], bad).is_err());
        assert!(LinearCamera::for_view(b, 1.0, 2, 2, bands(), bad).is_err());
        assert!(SignalSensor::<2>::new(b, bad).is_err());
        assert!(SampledInfrared::new(b, bad, tables()).is_err());
        assert!(InfraredTables::new(table(8, 0), vec![(bad, table(8, 0))]).is_err());
    }
    assert_eq!(
        InfraredTables::new(table(8, 0), vec![(0.0125, table(6, 0))]).unwrap_err().to_string(),
        "6 sensors of a table are no whole groups of 8"
    );
    let sampled = SampledInfrared::new(b, 0.035, tables()).unwrap();
    assert!(sampled.clone().first(0).is_err());
    assert_eq!(sampled.first(9).unwrap_err(), ChannelError::Selection { start: 0, end: 9, channels: 8 });
}

/// A world with arbitrary readings.
struct Odd([f32; 8]);

impl Handles for Odd {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}
impl Kinematics for Odd {
    fn pose(&self, _: BodyId) -> Pose {
        let [a, b, c, d, e, f, ..] = self.0;
        Pose { position: [a, b, 0.0], rotation: [c, d, e, f] }
    }
    fn velocity(&self, _: BodyId) -> Twist {
        Twist::default()
    }
}
impl Sight for Odd {
    fn query_near(&self, _: [f32; 2], _: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        let [a, b, c, d, e, f, g, h] = self.0;
        tell(NearbySurface { body: None, point: [a, b], distance: c, radius: d, color: [e; 3], signal: Some(f) });
        tell(NearbySurface {
            body: Some(BodyId(1)),
            point: [h, g],
            distance: f,
            radius: e,
            color: [d; 3],
            signal: Some(c),
        });
    }
    fn cast_planar(&self, _: [f32; 2], _: [f32; 2], _: f32, _: Option<BodyId>) -> Option<PlanarHit<BodyId>> {
        let [a, b, c, d, ..] = self.0;
        (d < 1.0).then_some(PlanarHit { distance: d, body: None, color: [a, b, c] })
    }
}

impl Planar for Odd {
    fn ground(&self, _: [f32; 2]) -> [f32; 3] {
        let [a, b, c, ..] = self.0;
        [a, b, c]
    }
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<BodyId>)) {
        let [a, b, c, d, e, f, ..] = self.0;
        tell(Lamp { body: BodyId(1), position: [a, b], intensity: c });
        tell(Lamp { body: BodyId(2), position: [d, e], intensity: f });
    }
}

fn anything() -> impl Strategy<Value = f32> {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 0.0, -0.0, 1.0];
    prop_oneof![prop::sample::select(odd.to_vec()), -2.0_f32..2.0, -0.05_f32..0.05]
}

proptest! {
    #[test]
    fn readings_stay_in_their_range_whatever_the_world_tells(numbers in prop::array::uniform8(anything())) {
        let (world, b, robot) = (Odd(numbers), BodyId(0), MobileRobot::khepera());
        let mut sensors: Vec<Box<dyn Sensor<Odd>>> = vec![
            Box::new(GroundColor::new(b, [[0.0, 0.0]]).unwrap()),
            Box::new(GroundColor::new(b, [[0.0, 0.0]]).unwrap().rgb()),
            Box::new(LightSensors::for_robot(&robot, b, 1.0).unwrap()),
            Box::new(LinearCamera::for_view(b, 1.0, 2, 3, bands(), 1.0).unwrap()),
            Box::new(SignalSensor::<3>::new(b, 1.0).unwrap()),
            Box::new(SignalSensor::<3>::new(b, 1.0).unwrap().mean()),
            Box::new(AttachmentSensor::new(b)),
            Box::new(InfraredFormula::for_robot(&robot, b).unwrap()),
            Box::new(SampledInfrared::new(b, 0.035, tables()).unwrap()),
        ];
        for (i, sensor) in sensors.iter_mut().enumerate() {
            let values = read(sensor.as_mut(), &world);
            prop_assert!(values.iter().all(|x| (0.0..=1.0).contains(x)), "{i}: {values:?}");
        }
    }

    #[test]
    fn what_one_side_says_is_heard_on_that_side(bearing in -3.1_f32..3.1, apart in 0.2_f32..0.5, signal in 0.0_f32..1.0) {
        let hear = |side: f32| {
            let mut world = PlaneWorld::new();
            let ear = world.add_robot(&MobileRobot::e_puck(), [0.0, 0.0], 0.0);
            let (s, c) = farsa_num::sin_cos(side * bearing);
            let other = world.add_robot(&MobileRobot::e_puck(), [apart * c, apart * s], 1.0);
            world.command(other.signal.unwrap(), [signal, 0.0]);
            read(&mut SignalSensor::<5>::new(ear.body, 1.0).unwrap(), &world)
        };
        let (here, there) = (hear(1.0), hear(-1.0));
        prop_assert_eq!(&here, &[0, 4, 3, 2, 1].map(|i| there[i]));
        prop_assert_eq!(here.iter().sum::<f32>(), signal);
        let fifth = 2.0 * PI / 5.0;
        let expected = (bearing.rem_euclid(2.0 * PI) / fifth).round() as usize % 5;
        prop_assert_eq!(here[expected], signal);
    }
}
