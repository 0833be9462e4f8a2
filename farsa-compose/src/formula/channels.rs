//! Values of channels of sensors and motors in formulas.

use farsa_num::Scalar;

/// Names of a robot's sensors and motors, with the first channel of each and the one after the last.
#[derive(Clone, Copy)]
pub(crate) struct ChannelNames<'n> {
    pub(crate) sensors: &'n [(String, [usize; 2])],
    pub(crate) motors: &'n [(String, [usize; 2])],
    /// Names of all inputs.
    pub(crate) inputs: &'n [String],
    /// Names of all outputs.
    pub(crate) outputs: &'n [String],
}

/// Combination of channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Combination {
    Least,
    Largest,
    Mean,
}

/// Channels with their combination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Channels {
    /// True for motors instead of sensors.
    motor: bool,
    range: [usize; 2],
    combination: Combination,
}

impl<'n> ChannelNames<'n> {
    /// Returns the combined channels of a sensor or motor.
    pub(crate) fn part(&self, name: &str, combination: Combination) -> Option<Channels> {
        let lists = [(false, self.sensors), (true, self.motors)].into_iter();
        let mut parts = lists.flat_map(|(motor, parts)| parts.iter().map(move |part| (motor, part)));
        let (motor, (_, range)) = parts.find(|(_, (known, _))| known == name)?;
        Some(Channels { motor, range: *range, combination })
    }

    /// Returns a single channel by its name, or by that of a sensor or motor without others.
    pub(crate) fn channel(&self, name: &str) -> Option<Channels> {
        let of_part = self.part(name, Combination::Largest).filter(|channels| channels.count() == 1);
        let named = || {
            let lists = [(false, self.inputs), (true, self.outputs)].into_iter();
            let mut channels = lists.map(|(motor, names)| (motor, names.iter().position(|known| known == name)));
            channels.find_map(|(motor, place)| {
                let place = place?;
                Some(Channels { motor, range: [place, place + 1], combination: Combination::Largest })
            })
        };
        of_part.or_else(named)
    }

    /// Lists the names of sensors, motors and channels.
    pub(crate) fn all(self) -> impl Iterator<Item = &'n str> {
        let parts = self.sensors.iter().chain(self.motors).map(|(name, _)| name.as_str());
        parts.chain(self.inputs.iter().chain(self.outputs).map(String::as_str))
    }
}

impl Channels {
    /// Gets the number of channels.
    pub(crate) fn count(&self) -> usize {
        self.range[1] - self.range[0]
    }

    /// Computes the value from the sensor and motor values of a robot.
    pub(crate) fn value(&self, sensors: &[f32], motors: &[f32]) -> f64 {
        let [first, end] = self.range;
        let channels = if self.motor { motors } else { sensors }.get(first..end).unwrap_or_default();
        let values = channels.iter().map(|x| f64::from(*x));
        match self.combination {
            Combination::Least => values.reduce(Scalar::min).unwrap_or(0.0),
            Combination::Largest => values.reduce(Scalar::max).unwrap_or(0.0),
            Combination::Mean => values.sum::<f64>() / channels.len().max(1) as f64,
        }
    }
}
