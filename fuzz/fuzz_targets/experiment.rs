//! Files that describe experiments (TOML).
#![no_main]

use farsa_compose::ComposedExperiment;
use farsa_fuzz::{bounded_toml, limits};
use farsa_lab::Experiment as _;
use libfuzzer_sys::fuzz_target;

fn read(text: &str) -> Option<ComposedExperiment> {
    ComposedExperiment::from_text_within(limits(), "experiment.toml", text, farsa_lab::strategy::strategies()).ok()
}

farsa_fuzz::text!();

// The schema is made once, and is no part of what an input takes.
fuzz_target!(init: drop(read("")), |input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let Some(experiment) = bounded_toml(text, || read(text)) else { return };
    let kept = experiment.definition().expect("the text that a run keeps");
    let again = read(kept).expect("what a run keeps is read");
    assert_eq!(again.definition(), Some(kept));
    assert_eq!((again.summary(), again.conditions()), (experiment.summary(), experiment.conditions()));
    for condition in experiment.conditions() {
        let keys =
            |of: &ComposedExperiment| of.settings(condition).iter().map(|one| one.key().to_owned()).collect::<Vec<_>>();
        assert_eq!(keys(&again), keys(&experiment));
    }
});
