//! The bits of a long run: a change here is value-breaking and has its heading in the changelog.

use farsa_nn::block::{Architecture, BlockNetwork, BlockParameter};
use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
use farsa_nn::{Controller, Ctrnn, CtrnnLayout, Integrator, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa_num::{Digest, Domain, Stream};

#[test]
fn a_hundred_thousand_steps() {
    const LAYOUT: LeakyLayout = LeakyLayout::new(29, 12, 23);
    let run = |leak| {
        let mut genes = Stream::new(2010, Domain::InitialGenome, 0, 0, 0);
        let mut parameters = [0.0; LAYOUT.parameter_count()];
        for (p, kind) in parameters.iter_mut().zip(LAYOUT.kinds()) {
            *p = if kind == LeakyParameter::Leak { genes.uniform() } else { genes.range(-6.0, 6.0) };
        }
        let mut network = LeakyNetwork::new(LAYOUT, leak, parameters, [0.0; LAYOUT.state_len()]).expect("valid");
        let mut inputs = Stream::new(2010, Domain::Network, 0, 0, 0);
        let (mut x, mut y, mut digest) = ([0.0; 29], [0.0; 23], Digest::new());
        for _ in 0..100_000 {
            // The range of the experiment's position sensors: units left unsaturated and saturated alike.
            x.fill_with(|| inputs.range(-10.0, 10.0));
            network.step(&x, &mut y);
            digest.add_f32s(network.hidden());
            digest.add_f32s(&y);
        }
        digest.finish()
    };
    let digests = Leak::ALL.map(run);
    let expected = [0xAF1A_A86B_F870_EE5E, 0x3C54_0E4E_8C2B_D1B6, 0x4AC3_9883_CC9E_8E64];
    assert_eq!(digests, expected, "{digests:#018x?}");
}

#[test]
fn a_hundred_thousand_steps_in_fixed_point() {
    const LAYOUT: LeakyLayout = LeakyLayout::new(29, 12, 23);
    let run = |leak| {
        let mut genes = Stream::new(2010, Domain::InitialGenome, 0, 0, 0);
        let (mut parameters, mut fixed) = ([0.0; LAYOUT.parameter_count()], [0; LAYOUT.parameter_count()]);
        for (p, kind) in parameters.iter_mut().zip(LAYOUT.kinds()) {
            *p = if kind == LeakyParameter::Leak { genes.uniform() } else { genes.range(-6.0, 6.0) };
        }
        let scale = QuantizedScale::quantize(&LAYOUT, 9, &parameters, &mut fixed).expect("fits");
        let mut network = QuantizedNetwork::new(LAYOUT, leak, scale, fixed, [0; LAYOUT.state_len()]).expect("valid");
        let mut inputs = Stream::new(2010, Domain::Network, 0, 0, 0);
        let (mut x, mut y, mut digest) = ([0; 29], [0; 23], Digest::new());
        for _ in 0..100_000 {
            x.fill_with(|| (inputs.next_u32() >> 19) as i16 - 4096);
            network.step_quantized(&x, &mut y);
            let told = network.hidden().iter().map(|h| *h as u64).chain(y.iter().map(|y| *y as u64));
            told.for_each(|value| digest.add_u64(value));
        }
        digest.finish()
    };
    let digests = Leak::ALL.map(run);
    let expected = [0xA03A_A352_FB5E_3AE7, 0x960F_7D67_C025_0001, 0x3986_2CAB_1601_3E9D];
    assert_eq!(digests, expected, "{digests:#018x?}");
}

#[test]
fn a_hundred_thousand_steps_of_continuous_networks() {
    let run = |integrator| {
        let layout = CtrnnLayout::new(3, 13, 4).with_integrator(integrator);
        let mut stream = Stream::new(1995, Domain::InitialGenome, 0, 0, 0);
        let mut parameters = vec![0.0; layout.parameter_count()];
        layout.draw_centre_crossing(&mut stream, 16.0, [0.1, 2.0], &mut parameters).expect("as many");
        let mut network = Ctrnn::new(layout, 0.05, parameters, vec![0.0; layout.state_len()]).expect("valid");
        let mut inputs = Stream::new(1995, Domain::Network, 0, 0, 0);
        let (mut x, mut y, mut digest) = ([0.0; 3], [0.0; 4], Digest::new());
        for _ in 0..100_000 {
            x.fill_with(|| inputs.range(-1.0, 1.0));
            network.step(&x, &mut y);
            digest.add_f32s(network.states());
            digest.add_f32s(&y);
        }
        digest.finish()
    };
    let digests = Integrator::ALL.map(run);
    let expected = [0xE2DB_EB05_30B1_E477, 0x96A6_3C61_CEA3_C546, 0x2B09_0621_D7B2_32BE];
    assert_eq!(digests, expected, "{digests:#018x?}");
}

#[test]
fn a_hundred_thousand_steps_of_blocks() {
    let plan =
        Architecture::jordan(5, 11, 3).with_recurrent_outputs().with_leaks().with_gains().with_input_delay(3).plan();
    let layout = plan.layout();
    let mut genes = Stream::new(1986, Domain::InitialGenome, 0, 0, 0);
    let draw = |kind| match kind {
        BlockParameter::Leak | BlockParameter::Gain => genes.uniform(),
        _ => genes.range(-6.0, 6.0),
    };
    let parameters: Vec<f32> = layout.kinds().map(draw).collect();
    let mut network =
        BlockNetwork::new(layout, Leak::Evonet, parameters, vec![0.0; layout.state_len()]).expect("valid");
    let mut inputs = Stream::new(1986, Domain::Network, 0, 0, 0);
    let (mut x, mut y, mut digest) = ([0.0; 5], [0.0; 3], Digest::new());
    for _ in 0..100_000 {
        x.fill_with(|| inputs.range(-1.0, 1.0));
        network.step(&x, &mut y);
        digest.add_f32s(network.activations());
    }
    assert_eq!(digest.finish(), 0xE621_065F_616F_11BB, "{:#018x}", digest.finish());
}
