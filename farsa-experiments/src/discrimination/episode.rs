//! An episode of `discrimination` and `discrimination-cylinders`: one trial among cylinders, up to its last step or a
//! collision.

use core::f32::consts::PI;

use farsa_body::motors::WheelVelocity;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Motor as _, PairId, Planar,
    Rays, Sensor as _,
};
use farsa_body::robots::MobileParts;
use farsa_body::sensors::WheelSpeed;
use farsa_body::{ChannelError, Pose, Recorder, Twist};
use farsa_lab::{Episode, EpisodeId, Error, seconds};
use farsa_nn::Controller;
use farsa_num::{Domain, Scalar, Stream};
use farsa_physics::arena::{ArenaError, FreePlace};

use crate::discrimination::config::{Config, EYES};
use crate::infrared::settings::Infrared;
use crate::wheeled::{place_and_heading, record_step, wheel_speeds};

/// Most cylinders of a trial.
pub const CYLINDERS: usize = 2;

/// The score of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Trial {
    /// Steps taken.
    pub steps: u32,
    /// Steps near each cylinder, the one to stay at first.
    pub near: [u32; CYLINDERS],
    /// Differences of the wheels' speeds, summed over the steps near each cylinder \[rad/s\].
    pub spun: [f64; CYLINDERS],
    /// Whether the robot ran into something.
    pub collided: bool,
    /// Whether no place was found for something at the start, or a value was not finite.
    pub failed: bool,
    /// From the robot's hull to the surface of each cylinder after the last step \[m\].
    pub distance: [f64; CYLINDERS],
}

/// The robot among its cylinders with a controller: sensors, motors, and the judge of the trial.
#[derive(Clone, Debug)]
pub struct CylinderEpisode<C> {
    config: Config,
    parts: MobileParts,
    pair: PairId,
    radius: f64,
    cylinders: Vec<BodyId>,
    infrared: Infrared,
    wheel_speeds: Option<WheelSpeed>,
    wheels: WheelVelocity,
    controller: C,
    /// Where each cylinder stands in this trial \[m\].
    places: [[f32; 2]; CYLINDERS],
    x: Vec<f32>,
    y: [f32; 2],
    trial: Trial,
}

impl<C: Controller> CylinderEpisode<C> {
    /// A trial of this controller, of [`Config::inputs`] inputs and two outputs, left and right wheel.
    ///
    /// # Errors
    /// [`Error::Other`] for a controller of another shape, for none or too many cylinders, and for tables of too few
    /// sensors.
    pub fn new(config: Config, controller: C) -> Result<Self, Error> {
        let (inputs, outputs) = (controller.inputs(), controller.outputs());
        let count = config.radii.len();
        if inputs != config.inputs() || outputs != 2 {
            let wanted = config.inputs();
            return Err(Error::Other(format!(
                "discrimination: a controller of {inputs} inputs and {outputs} outputs where {wanted} and 2 are wanted"
            )));
        }
        if !(1..=CYLINDERS).contains(&count) {
            return Err(Error::Other(format!("discrimination: {count} cylinders where 1 or {CYLINDERS} are wanted")));
        }
        let wrong = |error: ChannelError| Error::Other(format!("discrimination: {error}"));
        let (robot, arena) = (config.robot.clone(), config.arena());
        let parts = arena.parts(0);
        let largest = robot.max_wheel_speed as f32;
        let speeds = WheelSpeed::new(parts.wheels, largest).map_err(wrong)?;
        Ok(Self {
            parts,
            pair: PairId(0),
            radius: robot.radius,
            cylinders: (0..count).map(|i| arena.cylinder(i)).collect(),
            infrared: Infrared::for_robot(&robot, parts.body, EYES, &config.infrared).map_err(wrong)?,
            wheel_speeds: config.wheel_speeds.then_some(speeds),
            wheels: WheelVelocity::new(parts.motors, largest).map_err(wrong)?,
            controller,
            places: [[0.0; 2]; CYLINDERS],
            x: vec![0.0; config.inputs()],
            y: [0.0; 2],
            trial: Trial::default(),
            config,
        })
    }

