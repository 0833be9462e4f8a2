//! `farsa draw`: a moment of a life as a picture, and a champion's for the report.

use std::io::Write as _;
use std::path::Path;

use farsa_body::{BodyId, Pose};
use serde::Serialize;

use crate::camera::Camera;
use crate::directory::{Directory, create_result};
use crate::error::Error;
use crate::form::Form;
use crate::picture::{Beam, Color, OKABE_ITO, Picture, Placed, Push, Role};
use crate::plan::Plan;
use crate::prop::Prop;
use crate::recording::Recording;
use crate::replay::{Lived, Relived, Which};
use crate::stage::View;
use crate::vector::{Vector, length, sub};

/// Width and height of a picture where none are asked for.
const SIZE: (u32, u32) = (1200, 800);
/// The same for a picture in a report.
const REPORT_SIZE: [u32; 2] = [600, 400];
/// How high above the ground trails are drawn [m].
const TRAIL: f64 = 1e-3;
/// The colours of trails, by number: those that are seen best on the ground come first.
const TRAILS: [usize; 6] = [4, 5, 2, 6, 0, 1];
/// Largest width and height.
const LARGEST: u32 = 8192;

/// What a picture is a file of.
#[derive(Clone, Copy)]
enum Format {
    Png,
    Svg,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Error> {
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
    /// The whole life, of which the picture is a moment.
    #[serde(flatten)]
    life: Lived,
    /// The moment [s].
    time: f64,
    camera: &'static str,
    width: u32,
    height: u32,
    file: String,
    /// The same in a line of words.
    pub(crate) summary: String,
}

/// Draws the moment `time` \[s\] of a life, by default its last, and writes it to a new file.
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
    let format = Format::of(path)?;
    let camera = camera.map(Camera::named).transpose()?;
    let (width, height) = size.unwrap_or(SIZE);
    if !(16..=LARGEST).contains(&width) || !(16..=LARGEST).contains(&height) {
        return Err(Error::Usage(format!("a picture of {width}x{height}: each side is 16 to {LARGEST} pixels")));
    }
    let mut relived = Relived::find(plan, directory, which)?;
    let trial = relived.trials.start;
    let mut recording = Recording::new(relived.stage());
    let outcome = relived.live(trial, &mut recording);
    let tick = tick_at(&recording, time)?;
    let camera = camera.unwrap_or(Camera::for_view(recording.stage().view));
    let mut picture = recording.picture(tick).ok_or_else(|| {
        Error::Usage(format!("{}: lives of `{}` have no bodies to draw", directory.path().display(), plan.name()))
    })?;
    let seconds = recording.times()[tick];
    let Relived { generation, individual, .. } = relived;
    let caption =
        format!("{}, generation {generation}, individual {individual}, trial {trial}, {seconds:.2} s", plan.name());
    picture.caption = Some(caption.clone());
    let bytes = match format {
        Format::Png => picture.png(camera, [width, height])?,
        Format::Svg => picture.svg(camera, [width, height], "p").into_bytes(),
    };
    create_result(path)?.write_all(&bytes).map_err(Error::io("write", path))?;
    Ok(Drawn {
        life: relived.lived(plan, directory, std::slice::from_ref(&outcome)),
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
    let mut relived = Relived::find(plan, directory, Which::default())?;
    let mut best: Option<(f64, u32, Recording)> = None;
    for trial in relived.trials.clone() {
        let mut recording = Recording::new(relived.stage());
        let outcome = relived.live(trial, &mut recording);
        let fitness = relived.fitness(core::slice::from_ref(&outcome));
        if best.as_ref().is_none_or(|(other, ..)| fitness > *other) {
            best = Some((fitness, trial, recording));
        }
    }
    let Some((_, trial, recording)) = best else { return Ok(None) };
    let Some(last) = recording.times().len().checked_sub(1) else { return Ok(None) };
    let Some(mut picture) = recording.picture(last) else { return Ok(None) };
    picture.caption = Some(format!("{}: champion, trial {trial}, {:.2} s", plan.name(), recording.times()[last]));
    Ok(Some(picture.svg(Camera::for_view(recording.stage().view), REPORT_SIZE, prefix)))
}

/// The tick that is nearest to a time; the last if none is named.
fn tick_at(recording: &Recording, time: Option<f64>) -> Result<usize, Error> {
    let times = recording.times();
    let (Some(first), Some(last)) = (times.first(), times.last()) else {
        return Err(Error::Usage("the life has no step to draw".into()));
    };
    let Some(time) = time else { return Ok(times.len() - 1) };
    // The start, before the first step, is not recorded: whoever asks for 0 wants the first.
    if !(0.0..=*last).contains(&time) {
        return Err(Error::Usage(format!("the time {time} s: the life has moments from {first} to {last} s")));
    }
    let tick = times.partition_point(|other| *other < time);
    let nearer = tick > 0 && time - times[tick - 1] < times[tick] - time;
    Ok(if nearer { tick - 1 } else { tick })
}

impl Recording {
    /// What is to be seen at a tick, as `farsa draw` shows it; `None` if there is no such tick, or no bodies.
    ///
    /// A view from above also shows the ways that robots went up to then.
    pub fn picture(&self, tick: usize) -> Option<Picture> {
        let stage = self.stage();
        if tick >= self.times().len() || (stage.robot.is_none() && stage.props.is_empty()) {
            return None;
        }
        let mut picture = Picture::default();
        let pose = |body| self.pose_at(tick, body).map_or_else(Pose::identity, |pose| pose.cast());
        if let Some(robot) = &stage.robot {
            picture.add_robot(robot, pose);
        }
        let place = |prop: &Prop| prop.placed(&prop.body.map_or_else(Pose::identity, pose));
        picture.shapes.extend(stage.props.iter().map(place));
        if stage.view == View::Top {
            picture.trails = trails(self, tick);
            // What stands around belongs into the frame: an arena is seen whole.
            let walls = picture.shapes.iter().filter(|placed| matches!(placed.form, Form::Box { .. }));
            let corners = |placed: &Placed| {
                placed.form.hull().into_iter().map(|(corner, _)| placed.pose.transform(corner)).collect::<Vec<_>>()
            };
            picture.frame = walls.flat_map(corners).collect();
        }
        let f64_of = |position: [f32; 3]| position.map(f64::from);
        picture.contacts = (self.contacts_at(tick).iter())
            .map(|contact| Push { point: f64_of(contact.point), force: f64_of(contact.force) })
            .collect();
        picture.rays = (self.rays_at(tick).iter())
            .map(|ray| Beam { from: f64_of(ray.from), to: f64_of(ray.to), hit: ray.met })
            .collect();
        let point = |(index, name): (usize, &String)| {
            let position = self.point_at(tick, index)?;
            position.iter().all(|x| x.is_finite()).then(|| (name.clone(), f64_of(position)))
        };
        picture.points = stage.points.iter().enumerate().filter_map(point).collect();
        Some(picture)
    }
}

/// The ways that robots went up to a tick, a little above the ground, each in the colour of its robot's hull.
fn trails(recording: &Recording, tick: usize) -> Vec<(Vec<Vector>, Color)> {
    let stage = recording.stage();
    let bodies: Vec<BodyId> =
        stage.props.iter().filter(|prop| prop.role == Role::Robot).filter_map(|prop| prop.body).collect();
    let mut seen = Vec::new();
    let mut trails = Vec::new();
    for body in bodies {
        if seen.contains(&body) {
            continue;
        }
        seen.push(body);
        let mut way: Vec<Vector> = Vec::new();
        for place in
            (0..=tick).filter_map(|tick| recording.pose_at(tick, body)).map(|pose| pose.position.map(f64::from))
        {
            let place = [place[0], place[1], TRAIL];
            let moved = way.last().is_none_or(|last| length(sub(place, *last)) > 1e-4);
            if moved && place.iter().all(|x| x.is_finite()) {
                way.push(place);
            }
        }
        if way.len() > 1 {
            trails.push((way, OKABE_ITO[TRAILS[(seen.len() - 1) % TRAILS.len()]]));
        }
    }
    trails
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stage::Stage;
    use farsa_body::{ArmAndHand, Recorder};

    fn recording(ticks: u32) -> Recording {
        let robot = ArmAndHand::default().robot().unwrap();
        let mut recording = Recording::new(Stage::of_robot(&robot));
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
    fn only_bodies_can_be_drawn() {
        assert!(Recording::new(Stage::of_scalars(["x"])).picture(0).is_none());
        let recording = recording(2);
        let robot = recording.stage().robot.as_ref().unwrap();
        assert_eq!(recording.picture(1).unwrap().shapes.len(), robot.colliders.len());
        assert_eq!(recording.picture(2), None, "there are two ticks");
    }

    /// A round robot that drove a quarter of a circle between walls, and a post.
    fn arena() -> Recording {
        let on_ground = |x: f64, y: f64, z: f64| Pose::at([x, y, z]);
        let (robot, post) = (BodyId(0), BodyId(1));
        let hull = Form::Cylinder { radius: 0.035, half_length: 0.015 };
        let wall = Form::Box { half: [0.2, 0.005, 0.02] };
        let stage = Stage {
            bodies: vec!["robot".into(), "post".into()],
            props: vec![
                Prop::new("ground", Form::Rectangle { half: [0.2; 2] }, Pose::identity(), Role::Ground),
                Prop::new("nest", Form::Disc { radius: 0.05 }, on_ground(0.1, 0.1, 0.0), Role::Area),
                Prop::new("north", wall, on_ground(0.0, 0.205, 0.02), Role::Ground),
                Prop::new("south", wall, on_ground(0.0, -0.205, 0.02), Role::Ground),
                Prop::new("hull", hull, on_ground(0.0, 0.0, 0.015), Role::Robot).on(robot),
                Prop::new("post", hull, on_ground(0.0, 0.0, 0.015), Role::Thing).on(post).with_color([200, 30, 30]),
            ],
            view: View::Top,
            ..Stage::default()
        };
        let mut recording = Recording::new(stage);
        for tick in 0..=20u8 {
            let (sine, cosine) = farsa_num::sin_cos(f32::from(tick) * 0.078);
            recording.pose(robot, Pose::at([0.1 * cosine - 0.1, 0.1 * sine, 0.0]));
            recording.pose(post, Pose::at([-0.1, -0.05, 0.0]));
            recording.ray([0.0; 3], [0.05, 0.0, 0.0], tick % 2 == 0);
            recording.tick(0.05 * f64::from(tick));
        }
        recording
    }

    #[test]
    fn an_arena_shows_its_props_and_the_way_of_its_robot() {
        let recording = arena();
        let picture = recording.picture(20).unwrap();
        assert_eq!((picture.shapes.len(), picture.trails.len(), picture.rays.len()), (6, 1, 1));
        assert_eq!(picture.trails[0].0.len(), 21);
        // Twice the eight corners of two walls.
        assert_eq!(picture.frame.len(), 8 * 2);
        let place = picture.shapes[4].pose.position;
        let (_, cosine) = farsa_num::sin_cos(20.0_f64 * 0.078);
        assert!((place[0] - (0.1 * cosine - 0.1)).abs() < 1e-6 && place[2] == 0.015, "{place:?}");
        assert_eq!(picture.shapes[5].color(), [200, 30, 30]);
        let svg = picture.svg(Camera::for_view(View::Top), [600, 600], "p");
        assert!(svg.starts_with("<svg") && svg.contains("<title>"), "{svg}");
        let page = crate::Page::new("arena").with("a", recording).html();
        for part in ["\"kind\":\"cylinder\"", "\"role\":\"area\"", "\"color\":\"#c81e1e\"", "\"robot\",\"post\""] {
            assert!(page.contains(part), "{part}");
        }
        if let Some(path) = std::env::var_os("FARSA_LOOK") {
            std::fs::write(std::path::Path::new(&path).join("arena.svg"), svg).unwrap();
            std::fs::write(std::path::Path::new(&path).join("arena.html"), page).unwrap();
        }
    }
}
