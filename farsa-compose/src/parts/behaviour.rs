//! Objectives and measures of an individual in addition to its fitness.

use farsa_lab::{Behaviour, Error, Note, Outcome, Parameter};

use crate::check::source::Source;
use crate::document::BehaviourOfTerms;

/// Terms that are objectives or measures, from the notes of outcomes.
#[derive(Clone, Debug)]
pub(crate) struct TermBehaviour {
    objectives: Vec<(String, f64)>,
    descriptors: Vec<Parameter>,
}

/// Returns the name of the note with a term before its weight.
pub(crate) fn note_of(term: &str) -> String {
    format!("measured {term}")
}

impl TermBehaviour {
    /// Reads the objectives and measures of a document with these terms. Returns `None` without any.
    ///
    /// # Errors
    /// [`Error::Unknown`] for an unknown term, [`Error::Setting`] for an empty range.
    pub(crate) fn new(behaviour: &BehaviourOfTerms, names: &[String], source: &Source) -> Result<Option<Self>, Error> {
        let known = |name: &String, path: String| {
            let term = names.iter().find(|known| *known == name).cloned();
            term.ok_or_else(|| Error::unknown(&source.of(&path), "term", name, names.iter().map(String::as_str)))
        };
        let objectives = behaviour.objectives.iter().enumerate().map(|(index, objective)| {
            let name = known(&objective.term, format!("/behaviour/objectives/{index}/term"))?;
            Ok((name, if objective.less { -1.0 } else { 1.0 }))
        });
        let descriptors = behaviour.descriptors.iter().enumerate().map(|(index, descriptor)| {
            let path = format!("/behaviour/descriptors/{index}");
            let [low, high] = descriptor.range;
            if low >= high {
                return Err(source.wrong(&format!("{path}/range"), format!("{low} to {high} does not rise")));
            }
            Ok(Parameter::new(known(&descriptor.term, format!("{path}/term"))?, descriptor.range))
        });
        let objectives = objectives.collect::<Result<Vec<_>, Error>>()?;
        let descriptors = descriptors.collect::<Result<Vec<_>, Error>>()?;
        let says = !objectives.is_empty() || !descriptors.is_empty();
        Ok(says.then_some(Self { objectives, descriptors }))
    }

    /// Returns true if a term is an objective or a measure.
    pub(crate) fn looks_at(&self, name: &str) -> bool {
        let objectives = self.objectives.iter().map(|(name, _)| name.as_str());
        objectives.chain(self.descriptors.iter().map(|descriptor| descriptor.name.as_str())).any(|known| known == name)
    }
}

impl Behaviour for TermBehaviour {
    fn objectives(&self) -> Vec<String> {
        let named = |(name, sign): &(String, f64)| if *sign < 0.0 { format!("minus {name}") } else { name.clone() };
        self.objectives.iter().map(named).collect()
    }

    fn descriptors(&self) -> Vec<Parameter> {
        self.descriptors.clone()
    }

    fn describe(&self, trials: &[Outcome]) -> Vec<f64> {
        let of_trial = |trial: &Outcome, name: &str| {
            let name = note_of(name);
            let note = trial.notes.iter().find(|(known, _)| **known == name).map(|(_, note)| note);
            if let Some(Note::Number(value)) = note { *value } else { f64::NAN }
        };
        let mean = |name: &str| {
            let sum: f64 = trials.iter().map(|trial| of_trial(trial, name)).sum();
            sum / trials.len().max(1) as f64
        };
        let objectives = self.objectives.iter().map(|(name, sign)| sign * mean(name));
        objectives.chain(self.descriptors.iter().map(|descriptor| mean(&descriptor.name))).collect()
    }
}
