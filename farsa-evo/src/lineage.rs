//! Who descends from whom: enough to rebuild every genome of a run.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::config::GaConfig;
use crate::error::EvoError;
use crate::mutation::{BitMutation, randomize_bits};
use crate::population::Population;

/// The configuration, the seed and the selected parents of every generation of a [`TruncationGa`](crate::TruncationGa).
///
/// Mutation draws from a stream per child, so this is all it takes to rebuild any genome without evaluating anything.
/// It only grows: 4 bytes a parent and generation.
///
/// Child `i` of a generation descends from the parent of rank `i / copies` of the generation before, `copies` being
/// population / parents; it is unchanged when `i % copies == 0` and mutated otherwise, with the numbers of the stream
/// (seed, [`Domain::Mutation`], trial 0, individual `i`, generation of the child). Individual `i` of generation 0 is
/// drawn from (seed, [`Domain::InitialGenome`], trial 0, `i`, 0).
///
/// ```
/// use farsa_evo::{GaConfig, Lineage, Strategy, TruncationGa};
///
/// let mut evolution = TruncationGa::new(GaConfig { population: 6, parents: 2, ..GaConfig::new(3) }, 5)?;
/// let first = evolution.ask().clone();
/// evolution.tell_values(&[0.0, 3.0, 1.0, 9.0, 2.0, 2.0])?;
/// let lineage: &Lineage = evolution.lineage();
/// assert_eq!(lineage.selected(0), Some(&[3, 1][..]));
/// assert_eq!((lineage.parent_of(1, 0), lineage.parent_of(1, 5)), (Some(3), Some(1)));
/// assert_eq!(lineage.genome_of(1, 0)?, first.get(3).expect("of six"));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawLineage"))]
pub struct Lineage {
    config: GaConfig,
    seed: u64,
    /// Individuals selected from each generation, best first [generations x parents].
    selected: Vec<u32>,
    /// Which of several populations of a run this is, told again by whoever reads it: the trial of its streams.
    #[cfg_attr(feature = "serde", serde(skip))]
    number: u32,
}

impl Lineage {
    /// The lineage of a run that has only its initial generation.
    ///
    /// # Errors
    /// Those of [`GaConfig::validate`].
    pub fn new(config: GaConfig, seed: u64) -> Result<Self, EvoError> {
        config.validate()?;
        Ok(Self { config, seed, selected: Vec::new(), number: 0 })
    }

    /// The same selections in another of several populations.
    pub(crate) fn numbered(self, number: u32) -> Self {
        Self { number, ..self }
    }

    /// Records the individuals \[parents\] selected from the latest generation, best first, which makes the next one.
    ///
    /// # Errors
    /// [`EvoError::SelectedCount`], [`EvoError::NoSuchIndividual`], [`EvoError::SelectedTwice`] or
    /// [`EvoError::LastGeneration`]; the lineage is then unchanged.
    pub fn record(&mut self, selected: &[u32]) -> Result<(), EvoError> {
        self.check(selected)?;
        self.latest().checked_add(1).ok_or(EvoError::LastGeneration)?;
        self.selected.extend_from_slice(selected);
        Ok(())
    }

    fn check(&self, selected: &[u32]) -> Result<(), EvoError> {
        if selected.len() != self.config.parents {
            return Err(EvoError::SelectedCount { expected: self.config.parents, found: selected.len() });
        }
        let mut seen = BTreeSet::new();
        for individual in selected.iter().map(|&index| index as usize) {
            self.check_individual(individual)?;
            if !seen.insert(individual) {
                return Err(EvoError::SelectedTwice { individual });
            }
        }
        Ok(())
    }

    fn check_individual(&self, individual: usize) -> Result<(), EvoError> {
        let population = self.config.population;
        if individual < population { Ok(()) } else { Err(EvoError::NoSuchIndividual { individual, population }) }
    }

    fn check_generation(&self, generation: u32) -> Result<(), EvoError> {
        let latest = self.latest();
        if generation <= latest { Ok(()) } else { Err(EvoError::NoSuchGeneration { generation, latest }) }
    }

    /// The configuration of the run.
    pub fn config(&self) -> &GaConfig {
        &self.config
    }

    /// The seed of the run.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The number of the latest generation whose genomes are known, 0 when nothing is recorded.
    pub fn latest(&self) -> u32 {
        (self.selected.len() / self.config.parents) as u32
    }

    /// The individuals \[parents\] selected from a generation, best first; none for the latest and what lies ahead.
    pub fn selected(&self, generation: u32) -> Option<&[u32]> {
        self.selected.chunks_exact(self.config.parents).nth(generation as usize)
    }

    /// The index, in the generation before, of an individual's parent; none in generation 0 and for what does not
    /// exist.
    pub fn parent_of(&self, generation: u32, individual: usize) -> Option<usize> {
        self.check_individual(individual).ok()?;
        let selected = self.selected(generation.checked_sub(1)?)?;
        selected.get(individual / self.config.copies()).map(|&parent| parent as usize)
    }

