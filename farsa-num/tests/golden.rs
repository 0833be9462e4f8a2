//! The bits themselves. A change here is a change of every recorded run: CHANGELOG.md lists it under *Values*.

use farsa_num::{Digest, Domain, Stream, acos, asin, atan2, exp, ln, logistic, sin_cos, tanh};

/// The digest of a function over a grid of `f32` and the same grid in `f64`.
fn digest(low: f64, high: f64, single: impl Fn(f32) -> f32, double: impl Fn(f64) -> f64) -> u64 {
    let mut digest = Digest::new();
    for i in 0..=20_000 {
        let x = low + (high - low) * (f64::from(i) / 20_000.0);
        digest.add_f32(single(x as f32));
        digest.add_f64(double(x));
    }
    digest.finish()
}

#[test]
fn functions_keep_their_bits() {
    let got = [
        ("exp", digest(-110.0, 90.0, exp, exp)),
        ("logistic", digest(-100.0, 100.0, logistic, logistic)),
        ("tanh", digest(-12.0, 12.0, tanh, tanh)),
        ("sin", digest(-10_500.0, 10_500.0, |x| sin_cos(x).0, |x| sin_cos(x).0)),
        ("cos", digest(-20.0, 20.0, |x| sin_cos(x).1, |x| sin_cos(x).1)),
        ("ln", digest(0.0, 40.0, ln, ln)),
        ("asin", digest(-1.0, 1.0, asin, asin)),
        ("acos", digest(-1.0, 1.0, acos, acos)),
        ("atan2", digest(-5.0, 5.0, |y| atan2(y, 0.7 - y * y), |y| atan2(y, 0.7 - y * y))),
    ];
    let want = [
        ("exp", 0x278C_484A_57B0_AA90),
        ("logistic", 0x4C88_BB0F_419A_3EB3),
        ("tanh", 0xC138_A913_A45C_5D47),
        ("sin", 0x408E_BC76_9F45_2A26),
        ("cos", 0x67E8_BF2E_16CA_E1DD),
        ("ln", 0xFB9A_EFF8_31F7_6C5C),
        ("asin", 0xACB8_4641_AA81_CD01),
        ("acos", 0x137D_2B7D_E4F7_9396),
        ("atan2", 0x765C_664D_D7E2_A074),
    ];
    assert_eq!(got, want, "{got:#018x?}");
}

#[test]
fn streams_keep_their_bits() {
    let mut stream = Stream::new(0x0123_4567_89AB_CDEF, Domain::Sensor, 7, 11, 13);
    let mut digest = Digest::new();
    for i in 1..=5000_u32 {
        digest.add_u64(stream.next_u32().into());
        digest.add_u64(stream.next_u64());
        digest.add_f32(stream.uniform());
        digest.add_f64(stream.uniform_f64());
        digest.add_f32(stream.range(-3.0, 5.0));
        digest.add_f64(stream.range_f64(-3.0, 5.0));
        digest.add_u64(stream.below(i).into());
        digest.add_f32(stream.normal());
        digest.add_f32s(&stream.normal_pair());
        digest.add_u64(stream.geometric(-0.01));
    }
    digest.add_u64(stream.position());
    assert_eq!(digest.finish(), 0x74D1_5A29_EEDE_D47E, "{:#018x}", digest.finish());
}
