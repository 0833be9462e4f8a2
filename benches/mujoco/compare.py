#!/usr/bin/env python3
"""Runs both programs pinned to one processor and in turns, and prints the tables; called by run.

    compare.py TARGET PROGRAM times|errors|outcomes|all [ROUNDS [SECONDS]]

What times and errors measured is kept in TARGET/mujoco, for the tables that need both."""

import json
import math
import os
import statistics
import subprocess
import sys
from pathlib import Path

OUT = Path(sys.argv[1]) / "mujoco"
OURS = sys.argv[2]
PART = sys.argv[3] if len(sys.argv) > 3 else "all"
ROUNDS = int(sys.argv[4]) if len(sys.argv) > 4 else 5
SECONDS = sys.argv[5] if len(sys.argv) > 5 else "0.5"
PHASES = ["free", "waves", "table", "grasp"]
COMPARED = ["free", "waves", "table"]  # whose errors are compared: in the grasp outcomes differ, not angles
# What is measured, and with how many steps per control step of 10 ms.
FARSA, LANES8, LANES16, MUJOCO = "FARSA, one world", "FARSA, 8 lanes AVX2", "FARSA, 16 lanes AVX-512", "MuJoCo"
STEPS = {FARSA: [1, 2, 4, 5, 10], LANES8: [1, 2, 4, 5, 10], LANES16: [1, 2, 4, 5, 10], MUJOCO: [1, 2, 4, 5, 10]}
DEFAULT, FAST = 4, 2
REFERENCE = 200  # 0.05 ms
EQUAL = 0.5  # RMS over the arm's joints and the phase [deg]

processor = str(max(os.sched_getaffinity(0)))


# Whose outcomes are compared: name, steps per control step, and the model for MuJoCo.
ROBOT, ROBOT_2MS = "robot.xml", "robot-2ms.xml"
PLAYED = [
    ("FARSA, 2.5 ms", 4, None),
    ("FARSA, 5 ms", 2, None),
    ("FARSA, 0.5 ms", 20, None),
    ("MuJoCo, 10 ms", 1, ROBOT),
    ("MuJoCo, 2 ms", 5, ROBOT),
    ("MuJoCo, 2 ms, contacts for 2 ms", 5, ROBOT_2MS),
]
STARTS = 100
# What the script knows of the sphere's place, and by how much that is displaced along x and y [cm].
GRASPS = [("seen", 1.5), ("blind", 3)]


def run(engine, verb, phase, steps, *more):
    file = str(OUT / f"{phase}.txt")
    if engine == MUJOCO:
        words = [str(OUT / "step_mujoco"), str(OUT / "robot.xml"), file, verb, str(steps), *(more or ["0"])]
    elif engine == FARSA or verb == "trace":
        words = [OURS, verb, file, str(steps), *more]
    else:
        words = [OURS, "lanes", file, str(steps), *more, "8" if engine == LANES8 else "16"]
    done = subprocess.run(["taskset", "-c", processor, *words], capture_output=True, text=True, check=True)
    return [[float(x) for x in line.split()] for line in done.stdout.splitlines()]


def play(engine, *script):
    _, steps, model = engine
    theirs = [str(OUT / "step_mujoco"), str(OUT / model)] if model else []
    done = subprocess.run([OURS, *script, str(steps), *theirs], capture_output=True, text=True, check=True)
    return [[float(x) for x in line.split()] for line in done.stdout.splitlines()]


def keep(name, found):
    (OUT / name).write_text(json.dumps([[key, value] for key, value in found.items()]))


def kept(name):
    """What an earlier part found; nothing if it has not run."""
    if not (OUT / name).exists():
        return {}
    pairs = json.loads((OUT / name).read_text())
    return {tuple(key) if isinstance(key, list) else key: value for key, value in pairs}


def milliseconds(steps):
    return f"{10 / steps:g} ms"


