//! Spatial vectors and inertias, all in the world's axes about one reference point of their tree.
//!
//! With common axes and a common point nothing is transformed from link to link. Articulated inertias are added
//! unchanged, which makes the sweeps about half as long as in link coordinates ([Featherstone2008, section 7.3] has
//! them in link coordinates). The point is chosen near the lightest links, so that single precision suffices.

use core::ops::{Add, AddAssign, Sub};

use farsa_num::Scalar;

pub(crate) type Vector<S> = [S; 3];
/// Rows of a rotation matrix.
pub(crate) type Matrix<S> = [[S; 3]; 3];

#[inline(always)]
pub(crate) fn cross<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(crate) fn dot<S: Scalar>(a: Vector<S>, b: Vector<S>) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn add<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(crate) fn sub<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(crate) fn scale<S: Scalar>(a: Vector<S>, k: S) -> Vector<S> {
    [a[0] * k, a[1] * k, a[2] * k]
}

#[inline(always)]
pub(crate) fn select<S: Scalar>(mask: S::Mask, a: Vector<S>, b: Vector<S>) -> Vector<S> {
    [S::select(mask, a[0], b[0]), S::select(mask, a[1], b[1]), S::select(mask, a[2], b[2])]
}

#[inline(always)]
pub(crate) fn splat<S: Scalar>(simd: S::Simd, a: [S::Real; 3]) -> Vector<S> {
    [S::splat(simd, a[0]), S::splat(simd, a[1]), S::splat(simd, a[2])]
}

#[inline(always)]
pub(crate) fn splat_symmetric<S: Scalar>(simd: S::Simd, m: [S::Real; 6]) -> [S; 6] {
    let ([a, b, c], [d, e, f]) = (splat(simd, [m[0], m[1], m[2]]), splat(simd, [m[3], m[4], m[5]]));
    [a, b, c, d, e, f]
}

#[inline(always)]
pub(crate) fn splat_matrix<S: Scalar>(simd: S::Simd, m: Matrix<S::Real>) -> Matrix<S> {
    [splat(simd, m[0]), splat(simd, m[1]), splat(simd, m[2])]
}

#[inline(always)]
pub(crate) fn rotate<S: Scalar>(m: &Matrix<S>, a: Vector<S>) -> Vector<S> {
    [dot(m[0], a), dot(m[1], a), dot(m[2], a)]
}

#[inline(always)]
pub(crate) fn rotate_back<S: Scalar>(m: &Matrix<S>, a: Vector<S>) -> Vector<S> {
    [
        m[0][0] * a[0] + m[1][0] * a[1] + m[2][0] * a[2],
        m[0][1] * a[0] + m[1][1] * a[1] + m[2][1] * a[2],
        m[0][2] * a[0] + m[1][2] * a[1] + m[2][2] * a[2],
    ]
}

/// The product of two rotations.
#[inline(always)]
pub(crate) fn product<S: Scalar>(m: &Matrix<S>, n: &Matrix<S>) -> Matrix<S> {
    [rotate_back(n, m[0]), rotate_back(n, m[1]), rotate_back(n, m[2])]
}

/// The rotation matrix of a unit quaternion [x, y, z, w].
#[inline(always)]
pub(crate) fn matrix_of<S: Scalar>(q: [S; 4]) -> Matrix<S> {
    let one = q[0].constant(1.0);
    let [x, y, z, w] = q;
    // R = 1 + 2 w [v]x + 2 [v]x [v]x with v = (x, y, z). Doubled once, so that each entry takes one product and one
    // sum.
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [[one - (yy + zz), xy - wz, xz + wy], [xy + wz, one - (xx + zz), yz - wx], [xz - wy, yz + wx, one - (xx + yy)]]
}

/// A motion (angular velocity, velocity of the reference point) or a force (moment about it, force).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spatial<S> {
    /// Angular velocity [rad/s], or moment about the reference point [N m].
    pub angular: [S; 3],
    /// Velocity of the point of the body that is at the reference point [m/s], or force [N].
    pub linear: [S; 3],
}

