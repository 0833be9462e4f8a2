//! Command lines of requests. Each word is checked and is one argument of a process, never a text of a shell.

use serde::Deserialize;

use crate::live::lab::folder::{EXPORTS, PAGES, RUNS};
use crate::live::lab::names::{Refusal, file_name, key, name, value};
use crate::run::laboratory::{FILE, is_file};

/// Most seeds of a request.
const MAX_SEEDS: usize = 1000;
/// Most runs of a page.
const MAX_RUNS: usize = 500;
/// Longest name of a page without its extension [bytes].
const MAX_STEM: usize = 80;

/// Request for runs of an experiment.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RunRequest {
    /// A built-in experiment or a file of the folder.
    pub(super) experiment: String,
    condition: Option<String>,
    strategy: Option<String>,
    pub(super) seeds: Vec<u64>,
    generations: Option<u64>,
    threads: Option<u16>,
    /// Changed settings, in the order of the page.
    #[serde(default)]
    settings: Vec<(String, String)>,
    /// First part of the names of the runs, instead of that of the command.
    name: Option<String>,
}

impl RunRequest {
    /// Checks the number of seeds.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn check(&self) -> Result<(), Refusal> {
        if self.seeds.is_empty() || self.seeds.len() > MAX_SEEDS {
            return Err(Refusal::invalid(format!("give 1 to {MAX_SEEDS} seeds")));
        }
        Ok(())
    }

    /// Returns the name of the run of a seed, as the command forms it.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn run(&self, seed: u64) -> Result<String, Refusal> {
        let formed = || {
            let experiment = self.experiment.strip_suffix(FILE).unwrap_or(&self.experiment);
            let parts = [Some(experiment), self.condition.as_deref(), self.strategy.as_deref()];
            parts.into_iter().flatten().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
        };
        let stem = self.name.clone().unwrap_or_else(formed);
        // A name that was given for one run is its name.
        let text = if self.name.is_some() && self.seeds.len() == 1 { stem } else { format!("{stem}-{seed}") };
        name(&text)?;
        Ok(text)
    }

    /// Returns the arguments of the command for a seed and the name of its run.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn words(&self, seed: u64, run: &str) -> Result<Vec<String>, Refusal> {
        let mut words = vec!["run".to_owned(), experiment(&self.experiment)?.to_owned()];
        let seed = Some(seed.to_string());
        for (option, given) in [
            ("--condition", self.condition.clone()),
            ("--strategy", self.strategy.clone()),
            ("--seed", seed),
            ("--generations", self.generations.map(|count| count.to_string())),
            ("--threads", self.threads.map(|count| count.to_string())),
        ] {
            if let Some(given) = given.filter(|given| !given.is_empty()) {
                words.extend([option.to_owned(), name(&given)?.to_owned()]);
            }
        }
        for (setting, given) in &self.settings {
            words.extend(["--set".to_owned(), format!("{}={}", key(setting)?, value(given)?)]);
        }
        words.extend(["--out".to_owned(), place(run)]);
        Ok(words)
    }
}

/// Request to continue a run.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ResumeRequest {
    pub(super) run: String,
    /// New number of generations.
    generations: Option<u64>,
    threads: Option<u16>,
}

impl ResumeRequest {
    pub(super) fn words(&self) -> Vec<String> {
        let mut words = vec!["run".to_owned(), "--resume".to_owned(), place(&self.run)];
        let threads = self.threads.map(u64::from);
        for (option, given) in [("--generations", self.generations), ("--threads", threads)] {
            words.extend(given.into_iter().flat_map(|count| [option.to_owned(), count.to_string()]));
        }
        words
    }
}

/// Request to test a champion.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TestRequest {
    pub(super) run: String,
    trials: Option<u32>,
    seed: Option<u64>,
    protocol: Option<String>,
}

impl TestRequest {
    /// Returns the arguments of the command.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn words(&self) -> Result<Vec<String>, Refusal> {
        let mut words = vec!["test".to_owned(), place(&self.run)];
        for (option, given) in [
            ("--trials", self.trials.map(|count| count.to_string())),
            ("--seed", self.seed.map(|seed| seed.to_string())),
            ("--protocol", self.protocol.clone()),
        ] {
            if let Some(given) = given {
                words.extend([option.to_owned(), name(&given)?.to_owned()]);
            }
        }
        words.push("--json".into());
        Ok(words)
    }
}

/// Kind of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum PageKind {
    /// Curves, intervals and tests of one or several runs.
    Report,
    /// Recorded trials of a champion.
    Replay,
    /// The agent itself, with lesions and evolution.
    Live,
}

/// Request for a page.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PageRequest {
    kind: PageKind,
    pub(super) runs: Vec<String>,
    /// Generations of an interactive page.
    #[serde(default)]
    generations: Vec<u32>,
    /// Individual of each generation, instead of the best.
    individual: Option<u32>,
}

