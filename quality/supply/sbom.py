#!/usr/bin/env python3
"""The software bill of materials of the command `farsa`, as CycloneDX.

`sbom.py make FILE [CRATES]` writes it from `cargo metadata` and Cargo.lock; CRATES is the folder of
our packaged crates, whose hashes it takes. `sbom.py check FILE` compares one with what `cargo tree`
says the command links, and with Cargo.lock, and validates it where cyclonedx-python-lib is there.

cargo-cyclonedx 0.5.9 agrees with it in every licence and hash. It lists crates, too, that nothing
compiles, names folders of the machine, has no hash of our crates, and takes three processor minutes
to install."""

import hashlib
import json
import subprocess
import sys
import tomllib
import uuid
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMAND = "farsa-experiments"
# What is in the program, and what it is built with besides: macros and build scripts.
LINKED = "normal,no-proc-macro"
BUILT = "normal,build"
SPECIFICATION = "1.6"


def cargo(*arguments):
    """What cargo prints, of the versions in Cargo.lock."""
    command = ["cargo", *arguments, "--locked", "--offline"]
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout


def host():
    """The target that is compiled for here."""
    said = subprocess.run(["rustc", "-vV"], check=True, capture_output=True, text=True).stdout
    return next(line.removeprefix("host: ") for line in said.splitlines() if "host: " in line)


def lock():
    """The checksum of each package and version in Cargo.lock; none of our own."""
    packages = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
    return {(one["name"], one["version"]): one.get("checksum") for one in packages}


def dependencies(kinds):
    """Name and version of what those kinds of dependencies lead to."""
    edges = ["--edges", kinds, "--prefix", "none", "--target", host(), "--format", "{p}"]
    lines = cargo("tree", "--package", COMMAND, *edges).splitlines()
    words = [line.split() for line in lines if line]
    return {(word[0], word[1].removeprefix("v")) for word in words}


def spdx(text):
    """A licence as an SPDX expression: before 1.0 cargo let a slash stand for `or`."""
    return text.replace("/", " OR ") if " " not in text else text


def component(package, kind, checksum):
    """What the list says of a package."""
    name, version = package["name"], package["version"]
    url = f"pkg:cargo/{name}@{version}"
    said = {"type": kind, "bom-ref": url, "name": name, "version": version, "purl": url}
    said["description"] = package["description"] or ""
    said["licenses"] = [{"expression": spdx(package["license"])}]
    if checksum:
        said["hashes"] = [{"alg": "SHA-256", "content": checksum}]
    if package["repository"]:
        said["externalReferences"] = [{"type": "vcs", "url": package["repository"]}]
    return said


def make(path, crates):
    """Writes the list."""
    metadata = json.loads(cargo("metadata", "--format-version", "1", "--filter-platform", host()))
    packages = {(one["name"], one["version"]): one for one in metadata["packages"]}
    checksums = lock()
    used = sorted(dependencies(BUILT))
    by_id = {packages[key]["id"]: key for key in used}
    runs = dependencies(LINKED)

    def listed(key):
        checksum = checksums[key]
        if checksum is None and crates:
            crate = Path(crates) / f"{key[0]}-{key[1]}.crate"
            checksum = hashlib.sha256(crate.read_bytes()).hexdigest()
        return component(packages[key], "application" if key[0] == COMMAND else "library", checksum)

    components = {key: listed(key) for key in used}
    for key, one in components.items():
        one["scope"] = "required" if key in runs else "excluded"
    needs = []
    for node in metadata["resolve"]["nodes"]:
        if node["id"] in by_id:
            others = {by_id[one["pkg"]] for one in node["deps"] if one["pkg"] in by_id
                      and any(kind["kind"] != "dev" for kind in one["dep_kinds"])}
            refs = sorted(components[other]["bom-ref"] for other in others)
            needs.append({"ref": components[by_id[node["id"]]]["bom-ref"], "dependsOn": refs})
    command = next(components.pop(key) for key in used if key[0] == COMMAND)
    del command["scope"]
    everything = json.dumps([command, *components.values()], sort_keys=True)
    bom = {
        "bomFormat": "CycloneDX",
        "specVersion": SPECIFICATION,
        # The same list has the same number.
        "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, everything)}",
        "version": 1,
        "metadata": {"component": command},
        "components": list(components.values()),
        "dependencies": sorted(needs, key=lambda need: need["ref"]),
    }
    Path(path).write_text(json.dumps(bom, indent=1) + "\n")


def validate(text):
    """Whether the schema of CycloneDX was asked, which must find nothing."""
    try:
        from cyclonedx.schema import SchemaVersion
        from cyclonedx.validation.json import JsonStrictValidator
    except ImportError:
        return False
    version = SchemaVersion[f"V{SPECIFICATION.replace('.', '_')}"]
    error = JsonStrictValidator(version).validate_str(text)
    assert error is None, error
    return True


def check(path):
    """Compares the list with what is linked, and with the lock file."""
    text = Path(path).read_text()
    bom = json.loads(text)
    assert (bom["bomFormat"], bom["specVersion"]) == ("CycloneDX", SPECIFICATION)
    listed = [bom["metadata"]["component"], *bom["components"]]
    found = {(one["name"], one["version"]): one for one in listed}
    assert len(found) == len(listed), "a package is listed twice"
    checksums = lock()
    needed, own = dependencies(LINKED), 0
    missing = needed - set(found)
    assert not missing, f"linked and not listed: {missing}"
    assert not set(found) - set(checksums), f"in no lock file: {set(found) - set(checksums)}"
    for key, one in found.items():
        assert one["licenses"][0].get("expression"), f"{key} has no licence"
        hashes = {entry["alg"]: entry["content"] for entry in one.get("hashes", [])}
        assert hashes.get("SHA-256"), f"{key} has no hash"
        own += checksums[key] is None
        assert checksums[key] in (None, hashes["SHA-256"]), f"{key} has another hash"
    references = {one["bom-ref"] for one in listed}
    for one in bom["dependencies"]:
        assert {one["ref"], *one["dependsOn"]} <= references, one
    assert len(needed) > 50 and own > 5, f"{len(needed)} packages, {own} of our own"
    return len(found), len(needed), validate(text)


def main():
    """Does what it is asked."""
    verb, path, *more = sys.argv[1:]
    if verb == "make":
        make(path, more[0] if more else None)
        return
    listed, needed, valid = check(path)
    schema = "valid by its schema" if valid else "not run: its schema, without cyclonedx-python-lib"
    print(f"{path}: {listed} packages, {needed} of them linked; {schema}")


if __name__ == "__main__":
    main()
