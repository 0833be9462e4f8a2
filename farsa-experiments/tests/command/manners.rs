//! What the command says about itself, and how it keeps silent.

use std::fs;
use std::path::Path;

use crate::tool::{command, farsa, ok, own, say, scratch};

const SUBCOMMANDS: [&str; 10] =
    ["list", "info", "run", "test", "replay", "draw", "report", "export", "completions", "man"];

#[test]
fn the_help_is_a_tour_on_one_screen() {
    let here = scratch("help");
    for (program, name, experiment) in [(farsa(), "farsa", "reach-grasp-lift"), (own(), "own-experiment", "cart")] {
        let help = ok(program, &here, "--help");
        assert!(help.lines().count() <= 24, "{} lines: {help}", help.lines().count());
        assert!(help.lines().all(|line| line.chars().count() <= 80), "{help}");
        for subcommand in SUBCOMMANDS {
            assert!(help.contains(&format!("\n  {subcommand} ")), "no {subcommand} in {help}");
            let own_help = ok(program, &here, &format!("{subcommand} --help"));
            assert!(
                own_help.contains("Example") && own_help.contains(&format!("\n  {name} {subcommand}")),
                "{own_help}"
            );
            assert!(own_help.lines().all(|line| line.chars().count() <= 80), "{own_help}");
        }
        assert!(help.contains(&format!("Usage: {name} ")) && help.contains(&format!("  {name} run {experiment} ")));
        assert!(ok(program, &here, "--version").starts_with(&format!("{name} ")));
    }
    assert!(ok(own(), &here, "--version").contains("(FARSA "));
}

#[test]
fn the_nearest_word_is_named() {
    let here = scratch("nearest");
    for (arguments, word) in [
        ("rum cart", "'run'"),
        ("run cart --generatoins 3", "'--generations'"),
        ("completions fihs", "fish"),
        ("replay x --htlm y", "'--html'"),
        ("info crat", "`cart`"),
        ("info cart --condition smoth", "`smooth`"),
    ] {
        let said = say(own(), &here, arguments);
        assert_eq!(said.code, Some(2), "{arguments}: {said:?}");
        assert!(said.err.contains(word), "{arguments}: no {word} in {said:?}");
    }
}

