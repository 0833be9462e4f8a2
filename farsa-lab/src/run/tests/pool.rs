//! A pool's threads: outcomes in their order, stops, and panics alone and in lanes.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use farsa_body::Recorder;
use farsa_view::Schema;

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::{Evaluation, Evaluator, InLanes, Task, TaskInfo};
use crate::experiment::lanes::{LaneRequest, Lanes};
use crate::experiment::outcome::Outcome;
use crate::experiment::parameter::Parameter;
use crate::experiment::settings::Settings;
use crate::run::evaluation_backend::Unfinished;
use crate::run::experiment::SimpleExperiment;
use crate::run::plan::Plan;
use crate::run::pool::Pool;

/// Its fitness is the individual's number. It panics from the fifth on if its parameter is set.
struct Nothing;

/// The experiment of an evaluator, without settings.
fn plan(prepare: fn(&Settings) -> Result<Box<dyn Evaluator>, Error>) -> Plan<'static> {
    let settings = |_: &str| Vec::new();
    let experiment = SimpleExperiment { name: "nothing", summary: "nothing", conditions: &[], settings, prepare };
    Plan::new(Box::leak(Box::new(experiment)), None, "").unwrap()
}

impl Task for Nothing {
    fn info(&self) -> TaskInfo {
        TaskInfo::new(vec![Parameter::new("panic", [0.0, 1.0])], Schema::default())
    }
}

impl Evaluator for Nothing {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
        assert!(evaluation.parameters[0] == 0.0 || evaluation.id.individual < 5, "as planned");
        Outcome { steps: evaluation.id.individual, ..Outcome::default() }
    }
}

fn pool(threads: usize) -> Pool<'static> {
    Pool::new(&plan(|_| Ok(Box::new(Nothing))), threads, LaneRequest::ONE).unwrap()
}

fn task(number: usize, parameters: &[f32]) -> Evaluation<'_> {
    let id = EpisodeId { individual: number as u32, ..EpisodeId::default() };
    Evaluation { number, ..Evaluation::new(parameters, id) }
}

#[test]
fn results_stand_in_the_order_of_the_work() {
    for threads in 1..4 {
        let heard = AtomicUsize::new(0);
        let some = |number| (number % 7 != 3).then(|| task(number, &[0.0]));
        let done = |_, _: Option<&Outcome>| {
            heard.fetch_add(1, Ordering::Relaxed);
        };
        let Ok(results) = pool(threads).evaluate(50, &AtomicBool::new(false), some, done) else { panic!() };
        assert_eq!(heard.into_inner(), 50);
        for (number, result) in results.iter().enumerate() {
            assert_eq!(result.as_ref().map(|outcome| outcome.steps), (number % 7 != 3).then_some(number as u32));
        }
    }
}

#[test]
fn a_stop_leaves_no_results() {
    let stop = AtomicBool::new(false);
    let done = |number, _: Option<&Outcome>| {
        stop.fetch_or(number == 7, Ordering::Relaxed);
    };
    let stopped = pool(2).evaluate(50, &stop, |number| Some(task(number, &[0.0])), done);
    assert!(matches!(stopped, Err(Unfinished::Stopped)));
}

#[test]
fn a_panic_is_an_outcome_and_the_others_are_what_they_are() {
    for threads in 1..4 {
        let all = |number| Some(task(number, &[1.0]));
        let Ok(results) = pool(threads).evaluate(9, &AtomicBool::new(false), all, |_, _| {}) else { panic!() };
        for (number, outcome) in results.into_iter().map(Option::unwrap).enumerate() {
            assert_eq!(outcome.is_finite(), number < 5);
            let why = outcome.why_failed(&[]).unwrap_or_default();
            assert_eq!(why.contains("panicked: as planned (") && why.contains("pool.rs:"), number >= 5, "{why}");
        }
    }
}

/// Every tenth individual panics, together with those in the same lanes.
struct InGroups(usize);

impl Task for InGroups {
    fn info(&self) -> TaskInfo {
        TaskInfo::new(vec![Parameter::new("none", [0.0, 1.0])], Schema::default())
    }
}

impl Evaluator for InGroups {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
        assert!(evaluation.id.individual % 10 != 3, "as planned");
        Outcome { steps: evaluation.id.individual, ..Outcome::default() }
    }
    fn in_lanes(&mut self) -> Option<&mut dyn InLanes> {
        Some(self)
    }
}

impl InLanes for InGroups {
    fn use_lanes(&mut self, lanes: Lanes) -> Result<(), Error> {
        self.0 = lanes.count();
        Ok(())
    }
    fn run_in_lanes<'p>(
        &mut self,
        next: &mut dyn FnMut() -> Option<Evaluation<'p>>,
        done: &mut dyn FnMut(usize, Outcome),
    ) {
        loop {
            let group: Vec<Evaluation<'p>> = (0..self.0).map_while(|_| next()).collect();
            if group.is_empty() {
                return;
            }
            for evaluation in group {
                done(evaluation.number, self.evaluate(evaluation, None));
            }
        }
    }
}

#[test]
fn a_panic_in_a_lane_fails_that_lane_alone() {
    for (threads, lanes) in [(1, 1), (1, 8), (3, 8), (2, 16)] {
        let plan = plan(|_| Ok(Box::new(InGroups(1))));
        let wanted = LaneRequest { count: Some(lanes), ..LaneRequest::ONE };
        let mut pool = Pool::new(&plan, threads, wanted).unwrap();
        let heard = AtomicUsize::new(0);
        let done = |_, _: Option<&Outcome>| {
            heard.fetch_add(1, Ordering::Relaxed);
        };
        let all = |number| Some(task(number, &[0.0]));
        let Ok(results) = pool.evaluate(100, &AtomicBool::new(false), all, done) else { panic!() };
        assert_eq!(heard.into_inner(), 100);
        for (number, outcome) in results.into_iter().map(Option::unwrap).enumerate() {
            assert_eq!(outcome.is_finite(), number % 10 != 3, "{threads} threads, {lanes} lanes");
            assert!(number % 10 == 3 || outcome.steps == number as u32);
        }
    }
}
