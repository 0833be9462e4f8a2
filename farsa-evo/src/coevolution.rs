//! Several populations that evolve beside each other, each selected within itself.

use alloc::vec::Vec;

use crate::config::GaConfig;
use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::lineage::Lineage;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::Saved;
use crate::strategy::{Strategy, next_generation};
use crate::truncation::TruncationGa;

/// Two or more populations of the same size, each evolving as a [`TruncationGa`] by the fitness of its own individuals.
///
/// The individuals of all populations stand in one [`Population`], one population after the other: individual `i` of
/// population `p` is number `p * size + i`. Genomes are as long as those of the population with the most genes; the
/// others' end in zeros. Who meets whom is the caller's business.
///
/// Population `p` draws from the streams of a `TruncationGa` with trial `p` in the place of trial 0, so that population 0
/// draws what a `TruncationGa` of the same seed draws.
///
/// ```
/// use farsa_evo::{Coevolution, GaConfig, Strategy};
///
/// // Predators of five genes, prey of three, each judged against the first of the others.
/// let config = |genes| GaConfig { population: 20, parents: 4, ..GaConfig::new(genes) };
/// let mut search = Coevolution::new(&[config(5), config(3)], 11)?;
/// for _ in 0..10 {
///     let (population, size) = (search.ask(), search.size());
///     let [predator, prey] = [0, size].map(|first| population.get(first).expect("an individual")[0]);
///     let catch = |genes: &[u16]| -f64::from(genes[0].abs_diff(prey));
///     let flee = |genes: &[u16]| f64::from(genes[0].abs_diff(predator));
///     let values: Vec<f64> =
///         population.iter().enumerate().map(|(i, genes)| if i < size { catch(genes) } else { flee(genes) }).collect();
///     search.tell_values(&values)?;
/// }
/// assert_eq!((search.generation(), search.populations(), search.ask().genome_len()), (10, 2, 5));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
///
/// Under the feature `serde` it is saved as its lineages and a digest of the current genomes, which are rebuilt when it
/// is read.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::Saved<Lineages>"))]
pub struct Coevolution {
    /// At least two.
    members: Vec<TruncationGa>,
    population: Population,
}

impl Coevolution {
    /// A co-evolution of populations with these configurations \[populations\], at its random initial generation.
    ///
    /// # Errors
    /// Those of [`Lineages::new`].
    pub fn new(configs: &[GaConfig], seed: u64) -> Result<Self, EvoError> {
        Self::resume(Lineages::new(configs, seed)?)
    }

    /// A co-evolution at the latest generation of its lineages, in the same state as the one that recorded them.
    ///
    /// # Errors
    /// None for lineages that were made on this machine.
    pub fn resume(lineages: Lineages) -> Result<Self, EvoError> {
        let members = lineages.of.into_iter().map(TruncationGa::resume).collect::<Result<Vec<_>, _>>()?;
        let population = together(&members.iter().map(Strategy::ask).collect::<Vec<_>>())?;
        Ok(Self { members, population })
    }

    /// Number of populations.
    pub fn populations(&self) -> usize {
        self.members.len()
    }

    /// Number of individuals of each population.
    pub fn size(&self) -> usize {
        self.population.len() / self.members.len()
    }

    /// The configuration of each population.
    pub fn configs(&self) -> impl Iterator<Item = &GaConfig> {
        self.members.iter().map(TruncationGa::config)
    }

    /// The parents of every generation so far, in each population.
    pub fn lineages(&self) -> Lineages {
        Lineages { of: self.members.iter().map(|member| member.lineage().clone()).collect() }
    }
}

/// Puts populations one after the other, with zeros behind the shorter genomes.
fn together(populations: &[&Population]) -> Result<Population, EvoError> {
    let individuals = populations.iter().map(|population| population.len()).sum();
    let longest = populations.iter().map(|population| population.genome_len()).max().unwrap_or(0);
    let mut all = Population::new(individuals, longest)?;
    for (genome, own) in all.iter_mut().zip(populations.iter().flat_map(|population| population.iter())) {
        genome.iter_mut().zip(own).for_each(|(gene, own)| *gene = *own);
    }
    Ok(all)
}

impl Strategy for Coevolution {
    fn generation(&self) -> u32 {
        self.members.first().map_or(0, Strategy::generation)
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        // Checked for all before anybody is told: none of them can refuse afterwards.
        next_generation(self.generation(), self.population.len(), fitness)?;
        let size = self.size();
        for (member, fitness) in self.members.iter_mut().zip(fitness.chunks(size)) {
            member.tell(fitness)?;
        }
        self.population = together(&self.members.iter().map(Strategy::ask).collect::<Vec<_>>())?;
        Ok(())
    }

