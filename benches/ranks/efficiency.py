#!/usr/bin/env python3
"""How fast ranks are beside threads, measured here, and computed for more ranks.

python3 benches/ranks/efficiency.py [GENERATIONS [ROUNDS [EXPERIMENT]]]

FARSA and FARSA_MPI name the two commands (release builds). Each round runs one thread, two threads, and two ranks of one thread
one after the other; medians of the rounds count, in seconds of the run's own session (manifest.json), so that starting MPI is not
part of it. Beyond that a generation of n trials of t seconds on P ranks with L lanes takes

    n t / P  +  L t  +  s

seconds: its share of the trials, at most one trial of the last lane to be filled (a batch of L trials takes L t), and the work s
that each rank does alone (selection, files, meetings). t and s follow from the runs of one thread with all and with a fifth of the
individuals.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path


def seconds(command, out):
    subprocess.run([*command, "--out", out, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    sessions = json.loads((Path(out) / "manifest.json").read_text())["sessions"]
    return sum(session["seconds"] for session in sessions)


def main():
    generations = sys.argv[1] if len(sys.argv) > 1 else "20"
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    experiment = sys.argv[3] if len(sys.argv) > 3 else "reach-grasp-lift"
    farsa, ranks = os.environ.get("FARSA", "farsa"), os.environ.get("FARSA_MPI", "farsa-mpi")
    mpirun = ["mpirun", "--allow-run-as-root", "--bind-to", "core", "-n", "2", ranks]
    run = ["run", experiment, "--generations", generations]
    info = json.loads(subprocess.check_output([farsa, "info", experiment, "--json"]))
    population, trials = 100, info["trials"]
    few = ["--population", "20", "--set", "evolution.parents=4"]
    kinds = {
        "one thread": [farsa, *run, "--threads", "1", "--population", str(population)],
        "one thread, a fifth of the individuals": [farsa, *run, "--threads", "1", *few],
        "two threads": [farsa, *run, "--threads", "2", "--population", str(population)],
        "two ranks": [*mpirun, *run, "--threads", "1", "--population", str(population)],
    }
    found = {kind: [] for kind in kinds}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(rounds):
            for kind, command in kinds.items():
                found[kind].append(seconds(command, f"{folder}/{number}-{kind}".replace(" ", "-")) / int(generations))
    median = {kind: statistics.median(values) for kind, values in found.items()}
    for kind, value in median.items():
        print(f"{kind}: {1000 * value:.1f} ms a generation, {min(found[kind]) * 1000:.1f} to {max(found[kind]) * 1000:.1f}")
    print(f"two ranks have {median['two threads'] / median['two ranks']:.3f} of the speed of two threads")
    one, fifth = median["one thread"], median["one thread, a fifth of the individuals"]
    n = population * trials
    t = (one - fifth) / (n - 20 * trials)
    s = max(0.0, one - n * t)
    print(f"t = {1000 * t:.2f} ms a trial, s = {1000 * s:.1f} ms a generation, n = {n}")
    print("| ranks | 8 lanes: ms a generation | efficiency | 16 lanes: ms a generation | efficiency |")
    print("|---|---|---|---|---|")
    for count in (1, 2, 4, 8, 16, 32, 64):
        row = []
        for lanes in (8, 16):
            time = n * t / count + (lanes * t if count > 1 else 0.0) + s
            row.append(f"{1000 * time:.0f} | {one / (count * time):.2f}")
        print(f"| {count} | {' | '.join(row)} |")


if __name__ == "__main__":
    main()
