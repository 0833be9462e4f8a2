//! `protocols/NAME.states.csv`: what the neurons of the first trials of each case were like, step by step.

use std::path::{Path, PathBuf};

use farsa_body::Recorder;
use farsa_view::Schema;

use crate::error::Error;
use crate::evaluation::protocols::files::{ProtocolRecord, make_folder};
use crate::evaluation::protocols::trial::CaseTrial;
use crate::evaluation::recorded;
use crate::evaluation::test::Tested;
use crate::experiment::protocol::{CaseId, Protocol};
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// First trials of each case that are recorded.
const TRIALS: usize = 6;
/// Maximum number of recorded cases.
const MAX_CASES: usize = 60;
/// Most steps that are kept of a trial: of a longer one every second is, or every fourth, and so on.
const MAX_STEPS: usize = 1000;
/// Columns before those of the neurons.
const HEAD: [&str; 4] = ["case", "trial", "success", "step"];

/// States of some trials.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct States {
    /// Names of the neurons.
    pub(crate) neurons: Vec<String>,
    pub(crate) trials: Vec<StateTrial>,
}

/// States of a trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct StateTrial {
    /// Its case, and its number in that.
    pub(crate) case: usize,
    pub(crate) trial: usize,
    pub(crate) success: bool,
    /// Steps, counted from 0, and what the neurons were like after each \[neurons\].
    pub(crate) steps: Vec<(u32, Vec<f32>)>,
}

/// Keeps the states of a span of neurons.
struct StateRecorder {
    first: usize,
    count: usize,
    now: Vec<f32>,
    step: u32,
    stride: u32,
    kept: Vec<(u32, Vec<f32>)>,
}

impl Recorder for StateRecorder {
    fn neurons(&mut self, states: &[f32]) {
        self.now.clear();
        self.now.extend(states.iter().skip(self.first).take(self.count));
    }

    fn tick(&mut self, _: f64) {
        if self.step.is_multiple_of(self.stride) {
            if self.kept.len() == MAX_STEPS {
                self.stride *= 2;
                self.kept.retain(|(step, _)| step.is_multiple_of(self.stride));
            }
            if self.step.is_multiple_of(self.stride) {
                self.kept.push((self.step, self.now.clone()));
            }
        }
        self.step += 1;
    }
}

impl States {
    /// Runs the first trials of each case again and records them. Trials that panic are skipped.
    ///
    /// With several populations the first one's champion is recorded.
    ///
    /// # Errors
    /// [`Error::Other`] for neurons beyond the schema, and as for [`Plan::evaluator`].
    pub(crate) fn record(
        plan: &Plan<'_>,
        tested: Tested<'_>,
        [number, trials]: [usize; 2],
        protocol: &Protocol,
        seed: u64,
    ) -> Result<Self, Error> {
        let mut evaluator = plan.evaluator()?;
        let Some(parameters) = tested.parameters.first() else { return Ok(Self::default()) };
        let schema: Schema =
            evaluator.bodies().map_or_else(|| evaluator.info().schema, |bodies| bodies.schema_with(parameters));
        let span = protocol.states.clone();
        let Some(neurons) = schema.neurons.get(span.clone()) else {
            let why = format!("protocol `{}` records the states of neurons {span:?}", protocol.name);
            return Err(Error::Other(format!("{why} of {}", schema.neurons.len())));
        };
        let neurons = neurons.iter().map(|neuron| neuron.name.clone()).collect();
        let mut recordings = Vec::new();
        for case in 0..protocol.cases.len().min(MAX_CASES) {
            for trial in 0..trials.min(TRIALS) {
                let (first, count) = (span.start, span.len());
                let mut recorder =
                    StateRecorder { first, count, now: vec![0.0; count], step: 0, stride: 1, kept: Vec::new() };
                let of_case = CaseTrial { case: CaseId { protocol: number, case }, trial, seed };
                match of_case.run(evaluator.as_mut(), tested, &mut recorder) {
                    Ok(outcome) => {
                        recordings.push(StateTrial { case, trial, success: outcome.success, steps: recorder.kept });
                    }
                    Err(()) => evaluator = plan.evaluator()?,
                }
            }
        }
        Ok(Self { neurons, trials: recordings })
    }

    /// Iterates over the points of all trials.
    pub(crate) fn points(&self) -> impl Iterator<Item = &[f32]> + Clone {
        self.trials.iter().flat_map(|trial| &trial.steps).map(|(_, states)| states.as_slice())
    }

    /// Reads the states of a protocol with the record of their test.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::File`].
    pub(crate) fn read(directory: &Directory, name: &str) -> Result<Option<(Self, Option<ProtocolRecord>)>, Error> {
        let [table, record] = places(directory, name);
        let Some((text, found)) = recorded::read(&table, &record)? else { return Ok(None) };
        Ok(Some((Self::from_text(&text).map_err(|why| Error::damaged(&table, why))?, found)))
    }

