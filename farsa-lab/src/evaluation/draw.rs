//! `farsa draw`: a moment of a trial as a picture, and a champion's for the report.

use std::path::Path;

use farsa_view::{Camera, Picture, Recording};
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::memory_budget::MemoryUse;
use crate::evaluation::replay::{ReplaySummary, Replayable, Selection, TrialSelector};
use crate::run::plan::Plan;
use crate::store::directory::Directory;
use crate::store::own_output::{refuse_other, write_outputs};

/// Width and height of a picture where none are asked for.
const SIZE: (u32, u32) = (1200, 800);
/// The same of each of several.
const SIZE_OF_FRAMES: (u32, u32) = (480, 320);
/// The same for a picture in a report.
const REPORT_SIZE: [u32; 2] = [600, 400];
/// Largest width and height.
const MAX_SIDE: u32 = 8192;

/// Format of a picture file.
#[derive(Clone, Copy)]
enum Format {
    Png,
    Svg,
}

impl Format {
    fn from_path(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            _ => Err(Error::Usage(format!("{}: the name of a picture ends in .svg or .png", path.display()))),
        }
    }
}

/// A drawn picture.
#[derive(Debug, Serialize)]
pub(crate) struct DrawResult {
    /// Whole trial, of which the picture is a moment.
    #[serde(flatten)]
    replay: ReplaySummary,
    /// Time of the picture [s], the first of several.
    time: f64,
    frames: usize,
    camera: &'static str,
    width: u32,
    height: u32,
    file: String,
    /// The same in a line of words.
    pub(crate) summary: String,
}

/// Contents and form of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawRequest<'w> {
    pub(crate) which: Selection,
    /// Moment \[s\], by default the last.
    pub(crate) time: Option<f64>,
    /// Number of moments from the first to the last, instead of one moment.
    pub(crate) frames: Option<u32>,
    pub(crate) camera: Option<&'w str>,
    /// Width and height \[pixels\].
    pub(crate) size: Option<(u32, u32)>,
}

/// Draws a moment of a trial, or several as an animation, and writes it to a file, which replaces only its earlier version.
///
/// # Errors
/// [`Error::Usage`] for what cannot be drawn, those of [`Replayable::find`], [`Error::Io`].
pub(crate) fn draw(
    plan: &Plan<'_>,
    directory: &Directory,
    wish: DrawRequest<'_>,
    path: &Path,
) -> Result<DrawResult, Error> {
    let format = Format::from_path(path)?;
    let camera = wish.camera.map(Camera::named).transpose()?;
    let (width, height) = wish.size.unwrap_or(if wish.frames.is_some() { SIZE_OF_FRAMES } else { SIZE });
    if !(16..=MAX_SIDE).contains(&width) || !(16..=MAX_SIDE).contains(&height) {
        return Err(Error::Usage(format!("a picture of {width}x{height}: each side is 16 to {MAX_SIDE} pixels")));
    }
    if wish.frames.is_some() && matches!(format, Format::Svg) {
        return Err(Error::Usage(format!("{}: with --frames its name ends in .png", path.display())));
    }
    refuse_other(path)?;
    let mut replayable = Replayable::find(plan, directory, wish.which)?;
    let trial = replayable.trials.start;
    let mut memory = MemoryUse::new(plan.limits);
    let mut recording = memory.recording(replayable.schema());
    let outcome = replayable.run(trial, &mut recording)?;
    // A trial that does not fit in memory still has moments before its end.
    if wish.frames.is_some() || !has_moment(&recording, wish.time) {
        memory.add(&recording)?;
    }
    let camera = camera.unwrap_or(Camera::for_view(recording.schema().view));
    let ticks = match wish.frames {
        None => vec![tick_at(&recording, wish.time)?],
        Some(frames) => ticks_of(tick_at(&recording, None)?, frames as usize),
    };
    let nothing =
        || Error::Usage(format!("{}: trials of `{}` have no bodies to draw", directory.path().display(), plan.name()));
    let pictures = ticks.iter().map(|tick| recording.picture(*tick)).collect::<Option<Vec<_>>>();
    let mut pictures = pictures.filter(|pictures| !pictures.is_empty()).ok_or_else(nothing)?;
    let seconds = recording.times()[ticks[0]];
    let Replayable { generation, individual, .. } = replayable;
    let chosen = if wish.which.trial == TrialSelector::Best { "best trial" } else { "trial" };
    let words = if wish.frames.is_none() { in_words(&recording, ticks[0]) } else { String::new() };
    let mut caption = format!(
        "{}, generation {generation}, individual {individual}, {chosen} {trial}, {seconds:.2} s{words}",
        plan.name(),
    );
    let last = recording.times()[ticks[ticks.len() - 1]];
    let frames = pictures.len();
    let bytes = match (wish.frames, format) {
        (Some(_), _) => {
            caption = format!("{caption} to {last:.2} s, {frames} pictures");
            let milliseconds = 1000.0 * (last - seconds) / (frames.max(2) - 1) as f64;
            Picture::animated_png(
                &pictures,
                camera,
                [width, height],
                milliseconds.round().clamp(10.0, 60_000.0) as u16,
            )?
        }
        (None, Format::Png) => pictures[0].png(camera, [width, height])?,
        (None, Format::Svg) => {
            pictures[0].caption = Some(caption.clone());
            pictures[0].svg(camera, [width, height], "p").into_bytes()
        }
    };
    write_outputs(&[(path.to_owned(), bytes)])?;
    Ok(DrawResult {
        replay: replayable.summary(plan, directory, std::slice::from_ref(&outcome)),
        time: seconds,
        frames,
        camera: camera.name(),
        width,
        height,
        file: path.display().to_string(),
        summary: format!("{caption}, camera {}: {width}x{height}", camera.name()),
    })
}

