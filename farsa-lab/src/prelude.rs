//! Names that most experiments need, for `use farsa_lab::prelude::*`.

pub use farsa_view::Schema;

pub use crate::error::Error;
pub use crate::experiment::{
    Controlled, Description, Episode, EpisodeId, Evaluation, Evaluator, InWorld, Neurocontroller, Note, Objective,
    Outcome, Parameter, PlanarWorld, Setting, Settings, Task, TaskInfo, Trials, record_row, run_episode,
};
pub use crate::run::{Experiment, Laboratory, SimpleExperiment};
