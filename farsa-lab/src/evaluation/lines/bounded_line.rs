//! Lines of an input, each of a bounded length.

use std::io::{self, BufRead};

/// A line of the input.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum BoundedLine {
    /// Its bytes without the end of the line.
    Whole(Vec<u8>),
    /// A line beyond the limit. It was skipped.
    TooLong,
}

/// Reads the next line of at most `limit` bytes. Returns none at the end. The last line needs no line end.
///
/// # Errors
/// Errors of the input.
pub(super) fn next_line(input: &mut impl BufRead, limit: usize) -> io::Result<Option<BoundedLine>> {
    let (mut line, mut read, mut too_long) = (Vec::new(), false, false);
    loop {
        let chunk = match input.fill_buf() {
            Ok(chunk) => chunk,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        let end = chunk.iter().position(|byte| *byte == b'\n');
        let part = &chunk[..end.unwrap_or(chunk.len())];
        too_long |= line.len() + part.len() > limit;
        if !too_long {
            line.extend_from_slice(part);
        }
        let used = end.map_or(chunk.len(), |end| end + 1);
        read |= used > 0;
        input.consume(used);
        if end.is_some() || used == 0 {
            let found = if too_long { BoundedLine::TooLong } else { BoundedLine::Whole(line) };
            return Ok(read.then_some(found));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    #[test]
    fn lines_are_those_of_the_text_and_long_ones_are_passed_over() {
        let text = "one\n\nfour and more\nabcd\nlast";
        let whole = |text: &str| BoundedLine::Whole(text.into());
        for capacity in [1, 2, 3, 5, 100] {
            let mut input = BufReader::with_capacity(capacity, text.as_bytes());
            let mut all = Vec::new();
            while let Some(line) = next_line(&mut input, 4).unwrap() {
                all.push(line);
            }
            assert_eq!(all, [whole("one"), whole(""), BoundedLine::TooLong, whole("abcd"), whole("last")]);
        }
        assert_eq!(next_line(&mut &b""[..], 4).unwrap(), None);
        assert_eq!(next_line(&mut &b"12345"[..], 4).unwrap(), Some(BoundedLine::TooLong));
    }
}
