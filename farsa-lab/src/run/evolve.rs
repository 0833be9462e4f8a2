//! Evolution from the first or any later generation on, with everything kept that is needed to go on.

use std::fs;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use farsa_evo::{Fitness, Record, Statistics, Strategy};

use crate::error::Error;
use crate::experiment::episode::EpisodeId;
use crate::experiment::evaluator::Evaluation;
use crate::experiment::outcome::Outcome;
use crate::figures::plot;
use crate::run::begin::{lineage, resumed};
use crate::run::diagnostics::DiagnosticsTable;
use crate::run::plan::Plan;
use crate::run::pool::{Pool, Unfinished};
use crate::run::progress::Progress;
use crate::run::records::{Best, Champions, Checkpoint, ToldRecord, evolved};
use crate::run::summary::{Summary, Winner};
use crate::store::directory::{Directory, replace};
use crate::store::identity::Identity;
use crate::store::lineage::{Lineage, rows};
use crate::store::log::Log;
use crate::store::manifest::{Manifest, Session};
use crate::strategy::history::History;
use crate::strategy::opponents::{Hall, Meeting};

/// How long generations may stay unsaved: short generations would spend their time waiting for the disk.
const UNSAVED: Duration = Duration::from_secs(1);

/// Evolves the run in a directory up to its last generation and says what came of it.
///
/// # Errors
/// [`Error::Interrupted`] after `stop` became true; all finished generations are then kept.
pub(crate) fn go_on(
    plan: &Plan<'_>,
    directory: &Directory,
    mut pool: Pool,
    stop: &AtomicBool,
    program: &str,
    quiet: bool,
) -> Result<Summary, Error> {
    evolved(directory)?;
    // The lock comes before anything is read that another process might be writing.
    let mut log = Log::open(&directory.log())?;
    let path = directory.checkpoint();
    let checkpoint = Checkpoint::read(plan, directory)?;
    checkpoint.identity.same_values(&plan.identity()?, &path)?;
    let (strategy, record) = resumed(plan, directory, &checkpoint)?;
    let hall = match record.populations() {
        1 => Hall::default(),
        _ => Hall::before(&History::new(directory.record(), record.clone(), plan.fresh()), pool.genotype())?,
    };
    let (done, last) = (strategy.generation(), plan.generations()?);
    if last < done {
        return Err(Error::Usage(format!("{}: has finished {done} generations already", directory.path().display())));
    }
    let mut manifest = Manifest::read(&directory.manifest())?;
    log.rewind(checkpoint.log)?;
    let lineage = lineage(plan, directory, &checkpoint, &record, strategy.as_ref())?;
    let text = plan.to_toml()?;
    if fs::read_to_string(directory.config()).ok().as_ref() != Some(&text) {
        replace(&directory.config(), text.as_bytes())?;
    }
    manifest.sessions.push(Session::new(pool.threads(), pool.lanes().info(), done));

    let individuals = |generations: u32| u64::from(generations).saturating_mul(strategy.ask().len() as u64);
    let progress = Progress::new(individuals(done), individuals(last), quiet);
    let mut run = Run {
        directory,
        title: plan.name(),
        names: pool.evaluator().populations(),
        identity: checkpoint.identity,
        name: plan.definition().name().into(),
        strategy,
        record,
        hall,
        log,
        lineage,
        diagnostics: DiagnosticsTable::new(plan.definition().diagnostics(), checkpoint.diagnostics),
        manifest,
        champions: None,
        started: Instant::now(),
    };
    let mut saved = Instant::now();
    let mut ended = Ok(());
    while run.strategy.generation() < last {
        match run.generation(&mut pool, stop, &progress) {
            Ok(()) => {}
            Err(Unsuccessful::Error(error)) => return Err(error),
            Err(Unsuccessful::Unfinished(Unfinished::Panicked)) => {
                ended = Err(Error::Panicked { generation: run.strategy.generation() });
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
    /// Of the populations.
    names: Vec<String>,
    identity: Identity,
    /// Of the strategy.
    name: String,
    strategy: Box<dyn Strategy>,
    record: Record,
    /// Whom several populations still have to meet.
    hall: Hall,
    log: Log,
    /// None for a strategy whose individuals have no parents.
    lineage: Option<Lineage>,
    diagnostics: DiagnosticsTable,
    manifest: Manifest,
    /// The best of the last generation, once one is finished in this process.
    champions: Option<Champions>,
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
    /// Evaluates all individuals of a generation and makes the next.
    fn generation(&mut self, pool: &mut Pool, stop: &AtomicBool, progress: &Progress) -> Result<(), Unsuccessful> {
        let generation = self.strategy.generation();
        let genomes = self.strategy.ask();
        let (seed, populations) = (self.identity.seed, self.strategy.populations());
        let lost = |why: &str| Error::Other(format!("generation {generation}: {why}"));
        let trials = pool.evaluator().trials();
        let parameters = pool.genotype().decode_all(genomes).ok_or_else(|| lost("genomes of another length"))?;
        let meeting = Meeting { generation, populations, size: genomes.len() / populations, trials };
        let opponents = self.hall.opponents(meeting, &parameters).ok_or_else(|| lost("an opponent is missing"))?;
        let id = EpisodeId { seed, generation, ..EpisodeId::default() };
        let opponents = Opponents { parameters: &opponents, each: populations - 1 };
        let fitness =
            fitness_of_all(pool, &parameters, opponents, id, stop, progress).map_err(Unsuccessful::Unfinished)?;
        let ranked_by = self.strategy.ranked_by(&fitness);
        let statistics = Statistics::from_fitness(&ranked_by).ok_or_else(|| lost("no individual was evaluated"))?;
        let best = self.strategy.champions(&ranked_by).into_iter().map(|best| {
            let (fitness, genes) = (*ranked_by.get(best)?, genomes.get(best)?.to_vec());
            Some(Best { individual: best as u32, fitness, genes })
        });
        let best: Vec<Best> = best.collect::<Option<_>>().ok_or_else(|| lost("no individual is the best"))?;
        let each = ranked_by.chunks(meeting.size.max(1)).filter(|_| populations > 1);
        let each: Vec<Statistics> = each.filter_map(Statistics::from_fitness).collect();
        self.log.append(&statistics, fitness.len(), &each)?;
        let told = self.record.tell(self.strategy.as_mut(), &fitness);
        told.map_err(|error| lost(&error.to_string()))?;
        self.diagnostics.push(self.strategy.as_ref());
        if let Some(lineage) = &mut self.lineage {
            lineage.append(&rows(self.strategy.as_ref()))?;
        }
        self.hall.add(best.iter().filter_map(|best| parameters.get(best.individual as usize).cloned()).collect());
        self.champions = Some(Champions { identity: self.identity.clone(), generation, best });
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
        let lineage = self.lineage.as_mut().map_or(Ok(0), Lineage::sync)?;
        let (strategy, record) = (self.name.clone(), self.record.clone());
        ToldRecord { identity: identity.clone(), strategy, record }.write(&directory.record())?;
        if let Some(champions) = &self.champions {
            champions.write(&directory.champion())?;
        }
        self.diagnostics.write(directory, &self.title)?;
        Checkpoint {
            identity: identity.clone(),
            generation: self.strategy.generation(),
            log: mark,
            lineage,
            diagnostics: self.diagnostics.rows().to_vec(),
            state: self.strategy.snapshot().map(|strategy| strategy.save()),
        }
        .write(&directory.checkpoint())?;
        if let Some(session) = self.manifest.sessions.last_mut() {
            session.seconds = self.started.elapsed().as_secs_f64();
        }
        self.manifest.write(&directory.manifest())?;
        let plot = plot::draw(&self.title, self.log.lines(), &self.names);
        let plot = plot.map_err(|why| Error::damaged(&directory.plot(), why))?;
        replace(&directory.plot(), plot.as_bytes())
    }

    fn summary(&self) -> Summary {
        let Identity { experiment, condition, seed, .. } = self.identity.clone();
        let session = self.manifest.sessions.last();
        let champions: Vec<Winner> = self.champions.iter().flat_map(Winner::from_champions).collect();
        Summary {
            directory: self.directory.path().display().to_string(),
            experiment,
            condition,
            seed,
            generations: self.strategy.generation(),
            evaluations: session.map_or(0, |session| session.evaluations),
            seconds: session.map_or(0.0, |session| session.seconds),
            champion: champions.first().cloned(),
            champions: if champions.len() > 1 { champions } else { Vec::new() },
        }
    }
}

/// The opponents of a generation's evaluations, in their order, so many for each.
#[derive(Clone, Copy, Default)]
pub(crate) struct Opponents<'g> {
    pub(crate) parameters: &'g [&'g [f32]],
    pub(crate) each: usize,
}

impl<'g> Opponents<'g> {
    /// Those of the evaluation with a number.
    fn get(&self, number: usize) -> &'g [&'g [f32]] {
        self.parameters.get(number * self.each..(number + 1) * self.each).unwrap_or_default()
    }
}

