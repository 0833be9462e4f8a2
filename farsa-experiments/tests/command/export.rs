//! `farsa export`: robots, controllers and starts for other simulators.

use std::fs;
use std::path::Path;

use farsa_experiments::minimal_cognition::LAYOUT as AGENT;
use farsa_nn::bytes::{CtrnnBytes, LeakyNetworkBytes, channel_hash};
use farsa_nn::{Leak, LeakyLayout};
use safetensors::SafeTensors;

use crate::tool::{farsa, ok, own, say, scratch};

#[test]
fn the_robot_is_written_once() {
    let here = scratch("export");
    let printed = ok(farsa(), &here, "export robot reach-grasp-lift --format mjcf");
    for part in ["name=\"J27\"", "<freejoint", "timestep=\"0.005\"", "<key name=\"start4\"", "geom1=\"sphere\""] {
        assert!(printed.contains(part), "no {part}");
    }
    let to_file = "export robot reach-grasp-lift --condition no-labels --format mjcf --out robot.xml";
    assert_eq!(ok(farsa(), &here, to_file), "");
    assert_eq!(fs::read_to_string(here.join("robot.xml")).expect("the file"), printed);
    let said = say(farsa(), &here, to_file);
    assert!(said.code == Some(2) && said.err.contains("robot.xml: there is one already"), "{said:?}");
    let coarse = ok(farsa(), &here, "export robot reach-grasp-lift --format mjcf --set world.substeps=1");
    assert!(coarse.contains("timestep=\"0.01\""));
    let urdf = ok(farsa(), &here, "export robot reach-grasp-lift --format urdf");
    assert!(urdf.starts_with("<?xml") && urdf.contains("<link name=\"palm\">"));
}

#[test]
fn what_cannot_be_exported_is_said() {
    let here = scratch("export-nothing");
    ok(own(), &here, "run cart --generations 1 --quiet --out r");
    for (program, arguments, word) in [
        (own(), "export robot cart --format mjcf", "cart has no robot"),
        (own(), "export robot crat --format mjcf", "`cart`"),
        (farsa(), "export robot reach-grasp-lift --format mjfc", "'mjcf'"),
        (farsa(), "export robot reach-grasp-lift", "--format"),
        (farsa(), "export robot reach-grasp-lift --format urdf --set world.substep=2", "world.substeps"),
        (farsa(), "export robto reach-grasp-lift", "'robot'"),
        (farsa(), "export controller nowhere --format json", "nowhere"),
        (farsa(), "export starts nowhere --format json", "nowhere"),
        (farsa(), "export controller nowhere --format mjcf", "'mjcf'"),
        (own(), "export controller r --format json", "cart: its controllers cannot be exported"),
        (own(), "export starts r --format json", "cart: its starts cannot be exported"),
    ] {
        let said = say(program, &here, arguments);
        assert_eq!(said.code, Some(2), "{arguments}: {said:?}");
        assert!(said.err.contains(word), "{arguments}: no {word} in {said:?}");
    }
}

#[test]
fn a_champion_is_written_with_its_channels_and_starts() {
    let here = scratch("export-controller");
    ok(farsa(), &here, "run reach-grasp-lift --generations 1 --quiet --set trial.steps=2 --out r");
    let printed = ok(farsa(), &here, "export controller r --format json");
    let told: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
    let count = |what: &serde_json::Value| what.as_array().map_or(0, Vec::len);
    assert_eq!([count(&told["sensors"]), count(&told["motors"]), count(&told["actuators"])], [29, 23, 27]);
    let kinds = ["sensor_weights", "recurrent_weights", "output_weights", "biases", "leaks"];
    assert_eq!(kinds.map(|kind| count(&told["network"][kind])), [348, 144, 276, 12, 12]);
    assert_eq!(
        (&told["format"], &told["network"]["leak"], &told["generation"]),
        (&1.into(), &"filter".into(), &0.into())
    );
    assert_eq!(told["sensors"][0]["reads"], "joint-position");
    assert_eq!(told["motors"][16]["servos"][1]["actuator"], "J11");
    assert!(told["actuators"][0]["law"]["muscle-pair"]["tension"].is_number());
    ok(farsa(), &here, "export controller r --format json --out c.json");
    assert_eq!(fs::read_to_string(here.join("c.json")).expect("the file"), printed);
    the_same_in_other_formats(&here, &told);

    let starts = |seed: u32| {
        let printed = ok(farsa(), &here, &format!("export starts r --trials 9 --seed {seed} --format json"));
        serde_json::from_str::<serde_json::Value>(&printed).expect("JSON")["starts"].clone()
    };
    let (first, other) = (starts(1), starts(2));
    assert_eq!((count(&first), count(&first[0]["joints"]), first == starts(1)), (9, 27, true));
    // The same place of the table, displaced again.
    assert!(first[0] != first[4] && first[0] != other[0] && first[0]["bodies"][0][0] == "sphere");
}

