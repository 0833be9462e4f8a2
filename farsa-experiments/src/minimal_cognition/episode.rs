//! Episodes of `minimal-cognition`, in which an object falls toward the agent.

use farsa_evo::ObservationStatistics;
use farsa_lab::advanced::{Intervention, NormalizedController};
use farsa_lab::{EpisodeId, Error};
use farsa_nn::{Controller as _, Ctrnn};
use farsa_num::{Domain, Stream, sin_cos};

use crate::minimal_cognition::config::Config;
use crate::minimal_cognition::network::{LAYOUT, MOTORS, RAYS};
use crate::minimal_cognition::object::Object;

/// A trial with one falling object.
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
    /// Creates an episode for an agent whose network has the given parameters.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the parameters are invalid.
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

    /// Replaces the parameters of the network.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the parameters are invalid.
    pub fn set_parameters(&mut self, parameters: &[f32]) -> Result<(), Error> {
        let copied = self.network.controller_mut().copy_parameters(parameters);
        copied.map_err(|error| Error::Other(format!("minimal-cognition: {error}")))
    }

    /// Starts a trial. The agent is at rest in the middle of the line, and the object is `offset` to the right of it.
    pub fn place(&mut self, object: Object, offset: f64) {
        (self.object, self.places, self.steps) = (object, [offset, 0.0], 0);
        (self.x, self.y) = ([0.0; RAYS], [0.0; MOTORS]);
        self.network.reset();
    }

    /// Starts the trial with the given identifier. Circles and diamonds alternate, and each trial draws the distance
    /// from a different part of the range.
    ///
    /// The distance and then the side are drawn from the stream of [`Domain::Start`]. They are the same for all
    /// individuals of a generation.
    pub fn arrange(&mut self, id: EpisodeId) {
        let Config { trials, offset, diameter, side, .. } = self.config;
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
        // Stratified draws. Trials 2 k and 2 k + 1 share part k of [0, offset], the first with a circle and the second
        // with a diamond.
        let parts = trials.div_ceil(2).max(1);
        let part = f64::from(id.trial / 2 % parts);
        let distance = offset * (part + stream.range_f64(0.0, 1.0)) / f64::from(parts);
        let object = if id.trial.is_multiple_of(2) { Object::circle(diameter) } else { Object::diamond(side) };
        let right = stream.below(2) == 1;
        self.place(object, if right { distance } else { -distance });
    }

    /// Returns the free length of each ray.
    pub fn free(&self) -> [f64; RAYS] {
        self.free_at(self.height())
    }

    /// Returns the free length of each ray for an object at a different height.
    pub fn free_at(&self, height: f64) -> [f64; RAYS] {
        let [object, agent] = self.places;
        let Config { body, ray_length, .. } = self.config;
        self.rays.map(|[sine, cosine]| {
            // Rays start on the circular hull of the agent. Coordinates are relative to the center of the object.
            let from = [agent - object + 0.5 * body * sine, 0.5 * body * cosine - height];
            self.object.meet(from, [sine, cosine]).map_or(ray_length, |distance| distance.min(ray_length))
        })
    }

    /// Performs one step of the network and moves the agent and the object.
    pub fn step(&mut self) {
        let Config { width, time_step, ray_length, input_gain, velocity_gain, .. } = self.config;
        // I = g (L - l) / L, which is 0 for a free ray of length L and g for an object at the hull.
        self.x = self.free().map(|free| (input_gain * (ray_length - free) / ray_length) as f32);
        self.network.step(&self.x, &mut self.y);
        let [right, left] = self.y.map(f64::from);
        // Equal outputs cancel, so the agent is at rest without a difference between its motors.
        let moved = self.places[1] + time_step * velocity_gain * (right - left);
        self.places[1] = moved.clamp(-0.5 * width, 0.5 * width);
        self.steps += 1;
    }

    /// Returns true if the object has reached the height at which a trial ends.
    pub fn ended(&self) -> bool {
        self.steps >= self.config.steps()
    }

    /// Computes the height of the center of the object above the center of the agent.
    pub fn height(&self) -> f64 {
        let Config { start_height, speed, time_step, .. } = self.config;
        // Computed from the number of steps, so that rounding does not accumulate over a trial.
        start_height - f64::from(self.steps) * speed * time_step
    }

    /// Returns the horizontal distance between the two centers.
    pub fn distance(&self) -> f64 {
        (self.places[1] - self.places[0]).abs()
    }

    /// Computes the reward as if the trial ended now. It is between 0 and 1.
    pub fn score(&self) -> f64 {
        let part = (self.distance() / self.config.clip).min(1.0);
        match self.object {
            Object::Circle { .. } => 1.0 - part,
            Object::Diamond { .. } => part,
        }
    }

    /// Gets the configuration of the episode.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Returns the parameters of the network, in the order of [`LAYOUT`].
    pub fn parameters(&self) -> &[f32] {
        self.network.controller().parameters()
    }

    /// Returns the network that controls the agent.
    pub fn network(&self) -> &Ctrnn<Vec<f32>, Vec<f32>> {
        self.network.controller()
    }

    /// Normalizes the inputs of the network with earlier statistics, or disables normalization for `None`. Returns
    /// `false` if the statistics have a different number of channels.
    pub fn normalise(&mut self, before: Option<&ObservationStatistics>) -> bool {
        self.network.load(before)
    }

    /// Changes inputs and neurons of the network until the next normalization of observations.
    pub(crate) fn intervene(&mut self, intervention: &Intervention, id: EpisodeId) {
        self.network.intervene(intervention, id, 0);
    }

    /// Returns the statistics of the inputs since the last call of [`normalise`](Self::normalise), or `None` if
    /// normalization is disabled.
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.network.observed()
    }

    /// Gets the falling object.
    pub fn object(&self) -> Object {
        self.object
    }

    /// Gets the positions of the object and of the agent along the line.
    pub fn places(&self) -> [f64; 2] {
        self.places
    }

    /// Gets the number of steps that have been completed.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Gets the sine and the cosine of the angle of each ray. Angles are measured clockwise from the upward
    /// direction.
    pub fn rays(&self) -> &[[f64; 2]; RAYS] {
        &self.rays
    }

    /// Gets the seven inputs of the last step.
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// Gets the outputs of the two motor neurons in the last step.
    pub fn done(&self) -> &[f32] {
        &self.y
    }
}
