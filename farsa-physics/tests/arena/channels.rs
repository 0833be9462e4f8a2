//! Every sensor and motor of `farsa_body` for mobile robots, for a world of the plane.

use farsa_body::motors::{AttachmentMotor, Leds, SignalMotor, SpeedAndTurn, WheelVelocity};
use farsa_body::ports::{Actuated, ActuatorId, BodyId, JointId, Joints, Kinematics, Motor, Planar, Rays, Sensor};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::infrared::{InfraredFormula, InfraredRays, InfraredTable, InfraredTables, SampledInfrared};
use farsa_body::sensors::{
    AttachmentSensor, Beam, ColorBand, GroundColor, LaserDistance, LightSensors, LinearCamera, SignalSensor, Traction,
    WheelSpeed,
};

fn table() -> InfraredTables {
    let table = |offset: usize| {
        let mut lines = vec!["8 36 20 5 2".to_string()];
        for distance in 0..20 {
            lines.push(format!("TURN {distance}"));
            for angle in 0..36 {
                let row: Vec<String> =
                    (0..8).map(|s| (offset + (19 - distance) * 3 + (angle + s) % 7).to_string()).collect();
                lines.push(row.join(" "));
            }
        }
        lines.push("END".into());
        InfraredTable::parse(&lines.join("\n")).unwrap()
    };
    InfraredTables::new(table(0), vec![(0.0125, table(100)), (0.027, table(200))]).unwrap()
}

/// Every sensor of a robot with its name and how far its readings may differ in another implementation of the world.
pub(crate) fn every_sensor<W>(robot: &MobileRobot, parts: &MobileParts) -> Vec<(&'static str, f32, Box<dyn Sensor<W>>)>
where
    W: Planar<Body = BodyId> + Rays<Body = BodyId> + Kinematics<Body = BodyId> + Joints<Joint = JointId> + 'static,
{
    let b = parts.body;
    let bands = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.5; 3]].map(|color| ColorBand::around(color, 0.3));
    let radius = robot.radius;
    let fan: Vec<Beam> = (0..16).map(|i| Beam::in_cone(radius, 0.0, 1.5, i, 16)).collect();
    let places: Vec<[f32; 2]> = robot.ground.iter().map(|place| place.map(|x| x as f32)).collect();
    let largest = robot.max_wheel_speed as f32;
    vec![
        ("rays", 1e-3, Box::new(InfraredRays::for_robot(robot, b).unwrap())),
        ("analytic", 1e-3, Box::new(InfraredFormula::for_robot(robot, b).unwrap())),
        ("sampled", 1e-6, Box::new(SampledInfrared::new(b, radius as f32, table()).unwrap())),
        ("laser", 1e-3, Box::new(LaserDistance::new(b, fan, 0.01, 2.0).unwrap())),
        ("light", 1e-3, Box::new(LightSensors::for_robot(robot, b, 0.2).unwrap())),
        ("camera", 1e-6, Box::new(LinearCamera::for_view(b, 6.2, 6, 20, bands, 2.0).unwrap())),
        ("ground", 1e-6, Box::new(GroundColor::new(b, places).unwrap().rgb())),
        ("signal", 1e-6, Box::new(SignalSensor::<4>::new(b, 0.6).unwrap())),
        ("wheels", 1e-6, Box::new(WheelSpeed::new(parts.wheels, largest).unwrap())),
        ("traction", 1e-6, Box::new(Traction::new(b, parts.wheels, robot.wheel_radius as f32, 0.2).unwrap())),
        ("attachment", 1e-6, Box::new(AttachmentSensor::new(b))),
    ]
}

/// Every motor of a robot that has all devices.
pub(crate) fn every_motor<W>(robot: &MobileRobot, parts: &MobileParts) -> Vec<Box<dyn Motor<W>>>
where
    W: Actuated<Actuator = ActuatorId> + 'static,
{
    let largest = robot.max_wheel_speed as f32;
    vec![
        Box::new(WheelVelocity::new(parts.motors, largest).unwrap()),
        Box::new(SpeedAndTurn::new(parts.motors, largest).unwrap()),
        Box::new(Leds::new(parts.leds.unwrap())),
        Box::new(SignalMotor::new(parts.signal.unwrap())),
        Box::new(AttachmentMotor::new(parts.attachment.unwrap())),
    ]
}
