//! `farsa report`: a page about one or several runs.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::Error;
use crate::escaped::OneLine;
use crate::report::outcome::Success;
use crate::report::page::{Block, Page};
use crate::report::run::Run;
use crate::report::section::section;
use crate::report::settings::shell;
use crate::run::plan::Plan;
use crate::store::directory::Directory;
use crate::store::own_output::{refuse_other, write_outputs};

/// Default criterion of a successful run.
const HALF: Success = Success::Share(0.5);

/// Summary of a written report.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    runs: Vec<RunSummary>,
    /// Written files.
    files: Vec<String>,
}

#[derive(Debug, Serialize)]
struct RunSummary {
    directory: String,
    experiment: String,
    condition: String,
    seed: u64,
    generations: usize,
    best: f64,
    mean: f64,
    /// Share of successful trials, `None` without a test.
    success: Option<f64>,
}

impl Summary {
    /// Formats the summary as a line of text.
    pub(crate) fn text(&self) -> String {
        let runs = if self.runs.len() == 1 { "run" } else { "runs" };
        format!("{} {runs}: {}\n", self.runs.len(), OneLine(self.files.join(", ")))
    }
}

/// Writes a page about some runs as HTML, as Markdown with its figures, or both.
///
/// # Errors
/// [`Error::Usage`] for an existing file or a run that is given twice and errors of reading a run. Nothing is written then.
pub(crate) fn report(
    runs: Vec<(Directory, Plan<'_>)>,
    html: Option<&Path>,
    md: Option<&Path>,
    success: Option<Success>,
    program: &str,
) -> Result<Summary, Error> {
    for (index, (directory, _)) in runs.iter().enumerate() {
        let real = |directory: &Directory| fs::canonicalize(directory.path()).ok();
        if runs.iter().take(index).any(|(other, _)| real(other) == real(directory)) {
            return Err(Error::Usage(format!("{}: is named twice", directory.path().display())));
        }
    }
    html.into_iter().chain(md).try_for_each(refuse_other)?;
    let runs = runs.into_iter().map(|(directory, plan)| Run::read(directory, plan)).collect::<Result<Vec<_>, _>>()?;
    let page = page(&runs, html, md, success, program)?;
    let mut files: Vec<(PathBuf, String)> = Vec::new();
    if let Some(path) = html {
        files.push((path.into(), page.html()));
    }
    if let Some(path) = md {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let (text, pictures) = page.markdown(&stem);
        files.push((path.into(), text));
        files.extend(pictures.into_iter().map(|(name, picture)| (path.with_file_name(name), picture)));
    }
    write_outputs(&files)?;
    Ok(Summary {
        runs: runs.iter().map(|run| summary(run, &runs)).collect(),
        files: files.iter().map(|(path, _)| path.display().to_string()).collect(),
    })
}

fn page(
    runs: &[Run<'_>],
    html: Option<&Path>,
    md: Option<&Path>,
    success: Option<Success>,
    program: &str,
) -> Result<Page, Error> {
    let mut experiments: Vec<String> = Vec::new();
    for label in runs.iter().map(|run| run.experiment(runs)) {
        if !experiments.contains(&label) {
            experiments.push(label);
        }
    }
    let title = match runs {
        [run] => run.plan.name(),
        _ => format!("{}: {} runs", experiments.join(", "), runs.len()),
    };
    let mut blocks = Vec::new();
    for experiment in &experiments {
        let these: Vec<&Run<'_>> = runs.iter().filter(|run| run.experiment(runs) == *experiment).collect();
        let heading = Some(experiment.as_str()).filter(|_| experiments.len() > 1);
        blocks.extend(section(&these, heading, success.unwrap_or(HALF), program)?);
    }
    let mut words: Vec<String> = vec![program.into(), "report".into()];
    words.extend(runs.iter().map(Run::name));
    for (option, path) in [("--html", html), ("--md", md)] {
        words.extend(path.into_iter().flat_map(|path| [option.to_owned(), path.display().to_string()]));
    }
    words.extend(match success {
        None => Vec::new(),
        Some(Success::Share(least)) => vec!["--success-share".to_owned(), least.to_string()],
        Some(Success::Fitness(least)) => vec!["--success-fitness".to_owned(), least.to_string()],
    });
    blocks.push(Block::Heading("This page".into()));
    let version = env!("CARGO_PKG_VERSION");
    blocks.push(Block::Text(format!("Written by FARSA {version}. The same runs make the same page.")));
    blocks.push(Block::Commands(vec![shell(&words)?]));
    Ok(Page { title, blocks })
}

fn summary(run: &Run<'_>, runs: &[Run<'_>]) -> RunSummary {
    RunSummary {
        directory: run.name(),
        experiment: run.experiment(runs),
        condition: run.plan.condition.clone(),
        seed: run.plan.seed,
        generations: run.lines.len(),
        best: run.fitness(None, run.last(), 0),
        mean: run.fitness(None, run.last(), 1),
        success: run.success(),
    }
}
