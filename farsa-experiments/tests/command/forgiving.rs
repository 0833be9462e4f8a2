//! Commands that help: lists, help, names of files, next steps, progress and errors that name the way out.

use std::fs;

use crate::tool::{command, farsa, ok, own, say, scratch};

#[test]
fn help_of_a_subcommand_is_its_own() {
    let here = scratch("help-of");
    for subcommand in ["run", "strategies", "draw", "export robot", "schema"] {
        let help = ok(farsa(), &here, &format!("help {subcommand}"));
        assert_eq!(help, ok(farsa(), &here, &format!("{subcommand} --help")), "{subcommand}");
        assert!(help.contains(&format!("Usage: farsa {subcommand}")), "{help}");
    }
    for line in ["help", "help help", "-q help"] {
        assert_eq!(ok(farsa(), &here, line), ok(farsa(), &here, "--help"), "{line}");
    }
    assert_eq!(ok(farsa(), &here, "-q help run"), ok(farsa(), &here, "run --help"));
    let said = say(farsa(), &here, "help rum");
    assert!(said.code == Some(2) && said.err.contains("'run'"), "{said:?}");
}

#[test]
fn strategies_are_a_list_and_each_has_its_settings() {
    let here = scratch("strategies");
    let list = ok(farsa(), &here, "strategies");
    let json: serde_json::Value = serde_json::from_str(&ok(farsa(), &here, "strategies --json")).expect("JSON");
    let strategies = json.as_array().expect("a list");
    assert_eq!((list.lines().count(), strategies.len()), (21, 21));
    for (line, strategy) in list.lines().zip(strategies) {
        let [name, summary] = ["name", "summary"].map(|key| strategy[key].as_str().expect("a word"));
        assert!(line.starts_with(&format!("{name} ")) && line.ends_with(summary), "{line}");
        let text = ok(farsa(), &here, &format!("strategies {name}"));
        assert!(text.starts_with(&format!("{name}: {summary}\n")), "{text}");
        for setting in strategy["settings"].as_array().expect("a list") {
            assert!(text.contains(&format!("\n  {} = ", setting["key"].as_str().expect("a key"))), "{text}");
        }
    }
}

#[test]
fn templates_are_listed_without_a_pattern_of_the_shell() {
    let here = scratch("templates");
    for line in ["new --from list", "new follow --from list"] {
        let list = ok(farsa(), &here, line);
        assert!(list.lines().count() > 2 && list.contains("\n  wander "), "{list}");
        let said = say(farsa(), &here, "new follow --from ?");
        assert!(said.code == Some(2) && said.err.ends_with(&list), "{said:?}");
    }
    let said = say(farsa(), &here, "new --from wander");
    assert!(said.code == Some(2) && said.err.contains("new NAME --from wander"), "{said:?}");
    assert!(say(farsa(), &here, "new").err.contains("<NAME>"), "the name is missing");
    assert_eq!(fs::read_dir(&here).expect("the folder").count(), 0);
}

#[test]
fn a_name_without_extension_finds_its_file() {
    let here = scratch("without-extension");
    fs::create_dir_all(here.join("below")).expect("a folder");
    ok(farsa(), &here, "new follow --from wander --quiet");
    ok(farsa(), &here, "new below/other --from wander --quiet");
    for (name, file) in [("follow", "follow.toml"), ("below/other", "below/other.toml")] {
        for line in ["check", "info", "export robot --format urdf"] {
            assert_eq!(ok(farsa(), &here, &format!("{line} {name}")), ok(farsa(), &here, &format!("{line} {file}")));
        }
    }
    let small = "--population 8 --set episode.steps=5 --set episode.trials=1 --quiet";
    ok(farsa(), &here, &format!("run follow --generations 1 {small}"));
    ok(farsa(), &here, "run follow --resume runs/follow-1 --generations 2 --quiet");
    ok(farsa(), &here, "bench follow --seconds 0.05 --set evolution.population=8 --set episode.trials=1 --quiet");
    // The error names a run.
    for line in ["serve follow", "test follow.toml", "replay follow-1", "live follow --html l.html"] {
        let said = say(farsa(), &here, line);
        let why = "there is no such directory; a run of this name is `runs/follow-1`\n";
        assert!(said.code == Some(2) && said.err.ends_with(why), "{line}: {said:?}");
    }
    assert!(say(farsa(), &here, "test foll").err.ends_with("there is no such directory\n"));
    // A built-in experiment comes first, and another file of the name is another experiment.
    ok(farsa(), &here, "new foraging --from wander --quiet");
    assert_eq!(ok(farsa(), &here, "info foraging"), ok(farsa(), &scratch("elsewhere"), "info foraging"));
    let text = fs::read_to_string(here.join("follow.toml")).expect("the file");
    fs::write(here.join("follow.toml"), format!("{text}\n# changed\n")).expect("the file");
    let said = say(farsa(), &here, "run follow --resume runs/follow-1 --generations 3");
    assert!(said.code == Some(2) && said.err.contains("`definition`"), "{said:?}");
}

