//! Recursive dynamics of a forest of links: forward kinematics, articulated bodies, Newton-Euler, composite bodies.
//!
//! All functions work on slices of the caller and allocate nothing. A joint's own frame has its axis along z. Floating
//! links have six velocities: angular, then that of the center of mass, both in the world's axes.

use farsa_num::{Real, Scalar, sin_cos};

use crate::articulated::link::{Link, LinkData, Motion, WORLD};
use crate::articulated::sliding;
use crate::articulated::spatial::{
    Cholesky, Inertia, Spatial, Vector, add, cross, dot, matrix_of, product, rotate, rotate_symmetric, scale, splat,
    splat_matrix, splat_symmetric, sub,
};

/// A row of a rotation, turned about its third axis.
#[inline(always)]
fn turn<S: Scalar>(r: Vector<S>, s: S, c: S) -> Vector<S> {
    [r[0] * c + r[1] * s, r[1] * c - r[0] * s, r[2]]
}

/// Places all links: forward kinematics and velocities from positions `q` [positions] and velocities `v` [dofs] into `work` [links].
#[inline(always)]
pub fn forward_kinematics<S: Scalar>(
    simd: S::Simd,
    links: &[Link<S::Real>],
    q: &[S],
    v: &[S],
    work: &mut [LinkData<S>],
) {
    if some_slide(links) {
        place::<S, true>(simd, links, q, v, work);
    } else {
        place::<S, false>(simd, links, q, v, work);
    }
}

/// Returns whether there is a link that only slides. Without one, kernels are compiled for no such link, because a test
/// at each link takes a tenth of the time.
fn some_slide<R>(links: &[Link<R>]) -> bool {
    links.iter().any(|link| link.sliding.is_some())
}

#[inline(always)]
fn place<S: Scalar, const SLIDING: bool>(
    simd: S::Simd,
    links: &[Link<S::Real>],
    q: &[S],
    v: &[S],
    work: &mut [LinkData<S>],
) {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    // First pass: rotations and origins. A joint's frame turns about or slides along its own z axis.
    for (i, link) in links.iter().enumerate() {
        let at = usize::from(link.q);
        if let Some(joint_frame) = link.sliding.as_ref().filter(|_| SLIDING) {
            let parent = (link.parent != WORLD).then(|| work[usize::from(link.parent)].position);
            let w = &mut work[i];
            (w.rotation, w.position, w.centre) = joint_frame.place(simd, parent, q[at]);
            continue;
        }
        let (rotation, position) = if link.motion == Motion::Floating {
            (matrix_of([q[at + 3], q[at + 4], q[at + 5], q[at + 6]]), [q[at], q[at + 1], q[at + 2]])
        } else {
            let joint_frame = splat_matrix(simd, link.rotation);
            let offset = splat::<S>(simd, link.offset);
            let (frame, origin) = if link.parent == WORLD {
                (joint_frame, offset)
            } else {
                let parent = &work[usize::from(link.parent)];
                (product(&parent.rotation, &joint_frame), add(parent.position, rotate(&parent.rotation, offset)))
            };
            if link.motion == Motion::Revolute {
                let (s, c) = sin_cos(q[at]);
                ([turn(frame[0], s, c), turn(frame[1], s, c), turn(frame[2], s, c)], origin)
            } else {
                let axis = [frame[0][2], frame[1][2], frame[2][2]];
                (frame, add(origin, scale(axis, q[at])))
            }
        };
        let w = &mut work[i];
        w.rotation = rotation;
        w.position = position;
        w.centre = add(position, rotate(&rotation, splat::<S>(simd, link.centre)));
    }
    // Second pass, with the reference points: the joint's motion subspace s, v_i = v_parent + s q', and the
    // acceleration from velocities alone, c_i = v_parent x s q'. There is no term for a subspace that moves with the
    // link, for s q' x s q' = 0. The reference point needs no term, because spatial vectors refer to its present place.
    for (i, link) in links.iter().enumerate() {
        let reference = work[usize::from(link.reference)].centre;
        let parent = if link.parent == WORLD { Spatial::zero(simd) } else { work[usize::from(link.parent)].velocity };
        let at = usize::from(link.dof);
        let w = &mut work[i];
        w.reference = reference;
        if SLIDING && link.sliding.is_some() {
            sliding::set_in_motion(simd, w, parent.linear, v[at]);
            continue;
        }
        let axis = [w.rotation[0][2], w.rotation[1][2], w.rotation[2][2]];
        match link.motion {
            Motion::Floating => {
                // The center of mass is the reference point.
                let (angular, linear) = ([v[at], v[at + 1], v[at + 2]], [v[at + 3], v[at + 4], v[at + 5]]);
                let r = sub(reference, w.centre);
                w.velocity = Spatial { angular, linear: add(linear, cross(angular, r)) };
                w.bias = Spatial::zero(simd);
                continue;
            }
            Motion::Revolute => {
                w.subspace = Spatial { angular: axis, linear: cross(sub(w.position, reference), axis) };
            }
            Motion::Prismatic => w.subspace = Spatial { angular: [zero; 3], linear: axis },
        }
        let joint = w.subspace.scale(v[at]);
        w.velocity = parent + joint;
        w.bias = parent.cross_motion(joint);
    }
}

