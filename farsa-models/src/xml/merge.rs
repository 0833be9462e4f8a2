//! A tree as one text, with some elements changed.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::xml::tree::Element;
use crate::xml::write::{Lines, quoted};

/// Changes of elements, by their numbers.
#[derive(Default)]
pub(crate) struct Changes {
    /// Text instead of an element. It may be empty.
    pub(crate) replaced: BTreeMap<usize, String>,
    /// Text before the children of an element.
    pub(crate) added: BTreeMap<usize, String>,
    /// All attributes of an element.
    pub(crate) attributes: BTreeMap<usize, Vec<(String, String)>>,
}

/// A step of the writer, which has no recursion because elements may be nested deeply.
enum Step<'t> {
    Open(Element<'t>),
    Close(&'t str),
}

/// Writes an element with everything in it. Names with a prefix are left out, because the text does not declare their namespaces.
pub(crate) fn merged(root: Element<'_>, changes: &Changes) -> String {
    let mut out = Lines::default();
    let mut steps = vec![Step::Open(root)];
    while let Some(step) = steps.pop() {
        let element = match step {
            Step::Close(tag) => {
                out.close(tag);
                continue;
            }
            Step::Open(element) => element,
        };
        let number = element.index();
        if let Some(text) = changes.replaced.get(&number) {
            text.lines().for_each(|line| out.line(line));
            continue;
        }
        if element.tag().contains(':') {
            continue;
        }
        let mut head = element.tag().to_owned();
        let attributes = changes.attributes.get(&number).map_or(element.attributes(), Vec::as_slice);
        for (name, value) in attributes.iter().filter(|(name, _)| !name.contains(':')) {
            // Writing into a string cannot fail.
            let _ = write!(head, " {name}={}", quoted(value));
        }
        let added = changes.added.get(&number);
        let children: Vec<_> = element.children().collect();
        if children.is_empty() && added.is_none() {
            out.line(&format!("<{head}/>"));
            continue;
        }
        out.open(&head);
        added.into_iter().flat_map(|text| text.lines()).for_each(|line| out.line(line));
        steps.push(Step::Close(element.tag()));
        steps.extend(children.into_iter().rev().map(Step::Open));
    }
    out.text
}