    /// Writes both files.
    ///
    /// # Errors
    /// As for [`recorded::write`] and [`make_folder`].
    pub(crate) fn write(
        &self,
        directory: &Directory,
        name: &str,
        record: impl FnOnce(u32) -> ProtocolRecord,
    ) -> Result<(), Error> {
        make_folder(directory)?;
        let [path, json] = places(directory, name);
        let bytes = self.csv(&path)?;
        recorded::write(directory.path(), (&path, &bytes), &json, record)
    }

    pub(crate) fn csv(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let wrong = |error: csv::Error| Error::io("write", path)(error.into());
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(HEAD.into_iter().chain(self.neurons.iter().map(String::as_str))).map_err(wrong)?;
        for StateTrial { case, trial, success, steps } in &self.trials {
            for (step, states) in steps {
                let of_trial = [case.to_string(), trial.to_string(), success.to_string(), step.to_string()];
                let states = states.iter().map(f32::to_string);
                writer.write_record(of_trial.into_iter().chain(states)).map_err(wrong)?;
            }
        }
        writer.into_inner().map_err(|error| Error::io("write", path)(error.into_error()))
    }

    pub(crate) fn from_text(text: &str) -> Result<Self, String> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let head = reader.headers().map_err(|error| error.to_string())?;
        if !head.iter().take(HEAD.len()).eq(HEAD) || !text.ends_with('\n') {
            return Err("is not a table of states".into());
        }
        let neurons = head.iter().skip(HEAD.len()).map(str::to_owned).collect();
        let mut trials: Vec<StateTrial> = Vec::new();
        for (number, record) in reader.records().enumerate() {
            let record = record.map_err(|error| error.to_string())?;
            let line = || format!("line {} is not a state", number + 1);
            let field = |column: usize| record.get(column).unwrap_or_default();
            let number = |column: usize| field(column).parse().map_err(|_| line());
            let [case, trial, step] = [number(0)?, number(1)?, number(3)?];
            let success = field(2).parse().map_err(|_| line())?;
            let states: Result<Vec<f32>, _> = record.iter().skip(HEAD.len()).map(str::parse).collect();
            let state = (u32::try_from(step).map_err(|_| line())?, states.map_err(|_| line())?);
            match trials.last_mut() {
                Some(last) if (last.case, last.trial) == (case, trial) => last.steps.push(state),
                _ => trials.push(StateTrial { case, trial, success, steps: vec![state] }),
            }
        }
        Ok(Self { neurons, trials })
    }
}

/// Where the files are: the table and its record.
fn places(directory: &Directory, name: &str) -> [PathBuf; 2] {
    // No protocol has a point in its name.
    ["csv", "json"].map(|end| directory.protocols().join(format!("{name}.states.{end}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn states() -> States {
        let trial = |case, trial, success| StateTrial {
            case,
            trial,
            success,
            steps: vec![(0, vec![0.1, f32::MIN_POSITIVE]), (2, vec![1.0 / 3.0, 7e12])],
        };
        let neurons = vec!["inner 1".into(), "a, \"b\"".into()];
        States { neurons, trials: vec![trial(0, 0, true), trial(0, 1, false), trial(3, 0, false)] }
    }

    #[test]
    fn what_is_written_is_read_to_the_last_bit() {
        let text = String::from_utf8(states().csv(Path::new("x")).unwrap()).unwrap();
        assert!(text.starts_with("case,trial,success,step,inner 1,\"a, \"\"b\"\"\"\n0,0,true,0,0.1,"), "{text}");
        assert_eq!(States::from_text(&text).unwrap(), states());
        assert_eq!(states().points().count(), 6);
        for (wrong, why) in [
            (text.replace("case,", "row,"), "not a table of states"),
            (text.trim_end().to_owned(), "not a table of states"),
            (text.replace("0,1,false,0", "0,one,false,0"), "line 3 is not a state"),
            (text.replace("0,1,false,0", "0,1,no,0"), "line 3 is not a state"),
            (text.replace("0,1,false,0", "0,1,false,-1"), "line 3 is not a state"),
            (text.replace("0,1,false,0,0.1", "0,1,false,0,much"), "line 3 is not a state"),
            (text.replace("0,1,false,0,", "0,1,false,0,1,"), "7 fields"),
        ] {
            let found = States::from_text(&wrong).unwrap_err();
            assert!(found.contains(why), "{found}\n{wrong}");
        }
    }

    #[test]
    fn of_long_trials_evenly_spaced_steps_are_kept() {
        let mut recorder =
            StateRecorder { first: 1, count: 2, now: vec![0.0; 2], step: 0, stride: 1, kept: Vec::new() };
        for step in 0..2500_u16 {
            recorder.neurons(&[f32::from(step), 0.5, -f32::from(step), 9.0]);
            recorder.tick(0.0);
        }
        assert_eq!((recorder.kept.len(), recorder.stride), (625, 4));
        for (place, (step, states)) in recorder.kept.iter().enumerate() {
            assert_eq!((*step, states.as_slice()), (4 * place as u32, &[0.5, -(*step as f32)][..]));
        }
    }
}
