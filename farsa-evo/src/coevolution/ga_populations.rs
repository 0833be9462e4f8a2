//! Several populations that evolve beside each other, each selected within itself.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::SavedStrategy;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Genealogy, RecordKind, Strategy, next_generation};
use crate::words::GaConfig;
use crate::words::TruncationGa;

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
/// use farsa_evo::Strategy;
/// use farsa_evo::coevolution::Coevolution;
/// use farsa_evo::words::GaConfig;
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
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::SavedStrategy<Vec<GaConfig>>"))]
pub struct Coevolution {
    /// At least two.
    members: Vec<TruncationGa>,
    population: Population,
}

impl Coevolution {
    /// A co-evolution of populations with these configurations \[populations\], at its random initial generation.
    ///
    /// # Errors
    /// [`EvoError::FewPopulations`], [`EvoError::UnequalPopulations`], [`EvoError::TooLarge`] and those of
    /// [`GaConfig::validate`].
    pub fn new(configs: &[GaConfig], seed: u64) -> Result<Self, EvoError> {
        let [first, _, ..] = configs else {
            return Err(EvoError::FewPopulations { populations: configs.len() });
        };
        configs.iter().try_for_each(GaConfig::validate)?;
        let first = first.population;
        if let Some((population, other)) = configs.iter().enumerate().find(|(_, other)| other.population != first) {
            return Err(EvoError::UnequalPopulations { first, population, individuals: other.population });
        }
        let longest = configs.iter().map(|config| config.genes).max().unwrap_or(0);
        Population::check(first.saturating_mul(configs.len()), longest)?;
        let members = configs.iter().zip(0..).map(|(config, number)| TruncationGa::numbered(*config, seed, number));
        let members = members.collect::<Result<Vec<_>, _>>()?;
        let population = together(&members.iter().map(Strategy::ask).collect::<Vec<_>>())?;
        Ok(Self { members, population })
    }

    /// Number of individuals of each population.
    pub fn size(&self) -> usize {
        self.population.len() / self.members.len()
    }

    /// The configuration of each population.
    pub fn configs(&self) -> impl Iterator<Item = &GaConfig> {
        self.members.iter().map(TruncationGa::config)
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.members.first().map_or(0, TruncationGa::seed)
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

    fn populations(&self) -> usize {
        self.members.len()
    }

    fn record_kind(&self) -> RecordKind {
        RecordKind::Order
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        Some(self)
    }
}

impl Genealogy for Coevolution {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        let (size, population) = (self.size(), individual / self.size());
        let own = self.members.get(population).map(|member| member.parents_of(individual % size));
        own.unwrap_or_default().into_iter().map(|parent| population * size + parent).collect()
    }
}

impl Snapshot for Coevolution {
    /// The states of the populations, each with its length in front.
    fn save(&self) -> Vec<u8> {
        let mut all = Vec::new();
        for state in self.members.iter().map(Snapshot::save) {
            all.extend((state.len() as u64).to_le_bytes());
            all.extend(state);
        }
        all
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let mut members = self.members.clone();
        let mut rest = state;
        for member in &mut members {
            let expected = StateReader::new(rest, rest.len())?.u64()?;
            let short =
                EvoError::StateLength { expected: usize::try_from(expected).unwrap_or(usize::MAX), found: rest.len() };
            let own = rest.get(8..).and_then(|rest| rest.split_at_checked(usize::try_from(expected).ok()?));
            let (own, behind) = own.ok_or(short)?;
            member.restore(own)?;
            rest = behind;
        }
        if !rest.is_empty() {
            return Err(EvoError::StateLength { expected: state.len() - rest.len(), found: state.len() });
        }
        let generation = members.first().map_or(0, Strategy::generation);
        if let Some(other) = members.iter().find(|member| member.generation() != generation) {
            return Err(EvoError::StateContent {
                what: "the generation of a population",
                found: other.generation().into(),
            });
        }
        self.population = together(&members.iter().map(Strategy::ask).collect::<Vec<_>>())?;
        self.members = members;
        Ok(())
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Coevolution {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let configs: Vec<GaConfig> = self.configs().copied().collect();
        SavedStrategy::new(configs, self.seed(), self).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<SavedStrategy<Vec<GaConfig>>> for Coevolution {
    type Error = EvoError;

    fn try_from(saved: SavedStrategy<Vec<GaConfig>>) -> Result<Self, EvoError> {
        let product = |config: &GaConfig| config.population.saturating_mul(config.genes);
        saved.holds(saved.config.iter().map(product).fold(0, usize::saturating_add), 1)?;
        let mut strategy = Self::new(&saved.config, saved.seed)?;
        strategy.restore(&saved.state)?;
        Ok(strategy)
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
        let mut record = crate::Record::new(&mut all).unwrap();
        let mut alone = configs().map(|config| TruncationGa::new(config, 5).unwrap());
        assert_eq!((all.ask().len(), all.ask().genome_len(), all.size(), all.populations()), (18, 7, 6, 3));
        for generation in 0..12 {
            for (individual, genome) in all.ask().iter().enumerate() {
                let own = alone[individual / 6].ask().get(individual % 6).unwrap();
                assert_eq!(&genome[..own.len()] == own, individual < 6, "{individual} of {generation}");
                assert!(genome[configs()[individual / 6].genes..].iter().all(|&gene| gene == 0));
            }
            let fitness = told(generation, 18);
            record.tell(&mut all, &fitness).unwrap();
            alone.iter_mut().zip(fitness.chunks(6)).for_each(|(ga, fitness)| ga.tell(fitness).unwrap());
            assert_eq!(all.generation(), generation + 1);
            for (population, ga) in alone.iter().enumerate() {
                let first = ga.selected()[0] as usize;
                assert_eq!(record.champion(population, generation), Some(6 * population + first));
                assert_eq!(all.parents_of(6 * population + 4), [6 * population + ga.parents_of(4)[0]]);
            }
        }
        assert_eq!(record.champion(3, 0), None);
        assert!(all.parents_of(18).is_empty());
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        let [a, b, c] = configs();
        assert_eq!(Coevolution::new(&[a], 1), Err(EvoError::FewPopulations { populations: 1 }));
        let other = GaConfig { population: 9, ..c };
        let unequal = EvoError::UnequalPopulations { first: 6, population: 2, individuals: 9 };
        assert_eq!(Coevolution::new(&[a, b, other], 1), Err(unequal));
        assert_eq!(Coevolution::new(&[a, GaConfig { genes: 0, ..b }], 1), Err(EvoError::NoGenes));
        let mut all = Coevolution::new(&[a, b], 1).unwrap();
        let before = all.clone();
        assert_eq!(all.tell(&told(0, 6)), Err(EvoError::FitnessCount { expected: 12, found: 6 }));
        assert_eq!(all, before);
    }
}
