//! Long searches without selection: fitness that is equal, failed, tied, noise or far from zero.

use farsa_evo::archives::{GridCells, MapElites, MapElitesConfig, NoveltyConfig, NoveltySearch};
use farsa_evo::coevolution::{Cosyne, CosyneConfig, GeneralistCoevolution, GeneralistConfig, Populations};
use farsa_evo::covariance::{
    CholeskyCmaEs, CmaEs, CmaEsConfig, CmaEsRestarts, CmaEsRestartsConfig, RestartSchedule, SeparableCmaEs,
    SeparableCmaEsConfig,
};
use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Pgpe, PgpeConfig, PgpeFitness, Snes, SnesConfig, Xnes, XnesConfig,
};
use farsa_evo::pareto::{Nsga2, Nsga2Config};
use farsa_evo::real::{
    EvolutionStrategy, EvolutionStrategyConfig, RealGa, RealGaConfig, RealMutation, Recombination, SteadyState,
    SteadyStateConfig, StepSizes, Survival,
};
use farsa_evo::words::{GaConfig, OnePlusOne, OnePlusOneConfig, RandomSearch, TruncationGa};
use farsa_evo::{EvoError, Gene, Scores, Strategy};
use farsa_num::{Domain, Stream};

const GENERATIONS: u32 = 2000;
const GENES: usize = 4;
/// Range of every gene.
const BOX: [f64; 2] = [-1.0, 1.0];
const WIDTH: f64 = BOX[1] - BOX[0];

/// Fitness without information.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Landscape {
    Flat,
    Failed,
    /// Noise of three values, with some failures and some generations that fail as a whole.
    Ties,
    /// Noise far above zero, in the last digits of the numbers.
    Offset,
    /// Noise between the ends of the numbers.
    Huge,
}

impl Landscape {
    const ALL: [Self; 5] = [Self::Flat, Self::Failed, Self::Ties, Self::Offset, Self::Huge];

    /// A number of an individual.
    fn value(self, generation: u32, stream: &mut Stream) -> f64 {
        let noise = 2.0 * stream.uniform_f64() - 1.0;
        match self {
            Self::Flat => 1.0,
            Self::Failed => f64::NAN,
            Self::Ties if generation % 11 == 10 || noise > 0.8 => f64::NAN,
            Self::Ties => noise.round(),
            Self::Offset => 1e15 + noise,
            Self::Huge => f64::MAX * noise,
        }
    }

    fn scores<G: Gene>(self, search: &impl Strategy<G>) -> Scores {
        let (shape, count) = (search.score_shape(), search.ask().len());
        let mut stream = Stream::new(7, Domain::General, 0, 0, search.generation());
        let values = (0..count * shape.width()).map(|_| self.value(search.generation(), &mut stream)).collect();
        Scores::nan_as_failed(shape, values).unwrap()
    }
}

/// Genes as numbers.
trait Finite: Gene {
    fn is_finite(self) -> bool;
}

