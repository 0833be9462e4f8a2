//! The command's messages about itself, and its silence.

use std::fs;

use crate::tool::{Running, Said, command, content, farsa, ok, own, say, scratch};

const SUBCOMMANDS: [&str; 20] = [
    "lab",
    "strategies",
    "list",
    "info",
    "run",
    "sweep",
    "merge",
    "test",
    "evaluate",
    "import",
    "replay",
    "live",
    "serve",
    "draw",
    "report",
    "export",
    "robot",
    "bench",
    "new",
    "check",
];

/// Subcommands without room on the screen.
const UNLISTED: [&str; 3] = ["completions", "man", "schema"];

#[test]
fn the_help_is_a_tour_on_one_screen() {
    let here = scratch("help");
    for (program, name, experiment) in [(farsa(), "farsa", "reach-grasp-lift"), (own(), "own-experiment", "cart")] {
        let help = ok(program, &here, "--help");
        assert!(help.lines().count() <= 24, "{} lines: {help}", help.lines().count());
        assert!(help.lines().all(|line| line.chars().count() <= 80), "{help}");
        for subcommand in SUBCOMMANDS.into_iter().chain(UNLISTED) {
            let listed = help.contains(&format!("\n  {subcommand} "));
            assert_eq!(listed, !UNLISTED.contains(&subcommand), "{subcommand} in {help}");
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
        ("bench crat", "`cart`"),
        ("bench cart --secods 1", "'--seconds'"),
        ("run cart --replicatoins 3", "'--replications'"),
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
    // Not every shell can have the words of an argument.
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
        "replay r --out trial.csv --quiet",
        "report r --html r.html --quiet",
    ] {
        let said = say(own(), &here, arguments);
        assert_eq!((said.code, said.out.as_str(), said.err.as_str()), (Some(0), "", ""), "{arguments}");
    }
    assert!(here.join("r/test.csv").is_file() && here.join("r.html").is_file() && here.join("trial.csv").is_file());
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
    let said = say(own(), &here, "replay r --json --out trial.csv");
    let episode = parsed(&said.out);
    assert_eq!((&episode["file"], said.err.as_str()), (&"trial.csv".into(), ""));
    assert_eq!(
        (&episode["directory"], &episode["experiment"], &episode["seed"]),
        (&"r".into(), &"cart".into(), &1.into())
    );
    assert_eq!((&episode["generation"], &episode["individual"]), (&2.into(), &run["champion"]["individual"]));
    assert_eq!((&episode["fitness"], &episode["steps"]), (&best.into(), &1500.into()));
    assert_eq!(episode["compared"], serde_json::Value::Null);
    let trials = episode["trials"].as_array().expect("a list");
    let sum: f64 = trials.iter().map(|trial| trial["fitness"].as_f64().expect("a number")).sum();
    assert!((sum - best).abs() < 1e-12 && trials.len() == 3, "{episode}");
    assert_eq!((&trials[2]["trial"], &trials[2]["steps"]), (&2.into(), &500.into()));
    assert_eq!(episode["success"], trials.iter().all(|trial| trial["success"] == true));

    // An episode that failed has earned no number. The other run is reported as well.
    let other = "run cart --generations 1 --seed 5 --set cart.friction=0 --out s";
    ok(own(), &here, other);
    let log = fs::read_to_string(here.join("s/fitness.csv")).expect("the log");
    assert!(!log.ends_with(",0\n"), "some carts leave the track: {log}");
    let episodes = (0..20).map(|individual| {
        let page = format!("{individual}.html");
        let line = format!("replay s --generation 0 --individual {individual} --trial 1 --compare r --html {page}");
        parsed(&ok(own(), &here, &format!("{line} --json")))
    });
    let episodes: Vec<serde_json::Value> = episodes.collect();
    for (individual, episode) in episodes.iter().enumerate() {
        assert_eq!(
            (&episode["individual"], &episode["compared"]["individual"]),
            (&individual.into(), &individual.into())
        );
        assert_eq!((&episode["directory"], &episode["compared"]["directory"]), (&"s".into(), &"r".into()));
        assert_eq!(episode["fitness"].is_null(), episode["steps"] == 0, "{episode}");
        let words = episode["summary"].as_str().expect("words");
        assert!(words.lines().count() == 2 && words.contains(", trial 1: "), "{words}");
    }
    assert!(
        episodes.iter().any(|episode| episode["fitness"].is_null())
            && episodes.iter().any(|episode| episode["steps"] == 500)
    );
}

#[test]
fn a_picture_is_told_of() {
    let here = scratch("drawn");
    let run = "run reach-grasp-lift --population 20 --set trial.steps=20 --generations 2 --out r";
    ok(farsa(), &here, run);
    let line = "draw r --individual 3 --trial 2 --time 0.1 --camera top --size 64x48 --out p.svg --json";
    let drawn: serde_json::Value = serde_json::from_str(&ok(farsa(), &here, line)).expect("JSON");
    assert_eq!(
        (&drawn["file"], &drawn["camera"], &drawn["condition"]),
        (&"p.svg".into(), &"top".into(), &"labels".into())
    );
    assert_eq!(
        (&drawn["generation"], &drawn["individual"], &drawn["trials"][0]["trial"]),
        (&1.into(), &3.into(), &2.into())
    );
    assert_eq!((&drawn["time"], &drawn["width"], &drawn["height"]), (&0.1.into(), &64.into(), &48.into()));
    assert_eq!((&drawn["steps"], drawn["trials"].as_array().map(Vec::len)), (&20.into(), Some(1)));
    assert_eq!(drawn["fitness"], drawn["trials"][0]["fitness"]);
    assert!(drawn["summary"].as_str().is_some_and(|words| words.contains("individual 3, trial 2, 0.10 s")), "{drawn}");
}

#[test]
fn a_bench_counts_trials() {
    let here = scratch("bench");
    let parsed = |text: &str| serde_json::from_str::<serde_json::Value>(text).expect(text);
    let set = "--set trial.steps=50 --set evolution.generations=30 --set cart.friction=5";
    let short = format!("{set} --seconds 0.05");
    // On a machine with other work a generation may take longer than expected.
    let patience = [0.05, 1.0, 60.0];
    let benched = |seconds| parsed(&ok(own(), &here, &format!("bench {set} --seconds {seconds} --threads 1 --json")));
    let found = patience.into_iter().map(benched).find(|found| found["rounds"] != 0).expect("a generation");
    assert_eq!((&found["experiment"], &found["condition"]), (&"cart".into(), &"rough".into()));
    let number = |key: &str| found[key].as_f64().expect(key);
    // No cart leaves the track in half a second, so a generation is 60 episodes of 50 steps.
    assert_eq!((number("trials"), number("steps")), (60.0 * number("rounds"), 3000.0 * number("rounds")));
    assert!(number("rounds") >= 1.0 && number("seconds") > 0.0);
    assert_eq!((number("steps") / number("seconds"), number("threads")), (number("steps_per_second"), 1.0));
    assert_eq!(number("steps_per_second_and_core"), number("steps_per_second"));
    assert_eq!((&found["lanes"], &found["simd"], &found["run"]), (&1.into(), &"none".into(), &serde_json::Value::Null));
    assert_eq!(found["study"]["control_steps"], 20.0 * 30.0 * 20.0 * 3.0 * 50.0);
    assert_eq!(found["predictions"][1]["cores"], 64);
    let seconds = found["predictions"][1]["seconds"].as_f64().expect("a number");
    let expected = 20.0 * 30.0 * 3000.0 / (64.0 * number("steps_per_second"));
    assert!((seconds / expected - 1.0).abs() < 1e-9, "{found}");

    // The genomes of a run, under its settings. Nothing is written.
    ok(own(), &here, "run cart --condition smooth --generations 3 --set trial.steps=50 --out r");
    let before = content(&here);
    let text = ok(own(), &here, "bench --run r --seconds 0.05");
    assert!(
        text.starts_with("cart smooth\ncounted: ") && text.contains("the 20 genomes of generation 2 of r: "),
        "{text}"
    );
    assert!(text.contains("\ngenerations per hour ") && text.contains("x 3 trials x 50 steps"), "{text}");
    let more = parsed(&ok(own(), &here, "bench --run r --seconds 0.05 --set trial.steps=7 --json --quiet"));
    assert_eq!((&more["generation"], &more["study"]["steps"]), (&2.into(), &7.0.into()));
    assert_eq!(content(&here), before);
    assert!(ok(own(), &here, &format!("bench cart {short} --quiet")).is_empty());
    for (arguments, word) in [
        ("bench cart --run r", "--run"),
        ("bench --run nowhere", "nowhere: there is no such directory"),
        ("bench cart --seconds 0", "0.01 to 86400"),
        ("bench cart --set cart.fricton=1", "`cart.friction`"),
        ("bench cart --lanes 8", "cart has 1 only"),
    ] {
        let said = say(own(), &here, arguments);
        assert!(said.code == Some(2) && said.err.contains(word), "{arguments}: {said:?}");
    }
}

/// True for a byte that colors or moves the cursor.
fn escapes(said: &Said) -> bool {
    [&said.out, &said.err].into_iter().any(|text| text.contains(['\u{1b}', '\r']))
}

#[test]
fn pipes_get_no_colours() {
    let here = scratch("colours");
    for arguments in ["--help", "run --help", "rnu", "run cart --generations 3 --out r", "test r --trials 3", "list"] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let said = Running::start(&mut command(own(), &here, &arguments)).end();
        assert!(!escapes(&said), "{arguments:?}: {said:?}");
    }
}