    fn genomes_at(&self, generation: u32) -> Result<Population, EvoError> {
        let populations =
            self.members.iter().map(|member| member.genomes_at(generation)).collect::<Result<Vec<_>, _>>()?;
        together(&populations.iter().collect::<Vec<_>>())
    }

    fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        let (size, population) = (self.size(), self.population.len());
        let member = self.members.get(individual / size).ok_or(EvoError::NoSuchIndividual { individual, population });
        let mut genes = member?.genome_of(generation, individual % size)?;
        genes.resize(self.population.genome_len(), 0);
        Ok(genes)
    }
}

/// The lineages of co-evolving populations: with them any genome of a [`Coevolution`] is rebuilt.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Vec<Lineage>", into = "Vec<Lineage>"))]
pub struct Lineages {
    of: Vec<Lineage>,
}

impl Lineages {
    /// The lineages of a run that has only its initial generation, for these configurations \[populations\].
    ///
    /// # Errors
    /// [`EvoError::FewPopulations`], [`EvoError::UnequalPopulations`], [`EvoError::TooLarge`] and those of
    /// [`GaConfig::validate`].
    pub fn new(configs: &[GaConfig], seed: u64) -> Result<Self, EvoError> {
        Self::checked(configs.iter().map(|config| Lineage::new(*config, seed)).collect::<Result<_, _>>()?)
    }

    /// Lineages of one run, each told which population it is.
    fn checked(of: Vec<Lineage>) -> Result<Self, EvoError> {
        let [first, _, ..] = of.as_slice() else {
            return Err(EvoError::FewPopulations { populations: of.len() });
        };
        for (population, other) in of.iter().enumerate() {
            let individuals = other.config().population;
            if individuals != first.config().population {
                let first = first.config().population;
                return Err(EvoError::UnequalPopulations { first, population, individuals });
            }
            if (other.seed(), other.latest()) != (first.seed(), first.latest()) {
                return Err(EvoError::OtherRun { population });
            }
        }
        let longest = of.iter().map(|lineage| lineage.config().genes).max().unwrap_or(0);
        Population::check(first.config().population.saturating_mul(of.len()), longest)?;
        Ok(Self { of: of.into_iter().zip(0..).map(|(lineage, number)| lineage.numbered(number)).collect() })
    }

    /// Number of populations.
    pub fn populations(&self) -> usize {
        self.of.len()
    }

    /// Number of individuals of each population.
    pub fn size(&self) -> usize {
        self.of.first().map_or(0, |lineage| lineage.config().population)
    }

    /// The number of the latest generation whose genomes are known, 0 when nothing is recorded.
    pub fn latest(&self) -> u32 {
        self.of.first().map_or(0, Lineage::latest)
    }

    /// The individuals \[parents\] selected from a generation of a population, best first and numbered within it; none for
    /// the latest generation, what lies ahead and what does not exist.
    pub fn selected(&self, population: usize, generation: u32) -> Option<&[u32]> {
        self.of.get(population)?.selected(generation)
    }

    /// The number, in the generation before, of an individual's parent, both counted through all populations; none in
    /// generation 0 and for what does not exist.
    pub fn parent_of(&self, generation: u32, individual: usize) -> Option<usize> {
        let size = self.size();
        let population = individual / size;
        Some(population * size + self.of.get(population)?.parent_of(generation, individual % size)?)
    }

    /// The genome \[genes of the longest\] of an individual of a generation, counted through all populations.
    ///
    /// # Errors
    /// [`EvoError::NoSuchGeneration`] or [`EvoError::NoSuchIndividual`].
    pub fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        let size = self.size();
        let beyond = EvoError::NoSuchIndividual { individual, population: size * self.of.len() };
        let mut genes = self.of.get(individual / size).ok_or(beyond)?.genome_of(generation, individual % size)?;
        genes.resize(self.of.iter().map(|lineage| lineage.config().genes).max().unwrap_or(0), 0);
        Ok(genes)
    }
}

impl From<Lineages> for Vec<Lineage> {
    fn from(lineages: Lineages) -> Self {
        lineages.of
    }
}

impl TryFrom<Vec<Lineage>> for Lineages {
    type Error = EvoError;

