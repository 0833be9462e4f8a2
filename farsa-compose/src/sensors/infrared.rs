//! Infrared sensors.

use std::sync::Arc;

use farsa_body::ChannelError;
use farsa_body::ports::{Channels, Sensor};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::infrared::{
    self, InfraredDrawing, InfraredFormula, InfraredGroups, InfraredTables, SampledInfrared,
};
use farsa_lab::Error;
use farsa_lab::advanced::PlanarWorld;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::infrared_tables::MeasuredTables;
use crate::sensors::{first, wrong};

/// Infrared sensors around the hull: 0 nothing .. 1 at the hull.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Infrared {
    /// Model of the readings.
    #[serde(default)]
    model: InfraredModel,
    /// Number of sensors, from the robot's first. 0 means all.
    #[serde(default)]
    #[schemars(range(min = 0, max = 64))]
    first: u32,
    /// Number of groups of neighboring sensors, each of which gives its largest value, by rays. 0 keeps each alone.
    #[serde(default)]
    #[schemars(range(min = 0, max = 64))]
    groups: u32,
    /// Files of measured readings, for the model `tables`.
    tables: Option<MeasuredTables>,
}

/// Models of infrared sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum InfraredModel {
    /// A formula of distance and angle, with distances of a Khepera.
    #[default]
    Analytic,
    /// Rays, up to the range of the robot's sensors.
    Rays,
    /// Measured readings from files.
    Tables,
}

#[derive(Clone, Debug)]
enum Readings {
    Analytic(InfraredFormula<Vec<[f32; 2]>>),
    Rays(InfraredGroups),
    Sampled(SampledInfrared<Arc<InfraredTables>>),
}

/// Infrared sensors, with their rays in recordings.
#[derive(Clone, Debug)]
pub(crate) struct InfraredSensor {
    readings: Readings,
    pub(crate) drawing: InfraredDrawing,
}

impl InfraredSensor {
    /// Gets the value of each ray if there are fewer channels.
    pub(crate) fn ring(&self) -> Option<&[f32]> {
        match &self.readings {
            Readings::Rays(rays) if rays.channels() < self.drawing.count() => Some(rays.ring()),
            _ => None,
        }
    }
}

impl Channels for InfraredSensor {
    fn channels(&self) -> usize {
        match &self.readings {
            Readings::Analytic(infrared) => infrared.channels(),
            Readings::Rays(infrared) => infrared.channels(),
            Readings::Sampled(infrared) => infrared.channels(),
        }
    }

    fn reset(&mut self) {
        match &mut self.readings {
            Readings::Analytic(infrared) => infrared.reset(),
            Readings::Rays(infrared) => infrared.reset(),
            Readings::Sampled(infrared) => infrared.reset(),
        }
    }
}

impl<W: PlanarWorld> Sensor<W> for InfraredSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        match &mut self.readings {
            Readings::Analytic(infrared) => infrared.read(world, out),
            Readings::Rays(infrared) => infrared.read(world, out),
            Readings::Sampled(infrared) => infrared.read(world, out),
        }
    }
}

impl Infrared {
    /// Returns the tables of the readings, for the robot's sensors.
    fn measured(&self, scene: &PartScene<'_>, robot: &MobileRobot) -> Result<Option<Arc<InfraredTables>>, Error> {
        let wrong = |why: String| scene.0.error_at("tables", why);
        match (self.model, &self.tables) {
            (InfraredModel::Tables, None) => {
                Err(Error::Other("lacks the key `tables`, which the model `tables` needs".into()))
            }
            (InfraredModel::Tables, Some(tables)) => {
                let tables = tables.read(scene)?;
                let (sensors, expected) = (tables.sensors(), robot.infrared.angles.len());
                if sensors != expected {
                    return Err(wrong(format!("are of {sensors} sensors where the {} has {expected}", robot.name)));
                }
                Ok(Some(tables))
            }
            (_, Some(_)) => Err(wrong("are for the model `tables`".into())),
            (_, None) => Ok(None),
        }
    }

    fn readings(&self, robot: &MobileRobot, scene: &PartScene<'_>) -> Result<Readings, Error> {
        let place = scene.planar()?;
        let (body, groups) = (place.parts.body, self.groups as usize);
        if let Some(tables) = self.measured(scene, place.robot)? {
            let sensor = SampledInfrared::new(body, robot.radius as f32, tables).map_err(wrong)?;
            let count = self.first as usize;
            return Ok(Readings::Sampled(if count == 0 { sensor } else { sensor.first(count).map_err(wrong)? }));
        }
        let sensors = robot.infrared.angles.len();
        Ok(match (self.model, groups) {
            (InfraredModel::Analytic, 0) => Readings::Analytic(InfraredFormula::for_robot(robot, body).map_err(wrong)?),
            (InfraredModel::Analytic | InfraredModel::Tables, _) => {
                let field = "groups of sensors by the formula (those of the model `rays` have groups)";
                return Err(wrong(ChannelError::Groups { field, count: groups, size: 0 }));
            }
            (InfraredModel::Rays, 0) => Readings::Rays(InfraredGroups::for_robot(robot, body, sensors).map_err(wrong)?),
            (InfraredModel::Rays, _) => Readings::Rays(InfraredGroups::for_robot(robot, body, groups).map_err(wrong)?),
        })
    }
}

impl SensorPart for Infrared {
    type Sensor = InfraredSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<InfraredSensor, Error> {
        let mut robot = scene.planar()?.robot.clone();
        robot.infrared.angles = first(&robot.infrared.angles, self.first)?;
        let drawing = InfraredDrawing::for_robot(&robot, robot.infrared.angles.len());
        Ok(InfraredSensor { readings: self.readings(&robot, scene)?, drawing })
    }

    fn quantity(&self, channel: usize, scene: &PartScene<'_>) -> Quantity {
        let Some(robot) = scene.mobile_robot() else { return Quantity::default() };
        let angles = &robot.infrared.angles;
        let size = if self.groups == 0 { 1 } else { (angles.len() / self.groups as usize).max(1) };
        let angle = angles.get(channel * size).map_or(0.0, |angle| angle.to_degrees());
        let prefix = if size > 1 { format!("the nearest of {size} sensors around ") } else { "at ".into() };
        let ends = match self.model {
            InfraredModel::Analytic => infrared::InfraredModel::WALL_ENDS,
            InfraredModel::Rays | InfraredModel::Tables => [robot.infrared.range, 0.0],
        };
        let text = format!("distance of what is near, {prefix}{angle:.0} degrees to the left of ahead");
        Quantity { is_linear: self.model == InfraredModel::Rays, ..Quantity::new(text, "m", ends) }
    }

    fn rays(&self, robot: Option<&MobileRobot>) -> usize {
        let rays = |robot: &MobileRobot| robot.infrared.angles.len() * robot.infrared.rays;
        if self.model == InfraredModel::Rays { robot.map_or(0, rays) } else { 0 }
    }

    fn files(&self) -> Vec<(String, String)> {
        self.tables.as_ref().map_or_else(Vec::new, MeasuredTables::files)
    }
}
