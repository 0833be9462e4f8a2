//! `farsa export`: sources and files.

use std::path::Path;

use crate::command::arguments::export::{
    DataFormat, ExportControllerArgs, ExportGenotypeArgs, ExportRobotArgs, ExportStartsArgs, ExportWhat,
};
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::export::files::{self, Exported};
use crate::run::laboratory::FILE;

impl Invocation<'_, '_> {
    /// Returns the exported content with its paths, if it has any.
    pub(super) fn exported(&self, what: ExportWhat) -> Result<Exported, Error> {
        match what {
            ExportWhat::Robot(args) => Ok(Exported::of(self.exported_robot(&args)?, args.out)),
            ExportWhat::Controller(ExportControllerArgs { directory, population, format, out }) => {
                let (directory, plan) = self.existing(&directory)?;
                files::controller(&plan, &directory, population.as_deref(), format, out)
            }
            ExportWhat::Genotype(ExportGenotypeArgs { directory, population, out }) => {
                let (directory, plan) = self.existing(&directory)?;
                Ok(Exported::of(files::genotype(&plan, &directory, population.as_deref())?, out))
            }
            ExportWhat::Starts(ExportStartsArgs { directory, trials, seed, format: DataFormat::Json, out }) => {
                let (_, plan) = self.existing(&directory)?;
                Ok(Exported::of(files::starts(&plan, trials as usize, seed)?, out))
            }
        }
    }

    /// Returns the robot of an experiment or of a run. The name of an experiment takes precedence over a directory.
    fn exported_robot(&self, args: &ExportRobotArgs) -> Result<String, Error> {
        let ExportRobotArgs { experiment: name, population, variant, format, .. } = args;
        let (path, found) = (Path::new(name), self.find(name));
        let is_path = path.is_dir() || (path.components().count() > 1 && !name.ends_with(FILE));
        if found.is_err() && is_path {
            let (directory, mut plan) = self.existing(path)?;
            if let Some(condition) = &variant.condition {
                return Err(Error::Usage(format!("--condition {condition}: a run has a condition already")));
            }
            variant.apply(&mut plan)?;
            return files::robot(&plan, Some((&directory, population.as_deref())), *format);
        }
        let plan = variant.plan(found?)?;
        match population {
            Some(population) => {
                Err(Error::Usage(format!("--population {population}: for the directory of a run, and {name} is none")))
            }
            None => files::robot(&plan, None, *format),
        }
    }
}
