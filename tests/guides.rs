//! The guides of `docs/guide`: their programs are those of `examples/guide`, their errors occur as printed, and their commands give the
//! printed output.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

mod readers;

const GUIDES: [&str; 4] = ["new-robot", "new-sensor", "own-part", "new-experiment"];

/// The programs of the guides: guide, the reader's file, our example.
const PROGRAMS: [[&str; 3]; 4] = [
    ["new-robot", "src/main.rs", "new_robot"],
    ["new-sensor", "src/main.rs", "new_sensor"],
    ["own-part", "src/main.rs", "own_part"],
    ["new-experiment", "src/main.rs", "new_experiment"],
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn guide(name: &str) -> String {
    read(format!("docs/guide/{name}.md"))
}

/// A fenced block: its language, the file that it belongs to, its text.
struct Block {
    language: String,
    file: String,
    text: String,
}

fn blocks(text: &str) -> Vec<Block> {
    let mut found: Vec<Block> = Vec::new();
    let mut within = false;
    for line in text.lines() {
        match line.strip_prefix("```") {
            Some(_) if within => within = false,
            Some(info) => {
                let (language, file) = info.split_once(' ').unwrap_or((info, ""));
                found.push(Block { language: language.into(), file: file.into(), text: String::new() });
                within = true;
            }
            None if within => {
                let block = found.last_mut().expect("a block");
                block.text += line;
                block.text += "\n";
            }
            None => {}
        }
    }
    assert!(!within, "a block has no end");
    found
}

/// The files of a guide, each the sum of its blocks with empty lines between them.
fn written(name: &str) -> BTreeMap<String, String> {
    let mut files: BTreeMap<String, String> = BTreeMap::new();
    for block in blocks(&guide(name)) {
        if block.language == "rust" && !block.file.is_empty() {
            let text = files.entry(block.file).or_default();
            if !text.is_empty() {
                *text += "\n";
            }
            *text += &block.text;
        }
    }
    files
}

#[test]
fn the_programs_of_the_guides_are_ours() {
    for [name, file, ours] in PROGRAMS {
        let files = written(name);
        let theirs = files.get(file).unwrap_or_else(|| panic!("{name}.md has no {file}"));
        // That of parts is also what `farsa new --parts` writes.
        let ours_text = match ours {
            "own_part" => read("farsa-compose/templates/parts/main.rs"),
            _ => read(format!("examples/guide/{ours}.rs")),
        };
        for (number, (a, b)) in theirs.lines().zip(ours_text.lines()).enumerate() {
            assert_eq!(a, b, "{name}.md, {file} line {}, is not that of the example {ours}", number + 1);
        }
        assert_eq!(theirs.lines().count(), ours_text.lines().count(), "{name}.md, {file}");
    }
    let known: usize = GUIDES.iter().map(|name| written(name).len()).sum();
    assert_eq!(known, PROGRAMS.len(), "a guide has a program that is not checked");
    for name in fs::read_dir(root().join("examples/guide")).expect("the programs") {
        let name = name.expect("a file").file_name();
        assert!(PROGRAMS.iter().any(|[_, _, ours]| name == *format!("{ours}.rs")), "{name:?} belongs to no guide");
    }
}

#[test]
fn the_crate_that_farsa_new_writes_is_that_of_the_guide() {
    for (file, template) in [("Cargo.toml", "dependencies.toml"), ("seek.toml", "seek.toml")] {
        let shown = blocks(&guide("own-part")).into_iter().find(|block| block.file == file).expect("a block").text;
        assert_eq!(shown, read(format!("farsa-compose/templates/parts/{template}")), "{file}");
    }
}

/// The lines of all items whose first line has one of these beginnings, up to the closing brace at the margin.
fn item_lines(text: &str, beginnings: &[&str]) -> usize {
    let mut lines = 0;
    let mut within = false;
    for line in text.lines() {
        let begins = beginnings.iter().any(|beginning| line.starts_with(beginning));
        if within || begins {
            lines += 1;
        }
        within = (within || begins) && line != "}" && !(begins && line.ends_with(';'));
    }
    lines
}

#[test]
fn they_are_as_short_as_is_said() {
    let sensor = read("examples/guide/new_sensor.rs");
    let ends =
        ["struct Bearing", "impl<B> Channels for Bearing", "impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W>"];
    let lines = item_lines(&sensor, &ends);
    assert!((10..=15).contains(&lines), "a sensor of one's own takes {lines} lines");
    assert!(guide("new-sensor").contains(&format!("{lines} lines")), "the guide does not say {lines} lines");
    let lines = read("examples/guide/new_experiment.rs").lines().count();
    assert!((40..=60).contains(&lines), "a new experiment takes {lines} lines");
    assert!(guide("new-experiment").contains(&format!("{lines} lines")), "the guide does not say {lines} lines");
}

#[test]
fn links_lead_somewhere_and_pictures_are_small() {
    for name in GUIDES {
        let text = guide(name);
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for target in targets.filter(|target| !target.starts_with("http")) {
            let path = root().join("docs/guide").join(target.split('#').next().unwrap_or(target));
            assert!(path.exists(), "{name}.md: {target}");
            if path.extension().is_some_and(|extension| extension == "svg") {
                let size = fs::metadata(&path).expect("a picture").len();
                assert!(size < 60_000, "{target}: {size} bytes");
            }
        }
        assert!(
            read("docs/README.md").contains(&format!("guide/{name}.md")),
            "docs/README.md has no link to {name}.md"
        );
    }
    assert!(read("ci").contains("--test guides --test empty_project -- --ignored"), "ci does not follow the guides");
}

#[test]
fn the_cluster_guide_and_its_scripts_are_there() {
    let text = guide("cluster");
    for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
        let (file, heading) = target.split_once('#').unwrap_or((target, ""));
        let path = if file.is_empty() { "cluster.md" } else { file };
        let path = root().join("docs/guide").join(path);
        let linked = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{target}: {error}"));
        let anchor = |line: &str| {
            let words = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            words.chars().filter(|letter| letter.is_alphanumeric() || "-_".contains(*letter)).collect::<String>()
        };
        let known = linked.lines().filter(|line| line.starts_with('#')).any(|line| anchor(line) == heading);
        assert!(heading.is_empty() || known, "no heading {target}");
    }
    for name in ["array", "workers"] {
        let path = format!("docs/guide/cluster/{name}.sh");
        assert!(text.contains(&format!("(cluster/{name}.sh)")), "the guide does not name {name}.sh");
        // The lines that submit it are those of the guide.
        let script = read(&path);
        for line in script.lines().filter_map(|line| line.strip_prefix("#   ")) {
            assert!(text.contains(line), "{path}: the guide does not say {line:?}");
        }
        let check = Command::new("bash").arg("-n").arg(root().join(&path)).output().expect("bash");
        assert!(check.status.success() && check.stderr.is_empty(), "{path}: {check:?}");
    }
    assert!(read("docs/README.md").contains("guide/cluster.md"), "docs/README.md has no link to cluster.md");
}

