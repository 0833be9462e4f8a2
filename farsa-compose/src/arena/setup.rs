//! Scene with the sensors, motors and terms of its robots.

use crate::arena::ArenaWorld;
use farsa_body::ports::{BodyId, Channels as _};
use farsa_body::sensors::infrared::InfraredDrawing;
use farsa_lab::Error;

use crate::arena::field::Field;
use crate::arena::registered::{self, PartOfPlanar, RegisteredMotor, RegisteredSensor};
use crate::arena::scene::{Scene, Thing};
use crate::arena::starting::Starting;
use crate::arena::term::Term;
use crate::check::source::Source;
use crate::document::{Document, Reward, TestProtocol};
use crate::formula::compile::Quantity;
use crate::part::Area;
use crate::part::files::Files;
use crate::part::object::PlanarEnd;
use crate::parts::agents::Agents;
use crate::parts::conditions::FormulaConditions;
use crate::parts::equipment::Equipment;
use crate::parts::ledger::Ledger;
use crate::parts::network_spec::{NetworkSpec, Spans};
use crate::parts::part::Part;
use crate::parts::sizes::{MemoryBudget, check_parts};
use crate::parts::trainee::Trainee;

/// A scene with its robots and terms.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    pub(crate) scene: Scene,
    /// Sensors and motors of each robot.
    pub(crate) members: Vec<Member>,
    /// Nest and field, if any.
    pub(crate) foraging: Option<(BodyId, Field)>,
    pub(crate) starting: Starting,
    /// Measures of the terms.
    pub(crate) terms: Vec<Term>,
    pub(crate) ends: Vec<Box<dyn PlanarEnd>>,
    /// True if one of them depends on success.
    pub(crate) ends_with_success: bool,
}

/// Sensors and motors of a robot.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) parts: farsa_body::robots::MobileParts,
    pub(crate) equipment: Equipment<RegisteredSensor, RegisteredMotor>,
    /// Infrared sensors in recordings, with their number among the sensors and their first channel.
    pub(crate) drawn: Vec<([usize; 2], InfraredDrawing)>,
}

impl Member {
    /// Stops all motors.
    pub(crate) fn rest<W: ArenaWorld>(&mut self, spans: &Spans, y: &mut [f32], world: &mut W) {
        for (motor, (_, [first, end])) in self.equipment.motors.iter_mut().zip(spans) {
            motor.kind_mut().rest(&mut y[*first..*end], world);
        }
    }
}

