//! Pairs of colliders that may touch.

use alloc::collections::BTreeSet;

use crate::robot::description::Robot;
use crate::robot::shape::Shape;
use crate::robot::validation::{Part, RobotError, index};

impl Robot {
    /// Looks for what is wrong with the pairs.
    pub(super) fn validate_pairs(&self) -> Result<(), RobotError> {
        let mut seen = BTreeSet::new();
        for pair in &self.pairs {
            let [a, b] = pair.colliders;
            index("a pair", "collider", a, self.colliders.len())?;
            index("a pair", "collider", b, self.colliders.len())?;
            let colliders = || [self.colliders[a].name.clone(), self.colliders[b].name.clone()];
            if self.colliders[a].body == self.colliders[b].body {
                return Err(RobotError::SameBody { colliders: colliders() });
            }
            if !seen.insert([a.min(b), a.max(b)]) {
                return Err(RobotError::Twice { colliders: colliders() });
            }
            if self.colliders[a].shape == Shape::Plane && self.colliders[b].shape == Shape::Plane {
                return Err(RobotError::Shapes { colliders: colliders() });
            }
            Part(&self.colliders[a].name).surface(&pair.surface)?;
        }
        Ok(())
    }
}
