//! A lane computes what one lane alone computes, bit for bit, at every instruction set of this machine.

use farsa_num::fearless_simd::{dispatch, f32x8, f32x16};
use farsa_num::{Instructions, Mask, Scalar, exp, logistic, sin_cos, tanh};
use proptest::prelude::*;

/// Everything the crate computes of three numbers, in one order.
#[inline(always)]
fn everything<S: Scalar<Real = f32>>(a: S, b: S, c: S) -> [S; 31] {
    let truth = |mask: S::Mask| S::select(mask, a.constant(1.0), a.constant(-0.0));
    let mut sum = a;
    sum += b;
    let mut difference = a;
    difference -= b;
    let mut product = a;
    product *= b;
    // Only whole numbers within the exponents are specified.
    let whole = a.clamp(a.constant(-126.0), a.constant(127.0)).round_small();
    let ((sine, cosine), (lt, le)) = (sin_cos(a), (a.lt(b), a.le(b)));
    [
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        sum,
        difference,
        product,
        a.sqrt(),
        a.abs(),
        a.min(b),
        a.max(b),
        a.clamp(b, c),
        a.round_small(),
        whole.exp2_integer(),
        a.constant(0.1),
        a.like(0.1),
        truth(lt),
        truth(le),
        truth(a.gt(b)),
        truth(a.ge(b)),
        truth(lt & b.lt(c)),
        truth(lt | b.lt(c)),
        truth(!le),
        S::select(lt, b, c),
        exp(a),
        logistic(a),
        tanh(a),
        sine,
        cosine,
        exp(a * b) - c * logistic(b),
    ]
}

/// `everything`, over as many numbers as there are, `S::LANES` at a time.
#[inline(always)]
fn run<S: Scalar<Real = f32>>(simd: S::Simd, numbers: &[[f32; 3]]) -> Vec<[f32; 31]> {
    let mut results = vec![];
    for chunk in numbers.chunks(S::LANES) {
        let mut lanes = [S::splat(simd, 0.25); 3];
        for (i, abc) in chunk.iter().enumerate() {
            for (lane, x) in lanes.iter_mut().zip(abc) {
                lane.set_lane(i, *x);
            }
        }
        let [a, b, c] = lanes;
        let values = everything(a, b, c);
        results.extend((0..chunk.len()).map(|i| values.map(|v| v.lane(i))));
    }
    results
}

fn assert_same(numbers: &[[f32; 3]]) {
    let alone = run::<f32>((), numbers);
    for instructions in Instructions::available() {
        let eight = dispatch!(instructions.level(), simd => run::<f32x8<_>>(simd, numbers));
        let sixteen = dispatch!(instructions.level(), simd => run::<f32x16<_>>(simd, numbers));
        for (width, lanes) in [(8, eight), (16, sixteen)] {
            for ((abc, want), got) in numbers.iter().zip(&alone).zip(&lanes) {
                for (i, (w, g)) in want.iter().zip(got).enumerate() {
                    let same = w.to_bits() == g.to_bits() || w.is_nan() && g.is_nan();
                    assert!(same, "value {i} of {abc:?}: {w:?} alone, {g:?} in {width} lanes at {instructions:?}");
                }
            }
        }
    }
}

#[test]
fn lanes_equal_one_lane_on_edges() {
    let edges = [
        0.0,
        f32::from_bits(1),
        1e-40,
        f32::MIN_POSITIVE,
        1e-20,
        0.3465,
        0.3466,
        0.5,
        0.5625,
        core::f32::consts::FRAC_PI_4,
        1.0,
        1.5,
        2.5,
        core::f32::consts::PI,
        87.4,
        88.7,
        88.8,
        103.9,
        1e4,
        4_194_304.0,
        4_194_305.0,
        1e20,
        f32::MAX,
        f32::INFINITY,
        f32::NAN,
    ];
    let edges: Vec<f32> = edges.iter().flat_map(|&x| [x, -x]).collect();
    let mut numbers = vec![];
    for &a in &edges {
        for &b in &edges {
            numbers.push([a, b, edges[numbers.len() * 7 % edges.len()]]);
        }
    }
    println!("instructions that ran: {:?}", Instructions::available().collect::<Vec<_>>());
    assert_same(&numbers);
}

