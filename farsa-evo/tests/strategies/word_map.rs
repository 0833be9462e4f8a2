//! Maps of integer genes in both directions, compared with the direct decoding.

use crate::errors;
use farsa_evo::EvoError;
use farsa_evo::words::{GeneRange, WordCode, WordGene, WordMap, decode};
use proptest::prelude::*;

fn word(bits: u32, low: f32, high: f32, code: WordCode) -> WordGene {
    WordGene::Word { bits, low, high, code }
}

fn decoded(map: &WordMap, words: &[u16]) -> Vec<f32> {
    let mut parameters = vec![f32::NAN; map.parameters()];
    map.decode(words, &mut parameters).unwrap();
    parameters
}

fn encoded(map: &WordMap, parameters: &[f32]) -> Vec<u16> {
    let mut words = vec![0xAAAA; map.words()];
    map.encode(parameters, &mut words).unwrap();
    words
}

#[test]
fn sixteen_bits_decode_like_the_direct_decoding() {
    let words: Vec<u16> = (0..=u16::MAX).collect();
    let map = WordMap::new(vec![word(16, -6.0, 6.0, WordCode::Plain); words.len()]).unwrap();
    let mut want = vec![0.0; words.len()];
    decode(&words, &[GeneRange::new(words.len(), -6.0, 6.0).unwrap()], &mut want).unwrap();
    assert_eq!(decoded(&map, &words), want);
    assert_eq!(encoded(&map, &want), words);
}

/// Every value of every width and code round-trips.
#[test]
fn every_value_round_trips() {
    for bits in 1..=16 {
        for code in [WordCode::Plain, WordCode::Gray] {
            let words: Vec<u16> = (0..=u16::MAX >> (16 - bits)).collect();
            let map = WordMap::new(vec![word(bits, -1.5, 7.25, code); words.len()]).unwrap();
            let parameters = decoded(&map, &words);
            assert_eq!(encoded(&map, &parameters), words, "{bits} {code:?}");
            assert!(parameters.contains(&-1.5) && parameters.contains(&7.25));
        }
    }
}

#[test]
fn neighboring_values_of_a_gray_code_differ_by_a_bit() {
    let map = WordMap::new(vec![word(6, 0.0, 63.0, WordCode::Gray)]).unwrap();
    let words: Vec<u16> = (0..64).map(|value| encoded(&map, &[value as f32])[0]).collect();
    assert!(words.windows(2).all(|pair| (pair[0] ^ pair[1]).is_power_of_two()));
    assert_eq!(words[..6], [0b0, 0b1, 0b11, 0b10, 0b110, 0b111]);
    // Unused bits have no effect.
    assert_eq!(decoded(&map, &[words[5] | 0xFFC0]), [5.0]);
}

#[test]
fn frozen_parameters_take_no_gene() {
    let gene = word(8, 0.0, 255.0, WordCode::Plain);
    let map = WordMap::new(vec![WordGene::Frozen(-3.0), gene, WordGene::Frozen(9.5), gene]).unwrap();
    assert_eq!(map.genes(), [WordGene::Frozen(-3.0), gene, WordGene::Frozen(9.5), gene]);
    assert_eq!(decoded(&map, &[7, 9]), [-3.0, 7.0, 9.5, 9.0]);
    assert_eq!(encoded(&map, &[f32::NAN, 7.4, 0.0, 1e9]), [7, 255]);
    assert_eq!(encoded(&map, &[0.0, 7.5, 0.0, f32::NEG_INFINITY]), [7, 0]);
}

#[test]
fn invalid_maps_are_refused() {
    assert_eq!(WordMap::new(Vec::new()), Err(errors::no_genes()));
    let refused = |gene| WordMap::new(vec![gene]).unwrap_err();
    assert_eq!(refused(word(0, 0.0, 1.0, WordCode::Gray)), errors::gene_bits(0));
    assert_eq!(refused(word(17, 0.0, 1.0, WordCode::Gray)), errors::gene_bits(17));
    assert_eq!(refused(word(4, 1.0, 0.0, WordCode::Gray)), errors::range(1.0, 0.0));
    let infinite = f32::INFINITY;
    assert_eq!(refused(WordGene::Frozen(infinite)), errors::range(infinite, infinite));
    let map = WordMap::new(vec![word(4, 0.0, 1.0, WordCode::Gray), WordGene::Frozen(2.0)]).unwrap();
    let (mut parameters, mut words) = ([8.0; 2], [8; 1]);
    let lengths = |genes, out| Err(errors::lengths(genes, 1, out));
    assert_eq!(map.decode(&[1, 2], &mut parameters), lengths(2, 2));
    assert_eq!(map.encode(&[1.0], &mut words), lengths(1, 1));
    assert!(matches!(map.encode(&[f32::NAN, 2.0], &mut words), Err(EvoError::OutOfRange { .. })));
    assert_eq!((parameters, words), ([8.0; 2], [8]));
}

fn gene() -> impl Strategy<Value = WordGene> {
    let ends = proptest::array::uniform2(prop_oneof![-10.0_f32..10.0, proptest::num::f32::NORMAL]);
    (1..=16_u32, ends, any::<bool>(), 0..5_u32).prop_map(|(bits, [a, b], gray, kind)| match kind {
        0 => WordGene::Frozen(a),
        // In a range with few numbers several genes have the same value.
        1 => word(bits, a, a.next_up().min(f32::MAX).max(a), WordCode::Gray),
        _ => word(bits, a.min(b), a.max(b), if gray { WordCode::Gray } else { WordCode::Plain }),
    })
}

proptest! {
    #[test]
    fn decoded_values_round_trip(
        genes in proptest::collection::vec(gene(), 1..20),
        words in proptest::collection::vec(any::<u16>(), 20),
    ) {
        let map = WordMap::new(genes).unwrap();
        let parameters = decoded(&map, &words[..map.words()]);
        prop_assert!(parameters.iter().all(|parameter| parameter.is_finite()));
        prop_assert_eq!(decoded(&map, &encoded(&map, &parameters)), parameters);
    }

    /// Compares with a search through all values.
    #[test]
    fn the_nearest_value_is_chosen(bits in 1..=9_u32, ends in proptest::array::uniform2(-10.0_f32..10.0), x in -12.0_f32..12.0) {
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let map = WordMap::new(vec![word(bits, low, high, WordCode::Plain)]).unwrap();
        let away = |number: u16| (f64::from(decoded(&map, &[number])[0]) - f64::from(x)).abs();
        let nearest = (0..1_u16 << bits).min_by(|a, b| away(*a).total_cmp(&away(*b))).unwrap();
        prop_assert_eq!(away(encoded(&map, &[x])[0]), away(nearest));
    }
}
