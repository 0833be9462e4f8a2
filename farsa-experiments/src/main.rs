//! The `farsa` command over the reference experiments.

use std::process::ExitCode;

use farsa_experiments::{
    Aggregation, BodyEvolution, Braitenberg, Discrimination, DiscriminationCylinders, Foraging, PassiveWalker,
    PredatorPrey, PushBox, ReachGraspLift, cli,
};

fn main() -> ExitCode {
    cli::main(&[
        &ReachGraspLift,
        &Discrimination,
        &DiscriminationCylinders,
        &Braitenberg,
        &Foraging,
        &Aggregation,
        &PredatorPrey,
        &PushBox,
        &PassiveWalker,
        &BodyEvolution,
    ])
}
