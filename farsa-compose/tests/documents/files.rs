//! Files that an experiment names, in its folder.

use std::fs;
use std::path::{Path, PathBuf};

use farsa_compose::{ComposedExperiment, FILES};
use farsa_lab::{Error, Experiment as _};

const REST: &str = "robot = { kind = \"e-puck\" }\nmotors = [{ kind = \"wheels\" }]\nnetwork = { kind = \"perceptron\" }\n\
    reward = [{ kind = \"steps\" }]\n";

/// A table of eight sensors, four angles and one distance.
const TABLE: &str = "8 4 1 0 50\nTURN 0\n512 512 512 512 512 512 0 0\n0 256 0 256 0 256 0 256\n0 0 0 0 0 0 512 512\n\
    256 0 256 0 256 0 256 0\nEND\n";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn read(folder: &Path, text: &str) -> Result<ComposedExperiment, Error> {
    fs::write(folder.join("own.toml"), text).expect("a file");
    ComposedExperiment::from_file(folder.join("own.toml"), farsa_lab::strategy::strategies())
}

/// An infrared sensor with the table of walls and tables of bodies of these numbers.
fn sensor(name: &str, bodies: std::ops::Range<usize>) -> String {
    let bodies: Vec<String> = bodies
        .map(|number| format!("{{ file = \"b{number}.sam\", radius = {} }}", 0.01 + 0.001 * number as f64))
        .collect();
    format!(
        "[[sensors]]\nname = \"{name}\"\nkind = \"infrared\"\nmodel = \"tables\"\n\
         tables = {{ walls = \"walls.sam\", bodies = [{}] }}\n",
        bodies.join(", ")
    )
}

/// Sixteen files are the most, each counted once.
#[test]
fn sixteen_files_are_stored_once_each() {
    let folder = folder("sixteen");
    fs::write(folder.join("walls.sam"), TABLE).expect("a file");
    for number in 0..16 {
        fs::write(folder.join(format!("b{number}.sam")), TABLE.replace("256", &format!("{}", 300 + number)))
            .expect("a file");
    }
    let text = format!("{REST}{}{}", sensor("one", 0..8), sensor("two", 4..15));
    let made = read(&folder, &text).unwrap_or_else(|error| panic!("{error}"));
    let stored = made.definition().expect("a text");
    let files = stored.split("[files]\n").nth(1).expect("files");
    assert_eq!(files.matches(".sam\" = ").count(), 16, "{files}");
    for number in 0..15 {
        assert_eq!(files.matches(&format!("\"b{number}.sam\" = ")).count(), 1, "{number}");
        assert!(files.contains(&format!("0 {} 0", 300 + number)), "{number}");
    }
    let text = format!("{REST}{}{}", sensor("one", 0..8), sensor("two", 4..16));
    let error = read(&folder, &text).err().expect("an error").to_string();
    assert!(
        error.contains("`sensors.2.tables.bodies.12.file`: is one file more than 16, which are the most"),
        "{error}"
    );
}

/// The folder of a bare file name is the working directory, in which this crate has a file that is no table.
#[test]
fn a_bare_name_is_in_the_working_directory() {
    let text = format!("{REST}{}", sensor("one", 0..0)).replace("walls.sam", "Cargo.toml");
    for folder in ["", "."] {
        let error = (FILES.read)("own.toml", &text, Some(Path::new(folder)), farsa_lab::strategy::strategies().into());
        let error = error.err().expect("an error").to_string();
        assert!(error.contains("`sensors.1.tables.walls`: Cargo.toml: "), "{error}");
    }
}

/// The limit of a million bytes is for a model with all that it includes.
#[test]
fn models_are_limited_with_what_they_include() {
    let folder = folder("large");
    let bodies = |count: usize| {
        let body = |number: usize| format!("<body name='{number}{}'/>", "b".repeat(2000));
        let bodies: String = (0..count).map(body).collect();
        fs::write(folder.join("part.xml"), format!("<mujocoinclude><worldbody>{bodies}</worldbody></mujocoinclude>"))
    };
    let model = "<mujoco><include file='part.xml'/><worldbody><body name='arm'><joint name='hinge' axis='0 0 1'/>\
        <inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>";
    fs::write(folder.join("arm.xml"), model).expect("a file");
    let text = "world = { engine = \"articulated\" }\nrobot = { kind = \"model\", file = \"arm.xml\" }\n\
        sensors = [{ kind = \"joint-speed\" }]\nmotors = [{ kind = \"joint-torque\", largest = 1.0 }]\n\
        network = { kind = \"perceptron\" }\nreward = [{ kind = \"steps\" }]\n";
    bodies(3).expect("a file");
    assert_eq!(read(&folder, text).err().map(|error| error.to_string()), None);
    bodies(600).expect("a file");
    let error = read(&folder, text).err().expect("an error").to_string();
    assert!(error.contains("`robot.file`: arm.xml: ") && error.contains("1000000"), "{error:.400}");
}

/// A run has the name, the summary and the text of its file.
#[test]
fn an_experiment_has_the_name_of_its_file() {
    let text = format!("summary = \"drives about\"\n{REST}sensors = [{{ kind = \"touch\" }}]\n");
    let made = ComposedExperiment::from_text("some/own-2.toml", &text, farsa_lab::strategy::strategies());
    let made = made.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((made.name(), made.summary(), made.definition()), ("own-2", "drives about", Some(&*text)));
    assert_eq!(made.strategy("").name(), "truncation");
    let schema = (FILES.schema)(&[]).expect("a schema");
    assert!(schema.ends_with("}\n") && schema.contains("\"unevaluatedProperties\": false"), "{schema:.200}");
    for template in FILES.templates {
        let file = format!("{}.toml", template.name);
        assert!((FILES.read)(&file, template.text, None, farsa_lab::strategy::strategies().into()).is_ok(), "{file}");
    }
}

/// Every condition is checked when the file is read.
#[test]
fn conditions_that_cannot_be_are_refused() {
    let text = |setting: &str| {
        format!(
            "{REST}sensors = [{{ kind = \"infrared\" }}]\nstart = [{{ place = \"robot\", at = \"fixed\", point = [0.5, 0.5] }}]\n\
             [[conditions]]\nname = \"a\"\n[[conditions]]\nname = \"b\"\nsettings = {{ {setting} }}\n"
        )
    };
    for (setting, why) in [
        ("\"sensors.infrared.first\" = 3", None),
        ("\"sensors.infrared.first\" = 9", Some("channels 0..9 of 8")),
        ("\"start.robot.point\" = [0.5, 1.5]", Some("is outside the walls")),
        ("\"world.time_step\" = 0.3", Some("is outside")),
    ] {
        let error = ComposedExperiment::from_text("own.toml", &text(setting), farsa_lab::strategy::strategies()).err();
        let error = error.map(|error| error.to_string());
        match why {
            Some(why) => assert!(error.as_deref().is_some_and(|error| error.contains(why)), "{setting}: {error:?}"),
            None => assert_eq!(error, None),
        }
    }
}
