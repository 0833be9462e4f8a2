//! The fixed-point network against its equations in wide integers, and against the network of floats.

use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
use farsa_nn::{Controller, Error, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

const LABELS: LeakyLayout = LeakyLayout::new(29, 12, 23);

/// The equations index by index in 128 bits, the sums in the reverse order.
struct Oracle<'a> {
    layout: LeakyLayout,
    leak: Leak,
    scale: QuantizedScale,
    fixed: &'a [i16],
    hidden: Vec<i128>,
    previous: Vec<i128>,
}

impl<'a> Oracle<'a> {
    fn new(layout: LeakyLayout, leak: Leak, scale: QuantizedScale, fixed: &'a [i16]) -> Self {
        let zeros = vec![0; layout.hidden()];
        Self { layout, leak, scale, fixed, hidden: zeros.clone(), previous: zeros }
    }

    /// The logistic function of the documentation: rounded entries every 1/32, and the rounded line between them.
    fn logistic(&self, sum: i128) -> i128 {
        let bits = self.scale.sum_bits();
        let size = sum.abs().min(12 << bits);
        let entry = |k: i128| (32768.0 / (1.0 + farsa_num::exp(k as f64 / -32.0)) + 0.5).floor() as i128;
        let (k, rest) = ((size * 32) >> bits, size * 32 % (1 << bits));
        let line = (entry(k + 1).min(32768) - entry(k)) * rest;
        let value = entry(k) + (line * 2 + (1 << bits)).div_euclid(2 << bits);
        if sum < 0 { 32768 - value } else { value }
    }

    fn step(&mut self, x: &[i16]) -> Vec<i16> {
        let (n, h, o) = (self.layout.sensors(), self.layout.hidden(), self.layout.outputs());
        let scale = self.scale;
        let p = |index: usize| i128::from(self.fixed[index]);
        let shifted = |value: i128, bits: u32| value.div_euclid(1 << (bits + scale.weight_bits() - scale.sum_bits()));
        let sources: Vec<i128> = self.hidden.iter().map(|h| (h + (1 << 14)) >> 15).collect();
        let mut response = vec![0; h];
        for i in 0..h {
            let mut net = 0;
            for j in (0..n).rev() {
                net += shifted(p(j * h + i) * i128::from(x[j]), scale.input_bits());
            }
            for k in (0..h).rev() {
                net += shifted(p(n * h + k * h + i) * sources[k], 15);
            }
            net += shifted(p(n * h + h * h + h * o + i) << 15, 15);
            assert!(i32::try_from(net).is_ok(), "the sum of hidden neuron {i} is {net}");
            response[i] = self.logistic(net) << 15;
        }
        for i in 0..h {
            let d = p(n * h + h * h + h * o + h + i);
            let (h, y, before) = (self.hidden[i], response[i], self.previous[i]);
            self.hidden[i] = match self.leak {
                Leak::Filter => h + (d * (y - h)).div_euclid(1 << 14),
                Leak::TwoTap => before + (d * (y - before)).div_euclid(1 << 14),
                Leak::Evonet => h + (((1 << 14) - d) * (y - h)).div_euclid(1 << 14),
            };
        }
        self.previous = response;
        let output = |i| {
            let source = |j: usize| (self.hidden[j] + (1 << 14)) >> 15;
            let net: i128 = (0..h).rev().map(|j| shifted(p(n * h + h * h + j * o + i) * source(j), 15)).sum();
            assert!(i32::try_from(net).is_ok(), "the sum of output {i} is {net}");
            self.logistic(net).min(32767) as i16
        };
        (0..o).map(output).collect()
    }
}

/// Decodes genes [0..1] to weights and biases of this range, and leaks.
fn decode(layout: LeakyLayout, range: f32, genes: &[f32]) -> Vec<f32> {
    let decoded =
        |(gene, kind): (&f32, _)| if kind == LeakyParameter::Leak { *gene } else { range * (2.0 * gene - 1.0) };
    genes.iter().zip(layout.kinds()).map(decoded).collect()
}

