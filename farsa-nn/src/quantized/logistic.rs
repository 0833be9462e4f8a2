//! The logistic function in integer arithmetic, interpolated linearly between the entries of a table.

/// Fraction bits of activations: 2^15 is 1.
pub(crate) const ACTIVATION_BITS: u32 = 15;

/// Fraction bits of the argument. The lower [`STEP_BITS`] select a point between two entries of the table.
pub(crate) const ARGUMENT_BITS: u32 = 20;
const STEP_BITS: u32 = 15;

/// From here on the result rounds to 1.
const END: u32 = 12;

/// Entries per unit of the argument: the line between two is at most 1.2e-5, 0.4 units, off.
const PER_UNIT: u32 = 1 << (ARGUMENT_BITS - STEP_BITS);
const ENTRIES: usize = (END * PER_UNIT) as usize + 1;

/// 1/(1 + exp(-k/32)) for k = 0, 1, ... 384, in units of 2^-15. Written by the compiler: 770 bytes, and no float at run
/// time.
static TABLE: [u16; ENTRIES] = table();

const fn table() -> [u16; ENTRIES] {
    // exp(-1/32) by its series, whose tenth term is below 1e-21, then its powers.
    let x = -1.0 / PER_UNIT as f64;
    let (mut ratio, mut term, mut n) = (1.0, 1.0, 1);
    while n < 10 {
        term = term * x / n as f64;
        ratio += term;
        n += 1;
    }
    let (mut entries, mut power, mut k) = ([0; ENTRIES], 1.0, 0);
    while k < ENTRIES {
        entries[k] = ((1 << ACTIVATION_BITS) as f64 / (1.0 + power) + 0.5) as u16;
        power *= ratio;
        k += 1;
    }
    entries
}

/// 1/(1 + exp(-x)) with x = `sum` / 2^`bits`, in units of 2^-15. The result is in 0..=2^15, within 1.5 units, and never
/// falls where `sum` rises. `logistic(-sum)` is 2^15 - `logistic(sum)`.
///
/// `bits` is at most [`ARGUMENT_BITS`].
#[inline(always)]
pub(crate) fn logistic(sum: i32, bits: u32) -> i32 {
    let size = sum.unsigned_abs().min(END << bits) << (ARGUMENT_BITS - bits);
    let entry = (size >> STEP_BITS) as usize;
    let between = (size & ((1 << STEP_BITS) - 1)).cast_signed();
    let (low, high) = match TABLE.get(entry..entry + 2) {
        Some(&[low, high]) => (i32::from(low), i32::from(high)),
        // At the end itself.
        _ => (1 << ACTIVATION_BITS, 1 << ACTIVATION_BITS),
    };
    // Neighbours differ by at most 256: the product has 23 bits.
    let value = low + (((high - low) * between + (1 << (STEP_BITS - 1))) >> STEP_BITS);
    if sum < 0 { (1 << ACTIVATION_BITS) - value } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn within_a_unit_and_a_half_and_never_falling() {
        for bits in [10, 15, ARGUMENT_BITS] {
            let (mut last, mut largest) = (0, 0.0_f64);
            for sum in -(13 << bits)..=13 << bits {
                let found = logistic(sum, bits);
                let exact = 32768.0 * farsa_num::logistic(f64::from(sum) / f64::from(1 << bits));
                largest = largest.max((f64::from(found) - exact).abs());
                assert!(found >= last, "falls at {sum} of {bits} bits");
                assert_eq!(found + logistic(-sum, bits), 1 << ACTIVATION_BITS);
                last = found;
            }
            assert!(largest < 1.5, "{largest} units at {bits} bits");
        }
    }

    #[test]
    fn the_ends_of_all_sums() {
        for bits in 0..=ARGUMENT_BITS {
            assert_eq!(logistic(0, bits), 16384);
            assert_eq!(logistic(i32::MAX, bits), 32768);
            assert_eq!(logistic(i32::MIN, bits), 0);
        }
    }

    #[test]
    fn entries_are_rounded_correctly() {
        for (k, entry) in TABLE.into_iter().enumerate() {
            let exact = 32768.0 * farsa_num::logistic(k as f64 / 32.0);
            assert!((f64::from(entry) - exact).abs() <= 0.5 + 1e-9, "entry {k} is {entry}, not {exact}");
        }
    }
}
