//! The network against loops written from its equations, hand-computed cases and properties.

use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::{Controller, Error, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa_num::Instructions;
use proptest::prelude::*;

const LABELS: LeakyLayout = LeakyLayout::new(29, 12, 23);

/// The equations of the source, index by index, with separate vectors.
struct Oracle<'a> {
    layout: LeakyLayout,
    leak: Leak,
    parameters: &'a [f32],
    hidden: Vec<f32>,
    response: Vec<f32>,
}

impl<'a> Oracle<'a> {
    fn new(layout: LeakyLayout, leak: Leak, parameters: &'a [f32]) -> Self {
        let zeros = vec![0.0; layout.hidden()];
        Self { layout, leak, parameters, hidden: zeros.clone(), response: zeros }
    }

    fn step(&mut self, x: &[f32]) -> Vec<f32> {
        let (n, h, o) = (self.layout.sensors(), self.layout.hidden(), self.layout.outputs());
        let p = self.parameters;
        let sigma = |x: f32| farsa_num::logistic(self.layout.slope() * x);
        let mut response = vec![0.0; h];
        for i in 0..h {
            let mut net = p[n * h + h * h + h * o + i];
            for j in 0..n {
                net += p[j * h + i] * x[j];
            }
            for k in 0..h {
                net += p[n * h + k * h + i] * self.hidden[k];
            }
            response[i] = sigma(net);
        }
        for i in 0..h {
            let d = p[n * h + h * h + h * o + h + i];
            self.hidden[i] = match self.leak {
                Leak::Filter => d * response[i] + (1.0 - d) * self.hidden[i],
                Leak::TwoTap => d * response[i] + (1.0 - d) * self.response[i],
                Leak::Evonet => d * self.hidden[i] + (1.0 - d) * response[i],
            };
        }
        self.response = response;
        let mut y = vec![0.0; o];
        for i in 0..o {
            let mut net = 0.0;
            for j in 0..h {
                net += p[n * h + h * h + j * o + i] * self.hidden[j];
            }
            y[i] = sigma(net);
        }
        y
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// Decodes genes [0..1] as the experiment does.
fn decode(layout: LeakyLayout, genes: &[f32]) -> Vec<f32> {
    let decoded = |(gene, kind): (&f32, _)| if kind == LeakyParameter::Leak { *gene } else { 12.0 * gene - 6.0 };
    genes.iter().zip(layout.kinds()).map(decoded).collect()
}

fn state(layout: LeakyLayout) -> Vec<f32> {
    vec![f32::NAN; layout.state_len()]
}

fn any_layout() -> impl Strategy<Value = LeakyLayout> {
    // Up to 72 targets: every number of vectors side by side, twice, and every remainder.
    (0..12_usize, 0..72_usize, 0..72_usize).prop_map(|(n, h, o)| LeakyLayout::new(n, h, o))
}

prop_compose! {
    /// A layout, its parameters and a few steps of inputs.
    fn any_case()(layout in any_layout())(
        genes in prop::collection::vec(0.0_f32..=1.0, layout.parameter_count()),
        inputs in prop::collection::vec(prop::collection::vec(-50.0_f32..50.0, layout.sensors()), 1..8),
        layout in Just(layout),
    ) -> (LeakyLayout, Vec<f32>, Vec<Vec<f32>>) {
        (layout, decode(layout, &genes), inputs)
    }
}

proptest! {
    #[test]
    fn equals_the_oracle_bit_for_bit((layout, parameters, inputs) in any_case()) {
        for (leak, instructions) in Leak::ALL.into_iter().flat_map(|leak| Instructions::available().map(move |instructions| (leak, instructions))) {
            let mut network = LeakyNetwork::new(layout, leak, &parameters, state(layout))?.with_instructions(instructions);
            let mut oracle = Oracle::new(layout, leak, &parameters);
            let mut y = vec![f32::NAN; layout.outputs()];
            for x in &inputs {
                network.step(x, &mut y);
                prop_assert_eq!(bits(&y), bits(&oracle.step(x)), "{:?}", instructions);
                prop_assert_eq!(bits(network.hidden()), bits(&oracle.hidden), "{:?}", instructions);
                prop_assert!(y.iter().chain(network.hidden()).all(|v| (0.0..=1.0).contains(v)));
            }
        }
    }

    #[test]
    fn without_leak_the_readings_agree((layout, mut parameters, inputs) in any_case()) {
        let leaks = layout.range(LeakyParameter::Leak);
        parameters[leaks.clone()].fill(1.0);
        let mut reversed = parameters.clone();
        reversed[leaks].fill(0.0);
        let mut filter = LeakyNetwork::new(layout, Leak::Filter, &parameters, state(layout))?;
        let mut two_tap = LeakyNetwork::new(layout, Leak::TwoTap, &parameters, state(layout))?;
        let mut evonet = LeakyNetwork::new(layout, Leak::Evonet, &reversed, state(layout))?;
        for x in &inputs {
            let mut y = vec![vec![0.0; layout.outputs()]; 3];
            filter.step(x, &mut y[0]);
            two_tap.step(x, &mut y[1]);
            evonet.step(x, &mut y[2]);
            prop_assert_eq!(bits(&y[0]), bits(&y[1]));
            prop_assert_eq!(bits(&y[0]), bits(&y[2]));
            prop_assert_eq!(filter.hidden(), two_tap.hidden());
            prop_assert_eq!(filter.hidden(), evonet.hidden());
        }
    }

    #[test]
    fn a_neuron_that_takes_nothing_new_stays_at_rest((layout, mut parameters, inputs) in any_case()) {
        parameters[layout.range(LeakyParameter::Leak)].fill(0.0);
        let mut network = LeakyNetwork::new(layout, Leak::Filter, &parameters, state(layout))?;
        let mut y = vec![0.0; layout.outputs()];
        for x in &inputs {
            network.step(x, &mut y);
            prop_assert!(network.hidden().iter().all(|&h| h == 0.0));
            prop_assert!(y.iter().all(|&o| o == 0.5));
        }
    }

    /// An output does not depend on the other outputs in its vector.
    #[test]
    fn reversed_outputs_are_the_same_outputs((layout, parameters, inputs) in any_case()) {
        let mut reversed = parameters.clone();
        for row in reversed[layout.range(LeakyParameter::OutputWeight)].chunks_mut(layout.outputs().max(1)) {
            row.reverse();
        }
        let mut network = LeakyNetwork::new(layout, Leak::Filter, &parameters, state(layout))?;
        let mut mirror = LeakyNetwork::new(layout, Leak::Filter, &reversed, state(layout))?;
        let (mut y, mut z) = (vec![0.0; layout.outputs()], vec![0.0; layout.outputs()]);
        for x in &inputs {
            network.step(x, &mut y);
            mirror.step(x, &mut z);
            z.reverse();
            prop_assert_eq!(bits(&y), bits(&z));
        }
    }

    #[test]
    fn reset_and_new_parameters_leave_no_trace((layout, parameters, inputs) in any_case()) {
        let other: Vec<f32> = parameters.iter().map(|p| if (0.0..=1.0).contains(p) { 1.0 - p } else { -p }).collect();
        for leak in Leak::ALL {
            let run = |network: &mut dyn Controller| {
                let mut y = vec![0.0; layout.outputs()];
                inputs.iter().flat_map(|x| { network.step(x, &mut y); bits(&y) }).collect::<Vec<u32>>()
            };
            let first = run(&mut LeakyNetwork::new(layout, leak, &parameters[..], state(layout))?);
            let mut network = LeakyNetwork::new(layout, leak, &other[..], state(layout))?;
            run(&mut network);
            network.reset();
            prop_assert_eq!(network.set_parameters(&parameters)?, &other[..]);
            prop_assert_eq!(&run(&mut network), &first);
            let mut owner = LeakyNetwork::new(layout, leak, other.clone(), state(layout))?;
            run(&mut owner);
            owner.reset();
            owner.copy_parameters(&parameters)?;
            prop_assert_eq!(owner.parameters(), &parameters[..]);
            prop_assert_eq!(&run(&mut owner), &first);
        }
    }
}

#[test]
fn every_remainder_equals_the_oracle() -> Result<(), Error> {
    const SIZES: [usize; 14] = [0, 1, 2, 7, 8, 9, 15, 16, 17, 24, 31, 33, 47, 1000];
    println!("instructions that ran: {:?}", Instructions::available().collect::<Vec<_>>());
    for (hidden, outputs) in SIZES.into_iter().flat_map(|h| SIZES.map(|o| (h, o))) {
        let layout = LeakyLayout::new(3, hidden, outputs);
        let genes: Vec<f32> = (0..layout.parameter_count()).map(|i| (i * 7919 % 1009) as f32 / 1008.0).collect();
        let parameters = decode(layout, &genes);
        for instructions in Instructions::available() {
            let mut network =
                LeakyNetwork::new(layout, Leak::Filter, &parameters, state(layout))?.with_instructions(instructions);
            let mut oracle = Oracle::new(layout, Leak::Filter, &parameters);
            let mut y = vec![f32::NAN; outputs];
            for x in [[1.0, -40.0, 0.3], [0.0, 9.0, -2.0]] {
                network.step(&x, &mut y);
                assert_eq!(bits(&y), bits(&oracle.step(&x)), "3-{hidden}-{outputs} at {instructions:?}");
                assert_eq!(bits(network.hidden()), bits(&oracle.hidden), "3-{hidden}-{outputs} at {instructions:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn two_steps_by_hand() -> Result<(), Error> {
    // One sensor (w 2), one hidden neuron (r 5, bias 1, leak 0.25), one output (w 4).
    const TINY: LeakyLayout = LeakyLayout::new(1, 1, 1);
    let close = |a: f32, b: f32| assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    // x = 2: net 5, y = 1/(1 + exp(-1)) = 0.7310586. x = 0: net 1 + 5*H(1).
    let cases = [
        (Leak::Filter, [0.182_764_6, 0.285_708_4], [0.536_487_9, 0.556_894_2]),
        (Leak::TwoTap, [0.182_764_6, 0.696_928_9], [0.536_487_9, 0.635_883_9]),
        (Leak::Evonet, [0.548_293_9, 0.646_178_6], [0.607_933_8, 0.626_432_6]),
    ];
    for (leak, hidden, output) in cases {
        let mut network = LeakyNetwork::new(TINY, leak, [2.0, 5.0, 4.0, 1.0, 0.25], [0.0; 3])?;
        let mut y = [0.0];
        for (x, (h, o)) in [2.0, 0.0].into_iter().zip(hidden.into_iter().zip(output)) {
            network.step(&[x], &mut y);
            close(network.hidden()[0], h);
            close(y[0], o);
        }
    }
    Ok(())
}

#[test]
fn runs_from_a_static() -> Result<(), Error> {
    static PARAMETERS: [f32; LABELS.parameter_count()] = [0.25; LABELS.parameter_count()];
    let mut network = LeakyNetwork::new(LABELS, Leak::Filter, &PARAMETERS, [0.0; LABELS.state_len()])?;
    let mut owned = LeakyNetwork::new(LABELS, Leak::Filter, PARAMETERS.to_vec(), vec![0.0; LABELS.state_len()])?;
    let (mut y, mut z) = ([0.0; 23], [0.0; 23]);
    for _ in 0..10 {
        network.step(&[1.0; 29], &mut y);
        owned.step(&[1.0; 29], &mut z);
        assert_eq!(y, z);
    }
    let (parameters, state) = network.into_parts();
    assert_eq!(parameters.as_ptr(), PARAMETERS.as_ptr());
    assert_eq!(state[..12], owned.hidden()[..]);
    Ok(())
}

#[test]
fn construction_names_the_mistake() {
    const TINY: LeakyLayout = LeakyLayout::new(1, 1, 1);
    let build = |parameters: &[f32], state: &mut [f32]| LeakyNetwork::new(TINY, Leak::Filter, parameters, state).err();
    let mut state = [0.0; 3];
    assert_eq!(build(&[0.0; 5], &mut state), None);
    assert_eq!(build(&[0.0; 4], &mut state), Some(Error::Length { slice: Slice::Parameters, expected: 5, found: 4 }));
    assert_eq!(build(&[0.0; 5], &mut state[..2]), Some(Error::Length { slice: Slice::State, expected: 3, found: 2 }));
    assert_eq!(
        build(&[0.0, 0.0, f32::NAN, 0.0, 2.0], &mut state),
        Some(Error::Parameter { index: 2, fault: ParameterFault::NotFinite })
    );
    assert_eq!(
        build(&[0.0, 0.0, 0.0, 0.0, f32::INFINITY], &mut state),
        Some(Error::Parameter { index: 4, fault: ParameterFault::NotFinite })
    );
    assert_eq!(
        build(&[0.0, 0.0, 0.0, 0.0, 1.5], &mut state),
        Some(Error::Parameter { index: 4, fault: ParameterFault::Leak(1.5) })
    );
    let steep = LeakyNetwork::new(TINY.with_slope(f32::INFINITY), Leak::Filter, [0.0; 5], [0.0; 3]).err();
    assert_eq!(steep, Some(Error::Layout(LayoutFault::Slope(f32::INFINITY))));
    let huge = LeakyLayout::new(usize::MAX, 2, 2);
    let error = LeakyNetwork::new(huge, Leak::Filter, [0.0; 5], [0.0; 3]).err();
    assert_eq!(error, Some(Error::Length { slice: Slice::Parameters, expected: usize::MAX, found: 5 }));
}

#[test]
fn refused_parameters_change_nothing() -> Result<(), Error> {
    let mut network = LeakyNetwork::new(LeakyLayout::new(1, 1, 1), Leak::Filter, [0.5; 5], [0.0; 3])?;
    assert!(network.set_parameters([2.0; 5]).is_err());
    assert!(network.copy_parameters(&[0.0; 4]).is_err());
    assert_eq!(network.parameters(), [0.5; 5]);
    Ok(())
}

#[test]
fn every_parameter_has_one_kind() {
    for layout in [LABELS, LeakyLayout::new(26, 12, 23), LeakyLayout::new(0, 3, 1), LeakyLayout::new(2, 0, 2)] {
        let kinds: Vec<_> = layout.kinds().collect();
        assert_eq!(kinds.len(), layout.parameter_count());
        assert_eq!(layout.kind(kinds.len()), None);
        for (i, &kind) in kinds.iter().enumerate() {
            assert_eq!(layout.kind(i), Some(kind));
            assert!(layout.range(kind).contains(&i));
        }
        let ramp: Vec<f32> = (0..kinds.len()).map(|i| i as f32).collect();
        let parts = layout.split(&ramp);
        let joined =
            [parts.sensor_weights, parts.recurrent_weights, parts.output_weights, parts.biases, parts.leaks].concat();
        assert_eq!(joined, ramp);
    }
}

#[test]
fn a_leak_is_known_by_its_name() {
    for leak in Leak::ALL {
        assert_eq!(leak.name().parse(), Ok(leak));
        assert_eq!(format!("{leak:?}").parse(), Ok(leak));
        assert_eq!(format!("{leak:>8}"), format!("{:>8}", leak.name()));
    }
    assert_eq!("filt".parse::<Leak>(), Err(Error::Name { of: "leak", names: "filter, two-tap, evonet" }));
    assert_eq!("".parse::<Leak>(), Err(Error::Name { of: "leak", names: "filter, two-tap, evonet" }));
}

#[test]
#[cfg_attr(debug_assertions, should_panic = "sensor values")]
fn a_missing_sensor_counts_for_nothing() {
    let parameters = decode(LABELS, &[0.75; 792]);
    let mut network = LeakyNetwork::new(LABELS, Leak::Filter, &parameters, state(LABELS)).expect("valid");
    let (mut short, mut whole) = ([0.0; 23], [0.0; 23]);
    network.step(&[1.0; 28], &mut short);
    network.reset();
    let mut x = [1.0; 29];
    x[28] = 0.0;
    network.step(&x, &mut whole);
    assert_eq!(short, whole);
    network.reset();
    network.step(&[[1.0; 28].as_slice(), &[0.0, 9.0, 9.0]].concat(), &mut short);
    assert_eq!(short, whole);
}

#[test]
#[cfg_attr(debug_assertions, should_panic = "motor values")]
fn surplus_outputs_are_left_alone() {
    let parameters = decode(LABELS, &[0.75; 792]);
    let mut network = LeakyNetwork::new(LABELS, Leak::Filter, &parameters, state(LABELS)).expect("valid");
    let (mut long, mut short) = ([-1.0; 25], [0.0; 22]);
    network.step(&[1.0; 29], &mut long);
    assert_eq!(long[23..], [-1.0; 2]);
    network.reset();
    network.step(&[1.0; 29], &mut short);
    assert_eq!(short, long[..22]);
}
