//! Readers and directories of runs by each strategy.

use std::fs;

use farsa_lab::advanced::RunDirectory;
use farsa_lab::fuzzing::RunReader;
use farsa_lab::strategy::strategies;

thread_local! {
    /// Readers for all strategies with one population, then for those with opponents.
    static READERS: Vec<RunReader<'static>> = readers();
    /// Directories of runs in the same order.
    static DIRECTORIES: Vec<RunDirectory<'static>> = directories();
}

fn readers() -> Vec<RunReader<'static>> {
    let laboratory = crate::laboratory();
    let read = |(name, text): (String, String)| {
        RunReader::new(&laboratory, &text).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    configurations().into_iter().map(read).collect()
}

fn directories() -> Vec<RunDirectory<'static>> {
    let laboratory = crate::laboratory();
    let open = |(name, text): (String, String)| {
        let path = std::env::temp_dir().join(format!("farsa-fuzz-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).expect("a directory");
        fs::write(path.join("config.toml"), text).expect("a configuration");
        RunDirectory::open(&path, &laboratory).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    configurations().into_iter().map(open).collect()
}

/// The configurations of the readers, each with a name.
pub fn configurations() -> Vec<(String, String)> {
    let mut all = Vec::new();
    for (condition, without) in [("alone", &["generalist"][..]), ("chase", &["one-plus-one", "learning"])] {
        for strategy in strategies().iter().map(|strategy| strategy.name()).filter(|name| !without.contains(name)) {
            all.push((format!("{condition}-{strategy}"), configuration(condition, strategy)));
        }
    }
    all
}

/// Calls `read` with the reader of runs of a strategy, which a byte of the input selects.
pub fn with_run<T>(byte: u8, read: impl FnOnce(&RunReader<'static>) -> T) -> T {
    READERS.with(|readers| read(&readers[usize::from(byte) % readers.len()]))
}

/// Calls `read` with the directory of a run, selected like the reader of [`with_run`].
pub fn with_directory<T>(byte: u8, read: impl FnOnce(&RunDirectory<'static>) -> T) -> T {
    DIRECTORIES.with(|directories| read(&directories[usize::from(byte) % directories.len()]))
}

fn configuration(condition: &str, strategy: &str) -> String {
    let head =
        format!("experiment = \"tune\"\ncondition = \"{condition}\"\nstrategy.name = \"{strategy}\"\nseed = 1\n");
    // Settings next to the population size, on which the trials of several populations depend.
    let more = match (condition, strategy) {
        ("alone", _) => return format!("{head}evolution.generations = 2\n"),
        (_, "truncation" | "novelty-search") => "evolution.parents = 2\n",
        (_, "evolution-strategy") => "strategy.parents = 2\n",
        (_, "generalist") => "strategy.newcomers = 5\nstrategy.iterations = 2\n",
        (_, "cma-me") => "strategy.emitters = 2\n",
        _ => "",
    };
    format!("{head}evolution.generations = 2\nevolution.population = 10\n{more}")
}

/// Splits an input into its first bytes and the rest, or returns `None` for a shorter input.
pub fn selected<const N: usize>(input: &[u8]) -> Option<([u8; N], &[u8])> {
    input.split_first_chunk().map(|(first, rest)| (*first, rest))
}
