//! Bodies that are moved or pushed during an episode.

use farsa_body::ports::{Arrange, BodyId, ExternalForces, Handles, Kinematics};
use farsa_body::{Pose, Recorder, Twist};
use serde::{Deserialize, Serialize};

use crate::experiment::episode::{Episode, EpisodeId};

/// A body that is moved before a step of an episode. It is at rest afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// Step before which the body is moved, from 0.
    pub step: u32,
    /// Index of the body. A body that is attached to a joint is not moved.
    pub body: u16,
    /// New position \[m\].
    pub position: [f32; 3],
    /// New orientation, as a unit quaternion \[x, y, z, w\].
    pub rotation: [f32; 4],
}

/// An external force that acts on a body during some steps of an episode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Push {
    /// First step in which the force acts, from 0, and the step after the last.
    pub steps: [u32; 2],
    /// Index of the body.
    pub body: u16,
    /// Point of application, in the frame of the body \[m\].
    pub point: [f32; 3],
    /// Force in world coordinates \[N\].
    pub force: [f32; 3],
}

/// Moves a body in a world of type `W`.
pub(crate) type Place<W> = fn(&mut W, &Displacement);
/// Pushes a body in the next step of a world of type `W`.
pub(crate) type Apply<W> = fn(&mut W, &Push);

/// Puts a body somewhere.
pub(crate) fn place<W: Arrange + Handles<Body = BodyId>>(world: &mut W, displacement: &Displacement) {
    let Displacement { body, position, rotation, .. } = *displacement;
    world.place_body(BodyId(body), Pose { position, rotation }, Twist::default());
    world.finish_placement();
}

/// Pushes a body.
pub(crate) fn apply<W: ExternalForces + Kinematics + Handles<Body = BodyId>>(world: &mut W, push: &Push) {
    let body = BodyId(push.body);
    let point = world.pose(body).transform(push.point);
    world.apply_force(body, point, push.force);
}

/// Disturbances of an episode, in any order, and their functions for its world.
pub(crate) struct Disturbances<'d, W> {
    pub(crate) displacements: &'d [Displacement],
    pub(crate) pushes: &'d [Push],
    pub(crate) place: Option<Place<W>>,
    pub(crate) apply: Option<Apply<W>>,
}

impl<W> Disturbances<'_, W> {
    /// Checks whether there is any disturbance.
    pub(crate) fn any(&self) -> bool {
        let placed = self.place.is_some() && !self.displacements.is_empty();
        placed || self.apply.is_some() && !self.pushes.is_empty()
    }

    /// Applies the disturbances before a step. Displacements come first.
    fn before(&self, step: u32, world: &mut W) {
        if let Some(place) = self.place {
            let now = self.displacements.iter().filter(|displacement| displacement.step == step);
            now.for_each(|displacement| place(world, displacement));
        }
        if let Some(apply) = self.apply {
            let now = self.pushes.iter().filter(|push| (push.steps[0]..push.steps[1]).contains(&step));
            now.for_each(|push| apply(world, push));
        }
    }
}

/// An episode in which something is done to bodies.
pub(crate) struct Disturbed<'d, W, E> {
    episode: E,
    disturbances: Disturbances<'d, W>,
    step: u32,
}

impl<'d, W, E> Disturbed<'d, W, E> {
    /// Builds the episode with these.
    pub(crate) fn new(episode: E, disturbances: Disturbances<'d, W>) -> Self {
        Self { episode, disturbances, step: 0 }
    }
}

