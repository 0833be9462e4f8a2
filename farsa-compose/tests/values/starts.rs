//! Placements: all draws are within their limits, and come near to them.

use farsa_body::ports::BodyId;
use farsa_body::{Pose, Recorder};
use farsa_lab::advanced::Recording;
use farsa_lab::{EpisodeId, Evaluation};

use crate::{distance, made, refused};

/// Poses of all bodies after the first step.
#[derive(Default)]
struct First(Vec<Pose>, bool);

impl Recorder for First {
    fn pose(&mut self, body: BodyId, pose: Pose) {
        if !self.1 {
            self.0.resize(self.0.len().max(body.index() + 1), Pose::identity());
            self.0[body.index()] = pose;
        }
    }
    fn tick(&mut self, _: f64) {
        self.1 = true;
    }
}

/// Poses x, y and heading of these bodies at the start of 400 trials in which nothing moves.
pub(crate) fn places(text: &str, bodies: &[u16]) -> Vec<Vec<[f64; 3]>> {
    let mut evaluator = made(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let trial = |trial| {
        let mut first = First::default();
        let id = EpisodeId { trial, ..EpisodeId::default() };
        evaluator.evaluate(Evaluation::new(&parameters, id), Some(&mut first));
        let place = |body: &u16| {
            let pose = first.0[usize::from(*body)];
            let [x, y, _] = pose.position.map(f64::from);
            [x, y, f64::from(pose.heading())]
        };
        bodies.iter().map(place).collect()
    };
    (0..400).map(trial).collect()
}

/// All values are within these ends, and some are within a twentieth of the range from each.
#[track_caller]
pub(crate) fn spans(values: impl Iterator<Item = f64>, [low, high]: [f64; 2], what: &str) {
    let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let room = 0.05 * (high - low);
    assert!(least >= low - 1e-5 && most <= high + 1e-5, "{what}: {least} to {most}, not within {low} to {high}");
    assert!(least <= low + room && most >= high - room, "{what}: {least} to {most} of {low} to {high}");
}

fn file(rest: &str) -> String {
    format!(
        "world = {{ size = [3.0, 2.0] }}\nsensors = [{{ kind = \"constant\", value = 1.0 }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
         network = {{ kind = \"wired\", bias = [0.5, 0.5], wires = [] }}\nepisode = {{ steps = 1, trials = 1 }}\n\
         reward = [{{ kind = \"steps\" }}]\n{rest}"
    )
}

fn flat([x, y, _]: [f64; 3]) -> [f64; 2] {
    [x, y]
}

const POST: &str = "[[objects]]\nname = \"post\"\nkind = \"cylinder\"\nradius = 0.3\nat = [1.2, 0.9]\n";
const PI: f64 = std::f64::consts::PI;

/// An e-puck has a radius of 0.035 m. Without a placement it starts anywhere, touching nothing.
#[test]
fn robots_start_anywhere_at_their_distances() {
    let robot = "[robot]\nkind = \"e-puck\"\n";
    let found = places(&file(&format!("{robot}{POST}")), &[0]);
    spans(found.iter().map(|bodies| bodies[0][0]), [0.035, 2.965], "x");
    spans(found.iter().map(|bodies| bodies[0][1]), [0.035, 1.965], "y");
    spans(found.iter().map(|bodies| bodies[0][2]), [-PI, PI], "heading");
    let gap = |bodies: &Vec<[f64; 3]>| distance(flat(bodies[0]), [1.2, 0.9]) - 0.335;
    let least = found.iter().map(gap).fold(f64::INFINITY, f64::min);
    assert!((0.0..0.05).contains(&least), "{least}");
    let start = "[[start]]\nplace = \"robot\"\nat = \"anywhere\"\nwalls = 0.2\napart = 0.15\n";
    let found = places(&file(&format!("{robot}{POST}{start}")), &[0]);
    spans(found.iter().map(|bodies| bodies[0][0]), [0.235, 2.765], "x with walls");
    spans(found.iter().map(|bodies| bodies[0][1]), [0.235, 1.765], "y with walls");
    let least = found.iter().map(gap).fold(f64::INFINITY, f64::min);
    assert!((0.15..0.2).contains(&least), "{least} with a distance");
}

#[test]
fn robots_start_near_and_around_things() {
    let file =
        |start: &str| file(&format!("[robot]\nkind = \"e-puck\"\n{POST}[[start]]\nplace = \"robot\"\n{start}\n"));
    let found = places(&file("at = \"near\"\nof = \"post\"\nwithin = 0.6"), &[0]);
    spans(found.iter().map(|bodies| distance(flat(bodies[0]), [1.2, 0.9])), [0.335, 0.6], "near");
    let found = places(&file("at = \"around\"\nof = \"post\"\ndistance = [0.4, 0.7]"), &[0]);
    spans(found.iter().map(|bodies| distance(flat(bodies[0]), [1.2, 0.9])), [0.4, 0.7], "around");
    let direction = |bodies: &Vec<[f64; 3]>| f64::atan2(bodies[0][1] - 0.9, bodies[0][0] - 1.2);
    spans(found.iter().map(direction), [-PI, PI], "direction");
    // The point and the heading of 37 degrees are fixed, or the heading is drawn.
    for (keys, drawn) in [("heading = 37", false), ("drawn_heading = true", true)] {
        let found = places(&file(&format!("at = \"fixed\"\npoint = [2.1, 0.4]\n{keys}")), &[0]);
        assert!(found.iter().all(|bodies| distance(flat(bodies[0]), [2.1, 0.4]) < 1e-6));
        if drawn {
            spans(found.iter().map(|bodies| bodies[0][2]), [-PI, PI], "heading");
        } else {
            assert!(found.iter().all(|bodies| (bodies[0][2] - 37_f64.to_radians()).abs() < 1e-6));
        }
    }
}

/// Two discs of 0.25 m: their edges keep a distance from each other and from the walls, or their centers do.
#[test]
fn areas_keep_their_edges_or_centers_apart() {
    let file = |keys: &str| {
        file(&format!(
            "[robot]\nkind = \"e-puck\"\n[[objects]]\nname = \"spots\"\nkind = \"disc\"\nradius = 0.25\ncount = 2\ncolor = [0, 0, 0]\n\
             [[start]]\nplace = \"spots\"\nat = \"anywhere\"\nwalls = 0.1\napart = 0.4\n{keys}"
        ))
    };
    for (keys, edge) in [("", 0.25), ("centers = true\n", 0.0)] {
        let found = places(&file(keys), &[1, 2]);
        spans(found.iter().flatten().map(|at| at[0]), [edge + 0.1, 2.9 - edge], "x of areas");
        spans(found.iter().flatten().map(|at| at[1]), [edge + 0.1, 1.9 - edge], "y of areas");
        let apart = found.iter().map(|bodies| distance(flat(bodies[0]), flat(bodies[1])));
        let least = apart.fold(f64::INFINITY, f64::min);
        assert!((2.0 * edge + 0.4 - 1e-6..2.0 * edge + 0.5).contains(&least), "{least} {keys}");
    }
}

/// Robots on different points, and a thing that follows the choice of another.
#[test]
fn choices_take_free_points_and_follow() {
    let rest = "[robot]\nkind = \"e-puck\"\ncount = 2\n\
        [[objects]]\nname = \"sign\"\nkind = \"disc\"\nradius = 0.05\ncolor = [0, 0, 0]\n\
        [[start]]\nplace = \"robot\"\nat = \"one-of\"\npoints = [[0.5, 0.4], [1.5, 0.7], [2.5, 1.3]]\n\
        [[start]]\nplace = \"sign\"\nat = \"one-of\"\npoints = [[0.6, 1.8], [1.6, 1.7], [2.6, 1.6]]\nlike = \"robot\"\n";
    let points = [[0.5, 0.4], [1.5, 0.7], [2.5, 1.3]];
    let signs = [[0.6, 1.8], [1.6, 1.7], [2.6, 1.6]];
    let number = |list: &[[f64; 2]], at: [f64; 3]| list.iter().position(|point| distance(*point, flat(at)) < 1e-6);
    let mut seen = [[0; 3]; 3];
    for bodies in places(&file(rest), &[0, 1, 2]) {
        let [first, second] = [bodies[0], bodies[1]].map(|at| number(&points, at).expect("a point"));
        assert_ne!(first, second);
        assert_eq!(number(&signs, bodies[2]), Some(second), "the sign follows the last robot");
        seen[first][second] += 1;
    }
    assert!((0..3).all(|a| (0..3).all(|b| a == b || seen[a][b] > 30)), "{seen:?}");
}

/// Things next to a robot with joints: in a box, apart, on a point with a heading, and a joint within its limits. Its name is no
/// key of a setting.
#[test]
fn things_and_joints_start_within_their_limits() {
    let model = r#"<robot name="s"><link name="base"/><link name="bar"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="The Hinge" type="revolute"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="4" velocity="9"/></joint></robot>"#;
    let text = format!(
        "world = {{ engine = \"articulated\", floor = false, gravity = [0, 0, 0] }}\nrobot = {{ kind = \"model\", file = \"s.urdf\" }}\n\
         sensors = [{{ kind = \"joint-position\", from = 0.0, to = 1.0 }}, {{ kind = \"target-position\", target = \"ball\", axes = \"world\", body = \"base\" }}, \
         {{ name = \"mark\", kind = \"target-position\", target = \"mark\", axes = \"world\", body = \"base\" }}]\n\
         motors = [{{ kind = \"joint-torque\" }}]\nnetwork = {{ kind = \"wired\", bias = [0.5], wires = [] }}\n\
         episode = {{ steps = 1, trials = 1 }}\nreward = [{{ kind = \"steps\" }}]\n\
         [[objects]]\nname = \"ball\"\nkind = \"ball\"\nradius = 0.1\nmass = 0.3\n\
         [[objects]]\nname = \"mark\"\nkind = \"marker\"\n\
         [[start]]\nplace = \"The Hinge\"\nat = \"turned\"\nlow = -1.2\nhigh = 0.4\n\
         [[start]]\nplace = \"ball\"\nat = \"in-box\"\nlow = [0.5, -0.4, 0.3]\nhigh = [0.9, 0.2, 1.5]\n\
         [[start]]\nplace = \"mark\"\nat = \"in-box\"\nlow = [0.4, -0.5, 0.2]\nhigh = [1.0, 0.3, 1.6]\napart = 0.25\n\
         [files]\n\"s.urdf\" = '''{model}'''\n"
    );
    let mut evaluator = made(&text).unwrap_or_else(|error| panic!("{error}"));
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let first = |trial| {
        let mut recording = Recording::new(evaluator.info().schema);
        let id = EpisodeId { trial, ..EpisodeId::default() };
        evaluator.evaluate(Evaluation::new(&parameters, id), Some(&mut recording));
        let columns = recording.schema().columns();
        let read = columns.iter().zip(recording.row(0)).filter(|(column, _)| column.starts_with("sensor."));
        read.map(|(_, value)| value).collect::<Vec<f64>>()
    };
    let found: Vec<Vec<f64>> = (0..400).map(first).collect();
    let limits = [[-1.2, 0.4], [0.5, 0.9], [-0.4, 0.2], [0.3, 1.5], [0.4, 1.0], [-0.5, 0.3], [0.2, 1.6]];
    for (index, limits) in limits.into_iter().enumerate() {
        spans(found.iter().map(|read| read[index]), limits, &format!("channel {index}"));
    }
    let apart = found.iter().map(|read| (1..4).map(|k| (read[k] - read[k + 3]).powi(2)).sum::<f64>().sqrt());
    let least = apart.fold(f64::INFINITY, f64::min);
    // From the surface of the ball to the center of the marker.
    assert!((0.35 - 1e-6..0.42).contains(&least), "{least}");
}

/// A margin of more than half the depth leaves the middle: 1.2 m from walls that are 3 m and 2 m apart.
#[test]
fn areas_without_room_are_in_the_middle() {
    let area = |start: &str| {
        file(&format!(
            "[robot]\nkind = \"e-puck\"\n{POST}[[objects]]\nname = \"spot\"\nkind = \"disc\"\nradius = 0.25\ncolor = [0, 0, 0]\n\
             [[start]]\nplace = \"spot\"\n{start}\n"
        ))
    };
    let found = places(&area("at = \"anywhere\"\nwalls = 0.95"), &[2]);
    spans(found.iter().map(|bodies| bodies[0][0]), [1.2, 1.8], "x");
    assert!(found.iter().all(|bodies| (bodies[0][1] - 1.0).abs() < 1e-6), "y");
    // Near the post, and 0.25 m or 0.35 m from the walls.
    let corner =
        area("at = \"near\"\nof = \"post\"\nwithin = 0.5\nwalls = 0.1").replace("at = [1.2, 0.9]", "at = [0.4, 0.3]");
    let found = places(&corner, &[2]);
    spans(found.iter().map(|bodies| bodies[0][0]), [0.35, 0.9], "x near a corner");
    spans(found.iter().map(|bodies| bodies[0][1]), [0.35, 0.8], "y near a corner");
    let far = |bodies: &Vec<[f64; 3]>| distance(flat(bodies[0]), [0.4, 0.3]);
    assert!(found.iter().map(far).all(|far| far <= 0.5 + 1e-6));
    let found = places(&area("at = \"near\"\nof = \"post\"\nwithin = 0.5"), &[2]);
    spans(found.iter().map(|bodies| distance(flat(bodies[0]), [1.2, 0.9])), [0.0, 0.5], "distance");
    // Areas have no heading.
    assert!(found.iter().all(|bodies| bodies[0][2] == 0.0));
}

/// Two discs of 0.9 m that keep 0.5 m apart need 2.3 m between centers. The centers are at most sqrt(1.2^2 + 0.2^2) m
/// apart.
#[test]
fn missing_room_is_an_error() {
    let text = file(
        "[robot]\nkind = \"e-puck\"\n[[objects]]\nname = \"spots\"\nkind = \"disc\"\nradius = 0.9\ncount = 2\ncolor = [0, 0, 0]\n\
         [[start]]\nplace = \"spots\"\nat = \"anywhere\"\napart = 0.5\n",
    );
    let error = refused(&text);
    assert!(error.contains("no free place for a disc of 0.9 m in 1000 tries"), "{error}");
    let (_, lacked) = error.split_once("the best lacked ").expect("a length");
    let lacked: f64 = lacked.trim_end_matches(" m").parse().expect("a number");
    let least = 2.3 - f64::hypot(1.2, 0.2);
    assert!((least..least + 0.62).contains(&lacked), "{error}");
    // Without a distance they may overlap.
    let found = places(&text.replace("apart = 0.5\n", ""), &[1, 2]);
    spans(found.iter().map(|bodies| distance(flat(bodies[0]), flat(bodies[1]))), [0.0, 1.2], "distance");
}

/// Two discs of 0.2 m keep 0.06 m apart within 1 m. There is room unless the first is in the middle. A trial without
/// room has failed, and has no step.
#[test]
fn trials_without_room_have_failed() {
    let text = file(
        "[robot]\nkind = \"e-puck\"\n[[objects]]\nname = \"spots\"\nkind = \"disc\"\nradius = 0.2\ncount = 2\ncolor = [0, 0, 0]\n\
         [[start]]\nplace = \"spots\"\nat = \"anywhere\"\napart = 0.06\n",
    )
    .replace("size = [3.0, 2.0]", "size = [1.0, 1.0]");
    let mut evaluator = made(&text).unwrap_or_else(|error| panic!("{error}"));
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let mut failures = 0;
    for trial in 0..300 {
        let mut recording = Recording::new(evaluator.info().schema);
        let id = EpisodeId { trial, ..EpisodeId::default() };
        let outcome = evaluator.evaluate(Evaluation::new(&parameters, id), Some(&mut recording));
        let failed = !outcome.is_finite();
        assert_eq!((failed, outcome.steps), (recording.times().is_empty(), u32::from(!failed)), "{outcome:?}");
        failures += usize::from(failed);
    }
    assert!((1..60).contains(&failures), "{failures} of 300 have failed");
}

/// Populations of four individuals start alike with `common_starts`.
#[test]
fn populations_start_alike_if_asked() {
    for common in [true, false] {
        let text = file(&format!(
            "team = {{ coevolution = true, common_starts = {common} }}\n\
             robots = [{{ name = \"a\", kind = \"e-puck\" }}, {{ name = \"b\", kind = \"e-puck\" }}]\n"
        ))
        .replace(
            "network = { kind = \"wired\", bias = [0.5, 0.5], wires = [] }",
            "network = { kind = \"perceptron\" }",
        );
        let made =
            farsa_compose::ComposedExperiment::from_text("values.toml", &text, farsa_lab::strategy::strategies());
        let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
        let mut settings = farsa_lab::Experiment::settings(&made, "");
        settings.push(farsa_lab::Setting::whole("evolution.population", 4, 1..=100));
        let settings = farsa_lab::Settings::new(settings).expect("settings");
        let mut evaluator = farsa_lab::Experiment::prepare(&made, "", &settings).expect("an evaluator");
        let parameters = vec![0.0; evaluator.info().parameters.len()];
        let opponents = [&parameters[..]];
        let mut start = |individual| {
            let mut recording = Recording::new(evaluator.info().schema);
            let id = EpisodeId { individual, ..EpisodeId::default() };
            let evaluation = Evaluation { opponents: &opponents, ..Evaluation::new(&parameters, id) };
            evaluator.evaluate(evaluation, Some(&mut recording));
            recording.pose_at(0, BodyId(0)).expect("a body").position
        };
        let found = [1, 5, 2].map(&mut start);
        assert_eq!((found[0] == found[1], found[0] == found[2]), (common, false), "{found:?}");
    }
}

/// Impossible placements, with their places in the file.
#[test]
fn impossible_starts_are_refused() {
    let teams = "robots = [{ name = \"a\", kind = \"e-puck\", count = 2 }, { name = \"b\", kind = \"e-puck\" }]\n";
    let two = "robot = { kind = \"e-puck\", count = 2 }\n";
    let spots = "[[objects]]\nname = \"spots\"\nkind = \"disc\"\nradius = 0.1\ncount = 2\ncolor = [0, 0, 0]\n";
    let start = |place: &str, keys: &str| format!("[[start]]\nplace = \"{place}\"\n{keys}\n");
    let (fixed, anywhere) = ("at = \"fixed\"\npoint = [0.4, 0.5]", "at = \"anywhere\"");
    let one_of = "at = \"one-of\"\npoints = [[0.4, 0.5], [0.9, 0.5]]";
    for (text, why) in [
        (format!("{two}{}", start("robot", fixed)), Some("`start.1`: puts 2 robots on one point")),
        (format!("{two}{}", start("robot-2", fixed)), None),
        (format!("{two}{}", start("robot-3", fixed)), Some("`start.1.place`: is robot 3 of 2")),
        (format!("{two}{}", start("robot-0", fixed)), Some("`start.1.place`: is robot 0 of 2")),
        (format!("{two}{}", start("robot-x", fixed)), Some("unknown object `robot-x`; the nearest is `robot-1`")),
        (format!("{teams}{}", start("a", fixed)), Some("`start.1`: puts 2 robots on one point")),
        (format!("{teams}{}", start("b", fixed)), None),
        (format!("{teams}{}", start("a", one_of)), None),
        (
            format!("{teams}{}{}", start("a", anywhere), start("robot-2", anywhere)),
            Some("`start.2.place`: `robot-2` is placed twice"),
        ),
        (format!("{teams}{}{}", start("a", anywhere), start("robot-3", anywhere)), None),
        (
            format!("{two}{spots}{}{}", start("spots", one_of), start("robot", &format!("{one_of}\nlike = \"spots\""))),
            Some("`start.2`: puts 2 robots on one point"),
        ),
        (format!("{two}{spots}{}", start("spots", fixed)), Some("`start.1.place`: puts 2 things on one point")),
        (format!("{two}{spots}"), Some("`objects.1`: lacks the key `at`, and no `[[start]]` places it")),
        (
            format!("{two}{POST}{}", start("robot", "at = \"around\"\nof = \"post\"\ndistance = [0.7, 0.4]")),
            Some("`start.1.distance`: runs backwards"),
        ),
        (format!("{two}{POST}{}", start("robot", "at = \"around\"\nof = \"post\"\ndistance = [0.6, 0.6]")), None),
        (
            format!("{two}{}", start("robot", "at = \"turned\"\nlow = 0.0\nhigh = 1.0")),
            Some("`start.1.at`: is for robots with joints"),
        ),
        (
            format!(
                "{two}{}{}",
                start("robot-1", anywhere),
                start("robot-2", "at = \"near\"\nof = \"robot-1\"\nwithin = 0.5")
            ),
            None,
        ),
        (
            format!("{two}{}", start("robot-2", "at = \"near\"\nof = \"robot-1\"\nwithin = 0.5")),
            Some("`start.1.of`: `robot-1` has to be placed before"),
        ),
        (format!("{two}{POST}{}", start("post", anywhere)), None),
        (
            format!(
                "{two}[[objects]]\nname = \"bar\"\nkind = \"wall\"\nsize = [0.3, 0.1]\nat = [1.0, 1.0]\n{}",
                start("bar", anywhere)
            ),
            Some("`start.1.place`: `bar` is a wall, which has no middle"),
        ),
        (format!("{two}{}", start("robot", "at = \"one-of\"\npoints = [[0.4, 0.5]]")), Some("no free place")),
    ] {
        match why {
            Some(why) => assert!(refused(&file(&text)).contains(why), "{}\nwhere\n{why}", refused(&file(&text))),
            None => assert!(made(&file(&text)).is_ok(), "{text}"),
        }
    }
}