#[test]
fn completions_and_the_manual_know_all_commands() {
    let here = scratch("manual");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = ok(own(), &here, &format!("completions {shell}"));
        for word in SUBCOMMANDS.iter().chain(&["own-experiment", "generations"]) {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    // Not every shell can be told the words that an argument may have.
    let script = ok(own(), &here, "completions bash");
    assert!(script.contains("cart") && script.contains("smooth"), "{script}");
    let page = ok(own(), &here, "man");
    assert!(page.contains(".TH own-experiment 1"), "{page}");
    assert!(SUBCOMMANDS.iter().all(|subcommand| page.contains(subcommand)), "{page}");
    assert!(ok(own(), &here, "man --out pages --quiet").is_empty());
    for subcommand in SUBCOMMANDS {
        let page = fs::read_to_string(here.join(format!("pages/own-experiment-{subcommand}.1"))).expect(subcommand);
        assert!(page.contains("Example"), "{page}");
    }
    let page = fs::read_to_string(here.join("pages/own-experiment.1")).expect("the first page");
    fs::write(here.join("pages/own-experiment.1"), "mine").expect("a file");
    let said = say(own(), &here, "man --out pages");
    assert_eq!(said.code, Some(2), "{said:?}");
    assert!(said.err.contains("own-experiment.1: there is one already"), "{said:?}");
    assert!(!page.is_empty());
}

#[test]
fn quiet_says_nothing_and_errors_stay() {
    let here = scratch("quiet");
    for arguments in [
        "run cart --generations 3 --out r --quiet",
        "--quiet run --resume r --generations 4",
        "test r --trials 3 -q",
        "replay r --out life.csv --quiet",
        "report r --html r.html --quiet",
    ] {
        let said = say(own(), &here, arguments);
        assert_eq!((said.code, said.out.as_str(), said.err.as_str()), (Some(0), "", ""), "{arguments}");
    }
    assert!(here.join("r/test.csv").is_file() && here.join("r.html").is_file() && here.join("life.csv").is_file());
    let said = say(own(), &here, "replay r --quiet --trial 0");
    assert!(said.out.starts_with("trial,step,") && said.err.is_empty(), "{said:?}");
    let said = say(own(), &here, "test nowhere --quiet");
    assert!(said.code == Some(2) && said.err.starts_with("error: nowhere: "), "{said:?}");
}

#[test]
fn json_is_json() {
    let here = scratch("json");
    let parsed = |text: &str| serde_json::from_str::<serde_json::Value>(text).expect(text);
    let list = parsed(&ok(own(), &here, "list --json"));
    assert_eq!((&list[0]["name"], &list[0]["conditions"][1]), (&"cart".into(), &"smooth".into()));
    let run = parsed(&ok(own(), &here, "run cart --generations 3 --out r --json"));
    assert_eq!((&run["directory"], &run["generations"], &run["evaluations"]), (&"r".into(), &3.into(), &60.into()));
    assert_eq!(run["champion"]["generation"], 2);
    let log = fs::read_to_string(here.join("r/fitness.csv")).expect("the log");
    let best: f64 = log.lines().last().and_then(|line| line.split(',').nth(1)?.parse().ok()).expect("the best");
    assert_eq!(run["champion"]["fitness"], best);
    assert_eq!(parsed(&ok(own(), &here, "run --resume r --json --quiet"))["champion"], serde_json::Value::Null);

    let test = parsed(&ok(own(), &here, "test r --trials 6 --seed 4 --json"));
    assert_eq!((&test["trials"], &test["seed"], &test["generation"]), (&6.into(), &4.into(), &2.into()));
    let csv = fs::read_to_string(here.join("r/test.csv")).expect("the test");
    assert_eq!(test["successes"], csv.lines().filter(|line| line.contains(",true,")).count());
    assert_eq!(test["by_trial"]["2"]["of"], 2);
    assert!(test["notes"]["at [m]"]["mean"].is_f64(), "{test}");

    let said = say(own(), &here, "replay r --json --trial 0");
    assert!(said.out.starts_with("trial,step,"));
    assert_eq!(parsed(&said.err)["file"], serde_json::Value::Null);
    let said = say(own(), &here, "replay r --json --out life.csv");
    assert_eq!((&parsed(&said.out)["file"], said.err.as_str()), (&"life.csv".into(), ""));
}

/// Whether there is a byte that colours or moves the cursor.
fn escapes(output: &std::process::Output) -> bool {
    output.stdout.iter().chain(&output.stderr).any(|&byte| byte == 0x1b || byte == b'\r')
}

#[test]
fn pipes_get_no_colours() {
    let here = scratch("colours");
    for arguments in ["--help", "run --help", "rnu", "run cart --generations 3 --out r", "test r --trials 3", "list"] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let output = command(own(), &here, &arguments).output().expect("the program");
        assert!(!escapes(&output), "{arguments:?}: {output:?}");
    }
}

/// On a terminal, made by `script`, help has colours and `NO_COLOR` takes them away; without `script` nothing is tested.
#[cfg(target_os = "linux")]
#[test]
fn no_color_is_heeded_on_a_terminal() {
    let here = scratch("terminal");
    let on_a_terminal = |no_color: bool| {
        let line = format!("{} --help", own().display());
        let mut script = command(Path::new("script"), &here, &["-qec", &line, "/dev/null"]);
        script.env("TERM", "xterm-256color").env_remove("NO_COLOR").env_remove("CLICOLOR");
        if no_color {
            script.env("NO_COLOR", "1");
        }
        script.output().ok().filter(|output| output.status.success())
    };
    if let (Some(with), Some(without)) = (on_a_terminal(false), on_a_terminal(true)) {
        assert!(with.stdout.contains(&0x1b) && !without.stdout.contains(&0x1b), "{with:?} {without:?}");
    }
}
