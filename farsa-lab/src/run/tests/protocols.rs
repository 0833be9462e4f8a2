//! Tests of champions by protocols: what is evaluated, written, read back, refused and reported.

use std::fs;

use super::*;
use crate::evaluation::protocols::files;
use crate::evaluation::protocols::states::States;
use crate::evaluation::protocols::test::{ProtocolRun, TestOptions, lesions, test};
use crate::evaluation::test as plain_test;
use crate::experiment::intervention::Intervention;
use crate::experiment::protocol::{Case, CaseId, Protocol};
use crate::experiment::{Anatomy, Rescored};

/// Returns its case and its random numbers as terms. `MOVE red` always fails, as do all cases of `none`.
#[derive(Clone, Copy)]
struct Words {
    populations: usize,
    /// The fault of its protocols.
    wrong: bool,
}

const WORDS: Words = Words { populations: 1, wrong: false };

impl Experiment for Words {
    fn name(&self) -> &'static str {
        "words"
    }
    fn summary(&self) -> &'static str {
        "tells its case"
    }
    fn strategy(&self, _: &str) -> &'static dyn StrategyDefinition {
        &Truncation
    }
    fn settings(&self, _: &str) -> Vec<Setting> {
        let size = i64::try_from(SIZE).unwrap();
        vec![Setting::whole(POPULATION, size, 1..=100), Setting::whole("evolution.parents", 2, 1..=100)]
    }
    fn prepare(&self, _: &str, _: &Settings) -> Result<Box<dyn Evaluator>, Error> {
        // A wrapper has the protocols of what it wraps.
        Ok(Box::new(Rescored::new(Box::new(*self), ["case", "start"], |outcome| outcome.terms.clone())))
    }
    fn gene_bits(&self) -> u32 {
        8
    }
}

impl Words {
    fn schema() -> Schema {
        let neurons = ["sensory", "inner 1", "inner 2"].map(farsa_view::Channel::new).into();
        Schema { neurons, ..Schema::from_scalars(["gene"]) }.with_sensors(["ear"])
    }

    fn protocols(&self) -> Vec<Protocol> {
        let words = Protocol::from_table("words", "two <words>", ["TOUCH", "MOVE"], ["red", "green"])
            .with_axes("action", "object")
            .with_held_out(|row, column| row == "TOUCH" && column == "green")
            .with_states(1..3)
            .with_trials(4);
        let times =
            Protocol::from_list("times", "ever later", ["0 s", "2 s", "4 s"]).with_axes("time", "").with_trials(4);
        let none = Protocol::new("none", "breaks down").with_case(Case::new("always", "")).with_trials(2);
        let twice = words.clone();
        [words, none, times].into_iter().chain(self.wrong.then_some(twice)).collect()
    }
}

impl Task for Words {
    fn info(&self) -> TaskInfo {
        TaskInfo {
            trials: TRIALS as usize,
            terms: vec!["case".into(), "start".into()],
            populations: (0..self.populations).map(|population| population.to_string()).collect(),
            protocols: self.protocols(),
            anatomy: Some(Anatomy::new(&Self::schema(), &Description::default())),
            ..TaskInfo::new(vec![Parameter::new("only", [0.0, 255.0])], Self::schema())
        }
    }
}

impl Evaluator for Words {
    fn evaluate(&mut self, evaluation: Evaluation<'_>, recorder: Option<&mut dyn Recorder>) -> Outcome {
        let Evaluation { id, case, intervention, .. } = evaluation;
        let held = |change: &Intervention| (10 * change.lesions.len() + change.inputs.len()) as f64;
        let case = match case {
            None => 100.0 + intervention.map_or(0.0, held),
            Some(CaseId { protocol: 0, case }) => case as f64,
            // At 0 s always, at 2 s in one trial of three, at 4 s never.
            Some(CaseId { protocol: 2, case }) => {
                if case as u32 + id.trial < 2 {
                    1.0
                } else {
                    2.0
                }
            }
            Some(_) => return Outcome::failed(),
        };
        let start = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation).uniform_f64();
        if let Some(recorder) = recorder {
            for step in 0..7_u8 {
                recorder.neurons(&[9.0, case as f32, f32::from(step) * (1.0 + id.trial as f32)]);
                recorder.tick(f64::from(step));
            }
        }
        let notes = vec![("way", (2.0 * case).into()), ("population", id.population(SIZE).to_string().as_str().into())];
        Outcome { terms: vec![case, start], steps: 7, success: case != 2.0, notes, ..Outcome::default() }
    }
}

const EFFORT: TestOptions = TestOptions { trials: None, seed: 3, threads: 1, lanes: LaneRequest::ONE, quiet: true };

