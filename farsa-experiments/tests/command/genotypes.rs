//! External genotypes: evaluated, and imported as a directory that can be tested and replayed.

use std::fs;

use crate::tool::{content, farsa, ok, own, say, scratch};

const GOOD: &str = "**NET : 500_0_0.wts\nDYNAMICAL NN\n30000\n22000\nEND\n";

/// The number behind a name in what `evaluate` wrote.
fn value(text: &str, name: &str) -> f64 {
    let line = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
    line.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no {name} in {text}"))
}

#[test]
fn anybodys_genotype_is_evaluated() {
    let here = scratch("evaluate");
    fs::write(here.join("a.gen"), GOOD).expect("a file");
    fs::write(here.join("a.txt"), "30000, 22000\n").expect("a file");
    fs::write(here.join("two.gen"), format!("{GOOD}{}", GOOD.replace("30000", "65535"))).expect("a file");
    let evaluate = |rest: &str| ok(own(), &here, &format!("evaluate cart --trials 60 --seed 3 {rest}"));
    let text = evaluate("--genes 30000,22000 --threads 1");
    let names: Vec<&str> = text.lines().filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(names, ["mean_fitness", "standard_error", "at_m_per_trial", "success_rate"]);
    for same in [
        "--genes 30000,22000 --threads 2",
        "--genes-file a.gen",
        "--genes-file a.txt -q",
        "--genes-file two.gen --genotype 0",
    ] {
        assert_eq!(evaluate(same), text, "{same}");
    }
    let json: serde_json::Value = serde_json::from_str(&evaluate("--genes 30000,22000 --json")).expect("JSON");
    for name in &names {
        assert_eq!(json[name], value(&text, name), "{name}");
    }
    // A cart that drives off the track breaks down and counts apart.
    let other = evaluate("--genes-file two.gen --genotype 1");
    assert!(value(&other, "broken_down") > 0.0, "{other}");

    // The same numbers as a test of an imported run finds, trial by trial.
    ok(own(), &here, "import a.gen --experiment cart --out a");
    ok(own(), &here, "test a --trials 60 --seed 3");
    let csv = fs::read_to_string(here.join("a/test.csv")).expect("the test");
    let fitness: Vec<f64> = csv.lines().skip(1).filter_map(|line| line.split(',').nth(4)?.parse().ok()).collect();
    let mean = fitness.iter().sum::<f64>() / 60.0;
    let variance = fitness.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 59.0;
    assert_eq!(value(&text, "mean_fitness"), mean);
    assert!((value(&text, "standard_error") - (variance / 60.0).sqrt()).abs() < 1e-12, "{text}");
    assert_eq!(value(&text, "success_rate"), csv.matches(",true,").count() as f64 / 60.0);
    assert_ne!(evaluate("--genes 30000,22000 --set cart.friction=2 --condition smooth"), text);
}

