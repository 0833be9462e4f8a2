//! State of a search: strategy, opponents and observations. It is equal on every rank of a run.

use farsa_evo::{EvoError, Fitness, ObservationStatistics, Scores, Statistics};

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::run::evaluation_backend::{EvaluationBackend, Unfinished};
use crate::run::fitness::{Generation, Judged, Opponents, judgements_of_all};
use crate::run::records::Best;
use crate::store::failures::FailedEvaluation;
use crate::strategy::any_strategy::AnyStrategy;
use crate::strategy::opponents::{HallOfFame, Pairing, chosen};

/// State of a search.
pub(crate) struct SearchState {
    pub(crate) search: AnyStrategy,
    /// Opponents from previous generations, for several populations.
    hall: HallOfFame,
    /// Observation statistics of all generations so far, where observations are normalized.
    pub(crate) observed: Option<ObservationStatistics>,
    seed: u64,
}

/// Result of a generation.
pub(crate) struct GenerationResult {
    /// Reported fitness of every individual.
    pub(crate) fitness: Vec<Fitness>,
    pub(crate) failed: Vec<FailedEvaluation>,
    /// Statistics of all individuals, and of each population where there are several.
    pub(crate) statistics: Statistics,
    pub(crate) each: Vec<Statistics>,
    /// Best of each population.
    pub(crate) best: Vec<Best>,
    /// Parameters of the opponents of each of these in each trial.
    pub(crate) met: Vec<Vec<Vec<Vec<f32>>>>,
    /// Normalization of its observations, where there is one.
    pub(crate) normalisation: Option<ObservationStatistics>,
}

impl SearchState {
    /// Creates the state of a search.
    pub(crate) fn new(
        search: AnyStrategy,
        hall: HallOfFame,
        observed: Option<ObservationStatistics>,
        seed: u64,
    ) -> Self {
        Self { search, hall, observed, seed }
    }

    /// Gets the champions that are still opponents.
    pub(crate) fn hall(&self) -> &HallOfFame {
        &self.hall
    }

    /// Evaluates a generation and reports its scores to the strategy by `tell`, which makes the next one. `advance` is called
    /// after each individual.
    ///
    /// # Errors
    /// [`Unfinished`]. The search is then unchanged.
    pub(crate) fn generation(
        &mut self,
        by: &mut dyn EvaluationBackend,
        advance: &(dyn Fn() + Sync),
        tell: impl FnOnce(&mut AnyStrategy, &Scores) -> Result<(), EvoError>,
    ) -> Result<GenerationResult, Unfinished> {
        let generation = self.search.generation();
        let individuals = self.search.individuals();
        let (seed, populations) = (self.seed, self.search.populations());
        let lost = |why: &str| Error::Other(format!("generation {generation}: {why}"));
        let trials = by.info().trials;
        let parameters = self.search.parameters(by.genotype()).ok_or_else(|| lost("genomes of another length"))?;
        let meeting = Pairing { generation, populations, size: individuals / populations, trials };
        let told_apart = self.search.opponents();
        let chosen = told_apart.and_then(|_| chosen(&self.search, by.genotype(), trials));
        let opponents = match (told_apart, &chosen) {
            (None, _) => self.hall.opponents(meeting, &parameters),
            (Some(_), chosen) => chosen.as_ref().map(|all| all.iter().map(Vec::as_slice).collect()),
        };
        let opponents = opponents.ok_or_else(|| lost("an opponent is missing"))?;
        let id = EpisodeId { seed, generation, ..EpisodeId::default() };
        let opponents = Opponents { parameters: &opponents, each: populations - 1, told_apart };
        let shape = self.search.score_shape();
        let normalisation = self.observed.clone();
        let batch =
            Generation { parameters: &parameters, opponents, normalisation: normalisation.as_ref(), id, stop: None };
        let Judged { judgements, failed, observed } = judgements_of_all(by, batch, shape, advance)?;
        let fitness = judgements.fitness();
        let ranked_by = self.search.ranked_by(&fitness);
        let statistics = Statistics::from_fitness(&ranked_by).ok_or_else(|| lost("no individual was evaluated"))?;
        let best = self.search.champions(&ranked_by).into_iter().map(|best| {
            let (fitness, genes) = (*ranked_by.get(best)?, self.search.genome(best)?);
            Some(Best { individual: best as u32, fitness, genes })
        });
        let best: Vec<Best> = best.collect::<Option<_>>().ok_or_else(|| lost("no individual is the best"))?;
        let met = best.iter().map(|best| {
            let met = |trial| opponents.get(trial * individuals + best.individual as usize);
            (0..trials).map(|trial| met(trial).iter().map(|met| met.to_vec()).collect()).collect()
        });
        let met = met.collect();
        let each = ranked_by.chunks(meeting.size.max(1)).filter(|_| populations > 1);
        let each: Vec<Statistics> = each.filter_map(Statistics::from_fitness).collect();
        let updated = tell(&mut self.search, &judgements);
        updated.map_err(|error| lost(&error.to_string()))?;
        if let (Some(all), Some(own)) = (&mut self.observed, &observed) {
            all.merge(own).map_err(|error| lost(&error.to_string()))?;
        }
        if told_apart.is_none() {
            self.hall.add(best.iter().filter_map(|best| parameters.get(best.individual as usize).cloned()).collect());
        }
        Ok(GenerationResult { fitness, failed, statistics, each, best, met, normalisation })
    }
}
