//! Moves and pushes of bodies in an episode, with the world's numbers of bodies.

use farsa_body::ports::BodyId;
use farsa_view::Schema;
use serde::Deserialize;

use crate::error::Error;
use crate::experiment::disturbance::{Displacement, Push};
use crate::experiment::evaluator::Evaluator;

/// Largest force [N], above which the simulated contacts lose their meaning.
const MAX_FORCE: f32 = 1e5;

/// Moves and pushes of bodies, whose numbers are those of a page or of the world.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Disturbances {
    pub(crate) moves: Vec<Displacement>,
    pub(crate) pushes: Vec<Push>,
}

impl Disturbances {
    /// Replaces the body numbers of a page by those of the world.
    ///
    /// # Errors
    /// [`Error::Usage`] for an experiment without such bodies, an unknown body and an invalid pose or force.
    pub(crate) fn in_world(&self, evaluator: &dyn Evaluator, name: &str, schema: &Schema) -> Result<Self, Error> {
        let Self { moves, pushes } = self;
        for (verb, count, supported) in
            [("moved", moves.len(), evaluator.displaces()), ("pushed", pushes.len(), evaluator.pushes())]
        {
            if count > 0 && !supported {
                return Err(Error::Usage(format!("experiment `{name}` has no bodies that can be {verb}")));
            }
        }
        let shown: Vec<BodyId> = schema.shown().collect();
        let body = |body: u16| {
            let unknown = || Error::Usage(format!("body {body} of {} (the first is 0)", shown.len()));
            shown.get(usize::from(body)).map(|body| body.0).ok_or_else(unknown)
        };
        let displacement = |displacement: &Displacement| {
            let Displacement { position, rotation, .. } = *displacement;
            let length = rotation.iter().map(|x| x * x).sum::<f32>();
            if !position.iter().all(|x| x.is_finite()) || !(0.5..2.0).contains(&length) {
                return Err(Error::Usage(format!("a body at {position:?}, turned by {rotation:?}")));
            }
            Ok(Displacement { body: body(displacement.body)?, ..*displacement })
        };
        let push = |push: &Push| {
            let Push { point, force, .. } = *push;
            let bounded = force.iter().all(|x| x.abs() <= MAX_FORCE);
            if !bounded || !point.iter().all(|x| x.is_finite()) {
                return Err(Error::Usage(format!("a force of {force:?} N at {point:?}, at most {MAX_FORCE} N")));
            }
            Ok(Push { body: body(push.body)?, ..*push })
        };
        let moves = moves.iter().map(displacement).collect::<Result<_, _>>()?;
        Ok(Self { moves, pushes: pushes.iter().map(push).collect::<Result<_, _>>()? })
    }

    /// Counts the moves and pushes in words.
    pub(crate) fn remarks(&self) -> impl Iterator<Item = String> {
        let counts = [(self.moves.len(), "moved"), (self.pushes.len(), "pushed")];
        counts.into_iter().filter(|(count, _)| *count > 0).map(|(count, verb)| format!("{count} {verb}"))
    }
}
