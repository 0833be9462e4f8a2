//! A crate outside the workspace has the same command over its own experiment.

use std::fs;

use crate::tool::{ok, own, say, scratch};

#[test]
fn it_is_listed_and_explained() {
    let here = scratch("own-info");
    assert_eq!(ok(own(), &here, "list"), "cart  a cart learns to stop at the middle of its track [rough, smooth]\n");
    let text = ok(own(), &here, "info cart");
    for line in ["condition: rough (of rough, smooth)", "genome: 2 genes, 32 bits", "network: 2-1, linear"] {
        assert!(text.contains(line), "{text}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&ok(own(), &here, "info cart --condition smooth --json")).expect("JSON");
    assert_eq!(json["genome_bits"], 32);
    assert_eq!((&json["trials"], &json["steps"], &json["step_seconds"]), (&3.into(), &500.into(), &0.01.into()));
    let settings = json["settings"].as_array().expect("a list");
    let setting = |key: &str| settings.iter().find(|setting| setting["key"] == key).expect(key);
    assert_eq!(setting("cart.friction")["default"], 0.0);
    assert_eq!(setting("cart.friction")["source"], "chosen");
    assert_eq!(setting("evolution.mutation_rate")["source"], "given");
    assert_eq!(setting("evolution.population")["default"], 20);
}

#[test]
fn it_learns_and_its_best_life_is_seen_again() {
    let here = scratch("own-run");
    let said = say(own(), &here, "run cart --generations 12 --seed 3");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(said.err.contains("generation 11: best 2."), "{said:?}");
    let run = here.join("runs/cart-rough-3");
    let log = fs::read_to_string(run.join("fitness.csv")).expect("the log");
    let rows: Vec<Vec<f64>> = log
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|field| field.parse().expect("a number")).collect())
        .collect();
    assert_eq!(rows.len(), 12);
    assert!(rows.iter().all(|row| row[1] >= row[2] && row[2] >= row[3] && row[4] == 20.0), "{log}");
    assert!(
        rows[0][5] > 0.0 && rows[11][2] > rows[0][2],
        "some carts leave the track at first, then they learn: {log}"
    );

    // The fitness of every generation's best is earned again by the episode that is rebuilt from the record.
    for (generation, row) in rows.iter().enumerate() {
        let line = format!("replay runs/cart-rough-3 --generation {generation}");
        let said = say(own(), &here, &line);
        assert_eq!(said.code, Some(0), "{said:?}");
        let words = format!("3 trials: 1500 steps, fitness {:.3}\n", row[1]);
        assert!(said.err.ends_with(&words), "{row:?}: {}", said.err);
        let json = ok(own(), &here, &format!("{line} --json --out {generation}.csv"));
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(json["fitness"], row[1]);
    }
    let all = ok(own(), &here, "replay runs/cart-rough-3 --generation 4 --individual 7");
    let one = ok(own(), &here, "replay runs/cart-rough-3 --generation 4 --individual 7 --trial 1");
    let head = "trial,step,time [s],position [m],speed [m/s],force [N]\n";
    let lines =
        |text: &str| text.strip_prefix(head).expect("the columns").lines().map(str::to_owned).collect::<Vec<_>>();
    let of_trial: Vec<String> = lines(&all).into_iter().filter(|line| line.starts_with("1,")).collect();
    assert_eq!(lines(&one), of_trial);

    let table = ok(own(), &here, "test runs/cart-rough-3 --trials 7 --threads 1");
    assert!(table.contains("\nsuccess: "), "{table}");
    let csv = fs::read_to_string(run.join("test.csv")).expect("the test");
    assert_eq!(csv.lines().count(), 8);
    assert_eq!(csv.lines().next(), Some("index,trial,steps,success,fitness,at [m]"));
    let starts: Vec<&str> =
        csv.lines().skip(1).filter_map(|line| line.split_once(",true,")).map(|pair| pair.1).collect();
    let other = ok(own(), &here, "test runs/cart-rough-3 --trials 7 --threads 2");
    assert_eq!(table, other);
    assert_eq!(csv, fs::read_to_string(run.join("test.csv")).expect("the test"));
    assert!(starts.windows(2).all(|pair| pair[0] != pair[1]), "every trial has a start of its own: {csv}");
    assert_ne!(table, ok(own(), &here, "test runs/cart-rough-3 --trials 7 --seed 2"));
}

#[test]
fn the_configuration_of_a_run_repeats_it() {
    let here = scratch("own-config");
    ok(own(), &here, "run cart --condition smooth --generations 3 --seed 5 --set cart.motor=switched --out a");
    ok(own(), &here, "run --config a/config.toml --out b");
    for name in ["config.toml", "fitness.csv", "champion.bin", "record.bin", "lineage.csv"] {
        let read = |run: &str| fs::read(here.join(run).join(name)).expect(name);
        assert_eq!(read("a"), read("b"), "{name}");
    }
    let text = fs::read_to_string(here.join("a/config.toml")).expect("the configuration");
    assert!(text.contains("motor = \"switched\"") && text.contains("condition = \"smooth\""), "{text}");
    // The command line has precedence over the file.
    ok(own(), &here, "run --config a/config.toml --seed 6 --set cart.motor=linear --generations 2 --out c");
    let text = fs::read_to_string(here.join("c/config.toml")).expect("the configuration");
    assert!(
        text.contains("motor = \"linear\"") && text.contains("seed = 6") && text.contains("generations = 2"),
        "{text}"
    );
}

#[test]
fn the_run_tells_who_made_it_and_draws_its_curve() {
    let here = scratch("own-manifest");
    ok(own(), &here, "run cart --generations 2 --threads 1 --out r");
    ok(own(), &here, "run --resume r --generations 3 --threads 2");
    let text = fs::read_to_string(here.join("r/manifest.json")).expect("the manifest");
    let manifest: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!((&manifest["experiment"], &manifest["seed"]), (&"cart".into(), &1.into()));
    let sessions = manifest["sessions"].as_array().expect("a list");
    let told = |key: &str| sessions.iter().map(|session| session[key].as_u64().unwrap_or(99)).collect::<Vec<_>>();
    assert_eq!((told("threads"), told("generations")), (vec![1, 2], vec![2, 1]));
    assert_eq!((told("first_generation"), told("evaluations")), (vec![0, 2], vec![40, 20]));
    assert!(sessions[0]["machine"]["os"].is_string() && sessions[0]["seconds"].is_f64());
    let plot = fs::read_to_string(here.join("r/fitness.svg")).expect("the plot");
    assert!(plot.starts_with("<svg") && plot.contains("cart-rough-1") && plot.contains("worst"));
}
