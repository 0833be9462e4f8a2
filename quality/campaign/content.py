"""What directories hold, and whether it is the same."""

import json
import shutil
from pathlib import Path

from program import Lost

# It has the times of a run's sessions.
MANIFEST = "manifest.json"
# What `test` adds to a run.
TESTED = ("test.csv", "test.json", ".test.lock")


def names(folder):
    """All names in a folder, hidden ones too."""
    return sorted(entry.name for entry in Path(folder).iterdir())


def content(folder):
    """All files below a folder, with their bytes."""
    folder = Path(folder)
    files = (path for path in folder.rglob("*") if not path.is_dir())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def same_run(found, expected, result=None):
    """Loses a run whose files are not those of another one, byte for byte, but for the manifest."""
    found, expected = content(found), content(expected)
    strays = sorted(set(found) - set(expected))
    missing = sorted(set(expected) - set(found))
    if strays or missing:
        raise Lost(f"stray files {strays}, missing files {missing}", result)
    differing = [
        name
        for name in expected
        if found[name] != expected[name] and Path(name).name != MANIFEST
    ]
    if differing:
        raise Lost(f"other bytes than the run that nothing happened to: {differing}", result)
    for name in expected:
        if Path(name).name == MANIFEST:
            try:
                json.loads(found[name])
            except ValueError as error:
                raise Lost(f"{name}: {error}", result) from error


def nothing_but(folder, expected, result=None):
    """Loses a folder in which something else lies."""
    found = names(folder)
    if found != sorted(expected):
        raise Lost(f"in the folder are {found}, not {sorted(expected)}", result)


def forget_tests(run):
    """Removes what `test` has added to a run."""
    for name in TESTED:
        (Path(run) / name).unlink(missing_ok=True)


def copy(source, target):
    """Copies a directory."""
    shutil.copytree(source, target, symlinks=True)
