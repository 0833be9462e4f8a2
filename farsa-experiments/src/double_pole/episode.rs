//! An episode of `double-pole`: a network pushes the cart until a pole falls.

use farsa_evo::ObservationStatistics;
use farsa_lab::advanced::{Intervention, NormalizedController};
use farsa_lab::{EpisodeId, Error};
use farsa_nn::block::BlockNetwork;
use farsa_nn::{Controller as _, Leak};

use crate::double_pole::cart::CartState;
use crate::double_pole::config::Config;
use crate::double_pole::network::layout;

/// Steps over which the damping fitness is taken.
const DAMPED: u32 = 1000;
/// The number of last steps in the sum of positions and velocities.
const LAST: u32 = 100;

/// A cart with two poles and the network that pushes it.
#[derive(Clone, Debug)]
pub struct CartEpisode {
    config: Config,
    network: NormalizedController<BlockNetwork<'static, Vec<f32>, Vec<f32>>>,
    state: CartState,
    steps: u32,
    fallen: bool,
    /// Distance of cart and first pole from rest after each of the last 100 of the first 1000 steps.
    unrest: [f64; LAST as usize],
    x: Vec<f32>,
    y: [f32; 1],
    force: f64,
}

impl CartEpisode {
    /// An episode of a network with these parameters, at the start of the configuration.
    ///
    /// # Errors
    /// [`Error::Other`] for parameters that make no network.
    pub fn new(config: Config, parameters: Vec<f32>) -> Result<Self, Error> {
        let layout = layout(config.velocities, config.hidden);
        let network = BlockNetwork::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len()])
            .map_err(|error| Error::Other(format!("double-pole: {error}")))?;
        let network = NormalizedController::new(network);
        let (unrest, x) = ([0.0; LAST as usize], vec![0.0; config.inputs()]);
        let state = CartState::default();
        let mut episode = Self { config, network, state, steps: 0, fallen: false, unrest, x, y: [0.0], force: 0.0 };
        episode.place(config.start());
        Ok(episode)
    }

    /// Gives the cart another network.
    ///
    /// # Errors
    /// [`Error::Other`] for parameters that make no network.
    pub fn set_parameters(&mut self, parameters: &[f32]) -> Result<(), Error> {
        let copied = self.network.controller_mut().copy_parameters(parameters);
        copied.map_err(|error| Error::Other(format!("double-pole: {error}")))
    }

    /// Changes inputs and neurons of the network until the next normalization of observations.
    pub(crate) fn intervene(&mut self, intervention: &Intervention, id: EpisodeId) {
        self.network.intervene(intervention, id, 0);
    }

    /// Begins a trial at a state, with the network at rest.
    pub fn place(&mut self, state: CartState) {
        (self.state, self.steps, self.fallen) = (state, 0, false);
        self.unrest.fill(0.0);
        self.x.fill(0.0);
        (self.y, self.force) = ([0.0], 0.0);
        self.network.reset();
    }

    /// One step: senses, thinks, pushes, and the poles move.
    pub fn step(&mut self) {
        let Config { cart, time_step, substeps, force, least_force, scales, velocities, .. } = self.config;
        let CartState { position, velocity, angles, angular_velocities } = self.state;
        let [of_position, of_angle, of_velocity] = scales;
        let places = [position / of_position, angles[0] / of_angle, angles[1] / of_angle];
        let speeds = [velocity / of_velocity, angular_velocities[0] / of_velocity, angular_velocities[1] / of_velocity];
        let sensed = places.into_iter().chain(speeds.into_iter().filter(|_| velocities));
        for (x, sensed) in self.x.iter_mut().zip(sensed) {
            *x = sensed as f32;
        }
        self.network.step(&self.x, &mut self.y);
        let push = force * f64::from(self.y[0]);
        self.force = if push.abs() >= least_force {
            push
        } else if push < 0.0 {
            -least_force
        } else {
            least_force
        };
        for _ in 0..substeps {
            self.state = cart.step(&self.state, self.force, time_step);
        }
        if self.in_balance() {
            if self.steps < DAMPED {
                let CartState { position, velocity, angles, angular_velocities } = self.state;
                let unrest = position.abs() + velocity.abs() + angles[0].abs() + angular_velocities[0].abs();
                self.unrest[(self.steps % LAST) as usize] = unrest;
            }
            self.steps += 1;
        } else {
            self.fallen = true;
        }
    }

    /// True if no pole has fallen and the cart is on its track.
    pub fn in_balance(&self) -> bool {
        let most = Config::radians(self.config.most_angle);
        self.state.position.abs() <= self.config.most_position && self.state.angles.iter().all(|a| a.abs() <= most)
    }

    /// True if a pole has fallen, the cart has left its track, or the time is over.
    pub fn ended(&self) -> bool {
        self.fallen || self.steps >= self.config.steps
    }

    /// True if the time is over and no pole has fallen.
    pub fn succeeded(&self) -> bool {
        !self.fallen && self.steps >= self.config.steps
    }

    /// The two terms of the damping fitness if the trial ends now, for balance and for rest, with their weights.
    ///
    /// Source: \[Gruau1996\] as in \[Gomez2008\] section 5.5.2. Deviation: the sum is over 100 steps, which its limits make 101.
    pub fn damping(&self) -> [f64; 2] {
        let steps = self.steps.min(DAMPED);
        let sum: f64 = self.unrest.iter().sum();
        let rest = if steps < LAST { 0.0 } else { 0.75 / sum.max(1e-9) };
        [0.1 * f64::from(steps) / f64::from(DAMPED), 0.9 * rest]
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The network.
    pub fn network(&self) -> &BlockNetwork<'static, Vec<f32>, Vec<f32>> {
        self.network.controller()
    }

    /// Normalizes observations by earlier ones, or not at all. Returns false for statistics of other channels.
    pub fn normalise(&mut self, before: Option<&ObservationStatistics>) -> bool {
        self.network.load(before)
    }

    /// The observations since [`normalise`](Self::normalise), if they are normalized.
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.network.observed()
    }

    /// Where cart and poles are.
    pub fn state(&self) -> &CartState {
        &self.state
    }

    /// Steps in balance so far.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// The last inputs: position and angles, then velocities [3 or 6].
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// The last output of the network \[1\].
    pub fn output(&self) -> &[f32] {
        &self.y
    }

    /// The force that the cart was pushed with last \[N\].
    pub fn force(&self) -> f64 {
        self.force
    }
}

impl Config {
    /// The state that trials start from.
    pub fn start(&self) -> CartState {
        CartState { angles: [Self::radians(self.angle), 0.0], ..CartState::default() }
    }

    /// The 625 starts of the generalization test of \[Gruau1996\]. Position and velocity of the cart, angle and angular velocity of
    /// the first pole have 0.05, 0.25, 0.5, 0.75 and 0.95 of their ranges. The ranges are plus and minus 2.16 m, 1.35 m/s, 3.6 deg
    /// and 8.6 deg/s.
    pub fn generalization_starts() -> impl Iterator<Item = CartState> {
        let at = |place: u32, half: f64| half * (2.0 * [0.05, 0.25, 0.5, 0.75, 0.95][place as usize % 5] - 1.0);
        (0..625).map(move |number| CartState {
            position: at(number / 125, 2.16),
            velocity: at(number / 25, 1.35),
            angles: [at(number / 5, Self::radians(3.6)), 0.0],
            angular_velocities: [at(number, Self::radians(8.6)), 0.0],
        })
    }
}
