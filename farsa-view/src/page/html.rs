//! A page that shows recorded episodes in a browser: one file, no network.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use farsa_body::{BodyId, Pose, Robot, Visual};
use farsa_num::crc32;
use serde_json::{Value, json};

use crate::page::blocks::{Blocks, COUNTS, Space};
use crate::picture::svg_data::hex;
use crate::recording::memory::Recording;
use crate::recording::schema::Channel;
use crate::recording::view::View;
use crate::shape::appearance::as_screens_take_it;
use crate::shape::geometry::Geometry;

const TEMPLATE: &str = include_str!("viewer/page.html");
const STYLE: &str = include_str!("viewer/viewer.css");
const SCRIPTS: &[&str] = &[
    include_str!("viewer/data.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/scene.js"),
    include_str!("viewer/view.js"),
    include_str!("viewer/strips.js"),
    include_str!("viewer/images.js"),
    include_str!("viewer/network.js"),
    include_str!("viewer/player.js"),
    include_str!("viewer/main.js"),
];

/// A page of recorded episodes, to be looked at in a browser: bodies in space, strips of everything that has a value,
/// and the network, all on one clock.
///
/// It needs nothing but itself. The format of its data is described in `docs/replay-format.md` of the project.
#[derive(Clone, Debug, Default)]
pub struct Page {
    title: String,
    episodes: Vec<Film>,
    beside: Option<usize>,
}

#[derive(Clone, Debug)]
struct Film {
    name: String,
    facts: Vec<(String, String)>,
    recording: Recording,
}

impl Page {
    /// A page without episodes.
    pub fn new(title: &str) -> Self {
        Self { title: title.into(), ..Self::default() }
    }

    /// The same page with another episode.
    pub fn with(mut self, name: &str, recording: Recording) -> Self {
        self.add(name, Vec::new(), recording);
        self
    }

    /// Adds an episode with facts about it, by name, such as its fitness.
    pub fn add(&mut self, name: &str, facts: Vec<(String, String)>, recording: Recording) {
        self.episodes.push(Film { name: name.into(), facts, recording });
    }

    /// Number of episodes.
    pub fn episodes(&self) -> usize {
        self.episodes.len()
    }

    /// Shows the episode of this number, from 0, beside the first one when the page opens.
    pub fn open_beside(&mut self, episode: usize) {
        self.beside = Some(episode);
    }

