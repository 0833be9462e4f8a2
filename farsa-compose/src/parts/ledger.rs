//! Terms of a trial, with success and failure.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use farsa_lab::advanced::mean_of_trials;
use farsa_lab::{Combination, Error, Note, Outcome};
use farsa_num::Scalar;

use crate::check::source::Source;
use crate::document::{Condition, Document, Trials};
use crate::parts::behaviour::TermBehaviour;
use crate::parts::conditions::FormulaConditions;
use crate::parts::constant_fitness::warning;
use crate::parts::groups::Groups;
use crate::parts::tally::Tally;
use crate::parts::wanted::Wanted;

/// Terms of a trial with their totals.
#[derive(Clone, Debug)]
pub(crate) struct Ledger {
    /// Terms of the document, then those that formulas of conditions measure.
    pub(crate) tallies: Vec<Tally>,
    /// Number of terms of the document.
    shown: usize,
    success: Vec<Wanted>,
    failure: Vec<Wanted>,
    end: Vec<Wanted>,
    /// Number of conditions that must hold for a time.
    lasting: usize,
    /// Evolving robots of this trial, from the first up to the one after the last.
    evolving: [usize; 2],
    pub(crate) behaviour: Option<TermBehaviour>,
    /// Terms of the fitness: those with a weight, or all if none has one.
    paid: Vec<usize>,
    /// Terms in the notes of an outcome, with the names of the notes.
    notes: Vec<(usize, &'static str)>,
    /// Most steps of a trial.
    most_steps: u32,
    product: bool,
    trials: Trials,
    /// Doubts about the fitness or the motors.
    pub(crate) warnings: Vec<String>,
    /// Steps of this trial.
    pub(crate) steps: u32,
    /// Result of the trial.
    pub(crate) failed: bool,
    /// First term with a value that is not finite, and the value.
    broken: Option<(usize, f64)>,
    succeeded: bool,
}

impl Ledger {
    /// Builds the terms of a document with these robots. `of_steps` is true for terms with a state that each
    /// step updates. The formulas of conditions are about these robots, by default all.
    pub(crate) fn new(
        document: &Document,
        of_steps: &[bool],
        (mut formulas, abouts): (FormulaConditions, &[Option<[usize; 2]>]),
        groups: &Groups,
        source: &Source,
    ) -> Result<Self, Error> {
        let rewards = &source.names.terms;
        let tally = |(number, reward)| Tally::new(reward, number, rewards, groups, source);
        let mut tallies = document.reward.iter().enumerate().map(tally).collect::<Result<Vec<_>, _>>()?;
        if tallies.is_empty() {
            return Err(source.wrong("/reward", "has no term: nothing is earned"));
        }
        let shown = tallies.len();
        let about = |number: usize| abouts.get(number).copied().flatten();
        tallies.extend((0..formulas.paths.len()).map(|number| Tally::of_condition(groups, about(number))));
        let time_step = document.world.time_step;
        let mut conditions = |list: &str, conditions: &[Condition]| {
            let condition = |(index, condition)| {
                let path = format!("/{list}/{index}");
                let formula = formulas.take(&path);
                Wanted::new(condition, formula, (&path, time_step), rewards, groups, source)
            };
            conditions.iter().enumerate().map(condition).collect::<Result<Vec<_>, Error>>()
        };
        let (success, failure) = (conditions("success", &document.success)?, conditions("failure", &document.failure)?);
        let end = conditions("end", &document.end)?;
        // A late term has no value before the end of the trial, so nothing within the trial may depend on it. Success
        // matters within the trial only if it ends the trial.
        let ends_with_success = source.registry.ends_with_success(document);
        let of_steps_of = |wanted: &&Wanted| ends_with_success || wanted.steps().is_some();
        let watched = success.iter().filter(of_steps_of).chain(&failure).chain(&end).flat_map(Wanted::terms);
        let watched: Vec<usize> = watched.chain(tallies.iter().filter_map(|tally| tally.during)).collect();
        for (number, tally) in tallies.iter_mut().enumerate() {
            tally.late = tally.may_be_late() && !of_steps[number] && !watched.contains(&number);
        }
        let behaviour = TermBehaviour::new(&document.behaviour, &tallies[..shown], source)?;
        let noted = tallies[..shown].iter().enumerate().filter(|(number, tally)| {
            tally.is_only_measured() || behaviour.as_ref().is_some_and(|behaviour| behaviour.looks_at(*number))
        });
        let paid: Vec<usize> = (0..shown).filter(|number| !tallies[*number].is_only_measured()).collect();
        let paid = if paid.is_empty() { (0..shown).collect() } else { paid };
        let notes = noted.map(|(number, tally)| (number, lasting(&tally.note()))).collect();
        let lasting = success.iter().chain(&failure).chain(&end).filter(|wanted| wanted.steps().is_some()).count();
        let mut warnings: Vec<String> = warning(document, groups, source).into_iter().collect();
        let lists = [("success", &success), ("failure", &failure), ("end", &end)];
        warnings.extend(lists.into_iter().flat_map(|(list, wanted)| too_long(list, wanted, document, source)));
        Ok(Self {
            tallies,
            shown,
            success,
            failure,
            end,
            lasting,
            evolving: [0, groups.robots()],
            behaviour,
            paid,
            notes,
            most_steps: document.episode.steps,
            product: document.fitness.product,
            trials: document.fitness.trials,
            warnings,
            steps: 0,
            failed: false,
            broken: None,
            succeeded: false,
        })
    }

