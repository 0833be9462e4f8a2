//! MAP-Elites.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::archives::archive::Archive;
use crate::archives::emitter::Emitter;
use crate::archives::grid_cells::Cells;
use crate::archives::improvement::Improvement;
use crate::error::{EvoError, check_setting};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::real::bounds::{check_bounds, draw_within, reflect};
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Collection, Genealogy, Member, Strategy, next_scored};

/// Configuration of [`MapElites`](crate::archives::MapElites), except for the cells.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapElitesConfig {
    /// Range of each gene \[genes\] from low to high, within -1e100 to 1e100. You can freeze a gene by giving it equal
    /// ends. Note that this does not work with the improvement emitter, which needs a range.
    pub bounds: Vec<[f64; 2]>,
    /// Emitters that make the individuals of a generation, in this order.
    pub emitters: Vec<Emitter>,
}

impl MapElitesConfig {
    /// Creates a configuration with 100 individuals of the iso-line emitter and the deviations of \[Mouret2018\]. The
    /// number of individuals is our choice.
    pub fn new(bounds: Vec<[f64; 2]>) -> Self {
        Self { bounds, emitters: Vec::from([Emitter::IsoLine { batch: 100, iso_sigma: 0.01, line_sigma: 0.2 }]) }
    }

    /// Creates a configuration of CMA-ME with the given number of improvement emitters of \[Fontaine2020\]. All of them
    /// start in the middle of the bounds, with the given batch of individuals and a step size in the unit of the genes.
    pub fn cma_me(bounds: Vec<[f64; 2]>, emitters: usize, batch: usize, sigma: f64) -> Self {
        let mean: Vec<f64> = bounds.iter().map(|[low, high]| 0.5 * (low + high)).collect();
        let emitters = (0..emitters).map(|_| Emitter::Improvement { batch, mean: mean.clone(), sigma }).collect();
        Self { bounds, emitters }
    }

    /// Number of individuals in a generation, summed over all emitters.
    pub fn population(&self) -> usize {
        self.emitters.iter().fold(0, |sum: usize, emitter| sum.saturating_add(emitter.batch()))
    }

    /// Checks that all settings are within their allowed ranges.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for no emitters or wrong sizes, [`EvoError::OutOfRange`] for other numbers.
    pub fn validate(&self) -> Result<(), EvoError> {
        check_bounds(self.population(), &self.bounds)?;
        self.emitters.iter().try_for_each(|emitter| emitter.check(&self.bounds))?;
        if self.emitters.iter().any(|emitter| matches!(emitter, Emitter::Improvement { .. })) {
            Population::check(self.bounds.len(), self.bounds.len())?;
            for &[low, high] in &self.bounds {
                check_setting(low < high, "the high end of a gene", high, "above its low end")?;
            }
        }
        Ok(())
    }
}

/// The MAP-Elites algorithm. It keeps the best individual of each cell of behaviors in an archive, and emitters make
/// new individuals from this archive. If you use improvement emitters, this is CMA-ME.
///
/// Scores consist of one objective and the measures that the cells require. Individuals of a generation are added in
/// the order of their index. An individual replaces the elite of its cell only if it is better, not if it is equally
/// good. Failed evaluations are never added, and no individual is evaluated again. Champions are the best individuals
/// of a generation by the objective.
///
/// Individual `i` of generation `g` draws from the stream (seed, [`Domain::Mutation`], trial 0, `i`, `g`). The draws are
/// its elite, the second elite for the iso-line emitter, one normal number for the line, then a row of normal numbers.
/// While the archive is empty it draws from (seed, [`Domain::InitialGenome`], trial 0, `i`, `g`). Emitter `e` chooses the
/// elite of a new start with (seed, [`Domain::Mutation`], trial 1, `e`, `g`).
///
/// Sources: \[Mouret2015\], \[Vassiliades2018\], \[Mouret2018\], \[Fontaine2020\]. Deviations: whole generations are added,
/// where the sources add each individual before the next is made. Every emitter works in every generation, where CMA-ME
/// chooses the one with the fewest individuals. See also [`Emitter`].
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::archives::{GridCells, MapElites, MapElitesConfig};
///
/// // Two genes that add up to as little as can be, for each place of the first.
/// let cells = GridCells::new(vec![[-1.0, 1.0]], vec![20])?;
/// let mut search = MapElites::new(MapElitesConfig::new(vec![[-1.0, 1.0]; 2]), cells, 1)?;
/// search.evolve(30, |genes, row| row.copy_from_slice(&[-(genes[0] + genes[1]).abs(), genes[0]]))?;
/// assert_eq!(search.archive().len(), 20);
/// assert!(search.archive().elites().all(|elite| elite.objective > -0.05));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MapElites<C> {
    config: MapElitesConfig,
    seed: u64,
    generation: u32,
    archive: Archive<C>,
    /// The state of each emitter that has one.
    improvements: Vec<Option<Improvement>>,
    /// The generation and the individual of each individual's elites, empty without elites.
    parents: Vec<[Option<[u32; 2]>; 2]>,
    population: Population<f64>,
}

