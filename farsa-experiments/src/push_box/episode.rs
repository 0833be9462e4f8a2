//! Episodes of `push-box`, in which a robot pushes a box on an unbounded plane.

use core::f32::consts::PI;

use farsa_body::motors::WheelVelocity;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Motor as _, PairId, Planar,
    Rays, Sensor as _,
};
use farsa_body::robots::MobileParts;
use farsa_body::sensors::Beam;
use farsa_body::sensors::infrared::{InfraredDrawing, InfraredRays};
use farsa_body::{ChannelError, Pose, Recorder, Twist};
use farsa_lab::advanced::seconds;
use farsa_lab::{Episode, EpisodeId, Error};
use farsa_nn::Controller;
use farsa_num::{Domain, Scalar, Stream, sin_cos};

use crate::push_box::config::PushConfig;
use crate::push_box::layer::{place_and_heading, record_step, wheel_speeds};

/// Values that a controller gives: left and right wheel.
pub(crate) const OUTPUTS: usize = 2;

/// The measurements collected during a trial.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct PushTrial {
    /// Number of steps that have been completed.
    pub steps: u32,
    /// Number of steps in which the robot touched the box.
    pub touched: u32,
    /// Horizontal distance between the first and the last position of the box (in meters).
    pub moved: f64,
    /// Length of the path of the box (in meters).
    pub way: f64,
    /// Largest speed of the box at the end of a step, in meters per second.
    pub fastest: f64,
    /// True if a measured value was not finite.
    pub failed: bool,
}

/// A trial in which a controller drives the robot near the box.
#[derive(Clone, Debug)]
pub struct PushEpisode<C> {
    config: PushConfig,
    parts: MobileParts,
    cube: BodyId,
    pair: PairId,
    infrared: InfraredRays<Vec<Beam>>,
    drawing: InfraredDrawing,
    wheels: WheelVelocity,
    controller: C,
    x: Vec<f32>,
    y: [f32; OUTPUTS],
    /// Where the box was at the start and after the last step \[m\].
    places: [[f32; 2]; 2],
    trial: PushTrial,
}

impl<C: Controller> PushEpisode<C> {
    /// Creates an episode for a controller with two outputs that drive the left and the right wheel. The number of
    /// inputs is given by [`PushConfig::inputs`].
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the controller has a different number of inputs or outputs.
    pub fn new(config: PushConfig, controller: C) -> Result<Self, Error> {
        let (inputs, outputs, wanted) = (controller.inputs(), controller.outputs(), config.inputs());
        if inputs != wanted || outputs != OUTPUTS {
            return Err(Error::Other(format!(
                "push-box: a controller of {inputs} inputs and {outputs} outputs where {wanted} and {OUTPUTS} are wanted"
            )));
        }
        let wrong = |error: ChannelError| Error::Other(format!("push-box: {error}"));
        let (robot, scene) = (&config.robot, config.scene());
        let parts = scene.arena.parts(0);
        Ok(Self {
            parts,
            cube: scene.block(0),
            pair: scene.block_pair(0),
            infrared: InfraredRays::for_robot(robot, parts.body).map_err(wrong)?,
            drawing: InfraredDrawing::for_robot(robot, wanted),
            wheels: WheelVelocity::new(parts.motors, robot.max_wheel_speed as f32).map_err(wrong)?,
            controller,
            x: vec![0.0; wanted],
            y: [0.0; OUTPUTS],
            places: [[0.0; 2]; 2],
            trial: PushTrial::default(),
            config,
        })
    }

