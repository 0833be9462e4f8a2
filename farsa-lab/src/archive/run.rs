//! Files of a run in an archive. Files that the record and the configuration determine are left out.

use std::fs;
use std::path::Path;

use crate::archive::packed::Files;
use crate::error::Error;
use crate::experiment::lanes::LaneRequest;
use crate::run::begin::resumed;
use crate::run::evolve;
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::run::record_file::RunRecord;
use crate::run::records::Checkpoint;
use crate::store::append_log::{self, Mark};
use crate::store::bounded::read_regular;
use crate::store::checksummed;
use crate::store::directory::Directory;
use crate::store::replace::replace;

/// Bytes of the largest file that is packed.
const MAX_BYTES: u64 = 1 << 30;

/// Returns the files from which [`restore`] makes a run, or `None` for an unfinished run.
///
/// # Errors
/// The errors of [`Checkpoint::read`] and [`RunRecord::read`], and [`Error::Io`].
pub(crate) fn pack(plan: &Plan<'_>, directory: &Directory) -> Result<Option<Files>, Error> {
    let checkpoint = Checkpoint::read(plan, directory)?;
    let content = RunRecord::content(plan, directory, &checkpoint)?;
    let RunRecord { record, .. } = RunRecord::from_content(plan, directory, &checkpoint, content.clone())?;
    if checkpoint.generation < plan.generations()? {
        return Ok(None);
    }
    let mut files = Files::new();
    let mut add = |path: &Path, bytes: Vec<u8>| {
        let name = path.strip_prefix(directory.path()).unwrap_or(path);
        let parts: Vec<_> = name.iter().map(|part| part.to_string_lossy()).collect();
        files.insert(parts.join("/"), bytes);
    };
    add(&directory.record(), content);
    if !checkpoint.failures.is_empty() {
        let path = directory.failures();
        add(&path, append_log::read(&path, checkpoint.failures, MAX_BYTES)?);
    }
    // The lineage is rebuilt from the record, and so is the state of the strategy, unless the record has genomes alone.
    let mut checkpoint = Checkpoint { lineage: Mark::default(), ..checkpoint };
    let state = checkpoint.state.take();
    if resumed(plan, directory, &checkpoint, &record).is_err() {
        checkpoint.state = state;
    }
    let path = directory.checkpoint();
    add(&path, checksummed::to_bytes(&path, &checkpoint)?);
    for path in [directory.config(), directory.manifest(), directory.champion()] {
        add(&path, read_regular(&path, MAX_BYTES)?);
    }
    for (path, is_folder) in entries(directory.path())? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if is_folder && name.starts_with("protocols") {
            let own = entries(&path)?.into_iter().filter(|(path, is_folder)| !is_folder && is_table(path));
            own.into_iter().try_for_each(|(path, _)| read_regular(&path, MAX_BYTES).map(|bytes| add(&path, bytes)))?;
        } else if !is_folder && name.starts_with("test") && is_table(&path) {
            add(&path, read_regular(&path, MAX_BYTES)?);
        }
    }
    Ok(Some(files))
}

/// Checks for a table of a test or its description.
fn is_table(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "csv" || extension == "json")
}

/// Lists the visible entries of a folder, with true for folders.
fn entries(path: &Path) -> Result<Vec<(std::path::PathBuf, bool)>, Error> {
    let read = || fs::read_dir(path)?.collect::<Result<Vec<_>, _>>();
    let entries = read().map_err(Error::io("read", path))?.into_iter();
    let visible = entries.filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'));
    Ok(visible.map(|entry| (entry.path(), entry.file_type().is_ok_and(|kind| kind.is_dir()))).collect())
}

/// Makes the files that were left out. A run of other values stays as it is, because this program cannot continue it.
///
/// # Errors
/// The errors of [`evolve::rebuild`].
pub(crate) fn restore(plan: &Plan<'_>, directory: &Directory) -> Result<(), Error> {
    let path = directory.checkpoint();
    if Checkpoint::read(plan, directory)?.identity.same_values(&plan.identity()?, &path).is_err() {
        return Ok(());
    }
    let manifest = read_regular(&directory.manifest(), MAX_BYTES)?;
    evolve::rebuild(plan, directory, &Pool::new(plan, 1, LaneRequest::ONE)?)?;
    // Without a session of this process.
    replace(&directory.manifest(), &manifest)
}
