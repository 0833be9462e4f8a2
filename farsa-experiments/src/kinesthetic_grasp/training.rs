//! Lessons: the arm is led, and a network learns by back-propagation through time what its motors should have done.

use std::sync::Arc;

use farsa_lab::{EpisodeId, Error, Lesson};
use farsa_nn::{Adam, Error as NetworkError, Gradient, Leak, LeakyLayout, LeakyNetwork, LeakyParameter, Learner, Loss};
use farsa_num::{Domain, Scalar, Stream};

use crate::kinesthetic_grasp::demonstrator::{Record, Teacher};
use crate::reach_grasp_lift::config::TRIALS;
use crate::reach_grasp_lift::scene::Scene;

/// Sensor values of the sphere's place, in cm, enter learning in units of this.
const CENTIMETRES: f32 = 10.0;
/// Weights and biases begin within plus and minus this, for such sensor values; leaks between 0.2 and 1.
const FIRST_WEIGHTS: f32 = 0.5;
/// The longest gradient that is followed as it is.
const LONGEST: f64 = 1.0;

/// How lessons are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lessons {
    /// Times that the arm is led in a lesson, each from another start.
    pub demonstrations: u32,
    /// Times that all of them are gone through.
    pub passes: u32,
    /// Demonstrations of a step of learning.
    pub batch: u32,
    /// Size of a step of learning, of Adam.
    pub rate: f64,
    /// Lessons after which that is half, and a third after twice as many.
    pub half_rate: f64,
    /// Steps of learning over which parameters are averaged for lives; 1 for the latest ones as they are.
    pub mean: u32,
    /// Lessons until the network has its full say while it is led; 0 if it never has any.
    pub own_say: u32,
}

impl Default for Lessons {
    fn default() -> Self {
        Self { demonstrations: 16, passes: 5, batch: 2, rate: 0.012, half_rate: 75.0, mean: 800, own_say: 150 }
    }
}

/// A teacher, and what its pupil is made of.
pub(crate) struct School {
    lessons: Lessons,
    layout: LeakyLayout,
    leak: Leak,
    weight_range: f64,
    /// What each sensor value is divided by before it is learned from.
    units: Vec<f32>,
    teacher: Teacher,
    records: Vec<Record>,
}

impl School {
    /// A school in a scene.
    ///
    /// # Errors
    /// [`Error::Other`] for a robot that cannot be built.
    pub(crate) fn new(scene: Arc<Scene>, lessons: Lessons) -> Result<Self, Error> {
        let config = &scene.config;
        let (layout, leak, weight_range) = (config.layout(), config.leak, config.weight_range);
        let label = config.label_amplitude.max(1.0) as f32;
        let units = (0..layout.sensors()).map(|j| match j {
            0..23 => 1.0,
            23..26 => CENTIMETRES,
            _ => label,
        });
        let (units, records) = (units.collect(), vec![Record::default(); lessons.demonstrations as usize]);
        Ok(Self { lessons, layout, leak, weight_range, units, teacher: Teacher::new(scene)?, records })
    }

    /// A pupil that knows nothing yet.
    fn pupil(&self, seed: u64) -> Option<Learner<f64, Adam>> {
        let mut draw = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
        let first = self.layout.kinds().map(|kind| {
            f64::from(if kind == LeakyParameter::Leak {
                draw.range(0.2, 1.0)
            } else {
                draw.range(-FIRST_WEIGHTS, FIRST_WEIGHTS)
            })
        });
        let pupil =
            Learner::new(self.layout, self.leak, Loss::CrossEntropy, first.collect(), Adam::new(self.lessons.rate));
        Some(
            pupil.ok()?.with_limit(self.weight_range).with_max_gradient_norm(LONGEST).with_averaging(self.lessons.mean),
        )
    }

    /// The words that learning starts from; none for a network that cannot be.
    pub(crate) fn first_words(&self, seed: u64) -> Vec<f64> {
        self.pupil(seed).map_or_else(Vec::new, |pupil| pupil.words().collect())
    }

    /// The network's parameters that stand last in the words of its pupil: their mean over the latest steps.
    pub(crate) fn parameters(&self, words: &[f64]) -> Vec<f32> {
        let hidden = self.layout.hidden().max(1);
        let of_sensors = self.layout.range(LeakyParameter::SensorWeight);
        let unit = |index: usize| if of_sensors.contains(&index) { self.units[index / hidden] } else { 1.0 };
        let mean = &words[words.len().saturating_sub(self.layout.parameter_count())..];
        mean.iter().enumerate().map(|(index, p)| (p / f64::from(unit(index))) as f32).collect()
    }

