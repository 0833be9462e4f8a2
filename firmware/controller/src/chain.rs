//! The inverse dynamics of an arm, without a heap.

use farsa_num::sin_cos;

type Vector = [f32; 3];

/// A link of a [`Chain`] with its joint, in a frame parallel to that of the parent at position 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainLink {
    /// The joint's axis, of length 1.
    pub axis: Vector,
    /// The joint in the parent's frame [m].
    pub offset: Vector,
    /// Mass [kg].
    pub mass: f32,
    /// Center of mass [m].
    pub centre: Vector,
    /// Moments of inertia about the center of mass, along the axes of the frame [kg m2].
    pub inertia: Vector,
    /// Inertia of the drive at the joint [kg m2].
    pub armature: f32,
}

/// A serial arm of `N` links with rotary joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain<const N: usize> {
    /// From the base outwards.
    pub links: [ChainLink; N],
    /// Gravity in the base's frame [m/s2].
    pub gravity: Vector,
}

/// The results of the outward sweep for the inward sweep, in the axes of the base.
#[derive(Clone, Copy)]
struct Swept {
    axis: Vector,
    offset: Vector,
    force: Vector,
    moment: Vector,
}

impl<const N: usize> Chain<N> {
    /// Computes the joint torques [N m] that hold the positions `q` [rad] at rest against gravity.
    pub fn holding_torques(&self, q: &[f32; N]) -> [f32; N] {
        self.torques(q, &[0.0; N], &[0.0; N])
    }

    /// Computes the joint torques [N m] for the accelerations `qdd` [rad/s2] at positions `q` [rad] and speeds `qd` [rad/s].
    ///
    /// Source: recursive Newton-Euler, [Featherstone2008] table 5.1. Deviation: three-dimensional vectors in the axes of the base
    /// instead of spatial ones in those of the links.
    pub fn torques(&self, q: &[f32; N], qd: &[f32; N], qdd: &[f32; N]) -> [f32; N] {
        // Rows are the frame's axes in the base's.
        let mut frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let (mut speed, mut turning, mut rising) = ([0.0; 3], [0.0; 3], scale(self.gravity, -1.0));
        let mut swept = [Swept { axis: [0.0; 3], offset: [0.0; 3], force: [0.0; 3], moment: [0.0; 3] }; N];
        for i in 0..N {
            let link = &self.links[i];
            let (axis, offset) = (to_base(&frame, link.axis), to_base(&frame, link.offset));
            rising = add(rising, add(cross(turning, offset), cross(speed, cross(speed, offset))));
            let joint = scale(axis, qd[i]);
            turning = add(turning, add(scale(axis, qdd[i]), cross(speed, joint)));
            speed = add(speed, joint);
            let (s, c) = sin_cos(q[i]);
            frame = frame.map(|side| turn(side, axis, s, c));

            let centre = to_base(&frame, link.centre);
            let at_centre = add(rising, add(cross(turning, centre), cross(speed, cross(speed, centre))));
            let force = scale(at_centre, link.mass);
            let about = |w| to_base(&frame, times(link.inertia, to_frame(&frame, w)));
            let moment = add(add(about(turning), cross(speed, about(speed))), cross(centre, force));
            swept[i] = Swept { axis, offset, force, moment };
        }
        let mut torques = [0.0; N];
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for i in (0..N).rev() {
            let link = &swept[i];
            (force, moment) = (add(force, link.force), add(moment, link.moment));
            torques[i] = dot(moment, link.axis) + self.links[i].armature * qdd[i];
            // About the parent's origin.
            moment = add(moment, cross(link.offset, force));
        }
        torques
    }
}

/// `v` turned about a unit axis by the angle of this sine and cosine.
fn turn(v: Vector, axis: Vector, s: f32, c: f32) -> Vector {
    add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1.0 - c)))
}

fn to_base([x, y, z]: &[Vector; 3], v: Vector) -> Vector {
    add(add(scale(*x, v[0]), scale(*y, v[1])), scale(*z, v[2]))
}

fn to_frame(frame: &[Vector; 3], v: Vector) -> Vector {
    frame.map(|side| dot(side, v))
}

fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn times(a: Vector, b: Vector) -> Vector {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

fn scale(a: Vector, k: f32) -> Vector {
    a.map(|a| a * k)
}

fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