    /// Puts the cylinders and then the robot somewhere, each uniformly over where there is room; the heading is uniform.
    ///
    /// All is drawn from the stream of [`Domain::Start`] of the id's trial, individual and generation: every evaluation
    /// has places of its own.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries.
    pub fn arrange<W>(&mut self, world: &mut W, id: EpisodeId) -> Result<(), ArenaError>
    where
        W: Planar + Arrange + Handles<Body = BodyId, Joint = JointId>,
    {
        let Self { config, cylinders, places, .. } = self;
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        let free = |radius: f64, to_wall: f64| {
            let margin = radius + to_wall;
            let low = config.size.map(|x| margin.min(0.5 * x) as f32);
            let high = config.size.map(|x| (x - margin).max(0.5 * x) as f32);
            // The region keeps from the walls exactly; the hair's breadth is for the rounding of its ends.
            FreePlace { walls: (to_wall - 1e-6) as f32, ..FreePlace::new([low, high], radius as f32) }
        };
        world.clear();
        let mut others: [(BodyId, f32); CYLINDERS] = [(BodyId(0), 0.0); CYLINDERS];
        for (i, (&body, &radius)) in cylinders.iter().zip(&config.radii).enumerate() {
            let clear = free(radius, config.object_to_wall).clear_of(&others[..i]);
            places[i] = clear.find(world, &mut stream)?;
            world.place_body(body, Pose::planar(places[i], 0.0), Twist::default());
            world.finish_placement();
            others[i] = (body, config.object_to_object as f32);
        }
        let others = others.map(|(body, _)| (body, config.robot_to_object as f32));
        let clear = free(self.radius, config.robot_to_wall).clear_of(&others[..cylinders.len()]);
        let at = clear.find(world, &mut stream)?;
        world.place_body(self.parts.body, Pose::planar(at, stream.range(-PI, PI)), Twist::default());
        world.finish_placement();
        Ok(())
    }

    /// What the trial has earned so far: the share of all its steps near the first cylinder, less the cost of those near
    /// the other; NaN for one that failed.
    pub fn fitness(&self) -> f64 {
        let [first, other] = self.trial.near.map(f64::from);
        let steps = f64::from(self.config.steps);
        if self.trial.failed { f64::NAN } else { (first - self.config.cost * other) / steps }
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The score of the trial.
    pub fn trial(&self) -> &Trial {
        &self.trial
    }

    /// By which numbers the robot's parts are known.
    pub fn parts(&self) -> &MobileParts {
        &self.parts
    }

    /// The bodies of the cylinders, the one to stay at first.
    pub fn cylinders(&self) -> &[BodyId] {
        &self.cylinders
    }

    /// The infrared sensors.
    pub fn infrared(&self) -> &Infrared {
        &self.infrared
    }

    /// The controller.
    pub fn controller(&self) -> &C {
        &self.controller
    }

    /// The controller, for other parameters.
    pub fn controller_mut(&mut self) -> &mut C {
        &mut self.controller
    }

    /// Another controller of the same shape.
    pub fn set_controller(&mut self, controller: C) {
        debug_assert_eq!((controller.inputs(), controller.outputs()), (self.x.len(), 2), "inputs and outputs");
        self.controller = controller;
    }

    /// What was sensed last \[6, or 8 with the wheels\].
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// What was done last \[2\].
    pub fn done(&self) -> &[f32] {
        &self.y
    }
}

impl<W, C> Episode<W> for CylinderEpisode<C>
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
        self.trial = Trial { failed: self.arrange(world, id).is_err(), ..Trial::default() };
        self.controller.reset();
    }

    /// Whether there was room for everything.
    fn has_started(&self) -> bool {
        !self.trial.failed
    }

    #[inline]
    fn act(&mut self, world: &mut W) {
        let (eyes, rest) = self.x.split_at_mut(EYES);
        self.infrared.read(world, eyes);
        if let Some(speeds) = &mut self.wheel_speeds {
            speeds.read(world, rest);
        }
        self.controller.step(&self.x, &mut self.y);
        self.wheels.drive(&self.y, world);
    }

    /// Judges the step that has passed; `Some` ends the trial with the fitness that it would earn alone.
    ///
    /// The step of a collision still counts, with the robot where it was set back to.
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        let Self { config, parts, trial, .. } = self;
        let [x, y, _] = world.pose(parts.body).position;
        trial.steps += 1;
        let [left, right] = parts.wheels.map(|wheel| f64::from(world.speed(wheel)));
        for (i, radius) in config.radii.iter().enumerate() {
            let [u, v] = [x - self.places[i][0], y - self.places[i][1]].map(f64::from);
            let distance = Scalar::sqrt(u * u + v * v) - self.radius - radius;
            trial.distance[i] = distance;
            trial.failed |= !distance.is_finite();
            if distance < config.near {
                trial.near[i] += 1;
                trial.spun[i] += (right - left).abs();
            }
        }
        trial.collided = world.touches(self.pair);
        (trial.failed || trial.collided || trial.steps >= config.steps).then(|| self.fitness())
    }

    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        self.infrared.record(world.pose(self.parts.body), &self.x, recorder);
    }

    /// Records what was sensed, computed and done before the step, and what it led to.
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let Self { trial, parts, cylinders, config, .. } = self;
        let bodies = core::iter::once(parts.body).chain(cylinders.iter().copied());
        record_step(world, &self.x, &self.y, bodies, recorder);
        let mut scalars = place_and_heading(world, parts.body).to_vec();
        scalars.extend(&trial.distance[..cylinders.len()]);
        scalars.extend(wheel_speeds(&self.y, config.robot.max_wheel_speed));
        scalars.push(self.fitness());
        recorder.scalars(&scalars);
        recorder.tick(seconds(trial.steps, config.time_step));
    }
}
