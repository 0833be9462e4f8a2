//! Errors of a file have its line and key, and the nearest valid word.

use farsa_compose::ComposedExperiment;
use farsa_lab::{Experiment as _, Settings};
use farsa_nn::LeakyLayout;

/// A file that is right, a line each key.
const RIGHT: &str = r#"summary = "an e-puck looks for a lamp"
[world]
size = [1.0, 1.0]
[[objects]]
name = "lamp"
kind = "cylinder"
radius = 0.02
lamp = 1.0
[robot]
kind = "e-puck"
[[sensors]]
kind = "light"
wrappers = [{ kind = "uniform-noise", amplitude = 0.05 }]
[[motors]]
kind = "wheels"
[network]
kind = "leaky"
hidden = 2
[episode]
steps = 50
trials = 2
[[start]]
place = "lamp"
at = "anywhere"
walls = 0.1
[[reward]]
kind = "approach"
object = "lamp"
over = "end"
[[success]]
term = "approach"
above = 0.1
[evolution]
generations = 3
population = 4
parents = 2
"#;

fn error(text: &str) -> String {
    match ComposedExperiment::from_text("look.toml", text, farsa_lab::strategy::strategies()) {
        Ok(made) => {
            let made = Settings::new(made.settings("")).and_then(|settings| made.prepare("", &settings).map(drop));
            made.err().map_or_else(|| "nothing is wrong".into(), |error| error.to_string())
        }
        Err(error) => {
            assert_eq!(error.exit_code(), 2, "{error}");
            error.to_string()
        }
    }
}

#[test]
fn the_file_is_right() {
    assert_eq!(error(RIGHT), "nothing is wrong");
}

#[test]
fn what_is_wrong_is_named_with_file_line_and_key() {
    for (line, wrong, message) in [
        ("hidden = 2", "hiden = 2", "look.toml line 18: unknown key `hiden`; the nearest is `hidden`"),
        ("kind = \"light\"", "kind = \"ligth\"", "look.toml line 12: unknown kind `ligth`; the nearest is `light`"),
        ("kind = \"e-puck\"", "kind = \"epuck\"", "look.toml line 10: unknown choice `epuck`; the nearest is `e-puck`"),
        ("object = \"lamp\"", "object = \"lamb\"", "look.toml line 28: unknown object `lamb`; the nearest is `lamp`"),
        (
            "term = \"approach\"",
            "term = \"aproach\"",
            "look.toml line 31: unknown term `aproach`; the nearest is `approach`",
        ),
        ("hidden = 2", "hidden = 2.5", "look.toml line 18: network.hidden: is not a whole number"),
        ("hidden = 2", "hidden = 0", "look.toml line 18: network.hidden: 0 is outside 1 to 10000"),
        ("radius = 0.02", "radius = nan", "look.toml line 7: objects.1.radius: NaN is not a number"),
        ("radius = 0.02", "radius = -1", "look.toml line 7: objects.1.radius: -1 is outside 0.0001 to 100"),
        ("radius = 0.02", "", "look.toml line 4: objects.1: lacks the key `radius`"),
        ("size = [1.0, 1.0]", "size = [1.0]", "look.toml line 3: world.size: has 1 values where 2 are wanted"),
        ("size = [1.0, 1.0]", "size = 1.0", "look.toml line 3: world.size: is not a list"),
        ("steps = 50", "steps = 99999999999999999999", "look.toml line 20: episode.steps: is too large a number"),
        ("name = \"lamp\"", "name = \"Lamp\"", "look.toml line 5: objects.1.name: is not a name: 1 to 40"),
        (
            "name = \"lamp\"",
            "name = \"robot\"",
            "look.toml line 5: objects.1.name: `robot` names something else already",
        ),
        ("above = 0.1", "", "look.toml line 30: success.1: lacks `above` and `below`"),
        (
            "at = \"anywhere\"",
            "",
            "look.toml line 22: start.1: lacks the key `at`: one of anywhere, near, around, in-box, one-of, posture, turned, fixed",
        ),
        ("walls = 0.1", "wals = 0.1", "look.toml line 25: unknown key `wals`; the nearest is `walls`"),
        (
            "amplitude = 0.05",
            "amplitude = -0.05",
            "look.toml line 13: sensors.1.wrappers.1.amplitude: -0.05 is outside 0",
        ),
        (
            "parents = 2",
            "parent = 2",
            "look.toml line 36: unknown key `evolution.parent`; the nearest is `evolution.parents`",
        ),
        ("parents = 2", "parents = -2", "look.toml line 36: evolution.parents: -2 is outside"),
        (
            "parents = 2",
            "strategy = \"cma-es\"",
            "look.toml line 36: `evolution.strategy`: is no setting; another strategy is `--strategy`, or `strategy.name` in a file",
        ),
        ("[robot]", "[robotz]", "look.toml line 9: unknown key `robotz`; the nearest is `robot`"),
        ("summary = \"an e-puck looks for a lamp\"", "summary = \"a\nb\"", "look.toml line 2"),
        (
            "kind = \"wheels\"",
            "kind = \"attachment\"",
            "look.toml line 14: motors.1: needs an attachment device; the e-puck has none",
        ),
    ] {
        assert_eq!(RIGHT.matches(line).count(), 1, "{line}");
        let found = error(&RIGHT.replace(line, wrong));
        assert!(plain(&found).starts_with(&plain(message)), "{wrong}\n  found:  {found}\n  wanted: {message}");
    }
}

