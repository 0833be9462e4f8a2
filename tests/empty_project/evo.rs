use farsa_evo::{EvoError, Fitness, Strategy, words::GaConfig, words::TruncationGa};

fn main() -> Result<(), EvoError> {
    let mut evolution = TruncationGa::new(GaConfig::new(8), 42)?;
    for _ in 0..50 {
        let sums = evolution.ask().iter().map(|genes| genes.iter().map(|gene| f64::from(*gene)).sum());
        let fitness: Vec<Fitness> = sums.map(Fitness::nan_as_failed).collect();
        evolution.tell(&fitness)?;
    }
    Ok(println!("{:?}", evolution.ask().iter().next()))
}
