//! Tables of infrared readings that were measured at different distances and angles.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

/// The readings of a real robot's infrared sensors for one surface, sampled at different distances and angles.
///
/// Distances are measured from the hull of the robot to the nearest point of the surface. Angles are the bearings of
/// this point from the center of the robot, clockwise from its heading.
#[derive(Clone, Debug, PartialEq)]
pub struct InfraredTable {
    sensors: usize,
    angles: usize,
    distances: usize,
    /// First distance and step between distances [mm].
    first: f32,
    step: f32,
    /// Readings [distances x angles x sensors] in [0, 1).
    readings: Vec<f32>,
}

/// The largest reading of the ten-bit converter that the tables were measured with.
const MAX_READING: u16 = 1023;

/// The most readings that a table may announce: 4096 times those of a Khepera's.
const MAX_READINGS: usize = 4096 * 8 * 180 * 20;

impl InfraredTable {
    /// Parses the contents of a `.sam` file of FARSA.
    ///
    /// The first line contains `sensors angles distances first step`, where the last two values are integers in
    /// millimeters. For each distance there is a line `TURN k`, starting with k = 0. It is followed by one line per
    /// angle with a reading in 0..=1023 for each sensor. The last line is `END`. Empty lines are ignored.
    ///
    /// ```
    /// use farsa_body::sensors::infrared::InfraredTable;
    ///
    /// let table = InfraredTable::parse("2 3 1 5 2\nTURN 0\n0 512\n256 0\n0 0\nEND\n").unwrap();
    /// assert_eq!(table.response(0.006, 0.0), Some(&[0.0, 0.5][..])); // 6 mm from the hull, ahead
    /// assert_eq!(table.response(0.006, -2.2), Some(&[0.25, 0.0][..])); // to the right: the second of three rows
    /// assert_eq!(table.response(0.007, 0.0), None);
    ///
    /// let error = InfraredTable::parse("2 3 1 5 2\nTURN 0\n0 512\n256 2000\n0 0\nEND\n").unwrap_err();
    /// assert_eq!(error.to_string(), "line 4: a reading of 2000, but they are whole numbers from 0 to 1023");
    /// ```
    ///
    /// # Errors
    /// Returns the first error and the number of its line.
    pub fn parse(text: &str) -> Result<Self, InfraredTableError> {
        let mut lines = Lines { lines: text.lines().enumerate(), last: 0 };
        let (line, header) = lines.next("the sizes `sensors angles distances first step`")?;
        let fields: Vec<&str> = header.split_whitespace().collect();
        let &[sensors, angles, distances, first, step] = fields.as_slice() else {
            return Err(InfraredTableError::Width { line, expected: 5, found: fields.len() });
        };
        let number = |field: &'static str, text: &str, least: u16| {
            let size = text.parse::<u16>().ok().filter(|&size| size >= least);
            size.ok_or_else(|| InfraredTableError::Size { line, field, found: text.to_string() })
        };
        let [sensors, angles, distances] =
            [("sensors", sensors), ("angles", angles), ("distances", distances)].map(|(field, s)| number(field, s, 1));
        let [sensors, angles, distances] = [sensors?, angles?, distances?].map(usize::from);
        let (first, step) = (number("first distance", first, 0)?, number("step", step, 1)?);
        // Three numbers of 16 bits fit into 64.
        let readings = sensors as u64 * angles as u64 * distances as u64;
        if readings > MAX_READINGS as u64 {
            return Err(InfraredTableError::TooLarge { line, readings });
        }
        let mut table =
            Self { sensors, angles, distances, first: first.into(), step: step.into(), readings: Vec::new() };
        for turn in 0..distances {
            let (line, text) = lines.next("TURN")?;
            let mut words = text.split_whitespace();
            let right = words.next() == Some("TURN")
                && words.next().and_then(|number| number.parse().ok()) == Some(turn)
                && words.next().is_none();
            if !right {
                return Err(InfraredTableError::Turn { line, expected: turn, found: text.to_string() });
            }
            for _ in 0..angles {
                let (line, text) = lines.next("readings")?;
                let before = table.readings.len();
                for word in text.split_whitespace() {
                    let reading = word.parse::<u16>().ok().filter(|&reading| reading <= MAX_READING);
                    let reading =
                        reading.ok_or_else(|| InfraredTableError::Reading { line, found: word.to_string() })?;
                    table.readings.push(f32::from(reading) / f32::from(MAX_READING + 1));
                }
                let found = table.readings.len() - before;
                if found != sensors {
                    return Err(InfraredTableError::Width { line, expected: sensors, found });
                }
            }
        }
        let (line, text) = lines.next("END")?;
        if text != "END" {
            return Err(InfraredTableError::End { line, found: text.to_string() });
        }
        match lines.next("") {
            Ok((line, text)) => Err(InfraredTableError::Garbage { line, found: text.to_string() }),
            Err(_) => Ok(table),
        }
    }

    /// Gets the number of sensors.
    pub fn sensors(&self) -> usize {
        self.sensors
    }

    /// Computes the distance from the hull at which the response ends (in meters).
    pub fn range(&self) -> f32 {
        (self.first + self.step * self.distances as f32) / 1000.0
    }

    /// Returns the readings of all sensors for a surface at the given distance from the hull (in meters) and the given
    /// bearing (in radians), counter-clockwise from straight ahead. The readings are in [0, 1).
    ///
    /// The row is chosen as in FARSA. The index of the distance is trunc((distance - first) / step). It is 0 below the
    /// first distance, and the result is `None` after the last one. The index of the angle is trunc(angle / 360 angles)
    /// for the clockwise angle in [0, 360) degrees. Readings are divided by 1024. The result is `None` if an argument
    /// is NaN.
    pub fn response(&self, distance: f32, bearing: f32) -> Option<&[f32]> {
        const FULL: f32 = 2.0 * core::f32::consts::PI;
        let from_first = (1000.0 * distance - self.first) / self.step;
        let turns = -bearing / FULL;
        if from_first.is_nan() || from_first >= self.distances as f32 || !turns.is_finite() {
            return None;
        }
        // The cast truncates, and takes what is negative for 0.
        let distance = from_first as usize;
        let share = turns - libm::floorf(turns);
        // The share of an angle just below a full turn may be rounded up to 1.
        let angle = ((share * self.angles as f32) as usize).min(self.angles - 1);
        let row = (distance * self.angles + angle) * self.sensors;
        self.readings.get(row..row + self.sensors)
    }
}

