//! Networks of blocks against loops written from their equations, against the other networks, and in the original's order.

use farsa_nn::block::{
    Architecture, Block, BlockLayout, BlockNetwork, BlockParameter, BlockPlan, EvonetRanges, Group, Span,
};
use farsa_nn::fault::{LayoutFault, ParameterFault, Slice};
use farsa_nn::{
    Ablatable, Activation, Controller, Error, Leak, LeakyLayout, LeakyNetwork, LeakyParameter, Lesion, Lesioned,
};
use farsa_num::{Domain, Instructions, Stream};
use proptest::prelude::*;

/// A neuron with its parameters.
#[derive(Clone, Copy)]
struct Neuron {
    group: Group,
    bias: f32,
    gain: f32,
    leak: f32,
}

/// The equations, neuron by neuron, with a history instead of rings.
struct Oracle<'a> {
    layout: BlockLayout<'a>,
    leak: Leak,
    parameters: &'a [f32],
    neurons: Vec<Neuron>,
    activations: Vec<f32>,
    responses: Vec<f32>,
    /// The values sent by each block, step by step.
    sent: Vec<Vec<Vec<f32>>>,
}

impl<'a> Oracle<'a> {
    fn new(layout: BlockLayout<'a>, leak: Leak, parameters: &'a [f32]) -> Self {
        let [mut bias, mut gain, mut decay] = [BlockParameter::Bias, BlockParameter::Gain, BlockParameter::Leak]
            .map(|kind| parameters[layout.range(kind)].iter().copied());
        let mut neurons = Vec::new();
        for group in layout.groups() {
            for _ in 0..group.neurons {
                neurons.push(Neuron {
                    group: *group,
                    bias: if group.bias { bias.next().expect("a bias") } else { 0.0 },
                    gain: if group.gain { gain.next().expect("a gain") } else { 1.0 },
                    leak: if group.leak { decay.next().expect("a leak") } else { f32::NAN },
                });
            }
        }
        let zeros = vec![0.0; neurons.len()];
        let sent = vec![Vec::new(); layout.blocks().len()];
        Self { layout, leak, parameters, neurons, activations: zeros.clone(), responses: zeros, sent }
    }

    fn step(&mut self, x: &[f32]) -> Vec<f32> {
        let mut net: Vec<f32> = self.neurons.iter().map(|n| n.bias).collect();
        let mut gains: Vec<f32> = self.neurons.iter().map(|n| n.gain).collect();
        let mut weight = 0;
        for (b, block) in self.layout.blocks().iter().enumerate() {
            match *block {
                Block::Connect { from, to, delay } => {
                    let now = (from.first..from.end()).map(|j| self.activations[j] * gains[j]).collect();
                    self.sent[b].push(now);
                    let zeros = vec![0.0; from.count];
                    let then = self.sent[b].len().checked_sub(1 + delay).map_or(&zeros, |step| &self.sent[b][step]);
                    for (j, sent) in then.iter().enumerate() {
                        for i in 0..to.count {
                            net[to.first + i] += self.parameters[weight + j * to.count + i] * sent;
                        }
                    }
                    weight += from.count * to.count;
                }
                Block::Update(span) => {
                    for i in span.first..span.end() {
                        let Neuron { group, leak: d, .. } = self.neurons[i];
                        let y = if i < x.len() { x[i] } else { group.activation.apply(group.slope * net[i]) };
                        let a = self.activations[i];
                        self.activations[i] = match self.leak {
                            _ if !group.leak => y,
                            Leak::Filter => d * y + (1.0 - d) * a,
                            Leak::TwoTap => d * y + (1.0 - d) * self.responses[i],
                            Leak::Evonet => d * a + (1.0 - d) * y,
                        };
                        self.responses[i] = y;
                    }
                }
                Block::Gain(span) => (span.first..span.end()).for_each(|i| gains[i] = gains[span.first]),
                Block::ModulatedGain { neurons, by } => {
                    (neurons.first..neurons.end()).for_each(|i| gains[i] = self.activations[by]);
                }
                _ => unreachable!("another block"),
            }
        }
        self.activations[self.neurons.len() - self.layout.outputs()..].to_vec()
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|v| v.to_bits()).collect()
}

fn drawn(layout: BlockLayout<'_>, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::Network, 0, 0, 0);
    let draw = |kind| match kind {
        BlockParameter::Leak => stream.uniform(),
        BlockParameter::Gain => stream.range(0.0, 2.0),
        _ => stream.range(-2.0, 2.0),
    };
    layout.kinds().map(draw).collect()
}

