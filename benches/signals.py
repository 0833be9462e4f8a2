#!/usr/bin/env python3
"""Tests champions of a study of signals with cut parts and in smaller teams: signals.py FARSA FOLDER > FILE.csv

FARSA is the command and FOLDER holds the runs. The plan is in studies/signals-foraging.toml.
"""
import csv
import json
import re
import subprocess
import sys
from pathlib import Path

CUTS = ["output:red", "output:blue", "output:red,output:blue", "sensor:camera"]
TRIALS = "100"


def cases(farsa, run, *options):
    done = subprocess.run([farsa, "test", str(run), *options, "--json", "--quiet"], check=True, capture_output=True)
    return json.loads(done.stdout)["cases"]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    farsa, folder = sys.argv[1:]
    runs = [path.parent for path in Path(folder).rglob("record.bin")]
    if not runs:
        sys.exit(f"signals.py: {folder} holds no runs")
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["seed", "case", "trials", "fitness", "low", "high"])
    for run in sorted(runs, key=lambda run: int(re.search(r"(\d+)$", run.name)[1])):
        seed = run.name.rsplit("-", 1)[1]

        def write(name, case):
            low, high = case["fitness_interval"]
            out.writerow([seed, name, case["trials"], f"{case['fitness']:.4f}", f"{low:.4f}", f"{high:.4f}"])

        for number, cut in enumerate(CUTS):
            intact, silent = cases(farsa, run, "--trials", TRIALS, "--lesion", cut)
            if number == 0:
                write("intact", intact)
            write(cut.replace(",", " "), silent)
        experiment = json.loads((run / "manifest.json").read_text())["experiment"]
        info = subprocess.run([farsa, "info", experiment], check=True, capture_output=True, text=True)
        if "  team-size " in info.stdout:
            for case in cases(farsa, run, "--protocol", "team-size", "--trials", TRIALS):
                write(f"team of {case['row']}", case)


if __name__ == "__main__":
    main()
