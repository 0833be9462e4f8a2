//! What a trial has earned, and whether it has succeeded.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use farsa_lab::{Error, Note, Outcome, mean_of_trials};
use farsa_num::Scalar;

use crate::check::places::Places;
use crate::check::settings::names;
use crate::document::{Condition, Document, Ending, Trials};
use crate::parts::behaviour::{TermBehaviour, note_of};
use crate::parts::groups::Groups;
use crate::parts::tally::Tally;
use crate::parts::wanted::Wanted;
use crate::parts::wiring::json;

/// The terms of a trial, with what they have come to.
#[derive(Clone, Debug)]
pub(crate) struct Ledger {
    pub(crate) tallies: Vec<Tally>,
    success: Vec<Wanted>,
    failure: Vec<Wanted>,
    pub(crate) behaviour: Option<TermBehaviour>,
    /// The terms that fitness is made of: those with a weight, or all where none has one.
    paid: Vec<usize>,
    /// The terms whose measures are notes of an outcome, with their names.
    notes: Vec<(usize, &'static str)>,
    /// Most steps of a trial.
    most_steps: u32,
    product: bool,
    trials: Trials,
    /// Steps of this trial.
    pub(crate) steps: u32,
    /// Whether it broke down, and whether it succeeded.
    pub(crate) failed: bool,
    succeeded: bool,
}

impl Ledger {
    /// That of a document with these robots; `of_steps` says of each term whether it measures what happened in a step.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a term that there is not, [`Error::Setting`] for what does not go together.
    pub(crate) fn new(document: &Document, of_steps: &[bool], groups: &Groups, places: &Places) -> Result<Self, Error> {
        let rewards = names(&json(&document.reward)?);
        let tally = |(number, reward)| Tally::new(reward, number, &rewards, groups, places);
        let mut tallies = document.reward.iter().enumerate().map(tally).collect::<Result<Vec<_>, _>>()?;
        if tallies.is_empty() {
            return Err(places.wrong("/reward", "has no term: nothing is earned"));
        }
        let conditions = |list: &str, all: &[Condition]| {
            let one = |(index, own)| Wanted::new(own, &format!("/{list}/{index}"), &rewards, places);
            all.iter().enumerate().map(one).collect::<Result<Vec<_>, Error>>()
        };
        let (success, failure) = (conditions("success", &document.success)?, conditions("failure", &document.failure)?);
        let ends_with_success = document.episode.ends.contains(&Ending::Success);
        let watched = success.iter().filter(|_| ends_with_success).chain(&failure).map(|wanted| wanted.term);
        let watched: Vec<usize> = watched.chain(tallies.iter().filter_map(|tally| tally.during)).collect();
        for (number, tally) in tallies.iter_mut().enumerate() {
            tally.late = tally.may_be_late() && !of_steps[number] && !watched.contains(&number);
        }
        let behaviour = TermBehaviour::new(&document.behaviour, &rewards, places)?;
        let noted = tallies.iter().enumerate().filter(|(_, tally)| {
            tally.is_only_measured() || behaviour.as_ref().is_some_and(|behaviour| behaviour.looks_at(&tally.name))
        });
        let paid: Vec<usize> = (0..tallies.len()).filter(|number| !tallies[*number].is_only_measured()).collect();
        let paid = if paid.is_empty() { (0..tallies.len()).collect() } else { paid };
        let notes = noted.map(|(number, tally)| (number, lasting(&note_of(&tally.name)))).collect();
        Ok(Self {
            tallies,
            success,
            failure,
            behaviour,
            paid,
            notes,
            most_steps: document.episode.steps,
            product: document.fitness.product,
            trials: document.fitness.trials,
            steps: 0,
            failed: false,
            succeeded: false,
        })
    }

    /// Forgets an earlier trial; `arranged` says whether this one could begin.
    pub(crate) fn begin(&mut self, arranged: bool) {
        (self.steps, self.succeeded, self.failed) = (0, false, !arranged);
        self.tallies.iter_mut().for_each(Tally::reset);
    }

    /// Says which robots evolve in the next trial, from the first to before the last.
    pub(crate) fn evolve(&mut self, robots: [usize; 2]) {
        self.tallies.iter_mut().for_each(|tally| tally.evolve(robots));
    }

    /// Counts what a term has measured in a step.
    #[inline]
    pub(crate) fn count(&mut self, number: usize, value: f64) {
        self.failed |= !value.is_finite();
        let (others, tally) = self.tallies.split_at_mut(number);
        tally[0].count(value, others);
    }

    /// Whether the trial is over by steps, by failure or by having broken down.
    #[inline]
    pub(crate) fn is_over(&self) -> bool {
        self.failed || self.steps >= self.most_steps || self.has_failed()
    }

    /// Whether a condition of failure holds.
    fn has_failed(&self) -> bool {
        self.failure.iter().any(|wanted| wanted.holds(&self.tallies))
    }

    /// Whether a trial that ended now would have succeeded.
    pub(crate) fn would_succeed(&self) -> bool {
        !self.success.is_empty() && self.success.iter().all(|wanted| wanted.holds(&self.tallies))
    }

    /// What a trial that ends now has earned; NaN if it broke down.
    pub(crate) fn conclude(&mut self) -> f64 {
        self.succeeded = self.would_succeed() && !self.has_failed();
        if self.failed { f64::NAN } else { self.earned() }
    }

    /// What the trial has earned so far.
    pub(crate) fn earned(&self) -> f64 {
        let terms = self.paid().map(|tally| tally.earned(self.most_steps));
        if self.product { terms.product() } else { terms.sum() }
    }

    fn paid(&self) -> impl Iterator<Item = &Tally> {
        self.paid.iter().filter_map(|number| self.tallies.get(*number))
    }

    /// The names of the terms that fitness is made of.
    pub(crate) fn names(&self) -> Vec<String> {
        self.paid().map(|tally| tally.name.clone()).collect()
    }

    /// What came of the trial.
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

    /// The fitness of an individual by its trials.
    pub(crate) fn fitness(&self, trials: &[Outcome]) -> f64 {
        if !self.product && self.trials == Trials::Mean {
            return mean_of_trials(trials);
        }
        let of_trial = |outcome: &Outcome| -> f64 {
            if self.product { outcome.terms.iter().product() } else { outcome.terms.iter().sum() }
        };
        let each = trials.iter().map(of_trial);
        match self.trials {
            Trials::Mean => each.sum::<f64>() / trials.len().max(1) as f64,
            Trials::Sum => each.sum(),
            // NaN is the worst.
            Trials::Worst => each.fold(f64::INFINITY, |worst, own| {
                if own.is_nan() || worst.is_nan() { f64::NAN } else { Scalar::min(worst, own) }
            }),
        }
    }
}

/// A name that lasts as long as the process, as those of notes do; equal ones are one.
fn lasting(name: &str) -> &'static str {
    static KEPT: Mutex<BTreeSet<&str>> = Mutex::new(BTreeSet::new());
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = kept.get(name) {
        return known;
    }
    let name: &'static str = String::leak(name.to_owned());
    kept.insert(name);
    name
}
