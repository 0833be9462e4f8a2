//! Parameters for any network, and what the steps of a trial are recorded as.

use farsa_body::Recorder;
use farsa_lab::Evaluator;

/// Numbers between the ends of each parameter.
pub(crate) fn drawn(evaluator: &dyn Evaluator) -> Vec<f32> {
    let own = |(number, parameter): (usize, farsa_lab::Parameter)| {
        let share = (number * 37 % 101) as f64 / 100.0;
        (parameter.ends[0] + share * (parameter.ends[1] - parameter.ends[0])) as f32
    };
    evaluator.info().parameters.into_iter().enumerate().map(own).collect()
}

/// Returns sensor and motor values in each step.
#[derive(Default)]
pub(crate) struct Steps {
    x: Vec<f32>,
    y: Vec<f32>,
    pub(crate) all: Vec<[Vec<f32>; 2]>,
}

impl Recorder for Steps {
    fn sensors(&mut self, values: &[f32]) {
        self.x = values.into();
    }
    fn outputs(&mut self, values: &[f32]) {
        self.y = values.into();
    }
    fn tick(&mut self, _: f64) {
        self.all.push([self.x.clone(), self.y.clone()]);
    }
}
