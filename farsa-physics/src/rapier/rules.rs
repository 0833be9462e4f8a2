//! Which colliders may touch, and with what friction: rapier requests every pair of colliders that come near.

use alloc::vec;
use alloc::vec::Vec;

use rapier3d::geometry::{Collider, SolverFlags};
use rapier3d::pipeline::{ContactModificationContext, PairFilterContext, PhysicsHooks};

/// No pair of the description.
const NONE: u16 = u16::MAX;

/// The pairs of colliders that may touch.
///
/// A collider bears its number plus one as user data. 0 is a collider that others put there, which touches everything.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    /// Number of colliders.
    width: usize,
    /// The number of the pair of two colliders [width * width].
    pairs: Vec<u16>,
    /// Coefficients of friction and restitution of each pair.
    surfaces: Vec<[f32; 2]>,
}

impl Rules {
    pub(crate) fn new(width: usize, pairs: &[([usize; 2], [f64; 2])]) -> Self {
        let mut table = vec![NONE; width * width];
        for (number, &([a, b], _)) in pairs.iter().enumerate() {
            table[a * width + b] = number as u16;
            table[b * width + a] = number as u16;
        }
        Self { width, pairs: table, surfaces: pairs.iter().map(|(_, surface)| surface.map(|x| x as f32)).collect() }
    }

    /// Returns the mark of a collider with this number.
    pub(crate) fn mark(number: usize) -> u128 {
        number as u128 + 1
    }

    /// The number of a collider, or `None` for one of others.
    pub(crate) fn number(collider: &Collider) -> Option<usize> {
        usize::try_from(collider.user_data).ok()?.checked_sub(1)
    }

    /// The pair of two colliders. `Err` for a collider of others.
    fn pair(&self, a: &Collider, b: &Collider) -> Result<Option<usize>, ()> {
        let (Some(a), Some(b)) = (Self::number(a), Self::number(b)) else { return Err(()) };
        let pair = self.pairs.get(a * self.width + b).copied().unwrap_or(NONE);
        Ok((pair != NONE).then_some(usize::from(pair)))
    }
}

impl PhysicsHooks for Rules {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        match self.pair(&context.colliders[context.collider1], &context.colliders[context.collider2]) {
            Ok(None) => None,
            _ => Some(SolverFlags::COMPUTE_RIGID_IMPULSES),
        }
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let pair = self.pair(&context.colliders[context.collider1], &context.colliders[context.collider2]);
        if let Ok(Some(pair)) = pair
            && let Some(manifold) = context.rigid_mut()
        {
            [*manifold.friction, *manifold.restitution] = self.surfaces[pair];
        }
    }
}
