//! Meshes that views draw.

use std::fs;
use std::path::{Path, PathBuf};

use farsa_models::{DrawnMesh, Imported, Meshes, ReadOptions};

/// A cube with edges of 1 from the origin.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("cube.obj"), CUBE).unwrap();
    folder
}

fn read(folder: &Path, text: &str) -> Imported {
    Imported::from_text(text, &ReadOptions { root: Some(folder.into()), ..ReadOptions::default() }).unwrap()
}

/// Computes the least and greatest coordinates of a mesh, rounded to a millionth.
fn bounds(mesh: &DrawnMesh) -> [[f64; 3]; 2] {
    let most = |sign: f64| [0, 1, 2].map(|k| mesh.points.iter().map(|p| sign * p[k]).fold(f64::NEG_INFINITY, f64::max));
    [most(-1.0).map(|x| -x), most(1.0)].map(|end| end.map(|x| (x * 1e6).round() / 1e6 + 0.0))
}

/// Computes the volume within a closed mesh, which is negative if its triangles face inward.
fn volume(mesh: &DrawnMesh) -> f64 {
    let six = |corners: &[usize; 3]| {
        let [a, b, c] = corners.map(|i| mesh.points[i]);
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    mesh.triangles.iter().map(six).sum::<f64>() / 6.0
}

#[test]
fn visuals_of_a_urdf_are_preferred_to_its_collision_meshes() {
    let folder = folder("drawn_urdf");
    let mesh = |scale: &str| format!("<geometry><mesh filename='cube.obj' scale='{scale}'/></geometry>");
    let link = |name: &str, parts: &str| format!("<link name='{name}'>{parts}</link>");
    let visual = |rest: &str| format!("<visual><origin xyz='1 0 0' rpy='0 0 1.5707963267948966'/>{rest}</visual>");
    let collision = format!("<collision><origin xyz='0 0 3'/>{}</collision>", mesh("1 1 1"));
    let paint = "<material name='red'><color rgba='1 0 0 1'/></material>";
    let ball = visual("<geometry><sphere radius='0.5'/></geometry>");
    let text = format!(
        "<robot name='r'>{}{}{}{}{}</robot>",
        link("both", &format!("{}{ball}{collision}", visual(&format!("{}{paint}", mesh("2 1 -1"))))),
        link("touching", &collision),
        link("plain", &format!("{ball}{collision}")),
        link("collada", &format!("{}{collision}", visual(&mesh("1 1 1").replace("cube.obj", "cube.dae")))),
        ["touching", "plain", "collada"]
            .map(|name| format!(
                "<joint name='{name}' type='fixed'><parent link='both'/><child link='{name}'/></joint>"
            ))
            .concat(),
    );
    let found = read(&folder, &text);
    let of = |name: &str| {
        let body = found.robot.body(name);
        found.meshes.iter().filter(|mesh| mesh.body == body).collect::<Vec<_>>()
    };
    let [cube, sphere] = of("both")[..] else { panic!("{:?}", found.meshes) };
    assert_eq!((cube.color, cube.collider, cube.triangles.len()), (Some([1.0, 0.0, 0.0]), None, 12));
    // The cube is scaled, then turned by 90 degrees and moved.
    assert_eq!(bounds(cube), [[0.0, 0.0, -1.0], [1.0, 2.0, 0.0]]);
    assert!((volume(cube) - 2.0).abs() < 1e-9 && sphere.color.is_none());
    assert_eq!(bounds(sphere)[1][2], 0.5);
    for (name, count) in [("touching", 1), ("plain", 0), ("collada", 1)] {
        assert_eq!(of(name).len(), count, "{name}");
    }
    let collider = found.robot.colliders.iter().position(|collider| collider.body == found.robot.body("touching"));
    assert_eq!((of("touching")[0].collider, bounds(of("touching")[0])[1]), (collider, [1.0, 1.0, 4.0]));
    assert!(found.warnings.iter().any(|warning| warning.why.contains("with a mesh are left out")));
    // The robot is the same without the meshes for drawing.
    let bare = read(&folder, &text.replace(&visual(&format!("{}{paint}", mesh("2 1 -1"))), ""));
    assert_eq!((&bare.robot.colliders, &bare.robot.segments), (&found.robot.colliders, &found.robot.segments));
    let leave = ReadOptions { meshes: Meshes::Leave, ..ReadOptions::default() };
    assert!(Imported::from_text(&text, &leave).unwrap().meshes.is_empty());
}

#[test]
fn geoms_of_an_mjcf_are_drawn_where_mujoco_draws_them() {
    let folder = folder("drawn_mjcf");
    let text = "<mujoco><compiler angle='radian'/><default><default class='show'><geom contype='0' conaffinity='0'/></default>\
        </default><asset><mesh name='cube' file='cube.obj' scale='2 2 2' refpos='0.5 0 0' refquat='0.7071067811865476 0 0 0.7071067811865476'/>\
        <material name='green' rgba='0 1 0 1'/></asset><worldbody><geom name='wall' type='mesh' mesh='cube' pos='9 0 0'/>\
        <body name='dressed' pos='0 0 5'><joint name='hinge' pos='0 0 0.5'/><geom type='mesh' mesh='cube'/>\
        <frame pos='0 1 0'><geom class='show' type='mesh' mesh='cube' material='green' group='2'/></frame>\
        <geom class='show' type='mesh' mesh='cube' group='3'/><geom class='show' type='mesh' mesh='cube' rgba='0 1 0 0'/></body>\
        <body name='bare'><freejoint/><geom name='hull' type='mesh' mesh='cube' rgba='0 0 1 1'/><geom size='0.1'/></body>\
        </worldbody></mujoco>";
    let found = read(&folder, text);
    let [shown, wall, hull] = found.meshes.as_slice() else { panic!("{:?}", found.meshes) };
    // The point (1, 0, 0) of the file is at (0, -0.5, 0) from the origin of the mesh, and the scale doubles that.
    let [low, high] = bounds(wall);
    assert_eq!((low, high), ([9.0, -1.0, 0.0], [11.0, 1.0, 2.0]));
    assert_eq!((wall.body, wall.collider), (None, found.robot.colliders.iter().position(|c| c.name == "wall")));
    // The segment's frame is at its joint.
    assert_eq!(bounds(shown), [[0.0, 0.0, -0.5], [2.0, 2.0, 1.5]]);
    assert_eq!((shown.body, shown.collider, shown.color), (found.robot.body("dressed"), None, Some([0.0, 1.0, 0.0])));
    assert_eq!((hull.body, hull.color), (found.robot.body("bare"), Some([0.0, 0.0, 1.0])));
    assert!((volume(hull) - 8.0).abs() < 1e-9);
    let group = found.warnings.iter().find(|warning| warning.what == "geom of a mesh that touches nothing").unwrap();
    assert_eq!(group.count, 2);
}

#[test]
fn a_drawn_mesh_that_is_absent_is_a_warning() {
    let folder = folder("drawn_absent");
    let text = "<mujoco><asset><mesh name='none' file='none.obj'/></asset><worldbody><body name='b'><freejoint/>\
        <inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><geom size='0.1'/><geom type='mesh' mesh='none' contype='0' conaffinity='0'/></body></worldbody></mujoco>";
    let found = read(&folder, text);
    assert!(found.meshes.is_empty());
    assert!(found.warnings.iter().any(|warning| warning.what == "drawn mesh" && warning.why.contains("none.obj")));
}