impl PageRequest {
    /// Checks the number of runs.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let most = if self.kind == PageKind::Report { MAX_RUNS } else { 1 };
        if self.runs.is_empty() || self.runs.len() > most {
            return Err(Refusal::invalid(format!("give 1 to {most} runs")));
        }
        Ok(())
    }

    pub(super) fn is_live(&self) -> bool {
        self.kind == PageKind::Live
    }

    /// Returns the name of the page's file.
    pub(super) fn file(&self) -> String {
        let kind = match self.kind {
            PageKind::Report => "report",
            PageKind::Replay => "replay",
            PageKind::Live => "live",
        };
        let joined = self.runs.join("+");
        let runs = if joined.len() > MAX_STEM { format!("{}-runs", self.runs.len()) } else { joined };
        format!("{kind}-{runs}.html")
    }

    pub(super) fn words(&self) -> Vec<String> {
        let command = match self.kind {
            PageKind::Report => "report",
            PageKind::Replay => "replay",
            PageKind::Live => "live",
        };
        let mut words = vec![command.to_owned()];
        words.extend(self.runs.iter().map(|run| place(run)));
        if self.is_live() && !self.generations.is_empty() {
            let list: Vec<String> = self.generations.iter().map(u32::to_string).collect();
            words.extend(["--generations".to_owned(), list.join(",")]);
        }
        if let Some(individual) = self.individual.filter(|_| self.is_live()) {
            words.extend(["--individual".to_owned(), individual.to_string()]);
        }
        words.extend(["--html".to_owned(), format!("{PAGES}/{}", self.file()), "--json".to_owned()]);
        words
    }
}

/// Kind of a text that an interactive page has made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum KeptKind {
    /// Genes of an individual.
    Genotype,
    /// Configuration with changed settings.
    Configuration,
    /// Commands that repeat a trial.
    Script,
    /// Run that evolution in the page has continued.
    Run,
}

/// Request to keep a text of an interactive page.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeepRequest {
    pub(super) kind: KeptKind,
    /// Run of the page.
    pub(super) run: String,
    pub(super) text: String,
}

impl KeepRequest {
    /// Returns the end of the name of the file.
    pub(super) fn extension(&self) -> &'static str {
        match self.kind {
            KeptKind::Genotype => ".gen",
            KeptKind::Configuration => ".toml",
            KeptKind::Script => ".sh",
            KeptKind::Run => ".run.json",
        }
    }
}

/// Returns the arguments of the command that continues a saved run.
pub(super) fn continued(file: &str, run: &str) -> Vec<String> {
    vec!["run".into(), "--from".into(), format!("{EXPORTS}/{file}"), "--out".into(), place(run)]
}

/// Request to write a file for other programs.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExportRequest {
    pub(super) run: String,
    format: Format,
}

/// Format of an exported file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Format {
    Json,
    Bytes,
    Rust,
    Safetensors,
    C,
    CIntegers,
    Genotype,
    Starts,
    Mjcf,
    Urdf,
}

impl ExportRequest {
    /// Returns the beginning and the end of the name of the new file.
    pub(super) fn file(&self) -> (String, &'static str) {
        let end = match self.format {
            Format::Json => ".controller.json",
            Format::Bytes => ".farsa",
            Format::Rust => ".rs",
            Format::Safetensors => ".safetensors",
            Format::C => ".c",
            Format::CIntegers => ".integers.c",
            Format::Genotype => ".gen",
            Format::Starts => ".starts.json",
            Format::Mjcf => ".xml",
            Format::Urdf => ".urdf",
        };
        (self.run.clone(), end)
    }

    /// Returns the arguments of the command for this file.
    pub(super) fn words(&self, file: &str) -> Vec<String> {
        let (what, format) = match self.format {
            Format::Json => ("controller", Some("json")),
            Format::Bytes => ("controller", Some("bytes")),
            Format::Rust => ("controller", Some("rust")),
            Format::Safetensors => ("controller", Some("safetensors")),
            Format::C => ("controller", Some("c")),
            Format::CIntegers => ("controller", Some("c-integers")),
            Format::Genotype => ("genotype", None),
            Format::Starts => ("starts", Some("json")),
            Format::Mjcf => ("robot", Some("mjcf")),
            Format::Urdf => ("robot", Some("urdf")),
        };
        let mut words = vec!["export".to_owned(), what.to_owned(), place(&self.run)];
        words.extend(format.into_iter().flat_map(|format| ["--format".to_owned(), format.to_owned()]));
        words.extend(["--out".to_owned(), format!("{EXPORTS}/{file}")]);
        words
    }
}

/// Returns the arguments of the command that prints a part of a run's page.
pub(super) fn served(run: &str, part: &str) -> Vec<String> {
    vec!["serve".into(), place(run), "--print".into(), part.into()]
}

/// Returns the directory of a run in the folder.
fn place(run: &str) -> String {
    format!("{RUNS}/{run}")
}

