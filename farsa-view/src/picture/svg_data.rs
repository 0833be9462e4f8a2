//! Numbers, colors, paths and text of SVG.

use std::fmt::Write as _;

use crate::picture::outline::Point2;
use crate::shape::appearance::Color;

/// Writes the data of a path through places, in steps of a tenth of a pixel.
pub(crate) fn path(places: &[Point2], closed: bool) -> String {
    let mut data = String::new();
    if places.len() < 2 || (closed && places.len() < 3) {
        return data;
    }
    let tenths = |place: &Point2| place.map(|x| (10.0 * x).round().clamp(-1e7, 1e7) as i64);
    let number = |tenths: i64| digits(tenths as f64 / 10.0, 10.0);
    let mut last = [0; 2];
    for (i, place) in places.iter().enumerate() {
        let [x, y] = tenths(place);
        if i == 0 {
            let _ = write!(data, "M{},{}l", number(x), number(y));
        } else {
            // Differences of rounded places, so that errors do not add up.
            let [dx, dy] = [number(x - last[0]), number(y - last[1])];
            let gap = if i == 1 || dx.starts_with('-') { "" } else { " " };
            let comma = if dy.starts_with('-') { "" } else { "," };
            let _ = write!(data, "{gap}{dx}{comma}{dy}");
        }
        last = [x, y];
    }
    if closed {
        data.push('z');
    }
    data
}

/// Formats a number, rounded to a multiple of 1 / `parts`, with the fewest digits.
pub(crate) fn digits(x: f64, parts: f64) -> String {
    let rounded = (x * parts).round() / parts;
    // Zero has no sign.
    let text = format!("{}", rounded + 0.0);
    match text.strip_prefix("0.") {
        Some(rest) => format!(".{rest}"),
        None => text.strip_prefix("-0.").map_or(text.clone(), |rest| format!("-.{rest}")),
    }
}

/// Formats a color.
pub(crate) fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Escapes text for XML, without invalid characters.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(' '),
            letter if letter.is_control() || matches!(letter, '\u{fffe}' | '\u{ffff}') => {}
            letter => out.push(letter),
        }
    }
    out
}

/// Returns the place of a name, moved up until it covers no other one, and adds it to those taken.
pub(crate) fn apart(place: Point2, letters: f64, name: &str, taken: &mut Vec<(Point2, f64)>) -> Point2 {
    // The mean letter is about half as wide as high.
    let width = 0.6 * letters * name.chars().count() as f64;
    let mut place = place;
    let covers = |place: Point2, taken: &[(Point2, f64)]| {
        taken.iter().any(|([x, y], other)| {
            (place[1] - y).abs() < 1.1 * letters && place[0] < x + other && *x < place[0] + width
        })
    };
    while covers(place, taken) {
        place[1] -= 0.3 * letters;
    }
    taken.push((place, width));
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, text) in [(0.0, "0"), (-0.04, "0"), (0.25, ".3"), (-0.5, "-.5"), (12.0, "12"), (-3.26, "-3.3")] {
            assert_eq!(digits(x, 10.0), text);
        }
        assert_eq!(hex([0, 158, 255]), "#009eff");
    }

    #[test]
    fn paths_end_where_they_should() {
        assert_eq!(path(&[[1.0, 2.0], [3.04, 1.0], [3.06, 5.0]], true), "M1,2l2-1 .1,4z");
        assert_eq!(path(&[[1.0, 2.0]], false), "");
        // A thousand steps of a third of a tenth are a hundred thirds, in spite of rounding.
        let steps: Vec<Point2> = (0..=1000).map(|i| [f64::from(i) / 30.0, 0.0]).collect();
        let written = path(&steps, false);
        let steps = written.trim_start_matches("M0,0l").split(' ').map(|step| step.trim_end_matches(",0"));
        let sum: f64 = steps.map(|step| step.parse::<f64>().unwrap()).sum();
        assert!((sum - 33.3).abs() < 1e-9, "{sum}");
    }

    #[test]
    fn names_of_one_place_are_written_above_each_other() {
        let mut taken = Vec::new();
        let names = ["the palm's target", "the palm", "grasp"];
        let places = names.map(|name| apart([100.0, 50.0], 10.0, name, &mut taken));
        assert_eq!(places[0], [100.0, 50.0]);
        for (i, [x, y]) in places.into_iter().enumerate() {
            assert!(places[..i].iter().all(|[_, other]| (other - y).abs() >= 11.0) && x == 100.0, "{places:?}");
        }
        // A name of 7 letters of 6 pixels ends at 142.
        assert_eq!(apart([143.0, 50.0], 10.0, "elsewhere", &mut vec![([100.0, 50.0], 42.0)]), [143.0, 50.0]);
        assert!(apart([141.0, 50.0], 10.0, "here", &mut vec![([100.0, 50.0], 42.0)])[1] < 39.1);
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("a<b> & \"c\"\u{7}\n\u{ffff}d"), "a&lt;b&gt; &amp; &quot;c&quot; d");
    }
}
