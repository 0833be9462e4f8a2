//! Checks of the pairs of colliders that may touch.

use alloc::collections::BTreeSet;

use crate::robot::description::{Robot, SoftContact};
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
            let part = Part(&self.colliders[a].name);
            part.surface(&pair.surface)?;
            part.demand((0.0..=1.0).contains(&pair.restitution), "restitution", pair.restitution)?;
            if let Some(SoftContact { inertia, friction: [damping, own], margin, is_pyramid, impedance }) = pair.soft {
                part.not_negative("inertia of the contact", inertia)?;
                part.not_negative("damping of friction", damping)?;
                part.positive("inertia of friction", own)?;
                part.not_negative("margin of the contact", margin)?;
                part.impedance(impedance)?;
                if is_pyramid {
                    part.positive("friction of the pyramid", pair.surface.friction)?;
                    part.demand(pair.restitution == 0.0, "restitution of a pyramid", pair.restitution)?;
                }
            }
        }
        Ok(())
    }
}
