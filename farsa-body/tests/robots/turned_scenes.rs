//! Readings of mobile robots' sensors do not depend on the place and rotation of the scene, or on a tilt of the robot.

use core::f32::consts::PI;
use std::sync::OnceLock;

use crate::shared::{BLUE, RED, bands, read};
use farsa_body::ports::{
    Actuated, ActuatorId, BodyId, Handles, JointId, Kinematics, Lamp, NearbySurface, Planar, PlanarHit, Sensor, Sight,
};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::infrared::{
    InfraredFormula, InfraredGroups, InfraredRays, InfraredTable, InfraredTables, SampledInfrared,
};
use farsa_body::sensors::{GroundColor, LaserDistance, LightSensors, LinearCamera, SignalSensor};
use farsa_body::testing::PlaneWorld;
use farsa_body::{Pose, Twist};
use farsa_num::sin_cos;
use proptest::prelude::*;

/// Builds a `MarXbot` among things of every kind, moved and turned as one. In the scene's axes it is at (0.1, 0.2) and
/// looks to 0.5 rad.
fn scene([dx, dy]: [f32; 2], turn: f32) -> (PlaneWorld, BodyId) {
    let (sine, cosine) = sin_cos(turn);
    let at = |x: f32, y: f32| [dx + cosine * x - sine * y, dy + sine * x + cosine * y];
    let mut world = PlaneWorld::new();
    world.add_wall([at(0.24, -1.0), at(0.22, 1.0)], [1.0; 3]);
    let body = world.add_robot(&MobileRobot::marxbot(), at(0.1, 0.2), turn + 0.5).body;
    world.add_disc(at(0.03, 0.37), 0.05, RED);
    world.add_disc(at(-0.25, 0.2), 0.2, BLUE);
    world.add_disc(at(0.19, 0.26), 0.01, BLUE);
    world.add_lamp(at(0.1, -0.4), 0.01, 0.4);
    world.add_lamp(at(0.15, 0.6), 0.01, 0.2);
    world.add_area(at(0.1, 0.2), 0.06, [0.3, 0.6, 0.9]);
    world.add_area(at(0.15, 0.25), 0.02, [0.9, 0.1, 0.4]);
    for (x, y, signal) in [(0.05, 0.0, 0.75), (-0.1, 0.5, 0.25)] {
        let other = world.add_robot(&MobileRobot::marxbot(), at(x, y), turn);
        world.command(other.signal.unwrap(), [signal, 0.0]);
        world.command(other.leds.unwrap()[0], [1.0, 0.0]);
    }
    (world, body)
}

/// A table whose readings fall with the distance and are largest where the surface is ahead of the sensor.
fn tables() -> &'static InfraredTables {
    static TABLES: OnceLock<InfraredTables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let mut lines = vec!["8 360 20 3 5".to_owned()];
        for distance in 0..20 {
            lines.push(format!("TURN {distance}"));
            for angle in 0..360 {
                let aside = |sensor: i32| ((angle - 45 * sensor + 540) % 360 - 180).abs();
                let reading = |sensor: i32| (1000 - 40 * distance - 2 * aside(sensor)).max(0).to_string();
                lines.push((0..8).map(reading).collect::<Vec<_>>().join(" "));
            }
        }
        lines.push("END".into());
        InfraredTables::new(InfraredTable::parse(&lines.join("\n")).unwrap(), vec![]).unwrap()
    })
}

/// Sensors that need the plane alone, each with its name and by how much a reading may differ.
fn planar<W: Planar<Body = BodyId> + Kinematics>(b: BodyId) -> Vec<(Box<dyn Sensor<W>>, f32)> {
    let robot = MobileRobot::marxbot();
    let places: Vec<[f32; 2]> = robot.ground.iter().map(|place| place.map(|x| x as f32)).collect();
    // A ray of a camera, a row of a table.
    let (ray, row) = (1.01 / 40.0, 0.05);
    vec![
        (Box::new(GroundColor::new(b, places.clone()).unwrap()), 1e-4),
        (Box::new(GroundColor::new(b, places).unwrap().rgb()), 1e-4),
        (Box::new(LightSensors::for_robot(&robot, b, 0.3).unwrap()), 1e-3),
        (Box::new(LinearCamera::for_view(b, 2.0 * f64::from(PI), 5, 40, bands(), 2.0).unwrap()), ray),
        (Box::new(LinearCamera::for_view(b, 1.5, 2, 40, bands(), 2.0).unwrap()), ray),
        (Box::new(SignalSensor::<4>::new(b, 1.0).unwrap()), 0.0),
        (Box::new(SignalSensor::<3>::new(b, 1.0).unwrap().mean()), 0.0),
        (Box::new(InfraredFormula::for_robot(&robot, b).unwrap()), 1e-3),
        (Box::new(SampledInfrared::new(b, 0.085, tables()).unwrap()), row),
    ]
}

