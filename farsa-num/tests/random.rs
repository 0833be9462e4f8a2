//! The generator: published answers, addresses, positions, and the shape of what is drawn. Nothing here is left to chance.

use farsa_num::{Domain, Stream, ln, philox};
use proptest::prelude::*;

const N: u32 = 400_000;

fn stream() -> Stream {
    Stream::new(2007, Domain::Start, 1, 2, 3)
}

/// `kat_vectors` of the `Random123` distribution.
#[test]
fn philox_gives_the_published_answers() {
    let answers = [
        ([0; 4], [0; 2], [0x6627_E8D5, 0xE169_C58D, 0xBC57_AC4C, 0x9B00_DBD8]),
        ([u32::MAX; 4], [u32::MAX; 2], [0x408F_276D, 0x41C8_3B0E, 0xA20B_C7C6, 0x6D54_51FD]),
        (
            [0x243F_6A88, 0x85A3_08D3, 0x1319_8A2E, 0x0370_7344],
            [0xA409_3822, 0x299F_31D0],
            [0xD16C_FE09, 0x94FD_CCEB, 0x5001_E420, 0x2412_6EA1],
        ),
    ];
    for (counter, key, words) in answers {
        assert_eq!(philox(counter, key), words);
    }
}

/// The address is the promise: a run is replayed from it alone.
#[test]
fn a_stream_is_philox_of_its_address() {
    let domains = [
        (Domain::Start, 0),
        (Domain::Sensor, 1),
        (Domain::Motor, 2),
        (Domain::InitialGenome, 3),
        (Domain::Mutation, 4),
        (Domain::Network, 5),
        (Domain::General, 6),
    ];
    for (domain, number) in domains {
        let mut stream = Stream::new(0x1111_2222_3333_4444, domain, 0xAB_CDEF, 55, 66);
        for block in 0..3 {
            let words = philox([block, number << 24 | 0xAB_CDEF, 55, 66], [0x3333_4444, 0x1111_2222]);
            assert_eq!(words, [(); 4].map(|()| stream.next_u32()));
        }
    }
}

#[test]
fn a_seed_alone_is_a_stream_of_its_own() {
    let mut stream = Stream::from_seed(0x1111_2222_3333_4444);
    assert_eq!(stream, Stream::new(0x1111_2222_3333_4444, Domain::General, 0, 0, 0));
    let words = philox([0, 6 << 24, 0, 0], [0x3333_4444, 0x1111_2222]);
    assert_eq!([(); 4].map(|()| stream.next_u32()), words);
    // Fixed answers, which never change.
    let mut stream = Stream::from_seed(2007);
    assert_eq!([(); 4].map(|()| stream.next_u32()), [1458365785, 247510452, 2115945908, 3279009575]);
}

/// Algorithm 5 of \[Lemire2019\] by division, over the words of a stream: the number, and how many words it took.
fn below_by_division(stream: &mut Stream, n: u32) -> (u32, u32) {
    let unbiased = u64::from(n) * ((1 << 32) / u64::from(n));
    for words in 1.. {
        let product = u64::from(stream.next_u32()) * u64::from(n);
        // The low half of the product is refused below 2^32 mod n.
        if u64::from(product as u32) >= (1 << 32) - unbiased {
            return ((product >> 32) as u32, words);
        }
    }
    unreachable!()
}

#[test]
fn below_refuses_what_would_be_drawn_too_often() {
    // A quarter of 2^32 words is rejected.
    let n = 3 << 30;
    let (mut stream, mut refused) = (stream(), 0);
    for _ in 0..1000 {
        let mut same = stream;
        let (expected, words) = below_by_division(&mut same, n);
        assert_eq!(stream.below(n), expected);
        assert_eq!(stream, same, "{words} words");
        refused += words - 1;
    }
    assert!((200..500).contains(&refused), "{refused} of a thousand");
    // Fixed answers. A word is rejected before the second number.
    let mut stream = Stream::from_seed(1);
    let drawn = [(); 4].map(|()| (stream.below(n), stream.position()));
    assert_eq!(drawn, [(1794326589, 1), (1116488581, 3), (2470284264, 4), (291767875, 5)]);
}

