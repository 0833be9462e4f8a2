#!/usr/bin/env python3
"""Counts successes and failures of the champions of reach-grasp-lift in their fresh trials:

    failures.py FOLDER > FILE.csv

FOLDER holds the runs of a study such as studies/labels.toml, whose plan names the classes. The sphere rests at a height of 2.5 cm. Of the
trials that do not succeed, the sphere of a `dropped` one was lifted to 5 cm. Of the others, `no reach` ends in the phase of reaching,
`clamped` holds the sphere on or above the table at the end, and the rest is `no grasp`. `lifted for 1 s` is the condition of the reward,
without a least height. Starts are numbered from 1, `fitness` is the mean of the trials, and `best` and `mean` are those of the last
generation.
"""
import csv
import json
import sys
from collections import Counter
from pathlib import Path

CLASSES = ["success", "no reach", "no grasp", "clamped", "dropped"]
REST = 2.5  # cm
LIFTED = 5.0  # cm


def kind(trial):
    if trial["success"] == "true":
        return "success"
    if float(trial["highest [cm]"]) >= LIFTED:
        return "dropped"
    if trial["phase"] == "reach":
        return "no reach"
    held = trial["lifted for 1 s"] == "true" or float(trial["height [cm]"]) > REST + 0.05
    return "clamped" if held else "no grasp"


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    rows = []
    for file in Path(sys.argv[1]).rglob("test.csv"):
        run = file.parent
        manifest = json.loads((run / "manifest.json").read_text())
        trials, generations = table(file), table(run / "fitness.csv")
        counts = Counter(map(kind, trials))
        starts = Counter(trial["trial"] for trial in trials if trial["success"] == "true")
        lifted = sum(trial["lifted for 1 s"] == "true" for trial in trials)
        fitness = sum(float(trial["fitness"]) for trial in trials) / len(trials)
        failures = [name for name in CLASSES[1:] if counts[name]]
        most = max(failures, key=lambda name: counts[name], default="")
        row = [manifest["condition"], manifest["seed"], *(counts[name] for name in CLASSES), most]
        row += [*(starts[str(start)] for start in range(4)), lifted, f"{fitness:.3f}"]
        rows.append([*row, *(f"{float(generations[-1][name]):.3f}" for name in ("best", "mean"))])
    if not rows:
        sys.exit(f"failures.py: {sys.argv[1]} holds no tested runs")
    out = csv.writer(sys.stdout, lineterminator="\n")
    starts = [f"start {start}" for start in range(1, 5)]
    out.writerow(["condition", "seed", *CLASSES, "most frequent failure", *starts, "lifted for 1 s", "fitness", "best", "mean"])
    out.writerows(sorted(rows, key=lambda row: (row[0], row[1])))


if __name__ == "__main__":
    main()
