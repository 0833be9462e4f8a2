//! Documents of experiments: what they say, and what is wrong with them.

#[path = "../drawn/mod.rs"]
mod drawn;

mod damaged;
mod groups;
mod networks;
mod parts;
mod protocols;
mod rules;
mod steps;
