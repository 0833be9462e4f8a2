//! `farsa draw --protocol`: how a trial of each case ends, side by side.

use std::path::Path;

use farsa_view::{Camera, Picture};
use maud::{Markup, PreEscaped, html};
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::memory_budget::MemoryUse;
use crate::evaluation::protocols::selected_cases::{CaseSelection, CaseTrials};
use crate::evaluation::test::Subject;
use crate::evaluation::trials::{success, why_failed};
use crate::experiment::protocol::{Case, Protocol};
use crate::figures::svg::{FONT, INK, MARGIN, OUTLINE, PAPER};
use crate::run::plan::Plan;
use crate::store::directory::Directory;
use crate::store::own_output::{refuse_other, write_outputs};

/// Width and height of each picture where none are asked for, and the largest.
const SIZE: (u32, u32) = (320, 260);
const MAX_SIDE: u32 = 2048;
/// Maximum number of pictures in a row.
const COLUMNS: usize = 8;
/// Heights of the title and of a picture's label, and what lies between pictures.
const HEAD: u32 = 44;
const LABEL: u32 = 26;
const GAP: u32 = 12;
/// Width of a letter of the title, at most in the mean.
const TITLE_LETTER: u32 = 10;

/// Which trials are drawn, and how.
pub(crate) struct DrawRequest<'w> {
    pub(crate) choice: CaseSelection<'w>,
    pub(crate) camera: Option<&'w str>,
    /// Size of each picture.
    pub(crate) size: Option<(u32, u32)>,
}

/// A drawn sheet.
#[derive(Debug, Serialize)]
pub(crate) struct Sheet {
    directory: String,
    protocol: String,
    generation: u32,
    individual: u32,
    trial: u32,
    seed: u64,
    cases: Vec<DrawnCase>,
    file: String,
    /// The same in a line of words.
    pub(crate) summary: String,
}

/// A picture of the sheet.
#[derive(Debug, Serialize)]
struct DrawnCase {
    row: String,
    column: String,
    held_out: bool,
    /// `None` for a task without a criterion of success.
    success: Option<bool>,
    broken_down: bool,
    #[serde(skip)]
    picture: Picture,
}

/// Draws the end of a trial of each case of a protocol, all to the same scale, and writes them to a file, which replaces only its earlier version.
///
/// # Errors
/// As for [`CaseTrials::find`] and [`CaseTrials::run`], [`Error::Io`], [`Error::Usage`] for a file that is not an SVG,
/// an invalid size, and trials without bodies.
pub(crate) fn draw(
    plan: &Plan<'_>,
    directory: &Directory,
    wish: &DrawRequest<'_>,
    path: &Path,
) -> Result<Sheet, Error> {
    if path.extension().is_none_or(|end| !end.eq_ignore_ascii_case("svg")) {
        return Err(Error::Usage(format!("{}: the name of a sheet of pictures ends in .svg", path.display())));
    }
    let camera = wish.camera.map(Camera::named).transpose()?;
    let (width, height) = wish.size.unwrap_or(SIZE);
    if !(16..=MAX_SIDE).contains(&width) || !(16..=MAX_SIDE).contains(&height) {
        return Err(Error::Usage(format!("pictures of {width}x{height}: each side is 16 to {MAX_SIDE} pixels")));
    }
    refuse_other(path)?;
    let mut trials = CaseTrials::find(plan, directory, wish.choice)?;
    let cases = pictures(plan, &mut trials)?;
    let camera = camera.unwrap_or(Camera::for_view(trials.schema().view));
    let caption = trials.caption();
    let shown: Vec<Case> = trials.cases.iter().map(|number| trials.case(*number)).collect();
    // A whole table keeps its rows. Named cases form one row.
    let abreast =
        if wish.choice.cases.is_empty() { Protocol::places(&shown, |case| &case.column).len() } else { shown.len() };
    let columns = abreast.clamp(1, COLUMNS);
    let picture = sheet(&caption, &cases, columns, camera, [width, height]);
    write_outputs(&[(path.to_owned(), picture)])?;
    let Subject { generation, individual, .. } = trials.subject();
    Ok(Sheet {
        directory: directory.path().display().to_string(),
        protocol: trials.protocol().name.clone(),
        generation: *generation,
        individual: *individual,
        trial: trials.trial,
        seed: trials.seed,
        summary: format!("{caption}: {} cases, camera {}", cases.len(), camera.name()),
        cases,
        file: path.display().to_string(),
    })
}

