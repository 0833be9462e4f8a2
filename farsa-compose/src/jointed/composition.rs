//! A robot with joints in its scene: all that the trials of an experiment share.

use farsa_body::ports::{BodyId, Channels as _, JointId, PairId};
use farsa_body::robot::JointKind;
use farsa_lab::Error;
use farsa_num::Stream;
use farsa_physics::articulated::Options;

use crate::check::places::Places;
use crate::document::{Document, Ending, Engine, SensorKind};
use crate::jointed::driving::{Driving, motor};
use crate::jointed::scene::{ROBOT, Scene};
use crate::jointed::sensing::{Sensing, sensor};
use crate::jointed::starting::Starting;
use crate::jointed::term::Term;
use crate::parts::agents::Agents;
use crate::parts::bounded::{Room, bounded_parts};
use crate::parts::groups::Groups;
use crate::parts::ledger::Ledger;
use crate::parts::wiring::Wiring;
use crate::parts::wrapping::{NoiseStreams, Reseed as _};

/// The scene of an experiment with its robot, and what is measured of it.
#[derive(Clone, Debug)]
pub(crate) struct Composition {
    pub(crate) scene: Scene,
    pub(crate) sensors: Vec<Sensing>,
    pub(crate) motors: Vec<Driving>,
    pub(crate) starting: Starting,
    /// What the terms measure.
    pub(crate) terms: Vec<Term>,
    /// The pairs by which the robot runs into a thing.
    pub(crate) collisions: Vec<PairId>,
    /// All joints, and the bodies that float: what shows whether the dynamics broke down.
    pub(crate) joints: Vec<JointId>,
    pub(crate) floating: Vec<BodyId>,
}

impl Composition {
    /// The parts of a document with their channels and terms; errors name the places where they stand.
    ///
    /// # Errors
    /// [`Error::Setting`] and [`Error::Unknown`] for what does not go together.
    pub(crate) fn new(document: Document, places: &Places) -> Result<(Self, Agents), Error> {
        refuse(&document, places)?;
        let mut scene = Scene::new(&document, places)?;
        let (mut sensors, mut motors, mut room) = (Vec::new(), Vec::new(), Room::new());
        for (index, own) in document.sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled) {
            sensors.push(sensor(own, &scene, &format!("/sensors/{index}"), &mut room, places)?);
        }
        for (index, own) in document.motors.iter().enumerate().filter(|(_, motor)| motor.enabled) {
            motors.push(motor(own, &mut scene, &format!("/motors/{index}"), &mut room, places)?);
        }
        let channels =
            [sensors.iter().map(Sensing::channels).collect(), motors.iter().map(Driving::channels).collect()];
        let wiring = Wiring::new(&document, channels, places)?;
        room.take(wiring.kept(), "/network", places)?;
        let term = |(number, reward): (usize, &crate::document::Reward)| {
            Term::new(&reward.kind, &format!("/reward/{number}"), &wiring.sensors, &scene, places)
        };
        let terms = document.reward.iter().enumerate().map(term).collect::<Result<Vec<_>, _>>()?;
        let groups = Groups::new([(ROBOT.to_owned(), 1)], false);
        let of_steps: Vec<bool> = terms.iter().map(Term::looks_back).collect();
        let ledger = Ledger::new(&document, &of_steps, &groups, places)?;
        let starting = Starting::new(&document, &scene, places)?;
        let segments = scene.robot.segments.iter().enumerate();
        let floating = segments.filter(|(_, segment)| segment.joint.kind == JointKind::Floating);
        let floating = floating.map(|(number, _)| BodyId(number as u16)).collect();
        let (joints, collisions) = (scene.robot.joints().collect(), scene.collisions());
        let agents = Agents::new(document, wiring, ledger, groups);
        Ok((Self { scene, sensors, motors, starting, terms, collisions, joints, floating }, agents))
    }

    /// Gives all noise its streams for an episode.
    pub(crate) fn reseed(&mut self, [sensor, motor]: [Stream; 2], steps: u32) {
        let mut streams = [NoiseStreams::new(sensor, steps), NoiseStreams::new(motor, steps)];
        self.sensors.iter_mut().for_each(|sensor| sensor.reseed(&mut streams[0]));
        self.motors.iter_mut().for_each(|motor| motor.reseed(&mut streams[1]));
    }
}

/// How the world of a document is stepped.
pub(crate) fn options(document: &Document) -> Options {
    let world = &document.world;
    Options {
        time_step: world.time_step,
        substeps: world.substeps,
        gravity: world.gravity,
        sight_height: world.sight_height,
        ..Options::default()
    }
}

/// Refuses what only robots on wheels have.
fn refuse(document: &Document, places: &Places) -> Result<(), Error> {
    let why = "is for robots on wheels; this one has joints";
    if document.world.engine == Engine::Arena {
        let why = "`arena` is for robots on wheels; this one has joints, for `articulated` and `rapier`";
        return Err(places.wrong("/world/engine", why));
    }
    bounded_parts(document, 1, 0, places)?;
    for (index, sensor) in document.sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled) {
        if document.world.engine == Engine::Rapier && matches!(sensor.kind, SensorKind::Camera(_)) {
            let why = "sees nothing in `rapier`; take the engine `articulated`";
            return Err(places.wrong(&format!("/sensors/{index}"), why));
        }
    }
    if !document.robots.is_empty() || document.team.coevolution {
        return Err(places.wrong("/robots", "are for robots on wheels; of those with joints there is one"));
    }
    if document.foraging.is_some() {
        return Err(places.wrong("/foraging", why));
    }
    if let Some(index) = document.episode.ends.iter().position(|ending| *ending == Ending::Death) {
        return Err(places.wrong(&format!("/episode/ends/{index}"), why));
    }
    let robot = document.reward.iter().position(|reward| reward.robot.is_some_and(|robot| robot > 1));
    if let Some(index) = robot {
        return Err(places.wrong(&format!("/reward/{index}/robot"), "there is one robot with joints"));
    }
    Ok(())
}
