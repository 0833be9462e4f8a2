//! The channels of a robot, and the network between them.

use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::{Document, MotorKind};
use crate::parts::channel_quantity::changes;
use crate::parts::ends::Ends;
use crate::parts::network::AnyNetwork;
use crate::parts::searched::Searched;

/// Names of sensors or motors, with the first channel of each and the one after the last.
pub(crate) type Spans = Vec<(String, [usize; 2])>;

/// The channels of a robot, its network, and the parameters of a search.
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
        let mut named = Vec::new();
        for (sensor, (name, text)) in document.sensors.iter().zip(&source.names.sensors) {
            if sensor.enabled {
                named.push(name.clone());
                about.push(with_changes(text, &changes(sensor.wrappers.iter())));
            } else {
                absent.push(name.clone());
            }
        }
        let sensors = spans(named.drain(..).zip(sensor_channels));
        for (motor, (name, text)) in document.motors.iter().zip(&source.names.motors) {
            if motor.enabled {
                named.push(name.clone());
                about.push(with_changes(text, &changes(motor.wrappers.iter().rev())));
            } else {
                absent.push(name.clone());
            }
        }
        let motors = spans(named.into_iter().zip(motor_channels));
        let [inputs, outputs] = [&sensors, &motors].map(|spans| spans.last().map_or(0, |(_, [_, end])| *end));
        for (list, channels) in [("sensors", inputs), ("motors", outputs)] {
            if !(1..=MAX_CHANNELS).contains(&channels) {
                let why = format!("have {channels} channels; from 1 to {MAX_CHANNELS} make a network");
                return Err(source.wrong(&format!("/{list}"), why));
            }
        }
        let inputs = input_names(document, &sensors, source)?;
        let outputs = output_names(document, &motors, source)?;
        let ends = Ends { inputs: &inputs, outputs: &outputs, sensors: &sensors, motors: &motors, absent: &absent };
        let network = AnyNetwork::new(document, ends, source)?;
        let parameters = network.parameters(&document.network, ends);
        let given = network.given(&document.network, ends);
        let searched = Searched::new(parameters, &given, &document.network, source)?;
        searched.check(&network, source)?;
        Ok(Self { sensors, motors, about, inputs, outputs, network, searched })
    }

    /// Returns the number of values that each robot keeps: channels, parameters and state.
    pub(crate) fn values(&self) -> usize {
        self.inputs.len() + self.outputs.len() + self.network.values()
    }
}

/// Appends the wrappers of a part to its description.
fn with_changes(about: &str, changes: &str) -> String {
    if changes.is_empty() { about.to_owned() } else { format!("{about} With {changes}.") }
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

fn channel_names((name, [first, end]): &(String, [usize; 2])) -> Vec<String> {
    match end - first {
        1 => vec![name.clone()],
        count => (1..=count).map(|number| format!("{name} {number}")).collect(),
    }
}

/// Names the inputs, by default with numbers.
fn input_names(document: &Document, spans: &Spans, source: &Source) -> Result<Vec<String>, Error> {
    let sensors = document.sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled).zip(spans);
    let names = sensors.map(|((index, sensor), span)| {
        given_names(sensor.channels.as_ref(), channel_names(span), &format!("/sensors/{index}/channels"), source)
    });
    Ok(names.collect::<Result<Vec<_>, _>>()?.concat())
}

/// Names the outputs. By default wheels have words instead of numbers.
fn output_names(document: &Document, spans: &Spans, source: &Source) -> Result<Vec<String>, Error> {
    let motors = document.motors.iter().enumerate().filter(|(_, motor)| motor.enabled).zip(spans);
    let names = motors.map(|((index, motor), span)| {
        let with = |words: &[&str]| words.iter().map(|word| format!("{} {word}", span.0)).collect::<Vec<_>>();
        let names = match &motor.kind {
            MotorKind::Wheels {} => with(&["left", "right"]),
            MotorKind::SpeedAndTurn { .. } => with(&["speed", "turn"]),
            _ => channel_names(span),
        };
        given_names(motor.channels.as_ref(), names, &format!("/motors/{index}/channels"), source)
    });
    Ok(names.collect::<Result<Vec<_>, _>>()?.concat())
}

/// Returns the names that a document gives to channels, or the default names.
fn given_names(
    given: Option<&Vec<String>>,
    names: Vec<String>,
    path: &str,
    source: &Source,
) -> Result<Vec<String>, Error> {
    match given {
        Some(given) if given.len() != names.len() => {
            Err(source.wrong(path, format!("has {} names for {} channels", given.len(), names.len())))
        }
        given => Ok(given.cloned().unwrap_or(names)),
    }
}
