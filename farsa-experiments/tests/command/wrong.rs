//! Wrong configurations, doubtful ones, and names of files: exit codes, lines and warnings.

use std::fs;
use std::path::Path;

use crate::tool::{farsa, ok, say, scratch};

/// Refuses a command with exit code 2 and these words, and writes nothing.
fn refused(here: &Path, arguments: &str, words: &[&str]) -> String {
    let said = say(farsa(), here, arguments);
    assert_eq!(said.code, Some(2), "{arguments}: {said:?}");
    for word in words {
        assert!(said.err.contains(word), "{arguments}: no {word:?} in {said:?}");
    }
    assert!(said.out.is_empty() && !here.join("runs").exists() && !here.join("o").exists(), "{arguments}: {said:?}");
    said.err
}

/// Writes an experiment of the guide whose strategy is chosen in line 1.
fn follow(here: &Path, strategy: &str) {
    let _ = fs::remove_file(here.join("follow.toml"));
    ok(farsa(), here, "new follow --from wander --quiet");
    let text = fs::read_to_string(here.join("follow.toml")).expect("the file");
    // The strategies below have other rates and parents.
    let text = text.replace("parents = 8\n", "").replace("mutation_rate = 0.02\n", "");
    fs::write(here.join("follow.toml"), format!("strategy = {{ name = \"{strategy}\" }}\n{text}")).expect("a file");
}

#[test]
fn strategies_that_do_not_fit_are_wrong_configurations() {
    let here = scratch("wrong-strategies");
    ok(farsa(), &here, "new follow --from light --quiet");
    let several = "follow: has its fitness alone, where `nsga2` wants several objectives";
    let measures = "follow: says nothing of behaviour";
    for command in ["check follow.toml", "run follow.toml --out o", "run follow.toml --replications 2"] {
        for (strategy, why) in [("nsga2", several), ("map-elites", measures), ("generalist", "wants 2")] {
            if !command.starts_with("check") {
                refused(&here, &format!("{command} --strategy {strategy}"), &[why]);
            }
            // A file has a line.
            follow(&here, strategy);
            refused(&here, command, &["follow.toml line 1: ", why]);
            let _ = fs::remove_file(here.join("follow.toml"));
            ok(farsa(), &here, "new follow --from light --quiet");
        }
    }
    // Each strategy starts or is refused with code 2.
    let list = ok(farsa(), &here, "strategies --json");
    let list: serde_json::Value = serde_json::from_str(&list).expect("a list");
    let names: Vec<&str> = list.as_array().into_iter().flatten().filter_map(|known| known["name"].as_str()).collect();
    assert!(names.len() > 15, "{names:?}");
    for (number, name) in names.iter().enumerate() {
        let size = "--population 3 --generations 1 --set episode.steps=5 --set episode.trials=1";
        let said = say(farsa(), &here, &format!("run follow.toml --strategy {name} {size} --out s{number}"));
        assert!([Some(0), Some(2)].contains(&said.code), "{name}: {said:?}");
        assert_eq!(said.code == Some(0), here.join(format!("s{number}")).exists(), "{name}: {said:?}");
    }
}

#[test]
fn settings_that_contradict_each_other_have_the_line_of_the_file() {
    let here = scratch("wrong-settings");
    ok(farsa(), &here, "new follow --from light --quiet");
    let text = fs::read_to_string(here.join("follow.toml")).expect("the file");
    let line = 1 + text.lines().position(|line| line.starts_with("evolution")).expect("the table");
    fs::write(here.join("follow.toml"), text.replace("population = 40", "population = 41")).expect("a file");
    for command in ["check follow.toml", "run follow.toml --out o", "run follow.toml --replications 2"] {
        let place =
            format!("follow.toml line {line}: `evolution.population`: a population of 41 is not a multiple of 8");
        refused(&here, command, &[&place]);
    }
    // A value of the command line is not that of the file.
    let said = say(farsa(), &here, "check follow.toml --set evolution.population=42");
    assert_eq!(said.code, Some(2), "{said:?}");
    assert!(said.err.starts_with("error: `evolution.population`: a population of 42"), "{said:?}");
    // The values of a condition have its line.
    let condition =
        "conditions = [{ name = \"odd\", settings = { \"evolution.parents\" = 7, \"evolution.population\" = 50 } }]";
    fs::write(here.join("follow.toml"), format!("{condition}\n{text}")).expect("a file");
    refused(&here, "check follow.toml", &["follow.toml line 1: `evolution.population`: a population of 50"]);
    refused(&here, "run predator-prey --set evolution.population=3 --out o", &["`evolution.population`"]);
}

