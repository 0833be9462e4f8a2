//! Seconds of a generation, without evaluations, of strategies over many genes:
//! `cargo run --release -p farsa-evo --example generation_cost -- [GENERATIONS [NAME...]]`.
//!
//! `benches/generation_cost.py` compares it with pycma and numpy. Each line has the name, the genes, the individuals, and the median
//! and least seconds of a generation. For covariance matrix adaptation the median is replaced by the mean, because the axes
//! are not computed in every generation.

use std::time::Instant;

use farsa_evo::covariance::{CholeskyCmaEs, CmaEs, CmaEsConfig, SeparableCmaEs, SeparableCmaEsConfig};
use farsa_evo::gradient::{Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Pgpe, PgpeConfig};
use farsa_evo::words::{GaConfig, TruncationGa};
use farsa_evo::{EvoError, Gene, Strategy};

/// Times the given number of generations with arbitrary fitness, after two generations that are not timed.
fn time<G: Gene>(name: &str, generations: usize, strategy: &mut dyn Strategy<G>) -> Result<(), EvoError> {
    let (individuals, genes) = (strategy.ask().len(), strategy.ask().genome_len());
    let values: Vec<f64> = (0..individuals).map(|i| ((i * 7919) % individuals) as f64).collect();
    let mut seconds = Vec::new();
    for generation in 0..generations + 2 {
        let start = Instant::now();
        strategy.tell_values(&values)?;
        if generation > 1 {
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    let mean = seconds.iter().sum::<f64>() / seconds.len() as f64;
    seconds.sort_by(f64::total_cmp);
    println!("{name} {genes} {individuals} {:.6} {:.6} {mean:.6}", seconds[seconds.len() / 2], seconds[0]);
    Ok(())
}

fn main() -> Result<(), EvoError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let generations: usize = arguments.first().and_then(|count| count.parse().ok()).unwrap_or(40).max(1);
    let wanted = |name: &str| arguments.len() < 2 || arguments[1..].iter().any(|argument| argument == name);
    let (covariance, many) = (792, 100_000);
    if wanted("ga") {
        let config = GaConfig { population: 100, ..GaConfig::new(792) };
        time::<u16>("ga", generations, &mut TruncationGa::new(config, 1)?)?;
    }
    if wanted("cma-es") {
        let config = CmaEsConfig::new(vec![0.0; covariance], 0.5);
        time::<f64>("cma-es", generations, &mut CmaEs::new(config, 1)?)?;
    }
    if wanted("cholesky-cma-es") {
        let config = CmaEsConfig::new(vec![0.0; covariance], 0.5);
        time::<f64>("cholesky-cma-es", generations, &mut CholeskyCmaEs::with_covariance(config, 1)?)?;
    }
    if wanted("separable-cma-es") {
        let config = SeparableCmaEsConfig::new(vec![0.0; covariance], 0.5);
        time::<f64>("separable-cma-es", generations, &mut SeparableCmaEs::with_covariance(config, 1)?)?;
    }
    if wanted("open-ai-es") {
        let config = OpenAiEsConfig::new(vec![0.0; many], 100);
        time::<f64>("open-ai-es", generations, &mut OpenAiEs::new(config, 1)?)?;
    }
    if wanted("ars") {
        let config = ArsConfig::new(vec![0.0; many], 100);
        time::<f64>("ars", generations, &mut Ars::new(config, 1)?)?;
    }
    if wanted("pgpe") {
        let config = PgpeConfig::new(vec![0.0; many], 0.1, 100);
        time::<f64>("pgpe", generations, &mut Pgpe::new(config, 1)?)?;
    }
    Ok(())
}
