//! A controller whose observations are normalised.

use farsa_evo::ObservationStatistics;
use farsa_nn::Controller;

/// The most that a normalised observation is away from 0, in standard deviations.
const LIMIT: f32 = 10.0;

/// A controller that takes observations as they are or, where the evaluation says so, normalised by the mean and the
/// deviation of earlier ones.
///
/// An evaluation that normalises also wants to know what was observed: [`observed`](Self::observed) goes into
/// [`Outcome::observed`](crate::Outcome::observed). An evaluation that does not changes no bit of what the controller
/// computes.
///
/// Source: V2 of \[Mania2018\] algorithm 1. As there, nothing is changed before there are two observations. Deviations:
/// those of [`ObservationStatistics`], and a limit of 10 standard deviations.
///
/// ```
/// use farsa_evo::ObservationStatistics;
/// use farsa_lab::NormalisedController;
/// use farsa_nn::{Controller, Perceptron};
///
/// let mut control = NormalisedController::new(Perceptron::new(1, 1, 1.0, [1.0, 0.0])?);
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
pub struct NormalisedController<C> {
    controller: C,
    /// What was observed before, and since [`load`](Self::load); none where nothing is normalised.
    statistics: Option<[ObservationStatistics; 2]>,
    x: Vec<f32>,
}

impl<C: Controller> NormalisedController<C> {
    /// This controller, with observations as they are.
    pub fn new(controller: C) -> Self {
        let x = vec![0.0; controller.inputs()];
        Self { controller, statistics: None, x }
    }

    /// Normalises by what was observed before, or does not normalise, and forgets what was observed since; false for
    /// statistics of other channels than the controller's inputs, which change nothing.
    pub fn load(&mut self, before: Option<&ObservationStatistics>) -> bool {
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

    /// What was observed since [`load`](Self::load), before it was normalised; none where it is not.
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.statistics.as_ref().map(|[_, since]| since)
    }

    /// The controller.
    pub fn controller(&self) -> &C {
        &self.controller
    }

    /// The controller, for other parameters.
    pub fn controller_mut(&mut self) -> &mut C {
        &mut self.controller
    }
}

impl<C: Controller> Controller for NormalisedController<C> {
    fn inputs(&self) -> usize {
        self.controller.inputs()
    }

    fn outputs(&self) -> usize {
        self.controller.outputs()
    }

    /// Forgets what the controller remembers; what was observed stays.
    fn reset(&mut self) {
        self.controller.reset();
    }

    #[inline]
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let Some([before, since]) = &mut self.statistics else { return self.controller.step(x, y) };
        since.push(x);
        // One observation has no deviation.
        if before.count() < 2 {
            return self.controller.step(x, y);
        }
        self.x.copy_from_slice(x);
        before.normalise(&mut self.x, LIMIT);
        self.controller.step(&self.x, y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let mut control = NormalisedController::new(Echo);
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
        // Another evaluation knows nothing of this one.
        assert!(control.load(Some(&before)));
        assert_eq!(control.observed().unwrap().count(), 0);
    }

    #[test]
    fn nothing_changes_before_there_are_two_observations() {
        for count in 0..2 {
            let before = statistics(&[[1.0, -4.0]][..count]);
            let mut control = NormalisedController::new(Echo);
            assert!(control.load(Some(&before)));
            let mut y = [0.0; 2];
            control.step(&[0.25, 30.0], &mut y);
            assert_eq!((y, control.observed().unwrap().count()), ([0.25, 30.0], 1));
        }
    }

    #[test]
    fn other_channels_are_refused() {
        let mut control = NormalisedController::new(Echo);
        assert!(!control.load(Some(&ObservationStatistics::new(3).unwrap())));
        assert!(control.observed().is_none() && control.load(None));
    }
}
