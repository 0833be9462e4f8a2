//! Documents of experiments: meaning and errors.

#[path = "../drawn/mod.rs"]
mod drawn;

mod damaged;
mod files;
mod groups;
mod keys;
mod networks;
mod parts;
mod placements;
mod protocols;
mod rules;
mod settings;
mod sizes;
mod steps;
mod warnings;
