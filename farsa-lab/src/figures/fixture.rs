//! Results of other programs for the tests.

/// Reads the cases of a kind in `tests/fixtures/statistics.json`.
pub(crate) fn fixture(kind: &str) -> Vec<serde_json::Value> {
    let kinds: serde_json::Value =
        serde_json::from_str(include_str!("../../tests/fixtures/statistics.json")).expect("JSON");
    let cases = kinds[kind].as_array().expect("a list of cases").clone();
    assert!(!cases.is_empty(), "{kind}");
    cases
}
