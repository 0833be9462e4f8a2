//! Schema of a recording: bodies, channels and a network.

use std::sync::Arc;

use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, Robot};
use farsa_nn::{LeakyLayout, LeakyParameter};

use crate::recording::view::View;
use crate::shape::scene_mesh::SceneMesh;
use crate::shape::scene_object::SceneObject;

/// A quantity with one value per tick, as in tables and pages.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Channel {
    /// Name.
    pub name: String,
    /// Label for pages. If this is empty, pages show the name instead.
    pub label: String,
    /// Explanation for pages, shown at the pointer. This may be empty.
    pub about: String,
    /// Unit of the values. This is empty for numbers without a unit.
    pub unit: String,
    /// Group of the channel, such as `phase`, `fitness`, `sensor`, `neuron`, `output`, `joint`, `actuator` or `force`. You
    /// can also use a custom word.
    pub group: String,
    /// Range of the values, if it is fixed by definition.
    pub range: Option<[f64; 2]>,
    /// Words for the values 0, 1, 2 and so on. This is empty for ordinary numbers.
    pub words: Vec<String>,
}

impl Channel {
    /// Creates a channel from its name.
    ///
    /// If there is a unit, add it in brackets, for example `"x [m]"`.
    pub fn new(name: &str) -> Self {
        let (name, unit) = match name.strip_suffix(']').and_then(|name| name.rsplit_once(" [")) {
            Some((name, unit)) => (name, unit),
            None => (name, ""),
        };
        Self { name: name.into(), unit: unit.into(), ..Self::default() }
    }

    /// Sets the label, which pages show instead of the name.
    pub fn labelled(self, label: &str) -> Self {
        Self { label: label.into(), ..self }
    }

    /// Sets the explanation, which pages show at the pointer.
    pub fn about(self, about: &str) -> Self {
        Self { about: about.into(), ..self }
    }

    /// Sets the group of the channel.
    pub fn group(self, group: &str) -> Self {
        Self { group: group.into(), ..self }
    }

    /// Sets the range of the values.
    pub fn range(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }

    /// Sets words for the values 0, 1, 2 and so on.
    pub fn words(self, words: &[&str]) -> Self {
        Self { words: words.iter().map(|&word| word.into()).collect(), ..self }
    }

    /// Formats the name and the unit, in the same way as [`Channel::new`] expects them.
    pub fn title(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// An image of a camera or on the ground, as in pages.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ImageChannel {
    /// Name.
    pub name: String,
    /// Number of columns and rows.
    pub size: [usize; 2],
    /// Outer corners of the first and the last pixel on the ground [m], if it is an image there.
    pub ground: Option<[[f64; 2]; 2]>,
}

impl ImageChannel {
    /// Creates an image with the given columns and rows.
    pub fn new(name: &str, size: [usize; 2]) -> Self {
        Self { name: name.into(), size, ground: None }
    }

    /// Places the image on the ground, from the corner of its first pixel to that of its last one [m], with columns along x.
    ///
    /// Each pixel that is not black becomes a mark on the ground. This only stores changes, so a tick without pixels leaves
    /// the image as it is. Note that images with more than 65535 pixels are not stored at all.
    pub fn on_ground(self, from: [f64; 2], to: [f64; 2]) -> Self {
        Self { ground: Some([from, to]), ..self }
    }

    /// Gets the number of pixels.
    pub(crate) fn pixels(&self) -> usize {
        self.size[0].saturating_mul(self.size[1])
    }
}

/// Weights from every node of one range to every node of another, source-major.
///
/// Nodes are numbered in the order sensors, neurons, outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Links {
    /// First source and the one after the last.
    pub from: [usize; 2],
    /// First target and the one after the last.
    pub to: [usize; 2],
    /// Index of the first weight in the parameters.
    pub first: usize,
}

/// One parameter for each node of a range, such as a bias.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeParameters {
    /// Name of the parameter.
    pub name: String,
    /// First node and the one after the last.
    pub nodes: [usize; 2],
    /// Index of the first value in the parameters.
    pub first: usize,
}

/// Names and order of all values that a recorder receives in an episode.
///
/// ```
/// use farsa_body::robots::ArmAndHand;
/// use farsa_view::Schema;
///
/// let robot = ArmAndHand::default().robot()?;
/// let schema = Schema::from_robot(&robot).with_sensors(["J1", "J2"]).with_scalars(["time to go [s]"]);
/// assert_eq!(schema.columns(), ["time to go [s]", "sensor.J1", "sensor.J2"]);
/// # Ok::<(), farsa_body::robot::RobotError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Schema {
    /// Robot or scene with the bodies and their shapes.
    pub robot: Option<Robot>,
    /// Names of the bodies by index. This is only used if there is no robot.
    pub bodies: Vec<String>,
    /// Further visible objects.
    pub objects: Vec<SceneObject>,
    /// Meshes that pages draw instead of colliders.
    pub meshes: Arc<[SceneMesh]>,
    /// Sensors of the controller.
    pub sensors: Vec<Channel>,
    /// Neurons between sensors and motors.
    pub neurons: Vec<Channel>,
    /// Outputs of the controller.
    pub outputs: Vec<Channel>,
    /// Further named values.
    pub scalars: Vec<Channel>,
    /// Further points, by index.
    pub points: Vec<String>,
    /// Images of cameras and images on the ground, by index.
    pub images: Vec<ImageChannel>,
    /// Links between nodes. These are needed to draw the network.
    pub links: Vec<Links>,
    /// Links without a weight in the parameters, as pairs of a source and a target, such as a direct input.
    pub direct_links: Vec<[usize; 2]>,
    /// Further parameters of nodes.
    pub node_parameters: Vec<NodeParameters>,
    /// Initial camera of a page.
    pub view: View,
}

