//! A directory for what reads files.

use std::fs;
use std::path::{Path, PathBuf};

/// A directory of this process among the system's temporary files. `./ci` puts those into memory and removes them.
pub struct Scratch(PathBuf);

impl Scratch {
    /// Makes one.
    ///
    /// # Panics
    /// When there is no room.
    pub fn new() -> Self {
        let path = std::env::temp_dir().join(format!("farsa-fuzz-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a directory");
        Self(path)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Puts a file into it.
    ///
    /// # Panics
    /// When there is no room.
    pub fn put(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        fs::write(&path, content).expect("a file");
        path
    }

    /// Reads a file.
    ///
    /// # Panics
    /// When it is gone.
    pub fn get(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).expect("a file")
    }
}

impl Default for Scratch {
    fn default() -> Self {
        Self::new()
    }
}
