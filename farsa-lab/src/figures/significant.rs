//! Numbers for people, with four significant digits.

/// A number with four significant digits; all of those before the point where there are more, and as a power of ten beyond nine
/// of these or four zeros behind the point. Files have all digits.
pub(crate) fn significant(x: f64) -> String {
    // Nothing, whatever it was weighed with, has no sign.
    let x = x + 0.0;
    let scientific = format!("{x:.3e}");
    // Of the rounded number: 9.9999 is 10.00.
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        // What is not finite has none.
        None => format!("{x}"),
        Some(exponent @ -5..=8) => format!("{x:.*}", usize::try_from(3 - exponent).unwrap_or(0)),
        Some(_) => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn four_digits_say_how_large_it_is() {
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

    proptest! {
        #[test]
        fn it_is_the_number_to_half_a_unit_of_the_fourth_digit(x in prop::num::f64::NORMAL) {
            let read: f64 = significant(x).parse().unwrap();
            prop_assert!((read - x).abs() <= 5.001e-4 * x.abs(), "{x:?}: {read:?}");
        }
    }
}