/// The lines of a text that are not empty, with their numbers from 1.
struct Lines<'a> {
    lines: core::iter::Enumerate<core::str::Lines<'a>>,
    last: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self, expected: &'static str) -> Result<(usize, &'a str), InfraredTableError> {
        for (index, line) in &mut self.lines {
            self.last = index + 1;
            if !line.trim().is_empty() {
                return Ok((index + 1, line.trim()));
            }
        }
        Err(InfraredTableError::Truncated { line: self.last + 1, expected })
    }
}

/// The reason why a table of infrared readings cannot be parsed. Lines are counted from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum InfraredTableError {
    /// A size in the first line is not an integer, too small or larger than 65535.
    Size {
        /// Number of the line.
        line: usize,
        /// Name of the size that the line should contain.
        field: &'static str,
        /// Text in the file.
        found: String,
    },
    /// The number of readings in the first line is larger than the file permits.
    TooLarge {
        /// Number of the line.
        line: usize,
        /// Announced number of readings.
        readings: u64,
    },
    /// A line contains too few or too many numbers.
    Width {
        /// Number of the line.
        line: usize,
        /// Expected number of values.
        expected: usize,
        /// Actual number of values.
        found: usize,
    },
    /// A reading is not an integer from 0 to 1023.
    Reading {
        /// Number of the line.
        line: usize,
        /// Text in the file.
        found: String,
    },
    /// The number of the next distance is missing. The preceding distance may also have too few or too many rows.
    Turn {
        /// Number of the line.
        line: usize,
        /// Expected number after `TURN`.
        expected: usize,
        /// Text in the file.
        found: String,
    },
    /// The file ends too early.
    Truncated {
        /// Number of the missing line.
        line: usize,
        /// Expected content.
        expected: &'static str,
    },
    /// There is no line `END` after the readings.
    End {
        /// Number of the line where it is expected.
        line: usize,
        /// Text in the file.
        found: String,
    },
    /// There is additional text after `END`.
    Garbage {
        /// Number of the line.
        line: usize,
        /// Text in the file.
        found: String,
    },
}

/// The beginning of a text that may be anything.
fn head(text: &str) -> &str {
    text.char_indices().nth(40).map_or(text, |(end, _)| &text[..end])
}

impl fmt::Display for InfraredTableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { line, field, found } => {
                let least = u8::from(*field != "first distance");
                write!(f, "line {line}: {field} `{}`, but it is a whole number from {least} to 65535", head(found))
            }
            Self::TooLarge { line, readings } => {
                write!(f, "line {line}: {readings} readings, at most {MAX_READINGS} are taken")
            }
            Self::Width { line, expected, found } => write!(f, "line {line}: {found} numbers instead of {expected}"),
            Self::Reading { line, found } => {
                write!(
                    f,
                    "line {line}: a reading of {}, but they are whole numbers from 0 to {MAX_READING}",
                    head(found)
                )
            }
            Self::Turn { line, expected, found } => {
                write!(f, "line {line}: `{}` instead of `TURN {expected}`", head(found))
            }
            Self::Truncated { line, expected } => {
                write!(f, "line {line}: the text ends where {expected} should follow")
            }
            Self::End { line, found } => write!(f, "line {line}: `{}` instead of `END`", head(found)),
            Self::Garbage { line, found } => write!(f, "line {line}: `{}` after `END`", head(found)),
        }
    }
}