    /// Resets all totals. `arranged` is false if something had no place.
    pub(crate) fn begin(&mut self, arranged: bool) {
        (self.steps, self.succeeded, self.failed, self.broken) = (0, false, !arranged, None);
        self.tallies.iter_mut().for_each(Tally::reset);
        self.conditions().for_each(Wanted::begin);
    }

    /// Iterates over all conditions.
    fn conditions(&mut self) -> impl Iterator<Item = &mut Wanted> {
        self.success.iter_mut().chain(&mut self.failure).chain(&mut self.end)
    }

    /// Gets the terms of the document.
    pub(crate) fn shown(&self) -> &[Tally] {
        &self.tallies[..self.shown]
    }

    /// Counts a step for conditions that must hold for a time.
    #[inline]
    pub(crate) fn count_conditions(&mut self) {
        if self.lasting > 0 {
            let Self { tallies, success, failure, end, .. } = self;
            let conditions = success.iter_mut().chain(failure).chain(end);
            conditions.for_each(|wanted| wanted.count(tallies));
        }
    }

    /// Sets the evolving robots of the next trial, from the first up to the one after the last.
    pub(crate) fn evolve(&mut self, robots: [usize; 2]) {
        self.evolving = robots;
        self.tallies.iter_mut().for_each(|tally| tally.evolve(robots));
    }

    /// Notes the first value that is not finite.
    #[cold]
    fn fail(&mut self, number: usize, value: f64) {
        self.failed = true;
        self.broken.get_or_insert((number, value));
    }

    /// Adds the value of a term in a step.
    #[inline]
    pub(crate) fn count(&mut self, number: usize, value: f64) {
        if !value.is_finite() {
            self.fail(number, value);
        }
        // A condition names an earlier term only, and terms count in their order.
        let (others, tally) = self.tallies.split_at_mut(number);
        tally[0].count(value, others);
    }

    /// Returns true after the last step, a failure or NaN.
    #[inline]
    pub(crate) fn is_over(&self) -> bool {
        self.failed || self.steps >= self.most_steps || self.has_failed() || self.one_holds(&self.end)
    }

    /// Checks that the trial is over by the number of its steps, and by no condition.
    pub(crate) fn is_truncated(&self) -> bool {
        !self.failed && self.steps >= self.most_steps && !self.has_failed() && !self.one_holds(&self.end)
    }

    /// Checks if a condition of failure holds.
    fn has_failed(&self) -> bool {
        self.one_holds(&self.failure)
    }

    fn one_holds(&self, conditions: &[Wanted]) -> bool {
        conditions.iter().any(|wanted| wanted.is_for(self.evolving) && wanted.holds(&self.tallies))
    }

    /// Checks if there is a condition of success.
    pub(crate) fn has_success(&self) -> bool {
        !self.success.is_empty()
    }

