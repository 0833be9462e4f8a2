//! The experiment `double-pole`, in which a network balances two poles on a cart.

/// The cart, its poles and their equations of motion.
mod cart;
/// The values of `double-pole`, as settings.
mod config;
/// An episode of `double-pole`: a network pushes the cart until a pole falls.
mod episode;
/// Its name, conditions and settings, and what runs its trials.
mod experiment;
/// The networks of `double-pole`, one for each number of inputs and hidden neurons.
mod network;

pub use cart::{Cart, CartState, Pole};
pub use config::Config;
pub use episode::CartEpisode;
pub use experiment::{Balancing, DoublePole, evaluator};
pub use network::{MOST_HIDDEN, layout, neuron_order};