/// Bytes, Rust and tables hold the values in the JSON of the same run.
fn the_same_in_other_formats(here: &Path, told: &serde_json::Value) {
    let written = |format: &str| {
        ok(farsa(), here, &format!("export controller r --format {format} --out c.{format}"));
        fs::read(here.join(format!("c.{format}"))).expect("the file")
    };
    let kinds = ["sensor_weights", "recurrent_weights", "output_weights", "biases", "leaks"];
    let values = |kind: &str| serde_json::from_value::<Vec<f32>>(told["network"][kind].clone()).expect("numbers");
    let names = |of: &str| {
        let channels = told[of].as_array().into_iter().flatten();
        channels.map(|channel| channel["name"].as_str().unwrap_or("").to_owned()).collect::<Vec<_>>()
    };

    let bytes = written("bytes");
    let read = LeakyNetworkBytes::read(&bytes).expect("a network");
    let mut parameters = vec![0.0; read.layout().parameter_count()];
    read.copy_parameters(&mut parameters).expect("the length");
    assert_eq!(parameters, kinds.map(values).concat());
    assert_eq!((read.layout(), read.leak()), (LeakyLayout::new(29, 12, 23), Leak::Filter));
    assert_eq!(read.channels(), channel_hash(names("sensors"), names("motors")));

    let rust = String::from_utf8(written("rust")).expect("text");
    for part in [
        "LeakyLayout::new(29, 12, 23).with_slope(0.2);".to_owned(),
        "LEAK: Leak = Leak::Filter;".to_owned(),
        format!("CHANNELS: u64 = {:#018x};", read.channels()),
        format!("{:?}, {:?},", parameters[0], parameters[1]),
        "\"touch thumb\",".to_owned(),
    ] {
        assert!(rust.contains(&part), "no {part} in {rust}");
    }
    let (_, list) =
        rust.split_once("PARAMETERS").and_then(|(_, rest)| rest.split_once("&[\n")).expect("the parameters");
    let listed = list.split(',').filter_map(|number| number.trim().parse::<f32>().ok());
    assert!(listed.eq(parameters.iter().copied()));

    let source = String::from_utf8(written("c")).expect("text");
    let header = fs::read_to_string(here.join("c.h")).expect("the header");
    assert!(source.contains("int c_selftest(void)") && header.contains("#define C_INPUTS 29"), "{header}");
    assert!(header.contains(" *   28 ") && header.contains("void c_step("), "{header}");
    ok(farsa(), here, "export controller r --format c-integers --out integers");
    assert!(fs::read_to_string(here.join("integers.c")).expect("the source").contains("STORED int16_t"));
    for (out, word) in
        [("c.cpp", "for example c.c"), ("3.c", "for example controller_3"), ("c.h", "there is one already")]
    {
        let said = say(farsa(), here, &format!("export controller r --format c --out {out}"));
        assert!(said.code == Some(2) && said.err.contains(word), "{out}: {said:?}");
    }

    let tables = written("safetensors");
    let (_, head) = SafeTensors::read_metadata(&tables).expect("tables");
    let about = head.metadata().as_ref().and_then(|texts| texts.get("farsa")).expect("what it is");
    let about: serde_json::Value = serde_json::from_str(about).expect("JSON");
    assert_eq!((&about["seed"], &about["network"]["leak"]), (&told["seed"], &"filter".into()));
    assert_eq!(about["network"]["leaks"], serde_json::Value::Null);
    let tables = SafeTensors::deserialize(&tables).expect("tables");
    for (kind, shape) in kinds.into_iter().zip([&[29, 12][..], &[12, 12], &[12, 23], &[12], &[12]]) {
        let table = tables.tensor(kind).expect("the table");
        let numbers = table.data().chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().expect("4")));
        assert_eq!((table.shape(), numbers.collect::<Vec<_>>()), (shape, values(kind)), "{kind}");
    }
}