    /// Places the box in the middle of the arena and the robot near it. Both headings and the direction and distance of
    /// the robot are uniformly distributed.
    ///
    /// The values are drawn from the stream of [`Domain::Start`] for the given trial and generation. All individuals of
    /// a generation therefore have the same starts.
    pub fn arrange<W>(&mut self, world: &mut W, id: EpisodeId)
    where
        W: Kinematics + Arrange + Handles<Body = BodyId, Joint = JointId>,
    {
        let Self { config, parts, cube, .. } = self;
        // Individual 0 for all makes starts equal within a generation.
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
        world.clear();
        world.place_body(*cube, Pose::planar([0.0; 2], stream.range(-PI, PI)), Twist::default());
        let away = stream.range(config.apart[0] as f32, config.apart[1] as f32);
        // `apart` is the gap between hulls. The cube counts as a circle around its base at any heading.
        let away = away + (config.robot.radius + config.around()) as f32;
        let (sine, cosine) = sin_cos(stream.range(-PI, PI));
        let at = [away * cosine, away * sine];
        world.place_body(parts.body, Pose::planar(at, stream.range(-PI, PI)), Twist::default());
        world.finish_placement();
    }

    /// Returns the current reward. This is the displacement of the box in meters. It is NaN if the trial failed.
    pub fn fitness(&self) -> f64 {
        if self.trial.failed { f64::NAN } else { self.trial.moved }
    }

    /// Gets the configuration of the episode.
    pub fn config(&self) -> &PushConfig {
        &self.config
    }

    /// Gets the measurements of the current trial.
    pub fn trial(&self) -> &PushTrial {
        &self.trial
    }

    /// Gets the identifiers of the robot's parts.
    pub fn parts(&self) -> &MobileParts {
        &self.parts
    }

    /// Gets the body of the box.
    pub fn cube(&self) -> BodyId {
        self.cube
    }

    /// Gets the controller of the robot.
    pub fn controller(&self) -> &C {
        &self.controller
    }

    /// Replaces the controller. The new controller must have the same number of inputs and outputs.
    pub fn set_controller(&mut self, controller: C) {
        debug_assert_eq!((controller.inputs(), controller.outputs()), (self.x.len(), OUTPUTS), "inputs and outputs");
        self.controller = controller;
    }

    /// Gets the eight inputs of the last step.
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// Gets the two outputs of the last step.
    pub fn done(&self) -> &[f32] {
        &self.y
    }
}

impl<W, C> Episode<W> for PushEpisode<C>
where
    W: Planar
        + Rays
        + Kinematics
        + Joints
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>,
    C: Controller,
{
    /// Resets the score and arranges the world.
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.arrange(world, id);
        let [x, y, _] = world.pose(self.cube).position;
        self.places = [[x, y]; 2];
        self.trial = PushTrial::default();
        self.controller.reset();
    }

    #[inline]
    fn act(&mut self, world: &mut W) {
        self.infrared.read(world, &mut self.x);
        self.controller.step(&self.x, &mut self.y);
        self.wheels.drive(&self.y, world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        let Self { config, trial, places, .. } = self;
        trial.steps += 1;
        let [x, y, _] = world.pose(self.cube).position;
        let apart = |[u, v]: [f32; 2]| {
            let [u, v] = [x - u, y - v].map(f64::from);
            Scalar::sqrt(u * u + v * v)
        };
        // `moved` is the distance from the start, and `way` is the length of the path.
        trial.moved = apart(places[0]);
        trial.way += apart(places[1]);
        places[1] = [x, y];
        let [u, v, _] = world.velocity(self.cube).linear.map(f64::from);
        trial.fastest = Scalar::max(trial.fastest, Scalar::sqrt(u * u + v * v));
        trial.touched += u32::from(world.touches(self.pair));
        // `way` is a sum, so a single NaN stays in it.
        trial.failed |= !(trial.way.is_finite() && trial.fastest.is_finite());
        (trial.failed || trial.steps >= config.steps).then(|| self.fitness())
    }

    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        self.drawing.record(world.pose(self.parts.body), &self.x, false, recorder);
    }

    /// Records what was sensed, computed and done before the step, and what it led to.
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let bodies = [self.parts.body, self.cube];
        record_step(world, &self.x, &self.y, bodies, recorder);
        let mut scalars = Vec::with_capacity(9);
        scalars.extend(bodies.into_iter().flat_map(|body| place_and_heading(world, body)));
        scalars.extend(wheel_speeds(&self.y, self.config.robot.max_wheel_speed));
        scalars.push(self.trial.moved);
        recorder.scalars(&scalars);
        recorder.tick(seconds(self.trial.steps, self.config.time_step));
    }
}
