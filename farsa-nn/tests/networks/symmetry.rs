//! Few genes that fill many parameters, and centre-crossing biases.

use farsa_nn::block::Span;
use farsa_nn::fault::{LayoutFault, Slice};
use farsa_nn::{Activation, Controller, Ctrnn, CtrnnLayout, CtrnnParameter, CtrnnSymmetry, Error, Integrator};
use farsa_num::{Domain, Stream};
use proptest::prelude::*;

fn state(layout: CtrnnLayout) -> Vec<f32> {
    vec![f32::NAN; layout.state_len()]
}

/// Genes decoded into ranges as those of the literature.
fn drawn(symmetry: &CtrnnSymmetry<'_>, seed: u64) -> Vec<f32> {
    let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
    let draw = |kind| match kind {
        CtrnnParameter::TimeConstant => stream.range(1.0, 2.0),
        CtrnnParameter::Gain => stream.range(0.5, 1.5),
        _ => stream.range(-1.0, 1.0),
    };
    symmetry.kinds().map(draw).collect()
}

proptest! {
    #[test]
    fn a_mirrored_world_is_answered_by_the_mirror_image(
        seed in any::<u64>(), (inputs, neurons) in (0..5_usize, 1..9_usize), direct in any::<bool>(),
    ) {
        // Inputs and neurons are mirrored end to end, and the outputs are all neurons.
        let layout = CtrnnLayout::new(inputs.min(neurons), neurons, neurons);
        let inputs = layout.inputs();
        let layout = if direct { layout.with_direct_inputs((neurons - inputs) / 2) } else { layout };
        prop_assume!(!direct || (neurons - inputs).is_multiple_of(2));
        let images = |count: usize| (0..count).rev().collect::<Vec<usize>>();
        let (of_inputs, of_neurons) = (images(if direct { 0 } else { inputs }), images(neurons));
        let symmetry = CtrnnSymmetry::new(layout, &of_inputs, &of_neurons)?;
        let mut parameters = vec![f32::NAN; layout.parameter_count()];
        symmetry.expand(&drawn(&symmetry, seed), &mut parameters)?;
        let mut network = Ctrnn::new(layout, 0.1, &parameters, state(layout))?;
        let mut mirror = Ctrnn::new(layout, 0.1, &parameters, state(layout))?;
        let mut stream = Stream::new(seed, Domain::Sensor, 0, 0, 0);
        let (mut y, mut z) = (vec![0.0; neurons], vec![0.0; neurons]);
        for _ in 0..50 {
            let mut x: Vec<f32> = (0..inputs).map(|_| stream.range(-1.0, 1.0)).collect();
            network.step(&x, &mut y);
            x.reverse();
            mirror.step(&x, &mut z);
            z.reverse();
            prop_assert!(y.iter().zip(&z).all(|(y, z)| (y - z).abs() < 1e-5), "{y:?} is not {z:?}");
        }
    }

    #[test]
    fn every_gene_fills_what_is_its_own(seed in any::<u64>(), neurons in 1..12_usize) {
        let layout = CtrnnLayout::new(2, neurons, 1);
        let images: Vec<usize> = (0..neurons).rev().collect();
        let symmetry = CtrnnSymmetry::new(layout, &[1, 0], &images)?;
        let genes: Vec<f32> = (0..symmetry.gene_count()).map(|gene| gene as f32 + (seed % 2) as f32).collect();
        let mut parameters = vec![f32::NAN; layout.parameter_count()];
        symmetry.expand(&genes, &mut parameters)?;
        // Each value occurs once or, with its mirror image, twice, and so do all genes.
        let mut sorted = parameters.clone();
        sorted.sort_by(f32::total_cmp);
        prop_assert!(sorted.chunk_by(|a, b| a == b).all(|same| same.len() <= 2));
        sorted.dedup();
        prop_assert_eq!(sorted, genes);
        let half = |count: usize| count.div_ceil(2);
        prop_assert_eq!(symmetry.gene_count(), neurons + half(neurons * neurons) + 3 * half(neurons));
    }

    #[test]
    fn at_the_centre_all_neurons_are_halfway_and_at_rest(seed in any::<u64>(), neurons in 1..20_usize) {
        let layout = CtrnnLayout::new(0, neurons, 1).with_integrator(Integrator::RungeKutta4);
        let mut parameters = vec![0.0; layout.parameter_count()];
        let mut stream = Stream::new(seed, Domain::InitialGenome, 0, 0, 0);
        layout.draw_centre_crossing(&mut stream, 16.0, [1.0, 2.0], &mut parameters)?;
        prop_assert_eq!(stream.position(), (neurons * neurons + neurons) as u64);
        let parts = layout.split(&parameters);
        prop_assert!(parts.weights.iter().all(|w| (-16.0..16.0).contains(w)));
        prop_assert!(parts.time_constants.iter().all(|tau| (1.0..2.0).contains(tau)));
        prop_assert!(parts.gains.iter().all(|g| *g == 1.0));
        let centre: Vec<f32> = parts.biases.iter().map(|theta| -theta).collect();
        let mut network = Ctrnn::new(layout, 0.1, &parameters, state(layout))?;
        network.set_states(&centre)?;
        prop_assert!(network.neuron_outputs().iter().all(|o| *o == 0.5));
        network.step(&[], &mut [0.0]);
        prop_assert!(network.states().iter().zip(&centre).all(|(y, c)| (y - c).abs() < 1e-4));
    }
}

