//! Wires set by hand.

use std::collections::BTreeMap;
use std::sync::Arc;

use farsa_lab::exports::NetworkExport;
use farsa_lab::{Error, Parameter};
use farsa_nn::{Ablatable, Controller, Lesion};
use farsa_num::{Scalar, logistic};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::name::NAME;
use crate::networks::single;
use crate::part::{NetworkEnds, NetworkPart, PartNetwork};

/// Wires from inputs to outputs.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Wired {
    /// Biases of the outputs, in their order.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    bias: Vec<f64>,
    /// Searches other biases.
    #[serde(default)]
    search_bias: bool,
    /// Activation function of the outputs.
    #[serde(default)]
    activation: Activation,
    /// Wires in the order of their addition.
    wires: Vec<Wire>,
}

/// A wire that adds to an output the weighted sum of some inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
struct Wire {
    /// Name for settings and parameters, by default the number.
    #[schemars(regex(pattern = NAME))]
    name: Option<String>,
    /// Names of inputs, such as `light 1`, in the order of addition.
    from: Vec<String>,
    /// Name of an output, such as `wheels left`.
    to: String,
    /// Factor of the inputs.
    #[schemars(range(min = -1e6, max = 1e6))]
    weight: f64,
    /// Searches another weight between the ends of `weights`.
    #[serde(default)]
    searched: bool,
}

/// Activation functions of outputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Activation {
    /// Identity, clamped to 0 and 1.
    #[default]
    Clamp,
    /// Logistic function.
    Logistic,
}

/// A network of wires: `y_o = f(b_o + sum w x)`. The sum adds the wires in order, starting at 0. `f` is the identity
/// clamped to 0 and 1, or the logistic function.
#[derive(Clone, Debug)]
pub(super) struct HandWired {
    inputs: usize,
    outputs: usize,
    /// Inputs and output of each wire.
    wires: Arc<[(Vec<usize>, usize)]>,
    activation: Activation,
    /// Weights of the wires, then biases.
    parameters: Vec<f32>,
}

impl Wired {
    /// Names the wires.
    fn names(&self) -> impl Iterator<Item = String> + '_ {
        let name = |(number, wire): (usize, &Wire)| wire.name.clone().unwrap_or_else(|| format!("wire {}", number + 1));
        self.wires.iter().enumerate().map(name)
    }
}

impl NetworkPart for Wired {
    type Network = HandWired;

    fn network(&self, ends: &NetworkEnds<'_>) -> Result<HandWired, Error> {
        let NetworkEnds { inputs, outputs, .. } = ends;
        if self.bias.len() != outputs.len() {
            let why = format!("has {} values where the motors want {}", self.bias.len(), outputs.len());
            return Err(ends.error_at("bias", why));
        }
        let made = self.wires.iter().enumerate().map(|(number, wire)| {
            let from = wire.from.iter().enumerate();
            let from = from
                .map(|(index, name)| ends.position(inputs, ("input", name), &format!("wires/{number}/from/{index}")));
            let from = from.collect::<Result<Vec<_>, _>>()?;
            Ok((from, ends.position(outputs, ("output", &wire.to), &format!("wires/{number}/to"))?))
        });
        let wires = made.collect::<Result<Vec<_>, Error>>()?;
        let parameters = self.wires.iter().map(|wire| wire.weight).chain(self.bias.iter().copied());
        Ok(HandWired {
            inputs: inputs.len(),
            outputs: outputs.len(),
            wires: wires.into(),
            activation: self.activation,
            parameters: parameters.map(|x| x as f32).collect(),
        })
    }

    fn parameters(&self, _: &HandWired, ends: &NetworkEnds<'_>) -> Vec<Parameter> {
        let range = single(ends.weights);
        let weights = self.names().map(|name| Parameter::new(format!("weight of {name}"), range));
        weights.chain(ends.outputs.iter().map(|output| Parameter::new(format!("bias of {output}"), range))).collect()
    }

    fn given(&self, _: &HandWired, ends: &NetworkEnds<'_>) -> BTreeMap<String, f64> {
        let fixed = self.wires.iter().zip(self.names()).filter(|(wire, _)| !wire.searched);
        let fixed = fixed.map(|(wire, name)| (format!("weight of {name}"), wire.weight));
        let biases = ends.outputs.iter().zip(&self.bias).filter(|_| !self.search_bias);
        fixed.chain(biases.map(|(output, bias)| (format!("bias of {output}"), *bias))).collect()
    }
}

impl PartNetwork for HandWired {
    fn copy_parameters(&mut self, parameters: &[f32]) -> bool {
        let fits = parameters.len() == self.parameters.len() && parameters.iter().all(|x| x.is_finite());
        if fits {
            self.parameters.copy_from_slice(parameters);
        }
        fits
    }

    fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    fn activations(&self) -> &[f32] {
        &[]
    }

    /// Returns the equivalent perceptron if the outputs are logistic: weights input by input, then biases.
    fn export(&self) -> Option<NetworkExport> {
        if self.activation != Activation::Logistic {
            return None;
        }
        let (inputs, outputs) = (self.inputs, self.outputs);
        let mut parameters = vec![0.0; (inputs + 1) * outputs];
        for ((from, to), weight) in self.wires.iter().zip(&self.parameters) {
            for input in from {
                parameters[input * outputs + to] += weight;
            }
        }
        parameters[inputs * outputs..].copy_from_slice(&self.parameters[self.wires.len()..]);
        Some(NetworkExport::Perceptron { inputs, outputs, slope: 1.0, parameters })
    }

    fn summary(&self) -> String {
        format!("{}-{}, wired by hand", self.inputs, self.outputs)
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
