//! The networks of the format.

use farsa_lab::Parameter;
use farsa_lab::advanced::Part;

use crate::part::network;

/// Clusters and links.
pub(crate) mod blocks;
/// Networks in continuous time.
pub(crate) mod ctrnn;
/// The network of the 2013 program.
mod evonet;
/// Layers and delayed links.
mod layered;
/// Hidden layers of leaky integrators.
pub(crate) mod leaky;
/// One layer.
pub(crate) mod perceptron;
/// Layouts of block networks with a static lifetime.
mod static_layout;
/// Wires set by hand.
mod wired;

/// Lists them under their names.
pub(crate) fn networks() -> Vec<Part> {
    vec![
        network::<perceptron::PerceptronPart>("perceptron"),
        network::<leaky::Leaky>("leaky"),
        network::<wired::Wired>("wired"),
        network::<ctrnn::CtrnnPart>("ctrnn"),
        network::<layered::FeedForward>("feed-forward"),
        network::<layered::Elman>("elman"),
        network::<layered::Jordan>("jordan"),
        network::<layered::FullyRecurrent>("fully-recurrent"),
        network::<blocks::Blocks>("blocks"),
        network::<evonet::Evonet>("evonet"),
    ]
}

/// Implements the traits of controllers for a struct around a network.
macro_rules! around {
    ($name:ty, $field:ident) => {
        impl farsa_nn::Controller for $name {
            fn inputs(&self) -> usize {
                self.$field.inputs()
            }
            fn outputs(&self) -> usize {
                self.$field.outputs()
            }
            fn reset(&mut self) {
                self.$field.reset();
            }
            fn step(&mut self, x: &[f32], y: &mut [f32]) {
                self.$field.step(x, y);
            }
        }

        impl farsa_nn::Ablatable for $name {
            fn neurons(&self) -> usize {
                self.$field.neurons()
            }
            fn step_ablated(&mut self, lesions: &[farsa_nn::Lesion], x: &[f32], y: &mut [f32]) {
                self.$field.step_ablated(lesions, x, y);
            }
        }
    };
}
use around;

/// Rounds a range to single precision, in which networks compute.
fn single(ends: [f64; 2]) -> [f64; 2] {
    ends.map(|end| f64::from(end as f32))
}

/// Names parameters by kind and number.
fn numbered<'k>(kinds: impl Iterator<Item = (&'k str, [f64; 2])>) -> Vec<Parameter> {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    let named = kinds.map(|(kind, range)| {
        let place = counts.iter().position(|(known, _)| *known == kind).unwrap_or_else(|| {
            counts.push((kind, 0));
            counts.len() - 1
        });
        counts[place].1 += 1;
        Parameter::new(format!("{kind} {}", counts[place].1), range)
    });
    named.collect()
}