/// The rigid inertias of all links about their references, into `work[..].inertia`.
#[inline(always)]
pub(crate) fn rigid_inertias<S: Scalar>(simd: S::Simd, links: &[Link<S::Real>], work: &mut [LinkData<S>]) {
    for (link, w) in links.iter().zip(work) {
        w.inertia = rigid_inertia(simd, link, w);
    }
}

#[inline(always)]
fn rigid_inertia<S: Scalar>(simd: S::Simd, link: &Link<S::Real>, w: &LinkData<S>) -> Inertia<S> {
    let about_centre = splat_symmetric(simd, link.inertia);
    let turned = rotate_symmetric(&w.rotation, &about_centre);
    Inertia::rigid(S::splat(simd, link.mass), sub(w.centre, w.reference), turned)
}

/// Joint accelerations under joint efforts: articulated bodies [Featherstone2008] table 7.1.
///
/// `tau` [dofs] are efforts, `diagonal` [dofs] is added to the joint-space inertia (armature and h d + h^2 k of
/// implicit terms), `qdd` [dofs] receives accelerations. `work` must have gone through [`forward_kinematics`].
/// Deviations: common axes and reference point instead of link coordinates. Gravity [m/s2] as a field instead of an
/// acceleration of the base. A floating link's linear acceleration is that of its center of mass. The factor stays in
/// `work` and `roots`.
#[inline(always)]
pub fn accelerations<S: Scalar>(
    simd: S::Simd,
    links: &[Link<S::Real>],
    gravity: [S::Real; 3],
    tau: &[S],
    diagonal: &[S],
    work: &mut [LinkData<S>],
    roots: &mut [Root<S>],
    qdd: &mut [S],
) {
    if some_slide(links) {
        articulated_bodies::<S, true>(simd, links, gravity, tau, diagonal, work, roots, qdd);
    } else {
        articulated_bodies::<S, false>(simd, links, gravity, tau, diagonal, work, roots, qdd);
    }
}

