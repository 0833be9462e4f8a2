//! Reports have the numbers and commands of their runs, and overwrite nothing.

use std::fs;
use std::path::Path;

use crate::tool::{command, content, farsa, ok, own, say, scratch};

/// Two conditions with two seeds each, of different lengths. One run has no test.
fn four_runs(here: &Path) {
    for (condition, seed, generations) in [("rough", 1, 4), ("rough", 2, 5), ("smooth", 1, 6), ("smooth", 2, 4)] {
        let run = format!("run cart --condition {condition} --seed {seed} --generations {generations}");
        ok(own(), here, &format!("{run} --quiet"));
    }
    for run in ["rough-1", "rough-2", "smooth-1"] {
        ok(own(), here, &format!("test runs/cart-{run} --trials 6 --seed 3 --quiet"));
    }
}

const FOUR: &str = "runs/cart-rough-1 runs/cart-rough-2 runs/cart-smooth-1 runs/cart-smooth-2";

/// Reads a column of a run's log.
fn log(here: &Path, run: &str, column: usize) -> Vec<f64> {
    let text = fs::read_to_string(here.join("runs").join(run).join("fitness.csv")).expect("the log");
    text.lines().skip(1).map(|line| line.split(',').nth(column).expect("a field").parse().expect("a number")).collect()
}

/// Formats a number like the report. Fitness of the cart is between 1 and 10.
fn short(x: f64) -> String {
    format!("{x:.4}")
}

#[test]
fn four_runs_on_a_page() {
    let here = scratch("report-four");
    four_runs(&here);
    let output = ok(own(), &here, &format!("report {FOUR} --html page.html --md page.md"));
    assert_eq!(output, "4 runs: page.html, page.md, page-fitness-1.svg, page-fitness-2.svg\n");
    let html = fs::read_to_string(here.join("page.html")).expect("the page");
    let md = fs::read_to_string(here.join("page.md")).expect("the page");
    assert_eq!(html.matches("<svg").count(), 2);
    for tag in ["<script", "<link", "src=", "@import", "url("] {
        assert!(!html.contains(tag), "the page wants something else: {tag}");
    }
    assert!(html.contains("name=\"viewport\"") && html.contains("prefers-color-scheme: dark"));

    // The medians of two runs at the last common generation, 3, with the quartiles between them.
    for (condition, column, cell) in [("rough", 1, 2), ("rough", 2, 3), ("smooth", 1, 2), ("smooth", 2, 3)] {
        let mut two = [1, 2].map(|seed| log(&here, &format!("cart-{condition}-{seed}"), column)[3]);
        two.sort_by(f64::total_cmp);
        let [low, high] = two;
        let quartiles = [0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high].map(short);
        let expected = format!("{} ({} to {})", short(0.5 * low + 0.5 * high), quartiles[0], quartiles[1]);
        let row = md.lines().find(|line| line.starts_with(&format!("| {condition} | 2 | "))).expect("a row");
        let value = row.split(" | ").nth(cell).expect("a cell");
        assert_eq!(value, expected, "{row}");
        assert!(html.contains(&format!(">{expected}<")), "{expected}");
    }
    assert!(md.contains("at generation 3, the last common one"));
    // Only two comparisons, because a run without a test prevents that of the tests.
    assert_eq!(md.lines().filter(|line| line.starts_with("| rough | smooth | ")).count(), 2);
    // Differences precede the common results.
    assert!(md.contains("| cart.friction | 0.5 | 0.0 | 1/s |"), "{md}");
    assert!(md.find("### Differences") < md.find("### Fitness"));
    for line in [
        "| seeds | 1, 2 | 1, 2 |",
        "| generations | 4, 5 | 6, 4 |",
        "| evolution.mutation_rate | 0.015 |",
        "| cart.motor | \"linear\" |  | chosen | Continuous or full force. |",
        "| evolution.generations | 4 / 5 / 6 |  | set; the default ",
        "own-experiment test runs/cart-smooth-2\n",
        "own-experiment test runs/cart-rough-2 --trials 6 --seed 3\n",
        "own-experiment run cart --condition smooth --seed 1 --generations 6 --out runs/cart-smooth-1-again\n",
        "own-experiment replay runs/cart-rough-1\n",
    ] {
        assert!(md.contains(line), "no {line:?} in {md}");
    }
    assert!(md.contains(&format!("own-experiment report {FOUR} --html page.html --md page.md\n")), "{md}");
    for n in [1, 2] {
        let svg = fs::read_to_string(here.join(format!("page-fitness-{n}.svg"))).expect("a picture");
        assert!(svg.starts_with("<svg") && svg.contains("rough, 2 runs") && svg.contains("smooth, 2 runs"));
        assert!(md.contains(&format!("(<page-fitness-{n}.svg>)")));
        assert_eq!(svg.matches("<polygon").count(), 2, "a band for each condition");
    }

    // A second report has the same bytes, and a command of the page repeats the run.
    for file in ["page.html", "page.md", "page-fitness-1.svg", "page-fitness-2.svg"] {
        fs::copy(here.join(file), here.join(format!("first-{file}"))).expect("the file");
    }
    ok(own(), &here, &format!("report {FOUR} --html page.html --md page.md --quiet"));
    for file in ["page.html", "page.md", "page-fitness-1.svg", "page-fitness-2.svg"] {
        let first = fs::read(here.join(format!("first-{file}"))).expect("the first");
        assert!(fs::read(here.join(file)).expect("the second") == first, "{file}");
    }
    let command = md.lines().find(|line| line.contains("--out runs/cart-smooth-1-again")).expect("the command");
    ok(own(), &here, command.trim_start_matches("own-experiment "));
    let bytes = |run: &str| fs::read(here.join("runs").join(run).join("fitness.csv")).expect("the log");
    assert_eq!(bytes("cart-smooth-1"), bytes("cart-smooth-1-again"));
}

