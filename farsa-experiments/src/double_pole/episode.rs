//! Episodes of `double-pole`, in which a network pushes the cart until a pole falls.

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

/// A trial in which a network balances the two poles on the cart.
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
    /// Creates an episode for a network with the given parameters. It starts in the initial state of the configuration.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the parameters are invalid.
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

    /// Replaces the parameters of the network.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the parameters are invalid.
    pub fn set_parameters(&mut self, parameters: &[f32]) -> Result<(), Error> {
        let copied = self.network.controller_mut().copy_parameters(parameters);
        copied.map_err(|error| Error::Other(format!("double-pole: {error}")))
    }

    /// Changes inputs and neurons of the network until the next normalization of observations.
    pub(crate) fn intervene(&mut self, intervention: &Intervention, id: EpisodeId) {
        self.network.intervene(intervention, id, 0);
    }

    /// Starts a trial in the given state and resets the network.
    pub fn place(&mut self, state: CartState) {
        (self.state, self.steps, self.fallen) = (state, 0, false);
        self.unrest.fill(0.0);
        self.x.fill(0.0);
        (self.y, self.force) = ([0.0], 0.0);
        self.network.reset();
    }

    /// Performs one step of the network and applies the resulting force to the cart.
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
        // With a positive `least_force`, output 0 pushes to the positive side. No network can leave the cart alone.
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
            // Slot steps % 100 is overwritten up to step 1000, so the buffer ends with steps 901 to 1000.
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

    /// Returns true if both poles are upright and the cart is still on its track.
    pub fn in_balance(&self) -> bool {
        let most = Config::radians(self.config.most_angle);
        self.state.position.abs() <= self.config.most_position && self.state.angles.iter().all(|a| a.abs() <= most)
    }

    /// Returns true if the trial is over, either because the cart lost its balance or because it reached the maximum
    /// number of steps.
    pub fn ended(&self) -> bool {
        self.fallen || self.steps >= self.config.steps
    }

    /// Returns true if the poles were balanced until the end of the trial.
    pub fn succeeded(&self) -> bool {
        !self.fallen && self.steps >= self.config.steps
    }

    /// Returns the two terms of the damping fitness for balance and rest, with their weights, as if the trial ended
    /// now.
    ///
    /// Source: \[Gruau1996\] as in \[Gomez2008\] section 5.5.2. Deviation: the sum is over 100 steps, although the
    /// limits given in the source would make it 101.
    pub fn damping(&self) -> [f64; 2] {
        let steps = self.steps.min(DAMPED);
        let sum: f64 = self.unrest.iter().sum();
        // 0.75 / sum of |x| + |v| + |a| + |w|. The bound of 1e-9 keeps the quotient finite for a cart at rest.
        let rest = if steps < LAST { 0.0 } else { 0.75 / sum.max(1e-9) };
        [0.1 * f64::from(steps) / f64::from(DAMPED), 0.9 * rest]
    }

    /// Gets the configuration of the episode.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Returns the network that controls the cart.
    pub fn network(&self) -> &BlockNetwork<'static, Vec<f32>, Vec<f32>> {
        self.network.controller()
    }

    /// Normalizes the inputs of the network with earlier statistics, or disables normalization for `None`. Returns
    /// `false` if the statistics have a different number of channels.
    pub fn normalise(&mut self, before: Option<&ObservationStatistics>) -> bool {
        self.network.load(before)
    }

    /// Returns the statistics of the inputs since the last call of [`normalise`](Self::normalise), or `None` if
    /// normalization is disabled.
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.network.observed()
    }

    /// Gets the current state of the cart and the poles.
    pub fn state(&self) -> &CartState {
        &self.state
    }

    /// Gets the number of steps for which the poles have been balanced.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Gets the inputs of the last step. The position and the two angles come first, followed by the velocities if
    /// the network receives them.
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// Gets the output of the network in the last step.
    pub fn output(&self) -> &[f32] {
        &self.y
    }

    /// Gets the force that was applied to the cart in the last step (in newtons).
    pub fn force(&self) -> f64 {
        self.force
    }
}

impl Config {
    /// Returns the initial state of a trial.
    pub fn start(&self) -> CartState {
        CartState { angles: [Self::radians(self.angle), 0.0], ..CartState::default() }
    }

    /// Returns the 625 initial states of the generalization test of \[Gruau1996\].
    ///
    /// The position and velocity of the cart and the angle and angular velocity of the first pole each take five
    /// values. These values are at 0.05, 0.25, 0.5, 0.75 and 0.95 of the range. The ranges extend to 2.16 m, 1.35 m/s,
    /// 3.6 deg and 8.6 deg/s in both directions.
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
