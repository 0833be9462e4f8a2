//! Evolution from the first or any later generation on, with everything kept that is needed to go on.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use farsa_evo::{Fitness, Statistics, Strategy as _, TruncationGa};

use crate::directory::{Directory, replace};
use crate::error::Error;
use crate::evolution;
use crate::experiment::{Outcome, Setup, Tape};
use crate::life::Job;
use crate::log::{HEADER, Log};
use crate::manifest::{Manifest, Session};
use crate::plan::{Identity, Plan};
use crate::plot;
use crate::pool::{Pool, Unfinished};
use crate::progress::Progress;
use crate::records::{self, Ancestry, Champion, Checkpoint};
use crate::sealed;

/// How long generations may stay unsaved: short generations would spend their time waiting for the disk.
const UNSAVED: Duration = Duration::from_secs(1);

/// Makes the directory of a new run, ready for its first generation.
pub(crate) fn create(plan: &Plan<'_>, path: &Path) -> Result<Directory, Error> {
    let config = evolution::config(&plan.settings, plan.setup()?.genes())?;
    let evolution = TruncationGa::new(config, plan.seed).map_err(|error| Error::Other(error.to_string()))?;
    let text = plan.to_toml()?;
    Directory::create(path, |directory| {
        let identity = plan.identity();
        replace(&directory.config(), text.as_bytes())?;
        Manifest::new(&identity).write(&directory.manifest())?;
        replace(&directory.log(), HEADER.as_bytes())?;
        let ancestry = Ancestry { identity: identity.clone(), lineage: evolution.lineage().clone() };
        sealed::write(&directory.lineage(), &ancestry)?;
        sealed::write(&directory.checkpoint(), &Checkpoint { identity, log: Log::start(), evolution })
    })
}

/// Evolves the run in a directory up to its last generation and says what came of it.
///
/// # Errors
/// [`Error::Interrupted`] after `stop` became true; all finished generations are then kept.
pub(crate) fn go_on(
    plan: &Plan<'_>,
    directory: &Directory,
    threads: usize,
    stop: &AtomicBool,
    program: &str,
) -> Result<String, Error> {
    // The lock comes before anything is read that another process might be writing.
    let mut log = Log::open(&directory.log())?;
    let path = directory.checkpoint();
    let Checkpoint { identity, log: mark, evolution } = records::read(&path, plan, directory.path())?;
    identity.same_values(&plan.identity(), &path)?;
    let mut pool = Pool::new(plan, threads)?;
    if *evolution.config() != evolution::config(&plan.settings, pool.genes())? {
        return Err(Error::damaged(&path, "its genomes are not those of the experiment"));
    }
    let (done, last) = (evolution.generation(), plan.generations()?);
    if last < done {
        return Err(Error::Usage(format!("{}: has finished {done} generations already", directory.path().display())));
    }
    let mut manifest = Manifest::read(&directory.manifest())?;
    log.rewind(mark)?;
    let text = plan.to_toml()?;
    if fs::read_to_string(directory.config()).ok().as_ref() != Some(&text) {
        replace(&directory.config(), text.as_bytes())?;
    }
    manifest.sessions.push(Session::new(threads, done));

    let individuals = |generations: u32| u64::from(generations).saturating_mul(evolution.config().population as u64);
    let progress = Progress::new("individuals", individuals(done), individuals(last));
    let mut run = Run {
        directory,
        title: plan.name(),
        identity,
        evolution,
        log,
        manifest,
        champion: None,
        started: Instant::now(),
    };
    let mut saved = Instant::now();
    let mut ended = Ok(());
    while run.evolution.generation() < last {
        match run.generation(&mut pool, stop, &progress) {
            Ok(()) => {}
            Err(Unsuccessful::Error(error)) => return Err(error),
            Err(Unsuccessful::Unfinished(Unfinished::Panicked)) => {
                ended = Err(Error::Panicked { generation: run.evolution.generation() });
                break;
            }
            Err(Unsuccessful::Unfinished(Unfinished::Stopped)) => {
                let resume = format!("{program} run --resume {}", directory.path().display());
                ended = Err(Error::Interrupted { resume });
                break;
            }
        }
        if saved.elapsed() >= UNSAVED {
            run.save()?;
            saved = Instant::now();
        }
    }
    drop(progress);
    run.save()?;
    ended.map(|()| run.summary())
}

