//! The imports between the files of each crate form no circle between folders, and within a folder only the listed ones.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Permitted circles within a folder, by the names of their files.
const KNOWN: &[&[&str]] = &[];

/// A file of a crate: its module path, the names that it imports as module paths, and its re-exports.
#[derive(Default)]
struct Source {
    file: PathBuf,
    /// Paths from the crate's root.
    uses: Vec<Vec<String>>,
    /// The last segment or alias of every re-export, with its path. `*` is a whole module.
    exports: Vec<(String, Vec<String>)>,
}

/// The text without comments and without what is compiled for tests only.
fn code(text: &str) -> String {
    let mut lines = Vec::new();
    let mut skipping: Option<usize> = None;
    let mut test_next = false;
    for line in text.lines() {
        let plain = line.split("//").next().unwrap_or(line);
        let indent = line.len() - line.trim_start().len();
        if let Some(from) = skipping {
            if indent == from && plain.trim_start().starts_with('}') {
                skipping = None;
            }
            continue;
        }
        if plain.trim() == "#[cfg(test)]" {
            test_next = true;
            continue;
        }
        if test_next && !plain.trim().is_empty() {
            test_next = plain.trim_start().starts_with("#[");
            if plain.trim_end().ends_with('{') {
                skipping = Some(indent);
            }
            continue;
        }
        lines.push(plain);
    }
    lines.join("\n")
}

/// The leaves of a `use` tree as paths, each with its local name.
fn leaves(tree: &str, prefix: &[String], found: &mut Vec<(String, Vec<String>)>) {
    let tree = tree.trim();
    if let Some(open) = tree.find('{') {
        let mut path = prefix.to_vec();
        path.extend(tree[..open].split("::").map(str::trim).filter(|part| !part.is_empty()).map(String::from));
        let inner = &tree[open + 1..tree.rfind('}').unwrap_or(tree.len())];
        let (mut depth, mut start) = (0, 0);
        for (at, c) in inner.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    leaves(&inner[start..at], &path, found);
                    start = at + 1;
                }
                _ => {}
            }
        }
        leaves(&inner[start..], &path, found);
        return;
    }
    if tree.is_empty() {
        return;
    }
    let (name, alias) = tree.split_once(" as ").unwrap_or((tree, ""));
    let mut path = prefix.to_vec();
    path.extend(name.split("::").map(|part| part.trim().to_string()).filter(|part| part != "self"));
    let known = if alias.is_empty() { path.last().cloned().unwrap_or_default() } else { alias.trim().into() };
    found.push((known, path));
}

/// A path as written in a module, from the crate's root, or `None` outside the crate.
fn from_root(path: &[String], module: &[String], children: &BTreeSet<String>) -> Option<Vec<String>> {
    let mut path = path.to_vec();
    match path.first()?.as_str() {
        "crate" => {
            path.remove(0);
            Some(path)
        }
        "self" => {
            path.remove(0);
            Some([module.to_vec(), path].concat())
        }
        "super" => {
            let mut base = module.to_vec();
            while path.first().is_some_and(|part| part == "super") {
                path.remove(0);
                base.pop();
            }
            Some([base, path].concat())
        }
        first if children.contains(first) => Some([module.to_vec(), path].concat()),
        _ => None,
    }
}

/// Every module of a crate, by its path.
fn modules(src: &Path) -> BTreeMap<Vec<String>, Source> {
    let mut found = BTreeMap::new();
    let mut folders = vec![(src.to_path_buf(), Vec::new())];
    while let Some((folder, module)) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            let name = entry.file_stem().expect("a name").to_string_lossy().into_owned();
            let deeper = |name: String| [module.clone(), vec![name]].concat();
            if entry.is_dir() {
                folders.push((entry, deeper(name)));
            } else if entry.extension().is_some_and(|extension| extension == "rs") && name != "main" {
                let own = if name == "lib" || name == "mod" { module.clone() } else { deeper(name) };
                found.insert(own, Source { file: entry, ..Source::default() });
            }
        }
    }
    let all: BTreeSet<Vec<String>> = found.keys().cloned().collect();
    for (module, source) in &mut found {
        let text = code(&fs::read_to_string(&source.file).expect("a source"));
        let children = all.iter().filter(|other| other.len() == module.len() + 1 && other.starts_with(module));
        let children: BTreeSet<String> = children.filter_map(|child| child.last().cloned()).collect();
        for statement in text.split(';').map(str::trim) {
            let Some(at) = statement.rfind("use ") else { continue };
            let before = statement[..at].trim_end();
            if !(before.is_empty() || before.ends_with(['\n', '}', ']', ')']) || before.ends_with("pub")) {
                continue;
            }
            let public = before.ends_with("pub") || before.ends_with(')') && before.contains("pub(");
            let mut of_tree = Vec::new();
            leaves(&statement[at + 4..].replace('\n', " "), &[], &mut of_tree);
            for (name, path) in of_tree {
                if let Some(path) = from_root(&path, module, &children) {
                    if public {
                        source.exports.push((name, path.clone()));
                    } else {
                        source.uses.push(path);
                    }
                }
            }
        }
        // Paths within the code.
        for (at, _) in text.match_indices("crate::") {
            let rest: String =
                text[at..].chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
            let path: Vec<String> =
                rest.split("::").skip(1).filter(|part| !part.is_empty()).map(String::from).collect();
            source.uses.push(path);
        }
    }
    found
}

