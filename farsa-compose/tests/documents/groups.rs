//! Robots in groups: of different kinds, with one genome or a population each, and things on one of several points.

use farsa_body::ports::BodyId;
use farsa_body::{Pose, Recorder};
use farsa_compose::ComposedExperiment;
use farsa_lab::advanced::Lanes;
use farsa_lab::{EpisodeId, Evaluation, Evaluator, Experiment as _, Outcome, Settings};

const CHASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../experiments/chase.toml");

/// Two groups of e-puck: one with one robot, one with two.
const GROUPS: &str = "[[robots]]\nname = \"hunter\"\nkind = \"e-puck\"\nspeed = 0.12\n\
     [[robots]]\nname = \"prey\"\nkind = \"e-puck\"\ncount = 2\nspeed = 0.06\n\
     [[sensors]]\nkind = \"constant\"\nvalue = 1.0\n[[motors]]\nkind = \"wheels\"\n[network]\nkind = \"perceptron\"\n\
     [world]\nsize = [4.0, 4.0]\n[episode]\nsteps = 10\ntrials = 1\n\
     [[start]]\nplace = \"hunter\"\nat = \"fixed\"\npoint = [2.0, 1.0]\n\
     [[start]]\nplace = \"prey\"\nat = \"one-of\"\npoints = [[1.0, 3.0], [2.0, 3.0], [3.0, 3.0]]\n";
const MOVED: &str = "[[reward]]\nkind = \"displacement\"\nover = \"end\"\n";

fn made(text: &str) -> Result<Box<dyn Evaluator>, farsa_lab::Error> {
    let made = ComposedExperiment::from_text("team.toml", text, farsa_lab::strategy::strategies())?;
    let mut settings = made.settings("");
    // As a strategy's settings are when there is a run.
    settings.retain(|setting| setting.key() != "evolution.population");
    settings.push(farsa_lab::Setting::whole("evolution.population", 10, 1..=100));
    made.prepare("", &Settings::new(settings)?)
}

