//! The eyes of a robot with joints: cameras with an image on its bodies.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::sensors::{Camera, CameraImage, ColorBand, ColorBlobs, VisualOffset};
use farsa_lab::Error;
use farsa_num::sin_cos;

use crate::check::places::Places;
use crate::document::{ColorRange, Eye};
use crate::jointed::scene::Scene;
use crate::jointed::spot::Spot;
use crate::parts::meaning::Meaning;

/// The camera of an eye of so many columns and rows.
fn camera(eye: &Eye, size: [usize; 2], scene: &Scene, path: &str, places: &Places) -> Result<Camera, Error> {
    let (body, frame) = scene.body(eye.body.as_ref(), &format!("{path}/eye/body"), places)?;
    let about = |axis: usize| {
        let (sine, cosine) = sin_cos(0.5 * eye.turned[axis].to_radians());
        let mut rotation = [0.0, 0.0, 0.0, cosine];
        rotation[axis] = sine;
        Pose { rotation, ..Pose::identity() }
    };
    let turned = about(2).compose(&about(1)).compose(&about(0));
    let placement = frame.compose(&Pose::at(eye.at)).compose(&turned);
    let made = Camera::new(body, placement.cast(), size, eye.field_of_view.to_radians(), eye.range as f32);
    made.map_err(|error| places.wrong(path, error))
}

fn size(eye: &Eye) -> [usize; 2] {
    [eye.columns, eye.rows].map(|count| count as usize)
}

/// The image of an eye.
///
/// # Errors
/// [`Error::Unknown`] for a body that there is not.
pub(crate) fn image(eye: &Eye, scene: &Scene, path: &str, places: &Places) -> Result<CameraImage, Error> {
    Ok(CameraImage::new(camera(eye, size(eye), scene, path, places)?))
}

/// Where colours are in the image of an eye.
///
/// # Errors
/// [`Error::Unknown`] for a body that there is not, [`Error::Setting`] without colours.
pub(crate) fn blobs(
    eye: &Eye,
    colors: &[ColorRange],
    scene: &Scene,
    path: &str,
    places: &Places,
) -> Result<ColorBlobs, Error> {
    let narrow = |ends: [f64; 3]| ends.map(|x| x as f32);
    let bands = colors.iter().map(|color| ColorBand { low: narrow(color.low), high: narrow(color.high) });
    let made = ColorBlobs::new(camera(eye, size(eye), scene, path, places)?, bands.collect());
    made.map_err(|error| places.wrong(path, error))
}

/// How far one thing or body is from another in the image of an eye.
///
/// # Errors
/// [`Error::Unknown`] for a body or thing that there is not, [`Error::Setting`] for a marker.
pub(crate) fn offset(
    eye: &Eye,
    [of, from]: [&String; 2],
    scene: &Scene,
    path: &str,
    places: &Places,
) -> Result<VisualOffset, Error> {
    let point = |name: &String, key: &str| -> Result<(BodyId, [f32; 3]), Error> {
        let path = format!("{path}/{key}");
        match scene.spot(name, &path, places)?.0 {
            Spot::Body(point) => Ok((point.body, point.at)),
            Spot::Marker(_) => Err(places.wrong(&path, format!("`{name}` is a marker, which no eye sees"))),
        }
    };
    let (of, from) = (point(of, "of")?, point(from, "from")?);
    // Of the camera only its place and field of view matter.
    Ok(VisualOffset::new(camera(eye, [1, 1], scene, path, places)?, of, from))
}

/// What a channel of an image reads.
pub(crate) fn of_image(eye: &Eye, channel: usize) -> Meaning {
    let color = ["red", "green", "blue"][channel % 3];
    let (column, row) = (channel / 3 % eye.columns as usize, channel / 3 / eye.columns as usize);
    Meaning::new(format!("{color} of the pixel in column {column}, row {row}"), "1", [0.0, 1.0])
}

/// What a channel of blobs reads.
pub(crate) fn of_blobs(colors: &[ColorRange], channel: usize) -> Meaning {
    let color = colors.get(channel / 3).map_or("", |color| color.name.as_str());
    let what = match channel % 3 {
        0 => format!("halves of the image's width that {color} is to the left"),
        1 => format!("halves of the image's width that {color} is upwards"),
        _ => format!("share of the pixels that are {color}"),
    };
    Meaning::new(what, "1", [0.0, 1.0])
}

/// What a channel of an offset reads.
pub(crate) fn of_offset([of, from]: [&str; 2], channel: usize) -> Meaning {
    let way = ["to the left", "above"][channel % 2];
    Meaning::new(format!("widths of the image that {of} is {way} of {from}"), "1", [0.0, 1.0])
}
