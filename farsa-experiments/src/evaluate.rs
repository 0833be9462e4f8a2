//! `farsa evaluate`: anybody's genotype on random trials.

use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use crate::arguments_genotypes::EvaluateArgs;
use crate::error::Error;
use crate::exam;
use crate::exam_table::Tried;
use crate::experiment::{Experiment, Note};
use crate::genotypes::Shape;
use crate::plan::{self, Plan};
use crate::pool::{Pool, Unfinished};
use crate::progress::Progress;
use crate::settings::Value;

/// The setting that `--ir-tables` is short for.
const INFRARED_TABLES: &str = "robot.infrared_tables";

/// What an evaluation found.
#[derive(Debug, Serialize)]
pub(crate) struct Evaluation {
    experiment: String,
    condition: String,
    trials: usize,
    seed: u64,
    /// Lives whose numbers were not finite; they count in nothing else.
    broken_down: usize,
    mean_fitness: f64,
    /// Of the mean fitness; not a number for a single trial.
    standard_error: f64,
    /// The mean of every note that is a number, under its name.
    #[serde(flatten)]
    per_trial: serde_json::Map<String, serde_json::Value>,
    success_rate: f64,
    /// The same in the order of the notes.
    #[serde(skip)]
    notes: Vec<(String, f64)>,
}

impl Evaluation {
    /// What `tried` says together.
    fn new(plan: &Plan<'_>, seed: u64, tried: &[Tried]) -> Self {
        let lived: Vec<&Tried> = tried.iter().filter(|tried| tried.fitness.is_finite()).collect();
        let fitness: Vec<f64> = lived.iter().map(|tried| tried.fitness).collect();
        let (mean_fitness, standard_error) = mean(&fitness);
        let mut notes: Vec<(String, f64)> = Vec::new();
        let names = lived.first().map_or(&[][..], |tried| &tried.outcome.notes);
        for (name, _) in names.iter().filter(|(_, note)| matches!(note, Note::Number(_))) {
            let values = lived.iter().filter_map(|tried| {
                let (_, note) = tried.outcome.notes.iter().find(|(other, _)| other == name)?;
                if let Note::Number(x) = note { Some(*x) } else { None }
            });
            notes.push((format!("{}_per_trial", word(name)), mean(&values.collect::<Vec<_>>()).0));
        }
        let successes = tried.iter().filter(|tried| tried.outcome.success).count();
        Self {
            experiment: plan.experiment.name().into(),
            condition: plan.condition.clone(),
            trials: tried.len(),
            seed,
            broken_down: tried.len() - lived.len(),
            mean_fitness,
            standard_error,
            per_trial: notes.iter().map(|(name, x)| (name.clone(), (*x).into())).collect(),
            success_rate: successes as f64 / tried.len().max(1) as f64,
            notes,
        }
    }

    /// A line for each number, its name first.
    pub(crate) fn text(&self) -> String {
        let Self { mean_fitness, standard_error, success_rate, broken_down, .. } = self;
        let mut text = format!("mean_fitness {mean_fitness:?}\nstandard_error {standard_error:?}\n");
        // Writing into a string cannot fail.
        for (name, x) in &self.notes {
            let _ = writeln!(text, "{name} {x:?}");
        }
        let _ = writeln!(text, "success_rate {success_rate:?}");
        if *broken_down > 0 {
            let _ = writeln!(text, "broken_down {broken_down}");
        }
        text
    }
}

/// The mean and its standard error.
fn mean(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (count - 1.0) / count).sqrt())
}

/// The name of a note as one word: letters and digits stay, everything between them becomes an underscore.
fn word(name: &str) -> String {
    name.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty()).collect::<Vec<_>>().join("_")
}

