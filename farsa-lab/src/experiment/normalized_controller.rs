//! A controller whose observations are normalised.

use farsa_evo::ObservationStatistics;
use farsa_nn::{Ablatable, Controller, Lesion};
use farsa_num::{Domain, Stream};

use crate::experiment::episode::EpisodeId;
use crate::experiment::intervention::Intervention;

/// Most that a normalized observation is away from 0, in standard deviations.
pub(crate) const LIMIT: f32 = 10.0;

/// A controller whose observations can be normalized by the mean and the deviation of earlier ones.
///
/// If an evaluation has statistics, new statistics are collected as well. Pass [`observed`](Self::observed) to
/// [`Outcome::observed`](crate::Outcome::observed) in this case. Without statistics, every bit of the controller's
/// output is unchanged.
///
/// Source: V2 of \[Mania2018\] algorithm 1. As there, nothing is changed before there are two observations.
/// Deviations: those of [`ObservationStatistics`], and a limit of 10 standard deviations.
///
/// ```
/// use farsa_evo::ObservationStatistics;
/// use farsa_lab::advanced::NormalizedController;
/// use farsa_nn::{Controller, Perceptron};
///
/// let mut control = NormalizedController::new(Perceptron::new(1, 1, 1.0, [1.0, 0.0])?);
/// let mut before = ObservationStatistics::new(1)?;
/// for x in [190.0, 210.0] {
///     before.push(&[x]);
/// }
/// let mut y = [0.0];
/// assert!(control.load(Some(&before)));
/// control.step(&[200.0], &mut y);
/// assert_eq!(y, [0.5]); // the mean, 200, is 0 for the perceptron
/// assert_eq!(control.observed().map(|observed| observed.mean()), Some(&[200.0][..]));
///
/// assert!(control.load(None));
/// control.step(&[200.0], &mut y);
/// assert!(y[0] > 0.99 && control.observed().is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct NormalizedController<C> {
    controller: C,
    /// Statistics of earlier observations, and since [`load`](Self::load). None without normalization.
    statistics: Option<[ObservationStatistics; 2]>,
    x: Vec<f32>,
    /// Change of the controller in a test.
    changed: Option<Changed<C>>,
}

/// An intervention in its course.
#[derive(Clone, Debug)]
struct Changed<C> {
    intervention: Intervention,
    noise: Stream,
    step: StepAblated<C>,
}

/// [`Ablatable::step_ablated`], which not every controller has.
type StepAblated<C> = fn(&mut C, &[Lesion], &[f32], &mut [f32]);

impl<C> Changed<C> {
    /// Senses with noise and holds inputs, `x` being normalised already, and computes with neurons held.
    fn step(&mut self, controller: &mut C, x: &mut [f32], y: &mut [f32]) {
        let Intervention { lesions, inputs, noise, .. } = &self.intervention;
        if *noise > 0.0 {
            for x in &mut *x {
                *x += self.noise.range(-*noise, *noise);
            }
        }
        for (inputs, value) in inputs {
            let end = inputs.end.min(x.len());
            x[inputs.start.min(end)..end].fill(*value);
        }
        (self.step)(controller, lesions, x, y);
    }
}

impl<C: Controller> NormalizedController<C> {
    /// Wraps a controller. At first its observations are not normalized.
    pub fn new(controller: C) -> Self {
        let x = vec![0.0; controller.inputs()];
        Self { controller, statistics: None, x, changed: None }
    }

    /// Loads statistics of earlier observations, if there are any. This discards the collected statistics, and
    /// removes any intervention.
    ///
    /// If the number of channels is wrong, this returns `false` and keeps the statistics as they are.
    pub fn load(&mut self, before: Option<&ObservationStatistics>) -> bool {
        self.changed = None;
        let Some(before) = before else {
            self.statistics = None;
            return true;
        };
        let (true, Ok(since)) = (before.channels() == self.x.len(), ObservationStatistics::new(self.x.len())) else {
            return false;
        };
        self.statistics = Some([before.clone(), since]);
        true
    }

