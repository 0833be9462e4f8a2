//! `farsa test`: the champion on starts that it has never met.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::atomic::AtomicBool;

use crate::directory::{Directory, replace};
use crate::error::Error;
use crate::experiment::{Note, Outcome, Tape};
use crate::life::Job;
use crate::plan::{LARGEST_SEED, Plan};
use crate::pool::{Pool, Unfinished};
use crate::progress::Progress;
use crate::records::{self, Champion};

/// Lives `trials` fresh trials of the champion, writes `test.csv` and returns a table for reading.
///
/// Trial i of the test is trial i modulo the experiment's number of trials, with random numbers of its own.
pub(crate) fn test(
    plan: &Plan<'_>,
    directory: &Directory,
    trials: usize,
    seed: u64,
    threads: usize,
) -> Result<String, Error> {
    let path = directory.champion();
    if !path.is_file() && directory.checkpoint().is_file() {
        return Err(Error::damaged(&path, "there is none: no generation is finished yet"));
    }
    let Champion { identity, generation, individual, genes, .. } = records::read(&path, plan, directory.path())?;
    let mut pool = Pool::new(plan, threads)?;
    if genes.len() != pool.genes() {
        return Err(Error::damaged(&path, "its genome is not one of the experiment"));
    }
    let warning = identity.same_values(&plan.identity(), &path).err();

    let progress = Progress::new("trials", 0, trials as u64);
    let results = pool.map(trials, &AtomicBool::new(false), |setup, index| {
        let kinds = setup.trials().max(1);
        let (round, trial) = ((index / kinds) as u32, (index % kinds) as u32);
        let job = Job { seed: seed | !LARGEST_SEED, generation: round, individual: 0, trial };
        let outcome = setup.live(&genes, job, &mut Tape::off());
        let fitness = if outcome.is_finite() { setup.fitness(std::slice::from_ref(&outcome)) } else { f64::NAN };
        progress.advance();
        (trial, outcome, fitness)
    });
    drop(progress);
    let results = results.map_err(|reason| match reason {
        Unfinished::Panicked => Error::Panicked { generation },
        Unfinished::Stopped => Error::Other("stopped".into()),
    })?;

    let table = table(&plan.setup()?.terms(), &results);
    replace(&directory.test(), csv_of(&table, &directory.test())?.as_slice())?;
    let mut text = aligned(&table);
    let _ = writeln!(text, "\nindividual {individual} of generation {generation}, test seed {seed}");
    text.push_str(&summary(&results));
    if let Some(warning) = warning {
        let _ = writeln!(text, "warning: {warning}");
    }
    Ok(text)
}

type Result1 = (u32, Outcome, f64);

fn table(terms: &[String], results: &[Result1]) -> Vec<Vec<String>> {
    let mut head: Vec<String> = ["index", "trial", "steps", "success", "fitness"].map(str::to_owned).into();
    // An experiment with one term has it as its fitness.
    let terms = if terms.len() > 1 { terms } else { &[] };
    head.extend(terms.iter().cloned());
    // A life that broke down has no notes: the names are those of the first that has.
    let names: Vec<&str> = results
        .iter()
        .map(|(_, outcome, _)| &outcome.notes)
        .find(|notes| !notes.is_empty())
        .map_or_else(Vec::new, |notes| notes.iter().map(|(name, _)| *name).collect());
    head.extend(names.iter().map(|&name| name.to_owned()));
    let lines = results.iter().enumerate().map(|(index, (trial, outcome, fitness))| {
        let mut line = vec![
            index.to_string(),
            trial.to_string(),
            outcome.steps.to_string(),
            outcome.success.to_string(),
            number(*fitness),
        ];
        line.extend((0..terms.len()).map(|term| number(outcome.terms.get(term).copied().unwrap_or(f64::NAN))));
        line.extend(names.iter().map(|&name| match outcome.notes.iter().find(|note| note.0 == name) {
            Some((_, Note::Number(x))) => number(*x),
            Some((_, Note::Text(text))) => text.clone(),
            None => String::new(),
        }));
        line
    });
    std::iter::once(head).chain(lines).collect()
}

fn number(x: f64) -> String {
    format!("{x:?}")
}

