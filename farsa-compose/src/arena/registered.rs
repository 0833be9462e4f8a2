//! Registered parts.

use farsa_body::ports::{ActuatorId, BodyId, Channels, JointId, Motor, PairId, Sensor};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_lab::Error;

use crate::arena::ArenaWorld;
use crate::arena::scene::{Scene, Thing};
use crate::check::completed::builder;
use crate::check::source::Source;
use crate::part::PartScene;
use crate::part::definition::{Build, Given};
use crate::part::object::{PlanarMotor, PlanarSensor, PlanarStart, PlanarTerm};
use crate::part::scene::{Area, Surroundings};

/// A registered sensor.
#[derive(Clone, Debug)]
pub(crate) struct RegisteredSensor(pub(crate) Box<dyn PlanarSensor>);

impl Channels for RegisteredSensor {
    fn channels(&self) -> usize {
        self.0.channels()
    }

    fn reset(&mut self) {
        self.0.reset();
    }
}

impl<W: ArenaWorld> Sensor<W> for RegisteredSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        world.sense(&mut *self.0, out);
    }
}

/// A registered motor.
#[derive(Clone, Debug)]
pub(crate) struct RegisteredMotor(pub(crate) Box<dyn PlanarMotor>);

impl Channels for RegisteredMotor {
    fn channels(&self) -> usize {
        self.0.channels()
    }

    fn reset(&mut self) {
        self.0.reset();
    }
}

impl<W: ArenaWorld> Motor<W> for RegisteredMotor {
    fn drive(&mut self, y: &[f32], world: &mut W) {
        world.drive(&mut *self.0, y);
    }
}

/// Scene of a part of a robot on wheels.
#[derive(Clone, Copy)]
pub(crate) struct PartOfPlanar<'s> {
    pub(crate) scene: &'s Scene,
    pub(crate) robot: usize,
    /// Path of the part in the document.
    pub(crate) path: &'s str,
    pub(crate) source: &'s Source,
}

impl Surroundings for PartOfPlanar<'_> {
    fn error(&self, why: String) -> Error {
        self.source.wrong(self.path, why)
    }

    fn body(&self, name: Option<&str>) -> Result<BodyId, Error> {
        let named = name.map(|name| self.error(format!("names the body `{name}` of a robot on wheels")));
        named.map_or_else(|| Ok(self.scene.parts(self.robot).body), Err)
    }

    fn thing(&self, name: &str) -> Result<BodyId, Error> {
        self.scene.body(name, self.path, self.source)
    }

    fn area(&self, name: &str) -> Result<Area, Error> {
        match self.scene.thing(name, self.path, self.source)? {
            Thing::Area(area) => Ok(area),
            _ => Err(self.error(format!("`{name}` is no disc or rectangle"))),
        }
    }

    fn robots(&self) -> Vec<BodyId> {
        (0..self.scene.robots.len()).map(|robot| self.scene.parts(robot).body).collect()
    }

    fn joints(&self, names: &[String]) -> Result<Vec<JointId>, Error> {
        let parts = self.scene.parts(self.robot);
        if names.is_empty() {
            return Ok(parts.wheels.to_vec());
        }
        names.iter().map(|name| wheel(name, &parts, self.path, self.source)).collect()
    }

    fn actuators(&self, joints: &[String]) -> Result<Vec<ActuatorId>, Error> {
        let parts = self.scene.parts(self.robot);
        let motor = |joint: JointId| parts.motors[usize::from(joint == parts.wheels[1])];
        Ok(self.joints(joints)?.into_iter().map(motor).collect())
    }

    fn contacts(&self, bodies: &[String], with: Option<&str>) -> Result<Vec<PairId>, Error> {
        if bodies.is_empty() && with.is_none() {
            return Ok(vec![PairId(self.scene.parts(self.robot).body.0)]);
        }
        Err(self.error("names contacts of a robot on wheels, which has one pair for all".into()))
    }

    fn mobile_robot(&self) -> Option<&MobileRobot> {
        self.scene.robots.get(self.robot)
    }
}

/// Returns a wheel by name.
pub(crate) fn wheel(name: &str, parts: &MobileParts, path: &str, source: &Source) -> Result<JointId, Error> {
    const WHEELS: [&str; 2] = ["left-wheel", "right-wheel"];
    Ok(parts.wheels[source.position(WHEELS.into_iter(), ("joint", name), path)?])
}

/// Reason against a part of the other robots.
const OTHER: &str = "is for robots with joints; this one is on wheels";

/// Builds a registered sensor in a scene.
pub(crate) fn sensor(kind: &str, keys: &Given, scene: PartOfPlanar<'_>) -> Result<RegisteredSensor, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Sensor((build, _), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map(RegisteredSensor).map_err(|error| source.at(path, error))
}

/// Builds a registered motor in a scene.
pub(crate) fn motor(kind: &str, keys: &Given, scene: PartOfPlanar<'_>) -> Result<RegisteredMotor, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Motor((build, _), _) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map(RegisteredMotor).map_err(|error| source.at(path, error))
}

/// Builds a registered term in a scene.
pub(crate) fn term(kind: &str, keys: &Given, scene: PartOfPlanar<'_>) -> Result<Box<dyn PlanarTerm>, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Term((build, _)) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}

/// Builds a registered placement in a scene.
pub(crate) fn start(kind: &str, keys: &Given, scene: PartOfPlanar<'_>) -> Result<Box<dyn PlanarStart>, Error> {
    let (path, source) = (scene.path, scene.source);
    let build = builder((kind, path, source), OTHER, |build| match build {
        Build::Start((build, _)) => Some(*build),
        _ => None,
    });
    let build = build?;
    build(keys, &PartScene::new(&scene)).map_err(|error| source.at(path, error))
}
