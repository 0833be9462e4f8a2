//! Contacts with a pyramid of friction, as MuJoCo's by default.
//!
//! A point has four edges e = n + m t, n - m t for both tangents t, with the friction m. The force along each is that of
//! a separate contact: `f = max(0, -k (x + h u) - d v+ - I (v+ - v) / h)`, with the gap x, and the speeds v before and
//! v+ after the step along e. The gap changes at the normal speed, so the spring has `u = v+ - w` with the predicted
//! speed w along m t or -m t. This is implicit in v+, and stiff springs remain stable.

use farsa_num::Scalar;

use crate::articulated::solver::Block;
use crate::articulated::spatial::{Vector, cross, dot, scale, select, sub};

/// Law of each edge of a point. As a row of impulses it is `v+ + c l + o = 0` where it pushes, with
/// `c = 1 / (h^2 k + h d + I)` and `o = c (h k (x - h w) - I v)`.
pub(crate) struct EdgeLaw<S> {
    pub(crate) friction: S,
    /// Duration of the step, and the gap x.
    pub(crate) h: S,
    pub(crate) height: S,
    /// `h k`, d and I of the four edges together.
    pub(crate) spring: S,
    pub(crate) damping: S,
    pub(crate) inertia: S,
}

/// Tangents of MuJoCo's contact frames (`mju_makeFrame`).
#[inline(always)]
pub(crate) fn edge_tangents<S: Scalar>(normal: Vector<S>) -> [Vector<S>; 2] {
    let (zero, one) = (normal[0].constant(0.0), normal[0].constant(1.0));
    let half = normal[0].constant(0.5);
    let across = select(normal[1].abs().lt(half), [zero, one, zero], [zero, zero, one]);
    let along = sub(across, scale(normal, dot(across, normal)));
    let first = scale(along, one / dot(along, along).sqrt());
    [first, cross(normal, first)]
}

/// Tangent and sign of an edge.
const EDGES: [(usize, f64); 4] = [(1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)];

/// Rounds over the edges of a point. Opposite edges work against each other, and with one round a body
/// that is held by friction can creep against its push.
const ROUNDS: usize = 4;

impl<S: Scalar> EdgeLaw<S> {
    /// Completes a block with the velocities along its axes, predicted and before the step, and the impulse of the last step.
    #[inline(always)]
    pub(crate) fn block(&self, mut block: Block<S>, velocity: [S; 3], before: [S; 3], old: [S; 3]) -> Block<S> {
        let (zero, one, quarter) = (old[0].constant(0.0), old[0].constant(1.0), old[0].constant(0.25));
        let [spring, inertia] = [self.spring * quarter, self.inertia * quarter];
        block.compliance = one / (self.h * (spring + self.damping * quarter) + inertia);
        block.offset = (spring * self.height - inertia * before[0]) * block.compliance;
        // The part of the offset for speeds along a tangent belongs to these.
        let across = |k: usize| velocity[k] - (self.h * spring * velocity[k] + inertia * before[k]) * block.compliance;
        block.velocity = [velocity[0], across(1), across(2)];
        // The edges that have the old impulse: the least across, and equal parts of the rest.
        let across = [old[1] / self.friction, old[2] / self.friction];
        let rest = (old[0] - across[0].abs() - across[1].abs()).max(zero) * quarter;
        let mut edges = [zero; 4];
        let mut inverse = [zero; 4];
        for (edge, (k, sign)) in EDGES.into_iter().enumerate() {
            let lever = self.friction * zero.constant(sign);
            let load = (across[k - 1] * zero.constant(sign)).max(zero) + rest;
            edges[edge] = S::select(block.mask & old[0].gt(zero), load, zero);
            let [a, b] = [block.response[0], block.response[k]];
            let mixed = block.response[k + 2];
            let own = a + lever * (mixed + mixed + lever * b);
            inverse[edge] = one / (own + block.compliance);
        }
        block.set_edges(edges, inverse);
        block.impulse = total(edges, self.friction);
        block
    }
}

/// The impulse along the axes of the edges' impulses.
#[inline(always)]
fn total<S: Scalar>([a, b, c, d]: [S; 4], friction: S) -> [S; 3] {
    [(a + b) + (c + d), friction * (a - b), friction * (c - d)]
}

