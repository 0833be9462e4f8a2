//! Sensors of robots in an arena.

use std::sync::Arc;

use farsa_body::ChannelError;
use farsa_body::ports::{Channels, JointId, PairId, Sensor};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::infrared::{InfraredFormula, InfraredGroups, InfraredTables, SampledInfrared};
use farsa_body::sensors::{
    AttachmentSensor, Beam, BodyPose, BodyVelocity, ContactForce, GroundColor, Height, JointPosition, JointSpeed,
    LaserDistance, LightSensors, Point, Signal, SignalSensor, TargetPosition, Touch, Traction, WheelSpeed,
};
use farsa_lab::Error;

use crate::arena::ArenaWorld;
use crate::arena::field::Forager;
use crate::arena::measure::one_body;
use crate::arena::registered::{self, PartOfPlanar, RegisteredSensor, wheel};
use crate::arena::scene::Scene;
use crate::check::source::Source;
use crate::document::{InfraredModel, SensorKind};
use crate::parts::eye::{Eye, eye};
use crate::parts::files::{Files, measured};

/// A sensor of a robot in a plane.
#[derive(Clone, Debug)]
pub(crate) enum Sensing {
    Analytic(InfraredFormula<Vec<[f32; 2]>>),
    Rays(InfraredGroups),
    Sampled(SampledInfrared<Arc<InfraredTables>>),
    Light(LightSensors<Vec<Beam>>),
    Ground(GroundColor<Vec<[f32; 2]>>),
    Laser(LaserDistance<Vec<Beam>>),
    Camera(Eye),
    WheelSpeed(WheelSpeed),
    Traction(Traction),
    SignalAround(SignalSensor<1>),
    SignalHalves(SignalSensor<2>),
    SignalQuarters(SignalSensor<4>),
    SignalEighths(SignalSensor<8>),
    Attachment(AttachmentSensor),
    Touch(Touch<[PairId; 1]>),
    ContactForce(ContactForce<[PairId; 1]>),
    Target(TargetPosition),
    Pose(BodyPose),
    Velocity(BodyVelocity),
    Height(Height),
    JointPosition(Vec<JointPosition>),
    JointSpeed(Vec<JointSpeed>),
    Constant(Signal<1>),
    Energy(Signal<1>),
    Carried(Signal<1>),
    Registered(RegisteredSensor),
}

/// Calls a method of the sensor of any kind.
macro_rules! sensor {
    ($sensing:expr, $sensor:ident => $call:expr) => {
        match $sensing {
            Sensing::Analytic($sensor) => $call,
            Sensing::Rays($sensor) => $call,
            Sensing::Sampled($sensor) => $call,
            Sensing::Light($sensor) => $call,
            Sensing::Ground($sensor) => $call,
            Sensing::Laser($sensor) => $call,
            Sensing::Camera($sensor) => $call,
            Sensing::WheelSpeed($sensor) => $call,
            Sensing::Traction($sensor) => $call,
            Sensing::SignalAround($sensor) => $call,
            Sensing::SignalHalves($sensor) => $call,
            Sensing::SignalQuarters($sensor) => $call,
            Sensing::SignalEighths($sensor) => $call,
            Sensing::Attachment($sensor) => $call,
            Sensing::Touch($sensor) => $call,
            Sensing::ContactForce($sensor) => $call,
            Sensing::Target($sensor) => $call,
            Sensing::Pose($sensor) => $call,
            Sensing::Velocity($sensor) => $call,
            Sensing::Height($sensor) => $call,
            Sensing::JointPosition($sensor) => $call,
            Sensing::JointSpeed($sensor) => $call,
            Sensing::Constant($sensor) => $call,
            Sensing::Energy($sensor) => $call,
            Sensing::Carried($sensor) => $call,
            Sensing::Registered($sensor) => $call,
        }
    };
}

impl Channels for Sensing {
    fn channels(&self) -> usize {
        sensor!(self, sensor => sensor.channels())
    }

    fn reset(&mut self) {
        sensor!(self, sensor => sensor.reset());
    }
}

impl<W: ArenaWorld> Sensor<W> for Sensing {
    /// Reads infrared rays inline, because most experiments have them.
    #[inline(always)]
    fn read(&mut self, world: &W, out: &mut [f32]) {
        if let Self::Analytic(infrared) = self {
            infrared.read(world, out);
        } else {
            self.read_other(world, out);
        }
    }
}

impl Sensing {
    #[inline(never)]
    fn read_other<W: ArenaWorld>(&mut self, world: &W, out: &mut [f32]) {
        sensor!(self, sensor => sensor.read(world, out));
    }

    /// Updates a sensor of the robot's own state.
    pub(crate) fn feel(&mut self, forager: &Forager) {
        match self {
            Self::Energy(signal) => signal.set([forager.energy as f32]),
            Self::Carried(signal) => signal.set([f32::from(u8::from(forager.carried > 0))]),
            _ => {}
        }
    }
}

