//! Gradients of perceptrons, continuous-time networks and block networks against finite differences, and their runs against the
//! networks.
#![cfg(feature = "alloc")]

use farsa_nn::block::{Architecture, Block, BlockLayout, BlockNetwork, BlockParameter, Group, Span};
use farsa_nn::fault::LayoutFault;
use farsa_nn::learning::{Adam, Demonstration, Differentiable, Gradient, Learner, Loss};
use farsa_nn::{
    Activation, Controller, Ctrnn, CtrnnLayout, CtrnnParameter, Error, Integrator, Leak, Network, Perceptron,
};
use farsa_num::Stream;
use proptest::prelude::*;

/// Numbers of a stream in a range.
fn draws(stream: &mut Stream, count: usize, low: f32, high: f32) -> Vec<f32> {
    (0..count).map(|_| stream.range(low, high)).collect()
}

/// Compares the gradient with finite differences, and the cost with that of the network's motor values.
fn check<M, P, S>(network: &mut Network<M, P, S>, losses: &[Loss], seed: u64, ticks: usize)
where
    M: Differentiable,
    P: AsRef<[f32]>,
    S: AsMut<[f32]>,
    Network<M, P, S>: Controller,
{
    const STEP: f64 = 1e-5;
    let mut stream = Stream::from_seed(seed);
    let (inputs, outputs) = (Controller::inputs(network), Controller::outputs(network));
    let (x, wanted) = (draws(&mut stream, inputs * ticks, -2.0, 2.0), draws(&mut stream, outputs * ticks, 0.0, 1.0));
    let demonstration = Demonstration { x: &x, wanted: &wanted };
    let parameters: Vec<f64> = network.parameters().iter().map(|p| f64::from(*p)).collect();
    for loss in losses {
        let mut gradient = Gradient::<f64, M>::of(network, *loss).expect("a gradient");
        let cost = gradient.add(&parameters, demonstration).expect("a cost");
        let exact = gradient.sum().to_vec();
        for (index, exact) in exact.iter().enumerate() {
            let mut cost_at = |by: f64| {
                let mut parameters = parameters.clone();
                parameters[index] += by;
                gradient.cost(&parameters, demonstration).expect("a cost")
            };
            let difference = (cost_at(STEP) - cost_at(-STEP)) / (2.0 * STEP);
            let scale = 1.0 + exact.abs();
            assert!((difference - exact).abs() < 1e-5 * scale, "parameter {index}: {exact} is not {difference}");
        }
        if *loss == Loss::SquaredError {
            network.reset();
            let mut y = vec![0.0; outputs];
            let mut expected = 0.0;
            for (x, wanted) in x.chunks(inputs).zip(wanted.chunks(outputs)) {
                network.step(x, &mut y);
                expected +=
                    y.iter().zip(wanted).map(|(y, wanted)| f64::from(y - wanted) * f64::from(y - wanted)).sum::<f64>();
            }
            assert!((cost - expected).abs() < 1e-4 * (1.0 + expected), "{cost} is not {expected}");
        }
    }
}

const BOTH: [Loss; 2] = [Loss::SquaredError, Loss::CrossEntropy];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn of_a_perceptron(n in 1..5_usize, o in 1..4_usize, ticks in 1..6_usize, slope in 0.1_f32..1.5, seed in 0..u64::MAX) {
        let mut stream = Stream::from_seed(seed);
        let parameters = draws(&mut stream, Perceptron::parameter_count(n, o), -2.0, 2.0);
        check(&mut Perceptron::new(n, o, slope, parameters)?, &BOTH, seed, ticks);
    }

    #[test]
    fn of_a_continuous_network(
        [m, n, o] in [1..4_usize, 3..6_usize, 1..3_usize],
        (integrator, activation, direct) in (0..3_usize, 0..3_usize, any::<bool>()),
        ticks in 1..6_usize,
        seed in 0..u64::MAX,
    ) {
        let integrator = [Integrator::Euler, Integrator::ExponentialEuler, Integrator::RungeKutta4][integrator];
        let activation = [Activation::Logistic, Activation::Tanh, Activation::Linear][activation];
        let layout = CtrnnLayout::new(m, n, o).with_integrator(integrator).with_activation(activation);
        let layout = if direct { layout.with_direct_inputs(n - m.min(n)) } else { layout };
        let mut stream = Stream::from_seed(seed);
        let parameter = |kind| match kind {
            CtrnnParameter::TimeConstant => stream.range(0.1, 1.0),
            CtrnnParameter::Gain => stream.range(0.5, 1.5),
            _ => stream.range(-1.0, 1.0),
        };
        let parameters: Vec<f32> = layout.kinds().map(parameter).collect();
        let mut network = Ctrnn::new(layout, 0.05, parameters, vec![0.0; layout.state_len()])?;
        let losses = if activation == Activation::Logistic { &BOTH[..] } else { &BOTH[..1] };
        check(&mut network, losses, seed, ticks);
    }

    #[test]
    fn of_the_known_architectures(kind in 0..4_usize, leak in 0..3_usize, ticks in 1..7_usize, seed in 0..u64::MAX) {
        let plan = match kind {
            0 => Architecture::feed_forward(3, 4, 2),
            1 => Architecture::elman(3, 4, 2),
            2 => Architecture::jordan(3, 4, 2),
            _ => Architecture::fully_recurrent(3, 4, 2),
        };
        let plan = plan.plan();
        of_blocks(plan.layout(), Leak::ALL[leak], &BOTH, seed, ticks);
    }

    /// Leaks, gains, modulated gains, delays, slopes, every smooth function, leaky inputs and outputs, and a second update.
    #[test]
    fn of_blocks_of_every_kind(leak in 0..3_usize, delay in 0..4_usize, ticks in 1..9_usize, seed in 0..u64::MAX) {
        let [x, a, b, o] = [Span::new(0, 2), Span::new(2, 3), Span::new(5, 2), Span::new(7, 2)];
        let groups = [
            Group::new(2, Activation::Linear).with_leaks(),
            Group::new(3, Activation::Tanh).with_biases().with_gains().with_leaks(),
            Group { slope: 0.7, ..Group::new(2, Activation::Logistic).with_biases().with_gains() },
            Group::new(2, Activation::Logistic).with_biases().with_leaks(),
        ];
        let blocks = [
            Block::Update(x),
            Block::connect(x, a),
            Block::connect(a, a).delayed(1),
            Block::connect(o, a).delayed(delay),
            Block::Gain(a),
            Block::Update(a),
            Block::ModulatedGain { neurons: b, by: 3 },
            Block::connect(b, b).delayed(delay),
            Block::connect(Span::new(0, 5), b),
            Block::Update(b),
            Block::connect(Span::new(1, 6), o),
            Block::Update(Span::new(6, 3)),
        ];
        of_blocks(BlockLayout::new(2, 2, &groups, &blocks), Leak::ALL[leak], &BOTH[..1], seed, ticks);
    }
}

