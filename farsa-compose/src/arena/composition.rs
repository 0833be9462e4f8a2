//! Robots in an arena: all that the trials of an experiment share.

use farsa_body::ports::{BodyId, Channels, Motor as _, Sensor as _};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::infrared::InfraredDrawing;
use farsa_lab::{Error, PlanarWorld};
use farsa_num::Stream;

use crate::arena::driving::{Driving, motor};
use crate::arena::field::Field;
use crate::arena::scene::{Scene, Thing};
use crate::arena::sensing::{Sensing, sensor};
use crate::arena::starting::Starting;
use crate::arena::term::Term;
use crate::check::places::Places;
use crate::document::{Document, Ending, MotorKind, SensorKind};
use crate::parts::agents::Agents;
use crate::parts::bounded::{Room, bounded_parts};
use crate::parts::files::Files;
use crate::parts::ledger::Ledger;
use crate::parts::wiring::Wiring;
use crate::parts::wrapping::{NoiseStreams, Reseed as _};

/// The scene of an experiment with its robots, and what is measured of them.
#[derive(Clone, Debug)]
pub(crate) struct Composition {
    pub(crate) scene: Scene,
    /// The sensors of each robot, and its motors.
    pub(crate) members: Vec<Member>,
    /// The nest and the field around it, if there are any.
    pub(crate) foraging: Option<(BodyId, Field)>,
    /// Whether things can be carried away during a trial.
    pub(crate) moving: bool,
    pub(crate) starting: Starting,
    /// What the terms measure.
    pub(crate) terms: Vec<Term>,
}

/// What a robot senses and does.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) parts: farsa_body::robots::MobileParts,
    pub(crate) sensors: Vec<Sensing>,
    pub(crate) motors: Vec<Driving>,
    /// The infrared sensors that a recording draws, with their first channel.
    pub(crate) drawn: Vec<(usize, InfraredDrawing)>,
}

/// Names of sensors or motors, with the first channel of each and the one after the last.
type Spans = [(String, [usize; 2])];

impl Member {
    /// Reads all sensors, whose channels these are.
    #[inline]
    pub(crate) fn sense<W: PlanarWorld>(&mut self, spans: &Spans, world: &W, x: &mut [f32]) {
        for (sensor, (_, [first, end])) in self.sensors.iter_mut().zip(spans) {
            sensor.read(world, &mut x[*first..*end]);
        }
    }

    /// Drives all motors, whose channels these are.
    #[inline]
    pub(crate) fn drive<W: PlanarWorld>(&mut self, spans: &Spans, y: &[f32], world: &mut W) {
        for (motor, (_, [first, end])) in self.motors.iter_mut().zip(spans) {
            motor.drive(&y[*first..*end], world);
        }
    }

    /// Puts all motors to rest.
    pub(crate) fn rest<W: PlanarWorld>(&mut self, spans: &Spans, y: &mut [f32], world: &mut W) {
        for (motor, (_, [first, end])) in self.motors.iter_mut().zip(spans) {
            motor.rest(&mut y[*first..*end], world);
        }
    }
}