#[test]
fn all_that_is_wrong_is_told_by_its_lines() {
    let wrong = RIGHT
        .replace("hidden = 2", "neurons = 2")
        .replace("kind = \"light\"", "kind = \"ligth\"")
        .replace("steps = 50", "steps = 0");
    let told = [
        "look.toml line 12: unknown kind `ligth`; the nearest is `light`",
        "look.toml line 18: unknown key `neurons`; there are `fixed`, `hidden`, `kind`, `leaks`, `shared`, `slope` and `weights`",
        "look.toml line 20: `episode.steps`: 0 is outside 1 to 1000000",
    ];
    assert_eq!(error(&wrong), told.join("; "));
    // A key that is needed may be there under a wrong name.
    let found = error(&RIGHT.replace("size = [1.0, 1.0]", "sizes = [1.0, 1.0]"));
    assert_eq!(found, "look.toml line 3: unknown key `sizes`; the nearest is `size`");
    let many = "[[sensors]]\nkind = \"ligth\"\n".repeat(900);
    assert_eq!(error(&format!("{RIGHT}{many}")).matches("ligth").count(), 20);
}

#[test]
fn parts_that_do_not_go_together_are_refused() {
    for (added, message) in [
        (
            "[[start]]\nplace = \"lamp\"\nat = \"anywhere\"\n",
            "look.toml line 38: start.2.place: `lamp` is placed twice",
        ),
        (
            "[[objects]]\nname = \"wall\"\nkind = \"wall\"\nsize = [1, 1]\n",
            "look.toml line 37: objects.2: lacks the key `at`",
        ),
        (
            "[[objects]]\nname = \"box\"\nkind = \"disc\"\nradius = 1\ncolor = [0, 0, 0]\n",
            "look.toml line 37: objects.2: lacks the key `at`, and no",
        ),
        (
            "[[reward]]\nkind = \"in-area\"\narea = \"lamp\"\n",
            "look.toml line 39: reward.2.area: `lamp` is no disc or rectangle",
        ),
        (
            "[[reward]]\nkind = \"touch\"\nduring = \"touch\"\n",
            "look.toml line 39: reward.2.during: `touch` has to stand before",
        ),
        ("[[reward]]\nkind = \"touch\"\nclip = [1, 0]\n", "look.toml line 39: reward.2.clip: runs backwards"),
        ("[[sensors]]\nkind = \"infrared\"\nfirst = 9\n", "look.toml line 37: sensors.2: channels 0..9 of 8"),
        ("[[sensors]]\nkind = \"signal\"\nrange = 1\nsectors = 3\n", "look.toml line 37: sensors.2: "),
        (
            "[[sensors]]\nkind = \"laser-distance\"\nbeams = 10000\nfield_of_view = 90\nrange = 1\nwrappers = [{ kind = \"delay\", steps = 10000 }]\n",
            "look.toml line 42: sensors.2.wrappers.1: ",
        ),
        ("[strategy]\nname = \"cmaes\"\n", "look.toml line 38: unknown strategy `cmaes`; the nearest is `cma-es`"),
        (
            "[[conditions]]\nname = \"a\"\nsettings = { \"network.hiden\" = 3 }\n",
            "look.toml line 39: unknown key `network.hiden`; the nearest is `network.hidden`",
        ),
        (
            "[[conditions]]\nname = \"a\"\n[[conditions]]\nname = \"a\"\n",
            "look.toml line 40: conditions.2.name: stands twice",
        ),
    ] {
        let found = error(&format!("{RIGHT}{added}"));
        assert!(plain(&found).starts_with(&plain(message)), "{added}\n  found:  {found}\n  wanted: {message}");
    }
}

