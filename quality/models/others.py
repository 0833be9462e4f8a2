"""Readings of models by MuJoCo and Pinocchio: mass matrix, bias forces, places and ranges at random states."""

import math
import os
import sys
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin

STATES = 3


@dataclass
class State:
    """A state, with what follows from it. Joints are in the order of the reading."""

    positions: dict
    speeds: np.ndarray
    mass: np.ndarray
    bias: np.ndarray
    places: dict


@dataclass
class Reading:
    """A model as another program reads it."""

    # Names of single joints and bodies that move freely, each with its first velocity.
    joints: dict = field(default_factory=dict)
    free: dict = field(default_factory=dict)
    ranges: dict = field(default_factory=dict)
    # Stiffness and rest position of each spring, and dry friction, where the program has them.
    laws: dict = field(default_factory=dict)
    contacts: bool = True
    states: list = field(default_factory=list)


def between(ends, random):
    """Draws a position inside the range, at most 1 from its middle or its nearest end to 0."""
    low, high = sorted(ends)
    if math.isinf(low) or math.isinf(high) or high - low > 4.0:
        near = min(max(0.0, low), high)
        low, high = max(low, near - 1.0), min(high, near + 1.0)
    return random.uniform(low, high)


def from_mujoco(path, random):
    """The reading of an MJCF by MuJoCo. Velocities of a free body are linear in the world, angular in the body."""
    model = mujoco.MjModel.from_xml_path(str(path))
    data, reading = mujoco.MjData(model), Reading()
    flags = mujoco.mjtDisableBit
    reading.contacts = not model.opt.disableflags & (flags.mjDSBL_CONTACT | flags.mjDSBL_CONSTRAINT)
    limits = not model.opt.disableflags & (flags.mjDSBL_LIMIT | flags.mjDSBL_CONSTRAINT)
    disabled = int(model.opt.disableflags)
    # Constraints change neither the mass matrix nor the bias, but take time.
    model.opt.disableflags |= flags.mjDSBL_CONSTRAINT | flags.mjDSBL_CONTACT
    bodies = [model.body(b).name or f"body{b}" for b in range(model.nbody)]
    addresses = {}
    for j in range(model.njnt):
        name, first = model.joint(j).name or f"joint{j}", int(model.jnt_dofadr[j])
        kind = model.jnt_type[j]
        if kind == mujoco.mjtJoint.mjJNT_FREE:
            reading.free[bodies[model.jnt_bodyid[j]]] = first
            addresses[bodies[model.jnt_bodyid[j]]] = int(model.jnt_qposadr[j])
        elif kind != mujoco.mjtJoint.mjJNT_BALL:
            reading.joints[name] = first
            limited = model.jnt_limited[j] and limits
            reading.ranges[name] = tuple(model.jnt_range[j]) if limited else (-math.inf, math.inf)
            addresses[name] = int(model.jnt_qposadr[j])
            springs = not model.opt.disableflags & flags.mjDSBL_SPRING
            friction = not disabled & (flags.mjDSBL_FRICTIONLOSS | flags.mjDSBL_CONSTRAINT)
            stiffness = float(model.jnt_stiffness[j]) * bool(springs)
            rest = float(model.qpos_spring[addresses[name]]) if stiffness else 0.0
            reading.laws[name] = (stiffness, rest, float(model.dof_frictionloss[first]) * bool(friction))
    for _ in range(STATES):
        mujoco.mj_resetData(model, data)
        positions = {name: between(ends, random) for name, ends in reading.ranges.items()}
        for name, position in positions.items():
            data.qpos[addresses[name]] = position
        for name in reading.free:
            turn = random.normal(size=4)
            positions[name] = np.array([*random.uniform(-1, 1, 3), *(turn / np.linalg.norm(turn))])
            data.qpos[addresses[name] : addresses[name] + 7] = positions[name]
        data.qvel[:] = random.uniform(-1, 1, model.nv)
        mujoco.mj_forward(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        places = {
            bodies[b]: (data.xpos[b].copy(), data.xmat[b].reshape(3, 3).copy()) for b in range(1, model.nbody)
        }
        reading.states.append(State(positions, data.qvel.copy(), mass, data.qfrc_bias.copy(), places))
    return reading


def from_pinocchio(path, random):
    """The reading of a URDF by Pinocchio, whose root is fixed in the world."""
    model = pin.buildModelFromUrdf(str(path))
    data, reading = model.createData(), Reading()
    for j in range(1, model.njoints):
        joint, name = model.joints[j], model.names[j]
        reading.joints[name] = joint.idx_v
        ends = (-math.inf, math.inf)
        if joint.nq == 1:
            ends = tuple(float(limit[joint.idx_q]) for limit in (model.lowerPositionLimit, model.upperPositionLimit))
        reading.ranges[name] = tuple(end if abs(end) < 1e9 else math.copysign(math.inf, end) for end in ends)
    for _ in range(STATES):
        positions = {name: between(ends, random) for name, ends in reading.ranges.items()}
        q, speeds = pin.neutral(model), random.uniform(-1, 1, model.nv)
        for name, position in positions.items():
            joint = model.joints[model.getJointId(name)]
            q[joint.idx_q : joint.idx_q + joint.nq] = (
                [position] if joint.nq == 1 else [math.cos(position), math.sin(position)]
            )
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = pin.nonLinearEffects(model, data, q, speeds).copy()
        pin.framesForwardKinematics(model, data, q)
        places = {
            frame.name: (place.translation.copy(), place.rotation.copy())
            for frame, place in zip(model.frames, data.oMf)
            if frame.type == pin.FrameType.BODY
        }
        reading.states.append(State(positions, speeds, mass, bias, places))
    return reading


@contextmanager
def silent():
    """Hides messages that C++ code writes to standard error."""
    sys.stderr.flush()
    with open(os.devnull, "w") as nothing:
        before = os.dup(2)
        os.dup2(nothing.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(before, 2)
            os.close(before)


def read(folder, name):
    """The reading of a file by the program of its format. Raises an error with the program's message."""
    path = Path(folder) / name
    random = np.random.default_rng([ord(letter) for letter in name])
    with silent():
        return (from_pinocchio if path.suffix == ".urdf" else from_mujoco)(path, random)
