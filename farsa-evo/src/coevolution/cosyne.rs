//! Cooperative co-evolution of the weights of a network.

use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::PI;
use core::iter::repeat_n;

use farsa_num::{Domain, Stream, exp, ln, sin_cos};

use crate::error::{EvoError, check_range, check_setting, check_share};
use crate::fitness::Fitness;
use crate::population::Population;
use crate::real::bounds::uniform;
use crate::search::{Algorithm, Search, Step};
use crate::snapshot::{StateReader, push_indices, push_reals};
use crate::strategy::RecordKind;

/// Which weights change places within their subpopulation before the next generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Permutation {
    /// All but those of new offspring, as in the experiments of \[Gomez2008\].
    All,
    /// The same weights, each with the probability 1 - ((f - min) / (max - min))^(1/n) for a network of fitness f and n
    /// genes, \[Gomez2008\] eq. 1. It keeps good networks together. Deviations: failed evaluations are not the minimum, and
    /// their weights are always permuted, as are all weights where all fitness is equal.
    ByFitness,
}

/// Configuration of [`Cosyne`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CosyneConfig {
    /// Number of genes in each segment, at least 1. Segments cover all genes and group related ones, such as the
    /// weights of a neuron. Note that crossover cuts each of them once.
    pub segments: Vec<usize>,
    /// Number of individuals m, at least 2: weights of each subpopulation.
    pub population: usize,
    /// Number of parents, the best individuals, 1 to `population`. A quarter in the source.
    pub parents: usize,
    /// Number of offspring l, which replace the worst: 0 to `population`.
    pub offspring: usize,
    /// Weights begin uniform between minus and plus this, 0 to 1e100.
    pub range: f64,
    /// Probability (0 to 1) that a weight of an offspring is mutated.
    pub mutation_rate: f64,
    /// Scale of the Cauchy distribution that mutation adds, in the unit of the genes, 0 to 1e100. Half of all mutations
    /// are smaller than this.
    pub mutation_scale: f64,
    /// Which weights change places.
    pub permutation: Permutation,
}

impl CosyneConfig {
    /// The values of \[Gomez2008\] section 5.3 for two poles, with one segment. There are 30 individuals, of which the best
    /// 7 are parents. Weights are from -10 to 10, and 30 % of the weights of offspring are mutated with a scale of 0.3.
    ///
    /// The source does not give the number of offspring. Half of the population is replaced here, as in ESP of the same
    /// authors.
    pub fn new(genes: usize) -> Self {
        Self {
            segments: vec![genes],
            population: 30,
            parents: 7,
            offspring: 15,
            range: 10.0,
            mutation_rate: 0.3,
            mutation_scale: 0.3,
            permutation: Permutation::All,
        }
    }

    /// Number of genes in all segments together.
    pub fn genes(&self) -> usize {
        self.segments.iter().fold(0, |sum: usize, segment| sum.saturating_add(*segment))
    }

    /// Checks that all settings are within their allowed ranges.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] or [`EvoError::OutOfRange`] for the first setting that is invalid.
    pub fn validate(&self) -> Result<(), EvoError> {
        let Self { population, parents, offspring, range, mutation_rate, mutation_scale, .. } = *self;
        Population::check(population, self.genes())?;
        check_setting(population >= 2, "the population", population as f64, "at least 2")?;
        for &segment in &self.segments {
            check_setting(segment > 0, "the genes of a segment", segment as f64, "at least 1")?;
        }
        let within = (1..=population).contains(&parents);
        check_setting(within, "the number of parents", parents as f64, "1 to the population")?;
        let within = offspring <= population;
        check_setting(within, "the number of offspring", offspring as f64, "0 to the population")?;
        check_range("the range of the first weights", range, [0.0, 1e100], "0 to 1e100")?;
        check_share("the mutation rate", mutation_rate)?;
        check_range("the scale of mutation", mutation_scale, [0.0, 1e100], "0 to 1e100")
    }
}