impl core::error::Error for InfraredTableError {}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::format;
    use proptest::prelude::*;

    /// Two sensors, three angles, two distances.
    const TABLE: &str = "2 3 2 5 2 \nTURN 0\n1 2\n3 4\n5 6\nTURN 1\n7 8\n9 10\n11 12\nEND";

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let said = |text: &str| InfraredTable::parse(text).map_err(|error| error.to_string());
        assert!(said(TABLE).is_ok() && said(&format!("\n{}\n\n", TABLE.replace('\n', "\r\n"))).is_ok());
        for (from, to, message) in [
            ("2 3 2 5 2 ", "2 3 2 5", "line 1: 4 numbers instead of 5"),
            ("2 3 2 5 2 ", "2 3 two 5 2", "line 1: distances `two`, but it is a whole number from 1 to 65535"),
            ("2 3 2 5 2 ", "0 3 2 5 2", "line 1: sensors `0`, but it is a whole number from 1 to 65535"),
            ("2 3 2 5 2 ", "2 3 2 5 0", "line 1: step `0`, but it is a whole number from 1 to 65535"),
            ("2 3 2 5 2 ", "2 3 2 -5 2", "line 1: first distance `-5`, but it is a whole number from 0 to 65535"),
            ("2 3 2 5 2 ", "60000 60000 60000 5 2", "line 1: 216000000000000 readings, at most 117964800 are taken"),
            ("2 3 2 5 2 ", "2 4 2 5 2 ", "line 6: a reading of TURN, but they are whole numbers from 0 to 1023"),
            ("2 3 2 5 2 ", "2 2 2 5 2 ", "line 5: `5 6` instead of `TURN 1`"),
            ("2 3 2 5 2 ", "2 3 3 5 2 ", "line 10: `END` instead of `TURN 2`"),
            ("2 3 2 5 2 ", "2 3 1 5 2 ", "line 6: `TURN 1` instead of `END`"),
            ("2 3 2 5 2 ", "3 3 2 5 2 ", "line 3: 2 numbers instead of 3"),
            ("TURN 1", "TURN 2", "line 6: `TURN 2` instead of `TURN 1`"),
            ("TURN 1", "TURN 1 2", "line 6: `TURN 1 2` instead of `TURN 1`"),
            ("11 12", "11 1024", "line 9: a reading of 1024, but they are whole numbers from 0 to 1023"),
            ("11 12", "11 -1", "line 9: a reading of -1, but they are whole numbers from 0 to 1023"),
            ("11 12", "11 1.5", "line 9: a reading of 1.5, but they are whole numbers from 0 to 1023"),
            ("11 12\nEND", "11", "line 9: 1 numbers instead of 2"),
            ("\nEND", "", "line 10: the text ends where END should follow"),
            ("11 12\nEND", "", "line 9: the text ends where readings should follow"),
            ("END", "END\n\nmore", "line 12: `more` after `END`"),
        ] {
            assert_eq!(said(&TABLE.replace(from, to)), Err(message.into()));
        }
        let missing = "line 1: the text ends where the sizes `sensors angles distances first step` should follow";
        assert_eq!(said(""), Err(missing.into()));
    }

    #[test]
    fn rows_are_found_as_documented() {
        let table = InfraredTable::parse(TABLE).expect("a table");
        let at = |distance, bearing| table.response(distance, bearing).map(|row| row[0] * 1024.0);
        let third = 2.0 * core::f32::consts::PI / 3.0;
        for (distance, row) in [(-1.0, 0.0), (0.0, 0.0), (0.0069, 0.0), (0.0071, 6.0), (0.0089, 6.0)] {
            assert_eq!(at(distance, -0.1), Some(1.0 + row), "{distance}");
            assert_eq!(at(distance, -1.1 * third), Some(3.0 + row), "{distance}");
            assert_eq!(at(distance, -2.1 * third), Some(5.0 + row), "{distance}");
            assert_eq!(at(distance, 0.1), Some(5.0 + row), "{distance}");
            assert_eq!(at(distance, 1e-12), Some(5.0 + row), "{distance}");
            assert_eq!(at(distance, 0.0), Some(1.0 + row), "{distance}");
        }
        for (distance, bearing) in [(0.0091, 0.0), (f32::INFINITY, 0.0), (f32::NAN, 0.0), (0.0, f32::NAN)] {
            assert_eq!(table.response(distance, bearing), None);
        }
        assert!((table.range() - 0.009).abs() < 1e-9);
        assert_eq!(table.sensors(), 2);
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "[0-9 TURNED\n.-]{0,80}", cut in 0_usize..60, change in 0_usize..60, with in "[0-9 A\n-]") {
            let _ = InfraredTable::parse(&text);
            let _ = InfraredTable::parse(&TABLE[..cut.min(TABLE.len())]);
            let mut changed = TABLE.to_string();
            let change = change.min(TABLE.len() - 1);
            changed.replace_range(change..=change, &with);
            let _ = InfraredTable::parse(&changed);
        }

        #[test]
        fn every_reading_is_one_of_the_table(distance in -1.0_f32..1.0, bearing in -100.0_f32..100.0) {
            let table = InfraredTable::parse(TABLE).expect("a table");
            let row = table.response(distance, bearing);
            prop_assert_eq!(row.is_some(), distance < 0.009);
            prop_assert!(row.is_none_or(|row| row.len() == 2 && row[1] - row[0] == 1.0 / 1024.0));
        }
    }
}
