//! How an experiment searches, in a word.

/// How an experiment searches for good genomes, [`Experiment::search`](crate::Experiment::search).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Search {
    /// The best of a generation make mutated copies, [`farsa_evo::TruncationGa`]; with several populations within each of
    /// them, [`farsa_evo::Coevolution`].
    #[default]
    Truncation,
    /// One parent makes one mutant a generation and the better of the two stays, [`farsa_evo::OnePlusOne`].
    ///
    /// The log of such a run is about the mean fitness of the parent over its life and the fitness of the mutant: the
    /// best of the two is that of the survivor, which is the champion.
    OnePlusOne,
    /// Nothing is selected: a generation is one individual, which takes a lesson after it was evaluated, [`Learner::lesson`](crate::Learner::lesson).
    ///
    /// The log of such a run has one fitness three times; errors are in `learning.csv`.
    Learning,
}
