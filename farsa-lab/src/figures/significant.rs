//! Numbers with four significant digits.

/// Formats a number for people with four significant digits and at least all digits of its integer part.
///
/// Very large and very small numbers are in scientific notation. Files have all digits.
pub(crate) fn significant(x: f64) -> String {
    // Zero has no sign.
    let x = x + 0.0;
    let scientific = format!("{x:.3e}");
    // The exponent of the rounded number: 9.9999 is 10.00.
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        // Infinities and NaN.
        None => format!("{x}"),
        Some(exponent @ -5..=8) => format!("{x:.*}", usize::try_from(3 - exponent).unwrap_or(0)),
        Some(_) => scientific,
    }
}

/// Formats a fitness with four digits, or its absence after a failure.
pub(crate) fn scored(fitness: f64) -> String {
    if fitness.is_finite() { format!("fitness {}", significant(fitness)) } else { "no fitness".into() }
}

/// Formats an optional remark in parentheses after a space.
pub(crate) fn remark(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!(" ({text})") }
}

/// Formats a share as a percentage, and NaN as a dash.
pub(crate) fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.1} %", 100.0 * share) } else { "–".into() }
}

/// Formats a number of things, in the singular for one.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn four_significant_digits_are_shown() {
        for (x, text) in [
            (0.0, "0.000"),
            (-0.0, "0.000"),
            (6.366340887909837, "6.366"),
            (-0.5430833333, "-0.5431"),
            (9.9996, "10.00"),
            (0.000_012_345, "0.00001234"),
            (0.000_001_234_5, "1.234e-6"),
            (1234.4, "1234"),
            (98_765.4, "98765"),
            (123_456_789.0, "123456789"),
            (1_234_567_890.0, "1.235e9"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(significant(x), text);
        }
    }

    #[test]
    fn shares_are_percentages() {
        assert_eq!([0.5, 1.0 / 3.0, f64::NAN].map(percent), ["50.0 %", "33.3 %", "–"]);
    }

    #[test]
    fn a_fitness_and_a_remark_may_be_absent() {
        assert_eq!([2.5, f64::NAN, f64::NEG_INFINITY].map(scored), ["fitness 2.500", "no fitness", "no fitness"]);
        assert_eq!(["", "sum of 5 trials"].map(remark), ["", " (sum of 5 trials)"]);
    }

    #[test]
    fn one_thing_is_singular() {
        assert_eq!([0, 1, 2].map(|count| counted(count, "bit")), ["0 bits", "1 bit", "2 bits"]);
    }

    proptest! {
        #[test]
        fn it_is_the_number_to_half_a_unit_of_the_fourth_digit(x in prop::num::f64::NORMAL) {
            let read: f64 = significant(x).parse().unwrap();
            prop_assert!((read - x).abs() <= 5.001e-4 * x.abs(), "{x:?}: {read:?}");
        }
    }
}
