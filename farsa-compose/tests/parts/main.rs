//! Parts of a user's crate, one of each kind, in files for both worlds.

mod own;

use farsa_body::Recorder;
use farsa_body::ports::BodyId;
use farsa_body::testing::{check_motor, check_sensor};
use farsa_compose::{ComposedExperiment, FILES};
use farsa_lab::advanced::{Lanes, Recording, Vocabulary};
use farsa_lab::exports::NetworkExport;
use farsa_lab::strategy::strategies;
use farsa_lab::{EpisodeId, Error, Evaluation, Evaluator, Experiment as _, Note, Outcome, Settings};
use farsa_nn::{Controller as _, Perceptron};
use farsa_num::Instructions;
use serde_json::Value;

use own::{BearingSensor, TwistMotor, parts};

/// A robot on wheels with a part of each kind.
const WHEELS: &str = r#"
robot = { kind = "mini" }
objects = [{ name = "gate", kind = "gate", width = 0.3, at = [0.7, 0.5] }]
sensors = [{ kind = "bearing", to = "gate", reach = 2.0, wrappers = [{ kind = "smooth", rate = 0.5, noise = 0.01 }] }]
motors = [{ kind = "twist", largest = 4.0 }]
network = { kind = "echo", largest = 3.0 }
episode = { steps = 60, trials = 2 }
start = [{ place = "robot", at = "on-line", from = [0.2, 0.2, 0.0], to = [0.2, 0.8, 0.0] }]
end = [{ term = "path", above = 0.5 }]
[[reward]]
kind = "away"
from = "gate"
over = "end"
[[reward]]
kind = "distance"
object = "gate"
over = "end"
weight = 0.0
[[reward]]
kind = "path"
over = "end"
weight = 0.0
"#;

/// A robot with joints with a part of each kind that is for it.
const JOINTS: &str = r#"
robot = { kind = "turntable" }
world = { engine = "articulated", time_step = 0.01, floor = false, gravity = [0.0, 0.0, 0.0] }
objects = [{ name = "ball", kind = "ball", radius = 0.05, mass = 0.1 }]
sensors = [{ kind = "bearing", to = "ball", wrappers = [{ kind = "smooth", rate = 0.5 }] }, { kind = "joint-position" }]
motors = [{ kind = "twist", largest = 1.0 }]
network = { kind = "echo", largest = 3.0 }
episode = { steps = 60, trials = 2 }
start = [{ place = "ball", at = "on-line", from = [1.0, -1.0, 0.0], to = [1.0, 1.0, 0.0] }]
[[reward]]
kind = "away"
from = "ball"
over = "end"
[[reward]]
kind = "distance"
object = "ball"
over = "end"
weight = 0.0
[[reward]]
kind = "joint-speed"
over = "mean"
weight = 0.0
"#;

fn made(text: &str) -> Result<ComposedExperiment, Error> {
    let parts = parts();
    ComposedExperiment::from_text("own.toml", text, Vocabulary { strategies: strategies(), parts: &parts })
}

fn evaluator(text: &str) -> Box<dyn Evaluator> {
    let made = made(text).unwrap_or_else(|error| panic!("{error}"));
    made.prepare("", &Settings::new(made.settings("")).expect("settings")).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    made(text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string()
}

/// Parameters that differ between individuals.
fn parameters(evaluator: &dyn Evaluator, individual: usize) -> Vec<f32> {
    let mut stream = farsa_num::Stream::from_seed(individual as u64);
    evaluator.info().parameters.iter().map(|at| stream.range_f64(at.ends[0], at.ends[1]) as f32).collect()
}

fn jobs(all: &[Vec<f32>]) -> Vec<Evaluation<'_>> {
    let job = |number: usize| {
        let id = EpisodeId { seed: 3, generation: 1, individual: number as u32 / 2, trial: number as u32 % 2 };
        Evaluation { number, ..Evaluation::new(&all[number / 2], id) }
    };
    (0..2 * all.len()).map(job).collect()
}

