//! Imitation learning from demonstrations with back-propagation through time.

use std::sync::Arc;

use farsa_lab::advanced::Iteration;
use farsa_lab::{EpisodeId, Error};
use farsa_nn::learning::{Adam, Gradient, Learner, Loss};
use farsa_nn::{Error as NetworkError, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa_num::{Domain, Scalar, Stream};

use crate::kinesthetic_grasp::demonstrator::{Demonstrator, Record};
use crate::reach_grasp_lift::config::TRIALS;
use crate::reach_grasp_lift::scene::Scene;

/// Sensor values of the sphere's place, in cm, enter learning in units of this.
const CENTIMETRES: f32 = 10.0;
/// Initial weights and biases are within plus and minus this, for such sensor values. Leaks are between 0.2 and 1.
const FIRST_WEIGHTS: f32 = 0.5;
/// Gradients with a larger norm are scaled down to it.
const MAX_GRADIENT_NORM: f64 = 1.0;

/// The parameters of the training.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Training {
    /// Number of demonstrations in an iteration. Each of them has a different start.
    pub demonstrations: u32,
    /// Number of times that an iteration uses each demonstration.
    pub epochs: u32,
    /// Number of demonstrations that contribute to a gradient step.
    pub batch: u32,
    /// Initial learning rate of Adam.
    pub rate: f64,
    /// Number of iterations after which the learning rate is reduced to one half. It is one third after twice as
    /// many iterations.
    pub half_rate: f64,
    /// Number of gradient steps over which the parameters are averaged. A value of 1 disables averaging.
    pub averaging: u32,
    /// Number of iterations after which the network controls the last demonstration of an iteration completely.
    /// With 0, the network is never mixed in.
    pub mixing: u32,
}

impl Default for Training {
    fn default() -> Self {
        Self { demonstrations: 16, epochs: 5, batch: 2, rate: 0.012, half_rate: 75.0, averaging: 800, mixing: 150 }
    }
}

/// A demonstrator, and what the learner is made of.
pub(crate) struct Trainer {
    training: Training,
    layout: LeakyLayout,
    leak: Leak,
    weight_range: f64,
    /// Divisors of the sensor values in training.
    units: Vec<f32>,
    demonstrator: Demonstrator,
    records: Vec<Record>,
}

impl Trainer {
    /// A trainer in a scene.
    ///
    /// # Errors
    /// [`Error::Other`] for a robot that cannot be built.
    pub(crate) fn new(scene: Arc<Scene>, training: Training) -> Result<Self, Error> {
        let config = &scene.config;
        let (layout, leak, weight_range) = (config.layout(), config.leak, config.weight_range);
        let label = config.label_amplitude.max(1.0) as f32;
        let units = (0..layout.sensors()).map(|j| match j {
            0..23 => 1.0,
            23..26 => CENTIMETRES,
            _ => label,
        });
        let (units, records) = (units.collect(), vec![Record::default(); training.demonstrations as usize]);
        Ok(Self { training, layout, leak, weight_range, units, demonstrator: Demonstrator::new(scene)?, records })
    }

    /// A learner that has learned nothing yet.
    fn learner(&self, seed: u64) -> Option<Learner<f64, Adam>> {
        let mut draw = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
        // Small weights keep the logistic units out of saturation, where gradients vanish. Leaks of at least 0.2 keep errors from fading
        // within few steps.
        let first = self.layout.kinds().map(|kind| {
            f64::from(if kind == LeakyParameter::Leak {
                draw.range(0.2, 1.0)
            } else {
                draw.range(-FIRST_WEIGHTS, FIRST_WEIGHTS)
            })
        });
        let learner =
            Learner::new(self.layout, self.leak, Loss::CrossEntropy, first.collect(), Adam::new(self.training.rate));
        Some(
            learner
                .ok()?
                .with_limit(self.weight_range)
                .with_max_gradient_norm(MAX_GRADIENT_NORM)
                .with_averaging(self.training.averaging),
        )
    }

    /// The initial state of learning, empty for a network that cannot be built.
    pub(crate) fn initial_state(&self, seed: u64) -> Vec<f64> {
        self.learner(seed).map_or_else(Vec::new, |learner| learner.state().collect())
    }

    /// The mean parameters of the network over the latest steps. They are last in the state of the learner.
    pub(crate) fn parameters(&self, state: &[f64]) -> Vec<f32> {
        let hidden = self.layout.hidden().max(1);
        let of_sensors = self.layout.range(LeakyParameter::SensorWeight);
        // The network learned x / unit, so a weight of x is the learned one divided by the unit.
        let unit = |index: usize| if of_sensors.contains(&index) { self.units[index / hidden] } else { 1.0 };
        // The averaged parameters are the last ones of the learner's state.
        let mean = &state[state.len().saturating_sub(self.layout.parameter_count())..];
        mean.iter().enumerate().map(|(index, p)| (p / f64::from(unit(index))) as f32).collect()
    }

