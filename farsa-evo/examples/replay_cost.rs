//! Seconds to rebuild a generation from the record, without any evaluation:
//! `cargo run --release -p farsa-evo --example replay_cost -- [GENES [GENERATIONS [NAME...]]]`.
//!
//! Each strategy has 100 individuals where its sizes allow it, and receives arbitrary fitness. A line has the name, the
//! genes, the individuals, the generations, the seconds of the slowest rebuild and the megabytes of the record. Five
//! generations are rebuilt: the last, and those just before a saved state.

use std::time::Instant;

use farsa_evo::archives::{CvtCells, GridCells, MapElites, MapElitesConfig, NoveltyConfig, NoveltySearch};
use farsa_evo::coevolution::{Cosyne, CosyneConfig};
use farsa_evo::covariance::{CholeskyCmaEs, CmaEs, CmaEsConfig, SeparableCmaEs, SeparableCmaEsConfig};
use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Pgpe, PgpeConfig, Snes, SnesConfig, Xnes, XnesConfig,
};
use farsa_evo::pareto::{Nsga2, Nsga2Config};
use farsa_evo::real::{
    EvolutionStrategy, EvolutionStrategyConfig, RealGa, RealGaConfig, SteadyState, SteadyStateConfig,
};
use farsa_evo::words::{GaConfig, OnePlusOne, OnePlusOneConfig, TruncationGa};
use farsa_evo::{EvoError, Gene, Record, ScoreShape, Scores, Strategy};

/// Arbitrary scores that differ between generations.
fn scores(shape: ScoreShape, individuals: usize, generation: u32) -> Result<Scores, EvoError> {
    let number = |i: usize| ((i * 7919 + generation as usize * 104_729) % 10_007) as f64 / 10_007.0;
    Scores::nan_as_failed(shape, (0..individuals * shape.width()).map(number).collect())
}

/// Runs the given number of generations and times the rebuilding of some of them.
fn time<G: Gene, S: Strategy<G>>(
    name: &str,
    generations: u32,
    fresh: impl Fn() -> Result<S, EvoError>,
) -> Result<(), EvoError> {
    let mut strategy = fresh()?;
    let (individuals, genes) = (strategy.ask().len(), strategy.ask().genome_len());
    let mut record = Record::new(&mut strategy)?;
    let mut before_states = Vec::new();
    for generation in 0..generations {
        let scores = scores(strategy.score_shape(), individuals, generation)?;
        if scores.shape() == ScoreShape::FITNESS {
            record.tell(&mut strategy, &scores.fitness())?;
        } else {
            record.tell_scores(&mut strategy, &scores)?;
        }
        if record.entry(generation).is_some_and(|entry| entry.state.is_some()) {
            before_states.push(generation);
        }
    }
    let parts = before_states.len().div_ceil(4).max(1);
    let mut wanted: Vec<u32> = before_states.into_iter().step_by(parts).collect();
    wanted.push(generations - 1);
    let mut most: f64 = 0.0;
    for generation in wanted {
        let mut again = fresh()?;
        let start = Instant::now();
        record.rebuild(&mut again, generation)?;
        most = most.max(start.elapsed().as_secs_f64());
    }
    println!("{name} {genes} {individuals} {generations} {most:.3} {:.1}", record.bytes() as f64 / 1e6);
    Ok(())
}

/// Strategies over integer genes.
fn words(n: usize, generations: u32, wanted: &dyn Fn(&str) -> bool) -> Result<(), EvoError> {
    let config = GaConfig { population: 100, ..GaConfig::new(n) };
    if wanted("truncation") {
        time::<u16, _>("truncation", generations, || TruncationGa::new(config, 1))?;
    }
    if wanted("one-plus-one") {
        time::<u16, _>("one-plus-one", generations, || OnePlusOne::new(OnePlusOneConfig::new(n), 1))?;
    }
    if wanted("novelty-search") {
        let search = || NoveltySearch::new(NoveltyConfig::new(2), TruncationGa::new(config, 1)?, 1);
        time::<u16, _>("novelty-search", generations, search)?;
    }
    Ok(())
}

