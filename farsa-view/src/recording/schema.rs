//! What a recording shows: the bodies, and the names of everything that has a value.

use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, Robot};
use farsa_nn::{LeakyLayout, LeakyParameter};

use crate::recording::view::View;
use crate::shape::scene_object::SceneObject;

/// Something that has one value per tick, as tables and pages name it.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Channel {
    /// What it is called.
    pub name: String,
    /// What pages show in place of the name; empty for the name itself.
    pub label: String,
    /// Its unit; empty if it has none.
    pub unit: String,
    /// What stands together: `phase`, `fitness`, `sensor`, `neuron`, `output`, `joint`, `actuator`, `force` or a word of
    /// one's own.
    pub group: String,
    /// Where its values lie by definition, if that is known.
    pub range: Option<[f64; 2]>,
    /// What the values 0, 1, 2 ... mean, if they are words.
    pub words: Vec<String>,
}

impl Channel {
    /// A channel by its name, the unit in brackets behind: `"x [m]"`.
    pub fn new(name: &str) -> Self {
        let (name, unit) = match name.strip_suffix(']').and_then(|name| name.rsplit_once(" [")) {
            Some((name, unit)) => (name, unit),
            None => (name, ""),
        };
        Self { name: name.into(), unit: unit.into(), ..Self::default() }
    }

    /// The same channel with a label, which pages show in place of its name.
    pub fn labelled(self, label: &str) -> Self {
        Self { label: label.into(), ..self }
    }

    /// The same channel in a group.
    pub fn group(self, group: &str) -> Self {
        Self { group: group.into(), ..self }
    }

    /// The same channel with the range of its values.
    pub fn range(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }

    /// The same channel with words for the values 0, 1, 2 ...
    pub fn words(self, words: &[&str]) -> Self {
        Self { words: words.iter().map(|&word| word.into()).collect(), ..self }
    }

    /// Name and unit as they were given to [`Channel::new`].
    pub fn title(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// An image, as pages name it: what a camera sees, or what lies on the ground.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ImageChannel {
    /// What it is called.
    pub name: String,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Where it lies on the ground, if it does: the corner of its first pixel and that of its last one [m].
    pub ground: Option<[[f64; 2]; 2]>,
}

impl ImageChannel {
    /// An image of so many columns and rows.
    pub fn new(name: &str, size: [usize; 2]) -> Self {
        Self { name: name.into(), size, ground: None }
    }

    /// The same image on the ground, from the corner of its first pixel to that of its last one [m]: columns run along x.
    ///
    /// Each pixel that is not black is a mark on the ground in its colour. What changes is kept, so that an image which
    /// changes little takes little room; a tick without pixels leaves it as it was. Images of more than 65535 pixels are not kept.
    pub fn on_ground(self, from: [f64; 2], to: [f64; 2]) -> Self {
        Self { ground: Some([from, to]), ..self }
    }

    /// Number of pixels.
    pub(crate) fn pixels(&self) -> usize {
        self.size[0].saturating_mul(self.size[1])
    }
}

/// Weights from every node of one range to every node of another, source-major.
///
/// Nodes are numbered through: sensors, then neurons, then outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Links {
    /// First source and the one after the last.
    pub from: [usize; 2],
    /// First target and the one after the last.
    pub to: [usize; 2],
    /// Index of the first weight in the parameters.
    pub first: usize,
}

/// One parameter for each node of a range, such as the biases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeParameters {
    /// What they are called.
    pub name: String,
    /// First node and the one after the last.
    pub nodes: [usize; 2],
    /// Index of the first in the parameters.
    pub first: usize,
}

/// What a recording holds: everything that a recorder is given in an episode, by name and in order.
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
    /// The bodies with their shapes; `None` if there is nothing to see.
    pub robot: Option<Robot>,
    /// The names of the bodies where no robot names them, by number.
    pub bodies: Vec<String>,
    /// What is to be seen beside the robot's shapes.
    pub objects: Vec<SceneObject>,
    /// What is sensed.
    pub sensors: Vec<Channel>,
    /// The neurons between sensors and motors.
    pub neurons: Vec<Channel>,
    /// What the controller answers.
    pub outputs: Vec<Channel>,
    /// Whatever else has a name.
    pub scalars: Vec<Channel>,
    /// The points worth seeing, by number.
    pub points: Vec<String>,
    /// The images that cameras see, and those on the ground, by number.
    pub images: Vec<ImageChannel>,
    /// How the nodes are linked, for a picture of the network.
    pub links: Vec<Links>,
    /// What other parameters nodes have.
    pub node_parameters: Vec<NodeParameters>,
    /// How a page looks at it.
    pub view: View,
}