#[inline(always)]
fn articulated_bodies<S: Scalar, const SLIDING: bool>(
    simd: S::Simd,
    links: &[Link<S::Real>],
    gravity: [S::Real; 3],
    tau: &[S],
    diagonal: &[S],
    work: &mut [LinkData<S>],
    roots: &mut [Root<S>],
    qdd: &mut [S],
) {
    let slides = |link: &Link<S::Real>| SLIDING && link.sliding.is_some();
    let one = S::splat(simd, S::Real::from_f64(1.0));
    for (link, w) in links.iter().zip(work.iter_mut()) {
        if slides(link) {
            sliding::weigh(simd, w, link.mass);
        } else {
            w.inertia = rigid_inertia(simd, link, w);
        }
    }
    // Bias forces p_i = v_i x* I_i v_i. Gravity comes in with the acceleration of the base, below.
    for (link, w) in links.iter().zip(work.iter_mut()) {
        if !slides(link) {
            w.force = w.velocity.cross_force(w.inertia.times(w.velocity));
        }
    }
    // Inwards, articulated inertias I^A and bias forces p^A. With U = I^A s, D = s . U + diagonal and u = tau - s . p^A
    // a link passes I^A - U U^T / D and p^A + (I^A - U U^T / D) c + U u / D to its parent. Common axes and one
    // reference point: both are added unchanged. A floating link takes its six velocities at once, with a Cholesky
    // factor instead of D.
    for (i, link) in links.iter().enumerate().rev() {
        let at = usize::from(link.dof);
        let w = &mut work[i];
        if link.motion == Motion::Floating {
            roots[usize::from(link.root)].factor = w.inertia.cholesky();
            continue;
        }
        if slides(link) {
            let (inertia, force) = sliding::inwards(simd, w, tau[at], diagonal[at]);
            if link.parent != WORLD {
                sliding::take(&mut work[usize::from(link.parent)], &inertia, force);
            }
            continue;
        }
        let column = w.inertia.times(w.subspace);
        let d = one / (w.subspace.dot(column) + diagonal[at]);
        let u = tau[at] - w.subspace.dot(w.force);
        w.column = column;
        w.reciprocal = d;
        w.effort = u;
        if link.parent != WORLD {
            let inertia = w.inertia.minus_square(column, d);
            let force = w.force + inertia.times(w.bias) + column.scale(u * d);
            let parent = &mut work[usize::from(link.parent)];
            if slides(&links[usize::from(link.parent)]) {
                sliding::take(parent, &inertia.linear, force.linear);
                continue;
            }
            parent.inertia.add(&inertia);
            parent.force += force;
        }
    }
    // Outwards, q'' = (u - U . (a_parent + c)) / D and a = a_parent + c + s q''. The base is accelerated by minus gravity, so
    // accelerations of links are those relative to free fall.
    let field = splat::<S>(simd, gravity);
    let zero = Spatial::zero(simd);
    let base = Spatial { angular: zero.angular, linear: sub(zero.linear, field) };
    for (i, link) in links.iter().enumerate() {
        let at = usize::from(link.dof);
        if link.motion == Motion::Floating {
            // I^A a = f - p^A. From spatial to conventional acceleration of the center of mass: a + w x v, and free
            // fall.
            let w = &mut work[i];
            let effort = Spatial {
                angular: [tau[at], tau[at + 1], tau[at + 2]],
                linear: [tau[at + 3], tau[at + 4], tau[at + 5]],
            };
            let factor = &roots[usize::from(link.root)].factor;
            let a = factor.other_half(factor.half(effort - w.force));
            w.acceleration = a;
            let linear = add(add(a.linear, field), cross(w.velocity.angular, w.velocity.linear));
            for k in 0..3 {
                qdd[at + k] = a.angular[k];
                qdd[at + 3 + k] = linear[k];
            }
            continue;
        }
        let parent = if link.parent == WORLD { base } else { work[usize::from(link.parent)].acceleration };
        let w = &mut work[i];
        if slides(link) {
            qdd[at] = sliding::outwards(simd, w, parent.linear);
            continue;
        }
        let a = parent + w.bias;
        let x = (w.effort - w.column.dot(a)) * w.reciprocal;
        qdd[at] = x;
        w.acceleration = a + w.subspace.scale(x);
    }
}

/// The factor of a floating link's articulated inertia.
#[derive(Clone, Copy, Debug)]
pub struct Root<S> {
    pub(crate) factor: Cholesky<S>,
}

impl<S: Scalar> Root<S> {
    /// An empty one.
    pub fn new(simd: S::Simd) -> Self {
        Self { factor: Cholesky::identity(simd) }
    }
}

