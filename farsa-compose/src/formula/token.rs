//! Tokens of formulas.

use winnow::Parser as _;
use winnow::ascii::multispace0;
use winnow::stream::{Location as _, Stream};
use winnow::token::{literal, take_while};

use crate::formula::nodes::{Input, Number, Parsed, RESERVED, cut};
use crate::formula::unit::Unit;
use crate::formula::unknown;

/// Skips white space.
pub(crate) fn space(input: &mut Input<'_>) -> Parsed<()> {
    multispace0.void().parse_next(input)
}

/// Takes a symbol after white space. Leaves the input unchanged without it.
pub(crate) fn symbol(input: &mut Input<'_>, text: &'static str) -> bool {
    let start = input.checkpoint();
    let taken: Parsed<()> = (multispace0, literal(text)).void().parse_next(input);
    if taken.is_err() {
        input.reset(&start);
    }
    taken.is_ok()
}

/// Takes a reserved word. Leaves the input unchanged without it.
pub(crate) fn keyword(input: &mut Input<'_>, wanted: &str) -> bool {
    let start = input.checkpoint();
    let taken = space(input).is_ok() && word(input).is_some_and(|word| word == wanted);
    if !taken {
        input.reset(&start);
    }
    taken
}

/// Takes a word: letters, digits, `_`, and hyphens between them.
pub(crate) fn word<'t>(input: &mut Input<'t>) -> Option<&'t str> {
    let text: &'t str = input.input.as_ref();
    let is_inner = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let bytes = text.as_bytes();
    if !bytes.first().is_some_and(|byte| byte.is_ascii_alphabetic() || *byte == b'_') {
        return None;
    }
    let inner = |at: usize| bytes.get(at).is_some_and(|byte| is_inner(*byte));
    let mut end = 1;
    while inner(end) || bytes.get(end) == Some(&b'-') && inner(end + 1) {
        end += 1;
    }
    Some(input.next_slice(end))
}

/// Takes a text in single quotes.
pub(crate) fn quoted<'t>(input: &mut Input<'t>) -> Parsed<Option<&'t str>> {
    let offset = input.current_token_start();
    if !symbol(input, "'") {
        return Ok(None);
    }
    let text: &str = take_while(0.., |character| character != '\'').parse_next(input)?;
    if symbol(input, "'") { Ok(Some(text)) } else { cut(offset, "the quote does not end") }
}

/// Takes a number without a sign, with its unit.
pub(crate) fn number(input: &mut Input<'_>) -> Parsed<Option<Number>> {
    let offset = input.current_token_start();
    let text = input.input.as_ref();
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = digits(0);
    if end == 0 {
        return Ok(None);
    }
    if bytes.get(end) == Some(&b'.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits((end + 1 + sign).min(bytes.len()));
        end += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    let value: f64 = text[..end].parse().unwrap_or(f64::INFINITY);
    if !value.is_finite() {
        return cut(offset, "the number is too large");
    }
    input.next_slice(end);
    let Some((unit, [numerator, denominator])) = unit(input)? else {
        return Ok(Some(Number { value, unit: None }));
    };
    Ok(Some(Number { value: value * numerator / denominator, unit: Some(unit) }))
}

/// Takes the unit after a number, such as `m/s`.
fn unit(input: &mut Input<'_>) -> Parsed<Option<(Unit, [f64; 2])>> {
    let start = input.checkpoint();
    space(input)?;
    let offset = input.current_token_start();
    let Some(above) = word(input).filter(|word| !RESERVED.contains(word)) else {
        input.reset(&start);
        return Ok(None);
    };
    if Unit::parse(above).is_none() {
        return cut(offset, unknown("unit", above, Unit::names()));
    }
    // A quotient of units has no space, unlike a quotient of quantities.
    let end = input.checkpoint();
    if input.input.as_ref().starts_with('/') {
        input.next_slice(1);
        if let Some(below) = word(input)
            && let Some(quotient) = Unit::parse(&format!("{above}/{below}"))
        {
            return Ok(Some(quotient));
        }
        input.reset(&end);
    }
    Ok(Unit::parse(above))
}