/// Builds the sensor at a path of the document for robot number `robot`.
pub(crate) fn sensor(
    kind: &SensorKind,
    scene: &Scene,
    robot: usize,
    path: &str,
    files: &mut Files<'_>,
    source: &Source,
) -> Result<Sensing, Error> {
    if let SensorKind::Registered { kind, keys } = kind {
        return registered::sensor(kind, keys, PartOfPlanar { scene, robot, path, source }).map(Sensing::Registered);
    }
    let target = match kind {
        SensorKind::TargetPosition { target, .. } => Some(scene.body(target, &format!("{path}/target"), source)?),
        _ => None,
    };
    let tables = match kind {
        SensorKind::Infrared { model: InfraredModel::Tables, tables: None, .. } => {
            return Err(source.wrong(path, "lacks the key `tables`, which the model `tables` needs"));
        }
        SensorKind::Infrared { model: InfraredModel::Tables, tables: Some(tables), .. } => {
            let tables = measured(tables, files, path, source)?;
            let (sensors, expected) = (tables.sensors(), scene.robots[robot].infrared.angles.len());
            if sensors != expected {
                let why = format!("are of {sensors} sensors where the {} has {expected}", scene.robots[robot].name);
                return Err(source.wrong(&format!("{path}/tables"), why));
            }
            Some(tables)
        }
        SensorKind::Infrared { tables: Some(_), .. } => {
            return Err(source.wrong(&format!("{path}/tables"), "are for the model `tables`"));
        }
        _ => None,
    };
    check(kind, path, source)?;
    let parts = scene.parts(robot);
    let wheels = match kind {
        SensorKind::JointPosition { joints, .. } | SensorKind::JointSpeed { joints } => {
            let named = joints.iter().enumerate();
            named.map(|(index, joint)| wheel(joint, &parts, &format!("{path}/joints/{index}"), source)).collect()
        }
        _ => Ok(Vec::new()),
    };
    let wheels = wheels?;
    let wheels = if wheels.is_empty() { &parts.wheels[..] } else { &wheels };
    let made = bare(kind, &scene.robots[robot], &parts, target, tables, wheels);
    made.map_err(|error| source.wrong(path, error))
}

/// Rejects sensors of robots with joints.
fn check(kind: &SensorKind, path: &str, source: &Source) -> Result<(), Error> {
    let (body, bodies, point) = match kind {
        SensorKind::Touch { bodies, with } | SensorKind::ContactForce { bodies, with } => {
            (with, &bodies[..], &[0.0; 3])
        }
        SensorKind::TargetPosition { body, point, .. } | SensorKind::Height { body, point } => (body, &[][..], point),
        SensorKind::BodyPose { body } | SensorKind::BodyVelocity { body, .. } => (body, &[][..], &[0.0; 3]),
        SensorKind::Camera(camera) => (&camera.body, &[][..], &[0.0; 3]),
        SensorKind::CameraImage { .. } | SensorKind::ColorBlobs { .. } | SensorKind::VisualOffset { .. } => {
            return Err(source.wrong(path, "is for robots with joints; one on wheels has a `camera` of sectors"));
        }
        SensorKind::JointPosition { from, to, .. } => {
            let missing = [("from", from), ("to", to)].into_iter().find(|(_, end)| end.is_none());
            return missing.map_or(Ok(()), |(key, _)| {
                Err(source.wrong(path, format!("lacks the key `{key}`: wheels turn on and on")))
            });
        }
        _ => return Ok(()),
    };
    one_body(body.as_ref(), bodies, point, path, source)
}

/// Returns the first items of a list, or all of them for 0.
fn first<T: Clone>(list: &[T], count: u32) -> Result<Vec<T>, ChannelError> {
    let end = if count == 0 { list.len() } else { count as usize };
    let found = list.get(..end).filter(|found| !found.is_empty());
    found.map(<[T]>::to_vec).ok_or(ChannelError::Selection { start: 0, end, channels: list.len() })
}

