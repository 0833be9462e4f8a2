//! Untrusted files: their content reaches no terminal as it is, and none of them takes all memory or all time.

use std::fs;
use std::path::Path;

use crate::tool::{Running, Said, command, farsa, ok, say, scratch};

/// An escape sequence that clears the screen, one that names the window, C1's own, one that turns the direction of writing.
const EVIL: &str = "\u{1b}[2J\u{1b}]0;x\u{7}\u{9b}2J\u{202e}";
const SHOWN: &str = "\\u{1b}[2J\\u{1b}]0;x\\u{7}\\u{9b}2J\\u{202e}";

fn plain(said: &Said) {
    let bad = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    assert!(!said.err.contains(bad) && !said.out.contains(bad), "{said:?}");
}

/// The program must refuse with a code and print the words on one line, without control characters.
fn refused(here: &Path, arguments: &[&str], code: i32, words: &str) {
    let said = Running::start(&mut command(farsa(), here, arguments)).end();
    assert!(said.code == Some(code) && said.out.is_empty(), "{arguments:?}: {said:?}");
    assert!(said.err.contains(words) && said.err.lines().count() == 1, "{arguments:?}: no {words:?} in {said:?}");
    plain(&said);
}

#[test]
fn control_characters() {
    let here = scratch("escapes");
    let run = ["run", "--config", "evil.toml"];
    for (text, words) in [
        ("\"\\u001b[2J\\u001b]0;x\\u0007\\u009b2J\\u202e\" = 1", &format!("line 2: unknown key `{SHOWN}`")),
        ("\"a\\nerror: b\" = 1", &"line 2: unknown key `a\\nerror: b`".to_owned()),
        ("trial.steps = \"\\u009b\\n\"", &"line 2: `trial.steps`: \"\\u{9b}\\n\" is not a whole number".to_owned()),
        ("condition = \"\\u001b\\n\"", &"line 2: unknown condition `\\u{1b}\\n`".to_owned()),
        ("[\"\\u202e\"]", &"line 2: unknown section `\\u{202e}`".to_owned()),
    ] {
        fs::write(here.join("evil.toml"), format!("experiment = \"discrimination\"\n{text}\n")).expect("a file");
        refused(&here, &run, 2, words);
    }
    fs::write(here.join("evil.gen"), format!("**NET : a\nDYNAMICAL NN\n{EVIL}\nEND\n")).expect("a file");
    let genes = ["evaluate", "discrimination", "--genes-file", "evil.gen"];
    refused(&here, &genes, 2, &format!("evil.gen: line 3: gene 0 (the first is 0) is `{SHOWN}`, not a whole number"));
    let link = "<link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
    let robot = format!("<robot name='x&#x9b;2J\u{202e}'>{link}</robot>");
    fs::write(here.join("evil.urdf"), robot).expect("a file");
    let said = say(farsa(), &here, "robot evil.urdf");
    assert!(said.code == Some(0) && said.out.starts_with("evil.urdf: x\\u{9b}2J\\u{202e}\n"), "{said:?}");
    plain(&said);
}

#[cfg(unix)]
#[test]
fn names_of_files() {
    let here = scratch("names");
    let evil = "d\u{1b}[2J\u{9b}\ne".to_owned();
    refused(&here, &["test", &evil], 2, "d\\u{1b}[2J\\u{9b}\\ne");
    refused(&here, &["run", "--config", &evil], 2, "cannot read d\\u{1b}[2J\\u{9b}\\ne");
    let short = ["--generations", "1", "--set", "trial.count=1", "--set", "trial.steps=5"];
    let arguments = [&["run", "discrimination", "--out", &evil], short.as_slice()].concat();
    let run = |arguments: &[&str]| Running::start(&mut command(farsa(), &here, arguments)).end();
    for arguments in [
        arguments.as_slice(),
        &["run", "--resume", &evil],
        &["replay", &evil, "--out", "a.csv"],
        &["test", &evil, "--trials", "2"],
    ] {
        let said = run(arguments);
        assert_eq!(said.code, Some(0), "{said:?}");
        plain(&said);
        assert!(!format!("\n{}{}", said.out, said.err).contains("\ne:"), "{said:?}");
    }
}

#[test]
fn files_without_an_end() {
    let here = scratch("endless");
    let keys: Vec<String> = (0..45_000).map(|number| format!("k{number}=1\n")).collect();
    fs::write(here.join("keys.toml"), format!("experiment=\"discrimination\"\n{}", keys.concat())).expect("a file");
    refused(&here, &["run", "--config", "keys.toml"], 2, "keys.toml line 2: unknown key `k0`");
    fs::File::create(here.join("large")).and_then(|file| file.set_len(1 << 40)).expect("a file with a hole");
    let most = |bytes: u32| format!("large: has more than {bytes} bytes, the most that is read of it");
    refused(&here, &["run", "--config", "large"], 2, &most(4_000_000));
    refused(&here, &["evaluate", "discrimination", "--genes-file", "large"], 2, &most(256_000_000));
    refused(&here, &["import", "--experiment", "discrimination", "large", "--out", "i"], 2, &most(256_000_000));
    let tables = ["--set", "robot.infrared=sampled", "--set", "robot.infrared_tables=."];
    fs::rename(here.join("large"), here.join("wall.sam")).expect("another name");
    refused(&here, &[&["run", "discrimination"], tables.as_slice()].concat(), 2, "wall.sam: has more than 256000000");
    if cfg!(unix) {
        refused(&here, &["run", "--config", "/dev/zero"], 2, "/dev/zero: has more than 4000000 bytes");
        refused(&here, &["run", "--config", "/dev/null"], 2, "names an experiment");
    }
}

#[cfg(unix)]
#[test]
fn pipes() {
    use std::process::Command;
    let here = scratch("pipes");
    let mkfifo = |name: &str| assert!(Command::new("mkfifo").arg(here.join(name)).status().expect("mkfifo").success());
    mkfifo("late.toml");
    let late = here.join("late.toml");
    let writer = std::thread::spawn(move || {
        std::thread::sleep(std::time::Duration::from_millis(200));
        fs::write(late, "experiment = \"discrimination\"\nworld.stepp = 1\n").expect("a pipe");
    });
    refused(&here, &["run", "--config", "late.toml"], 2, "late.toml line 2: unknown key `world.stepp`");
    writer.join().expect("a writer");
    mkfifo("wall.sam");
    let tables = ["--set", "robot.infrared=sampled", "--set", "robot.infrared_tables=."];
    refused(&here, &[&["run", "discrimination"], tables.as_slice()].concat(), 2, "wall.sam: is not a regular file");
    ok(farsa(), &here, "run discrimination --generations 1 --set trial.count=1 --set trial.steps=5 --out r");
    fs::remove_file(here.join("r/config.toml")).expect("the configuration");
    mkfifo("r/config.toml");
    refused(&here, &["test", "r"], 2, "r: holds no run: there is no config.toml");
}
