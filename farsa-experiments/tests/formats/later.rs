//! Allowed changes of a later version, in copies with changed numbers: they are refused by name.

use std::fs;
use std::path::{Path, PathBuf};

use farsa_num::crc32;
use serde_json::Value;

use crate::place::{Place, content, end};
use crate::refusal::Change;
use crate::{formats, v0_1};

/// Changes a sealed file: where to, the byte of its new number, and the checksum that follows from that.
fn altered(path: &Path, place: usize, number: u8) {
    let mut bytes = fs::read(path).expect("a file");
    bytes[place] = number;
    // The head of a record is sealed, too, with the generations after it.
    let length = u64::from_le_bytes(bytes[12..20].try_into().expect("eight bytes"));
    let end = 20 + usize::try_from(length).expect("a length");
    let checksum = crc32(&bytes[..end]).to_le_bytes();
    bytes[end..end + 4].copy_from_slice(&checksum);
    fs::write(path, bytes).expect("a file");
}

#[test]
fn what_a_later_version_changes_is_refused_by_name() {
    for name in ["snes", "predator-prey", "imported"] {
        let run = formats().join(v0_1::VERSION).join(name);
        let place = Place::with(&format!("later-{name}"), &run);
        if place.refused().is_some() {
            // Then it is so already.
            continue;
        }
        let text = place.text("run/manifest.json");
        let manifest = |key: &str, from: u64| {
            let line = |number: u64| format!("\"{key}\": {number},");
            assert!(text.contains(&line(from)), "{text}");
            fs::write(place.0.join("run/manifest.json"), text.replace(&line(from), &line(9))).expect("a manifest");
        };
        let then: Value = serde_json::from_str(&text).expect("JSON");
        let number = |key: &str| then[key].as_u64().expect("a number");
        let files: Vec<PathBuf> = content(&run)
            .into_keys()
            .filter(|file| end(file) == "bin")
            .map(|file| place.0.join("run").join(file))
            .collect();
        // After the experiment, the condition and a seed of one byte.
        let values = |path: &Path| {
            let bytes = fs::read(path).expect("a file");
            let condition = 21 + usize::from(bytes[20]);
            condition + usize::from(bytes[condition]) + 2
        };
        for (change, key) in [(0, "values_version"), (1, "experiment_version")] {
            manifest(key, number(key));
            for path in &files {
                assert_eq!(
                    u64::from(fs::read(path).expect("a file")[values(path) + change]),
                    number(key),
                    "{}",
                    path.display()
                );
                altered(path, values(path) + change, 9);
            }
            let refusal = place.refused().expect("another version");
            assert!(matches!(refusal.of, Change::Values) && refusal.words.contains("version 9 of"), "{refusal:?}");
            place.is_refused(&refusal);
            for path in &files {
                altered(path, values(path) + change, u8::try_from(number(key)).expect("a small number"));
            }
        }
        fs::write(place.0.join("run/manifest.json"), &text).expect("a manifest");
        assert!(place.refused().is_none());
        for path in &files {
            altered(path, 8, 9);
        }
        let refusal = place.refused().expect("another format");
        assert!(matches!(refusal.of, Change::Format), "{refusal:?}");
        place.is_refused(&refusal);
        if place.recorded().is_some() {
            let place = Place::with(&format!("manifest-{name}"), &run);
            fs::write(place.0.join("run/manifest.json"), text.replace("\"format\": 1,", "\"format\": 9,"))
                .expect("a manifest");
            let refusal = place.refused().expect("another format");
            assert!(matches!(refusal.of, Change::Manifest), "{refusal:?}");
            place.is_refused(&refusal);
        }
    }
}
