//! Options and what was read survive being written and read.
#![cfg(feature = "serde")]
#![allow(missing_docs, clippy::unwrap_used)]

use farsa_models::mjcf::MjcfOptions;
use farsa_models::{Imported, Meshes, ReadOptions};

#[test]
fn options_name_only_what_differs() {
    let options: ReadOptions = serde_json::from_str(r#"{"meshes": "leave", "repair": {"balance": true}}"#).unwrap();
    let mut expected = ReadOptions { meshes: Meshes::Leave, ..ReadOptions::default() };
    expected.repair.balance = true;
    assert_eq!(options, expected);
    let text = serde_json::to_string(&options).unwrap();
    assert_eq!(serde_json::from_str::<ReadOptions>(&text).unwrap(), options);
    assert_eq!(serde_json::from_str::<MjcfOptions>("{}").unwrap(), MjcfOptions::default());
    assert!(serde_json::from_str::<MjcfOptions>(r#"{"timestep": 0.001}"#).is_err());
}

#[test]
fn what_was_read_reads_back_as_it_was() {
    let text = r#"<mujoco model="rod"><worldbody><body name="rod" pos="0 0 1">
        <joint name="hinge" axis="0 1 0" range="-90 90" springyield="1"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.5" size="0.01"/></body></worldbody></mujoco>"#;
    let imported = Imported::from_text(text, &ReadOptions::default()).unwrap();
    assert_eq!(imported.warnings.len(), 1);
    let text = serde_json::to_string(&imported).unwrap();
    assert_eq!(serde_json::from_str::<Imported>(&text).unwrap(), imported);
}
