//! Warnings about a fitness that is the same for all individuals, with the line of the terms.

use farsa_compose::ComposedExperiment;
use farsa_lab::{Experiment as _, Settings};

fn warnings(rest: &str) -> Vec<String> {
    let text = format!(
        "robot = {{ kind = \"marxbot\" }}\n\
         sensors = [{{ kind = \"infrared\" }}, {{ name = \"still\", kind = \"constant\", value = 0.4 }}]\n\
         network = {{ kind = \"perceptron\" }}\n\
         objects = [{{ name = \"post\", kind = \"cylinder\", radius = 0.05, at = [0.5, 0.5] }}, \
         {{ name = \"nest\", kind = \"disc\", radius = 0.2, color = [0, 0, 0], at = [0.3, 0.3] }}]\n\
         [[motors]]\nkind = \"wheels\"\n{rest}\n"
    );
    let made = ComposedExperiment::from_text("dull.toml", &text, farsa_lab::strategy::strategies());
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
        ("kind = \"held\"", "kind = \"held\"\n[[motors]]\nkind = \"attachment\""),
        ("kind = \"sensor\"\nsensor = \"still\"", "kind = \"sensor\"\nsensor = \"infrared\""),
        ("kind = \"clusters\"", "kind = \"gap\"\nobject = \"post\""),
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
