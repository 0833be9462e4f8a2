//! A page that shows recorded episodes in a browser: one file, no network.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::page::episode_data::EpisodeData;
use crate::recording::memory::Recording;
use crate::recording::view::View;

const TEMPLATE: &str = include_str!("viewer/page.html");
const STYLE: &str = concat!(include_str!("viewer/palette.css"), include_str!("viewer/viewer.css"));
const SCRIPTS: &[&str] = &[
    include_str!("viewer/data.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/scene.js"),
    include_str!("viewer/view.js"),
    include_str!("viewer/strips.js"),
    include_str!("viewer/images.js"),
    include_str!("viewer/network.js"),
    include_str!("viewer/film.js"),
    include_str!("viewer/player.js"),
    include_str!("viewer/main.js"),
];

/// Additional permissions of a live page: to compile its module in a worker.
const LIVE_POLICY: &str = " 'wasm-unsafe-eval' blob:; worker-src blob:";
/// Additional permissions of a served page: also to connect to its server.
const SERVED_POLICY: &str = " 'wasm-unsafe-eval' blob:; worker-src blob:; connect-src 'self'";
const LIVE_SCRIPT: &str = concat!(
    include_str!("viewer/live.js"),
    include_str!("viewer/settings.js"),
    include_str!("viewer/keep.js"),
    include_str!("viewer/summary.js"),
    include_str!("viewer/evolve.js"),
    include_str!("viewer/move.js")
);

/// A page for the browser that shows recorded episodes. Bodies in space, time series and the network share a single
/// clock.
///
/// Since the page is a single file without external resources, you can send it to others as it is. Its data format is
/// described in `docs/replay-format.md` of the project.
#[derive(Clone, Debug, Default)]
pub struct Page {
    title: String,
    episodes: Vec<EpisodeData>,
    second: Option<usize>,
}

impl Page {
    /// Creates a page without episodes.
    pub fn new(title: &str) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    /// Appends an episode, and returns the page.
    pub fn with(mut self, name: &str, recording: Recording) -> Self {
        self.add(name, Vec::new(), recording);
        self
    }

    /// Appends an episode with named facts about it, such as its fitness.
    pub fn add(&mut self, name: &str, facts: Vec<(String, String)>, recording: Recording) {
        self.episodes.push(EpisodeData { name: name.into(), facts, recording });
    }

    /// Counts the episodes of this page.
    pub fn episodes(&self) -> usize {
        self.episodes.len()
    }

    /// Selects an episode by its index. When the page opens, it is shown next to the first one.
    pub fn open_beside(&mut self, episode: usize) {
        self.second = Some(episode);
    }

    /// Writes the data of an episode as JSON, in the format of docs/replay-format.md.
    ///
    /// If there is no such episode, this returns `None`.
    pub fn episode(&self, number: usize) -> Option<String> {
        self.episodes.get(number).map(|episode| episode.json().to_string())
    }

    /// Writes the complete page as HTML.
    pub fn html(&self) -> String {
        let top = self.episodes.first().is_some_and(|episode| episode.recording.schema().view == View::Top);
        let mut data = data_head(&self.title, top);
        let mut episodes: Vec<Value> = self.episodes.iter().map(EpisodeData::json).collect();
        share_meshes(&mut episodes);
        data["episodes"] = episodes.into();
        if let Some(second) = self.second {
            data["beside"] = second.into();
        }
        composed(&self.title, &data, Kind::Recorded)
    }
}

/// Replaces the meshes of an episode by the index of the first episode with the same ones.
fn share_meshes(episodes: &mut [Value]) {
    for index in 1..episodes.len() {
        let (before, rest) = episodes.split_at_mut(index);
        let Some(meshes) = rest[0].get_mut("meshes") else { continue };
        if let Some(first) = before.iter().position(|episode| episode.get("meshes") == Some(meshes)) {
            *meshes = first.into();
        }
    }
}

