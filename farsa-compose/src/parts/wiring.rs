//! What robots sense, do and compute with: channels, and the network between them.

use farsa_lab::Error;
use serde_json::Value;

use crate::check::places::Places;
use crate::check::schema::{Part, SCHEMA};
use crate::check::settings::names;
use crate::document::{Document, Motor, MotorKind};
use crate::parts::ends::Ends;
use crate::parts::meaning::changes;
use crate::parts::network::AnyNetwork;
use crate::parts::searched::Searched;

/// Names of sensors or motors, with the first channel of each and the one after the last.
pub(crate) type Spans = Vec<(String, [usize; 2])>;

/// The channels of a robot, and its network.
#[derive(Clone, Debug)]
pub(crate) struct Wiring {
    pub(crate) sensors: Spans,
    pub(crate) motors: Spans,
    /// What they are, sensors and then motors.
    pub(crate) about: Vec<String>,
    /// Names of all inputs and outputs of a network.
    pub(crate) inputs: Vec<String>,
    pub(crate) outputs: Vec<String>,
    pub(crate) network: AnyNetwork,
    /// Which of its parameters are searched for.
    pub(crate) searched: Searched,
}

/// The most channels of a robot's sensors or motors.
const MOST_CHANNELS: usize = 10_000;

impl Wiring {
    /// That of a document, whose sensors and motors that are there have so many channels each.
    ///
    /// # Errors
    /// [`Error::Setting`] for too few or too many channels, and what is wrong with the network.
    pub(crate) fn new(
        document: &Document,
        [of_sensors, of_motors]: [Vec<usize>; 2],
        places: &Places,
    ) -> Result<Self, Error> {
        let named = names(&json(&document.sensors)?);
        let enabled = document.sensors.iter().zip(named).filter(|(sensor, _)| sensor.enabled);
        let sensors = spans(enabled.map(|(_, name)| name).zip(of_sensors));
        let named = names(&json(&document.motors)?);
        let enabled = document.motors.iter().zip(named).filter(|(motor, _)| motor.enabled);
        let motors = spans(enabled.map(|(_, name)| name).zip(of_motors));
        let [inputs, outputs] = [&sensors, &motors].map(|spans| spans.last().map_or(0, |(_, [_, end])| *end));
        for (list, channels) in [("sensors", inputs), ("motors", outputs)] {
            if !(1..=MOST_CHANNELS).contains(&channels) {
                let why = format!("have {channels} channels; from 1 to {MOST_CHANNELS} make a network");
                return Err(places.wrong(&format!("/{list}"), why));
            }
        }
        let inputs: Vec<String> = sensors.iter().flat_map(channel_names).collect();
        let outputs = output_names(document, &motors);
        let ends =
            Ends { inputs: &inputs, outputs: &outputs, sensors: &sensors, motors: &motors, absent: &absent(document)? };
        let network = AnyNetwork::new(document, ends, places)?;
        let all = network.parameters(&document.network, ends);
        let given = network.given(&document.network, ends);
        let searched = Searched::new(all, &given, &document.network, places)?;
        searched.check(&network, places)?;
        Ok(Self { about: about(document)?, sensors, motors, inputs, outputs, network, searched })
    }

    /// How many values each robot keeps of it: what it senses and does, and its own network.
    pub(crate) fn kept(&self) -> usize {
        self.inputs.len() + self.outputs.len() + self.network.kept()
    }
}

/// The names of sensors and motors that are switched off.
fn absent(document: &Document) -> Result<Vec<String>, Error> {
    let sensors = names(&json(&document.sensors)?).into_iter().zip(document.sensors.iter().map(|part| part.enabled));
    let motors = names(&json(&document.motors)?).into_iter().zip(document.motors.iter().map(|part| part.enabled));
    Ok(sensors.chain(motors).filter(|(_, enabled)| !enabled).map(|(name, _)| name).collect())
}

/// What the schema says of each sensor and motor that is there, and what changes its values.
fn about(document: &Document) -> Result<Vec<String>, Error> {
    let schema = &*SCHEMA;
    let Some(part) = Part::root(schema) else { return Ok(Vec::new()) };
    let [sensors, motors] = [json(&document.sensors)?, json(&document.motors)?];
    let said = |list: &str, own: &Value, changes: String| {
        let about = part.about(list, own["kind"].as_str().unwrap_or_default());
        if changes.is_empty() { about.to_owned() } else { format!("{about} With {changes}.") }
    };
    let of_sensors = document.sensors.iter().zip(&sensors).filter(|(sensor, _)| sensor.enabled);
    let of_sensors = of_sensors.map(|(sensor, own)| said("sensors", own, changes(sensor.wrappers.iter())));
    let of_motors = document.motors.iter().zip(&motors).filter(|(motor, _)| motor.enabled);
    let of_motors = of_motors.map(|(motor, own)| said("motors", own, changes(motor.wrappers.iter().rev())));
    Ok(of_sensors.chain(of_motors).collect())
}

/// Parts of a document as JSON.
///
/// # Errors
/// [`Error::Other`] for what is no JSON.
pub(crate) fn json<T: serde::Serialize>(parts: &[T]) -> Result<Vec<Value>, Error> {
    let values = parts.iter().map(serde_json::to_value);
    values.collect::<Result<_, _>>().map_err(|error| Error::Other(error.to_string()))
}

/// Names with the first channel of each and the one after the last.
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

/// The names of outputs: wheels and muscles have words of their own.
fn output_names(document: &Document, motors: &Spans) -> Vec<String> {
    let enabled = document.motors.iter().filter(|motor| motor.enabled);
    let of_motor = |(motor, span): (&Motor, &(String, [usize; 2]))| {
        let own = |words: &[&str]| words.iter().map(|word| format!("{} {word}", span.0)).collect::<Vec<_>>();
        match &motor.kind {
            MotorKind::Wheels {} => own(&["left", "right"]),
            MotorKind::SpeedAndTurn { .. } => own(&["speed", "turn"]),
            _ => channel_names(span),
        }
    };
    enabled.zip(motors).flat_map(of_motor).collect()
}
