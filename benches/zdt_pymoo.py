"""NSGA-II of farsa-evo beside that of pymoo, on ZDT1 to 4 and 6, in one run.

    python -m venv env && env/bin/pip install pymoo==0.6.2
    env/bin/python benches/zdt_pymoo.py [--defaults]

Both have 100 individuals, 25 000 evaluations, and the settings of Deb and others (2002): crossover with probability 0.9
and index 20, mutation of one gene in a genome with index 20. With --defaults pymoo has its own index of crossover, 15.
Seeds are 1 to 11. The hypervolume is above (1.1, 1.1), by pymoo for pymoo and by farsa-evo for farsa-evo.
"""

import csv
import io
import statistics
import subprocess
import sys
import time
from pathlib import Path

from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.indicators.hv import HV
from pymoo.operators.crossover.sbx import SBX
from pymoo.operators.mutation.pm import PM
from pymoo.optimize import minimize
from pymoo.problems import get_problem

SEEDS = range(1, 12)


def of_farsa():
    """Hypervolume and seconds of each problem and seed, by the example `zdt`."""
    command = ["cargo", "run", "--quiet", "--release", "-p", "farsa-evo", "--example", "zdt"]
    root = Path(__file__).resolve().parent.parent
    lines = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True).stdout
    found = {}
    for row in csv.DictReader(io.StringIO(lines)):
        volumes, seconds = found.setdefault(row["problem"], ([], []))
        volumes.append(float(row["hypervolume"]))
        seconds.append(float(row["seconds"]))
    return found


def of_pymoo(name, seed, eta):
    problem = get_problem(name)
    algorithm = NSGA2(pop_size=100, crossover=SBX(prob=0.9, eta=eta), mutation=PM(eta=20))
    start = time.perf_counter()
    result = minimize(problem, algorithm, ("n_eval", 25_000), seed=seed, verbose=False)
    seconds = time.perf_counter() - start
    assert result.algorithm.evaluator.n_eval == 25_000
    return HV(ref_point=[1.1, 1.1])(result.F), seconds


def main():
    eta = 15 if "--defaults" in sys.argv else 20
    ours = of_farsa()
    print("problem  farsa: median, lowest, seconds  pymoo: median, lowest, seconds  ratio of medians, of means")
    for name, (volumes, seconds) in ours.items():
        theirs = [of_pymoo(name, seed, eta) for seed in SEEDS]
        other = [volume for volume, _ in theirs]
        time_of = statistics.median(seconds), statistics.median(seconds for _, seconds in theirs)
        medians = statistics.median(volumes), statistics.median(other)
        print(
            f"{name}  {medians[0]:.4f} {min(volumes):.4f} {time_of[0]:.3f}"
            f"  {medians[1]:.4f} {min(other):.4f} {time_of[1]:.2f}"
            f"  {medians[0] / medians[1]:.4f} {statistics.mean(volumes) / statistics.mean(other):.4f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