#[test]
fn a_continuous_time_network_is_written_in_all_formats() {
    let here = scratch("export-ctrnn");
    ok(farsa(), &here, "run minimal-cognition --generations 1 --population 20 --quiet --out r");
    ok(farsa(), &here, "export controller r --format bytes --out c.bytes");
    let bytes = fs::read(here.join("c.bytes")).expect("the file");
    let read = CtrnnBytes::read(&bytes).expect("a continuous-time network");
    let rays: Vec<String> = (1..=7).map(|ray| format!("ray {ray}")).collect();
    assert_eq!((read.layout(), read.channels()), (AGENT, channel_hash(rays, ["right", "left"])));
    let mut parameters = vec![0.0; AGENT.parameter_count()];
    read.copy_parameters(&mut parameters).expect("the length");
    let parts = AGENT.split(&parameters);
    // The same on both sides, and no champion of nothing.
    assert!(parts.time_constants[7] == parts.time_constants[11] && parts.weights.iter().any(|w| *w != 0.0));
    let told: serde_json::Value =
        serde_json::from_str(&ok(farsa(), &here, "export controller r --format json")).expect("JSON");
    assert_eq!((&told["network"]["kind"], &told["network"]["neurons"]), (&"ctrnn".into(), &14.into()));
    let ray = &told["sensors"][0];
    assert_eq!(["name", "reads"].map(|key| ray[key].as_str()), [Some("ray 1"), Some("quantity")]);
    assert_eq!(["zero", "one"].map(|key| ray[key].as_f64()), [Some(220.0), Some(198.0)]);
    let rust = ok(farsa(), &here, "export controller r --format rust");
    for part in
        ["CtrnnLayout::new(7, 14, 2)", ".with_direct_inputs(0)", "Integrator::", "TIME_STEP: f32 = ", "`ray 1` reads"]
    {
        assert!(rust.contains(part), "no {part} in {rust}");
    }
    ok(farsa(), &here, "export controller r --format safetensors --out c.safetensors");
    let tables = fs::read(here.join("c.safetensors")).expect("the file");
    let tables = SafeTensors::deserialize(&tables).expect("tables");
    assert_eq!(tables.tensor("weights").expect("the table").shape(), [14, 14]);
    assert_eq!(tables.tensor("input_weights").expect("the table").shape(), [0, 14]);
}

#[test]
fn networks_of_wheeled_robots_and_of_the_cart_are_written_in_all_formats() {
    let here = scratch("export-kinds");
    for (experiment, kind, part) in [
        ("discrimination", 4, "Perceptron::parameter_count(6, 2)"),
        ("double-pole", 5, "BlockLayout::new(6, 1, GROUPS, BLOCKS)"),
    ] {
        ok(
            farsa(),
            &here,
            &format!("run {experiment} --generations 1 --quiet --set trial.steps=100 --out {experiment}"),
        );
        let export = |format: &str| ok(farsa(), &here, &format!("export controller {experiment} --format {format}"));
        assert!(export("json").contains("\"reads\": \"quantity\""));
        let rust = export("rust");
        assert!(rust.contains(part), "no {part} in {rust}");
        for format in ["bytes", "safetensors"] {
            ok(
                farsa(),
                &here,
                &format!("export controller {experiment} --format {format} --out {experiment}.{format}"),
            );
        }
        let bytes = fs::read(here.join(format!("{experiment}.bytes"))).expect("the file");
        assert_eq!((&bytes[..8], bytes[12]), (&b"FARSA-NN"[..], kind), "{experiment}");
        let tables = fs::read(here.join(format!("{experiment}.safetensors"))).expect("the file");
        assert!(SafeTensors::deserialize(&tables).is_ok_and(|tables| tables.tensor("weights").is_ok()), "{experiment}");
    }
}

#[test]
fn of_several_populations_one_is_named() {
    let here = scratch("export-populations");
    ok(farsa(), &here, "run predator-prey --generations 1 --population 16 --quiet --set trial.steps=2 --out r");
    let said = say(farsa(), &here, "export controller r --format json");
    assert!(said.code == Some(2) && said.err.contains("predator and prey: name one"), "{said:?}");
    let said = say(farsa(), &here, "export controller r --format json --population pray");
    assert!(said.code == Some(2) && said.err.contains("`prey`"), "{said:?}");
    let [predator, prey] = ["predator", "prey"].map(|name| {
        let told = ok(farsa(), &here, &format!("export controller r --format json --population {name}"));
        let told: serde_json::Value = serde_json::from_str(&told).expect("JSON");
        assert_eq!(told["population"], name);
        told["network"]["biases"].clone()
    });
    assert_ne!(predator, prey);
}
