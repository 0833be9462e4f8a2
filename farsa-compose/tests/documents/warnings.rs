//! Warnings about a fitness that is the same for all individuals, with the line of the terms.

use farsa_compose::ComposedExperiment;
use farsa_lab::{Experiment as _, Settings};

fn warnings(rest: &str) -> Vec<String> {
    let text = format!(
        "robot = {{ kind = \"marxbot\" }}\n\
         sensors = [{{ kind = \"infrared\" }}, {{ name = \"still\", kind = \"constant\", value = 0.4 }}, \
         {{ name = \"noisy\", kind = \"constant\", value = 0.4, wrappers = [{{ kind = \"uniform-noise\", amplitude = 0.1 }}] }}]\n\
         network = {{ kind = \"perceptron\" }}\n\
         objects = [{{ name = \"post\", kind = \"cylinder\", radius = 0.05, at = [0.5, 0.5] }}, \
         {{ name = \"nest\", kind = \"disc\", radius = 0.2, color = [0, 0, 0], at = [0.3, 0.3] }}]\n\
         [[motors]]\nkind = \"wheels\"\n{rest}\n"
    );
    of_text(&text)
}

fn of_text(text: &str) -> Vec<String> {
    let made = ComposedExperiment::from_text("dull.toml", text, farsa_lab::strategy::strategies());
    let made = made.unwrap_or_else(|error| panic!("{error}\n{text}"));
    let evaluator = Settings::new(made.settings("")).and_then(|settings| made.prepare("", &settings));
    evaluator.unwrap_or_else(|error| panic!("{error}\n{text}")).info().warnings
}

#[test]
fn a_fitness_without_weights_is_warned_about() {
    let found = warnings("[[reward]]\nkind = \"forward\"\nweight = 0.0\n[[reward]]\nkind = \"touch\"\nweight = 0.0");
    assert_eq!(found, ["dull.toml line 9: no term has a weight, so the fitness of all individuals is 0"]);
    assert!(warnings("[[reward]]\nkind = \"forward\"\n[[reward]]\nkind = \"touch\"\nweight = 0.0").is_empty());
}