#[test]
fn links_that_do_not_exist_are_zero() -> Result<(), Error> {
    let layout = CtrnnLayout::new(0, 4, 1);
    let links = [(Span::new(0, 1), Span::new(2, 2))];
    let symmetry = CtrnnSymmetry::new(layout, &[], &[1, 0, 3, 2])?.with_links(&links)?.with_gains(&[])?;
    // Neuron 0 to 2 and 3, and by symmetry 1 to 3 and 2, a bias and a time constant of each pair.
    assert_eq!(symmetry.gene_count(), 2 + 2 + 2);
    let mut parameters = vec![f32::NAN; layout.parameter_count()];
    symmetry.expand(&[7.0, 8.0, 1.0, 2.0, 3.0, 4.0], &mut parameters)?;
    let parts = layout.split(&parameters);
    assert_eq!(parts.weights, [[0.0, 0.0, 7.0, 8.0], [0.0, 0.0, 8.0, 7.0], [0.0; 4], [0.0; 4]].concat());
    assert_eq!((parts.biases, parts.gains), (&[1.0, 1.0, 2.0, 2.0][..], &[1.0; 4][..]));
    assert_eq!(parts.time_constants, [3.0, 3.0, 4.0, 4.0]);
    Ok(())
}

#[test]
fn gains_without_genes_are_one() -> Result<(), Error> {
    let layout = CtrnnLayout::new(5, 5, 1).with_direct_inputs(0);
    let (links, alike, images) = ([], [Span::new(2, 3)], [1, 0, 4, 3, 2]);
    let symmetry = CtrnnSymmetry::new(layout, &[], &images)?.with_links(&links)?.with_alike(&alike)?;
    // A bias, a gain and a time constant of the pair and of those that are alike.
    let all = [[1.0, 1.0, 2.0, 2.0, 2.0], [3.0, 3.0, 4.0, 4.0, 4.0], [5.0, 5.0, 6.0, 6.0, 6.0]];
    let (none, pair, three) = ([1.0; 5], [3.0, 3.0, 1.0, 1.0, 1.0], [1.0, 1.0, 3.0, 3.0, 3.0]);
    // The second of a pair counts for both, the first of alike neurons for all.
    let cases: [(&[Span], [f32; 5]); 4] =
        [(&[Span::new(0, 5)], all[1]), (&[Span::new(1, 1)], pair), (&[Span::new(2, 1)], three), (&[], none)];
    for (spans, gains) in cases {
        let symmetry = symmetry.with_gains(spans)?;
        let mut own = gains.to_vec();
        own.dedup();
        own.retain(|gain| *gain != 1.0);
        let mut parameters = vec![f32::NAN; layout.parameter_count()];
        symmetry.expand(&[&[1.0, 2.0], &own[..], &[5.0, 6.0]].concat(), &mut parameters)?;
        let parts = layout.split(&parameters);
        assert_eq!([parts.biases, parts.gains, parts.time_constants], [&all[0], &gains[..], &all[2]], "{spans:?}");
        assert_eq!(symmetry.kinds().filter(|kind| *kind == CtrnnParameter::Gain).count(), own.len());
    }
    Ok(())
}