    /// The genes that come nearest to these parameters.
    pub(crate) fn genes(&self, words: &[f64]) -> Vec<u16> {
        let range = self.weight_range;
        let gene = |(p, kind): (f32, LeakyParameter)| {
            let p = f64::from(p);
            let share = match (kind, self.leak) {
                // As `reach-grasp-lift` decodes them: |p| / range of what is decoded like a weight.
                (LeakyParameter::Leak, Leak::Evonet) => 0.5 * (1.0 + p),
                (LeakyParameter::Leak, _) => p,
                _ => 0.5 * (1.0 + p / range),
            };
            (share * f64::from(u16::MAX)).round_small() as u16
        };
        self.parameters(words).into_iter().zip(self.layout.kinds()).map(gene).collect()
    }

    /// One lesson: the arm is led from new starts, and the words change by what there was to learn.
    ///
    /// The demonstrations of lesson g are trials 4, 5, ... of generation g; those that are lived for the fitness are 0 to 3.
    pub(crate) fn lesson(&mut self, words: &mut [f64], seed: u64, generation: u32) -> Option<Lesson> {
        let mut pupil = self.pupil(seed)?;
        pupil.set_words(words).ok()?;
        let parameters = self.parameters(words);
        let mut squares = Gradient::new(self.layout, self.leak, Loss::SquaredError).ok()?;
        let mut network =
            LeakyNetwork::new(self.layout, self.leak, &parameters, vec![0.0; self.layout.state_len()]).ok()?;
        let Lessons { passes, batch, rate, half_rate, own_say, .. } = self.lessons;
        let most = match own_say {
            0 => 0.0,
            lessons => (f64::from(generation) / f64::from(lessons)).min(1.0),
        };
        let last = (self.records.len() - 1).max(1) as f64;
        let mut successes = 0;
        for (number, record) in self.records.iter_mut().enumerate() {
            let id = EpisodeId { seed, generation, individual: 0, trial: (TRIALS + number) as u32 };
            // From the teacher's alone to the network's full share. Consecutive demonstrations take the four starts in turn.
            let share = most * number as f64 / last;
            self.teacher.lead(id, &mut network, share as f32, record);
            successes += u32::from(record.success);
            for x in record.x.chunks_exact_mut(self.units.len()) {
                x.iter_mut().zip(&self.units).for_each(|(x, unit)| *x /= unit);
            }
        }
        let before = error(&mut squares, &pupil, &self.records).ok()?;
        pupil.optimizer_mut().rate = rate / (1.0 + f64::from(generation) / half_rate);
        let mut draw = Stream::new(seed, Domain::Network, 0, 0, generation);
        for _ in 0..passes {
            // Every pass puts other demonstrations together.
            let mut order: Vec<usize> = (0..self.records.len()).collect();
            for end in (1..order.len()).rev() {
                order.swap(end, draw.below(end as u32 + 1) as usize);
            }
            for batch in order.chunks(batch.max(1) as usize) {
                pupil.learn(batch.iter().map(|&number| self.records[number].demonstration())).ok()?;
            }
        }
        let after = error(&mut squares, &pupil, &self.records).ok()?;
        for (word, new) in words.iter_mut().zip(pupil.words()) {
            *word = new;
        }
        Some(Lesson { before, after, successes: f64::from(successes) / self.records.len() as f64 })
    }
}

impl farsa_lab::Learner for School {
    fn first_words(&self, seed: u64) -> Vec<f64> {
        Self::first_words(self, seed)
    }

    fn lesson(&mut self, words: &mut [f64], seed: u64, generation: u32) -> Option<Lesson> {
        Self::lesson(self, words, seed, generation)
    }

    fn learned(&self, words: &[f64]) -> Vec<u16> {
        self.genes(words)
    }
}

/// Root of the mean squared error of motor values over all demonstrations.
fn error(squares: &mut Gradient<f64>, pupil: &Learner<f64, Adam>, records: &[Record]) -> Result<f64, NetworkError> {
    let (mut sum, mut values) = (0.0, 0);
    for record in records {
        sum += squares.cost(pupil.mean(), record.demonstration())?;
        values += record.wanted.len();
    }
    Ok(Scalar::sqrt(sum / values.max(1) as f64))
}