impl<W, E: Episode<W>> Episode<W> for Disturbed<'_, W, E> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.step = 0;
        self.episode.start(world, id);
    }

    fn has_started(&self) -> bool {
        self.episode.has_started()
    }

    fn act(&mut self, world: &mut W) {
        self.disturbances.before(self.step, world);
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
    use farsa_body::ports::World as _;
    use farsa_body::robot::{Joint, MassProperties, Robot, Segment};
    use farsa_body::robots::MobileRobot;
    use farsa_physics::{arena, articulated};

    /// Ten steps in which nothing is done, and where the body is before each.
    struct Ten(Vec<[f32; 3]>);

    impl<W: Kinematics<Body = BodyId>> Episode<W> for Ten {
        fn start(&mut self, _: &mut W, _: EpisodeId) {
            self.0.clear();
        }
        fn act(&mut self, world: &mut W) {
            self.0.push(world.pose(BodyId(0)).position);
        }
        fn judge(&mut self, _: &mut W) -> Option<f64> {
            (self.0.len() == 10).then_some(0.0)
        }
    }

    #[test]
    fn a_body_is_put_somewhere_before_its_step() {
        let mut arena = arena::Arena::new();
        arena.add_robot(MobileRobot::khepera(), [0.0, 0.0], 0.0);
        let mut world = arena::World::new(&arena).unwrap();
        let to = |step, x| Displacement { step, body: 0, position: [x, 0.5, 0.0], rotation: [0.0, 0.0, 0.0, 1.0] };
        let displacements = &[to(7, 0.25), to(3, -0.5), to(12, 9.0)];
        let disturbances = Disturbances { displacements, pushes: &[], place: Some(place), apply: None };
        assert!(disturbances.any());
        let mut episode = Disturbed::new(Ten(Vec::new()), disturbances);
        for _ in 0..2 {
            world.clear();
            run_episode(&mut episode, &mut world, EpisodeId::default(), None);
            let xs: Vec<f32> = episode.episode.0.iter().map(|position| position[0]).collect();
            assert_eq!(xs, [0.0, 0.0, 0.0, -0.5, -0.5, -0.5, -0.5, 0.25, 0.25, 0.25]);
        }
    }

    /// A ball without weight: it gains F t / m in each step of a push, and keeps it.
    #[test]
    fn a_body_is_pushed_in_its_steps() {
        let mut ball = Robot::new("ball");
        let start = Joint::floating(Pose::identity());
        ball.add_segment(Segment::new("ball", None, start, MassProperties::sphere(0.5, 0.1)));
        let options = articulated::Options { gravity: [0.0; 3], ..articulated::Options::default() };
        let mut world = articulated::World::new(articulated::Model::<f32>::new(&ball, &options).unwrap());
        let (h, m) = (f64::from(world.time_step()), 0.5);
        let push = |steps, force| Push { steps, body: 0, point: [0.0; 3], force: [force, 0.0, 0.0] };
        let pushes = &[push([2, 5], 0.5), push([4, 6], -0.25), push([3, 3], 9.0), push([20, 30], 9.0)];
        let disturbances = Disturbances { displacements: &[], pushes, place: Some(place), apply: Some(apply) };
        let mut episode = Disturbed::new(Ten(Vec::new()), disturbances);
        run_episode(&mut episode, &mut world, EpisodeId::default(), None);
        let forces = [0.0, 0.0, 0.5, 0.5, 0.25, -0.25, 0.0, 0.0, 0.0, 0.0];
        let speed: f64 = forces.iter().map(|force| force / m * h).sum();
        let measured = f64::from(world.velocity(BodyId(0)).linear[0]);
        assert!((measured - speed).abs() < 1e-6 * speed, "{measured} and {speed}");
        let places = &episode.episode.0;
        assert!(places[..3].iter().all(|place| *place == [0.0; 3]) && places[3][0] > 0.0, "{places:?}");
    }

    #[test]
    fn what_a_world_cannot_do_is_left_out() {
        let pushes = &[Push { steps: [0, 9], body: 0, point: [0.0; 3], force: [1.0; 3] }];
        let disturbances = |place, apply| Disturbances::<arena::World> { displacements: &[], pushes, place, apply };
        assert!(!disturbances(Some(place), None).any());
        assert!(disturbances(None, Some(|_, _| ())).any());
    }
}
