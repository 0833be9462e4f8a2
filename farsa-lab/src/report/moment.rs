//! Moment at which runs are compared: a generation, or a number of evaluations if generations differ in size.

use crate::figures::chart::Across;
use crate::report::run::{Group, Run};

/// Number of points of a curve over evaluations.
const POINTS: u64 = 500;

/// Last moment that some runs have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Moment {
    Generation(usize),
    Evaluations(u64),
}

impl Moment {
    /// Finds the last common moment of all runs.
    pub(crate) fn common(groups: &[Group<'_>]) -> Self {
        let generation = groups.iter().map(Group::common).min().unwrap_or(0);
        let mut runs = groups.iter().flat_map(|group| &group.runs);
        let first = runs.clone().next();
        let alike = |run: &&Run<'_>| {
            let each =
                |run: &Run<'_>| run.lines.iter().take(generation + 1).map(|line| line.evaluations).collect::<Vec<_>>();
            first.is_some_and(|first| each(first) == each(run))
        };
        if runs.all(alike) {
            return Self::Generation(generation);
        }
        let runs = groups.iter().flat_map(|group| &group.runs);
        Self::Evaluations(runs.map(|run| evaluations(run).last().copied().unwrap_or(0)).min().unwrap_or(0))
    }

    /// Finds the last finished generation of a run at this moment, if any.
    pub(crate) fn generation(self, run: &Run<'_>) -> Option<usize> {
        match self {
            Self::Generation(generation) => Some(generation),
            Self::Evaluations(most) => evaluations(run).partition_point(|&count| count <= most).checked_sub(1),
        }
    }

    /// Describes the last common moment.
    pub(crate) fn words(self) -> String {
        match self {
            Self::Generation(generation) => format!("at generation {generation}, the last common one"),
            Self::Evaluations(most) => {
                format!("after {most} evaluations, the largest common number, because generations differ in size")
            }
        }
    }

    /// Builds the lower axis of curves.
    pub(crate) fn axis(self, groups: &[Group<'_>]) -> Across {
        match self {
            Self::Generation(_) => Across::Generations,
            Self::Evaluations(_) => {
                let runs = groups.iter().flat_map(|group| &group.runs);
                let most = runs.filter_map(|run| evaluations(run).last().copied()).max().unwrap_or(0);
                Across::Evaluations(most.div_ceil(POINTS).max(1))
            }
        }
    }
}

/// Gets the position of a run's last generation on an axis.
pub(crate) fn length(run: &Run<'_>, across: Across) -> usize {
    match across {
        Across::Generations => run.last(),
        Across::Evaluations(step) => evaluations(run).last().map_or(0, |most| (most / step) as usize),
    }
}

/// Finds the last finished generation of a run at a position on an axis.
pub(crate) fn generation_at(run: &Run<'_>, across: Across, place: usize) -> Option<usize> {
    match across {
        Across::Generations => Some(place),
        Across::Evaluations(step) => Moment::Evaluations(step * place as u64).generation(run),
    }
}

/// Returns the number of evaluations up to each generation.
fn evaluations(run: &Run<'_>) -> Vec<u64> {
    let mut sum = 0_u64;
    let add = |line: &crate::store::log::Line| {
        sum = sum.saturating_add(line.evaluations);
        sum
    };
    run.lines.iter().map(add).collect()
}
