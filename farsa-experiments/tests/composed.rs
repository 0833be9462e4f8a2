//! Experiments from files, through the command.

#[path = "../../farsa-compose/tests/drawn/mod.rs"]
mod drawn;

use std::path::{Path, PathBuf};
use std::process::Command;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments")
}

/// A run that was interrupted, by another number of threads, has the bytes of one that was not, and its trials can be replayed.
#[test]
fn drawn_files_resume_and_replay() {
    let bench = Bench::new("drawn-runs");
    let files = |numbers: std::ops::Range<u32>| {
        for file in numbers {
            let text = drawn::Draw::new(20_261_125, file).file().replace("steps = 100", "steps = 20");
            let name = format!("drawn-{file}");
            let path = bench.path(&format!("{name}.toml"));
            std::fs::write(&path, &text).expect("a file");
            let small = "--population 4 --set evolution.parents=2 -q";
            bench.succeed(&format!("run {name}.toml {small} --generations 3 --threads 1 --out whole-{name}"));
            bench.succeed(&format!("run {name}.toml {small} --generations 1 --threads 2 --lanes 1 --out {name}"));
            std::fs::remove_file(path).expect("the file goes");
            bench.succeed(&format!("run --resume {name} --generations 3 -q"));
            for file in ["fitness.csv", "champion.bin", "lineage.csv"] {
                let [own, whole] = [name.clone(), format!("whole-{name}")]
                    .map(|run| std::fs::read(bench.path(&run).join(file)).expect(file));
                assert!(own == whole, "{file} of\n{text}");
            }
            bench.succeed(&format!("replay {name} --generation 1 --individual 3 -q"));
        }
    };
    // `./ci long` draws more.
    let drawn = std::env::var("FARSA_DRAWN").map_or(60, |drawn| drawn.parse().expect("a number of files"));
    std::thread::scope(|scope| {
        scope.spawn(|| files(0..drawn / 2));
        files(drawn / 2..drawn);
    });
}

/// The command, in a separate folder.
struct Bench(PathBuf);

impl Bench {
    /// An empty one.
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("composed").join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Its output, and its exit code.
    fn say(&self, arguments: &str) -> (String, i32) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_farsa"));
        let output = command.current_dir(&self.0).args(arguments.split(' ')).output().expect("the command");
        let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        (said, output.status.code().unwrap_or(-1))
    }

    fn succeed(&self, arguments: &str) -> String {
        let (said, code) = self.say(arguments);
        assert_eq!(code, 0, "{arguments}: {said}");
        said
    }

    fn refused(&self, arguments: &str) -> String {
        let (said, code) = self.say(arguments);
        assert_eq!(code, 2, "{arguments}: {said}");
        said
    }
}

/// From a template to a page, without the file from the moment the run has begun.
#[test]
fn a_template_is_run_resumed_tested_and_replayed() {
    let bench = Bench::new("templates");
    for template in ["light", "wander", "team"] {
        let name = format!("my-{template}");
        bench.succeed(&format!("new {name} --from {template}"));
        let said = bench.succeed(&format!("check {name}.toml --graph {name}.svg"));
        assert!(said.starts_with(&format!("{name}: ")) && said.contains("infrared"), "{said}");
        assert!(bench.read(&format!("{name}.svg")).contains("infrared"));
        let small = "--population 8 --set evolution.parents=4 --set episode.trials=2 --set episode.steps=50";
        bench.succeed(&format!("run {name}.toml {small} --generations 4 --threads 1 --lanes 1 --out whole-{name} -q"));
        bench.succeed(&format!("run {name}.toml {small} --generations 2 --threads 2 --out {name} -q"));
        std::fs::remove_file(bench.path(&format!("{name}.toml"))).expect("the file goes");
        bench.succeed(&format!("run --resume {name} --generations 4 -q"));
        for file in ["fitness.csv", "champion.bin", "lineage.csv"] {
            let [own, whole] = [name.clone(), format!("whole-{name}")]
                .map(|run| std::fs::read(bench.path(&run).join(file)).expect(file));
            assert!(own == whole, "{template}: {file}");
        }
        bench.succeed(&format!("test {name} --trials 3 -q"));
        bench.succeed(&format!("replay {name} --generation 1 --individual 3 --html {name}.html -q"));
        bench.succeed(&format!("run --config {name}/config.toml --out again-{name} --generations 4 -q"));
        assert_eq!(bench.read(&format!("{name}/fitness.csv")), bench.read(&format!("again-{name}/fitness.csv")));
    }
    bench.succeed("report my-light my-wander --html report.html");
}