#[test]
fn wrong_genes_are_named() {
    let here = scratch("wrong-genes");
    for (file, text) in [
        ("cut.gen", &GOOD[..GOOD.len() - 4]),
        ("few.gen", "DYNAMICAL NN\n1\nEND\n"),
        ("large.gen", "DYNAMICAL NN\n1\n65536\nEND\n"),
        ("two.gen", "DYNAMICAL NN\n1\n2\nEND\nDYNAMICAL NN\n1\n2\nEND\n"),
        ("empty.gen", ""),
    ] {
        fs::write(here.join(file), text).expect("a file");
    }
    let before = content(&here);
    for (arguments, code, words) in [
        ("evaluate cart", 2, ["--genes"].as_slice()),
        ("evaluate cart --genes 1,2 --genes-file two.gen", 2, &["--genes-file"]),
        ("evaluate catr --genes 1,2", 2, &["unknown experiment `catr`", "nearest is `cart`"]),
        ("evaluate cart --condition smoth --genes 1,2", 2, &["`smooth`"]),
        ("evaluate cart --genes 1,2 --set cart.frictoin=1", 2, &["--set: unknown key", "`cart.friction`"]),
        ("evaluate cart --genes 1,2,3", 2, &["--genes: 3 genes where 2 are expected"]),
        ("evaluate cart --genes 1,65536", 2, &["--genes: gene 1 (the first is 0) is `65536`", "0 to 65535"]),
        ("evaluate cart --genes -1,2", 2, &["--genes: gene 0 (the first is 0) is `-1`"]),
        ("evaluate cart --genes 1,x", 2, &["gene 1 (the first is 0) is `x`, not a whole number from 0 to 65535"]),
        ("evaluate cart --genes 1,2 --trials 0", 2, &["--trials"]),
        ("evaluate cart --genes 1,2 --ir-tables .", 2, &["--ir-tables: cart has no setting `robot.infrared_tables`"]),
        ("evaluate cart --genes 1,2 --genotype 0", 2, &["--genotype"]),
        ("evaluate cart --genes-file none.gen", 2, &["cannot read none.gen"]),
        ("evaluate cart --genes-file two.gen", 2, &["two.gen: holds 2 genotypes", "--genotype"]),
        ("evaluate cart --genes-file two.gen --genotype 2", 2, &["two.gen: genotype 2 of 2"]),
        ("evaluate cart --genes-file cut.gen", 2, &["cut.gen: line 4: truncated", "2 genes so far and no END"]),
        ("import cut.gen --experiment cart --out x", 2, &["cut.gen: line 4: truncated"]),
        ("import two.gen few.gen --experiment cart --out x", 2, &["few.gen: line 1: 1 genes where 2 are expected"]),
        ("import large.gen --experiment cart --out x", 2, &["large.gen: line 3: gene 1", "`65536`"]),
        ("import empty.gen --experiment cart --out x", 2, &["empty.gen: "]),
        ("import none.gen --experiment cart --out x", 2, &["cannot read none.gen"]),
        ("import two.gen --experiment catr --out x", 2, &["nearest is `cart`"]),
        ("import two.gen --experiment cart --ir-tables t --out x", 2, &["--ir-tables: cart has no setting"]),
        ("import two.gen --experiment cart", 2, &["--out"]),
        ("import --experiment cart --out x", 2, &["FILE"]),
    ] {
        let said = say(own(), &here, arguments);
        assert_eq!(said.code, Some(code), "{arguments}: {said:?}");
        for word in words {
            assert!(said.err.contains(word), "{arguments}: no {word:?} in {said:?}");
        }
        assert!(said.out.is_empty() && content(&here) == before, "{arguments}: {said:?}");
    }
}

