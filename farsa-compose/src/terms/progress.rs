//! Displacements of the last step.

use farsa_body::ports::{BodyId, Handles, Kinematics};
use farsa_body::sensors::Point;
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::{direction, turned};

/// Displacement in this step along the heading [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Forward {
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// Displacement in this step along a direction of the world [m].
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Progress {
    /// Direction, of any length.
    #[schemars(inner(range(min = -1.0, max = 1.0)))]
    along: [f64; 3],
    /// Body of a robot with joints, by default the first.
    body: Option<String>,
}

/// Displacement of a point of a robot in the last step.
#[derive(Clone, Debug)]
struct Way {
    /// Number of a robot on wheels.
    robot: Option<usize>,
    point: Point,
    /// Position in the last step [m].
    before: [f64; 3],
    /// Displacement [m].
    last: [f64; 3],
}

impl Way {
    fn new(body: Option<&String>, scene: &PartScene<'_>) -> Result<Self, Error> {
        let point = scene.0.point(body, [0.0; 3])?;
        let robot = scene.mobile_robot().map(|_| scene.0.robot());
        Ok(Self { robot, point, before: [0.0; 3], last: [0.0; 3] })
    }

    fn position<W: Kinematics + Handles<Body = BodyId>>(&self, world: &W, now: &Moment<'_>) -> [f64; 3] {
        let position = self.robot.map_or_else(|| self.point.position(world), |robot| now.poses[robot].position);
        position.map(f64::from)
    }

    fn start<W: Kinematics + Handles<Body = BodyId>>(&mut self, world: &W, now: &Moment<'_>) {
        self.before = self.position(world, now);
    }

    fn step<W: Kinematics + Handles<Body = BodyId>>(&mut self, world: &W, now: &Moment<'_>) {
        let position = self.position(world, now);
        self.last = [0, 1, 2].map(|k| position[k] - self.before[k]);
        self.before = position;
    }
}

/// The displacement along the heading.
#[derive(Clone, Debug)]
pub(super) struct ForwardTerm(Way);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for ForwardTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        self.0.start(world, now);
    }

    fn step(&mut self, world: &W, now: &Moment<'_>) {
        self.0.step(world, now);
    }

    fn value(&self, world: &W, now: &Moment<'_>) -> f64 {
        let [x, y, _] = self.0.last;
        match self.0.robot {
            Some(robot) => turned(&now.poses[robot], [x, y])[0],
            // x component of R^T (p - p'), with p' of the previous step.
            None => world.pose(self.0.point.body).cast::<f64>().rotate_back(self.0.last)[0],
        }
    }
}

/// The displacement along a unit vector.
#[derive(Clone, Debug)]
pub(super) struct ProgressTerm(Way, [f64; 3]);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for ProgressTerm {
    fn start(&mut self, world: &W, now: &Moment<'_>) {
        self.0.start(world, now);
    }

    fn step(&mut self, world: &W, now: &Moment<'_>) {
        self.0.step(world, now);
    }

    fn value(&self, _: &W, _: &Moment<'_>) -> f64 {
        // n . (p - p')
        let ([x, y, z], [u, v, w]) = (self.0.last, self.1);
        if self.0.robot.is_some() { x * u + y * v } else { x * u + y * v + z * w }
    }
}

impl TermPart for Forward {
    type Term = ForwardTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<ForwardTerm, Error> {
        Way::new(self.body.as_ref(), scene).map(ForwardTerm)
    }
}

impl TermPart for Progress {
    type Term = ProgressTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<ProgressTerm, Error> {
        Ok(ProgressTerm(Way::new(self.body.as_ref(), scene)?, direction(self.along, scene)?))
    }
}
