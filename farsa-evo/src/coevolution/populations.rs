//! A group of searches of the same kind, one for each population.

use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::error::EvoError;
use crate::fitness::Fitness;
use crate::gene::Gene;
use crate::population::Population;
#[cfg(feature = "serde")]
use crate::saved::SavedStrategy;
use crate::score_shape::ScoreShape;
use crate::scores::Scores;
use crate::snapshot::{Snapshot, StateReader};
use crate::strategy::{Collection, Genealogy, Member, RecordKind, Strategy, next_generation};
use crate::words::{GaConfig, TruncationGa};

/// Two or more searches of the same kind and number of individuals. Each takes the fitness, or the scores, of one population.
///
/// All individuals are in one [`Population`], one search after the other. Individual `i` of population `p` is number `p *
/// size + i`. Genomes are as long as the longest, and shorter ones end in zeros. The caller pairs individuals for
/// evaluation.
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::coevolution::Populations;
/// use farsa_evo::covariance::{CmaEs, CmaEsConfig};
///
/// let search = |seed| CmaEs::new(CmaEsConfig::new(vec![0.0; 3], 0.5), seed);
/// let mut pair = Populations::new(2, 11, search)?;
/// assert_eq!((pair.populations(), pair.size()), (2, 7));
/// for _ in 0..60 {
///     let size = pair.size();
///     let aim = |i: usize| if i < size { 1.0 } else { -1.0 };
///     let error = |(i, x): (usize, &[f64])| -x.iter().map(|x| (x - aim(i)) * (x - aim(i))).sum::<f64>();
///     let values: Vec<f64> = pair.ask().iter().enumerate().map(error).collect();
///     pair.tell_values(&values)?;
/// }
/// assert!((pair.members()[1].mean()[0] + 1.0).abs() < 0.01);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::saved::SavedStrategy<Vec<GaConfig>>"))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "Self: TryFrom<SavedStrategy<Vec<GaConfig>>, Error = EvoError>"))
)]
pub struct Populations<S, G = f64> {
    /// At least two, of the same number of individuals.
    members: Vec<S>,
    kind: RecordKind,
    population: Population<G>,
}

impl Populations<TruncationGa, u16> {
    /// Starts populations of integer genes with these configurations \[populations\], which may differ in all but the number
    /// of individuals.
    ///
    /// All have the same seed. Population `p` draws from the streams of a [`TruncationGa`] with trial `p` instead of 0.
    ///
    /// ```
    /// use farsa_evo::Strategy;
    /// use farsa_evo::coevolution::Populations;
    /// use farsa_evo::words::GaConfig;
    ///
    /// // Predators of five genes and prey of three.
    /// let config = |genes| GaConfig { population: 20, parents: 4, ..GaConfig::new(genes) };
    /// let search = Populations::truncation(&[config(5), config(3)], 11)?;
    /// assert_eq!((search.populations(), search.size(), search.ask().genome_len()), (2, 20, 5));
    /// # Ok::<(), farsa_evo::EvoError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for fewer than two populations, unequal sizes or too many genes, and the errors of
    /// [`GaConfig::validate`].
    pub fn truncation(configs: &[GaConfig], seed: u64) -> Result<Self, EvoError> {
        let [GaConfig { population: first, .. }, _, ..] = *configs else {
            return Err(EvoError::few_populations(configs.len()));
        };
        configs.iter().try_for_each(GaConfig::validate)?;
        if let Some(population) = configs.iter().position(|config| config.population != first) {
            return Err(EvoError::unequal_populations(first, population, configs[population].population));
        }
        let longest = configs.iter().map(|config| config.genes).max().unwrap_or(0);
        Population::check(first.saturating_mul(configs.len()), longest)?;
        let members = configs.iter().zip(0..).map(|(config, number)| TruncationGa::numbered(*config, seed, number));
        Self::gathered(members.collect::<Result<_, _>>()?, RecordKind::Order)
    }

