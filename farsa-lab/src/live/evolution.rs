//! Evolution that goes on in memory, generation after generation, shared by any number of sessions that hold the same search.

use farsa_evo::{Fitness, ObservationStatistics, Snapshot as _};
use serde::Serialize;

use crate::error::Error;
use crate::experiment::evaluator::{Evaluator, TaskInfo};
use crate::experiment::genotype::Genotype;
use crate::experiment::outcome::Outcome;
use crate::live::bytes::Bytes;
use crate::live::script::Evolved;
use crate::live::standing::Standing;
use crate::ranks::wire::Outcomes;
use crate::run::evaluation_backend::{EvaluationBackend, Heard, TaskOf, Unfinished, round};
use crate::run::plan::Plan;
use crate::run::search_state::{GenerationResult, SearchState};
use crate::store::log::Line;
use crate::strategy::opponents::Hall;
use crate::strategy::search::Search;

/// Sessions that share a generation at most.
const MOST_PARTS: usize = 1024;

/// What came of a generation.
#[derive(Debug, Serialize)]
pub(crate) struct Bred {
    generation: u32,
    line: Line,
    /// The best of each population; by a strategy that keeps its champion the best that was evolved here.
    champions: Vec<Evolved>,
}

/// A search that goes on.
pub(crate) struct Evolution {
    progression: SearchState,
    info: TaskInfo,
    genotype: Genotype,
    /// The champions so far, and what the first of them earned.
    champions: Option<(Fitness, Vec<Evolved>)>,
}

impl Evolution {
    /// The search of a plan where it stood.
    ///
    /// # Errors
    /// [`Error::Other`] for a state that is none of the plan's strategy.
    pub(crate) fn resume(plan: &Plan<'_>, evaluator: &dyn Evaluator, standing: Standing) -> Result<Self, Error> {
        let wrong = |why: &str| Error::Other(format!("script: where evolution stands: {why}"));
        let mut search = plan.strategy()?;
        let snapshot = search.snapshot().ok_or_else(|| wrong("the strategy cannot save its state"))?;
        snapshot.restore(&standing.state.0).map_err(|error| wrong(&error.to_string()))?;
        if search.generation() != standing.generation {
            return Err(wrong("it is at another generation"));
        }
        let populations = search.populations();
        let floats = standing.hall.floats();
        let info = evaluator.info();
        let each = info.parameters.len().max(1);
        if !floats.len().is_multiple_of(populations * each) {
            return Err(wrong("its champions are of another length"));
        }
        let of_generation = |all: &[f32]| all.chunks(each).map(<[f32]>::to_vec).collect();
        let hall = Hall::from_champions(floats.chunks(populations * each).map(of_generation).collect());
        let observed = match standing.observed {
            Some(bytes) => {
                Some(ObservationStatistics::from_saved(&bytes.0).map_err(|error| wrong(&error.to_string()))?)
            }
            None => None,
        };
        let progression = SearchState::new(search, hall, observed, plan.seed);
        Ok(Self { progression, info, genotype: plan.genotype(evaluator), champions: None })
    }

    /// Evaluates a part of the present generation: of `parts` that are as large, the one with this number.
    ///
    /// # Errors
    /// [`Error::Usage`] for a part that there is not, and what keeps the generation from being evaluated.
    pub(crate) fn share(&mut self, evaluator: &mut dyn Evaluator, part: usize, parts: usize) -> Result<Bytes, Error> {
        if part >= parts || parts > MOST_PARTS {
            return Err(Error::Usage(format!("part {part} of {parts}; at most {MOST_PARTS}, the first is 0")));
        }
        let part = Part::Share { part, parts, found: Vec::new() };
        let mut session = Session { evaluator, info: &self.info, genotype: &self.genotype, part };
        let ended = self.progression.generation(&mut session, &|| {}, |_, _| Ok(()));
        if let Err(Unfinished::Error(error)) = ended {
            return Err(error);
        }
        let Part::Share { found, .. } = &session.part else { return Ok(Bytes::default()) };
        let bytes = postcard::to_stdvec(&Outcomes::from_numbered(found));
        bytes.map(Bytes).map_err(|error| Error::Other(format!("outcomes: {error}")))
    }

