//! Signals.

use farsa_body::ChannelError;
use farsa_body::ports::{BodyId, Channels, Sensor};
use farsa_body::sensors::SignalSensor;
use farsa_lab::Error;
use farsa_lab::advanced::PlanarWorld;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::wrong;

/// Signals of other robots, in sectors counter-clockwise from ahead: the strongest, 0 to 1.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Signal {
    /// Range of the sensor [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    range: f64,
    /// Sectors around the robot: 1, 2, 4 or 8.
    #[serde(default = "four")]
    #[schemars(range(min = 1, max = 8))]
    sectors: u32,
    /// Reads the mean of a sector instead of the strongest signal.
    #[serde(default)]
    mean: bool,
}

fn four() -> u32 {
    4
}

/// A sensor with this number of sectors.
#[derive(Clone, Debug)]
pub(super) enum Sectors {
    One(SignalSensor<1>),
    Two(SignalSensor<2>),
    Four(SignalSensor<4>),
    Eight(SignalSensor<8>),
}

impl Channels for Sectors {
    fn channels(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Four(_) => 4,
            Self::Eight(_) => 8,
        }
    }
}

impl<W: PlanarWorld> Sensor<W> for Sectors {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        match self {
            Self::One(sensor) => sensor.read(world, out),
            Self::Two(sensor) => sensor.read(world, out),
            Self::Four(sensor) => sensor.read(world, out),
            Self::Eight(sensor) => sensor.read(world, out),
        }
    }
}

impl Signal {
    fn with_sectors<const N: usize>(&self, body: BodyId) -> Result<SignalSensor<N>, Error> {
        let sensor = SignalSensor::new(body, self.range as f32).map_err(wrong)?;
        Ok(if self.mean { sensor.mean() } else { sensor })
    }
}

impl SensorPart for Signal {
    type Sensor = Sectors;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<Sectors, Error> {
        let body = scene.planar()?.parts.body;
        Ok(match self.sectors {
            1 => Sectors::One(self.with_sectors(body)?),
            2 => Sectors::Two(self.with_sectors(body)?),
            4 => Sectors::Four(self.with_sectors(body)?),
            8 => Sectors::Eight(self.with_sectors(body)?),
            other => {
                let (field, count) = ("sectors, of 1, 2, 4 or 8", other as usize);
                return Err(wrong(ChannelError::Groups { field, count, size: 1 }));
            }
        })
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        Quantity::new(format!("signal in sector {} counter-clockwise from ahead", channel + 1), "1", [0.0, 1.0])
    }
}
