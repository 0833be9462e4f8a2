//! Overlaps at the start of a trial.

use crate::arena::ArenaWorld;
use farsa_body::ports::{BodyId, NearbySurface};
use farsa_lab::{EpisodeId, Error};
use farsa_num::{Scalar, sin_cos};

use crate::arena::episode::ArenaEpisode;
use crate::check::source::Source;

/// Greatest depth of a contact at the start [m].
const DEEPEST: f32 = 1e-3;

/// Overlapped thing.
#[derive(Clone, Copy)]
enum Obstacle {
    Wall,
    Body(BodyId),
}

impl Obstacle {
    fn body(self) -> Option<BodyId> {
        if let Self::Body(body) = self { Some(body) } else { None }
    }
}

/// Refuses a start of one of the trials with a robot or a block inside another thing or a wall.
///
/// The world refuses cylinders inside walls when it is built.
pub(crate) fn check_start<W: ArenaWorld>(
    episode: &mut ArenaEpisode,
    world: &mut W,
    trials: impl Iterator<Item = EpisodeId>,
    source: &Source,
) -> Result<(), Error> {
    for id in trials {
        let trial = id.trial + 1;
        episode.arrange(world, id).map_err(|error| source.wrong("/start", error))?;
        let scene = episode.scene();
        let robots = scene.robots.iter().enumerate().map(|(robot, hull)| {
            let body = scene.parts(robot).body;
            (body, inside_disc(world, body, hull.radius as f32))
        });
        let blocks = scene.movable().map(|(body, size)| (body, inside_box(world, body, size)));
        for (body, overlap) in robots.chain(blocks) {
            let Some(other) = overlap else { continue };
            let name = |body| scene.name_of(body).unwrap_or("robot");
            let path = episode.path_of([Some(body), other.body()].into_iter().flatten(), name(body));
            let other = other.body().map_or_else(|| "a wall".into(), |other| format!("`{}`", name(other)));
            return Err(
                source.wrong(&path, format!("`{}` is inside {other} at the start of trial {trial}", name(body)))
            );
        }
    }
    Ok(())
}

/// Returns what a robot overlaps, if anything.
fn inside_disc<W: ArenaWorld>(world: &W, body: BodyId, radius: f32) -> Option<Obstacle> {
    let [x, y, _] = world.pose(body).position;
    overlapping(world, body, [x, y], radius, |near| near.distance < radius - DEEPEST)
}

/// Returns what a box with these sides overlaps, if anything.
///
/// From its center, corners and edges, the nearest point of another surface is sought inside it.
fn inside_box<W: ArenaWorld>(world: &W, body: BodyId, size: [f64; 2]) -> Option<Obstacle> {
    let pose = world.pose(body);
    let ([x, y, _], (sine, cosine)) = (pose.position, sin_cos(pose.heading()));
    let [a, b] = size.map(|side| Scalar::max(0.5 * side as f32 - DEEPEST, 0.0));
    let is_inside = |[px, py]: [f32; 2]| {
        let [dx, dy] = [px - x, py - y];
        let along = [cosine * dx + sine * dy, cosine * dy - sine * dx];
        Scalar::abs(along[0]) <= a && Scalar::abs(along[1]) <= b
    };
    let points = [-1.0, 0.0, 1.0].into_iter().flat_map(|i| [-1.0, 0.0, 1.0].map(|j| [i * a, j * b]));
    let points = points.map(|[i, j]| [x + cosine * i - sine * j, y + sine * i + cosine * j]);
    let reach = 2.0 * (a + b);
    points
        .into_iter()
        .find_map(|from| overlapping(world, body, from, reach, |near| near.distance <= 0.0 || is_inside(near.point)))
}

/// Returns the first other body near a point that satisfies a test.
fn overlapping<W: ArenaWorld>(
    world: &W,
    body: BodyId,
    from: [f32; 2],
    range: f32,
    overlaps: impl Fn(&NearbySurface<BodyId>) -> bool,
) -> Option<Obstacle> {
    let mut first = None;
    world.query_near(from, range, &mut |near| {
        if first.is_none() && near.body != Some(body) && overlaps(&near) {
            first = Some(near.body.map_or(Obstacle::Wall, Obstacle::Body));
        }
    });
    first
}
