//! Networks with wires set by hand.

use std::sync::Arc;

use farsa_lab::{Error, Parameter};
use farsa_nn::{Ablatable, Controller, Lesion};
use farsa_num::{Scalar, logistic};

use crate::check::source::Source;
use crate::document::{Activation, Wire};
use crate::parts::ends::Ends;

/// A network of wires: `y_o = f(b_o + sum w x)`. The sum adds the wires in order, starting at 0. `f` is the identity
/// clamped to 0 and 1, or the logistic function.
#[derive(Clone, Debug)]
pub(crate) struct HandWired {
    inputs: usize,
    outputs: usize,
    /// Inputs and output of each wire.
    wires: Arc<[(Vec<usize>, usize)]>,
    activation: Activation,
    /// Weights of the wires, then biases.
    parameters: Vec<f32>,
}

impl HandWired {
    /// Builds the wires of a document.
    pub(crate) fn new(
        wires: &[Wire],
        bias: &[f64],
        activation: Activation,
        ends: Ends<'_>,
        source: &Source,
    ) -> Result<Self, Error> {
        let Ends { inputs, outputs, .. } = ends;
        if bias.len() != outputs.len() {
            let why = format!("has {} values where the motors want {}", bias.len(), outputs.len());
            return Err(source.wrong("/network/bias", why));
        }
        let end = |name: &str, list: &[String], what, path: String| {
            source.position(list.iter().map(String::as_str), (what, name), &path)
        };
        let made = wires.iter().enumerate().map(|(number, wire)| {
            let path = format!("/network/wires/{number}");
            let from = wire.from.iter().enumerate();
            let from = from.map(|(index, name)| end(name, inputs, "input", format!("{path}/from/{index}")));
            Ok((from.collect::<Result<Vec<_>, _>>()?, end(&wire.to, outputs, "output", format!("{path}/to"))?))
        });
        let wired = made.collect::<Result<Vec<_>, Error>>()?;
        let parameters = wires.iter().map(|wire| wire.weight).chain(bias.iter().copied());
        Ok(Self {
            inputs: inputs.len(),
            outputs: outputs.len(),
            wires: wired.into(),
            activation,
            parameters: parameters.map(|x| x as f32).collect(),
        })
    }

    /// Names all parameters.
    pub(crate) fn named(wires: &[Wire], names: &[String], outputs: &[String], range: [f64; 2]) -> Vec<Parameter> {
        let weights = wires.iter().zip(names).map(|(_, name)| Parameter::new(format!("weight of {name}"), range));
        weights.chain(outputs.iter().map(|output| Parameter::new(format!("bias of {output}"), range))).collect()
    }

    /// Copies parameters. Returns false for another number of them and for NaN.
    pub(crate) fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        let fits = parameters.len() == self.parameters.len() && parameters.iter().all(|x| x.is_finite());
        if fits {
            self.parameters.copy_from_slice(parameters);
        }
        fits
    }

    pub(crate) fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// Computes the equivalent perceptron's parameters if the outputs are logistic: weights input by input, then
    /// biases.
    pub(crate) fn as_layer(&self) -> Option<Vec<f32>> {
        if self.activation != Activation::Logistic {
            return None;
        }
        let mut layer = vec![0.0; (self.inputs + 1) * self.outputs];
        for ((from, to), weight) in self.wires.iter().zip(&self.parameters) {
            for input in from {
                layer[input * self.outputs + to] += weight;
            }
        }
        layer[self.inputs * self.outputs..].copy_from_slice(&self.parameters[self.wires.len()..]);
        Some(layer)
    }
}

impl Controller for HandWired {
    fn inputs(&self) -> usize {
        self.inputs
    }

    fn outputs(&self) -> usize {
        self.outputs
    }

    fn reset(&mut self) {}

    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let (weights, biases) = self.parameters.split_at(self.wires.len());
        y.fill(0.0);
        for ((from, to), weight) in self.wires.iter().zip(weights) {
            for input in from {
                y[*to] += weight * x[*input];
            }
        }
        for (y, bias) in y.iter_mut().zip(biases) {
            let sum = bias + *y;
            *y = match self.activation {
                Activation::Clamp => Scalar::clamp(sum, 0.0, 1.0),
                Activation::Logistic => logistic(sum),
            };
        }
    }
}

/// A hand-wired network has no neurons to hold.
impl Ablatable for HandWired {
    fn neurons(&self) -> usize {
        0
    }

    fn step_ablated(&mut self, _: &[Lesion], x: &[f32], y: &mut [f32]) {
        self.step(x, y);
    }
}
