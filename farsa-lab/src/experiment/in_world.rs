//! An evaluator made of a world and an episode.

use farsa_body::Recorder;
use farsa_body::ports::{Arrange, BodyId, ExternalForces, Handles, Kinematics, World};

use crate::error::Error;
use crate::experiment::behavior::Behavior;
use crate::experiment::disturbance::{Apply, Disturbances, Disturbed, Place, apply, place};
use crate::experiment::episode::{Episode, EpisodeId, run_episode};
use crate::experiment::evaluator::{Bodies, Evaluation, Evaluator, Exports, InLanes, Learner, Task, TaskInfo};
use crate::experiment::in_lanes::{Batch, run_in_lanes};
use crate::experiment::lanes::Lanes;
use crate::experiment::limited::Limited;
use crate::experiment::outcome::Outcome;
use crate::experiment::rollout::Rollout;
use crate::experiment::stepped::{in_batch, in_one_world};
use crate::experiment::stepper::{Stepper, not_stepped};

/// An episode in each lane of a batch.
trait LaneRunner<R>: Send {
    fn run_in_lanes<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    );

    fn into_stepper(self: Box<Self>) -> Result<Box<dyn Stepper>, Error>;
}

struct InBatch<B, R> {
    batch: B,
    episodes: Vec<Numbered<R>>,
}

/// An episode with the number of its evaluation.
struct Numbered<R> {
    limited: Limited<R>,
    number: usize,
}

impl<W: ?Sized, R: Episode<W>> Episode<W> for Numbered<R> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.limited.start(world, id);
    }
    fn has_started(&self) -> bool {
        self.limited.has_started()
    }
    fn act(&mut self, world: &mut W) {
        self.limited.act(world);
    }
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.limited.judge(world)
    }
}

impl<B, R> LaneRunner<R> for InBatch<B, R>
where
    B: Batch + Send + 'static,
    R: Rollout + for<'a> Episode<B::Lane<'a>> + 'static,
{
    fn into_stepper(self: Box<Self>) -> Result<Box<dyn Stepper>, Error> {
        let Self { batch, episodes } = *self;
        in_batch(batch, episodes.into_iter().map(|numbered| numbered.limited.episode).collect())
    }

    fn run_in_lanes<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    ) {
        // Two closures report outcomes in turn.
        let done = std::cell::RefCell::new(done);
        let begin = |Numbered { limited, number }: &mut Numbered<R>| {
            loop {
                let evaluation = next()?;
                (*number, limited.stop) = (evaluation.number, evaluation.stop);
                if limited.episode.load(&evaluation) {
                    return Some(evaluation.id);
                }
                done.borrow_mut()(evaluation.number, Outcome::failed());
            }
        };
        let end = |ended: &mut Numbered<R>, _: f64| {
            let limited = &ended.limited;
            let outcome = limited.stopped().unwrap_or_else(|| limited.episode.outcome());
            done.borrow_mut()(ended.number, outcome);
        };
        run_in_lanes(&mut self.episodes, &mut self.batch, begin, end);
    }
}

type Make<R> = Box<dyn Fn(Lanes, &R) -> Result<Box<dyn LaneRunner<R>>, Error> + Send>;

/// Evaluates episodes in a world of type `W`. Episodes run one after the other, or side by side in lanes if the world
/// has batches.
pub struct InWorld<W, R> {
    world: W,
    rollout: R,
    /// Most steps of an episode. `None` after the episode was changed.
    budget: Option<u64>,
    make: Option<Make<R>>,
    lanes: Option<Box<dyn LaneRunner<R>>>,
    /// Moves bodies, if the world can.
    place: Option<Place<W>>,
    /// Pushes bodies, if the world can.
    apply: Option<Apply<W>>,
}

impl<W, R: Rollout> InWorld<W, R> {
    /// Creates an evaluator for this episode and this world. By default it has no lanes.
    pub fn new(world: W, rollout: R) -> Self {
        let budget = Some(rollout.info().step_budget());
        Self { world, rollout, budget, make: None, lanes: None, place: None, apply: None }
    }
}