#[test]
fn imported_genotypes_are_tested_and_replayed_and_nothing_else() {
    let here = scratch("import");
    fs::write(here.join("a.gen"), GOOD).expect("a file");
    fs::write(here.join("b.gen"), GOOD.replace("30000", "20000")).expect("a file");
    let said = ok(own(), &here, "import a.gen b.gen a.gen --experiment cart --set cart.friction=1 --seed 5 --out r");
    assert!(said.starts_with("r: 3 genotypes of 2 genes from a.gen, b.gen, a.gen"), "{said}");
    let manifest = fs::read_to_string(here.join("r/manifest.json")).expect("the manifest");
    assert!(manifest.contains("b.gen"), "{manifest}");
    let replay = |rest: &str| ok(own(), &here, &format!("replay r {rest}"));
    let best = replay("");
    assert_eq!(best, replay("--generation 0 --individual 0"));
    assert_ne!(best, replay("--individual 1"));
    assert_eq!(ok(own(), &here, "test r --trials 4"), ok(own(), &here, "test r --trials 4 --threads 1"));
    assert!(say(own(), &here, "draw r --out a.svg").err.contains("have no bodies to draw"));
    let before = content(&here);
    for (arguments, code, words) in [
        ("run --resume r --generations 3", 2, "imported genotypes, which no evolution has made"),
        ("report r --html r.html", 2, "imported genotypes, which no evolution has made"),
        ("replay r --generation 1", 2, "generation 1 of 1 finished ones"),
        ("replay r --individual 3", 2, "individual 3 of a population of 3"),
        ("import a.gen --experiment cart --out r", 2, "already holds a run"),
    ] {
        let said = say(own(), &here, arguments);
        assert_eq!(said.code, Some(code), "{arguments}: {said:?}");
        assert!(said.err.contains(words), "{arguments}: {said:?}");
        assert!(content(&here) == before, "{arguments}");
    }
    // Another configuration is noticed here too, and so is damage.
    let config = here.join("r/config.toml");
    let text = fs::read_to_string(&config).expect("the configuration");
    fs::write(&config, text.replace("friction = 1.0", "friction = 2.0")).expect("the configuration");
    for command in ["test r", "replay r"] {
        assert!(say(own(), &here, command).err.contains("`cart.friction` = 1.0, not 2.0"));
    }
    fs::write(&config, text).expect("the configuration");
    let mut bytes = fs::read(here.join("r/genotypes.bin")).expect("the genotypes");
    bytes.truncate(40);
    fs::write(here.join("r/genotypes.bin"), bytes).expect("the genotypes");
    let said = say(own(), &here, "replay r");
    assert!(said.code == Some(1) && said.err.contains("genotypes.bin: truncated"), "{said:?}");
}

/// Genotypes of predator-prey as files, the same as lists, and the options for short trials.
const SHORT: &str = "--set trial.steps=80 --set trial.count=2";

fn hunters(here: &std::path::Path) -> [String; 3] {
    let json: serde_json::Value = serde_json::from_str(&ok(farsa(), here, "info predator-prey --json")).expect("JSON");
    let genes = json["genes"].as_u64().expect("a number");
    ["a", "b", "c"].map(|name| {
        let seed = u64::from(name.as_bytes()[0]);
        let genes: Vec<String> = (0..genes).map(|i| (i * 2_654_435_761 * seed % 65_536).to_string()).collect();
        fs::write(here.join(format!("{name}.gen")), format!("DYNAMICAL NN\n{}\nEND\n", genes.join("\n")))
            .expect("a file");
        genes.join(",")
    })
}

#[test]
fn genotypes_of_several_populations_are_evaluated_against_each_other() {
    let here = scratch("evaluate-several");
    let [a, b, _] = hunters(&here);
    let evaluate =
        |rest: &str| ok(farsa(), &here, &format!("evaluate predator-prey --trials 12 --seed 3 {SHORT} {rest}"));
    let text = evaluate(&format!("--genes {a} --genes {b}"));
    let names: Vec<&str> = text.lines().filter_map(|line| line.split(' ').next()).collect();
    let of_each = ["mean_fitness", "standard_error", "success_rate"];
    let expected: Vec<String> =
        ["predator", "prey"].iter().flat_map(|name| of_each.map(|what| format!("{name}_{what}"))).collect();
    assert_eq!(names[..6], expected);
    assert_eq!(names[6..], ["captures_per_trial", "time_s_per_trial", "gap_at_the_end_m_per_trial"]);
    // The gain of one is the loss of the other.
    assert!((value(&text, "predator_mean_fitness") + value(&text, "prey_mean_fitness") - 1.0).abs() < 1e-12, "{text}");
    assert_eq!(value(&text, "predator_success_rate") + value(&text, "prey_success_rate"), 1.0);
    for same in [
        format!("--genes prey={b} --genes predator={a} --threads 1"),
        "--genes-file a.gen --genes-file b.gen".into(),
        format!("--genes-file prey=b.gen --genes predator={a} --genotype 0"),
    ] {
        assert_eq!(evaluate(&same), text, "{same}");
    }
    assert_ne!(evaluate("--genes-file b.gen --genes-file a.gen"), text);
    let json = evaluate("--genes-file a.gen --genes-file b.gen --json");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["populations"][1]["population"], "prey");
    assert_eq!(json["populations"][1]["mean_fitness"], value(&text, "prey_mean_fitness"));
    assert_eq!(
        (&json["mean_fitness"], &json["captures_per_trial"]),
        (&serde_json::Value::Null, &value(&text, "captures_per_trial").into())
    );

    // Imported, they do in a test what they did here, trial by trial.
    let said =
        ok(farsa(), &here, &format!("import prey=b.gen predator=a.gen --experiment predator-prey {SHORT} --out r"));
    assert!(said.starts_with("r: 1 of predator and of prey, "), "{said}");
    ok(farsa(), &here, "test r --trials 12 --seed 3");
    let csv = fs::read_to_string(here.join("r/test.csv")).expect("the test");
    for (column, name) in [("fitness", "predator"), ("fitness of population prey", "prey")] {
        let column = csv.lines().next().and_then(|head| head.split(',').position(|c| c == column)).expect("a column");
        let values = csv.lines().skip(1).filter_map(|line| line.split(',').nth(column)?.parse::<f64>().ok());
        assert_eq!(value(&text, &format!("{name}_mean_fitness")), values.sum::<f64>() / 12.0, "{name}");
    }
}

