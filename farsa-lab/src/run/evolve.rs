//! Loop over the generations of a run, with a checkpoint from time to time.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use farsa_evo::RecordWriter;

use crate::error::Error;
use crate::figures::log_curves::LogCurves;
use crate::run::begin::search_state;
use crate::run::catch_panic::catch_panic;
use crate::run::collection::CollectionTable;
use crate::run::coordinator::{barrier, coordinate, facts, run_command};
use crate::run::evaluation_backend::Unfinished;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::progress::{Progress, ProgressOptions};
use crate::run::record_file::RunRecord;
use crate::run::records::{Champions, Checkpoint, evolved};
use crate::run::recover::{RunFiles, recover};
use crate::run::search_state::{GenerationResult, SearchState};
use crate::run::summary::{Summary, Winner};
use crate::shell::{quoted, resume_command};
use crate::store::append_log::Mark;
use crate::store::directory::Directory;
use crate::store::failures::FailedEvaluation;
use crate::store::identity::Identity;
use crate::store::lineage::{Lineage, rows};
use crate::store::lock::Lock;
use crate::store::log::Line;
use crate::store::manifest::{Manifest, Session};
use crate::store::replace::replace;

/// Time between two checkpoints. After every short generation a checkpoint would cost more than the generation.
const UNSAVED: Duration = Duration::from_secs(1);

/// Evolves the run in a directory up to its last generation and returns a summary.
///
/// # Errors
/// [`Error::Interrupted`] after `stop` became true. All finished generations are saved.
pub(crate) fn continue_run(
    plan: &Plan<'_>,
    directory: &Directory,
    pool: Pool<'_>,
    stop: &AtomicBool,
    program: &str,
    quiet: bool,
) -> Result<Summary, Error> {
    evolved(directory)?;
    // Another process may write the files until the lock is held.
    let lock = Lock::of_run(directory.path())?;
    let options = ProgressOptions { quiet, study: None };
    continue_locked(&lock, plan, directory, pool, stop, program, options)
}

/// Evolves a run whose lock is already held.
///
/// # Errors
/// As [`continue_run`].
pub(crate) fn continue_locked(
    _lock: &Lock,
    plan: &Plan<'_>,
    directory: &Directory,
    mut pool: Pool<'_>,
    stop: &AtomicBool,
    program: &str,
    options: ProgressOptions,
) -> Result<Summary, Error> {
    let path = directory.checkpoint();
    let checkpoint = Checkpoint::read(plan, directory)?;
    checkpoint.identity.same_values(&plan.identity()?, &path)?;
    let (done, last) = (checkpoint.generation, plan.generations()?);
    if last < done {
        return Err(Error::Usage(format!("{}: has finished {done} generations already", directory.path().display())));
    }
    let (command, facts) = (run_command(plan, directory, &pool, &checkpoint)?, facts(plan)?);
    let mut run = Run::resume(plan, directory, checkpoint, &pool, program)?;
    let individuals =
        |generations: u32| u64::from(generations).saturating_mul(run.search_state.search.individuals() as u64);
    let progress = Progress::of_run([done, last].map(individuals), last, options);
    if let Some(kept) = &run.files.changed_log {
        let (log, kept) = (directory.log(), kept.display());
        progress.note(&format!(
            "{}: had been changed: the changed file is now {kept}, and the log is written again",
            log.display()
        ));
    }
    coordinate(&mut pool, command, facts, |pool| {
        let ended = run.evolve(last, pool, stop, &progress);
        if let Some(total) = run.failures_note() {
            progress.note(&total);
        }
        ended
    })?;
    drop(progress);
    Ok(run.summary())
}

/// Writes the files of a run that its record determines, in a directory that its creator has locked.
///
/// # Errors
/// As [`continue_run`].
pub(crate) fn rebuild(plan: &Plan<'_>, directory: &Directory, pool: &Pool<'_>) -> Result<(), Error> {
    let checkpoint = Checkpoint::read(plan, directory)?;
    Run::resume(plan, directory, checkpoint, pool, "")?.save()
}

/// A run in progress.
struct Run<'d> {
    directory: &'d Directory,
    /// Name of this program.
    program: &'d str,
    title: String,
    /// Names of the populations.
    names: Vec<String>,
    /// Combination of the trials into the fitness.
    combined: String,
    identity: Identity,
    search_state: SearchState,
    record: RecordWriter,
    files: RunFiles,
    /// Curves of `fitness.svg`.
    curves: LogCurves,
    /// Number of evaluations that failed in this process, and the first of them.
    failed: (u64, Option<FailedEvaluation>),
    /// Number of failed evaluations in all finished generations.
    failures: u64,
    /// `None` for a strategy without an archive or front.
    collection: Option<CollectionTable>,
    manifest: Manifest,
    /// Champions, from the first generation of this process. If they are the best of all generations, from the start.
    champions: Option<Champions>,
    started: Instant,
}

