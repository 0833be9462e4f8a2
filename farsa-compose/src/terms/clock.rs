//! Steps and time.

use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::term::Constants;
use crate::part::{Moment, PartScene, Term, TermPart};

/// 1 in every step.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Steps {}

/// Number of steps since the start.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Step {}

/// Time since the start [s].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Time {}

/// Share of the longest trial that is left.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct TimeLeft {
    /// Name of a group of robots for which it is the rest of 1 instead.
    rest: String,
}

/// A function of the moment.
#[derive(Clone, Debug)]
pub(super) struct ClockTerm(fn(&Moment<'_>) -> f64);

impl<W: ?Sized> Term<W> for ClockTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        (self.0)(now)
    }

    fn has_state(&self) -> bool {
        false
    }
}

/// Share of the longest trial that is left, or its rest of 1.
#[derive(Clone, Debug)]
pub(super) struct TimeLeftTerm {
    is_rest: bool,
}

impl<W: ?Sized> Term<W> for TimeLeftTerm {
    fn value(&self, _: &W, now: &Moment<'_>) -> f64 {
        // 1 - t / T
        let left = 1.0 - f64::from(now.steps) / f64::from(now.longest);
        if self.is_rest { 1.0 - left } else { left }
    }

    fn has_state(&self) -> bool {
        false
    }
}

macro_rules! of_clock {
    ($($name:ident, $value:expr;)*) => {
        $(impl TermPart for $name {
            type Term = ClockTerm;

            fn term(&self, _: &PartScene<'_>) -> Result<ClockTerm, Error> {
                Ok(ClockTerm($value))
            }

            fn is_constant(&self, _: &dyn Constants) -> bool {
                true
            }
        })*
    };
}
of_clock! {
    Steps, |_| 1.0;
    Step, |now| f64::from(now.steps);
    Time, |now| f64::from(now.steps) * now.time_step;
}

impl TermPart for TimeLeft {
    type Term = TimeLeftTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<TimeLeftTerm, Error> {
        let [first, end] = scene.0.group(&self.rest, "rest")?;
        Ok(TimeLeftTerm { is_rest: (first..end).contains(&scene.0.robot()) })
    }

    fn is_constant(&self, _: &dyn Constants) -> bool {
        true
    }
}
