//! Result of a replay, and its page: of one run, or of two side by side.

use std::path::Path;

use farsa_view::Page;
use serde::Serialize;

use crate::error::Error;
use crate::run::plan::Plan;
use crate::store::directory::Directory;
use crate::store::own_output::{refuse_other, write_outputs};

/// Result of a replay, with a summary of each run.
#[derive(Debug, Serialize)]
pub(crate) struct Replayed<S> {
    #[serde(flatten)]
    pub(crate) replay: S,
    /// The same choice in another run, if there is one.
    compared: Option<S>,
    /// File of the recordings. None for the standard output.
    pub(crate) file: Option<String>,
    /// The same in words.
    pub(crate) summary: String,
}

/// The same in words.
pub(crate) trait InWords {
    fn text(&self) -> String;
}

impl<S: InWords> Replayed<S> {
    pub(crate) fn new(replay: S, compared: Option<S>) -> Self {
        let texts: Vec<String> = [&replay].into_iter().chain(&compared).map(S::text).collect();
        Self { replay, compared, file: None, summary: texts.join("\n") }
    }
}

/// Condition and seed of a run, or its seed.
pub(crate) fn run_in_words(plan: &Plan<'_>) -> String {
    let condition = if plan.condition.is_empty() { "seed" } else { plan.condition.as_str() };
    format!("{condition} {}", plan.seed)
}

/// Writes a page for a browser from what `add` adds of a run, and of a second run to compare. `what` ends its title.
///
/// # Errors
/// As for `add` and [`write_outputs`].
pub(crate) fn page<S: InWords>(
    (plan, directory): (&Plan<'_>, &Directory),
    compare: Option<(&Plan<'_>, &Directory)>,
    what: &str,
    path: &Path,
    add: impl Fn(&mut Page, &Plan<'_>, &Directory) -> Result<S, Error>,
) -> Result<Replayed<S>, Error> {
    refuse_other(path)?;
    let both = compare.map_or_else(|| plan.name(), |(other, _)| format!("{} and {}", plan.name(), other.name()));
    let mut page = Page::new(&format!("{both}{what}"));
    let replay = add(&mut page, plan, directory)?;
    let second = page.episodes();
    let compared = compare.map(|(plan, directory)| add(&mut page, plan, directory)).transpose()?;
    if compared.is_some() {
        page.open_beside(second);
    }
    write_outputs(&[(path.into(), page.html())])?;
    Ok(Replayed::new(replay, compared))
}
