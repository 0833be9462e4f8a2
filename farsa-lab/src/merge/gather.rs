//! Distinct runs below directories.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::archive::Archive;
use crate::error::Error;
use crate::run::config_file::ConfigFile;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::store::directory::Directory;
use crate::store::identity::Identity;
use crate::store::log::Line;

/// Largest depth of runs below a named directory.
const DEEPEST: usize = 8;

/// A run below the directories.
pub(crate) struct Gathered<'e> {
    pub(crate) directory: Directory,
    /// Its path below the named directory.
    pub(crate) name: PathBuf,
    /// Its path for messages: that of the directory, or below an archive.
    pub(crate) place: PathBuf,
    pub(crate) plan: Plan<'e>,
    pub(crate) identity: Identity,
    /// Lines of the finished generations.
    pub(crate) lines: Vec<Line>,
    /// Number of generations in its configuration.
    pub(crate) asked: usize,
}

/// Distinct runs, in the order in which they were found, and the duplicates.
pub(crate) struct Gathering<'e> {
    pub(crate) runs: Vec<Gathered<'e>>,
    /// Skipped directory, and that of the same run with at least as many generations.
    pub(crate) twins: Vec<[PathBuf; 2]>,
    /// Runs of archives, removed with this value.
    unpacked: Vec<TempDir>,
}

impl<'e> Gathered<'e> {
    /// Reads a run, up to the last checkpoint if it is in progress.
    ///
    /// # Errors
    /// The errors of [`Plan::from_file`], [`Checkpoint::read`] and [`RunRecord::read`].
    pub(crate) fn read(laboratory: &Laboratory<'e>, directory: Directory, name: PathBuf) -> Result<Self, Error> {
        let plan = Plan::from_file(laboratory, &ConfigFile::read_regular(&directory.config())?)?;
        let RunRecord { identity, lines, .. } =
            RunRecord::read(&plan, &directory, &Checkpoint::read(&plan, &directory)?)?;
        let asked = plan.generations()? as usize;
        let place = directory.path().to_path_buf();
        Ok(Self { directory, name, place, plan, identity, lines, asked })
    }

    pub(crate) fn is_finished(&self) -> bool {
        self.lines.len() >= self.asked
    }

    /// Returns true for a run from an archive.
    pub(crate) fn is_archived(&self) -> bool {
        self.place != self.directory.path()
    }

    /// Finds the first generation in which two runs of one configuration and seed differ. They never should.
    fn differs_from(&self, other: &Self) -> Option<usize> {
        self.lines.iter().zip(&other.lines).position(|(a, b)| a != b)
    }
}

impl<'e> Gathering<'e> {
    /// Finds and reads the runs in and below directories, and in archives.
    ///
    /// # Errors
    /// [`Error::File`] for a directory without a run, [`Error::Other`] for runs of one experiment with other versions of the
    /// values, and for one run with two results. Also the errors of [`Gathered::read`].
    pub(crate) fn new(laboratory: &Laboratory<'e>, roots: &[PathBuf]) -> Result<Self, Error> {
        let mut gathering = Self { runs: Vec::new(), twins: Vec::new(), unpacked: Vec::new() };
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        let mut seen: Vec<PathBuf> = Vec::new();
        for root in roots {
            let real = fs::canonicalize(root).map_err(|error| Error::io("read", root)(error).into_usage())?;
            if seen.contains(&real) {
                return Err(Error::Usage(format!("{}: is named twice", root.display())));
            }
            seen.push(real);
            if root.is_file() {
                gathering.add_archive(laboratory, root, &mut known)?;
                continue;
            }
            let mut found = Vec::new();
            find(root, Path::new(""), 0, &mut found)?;
            if found.is_empty() {
                return Err(Error::no_run(root, "holds no run, nor does a folder in it"));
            }
            for (directory, name) in found {
                gathering.add(Gathered::read(laboratory, directory, name)?, &mut known)?;
            }
        }
        for (index, run) in gathering.runs.iter().enumerate() {
            let same = |other: &&Gathered<'_>| other.identity.experiment == run.identity.experiment;
            gathering.runs.iter().take(index).find(same).map_or(Ok(()), |first| same_version(first, run))?;
        }
        Ok(gathering)
    }

    /// Adds the runs of an archive.
    fn add_archive(
        &mut self,
        laboratory: &Laboratory<'e>,
        path: &Path,
        known: &mut BTreeMap<String, usize>,
    ) -> Result<(), Error> {
        let archive = Archive::read(path)?;
        let folder = tempfile::tempdir().map_err(|error| Error::io("make", &std::env::temp_dir())(error))?;
        archive.unpack(folder.path())?;
        for name in archive.runs.keys() {
            let directory = Directory::open(&folder.path().join(name))?;
            let run = Gathered::read(laboratory, directory, name.into())?;
            self.add(Gathered { place: path.join(name), ..run }, known)?;
        }
        self.unpacked.push(folder);
        Ok(())
    }

    /// Adds a run, or skips the shorter of two equal runs. `known` has the places of the added runs.
    fn add(&mut self, run: Gathered<'e>, known: &mut BTreeMap<String, usize>) -> Result<(), Error> {
        // Runs differ by their settings and by the content of files, not by their length.
        let Identity { experiment, condition, seed, settings, .. } = &run.identity;
        let key = format!("{experiment:?} {condition:?} {seed} {settings:?}");
        let Some(first) = known.get(&key).and_then(|index| self.runs.get_mut(*index)) else {
            known.insert(key, self.runs.len());
            self.runs.push(run);
            return Ok(());
        };
        same_version(first, &run)?;
        let path = |run: &Gathered<'_>| run.place.clone();
        if let Some(generation) = first.differs_from(&run) {
            let [first, second] = [path(first), path(&run)];
            return Err(Error::Other(format!(
                "{} and {} have one configuration and seed, and other results from generation {generation} on: one of \
                 them was changed",
                first.display(),
                second.display()
            )));
        }
        let left = if run.lines.len() > first.lines.len() { std::mem::replace(first, run) } else { run };
        let kept = path(first);
        self.twins.push([path(&left), kept]);
        Ok(())
    }
}

