//! The same bytes whatever the number of threads and however often a run is killed.

use std::fs;
use std::path::Path;

use farsa_num::Instructions;

use crate::tool::{Running, command, content, interruptible, ok, own, results, say, scratch};

#[test]
fn one_and_two_threads() {
    let here = scratch("threads");
    for threads in ["1", "2", "7"] {
        ok(own(), &here, &format!("run cart --generations 15 --threads {threads} --out t{threads}"));
    }
    let one = results(&here.join("t1"));
    assert_eq!(one, results(&here.join("t2")));
    assert_eq!(one, results(&here.join("t7")));
}

#[test]
fn more_generations_later_or_at_once() {
    let here = scratch("more");
    ok(own(), &here, "run cart --generations 9 --out once");
    ok(own(), &here, "run cart --generations 4 --out twice --threads 1");
    let said = say(own(), &here, "run --resume twice --generations 9 --threads 2");
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(!said.err.contains("generation 3:") && said.err.contains("generation 4:"), "{said:?}");
    assert_eq!(results(&here.join("once")), results(&here.join("twice")));
    // There is nothing left to do, and that is no mistake.
    assert!(ok(own(), &here, "run --resume twice").contains("all 9 generations are finished already"));
    assert_eq!(results(&here.join("once")), results(&here.join("twice")));
}

/// Trials long enough that a generation takes a few milliseconds.
const SLOW: &str = "run cart --set trial.steps=5000 --set cart.friction=5 --seed 2";

fn generations(run: &Path) -> usize {
    fs::read_to_string(run.join("fitness.csv")).map_or(0, |log| log.lines().count().saturating_sub(1))
}

#[test]
fn killed_and_resumed() {
    const LENGTH: usize = 1200;
    let here = scratch("killed");
    ok(own(), &here, &format!("{SLOW} --generations {LENGTH} --out whole"));
    let mut arguments: Vec<String> =
        format!("{SLOW} --generations {LENGTH} --out killed").split(' ').map(Into::into).collect();
    let run = here.join("killed");
    let mut gone_on_from = Vec::new();
    // Far enough apart that a checkpoint lies between two kills on any machine that takes a second for the whole.
    for wanted in [1, LENGTH / 2] {
        let mut killed = Running::start(&mut command(own(), &here, &arguments));
        killed.until("generation to be killed in", || generations(&run) >= wanted);
        drop(killed);
        gone_on_from.push(generations(&run));
        arguments = ["run", "--resume", "killed"].map(Into::into).into();
    }
    assert!(gone_on_from[1] < LENGTH, "killed too late to show anything");
    // A kill in the middle of a line.
    let mut log = fs::read(run.join("fitness.csv")).expect("the log");
    log.extend(b"777,0.1");
    fs::write(run.join("fitness.csv"), log).expect("the log");
    ok(own(), &here, "run --resume killed --threads 2");
    assert_eq!(results(&here.join("whole")), results(&run));
    assert!(content(&run).iter().all(|(path, _)| !path.to_string_lossy().contains(".new")));
}

#[cfg(unix)]
#[test]
fn interrupted_and_resumed() {
    let here = scratch("interrupted");
    ok(own(), &here, &format!("{SLOW} --generations 300 --out whole"));
    let arguments: Vec<&str> = SLOW.split(' ').chain(["--generations", "300", "--out", "stopped"]).collect();
    let run = here.join("stopped");
    let mut stopped = Running::start(&mut interruptible(own(), &here, &arguments));
    stopped.until("generation 20", || generations(&run) >= 20);
    stopped.signal("INT");
    let said = stopped.end();
    assert_eq!(said.code, Some(130), "{said:?}");
    assert!(said.err.contains("\ninterrupted; go on with `own-experiment run --resume stopped`"), "{said:?}");
    let kept = generations(&run);
    assert!((20..300).contains(&kept), "{kept}");
    // Nothing that was finished is evaluated again.
    let again = say(own(), &here, "run --resume stopped");
    assert_eq!(again.code, Some(0), "{again:?}");
    let first = again.err.lines().next().expect("a line");
    assert!(first.starts_with(&format!("generation {kept}: ")), "{first}");
    assert_eq!(results(&here.join("whole")), results(&run));
}