#[test]
fn one_run_on_a_page() {
    let here = scratch("report-one");
    ok(own(), &here, "run cart --generations 3 --set cart.motor=switched --quiet");
    let json = ok(own(), &here, "report runs/cart-rough-1 --html one.html --json");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let (best, mean) = (log(&here, "cart-rough-1", 1)[2], log(&here, "cart-rough-1", 2)[2]);
    assert_eq!((&json["runs"][0]["best"], &json["runs"][0]["mean"]), (&best.into(), &mean.into()));
    assert_eq!((&json["files"][0], &json["runs"][0]["success"]), (&"one.html".into(), &serde_json::Value::Null));
    let html = fs::read_to_string(here.join("one.html")).expect("the page");
    for piece in [
        "<title>cart-rough-1</title>",
        ">best</text>",
        ">worst</text>",
        "own-experiment test runs/cart-rough-1",
        "--generations 3 --set 'cart.motor=&quot;switched&quot;' --out runs/cart-rough-1-again",
        "set; the default &quot;linear&quot; is chosen",
    ] {
        assert!(html.contains(piece), "no {piece} in {html}");
    }
    assert!(!html.contains("Do they differ?") && !html.contains("Differences"));

    // The test of an earlier champion is labeled as such.
    ok(own(), &here, "test runs/cart-rough-1 --trials 3 --quiet");
    ok(own(), &here, "run --resume runs/cart-rough-1 --generations 5 --quiet");
    ok(own(), &here, "report runs/cart-rough-1 --md later.md");
    let md = fs::read_to_string(here.join("later.md")).expect("the page");
    assert!(md.contains("| generation 2: an earlier one | 3 | "), "{md}");
}

#[test]
fn other_settings_are_another_group_and_twins_are_reported() {
    let here = scratch("report-groups");
    for (name, arguments) in
        [("a", "--seed 1"), ("b", "--seed 2"), ("c", "--seed 1 --set cart.friction=0.75"), ("twin of a", "--seed 1")]
    {
        let arguments: Vec<&str> =
            "run cart --quiet --generations 3".split(' ').chain(arguments.split(' ')).chain(["--out", name]).collect();
        assert!(command(own(), &here, &arguments).status().expect("the program").success());
    }
    let arguments = ["report", "a", "b", "c", "twin of a", "--md", "groups.md"];
    assert!(command(own(), &here, &arguments).status().expect("the program").success());
    let md = fs::read_to_string(here.join("groups.md")).expect("the page");
    assert!(md.contains("| condition | rough, friction=0.5 | rough, friction=0.75 |\n"), "{md}");
    assert!(md.contains("| cart.friction | 0.5 | 0.75 | 1/s |\n"), "{md}");
    assert!(md.contains("Warning: a and twin of a have the same configuration and seed"), "{md}");
    assert!(md.contains("--set 'cart.friction=0.75' --out c-again\n"), "{md}");
    assert!(md.contains("own-experiment replay 'twin of a'\n"), "{md}");
}