    /// Gets the statistics of raw observations since [`load`](Self::load). This is `None` unless observations are
    /// normalized.
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.statistics.as_ref().map(|[_, since]| since)
    }

    /// Changes inputs and neurons until the next [`load`](Self::load). Parameters are not changed, so you need to
    /// apply [`Intervention::edited`] yourself.
    ///
    /// The noise is drawn from the stream of [`Domain::Network`] of the episode and the robot's number, from 0. It is
    /// the same in every case of a protocol. Noise and held inputs are applied after normalization, and are not part
    /// of [`observed`](Self::observed).
    pub fn intervene(&mut self, intervention: &Intervention, id: EpisodeId, robot: u32)
    where
        C: Ablatable,
    {
        let EpisodeId { seed, generation, individual, trial } = id;
        self.changed = (*intervention != Intervention::default()).then(|| Changed {
            intervention: intervention.clone(),
            noise: Stream::new(seed, Domain::Network, trial, individual.wrapping_add(robot << 16), generation),
            step: C::step_ablated,
        });
    }

    /// Gets the controller.
    pub fn controller(&self) -> &C {
        &self.controller
    }

    /// Gets a mutable reference to the controller. You need it to load other parameters.
    pub fn controller_mut(&mut self) -> &mut C {
        &mut self.controller
    }
}

impl<C: Controller> Controller for NormalizedController<C> {
    fn inputs(&self) -> usize {
        self.controller.inputs()
    }

    fn outputs(&self) -> usize {
        self.controller.outputs()
    }

    /// Resets the controller. The collected statistics stay.
    fn reset(&mut self) {
        self.controller.reset();
    }

