#!/usr/bin/env python3
"""Runs an evolved controller in MuJoCo, with sensors, network, muscles and judge of this script's own.

    champion.py check MODEL.xml CONTROLLER.json TRIAL.csv
    champion.py test MODEL.xml CONTROLLER.json STARTS.json [--step S]... [--beside NAME=test.csv]...

Commands for a test:

    farsa run reach-grasp-lift --seed 1 --out run
    farsa test run --trials 100
    farsa export robot reach-grasp-lift --format mjcf --out robot.xml
    farsa export controller run --format json --out controller.json
    farsa export starts run --trials 100 --format json --out starts.json
    champion.py test robot.xml controller.json starts.json --beside ours=run/test.csv

A check of the sensors records a trial with converged contacts (400 sweeps instead of 10):

    farsa run reach-grasp-lift --seed 1 --generations 2 --set world.sweeps=400 --out converged
    farsa replay converged --out converged.csv
    farsa export controller converged --format json --out converged.json
    champion.py check robot.xml converged.json converged.csv

Nothing here shares code with FARSA; what
is restated (phases, muscles, network) follows the printed equations. See README.md."""

import argparse
import csv
import json
import sys

import mujoco
import numpy as np

CHECKED = 100
TOLERANCE = 1e-5
# How far before the surfaces meet a pair is looked at [m].
NEAR = 2e-3


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


class Network:
    """H = leak of sigma(bias + sensors + recurrence), O = sigma(weights H)."""

    def __init__(self, data):
        n, h, o = data["inputs"], data["hidden"], data["outputs"]
        self.slope, self.leak = data["slope"], data["leak"]
        self.sensor_weights = np.array(data["sensor_weights"]).reshape(n, h)
        self.recurrent_weights = np.array(data["recurrent_weights"]).reshape(h, h)
        self.output_weights = np.array(data["output_weights"]).reshape(h, o)
        self.biases, self.leaks = np.array(data["biases"]), np.array(data["leaks"])
        self.reset()

    def reset(self):
        self.hidden = np.zeros_like(self.biases)
        self.before = np.zeros_like(self.biases)

    def sigma(self, x):
        return 1 / (1 + np.exp(-self.slope * x))

    def step(self, x):
        y = self.sigma(self.biases + x @ self.sensor_weights + self.hidden @ self.recurrent_weights)
        d = self.leaks
        self.hidden = {
            "filter": d * y + (1 - d) * self.hidden,
            "two-tap": d * y + (1 - d) * self.before,
            "evonet": d * self.hidden + (1 - d) * y,
        }[self.leak]
        self.before = y
        return self.sigma(self.hidden @ self.output_weights)


class Scene:
    """The model, its state and what is read from it."""

    def __init__(self, path, substeps=None, control_step=0.01):
        self.model = mujoco.MjModel.from_xml_path(path)
        if substeps:
            self.model.opt.timestep = control_step / substeps
        self.substeps = round(control_step / self.model.opt.timestep)
        self.data = mujoco.MjData(self.model)

    def joint(self, name):
        """Where a joint's position and speed lie."""
        joint = self.model.joint(name)
        return joint.qposadr[0], joint.dofadr[0]

    def place(self, joints, bodies):
        """Joints: name, position and, if they move, speed. Free bodies, not turned: name, place of the origin, velocity, rotation."""
        mujoco.mj_resetData(self.model, self.data)
        for name, *state in joints:
            for to, at, value in zip((self.data.qpos, self.data.qvel), self.joint(name), state):
                to[at] = value
        for name, at, *twist in bodies:
            joint = self.model.body(name).jntadr[0]
            position, speed = self.model.jnt_qposadr[joint], self.model.jnt_dofadr[joint]
            self.data.qpos[position : position + 7] = [*at, 1, 0, 0, 0]
            if twist:
                self.data.qvel[speed : speed + 6] = np.ravel(twist)
        mujoco.mj_forward(self.model, self.data)

    def point(self, of):
        body = self.data.body(of["body"])
        return body.xpos + body.xmat.reshape(3, 3) @ np.array(of["at"])

    def loads(self, surfaces, joints, bodies):
        """Normal forces [N] of the dynamics step that has led to a state, by the law of the exported surfaces, for pairs of geoms
        near each other: stiffness * depth at its end, by the normal at its beginning, - damping * the speed at which they
        part then, if they overlapped before. A step moves by the speeds at its end: so it began at q - h v."""
        h = self.model.opt.timestep
        before = [(name, q - h * speed, speed) for name, q, speed in joints]
        self.place(before, [(name, np.subtract(at, h * np.array(v)), v, w) for name, at, v, w in bodies])
        loads, jacobian = {}, np.zeros((2, 3, self.model.nv))
        for contact in self.data.contact:
            pair = frozenset(contact.geom.tolist())
            for body, rows in zip(self.model.geom_bodyid[contact.geom], jacobian):
                mujoco.mj_jac(self.model, self.data, rows, None, contact.pos, body)
            # MuJoCo's normal points from the first geom to the second.
            parting = contact.frame[:3] @ (jacobian[1] - jacobian[0]) @ self.data.qvel
            stiffness, damping = surfaces[pair]
            load = -stiffness * (contact.dist + h * parting) - damping * parting * (contact.dist <= 0)
            loads[pair] = max(loads.get(pair, -np.inf), load)
        return loads

    def touching(self):
        """Pairs of geoms with a normal force between them."""
        force, pairs = np.zeros(6), set()
        for i, pair in enumerate(self.data.contact.geom.tolist()):
            mujoco.mj_contactForce(self.model, self.data, i, force)
            if force[0] > 0:
                pairs.add(frozenset(pair))
        return pairs

    def gap(self, pair):
        """Distance of two geoms' surfaces, negative where they overlap [m]."""
        return mujoco.mj_geomDistance(self.model, self.data, *sorted(pair), 1.0, np.zeros(6))

    def pair(self, names):
        return frozenset(self.model.geom(name).id for name in names)


