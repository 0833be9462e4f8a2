//! The original's text and the order of its parameters, against a walk through them as the original takes it.
#![cfg(feature = "alloc")]

use farsa_nn::block::{Block, BlockNetwork, Evonet, EvonetRanges};
use farsa_nn::fault::{ParameterFault, Slice};
use farsa_nn::{Activation, Controller, Error, Leak};

const TEXT: &str = include_str!("../fixtures/evonet.phe");

/// The content of the text as plain numbers: blocks and neurons.
fn numbers(lines: std::ops::Range<usize>) -> Vec<Vec<usize>> {
    let words = |line: &str| line.split_whitespace().take(6).map(|word| word.parse().expect("a number")).collect();
    TEXT.lines().skip(lines.start).take(lines.len()).map(words).collect()
}

/// A step as the original takes it: one pointer goes over the parameters, in double precision.
fn walk(parameters: &[f64], ranges: [f64; 3], act: &mut [f64], x: &[f64]) {
    let [wrange, brange, grange] = ranges;
    let (blocks, neurons) = (numbers(5..14), numbers(15..22));
    let mut p = parameters.iter().copied();
    let mut next = || p.next().expect("a parameter");
    let mut gain: Vec<f64> =
        neurons.iter().map(|n| if n[2] == 1 { next().abs() / wrange * grange } else { 1.0 }).collect();
    let mut net: Vec<f64> = neurons.iter().map(|n| if n[0] == 1 { next() / wrange * brange } else { 0.0 }).collect();
    for b in blocks {
        let (targets, sources) = (b[1]..b[1] + b[2], b[3]..b[3] + b[4]);
        match b[0] {
            0 => {
                for t in targets {
                    for s in sources.clone() {
                        net[t] += act[s] * gain[s] * next();
                    }
                }
            }
            1 => {
                for t in targets {
                    let logistic = |x: f64| 1.0 / (1.0 + farsa_num::exp(-x));
                    let response = match neurons[t][1] {
                        _ if t < x.len() => x[t],
                        2 => f64::from(u8::from(net[t] >= 0.0)),
                        3 => logistic(0.2 * net[t]),
                        _ => logistic(net[t]),
                    };
                    let delta = if neurons[t][1] == 1 { next().abs() / wrange } else { 0.0 };
                    act[t] = act[t] * delta + response * (1.0 - delta);
                }
            }
            2 => targets.clone().for_each(|t| gain[t] = gain[targets.start]),
            _ => targets.clone().for_each(|t| gain[t] = act[sources.start]),
        }
    }
    assert_eq!(p.next(), None);
}

#[test]
fn the_fixture_is_read_and_steps_as_the_original() -> Result<(), Error> {
    let evonet: Evonet = TEXT.parse()?;
    let layout = evonet.layout.layout();
    assert_eq!((layout.inputs(), layout.outputs(), layout.neurons(), layout.blocks().len()), (3, 2, 7, 9));
    // The third to the fifth neuron differ from each other, s1 from s0 and s2.
    assert_eq!(layout.groups().iter().map(|group| group.neurons).collect::<Vec<_>>(), [1; 7]);
    assert_eq!((evonet.numbers.len(), evonet.numbers[0], evonet.numbers[23]), (24, Some(2.5), Some(3.0)));
    assert_eq!((evonet.mutations[0], evonet.mutations[12], evonet.mutations[14]), (None, Some(0.0), Some(0.5)));

    let ranges = EvonetRanges { weight: 5.0, bias: 4.0, gain: 3.0 };
    let parameters = evonet.parameters(ranges)?;
    let mut network = BlockNetwork::new(layout, Leak::Evonet, &parameters, vec![0.0; layout.state_len()])?;
    let numbers: Vec<f64> = evonet.numbers.iter().flatten().map(|p| f64::from(*p)).collect();
    let (mut act, mut y) = ([0.0; 7], [0.0; 2]);
    for step in 0..50 {
        let x = [step % 7, step % 5, step % 3].map(|x| x as f32 / 8.0);
        network.step(&x, &mut y);
        walk(&numbers, [5.0, 4.0, 3.0], &mut act, &x.map(f64::from));
        for (a, expected) in network.activations().iter().zip(act) {
            assert!((f64::from(*a) - expected).abs() < 1e-6, "step {step}: {a} is not {expected}");
        }
        assert_eq!(y, network.activations()[5..]);
    }
    Ok(())
}

