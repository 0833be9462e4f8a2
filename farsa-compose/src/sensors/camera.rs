//! Cameras with sectors.

use farsa_body::Pose;
use farsa_body::ports::{BodyId, Channels, Sensor};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::{Beam, ColorBand, LinearCamera};
use farsa_lab::Error;
use farsa_physics::{arena, articulated};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{PartScene, Quantity, SensorPart};
use crate::sensors::color::ColorRange;
use crate::sensors::wrong;

/// A camera of sectors from left to right. Each channel is the share of a sector that shows a color. With a robot
/// with joints it sees colored things in the horizontal plane at `world.sight_height`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Camera {
    /// Body of a robot with joints that carries the camera at its origin, with the view along its x axis, by default
    /// the first.
    body: Option<String>,
    /// Field of view around straight ahead [deg].
    #[schemars(range(min = 1.0, max = 360.0))]
    field_of_view: f64,
    /// Sectors from left to right.
    #[schemars(range(min = 1, max = 1000))]
    sectors: u32,
    /// Rays in each sector.
    #[serde(default = "nine")]
    #[schemars(range(min = 1, max = 1000))]
    rays: u32,
    /// Range [m].
    #[schemars(range(min = 0.001, max = 1000.0))]
    range: f64,
    /// Colors of the channels.
    colors: Vec<ColorRange>,
}

fn nine() -> u32 {
    9
}

type Sectors = LinearCamera<Vec<Beam>, Vec<ColorBand>>;

/// A camera for each world, although some have nothing to see.
#[derive(Clone, Debug)]
pub(super) struct CameraSensor(Sectors);

/// A world that draws the view of a camera.
pub(super) trait Shows {
    fn show(&self, camera: &mut Sectors, out: &mut [f32]);
}

macro_rules! shows {
    ($($world:ty),*) => {
        $(impl Shows for $world {
            fn show(&self, camera: &mut Sectors, out: &mut [f32]) {
                camera.read(self, out);
            }
        })*
    };
}
shows!(arena::World, arena::Lane<'_>, articulated::World<f32>, articulated::Lane<'_>);
#[cfg(feature = "rapier")]
shows!(farsa_physics::rapier::ArenaWorld);

#[cfg(feature = "rapier")]
impl Shows for farsa_physics::rapier::World {
    /// Draws nothing, because files with a camera are rejected for this engine.
    fn show(&self, _: &mut Sectors, out: &mut [f32]) {
        out.fill(0.0);
    }
}

impl Channels for CameraSensor {
    fn channels(&self) -> usize {
        self.0.channels()
    }

    fn reset(&mut self) {
        self.0.reset();
    }
}

impl<W: Shows> Sensor<W> for CameraSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        world.show(&mut self.0, out);
    }
}

impl Camera {
    fn on(&self, body: BodyId) -> Result<CameraSensor, Error> {
        let bands = self.colors.iter().map(ColorRange::band).collect();
        let (view, [sectors, rays]) = (self.field_of_view.to_radians(), [self.sectors as usize, self.rays as usize]);
        LinearCamera::for_view(body, view, sectors, rays, bands, self.range as f32).map(CameraSensor).map_err(wrong)
    }
}

impl SensorPart for Camera {
    type Sensor = CameraSensor;

    fn sensor(&self, scene: &PartScene<'_>) -> Result<CameraSensor, Error> {
        let (body, placement) = scene.0.frame(self.body.as_ref(), "body")?;
        if !scene.0.shows() {
            return Err(scene.error("sees nothing in `rapier`; take the engine `articulated`"));
        }
        if placement != Pose::identity() {
            let why = format!("lies within `{}`; a camera is at the origin of a body", scene.0.body_name(body));
            return Err(scene.0.error_at("body", why));
        }
        self.on(body)
    }

    fn quantity(&self, channel: usize, _: &PartScene<'_>) -> Quantity {
        let colors = self.colors.len().max(1);
        let color = self.colors.get(channel % colors).map_or("", |color| color.name.as_str());
        let sector = channel / colors + 1;
        Quantity::new(format!("share of sector {sector} from the left that is {color}"), "1", [0.0, 1.0])
    }

    fn rays(&self, _: Option<&MobileRobot>) -> usize {
        self.sectors as usize * self.rays as usize
    }
}
