//! A pool of threads that run trials. Results do not depend on the number of threads.

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crate::error::Error;
use crate::experiment::evaluator::{Evaluation, Evaluator, TaskInfo};
use crate::experiment::genotype::Genotype;
use crate::experiment::lanes::{LaneRequest, Lanes};
use crate::experiment::outcome::Outcome;
use crate::experiment::settings::Settings;
use crate::ranks::dealing::{give, take};
use crate::ranks::exchange::{Exchange, Numbered, Status};
use crate::ranks::numbers::{AssignedBlocks, Numbers};
use crate::run::catch_panic::catch_panic;
use crate::run::evaluation_backend::{EvaluationBackend, Heard, TaskOf, Unfinished, round};
use crate::run::experiment::Experiment;
use crate::run::plan::Plan;

/// An experiment prepared for each thread.
pub(crate) struct Pool<'e> {
    /// At least one evaluator.
    evaluators: Vec<Box<dyn Evaluator>>,
    info: TaskInfo,
    genotype: Genotype,
    maker: Maker<'e>,
    /// Ranks that share the evaluations.
    exchange: Rc<Exchange<'e>>,
}

/// Prepares more evaluators. An evaluator is discarded after a panic.
struct Maker<'e> {
    experiment: &'e dyn Experiment,
    condition: String,
    settings: Settings,
    lanes: Lanes,
}

impl Maker<'_> {
    fn make(&self) -> Result<Box<dyn Evaluator>, Error> {
        let prepared = self.experiment.prepare(&self.condition, &self.settings);
        let mut evaluator = prepared.map_err(|error| match error {
            Error::Other(why) => Error::Usage(why),
            other => other,
        })?;
        if let Some(in_lanes) = evaluator.in_lanes() {
            in_lanes.use_lanes(self.lanes)?;
        }
        Ok(evaluator)
    }
}

/// A pool between two rounds, without ranks. Another thread may take it.
pub(crate) struct IdlePool<'e> {
    evaluators: Vec<Box<dyn Evaluator>>,
    info: TaskInfo,
    genotype: Genotype,
    maker: Maker<'e>,
}

impl<'e> IdlePool<'e> {
    /// Makes the pool evaluate again.
    pub(crate) fn awake(self) -> Pool<'e> {
        let Self { evaluators, info, genotype, maker } = self;
        Pool { evaluators, info, genotype, maker, exchange: Rc::default() }
    }
}

