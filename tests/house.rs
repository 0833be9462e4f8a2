//! The size of public interfaces: names at a crate's root, one path for each name, variants of an error.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The libraries of the workspace.
fn libraries() -> Vec<String> {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).expect("a manifest");
    let members = manifest.lines().find_map(|line| line.strip_prefix("members = [")).expect("members in one line");
    members.split('"').filter(|name| name.starts_with("farsa-")).map(String::from).collect()
}

/// The last names of the tree of a `use`.
fn leaves(tree: &str, names: &mut BTreeSet<String>) {
    let tree = tree.trim();
    if let Some(open) = tree.find('{') {
        let inner = &tree[open + 1..tree.rfind('}').unwrap_or(tree.len())];
        let (mut depth, mut start) = (0, 0);
        for (at, c) in inner.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    leaves(&inner[start..at], names);
                    start = at + 1;
                }
                _ => {}
            }
        }
        leaves(&inner[start..], names);
    } else if !tree.is_empty() {
        let name = tree.rsplit("::").next().unwrap_or(tree);
        names.insert(name.rsplit(" as ").next().unwrap_or(name).trim().to_owned());
    }
}

/// The names that a module makes public by `pub use` or by definition, except modules.
fn public_names(file: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(file).unwrap_or_default();
    let mut names = BTreeSet::new();
    let mut statement: Option<String> = None;
    let mut hidden = false;
    for line in text.lines() {
        // Statements at the margin are those of the module itself.
        if let Some(rest) = line.strip_prefix("pub use ") {
            statement = Some(String::from(rest));
        } else if let Some(open) = &mut statement {
            open.push_str(line.trim());
        }
        if let Some(tree) = statement.as_deref().and_then(|tree| tree.split_once(';')) {
            if !hidden {
                leaves(tree.0, &mut names);
            }
            statement = None;
        }
        for kind in [
            "pub fn ",
            "pub const fn ",
            "pub struct ",
            "pub enum ",
            "pub trait ",
            "pub type ",
            "pub const ",
            "pub static ",
        ] {
            if let Some(rest) = line.strip_prefix(kind)
                && !rest.starts_with("fn ")
            {
                names.insert(rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect());
            }
        }
        hidden = line == "#[doc(hidden)]";
    }
    names
}

/// The file of a module next to `lib.rs`.
fn module_file(source: &Path, name: &str) -> PathBuf {
    let flat = source.join(format!("{name}.rs"));
    if flat.exists() { flat } else { source.join(name).join("mod.rs") }
}

#[test]
fn few_names_at_the_root_and_one_path_for_each() {
    let mut faults = Vec::new();
    for library in libraries() {
        let source = root().join(&library).join("src");
        let file = source.join("lib.rs");
        let names = public_names(&file);
        println!("{library}: {} names at the root", names.len());
        if names.len() > 25 {
            faults.push(format!("{library} has {} names at its root, at most 25", names.len()));
        }
        let text = fs::read_to_string(&file).expect("a library");
        let modules = text.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
        for module in modules.filter(|module| *module != "prelude") {
            for name in public_names(&module_file(&source, module)).intersection(&names) {
                faults.push(format!("{library}: {name} and {module}::{name}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn sources(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

#[test]
fn errors_are_grouped() {
    let mut faults = Vec::new();
    let mut count = 0;
    for library in libraries() {
        let mut files = Vec::new();
        sources(&root().join(&library).join("src"), &mut files);
        for file in files {
            let text = fs::read_to_string(&file).expect("a source");
            let mut open: Option<(&str, usize)> = None;
            for line in text.lines() {
                if let Some(rest) = line.strip_prefix("pub enum ") {
                    let name = rest.split([' ', '<']).next().unwrap_or(rest);
                    open = name.ends_with("Error").then_some((name, 0));
                } else if let Some((name, variants)) = &mut open {
                    if line == "}" {
                        println!("{library}: {name} has {variants} variants");
                        count += 1;
                        if *variants > 8 {
                            faults.push(format!("{library}: {name} has {variants} variants, at most 8"));
                        }
                        open = None;
                    } else if line.strip_prefix("    ").is_some_and(|text| text.starts_with(char::is_uppercase)) {
                        *variants += 1;
                    }
                }
            }
        }
    }
    assert!(count >= 8, "only {count} errors");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