#[test]
fn files_of_more_than_anybody_writes_are_refused() {
    let nested = format!("{RIGHT}[a{}]\n", ".a".repeat(100_000));
    let found = error(&nested);
    assert!(found.starts_with("look.toml line 37: ") && found.ends_with("recursion limit"), "{found}");
    // An error without a place in the text has the line from which on the text has it.
    for deep in ["[", "{ a = "] {
        let found = error(&RIGHT.replace("walls = 0.1", &format!("walls = {}", deep.repeat(10_000))));
        assert!(found.starts_with("look.toml line 25: "), "{found}");
    }
    // Each condition is checked as a separate experiment.
    let conditions =
        |count| (0..count).map(|n| format!("[[conditions]]\nname = \"c{n}\"\n")).collect::<Vec<_>>().concat();
    assert_eq!(error(&format!("{RIGHT}{}", conditions(100))), "nothing is wrong");
    let found = error(&format!("{RIGHT}{}", conditions(101)));
    assert_eq!(plain(&found), "look.toml line 37: conditions: has 101 values where 0 to 100 are wanted");
}

#[test]
fn what_lies_beyond_the_walls_is_refused() {
    let nest = "[[objects]]\nname = \"nest\"\nkind = \"disc\"\nradius = 0.1\ncolor = [0, 0, 0]\n";
    let disc = |at: &str| format!("{RIGHT}{nest}{at}\n");
    let start = |at: &str| format!("{RIGHT}[[start]]\nplace = \"robot\"\n{at}\n");
    let walls = "is outside the walls, which enclose 0 to 1 m and 0 to 1 m";
    for (text, line, key, at) in [
        (disc("at = [-0.2, 0.5]"), 42, "objects.2.at", "[-0.2, 0.5]"),
        (start("at = \"fixed\"\npoint = [0.5, 1.01]"), 40, "start.2.point", "[0.5, 1.01]"),
        (start("at = \"one-of\"\npoints = [[0.2, 0.2], [2, 0]]"), 40, "start.2.points.2", "[2, 0]"),
    ] {
        assert_eq!(plain(&error(&text)), format!("look.toml line {line}: {key}: {at} {walls}"));
        assert_eq!(error(&text.replace("size = [1.0, 1.0]", "size = [1.0, 1.0]\nwalls = false")), "nothing is wrong");
    }
    // A lamp behind a wall is seen.
    let lamp = RIGHT.replace("lamp = 1.0", "lamp = 1.0\nat = [-0.2, 0.5]");
    let lamp = lamp.replace("[[start]]\nplace = \"lamp\"\nat = \"anywhere\"\nwalls = 0.1\n", "");
    assert_eq!(error(&lamp), "nothing is wrong");
    for inside in ["at = [0.0, 1.0]", "at = [0.5, 0.5]"] {
        assert_eq!(error(&disc(inside)), "nothing is wrong");
    }
}

