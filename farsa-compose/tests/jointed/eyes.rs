//! Sight of robots with joints: cameras of a plane and eyes with an image.

use farsa_lab::advanced::{ImageChannel, Recording};
use farsa_lab::{EpisodeId, Evaluation};

use crate::{FELT, close, file, made, measured, outcome, refused};

/// A camera at the axis of the bar that looks along it, with a red ball of 20 cm two metres ahead, and nothing that falls.
fn watching(sight: f64, at: &str) -> String {
    let world = format!("gravity = [0.0, 0.0, 0.0]\nfloor = false\nsight_height = {sight:?}");
    let camera = "[[sensors]]\nkind = \"camera\"\nbody = \"rod\"\nfield_of_view = 60.0\nsectors = 3\nrange = 5.0\n\
                  colors = [{ name = \"red\", low = [0.5, 0.0, 0.0], high = [1.0, 0.3, 0.3] }]";
    let ball = format!(
        "[[objects]]\nkind = \"ball\"\nname = \"apple\"\nat = {at}\nradius = 0.2\nmass = 1.0\ncolor = [1.0, 0.0, 0.0]"
    );
    let rest = format!("{}\n{ball}", FELT.replace("joint-position", "camera"));
    file(&world, "kind = \"joint-velocity\"\nlargest = 2.0\ngain = 50.0", &rest)
        .replace("[[motors]]", &format!("{camera}\n[[motors]]"))
}

#[test]
fn cameras_see_coloured_things_in_their_plane() {
    // Rays every 20 / 9 degrees. The ball is 5.7 degrees to each side, and 3.8 in a plane above its center.
    for (sight, share) in [(1.0, 5.0), (1.15, 3.0), (1.25, 0.0)] {
        close(measured(&outcome(&watching(sight, "[2.0, 0.0, 1.0]"), 0.5), "sensor"), share / 9.0, 1e-6);
    }
    // Behind it, and too far away.
    for at in ["[-2.0, 0.0, 1.0]", "[5.5, 0.0, 1.0]"] {
        close(measured(&outcome(&watching(1.0, at), 0.5), "sensor"), 0.0, 0.0);
    }
    // While the bar turns, in lanes as alone.
    let mut evaluator = made(&watching(1.0, "[1.0, 1.0, 1.0]")).expect("an evaluator");
    let parameters = vec![0.7; evaluator.info().parameters.len()];
    let evaluation = Evaluation::new(&parameters, EpisodeId::default());
    let alone = evaluator.evaluate(evaluation, None);
    let lanes = evaluator.in_lanes().expect("lanes");
    lanes.use_lanes(farsa_lab::advanced::Lanes::best()).expect("a batch");
    let (mut next, mut in_lanes) = (Some(evaluation), Vec::new());
    lanes.run_in_lanes(&mut || next.take(), &mut |_, outcome| in_lanes.push(outcome));
    assert_eq!(in_lanes, [alone]);
    let found = refused(&watching(1.0, "[2.0, 0.0, 1.0]").replace("body = \"rod\"", "body = \"rot\""));
    assert!(found.contains("body `rot`") || found.contains("rod"), "{found}");
}

const EYE: &str = "eye = { body = \"rod\", columns = 9, rows = 7, field_of_view = 60.0, range = 5.0 }";

/// The bar with this eye's sensor instead of its camera, and a green ball next to the red one.
fn eyed(sensor: &str) -> String {
    let text = watching(1.0, "[2.0, 0.0, 1.0]");
    let (before, rest) = text.split_once("kind = \"camera\"").expect("a camera");
    let (_, after) = rest.split_once("[[motors]]").expect("motors");
    let (before, after) = (before.to_owned(), after.replace("sensor = \"camera\"", "sensor = \"joint-position\""));
    let pear = "[[objects]]\nkind = \"ball\"\nname = \"pear\"\nat = [2.0, 0.5, 1.0]\nradius = 0.1\nmass = 1.0\ncolor = [0.0, 1.0, 0.0]";
    format!("{before}{sensor}\n[[motors]]{}", after.replacen("[files]", &format!("{pear}\n[files]"), 1))
}