impl<S: Scalar> Spatial<S> {
    #[inline(always)]
    pub(crate) fn zero(simd: S::Simd) -> Self {
        let z = S::splat(simd, farsa_num::Real::from_f64(0.0));
        Self { angular: [z; 3], linear: [z; 3] }
    }
    /// Multiplies each component by `k`.
    #[inline(always)]
    pub fn scale(self, k: S) -> Self {
        Self { angular: scale(self.angular, k), linear: scale(self.linear, k) }
    }
    /// Computes the scalar product of a motion and a force, which is the power [W].
    #[inline(always)]
    pub fn dot(self, other: Self) -> S {
        dot(self.angular, other.angular) + dot(self.linear, other.linear)
    }
    /// Computes the rate of change of a motion that is carried along by this one \[Featherstone2008\] eq. 2.31.
    #[inline(always)]
    pub fn cross_motion(self, m: Self) -> Self {
        Self {
            angular: cross(self.angular, m.angular),
            linear: add(cross(self.angular, m.linear), cross(self.linear, m.angular)),
        }
    }
    /// Computes the rate of change of a force that is carried along by this motion \[Featherstone2008\] eq. 2.32.
    #[inline(always)]
    pub fn cross_force(self, f: Self) -> Self {
        Self {
            angular: add(cross(self.angular, f.angular), cross(self.linear, f.linear)),
            linear: cross(self.angular, f.linear),
        }
    }
    /// Computes the velocity [m/s] of the point of the body at `r` [m] from the reference point.
    #[inline(always)]
    pub fn at(self, r: [S; 3]) -> [S; 3] {
        add(self.linear, cross(self.angular, r))
    }
    /// Creates the spatial force of `f` [N] at the point `r` [m] from the reference point.
    #[inline(always)]
    pub fn force_at(r: [S; 3], f: [S; 3]) -> Self {
        Self { angular: cross(r, f), linear: f }
    }
}

impl<S: Scalar> Add for Spatial<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { angular: add(self.angular, o.angular), linear: add(self.linear, o.linear) }
    }
}

impl<S: Scalar> Sub for Spatial<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { angular: sub(self.angular, o.angular), linear: sub(self.linear, o.linear) }
    }
}

impl<S: Scalar> AddAssign for Spatial<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

/// A symmetric 6x6 inertia: angular block [xx, yy, zz, xy, xz, yz], coupling block (rows angular), linear block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia<S> {
    pub(crate) angular: [S; 6],
    pub(crate) coupling: [[S; 3]; 3],
    pub(crate) linear: [S; 6],
}

/// Row and column of each entry of a symmetric matrix.
const TRIANGLE: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

#[inline(always)]
pub(crate) fn symmetric<S: Scalar>(m: &[S; 6], a: Vector<S>) -> Vector<S> {
    [
        m[0] * a[0] + m[3] * a[1] + m[4] * a[2],
        m[3] * a[0] + m[1] * a[1] + m[5] * a[2],
        m[4] * a[0] + m[5] * a[1] + m[2] * a[2],
    ]
}

/// `rotation * m * rotation^T` of a symmetric matrix.
#[inline(always)]
pub(crate) fn rotate_symmetric<S: Scalar>(rotation: &Matrix<S>, m: &[S; 6]) -> [S; 6] {
    // With r_i the rows of the rotation, entry (i, j) is r_i . (m r_j).
    let t = [symmetric(m, rotation[0]), symmetric(m, rotation[1]), symmetric(m, rotation[2])];
    [
        dot(rotation[0], t[0]),
        dot(rotation[1], t[1]),
        dot(rotation[2], t[2]),
        dot(rotation[0], t[1]),
        dot(rotation[0], t[2]),
        dot(rotation[1], t[2]),
    ]
}

impl<S: Scalar> Inertia<S> {
    #[inline(always)]
    pub(crate) fn zero(simd: S::Simd) -> Self {
        let z = S::splat(simd, farsa_num::Real::from_f64(0.0));
        Self { angular: [z; 6], coupling: [[z; 3]; 3], linear: [z; 6] }
    }

    /// A rigid body: mass, center of mass from the reference point, inertia about the center in the world's axes.
    #[inline(always)]
    pub(crate) fn rigid(mass: S, centre: Vector<S>, about_centre: [S; 6]) -> Self {
        let zero = mass.constant(0.0);
        // With c the center of mass: I_c + m (c . c 1 - c c^T) about the point, and m [c]x between motion and moment
        // [Featherstone2008] section 2.13.
        let m = scale(centre, mass);
        let [x, y, z] = centre;
        let [mx, my, mz] = m;
        Self {
            angular: [
                about_centre[0] + (my * y + mz * z),
                about_centre[1] + (mx * x + mz * z),
                about_centre[2] + (mx * x + my * y),
                about_centre[3] - mx * y,
                about_centre[4] - mx * z,
                about_centre[5] - my * z,
            ],
            coupling: [[zero, -mz, my], [mz, zero, -mx], [-my, mx, zero]],
            linear: [mass, mass, mass, zero, zero, zero],
        }
    }

