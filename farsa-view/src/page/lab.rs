//! The page of `farsa lab`: markup, style and scripts as separate files, so that it needs no inline script.

/// Types of the files.
const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const JS: &str = "text/javascript; charset=utf-8";

/// Files by their addresses.
const FILES: &[(&str, &str, &str)] = &[
    ("/", HTML, include_str!("lab/lab.html")),
    ("/lab/palette.css", CSS, include_str!("viewer/palette.css")),
    ("/lab/lab.css", CSS, include_str!("lab/lab.css")),
    ("/lab/main.js", JS, include_str!("lab/main.js")),
    ("/lab/parts.js", JS, include_str!("lab/parts.js")),
    ("/lab/curve.js", JS, include_str!("lab/curve.js")),
    ("/lab/start.js", JS, include_str!("lab/start.js")),
    ("/lab/experiment.js", JS, include_str!("lab/experiment.js")),
    ("/lab/settings.js", JS, include_str!("lab/settings.js")),
    ("/lab/editor.js", JS, include_str!("lab/editor.js")),
    ("/lab/run.js", JS, include_str!("lab/run.js")),
    ("/lab/trial.js", JS, include_str!("lab/trial.js")),
];

/// The page of a laboratory in the browser. A server of [`farsa-lab`](https://docs.rs/farsa-lab) answers its requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LabPage;

impl LabPage {
    /// Returns the type and the text of the file at an address.
    ///
    /// If there is no such file, this returns `None`.
    pub fn file(address: &str) -> Option<(&'static str, &'static str)> {
        FILES.iter().find(|(path, ..)| *path == address).map(|&(_, kind, text)| (kind, text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_needs_no_other_file_and_builds_no_markup() {
        for (path, _, text) in FILES {
            for quoted in text.split('"').skip(1).step_by(2).filter(|quoted| quoted.starts_with("/lab/")) {
                assert!(LabPage::file(quoted).is_some(), "{path}: {quoted}");
            }
            for import in text.split("from \"./").skip(1).filter_map(|rest| rest.split_once('"')) {
                assert!(LabPage::file(&format!("/lab/{}", import.0)).is_some(), "{path}: {}", import.0);
            }
            for forbidden in
                ["innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "style=", "://"]
            {
                let text = text.replace("http://www.w3.org/2000/svg", "");
                assert!(!text.contains(forbidden), "{path}: {forbidden}");
            }
        }
        assert_eq!(LabPage::file("/lab/../lab.rs"), None);
    }
}