/// Returns the words of a tick, such as the phase or an instruction, after a comma.
fn in_words(recording: &Recording, tick: usize) -> String {
    let words = recording.words(tick);
    if words.is_empty() { String::new() } else { format!(", {}", words.join(" ")) }
}

/// Returns at most `count` ticks from the first to the last, evenly spaced.
fn ticks_of(last: usize, count: usize) -> Vec<usize> {
    let count = count.clamp(1, last + 1);
    (0..count).map(|frame| frame * last / (count - 1).max(1)).collect()
}

/// A champion's picture for a page.
pub(crate) struct Portrait {
    /// An SVG.
    pub(crate) picture: String,
    /// Time of its last step that was kept \[s\], of a trial that does not fit.
    pub(crate) cut: Option<f64>,
}

/// Draws the end of the champion's best trial as an SVG for a page. Returns `None` without bodies.
///
/// `prefix` begins every id, so that one page can hold several pictures.
pub(crate) fn champion(plan: &Plan<'_>, directory: &Directory, prefix: &str) -> Result<Option<Portrait>, Error> {
    let mut replayable = Replayable::find(plan, directory, Selection::default())?;
    let mut best: Option<(f64, u32, Recording)> = None;
    for trial in replayable.trials.clone() {
        let mut recording = MemoryUse::new(plan.limits).recording(replayable.schema());
        let outcome = replayable.run(trial, &mut recording)?;
        let fitness = replayable.fitness(core::slice::from_ref(&outcome));
        if best.as_ref().is_none_or(|(other, ..)| fitness > *other) {
            best = Some((fitness, trial, recording));
        }
    }
    let Some((_, trial, recording)) = best else { return Ok(None) };
    let Some(last) = recording.times().len().checked_sub(1) else { return Ok(None) };
    let Some(mut picture) = recording.picture(last) else { return Ok(None) };
    let time = recording.times()[last];
    let words = in_words(&recording, last);
    picture.caption = Some(format!("{}: champion, best trial {trial}, {time:.2} s{words}", plan.name()));
    let picture = picture.svg(Camera::for_view(recording.schema().view), REPORT_SIZE, prefix);
    Ok(Some(Portrait { picture, cut: recording.is_cut().then_some(time) }))
}

/// Checks whether the recording reaches a time, even if it was cut.
fn has_moment(recording: &Recording, time: Option<f64>) -> bool {
    time.is_some_and(|time| recording.times().last().is_some_and(|last| time <= *last))
}

/// Returns the tick nearest to a time, or the last one.
fn tick_at(recording: &Recording, time: Option<f64>) -> Result<usize, Error> {
    let times = recording.times();
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Err(Error::Usage("the trial has no step to draw".into()));
    };
    let Some(time) = time else { return Ok(times.len() - 1) };
    // The start, before the first step, is not recorded: a request for 0 means the first.
    if !(0.0..=*last).contains(&time) {
        return Err(Error::Usage(format!("the time {time} s: the trial has moments from {first} to {last} s")));
    }
    let tick = times.partition_point(|other| *other < time);
    let nearer = tick > 0 && time - times[tick - 1] < times[tick] - time;
    Ok(if nearer { tick - 1 } else { tick })
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::robots::ArmAndHand;
    use farsa_body::{Pose, Recorder};
    use farsa_view::Schema;

    #[test]
    fn of_a_trial_that_does_not_fit_only_what_was_kept_is_drawn() {
        let mut recording = Recording::new(Schema::from_scalars(["x"])).with_room(1000);
        for tick in 1..=100 {
            recording.scalars(&[0.0]);
            recording.tick(f64::from(tick));
        }
        let kept = recording.times().len();
        assert!(recording.is_cut() && (2..100).contains(&kept));
        assert!(has_moment(&recording, Some(1.0)) && has_moment(&recording, Some(kept as f64)));
        for time in [Some(kept as f64 + 0.5), Some(100.0), Some(f64::NAN), None] {
            assert!(!has_moment(&recording, time), "{time:?}");
        }
    }

    fn recording(ticks: u32) -> Recording {
        let robot = ArmAndHand::default().robot().unwrap();
        let mut recording = Recording::new(Schema::from_robot(&robot));
        for tick in 1..=ticks {
            recording.pose(ArmAndHand::PALM, Pose::at([0.1 * tick as f32, 0.0, 0.0]));
            recording.tick(0.01 * f64::from(tick));
        }
        recording
    }

    #[test]
    fn the_nearest_moment_is_drawn() {
        let recording = recording(10);
        let at = |time| tick_at(&recording, time).unwrap();
        assert_eq!([at(None), at(Some(0.0)), at(Some(0.01)), at(Some(0.0149)), at(Some(0.0151))], [9, 0, 0, 0, 1]);
        assert_eq!(at(Some(0.1)), 9);
        for time in [-0.01, 0.11, f64::NAN] {
            let error = tick_at(&recording, Some(time)).unwrap_err().to_string();
            assert!(error.contains("from 0.01 to 0.1 s"), "{error}");
        }
        assert!(tick_at(&Recording::default(), None).is_err());
    }

    #[test]
    fn moments_of_an_animation_lie_evenly() {
        assert_eq!(ticks_of(9, 4), [0, 3, 6, 9]);
        assert_eq!(ticks_of(99, 3), [0, 49, 99]);
        assert_eq!((ticks_of(2, 50), ticks_of(0, 5), ticks_of(9, 1)), (vec![0, 1, 2], vec![0], vec![0]));
    }
}
