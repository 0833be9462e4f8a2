//! Data of an episode in a page, in the format of docs/replay-format.md.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Collider, Visual};
use farsa_num::crc32;
use serde_json::{Value, json};

use crate::page::blocks::{Blocks, COUNTS, Space};
use crate::picture::moment::{Look, looks};
use crate::picture::svg_data::hex;
use crate::recording::memory::Recording;
use crate::recording::schema::Channel;
use crate::shape::appearance::as_screens_take_it;
use crate::shape::geometry::Geometry;
use crate::shape::scene_mesh::SceneMesh;
use crate::shape::scene_object::ShownWhile;

/// A recorded episode with its name and facts about its outcome.
#[derive(Clone, Debug)]
pub(super) struct EpisodeData {
    pub(super) name: String,
    pub(super) facts: Vec<(String, String)>,
    pub(super) recording: Recording,
}

impl EpisodeData {
    /// Returns the episode as JSON.
    pub(super) fn json(&self) -> Value {
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
                // A body that was not recorded keeps its last pose.
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
        let images = self.images(&mut blocks);
        let grounds = self.grounds(&mut blocks);
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
            "images": images,
            "position_origin": space.origin,
            "position_unit": space.unit,
            "force_unit": force_unit,
            "blocks": starts,
            "bytes": bytes.len(),
            "crc32": crc32(&bytes),
        });
        if !grounds.is_empty() {
            data["ground_images"] = grounds.into();
        }
        if !schema.meshes.is_empty() {
            data["meshes"] = schema.meshes.iter().map(SceneMesh::data).collect();
        }
        if let Some(network) = self.network() {
            data["network"] = network;
        }
        // The last key, so that people see all names before the long line of numbers.
        data["data"] = STANDARD.encode(&bytes).into();
        data
    }

    fn names(&self, bodies: &[BodyId]) -> Vec<&str> {
        bodies.iter().map(|body| self.recording.schema().body_name(*body)).collect()
    }

    fn shapes(&self, bodies: &[BodyId]) -> Vec<Value> {
        let schema = self.recording.schema();
        let columns = schema.columns();
        let placed = |mut shape: Value, name: &str, body: Option<BodyId>, placement: &Pose<f64>, role: &str| {
            let body = body.and_then(|body| bodies.iter().position(|other| *other == body));
            shape["name"] = name.into();
            shape["body"] = body.map_or_else(|| (-1).into(), Value::from);
            shape["role"] = role.into();
            shape["position"] = json!(placement.position.map(short));
            shape["rotation"] = json!(placement.rotation.map(short));
            shape
        };
        let shape = |name: &str, body: Option<BodyId>, geometry: Geometry, placement: &Pose<f64>, role: &str| {
            placed(geometry_data(geometry), name, body, placement, role)
        };
        let looks: Vec<Look> = schema.robot.as_ref().map(looks).unwrap_or_default();
        let look =
            |body: Option<BodyId>| body.and_then(|body| looks.get(body.index()).copied()).unwrap_or(Look::GROUND);
        let drawn = |name: &str, &Visual { body, shape: form, placement, color }: &Visual| {
            let look = look(body);
            let mut value = shape(name, body, form.into(), &placement, look.role.name());
            if let Some(color) = color.map(as_screens_take_it).or(look.color) {
                value["color"] = hex(color).into();
            }
            value
        };
        let colliders = schema.robot.iter().flat_map(|robot| {
            let index = |collider| robot.colliders.iter().position(|other| std::ptr::eq(other, collider));
            let replaced = move |collider: &Collider| {
                let index = index(collider).unwrap_or_default();
                schema.meshes.iter().any(|mesh| mesh.replaces(index, collider.body))
            };
            robot.drawn_colliders().filter(move |collider| !replaced(collider))
        });
        let colliders = colliders.map(|collider| drawn(&collider.name, &collider.into()));
        let visuals = schema.robot.iter().flat_map(|robot| &robot.visuals);
        let visuals = visuals.map(|visual| drawn(visual.body.map_or("", |body| schema.body_name(body)), visual));
        let objects = schema.objects.iter().filter_map(|object| {
            let mut value = shape(&object.name, object.body, object.geometry, &object.placement, object.role.name());
            if let Some(color) = object.color {
                value["color"] = hex(color).into();
            }
            if let Some(ShownWhile { channel, low, high }) = &object.shown {
                // A shape that depends on an unknown channel is never shown.
                let channel = columns.iter().position(|column| column == channel)?;
                value["shown"] = json!([channel, low.max(f64::MIN), high.min(f64::MAX)]);
            }
            Some(value)
        });
        let meshes = schema.meshes.iter().enumerate().map(|(number, mesh)| {
            let look = look(mesh.body);
            let name = mesh.body.map_or("", |body| schema.body_name(body));
            let solid = json!({"kind": "mesh", "mesh": number, "half": mesh.half().map(short)});
            let mut value = placed(solid, name, mesh.body, &Pose::at(mesh.centre), look.role.name());
            if let Some(color) = mesh.color.or(look.color) {
                value["color"] = hex(color).into();
            }
            value
        });
        colliders.chain(visuals).chain(meshes).chain(objects).collect()
    }

    fn pairs(&self) -> Vec<[&str; 2]> {
        let Some(robot) = &self.recording.schema().robot else { return Vec::new() };
        let name = |collider: usize| robot.colliders.get(collider).map_or("", |collider| collider.name.as_str());
        robot.pairs.iter().map(|pair| pair.colliders.map(name)).collect()
    }

    /// Writes the values of all channels and returns their descriptions.
    fn channels(&self, blocks: &mut Blocks) -> Vec<Value> {
        let recording = &self.recording;
        let ticks = recording.times().len();
        let rows: Vec<Vec<f64>> = (0..ticks).map(|tick| recording.row(tick).collect()).collect();
        blocks.begin("channels");
        let mut descriptions = Vec::new();
        for (index, (_, channel)) in recording.schema().channels().enumerate() {
            let values = || rows.iter().map(|row| row[index]);
            let finite = || values().filter(|x| x.is_finite());
            let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
            let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
            // Integers stay exact: phases, numbers of contacts.
            let integer = finite().all(|x| x.fract() == 0.0) && high - low <= COUNTS;
            let scale = if integer { 1.0 } else { (high - low) / COUNTS };
            for x in values() {
                blocks.word(if x.is_nan() { u16::MAX } else { ((x - low) / scale).round().min(COUNTS) as u16 });
            }
            descriptions.push(described(channel, low, scale));
        }
        descriptions
    }

    /// Writes the images of cameras and returns their descriptions.
    fn images(&self, blocks: &mut Blocks) -> Vec<Value> {
        let images = self.recording.images();
        let mut descriptions = Vec::new();
        blocks.begin("image_starts");
        for (number, image) in self.recording.schema().images.iter().enumerate() {
            if image.ground.is_none() {
                images.starts(number).for_each(|start| blocks.long(start));
                descriptions.push(json!({"name": image.name, "size": image.size}));
            }
        }
        blocks.begin("pixels");
        images.pixels().iter().for_each(|pixel| blocks.word(*pixel));
        descriptions
    }

    /// Writes the changes of images on the ground and returns their descriptions.
    fn grounds(&self, blocks: &mut Blocks) -> Vec<Value> {
        let recording = &self.recording;
        let mut descriptions = Vec::new();
        for (number, image) in recording.schema().images.iter().enumerate() {
            let Some([from, to]) = image.ground else { continue };
            if descriptions.is_empty() {
                blocks.begin("ground_pixels");
            }
            for tick in 0..recording.times().len() {
                let changes = recording.grounds().changes(tick, number);
                blocks.word(changes.len() as u16);
                changes.iter().flat_map(|change| [change.pixel, change.shade]).for_each(|word| blocks.word(word));
            }
            let place = [from[0], from[1], to[0], to[1]].map(short);
            descriptions.push(json!({"name": image.name, "size": image.size, "ground": place}));
        }
        descriptions
    }

    fn network(&self) -> Option<Value> {
        let schema = self.recording.schema();
        if schema.links.is_empty() || self.recording.controller_parameters().is_empty() {
            return None;
        }
        let layers = [&schema.sensors, &schema.neurons, &schema.outputs];
        let channels = layers.into_iter().enumerate().flat_map(|(layer, nodes)| nodes.iter().map(move |x| (layer, x)));
        let first = schema.scalars.len();
        let nodes: Vec<Value> = channels
            .enumerate()
            .map(|(index, (layer, node))| json!({"name": node.title(), "layer": layer, "channel": first + index}))
            .collect();
        let links: Vec<Value> = (schema.links.iter())
            .map(|links| json!({"from": links.from, "to": links.to, "first": links.first}))
            .collect();
        let values: Vec<Value> = (schema.node_parameters.iter())
            .map(|values| json!({"name": values.name, "nodes": values.nodes, "first": values.first}))
            .collect();
        let mut network = json!({"nodes": nodes, "links": links, "values": values});
        if !schema.direct_links.is_empty() {
            network["direct"] = json!(schema.direct_links);
        }
        Some(network)
    }
}

