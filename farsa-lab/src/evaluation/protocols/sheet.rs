//! `farsa draw --protocol`: how a trial of each case ends, side by side.

use std::path::Path;

use farsa_view::{Camera, Picture, Recording};
use maud::{Markup, PreEscaped, html};
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::protocols::trial::CaseTrial;
use crate::evaluation::test::{Subject, whose};
use crate::experiment::evaluator::Bodies;
use crate::experiment::lanes::Wanted;
use crate::experiment::protocol::{CaseId, Protocol};
use crate::figures::heat_map::OUTLINE;
use crate::figures::plot::{FONT, INK, MARGIN, PAPER};
use crate::run::plan::Plan;
use crate::run::pool::Pool;
use crate::store::directory::Directory;
use crate::store::replace::create_results;

/// Width and height of each picture where none are asked for, and the largest.
const SIZE: (u32, u32) = (320, 260);
const LARGEST: u32 = 2048;
/// Most cases of a protocol that is drawn, and most pictures beside each other.
const MOST_CASES: usize = 60;
const COLUMNS: usize = 8;
/// Heights of the title and of a picture's label, and what lies between pictures.
const HEAD: u32 = 44;
const LABEL: u32 = 26;
const GAP: u32 = 12;

/// Which trials are drawn, and how.
pub(crate) struct Wish<'w> {
    pub(crate) protocol: &'w str,
    /// The number of the trial in each case.
    pub(crate) trial: u32,
    /// Of the test.
    pub(crate) seed: u64,
    pub(crate) camera: Option<&'w str>,
    /// Of each picture.
    pub(crate) size: Option<(u32, u32)>,
}

/// What was drawn.
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
    success: bool,
    #[serde(skip)]
    picture: Picture,
}

/// Draws the end of a trial of each case of a protocol, all to the same scale, and writes them to a new file.
///
/// # Errors
/// Those of [`Protocol::find`] and [`Subject::read`]; [`Error::Usage`] for a file that is no SVG, a size that none is, too many
/// cases, and trials without bodies; [`Error::Other`] for a trial that panics; [`Error::Io`].
pub(crate) fn draw(plan: &Plan<'_>, directory: &Directory, wish: &Wish<'_>, path: &Path) -> Result<Sheet, Error> {
    if path.extension().is_none_or(|end| !end.eq_ignore_ascii_case("svg")) {
        return Err(Error::Usage(format!("{}: the name of a sheet of pictures ends in .svg", path.display())));
    }
    let camera = wish.camera.map(Camera::named).transpose()?;
    let (width, height) = wish.size.unwrap_or(SIZE);
    if !(16..=LARGEST).contains(&width) || !(16..=LARGEST).contains(&height) {
        return Err(Error::Usage(format!("pictures of {width}x{height}: each side is 16 to {LARGEST} pixels")));
    }
    let pool = Pool::new(plan, 1, Wanted::ONE)?;
    let mut protocols = pool.evaluator().protocols();
    let number = Protocol::find(&protocols, wish.protocol, plan.experiment.name())?;
    let protocol = protocols.swap_remove(number);
    let count = protocol.cases.len();
    if count > MOST_CASES {
        return Err(Error::Usage(format!("protocol `{}` has {count} cases; {MOST_CASES} are drawn", protocol.name)));
    }
    let subject = Subject::read(plan, directory, &pool)?;
    let (cases, view) = pictures(plan, &subject, (number, &protocol), wish)?;
    let camera = camera.unwrap_or(Camera::for_view(view));
    let Subject { generation, individual, individuals, .. } = &subject;
    let trial = format!("trial {}, test seed {}", wish.trial, wish.seed);
    let caption = format!("{}, {}, {trial}", protocol.name, whose(*generation, *individual, individuals));
    let columns = Protocol::places(&protocol.cases, |case| &case.column).len().clamp(1, COLUMNS);
    let picture = sheet(&caption, &cases, columns, camera, [width, height]);
    create_results(&[(path.to_owned(), picture)])?;
    Ok(Sheet {
        directory: directory.path().display().to_string(),
        protocol: protocol.name,
        generation: *generation,
        individual: *individual,
        trial: wish.trial,
        seed: wish.seed,
        summary: format!("{caption}: {count} cases, camera {}", camera.name()),
        cases,
        file: path.display().to_string(),
    })
}

/// The end of the trial in each case, each with room for what is to be seen in all.
fn pictures(
    plan: &Plan<'_>,
    subject: &Subject,
    (number, protocol): (usize, &Protocol),
    wish: &Wish<'_>,
) -> Result<(Vec<DrawnCase>, farsa_view::View), Error> {
    let mut evaluator = plan.evaluator()?;
    let tested = subject.tested();
    let with = |bodies: &dyn Bodies| tested.parameters.first().map(|parameters| bodies.schema_with(parameters));
    let schema = evaluator.bodies().and_then(with).unwrap_or_else(|| evaluator.schema());
    let view = schema.view;
    let mut cases = Vec::new();
    for (case, found) in protocol.cases.iter().enumerate() {
        let mut recording = Recording::new(schema.clone());
        let of_case =
            CaseTrial { case: CaseId { protocol: number, case }, trial: wish.trial as usize, seed: wish.seed };
        let Ok(outcome) = of_case.run(evaluator.as_mut(), tested, &mut recording) else {
            return Err(Error::Other(format!("trial {} of the case {} panicked", wish.trial, found.name())));
        };
        let last = recording.times().len().checked_sub(1);
        let picture = last
            .and_then(|tick| recording.picture(tick))
            .ok_or_else(|| Error::Usage(format!("trials of `{}` have no bodies to draw", plan.name())))?;
        let (row, column, held_out) = (found.row.clone(), found.column.clone(), found.held_out);
        cases.push(DrawnCase { row, column, held_out, success: outcome.success, picture });
    }
    let corners: Vec<[f64; 3]> = cases.iter().flat_map(|case| case.picture.extent()).collect();
    for case in &mut cases {
        case.picture.frame.clone_from(&corners);
    }
    Ok((cases, view))
}

/// The pictures with their labels, so many beside each other.
fn sheet(title: &str, cases: &[DrawnCase], columns: usize, camera: Camera, [width, height]: [u32; 2]) -> String {
    let margin = MARGIN as u32;
    let rows = cases.len().div_ceil(columns) as u32;
    let beside = columns.min(cases.len()) as u32;
    let all = [2 * margin + beside * (width + GAP) - GAP, HEAD + rows * (height + LABEL + GAP) + 8];
    let draw = |number: usize, case: &DrawnCase| -> Markup {
        let [x, y] = [(number % columns) as u32, (number / columns) as u32];
        let [x, y] = [margin + x * (width + GAP), HEAD + LABEL + y * (height + LABEL + GAP)];
        let result = if case.success { "succeeded" } else { "failed" };
        let name = if case.column.is_empty() { case.row.clone() } else { format!("{} {}", case.row, case.column) };
        let held_out = if case.held_out { ", held out" } else { "" };
        html! {
            text x=(x) y=(y - 8) fill=(INK) { (name) (held_out) ": " (result) }
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
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", all[0], all[1])) width=(all[0]) height=(all[1])
            font-family=(FONT.0) font-size="16" {
            rect width="100%" height="100%" fill=(PAPER) {}
            text x=(margin) y="28" font-size="18" fill=(INK) { (title) }
            @for (number, case) in cases.iter().enumerate() { (draw(number, case)) }
        }
    };
    picture.into_string() + "\n"
}
