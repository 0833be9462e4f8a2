//! The guide to test protocols shows what its commands print.

use std::fs;
use std::path::Path;

use crate::tool::{Running, Said, command, farsa, scratch};

/// The fenced blocks of a language in a text.
fn blocks<'t>(text: &'t str, language: &str) -> Vec<&'t str> {
    let fence = format!("```{language}\n");
    let pieces = text.split(fence.as_str()).skip(1);
    pieces.filter_map(|piece| piece.split_once("```").map(|(block, _)| block)).collect()
}

/// The words of a command, as a shell divides them.
fn words(line: &str) -> Vec<&str> {
    let quoted = line.split('"').enumerate();
    let words = quoted.flat_map(|(number, piece)| {
        if number % 2 == 1 { vec![piece] } else { piece.split(' ').filter(|word| !word.is_empty()).collect() }
    });
    words.collect()
}

#[test]
fn protocols_print_what_their_guide_shows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let guide = fs::read_to_string(root.join("docs/guide/protocols.md")).expect("the guide");
    let here = scratch("protocols-guide");
    let shown = blocks(&guide, "text").into_iter().filter(|block| block.starts_with("lesion"));
    let shown: Vec<&str> = shown.collect();
    let printed = blocks(&guide, "sh").into_iter().map(|commands| {
        let mut printed = String::new();
        for line in commands.lines() {
            let arguments = words(line.strip_prefix("farsa ").expect("a command of ours"));
            // The reader is in the clone. Files written here belong in other places.
            for file in arguments.iter().filter(|word| root.join(word).is_file()) {
                let copy = here.join(file);
                fs::create_dir_all(copy.parent().expect("a folder")).expect("a folder");
                fs::copy(root.join(file), copy).expect("a copy");
            }
            let said: Said = Running::start(&mut command(farsa(), &here, &arguments)).end();
            assert_eq!(said.code, Some(0), "{line}: {said:?}");
            printed = said.out;
        }
        printed
    });
    assert_eq!(printed.collect::<Vec<_>>(), shown);
}
