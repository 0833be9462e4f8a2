//! From the first line to the last.

use std::io::{BufRead, Write};
use std::sync::atomic::AtomicBool;

use farsa_evo::ScoreShape;
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::lines::answer::{Answer, ByPopulation, IndividualResult, Introduction, Refusal};
use crate::evaluation::lines::bounded_line::{BoundedLine, next_line};
use crate::evaluation::lines::request::{Request, RequestSchema};
use crate::experiment::episode::EpisodeId;
use crate::run::fitness::{Generation, Opponents, individuals};
use crate::run::plan::Plan;
use crate::run::pool::Pool;

/// Writes a line that describes the experiment, and then one for each line that is read: what its parameters come to, in trials
/// as those of a run. Each is written out before the next is read.
///
/// # Errors
/// [`Error::Usage`] at the end if any line was refused, and for normalized observations. [`Error::Io`] of input and
/// output.
pub(crate) fn serve(
    plan: &Plan<'_>,
    mut pool: Pool<'_>,
    input: &mut impl BufRead,
    output: &mut impl Write,
) -> Result<(), Error> {
    if plan.no_observations()?.is_some() {
        let why = "--stdin: observations are normalised by what a run has observed, and this is none";
        return Err(Error::Usage(why.into()));
    }
    let populations = pool.info().populations.clone();
    let wanted = RequestSchema {
        experiment: plan.experiment.name(),
        size: if populations.len() > 1 { plan.size()? } else { 0 },
        populations,
        parameters: pool.info().parameters.clone(),
        genotype: pool.genotype().clone(),
        seed: plan.seed,
        limits: plan.limits,
    };
    let line_bytes = plan.limits.line_bytes;
    write(output, &Introduction::new(&plan.condition, &wanted, pool.evaluator(), line_bytes))?;
    let mut first_refused: Option<(u64, String)> = None;
    let (mut line, mut refused) = (0, 0_u64);
    let reading = |error| Error::io("read", "the input".as_ref())(error);
    while let Some(found) = next_line(input, line_bytes).map_err(reading)? {
        line += 1;
        let request = match found {
            BoundedLine::Whole(bytes) => Request::from_line(&bytes, &wanted),
            BoundedLine::TooLong => Err(format!("has more than {line_bytes} bytes, the most of a line")),
        };
        match request {
            Ok(request) => write(output, &answer(line, request, &wanted, &mut pool)?)?,
            Err(error) => {
                write(output, &Refusal { line, error: &error })?;
                refused += 1;
                first_refused.get_or_insert((line, error));
            }
        }
    }
    match first_refused {
        None => Ok(()),
        Some((first, why)) => Err(Error::Usage(format!("{refused} of {line} lines were refused; line {first}: {why}"))),
    }
}

/// Writes a value as a line and flushes, because the caller waits for it.
fn write(output: &mut impl Write, value: &impl Serialize) -> Result<(), Error> {
    let mut text = serde_json::to_vec(value).map_err(|error| Error::Other(error.to_string()))?;
    text.push(b'\n');
    output.write_all(&text).and_then(|()| output.flush()).map_err(Error::io("write", "the output".as_ref()))
}

/// Evaluates a request, one population after the other.
fn answer<'w>(
    line: u64,
    request: Request,
    wanted: &'w RequestSchema,
    pool: &mut Pool<'_>,
) -> Result<Answer<'w>, Error> {
    let Request { id, seed, generation, individual, parameters, evaluated } = request;
    let behaviour = pool.evaluator().behavior();
    let (objectives, measures) =
        behaviour.map_or((0, 0), |behaviour| (behaviour.objectives().len(), behaviour.measures().len()));
    let shape = ScoreShape::new(1 + objectives, measures);
    let trials = pool.info().trials;
    let mut results: Vec<(&str, Vec<IndividualResult>)> = Vec::new();
    for (own, name) in wanted.populations.iter().enumerate().filter(|(own, _)| evaluated[*own]) {
        let met = opponents(&parameters, own, trials);
        let opponents = Opponents { parameters: &met, each: parameters.len() - 1, told_apart: None };
        let individual = (own * wanted.size) as u32 + individual;
        let id = EpisodeId { seed, generation, individual, trial: 0 };
        let batch = Generation { parameters: &parameters[own], opponents, normalisation: None, id, stop: None };
        let judged = individuals(&mut pool.until(&AtomicBool::new(false)), batch, shape, |_| {})?;
        let evaluator = pool.evaluator();
        results.push((name, judged.into_iter().map(|judged| IndividualResult::new(judged, evaluator)).collect()));
    }
    let fitness = |judged: &[IndividualResult]| judged.iter().map(|result| result.fitness).collect::<Vec<_>>();
    let fitness: Vec<_> = results.iter().map(|(name, judged)| (*name, fitness(judged))).collect();
    Ok(Answer {
        line,
        id,
        fitness: by_population(fitness, wanted.populations.len()),
        individuals: by_population(results, wanted.populations.len()),
    })
}

/// Without a name where there is a single population.
fn by_population<T>(mut all: Vec<(&str, T)>, populations: usize) -> ByPopulation<'_, T> {
    match all.pop() {
        Some((_, only)) if populations == 1 => ByPopulation::Only(only),
        last => ByPopulation::Named(all.into_iter().chain(last).collect()),
    }
}

/// Lists the opponents of a population, trial after trial, individual after individual. As in the first generation of
/// a run, trial t is against individual t of each other population.
fn opponents(parameters: &[Vec<Vec<f32>>], own: usize, trials: usize) -> Vec<&[f32]> {
    let others = || parameters.iter().enumerate().filter(move |(other, _)| *other != own);
    let of_trial = |trial: usize| others().map(move |(_, rows)| rows[trial % rows.len()].as_slice());
    (0..trials).flat_map(|trial| parameters[own].iter().flat_map(move |_| of_trial(trial))).collect()
}
