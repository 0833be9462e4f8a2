//! Choice of world, where an experiment offers one.

use crate::error::Error;
use crate::experiment::settings::Value;
use crate::run::plan::Plan;

/// Key of the setting that `--world` changes.
pub const ENGINE: &str = "world.engine";

/// Chooses the world of a plan, if one is named.
///
/// # Errors
/// [`Error::Usage`] for an experiment without a choice, [`Error::Setting`] for an unknown world.
pub(crate) fn choose(plan: &mut Plan<'_>, world: Option<&str>) -> Result<(), Error> {
    let Some(world) = world else { return Ok(()) };
    if !plan.settings.has(ENGINE) {
        return Err(Error::Usage(format!("--world {world}: {} has one world only", plan.experiment.name())));
    }
    plan.settings.set("--world", ENGINE, Value::Word(world.into()))
}

/// Chooses another world for the trials of a run, and returns whether it differs from the run's.
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
    use crate::experiment::evaluator::Evaluator;
    use crate::experiment::settings::{Setting, Settings};
    use crate::run::experiment::Experiment;

    /// An experiment with the given number of worlds.
    struct Toy(&'static [&'static str]);

    impl Experiment for Toy {
        fn name(&self) -> &'static str {
            "toy"
        }
        fn summary(&self) -> &'static str {
            "nothing"
        }
        fn settings(&self, _: &str) -> Vec<Setting> {
            self.0.first().map(|first| Setting::word(ENGINE, first, self.0)).into_iter().collect()
        }
        fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
            Err(Error::Other(settings.word(ENGINE)?.into()))
        }
    }

    #[test]
    fn a_plan_is_moved_to_another_world() {
        let toy = Toy(&["articulated", "rapier"]);
        let mut plan = Plan::new(&toy, None, "").unwrap();
        let before = plan.identity().unwrap();
        choose(&mut plan, None).unwrap();
        assert_eq!(plan.identity().unwrap(), before);
        choose(&mut plan, Some("rapier")).unwrap();
        assert_ne!(plan.identity().unwrap(), before);
        assert_eq!(plan.settings.word(ENGINE).unwrap(), "rapier");
        assert!(!visit(&mut plan, Some("rapier")).unwrap() && plan.elsewhere.is_none());
        let run = plan.identity().unwrap();
        assert!(visit(&mut plan, Some("articulated")).unwrap());
        assert_eq!(plan.evaluator().err().unwrap().to_string(), "articulated", "it is evaluated there");
        assert_eq!(plan.identity().unwrap(), run, "it is the same run");
        assert!(!visit(&mut plan, None).unwrap() && plan.elsewhere.is_none());
        let error = choose(&mut plan, Some("rapir")).unwrap_err();
        assert!(error.to_string().starts_with("--world: `world.engine`"), "{error}");
        let none = Toy(&[]);
        let mut other = Plan::new(&none, None, "").unwrap();
        let error = choose(&mut other, Some("rapier")).unwrap_err().to_string();
        assert_eq!(error, "--world rapier: toy has one world only");
    }
}