#[test]
fn the_end_of_a_run_names_the_next_commands() {
    let here = scratch("next");
    for directory in ["r", "my runs/a"] {
        let line = ["run", "cart", "--generations", "2", "--out", directory];
        let output = command(own(), &here, &line).output().expect("the program");
        let out = String::from_utf8(output.stdout).expect("text");
        let steps: Vec<&str> = out.lines().skip(1).collect();
        let program = own().display();
        let run = if directory == "r" { "r" } else { "'my runs/a'" };
        let expected = [
            format!("look:      {program} replay {run} --html trials.html"),
            format!("test:      {program} test {run}"),
            format!("continue:  {program} run --resume {run} --generations 4"),
        ];
        assert_eq!(steps, expected, "{out}");
        for step in steps {
            let words = shell_words(step.split_once(':').expect("a step").1);
            let status = command(own(), &here, &words[1..]).output().expect("the program").status;
            assert!(status.success(), "{step}");
        }
        let log = fs::read_to_string(here.join(directory).join("fitness.csv")).expect("the log");
        assert_eq!(log.lines().count(), 1 + 4);
    }
    assert!(here.join("trials.html").is_file() && here.join("r/test.csv").is_file());
    assert!(!ok(own(), &here, "run cart --generations 1 --seed 2 --json").contains("--resume"));
    // Only commands that are accepted and left to do.
    let tested = ok(own(), &here, "run cart --generations 1 --seed 3 --test 2");
    let steps: Vec<&str> = tested.lines().skip(2).filter_map(|line| Some(line.split_once(':')?.0)).collect();
    assert_eq!(steps, ["look", "continue"], "{tested}");
    let single = ok(farsa(), &here, "run braitenberg");
    let steps: Vec<&str> = single.lines().skip(1).filter_map(|line| Some(line.split_once(':')?.0)).collect();
    assert_eq!(steps, ["look", "test"], "{single}");
}

/// Splits a line with single quotes.
fn shell_words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for letter in line.trim().chars() {
        match (letter, quoted) {
            ('\'', _) => quoted = !quoted,
            (' ', false) => words.push(String::new()),
            (letter, _) => words.last_mut().expect("a word").push(letter),
        }
    }
    words
}

#[test]
fn a_log_counts_generations_and_predicts_the_end_of_all_runs() {
    let here = scratch("progress");
    let said = say(own(), &here, "run cart --generations 12 --replications 2");
    assert_eq!(said.code, Some(0), "{said:?}");
    let lines = |start: &str| said.err.lines().filter(|line| line.starts_with(start)).collect::<Vec<_>>();
    let (firsts, lasts) = (lines("generation 0: best "), lines("generation 11: best "));
    let (&[first, _], &[last, end]) = (firsts.as_slice(), lasts.as_slice()) else { panic!("{said:?}") };
    assert!(first.contains(", worst ") && first.contains("; 1 of 12 generations, "), "{first}");
    for word in [" individuals/s, ", " left, all runs "] {
        assert!(first.contains(word), "{first}");
    }
    // Nothing is left of the first run, and 240 individuals of the second.
    assert!(last.contains("; 12 of 12 generations, ") && !last.contains(" left"), "{last}");
    assert!(last.contains(", all runs ") && !end.contains(", all runs "), "{last}\n{end}");
}

#[test]
fn numbers_out_of_range_name_the_range() {
    let here = scratch("numbers");
    let seed = "not a whole number from 0 to 9223372036854775807";
    for (line, why) in [
        ("run cart --seed -1", seed),
        ("test r --seed -1", seed),
        ("evaluate cart --genes 1 --seed x", seed),
        ("test r --trials 0", "not a whole number from 1 to 100000000"),
        ("run cart --generations x", "not a whole number"),
        ("run cart --threads 1.5", "not a whole number from 1 to 4096"),
        ("replay r --generation -1", "not a whole number from 0 to 4294967295"),
        ("serve r --port 70000", "not a whole number from 0 to 65535"),
        ("export starts r --format json --trials -5", "not a whole number from 1 to 1000000"),
    ] {
        let said = say(own(), &here, line);
        assert!(said.code == Some(2) && said.err.contains(why), "{line}: {said:?}");
    }
}

#[test]
fn a_setting_of_another_strategy_names_both() {
    let here = scratch("other-strategy");
    let grid = "[grid]\nstrategy.name = [\"truncation\", \"cma-es\"]\nevolution.mutation_rate = [0.01, 0.05]\n";
    fs::write(here.join("my.toml"), format!("experiment = \"discrimination\"\n{grid}")).expect("a file");
    let truncation = "`evolution.mutation_rate`: a setting of `truncation`";
    for (line, place) in [
        ("sweep my.toml", "my.toml line 4: "),
        ("run discrimination --strategy cma-es --set evolution.mutation_rate=0.1", "--set: "),
    ] {
        let said = say(farsa(), &here, line);
        assert!(said.code == Some(2) && said.err.starts_with(&format!("error: {place}{truncation}")), "{said:?}");
        let keys = said.err.split_once(", not of `cma-es`; the settings of `cma-es` are ").expect("the keys").1;
        let text = ok(farsa(), &here, "strategies cma-es");
        for key in keys.trim().split(", ") {
            assert!(text.contains(&format!("\n  {} = ", key.trim_matches('`'))), "{key}: {text}");
        }
    }
}

#[test]
fn a_file_has_all_trials_of_a_long_test() {
    let here = scratch("long-test");
    ok(own(), &here, "run cart --generations 1 --out r --quiet");
    // An individual of a generation has no test.csv.
    for (individual, is_champion) in [("--generation 0", false), ("", true)] {
        let line = format!("test r --trials 201 {individual}");
        let text = ok(own(), &here, line.trim_end());
        for index in 0..201 {
            assert_eq!(text.matches(&format!("\n{index:>5} ")).count(), 1, "{index}: {text}");
        }
        assert!(!text.contains("more trials"), "{text}");
        assert_eq!(here.join("r/test.csv").exists(), is_champion);
    }
}
