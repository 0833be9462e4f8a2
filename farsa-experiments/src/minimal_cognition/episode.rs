//! An episode of `minimal-cognition`: one object falls, and the agent moves under it.

use farsa_evo::ObservationStatistics;
use farsa_lab::advanced::{Intervention, NormalizedController};
use farsa_lab::{EpisodeId, Error};
use farsa_nn::{Controller as _, Ctrnn};
use farsa_num::{Domain, Stream, sin_cos};

use crate::minimal_cognition::config::Config;
use crate::minimal_cognition::network::{LAYOUT, MOTORS, RAYS};
use crate::minimal_cognition::object::Object;

/// An agent under a falling object.
#[derive(Clone, Debug)]
pub struct AgentEpisode {
    config: Config,
    /// Sine and cosine of each ray's angle, clockwise from straight up.
    rays: [[f64; 2]; RAYS],
    network: NormalizedController<Ctrnn<Vec<f32>, Vec<f32>>>,
    object: Object,
    /// Where the object and the agent are on the line.
    places: [f64; 2],
    steps: u32,
    x: [f32; RAYS],
    y: [f32; MOTORS],
}

impl AgentEpisode {
    /// An episode of an agent whose network has these parameters.
    ///
    /// # Errors
    /// [`Error::Other`] for parameters that make no network.
    pub fn new(config: Config, parameters: Vec<f32>) -> Result<Self, Error> {
        let state = vec![0.0; LAYOUT.state_len()];
        let network = Ctrnn::new(LAYOUT, config.time_step as f32, parameters, state)
            .map_err(|error| Error::Other(format!("minimal-cognition: {error}")))?;
        let network = NormalizedController::new(network);
        // Whole numbers to the last product: the fan is the same to the bit on both sides.
        let angle = |ray: usize| config.fan * (2.0 * ray as f64 - (RAYS - 1) as f64) / (2 * (RAYS - 1)) as f64;
        let rays = core::array::from_fn(|ray| {
            let (sine, cosine) = sin_cos(angle(ray));
            [sine, cosine]
        });
        let object = Object::circle(config.diameter);
        Ok(Self { config, rays, network, object, places: [0.0; 2], steps: 0, x: [0.0; RAYS], y: [0.0; MOTORS] })
    }

    /// Gives the agent another network.
    ///
    /// # Errors
    /// [`Error::Other`] for parameters that make no network.
    pub fn set_parameters(&mut self, parameters: &[f32]) -> Result<(), Error> {
        let copied = self.network.controller_mut().copy_parameters(parameters);
        copied.map_err(|error| Error::Other(format!("minimal-cognition: {error}")))
    }

    /// Begins a trial: the agent in the middle and at rest, the object so far to its right.
    pub fn place(&mut self, object: Object, offset: f64) {
        (self.object, self.places, self.steps) = (object, [offset, 0.0], 0);
        (self.x, self.y) = ([0.0; RAYS], [0.0; MOTORS]);
        self.network.reset();
    }

    /// Begins the trial of an id: circles and diamonds by turns, each trial at distances in its part of the range.
    ///
    /// Distance and side are drawn in this order from the stream of [`Domain::Start`], the same for all individuals.
    pub fn arrange(&mut self, id: EpisodeId) {
        let Config { trials, offset, diameter, side, .. } = self.config;
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
        let parts = trials.div_ceil(2).max(1);
        let part = f64::from(id.trial / 2 % parts);
        let distance = offset * (part + stream.range_f64(0.0, 1.0)) / f64::from(parts);
        let object = if id.trial.is_multiple_of(2) { Object::circle(diameter) } else { Object::diamond(side) };
        let right = stream.below(2) == 1;
        self.place(object, if right { distance } else { -distance });
    }

    /// Free length of each ray.
    pub fn free(&self) -> [f64; RAYS] {
        self.free_at(self.height())
    }

    /// The same if the object were at another height.
    pub fn free_at(&self, height: f64) -> [f64; RAYS] {
        let [object, agent] = self.places;
        let Config { body, ray_length, .. } = self.config;
        self.rays.map(|[sine, cosine]| {
            let from = [agent - object + 0.5 * body * sine, 0.5 * body * cosine - height];
            self.object.meet(from, [sine, cosine]).map_or(ray_length, |distance| distance.min(ray_length))
        })
    }

    /// One step: senses, thinks, moves, and the object falls.
    pub fn step(&mut self) {
        let Config { width, time_step, ray_length, input_gain, velocity_gain, .. } = self.config;
        self.x = self.free().map(|free| (input_gain * (ray_length - free) / ray_length) as f32);
        self.network.step(&self.x, &mut self.y);
        let [right, left] = self.y.map(f64::from);
        let moved = self.places[1] + time_step * velocity_gain * (right - left);
        self.places[1] = moved.clamp(-0.5 * width, 0.5 * width);
        self.steps += 1;
    }

    /// True if the object has come down.
    pub fn ended(&self) -> bool {
        self.steps >= self.config.steps()
    }

    /// Height of the object's center above the agent's.
    pub fn height(&self) -> f64 {
        let Config { start_height, speed, time_step, .. } = self.config;
        start_height - f64::from(self.steps) * speed * time_step
    }

    /// Horizontal distance between the centers.
    pub fn distance(&self) -> f64 {
        (self.places[1] - self.places[0]).abs()
    }

    /// The reward if the trial ends now, 0 to 1.
    pub fn score(&self) -> f64 {
        let part = (self.distance() / self.config.clip).min(1.0);
        match self.object {
            Object::Circle { .. } => 1.0 - part,
            Object::Diamond { .. } => part,
        }
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The parameters of the network, in the order of [`LAYOUT`].
    pub fn parameters(&self) -> &[f32] {
        self.network.controller().parameters()
    }

    /// The network.
    pub fn network(&self) -> &Ctrnn<Vec<f32>, Vec<f32>> {
        self.network.controller()
    }

    /// Normalizes observations by earlier ones, or not at all. Returns false for statistics of other channels.
    pub fn normalise(&mut self, before: Option<&ObservationStatistics>) -> bool {
        self.network.load(before)
    }

    /// Changes inputs and neurons of the network until the next normalization of observations.
    pub(crate) fn intervene(&mut self, intervention: &Intervention, id: EpisodeId) {
        self.network.intervene(intervention, id, 0);
    }

    /// The observations since [`normalise`](Self::normalise), if they are normalized.
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.network.observed()
    }

    /// The falling object.
    pub fn object(&self) -> Object {
        self.object
    }

    /// Where the object and the agent are on the line.
    pub fn places(&self) -> [f64; 2] {
        self.places
    }

    /// Steps taken.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// The sines and cosines of the rays' angles, clockwise from straight up.
    pub fn rays(&self) -> &[[f64; 2]; RAYS] {
        &self.rays
    }

    /// The last inputs \[7\].
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// The last outputs of the motor neurons \[2\].
    pub fn done(&self) -> &[f32] {
        &self.y
    }
}