#[test]
fn a_part_of_each_kind_works_in_both_worlds_and_in_lanes() {
    for text in [WHEELS, JOINTS] {
        let mut alone = evaluator(text);
        let all: Vec<Vec<f32>> = (0..6).map(|individual| parameters(alone.as_ref(), individual)).collect();
        let jobs = jobs(&all);
        let expected: Vec<Outcome> = jobs.iter().map(|job| alone.evaluate(*job, None)).collect();
        assert!(expected.iter().all(Outcome::is_finite), "{expected:?}");
        assert!(expected.windows(2).all(|pair| pair[0].terms != pair[1].terms), "{expected:?}");
        // Nothing is left of an episode.
        for (job, outcome) in jobs.iter().zip(&expected).rev() {
            assert_eq!(alone.evaluate(*job, None), *outcome);
        }
        for count in [1, 8, 16] {
            let mut lanes = evaluator(text);
            let side_by_side = lanes.in_lanes().expect("both worlds have lanes");
            let lanes =
                Lanes::new(count, Instructions::detect()).or_else(|_| Lanes::new(count, Instructions::baseline()));
            side_by_side.use_lanes(lanes.expect("lanes")).expect("a batch");
            let (mut next, mut found) = (jobs.iter(), vec![None; jobs.len()]);
            side_by_side
                .run_in_lanes(&mut || next.next().copied(), &mut |number, outcome| found[number] = Some(outcome));
            let found: Vec<Outcome> = found.into_iter().flatten().collect();
            assert_eq!(found, expected, "{count} lanes");
        }
    }
}

