//! The bits of all crates together. A change here is a change of every recorded run: it stands in CHANGELOG.md as
//! value-breaking.

#[allow(dead_code)]
#[path = "../examples/06_the_loop.rs"]
mod the_loop;

/// Of the first 300 states.
const DIGEST: u64 = 0xbdfa_4908_e6b2_1f9d;

#[test]
fn the_whole_loop_keeps_its_bits() {
    let digest = the_loop::live(300).expect("the example runs");
    assert_eq!(digest, DIGEST, "{digest:#018x}");
}