prop_compose! {
    /// A layout, its parameters, fraction bits of its inputs, and a few steps of any inputs.
    fn any_case()(n in 0..12_usize, h in 0..20_usize, o in 0..20_usize, slope in -2.0_f32..2.0)(
        genes in prop::collection::vec(0.0_f32..=1.0, LeakyLayout::new(n, h, o).parameter_count()),
        range in prop::sample::select(vec![1e-6_f32, 0.3, 1.0, 6.0, 100.0]),
        input_bits in 3..=15_u32,
        inputs in prop::collection::vec(prop::collection::vec(any::<i16>(), n), 1..8),
        layout in Just(LeakyLayout::new(n, h, o).with_slope(slope)),
    ) -> (LeakyLayout, Vec<f32>, u32, Vec<Vec<i16>>) {
        (layout, decode(layout, range, &genes), input_bits, inputs)
    }
}

proptest! {
    #[test]
    fn equals_the_oracle((layout, parameters, input_bits, inputs) in any_case()) {
        let mut fixed = vec![0; parameters.len()];
        // Where sums of ten bits do not fit there is nothing to compare.
        let Ok(scale) = QuantizedScale::quantize(&layout, input_bits, &parameters, &mut fixed) else { return Ok(()) };
        for leak in Leak::ALL {
            let mut network = QuantizedNetwork::new(layout, leak, scale, &fixed, vec![9; layout.state_len()])?;
            let mut through_floats = network.clone();
            let mut oracle = Oracle::new(layout, leak, scale, &fixed);
            let (mut y, mut z) = (vec![0; layout.outputs()], vec![0.0; layout.outputs()]);
            for x in &inputs {
                network.step_quantized(x, &mut y);
                prop_assert_eq!(&y, &oracle.step(x));
                let hidden: Vec<i128> = network.hidden().iter().map(|h| i128::from(*h)).collect();
                prop_assert_eq!(&hidden, &oracle.hidden);
                prop_assert!(hidden.iter().all(|h| (0..=1 << 30).contains(h)));
                let floats: Vec<f32> = x.iter().map(|x| f32::from(*x) / (1_u32 << input_bits) as f32).collect();
                through_floats.step(&floats, &mut z);
                let back: Vec<f32> = y.iter().map(|y| f32::from(*y) / 32768.0).collect();
                prop_assert_eq!(&z, &back);
            }
        }
    }

    /// Rounded values are off by at most half a unit, and one more fraction bit does not fit.
    #[test]
    fn parameters_are_rounded_to_the_finest_units((layout, parameters, input_bits, _) in any_case()) {
        let mut fixed = vec![0; parameters.len()];
        let Ok(scale) = QuantizedScale::quantize(&layout, input_bits, &parameters, &mut fixed) else { return Ok(()) };
        let unit = 1.0 / f64::from(1_u32 << scale.weight_bits());
        let mut largest = 0.0_f64;
        for ((p, q), kind) in parameters.iter().zip(&fixed).zip(layout.kinds()) {
            let (exact, found) = match kind {
                LeakyParameter::Leak => (f64::from(*p) * unit * 16384.0, f64::from(*q) * unit),
                _ => (f64::from(*p) * f64::from(layout.slope()), f64::from(*q) * unit),
            };
            prop_assert!((exact - found).abs() <= 0.5000001 * unit, "{} is {}", exact, found);
            largest = if kind == LeakyParameter::Leak { largest } else { largest.max(exact.abs()) };
        }
        prop_assert!(scale.weight_bits() == 15 || 2.0 * largest / unit > 32767.0);
        let finer = QuantizedScale::new(input_bits, scale.weight_bits(), scale.sum_bits() + 1);
        let fits = |finer| QuantizedNetwork::new(layout, Leak::Filter, finer, &fixed, vec![0; layout.state_len()]).is_ok();
        prop_assert!(!finer.is_ok_and(fits));
    }

    /// A slow neuron arrives: the largest error of a leak of one unit is that of its rounding, not of its state.
    #[test]
    fn a_slow_neuron_does_not_stop_short(d in 4..200_i16, bias in -9830..9830_i16) {
        const ONE: LeakyLayout = LeakyLayout::new(0, 1, 0);
        let scale = QuantizedScale::new(9, 14, 20)?;
        let mut network = QuantizedNetwork::new(ONE, Leak::Filter, scale, [0, bias, d], [0; 3])?;
        (0..60_000).for_each(|_| network.step_quantized(&[], &mut []));
        let exact = farsa_num::logistic(f64::from(bias) / 16384.0);
        prop_assert!((f64::from(network.hidden()[0]) / f64::from(1 << 30) - exact).abs() < 6e-5);
    }
}

