//! What must be the same on all ranks, compared by name.

use crate::error::Error;
use crate::store::identity::Identity;

/// Names and values in an order of their own.
pub(crate) type Facts = Vec<(String, String)>;

/// What a run is: the program's version and all that its results depend on.
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

/// Refuses the first rank whose facts differ from those of rank 0, with what differs.
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
}
