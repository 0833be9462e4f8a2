//! Genotypes from elsewhere: evaluated, and imported as a directory that can be tested and replayed.

use std::fs;

use crate::tool::{content, ok, own, say, scratch};

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
        ("evaluate cart --genes-file none.gen", 1, &["cannot read none.gen"]),
        ("evaluate cart --genes-file two.gen", 2, &["two.gen: holds 2 genotypes", "--genotype"]),
        ("evaluate cart --genes-file two.gen --genotype 2", 2, &["two.gen: genotype 2 of 2"]),
        ("evaluate cart --genes-file cut.gen", 1, &["cut.gen: line 4: truncated", "2 genes so far and no END"]),
        ("import cut.gen --experiment cart --out x", 1, &["cut.gen: line 4: truncated"]),
        ("import two.gen few.gen --experiment cart --out x", 1, &["few.gen: line 1: 1 genes where 2 are expected"]),
        ("import large.gen --experiment cart --out x", 1, &["large.gen: line 3: gene 1", "`65536`"]),
        ("import empty.gen --experiment cart --out x", 1, &["empty.gen: "]),
        ("import none.gen --experiment cart --out x", 1, &["cannot read none.gen"]),
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
