//! Whatever is wrong is named, with exit code 2 or 1, and nothing is overwritten.

use std::fs;
use std::path::Path;

use crate::tool::{content, farsa, ok, own, say, scratch};

/// The program must refuse with a code and print all of the words, and change nothing.
fn refused(program: &Path, here: &Path, arguments: &str, code: i32, words: &[&str]) {
    let before = content(here);
    let said = say(program, here, arguments);
    assert_eq!(said.code, Some(code), "{arguments}: {said:?}");
    for word in words {
        assert!(said.err.contains(word), "{arguments}: no {word:?} in {said:?}");
    }
    assert!(said.out.is_empty(), "{arguments}: {said:?}");
    assert!(content(here) == before, "{arguments} changed a file");
}

#[test]
fn worlds() {
    let here = scratch("worlds");
    let run = "run reach-grasp-lift --generations 1 --population 20";
    let unknown = ["--world: ", "`world.engine`", "rapir"];
    refused(farsa(), &here, &format!("{run} --world rapir"), 2, &unknown);
    refused(farsa(), &here, "run braitenberg --world rapier", 2, &["--world rapier: braitenberg has one world only"]);
    if cfg!(feature = "rapier") {
        ok(farsa(), &here, &format!("{run} --set trial.steps=5 --world rapier --out r"));
        let other = ["`world.engine` = \"rapier\", not \"articulated\""];
        refused(farsa(), &here, "run --resume r --generations 2 --world articulated", 2, &other);
        // A test may leave the run's world, and keeps what it finds to itself.
        ok(farsa(), &here, "test r --trials 4 --world articulated");
        assert!(here.join("r/test-articulated.csv").is_file() && !here.join("r/test.csv").exists());
        ok(farsa(), &here, "test r --trials 4 --world rapier");
        assert!(here.join("r/test.csv").is_file());
        ok(farsa(), &here, "replay r --trial 0 --world articulated --out trial.csv");
        ok(farsa(), &here, "run discrimination --generations 1 --set trial.count=1 --set trial.steps=5 --out d");
        ok(farsa(), &here, "test d --trials 4 --world rapier");
        assert!(here.join("d/test-rapier.csv").is_file() && !here.join("d/test.csv").exists());
        ok(farsa(), &here, "replay d --trial 0 --world rapier --out wheels.csv");
        let short = "--generations 1 --population 4 --set trial.count=1 --set trial.steps=5";
        ok(farsa(), &here, &format!("run push-box {short} --world rapier --out p"));
        ok(farsa(), &here, "test p --trials 2");
        ok(farsa(), &here, "draw p --trial 0 --out box.svg");
        ok(farsa(), &here, "report p --md report.md");
    } else {
        let how = ["world `rapier`", "--features rapier"];
        refused(farsa(), &here, &format!("{run} --world rapier"), 2, &how);
        ok(farsa(), &here, &format!("{run} --set trial.steps=5 --world articulated --out r"));
        refused(farsa(), &here, "test r --trials 4 --world rapier", 2, &how);
        refused(farsa(), &here, "replay r --trial 0 --world rapier", 2, &how);
        for experiment in ["discrimination --world rapier", "discrimination-cylinders --world rapier", "push-box"] {
            refused(farsa(), &here, &format!("run {experiment} --generations 1 --out n"), 2, &how);
        }
        let list = ok(farsa(), &here, "list");
        let line = list.lines().find(|line| line.contains("push-box")).expect("push-box is listed");
        assert!(line.contains("--features rapier"), "{line}");
    }
}