class Sensors:
    def __init__(self, scene, channels):
        self.scene, self.channels = scene, channels
        self.pairs = [[scene.pair(names) for names in c.get("pairs", [])] for c in channels]

    def read(self, phase, touching):
        return np.array([self.channel(c, pairs, phase, touching) for c, pairs in zip(self.channels, self.pairs)])

    def channel(self, channel, pairs, phase, touching):
        reads = channel["reads"]
        if reads == "joint-position":
            q = self.scene.data.qpos[self.scene.joint(channel["joint"])[0]]
            return (q - channel["from"]) / (channel["to"] - channel["from"])
        if reads == "touch":
            return min(1.0, sum(pair in touching for pair in pairs) / channel["saturation"])
        if reads == "way":
            way = self.scene.point(channel["target"]) - self.scene.point(channel["from"])
            if channel["axes"] == "body":
                way = self.scene.data.body(channel["from"]["body"]).xmat.reshape(3, 3).T @ way
            return channel["scale"] * way[channel["component"]]
        if reads == "label":
            return channel["amplitude"] if phase == channel["phase"] else 0.0
        sys.exit(f"a sensor that reads {reads} is not known here")


class Judge:
    """Phases and success of reach-grasp-lift [Ferrauto2010, 2.3.4]."""

    def __init__(self, scene, data):
        self.scene, self.data, self.phases = scene, data, data["phases"]
        self.on_fingers = [scene.pair(names) for names in data["on_fingers"]]
        self.on_table = scene.pair(data["on_table"])
        self.reset()

    def reset(self):
        self.phase, self.held, self.fallen = self.phases[0], 0, False

    def step(self, touching):
        target = self.scene.data.body(self.data["target"]).xpos
        palm = self.scene.point(self.data["palm"])
        tips = [self.scene.point(tip) for tip in self.data["fingertips"]]
        ds = 100 * np.linalg.norm(palm - target - [0, 0, 0.05])
        grasp = 100 * np.linalg.norm(np.mean([palm, *tips], axis=0) - target)
        contacts = sum(pair in touching for pair in self.on_fingers)
        r, g, l = 1 - np.exp(-0.1 * ds), np.exp(-0.2 * grasp), 1 - np.exp(-0.3 * contacts)
        if self.phase == self.phases[0]:
            if not (r > g or g < 0.5):
                self.phase = self.phases[1]
        elif self.phase == self.phases[1] and g > 0.7 and l > 0.6:
            self.phase = self.phases[2]
        lifted = contacts > 0 and self.on_table not in touching
        self.held = self.held + 1 if lifted and target[2] >= self.data["success_height"] else 0
        self.fallen = target[2] < 0

    def succeeds(self):
        return self.held >= self.data["success_steps"] and not self.fallen