/// Refuses runs of one experiment with other versions of the values.
pub(crate) fn same_version(first: &Gathered<'_>, second: &Gathered<'_>) -> Result<(), Error> {
    let versions = |run: &Gathered<'_>| [run.identity.values_version, run.identity.experiment_version];
    let [a, b] = [versions(first), versions(second)];
    if a == b {
        return Ok(());
    }
    let paths = [first, second].map(|run| run.place.display());
    let (what, a, b) = if a[0] == b[0] {
        (format!("the values of {}", first.identity.experiment), a[1], b[1])
    } else {
        ("FARSA's values".to_owned(), a[0], b[0])
    };
    Err(Error::Other(format!(
        "{} was made with version {a} of {what}, {} with version {b}: their numbers do not compare",
        paths[0], paths[1]
    )))
}

/// Returns the runs in and below a directory, sorted by name. Hidden folders, links and the content of runs are skipped.
fn find(path: &Path, name: &Path, depth: usize, found: &mut Vec<(Directory, PathBuf)>) -> Result<(), Error> {
    if let Ok(directory) = Directory::open(path) {
        let own = || path.canonicalize().ok().and_then(|path| path.file_name().map(PathBuf::from)).unwrap_or_default();
        found.push((directory, if depth == 0 { own() } else { name.into() }));
        return Ok(());
    }
    if depth == DEEPEST {
        return Ok(());
    }
    let read = || fs::read_dir(path)?.collect::<Result<Vec<_>, _>>();
    let mut folders: Vec<_> = read().map_err(Error::io("read", path))?;
    folders.retain(|entry| {
        let visible = !entry.file_name().to_string_lossy().starts_with('.');
        visible && entry.file_type().is_ok_and(|kind| kind.is_dir())
    });
    folders.sort_by_key(fs::DirEntry::file_name);
    folders.iter().try_for_each(|entry| find(&entry.path(), &name.join(entry.file_name()), depth + 1, found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::experiment::Experiment;
    use std::sync::atomic::AtomicBool;

    use farsa_body::Recorder;
    use farsa_view::Schema;

    use crate::experiment::evaluator::{Evaluation, Evaluator, Task, TaskInfo};
    use crate::experiment::lanes::LaneRequest;
    use crate::experiment::outcome::Outcome;
    use crate::experiment::parameter::Parameter;
    use crate::experiment::settings::{Setting, Settings};
    use crate::run::pool::Pool;
    use crate::run::{begin, evolve};
    use crate::strategy::settings::{GENERATIONS, POPULATION};

    /// Its fitness is the gene, with a bonus from a fault that no version reports.
    #[derive(Clone, Copy)]
    struct Toy {
        version: u32,
        bonus: f64,
    }

    impl Experiment for Toy {
        fn name(&self) -> &'static str {
            "toy"
        }
        fn summary(&self) -> &'static str {
            "earns its gene"
        }
        fn values_version(&self) -> u32 {
            self.version
        }
        fn settings(&self, _: &str) -> Vec<Setting> {
            vec![Setting::whole(GENERATIONS, 3, 1..=100), Setting::whole(POPULATION, 20, 1..=100)]
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
        fn evaluate(&mut self, evaluation: Evaluation<'_>, _: Option<&mut dyn Recorder>) -> Outcome {
            // The fault begins with the second generation.
            let bonus = if evaluation.id.generation > 0 { self.bonus } else { 0.0 };
            Outcome { terms: vec![f64::from(evaluation.parameters[0]) + bonus], steps: 1, ..Outcome::default() }
        }
    }

    fn run(toy: Toy, path: &Path) {
        let plan = Plan::new(&toy, None, "").unwrap();
        let directory = begin::create(&plan, path).unwrap();
        let pool = Pool::new(&plan, 1, LaneRequest::ONE).unwrap();
        evolve::continue_run(&plan, &directory, pool, &AtomicBool::new(false), "farsa", true).unwrap();
    }

    #[test]
    fn other_versions_and_other_results_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let plain = Toy { version: 1, bonus: 0.0 };
        run(plain, &at("a/toy-1"));
        run(Toy { version: 2, ..plain }, &at("b/toy-1"));
        run(Toy { bonus: 0.5, ..plain }, &at("c/toy-1"));
        run(plain, &at("d/deep/down/toy-1"));
        let gather = |names: [&str; 2]| {
            let laboratory = Laboratory::new(&[&plain]);
            let found = Gathering::new(&laboratory, &names.map(at)).map_err(|error| error.to_string());
            found.map(|found| (found.runs.len(), found.twins.len()))
        };
        let [a, b, c] = ["a", "b", "c"].map(|name| at(name).join("toy-1").display().to_string());
        assert_eq!(
            gather(["a", "b"]).unwrap_err(),
            format!(
                "{a} was made with version 1 of the values of toy, {b} with version 2: their numbers do not compare"
            )
        );
        assert_eq!(
            gather(["a", "c"]).unwrap_err(),
            format!(
                "{a} and {c} have one configuration and seed, and other results from generation 1 on: one of them was changed"
            )
        );
        assert_eq!(gather(["a", "d"]).unwrap(), (1, 1));
    }
}
