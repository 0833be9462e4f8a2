//! Runs on ranks that are threads: the files of one process, for any number of ranks, also when that changes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{CHASE, CHASE_ALONE, LEARNER, Numbers, STEADY, plan, pool, scratch};
use crate::error::Error;
use crate::ranks::Ranks;
use crate::ranks::exchange::{Exchange, WorkerCommand};
use crate::ranks::threads::on_ranks;
use crate::run::begin::create;
use crate::run::evolve::continue_run;
use crate::run::plan::Plan;
use crate::run::worker::Worker;
use crate::store::directory::Directory;

const GENERATIONS: i64 = 12;

/// Runs one rank of a continued run, and returns the exit code of workers.
pub(super) fn part(
    ranks: &dyn Ranks,
    plan: &Plan<'_>,
    directory: &Path,
    threads: usize,
    stop: &AtomicBool,
) -> Result<String, Error> {
    let exchange = Rc::new(Exchange::new(ranks));
    if ranks.rank() > 0 {
        let follow = Worker {
            plan: &|file| {
                let mut found = Plan::new(plan.experiment, None, "")?;
                found.apply(file)?;
                Ok(found)
            },
            pool: &|plan| Ok(pool(plan, threads).on(exchange.clone())),
            stop,
        };
        return follow.follow(&exchange).map(|code| code.to_string());
    }
    let directory = Directory::open(directory).or_else(|_| create(plan, directory))?;
    let found = continue_run(plan, &directory, pool(plan, threads).on(exchange.clone()), stop, "farsa", true);
    let code = found.as_ref().map_or_else(Error::exit_code, |_| 0);
    exchange.command(Some(&WorkerCommand::End(code)))?;
    found.map(|summary| summary.text())
}

fn all_well(results: Vec<Result<String, Error>>) {
    for result in results {
        result.unwrap();
    }
}

/// Runs on the given number of ranks, with different numbers of threads.
fn on(size: usize, numbers: &Numbers, generations: i64, directory: &Path) -> Vec<Result<String, Error>> {
    on_ranks(size, |ranks| {
        let plan = plan(numbers, generations);
        part(ranks, &plan, directory, 1 + ranks.rank() % 2, &AtomicBool::new(false))
    })
}

/// The content of a run, except for the manifest with its times.
pub(super) fn content(run: &Path) -> BTreeMap<String, Vec<u8>> {
    let names = fs::read_dir(run).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let names = names.filter(|name| name != "manifest.json");
    names.map(|name| (name.clone(), fs::read(run.join(name)).unwrap())).collect()
}

pub(super) fn same(found: &Path, expected: &Path) {
    let (found, expected) = (content(found), content(expected));
    assert!(found.keys().eq(expected.keys()), "{:?} {:?}", found.keys(), expected.keys());
    for (name, bytes) in &expected {
        assert!(found[name] == *bytes, "{name} differs");
    }
}

