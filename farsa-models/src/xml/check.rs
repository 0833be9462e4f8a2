//! A look at XML before it is parsed: what is too large, too deep or multiplies itself gets no further.

use crate::error::{ReadError, SourceLocation};
use crate::options::Limits;

/// Refuses text with more or deeper elements or more attributes than the limits allow, or with a document type, which
/// alone can define entities.
///
/// Makes one pass over the bytes. It finds the beginnings and ends of tags and trusts nothing else. The parser checks
/// the syntax. `elements` is the number of elements in earlier files of the model.
pub(crate) fn check(file: &str, text: &str, elements: &mut usize, limits: &Limits) -> Result<(), ReadError> {
    let bytes = text.as_bytes();
    let mut at = 0;
    let (mut line, mut counted) = (1, 0);
    let mut depth = 0_usize;
    let (mut namespaces, mut attributes) = (0, 0);
    while let Some(found) = bytes[at..].iter().position(|byte| *byte == b'<') {
        at += found;
        line += bytes[counted..at].split(|byte| *byte == b'\n').count() - 1;
        counted = at;
        let place = || SourceLocation { file: file.into(), line };
        let too_much = |what, limit| Err(ReadError::TooMuch { place: place(), what, limit });
        let rest = &bytes[at..];
        if let Some(end) = [(&b"<!--"[..], &b"-->"[..]), (b"<![CDATA[", b"]]>"), (b"<?", b"?>")]
            .iter()
            .find_map(|(open, close)| rest.starts_with(open).then(|| find(rest, close, open.len())))
        {
            at += end;
            continue;
        }
        if rest.starts_with(b"<!") {
            let why = "a document type; models have none, and entities are not read".to_string();
            return Err(ReadError::Malformed { place: place(), why });
        }
        let tag = Tag::from_bytes(rest);
        at += tag.length;
        if rest.starts_with(b"</") {
            depth = depth.saturating_sub(1);
            continue;
        }
        *elements += 1;
        namespaces += tag.namespaces;
        attributes += tag.attributes;
        if *elements > limits.elements {
            return too_much("elements", limits.elements);
        }
        if tag.attributes > limits.attributes {
            return too_much("attributes of one element", limits.attributes);
        }
        if attributes > limits.elements.saturating_mul(8) {
            return too_much("attributes", limits.elements.saturating_mul(8));
        }
        if namespaces > limits.attributes {
            return too_much("name spaces", limits.attributes);
        }
        if !tag.empty {
            depth += 1;
            if depth > limits.depth {
                return too_much("elements within each other", limits.depth);
            }
        }
    }
    Ok(())
}

/// Where `close` ends, looked for from `from` on, or the end of the bytes.
fn find(bytes: &[u8], close: &[u8], from: usize) -> usize {
    let rest = bytes.get(from..).unwrap_or_default();
    rest.windows(close.len()).position(|window| window == close).map_or(bytes.len(), |at| from + at + close.len())
}

/// Outline of a tag.
struct Tag {
    length: usize,
    attributes: usize,
    namespaces: usize,
    empty: bool,
}

impl Tag {
    /// Reads the tag that the bytes begin with, to its `>` outside of quotes or to the end.
    fn from_bytes(bytes: &[u8]) -> Self {
        let mut tag = Self { length: bytes.len(), attributes: 0, namespaces: 0, empty: false };
        let mut quote = None;
        for (i, byte) in bytes.iter().enumerate() {
            match (quote, byte) {
                (Some(open), byte) => quote = Some(open).filter(|open| *open != byte),
                (None, b'"' | b'\'') => quote = Some(byte),
                (None, b'=') => tag.attributes += 1,
                (None, b'x') if bytes[i..].starts_with(b"xmlns") => tag.namespaces += 1,
                (None, b'>') => {
                    tag.empty = i > 0 && bytes[i - 1] == b'/';
                    tag.length = i + 1;
                    break;
                }
                (None, _) => {}
            }
        }
        tag
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> Option<ReadError> {
        let limits = Limits { elements: 100, depth: 10, attributes: 5, ..Limits::default() };
        check("m.xml", text, &mut 0, &limits).err()
    }

    #[test]
    fn what_is_within_limits_passes() {
        let deep = format!("<?xml a='<'?>{}<b a=\"<>\"/>{}<!-- <<<< -->", "<a>".repeat(10), "</a>".repeat(10));
        assert_eq!(refused(&deep), None);
        assert_eq!(refused(&format!("<a>{}</a>", "<![CDATA[<x><y>]]><b/>".repeat(99))), None);
        for broken in ["<", "<a", "<a b='", "<!--", "</", "<?", "", "<![CDATA[", "</a></a>"] {
            assert_eq!(refused(broken), None, "the parser's to refuse: {broken}");
        }
    }

    #[test]
    fn what_is_not_is_refused_with_its_line() {
        let of = |line| SourceLocation { file: "m.xml".into(), line };
        let deep = format!("\n{}", "<a>\n".repeat(11));
        let expected = ReadError::TooMuch { place: of(12), what: "elements within each other", limit: 10 };
        assert_eq!(refused(&deep), Some(expected));
        let many = "<a/>\n".repeat(101);
        assert_eq!(refused(&many), Some(ReadError::TooMuch { place: of(101), what: "elements", limit: 100 }));
        let wide = "<a b='1' c='2' d='3' e='4' f='5' g='6'/>";
        let expected = ReadError::TooMuch { place: of(1), what: "attributes of one element", limit: 5 };
        assert_eq!(refused(wide), Some(expected));
        let spaces = "<a xmlns:b='c'>".repeat(6);
        assert_eq!(refused(&spaces), Some(ReadError::TooMuch { place: of(1), what: "name spaces", limit: 5 }));
        for bomb in ["\n<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>", "\n<!doctype>", "\n<!ENTITY>"] {
            assert!(matches!(refused(bomb), Some(ReadError::Malformed { place, .. }) if place == of(2)), "{bomb}");
        }
    }
}
