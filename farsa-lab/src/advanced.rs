//! Parts of the laboratory beyond an experiment, its episodes and its objective.

pub use farsa_view::shape::SceneObject;
pub use farsa_view::{Channel, ImageChannel, Links, NodeParameters, Recording, Schema, View};

pub use crate::error::{FileFault, nearest_name};
#[cfg(feature = "command")]
pub use crate::evaluation::TestTrial;
pub use crate::evaluation::read_genotypes;
pub use crate::experiment::{
    Anatomy, Batch, Behavior, Bodies, Case, CaseId, ChannelGroup, Description, Displacement, ExternalControl, Failure,
    Genotype, InLanes, Intervention, Interventions, Iteration, Lanes, Learner, NoWorld, NormalizedController,
    NotedBehavior, OwnedNetwork, PartNames, PlanarWorld, Protocol, Push, Rescored, Rollout, Source, StepResult,
    Stepper, Value, input_ranges, mean_of_note, mean_of_trials, network_parameters, record_row, resting_network,
    run_episode, run_in_lanes, seconds,
};
pub use crate::limits::Limits;
pub use crate::live::{LiveModule, LiveSession};
pub use crate::ranks::{Alone, Ranks};
pub use crate::run::{
    ENGINE, ExperimentFiles, ImportExperiment, ImportedFile, LeftOut, Part, ReadExperiment, Template, Vocabulary,
};
#[cfg(feature = "command")]
pub use crate::run::{Evaluated, Problem, ProblemOptions, Search};
pub use crate::run_directory::{GenerationRecord, LogRow, RunChampion, RunDirectory};
pub use crate::store::{VALUES_VERSION, read_text_file};
