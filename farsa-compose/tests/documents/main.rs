//! Documents of experiments: meaning and errors.

#[path = "../drawn/mod.rs"]
mod drawn;

mod damaged;
mod groups;
mod keys;
mod networks;
mod parts;
mod placements;
mod protocols;
mod rules;
mod steps;
mod warnings;
