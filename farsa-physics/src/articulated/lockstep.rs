//! The compiled steps of batches, one for every instruction set and vector, here and nowhere else.
//!
//! Each takes the compiler about as long as the rest of the crate, so the crate's unit tests are built without them.
//! Sixteen worlds that fill no vector of the instruction set are two vectors of eight to the same step.
#![cfg_attr(
    all(target_arch = "wasm32", not(target_feature = "simd128")),
    allow(dead_code, unused_imports, reason = "there are no vectors")
)]

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use farsa_num::fearless_simd::f32x8;
use farsa_num::{Instructions, Mask as _, Scalar};

use crate::articulated::external::Wrenches;
use crate::articulated::group::{is_clear, unknown_gap};
use crate::articulated::lane::{LINK_WORDS, Words};
use crate::articulated::model::{Model, POINT_WORDS};
use crate::articulated::step::{Precision, Scratch, step};

/// Numbers of worlds that a [`Batch`](crate::articulated::Batch) can have.
pub const LANES: [usize; 2] = [8, 16];

/// Steps all worlds of a batch together.
pub(crate) trait Lockstep: Send + Sync {
    /// One control step from words to words.
    fn step(&mut self, model: &Model<f32>, words: &mut Words);
    /// Returns a copy.
    fn boxed_clone(&self) -> Box<dyn Lockstep>;
}

/// The worlds of a batch, as many at a time as a vector has lanes.
#[derive(Clone)]
struct Vectors<S: Scalar> {
    simd: S::Simd,
    shares: Vec<Share<S>>,
}

/// State and scratch of the worlds of a batch that one vector holds.
#[derive(Clone)]
struct Share<S: Scalar> {
    state: Vec<S>,
    scratch: Scratch<S>,
}

impl<S: Scalar<Real = f32>> Vectors<S> {
    /// Builds the steps for `lanes` worlds, a multiple of [`Scalar::LANES`].
    fn new(simd: S::Simd, model: &Model<f32>, lanes: usize) -> Self {
        let share = Share { state: vec![S::splat(simd, 0.0); model.state_len()], scratch: Scratch::new(simd, model) };
        Self { simd, shares: vec![share; lanes / S::LANES] }
    }

    #[inline(always)]
    fn run(&mut self, model: &Model<f32>, words: &mut Words) {
        for (index, share) in self.shares.iter_mut().enumerate() {
            share.run(self.simd, model, words, index * S::LANES);
        }
        words.arranged = false;
    }
}

impl<S: Scalar<Real = f32>> Share<S> {
    /// Steps the worlds from the one with index `lane` on.
    #[inline(always)]
    fn run(&mut self, simd: S::Simd, model: &Model<f32>, words: &mut Words, lane: usize) {
        let lanes = words.lanes;
        // One word of these worlds.
        let range = lane..lane + S::LANES;
        if words.arranged {
            for (x, from) in self.state.iter_mut().zip(words.state.chunks_exact(lanes)) {
                *x = S::load(simd, &from[range.clone()]);
            }
            // Untouched lanes come to the bits that they have.
            self.scratch.forward_kinematics(simd, model, &self.state);
        } else {
            let commands = model.first_command()..model.first_point();
            let from = words.state.chunks_exact(lanes).skip(commands.start);
            for (x, from) in self.state[commands].iter_mut().zip(from) {
                *x = S::load(simd, &from[range.clone()]);
            }
        }
        step(simd, model, &mut self.state, &mut self.scratch);
        self.store(simd, model, &mut words.state, lanes, lane);
        self.store_touching(simd, model, &mut words.touching, lanes, lane);
        for (w, to) in self.scratch.links.iter().zip(words.links.chunks_exact_mut(LINK_WORDS * lanes)) {
            let rotation = w.rotation.as_flattened();
            let velocity = [w.velocity.angular, w.velocity.linear];
            let all = [rotation, &w.position, &w.reference, velocity.as_flattened()];
            for (x, to) in all.into_iter().flatten().zip(to.chunks_exact_mut(lanes)) {
                x.store(&mut to[range.clone()]);
            }
        }
    }

    /// Writes which pairs touch. A world alone stops at the first point that does ([`is_touching`](crate::articulated::view::is_touching)).
    #[inline(always)]
    fn store_touching(&self, simd: S::Simd, model: &Model<f32>, to: &mut [f32], lanes: usize, lane: usize) {
        let (zero, one) = (S::splat(simd, 0.0), S::splat(simd, 1.0));
        for (pair, to) in model.pairs.iter().zip(to.chunks_exact_mut(lanes)) {
            let first = model.first_point() + POINT_WORDS * pair.point;
            let points = self.state[first..first + POINT_WORDS * pair.points].chunks_exact(POINT_WORDS);
            let touching = points.into_iter().fold(zero.lt(zero), |any, point| any | point[3].gt(zero));
            S::select(touching, one, zero).store(&mut to[lane..lane + S::LANES]);
        }
    }