#[test]
fn exported_genotypes_are_imported_and_do_the_same() {
    let here = scratch("export-genotype");
    ok(own(), &here, "run cart --generations 2 --seed 3 --quiet --out r");
    let printed = ok(own(), &here, "export genotype r");
    let lines: Vec<&str> = printed.lines().collect();
    assert!(
        lines[0].starts_with("**NET : cart") && lines[0].contains(", seed 3, generation 1, individual "),
        "{printed}"
    );
    assert_eq!((lines.len(), lines[1], lines[4]), (5, "DYNAMICAL NN", "END"));
    assert_eq!(ok(own(), &here, "export genotype r --out a.gen"), "");
    assert_eq!(fs::read_to_string(here.join("a.gen")).expect("the file"), printed);
    assert!(say(own(), &here, "export genotype r --out a.gen").err.contains("a.gen: there is one already"));
    assert!(say(own(), &here, "export genotype nowhere").err.contains("nowhere"));
    ok(own(), &here, "import a.gen --experiment cart --out i");
    assert_eq!(ok(own(), &here, "export genotype i").lines().skip(1).collect::<Vec<_>>(), lines[1..]);
    let tested = |run: &str| {
        ok(own(), &here, &format!("test {run} --trials 6"));
        fs::read_to_string(here.join(run).join("test.csv")).expect("the test")
    };
    assert_eq!(tested("r"), tested("i"));

    // One of several populations, by name.
    hunters(&here);
    ok(farsa(), &here, &format!("import a.gen b.gen --experiment predator-prey {SHORT} --out h"));
    for (population, file) in [("predator", "a.gen"), ("prey", "b.gen")] {
        let genes = ok(farsa(), &here, &format!("export genotype h --population {population}"));
        let given = fs::read_to_string(here.join(file)).expect("the file");
        assert!(genes.lines().skip(2).eq(given.lines().filter(|line| !line.starts_with(['*', 'D']))), "{population}");
    }
    for (rest, words) in [
        ("", "--population: predator-prey has 2 populations, predator and prey: name one"),
        (" --population pray", "--population: unknown population `pray`; the nearest is `prey`"),
    ] {
        let said = say(farsa(), &here, &format!("export genotype h{rest}"));
        assert!(said.code == Some(2) && said.err.contains(words), "{said:?}");
    }
}