#[test]
fn genes_are_decoded_as_the_original_does() -> Result<(), Error> {
    let evonet: Evonet = TEXT.parse()?;
    let (layout, ranges) = (evonet.layout.layout(), EvonetRanges::default());
    let genes: Vec<u8> = (0..24).map(|i| (i * 97 % 256) as u8).collect();
    let mut parameters = vec![f32::NAN; layout.parameter_count()];
    layout.read_evonet(ranges, genes.iter().map(|gene| ranges.read_gene(*gene)), &mut parameters)?;
    let mut network = BlockNetwork::new(layout, Leak::Evonet, &parameters, vec![0.0; layout.state_len()])?;
    let numbers: Vec<f64> = genes.iter().map(|gene| 5.0 - f64::from(*gene) / 255.0 * 10.0).collect();
    let (mut act, mut y) = ([0.0; 7], [0.0; 2]);
    for _ in 0..50 {
        network.step(&[0.25, 0.5, 1.0], &mut y);
        walk(&numbers, [5.0; 3], &mut act, &[0.25, 0.5, 1.0]);
    }
    assert!(y.iter().zip(&act[5..]).all(|(y, act)| (f64::from(*y) - act).abs() < 1e-5), "{y:?} is not {act:?}");
    Ok(())
}

#[test]
fn files_without_parameters_and_older_ones() -> Result<(), Error> {
    let net = format!("{}END\n", TEXT.split("FREE").next().unwrap_or_default());
    let evonet: Evonet = net.parse()?;
    assert!(evonet.numbers.is_empty());
    assert_eq!(
        evonet.parameters(EvonetRanges::default()),
        Err(Error::Length { slice: Slice::Parameters, expected: 24, found: 0 })
    );
    assert!(matches!(evonet.layout.blocks[6], Block::ModulatedGain { by: 0, .. }));
    assert_eq!((evonet.layout.groups[4].slope, evonet.layout.groups[0].activation), (0.2, Activation::Linear));
    // Alike neurons that follow each other are one group.
    let alike: Evonet = net.replace("0 1 0 80", "0 0 1 80").parse()?;
    assert_eq!(alike.layout.groups[0].neurons, 2);
    // Lines end as on Windows, and a parameter that is drawn is -99 in older files.
    let older =
        TEXT.replace('\n', "\r\n").replace("2.500000 \t * ", "-99").replace("0.500000 \t * \t\t \tbias", "0.5 \tbias");
    let evonet: Evonet = older.parse()?;
    assert_eq!((evonet.numbers[0], evonet.mutations[0]), (None, None));
    assert_eq!((evonet.numbers[2], evonet.mutations[2]), (Some(0.5), Some(0.0)));
    assert_eq!(
        evonet.parameters(EvonetRanges::default()),
        Err(Error::Parameter { index: 0, fault: ParameterFault::NoValue })
    );
    let free: Evonet = TEXT.replace("2.500000 \t", "* \t").parse()?;
    assert_eq!(free.numbers[0], None);
    Ok(())
}

#[test]
fn what_is_wrong_has_a_line() {
    let wrong = |from: &str, to: &str| {
        assert!(TEXT.contains(from), "{from}");
        TEXT.replacen(from, to, 1).parse::<Evonet>().expect_err(to).to_string()
    };
    for (from, to, why) in [
        ("ARCHITECTURE", "ARCH", "line 1: expected ARCHITECTURE"),
        ("nneurons 7", "nneurons seven", "line 2: expected `nneurons` and a number"),
        ("nsensors 3", "nsensor 3", "line 3: expected `nsensors` and a number"),
        (
            "2 0 3 0 0 0 // gain",
            "4 0 3 0 0 0 // gain",
            "line 6: expected a block: six whole numbers, the first from 0 to 3",
        ),
        ("0 3 2 0 3 0", "0 3 2 0 3", "line 8: expected a block: six whole numbers, the first from 0 to 3"),
        ("neurons bias", "nerves", "line 15: expected neurons bias"),
        (
            "1 3 1 90",
            "1 4 1 90",
            "line 20: expected a neuron: six whole numbers, bias and gain 0 or 1, type from 0 to 3",
        ),
        ("1.750000", "nan", "line 28: expected a parameter: a number or `*`, and its mutation rate"),
        ("END", "", "line 49: expected END"),
        ("PARAMETERS 24", "PARAMETERS 25", "25 parameters where the layout has 24"),
        ("0 3 2 0 3 0", "0 3 9 0 3 0", "block 2 has 9 neurons from neuron 3 on where the layout has 7 neurons"),
        ("nmotors 2", "nmotors 5", "8 neurons from neuron 0 on where the layout has 7"),
        (
            "nneurons 7",
            "nneurons 8",
            "line 23: expected a neuron: six whole numbers, bias and gain 0 or 1, type from 0 to 3",
        ),
    ] {
        assert_eq!(wrong(from, to), why, "{to}");
    }
    // However it is cut, it is an error and no panic.
    for end in 0..TEXT.len() - 2 {
        assert!(TEXT[..end].parse::<Evonet>().is_err(), "{end}");
    }
}
