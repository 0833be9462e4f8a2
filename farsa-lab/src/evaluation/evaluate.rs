//! `farsa evaluate`: a genotype from any source on random trials.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use serde::Serialize;

use crate::error::Error;
use crate::evaluation::genotypes::Shape;
use crate::evaluation::populations::Populations;
use crate::evaluation::test::{self, Tested, Trials};
use crate::evaluation::test_table::TrialResult;
use crate::experiment::evaluator::TaskInfo;
use crate::experiment::outcome::Note;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progress::Progress;
use crate::strategy::any_strategy::Genome;

/// Genes that a command line gives.
pub(crate) struct GeneArguments {
    /// Lists of genes, with the names of populations before them or not.
    pub(crate) lists: Vec<String>,
    /// Files of genotypes, likewise.
    pub(crate) files: Vec<PathBuf>,
    /// Number of the genotype in each file. None for the only one.
    pub(crate) numbers: Vec<usize>,
}

/// Result of an evaluation.
#[derive(Debug, Serialize)]
pub(crate) struct Evaluation {
    experiment: String,
    condition: String,
    trials: usize,
    seed: u64,
    /// Trials with numbers that are not finite. They are excluded from all means.
    broken_down: usize,
    /// Present for a single population only.
    #[serde(skip_serializing_if = "Option::is_none")]
    mean_fitness: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    standard_error: Option<f64>,
    /// Mean of every note that is a number, under its name.
    #[serde(flatten)]
    per_trial: serde_json::Map<String, serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    success_rate: Option<f64>,
    /// Results of several populations, in order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    populations: Vec<PopulationResult>,
    /// Name and value of each line of text.
    #[serde(skip)]
    lines: Vec<(String, String)>,
}

/// Result of one population.
#[derive(Debug, Serialize)]
struct PopulationResult {
    population: String,
    mean_fitness: f64,
    /// Standard error of the mean fitness. NaN for a single trial.
    standard_error: f64,
    /// Share of all trials, NaN if all broke down. `None` for a task without a criterion of success.
    #[serde(skip_serializing_if = "Option::is_none")]
    success_rate: Option<f64>,
}

impl PopulationResult {
    /// Summarizes population number `own` over the finished trials. The success rate is relative to all trials.
    fn new(name: &str, own: usize, finished: &[&TrialResult], all: usize, has_success: bool) -> Self {
        let result_of = |results: &TrialResult| match own.checked_sub(1) {
            None => Some((results.fitness, results.outcome.success)),
            Some(other) => results.others.get(other).copied(),
        };
        let earned: Vec<(f64, bool)> = finished.iter().filter_map(|results| result_of(results)).collect();
        let (mean_fitness, standard_error) = mean(&earned.iter().map(|(fitness, _)| *fitness).collect::<Vec<_>>());
        let successes = earned.iter().filter(|(_, success)| *success).count();
        let success_rate = if earned.is_empty() { f64::NAN } else { successes as f64 / all.max(1) as f64 };
        Self {
            population: name.into(),
            mean_fitness,
            standard_error,
            success_rate: has_success.then_some(success_rate),
        }
    }
}

impl Evaluation {
    /// Summarizes the results of a task.
    fn new(plan: &Plan<'_>, seed: u64, info: &TaskInfo, results: &[TrialResult]) -> Self {
        let names = &info.populations;
        let finished: Vec<&TrialResult> = results.iter().filter(|result| result.failure.is_none()).collect();
        let broken_down = results.len() - finished.len();
        let mut notes: Vec<(String, f64)> = Vec::new();
        let first_notes = finished.first().map_or(&[][..], |results| &results.outcome.notes);
        for (name, _) in first_notes.iter().filter(|(_, note)| matches!(note, Note::Number(_))) {
            let values = finished.iter().filter_map(|results| {
                let (_, note) = results.outcome.notes.iter().find(|(other, _)| other == name)?;
                if let Note::Number(x) = note { Some(*x) } else { None }
            });
            notes.push((format!("{}_per_trial", word(name)), mean(&values.collect::<Vec<_>>()).0));
        }
        let earned = names
            .iter()
            .enumerate()
            .map(|(own, name)| PopulationResult::new(name, own, &finished, results.len(), info.has_success));
        let earned: Vec<PopulationResult> = earned.collect();
        let alone = if let [alone] = earned.as_slice() { Some(alone) } else { None };
        let mut lines: Vec<(String, String)> = Vec::new();
        let mut add = |name: &str, x: f64| lines.push((name.into(), format!("{x:?}")));
        for result in &earned {
            let prefix = if alone.is_some() { String::new() } else { format!("{}_", word(&result.population)) };
            add(&format!("{prefix}mean_fitness"), result.mean_fitness);
            add(&format!("{prefix}standard_error"), result.standard_error);
            if alone.is_some() {
                for (name, x) in &notes {
                    add(name, *x);
                }
            }
            if let Some(rate) = result.success_rate {
                add(&format!("{prefix}success_rate"), rate);
            }
        }
        if alone.is_none() {
            for (name, x) in &notes {
                add(name, *x);
            }
        }
        if broken_down > 0 {
            lines.push(("broken_down".into(), broken_down.to_string()));
        }
        Self {
            experiment: plan.experiment.name().into(),
            condition: plan.condition.clone(),
            trials: results.len(),
            seed,
            broken_down,
            mean_fitness: alone.map(|alone| alone.mean_fitness),
            standard_error: alone.map(|alone| alone.standard_error),
            per_trial: notes.into_iter().map(|(name, x)| (name, x.into())).collect(),
            success_rate: alone.and_then(|alone| alone.success_rate),
            populations: if names.len() == 1 { Vec::new() } else { earned },
            lines,
        }
    }