/// Returns the recording of the first step of a trial at rest.
fn recorded(text: &str) -> Recording {
    let mut evaluator = made(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let mut recording = Recording::new(evaluator.info().schema);
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), Some(&mut recording));
    recording
}

/// A sensor's values at the first tick, by the beginning of their columns.
fn sensed(recording: &Recording, name: &str) -> Vec<f64> {
    let columns = recording.schema().columns();
    let values = columns.iter().zip(recording.row(0));
    values.filter(|(column, _)| column.starts_with(&format!("sensor.{name}"))).map(|(_, value)| value).collect()
}

#[test]
fn eyes_see_what_is_before_them_and_recordings_have_their_images() {
    let recording = recorded(&eyed(&format!("kind = \"camera-image\"\n{EYE}")));
    assert_eq!(recording.schema().images, [ImageChannel::new("camera-image", [9, 7])]);
    let image: Vec<[f32; 3]> = recording.image_at(0, 0).expect("an image").collect();
    // By hand: a ray through the middle of each pixel, which are squares, and its distance from the balls' middles.
    let half = farsa_num::sin_cos(std::f64::consts::PI / 6.0);
    let half = half.0 / half.1;
    let (mut reds, mut greens) = (0, 0);
    for (index, seen) in image.iter().enumerate() {
        let ray = [1.0, half * (8.0 - 2.0 * (index % 9) as f64) / 9.0, half * (6.0 - 2.0 * (index / 9) as f64) / 9.0];
        let square = ray.iter().map(|x| x * x).sum::<f64>();
        let meets = |middle: [f64; 3], radius: f64| {
            let along = (0..3).map(|k| ray[k] * middle[k]).sum::<f64>() / square;
            (0..3).map(|k| (middle[k] - along * ray[k]) * (middle[k] - along * ray[k])).sum::<f64>() < radius * radius
        };
        let expected = if meets([2.0, 0.0, 0.0], 0.2) {
            reds += 1;
            [1.0, 0.0, 0.0]
        } else if meets([2.0, 0.5, 0.0], 0.1) {
            greens += 1;
            [0.0, 1.0, 0.0]
        } else {
            [0.0; 3]
        };
        assert_eq!(*seen, expected, "pixel {index}");
    }
    assert!(reds > 0 && greens > 0, "{reds} {greens}");
    let values: Vec<f64> = image.iter().flatten().map(|shade| f64::from(*shade)).collect();
    assert_eq!(sensed(&recording, "camera-image"), values);

    let colors = "colors = [{ name = \"red\", low = [0.5, 0.0, 0.0], high = [1.0, 0.3, 0.3] }]";
    let recording = recorded(&eyed(&format!("kind = \"color-blobs\"\n{EYE}\n{colors}")));
    assert_eq!(recording.image_at(0, 0).expect("an image").collect::<Vec<_>>(), image);
    let found = sensed(&recording, "color-blobs");
    for (found, wanted) in found.iter().zip([0.0, 0.0, f64::from(reds) / 63.0]) {
        close(*found, wanted, 1e-6);
    }
    assert_eq!(found.len(), 3);

    // The pear is a quarter to the left of straight ahead, of half a width of tan 30 degrees.
    let recording = recorded(&eyed(&format!("kind = \"visual-offset\"\n{EYE}\nof = \"pear\"\nfrom = \"apple\"")));
    let found = sensed(&recording, "visual-offset");
    close(found[0], 0.5 * 0.25 / half, 1e-6);
    close(found[1], 0.0, 1e-6);
    assert!(recording.schema().images.is_empty());

    // Moved and turned about x, then y, then z, it is R = Rz Ry Rx.
    let (at, turned) = ([0.1, 0.2, 0.3], [20.0, -15.0, 25.0]);
    let eye = EYE.replace("columns", &format!("at = {at:?}, turned = {turned:?}, columns"));
    let recording = recorded(&eyed(&format!("kind = \"visual-offset\"\n{eye}\nof = \"pear\"\nfrom = \"apple\"")));
    let [[sa, ca], [sb, cb], [sc, cc]] =
        turned.map(|angle: f64| <[f64; 2]>::from(farsa_num::sin_cos(angle.to_radians())));
    let axes = [
        [cc * cb, sc * cb, -sb],
        [cc * sb * sa - sc * ca, sc * sb * sa + cc * ca, cb * sa],
        [cc * sb * ca + sc * sa, sc * sb * ca - cc * sa, cb * ca],
    ];
    let projected = |place: [f64; 3]| {
        // The body is 1 m above the origin.
        let way = [place[0] - at[0], place[1] - at[1], place[2] - 1.0 - at[2]];
        let [ahead, left, up] = axes.map(|axis| (0..3).map(|k| axis[k] * way[k]).sum::<f64>());
        [left / ahead / half, up / ahead / half]
    };
    let (of, from) = (projected([2.0, 0.5, 1.0]), projected([2.0, 0.0, 1.0]));
    for (k, found) in sensed(&recording, "visual-offset").into_iter().enumerate() {
        close(found, 0.5 * (of[k] - from[k]), 1e-5);
    }
    assert!((of[1] - from[1]).abs() > 0.02, "{of:?} {from:?}");

    // Turned back it sees nothing.
    let back = EYE.replace("columns", "turned = [0.0, 0.0, 180.0], columns");
    let recording = recorded(&eyed(&format!("kind = \"color-blobs\"\n{back}\n{colors}")));
    assert_eq!(sensed(&recording, "color-blobs"), [0.0; 3]);
}