/// Runs a program whose output is a terminal, and returns what it wrote there.
#[cfg(target_os = "linux")]
fn on_a_terminal(mut program: std::process::Command) -> String {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

    let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a terminal");
    grantpt(&controller).and_then(|()| unlockpt(&controller)).expect("a terminal");
    let name = ptsname(&controller, Vec::new()).expect("its name").into_string().expect("its name");
    let terminal = fs::File::options().read(true).write(true).open(name).expect("a terminal");
    program.stdout(terminal.try_clone().expect("a terminal")).stderr(terminal);
    let running = Running::start(&mut program);
    drop(program);
    // Reading fails when the program has ended, as the last one to hold the terminal.
    let reader = crate::tool::read(fs::File::from(controller));
    assert_eq!(running.end().code, Some(0));
    reader.join().expect("its output")
}

#[cfg(target_os = "linux")]
#[test]
fn no_color_is_heeded_on_a_terminal() {
    let here = scratch("terminal");
    let help = |no_color: bool| {
        let mut help = command(own(), &here, &["--help"]);
        help.env("TERM", "xterm-256color").env_remove("NO_COLOR").env_remove("CLICOLOR");
        if no_color {
            help.env("NO_COLOR", "1");
        }
        on_a_terminal(help)
    };
    let [with, without] = [false, true].map(help);
    assert!(with.contains('\u{1b}') && with.contains("Usage"), "{with}");
    assert!(!without.contains('\u{1b}') && without.contains("Usage"), "{without}");
}

