//! What an experiment is to the command: a name, a table of settings, and lives of genomes.

use std::path::PathBuf;

use farsa_body::Recorder;
use farsa_models::MjcfOptions;

use crate::controller_export::{ControllerExport, CtrnnExport, StartExport};
use crate::error::Error;
use crate::lanes::Lanes;
use crate::life::Job;
use crate::search::Search;
use crate::settings::{Setting, Settings};
use crate::stage::Stage;

/// An experiment that the `farsa` command lists, explains, runs, tests and replays.
///
/// The experiment says what there is to set and how a genome lives; the command brings evolution, threads, files,
/// checkpoints and replay. See the crate's documentation for a whole one.
pub trait Experiment: Sync {
    /// The name on the command line and in the run directory: lower-case letters, digits and hyphens.
    fn name(&self) -> &'static str;

    /// What is asked, in one line.
    fn summary(&self) -> &'static str;

    /// The conditions that are compared, the default one first; empty if there is only one.
    fn conditions(&self) -> &'static [&'static str] {
        &[]
    }

    /// Grows by one whenever the same configuration, seed and genes earn another fitness.
    ///
    /// A run of another version is neither resumed nor replayed: its lives would be others.
    fn values_version(&self) -> u32 {
        1
    }

    /// How a run searches for good genomes under a condition; by default with the truncation algorithm.
    fn search(&self, condition: &str) -> Search {
        let _ = condition;
        Search::Truncation
    }

    /// Every setting of the experiment under a condition (`""` if there are none), with its default.
    ///
    /// The settings of evolution (`evolution.*`, [`evolution::settings`](crate::evolution::settings) or, as
    /// [`search`](Self::search) says, [`evolution::steady_state_settings`](crate::evolution::steady_state_settings)) are
    /// added by the command; a setting here with the same key replaces the one there, which is how an experiment has its own
    /// defaults.
    fn settings(&self, condition: &str) -> Vec<Setting>;

    /// The files whose content lives depend on, such as tables of sensors that a setting names; by default none.
    ///
    /// A run remembers their checksums and is neither resumed, replayed nor tested with other ones. Relative paths are
    /// relative to the current directory.
    ///
    /// # Errors
    /// [`Error::setting`] for a value that names no file.
    fn files(&self, condition: &str, settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        let _ = (condition, settings);
        Ok(Vec::new())
    }

    /// Builds what one thread needs to live lives under a condition and checked settings.
    ///
    /// Called once for every thread; all of them must live the same lives.
    ///
    /// # Errors
    /// [`Error::setting`] for values that are each allowed but do not go together.
    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error>;
}

/// An experiment ready to live lives in one thread: its robot, world and scratch memory.
///
/// A life must depend on the genes and the [`Job`] alone, never on the lives this value lived before: that is what
/// makes runs repeatable, resumable and the same on any number of threads.
pub trait Setup: Send {
    /// Number of genes; where populations differ, of the one with the most.
    fn genes(&self) -> usize;

    /// Bits of a gene, 1 to 16: genes are 0 to 2^bits - 1.
    fn gene_bits(&self) -> u32 {
        16
    }

    /// Number of populations that evolve against each other, each of `evolution.population` individuals; by default one.
    ///
    /// The individuals of all are numbered through, one population after the other: see [`Job::population`]. With more
    /// than one, [`live_against`](Self::live_against) lives the lives.
    fn populations(&self) -> usize {
        1
    }

    /// What the populations are called, in their order: one word each; by default their numbers, from 0.
    fn population_names(&self) -> Vec<String> {
        (0..self.populations()).map(|population| population.to_string()).collect()
    }

    /// Trials of an evaluation.
    fn trials(&self) -> usize {
        1
    }

    /// Names of the terms of the fitness that [`Outcome::terms`] holds, in its order.
    fn terms(&self) -> Vec<String> {
        vec!["fitness".into()]
    }

    /// What a life tells its [`Tape`] at every step, by name: [`Stage::of_scalars`] if it is a row of numbers.
    fn stage(&self) -> Stage;

