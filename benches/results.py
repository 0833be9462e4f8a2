#!/usr/bin/env python3
"""Statistics of runs for docs/results/data.

  results.py best DIR...    of the best individuals of the last generation: mean, standard deviation, median, quartiles, range
  results.py near DIR...    of tests of discrimination-cylinders: shares of time near each cylinder, their difference, collisions

Each DIR holds the runs of a condition, those of `near` with their tests. Quartiles are at (n + 1)/4 and 3(n + 1)/4, and intervals are
those of Student's t with 95 %.
"""
import csv
import math
import re
import statistics
import sys
from pathlib import Path


def runs(folder):
    """The runs of a folder in the order of their seeds."""
    found = [path.parent for path in Path(folder).rglob("fitness.csv")]
    if not found:
        sys.exit(f"results.py: {folder} holds no runs")
    return sorted(found, key=lambda run: int(re.search(r"(\d+)$", run.name)[1]))


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def best(folders):
    yield ["", "mean", "sd", "median", "quartiles", "range"]
    for folder in folders:
        values = [float(table(run / "fitness.csv")[-1]["best"]) for run in runs(folder)]
        low, middle, high = statistics.quantiles(values, n=4)
        figures = [statistics.mean(values), statistics.stdev(values), middle]
        yield [
            Path(folder).name,
            *(f"{x:.6f}" for x in figures),
            f"{low:.6f} to {high:.6f}",
            f"{min(values):.6f} to {max(values):.6f}",
        ]


def near(folders):
    yield ["condition", "seed", "near the large", "near the small", "difference", "collisions"]
    for folder in folders:
        for run in runs(folder):
            trials = table(run / "test.csv")
            large, small = ([float(trial[name]) for trial in trials] for name in NEAR)
            differences = [a - b for a, b in zip(large, small)]
            mean = statistics.mean(differences)
            half = 1.962 * statistics.stdev(differences) / math.sqrt(len(differences))
            collisions = sum(float(trial["collisions"]) > 0 for trial in trials)
            yield [
                Path(folder).name,
                run.name.rsplit("-", 1)[1],
                f"{statistics.mean(large):.6f}",
                f"{statistics.mean(small):.6f}",
                f"{mean:+.6f} ({mean - half:+.6f} to {mean + half:+.6f})",
                collisions,
            ]


NEAR = ["near large", "near small"]
TABLES = {"best": best, "near": near}

if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in TABLES:
        sys.exit(__doc__)
    csv.writer(sys.stdout, lineterminator="\n").writerows(TABLES[sys.argv[1]](sys.argv[2:]))
