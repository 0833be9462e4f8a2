//! Conditions of success, failure and end.

use farsa_lab::Error;

use crate::check::source::Source;
use crate::document::Condition;
use crate::formula::program::Program;
use crate::parts::conditions::FormulaCondition;
use crate::parts::groups::Groups;
use crate::parts::tally::Tally;

/// A condition on the values of terms.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    test: Test,
    /// Evolving robots for which the condition is, by default any.
    of: Option<[usize; 2]>,
    /// Steps in a row in which the condition must hold, if it must hold for a time.
    steps: Option<u32>,
    /// Steps in a row in which it has held.
    held: u32,
}

/// A test of the last step's values.
#[derive(Clone, Debug)]
enum Test {
    /// Limits of a term, by number.
    Limits { term: usize, above: Option<f64>, below: Option<f64> },
    /// A formula of consecutive terms, from the first up to the one after the last.
    Formula { program: Program, terms: [usize; 2] },
}

impl Wanted {
    /// Reads the condition at a path. `formula` is that of the condition, and `time_step` the control step [s].
    pub(crate) fn new(
        condition: &Condition,
        formula: Option<FormulaCondition>,
        (path, time_step): (&str, f64),
        names: &[String],
        groups: &Groups,
        source: &Source,
    ) -> Result<Self, Error> {
        let Condition { term, of, above, below, .. } = condition;
        let of = of.as_ref().map(|name| groups.find(name, &format!("{path}/of"), source)).transpose()?;
        let Some(FormulaCondition { program, terms, duration }) = formula else {
            let lacks = || source.wrong(path, "lacks the key `term`, or a `formula`");
            let term = term.as_ref().ok_or_else(lacks)?;
            let term = source.position(names.iter().map(String::as_str), ("term", term), &format!("{path}/term"))?;
            if above.is_none() && below.is_none() {
                return Err(source.wrong(path, "lacks `above` and `below`: one of them at least"));
            }
            let test = Test::Limits { term, above: *above, below: *below };
            return Ok(Self { test, of, steps: None, held: 0 });
        };
        let given = [("term", term.is_some()), ("above", above.is_some()), ("below", below.is_some())];
        if let Some((key, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(source.wrong(&format!("{path}/{key}"), "is for conditions without a `formula`"));
        }
        // A time of 10 steps may be a little more than 10 in floating point.
        let steps = duration.map(|duration| (duration / time_step - 1e-6).ceil().max(1.0) as u32);
        Ok(Self { test: Test::Formula { program, terms }, of, steps, held: 0 })
    }

    /// Iterates over the numbers of its terms.
    pub(crate) fn terms(&self) -> std::ops::Range<usize> {
        match self.test {
            Test::Limits { term, .. } => term..term + 1,
            Test::Formula { terms: [first, end], .. } => first..end,
        }
    }

    /// Returns the steps in a row in which the condition must hold, if it must hold for a time.
    pub(crate) fn steps(&self) -> Option<u32> {
        self.steps
    }

    /// Checks if the condition is for trials in which these robots evolve.
    pub(crate) fn is_for(&self, evolving: [usize; 2]) -> bool {
        self.of.is_none_or(|of| of == evolving)
    }

    /// Begins a trial.
    pub(crate) fn begin(&mut self) {
        self.held = 0;
    }

    /// Counts a step, if the condition must hold for a time.
    pub(crate) fn count(&mut self, terms: &[Tally]) {
        if self.steps.is_some() {
            self.held = if self.is_met(terms) { self.held.saturating_add(1) } else { 0 };
        }
    }

    /// Checks if the condition holds after the last step.
    #[inline]
    pub(crate) fn holds(&self, terms: &[Tally]) -> bool {
        match self.steps {
            Some(steps) => self.held >= steps,
            None => self.is_met(terms),
        }
    }

    /// Checks the values of the last step.
    #[inline]
    fn is_met(&self, terms: &[Tally]) -> bool {
        match &self.test {
            Test::Limits { term, above, below } => {
                let value = terms[*term].last;
                above.is_none_or(|above| value > above) && below.is_none_or(|below| value < below)
            }
            Test::Formula { program, terms: [first, _] } => {
                program.evaluate(|number| terms[first + number].last) == 1.0
            }
        }
    }
}
