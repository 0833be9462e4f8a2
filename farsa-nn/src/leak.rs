//! The three readings of a hidden neuron's leak.

use core::fmt;
use core::str::FromStr;

use crate::Error;
use crate::name::same_letters;

/// How a hidden neuron with leak `d` [0..1] forms its activation `H(t)` from its response `y(t) = sigma(net(t))`.
///
/// The source prints one equation and describes another, and its program ran a third; so each reading has a name and a
/// run records which it used.
///
/// Source: `[Ferrauto2010]` chapter 2. Deviation: the default is [`Leak::Filter`], not the printed equation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Leak {
    /// `H(t) = d*y(t) + (1-d)*H(t-1)`: the low-pass filter that the source's words describe.
    // The source calls d the time constant of leaky-integrator neurons; the printed equation has no integrator.
    #[default]
    Filter,
    /// `H(t) = d*y(t) + (1-d)*y(t-1)`: the equation as printed, a memory of one step.
    TwoTap,
    /// `H(t) = d*H(t-1) + (1-d)*y(t)`: the original program, where `d` weights the old value (and is `|p|/range` of a
    /// gene `p`, clamped to [0, 1]).
    Evonet,
}

impl Leak {
    /// Every reading, in the order of their declaration.
    pub const ALL: [Self; 3] = [Self::Filter, Self::TwoTap, Self::Evonet];

    /// The name in configurations and logs: `filter`, `two-tap` or `evonet`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Filter => "filter",
            Self::TwoTap => "two-tap",
            Self::Evonet => "evonet",
        }
    }
}

impl fmt::Display for Leak {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Leak {
    type Err = Error;

    /// The reading of this name, in any case and with or without the hyphen, so that `TwoTap` is `two-tap`.
    ///
    /// # Errors
    /// [`Error::UnknownLeak`] when no reading has this name.
    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL.into_iter().find(|leak| same_letters(name, leak.name())).ok_or(Error::UnknownLeak)
    }
}
