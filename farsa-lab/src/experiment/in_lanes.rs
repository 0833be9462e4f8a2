//! Many episodes side by side, one in each lane of a batch of worlds.

use farsa_physics::{arena, articulated};

use crate::experiment::episode::{Episode, EpisodeId};

/// A batch of worlds that are stepped together using SIMD. Each lane of the vectors contains a world.
pub trait Batch {
    /// One of the worlds.
    type Lane<'a>
    where
        Self: 'a;

    /// Number of worlds.
    fn lanes(&self) -> usize;

    /// Gets the world in a lane.
    fn lane(&mut self, index: usize) -> Self::Lane<'_>;

    /// Steps all worlds.
    fn step(&mut self);
}

/// Implements the trait by the inherent methods of farsa-physics' batches.
macro_rules! batch {
    ($($module:ident),*) => {$(
        impl Batch for $module::Batch {
            type Lane<'a> = $module::Lane<'a>;

            fn lanes(&self) -> usize {
                self.lanes()
            }

            fn lane(&mut self, index: usize) -> Self::Lane<'_> {
                self.lane(index)
            }

            fn step(&mut self) {
                self.step();
            }
        }
    )*};
}

batch!(articulated, arena);

/// Runs episodes in the lanes of a batch until there are no more.
///
/// Each element of `episodes` uses its own lane. The closure `begin` prepares an episode for its next start. It
/// returns the id of the episode, or `None` after the last one. The closure `end` receives the return of an episode.
///
/// Lanes are refilled as soon as their episode ends. This only affects the time, and each episode is equal to the one
/// that [`run_episode`](crate::advanced::run_episode) runs.
pub fn run_in_lanes<B, E>(
    episodes: &mut [E],
    batch: &mut B,
    mut begin: impl FnMut(&mut E) -> Option<EpisodeId>,
    mut end: impl FnMut(&mut E, f64),
) where
    B: Batch + 'static,
    E: for<'a> Episode<B::Lane<'a>>,
{
    debug_assert!(episodes.len() <= batch.lanes(), "{} episodes in {} lanes", episodes.len(), batch.lanes());
    let lanes = episodes.len().min(batch.lanes());
    let episodes = &mut episodes[..lanes];
    let mut running = vec![false; lanes];
    let mut more = true;
    loop {
        for (index, (episode, running)) in episodes.iter_mut().zip(&mut running).enumerate() {
            let mut lane = batch.lane(index);
            if *running && let Some(sum) = episode.judge(&mut lane) {
                end(episode, sum);
                *running = false;
            }
            while !*running && more {
                // After the last one `begin` is not called again.
                let Some(id) = begin(episode) else {
                    more = false;
                    break;
                };
                episode.start(&mut lane, id);
                *running = episode.has_started();
                if !*running {
                    end(episode, f64::NAN);
                }
            }
            if *running {
                episode.act(&mut lane);
            }
        }
        if !running.contains(&true) {
            return;
        }
        batch.step();
    }
}
