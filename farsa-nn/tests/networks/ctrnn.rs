//! The continuous-time network against loops written from its equations, closed-form cases, and properties.

use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::{Activation, Controller, Ctrnn, CtrnnLayout, CtrnnParameter, Error, Integrator, Lesion, Lesioned};
use farsa_num::{Domain, Instructions, Stream};
use proptest::prelude::*;

/// The equations of the source, index by index, with separate vectors.
struct Oracle<'a> {
    layout: CtrnnLayout,
    time_step: f32,
    parameters: &'a [f32],
    y: Vec<f32>,
}

impl<'a> Oracle<'a> {
    fn new(layout: CtrnnLayout, time_step: f32, parameters: &'a [f32]) -> Self {
        Self { layout, time_step, parameters, y: vec![0.0; layout.neurons()] }
    }

    fn outputs(&self, y: &[f32]) -> Vec<f32> {
        let parts = self.layout.split(self.parameters);
        let one = |i: usize| self.layout.activation().apply(parts.gains[i] * (y[i] + parts.biases[i]));
        (0..y.len()).map(one).collect()
    }

    fn drive(&self, y: &[f32], x: &[f32]) -> Vec<f32> {
        let (n, o) = (y.len(), self.outputs(y));
        let parts = self.layout.split(self.parameters);
        let one = |i: usize| {
            let mut net = 0.0;
            match self.layout.direct_inputs() {
                Some(neurons) if neurons.contains(&i) => net = x[i - neurons.start],
                Some(_) => {}
                None => {
                    for k in 0..x.len() {
                        net += parts.input_weights[k * n + i] * x[k];
                    }
                }
            }
            for j in 0..n {
                net += parts.weights[j * n + i] * o[j];
            }
            net
        };
        (0..n).map(one).collect()
    }

    /// `dt/tau_i (net_i - y_i)` at these states.
    fn slopes(&self, y: &[f32], x: &[f32]) -> Vec<f32> {
        let (net, parts) = (self.drive(y, x), self.layout.split(self.parameters));
        let rate = |i: usize| (f64::from(self.time_step) / f64::from(parts.time_constants[i])) as f32;
        (0..y.len()).map(|i| rate(i) * (net[i] - y[i])).collect()
    }

