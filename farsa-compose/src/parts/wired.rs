//! A network that is wired by hand.

use std::sync::Arc;

use farsa_lab::{Error, Parameter};
use farsa_nn::Controller;
use farsa_num::{Scalar, logistic};

use crate::check::places::Places;
use crate::document::{Activation, Wire};
use crate::parts::ends::Ends;

/// Wires that add inputs up: `y_o = f(b_o + sum w x)`, the sum wire by wire from 0, `f` the identity cut at 0 and 1 or the
/// logistic function.
#[derive(Clone, Debug)]
pub(crate) struct Wired {
    inputs: usize,
    outputs: usize,
    /// The inputs of each wire, and its output.
    wires: Arc<[(Vec<usize>, usize)]>,
    activation: Activation,
    /// The weights of the wires, then the biases.
    parameters: Vec<f32>,
}

impl Wired {
    /// The wires of a document between these ends.
    ///
    /// # Errors
    /// [`Error::Unknown`] for an end that there is not, [`Error::Setting`] for another number of biases than of outputs.
    pub(crate) fn new(
        wires: &[Wire],
        bias: &[f64],
        activation: Activation,
        ends: Ends<'_>,
        places: &Places,
    ) -> Result<Self, Error> {
        let Ends { inputs, outputs, .. } = ends;
        if bias.len() != outputs.len() {
            let why = format!("has {} values where the motors want {}", bias.len(), outputs.len());
            return Err(places.wrong("/network/bias", why));
        }
        let end = |name: &str, list: &[String], what, path: String| {
            let found = list.iter().position(|known| known == name);
            let names = list.iter().map(String::as_str);
            found.ok_or_else(|| Error::unknown(&places.of(&path), what, name, names))
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

    /// All parameters by their names, in their order.
    pub(crate) fn named(wires: &[Wire], names: &[String], outputs: &[String], range: [f64; 2]) -> Vec<Parameter> {
        let weights = wires.iter().zip(names).map(|(_, name)| Parameter::new(format!("weight of {name}"), range));
        weights.chain(outputs.iter().map(|output| Parameter::new(format!("bias of {output}"), range))).collect()
    }

    /// Takes other parameters; false for another number of them.
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

    /// The weights of one layer that does the same, input by input, and then the biases, if its outputs are logistic.
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

impl Controller for Wired {
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