#[test]
fn a_robot_is_drawn_and_a_cart_is_not() {
    let here = scratch("report-draw");
    let short = "run reach-grasp-lift --population 4 --set evolution.parents=2 --set trial.steps=10 --generations 1";
    ok(farsa(), &here, &format!("{short} --out arm --quiet"));
    let output = ok(farsa(), &here, "draw arm --trial 1 --time 0.05 --camera top --size 320x200 --out moment.svg");
    assert!(output.contains("trial 1, 0.05 s, reach, camera top: 320x200"), "{output}");
    assert!(fs::read_to_string(here.join("moment.svg")).expect("the picture").starts_with("<svg"));
    assert!(ok(farsa(), &here, "draw arm --size 64x48 --out end.png --quiet").is_empty());
    assert!(fs::read(here.join("end.png")).expect("the picture").starts_with(b"\x89PNG"));
    // A sheet of a test's cases shows the outcomes of the test.
    let output = ok(farsa(), &here, "draw arm --protocol labels --trial 1 --seed 5 --size 120x90 --out cases.svg");
    assert!(output.contains("trial 1, test seed 5: 3 cases"), "{output}");
    ok(farsa(), &here, "test arm --protocol labels --trials 2 --seed 5 --quiet");
    let sheet = fs::read_to_string(here.join("cases.svg")).expect("the sheet");
    assert_eq!(sheet.matches("<svg").count(), 1 + 3);
    let table = fs::read_to_string(here.join("arm/protocols/labels.csv")).expect("the table");
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let result = if fields[7] == "true" { "success" } else { "no success" };
        let held_out = if fields[3] == "true" { ", held out" } else { "" };
        let label = format!("{} {}", fields[1], fields[2]);
        assert!(fields[4] != "1" || sheet.contains(&format!("{}{held_out}: {result}", label.trim_end())), "{line}");
    }
    ok(farsa(), &here, "report arm --html arm.html --md arm.md");
    assert_eq!(fs::read_to_string(here.join("arm.html")).expect("the page").matches("<figure><svg").count(), 3);
    assert!(fs::read_to_string(here.join("arm.md")).expect("the page").contains("![champion](<arm-champion-1.svg>)"));
    ok(farsa(), &here, "replay arm --html trial.html --compare arm --quiet");
    ok(own(), &here, "run cart --generations 1 --out cart --quiet");
    // Pictures replace their earlier versions, and other files stay.
    for (line, name) in [
        ("draw arm --size 64x48 --out end.png --trial 2 --quiet", "end.png"),
        ("draw arm --protocol labels --size 120x90 --out cases.svg --quiet", "cases.svg"),
        ("check reach-grasp-lift --graph graph.svg --quiet", "graph.svg"),
    ] {
        ok(farsa(), &here, line);
        let first = fs::read(here.join(name)).expect("the picture");
        ok(farsa(), &here, line);
        assert!(fs::read(here.join(name)).expect("the picture") == first, "{name}");
        let mine = format!("mine.{}", &name[name.len() - 3..]);
        fs::write(here.join(mine), [first.as_slice(), b" "].concat()).expect("a changed picture");
    }
    for (program, arguments, words) in [
        (farsa(), "draw arm --out mine.png", "mine.png: there is one already"),
        // Refused before the search for a trial, which may be slow.
        (farsa(), "draw arm --trial 99 --out mine.png", "mine.png: there is one already"),
        (farsa(), "draw arm --protocol labls --out mine.svg", "there is one already"),
        (farsa(), "draw arm --out end.gif", "ends in .svg or .png"),
        (farsa(), "draw arm --protocol labls --out new.svg", "the nearest is `labels`"),
        (farsa(), "draw arm --protocol labels --out new.png", "ends in .svg"),
        (farsa(), "draw arm --protocol labels --out mine.svg", "there is one already"),
        (farsa(), "draw arm --protocol labels --size 9999x10 --out new.svg", "16 to 2048"),
        (farsa(), "draw arm --protocol labels --time 0.1 --out new.svg", "cannot be used with"),
        (farsa(), "draw arm --seed 2 --out new.svg", "--protocol"),
        (own(), "draw cart --protocol labels --out new.svg", "has none"),
        (farsa(), "draw arm --camera tpo --out new.svg", "nearest is `top`"),
        (farsa(), "draw arm --size 20 --out new.svg", "not of the form 1200x800"),
        (farsa(), "draw arm --time 7 --out new.svg", "from 0.01 to 0.1 s"),
        (farsa(), "replay arm --html new.html --out new.csv", "cannot be used with"),
        (farsa(), "replay arm --compare arm", "--html"),
        (own(), "draw cart --out new.svg", "have no bodies to draw"),
    ] {
        let output = say(program, &here, arguments);
        assert_eq!((output.code, output.out.as_str()), (Some(2), ""), "{arguments}: {output:?}");
        assert!(output.err.contains(words), "{arguments}: {output:?}");
    }
    assert!(!here.join("new.svg").exists() && !here.join("new.html").exists());
}

