//! Checks of the pairs of colliders that may touch.

use alloc::collections::BTreeSet;

use crate::robot::description::Robot;
use crate::robot::shape::Shape;
use crate::robot::validation::{PairFault, Part, RobotError, index};

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
                return Err(RobotError::Pair { colliders: colliders(), fault: PairFault::SameBody });
            }
            if !seen.insert([a.min(b), a.max(b)]) {
                return Err(RobotError::Pair { colliders: colliders(), fault: PairFault::Twice });
            }
            if self.colliders[a].shape == Shape::Plane && self.colliders[b].shape == Shape::Plane {
                return Err(RobotError::Pair { colliders: colliders(), fault: PairFault::Shapes });
            }
            Part(&self.colliders[a].name).surface(&pair.surface)?;
        }
        Ok(())
    }
}
