//! The worlds in which experiments can be simulated.

use std::str::FromStr;

use farsa_lab::Error;

/// The physics engine of experiments that support several engines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Engine {
    /// Articulated world of `farsa_physics::articulated`.
    #[default]
    Articulated,
    /// World of `farsa_physics::rapier`. It is only available if the feature `rapier` is enabled.
    Rapier,
}

impl Engine {
    /// The names on the command line.
    pub(crate) const NAMES: [&'static str; 2] = ["articulated", "rapier"];

    /// Returns the name used on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Why a program without the feature cannot run in this world.
    #[cfg(not(feature = "rapier"))]
    pub(crate) fn missing(self) -> Error {
        missing(self.name())
    }
}

/// Why a program that was built without the feature of a world's name cannot run in it.
#[cfg(not(feature = "rapier"))]
pub(crate) fn missing(name: &str) -> Error {
    Error::Usage(format!(
        "world `{name}`: this program was built without it; build it with `--features {name}`, for example \
         `cargo run --release --features farsa-experiments/{name} --bin farsa`"
    ))
}

impl FromStr for Engine {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let engine = [Self::Articulated, Self::Rapier].into_iter().find(|engine| engine.name() == name);
        engine.ok_or_else(|| Error::unknown("", "world", name, Self::NAMES))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(not(feature = "rapier"))]
    use farsa_lab::advanced::{ENGINE, Value};
    #[cfg(not(feature = "rapier"))]
    use farsa_lab::{Experiment, Settings};

    #[test]
    fn worlds_have_names() {
        for engine in [Engine::Articulated, Engine::Rapier] {
            assert_eq!(engine.name().parse::<Engine>().unwrap(), engine);
        }
        assert_eq!(
            "rapir".parse::<Engine>().unwrap_err().to_string(),
            "unknown world `rapir`; the nearest is `rapier`"
        );
    }

    #[cfg(not(feature = "rapier"))]
    #[test]
    fn a_program_without_rapier_says_how_to_get_it() {
        for experiment in [&crate::reach_grasp_lift::ReachGraspLift as &dyn Experiment, &crate::DISCRIMINATION] {
            let condition = experiment.conditions()[0];
            let mut settings = Settings::new(experiment.settings(condition)).unwrap();
            settings.set("", ENGINE, Value::Word("rapier".into())).unwrap();
            let error = experiment.prepare(condition, &settings).err().unwrap();
            assert!(error.to_string().contains("--features rapier") && error.exit_code() == 2, "{error}");
        }
    }
}
