//! Every kind of the schema has a value in this program, for robots on wheels and for those with joints.

use std::fmt::Write as _;

use serde_json::Value;

use crate::{drives, joints, refused, senses, teams, wheels, wrappers};

/// Returns the kinds of a definition of the schema.
fn kinds(definition: &str) -> Vec<String> {
    let schema = farsa_compose::schema();
    let branches = schema.pointer(&format!("/$defs/{definition}/oneOf")).and_then(Value::as_array).expect("kinds");
    let word = |branch: &Value| branch.pointer("/properties/kind/const").and_then(Value::as_str).map(str::to_owned);
    let found: Vec<String> = branches.iter().filter_map(word).collect();
    assert!(found.len() > 5, "{definition}: {found:?}");
    found
}

/// Kinds with values in `tests/jointed/eyes.rs`, by rays through the middles of pixels.
const SEEN: [&str; 4] = ["camera", "camera-image", "color-blobs", "visual-offset"];
/// Terms of food and groups in `teams.rs`.
const OF_TEAMS: [&str; 10] = [
    "food",
    "carried-food",
    "lost-food",
    "deaths",
    "energy",
    "alive",
    "held",
    "time-left",
    "fullest-area",
    "exchanges",
];

const ALL: &str = "eye = { columns = 1, rows = 1, field_of_view = 60, range = 1 }\n";

/// Kinds without a value for wheels, and for joints, with the keys that they need. They are refused there.
const NOT_ON_WHEELS: [(&str, &str, &str); 12] = [
    ("reward", "height", ""),
    ("reward", "upright", ""),
    ("reward", "joint-speed", ""),
    ("reward", "joint-position", "joint = \"hinge\"\n"),
    ("reward", "joint-velocity", "joint = \"hinge\"\n"),
    ("sensors", "camera-image", ALL),
    ("sensors", "color-blobs", "colors = []\n"),
    ("sensors", "visual-offset", "of = \"lamp\"\nfrom = \"lamp\"\n"),
    ("motors", "joint-velocity", "largest = 1.0\n"),
    ("motors", "joint-torque", ""),
    ("motors", "servo", ""),
    ("motors", "muscles", ""),
];
const NOT_OF_JOINTS: [(&str, &str, &str); 36] = [
    ("reward", "angle", "object = \"lamp\"\n"),
    ("reward", "wheel-speed", ""),
    ("reward", "wheel-difference", ""),
    ("reward", "straight-on", ""),
    ("reward", "in-area", "area = \"lamp\"\n"),
    ("reward", "fullest-area", "area = \"lamp\"\n"),
    ("reward", "robots-in-area", "area = \"lamp\"\n"),
    ("reward", "dispersion", ""),
    ("reward", "clusters", ""),
    ("reward", "largest-cluster", ""),
    ("reward", "near-others", ""),
    ("reward", "exchanges", "area = \"lamp\"\nwith = \"lamp\"\n"),
    ("reward", "food", ""),
    ("reward", "carried-food", ""),
    ("reward", "lost-food", ""),
    ("reward", "deaths", ""),
    ("reward", "energy", ""),
    ("reward", "alive", ""),
    ("reward", "held", ""),
    ("reward", "gap", "object = \"lamp\"\n"),
    ("reward", "time-left", "rest = \"robot\"\n"),
    ("sensors", "infrared", ""),
    ("sensors", "light", ""),
    ("sensors", "ground-color", ""),
    ("sensors", "laser-distance", "beams = 1\nfield_of_view = 1\nrange = 1\n"),
    ("sensors", "wheel-speed", ""),
    ("sensors", "traction", "largest = 1\n"),
    ("sensors", "signal", "range = 1\n"),
    ("sensors", "attachment", ""),
    ("sensors", "energy", ""),
    ("sensors", "carried", ""),
    ("motors", "wheels", ""),
    ("motors", "speed-and-turn", ""),
    ("motors", "leds", "colors = [\"red\"]\n"),
    ("motors", "signal", ""),
    ("motors", "attachment", ""),
];

/// A file with a part of this kind.
fn file(wheels: bool, list: &str, kind: &str, keys: &str) -> String {
    let robot = if wheels {
        "[robot]\nkind = \"e-puck\"\n"
    } else {
        "[world]\nengine = \"articulated\"\n[robot]\nkind = \"arm-and-hand\"\n"
    };
    let mut text = format!("{robot}[network]\nkind = \"perceptron\"\n");
    let motor = if wheels { "wheels" } else { "muscles" };
    for (own, plain) in [("sensors", "constant\"\nvalue = \"1"), ("motors", motor), ("reward", "steps")] {
        let (plain, keys) = if own == list { (kind, keys) } else { (plain, "") };
        let _ = write!(text, "[[{own}]]\nkind = \"{plain}\"\n{keys}");
    }
    text.replace("value = \"1\"", "value = 1")
}

#[test]
fn each_kind_has_a_value_or_is_refused() {
    let terms_on_wheels =
        wheels::TERMS.iter().map(|(kind, ..)| *kind).chain(teams::TERMS.iter().map(|(kind, ..)| *kind));
    let terms_on_wheels: Vec<&str> = terms_on_wheels.chain(OF_TEAMS).collect();
    let terms_of_joints: Vec<&str> = joints::TERMS.iter().map(|(kind, ..)| *kind).collect();
    let of_joints: Vec<&str> = joints::SENSORS.iter().copied().chain(SEEN).chain(["touch", "contact-force"]).collect();
    for (list, definition, on_wheels, of_joints) in [
        ("reward", "Reward", &terms_on_wheels[..], &terms_of_joints[..]),
        ("sensors", "Sensor", senses::SENSORS, &of_joints[..]),
        ("motors", "Motor", drives::MOTORS, joints::MOTORS),
        ("wrappers", "Wrapper", wrappers::WRAPPERS, wrappers::WRAPPERS),
    ] {
        for kind in kinds(definition) {
            for (wheels, valued, others) in
                [(true, on_wheels, &NOT_ON_WHEELS[..]), (false, of_joints, &NOT_OF_JOINTS[..])]
            {
                let other = others.iter().find(|(known, name, _)| *known == list && *name == kind);
                match other {
                    None => {
                        assert!(valued.contains(&kind.as_str()), "{list}: `{kind}` has no value, on wheels: {wheels}");
                    }
                    Some((_, _, keys)) => {
                        assert!(!valued.contains(&kind.as_str()), "{list}: `{kind}` has a value and is refused");
                        let error = refused(&file(wheels, list, &kind, keys));
                        let known =
                            ["is for robots", "needs joints", "lacks the key"].iter().any(|why| error.contains(why));
                        assert!(known, "{list}: {kind}: {error}");
                    }
                }
            }
        }
    }
}
