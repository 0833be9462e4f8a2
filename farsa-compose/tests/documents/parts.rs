//! Every sensor, motor, wrapper and network of the libraries has a name in a file, or a reason why it has none.

use std::path::Path;

use serde_json::Value;

/// The list and the word of a public name of a library in a file. Without a word: the reason.
const NAMED: [(&str, &str, &str); 64] = [
    // Sensors.
    ("InfraredFormula", "sensors", "infrared"),
    ("InfraredRays", "", "part of InfraredGroups"),
    ("InfraredGroups", "sensors", "infrared"),
    ("InfraredDrawing", "", "for recordings"),
    ("SampledInfrared", "sensors", "infrared"),
    ("InfraredTables", "", "part of SampledInfrared"),
    ("InfraredTable", "", "part of SampledInfrared"),
    ("InfraredTableError", "", "an error"),
    ("InfraredModel", "", "what an arena computes InfraredFormula with"),
    ("LightSensors", "sensors", "light"),
    ("GroundColor", "sensors", "ground-color"),
    ("LaserDistance", "sensors", "laser-distance"),
    ("LinearCamera", "sensors", "camera"),
    ("ColorBand", "", "part of LinearCamera"),
    ("Camera", "", "part of the next three"),
    ("CameraImage", "sensors", "camera-image"),
    ("ColorBlobs", "sensors", "color-blobs"),
    ("VisualOffset", "sensors", "visual-offset"),
    ("WheelSpeed", "sensors", "wheel-speed"),
    ("Traction", "sensors", "traction"),
    ("SignalSensor", "sensors", "signal"),
    ("AttachmentSensor", "sensors", "attachment"),
    ("Touch", "sensors", "touch"),
    ("ContactForce", "sensors", "contact-force"),
    ("TargetPosition", "sensors", "target-position"),
    ("Axes", "", "part of TargetPosition and BodyVelocity"),
    ("Point", "", "part of TargetPosition and Height"),
    ("BodyPose", "sensors", "body-pose"),
    ("BodyVelocity", "sensors", "body-velocity"),
    ("Height", "sensors", "height"),
    ("JointPosition", "sensors", "joint-position"),
    ("JointSpeed", "sensors", "joint-speed"),
    ("Signal", "sensors", "constant"),
    ("Beam", "", "part of several sensors"),
    // Motors.
    ("WheelVelocity", "motors", "wheels"),
    ("SpeedAndTurn", "motors", "speed-and-turn"),
    ("Leds", "motors", "leds"),
    ("SignalMotor", "motors", "signal"),
    ("AttachmentMotor", "motors", "attachment"),
    ("Muscles", "motors", "muscles"),
    ("ServoGroup", "motors", "servo"),
    ("ServoRange", "", "part of ServoGroup"),
    ("TorqueMotor", "motors", "joint-torque"),
    ("VelocityMotor", "motors", "joint-velocity"),
    ("HeadTracking", "", "no motor: a reflex of built-in experiments"),
    // Wrappers.
    ("Noisy", "wrappers", "uniform-noise"),
    ("Noise", "wrappers", "normal-noise"),
    ("Delayed", "wrappers", "delay"),
    ("Scaled", "wrappers", "scale"),
    ("Saturated", "wrappers", "saturate"),
    ("Thresholded", "wrappers", "threshold"),
    ("Lesioned", "wrappers", "lesion"),
    ("Stuck", "wrappers", "stuck"),
    ("StuckAt", "", "part of Stuck"),
    ("Recorded", "", "changes nothing; for programs that look at the last values"),
    // Networks.
    ("Perceptron", "network", "perceptron"),
    ("LeakyNetwork", "network", "leaky"),
    ("Ctrnn", "network", "ctrnn"),
    ("BlockNetwork", "network", "blocks"),
    ("Architecture", "network", "jordan"),
    ("Evonet", "network", "evonet"),
    ("PerceptronLanes", "", "perceptrons side by side"),
    ("QuantizedNetwork", "", "a network for boards, made of an evolved one"),
    ("Network", "", "the holder of the four kinds above"),
];

/// The public names that a source re-exports and that begin with a capital letter.
fn exported(path: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let uses = text.split("pub use ").skip(1).map(|rest| rest.split(';').next().unwrap_or_default());
    let words = uses.flat_map(|list| list.split(|c: char| !c.is_alphanumeric() && c != '_'));
    words.filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase())).map(str::to_owned).collect()
}

/// Returns the valid kinds of a part, of a list of the schema or of a definition.
fn kinds(schema: &Value, list: &str) -> Vec<String> {
    let name = match list {
        "sensors" => "Sensor",
        "motors" => "Motor",
        "wrappers" => "Wrapper",
        _ => "Network",
    };
    let branches = schema.pointer(&format!("/$defs/{name}/oneOf")).and_then(Value::as_array).expect("its kinds");
    let word = |branch: &Value| branch.pointer("/properties/kind/const").and_then(Value::as_str).map(str::to_owned);
    branches.iter().filter_map(word).collect()
}

#[test]
fn every_part_of_the_libraries_has_a_name_or_a_reason() {
    let schema = farsa_compose::schema();
    let mut count = 0;
    let modules = ["sensors/mod.rs", "sensors/infrared/mod.rs", "motors/mod.rs", "wrappers/mod.rs"];
    for source in modules.map(|module| format!("farsa-body/src/{module}")) {
        let source = source.as_str();
        for name in exported(source) {
            assert!(NAMED.iter().any(|(known, ..)| *known == name), "{source}: `{name}` has no name in a file");
            count += 1;
        }
    }
    assert!(count > 40, "{count} names were found");
    let sources = ["lib.rs", "block/mod.rs", "quantized/mod.rs"].map(|source| format!("farsa-nn/src/{source}"));
    let networks = sources.iter().flat_map(|source| exported(source)).filter(|name| {
        ["Network", "Ctrnn", "Perceptron", "Evonet", "Architecture"].iter().any(|part| name.contains(part))
    });
    let parts = ["Layout", "Parameter", "Parts", "Symmetry", "Ranges", "Bytes"];
    for name in networks.filter(|name| !parts.iter().any(|part| name.ends_with(part))) {
        assert!(NAMED.iter().any(|(known, ..)| *known == name), "`{name}` has no name in a file");
    }
    for (name, list, word) in NAMED {
        assert!(list.is_empty() || kinds(&schema, list).iter().any(|kind| kind == word), "{name}: no `{word}`");
    }
}
