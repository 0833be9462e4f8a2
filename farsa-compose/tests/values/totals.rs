//! Totals of terms over steps and trials, conditions, and their combination into the fitness.

use farsa_lab::{EpisodeId, Evaluation, Experiment as _, Note, Outcome, Settings};

use crate::wheels::{LAMP, NOTHING, OUTPUTS, TIME_STEP, file, step};
use crate::{Trial, all_close, close, distance, made};

/// Time after a step [s].
fn time(number: usize) -> f64 {
    TIME_STEP * number as f64
}

fn far(number: usize) -> f64 {
    distance(step(number).at, LAMP)
}

/// Returns the note of a term that is only measured.
fn note(outcome: &Outcome, name: &str) -> f64 {
    match outcome.notes.iter().find(|(note, _)| *note == name) {
        Some((_, Note::Number(value))) => *value,
        other => panic!("{name}: {other:?} of {outcome:?}"),
    }
}

const TERMS: &str = "[[reward]]\nname = \"mean\"\nkind = \"time\"\nweight = 2.5\n\
    [[reward]]\nname = \"sum\"\nkind = \"time\"\nover = \"sum\"\nweight = -0.7\n\
    [[reward]]\nname = \"end\"\nkind = \"time\"\nover = \"end\"\nweight = 0.3\n\
    [[reward]]\nname = \"most\"\nkind = \"distance\"\nobject = \"lamp\"\nover = \"most\"\nweight = 1.7\n\
    [[reward]]\nname = \"low\"\nkind = \"distance\"\nobject = \"lamp\"\nclip = [-9.0, 0.15]\nover = \"sum\"\n\
    [[reward]]\nname = \"high\"\nkind = \"distance\"\nobject = \"lamp\"\nclip = [0.15, 9.0]\nover = \"sum\"\n\
    [[reward]]\nname = \"within\"\nkind = \"near\"\nobject = \"lamp\"\nwithin = 0.09\n\
    [[reward]]\nname = \"during\"\nkind = \"time\"\nover = \"sum\"\nduring = \"within\"\n\
    [[reward]]\nname = \"most-during\"\nkind = \"time\"\nover = \"most\"\nduring = \"within\"\n\
    [[reward]]\nname = \"never\"\nkind = \"time\"\nover = \"most\"\nduring = \"nothing\"\n\
    [[reward]]\nname = \"looked\"\nkind = \"time\"\nover = \"sum\"\nweight = 0.0\n\
    [[reward]]\nname = \"named\"\nlabel = \"seconds\"\nkind = \"time\"\nweight = 0.0\n";

/// The term `nothing` before `never`: no sensor reads anything.
fn terms() -> String {
    let nothing = "[[reward]]\nname = \"nothing\"\nkind = \"touch\"\n";
    TERMS.replace("[[reward]]\nname = \"never\"", &format!("{nothing}[[reward]]\nname = \"never\""))
}

fn close_by(number: usize) -> bool {
    far(number) - 0.035 - 0.03 < 0.09
}

fn check(trial: &Trial, steps: usize) {
    let numbers = || 1..=steps;
    let sum: f64 = numbers().map(time).sum();
    let counted: Vec<usize> = numbers().filter(|number| close_by(*number)).collect();
    let wanted = [
        // A mean is divided by the 20 steps of the longest trial.
        2.5 * sum / 20.0,
        -0.7 * sum,
        0.3 * time(steps),
        1.7 * numbers().map(far).fold(0.0, f64::max),
        numbers().map(|number| far(number).min(0.15)).sum(),
        numbers().map(|number| far(number).max(0.15)).sum(),
        counted.len() as f64 / 20.0,
        counted.iter().map(|number| time(*number)).sum(),
        counted.last().map_or(0.0, |number| time(*number)),
        0.0,
        0.0,
    ];
    all_close(&trial.outcome.terms, &wanted, 2e-5, "terms");
    close(note(&trial.outcome, "measured looked"), sum, 1e-9, "a term without weight");
    close(note(&trial.outcome, "seconds"), sum / 20.0, 1e-9, "a term with a label");
    assert_eq!(trial.outcome.steps, steps as u32);
    let last = trial.column("fitness so far").last().copied().unwrap_or(f64::NAN);
    close(last, wanted.iter().sum(), 1e-4, "fitness of the trial");
}

#[test]
fn totals_are_means_sums_ends_and_largest_values() {
    let text = file(OUTPUTS, NOTHING, &terms());
    let counted = (1..=20).filter(|number| close_by(*number)).count();
    assert!((2..19).contains(&counted) && !close_by(1), "{counted} steps count");
    check(&Trial::new(&text), 20);
    // 0.16 n is above 1.9 from the twelfth step on.
    let ended = Trial::new(&format!("{text}[[end]]\nterm = \"mean\"\nabove = 1.9\n"));
    check(&ended, 12);
    assert!(!ended.outcome.success);
}

