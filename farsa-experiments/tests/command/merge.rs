//! Runs of several machines in one place: each once, whole, and nothing overwritten.

use std::fs;
use std::path::Path;

use crate::tool::{content, farsa, ok, own, say, scratch};

/// Two machines: 1 and 2 there, 2 (cut short) and 3 here, and one under another setting.
fn two_machines(here: &Path) {
    let run = "run cart --generations 3 --set trial.steps=50 -q";
    for (place, arguments) in [
        ("node1/runs", "--seed 1"),
        ("node1/runs", "--seed 2"),
        ("node2/runs", "--seed 3"),
        ("node2/sweep/friction=2.0", "--seed 1 --set cart.friction=2"),
    ] {
        let seed = arguments.split(' ').nth(1).expect("a seed");
        ok(own(), here, &format!("{run} {arguments} --out {place}/cart-rough-{seed}"));
    }
    ok(own(), here, "run cart --generations 2 --set trial.steps=50 -q --seed 2 --out node2/runs/cart-rough-2");
    let config = here.join("node2/runs/cart-rough-2/config.toml");
    let text = fs::read_to_string(&config).expect("the configuration");
    // As a run of three generations that was cut short after two.
    fs::write(&config, text.replace("generations = 2\n", "generations = 3\n")).expect("the configuration");
    ok(own(), here, "test node1/runs/cart-rough-2 --trials 5 --seed 9 -q");
}

