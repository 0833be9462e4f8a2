//! `farsa draw`: a moment of a trial as a picture, and a champion's for the report.

use std::path::Path;

use farsa_view::{Camera, Recording};
use serde::Serialize;

use crate::error::Error;
use crate::evaluation::replay::{ReplaySummary, Replayable, Which};
use crate::run::plan::Plan;
use crate::store::directory::Directory;
use crate::store::replace::create_results;

/// Width and height of a picture where none are asked for.
const SIZE: (u32, u32) = (1200, 800);
/// The same for a picture in a report.
const REPORT_SIZE: [u32; 2] = [600, 400];
/// Largest width and height.
const LARGEST: u32 = 8192;

/// What a picture is a file of.
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

/// What was drawn.
#[derive(Debug, Serialize)]
pub(crate) struct Drawn {
    /// The whole trial, of which the picture is a moment.
    #[serde(flatten)]
    replay: ReplaySummary,
    /// The moment [s].
    time: f64,
    camera: &'static str,
    width: u32,
    height: u32,
    file: String,
    /// The same in a line of words.
    pub(crate) summary: String,
}

/// Draws the moment `time` \[s\] of a trial, by default its last, and writes it to a new file.
///
/// Of the trials the first is drawn if none is named.
pub(crate) fn draw(
    plan: &Plan<'_>,
    directory: &Directory,
    which: Which,
    time: Option<f64>,
    camera: Option<&str>,
    size: Option<(u32, u32)>,
    path: &Path,
) -> Result<Drawn, Error> {
    let format = Format::from_path(path)?;
    let camera = camera.map(Camera::named).transpose()?;
    let (width, height) = size.unwrap_or(SIZE);
    if !(16..=LARGEST).contains(&width) || !(16..=LARGEST).contains(&height) {
        return Err(Error::Usage(format!("a picture of {width}x{height}: each side is 16 to {LARGEST} pixels")));
    }
    let mut replayable = Replayable::find(plan, directory, which)?;
    let trial = replayable.trials.start;
    let mut recording = Recording::new(replayable.schema());
    let outcome = replayable.run(trial, &mut recording)?;
    let tick = tick_at(&recording, time)?;
    let camera = camera.unwrap_or(Camera::for_view(recording.schema().view));
    let mut picture = recording.picture(tick).ok_or_else(|| {
        Error::Usage(format!("{}: trials of `{}` have no bodies to draw", directory.path().display(), plan.name()))
    })?;
    let seconds = recording.times()[tick];
    let Replayable { generation, individual, .. } = replayable;
    let caption =
        format!("{}, generation {generation}, individual {individual}, trial {trial}, {seconds:.2} s", plan.name());
    picture.caption = Some(caption.clone());
    let bytes = match format {
        Format::Png => picture.png(camera, [width, height])?,
        Format::Svg => picture.svg(camera, [width, height], "p").into_bytes(),
    };
    create_results(&[(path.to_owned(), bytes)])?;
    Ok(Drawn {
        replay: replayable.summary(plan, directory, std::slice::from_ref(&outcome)),
        time: seconds,
        camera: camera.name(),
        width,
        height,
        file: path.display().to_string(),
        summary: format!("{caption}, camera {}: {width}x{height}", camera.name()),
    })
}

/// The end of the best trial of a run's champion, as an SVG to stand in a page; `None` if it has no bodies.
///
/// `prefix` begins every id in it, so that several can stand in one page.
pub(crate) fn champion(plan: &Plan<'_>, directory: &Directory, prefix: &str) -> Result<Option<String>, Error> {
    let mut replayable = Replayable::find(plan, directory, Which::default())?;
    let mut best: Option<(f64, u32, Recording)> = None;
    for trial in replayable.trials.clone() {
        let mut recording = Recording::new(replayable.schema());
        let outcome = replayable.run(trial, &mut recording)?;
        let fitness = replayable.fitness(core::slice::from_ref(&outcome));
        if best.as_ref().is_none_or(|(other, ..)| fitness > *other) {
            best = Some((fitness, trial, recording));
        }
    }
    let Some((_, trial, recording)) = best else { return Ok(None) };
    let Some(last) = recording.times().len().checked_sub(1) else { return Ok(None) };
    let Some(mut picture) = recording.picture(last) else { return Ok(None) };
    picture.caption = Some(format!("{}: champion, trial {trial}, {:.2} s", plan.name(), recording.times()[last]));
    Ok(Some(picture.svg(Camera::for_view(recording.schema().view), REPORT_SIZE, prefix)))
}

/// The tick that is nearest to a time; the last if none is named.
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
    use farsa_body::{ArmAndHand, Pose, Recorder};
    use farsa_view::Schema;

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
}
