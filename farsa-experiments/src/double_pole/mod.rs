//! The experiment `double-pole`: two poles on a cart.
//!
//! - `config`: the values of `double-pole`, as settings
//! - `experiment`: its name, conditions and settings, and what runs its trials
//! - `episode`: an episode of `double-pole`: a network pushes the cart until a pole falls
//! - `cart`: the cart, its poles and their equations of motion
//! - `network`: the networks of `double-pole`, one for each number of inputs and hidden neurons

mod cart;
mod config;
mod episode;
mod experiment;
mod network;

pub use cart::{Cart, CartState, Pole};
pub use config::Config;
pub use episode::CartEpisode;
pub use experiment::{Balancing, DoublePole, evaluator};
pub use network::{MOST_HIDDEN, layout, neuron_order};
