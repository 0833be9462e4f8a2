//! Episodes that a caller steps, in one world or in the lanes of a batch.

use farsa_body::Recorder;
use farsa_body::ports::World;

use crate::error::Error;
use crate::experiment::episode::{Episode, EpisodeId};
use crate::experiment::evaluator::Evaluation;
use crate::experiment::in_lanes::Batch;
use crate::experiment::limited::Limited;
use crate::experiment::outcome::Outcome;
use crate::experiment::rollout::Rollout;
use crate::experiment::stepper::{StepResult, Stepper, not_stepped};

/// An episode that is stepped.
struct Stepped<R> {
    limited: Limited<R>,
    running: bool,
    earned: f64,
}

impl<R: Rollout> Stepped<R> {
    fn new(rollout: R, budget: u64) -> Self {
        Self { limited: Limited::new(rollout, budget), running: false, earned: 0.0 }
    }

    /// Loads parameters that no step uses, since some tasks prepare more than their controller with them.
    fn prepare(&mut self) -> Result<(), Error> {
        let info = self.limited.episode.info();
        let middle = |[first, other]: [f64; 2]| f64::midpoint(first, other) as f32;
        let parameters: Vec<f32> = info.parameters.iter().map(|parameter| middle(parameter.ends)).collect();
        if self.limited.episode.load(&Evaluation::new(&parameters, EpisodeId::default())) {
            return Ok(());
        }
        Err(Error::Other(format!("{} parameters in the middle of their ranges do not fit", parameters.len())))
    }

    fn start<W: ?Sized>(&mut self, world: &mut W, id: EpisodeId, observation: &mut [f32]) -> bool
    where
        R: Episode<W>,
    {
        self.limited.start(world, id);
        (self.running, self.earned) = (self.limited.has_started(), 0.0);
        self.observe(world, observation);
        self.running
    }

    fn observe<W: ?Sized>(&mut self, world: &W, observation: &mut [f32])
    where
        R: Episode<W>,
    {
        if let Ok(external) = self.limited.episode.external() {
            external.observe(world);
            observation.copy_from_slice(external.observation());
        }
    }

    fn actuate<W: ?Sized>(&mut self, world: &mut W, action: &[f32])
    where
        R: Episode<W>,
    {
        if self.running
            && let Ok(external) = self.limited.episode.external()
        {
            external.actuate(action, world);
        }
    }

    fn judge<W: ?Sized>(&mut self, world: &mut W, observation: &mut [f32]) -> StepResult
    where
        R: Episode<W>,
    {
        if !self.running {
            return StepResult::default();
        }
        let end = self.limited.judge(world);
        let stopped = self.limited.stopped().is_some();
        let mut result = StepResult::default();
        if let Ok(external) = self.limited.episode.external() {
            let earned = external.earned();
            let failed = !earned.is_finite() || !stopped && end.is_some_and(f64::is_nan);
            let truncated = stopped || end.is_some() && external.is_truncated(world);
            result = StepResult {
                reward: if failed { 0.0 } else { earned - self.earned },
                terminated: failed || end.is_some() && !truncated,
                truncated: truncated && !failed,
                failed,
            };
            self.earned = earned;
        }
        self.running = !result.is_last();
        self.observe(world, observation);
        result
    }

    fn outcome(&self) -> Outcome {
        self.limited.stopped().unwrap_or_else(|| self.limited.episode.outcome())
    }
}

/// One world with its episode.
struct OneWorld<W, R> {
    world: W,
    stepped: Stepped<R>,
    channels: [usize; 2],
}

impl<W: World + Send, R: Rollout + Episode<W>> Stepper for OneWorld<W, R> {
    fn worlds(&self) -> usize {
        1
    }

    fn channels(&self) -> [usize; 2] {
        self.channels
    }

    fn start(&mut self, _: usize, id: EpisodeId, observation: &mut [f32]) -> bool {
        self.stepped.start(&mut self.world, id, observation)
    }

    fn step(&mut self, actions: &[f32], results: &mut [StepResult], observations: &mut [f32]) {
        let Some(result) = results.first_mut() else { return };
        if self.stepped.running {
            self.stepped.actuate(&mut self.world, actions);
            self.world.step();
        }
        *result = self.stepped.judge(&mut self.world, observations);
    }

