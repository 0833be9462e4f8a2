//! Eyes of a robot with joints: cameras with an image.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::sensors::{Camera, CameraImage, ColorBlobs, VisualOffset};
use farsa_lab::Error;
use farsa_num::sin_cos;

use crate::check::source::Source;
use crate::document::{ColorRange, Eye};
use crate::jointed::named_point::NamedPoint;
use crate::jointed::scene::Scene;
use crate::parts::channel_quantity::ChannelQuantity;
use crate::parts::eye::band;

/// Builds the camera of an eye with the given numbers of columns and rows.
fn camera(eye: &Eye, size: [usize; 2], scene: &Scene, path: &str, source: &Source) -> Result<Camera, Error> {
    let (body, frame) = scene.body(eye.body.as_ref(), &format!("{path}/eye/body"), source)?;
    let about = |axis: usize| {
        // A turn by a about axis k is the quaternion with sin(a/2) at k and cos(a/2) last. The document has degrees.
        let (sine, cosine) = sin_cos(0.5 * eye.turned[axis].to_radians());
        let mut rotation = [0.0, 0.0, 0.0, cosine];
        rotation[axis] = sine;
        Pose { rotation, ..Pose::identity() }
    };
    // R = Rz Ry Rx, so the turn about x is applied first.
    let turned = about(2).compose(&about(1)).compose(&about(0));
    let placement = frame.compose(&Pose::at(eye.at)).compose(&turned);
    let made = Camera::new(body, placement.cast(), size, eye.field_of_view.to_radians(), eye.range as f32);
    made.map_err(|error| source.wrong(path, error))
}

fn size(eye: &Eye) -> [usize; 2] {
    [eye.columns, eye.rows].map(|count| count as usize)
}

/// Builds a sensor of the image.
pub(crate) fn image(eye: &Eye, scene: &Scene, path: &str, source: &Source) -> Result<CameraImage, Error> {
    Ok(CameraImage::new(camera(eye, size(eye), scene, path, source)?))
}

/// Builds a sensor of the positions of colors in the image.
pub(crate) fn blobs(
    eye: &Eye,
    colors: &[ColorRange],
    scene: &Scene,
    path: &str,
    source: &Source,
) -> Result<ColorBlobs, Error> {
    let made = ColorBlobs::new(camera(eye, size(eye), scene, path, source)?, colors.iter().map(band).collect());
    made.map_err(|error| source.wrong(path, error))
}

/// Builds a sensor of the offset between two things or bodies in the image.
pub(crate) fn offset(
    eye: &Eye,
    [of, from]: [&String; 2],
    scene: &Scene,
    path: &str,
    source: &Source,
) -> Result<VisualOffset, Error> {
    let point = |name: &String, key: &str| -> Result<(BodyId, [f32; 3]), Error> {
        let path = format!("{path}/{key}");
        match scene.point_named(name, &path, source)?.0 {
            NamedPoint::Body(point) => Ok((point.body, point.at)),
            NamedPoint::Marker(_) => Err(source.wrong(&path, format!("`{name}` is a marker, which no eye sees"))),
        }
    };
    let (target, from) = (point(of, "of")?, point(from, "from")?);
    // Only the pose and the field of view of the camera matter.
    Ok(VisualOffset::new(camera(eye, [1, 1], scene, path, source)?, target, from))
}

/// Describes the quantity of an image channel.
pub(crate) fn of_image(eye: &Eye, channel: usize) -> ChannelQuantity {
    let color = ["red", "green", "blue"][channel % 3];
    // Pixels are row by row, with three colors each.
    let (column, row) = (channel / 3 % eye.columns as usize, channel / 3 / eye.columns as usize);
    ChannelQuantity::new(format!("{color} of the pixel in column {column}, row {row}"), "1", [0.0, 1.0])
}

/// Describes the quantity of a channel of blobs.
pub(crate) fn of_blobs(colors: &[ColorRange], channel: usize) -> ChannelQuantity {
    let color = colors.get(channel / 3).map_or("", |color| color.name.as_str());
    let what = match channel % 3 {
        0 => format!("halves of the image's width that {color} is to the left"),
        1 => format!("halves of the image's width that {color} is upwards"),
        _ => format!("share of the pixels that are {color}"),
    };
    ChannelQuantity::new(what, "1", [0.0, 1.0])
}

/// Describes the quantity of a channel of an offset.
pub(crate) fn of_offset([of, from]: [&str; 2], channel: usize) -> ChannelQuantity {
    let way = ["to the left", "above"][channel % 2];
    ChannelQuantity::new(format!("widths of the image that {of} is {way} of {from}"), "1", [0.0, 1.0])
}
