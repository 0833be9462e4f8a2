//! Environments that one thread steps.

use farsa_lab::EpisodeId;
use farsa_lab::advanced::{Recording, StepResult, Stepper};

/// Most episodes that are tried until one finds a place for everything.
const MAX_STARTS: u64 = 1000;

/// Time of the reset of an environment whose episode has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Autoreset {
    /// In the step that ends the episode.
    SameStep,
    /// In the next step, which ignores its action.
    NextStep,
    /// Only by `reset`.
    Disabled,
}

/// Episodes of an environment: all trials of an individual, one generation after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Episodes {
    pub(crate) seed: u64,
    pub(crate) individual: u32,
    /// Number of the next episode.
    pub(crate) next: u64,
}

impl Episodes {
    fn draw(&mut self, trials: u64) -> EpisodeId {
        let Self { seed, individual, next } = *self;
        self.next = next.wrapping_add(1);
        let generation = u32::try_from(next / trials).unwrap_or(u32::MAX);
        EpisodeId { seed, generation, individual, trial: (next % trials) as u32 }
    }
}

/// Order to an environment in a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    Keep,
    /// Starts the next episode.
    Next,
    /// Starts the next of other episodes.
    From(Episodes),
}

/// Work of a thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Job {
    Reset,
    Step,
}

/// An episode that ended in the last step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ended {
    /// Number of the environment.
    pub(crate) environment: usize,
    pub(crate) fitness: f64,
    pub(crate) steps: u32,
    pub(crate) success: bool,
    pub(crate) failed: bool,
    pub(crate) terms: Vec<f64>,
    /// Last observation, if a new episode has begun.
    pub(crate) observation: Option<Vec<f32>>,
}

/// Environments of one thread with their buffers.
pub(crate) struct Chunk {
    /// Number of the first environment.
    pub(crate) first: usize,
    pub(crate) job: Job,
    mode: Autoreset,
    trials: u64,
    channels: [usize; 2],
    /// Worlds of each stepper.
    lanes: usize,
    steppers: Vec<Box<dyn Stepper>>,
    episodes: Vec<Episodes>,
    pub(crate) orders: Vec<Order>,
    pub(crate) actions: Vec<f32>,
    pub(crate) observations: Vec<f32>,
    pub(crate) results: Vec<StepResult>,
    /// True for an environment whose episode has ended and was not reset.
    pub(crate) waits: Vec<bool>,
    pub(crate) ended: Vec<Ended>,
    /// Environment that found no start.
    pub(crate) failure: Option<String>,
}

impl Chunk {
    /// Creates `count` environments, the first of which has the number `first`.
    pub(crate) fn new(
        (first, count): (usize, usize),
        steppers: Vec<Box<dyn Stepper>>,
        lanes: usize,
        mode: Autoreset,
        trials: usize,
    ) -> Self {
        let channels = steppers.first().map_or([0; 2], |stepper| stepper.channels());
        let [inputs, outputs] = channels;
        Self {
            first,
            job: Job::Reset,
            mode,
            trials: trials.max(1) as u64,
            channels,
            lanes,
            steppers,
            episodes: vec![Episodes { seed: 0, individual: 0, next: 0 }; count],
            orders: vec![Order::Keep; count],
            actions: vec![0.0; count * outputs],
            observations: vec![0.0; count * inputs],
            results: vec![StepResult::default(); count],
            waits: vec![false; count],
            ended: Vec::new(),
            failure: None,
        }
    }

    /// Gets the number of environments.
    pub(crate) fn count(&self) -> usize {
        self.results.len()
    }

    /// Records the state of an environment of this chunk.
    pub(crate) fn record(&mut self, place: usize, recording: &mut Recording) {
        self.steppers[place / self.lanes].record(place % self.lanes, recording);
    }

    /// Does its job.
    pub(crate) fn run(&mut self) {
        self.ended.clear();
        match self.job {
            Job::Reset => self.reset(),
            Job::Step => self.step(),
        }
    }

    fn reset(&mut self) {
        for place in 0..self.count() {
            match std::mem::replace(&mut self.orders[place], Order::Keep) {
                Order::Keep => continue,
                Order::Next => {}
                Order::From(episodes) => self.episodes[place] = episodes,
            }
            self.waits[place] = false;
            self.start(place);
        }
    }

    /// Starts the next episode of an environment.
    fn start(&mut self, place: usize) {
        let [inputs, _] = self.channels;
        let observation = &mut self.observations[place * inputs..(place + 1) * inputs];
        let stepper = &mut self.steppers[place / self.lanes];
        for _ in 0..MAX_STARTS {
            let id = self.episodes[place].draw(self.trials);
            if stepper.start(place % self.lanes, id, observation) {
                return;
            }
        }
        let environment = self.first + place;
        self.failure = Some(format!("environment {environment} found no free place in {MAX_STARTS} episodes"));
    }

    fn step(&mut self) {
        let [inputs, outputs] = self.channels;
        let rows = self.results.chunks_mut(self.lanes);
        let rows = rows.zip(self.actions.chunks(self.lanes * outputs));
        let rows = rows.zip(self.observations.chunks_mut(self.lanes * inputs));
        for (stepper, ((results, actions), observations)) in self.steppers.iter_mut().zip(rows) {
            stepper.step(actions, results, observations);
        }
        for place in 0..self.count() {
            if self.waits[place] {
                // Its world has no episode and was not stepped.
                if self.mode == Autoreset::NextStep {
                    self.waits[place] = false;
                    self.start(place);
                }
            } else if self.results[place].is_last() {
                self.end(place);
            }
        }
    }

    /// Reports the end of an episode, and starts the next one if it begins in the same step.
    fn end(&mut self, place: usize) {
        let [inputs, _] = self.channels;
        let (stepper, world) = (&self.steppers[place / self.lanes], place % self.lanes);
        let (outcome, result) = (stepper.outcome(world), self.results[place]);
        let again = self.mode == Autoreset::SameStep;
        self.ended.push(Ended {
            environment: self.first + place,
            fitness: if result.failed { f64::NAN } else { stepper.earned(world) },
            steps: outcome.steps,
            success: outcome.success && !result.failed,
            failed: result.failed,
            terms: outcome.terms,
            observation: again.then(|| self.observations[place * inputs..(place + 1) * inputs].to_vec()),
        });
        if again {
            self.start(place);
        } else {
            self.waits[place] = true;
        }
    }
}
