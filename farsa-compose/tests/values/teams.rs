//! Terms of several robots on wheels, and of food.

use std::fmt::Write as _;

use crate::wheels::{Step, TIME_STEP, driven};
use crate::{Trial, all_close, close, distance, refused, yes};

/// Starts [m] and headings [deg] of three robots, and the radius of their hulls [m].
const STARTS: [([f64; 2], f64); 3] = [([0.7, 0.5], 20.0), ([0.9, 1.1], 140.0), ([1.9, 0.8], -75.0)];
const RADIUS: f64 = 0.17;

fn file(terms: &str) -> String {
    let mut text = format!(
        "world = {{ size = [3.1, 2.3], time_step = {TIME_STEP} }}\n\
         robot = {{ kind = \"e-puck\", count = 3, radius = {RADIUS} }}\n\
         sensors = [{{ kind = \"constant\", value = 1.0 }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
         network = {{ kind = \"wired\", bias = [0.95, 0.8], wires = [] }}\nepisode = {{ steps = 24, trials = 1 }}\n\
         [[objects]]\nname = \"yard\"\nkind = \"rectangle\"\nsize = [0.9, 0.14]\nheading = 70\nat = [0.78, 0.8]\n\
         color = [0.1, 0.3, 0.8]\n{terms}"
    );
    for (number, (at, heading)) in STARTS.iter().enumerate() {
        let _ = writeln!(
            text,
            "[[start]]\nplace = \"robot-{}\"\nat = \"fixed\"\npoint = {at:?}\nheading = {heading}",
            number + 1
        );
    }
    text
}

fn team(number: usize) -> [Step; 3] {
    STARTS.map(|(at, heading)| driven(at, heading.to_radians(), [0.95, 0.8], number))
}

fn mean(values: [f64; 3]) -> f64 {
    values.iter().sum::<f64>() / 3.0
}

fn in_yard([x, y]: [f64; 2]) -> bool {
    let (sine, cosine) = 70_f64.to_radians().sin_cos();
    let [u, v] = [x - 0.78, y - 0.8];
    (u * cosine + v * sine).abs() <= 0.45 && (v * cosine - u * sine).abs() <= 0.07
}

/// Distances of the pairs of robots: first and second, second and third, third and first.
fn pairs(team: &[Step; 3]) -> [f64; 3] {
    [[0, 1], [1, 2], [2, 0]].map(|[a, b]: [usize; 2]| distance(team[a].at, team[b].at))
}

/// Pairs without room for another robot: their centers are less than 4 radii apart.
fn linked(team: &[Step; 3]) -> usize {
    pairs(team).iter().filter(|far| **far < 4.0 * RADIUS).count()
}

type Case = (&'static str, &'static str, fn(&[Step; 3]) -> f64);

pub(crate) const TERMS: &[Case] = &[
    ("distance", "object = \"yard\"", |team| mean(team.each_ref().map(|robot| distance(robot.at, [0.78, 0.8])))),
    ("distance", "object = \"yard\"\nrobot = 2", |team| distance(team[1].at, [0.78, 0.8])),
    // A robot is at no distance from itself.
    ("distance", "object = \"robot-3\"", |team| (pairs(team)[1] + pairs(team)[2]) / 3.0),
    ("approach", "object = \"robot-3\"\nrobot = 1", |team| {
        // The place of the thing is the present one in both distances.
        distance(STARTS[0].0, team[2].at) - pairs(team)[2]
    }),
    ("gap", "object = \"robot-3\"\nrobot = 1", |team| pairs(team)[2] - 2.0 * RADIUS),
    ("moved", "object = \"robot-2\"", |team| distance(team[1].at, STARTS[1].0)),
    ("moved", "object = \"robot-2\"\nrobot = 3", |team| distance(team[1].at, STARTS[1].0)),
    ("displacement", "robot = 3", |team| distance(team[2].at, STARTS[2].0)),
    ("position", "along = [-0.2, 0.5, 0.0]", |team| {
        mean(team.each_ref().map(|robot| (0.5 * robot.at[1] - 0.2 * robot.at[0]) / f64::sqrt(0.29)))
    }),
    ("in-area", "area = \"yard\"", |team| mean(team.each_ref().map(|robot| yes(in_yard(robot.at))))),
    ("fullest-area", "area = \"yard\"", |team| mean(team.each_ref().map(|robot| yes(in_yard(robot.at))))),
    ("near-others", "", |team| {
        // Each pair counts for both of its robots, of which each has two others.
        let far = pairs(team).iter().sum::<f64>() / 3.0;
        1.0 - far / f64::hypot(3.1, 2.3)
    }),
    ("dispersion", "", |team| {
        // The sum of squares about the centroid is the sum over all pairs divided by the number of robots.
        pairs(team).iter().map(|far| far * far).sum::<f64>() / 3.0 / (4.0 * RADIUS * RADIUS)
    }),
    ("clusters", "", |team| [3.0, 2.0, 1.0, 1.0][linked(team)]),
    ("largest-cluster", "", |team| [1.0, 2.0, 3.0, 3.0][linked(team)] / 3.0),
];

#[test]
fn each_term_of_a_team_has_its_value() {
    let mut terms = String::new();
    for (number, (kind, keys, _)) in TERMS.iter().enumerate() {
        let _ = writeln!(terms, "[[reward]]\nname = \"v{number}\"\nkind = \"{kind}\"\n{keys}");
    }
    let trial = Trial::new(&file(&terms));
    let mut links = [0; 4];
    for number in 1..=24 {
        links[linked(&team(number))] += 1;
        for (index, (kind, keys, value)) in TERMS.iter().enumerate() {
            let found = trial.column(&format!("v{index}"))[number - 1];
            close(found, value(&team(number)), 2e-5, &format!("{kind} {keys} after step {number}"));
        }
    }
    assert!(links[0] > 0 && links[1] > 0, "robots join and part: {links:?}");
    let areas = |number: usize| team(number).each_ref().map(|robot| in_yard(robot.at));
    assert!((1..=24).any(|number| areas(number) == [true, true, false]), "two are in one area");
    assert!((1..=24).any(|number| areas(number) == [false, true, false]), "one is");
}

/// With two areas of one name, the one with more robots counts.
#[test]
fn the_fullest_of_several_areas_counts() {
    let rest = "[[objects]]\nname = \"spots\"\nkind = \"disc\"\nradius = 0.42\ncount = 2\ncolor = [0, 0, 0]\n\
        [[start]]\nplace = \"spots\"\nat = \"anywhere\"\nwalls = 0.0\napart = 0.2\n\
        [[reward]]\nname = \"full\"\nkind = \"fullest-area\"\narea = \"spots\"\n\
        [[reward]]\nname = \"in\"\nkind = \"in-area\"\narea = \"spots\"\n";
    let text = file(rest);
    let mut evaluator = crate::made(&text).unwrap_or_else(|error| panic!("{error}"));
    let parameters = vec![0.0; evaluator.info().parameters.len()];
    let mut seen = [[0; 4]; 4];
    for trial in 0..40 {
        let mut recording = farsa_lab::advanced::Recording::new(evaluator.info().schema);
        let id = farsa_lab::EpisodeId { trial, ..farsa_lab::EpisodeId::default() };
        evaluator.evaluate(farsa_lab::Evaluation::new(&parameters, id), Some(&mut recording));
        let place = |body| {
            let pose = recording.pose_at(0, farsa_body::ports::BodyId(body)).expect("a body");
            [0, 1].map(|k| f64::from(pose.position[k]))
        };
        // Robots, the yard, and the two spots. They are apart, so no robot is in both.
        let counts = [4, 5].map(|spot| (0..3).filter(|robot| distance(place(*robot), place(spot)) <= 0.42).count());
        let columns = recording.schema().columns();
        let value = |name: &str| {
            let index = columns.iter().position(|column| column == name).expect("a term");
            recording.row(0).nth(index).expect("a value")
        };
        close(value("full"), counts[0].max(counts[1]) as f64 / 3.0, 1e-12, "fullest");
        close(value("in"), (counts[0] + counts[1]) as f64 / 3.0, 1e-12, "in any");
        seen[counts[0]][counts[1]] += 1;
    }
    assert!(seen[1][1] + seen[1][2] + seen[2][1] > 0, "both have robots: {seen:?}");
}

/// The measure of a group, and the share of time that is left: n steps of 24 are over. Group `b` counts the rest of 1.
#[test]
fn groups_have_their_own_terms() {
    let groups = "robots = [{ name = \"a\", kind = \"e-puck\", count = 2, radius = 0.17 }, \
         { name = \"b\", kind = \"e-puck\", radius = 0.17 }]\n";
    let terms = "[[reward]]\nname = \"all\"\nkind = \"time-left\"\nrest = \"b\"\n\
        [[reward]]\nname = \"a-left\"\nkind = \"time-left\"\nrest = \"b\"\nof = \"a\"\n\
        [[reward]]\nname = \"b-left\"\nkind = \"time-left\"\nrest = \"b\"\nof = \"b\"\n\
        [[reward]]\nname = \"x-of-a\"\nkind = \"position\"\nalong = [1.0, 0.0, 0.0]\nof = \"a\"\n\
        [[reward]]\nname = \"to-b\"\nkind = \"distance\"\nobject = \"b\"\nof = \"a\"\n";
    let text = file(terms).replace("robot = { kind = \"e-puck\", count = 3, radius = 0.17 }\n", groups);
    let trial = Trial::new(&text);
    for number in 1..=24_usize {
        let (team, past) = (team(number), number as f64 / 24.0);
        let wanted = [
            ("all", (2.0 * (1.0 - past) + past) / 3.0),
            ("a-left", 1.0 - past),
            ("b-left", past),
            ("x-of-a", 0.5 * (team[0].at[0] + team[1].at[0])),
            ("to-b", 0.5 * (pairs(&team)[1] + pairs(&team)[2])),
        ];
        for (name, wanted) in wanted {
            close(trial.column(name)[number - 1], wanted, 1e-5, &format!("{name} after step {number}"));
        }
    }
}

/// Two `MarXbot`s at 0.027 m a step on cells of 0.5 m by 0.375 m.
///
/// The first begins at x = 0.4 and heads along x. It takes the food of its cell in step 1 and of the next in step 4
/// (0.508). It reaches the nest, from 0.7 to 1.0, in step 12 (0.724) and leaves it into the third cell in step 23
/// (1.021). The second begins at x = 1.3 and heads against x. It takes food in step 1 and, below 1.0, in step 12
/// (0.976). With a cost of 0.06 it dies in step 17 with both.
#[test]
fn food_and_energy_are_counted_by_hand() {
    let terms = ["food", "carried-food", "lost-food", "deaths", "energy", "alive"];
    let rewards = terms.map(|kind| format!("{{ kind = \"{kind}\" }}")).join(", ");
    let text = format!(
        "world = {{ size = [2.0, 1.5], time_step = 0.2 }}\nrobot = {{ kind = \"marxbot\", count = 2 }}\n\
         sensors = [{{ kind = \"energy\" }}, {{ kind = \"carried\" }}]\nmotors = [{{ kind = \"wheels\" }}]\n\
         network = {{ kind = \"wired\", bias = [0.75, 0.75], wires = [] }}\nepisode = {{ steps = 24, trials = 1 }}\n\
         objects = [{{ name = \"nest\", kind = \"disc\", radius = 0.15, at = [0.85, 0.2], color = [0, 0, 0] }}]\n\
         foraging = {{ nest = \"nest\", cells = 4, cost = 0.06 }}\nreward = [{rewards}]\n\
         [[start]]\nplace = \"robot-1\"\nat = \"fixed\"\npoint = [0.4, 0.2]\n\
         [[start]]\nplace = \"robot-2\"\nat = \"fixed\"\npoint = [1.3, 1.1]\nheading = 180\n"
    );
    let trial = Trial::new(&text);
    let spent = |steps: usize| 1.0 - 0.06 * steps as f64;
    let energy = |number: usize| {
        let first = match number {
            ..12 => spent(number),
            12..23 => 1.0,
            _ => spent(number - 22),
        };
        [first, if number < 17 { spent(number) } else { 0.0 }]
    };
    for number in 1..=24_usize {
        let carried = match number {
            4..12 => 2 + 1,
            1..4 | 12..17 => 2,
            17..23 => 0,
            _ => 1,
        };
        let (delivered, dead) = (number >= 12, number >= 17);
        let wanted = [
            2.0 * yes(delivered),
            f64::from(carried),
            2.0 * yes(dead),
            yes(dead),
            0.5 * (energy(number)[0] + energy(number)[1]),
            1.0 - 0.5 * yes(dead),
        ];
        let found = terms.map(|kind| trial.column(kind)[number - 1]);
        all_close(&found, &wanted, 1e-9, &format!("{terms:?} after step {number}"));
        // Sensors of the first robot are read before the step.
        let before = number - 1;
        let load = (1..12).contains(&before) || before >= 23;
        all_close(&trial.sensor("energy", number), &[energy(before)[0]], 1e-6, "energy");
        all_close(&trial.sensor("carried", number), &[yes(load)], 0.0, "carried");
    }
    // The dead robot rests where it died, 17 steps from its start. It still drives in that step.
    let at = trial.recording.pose_at(23, farsa_body::ports::BodyId(1)).expect("a body").position;
    close(f64::from(at[0]), 1.3 - 17.0 * 0.027, 1e-5, "place of death");
}

/// The first of two `MarXbot`s faces the second, which faces away: their hulls are 0.01 m apart, and devices reach 0.02 m.
#[test]
fn what_is_held_counts_for_the_robot_that_holds() {
    let (sine, cosine) = 33_f64.to_radians().sin_cos();
    let at = [1.1 + 0.18 * cosine, 0.6 + 0.18 * sine];
    let text = |attachment: f64| {
        format!(
            "world = {{ size = [3.0, 2.0] }}\nrobot = {{ kind = \"marxbot\", count = 2 }}\n\
             sensors = [{{ kind = \"attachment\" }}]\nmotors = [{{ kind = \"wheels\" }}, {{ kind = \"attachment\" }}]\n\
             network = {{ kind = \"wired\", bias = [0.5, 0.5, {attachment}], wires = [] }}\n\
             episode = {{ steps = 3, trials = 1 }}\n\
             reward = [{{ kind = \"held\" }}, {{ name = \"one\", kind = \"held\", robot = 1 }}, \
             {{ name = \"two\", kind = \"held\", robot = 2 }}]\n\
             [[start]]\nplace = \"robot-1\"\nat = \"fixed\"\npoint = [1.1, 0.6]\nheading = 33\n\
             [[start]]\nplace = \"robot-2\"\nat = \"fixed\"\npoint = {at:?}\nheading = 33\n"
        )
    };
    for (attachment, held) in [(0.8, 1.0), (0.4, 0.0)] {
        let trial = Trial::new(&text(attachment));
        for (name, wanted) in [("held", 0.5 * held), ("one", held), ("two", 0.0)] {
            assert_eq!(trial.column(name), [wanted; 3], "{name} at {attachment}");
        }
        assert_eq!([1, 2, 3].map(|step| trial.sensor("attachment", step)[0]), [0.0, held, held]);
    }
}

/// Robots are numbered from 1, and a term names one of them or a group.
#[test]
fn terms_name_robots_that_there_are() {
    let term = |keys: &str| file(&format!("[[reward]]\nkind = \"distance\"\nobject = \"yard\"\n{keys}\n"));
    assert_eq!(Trial::new(&term("robot = 3")).outcome.steps, 24);
    for (keys, why) in [
        ("robot = 4", "`reward.1.robot`: is robot 4 of 3"),
        ("of = \"robots\"", "unknown group of robots `robots`; the nearest is `robot`"),
        ("object = \"yart\"", "unknown object `yart`; the nearest is `yard`"),
        ("object = \"robot-4\"", "unknown object `robot-4`; the nearest is `robot-1`"),
    ] {
        let text = if keys.starts_with("object") { term("").replace("object = \"yard\"", keys) } else { term(keys) };
        let found = refused(&text);
        assert!(found.contains(why), "{found}");
    }
    // A robot alone is not a thing for its own measures.
    let alone = crate::wheels::file(
        crate::wheels::OUTPUTS,
        crate::wheels::NOTHING,
        "[[reward]]\nkind = \"moved\"\nobject = \"robot-2\"\n",
    );
    let found = refused(&alone);
    assert!(found.contains("unknown object `robot-2`") && !found.contains("robot-1"), "{found}");
}

/// Two robots on given circles, each in an area or not, and the exchanges that are counted.
#[test]
fn exchanges_count_each_time_that_both_are_the_other_way_round() {
    // Both robots turn about the middle between the areas, half a turn apart, so that each half turn is an exchange.
    let text = |size: f64, start: f64| {
        format!(
            r#"
world = {{ size = [2.0, 2.0], time_step = 0.1 }}
robot = {{ kind = "e-puck", count = 2 }}
objects = [
    {{ name = "left", kind = "disc", radius = {size}, color = [0.0, 0.0, 0.0], at = [0.8, 1.0] }},
    {{ name = "right", kind = "rectangle", size = [{side}, {side}], color = [0.0, 0.0, 0.0], at = [1.2, 1.0] }},
]
sensors = [{{ kind = "constant", value = 0.0 }}]
motors = [{{ kind = "wheels" }}]
network = {{ kind = "wired", bias = [0.6915, 0.75], wires = [] }}
episode = {{ steps = 600, trials = 1 }}
start = [
    {{ place = "robot-1", at = "fixed", point = [{start}, 1.0], heading = -90.0 }},
    {{ place = "robot-2", at = "fixed", point = [{other}, 1.0], heading = 90.0 }},
]
[[reward]]
kind = "exchanges"
area = "left"
with = "right"
over = "end"
"#,
            side = 2.0 * size,
            other = 2.0 - start,
        )
    };
    let trial = Trial::new(&text(0.15, 0.8));
    let counts = trial.column("exchanges");
    // Turns from the positions of the recorded robot: it is in the left area, then in the right one, and so on.
    let xs = trial.column("x [m]");
    let (mut expected, mut last) = (0.0, xs[0] < 1.0);
    for (x, count) in xs.iter().zip(&counts) {
        let inside = if *x < 1.0 { (x - 0.8).abs() } else { (x - 1.2).abs() };
        if inside < 0.1 && last != (*x < 1.0) {
            (expected, last) = (expected + 1.0, *x < 1.0);
        }
        assert!((count - expected).abs() <= 1.0, "{count} is not {expected}");
    }
    assert!(expected >= 2.0 && counts.last() == Some(&expected), "{expected} {:?}", counts.last());
    // Nothing is counted in areas that are too small to be met.
    assert_eq!(Trial::new(&text(0.001, 0.785)).outcome.terms[0], 0.0);
    let error = refused(&text(0.15, 0.8).replace("count = 2", "count = 1").replace("    { place = \"robot-2\"", "#"));
    assert!(error.contains("is for two robots on wheels"), "{error}");
    let error = refused(&text(0.15, 0.8).replace("with = \"right\"", "with = \"rihgt\""));
    assert!(error.contains("unknown object `rihgt`; the nearest is `right`"), "{error}");
}