/// The trial of the streams that permute subpopulations. Offspring use 0.
const PERMUTATION: u32 = 1;

/// Cooperative Synapse Neuroevolution, `CoSyNE`. Each gene, the weight of a connection, has its subpopulation, and an
/// individual is a network with one weight of each. Genes are unbounded reals.
///
/// In each generation the best make offspring by crossover and mutation, which replace the worst. Then weights change
/// places within their subpopulations, so that each is evaluated in another network. Small networks need few evaluations.
/// With many genes good combinations are lost, unless [`Permutation::ByFitness`] keeps them.
///
/// Individuals are in the order of their fitness in the previous generation, best first, equals by index, failed ones last.
/// The offspring follow. A pair of offspring has two parents that are drawn uniformly and differ if possible. The cut of
/// each segment is uniform from before its first gene to after its last.
///
/// Offspring `2 i` and `2 i + 1` of generation `g` draw from the stream (seed, [`Domain::Mutation`], trial 0, `i`, `g`).
/// The permutation of gene `i` draws from (seed, [`Domain::Mutation`], trial 1, `i`, `g`). Individual `i` of generation 0
/// draws from (seed, [`Domain::InitialGenome`], trial 0, `i`, 0).
///
/// Source: \[Gomez2008\] algorithm 2, with the crossover and mutation of section 4. It gives neither the number of
/// offspring nor the choice of parents, see above and [`CosyneConfig::new`].
///
/// ```
/// use farsa_evo::Strategy;
/// use farsa_evo::coevolution::{Cosyne, CosyneConfig};
///
/// let mut search = Cosyne::new(CosyneConfig::new(3), 1)?;
/// let goal = [1.0, -2.0, 0.5];
/// let champion = search.maximize(200, |x| -x.iter().zip(goal).map(|(x, goal)| (x - goal) * (x - goal)).sum::<f64>())?;
/// assert!(champion.fitness.get() > -0.1);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
pub type Cosyne = Search<CosyneOrigins>;

/// Internal state of [`Cosyne`].
#[derive(Clone, Debug, PartialEq)]
pub struct CosyneOrigins {
    /// The place of each gene in the previous generation [individuals x genes]. Empty in generation 0.
    origins: Vec<u32>,
}

/// Crosses two parents: one of them for each gene of the first child, the other for the second child \[genes\].
fn cross(segments: &[usize], [first, second]: [u32; 2], stream: &mut Stream, children: &mut [Vec<u32>; 2]) {
    let [one, other] = children;
    one.clear();
    other.clear();
    for &segment in segments {
        let cut = stream.below(segment as u32 + 1) as usize;
        for gene in 0..segment {
            let (a, b) = if gene < cut { (first, second) } else { (second, first) };
            one.push(a);
            other.push(b);
        }
    }
}

impl CosyneOrigins {
    /// Replaces the worst by offspring of the best of an `old` population, in one that is sorted.
    fn breed(
        &mut self,
        step: &Step<'_, CosyneConfig>,
        old: &Population<f64>,
        order: &[usize],
        sorted: &mut Population<f64>,
    ) {
        let CosyneConfig { segments, parents, offspring, mutation_rate, mutation_scale, .. } = step.config;
        let (size, genes) = (sorted.len(), sorted.genome_len());
        let first = (size - offspring) * genes;
        let origins = self.origins.get_mut(first..).unwrap_or_default();
        let pairs = sorted.as_mut_slice().get_mut(first..).unwrap_or_default().chunks_mut(2 * genes);
        let mut children = [Vec::with_capacity(genes), Vec::with_capacity(genes)];
        for (pair, (new, origins)) in pairs.zip(origins.chunks_mut(2 * genes)).enumerate() {
            let mut stream = step.stream(pair);
            let mut draw = || stream.below(*parents as u32);
            let one = draw();
            let mut other = draw();
            while other == one && *parents > 1 {
                other = draw();
            }
            let of = |rank: u32| order.get(rank as usize).map_or(0, |individual| *individual as u32);
            cross(segments, [of(one), of(other)], &mut stream, &mut children);
            // With an odd number of offspring the last pair has no room for its second child.
            for ((new, origins), from) in new.chunks_mut(genes).zip(origins.chunks_mut(genes)).zip(&children) {
                origins.copy_from_slice(from);
                for (index, (gene, from)) in new.iter_mut().zip(from).enumerate() {
                    let inherited = old.get(*from as usize).and_then(|genes| genes.get(index));
                    *gene = inherited.copied().unwrap_or_default();
                    if stream.uniform_f64() < *mutation_rate {
                        *gene += mutation_scale * cauchy(&mut stream);
                    }
                }
            }
        }
    }