#[test]
fn the_command_line() {
    let here = scratch("line");
    for (arguments, words) in [
        ("", ["Usage"].as_slice()),
        ("rum cart", &["rum"]),
        ("run", &["Usage"]),
        ("run cart --sed 1", &["--sed"]),
        ("run cart --seed -1", &["--seed"]),
        ("run cart --seed 9223372036854775808", &["--seed"]),
        ("run cart --threads 0", &["--threads"]),
        ("run cart --lanes 3", &["--lanes", "1, 8, 16, auto"]),
        ("run cart --simd neon", &["--simd", "baseline, avx2, avx512, auto"]),
        ("run cart --lanes 8", &["--lanes 8: cart has 1 only"]),
        ("run cart --set population", &["--set", "key=value"]),
        ("run catr", &["unknown experiment `catr`", "nearest is `cart`"]),
        ("info catr", &["unknown experiment `catr`", "nearest is `cart`"]),
        ("run cart --condition rouhg", &["unknown condition `rouhg`", "nearest is `rough`"]),
        ("info cart --condition labels", &["unknown condition `labels`"]),
        ("run cart --set cart.frictoin=1", &["--set: unknown key `cart.frictoin`", "nearest is `cart.friction`"]),
        ("run cart --set cart.friction=nan", &["--set: `cart.friction`: NaN"]),
        ("run cart --set cart.friction=NaN", &["--set: `cart.friction`: NaN"]),
        ("run cart --set cart.friction=inf", &["--set: `cart.friction`: inf is outside 0.0 to 10.0"]),
        ("run cart --set cart.friction=-0.1", &["-0.1 is outside 0.0 to 10.0"]),
        ("run cart --set cart.friction=much", &["\"much\" is not a number"]),
        ("run cart --set cart.motor=swiched", &["unknown choice `swiched`", "nearest is `switched`"]),
        ("run cart --set trial.steps=1.5", &["1.5 is not a whole number"]),
        ("run cart --set evolution.mutation_rate=1.01", &["`evolution.mutation_rate`: 1.01 is outside 0.0 to 1.0"]),
        ("run cart --population 0", &["--population: `evolution.population`: 0 is outside 1 to 1000"]),
        ("run cart --population 4", &["`evolution.population`: 5 parents from a population of 4"]),
        ("run cart --population 7", &["`evolution.population`: a population of 7 is not a multiple of 5 parents"]),
        ("run cart --generations 0", &["--generations: `evolution.generations`: 0 is outside 1 to"]),
        ("run cart --config none.toml --resume x --out y", &["--out"]),
        ("run --resume nowhere", &["nowhere: there is no such directory"]),
        ("test nowhere", &["nowhere: there is no such directory"]),
        ("test nowhere --trials 0", &["--trials"]),
        ("replay nowhere", &["nowhere: there is no such directory"]),
        ("test .", &["holds no run"]),
    ] {
        refused(own(), &here, arguments, 2, words);
    }
    refused(own(), &here, "run cart --config none.toml", 2, &["cannot read none.toml"]);
    refused(farsa(), &here, "run reach-grasp-lit", 2, &["unknown experiment", "nearest is `reach-grasp-lift`"]);
    refused(farsa(), &here, "run reach-grasp-lift --condition label", 2, &["nearest is `labels`"]);
    refused(farsa(), &here, "run reach-grasp-lift --population 10", 2, &["20 parents from a population of 10"]);
    for harmless in ["--help", "--version", "run --help", "list"] {
        assert_eq!(say(farsa(), &here, harmless).code, Some(0));
    }
    assert!(!here.join("runs").exists());
}

#[test]
fn a_configuration_file() {
    let here = scratch("file");
    for (text, words) in [
        ("# mine\n[cart]\nfrction = 1", ["my.toml line 3: unknown key `cart.frction`", "`cart.friction`"].as_slice()),
        ("[crat]\nfriction = 1", &["my.toml line 2: unknown key `crat.friction`", "`cart.friction`"]),
        ("[cart]\nfriction = nan", &["my.toml line 2: `cart.friction`: NaN"]),
        ("[cart]\nfriction = 11", &["my.toml line 2: `cart.friction`: 11 is outside 0.0 to 10.0"]),
        ("[evolution]\npopulation = 0", &["my.toml line 2: `evolution.population`: 0 is outside"]),
        ("[evolution]\npopulation = 4", &["`evolution.population`: 5 parents from a population of 4"]),
        ("[cart]\nfriction = ", &["my.toml line 2"]),
        ("[cart\n", &["my.toml line 1"]),
        ("experiment = \"chart\"", &["my.toml line 1", "\"chart\"", "`cart`"]),
        ("\ncondition = \"smoth\"", &["my.toml line 2: unknown condition `smoth`", "`smooth`"]),
        ("seed = 1.5", &["my.toml line 1: `seed`"]),
    ] {
        fs::write(here.join("my.toml"), text).expect("the file");
        refused(own(), &here, "run cart --config my.toml", 2, words);
    }
    fs::write(here.join("my.toml"), "seed = 3").expect("the file");
    refused(own(), &here, "run --config my.toml", 2, &["neither the command line nor the file names an experiment"]);
    fs::write(here.join("my.toml"), [0xff, 0xfe]).expect("the file");
    refused(own(), &here, "run cart --config my.toml", 2, &["my.toml: line 1: the byte 0xff is no text"]);
}

