//! A document, checked and made: all that its trials share.

use farsa_body::Channels;
use farsa_lab::Error;
use farsa_num::{Domain, Stream};

use crate::check::places::Places;
use crate::check::schema::{Part, schema};
use crate::check::settings::names;
use crate::document::{Document, MotorKind, SensorKind};
use crate::parts::driving::{Driving, motor};
use crate::parts::network::AnyNetwork;
use crate::parts::scene::Scene;
use crate::parts::sensing::{Sensing, sensor};
use crate::parts::starting::Starting;
use crate::parts::term::{Term, Wanted};
use crate::parts::wrapping::{NoiseStreams, Reseed as _};

/// The parts of an experiment.
#[derive(Clone, Debug)]
pub(crate) struct Composition {
    pub(crate) document: Document,
    pub(crate) scene: Scene,
    /// The sensors of each robot, and its motors.
    pub(crate) members: Vec<Member>,
    /// Names of the sensors and motors, with the first channel of each and the one after the last.
    pub(crate) sensors: Vec<(String, [usize; 2])>,
    pub(crate) motors: Vec<(String, [usize; 2])>,
    /// What they are, sensors and then motors.
    pub(crate) about: Vec<String>,
    /// Names of all inputs and outputs of a network.
    pub(crate) inputs: Vec<String>,
    pub(crate) outputs: Vec<String>,
    pub(crate) network: AnyNetwork,
    /// Whether things can be carried away during a trial.
    pub(crate) moving: bool,
    pub(crate) starting: Starting,
    pub(crate) terms: Vec<Term>,
    pub(crate) success: Vec<Wanted>,
}

/// What a robot senses and does.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) parts: farsa_body::MobileParts,
    pub(crate) sensors: Vec<Sensing>,
    pub(crate) motors: Vec<Driving>,
}

/// The most channels of a robot's sensors or motors.
const MOST_CHANNELS: usize = 10_000;
/// The most rays that all robots send out in a step.
const MOST_RAYS: usize = 200_000;

impl Composition {
    /// The parts of a document; errors name the places where they stand.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Unknown`] for what does not go together.
    pub(crate) fn new(document: Document, places: &Places) -> Result<Self, Error> {
        let scene = Scene::new(&document, places)?;
        let of_sensors = names(&json(&document.sensors)?);
        let of_motors = names(&json(&document.motors)?);
        bounded(&document, places)?;
        let mut members = Vec::new();
        for robot in 0..scene.robots {
            let (mut sensors, mut motors) = (Vec::new(), Vec::new());
            for (index, own) in document.sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled) {
                sensors.push(sensor(own, &scene, robot, &format!("/sensors/{index}"), places)?);
            }
            for (index, own) in document.motors.iter().enumerate().filter(|(_, motor)| motor.enabled) {
                motors.push(motor(own, &scene, robot, &format!("/motors/{index}"), places)?);
            }
            members.push(Member { parts: scene.parts(robot), sensors, motors });
        }
        let enabled = document.sensors.iter().zip(of_sensors).filter(|(sensor, _)| sensor.enabled);
        let counts = members[0].sensors.iter().map(Channels::channels);
        let sensors = spans(enabled.map(|(_, name)| name).zip(counts));
        let enabled = document.motors.iter().zip(of_motors).filter(|(motor, _)| motor.enabled);
        let counts = members[0].motors.iter().map(Channels::channels);
        let motors = spans(enabled.map(|(_, name)| name).zip(counts));
        let about = about(&document)?;
        let [inputs, outputs] = [&sensors, &motors].map(|spans| spans.last().map_or(0, |(_, [_, end])| *end));
        for (list, channels) in [("sensors", inputs), ("motors", outputs)] {
            if !(1..=MOST_CHANNELS).contains(&channels) {
                let why = format!("have {channels} channels; from 1 to {MOST_CHANNELS} make a network");
                return Err(places.wrong(&format!("/{list}"), why));
            }
        }
        let network = AnyNetwork::new(&document.network, [inputs, outputs], document.world.time_step);
        let network = network.map_err(|error| places.wrong("/network", error))?;
        let rewards = names(&json(&document.reward)?);
        let term = |(number, reward)| Term::new(reward, number, &rewards, &sensors, &scene, places);
        let terms = document.reward.iter().enumerate().map(term).collect::<Result<Vec<_>, _>>()?;
        if terms.is_empty() {
            return Err(places.wrong("/reward", "has no term: nothing is earned"));
        }
        let wanted = |(index, condition)| Wanted::new(condition, &format!("/success/{index}"), &rewards, places);
        let success = document.success.iter().enumerate().map(wanted).collect::<Result<Vec<_>, _>>()?;
        let moving = document.motors.iter().any(|motor| motor.enabled && motor.kind == MotorKind::Attachment {});
        let starting = Starting::new(&document, &scene, places)?;
        let named = |spans: &[(String, [usize; 2])]| spans.iter().flat_map(channel_names).collect::<Vec<_>>();
        let (inputs, outputs) = (named(&sensors), output_names(&document, &motors));
        Ok(Self {
            document,
            scene,
            members,
            sensors,
            motors,
            about,
            inputs,
            outputs,
            network,
            moving,
            starting,
            terms,
            success,
        })
    }

    /// Gives all noise its streams for an episode.
    pub(crate) fn reseed(members: &mut [Member], [sensor, motor]: [Stream; 2], steps: u32) {
        let mut streams = [NoiseStreams::new(sensor, steps), NoiseStreams::new(motor, steps)];
        for member in members {
            member.sensors.iter_mut().for_each(|sensor| sensor.reseed(&mut streams[0]));
            member.motors.iter_mut().for_each(|motor| motor.reseed(&mut streams[1]));
        }
    }
}

