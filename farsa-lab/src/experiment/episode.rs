//! An episode: what happens in a world from the first to the last step of a trial.

use farsa_body::Recorder;
use farsa_body::ports::{ActuatorId, BodyId, Handles, JointId, World};
use serde::{Deserialize, Serialize};

use crate::experiment::external::ExternalControl;

/// Identifies an episode of a run.
///
/// These numbers select the streams that all random numbers of the episode are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct EpisodeId {
    /// Seed of the run.
    pub seed: u64,
    /// Generation, from 0.
    pub generation: u32,
    /// Individual within the generation, from 0.
    pub individual: u32,
    /// Trial of the individual, from 0.
    pub trial: u32,
}

impl EpisodeId {
    /// Computes the index of the population that this individual belongs to.
    ///
    /// The `size` is the number of individuals in each population, which is the setting `evolution.population`.
    pub fn population(&self, size: usize) -> usize {
        self.individual as usize / size.max(1)
    }
}

/// A trial in a world of type `W`, with a start and then steps until it ends.
///
/// An episode steps no world: [`run_episode`] does, alone, and [`run_in_lanes`](crate::advanced::run_in_lanes) in a lane of a batch. So
/// the same episode gives the same bits in both.
pub trait Episode<W: ?Sized> {
    /// Sets up the world and the episode. This discards the previous episode.
    fn start(&mut self, world: &mut W, id: EpisodeId);

    /// Checks whether the start succeeded.
    ///
    /// If this is `false`, the episode ends before its first step with a return of NaN.
    fn has_started(&self) -> bool {
        true
    }

    /// Senses, computes and acts, before the world steps.
    fn act(&mut self, world: &mut W);

    /// Judges the last step. `Some(return)` ends the episode.
    ///
    /// Use a return of NaN if the world or the controller produced a number that is not finite. Note that the world is
    /// mutable, since some surroundings react to the robot, such as the ground under a swinging foot.
    fn judge(&mut self, world: &mut W) -> Option<f64>;

    /// Gives access to sensors and motors without the controller, for a [`Stepper`](crate::advanced::Stepper).
    ///
    /// # Errors
    /// Returns the reason if the actions cannot come from outside. This is the default.
    fn external(&mut self) -> Result<&mut dyn ExternalControl<W>, String> {
        Err("its episode takes no actions from outside".into())
    }

    /// Records the rays of sensors. This is called after [`act`](Self::act) and before the world steps.
    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        let _ = (world, recorder);
    }

    /// Records the step that was just judged, and ends the tick of the recorder.
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let _ = (world, recorder);
    }
}

impl<W: ?Sized, E: Episode<W> + ?Sized> Episode<W> for &mut E {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        (**self).start(world, id);
    }
    fn has_started(&self) -> bool {
        (**self).has_started()
    }
    fn act(&mut self, world: &mut W) {
        (**self).act(world);
    }
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        (**self).judge(world)
    }
    fn external(&mut self) -> Result<&mut dyn ExternalControl<W>, String> {
        (**self).external()
    }
    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        (**self).record_action(world, recorder);
    }
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        (**self).record(world, recorder);
    }
}

/// Runs a single episode in `world` and gives its return. Passing a recorder does not change the result.
pub fn run_episode<W, E>(episode: &mut E, world: &mut W, id: EpisodeId, mut recorder: Option<&mut dyn Recorder>) -> f64
where
    W: World + ?Sized,
    E: Episode<W> + ?Sized,
{
    episode.start(world, id);
    if !episode.has_started() {
        return f64::NAN;
    }
    loop {
        episode.act(world);
        if let Some(recorder) = &mut recorder {
            episode.record_action(world, *recorder);
        }
        world.step();
        let end = episode.judge(world);
        if let Some(recorder) = &mut recorder {
            episode.record(world, *recorder);
        }
        if let Some(sum) = end {
            return sum;
        }
    }
}

/// An empty world without a clock. Use this if your episode already holds all of its state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct NoWorld;

impl Handles for NoWorld {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl World for NoWorld {
    fn step(&mut self) {}

    fn time_step(&self) -> f32 {
        0.0
    }
}

/// Records a row of scalars and ends the tick at `time` \[s\]. If there is no recorder, this does nothing.
pub fn record_row(recorder: &mut Option<&mut dyn Recorder>, time: f64, values: &[f64]) {
    if let Some(recorder) = recorder {
        recorder.scalars(values);
        recorder.tick(time);
    }
}

/// Computes the time after the given number of steps \[s\].
///
/// This is rounded to the nanosecond, so that 201 steps of 0.1 s give 20.1 s.
pub fn seconds(steps: u32, time_step: f64) -> f64 {
    (f64::from(steps) * time_step * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Clock(u32);

    impl Handles for Clock {
        type Body = BodyId;
        type Joint = JointId;
        type Actuator = ActuatorId;
    }

    impl World for Clock {
        fn step(&mut self) {
            self.0 += 1;
        }
        fn time_step(&self) -> f32 {
            0.01
        }
    }

    /// Ends at the sixth step, or cannot start.
    struct UntilSix {
        trial: u32,
        acts: u32,
    }

    impl Episode<Clock> for UntilSix {
        fn start(&mut self, world: &mut Clock, id: EpisodeId) {
            world.0 = 0;
            (self.trial, self.acts) = (id.trial, 0);
        }
        fn has_started(&self) -> bool {
            self.trial < 9
        }
        fn act(&mut self, world: &mut Clock) {
            assert_eq!(world.0, self.acts);
            self.acts += 1;
        }
        fn judge(&mut self, world: &mut Clock) -> Option<f64> {
            (world.0 == 6).then(|| f64::from(world.0 + self.trial))
        }
        fn record_action(&self, world: &Clock, recorder: &mut dyn Recorder) {
            assert_eq!(world.0 + 1, self.acts);
            recorder.scalars(&[f64::from(world.0)]);
        }
        fn record(&self, world: &Clock, recorder: &mut dyn Recorder) {
            recorder.tick(seconds(world.0, 0.1));
        }
    }

    #[derive(Default)]
    struct Log(Vec<f64>, Vec<f64>);

    impl Recorder for Log {
        fn scalars(&mut self, values: &[f64]) {
            self.0.extend_from_slice(values);
        }
        fn tick(&mut self, time: f64) {
            self.1.push(time);
        }
    }

    #[test]
    fn an_episode_is_judged_after_every_step_and_starts_afresh() {
        let (mut world, mut episode) = (Clock(99), UntilSix { trial: 0, acts: 0 });
        assert_eq!(run_episode(&mut episode, &mut world, EpisodeId::default(), None), 6.0);
        let mut log = Log::default();
        let id = EpisodeId { trial: 4, ..EpisodeId::default() };
        assert_eq!(run_episode(&mut episode, &mut world, id, Some(&mut log)), 10.0);
        assert_eq!((world.0, episode.acts), (6, 6));
        assert_eq!(log.0, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(log.1, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
        let id = EpisodeId { trial: 9, ..EpisodeId::default() };
        assert!(run_episode(&mut episode, &mut world, id, None).is_nan() && episode.acts == 0);
    }
}