/// Conditions compare the last value of a term before its weight. All conditions of success have to hold.
#[test]
fn conditions_look_at_the_last_step() {
    let counted = "[[reward]]\nname = \"counted\"\nkind = \"steps\"\n";
    let trial =
        |conditions: &str| Trial::new(&file(OUTPUTS, NOTHING, &format!("{}{counted}{conditions}", terms()))).outcome;
    let one = |list: &str, range: &str| format!("[[{list}]]\nterm = \"mean\"\n{range}\n");
    // The time at the end is 3.2 s.
    for (conditions, success) in [
        (one("success", "above = 3.1"), true),
        (one("success", "above = 3.3"), false),
        (one("success", "below = 3.3"), true),
        (one("success", "below = 3.1"), false),
        (one("success", "above = 3.1\nbelow = 3.3"), true),
        (one("success", "above = 3.3\nbelow = 3.4"), false),
        // Ends do not count: the term `counted` is 1.
        ("[[success]]\nterm = \"counted\"\nabove = 1.0\n".into(), false),
        ("[[success]]\nterm = \"counted\"\nbelow = 1.0\n".into(), false),
        ("[[success]]\nterm = \"counted\"\nabove = 0.9\nbelow = 1.1\n".into(), true),
        (one("success", "above = 3.1") + &one("success", "below = 3.1"), false),
        (String::new(), false),
    ] {
        let found = trial(&conditions);
        assert_eq!((found.success, found.steps), (success, 20), "{conditions}");
    }
    // A failure ends the trial and is no success. Any of several ends it.
    let failed =
        trial(&(one("success", "above = 0.1") + &one("failure", "above = 9.0") + &one("failure", "above = 1.9")));
    assert_eq!((failed.success, failed.steps), (false, 12));
    let ended = trial(&(one("success", "above = 0.1") + &one("end", "above = 1.9")));
    assert_eq!((ended.success, ended.steps), (true, 12));
    // A trial may end by its success.
    let text = file(OUTPUTS, NOTHING, &format!("{}{}", terms(), one("success", "above = 1.9")));
    let ended = Trial::new(&text.replace("trials = 1", "trials = 1, ends = [\"success\"]")).outcome;
    assert_eq!((ended.success, ended.steps), (true, 12));
}

/// Three trials of two terms: 1 + 0.25, 3 - 0.5 and 2 + 4.
#[test]
fn trials_are_combined_by_mean_sum_or_worst() {
    let outcomes: Vec<Outcome> = [[1.0, 0.25], [3.0, -0.5], [2.0, 4.0]]
        .map(|terms| Outcome { terms: terms.to_vec(), steps: 20, ..Outcome::default() })
        .into();
    let two = "[[reward]]\nkind = \"time\"\n[[reward]]\nkind = \"steps\"\nweight = -2.0\n";
    let fitness = |table: &str| {
        let evaluator = made(&file(OUTPUTS, NOTHING, &format!("{two}[fitness]\n{table}"))).expect("an evaluator");
        evaluator.fitness(&outcomes)
    };
    close(fitness(""), (1.25 + 2.5 + 6.0) / 3.0, 1e-12, "mean");
    close(fitness("trials = \"sum\"\n"), 1.25 + 2.5 + 6.0, 1e-12, "sum");
    close(fitness("trials = \"worst\"\n"), 1.25, 1e-12, "worst");
    close(fitness("product = true\n"), (0.25 - 1.5 + 8.0) / 3.0, 1e-12, "mean of products");
    close(fitness("product = true\ntrials = \"sum\"\n"), 0.25 - 1.5 + 8.0, 1e-12, "sum of products");
    close(fitness("product = true\ntrials = \"worst\"\n"), -1.5, 1e-12, "worst product");
    let text = file(OUTPUTS, NOTHING, &format!("{two}[fitness]\nproduct = true\n"));
    let last = Trial::new(&text).column("fitness so far")[19];
    // The mean time is 0.16 * 210 / 20.
    close(last, 0.16 * 210.0 / 20.0 * -2.0, 1e-9, "product of a trial");
}