/// A run in progress.
struct Run<'d> {
    directory: &'d Directory,
    title: String,
    identity: Identity,
    evolution: TruncationGa,
    log: Log,
    manifest: Manifest,
    /// The best of the last generation, once one is finished in this process.
    champion: Option<Champion>,
    started: Instant,
}

/// Why a generation is not finished.
enum Unsuccessful {
    Unfinished(Unfinished),
    Error(Error),
}

impl From<Error> for Unsuccessful {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

impl Run<'_> {
    /// Lives all lives of a generation and makes the next.
    fn generation(&mut self, pool: &mut Pool, stop: &AtomicBool, progress: &Progress) -> Result<(), Unsuccessful> {
        let generation = self.evolution.generation();
        let genomes = self.evolution.ask();
        let seed = self.identity.seed;
        let fitness = pool
            .map(genomes.len(), stop, |setup, individual| {
                let job = Job { seed, generation, individual: individual as u32, trial: 0 };
                let fitness = genomes.get(individual).map_or(Fitness::WORST, |genes| evaluate(setup, genes, job));
                progress.advance();
                fitness
            })
            .map_err(Unsuccessful::Unfinished)?;
        let lost = |why: &str| Error::Other(format!("generation {generation}: {why}"));
        let statistics = Statistics::of(&fitness).ok_or_else(|| lost("nobody lived"))?;
        let best = statistics.best_index;
        let (Some(&fitness_of_best), Some(genes)) = (fitness.get(best), genomes.get(best)) else {
            return Err(lost("nobody is best").into());
        };
        self.champion = Some(Champion {
            identity: self.identity.clone(),
            generation,
            individual: best as u32,
            fitness: fitness_of_best,
            genes: genes.to_vec(),
        });
        self.log.append(&statistics, fitness.len())?;
        self.evolution.tell(&fitness).map_err(|error| lost(&error.to_string()))?;
        if let Some(session) = self.manifest.sessions.last_mut() {
            session.generations += 1;
            session.evaluations += fitness.len() as u64;
        }
        progress.generation(generation, &statistics);
        Ok(())
    }

    /// Keeps everything; the checkpoint, which speaks of the others, comes after what it speaks of.
    fn save(&mut self) -> Result<(), Error> {
        let (directory, identity) = (self.directory, &self.identity);
        let mark = self.log.sync()?;
        let ancestry = Ancestry { identity: identity.clone(), lineage: self.evolution.lineage().clone() };
        sealed::write(&directory.lineage(), &ancestry)?;
        if let Some(champion) = &self.champion {
            sealed::write(&directory.champion(), champion)?;
        }
        let checkpoint = Checkpoint { identity: identity.clone(), log: mark, evolution: self.evolution.clone() };
        sealed::write(&directory.checkpoint(), &checkpoint)?;
        if let Some(session) = self.manifest.sessions.last_mut() {
            session.seconds = self.started.elapsed().as_secs_f64();
        }
        self.manifest.write(&directory.manifest())?;
        let plot = plot::draw(&self.title, self.log.rows()).map_err(|why| Error::damaged(&directory.plot(), why))?;
        replace(&directory.plot(), plot.as_bytes())
    }

    fn summary(&self) -> String {
        let (path, done) = (self.directory.path().display(), self.evolution.generation());
        match &self.champion {
            None => format!("{path}: all {done} generations are finished already"),
            Some(Champion { generation, individual, fitness, .. }) => format!(
                "{path}: {done} generations; champion: individual {individual} of generation {generation}, fitness {:?}",
                fitness.get()
            ),
        }
    }
}

/// Lives all trials of an individual; `job.trial` is set for each.
pub(crate) fn evaluate(setup: &mut dyn Setup, genes: &[u16], job: Job) -> Fitness {
    let mut outcomes: Vec<Outcome> = Vec::with_capacity(setup.trials());
    for trial in 0..setup.trials() {
        let outcome = setup.live(genes, Job { trial: trial as u32, ..job }, &mut Tape::off());
        if !outcome.is_finite() {
            return Fitness::WORST;
        }
        outcomes.push(outcome);
    }
    let fitness = setup.fitness(&outcomes);
    if fitness.is_finite() { Fitness::nan_as_failed(fitness) } else { Fitness::WORST }
}
