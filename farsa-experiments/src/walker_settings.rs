//! The settings that all experiments with walkers have, and how a walk is lived and told.

use farsa_body::{Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, World};
use farsa_models::MjcfOptions;

use crate::engine::{ENGINE, Engine};
use crate::error::Error;
use crate::experiment::{Note, Outcome, Tape};
use crate::gait::End;
use crate::settings::{Setting, Settings};
use crate::walker::Walker;
use crate::walker_life::{Walk, WalkerLife};
use crate::walker_stage::tell;

/// The surroundings that settings ask for; the rules are those of `plain`.
pub(crate) fn walk(settings: &Settings, plain: Walk) -> Result<Walk, Error> {
    Ok(Walk {
        slope: settings.number("world.slope")?,
        gravity: settings.number("world.gravity")?,
        time_step: settings.number("world.time_step")?,
        steps: settings.count("trial.steps")? as u32,
        noise: settings.number("start.noise")?,
        ..plain
    })
}

/// The setting of the world.
pub(crate) fn engine() -> Setting {
    Setting::word(ENGINE, Engine::default().name(), &Engine::NAMES)
        .doc("Whose dynamics: ours, or rapier's, where a foot is as soft as rapier makes of a frequency and a damping ratio.")
}

/// How many times as high as the whole walker's on the ground's stiffness the frequency of a contact must be in rapier.
///
/// rapier counts it for the mass that a foot alone resists a blow with, a fraction of the walker's on a leaning light leg. At 1 the
/// walker of `passive-walker` falls after four steps, at 8 it walks with steps 2 % short.
#[cfg(feature = "rapier")]
const HARDER: f64 = 64.0;

/// How rapier is stepped for a walk, with so many sweeps for places and for speeds.
///
/// A sweep leaves `1 - foot / (hip * (sin(2 angle) / 2)^2)` of what the blow on a leaning leg has still to take, for masses of light feet and
/// hip; what a step leaves, the next gives back.
#[cfg(feature = "rapier")]
pub(crate) fn rapier_options(
    walk: &Walk,
    walker: &Walker,
    substeps: u32,
    sweeps: u32,
) -> farsa_physics::rapier::Options {
    farsa_physics::rapier::Options {
        time_step: walk.time_step,
        substeps,
        sweeps,
        speed_sweeps: sweeps,
        gravity: Walker::gravity(walk.gravity, walk.slope),
        length_unit: 0.1 * walker.legs[0].length,
        contact_frequency: HARDER * farsa_num::Scalar::sqrt(walker.stiffness / walker.mass()) / core::f64::consts::TAU,
        contact_damping: walker.damping_ratio,
        ..farsa_physics::rapier::Options::default()
    }
}

/// The walker with the contacts that settings ask for.
pub(crate) fn on_contacts(settings: &Settings, walker: Walker) -> Result<Walker, Error> {
    Ok(Walker {
        friction: settings.number("contact.friction")?,
        stiffness: settings.number("contact.stiffness")?,
        damping_ratio: settings.number("contact.damping_ratio")?,
        ..walker
    })
}

/// What a MuJoCo model of a walker says beside the robot.
pub(crate) fn mjcf_options(walk: &Walk) -> MjcfOptions {
    let gravity = Walker::gravity(walk.gravity, walk.slope);
    MjcfOptions { time_step: walk.time_step, gravity, ..MjcfOptions::default() }
}

/// Lives a walk that has been started to its end; success is ten strides, twenty steps, without a fall.
pub(crate) fn live_to_the_end<W>(life: &mut WalkerLife, world: &mut W, tape: &mut Tape<'_>) -> Outcome
where
    W: World
        + Kinematics
        + Joints
        + Contacts
        + Actuated
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>,
{
    let distance = loop {
        life.act(world);
        world.step();
        let end = life.judge(world);
        if let Some(recorder) = tape.recorder() {
            tell(life, world, recorder);
        }
        if let Some(distance) = end {
            break distance;
        }
    };
    let gait = life.gait();
    let end = gait.end().map_or("time", End::name);
    Outcome {
        terms: vec![distance],
        steps: gait.ticks(),
        success: gait.end().is_none() && gait.steps() >= 20,
        notes: vec![("end", Note::from(end)), ("steps made", Note::from(f64::from(gait.steps())))],
    }
}

/// The mean of the trials' terms, of which a walk has one.
pub(crate) fn mean(trials: &[Outcome]) -> f64 {
    trials.iter().flat_map(|outcome| &outcome.terms).sum::<f64>() / trials.len().max(1) as f64
}
