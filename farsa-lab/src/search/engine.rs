//! How a run searches: the strategies of farsa-evo behind one face.

use farsa_evo::{
    Coevolution, EvoError, Fitness, Lineage, Lineages, OnePlusOne, OnePlusOneHistory, Population, Statistics, Strategy,
    TruncationGa,
};

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::search_kind::Search;
use crate::experiment::settings::Settings;
use crate::search::evolution;
use crate::search::learning::{Learning, Lessons};

/// An experiment that learns has no learner.
const NO_LEARNER: &str = "an experiment that learns without a learner";

/// A search under way.
#[derive(Debug, Clone)]
pub(crate) enum Evolution {
    Truncation(TruncationGa),
    OnePlusOne(OnePlusOne),
    Several(Coevolution),
    Learning(Learning),
}

impl Evolution {
    /// The search that an experiment of this name asks for, at its first generation.
    ///
    /// # Errors
    /// [`Error::Setting`] when settings do not go together, [`Error::Other`] for genomes that cannot be.
    pub(crate) fn new(
        name: &str,
        search: Search,
        settings: &Settings,
        seed: u64,
        gene_bits: u32,
        evaluator: &mut dyn Evaluator,
    ) -> Result<Self, Error> {
        let refused = |error: EvoError| Error::Other(format!("{name}: {error}"));
        let (populations, genes) = (evaluator.populations().len(), evaluator.parameters().len());
        match (search, populations) {
            (_, 0) => Err(Error::Other(format!("{name}: no population"))),
            (Search::OnePlusOne, 1) => {
                let config = evolution::one_plus_one(settings, genes, gene_bits)?;
                OnePlusOne::new(config, seed).map(Self::OnePlusOne).map_err(refused)
            }
            (Search::OnePlusOne, _) => {
                Err(Error::Other(format!("{name}: a steady-state search of several populations")))
            }
            (Search::Learning, 1) => {
                let learner = evaluator.learner().ok_or_else(|| Error::Other(NO_LEARNER.into()))?;
                Learning::new(learner, seed).map(Self::Learning).map_err(refused)
            }
            (Search::Learning, _) => Err(Error::Other(format!("{name}: several populations that learn"))),
            (Search::Truncation, populations) => {
                let config = evolution::config(settings, genes, gene_bits)?;
                if populations == 1 {
                    TruncationGa::new(config, seed).map(Self::Truncation).map_err(refused)
                } else {
                    Coevolution::new(&vec![config; populations], seed).map(Self::Several).map_err(refused)
                }
            }
        }
    }

    /// Whether another search is of the same kind with the same configuration.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Truncation(a), Self::Truncation(b)) => a.config() == b.config(),
            (Self::OnePlusOne(a), Self::OnePlusOne(b)) => a.config() == b.config(),
            (Self::Several(a), Self::Several(b)) => a.configs().eq(b.configs()),
            (Self::Learning(a), Self::Learning(b)) => a.is_like(b),
            _ => false,
        }
    }

    /// The generation that waits for its fitness.
    pub(crate) fn generation(&self) -> u32 {
        match self {
            Self::Truncation(ga) => ga.generation(),
            Self::OnePlusOne(search) => search.generation(),
            Self::Several(all) => all.generation(),
            Self::Learning(learning) => learning.generation(),
        }
    }

    /// Everyone of the generation that waits for its fitness.
    pub(crate) fn ask(&self) -> &Population {
        match self {
            Self::Truncation(ga) => ga.ask(),
            Self::OnePlusOne(search) => search.ask(),
            Self::Several(all) => all.ask(),
            Self::Learning(learning) => learning.ask(),
        }
    }

    /// Populations that evolve beside each other.
    pub(crate) fn populations(&self) -> usize {
        if let Self::Several(all) = self { all.populations() } else { 1 }
    }

    /// Takes the fitness of the current generation and makes the next, by a lesson of `evaluator` where it learns.
    ///
    /// # Errors
    /// The search's words, should it refuse.
    pub(crate) fn tell(&mut self, fitness: &[Fitness], evaluator: &mut dyn Evaluator, seed: u64) -> Result<(), String> {
        let told = match self {
            Self::Truncation(ga) => ga.tell(fitness),
            Self::OnePlusOne(search) => search.tell(fitness),
            Self::Several(all) => all.tell(fitness),
            Self::Learning(learning) => return learning.study(evaluator.learner().ok_or(NO_LEARNER)?, seed),
        };
        told.map_err(|error| error.to_string())
    }

    /// The fitness that individuals are ranked by, if this is what they earned: for the parent of a steady-state search
    /// the mean over its life.
    pub(crate) fn judged(&self, fitness: &[Fitness]) -> Result<Vec<Fitness>, EvoError> {
        match self {
            Self::OnePlusOne(search) => search.judged(fitness).map(Into::into),
            Self::Truncation(_) | Self::Several(_) | Self::Learning(_) => Ok(fitness.into()),
        }
    }

    /// The best individual of each population by the fitness that they are ranked by.
    pub(crate) fn champions(&self, judged: &[Fitness]) -> Vec<usize> {
        match self {
            // Ties go to the mutant.
            Self::OnePlusOne(_) => vec![usize::from(judged.get(1) >= judged.first())],
            Self::Truncation(_) | Self::Several(_) | Self::Learning(_) => {
                let size = (judged.len() / self.populations()).max(1);
                let best = |fitness: &[Fitness]| {
                    Statistics::from_fitness(fitness).map_or(0, |statistics| statistics.best_index)
                };
                judged.chunks(size).enumerate().map(|(population, own)| population * size + best(own)).collect()
            }
        }
    }

    /// The statistics of each of several populations; none of a single one.
    pub(crate) fn of_each(&self, judged: &[Fitness]) -> Vec<Statistics> {
        let size = (judged.len() / self.populations()).max(1);
        let each = judged.chunks(size).filter(|_| self.populations() > 1);
        each.filter_map(Statistics::from_fitness).collect()
    }

    /// Who descends from whom so far.
    pub(crate) fn descent(&self) -> Descent {
        match self {
            Self::Truncation(ga) => Descent::Truncation(ga.lineage().clone()),
            Self::OnePlusOne(search) => Descent::OnePlusOne(search.history().clone()),
            Self::Several(all) => Descent::Several(all.lineages()),
            Self::Learning(learning) => Descent::Learned(learning.lessons().clone()),
        }
    }
}

