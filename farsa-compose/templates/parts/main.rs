//! A custom sensor and a custom term for experiment files.

use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Sensor};
use farsa_compose::part::{self, Moment, PartScene, SensorPart, Term, TermPart};
use farsa_lab::{Error, Laboratory};
use farsa_num::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Way to a thing in the axes of the robot: ahead and to the left.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
struct Compass {
    /// Name of the thing.
    to: String,
    /// Distance that reads 1 [m].
    #[serde(default = "meter")]
    #[schemars(range(min = 0.1, max = 10.0))]
    reach: f64,
}

fn meter() -> f64 {
    1.0
}

/// The sensor in a world: robot, thing and scale.
#[derive(Clone)]
struct CompassSensor(BodyId, BodyId, f32);

impl Channels for CompassSensor {
    fn channels(&self) -> usize {
        2
    }
}

impl<W: Kinematics + Handles<Body = BodyId>> Sensor<W> for CompassSensor {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let way = world.pose(self.0).transform_back(world.pose(self.1).position);
        out.iter_mut().zip(&way[..2]).for_each(|(out, x)| *out = x * self.2);
    }
}

impl SensorPart for Compass {
    type Sensor = CompassSensor;
    fn sensor(&self, scene: &PartScene<'_>) -> Result<CompassSensor, Error> {
        Ok(CompassSensor(scene.body(None)?, scene.thing(&self.to)?, 1.0 / self.reach as f32))
    }
}

/// Way of the robot since the start [m].
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
struct Path {}

/// The term in a world: robot, position in the last step and way.
#[derive(Clone)]
struct PathTerm(BodyId, [f32; 3], f64);

impl<W: Kinematics + Handles<Body = BodyId>> Term<W> for PathTerm {
    fn start(&mut self, world: &W, _: &Moment<'_>) {
        (self.1, self.2) = (world.pose(self.0).position, 0.0);
    }
    fn step(&mut self, world: &W, _: &Moment<'_>) {
        let now = world.pose(self.0).position;
        let squares = now.iter().zip(self.1).map(|(x, before)| f64::from(x - before) * f64::from(x - before));
        (self.1, self.2) = (now, self.2 + Scalar::sqrt(squares.sum::<f64>()));
    }
    fn value(&self, _: &W, _: &Moment<'_>) -> f64 {
        self.2
    }
}

impl TermPart for Path {
    type Term = PathTerm;
    fn term(&self, scene: &PartScene<'_>) -> Result<PathTerm, Error> {
        Ok(PathTerm(scene.body(None)?, [0.0; 3], 0.0))
    }
}

fn laboratory() -> Laboratory<'static> {
    let laboratory = Laboratory::new(&[]).with_files(farsa_compose::FILES);
    laboratory.with_part(part::sensor::<Compass>("compass")).with_part(part::term::<Path>("path"))
}

farsa_lab::main!(laboratory);