/// Largest and root mean square difference of motor values to the network of floats over a number of networks and steps.
fn deviation(layout: LeakyLayout, leak: Leak, range: f32, networks: u32, steps: u32) -> (f64, f64) {
    let (mut largest, mut squares, mut count) = (0.0_f64, 0.0_f64, 0_u32);
    for individual in 0..networks {
        let mut draw = Stream::new(16, Domain::InitialGenome, 0, individual, 0);
        let genes: Vec<f32> = (0..layout.parameter_count()).map(|_| draw.uniform()).collect();
        let parameters = decode(layout, range, &genes);
        let mut fixed = vec![0; parameters.len()];
        let scale = QuantizedScale::quantize(&layout, 9, &parameters, &mut fixed).expect("fits");
        let mut network = LeakyNetwork::new(layout, leak, &parameters, vec![0.0; layout.state_len()]).expect("valid");
        let mut integers =
            QuantizedNetwork::new(layout, leak, scale, fixed, vec![0; layout.state_len()]).expect("valid");
        let (mut x, mut y, mut z) =
            (vec![0.5; layout.sensors()], vec![0.0; layout.outputs()], vec![0.0; layout.outputs()]);
        let mut inputs = Stream::new(16, Domain::Sensor, 0, individual, 0);
        for step in 0..steps {
            // As the experiment's sensors: what moves a little, touches, a place in cm, and a label that changes twice.
            for (j, x) in x.iter_mut().enumerate() {
                *x = match j {
                    0..17 => (*x + inputs.range(-0.02, 0.02)).clamp(0.0, 1.0),
                    17..23 => inputs.below(4) as f32 / 3.0,
                    23..26 => (*x + inputs.range(-0.5, 0.5)).clamp(-30.0, 30.0),
                    _ => {
                        if step * 3 / steps == j as u32 - 26 {
                            50.0
                        } else {
                            0.0
                        }
                    }
                };
            }
            network.step(&x, &mut y);
            integers.step(&x, &mut z);
            for (y, z) in y.iter().zip(&z) {
                let difference = f64::from(y - z).abs();
                largest = largest.max(difference);
                squares += difference * difference;
                count += 1;
            }
        }
    }
    (largest, (squares / f64::from(count)).sqrt())
}

/// The table of the README, and the promise above it.
#[test]
fn motor_values_are_close_to_those_of_floats() {
    for leak in Leak::ALL {
        for range in [1.0, 6.0] {
            let (largest, rms) = deviation(LABELS, leak, range, 200, 600);
            println!("{leak:>8}, weights within {range}: largest {largest:.1e}, root mean square {rms:.1e}");
            let most = if range == 6.0 { [4e-3, 1e-4] } else { [1e-3, 5e-5] };
            assert!(largest < most[0] && rms < most[1], "{leak}, weights within {range}: {largest} and {rms}");
        }
    }
}

