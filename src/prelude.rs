//! The names of a first program: `use farsa::prelude::*;`.
//!
//! Worlds stay in their modules, because there are several: `arena::World` and `articulated::World`. Their ports are here,
//! so that a loop can step a world and read it.
//!
//! A Khepera evolves to drive in a square without running into its walls:
//!
#![cfg_attr(not(feature = "alloc"), doc = "```ignore")]
#![cfg_attr(feature = "alloc", doc = "```")]
//! use farsa::prelude::*;
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     // A robot in a world, with what it senses and what drives it.
//!     let robot = MobileRobot::khepera();
//!     let mut square = arena::Arena::walled(0.5, 0.5);
//!     let number = square.add_robot(robot.clone(), [0.25, 0.25], 0.3);
//!     let mut world = arena::World::new(&square)?;
//!     let parts = world.parts(number);
//!     let mut sensors = InfraredFormula::for_robot(&robot, parts.body)?;
//!     let mut motors = WheelVelocity::new(parts.motors, robot.max_wheel_speed as f32)?;
//!
//!     // A network between the two; its parameters are what evolves.
//!     let (inputs, outputs) = (sensors.channels(), 2);
//!     let count = Perceptron::parameter_count(inputs, outputs);
//!     let ranges = [GeneRange::new(count, -5.0, 5.0)?];
//!     let mut start = vec![0.0; world.snapshot_len()];
//!     world.save(&mut start);
//!     let (mut x, mut y) = (vec![0.0; inputs], vec![0.0; outputs]);
//!
//!     let mut evaluate = |genes: &[u16]| {
//!         let mut parameters = vec![0.0; count];
//!         decode(genes, &ranges, &mut parameters).expect("as many genes as parameters");
//!         let mut net = Perceptron::new(inputs, outputs, 1.0, parameters).expect("finite numbers");
//!         world.restore(&start);
//!         let mut fitness = 0.0;
//!         for _ in 0..100 {
//!             sensors.read(&world, &mut x); // light that comes back -> 0..1
//!             net.step(&x, &mut y);
//!             motors.drive(&y, &mut world); // 0..1 -> speeds of the wheels
//!             world.step(); // 50 ms
//!             // Fast and straight, far from walls.
//!             let (ahead, turn) = (y[0] + y[1] - 1.0, (y[0] - y[1]).abs());
//!             let near = x.iter().copied().fold(0.0, f32::max);
//!             fitness += f64::from(ahead.max(0.0) * (1.0 - turn) * (1.0 - near));
//!         }
//!         fitness
//!     };
//!     let config = GaConfig { population: 20, parents: 4, ..GaConfig::new(count) };
//!     let champion = TruncationGa::new(config, 1)?.maximize(10, &mut evaluate)?;
//!     assert!(champion.fitness.get() > 50.0, "{} of 100", champion.fitness.get());
//!     Ok(())
//! }
//! ```

pub use farsa_body::prelude::*;
#[cfg(feature = "alloc")]
pub use farsa_evo::words::{
    GaConfig, GeneRange, Mutation, OnePlusOne, OnePlusOneConfig, RandomSearch, TruncationGa, decode,
};
#[cfg(feature = "alloc")]
pub use farsa_evo::{Champion, Fitness, Population, Statistics, Strategy};
pub use farsa_nn::{
    Activation, Controller, Ctrnn, CtrnnLayout, Leak, LeakyLayout, LeakyNetwork, LeakyParameter, Perceptron,
};
pub use farsa_num::{Domain, Stream};
#[cfg(feature = "alloc")]
pub use farsa_physics::arena;
pub use farsa_physics::articulated;
#[cfg(feature = "rapier")]
pub use farsa_physics::rapier;