#[test]
fn an_own_term_has_the_bits_of_the_equal_term_of_the_format() {
    for (text, thing) in [(WHEELS, "gate"), (JOINTS, "ball")] {
        let mut evaluator = evaluator(text);
        let all = [parameters(evaluator.as_ref(), 1)];
        for job in jobs(&all) {
            let outcome = evaluator.evaluate(job, None);
            let distance = outcome.notes.iter().find(|(name, _)| *name == "measured distance");
            assert!(outcome.terms[0] > 0.1, "{outcome:?} {thing}");
            // The plane measures in single precision, space in double precision.
            match distance {
                Some((_, Note::Number(distance))) => {
                    assert!((outcome.terms[0] - distance).abs() <= 1e-6 * distance, "{outcome:?}");
                    assert!(text == WHEELS || outcome.terms[0].to_bits() == distance.to_bits(), "{outcome:?}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
}

#[test]
fn an_own_term_ends_a_trial() {
    let text = WHEELS
        .replace("steps = 60", "steps = 600")
        .replace("twist", "wheels")
        .replace(", largest = 4.0 }]\nnetwork", " }]\nnetwork");
    let outcomes = |text: &str| {
        let mut evaluator = evaluator(text);
        let all = [vec![3.0; evaluator.info().parameters.len()]];
        jobs(&all).into_iter().map(|job| evaluator.evaluate(job, None)).collect::<Vec<_>>()
    };
    let compared = outcomes(&text);
    for outcome in &compared {
        assert!(outcome.steps < 600, "{outcome:?}");
        let way = outcome.notes.iter().find(|(name, _)| *name == "measured path");
        // The first step beyond half a meter ends the trial. A step is at most 8 mm long.
        assert!(matches!(way, Some((_, Note::Number(way))) if (0.5..0.51).contains(way)), "{outcome:?}");
    }
    // The same condition as a formula.
    assert_eq!(outcomes(&text.replace("[{ term = \"path\", above = 0.5 }]", "\"path > 0.5 m\"")), compared);
}

#[test]
fn an_own_end_ends_a_trial() {
    let text = WHEELS
        .replace("steps = 60", "steps = 600, ends = [\"across\"]")
        .replace("end = [{ term = \"path\", above = 0.5 }]\n", "");
    let text = text.replace("twist", "wheels").replace(", largest = 4.0 }]\nnetwork", " }]\nnetwork");
    let mut evaluator = evaluator(&text);
    let all = [vec![3.0; evaluator.info().parameters.len()]];
    for job in jobs(&all) {
        let mut recording = Recording::new(evaluator.info().schema);
        let outcome = evaluator.evaluate(job, Some(&mut recording as &mut dyn Recorder));
        let x = |tick: u32| recording.pose_at(tick as usize, BodyId(0)).expect("a pose").position[0];
        assert!(outcome.steps < 600 && x(outcome.steps - 1) > 0.5 && x(outcome.steps - 2) <= 0.5, "{outcome:?}");
    }
    let error = refused(&text.replace("\"across\"", "\"acros\""));
    assert!(error.contains("`acros`; the nearest is `across`"), "{error}");
}

/// An end with a key, for which a word has no place.
#[derive(Clone, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
struct Beyond {
    /// A line.
    x: f64,
}

impl farsa_compose::part::EndPart for Beyond {
    type End = own::AcrossEnd;
    fn end(&self, scene: &farsa_compose::part::PartScene<'_>) -> Result<own::AcrossEnd, Error> {
        own::Across {}.end(scene)
    }
}

#[test]
fn an_end_with_keys_is_refused() {
    let mut parts = parts();
    parts.push(farsa_compose::part::end::<Beyond>("beyond"));
    let vocabulary = Vocabulary { strategies: strategies(), parts: &parts };
    let error = ComposedExperiment::from_text("own.toml", WHEELS, vocabulary).err().expect("an error").to_string();
    assert!(error.contains("the end `beyond` of this program has keys"), "{error}");
}

/// Sensor and motor values of each step.
#[derive(Default)]
struct Steps(Vec<[Vec<f32>; 2]>);

impl Recorder for Steps {
    fn sensors(&mut self, x: &[f32]) {
        self.0.push([x.to_vec(), Vec::new()]);
    }
    fn outputs(&mut self, y: &[f32]) {
        if let Some([_, outputs]) = self.0.last_mut() {
            *outputs = y.to_vec();
        }
    }
    fn tick(&mut self, _: f64) {}
}

/// The controller of a program's own network is exported with the bits of a trial.
#[test]
fn an_own_network_is_exported() {
    for text in [WHEELS, JOINTS] {
        let mut evaluator = evaluator(&text.replace("kind = \"echo\", largest = 3.0", "kind = \"steep\", slope = 2.5"));
        let parameters = parameters(evaluator.as_ref(), 2);
        let export = evaluator.exports().and_then(|exports| exports.controller(&parameters)).expect("a controller");
        let NetworkExport::Perceptron { inputs, outputs, slope: 2.5, parameters: exported } = export.network else {
            panic!("{:?}", export.network)
        };
        let mut network = Perceptron::new(inputs, outputs, 2.5, exported).expect("a layer");
        let (mut steps, mut y) = (Steps::default(), vec![0.0; outputs]);
        evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), Some(&mut steps));
        for [sensed, done] in steps.0.iter().filter(|[_, done]| !done.is_empty()) {
            network.step(sensed, &mut y);
            assert_eq!(y, *done);
        }
        assert!(steps.0.len() > 50);
    }
}

#[test]
fn a_body_away_from_its_joint_is_refused() {
    const ARM: &str = r#"<mujoco><worldbody><body name="rod"><joint name="hinge" axis="0 0 1" pos="POS" range="-90 90"/>
<geom size="0.1"/></body></worldbody><actuator><motor joint="hinge"/></actuator></mujoco>"#;
    let file = |at: &str| {
        let robot = "robot = { kind = \"model\", file = \"arm.xml\" }";
        let text = JOINTS.replace("robot = { kind = \"turntable\" }", robot);
        let text = text.replacen("from = \"ball\"", "from = \"rod\"", 1);
        let text = text.replace("kind = \"twist\"", "kind = \"joint-torque\"");
        text + "[files]\n\"arm.xml\" = '''" + &ARM.replace("POS", at) + "'''\n"
    };
    let why = refused(&file("0.5 0 0"));
    assert!(why.contains("`rod` is not at the origin of its segment `rod`"), "{why}");
    made(&file("0 0 0")).unwrap_or_else(|error| panic!("{error}"));
}

#[cfg(feature = "rapier")]
#[test]
fn parts_work_in_rapier() {
    let planar = format!("world = {{ engine = \"rapier\" }}{WHEELS}");
    for text in [planar, JOINTS.replace("\"articulated\"", "\"rapier\"")] {
        let mut rapier = evaluator(&text);
        let all = [parameters(rapier.as_ref(), 1)];
        for job in jobs(&all) {
            let outcome = rapier.evaluate(job, None);
            let distance = outcome.notes.iter().find(|(name, _)| *name == "measured distance");
            let Some((_, Note::Number(distance))) = distance else { panic!("{outcome:?}") };
            // The term measures in space, and the centers have slightly different heights.
            assert!(outcome.terms[0] > 0.1 && (outcome.terms[0] - distance).abs() <= 1e-5 * distance, "{outcome:?}");
            assert_eq!(rapier.evaluate(job, None), outcome);
        }
    }
}

/// A part with tables among its keys.
#[derive(Clone, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
struct Nested {
    /// Points of a way.
    #[serde(default)]
    points: Vec<Place>,
}

/// A place of the floor.
#[derive(Clone, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct Place {
    /// First coordinate [m].
    #[schemars(range(min = -1.0, max = 1.0))]
    x: f64,
}

impl farsa_compose::part::TermPart for Nested {
    type Term = own::AwayTerm;
    fn term(&self, scene: &farsa_compose::part::PartScene<'_>) -> Result<own::AwayTerm, Error> {
        let sum: f64 = self.points.iter().map(|point| point.x).sum();
        if sum > 1.0 {
            Err(scene.error(format!("adds up to {sum}")))
        } else {
            Ok(own::AwayTerm([scene.body(None)?; 2]))
        }
    }
}

#[test]
fn keys_may_hold_tables() {
    let mut parts = parts();
    parts.push(farsa_compose::part::term::<Nested>("nested"));
    let made = |points: &str| {
        let text = format!("{WHEELS}[[reward]]\nkind = \"nested\"\nover = \"end\"\npoints = {points}\n");
        let vocabulary = Vocabulary { strategies: strategies(), parts: &parts };
        let made = ComposedExperiment::from_text("own.toml", &text, vocabulary)?;
        made.prepare("", &Settings::new(made.settings(""))?).map(|_| ())
    };
    made("[{ x = 0.5 }, { x = 0.25 }]").expect("valid points");
    for (points, why) in [
        ("[{ x = 0.75 }, { x = 0.75 }]", "adds up to 1.5"),
        ("[{ x = 1.5 }]", "1.5 is outside -1 to 1"),
        ("[{ y = 0.5 }]", "unknown key `y`"),
        ("[{}]", "lacks the key `x`"),
        ("[{ x = \"far\" }]", "reward.4"),
    ] {
        let error = made(points).expect_err(points).to_string();
        assert!(error.starts_with("own.toml line ") && error.contains(why), "{points}: {error}");
    }
    let schema: Value = serde_json::from_str(&(FILES.schema)(&parts).expect("a schema")).expect("JSON");
    assert!(schema.to_string().contains("A place of the floor"));
}

#[test]
fn keys_are_settings_with_text_range_and_unit() {
    let made = made(WHEELS).expect("an experiment");
    let settings = made.settings("");
    let reach = settings.iter().find(|setting| setting.key() == "sensors.bearing.reach").expect("a setting");
    let text = format!("{reach:?}");
    assert!(text.contains("Distance that reads 1") && text.contains("\"m\"") && text.contains("10.0"), "{text}");
    // A default that the file lacks is a setting, too.
    let text = WHEELS.replace(", reach = 2.0", "");
    let defaults = self::made(&text).expect("an experiment").settings("");
    assert!(defaults.iter().any(|setting| setting.key() == "sensors.bearing.reach"));
    // A setting of each part changes the trial.
    let changed = |key: &str, value: f64| {
        let mut settings = Settings::new(made.settings("")).expect("settings");
        settings.set("test", key, farsa_lab::advanced::Value::Number(value)).expect(key);
        let mut evaluator = made.prepare("", &settings).expect("an evaluator");
        let parameters = vec![0.7; evaluator.info().parameters.len()];
        evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None)
    };
    let intact = changed("sensors.bearing.reach", 2.0);
    for (key, value) in [
        ("sensors.bearing.reach", 1.0),
        ("sensors.bearing.wrappers.smooth.rate", 0.1),
        ("sensors.bearing.wrappers.smooth.noise", 0.5),
        ("motors.twist.largest", 1.0),
        ("objects.gate.width", 0.6),
    ] {
        assert_ne!(changed(key, value), intact, "{key}");
    }
    assert!(made.settings("").iter().any(|setting| setting.key() == "network.largest"));
}

#[test]
fn a_network_of_its_own_can_be_lesioned_and_recorded() {
    for text in [WHEELS, JOINTS] {
        let mut evaluator = evaluator(text);
        let parameters = parameters(evaluator.as_ref(), 4);
        let evaluation = Evaluation::new(&parameters, EpisodeId::default());
        let mut recording = Recording::new(evaluator.info().schema);
        let outcome = evaluator.evaluate(evaluation, Some(&mut recording as &mut dyn Recorder));
        assert_eq!(recording.times().len(), outcome.steps as usize);
        let columns = recording.schema().columns();
        assert!(columns.iter().any(|column| column.starts_with("neuron")), "{columns:?}");
        let about = &recording.schema().sensors[0].about;
        assert!(about.starts_with("x of the way to ") && about.ends_with("with `smooth`"), "{about}");
        // Its protocol `lesions` silences each neuron.
        let info = evaluator.info();
        let lesions = info.protocols.iter().find(|protocol| format!("{protocol:?}").contains("lesions"));
        assert!(lesions.is_some(), "{:?}", info.protocols);
    }
}

#[test]
fn errors_name_place_and_nearest_name() {
    for (from, to, wanted) in [
        ("\"bearing\"", "\"bering\"", "own.toml line 4: unknown kind `bering`; the nearest is `bearing`"),
        ("reach = 2.0", "reach = 20.0", "own.toml line 4: `sensors.1.reach`: 20 is outside 0.1 to 10"),
        ("reach = 2.0", "raech = 2.0", "own.toml line 4: unknown key `raech`; the nearest is `reach`"),
        ("to = \"gate\",", "to = \"gaet\",", "own.toml line 4: unknown object `gaet`; the nearest is `gate`"),
        ("to = \"gate\", ", "", "own.toml line 4: `sensors.1`: lacks the key `to`"),
        ("\"smooth\"", "\"smoth\"", "own.toml line 4: unknown kind `smoth`; the nearest is `smooth`"),
        ("\"echo\"", "\"eco\"", "own.toml line 6: unknown kind `eco`; the nearest is `echo`"),
        ("\"on-line\"", "\"online\"", "unknown way to place something `online`; the nearest is `on-line`"),
        ("\"mini\"", "\"minni\"", "own.toml line 2: unknown choice `minni`; the nearest is `mini`"),
        (", at = [0.7, 0.5]", "", "own.toml line 3: `objects.1`: lacks the key `at`"),
        ("kind = \"mini\"", "kind = \"turntable\"", "own.toml"),
    ] {
        let text = WHEELS.replacen(from, to, 1);
        let error = refused(&text);
        assert!(error.contains(wanted), "{error}\nwhere\n{wanted}");
    }
    // Without the program that registers them, the names are unknown.
    let error = ComposedExperiment::from_text("own.toml", WHEELS, strategies()).err().expect("an error").to_string();
    assert!(error.contains("unknown kind `bearing`"), "{error}");
}

#[test]
fn parts_that_cannot_be_registered_are_refused() {
    let error = |parts: Vec<farsa_lab::advanced::Part>| {
        let vocabulary = Vocabulary { strategies: strategies(), parts: &parts };
        ComposedExperiment::from_text("own.toml", WHEELS, vocabulary).err().expect("an error").to_string()
    };
    let taken = farsa_compose::part::sensor::<own::Bearing>("infrared");
    assert_eq!(error(vec![taken]), "the sensor `infrared` of this program has the name of another one");
    let named = farsa_compose::part::sensor::<own::Bearing>("My Sensor");
    assert!(error(vec![named]).starts_with("the sensor `My Sensor` of this program has no valid name"));
    let twice = || farsa_compose::part::network::<own::Echo>("echo");
    assert_eq!(error(vec![twice(), twice()]), "the network `echo` of this program has the name of another one");
}

/// All names that select a branch of a table in the schema.
fn kinds(schema: &Value, table: &str, tag: &str) -> Vec<String> {
    let branches = schema["$defs"][table]["oneOf"].as_array().expect("branches");
    branches.iter().filter_map(|branch| branch["properties"][tag]["const"].as_str()).map(str::to_owned).collect()
}

#[test]
fn the_schema_has_all_registered_names_and_no_others() {
    let with = |parts: &[farsa_lab::advanced::Part]| {
        let text = (FILES.schema)(parts).expect("a schema");
        serde_json::from_str::<Value>(&text).expect("JSON")
    };
    let (plain, own) = (with(&[]), with(&parts()));
    for (table, tag, names) in [
        ("Sensor", "kind", &["bearing"][..]),
        ("Motor", "kind", &["twist"]),
        ("Wrapper", "kind", &["smooth"]),
        ("Network", "kind", &["echo", "steep"]),
        ("Reward", "kind", &["away", "path"]),
        ("Start", "at", &["on-line"]),
        ("Object", "kind", &["gate"]),
    ] {
        let (before, mut after) = (kinds(&plain, table, tag), kinds(&own, table, tag));
        let added = after.split_off(before.len());
        assert_eq!((after, added), (before, names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>()));
    }
    let ends = own["$defs"]["Ending"]["oneOf"].as_array().expect("words");
    let words: Vec<&str> = ends.iter().filter_map(|word| word["const"].as_str()).collect();
    assert_eq!(words, ["collision", "success", "death", "across"]);
    assert_eq!(ends[3]["description"], "The robot crosses the line x = 0.5 m.");
}

#[test]
fn own_parts_keep_the_promises_of_sensors_and_motors() {
    use farsa_body::robots::MobileRobot;
    use farsa_physics::arena::{Arena, Cylinder, World};
    let mut arena = Arena::walled(1.0, 1.0);
    arena.add_robot(MobileRobot::e_puck(), [0.3, 0.3], 0.4);
    arena.add_cylinder(Cylinder::new([0.7, 0.5], 0.05));
    let (parts, thing) = (arena.parts(0), arena.cylinder(0));
    let world = World::new(&arena).expect("a world");
    let mut sensor = BearingSensor { from: parts.body, to: thing, scale: 1.0 };
    assert_ne!(parts.body, BodyId(9));
    check_sensor(&mut sensor, &world).expect("a sensor");
    check_motor(&mut TwistMotor(parts.motors.to_vec(), 4.0), || world.clone()).expect("a motor");
}

#[test]
fn each_part_takes_at_most_forty_lines() {
    let text = include_str!("own.rs");
    for part in ["Bearing", "Twist", "Smooth", "Steep", "Across", "Away", "Path", "OnLine", "Gate"] {
        let (is, of) = (format!("pub(crate) struct {part}"), format!(" for {part}"));
        let mut lines = 0;
        let mut within = false;
        for line in text.lines() {
            within |= line.starts_with(&is) || line.starts_with("impl") && line.contains(&of);
            lines += usize::from(within);
            within &= line != "}";
        }
        assert!((10..=40).contains(&lines), "{part} takes {lines} lines");
    }
}