/// Both protocols of a file: listed, run, and in the report.
#[test]
fn champions_of_files_are_tested_by_protocols() {
    let bench = Bench::new("protocols");
    bench.succeed("new own --from light");
    let info = bench.succeed("info own.toml");
    assert!(info.contains("\n  lesions ") && info.contains("\n  noise "), "{info}");
    let small = "--population 4 --set evolution.parents=2 --set episode.trials=1 --set episode.steps=20";
    bench.succeed(&format!("run own.toml {small} --generations 2 --out r -q"));
    let said = bench.succeed("test r --protocol lesions --trials 3");
    for case in ["intact", "no infrared", "no light", "no neuron 4", "no output of wheels right"] {
        assert!(said.contains(case), "no {case}: {said}");
    }
    bench.succeed("test r --protocol noise --trials 3 -q");
    for (name, cases) in [("lesions", 1 + 2 + 4 + 2), ("noise", 5)] {
        assert_eq!(bench.read(&format!("r/protocols/{name}.csv")).lines().count(), 1 + 3 * cases, "{name}");
    }
    bench.succeed("report r --html page.html");
    assert!(bench.read("page.html").contains("no output of wheels right"));
    assert!(bench.refused("test r --protocol lesion").contains("the nearest is `lesions`"));
}

#[test]
fn what_is_wrong_with_a_file_is_said_before_anything_is_made() {
    let bench = Bench::new("wrong");
    let said = bench.refused("new follow --from lihgt");
    assert!(said.contains("unknown template `lihgt`; the nearest is `light`") && said.contains("  wander  "), "{said}");
    assert!(bench.refused("new Follow").contains("lower-case"));
    bench.succeed("new follow");
    assert!(bench.refused("new follow").contains("there is one already"));
    let text = bench.read("follow.toml");
    let damaged = text.replace("kind = \"light\"", "kind = \"ligth\"");
    std::fs::write(bench.path("damaged.toml"), &damaged).expect("a file");
    let line = 1 + damaged.lines().position(|line| line.contains("ligth")).expect("the line");
    let message = format!("error: damaged.toml line {line}: unknown kind `ligth`; the nearest is `light`");
    for command in ["check", "info", "run", "bench"] {
        let said = bench.refused(&format!("{command} damaged.toml"));
        assert!(said.starts_with(&message), "{command}: {said}");
    }
    assert!(!bench.path("runs").exists());
    bench.succeed("run follow.toml --generations 1 --population 8 --set evolution.parents=4 -q");
    // Another text is another experiment.
    std::fs::write(bench.path("follow.toml"), text.replace("hidden = 4", "hidden = 5")).expect("a file");
    let said = bench.refused("run follow.toml --resume runs/follow-1 --generations 2");
    assert!(said.contains("definition"), "{said}");
    let (said, code) = bench.say("info no.toml");
    assert!(code == 2 && said.contains("cannot read no.toml"), "{said}");
    let schema: serde_json::Value = serde_json::from_str(&bench.succeed("schema")).expect("JSON");
    assert!(schema.pointer("/properties/sensors").is_some());
}

/// Each channel of every built-in experiment has its place in the drawing.
#[test]
fn built_in_experiments_are_drawn_too() {
    let bench = Bench::new("drawn");
    for experiment in farsa_experiments::all() {
        let name = experiment.name();
        let said = bench.succeed(&format!("check {name} --graph {name}.svg --json"));
        let found: serde_json::Value = serde_json::from_str(&said).expect("JSON");
        let svg = bench.read(&format!("{name}.svg"));
        for group in ["sensors", "motors"] {
            let list = found[group].as_array().expect("a list");
            let mut next = 0;
            for group in list {
                assert_eq!(group["channels"][0], next, "{name}");
                next = group["channels"][1].as_u64().expect("a number");
                let title = group["name"].as_str().expect("a name").split(' ').next().unwrap_or_default();
                assert!(svg.contains(title), "{name}: {title}");
            }
        }
    }
}

