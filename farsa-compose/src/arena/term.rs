//! Terms of the fitness for robots in an arena.

use farsa_lab::Error;
use farsa_physics::arena;

use crate::arena::ArenaWorld;
use crate::arena::registered::{self, PartOfPlanar};
use crate::arena::scene::Scene;
use crate::check::source::Source;
use crate::document::RewardKind;
use crate::formula::channels::{ChannelNames, Channels};
use crate::formula::compile::{Formula, Quantity, Scope};
use crate::formula::program::Program;
use crate::part::object::PlanarTerm;
use crate::part::{self, Moment};

/// A term with its measure.
#[derive(Clone, Debug)]
pub(crate) struct Term {
    measure: Measure,
    is_of_team: bool,
    /// Robots of the mean in a formula, from the first up to the one after the last, by default the measured one.
    about: Option<[usize; 2]>,
}

#[derive(Clone, Debug)]
enum Measure {
    /// For each robot.
    Robots(Vec<Box<dyn PlanarTerm>>),
    Channels(Channels),
    Formula(Box<Formula<Term>>),
    /// A formula of one quantity of each robot.
    Changed(Box<Program>, Vec<Box<dyn PlanarTerm>>),
}

impl Term {
    /// Reads the term at a path of the document. `channels` are those of a robot.
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
            let mut make = |quantity: &Quantity, path: &str| {
                Ok((Self::from_quantity(quantity, path, channels, scene, source)?, 0))
            };
            let mut formula = Scope { path: &path, channels, source }.term(formula, &mut make)?;
            if formula.program.is_one_quantity()
                && let Some(term) = formula.terms.pop_if(|term| term.about.is_none())
            {
                return Ok(term);
            }
            if formula.program.is_of_one_quantity()
                && let [Self { measure: Measure::Robots(terms), about: None, is_of_team }] = &formula.terms[..]
            {
                let measure = Measure::Changed(Box::new(formula.program), terms.clone());
                return Ok(Self { measure, is_of_team: *is_of_team, about: None });
            }
            let is_of_team = formula.terms.iter().all(Self::is_of_team);
            return Ok(Self { measure: Measure::Formula(Box::new(formula)), is_of_team, about: None });
        }
        let term = |robot| {
            let sensors = channels.sensors;
            registered::term(kind, PartOfPlanar { scene, robot, files: None, rule: None, sensors, path, source })
        };
        let terms = (0..scene.robots.len()).map(term).collect::<Result<_, _>>()?;
        let is_of_team = facts.is_some_and(|facts| facts.is_of_team());
        Ok(Self { measure: Measure::Robots(terms), is_of_team, about: None })
    }

    /// Reads the term of a formula's quantity.
    pub(crate) fn from_quantity(
        quantity: &Quantity,
        path: &str,
        channels: ChannelNames<'_>,
        scene: &Scene,
        source: &Source,
    ) -> Result<Self, Error> {
        match quantity {
            Quantity::Measure(kind, subject) => {
                registered::check_term(kind, path, source)?;
                let (mut kind, mut subject) = (kind.clone(), subject.clone());
                subject = subject.or_else(|| kind.take_body());
                let about = subject.map(|name| scene.robots_named(&name, path, source)).transpose()?;
                Ok(Self { about, ..Self::new(&kind, path, channels, scene, source)? })
            }
            Quantity::Channels(channels) => {
                Ok(Self { measure: Measure::Channels(*channels), is_of_team: false, about: None })
            }
        }
    }

    /// Checks if the measure has one value for the whole team.
    pub(crate) fn is_of_team(&self) -> bool {
        self.is_of_team
    }

    /// Checks if the measure has a state that each step updates.
    pub(crate) fn has_state(&self) -> bool {
        match &self.measure {
            Measure::Robots(terms) | Measure::Changed(_, terms) => {
                terms.iter().any(|term| part::Term::<arena::World>::has_state(&**term))
            }
            Measure::Channels(_) => false,
            Measure::Formula(formula) => formula.terms.iter().any(Self::has_state),
        }
    }

    /// Stores the state at the start of a trial.
    pub(crate) fn begin<W: ArenaWorld>(&mut self, world: &W, now: &Moment<'_>) {
        match &mut self.measure {
            Measure::Robots(terms) | Measure::Changed(_, terms) => {
                for term in terms {
                    world.begin(&mut **term, now);
                }
            }
            Measure::Channels(_) => {}
            Measure::Formula(formula) => formula.terms.iter_mut().for_each(|term| term.begin(world, now)),
        }
    }

    /// Updates the state after a step.
    pub(crate) fn step<W: ArenaWorld>(&mut self, world: &W, now: &Moment<'_>) {
        match &mut self.measure {
            Measure::Robots(terms) | Measure::Changed(_, terms) => {
                for term in terms {
                    world.step_term(&mut **term, now);
                }
            }
            Measure::Channels(_) => {}
            Measure::Formula(formula) => formula.terms.iter_mut().for_each(|term| term.step(world, now)),
        }
    }

    /// Returns the robots that a quantity of a condition is about, by default all.
    pub(crate) fn about(&self) -> Option<[usize; 2]> {
        self.about
    }

    /// Computes the measure of robot number `robot`.
    #[inline(always)]
    pub(crate) fn value<W: ArenaWorld>(&self, world: &W, now: &Moment<'_>, robot: usize) -> f64 {
        match &self.measure {
            Measure::Robots(terms) => terms.get(robot).map_or(f64::NAN, |term| world.value(&**term, now)),
            Measure::Channels(channels) => channels.value(now.sensed(robot), now.driven(robot)),
            Measure::Formula(formula) => Self::formula_value(formula, world, now, robot),
            Measure::Changed(program, terms) => {
                program.of_one_quantity(terms.get(robot).map_or(f64::NAN, |term| world.value(&**term, now)))
            }
        }
    }

    /// Computes a formula.
    #[inline(never)]
    fn formula_value<W: ArenaWorld>(formula: &Formula<Self>, world: &W, now: &Moment<'_>, robot: usize) -> f64 {
        formula.program.evaluate(|number| {
            let term = &formula.terms[number];
            match (&term.measure, term.about) {
                (Measure::Robots(terms), None) => terms.get(robot).map_or(f64::NAN, |term| world.value(&**term, now)),
                _ => term.other_value(world, now, robot),
            }
        })
    }

    /// Computes the mean over the robots that the quantity is about, or a channel.
    #[inline(never)]
    fn other_value<W: ArenaWorld>(&self, world: &W, now: &Moment<'_>, robot: usize) -> f64 {
        let value = |robot: usize| match &self.measure {
            Measure::Robots(terms) => terms.get(robot).map_or(f64::NAN, |term| world.value(&**term, now)),
            Measure::Channels(channels) => channels.value(now.sensed(robot), now.driven(robot)),
            // Terms of formulas are no formulas.
            Measure::Formula(_) | Measure::Changed(..) => f64::NAN,
        };
        let Some([first, end]) = self.about else { return value(robot) };
        // A smaller team lacks its last robots.
        let robots = first..end.min(now.poses.len());
        let count = robots.len().max(1) as f64;
        robots.map(value).sum::<f64>() / count
    }
}