#[test]
fn refused_reports_write_nothing() {
    let here = scratch("report-bad");
    ok(own(), &here, "run cart --generations 3 --out a --quiet");
    ok(own(), &here, "test a --trials 3 --quiet");
    fs::create_dir(here.join("letters")).expect("a directory");
    fs::write(here.join("there.html"), "mine").expect("a file");
    fs::write(here.join("there.md"), "mine").expect("a file");
    fs::write(here.join("x-fitness-1.svg"), "mine").expect("a file");
    let refused = |arguments: &str, code: i32, words: &[&str]| {
        let before = content(&here);
        let output = say(own(), &here, arguments);
        assert_eq!((output.code, output.out.as_str()), (Some(code), ""), "{arguments}: {output:?}");
        for word in words {
            assert!(output.err.contains(word), "{arguments}: no {word:?} in {output:?}");
        }
        assert!(content(&here) == before, "{arguments} changed a file");
    };
    refused("report a", 2, &["<--html <FILE>|--md <FILE>>"]);
    refused("report --html new.html", 2, &["DIR"]);
    refused("report a nowhere --html new.html", 2, &["nowhere: there is no such directory"]);
    refused("report letters a --html new.html", 2, &["letters: holds no run"]);
    refused("report a ./a --html new.html", 2, &["./a: is named twice"]);
    refused("report a --html there.html", 2, &["there.html: there is one already"]);
    refused("report a --html new.html --md there.md", 2, &["there.md: there is one already"]);
    refused("report a --html new.html --md x.md", 2, &["x-fitness-1.svg: there is one already"]);
    refused("report a --html none/new.html", 2, &["none/new.html: there is no folder none"]);
    for (file, damaged, words) in [
        ("test.csv", "index,trial\n0,0\n", "test.csv: is not the table of a test"),
        ("test.csv", "index,trial,steps,success,fitness,at [m]\n0,0,5,true,x,1\n", "test.csv: line 2 "),
        ("test.json", "{}", "test.json: "),
        ("record.bin", "generation,best\n", "record.bin: truncated"),
        ("manifest.json", "{", "manifest.json: "),
        ("manifest.json", "{\"format\": 2}", "manifest.json: has format 2, this program reads format 1"),
    ] {
        let path = here.join("a").join(file);
        let intact = fs::read(&path).expect("the file");
        fs::write(&path, damaged).expect("the file");
        refused("report a --html new.html", 1, &[words]);
        fs::write(&path, intact).expect("the file");
    }
    // A changed log has no effect on the report, which reads the record.
    ok(own(), &here, "report a --md new.md");
    let path = here.join("a/fitness.csv");
    let intact = fs::read_to_string(&path).expect("the log");
    fs::write(&path, intact.replacen("0,2.", "0,3.", 1).replacen("0,1.", "0,9.", 1)).expect("the log");
    ok(own(), &here, "report a --md again.md");
    let text = |file: &str| fs::read_to_string(here.join(file)).expect("it");
    // The last line is the mark with the checksum.
    let [new, again] = ["new.md", "again.md"].map(|file| text(file).rsplit_once("<!-- ").expect("a mark").0.to_owned());
    assert_eq!(again.replace("again-", "new-").replace("again.md", "new.md"), new);
    ok(own(), &here, "report a --html new.html");
}