/// Brings the impulses of the edges to their law in the lanes of `mask`, given all others and the velocities `v` along the
/// axes. Returns the change of the impulse.
#[inline(always)]
pub(crate) fn relax_edges<S: Scalar>(block: &mut Block<S>, friction: S, mut v: [S; 3], mask: S::Mask) -> [S; 3] {
    let zero = friction.constant(0.0);
    let [a00, a11, a22, a01, a02, a12] = block.response;
    let response = [[a00, a01, a02], [a01, a11, a12], [a02, a12, a22]];
    let (mut edges, inverse) = block.edges();
    for (edge, (k, sign)) in (0..ROUNDS).flat_map(|_| EDGES.into_iter().enumerate()) {
        let lever = friction * zero.constant(sign);
        let old = edges[edge];
        let speed = v[0] + lever * v[k] + block.compliance * old + block.offset;
        let new = S::select(mask, (old - speed * inverse[edge]).max(zero), old);
        let change = new - old;
        edges[edge] = new;
        for (v, row) in v.iter_mut().zip(&response) {
            *v += (row[0] + lever * row[k]) * change;
        }
    }
    block.set_edges(edges, inverse);
    let new = total(edges, friction);
    let difference = sub(new, block.impulse);
    block.impulse = select(mask, new, block.impulse);
    select(mask, difference, [zero; 3])
}

#[cfg(test)]
mod tests {
    use core::cmp::Ordering;

    use farsa_num::{Domain, Stream};

    use super::*;

    /// Impulses of random points satisfy the law of each edge by itself, with the velocities after all four.
    #[test]
    fn each_edge_keeps_its_law() {
        let mut stream = Stream::new(5, Domain::General, 0, 0, 0);
        let mut random = |low: f64, high: f64| low + (high - low) * f64::from(stream.uniform());
        let (mut pushing, mut idle) = (0, 0);
        for _ in 0..200 {
            // A response L L^T with a diagonal that is not small.
            let l: [[f64; 3]; 3] = core::array::from_fn(|i| {
                core::array::from_fn(|j| match j.cmp(&i) {
                    Ordering::Less => random(-0.5, 0.5),
                    Ordering::Equal => random(0.5, 1.5),
                    Ordering::Greater => 0.0,
                })
            });
            let a = |i: usize, j: usize| (0..3).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            let response = [a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(0, 2), a(1, 2)];
            let (h, friction, height) = (0.01, random(0.1, 2.0), random(-0.01, 0.0));
            let (k, d, inertia) = (random(10.0, 1e4), random(1.0, 100.0), random(0.1, 4.0));
            let [velocity, before] = [(); 2].map(|()| [random(-1.0, 0.5), random(-1.0, 1.0), random(-1.0, 1.0)]);
            let law = EdgeLaw { friction, h, height, spring: h * k, damping: d, inertia };
            let start = Block { mask: true, response, ..Block::<f64>::new(()) };
            let mut block = law.block(start, velocity, before, [0.02, 0.004, -0.003]);
            let at = |block: &Block<f64>, from: [f64; 3]| {
                let p = block.impulse;
                [0, 1, 2].map(|i| from[i] + (0..3).map(|j| a(i, j) * p[j]).sum::<f64>())
            };
            for _ in 0..2000 {
                let v = at(&block, block.velocity);
                relax_edges(&mut block, friction, v, true);
            }
            let (edges, after) = (block.edges().0, at(&block, velocity));
            for ((i, sign), impulse) in EDGES.into_iter().zip(edges) {
                let lever = sign * friction;
                let [v, old] = [after, before].map(|v| v[0] + lever * v[i]);
                let normal = v - lever * velocity[i];
                let force = -k / 4.0 * (height + h * normal) - d / 4.0 * v - inertia / 4.0 * (v - old) / h;
                let wanted = (h * force).max(0.0);
                assert!((impulse - wanted).abs() < 1e-9 * (1.0 + impulse), "{impulse}, not {wanted}");
                pushing += usize::from(impulse > 0.0);
                idle += usize::from(impulse == 0.0);
            }
        }
        assert!(pushing > 200 && idle > 100, "{pushing} {idle}");
    }
}
