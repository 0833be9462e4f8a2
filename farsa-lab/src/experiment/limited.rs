//! An episode with a maximum number of steps.

use std::sync::atomic::{AtomicBool, Ordering};

use farsa_body::Recorder;

use crate::experiment::episode::{Episode, EpisodeId};
use crate::experiment::outcome::{Failure, Outcome};

/// An episode that is stopped after a maximum number of steps, or when a flag becomes true.
pub(crate) struct Limited<E> {
    pub(crate) episode: E,
    pub(crate) stop: Option<&'static AtomicBool>,
    budget: u64,
    left: u64,
    stopped: bool,
}

impl<E> Limited<E> {
    /// An episode that has at most `budget` steps.
    pub(crate) fn new(episode: E, budget: u64) -> Self {
        Self { episode, stop: None, budget, left: budget, stopped: false }
    }

    /// Gets the outcome if the episode was stopped.
    pub(crate) fn stopped(&self) -> Option<Outcome> {
        let steps = u32::try_from(self.budget - self.left).unwrap_or(u32::MAX);
        let failure = if self.left > 0 { Failure::Interrupted } else { Failure::Endless(self.budget) };
        self.stopped.then(|| Outcome { steps, failure: Some(failure), ..Outcome::failed() })
    }

    fn is_interrupted(&self) -> bool {
        self.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }
}

impl<W: ?Sized, E: Episode<W>> Episode<W> for Limited<E> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        (self.left, self.stopped) = (self.budget, false);
        self.episode.start(world, id);
    }

    fn has_started(&self) -> bool {
        self.episode.has_started()
    }

    fn act(&mut self, world: &mut W) {
        self.episode.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        let end = self.episode.judge(world);
        self.left = self.left.saturating_sub(1);
        self.stopped = end.is_none() && (self.left == 0 || self.is_interrupted());
        if self.stopped { Some(f64::NAN) } else { end }
    }

    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        self.episode.record_action(world, recorder);
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        self.episode.record(world, recorder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::episode::{NoWorld, run_episode};

    /// Ends after a number of steps.
    struct Steps(u32, u32);

    impl Episode<NoWorld> for Steps {
        fn start(&mut self, _: &mut NoWorld, id: EpisodeId) {
            *self = Self(0, id.trial);
        }
        fn act(&mut self, _: &mut NoWorld) {
            self.0 += 1;
        }
        fn judge(&mut self, _: &mut NoWorld) -> Option<f64> {
            (self.0 == self.1).then(|| f64::from(self.0))
        }
    }

    #[test]
    fn an_episode_ends_with_its_budget_and_the_next_has_a_new_one() {
        let mut episode = Limited::new(Steps(0, 0), 5);
        for (wanted, stopped) in [(3, false), (5, false), (6, true), (0, true), (4, false)] {
            let id = EpisodeId { trial: wanted, ..EpisodeId::default() };
            let end = run_episode(&mut episode, &mut NoWorld, id, None);
            assert_eq!(end.is_nan(), stopped, "{wanted}");
            assert_eq!((episode.stopped().is_some(), episode.episode.0), (stopped, if stopped { 5 } else { wanted }));
        }
    }

    #[test]
    fn a_flag_ends_an_episode_after_its_step() {
        static STOP: AtomicBool = AtomicBool::new(true);
        let mut episode = Limited { stop: Some(&STOP), ..Limited::new(Steps(0, 0), 5) };
        // An episode that ends in the same step is complete.
        for (wanted, interrupted) in [(3, true), (1, false)] {
            let id = EpisodeId { trial: wanted, ..EpisodeId::default() };
            assert_eq!(run_episode(&mut episode, &mut NoWorld, id, None).is_nan(), interrupted);
            let failure = episode.stopped().map(|outcome| (outcome.steps, outcome.failure));
            assert_eq!(failure, interrupted.then_some((1, Some(Failure::Interrupted))));
        }
    }
}