fn state(layout: BlockLayout<'_>) -> Vec<f32> {
    vec![f32::NAN; layout.state_len()]
}

fn any_group() -> impl Strategy<Value = Group> {
    let flags = (any::<bool>(), any::<bool>(), any::<bool>());
    (0..14_usize, prop::sample::select(&Activation::ALL[..]), 0.1_f32..1.5, flags).prop_map(
        |(neurons, activation, slope, (bias, gain, leak))| Group { neurons, activation, slope, bias, gain, leak },
    )
}

fn any_block(neurons: usize) -> impl Strategy<Value = Block> {
    let span = move || (0..=neurons, 0..=neurons).prop_map(|(a, b)| Span::new(a.min(b), a.max(b) - a.min(b)));
    prop_oneof![
        4 => (span(), span(), 0..3_usize).prop_map(|(from, to, delay)| Block::connect(from, to).delayed(delay)),
        3 => span().prop_map(Block::Update),
        1 => span().prop_map(Block::Gain),
        1 => (span(), 0..neurons.max(1)).prop_map(move |(neurons, by)| {
            if neurons.end() == 0 { Block::Gain(neurons) } else { Block::ModulatedGain { neurons, by } }
        }),
    ]
}

prop_compose! {
    /// Groups, numbers of inputs and outputs, and blocks.
    fn any_plan()(groups in prop::collection::vec(any_group(), 1..4))(
        blocks in prop::collection::vec(any_block(groups.iter().map(|g| g.neurons).sum()), 0..8),
        ends in (0.0_f64..1.0, 0.0_f64..1.0),
        groups in Just(groups),
    ) -> (usize, usize, Vec<Group>, Vec<Block>) {
        let neurons: usize = groups.iter().map(|g| g.neurons).sum();
        let inputs = (ends.0 * (neurons + 1) as f64) as usize;
        let outputs = (ends.1 * (neurons - inputs + 1) as f64) as usize;
        (inputs, outputs, groups, blocks)
    }
}