/// An archive keeps the places where robots end, and `check` prints them.
#[test]
fn a_maze_is_searched_by_where_robots_end() {
    let bench = Bench::new("maze");
    std::fs::copy(folder().join("maze.toml"), bench.path("maze.toml")).expect("a copy");
    let said = bench.succeed("check maze.toml");
    assert!(said.ends_with("fitness: left\nbehaviour: x 0.0 to 1.5, y 0.0 to 1.0\n"), "{said}");
    let said = bench.succeed("check maze.toml --json");
    let found: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!(found["descriptors"][1], serde_json::json!({ "name": "y", "range": [0.0, 1.0] }));
    assert!(bench.succeed("check double-pole").contains("\nfitness: "));
    let small = "--population 20 --generations 3 --set episode.steps=200 -q";
    bench.succeed(&format!("run maze.toml --set evolution.parents=4 {small} --out novel"));
    bench.succeed(&format!("run maze.toml --strategy map-elites {small} --out elites"));
    let archive = bench.read("elites/archive.csv");
    let (head, rows) = archive.split_once('\n').expect("a head");
    let columns: Vec<&str> = head.split(',').collect();
    let column =
        |name: &str| columns.iter().position(|known| *known == name).unwrap_or_else(|| panic!("{name}: {head}"));
    let ends: Vec<[f64; 2]> = rows
        .lines()
        .map(|row| {
            ["x", "y"].map(|name| row.split(',').nth(column(name)).and_then(|x| x.parse().ok()).expect("a number"))
        })
        .collect();
    assert!(ends.len() > 5, "{archive}");
    // None is beyond a wall of the first room.
    assert!(ends.iter().all(|[x, y]| (0.0..1.5).contains(x) && (0.0..0.5).contains(y)), "{archive}");
    let spread = |k: usize| ends.iter().fold([1.0_f64, 0.0], |[low, high], at| [low.min(at[k]), high.max(at[k])]);
    assert!([0, 1].into_iter().map(spread).all(|[low, high]| high > low + 0.05), "{archive}");
    // A report compares the champions, which are the best of all generations.
    for run in ["novel", "elites"] {
        bench.succeed(&format!("test {run} --trials 2 -q"));
    }
    bench.succeed("report novel elites --md report.md -q");
    let report = bench.read("report.md");
    assert!(report.contains("| fitness | left | left |") && !report.contains("an earlier one"), "{report}");
    let so_far =
        "The best so far where the champion is the best of all generations: maze, novelty-search; maze, map-elites.";
    assert_eq!(report.matches(so_far).count(), 2, "{report}");
    // A test of the last generation's best, as earlier programs made it, is about another individual than the champion.
    let record: serde_json::Value = serde_json::from_str(&bench.read("novel/test.json")).expect("JSON");
    let generation = record["generation"].as_u64().expect("a generation");
    let another = bench.read("novel/test.json").replace(&format!("\"generation\": {generation}"), "\"generation\": 9");
    std::fs::write(bench.path("novel/test.json"), another).expect("a file");
    bench.succeed("report novel --md later.md -q");
    assert!(bench.read("later.md").contains("| generation 9: a later one |"), "{}", bench.read("later.md"));
    // The notes and archives of the strategies are shown: the archive as it is next to the run.
    let log = bench.read("elites/strategy.csv");
    let elites = log.lines().last().and_then(|row| row.split(',').nth(1)).expect("a number of elites");
    assert_eq!(elites.parse(), Ok(ends.len() as f64));
    for part in ["### Values of novelty-search", "### Values of map-elites", "| run | elites | qd score |"] {
        assert!(report.contains(part), "{part}: {report}");
    }
    let row = report.lines().find(|line| line.starts_with(&format!("| elites | {}.", ends.len())));
    assert!(row.is_some(), "{elites}: {report}");
    let (copy, archive) = (bench.read("report-archive-1.svg"), bench.read("elites/archive.svg"));
    // A report's own pictures end with its mark.
    assert!(copy.strip_prefix(&archive).is_some_and(|mark| mark.starts_with("<!-- FARSA ")), "{copy}");
}

/// The guide shows the template that the command writes, and its pictures are there.
#[test]
fn the_guide_shows_what_the_command_writes() {
    let bench = Bench::new("guide");
    bench.succeed("new follow --from light");
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide");
    let text = std::fs::read_to_string(guide.join("experiment-file.md")).expect("the guide");
    let file = bench.read("follow.toml");
    assert!(text.contains(&format!("```toml\n{file}```")), "the guide shows another file");
    assert!(file.lines().count() <= 30);
    bench.succeed("check follow.toml --graph follow.svg -q");
    let shown = std::fs::read_to_string(guide.join("../pictures/follow-graph.svg")).expect("the drawing");
    assert!(shown == bench.read("follow.svg"), "docs/pictures/follow-graph.svg is another drawing");
    let wrong = file.replace("{ kind = \"infrared\" }", "{ kind = \"infrard\" }").replace("hidden = 4", "hidden = 0");
    std::fs::write(bench.path("follow.toml"), wrong).expect("a file");
    let said = bench.refused("check follow.toml");
    assert!(
        said.starts_with("error: follow.toml line 7: unknown kind `infrard`; the nearest is `infrared`\n"),
        "{said}"
    );
    assert!(text.contains(&said), "the guide shows other errors than {said}");
}
