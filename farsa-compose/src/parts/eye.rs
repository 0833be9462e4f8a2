//! Cameras with sectors.

use farsa_body::ChannelError;
use farsa_body::ports::BodyId;
use farsa_body::sensors::{Beam, ColorBand, LinearCamera};

use crate::document::{Camera, ColorRange, SensorKind};
use crate::parts::channel_quantity::ChannelQuantity;

/// A camera.
pub(crate) type Eye = LinearCamera<Vec<Beam>, Vec<ColorBand>>;

/// Builds a camera on a body.
pub(crate) fn eye(body: BodyId, camera: &Camera) -> Result<Eye, ChannelError> {
    let bands = camera.colors.iter().map(band).collect();
    let (view, [sectors, rays]) = (camera.field_of_view.to_radians(), [camera.sectors, camera.rays]);
    LinearCamera::for_view(body, view, sectors as usize, rays as usize, bands, camera.range as f32)
}

/// Rounds a range of colors to single precision.
pub(crate) fn band(color: &ColorRange) -> ColorBand {
    let [low, high] = [color.low, color.high].map(|ends| ends.map(|x| x as f32));
    ColorBand { low, high }
}

/// Describes the quantity of a camera channel.
pub(crate) fn seen(camera: &Camera, channel: usize) -> ChannelQuantity {
    let colors = camera.colors.len().max(1);
    let color = camera.colors.get(channel % colors).map_or("", |color| color.name.as_str());
    let sector = channel / colors + 1;
    ChannelQuantity::new(format!("share of sector {sector} from the left that is {color}"), "1", [0.0, 1.0])
}

/// Counts the rays of a sensor in a step. Rays of infrared sensors depend on the robot.
pub(crate) fn rays_of(kind: &SensorKind) -> usize {
    match kind {
        SensorKind::LaserDistance { beams, .. } => *beams as usize,
        SensorKind::Camera(camera) => camera.sectors as usize * camera.rays as usize,
        SensorKind::CameraImage { eye } | SensorKind::ColorBlobs { eye, .. } => {
            eye.columns as usize * eye.rows as usize
        }
        _ => 0,
    }
}