/// The domains of the noise of sensors and of motors.
pub(crate) const NOISE: [Domain; 2] = [Domain::Sensor, Domain::Motor];

/// What the schema says of each sensor and motor that is there.
fn about(document: &Document) -> Result<Vec<String>, Error> {
    let schema = schema();
    let Some(part) = Part::root(&schema) else { return Ok(Vec::new()) };
    let [sensors, motors] = [json(&document.sensors)?, json(&document.motors)?];
    let lists = [("sensors", sensors), ("motors", motors)];
    let enabled = |part: &serde_json::Value| part["enabled"] == true;
    let found = lists.iter().flat_map(|(list, parts)| {
        let kinds = parts.iter().filter(|part| enabled(part)).map(|part| part["kind"].as_str().unwrap_or_default());
        kinds.map(|kind| part.about(list, kind).to_owned())
    });
    Ok(found.collect())
}

/// Refuses what would take a step too long.
fn bounded(document: &Document, places: &Places) -> Result<(), Error> {
    let robots = document.robot.count as usize;
    for (index, sensor) in document.sensors.iter().enumerate() {
        let rays = match &sensor.kind {
            SensorKind::LaserDistance { beams, .. } => *beams as usize,
            SensorKind::Camera(camera) => camera.sectors as usize * camera.rays as usize,
            _ => 0,
        };
        if rays.saturating_mul(robots) > MOST_RAYS {
            let why = format!("sends out {rays} rays from each of {robots} robots; at most {MOST_RAYS} in all");
            return Err(places.wrong(&format!("/sensors/{index}"), why));
        }
    }
    Ok(())
}

fn json<T: serde::Serialize>(parts: &[T]) -> Result<Vec<serde_json::Value>, Error> {
    let values = parts.iter().map(serde_json::to_value);
    values.collect::<Result<_, _>>().map_err(|error| Error::Other(error.to_string()))
}

/// Names with the first channel of each and the one after the last.
fn spans(named: impl Iterator<Item = (String, usize)>) -> Vec<(String, [usize; 2])> {
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

/// The names of outputs: wheels and LEDs have words of their own.
fn output_names(document: &Document, motors: &[(String, [usize; 2])]) -> Vec<String> {
    let enabled = document.motors.iter().filter(|motor| motor.enabled);
    let of_motor = |(motor, span): (&crate::document::Motor, &(String, [usize; 2]))| {
        let own = |words: &[&str]| words.iter().map(|word| format!("{} {word}", span.0)).collect::<Vec<_>>();
        match &motor.kind {
            MotorKind::Wheels {} => own(&["left", "right"]),
            MotorKind::SpeedAndTurn { .. } => own(&["speed", "turn"]),
            _ => channel_names(span),
        }
    };
    enabled.zip(motors).flat_map(of_motor).collect()
}