#[test]
fn lanes_equal_one_lane_on_a_fine_grid() {
    let grid: Vec<_> = (0..60_000).map(|i| (i as f32 - 30_000.0) * 0.0037).map(|x| [x, 0.3 - x, x * x]).collect();
    assert_same(&grid);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn lanes_equal_one_lane_on_any_bits(bits in prop::collection::vec(any::<[u32; 3]>(), 1..40)) {
        assert_same(&bits.iter().map(|abc| abc.map(f32::from_bits)).collect::<Vec<_>>());
    }

    #[test]
    fn lanes_equal_one_lane_on_usual_numbers(numbers in prop::collection::vec(prop::array::uniform3(-100_f32..100.0), 1..40)) {
        assert_same(&numbers);
    }
}

#[test]
fn lanes_come_from_a_slice_and_go_back() {
    #[inline(always)]
    fn round<S: Scalar<Real = f32>>(simd: S::Simd, from: &[f32], to: &mut [f32]) -> [f32; 2] {
        let x = S::load(simd, from);
        (x + x).store(to);
        [x.lane(0), x.lane(S::LANES - 1)]
    }
    let from: [f32; 20] = core::array::from_fn(|i| i as f32);
    let check = |lanes: usize, run: &dyn Fn(&mut [f32]) -> [f32; 2]| {
        let mut to = [-1.0; 20];
        assert_eq!(run(&mut to), [0.0, (lanes - 1) as f32]);
        assert!((0..20).all(|i| to[i] == if i < lanes { 2.0 * from[i] } else { -1.0 }));
    };
    check(1, &|to| round::<f32>((), &from, to));
    for instructions in Instructions::available() {
        check(8, &|to| dispatch!(instructions.level(), simd => round::<f32x8<_>>(simd, &from, to)));
        check(16, &|to| dispatch!(instructions.level(), simd => round::<f32x16<_>>(simd, &from, to)));
    }
}

#[test]
fn masks_tell_any_all_and_which() {
    for instructions in Instructions::available() {
        dispatch!(instructions.level(), simd => {
            let mut x = f32x8::splat(simd, 1.0);
            let one = x;
            assert!(x.le(one).all() && x.le(one).any() && !x.lt(one).any() && !x.lt(one).all());
            x.set_lane(5, 0.0);
            let mask = x.lt(one);
            assert!(mask.any() && !mask.all());
            assert!((0..20).all(|i| Mask::lane(mask, i) == (i == 5)), "{instructions:?}");
        });
    }
    assert!(Mask::lane(true, 0) && !Mask::lane(true, 1) && !Mask::lane(false, 0));
}

/// Where a wide set is not found, all is computed with the same bits and takes longer.
#[test]
#[cfg(all(target_arch = "x86_64", feature = "std"))]
fn the_instruction_sets_are_those_that_the_processor_tells() {
    macro_rules! has {
        ($($feature:tt)*) => { true $(&& std::arch::is_x86_feature_detected!($feature))* };
    }
    let v3 = has!("avx2" "bmi1" "bmi2" "cmpxchg16b" "f16c" "fma" "fxsr" "lzcnt" "movbe" "popcnt" "xsave");
    let vectors =
        has!("avx512bitalg" "avx512bw" "avx512cd" "avx512dq" "avx512f" "avx512ifma" "avx512vbmi" "avx512vbmi2");
    let more = has!("avx512vl" "avx512vnni" "avx512vpopcntdq" "gfni" "pclmulqdq" "vaes" "vpclmulqdq" "aes" "sha");
    let beside = has!("adx" "rdrand" "rdseed" "xsavec" "xsaveopt" "xsaves");
    let available: Vec<Instructions> = Instructions::available().collect();
    for (one, there) in [
        (Instructions::Sse2, true),
        (Instructions::Sse4_2, has!("sse4.2" "popcnt")),
        (Instructions::Avx2, v3),
        (Instructions::Avx512, v3 && vectors && more && beside),
        (Instructions::Neon, false),
        (Instructions::WasmSimd128, false),
    ] {
        assert_eq!(available.contains(&one), there, "{one}");
        assert_eq!(one.to_string(), one.name());
    }
    assert_eq!(Some(&Instructions::detect()), available.last());
    assert_eq!(Instructions::default(), Instructions::detect());
    if cfg!(not(target_feature = "sse4.2")) {
        assert_eq!(Instructions::baseline(), Instructions::Sse2);
    }
    for one in available {
        assert!(!one.level().is_fallback(), "{one}");
    }
}
