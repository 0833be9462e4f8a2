//! A comparison of robot models up to rounding.

/// The attributes with numbers that may differ for the same robot: angles of a rotation, and the impedance of a contact, computed
/// from its stiffness.
const DERIVED: [&str; 3] = ["rpy", "solref", "solimp"];
/// The largest difference of numbers, as a share of the largest.
const ROUNDING: f64 = 1e-9;

/// The words of a text, without the derived numbers.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let mut derived = false;
    // Attributes are `name="numbers"`: every second part at quotes is a value.
    text.split('"').enumerate().flat_map(move |(part, within)| {
        let value = part % 2 == 1;
        let left_out = value && derived;
        derived = !value && DERIVED.iter().any(|name| within.trim_end_matches('=').ends_with(name));
        if left_out { "" } else { within }.split_whitespace()
    })
}

/// Compares two words, with a tolerance for numbers.
fn alike(one: &str, other: &str, largest: f64) -> bool {
    match (one == other, one.parse::<f64>(), other.parse::<f64>()) {
        (true, ..) => true,
        (false, Ok(one), Ok(other)) => (one - other).abs() <= ROUNDING * largest,
        _ => false,
    }
}

/// Compares two written models, except for the rounding of rotations.
pub fn same_model(one: &str, other: &str) -> bool {
    let numbers = words(one).filter_map(|word| word.parse::<f64>().ok()).filter(|number| number.is_finite());
    let largest = numbers.fold(1.0, |largest: f64, number| largest.max(number.abs()));
    let (mut left, mut right) = (words(one), words(other));
    loop {
        match (left.next(), right.next()) {
            (None, None) => return true,
            (Some(one), Some(other)) if alike(one, other, largest) => {}
            _ => return false,
        }
    }
}