def times():
    """For each phase, engine and number of steps what each round printed; nothing for lanes that do not run here."""
    found = {}
    for number in range(ROUNDS):
        for phase in PHASES:
            for engine, kinds in STEPS.items():
                for steps in kinds:
                    for row in run(engine, "time", phase, steps, SECONDS):
                        found.setdefault((phase, engine, steps), []).append(row)
        print(f"round {number + 1} of {ROUNDS}", file=sys.stderr)
    return found


def median(rows, column=0):
    return statistics.median(row[column] for row in rows)


def error(path, truth):
    square = [(a - b) ** 2 for p, t in zip(path, truth) for a, b in zip(p, t)]
    return math.sqrt(sum(square) / len(square))


def errors():
    found = {}
    for phase in COMPARED:
        truths = {}
        for engine in [FARSA, MUJOCO]:
            truth = run(engine, "trace", phase, REFERENCE, *(["f64"] if engine == FARSA else []))
            for steps in STEPS[engine]:
                found[phase, engine, steps] = error(run(engine, "trace", phase, steps), truth)
            truths[engine] = truth
        found[phase] = error(truths[FARSA], truths[MUJOCO])
        for lanes in [LANES8, LANES16]:  # the same bits
            for steps in STEPS[lanes]:
                found[phase, lanes, steps] = found[phase, FARSA, steps]
    return found


def cost_at(points):
    """Time at the error EQUAL, between its neighbours in logarithms; of the coarsest step, the first, if that is good
    enough: errors need not fall with the step."""
    if points[0][0] <= EQUAL:
        return points[0][1]
    for (e1, t1), (e2, t2) in zip(points, points[1:]):
        if e2 <= EQUAL:
            return t1 * math.exp(math.log(EQUAL / e1) / math.log(e2 / e1) * math.log(t2 / t1))
    return math.nan


def row(*cells):
    print("| " + " | ".join(cells) + " |")


def head(*cells):
    row(*cells)
    print("|" + "---|" * len(cells))


def print_times(measured):
    engines = [engine for engine in STEPS if ("grasp", engine, DEFAULT) in measured]
    ours = [engine for engine in engines if engine != MUJOCO]
    print(f"{ROUNDS} rounds of {SECONDS} s, interleaved: median (least to most), microseconds per world and 10 ms.\n")
    head("engine, step", *PHASES)
    for engine, steps in [*((e, s) for e in ours for s in (DEFAULT, FAST)), (MUJOCO, 1), (MUJOCO, 5)]:
        cells = []
        for phase in PHASES:
            rows = measured[phase, engine, steps]
            least, most = min(r[0] for r in rows), max(r[0] for r in rows)
            cells.append(f"{median(rows):.1f} ({least:.1f} to {most:.1f})")
        row(f"{engine}, {milliseconds(steps)}", *cells)
    print("\nMuJoCo's time divided by ours:\n")
    head("MuJoCo : ours", *PHASES)
    for engine in ours:
        for steps in (DEFAULT, FAST):
            for theirs in (1, 5):
                cells = [f"{median(measured[p, MUJOCO, theirs]) / median(measured[p, engine, steps]):.2f}" for p in PHASES]
                row(f"{milliseconds(theirs)} : {engine}, {milliseconds(steps)}", *cells)
    pairs = (OUT / ROBOT).read_text().count("<pair ")
    print(f"\nMeans over the phase; of {pairs} pairs all are tested by their bounds in every step of ours:\n")
    head("phase", "engine, step", "pairs that touch", "contact points", "rows", "solver iterations", "sphere slipped [mm]")
    for phase in PHASES:
        for engine, steps in [(FARSA, DEFAULT), (FARSA, FAST), (MUJOCO, 1), (MUJOCO, 5)]:
            rows = measured[phase, engine, steps]
            slip = f"{median(rows, 3 if engine == FARSA else 4):.3f}" if phase == "grasp" else ""
            points = f"{median(rows, 1):.1f}"
            if engine == FARSA:
                cells = [f"{median(rows, 2):.1f}", points, "", "10 sweeps"]
            else:
                cells = ["", points, f"{median(rows, 2):.0f}", f"{median(rows, 3):.1f}"]
            row(phase, f"{engine}, {milliseconds(steps)}", *cells, slip)