    /// Gets the combination of trials into the fitness.
    pub(crate) fn combination(&self) -> Combination {
        match self.trials {
            Trials::Mean => Combination::Mean,
            Trials::Sum => Combination::Sum,
            Trials::Worst => Combination::Worst,
        }
    }

    /// Checks if all conditions of success hold.
    pub(crate) fn would_succeed(&self) -> bool {
        let mut wanted = self.success.iter().filter(|wanted| wanted.is_for(self.evolving)).peekable();
        // `all` is true for an empty list, but a document without conditions has no success.
        wanted.peek().is_some() && wanted.all(|wanted| wanted.holds(&self.tallies))
    }

    /// Ends the trial and returns its reward, NaN after a failure of the dynamics.
    pub(crate) fn conclude(&mut self) -> f64 {
        self.succeeded = self.would_succeed() && !self.has_failed();
        if self.failed { f64::NAN } else { self.earned() }
    }

    /// Computes the reward so far.
    pub(crate) fn earned(&self) -> f64 {
        let terms = self.paid().map(|tally| tally.earned(self.most_steps));
        if self.product { terms.product() } else { terms.sum() }
    }

    fn paid(&self) -> impl Iterator<Item = &Tally> {
        self.paid.iter().filter_map(|number| self.tallies.get(*number))
    }

    /// Lists the names of the fitness terms.
    pub(crate) fn names(&self) -> Vec<String> {
        self.paid().map(|tally| tally.label().to_owned()).collect()
    }

    /// Builds the outcome of a failed trial, which names the term that is not finite.
    pub(crate) fn failure(&self) -> Outcome {
        let place = |number| self.paid.iter().position(|paid| *paid == number);
        let broken = self.broken.and_then(|(number, value)| Some((place(number)?, value)));
        let Some((place, value)) = broken else { return Outcome::failed() };
        let terms = (0..self.paid.len()).map(|term| if term == place { value } else { 0.0 });
        Outcome { terms: terms.collect(), ..Outcome::default() }
    }

    /// Builds the outcome of the trial.
    pub(crate) fn outcome(&self) -> Outcome {
        let (steps, tallies) = (self.most_steps, &self.tallies);
        Outcome {
            terms: self.paid().map(|tally| tally.earned(steps)).collect(),
            steps: self.steps,
            success: self.succeeded,
            notes: self
                .notes
                .iter()
                .map(|(number, name)| (*name, Note::from(tallies[*number].measured(steps))))
                .collect(),
            ..Outcome::default()
        }
    }

    /// Computes the fitness of an individual from its trials.
    pub(crate) fn fitness(&self, trials: &[Outcome]) -> f64 {
        if !self.product && self.trials == Trials::Mean {
            return mean_of_trials(trials);
        }
        let of_trial = |outcome: &Outcome| -> f64 {
            if self.product { outcome.terms.iter().product() } else { outcome.terms.iter().sum() }
        };
        let rewards = trials.iter().map(of_trial);
        match self.trials {
            Trials::Mean => rewards.sum::<f64>() / trials.len().max(1) as f64,
            Trials::Sum => rewards.sum(),
            // NaN is the worst.
            Trials::Worst => rewards.fold(f64::INFINITY, |worst, own| {
                if own.is_nan() || worst.is_nan() { f64::NAN } else { Scalar::min(worst, own) }
            }),
        }
    }
}

/// Lists warnings about conditions that must hold for longer than a trial.
fn too_long(list: &str, wanted: &[Wanted], document: &Document, source: &Source) -> Vec<String> {
    let most = document.episode.steps;
    let long = wanted.iter().enumerate().filter(|(_, wanted)| wanted.steps().is_some_and(|steps| steps > most));
    let warning = |(index, _)| {
        let place = source.of(&format!("/{list}/{index}"));
        format!("{place}: the condition must hold for more than the {most} steps of a trial, so it never holds")
    };
    long.map(warning).collect()
}

/// Leaks the name of a note, once for equal ones.
fn lasting(name: &str) -> &'static str {
    static KEPT: Mutex<BTreeSet<&str>> = Mutex::new(BTreeSet::new());
    // Notes have static names. The set limits the leak to one copy of each distinct name.
    let mut names = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(name) {
        return known;
    }
    let name: &'static str = String::leak(name.to_owned());
    names.insert(name);
    name
}
