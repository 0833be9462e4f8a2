//! The experiment `foraging`: a team carries food to its nest.
//!
//! - `baseline`: a forager without evolution, to compare evolved ones with
//! - `config`: the values of `foraging`, as settings
//! - `experiment`: its name, conditions and settings, and what lives its lives
//! - `field`: food on a square field, and the robots that live on it: a book of accounts
//! - `life`: a life of `foraging`: robots carry food from a field to their nest, and must come home to live

mod baseline;
mod config;
mod experiment;
mod field;
mod life;

pub use crate::team::config::TeamConfig;
pub use crate::team::eyes::RobotEyes;
pub use crate::team::robots::Team;
pub use crate::team::{life::Mission, life::Moment, life::TeamLife};
pub use baseline::HomingForager;
pub use config::ForagingConfig;
pub use experiment::{Foraging, forage};
pub use farsa_lab::OwnedNetwork;
pub use field::{Field, Forager};
pub use life::{ForagingLife, ForagingMission};
