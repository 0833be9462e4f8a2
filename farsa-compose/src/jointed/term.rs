//! Terms of the fitness for a robot with joints.

use farsa_lab::Error;
use farsa_physics::articulated;

use crate::check::source::Source;
use crate::document::RewardKind;
use crate::formula::channels::{ChannelNames, Channels};
use crate::formula::compile::{Formula, Quantity, Scope};
use crate::jointed::SpatialWorld;
use crate::jointed::registered::{self, PartOfSpatial};
use crate::jointed::scene::Scene;
use crate::part::object::SpatialTerm;
use crate::part::{self, Moment};

/// A term with its measure.
#[derive(Clone, Debug)]
pub(crate) struct Term {
    measure: Measure,
}

#[derive(Clone, Debug)]
enum Measure {
    Robot(Box<dyn SpatialTerm>),
    Channels(Channels),
    Formula(Box<Formula<Term>>),
}

impl Term {
    /// Reads a term at a path of the document. `channels` are those of the robot.
    pub(crate) fn new(
        kind: &RewardKind,
        path: &str,
        channels: ChannelNames<'_>,
        scene: &Scene,
        source: &Source,
    ) -> Result<Self, Error> {
        let facts = source.registry.term(kind);
        if let Some(formula) = facts.as_ref().and_then(|facts| facts.formula()) {
            let path = format!("{path}/formula");
            let mut make =
                |quantity: &Quantity, path: &str| Self::from_quantity(quantity, path, channels, scene, source);
            let mut formula = Scope { path: &path, channels, source }.term(formula, &mut make)?;
            if formula.program.is_one_quantity()
                && let Some(term) = formula.terms.pop()
            {
                return Ok(term);
            }
            return Ok(Self { measure: Measure::Formula(Box::new(formula)) });
        }
        let sensors = channels.sensors;
        let part = PartOfSpatial { scene, wiring: None, rule: None, sensors, path, source };
        Ok(Self { measure: Measure::Robot(registered::term(kind, part)?) })
    }

    /// Reads the term of a formula's quantity, with the number of its unit: 0 for hinges and 1 for rails.
    pub(crate) fn from_quantity(
        quantity: &Quantity,
        path: &str,
        channels: ChannelNames<'_>,
        scene: &Scene,
        source: &Source,
    ) -> Result<(Self, usize), Error> {
        let touch;
        let kind = match quantity {
            Quantity::Measure(kind, None) => kind,
            Quantity::Measure(kind, Some(body)) => {
                let of_body = kind.as_touch_of(body);
                touch = of_body
                    .ok_or_else(|| source.wrong(path, format!("is about the whole robot; `{body}` cannot be named")))?;
                &touch
            }
            Quantity::Channels(channels) => {
                return Ok((Self { measure: Measure::Channels(*channels) }, 0));
            }
        };
        let term = Self::new(kind, path, channels, scene, source)?;
        let facts = source.registry.term(kind);
        let Some(names) = facts.as_ref().and_then(|facts| facts.joints()) else { return Ok((term, 0)) };
        let joints = scene.joints(names, |_| true, path, source)?;
        let rails = joints.iter().filter(|joint| scene.is_rail(**joint)).count();
        if (1..joints.len()).contains(&rails) {
            return Err(source.wrong(path, "mixes hinges and rails, whose units differ; name the joints"));
        }
        Ok((term, usize::from(rails > 0)))
    }

    /// Checks if the measure has a state that each step updates.
    pub(crate) fn has_state(&self) -> bool {
        match &self.measure {
            Measure::Robot(term) => part::Term::<articulated::World<f32>>::has_state(&**term),
            Measure::Channels(_) => false,
            Measure::Formula(formula) => formula.terms.iter().any(Self::has_state),
        }
    }

    /// Stores the state at the start of a trial.
    pub(crate) fn begin<W: SpatialWorld>(&mut self, world: &W, now: &Moment<'_>) {
        match &mut self.measure {
            Measure::Robot(term) => world.begin(&mut **term, now),
            Measure::Channels(_) => {}
            Measure::Formula(formula) => formula.terms.iter_mut().for_each(|term| term.begin(world, now)),
        }
    }

    /// Updates the state after a step.
    pub(crate) fn step<W: SpatialWorld>(&mut self, world: &W, now: &Moment<'_>) {
        match &mut self.measure {
            Measure::Robot(term) => world.step_term(&mut **term, now),
            Measure::Channels(_) => {}
            Measure::Formula(formula) => formula.terms.iter_mut().for_each(|term| term.step(world, now)),
        }
    }

    /// Computes the measure after a step.
    pub(crate) fn value<W: SpatialWorld>(&self, world: &W, now: &Moment<'_>) -> f64 {
        match &self.measure {
            Measure::Robot(term) => world.value(&**term, now),
            Measure::Channels(channels) => channels.value(now.sensed(0), now.driven(0)),
            Measure::Formula(formula) => formula.program.evaluate(|number| formula.terms[number].value(world, now)),
        }
    }
}