impl<'d> Run<'d> {
    /// Resumes the run in a directory from its checkpoint. Everything that can be refused is read before anything is written.
    fn resume(
        plan: &Plan<'_>,
        directory: &'d Directory,
        checkpoint: Checkpoint,
        pool: &Pool<'_>,
        program: &'d str,
    ) -> Result<Self, Error> {
        let mut run_record = RunRecord::read(plan, directory, &checkpoint)?;
        let search_state = search_state(plan, directory, &checkpoint, &run_record, pool.genotype())?;
        let search = &search_state.search;
        let mut manifest = Manifest::read_or_new(&directory.manifest(), &checkpoint.identity)?;
        manifest.sessions.push(Session::new(pool.threads(), pool.lanes().info(), search.generation()));
        let files = recover(plan, directory, &checkpoint, &mut run_record, search)?;
        let best_ever = run_record.keeps_champion && run_record.champion().is_some();
        let champions = if best_ever { Some(Champions::read(plan, directory)?) } else { None };
        Ok(Self {
            directory,
            program,
            title: plan.name(),
            names: pool.info().populations.clone(),
            combined: pool.info().combined(),
            identity: checkpoint.identity,
            collection: CollectionTable::new(search, pool.evaluator()),
            curves: LogCurves::from_lines(&run_record.lines, run_record.record.populations()),
            record: run_record.record.writer(),
            search_state,
            files,
            failed: (0, None),
            failures: run_record.failed(),
            manifest,
            champions,
            started: Instant::now(),
        })
    }

    /// Evolves up to a generation and saves from time to time and at the end.
    fn evolve(&mut self, last: u32, pool: &mut Pool<'_>, stop: &AtomicBool, progress: &Progress) -> Result<(), Error> {
        let mut saved = Instant::now();
        let mut ended = Ok(());
        while self.search_state.search.generation() < last {
            let generation = self.search_state.search.generation();
            if let Err(full) = self.files.record.check_space() {
                let why = format!("{full}; the run ends after {generation} generations, which are kept");
                ended = Err(Error::Other(why));
                break;
            }
            // Panics of trials are caught in the pool. A panic here is one of the strategy, whose state is then lost.
            let result = catch_panic(|| barrier(pool, stop).and_then(|()| self.generation(pool, stop, progress)));
            match result.map_err(|why| Error::strategy_panicked(generation, &why))? {
                Ok(()) => {}
                Err(Unfinished::Error(error)) => return Err(error),
                Err(Unfinished::Stopped) => {
                    let resume = resume_command(self.program, self.directory.path());
                    ended = Err(Error::Interrupted { resume });
                    break;
                }
            }
            if saved.elapsed() >= UNSAVED {
                self.save()?;
                saved = Instant::now();
            }
        }
        self.save()?;
        ended
    }

    /// Evaluates a generation and appends it to all files.
    fn generation(&mut self, pool: &mut Pool<'_>, stop: &AtomicBool, progress: &Progress) -> Result<(), Unfinished> {
        let generation = self.search_state.search.generation();
        let GenerationResult { fitness, failed, statistics, each, best, normalisation, .. } =
            self.search_state.generation(&mut pool.until(stop), &|| progress.advance(), |search, judgements| {
                search.tell(&mut self.record, judgements)
            })?;
        let search = &self.search_state.search;
        let line = Line::new(&statistics, fitness.len(), &each);
        self.files.record.append(&self.record, &line, search, self.search_state.observed.as_ref())?;
        self.files.log.append(&line)?;
        self.curves.push(&line);
        self.failures = self.failures.saturating_add(line.failed);
        self.files.failures.append(&failed, self.program)?;
        self.files.diagnostics.append(search)?;
        if let Some(lineage) = &mut self.files.lineage {
            lineage.append(&rows(search))?;
        }
        let latest = Champions { identity: self.identity.clone(), generation, best, normalisation };
        let keeps = search.champion_is_best_ever();
        self.champions = Some(match self.champions.take() {
            Some(best) if keeps && latest.fitness() <= best.fitness() => best,
            _ => latest,
        });
        if let Some(session) = self.manifest.sessions.last_mut() {
            session.generations += 1;
            session.evaluations += fitness.len() as u64;
        }
        let each: Vec<_> = self.names.iter().map(String::as_str).zip(&each).collect();
        let total = [("", &statistics)];
        progress.generation(generation, if each.is_empty() { &total } else { &each });
        self.report_failures(failed, progress);
        Ok(())
    }

