//! With a heap: a description, a world of arm, hand, sphere and table, and evolution.

use farsa::body::{ArmAndHand, Tabletop, World as _};
use farsa::evo::{Fitness, GaConfig, Strategy, TruncationGa};
use farsa::physics::articulated::{Model, Options, World};

/// Ten control steps and two generations.
pub fn runs() -> Result<(), ()> {
    let robot = Tabletop::default().scene(&ArmAndHand::default()).map_err(|_| ())?;
    let mut world = World::new(Model::<f32>::new(&robot, &Options::default()).map_err(|_| ())?);
    for _ in 0..10 {
        world.step();
    }
    let mut evolution = TruncationGa::new(GaConfig::new(4), 1).map_err(|_| ())?;
    for _ in 0..2 {
        let fitness: [Fitness; 100] =
            core::array::from_fn(|i| Fitness::nan_as_failed(f64::from(evolution.ask().as_slice()[4 * i])));
        evolution.tell(&fitness).map_err(|_| ())?;
    }
    if world.is_finite() && evolution.generation() == 2 { Ok(()) } else { Err(()) }
}