impl<'e> Pool<'e> {
    /// Detaches the pool from its ranks.
    pub(crate) fn idle(self) -> IdlePool<'e> {
        let Self { evaluators, info, genotype, maker, .. } = self;
        IdlePool { evaluators, info, genotype, maker }
    }

    /// Prepares a pool of at least one thread.
    ///
    /// # Errors
    /// [`Error::Usage`] for more lanes or other instructions than the machine or the experiment has.
    pub(crate) fn new(plan: &Plan<'e>, threads: usize, wanted: LaneRequest) -> Result<Self, Error> {
        let asked = wanted.on_this_machine()?;
        let mut first = plan.evaluator()?;
        let lanes = if first.in_lanes().is_some() { asked } else { Lanes::one() };
        if wanted.count.is_some_and(|count| count != lanes.count()) {
            let (name, only) = (plan.experiment.name(), lanes.count());
            return Err(Error::Usage(format!("--lanes {}: {name} has {only} only", asked.count())));
        }
        let info = first.info();
        let genotype = plan.genotype(first.as_ref());
        let settings = plan.settings_of_trials()?;
        let maker = Maker { experiment: plan.experiment, condition: plan.condition.clone(), settings, lanes };
        drop(first);
        let evaluators = (0..threads.max(1)).map(|_| maker.make()).collect::<Result<_, _>>()?;
        Ok(Self { evaluators, info, genotype, maker, exchange: Rc::default() })
    }

    /// Makes the pool that of one rank of several.
    pub(crate) fn on(self, exchange: Rc<Exchange<'e>>) -> Self {
        Self { exchange, ..self }
    }

    /// Gets the ranks that share the evaluations.
    pub(crate) fn exchange(&self) -> Rc<Exchange<'e>> {
        self.exchange.clone()
    }

    /// Makes the pool stop when `stop` becomes true.
    pub(crate) fn until<'p>(&'p mut self, stop: &'p AtomicBool) -> Stoppable<'p, 'e> {
        Stoppable { pool: self, stop }
    }

    /// Gets the number of threads.
    pub(crate) fn threads(&self) -> usize {
        self.evaluators.len()
    }

    /// Gets the lanes of each thread.
    pub(crate) fn lanes(&self) -> Lanes {
        self.maker.lanes
    }

    /// Gets the genotype of the experiment's parameters.
    pub(crate) fn genotype(&self) -> &Genotype {
        &self.genotype
    }

    /// Gets the data of the task.
    pub(crate) fn info(&self) -> &TaskInfo {
        &self.info
    }

    /// Returns the evaluator of the first thread.
    pub(crate) fn evaluator(&self) -> &dyn Evaluator {
        self.evaluators[0].as_ref()
    }

    /// Runs `count` evaluations, each on the next free thread, and returns the outcomes in order. With several ranks each runs a
    /// part of them, and all return the same.
    ///
    /// `task` returns the evaluation of a number, or `None` if it is not needed. `done` is called for every number. A trial that
    /// panics counts as failed.
    pub(crate) fn evaluate<'g>(
        &mut self,
        count: usize,
        stop: &AtomicBool,
        task: impl Fn(usize) -> Option<Evaluation<'g>> + Sync,
        done: impl Fn(usize, Option<&Outcome>) + Sync,
    ) -> Result<Vec<Option<Outcome>>, Unfinished> {
        let exchange = self.exchange.clone();
        let mut results = self.evaluate_own(count, stop, task, &done);
        if !exchange.is_alone() {
            let evaluated_here = results.as_ref().map_or(0, Vec::len);
            let all = exchange.outcomes(results, stop.load(Ordering::Relaxed))?.ok_or(Unfinished::Stopped)?;
            all.iter().skip(evaluated_here).for_each(|(number, outcome)| done(*number, outcome.as_ref()));
            results = Ok(all);
        }
        let mut results = results?;
        if results.len() < count {
            return Err(Unfinished::Stopped);
        }
        results.sort_unstable_by_key(|(number, _)| *number);
        Ok(results.into_iter().map(|(_, result)| result).collect())
    }

    /// Runs evaluations until none is left on any rank.
    fn evaluate_own<'g>(
        &mut self,
        count: usize,
        stop: &AtomicBool,
        task: impl Fn(usize) -> Option<Evaluation<'g>> + Sync,
        done: impl Fn(usize, Option<&Outcome>) + Sync,
    ) -> Result<Vec<Numbered>, Error> {
        let (maker, exchange, all) = (&self.maker, &self.exchange, self.evaluators.len());
        let at_once = all * maker.lanes.count();
        let numbers =
            if exchange.is_follower() { Numbers::Assigned(AssignedBlocks::default()) } else { Numbers::counted(count) };
        let work = &Work { numbers, ended: AtomicBool::new(false), stop, task, done, maker };
        thread::scope(|scope| {
            let mut threads = Vec::with_capacity(all);
            let mut begun = Ok(());
            for evaluator in &mut self.evaluators {
                let name = "trials".to_owned();
                match thread::Builder::new().name(name).spawn_scoped(scope, move || work.run(evaluator)) {
                    Ok(thread) => threads.push(thread),
                    Err(source) => {
                        work.ended.store(true, Ordering::Relaxed);
                        begun = Err(no_thread(threads.len() + 1, all, &source));
                        break;
                    }
                }
            }
            // A thread ends when no number is left, or by an error. In both cases the ranks stop waiting for it.
            let ended = || {
                let stopping = stop.load(Ordering::Relaxed) || work.ended.load(Ordering::Relaxed);
                stopping || threads.iter().any(thread::ScopedJoinHandle::is_finished)
            };
            let shared = match &work.numbers {
                Numbers::Assigned(given) => take(exchange.ranks(), given, at_once, &ended),
                numbers @ Numbers::Counted { .. } => give(exchange.ranks(), numbers, &ended),
            };
            if shared.is_err() {
                work.numbers.close();
            }
            let joined: Vec<_> = threads.into_iter().map(thread::ScopedJoinHandle::join).collect();
            let ours = || Error::Other("a thread of trials panicked outside a trial".into());
            let joined = joined.into_iter().map(|result| result.unwrap_or_else(|_| Err(ours())));
            let results = joined.collect::<Result<Vec<_>, _>>().map(|results| results.into_iter().flatten().collect());
            begun.and(shared).and(results)
        })
    }

    /// Takes part in a round without evaluations after an error, so that all ranks receive it.
    ///
    /// # Errors
    /// The errors of the ranks' messages.
    pub(crate) fn withdraw(&self, status: &Status) -> Result<(), Error> {
        let ranks = self.exchange.ranks();
        if self.exchange.is_follower() {
            take(ranks, &AssignedBlocks::default(), 0, &|| true)?;
        } else {
            give(ranks, &Numbers::counted(0), &|| true)?;
        }
        self.exchange.no_outcomes(status)
    }
}

