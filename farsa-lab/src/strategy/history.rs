//! Genomes and champions of past generations.

use std::ops::Range;
use std::path::PathBuf;

use farsa_evo::{ObservationStatistics, Population, Record};

use crate::error::Error;
use crate::strategy::any_strategy::{AnyStrategy, Genome, Genomes};

/// Makes the strategy of a run, at its first generation.
pub(crate) type Fresh<'h> = Box<dyn Fn() -> Result<AnyStrategy, Error> + 'h>;

/// Finished generations of a run, and their file.
pub(crate) struct History<'h> {
    path: PathBuf,
    past: Past<'h>,
    /// Statistics of the observations before each generation, if observations are normalized.
    observations: Vec<ObservationStatistics>,
    /// Generation whose best is the run's champion, where that is not the last one's.
    champion: Option<u32>,
}

/// Source of the genomes.
enum Past<'h> {
    /// Reported fitness.
    RunRecord { record: Record, fresh: Fresh<'h> },
    /// External genomes as the only generation: one population after the other, of equal size.
    Imported { genomes: Vec<Vec<u16>>, populations: usize },
}

impl<'h> History<'h> {
    /// Creates the history of a run from its record.
    pub(crate) fn new(path: PathBuf, record: Record, fresh: Fresh<'h>) -> Self {
        Self { path, past: Past::RunRecord { record, fresh }, observations: Vec::new(), champion: None }
    }

    /// Sets the observations before each generation.
    pub(crate) fn with_observations(self, observations: Vec<ObservationStatistics>) -> Self {
        Self { observations, ..self }
    }

    /// Sets the generation whose best is the run's champion.
    pub(crate) fn with_champion(self, champion: Option<u32>) -> Self {
        Self { champion, ..self }
    }

    /// Gets the generation whose best is the run's champion, by default the last finished one.
    pub(crate) fn champion_generation(&self) -> u32 {
        self.champion.unwrap_or(self.finished().saturating_sub(1))
    }

    /// By what observations were normalised in a generation, where they were.
    pub(crate) fn normalisation(&self, generation: u32) -> Option<&ObservationStatistics> {
        self.observations.get(generation as usize)
    }

    /// Imported genomes, those of one population after the other.
    pub(crate) fn from_imported(path: PathBuf, genomes: Vec<Vec<u16>>, populations: usize) -> Self {
        let past = Past::Imported { genomes, populations: populations.max(1) };
        Self { path, past, observations: Vec::new(), champion: None }
    }

    /// Number of finished generations.
    pub(crate) fn finished(&self) -> u32 {
        match &self.past {
            Past::RunRecord { record, .. } => record.generations(),
            Past::Imported { .. } => 1,
        }
    }

    /// Gets the number of populations.
    pub(crate) fn populations(&self) -> usize {
        match &self.past {
            Past::RunRecord { record, .. } => record.populations(),
            Past::Imported { populations, .. } => *populations,
        }
    }

    /// Individuals of each population.
    pub(crate) fn size(&self) -> usize {
        match &self.past {
            Past::RunRecord { record, .. } => record.size(),
            Past::Imported { genomes, populations } => genomes.len() / populations,
        }
    }

    /// Finds the best individual of a population in a finished generation, counted through all populations.
    pub(crate) fn champion(&self, population: usize, generation: u32) -> Option<usize> {
        match &self.past {
            Past::RunRecord { record, .. } => record.champion(population, generation),
            Past::Imported { .. } => {
                (generation == 0 && population < self.populations()).then_some(population * self.size())
            }
        }
    }

    /// Visits the genomes of finished generations, given in rising order. `visit` receives the index in that order.
    ///
    /// # Errors
    /// [`Error::File`] for a generation that is not finished, and when the record is not one of this strategy.
    pub(crate) fn visit(
        &self,
        generations: impl IntoIterator<Item = u32>,
        mut visit: impl FnMut(u32, &Genomes) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let damaged = |error| Error::damaged(&self.path, error);
        match &self.past {
            Past::RunRecord { record, fresh } => {
                let mut strategy = fresh()?;
                for generation in generations {
                    let population = strategy.genomes(record, generation).map_err(damaged)?;
                    visit(generation, &population)?;
                }
            }
            Past::Imported { genomes, .. } => {
                let genes = genomes.first().map_or(0, Vec::len);
                let mut population = Population::new(genomes.len(), genes).map_err(damaged)?;
                for (own, genome) in population.iter_mut().zip(genomes) {
                    if genome.len() != genes {
                        return Err(self.missing(0));
                    }
                    own.copy_from_slice(genome);
                }
                let population = Genomes::Words(population);
                for generation in generations {
                    if generation > 0 {
                        return Err(self.missing(generation));
                    }
                    visit(generation, &population)?;
                }
            }
        }
        Ok(())
    }

    /// Rebuilds the genomes of individuals of finished generations, in the order asked for.
    ///
    /// # Errors
    /// As [`visit`](Self::visit), and for an individual that does not exist.
    pub(crate) fn genomes(&self, wanted: &[(u32, usize)]) -> Result<Vec<Genome>, Error> {
        let mut generations: Vec<u32> = wanted.iter().map(|(generation, _)| *generation).collect();
        generations.sort_unstable();
        generations.dedup();
        let mut genomes: Vec<Genome> = vec![Genome::Words(Vec::new()); wanted.len()];
        self.visit(generations, |generation, population| {
            for (genome, (_, individual)) in genomes.iter_mut().zip(wanted).filter(|(_, (own, _))| *own == generation) {
                *genome = population.get(*individual).ok_or_else(|| self.missing(generation))?;
            }
            Ok(())
        })?;
        Ok(genomes)
    }

    /// The genomes that an individual of a finished generation met in each of some trials, where the strategy chose them.
    ///
    /// # Errors
    /// As [`visit`](Self::visit).
    pub(crate) fn opponents_of(
        &self,
        generation: u32,
        individual: usize,
        trials: Range<u32>,
    ) -> Result<Option<Vec<Vec<Genome>>>, Error> {
        let Past::RunRecord { record, fresh } = &self.past else { return Ok(None) };
        let mut search = fresh()?;
        if search.opponents().is_none() {
            return Ok(None);
        }
        search.rebuild(record, generation).map_err(|error| Error::damaged(&self.path, error))?;
        Ok(trials.map(|trial| search.opponents_of(individual, trial)).collect())
    }

    /// Builds the error about a generation or individual that does not exist.
    pub(crate) fn missing(&self, generation: u32) -> Error {
        Error::damaged(&self.path, format!("an individual of generation {generation} is missing"))
    }
}