    /// One iteration: demonstrations from new starts, then gradient steps, which change the state.
    ///
    /// The demonstrations of iteration g are trials 4, 5, ... of generation g. Trials 0 to 3 are run for the fitness.
    pub(crate) fn iterate(&mut self, state: &mut [f64], seed: u64, generation: u32) -> Option<Iteration> {
        let mut learner = self.learner(seed)?;
        learner.set_state(state).ok()?;
        let parameters = self.parameters(state);
        let mut squares = Gradient::new(self.layout, self.leak, Loss::SquaredError).ok()?;
        let mut network =
            LeakyNetwork::new(self.layout, self.leak, &parameters, vec![0.0; self.layout.state_len()]).ok()?;
        let Training { epochs, batch, rate, half_rate, mixing, .. } = self.training;
        // beta_g = min(1, g / mixing) is the network's share in the last demonstration of iteration g.
        let largest = match mixing {
            0 => 0.0,
            iterations => (f64::from(generation) / f64::from(iterations)).min(1.0),
        };
        // At least 1, because a single demonstration would divide 0 by 0.
        let last = (self.records.len() - 1).max(1) as f64;
        let mut successes = 0;
        for (number, record) in self.records.iter_mut().enumerate() {
            // Trial numbers above those of a test draw other displacements.
            let id = EpisodeId { seed, generation, individual: 0, trial: (TRIALS + number) as u32 };
            // From the demonstrator alone to the network's full share. Consecutive demonstrations take the four starts
            // in turn.
            let share = largest * number as f64 / last;
            self.demonstrator.roll_out(id, &mut network, share as f32, record);
            successes += u32::from(record.success);
            for x in record.x.chunks_exact_mut(self.units.len()) {
                x.iter_mut().zip(&self.units).for_each(|(x, unit)| *x /= unit);
            }
        }
        let before = error(&mut squares, &learner, &self.records).ok()?;
        // rate_g = rate / (1 + g / half_rate): half after half_rate iterations, a third after twice as many.
        learner.optimizer_mut().rate = rate / (1.0 + f64::from(generation) / half_rate);
        let mut draw = Stream::new(seed, Domain::Network, 0, 0, generation);
        for _ in 0..epochs {
            // Every epoch puts other demonstrations together.
            let mut order: Vec<usize> = (0..self.records.len()).collect();
            for end in (1..order.len()).rev() {
                // Fisher-Yates shuffle.
                order.swap(end, draw.below(end as u32 + 1) as usize);
            }
            for batch in order.chunks(batch.max(1) as usize) {
                learner.learn(batch.iter().map(|&number| self.records[number].demonstration())).ok()?;
            }
        }
        let after = error(&mut squares, &learner, &self.records).ok()?;
        for (value, new) in state.iter_mut().zip(learner.state()) {
            *value = new;
        }
        Some(Iteration { before, after, successes: f64::from(successes) / self.records.len() as f64 })
    }
}

impl farsa_lab::advanced::Learner for Trainer {
    fn initial_state(&self, seed: u64) -> Vec<f64> {
        Self::initial_state(self, seed)
    }

    fn iterate(&mut self, state: &mut [f64], seed: u64, generation: u32) -> Option<Iteration> {
        Self::iterate(self, state, seed, generation)
    }

    fn learned(&self, state: &[f64]) -> Vec<f64> {
        let value = |(p, kind): (f32, LeakyParameter)| match (kind, self.leak) {
            // As `reach-grasp-lift` reads them: |p| / range of what is decoded like a weight.
            (LeakyParameter::Leak, Leak::Evonet) => f64::from(p) * self.weight_range,
            _ => f64::from(p),
        };
        self.parameters(state).into_iter().zip(self.layout.kinds()).map(value).collect()
    }
}

/// Root of the mean squared error of motor values over all demonstrations.
fn error(squares: &mut Gradient<f64>, learner: &Learner<f64, Adam>, records: &[Record]) -> Result<f64, NetworkError> {
    let (mut sum, mut values) = (0.0, 0);
    for record in records {
        sum += squares.cost(learner.mean(), record.demonstration())?;
        values += record.wanted.len();
    }
    Ok(Scalar::sqrt(sum / values.max(1) as f64))
}