/// Evaluates all trials of all individuals and says what fitness each comes to.
///
/// A trial that failed makes its individual the worst, whatever comes of the others.
fn fitness_of_all(
    pool: &mut Pool,
    parameters: &[Vec<f32>],
    opponents: Opponents<'_>,
    of: EpisodeId,
    stop: &AtomicBool,
    progress: &Progress,
) -> Result<Vec<Fitness>, Unfinished> {
    let (count, trials) = (parameters.len(), pool.evaluator().trials());
    let ended = AtomicUsize::new(0);
    let done = |_: Option<&Outcome>| {
        if (ended.fetch_add(1, Ordering::Relaxed) + 1).is_multiple_of(trials) {
            progress.advance();
        }
    };
    let mut outcomes = evaluate_all(pool, parameters, opponents, of, stop, done)?;
    let evaluator = pool.evaluator();
    let fitness = (0..count).map(|individual| {
        let own = outcomes.iter_mut().skip(individual).step_by(count);
        let outcomes: Option<Vec<Outcome>> = own.map(Option::take).collect();
        let finite = outcomes.filter(|outcomes| outcomes.iter().all(Outcome::is_finite));
        let fitness = finite.map_or(f64::NAN, |outcomes| evaluator.fitness(&outcomes));
        if fitness.is_finite() { Fitness::nan_as_failed(fitness) } else { Fitness::WORST }
    });
    Ok(fitness.collect())
}

