//! What the writers of model files share: nested lines, numbers and names in XML.

use std::fmt::Write as _;

use farsa_body::Robot;

/// Lines of XML, each as far in as it is nested.
#[derive(Default)]
pub(crate) struct Lines {
    pub(crate) text: String,
    depth: usize,
}

impl Lines {
    /// One whole element or comment.
    pub(crate) fn line(&mut self, line: &str) {
        // Writing into a string cannot fail.
        let _ = writeln!(self.text, "{:1$}{line}", "", 2 * self.depth);
    }

    /// An element, name and attributes, that others follow in.
    pub(crate) fn open(&mut self, head: &str) {
        self.line(&format!("<{head}>"));
        self.depth += 1;
    }

    /// The end of the element of this name.
    pub(crate) fn close(&mut self, name: &str) {
        self.depth = self.depth.saturating_sub(1);
        self.line(&format!("</{name}>"));
    }
}

/// Numbers with a space between, each the shortest that reads back the same; zeros without sign.
pub(crate) fn numbers(of: &[f64]) -> String {
    let mut text = String::new();
    for (i, x) in of.iter().enumerate() {
        let _ = write!(text, "{}{:?}", if i == 0 { "" } else { " " }, x + 0.0);
    }
    text
}

/// A name as the value of an attribute, quotes included.
pub(crate) fn quoted(name: &str) -> String {
    let mut text = String::from("\"");
    for c in name.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            // Line breaks and tabs in attributes are read as spaces otherwise.
            c if c.is_control() => {
                let _ = write!(text, "&#{};", u32::from(c));
            }
            c => text.push(c),
        }
    }
    text.push('"');
    text
}

/// `wanted`, or with as many `_` behind as it takes to be none of the names.
pub(crate) fn unused<'a>(wanted: &str, names: &(impl Iterator<Item = &'a str> + Clone)) -> String {
    let mut name = wanted.to_owned();
    while names.clone().any(|other| other == name) {
        name.push('_');
    }
    name
}

/// The segments' names, changed where one is `reserved` by the format.
pub(crate) fn segment_names(robot: &Robot, reserved: &str) -> Vec<String> {
    let all = robot.segments.iter().map(|segment| segment.name.as_str());
    let name = |own: &str| if own == reserved { unused(own, &all) } else { own.to_owned() };
    all.clone().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_safe_in_attributes() {
        assert_eq!(quoted("a<b> & \"c\"\n"), "\"a&lt;b&gt; &amp; &quot;c&quot;&#10;\"");
        assert_eq!(numbers(&[-0.0, 1.0, 1e-7, 0.1]), "0.0 1.0 1e-7 0.1");
        assert_eq!(unused("world", &["world", "world_"].into_iter()), "world__");
    }
}