fn words_plan(words: &Words) -> Plan<'_> {
    let mut plan = Plan::new(words, None, "").unwrap();
    plan.settings.set("", GENERATIONS_KEY, Value::Whole(2)).unwrap();
    plan
}

fn evolved(words: &Words, root: &std::path::Path) -> Directory {
    let directory = create(&words_plan(words), root).unwrap();
    run(&words_plan(words), &directory, 1);
    directory
}

fn tested(words: &Words, directory: &Directory, name: &str, threads: usize) -> Result<ProtocolRun, Error> {
    test(&words_plan(words), directory, name, TestOptions { threads, ..EFFORT })
}

#[test]
fn a_controller_is_changed_in_every_case_and_nothing_is_written() {
    let root = scratch("lesions");
    let directory = evolved(&WORDS, &root);
    let effort = TestOptions { trials: Some(3), ..EFFORT };
    let found = |name, lists: &[&str], effort| {
        let lists: Vec<String> = lists.iter().map(|&list| list.to_owned()).collect();
        lesions(&words_plan(&WORDS), &directory, name, &lists, effort)
    };
    let text = found(None, &["neuron:inner 1", "sensor:ear=0.25,noise:0.5"], effort).unwrap().text();
    // The toy reports its interventions.
    let rows = text.lines().skip(3).map(|line| line.split_whitespace().rev().nth(3).unwrap_or_default());
    assert_eq!(rows.collect::<Vec<_>>(), ["case", "100.0", "110.0", "101.0"], "{text}");
    assert!(text.starts_with("lesion: with these parts of the controller changed\n"), "{text}");
    let text = found(Some("words"), &["neuron:inner 2"], effort).unwrap().text();
    assert!(text.starts_with("words: two <words>; with neuron:inner 2\n"), "{text}");
    assert!(!root.join("protocols").exists());
    for (name, lists, why) in [
        (Some("words"), &["neuron:inner 1", "noise:1"][..], "--lesion: 2 lists where protocol `words` takes one"),
        (Some("word"), &["neuron:inner 1"], "unknown test protocol `word`; the nearest is `words`"),
        (None, &["neuron:inner"], "unknown neuron `inner`; the nearest is `inner 1`"),
    ] {
        let error = found(name, lists, effort).unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    }
    let many = found(None, &["noise:1"], TestOptions { trials: Some(50_000_001), ..EFFORT }).unwrap_err().to_string();
    assert!(many.contains("50000001 trials of each of 2 cases are more than 100000000 trials"), "{many}");

    // An experiment without a controller is refused.
    let plan = plan(&STEADY, 2);
    let root = scratch("lesions-of-none");
    let directory = create(&plan, &root).unwrap();
    run(&plan, &directory, 1);
    let error = lesions(&plan, &directory, None, &["neuron:1".into()], effort).unwrap_err().to_string();
    assert!(error.contains("has no controller that can be changed"), "{error}");
}