#[test]
fn robots_are_limited_with_all_that_they_carry() {
    let robots = |count: u32| {
        let wide = RIGHT.replace("[1.0, 1.0]", "[100.0, 100.0]");
        wide.replace("kind = \"e-puck\"", &format!("kind = \"e-puck\"\ncount = {count}"))
    };
    let sensors = |count: usize| "[[sensors]]\nkind = \"touch\"\n".repeat(count);
    // In addition there are a sensor and a motor: a hundred parts each.
    assert_eq!(error(&format!("{}{}", robots(1000), sensors(98))), "nothing is wrong");
    let found = plain(&error(&format!("{}{}", robots(1000), sensors(99))));
    let parts = "sensors: and motors are 101 on each of 1000 robots; at most 100000 in all";
    assert!(found.starts_with("look.toml") && found.ends_with(parts), "{found}");
    // Two lasers that alone send out few enough.
    let lasers = "[[sensors]]\nkind = \"laser-distance\"\nbeams = 200\nfield_of_view = 90\nrange = 1\n".repeat(2);
    let found = plain(&error(&format!("{}{lasers}", robots(600))));
    let rays = "sensors.3: and those before it send out 240000 rays from 600 robots; at most 200000 in all";
    assert!(found.ends_with(rays), "{found}");
    // Eight sensors of five rays.
    let infrared = "[[sensors]]\nkind = \"infrared\"\nmodel = \"rays\"\n";
    assert_eq!(error(&format!("{}{}", robots(1000), infrared.repeat(5))), "nothing is wrong");
    let found = plain(&error(&format!("{}{}", robots(1000), infrared.repeat(6))));
    let rays = "sensors.7: and those before it send out 240000 rays from 1000 robots; at most 200000 in all";
    assert!(found.ends_with(rays), "{found}");
    let groups = (0..600)
        .map(|n| format!("[[robots]]\nname = \"g{n}\"\nkind = \"e-puck\"\ncount = 2\n"))
        .collect::<Vec<_>>()
        .concat();
    let found = plain(&error(&RIGHT.replace("[robot]\nkind = \"e-puck\"\n", &groups)));
    assert!(found.ends_with("robots.501: and those before it are 1002 robots; at most 1000 in all"), "{found}");
}

#[test]
fn what_robots_keep_is_limited_for_all_of_them() {
    let robots = |hidden: usize, wrappers: &str| {
        let wide = RIGHT.replace("[1.0, 1.0]", "[100.0, 100.0]");
        let many = wide.replace("kind = \"e-puck\"", "kind = \"e-puck\"\ncount = 1000");
        let network = many.replace("hidden = 2", &format!("hidden = {hidden}"));
        network.replace("amplitude = 0.05 }]", &format!("amplitude = 0.05 }}{wrappers}]"))
    };
    // Eight lights, two wheels, and the noise of the lights, which counts as 32 values itself.
    let kept = |hidden| {
        let layout = LeakyLayout::new(8, hidden, 2);
        1000 * (8 + 8 + 32 + 2 + layout.parameter_count() + layout.state_len())
    };
    let hidden = (1..200).take_while(|hidden| kept(*hidden) <= 10_000_000).last().expect("a network");
    assert_eq!(error(&robots(hidden, "")), "nothing is wrong");
    let found = plain(&error(&robots(hidden + 1, "")));
    let wanted =
        format!("network: and what is before it keep {} values; at most 10000000 in all robots", kept(hidden + 1));
    assert!(found.starts_with("look.toml line 17") && found.ends_with(&wanted), "{found}");
    // With delays the 125th robot of 8 * (1 + 1 + 10 000) + 2 * 32 values is one too many.
    let found = plain(&error(&robots(2, ", { kind = \"delay\", steps = 10000 }")));
    let wanted = "sensors.1.wrappers.2: and what is before it keep 10010000 values; at most 10000000 in all robots";
    assert!(found.starts_with("look.toml line 14") && found.ends_with(wanted), "{found}");
    let many = ", { kind = \"scale\", gain = 1.0 }";
    assert_eq!(error(&robots(2, &many.repeat(31))), "nothing is wrong");
    let found = plain(&error(&robots(2, &many.repeat(32))));
    assert!(found.starts_with("look.toml line 14: sensors.1.wrappers") && found.contains("32"), "{found}");
}