/// Returns the first keys of the data of every page.
pub(crate) fn data_head(title: &str, from_above: bool) -> Value {
    json!({
        "format": "farsa-replay",
        "version": 1,
        "made_by": concat!("farsa ", env!("CARGO_PKG_VERSION")),
        "title": title,
        "view": if from_above { "top" } else { "free" },
    })
}

/// Kind of a page, which decides its permissions and scripts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Shows recorded episodes.
    Recorded,
    /// Runs WebAssembly in its own workers.
    Live,
    /// Runs WebAssembly and connects to its server.
    Served,
}

/// Composes the HTML of a page.
pub(crate) fn composed(title: &str, data: &Value, kind: Kind) -> String {
    // A text of a recording must not end the script element.
    let data = data.to_string().replace('<', "\\u003c");
    let (policy, more) = match kind {
        Kind::Recorded => ("", ""),
        Kind::Live => (LIVE_POLICY, LIVE_SCRIPT),
        Kind::Served => (SERVED_POLICY, LIVE_SCRIPT),
    };
    let parts = [
        ("{{policy}}", policy.to_owned()),
        ("{{title}}", escaped(title)),
        ("{{style}}", lean(STYLE)),
        ("{{script}}", lean(&SCRIPTS.concat()) + &lean(more)),
        ("{{data}}", data),
    ];
    let mut html = String::new();
    let mut rest = TEMPLATE;
    for (mark, part) in parts {
        let Some((before, after)) = rest.split_once(mark) else { continue };
        html.push_str(before);
        html.push_str(&part);
        rest = after;
    }
    html.push_str(rest);
    html
}

/// Removes indentation, comment lines, empty lines and most ends of lines, a fifth of a script.
fn lean(source: &str) -> String {
    let lines = source.lines().map(str::trim_start).filter(|line| !line.is_empty() && !line.starts_with("//"));
    // After these letters neither language needs the end of a line.
    let end = |line: &str| if line.ends_with([';', '{', ',']) { "" } else { "\n" };
    lines.flat_map(|line| [line, end(line)]).collect()
}

/// Escapes text for HTML.
pub(crate) fn escaped(text: &str) -> String {
    let mut html = String::new();
    for letter in text.chars() {
        match letter {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&quot;"),
            other => html.push(other),
        }
    }
    html
}

