//! Many settings by one file: each point as its own command would make it, shared by processes, refused as a whole.

use std::fs;
use std::path::Path;

use crate::tool::{Running, command, content, farsa, json, ok, own, results, say, scratch};

const FILE: &str = r#"
experiment = "cart"
seed = 4
replications = 2

[evolution]
generations = 3

[trial]
steps = 100

[grid]
condition = ["rough", "smooth"]
cart.friction = [0, 1.5]

[list]
evolution.population = [20, 10]
evolution.parents = [5, 2]
"#;

/// The points of the file, in their order.
fn points() -> Vec<(String, String)> {
    let mut points = Vec::new();
    for condition in ["rough", "smooth"] {
        for friction in ["0.0", "1.5"] {
            for (population, parents) in [(20, 5), (10, 2)] {
                let name =
                    format!("condition={condition},friction={friction},population={population},parents={parents}");
                let arguments = format!(
                    "run cart --condition {condition} --set cart.friction={friction} --population {population} --set \
                     evolution.parents={parents} --generations 3 --set trial.steps=100"
                );
                points.push((name, arguments));
            }
        }
    }
    points
}

#[test]
fn each_point_is_what_its_own_command_makes() {
    let here = scratch("sweep-points");
    fs::write(here.join("friction.toml"), FILE).expect("the file");
    // The list begins nothing.
    let listed = json(&ok(own(), &here, "sweep friction.toml --list --json"));
    assert_eq!(fs::read_dir(&here).expect("a directory").count(), 1);
    let listed = listed["points"].as_array().expect("a list");
    assert_eq!(listed.len(), 8);
    for (point, (name, _)) in listed.iter().zip(points()) {
        assert_eq!(point["directory"], format!("runs/friction/{name}"));
        assert_eq!((&point["replications"], point["runs"].as_array().map(Vec::len)), (&2.into(), Some(0)));
    }

    // One point alone, one replication of it, then all.
    let said = say(own(), &here, "sweep friction.toml --point 3 --replication 2");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(said.err.contains("point 3 of 8, replication 2 of 2: runs/friction/condition=rough,"), "{said:?}");
    assert_eq!(fs::read_dir(here.join("runs/friction")).expect("it").count(), 1);
    let said = say(own(), &here, "sweep friction.toml");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert_eq!(said.err.matches("all 3 generations are finished already").count(), 1, "{said:?}");
    assert_eq!(said.out.lines().filter(|line| line.contains(" 2 of 2 ")).count(), 8, "{said:?}");
    for (name, arguments) in points() {
        let condition = if name.starts_with("condition=rough") { "rough" } else { "smooth" };
        for seed in [4, 5] {
            let single = format!("single/{name}-{seed}");
            ok(own(), &here, &format!("{arguments} --seed {seed} --out {single} -q"));
            let run = here.join(format!("runs/friction/{name}/cart-{condition}-{seed}"));
            assert_eq!(results(&run), results(&here.join(single)), "{name}, seed {seed}");
        }
    }

    // Again: nothing is evaluated or touched, and the list has the same medians.
    let before = content(&here);
    assert_eq!(ok(own(), &here, "sweep friction.toml"), said.out);
    assert_eq!(ok(own(), &here, "sweep friction.toml --list"), said.out);
    assert_eq!(content(&here), before);
    // A value more leaves the points that are there as they are.
    let more = FILE.replace("cart.friction = [0, 1.5]", "cart.friction = [3, 0, 1.5]");
    fs::write(here.join("more.toml"), more).expect("the file");
    let listed = json(&ok(own(), &here, "sweep more.toml --out runs/friction --list --json"));
    let done = listed["points"].as_array().expect("a list").iter().filter(|point| !point["median"].is_null());
    assert_eq!(done.count(), 8);
    // The points are groups of a report.
    let runs: Vec<String> = points()[..2]
        .iter()
        .flat_map(|(name, _)| [4, 5].map(|seed| format!("runs/friction/{name}/cart-rough-{seed}")))
        .collect();
    ok(own(), &here, &format!("report {} --md report.md", runs.join(" ")));
    let md = fs::read_to_string(here.join("report.md")).expect("the report");
    assert!(md.contains("| evolution.population | 20 | 10 |  |"), "{md}");
}

