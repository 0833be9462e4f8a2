//! Channels of a robot, and the network between them.

use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::{Document, MotorKind};
use crate::formula::channels::ChannelNames;
use crate::part::network::{Built, NetworkEnds};
use crate::parts::network::AnyNetwork;
use crate::parts::searched::Searched;
use crate::parts::wrapping::changes;

/// Names of sensors or motors, with the first channel of each and the one after the last.
pub(crate) type Spans = Vec<(String, [usize; 2])>;

/// Channels of a robot, its network, and the parameters of a search.
#[derive(Clone, Debug)]
pub(crate) struct NetworkSpec {
    pub(crate) sensors: Spans,
    pub(crate) motors: Spans,
    /// Descriptions of sensors, then of motors.
    pub(crate) about: Vec<String>,
    /// Names of all inputs.
    pub(crate) inputs: Vec<String>,
    /// Names of all outputs.
    pub(crate) outputs: Vec<String>,
    pub(crate) network: AnyNetwork,
    pub(crate) searched: Searched,
}

/// Most channels of all sensors of a robot, and of all its motors.
const MAX_CHANNELS: usize = 10_000;

impl NetworkSpec {
    /// Builds the network of a document whose enabled sensors and motors have these numbers of channels.
    pub(crate) fn new(document: &Document, channels: [Vec<usize>; 2], source: &Source) -> Result<Self, Error> {
        let [mut absent, mut about] = [Vec::new(), Vec::new()];
        let [sensor_channels, motor_channels] = channels;
        let mut spans = |changes: Vec<Option<String>>, names: &[(String, String)], channels: Vec<usize>| {
            let mut named = Vec::new();
            for (changes, (name, text)) in changes.into_iter().zip(names) {
                let Some(changes) = changes else {
                    absent.push(name.clone());
                    continue;
                };
                named.push(name.clone());
                about.push(if changes.is_empty() { text.clone() } else { format!("{text} With {changes}.") });
            }
            spans(named.into_iter().zip(channels))
        };
        let registry = &source.registry;
        let sensors = document.sensors.iter();
        let sensors = sensors.map(|sensor| sensor.enabled.then(|| changes(sensor.wrappers.iter(), registry)));
        let sensors = spans(sensors.collect(), &source.names.sensors, sensor_channels);
        let motors = document.motors.iter();
        let motors = motors.map(|motor| motor.enabled.then(|| changes(motor.wrappers.iter().rev(), registry)));
        let motors = spans(motors.collect(), &source.names.motors, motor_channels);
        let [inputs, outputs] = [&sensors, &motors].map(|spans| spans.last().map_or(0, |(_, [_, end])| *end));
        for (list, channels) in [("sensors", inputs), ("motors", outputs)] {
            if !(1..=MAX_CHANNELS).contains(&channels) {
                let why = format!("have {channels} channels; from 1 to {MAX_CHANNELS} make a network");
                return Err(source.wrong(&format!("/{list}"), why));
            }
        }
        let of_sensors = document.sensors.iter().map(|sensor| (sensor.enabled, sensor.channels.as_deref(), &[][..]));
        let inputs = channel_names("sensors", of_sensors, &sensors, source)?;
        let of_motors = document.motors.iter();
        let words = |kind: &MotorKind| registry.motor(kind).map_or(&[][..], |motor| motor.channels());
        let of_motors = of_motors.map(|motor| (motor.enabled, motor.channels.as_deref(), words(&motor.kind)));
        let outputs = channel_names("motors", of_motors, &motors, source)?;
        let ends = NetworkEnds {
            inputs: &inputs,
            outputs: &outputs,
            time_step: document.world.time_step,
            weights: document.network.weights,
            sensors: &sensors,
            motors: &motors,
            absent: &absent,
            files: &document.files,
            text: source,
        };
        let (network, Built { parameters, given, .. }) = AnyNetwork::new(document, &ends, source)?;
        let searched = Searched::new(parameters, &given, &document.network, source)?;
        searched.check(&network, source)?;
        Ok(Self { sensors, motors, about, inputs, outputs, network, searched })
    }

    /// Gets the names of sensors, motors and channels.
    pub(crate) fn channel_names(&self) -> ChannelNames<'_> {
        let Self { sensors, motors, inputs, outputs, .. } = self;
        ChannelNames { sensors, motors, inputs, outputs }
    }

    /// Gets the number of values that each robot keeps: channels, parameters and state.
    pub(crate) fn values(&self) -> usize {
        self.inputs.len() + self.outputs.len() + self.network.values()
    }
}

/// Numbers the channels of parts.
fn spans(named: impl Iterator<Item = (String, usize)>) -> Spans {
    let mut first = 0;
    let span = |(name, count): (String, usize)| {
        first += count;
        (name, [first - count, first])
    };
    named.map(span).collect()
}

/// Names all channels of a list of parts: as the document does, or by words or numbers.
fn channel_names<'d>(
    list: &str,
    parts: impl Iterator<Item = (bool, Option<&'d [String]>, &'d [&'d str])>,
    spans: &Spans,
    source: &Source,
) -> Result<Vec<String>, Error> {
    let mut names = Vec::new();
    let enabled = parts.enumerate().filter(|(_, (enabled, ..))| *enabled);
    for ((index, (_, given, words)), (name, [first, end])) in enabled.zip(spans) {
        match (given, end - first) {
            (Some(given), count) if given.len() != count => {
                let why = format!("has {} names for {count} channels", given.len());
                return Err(source.wrong(&format!("/{list}/{index}/channels"), why));
            }
            (Some(given), _) => names.extend_from_slice(given),
            (None, _) if !words.is_empty() => names.extend(words.iter().map(|word| format!("{name} {word}"))),
            (None, 1) => names.push(name.clone()),
            (None, count) => names.extend((1..=count).map(|number| format!("{name} {number}"))),
        }
    }
    Ok(names)
}