fn channels<N: AsRef<str>>(names: impl IntoIterator<Item = N>, group: &str) -> Vec<Channel> {
    names.into_iter().map(|name| Channel::new(name.as_ref()).group(group)).collect()
}

impl Schema {
    /// Creates a schema with the bodies of a robot or scene, and without channels.
    pub fn from_robot(robot: &Robot) -> Self {
        Self { robot: Some(robot.clone()), ..Self::default() }
    }

    /// Creates a schema with named values. Units are given in brackets, as in `["x [m]"]`.
    pub fn from_scalars<N: AsRef<str>>(names: impl IntoIterator<Item = N>) -> Self {
        Self::default().with_scalars(names)
    }

    /// Sets the names of the sensors.
    pub fn with_sensors<N: AsRef<str>>(self, names: impl IntoIterator<Item = N>) -> Self {
        Self { sensors: channels(names, "sensor"), ..self }
    }

    /// Sets the names of the outputs.
    pub fn with_outputs<N: AsRef<str>>(self, names: impl IntoIterator<Item = N>) -> Self {
        Self { outputs: channels(names, "output"), ..self }
    }

    /// Sets the names of further values. This replaces earlier ones.
    pub fn with_scalars<N: AsRef<str>>(self, names: impl IntoIterator<Item = N>) -> Self {
        Self { scalars: channels(names, "value"), ..self }
    }

    /// Sets labels for existing channels, given as pairs of a name and a label.
    ///
    /// A pair matches a channel of that name, and one whose name starts with it and a space: `("J4", "elbow")` labels
    /// `J4 torque` as `elbow torque`. The first matching pair is used.
    ///
    /// ```
    /// use farsa_view::Schema;
    ///
    /// let schema = Schema::from_scalars(["J4 [rad]", "J4 agonist length", "J4 torque [N m]", "J40"]);
    /// let schema = schema.with_labels(&[("J4 agonist", "elbow flexor"), ("J4", "elbow extension")]);
    /// let labels: Vec<&str> = schema.scalars.iter().map(|channel| channel.label.as_str()).collect();
    /// assert_eq!(labels, ["elbow extension", "elbow flexor length", "elbow extension torque", ""]);
    /// ```
    pub fn with_labels<N: AsRef<str>, L: AsRef<str>>(mut self, labels: &[(N, L)]) -> Self {
        let label_of = |channel: &str| {
            labels.iter().find_map(|(name, label)| {
                let rest = channel.strip_prefix(name.as_ref())?;
                (rest.is_empty() || rest.starts_with(' ')).then(|| format!("{}{rest}", label.as_ref()))
            })
        };
        let Self { sensors, neurons, outputs, scalars, .. } = &mut self;
        for channel in [sensors, neurons, outputs, scalars].into_iter().flatten() {
            if let Some(label) = label_of(&channel.name) {
                channel.label = label;
            }
        }
        self
    }

    /// Appends an image with the given columns and rows.
    pub fn with_image(mut self, name: &str, size: [usize; 2]) -> Self {
        self.images.push(ImageChannel::new(name, size));
        self
    }

    /// Sets the neurons and links of a network, whose inputs and outputs are the sensors and outputs of the schema.
    ///
    /// To show its weights, you also need to record the parameters using
    /// [`Recorder::parameters`](farsa_body::Recorder::parameters).
    pub fn with_network(self, layout: &LeakyLayout) -> Self {
        let (n, h) = (layout.sensors(), layout.hidden());
        let (neurons, outputs) = ([n, n + h], [n + h, n + h + layout.outputs()]);
        let first = |kind| layout.range(kind).start;
        let links = vec![
            Links { from: [0, n], to: neurons, first: first(LeakyParameter::SensorWeight) },
            Links { from: neurons, to: neurons, first: first(LeakyParameter::RecurrentWeight) },
            Links { from: neurons, to: outputs, first: first(LeakyParameter::OutputWeight) },
        ];
        let of_neurons = |name: &str, kind| NodeParameters { name: name.into(), nodes: neurons, first: first(kind) };
        let node_parameters = vec![of_neurons("bias", LeakyParameter::Bias), of_neurons("leak", LeakyParameter::Leak)];
        let names: Vec<String> = (1..=h).map(|number| number.to_string()).collect();
        let neurons = channels(names, "neuron").into_iter().map(|channel| channel.range(0.0, 1.0)).collect();
        Self { neurons, links, node_parameters, ..self }
    }