/// Gets the end of the trial in each case, each with room for what is to be seen in all.
fn pictures(plan: &Plan<'_>, trials: &mut CaseTrials) -> Result<Vec<DrawnCase>, Error> {
    let mut cases = Vec::new();
    for number in trials.cases.clone() {
        let mut memory = MemoryUse::new(plan.limits);
        let mut recording = memory.recording(trials.schema());
        let outcome = trials.run(number, &mut recording)?;
        memory.add(&recording)?;
        let last = recording.times().len().checked_sub(1);
        let picture = last
            .and_then(|tick| recording.picture(tick))
            .ok_or_else(|| Error::Usage(format!("trials of `{}` have no bodies to draw", plan.name())))?;
        let Case { row, column, held_out } = trials.case(number);
        let broken_down = why_failed(trials.evaluator(), &outcome).is_some();
        let success = success(trials.evaluator(), &outcome);
        cases.push(DrawnCase { row, column, held_out, success, broken_down, picture });
    }
    let corners: Vec<[f64; 3]> = cases.iter().flat_map(|case| case.picture.extent()).collect();
    for case in &mut cases {
        case.picture.frame.clone_from(&corners);
    }
    Ok(cases)
}

/// Arranges the labeled pictures in rows of the given length.
fn sheet(title: &str, cases: &[DrawnCase], columns: usize, camera: Camera, [width, height]: [u32; 2]) -> String {
    let margin = MARGIN as u32;
    let rows = cases.len().div_ceil(columns) as u32;
    let beside = columns.min(cases.len()) as u32;
    let wide = (beside * (width + GAP) - GAP).max(TITLE_LETTER * title.chars().count() as u32);
    let size = [2 * margin + wide, HEAD + rows * (height + LABEL + GAP) + 8];
    let draw = |number: usize, case: &DrawnCase| -> Markup {
        let [x, y] = [(number % columns) as u32, (number / columns) as u32];
        let [x, y] = [margin + x * (width + GAP), HEAD + LABEL + y * (height + LABEL + GAP)];
        let result = match (case.success, case.broken_down) {
            (_, true) => ": broken down",
            (Some(true), _) => ": success",
            (Some(false), _) => ": no success",
            (None, _) => "",
        };
        let name = if case.column.is_empty() { case.row.clone() } else { format!("{} {}", case.row, case.column) };
        let held_out = if case.held_out { ", held out" } else { "" };
        html! {
            text x=(x) y=(y - 8) fill=(INK) { (name) (held_out) (result) }
            g transform=(format!("translate({x} {y})")) {
                (PreEscaped(case.picture.svg(camera, [width, height], &format!("c{number}-"))))
                @if case.held_out {
                    rect width=(width) height=(height) fill="none" stroke=(OUTLINE) stroke-width="3" stroke-dasharray="8 3" {}
                } @else {
                    rect width=(width) height=(height) fill="none" stroke=(INK) stroke-opacity="0.3" {}
                }
            }
        }
    };
    let picture = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", size[0], size[1])) width=(size[0]) height=(size[1])
            font-family=(FONT) font-size="16" {
            rect width="100%" height="100%" fill=(PAPER) {}
            text x=(margin) y="28" font-size="18" fill=(INK) { (title) }
            @for (number, case) in cases.iter().enumerate() { (draw(number, case)) }
        }
    };
    picture.into_string() + "\n"
}