fn channels<N: AsRef<str>>(names: impl IntoIterator<Item = N>, group: &str) -> Vec<Channel> {
    names.into_iter().map(|name| Channel::new(name.as_ref()).group(group)).collect()
}

impl Schema {
    /// Only the bodies of a robot or scene.
    pub fn from_robot(robot: &Robot) -> Self {
        Self { robot: Some(robot.clone()), ..Self::default() }
    }

    /// Only named values, units in brackets: `["x [m]"]`.
    pub fn from_scalars<N: AsRef<str>>(names: impl IntoIterator<Item = N>) -> Self {
        Self::default().with_scalars(names)
    }

    /// With these sensors.
    pub fn with_sensors<N: AsRef<str>>(self, names: impl IntoIterator<Item = N>) -> Self {
        Self { sensors: channels(names, "sensor"), ..self }
    }

    /// With these outputs.
    pub fn with_outputs<N: AsRef<str>>(self, names: impl IntoIterator<Item = N>) -> Self {
        Self { outputs: channels(names, "output"), ..self }
    }

    /// With these values of one's own.
    pub fn with_scalars<N: AsRef<str>>(self, names: impl IntoIterator<Item = N>) -> Self {
        Self { scalars: channels(names, "value"), ..self }
    }

    /// With labels for the channels that are there by now, as pairs of a name and a label.
    ///
    /// A pair fits a channel that has the name, and one whose name begins with it and a space: `("J4", "elbow")` makes
    /// `J4 torque` an `elbow torque`. Of several pairs that fit, the first counts.
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

    /// With another image.
    pub fn with_image(mut self, name: &str, size: [usize; 2]) -> Self {
        self.images.push(ImageChannel::new(name, size));
        self
    }

    /// With the neurons and links of a network whose sensors and outputs those of the schema are.
    ///
    /// The recorder must be given the network's parameters, [`Recorder::parameters`](farsa_body::Recorder::parameters).
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

    /// The bodies that can be seen.
    pub fn shown(&self) -> impl Iterator<Item = BodyId> + '_ {
        let of_robot = self.robot.iter().flat_map(Robot::shaped_bodies);
        let mut of_objects: Vec<BodyId> = self.objects.iter().filter_map(|object| object.body).collect();
        of_objects.sort_unstable();
        of_objects.dedup();
        let known = |body: &BodyId| self.robot.as_ref().is_some_and(|robot| robot.shaped_bodies().any(|b| b == *body));
        of_objects.retain(|body| !known(body));
        of_robot.chain(of_objects)
    }

    /// Number of bodies, seen or not.
    pub(crate) fn body_count(&self) -> usize {
        self.robot.as_ref().map_or(self.bodies.len(), |robot| robot.segments.len())
    }

    /// What a body is called; empty if there is none.
    pub(crate) fn body_name(&self, body: BodyId) -> &str {
        match &self.robot {
            Some(robot) => robot.segments.get(body.index()).map_or("", |segment| segment.name.as_str()),
            None => self.bodies.get(body.index()).map_or("", String::as_str),
        }
    }

    /// All channels with the prefix that tells sensors, neurons and outputs from other values, in the order of tables.
    pub(crate) fn channels(&self) -> impl Iterator<Item = (&'static str, &Channel)> {
        let scalars = self.scalars.iter().map(|channel| ("", channel));
        let sensors = self.sensors.iter().map(|channel| ("sensor.", channel));
        let neurons = self.neurons.iter().map(|channel| ("neuron.", channel));
        let outputs = self.outputs.iter().map(|channel| ("output.", channel));
        scalars.chain(sensors).chain(neurons).chain(outputs)
    }

    /// The columns of a table of everything but bodies, contacts, rays, points and images.
    pub fn columns(&self) -> Vec<String> {
        self.channels().map(|(prefix, channel)| format!("{prefix}{}", channel.title())).collect()
    }

    /// Whether a body moves by itself: it floats, or slides in a plane, and nothing with a joint hangs on it.
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
        // Others stay as they are.
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