#[test]
fn a_fitness_that_cannot_differ_is_warned_about() {
    let here = scratch("doubtful");
    ok(farsa(), &here, "new follow --from light --quiet");
    let text = fs::read_to_string(here.join("follow.toml")).expect("the file");
    let quiet =
        text.replace("kind = \"near\", ", "kind = \"near\", weight = 0.0, ").replace("weight = -0.5", "weight = 0.0");
    fs::write(here.join("follow.toml"), &quiet).expect("a file");
    let line = 1 + quiet.lines().position(|line| line.contains("kind = \"near\"")).expect("a term");
    let warning =
        format!("warning: follow.toml line {line}: no term has a weight, so the fitness of all individuals is 0\n");
    let run = "run follow.toml --generations 1 --population 8 --set episode.steps=5";
    for command in ["check follow.toml", &format!("{run} --out a"), &format!("{run} --replications 1 --out b")] {
        let said = say(farsa(), &here, command);
        assert!(said.code == Some(0) && said.err.contains(&warning), "{command}: {said:?}");
        assert!(
            !say(farsa(), &here, &format!("--quiet {command}").replace("--out ", "--out q")).err.contains("warning")
        );
    }
    let json: serde_json::Value = serde_json::from_str(&ok(farsa(), &here, "check follow.toml --json")).expect("JSON");
    assert_eq!(json["warnings"].as_array().map(Vec::len), Some(1), "{json}");
    // A weight of the command line is enough.
    let said = say(farsa(), &here, "check follow.toml --set reward.near.weight=0.1");
    assert!(said.code == Some(0) && !said.err.contains("warning"), "{said:?}");
}

#[test]
fn names_that_are_almost_files_name_them() {
    let here = scratch("almost-files");
    fs::create_dir_all(here.join("below")).expect("a folder");
    ok(farsa(), &here, "new follow --from light --quiet");
    ok(farsa(), &here, "new below/other --from light --quiet");
    for (name, file) in [("Follow.toml", "follow.toml"), ("below/Other", "below/other.toml"), ("FOLLOW", "follow.toml")]
    {
        for command in ["run", "check", "info", "bench"] {
            refused(
                &here,
                &format!("{command} {name}"),
                &[&format!("there is no experiment `{name}`; the file is `{file}`")],
            );
        }
    }
    refused(&here, "run foragin", &["unknown experiment `foragin`; the nearest is `foraging`"]);
}

/// Every file and folder that a command line names is a part of it, and so is what a setting names.
#[test]
fn files_of_the_command_line_are_missing_or_damaged() {
    let here = scratch("wrong-files");
    let run = "run discrimination --generations 1 --set trial.count=1 --set trial.steps=5";
    ok(farsa(), &here, &format!("{run} --out r"));
    fs::create_dir(here.join("folder")).expect("a folder");
    fs::write(here.join("text.txt"), "text\n").expect("a file");
    let model = "<robot name='r' xmlns:xacro='x'>\n<xacro:leg name='left'/></robot>";
    fs::write(here.join("raw.urdf"), model).expect("a file");
    let reads = ["check", "info", "run", "bench", "sweep"].map(|command| format!("{command} none.toml"));
    let writes =
        ["report r --html", "draw r --out", "replay r --out", "replay r --html", "live r --html", "merge r --csv"];
    let writes = writes.map(|command| format!("{command} none/a.svg"));
    let others = [
        "run discrimination --config none.toml",
        "run discrimination --config folder",
        "run discrimination --set robot.infrared_tables=none",
        "robot none.urdf",
        "robot raw.urdf",
        "robot text.txt",
        "robot folder",
        "robot raw.urdf --packages none",
        "evaluate discrimination --genes-file text.txt",
        "evaluate discrimination --genes-file none",
        "evaluate discrimination --genes-file text.txt --ir-tables none",
        "import none.ini",
        "import folder --experiment discrimination",
        "import text.txt --experiment discrimination",
        "merge none",
        "live r --module none --html page.html",
        "serve r --module none",
        "lab folder --module none",
        "man --out text.txt/a",
        "test none",
    ];
    for arguments in reads.into_iter().chain(writes).chain(others.map(str::to_owned)) {
        let more = if arguments.starts_with("import") && !arguments.contains(".ini") { " --out o" } else { "" };
        let text = refused(&here, &format!("{arguments}{more}"), &["error: "]);
        assert!(!text.contains("Usage: "), "{arguments}: {text}");
    }
}

/// A file with the name of a built-in experiment is another experiment, also on a page.
#[test]
fn reports_name_the_origin_of_equal_names() {
    let here = scratch("equal-names");
    ok(farsa(), &here, "new discrimination --from light --quiet");
    let run = |name: &str, more: &str| ok(farsa(), &here, &format!("run {name} --generations 1 {more} --quiet"));
    run("discrimination", "--set trial.count=1 --set trial.steps=5 --out built-in");
    run("discrimination.toml", "--population 8 --set episode.trials=1 --set episode.steps=5 --out file");
    ok(farsa(), &here, "report built-in file --md both.md");
    let page = fs::read_to_string(here.join("both.md")).expect("the page");
    for heading in ["discrimination (built in)", "discrimination (from a file)"] {
        assert!(page.contains(&format!("\n## {heading}\n")), "{heading}: {page:.600}");
    }
    ok(farsa(), &here, "report file --md one.md");
    assert!(!fs::read_to_string(here.join("one.md")).expect("the page").contains("(from a file)"));
}
