//! Truncated, altered and missing files, a full disk, and two processes at one run.

use std::fs;
use std::path::Path;

use crate::tool::{Running, Said, command, content, ok, own, results, say, scratch};

/// Damages a file in a way, expects the command to refuse and to change nothing, and puts the file back.
fn refused(here: &Path, file: &str, damage: &dyn Fn(&mut Vec<u8>), arguments: &str, words: &[&str]) {
    let path = here.join("r").join(file);
    let whole = fs::read(&path).expect("the file");
    let mut bytes = whole.clone();
    damage(&mut bytes);
    fs::write(&path, &bytes).expect("the file");
    let before = content(here);
    let said = say(own(), here, arguments);
    assert_eq!(said.code, Some(1), "{arguments}: {said:?}");
    for word in words.iter().chain(&[file]) {
        assert!(said.err.contains(word), "{arguments}: no {word:?} in {said:?}");
    }
    assert!(content(here) == before, "{arguments} changed a file");
    fs::write(&path, whole).expect("the file");
}

#[test]
fn damaged_files_are_named() {
    let here = scratch("damaged");
    ok(own(), &here, "run cart --generations 3 --out r");
    let resume = "run --resume r --generations 5";
    for (file, arguments, kind) in [("checkpoint.bin", resume, "checkpoint"), ("champion.bin", "test r", "champion")] {
        refused(&here, file, &|bytes| bytes.truncate(bytes.len() / 2), arguments, &["truncated"]);
        refused(&here, file, &|bytes| bytes.truncate(5), arguments, &["truncated"]);
        refused(&here, file, &Vec::clear, arguments, &["truncated"]);
        refused(&here, file, &|bytes| bytes[40] ^= 1, arguments, &["altered", "checksum"]);
        refused(&here, file, &|bytes| bytes.push(0), arguments, &["altered"]);
        refused(&here, file, &|bytes| bytes[8] = 99, arguments, &["format version 99"]);
        refused(&here, file, &|bytes| *bytes = b"a text, not a record".to_vec(), arguments, &["is not a", kind]);
    }
    // The checkpoint stores the length of the record and its checksum. Later bytes are of no finished generation.
    for arguments in ["replay r", resume] {
        refused(&here, "record.bin", &|bytes| bytes.truncate(bytes.len() - 1), arguments, &["truncated"]);
        refused(&here, "record.bin", &Vec::clear, arguments, &["truncated"]);
        for byte in [0, 8, 12, 40] {
            refused(&here, "record.bin", &|bytes| bytes[byte] ^= 1, arguments, &["altered", "checksum"]);
        }
        refused(&here, "record.bin", &|bytes| *bytes.last_mut().expect("a byte") ^= 1, arguments, &["altered"]);
    }
    refused(&here, "manifest.json", &|bytes| bytes[14] = b'9', resume, &["format 9"]);
    refused(&here, "manifest.json", &|bytes| bytes.truncate(10), resume, &[]);
    // Nothing of this has harmed the run.
    ok(own(), &here, "run cart --generations 5 --out whole");
    ok(own(), &here, resume);
    assert_eq!(results(&here.join("r")), results(&here.join("whole")));
}

#[test]
fn missing_files_are_named() {
    let here = scratch("missing");
    ok(own(), &here, "run cart --generations 2 --out r");
    for (file, arguments) in
        [("checkpoint.bin", "run --resume r"), ("champion.bin", "test r"), ("record.bin", "replay r")]
    {
        let (path, away) = (here.join("r").join(file), here.join(file));
        fs::rename(&path, &away).expect("the file");
        let said = say(own(), &here, arguments);
        assert_eq!(said.code, Some(1), "{said:?}");
        assert!(said.err.contains(file), "{said:?}");
        fs::rename(&away, &path).expect("the file");
    }
}

/// A shell that lets no file grow beyond some blocks of 512 bytes, which is what a full disk looks like to a program.
#[cfg(unix)]
fn on_a_full_disk(here: &Path, blocks: u32, arguments: &str) -> Said {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" {arguments}");
    let arguments = [std::ffi::OsStr::new("-c"), script.as_ref(), own().as_os_str()];
    Running::start(&mut command(Path::new("/bin/sh"), here, &arguments)).end()
}

#[cfg(unix)]
#[test]
fn a_full_disk_loses_nothing() {
    let here = scratch("full");
    ok(own(), &here, "run cart --generations 40 --out whole");
    ok(own(), &here, "run cart --generations 4 --out r");
    let before = results(&here.join("r"));
    // Not even the configuration can be written.
    let said = on_a_full_disk(&here, 0, "run --resume r --generations 40");
    assert_eq!(said.code, Some(1), "{said:?}");
    assert!(said.err.contains("cannot write r/config.toml: File too large"), "{said:?}");
    assert_eq!(before, results(&here.join("r")));
    // Some generations can be, then the log is full in the middle of a line.
    let said = on_a_full_disk(&here, 3, "run --resume r --generations 40");
    assert_eq!(said.code, Some(1), "{said:?}");
    assert!(said.err.contains("cannot write r/"), "{said:?}");
    assert!(said.err.contains("; 5 of 40 generations, "), "it should come some way: {said:?}");
    let after = results(&here.join("r"));
    assert_eq!((&before[1], &before[3]), (&after[1], &after[3]), "champion and checkpoint as they were");
    assert!(after[2].starts_with(&before[2]), "and the record at least that long");
    // A new run finds no room and leaves no rest.
    let said = on_a_full_disk(&here, 0, "run cart --out new");
    assert_eq!(said.code, Some(1), "{said:?}");
    let mut left: Vec<_> =
        fs::read_dir(&here).expect("here").map(|entry| entry.expect("an entry").file_name()).collect();
    left.sort();
    assert_eq!(left, ["r", "whole"]);
    // With room again the run continues as if nothing had happened.
    ok(own(), &here, "run --resume r --generations 40");
    assert_eq!(results(&here.join("r")), results(&here.join("whole")));
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_cannot_be_written_is_an_error() {
    let here = scratch("dev-full");
    ok(own(), &here, "run cart --generations 2 --out r");
    let said = say(own(), &here, "replay r --out /dev/full");
    assert_eq!(said.code, Some(1), "{said:?}");
    assert!(said.err.contains("cannot write"), "{said:?}");
    // But a reader that has stopped is no error.
    let script = "\"$0\" replay r | head -n 2";
    let arguments = [std::ffi::OsStr::new("-c"), script.as_ref(), own().as_os_str()];
    let said = Running::start(&mut command(Path::new("/bin/sh"), &here, &arguments)).end();
    assert_eq!((said.out.lines().count(), said.err.as_str()), (2, ""));
}

#[test]
fn two_processes_at_one_run() {
    let here = scratch("two");
    let arguments = "run cart --generations 100000 --set trial.steps=50000 --out r";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let mut first = Running::start(&mut command(own(), &here, &arguments));
    first.until("log", || here.join("r/fitness.csv").exists());
    // The first needs a moment between making the directory and taking possession.
    std::thread::sleep(std::time::Duration::from_millis(300));
    let said = say(own(), &here, "run --resume r");
    drop(first);
    assert_eq!(said.code, Some(2), "{said:?}");
    assert!(said.err.contains("another process is at this run"), "{said:?}");
}