    /// Prints the first evaluation that failed and counts the others.
    fn report_failures(&mut self, failed: Vec<FailedEvaluation>, progress: &Progress) {
        self.failed.0 += failed.len() as u64;
        if let (None, Some(first)) = (&self.failed.1, failed.into_iter().next()) {
            let FailedEvaluation { generation, individual, why, .. } = &first;
            let command = first.command(self.program, &quoted(&self.directory.path().to_string_lossy()));
            progress.note(&format!("generation {generation}: individual {individual} failed: {why}; see `{command}`"));
            self.failed.1 = Some(first);
        }
    }

    /// A line with the number of failed evaluations, if there are any.
    fn failures_note(&self) -> Option<String> {
        let (count, path) = (self.failed.0, self.directory.failures());
        (count > 0).then(|| format!("{count} evaluations failed: {}", path.display()))
    }

    /// Saves everything. The checkpoint has marks of the other files, so it is written after them.
    fn save(&mut self) -> Result<(), Error> {
        let (directory, identity) = (self.directory, &self.identity);
        self.files.log.sync()?;
        let record = self.files.record.sync()?;
        let lineage = self.files.lineage.as_mut().map_or(Ok(Mark::default()), Lineage::sync)?;
        let failures = self.files.failures.sync()?;
        if let Some(champions) = &self.champions {
            champions.write(&directory.champion())?;
        }
        self.files.diagnostics.save(&self.title)?;
        if let Some(collection) = &self.collection {
            collection.write(&self.search_state.search, directory, &self.title)?;
        }
        let generation = self.search_state.search.generation();
        let state = self.search_state.search.snapshot().map(|strategy| strategy.save());
        Checkpoint { identity: identity.clone(), generation, record, lineage, failures, state }
            .write(&directory.checkpoint())?;
        if let Some(session) = self.manifest.sessions.last_mut() {
            session.seconds = self.started.elapsed().as_secs_f64();
        }
        self.manifest.write(&directory.manifest())?;
        replace(&directory.plot(), self.curves.draw(&self.title, &self.names).as_bytes())
    }