mod mistakes {
    //! The mistakes of the guides, made one by one.

    use super::guide;
    use farsa::body::Pose;
    use farsa::body::actuators::{Law, Servo};
    use farsa::body::ports::{Actuated, ActuatorId, BodyId, Channels, JointId, Kinematics, Motor, Sensor};
    use farsa::body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
    use farsa::body::robots::{ArmAndHand, InfraredRing, MobileRobot};
    use farsa::body::sensors::infrared::InfraredRays;
    use farsa::body::testing::{check_motor, check_sensor};
    use farsa::body::wrappers::{Noise, Noisy};
    use farsa::num::{Domain, Stream};
    use farsa::physics::arena::{Arena, World};
    use farsa::physics::articulated::{Model, Options};

    fn says(name: &str, error: &dyn std::fmt::Display) {
        let (text, error) = (guide(name), error.to_string());
        assert!(text.contains(&error), "{name}.md does not show: {error}");
    }

    fn robot(joint: Joint, mass: MassProperties) -> Robot {
        let mut robot = Robot::new("r");
        robot.add_segment(Segment::new("forearm", None, joint, mass));
        robot
    }

    #[test]
    fn of_robots() {
        let hinge = |range| Joint::revolute("elbow", [0.0, -1.0, 0.0], Pose::identity(), range);
        let ball = MassProperties::sphere(0.2, 0.04);
        says("new-robot", &robot(hinge([2.0, 0.0]), ball).validate().unwrap_err());
        let mut other = robot(hinge([0.0, 2.0]), ball);
        other.segments[0].parent = Some(BodyId(1));
        says("new-robot", &other.validate().unwrap_err());
        let mut other = robot(hinge([0.0, 2.0]), ball);
        let skin = other.add_collider(Collider::new(
            "hand",
            Some(BodyId(0)),
            Shape::Sphere { radius: 0.04 },
            Pose::identity(),
        ));
        let bone = other.add_collider(Collider::new(
            "forearm",
            Some(BodyId(0)),
            Shape::Sphere { radius: 0.04 },
            Pose::identity(),
        ));
        other.add_pair([skin, bone], Surface { friction: 0.8, rolling_friction: 0.0, stiffness: 2e4, damping: 100.0 });
        says("new-robot", &other.validate().unwrap_err());
        let mut other = robot(Joint::fixed(Pose::identity()), ball);
        other.add_actuator("elbow", JointId(0), Law::Servo(Servo { stiffness: 1.0, damping: 0.1, limit: 1.0 }));
        says("new-robot", &other.validate().unwrap_err());
        let weightless = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [0.0; 6] };
        let model = Model::<f32>::new(&robot(hinge([0.0, 2.0]), weightless), &Options::default());
        says("new-robot", &model.expect_err("no world has that"));
        let khepera = MobileRobot::khepera();
        let infrared = InfraredRing { range: 0.0, ..khepera.infrared.clone() };
        says(
            "new-robot",
            &InfraredRays::for_robot(&MobileRobot { infrared, ..khepera.clone() }, BodyId(0)).unwrap_err(),
        );
        let mut arena = Arena::walled(1.0, 1.0);
        arena.add_robot(khepera, [0.02, 0.5], 0.0);
        says("new-robot", &World::new(&arena).unwrap_err());
    }

    /// The sensor of the guide without its guard.
    #[derive(Debug)]
    struct Bare(BodyId, BodyId);

    impl Channels for Bare {
        fn channels(&self) -> usize {
            2
        }
    }

    impl<W: Kinematics<Body = BodyId>> Sensor<W> for Bare {
        fn read(&mut self, world: &W, out: &mut [f32]) {
            let [x, y, _] = world.pose(self.0).transform_back(world.pose(self.1).position);
            let distance = (x * x + y * y).sqrt();
            out.iter_mut().zip([x, y]).for_each(|(o, x)| *o = x / distance);
        }
    }

    /// One that writes one channel less than it has, or one more.
    struct Miscounted(usize);

    impl Channels for Miscounted {
        fn channels(&self) -> usize {
            2
        }
    }

    impl<W> Sensor<W> for Miscounted {
        fn read(&mut self, _: &W, out: &mut [f32]) {
            out.iter_mut().take(self.0).for_each(|o| *o = 0.5);
        }
    }

    /// A motor that hands on what it is given.
    struct Open(ActuatorId);

    impl Channels for Open {
        fn channels(&self) -> usize {
            1
        }
    }

    impl<W: Actuated<Actuator = ActuatorId>> Motor<W> for Open {
        fn drive(&mut self, y: &[f32], world: &mut W) {
            y.iter().take(1).for_each(|y| world.command(self.0, [*y, 0.0]));
        }
    }

    #[test]
    fn of_sensors_and_motors() {
        let mut arena = Arena::walled(1.0, 1.0);
        arena.add_robot(MobileRobot::e_puck(), [0.5, 0.5], 0.0);
        let world = World::new(&arena).expect("a world");
        let body = arena.parts(0).body;
        says("new-sensor", &check_sensor(&mut Bare(body, body), &world).unwrap_err());
        says("new-sensor", &check_sensor(&mut Miscounted(1), &world).unwrap_err());
        says("new-sensor", &check_sensor(&mut Miscounted(3), &world).unwrap_err());
        let wheel = arena.parts(0).motors[0];
        says("new-sensor", &check_motor(&mut Open(wheel), || world.clone()).unwrap_err());
        let stream = Stream::new(1, Domain::Sensor, 0, 0, 0);
        says("new-sensor", &Noisy::new(Bare(body, ArmAndHand::PALM), Noise::Normal(-0.3), stream).unwrap_err());
    }
}