#[test]
fn every_case_is_told_and_has_the_starts_of_a_plain_test() {
    let root = scratch("protocols");
    let directory = evolved(&WORDS, &root);
    let text = tested(&WORDS, &directory, "words", 1).unwrap().text();
    assert!(text.contains("TOUCH   green   held out       4        4  100.0 %"), "{text}");
    assert!(text.contains("MOVE    red     trained        4        0    0.0 %"), "{text}");
    assert!(text.contains("held out: 4 of 4 (100.0 %)\n") && text.contains("trained: 8 of 12 (66.7 %)"), "{text}");
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap();
    let csv = read("protocols/words.csv");
    let json = read("protocols/words.json");
    for threads in [2, 3] {
        tested(&WORDS, &directory, "words", threads).unwrap();
        assert_eq!((read("protocols/words.csv"), read("protocols/words.json")), (csv.clone(), json.clone()));
    }
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        lines[0].join(","),
        "case,row,column,held_out,index,trial,steps,success,fitness,case,start,way,population"
    );
    assert_eq!(lines.len(), 1 + 4 * 4);
    plain_test::test(&words_plan(&WORDS), &directory, None, 4, 3, 1, LaneRequest::ONE, true).unwrap();
    let plain = read("test.csv");
    let starts: Vec<&str> = plain.lines().skip(1).map(|line| line.split(',').nth(6).unwrap()).collect();
    for (number, line) in lines[1..].iter().enumerate() {
        let (case, trial) = (number / 4, number % 4);
        assert_eq!(
            (line[0], line[9], line[11]),
            (&*case.to_string(), &*format!("{case}.0"), &*format!("{}.0", 2 * case))
        );
        assert_eq!((line[4], line[5]), (&*trial.to_string(), &*(trial % 3).to_string()));
        // All cases have the same starts, and they are those of the plain test, which has no case.
        assert_eq!(line[10], starts[trial], "case {case}, trial {trial}");
    }
    assert!(starts[0] != starts[3] && plain.lines().skip(1).all(|line| line.contains(",100.0,")), "{plain}");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn champions_of_several_populations_meet_in_every_case() {
    let root = scratch("protocols-populations");
    let words = Words { populations: 2, ..WORDS };
    let directory = evolved(&words, &root);
    let text = tested(&words, &directory, "words", 2).unwrap().text();
    assert!(text.contains("against each other, 4 trials a case"), "{text}");
    let csv = fs::read_to_string(root.join("protocols/words.csv")).unwrap();
    assert!(csv.lines().next().unwrap().ends_with(",fitness of population 1,success of population 1"), "{csv}");
    for line in csv.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        // Both have the same case and the same start.
        assert_eq!((fields[8], fields[12]), (fields[13], "0"), "{line}");
    }
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn what_cannot_be_tested_is_refused() {
    let root = scratch("protocols-refused");
    let directory = evolved(&WORDS, &root);
    let refused = |found: Result<ProtocolRun, Error>| found.unwrap_err().to_string();
    let error = tested(&WORDS, &directory, "wrods", 1).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let error = error.to_string();
    assert!(error.contains("unknown test protocol `wrods`; the nearest is `words`"), "{error}");
    assert!(error.contains("experiment `words`, which has words, none, times: "), "{error}");
    assert!(!root.join("protocols").exists());
    let error = refused(tested(&Words { wrong: true, ..WORDS }, &directory, "words", 1));
    assert!(error.contains("`words` is there twice"), "{error}");
    let many = test(&words_plan(&WORDS), &directory, "words", TestOptions { trials: Some(25_000_001), ..EFFORT });
    let error = refused(many);
    assert!(error.contains("25000001 trials of each of 4 cases are more than 100000000"), "{error}");
    // An untrusted file, or a link to another folder.
    fs::write(root.join("protocols"), "x").unwrap();
    let error = refused(tested(&WORDS, &directory, "words", 1));
    assert!(error.contains("protocols: is not a directory"), "{error}");
    #[cfg(unix)]
    {
        fs::remove_file(root.join("protocols")).unwrap();
        std::os::unix::fs::symlink(std::env::temp_dir(), root.join("protocols")).unwrap();
        assert!(refused(tested(&WORDS, &directory, "words", 1)).contains("is not a directory"));
    }
    fs::remove_file(root.join("protocols")).unwrap();
    // Failed trials are counted, and the first is explained.
    let text = tested(&WORDS, &directory, "none", 1).unwrap().text();
    assert!(
        text.contains("always       2            2        –     –") && text.contains("line 0 of the test failed"),
        "{text}"
    );
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn damaged_results_are_refused_and_those_without_a_record_are_read() {
    let root = scratch("protocols-damaged");
    let directory = evolved(&WORDS, &root);
    assert!(files::read(&directory, "words").unwrap().is_none());
    tested(&WORDS, &directory, "words", 1).unwrap();
    let (table, record) = files::read(&directory, "words").unwrap().unwrap();
    let record = record.unwrap();
    assert_eq!((table.cases.len(), record.trials, record.seed, record.generation), (4, 4, 3, 1));
    let [csv, json] = ["csv", "json"].map(|end| root.join(format!("protocols/words.{end}")));
    let (good, said) = (fs::read_to_string(&csv).unwrap(), fs::read_to_string(&json).unwrap());
    // The record of another table.
    fs::write(&csv, good.replace("7,true", "8,true")).unwrap();
    assert!(files::read(&directory, "words").unwrap().unwrap().1.is_none());
    fs::write(&csv, &good[..good.len() / 2]).unwrap();
    assert!(matches!(files::read(&directory, "words"), Err(Error::File { .. })));
    fs::write(&csv, &good).unwrap();
    for bad in ["{", "{\"protocol\":1}", &said.replace("\"words\"", "\"other\"")] {
        fs::write(&json, bad).unwrap();
        assert!(matches!(files::read(&directory, "words"), Err(Error::File { .. })), "{bad}");
    }
    fs::remove_file(&json).unwrap();
    assert!(files::read(&directory, "words").unwrap().unwrap().1.is_none());
    // The table replaces the old one.
    tested(&WORDS, &directory, "words", 2).unwrap();
    assert_eq!((fs::read_to_string(&csv).unwrap(), fs::read_to_string(&json).unwrap()), (good, said));
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn the_states_of_the_first_trials_are_recorded_case_by_case() {
    let root = scratch("protocols-states");
    let directory = evolved(&WORDS, &root);
    assert!(States::read(&directory, "words").unwrap().is_none());
    tested(&WORDS, &directory, "words", 1).unwrap();
    let (states, record) = States::read(&directory, "words").unwrap().unwrap();
    assert_eq!((states.neurons.join(", "), states.trials.len()), ("inner 1, inner 2".into(), 4 * 4));
    for (number, trial) in states.trials.iter().enumerate() {
        let (case, kind) = (number / 4, number % 4 % 3);
        assert_eq!((trial.case, trial.trial, trial.success), (case, number % 4, case != 2));
        let expected = (0..7_u8).map(|step| (u32::from(step), vec![case as f32, f32::from(step) * (1 + kind) as f32]));
        assert_eq!(trial.steps, expected.collect::<Vec<_>>());
    }
    let (_, of_table) = files::read(&directory, "words").unwrap().unwrap();
    assert!(record.unwrap().same_test(&of_table.unwrap()));
    // A test of other trials has no states of this one, and neither has a protocol without states.
    test(&words_plan(&WORDS), &directory, "words", TestOptions { trials: Some(1), seed: 4, ..EFFORT }).unwrap();
    assert_eq!(States::read(&directory, "words").unwrap().unwrap().0.trials.len(), 4);
    tested(&WORDS, &directory, "times", 1).unwrap();
    assert!(!root.join("protocols/times.states.csv").exists());
    let table = root.join("protocols/words.states.csv");
    let text = fs::read_to_string(&table).unwrap();
    fs::write(&table, text.replace("0,0,", "zero,0,")).unwrap();
    assert!(matches!(States::read(&directory, "words"), Err(Error::File { .. })));
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_report_shows_what_protocols_found() {
    let root = scratch("protocols-report");
    let directories = [11, 12].map(|seed| {
        let mut plan = words_plan(&WORDS);
        plan.seed = seed;
        let directory = create(&plan, &root.join(seed.to_string())).unwrap();
        run(&plan, &directory, 1);
        directory
    });
    for (directory, seed, name) in
        [(0, 11, "words"), (1, 12, "words"), (0, 11, "none"), (0, 11, "times"), (1, 12, "times")]
    {
        let mut plan = words_plan(&WORDS);
        plan.seed = seed;
        test(&plan, &directories[directory], name, EFFORT).unwrap();
    }
    let report = |runs: &[&Directory], name: &str| {
        let plans = runs.iter().zip(11..).map(|(directory, seed)| {
            let mut plan = words_plan(&WORDS);
            plan.seed = seed;
            ((*directory).clone(), plan)
        });
        let path = root.join(name);
        crate::report::write::report(plans.collect(), Some(&path), Some(&path.with_extension("md")), None, "farsa")
            .unwrap();
        fs::read_to_string(path).unwrap()
    };
    let one = report(&[&directories[0]], "one.html");
    let pieces =
        ["Test protocol words", "Test protocol none", "two &lt;words&gt;. Every case", "4 of 4", "0 of 4", "held out"];
    for piece in pieces.into_iter().chain(["11: the champion of generation 1.", "--protocol words --trials 4 --seed 3"])
    {
        assert!(one.contains(piece), "no {piece}");
    }
    assert!(!one.contains("<words>"));
    // The protocols are in Markdown, too, with their pictures.
    assert!(fs::read_to_string(root.join("one-protocol-1.svg")).unwrap().contains("words: success"));
    assert!(fs::read_to_string(root.join("one-protocol-2.svg")).unwrap().contains("none: success"));
    // States on their components, and shares over a number: of 4, 2 and 0 successes 2 are half.
    let states = fs::read_to_string(root.join("one-states-1.svg")).unwrap();
    assert!(states.contains("words: internal states") && states.matches("<use ").count() == 4, "{states}");
    assert!(one.contains("2 neurons, inner 1 to inner 2, in the first 4 trials of each case"));
    assert!(fs::read_to_string(root.join("one-rates-1.svg")).unwrap().contains("times: success"));
    assert!(one.contains("11: the share falls to half of its first value at 2.500 s."));
    let two = report(&[&directories[0], &directories[1]], "two.html");
    assert!(two.contains("words, 2 runs: the share falls to half") && two.matches("internal states").count() == 2);
    assert!(two.contains("Each of the 2 runs") && two.contains("TOUCH green, held out") && two.contains("100 to 100"));
    // Protocols that were not run are listed with their commands.
    assert!(!one.contains("that were not run"));
    assert!(two.contains("Test protocols that were not run") && two.contains("1 of 2 runs"), "{two}");
    assert!(two.contains("12 --protocol none"));
    fs::remove_dir_all(root).unwrap();
}