#[test]
fn imported_populations_meet_in_replays() {
    let here = scratch("import-several");
    hunters(&here);
    let import = |rest: &str| say(farsa(), &here, &format!("import {rest} --experiment predator-prey {SHORT}"));
    assert_eq!(import("predator=a.gen predator=b.gen prey=b.gen prey=c.gen --out r").code, Some(0));
    let config = fs::read_to_string(here.join("r/config.toml")).expect("the configuration");
    assert!(config.contains("\npopulation = 2\n"), "{config}");
    let rewards = |individual: usize, trial: usize| {
        let csv = ok(farsa(), &here, &format!("replay r --individual {individual} --trial {trial}"));
        let head: Vec<&str> = csv.lines().next().expect("a head").split(',').collect();
        let at = |name: &str| head.iter().position(|c| *c == name).unwrap_or_else(|| panic!("{name} in {head:?}"));
        let last: Vec<&str> = csv.lines().last().expect("a line").split(',').collect();
        ["time [s]", "gap at the end [m]", "captures"].map(|name| last[at(name)].to_owned())
    };
    // In trial 0 the first of each play against each other: it is one episode, whichever side records it.
    assert_eq!(rewards(0, 0), rewards(2, 0));
    assert_eq!(rewards(1, 1), rewards(3, 1));
    assert_ne!(rewards(0, 0), rewards(1, 0));
    assert!(say(farsa(), &here, "replay r --individual 4").err.contains("individual 4 of a population of 4"));
    assert_eq!(say(farsa(), &here, "draw r --individual 3 --out a.svg").code, Some(0));
}

#[test]
fn populations_without_genes_are_named() {
    let here = scratch("wrong-populations");
    let [a, b, _] = hunters(&here);
    fs::write(here.join("two.gen"), fs::read_to_string(here.join("a.gen")).expect("a file").repeat(2)).expect("a file");
    let before = content(&here);
    let evaluate = |rest: &str| format!("evaluate predator-prey --trials 2 {rest}");
    let import = |rest: &str| format!("import {rest} --experiment predator-prey --out x");
    for (arguments, words) in [
        (evaluate(&format!("--genes {a}")), ["1 given", "2 populations, predator and prey"]),
        (evaluate(&format!("--genes predator={a}")), ["none for population `prey`", "prey=..."]),
        (evaluate(&format!("--genes predator={a} --genes {b}")), ["everywhere or nowhere", "predator=... prey=..."]),
        (
            evaluate(&format!("--genes pray={a} --genes predator={b}")),
            ["unknown population `pray`", "nearest is `prey`"],
        ),
        (evaluate(&format!("--genes prey={a} --genes prey={b} --genes predator={a}")), ["2 genotypes", "`prey`"]),
        (evaluate("--genes prey=1,2 --genes predator=1"), ["--genes: prey: 2 genes where", "are expected"]),
        (evaluate(&format!("--genes {a} --genes-file b.gen")), ["name the populations", "--genes-file prey=..."]),
        (evaluate("--genes-file a.gen --genes-file two.gen"), ["two.gen: holds 2 genotypes", "--genotype"]),
        (
            evaluate("--genes-file a.gen --genes-file b.gen --genotype 0 --genotype 0 --genotype 0"),
            ["3 numbers", "2 of"],
        ),
        (import("a.gen"), ["FILE: 1 given", "predator and prey"]),
        (import("predator=a.gen predator=b.gen"), ["none for population `prey`", "prey=..."]),
        (import("predatr=a.gen prey=b.gen"), ["unknown population `predatr`", "nearest is `predator`"]),
        (import("two.gen b.gen"), ["2 of predator and 1 of prey", "as many"]),
        (import("a.gen b.gen --set evolution.population=7"), ["`evolution.population`: 1 genotypes", "wants 7"]),
    ] {
        let said = say(farsa(), &here, &arguments);
        let shown = &arguments[..arguments.len().min(120)];
        assert_eq!(said.code, Some(2), "{shown}: {said:?}");
        for word in words {
            assert!(said.err.contains(word), "{shown}: no {word:?} in {said:?}");
        }
        assert!(said.out.is_empty() && content(&here) == before, "{shown}: {said:?}");
    }
}
