//! With a heap: a description, a world of arm, hand, sphere and table, and evolution of words and of reals.

use farsa::body::ports::World as _;
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::evo::covariance::{CmaEs, CmaEsConfig};
use farsa::evo::words::{GaConfig, TruncationGa};
use farsa::evo::{EvoError, Strategy};
use farsa::physics::articulated::{Model, Options, World};

/// Ten control steps, and two searches that have to find what they search for.
pub fn runs() -> Result<(), i32> {
    let robot = Tabletop::default().scene(&ArmAndHand::default()).map_err(|_| 10)?;
    let mut world = World::new(Model::<f32>::new(&robot, &Options::default()).map_err(|_| 11)?);
    for _ in 0..10 {
        world.step();
    }
    if !world.is_finite() {
        return Err(12);
    }
    if genetic_algorithm().map_err(|_| 13)? != [u16::MAX; 2] {
        return Err(14);
    }
    if covariance_matrix_adaptation().map_err(|_| 15)? < -1e-10 {
        return Err(16);
    }
    Ok(())
}

/// The genes with the most ones that a genetic algorithm finds.
fn genetic_algorithm() -> Result<[u16; 2], EvoError> {
    let mut search = TruncationGa::new(GaConfig::new(2), 1)?;
    let champion = search.maximize(40, |genes| genes.iter().map(|gene| f64::from(gene.count_ones())).sum())?;
    Ok([champion.genome[0], champion.genome[1]])
}

/// The fitness that CMA-ES reaches on Rosenbrock's function of four variables, whose largest is 0.
fn covariance_matrix_adaptation() -> Result<f64, EvoError> {
    let mut search = CmaEs::new(CmaEsConfig::new([0.0; 4].into(), 0.5), 1)?;
    let square = |x: f64| x * x;
    let rosenbrock =
        |x: &[f64]| -> f64 { x.windows(2).map(|x| 100.0 * square(x[1] - x[0] * x[0]) + square(1.0 - x[0])).sum() };
    Ok(search.maximize(400, |x| -rosenbrock(x))?.fitness.get())
}
