//! `farsa import`: genotypes and configurations of the original FARSA.

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::command::arguments::genotypes::ImportArgs;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::escaped::OneLine;
use crate::evaluation::import;
use crate::json::pretty;
use crate::run::laboratory::{FILE, MAX_BYTES};
use crate::run::{ImportedFile, LeftOut};
use crate::store::bounded;
use crate::store::replace::create_results;
use crate::strategy::settings::POPULATION;

/// Suffixes of configuration files.
const CONFIGURATIONS: [&str; 2] = ["ini", "conf"];
/// Most remarks that are listed.
const MAX_REMARKS: usize = 1000;

/// Result of importing a configuration.
#[derive(Debug, Serialize)]
struct Summary<'i> {
    file: String,
    /// Differences from the original.
    left: &'i [LeftOut],
    /// Remarks without effect on results.
    without_effect: &'i [LeftOut],
    /// Number of further remarks.
    more_left: usize,
    more_without_effect: usize,
}

impl Invocation<'_, '_> {
    /// Imports genotypes or a configuration.
    pub(super) fn import(&self, args: &ImportArgs) -> Result<(), Error> {
        match &*args.files {
            [path] if args.experiment.is_none() && is_configuration(path) => self.import_configuration(args, path),
            files => {
                if let Some(path) = files.iter().find(|path| has_ending(path)) {
                    let path = path.display();
                    let why = "is a configuration, which stands alone and has no --experiment";
                    return Err(Error::Usage(format!("{path}: {why}")));
                }
                self.import_genotypes(args)
            }
        }
    }

    fn import_genotypes(&self, args: &ImportArgs) -> Result<(), Error> {
        let wanted = |what: &str| Error::Usage(format!("genotypes are imported with {what}"));
        let name = args.experiment.as_ref().ok_or_else(|| wanted("--experiment NAME"))?;
        let out = args.out.as_ref().ok_or_else(|| wanted("--out DIR"))?;
        if args.strict {
            return Err(Error::Usage("--strict is for configurations".into()));
        }
        let mut plan = args.variant.plan(self.find(name)?)?;
        plan.seed = args.seed.unwrap_or(1);
        let summary = import::import(plan, &args.files, args.variant.set(POPULATION), out)?;
        self.summary(args.json, &format!("{}\n", summary.text()), &|| pretty(&summary))
    }

    /// Writes an experiment file, and reports differences from the original.
    fn import_configuration(&self, args: &ImportArgs, path: &Path) -> Result<(), Error> {
        if !args.variant.is_empty() || args.seed.is_some() {
            let why = "a configuration has its own settings and seeds: --condition, --set, --ir-tables and --seed are for genotypes";
            return Err(Error::Usage(why.into()));
        }
        let text = bounded::read_stream_text(path, MAX_BYTES)?;
        let out = args.out.clone().unwrap_or_else(|| file_of(path));
        let name = out.display().to_string();
        if !name.ends_with(FILE) {
            return Err(Error::Usage(format!("--out {name}: a file that describes an experiment ends with {FILE}")));
        }
        let import = self.laboratory.files()?.import;
        let import = import.ok_or_else(|| Error::Usage("this program imports no configurations".into()))?;
        let imported = import(&path.display().to_string(), &name, &text).map_err(Error::into_usage)?;
        let ImportedFile { text, left, idle, more_left, more_idle } = &imported;
        let lost = left.len() + more_left;
        tell_left(left, lost);
        if args.strict && !left.is_empty() {
            let why = format!("{lost} of its lines and defaults cannot be carried over; nothing is written");
            return Err(Error::Usage(format!("{}: {why}", path.display())));
        }
        create_results(&[(out, text)])?;
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}: from {}", OneLine(&name), OneLine(path.display()));
        let _ = writeln!(
            text,
            "{} not carried over as it is, {} without effect; the file begins with them",
            lost,
            idle.len() + more_idle
        );
        let _ = writeln!(text, "{} check {}", self.program, OneLine(&name));
        let summary = Summary {
            file: name.clone(),
            left,
            without_effect: idle,
            more_left: *more_left,
            more_without_effect: *more_idle,
        };
        self.summary(args.json, &text, &|| pretty(&summary))
    }
}

/// Reports differences on standard error. A closed pipe is no error.
fn tell_left(left: &[LeftOut], lost: usize) {
    let mut errors = io::stderr().lock();
    for remark in left.iter().take(MAX_REMARKS) {
        let _ = writeln!(errors, "{remark}");
    }
    let shown = left.len().min(MAX_REMARKS);
    if lost > shown {
        let _ = writeln!(errors, "and {} more", lost - shown);
    }
}

fn has_ending(path: &Path) -> bool {
    path.extension().is_some_and(|end| CONFIGURATIONS.iter().any(|known| end.eq_ignore_ascii_case(known)))
}

/// Returns true for a configuration, by its name or its first line that is no comment.
fn is_configuration(path: &Path) -> bool {
    let begins = |text: String| {
        let line = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with(['#', ';']));
        line.is_some_and(|line| line.starts_with('['))
    };
    has_ending(path) || (path.is_file() && bounded::read_stream_text(path, MAX_BYTES).is_ok_and(begins))
}

/// Returns the experiment file for a configuration, with a valid name.
fn file_of(path: &Path) -> PathBuf {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let name: String =
        stem.chars().take(40).map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }).collect();
    let name = name.trim_matches('-');
    PathBuf::from(format!("{}{FILE}", if name.is_empty() { "experiment" } else { name }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_configurations_become_names_of_experiments() {
        for (path, file) in [
            ("configuration.ini", "configuration.toml"),
            ("../a/Khepera Light_2.CONF", "khepera-light-2.toml"),
            ("Ä.ini", "experiment.toml"),
        ] {
            assert_eq!(file_of(Path::new(path)), Path::new(file), "{path}");
            assert!(has_ending(Path::new(path)), "{path}");
        }
        assert!(!has_ending(Path::new("a.gen")) && !has_ending(Path::new("ini")));
    }
}