fn of_blocks(layout: BlockLayout<'_>, leak: Leak, losses: &[Loss], seed: u64, ticks: usize) {
    let mut stream = Stream::from_seed(seed);
    let parameter = |kind| match kind {
        BlockParameter::Leak => stream.range(0.1, 0.9),
        BlockParameter::Gain => stream.range(0.5, 1.5),
        _ => stream.range(-1.0, 1.0),
    };
    let parameters: Vec<f32> = layout.kinds().map(parameter).collect();
    let network = BlockNetwork::new(layout, leak, parameters, vec![0.0; layout.state_len()]);
    check(&mut network.expect("a network"), losses, seed, ticks);
}

#[test]
fn cross_entropy_requires_logistic_outputs() {
    let layout = CtrnnLayout::new(1, 2, 1).with_activation(Activation::Tanh);
    let network = Ctrnn::new(layout, 0.1, vec![1.0; layout.parameter_count()], vec![0.0; layout.state_len()]);
    let refused = Gradient::<f64, _>::of(&network.expect("a network"), Loss::CrossEntropy).err();
    assert_eq!(refused, Some(Error::Layout(LayoutFault::Loss)));
    let groups = [Group::new(1, Activation::Linear), Group::new(1, Activation::Logistic).with_leaks()];
    let blocks = [Block::Update(Span::new(0, 1)), Block::connect(Span::new(0, 1), Span::new(1, 1))];
    let layout = BlockLayout::new(1, 1, &groups, &blocks);
    let network = BlockNetwork::new(layout, Leak::Filter, [0.5; 2], vec![0.0; layout.state_len()]).expect("a network");
    assert!(Gradient::<f64, _>::of(&network, Loss::CrossEntropy).is_err());
    assert!(Gradient::<f64, _>::of(&network, Loss::SquaredError).is_ok());
}

/// A flag is visible in the first tick and required in the last.
#[test]
fn recurrent_networks_learn_to_remember() {
    let flag = |shown: f32| {
        let x: Vec<f32> = (0..6).map(|tick| if tick == 0 { shown } else { 0.0 }).collect();
        (x, vec![shown; 6])
    };
    let flags = [flag(0.0), flag(1.0)];
    let all = || flags.iter().map(|(x, wanted)| Demonstration { x, wanted });
    let mut stream = Stream::from_seed(9);
    let layout = CtrnnLayout::new(1, 4, 1);
    let parameter = |kind| match kind {
        CtrnnParameter::TimeConstant => 0.2,
        CtrnnParameter::Gain => 1.0,
        _ => stream.range(-1.0, 1.0),
    };
    let parameters: Vec<f32> = layout.kinds().map(parameter).collect();
    let network = Ctrnn::new(layout, 0.1, parameters, vec![0.0; layout.state_len()]).expect("a network");
    let gains = layout.range(CtrnnParameter::Gain);
    let learner: Learner<f64, _, _> = Learner::of(&network, Loss::CrossEntropy, Adam::new(0.05)).expect("a learner");
    let mut learner = learner.with_frozen(gains.clone());
    let first = learner.cost(all()).expect("a cost");
    for _ in 0..500 {
        learner.learn(all()).expect("a step");
    }
    let last = learner.cost(all()).expect("a cost");
    assert!(first > 0.5 && last < 0.1, "{first} {last}");
    let constants = layout.range(CtrnnParameter::TimeConstant);
    assert!(learner.parameters()[constants].iter().all(|tau| *tau >= 1e-3));
    assert!(learner.parameters()[gains].iter().all(|gain| *gain == 1.0));
    let plan = Architecture::elman(1, 4, 1).plan();
    let layout = plan.layout();
    let parameters = draws(&mut stream, layout.parameter_count(), -1.0, 1.0);
    let network = BlockNetwork::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len()]);
    let network = network.expect("a network");
    let mut learner: Learner<f64, _, _> =
        Learner::of(&network, Loss::CrossEntropy, Adam::new(0.05)).expect("a learner");
    for _ in 0..500 {
        learner.learn(all()).expect("a step");
    }
    assert!(learner.cost(all()).expect("a cost") < 0.05, "{:?}", learner.cost(all()));
}