    /// An iterator over the configurations of the populations.
    pub fn configs(&self) -> impl Iterator<Item = &GaConfig> {
        self.members.iter().map(TruncationGa::config)
    }

    /// Gets the seed that this search was created with.
    pub fn seed(&self) -> u64 {
        self.members.first().map_or(0, TruncationGa::seed)
    }
}

impl<G: Gene, S: Strategy<G> + Snapshot> Populations<S, G> {
    /// Starts the given number of searches that `search` makes of their seeds. The first has `seed`. The seed of number `p` is
    /// drawn from the stream (`seed`, [`Domain::General`], trial 0, `p`, generation 0).
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for fewer than two populations, unequal sizes or too many genes.
    /// [`EvoError::Shape`] for genomes of unequal lengths. The errors of `search`.
    pub fn new(populations: usize, seed: u64, search: impl Fn(u64) -> Result<S, EvoError>) -> Result<Self, EvoError> {
        if populations < 2 {
            return Err(EvoError::few_populations(populations));
        }
        let first = search(seed)?;
        let (size, genes) = (first.ask().len(), first.ask().genome_len());
        Population::check(size.saturating_mul(populations), genes)?;
        let mut members = Vec::with_capacity(populations);
        members.push(first);
        for number in 1..populations {
            let mut stream = Stream::new(seed, Domain::General, 0, number as u32, 0);
            let member = search(u64::from(stream.next_u32()) | u64::from(stream.next_u32()) << 32)?;
            let (individuals, length) = (member.ask().len(), member.ask().genome_len());
            if individuals != size {
                return Err(EvoError::unequal_populations(size, number, individuals));
            }
            if length != genes {
                return Err(EvoError::lengths(length, genes, genes));
            }
            members.push(member);
        }
        // Values even where a search depends on their order alone. Records of this kind have always contained them.
        let kind = match members.first().map(Strategy::record_kind) {
            Some(RecordKind::Genomes) => RecordKind::Genomes,
            _ => RecordKind::Values,
        };
        Self::gathered(members, kind)
    }

    fn gathered(members: Vec<S>, kind: RecordKind) -> Result<Self, EvoError> {
        let individuals = members.iter().map(|member| member.ask().len()).sum();
        let longest = members.iter().map(|member| member.ask().genome_len()).max().unwrap_or(0);
        let mut populations = Self { members, kind, population: Population::new(individuals, longest)? };
        populations.gather();
        Ok(populations)
    }

    /// Gets all searches, one for each population.
    pub fn members(&self) -> &[S] {
        &self.members
    }

    /// Number of individuals in each population.
    pub fn size(&self) -> usize {
        self.population.len() / self.members.len()
    }

    /// Copies the genomes of all searches. Zeros after a shorter genome stay.
    fn gather(&mut self) {
        let genomes = self.members.iter().flat_map(|member| member.ask().iter());
        for (copy, genome) in self.population.iter_mut().zip(genomes) {
            copy.iter_mut().zip(genome).for_each(|(copy, gene)| *copy = *gene);
        }
    }
}

impl<G: Gene, S: Strategy<G> + Snapshot> Strategy<G> for Populations<S, G> {
    fn generation(&self) -> u32 {
        self.members.first().map_or(0, Strategy::generation)
    }

    fn ask(&self) -> &Population<G> {
        &self.population
    }

    fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
        // Checked for all first, so that no search can return an error after another has changed.
        self.score_shape().check(ScoreShape::FITNESS)?;
        next_generation(self.generation(), self.population.len(), fitness)?;
        let size = self.size();
        for (member, fitness) in self.members.iter_mut().zip(fitness.chunks(size)) {
            member.tell(fitness)?;
        }
        self.gather();
        Ok(())
    }

    fn score_shape(&self) -> ScoreShape {
        self.members.first().map_or(ScoreShape::FITNESS, Strategy::score_shape)
    }

    fn tell_scores(&mut self, scores: &Scores) -> Result<(), EvoError> {
        scores.check(self.score_shape(), self.population.len())?;
        self.generation().checked_add(1).ok_or(EvoError::LastGeneration)?;
        let numbers = self.size() * scores.shape().width();
        for (member, own) in self.members.iter_mut().zip(scores.values().chunks(numbers)) {
            member.tell_scores(&Scores::nan_as_failed(scores.shape(), own.to_vec())?)?;
        }
        self.gather();
        Ok(())
    }

    fn populations(&self) -> usize {
        self.members.len()
    }

    fn record_kind(&self) -> RecordKind {
        self.kind
    }

    fn ranked_by(&self, fitness: &[Fitness]) -> Vec<Fitness> {
        let own = self.members.iter().zip(fitness.chunks(self.size()));
        own.flat_map(|(member, fitness)| member.ranked_by(fitness)).collect()
    }

    fn champions(&self, ranked_by: &[Fitness]) -> Vec<usize> {
        let size = self.size();
        let own = self.members.iter().zip(ranked_by.chunks(size)).enumerate();
        own.flat_map(|(number, (member, fitness))| {
            member.champions(fitness).into_iter().map(move |best| number * size + best)
        })
        .collect()
    }

    fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
        Some(self)
    }

    fn genealogy(&self) -> Option<&dyn Genealogy> {
        self.members.first()?.genealogy().map(|_| self as &dyn Genealogy)
    }

    fn collection(&self) -> Option<&dyn Collection> {
        self.members.first()?.collection().map(|_| self as &dyn Collection)
    }

    /// Never, because fitness may depend on the opponents of an individual.
    fn champion_is_best_ever(&self) -> bool {
        false
    }

    /// The numbers of one search after the other.
    fn diagnostics(&self) -> Vec<f64> {
        self.members.iter().flat_map(Strategy::diagnostics).collect()
    }
}

impl<G: Gene, S: Strategy<G> + Snapshot> Collection for Populations<S, G> {
    fn members(&self) -> Vec<Member<'_>> {
        let (size, mut all) = (self.size(), Vec::new());
        for (number, member) in self.members.iter().enumerate() {
            let own = member.collection().map(Collection::members).unwrap_or_default();
            let counted = |member: Member<'_>| member.individual + number * size;
            all.extend(own.into_iter().map(|member| Member { individual: counted(member), ..member }));
        }
        all
    }
}

impl<G: Gene, S: Strategy<G> + Snapshot> Genealogy for Populations<S, G> {
    fn parents_of(&self, individual: usize) -> Vec<usize> {
        let (size, number) = (self.size(), individual / self.size());
        let own = self.members.get(number).and_then(|member| Some(member.genealogy()?.parents_of(individual % size)));
        own.unwrap_or_default().into_iter().map(|parent| number * size + parent).collect()
    }
}

impl<G: Gene, S: Strategy<G> + Snapshot> Snapshot for Populations<S, G> {
    fn snapshot_interval(&self) -> u32 {
        self.members.iter().map(Snapshot::snapshot_interval).min().unwrap_or(u32::MAX)
    }

    /// Returns the state of each search after its length, a `u64`.
    fn save(&self) -> Vec<u8> {
        let mut all = Vec::new();
        for state in self.members.iter().map(Snapshot::save) {
            all.extend((state.len() as u64).to_le_bytes());
            all.extend(state);
        }
        all
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
        // Earlier searches return to their states when a later state is invalid.
        let before: Vec<Vec<u8>> = self.members.iter().map(Snapshot::save).collect();
        let restored = self.restore_members(state);
        if restored.is_err() {
            for (member, state) in self.members.iter_mut().zip(&before) {
                member.restore(state)?;
            }
        }
        self.gather();
        restored
    }
}