/// Builds a sensor. `target` is the body that it observes, if any, and `wheels` the wheels that it
/// reads.
fn bare(
    kind: &SensorKind,
    robot: &MobileRobot,
    parts: &MobileParts,
    target: Option<farsa_body::ports::BodyId>,
    tables: Option<Arc<InfraredTables>>,
    wheels: &[JointId],
) -> Result<Sensing, ChannelError> {
    let body = parts.body;
    Ok(match kind {
        SensorKind::Infrared { model: InfraredModel::Tables, first: count, .. } => {
            let tables = tables.ok_or(ChannelError::Groups { field: "tables", count: 0, size: 1 })?;
            let sensor = SampledInfrared::new(body, robot.radius as f32, tables)?;
            Sensing::Sampled(if *count == 0 { sensor } else { sensor.first(*count as usize)? })
        }
        SensorKind::Infrared { model, first: count, groups, .. } => {
            let mut robot = robot.clone();
            robot.infrared.angles = first(&robot.infrared.angles, *count)?;
            let sensors = robot.infrared.angles.len();
            match (model, groups) {
                (InfraredModel::Analytic, 0) => Sensing::Analytic(InfraredFormula::for_robot(&robot, body)?),
                (InfraredModel::Analytic | InfraredModel::Tables, _) => {
                    let field = "groups of sensors by the formula (those of the model `rays` have groups)";
                    return Err(ChannelError::Groups { field, count: *groups as usize, size: 0 });
                }
                (InfraredModel::Rays, 0) => Sensing::Rays(InfraredGroups::for_robot(&robot, body, sensors)?),
                (InfraredModel::Rays, _) => Sensing::Rays(InfraredGroups::for_robot(&robot, body, *groups as usize)?),
            }
        }
        SensorKind::Light { reference } => Sensing::Light(LightSensors::for_robot(robot, body, *reference as f32)?),
        SensorKind::GroundColor { rgb, first: count, middle } => {
            let source = if *middle { vec![[0.0; 2]] } else { first(&robot.ground, *count)? };
            let source: Vec<[f32; 2]> = source.into_iter().map(|at| at.map(|x| x as f32)).collect();
            let sensor = GroundColor::new(body, source)?;
            Sensing::Ground(if *rgb { sensor.rgb() } else { sensor })
        }
        SensorKind::LaserDistance { beams, field_of_view, range, height } => {
            let beams = fan(robot.radius, field_of_view.to_radians(), *beams as usize);
            Sensing::Laser(LaserDistance::new(body, beams, *height as f32, *range as f32)?)
        }
        SensorKind::Camera(camera) => Sensing::Camera(eye(body, camera)?),
        SensorKind::WheelSpeed { signed } => {
            let sensor = WheelSpeed::new(parts.wheels, robot.max_wheel_speed as f32)?;
            Sensing::WheelSpeed(if *signed { sensor.signed() } else { sensor })
        }
        SensorKind::Traction { largest } => {
            Sensing::Traction(Traction::new(body, parts.wheels, robot.wheel_radius as f32, *largest as f32)?)
        }
        SensorKind::Signal { range, sectors, mean } => signal(body, *range as f32, *sectors, *mean)?,
        SensorKind::Attachment {} => Sensing::Attachment(AttachmentSensor::new(body)),
        // In an arena, the pair with the number of a body covers all contacts of that body.
        SensorKind::Touch { .. } => Sensing::Touch(Touch::new([PairId(body.0)], 1.0)?),
        SensorKind::ContactForce { .. } => Sensing::ContactForce(ContactForce::new([PairId(body.0)])),
        SensorKind::TargetPosition { axes, scale, .. } => {
            // `sensor` has already resolved the target of this kind.
            let [target, from] = [target.unwrap_or(body), body].map(Point::origin);
            Sensing::Target(TargetPosition::new(target, from, (*axes).into(), *scale as f32)?)
        }
        SensorKind::BodyPose { .. } => Sensing::Pose(BodyPose::new(body)),
        SensorKind::BodyVelocity { axes, .. } => Sensing::Velocity(BodyVelocity::new(body, (*axes).into())),
        SensorKind::Height { .. } => Sensing::Height(Height::new(Point::origin(body))),
        SensorKind::JointPosition { from, to, .. } => {
            // `check` has rejected missing ends.
            let [from, to] = [from, to].map(|end| end.unwrap_or(f64::INFINITY) as f32);
            let made = wheels.iter().map(|wheel| JointPosition::new(*wheel, from, to));
            Sensing::JointPosition(made.collect::<Result<_, _>>()?)
        }
        SensorKind::JointSpeed { .. } => {
            Sensing::JointSpeed(wheels.iter().map(|wheel| JointSpeed::new(*wheel)).collect())
        }
        // Rejected by `check`, or built by `sensor`.
        SensorKind::CameraImage { .. }
        | SensorKind::ColorBlobs { .. }
        | SensorKind::VisualOffset { .. }
        | SensorKind::Registered { .. } => {
            return Err(ChannelError::Groups { field: "eyes", count: 0, size: 1 });
        }
        SensorKind::Energy {} => Sensing::Energy(Signal::new([0.0])),
        SensorKind::Carried {} => Sensing::Carried(Signal::new([0.0])),
        SensorKind::Constant { value } => Sensing::Constant(Signal::new([*value as f32])),
    })
}

fn signal(body: farsa_body::ports::BodyId, range: f32, sectors: u32, mean: bool) -> Result<Sensing, ChannelError> {
    macro_rules! sensor {
        ($kind:ident) => {{
            let sensor = SignalSensor::new(body, range)?;
            Sensing::$kind(if mean { sensor.mean() } else { sensor })
        }};
    }
    Ok(match sectors {
        1 => sensor!(SignalAround),
        2 => sensor!(SignalHalves),
        4 => sensor!(SignalQuarters),
        8 => sensor!(SignalEighths),
        other => {
            return Err(ChannelError::Groups { field: "sectors, of 1, 2, 4 or 8", count: other as usize, size: 1 });
        }
    })
}

/// Returns beams from left to right over an angle [rad], each from the hull outwards.
fn fan(radius: f64, angle: f64, beams: usize) -> Vec<Beam> {
    (0..beams)
        .map(|beam| {
            let share = if beams > 1 { 0.5 - beam as f64 / (beams - 1) as f64 } else { 0.0 };
            Beam::in_cone(radius, share * angle, 0.0, 0, 1)
        })
        .collect()
}
