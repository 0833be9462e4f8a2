//! Marks by which a run is recognized, although its files grow.

use std::fs::{self, Metadata};
use std::path::Path;
use std::time::SystemTime;

use farsa_num::Digest;

use crate::error::Error;
use crate::live::session::json;
use crate::store::directory::Directory;
use crate::store::identity::Identity;

/// Version of a file. Replacing the file by another one changes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::live) struct FileMark {
    place: Place,
    size: u64,
    modified: Option<SystemTime>,
}

/// Identity of a file or directory, which its content does not change.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Place {
    /// Device and number, where the system has them.
    number: Option<[u64; 2]>,
    created: Option<SystemTime>,
}

/// Marks of a run's directory and configuration. Generations do not change them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::live) struct RunMark {
    directory: Place,
    config: FileMark,
}

impl Place {
    fn of(metadata: &Metadata) -> Self {
        #[cfg(unix)]
        let number = {
            use std::os::unix::fs::MetadataExt as _;
            Some([metadata.dev(), metadata.ino()])
        };
        #[cfg(not(unix))]
        let number = None;
        Self { number, created: metadata.created().ok() }
    }
}

impl FileMark {
    /// Reads the mark of a file, if it exists.
    pub(in crate::live) fn read(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        Some(Self { place: Place::of(&metadata), size: metadata.len(), modified: metadata.modified().ok() })
    }
}

impl RunMark {
    /// Reads the marks of a directory, if it holds a run.
    pub(in crate::live) fn read(directory: &Directory) -> Option<Self> {
        let place = Place::of(&fs::metadata(directory.path()).ok()?);
        Some(Self { directory: place, config: FileMark::read(&directory.config())? })
    }

    /// Computes the name of a run in a page: equal for the same run in the same directory, also when it was extended.
    ///
    /// # Errors
    /// [`Error::Other`] for an identity that has no JSON.
    pub(in crate::live) fn name(&self, identity: &Identity) -> Result<String, Error> {
        let mut digest = Digest::new();
        digest.add_bytes(format!("{:?}", self.directory).as_bytes());
        digest.add_bytes(json(identity)?.as_bytes());
        Ok(format!("{:016x}", digest.finish()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generations_keep_the_mark_and_another_directory_changes_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r");
        let directory = Directory::at(path.clone());
        assert_eq!(RunMark::read(&directory), None);
        let create = || {
            fs::create_dir(&path).unwrap();
            fs::write(directory.config(), "seed = 1").unwrap();
        };
        create();
        let first = RunMark::read(&directory).unwrap();
        fs::write(directory.log(), "generation\n").unwrap();
        assert_eq!(RunMark::read(&directory).unwrap(), first);
        fs::rename(&path, folder.path().join("aside")).unwrap();
        assert_eq!(RunMark::read(&directory), None);
        create();
        assert_ne!(RunMark::read(&directory).unwrap(), first);
        fs::write(directory.config(), "seed = 22").unwrap();
        let other = RunMark::read(&directory).unwrap();
        assert_eq!(
            (&other.directory, other.config == first.config),
            (&RunMark::read(&directory).unwrap().directory, false)
        );
    }
}