    #[inline(always)]
    pub(crate) fn times(&self, m: Spatial<S>) -> Spatial<S> {
        Spatial {
            // Below the diagonal is the transposed coupling.
            angular: add(symmetric(&self.angular, m.angular), rotate(&self.coupling, m.linear)),
            linear: add(rotate_back(&self.coupling, m.angular), symmetric(&self.linear, m.linear)),
        }
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, o: &Self) {
        for k in 0..6 {
            self.angular[k] += o.angular[k];
            self.linear[k] += o.linear[k];
        }
        for a in 0..3 {
            for b in 0..3 {
                self.coupling[a][b] += o.coupling[a][b];
            }
        }
    }

    /// `self - u u^T d`.
    #[inline(always)]
    pub(crate) fn minus_square(&self, u: Spatial<S>, d: S) -> Self {
        let s = u.scale(d);
        // A yielding joint reduces the inertia that its parent carries: I - U U^T / D. One triangle is enough.
        let (w, v, sw, sv) = (u.angular, u.linear, s.angular, s.linear);
        let mut o = *self;
        for (k, (a, b)) in TRIANGLE.into_iter().enumerate() {
            o.angular[k] -= sw[a] * w[b];
        }
        o.linear = Self::linear_minus_square(&self.linear, v, sv);
        for a in 0..3 {
            for b in 0..3 {
                o.coupling[a][b] -= sw[a] * v[b];
            }
        }
        o
    }

    /// The linear block of the same, with `sv` for `v d`.
    #[inline(always)]
    pub(crate) fn linear_minus_square(linear: &[S; 6], v: Vector<S>, sv: Vector<S>) -> [S; 6] {
        let mut o = *linear;
        for (k, (a, b)) in TRIANGLE.into_iter().enumerate() {
            o[k] -= sv[a] * v[b];
        }
        o
    }

    /// Entry (a, b) of the 6x6 matrix, angular first.
    #[inline(always)]
    fn entry(&self, a: usize, b: usize) -> S {
        const SYMMETRIC: [[usize; 3]; 3] = [[0, 3, 4], [3, 1, 5], [4, 5, 2]];
        match (a < 3, b < 3) {
            (true, true) => self.angular[SYMMETRIC[a][b]],
            (true, false) => self.coupling[a][b - 3],
            (false, true) => self.coupling[b][a - 3],
            (false, false) => self.linear[SYMMETRIC[a - 3][b - 3]],
        }
    }

    /// The Cholesky factor, lower triangle. The diagonal holds reciprocals.
    #[inline(always)]
    pub(crate) fn cholesky(&self) -> Cholesky<S> {
        let one = self.angular[0].constant(1.0);
        // A = L L^T, column by column: l_jj = sqrt(a_jj - sum_k l_jk^2), l_ij = (a_ij - sum_k l_ik l_jk) / l_jj. The
        // reciprocals of l_jj are stored, so that a solve with the factor only multiplies.
        let mut l = [[one; 6]; 6];
        for j in 0..6 {
            let mut d = self.entry(j, j);
            for k in 0..j {
                d -= l[j][k] * l[j][k];
            }
            let r = one / d.sqrt();
            l[j][j] = r;
            for i in j + 1..6 {
                let mut x = self.entry(i, j);
                for k in 0..j {
                    x -= l[i][k] * l[j][k];
                }
                l[i][j] = x * r;
            }
        }
        Cholesky { l }
    }
}

/// A Cholesky factor of a 6x6 inertia.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cholesky<S> {
    l: [[S; 6]; 6],
}

impl<S: Scalar> Cholesky<S> {
    pub(crate) fn identity(simd: S::Simd) -> Self {
        let z = S::splat(simd, farsa_num::Real::from_f64(0.0));
        let mut l = [[z; 6]; 6];
        for (k, row) in l.iter_mut().enumerate() {
            row[k] = z.constant(1.0);
        }
        Self { l }
    }

    /// `L^-1 b`.
    #[inline(always)]
    pub(crate) fn half(&self, b: Spatial<S>) -> [S; 6] {
        // Forwards: y_i = (b_i - sum_(k<i) l_ik y_k) / l_ii.
        let mut y = [b.angular[0], b.angular[1], b.angular[2], b.linear[0], b.linear[1], b.linear[2]];
        for i in 0..6 {
            for k in 0..i {
                y[i] -= self.l[i][k] * y[k];
            }
            y[i] *= self.l[i][i];
        }
        y
    }

    /// `L^-T y`.
    #[inline(always)]
    pub(crate) fn other_half(&self, mut y: [S; 6]) -> Spatial<S> {
        // Backwards: x_i = (y_i - sum_(k>i) l_ki x_k) / l_ii.
        for i in (0..6).rev() {
            for k in i + 1..6 {
                y[i] -= self.l[k][i] * y[k];
            }
            y[i] *= self.l[i][i];
        }
        Spatial { angular: [y[0], y[1], y[2]], linear: [y[3], y[4], y[5]] }
    }
}