/// Strategies over reals within bounds.
fn bounded(n: usize, generations: u32, wanted: &dyn Fn(&str) -> bool) -> Result<(), EvoError> {
    let bounds = vec![[-1.0, 1.0]; n];
    if wanted("real-ga") {
        time::<f64, _>("real-ga", generations, || RealGa::new(RealGaConfig::new(bounds.clone()), 1))?;
    }
    if wanted("sss") {
        let config = SteadyStateConfig { population: 100, ..SteadyStateConfig::new(bounds.clone()) };
        time::<f64, _>("sss", generations, || SteadyState::new(config.clone(), 1))?;
    }
    if wanted("nsga2") {
        time::<f64, _>("nsga2", generations, || Nsga2::new(Nsga2Config::new(bounds.clone(), 2), 1))?;
    }
    let grid = GridCells::new(vec![[0.0, 1.0]; 2], vec![32; 2])?;
    if wanted("map-elites") {
        let config = MapElitesConfig::new(bounds.clone());
        time::<f64, _>("map-elites", generations, || MapElites::new(config.clone(), grid.clone(), 1))?;
        let cells = CvtCells::new(1024, &[[0.0, 1.0]; 2], 10_240, 1)?;
        time::<f64, _>("map-elites-cvt", generations, || MapElites::new(config.clone(), cells.clone(), 1))?;
    }
    if wanted("cma-me") {
        let config = MapElitesConfig::cma_me(bounds.clone(), 4, 25, 0.5);
        time::<f64, _>("cma-me", generations, || MapElites::new(config.clone(), grid.clone(), 1))?;
    }
    Ok(())
}

/// Strategies of a distribution, or of a point with noise around it.
fn distributions(n: usize, generations: u32, wanted: &dyn Fn(&str) -> bool) -> Result<(), EvoError> {
    let mean = vec![0.0; n];
    let cma = CmaEsConfig { population: 100, ..CmaEsConfig::new(mean.clone(), 0.5) };
    if wanted("cma-es") {
        time::<f64, _>("cma-es", generations, || CmaEs::new(cma.clone(), 1))?;
    }
    if wanted("cholesky-cma-es") {
        time::<f64, _>("cholesky-cma-es", generations, || CholeskyCmaEs::with_covariance(cma.clone(), 1))?;
    }
    if wanted("separable-cma-es") {
        let config = SeparableCmaEsConfig { population: 100, ..SeparableCmaEsConfig::new(mean.clone(), 0.5) };
        time::<f64, _>("separable-cma-es", generations, || SeparableCmaEs::with_covariance(config.clone(), 1))?;
    }
    if wanted("xnes") {
        let config = XnesConfig { population: 100, ..XnesConfig::new(mean.clone(), 0.5) };
        time::<f64, _>("xnes", generations, || Xnes::new(config.clone(), 1))?;
    }
    if wanted("snes") {
        let config = SnesConfig { population: 100, ..SnesConfig::new(mean.clone(), 0.5) };
        time::<f64, _>("snes", generations, || Snes::new(config.clone(), 1))?;
    }
    if wanted("evolution-strategy") {
        let config = EvolutionStrategyConfig::new(mean.clone(), 0.1);
        time::<f64, _>("evolution-strategy", generations, || EvolutionStrategy::new(config.clone(), 1))?;
    }
    if wanted("cosyne") {
        let config = CosyneConfig { population: 100, ..CosyneConfig::new(n) };
        time::<f64, _>("cosyne", generations, || Cosyne::new(config.clone(), 1))?;
    }
    if wanted("open-ai-es") {
        let config = OpenAiEsConfig::new(mean.clone(), 50);
        time::<f64, _>("open-ai-es", generations, || OpenAiEs::new(config.clone(), 1))?;
    }
    if wanted("pgpe") {
        let config = PgpeConfig::new(mean.clone(), 0.1, 50);
        time::<f64, _>("pgpe", generations, || Pgpe::new(config.clone(), 1))?;
    }
    if wanted("ars") {
        let config = ArsConfig::new(mean, 50);
        time::<f64, _>("ars", generations, || Ars::new(config.clone(), 1))?;
    }
    Ok(())
}

fn main() -> Result<(), EvoError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize| arguments.get(place).and_then(|count| count.parse::<u32>().ok());
    let (genes, generations) = (number(0).unwrap_or(792).max(1) as usize, number(1).unwrap_or(1000).max(1));
    let wanted = |name: &str| arguments.len() < 3 || arguments[2..].iter().any(|argument| argument == name);
    words(genes, generations, &wanted)?;
    bounded(genes, generations, &wanted)?;
    distributions(genes, generations, &wanted)
}