    fn earned(&self, _: usize) -> f64 {
        self.stepped.earned
    }

    fn outcome(&self, _: usize) -> Outcome {
        self.stepped.outcome()
    }

    fn record(&mut self, _: usize, recorder: &mut dyn Recorder) {
        self.stepped.limited.record(&self.world, recorder);
    }
}

/// A batch of worlds, each with its episode.
struct BatchOfWorlds<B, R> {
    batch: B,
    worlds: Vec<Stepped<R>>,
    channels: [usize; 2],
}

impl<B, R> Stepper for BatchOfWorlds<B, R>
where
    B: Batch + Send + 'static,
    R: Rollout + for<'a> Episode<B::Lane<'a>>,
{
    fn worlds(&self) -> usize {
        self.worlds.len()
    }

    fn channels(&self) -> [usize; 2] {
        self.channels
    }

    fn start(&mut self, world: usize, id: EpisodeId, observation: &mut [f32]) -> bool {
        self.worlds[world].start(&mut self.batch.lane(world), id, observation)
    }

    fn step(&mut self, actions: &[f32], results: &mut [StepResult], observations: &mut [f32]) {
        let Self { batch, worlds, channels: [inputs, outputs] } = self;
        if worlds.iter().all(|world| !world.running) {
            results.fill(StepResult::default());
            return;
        }
        for (index, (world, action)) in worlds.iter_mut().zip(actions.chunks_exact(*outputs)).enumerate() {
            world.actuate(&mut batch.lane(index), action);
        }
        batch.step();
        let rows = results.iter_mut().zip(observations.chunks_exact_mut(*inputs));
        for (index, (world, (result, observation))) in worlds.iter_mut().zip(rows).enumerate() {
            *result = world.judge(&mut batch.lane(index), observation);
        }
    }

    fn earned(&self, world: usize) -> f64 {
        self.worlds[world].earned
    }

    fn outcome(&self, world: usize) -> Outcome {
        self.worlds[world].outcome()
    }

    fn record(&mut self, world: usize, recorder: &mut dyn Recorder) {
        self.worlds[world].limited.record(&self.batch.lane(world), recorder);
    }
}

/// Steps an episode in one world.
pub(crate) fn in_one_world<W, R>(world: W, rollout: R) -> Result<Box<dyn Stepper>, Error>
where
    W: World + Send + 'static,
    R: Rollout + Episode<W> + 'static,
{
    let budget = rollout.info().step_budget();
    let mut stepped = Stepped::new(rollout, budget);
    let channels = stepped.limited.episode.external().map_err(|why| not_stepped(&why))?.channels();
    stepped.prepare()?;
    Ok(Box::new(OneWorld { world, stepped, channels }))
}

/// Steps episodes in the lanes of a batch.
pub(crate) fn in_batch<B, R>(mut batch: B, rollouts: Vec<R>) -> Result<Box<dyn Stepper>, Error>
where
    B: Batch + Send + 'static,
    R: Rollout + for<'a> Episode<B::Lane<'a>> + 'static,
{
    let mut channels = [0; 2];
    let mut worlds = Vec::with_capacity(rollouts.len());
    for rollout in rollouts {
        let budget = rollout.info().step_budget();
        let mut stepped = Stepped::new(rollout, budget);
        channels = of_lane(&mut batch, &mut stepped)?;
        stepped.prepare()?;
        worlds.push(stepped);
    }
    Ok(Box::new(BatchOfWorlds { batch, worlds, channels }))
}

/// Gets the channels of an episode in a lane, or the reason why it cannot be stepped.
fn of_lane<B, R>(batch: &mut B, stepped: &mut Stepped<R>) -> Result<[usize; 2], Error>
where
    B: Batch + 'static,
    R: Rollout + for<'a> Episode<B::Lane<'a>>,
{
    // Names the type of the lane, of which there are many.
    fn channels<W, R: Episode<W>>(_: &W, rollout: &mut R) -> Result<[usize; 2], String> {
        rollout.external().map(|external| external.channels())
    }
    channels(&batch.lane(0), &mut stepped.limited.episode).map_err(|why| not_stepped(&why))
}
