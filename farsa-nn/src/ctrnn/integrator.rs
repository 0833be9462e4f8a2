//! The integration methods of continuous-time networks.

use core::fmt;
use core::str::FromStr;

use crate::error::Error;
use crate::name::same_letters;

/// The method that integrates a [`Ctrnn`](crate::Ctrnn) from `t` to `t + dt` while the external inputs are constant.
///
/// The methods use `f_i(y) = ( -y_i + net_i(y) ) / tau_i` with the net input `net_i`:
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Integrator {
    /// Euler method, `y(t+dt) = y + dt f(y)`. It is of first order and unstable if `tau < dt/2`.
    #[default]
    Euler,
    /// Exponential Euler method, `y_i(t+dt) = net_i + (y_i - net_i) exp(-dt/tau_i)`. It is of first order, exact
    /// for constant `net`, and stable for every `tau`.
    ExponentialEuler,
    /// Classical fourth-order Runge-Kutta method with four evaluations per step. It is unstable if `tau <
    /// dt/2.785`.
    #[cfg_attr(feature = "serde", serde(rename = "runge-kutta-4"))]
    RungeKutta4,
}

impl Integrator {
    /// All integrators in the order of their declaration.
    pub const ALL: [Self; 3] = [Self::Euler, Self::ExponentialEuler, Self::RungeKutta4];

    /// Returns the name used in configurations and logs. This is `euler`, `exponential-euler` or `runge-kutta-4`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Euler => "euler",
            Self::ExponentialEuler => "exponential-euler",
            Self::RungeKutta4 => "runge-kutta-4",
        }
    }

    /// Returns the smallest time constant (in seconds) for which a single neuron does not diverge with the given time
    /// step (in seconds). This is 0 if the method is always stable.
    ///
    /// ```
    /// use farsa_nn::Integrator;
    ///
    /// assert_eq!(Integrator::Euler.least_time_constant(0.1), 0.05);
    /// ```
    pub fn least_time_constant(self, time_step: f32) -> f32 {
        match self {
            Self::Euler => 0.5 * time_step,
            Self::ExponentialEuler => 0.0,
            // 1 + z + z^2/2 + z^3/6 + z^4/24 is 1 at z = -2.7853.
            Self::RungeKutta4 => time_step / 2.785,
        }
    }
}

impl fmt::Display for Integrator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Integrator {
    type Err = Error;

    /// Parses the name of an integrator. Case and hyphens are ignored, so `RungeKutta4` is equivalent to
    /// `runge-kutta-4`.
    ///
    /// # Errors
    /// Returns [`Error::Name`] if the name is unknown.
    fn from_str(name: &str) -> Result<Self, Error> {
        Self::ALL
            .into_iter()
            .find(|integrator| same_letters(name, integrator.name()))
            .ok_or(Error::Name { of: "integrator", names: "euler, exponential-euler, runge-kutta-4" })
    }
}