impl<G: Gene, S: Strategy<G> + Snapshot> Populations<S, G> {
    fn restore_members(&mut self, state: &[u8]) -> Result<(), EvoError> {
        let mut rest = state;
        for member in &mut self.members {
            let expected = StateReader::new(rest, rest.len())?.u64()?;
            let expected = usize::try_from(expected).unwrap_or(usize::MAX);
            let short = || EvoError::state_length(expected, rest.len());
            let own = rest.get(8..).and_then(|rest| rest.split_at_checked(expected));
            let (own, behind) = own.ok_or_else(short)?;
            member.restore(own)?;
            rest = behind;
        }
        if !rest.is_empty() {
            return Err(EvoError::state_length(state.len() - rest.len(), state.len()));
        }
        // Searches advance together, so all states have the same generation.
        let generation = self.generation();
        match self.members.iter().find(|member| member.generation() != generation) {
            None => Ok(()),
            Some(other) => Err(EvoError::state_content("the generation of a population", other.generation().into())),
        }
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Populations<TruncationGa, u16> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.kind != RecordKind::Order {
            return Err(serde::ser::Error::custom("populations with different seeds cannot be serialized"));
        }
        let configs: Vec<GaConfig> = self.configs().copied().collect();
        SavedStrategy::new(configs, self.seed(), self).serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<SavedStrategy<Vec<GaConfig>>> for Populations<TruncationGa, u16> {
    type Error = EvoError;

    fn try_from(saved: SavedStrategy<Vec<GaConfig>>) -> Result<Self, EvoError> {
        let product = |config: &GaConfig| config.population.saturating_mul(config.genes);
        saved.holds(saved.config.iter().map(product).fold(0, usize::saturating_add), 1)?;
        let mut strategy = Self::truncation(&saved.config, saved.seed)?;
        strategy.restore(&saved.state)?;
        Ok(strategy)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::conformance::check_strategy;
    use crate::covariance::{CmaEs, CmaEsConfig};
    use crate::real::{RealGa, RealGaConfig};
    use crate::words::{GaConfig, TruncationGa};

    fn searches() -> Populations<CmaEs> {
        Populations::new(3, 5, |seed| CmaEs::new(CmaEsConfig::new(vec![0.0; 4], 0.5), seed)).unwrap()
    }

    fn told(generation: u32, count: usize) -> Vec<Fitness> {
        (0..count).map(|i| Fitness::nan_as_failed(f64::from((i as u32 * 7 + generation * 5) % 11))).collect()
    }

    #[test]
    fn each_is_a_lone_search_of_its_own_seed() {
        let mut all = searches();
        let seeds = all.members().iter().map(CmaEs::seed).collect::<Vec<_>>();
        assert_eq!(seeds[0], 5);
        assert!(seeds[1] != seeds[2] && seeds[1] != 5 && seeds[2] != 5);
        let alone = |seed: &u64| CmaEs::new(CmaEsConfig::new(vec![0.0; 4], 0.5), *seed).unwrap();
        let mut alone: Vec<CmaEs> = seeds.iter().map(alone).collect();
        let size = all.size();
        for generation in 0..20 {
            for (number, member) in alone.iter().enumerate() {
                for (i, genome) in member.ask().iter().enumerate() {
                    assert_eq!(all.ask().get(number * size + i), Some(genome));
                }
            }
            let fitness = told(generation, all.ask().len());
            let champions = all.champions(&all.ranked_by(&fitness));
            for (number, (member, fitness)) in alone.iter_mut().zip(fitness.chunks(size)).enumerate() {
                assert_eq!(champions[number], number * size + member.champions(fitness)[0]);
                member.tell(fitness).unwrap();
            }
            all.tell(&fitness).unwrap();
        }
    }

    #[test]
    fn they_keep_to_what_strategies_say() {
        check_strategy(|| Ok(searches()), 12).unwrap();
        let config = GaConfig { population: 10, parents: 5, ..GaConfig::new(4) };
        check_strategy::<u16, _>(|| Populations::new(2, 3, |seed| TruncationGa::new(config, seed)), 12).unwrap();
        let config = RealGaConfig::new(vec![[-1.0, 1.0]; 3]);
        let three = || Populations::new(3, 3, |seed| RealGa::new(config.clone(), seed));
        check_strategy(three, 12).unwrap();
        let mut three = three().unwrap();
        three.tell(&told(0, 300)).unwrap();
        for individual in [0, 99, 150, 200, 250, 299] {
            let (number, own) = (individual / 100, individual % 100);
            let parents = three.parents_of(individual);
            let wanted: Vec<usize> =
                three.members[number].parents_of(own).into_iter().map(|parent| 100 * number + parent).collect();
            assert!(!parents.is_empty() && parents == wanted, "{parents:?}");
            // It has parents where its searches do.
            let said = Strategy::genealogy(&three).map(|genealogy| genealogy.parents_of(individual));
            assert_eq!(said, Some(parents));
        }
        assert!(three.parents_of(300).is_empty());
        assert!(Strategy::genealogy(&searches()).is_none());
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        let search = |seed| CmaEs::new(CmaEsConfig::new(vec![0.0; 4], 0.5), seed);
        assert_eq!(Populations::new(1, 5, search), Err(EvoError::few_populations(1)));
        let sized = |seed| {
            let population = if seed == 5 { 10 } else { 12 };
            CmaEs::new(CmaEsConfig { population, ..CmaEsConfig::new(vec![0.0; 4], 0.5) }, seed)
        };
        let unequal = EvoError::unequal_populations(10, 1, 12);
        assert_eq!(Populations::new(2, 5, sized), Err(unequal));
        let long = |seed| {
            CmaEs::new(
                CmaEsConfig { population: 9, ..CmaEsConfig::new(vec![0.0; 4 + usize::from(seed != 5)], 0.5) },
                seed,
            )
        };
        assert_eq!(Populations::new(2, 5, long), Err(EvoError::lengths(5, 4, 4)));
        let mut all = searches();
        let before = all.clone();
        let expected = all.ask().len();
        assert_eq!(all.tell(&told(0, 6)), Err(EvoError::fitness_count(expected, 6)));
        assert_eq!(all, before);
    }

    #[test]
    fn damaged_states_are_refused_whole() {
        let mut all = searches();
        let fresh = all.save();
        all.tell(&told(0, all.ask().len())).unwrap();
        let (before, state) = (all.clone(), all.save());
        let other = [&fresh[..fresh.len() / 3], &state[fresh.len() / 3..]].concat();
        let cut = (0..state.len()).step_by(7).map(|length| state[..length].to_vec());
        let long = [&state[..], &[0]].concat();
        for damaged in cut.chain([long, other]) {
            assert!(all.restore(&damaged).is_err());
            assert_eq!(all, before);
        }
        all.restore(&fresh).unwrap();
        assert_eq!(all, searches());
    }

    fn configs() -> [GaConfig; 3] {
        let small = GaConfig { population: 6, parents: 3, mutation_rate: 0.1, ..GaConfig::new(4) };
        [small, GaConfig { genes: 7, parents: 2, ..small }, GaConfig { gene_bits: 8, ..small }]
    }

    #[test]
    fn population_0_is_a_lone_truncation_ga_and_no_other_is() {
        let mut all = Populations::truncation(&configs(), 5).unwrap();
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
    fn truncation_populations_of_unequal_sizes_are_refused() {
        let [a, b, c] = configs();
        assert_eq!(Populations::truncation(&[a], 1), Err(EvoError::few_populations(1)));
        let other = GaConfig { population: 9, ..c };
        let unequal = EvoError::unequal_populations(6, 2, 9);
        assert_eq!(Populations::truncation(&[a, b, other], 1), Err(unequal));
        assert_eq!(Populations::truncation(&[a, GaConfig { genes: 0, ..b }], 1), Err(EvoError::no_genes()));
        let mut all = Populations::truncation(&[a, b], 1).unwrap();
        let before = all.clone();
        assert_eq!(all.tell(&told(0, 6)), Err(EvoError::fitness_count(12, 6)));
        assert_eq!(all, before);
    }
}
