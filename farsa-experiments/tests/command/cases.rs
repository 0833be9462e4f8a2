//! Single cases of a test protocol are replayed and drawn as the test ran them.

use std::fs;

use crate::tool::{farsa, ok, own, say, scratch};

#[test]
fn a_case_is_replayed_as_it_was_tested() {
    let here = scratch("cases");
    let short = "run reach-grasp-lift --population 4 --set evolution.parents=2 --set trial.steps=10 --generations 1";
    ok(farsa(), &here, &format!("{short} --out arm --quiet"));
    ok(farsa(), &here, "test arm --protocol labels --trials 2 --seed 5 --quiet");
    let table = fs::read_to_string(here.join("arm/protocols/labels.csv")).expect("the table");
    // Trial 1 of the second case: its row, steps, success and fitness.
    let tested: Vec<&str> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>())
        .fold(Vec::new(), |found, line| if line[0] == "1" && line[4] == "1" { line } else { found });
    let (row, steps, success, fitness) = (tested[1], tested[6], tested[7], tested[8]);
    let chosen = "replay arm --protocol labels --trial 1 --seed 5";

    let said = say(farsa(), &here, &format!("{chosen} --case 1 --out steps.csv --json"));
    assert_eq!(said.code, Some(0), "{said:?}");
    let found: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
    let case = &found["cases"][0];
    assert_eq!((case["row"].as_str(), found["trial"].as_u64()), (Some(row), Some(1)));
    assert_eq!((case["steps"].to_string(), case["success"].to_string()), (steps.to_owned(), success.to_owned()));
    let earned = case["fitness"].as_f64().expect("a number");
    assert_eq!(earned.to_bits(), fitness.parse::<f64>().expect("a number").to_bits());
    let by_number = fs::read_to_string(here.join("steps.csv")).expect("the steps");
    assert_eq!(by_number.lines().count() - 1, steps.parse::<usize>().expect("a number"));
    assert!(by_number.lines().skip(1).all(|line| line.starts_with("1,")), "{by_number}");
    // By its name on the standard output, the same bytes. Another case and another seed are others.
    let with = |rest: &str| say(farsa(), &here, &format!("{chosen} {rest} --quiet"));
    assert_eq!(with(&format!("--case {row}")).out, by_number);
    assert_ne!(with("--case 0").out, by_number);
    assert_ne!(say(farsa(), &here, "replay arm --protocol labels --trial 1 --case 1 --quiet").out, by_number);

    // A page of all cases, next to those of another run.
    ok(farsa(), &here, &format!("{short} --seed 2 --out other --quiet"));
    let said = say(farsa(), &here, &format!("{chosen} --html cases.html --compare other"));
    assert_eq!((said.code, said.out.as_str()), (Some(0), ""), "{said:?}");
    assert_eq!(said.err.matches("trial 1, test seed 5").count(), 2, "{said:?}");
    assert_eq!(said.err.matches(&format!("\n{row}: ")).count(), 2, "{said:?}");
    assert!(fs::read_to_string(here.join("cases.html")).expect("the page").contains(&format!("{row}: ")));
    let said = ok(farsa(), &here, "draw arm --protocol labels --case 2 --case 0 --size 120x90 --out two.svg");
    assert!(said.contains(": 2 cases"), "{said}");
    assert_eq!(fs::read_to_string(here.join("two.svg")).expect("the sheet").matches("<svg").count(), 1 + 2);

    ok(own(), &here, "run cart --generations 1 --out cart --quiet");
    for (program, arguments, words) in [
        (farsa(), format!("{chosen} --case 3 --html new.html"), "whose cases are numbered 0 to 2"),
        (farsa(), format!("{chosen} --case {row}s --html new.html"), "the nearest is"),
        (farsa(), format!("{chosen} --out new.csv"), "3 cases of protocol `labels`: steps are written of one"),
        (farsa(), format!("{chosen} --generation 0 --html new.html"), "cannot be used with"),
        (
            farsa(),
            "replay arm --protocol labels --trial best --html new.html".into(),
            "a case of a protocol needs the number of a trial",
        ),
        (farsa(), "replay arm --case 1 --html new.html".into(), "--protocol"),
        (farsa(), "replay arm --seed 1 --html new.html".into(), "--protocol"),
        (farsa(), "replay arm --protocol label --html new.html".into(), "the nearest is `labels`"),
        (own(), "replay cart --protocol labels --html new.html".into(), "has none"),
    ] {
        let said = say(program, &here, &arguments);
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{arguments}: {said:?}");
        assert!(said.err.contains(words), "{arguments}: {said:?}");
    }
    assert!(!here.join("new.csv").exists() && !here.join("new.html").exists());
}