#[test]
fn a_directory_that_is_taken() {
    let here = scratch("taken");
    ok(own(), &here, "run cart --generations 2 --out r");
    for arguments in
        ["run cart --generations 2 --out r", "run cart --seed 2 --out r", "run --config r/config.toml --out r"]
    {
        refused(own(), &here, arguments, 2, &["r: already holds a run", "--resume"]);
    }
    fs::create_dir(here.join("letters")).expect("a directory");
    fs::write(here.join("letters/one.txt"), "dear").expect("a file");
    refused(own(), &here, "run cart --out letters", 2, &["letters: already holds other files"]);
    refused(own(), &here, "run cart --out letters/one.txt", 2, &["is not a directory"]);
    refused(own(), &here, "replay r --out letters/one.txt", 2, &["letters/one.txt: there is one already"]);
    refused(own(), &here, "replay r --out r/champion.bin", 2, &["there is one already"]);
}

#[test]
fn another_run_than_the_one_that_is_resumed() {
    let here = scratch("other");
    ok(own(), &here, "run cart --generations 2 --out r");
    for (arguments, words) in [
        ("--set cart.friction=0.25", ["`cart.friction` = 0.5, not 0.25"].as_slice()),
        ("--population 25", &["`evolution.population` = 20, not 25"]),
        ("--seed 2", &["`seed` = 1, not 2"]),
        ("cart --condition smooth", &["`condition` = rough, not smooth"]),
        ("chart", &["`experiment` = cart, not chart"]),
        ("--generations 1", &["has finished 2 generations already"]),
    ] {
        refused(own(), &here, &format!("run --resume r {arguments}"), 2, words);
    }
    ok(own(), &here, "run --resume r cart --condition rough --seed 1 --set cart.friction=0.5 --population 20");

    // A configuration that was changed by hand is noticed by everything that reads it.
    let config = here.join("r/config.toml");
    let text = fs::read_to_string(&config).expect("the configuration");
    fs::write(&config, text.replace("friction = 0.5", "friction = 0.75")).expect("the configuration");
    for arguments in ["run --resume r --generations 9", "test r", "replay r"] {
        refused(own(), &here, arguments, 2, &["`cart.friction` = 0.5, not 0.75"]);
    }
    fs::write(&config, text.replace("steps = ", "stpes = ")).expect("the configuration");
    refused(own(), &here, "run --resume r", 2, &["config.toml line ", "unknown key `trial.stpes`", "`trial.steps`"]);
    // Another program's run.
    fs::write(&config, &text).expect("the configuration");
    refused(farsa(), &here, "test r", 2, &["unknown experiment `cart`"]);
}

#[test]
fn lives_that_never_were() {
    let here = scratch("never");
    ok(own(), &here, "run cart --generations 2 --out r");
    for (arguments, words) in [
        ("--generation 2", ["generation 2 of 2 finished ones"].as_slice()),
        ("--individual 20", &["individual 20 of a population of 20"]),
        ("--trial 3", &["trial 3 of 3"]),
        ("--generation x", &["--generation"]),
    ] {
        refused(own(), &here, &format!("replay r {arguments}"), 2, words);
    }
}