    /// Iterates over the visible bodies.
    pub fn shown(&self) -> impl Iterator<Item = BodyId> + '_ {
        let of_robot = self.robot.iter().flat_map(Robot::shaped_bodies);
        let of_meshes = self.meshes.iter().filter_map(|mesh| mesh.body);
        let of_objects = self.objects.iter().filter_map(|object| object.body);
        let mut of_objects: Vec<BodyId> = of_objects.chain(of_meshes).collect();
        of_objects.sort_unstable();
        of_objects.dedup();
        let visible =
            |body: &BodyId| self.robot.as_ref().is_some_and(|robot| robot.shaped_bodies().any(|b| b == *body));
        of_objects.retain(|body| !visible(body));
        of_robot.chain(of_objects)
    }

    /// Gets the number of bodies, visible or not.
    pub(crate) fn body_count(&self) -> usize {
        self.robot.as_ref().map_or(self.bodies.len(), |robot| robot.segments.len())
    }

    /// Gets the name of a body. If there is no such body, the name is empty.
    pub(crate) fn body_name(&self, body: BodyId) -> &str {
        match &self.robot {
            Some(robot) => robot.segments.get(body.index()).map_or("", |segment| segment.name.as_str()),
            None => self.bodies.get(body.index()).map_or("", String::as_str),
        }
    }

    /// Returns all channels in the order of tables, with the prefix of sensors, neurons and outputs.
    pub(crate) fn channels(&self) -> impl Iterator<Item = (&'static str, &Channel)> {
        let scalars = self.scalars.iter().map(|channel| ("", channel));
        let sensors = self.sensors.iter().map(|channel| ("sensor.", channel));
        let neurons = self.neurons.iter().map(|channel| ("neuron.", channel));
        let outputs = self.outputs.iter().map(|channel| ("output.", channel));
        scalars.chain(sensors).chain(neurons).chain(outputs)
    }

    /// Lists the columns of a table with all channels.
    ///
    /// This does not include bodies, contacts, rays, points and images.
    pub fn columns(&self) -> Vec<String> {
        self.channels().map(|(prefix, channel)| format!("{prefix}{}", channel.title())).collect()
    }

    /// Returns true for a body that moves freely: it floats or slides in a plane, and no joint is attached.
    pub(crate) fn is_thing(&self, body: BodyId) -> bool {
        let Some(robot) = &self.robot else { return false };
        let floats = |segment: &farsa_body::robot::Segment| segment.joint.kind == JointKind::Floating;
        (robot.segments.get(body.index()).is_some_and(floats) || robot.sliders(body).is_some())
            && robot.segments.iter().all(|segment| segment.parent != Some(body))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_names_with_units() {
        for (title, name, unit) in [("x [m]", "x", "m"), ("x", "x", ""), ("a [b] c", "a [b] c", ""), ("q []", "q", "")]
        {
            let channel = Channel::new(title);
            assert_eq!((channel.name.as_str(), channel.unit.as_str()), (name, unit));
        }
        assert_eq!(Channel::new("force on sphere.palm [N]").title(), "force on sphere.palm [N]");
    }

    #[test]
    fn labels_change_what_is_shown_and_no_name() {
        let layout = LeakyLayout::new(2, 1, 3);
        let plain = Schema::from_scalars(["J1 [rad]", "J12 [rad]", "J1 torque [N m]", "time"])
            .with_sensors(["J1", "touch J1"])
            .with_outputs(["J1 J2", "J1 J2 J3", "J1-J3"])
            .with_network(&layout);
        let schema = plain.clone().with_labels(&[("J1 J2", "both"), ("J1", "elbow"), ("J1", "never"), ("1", "first")]);
        let labels: Vec<&str> = schema.channels().map(|(_, channel)| channel.label.as_str()).collect();
        assert_eq!(labels, ["elbow", "", "elbow torque", "", "elbow", "", "first", "both", "both J3", ""]);
        assert_eq!(schema.columns(), plain.columns());
        // Other channels are unchanged.
        let labelled = Channel::new("x [m]").labelled("place");
        let schema = Schema { scalars: vec![labelled], ..Schema::default() }.with_labels(&[("y", "height")]);
        assert_eq!((schema.scalars[0].label.as_str(), schema.columns()), ("place", vec![String::from("x [m]")]));
    }

    #[test]
    fn links_of_a_network_meet_every_parameter_once() {
        let layout = LeakyLayout::new(5, 3, 2);
        let schema = Schema::default().with_network(&layout);
        let mut seen = vec![0; layout.parameter_count()];
        for Links { from, to, first } in &schema.links {
            (0..(from[1] - from[0]) * (to[1] - to[0])).for_each(|weight| seen[first + weight] += 1);
        }
        for NodeParameters { nodes, first, .. } in &schema.node_parameters {
            (0..nodes[1] - nodes[0]).for_each(|node| seen[first + node] += 1);
        }
        assert_eq!(seen, vec![1; layout.parameter_count()]);
        assert_eq!(schema.columns(), ["neuron.1", "neuron.2", "neuron.3"]);
    }
}
