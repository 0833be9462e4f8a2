//! Hostile and damaged texts.

use std::fmt::Write as _;

use proptest::prelude::*;

use crate::round_trip::lost;
use crate::{fixture, message, read};

#[test]
fn hostile_texts_are_refused_soon() {
    let deep = format!("<mujoco>{}{}</mujoco>", "<body>".repeat(1_000_000), "</body>".repeat(1_000_000));
    assert_eq!(message(&deep), "text line 1: more than 30000 elements within each other");
    let many = format!("<mujoco>{}</mujoco>", "<geom/>".repeat(1_000_000));
    assert_eq!(message(&many), "text line 1: more than 100000 elements");
    let wide: String = (0..1_000_000).fold(String::from("<mujoco"), |mut text, i| {
        let _ = write!(text, " a{i}='1'");
        text
    });
    assert_eq!(message(&(wide + "/>")), "text line 1: more than 64 attributes of one element");
    let mut bomb = String::from("<!DOCTYPE robot [<!ENTITY a0 'lol'>");
    for i in 1..12 {
        let _ = write!(bomb, "<!ENTITY a{i} '{}'>", format!("&a{};", i - 1).repeat(10));
    }
    let bomb = bomb + "]>\n<robot name='&a11;'/>";
    assert_eq!(message(&bomb), "text line 1: a document type; models have none, and entities are not read");
    assert!(message("<robot name='&a;'/>").contains("unknown entity"), "{}", message("<robot name='&a;'/>"));
    // Geoms that may all touch each other are more pairs than a description holds.
    let geoms = "<body><freejoint/><geom size='1'/></body>".repeat(1000);
    assert!(
        message(&format!("<mujoco><worldbody>{geoms}</worldbody></mujoco>"))
            .ends_with("more than 65535 pairs of geoms that may touch")
    );
    let world = |body: &str, count| format!("<mujoco><worldbody>{}</worldbody></mujoco>", body.repeat(count));
    let touching = world("<geom size='1'/>", 3000);
    assert!(message(&touching).ends_with("more than 2000 geoms that may touch"), "{}", message(&touching));
    let free = world("<body><freejoint/><geom size='1' contype='0' conaffinity='0'/></body>", 2000);
    assert_eq!(read(&free).unwrap().robot.segments.len(), 2000);
    let free =
        free.replace("</worldbody>", "<geom name='g' size='1'/><body><joint/><geom size='1'/></body></worldbody>");
    assert_eq!(read(&free).unwrap().robot.pairs.len(), 1, "12 001 degrees of freedom");
    let defaults = format!("<mujoco><default>{}</default></mujoco>", "<geom/>".repeat(2000));
    assert_eq!(message(&defaults), "text line 1: more than 1000 defaults");
    let comments = format!("<mujoco>{}</mujoco>", "<!---->".repeat(1_000_000));
    assert_eq!(message(&comments), "text line 1: nodes limit reached");
    for text in
        ["", " ", "<", "<robot", "\u{0}", "<robot name='r'><link/>", "<mujoco><worldbody>", "<mujoco/><mujoco/>"]
    {
        assert!(read(text).is_err(), "{text}");
    }
}

/// A model with nearly everything that is read, small enough to be damaged often.
fn sample(urdf: bool) -> String {
    if urdf { fixture("zoo.urdf") } else { fixture("zoo.xml") }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn damaged_models_are_read_or_refused(
        urdf: bool,
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in any::<prop::sample::Index>(),
        moved in (any::<prop::sample::Index>(), any::<prop::sample::Index>()),
        change in 0..4,
    ) {
        let text = sample(urdf);
        let mut lines: Vec<&str> = text.lines().collect();
        let (from, to) = (moved.0.index(lines.len()), moved.1.index(lines.len()));
        match change {
            0 => drop(lines.remove(from)),
            1 => lines.insert(to, lines[from]),
            2 => lines.swap(from, to),
            _ => lines.truncate(cut.index(lines.len())),
        }
        let mut bytes = lines.join("\n").into_bytes();
        for (at, byte) in flips {
            let at = at.index(bytes.len().max(1));
            if let Some(to) = bytes.get_mut(at) {
                *to = byte;
            }
        }
        let text = String::from_utf8_lossy(&bytes);
        if let Ok(reading) = read(&text) {
            prop_assert!(reading.robot.validate().is_ok());
            prop_assert_eq!(lost(&reading.robot), Ok(()));
        }
    }

    #[test]
    fn wild_numbers_are_read_or_refused(
        urdf: bool,
        at in any::<prop::sample::Index>(),
        value in prop::sample::select(vec!["nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "0", "-1", "1e999", "", "x", "1 2", "99999999999999999999"]),
    ) {
        let text = sample(urdf);
        // Every run of digits in an attribute.
        let numbers: Vec<(usize, usize)> = {
            let bytes = text.as_bytes();
            let part = |b: u8| b.is_ascii_digit() || b == b'.' || b == b'-';
            let starts = (1..bytes.len()).filter(|i| part(bytes[*i]) && (bytes[i - 1] == b'"' || bytes[i - 1] == b' '));
            starts.map(|i| (i, i + bytes[i..].iter().take_while(|b| part(**b)).count())).collect()
        };
        let (from, to) = numbers[at.index(numbers.len())];
        let text = format!("{}{value}{}", &text[..from], &text[to..]);
        if let Ok(reading) = read(&text) {
            prop_assert!(reading.robot.validate().is_ok());
            prop_assert_eq!(lost(&reading.robot), Ok(()));
        }
    }
}
