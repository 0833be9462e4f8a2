#![doc = include_str!("../README.md")]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod compositional_instructions;
pub mod double_pole;
mod embedded;
mod icub_limits;
pub mod icub_reach;
pub mod icub_reach_grasp;
pub mod kinesthetic_grasp;
pub mod minimal_cognition;
pub mod push_box;
pub mod reach_grasp_lift;
mod smooth;
mod strategy;
pub mod walking;
mod worlds;

pub use embedded::{
    AGGREGATION, ANT, ANT_OMNI, BRAITENBERG, DISCRIMINATION, DISCRIMINATION_CYLINDERS, EmbeddedExperiment, FORAGING,
    G1_WALK, GO1_JOYSTICK, HALF_CHEETAH, HOPPER, HUMANOID, ModelExperiment, PREDATOR_PREY, WALKER2D,
};
pub use farsa_compose::Reflex;

/// Returns the laboratory of the `farsa` command with all experiments, all strategies and support for experiment files.
pub fn laboratory() -> farsa_lab::Laboratory<'static> {
    let files = farsa_compose::FILES;
    #[cfg(feature = "command")]
    let files = farsa_lab::advanced::ExperimentFiles { import: Some(farsa_original::from_original), ..files };
    let laboratory = farsa_lab::Laboratory::new(&all()).with_files(files);
    #[cfg(feature = "command")]
    let laboratory = laboratory.with_live_module(include_bytes!("live.wasm.gz"), &["rapier"]);
    laboratory
}

/// Returns all experiments in the order of the `farsa list` command.
pub fn all() -> [&'static dyn farsa_lab::Experiment; 24] {
    [
        &reach_grasp_lift::ReachGraspLift,
        &compositional_instructions::CompositionalInstructions,
        &icub_reach::IcubReach,
        &icub_reach_grasp::IcubReachGrasp,
        &kinesthetic_grasp::KinestheticGrasp,
        &DISCRIMINATION,
        &DISCRIMINATION_CYLINDERS,
        &BRAITENBERG,
        &minimal_cognition::MinimalCognition,
        &double_pole::DoublePole,
        &FORAGING,
        &AGGREGATION,
        &PREDATOR_PREY,
        &push_box::PushBox,
        &walking::passive_walker::PassiveWalker,
        &walking::body_evolution::BodyEvolution,
        &HOPPER,
        &WALKER2D,
        &HALF_CHEETAH,
        &ANT,
        &ANT_OMNI,
        &HUMANOID,
        &GO1_JOYSTICK,
        &G1_WALK,
    ]
}
