//! Bodies that are put elsewhere in the course of an episode.

use farsa_body::{Arrange, BodyId, Handles, Pose, Recorder, Twist};
use serde::{Deserialize, Serialize};

use crate::experiment::episode::{Episode, EpisodeId};

/// A body that is put somewhere, at rest, before a step of an episode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// Before which step, from 0.
    pub step: u32,
    /// Which body; nothing happens to one that hangs on a joint.
    pub body: u16,
    /// Where to \[m\].
    pub position: [f32; 3],
    /// How it lies there: a unit quaternion \[x, y, z, w\].
    pub rotation: [f32; 4],
}

/// How a body is put somewhere in a world of type `W`.
pub(crate) type Place<W> = fn(&mut W, &Displacement);

/// Puts a body somewhere.
pub(crate) fn place<W: Arrange + Handles<Body = BodyId>>(world: &mut W, displacement: &Displacement) {
    let Displacement { body, position, rotation, .. } = *displacement;
    world.place_body(BodyId(body), Pose { position, rotation }, Twist::default());
    world.finish_placement();
}

/// An episode in which bodies are put elsewhere.
pub(crate) struct Displaced<'d, W, E> {
    pub(crate) episode: E,
    pub(crate) displacements: &'d [Displacement],
    pub(crate) place: Place<W>,
    step: u32,
}

impl<'d, W, E> Displaced<'d, W, E> {
    /// The episode with these, in any order.
    pub(crate) fn new(episode: E, displacements: &'d [Displacement], place: Place<W>) -> Self {
        Self { episode, displacements, place, step: 0 }
    }
}

impl<W, E: Episode<W>> Episode<W> for Displaced<'_, W, E> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.step = 0;
        self.episode.start(world, id);
    }

    fn has_started(&self) -> bool {
        self.episode.has_started()
    }

    fn act(&mut self, world: &mut W) {
        let now = self.displacements.iter().filter(|displacement| displacement.step == self.step);
        now.for_each(|displacement| (self.place)(world, displacement));
        self.step = self.step.saturating_add(1);
        self.episode.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.episode.judge(world)
    }

    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        self.episode.record_action(world, recorder);
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        self.episode.record(world, recorder);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::episode::run_episode;
    use farsa_body::{Kinematics as _, MobileRobot};
    use farsa_physics::arena::{Arena, World};

    /// Ten steps in which nothing is done, and where the body is before each.
    struct Ten(Vec<[f32; 3]>);

    impl Episode<World> for Ten {
        fn start(&mut self, _: &mut World, _: EpisodeId) {
            self.0.clear();
        }
        fn act(&mut self, world: &mut World) {
            self.0.push(world.pose(BodyId(0)).position);
        }
        fn judge(&mut self, _: &mut World) -> Option<f64> {
            (self.0.len() == 10).then_some(0.0)
        }
    }

    #[test]
    fn a_body_is_put_somewhere_before_its_step() {
        let mut arena = Arena::new();
        arena.add_robot(MobileRobot::khepera(), [0.0, 0.0], 0.0);
        let mut world = World::new(&arena).unwrap();
        let to = |step, x| Displacement { step, body: 0, position: [x, 0.5, 0.0], rotation: [0.0, 0.0, 0.0, 1.0] };
        let displacements = [to(7, 0.25), to(3, -0.5), to(12, 9.0)];
        let mut episode = Displaced::new(Ten(Vec::new()), &displacements, place);
        for _ in 0..2 {
            world.clear();
            run_episode(&mut episode, &mut world, EpisodeId::default(), None);
            let xs: Vec<f32> = episode.episode.0.iter().map(|position| position[0]).collect();
            assert_eq!(xs, [0.0, 0.0, 0.0, -0.5, -0.5, -0.5, -0.5, 0.25, 0.25, 0.25]);
        }
    }
}
