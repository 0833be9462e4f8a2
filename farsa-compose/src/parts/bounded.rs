//! The sizes of networks, how many parts robots have, and what all of them keep together.
//!
//! The limits are lower where readers are fuzzed, whose memory is to be bounded by the length of a text: a few letters ask for a
//! large network, or for many robots.

use farsa_lab::Error;

use crate::check::places::Places;
use crate::document::{Document, InfraredModel, SensorKind};
use crate::parts::eye::rays_of;

/// The most parameters of a network, and the most values of its state.
const MOST_VALUES: usize = if cfg!(fuzzing) { 2000 } else { 1_000_000 };
/// The most sensors and motors of all robots together.
const MOST_PARTS: usize = if cfg!(fuzzing) { 500 } else { 100_000 };
/// The most rays that they send out in a step.
const MOST_RAYS: usize = if cfg!(fuzzing) { 4000 } else { 200_000 };

/// The most values that the wrappers and networks of all robots keep together.
const MOST_KEPT: usize = 10 * MOST_VALUES;

/// What is left of the values that the wrappers and networks of all robots may keep.
pub(crate) struct Room {
    left: usize,
}

impl Room {
    /// All of it.
    pub(crate) fn new() -> Self {
        Self { left: MOST_KEPT }
    }

    /// Takes so many values for the part that stands at a path.
    ///
    /// # Errors
    /// [`Error::Setting`] with the number of values that it and what took of the room before it keep.
    pub(crate) fn take(&mut self, values: usize, path: &str, places: &Places) -> Result<(), Error> {
        self.left = self.left.checked_sub(values).ok_or_else(|| {
            let all = (MOST_KEPT - self.left).saturating_add(values);
            places.wrong(path, format!("and what is before it keep {all} values; at most {MOST_KEPT} in all robots"))
        })?;
        Ok(())
    }
}

/// Refuses networks that would fill the memory.
///
/// # Errors
/// [`Error::Other`] with both numbers.
pub(crate) fn bounded(parameters: usize, state: usize) -> Result<(), Error> {
    for (what, count) in [("parameters", parameters), ("values to remember", state)] {
        if count > MOST_VALUES {
            return Err(Error::Other(format!("has {count} {what}; at most {MOST_VALUES} make a network")));
        }
    }
    Ok(())
}

/// Refuses sensors and motors that would fill the memory or take a step too long, of so many robots, whose infrared sensors have so
/// many rays in all.
///
/// # Errors
/// [`Error::Setting`] with the numbers.
pub(crate) fn bounded_parts(document: &Document, robots: usize, infrared: usize, places: &Places) -> Result<(), Error> {
    let Document { sensors, motors, .. } = document;
    let of_each = sensors.iter().filter(|one| one.enabled).count() + motors.iter().filter(|one| one.enabled).count();
    if of_each.saturating_mul(robots) > MOST_PARTS {
        let why = format!("and motors are {of_each} on each of {robots} robots; at most {MOST_PARTS} in all");
        return Err(places.wrong("/sensors", why));
    }
    let mut rays = 0_usize;
    for (index, sensor) in sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled) {
        rays = rays.saturating_add(match sensor.kind {
            SensorKind::Infrared { model: InfraredModel::Rays, .. } => infrared,
            _ => rays_of(&sensor.kind).saturating_mul(robots),
        });
        if rays > MOST_RAYS {
            let why =
                format!("and those before it send out {rays} rays from {robots} robots; at most {MOST_RAYS} in all");
            return Err(places.wrong(&format!("/sensors/{index}"), why));
        }
    }
    Ok(())
}
