//! Models of several files, and starts inside other things.

use std::fs;
use std::path::{Path, PathBuf};

use farsa_compose::ComposedExperiment;
use farsa_lab::{EpisodeId, Error, Evaluation, Experiment as _, Settings};
use farsa_view::{Page, Recording};
use serde_json::{Value, json};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("model/parts")).expect("a folder");
    folder
}

/// A cube of 0.2 m.
const CUBE: &str = "v -0.1 -0.1 -0.1\nv 0.1 -0.1 -0.1\nv 0.1 0.1 -0.1\nv -0.1 0.1 -0.1\nv -0.1 -0.1 0.1\nv 0.1 -0.1 0.1\n\
    v 0.1 0.1 0.1\nv -0.1 0.1 0.1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn experiment(model: &str, base: f64, rest: &str) -> String {
    format!(
        "[world]\nengine = \"articulated\"\ntime_step = 0.01\n[robot]\nkind = \"model\"\nfile = \"{model}\"\n\
         base = [0.0, 0.0, {base:?}]\n[[sensors]]\nkind = \"joint-position\"\nfrom = 0.0\nto = 1.0\n[[motors]]\n\
         kind = \"joint-torque\"\nlargest = 0.5\n[network]\nkind = \"perceptron\"\n[episode]\nsteps = 50\ntrials = 1\n\
         [[reward]]\nkind = \"joint-speed\"\nover = \"end\"\n[[reward]]\nkind = \"touch\"\n{rest}"
    )
}

fn read(folder: &Path, text: &str) -> Result<ComposedExperiment, Error> {
    fs::write(folder.join("cube.toml"), text).expect("a file");
    ComposedExperiment::from_file(folder.join("cube.toml"), farsa_lab::strategy::strategies())
}

fn terms(made: &ComposedExperiment) -> Vec<f64> {
    let mut evaluator = made.prepare("", &Settings::new(made.settings("")).expect("settings")).expect("an evaluator");
    let parameters = vec![0.7; evaluator.info().parameters.len()];
    evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None).terms
}

#[test]
fn models_with_includes_and_meshes_are_stored_with_the_run() {
    let body = "<body name='arm' pos='0 0 0.5'><joint name='hinge' axis='0 1 0'/><geom pos='0.2 0 0' GEOM/></body>";
    let mjcf = |geom: &str, rest: &str| {
        format!(
            "<mujoco><compiler angle='radian'/>{rest}<worldbody>{}</worldbody></mujoco>",
            body.replace("GEOM", geom)
        )
    };
    let urdf = |shape: &str| {
        format!(
            "<robot name='r'><link name='base'/><link name='arm'><inertial><origin xyz='0.2 0 0'/><mass value='8'/>\
             <inertia ixx='0.05' iyy='0.05' izz='0.05' ixy='0' ixz='0' iyz='0'/></inertial><collision name='c'>\
             <origin xyz='0.2 0 0' rpy='0.5 0 0'/><geometry>{shape}</geometry></collision></link><joint name='hinge' \
             type='continuous'><parent link='base'/><child link='arm'/><origin xyz='0 0 0.5'/><axis xyz='0 1 0'/></joint></robot>"
        )
    };
    let folder = folder("merged");
    fs::write(folder.join("model/parts/cube.obj"), CUBE).expect("a file");
    let asset = "<mujocoinclude><asset><mesh name='cube' file='cube.obj'/></asset></mujocoinclude>";
    fs::write(folder.join("model/parts/asset.xml"), asset).expect("a file");
    for (name, plain, merged) in [
        (
            "arm.xml",
            mjcf("type='box' size='0.1 0.1 0.1'", ""),
            mjcf("type='mesh' mesh='cube'", "<include file='parts/asset.xml'/>"),
        ),
        ("arm.urdf", urdf("<box size='0.2 0.2 0.2'/>"), urdf("<mesh filename='package://model/parts/cube.obj'/>")),
    ] {
        let place = folder.join("model").join(name);
        let text = experiment(&format!("model/{name}"), 0.0, "");
        fs::write(&place, plain).expect("a file");
        let expected = terms(&read(&folder, &text).unwrap_or_else(|error| panic!("{name}: {error}")));
        assert!(expected[0] > 0.1, "{name}: {expected:?}");
        fs::write(&place, merged).expect("a file");
        let made = read(&folder, &text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let found = terms(&made);
        assert!(
            found.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 1e-4 * b.abs()),
            "{name}: {found:?} {expected:?}"
        );
        // The definition of a run needs no file.
        let stored = made.definition().expect("a text").to_owned();
        let again = ComposedExperiment::from_text("cube.toml", &stored, farsa_lab::strategy::strategies());
        assert_eq!(terms(&again.unwrap_or_else(|error| panic!("{name}: {error}"))), found);
    }
    fs::remove_file(folder.join("model/parts/cube.obj")).expect("the file");
    let error = read(&folder, &experiment("model/arm.xml", 0.0, "")).err().expect("an error").to_string();
    assert!(
        error.contains("`robot.file`: model/arm.xml: parts/asset.xml line 1: \"cube.obj\" is not there"),
        "{error}"
    );
}

/// Returns the shapes of a page of the first trial, and its meshes.
fn page(made: &ComposedExperiment) -> (Vec<Value>, Value) {
    let mut evaluator = made.prepare("", &Settings::new(made.settings("")).expect("settings")).expect("an evaluator");
    let parameters = vec![0.7; evaluator.info().parameters.len()];
    let mut recording = Recording::new(evaluator.info().schema);
    evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), Some(&mut recording));
    let page = Page::new("meshes").with("one", recording).episode(0).expect("an episode");
    let mut page: Value = serde_json::from_str(&page).expect("JSON");
    (page["shapes"].as_array().expect("shapes").clone(), page["meshes"].take())
}

