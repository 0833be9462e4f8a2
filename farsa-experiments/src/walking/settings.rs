//! Settings that are common to all experiments with walkers, and functions to run and record a walk.

use farsa_lab::advanced::ENGINE;
use farsa_lab::{Error, Note, Outcome, Setting, Settings};
use farsa_models::mjcf::MjcfOptions;

use crate::walking::episode::{Walk, WalkerEpisode};
use crate::walking::gait::End;
use crate::walking::walker::Walker;
use crate::worlds::Engine;

/// The surroundings of the settings. The rules are those of `plain`.
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

/// Least ratio in rapier of the frequency of a contact and that of the whole walker on the ground's stiffness.
///
/// rapier counts it for the mass that a foot alone resists a blow with, a fraction of the walker's on a leaning light
/// leg. At 1 the walker of `passive-walker` falls after four steps, at 8 it walks with steps 2 % short.
#[cfg(feature = "rapier")]
const HARDER: f64 = 64.0;

/// Options of rapier for a walk, with the given numbers of sweeps for places and for speeds.
///
/// A sweep leaves `1 - foot / (hip * (sin(2 angle) / 2)^2)` of the remaining blow on a leaning leg, for masses of light
/// feet and hip. The next step returns the rest.
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

/// The walker with the contacts of the settings.
pub(crate) fn on_contacts(settings: &Settings, walker: Walker) -> Result<Walker, Error> {
    Ok(Walker {
        friction: settings.number("contact.friction")?,
        stiffness: settings.number("contact.stiffness")?,
        damping_ratio: settings.number("contact.damping_ratio")?,
        ..walker
    })
}

/// Options of a MuJoCo model of a walker.
pub(crate) fn mjcf_options(walk: &Walk) -> MjcfOptions {
    let gravity = Walker::gravity(walk.gravity, walk.slope);
    MjcfOptions { time_step: walk.time_step, gravity, ..MjcfOptions::default() }
}

/// The outcome of a walk that has ended. Success is ten strides, twenty steps, without a fall.
pub(crate) fn outcome(episode: &WalkerEpisode) -> Outcome {
    let gait = episode.gait();
    let end = gait.end().map_or("time", End::name);
    Outcome {
        terms: vec![episode.distance()],
        steps: gait.ticks(),
        success: gait.end().is_none() && gait.steps() >= 20,
        notes: vec![("end", Note::from(end)), ("steps made", Note::from(f64::from(gait.steps())))],
        ..Outcome::default()
    }
}