    /// Copies the state, but for the points of groups that are far and were so before: their words are the same.
    #[inline(always)]
    fn store(&self, simd: S::Simd, model: &Model<f32>, to: &mut [f32], lanes: usize, lane: usize) {
        let copy = |range: Range<usize>, to: &mut [f32]| {
            let to = to[lanes * range.start..lanes * range.end].chunks_exact_mut(lanes);
            for (x, to) in self.state[range].iter().zip(to) {
                x.store(&mut to[lane..lane + S::LANES]);
            }
        };
        let first = model.first_point();
        copy(0..first, to);
        for group in &model.groups {
            let at = first + POINT_WORDS * group.points.start;
            let gap = lanes * (at + 7) + lane;
            let was_far = !S::load(simd, &to[gap..gap + S::LANES]).lt(unknown_gap(simd)).any();
            if !(was_far && is_clear(simd, &self.state[first..], group)) {
                copy(at..first + POINT_WORDS * group.points.end, to);
            }
        }
        copy(first + POINT_WORDS * model.points..self.state.len(), to);
    }
}

impl<S> Lockstep for Vectors<S>
where
    S: Scalar<Real = f32> + Send + Sync + 'static,
    S::Simd: Send + Sync,
    S::Mask: Send + Sync,
{
    fn step(&mut self, model: &Model<f32>, words: &mut Words) {
        S::vectorize(
            self.simd,
            #[inline(always)]
            || self.run(model, words),
        );
    }

    fn boxed_clone(&self) -> Box<dyn Lockstep> {
        Box::new(self.clone())
    }
}

/// The step of a world alone, for one world after the other: where there are no vectors.
///
/// Lanes made of scalars would step alike, and take the compiler more than ten minutes.
#[derive(Clone)]
struct OneByOne {
    state: Vec<f32>,
    scratch: Scratch<f32>,
    /// None, which the step requests.
    forces: Wrenches<f32>,
}

impl Lockstep for OneByOne {
    fn step(&mut self, model: &Model<f32>, words: &mut Words) {
        for lane in 0..words.lanes {
            words.load(lane, &mut self.state);
            // One scratch serves all lanes, and has the links of the one before.
            <f32 as Precision>::forward_kinematics(model, &self.state, &mut self.scratch);
            <f32 as Precision>::step(model, &mut self.state, &mut self.scratch, &mut self.forces);
            words.store(model, lane, &self.state, &self.scratch.links);
        }
        words.arranged = false;
    }

    fn boxed_clone(&self) -> Box<dyn Lockstep> {
        Box::new(self.clone())
    }
}

/// The instruction sets of this machine that there are steps for, narrowest first.
pub(crate) fn instructions() -> impl Iterator<Item = Instructions> {
    // SSE4.2 has nothing that the steps use.
    Instructions::available().filter(|one| *one != Instructions::Sse4_2)
}

/// Returns the steps of `lanes` lanes, one of [`LANES`], by the widest of these instructions with compiled steps.
pub(crate) fn lockstep(model: &Model<f32>, lanes: usize, instructions: Instructions) -> Box<dyn Lockstep> {
    let vectors = if instructions == Instructions::Fallback { None } else { in_vectors(instructions, model, lanes) };
    vectors.unwrap_or_else(|| {
        let (state, scratch) = (model.initial.clone(), Scratch::new((), model));
        Box::new(OneByOne { state, scratch, forces: Wrenches::new(model) })
    })
}

/// The steps in vectors, if there are any.
#[cfg(any(not(target_arch = "wasm32"), target_feature = "simd128"))]
fn in_vectors(instructions: Instructions, model: &Model<f32>, lanes: usize) -> Option<Box<dyn Lockstep>> {
    fn boxed<S: Scalar<Real = f32> + Send + Sync + 'static>(
        simd: S::Simd,
        model: &Model<f32>,
        lanes: usize,
    ) -> Box<dyn Lockstep>
    where
        S::Simd: Send + Sync,
        S::Mask: Send + Sync,
    {
        Box::new(Vectors::<S>::new(simd, model, lanes))
    }
    let level = instructions.level();
    if level.is_fallback() {
        return None;
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        use farsa_num::fearless_simd::f32x16;

        // Sixteen lanes fill a register of AVX-512 only. A separate step for sixteen took as long on SSE2 and AVX2 as
        // two halves.
        if let Some(simd) = level.as_avx512() {
            return Some(if lanes == LANES[0] {
                boxed::<f32x8<_>>(simd, model, lanes)
            } else {
                boxed::<f32x16<_>>(simd, model, lanes)
            });
        }
        if let Some(simd) = level.as_avx2() {
            return Some(boxed::<f32x8<_>>(simd, model, lanes));
        }
        if let Some(simd) = level.as_sse2() {
            return Some(boxed::<f32x8<_>>(simd, model, lanes));
        }
        None
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    Some(farsa_num::fearless_simd::dispatch!(level, simd => boxed::<f32x8<_>>(simd, model, lanes)))
}

/// WebAssembly for machines without vectors has none.
#[cfg(all(target_arch = "wasm32", not(target_feature = "simd128")))]
fn in_vectors(_: Instructions, _: &Model<f32>, _: usize) -> Option<Box<dyn Lockstep>> {
    None
}
