//! Objectives and measures of an individual in addition to its fitness.

use farsa_lab::advanced::Behavior;
use farsa_lab::{Error, Note, Outcome, Parameter};

use crate::check::source::Source;
use crate::document::BehaviourOfTerms;
use crate::parts::tally::Tally;

/// Terms that are objectives or measures, from the notes of outcomes.
#[derive(Clone, Debug)]
pub(crate) struct TermBehaviour {
    objectives: Vec<(String, f64)>,
    descriptors: Vec<Parameter>,
    /// Terms of objectives and then of measures, with the names of their notes.
    terms: Vec<(usize, String)>,
}

impl TermBehaviour {
    /// Reads the objectives and measures of a document with these terms. Returns `None` without any.
    pub(crate) fn new(behaviour: &BehaviourOfTerms, tallies: &[Tally], source: &Source) -> Result<Option<Self>, Error> {
        let mut terms = Vec::new();
        let mut term = |name: &String, path: String| {
            let names = tallies.iter().map(|tally| tally.name.as_str());
            let number = source.position(names, ("term", name), &path)?;
            terms.push((number, tallies[number].note()));
            Ok::<_, Error>(tallies[number].label().to_owned())
        };
        let mut objectives = Vec::new();
        for (index, objective) in behaviour.objectives.iter().enumerate() {
            let label = term(&objective.term, format!("/behaviour/objectives/{index}/term"))?;
            objectives.push((label, if objective.less { -1.0 } else { 1.0 }));
        }
        let mut descriptors = Vec::new();
        for (index, descriptor) in behaviour.descriptors.iter().enumerate() {
            let path = format!("/behaviour/descriptors/{index}");
            let [low, high] = descriptor.range;
            if low >= high {
                return Err(source.wrong(&format!("{path}/range"), format!("{low} to {high} does not rise")));
            }
            descriptors.push(Parameter::new(term(&descriptor.term, format!("{path}/term"))?, descriptor.range));
        }
        Ok((!terms.is_empty()).then_some(Self { objectives, descriptors, terms }))
    }

    /// Checks if a term is an objective or a measure.
    pub(crate) fn looks_at(&self, number: usize) -> bool {
        self.terms.iter().any(|(term, _)| *term == number)
    }
}

impl Behavior for TermBehaviour {
    fn objectives(&self) -> Vec<String> {
        let named = |(name, sign): &(String, f64)| if *sign < 0.0 { format!("minus {name}") } else { name.clone() };
        self.objectives.iter().map(named).collect()
    }

    fn measures(&self) -> Vec<Parameter> {
        self.descriptors.clone()
    }

    fn describe(&self, trials: &[Outcome]) -> Vec<f64> {
        let measure = |trial: &Outcome, name: &str| {
            let note = trial.notes.iter().find(|(note, _)| *note == name).map(|(_, note)| note);
            if let Some(Note::Number(value)) = note { *value } else { f64::NAN }
        };
        let mean = |name: &str| {
            let sum: f64 = trials.iter().map(|trial| measure(trial, name)).sum();
            sum / trials.len().max(1) as f64
        };
        let signs = self.objectives.iter().map(|(_, sign)| *sign).chain(std::iter::repeat(1.0));
        self.terms.iter().zip(signs).map(|((_, note), sign)| sign * mean(note)).collect()
    }
}