#[test]
fn eyes_that_cannot_be_are_refused_by_name() {
    let image = eyed(&format!("kind = \"camera-image\"\n{EYE}"));
    let found = refused(&image.replace("body = \"rod\", columns", "body = \"rood\", columns"));
    assert!(found.contains("line") && found.contains("`rood`") && found.contains("`rod`"), "{found}");
    let found = refused(&image.replace("columns = 9", "columns = 0"));
    assert!(found.contains("columns"), "{found}");
    let found = refused(&image.replace("columns = 9, rows = 7", "columns = 1000, rows = 1000"));
    assert!(found.contains("1000000 rays"), "{found}");
    let offset = eyed(&format!("kind = \"visual-offset\"\n{EYE}\nof = \"pear\"\nfrom = \"apple\""));
    let found = refused(&offset.replace("of = \"pear\"", "of = \"peer\""));
    assert!(found.contains("`peer`") && found.contains("`pear`"), "{found}");
    let wheels = "[robot]\nkind = \"e-puck\"\n[[sensors]]\nkind = \"camera-image\"\neye = { columns = 1, rows = 1, field_of_view = 60.0, range = 1.0 }\n\
                  [[motors]]\nkind = \"wheels\"\n[network]\nkind = \"perceptron\"\n[[reward]]\nkind = \"steps\"\n";
    let found = refused(wheels);
    assert!(found.contains("is for robots with joints"), "{found}");
}

#[cfg(feature = "rapier")]
#[test]
fn cameras_are_refused_where_they_see_nothing() {
    let found = refused(&watching(1.0, "[2.0, 0.0, 1.0]").replace("\"articulated\"", "\"rapier\""));
    assert!(found.contains("sees nothing in `rapier`; take the engine `articulated`"), "{found}");
}

#[cfg(feature = "rapier")]
#[test]
fn eyes_see_the_same_in_rapier() {
    let colors = "colors = [{ name = \"red\", low = [0.5, 0.0, 0.0], high = [1.0, 0.3, 0.3] }]";
    for (name, rest) in
        [("camera-image", ""), ("color-blobs", colors), ("visual-offset", "of = \"pear\"\nfrom = \"apple\"")]
    {
        let text = eyed(&format!("kind = \"{name}\"\n{EYE}\n{rest}"));
        let [ours, other] = [text.clone(), text.replace("\"articulated\"", "\"rapier\"")].map(|text| recorded(&text));
        let [seen, there] = [&ours, &other].map(|recording| sensed(recording, name));
        assert!(seen.iter().any(|value| *value > 0.01), "{name}: {seen:?}");
        assert_eq!(seen.len(), there.len());
        for (here, there) in seen.into_iter().zip(there) {
            close(here, there, 1e-6);
        }
        let [image, there] = [&ours, &other].map(|recording| recording.image_at(0, 0).map(Iterator::collect::<Vec<_>>));
        assert!(image == there, "{name}");
    }
}