impl Setup {
    /// Builds the parts of a document.
    pub(crate) fn new(document: Document, source: &Source) -> Result<(Self, Agents), Error> {
        let scene = Scene::new(&document, source)?;
        if document.robot.is_none() && document.protocols.contains(&TestProtocol::TeamSize) {
            return Err(source.wrong("/protocols", "has `team-size`, which is for one group of robots"));
        }
        check_parts(&document, &scene.robots.iter().map(Some).collect::<Vec<_>>(), source)?;
        let (files, mut budget) = (Files::new(&document.files), MemoryBudget::new(source.limits));
        let mut members = Vec::new();
        for robot in 0..scene.robots.len() {
            let sensors = document.sensors.iter().map(|sensor| (&sensor.kind, &sensor.wrappers[..], sensor.enabled));
            let make = |kind, path: &str| {
                registered::sensor(
                    kind,
                    PartOfPlanar { scene: &scene, robot, files: Some(&files), rule: None, sensors: &[], path, source },
                )
            };
            let sensors = Part::list("sensors", sensors, make, &mut budget, source)?;
            let motors = document.motors.iter().map(|motor| (&motor.kind, &motor.wrappers[..], motor.enabled));
            let make = |kind, path: &str| {
                registered::motor(
                    kind,
                    PartOfPlanar { scene: &scene, robot, files: Some(&files), rule: None, sensors: &[], path, source },
                )
            };
            let motors = Part::list("motors", motors, make, &mut budget, source)?;
            let drawn = drawn(&sensors);
            members.push(Member { parts: scene.parts(robot), equipment: Equipment { sensors, motors }, drawn });
        }
        alike(&members, &scene, &document, source)?;
        let spec = NetworkSpec::new(&document, members[0].equipment.channels(), source)?;
        budget.take(spec.values().saturating_mul(members.len()), "/network", source)?;
        let channels = spec.channel_names();
        let term = |(number, reward): (usize, &Reward)| {
            Term::new(&reward.kind, &format!("/reward/{number}"), channels, &scene, source)
        };
        let mut terms = document.reward.iter().enumerate().map(term).collect::<Result<Vec<_>, _>>()?;
        let mut make =
            |quantity: &Quantity, path: &str| Ok((Term::from_quantity(quantity, path, channels, &scene, source)?, 0));
        let conditions = FormulaConditions::new(&document, channels, &mut terms, &mut make, source)?;
        let of_steps: Vec<bool> = terms.iter().map(Term::has_state).collect();
        let ledger = {
            let abouts: Vec<_> = terms[document.reward.len()..].iter().map(Term::about).collect();
            Ledger::new(&document, &of_steps, (conditions, &abouts), &scene.groups, source)?
        };
        let foraging = foraging(&document, &scene, source)?;
        let ends = document.episode.ends.iter().enumerate().map(|(number, ending)| {
            let path = &format!("/episode/ends/{number}");
            let scene = PartOfPlanar { scene: &scene, robot: 0, files: None, rule: None, sensors: &[], path, source };
            registered::end(ending, scene)
        });
        let ends = ends.collect::<Result<_, _>>()?;
        let ends_with_success = source.registry.ends_with_success(&document);
        let starting = Starting::new(&document, &scene, source)?;
        let trainee = Trainee::new(&document, &spec, source)?;
        let agents = Agents { trainee, ..Agents::new(document, spec, ledger, scene.groups.clone(), &source.registry) };
        Ok((Self { scene, members, foraging, starting, terms, ends, ends_with_success }, agents))
    }
}

/// Rejects sensors with other numbers of channels on other robots, because all robots have one network.
fn alike(members: &[Member], scene: &Scene, document: &Document, source: &Source) -> Result<(), Error> {
    let enabled = document.sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled);
    for (place, (index, _)) in enabled.enumerate() {
        let first = members[0].equipment.sensors[place].channels();
        let other = |robot: &usize| members[*robot].equipment.sensors[place].channels() != first;
        if let Some(robot) = (1..members.len()).find(other) {
            let [one, two] = [0, robot].map(|robot| scene.groups.of(robot));
            let channels = members[robot].equipment.sensors[place].channels();
            let why = format!("has {first} channels on `{one}` and {channels} on `{two}`: one network has to fit both");
            return Err(source.wrong(&format!("/sensors/{index}"), why));
        }
    }
    Ok(())
}

/// Builds the nest and the field of a document.
fn foraging(document: &Document, scene: &Scene, source: &Source) -> Result<Option<(BodyId, Field)>, Error> {
    let Some(foraging) = &document.foraging else { return Ok(None) };
    let path = "/foraging/nest";
    match scene.thing(&foraging.nest, path, source)? {
        Thing::Area(Area { body, half: [radius, _], disc: true }) => {
            let cells = foraging.cells as usize;
            Ok(Some((body, Field::new(scene.size, cells, foraging.cost, radius, scene.robots.len()))))
        }
        _ => Err(source.wrong(path, format!("`{}` is no disc", foraging.nest))),
    }
}

/// Returns the infrared sensors of a robot for recordings, with the number and the first channel of each.
fn drawn(sensors: &[Part<RegisteredSensor>]) -> Vec<([usize; 2], InfraredDrawing)> {
    let mut end = 0;
    let places = sensors.iter().enumerate().map(|(number, sensor)| {
        let first = end;
        end += sensor.channels();
        (sensor.kind().infrared(), [number, first])
    });
    places.filter_map(|(infrared, place)| Some((place, infrared?.drawing.clone()))).collect()
}