#[test]
fn the_last_word_is_followed_by_the_first() {
    let mut stream = stream();
    let first = stream.next_u32();
    stream.seek((1 << 34) - 1);
    assert_eq!(stream.position(), (1 << 34) - 1);
    stream.next_u32();
    assert_eq!(stream.position(), 0);
    assert_eq!(stream.next_u32(), first);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn seeking_is_drawing(seed in any::<u64>(), skipped in 0_u64..70, ahead in 0_usize..9) {
        let mut drawn = Stream::new(seed, Domain::Motor, 0, 1, 2);
        for _ in 0..skipped {
            drawn.next_u32();
        }
        let mut sought = Stream::new(seed, Domain::Motor, 0, 1, 2);
        for _ in 0..ahead {
            sought.next_u32();
        }
        sought.seek(skipped);
        prop_assert_eq!(sought.position(), skipped);
        prop_assert_eq!(drawn.position(), skipped);
        for _ in 0..9 {
            prop_assert_eq!(sought.next_u32(), drawn.next_u32());
        }
    }

    #[test]
    fn a_range_never_gives_its_end(seed in any::<u64>(), a in any::<f32>(), b in any::<f32>()) {
        let mut stream = Stream::new(seed, Domain::Start, 0, 0, 0);
        let (single, double) = (stream.range(a, b), stream.range_f64(a.into(), b.into()));
        if a < b {
            prop_assert!((a..b).contains(&single), "{}", single);
            prop_assert!((f64::from(a)..f64::from(b)).contains(&double), "{}", double);
        } else {
            prop_assert_eq!(single.to_bits(), a.to_bits());
            prop_assert_eq!(double.to_bits(), f64::from(a).to_bits());
        }
    }

    #[test]
    fn below_is_below(seed in any::<u64>(), n in any::<u32>()) {
        let drawn = Stream::new(seed, Domain::Start, 0, 0, 0).below(n);
        prop_assert!(drawn < n || n == 0 && drawn == 0);
    }

    #[test]
    fn normal_draws_two_words(seed in any::<u64>()) {
        let mut stream = Stream::new(seed, Domain::Start, 0, 0, 0);
        let mut other = stream;
        let [first, second] = stream.normal_pair();
        prop_assert_eq!(stream.position(), 2);
        prop_assert_eq!(other.normal(), first);
        prop_assert!(first.hypot(second) < 6.67);
    }
}

#[test]
fn a_range_is_the_uniform_number_stretched_and_moved() {
    let mut stream = stream();
    for _ in 0..1000 {
        let mut same = stream;
        // A range of 8: the product is exact.
        assert_eq!(stream.range(-2.0, 6.0), 8.0 * same.uniform() - 2.0);
        assert_eq!(stream.range_f64(-2.0, 6.0), 8.0 * same.uniform_f64() - 2.0);
        assert_eq!(stream, same);
    }
}

#[test]
fn a_range_one_number_wide_gives_that_number() {
    let mut stream = stream();
    for _ in 0..1000 {
        assert_eq!(stream.range(1.0, 1.0_f32.next_up()), 1.0);
        assert_eq!(stream.range_f64(-1.0, (-1.0_f64).next_up()), -1.0);
    }
}

/// Sum over the cells of (found - expected)^2 / expected.
fn chi_square(cells: &[u32]) -> f64 {
    let expected = cells.iter().map(|&c| f64::from(c)).sum::<f64>() / cells.len() as f64;
    cells.iter().map(|&c| (f64::from(c) - expected) * (f64::from(c) - expected) / expected).sum()
}

/// The square of `cells - 1` normal numbers has this mean and spread. Five spreads do not occur by chance.
fn assert_even(cells: &[u32]) {
    let freedom = (cells.len() - 1) as f64;
    let chi = chi_square(cells);
    assert!((chi - freedom).abs() < 5.0 * (2.0 * freedom).sqrt(), "chi^2 {chi} of {freedom}");
}