    /// A line for each number, its name first.
    pub(crate) fn text(&self) -> String {
        // Writing into a string cannot fail.
        let mut text = String::new();
        for (name, x) in &self.lines {
            let _ = writeln!(text, "{name} {x}");
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

/// Formats the name of a note as one word: letters and digits stay, everything between them becomes an underscore.
fn word(name: &str) -> String {
    name.split(|c: char| !c.is_alphanumeric()).filter(|part| !part.is_empty()).collect::<Vec<_>>().join("_")
}

/// Runs random trials of the given genes. Several populations compete in each trial.
///
/// # Errors
/// [`Error::Usage`] for genes that do not fit the experiment, and for a population with no genes or with two genotypes.
pub(crate) fn evaluate(
    plan: &Plan<'_>,
    mut pool: Pool,
    given: &GeneArguments,
    trials: usize,
    seed: u64,
    quiet: bool,
) -> Result<Evaluation, Error> {
    let names = pool.info().populations.clone();
    let genes = genes(given, plan.experiment.name(), &names, Shape::from_genotype(pool.genotype()))?;
    let parameters: Option<Vec<Vec<f32>>> = genes.iter().map(|genes| genes.decode(pool.genotype())).collect();
    let parameters = parameters.unwrap_or_default();
    let size = if names.len() > 1 { plan.size()? } else { 0 };
    let progress = Progress::of_trials(trials, quiet);
    let given = Tested { parameters: &parameters, size, normalisation: None };
    let never = AtomicBool::new(false);
    let results = test::run_trials(&mut pool, given, Trials::plain(trials, seed), &never, &progress);
    drop(progress);
    let results = results?;
    Ok(Evaluation::new(plan, seed, pool.info(), &results))
}

/// Gets the genes of each population, from lists and files.
fn genes(asked: &GeneArguments, experiment: &str, names: &[String], shape: Shape) -> Result<Vec<Genome>, Error> {
    const OPTIONS: &str = "--genes, --genes-file";
    let populations = Populations { experiment, names };
    if asked.numbers.len() > asked.files.len() {
        let (numbers, files) = (asked.numbers.len(), asked.files.len());
        return Err(Error::Usage(format!("--genotype: {numbers} numbers for {files} of --genes-file")));
    }
    let count = asked.lists.len() + asked.files.len();
    if names.len() == 1 && count > 1 {
        return Err(Error::Usage(format!("{OPTIONS}: {count} genotypes where {experiment} takes one")));
    }
    let mut given = Vec::new();
    for list in &asked.lists {
        let (population, list) = populations.split("--genes", list)?;
        let prefix = population.map_or_else(String::new, |population| format!("{}: ", names[population]));
        let genes = shape.genome(list).map_err(|error| Error::Usage(format!("--genes: {prefix}{error}")))?;
        given.push((population, genes));
    }
    for (number, path) in asked.files.iter().enumerate() {
        let (population, path) = populations.file("--genes-file", path)?;
        given.push((population, one(shape.read_genomes(&path)?, asked.numbers.get(number).copied(), &path)?));
    }
    let unnamed = given.iter().any(|(population, _)| population.is_none());
    if names.len() > 1 && unnamed && !asked.lists.is_empty() && !asked.files.is_empty() {
        // They have no order between them.
        let [first, second, ..] = names else { return Ok(Vec::new()) };
        let why = format!("name the populations: --genes {first}=... --genes-file {second}=...");
        return Err(Error::Usage(format!("{OPTIONS}: {experiment} has several populations: {why}")));
    }
    let all = populations.divide(OPTIONS, given)?;
    let one = |(name, mut all): (&String, Vec<Genome>)| match all.len() {
        1 => Ok(all.swap_remove(0)),
        count => Err(Error::Usage(format!("{OPTIONS}: {count} genotypes for population `{name}`"))),
    };
    names.iter().zip(all).map(one).collect()
}

/// Gets the genotype that was asked for, or the only one.
fn one(mut genotypes: Vec<Genome>, wanted: Option<usize>, path: &Path) -> Result<Genome, Error> {
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
