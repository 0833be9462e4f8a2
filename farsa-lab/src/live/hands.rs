//! What is asked to be done to the bodies of a trial, as its world has them.

use farsa_body::ports::BodyId;
use farsa_view::Schema;

use crate::error::Error;
use crate::experiment::evaluator::Evaluator;
use crate::experiment::{Displacement, Push};
use crate::live::request::Film;

/// Most bodies of a trial that are put elsewhere, and most pushes.
const MOST: usize = 1000;
/// The largest force [N]: ten times what crushes a robot's finger.
const LARGEST: f32 = 1e5;

/// The moves and pushes of a film, with the world's numbers of bodies in the place of the film's.
///
/// # Errors
/// [`Error::Usage`] for what cannot be put elsewhere or pushed, and too much of it.
pub(crate) fn hands(
    evaluator: &dyn Evaluator,
    name: &str,
    schema: &Schema,
    asked: &Film,
) -> Result<(Vec<Displacement>, Vec<Push>), Error> {
    let Film { moves, pushes, .. } = asked;
    for (what, count, can) in
        [("put elsewhere", moves.len(), evaluator.displaces()), ("pushed", pushes.len(), evaluator.pushes())]
    {
        if count > 0 && !can {
            return Err(Error::Usage(format!("experiment `{name}` has no bodies that can be {what}")));
        }
        if count > MOST {
            return Err(Error::Usage(format!("{count} bodies that are {what}, at most {MOST}")));
        }
    }
    let shown: Vec<BodyId> = schema.shown().collect();
    let body = |body: u16| {
        let none = || Error::Usage(format!("body {body} of {} (the first is 0)", shown.len()));
        shown.get(usize::from(body)).map(|body| body.0).ok_or_else(none)
    };
    let displacement = |one: &Displacement| {
        let Displacement { position, rotation, .. } = *one;
        let length = rotation.iter().map(|x| x * x).sum::<f32>();
        if !position.iter().all(|x| x.is_finite()) || !(0.5..2.0).contains(&length) {
            return Err(Error::Usage(format!("a body at {position:?}, turned by {rotation:?}")));
        }
        Ok(Displacement { body: body(one.body)?, ..*one })
    };
    let push = |one: &Push| {
        let Push { point, force, .. } = *one;
        let bounded = force.iter().all(|x| x.abs() <= LARGEST);
        if !bounded || !point.iter().all(|x| x.is_finite()) {
            return Err(Error::Usage(format!("a force of {force:?} N at {point:?}, at most {LARGEST} N")));
        }
        Ok(Push { body: body(one.body)?, ..*one })
    };
    Ok((moves.iter().map(displacement).collect::<Result<_, _>>()?, pushes.iter().map(push).collect::<Result<_, _>>()?))
}
