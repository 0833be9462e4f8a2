//! `farsa new --parts`: a crate with custom parts.

use std::fs;

use crate::tool::{farsa, ok, say, scratch};

#[test]
fn a_crate_with_parts_is_written_once_and_only_under_a_valid_name() {
    let here = scratch("new-parts");
    let said = ok(farsa(), &here, "new my-robots --parts");
    assert!(said.ends_with("cd my-robots\ncargo run -- run seek.toml --generations 20\n"), "{said:?}");
    let read = |name: &str| fs::read_to_string(here.join("my-robots").join(name)).expect(name);
    assert!(read("Cargo.toml").starts_with("[package]\nname = \"my-robots\"\n"));
    assert!(read("src/main.rs").contains("with_part(part::sensor::<Compass>(\"compass\"))"));
    assert!(read("seek.toml").contains("kind = \"compass\""));
    // Without the crate's program its file has an unknown word.
    let said = say(farsa(), &here, "check my-robots/seek.toml");
    assert!(said.code == Some(2) && said.err.contains("line 4: unknown kind `compass`"), "{said:?}");
    fs::write(here.join("my-robots/seek.toml"), "changed").expect("a file");
    for (name, why) in [
        ("my-robots", "my-robots: there is one already"),
        ("../my-robots", "`../my-robots` is no name of a crate"),
        ("My", "`My` is no name of a crate"),
        ("1a", "`1a` is no name of a crate"),
    ] {
        let said = say(farsa(), &here, &format!("new {name} --parts"));
        assert!(said.code == Some(2) && said.err.contains(why), "{name}: {said:?}");
    }
    assert_eq!(read("seek.toml"), "changed");
    let said = say(farsa(), &here, "new own --parts --from light");
    assert!(said.code == Some(2) && !here.join("own").exists(), "{said:?}");
}
