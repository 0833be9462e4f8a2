//! A search continued in memory. Several sessions with the same search share each generation.

use farsa_evo::{Fitness, ObservationStatistics, Snapshot as _};
use serde::Serialize;

use crate::error::Error;
use crate::experiment::evaluator::{Evaluator, TaskInfo};
use crate::experiment::genotype::Genotype;
use crate::experiment::outcome::Outcome;
use crate::live::bytes::Bytes;
use crate::live::page_run::PageIndividual;
use crate::live::run_state::{RunState, StateMark};
use crate::ranks::wire::Outcomes;
use crate::run::evaluation_backend::{EvaluationBackend, Heard, TaskOf, Unfinished, round};
use crate::run::plan::Plan;
use crate::run::search_state::{GenerationResult, SearchState};
use crate::store::log::Line;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::opponents::HallOfFame;

/// Results of a generation.
#[derive(Debug, Serialize)]
pub(crate) struct EvolvedGeneration {
    generation: u32,
    line: Line,
    /// Best of each population, over all generations here for a strategy that keeps its champion.
    champions: Vec<PageIndividual>,
}

/// A continued search.
pub(crate) struct Evolution {
    search: SearchState,
    info: TaskInfo,
    genotype: Genotype,
    /// Fitness of the first champion, and the champions so far.
    champions: Option<(Fitness, Vec<PageIndividual>)>,
}

impl Evolution {
    /// Restores the search of a plan.
    ///
    /// # Errors
    /// [`Error::Other`] for a state that does not fit the plan's strategy.
    pub(crate) fn resume(plan: &Plan<'_>, evaluator: &dyn Evaluator, state: RunState) -> Result<Self, Error> {
        let invalid = |why: &str| Error::Other(format!("script: the state of the run: {why}"));
        let mut search = plan.strategy()?;
        let snapshot = search.snapshot().ok_or_else(|| invalid("the strategy cannot save its state"))?;
        snapshot.restore(&state.state.0).map_err(|error| invalid(&error.to_string()))?;
        if search.generation() != state.generation {
            return Err(invalid("it is of another generation"));
        }
        let populations = search.populations();
        let floats = state.hall.floats();
        let info = evaluator.info();
        let length = info.parameters.len().max(1);
        if !floats.len().is_multiple_of(populations * length) {
            return Err(invalid("its champions have another number of parameters"));
        }
        let of_generation = |champions: &[f32]| champions.chunks(length).map(<[f32]>::to_vec).collect();
        let hall = HallOfFame::from_champions(floats.chunks(populations * length).map(of_generation).collect());
        let observed = match state.observed {
            Some(bytes) => {
                Some(ObservationStatistics::from_saved(&bytes.0).map_err(|error| invalid(&error.to_string()))?)
            }
            None => None,
        };
        let search = SearchState::new(search, hall, observed, plan.seed);
        Ok(Self { search, info, genotype: plan.genotype(evaluator), champions: None })
    }

    /// Identifies the state after the finished generations.
    ///
    /// # Errors
    /// [`Error::Usage`] for a strategy that cannot save its state.
    pub(crate) fn mark(&mut self) -> Result<StateMark, Error> {
        let state = RunState::of(&mut self.search);
        state.map(|state| state.mark()).ok_or_else(|| Error::Usage("the strategy cannot save its state".into()))
    }

    /// Evaluates part number `part` of `parts` equal parts of the current generation.
    ///
    /// # Errors
    /// [`Error::Usage`] for a part out of range and errors of the evaluation.
    pub(crate) fn share(&mut self, evaluator: &mut dyn Evaluator, part: usize, parts: usize) -> Result<Bytes, Error> {
        if part >= parts {
            return Err(Error::Usage(format!("part {part} of {parts} (the first is 0)")));
        }
        let part = Part::Share { part, parts, outcomes: Vec::new() };
        let mut session = Session { evaluator, info: &self.info, genotype: &self.genotype, part };
        let ended = self.search.generation(&mut session, &|| {}, |_, _| Ok(()));
        if let Err(Unfinished::Error(error)) = ended {
            return Err(error);
        }
        let Part::Share { outcomes, .. } = &session.part else { return Ok(Bytes::default()) };
        let bytes = postcard::to_stdvec(&Outcomes::from_numbered(outcomes));
        bytes.map(Bytes).map_err(|error| Error::Other(format!("outcomes: {error}")))
    }

    /// Reports the outcomes of all parts to the strategy, which makes the next generation.
    ///
    /// # Errors
    /// [`Error::Usage`] for invalid or missing outcomes.
    pub(crate) fn tell(&mut self, evaluator: &mut dyn Evaluator, parts: &[Bytes]) -> Result<EvolvedGeneration, Error> {
        let invalid = |why: &str| Error::Usage(format!("outcomes: {why}"));
        let mut numbered = Vec::new();
        for bytes in parts {
            let outcomes: Outcomes = postcard::from_bytes(&bytes.0).map_err(|error| invalid(&error.to_string()))?;
            numbered.extend(outcomes.into_numbered().ok_or_else(|| invalid("a name is missing"))?);
        }
        numbered.sort_by_key(|(number, _)| *number);
        let generation = self.search.search.generation();
        let mut session = Session { evaluator, info: &self.info, genotype: &self.genotype, part: Part::All(numbered) };
        let evaluated = self.search.generation(&mut session, &|| {}, AnyStrategy::tell_unrecorded);
        let GenerationResult { fitness, statistics, each, best, met, normalisation, .. } =
            evaluated.map_err(|error| match error {
                Unfinished::Error(error) => error,
                Unfinished::Stopped => invalid("they are not those of a whole generation"),
            })?;
        let normalisation = normalisation.map(|statistics| statistics.save());
        let champions = best.iter().zip(met).filter_map(|(best, opponents)| {
            let (individual, parameters) = (best.individual, best.genes.decode(&self.genotype)?);
            let (genes, normalisation) = (best.genes.words().map(<[u16]>::to_vec), normalisation.clone());
            Some(PageIndividual { generation, individual, genes, parameters, opponents, normalisation })
        });
        let fitness_of_best = best.first().map_or(Fitness::WORST, |best| best.fitness);
        let champions = match self.champions.take() {
            Some(previous) if self.search.search.champion_is_best_ever() && fitness_of_best <= previous.0 => previous,
            _ => (fitness_of_best, champions.collect()),
        };
        let line = Line::new(&statistics, fitness.len(), &each);
        Ok(EvolvedGeneration { generation, line, champions: self.champions.insert(champions).1.clone() })
    }
}

/// Evaluated part of a generation.
enum Part {
    /// Every `parts`-th evaluation from number `part`, with its outcomes.
    Share { part: usize, parts: usize, outcomes: Vec<(usize, Option<Outcome>)> },
    /// Outcomes of the whole generation, in order.
    All(Vec<(usize, Option<Outcome>)>),
}

/// Evaluates a part of a generation, or returns the given outcomes of all.
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
        let (part, parts, outcomes) = match &mut self.part {
            Part::All(numbered) if numbered.iter().map(|(number, _)| *number).eq(0..count) => {
                return Ok(std::mem::take(numbered).into_iter().map(|(_, outcome)| outcome).collect());
            }
            Part::All(_) => return Err(Unfinished::Stopped),
            Part::Share { part, parts, outcomes } => (*part, *parts, outcomes),
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
        *outcomes = ended;
        // A part is never a whole generation.
        Err(Unfinished::Stopped)
    }
}
