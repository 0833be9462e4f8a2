//! Recordings of robots on wheels: names and links, rays, outputs of dead robots, the robot that is watched, smaller teams.

use std::fmt::Write as _;

use farsa_body::ports::BodyId;
use farsa_body::{Pose, Recorder};
use farsa_evo::ObservationStatistics;
use farsa_lab::advanced::{CaseId, Recording};
use farsa_lab::{EpisodeId, Evaluation, Outcome};

use crate::senses::{RING, ahead, along};
use crate::wheels::{HULL, TIME_STEP, driven};
use crate::{Trial, all_close, close, distance, made, yes};

/// Runs one evaluation of parameters that are all 0.
fn evaluated(text: &str, change: impl FnOnce(&mut Evaluation<'_>)) -> (Outcome, Recording) {
    let mut evaluator = made(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let mut evaluation = Evaluation::new(&parameters, EpisodeId::default());
    change(&mut evaluation);
    let mut recording = Recording::new(evaluator.info().schema);
    let outcome = evaluator.evaluate(evaluation, Some(&mut recording));
    (outcome, recording)
}

/// Three inputs and two outputs: 6 weights, then 2 biases.
#[test]
fn a_task_is_described_with_its_channels() {
    let text = |network: &str| {
        format!(
            "world = {{ time_step = 0.04 }}\nrobot = {{ kind = \"e-puck\" }}\n\
             sensors = [{{ kind = \"wheel-speed\" }}, {{ kind = \"constant\", value = 0.3 }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
             network = {{ {network} }}\nepisode = {{ steps = 7, trials = 3 }}\n\
             reward = [{{ kind = \"steps\" }}, {{ kind = \"time\", name = \"clock\", label = \"time [s]\" }}]\n"
        )
    };
    let info = |network: &str| made(&text(network)).unwrap_or_else(|error| panic!("{network}: {error}")).info();
    let task = info("kind = \"perceptron\"");
    assert_eq!((task.trials, task.observations, &task.terms[..]), (3, 3, &["steps".into(), "time [s]".into()][..]));
    assert!(task.robots.is_empty() && task.populations.len() == 1, "{:?} {:?}", task.robots, task.populations);
    let groups = |groups: &[farsa_lab::advanced::ChannelGroup]| -> Vec<(String, usize)> {
        groups.iter().map(|group| (group.name.clone(), group.count)).collect()
    };
    let about = &task.description;
    assert_eq!(groups(&about.sensors), [("wheel-speed".into(), 2), ("constant".into(), 1)]);
    assert_eq!(groups(&about.motors), [("wheels".into(), 2)]);
    assert_eq!((about.parameters, about.steps, about.step_seconds), (8, 7, 0.04));
    let schema = &task.schema;
    let [links] = &schema.links[..] else { panic!("{:?}", schema.links) };
    assert_eq!((links.from, links.to, links.first), ([0, 3], [3, 5], 0));
    let [biases] = &schema.node_parameters[..] else { panic!("{:?}", schema.node_parameters) };
    assert_eq!((&*biases.name, biases.nodes, biases.first), ("bias", [3, 5], 6));
    assert_eq!(task.parameters[biases.first].name, "bias of wheels left");
    assert_eq!(schema.outputs.iter().map(|output| output.range).collect::<Vec<_>>(), [Some([0.0, 1.0]); 2]);
    let scalars: Vec<[&str; 3]> =
        schema.scalars.iter().map(|channel| [&*channel.name, &*channel.unit, &*channel.group]).collect();
    let place = [["x", "m", "place"], ["y", "m", "place"], ["heading", "rad", "place"]];
    // A recording has its own column of the name `time [s]`.
    let terms = [["steps", "", "term"], ["clock", "", "term"], ["fitness so far", "", "fitness"]];
    assert_eq!(scalars, [place, terms].concat());
    for (network, summary, neurons) in [
        ("kind = \"perceptron\"", "3-2, one layer of logistic units without memory", 0),
        ("kind = \"leaky\", hidden = 4", "3-4-2, recurrent hidden layer, leaks as filters", 4),
        (
            "kind = \"ctrnn\", neurons = 5, time_constants = [0.1, 1.0]",
            "3-2, 5 neurons in continuous time, all linked to all",
            5,
        ),
        ("kind = \"wired\", bias = [0.5, 0.5], wires = []", "3-2, wired by hand", 0),
        ("kind = \"feed-forward\", hidden = 4", "3-2, 6 neurons in blocks", 9),
    ] {
        let task = info(network);
        assert_eq!((&*task.description.network, task.schema.neurons.len()), (summary, neurons));
        let links = ["perceptron", "leaky", "ctrnn"].iter().any(|kind| network.contains(kind));
        assert_eq!(!task.schema.links.is_empty(), links, "{network}");
    }
    let names: Vec<String> = info("kind = \"ctrnn\", neurons = 3, time_constants = [0.1, 1.0]")
        .schema
        .neurons
        .into_iter()
        .map(|n| n.name)
        .collect();
    assert_eq!(names, ["1", "2", "3"]);
}

/// Both ends of a ray, and `true` if it hits something.
type Ray = ([f32; 3], [f32; 3], bool);

/// Rays of each step.
#[derive(Default)]
struct Rays {
    steps: Vec<Vec<Ray>>,
    now: Vec<Ray>,
}

impl Recorder for Rays {
    fn pose(&mut self, _: BodyId, _: Pose) {}
    fn ray(&mut self, from: [f32; 3], to: [f32; 3], hit: bool) {
        self.now.push((from, to, hit));
    }
    fn tick(&mut self, _: f64) {
        self.steps.push(std::mem::take(&mut self.now));
    }
}

/// Reads of five rays within 10 degrees of each direction of the ring, up to 0.05 m, at the wall x = 0.
fn at_wall(place: [f64; 2], heading: f64) -> [f64; 8] {
    RING.map(|degrees| {
        let from = ahead(place, along((heading + degrees).to_radians()), HULL);
        let hits = [-10.0, -5.0, 0.0, 5.0, 10.0].map(|off: f64| {
            let cosine = (heading + degrees + off).to_radians().cos();
            if cosine < 0.0 { from[0] / -cosine } else { f64::INFINITY }
        });
        1.0 - hits.into_iter().fold(0.05, f64::min) / 0.05
    })
}

/// A ray begins at the hull, at half the height of 0.05 m, and has the length of the sensor value. Sensors in groups
/// show the whole ring. Robots that are not watched show only rays that hit something.
#[test]
fn infrared_sensors_are_drawn_as_rays() {
    let text = |robot: &str, sensors: &str| {
        format!(
            "world = {{ size = [3.1, 2.3] }}\nrobot = {{ kind = \"e-puck\"{robot} }}\n\
             sensors = [{{ kind = \"constant\", value = 0.3 }}, {sensors}]\nmotors = [{{ kind = \"wheels\" }}]\n\
             network = {{ kind = \"wired\", bias = [0.5, 0.5], wires = [] }}\nepisode = {{ steps = 2, trials = 1 }}\n\
             reward = [{{ kind = \"steps\" }}]\n"
        )
    };
    let start = |name: &str, at: [f64; 2], heading: f64| {
        format!("[[start]]\nplace = \"{name}\"\nat = \"fixed\"\npoint = {at:?}\nheading = {heading}\n")
    };
    let drawn = |text: &str| {
        let mut evaluator = made(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let (parameters, mut rays) = (vec![0.0; evaluator.info().parameters.len()], Rays::default());
        evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), Some(&mut rays));
        assert_eq!(rays.steps.len(), 2);
        assert_eq!(rays.steps[0], rays.steps[1]);
        rays.steps.remove(0)
    };
    let same = |found: &[Ray], at: [f64; 2], heading: f64, reads: &[(f64, f64)]| {
        assert_eq!(found.len(), reads.len(), "{found:?}");
        for ((from, to, hit), (degrees, x)) in found.iter().zip(reads) {
            let way = along((heading + degrees).to_radians());
            let ([u, v], [p, q]) = (ahead(at, way, HULL), ahead(at, way, HULL + 0.05 * (1.0 - x)));
            all_close(&from.map(f64::from), &[u, v, 0.025], 1e-5, &format!("begin at {degrees}"));
            all_close(&to.map(f64::from), &[p, q, 0.025], 1e-4, &format!("end at {degrees}"));
            assert_eq!(*hit, *x > 0.0, "{degrees}");
        }
    };
    let rays = "{ kind = \"infrared\", model = \"rays\", first = 3 }";
    let groups = "{ kind = \"infrared\", model = \"rays\", groups = 4, name = \"groups\" }";
    let (at, heading) = ([0.055, 1.2], 37.0);
    let reads: Vec<(f64, f64)> = RING.into_iter().zip(at_wall(at, heading)).collect();
    let alone = text("", &format!("{rays}, {groups}")) + &start("robot", at, heading);
    let found = drawn(&alone);
    same(&found[..3], at, heading, &reads[..3]);
    same(&found[3..], at, heading, &reads);
    let two = text(", count = 2", rays) + &start("robot-1", [1.5, 1.2], 20.0) + &start("robot-2", at, heading);
    let found = drawn(&two);
    same(&found[..3], [1.5, 1.2], 20.0, &RING.map(|degrees| (degrees, 0.0))[..3]);
    let hits: Vec<(f64, f64)> = reads[..3].iter().copied().filter(|(_, x)| *x > 0.0).collect();
    assert!(!hits.is_empty() && hits.len() < 3, "{hits:?}");
    same(&found[3..], at, heading, &hits);
}

/// At a cost of 0.3 a robot away from the nest dies in its fourth step. Its sensors then read 0, and its motors rest.
#[test]
fn motors_of_the_dead_rest() {
    for (motors, bias, rest) in [
        ("{ kind = \"wheels\" }, { kind = \"signal\" }", &[0.8, 0.45, 0.6][..], &[0.5, 0.5, 0.0][..]),
        ("{ kind = \"speed-and-turn\" }, { kind = \"leds\", colors = [\"red\"] }", &[0.8, 0.45, 0.6], &[0.5, 0.5, 0.0]),
        ("{ kind = \"speed-and-turn\", forwards = true }", &[0.8, 0.45], &[0.0, 0.5]),
    ] {
        let text = |ends: &str, count: usize| {
            format!(
                "world = {{ size = [3.1, 2.3] }}\nrobot = {{ kind = \"e-puck\", count = {count} }}\n\
                 sensors = [{{ kind = \"constant\", value = 0.3 }}]\nmotors = [{motors}]\n\
                 network = {{ kind = \"wired\", bias = {bias:?}, wires = [] }}\nepisode = {{ steps = 6, trials = 1{ends} }}\n\
                 objects = [{{ name = \"nest\", kind = \"disc\", radius = 0.15, at = [0.85, 0.2], color = [0, 0, 0] }}]\n\
                 foraging = {{ nest = \"nest\", cost = 0.3 }}\nreward = [{{ kind = \"alive\" }}]\n\
                 [[start]]\nplace = \"robot-1\"\nat = \"fixed\"\npoint = [2.1, 1.6]\n"
            )
        };
        let trial = Trial::new(&text("", 1));
        assert_eq!(trial.column("alive"), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        assert_eq!((1..=6).map(|step| trial.sensor("constant", step)[0] > 0.0).filter(|reads| *reads).count(), 4);
        let columns = trial.recording.schema().columns();
        for step in 0..6 {
            let row = columns.iter().zip(trial.recording.row(step));
            let found: Vec<f64> = row.filter(|(name, _)| name.starts_with("output.")).map(|(_, value)| value).collect();
            all_close(&found, if step < 4 { bias } else { rest }, 1e-6, &format!("{motors} in step {}", step + 1));
        }
        // The trial ends with the last robot, which in the nest never dies.
        let ends = ", ends = [\"death\"]";
        assert_eq!(Trial::new(&text(ends, 1)).outcome.steps, 4);
        let second = "[[start]]\nplace = \"robot-2\"\nat = \"fixed\"\npoint = ";
        assert_eq!(Trial::new(&format!("{}{second}[0.85, 0.2]\n", text(ends, 2))).outcome.steps, 6);
        assert_eq!(Trial::new(&format!("{}{second}[1.4, 0.7]\n", text(ends, 2))).outcome.steps, 4);
    }
}

/// Starts [m] and headings [deg] of three robots, all of which drive along circles.
const STARTS: [([f64; 2], f64); 3] = [([0.7, 0.5], 20.0), ([0.9, 1.1], 140.0), ([1.9, 0.8], -75.0)];
const RADIUS: f64 = 0.17;

fn team(rest: &str) -> String {
    let mut text = format!(
        "{rest}world = {{ size = [3.1, 2.3], time_step = {TIME_STEP} }}\n\
         robot = {{ kind = \"e-puck\", count = 3, radius = {RADIUS} }}\n\
         sensors = [{{ kind = \"body-pose\" }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
         network = {{ kind = \"wired\", bias = [0.95, 0.8], wires = [] }}\nepisode = {{ steps = 5, trials = 1 }}\n"
    );
    for kind in ["near-others", "dispersion", "clusters", "largest-cluster"] {
        let _ = writeln!(text, "[[reward]]\nkind = \"{kind}\"");
    }
    text.push_str("[[reward]]\nname = \"spread\"\nkind = \"dispersion\"\nover = \"end\"\n");
    for (name, keys) in [("all", ""), ("last", "over = \"end\"\n"), ("third", "robot = 3\n")] {
        let _ = write!(text, "[[reward]]\nname = \"{name}\"\nkind = \"position\"\nalong = [1, 0, 0]\n{keys}");
    }
    for (number, (at, heading)) in STARTS.iter().enumerate() {
        let place = format!("place = \"robot-{}\"\nat = \"fixed\"", number + 1);
        let _ = writeln!(text, "[[start]]\n{place}\npoint = {at:?}\nheading = {heading}");
    }
    text
}

fn place(robot: usize, number: usize) -> [f64; 2] {
    let (at, heading) = STARTS[robot];
    driven(at, heading.to_radians(), [0.95, 0.8], number).at
}

#[test]
fn the_watched_robot_is_recorded() {
    let text = team("");
    for (watched, robot) in [(None, 0), (Some(0), 0), (Some(1), 1), (Some(2), 2), (Some(9), 2)] {
        let (_, recording) = evaluated(&text, |evaluation| evaluation.watched = watched);
        let columns = recording.schema().columns();
        let value = |tick: usize, name: &str| {
            let column = columns.iter().position(|column| column == name).expect("a column");
            recording.row(tick).nth(column).expect("a value")
        };
        for step in 1..=5 {
            let [x, y] = place(robot, step);
            close(value(step - 1, "x [m]"), x, 1e-5, &format!("x of {watched:?} after step {step}"));
            close(value(step - 1, "y [m]"), y, 1e-5, &format!("y of {watched:?} after step {step}"));
            let [x, _] = place(robot, step - 1);
            close(value(step - 1, "sensor.body-pose 1"), x, 1e-5, &format!("read by {watched:?} in step {step}"));
        }
    }
    let info = made(&text).expect("an evaluator").info();
    assert_eq!(info.robots, ["e-puck 1", "e-puck 2", "e-puck 3"]);
}

/// Tests with 1 or 2 of three robots are new, and the others stay outside: 5 times the longer side and 4 radii for each
/// robot away. They count for no term.
#[test]
fn smaller_teams_lack_their_last_robots() {
    let text = team("protocols = [\"team-size\"]\n");
    let protocols = made(&text).expect("an evaluator").info().protocols;
    let cases: Vec<(&str, bool)> = protocols[0].cases.iter().map(|case| (&*case.row, case.held_out)).collect();
    assert_eq!((&*protocols[0].name, cases), ("team-size", vec![("1", true), ("2", true), ("3", false)]));
    for (count, sizes) in [(4, &["1", "2", "4"][..]), (5, &["1", "2", "4", "5"]), (2, &["1", "2"])] {
        let starts = text.find("[[start]]").expect("starts");
        let text = text[..starts].replace("count = 3", &format!("count = {count}")).replace("robot = 3", "robot = 2");
        let protocols = made(&text).unwrap_or_else(|error| panic!("{error}")).info().protocols;
        assert_eq!(protocols[0].cases.iter().map(|case| &*case.row).collect::<Vec<_>>(), sizes);
    }
    for (case, present) in [(Some(0), 1), (Some(1), 2), (Some(2), 3), (None, 3)] {
        let (outcome, recording) = evaluated(&text, |evaluation| {
            evaluation.case = case.map(|case| CaseId { protocol: 0, case });
        });
        assert_eq!(outcome.steps, 5);
        let columns = recording.schema().columns();
        for number in 1..=5 {
            let value = |name: &str| {
                let column = columns.iter().position(|column| column == name).expect("a column");
                recording.row(number - 1).nth(column).expect("a value")
            };
            let places: Vec<[f64; 2]> = (0..present).map(|robot| place(robot, number)).collect();
            let count = present as f64;
            let mut pairs = Vec::new();
            for (index, a) in places.iter().enumerate() {
                pairs.extend(places[index + 1..].iter().map(|b| distance(*a, *b)));
            }
            let others = f64::max(count - 1.0, 1.0);
            let near = 1.0 - pairs.iter().sum::<f64>() * 2.0 / count / others / f64::hypot(3.1, 2.3);
            let spread = pairs.iter().map(|far| far * far).sum::<f64>() / count / (4.0 * RADIUS * RADIUS);
            let what = |name: &str| format!("{name} of {present} robots after step {number}");
            close(value("near-others"), near, 1e-5, &what("near-others"));
            close(value("dispersion"), spread, 1e-4, &what("dispersion"));
            let linked = pairs.iter().filter(|far| **far < 4.0 * RADIUS).count();
            assert_eq!(value("clusters"), count - linked as f64, "{}", what("clusters"));
            close(value("largest-cluster"), (1 + linked) as f64 / count, 1e-9, &what("largest-cluster"));
            let mean = places.iter().map(|[x, _]| x).sum::<f64>() / count;
            close(value("all"), mean, 1e-5, &what("position"));
            // Terms of the end are recorded in each step, like others.
            assert_eq!([value("last"), value("spread")], [value("all"), value("dispersion")], "{}", what("the end"));
            close(value("third"), yes(present == 3) * place(2, number)[0], 1e-5, &what("position of the third"));
            for robot in 0..3 {
                let found =
                    recording.pose_at(number - 1, BodyId(robot as u16)).expect("a pose").position.map(f64::from);
                let outside = [-5.0 * 3.1 - 4.0 * RADIUS * robot as f64; 2];
                let wanted = if robot < present { place(robot, number) } else { outside };
                all_close(&found[..2], &wanted, 1e-5, &what(&format!("place {robot}")));
            }
        }
    }
}

/// The statistics of three robots in five steps are merged: 15 rows.
#[test]
fn observations_of_all_robots_are_collected() {
    let text = team("");
    let before = ObservationStatistics::new(7).expect("statistics");
    let mut evaluator = made(&text).expect("an evaluator");
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let plain = Evaluation::new(&parameters, EpisodeId::default());
    assert_eq!(evaluator.evaluate(plain, None).observed, None);
    let outcome = evaluator.evaluate(Evaluation { normalisation: Some(&before), ..plain }, None);
    let observed = outcome.observed.expect("statistics");
    let xs: Vec<f64> = (0..3).flat_map(|robot| (0..5).map(move |step| place(robot, step)[0])).collect();
    let mean = xs.iter().sum::<f64>() / 15.0;
    assert_eq!((observed.count(), observed.channels()), (15, 7));
    close(observed.mean()[0], mean, 1e-5, "mean of x");
    close(observed.squares()[0], xs.iter().map(|x| (x - mean) * (x - mean)).sum(), 1e-4, "squares of x");
}

/// A robot whose left wheel adds 0.2 of a constant of 0.3 to 0.5, and the right one 0.1 of its place of x = 0.7.
fn wired(rest: &str) -> String {
    format!(
        "{rest}robot = {{ kind = \"e-puck\" }}\nmotors = [{{ kind = \"wheels\" }}]\nreward = [{{ kind = \"steps\" }}]\n\
         sensors = [{{ kind = \"body-pose\" }}, {{ kind = \"constant\", value = 0.3 }}]\nepisode = {{ steps = 1, trials = 1 }}\n\
         network = {{ kind = \"wired\", bias = [0.5, 0.5], wires = [\
         {{ from = [\"constant\"], to = \"wheels left\", weight = 0.2 }}, \
         {{ from = [\"body-pose 1\"], to = \"wheels right\", weight = 0.1 }}] }}\n\
         start = [{{ place = \"robot\", at = \"fixed\", point = [0.7, 0.4] }}]\n"
    )
}

fn outputs(recording: &Recording) -> [f64; 2] {
    let columns = recording.schema().columns();
    ["output.wheels left", "output.wheels right"].map(|name| {
        let column = columns.iter().position(|column| column == name).expect("an output");
        recording.row(0).nth(column).expect("a value")
    })
}

#[test]
fn lesions_cut_channels_or_sensors() {
    let poses = (1..=7).map(|channel| format!("no body-pose {channel}"));
    let channels: Vec<String> = ["intact".into()].into_iter().chain(poses).chain(["no constant".into()]).collect();
    for (rest, protocol, cases, cut) in [
        ("lesions = \"channels\"\n", "lesions", channels, [1, 8]),
        (
            "protocols = [\"senses\"]\n",
            "senses",
            ["intact", "no body-pose", "no constant"].map(str::to_owned).into(),
            [1, 2],
        ),
    ] {
        let protocols = made(&wired(rest)).unwrap_or_else(|error| panic!("{error}")).info().protocols;
        let found: Vec<String> = protocols[0].cases.iter().map(|case| case.row.clone()).collect();
        assert_eq!((&*protocols[0].name, found), (protocol, cases));
        for (case, wanted) in [(0, [0.56, 0.57]), (cut[0], [0.56, 0.5]), (cut[1], [0.5, 0.57])] {
            let case = Some(CaseId { protocol: 0, case });
            let (_, recording) = evaluated(&wired(rest), |evaluation| evaluation.case = case);
            all_close(&outputs(&recording), &wanted, 1e-6, &format!("{rest} {case:?}"));
        }
    }
}

/// A function replaces the network of one robot, and the others keep theirs.
#[test]
fn functions_drive_robots() {
    let text =
        wired("").replace("kind = \"e-puck\"", "kind = \"e-puck\", count = 2").replace("\"robot\"", "\"robot-1\"");
    let made = farsa_compose::ComposedExperiment::from_text("values.toml", &text, farsa_lab::strategy::strategies());
    let made = made.unwrap_or_else(|error| panic!("{error}"));
    let settings = farsa_lab::Settings::new(farsa_lab::Experiment::settings(&made, "")).expect("settings");
    let reflex: farsa_compose::Reflex = std::sync::Arc::new(|x, y| y.copy_from_slice(&[x[7] * 2.0, x[0]]));
    let prepared = |robot| made.prepare_with(&settings, vec![(robot, reflex.clone())]);
    for (robot, wanted) in [(0, [0.6, 0.7]), (1, [0.56, 0.57])] {
        let mut evaluator = prepared(robot).unwrap_or_else(|error| panic!("{error}"));
        let parameters = vec![0.0; evaluator.info().parameters.len()];
        let mut recording = Recording::new(evaluator.info().schema);
        evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), Some(&mut recording));
        all_close(&outputs(&recording), &wanted, 1e-6, &format!("the first robot, with a function for robot {robot}"));
        assert!(evaluator.exports().is_some_and(|exports| exports.controller(&parameters).is_none()));
    }
    assert!(prepared(2).err().is_some_and(|error| error.to_string().contains("there is no robot 2 on wheels")));
}

/// Parameters that the network cannot have make a trial fail: another number of them, NaN, and a leak above 1.
#[test]
fn wrong_parameters_fail() {
    for (network, count) in [
        ("kind = \"perceptron\"", 18),
        ("kind = \"perceptron\", order = \"outputs\"", 18),
        ("kind = \"leaky\", hidden = 2", 16 + 4 + 4 + 2 + 2),
        ("kind = \"ctrnn\", neurons = 3, time_constants = [0.1, 1.0]", 24 + 9 + 3 + 3),
        ("kind = \"elman\", hidden = 2", 16 + 4 + 4 + 2 + 2),
        ("kind = \"evonet\", hidden = 2, weights = [5.0, -5.0]", 16 + 4 + 2 + 2),
        ("kind = \"wired\", bias = [0.5, 0.5], search_bias = true, wires = []", 2),
    ] {
        let text = wired("");
        let (start, end) = (text.find("network = ").expect("a network"), text.find("start = ").expect("a start"));
        let text = format!("{}network = {{ {network} }}\n{}", &text[..start], &text[end..]);
        let mut evaluator = made(&text).unwrap_or_else(|error| panic!("{network}: {error}"));
        let ends: Vec<[f64; 2]> = evaluator.info().parameters.iter().map(|parameter| parameter.ends).collect();
        assert_eq!(ends.len(), count, "{network}");
        let right: Vec<f32> = ends.iter().map(|[low, high]| (0.6 * low + 0.4 * high) as f32).collect();
        let mut lasts = |parameters: &[f32]| {
            evaluator.evaluate(Evaluation::new(parameters, EpisodeId::default()), None).is_finite()
        };
        let mut broken = right.clone();
        broken[count - 1] = f32::NAN;
        let found = [&right[..], &right[1..], &[&right[..], &[0.5]].concat(), &broken].map(&mut lasts);
        assert_eq!(found, [true, false, false, false], "{network}");
        assert!(lasts(&right), "{network} after wrong ones");
    }
}
