//! Scene with the sensors, motors and terms of its robot.

use std::cell::RefCell;

use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::JointKind;
use farsa_lab::Error;
use farsa_physics::articulated::Options;

use crate::check::source::Source;
use crate::document::{Document, Engine};
use crate::formula::compile::Quantity;
use crate::jointed::registered::{self, PartOfSpatial, RegisteredMotor, RegisteredSensor};
use crate::jointed::scene::{ROBOT, Scene};
use crate::jointed::starting::Starting;
use crate::jointed::term::Term;
use crate::part::object::SpatialEnd;
use crate::part::wiring::Wiring;
use crate::parts::agents::Agents;
use crate::parts::conditions::FormulaConditions;
use crate::parts::equipment::Equipment;
use crate::parts::groups::Groups;
use crate::parts::ledger::Ledger;
use crate::parts::network_spec::NetworkSpec;
use crate::parts::part::Part;
use crate::parts::sizes::{MemoryBudget, check_parts};
use crate::parts::trainee::Trainee;

/// A scene with its robot and terms.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    pub(crate) scene: Scene,
    pub(crate) equipment: Equipment<RegisteredSensor, RegisteredMotor>,
    pub(crate) starting: Starting,
    /// Measures of the terms.
    pub(crate) terms: Vec<Term>,
    pub(crate) ends: Vec<Box<dyn SpatialEnd>>,
    /// True if one of them depends on success.
    pub(crate) ends_with_success: bool,
    /// All joints and floating bodies, whose speeds show a failure of the dynamics.
    pub(crate) joints: Vec<JointId>,
    pub(crate) floating: Vec<BodyId>,
}

impl Setup {
    /// Builds the parts of a document.
    pub(crate) fn new(document: Document, source: &Source) -> Result<(Self, Agents), Error> {
        refuse(&document, source)?;
        let mut scene = Scene::new(&document, source)?;
        let mut budget = MemoryBudget::new(source.limits);
        let sensors = document.sensors.iter().map(|sensor| (&sensor.kind, &sensor.wrappers[..], sensor.enabled));
        let wiring = RefCell::new(Wiring::new(&scene.robot));
        let make = |kind, path: &str| {
            registered::sensor(
                kind,
                PartOfSpatial { scene: &scene, wiring: Some(&wiring), rule: None, sensors: &[], path, source },
            )
        };
        let sensors = Part::list("sensors", sensors, make, &mut budget, source)?;
        let motors = document.motors.iter().map(|motor| (&motor.kind, &motor.wrappers[..], motor.enabled));
        let make = |kind, path: &str| {
            registered::motor(
                kind,
                PartOfSpatial { scene: &scene, wiring: Some(&wiring), rule: None, sensors: &[], path, source },
            )
        };
        let motors = Part::list("motors", motors, make, &mut budget, source)?;
        let wiring = wiring.into_inner();
        let warnings = wiring.warnings(&scene.robot);
        scene.robot.actuators = wiring.actuators;
        let equipment = Equipment { sensors, motors };
        let spec = NetworkSpec::new(&document, equipment.channels(), source)?;
        budget.take(spec.values(), "/network", source)?;
        let channels = spec.channel_names();
        let term = |(number, reward): (usize, &crate::document::Reward)| {
            Term::new(&reward.kind, &format!("/reward/{number}"), channels, &scene, source)
        };
        let mut terms = document.reward.iter().enumerate().map(term).collect::<Result<Vec<_>, _>>()?;
        let groups = Groups::new([(ROBOT.to_owned(), 1)], false);
        let mut make = |quantity: &Quantity, path: &str| Term::from_quantity(quantity, path, channels, &scene, source);
        let conditions = FormulaConditions::new(&document, channels, &mut terms, &mut make, source)?;
        let of_steps: Vec<bool> = terms.iter().map(Term::has_state).collect();
        let mut ledger = Ledger::new(&document, &of_steps, (conditions, &[]), &groups, source)?;
        ledger.warnings.extend(warnings);
        let starting = Starting::new(&document, &scene, source)?;
        let segments = scene.robot.segments.iter().enumerate();
        let floating = segments.filter(|(_, segment)| segment.joint.kind == JointKind::Floating);
        let floating = floating.map(|(number, _)| BodyId(number as u16)).collect();
        let ends = document.episode.ends.iter().enumerate().map(|(number, ending)| {
            let path = &format!("/episode/ends/{number}");
            let scene = PartOfSpatial { scene: &scene, wiring: None, rule: None, sensors: &[], path, source };
            registered::end(ending, scene)
        });
        let ends_with_success = source.registry.ends_with_success(&document);
        let (joints, ends) = (scene.robot.joints().collect(), ends.collect::<Result<_, _>>()?);
        let trainee = Trainee::new(&document, &spec, source)?;
        let agents = Agents { trainee, ..Agents::new(document, spec, ledger, groups, &source.registry) };
        Ok((Self { scene, equipment, starting, terms, ends, ends_with_success, joints, floating }, agents))
    }
}

/// Builds the options of the world.
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

/// Rejects parts of robots on wheels.
fn refuse(document: &Document, source: &Source) -> Result<(), Error> {
    let why = "is for robots on wheels; this one has joints";
    if document.world.engine == Engine::Arena {
        let why = "`arena` is for robots on wheels; this one has joints, for `articulated` and `rapier`";
        return Err(source.wrong("/world/engine", why));
    }
    check_parts(document, &[None], source)?;
    if !document.robots.is_empty() || document.team.coevolution {
        return Err(source.wrong("/robots", "are for robots on wheels; of those with joints there is one"));
    }
    if let Some(index) = document.objects.iter().position(|object| object.count.is_some()) {
        return Err(source.wrong(&format!("/objects/{index}/count"), why));
    }
    if document.foraging.is_some() {
        return Err(source.wrong("/foraging", why));
    }
    let robot = document.reward.iter().position(|reward| reward.robot.is_some_and(|robot| robot > 1));
    if let Some(index) = robot {
        return Err(source.wrong(&format!("/reward/{index}/robot"), "there is one robot with joints"));
    }
    Ok(())
}