/// A file with a changed byte, a missing line or a cut is a valid file or an error. None panics.
#[test]
fn no_damage_panics() {
    let mut refused = 0;
    let lines: Vec<&str> = RIGHT.lines().collect();
    for left_out in 0..lines.len() {
        let kept = lines.iter().enumerate().filter(|(line, _)| *line != left_out).map(|(_, line)| *line);
        refused += usize::from(error(&kept.collect::<Vec<_>>().join("\n")) != "nothing is wrong");
        refused += usize::from(error(&lines[..left_out].join("\n")) != "nothing is wrong");
    }
    for (place, _) in RIGHT.char_indices().step_by(3) {
        for other in ["", "[", "\"", "=", "9", "-", "\u{7f}", "\n"] {
            let text = format!("{}{other}{}", &RIGHT[..place], &RIGHT[place + 1..]);
            refused += usize::from(error(&text) != "nothing is wrong");
        }
    }
    assert!(refused > 500, "{refused} were refused");
}

/// Without the quotes of names.
fn plain(text: &str) -> String {
    text.replace('`', "")
}

/// Names in capitals are no keys of settings. They are unknown names like others.
#[test]
fn unknown_names_in_capitals_are_refused_with_their_lines() {
    for (line, wrong, message) in [
        ("place = \"lamp\"", "place = \"LAMP\"", "line 23: unknown object LAMP; the nearest is lamp"),
        ("term = \"approach\"", "term = \"GOAL\"", "line 31: unknown term GOAL"),
        ("object = \"lamp\"", "object = \"Lamp\"", "line 28: unknown object Lamp; the nearest is lamp"),
    ] {
        let found = plain(&error(&RIGHT.replace(line, wrong)));
        assert!(found.starts_with(&format!("look.toml {message}")), "{wrong}: {found}");
    }
    for list in ["success", "failure", "end"] {
        let found = plain(&error(&format!("{RIGHT}[[{list}]]\nterm = \"The Goal\"\nabove = 1\n")));
        assert!(found.starts_with("look.toml line 38: unknown term The Goal"), "{found}");
    }
    let found = plain(&error(&format!("{RIGHT}[[behaviour.objectives]]\nterm = \"GOAL\"\n")));
    assert!(found.starts_with("look.toml line 38: unknown term GOAL"), "{found}");
}

/// A robot alone has a number, which there has to be.
#[test]
fn robots_are_named_alone() {
    for (added, message) in [
        ("[[start]]\nplace = \"robot-2\"\nat = \"anywhere\"\n", "look.toml line 38: start.2.place: is robot 2 of 1"),
        ("[[start]]\nplace = \"robot-1\"\nat = \"anywhere\"\n", "nothing is wrong"),
        ("[[reward]]\nkind = \"touch\"\nrobot = 2\n", "look.toml line 39: reward.2.robot: is robot 2 of 1"),
    ] {
        let found = error(&format!("{RIGHT}{added}"));
        assert!(plain(&found).starts_with(message), "{added}\n  found:  {found}\n  wanted: {message}");
    }
}

/// A change of a line of `key = value`.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Damage {
    UnknownKey,
    OtherType,
    OutOfRange,
    NoNumber,
    UnknownWord,
    NoToml,
    Twice,
    Capitals,
    Deep,
}

/// The line damaged, if it can be.
fn damaged(line: &str, damage: Damage) -> Option<String> {
    // Not those of contents of files, which have several lines.
    let (key, value) = line.split_once(" = ").filter(|(key, _)| !key.starts_with('"'))?;
    let number = value.parse::<f64>().is_ok();
    let words =
        ["kind", "place", "at", "of", "object", "area", "nest", "target", "over", "model", "from", "to", "activation"];
    let word = words.contains(&key);
    match damage {
        Damage::UnknownKey => Some(format!("{key}-zq = {value}")),
        Damage::OtherType => Some(format!("{key} = {{ zq = 1 }}")),
        Damage::OutOfRange => number.then(|| format!("{key} = 1e300")),
        Damage::NoNumber => number.then(|| format!("{key} = nan")),
        Damage::UnknownWord => {
            let text = value.strip_prefix('"').filter(|_| word)?;
            Some(format!("{key} = \"zq-{text}"))
        }
        Damage::Capitals => {
            let text = value.strip_prefix('"').filter(|text| word && text.contains(char::is_lowercase))?;
            Some(format!("{key} = \"{}", text.to_uppercase()))
        }
        Damage::Deep => Some(format!("{key} = {}", "[".repeat(300))),
        Damage::NoToml => Some(format!("{key} {value}")),
        Damage::Twice => Some(format!("{line}\n{line}")),
    }
}