    /// The stage of one genome's lives, where bodies are made of genes; by default [`stage`](Self::stage).
    ///
    /// The channels must be those of the stage, whatever the genes.
    fn stage_of(&self, genes: &[u16]) -> Stage {
        let _ = genes;
        self.stage()
    }

    /// What a MuJoCo model of the robot on the [`stage`](Self::stage) says beside the robot, for `farsa export`.
    ///
    /// By default the time between two steps, if the experiment has a clock, and gravity 9.81 m/s2 downwards.
    fn mjcf_options(&self) -> MjcfOptions {
        let (plain, step) = (MjcfOptions::default(), self.description().step_seconds);
        MjcfOptions { time_step: if step > 0.0 { step } else { plain.time_step }, ..plain }
    }

    /// The controller of these genes with its channels, for `farsa export controller`; by default there is none to export.
    fn controller(&self, genes: &[u16]) -> Option<ControllerExport> {
        let _ = genes;
        None
    }

    /// The continuous-time network of these genes, for `farsa export controller --format bytes` where there is no
    /// [`controller`](Self::controller); by default there is none.
    fn ctrnn(&self, genes: &[u16]) -> Option<CtrnnExport> {
        let _ = genes;
        None
    }

    /// How the trial of a job starts, for `farsa export starts`; by default that cannot be told.
    fn start(&self, job: Job) -> Option<StartExport> {
        let _ = job;
        None
    }

    /// What the robot senses, does and computes with, for `farsa info`.
    fn description(&self) -> Description;

    /// Lives one trial, `job.trial`, from its start to its end.
    ///
    /// A run's seeds are below 2^63. In `farsa test` the seed has bit 63 set, so that no number is shared with any run;
    /// the individual is then the first of its population and the generation counts the earlier lives of the same trial.
    ///
    /// What [`stage`](Self::stage) names goes to the tape at every step when it is on; whether it is must not change the
    /// life. `genes` has [`genes`](Self::genes) entries. A life that broke down is [`Outcome::failed`].
    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome;

    /// Lives one trial against opponents, one of each other population in the order of the populations; by default there
    /// are none and it is [`live`](Self::live).
    ///
    /// Which population `genes` is of follows from `job`, [`Job::population`]. Trial t of generation g is lived against the
    /// champions of generation g - 1 - t, and where there were none yet against individual t (modulo their number) of the
    /// other populations of generation g.
    fn live_against(&mut self, genes: &[u16], opponents: &[&[u16]], job: Job, tape: &mut Tape<'_>) -> Outcome {
        let _ = opponents;
        self.live(genes, job, tape)
    }

    /// Gets ready to live lives side by side and returns in how many lanes [`live_many`](Self::live_many) will; by default
    /// in one.
    ///
    /// # Errors
    /// Whatever keeps the lanes from being built.
    fn use_lanes(&mut self, lanes: Lanes) -> Result<Lanes, Error> {
        let _ = lanes;
        Ok(Lanes::one())
    }

    /// Lives one task after the other, or several side by side, until `next` has no more; `done` takes the number of each
    /// with what came of it, which is what [`live`](Self::live), or [`live_against`](Self::live_against) the task's
    /// opponents, would return.
    ///
    /// `next` may be asked in any order of `done`: other threads draw from the same tasks.
    fn live_many<'g>(&mut self, next: &mut dyn FnMut() -> Option<Task<'g>>, done: &mut dyn FnMut(usize, Outcome)) {
        while let Some(Task { number, genes, opponents, job }) = next() {
            done(number, self.live_against(genes, opponents, job, &mut Tape::off()));
        }
    }

    /// The words from which learning starts, where the search is [`Search::Learning`]: all that a [`lesson`](Self::lesson)
    /// depends on besides seed and generation. By default there are none.
    fn first_words(&self, seed: u64) -> Vec<f64> {
        let _ = seed;
        Vec::new()
    }

    /// Changes the words by one lesson and says what it was like; `None` if these are not words to learn from.
    ///
    /// The same words, seed and generation must become the same words, whatever this value did before.
    fn lesson(&mut self, words: &mut [f64], seed: u64, generation: u32) -> Option<Lesson> {
        let _ = (words, seed, generation);
        None
    }

    /// The genes \[[`genes`](Self::genes)\] of what has been learned in these words.
    fn learned(&self, words: &[f64]) -> Vec<u16> {
        let _ = words;
        Vec::new()
    }

    /// The fitness of an individual from its trials, in the order of trials; `farsa test` asks for single ones too.
    ///
    /// By default the sum of all terms.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        trials.iter().flat_map(|outcome| &outcome.terms).sum()
    }
}

