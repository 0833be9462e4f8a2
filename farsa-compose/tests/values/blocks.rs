//! Blocks that robots push, with all kinds of things next to them. They need the engine rapier.

use std::fmt::Write as _;

use crate::starts::{places, spans};
use crate::{Trial, close, distance, refused};

const THINGS: [(&str, &str, [f64; 2]); 5] = [
    ("crate", "kind = \"block\"\nsize = [0.2, 0.1, 0.08]\nmass = 0.05", [1.2, 0.8]),
    ("post", "kind = \"cylinder\"\nradius = 0.05", [2.5, 0.4]),
    ("pond", "kind = \"disc\"\nradius = 0.2\ncolor = [0, 0, 0]\nheading = 30", [2.2, 1.9]),
    ("box", "kind = \"block\"\nsize = [0.1, 0.3, 0.08]\nmass = 0.2\nheading = 30", [0.4, 1.9]),
    ("yard", "kind = \"rectangle\"\nsize = [0.2, 0.5]\ncolor = [0, 0, 0]", [1.7, 0.3]),
];

fn file(rest: &str) -> String {
    let mut text =
        "world = { engine = \"rapier\", size = [3.1, 2.3], time_step = 0.05 }\nrobot = { kind = \"e-puck\" }\n\
         sensors = [{ kind = \"constant\", value = 1.0 }]\nmotors = [{ kind = \"wheels\" }]\n\
         network = { kind = \"wired\", bias = [0.9, 0.9], wires = [] }\nepisode = { steps = 40, trials = 1 }\n\
         start = [{ place = \"robot\", at = \"fixed\", point = [1.0, 0.8] }]\n"
            .to_owned();
    for (name, keys, at) in THINGS {
        let _ = writeln!(text, "[[objects]]\nname = \"{name}\"\n{keys}\nat = {at:?}");
        for term in ["distance", "moved"] {
            let _ = writeln!(text, "[[reward]]\nname = \"{term}-{name}\"\nkind = \"{term}\"\nobject = \"{name}\"");
        }
    }
    text + rest
}

/// The robot drives along x at 0.1152 m/s. The crate is 0.065 m before its hull. After 2 s it has pushed it along.
#[test]
fn a_block_is_pushed_and_the_rest_stays() {
    let trial = Trial::new(&file(""));
    for step in 0..40 {
        let robot = [trial.column("x [m]")[step], trial.column("y [m]")[step]];
        for (name, _, at) in THINGS {
            let moved = trial.column(&format!("moved-{name}"))[step];
            if name != "crate" {
                close(moved, 0.0, 1e-4, &format!("{name} after step {}", step + 1));
            }
            let at = if name == "crate" { [at[0] + moved, at[1]] } else { at };
            let found = trial.column(&format!("distance-{name}"))[step];
            close(found, distance(robot, at), 2e-3, &format!("distance from {name} after step {}", step + 1));
        }
    }
    let moved = trial.column("moved-crate");
    assert!(moved[7] < 1e-4 && (0.1..0.2).contains(&moved[39]), "{moved:?}");
    // Bodies are robots, cylinders, areas and blocks.
    let found = places(&file("").replace("steps = 40", "steps = 1"), &[1, 2, 3, 5]);
    for (index, name) in ["post", "pond", "yard", "box"].into_iter().enumerate() {
        let (_, _, at) = THINGS.into_iter().find(|(known, ..)| *known == name).expect("a thing");
        let [x, y, heading] = found[0][index];
        close(distance([x, y], at), 0.0, 1e-4, name);
        close(heading, if ["box", "pond"].contains(&name) { 30_f64.to_radians() } else { 0.0 }, 1e-4, name);
    }
    for (term, keys) in [("near", "within = 0.1\n"), ("gap", ""), ("contact", "")] {
        let term = format!("[[reward]]\nname = \"own\"\nkind = \"{term}\"\nobject = \"crate\"\n{keys}");
        assert!(refused(&file(&term)).contains("`crate` is no cylinder"), "{term}");
    }
    let why = "is a block, which nothing pushes in the engine `arena`";
    assert!(refused(&file("").replace("\"rapier\"", "\"arena\"")).contains(why));
}

/// A block is placed with half its diagonal of 0.1118 m from the walls and 0.4 m from the post, and its heading is drawn.
#[test]
fn blocks_start_by_their_diagonals() {
    let text = "world = { engine = \"rapier\", size = [1.2, 0.9], time_step = 0.05 }\nrobot = { kind = \"e-puck\" }\n\
        sensors = [{ kind = \"constant\", value = 1.0 }]\nmotors = [{ kind = \"wheels\" }]\n\
        network = { kind = \"wired\", bias = [0.5, 0.5], wires = [] }\nepisode = { steps = 1, trials = 1 }\n\
        reward = [{ kind = \"steps\" }]\n\
        objects = [{ name = \"post\", kind = \"cylinder\", radius = 0.05, at = [0.6, 0.4] }, \
        { name = \"crate\", kind = \"block\", size = [0.2, 0.1, 0.08], mass = 0.05 }]\n\
        start = [{ place = \"crate\", at = \"anywhere\", apart = 0.1 }]\n";
    let found = places(text, &[2]);
    let reach = 0.5 * f64::sqrt(0.05);
    spans(found.iter().map(|bodies| bodies[0][0]), [reach, 1.2 - reach], "x");
    spans(found.iter().map(|bodies| bodies[0][1]), [reach, 0.9 - reach], "y");
    spans(found.iter().map(|bodies| bodies[0][2]), [-std::f64::consts::PI, std::f64::consts::PI], "heading");
    let far = found.iter().map(|bodies| distance([bodies[0][0], bodies[0][1]], [0.6, 0.4]));
    let least = far.fold(f64::INFINITY, f64::min);
    assert!((reach + 0.15 - 1e-5..reach + 0.2).contains(&least), "{least}");
}