fn rows(csv: &str) -> Vec<Vec<String>> {
    csv.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn a_table_says_what_differs_and_what_came_of_each() {
    let here = scratch("merge-table");
    two_machines(&here);
    let before = content(&here);
    let said = say(own(), &here, "merge node1 node2");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert_eq!(said.err, "4 runs\nnode2/runs/cart-rough-2: the same run as node1/runs/cart-rough-2\n");
    let rows = rows(&said.out);
    let head = "directory,experiment,condition,strategy,seed,cart.friction,generations,finished,evaluations,failed,best,mean,\
                highest best,test generation,test trials,test broken down,test success,test fitness";
    assert_eq!(rows[0].join(","), head);
    let starts: Vec<String> = rows[1..].iter().map(|row| row[..10].join(",")).collect();
    assert_eq!(
        starts,
        [
            "node1/runs/cart-rough-1,cart,rough,truncation,1,0.5,3,true,60,0",
            "node1/runs/cart-rough-2,cart,rough,truncation,2,0.5,3,true,60,0",
            "node2/runs/cart-rough-3,cart,rough,truncation,3,0.5,3,true,60,0",
            "node2/sweep/friction=2.0/cart-rough-1,cart,rough,truncation,1,2.0,3,true,60,0",
        ]
    );
    for row in &rows[1..] {
        let log = fs::read_to_string(here.join(&row[0]).join("fitness.csv")).expect("the log");
        let log: Vec<Vec<&str>> = log.lines().skip(1).map(|line| line.split(',').collect()).collect();
        assert_eq!((row[10].as_str(), row[11].as_str()), (log[2][1], log[2][2]));
        let best = log.iter().map(|line| line[1].parse::<f64>().expect("a number")).fold(f64::NEG_INFINITY, f64::max);
        assert_eq!(row[12].parse::<f64>().expect("a number"), best);
    }
    let tested: Vec<(&str, &str)> = rows[1..].iter().map(|row| (row[13].as_str(), row[14].as_str())).collect();
    assert_eq!(tested, [("", ""), ("2", "5"), ("", ""), ("", "")]);
    assert_eq!(content(&here), before, "reading changes nothing");

    // Unfinished runs are reported, and are in the table.
    let said = say(own(), &here, "merge node2 --csv table.csv");
    assert_eq!(said.out, "3 runs\nnode2/runs/cart-rough-2: not finished: 2 of 3 generations\n");
    let table = fs::read_to_string(here.join("table.csv")).expect("the table");
    assert!(table.contains("node2/runs/cart-rough-2,cart,rough,truncation,2,0.5,2,false,40,0,"), "{table}");
}

#[test]
fn finished_runs_are_copied_whole_and_again_is_nothing() {
    let here = scratch("merge-copy");
    two_machines(&here);
    fs::create_dir(here.join("node1/runs/cart-rough-1/notes")).expect("a folder");
    fs::write(here.join("node1/runs/cart-rough-1/notes/a.txt"), "dear").expect("a file");
    let sources = || ["node1", "node2"].map(|name| content(&here.join(name)));
    let before = sources();
    let said = say(own(), &here, "merge node1/runs node2/runs node2/sweep --out all --csv all.csv");
    let text = "4 runs, 4 copied\nnode2/runs/cart-rough-2: the same run as node1/runs/cart-rough-2\n";
    assert_eq!((said.code, said.out.as_str()), (Some(0), text), "{said:?}");
    assert_eq!(sources(), before);
    for (from, to) in [
        ("node1/runs/cart-rough-1", "all/cart-rough-1"),
        ("node1/runs/cart-rough-2", "all/cart-rough-2"),
        ("node2/runs/cart-rough-3", "all/cart-rough-3"),
        ("node2/sweep/friction=2.0/cart-rough-1", "all/friction=2.0/cart-rough-1"),
    ] {
        let files = |root: &str| {
            let root = here.join(root);
            let all = content(&root).into_iter();
            let visible = all.map(|(path, bytes)| (path.strip_prefix(&root).expect("within").to_owned(), bytes));
            visible.filter(|(path, _)| !path.to_string_lossy().starts_with('.')).collect::<Vec<_>>()
        };
        assert_eq!(files(from), files(to));
        ok(own(), &here, &format!("test {to} --trials 2 -q"));
        assert!(fs::read_to_string(here.join("all.csv")).expect("it").contains(&format!("\n{to},cart,rough,")));
    }
    assert_eq!(fs::read(here.join("all/cart-rough-1/notes/a.txt")).expect("it"), b"dear");
    assert_eq!(fs::read_dir(here.join("all")).expect("it").count(), 4);

    // Again, with more: what is there stays as it is, also its tests.
    ok(own(), &here, "run cart --generations 3 --set trial.steps=50 -q --seed 9 --out node2/runs/cart-rough-9");
    let there = content(&here.join("all"));
    let said = say(own(), &here, "merge node1/runs node2/runs node2/sweep --out all --json");
    let json: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!((&json["copied"], json["there"].as_array().map(Vec::len)), (&["all/cart-rough-9"][..].into(), Some(4)));
    let now = content(&here.join("all"));
    assert!(there.iter().all(|file| now.contains(file)) && now.len() > there.len());
}

#[test]
fn what_cannot_be_merged_writes_nothing() {
    let here = scratch("merge-refused");
    two_machines(&here);
    let refused = |arguments: &str, code: i32, words: &[&str]| {
        let before = content(&here);
        let said = say(own(), &here, arguments);
        assert_eq!((said.code, said.out.as_str()), (Some(code), ""), "{arguments}: {said:?}");
        for word in words {
            assert!(said.err.contains(word), "{arguments}: no {word:?} in {said:?}");
        }
        assert_eq!(content(&here), before, "{arguments}");
    };
    fs::create_dir(here.join("empty")).expect("a directory");
    refused("merge", 2, &["DIR"]);
    refused("merge nowhere", 2, &["cannot read nowhere"]);
    refused("merge node1 empty", 2, &["empty: holds no run, nor does a folder in it"]);
    refused("merge node1 ./node1", 2, &["./node1: is named twice"]);
    refused("merge node1 --out node1/all", 2, &["--out node1/all: lies in node1, from where the runs come"]);
    refused("merge . --out all", 2, &["--out all: lies in ."]);
    fs::write(here.join("mine.csv"), "mine").expect("a file");
    refused("merge node1 --out all --csv mine.csv", 2, &["mine.csv: there is one already"]);
    // Different runs of one name.
    let two = "node1/runs/cart-rough-1 and node2/sweep/friction=2.0/cart-rough-1 are different runs of one name";
    refused("merge node1/runs node2/sweep/friction=2.0 --out all", 2, &[two]);
    fs::create_dir_all(here.join("taken/cart-rough-3")).expect("a directory");
    fs::write(here.join("taken/cart-rough-3/letter.txt"), "dear").expect("a file");
    refused("merge node1/runs node2/runs --out taken", 2, &["taken/cart-rough-3: already holds other files"]);
    // Another run at its place, and one with fewer generations.
    ok(own(), &here, "merge node2/sweep/friction=2.0 --out other");
    refused("merge node1/runs --out other", 2, &["the run in other/cart-rough-1 has `cart.friction` = 2.0, not 0.5"]);
    ok(own(), &here, "run --resume node2/sweep/friction=2.0/cart-rough-1 --generations 5 -q");
    refused(
        "merge node2/sweep/friction=2.0 --out other",
        2,
        &["other/cart-rough-1: holds 3 generations of the run that has 5 in node2/sweep/friction=2.0/cart-rough-1"],
    );
    // Two tables in one file.
    let said = say(own(), &here, "merge node1 --csv one.csv --curves ./one.csv");
    assert!(said.code == Some(2) && said.err.contains("--curves ./one.csv: two tables need two files"), "{said:?}");
    assert!(!here.join("one.csv").exists());
    // Runs of experiments that this program does not have.
    let said = say(farsa(), &here, "merge node1");
    assert!(said.code == Some(2) && said.err.contains("unknown experiment `cart`"), "{said:?}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../../../mine.csv", here.join("node1/runs/cart-rough-2/link.csv")).expect("a link");
        let said = say(own(), &here, "merge node1/runs --out linked");
        assert_eq!(said.code, Some(2), "{said:?}");
        assert!(said.err.contains("node1/runs/cart-rough-2/link.csv: is no file that can be copied"), "{said:?}");
        // The one before it is whole, and nothing is left of the other.
        assert_eq!(fs::read_dir(here.join("linked")).expect("it").count(), 1);
        fs::remove_file(here.join("node1/runs/cart-rough-2/link.csv")).expect("the link");
        let said = ok(own(), &here, "merge node1/runs --out linked");
        assert_eq!(said, "2 runs, 1 copied, 1 there already\n");
    }
    let record = here.join("node1/runs/cart-rough-2/record.bin");
    let mut bytes = fs::read(&record).expect("the record");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&record, bytes).expect("the record");
    refused("merge node1", 1, &["node1/runs/cart-rough-2/record.bin: "]);
}
