//! Checks that bound the memory and the time of a step by the limits of a reader.

use farsa_body::robots::MobileRobot;
use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::Document;
use crate::limits::Limits;

/// Checks the numbers of sensors, motors and rays of all robots, `None` for one with joints.
pub(crate) fn check_parts(document: &Document, robots: &[Option<&MobileRobot>], source: &Source) -> Result<(), Error> {
    let Document { sensors, motors, .. } = document;
    let Limits { parts, rays: most_rays, .. } = source.limits;
    let count = sensors.iter().filter(|part| part.enabled).count() + motors.iter().filter(|part| part.enabled).count();
    let number = robots.len();
    if count.saturating_mul(number) > parts {
        let why = format!("and motors are {count} on each of {number} robots; at most {parts} in all");
        return Err(source.wrong("/sensors", why));
    }
    let mut rays = 0_usize;
    for (index, sensor) in sensors.iter().enumerate().filter(|(_, sensor)| sensor.enabled) {
        let Some(part) = source.registry.sensor(&sensor.kind) else { continue };
        rays = robots.iter().fold(rays, |rays, robot| rays.saturating_add(part.rays(*robot)));
        if rays > most_rays {
            let why =
                format!("and those before it send out {rays} rays from {number} robots; at most {most_rays} in all");
            return Err(source.wrong(&format!("/sensors/{index}"), why));
        }
    }
    Ok(())
}

/// Number of values that the wrappers and networks of all robots may still keep.
pub(crate) struct MemoryBudget {
    left: usize,
    total: usize,
}

impl MemoryBudget {
    pub(crate) fn new(limits: Limits) -> Self {
        let total = limits.network_values.saturating_mul(10);
        Self { left: total, total }
    }

    /// Takes the given number of values for the part at a path.
    pub(crate) fn take(&mut self, values: usize, path: &str, source: &Source) -> Result<(), Error> {
        let total = self.total;
        self.left = self.left.checked_sub(values).ok_or_else(|| {
            let sum = (total - self.left).saturating_add(values);
            source.wrong(path, format!("and what is before it keep {sum} values; at most {total} in all robots"))
        })?;
        Ok(())
    }
}