/// One line of each file drawn at random is damaged: it is refused, with that line and its key.
#[test]
fn drawn_files_are_refused_with_line_and_key() {
    const ALL: [Damage; 9] = [
        Damage::UnknownKey,
        Damage::OtherType,
        Damage::OutOfRange,
        Damage::NoNumber,
        Damage::UnknownWord,
        Damage::NoToml,
        Damage::Twice,
        Damage::Capitals,
        Damage::Deep,
    ];
    let mut counts = [0; ALL.len()];
    for file in 0..300 {
        let mut draw = crate::drawn::Draw::new(20_261_126, file);
        let text = draw.file();
        assert_eq!(error(&text), "nothing is wrong", "{text}");
        let lines: Vec<&str> = text.lines().collect();
        let (number, damage, line) = (0..)
            .find_map(|_| {
                let number = draw.stream.below(lines.len() as u32) as usize;
                let damage = ALL[draw.stream.below(ALL.len() as u32) as usize];
                damaged(lines[number], damage).map(|line| (number, damage, line))
            })
            .expect("a line that can be damaged");
        counts[damage as usize] += 1;
        let all = lines.iter().enumerate().map(|(own, kept)| if own == number { line.as_str() } else { kept });
        let found = error(&all.collect::<Vec<_>>().join("\n"));
        // The second of two is the wrong one.
        let line_number = number + 1 + usize::from(damage == Damage::Twice);
        assert!(
            found.starts_with(&format!("look.toml line {line_number}: ")),
            "{damage:?} of line {line_number}: {found}\n{text}"
        );
        let key = lines[number].split(" = ").next().unwrap_or_default();
        let named = found.contains(key) || matches!(damage, Damage::NoToml | Damage::Twice | Damage::Deep);
        let named = named || found.contains("zq") || damage == Damage::Capitals;
        assert!(named, "{damage:?} of `{key}`: {found}");
    }
    assert!(counts.iter().all(|count| *count >= 10), "{counts:?}");
}

#[test]
fn a_choice_follows_an_earlier_one_of_as_many_points() {
    let areas = ["a", "b"]
        .map(|name| format!("[[objects]]\nname = \"{name}\"\nkind = \"disc\"\nradius = 0.1\ncolor = [0, 0, 0]\n"));
    let start = |place: &str, points: &str, like: &str| {
        format!("[[start]]\nplace = \"{place}\"\nat = \"one-of\"\npoints = {points}\n{like}")
    };
    let two = "[[0.2, 0.2], [0.8, 0.2]]";
    let text = |first: &str, like: &str| {
        [RIGHT, &areas.concat(), &start("a", first, ""), &start("b", two, &format!("like = \"{like}\"\n"))].concat()
    };
    assert_eq!(error(&text(two, "a")), "nothing is wrong");
    let before = |name: &str| format!("start.3.like: {name} has to be placed before, on one of some points");
    let counts = "start.3.like: a is placed on one of 1 points, and here are 2";
    for (text, why) in [
        (text("[[0.5, 0.5]]", "a"), counts.to_owned()),
        (text(two, "lamp"), before("lamp")),
        (text(two, "b"), before("b")),
        (text(two, "c"), before("c")),
    ] {
        let said = plain(&error(&text));
        assert!(said.starts_with("look.toml line ") && said.ends_with(&why), "{said}");
    }
    let robots = RIGHT.replace("kind = \"e-puck\"", "kind = \"e-puck\"\ncount = 2");
    let both = [robots.as_str(), &areas[0], &start("a", two, ""), &start("robot", two, "like = \"a\"\n")].concat();
    assert!(plain(&error(&both)).ends_with("start.3: puts 2 robots on one point"), "{}", error(&both));
}