/// Checks the name of an experiment: of a file of the folder or a built-in one.
///
/// # Errors
/// [`Refusal`].
pub(super) fn experiment(text: &str) -> Result<&str, Refusal> {
    if is_file(text) { file_name(text) } else { name(text) }
}

/// Checks that the arguments of a stored job are those of a request for its run. The file may be part of an untrusted folder.
pub(super) fn is_of_request(run: &str, words: &[String]) -> bool {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let place = place(run);
    let number = |text: &str| text.parse::<u64>().is_ok();
    let setting = |text: &str| text.split_once('=').is_some_and(|(of, given)| key(of).is_ok() && value(given).is_ok());
    let pairs = |rest: &[&str], numbers: &[&str], names: &[&str]| {
        let (pairs, []) = rest.as_chunks::<2>() else { return false };
        pairs.iter().all(|[option, given]| match *option {
            "--set" => names.contains(option) && setting(given),
            option if numbers.contains(&option) => number(given),
            option => names.contains(&option) && name(given).is_ok(),
        })
    };
    name(run).is_ok()
        && match words[..] {
            ["run", "--resume", of, ref rest @ ..] => of == place && pairs(rest, &["--generations", "--threads"], &[]),
            ["run", "--from", of, "--out", out] => {
                of.strip_prefix(EXPORTS).and_then(|of| of.strip_prefix('/')).is_some_and(|of| name(of).is_ok())
                    && out == place
            }
            ["run", of, ref rest @ .., "--out", out] => {
                let numbers = ["--seed", "--generations", "--threads"];
                experiment(of).is_ok() && out == place && pairs(rest, &numbers, &["--condition", "--strategy", "--set"])
            }
            ["test", of, ref rest @ .., "--json"] => {
                of == place && pairs(rest, &["--trials", "--seed"], &["--protocol"])
            }
            _ => false,
        }
}

/// Returns the arguments of a command that describes an experiment.
///
/// # Errors
/// [`Refusal`].
pub(super) fn about(
    command: &str,
    of: &str,
    condition: Option<&str>,
    strategy: Option<&str>,
    rest: &[&str],
) -> Result<Vec<String>, Refusal> {
    let mut words = vec![command.to_owned(), experiment(of)?.to_owned()];
    for (option, given) in [("--condition", condition), ("--strategy", strategy)] {
        if let Some(given) = given.filter(|given| !given.is_empty()) {
            words.extend([option.to_owned(), name(given)?.to_owned()]);
        }
    }
    words.extend(rest.iter().map(|&word| word.to_owned()));
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(json: &str) -> RunRequest {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn a_run_has_the_words_of_its_command() {
        let run = request(
            r#"{"experiment":"a.toml","condition":"far","strategy":null,"seeds":[3,4],"generations":9,
                "settings":[["evolution.population","8"],["world.kind","\"flat\""]]}"#,
        );
        assert_eq!(run.run(3).unwrap(), "a-far-3");
        let words = run.words(3, "a-far-3").unwrap().join(" ");
        assert_eq!(
            words,
            "run a.toml --condition far --seed 3 --generations 9 --set evolution.population=8 \
             --set world.kind=\"flat\" --out runs/a-far-3"
        );
        let named = request(r#"{"experiment":"a","seeds":[3],"name":"mine"}"#);
        assert_eq!(named.run(3).unwrap(), "mine");
    }

    #[test]
    fn a_saved_run_is_one_of_the_exports() {
        let words = continued("a-1.run.json", "a-1.2");
        assert_eq!(words.join(" "), "run --from exports/a-1.run.json --out runs/a-1.2");
        assert!(is_of_request("a-1.2", &words) && !is_of_request("a-1", &words));
        for wrong in ["/etc/x", "exports/../x", "exports//x", "exports/-x", "exportsx"] {
            let words: Vec<String> = ["run", "--from", wrong, "--out", "runs/a"].map(str::to_owned).into();
            assert!(!is_of_request("a", &words), "{wrong}");
        }
    }

    #[test]
    fn no_word_is_an_option_or_a_place_of_its_own() {
        for wrong in [
            r#"{"experiment":"--help","seeds":[1]}"#,
            r#"{"experiment":"../a.toml","seeds":[1]}"#,
            r#"{"experiment":"a","condition":"--out=/etc/x","seeds":[1]}"#,
            r#"{"experiment":"a","strategy":"-q","seeds":[1]}"#,
            r#"{"experiment":"a","seeds":[1],"settings":[["--out","x"]]}"#,
            r#"{"experiment":"a","seeds":[1],"settings":[["robot.tables","/etc"]]}"#,
        ] {
            assert!(request(wrong).words(1, "r").is_err(), "{wrong}");
        }
        assert!(request(r#"{"experiment":"a","seeds":[1],"name":"../x"}"#).run(1).is_err());
        assert!(request(r#"{"experiment":"a","seeds":[]}"#).check().is_err());
        assert!(serde_json::from_str::<RunRequest>(r#"{"experiment":"a","seeds":[1],"out":"/tmp"}"#).is_err());
    }
}
