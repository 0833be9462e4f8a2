//! The bits of all crates together. A change here is a change of every recorded run: CHANGELOG.md lists it under
//! *Values*.

#[allow(dead_code)]
#[path = "../examples/06_the_loop.rs"]
mod the_loop;

/// Digest of the first 300 states.
const DIGEST: u64 = 0xa168_9801_b67f_66c3;

#[test]
fn the_whole_loop_keeps_its_bits() {
    let digest = the_loop::run(300).expect("the example runs");
    assert_eq!(digest, DIGEST, "{digest:#018x}");
}
