//! Arithmetic of farsa-num and farsa-nn in C, operation by operation.

/// Beginning of a source file in single precision.
pub(super) const REALS: &str = "\
#include <float.h>
#include <stdint.h>

#ifdef __FAST_MATH__
#error \"-ffast-math changes the outputs: compile this file without it\"
#endif
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error \"single precision is needed: on 32-bit x86 compile with -msse2 -mfpmath=sse\"
#endif
/* A fused product and sum is rounded once and not twice, which changes the outputs. clang obeys the pragma except with
   -ffp-contract=fast. */
#if defined(__GNUC__) && !defined(__clang__)
#ifdef __FP_FAST_FMAF
#pragma GCC optimize(\"fp-contract=off\")
#endif
#else
#pragma STDC FP_CONTRACT OFF
#endif

/* On AVR constants stay in flash. */
#ifdef __AVR__
#include <avr/pgmspace.h>
#define STORED static const PROGMEM
#define READ(at) pgm_read_float(at)
#else
#define STORED static const
#define READ(at) (*(at))
#endif

typedef union {
    float real;
    uint32_t bits;
} word;

";

/// Beginning of a source file in integers.
pub(super) const INTEGERS: &str = "\
/* On AVR constants stay in flash. */
#ifdef __AVR__
#include <avr/pgmspace.h>
#define STORED static const PROGMEM
#define READ(at) pgm_read_word(at)
#else
#define STORED static const
#define READ(at) (*(at))
#endif

";

/// Functions by the text of their call. Later ones call earlier ones.
pub(super) const FUNCTIONS: [(&str, &str); 14] = [
    ("exponential(", EXPONENTIAL),
    ("inverse(", INVERSE),
    ("logistic(", LOGISTIC),
    ("tangent(", TANGENT),
    ("threshold(", THRESHOLD),
    ("rectified(", RECTIFIED),
    ("clamped(", CLAMPED),
    ("copy(", COPY),
    ("add(", ADD),
    ("copy_integers(", COPY_INTEGERS),
    ("product(", PRODUCT),
    ("share(", SHARE),
    ("source(", SOURCE),
    ("sigma(", SIGMA),
];

const EXPONENTIAL: &str = "\
/* 2^n. */
static float power(float n)
{
    word w;
    w.real = n + 12583039.0f;
    w.bits <<= 23;
    return w.real;
}

/* e^x = 2^k e^r with |r| <= 0.347. Adding 1.5 2^23 rounds to an integer. */
static float exponential(float x)
{
    float k, half, high, low, r, q;
    if (x > 89.0f) x = 89.0f;
    if (x < -105.0f) x = -105.0f;
    k = (x * 1.4426950408889634f + 12582912.0f) - 12582912.0f;
    high = x - k * 0.693145751953125f;
    low = k * 1.428606765330187e-6f;
    r = high - low;
    q = 0.5f + r * (0.166665763f + r * (0.0416663736f + r * (0.0083632376f + r * 0.00139412156f)));
    half = (k * 0.5f + 12582912.0f) - 12582912.0f;
    return ((high + (r * r * q - low)) + 1.0f) * power(half) * power(k - half);
}

";

const INVERSE: &str = "\
/* 1/x. The library of AVR does not round quotients below 2^-126 to the nearest number. */
static float inverse(float x)
{
#ifdef __AVR__
    word w;
    w.real = x;
    if (w.bits > 0x7e800000 && w.bits < 0x7f800000) {
        uint64_t twice = (uint64_t)1 << (w.bits < 0x7f000000 ? 47 : 46);
        w.bits = (uint32_t)((twice / ((w.bits & 0x7fffff) | 0x800000) + 1) / 2);
        return w.real;
    }
#endif
    return 1.0f / x;
}

";

const LOGISTIC: &str = "\
static float logistic(float x)
{
    return inverse(1.0f + exponential(-x));
}

";

const TANGENT: &str = "\
/* The hyperbolic tangent. */
static float tangent(float x)
{
    float size = x < 0.0f ? -x : x, z = x * x, large;
    if (size < 0.5625f)
        return x + x * (z * (-0.333333135f + z * (0.13332434f + z * (-0.0538352095f + z * (0.020997433f + z * -0.0061647906f)))));
    large = 1.0f - 2.0f / (exponential(size + size) + 1.0f);
    return x < 0.0f ? -large : large;
}

";

const THRESHOLD: &str = "\
static float threshold(float x)
{
    return 0.0f <= x ? 1.0f : 0.0f;
}

";

const RECTIFIED: &str = "\
static float rectified(float x)
{
    return x > 0.0f ? x : 0.0f;
}

";

const CLAMPED: &str = "\
/* An input: NaN counts as 0, and larger magnitudes as a million. */
static float clamped(float x)
{
    if (x < -1e6f) return -1e6f;
    if (x > 1e6f) return 1e6f;
    return x == x ? x : 0.0f;
}

";

const COPY: &str = "\
static void copy(float *to, const float *from, int count)
{
    for (int i = 0; i < count; i++) to[i] = READ(from + i);
}

";

const ADD: &str = "\
/* Adds the sources one after the other: sums[i] = sums[i] + weights[j][i] x[j]. */
static void add(float *sums, int targets, const float *x, int sources, const float *weights)
{
    for (int j = 0; j < sources; j++, weights += targets)
        for (int i = 0; i < targets; i++) sums[i] += READ(weights + i) * x[j];
}

";

const COPY_INTEGERS: &str = "\
static void copy_integers(int16_t *to, const int16_t *from, int count)
{
    for (int i = 0; i < count; i++) to[i] = (int16_t)READ(from + i);
}

";

const PRODUCT: &str = "\
/* Rounded down: this needs a compiler whose >> keeps the sign, as all common ones do. */
static int32_t product(int16_t weight, int32_t source, int shift)
{
    return (weight * source) >> shift;
}

";

const SHARE: &str = "\
/* d / 2^14 of a difference. */
static int32_t share(int32_t d, int32_t difference)
{
    int32_t high = difference >> 15, low = difference - high * 32768;
    return d * high * 2 + ((d * low) >> 14);
}

";

const SOURCE: &str = "\
/* An activation in units of 2^-15. */
static int32_t source(int32_t h)
{
    return (h + 16384) >> 15;
}

";

const SIGMA: &str = "\
/* 1/(1 + exp(-x)) in units of 2^-15 from a table with lines between its entries. */
static int32_t sigma(int32_t sum)
{
    uint32_t size = sum < 0 ? 0 - (uint32_t)sum : (uint32_t)sum;
    int32_t value = 32768;
    if (size < (uint32_t)12 << SUM_BITS) {
        size <<= 20 - SUM_BITS;
        int32_t low = (uint16_t)READ(LOGISTIC + (size >> 15)), high = (uint16_t)READ(LOGISTIC + (size >> 15) + 1);
        value = low + (((high - low) * (int32_t)(size & 32767) + 16384) >> 15);
    }
    return sum < 0 ? 32768 - value : value;
}

";
