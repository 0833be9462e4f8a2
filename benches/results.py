#!/usr/bin/env python3
"""Statistics of runs for docs/results/data.

  results.py best DIR...          of the best individuals of the last generation: mean, standard deviation, median, quartiles, range
  results.py near FARSA DIR...    of tests of discrimination-cylinders: shares of time near each cylinder, their difference,
                                  collisions, and net turns around the large cylinder while near it, in 20 replayed trials

Each DIR holds the runs of a condition, those of `near` with their tests. Quartiles are at (n + 1)/4 and 3(n + 1)/4, and intervals are
those of Student's t with 95 %. FARSA is the command.
"""
import csv
import math
import re
import statistics
import subprocess
import sys
import tempfile
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


def centre(steps):
    """The place that has the written distances from the robot's places, by least squares."""
    (x0, y0, d0), *rest = steps
    sums = [0.0] * 5
    for x, y, d in rest:
        a, b, c = 2 * (x - x0), 2 * (y - y0), d0 * d0 - d * d + x * x - x0 * x0 + y * y - y0 * y0
        for k, product in enumerate([a * a, a * b, b * b, a * c, b * c]):
            sums[k] += product
    aa, ab, bb, ac, bc = sums
    determinant = aa * bb - ab * ab
    return (bb * ac - ab * bc) / determinant, (aa * bc - ab * ac) / determinant


def turns(farsa, run, trial):
    """Net turns around the large cylinder over the steps near it, without their sign."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "trial.csv"
        subprocess.run([farsa, "replay", run, "--trial", str(trial), "--out", path, "--quiet"], check=True)
        rows = table(path)
    steps = [[float(row[name]) for name in ("x [m]", "y [m]", DISTANCE)] for row in rows]
    x0, y0 = centre(steps)
    angles = [math.atan2(y - y0, x - x0) for x, y, _ in steps]
    near = [float(row["near the first"]) > 0 for row in rows]
    pairs = [(b - a) for a, b, here in zip(angles, angles[1:], near[1:]) if here]
    return abs(sum(math.remainder(change, 2 * math.pi) for change in pairs)) / (2 * math.pi)


def near(arguments):
    farsa, *folders = arguments
    yield ["condition", "seed", "near the large", "near the small", "difference", "collisions", "net turns: mean", "most"]
    for folder in folders:
        for run in runs(folder):
            trials = table(run / "test.csv")
            large, small = ([float(trial[name]) for trial in trials] for name in NEAR)
            differences = [a - b for a, b in zip(large, small)]
            mean = statistics.mean(differences)
            half = 1.962 * statistics.stdev(differences) / math.sqrt(len(differences))
            around = [turns(farsa, run, trial) for trial in range(20)]
            collisions = sum(float(trial["collisions"]) > 0 for trial in trials)
            yield [
                Path(folder).name,
                run.name.rsplit("-", 1)[1],
                f"{statistics.mean(large):.6f}",
                f"{statistics.mean(small):.6f}",
                f"{mean:+.6f} ({mean - half:+.6f} to {mean + half:+.6f})",
                collisions,
                f"{statistics.mean(around):.4f}",
                f"{max(around):.4f}",
            ]


DISTANCE = "distance of the centers to the first [m]"
NEAR = ["share of time near the first", "share of time near the other"]
TABLES = {"best": best, "near": near}

if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in TABLES:
        sys.exit(__doc__)
    csv.writer(sys.stdout, lineterminator="\n").writerows(TABLES[sys.argv[1]](sys.argv[2:]))