#[test]
fn processes_share_the_points_and_a_killed_one_is_gone_on_with() {
    let here = scratch("sweep-shared");
    fs::write(here.join("friction.toml"), FILE.replace("generations = 3", "generations = 200")).expect("the file");
    ok(own(), &here, "sweep friction.toml --out one -q");
    let arguments = ["sweep", "friction.toml", "--threads", "1", "--quiet"];
    let start = || Running::start(&mut command(own(), &here, &arguments));
    let (mut first, others) = (start(), [start(), start()]);
    let begun = || fs::read_dir(here.join("runs/friction")).map_or(0, Iterator::count);
    first.until("second point", || begun() >= 2);
    drop(first);
    for other in others {
        let said = other.end();
        assert_eq!(said.code, Some(0), "{said:?}");
    }
    // The files of the killed process, unless another has taken them by then.
    ok(own(), &here, "sweep friction.toml -q");
    for (name, _) in points() {
        let condition = if name.starts_with("condition=rough") { "rough" } else { "smooth" };
        for seed in [4, 5] {
            let run = |root: &str| here.join(root).join(&name).join(format!("cart-{condition}-{seed}"));
            assert_eq!(results(&run("one")), results(&run("runs/friction")), "{name}, seed {seed}");
        }
    }
}

#[test]
fn a_sweep_is_refused_before_it_begins() {
    let here = scratch("sweep-refused");
    let refused = |text: &str, arguments: &str, words: &[&str]| {
        fs::write(here.join("my.toml"), text).expect("the file");
        let before = content(&here);
        let said = say(own(), &here, &format!("sweep {arguments}"));
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{text}: {said:?}");
        for word in words {
            assert!(said.err.contains(word), "{text}: no {word:?} in {said:?}");
        }
        assert_eq!(content(&here), before, "{text}");
    };
    let head = "experiment = \"cart\"\n";
    refused("[grid]\ncart.friction = [1]\n", "my.toml", &["my.toml: names no experiment"]);
    refused(
        "experiment = \"cat\"\n[grid]\nw.x = [1]\n",
        "my.toml",
        &["my.toml line 1: unknown experiment `cat`", "`cart`"],
    );
    for (text, words) in [
        (
            "[grid]\ncart.frictoin = [1]\n",
            "my.toml line 3: unknown key `cart.frictoin`; the nearest is `cart.friction`",
        ),
        ("[grid]\ncart.friction = [\n1,\n11]\n", "my.toml line 5: `cart.friction`: 11 is outside 0.0 to 10.0"),
        ("[grid]\ncart.motor = [\"linear\", \"swiched\"]\n", "my.toml line 3: `cart.motor`: "),
        (
            "[grid]\ncondition = [\"rough\", \"rugh\"]\n",
            "my.toml line 3: unknown condition `rugh`; the nearest is `rough`",
        ),
        ("[grid]\nevolution.parents = [5, 30]\n", "my.toml: point 2 (parents=30): "),
        ("[grid]\ncart.friction = [1, 1.0]\n", "my.toml line 3: point 2 is point 1 again"),
        ("grid.cart = 3\n", "my.toml line 2: `cart`: is not a list of values"),
        ("[grid\n", "my.toml line 2: "),
    ] {
        refused(&format!("{head}{text}"), "my.toml", &[words]);
    }
    let good = format!("{head}evolution.generations = 2\n[grid]\ncart.friction = [1, 2]\n");
    refused(&good, "my.toml --point 3", &["--point 3: there are 2"]);
    refused(&good, "my.toml --point 0", &["not a whole number from 1 to 4294967295"]);
    refused(&good, "my.toml --replication 2", &["--replication 2: there are 1"]);
    refused(&good, "my.toml --lanes 8", &["point 1 (friction=1.0): --lanes 8: cart has 1 only"]);
    // An obstacle for one point is one for all.
    fs::create_dir_all(here.join("runs/my/friction=2.0/cart-rough-1")).expect("a directory");
    fs::write(here.join("runs/my/friction=2.0/cart-rough-1/letter.txt"), "dear").expect("a file");
    refused(&good, "my.toml", &["runs/my/friction=2.0/cart-rough-1: already holds other files"]);
    assert!(!here.join("runs/my/friction=1.0").exists());
    // Another point is not asked for.
    ok(own(), &here, "sweep my.toml --point 1 -q");
    refused(
        &good.replace("[1, 2]", "[1, 3]").replace("[grid]", "trial.steps = 50\n[grid]"),
        "my.toml",
        &["runs/my/friction=1.0/cart-rough-1 has `trial.steps` = 500, not 50"],
    );
    assert!(!Path::new(&here.join("runs/my/friction=3.0")).exists());
}