/// The module that defines a path, through re-exports.
fn defined_in(path: &[String], modules: &BTreeMap<Vec<String>, Source>, depth: usize) -> Option<Vec<String>> {
    let length = (0..=path.len()).rev().find(|length| modules.contains_key(&path[..*length]))?;
    let (module, rest) = path.split_at(length);
    let Some(name) = rest.first() else { return Some(module.to_vec()) };
    if depth < 8 {
        let exports = &modules[module].exports;
        if let Some((_, to)) = exports.iter().find(|(known, to)| known == name && to != path) {
            return defined_in(to, modules, depth + 1);
        }
    }
    Some(module.to_vec())
}

/// The groups of modules that reach each other.
fn circles(arrows: &BTreeMap<Vec<String>, BTreeSet<Vec<String>>>) -> Vec<Vec<Vec<String>>> {
    let reached = |from: &Vec<String>| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(at) = open.pop() {
            for to in arrows.get(&at).into_iter().flatten() {
                if seen.insert(to.clone()) {
                    open.push(to.clone());
                }
            }
        }
        seen
    };
    let reach: BTreeMap<_, _> = arrows.keys().map(|module| (module.clone(), reached(module))).collect();
    let mut found: Vec<Vec<Vec<String>>> = Vec::new();
    for (module, seen) in &reach {
        if seen.contains(module) && !found.iter().any(|circle| circle.contains(module)) {
            let back = |other: &&Vec<String>| reach.get(*other).is_some_and(|seen| seen.contains(module));
            found.push(seen.iter().filter(back).cloned().collect());
        }
    }
    found
}

/// The circles of a crate in words, and whether they join folders.
fn of_crate(src: &Path) -> Vec<(bool, Vec<String>)> {
    let modules = modules(src);
    let mut arrows: BTreeMap<Vec<String>, BTreeSet<Vec<String>>> = BTreeMap::new();
    for (module, source) in &modules {
        let to = source.uses.iter().filter_map(|path| defined_in(path, &modules, 0));
        // The root and the folders' `mod.rs` represent their re-exports.
        let to = to.filter(|to| to != module && !to.is_empty());
        arrows.insert(module.clone(), to.collect());
    }
    let folder = |module: &Vec<String>| modules[module].file.parent().map(Path::to_path_buf);
    let words = |circle: Vec<Vec<String>>| {
        let mut folders: Vec<_> = circle.iter().map(folder).collect();
        folders.dedup();
        (folders.len() > 1, circle.iter().map(|module| module.join("::")).collect())
    };
    circles(&arrows).into_iter().map(words).collect()
}

#[test]
fn imports_run_in_no_circle_between_folders() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut crates: Vec<PathBuf> =
        fs::read_dir(root).expect("the repository").map(|e| e.expect("an entry").path()).collect();
    crates.retain(|path| path.join("src/lib.rs").is_file() && path.join("Cargo.toml").is_file());
    crates.sort();
    assert!(crates.len() >= 6, "{crates:?}");
    let mut wrong = Vec::new();
    for path in crates {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        for (joins, circle) in of_crate(&path.join("src")) {
            println!("{name}: {}", circle.join(", "));
            let known = KNOWN.iter().any(|known| known.iter().eq(circle.iter()));
            if joins || !known {
                wrong.push(format!("{name}: {}", circle.join(", ")));
            }
        }
    }
    assert!(wrong.is_empty(), "circles of imports:\n{}", wrong.join("\n"));
}

#[test]
fn a_circle_is_seen_through_re_exports_and_not_in_tests() {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("imports");
    let _ = fs::remove_dir_all(&place);
    fs::create_dir_all(place.join("far")).expect("a place");
    let write = |name: &str, text: &str| fs::write(place.join(name), text).expect("a file");
    write("lib.rs", "mod near;\nmod far;\npub use far::deep::Deep;\n");
    write("near.rs", "use crate::Deep;\npub struct Near(Deep);\n");
    write("far/mod.rs", "mod deep;\npub(crate) use deep::Deep;\n");
    write("far/deep.rs", "pub struct Deep;\n#[cfg(test)]\nmod tests {\n    use crate::near::Near;\n}\n");
    assert!(of_crate(&place).is_empty());
    write("far/deep.rs", "use crate::{near::Near as Other, std};\npub struct Deep(Other);\n");
    assert_eq!(of_crate(&place), [(true, vec!["far::deep".to_string(), "near".to_string()])]);
}