proptest! {
    #[test]
    fn equals_the_oracle_bit_for_bit((inputs, outputs, groups, blocks) in any_plan(), seed in any::<u64>()) {
        let layout = BlockLayout::new(inputs, outputs, &groups, &blocks);
        let parameters = drawn(layout, seed);
        let mut stream = Stream::new(seed, Domain::Sensor, 0, 0, 0);
        let xs: Vec<Vec<f32>> = (0..6).map(|_| (0..inputs).map(|_| stream.range(-2.0, 2.0)).collect()).collect();
        for (leak, instructions) in Leak::ALL.into_iter().flat_map(|leak| Instructions::available().map(move |instructions| (leak, instructions))) {
            let network = BlockNetwork::new(layout, leak, &parameters, state(layout));
            let mut network = network?.with_instructions(instructions);
            let mut oracle = Oracle::new(layout, leak, &parameters);
            let mut y = vec![f32::NAN; outputs];
            for x in &xs {
                network.step(x, &mut y);
                let expected = oracle.step(x);
                // Without bounds, numbers may overflow, and a NaN has no bits to compare.
                if oracle.activations.iter().any(|a| a.is_nan()) {
                    break;
                }
                prop_assert_eq!(bits(network.activations()), bits(&oracle.activations), "{:?} {:?}", leak, instructions);
                prop_assert_eq!(bits(&y), bits(&expected));
            }
        }
    }

    #[test]
    fn the_network_is_one_of_blocks((n, h, o) in (0..12_usize, 1..40_usize, 0..40_usize), seed in any::<u64>()) {
        let plan = Architecture::elman(n, h, o).with_slope(LeakyLayout::SLOPE).with_leaks().without_output_biases().plan();
        let (layout, whole) = (plan.layout(), LeakyLayout::new(n, h, o));
        prop_assert_eq!(layout.parameter_count(), whole.parameter_count());
        prop_assert!(layout.range(BlockParameter::Leak).eq(whole.range(LeakyParameter::Leak)));
        prop_assert!(layout.range(BlockParameter::Bias).eq(whole.range(LeakyParameter::Bias)));
        let parameters = drawn(layout, seed);
        let mut stream = Stream::new(seed, Domain::Sensor, 0, 0, 0);
        for leak in Leak::ALL {
            let mut blocks = BlockNetwork::new(layout, leak, &parameters, state(layout))?;
            let mut network = LeakyNetwork::new(whole, leak, &parameters, vec![0.0; whole.state_len()])?;
            let (mut y, mut z) = (vec![0.0; o], vec![0.0; o]);
            for _ in 0..10 {
                let x: Vec<f32> = (0..n).map(|_| stream.range(-50.0, 50.0)).collect();
                blocks.step(&x, &mut y);
                network.step(&x, &mut z);
                prop_assert_eq!(bits(&y), bits(&z), "{:?}", leak);
                prop_assert_eq!(bits(&blocks.activations()[n..n + h]), bits(network.hidden()), "{:?}", leak);
            }
        }
    }

    #[test]
    fn a_delay_is_the_input_of_before(seed in any::<u64>(), delay in 0..9_usize) {
        let (plan, late) = (Architecture::elman(3, 10, 2).plan(), Architecture::elman(3, 10, 2).with_input_delay(delay).plan());
        let (layout, delayed) = (plan.layout(), late.layout());
        let parameters = drawn(layout, seed);
        let mut now = BlockNetwork::new(layout, Leak::Filter, &parameters, state(layout))?;
        let mut then = BlockNetwork::new(delayed, Leak::Filter, &parameters, state(delayed))?;
        let mut stream = Stream::new(seed, Domain::Sensor, 0, 0, 0);
        let xs: Vec<[f32; 3]> = (0..30).map(|_| [0.0; 3].map(|_: f32| stream.range(-1.0, 1.0))).collect();
        let (mut y, mut z) = ([0.0; 2], [0.0; 2]);
        for t in 0..xs.len() {
            now.step(t.checked_sub(delay).map_or(&[0.0; 3], |t| &xs[t]), &mut y);
            then.step(&xs[t], &mut z);
            prop_assert_eq!(bits(&y), bits(&z), "step {}", t);
        }
        // A reset clears the delayed values.
        let first = |network: &mut BlockNetwork<'_, _, _>| {
            let mut y = [0.0; 2];
            network.reset();
            network.step(&[1.0; 3], &mut y);
            bits(&y)
        };
        let mut fresh = BlockNetwork::new(delayed, Leak::Filter, &parameters, state(delayed))?;
        prop_assert_eq!(first(&mut then), first(&mut fresh));
    }

    #[test]
    fn a_silent_neuron_is_one_without_links(seed in any::<u64>(), neuron in 2..12_usize) {
        let plan = Architecture::elman(2, 10, 4).plan();
        let layout = plan.layout();
        let parameters = drawn(layout, seed);
        let mut cut = parameters.clone();
        for to in 0..16 {
            layout.weights(neuron, to).for_each(|index| cut[index] = 0.0);
        }
        let lesions = [Lesion::new(neuron)];
        let mut without = Lesioned::new(BlockNetwork::new(layout, Leak::Filter, &parameters, state(layout))?, &lesions);
        let mut cut = BlockNetwork::new(layout, Leak::Filter, &cut, state(layout))?;
        let (mut y, mut z) = ([0.0; 4], [0.0; 4]);
        for step in 0..20 {
            let x = [step as f32 / 20.0, 0.5];
            without.step(&x, &mut y);
            cut.step(&x, &mut z);
            prop_assert_eq!(y, z);
            prop_assert_eq!(without.network().activations()[neuron], 0.0);
        }
    }
}

#[test]
fn the_named_architectures_have_their_memory() -> Result<(), Error> {
    // A pulse on the input, and what is left of it in the output afterwards.
    let echo = |plan: BlockPlan| -> Result<Vec<bool>, Error> {
        let layout = plan.layout();
        let parameters = vec![1.0; layout.parameter_count()];
        let mut pulsed = BlockNetwork::new(layout, Leak::Filter, &parameters, state(layout))?;
        let mut quiet = pulsed.clone();
        let (mut y, mut z) = ([0.0], [0.0]);
        (0..3)
            .map(|step| {
                pulsed.step(&[if step == 0 { 1.0 } else { 0.0 }], &mut y);
                quiet.step(&[0.0], &mut z);
                Ok(y != z)
            })
            .collect()
    };
    assert_eq!(echo(Architecture::feed_forward(1, 2, 1).plan())?, [true, false, false]);
    assert_eq!(echo(Architecture::feed_forward(1, 0, 1).plan())?, [true, false, false]);
    assert_eq!(echo(Architecture::elman(1, 2, 1).plan())?, [true, true, true]);
    assert_eq!(echo(Architecture::jordan(1, 2, 1).plan())?, [true, true, true]);
    assert_eq!(echo(Architecture::fully_recurrent(1, 2, 1).plan())?, [true, true, true]);
    assert_eq!(echo(Architecture::feed_forward(1, 2, 1).with_recurrent_outputs().plan())?, [true, true, true]);
    assert_eq!(echo(Architecture::feed_forward(1, 2, 1).with_input_delay(1).plan())?, [false, true, false]);
    assert_eq!(Architecture::jordan(3, 4, 2).plan().layout().parameter_count(), 3 * 4 + 2 * 4 + 4 * 2 + 6);
    assert_eq!(Architecture::fully_recurrent(3, 4, 2).plan().layout().parameter_count(), 3 * 6 + 6 * 6 + 6);
    let both = Architecture::feed_forward(3, 4, 2).with_inputs_to_outputs().plan();
    assert_eq!(both.layout().parameter_count(), 3 * 4 + 3 * 2 + 4 * 2 + 6);
    Ok(())
}