#[test]
fn construction_names_the_mistake() {
    const TINY: LeakyLayout = LeakyLayout::new(1, 1, 1);
    let scale = QuantizedScale::new(9, 14, 20).expect("valid");
    let build = |fixed: &[i16], state: &mut [i32]| QuantizedNetwork::new(TINY, Leak::Filter, scale, fixed, state).err();
    let mut state = [0; 3];
    assert_eq!(build(&[0; 5], &mut state), None);
    assert_eq!(build(&[0; 4], &mut state), Some(Error::Length { slice: Slice::Parameters, expected: 5, found: 4 }));
    assert_eq!(build(&[0; 5], &mut state[..2]), Some(Error::Length { slice: Slice::State, expected: 3, found: 2 }));
    assert_eq!(
        build(&[0, 0, 0, 0, 16385], &mut state),
        Some(Error::Parameter { index: 4, fault: ParameterFault::QuantizedLeak(16385) })
    );
    assert_eq!(
        build(&[0, 0, 0, 0, -1], &mut state).map(|error| error.to_string()),
        Some(
            "parameter 4, a leak, is -0.000061035156: outside [0, 1]; give leaks another gene range than weights"
                .into()
        )
    );

    let bits = |of, found, least, most| Err(Error::Layout(LayoutFault::FractionBits { of, found, least, most }));
    assert_eq!(QuantizedScale::new(16, 14, 20), bits("inputs", 16, 0, 15));
    assert_eq!(QuantizedScale::new(9, 16, 20), bits("weights", 16, 0, 15));
    assert_eq!(QuantizedScale::new(9, 14, 21), bits("sums", 21, 10, 20));
    assert_eq!(QuantizedScale::new(9, 2, 12), bits("sums", 12, 10, 11));
    assert_eq!(QuantizedScale::new(9, 14, 9), bits("sums", 9, 10, 20));
    assert_eq!(QuantizedScale::new(0, 5, 10), bits("sums", 10, 10, 5));

    let mut fixed = [0; 5];
    let mut quantize = |layout: &LeakyLayout, bits, p: [f32; 5]| QuantizedScale::quantize(layout, bits, &p, &mut fixed);
    assert_eq!(quantize(&TINY, 16, [0.0; 5]), bits("inputs", 16, 0, 15));
    assert_eq!(
        quantize(&TINY.with_slope(f32::NAN), 9, [0.0; 5]).map_err(|e| e.to_string()),
        Err("the slope of the logistic function is NaN: not finite".into())
    );
    assert_eq!(
        quantize(&TINY, 9, [0.0, f32::NAN, 0.0, 0.0, 0.0]),
        Err(Error::Parameter { index: 1, fault: ParameterFault::NotFinite })
    );
    assert_eq!(
        quantize(&TINY, 9, [0.0, 0.0, 0.0, 0.0, 2.0]),
        Err(Error::Parameter { index: 4, fault: ParameterFault::Leak(2.0) })
    );
    let huge = quantize(&TINY.with_slope(1.0), 9, [0.0, 0.0, 40_000.0, 0.0, 0.0]);
    assert_eq!(huge, Err(Error::Parameter { index: 2, fault: ParameterFault::Weight(40_000.0) }));
    let wide = QuantizedScale::quantize(&TINY, 9, &[0.0; 5], &mut [0; 4]);
    assert_eq!(wide, Err(Error::Length { slice: Slice::Parameters, expected: 5, found: 4 }));
    // A hundred weights of 1.2 and sensors to 32768: 2^15 * 1.2 * 100 = 3.9e6, times 2^10 over 2^31.
    let many = LeakyLayout::new(100, 1, 0);
    let mut fixed = vec![0; many.parameter_count()];
    let parameters: Vec<f32> = many.kinds().map(|kind| if kind == LeakyParameter::Leak { 1.0 } else { 6.0 }).collect();
    let error = QuantizedScale::quantize(&many, 0, &parameters, &mut fixed);
    assert!(
        matches!(error, Err(Error::Sum { target: 0, largest: 4_026_000_000..4_027_000_000, limit: 2_147_483_647 })),
        "{error:?}"
    );
}

/// The largest sums that construction lets pass do not overflow, which a debug build would notice.
#[test]
fn the_extremes_stay_within() -> Result<(), Error> {
    for (n, h) in [(29, 12), (60, 4), (3, 40)] {
        let layout = LeakyLayout::new(n, h, 3).with_slope(1.0);
        for sign in [-1.0, 1.0] {
            let parameters: Vec<f32> =
                layout.kinds().map(|kind| if kind == LeakyParameter::Leak { 1.0 } else { sign }).collect();
            let mut fixed = vec![0; parameters.len()];
            for input_bits in 0..=15 {
                let scale = QuantizedScale::quantize(&layout, input_bits, &parameters, &mut fixed)?;
                let mut network =
                    QuantizedNetwork::new(layout, Leak::Filter, scale, &fixed, vec![0; layout.state_len()])?;
                let mut y = [0; 3];
                for x in [i16::MAX, i16::MIN, i16::MAX] {
                    network.step_quantized(&vec![x; n], &mut y);
                    assert!(y.iter().all(|y| (0..=32767).contains(y)));
                }
            }
        }
    }
    Ok(())
}

#[test]
fn floats_enter_to_the_nearest() -> Result<(), Error> {
    let scale = QuantizedScale::new(9, 14, 20)?;
    let cases = [(0.0, 0), (1.0, 512), (-1.0, -512), (0.0029, 1), (64.0, 32767), (-1e9, -32768), (f32::NAN, 0)];
    for (x, fixed) in cases {
        assert_eq!(scale.input(x), fixed, "{x}");
    }
    assert_eq!(QuantizedScale::output(16384), 0.5);
    Ok(())
}