#[test]
fn lanes() {
    let here = scratch("lanes");
    let run = "run reach-grasp-lift --population 20 --set trial.steps=40 --seed 4 --generations 2";
    let farsa = crate::tool::farsa();
    let [avx2, avx512] = wide();
    let known = [("avx2", avx2), ("avx512", avx512), ("baseline", true), ("auto", true)];
    let mut runs = Vec::new();
    for (simd, _) in known.into_iter().filter(|(_, here)| *here) {
        for lanes in ["1", "8", "16", "auto"] {
            for threads in [1, 2] {
                let out = format!("{simd}-{lanes}-{threads}");
                ok(farsa, &here, &format!("{run} --lanes {lanes} --simd {simd} --threads {threads} --out {out}"));
                let text = fs::read_to_string(here.join(&out).join("manifest.json")).expect("the manifest");
                let manifest: serde_json::Value = serde_json::from_str(&text).expect("JSON");
                let session = &manifest["sessions"][0];
                match lanes {
                    "auto" => assert!(session["lanes"].as_u64() > Some(1), "{session}"),
                    "1" => assert_eq!((&session["lanes"], &session["simd"]), (&1.into(), &"none".into())),
                    _ => assert_eq!(session["lanes"].to_string(), lanes),
                }
                if simd != "auto" && lanes != "1" {
                    assert_eq!(session["simd"], simd);
                }
                runs.push(out);
            }
        }
    }
    for other in &runs[1..] {
        assert_eq!(results(&here.join(&runs[0])), results(&here.join(other)), "{} and {other}", runs[0]);
    }
    let tests = ["1", "8", "16"].map(|lanes| ok(farsa, &here, &format!("test {} --trials 9 --lanes {lanes}", runs[0])));
    assert!(tests.iter().all(|test| *test == tests[0]));
    let refused = say(farsa, &here, &format!("{run} --lanes 8 --simd neon --out refused"));
    assert!(refused.code == Some(2) && refused.err.contains("avx512"), "{refused:?}");
    if let Some(simd) = known.iter().find_map(|(simd, here)| (!here).then_some(simd)) {
        let refused = say(farsa, &here, &format!("{run} --simd {simd} --out refused"));
        assert!(refused.code == Some(2) && refused.err.contains("baseline"), "{refused:?}");
    }
    assert!(!here.join("refused").exists());
}

/// Support of AVX2 and of AVX-512 by the processor.
fn wide() -> [bool; 2] {
    [Instructions::Avx2, Instructions::Avx512].map(|wide| Instructions::available().any(|one| one == wide))
}

#[test]
fn the_main_experiment() {
    let here = scratch("main-experiment");
    let run = "run reach-grasp-lift --population 4 --set evolution.parents=2 --set trial.steps=30 --seed 9";
    let farsa = crate::tool::farsa();
    ok(farsa, &here, &format!("{run} --generations 3 --threads 1 --out one"));
    ok(farsa, &here, &format!("{run} --generations 1 --threads 2 --out two"));
    ok(farsa, &here, "run --resume two --generations 3 --threads 2");
    assert_eq!(results(&here.join("one")), results(&here.join("two")));
    let log = fs::read_to_string(here.join("one/fitness.csv")).expect("the log");
    let best = log.lines().last().and_then(|line| line.split(',').nth(1)).expect("the best");
    let said = say(farsa, &here, "replay one");
    // Four digits of it are printed.
    let fitness = said.err.split("fitness ").nth(1).and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
    let fitness = fitness.expect("a fitness");
    let best: f64 = best.parse().expect("a number");
    assert!((fitness - best).abs() <= 5e-4 * best.abs() && said.err.contains("fitness"), "{best}: {}", said.err);
    assert_eq!(said.out.lines().count(), 1 + 4 * 30);
    ok(farsa, &here, "test one --trials 4");
}