#[test]
fn gains_by_hand() -> Result<(), Error> {
    // Two inputs with gains 2 and 3, one linear output with weights 1 and 10.
    const GROUPS: [Group; 2] = [Group::new(2, Activation::Linear).with_gains(), Group::new(1, Activation::Linear)];
    const IN: Span = Span::new(0, 2);
    const OUT: Span = Span::new(2, 1);
    let output = |gain: Option<Block>| -> Result<f32, Error> {
        let blocks = [Some(Block::Update(IN)), gain, Some(Block::connect(IN, OUT)), Some(Block::Update(OUT))];
        let blocks: Vec<Block> = blocks.into_iter().flatten().collect();
        let layout = BlockLayout::new(2, 1, &GROUPS, &blocks);
        let mut network = BlockNetwork::new(layout, Leak::Filter, [1.0, 10.0, 2.0, 3.0], state(layout))?;
        let mut y = [0.0];
        network.step(&[5.0, 7.0], &mut y);
        Ok(y[0])
    };
    assert_eq!(output(None)?, 5.0 * 2.0 + 70.0 * 3.0);
    assert_eq!(output(Some(Block::Gain(IN)))?, 5.0 * 2.0 + 70.0 * 2.0);
    assert_eq!(output(Some(Block::ModulatedGain { neurons: IN, by: 1 }))?, 5.0 * 7.0 + 70.0 * 7.0);
    Ok(())
}

#[test]
fn construction_names_the_mistake() {
    let groups = [Group::new(1, Activation::Linear), Group::new(2, Activation::Logistic).with_leaks()];
    let blocks = [Block::connect(Span::new(0, 1), Span::new(1, 2)), Block::Update(Span::new(1, 2))];
    let build = |layout: BlockLayout<'_>, parameters: &[f32], less: usize| {
        BlockNetwork::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len().min(99) - less]).err()
    };
    let layout = BlockLayout::new(1, 1, &groups, &blocks);
    assert_eq!(build(layout, &[0.5; 4], 0), None);
    assert_eq!(build(layout, &[0.5; 3], 0), Some(Error::Length { slice: Slice::Parameters, expected: 4, found: 3 }));
    assert_eq!(build(layout, &[0.5; 4], 1), Some(Error::Length { slice: Slice::State, expected: 18, found: 17 }));
    assert_eq!(
        build(layout, &[0.5, f32::NAN, 0.5, 0.5], 0),
        Some(Error::Parameter { index: 1, fault: ParameterFault::NotFinite })
    );
    assert_eq!(
        build(layout, &[0.5, 0.5, 0.5, 1.5], 0),
        Some(Error::Parameter { index: 3, fault: ParameterFault::Leak(1.5) })
    );
    let many = BlockLayout::new(2, 2, &groups, &blocks);
    assert_eq!(build(many, &[0.5; 4], 0), Some(Error::Layout(LayoutFault::Neurons { first: 0, count: 4, neurons: 3 })));
    let beyond = [blocks[0], Block::Update(Span::new(2, 2))];
    let error = build(BlockLayout::new(1, 1, &groups, &beyond), &[0.5; 4], 0);
    assert_eq!(error, Some(Error::Layout(LayoutFault::Block { index: 1, first: 2, count: 2, neurons: 3 })));
    assert_eq!(
        error.expect("an error").to_string(),
        "block 1 has 2 neurons from neuron 2 on where the layout has 3 neurons"
    );
    let steep = [groups[0].with_slope(f32::NAN), groups[1]];
    assert!(matches!(
        build(BlockLayout::new(1, 1, &steep, &blocks), &[0.5; 4], 0),
        Some(Error::Layout(LayoutFault::Slope(_)))
    ));
    let huge = [Block::connect(Span::new(0, 1), Span::new(1, 2)).delayed(usize::MAX)];
    let layout = BlockLayout::new(1, 1, &groups, &huge);
    assert_eq!(layout.state_len(), usize::MAX);
    assert_eq!(
        build(layout, &[0.5; 4], 0),
        Some(Error::Length { slice: Slice::State, expected: usize::MAX, found: 99 })
    );
}