impl Composition {
    /// The parts of a document with their channels and terms; errors name the places where they stand.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Unknown`] for what does not go together.
    pub(crate) fn new(document: Document, places: &Places) -> Result<(Self, Agents), Error> {
        let scene = Scene::new(&document, places)?;
        let infrared = scene.robots.iter().map(|robot| robot.infrared.angles.len() * robot.infrared.rays).sum();
        bounded_parts(&document, scene.robots.len(), infrared, places)?;
        let (mut files, mut room) = (Files::new(&document.files), Room::new());
        let mut members = Vec::new();
        for robot in 0..scene.robots.len() {
            let (mut sensors, mut motors) = (Vec::new(), Vec::new());
            for (index, own) in document.sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled) {
                sensors.push(sensor(own, &scene, robot, &format!("/sensors/{index}"), &mut files, &mut room, places)?);
            }
            for (index, own) in document.motors.iter().enumerate().filter(|(_, motor)| motor.enabled) {
                motors.push(motor(own, &scene, robot, &format!("/motors/{index}"), &mut room, places)?);
            }
            let drawn = drawn(&document, &scene.robots[robot], &sensors);
            members.push(Member { parts: scene.parts(robot), sensors, motors, drawn });
        }
        alike(&members, &scene, &document, places)?;
        let channels = [
            members[0].sensors.iter().map(Channels::channels).collect(),
            members[0].motors.iter().map(Channels::channels).collect(),
        ];
        let wiring = Wiring::new(&document, channels, places)?;
        room.take(wiring.kept().saturating_mul(members.len()), "/network", places)?;
        let term = |(number, reward)| Term::new(reward, number, &wiring.sensors, &scene, places);
        let terms = document.reward.iter().enumerate().map(term).collect::<Result<Vec<_>, _>>()?;
        let of_steps: Vec<bool> = terms.iter().map(Term::looks_back).collect();
        let ledger = Ledger::new(&document, &of_steps, &scene.groups, places)?;
        let foraging = foraging(&document, &scene, &terms, places)?;
        let moving = document.motors.iter().any(|motor| motor.enabled && motor.kind == MotorKind::Attachment {})
            || !scene.blocks.is_empty()
            || terms.iter().any(|term| term.is_about_robot(&scene));
        let starting = Starting::new(&document, &scene, places)?;
        let agents = Agents::new(document, wiring, ledger, scene.groups.clone());
        Ok((Self { scene, members, foraging, moving, starting, terms }, agents))
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

/// Refuses sensors that have other channels on other robots: one network has to fit all.
fn alike(members: &[Member], scene: &Scene, document: &Document, places: &Places) -> Result<(), Error> {
    let enabled = document.sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled);
    for (place, (index, _)) in enabled.enumerate() {
        let first = members[0].sensors[place].channels();
        let other = |robot: &usize| members[*robot].sensors[place].channels() != first;
        if let Some(robot) = (1..members.len()).find(other) {
            let [one, two] = [0, robot].map(|robot| scene.groups.of(robot));
            let channels = members[robot].sensors[place].channels();
            let why = format!("has {first} channels on `{one}` and {channels} on `{two}`: one network has to fit both");
            return Err(places.wrong(&format!("/sensors/{index}"), why));
        }
    }
    Ok(())
}

/// The nest and the field of a document.
///
/// # Errors
/// [`Error::Unknown`] for a nest that there is not, [`Error::Setting`] for one that is no disc, and for what asks for food or
/// energy where there are none.
fn foraging(
    document: &Document,
    scene: &Scene,
    terms: &[Term],
    places: &Places,
) -> Result<Option<(BodyId, Field)>, Error> {
    let Some(foraging) = &document.foraging else {
        let felt = |kind: &SensorKind| matches!(kind, SensorKind::Energy {} | SensorKind::Carried {});
        let sensor = document.sensors.iter().position(|sensor| felt(&sensor.kind)).map(|own| format!("/sensors/{own}"));
        let term = terms.iter().position(Term::of_foraging).map(|own| format!("/reward/{own}"));
        let ending = document.episode.ends.contains(&Ending::Death).then(|| "/episode/ends".into());
        return match sensor.or(term).or(ending) {
            Some(path) => Err(places.wrong(&path, "needs the section `foraging`, which there is not")),
            None => Ok(None),
        };
    };
    let path = "/foraging/nest";
    match scene.thing(&foraging.nest, path, places)? {
        Thing::Area { body, half: [radius, _], disc: true } => {
            let cells = foraging.cells as usize;
            Ok(Some((body, Field::new(scene.size, cells, foraging.cost, radius, scene.robots.len()))))
        }
        _ => Err(places.wrong(path, format!("`{}` is no disc", foraging.nest))),
    }
}

/// The infrared sensors of a robot that a recording draws, with the first channel of each.
fn drawn(document: &Document, robot: &MobileRobot, sensors: &[Sensing]) -> Vec<(usize, InfraredDrawing)> {
    let mut first = 0;
    let enabled = document.sensors.iter().filter(|sensor| sensor.enabled).zip(sensors);
    let found = enabled.map(|(sensor, made)| {
        first += made.channels();
        (first - made.channels(), &sensor.kind)
    });
    let infrared = found.filter_map(|(first, kind)| match kind {
        SensorKind::Infrared { first: count, groups, .. } => {
            let mut robot = robot.clone();
            let sensors = robot.infrared.angles.len();
            robot.infrared.angles.truncate(if *count == 0 { sensors } else { *count as usize });
            let groups = if *groups == 0 { robot.infrared.angles.len() } else { *groups as usize };
            Some((first, InfraredDrawing::for_robot(&robot, groups)))
        }
        _ => None,
    });
    infrared.collect()
}