/// What the genomes of a run are rebuilt from.
#[derive(Debug, Clone)]
pub(crate) enum Descent {
    Truncation(Lineage),
    OnePlusOne(OnePlusOneHistory),
    Several(Lineages),
    Learned(Lessons),
    /// Genomes from elsewhere, as the only generation: those of one population after the other, as many of each.
    Imported {
        genomes: Vec<Vec<u16>>,
        populations: usize,
    },
}

impl Descent {
    /// Number of finished generations.
    pub(crate) fn finished(&self) -> u32 {
        match self {
            Self::Truncation(lineage) => lineage.latest(),
            Self::OnePlusOne(history) => history.latest(),
            Self::Several(lineages) => lineages.latest(),
            Self::Learned(lessons) => lessons.taken(),
            Self::Imported { .. } => 1,
        }
    }

    /// Populations that evolve beside each other.
    pub(crate) fn populations(&self) -> usize {
        match self {
            Self::Several(lineages) => lineages.populations(),
            Self::Imported { populations, .. } => (*populations).max(1),
            Self::Truncation(_) | Self::OnePlusOne(_) | Self::Learned(_) => 1,
        }
    }

    /// Individuals of each population.
    pub(crate) fn size(&self) -> usize {
        match self {
            Self::Truncation(lineage) => lineage.config().population,
            Self::OnePlusOne(_) => OnePlusOneHistory::INDIVIDUALS,
            Self::Several(lineages) => lineages.size(),
            Self::Learned(_) => 1,
            Self::Imported { genomes, .. } => genomes.len() / self.populations(),
        }
    }

    /// The best individual of a population in a finished generation, counted through all populations.
    pub(crate) fn champion(&self, population: usize, generation: u32) -> Option<usize> {
        let first = |selected: Option<&[u32]>| selected.and_then(<[u32]>::first).map(|&individual| individual as usize);
        match self {
            Self::Truncation(lineage) => first(lineage.selected(generation)),
            Self::OnePlusOne(history) => history.survivor(generation),
            Self::Several(lineages) => {
                Some(population * lineages.size() + first(lineages.selected(population, generation))?)
            }
            Self::Learned(lessons) => (generation < lessons.taken()).then_some(0),
            Self::Imported { .. } => (generation == 0).then_some(population * self.size()),
        }
    }

    /// The genome of an individual.
    pub(crate) fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        match self {
            Self::Truncation(lineage) => lineage.genome_of(generation, individual),
            Self::OnePlusOne(history) => history.genome_of(generation, individual),
            Self::Several(lineages) => lineages.genome_of(generation, individual),
            Self::Learned(lessons) => lessons.genome_of(generation, individual),
            Self::Imported { genomes, .. } => {
                let beyond = EvoError::NoSuchIndividual { individual, population: genomes.len() };
                genomes.get(individual).cloned().ok_or(beyond)
            }
        }
    }
}
