#!/usr/bin/env python3
"""Tests champions of a study of signals with cut parts, or in teams of other sizes:

    signals.py FARSA FOLDER > FILE.csv
    signals.py FARSA FOLDER teams > FILE.csv
    signals.py summary FILE.csv > SUMMARY.csv

FARSA is the command and FOLDER holds the runs. The plan is in studies/signals-foraging.toml. Cells are the mean fitness of fresh trials with
its 95 % interval, and for teams the mean per robot. A summary has a row for each case, with the means of the seeds and their median.
"""
import csv
import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

CUTS = {"red": "output:red", "blue": "output:blue", "both": "output:red,output:blue", "camera": "sensor:camera"}
SIZES = ["1", "2", "4", "8", "10"]
CUTS_OF_EXCHANGE = {"said": "output:said", "heard": "sensor:heard"}


def cases(farsa, run, *options):
    done = subprocess.run([farsa, "test", str(run), *options, "--json", "--quiet"], check=True, capture_output=True)
    return json.loads(done.stdout)["cases"]


def cell(case):
    low, high = case["fitness_interval"]
    return f"{case['fitness']:.2f} ({low:.2f} to {high:.2f})"


def cut(farsa, run, trials, cuts):
    cells = {}
    for name, parts in cuts.items():
        intact, silent = cases(farsa, run, "--trials", trials, "--lesion", parts)
        cells["intact"] = cell(intact)
        cells[f"without {name}"] = cell(silent)
    return cells


def teams(farsa, run, experiment):
    if experiment == "aggregation":
        # Its fitness is a mean of the robots, and it has no protocol of team sizes.
        with tempfile.TemporaryDirectory() as folder:
            genes = str(Path(folder) / "champion.gen")
            subprocess.run([farsa, "export", "genotype", str(run), "--out", genes, "--quiet"], check=True)
            command = [farsa, "evaluate", experiment, "--genes-file", genes, "--trials", "100", "--json"]
            sizes = {size: [*command, "--set", f"team.robots={size}"] for size in SIZES}
            done = {size: subprocess.run(words, check=True, capture_output=True) for size, words in sizes.items()}
            return {size: f"{json.loads(one.stdout)['mean_fitness']:.2f}" for size, one in done.items()}
    sizes = cases(farsa, run, "--protocol", "team-size", "--trials", "100")
    return {case["row"]: f"{case['fitness'] / int(case['row']):.2f}" for case in sizes}


def summary(file):
    with open(file, newline="") as source:
        rows = list(csv.DictReader(source))
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["case", f"seeds {rows[0]['seed']} to {rows[-1]['seed']}", "median"])
    for case in list(rows[0])[1:]:
        means = [row[case].split(" ")[0] for row in rows]
        out.writerow([case, ", ".join(means), f"{statistics.median(map(float, means)):.3f}"])


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "summary":
        summary(sys.argv[2])
        return
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["teams"]):
        sys.exit(__doc__)
    farsa, folder = sys.argv[1:3]
    rows = {}
    for run in (path.parent for path in Path(folder).rglob("record.bin")):
        seed = int(re.search(r"(\d+)$", run.name)[1])
        manifest = json.loads((run / "manifest.json").read_text())
        row = rows.setdefault(seed, {})
        if sys.argv[3:]:
            row.update(teams(farsa, run, manifest["experiment"]))
        elif manifest["condition"] == "silent":
            # Nothing to cut. The sweep has tested it.
            row["silent"] = cell(json.loads((run / "test.json").read_text())["results"])
        elif manifest["experiment"] == "exchange":
            row.update(cut(farsa, run, "200", CUTS_OF_EXCHANGE))
        else:
            row.update(cut(farsa, run, "100", CUTS))
    if not rows:
        sys.exit(f"signals.py: {folder} holds no runs")
    first = rows[min(rows)]
    names = sorted(first, key=int) if sys.argv[3:] else [*(name for name in first if name != "silent"), *(["silent"] if "silent" in first else [])]
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["seed", *names])
    for seed in sorted(rows):
        out.writerow([seed, *(rows[seed].get(name, "") for name in names)])


if __name__ == "__main__":
    main()