fn csv_of(table: &[Vec<String>], path: &std::path::Path) -> Result<Vec<u8>, Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    table.iter().try_for_each(|line| writer.write_record(line)).map_err(|error| Error::damaged(path, error))?;
    writer.into_inner().map_err(|error| Error::damaged(path, error.to_string()))
}

/// The table with columns that stand under each other; numbers are cut to two places.
fn aligned(table: &[Vec<String>]) -> String {
    let short = |field: &String| match field.parse::<f64>() {
        Ok(x) if field.contains('.') => format!("{x:.2}"),
        _ => field.clone(),
    };
    let table: Vec<Vec<String>> = table.iter().map(|line| line.iter().map(short).collect()).collect();
    let columns = table.first().map_or(0, Vec::len);
    let width = |column: usize| table.iter().filter_map(|line| Some(line.get(column)?.chars().count())).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let mut text = String::new();
    for line in &table {
        let fields = line.iter().zip(&widths).map(|(field, &width)| format!("{field:>width$}"));
        text.push_str(fields.collect::<Vec<_>>().join("  ").trim_end());
        text.push('\n');
    }
    text
}

/// The share of successes, the mean fitness, and the notes' counts and means.
fn summary(results: &[Result1]) -> String {
    let mut text = String::new();
    let share =
        |n: usize| format!("{n} of {} ({:.1} %)", results.len(), 100.0 * n as f64 / results.len().max(1) as f64);
    let successes = results.iter().filter(|(_, outcome, _)| outcome.success).count();
    // Writing into a string cannot fail.
    let _ = writeln!(text, "success: {}", share(successes));
    let failed = results.iter().filter(|(_, outcome, _)| !outcome.is_finite()).count();
    if failed > 0 {
        let _ = writeln!(text, "broken down: {}", share(failed));
    }
    let mut names: Vec<&str> = vec!["fitness"];
    let mut numbers: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let mut words: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for (_, outcome, fitness) in results {
        numbers.entry("fitness").or_default().push(*fitness);
        for (name, note) in &outcome.notes {
            if !names.contains(name) {
                names.push(name);
            }
            match note {
                Note::Number(x) => numbers.entry(name).or_default().push(*x),
                Note::Text(word) => *words.entry(name).or_default().entry(word).or_default() += 1,
            }
        }
    }
    for name in names {
        if let Some(list) = numbers.get(name) {
            let finite: Vec<f64> = list.iter().copied().filter(|x| x.is_finite()).collect();
            let mean = finite.iter().sum::<f64>() / finite.len().max(1) as f64;
            let _ = writeln!(text, "{name}: mean {mean:.2}");
        }
        if let Some(counts) = words.get(name) {
            let counts: Vec<String> = counts.iter().map(|(word, &count)| format!("{word} {}", share(count))).collect();
            let _ = writeln!(text, "{name}: {}", counts.join(", "));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_counts_words_and_averages_numbers() {
        let outcome = |phase: &str, height: f64, success| Outcome {
            terms: vec![1.0, 2.5],
            steps: 6,
            success,
            notes: vec![("phase", phase.into()), ("height", height.into())],
        };
        let results = [
            (0, outcome("reach", 1.0, false), 3.5),
            (1, outcome("lift", 6.0, true), 3.5),
            (2, Outcome::failed(), f64::NAN),
            (3, outcome("lift", 8.0, true), 7.0),
        ];
        let table = table(&["a".into(), "b".into()], &results);
        assert_eq!(table[0].join(","), "index,trial,steps,success,fitness,a,b,phase,height");
        assert_eq!(table[1].join(","), "0,0,6,false,3.5,1.0,2.5,reach,1.0");
        assert_eq!(table[3].join(","), "2,2,0,false,NaN,NaN,NaN,,");
        assert_eq!(
            summary(&results),
            "success: 2 of 4 (50.0 %)\nbroken down: 1 of 4 (25.0 %)\nfitness: mean 4.67\n\
             phase: lift 2 of 4 (50.0 %), reach 1 of 4 (25.0 %)\nheight: mean 5.00\n"
        );
        assert!(aligned(&table).lines().all(|line| line.len() <= aligned(&table).lines().next().unwrap().len()));
    }
}