/// Joint efforts that produce the accelerations `qdd` [dofs]: recursive Newton-Euler [Featherstone2008] table 5.1, into `tau` [dofs].
///
/// `armature` counts. `work` must have gone through [`forward_kinematics`]. With `qdd` and velocities zero these are
/// the efforts that hold the robot against gravity [m/s2]. Deviations as in [`accelerations`].
#[inline(always)]
pub fn inverse_dynamics<S: Scalar>(
    simd: S::Simd,
    links: &[Link<S::Real>],
    gravity: [S::Real; 3],
    qdd: &[S],
    work: &mut [LinkData<S>],
    tau: &mut [S],
) {
    // Outwards, accelerations relative to free fall and the force that each link alone needs, f = I a + v x* I v.
    // Inwards, the forces of all that a joint carries, of which it feels tau = s . f.
    let zero = Spatial::zero(simd);
    let field = splat::<S>(simd, gravity);
    let base = Spatial { angular: zero.angular, linear: sub(zero.linear, field) };
    rigid_inertias(simd, links, work);
    for (i, link) in links.iter().enumerate() {
        let at = usize::from(link.dof);
        let parent = if link.parent == WORLD { base } else { work[usize::from(link.parent)].acceleration };
        let w = &mut work[i];
        w.acceleration = if link.motion == Motion::Floating {
            let turning = cross(w.velocity.angular, w.velocity.linear);
            let linear = sub(sub([qdd[at + 3], qdd[at + 4], qdd[at + 5]], turning), field);
            Spatial { angular: [qdd[at], qdd[at + 1], qdd[at + 2]], linear }
        } else {
            parent + w.bias + w.subspace.scale(qdd[at])
        };
        w.force = w.inertia.times(w.acceleration) + w.velocity.cross_force(w.inertia.times(w.velocity));
    }
    for (i, link) in links.iter().enumerate().rev() {
        let at = usize::from(link.dof);
        let w = &work[i];
        let force = w.force;
        if link.motion == Motion::Floating {
            for k in 0..3 {
                tau[at + k] = force.angular[k];
                tau[at + 3 + k] = force.linear[k];
            }
            continue;
        }
        tau[at] = w.subspace.dot(force) + S::splat(simd, link.armature) * qdd[at];
        if link.parent != WORLD {
            work[usize::from(link.parent)].force += force;
        }
    }
}

/// The joint-space inertia, armature included: composite bodies [Featherstone2008] table 6.2, into `matrix` [dofs x dofs, rows].
///
/// `work` must have gone through [`forward_kinematics`].
#[inline(always)]
pub fn mass_matrix<S: Scalar>(simd: S::Simd, links: &[Link<S::Real>], work: &mut [LinkData<S>], matrix: &mut [S]) {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let one = S::splat(simd, S::Real::from_f64(1.0));
    let dofs: usize = links.iter().map(|l| if l.motion == Motion::Floating { 6 } else { 1 }).sum();
    for x in matrix.iter_mut() {
        *x = zero;
    }
    rigid_inertias(simd, links, work);
    for (i, link) in links.iter().enumerate().rev() {
        let at = usize::from(link.dof);
        let inertia = work[i].inertia;
        if link.motion == Motion::Floating {
            for k in 0..6 {
                let mut unit = Spatial::zero(simd);
                if k < 3 {
                    unit.angular[k] = one;
                } else {
                    unit.linear[k - 3] = one;
                }
                let f = inertia.times(unit);
                for r in 0..3 {
                    matrix[(at + r) * dofs + at + k] = f.angular[r];
                    matrix[(at + 3 + r) * dofs + at + k] = f.linear[r];
                }
            }
            continue;
        }
        // I^c s is the force that a unit acceleration of the joint needs. Its effect on each joint above is an entry of
        // the column, M_ji = s_j . I^c_i s_i.
        let f = inertia.times(work[i].subspace);
        matrix[at * dofs + at] = work[i].subspace.dot(f) + S::splat(simd, link.armature);
        let mut above = link.parent;
        while above != WORLD {
            let ancestor = &links[usize::from(above)];
            let other = usize::from(ancestor.dof);
            if ancestor.motion == Motion::Floating {
                for r in 0..3 {
                    for (row, x) in [(other + r, f.angular[r]), (other + 3 + r, f.linear[r])] {
                        matrix[row * dofs + at] = x;
                        matrix[at * dofs + row] = x;
                    }
                }
            } else {
                let x = work[usize::from(above)].subspace.dot(f);
                matrix[other * dofs + at] = x;
                matrix[at * dofs + other] = x;
            }
            above = ancestor.parent;
        }
        if link.parent != WORLD {
            work[usize::from(link.parent)].inertia.add(&inertia);
        }
    }
}