/// Compares a line or a text with an expectation, in which `...` matches anything.
fn matches(expected: &str, found: &str) -> bool {
    let Some((before, after)) = expected.split_once("...") else { return expected == found };
    let Some(rest) = found.strip_prefix(before) else { return false };
    (0..=rest.len()).filter(|at| rest.is_char_boundary(*at)).any(|at| matches(after, &rest[at..]))
}

/// Builds the reader's project.
#[derive(Clone, Copy, PartialEq)]
enum Builder {
    /// Cargo in the reader's project, or only a check, by [`readers::whole`].
    Reader,
    /// The workspace: its examples are the same programs, built already.
    Workspace,
}

/// Replaces cargo for programs that are already built. `farsa` is another crate's program.
const CARGO: &str = r#"
cargo() {
    local program=$FARSA_main verb=$1 name
    shift
    if [[ $verb == new ]]; then
        mkdir -p "$1/src" && printf '[package]\nname = "%s"\n\n[dependencies]\n' "$1" >"$1/Cargo.toml"
        return
    fi
    [[ $verb == run ]] || { echo "no cargo $verb here"; return 1; }
    while (($#)) && [[ $1 != -- ]]; do
        case $1 in
            --bin) name=FARSA_$2 program=${!name} ;;
            --manifest-path) program=$FARSA ;;
            *) echo "no $1 here"; return 1 ;;
        esac
        shift 2
    done
    (($# == 0)) || shift
    "$program" "$@"
}
"#;

/// The folder of the programs that the workspace builds, which are brought up to date.
fn built() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let mut build = Command::new(env!("CARGO"));
        // The same selection as in a test of the workspace, so that no dependency is compiled for other features.
        build.args(["build", "--workspace", "--offline", "--quiet", "--bin", "farsa"]).current_dir(root());
        for [_, _, ours] in PROGRAMS {
            build.args(["--example", ours]);
        }
        let output = build.env("CARGO_TARGET_DIR", target()).stdin(Stdio::null()).output().expect("cargo");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        target().join("debug")
    })
}

fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target directory").to_path_buf()
}

/// Runs a block of commands in a folder and returns its output and success.
fn run(name: &str, commands: &str, folder: &Path, place: &Path, builder: Builder) -> (String, bool) {
    let mut bash = Command::new("bash");
    let mut script = String::from("exec 2>&1\n");
    if builder == Builder::Workspace {
        let built = built();
        script += CARGO;
        let program = |name: &str| built.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
        bash.env("FARSA", program("farsa"));
        for [_, file, ours] in PROGRAMS.into_iter().filter(|[guide, ..]| *guide == name) {
            let variable = file.rsplit('/').next().unwrap_or(file).trim_end_matches(".rs");
            bash.env(format!("FARSA_{variable}"), program(&format!("examples/{ours}")));
        }
    }
    script += commands;
    script += "\npwd >\"$FARSA_PLACE\"\n";
    let output = bash
        .args(["-e", "-c", &script])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target())
        .env("CARGO_TERM_QUIET", "true")
        .env("CARGO_NET_OFFLINE", "true")
        .env("FARSA_PLACE", place)
        .stdin(Stdio::null())
        .output()
        .expect("bash");
    (String::from_utf8_lossy(&output.stdout).into_owned(), output.status.success())
}

/// Follows a guide in an empty folder: writes its files, runs its commands, compares output and pictures.
fn follow(name: &str, builder: Builder) {
    let kind = if builder == Builder::Reader { "reader" } else { "workspace" };
    // Outside the target directory, which most often is within the workspace: there `cargo new` would enter the project into it.
    let place = std::env::temp_dir().join(format!("farsa-guide-{kind}-{}", std::process::id())).join(name);
    fs::create_dir_all(&place).expect("an empty folder");
    // The reader has FARSA next to the project.
    let here = |text: &str| text.replace("../farsa", &root().display().to_string());
    let mut files: BTreeMap<String, String> = BTreeMap::new();
    let mut project: PathBuf = place.clone();
    let mut said = None;
    let checked = builder == Builder::Reader && !readers::whole();
    for block in blocks(&guide(name)) {
        match block.language.as_str() {
            "toml" if block.file != "Cargo.toml" => {
                fs::write(project.join(&block.file), &block.text).expect("a file of the project");
            }
            "toml" => {
                let path = project.join(&block.file);
                let manifest = fs::read_to_string(&path).expect("cargo new made one");
                let manifest = manifest.trim_end().strip_suffix("[dependencies]").expect("an empty table at the end");
                fs::write(&path, format!("{manifest}{}", here(&block.text))).expect("its manifest");
                // Pins what is on this machine already.
                fs::copy(root().join("Cargo.lock"), project.join("Cargo.lock")).expect("the lock file");
            }
            "rust" if !block.file.is_empty() => {
                let text = files.entry(block.file.clone()).or_default();
                *text += if text.is_empty() { "" } else { "\n" };
                *text += &block.text;
                let path = project.join(&block.file);
                fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
                fs::write(path, text).expect("a program");
            }
            "sh" if block.file == "pages" => {} // `tests/wasm/run` compiles the program.
            "sh" if checked && !files.is_empty() => readers::check(&project),
            "sh" => {
                let end = place.join("place");
                let (text, well) = run(name, &here(&block.text), &project, &end, builder);
                println!("{name}: $ {}\n{text}", block.text.trim_end());
                // A block may show how a command fails.
                assert_eq!(well, block.file != "fails", "{name}.md: {}says\n{text}", block.text);
                said = Some((block.text, text));
                if let Ok(now) = fs::read_to_string(end) {
                    project = PathBuf::from(now.trim_end());
                }
            }
            "text" if !checked => {
                let (command, found) = said.take().unwrap_or_else(|| panic!("{name}.md: an output without command"));
                // Whole lines may be left out, too.
                let expected = block.text.replace("\n...\n", "\n...");
                let fits = matches(expected.trim_end(), found.trim_end());
                assert!(fits, "{name}.md: {command}says\n{found}\nand not\n{}", block.text);
            }
            _ => {}
        }
    }
    for part in guide(name).split("](../pictures/guide-").skip(1).filter(|_| !checked) {
        let picture = part.split(')').next().expect("a picture");
        let drawn = fs::read(project.join(picture)).unwrap_or_else(|error| panic!("{name}: {picture}: {error}"));
        let place = root().join("docs/pictures").join(format!("guide-{picture}"));
        if std::env::var_os("FARSA_WRITE_REFERENCE").is_some() {
            fs::write(&place, &drawn).expect("a writable picture");
        }
        let shown = fs::read(place).expect("the picture shown");
        assert!(drawn == shown, "{name}: docs/pictures/guide-{picture} is not what the guide draws");
    }
    fs::remove_dir_all(&place).expect("no more needed");
}

#[test]
fn dots_stand_for_anything() {
    for (expected, found, fits) in
        [("a", "a", true), ("a", "b", false), ("a ... c", "a b b c", true), ("...c", "abc", true), ("a...", "b", false)]
    {
        assert_eq!(matches(expected, found), fits, "{expected} {found}");
    }
}

#[test]
fn whoever_follows_them_sees_what_they_show() {
    for name in GUIDES {
        follow(name, Builder::Workspace);
    }
}

#[test]
#[ignore = "checks or builds the projects of all readers, minutes: ./ci guides"]
fn their_projects_are_whole() {
    for name in GUIDES {
        follow(name, Builder::Reader);
    }
}
