//! Places in the folder of the laboratory. No path leaves it, and no link is followed.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::live::lab::names::{Refusal, file_name, name};
use crate::run::laboratory::{FILE, is_file};

/// Folder of the server's own files.
const OWN: &str = ".lab";
/// Folders of runs, pages, exports and of everything that was removed.
pub(super) const RUNS: &str = "runs";
pub(super) const PAGES: &str = "pages";
pub(super) const EXPORTS: &str = "exports";
/// Folder of pages that are shown with the experiments.
pub(super) const GALLERY: &str = "gallery";
const TRASH: &str = ".trash";
/// Most entries of a folder that are listed.
const MAX_ENTRIES: usize = 20_000;

/// Folder of the laboratory.
#[derive(Debug, Clone)]
pub(super) struct Folder {
    path: PathBuf,
}

impl Folder {
    pub(super) fn new(path: PathBuf) -> Self {
        Self { path }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Creates the folder of the server's own files.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Usage`] for a link.
    pub(super) fn own_directory(&self) -> Result<PathBuf, Error> {
        self.made(&[OWN]).map_err(|refusal| Error::Usage(refusal.why))
    }

    /// Returns the path of a folder, or of a file in it, none of which is a link. It may not exist.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn place(&self, parts: &[&str]) -> Result<PathBuf, Refusal> {
        let mut path = self.path.clone();
        for part in parts {
            path.push(part);
            if fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_symlink()) {
                return Err(Refusal::new(403, format!("{} is a link, which is not followed", parts.join("/"))));
            }
        }
        Ok(path)
    }

    /// Creates the folders of a path.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn made(&self, parts: &[&str]) -> Result<PathBuf, Refusal> {
        let path = self.place(parts)?;
        let made = fs::create_dir_all(&path);
        made.map_err(|error| Refusal::new(500, format!("cannot make {}: {error}", parts.join("/"))))?;
        Ok(path)
    }

    /// Returns the directory of an existing run.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn run(&self, text: &str) -> Result<PathBuf, Refusal> {
        let path = self.place(&[RUNS, name(text)?])?;
        let config = self.place(&[RUNS, text, "config.toml"])?;
        if config.is_file() { Ok(path) } else { Err(Refusal::new(404, format!("there is no run {text:?}"))) }
    }

    /// Returns the path of an existing experiment file.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn experiment(&self, text: &str) -> Result<PathBuf, Refusal> {
        let path = self.place(&[file_name(text)?])?;
        if path.is_file() { Ok(path) } else { Err(Refusal::new(404, format!("there is no file {text:?}"))) }
    }

    /// Refuses a file that is a link as an experiment. A name without extension may be that of a file, too.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn no_link(&self, experiment: &str) -> Result<(), Refusal> {
        let file = if is_file(experiment) { experiment.to_owned() } else { format!("{experiment}{FILE}") };
        self.place(&[file_name(&file)?]).map(|_| ())
    }

    /// Lists the runs by their names.
    pub(super) fn runs(&self) -> Vec<String> {
        self.listed(&[RUNS], |path| path.join("config.toml").is_file())
    }

    /// Lists the TOML files by their names.
    pub(super) fn experiments(&self) -> Vec<String> {
        self.listed(&[], Path::is_file).into_iter().filter(|name| file_name(name).is_ok()).collect()
    }

    /// Lists the files in a folder by their names.
    pub(super) fn files(&self, folder: &str) -> Vec<String> {
        self.listed(&folder.split('/').collect::<Vec<_>>(), Path::is_file)
    }

    /// Lists the valid names in a folder, except links.
    fn listed(&self, parts: &[&str], is_listed: impl Fn(&Path) -> bool) -> Vec<String> {
        let Ok(entries) = self.place(parts).map(fs::read_dir) else { return Vec::new() };
        let entries = entries.into_iter().flatten().take(MAX_ENTRIES).flatten();
        let files = entries.filter(|entry| entry.file_type().is_ok_and(|kind| !kind.is_symlink()));
        let files = files.filter(|entry| is_listed(&entry.path()));
        let names = files.filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|text| name(text).is_ok()).collect();
        names.sort();
        names
    }

    /// Moves a run or a file to the trash, under an unused name, which is returned.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn discard(&self, path: &Path) -> Result<String, Refusal> {
        let failed = |error: io::Error| Refusal::new(500, format!("cannot move {}: {error}", path.display()));
        let trash = self.made(&[TRASH])?;
        let text = path.file_name().unwrap_or_default().to_string_lossy();
        let names = std::iter::once(text.to_string()).chain((2_u32..).map(|number| format!("{text}-{number}")));
        let mut unused = names.filter(|name| fs::symlink_metadata(trash.join(name)).is_err());
        let name = unused.next().unwrap_or_default();
        fs::rename(path, trash.join(&name)).map_err(failed)?;
        Ok(format!("{TRASH}/{name}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn links_are_neither_listed_nor_followed() {
        use std::os::unix::fs::symlink;
        let outside = tempfile::tempdir().unwrap();
        let home = tempfile::tempdir().unwrap();
        let folder = Folder::new(home.path().into());
        for run in [outside.path().join("r"), home.path().join("runs/a")] {
            fs::create_dir_all(&run).unwrap();
            fs::write(run.join("config.toml"), "seed = 1").unwrap();
        }
        fs::write(outside.path().join("x.toml"), "secret").unwrap();
        fs::write(home.path().join("y.toml"), "").unwrap();
        symlink(outside.path().join("r"), home.path().join("runs/b")).unwrap();
        symlink(outside.path().join("x.toml"), home.path().join("x.toml")).unwrap();
        assert_eq!((folder.runs(), folder.experiments()), (vec!["a".into()], vec!["y.toml".into()]));
        assert!(folder.run("a").is_ok());
        assert_eq!(folder.run("b").unwrap_err().status, 403);
        assert_eq!(folder.experiment("x.toml").unwrap_err().status, 403);
        assert_eq!(folder.run("../runs/a").unwrap_err().status, 400);
        fs::rename(home.path().join("runs"), home.path().join("moved")).unwrap();
        symlink(home.path().join("moved"), home.path().join("runs")).unwrap();
        assert_eq!((folder.runs(), folder.run("a").unwrap_err().status), (Vec::<String>::new(), 403));
    }

    #[test]
    fn the_trash_keeps_everything() {
        let home = tempfile::tempdir().unwrap();
        let folder = Folder::new(home.path().into());
        for expected in [".trash/a.toml", ".trash/a.toml-2", ".trash/a.toml-3"] {
            let path = home.path().join("a.toml");
            fs::write(&path, expected).unwrap();
            assert_eq!(folder.discard(&path).unwrap(), expected);
            assert_eq!(fs::read_to_string(home.path().join(expected)).unwrap(), expected);
        }
    }
}