/// A pool that stops on request.
pub(crate) struct Stoppable<'p, 'e> {
    pool: &'p mut Pool<'e>,
    stop: &'p AtomicBool,
}

/// Interval, in generations, at which ranks compare their evaluations.
const COMPARED: u32 = 10;

impl EvaluationBackend for Stoppable<'_, '_> {
    fn evaluator(&self) -> &dyn Evaluator {
        self.pool.evaluator()
    }

    fn info(&self) -> &TaskInfo {
        &self.pool.info
    }

    fn genotype(&self) -> &Genotype {
        self.pool.genotype()
    }

    fn evaluate(
        &mut self,
        count: usize,
        task: &TaskOf<'_, '_>,
        done: &Heard<'_>,
    ) -> Result<Vec<Option<Outcome>>, Unfinished> {
        self.pool.evaluate(count, self.stop, task, done)
    }

    fn compare(&self, generation: u32, fingerprint: &dyn Fn() -> u64) {
        let exchange = &self.pool.exchange;
        if !exchange.is_alone() {
            exchange.compare_first_and_every(generation, COMPARED, fingerprint);
        }
    }
}

/// Creates the error of a thread that the system refused.
fn no_thread(number: usize, all: usize, source: &io::Error) -> Error {
    let least = number.saturating_sub(1).max(1);
    Error::Other(format!("cannot start thread {number} of {all}: {source}; --threads {least} or less may do"))
}

/// State shared by the threads of a round.
struct Work<'w, T, D> {
    numbers: Numbers,
    /// True if a thread found that the round cannot be finished.
    ended: AtomicBool,
    stop: &'w AtomicBool,
    task: T,
    done: D,
    maker: &'w Maker<'w>,
}

impl<'g, T, D> Work<'_, T, D>
where
    T: Fn(usize) -> Option<Evaluation<'g>> + Sync,
    D: Fn(usize, Option<&Outcome>) + Sync,
{
    /// Evaluates on one thread until no number is left.
    fn run(&self, evaluator: &mut Box<dyn Evaluator>) -> Result<Vec<Numbered>, Error> {
        // Two closures of one evaluator write here in turn.
        let results = RefCell::new(Vec::new());
        let put = |number: usize, outcome: Option<Outcome>| {
            (self.done)(number, outcome.as_ref());
            results.borrow_mut().push((number, outcome));
        };
        // Started evaluations: one, or as many as there are lanes.
        let running: RefCell<Vec<Evaluation<'g>>> = RefCell::new(Vec::new());
        let mut next = || {
            while !self.stop.load(Ordering::Relaxed) && !self.ended.load(Ordering::Relaxed) {
                let Some(number) = self.numbers.draw() else { break };
                match (self.task)(number) {
                    None => put(number, None),
                    Some(evaluation) => {
                        running.borrow_mut().push(evaluation);
                        return Some(evaluation);
                    }
                }
            }
            None
        };
        let mut end = |number: usize, outcome: Outcome| {
            running.borrow_mut().retain(|evaluation| evaluation.number != number);
            put(number, Some(outcome));
        };
        while let Err(why) = catch_panic(|| round(evaluator.as_mut(), &mut next, &mut end)) {
            let broken = running.take();
            self.renew(evaluator)?;
            if self.maker.lanes.count() == 1 {
                for evaluation in broken {
                    put(evaluation.number, Some(Outcome::panicked(&why)));
                }
                continue;
            }
            // One of the lanes has panicked. Evaluated alone, each of the others has its usual outcome.
            for evaluation in broken {
                let outcome = catch_panic(|| evaluator.evaluate(evaluation, None));
                if outcome.is_err() {
                    self.renew(evaluator)?;
                }
                put(evaluation.number, Some(outcome.unwrap_or_else(|why| Outcome::panicked(&why))));
            }
        }
        Ok(results.into_inner())
    }

    /// Replaces an evaluator after a panic.
    fn renew(&self, evaluator: &mut Box<dyn Evaluator>) -> Result<(), Error> {
        let made = catch_panic(|| self.maker.make());
        let made = made.unwrap_or_else(|why| Err(Error::Other(format!("the experiment cannot be prepared: {why}"))));
        // The old evaluator may panic again when it is dropped.
        let old = std::mem::replace(evaluator, made.inspect_err(|_| self.ended.store(true, Ordering::Relaxed))?);
        let _ = catch_panic(|| drop(old));
        Ok(())
    }
}