/// The Jacobian of a point of a link in the world's axes, into `matrix` [6 x dofs, rows: angular x, y, z, linear x, y, z].
///
/// `point` is in the world [m]. `work` must have gone through [`forward_kinematics`].
#[inline(always)]
pub fn jacobian<S: Scalar>(
    simd: S::Simd,
    links: &[Link<S::Real>],
    work: &[LinkData<S>],
    link: usize,
    point: [S; 3],
    matrix: &mut [S],
) {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let one = S::splat(simd, S::Real::from_f64(1.0));
    let dofs: usize = links.iter().map(|l| if l.motion == Motion::Floating { 6 } else { 1 }).sum();
    for x in matrix.iter_mut() {
        *x = zero;
    }
    let mut next = link as u16;
    while next != WORLD {
        let l = &links[usize::from(next)];
        let w = &work[usize::from(next)];
        let at = usize::from(l.dof);
        // A joint moves the point by its subspace, taken there: s_lin + s_ang x arm. The linear velocities of a
        // floating link are those of its center of mass, which may not be the reference.
        let arm = sub(point, w.reference);
        if l.motion == Motion::Floating {
            let arm = sub(point, w.centre);
            for k in 0..3 {
                let mut axis = [zero; 3];
                axis[k] = one;
                let linear = cross(axis, arm);
                for r in 0..3 {
                    matrix[r * dofs + at + k] = axis[r];
                    matrix[(3 + r) * dofs + at + k] = linear[r];
                    matrix[(3 + r) * dofs + at + 3 + k] = axis[r];
                }
            }
        } else {
            let linear = w.subspace.at(arm);
            for r in 0..3 {
                matrix[r * dofs + at] = w.subspace.angular[r];
                matrix[(3 + r) * dofs + at] = linear[r];
            }
        }
        next = l.parent;
    }
}

/// Kinetic energy of the links and their armatures [J]. `v` [dofs]. `work` must have gone through
/// [`forward_kinematics`].
#[inline(always)]
pub fn kinetic_energy<S: Scalar>(simd: S::Simd, links: &[Link<S::Real>], v: &[S], work: &mut [LinkData<S>]) -> S {
    rigid_inertias(simd, links, work);
    let mut twice = S::splat(simd, S::Real::from_f64(0.0));
    for (link, w) in links.iter().zip(work.iter()) {
        twice += w.velocity.dot(w.inertia.times(w.velocity));
        if link.motion != Motion::Floating {
            let speed = v[usize::from(link.dof)];
            twice += S::splat(simd, link.armature) * speed * speed;
        }
    }
    twice * twice.constant(0.5)
}

/// Potential energy in the field `gravity` [m/s2] [J], zero at the world's origin. `work` must have gone through
/// [`forward_kinematics`].
#[inline(always)]
pub fn potential_energy<S: Scalar>(
    simd: S::Simd,
    links: &[Link<S::Real>],
    gravity: [S::Real; 3],
    work: &[LinkData<S>],
) -> S {
    let mut energy = S::splat(simd, S::Real::from_f64(0.0));
    for (link, w) in links.iter().zip(work.iter()) {
        energy -= S::splat(simd, link.mass) * dot(splat::<S>(simd, gravity), w.centre);
    }
    energy
}

/// Center of mass of all links in the world [m]. `work` must have gone through [`forward_kinematics`].
#[inline(always)]
pub fn centre_of_mass<S: Scalar>(simd: S::Simd, links: &[Link<S::Real>], work: &[LinkData<S>]) -> [S; 3] {
    let zero = S::splat(simd, S::Real::from_f64(0.0));
    let (mut sum, mut mass) = ([zero; 3], zero);
    for (link, w) in links.iter().zip(work.iter()) {
        let m = S::splat(simd, link.mass);
        mass += m;
        sum = add(sum, scale(w.centre, m));
    }
    [sum[0] / mass, sum[1] / mass, sum[2] / mass]
}