#[test]
fn pages_draw_the_meshes_of_a_model() {
    let folder = folder("drawn");
    fs::write(folder.join("model/parts/cube.obj"), CUBE).expect("a file");
    let arm = |visual: &str| {
        format!(
            "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='8'/><inertia ixx='0.05' iyy='0.05' \
             izz='0.05' ixy='0' ixz='0' iyz='0'/></inertial><collision><geometry><sphere radius='0.1'/></geometry></collision>\
             {visual}</link><joint name='hinge' type='continuous'><parent link='base'/><child link='arm'/>\
             <origin xyz='0 0 0.5'/><axis xyz='0 1 0'/></joint></robot>"
        )
    };
    let visual = "<visual><origin xyz='0.2 0 0'/><geometry><mesh filename='parts/cube.obj' scale='1 2 3'/></geometry>\
        <material name='red'><color rgba='1 0 0 1'/></material></visual>";
    let text = experiment("model/arm.urdf", 0.0, "");
    fs::write(folder.join("model/arm.urdf"), arm("")).expect("a file");
    let plain = read(&folder, &text).expect("an experiment");
    assert!(page(&plain).0.iter().any(|shape| shape["kind"] == "sphere") && page(&plain).1.is_null());
    fs::write(folder.join("model/arm.urdf"), arm(visual)).expect("a file");
    let made = read(&folder, &text).expect("an experiment");
    assert_eq!(terms(&made), terms(&plain));
    // A stored text opens no file.
    fs::remove_file(folder.join("model/parts/cube.obj")).expect("the file");
    let stored = made.definition().expect("a text").to_owned();
    let read_again = |text: &str| ComposedExperiment::from_text("cube.toml", text, farsa_lab::strategy::strategies());
    let (shapes, meshes) = page(&read_again(&stored).expect("an experiment"));
    assert_eq!((&shapes, &meshes), (&page(&made).0, &page(&made).1));
    let [mesh] = shapes.iter().filter(|shape| shape["role"] == "robot").collect::<Vec<_>>()[..] else {
        panic!("{shapes:?}")
    };
    let found = ["kind", "color", "half", "position"].map(|key| mesh[key].clone());
    assert_eq!(found, [json!("mesh"), json!("#ff0000"), json!([0.1, 0.2, 0.3]), json!([0.2, 0, 0])]);
    // A triangle has three corners of 16 bits.
    assert_eq!(meshes[0]["triangles"].as_str().map(str::len), Some(12 * 3 * 2 * 4 / 3));
    for (from, to, why) in [("\"body\":1", "\"body\":2", "absent body"), ("\"half\"", "\"size\"", "a mesh lacks a key")]
    {
        let changed = stored.replace(&from.replace('"', "\\\""), &to.replace('"', "\\\"")).replace(from, to);
        assert_ne!(changed, stored);
        let error = read_again(&changed).err().expect("an error").to_string();
        assert!(error.contains("`robot.file`: model/arm.urdf.meshes: ") && error.contains(why), "{error}");
    }
}

#[test]
fn a_start_inside_the_floor_or_a_thing_is_refused() {
    let folder = folder("inside");
    let model = "<mujoco><worldbody><body name='arm'><joint name='hinge' axis='0 0 1'/>\
        <geom name='bar' type='box' size='0.5 0.05 0.05'/></body></worldbody></mujoco>";
    fs::write(folder.join("model/bar.xml"), model).expect("a file");
    let wall = "[[objects]]\nkind = \"wall\"\nname = \"post\"\nsize = [0.2, 0.6]\nheight = 1.0\n";
    let ball = "[[objects]]\nkind = \"ball\"\nname = \"ball\"\nradius = 0.1\nmass = 0.1\n";
    for (base, rest, expected) in [
        (0.05, String::new(), None),
        (0.0495, String::new(), None),
        (0.03, String::new(), Some("`robot`: `bar` is 20.0 mm inside `floor` at the start of trial 1")),
        (
            0.5,
            format!("{wall}at = [0.55, 0.0]\n"),
            Some("`objects.1`: `bar` is 50.0 mm inside `post` at the start of trial 1"),
        ),
        (0.5, format!("{wall}at = [0.61, 0.0]\n"), None),
        (0.5, format!("{ball}at = [0.0, 0.0, 0.5]\n"), Some("inside `ball` at the start of trial 1")),
        (0.5, format!("{ball}at = [2.0, 0.0, 0.06]\n"), Some("`objects.1`: `ball` is 40.0 mm inside `floor`")),
        (0.5, format!("{ball}at = [2.0, 0.0]\n"), None),
    ] {
        let text = experiment("model/bar.xml", base, &rest);
        let found = read(&folder, &text).err().map(|error| error.to_string());
        match expected {
            None => assert_eq!(found, None, "{rest}"),
            Some(expected) => assert!(found.as_deref().is_some_and(|found| found.contains(expected)), "{found:?}"),
        }
        // A stored text is read as it was.
        let table = format!("{text}\n[files]\n\"model/bar.xml\" = \"\"\"{model}\"\"\"\n");
        assert!(
            ComposedExperiment::from_text("cube.toml", &table, farsa_lab::strategy::strategies()).is_ok(),
            "{rest}"
        );
    }
}

#[test]
fn the_files_of_the_repository_start_clear_of_the_floor() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments");
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("an entry").path();
        let is_experiment = fs::read_to_string(&path).is_ok_and(|text| text.contains("kind = \"model\""));
        if is_experiment && path.extension().is_some_and(|ending| ending == "toml") {
            count += 1;
            let made = ComposedExperiment::from_file(&path, farsa_lab::strategy::strategies());
            made.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
    }
    assert!(count > 0, "no experiment has a model");
}