class Muscles:
    """Muscle pairs as applied torques, with their damping and stiffness taken implicitly [Ferrauto2010, chapter 2]."""

    def __init__(self, scene, actuators):
        self.scene = scene
        pairs = [(a, a["law"]["muscle-pair"]) for a in actuators if "muscle-pair" in a["law"]]
        self.number = {a["name"]: i for i, (a, _) in enumerate(pairs)}
        self.activations = np.zeros((len(pairs), 2))
        places = [scene.joint(a["joint"]) for a, _ in pairs]
        self.q, self.v = np.array([q for q, _ in places], int), np.array([v for _, v in places], int)
        self.law = {key: np.array([law[key] for _, law in pairs]) for key in (pairs[0][1] if pairs else [])}
        self.damping = scene.model.dof_damping[self.v].copy()

    def elastic(self, length, activation):
        """Active and passive tension, and their slope by the length."""
        law = self.law
        width = law["longest"] - law["rest_length"]
        e = (length - law["rest_length"]) / width
        growth = law["passive_scale"] * np.exp(law["shape"] * e)
        within = np.abs(e) < 1
        tension = np.where(within, activation * law["tension"] * (1 - e * e), 0) + growth - law["passive_scale"]
        slope = np.where(within, -2 * activation * law["tension"] * e, 0) + growth * law["shape"]
        return tension, slope / width

    def pull(self):
        if not self.number:
            return
        law, model, data = self.law, self.scene.model, self.scene.data
        gear = (law["longest"] - law["shortest"]) / (law["upper"] - law["lower"])
        stroke = gear * (data.qpos[self.q] - law["lower"])
        t1, slope1 = self.elastic(law["shortest"] + stroke, self.activations[:, 0])
        t2, slope2 = self.elastic(law["longest"] - stroke, self.activations[:, 1])
        leverage = law["moment_arm"] * gear
        stiffness = np.maximum(0, leverage * (slope1 + slope2))
        data.qfrc_applied[self.v] = law["moment_arm"] * (t2 - t1)
        viscous = 2 * leverage * law["viscosity"]
        model.dof_damping[self.v] = self.damping + viscous + model.opt.timestep * stiffness

    def step(self, substeps):
        for _ in range(substeps):
            self.pull()
            mujoco.mj_step(self.scene.model, self.scene.data)


class Motors:
    """Channels in [0, 1] as activations of muscles and positions of MuJoCo's own servos."""

    def __init__(self, scene, channels, muscles):
        self.scene, self.channels, self.muscles = scene, channels, muscles

    def drive(self, y):
        for channel, value in zip(self.channels, np.clip(y, 0, 1)):
            if channel["drives"] == "muscle":
                number = self.muscles.number[channel["actuator"]]
                self.muscles.activations[number, channel["muscle"]] = value
            else:
                for servo in channel["servos"]:
                    at = servo["from"] + (servo["to"] - servo["from"]) * value
                    self.scene.data.actuator(servo["actuator"]).ctrl[0] = at


def run(scene, muscles, controller, start):
    """A trial: whether it succeeds, its phase and height at the end."""
    network, sensors = Network(controller["network"]), Sensors(scene, controller["sensors"])
    judge, motors = Judge(scene, controller["judge"]), Motors(scene, controller["motors"], muscles)
    scene.place(start["joints"], start["bodies"])
    touching = scene.touching()
    for _ in range(controller["steps"]):
        motors.drive(network.step(sensors.read(judge.phase, touching)))
        muscles.step(scene.substeps)
        # Places and forces of where the step has led to.
        muscles.pull()
        mujoco.mj_forward(scene.model, scene.data)
        touching = scene.touching()
        judge.step(touching)
        if judge.fallen:
            break
    return judge.succeeds(), judge.phase, scene.data.body(controller["judge"]["target"]).xpos[2]