/// The sensors that cast rays in space.
fn rays(b: BodyId) -> Vec<(Box<dyn Sensor<PlaneWorld>>, f32)> {
    let robot = MobileRobot::marxbot();
    let fan: Vec<_> = (0..7).map(|i| farsa_body::sensors::Beam::in_cone(0.085, 0.3, 1.0, i, 7)).collect();
    vec![
        (Box::new(InfraredRays::for_robot(&robot, b).unwrap()), 2e-3),
        (Box::new(InfraredGroups::for_robot(&robot, b, 6).unwrap()), 2e-3),
        (Box::new(LaserDistance::new(b, fan, 0.0, 1.0).unwrap()), 2e-3),
    ]
}

fn differ(here: &[f32], there: &[f32], most: f32) -> bool {
    here.len() != there.len() || here.iter().zip(there).any(|(a, b)| (a - b).abs() > most)
}

/// The world as it is, but the robot pitched and rolled on the spot.
struct Tilted<'a> {
    world: &'a PlaneWorld,
    tilt: Pose,
}

impl Handles for Tilted<'_> {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}
impl Kinematics for Tilted<'_> {
    fn pose(&self, body: BodyId) -> Pose {
        self.world.pose(body).compose(&self.tilt)
    }
    fn velocity(&self, body: BodyId) -> Twist {
        self.world.velocity(body)
    }
}
impl Sight for Tilted<'_> {
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        self.world.query_near(from, range, tell);
    }
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<PlanarHit<BodyId>> {
        self.world.cast_planar(from, direction, range, but)
    }
}
impl Planar for Tilted<'_> {
    fn ground(&self, at: [f32; 2]) -> [f32; 3] {
        self.world.ground(at)
    }
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<BodyId>)) {
        self.world.lamps(tell);
    }
}

proptest! {
    #[test]
    fn readings_do_not_depend_on_where_the_scene_lies(shift in prop::array::uniform2(-1.0_f32..1.0), turn in -3.1_f32..3.1) {
        let ((usual, b), (moved, _)) = (scene([0.0; 2], 0.0), scene(shift, turn));
        for (i, (mut sensor, most)) in planar(b).into_iter().chain(rays(b)).enumerate() {
            let (here, there) = (read(sensor.as_mut(), &usual), read(sensor.as_mut(), &moved));
            prop_assert!(!differ(&here, &there, most), "sensor {}: {:?} {:?}", i, here, there);
            prop_assert!(here.iter().any(|x| *x > 0.0), "sensor {} reads nothing", i);
        }
    }

    /// A robot that pitches and rolls is seen from above: its place and heading are unchanged.
    #[test]
    fn a_tilted_robot_is_seen_from_above(turn in -3.1_f32..3.1, pitch in -1.4_f32..1.4, roll in -3.0_f32..3.0) {
        let (world, b) = scene([0.2, -0.3], turn);
        let ((ps, pc), (rs, rc)) = (sin_cos(0.5 * pitch), sin_cos(0.5 * roll));
        let about = |rotation| Pose { position: [0.0; 3], rotation };
        let tilt = about([0.0, ps, 0.0, pc]).compose(&about([rs, 0.0, 0.0, rc]));
        let tilted = Tilted { world: &world, tilt };
        for (i, ((mut upright, most), (mut sensor, _))) in
            planar::<PlaneWorld>(b).into_iter().zip(planar::<Tilted<'_>>(b)).enumerate()
        {
            let (here, there) = (read(upright.as_mut(), &world), read(sensor.as_mut(), &tilted));
            prop_assert!(!differ(&here, &there, most), "sensor {}: {:?} {:?}", i, here, there);
        }
    }
}