/// One trial of many that are to be lived.
#[derive(Debug, Clone, Copy)]
pub struct Task<'g> {
    /// Its number among them.
    pub number: usize,
    /// Who lives.
    pub genes: &'g [u16],
    /// Whom it lives against, one of each other population; empty where there is only one.
    pub opponents: &'g [&'g [u16]],
    /// Which life.
    pub job: Job,
}

/// What a lesson was like, [`Setup::lesson`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Lesson {
    /// Root of the mean squared error of motor values before it, on demonstrations that have never been learned from.
    pub before: f64,
    /// The same on the same demonstrations after it.
    pub after: f64,
    /// Share of the demonstrations that succeeded \[0..1\].
    pub successes: f64,
}

/// What came of one trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outcome {
    /// The terms of the fitness, named by [`Setup::terms`]; a term that is not finite makes the individual a failed one.
    pub terms: Vec<f64>,
    /// Steps lived.
    pub steps: u32,
    /// Whether the trial succeeded, by a definition that may be stricter than the fitness.
    pub success: bool,
    /// What else `farsa test` tells about the trial, by name: `("phase", "lift".into())`; the same names in every trial.
    pub notes: Vec<(&'static str, Note)>,
}

impl Outcome {
    /// A life that broke down: its individual is counted as failed and ranks last.
    pub fn failed() -> Self {
        Self { terms: vec![f64::NAN], ..Self::default() }
    }

    /// Whether all terms are finite.
    pub fn is_finite(&self) -> bool {
        self.terms.iter().all(|term| term.is_finite())
    }
}

/// A value of [`Outcome::notes`].
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// A quantity; `farsa test` gives its mean.
    Number(f64),
    /// One of a few words; `farsa test` counts them.
    Text(String),
}

impl From<f64> for Note {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<&str> for Note {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

/// Where a life tells what happens in each step, when somebody wants to know.
pub struct Tape<'a> {
    recorder: Option<&'a mut dyn Recorder>,
}

impl<'a> Tape<'a> {
    /// A tape that keeps nothing.
    pub fn off() -> Self {
        Self { recorder: None }
    }

    /// A tape that tells a recorder.
    pub fn to(recorder: &'a mut dyn Recorder) -> Self {
        Self { recorder: Some(recorder) }
    }

    /// Who listens, if anybody does: a life need not gather anything otherwise.
    pub fn recorder(&mut self) -> Option<&mut (dyn Recorder + 'a)> {
        self.recorder.as_deref_mut()
    }

    /// Tells one step's scalars, in the order of the stage, and ends the tick at `time` \[s\].
    pub fn row(&mut self, time: f64, values: &[f64]) {
        if let Some(recorder) = &mut self.recorder {
            recorder.scalars(values);
            recorder.tick(time);
        }
    }
}

/// What `farsa info` tells about a robot and its controller.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Description {
    /// The sensors in the order of the network's inputs.
    pub sensors: Vec<ChannelGroup>,
    /// The motors in the order of the network's outputs.
    pub motors: Vec<ChannelGroup>,
    /// The controller in one line.
    pub network: String,
    /// Number of parameters that the genes become.
    pub parameters: usize,
    /// Most steps of a trial.
    pub steps: usize,
    /// Time between two steps \[s\]; 0 if the experiment has no clock.
    pub step_seconds: f64,
}

/// A group of sensor or motor channels.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct ChannelGroup {
    /// What they are called.
    pub name: String,
    /// How many there are.
    pub count: usize,
    /// What they hold, with unit and range.
    pub meaning: String,
}

impl ChannelGroup {
    /// A group of channels.
    pub fn new(name: &str, count: usize, meaning: &str) -> Self {
        Self { name: name.into(), count, meaning: meaning.into() }
    }
}