#[test]
fn any_number_of_ranks_makes_the_files_of_one_process() {
    let root = scratch("ranks");
    let generalist = Numbers { strategy: super::generalist::generalist(), populations: 2 };
    let all = [("steady", STEADY), ("learner", LEARNER), ("alone", CHASE_ALONE), ("chase", CHASE)];
    for (name, numbers) in all.into_iter().chain([("generalist", generalist)]) {
        let place = |end: &str| root.join(format!("{name}-{end}"));
        let whole = create(&plan(&numbers, GENERATIONS), &place("whole")).unwrap();
        super::run(&plan(&numbers, GENERATIONS), &whole, 2);
        for size in [1, 2, 4] {
            let place = place(&size.to_string());
            for result in on(size, &numbers, GENERATIONS, &place).into_iter().skip(1) {
                assert_eq!(result.unwrap(), "0");
            }
            same(&place, whole.path());
        }
        // One rank, four, then two, from one checkpoint to the next.
        for (size, generations) in [(1, 3), (4, 7), (2, GENERATIONS)] {
            all_well(on(size, &numbers, generations, &place("parts")));
        }
        same(&place("parts"), whole.path());
    }
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn a_rank_with_another_run_ends_all_with_its_number() {
    let root = scratch("ranks-other");
    let (fine, other) = (plan(&CHASE_ALONE, 4), {
        let mut other = plan(&CHASE_ALONE, 4);
        other.seed = 12;
        other
    });
    let results = on_ranks(3, |ranks| {
        let exchange = Exchange::new(ranks);
        let own = if ranks.rank() == 2 { plan_of(12) } else { plan_of(11) };
        exchange.begin(crate::run::coordinator::facts(&own))
    });
    for result in results {
        let error = result.unwrap_err();
        assert_eq!((error.to_string().as_str(), error.exit_code()), ("rank 2: `seed` is 12 there and 11 on rank 0", 2));
    }
    assert_ne!(fine.identity().unwrap(), other.identity().unwrap());
    // A rank whose plan of the same configuration is another, as from another program.
    let results = on_ranks(3, |ranks| {
        let exchange = Rc::new(Exchange::new(ranks));
        let plan = plan_of(11);
        if ranks.rank() == 0 {
            let directory = create(&plan, &root.join("run")).unwrap();
            let result = continue_run(&plan, &directory, pool(&plan, 1).on(exchange.clone()), &NEVER, "farsa", true);
            exchange.command(Some(&WorkerCommand::End(9))).unwrap();
            return result.map(|_| 0);
        }
        let follow = Worker {
            plan: &|_| Ok(if ranks.rank() == 1 { plan_of(11) } else { plan_of(12) }),
            pool: &|plan| Ok(pool(plan, 1).on(exchange.clone())),
            stop: &NEVER,
        };
        follow.follow(&exchange)
    });
    let [first, second, third] = results.try_into().unwrap();
    let said = first.unwrap_err().to_string();
    assert!(
        said.starts_with("rank 2: the run in ") && said.ends_with("another configuration is another run"),
        "{said}"
    );
    assert_eq!((second.unwrap(), third.unwrap()), (9, 9));
    fs::remove_dir_all(root).unwrap();
}

static NEVER: AtomicBool = AtomicBool::new(false);

fn plan_of(seed: u64) -> Plan<'static> {
    let mut plan = plan(&CHASE_ALONE, 4);
    plan.seed = seed;
    plan
}

#[test]
fn a_rank_that_is_told_to_stop_stops_all_after_a_checkpoint() {
    let root = scratch("ranks-stop");
    let whole = create(&plan(&CHASE_ALONE, 2000), &root.join("whole")).unwrap();
    super::run(&plan(&CHASE_ALONE, 2000), &whole, 2);
    let place = root.join("stopped");
    for told in [0, 1, 2] {
        let stops: [AtomicBool; 3] = Default::default();
        let results = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(std::time::Duration::from_millis(30));
                stops[told].store(true, Ordering::Relaxed);
            });
            on_ranks(3, |ranks| {
                let plan = plan(&CHASE_ALONE, 2000);
                part(ranks, &plan, &place, 1, &stops[ranks.rank()])
            })
        });
        for (rank, result) in results.into_iter().enumerate() {
            match result {
                Ok(code) => assert!(code == "130" || code == "0" && rank > 0, "{code}"),
                Err(error) => assert!(rank == 0 && error.exit_code() == 130, "{error}"),
            }
        }
    }
    all_well(on(2, &CHASE_ALONE, 2000, &place));
    same(&place, whole.path());
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn an_error_of_rank_0_ends_all_and_loses_nothing() {
    let root = scratch("ranks-full");
    let place = root.join("run");
    let whole = create(&plan(&CHASE_ALONE, 5), &root.join("whole")).unwrap();
    super::run(&plan(&CHASE_ALONE, 5), &whole, 1);
    all_well(on(2, &CHASE_ALONE, 2, &place));
    // A directory where a file is to be replaced: no checkpoint can be written.
    fs::remove_file(place.join("fitness.svg")).unwrap();
    fs::create_dir(place.join("fitness.svg")).unwrap();
    let [first, second, third] = on(3, &CHASE_ALONE, 5, &place).try_into().unwrap();
    let first = first.unwrap_err();
    assert!(matches!(first, Error::Io { .. }), "{first}");
    assert_eq!((first.exit_code(), second.unwrap(), third.unwrap()), (1, "1".into(), "1".into()));
    fs::remove_dir(place.join("fitness.svg")).unwrap();
    all_well(on(2, &CHASE_ALONE, 5, &place));
    same(&place, whole.path());
    fs::remove_dir_all(root).unwrap();
}
