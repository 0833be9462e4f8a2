//! The expected results of a run of another version.

use std::collections::BTreeMap;
use std::fs;

use farsa_num::Digest;

use crate::place::{Place, content, end, has};
use crate::{Expected, GENERATIONS, TEST};

impl Place {
    /// Checks that reading commands find the recorded fitness and the one that a replay of the last generation's best earned then,
    /// and that they change nothing.
    pub(crate) fn is_read(&self, earned_then: Option<f64>) {
        let before = content(&self.0.join("run"));
        let last = self.recorded().map(|(generations, _)| format!("--generation {} ", generations - 1));
        let replayed = self.ok(&format!("replay run {}--out steps.csv --json", last.unwrap_or_default())).json();
        let lines = self.text("steps.csv").lines().count() as u64;
        // The step in which a pole falls is not in balance.
        assert!(
            replayed["steps"].as_u64().is_some_and(|steps| (steps..steps + 2).contains(&(lines - 1))),
            "{replayed}"
        );
        let earned = replayed["fitness"].as_f64().expect("a fitness");
        if let Some(then) = earned_then {
            assert_eq!(earned.to_bits(), then.to_bits(), "{}", self.0.display());
        }
        if let Some((generations, best)) = self.recorded() {
            let record = fs::read(self.0.join("run/record.bin")).expect("a record");
            // These judge an individual by its evaluations in several generations.
            let judges = ["one-plus-one", "generalist"].iter().any(|name| has(&record, name.as_bytes()));
            assert!(judges || earned.to_bits() == best[0].to_bits(), "{}: {earned} {best:?}", self.0.display());
            let keeps = ["random-search", "map-elites", "cma-me", "nsga2", "novelty-search"];
            let keeps = best.len() == 1 && keeps.iter().any(|name| has(&record, name.as_bytes()));
            if keeps {
                let champion = self.ok("replay run --out champion.csv --json").json();
                assert_eq!(champion["fitness"].as_f64(), Some(self.highest()), "{champion}");
            }
            let report = self.ok("report run --html report.html --json").json();
            let report = &report["runs"][0];
            assert_eq!(report["generations"].as_u64(), Some(generations as u64));
            let highest = if keeps { self.highest() } else { best.iter().copied().fold(f64::NEG_INFINITY, f64::max) };
            assert_eq!(report["best"].as_f64().map(f64::to_bits), Some(highest.to_bits()), "{report}");
        } else {
            let said = self.say("report run --html report.html");
            assert!(said.code == Some(2) && said.err.contains("which no evolution has made"), "{said:?}");
        }
        assert!(content(&self.0.join("run")) == before, "{}: something was written", self.0.display());
    }

    /// Demands that the first generation is rebuilt: its best individual earns again what was recorded.
    pub(crate) fn is_rebuilt(&self) {
        let log = self.text("run/fitness.csv");
        let first = log.lines().nth(1).expect("a generation").split(',');
        let column = if first.clone().count() > 6 { 6 } else { 1 };
        let earned: f64 = first.clone().nth(column).and_then(|best| best.parse().ok()).expect("the best");
        let again = self.ok("replay run --generation 0 --out first.csv --json").json();
        assert_eq!(again["fitness"].as_f64().map(f64::to_bits), Some(earned.to_bits()), "{}", self.0.display());
    }

    /// Checks that it is drawn, and that a page of it runs, or is refused where there is no world for it.
    pub(crate) fn is_shown(&self) {
        self.ok("draw run --size 120x90 --out end.svg");
        assert!(self.text("end.svg").starts_with("<svg"), "{}", self.0.display());
        if self.manifest("run")["experiment"] == "push-box" {
            let said = self.say("live run --html live.html");
            assert!(
                said.code == Some(2) && said.err.contains("world `rapier`: pages that run an agent are without it"),
                "{said:?}"
            );
        } else {
            let written = self.ok("live run --html live.html --json").json();
            let page = fs::metadata(self.0.join("live.html")).expect("a page").len();
            assert_eq!(written["bytes"].as_u64(), Some(page));
        }
    }

    /// Tests, exports and resumes as `formats/make` did, and demands the files that it had then.
    pub(crate) fn goes_on(&self, expected: &Expected) {
        self.ok(&format!("{TEST} --quiet"));
        if expected.files.contains_key("controller.farsa") {
            let population = |name: &str| format!("--population {name} ");
            let names = ["predator", "hunter"].map(population).into_iter().chain([String::new()]);
            let mut tried = names.map(|name| {
                self.say(&format!("export controller run --format bytes {name}--out run/controller.farsa"))
            });
            assert!(tried.any(|said| said.code == Some(0)), "{}: no controller", self.0.display());
        }
        let Some((generations, _)) = self.recorded() else {
            let said = self.say("run --resume run --generations 9");
            assert!(said.code == Some(2) && said.err.contains("which no evolution has made"), "{said:?}");
            return;
        };
        // A run without evolution has one generation.
        let last = if generations == 1 { 1 } else { GENERATIONS };
        self.ok(&format!("run --resume run --generations {last} --quiet"));
        assert_eq!(self.recorded().map(|(generations, _)| generations), Some(last));
        self.ok(&format!("run --config run/config.toml --generations {last} --out whole --quiet"));
    }

    /// Demands that the files are those of a run made whole by this program, and those that there were then.
    pub(crate) fn is_what_it_was(&self, expected: &Expected, version: &str) {
        let found = content(&self.0.join("run"));
        // A later version may have more settings, and then other words about them in what it writes.
        let configured =
            !self.0.join("whole").exists() || self.text("run/config.toml") == self.text("whole/config.toml");
        assert!(configured || !format!("v{}.", env!("CARGO_PKG_VERSION")).starts_with(&format!("{version}.")));
        let compared = |file: &str| end(file) == "csv" || configured && ["bin", "farsa"].contains(&end(file));
        if self.0.join("whole").exists() {
            for (file, bytes) in content(&self.0.join("whole")).iter().filter(|(file, _)| compared(file)) {
                assert!(found.get(file) == Some(bytes), "{}: {file} is not that of a whole run", self.0.display());
            }
        }
        let digest = |bytes: &[u8]| {
            let mut digest = Digest::new();
            digest.add_bytes(bytes);
            digest.finish()
        };
        let found: BTreeMap<&str, u64> = found
            .iter()
            .filter(|(file, _)| compared(file))
            .map(|(file, bytes)| (file.as_str(), digest(bytes)))
            .collect();
        let expected: BTreeMap<&str, u64> = expected
            .files
            .iter()
            .filter(|(file, _)| compared(file))
            .map(|(file, digest)| (file.as_str(), *digest))
            .collect();
        assert_eq!(found, expected, "{}", self.0.display());
    }
}