impl<W, R> InWorld<W, R> {
    /// Adds the ability to run episodes side by side. The closure `batch` must build the same worlds as a batch.
    #[must_use]
    pub fn with_lanes<B>(mut self, batch: impl Fn(Lanes) -> Result<B, Error> + Send + 'static) -> Self
    where
        B: Batch + Send + 'static,
        R: Rollout + Clone + for<'a> Episode<B::Lane<'a>> + 'static,
    {
        self.make = Some(Box::new(move |lanes, rollout: &R| {
            let batch = batch(lanes)?;
            let (budget, count) = (rollout.info().step_budget(), lanes.count());
            let limited = (0..count).map(|_| Limited::new(rollout.clone(), budget));
            let episodes = limited.map(|limited| Numbered { limited, number: 0 }).collect();
            Ok(Box::new(InBatch { batch, episodes }))
        }));
        self
    }

    /// Adds the ability to move bodies during an episode. This is useful for interactive pages.
    #[must_use]
    pub fn with_displacements(self) -> Self
    where
        W: Arrange + Handles<Body = BodyId>,
    {
        Self { place: Some(place), ..self }
    }

    /// Adds the ability to push bodies during an episode. This is useful for interactive pages.
    #[must_use]
    pub fn with_pushes(self) -> Self
    where
        W: ExternalForces + Kinematics + Handles<Body = BodyId>,
    {
        Self { apply: Some(apply), ..self }
    }

    /// Gets the episode.
    pub fn rollout(&self) -> &R {
        &self.rollout
    }

    /// Gets the episode and the world. Use this to run an episode by yourself.
    pub fn parts_mut(&mut self) -> (&mut R, &mut W) {
        self.budget = None;
        (&mut self.rollout, &mut self.world)
    }
}

impl<W: Send, R: Rollout> Task for InWorld<W, R> {
    fn info(&self) -> TaskInfo {
        self.rollout.info()
    }
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        self.rollout.fitness(trials)
    }
    fn behavior(&self) -> Option<&dyn Behavior> {
        self.rollout.behavior()
    }
    fn exports(&self) -> Option<&dyn Exports> {
        self.rollout.exports()
    }
    fn bodies(&self) -> Option<&dyn Bodies> {
        self.rollout.bodies()
    }
}

impl<W, R> Evaluator for InWorld<W, R>
where
    W: World + Send + 'static,
    R: Rollout + Episode<W> + 'static,
{
    fn evaluate(&mut self, evaluation: Evaluation<'_>, mut recorder: Option<&mut dyn Recorder>) -> Outcome {
        if !self.rollout.load(&evaluation) {
            return Outcome::failed();
        }
        if let Some(recorder) = &mut recorder {
            self.rollout.record_parameters(*recorder);
        }
        let budget = *self.budget.get_or_insert_with(|| self.rollout.info().step_budget());
        let mut limited = Limited::new(&mut self.rollout, budget);
        limited.stop = evaluation.stop;
        let Evaluation { id, displacements, pushes, .. } = evaluation;
        let disturbances = Disturbances { displacements, pushes, place: self.place, apply: self.apply };
        if disturbances.any() {
            run_episode(&mut Disturbed::new(&mut limited, disturbances), &mut self.world, id, recorder);
        } else {
            run_episode(&mut limited, &mut self.world, id, recorder);
        }
        limited.stopped().unwrap_or_else(|| self.rollout.outcome())
    }

    fn record_start(&mut self, evaluation: Evaluation<'_>, recorder: &mut dyn Recorder) -> bool {
        if !self.rollout.load(&evaluation) {
            return false;
        }
        self.rollout.start(&mut self.world, evaluation.id);
        let started = self.rollout.has_started();
        if started {
            self.rollout.record(&self.world, recorder);
        }
        started
    }

    fn learner(&mut self) -> Option<&mut dyn Learner> {
        self.rollout.learner()
    }

    fn displaces(&self) -> bool {
        self.place.is_some()
    }

    fn pushes(&self) -> bool {
        self.apply.is_some()
    }

    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        if self.make.is_some() { Some(self) } else { None }
    }

    fn into_stepper(self: Box<Self>, lanes: Lanes) -> Result<Box<dyn Stepper>, Error> {
        let Self { world, mut rollout, make, .. } = *self;
        if rollout.info().populations.len() > 1 {
            let populations = rollout.info().populations.len();
            return Err(not_stepped(&format!("it has {populations} populations, and an action is for one agent")));
        }
        if rollout.bodies().is_some() {
            return Err(not_stepped("its bodies evolve with its controllers"));
        }
        let refused = rollout.external().err();
        match (refused, make) {
            (Some(why), _) => Err(not_stepped(&why)),
            (None, _) if lanes.count() == 1 => in_one_world(world, rollout),
            (None, Some(make)) => make(lanes, &rollout)?.into_stepper(),
            (None, None) => Err(Error::Usage(format!("{} lanes; this experiment has 1 only", lanes.count()))),
        }
    }
}

impl<W, R> InLanes for InWorld<W, R>
where
    W: World + Send + 'static,
    R: Rollout + Episode<W> + 'static,
{
    fn use_lanes(&mut self, lanes: Lanes) -> Result<(), Error> {
        self.lanes = match &self.make {
            Some(make) if lanes.count() > 1 => Some(make(lanes, &self.rollout)?),
            _ => None,
        };
        Ok(())
    }

    fn run_in_lanes<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    ) {
        if let Some(lanes) = &mut self.lanes {
            // Lanes have no displacements or pushes.
            let mut alone = Vec::new();
            let mut plain = || loop {
                let evaluation = next()?;
                if evaluation.displacements.is_empty() && evaluation.pushes.is_empty() {
                    return Some(evaluation);
                }
                alone.push(evaluation);
            };
            lanes.run_in_lanes(&mut plain, done);
            for evaluation in alone {
                done(evaluation.number, self.evaluate(evaluation, None));
            }
            return;
        }
        while let Some(evaluation) = next() {
            done(evaluation.number, self.evaluate(evaluation, None));
        }
    }
}