#[test]
fn each_population_has_its_curves_and_columns() {
    let here = scratch("report-populations");
    let short = "--generations 3 --population 4 --set evolution.parents=2 --set trial.steps=40 --set trial.count=2";
    for seed in [1, 2] {
        ok(farsa(), &here, &format!("run predator-prey --seed {seed} {short} --quiet"));
    }
    let picture = fs::read_to_string(here.join("runs/predator-prey-1/fitness.svg")).expect("the picture");
    for title in ["predator-prey-1: predator", "predator-prey-1: prey"] {
        assert_eq!(picture.matches(&format!(">{title}<")).count(), 1, "{title}");
    }
    // The log has best, mean and worst of each population from column 6.
    let last = |column: usize| short_of(&log(&here, "predator-prey-1", column));
    ok(farsa(), &here, "report runs/predator-prey-1 --md one.md");
    let md = fs::read_to_string(here.join("one.md")).expect("the page");
    assert!(md.contains("Best, mean and worst individual of the prey of every generation"), "{md}");
    let row = md.lines().find(|line| line.starts_with("| runs/predator-prey-1 | ")).expect("a row");
    let head =
        "| last best, predator | last mean, predator | highest best, predator | last best, prey | last mean, prey |";
    assert!(md.contains(head), "{md}");
    let cells: Vec<&str> = row.split(" | ").collect();
    assert_eq!(
        [cells[4], cells[5], cells[7], cells[8]],
        [last(6), last(7), last(9), last(10)].each_ref().map(String::as_str)
    );
    let output = ok(farsa(), &here, "report runs/predator-prey-1 runs/predator-prey-2 --md two.md");
    assert!(output.contains("two-fitness-4.svg") && !output.contains("two-fitness-5.svg"), "{output}");
    let md = fs::read_to_string(here.join("two.md")).expect("the page");
    assert!(md.contains("Best of the generation, predator. ") && md.contains("Mean of the generation, prey. "), "{md}");
    assert!(md.contains("| condition | runs | best, predator | mean, predator | best, prey | mean, prey |"), "{md}");

    // The picture of a resumed run includes its earlier part. A log of another form is refused.
    let before = fs::read(here.join("runs/predator-prey-2/fitness.svg")).expect("the picture");
    ok(farsa(), &here, &format!("run predator-prey --seed 3 {short} --quiet --out whole"));
    ok(
        farsa(),
        &here,
        &format!("run predator-prey --seed 3 {} --quiet --out parts", short.replace("generations 3", "generations 1")),
    );
    ok(farsa(), &here, "run --resume parts --generations 3 --quiet");
    for file in ["fitness.csv", "champion.bin"] {
        assert!(
            fs::read(here.join("whole").join(file)).expect("a file")
                == fs::read(here.join("parts").join(file)).expect("a file"),
            "{file}"
        );
    }
    let [uninterrupted, resumed] =
        ["whole", "parts"].map(|run| fs::read(here.join(run).join("fitness.svg")).expect("the picture"));
    assert!(uninterrupted == resumed && uninterrupted != before);
    let path = here.join("parts/fitness.csv");
    let text = fs::read_to_string(&path).expect("the log");
    let six =
        text.lines().map(|line| line.splitn(7, ',').take(6).collect::<Vec<_>>().join(",") + "\n").collect::<String>();
    fs::write(&path, six).expect("the log");
    let output = say(farsa(), &here, "run --resume parts --generations 3");
    assert!(output.code == Some(0) && output.err.contains("fitness-changed-1.csv"), "{output:?}");
    assert_eq!(fs::read_to_string(&path).expect("the log"), text);
}

/// Formats the last number like the report.
fn short_of(numbers: &[f64]) -> String {
    let x = *numbers.last().expect("a number");
    if x != 0.0 && x.abs() < 1e-3 { format!("{x:.3e}") } else { short(x) }
}

