//! Meshes of robots: STL, as text and as bytes, and OBJ. The first byte selects.
#![no_main]

use std::sync::LazyLock;

use farsa_fuzz::{Scratch, bounded, selected};
use farsa_models::{Imported, ReadOptions};
use libfuzzer_sys::fuzz_target;

static SCRATCH: LazyLock<Scratch> = LazyLock::new(Scratch::new);

fn model(file: &str) -> String {
    format!(
        r#"<robot name="stone"><link name="stone">
<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><mesh filename="{file}"/></geometry></collision></link></robot>"#
    )
}

fuzz_target!(|input: &[u8]| {
    let Some(([kind], content)) = selected(input) else { return };
    let file = ["mesh.stl", "mesh.obj"][usize::from(kind % 2)];
    SCRATCH.put(file, content);
    let options = ReadOptions { root: Some(SCRATCH.path().into()), floating: true, ..ReadOptions::default() };
    let text = model(file);
    if let Ok(found) = bounded(input.len() + text.len(), || Imported::from_text(&text, &options)) {
        found.robot.validate().expect("what was read is a robot");
    }
});
