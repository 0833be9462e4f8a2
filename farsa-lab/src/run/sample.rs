//! Genomes of a measurement.

use crate::error::Error;
use crate::run::plan::Plan;
use crate::run::record_file::history;
use crate::store::directory::Directory;
use crate::strategy::opponents::{HallOfFame, Pairing};

/// Evaluated genomes.
pub(crate) struct Sample {
    /// Parameters of each individual.
    pub(super) parameters: Vec<Vec<f32>>,
    /// Parameters of their opponents, in the order of the evaluations.
    pub(super) opponents: Vec<Vec<f32>>,
    pub(super) populations: usize,
    /// Seed and generation of their trials. Later rounds increase the generation.
    pub(super) seed: u64,
    pub(super) generation: u32,
    /// Run of the genomes, if they are not random.
    pub(super) run: Option<String>,
}

impl Sample {
    /// Takes the first generation of a run of this plan.
    pub(crate) fn random(plan: &Plan<'_>) -> Result<Self, Error> {
        let strategy = plan.strategy()?;
        let populations = strategy.populations();
        let parameters = strategy.parameters(&plan.genotype(plan.evaluator()?.as_ref()));
        Self::new(plan, parameters, populations, &HallOfFame::default(), 0, 0)
    }

    /// Takes the last finished generation of a run, or its first.
    ///
    /// The values of the run may be those of another version, because its genomes are evaluated and not replayed.
    pub(crate) fn from_run(plan: &Plan<'_>, directory: &Directory) -> Result<Self, Error> {
        let (_, history, path) = history(plan, directory)?;
        let finished = history.finished();
        let run = Some(directory.path().display().to_string());
        let Some(generation) = finished.checked_sub(1) else {
            return Ok(Self { run, ..Self::random(plan)? });
        };
        let evaluator = plan.evaluator()?;
        let genotype = plan.genotype(evaluator.as_ref());
        let hall = HallOfFame::before(&history, &genotype)?;
        let mut sample = None;
        history.visit([generation], |generation, genomes| {
            let parameters = genomes.decode_all(&genotype);
            if parameters.is_none() {
                return Err(Error::damaged(&path, "its genomes are not those of the experiment"));
            }
            sample = Some(Self::new(plan, parameters, history.populations(), &hall, finished, generation)?);
            Ok(())
        })?;
        let sample = sample.ok_or_else(|| history.missing(generation))?;
        Ok(Self { run, ..sample })
    }

    /// Several populations are evaluated against the available champions and against each other.
    fn new(
        plan: &Plan<'_>,
        parameters: Option<Vec<Vec<f32>>>,
        populations: usize,
        hall: &HallOfFame,
        finished: u32,
        generation: u32,
    ) -> Result<Self, Error> {
        let lost = |why: &str| Error::Other(format!("the opponents of {}: {why}", plan.name()));
        let evaluator = plan.evaluator()?;
        let parameters = parameters.ok_or_else(|| lost("genomes of another length"))?;
        let (trials, size) = (evaluator.info().trials, parameters.len() / populations);
        let meeting = Pairing { generation: finished, populations, size, trials };
        let opponents = hall.opponents(meeting, &parameters).ok_or_else(|| lost("one is missing"))?;
        let opponents = opponents.into_iter().map(<[f32]>::to_vec).collect();
        Ok(Self { parameters, opponents, populations, seed: plan.seed, generation, run: None })
    }
}