    /// Permutes the weights of the individuals that are no offspring, each subpopulation by itself.
    fn permute(&mut self, step: &Step<'_, CosyneConfig>, chances: &[f64], population: &mut Population<f64>) {
        let genes = population.genome_len();
        let mut marked: Vec<usize> = Vec::with_capacity(chances.len());
        for gene in 0..genes {
            let mut stream = Stream::new(step.seed, Domain::Mutation, PERMUTATION, gene as u32, step.generation);
            marked.clear();
            match step.config.permutation {
                Permutation::All => marked.extend(0..chances.len()),
                Permutation::ByFitness => {
                    let chosen = chances.iter().enumerate().filter(|(_, chance)| stream.uniform_f64() < **chance);
                    marked.extend(chosen.map(|(individual, _)| individual));
                }
            }
            // Fisher-Yates shuffle: all permutations are equally likely. Origins move with their weights.
            for last in (1..marked.len()).rev() {
                let other = stream.below(last as u32 + 1) as usize;
                let (a, b) = (marked[last] * genes + gene, marked[other] * genes + gene);
                population.as_mut_slice().swap(a, b);
                self.origins.swap(a, b);
            }
        }
    }
}

/// A number of the standard Cauchy distribution: the tangent of a uniform angle.
fn cauchy(stream: &mut Stream) -> f64 {
    let (sine, cosine) = sin_cos(PI * (stream.uniform_f64() - 0.5));
    sine / cosine
}

/// The probability (equation 1) that a weight of each individual is permuted, given their fitness, best first.
fn chances(fitness: &[Fitness], genes: usize) -> Vec<f64> {
    let succeeded = || fitness.iter().filter(|fitness| !fitness.is_failed());
    let (Some(most), Some(least)) = (succeeded().max(), succeeded().min()) else { return vec![1.0; fitness.len()] };
    // Halves, so that no difference overflows.
    let half = |fitness: &Fitness| 0.5 * fitness.get();
    let chance = |fitness: &Fitness| {
        if fitness.is_failed() || most == least {
            1.0
        } else if fitness == most {
            0.0
        } else {
            // Above, fitness equal to an infinite best avoids a quotient of NaN. The worst has the part 0 and the chance 1.
            let part = (half(fitness) - half(least)) / (half(most) - half(least));
            1.0 - exp(ln(part) / genes as f64)
        }
    };
    fitness.iter().map(chance).collect()
}

impl Algorithm for CosyneOrigins {
    type Gene = f64;
    type Config = CosyneConfig;
    const HAS_PARENTS: bool = true;

    fn start(step: &Step<'_, CosyneConfig>) -> Result<(Self, Population<f64>), EvoError> {
        let CosyneConfig { population, range, .. } = *step.config;
        step.config.validate()?;
        let bounds = vec![[-range, range]; step.config.genes()];
        Ok((Self { origins: Vec::new() }, uniform(step, population, &bounds)?))
    }