    fn summary(&self) -> Summary {
        let Identity { experiment, condition, seed, .. } = self.identity.clone();
        let session = self.manifest.sessions.last();
        let champions: Vec<Winner> =
            self.champions.iter().flat_map(|all| Winner::from_champions(all, &self.names)).collect();
        Summary {
            directory: self.directory.path().into(),
            experiment,
            condition,
            seed,
            generations: self.search_state.search.generation(),
            evaluations: session.map_or(0, |session| session.evaluations),
            failed: self.failures,
            test: None,
            combined: self.combined.clone(),
            seconds: session.map_or(0.0, |session| session.seconds),
            champion: champions.first().cloned(),
            champions: if champions.len() > 1 { champions } else { Vec::new() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::replay::{Selection, TrialSelector, replay};
    use crate::evaluation::test;
    use crate::experiment::evaluator::{Evaluation, Evaluator, Task, TaskInfo};
    use crate::experiment::lanes::LaneRequest;
    use crate::experiment::outcome::Outcome;
    use crate::experiment::parameter::Parameter;
    use crate::experiment::settings::{Setting, Settings, Value};
    use crate::run::begin::create;
    use crate::run::experiment::Experiment;
    use crate::run::queue::Work;
    use crate::store::directory::Directory;
    use crate::strategy::settings::{GENERATIONS, POPULATION};
    use farsa_body::Recorder;
    use farsa_view::Schema;
    use std::fs;
    use std::path::PathBuf;

    /// Its fitness is the first gene. It fails for odd genes and can panic in one trial.
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
        fn info(&self) -> TaskInfo {
            TaskInfo::new(vec![Parameter::new("gene", [0.0, 65535.0])], Schema::from_scalars(["gene"]))
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

    fn pool<'e>(plan: &Plan<'e>, threads: usize) -> Pool<'e> {
        Pool::new(plan, threads, LaneRequest::ONE).unwrap()
    }

    fn finish(toy: Toy, directory: &Directory) -> Result<Summary, Error> {
        let plan = Plan::new(&toy, None, "")?;
        continue_run(&plan, directory, pool(&plan, 2), &AtomicBool::new(false), "farsa", true)
    }

    #[test]
    fn a_panic_is_a_failed_evaluation() {
        let root = scratch("panic");
        let careless = Toy { version: 1, panics: true };
        let plan = Plan::new(&careless, None, "").unwrap();
        let directory = create(&plan, &root.join("run")).unwrap();
        let summary = finish(careless, &directory).unwrap();
        let log = fs::read_to_string(directory.log()).unwrap();
        assert_eq!(log.lines().count(), 5);
        assert!(!log.contains("inf"), "{log}");
        let failures = fs::read_to_string(directory.failures()).unwrap();
        let panicked: Vec<&str> = failures.lines().filter(|line| line.contains("panicked")).collect();
        let [line] = panicked.as_slice() else { panic!("{failures}") };
        assert!(line.starts_with("2,3,0,\"panicked: as planned (") && line.contains("evolve.rs:"), "{line}");
        assert!(line.ends_with(",\"farsa replay . --generation 2 --individual 3 --trial 0\""), "{line}");
        // The log counts each failure once.
        let counted: u64 =
            log.lines().skip(1).map(|line| line.split(',').nth(5).unwrap().parse::<u64>().unwrap()).sum();
        assert_eq!([failures.lines().count() as u64 - 1, summary.failed], [counted; 2]);
        // Remarks by the user and a removed file change no number.
        fs::write(directory.failures(), failures + "mine\n").unwrap();
        assert_eq!(finish(careless, &directory).unwrap().failed, counted);
        fs::remove_file(directory.failures()).unwrap();
        let Work::Done(summary) = Work::of_run(&plan, directory.path()).unwrap() else { panic!("a finished run") };
        assert_eq!(summary.failed, counted);
        let which = Selection { generation: Some(2), individual: Some(3), trial: TrialSelector::Number(0) };
        let error = replay(&plan, &directory, which, None, || Ok(Vec::new())).unwrap_err();
        assert_eq!(error.to_string(), "trial 0 of individual 3 of generation 2 panicked");
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn another_version_neither_resumes_nor_replays() {
        let root = scratch("version");
        let (old, new) = (Toy { version: 1, panics: false }, Toy { version: 2, panics: false });
        let directory = create(&Plan::new(&old, None, "").unwrap(), &root).unwrap();
        finish(old, &directory).unwrap();
        let message = |error: Error| {
            assert_eq!(error.exit_code(), 1);
            error.to_string()
        };
        let words = "made with version 1 of the values of toy, this program has version 2";
        let resumed = message(finish(new, &directory).unwrap_err());
        assert!(resumed.contains("checkpoint.bin: ") && resumed.contains(words), "{resumed}");
        let plan = Plan::new(&new, None, "").unwrap();
        let replayed = message(replay(&plan, &directory, Selection::default(), None, || Ok(Vec::new())).unwrap_err());
        assert!(replayed.contains("record.bin: ") && replayed.contains(words), "{replayed}");
        // The champion's genes are valid, but its behavior may differ, so there is a warning.
        let tested = test::test(&plan, &directory, None, 3, 1, 1, LaneRequest::ONE, true).unwrap().text(false);
        assert!(tested.contains("warning: ") && tested.contains(words), "{tested}");
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn a_stop_between_generations_keeps_all() {
        let root = scratch("stop");
        let toy = Toy { version: 1, panics: false };
        let mut plan = Plan::new(&toy, None, "").unwrap();
        let directory = create(&plan, &root).unwrap();
        let stopped =
            continue_run(&plan, &directory, pool(&plan, 1), &AtomicBool::new(true), "farsa", true).unwrap_err();
        assert_eq!(stopped.exit_code(), 130);
        assert!(stopped.to_string().contains("`farsa run --resume "), "{stopped}");
        // No champion exists yet.
        assert!(
            test::test(&plan, &directory, None, 1, 1, 1, LaneRequest::ONE, true)
                .unwrap_err()
                .to_string()
                .contains("no generation is finished")
        );
        let replayed = replay(&plan, &directory, Selection::default(), None, || Ok(Vec::new())).unwrap_err();
        assert!(replayed.to_string().contains("record.bin: no generation is finished"), "{replayed}");
        plan.settings.set("", GENERATIONS, Value::Whole(2)).unwrap();
        continue_run(&plan, &directory, pool(&plan, 1), &AtomicBool::new(false), "farsa", true).unwrap();
        assert_eq!(fs::read_to_string(directory.log()).unwrap().lines().count(), 3);
        fs::remove_dir_all(root).unwrap();
    }
}