def print_errors(off, measured):
    """Without times where none are known."""
    engines = [e for e in STEPS if ("grasp", e, DEFAULT) in measured or (not measured and e in (FARSA, MUJOCO))]
    beside = ", and microseconds per 10 ms" if measured else " (no times: part times has not run)"
    print(f"\nRMS error of J1 to J7 [deg] against the engine's own 0.05 ms{beside}:\n")
    steps = STEPS[MUJOCO]
    head("phase", "engine", *map(milliseconds, steps), f"us at {EQUAL} deg", "MuJoCo : ours")
    for phase in COMPARED:
        points = {e: [(off[phase, e, s], median(measured[phase, e, s])) for s in steps] for e in engines if measured}
        costs = {engine: cost_at(points[engine]) for engine in points}
        for engine in engines:
            cells = [f"{off[phase, engine, s]:.4f}" for s in steps]
            if not measured:
                row(phase, engine, *cells, "", "")
                continue
            cells = [f"{cell}, {median(measured[phase, engine, s]):.1f}" for cell, s in zip(cells, steps)]
            ratio = "" if engine == MUJOCO else f"{costs[MUJOCO] / costs[engine]:.1f}"
            row(phase, engine, *cells, f"{costs[engine]:.2f}", ratio)
    between = ", ".join(f"{phase} {off[phase]:.1e} deg" for phase in COMPARED)
    print(f"\nThe two references differ by (RMS): {between}.")


def print_outcomes():
    grasps = {}
    for knowledge, cm in GRASPS:
        for engine in PLAYED:
            grasps[knowledge, cm, engine[0]] = play(engine, "grasps", str(STARTS), knowledge, str(cm))
    head("", "allowed", *(engine[0] for engine in PLAYED))
    for name, script, limit in [("resting sphere", "rest", 500), ("fingertip, 5 N", "press", 1000)]:
        found = [play(engine, script)[0] for engine in PLAYED]
        row(f"{name} sinks [um]", str(limit), *(f"{depth:.2f}" for depth, _ in found))
        row(f"{name}: force [N]", "", *(f"{force:.4f}" for _, force in found))
    held = [[r for r in grasps[*GRASPS[0], engine[0]] if r[0]] for engine in PLAYED]
    row("held sphere slips in 5 s [mm], median", "2", *(f"{median(rows, 1):.2f}" for rows in held))
    row("most of 100 grasps", "2", *(f"{max(r[1] for r in rows):.2f}" for rows in held))
    for knowledge, cm in GRASPS:
        print(f"\n{STARTS} starts, sphere displaced by up to {cm} cm, {knowledge} by the script:\n")
        own = PLAYED[0][0]
        columns = ["held", "both", f"only {own}", "only this", "neither"]
        slips = ["slipped in 5 s [mm]: median", "most", "more than 2 mm"]
        head("engine, step", *columns, *slips, "deepest contact [mm]: median", "most")
        first = grasps[knowledge, cm, own]
        for name, _, _ in PLAYED:
            rows = grasps[knowledge, cm, name]
            pairs = [(int(a[0]), int(b[0])) for a, b in zip(first, rows)]
            counts = ["" if name == own else str(pairs.count(kind)) for kind in [(1, 1), (1, 0), (0, 1), (0, 0)]]
            up = [r for r in rows if r[0]]
            slipped = [f"{median(up, 1):.2f}", f"{max(r[1] for r in up):.2f}", str(sum(r[1] > 2 for r in up))]
            deep = [f"{median(up, 2) / 1e3:.2f}", f"{max(r[2] for r in up) / 1e3:.2f}"]
            row(name, str(len(up)), *counts, *slipped, *deep)


def main():
    if PART in ("times", "all"):
        keep("times.json", times())
        print_times(kept("times.json"))
    if PART in ("errors", "all"):
        keep("errors.json", errors())
    if PART in ("times", "errors", "all") and (off := kept("errors.json")):
        print_errors(off, kept("times.json"))
    if PART in ("outcomes", "all"):
        print_outcomes()


if __name__ == "__main__":
    main()