impl<C: Cells + Clone> MapElites<C> {
    /// Creates a new search with an empty archive of these cells.
    ///
    /// # Errors
    /// Returns the errors of [`MapElitesConfig::validate`] and of [`Archive::new`].
    pub fn new(config: MapElitesConfig, cells: C, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        let archive = Archive::new(cells, config.bounds.len())?;
        let population = Population::new(config.population(), config.bounds.len())?;
        let improvement = |emitter: &Emitter| match emitter {
            Emitter::Improvement { batch, mean, sigma } => {
                Some(Improvement::new(mean.clone(), *sigma, *batch, &config.bounds))
            }
            _ => None,
        };
        let improvements = config.emitters.iter().map(improvement).collect();
        let parents = vec![[None; 2]; population.len()];
        let mut search = Self { config, seed, generation: 0, archive, improvements, parents, population };
        search.make();
        Ok(search)
    }

    /// Gets the configuration that this search was created with.
    pub fn config(&self) -> &MapElitesConfig {
        &self.config
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Gets the archive, which is the main result of this search.
    pub fn archive(&self) -> &Archive<C> {
        &self.archive
    }

    /// Computes how many bytes a [saved](Snapshot::save) state can take at most. This is the size when every cell has
    /// an elite.
    pub fn largest_state(&self) -> usize {
        self.state_length(self.archive.cells().cells())
    }

    /// Bytes of a state with the given number of elites.
    fn state_length(&self, elites: usize) -> usize {
        let distributions = self.improvements.iter().flatten().count();
        let own = 4 + distributions * Improvement::state_length(self.config.bounds.len());
        self.archive.state_length(elites).saturating_add(own)
    }

    /// Makes the individuals of this generation.
    fn make(&mut self) {
        let (seed, generation, genes) = (self.seed, self.generation, self.config.bounds.len());
        let Self { config, archive, improvements, parents, population, .. } = self;
        parents.fill([None; 2]);
        let empty = archive.is_empty();
        let domain = if empty { Domain::InitialGenome } else { Domain::Mutation };
        let (mut rest, mut first) = (population.as_mut_slice(), 0);
        for (emitter, improvement) in config.emitters.iter().zip(improvements) {
            let (own, behind) = core::mem::take(&mut rest).split_at_mut(emitter.batch() * genes);
            let stream = |individual: usize| Stream::new(seed, domain, 0, (first + individual) as u32, generation);
            if let Some(improvement) = improvement {
                improvement.sample(stream, own, &config.bounds);
            } else {
                for (individual, row) in own.chunks_exact_mut(genes).enumerate() {
                    if empty {
                        draw_within(row, &config.bounds, &mut stream(individual));
                    } else {
                        let named = vary(emitter, archive, row, &config.bounds, &mut stream(individual));
                        parents[first + individual] = named;
                    }
                }
            }
            (rest, first) = (behind, first + emitter.batch());
        }
    }
}

/// Makes an individual from elites and returns their generations and indices.
fn vary<C: Cells>(
    emitter: &Emitter,
    archive: &Archive<C>,
    row: &mut [f64],
    bounds: &[[f64; 2]],
    stream: &mut Stream,
) -> [Option<[u32; 2]>; 2] {
    let choose = |stream: &mut Stream| archive.slot(stream.below(archive.len() as u32) as usize);
    let Some(elite) = choose(stream) else { return [None; 2] };
    let origin = Some([elite.generation, elite.individual as u32]);
    let (sigma, second, along) = match *emitter {
        Emitter::IsoLine { iso_sigma, line_sigma, .. } => {
            let second = choose(stream);
            let [normal, _] = stream.normal_pair_f64();
            (iso_sigma, second, line_sigma * normal)
        }
        Emitter::Gaussian { sigma, .. } | Emitter::Improvement { sigma, .. } => (sigma, None, 0.0),
    };
    stream.fill_normal(row);
    // x = a + sigma_1 range N + sigma_2 N' (b - a). Without b the difference is 0. [Mouret2018].
    let line = second.map_or(elite.genes, |second| second.genes);
    for (((gene, own), other), &[low, high]) in row.iter_mut().zip(elite.genes).zip(line).zip(bounds) {
        *gene = reflect(own + sigma * (high - low) * *gene + along * (other - own), [low, high]);
    }
    [origin, second.map(|second| [second.generation, second.individual as u32])]
}

impl<C: Cells + Clone> Strategy<f64> for MapElites<C> {
    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population<f64> {
        &self.population
    }

