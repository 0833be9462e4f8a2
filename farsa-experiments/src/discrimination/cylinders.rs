//! The experiment `discrimination-cylinders`: a large and a small cylinder, distinguished by moving.

use std::path::PathBuf;

use farsa_lab::{Error, Evaluator, Experiment, Setting, Settings};

use crate::discrimination::config::Config;
use crate::discrimination::experiment::{GENE_BITS, in_its_world};
use crate::infrared::settings::InfraredModel;

/// Can a robot tell a large cylinder from a small one by how it must move to stay beside it? \[FARSA2; Ferrauto2010, 4.6.5\]
///
/// The robot of [`Discrimination`](crate::Discrimination) in an arena with both; what it earns for staying near the large
/// one it loses near the small one. It feels how fast its wheels turn (condition `wheels`) or does not (`no-wheels`): the
/// wheels' speeds are the only memory that its layer of two units has.
///
/// Chosen: the arena's size, the cylinders' distance, the fitness and the search by truncation selection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct DiscriminationCylinders;

const WHEELS: &str = "wheels";
const NO_WHEELS: &str = "no-wheels";

impl Experiment for DiscriminationCylinders {
    fn name(&self) -> &'static str {
        "discrimination-cylinders"
    }

    fn summary(&self) -> &'static str {
        "a Khepera stays near a large cylinder and not near a small one, with or without feeling its wheels"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &[WHEELS, NO_WHEELS]
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        let mut table = Config::two_cylinders(condition != NO_WHEELS).table();
        table.extend([
            Setting::whole("evolution.generations", 300, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated; the one thing that a resumed run may change."),
            Setting::whole("evolution.population", 40, 1..=1_000_000)
                .doc("Individuals of a generation, a multiple of the parents."),
            Setting::whole("evolution.parents", 8, 1..=1_000_000)
                .doc("The best individuals, which make population / parents copies each, the first of them unchanged."),
        ]);
        table
    }

    fn files(&self, _: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        InfraredModel::files(settings)
    }

    fn gene_bits(&self) -> u32 {
        GENE_BITS
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        in_its_world(Config::two_cylinders(condition != NO_WHEELS).read(settings)?)
    }
}
