//! Configurations of the original FARSA as files of ours.
//!
//! - `ini`: a text in the original's format
//! - `group`: what a group says, asked for key by key
//! - `remarks`: what cannot be carried over, and why
//! - `experiment`: steps, trials, arena and the plugin
//! - `robot`: the robot
//! - `channels`: what sensors and motors have in common
//! - `sensor`: the sensors
//! - `motor`: the motors
//! - `network`: the network
//! - `evolution`: the algorithm that searches
//! - `written`: the file that is written
//! - `import`: all of it

mod channels;
mod evolution;
mod experiment;
mod group;
mod import;
mod ini;
mod motor;
mod network;
mod remarks;
mod robot;
mod sensor;
mod written;

pub use import::from_original;