#[test]
fn strategies_are_points_and_groups_of_a_report() {
    let here = scratch("sweep-strategies");
    let file = "experiment = \"cart\"\nreplications = 3\n[evolution]\ngenerations = 5\n[trial]\nsteps = 60\n[grid]\n\
                strategy.name = [\"truncation\", \"cma-es\", \"xnes\"]\n";
    fs::write(here.join("which.toml"), file).expect("the file");
    ok(own(), &here, "sweep which.toml -q");
    for strategy in ["truncation", "cma-es", "xnes"] {
        let folder = here.join("runs/which").join(format!("strategy={strategy}"));
        let mut runs: Vec<_> =
            fs::read_dir(&folder).expect("the point").map(|run| run.expect("a run").path()).collect();
        runs.sort();
        assert_eq!(runs.len(), 3);
        for (seed, run) in (1..).zip(&runs) {
            let line = format!("run cart --strategy {strategy} --generations 5 --set trial.steps=60 --seed {seed}");
            ok(own(), &here, &format!("{line} --out single/{strategy}-{seed} -q"));
            let files = ["fitness.csv", "champion.bin", "record.bin", "config.toml"];
            for file in files {
                let [a, b] = [run.join(file), here.join(format!("single/{strategy}-{seed}")).join(file)];
                assert_eq!(fs::read(a).expect(file), fs::read(b).expect(file), "{strategy} {seed} {file}");
            }
        }
    }
    let table = ok(own(), &here, "merge runs/which -q");
    for (strategy, runs) in [("truncation", 3), ("cma-es", 3), ("xnes", 3)] {
        assert_eq!(table.matches(&format!(",cart,rough,{strategy},")).count(), runs, "{table}");
    }
    let runs: Vec<String> =
        table.lines().skip(1).filter_map(|line| line.split(',').next().map(str::to_owned)).collect();
    // A directory with a comma in its name is in quotes. These have none.
    assert_eq!(runs.len(), 9);
    ok(own(), &here, &format!("report {} --success-fitness 2 --md which.md", runs.join(" ")));
    let md = fs::read_to_string(here.join("which.md")).expect("the page");
    assert!(md.contains("| condition | rough, cma-es | rough, truncation | rough, xnes |"), "{md}");
    assert!(md.contains("| rough, cma-es | rough, truncation | "), "{md}");
}

#[test]
fn the_studies_of_the_repository_are_valid() {
    // Studies name experiment files by their paths in the repository. Listing writes nothing.
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = here.join("studies");
    let mut studies: Vec<_> = fs::read_dir(folder).expect("it").map(|entry| entry.expect("an entry").path()).collect();
    studies.sort();
    assert!(!studies.is_empty());
    for study in studies {
        let study = study.to_str().expect("a path");
        let listed = json(&ok(farsa(), &here, &format!("sweep {study} --list --json")));
        if study.ends_with("all.toml") {
            assert!(listed["checks"].is_array(), "{study}: {listed}");
            continue;
        }
        let points = listed["points"].as_array().expect("a list");
        let mut runs = points.iter().map(|point| point["replications"].as_u64().expect("a number"));
        assert!(!points.is_empty() && runs.all(|replications| replications >= 10), "{study}: {listed}");
    }
}
