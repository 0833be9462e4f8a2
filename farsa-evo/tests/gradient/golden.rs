//! The bits themselves. A change here is a change of every recorded run: CHANGELOG.md lists it under *Values*.

use farsa_evo::Strategy;
use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Optimizer, Pgpe, PgpeConfig, PgpeFitness, Snes, SnesConfig, Xnes,
    XnesConfig,
};

/// The digest of the genomes after fifty generations.
fn digest(mut strategy: impl Strategy<f64>) -> u64 {
    for generation in 0..50 {
        let value = |x: &[f64]| {
            let cost: f64 = x.iter().enumerate().map(|(i, x)| (1.0 + i as f64) * (x - 1.0) * (x - 1.0)).sum();
            // Some fail.
            if cost.to_bits().is_multiple_of(11) { f64::NAN } else { 0.01 * f64::from(generation) - cost }
        };
        let values: Vec<f64> = strategy.ask().iter().map(value).collect();
        strategy.tell_values(&values).unwrap();
    }
    strategy.ask().digest()
}

#[test]
fn strategies_keep_their_bits() {
    let start = || vec![0.25; 13];
    let open_ai = |optimizer| OpenAiEsConfig { optimizer, ..OpenAiEsConfig::new(vec![0.25; 300], 7) };
    let pgpe = |fitness| PgpeConfig { fitness, ..PgpeConfig::new(start(), 0.3, 7) };
    let ars = |top_directions| ArsConfig { top_directions, ..ArsConfig::new(start(), 7) };
    let got = [
        digest(Snes::new(SnesConfig::new(start(), 0.3), 2014).unwrap()),
        digest(Xnes::new(XnesConfig::new(start(), 0.3), 2010).unwrap()),
        digest(OpenAiEs::new(open_ai(Optimizer::ADAM), 2017).unwrap()),
        digest(OpenAiEs::new(open_ai(Optimizer::MOMENTUM), 2017).unwrap()),
        digest(Pgpe::new(pgpe(PgpeFitness::CenteredRanks), 2020).unwrap()),
        digest(Pgpe::new(pgpe(PgpeFitness::Raw), 2020).unwrap()),
        digest(Ars::new(ars(7), 2018).unwrap()),
        digest(Ars::new(ars(3), 2018).unwrap()),
    ];
    let want = [
        0xc206_56eb_60ca_b534,
        0xa425_012d_7696_7ea8,
        0x9d7b_fe81_f3d9_32a1,
        0x5631_9576_e73b_a3ba,
        0x96e7_7aeb_7e2d_845a,
        0xa4b3_9745_d849_2ff0,
        0x2352_239a_ea74_3e5a,
        0xdd1e_e291_7050_9b23,
    ];
    assert_eq!(got, want, "{got:#018x?}");
}
