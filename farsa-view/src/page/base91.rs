//! Bytes as text that is a quarter longer than they are; base64 is a third longer, which a page of two megabytes feels.

/// Four bytes as five letters, the highest first: those from `(` on, without the two that JSON and HTML would write longer.
///
/// What is missing of the last four bytes is 0.
pub(crate) fn base85(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(4) * 5);
    for four in bytes.chunks(4) {
        let mut padded = [0; 4];
        padded.iter_mut().zip(four).for_each(|(to, byte)| *to = *byte);
        let mut rest = u32::from_be_bytes(padded);
        let mut letters = [0; 5];
        for letter in letters.iter_mut().rev() {
            *letter = match b'(' + (rest % 85) as u8 {
                b'<' => b'}',
                b'\\' => b'~',
                plain => plain,
            };
            rest /= 85;
        }
        text.extend(letters.map(char::from));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the viewer reads it.
    fn decoded(text: &str, length: usize) -> Vec<u8> {
        let value = |letter: u8| match letter {
            b'}' => u64::from(b'<' - b'('),
            b'~' => u64::from(b'\\' - b'('),
            plain => u64::from(plain - b'('),
        };
        let fives = text.as_bytes().chunks(5).map(|five| five.iter().fold(0, |all, letter| 85 * all + value(*letter)));
        let mut bytes: Vec<u8> = fives.flat_map(|word| u32::try_from(word).unwrap().to_be_bytes()).collect();
        bytes.truncate(length);
        bytes
    }

    #[test]
    fn every_byte_comes_back() {
        let bytes: Vec<u8> = (0..10_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
        for length in [0, 1, 2, 3, 4, 5, 9_999, 10_000] {
            let text = base85(&bytes[..length]);
            assert_eq!(text.len(), length.div_ceil(4) * 5);
            assert_eq!(decoded(&text, length), &bytes[..length]);
            assert_eq!(serde_json::to_string(&text).unwrap(), format!("\"{text}\""));
            assert!(!text.contains('<'));
        }
        assert_eq!((base85(&[0; 4]), base85(&[255; 4])), ("(((((".into(), "z?^4(".into()));
    }
}
