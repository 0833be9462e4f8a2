//! Contacts.

use farsa_body::ports::{Contacts, PairId};
use farsa_lab::Error;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::part::{Moment, PartScene, Term, TermPart};
use crate::terms::place::yes;

/// 1 while the robot touches something.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct Touch {
    /// Bodies of a robot with joints, by default all of them.
    #[serde(default)]
    bodies: Vec<String>,
    /// The only thing that counts, or `floor`, for a robot with joints.
    with: Option<String>,
}

/// Contact pairs, of which one has to touch.
#[derive(Clone, Debug)]
pub(super) struct TouchTerm(pub(super) Vec<PairId>);

impl<W: Contacts> Term<W> for TouchTerm {
    fn value(&self, world: &W, _: &Moment<'_>) -> f64 {
        yes(self.0.iter().any(|pair| world.touches(*pair)))
    }

    fn has_state(&self) -> bool {
        false
    }
}

impl TermPart for Touch {
    type Term = TouchTerm;

    fn term(&self, scene: &PartScene<'_>) -> Result<TouchTerm, Error> {
        Ok(TouchTerm(scene.0.touching(&self.bodies, self.with.as_ref())?))
    }
}