    #[inline]
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let Self { controller, statistics, x: own, changed } = self;
        let mut normalised = false;
        if let Some([before, since]) = statistics {
            since.push(x);
            // One observation has no deviation.
            if before.count() >= 2 {
                own.copy_from_slice(x);
                before.normalize(own, LIMIT);
                normalised = true;
            }
        }
        match changed {
            None if normalised => controller.step(own, y),
            None => controller.step(x, y),
            Some(changed) => {
                if !normalised {
                    own.copy_from_slice(x);
                }
                changed.step(controller, own, y);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_nn::{Leak, LeakyLayout, LeakyNetwork};

    /// Two inputs, two hidden neurons, one output. All weights are 1.
    fn network() -> NormalizedController<LeakyNetwork<Vec<f32>, Vec<f32>>> {
        let layout = LeakyLayout::new(2, 2, 1);
        let (parameters, state) = (vec![1.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
        NormalizedController::new(LeakyNetwork::new(layout, Leak::Filter, parameters, state).unwrap())
    }

    fn response(control: &mut NormalizedController<LeakyNetwork<Vec<f32>, Vec<f32>>>, x: [f32; 2]) -> Vec<f32> {
        control.reset();
        let mut y = [0.0];
        (0..5)
            .map(|_| {
                control.step(&x, &mut y);
                y[0]
            })
            .collect()
    }

    #[test]
    fn interventions_cut_silence_and_disturb_until_the_next_evaluation() {
        let mut control = network();
        let id = EpisodeId { seed: 7, trial: 3, ..EpisodeId::default() };
        let intact = response(&mut control, [0.5, 0.9]);
        // A cut input is one that senses nothing.
        control.intervene(&Intervention::cut(1..2), id, 0);
        let cut = response(&mut control, [0.5, 0.9]);
        control.intervene(&Intervention::default(), id, 0);
        assert_eq!((&response(&mut control, [0.5, 0.0]), &response(&mut control, [0.5, 0.9])), (&cut, &intact));
        assert_ne!(cut, intact);
        // With all hidden neurons silent the output has only its own sum: half of the range for any input.
        let silent = Intervention { lesions: vec![Lesion::new(0), Lesion::new(1)], ..Intervention::default() };
        control.intervene(&silent, id, 0);
        assert_eq!(response(&mut control, [0.5, 0.9]), [0.5; 5]);
        control.intervene(&Intervention::lesion(0), id, 0);
        let one = response(&mut control, [0.5, 0.9]);
        assert!(one.iter().zip(&intact).all(|(one, all)| *one > 0.5 && one < all), "{one:?} {intact:?}");
        // Noise: the same for the same episode, another for another or another robot, and none of level 0.
        let mut noisy = |level: f32, id: EpisodeId, robot: u32| {
            control.intervene(&Intervention::noise(level), id, robot);
            response(&mut control, [0.5, 0.9])
        };
        let first = noisy(0.3, id, 0);
        assert!(first != intact && first == noisy(0.3, id, 0) && noisy(0.0, id, 0) == intact);
        assert!(first != noisy(0.3, EpisodeId { trial: 4, ..id }, 0) && first != noisy(0.3, id, 1));
        // An input beyond the network's is ignored. Loading restores the intact controller.
        control.intervene(&Intervention::cut(1..9), id, 0);
        assert_eq!(response(&mut control, [0.5, 0.9]), cut);
        assert!(control.load(None));
        assert_eq!(response(&mut control, [0.5, 0.9]), intact);
    }

    #[test]
    fn what_is_cut_is_the_mean_where_observations_are_normalised() {
        let mut control = network();
        let before = statistics(&[[1.0, 10.0], [3.0, 30.0]]);
        assert!(control.load(Some(&before)));
        let mean = response(&mut control, [2.5, 20.0]);
        assert!(control.load(Some(&before)));
        control.intervene(&Intervention::cut(1..2), EpisodeId::default(), 0);
        assert_eq!(response(&mut control, [2.5, 35.0]), mean);
        // The statistics are those of the inputs.
        assert_eq!(control.observed().unwrap().mean(), [2.5, 35.0]);
    }

    /// Hands its inputs on.
    #[derive(Clone, Debug)]
    struct Echo;

    impl Controller for Echo {
        fn inputs(&self) -> usize {
            2
        }
        fn outputs(&self) -> usize {
            2
        }
        fn reset(&mut self) {}
        fn step(&mut self, x: &[f32], y: &mut [f32]) {
            y.copy_from_slice(x);
        }
    }

    fn statistics(rows: &[[f32; 2]]) -> ObservationStatistics {
        let mut statistics = ObservationStatistics::new(2).unwrap();
        assert!(rows.iter().all(|row| statistics.push(row)));
        statistics
    }

    #[test]
    fn observations_are_normalised_by_those_before_and_kept_as_they_were() {
        let rows = [[1.0, -4.0], [2.0, 8.0], [6.0, 2.0]];
        let before = statistics(&rows);
        let mut control = NormalizedController::new(Echo);
        assert!(control.load(Some(&before)));
        let mut y = [0.0; 2];
        let seen = [[4.0, 0.5], [-3.0, 1e9]];
        // By hand: means 3 and 2, variances 14/3 and 24.
        let by_hand = |row: [f32; 2]| {
            let x = [(f64::from(row[0]) - 3.0) / (14.0_f64 / 3.0).sqrt(), (f64::from(row[1]) - 2.0) / 24.0_f64.sqrt()];
            x.map(|x| x.min(10.0) as f32)
        };
        for row in seen {
            control.step(&row, &mut y);
            let expected = by_hand(row);
            assert!(y.iter().zip(expected).all(|(y, x)| (y - x).abs() < 1e-6), "{y:?} {expected:?}");
        }
        control.reset();
        assert_eq!(control.observed(), Some(&statistics(&seen)));
        // Another evaluation does not depend on this one.
        assert!(control.load(Some(&before)));
        assert_eq!(control.observed().unwrap().count(), 0);
    }

    #[test]
    fn nothing_changes_before_there_are_two_observations() {
        for count in 0..2 {
            let before = statistics(&[[1.0, -4.0]][..count]);
            let mut control = NormalizedController::new(Echo);
            assert!(control.load(Some(&before)));
            let mut y = [0.0; 2];
            control.step(&[0.25, 30.0], &mut y);
            assert_eq!((y, control.observed().unwrap().count()), ([0.25, 30.0], 1));
        }
    }

    #[test]
    fn other_channels_are_refused() {
        let mut control = NormalizedController::new(Echo);
        assert!(!control.load(Some(&ObservationStatistics::new(3).unwrap())));
        assert!(control.observed().is_none() && control.load(None));
    }
}