    fn score_shape(&self) -> ScoreShape {
        ScoreShape::new(1, self.archive.cells().measures())
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        self.tell_scores(&Scores::from_fitness(fitness))
    }

    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        let generation = next_scored(self.generation, self.population.len(), self.score_shape(), scores)?;
        let mut additions = Vec::with_capacity(self.population.len());
        let mut objectives = Vec::with_capacity(self.population.len());
        for (individual, genes) in self.population.iter().enumerate() {
            let objective = scores.objectives(individual).first().copied().unwrap_or(f64::NEG_INFINITY);
            let origin = [self.generation, individual as u32];
            objectives.push(objective);
            additions.push(self.archive.insert(genes, objective, scores.measures(individual), origin));
        }
        let mut first = 0;
        for (number, emitter) in self.config.emitters.iter().enumerate() {
            let own = first..first + emitter.batch();
            first = own.end;
            let Some(improvement) = self.improvements.get_mut(number).and_then(Option::as_mut) else { continue };
            if improvement.tell(&objectives[own.clone()], &additions[own]) {
                // Trial 1, because individuals draw from trial 0.
                let mut stream = Stream::new(self.seed, Domain::Mutation, 1, number as u32, generation);
                let elite = self.archive.slot(stream.below(self.archive.len() as u32) as usize);
                let mean = match (elite, emitter) {
                    (Some(elite), _) => elite.genes,
                    (None, Emitter::Improvement { mean, .. }) => mean,
                    (None, _) => continue,
                };
                improvement.restart(mean);
            }
        }
        self.generation = generation;
        self.make();
        Ok(())
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }

    fn collection(&self) -> Option<&dyn Collection> {
        Some(self)
    }

    /// The number of elites, and the sum of their objectives.
    fn diagnostics(&self) -> Vec<f64> {
        vec![self.archive.len() as f64, self.archive.sum()]
    }
}

/// The elites of the archive, in the order in which their cells were filled.
impl<C: Cells> Collection for MapElites<C> {
    fn members(&self) -> Vec<Member<'_>> {
        self.archive.members().collect()
    }
}

/// Elites of earlier generations have no index in the previous one, and samples of a distribution have no parents.
impl<C: Cells + Clone> Genealogy for MapElites<C> {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        let named = self.parents.get(individual).into_iter().flatten().flatten();
        let latest = named.filter(|[generation, _]| generation.checked_add(1) == Some(self.generation));
        let mut parents: Vec<usize> = latest.map(|[_, individual]| *individual as usize).collect();
        parents.dedup();
        parents
    }
}

impl<C: Cells + Clone> Snapshot for MapElites<C> {
    /// An improvement emitter may draw an individual a hundred times, each time in n^2 operations. Its state has n^2
    /// numbers too, so it is stored at most every n generations.
    fn snapshot_interval(&self) -> u32 {
        let improvements = self.config.emitters.iter().filter(|emitter| matches!(emitter, Emitter::Improvement { .. }));
        let individuals: usize = improvements.map(Emitter::batch).sum();
        let genes = self.config.bounds.len();
        let operations = (individuals as u64).saturating_mul((genes as u64).saturating_pow(2));
        let told = 200_000_000_u64.checked_div(operations).unwrap_or(u64::MAX).max(genes as u64);
        u32::try_from(told).unwrap_or(u32::MAX)
    }

    fn save(&self) -> Vec<u8> {
        let mut state = Vec::with_capacity(self.state_length(self.archive.len()));
        state.extend(self.generation.to_le_bytes());
        self.archive.save(&mut state);
        self.improvements.iter().flatten().for_each(|improvement| improvement.save(&mut state));
        state
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let mut header = StateReader::new(state, state.len())?;
        // The length of a state depends on its number of elites.
        let (_, elites) = (header.u32()?, header.u32()? as usize);
        let mut reader = StateReader::new(state, self.state_length(elites))?;
        let generation = reader.u32()?;
        let archive = self.archive.read(&mut reader, &self.config.bounds)?;
        let mut improvements = self.improvements.clone();
        improvements.iter_mut().flatten().try_for_each(|improvement| improvement.restore(&mut reader))?;
        (self.generation, self.archive, self.improvements) = (generation, archive, improvements);
        self.make();
        Ok(())
    }
}
