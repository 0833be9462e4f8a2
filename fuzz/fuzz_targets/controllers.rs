//! Bytes of trained networks, of all kinds: as they are, and with lengths, hashes and checksum that are right.
#![no_main]

use farsa_fuzz::{bounded, sealed_controller};
use farsa_nn::block::BlockNetwork;
use farsa_nn::bytes::{BlockNetworkBytes, CtrnnBytes, LeakyNetworkBytes, PerceptronBytes, QuantizedNetworkBytes};
use farsa_nn::quantized::QuantizedNetwork;
use farsa_nn::{Controller, Ctrnn, LeakyNetwork, Perceptron};
use libfuzzer_sys::fuzz_target;

/// The largest state. A short description may have a large state, or inputs without weights, so the number is checked first.
const MOST_STATE: usize = 1 << 16;

/// Two steps, with inputs that are numbers and with others.
fn stepped(network: &mut impl Controller) {
    if network.inputs().max(network.outputs()) > MOST_STATE {
        return;
    }
    let mut outputs = vec![0.0; network.outputs()];
    for input in [0.5, f32::NAN] {
        network.step(&vec![input; network.inputs()], &mut outputs);
    }
}

fn leaky(bytes: &[u8]) {
    let Ok(found) = LeakyNetworkBytes::read(bytes) else { return };
    let (layout, leak) = (found.layout(), found.leak());
    let mut parameters = vec![0.0; layout.parameter_count()];
    found.copy_parameters(&mut parameters).expect("as many");
    let mut again = vec![0; LeakyNetworkBytes::byte_count(layout)];
    LeakyNetworkBytes::write(layout, leak, found.channels(), &parameters, &mut again)
        .expect("what was read is written");
    assert!(again == bytes);
    if layout.state_len() <= MOST_STATE {
        let state = vec![0.0; layout.state_len()];
        stepped(&mut LeakyNetwork::new(layout, leak, parameters, state).expect("what was read is a network"));
    }
}

fn quantized(bytes: &[u8]) {
    let Ok(found) = QuantizedNetworkBytes::read(bytes) else { return };
    let (layout, leak, scale) = (found.layout(), found.leak(), found.scale());
    let mut parameters = vec![0; layout.parameter_count()];
    found.copy_parameters(&mut parameters).expect("as many");
    let mut again = vec![0; QuantizedNetworkBytes::byte_count(layout)];
    let written = QuantizedNetworkBytes::write(layout, leak, scale, found.channels(), &parameters, &mut again);
    written.expect("what was read is written");
    assert!(again == bytes);
    if layout.state_len() <= MOST_STATE {
        let state = vec![0; layout.state_len()];
        let network = QuantizedNetwork::new(layout, leak, scale, parameters, state);
        stepped(&mut network.expect("what was read is a network"));
    }
}

fn ctrnn(bytes: &[u8]) {
    let Ok(found) = CtrnnBytes::read(bytes) else { return };
    let (layout, time_step) = (found.layout(), found.time_step());
    let mut parameters = vec![0.0; layout.parameter_count()];
    found.copy_parameters(&mut parameters).expect("as many");
    let mut again = vec![0; CtrnnBytes::byte_count(layout)];
    CtrnnBytes::write(layout, time_step, found.channels(), &parameters, &mut again).expect("what was read is written");
    assert!(again == bytes);
    if layout.state_len() <= MOST_STATE {
        let state = vec![0.0; layout.state_len()];
        stepped(&mut Ctrnn::new(layout, time_step, parameters, state).expect("what was read is a network"));
    }
}

fn perceptron(bytes: &[u8]) {
    let Ok(found) = PerceptronBytes::read(bytes) else { return };
    let (inputs, outputs, slope) = (found.inputs(), found.outputs(), found.slope());
    let mut parameters = vec![0.0; (inputs + 1) * outputs];
    found.copy_parameters(&mut parameters).expect("as many");
    let mut again = vec![0; PerceptronBytes::byte_count(inputs, outputs)];
    let written = PerceptronBytes::write(inputs, outputs, slope, found.channels(), &parameters, &mut again);
    written.expect("what was read is written");
    assert!(again == bytes);
    if inputs <= MOST_STATE {
        stepped(&mut Perceptron::new(inputs, outputs, slope, parameters).expect("what was read is a network"));
    }
}

fn blocks(bytes: &[u8]) {
    let Ok(found) = BlockNetworkBytes::read(bytes) else { return };
    let (buffer, leak) = (found.layout(), found.leak());
    let layout = buffer.layout();
    let mut parameters = vec![0.0; layout.parameter_count()];
    found.copy_parameters(&mut parameters).expect("as many");
    let mut again = vec![0; BlockNetworkBytes::byte_count(&layout)];
    BlockNetworkBytes::write(layout, leak, found.channels(), &parameters, &mut again)
        .expect("what was read is written");
    assert!(again == bytes);
    if layout.state_len() <= MOST_STATE {
        let state = vec![0.0; layout.state_len()];
        stepped(&mut BlockNetwork::new(layout, leak, parameters, state).expect("what was read is a network"));
    }
}

fn all(bytes: &[u8]) {
    for read in [leaky, quantized, ctrnn, perceptron, blocks] {
        bounded(bytes.len(), || read(bytes));
    }
}

fuzz_target!(|input: &[u8]| {
    all(input);
    if let Some(sealed) = sealed_controller(input) {
        all(&sealed);
    }
});
