#!/usr/bin/env python3
"""Seconds of a generation, without evaluations, beside pycma and numpy in the same run.

python3 benches/generation_cost.py [GENERATIONS [ROUNDS]]

needs `cma` and `numpy`, and cargo. Rounds alternate between the two sides, each in a process of its own with one thread; the
least of the medians of all rounds stands in the table, because other work on the machine only adds to them. Of covariance
matrix adaptation means are compared, as axes are not computed in every generation. numpy does what `tell` and `ask` do: it
draws 100 rows of 10^5 standard normal numbers, mirrors them around the mean, and adds them up weighted by their ranks; of the
optimiser there is a plain step. The genetic algorithm has no peer; its limit is a millisecond.
"""

import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def peer(name, generations):
    import numpy as np

    if "cma-es" in name:
        import cma

        options = {"verbose": -9, "seed": 1, "CMA_diagonal": name.startswith("separable")}
        search = cma.CMAEvolutionStrategy(792 * [0.0], 0.5, options)
        seconds = []
        for generation in range(generations + 2):
            start = time.perf_counter()
            points = search.ask()
            search.tell(points, [float((i * 7919) % len(points)) for i in range(len(points))])
            if generation > 1:
                seconds.append(time.perf_counter() - start)
        return sum(seconds) / len(seconds)
    random, genes, pairs, sigma = np.random.default_rng(1), 100_000, 100, 0.1
    mean, seconds = np.zeros(genes), []
    for _ in range(generations + 2):
        start = time.perf_counter()
        noise = random.standard_normal((pairs, genes))
        points = np.concatenate([mean + sigma * noise, mean - sigma * noise])
        values = np.array([float((i * 7919) % len(points)) for i in range(len(points))])
        ranks = values.argsort().argsort() / (len(points) - 1) - 0.5
        weights = ranks[:pairs] - ranks[pairs:]
        mean = mean + 0.01 / (2 * pairs * sigma) * (weights @ noise)
        if name == "pgpe":
            shape = (ranks[:pairs] + ranks[pairs:]) @ (noise * noise - 1.0)
            mean = mean + 0.0 * shape
        seconds.append(time.perf_counter() - start)
    return sorted(seconds[2:])[len(seconds[2:]) // 2]


def main():
    if len(sys.argv) > 2 and sys.argv[1] == "--peer":
        print(peer(sys.argv[2], int(sys.argv[3])))
        return
    generations = sys.argv[1] if len(sys.argv) > 1 else "40"
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")
    command = ["cargo", "build", "--release", "-q", "-p", "farsa-evo", "--example", "generation_cost"]
    subprocess.run(command, cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    program = target / "release" / "examples" / "generation_cost"
    print("| strategy | genes | individuals | farsa-evo [ms] | peer [ms] | ratio |")
    print("|---|---|---|---|---|---|")
    for name in ("ga", "cma-es", "cholesky-cma-es", "separable-cma-es", "open-ai-es", "ars", "pgpe"):
        ours, theirs = [], []
        for _ in range(rounds):
            words = subprocess.check_output([program, generations, name], text=True).split()
            ours.append(float(words[5] if "cma" in name else words[3]))
            if name != "ga":
                said = subprocess.check_output(
                    [sys.executable, __file__, "--peer", name, generations], text=True, env=environment
                )
                theirs.append(float(said))
        mine = 1000 * min(ours)
        other = f"{1000 * min(theirs):.2f} | {mine / (1000 * min(theirs)):.2f}" if theirs else "- | -"
        print(f"| {name} | {words[1]} | {words[2]} | {mine:.2f} | {other} |", flush=True)


if __name__ == "__main__":
    main()