#[test]
fn conditions_are_compared_at_equal_evaluations_and_by_their_successes() {
    let here = scratch("report-successes");
    // Generations of 20 and of 8 individuals.
    let mut runs = Vec::new();
    for seed in 1..=4 {
        for (name, arguments) in [("many", ""), ("few", " --population 8 --set evolution.parents=2")] {
            let run = format!("run cart --generations 6 --set trial.steps=100 --seed {seed}{arguments}");
            ok(own(), &here, &format!("{run} --out runs/{name}-{seed} -q"));
            runs.push(format!("runs/{name}-{seed}"));
        }
    }
    let best = |name: &str| [1, 2, 3, 4].map(|seed| log(&here, &format!("{name}-{seed}"), 1));
    let highest = |name: &str| best(name).map(|log| log.into_iter().fold(f64::NEG_INFINITY, f64::max));
    let (many, few) = (highest("many"), highest("few"));
    // A fitness that only some runs reach: the third of those with many individuals.
    let mut sorted = many;
    sorted.sort_by(f64::total_cmp);
    let threshold = sorted[1];
    let line = format!("report {} --success-fitness {threshold}", runs.join(" "));
    ok(own(), &here, &format!("{line} --md page.md --html page.html"));
    let md = fs::read_to_string(here.join("page.md")).expect("the page");

    // 48 evaluations are six generations of the few and two of the many.
    assert!(md.contains("after 48 evaluations, the largest common number"), "{md}");
    for (name, label, generation) in [("many", "population=20", 1), ("few", "population=8", 5)] {
        let mut at = best(name).map(|log| log[generation]);
        at.sort_by(f64::total_cmp);
        let median = short(0.5 * at[1] + 0.5 * at[2]);
        let row = md.lines().find(|line| line.contains(label) && line.contains(" | 4 | ")).expect("a row");
        assert!(row.contains(&format!("| 4 | {median} (")), "{row}: no {median}");
    }
    let picture = fs::read_to_string(here.join("page-fitness-1.svg")).expect("the picture");
    assert!(picture.contains("evaluations") && !picture.contains(">generation<"), "{picture}");

    let reached = |runs: [f64; 4]| runs.iter().filter(|best| **best >= threshold).count();
    assert_eq!(reached(many), 3);
    // Three of four by Wilson's score: scipy.stats.binomtest(3, 4).proportion_ci(method="wilson").
    assert!(md.contains(" | 3 | 4 | 75.0 % | 30.1 % to 95.4 % |"), "{md}");
    assert!(md.contains(&format!(" | {} | 4 | ", reached(few))), "{md}");
    let test = md.lines().find(|line| line.contains("| 3 of 4 |") || line.contains(" of 4 | 3 of 4 |")).expect("a row");
    assert!(test.contains(&format!("{} of 4", reached(few))), "{test}");
    assert!(md.contains(&format!("--md page.md --success-fitness {threshold}\n")), "the page's own command");
    // A second report has the same bytes.
    ok(own(), &here, &format!("{} --success-fitness {threshold} --md again.md", line.split(" --").next().expect("it")));
    let again = fs::read_to_string(here.join("again.md")).expect("the page");
    let again =
        again.replace("again-fitness", "page-fitness").replace("--md again.md", "--html page.html --md page.md");
    // The last line is the mark with the checksum.
    let body = |text: &str| text.rsplit_once("<!-- ").expect("a mark").0.to_owned();
    assert!(body(&again) == body(&md), "{again}");

    for (arguments, words) in [
        ("--success-share 1.5", "not a share from 0 to 1"),
        ("--success-fitness inf", "not a number"),
        ("--success-fitness 1 --success-share 1", "cannot be used with"),
    ] {
        let output = say(own(), &here, &format!("report runs/many-1 {arguments} --md new.md"));
        assert!(output.code == Some(2) && output.err.contains(words), "{arguments}: {output:?}");
    }
    assert!(!here.join("new.md").exists());
}

#[test]
fn tests_of_champions_are_counted_too() {
    let here = scratch("report-shares");
    for (condition, seed) in [("rough", 1), ("rough", 2), ("smooth", 1), ("smooth", 2)] {
        ok(own(), &here, &format!("run cart --condition {condition} --seed {seed} --generations 4 -q"));
        ok(own(), &here, &format!("test runs/cart-{condition}-{seed} --trials 8 -q"));
    }
    ok(own(), &here, &format!("report {FOUR} --md none.md --success-share 0"));
    let md = fs::read_to_string(here.join("none.md")).expect("the page");
    for label in ["rough", "smooth"] {
        assert!(md.contains(&format!("| {label} | 2 | 2 | 100.0 % | 34.2 % to 100.0 % |\n")), "{md}");
    }
    assert!(md.contains("| rough | smooth | 2 of 2 | 2 of 2 | 1.0000 |\n"), "{md}");
    assert!(md.contains("at least 0.0 % of the trials of its champion's test"), "{md}");
}
