//! When runs are compared: at a generation, or after as many evaluations where their generations differ in size.

use crate::figures::chart::Across;
use crate::report::run::{Group, Run};

/// Points of a curve over evaluations.
const POINTS: u64 = 500;

/// The last moment that some runs have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Moment {
    Generation(usize),
    Evaluations(u64),
}

impl Moment {
    /// The last that all runs of all groups have.
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

    /// The generation of a run that was finished last by then; none if there is none.
    pub(crate) fn generation(self, run: &Run<'_>) -> Option<usize> {
        match self {
            Self::Generation(generation) => Some(generation),
            Self::Evaluations(most) => evaluations(run).partition_point(|&count| count <= most).checked_sub(1),
        }
    }

    /// In words, for runs of which it is the last.
    pub(crate) fn words(self) -> String {
        match self {
            Self::Generation(generation) => format!("at generation {generation}, the last that all of them have"),
            Self::Evaluations(most) => {
                format!("after {most} evaluations, the most that all of them have (their generations differ in size)")
            }
        }
    }

    /// What lies along the axis of curves.
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

/// The place of a run's last generation along an axis.
pub(crate) fn length(run: &Run<'_>, across: Across) -> usize {
    match across {
        Across::Generations => run.last(),
        Across::Evaluations(step) => evaluations(run).last().map_or(0, |most| (most / step) as usize),
    }
}

/// The generation of a run at a place along an axis, if one is finished by then.
pub(crate) fn generation_at(run: &Run<'_>, across: Across, place: usize) -> Option<usize> {
    match across {
        Across::Generations => Some(place),
        Across::Evaluations(step) => Moment::Evaluations(step * place as u64).generation(run),
    }
}

/// How many evaluations each generation had finished.
fn evaluations(run: &Run<'_>) -> Vec<u64> {
    let mut sum = 0_u64;
    let add = |line: &crate::store::log::Line| {
        sum = sum.saturating_add(line.evaluations);
        sum
    };
    run.lines.iter().map(add).collect()
}
