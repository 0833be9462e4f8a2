//! Written robots are read unchanged. Wrong, hostile or damaged files are refused with the place of the fault.
#![allow(missing_docs, clippy::unwrap_used)]

/// Bounds of masses.
mod bounds;
/// Contacts of MuJoCo.
mod contacts;
/// MuJoCo's classes of defaults.
mod defaults;
/// Meshes that views draw.
mod drawn;
/// Faults with their place and the nearest name, and MuJoCo's rules.
mod faults;
/// The files that a model names.
mod files;
/// Hostile and damaged texts.
mod hostile;
/// The iCub, written and read.
mod icub;
/// Models as large as the limits.
mod keyframes;
mod large;
/// Limits of joints and actuators.
mod limits;
/// Visuals.
mod looks;
/// Parts of an MJCF that are left out, and the list of them.
mod losses;
/// Masses of meshes.
mod meshes;
/// Whatever is read is written and read back.
mod round_trip;
/// Settings of an MJCF that change the robot.
mod settings;
/// Wheeled robots that were written are read as they were.
mod wheeled;
/// Robots that were written are read as they were.
mod written;

use std::fs;
use std::path::Path;

use farsa_models::{Imported, ReadError, ReadOptions};

fn read(text: &str) -> Result<Imported, ReadError> {
    Imported::from_text(text, &ReadOptions::default())
}

fn fixture(name: &str) -> String {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures")).join(name);
    fs::read_to_string(path).unwrap()
}

fn message(text: &str) -> String {
    read(text).unwrap_err().to_string()
}