#[test]
fn other_parameters_leave_no_trace() -> Result<(), Error> {
    let plan = Architecture::elman(2, 9, 3).with_leaks().plan();
    let layout = plan.layout();
    let (first, second) = (drawn(layout, 1), drawn(layout, 2));
    let run = |network: &mut dyn Controller| {
        let mut y = [0.0; 3];
        network.reset();
        (0..5).for_each(|step| network.step(&[step as f32, 1.0], &mut y));
        bits(&y)
    };
    let expected = run(&mut BlockNetwork::new(layout, Leak::Filter, &second[..], state(layout))?);
    let mut borrows = BlockNetwork::new(layout, Leak::Filter, &first[..], state(layout))?;
    let mut owns = BlockNetwork::new(layout, Leak::Filter, first.clone(), state(layout))?;
    assert_ne!(run(&mut borrows), expected);
    assert_eq!(borrows.set_parameters(&second)?, &first[..]);
    assert!(owns.copy_parameters(&second[1..]).is_err());
    assert_eq!(owns.parameters(), first);
    owns.copy_parameters(&second)?;
    assert_eq!((run(&mut borrows), run(&mut owns)), (expected.clone(), expected));
    Ok(())
}

#[test]
fn a_lesion_holds_what_it_is_told() -> Result<(), Error> {
    const LAYOUT: LeakyLayout = LeakyLayout::new(1, 9, 2);
    let parameters: Vec<f32> = (0..LAYOUT.parameter_count()).map(|i| (i * 37 % 101) as f32 / 101.0).collect();
    let network = LeakyNetwork::new(LAYOUT, Leak::Filter, &parameters, [0.0; LAYOUT.state_len()])?;
    assert_eq!(network.neurons(), 11);
    // The last does not exist.
    let lesions = [Lesion { neuron: 4, activation: 0.75 }, Lesion { neuron: 10, activation: 0.125 }, Lesion::new(99)];
    let mut without = Lesioned::new(network.clone(), &lesions);
    let (mut y, mut z, mut whole) = ([0.0; 2], [0.0; 2], network);
    for _ in 0..3 {
        without.step(&[1.0], &mut y);
        whole.step(&[1.0], &mut z);
    }
    assert_eq!((without.network().hidden()[4], y[1]), (0.75, 0.125));
    assert_ne!(y[0], z[0]);
    without.set_lesions(&[]);
    without.reset();
    whole.reset();
    without.step(&[1.0], &mut y);
    whole.step(&[1.0], &mut z);
    assert_eq!((y, without.network().hidden()), (z, whole.hidden()));
    assert_eq!(without.into_network().hidden().len(), 9);
    Ok(())
}

#[test]
fn an_architecture_has_what_it_is_asked_for() {
    // Weights, biases, gains, leaks.
    let counts = |architecture: Architecture| {
        let plan = architecture.plan();
        [BlockParameter::Weight, BlockParameter::Bias, BlockParameter::Gain, BlockParameter::Leak]
            .map(|kind| plan.layout().range(kind).len())
    };
    let plain = Architecture::elman(3, 4, 2);
    assert_eq!(counts(plain), [12 + 16 + 8, 6, 0, 0]);
    assert_eq!(counts(plain.with_leaks()), [36, 6, 0, 4]);
    assert_eq!(counts(plain.with_output_leaks()), [36, 6, 0, 2]);
    assert_eq!(counts(plain.with_gains()), [36, 6, 4, 0]);
    assert_eq!(counts(plain.without_hidden_biases()), [36, 2, 0, 0]);
    assert_eq!(counts(plain.without_output_biases()), [36, 4, 0, 0]);
    assert_eq!(counts(plain.with_inputs_to_outputs()), [36 + 6, 6, 0, 0]);
    assert_eq!(counts(plain.with_recurrent_outputs()), [36 + 4, 6, 0, 0]);
    assert_eq!(counts(Architecture::jordan(3, 4, 2)), [12 + 8 + 8, 6, 0, 0]);
    assert_eq!(counts(Architecture::feed_forward(3, 4, 2)), [12 + 8, 6, 0, 0]);
    assert_eq!(counts(Architecture::fully_recurrent(3, 4, 2)), [18 + 36, 6, 0, 0]);
    // The groups of a plan are inputs, hidden neurons, outputs.
    let has = |architecture: Architecture, has: fn(&Group) -> bool| {
        let plan = architecture.plan();
        plan.layout().groups().iter().map(has).collect::<Vec<_>>()
    };
    assert_eq!(has(plain.with_output_leaks(), |group| group.leak), [false, false, true]);
    assert_eq!(has(plain.without_hidden_biases(), |group| group.bias), [false, false, true]);
    assert_eq!(has(plain.with_slope(0.3), |group| group.slope == 0.3), [false, true, true]);
}

