//! Which world an experiment is lived in, where there is a choice.

use std::str::FromStr;

use crate::error::Error;
use crate::plan::Plan;
use crate::settings::Value;

/// The setting that `--world` is short for.
pub(crate) const ENGINE: &str = "world.engine";

/// What moves the bodies of an experiment that has a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Engine {
    /// Our articulated world, `farsa_physics::articulated`.
    #[default]
    Articulated,
    /// rapier, `farsa_physics::rapier`; only where the crate was built with the feature of that name.
    Rapier,
}

impl Engine {
    /// The names on the command line.
    pub(crate) const NAMES: [&'static str; 2] = ["articulated", "rapier"];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Why a program without the feature cannot live in this world.
    #[cfg(not(feature = "rapier"))]
    pub(crate) fn missing(self) -> Error {
        missing(self.name())
    }
}

/// Why a program that was built without the feature of a world's name cannot live in it.
#[cfg(not(feature = "rapier"))]
pub(crate) fn missing(name: &str) -> Error {
    Error::Usage(format!(
        "world `{name}`: this program was built without it; build it with `--features {name}`, for example \
         `cargo run --release --features farsa-experiments/{name} --bin farsa`"
    ))
}

/// What moves the wheeled robots of an experiment that has a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum PlanarEngine {
    /// Our kinematic world, `farsa_physics::arena`: wheels do exactly what they are told.
    #[default]
    Arena,
    /// rapier, `farsa_physics::rapier::ArenaWorld`: rigid bodies on driven wheels; only where the crate was built with the
    /// feature of that name.
    Rapier,
}

impl PlanarEngine {
    /// The names on the command line.
    pub(crate) const NAMES: [&'static str; 2] = ["arena", "rapier"];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

impl FromStr for PlanarEngine {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let known = [Self::Arena, Self::Rapier].into_iter().find(|engine| engine.name() == name);
        known.ok_or_else(|| Error::unknown("", "world", name, Self::NAMES))
    }
}

impl FromStr for Engine {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self, Error> {
        let known = [Self::Articulated, Self::Rapier].into_iter().find(|engine| engine.name() == name);
        known.ok_or_else(|| Error::unknown("", "world", name, Self::NAMES))
    }
}

/// Chooses the world of a plan, if one was asked for.
///
/// # Errors
/// [`Error::Usage`] for an experiment that has no choice, [`Error::Setting`] for a world that it does not have.
pub(crate) fn choose(plan: &mut Plan<'_>, world: Option<&str>) -> Result<(), Error> {
    let Some(world) = world else { return Ok(()) };
    if plan.settings.get(ENGINE).is_err() {
        return Err(Error::Usage(format!("--world {world}: {} has one world only", plan.experiment.name())));
    }
    plan.settings.set("--world", ENGINE, Value::Word(world.into()))
}

/// Lets the lives of a run be lived in another world than the run's, and says whether it is another.
///
/// # Errors
/// As [`choose`].
pub(crate) fn visit(plan: &mut Plan<'_>, world: Option<&str>) -> Result<bool, Error> {
    let own = plan.settings.clone();
    choose(plan, world)?;
    let there = std::mem::replace(&mut plan.settings, own);
    let other = there != plan.settings;
    plan.elsewhere = other.then_some(there);
    Ok(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Braitenberg, ReachGraspLift};

    #[test]
    fn worlds_have_names() {
        for engine in [Engine::Articulated, Engine::Rapier] {
            assert_eq!(engine.name().parse::<Engine>().unwrap(), engine);
        }
        for engine in [PlanarEngine::Arena, PlanarEngine::Rapier] {
            assert_eq!(engine.name().parse::<PlanarEngine>().unwrap(), engine);
        }
        assert_eq!(
            "rapir".parse::<Engine>().unwrap_err().to_string(),
            "unknown world `rapir`; the nearest is `rapier`"
        );
    }

    #[test]
    fn a_plan_is_moved_to_another_world() {
        let mut plan = Plan::new(&ReachGraspLift, None, "").unwrap();
        let before = plan.identity().unwrap();
        choose(&mut plan, None).unwrap();
        assert_eq!(plan.identity().unwrap(), before);
        choose(&mut plan, Some("rapier")).unwrap();
        assert_ne!(plan.identity().unwrap(), before);
        assert_eq!(plan.settings.word(ENGINE).unwrap(), "rapier");
        assert!(!visit(&mut plan, Some("rapier")).unwrap() && plan.elsewhere.is_none());
        let run = plan.identity().unwrap();
        assert!(visit(&mut plan, Some("articulated")).unwrap() && plan.setup().is_ok());
        assert_eq!(plan.identity().unwrap(), run, "it is the same run");
        assert!(!visit(&mut plan, None).unwrap() && plan.elsewhere.is_none());
        let error = choose(&mut plan, Some("rapir")).unwrap_err();
        assert!(error.to_string().starts_with("--world: `world.engine`"), "{error}");
        let mut other = Plan::new(&Braitenberg, None, "").unwrap();
        let error = choose(&mut other, Some("rapier")).unwrap_err().to_string();
        assert_eq!(error, "--world rapier: braitenberg has one world only");
    }

    #[cfg(not(feature = "rapier"))]
    #[test]
    fn a_program_without_rapier_says_how_to_get_it() {
        for experiment in [&ReachGraspLift as &dyn crate::Experiment, &crate::Discrimination] {
            let mut plan = Plan::new(experiment, None, "").unwrap();
            choose(&mut plan, Some("rapier")).unwrap();
            let error = plan.setup().err().unwrap();
            assert!(error.to_string().contains("--features rapier") && error.exit_code() == 2, "{error}");
        }
    }
}