#[test]
fn uniforms_fill_their_interval_evenly() {
    let mut stream = stream();
    let (mut single, mut double, mut below, mut pairs) = ([0; 1000], [0; 1000], [0; 37], [0; 1024]);
    for _ in 0..N {
        let (u, v) = (stream.uniform(), stream.uniform_f64());
        assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v));
        assert_eq!(u * 16_777_216.0, (u * 16_777_216.0).trunc());
        single[(u * 1000.0) as usize] += 1;
        double[(v * 1000.0) as usize] += 1;
        below[stream.below(37) as usize] += 1;
        // Neighbouring words, to catch words that follow each other.
        pairs[(stream.below(32) * 32 + stream.below(32)) as usize] += 1;
    }
    assert_even(&single);
    assert_even(&double);
    assert_even(&below);
    assert_even(&pairs);
}

/// Three out of four words would be rejected or favoured by a careless reduction.
#[test]
fn below_is_unbiased_where_bias_is_worst() {
    let mut stream = stream();
    let mut thirds = [0; 3];
    for _ in 0..N {
        thirds[(stream.below(3 << 30) >> 30) as usize] += 1;
    }
    assert_even(&thirds);
}

#[test]
fn neighbouring_addresses_are_unrelated() {
    let mut bits = [0; 32];
    for individual in 0..20_000 {
        let a = Stream::new(1, Domain::Mutation, 0, individual, 5).next_u32();
        let b = Stream::new(1, Domain::Mutation, 0, individual + 1, 5).next_u32();
        for (i, count) in bits.iter_mut().enumerate() {
            *count += (a ^ b) >> i & 1;
        }
    }
    for count in bits {
        assert!((f64::from(count) - 10_000.0).abs() < 5.0 * 70.7, "{count} of 20000 differ");
    }
}

#[test]
fn normals_have_the_moments_and_tails_of_normals() {
    let mut stream = stream();
    let (mut moments, mut product, mut beyond) = ([0.0; 4], 0.0, [0_u32; 3]);
    for _ in 0..N {
        let [x, y] = stream.normal_pair().map(f64::from);
        for x in [x, y] {
            let mut power = 1.0;
            for moment in &mut moments {
                power *= x;
                *moment += power / f64::from(2 * N);
            }
            for (count, limit) in beyond.iter_mut().zip([1.0, 2.0, 3.0]) {
                *count += u32::from(x.abs() > limit);
            }
        }
        product += x * y / f64::from(N);
    }
    // Standard errors: sqrt(var(x^k) / n), with variances 1, 2, 15, 96.
    let n = f64::from(2 * N);
    for (moment, (mean, variance)) in moments.iter().zip([(0.0, 1.0), (1.0, 2.0), (0.0, 15.0), (3.0, 96.0)]) {
        assert!((moment - mean).abs() < 5.0 * (variance / n).sqrt(), "{moments:?}");
    }
    assert!(product.abs() < 5.0 / f64::from(N).sqrt(), "{product}");
    for (count, share) in beyond.iter().zip([0.317_310_508, 0.045_500_264, 0.002_699_796]) {
        assert!((f64::from(*count) - n * share).abs() < 5.0 * (n * share).sqrt(), "{beyond:?}");
    }
}

#[test]
fn geometric_skips_as_often_as_failures_come() {
    for p in [0.9, 0.5, 0.01, 1e-5] {
        let mut stream = stream();
        let log = ln(1.0 - p);
        let (mut sum, mut none) = (0.0, 0_u32);
        for _ in 0..N {
            let failures = stream.geometric(log);
            sum += failures as f64;
            none += u32::from(failures == 0);
        }
        let n = f64::from(N);
        let (mean, spread) = ((1.0 - p) / p, (1.0 - p).sqrt() / p);
        assert!((sum / n - mean).abs() < 5.0 * spread / n.sqrt(), "p {p}: mean {} of {mean}", sum / n);
        assert!((f64::from(none) - n * p).abs() <= 5.0 * (n * p * (1.0 - p)).sqrt() + 1.0, "p {p}: {none} at once");
    }
    assert_eq!(stream().geometric(ln(0.0)), 0, "certain");
    for never in [ln(1.0), -0.0, 0.5, f64::NAN] {
        assert_eq!(stream().geometric(never), u64::MAX, "impossible");
    }
}