    /// The genomes of a generation [individuals x genes].
    ///
    /// Only their ancestors are rebuilt: after the first tens of generations back, one or two each.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`].
    pub fn genomes_at(&self, generation: u32) -> Result<Population, EvoError> {
        self.check_generation(generation)?;
        let everyone = (0..self.config.population).collect();
        let mut population = Population::new(self.config.population, self.config.genes)?;
        for (genome, rebuilt) in population.iter_mut().zip(self.rebuild(generation, everyone)?.values()) {
            genome.copy_from_slice(rebuilt);
        }
        Ok(population)
    }

    /// The genome \[genes\] of one individual of a generation.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`] or [`EvoError::NoSuchIndividual`].
    pub fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        self.check_generation(generation)?;
        self.check_individual(individual)?;
        let mut genomes = self.rebuild(generation, BTreeSet::from([individual]))?;
        genomes.remove(&individual).ok_or(EvoError::NoSuchIndividual { individual, population: self.config.population })
    }

    /// The genomes of some individuals of a generation, by their index: back to their first ancestors, then forward.
    fn rebuild(&self, generation: u32, wanted: BTreeSet<usize>) -> Result<BTreeMap<usize, Vec<u16>>, EvoError> {
        let mut ancestors = vec![wanted];
        for time in (1..=generation).rev() {
            let parents = ancestors.last().into_iter().flatten().filter_map(|&child| self.parent_of(time, child));
            ancestors.push(parents.collect());
        }
        let mutation = self.config.bit_mutation()?;
        let mut genomes = BTreeMap::new();
        for (time, alive) in (0..=generation).zip(ancestors.into_iter().rev()) {
            let mut next = BTreeMap::new();
            for individual in alive {
                let parent = self.parent_of(time, individual).and_then(|parent| genomes.get(&parent));
                let mut genes = parent.cloned().unwrap_or_else(|| vec![0; self.config.genes]);
                self.vary(mutation, time, individual, &mut genes);
                next.insert(individual, genes);
            }
            genomes = next;
        }
        Ok(genomes)
    }

    /// Turns the genes \[genes\] of its parent into those of an individual: drawn, kept or mutated.
    pub(crate) fn vary(&self, mutation: BitMutation, generation: u32, individual: usize, genes: &mut [u16]) {
        let stream = |domain| Stream::new(self.seed, domain, self.number, individual as u32, generation);
        if generation == 0 {
            randomize_bits(genes, self.config.gene_bits, &mut stream(Domain::InitialGenome));
        } else if !individual.is_multiple_of(self.config.copies()) {
            mutation.apply(genes, &mut stream(Domain::Mutation));
        }
    }
}

/// A lineage as it is read, before anything in it is believed.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "Lineage")]
struct RawLineage {
    config: GaConfig,
    seed: u64,
    selected: Vec<u32>,
}

#[cfg(feature = "serde")]
impl TryFrom<RawLineage> for Lineage {
    type Error = EvoError;

    fn try_from(raw: RawLineage) -> Result<Self, EvoError> {
        let mut lineage = Self::new(raw.config, raw.seed)?;
        for selected in raw.selected.chunks(lineage.config.parents) {
            lineage.record(selected)?;
        }
        Ok(lineage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn small() -> Lineage {
        let config = GaConfig { population: 6, parents: 3, mutation_rate: 0.1, ..GaConfig::new(4) };
        Lineage::new(config, 5).unwrap()
    }

    #[test]
    fn children_lie_in_the_order_of_their_parents_rank() {
        let mut lineage = small();
        lineage.record(&[4, 0, 5]).unwrap();
        let parents: Vec<_> = (0..7).map(|child| lineage.parent_of(1, child)).collect();
        assert_eq!(parents, [Some(4), Some(4), Some(0), Some(0), Some(5), Some(5), None]);
        assert_eq!((lineage.parent_of(0, 0), lineage.parent_of(2, 0)), (None, None));
        assert_eq!((lineage.selected(0), lineage.selected(1)), (Some(&[4, 0, 5][..]), None));
    }

    #[test]
    fn one_individual_comes_out_as_among_all() {
        let mut lineage = small();
        for selected in [[4, 0, 5], [1, 2, 3], [5, 3, 0], [0, 1, 2]] {
            lineage.record(&selected).unwrap();
        }
        for generation in 0..=4 {
            let all = lineage.genomes_at(generation).unwrap();
            for (individual, genome) in all.iter().enumerate() {
                assert_eq!(lineage.genome_of(generation, individual).unwrap(), genome);
            }
        }
    }

    #[test]
    fn what_did_not_happen_is_refused() {
        let mut lineage = small();
        assert_eq!(lineage.record(&[0, 1]), Err(EvoError::SelectedCount { expected: 3, found: 2 }));
        assert_eq!(lineage.record(&[0, 6, 1]), Err(EvoError::NoSuchIndividual { individual: 6, population: 6 }));
        assert_eq!(lineage.record(&[2, 1, 2]), Err(EvoError::SelectedTwice { individual: 2 }));
        assert_eq!(lineage, small());
        let ahead = EvoError::NoSuchGeneration { generation: 1, latest: 0 };
        assert_eq!(lineage.genomes_at(1), Err(ahead));
        assert_eq!(lineage.genome_of(1, 0), Err(ahead));
        assert_eq!(lineage.genome_of(0, 6), Err(EvoError::NoSuchIndividual { individual: 6, population: 6 }));
    }
}