#[test]
fn a_fitness_that_cannot_differ_is_warned_about() {
    let why = "no term with a weight can differ, so all individuals have the same fitness";
    for (constant, differing) in [
        ("kind = \"steps\"", "kind = \"steps\"\n[[end]]\nterm = \"steps\"\nbelow = 0.5"),
        ("kind = \"steps\"", "kind = \"steps\"\n[episode]\nends = [\"collision\"]"),
        ("kind = \"time\"", "kind = \"time\"\n[[failure]]\nterm = \"time\"\nabove = 1"),
        ("kind = \"time-left\"\nrest = \"robot\"", "kind = \"speed\""),
        ("kind = \"speed\"\nclip = [0.5, 0.5]", "kind = \"speed\"\nclip = [0.0, 0.5]"),
        (
            "kind = \"moved\"\nobject = \"post\"",
            "kind = \"moved\"\nobject = \"post\"\n[[motors]]\nkind = \"attachment\"",
        ),
        ("formula = \"2 * time + exp(0) * 1 s\"", "formula = \"time * max(infrared)\""),
        ("kind = \"held\"", "kind = \"held\"\n[[motors]]\nkind = \"attachment\""),
        ("kind = \"sensor\"\nsensor = \"still\"", "kind = \"sensor\"\nsensor = \"infrared\""),
        ("kind = \"clusters\"", "kind = \"gap\"\nobject = \"post\""),
        (
            "kind = \"held\"\n[[motors]]\nkind = \"attachment\"\nenabled = false",
            "kind = \"held\"\n[[motors]]\nkind = \"leds\"\ncolors = [\"red\"]\n[[motors]]\nkind = \"attachment\"",
        ),
        ("kind = \"sensor\"\nsensor = \"still\"\nweight = 2", "kind = \"sensor\"\nsensor = \"noisy\""),
        (
            "kind = \"alive\"\n[foraging]\nnest = \"nest\"\ncells = 3",
            "kind = \"alive\"\n[foraging]\nnest = \"nest\"\ncost = 0.1",
        ),
        (
            "kind = \"carried-food\"\n[foraging]\nnest = \"nest\"\ncost = 0.1",
            "kind = \"carried-food\"\n[foraging]\nnest = \"nest\"\ncells = 3",
        ),
        (
            "kind = \"lost-food\"\n[foraging]\nnest = \"nest\"\ncost = 0.1",
            "kind = \"steps\"\n[[reward]]\nkind = \"speed\"\nweight = 0.1",
        ),
        ("kind = \"near-others\"", "kind = \"displacement\""),
        ("kind = \"dispersion\"", "kind = \"touch\""),
        ("kind = \"largest-cluster\"", "kind = \"effort\""),
        (
            "kind = \"energy\"\n[foraging]\nnest = \"nest\"",
            "kind = \"energy\"\n[foraging]\nnest = \"nest\"\ncost = 0.1",
        ),
        (
            "kind = \"deaths\"\n[foraging]\nnest = \"nest\"",
            "kind = \"deaths\"\n[foraging]\nnest = \"nest\"\ncost = 0.1",
        ),
        (
            "kind = \"food\"\n[foraging]\nnest = \"nest\"\ncost = 0.1",
            "kind = \"food\"\n[foraging]\nnest = \"nest\"\ncells = 3",
        ),
        (
            "kind = \"lost-food\"\n[foraging]\nnest = \"nest\"\ncells = 3",
            "kind = \"lost-food\"\n[foraging]\nnest = \"nest\"\ncells = 3\ncost = 0.1",
        ),
        (
            "kind = \"steps\"\n[[reward]]\nkind = \"time\"\nduring = \"steps\"",
            "name = \"met\"\nkind = \"touch\"\nweight = 0.0\n[[reward]]\nkind = \"time\"\nduring = \"met\"",
        ),
    ] {
        assert_eq!(warnings(&format!("[[reward]]\n{constant}")), [format!("dull.toml line 7: {why}")], "{constant}");
        assert!(warnings(&format!("[[reward]]\n{differing}")).is_empty(), "{differing}");
    }
}

/// Robots of a team move relative to each other, and balls are pushed.
#[test]
fn terms_of_teams_and_balls_can_differ() {
    for kind in ["near-others", "dispersion", "clusters", "largest-cluster"] {
        for (count, constant) in [(1, true), (2, false)] {
            let text = format!(
                "robot = {{ kind = \"e-puck\", count = {count} }}\nsensors = [{{ kind = \"touch\" }}]\n\
                 motors = [{{ kind = \"wheels\" }}]\nnetwork = {{ kind = \"perceptron\" }}\nreward = [{{ kind = \"{kind}\" }}]\n"
            );
            assert_eq!(of_text(&text).len(), usize::from(constant), "{kind} of {count}");
        }
    }
    for (object, constant) in [
        ("kind = \"ball\", radius = 0.1, mass = 1.0", false),
        ("kind = \"block\", size = [0.1, 0.1, 0.1], mass = 1.0", false),
        ("kind = \"marker\"", true),
    ] {
        let text = format!(
            "world = {{ engine = \"articulated\" }}\nrobot = {{ kind = \"arm-and-hand\" }}\nsensors = [{{ kind = \"joint-speed\" }}]\n\
             motors = [{{ kind = \"muscles\" }}]\nnetwork = {{ kind = \"perceptron\" }}\n\
             objects = [{{ name = \"thing\", at = [3.0, 0.0, 1.0], {object} }}]\nreward = [{{ kind = \"moved\", object = \"thing\" }}]\n"
        );
        assert_eq!(of_text(&text).len(), usize::from(constant), "{object}");
    }
}