/// Objectives and measures are means over trials, before the weights. A cost has the other sign.
#[test]
fn behaviors_are_means_of_trials() {
    let terms = "[[reward]]\nname = \"late\"\nkind = \"time\"\nover = \"end\"\nweight = 5.0\n\
        [[reward]]\nname = \"far\"\nkind = \"distance\"\nobject = \"lamp\"\nover = \"end\"\nweight = -3.0\n\
        [behaviour]\nobjectives = [{ term = \"late\", less = true }, { term = \"far\" }]\n\
        descriptors = [{ term = \"far\", range = [0.1, 0.9] }]\n";
    let evaluator = made(&file(OUTPUTS, NOTHING, terms)).expect("an evaluator");
    let behavior = evaluator.behavior().expect("a behavior");
    assert_eq!(behavior.objectives(), ["minus late", "far"]);
    let notes = |late: f64, far: f64| Outcome {
        notes: vec![("measured late", Note::from(late)), ("measured far", Note::from(far))],
        ..Outcome::default()
    };
    let found = behavior.describe(&[notes(3.0, 0.5), notes(4.0, 0.2), notes(8.0, 0.8)]);
    all_close(&found, &[-5.0, 0.5, 0.5], 1e-12, "described");
    let trial = Trial::new(&file(OUTPUTS, NOTHING, terms));
    close(note(&trial.outcome, "measured far"), far(20), 1e-5, "far");
    close(note(&trial.outcome, "measured late"), 3.2, 1e-9, "late");
}

/// A term with `of` is earned in trials in which its group evolves, and one without it by the evolving group alone.
#[test]
fn groups_that_evolve_earn_their_own_terms() {
    let text = "world = { size = [3.1, 2.3] }\nteam = { coevolution = true }\n\
        robots = [{ name = \"hunters\", kind = \"e-puck\", count = 2 }, { name = \"prey\", kind = \"e-puck\" }]\n\
        sensors = [{ kind = \"constant\", value = 1.0 }]\nmotors = [{ kind = \"wheels\" }]\n\
        network = { kind = \"perceptron\" }\nepisode = { steps = 2, trials = 1 }\n\
        reward = [{ name = \"x\", kind = \"position\", along = [1, 0, 0], over = \"end\" }, \
        { name = \"of-prey\", kind = \"position\", along = [1, 0, 0], of = \"prey\", over = \"end\" }, \
        { name = \"second\", kind = \"position\", along = [1, 0, 0], robot = 2, over = \"end\" }]\n\
        start = [{ place = \"robot-1\", at = \"fixed\", point = [0.3, 0.5] }, \
        { place = \"robot-2\", at = \"fixed\", point = [0.9, 1.5] }, { place = \"prey\", at = \"fixed\", point = [2.5, 1.1] }]\n\
        success = [{ term = \"x\", of = \"hunters\", below = 0.7 }, { term = \"x\", of = \"prey\", above = 2.6 }]\n";
    let strategies = farsa_lab::strategy::strategies();
    let made = farsa_compose::ComposedExperiment::from_text("values.toml", text, strategies).expect("an experiment");
    let mut settings = made.settings("");
    settings.push(farsa_lab::Setting::whole("evolution.population", 4, 1..=100));
    let mut evaluator = Settings::new(settings).and_then(|settings| made.prepare("", &settings)).expect("an evaluator");
    // All wheels rest at 1/2.
    let still = vec![0.0; evaluator.info().parameters.len()];
    let opponents = [&still[..]];
    for (individual, wanted, success) in [(1, [0.6, 0.0, 0.9], true), (5, [2.5, 2.5, 0.0], false)] {
        let id = EpisodeId { individual, ..EpisodeId::default() };
        let evaluation = Evaluation { opponents: &opponents, ..Evaluation::new(&still, id) };
        let outcome = evaluator.evaluate(evaluation, None);
        all_close(&outcome.terms, &wanted, 1e-6, &format!("individual {individual}"));
        assert_eq!(outcome.success, success, "individual {individual}");
    }
}

/// The value that is not finite has the place of its term, so that messages name this term.
#[test]
fn a_failed_trial_has_the_value_of_the_term_that_failed() {
    for (formula, wanted) in
        [("0 / 0", f64::NAN), ("1 / 0", f64::INFINITY), ("if(step > 3, -1 / 0, 1)", f64::NEG_INFINITY)]
    {
        let text = format!(
            r#"
robot = {{ kind = "e-puck" }}
sensors = [{{ kind = "constant", value = 0.0 }}]
motors = [{{ kind = "wheels" }}]
network = {{ kind = "wired", bias = [0.5, 0.5], wires = [] }}
episode = {{ steps = 5, trials = 1 }}
reward = [{{ kind = "touch" }}, {{ kind = "steps", weight = 0.0 }}, {{ formula = "{formula}", name = "broken" }}]
"#
        );
        let mut evaluator = made(&text).unwrap_or_else(|error| panic!("{error}"));
        let parameters = vec![0.0; evaluator.info().parameters.len()];
        let outcome = evaluator.evaluate(Evaluation::new(&parameters, EpisodeId::default()), None);
        assert_eq!(evaluator.info().terms, ["touch", "broken"]);
        assert!(!outcome.is_finite() && outcome.terms[0] == 0.0, "{outcome:?}");
        assert_eq!(outcome.terms[1].to_bits() << 1, wanted.to_bits() << 1, "{outcome:?}");
    }
}