#[test]
fn hidden_neurons_and_outputs_have_the_functions_they_are_given() -> Result<(), Error> {
    for (hidden, output) in [
        (Activation::Tanh, Activation::Linear),
        (Activation::Linear, Activation::Tanh),
        (Activation::Rectified, Activation::Step),
    ] {
        let plan = Architecture::feed_forward(1, 1, 1).with_activations(hidden, output).plan();
        let mut network = BlockNetwork::new(plan.layout(), Leak::Filter, [0.5; 4], state(plan.layout()))?;
        for x in [-3.0_f32, -1.0, 0.25, 2.0] {
            let mut y = [f32::NAN];
            network.step(&[x], &mut y);
            let expected = output.apply(0.5 + 0.5 * hidden.apply(0.5 + 0.5 * x));
            assert_eq!(y, [expected], "{hidden} and {output} of {x}");
        }
    }
    Ok(())
}

#[test]
fn the_originals_order_takes_each_parameter_once() {
    let plans = [
        Architecture::feed_forward(6, 0, 2).plan(),
        Architecture::elman(3, 4, 2).with_leaks().with_output_leaks().with_gains().plan(),
        Architecture::jordan(2, 3, 2).with_inputs_to_outputs().with_recurrent_outputs().plan(),
        Architecture::fully_recurrent(2, 3, 2).with_leaks().without_hidden_biases().plan(),
    ];
    for plan in plans {
        let layout = plan.layout();
        let mut order: Vec<usize> = layout.evonet_order().collect();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..layout.parameter_count()));
        let mut parameters = vec![0.0; layout.parameter_count()];
        let count = parameters.len();
        for found in [count - 1, count + 1] {
            let numbers = std::iter::repeat_n(1.0, found);
            let error = layout.read_evonet(EvonetRanges::default(), numbers, &mut parameters);
            assert_eq!(error, Err(Error::Length { slice: Slice::Parameters, expected: count, found }));
        }
    }
}

#[test]
fn leaks_and_time_constants_are_each_others() {
    for leak in [Leak::Filter, Leak::Evonet] {
        for d in [1e-6_f32, 0.01, 0.3, 0.5, 0.9, 0.999] {
            let tau = leak.time_constant(d, 0.01).expect("a time constant");
            let back = leak.for_time_constant(tau, 0.01).expect("a leak");
            assert!((back - d).abs() <= 1e-6 * d, "{leak}: {d} comes back as {back}");
        }
        assert_eq!(leak.time_constant(1.5, 0.01), None);
        assert_eq!(leak.time_constant(f32::NAN, 0.01), None);
        assert_eq!(leak.for_time_constant(-1.0, 0.01), None);
    }
    assert_eq!(Leak::Filter.time_constant(0.0, 0.01), Some(f32::INFINITY));
    assert_eq!(Leak::Filter.time_constant(1.0, 0.01), Some(0.0));
    assert_eq!(Leak::Evonet.time_constant(1.0, 0.01), Some(f32::INFINITY));
    assert_eq!(Leak::Filter.for_time_constant(f32::INFINITY, 0.01), Some(0.0));
    assert_eq!(Leak::Filter.for_time_constant(0.0, 0.01), Some(1.0));
    assert_eq!(Leak::Evonet.for_time_constant(0.0, 0.01), Some(0.0));
    assert_eq!((Leak::TwoTap.time_constant(0.5, 0.01), Leak::TwoTap.for_time_constant(1.0, 0.01)), (None, None));
}
