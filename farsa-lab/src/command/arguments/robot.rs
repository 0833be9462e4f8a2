//! Arguments of `farsa robot`.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use farsa_models::{Meshes, ReadOptions, Repair};

use crate::export::files::ModelFormat;

#[derive(Args)]
#[command(allow_negative_numbers = true)]
#[expect(clippy::struct_excessive_bools, reason = "the switches of a command")]
pub(crate) struct RobotArgs {
    /// A URDF or MJCF file
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// The folder that contains all files named in it [default: its own]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) root: Option<PathBuf>,
    /// A folder of packages for meshes at package://, repeatable
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) packages: Vec<PathBuf>,
    /// Let the root of a URDF move freely instead of fixing it
    #[arg(long)]
    pub(crate) floating: bool,
    /// Omit meshes
    #[arg(long)]
    pub(crate) without_meshes: bool,
    /// The mass of moving bodies without mass [kg]
    #[arg(long, value_name = "KG", default_value_t = 0.0, value_parser = not_negative)]
    pub(crate) least_mass: f64,
    /// The least moments of inertia of moving bodies [kg m2]
    #[arg(long, value_name = "KGM2", default_value_t = 0.0, value_parser = not_negative)]
    pub(crate) least_inertia: f64,
    /// Replace impossible moments of inertia by their mean
    #[arg(long)]
    pub(crate) balance: bool,
    /// Also write the robot in this format
    #[arg(long, value_enum)]
    pub(crate) format: Option<ModelFormat>,
    /// A new file for it [default: standard output]
    #[arg(long, value_name = "FILE", requires = "format", value_hint = ValueHint::FilePath)]
    pub(crate) out: Option<PathBuf>,
    /// Write JSON
    #[arg(long, conflicts_with = "format")]
    pub(crate) json: bool,
}

fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| "must be a number from 0 on".into())
}

impl RobotArgs {
    pub(crate) fn options(&self) -> ReadOptions {
        ReadOptions {
            root: self.root.clone(),
            packages: self.packages.clone(),
            floating: self.floating,
            meshes: if self.without_meshes { Meshes::Leave } else { Meshes::Fit },
            repair: Repair { least_mass: self.least_mass, least_inertia: self.least_inertia, balance: self.balance },
            ..ReadOptions::default()
        }
    }
}
