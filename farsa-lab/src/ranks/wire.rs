//! Bytes of messages between ranks.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use farsa_evo::{ObservationStatistics, Snapshot as _};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::experiment::outcome::{Failure, Note, Outcome};

/// Encodes a message.
pub(crate) fn to_bytes(content: &impl Serialize) -> Result<Vec<u8>, Error> {
    postcard::to_stdvec(content).map_err(|error| Error::Other(format!("a message between ranks: {error}")))
}

/// Decodes a message of another rank.
pub(crate) fn from_bytes<T: DeserializeOwned>(rank: usize, bytes: &[u8]) -> Result<T, Error> {
    let why = |error| Error::Rank { rank, code: 1, why: format!("said what this program cannot read: {error}") };
    postcard::from_bytes(bytes).map_err(why)
}

/// Outcomes of a rank with their numbers. Each name of a note is stored once.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Outcomes {
    names: Vec<String>,
    all: Vec<(u32, Option<WireOutcome>)>,
}

#[derive(Debug, Serialize, Deserialize)]
struct WireOutcome {
    terms: Vec<f64>,
    steps: u32,
    success: bool,
    notes: Vec<(u16, WireNote)>,
    /// State of the observation statistics.
    observed: Option<Vec<u8>>,
    failure: Option<WireFailure>,
}

#[derive(Debug, Serialize, Deserialize)]
enum WireNote {
    Number(f64),
    Text(String),
}

#[derive(Debug, Serialize, Deserialize)]
enum WireFailure {
    Panicked(String),
    Endless(u64),
    Interrupted,
}

impl Outcomes {
    /// Encodes outcomes.
    pub(crate) fn from_numbered(numbered: &[(usize, Option<Outcome>)]) -> Self {
        let mut names: Vec<&'static str> = Vec::new();
        let mut place = |name: &'static str| {
            let index = names.iter().position(|other| *other == name);
            index.unwrap_or_else(|| {
                names.push(name);
                names.len() - 1
            }) as u16
        };
        let mut wired = |outcome: &Outcome| WireOutcome {
            terms: outcome.terms.clone(),
            steps: outcome.steps,
            success: outcome.success,
            notes: outcome.notes.iter().map(|(name, note)| (place(name), wired_note(note))).collect(),
            observed: outcome.observed.as_ref().map(ObservationStatistics::save),
            failure: outcome.failure.as_ref().map(|failure| match failure {
                Failure::Panicked(why) => WireFailure::Panicked(why.clone()),
                Failure::Endless(steps) => WireFailure::Endless(*steps),
                Failure::Interrupted => WireFailure::Interrupted,
            }),
        };
        let all = numbered.iter().map(|(number, outcome)| (*number as u32, outcome.as_ref().map(&mut wired))).collect();
        Self { names: names.into_iter().map(str::to_owned).collect(), all }
    }

    /// Decodes the outcomes, bit for bit. The result is `None` if a note has an unknown name, or if observations are invalid.
    pub(crate) fn into_numbered(self) -> Option<Vec<(usize, Option<Outcome>)>> {
        let names: Vec<&'static str> = self.names.iter().map(|name| lasting(name)).collect();
        let outcome = |wired: WireOutcome| {
            let notes = wired.notes.into_iter().map(|(place, note)| {
                let note = match note {
                    WireNote::Number(x) => Note::Number(x),
                    WireNote::Text(text) => Note::Text(text),
                };
                Some((*names.get(usize::from(place))?, note))
            });
            Some(Outcome {
                terms: wired.terms,
                steps: wired.steps,
                success: wired.success,
                notes: notes.collect::<Option<_>>()?,
                observed: match wired.observed {
                    None => None,
                    Some(state) => Some(ObservationStatistics::from_saved(&state).ok()?),
                },
                failure: wired.failure.map(|failure| match failure {
                    WireFailure::Panicked(why) => Failure::Panicked(why),
                    WireFailure::Endless(steps) => Failure::Endless(steps),
                    WireFailure::Interrupted => Failure::Interrupted,
                }),
            })
        };
        let numbered = self.all.into_iter().map(|(number, wired)| match wired {
            None => Some((number as usize, None)),
            Some(wired) => Some((number as usize, Some(outcome(wired)?))),
        });
        numbered.collect()
    }
}

fn wired_note(note: &Note) -> WireNote {
    match note {
        Note::Number(x) => WireNote::Number(*x),
        Note::Text(text) => WireNote::Text(text.clone()),
    }
}

/// Returns a name with a static lifetime. An experiment has few names of notes, and each is stored once.
fn lasting(name: &str) -> &'static str {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(name) = names.get(name) {
        return name;
    }
    let leaked: &'static str = Box::leak(name.into());
    names.insert(leaked);
    leaked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outcomes_arrive_as_they_were() {
        let strange = f64::from_bits(0x7FF8_0000_0000_1234);
        let mut observed = ObservationStatistics::new(2).unwrap();
        assert!(observed.push(&[0.1, -7.0]) && observed.push(&[0.3, 1e30]));
        let all = vec![
            (7, Some(Outcome { terms: vec![0.1, -0.0, f64::INFINITY, strange], steps: 9, ..Outcome::default() })),
            (8, None),
            (9, Some(Outcome { observed: Some(observed), ..Outcome::default() })),
            (
                0,
                Some(Outcome {
                    success: true,
                    notes: vec![("phase", "lift".into()), ("height", 0.25.into())],
                    failure: Some(Failure::Endless(1 << 40)),
                    ..Outcome::failed()
                }),
            ),
            (1, Some(Outcome { notes: vec![("height", 1.0.into())], ..Outcome::panicked("no reason (x.rs:1)") })),
        ];
        let bytes = to_bytes(&Outcomes::from_numbered(&all)).unwrap();
        let again = from_bytes::<Outcomes>(1, &bytes).unwrap().into_numbered().unwrap();
        // NaN does not equal itself, so the bits are compared.
        assert_eq!(format!("{again:?}"), format!("{all:?}"));
        let bits = |all: &[(usize, Option<Outcome>)]| -> Vec<u64> {
            all.iter().flat_map(|(_, outcome)| outcome.iter().flat_map(|o| &o.terms)).map(|x| x.to_bits()).collect()
        };
        assert_eq!(bits(&again), bits(&all));
    }

    #[test]
    fn what_cannot_be_read_names_its_rank() {
        let bytes = to_bytes(&Outcomes::from_numbered(&[(3, Some(Outcome::failed()))])).unwrap();
        for length in 0..bytes.len() {
            let error = from_bytes::<Outcomes>(2, &bytes[..length]).unwrap_err().to_string();
            assert!(error.starts_with("rank 2: said what this program cannot read: "), "{error}");
        }
        let unknown = Outcome { notes: vec![("phase", 0.0.into())], ..Outcome::default() };
        let mut broken = Outcomes::from_numbered(&[(3, Some(unknown))]);
        broken.names.clear();
        assert_eq!(broken.into_numbered(), None);
        let mut broken = Outcomes::from_numbered(&[(3, Some(Outcome::default()))]);
        for state in [vec![], vec![1; 23], vec![1; 25]] {
            broken.all[0].1.as_mut().unwrap().observed = Some(state);
            assert_eq!(Outcomes { names: Vec::new(), all: std::mem::take(&mut broken.all) }.into_numbered(), None);
            broken = Outcomes::from_numbered(&[(3, Some(Outcome::default()))]);
        }
    }
}
