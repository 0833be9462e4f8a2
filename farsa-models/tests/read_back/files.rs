//! The files that a model names.

use std::fs;
use std::path::{Path, PathBuf};

use farsa_body::robot::Shape;
use farsa_models::{Imported, Limits, Meshes, ReadError, ReadOptions, SourceLocation};

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("model/meshes")).unwrap();
    folder
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn files_outside_are_not_read() {
    let folder = folder("paths");
    let model = folder.join("model/robot.xml");
    fs::write(folder.join("model/meshes/a.obj"), TETRAHEDRON).unwrap();
    fs::write(folder.join("secret.obj"), TETRAHEDRON).unwrap();
    let asset = |file: &str| {
        format!(
            "<mujoco><asset><mesh name=\"m\" file=\"{file}\"/></asset><worldbody><body><joint/><geom type=\"mesh\" mesh=\"m\"/></body></worldbody></mujoco>"
        )
    };
    let attempt = |file: &str, options: &ReadOptions| {
        fs::write(&model, asset(file)).unwrap();
        Imported::from_file(&model, options)
    };
    let strict = ReadOptions::default();
    let reading = attempt("meshes/a.obj", &strict).unwrap();
    assert!((reading.robot.segments[0].mass - 1000.0 / 6.0).abs() < 1e-9);
    assert!(attempt("./meshes/../meshes/a.obj", &strict).is_ok());
    let absolute = folder.join("secret.obj").display().to_string();
    for (file, why) in [
        ("../secret.obj", "leads out of the folder that may be read"),
        ("../nothing.obj", "leads out of the folder that may be read"),
        ("meshes/../../secret.obj", "leads out of the folder that may be read"),
        (absolute.as_str(), "leads out of the folder that may be read"),
        ("/nowhere/none.obj", "leads out of the folder that may be read"),
        ("meshes/none.obj", "is not there"),
        ("file:///a.obj", "leads out of the folder that may be read"),
        ("file://meshes/none.obj", "is not there"),
        ("https://a.b/a.obj", "is an address; only files are read"),
        ("package://p/secret.obj", "names a package, and no folder with packages was given"),
    ] {
        let error = attempt(file, &strict).unwrap_err();
        assert!(matches!(&error, ReadError::Path { why: found, .. } if *found == why), "{file}: {error}");
    }
    let error = attempt("meshes", &strict).unwrap_err();
    assert!(matches!(error, ReadError::Path { why: "is a folder", .. }), "{error}");
    let wider = ReadOptions { root: Some(folder.clone()), ..ReadOptions::default() };
    assert!(attempt("../secret.obj", &wider).is_ok(), "within the root that was given");
    assert!(attempt("../../secret.obj", &wider).is_err());
    let packages = ReadOptions { packages: vec![folder.clone()], ..ReadOptions::default() };
    assert!(attempt("package://model/meshes/a.obj", &packages).is_ok());
    for file in
        ["package://../secret.obj", "package://model/../../a.obj", "package:///secret.obj", "package://none/a.obj"]
    {
        assert!(attempt(file, &packages).is_err(), "{file}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.join("secret.obj"), folder.join("model/meshes/link.obj")).unwrap();
        let error = attempt("meshes/link.obj", &strict).unwrap_err();
        assert!(error.to_string().ends_with("leads out of the folder that may be read"), "{error}");
    }
    let small = Limits { bytes: 400, ..Limits::default() };
    fs::write(folder.join("model/meshes/large.obj"), TETRAHEDRON.repeat(100)).unwrap();
    let error = attempt("meshes/large.obj", &ReadOptions { limits: small, ..ReadOptions::default() }).unwrap_err();
    assert!(matches!(error, ReadError::TooMuch { what: "bytes in a file", .. }), "{error}");
    let left = attempt("meshes/none.obj", &ReadOptions { meshes: Meshes::Leave, ..ReadOptions::default() });
    assert!(matches!(left, Err(ReadError::Mass { .. })), "what moves lost its only mass");
}

#[test]
fn included_files_stand_where_they_are_named() {
    let folder = folder("includes");
    let model = folder.join("model/robot.xml");
    let main = "<mujoco><include file='meshes/parts.xml'/><worldbody><body name='a'><include file='leg.xml'/></body></worldbody></mujoco>";
    fs::write(&model, main).unwrap();
    fs::write(
        folder.join("model/meshes/parts.xml"),
        "<mujocoinclude><default><geom size='0.5'/></default></mujocoinclude>",
    )
    .unwrap();
    fs::write(folder.join("model/leg.xml"), "<mujoco><joint name='k'/>\n<geom name='g' density='1'/></mujoco>")
        .unwrap();
    let reading = Imported::from_file(&model, &ReadOptions::default()).unwrap();
    assert_eq!(reading.robot.colliders[0].shape, Shape::Sphere { radius: 0.5 });
    assert!(reading.robot.joint("k").is_some());
    fs::write(folder.join("model/leg.xml"), "<mujoco>\n<include file='leg.xml'/></mujoco>").unwrap();
    let error = Imported::from_file(&model, &ReadOptions::default()).unwrap_err().to_string();
    assert_eq!(error, "leg.xml line 2: a second include of `leg.xml`, the first is in line 1");
    fs::write(folder.join("model/leg.xml"), "<mujoco>\n<join/></mujoco>").unwrap();
    let error = Imported::from_file(&model, &ReadOptions::default()).unwrap_err().to_string();
    assert_eq!(error, "leg.xml line 2: unknown element of body `join`; the nearest is `joint`");
}

/// MuJoCo 4.0.0 reads each of these includes from an absolute path, and the mass is that of its tetrahedron, except
/// for the folder `meshdir` of an included file, which it does not find.
#[test]
fn files_of_an_included_file_are_next_to_it() {
    let folder = folder("included").canonicalize().unwrap();
    let model = folder.join("model/robot.xml");
    let body = "<worldbody><body><joint/><geom type='mesh' mesh='m'/></body></worldbody>";
    let asset = "<mujocoinclude><asset><mesh name='m' file='a.obj'/></asset></mujocoinclude>";
    let chain = "<mujocoinclude><include file='c.xml'/></mujocoinclude>";
    fs::create_dir_all(folder.join("model/parts/meshes")).unwrap();
    for (main, mesh, files) in [
        ("<include file='parts/c.xml'/>", "parts/a.obj", &[("parts/c.xml", asset)][..]),
        // The model's own folder comes first.
        ("<include file='parts/c.xml'/>", "a.obj", &[("parts/c.xml", asset), ("parts/a.obj", "")]),
        ("<include file='parts/b.xml'/>", "parts/a.obj", &[("parts/b.xml", chain), ("parts/c.xml", asset)]),
        ("<include file='parts/b.xml'/>", "a.obj", &[("parts/b.xml", chain), ("c.xml", asset), ("parts/c.xml", "<")]),
        ("<compiler meshdir='meshes'/><include file='parts/c.xml'/>", "parts/a.obj", &[("parts/c.xml", asset)]),
        ("<compiler assetdir='meshes/'/><include file='parts/c.xml'/>", "meshes/a.obj", &[("parts/c.xml", asset)]),
        ("<compiler meshdir='meshes'/><include file='parts/c.xml'/>", "parts/meshes/a.obj", &[("parts/c.xml", asset)]),
    ] {
        for file in
            ["a.obj", "meshes/a.obj", "parts/a.obj", "parts/meshes/a.obj", "c.xml", "parts/c.xml", "parts/b.xml"]
        {
            let _ = fs::remove_file(folder.join("model").join(file));
        }
        for (file, text) in files {
            fs::write(folder.join("model").join(file), text).unwrap();
        }
        fs::write(folder.join("model").join(mesh), TETRAHEDRON).unwrap();
        fs::write(&model, format!("<mujoco>{main}{body}</mujoco>")).unwrap();
        let reading =
            Imported::from_file(&model, &ReadOptions::default()).unwrap_or_else(|error| panic!("{mesh}: {error}"));
        assert!((reading.robot.segments[0].mass - 1000.0 / 6.0).abs() < 1e-9, "{mesh}");
    }
    fs::write(folder.join("model/parts/c.xml"), "<mujocoinclude><worldbody>\n<geoms/></worldbody></mujocoinclude>")
        .unwrap();
    fs::write(&model, "<mujoco><include file='parts/c.xml'/></mujoco>").unwrap();
    let error = Imported::from_file(&model, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("parts/c.xml line 2: unknown element"), "{error}");
}

#[test]
fn absolute_paths_and_addresses_below_the_root_are_read() {
    let folder = folder("absolute");
    fs::create_dir_all(folder.join("arm description/urdf")).unwrap();
    fs::create_dir_all(folder.join("arm description/meshes")).unwrap();
    fs::write(folder.join("arm description/meshes/a.obj"), TETRAHEDRON).unwrap();
    let at = folder.display().to_string();
    let options = ReadOptions { root: Some(folder.clone()), ..ReadOptions::default() };
    let urdf = folder.join("arm description/urdf/arm.urdf");
    let collision = |file: &str| {
        let geometry = format!("<geometry><mesh filename='{file}'/></geometry>");
        format!("<robot name='r'><link name='a'><collision>{geometry}</collision></link></robot>")
    };
    for file in [
        format!("{at}/arm description/meshes/a.obj"),
        format!("{at}/arm description/urdf/../meshes/./a.obj"),
        format!("file://{at}/arm%20description/meshes/a.obj"),
        format!("file://localhost{at}/arm description/meshes/a.obj"),
        "file://../meshes/a.obj".into(),
        "package://arm description/meshes/a.obj".into(),
        "model://arm description/meshes/a.obj".into(),
        "..\\meshes\\a.obj".into(),
    ] {
        fs::write(&urdf, collision(&file)).unwrap();
        let reading = Imported::from_file(&urdf, &options).unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_eq!(reading.robot.colliders.len(), 1, "{file}");
        assert!(Imported::from_file(&urdf, &ReadOptions::default()).is_err(), "{file}: without the root");
    }
    let mjcf = folder.join("arm description/urdf/arm.xml");
    for (meshes, file) in [
        (format!("{at}/arm description/meshes"), "a.obj"),
        (format!("{at}/arm description/meshes/"), "a.obj"),
        (format!("file://{at}/arm%20description/meshes"), "a.obj"),
        ("package://arm description/meshes".into(), "a.obj"),
        ("nowhere".into(), &format!("{at}/arm description/meshes/a.obj")),
    ] {
        let asset = format!("<compiler meshdir='{meshes}'/><asset><mesh name='m' file='{file}'/></asset>");
        let body = "<worldbody><body><joint/><geom type='mesh' mesh='m'/></body></worldbody>";
        fs::write(&mjcf, format!("<mujoco>{asset}{body}</mujoco>")).unwrap();
        let reading = Imported::from_file(&mjcf, &options).unwrap_or_else(|error| panic!("{meshes}: {error}"));
        assert!((reading.robot.segments[0].mass - 1000.0 / 6.0).abs() < 1e-9, "{meshes}");
    }
}

/// Opens a pipe into which a thread writes the text as far as it is read. The thread waits for a reader and ends with
/// the tests.
#[cfg(unix)]
fn pipe(path: &Path, text: String) {
    assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    let path = path.to_owned();
    std::thread::spawn(move || drop(fs::write(path, text)));
}

#[test]
#[cfg(unix)]
fn what_a_model_names_is_never_a_pipe_or_device() {
    let folder = folder("pipes");
    pipe(&folder.join("model/mesh.obj"), TETRAHEDRON.into());
    pipe(&folder.join("model/part.xml"), "<mujocoinclude/>".into());
    std::os::unix::fs::symlink("model/mesh.obj", folder.join("link.obj")).unwrap();
    let _socket = std::os::unix::net::UnixListener::bind(folder.join("model/socket.obj"));
    let mesh = |file: &str| {
        format!(
            "<mujoco><asset><mesh name='m' file='{file}'/></asset><worldbody>\n<geom type='mesh' mesh='m'/></worldbody></mujoco>"
        )
    };
    let urdf = |file: &str| {
        let geometry = format!("<geometry><mesh filename='{file}'/></geometry>");
        format!("<robot name='r'><link name='a'><collision>{geometry}</collision></link></robot>")
    };
    let pipe = "is a pipe; a model's files are regular ones";
    let device = "is a device or socket; only files are read";
    for (text, path, why) in [
        (mesh("model/mesh.obj"), "model/mesh.obj", pipe),
        (mesh("link.obj"), "link.obj", pipe),
        (urdf("model/mesh.obj"), "model/mesh.obj", pipe),
        (urdf("package://model/mesh.obj"), "package://model/mesh.obj", pipe),
        ("<mujoco><include file='model/part.xml'/></mujoco>".into(), "model/part.xml", pipe),
        (mesh("model/socket.obj"), "model/socket.obj", device),
        (urdf("model"), "model", "is a folder"),
    ] {
        let options =
            ReadOptions { root: Some(folder.clone()), packages: vec![folder.clone()], ..ReadOptions::default() };
        let error = Imported::from_text(&text, &options).unwrap_err();
        let place = SourceLocation { file: "text".into(), line: 1 };
        assert_eq!(error, ReadError::Path { place, path: path.into(), why }, "{text}");
    }
    let options = ReadOptions { root: Some("/dev".into()), ..ReadOptions::default() };
    for text in [mesh("zero"), urdf("zero")] {
        let error = Imported::from_text(&text, &options).unwrap_err();
        assert!(matches!(error, ReadError::Path { why, .. } if why == device), "{error}");
    }
}

#[test]
#[cfg(unix)]
fn the_model_itself_may_come_from_a_pipe() {
    let folder = folder("piped");
    let robot = "<robot name='r'><link name='a'/></robot>";
    pipe(&folder.join("whole.urdf"), robot.into());
    let reading = Imported::from_file(folder.join("whole.urdf"), &ReadOptions::default()).unwrap();
    assert_eq!(reading.robot.segments.len(), 1);
    pipe(&folder.join("long.urdf"), format!("{robot}{}", " ".repeat(10_000_000)));
    let limits = Limits { bytes: 1000, ..Limits::default() };
    let error = Imported::from_file(folder.join("long.urdf"), &ReadOptions { limits, ..ReadOptions::default() });
    assert!(matches!(error, Err(ReadError::TooMuch { what: "bytes in a file", limit: 1000, .. })), "{error:?}");
    for (path, why) in [("/dev/zero", "is a device or socket; only files are read"), ("/dev", "is a folder")] {
        let error = Imported::from_file(Path::new(path), &ReadOptions::default()).unwrap_err();
        assert_eq!(error, ReadError::File { path: path.into(), why: why.into() });
    }
}
