//! Deliberate changes of another version, and refusals that name them.

use std::fs;
use std::path::Path;

use farsa_lab::advanced::VALUES_VERSION;

use crate::TEST;
use crate::place::{Place, content, end, today};

/// A deliberate change of a later version.
#[derive(Debug)]
pub(crate) enum Change {
    Manifest,
    Format,
    Values,
}

/// Why a run of another version is not what it was.
#[derive(Debug)]
pub(crate) struct Refusal {
    pub(crate) words: String,
    pub(crate) of: Change,
}

/// The format version in the head of a `.bin`.
pub(crate) fn format_number(path: &Path) -> u32 {
    let bytes = fs::read(path).expect("a file");
    u32::from_le_bytes(bytes[8..12].try_into().expect("four bytes"))
}

impl Place {
    /// The refusal of the copy by this program with its words, or nothing if it reads the same formats and has the same values.
    pub(crate) fn refused(&self) -> Option<Refusal> {
        let (then, now) = (self.manifest("run"), today().manifest("run"));
        if then["format"] != now["format"] {
            let words = format!("has format {}, this program reads format {}", then["format"], now["format"]);
            return Some(Refusal { words, of: Change::Manifest });
        }
        let format = format_number(&today().0.join("run/checkpoint.bin"));
        for file in content(&self.0.join("run")).keys().filter(|file| end(file) == "bin") {
            let then = format_number(&self.0.join("run").join(file));
            if then != format {
                let words = format!("has format version {then}, this program reads version {format}");
                return Some(Refusal { words, of: Change::Format });
            }
        }
        let name = then["experiment"].as_str().expect("a name");
        let known = farsa_experiments::all().into_iter().find(|one| one.name() == name);
        // Experiments from files have a number for each kind of world.
        let config = fs::read_to_string(self.0.join("run/config.toml")).expect("a configuration");
        let of_file = if config.contains("engine = \"articulated\"") { 2 } else { 1 };
        let experiment = known.map_or(of_file, farsa_lab::Experiment::values_version);
        let versions = [
            ("FARSA's values".to_owned(), &then["values_version"], VALUES_VERSION),
            (format!("the values of {name}"), &then["experiment_version"], experiment),
        ];
        let (what, then, now) = versions.into_iter().find(|(_, then, now)| **then != *now)?;
        let words = format!("made with version {then} of {what}, this program has version {now}");
        Some(Refusal { words, of: Change::Values })
    }

    /// Demands that what would give other results is refused in these words, and that nothing is changed by that.
    pub(crate) fn is_refused(&self, Refusal { words, of }: &Refusal) {
        let (before, evolved) = (content(&self.0.join("run")), self.recorded().is_some());
        let refuses = |arguments: &str| {
            let said = self.say(arguments);
            assert!(said.code == Some(1) && said.err.contains(words), "{arguments}: {words}: {said:?}");
        };
        if evolved {
            refuses("run --resume run --generations 9 --quiet");
        }
        match of {
            Change::Manifest => refuses("report run --html report.html"),
            Change::Format | Change::Values => {
                refuses("replay run --out steps.csv");
                refuses("draw run --out end.svg");
                refuses("live run --html live.html");
                refuses("export genotype run --out champion.gen");
            }
        }
        match of {
            Change::Format => refuses(TEST),
            // New trials are new in any case, and their version is printed.
            Change::Values => {
                let warned = self.ok(&format!("{TEST} --json")).json();
                assert!(warned["warning"].as_str().is_some_and(|text| text.contains(words)), "{warned}");
                fs::remove_file(self.0.join("run/test.csv")).expect("a test");
                fs::remove_file(self.0.join("run/test.json")).expect("a test");
            }
            Change::Manifest => {}
        }
        assert!(content(&self.0.join("run")) == before, "{}: something was written", self.0.display());
    }
}