    /// The whole file.
    pub fn html(&self) -> String {
        let top = self.episodes.first().is_some_and(|film| film.recording.schema().view == View::Top);
        let episodes: Vec<Value> = self.episodes.iter().map(Film::data).collect();
        let mut data = json!({
            "format": "farsa-replay",
            "version": 1,
            "made_by": concat!("farsa ", env!("CARGO_PKG_VERSION")),
            "title": self.title,
            "view": if top { "top" } else { "free" },
            "lives": episodes,
        });
        if let Some(beside) = self.beside {
            data["beside"] = beside.into();
        }
        // No text of a recording can end the element that holds it.
        let data = data.to_string().replace('<', "\\u003c");
        let parts = [
            ("{{title}}", escaped(&self.title)),
            ("{{style}}", STYLE.to_owned()),
            ("{{script}}", SCRIPTS.concat()),
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
}

/// Text as it stands in HTML.
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

impl Film {
    fn data(&self) -> Value {
        let Self { name, facts, recording } = self;
        let schema = recording.schema();
        let ticks = recording.times().len();
        let bodies: Vec<BodyId> = schema.shown().collect();
        let position = |tick: usize, body: BodyId| recording.pose_at(tick, body).map(|pose| pose.position);
        let of_bodies = (0..ticks).flat_map(|tick| bodies.iter().filter_map(move |body| position(tick, *body)));
        let of_points = (0..ticks)
            .flat_map(|tick| (0..schema.points.len()).filter_map(move |point| recording.point_at(tick, point)));
        let touching = || (0..ticks).flat_map(|tick| recording.contacts_at(tick));
        let rays = (0..ticks).flat_map(|tick| recording.rays_at(tick)).flat_map(|ray| [ray.from, ray.to]);
        let space = Space::from_positions(
            of_bodies.chain(of_points).chain(touching().map(|contact| contact.point)).chain(rays),
        );
        let largest = touching().flat_map(|contact| contact.force).map(f32::abs).fold(1e-3, f32::max);
        let force_unit = f64::from(largest) / 32767.0;

        let mut blocks = Blocks::default();
        blocks.begin("times");
        recording.times().iter().for_each(|time| blocks.float(*time as f32));
        blocks.begin("poses");
        let mut last = vec![farsa_body::Pose::identity(); bodies.len()];
        for tick in 0..ticks {
            for (body, last) in bodies.iter().zip(&mut last) {
                // A body that was not recorded stays where it was.
                if let Some(pose) = recording.pose_at(tick, *body)
                    && pose.position.iter().chain(&pose.rotation).all(|x| x.is_finite())
                {
                    *last = pose;
                }
                space.write(last.position, &mut blocks);
                last.rotation.iter().for_each(|x| blocks.word(((x * 32767.0).round() as i16).cast_unsigned()));
            }
        }
        let channels = self.channels(&mut blocks);
        blocks.begin("points");
        for tick in 0..ticks {
            (0..schema.points.len())
                .filter_map(|point| recording.point_at(tick, point))
                .for_each(|position| space.write(position, &mut blocks));
        }
        blocks.begin("contacts");
        for contacts in (0..ticks).map(|tick| recording.contacts_at(tick)) {
            blocks.word(contacts.len() as u16);
            for contact in contacts {
                blocks.word(contact.pair.0);
                space.write(contact.point, &mut blocks);
                contact
                    .force
                    .iter()
                    .for_each(|f| blocks.word(((f64::from(*f) / force_unit).round() as i16).cast_unsigned()));
            }
        }
        blocks.begin("rays");
        for rays in (0..ticks).map(|tick| recording.rays_at(tick)) {
            blocks.word(rays.len() as u16);
            for ray in rays {
                space.write(ray.from, &mut blocks);
                space.write(ray.to, &mut blocks);
                blocks.word(u16::from(ray.met));
            }
        }
        let images = recording.images();
        blocks.begin("image_starts");
        (0..schema.images.len()).for_each(|image| images.starts(image).for_each(|start| blocks.long(start)));
        blocks.begin("pixels");
        images.pixels().iter().for_each(|pixel| blocks.word(*pixel));
        blocks.begin("weights");
        recording.controller_parameters().iter().for_each(|weight| blocks.float(*weight));

        let Blocks { bytes, starts } = blocks;
        let mut data = json!({
            "name": name,
            "facts": facts,
            "ticks": ticks,
            "bodies": self.names(&bodies),
            "shapes": self.shapes(&bodies),
            "channels": channels,
            "pairs": self.pairs(),
            "points": schema.points,
            "images": self.images(),
            "position_origin": space.origin,
            "position_unit": space.unit,
            "force_unit": force_unit,
            "blocks": starts,
            "bytes": bytes.len(),
            "crc32": crc32(&bytes),
        });
        if let Some(network) = self.network() {
            data["network"] = network;
        }
        // Last, so that a reader sees all names before the long line of numbers.
        data["data"] = STANDARD.encode(&bytes).into();
        data
    }

    fn names(&self, bodies: &[BodyId]) -> Vec<&str> {
        bodies.iter().map(|body| self.recording.schema().body_name(*body)).collect()
    }

    fn shapes(&self, bodies: &[BodyId]) -> Vec<Value> {
        let schema = self.recording.schema();
        let shape = |name: &str, body: Option<BodyId>, geometry: Geometry, placement: &Pose<f64>, role: &str| {
            let mut shape = match geometry {
                Geometry::Sphere { radius } => json!({"kind": "sphere", "radius": radius}),
                Geometry::Capsule { radius, half_length } => {
                    json!({"kind": "capsule", "radius": radius, "half_length": half_length})
                }
                Geometry::Cylinder { radius, half_length } => {
                    json!({"kind": "cylinder", "radius": radius, "half_length": half_length})
                }
                Geometry::Box { half } => json!({"kind": "box", "half": half}),
                Geometry::Plane => json!({"kind": "plane"}),
                Geometry::Disc { radius } => json!({"kind": "cylinder", "radius": radius, "half_length": 0.0}),
                Geometry::Rectangle { half: [x, y] } => json!({"kind": "box", "half": [x, y, 0.0]}),
            };
            let body = body.and_then(|body| bodies.iter().position(|other| *other == body));
            shape["name"] = name.into();
            shape["body"] = body.map_or_else(|| (-1).into(), Value::from);
            shape["role"] = role.into();
            shape["position"] = json!(placement.position);
            shape["rotation"] = json!(placement.rotation);
            shape
        };
        let drawn = |name: &str, &Visual { body, shape: form, placement, color }: &Visual| {
            let role = match body {
                None => "ground",
                Some(body) if schema.is_thing(body) => "thing",
                Some(_) => "robot",
            };
            let mut value = shape(name, body, form.into(), &placement, role);
            if let Some(color) = color {
                value["color"] = hex(as_screens_take_it(color)).into();
            }
            value
        };
        let colliders = schema.robot.iter().flat_map(Robot::drawn_colliders);
        let colliders = colliders.map(|collider| drawn(&collider.name, &collider.into()));
        let visuals = schema.robot.iter().flat_map(|robot| &robot.visuals);
        let visuals = visuals.map(|visual| drawn(visual.body.map_or("", |body| schema.body_name(body)), visual));
        let objects = schema.objects.iter().map(|object| {
            let mut value = shape(&object.name, object.body, object.geometry, &object.placement, object.role.name());
            if let Some(color) = object.color {
                value["color"] = hex(color).into();
            }
            value
        });
        colliders.chain(visuals).chain(objects).collect()
    }

    fn pairs(&self) -> Vec<[&str; 2]> {
        let Some(robot) = &self.recording.schema().robot else { return Vec::new() };
        let name = |collider: usize| robot.colliders.get(collider).map_or("", |collider| collider.name.as_str());
        robot.pairs.iter().map(|pair| pair.colliders.map(name)).collect()
    }

    /// Writes the values of all channels and says how to read them.
    fn channels(&self, blocks: &mut Blocks) -> Vec<Value> {
        let recording = &self.recording;
        let ticks = recording.times().len();
        let rows: Vec<Vec<f64>> = (0..ticks).map(|tick| recording.row(tick).collect()).collect();
        blocks.begin("channels");
        let mut told = Vec::new();
        for (index, (_, channel)) in recording.schema().channels().enumerate() {
            let values = || rows.iter().map(|row| row[index]);
            let finite = || values().filter(|x| x.is_finite());
            let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
            let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
            // Whole numbers stay exact: phases, counts of contacts.
            let whole = finite().all(|x| x.fract() == 0.0) && high - low <= COUNTS;
            let scale = if whole { 1.0 } else { (high - low) / COUNTS };
            for x in values() {
                blocks.word(if x.is_nan() { u16::MAX } else { ((x - low) / scale).round().min(COUNTS) as u16 });
            }
            told.push(described(channel, low, scale));
        }
        told
    }

    fn images(&self) -> Vec<Value> {
        let images = self.recording.schema().images.iter();
        images.map(|image| json!({"name": image.name, "size": image.size})).collect()
    }

    fn network(&self) -> Option<Value> {
        let schema = self.recording.schema();
        if schema.links.is_empty() || self.recording.controller_parameters().is_empty() {
            return None;
        }
        let layers = [&schema.sensors, &schema.neurons, &schema.outputs];
        let channels = layers.into_iter().enumerate().flat_map(|(layer, of)| of.iter().map(move |x| (layer, x)));
        let first = schema.scalars.len();
        let nodes: Vec<Value> = channels
            .enumerate()
            .map(|(index, (layer, node))| json!({"name": node.title(), "layer": layer, "channel": first + index}))
            .collect();
        let links: Vec<Value> = (schema.links.iter())
            .map(|links| json!({"from": links.from, "to": links.to, "first": links.first}))
            .collect();
        let values: Vec<Value> = (schema.node_parameters.iter())
            .map(|of| json!({"name": of.name, "nodes": of.nodes, "first": of.first}))
            .collect();
        Some(json!({"nodes": nodes, "links": links, "values": values}))
    }
}

fn described(channel: &Channel, minimum: f64, scale: f64) -> Value {
    let mut told = json!({
        "group": channel.group,
        "name": channel.name,
        "unit": channel.unit,
        "minimum": minimum,
        "scale": scale,
    });
    if let Some(range) = channel.range {
        told["range"] = json!(range);
    }
    if !channel.words.is_empty() {
        told["words"] = json!(channel.words);
    }
    told
}

/// A number with as many digits as a reader wants.
pub fn readable(x: f64) -> String {
    let mut text = String::new();
    let decimals = if x.abs() >= 1000.0 {
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
    use crate::recording::schema::Schema;
    use farsa_body::{PairContact, PairId, Pose, Recorder, Tabletop};

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
    fn what_is_read_back_is_what_was_told_within_the_stated_error() {
        let robot = Tabletop::default().scene(&farsa_body::ArmAndHand::default()).unwrap();
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
        let episode = &page["lives"][0];
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
            let of = |key: &str| channels[channel as usize][key].as_f64().unwrap();
            (count != u16::MAX).then(|| (of("minimum") + of("scale") * f64::from(count), of("scale")))
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
    fn images_are_read_back_in_their_colours() {
        let schema = Schema::from_scalars(["x"]).with_image("left eye", [3, 2]).with_image("right eye", [1, 1]);
        let mut recording = Recording::new(schema);
        // Those that are counts of 5, 6 and 5 bits come back exactly.
        let color = |tick: usize, pixel: usize| [tick as f32 / 31.0, 1.0 - pixel as f32 / 63.0, 1.0];
        for tick in 0..4_usize {
            (0..6).for_each(|pixel| recording.pixel(0, pixel, color(tick / 2, pixel)));
            if tick == 3 {
                recording.pixel(1, 0, [1.0, 0.0, 0.0]);
            }
            recording.tick(0.1 * tick as f64);
        }
        for tick in 0..4_usize {
            let kept: Vec<[f32; 3]> = recording.image_at(tick, 0).unwrap().collect();
            let expected: Vec<[f32; 3]> = (0..6).map(|pixel| color(tick / 2, pixel)).collect();
            assert_eq!(kept, expected);
        }
        assert!(recording.image_at(2, 1).is_none() && recording.image_at(3, 2).is_none());

        let page = data(&Page::new("eyes").with("one", recording).html());
        let episode = &page["lives"][0];
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
    fn a_page_of_nothing_is_a_page() {
        let page = data(&Page::new("none").html());
        assert_eq!(page["lives"], json!([]));
        let page = data(&Page::new("empty").with("nothing", Recording::default()).html());
        assert_eq!(page["lives"][0]["ticks"], 0);
    }

    #[test]
    fn the_viewer_is_small() {
        let size = TEMPLATE.len() + STYLE.len() + SCRIPTS.iter().map(|script| script.len()).sum::<usize>();
        assert!(size <= 69 * 1024, "{size} bytes");
    }
}
