"""Our reading of a model, with mass matrix and bias forces by Pinocchio from the description's numbers alone."""

import math

import numpy as np
import pinocchio as pin

# The tolerance of places [m], ranges, mass matrix and bias forces, relative to the joints' own.
TOLERANCE = 1e-6


def placement(pose):
    """A pose as Pinocchio's."""
    x, y, z, w = pose["rotation"]
    return pin.SE3(pin.Quaternion(w, x, y, z).normalized().toRotationMatrix(), np.array(pose["position"]))


def limits(joint):
    """A joint's range. JSON has no infinity."""
    low, high = joint["range"]
    return (-math.inf if low is None else low, math.inf if high is None else high)


class Description:
    """A robot's description, built joint by joint."""

    def __init__(self, imported):
        self.imported = imported
        self.segments = imported["robot"]["segments"]
        self.model = pin.Model()
        gravity = imported["gravity"]
        self.model.gravity.linear = np.array([0.0, 0.0, -9.81] if gravity is None else gravity)
        # Joint of each segment, and the segment's frame in the joint's.
        self.mounts, self.joints = {}, {}
        children = {}
        for index, segment in enumerate(self.segments):
            children.setdefault(segment["parent"], []).append(index)
        # Pinocchio needs each joint's subtree in one piece.
        waiting = children.get(None, [])[::-1]
        while waiting:
            index = waiting.pop()
            self.add(index, self.segments[index])
            waiting += children.get(index, [])[::-1]
        self.data = self.model.createData()

    def add(self, index, segment):
        """Adds a segment."""
        joint = segment["joint"]
        above = (0, pin.SE3.Identity()) if segment["parent"] is None else self.mounts[segment["parent"]]
        place = above[1] * placement(joint["placement"])
        axis = np.array(joint["axis"], float)
        kinds = {
            "revolute": lambda: pin.JointModelRevoluteUnaligned(axis / np.linalg.norm(axis)),
            "prismatic": lambda: pin.JointModelPrismaticUnaligned(axis / np.linalg.norm(axis)),
            "floating": pin.JointModelFreeFlyer,
        }
        mount = (above[0], place)
        if joint["kind"] != "fixed":
            free = joint["kind"] == "floating"
            place = pin.SE3.Identity() if free else place
            number = self.model.addJoint(above[0], kinds[joint["kind"]](), place, str(index))
            self.joints[index if free else joint["name"]] = (index, number)
            mount = (number, pin.SE3.Identity())
        self.mounts[index] = mount
        if mount[0]:
            xx, yy, zz, xy, xz, yz = segment["inertia"]
            inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            inertia = pin.Inertia(segment["mass"], np.array(segment["centre"], float), inertia)
            self.model.appendBodyToJoint(mount[0], inertia, mount[1])

    def frames(self):
        """Segments and placements of the file's bodies, by name."""
        return {frame["name"]: (frame["body"], placement(frame["placement"])) for frame in self.imported["frames"]}

    def differences(self, reading):
        """Yields what differs from a reading."""
        frames = self.frames()
        free = {self.joints[frames[name][0]][1]: name for name in reading.free if name in frames}
        single = {name for name in self.joints if isinstance(name, str)}
        if single != set(reading.joints) or len(free) != len(self.joints) - len(single):
            yield f"joints {sorted(single ^ set(reading.joints))[:5]}"
            return
        if len(reading.free) != len(free):
            yield "free bodies"
            return
        if self.imported["contacts"] != reading.contacts:
            yield "contacts"
        for name, ends in reading.ranges.items():
            ours = limits(self.segments[self.joints[name][0]]["joint"])
            if not all(a == b or abs(a - b) <= TOLERANCE * max(1.0, abs(a)) for a, b in zip(ends, ours)):
                yield f"range of {name}: {ends}, ours {ours}"
        for name, laws in reading.laws.items():
            joint = self.segments[self.joints[name][0]]["joint"]
            ours = [joint.get(law, 0.0) for law in ("stiffness", "rest", "friction")]
            if not np.allclose(laws, ours, rtol=TOLERANCE, atol=1e-12):
                yield f"stiffness, rest and friction of {name}: {laws}, ours {ours}"
        for state in reading.states:
            yield from self.different_state(reading, state, frames, free)

    def different_state(self, reading, state, frames, free):
        """Yields what differs in a state."""
        model, data = self.model, self.data
        q, speeds, turned = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        # T maps their velocities to ours, which are in the body's axes.
        transform, armature = np.zeros((model.nv, len(state.speeds))), np.zeros(model.nv)
        for name, first in reading.joints.items():
            index, number = self.joints[name]
            joint = model.joints[number]
            q[joint.idx_q], transform[joint.idx_v, first] = state.positions[name], 1.0
            armature[joint.idx_v] = self.segments[index]["joint"]["armature"]
        for number, name in free.items():
            joint, first = model.joints[number], reading.free[name]
            x, y, z, *turn = state.positions[name]
            rotation = pin.Quaternion(*turn)
            q[joint.idx_q : joint.idx_q + 7] = [x, y, z, *rotation.coeffs()]
            at = joint.idx_v
            transform[at : at + 3, first : first + 3] = rotation.toRotationMatrix().T
            transform[at + 3 : at + 6, first + 3 : first + 6] = np.eye(3)
        speeds = transform @ state.speeds
        for number in free:
            # Axes that turn change a constant velocity: dT/dt v = -w x v.
            at = model.joints[number].idx_v
            turned[at : at + 3] = -np.cross(speeds[at + 3 : at + 6], speeds[at : at + 3])
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T + np.diag(armature)
        bias = pin.nonLinearEffects(model, data, q, speeds)
        ours = transform.T @ mass @ transform
        ours_bias = transform.T @ (bias + mass @ turned)
        yield from compared(reading, state, ours, ours_bias)
        pin.forwardKinematics(model, data, q)
        for name, (position, rotation) in state.places.items():
            if name not in frames:
                yield f"body {name}"
                continue
            segment, inner = frames[name]
            number, mount = (0, pin.SE3.Identity()) if segment is None else self.mounts[segment]
            place = data.oMi[number] * mount * inner
            worst = max(np.abs(place.translation - position).max(), np.abs(place.rotation - rotation).max())
            if not worst <= TOLERANCE:
                yield f"place of {name}: {worst:.1e}"


def compared(reading, state, mass, bias):
    """Yields joints whose part of the mass matrix or bias differs, in units in which the matrix has a diagonal of 1."""
    names = {first: name for name, first in [*reading.joints.items(), *reading.free.items()]}
    diagonal = np.diag(state.mass)
    if not len(diagonal):
        return
    size = np.sqrt(np.maximum(diagonal, 1e-9 * diagonal.max()))
    for what, worst in [
        ("mass matrix", np.abs((mass - state.mass) / np.outer(size, size)).max(axis=1)),
        ("bias", np.abs((bias - state.bias) / size) / max(1e-6, np.abs(state.bias / size).max())),
    ]:
        if not worst.max() <= TOLERANCE:
            at = int(np.argmax(worst))
            yield f"{what} of {names.get(at, at)}: {worst.max():.1e}"