/// Evaluates all trials of all individuals, the first of all before the second of any: trial t of individual i has number
/// t x individuals + i. `of.trial` and `of.individual` are set for each; `done` hears of every one that ends.
///
/// Episodes side by side cost least when they are alike. What an individual has left after a trial that failed is left out.
pub(crate) fn evaluate_all(
    pool: &mut Pool,
    parameters: &[Vec<f32>],
    opponents: Opponents<'_>,
    of: EpisodeId,
    stop: &AtomicBool,
    done: impl Fn(Option<&Outcome>) + Sync,
) -> Result<Vec<Option<Outcome>>, Unfinished> {
    let (count, trials) = (parameters.len(), pool.evaluator().trials());
    let failed: Vec<AtomicBool> = parameters.iter().map(|_| AtomicBool::new(false)).collect();
    let task = |number: usize| {
        let (individual, trial) = (number % count, (number / count) as u32);
        let id = EpisodeId { individual: individual as u32, trial, ..of };
        let alive = !failed[individual].load(Ordering::Relaxed);
        let opponents = opponents.get(number);
        let own = parameters.get(individual).filter(|_| alive);
        own.map(|parameters| Evaluation { number, parameters, opponents, id })
    };
    let heard = |number: usize, outcome: Option<&Outcome>| {
        if outcome.is_some_and(|outcome| !outcome.is_finite()) {
            failed[number % count].store(true, Ordering::Relaxed);
        }
        done(outcome);
    };
    pool.evaluate(count * trials, stop, task, heard)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::replay::{Which, replay};
    use crate::evaluation::test;
    use crate::experiment::definition::Experiment;
    use crate::experiment::evaluator::{Evaluator, Parameter, Task};
    use crate::experiment::lanes::Wanted;
    use crate::experiment::outcome::Description;
    use crate::experiment::settings::{Setting, Settings, Value};
    use crate::run::begin::create;
    use crate::store::directory::Directory;
    use crate::strategy::settings::{GENERATIONS, POPULATION};
    use farsa_body::Recorder;
    use farsa_view::Schema;
    use std::path::PathBuf;

    /// Earns its first gene; panics in one trial, if asked to, and fails where the gene is odd.
    #[derive(Clone, Copy)]
    struct Toy {
        version: u32,
        panics: bool,
    }

    impl Experiment for Toy {
        fn name(&self) -> &'static str {
            "toy"
        }
        fn summary(&self) -> &'static str {
            "earns its first gene"
        }
        fn values_version(&self) -> u32 {
            self.version
        }
        fn settings(&self, _: &str) -> Vec<Setting> {
            vec![Setting::whole(GENERATIONS, 4, 1..=100), Setting::whole(POPULATION, 20, 1..=100)]
        }
        fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
            Ok(Box::new(*self))
        }
    }

    impl Task for Toy {
        fn parameters(&self) -> Vec<Parameter> {
            vec![Parameter::new("gene", [0.0, 65535.0])]
        }
        fn schema(&self) -> Schema {
            Schema::from_scalars(["gene"])
        }
        fn description(&self) -> Description {
            Description::default()
        }
    }

    impl Evaluator for Toy {
        fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome {
            let id = evaluation.id;
            assert!(!self.panics || (id.generation, id.individual) != (2, 3), "as planned");
            let gene = f64::from(evaluation.parameters[0]);
            if let Some(recorder) = recorder {
                recorder.scalars(&[gene]);
                recorder.tick(0.0);
            }
            let fitness = if gene % 2.0 == 1.0 { f64::INFINITY } else { gene };
            Outcome { terms: vec![fitness], steps: 1, ..Outcome::default() }
        }
    }

    fn scratch(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("farsa-run-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        path
    }

    fn pool(plan: &Plan<'_>, threads: usize) -> Pool {
        Pool::new(plan, threads, Wanted::ONE).unwrap()
    }

    fn finish(toy: Toy, directory: &Directory) -> Result<Summary, Error> {
        let plan = Plan::new(&toy, None, "")?;
        go_on(&plan, directory, pool(&plan, 2), &AtomicBool::new(false), "farsa", true)
    }

    #[test]
    fn a_panic_keeps_the_finished_generations() {
        let root = scratch("panic");
        let (careless, careful) = (Toy { version: 1, panics: true }, Toy { version: 1, panics: false });
        let directory = create(&Plan::new(&careless, None, "").unwrap(), &root.join("run")).unwrap();
        let error = finish(careless, &directory).unwrap_err();
        assert!(matches!(error, Error::Panicked { generation: 2 }) && error.exit_code() == 1, "{error}");
        finish(careful, &directory).unwrap();
        let whole = create(&Plan::new(&careful, None, "").unwrap(), &root.join("whole")).unwrap();
        finish(careful, &whole).unwrap();
        let log = fs::read_to_string(whole.log()).unwrap();
        assert_eq!(fs::read_to_string(directory.log()).unwrap(), log);
        assert!(!log.contains(",0\n"), "in every generation some fail: {log}");
        assert!(!log.contains("inf"), "{log}");
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn another_version_neither_resumes_nor_replays() {
        let root = scratch("version");
        let (old, new) = (Toy { version: 1, panics: false }, Toy { version: 2, panics: false });
        let directory = create(&Plan::new(&old, None, "").unwrap(), &root).unwrap();
        finish(old, &directory).unwrap();
        let said = |error: Error| {
            assert_eq!(error.exit_code(), 1);
            error.to_string()
        };
        let words = "made with version 1 of the values of toy, this program has version 2";
        let resumed = said(finish(new, &directory).unwrap_err());
        assert!(resumed.contains("checkpoint.bin: ") && resumed.contains(words), "{resumed}");
        let plan = Plan::new(&new, None, "").unwrap();
        let replayed = said(replay(&plan, &directory, Which::default(), &mut Vec::new()).unwrap_err());
        assert!(replayed.contains("record.bin: ") && replayed.contains(words), "{replayed}");
        // The champion's genes are what they are; that it may behave otherwise is worth a warning.
        let tested = test::test(&plan, &directory, 3, 1, 1, Wanted::ONE, true).unwrap().text();
        assert!(tested.contains("warning: ") && tested.contains(words), "{tested}");
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn a_stop_between_generations_keeps_all() {
        let root = scratch("stop");
        let toy = Toy { version: 1, panics: false };
        let mut plan = Plan::new(&toy, None, "").unwrap();
        let directory = create(&plan, &root).unwrap();
        let stopped = go_on(&plan, &directory, pool(&plan, 1), &AtomicBool::new(true), "farsa", true).unwrap_err();
        assert_eq!(stopped.exit_code(), 130);
        assert!(stopped.to_string().contains("`farsa run --resume "), "{stopped}");
        // Nobody is best yet.
        assert!(
            test::test(&plan, &directory, 1, 1, 1, Wanted::ONE, true)
                .unwrap_err()
                .to_string()
                .contains("no generation is finished")
        );
        assert!(replay(&plan, &directory, Which::default(), &mut Vec::new()).is_err());
        plan.settings.set("", GENERATIONS, Value::Whole(2)).unwrap();
        go_on(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap();
        assert_eq!(fs::read_to_string(directory.log()).unwrap().lines().count(), 3);
        fs::remove_dir_all(root).unwrap();
    }
}
