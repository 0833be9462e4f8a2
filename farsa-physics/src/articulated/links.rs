//! The moving links of a description: which segments ride on which, and the inertias of all that does.

use alloc::vec;
use alloc::vec::Vec;

use farsa_body::Pose;
use farsa_body::robot::{JointKind, Robot};
use farsa_num::{Real, Scalar};

use crate::articulated::link::{Link, LinkData, Motion, Sliding, WORLD};
use crate::articulated::model::{ModelError, Mount, Options};
use crate::articulated::spatial::{Matrix, Vector, add, cross, matrix_of, product, rotate, rotate_symmetric, sub};
use crate::articulated::tree::{forward_kinematics, mass_matrix};

/// A rotation whose third column is the axis.
fn axis_frame(axis: Vector<f64>) -> Matrix<f64> {
    let length = Scalar::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    let [x, y, z] = axis.map(|a| a / length);
    // For the coordinate axes a permutation, so that nothing is rounded.
    let u = if x.abs() > 0.9 {
        [0.0, 1.0, 0.0]
    } else if y.abs() > 0.9 {
        [0.0, 0.0, 1.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    // Gram-Schmidt: what of u is across the axis. V then makes the frame right-handed.
    let along = u[0] * x + u[1] * y + u[2] * z;
    let u = [u[0] - along * x, u[1] - along * y, u[2] - along * z];
    let n = Scalar::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    let u = u.map(|a| a / n);
    let v = cross([x, y, z], u);
    [[u[0], v[0], x], [u[1], v[1], y], [u[2], v[2], z]]
}

fn transpose(m: &Matrix<f64>) -> Matrix<f64> {
    [[m[0][0], m[1][0], m[2][0]], [m[0][1], m[1][1], m[2][1]], [m[0][2], m[1][2], m[2][2]]]
}

pub(crate) fn unit(q: [f64; 4]) -> [f64; 4] {
    let n = Scalar::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    q.map(|x| x / n)
}

pub(crate) fn frame(pose: &Pose<f64>) -> Mount<f64> {
    Mount { link: WORLD, rotation: matrix_of(unit(pose.rotation)), position: pose.position }
}

pub(crate) fn compose(outer: &Mount<f64>, inner: &Mount<f64>) -> Mount<f64> {
    Mount {
        link: outer.link,
        rotation: product(&outer.rotation, &inner.rotation),
        position: add(outer.position, rotate(&outer.rotation, inner.position)),
    }
}

pub(crate) const IDENTITY: Matrix<f64> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl Link<f64> {
    /// Adds a body that is rigidly mounted on the link.
    fn carry(&mut self, mass: f64, centre: Vector<f64>, inertia: &[f64; 6], mount: &Mount<f64>) {
        let centre = add(mount.position, rotate(&mount.rotation, centre));
        let total = self.mass + mass;
        if total == 0.0 {
            return;
        }
        // Both bodies about their common center: sum of I_k + m_k (c_k . c_k 1 - c_k c_k^T), the parallel axis theorem.
        let (old, w) = (self.centre, mass / total);
        let joint = [0, 1, 2].map(|k: usize| old[k] * (1.0 - w) + centre[k] * w);
        let turned = rotate_symmetric(&mount.rotation, inertia);
        for k in 0..6 {
            self.inertia[k] += turned[k];
        }
        for (m, c) in [(self.mass, sub(old, joint)), (mass, sub(centre, joint))] {
            let [x, y, z] = c;
            for (k, e) in [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z].into_iter().enumerate()
            {
                self.inertia[k] += m * e;
            }
        }
        self.mass = total;
        self.centre = joint;
    }

    fn cast<R: Real>(&self) -> Link<R> {
        let r = R::from_f64;
        Link {
            parent: self.parent,
            motion: self.motion,
            q: self.q,
            dof: self.dof,
            reference: self.reference,
            root: self.root,
            rotation: self.rotation.map(|row| row.map(r)),
            offset: self.offset.map(r),
            mass: r(self.mass),
            centre: self.centre.map(r),
            inertia: self.inertia.map(r),
            armature: r(self.armature),
            damping: r(self.damping),
            stiffness: r(self.stiffness),
            rest: r(self.rest),
            friction: r(self.friction),
            lower: r(self.lower),
            upper: r(self.upper),
            limit_stiffness: r(self.limit_stiffness),
            limit_damping: r(self.limit_damping),
            has_own_stop: self.has_own_stop,
            sliding: None,
        }
    }
}

/// The links in the precision of a world.
pub(crate) fn cast_links<R: Real>(links: &[Link<f64>]) -> Vec<Link<R>> {
    let mut cast: Vec<Link<R>> = Vec::with_capacity(links.len());
    for link in links {
        let mut link = link.cast();
        link.sliding = Sliding::of(&link, &cast);
        cast.push(link);
    }
    cast
}

pub(crate) fn cast_mount<R: Real>(m: &Mount<f64>) -> Mount<R> {
    Mount { link: m.link, rotation: m.rotation.map(|row| row.map(R::from_f64)), position: m.position.map(R::from_f64) }
}

/// The moving links, and where each segment is mounted.
pub(crate) fn links_of(robot: &Robot) -> (Vec<Link<f64>>, Vec<Mount<f64>>) {
    let mut links: Vec<Link<f64>> = Vec::new();
    let mut mounts: Vec<Mount<f64>> = Vec::new();
    let (mut q, mut dof, mut roots) = (0, 0, 0);
    for segment in &robot.segments {
        let joint = &segment.joint;
        let base = match segment.parent {
            Some(p) => mounts[p.index()],
            None => Mount { link: WORLD, rotation: IDENTITY, position: [0.0; 3] },
        };
        let at = compose(&base, &frame(&joint.placement));
        let motion = match joint.kind {
            JointKind::Fixed => {
                // A segment fixed to a link is part of it. The inertia of a segment fixed to the world has no effect.
                if let Some(link) = links.get_mut(usize::from(at.link)) {
                    link.carry(segment.mass, segment.centre, &segment.inertia, &at);
                }
                mounts.push(at);
                continue;
            }
            JointKind::Revolute => Motion::Revolute,
            JointKind::Prismatic => Motion::Prismatic,
            JointKind::Floating => Motion::Floating,
        };
        // The link is turned so that its joint moves along or about its z axis. The segment is mounted on it the other
        // way round.
        let turn = if motion == Motion::Floating { IDENTITY } else { axis_frame(joint.axis) };
        let mount = Mount { link: links.len() as u16, rotation: transpose(&turn), position: [0.0; 3] };
        let (nq, nv) = if motion == Motion::Floating { (7, 6) } else { (1, 1) };
        let mut link = Link {
            parent: at.link,
            motion,
            q,
            dof,
            reference: 0,
            root: roots,
            rotation: product(&at.rotation, &turn),
            offset: at.position,
            mass: 0.0,
            centre: [0.0; 3],
            inertia: [0.0; 6],
            armature: joint.armature,
            damping: joint.damping,
            stiffness: joint.stiffness,
            rest: joint.rest,
            friction: joint.friction,
            lower: joint.range[0],
            upper: joint.range[1],
            limit_stiffness: 0.0,
            limit_damping: 0.0,
            has_own_stop: joint.stop.is_some(),
            sliding: None,
        };
        link.carry(segment.mass, segment.centre, &segment.inertia, &mount);
        q += nq;
        dof += nv;
        roots += u16::from(motion == Motion::Floating);
        links.push(link);
        mounts.push(mount);
    }
    (links, mounts)
}

/// The reference link of each tree: a floating root, else the link with most children, else the last.
pub(crate) fn choose_references(links: &mut [Link<f64>]) {
    let n = links.len();
    let mut tree: Vec<usize> = (0..n).collect();
    let mut children = vec![0_usize; n];
    // Parents come before their children, so the root of the parent is already computed.
    for i in 0..n {
        if links[i].parent != WORLD {
            tree[i] = tree[usize::from(links[i].parent)];
            children[usize::from(links[i].parent)] += 1;
        }
    }
    for root in 0..n {
        if tree[root] != root {
            continue;
        }
        let members = || (0..n).filter(|&i| tree[i] == root);
        let reference = if links[root].motion == Motion::Floating {
            root
        } else {
            let most = members().map(|i| children[i]).max().unwrap_or(0);
            if most > 1 {
                members().find(|&i| children[i] == most).unwrap_or(root)
            } else {
                members().next_back().unwrap_or(root)
            }
        };
        for i in 0..n {
            if tree[i] == root {
                links[i].reference = reference as u16;
            }
        }
    }
}

/// The smallest ratio of two principal moments of a body: eight units in the last place of the largest.
///
/// An inertia is rotated into the world's axes with that error at most, and must stay positive.
pub(crate) fn least_ratio<R: Real>() -> f64 {
    let mut unit = 1.0;
    while R::from_f64(1.0 + 0.5 * unit).to_f64() > 1.0 {
        unit *= 0.5;
    }
    8.0 * unit
}

/// The eigenvalues of an inertia [xx, yy, zz, xy, xz, yz], by Jacobi's rotations.
fn principal_moments(&[xx, yy, zz, xy, xz, yz]: &[f64; 6]) -> [f64; 3] {
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    // Convergence is quadratic: five rounds reach the last place.
    for _ in 0..8 {
        for (p, q, other) in [(0, 1, 2), (0, 2, 1), (1, 2, 0)] {
            let off = a[p][q];
            if off == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * off);
            let root = Scalar::sqrt(theta * theta + 1.0);
            let tangent = if theta < 0.0 { 1.0 / (theta - root) } else { 1.0 / (theta + root) };
            let cosine = 1.0 / Scalar::sqrt(tangent * tangent + 1.0);
            let sine = tangent * cosine;
            let [x, y] = [a[other][p], a[other][q]];
            a[p][p] -= tangent * off;
            a[q][q] += tangent * off;
            (a[p][q], a[q][p]) = (0.0, 0.0);
            (a[other][p], a[other][q]) = (cosine * x - sine * y, sine * x + cosine * y);
            (a[p][other], a[q][other]) = (a[other][p], a[other][q]);
        }
    }
    [a[0][0], a[1][1], a[2][2]]
}

/// Stops scaled to each joint's own inertia, so that one frequency fits a shoulder and a finger.
pub(crate) fn set_limits(
    robot: &Robot,
    mounts: &[Mount<f64>],
    links: &mut [Link<f64>],
    initial: &[f64],
    dofs: usize,
    options: &Options,
    least: f64,
) -> Result<(), ModelError> {
    let mut work = vec![LinkData::<f64>::new(()); links.len()];
    let mut matrix = vec![0.0; dofs * dofs];
    let velocities = vec![0.0; dofs];
    forward_kinematics((), links, initial, &velocities, &mut work);
    mass_matrix((), links, &mut work, &mut matrix);
    for (segment, mount) in robot.segments.iter().zip(mounts) {
        let Some(link) = links.get_mut(usize::from(mount.link)) else { continue };
        if matches!(segment.joint.kind, JointKind::Fixed) {
            continue;
        }
        let at = usize::from(link.dof);
        // k = I w^2 and d = 2 zeta I w, with I the inertia that the joint feels at `initial`.
        let inertia = matrix[at * dofs + at];
        if inertia.is_nan() || inertia <= 0.0 {
            return Err(ModelError::Weightless { segment: segment.name.clone() });
        }
        let moments = principal_moments(&link.inertia);
        let largest = moments[0].max(moments[1]).max(moments[2]);
        let ratio = match link.motion {
            Motion::Floating => moments[0].min(moments[1]).min(moments[2]) / largest,
            Motion::Revolute => inertia / largest,
            Motion::Prismatic => 1.0,
        };
        if ratio < least {
            return Err(ModelError::Thin { segment: segment.name.clone(), ratio, least });
        }
        if link.has_own_stop {
            continue;
        }
        link.limit_stiffness = inertia * options.limit_frequency * options.limit_frequency;
        link.limit_damping = 2.0 * options.limit_damping * inertia * options.limit_frequency;
    }
    Ok(())
}
