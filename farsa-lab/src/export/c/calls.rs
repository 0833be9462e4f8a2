//! Pieces of code of networks in single precision.

use farsa_nn::{Activation, Leak};

use crate::export::c::code::real;

/// Returns an array of floats in the state.
pub(super) fn floats(name: &str, count: usize) -> (&'static str, String, usize) {
    ("float", String::from(name), count)
}

/// Writes the call that adds sources to sums, or nothing without sources or targets.
pub(super) fn add(sums: &str, targets: usize, x: &str, sources: usize, weights: &str) -> String {
    match sources.min(targets) {
        0 => String::new(),
        _ => format!("    add({sums}, {targets}, {x}, {sources}, {weights});\n"),
    }
}

/// Writes the call of an activation function.
pub(super) fn response(activation: Activation, argument: &str) -> String {
    let function = match activation {
        Activation::Logistic => "logistic",
        Activation::Tanh => "tangent",
        Activation::Linear => return format!("({argument})"),
        Activation::Step => "threshold",
        Activation::Rectified => "rectified",
    };
    format!("{function}({argument})")
}

/// Writes the response to a net input that is multiplied by a slope.
pub(super) fn real_response(activation: Activation, slope: f32, net: &str) -> String {
    response(activation, &format!("{} * {net}", real(slope)))
}

/// Writes the update of the activation `h` by the response `y` and the leak `d`. `index` is that of the neuron.
pub(super) fn leak_update(leak: Leak, h: &str, index: &str) -> String {
    match leak {
        Leak::Filter => format!("        {h} = d * y + (1.0f - d) * {h};\n"),
        Leak::TwoTap => {
            let previous = format!("state->previous[{index}]");
            format!("        {h} = d * y + (1.0f - d) * {previous};\n        {previous} = y;\n")
        }
        Leak::Evonet => format!("        {h} = d * {h} + (1.0f - d) * y;\n"),
    }
}
