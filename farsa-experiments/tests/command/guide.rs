//! The guide to test protocols shows what its commands print.

use std::fs;
use std::path::Path;

use crate::tool::{farsa, ok, scratch};

/// The fenced blocks of a language in a text.
fn blocks<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let fence = format!("```{language}\n");
    let pieces = text.split(fence.as_str()).skip(1);
    pieces.filter_map(|piece| piece.split_once("```").map(|(block, _)| block)).collect()
}

#[test]
fn protocols_print_what_their_guide_shows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let guide = fs::read_to_string(root.join("docs/guide/protocols.md")).expect("the guide");
    let [commands] = blocks(&guide, "sh")[..] else { panic!("one block of commands in {guide}") };
    let here = scratch("protocols-guide");
    let mut printed = String::new();
    for line in commands.lines() {
        let words = line.strip_prefix("farsa ").expect("a command of ours");
        // The reader stands in the clone; what is written here belongs elsewhere.
        for file in words.split(' ').filter(|word| root.join(word).is_file()) {
            let copy = here.join(file);
            fs::create_dir_all(copy.parent().expect("a folder")).expect("a folder");
            fs::copy(root.join(file), copy).expect("a copy");
        }
        printed = ok(farsa(), &here, words);
    }
    let shown = blocks(&guide, "text").into_iter().find(|block| block.starts_with("lesions: "));
    assert_eq!(shown, Some(printed.as_str()));
}