    fn advance(&mut self, step: &Step<'_, CosyneConfig>, fitness: &[Fitness], genomes: &mut Population<f64>) {
        let (order, old, genes) = (Fitness::ranking(fitness), genomes.clone(), genomes.genome_len());
        self.origins = order.iter().flat_map(|&from| repeat_n(from as u32, genes)).collect();
        for (row, &from) in genomes.iter_mut().zip(&order) {
            row.copy_from_slice(old.get(from).unwrap_or_default());
        }
        self.breed(step, &old, &order, genomes);
        let sorted: Vec<Fitness> = order.iter().filter_map(|&individual| fitness.get(individual)).copied().collect();
        let chances = chances(&sorted, genes);
        // Offspring are the last individuals, and their weights stay.
        let kept = chances.get(..sorted.len() - step.config.offspring).unwrap_or_default();
        self.permute(step, kept, genomes);
    }

    fn record_kind(config: &CosyneConfig) -> RecordKind {
        match config.permutation {
            Permutation::All => RecordKind::Order,
            Permutation::ByFitness => RecordKind::Values,
        }
    }

    /// All whose weights it has, in rising order.
    fn parents_of(&self, step: &Step<'_, CosyneConfig>, individual: usize) -> Vec<usize> {
        let origins = self.origins.chunks(step.config.genes()).nth(individual).unwrap_or_default();
        let mut parents: Vec<usize> = origins.iter().map(|&origin| origin as usize).collect();
        parents.sort_unstable();
        parents.dedup();
        parents
    }

    fn state_length(&self, step: &Step<'_, CosyneConfig>, genes: usize) -> usize {
        if step.generation == 0 { 8 * genes } else { 12 * genes }
    }

    fn save(&self, _: &CosyneConfig, genomes: &Population<f64>, saved: &mut Vec<u8>) {
        push_indices(saved, &self.origins);
        push_reals(saved, genomes.as_slice());
    }

    fn restore(
        &mut self,
        step: &Step<'_, CosyneConfig>,
        reader: &mut StateReader<'_>,
        genomes: &mut Population<f64>,
    ) -> Result<(), EvoError> {
        let origins = if step.generation == 0 { 0 } else { genomes.as_slice().len() };
        self.origins = reader.individuals(origins, genomes.len())?;
        reader.reals(genomes.as_mut_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chances_are_those_of_the_equation() {
        let fitness = [8.0, 2.0, 1.0, 0.0, f64::NAN].map(Fitness::nan_as_failed);
        let found = chances(&fitness, 3);
        // Third roots of 1, 1/4, 1/8 and 0.
        let want = [0.0, 1.0 - 0.629_960_524_947_436_6, 0.5, 1.0, 1.0];
        assert!(found.iter().zip(want).all(|(found, want)| (found - want).abs() < 1e-12), "{found:?}");
        assert_eq!(chances(&[Fitness::WORST; 2], 3), [1.0; 2]);
        assert_eq!(chances(&[2.0, 2.0, f64::NAN].map(Fitness::nan_as_failed), 3), [1.0; 3]);
        let wide = [f64::INFINITY, f64::MAX, f64::MIN].map(Fitness::nan_as_failed);
        assert_eq!(chances(&wide, 1), [0.0, 1.0, 1.0]);
        assert_eq!(chances(&wide[1..], 1), [0.0, 1.0]);
    }

    #[test]
    fn half_of_the_mutations_are_within_the_scale() {
        let mut stream = Stream::from_seed(4);
        let numbers: Vec<f64> = (0..100_000).map(|_| cauchy(&mut stream)).collect();
        // The distribution function is 1/2 + atan(x) / pi, so 1/4, 1/2 and 3/4 at -1, 0 and 1, and 0.9 at 3.078.
        for (x, want) in [(-1.0, 0.25), (0.0, 0.5), (1.0, 0.75), (3.077_683_5, 0.9)] {
            let part = numbers.iter().filter(|number| **number < x).count() as f64 / 1e5;
            assert!((part - want).abs() < 0.008, "{x}: {part}");
        }
    }
}