    /// Tells the strategy what all parts of the generation came to, which makes the next.
    ///
    /// # Errors
    /// [`Error::Usage`] for outcomes that are none, or not all.
    pub(crate) fn tell(&mut self, evaluator: &mut dyn Evaluator, parts: &[Bytes]) -> Result<Bred, Error> {
        let wrong = |why: &str| Error::Usage(format!("outcomes: {why}"));
        let mut all = Vec::new();
        for bytes in parts {
            let outcomes: Outcomes = postcard::from_bytes(&bytes.0).map_err(|error| wrong(&error.to_string()))?;
            all.extend(outcomes.into_numbered().ok_or_else(|| wrong("a name is missing"))?);
        }
        all.sort_by_key(|(number, _)| *number);
        let generation = self.progression.search.generation();
        let mut session = Session { evaluator, info: &self.info, genotype: &self.genotype, part: Part::Known(all) };
        let found = self.progression.generation(&mut session, &|| {}, Search::tell_unrecorded);
        let GenerationResult { fitness, statistics, each, best, met, normalisation, .. } =
            found.map_err(|error| match error {
                Unfinished::Error(error) => error,
                Unfinished::Stopped => wrong("they are not those of a whole generation"),
            })?;
        let normalisation = normalisation.map(|statistics| statistics.save());
        let champions = best.iter().zip(met).filter_map(|(best, opponents)| {
            let (individual, parameters) = (best.individual, best.genes.decode(&self.genotype)?);
            Some(Evolved { generation, individual, parameters, opponents, normalisation: normalisation.clone() })
        });
        let earned = best.first().map_or(Fitness::WORST, |best| best.fitness);
        let champions = match self.champions.take() {
            Some(known) if self.progression.search.keeps_champion() && earned <= known.0 => known,
            _ => (earned, champions.collect()),
        };
        let line = Line::new(&statistics, fitness.len(), &each);
        Ok(Bred { generation, line, champions: self.champions.insert(champions).1.clone() })
    }
}

/// What is evaluated of a generation.
enum Part {
    /// Every so many, from one of them on; what it came to.
    Share { part: usize, parts: usize, found: Vec<(usize, Option<Outcome>)> },
    /// Nothing: all outcomes are known, in their order.
    Known(Vec<(usize, Option<Outcome>)>),
}

/// Evaluates a part of a generation, or knows what all came to.
struct Session<'s> {
    evaluator: &'s mut dyn Evaluator,
    info: &'s TaskInfo,
    genotype: &'s Genotype,
    part: Part,
}

impl EvaluationBackend for Session<'_> {
    fn evaluator(&self) -> &dyn Evaluator {
        self.evaluator
    }

    fn info(&self) -> &TaskInfo {
        self.info
    }

    fn genotype(&self) -> &Genotype {
        self.genotype
    }

    fn evaluate(
        &mut self,
        count: usize,
        task: &TaskOf<'_, '_>,
        done: &Heard<'_>,
    ) -> Result<Vec<Option<Outcome>>, Unfinished> {
        let (part, parts, found) = match &mut self.part {
            Part::Known(all) if all.iter().map(|(number, _)| *number).eq(0..count) => {
                return Ok(std::mem::take(all).into_iter().map(|(_, outcome)| outcome).collect());
            }
            Part::Known(_) => return Err(Unfinished::Stopped),
            Part::Share { part, parts, found } => (*part, *parts, found),
        };
        let mut numbers = (part..count).step_by(parts);
        let (mut left_out, mut ended) = (Vec::new(), Vec::new());
        let mut next = || {
            for number in numbers.by_ref() {
                match task(number) {
                    None => left_out.push((number, None)),
                    evaluation => return evaluation,
                }
            }
            None
        };
        let mut end = |number: usize, outcome: Outcome| {
            done(number, Some(&outcome));
            ended.push((number, Some(outcome)));
        };
        round(self.evaluator, &mut next, &mut end);
        ended.append(&mut left_out);
        *found = ended;
        // A share alone is never a generation.
        Err(Unfinished::Stopped)
    }
}