def check(scene, controller, trial):
    """Sensors, phases and network beside those of a recorded trial."""
    with open(trial, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    sensors, judge = Sensors(scene, controller["sensors"]), Judge(scene, controller["judge"])
    network, target = Network(controller["network"]), controller["judge"]["target"]
    surfaces = {scene.pair(s["pair"]): (s["stiffness"], s["damping"]) for s in controller["surfaces"]}
    # Contacts are wanted before surfaces meet.
    scene.model.pair_margin[:] = scene.model.pair_gap[:] = NEAR
    names = [channel["name"] for channel in controller["sensors"]]
    joints = [key[: -len(" [rad]")] for key in rows[0] if key.endswith(" [rad]")]
    # A row has the sensors of the state that the row before it ends with.
    usable = [i for i in range(len(rows) - 1) if rows[i + 1]["trial"] == rows[i]["trial"]]
    chosen = {usable[i * len(usable) // CHECKED] for i in range(CHECKED)}
    most, phases, outputs, alike, least = np.zeros(len(names)), 0, 0.0, 0, np.inf
    for i, row in enumerate(rows):
        if i == 0 or row["trial"] != rows[i - 1]["trial"]:
            judge.reset()
            network.reset()
        x = np.array([float(row[f"sensor.{name}"]) for name in names])
        y = network.step(x)
        done = [float(value) for key, value in row.items() if key.startswith("output.")]
        outputs = max(outputs, np.abs(y - done).max())
        vector = lambda name, unit: [float(row[f"{target}.{name}{axis} [{unit}]"]) for axis in "xyz"]
        moves = [(name, float(row[f"{name} [rad]"]), float(row[f"{name} [rad/s]"])) for name in joints]
        bodies = [(target, vector("", "m"), vector("v", "m/s"), vector("w", "rad/s"))]
        loads = scene.loads(surfaces, moves, bodies)
        scene.place(moves, bodies)
        touching = {pair for pair, load in loads.items() if load > 0}
        judge.step(touching)
        phase = judge.phases[int(float(row["phase"]))]
        phases += judge.phase == phase
        judge.phase = phase
        if i in chosen:
            after = rows[i + 1]
            recorded = np.array([float(after[f"sensor.{name}"]) for name in names])
            read = sensors.read(phase, touching)
            off = np.abs(read - recorded)
            most = np.maximum(most, off)
            alike += (off < TOLERANCE).all()
            least = min([least, *(abs(loads[pair]) for pairs in sensors.pairs for pair in pairs if pair in loads)])
            for k in np.flatnonzero(off > TOLERANCE):
                near = [f"{1e6 * scene.gap(pair):.2f} um, {loads.get(pair, 0):.4f} N" for pair in sensors.pairs[k]]
                print(f"row {i + 1}: {names[k]} {recorded[k]:.6f} recorded, {read[k]:.6f} here; gaps and forces here: {near}")
    for kind in sorted({channel["reads"] for channel in controller["sensors"]}):
        of = np.array([channel["reads"] == kind for channel in controller["sensors"]])
        print(f"{kind}: {of.sum()} channels, largest difference in {len(chosen)} states {most[of].max():.2e}")
    print(f"all channels alike in {alike} of {len(chosen)} states")
    print(f"the force nearest 0 that decides a touch: {least:.2e} N")
    print(f"phase: {phases} of {len(rows)} steps alike")
    print(f"network: largest difference of an output in {len(rows)} steps {outputs:.2e}")
    return bool(most.max() < TOLERANCE)


def test(args):
    controller, starts = load(args.controller), load(args.starts)["starts"]
    names, found = [], []
    for beside in args.beside:
        name, path = beside.split("=", 1)
        with open(path, newline="", encoding="utf-8") as file:
            rows = [row["success"] == "true" for row in csv.DictReader(file)]
        names.append(name)
        found.append(rows[: len(starts)])
    for step in args.step or [None]:
        substeps = round(controller["time_step"] / step) if step else None
        scene = Scene(args.model, substeps, controller["time_step"])
        muscles, successes = Muscles(scene, controller["actuators"]), []
        for number, start in enumerate(starts):
            success, phase, height = run(scene, muscles, controller, start)
            successes.append(success)
            print(f"{number},{success},{phase},{100 * height:.3f}", file=sys.stderr)
        names.append(f"MuJoCo, {1e3 * scene.model.opt.timestep:g} ms")
        found.append(successes)
    kinds = 4
    print("| world | success | " + " | ".join(f"start {k + 1}" for k in range(kinds)), end="")
    print(" | both | only the first | only this | neither |\n" + "|---" * (kinds + 6) + "|")
    for name, rows in zip(names, found):
        cells = [f"{sum(rows)} of {len(rows)}"]
        cells += [f"{sum(rows[k::kinds])} of {len(rows[k::kinds])}" for k in range(kinds)]
        pairs = list(zip(found[0], rows))
        cells += [str(pairs.count(kind)) for kind in [(True, True), (True, False), (False, True), (False, False)]]
        print(f"| {name} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser()
    commands = parser.add_subparsers(dest="command", required=True)
    for name, last in [("check", "trial"), ("test", "starts")]:
        command = commands.add_parser(name)
        for argument in ["model", "controller", last]:
            command.add_argument(argument)
    command.add_argument("--step", type=float, action="append", help="MuJoCo's step [s], by default the model's")
    command.add_argument("--beside", action="append", default=[], metavar="NAME=FILE")
    args = parser.parse_args()
    if args.command == "check":
        sys.exit(0 if check(Scene(args.model), load(args.controller), args.trial) else 1)
    test(args)


if __name__ == "__main__":
    main()