fn evaluator(text: &str) -> Box<dyn Evaluator> {
    made(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Evaluates an individual whose outputs are all at one end, among others with their outputs at one end.
fn driven(evaluator: &mut dyn Evaluator, individual: u32, own: f32, others: f32) -> Outcome {
    let count = evaluator.info().parameters.len();
    let (own, others) = (vec![20.0 * own; count], vec![20.0 * others; count]);
    let opponents = [others.as_slice()];
    let id = EpisodeId { seed: 1, individual, ..EpisodeId::default() };
    evaluator.evaluate(Evaluation { opponents: &opponents, ..Evaluation::new(&own, id) }, None)
}

fn close(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1e-3, "{found} where {wanted} is wanted");
}

#[test]
fn robots_of_one_genome_may_differ() {
    let terms = "[[reward]]\nname = \"hunter\"\nkind = \"displacement\"\nof = \"hunter\"\nover = \"end\"\n\
                 [[reward]]\nname = \"prey\"\nkind = \"displacement\"\nof = \"prey\"\nover = \"end\"\n\
                 [[reward]]\nname = \"second\"\nkind = \"displacement\"\nrobot = 2\nover = \"end\"\n";
    let mut team = evaluator(&format!("{GROUPS}{MOVED}{terms}"));
    assert_eq!(team.info().populations, ["0"]);
    let outcome = driven(team.as_mut(), 0, 1.0, 0.0);
    // Half a second at 0.12 and at 0.06 m/s.
    for (found, wanted) in outcome.terms.iter().zip([0.04, 0.06, 0.03, 0.03]) {
        close(*found, wanted);
    }
    assert_eq!(outcome.terms.len(), 4);
}

#[test]
fn each_population_drives_its_own_robots_and_earns_by_them() {
    let terms = "[[reward]]\nname = \"hunter\"\nkind = \"displacement\"\nof = \"hunter\"\nover = \"end\"\n\
                 [[reward]]\nname = \"prey\"\nkind = \"displacement\"\nof = \"prey\"\nover = \"end\"\nweight = -1.0\n";
    let mut both = evaluator(&format!("[team]\ncoevolution = true\n{GROUPS}{MOVED}{terms}"));
    assert_eq!(both.info().populations, ["hunter", "prey"]);
    // A network without drive leaves both wheels at rest: 1/2.
    for (individual, own, others, wanted) in [
        (3, 1.0, 0.0, [0.06, 0.06, 0.0]),
        (3, 0.0, 1.0, [0.0, 0.0, 0.0]),
        (13, 1.0, 0.0, [0.03, 0.0, -0.03]),
        (13, 0.0, 1.0, [0.0, 0.0, 0.0]),
    ] {
        let outcome = driven(both.as_mut(), individual, own, others);
        for (found, wanted) in outcome.terms.iter().zip(wanted) {
            close(*found, wanted);
        }
    }
}

#[test]
fn lanes_have_the_bits_of_one_world() {
    let text = std::fs::read_to_string(CHASE).expect("the file");
    let mut alone = evaluator(&text);
    let ends: Vec<[f64; 2]> = alone.info().parameters.iter().map(|parameter| parameter.ends).collect();
    let row = |row: usize| {
        let share = |place: usize| ((row * 37 + place * 11) % 21) as f64 / 20.0;
        ends.iter().enumerate().map(|(place, [from, to])| (from + share(place) * (to - from)) as f32).collect()
    };
    let parameters: Vec<Vec<f32>> = (0..4).map(row).collect();
    let rows: Vec<&[f32]> = parameters.iter().map(Vec::as_slice).collect();
    let jobs: Vec<Evaluation<'_>> = (0..12)
        .map(|number| {
            let id = EpisodeId { seed: 4, individual: number % 20, trial: number % 6, ..EpisodeId::default() };
            let number = number as usize;
            let opponents = &rows[(number + 1) % 4..][..1];
            Evaluation { number, opponents, ..Evaluation::new(rows[number % 4], id) }
        })
        .collect();
    let expected: Vec<Outcome> = jobs.iter().map(|job| alone.evaluate(*job, None)).collect();
    assert!(expected.iter().all(Outcome::is_finite), "{expected:?}");
    assert!(expected.windows(2).any(|pair| pair[0].terms != pair[1].terms));
    let mut lanes = evaluator(&text);
    let side_by_side = lanes.in_lanes().expect("the arena has lanes");
    side_by_side.use_lanes(Lanes::best()).expect("a batch");
    let (mut next, mut found) = (jobs.iter(), vec![None; jobs.len()]);
    side_by_side.run_in_lanes(&mut || next.next().copied(), &mut |number, outcome| found[number] = Some(outcome));
    for (found, outcome) in found.into_iter().zip(&expected) {
        assert_eq!(found.as_ref(), Some(outcome));
    }
}

/// Where bodies were in the first step.
#[derive(Default)]
struct First {
    places: Vec<[f32; 2]>,
    ticks: usize,
}

impl Recorder for First {
    fn pose(&mut self, body: BodyId, pose: Pose) {
        if self.ticks == 0 {
            self.places.resize(self.places.len().max(body.index() + 1), [0.0; 2]);
            self.places[body.index()] = [pose.position[0], pose.position[1]];
        }
    }
    fn tick(&mut self, _: f64) {
        self.ticks += 1;
    }
}

#[test]
fn points_are_taken_once_and_all_of_them() {
    let mut team = evaluator(&format!("{GROUPS}{MOVED}"));
    let parameters = vec![0.0; team.info().parameters.len()];
    let mut seen = Vec::new();
    for trial in 0..60 {
        let (id, mut first) = (EpisodeId { seed: 9, trial, ..EpisodeId::default() }, First::default());
        team.evaluate(Evaluation::new(&parameters, id), Some(&mut first));
        let [one, two] = [first.places[1], first.places[2]];
        assert!(
            one != two && [one, two].iter().all(|[x, y]| *y == 3.0 && [1.0, 2.0, 3.0].contains(x)),
            "{one:?} {two:?}"
        );
        if !seen.contains(&[one, two]) {
            seen.push([one, two]);
        }
    }
    assert_eq!(seen.len(), 6, "each order of two of three points");
    let few = GROUPS.replace("[[1.0, 3.0], [2.0, 3.0], [3.0, 3.0]]", "[[1.0, 3.0]]");
    let error = made(&format!("{few}{MOVED}")).err().expect("an error").to_string();
    assert!(error.contains("`start`") && error.contains("no free place"), "{error}");
}

#[test]
fn controllers_leave_with_the_numbers_of_their_robots() {
    let both = evaluator(&format!("[team]\ncoevolution = true\n{GROUPS}{MOVED}"));
    let exports = both.exports().expect("exports");
    let parameters = vec![0.0; both.info().parameters.len()];
    let largest = |population| {
        let controller = exports.controller_of(population, &parameters).expect("a controller");
        format!("{:?}", controller.motors[0])
    };
    assert!(largest(0) != largest(1), "{}", largest(0));
    assert!(exports.controller_of(2, &parameters).is_none());
}

#[test]
fn what_is_wrong_is_said() {
    let two = |other: &str| GROUPS.replace("name = \"prey\"\nkind = \"e-puck\"", other);
    let coevolving = "[team]\ncoevolution = true\n";
    for (text, why) in [
        (format!("{GROUPS}[robot]\nkind = \"e-puck\"\n{MOVED}"), "`robots`: go not with `robot`"),
        ("[[sensors]]\nkind = \"touch\"\n[[motors]]\nkind = \"wheels\"\n[network]\nkind = \"perceptron\"\n[[reward]]\nkind = \"steps\"".into(), "lacks the key `robot`, or `robots`"),
        (format!("{}{MOVED}", two("name = \"hunter\"\nkind = \"e-puck\"")), "`hunter` names something else already"),
        (format!("{}{MOVED}", two("name = \"robot-3\"\nkind = \"e-puck\"")), "`robot-3` names something else already"),
        (format!("{}{MOVED}", two("name = \"prey\"\nkind = \"model\"")), "is for robots with joints; this one is on wheels"),
        (format!("{GROUPS}[[reward]]\nkind = \"steps\"\nof = \"pray\"\n"), "unknown group of robots `pray`; the nearest is `prey`"),
        (format!("{GROUPS}[[reward]]\nkind = \"steps\"\nof = \"prey\"\nrobot = 1\n"), "goes not with `robot`"),
        (format!("{GROUPS}[[reward]]\nkind = \"distance\"\nobject = \"prey\"\n"), "unknown object `prey`"),
        (format!("{GROUPS}[[objects]]\nname = \"prey\"\nkind = \"cylinder\"\nradius = 0.1\nat = [1.0, 1.0]\n{MOVED}"), "`prey` names something else already"),
        (
            format!("{}{MOVED}", two("name = \"prey\"\nkind = \"marxbot\"").replace("kind = \"constant\"\nvalue = 1.0", "kind = \"infrared\"")),
            "has 8 channels on `hunter` and 24 on `prey`: one network has to fit both",
        ),
        (
            format!("{coevolving}[robot]\nkind = \"e-puck\"\n[[sensors]]\nkind = \"touch\"\n[[motors]]\nkind = \"wheels\"\n[network]\nkind = \"perceptron\"\n{MOVED}"),
            "`team.coevolution`: is for groups of `robots`",
        ),
    ] {
        let found = made(&text).err().unwrap_or_else(|| panic!("nothing is wrong with\n{text}")).to_string();
        assert!(found.contains(why) && found.starts_with("team.toml"), "{found}\nwhere\n{why}\nis wanted of\n{text}");
    }
}

/// A sign and a goal on one of three points each: the goal as much further up as makes three square metres.
#[test]
fn a_thing_follows_the_choice_of_another() {
    let thing =
        |name: &str| format!("[[objects]]\nname = \"{name}\"\nkind = \"disc\"\nradius = 0.1\ncolor = [0, 0, 0]\n");
    let start = |name: &str, y: f64, like: &str| {
        format!("[[start]]\nplace = \"{name}\"\nat = \"one-of\"\npoints = [[1.0, {y}], [2.0, {y}], [3.0, {y}]]\n{like}")
    };
    let reward = |name: &str| {
        format!("[[reward]]\nname = \"{name}\"\nkind = \"distance\"\nobject = \"{name}\"\nover = \"end\"\n")
    };
    let rest = "[[start]]\nplace = \"robot\"\nat = \"fixed\"\npoint = [0.5, 1.0]\n[robot]\nkind = \"khepera\"\n\
                [[sensors]]\nkind = \"constant\"\nvalue = 1.0\n[[motors]]\nkind = \"wheels\"\n\
                [network]\nkind = \"perceptron\"\n[world]\nsize = [4.0, 4.0]\n[episode]\nsteps = 1\ntrials = 1\n";
    let text = |like: &str| {
        let things = [thing("sign"), thing("goal"), start("sign", 2.0, ""), start("goal", 3.0, like)].concat();
        things + &reward("sign") + &reward("goal") + rest
    };
    let apart = |like: &str| -> Vec<[i64; 2]> {
        let mut evaluator = evaluator(&text(like));
        let still = vec![0.0; evaluator.info().parameters.len()];
        let trial = |trial| {
            let id = EpisodeId { seed: 1, trial, ..EpisodeId::default() };
            let terms = evaluator.evaluate(Evaluation::new(&still, id), None).terms;
            // Index of each robot's point, from 0, by its distance from the robot.
            let number = |squared: f64| ((squared.sqrt() - 0.5) as f32).round() as i64;
            [number(terms[0] * terms[0] - 1.0), number(terms[1] * terms[1] - 4.0)]
        };
        (0..60).map(trial).collect()
    };
    let (alone, together) = (apart(""), apart("like = \"sign\"\n"));
    for number in 0..3 {
        assert!(together.contains(&[number, number]), "{together:?}");
    }
    assert!(together.iter().all(|[sign, goal]| sign == goal), "{together:?}");
    assert!(alone.iter().any(|[sign, goal]| sign != goal), "{alone:?}");
    // The choice that it follows is drawn as without it.
    assert!(alone.iter().zip(&together).all(|(alone, together)| alone[0] == together[0]));
}