/// Formats a number for readers. It has at most three decimals, and none if it is whole.
pub fn readable(x: f64) -> String {
    let mut text = String::new();
    // A tiny negative number would be -0.000.
    let x = if x.abs() < 0.0005 { 0.0 } else { x };
    let decimals = if x.abs() >= 1000.0 || x == x.round() {
        0
    } else if x.abs() >= 10.0 {
        1
    } else {
        3
    };
    // Writing to a string does not fail.
    let _ = write!(text, "{x:.decimals$}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::schema::{ImageChannel, Schema};
    use crate::shape::scene_mesh::SceneMesh;
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;
    use farsa_body::ports::{PairContact, PairId};
    use farsa_body::robots::Tabletop;
    use farsa_body::{Pose, Recorder};
    use farsa_num::crc32;

    /// The data of a page, as a browser reads it.
    fn data(html: &str) -> Value {
        let (_, rest) = html.split_once("id=\"data\">").unwrap();
        let (text, _) = rest.split_once("</script>").unwrap();
        serde_json::from_str(text).unwrap()
    }

    fn word(bytes: &[u8], at: u64) -> u16 {
        u16::from_le_bytes([bytes[at as usize], bytes[at as usize + 1]])
    }

    #[test]
    fn recorded_values_are_read_back_within_the_stated_error() {
        let robot = Tabletop::default().scene(&farsa_body::robots::ArmAndHand::default()).unwrap();
        let mut schema = Schema::from_robot(&robot).with_sensors(["a </script> <b>"]).with_scalars(["x [m]", "n"]);
        schema.points = vec!["p".into()];
        let mut recording = Recording::new(schema);
        let sphere = Tabletop::SPHERE;
        let place = |tick: u16| [0.01 * f32::from(tick), -0.3, 0.5];
        for tick in 0..100_u16 {
            recording.pose(sphere, Pose { position: place(tick), rotation: [0.0, 0.6, 0.0, -0.8] });
            recording.sensors(&[f32::from(tick).sqrt()]);
            recording.scalars(&[if tick == 7 { f64::NAN } else { 1.0 / f64::from(tick + 1) }, f64::from(tick % 3)]);
            recording.point(0, [1.0, 0.0, 0.0]);
            if tick == 50 {
                let contact =
                    PairContact { force: [0.0, -4.0, 2.0], point: [0.1; 3], points: 1, ..PairContact::default() };
                recording.contact(PairId(3), &contact);
            }
            recording.tick(0.01 * f64::from(tick + 1));
        }
        let html = Page::new("T & <T>").with("one", recording).html();
        assert!(html.contains("<title>T &amp; &lt;T&gt;"));
        assert_eq!(html.matches("</script>").count(), 2);
        let page = data(&html);
        let episode = &page["episodes"][0];
        let bytes = STANDARD.decode(episode["data"].as_str().unwrap()).unwrap();
        assert_eq!(episode["crc32"], crc32(&bytes));
        assert_eq!(episode["bytes"], bytes.len());
        let start = |block: &str| episode["blocks"][block].as_u64().unwrap();
        assert!(episode["blocks"].as_object().unwrap().values().all(|at| at.as_u64().unwrap() % 4 == 0));

        let bodies = episode["bodies"].as_array().unwrap();
        let index = bodies.iter().position(|name| name == "sphere").unwrap() as u64;
        let unit = episode["position_unit"].as_f64().unwrap();
        for tick in [0, 50, 99_u16] {
            let at = start("poses") + 14 * (u64::from(tick) * bodies.len() as u64 + index);
            for k in 0..3 {
                let origin = episode["position_origin"][k].as_f64().unwrap();
                let x = origin + unit * f64::from(word(&bytes, at + 2 * k as u64));
                assert!((x - f64::from(place(tick)[k])).abs() <= 0.51 * unit);
            }
            let w = f64::from(word(&bytes, at + 12).cast_signed()) / 32767.0;
            assert!((w + 0.8).abs() < 2e-5);
        }
        // Scalars come first.
        let channels = episode["channels"].as_array().unwrap();
        assert_eq!(
            channels.iter().map(|c| c["name"].as_str().unwrap()).collect::<Vec<_>>(),
            ["x", "n", "a </script> <b>"]
        );
        let value = |channel: u64, tick: u64| {
            let count = word(&bytes, start("channels") + 2 * (100 * channel + tick));
            let field = |key: &str| channels[channel as usize][key].as_f64().unwrap();
            (count != u16::MAX).then(|| (field("minimum") + field("scale") * f64::from(count), field("scale")))
        };
        assert_eq!(value(0, 7), None);
        assert_eq!((value(1, 4), value(1, 5)), (Some((1.0, 1.0)), Some((2.0, 1.0))));
        for tick in [0, 3, 99] {
            let (x, scale) = value(2, tick).unwrap();
            assert!((x - (tick as f64).sqrt()).abs() <= 0.51 * scale);
        }
        let at = start("contacts") + 2 * 50;
        assert_eq!((word(&bytes, at - 2), word(&bytes, at), word(&bytes, at + 2)), (0, 1, 3));
        let force = f64::from(word(&bytes, at + 12).cast_signed()) * episode["force_unit"].as_f64().unwrap();
        assert!((force - 2.0).abs() < 1e-3 || (force + 4.0).abs() < 1e-3);
        assert_eq!(episode["pairs"].as_array().unwrap().len(), robot.pairs.len());
        assert_eq!(episode["shapes"].as_array().unwrap().len(), robot.colliders.len());
        assert!(episode.get("network").is_none());
    }

    #[test]
    fn images_are_read_back_with_their_colors() {
        let schema = Schema::from_scalars(["x"]).with_image("left eye", [3, 2]).with_image("right eye", [1, 1]);
        let mut recording = Recording::new(schema);
        // Multiples of 1/31 and 1/63 are stored exactly.
        let color = |tick: usize, pixel: usize| [tick as f32 / 31.0, 1.0 - pixel as f32 / 63.0, 1.0];
        for tick in 0..4_usize {
            (0..6).for_each(|pixel| recording.pixel(0, pixel, color(tick / 2, pixel)));
            if tick == 3 {
                recording.pixel(1, 0, [1.0, 0.0, 0.0]);
            }
            recording.tick(0.1 * tick as f64);
        }
        for tick in 0..4_usize {
            let image: Vec<[f32; 3]> = recording.image_at(tick, 0).unwrap().collect();
            let expected: Vec<[f32; 3]> = (0..6).map(|pixel| color(tick / 2, pixel)).collect();
            assert_eq!(image, expected);
        }
        assert!(recording.image_at(2, 1).is_none() && recording.image_at(3, 2).is_none());

        let page = data(&Page::new("eyes").with("one", recording).html());
        let episode = &page["episodes"][0];
        assert_eq!(
            episode["images"],
            json!([{"name": "left eye", "size": [3, 2]}, {"name": "right eye", "size": [1, 1]}])
        );
        let bytes = STANDARD.decode(episode["data"].as_str().unwrap()).unwrap();
        let [starts, pixels] = ["image_starts", "pixels"].map(|block| episode["blocks"][block].as_u64().unwrap());
        assert_eq!((starts % 4, pixels % 4), (0, 0));
        let start = |image: u64, tick: u64| {
            let at = starts + 4 * (4 * image + tick);
            u64::from(word(&bytes, at)) + (u64::from(word(&bytes, at + 2)) << 16)
        };
        assert_eq!([0, 1, 2, 3].map(|tick| start(0, tick)), [0, 0, 6, 6]);
        assert_eq!(
            [0, 1, 2, 3].map(|tick| start(1, tick)),
            [u64::from(u32::MAX), u64::from(u32::MAX), u64::from(u32::MAX), 12]
        );
        for (tick, pixel) in [(0, 0), (1, 4), (3, 5)] {
            let read = word(&bytes, pixels + 2 * (start(0, tick) + pixel));
            let expected = (tick as u16 / 2) << 11 | (63 - pixel as u16) << 5 | 31;
            assert_eq!(read, expected, "{tick} {pixel}");
        }
        assert_eq!(word(&bytes, pixels + 2 * start(1, 3)), 31 << 11);
    }

    #[test]
    fn changes_of_images_on_the_ground_are_written() {
        let mut schema = Schema::from_scalars(["x"]).with_image("eye", [1, 1]);
        let ground = |name: &str| ImageChannel::new(name, [2, 2]).on_ground([0.0, 1.0], [2.0, -0.1]);
        schema.images = vec![ground("food"), schema.images[0].clone(), ground("traces")];
        let mut recording = Recording::new(schema);
        for tick in 0..4_usize {
            (tick.min(2)..4).for_each(|pixel| recording.pixel(0, pixel, [0.0, 1.0, 0.0]));
            recording.pixel(1, 0, [1.0; 3]);
            if tick == 3 {
                recording.pixel(2, 3, [1.0, 0.0, 0.0]);
            }
            recording.tick(0.1 * tick as f64);
        }
        let page = data(&Page::new("food").with("one", recording).html());
        let episode = &page["episodes"][0];
        assert_eq!(episode["images"], json!([{"name": "eye", "size": [1, 1]}]));
        let description = |name: &str| json!({"name": name, "size": [2, 2], "ground": [0, 1, 2, -0.1]});
        assert_eq!(episode["ground_images"], json!([description("food"), description("traces")]));
        let bytes = STANDARD.decode(episode["data"].as_str().unwrap()).unwrap();
        let start = |block: &str| episode["blocks"][block].as_u64().unwrap();
        let (green, red) = (63 << 5, 31 << 11);
        let expected = [4, 0, green, 1, green, 2, green, 3, green, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1, 3, red];
        let words: Vec<u16> =
            (0..expected.len()).map(|i| word(&bytes, start("ground_pixels") + 2 * i as u64)).collect();
        assert_eq!(words, expected);
        // Only the eye is an ordinary image.
        assert_eq!((word(&bytes, start("image_starts")), start("pixels") - start("image_starts")), (0, 4 * 4));
        assert_eq!(start("ground_pixels") - start("pixels"), 4);
    }

    #[test]
    fn labels_are_written_with_names() {
        let hostile = "</script><b>";
        let schema = Schema::from_scalars(["J4 [rad]", "x"]).with_sensors(["J1"]);
        let schema = schema.with_labels(&[("J4", "elbow extension"), ("J1", hostile)]);
        let mut recording = Recording::new(schema);
        recording.tick(0.0);
        let html = Page::new("labels").with("one", recording).html();
        assert!(!html.contains(hostile));
        let page = data(&html);
        let channels = page["episodes"][0]["channels"].as_array().unwrap();
        let labels: Vec<_> = channels.iter().map(|c| (c["name"].as_str().unwrap(), c.get("label"))).collect();
        assert_eq!(labels, [("J4", Some(&json!("elbow extension"))), ("x", None), ("J1", Some(&json!(hostile)))]);
    }

    #[test]
    fn meshes_replace_colliders_and_are_stored_once() {
        let robot = farsa_body::robots::ArmAndHand::default().robot().unwrap();
        let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 2.0, 1.0], [0.0, 0.0, 4.0]];
        let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        let on = |body: usize| SceneMesh::new(robot.colliders[body].body, &points, &triangles).unwrap();
        let mut schema = Schema::from_robot(&robot);
        let plain = data(&Page::new("p").with("one", Recording::new(schema.clone())).html());
        schema.meshes = [on(2).with_color([255, 0, 0]), on(0).instead_of(0)].into();
        let page = Page::new("m").with("one", Recording::new(schema.clone())).with("two", Recording::new(schema));
        let page = data(&page.html());
        let shapes = |page: &Value| page["episodes"][0]["shapes"].as_array().unwrap().clone();
        let (before, after) = (shapes(&plain), shapes(&page));
        let gone = robot.colliders.iter().filter(|collider| collider.body == robot.colliders[2].body).count() + 1;
        assert_eq!(after.len(), before.len() - gone + 2);
        let [first, second] = after.iter().filter(|shape| shape["kind"] == "mesh").collect::<Vec<_>>()[..] else {
            panic!("{after:?}")
        };
        assert_eq!(
            (&first["mesh"], &first["half"], &first["position"]),
            (&json!(0), &json!([0.5, 1, 1.5]), &json!([0.5, 1, 2.5]))
        );
        assert_eq!((&first["color"], &second["mesh"]), (&json!("#ff0000"), &json!(1)));
        let meshes = &page["episodes"][0]["meshes"];
        let bytes = |key: &str| STANDARD.decode(meshes[0][key].as_str().unwrap()).unwrap();
        let corners: Vec<usize> = (0..12).map(|i| word(&bytes("triangles"), 2 * i).into()).collect();
        assert_eq!((bytes("points").len(), corners), (24, triangles.concat()));
        assert_eq!((&page["episodes"][1]["meshes"], plain["episodes"][0].get("meshes")), (&json!(0), None));
    }

    #[test]
    fn a_page_may_be_empty() {
        let page = data(&Page::new("none").html());
        assert_eq!(page["episodes"], json!([]));
        let page = data(&Page::new("empty").with("nothing", Recording::default()).html());
        assert_eq!(page["episodes"][0]["ticks"], 0);
    }

    #[test]
    fn the_viewer_is_small() {
        let [viewer, live] = [SCRIPTS.concat(), LIVE_SCRIPT.to_owned()].map(|script| lean(&script).len());
        assert!(viewer + live <= 110 * 1024, "{viewer} + {live} bytes of JavaScript");
        let size = TEMPLATE.len() + lean(STYLE).len() + viewer;
        assert!(size <= 96 * 1024, "{size} bytes of a page without data");
    }
}
