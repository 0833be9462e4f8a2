//! Generates docs/command.md from the command line and `reference.txt`, and checks that the file is current.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use clap::builder::PossibleValue;
use clap::{Arg, Command};

use crate::command::manual;
use crate::run::laboratory::Laboratory;

const TEMPLATE: &str = include_str!("reference.txt");
/// Options that are listed once, with the help of `run`.
const COMMON: [&str; 8] = ["condition", "set", "threads", "lanes", "simd", "world", "json", "quiet"];
const MAX_BYTES: usize = 20_000;

fn is_common(argument: &Arg) -> bool {
    COMMON.iter().any(|name| argument.get_long() == Some(name))
}

/// Returns an option with its help as an item of a list.
fn item(argument: &Arg) -> String {
    let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
    let values = argument.get_possible_values();
    let values: Vec<&str> =
        values.iter().filter(|_| argument.get_long().is_some()).map(PossibleValue::get_name).collect();
    let values = if values.is_empty() { String::new() } else { format!(": {}", values.join(", ")) };
    let defaults: Vec<_> = argument.get_default_values().iter().map(|value| value.to_string_lossy()).collect();
    let default = if defaults.is_empty() || argument.get_num_args().is_some_and(|count| !count.takes_values()) {
        String::new()
    } else {
        format!(" [default: {}]", defaults.join(" "))
    };
    format!("- `{argument}`: {help}{values}{default}\n")
}

/// Formats the text of a subcommand: its purpose, its usage and its own options.
fn section(command: &mut Command) -> String {
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let usage =
        command.render_usage().to_string().replace("Usage: ", "").replace("[OPTIONS] ", "").replace(" [OPTIONS]", "");
    let arguments = command.get_arguments().filter(|argument| !argument.is_hide_set() && !is_common(argument));
    let arguments = arguments.filter(|argument| argument.get_id() != "help").map(item);
    let mut text = format!("{about}: `{usage}`\n\n{}", arguments.collect::<String>());
    if !text.ends_with("\n\n") {
        text.push('\n');
    }
    for nested in command.get_subcommands_mut().filter(|nested| nested.get_name() != "help") {
        text += &section(nested);
    }
    text
}

fn reference() -> String {
    let mut command = manual::command("farsa", &Laboratory::new(&[]));
    command.build();
    let run = command.find_subcommand("run").expect("the subcommand");
    let common: String = run.get_arguments().filter(|argument| is_common(argument)).map(item).collect();
    let mut text = TEMPLATE.replace("{{common}}\n", &common);
    let mut names = BTreeSet::new();
    for subcommand in command.get_subcommands_mut() {
        let mark = format!("{{{{{}}}}}\n", subcommand.get_name());
        assert_eq!(text.matches(&mark).count(), 1, "{mark}");
        names.insert(mark.clone());
        text = text.replace(&mark, &section(subcommand));
    }
    assert!(!text.contains("{{"), "an unknown subcommand, known are {names:?}");
    text
}

#[test]
fn the_reference_is_generated_from_the_command_line() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/command.md");
    let text = reference();
    if std::env::var_os("FARSA_WRITE_REFERENCE").is_some() {
        fs::write(&path, &text).expect("a file");
    }
    assert!(text.len() <= MAX_BYTES, "{} bytes", text.len());
    let current = fs::read_to_string(&path).expect("the reference");
    assert!(current == text, "docs/command.md is not current: run this test with FARSA_WRITE_REFERENCE=1");
}
