//! CMA-ME on a planar arm of 12 joints: a repertoire of places that it reaches with joint angles that vary little.
//!
//! `cargo run --release -p farsa-evo --example arm` prints a line of comma-separated values for each seed: the cells filled of a
//! centroidal Voronoi tessellation of 10 000 after 105 000 evaluations (five improvement emitters, 30 individuals each, 700
//! generations, as in the tutorial of pyribs), the sum of the objectives, and seconds, those of the tessellation apart.
//! `benches/arm_pyribs.py` prints the same of pyribs and compares them.

use std::time::Instant;

use farsa_evo::archives::{CvtCells, MapElites, MapElitesConfig};
use farsa_evo::{EvoError, Strategy};

mod planar_arm;
use planar_arm::{ANGLES, JOINTS, PLACES, judge};

fn main() -> Result<(), EvoError> {
    println!("seed,cells,sum,best,seconds,tessellation");
    for seed in 1..=11 {
        let start = Instant::now();
        let cells = CvtCells::new(10_000, &PLACES, 100_000, seed)?;
        let tessellation = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let config = MapElitesConfig::cma_me(vec![ANGLES; JOINTS], 5, 30, 0.1);
        let mut search = MapElites::new(config, cells, seed)?;
        let champion = search.evolve(700, judge)?;
        let seconds = start.elapsed().as_secs_f64();
        let (archive, best) = (search.archive(), champion.fitness.get());
        println!("{seed},{},{:.3},{best:.6},{seconds:.4},{tessellation:.3}", archive.len(), archive.sum());
    }
    Ok(())
}
