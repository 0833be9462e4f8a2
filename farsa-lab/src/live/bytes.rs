//! Bytes in JSON.

use std::fmt::Write as _;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Bytes written as two hexadecimal digits each. Repetitions remain visible to the compression of a page.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Bytes(pub(crate) Vec<u8>);

impl Bytes {
    /// Concatenates numbers, little-endian.
    pub(crate) fn from_floats<'f>(floats: impl IntoIterator<Item = &'f f32>) -> Self {
        Self(floats.into_iter().flat_map(|x| x.to_le_bytes()).collect())
    }

    /// Converts the bytes to numbers. Trailing bytes are ignored.
    pub(crate) fn floats(&self) -> Vec<f32> {
        self.0.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
    }

    /// Parses hexadecimal digits.
    fn from_digits(text: &str) -> Option<Self> {
        let (pairs, rest) = text.as_bytes().as_chunks::<2>();
        let digit = |letter: u8| char::from(letter).to_digit(16);
        let byte = |[high, low]: &[u8; 2]| Some((16 * digit(*high)? + digit(*low)?) as u8);
        let bytes: Option<Vec<u8>> = pairs.iter().map(byte).collect();
        bytes.filter(|_| rest.is_empty()).map(Self)
    }
}

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut text = String::with_capacity(2 * self.0.len());
        // Writing into a string cannot fail.
        self.0.iter().for_each(|byte| write!(text, "{byte:02x}").unwrap_or_default());
        serializer.serialize_str(&text)
    }
}

impl<'de> Deserialize<'de> for Bytes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::from_digits(&text).ok_or_else(|| D::Error::custom("bytes are two digits from 0 to f each"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_round_trip_and_other_text_is_refused() {
        let bytes = Bytes((0..=255).collect());
        let text = serde_json::to_string(&bytes).unwrap();
        assert!(text.starts_with("\"000102") && text.ends_with("fdfeff\""));
        assert_eq!(serde_json::from_str::<Bytes>(&text).unwrap(), bytes);
        for wrong in ["\"0\"", "\"0g\"", "\"+1\"", "\"\u{e9}\"", "1"] {
            assert!(serde_json::from_str::<Bytes>(wrong).is_err(), "{wrong}");
        }
        let floats = [0.5, -1e-40, f32::MAX];
        assert_eq!(Bytes::from_floats(&floats).floats(), floats);
    }
}
