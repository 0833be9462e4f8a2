#!/usr/bin/env python3
"""Times the iCub's upper body in both programs, pinned to one processor and in turns, and prints tables; called by run.

    upper_body.py FOLDER PROGRAM [ROUNDS [SECONDS]]
    upper_body.py FOLDER time PHASE SECONDS      MuJoCo alone: microseconds per step, contacts, solver iterations"""

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

FOLDER = Path(sys.argv[1])
PHASES = ["free", "random"]
SUBSTEPS = 4  # of 2.5 ms in a control step


def mujoco_alone(phase, seconds):
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(FOLDER / "icub.xml"))
    data = mujoco.MjData(model)
    names, start, *commands = [line.split() for line in (FOLDER / f"icub-{phase}.txt").read_text().splitlines()]
    start = [float(x) for x in start]
    commands = [[float(x) for x in row] for row in commands]
    joints = [model.joint(name) for name in names]
    actuators = [model.actuator(name).id for name in names]
    assert model.nv == model.nu == len(names)
    least = [float("inf")] * len(commands)
    contacts = iterations = count = 0
    begin = time.perf_counter()
    while time.perf_counter() - begin < seconds:
        mujoco.mj_resetData(model, data)
        for joint, angle in zip(joints, start):
            data.qpos[joint.qposadr[0]] = angle
        for step, row in enumerate(commands):
            data.ctrl[actuators] = row
            before = time.perf_counter_ns()
            mujoco.mj_step(model, data, SUBSTEPS)
            least[step] = min(least[step], time.perf_counter_ns() - before)
            contacts += data.ncon
            iterations += data.solver_niter[0]
            count += 1
    bad = data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number
    print(sum(least) / len(least) / 1e3 / SUBSTEPS, contacts / count, iterations / count, bad)


def pinned(*words):
    processor = str(max(os.sched_getaffinity(0)))
    return subprocess.run(["taskset", "-c", processor, *words], capture_output=True, text=True, check=True).stdout


def row(*cells):
    print("| " + " | ".join(cells) + " |")


def head(*cells):
    row(*cells)
    print("|" + "---|" * len(cells))


def spread(values):
    return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


def main():
    program = sys.argv[2]
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    seconds = sys.argv[4] if len(sys.argv) > 4 else "0.5"
    ours, theirs, touching = {}, {}, {}
    for number in range(rounds):
        for line in pinned(program, "time", seconds).splitlines():
            name, joints, pairs, lanes, phase, spent, touches = line.split("\t")
            ours.setdefault((int(joints), name, pairs, lanes), {}).setdefault(phase, []).append(float(spent))
            touching[name, phase] = touches
        for phase in PHASES:
            told = pinned(sys.executable, __file__, str(FOLDER), "time", phase, seconds)
            theirs.setdefault(phase, []).append([float(x) for x in told.split()])
        print(f"round {number + 1} of {rounds}", file=sys.stderr)
    print(f"{rounds} rounds of {seconds} s: median (least to most), microseconds per world and dynamics step of 2.5 ms.\n")
    head("robot", "joints", "pairs", "lanes", "no pairs", *PHASES, "pairs that touch: " + ", ".join(PHASES))
    for (joints, name, pairs, lanes), found in sorted(ours.items(), key=lambda item: (item[0][3], item[0][0])):
        touches = ", ".join(touching[name, phase] for phase in PHASES)
        row(name, str(joints), pairs, lanes, *(spread(found[phase]) for phase in ["no pairs", *PHASES]), touches)
    for phase, found in theirs.items():
        steps = spread([told[0] for told in found])
        contacts, iterations, bad = (statistics.median(told[k] for told in found) for k in (1, 2, 3))
        print(f"\nMuJoCo, iCub, {phase}: {steps}; {contacts:.1f} contacts, {iterations:.1f} iterations, {bad:.0f} warnings")
        for (joints, name, _, lanes), times in ours.items():
            if name == "iCub":
                ratio = statistics.median(told[0] for told in found) / statistics.median(times[phase])
                print(f"MuJoCo : FARSA, {lanes}: {ratio:.1f}")


if __name__ == "__main__":
    if sys.argv[2] == "time":
        mujoco_alone(sys.argv[3], float(sys.argv[4]))
    else:
        main()
