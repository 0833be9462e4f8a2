//! The `farsa` command over the reference experiments.

use std::process::ExitCode;

use farsa_experiments::{
    Aggregation, BodyEvolution, Braitenberg, Discrimination, DiscriminationCylinders, DoublePole, Foraging,
    KinestheticGrasp, MinimalCognition, PassiveWalker, PredatorPrey, PushBox, ReachGraspLift,
};
use farsa_lab::cli;

fn main() -> ExitCode {
    cli::main(&[
        &ReachGraspLift,
        &KinestheticGrasp,
        &Discrimination,
        &DiscriminationCylinders,
        &Braitenberg,
        &MinimalCognition,
        &DoublePole,
        &Foraging,
        &Aggregation,
        &PredatorPrey,
        &PushBox,
        &PassiveWalker,
        &BodyEvolution,
    ])
}