/// The plan that the options of the commands about genotypes ask for.
///
/// # Errors
/// [`Error::Unknown`] and [`Error::Setting`]; [`Error::Usage`] for tables that the experiment has no setting for.
pub(crate) fn plan<'e>(
    experiments: &[&'e dyn Experiment],
    (experiment, condition): (&str, Option<&str>),
    set: &[(String, Value)],
    infrared_tables: Option<&Path>,
) -> Result<Plan<'e>, Error> {
    let mut plan = Plan::new(plan::find(experiments, experiment, "")?, condition, "")?;
    for (key, value) in set {
        plan.settings.set("--set", key, value.clone())?;
    }
    if let Some(directory) = infrared_tables {
        if !plan.settings.table().iter().any(|setting| setting.key() == INFRARED_TABLES) {
            let condition = &plan.condition;
            let under = if condition.is_empty() { String::new() } else { format!(" under condition `{condition}`") };
            let why = format!("--ir-tables: {experiment} has no setting `{INFRARED_TABLES}`{under}");
            return Err(Error::Usage(why));
        }
        let text = directory
            .to_str()
            .ok_or_else(|| Error::Usage(format!("--ir-tables: {}: the name is not Unicode", directory.display())))?;
        plan.settings.set("--ir-tables", INFRARED_TABLES, Value::Word(text.into()))?;
    }
    Ok(plan)
}

/// Lives random trials of the genes on the command line.
///
/// # Errors
/// [`Error::Usage`] for genes that are none of the experiment's, and for an experiment of several populations.
pub(crate) fn evaluate(args: &EvaluateArgs, quiet: bool, experiments: &[&dyn Experiment]) -> Result<Evaluation, Error> {
    let name = (args.experiment.as_str(), args.condition.as_deref());
    let plan = plan(experiments, name, &args.set, args.ir_tables.as_deref())?;
    let mut pool = Pool::new(&plan, args.threads.count(), args.lanes.wanted())?;
    alone(&plan, pool.setup().populations())?;
    let shape = Shape::of(pool.setup());
    let genes = match (&args.genes, &args.genes_file) {
        (Some(list), _) => shape.list(list).map_err(|error| Error::Usage(format!("--genes: {error}")))?,
        (None, Some(path)) => one(shape.read(path)?, args.genotype, path)?,
        (None, None) => return Err(Error::Usage("neither --genes nor --genes-file".into())),
    };
    let trials = args.trials as usize;
    let progress = Progress::new(0, trials as u64, quiet);
    let tried = exam::lives(&mut pool, &[&genes], 0, trials, args.seed, &progress);
    drop(progress);
    let tried = tried.map_err(|reason| match reason {
        Unfinished::Panicked => Error::Other("a life panicked".into()),
        Unfinished::Stopped => Error::Other("stopped".into()),
    })?;
    Ok(Evaluation::new(&plan, args.seed, &tried))
}

/// Refuses an experiment whose individuals live against others.
pub(crate) fn alone(plan: &Plan<'_>, populations: usize) -> Result<(), Error> {
    if populations == 1 {
        return Ok(());
    }
    let name = plan.experiment.name();
    Err(Error::Usage(format!(
        "{name} has {populations} populations: a genotype alone has no opponents to live against"
    )))
}

/// The genotype that was asked for, or the only one.
fn one(mut genotypes: Vec<Vec<u16>>, wanted: Option<usize>, path: &Path) -> Result<Vec<u16>, Error> {
    let (path, count) = (path.display(), genotypes.len());
    match wanted {
        None if count == 1 => Ok(genotypes.swap_remove(0)),
        None => Err(Error::Usage(format!("{path}: holds {count} genotypes: choose one with --genotype, from 0"))),
        Some(number) if number < count => Ok(genotypes.swap_remove(number)),
        Some(number) => Err(Error::Usage(format!("{path}: genotype {number} of {count} (the first is 0)"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_has_an_error() {
        // 1, 2, 3, 4: variance 5/3, divided by 4.
        let (m, e) = mean(&[1.0, 2.0, 3.0, 4.0]);
        assert!(m == 2.5 && (e - (5.0_f64 / 12.0).sqrt()).abs() < 1e-15);
        assert!(mean(&[7.0]).0 == 7.0 && mean(&[7.0]).1.is_nan() && mean(&[]).0.is_nan());
    }

    #[test]
    fn notes_are_one_word() {
        assert_eq!(["collisions", "at [m]", "time to go [s]"].map(word), ["collisions", "at_m", "time_to_go_s"]);
    }
}