    /// The lineages of one run, in the order of its populations.
    ///
    /// # Errors
    /// [`EvoError::FewPopulations`], [`EvoError::UnequalPopulations`], [`EvoError::OtherRun`] or
    /// [`EvoError::TooLarge`].
    fn try_from(of: Vec<Lineage>) -> Result<Self, EvoError> {
        Self::checked(of)
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Coevolution {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Saved::new(self.lineages(), &self.population).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Saved<Lineages>> for Coevolution {
    type Error = EvoError;

    fn try_from(saved: Saved<Lineages>) -> Result<Self, EvoError> {
        let rebuilt = Self::resume(saved.state.clone())?;
        saved.check(&rebuilt.population)?;
        Ok(rebuilt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn configs() -> [GaConfig; 3] {
        let small = GaConfig { population: 6, parents: 3, mutation_rate: 0.1, ..GaConfig::new(4) };
        [small, GaConfig { genes: 7, parents: 2, ..small }, GaConfig { gene_bits: 8, ..small }]
    }

    fn told(generation: u32, count: usize) -> Vec<Fitness> {
        (0..count).map(|i| Fitness::nan_as_failed(f64::from((i as u32 * 7 + generation * 5) % 11))).collect()
    }

    #[test]
    fn population_0_is_a_lone_truncation_ga_and_no_other_is() {
        let mut all = Coevolution::new(&configs(), 5).unwrap();
        let mut alone = configs().map(|config| TruncationGa::new(config, 5).unwrap());
        assert_eq!((all.ask().len(), all.ask().genome_len(), all.size(), all.populations()), (18, 7, 6, 3));
        for generation in 0..12 {
            for (individual, genome) in all.ask().iter().enumerate() {
                assert_eq!(all.genome_of(generation, individual).unwrap(), genome);
                assert_eq!(all.lineages().genome_of(generation, individual).unwrap(), genome);
                let own = alone[individual / 6].ask().get(individual % 6).unwrap();
                assert_eq!(&genome[..own.len()] == own, individual < 6, "{individual} of {generation}");
                assert!(genome[configs()[individual / 6].genes..].iter().all(|&gene| gene == 0));
            }
            let fitness = told(generation, 18);
            all.tell(&fitness).unwrap();
            alone.iter_mut().zip(fitness.chunks(6)).for_each(|(ga, fitness)| ga.tell(fitness).unwrap());
            let lineages = all.lineages();
            assert_eq!((all.generation(), lineages.latest()), (generation + 1, generation + 1));
            assert_eq!((lineages.populations(), lineages.size()), (3, 6));
            for (population, ga) in alone.iter().enumerate() {
                assert_eq!(lineages.selected(population, generation), ga.lineage().selected(generation));
                let parent = ga.lineage().parent_of(generation + 1, 4).unwrap();
                assert_eq!(lineages.parent_of(generation + 1, 6 * population + 4), Some(6 * population + parent));
            }
        }
        let lineages = all.lineages();
        assert_eq!((lineages.selected(3, 0), lineages.parent_of(1, 18)), (None, None));
        let beyond = EvoError::NoSuchIndividual { individual: 18, population: 18 };
        assert_eq!(lineages.genome_of(1, 18), Err(beyond));
        let ahead = EvoError::NoSuchGeneration { generation: 13, latest: 12 };
        assert_eq!(lineages.genome_of(13, 7), Err(ahead));
        assert_eq!(Coevolution::resume(lineages).unwrap(), all);
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        let [a, b, c] = configs();
        assert_eq!(Coevolution::new(&[a], 1), Err(EvoError::FewPopulations { populations: 1 }));
        let other = GaConfig { population: 9, ..c };
        let unequal = EvoError::UnequalPopulations { first: 6, population: 2, individuals: 9 };
        assert_eq!(Coevolution::new(&[a, b, other], 1), Err(unequal));
        assert_eq!(Coevolution::new(&[a, GaConfig { genes: 0, ..b }], 1), Err(EvoError::NoGenes));
        let lineage = |seed| Lineage::new(a, seed).unwrap();
        let apart = Lineages::try_from(alloc::vec![lineage(1), lineage(1), lineage(2)]);
        assert_eq!(apart, Err(EvoError::OtherRun { population: 2 }));
        let mut later = lineage(1);
        later.record(&[0, 1, 2]).unwrap();
        assert_eq!(Lineages::try_from(alloc::vec![lineage(1), later]), Err(EvoError::OtherRun { population: 1 }));
        let mut all = Coevolution::new(&[a, b], 1).unwrap();
        let before = all.clone();
        assert_eq!(all.tell(&told(0, 6)), Err(EvoError::FitnessCount { expected: 12, found: 6 }));
        assert_eq!(all, before);
        assert_eq!(all.genome_of(0, 12), Err(EvoError::NoSuchIndividual { individual: 12, population: 12 }));
    }
}
