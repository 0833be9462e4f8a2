"""CMA-ME of farsa-evo beside that of pyribs, on the planar arm of 12 joints, in one run.

    python -m venv env && env/bin/pip install ribs==0.12.0
    env/bin/python benches/arm_pyribs.py [SEEDS]

Both have a centroidal Voronoi tessellation of 10 000 cells, of 100 000 points, five improvement emitters of 30 individuals
with step size 0.1, bounds of -pi to pi, and 700 generations: 105 000 evaluations, as in the tutorial of pyribs on
repertoires of arms. Time is that of the search and its evaluations, without the tessellation. Seeds are 1 and on, 5 of them.
"""

import csv
import io
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ[f"{library}_NUM_THREADS"] = "1"

import numpy as np
from ribs.archives import CVTArchive
from ribs.emitters import EvolutionStrategyEmitter
from ribs.schedulers import Scheduler

JOINTS = 12


def of_farsa():
    """Cells and seconds of each seed, by the example `arm`."""
    command = ["cargo", "run", "--quiet", "--release", "-p", "farsa-evo", "--example", "arm"]
    root = Path(__file__).resolve().parent.parent
    lines = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True).stdout
    rows = list(csv.DictReader(io.StringIO(lines)))
    return [int(row["cells"]) for row in rows], [float(row["seconds"]) for row in rows]


def judge(angles):
    sums = np.cumsum(angles, axis=1)
    places = np.stack((np.cos(sums).sum(axis=1), np.sin(sums).sum(axis=1)), axis=1)
    return -np.var(angles, axis=1), places


def of_pyribs(seed):
    reach = (-JOINTS, JOINTS)
    archive = CVTArchive(solution_dim=JOINTS, centroids=10_000, ranges=[reach, reach], samples=100_000, seed=seed)
    emitters = [
        EvolutionStrategyEmitter(
            archive,
            x0=np.zeros(JOINTS),
            sigma0=0.1,
            ranker="2imp",
            lower_bounds=np.full(JOINTS, -np.pi),
            upper_bounds=np.full(JOINTS, np.pi),
            batch_size=30,
            seed=100 * seed + number,
        )
        for number in range(5)
    ]
    scheduler = Scheduler(archive, emitters)
    start = time.perf_counter()
    for _ in range(700):
        scheduler.tell(*judge(scheduler.ask()))
    return len(archive), time.perf_counter() - start


def line(name, cells, seconds):
    counts = f"{min(cells)} to {max(cells)}, median {statistics.median(cells)}"
    print(f"{name}: {counts} cells; {statistics.median(seconds):.3f} s (fastest {min(seconds):.3f})", flush=True)


def main():
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    line("farsa ", *of_farsa())
    theirs = [of_pyribs(seed) for seed in range(1, seeds + 1)]
    line("pyribs", *zip(*theirs))


if __name__ == "__main__":
    main()
