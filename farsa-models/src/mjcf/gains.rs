//! Laws of MuJoCo's actuators: the numbers of an element and of the classes behind it.

use crate::error::ReadError;
use crate::mjcf::classes::{Classed, Classes};
use crate::xml::tree::Element;

/// Force of an actuator: gain x control + position x length + speed x velocity.
///
/// MuJoCo's documentation, "Computation, Actuation model": the kinds of actuators are words for `general`, with a fixed
/// `gainprm` and an affine `biasprm`. A servo is gain = kp, position = -kp, speed = -kv.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Gains {
    pub(crate) gain: f64,
    /// Constant, position and speed.
    bias: [f64; 3],
    fixed: bool,
    /// `biastype`, if it is "none" or "affine".
    affine: Option<bool>,
    dynamic: Option<Dynamic>,
}

/// States of an actuator.
#[derive(Clone, Copy, PartialEq)]
enum Dynamic {
    /// The filter of a position servo.
    TimeConstant,
    Other,
}

/// Numbers with which an element of a class begins, for the kinds `general`, `position` and `velocity`.
///
/// MuJoCo 4.0: a `general` begins with the state of its class. The others do so if a `general` or their own kind left
/// it, and otherwise begin with the state of the nearest enclosing class for which this holds.
pub(crate) struct ClassGains(Vec<[Gains; 3]>);

/// Index of a kind in the numbers of a class.
fn index(tag: &str) -> Option<usize> {
    ["general", "position", "velocity"].iter().position(|kind| *kind == tag)
}

impl ClassGains {
    pub(crate) fn new(classes: &Classes<'_>) -> Result<Self, ReadError> {
        let mut all: Vec<[Gains; 3]> = Vec::new();
        for (parent, elements) in classes.each() {
            let inherited = parent.map_or([Gains::MOTOR; 3], |parent| all[parent]);
            let mut gains = inherited;
            for element in elements.iter().filter(|element| crate::mjcf::classes::ACTUATORS.contains(&element.tag())) {
                let own = index(element.tag());
                let changed = own.map_or(Gains::MOTOR, |index| gains[index]).changed(*element)?;
                gains = if own == Some(0) { [changed; 3] } else { [changed, inherited[1], inherited[2]] };
                if let Some(index) = own {
                    gains[index] = changed;
                }
            }
            all.push(gains);
        }
        Ok(Self(all))
    }

    /// Returns the numbers of an actuator.
    pub(crate) fn of(&self, classed: &Classed<'_, '_>) -> Result<Gains, ReadError> {
        let start = index(classed.element.tag()).map_or(Gains::MOTOR, |index| self.0[classed.class()][index]);
        start.changed(classed.element)
    }
}

impl Gains {
    /// A motor.
    const MOTOR: Self = Self { gain: 1.0, bias: [0.0; 3], fixed: true, affine: Some(false), dynamic: None };

    /// Returns the numbers after an element of any kind.
    fn changed(self, element: Element<'_>) -> Result<Self, ReadError> {
        let number = |name| {
            let number = element.number(name)?;
            match number.filter(|number| *number < 0.0) {
                Some(_) => {
                    Err(element.wrong(name, element.attribute(name).unwrap_or_default(), "but must not be negative"))
                }
                None => Ok(number),
            }
        };
        let gain = if self.fixed { self.gain } else { 1.0 };
        Ok(match element.tag() {
            "general" => self.general(element)?,
            "motor" => Self::MOTOR,
            "position" => {
                let gain = element.number("kp")?.unwrap_or(gain);
                let mut speed = self.bias[2];
                match (number("kv")?, number("dampratio")?) {
                    (Some(_), Some(_)) => {
                        return Err(element.wrong(
                            "dampratio",
                            element.needed("dampratio")?,
                            "but there is `kv` already",
                        ));
                    }
                    (Some(kv), None) => speed = -kv,
                    (None, Some(ratio)) => speed = ratio,
                    (None, None) => {}
                }
                let kept = self.dynamic.filter(|dynamic| *dynamic == Dynamic::TimeConstant);
                let dynamic =
                    number("timeconst")?.map_or(kept, |constant| (constant != 0.0).then_some(Dynamic::TimeConstant));
                Self { gain, bias: [0.0, -gain, speed], fixed: true, affine: Some(true), dynamic }
            }
            "velocity" => {
                let gain = element.number("kv")?.unwrap_or(gain);
                Self { gain, bias: [0.0, 0.0, -gain], fixed: true, affine: Some(true), dynamic: None }
            }
            "adhesion" => Self { gain: element.number("gain")?.unwrap_or(1.0), ..Self::MOTOR },
            _ => Self { fixed: false, affine: None, dynamic: Some(Dynamic::Other), ..Self::MOTOR },
        })
    }

    fn general(self, element: Element<'_>) -> Result<Self, ReadError> {
        let mut gains = self;
        let word = |name, default| element.attribute(name).map_or(default, |word| word);
        gains.fixed = word("gaintype", if self.fixed { "fixed" } else { "" }) == "fixed";
        gains.affine = match element.attribute("biastype") {
            None => self.affine,
            Some("none") => Some(false),
            Some("affine") => Some(true),
            Some(_) => None,
        };
        gains.dynamic = match element.attribute("dyntype") {
            None => self.dynamic,
            Some("none") => None,
            Some("filterexact") => Some(Dynamic::TimeConstant),
            Some(_) => Some(Dynamic::Other),
        };
        gains.gain = element.list("gainprm", 1, 20)?.map_or(self.gain, |list| list[0]);
        for (to, from) in gains.bias.iter_mut().zip(element.list("biasprm", 1, 20)?.unwrap_or_default()) {
            *to = from;
        }
        Ok(gains)
    }

    /// Returns the factors of length and velocity, or `None` if a description has no such law.
    pub(crate) fn law(&self) -> Option<[f64; 2]> {
        let affine = self.affine.filter(|_| self.fixed && self.dynamic != Some(Dynamic::Other))?;
        match self.bias {
            _ if !affine => Some([0.0; 2]),
            [0.0, position, _] if self.has_ratio() => Some([position, 0.0]),
            [0.0, position, speed] => Some([position, speed]),
            _ => None,
        }
    }

    /// Checks whether MuJoCo computes the damping of a servo from a ratio: its positive factor of the velocity.
    pub(crate) fn has_ratio(&self) -> bool {
        let [constant, position, speed] = self.bias;
        self.affine == Some(true) && constant == 0.0 && position == -self.gain && speed > 0.0
    }

    /// Checks whether commands pass through a filter.
    pub(crate) fn is_filtered(&self) -> bool {
        self.dynamic == Some(Dynamic::TimeConstant)
    }
}