/// Rounds a length to the micrometer, with as few digits as possible.
fn short(x: f64) -> Value {
    let rounded = (x * 1e6).round() / 1e6;
    if rounded.fract() == 0.0 && rounded.abs() < 1e9 { (rounded as i64).into() } else { rounded.into() }
}

fn geometry_data(geometry: Geometry) -> Value {
    match geometry {
        Geometry::Sphere { radius } => json!({"kind": "sphere", "radius": short(radius)}),
        Geometry::Capsule { radius, half_length } => {
            json!({"kind": "capsule", "radius": short(radius), "half_length": short(half_length)})
        }
        Geometry::Cylinder { radius, half_length } => {
            json!({"kind": "cylinder", "radius": short(radius), "half_length": short(half_length)})
        }
        Geometry::Box { half } => json!({"kind": "box", "half": half.map(short)}),
        Geometry::Plane => json!({"kind": "plane"}),
        Geometry::Disc { radius } => json!({"kind": "cylinder", "radius": short(radius), "half_length": 0}),
        Geometry::Rectangle { half: [x, y] } => json!({"kind": "box", "half": [short(x), short(y), 0]}),
    }
}

fn described(channel: &Channel, minimum: f64, scale: f64) -> Value {
    let mut description = json!({
        "group": channel.group,
        "name": channel.name,
        "unit": channel.unit,
        "minimum": minimum,
        "scale": scale,
    });
    if !channel.label.is_empty() {
        description["label"] = channel.label.as_str().into();
    }
    if !channel.about.is_empty() {
        description["about"] = channel.about.as_str().into();
    }
    if let Some(range) = channel.range {
        description["range"] = json!(range);
    }
    if !channel.words.is_empty() {
        description["words"] = json!(channel.words);
    }
    description
}