    fn step(&mut self, x: &[f32]) -> Vec<f32> {
        let along = |y: &[f32], k: &[f32], by: f32| -> Vec<f32> { y.iter().zip(k).map(|(y, k)| y + k * by).collect() };
        let y = self.y.clone();
        match self.layout.integrator() {
            Integrator::Euler => self.y = along(&y, &self.slopes(&y, x), 1.0),
            Integrator::ExponentialEuler => {
                let (net, parts) = (self.drive(&y, x), self.layout.split(self.parameters));
                for i in 0..y.len() {
                    let z = f64::from(self.time_step) / f64::from(parts.time_constants[i]);
                    self.y[i] = if z < std::f64::consts::LN_2 {
                        y[i] + (farsa_num::tanh(0.5 * z) * (1.0 + farsa_num::exp(-z))) as f32 * (net[i] - y[i])
                    } else {
                        net[i] + (farsa_num::exp(-z) as f32) * (y[i] - net[i])
                    };
                }
            }
            Integrator::RungeKutta4 => {
                let a = self.slopes(&y, x);
                let b = self.slopes(&along(&y, &a, 0.5), x);
                let c = self.slopes(&along(&y, &b, 0.5), x);
                let d = self.slopes(&along(&y, &c, 1.0), x);
                for i in 0..y.len() {
                    self.y[i] = y[i] + (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) * (1.0 / 6.0);
                }
            }
        }
        self.outputs(&self.y)[self.layout.output_neurons()].to_vec()
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// Decodes genes [0..1] into ranges as those of the literature.
fn decode(layout: CtrnnLayout, genes: &[f32]) -> Vec<f32> {
    let decoded = |(gene, kind): (&f32, _)| match kind {
        CtrnnParameter::TimeConstant => 1.0 + 2.0 * gene,
        CtrnnParameter::Gain => 0.5 + gene,
        _ => 16.0 * gene - 8.0,
    };
    genes.iter().zip(layout.kinds()).map(decoded).collect()
}

fn drawn(layout: CtrnnLayout, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::Network, 0, 0, 0);
    let genes: Vec<f32> = (0..layout.parameter_count()).map(|_| stream.uniform()).collect();
    decode(layout, &genes)
}

fn state(layout: CtrnnLayout) -> Vec<f32> {
    vec![f32::NAN; layout.state_len()]
}

fn any_layout() -> impl Strategy<Value = CtrnnLayout> {
    let place = |n: usize| (0..=n, 0..=n).prop_map(|(a, b)| (a.min(b), a.max(b) - a.min(b)));
    let shape = (0..40_usize).prop_flat_map(move |n| (Just(n), place(n), place(n), 0..5_usize));
    let how = (any::<bool>(), prop::sample::select(&Integrator::ALL[..]), prop::sample::select(&Activation::ALL[..]));
    (shape, how).prop_map(|((n, (first, outputs), (to, direct), m), (weighted, integrator, activation))| {
        let layout = if weighted {
            CtrnnLayout::new(m, n, outputs)
        } else {
            CtrnnLayout::new(direct, n, outputs).with_direct_inputs(to)
        };
        layout.with_outputs_from(first).with_integrator(integrator).with_activation(activation)
    })
}

prop_compose! {
    /// A layout, its parameters, a time step and a few steps of inputs.
    fn any_case()(layout in any_layout())(
        genes in prop::collection::vec(0.0_f32..=1.0, layout.parameter_count()),
        inputs in prop::collection::vec(prop::collection::vec(-5.0_f32..5.0, layout.inputs()), 1..8),
        time_step in 0.01_f32..1.9,
        layout in Just(layout),
    ) -> (CtrnnLayout, f32, Vec<f32>, Vec<Vec<f32>>) {
        (layout, time_step, decode(layout, &genes), inputs)
    }
}

proptest! {
    #[test]
    fn equals_the_oracle_bit_for_bit((layout, time_step, parameters, inputs) in any_case()) {
        for instructions in Instructions::available() {
            let mut network = Ctrnn::new(layout, time_step, &parameters, state(layout))?.with_instructions(instructions);
            let mut oracle = Oracle::new(layout, time_step, &parameters);
            let mut y = vec![f32::NAN; layout.outputs()];
            for x in &inputs {
                network.step(x, &mut y);
                prop_assert_eq!(bits(&y), bits(&oracle.step(x)), "{:?}", instructions);
                prop_assert_eq!(bits(network.states()), bits(&oracle.y), "{:?}", instructions);
                prop_assert_eq!(bits(network.neuron_outputs()), bits(&oracle.outputs(&oracle.y)), "{:?}", instructions);
            }
        }
    }

    #[test]
    fn reset_and_new_parameters_leave_no_trace((layout, time_step, parameters, inputs) in any_case()) {
        let run = |network: &mut dyn Controller| {
            let mut y = vec![0.0; layout.outputs()];
            inputs.iter().flat_map(|x| { network.step(x, &mut y); bits(&y) }).collect::<Vec<u32>>()
        };
        let other = drawn(layout, 7);
        let first = run(&mut Ctrnn::new(layout, time_step, &parameters[..], state(layout))?);
        let mut network = Ctrnn::new(layout, time_step, &other[..], state(layout))?;
        run(&mut network);
        network.reset();
        prop_assert_eq!(network.set_parameters(&parameters)?, &other[..]);
        prop_assert_eq!(&run(&mut network), &first);
        let mut owner = Ctrnn::new(layout, time_step, other.clone(), state(layout))?;
        run(&mut owner);
        owner.copy_parameters(&parameters)?;
        owner.set_states(&vec![0.0; layout.neurons()])?;
        prop_assert_eq!(&run(&mut owner), &first);
    }

    /// Renumbering neurons changes only the order of rounding.
    #[test]
    fn renamed_neurons_are_the_same_neurons((seed, n) in (any::<u64>(), 1..20_usize), turn in 1..20_usize) {
        for integrator in Integrator::ALL {
            let layout = CtrnnLayout::new(2, n, n).with_integrator(integrator);
            let mut parameters = drawn(layout, seed);
            // Weights of a contracting net, so that a difference in rounding does not grow.
            for p in &mut parameters[..layout.range(CtrnnParameter::Weight).end] {
                *p /= 2.0 * n as f32;
            }
            let new = |i: usize| (i + turn) % n;
            let mut renamed = parameters.clone();
            for i in 0..n {
                (0..2).for_each(|k| renamed[k * n + new(i)] = parameters[k * n + i]);
                (0..n).for_each(|j| renamed[(2 + new(j)) * n + new(i)] = parameters[(2 + j) * n + i]);
                ((2 + n)..(5 + n)).for_each(|row| renamed[row * n + new(i)] = parameters[row * n + i]);
            }
            let mut one = Ctrnn::new(layout, 0.1, &parameters, state(layout))?;
            let mut other = Ctrnn::new(layout, 0.1, &renamed, state(layout))?;
            let (mut y, mut z) = (vec![0.0; n], vec![0.0; n]);
            for step in 0..200 {
                let x = [(step % 7) as f32 / 7.0, (step % 3) as f32];
                one.step(&x, &mut y);
                other.step(&x, &mut z);
                for i in 0..n {
                    prop_assert!((y[i] - z[new(i)]).abs() <= 1e-6, "{} is not {}", y[i], z[new(i)]);
                }
            }
        }
    }

    #[test]
    fn outputs_stay_in_range_whatever_comes_in(
        seed in any::<u64>(), n in 1..20_usize, direct in any::<bool>(),
        inputs in prop::collection::vec(prop_oneof![
            -1e6_f32..=1e6, Just(1e6), Just(-1e6), Just(1e30), Just(f32::MIN), Just(f32::INFINITY),
            Just(f32::NEG_INFINITY), Just(f32::NAN), Just(-0.0), Just(1e-40),
        ], 64),
    ) {
        for integrator in Integrator::ALL {
            let layout = CtrnnLayout::new(1, n, n).with_integrator(integrator);
            let layout = if direct { layout.with_direct_inputs(n / 2) } else { layout };
            let mut network = Ctrnn::new(layout, 0.5, drawn(layout, seed), state(layout))?;
            let mut y = vec![f32::NAN; n];
            for x in &inputs {
                network.step(&[*x], &mut y);
                prop_assert!(y.iter().all(|o| (0.0..=1.0).contains(o)), "{y:?} after {x}");
                prop_assert!(network.states().iter().all(|y| y.is_finite()), "{:?} after {x}", network.states());
            }
        }
    }

    /// From any state to any drive of the same sign, at any time constant: the exponential integrator is exact.
    #[test]
    fn a_neuron_alone_follows_the_exponential(
        (y0, input) in (1e-3_f32..1e3, 1e-3_f32..1e3), sign in any::<bool>(), (tau, time_step) in (1e-2_f32..1e2, 1e-3_f32..1e1),
    ) {
        let sign = if sign { 1.0 } else { -1.0 };
        let (y0, input) = (sign * y0, sign * input);
        let layout = CtrnnLayout::new(1, 1, 1).with_direct_inputs(0).with_integrator(Integrator::ExponentialEuler);
        let mut network = Ctrnn::new(layout, time_step, [0.0, 0.0, 1.0, tau], state(layout))?;
        for from in [0.0, y0] {
            network.set_states(&[from])?;
            network.step(&[input], &mut [0.0]);
            let (from, to) = (f64::from(from), f64::from(input));
            let z = f64::from(time_step) / f64::from(tau);
            // Convex, and from zero without cancellation.
            let exact = from * series_exp(-z) - to * series_expm1(-z);
            let found = network.states()[0];
            let ulp = f64::from((exact as f32).abs().next_up() - (exact as f32).abs());
            prop_assert!((f64::from(found) - exact).abs() <= 2.0 * ulp, "{found} is not {exact}");
        }
    }
}

#[test]
fn a_silent_neuron_is_one_that_nobody_hears() -> Result<(), Error> {
    for integrator in Integrator::ALL {
        let layout = CtrnnLayout::new(1, 11, 11).with_integrator(integrator);
        let parameters = drawn(layout, 5);
        let mut deaf = parameters.clone();
        deaf[11 + 3 * 11..11 + 4 * 11].fill(0.0);
        let lesions = [Lesion::new(3)];
        let mut without = Lesioned::new(Ctrnn::new(layout, 0.1, &parameters, state(layout))?, &lesions);
        let mut deaf = Ctrnn::new(layout, 0.1, &deaf, state(layout))?;
        let (mut y, mut z) = ([0.0; 11], [0.0; 11]);
        for step in 0..50 {
            without.step(&[step as f32 / 50.0], &mut y);
            deaf.step(&[step as f32 / 50.0], &mut z);
            assert_eq!(without.network().states(), deaf.states(), "{integrator}");
            assert_eq!((y[3], &y[4..]), (0.0, &z[4..]), "{integrator}");
        }
    }
    Ok(())
}

/// An exponential of the test's own: a series on small arguments, squared back.
fn series_expm1(x: f64) -> f64 {
    if x.abs() > 1e-2 {
        let half = series_expm1(0.5 * x);
        return half * (2.0 + half);
    }
    let mut sum = 0.0;
    for k in (1..12).rev() {
        sum = (1.0 + sum) * x / f64::from(k);
    }
    sum
}

fn series_exp(x: f64) -> f64 {
    // From the positive side, where nothing cancels.
    1.0 / (1.0 + series_expm1(-x))
}

#[test]
fn every_remainder_equals_the_oracle() -> Result<(), Error> {
    for n in [0, 1, 2, 7, 8, 9, 15, 16, 17, 31, 32, 33, 47, 64, 100, 257] {
        for integrator in Integrator::ALL {
            let layout = CtrnnLayout::new(3, n, n.min(5)).with_integrator(integrator);
            let parameters = drawn(layout, n as u64);
            for instructions in Instructions::available() {
                let mut network = Ctrnn::new(layout, 0.1, &parameters, state(layout))?.with_instructions(instructions);
                let mut oracle = Oracle::new(layout, 0.1, &parameters);
                let mut y = vec![f32::NAN; n.min(5)];
                for x in [[1.0, -4.0, 0.3], [0.0, 9.0, -2.0]] {
                    network.step(&x, &mut y);
                    assert_eq!(bits(&y), bits(&oracle.step(&x)), "{n} neurons, {integrator} at {instructions:?}");
                    assert_eq!(
                        bits(network.states()),
                        bits(&oracle.y),
                        "{n} neurons, {integrator} at {instructions:?}"
                    );
                }
            }
        }
    }
    Ok(())
}

#[test]
fn construction_names_the_mistake() {
    // One input, two neurons, one output: 2 weights of the input, 4, 2 biases, 2 gains, 2 time constants.
    const TINY: CtrnnLayout = CtrnnLayout::new(1, 2, 1);
    const GOOD: [f32; 12] = [1.0; 12];
    let with = |index: usize, value: f32| {
        let mut parameters = GOOD;
        parameters[index] = value;
        parameters
    };
    let build = |layout: CtrnnLayout, time_step: f32, parameters: &[f32]| {
        Ctrnn::new(layout, time_step, parameters, state(layout)).err()
    };
    assert_eq!(build(TINY, 0.1, &GOOD), None);
    for value in [0.0, -0.1, f32::INFINITY] {
        assert_eq!(build(TINY, value, &GOOD), Some(Error::Layout(LayoutFault::TimeStep(value))));
    }
    assert!(
        matches!(build(TINY, f32::NAN, &GOOD), Some(Error::Layout(LayoutFault::TimeStep(value))) if value.is_nan())
    );
    assert_eq!(build(TINY, 0.1, &GOOD[1..]), Some(Error::Length { slice: Slice::Parameters, expected: 12, found: 11 }));
    for (index, value) in [(0, f32::NAN), (5, f32::INFINITY), (11, f32::NEG_INFINITY)] {
        assert_eq!(
            build(TINY, 0.1, &with(index, value)),
            Some(Error::Parameter { index, fault: ParameterFault::NotFinite })
        );
    }
    let short =
        |index, value, least| Some(Error::Parameter { index, fault: ParameterFault::TimeConstant { value, least } });
    assert_eq!(build(TINY, 0.1, &with(11, 0.0)), short(11, 0.0, 0.05));
    assert_eq!(build(TINY, 0.1, &with(10, -3.0)), short(10, -3.0, 0.05));
    assert_eq!(build(TINY, 0.1, &with(10, 0.05)), None);
    assert_eq!(build(TINY, 0.1, &with(10, 0.049)), short(10, 0.049, 0.05));
    let layout = TINY.with_integrator(Integrator::RungeKutta4);
    assert_eq!(build(layout, 2.785, &with(10, 0.99)), short(10, 0.99, 1.0));
    let layout = TINY.with_integrator(Integrator::ExponentialEuler);
    assert_eq!(build(layout, 0.1, &with(10, 1e-30)), None);
    assert_eq!(build(layout, 0.1, &with(10, 0.0)), short(10, 0.0, 0.0));
    assert_eq!(
        build(TINY.with_direct_inputs(2), 0.1, &GOOD[2..]),
        Some(Error::Layout(LayoutFault::Neurons { first: 2, count: 1, neurons: 2 }))
    );
    assert_eq!(
        build(TINY.with_outputs_from(2), 0.1, &GOOD),
        Some(Error::Layout(LayoutFault::Neurons { first: 2, count: 1, neurons: 2 }))
    );
    assert_eq!(
        build(CtrnnLayout::new(1, 2, 3), 0.1, &GOOD),
        Some(Error::Layout(LayoutFault::Neurons { first: 0, count: 3, neurons: 2 }))
    );
    let found = TINY.state_len() - 1;
    let error = Ctrnn::new(TINY, 0.1, &GOOD, vec![0.0; found]).err();
    assert_eq!(error, Some(Error::Length { slice: Slice::State, expected: found + 1, found }));
    let huge = Ctrnn::new(CtrnnLayout::new(1, usize::MAX, 1), 0.1, GOOD, [0.0; 1]).err();
    assert_eq!(huge, Some(Error::Length { slice: Slice::Parameters, expected: usize::MAX, found: 12 }));
    let message = short(10, 0.02, 0.05).expect("an error").to_string();
    assert_eq!(
        message,
        "parameter 10, a time constant, is 0.02: below 0.05, where the integrator diverges at this time step"
    );
}

#[test]
fn refused_parameters_and_states_change_nothing() -> Result<(), Error> {
    let layout = CtrnnLayout::new(0, 1, 1);
    let mut network = Ctrnn::new(layout, 0.1, [1.0; 4], [0.0; 4])?;
    assert!(network.set_parameters([-1.0; 4]).is_err());
    assert!(network.copy_parameters(&[1.0; 3]).is_err());
    assert_eq!(network.set_states(&[0.0; 2]), Err(Error::Length { slice: Slice::State, expected: 1, found: 2 }));
    assert_eq!(network.set_states(&[f32::NAN]), Err(Error::State { index: 0 }));
    assert_eq!((network.parameters(), network.states()), (&[1.0; 4][..], &[0.0][..]));
    network.set_states(&[-1.0])?;
    assert_eq!((network.states(), network.neuron_outputs()), (&[-1.0][..], &[0.5][..]));
    Ok(())
}

#[test]
fn every_parameter_has_one_kind() {
    let layouts =
        [CtrnnLayout::new(3, 4, 2), CtrnnLayout::new(3, 4, 2).with_direct_inputs(1), CtrnnLayout::new(0, 0, 0)];
    for layout in layouts {
        let kinds: Vec<_> = layout.kinds().collect();
        assert_eq!(kinds.len(), layout.parameter_count());
        assert_eq!(layout.kind(kinds.len()), None);
        assert!(kinds.iter().enumerate().all(|(i, kind)| layout.kind(i) == Some(*kind)));
        let ramp: Vec<f32> = (0..kinds.len()).map(|i| i as f32).collect();
        let parts = layout.split(&ramp);
        let joined = [parts.input_weights, parts.weights, parts.biases, parts.gains, parts.time_constants].concat();
        assert_eq!(joined, ramp);
    }
}

#[test]
fn names_are_read_back() {
    for integrator in Integrator::ALL {
        assert_eq!(integrator.name().parse(), Ok(integrator));
        assert_eq!(format!("{integrator:?}").parse(), Ok(integrator));
    }
    for activation in Activation::ALL {
        assert_eq!(activation.name().parse(), Ok(activation));
    }
    assert_eq!(
        "rk4".parse::<Integrator>(),
        Err(Error::Name { of: "integrator", names: "euler, exponential-euler, runge-kutta-4" })
    );
    assert_eq!(
        "sigmoid".parse::<Activation>(),
        Err(Error::Name { of: "activation", names: "logistic, tanh, linear, step, rectified" })
    );
}

#[test]
#[cfg_attr(debug_assertions, should_panic = "sensor values")]
fn a_missing_input_counts_for_nothing() {
    for layout in [CtrnnLayout::new(2, 9, 9), CtrnnLayout::new(2, 9, 9).with_direct_inputs(3)] {
        let parameters = drawn(layout, 3);
        let mut network = Ctrnn::new(layout, 0.1, &parameters, state(layout)).expect("valid");
        let (mut short, mut whole) = ([0.0; 9], [0.0; 9]);
        network.step(&[1.0], &mut short);
        network.reset();
        network.step(&[1.0, 0.0], &mut whole);
        assert_eq!(short, whole);
        let mut long = [-1.0; 10];
        network.reset();
        network.step(&[1.0, 0.0, 7.0], &mut long);
        assert_eq!((&long[..9], long[9]), (&whole[..], -1.0));
    }
}