#[test]
fn mistakes_have_names() -> Result<(), Error> {
    let layout = CtrnnLayout::new(2, 3, 1);
    let symmetry = CtrnnSymmetry::new(layout, &[1, 0], &[2, 1, 0])?;
    let (genes, mut parameters) = (vec![0.0; symmetry.gene_count()], vec![9.0; layout.parameter_count()]);
    let count = genes.len();
    let few = symmetry.expand(&genes[1..], &mut parameters);
    assert_eq!(few, Err(Error::Length { slice: Slice::Parameters, expected: count, found: count - 1 }));
    assert!(symmetry.expand(&genes, &mut parameters[1..]).is_err());
    assert!(parameters.iter().all(|p| *p == 9.0));
    assert_eq!(
        CtrnnSymmetry::new(layout, &[], &[2, 1, 0]),
        Err(Error::Length { slice: Slice::MirrorImages, expected: 2, found: 0 })
    );
    assert_eq!(
        CtrnnSymmetry::new(layout, &[1, 0], &[1, 0]),
        Err(Error::Length { slice: Slice::MirrorImages, expected: 3, found: 2 })
    );
    assert_eq!(
        CtrnnSymmetry::new(layout, &[1, 0], &[1, 2, 0]),
        Err(Error::Layout(LayoutFault::Mirror { index: 0, image: 1 }))
    );
    assert_eq!(
        CtrnnSymmetry::new(layout, &[1, 2], &[0, 1, 2]),
        Err(Error::Layout(LayoutFault::Mirror { index: 0, image: 1 }))
    );
    let (three, four) = (Span::new(0, 3), Span::new(1, 3));
    let beyond = Err(Error::Layout(LayoutFault::Neurons { first: 1, count: 3, neurons: 3 }));
    assert_eq!(symmetry.with_links(&[(three, three), (three, four)]), beyond);
    assert_eq!(symmetry.with_links(&[(four, three)]), beyond);
    assert_eq!(symmetry.with_alike(&[three, four]), beyond);
    assert_eq!(symmetry.with_gains(&[four]), beyond);
    assert!(symmetry.with_gains(&[Span::new(3, usize::MAX)]).is_err());
    // The ends are mirrored to each other, the middle to itself.
    let not = |first, count| Err(Error::Layout(LayoutFault::Alike { first, count }));
    let cases: [(&[[usize; 2]], _); 7] = [
        (&[[0, 2]], not(0, 2)),
        (&[[0, 2], [2, 1]], not(0, 2)),
        (&[[0, 1]], not(0, 1)),
        (&[[0, 3], [1, 1]], not(1, 1)),
        (&[[0, 1], [2, 1]], Ok(count)),
        (&[[1, 1], [1, 0]], Ok(count)),
        (&[[0, 3]], Ok(count - 3)),
    ];
    for (spans, expected) in cases {
        let alike: Vec<Span> = spans.iter().map(|[first, count]| Span::new(*first, *count)).collect();
        assert_eq!(symmetry.with_alike(&alike).map(|symmetry| symmetry.gene_count()), expected, "{spans:?}");
    }
    assert!(layout.centre_crossing(&mut parameters[1..]).is_err());
    assert!(parameters.iter().all(|p| *p == 9.0));
    let tanh = layout.with_activation(Activation::Tanh);
    tanh.centre_crossing(&mut parameters)?;
    assert_eq!(tanh.split(&parameters).biases, [0.0; 3]);
    Ok(())
}
