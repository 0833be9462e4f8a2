//! The numbers of another program that the tests here compare with.

/// The cases of a kind in `tests/fixtures/statistics.json`.
pub(crate) fn fixture(kind: &str) -> Vec<serde_json::Value> {
    let all: serde_json::Value =
        serde_json::from_str(include_str!("../../tests/fixtures/statistics.json")).expect("JSON");
    let cases = all[kind].as_array().expect("a list of cases").clone();
    assert!(!cases.is_empty(), "{kind}");
    cases
}