impl Finite for f64 {
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Finite for u16 {
    fn is_finite(self) -> bool {
        true
    }
}

/// Runs a strategy on every landscape. Its steps are at most the width of the box, its genes finite, its state neither
/// grows nor loses a number.
fn endures<G: Finite, S: Strategy<G>>(name: &str, make: impl Fn() -> Result<S, EvoError>, step: impl Fn(&S) -> f64) {
    for landscape in Landscape::ALL {
        let mut search = make().unwrap();
        let mut largest_state = 0;
        for generation in 0..GENERATIONS {
            let longest = step(&search);
            assert!(longest <= WIDTH * (1.0 + 1e-12), "{name}, {landscape:?}, {generation}: a step of {longest}");
            let genes = search.ask().as_slice();
            assert!(genes.iter().all(|gene| gene.is_finite()), "{name}, {landscape:?}, {generation}: {genes:?}");
            let scores = landscape.scores(&search);
            search.tell_scores(&scores).unwrap();
            // The sum of an archive may be infinite, and so is the fitness of members that failed.
            assert!(search.diagnostics().iter().all(|number| !number.is_nan()), "{name}, {landscape:?}");
            if generation % 100 == 99 {
                let length = search.snapshot().unwrap().save().len();
                if generation < GENERATIONS / 2 {
                    largest_state = largest_state.max(length);
                } else {
                    assert!(length <= largest_state, "{name}, {landscape:?}: {length} bytes after {largest_state}");
                }
            }
        }
        let state = search.snapshot().unwrap().save();
        let mut copy = make().unwrap();
        copy.snapshot().unwrap().restore(&state).unwrap_or_else(|error| panic!("{name}, {landscape:?}: {error}"));
        for _ in 0..3 {
            assert_eq!(copy.ask().digest(), search.ask().digest(), "{name}, {landscape:?}");
            let scores = landscape.scores(&search);
            search.tell_scores(&scores).unwrap();
            copy.tell_scores(&scores).unwrap();
        }
    }
}

fn no_step<S>(_: &S) -> f64 {
    0.0
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().copied().fold(0.0, f64::max)
}

/// The largest standard deviation of a gene, from the diagonal of a covariance [genes x genes].
fn deviation(sigma: f64, covariance: &[f64]) -> f64 {
    sigma * largest(&covariance.iter().step_by(GENES + 1).copied().collect::<Vec<_>>()).sqrt()
}

fn mean() -> Vec<f64> {
    vec![0.0; GENES]
}

fn bounds() -> Vec<[f64; 2]> {
    vec![BOX; GENES]
}

#[test]
fn integer_genes() {
    let ga = || TruncationGa::new(GaConfig { population: 20, parents: 5, ..GaConfig::new(GENES) }, 1);
    endures("truncation", ga, no_step);
    endures("one-plus-one", || OnePlusOne::new(OnePlusOneConfig::new(GENES), 1), no_step);
    endures("random-search", || RandomSearch::new(GENES, 20, 1), no_step);
    let config = GeneralistConfig {
        genes: GENES,
        gene_bits: 8,
        members: 6,
        newcomers: 2,
        opponents: 3,
        iterations: 5,
        ..GeneralistConfig::new(0)
    };
    endures("generalist", || GeneralistCoevolution::new(config, 1), no_step);
    endures("populations", || Populations::new(2, 1, |_| ga()), no_step);
}

#[test]
fn evolution_strategies() {
    let plain = || EvolutionStrategyConfig { largest_step: WIDTH, ..EvolutionStrategyConfig::new(mean(), 0.5) };
    let step = |search: &EvolutionStrategy| largest(search.step_sizes());
    for survival in [Survival::Comma, Survival::Plus, Survival::PlusEvaluatedAgain] {
        for recombination in [Recombination::Intermediate, Recombination::Discrete, Recombination::None] {
            for step_sizes in [StepSizes::one(GENES), StepSizes::per_gene(GENES)] {
                let (parents, mixing, offspring) = (4, 4, 12);
                let config = EvolutionStrategyConfig {
                    parents,
                    mixing,
                    offspring,
                    survival,
                    recombination,
                    step_recombination: recombination,
                    step_sizes,
                    ..plain()
                };
                let name = format!("evolution-strategy, {survival:?}, {recombination:?}, {step_sizes:?}");
                endures(&name, || EvolutionStrategy::new(config.clone(), 1), step);
            }
        }
    }
    endures("evolution-strategy", || EvolutionStrategy::new(plain(), 1), step);
}

#[test]
fn genetic_algorithms() {
    endures("real-ga", || RealGa::new(RealGaConfig { population: 20, ..RealGaConfig::new(bounds()) }, 1), no_step);
    let mutation = RealMutation::SelfAdaptive { rate: 1.0, initial: 0.1, tau: 0.5, smallest: 1e-6 };
    let config = RealGaConfig { population: 20, mutation, ..RealGaConfig::new(bounds()) };
    // The mean step size of the population is a share of the range.
    let step = |search: &RealGa| WIDTH * largest(&search.diagnostics());
    endures("real-ga, self-adaptive", || RealGa::new(config.clone(), 1), step);
    endures("sss", || SteadyState::new(SteadyStateConfig::new(bounds()), 1), no_step);
    let config = Nsga2Config { population: 20, ..Nsga2Config::new(bounds(), 2) };
    endures("nsga2", || Nsga2::new(config.clone(), 1), no_step);
    endures("cosyne", || Cosyne::new(CosyneConfig { range: BOX[1], ..CosyneConfig::new(GENES) }, 1), no_step);
}

#[test]
fn covariance_matrices() {
    let config = || CmaEsConfig { largest_step: WIDTH, ..CmaEsConfig::new(mean(), 0.5) };
    let step = |search: &CmaEs| deviation(search.sigma(), &search.covariance());
    endures("cma-es", || CmaEs::new(config(), 1), step);
    let step = |search: &CholeskyCmaEs| deviation(search.sigma(), &search.covariance());
    endures("cholesky-cma-es", || CholeskyCmaEs::with_covariance(config(), 1), step);
    let separable = || SeparableCmaEsConfig { largest_step: WIDTH, ..SeparableCmaEsConfig::new(mean(), 0.5) };
    let step = |search: &SeparableCmaEs| search.sigma() * largest(search.variances()).sqrt();
    endures("separable-cma-es", || SeparableCmaEs::with_covariance(separable(), 1), step);
}

/// The state of a run grows until the run ends, and so does its population.
#[test]
fn restarts() {
    for schedule in [RestartSchedule::Ipop, RestartSchedule::Bipop] {
        let first = CmaEsConfig { largest_step: WIDTH, ..CmaEsConfig::new(mean(), 0.5) };
        for landscape in Landscape::ALL {
            let config = CmaEsRestartsConfig::new(first.clone(), schedule);
            let mut search = CmaEsRestarts::new(config.clone(), 1).unwrap();
            for generation in 0..GENERATIONS {
                let genes = search.ask().as_slice();
                assert!(genes.iter().all(|gene| f64::is_finite(*gene)), "{landscape:?}, {generation}: {genes:?}");
                let scores = landscape.scores(&search);
                search.tell_scores(&scores).unwrap();
            }
            assert!(search.run() > 0, "{schedule:?}, {landscape:?}");
            let state = search.snapshot().unwrap().save();
            let mut copy = CmaEsRestarts::new(config, 1).unwrap();
            copy.snapshot().unwrap().restore(&state).unwrap();
            assert_eq!(copy, search);
        }
    }
}

#[test]
fn gradients() {
    let config = || XnesConfig { largest_step: WIDTH, ..XnesConfig::new(mean(), 0.5) };
    let step = |search: &Xnes| {
        let rows = search.shape().chunks_exact(GENES).map(|row| row.iter().map(|x| x * x).sum::<f64>().sqrt());
        search.sigma() * rows.fold(0.0, f64::max)
    };
    endures("xnes", || Xnes::new(config(), 1), step);
    let config = || SnesConfig { largest_step: WIDTH, ..SnesConfig::new(mean(), 0.5) };
    endures("snes", || Snes::new(config(), 1), |search: &Snes| largest(search.sigmas()));
    for fitness in [PgpeFitness::CenteredRanks, PgpeFitness::Raw] {
        let config = || PgpeConfig { fitness, largest_step: WIDTH, ..PgpeConfig::new(mean(), 0.1, 10) };
        endures("pgpe", || Pgpe::new(config(), 1), |search: &Pgpe| largest(search.sigmas()));
    }
    // Their first diagnostic is the length of the latest step of the point.
    let step = |search: &OpenAiEs| search.diagnostics()[0];
    endures("open-ai-es", || OpenAiEs::new(OpenAiEsConfig::new(mean(), 10), 1), step);
    endures("ars", || Ars::new(ArsConfig::new(mean(), 10), 1), |search: &Ars| search.diagnostics()[0]);
}

#[test]
fn archives() {
    let cells = || GridCells::new(vec![BOX; 2], vec![5, 5]).unwrap();
    endures("map-elites", || MapElites::new(MapElitesConfig::new(bounds()), cells(), 1), no_step);
    endures("cma-me", || MapElites::new(MapElitesConfig::cma_me(bounds(), 2, 10, 0.5), cells(), 1), no_step);
    let inner = || TruncationGa::new(GaConfig { population: 10, parents: 2, ..GaConfig::new(GENES) }, 1).unwrap();
    let config = NoveltyConfig { capacity: 100, ..NoveltyConfig::new(2) };
    endures("novelty-search", || NoveltySearch::new(config, inner(), 1), no_step);
}
