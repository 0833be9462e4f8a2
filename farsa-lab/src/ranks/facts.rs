//! Values that must be equal on all ranks, compared by name.

use crate::error::Error;
use crate::store::identity::Identity;

/// Names and values, in a fixed order.
pub(crate) type Facts = Vec<(String, String)>;

/// Returns the facts of a run: the program's version and everything that the results depend on.
pub(crate) fn of_run(identity: &Identity, strategy: &str, generations: u32) -> Facts {
    let Identity { experiment, condition, seed, values_version, experiment_version, settings } = identity;
    let fixed = [
        ("the version of farsa-lab", env!("CARGO_PKG_VERSION").to_owned()),
        ("the version of FARSA's values", values_version.to_string()),
        ("experiment", experiment.clone()),
        ("the version of the experiment's values", experiment_version.to_string()),
        ("condition", condition.clone()),
        ("seed", seed.to_string()),
        ("strategy", strategy.to_owned()),
        ("evolution.generations", generations.to_string()),
    ];
    let fixed = fixed.into_iter().map(|(name, value)| (name.to_owned(), value));
    fixed.chain(settings.iter().map(|(name, value)| (name.clone(), value.to_string()))).collect()
}

/// Refuses the first rank whose facts differ from those of rank 0, with the difference.
///
/// # Errors
/// [`Error::Rank`] with exit code 2.
pub(crate) fn same(all: &[Facts]) -> Result<(), Error> {
    let Some((first, others)) = all.split_first() else { return Ok(()) };
    for (rank, other) in (1..).zip(others) {
        let value = |facts: &Facts, name: &str| facts.iter().find(|fact| fact.0 == name).map(|fact| fact.1.clone());
        let names = first.iter().chain(other).map(|(name, _)| name.as_str());
        let differing = names.map(|name| (name, value(first, name), value(other, name)));
        if let Some((name, expected, found)) = { differing }.find(|(_, expected, found)| expected != found) {
            let text = |value: Option<String>| value.unwrap_or_else(|| "missing".into());
            let why = format!("`{name}` is {} there and {} on rank 0", text(found), text(expected));
            return Err(Error::Rank { rank, code: 2, why });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::settings::Value;
    use crate::store::identity::FILE;

    fn facts(all: &[(&str, &str)]) -> Facts {
        all.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
    }

    #[test]
    fn the_first_rank_that_differs_is_named_with_what_differs() {
        let own = facts(&[("seed", "1"), ("world.step", "0.01")]);
        same(&[]).unwrap();
        same(&[own.clone(), own.clone()]).unwrap();
        for (other, message) in [
            (facts(&[("seed", "1"), ("world.step", "0.02")]), "`world.step` is 0.02 there and 0.01 on rank 0"),
            (facts(&[("seed", "1")]), "`world.step` is missing there and 0.01 on rank 0"),
            (
                facts(&[("seed", "1"), ("world.step", "0.01"), ("a", "\"b\"")]),
                "`a` is \"b\" there and missing on rank 0",
            ),
        ] {
            let error = same(&[own.clone(), own.clone(), other, facts(&[])]).unwrap_err();
            assert_eq!((error.to_string(), error.exit_code()), (format!("rank 2: {message}"), 2));
        }
    }
    #[test]
    fn another_program_or_run_is_named_with_both_values() {
        let own = Identity {
            experiment: "push-box".into(),
            condition: "plain".into(),
            seed: 3,
            values_version: 3,
            experiment_version: 2,
            settings: vec![("world.step".into(), Value::Whole(10)), (format!("{FILE}start.csv"), Value::Whole(77))],
        };
        let facts = |identity: &Identity| of_run(identity, "truncation", 100);
        let refused = |other: Facts, message: &str| {
            let error = same(&[facts(&own), facts(&own), facts(&own), other]).unwrap_err();
            assert_eq!((error.to_string(), error.exit_code()), (format!("rank 3: {message} on rank 0"), 2));
        };
        same(&[facts(&own), facts(&own.clone())]).unwrap();
        let with = |settings: [(&str, i64); 2]| Identity {
            settings: settings.map(|(name, value)| (name.to_owned(), Value::Whole(value))).into(),
            ..own.clone()
        };
        for (other, message) in [
            (Identity { values_version: 4, ..own.clone() }, "`the version of FARSA's values` is 4 there and 3"),
            (
                Identity { experiment_version: 1, ..own.clone() },
                "`the version of the experiment's values` is 1 there and 2",
            ),
            (Identity { experiment: "swarm".into(), ..own.clone() }, "`experiment` is swarm there and push-box"),
            (Identity { condition: "rapier".into(), ..own.clone() }, "`condition` is rapier there and plain"),
            (Identity { seed: 4, ..own.clone() }, "`seed` is 4 there and 3"),
            (with([("world.step", 20), ("CRC-32 of start.csv", 77)]), "`world.step` is 20 there and 10"),
            (with([("world.step", 10), ("CRC-32 of start.csv", 78)]), "`CRC-32 of start.csv` is 78 there and 77"),
        ] {
            refused(facts(&other), message);
        }
        refused(of_run(&own, "xnes", 100), "`strategy` is xnes there and truncation");
        refused(of_run(&own, "truncation", 99), "`evolution.generations` is 99 there and 100");
        let mut older = facts(&own);
        older[0].1 = "0.0.9".into();
        let version = env!("CARGO_PKG_VERSION");
        refused(older, &format!("`the version of farsa-lab` is 0.0.9 there and {version}"));
    }
}