/// A terminal has the summary of a replay alone, and progress with its unit.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_is_not_flooded() {
    let here = scratch("flood");
    let shown = on_a_terminal(command(own(), &here, &["run", "cart", "--generations", "3", "--out", "r"]));
    assert!(shown.contains(" of 3 generations"), "{shown}");
    let shown = on_a_terminal(command(own(), &here, &["replay", "r"]));
    assert!(!shown.contains("trial,step,") && shown.lines().count() < 10, "{shown}");
    assert!(shown.contains("generation 2") && shown.contains("--out FILE, --html FILE, or `| less`"), "{shown}");
}

/// `--force` moves a run aside, and nothing else.
#[test]
fn a_run_in_the_way_is_moved_aside_when_that_is_asked_for() {
    let here = scratch("force");
    ok(own(), &here, "run cart --generations 2 --out r");
    let first = content(&here.join("r"));
    let said = say(own(), &here, "run cart --generations 1 --seed 2 --out r");
    assert!(said.code == Some(2) && said.err.contains("or move it aside with --force"), "{said:?}");
    // Refused commands move nothing.
    for wrong in ["--set cart.friction=x", "--lanes 8", "--population 0", "--replications 2", "--strategy none"] {
        assert_eq!(say(own(), &here, &format!("run cart --out r --force {wrong}")).code, Some(2), "{wrong}");
        assert_eq!(content(&here.join("r")), first, "{wrong}");
    }
    let said = say(own(), &here, "run cart --generations 1 --seed 2 --out r --force");
    assert!(said.code == Some(0) && said.err.contains("r: the run that was there is kept as r.old-1\n"), "{said:?}");
    let kept = |name: &str| content(&here.join(name)).into_iter().map(|(_, bytes)| bytes).collect::<Vec<_>>();
    let bytes: Vec<_> = first.into_iter().map(|(_, bytes)| bytes).collect();
    assert_eq!(
        kept("r.old-1").into_iter().filter(|bytes| !bytes.is_empty()).count(),
        bytes.iter().filter(|bytes| !bytes.is_empty()).count()
    );
    assert!(bytes.iter().all(|bytes| kept("r.old-1").contains(bytes)));
    ok(own(), &here, "run cart --generations 1 --seed 3 --out r --force --quiet");
    assert!(here.join("r.old-2/config.toml").is_file() && here.join("r/config.toml").is_file());
    ok(own(), &here, "run --resume r.old-1 --generations 3 --quiet");
    // Nothing was in the way, and what is no run stays there.
    ok(own(), &here, "run cart --generations 1 --out new --force --quiet");
    fs::create_dir(here.join("letters")).expect("a folder");
    fs::write(here.join("letters/a.txt"), "dear").expect("a file");
    let said = say(own(), &here, "run cart --out letters --force");
    assert!(said.code == Some(2) && said.err.contains("already holds other files"), "{said:?}");
    assert!(here.join("letters/a.txt").is_file());
}

#[test]
fn populations_are_told_of_by_name() {
    let here = scratch("named-populations");
    let said = say(
        farsa(),
        &here,
        "run predator-prey --generations 1 --population 4 --set evolution.parents=2 --set trial.steps=5 --out r",
    );
    assert_eq!(said.code, Some(0), "{said:?}");
    let line = said.err.lines().find(|line| line.starts_with("generation 0: ")).expect("a generation");
    assert!(
        line.contains(": predator best ") && line.contains("; prey best ") && line.matches(", worst ").count() == 2,
        "{line}"
    );
    let words = said.out.split("champions of generation 0: ").nth(1).expect("the champions");
    assert!(words.starts_with("predator individual ") && words.contains("; prey individual "), "{said:?}");
    let log = fs::read_to_string(here.join("r/fitness.csv")).expect("the log");
    assert!(log.starts_with("generation,best,mean,worst,evaluations,failed,"), "{log}");
}
