//! Configuration of the experiment `double-pole`, and its settings.

use core::f64::consts::PI;

use farsa_lab::{Error, Setting, Settings};

use crate::double_pole::cart::Cart;
use crate::double_pole::network::MOST_HIDDEN;

/// The configuration of the cart, the trial and the network. Settings marked as given have the defaults of
/// \[Gomez2008\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// If true, the network receives the velocities as additional inputs.
    pub velocities: bool,
    /// If true, the fitness also rewards rest \[Gruau1996\]. Otherwise it is the number of steps in balance.
    pub damping: bool,
    /// Cart with its poles.
    pub cart: Cart,
    /// Duration of an integration step (in seconds).
    pub time_step: f64,
    /// Number of integration steps between two steps of the network.
    pub substeps: u32,
    /// Largest number of network steps in a trial.
    pub steps: u32,
    /// Initial angle of the long pole in degrees.
    pub angle: f64,
    /// Angle at which a pole counts as fallen (in degrees).
    pub most_angle: f64,
    /// Largest distance of the cart from the middle of the track (in meters).
    pub most_position: f64,
    /// Largest force that the network can apply (in newtons).
    pub force: f64,
    /// Smallest magnitude of the force that the network can apply (in newtons).
    pub least_force: f64,
    /// Number of hidden neurons in the network.
    pub hidden: u32,
    /// Largest absolute value of a weight.
    pub weight_range: f64,
    /// Scales of the positions (in meters), angles (in radians) and velocities (in m/s or rad/s). Each input is
    /// divided by its scale.
    pub scales: [f64; 3],
}

impl Config {
    /// Returns the default configuration, with or without velocities as inputs.
    pub fn new(velocities: bool) -> Self {
        Self {
            velocities,
            damping: false,
            cart: Cart::default(),
            time_step: 0.01,
            substeps: 2,
            steps: 100_000,
            angle: 4.0,
            most_angle: 36.0,
            most_position: 2.4,
            force: 10.0,
            least_force: 10.0 / 256.0,
            hidden: 1,
            weight_range: 10.0,
            scales: [4.8, 0.52, 2.0],
        }
    }

    /// An angle in degrees \[rad\].
    pub(crate) fn radians(degrees: f64) -> f64 {
        degrees * (PI / 180.0)
    }

    /// Returns the number of inputs of the network.
    pub fn inputs(&self) -> usize {
        if self.velocities { 6 } else { 3 }
    }

    /// Returns the number of neurons, including the output neuron.
    pub fn neurons(&self) -> usize {
        self.hidden as usize + 1
    }

    /// Returns the table of settings with the values of this configuration as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let positive = |key: &str, value: f64| Setting::number(key, value, 1e-9..=1e6);
        let least = |key: &str, value: f64| Setting::number(key, value, 0.0..=1e6);
        let [long, short] = self.cart.poles;
        vec![
            Setting::whole("evolution.generations", 100, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            positive("cart.mass", self.cart.mass).unit("kg").given().doc("Mass of the cart."),
            least("cart.friction", self.cart.friction).unit("N").given().doc("Friction of the cart on its track, whatever its speed."),
            positive("cart.track", self.most_position)
                .unit("m")
                .given()
                .doc("A trial ends where the cart is farther than this from the middle of its track."),
            positive("cart.force", self.force).unit("N").given().doc("The largest force on the cart."),
            least("cart.least_force", self.least_force)
                .unit("N")
                .given()
                .doc("The smallest force, so that the poles cannot be left alone when they are upright."),
            Setting::numbers("poles.half_lengths", &[long.half_length, short.half_length], 1e-9..=1e6)
                .unit("m")
                .given()
                .doc("Half the lengths of the poles."),
            Setting::numbers("poles.masses", &[long.mass, short.mass], 1e-9..=1e6).unit("kg").given().doc("Their masses."),
            least("poles.friction", long.friction).unit("N m s").given().doc("Friction of their hinges."),
            Setting::number("poles.angle", self.angle, -90.0..=90.0)
                .unit("deg")
                .given()
                .doc("Angle of the first pole from upright at the start. All else is at rest in the middle."),
            Setting::number("poles.failure_angle", self.most_angle, 0.0..=90.0)
                .unit("deg")
                .given()
                .doc("A trial ends where a pole is farther than this from upright."),
            least("world.gravity", self.cart.gravity).unit("m/s^2").doc("Acceleration of gravity."),
            Setting::number("world.time_step", self.time_step, 1e-5..=0.1)
                .unit("s")
                .given()
                .doc("Step of the integration, a Runge-Kutta method of fourth order."),
            Setting::whole("world.substeps", i64::from(self.substeps), 1..=1000)
                .given()
                .doc("Steps of the integration for each step of the network."),
            Setting::whole("trial.steps", i64::from(self.steps), 100..=10_000_000)
                .given()
                .doc("Steps of the network in a trial. A network that balances both poles so long has succeeded."),
            Setting::flag("fitness.damping", self.damping).given().doc(
                "Whether fitness is 0.1 t / 1000 + 0.9 * 0.75 / S over the first 1000 steps, t of them in balance, S the sum of \
                 |position| + |velocity| + |angle| + |angular velocity| of cart and first pole over the last 100 of those, and \
                 without the second term for t < 100. Else it is the number of steps in balance.",
            ),
            Setting::whole("net.hidden", i64::from(self.hidden), 0..=i64::from(MOST_HIDDEN))
                .given()
                .doc("Hidden neurons of the fully recurrent network."),
            Setting::number("net.weight_range", self.weight_range, 0.1..=1000.0)
                .given()
                .doc("Weights are decoded to plus and minus this."),
            Setting::numbers("sensors.scales", &self.scales, 1e-9..=1e6)
                .doc("What position [m], angles [rad] and velocities [m/s, rad/s] are divided by before the network senses them."),
        ]
    }

    /// Reads a configuration from settings that have been checked.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the values are not compatible with each other.
    pub fn read(velocities: bool, settings: &Settings) -> Result<Self, Error> {
        let number = |key: &str| settings.number(key);
        let mut cart = Cart {
            mass: number("cart.mass")?,
            friction: number("cart.friction")?,
            gravity: number("world.gravity")?,
            ..Cart::default()
        };
        let (lengths, masses) = (settings.numbers("poles.half_lengths")?, settings.numbers("poles.masses")?);
        for ((pole, half_length), mass) in cart.poles.iter_mut().zip(lengths).zip(masses) {
            (pole.half_length, pole.mass, pole.friction) = (*half_length, *mass, number("poles.friction")?);
        }
        let mut scales = [1.0; 3];
        for (scale, given) in scales.iter_mut().zip(settings.numbers("sensors.scales")?) {
            *scale = *given;
        }
        let config = Self {
            velocities,
            damping: settings.flag("fitness.damping")?,
            cart,
            time_step: number("world.time_step")?,
            substeps: settings.count("world.substeps")? as u32,
            steps: settings.count("trial.steps")? as u32,
            angle: number("poles.angle")?,
            most_angle: number("poles.failure_angle")?,
            most_position: number("cart.track")?,
            force: number("cart.force")?,
            least_force: number("cart.least_force")?,
            hidden: settings.count("net.hidden")? as u32,
            weight_range: number("net.weight_range")?,
            scales,
        };
        if config.least_force > config.force {
            let why = format!("{}: at most the largest force, {}", config.least_force, config.force);
            return Err(Error::setting("cart.least_force", why));
        }
        if config.angle.abs() > config.most_angle {
            let why =
                format!("{}: the pole would have fallen at the start, beyond {}", config.angle, config.most_angle);
            return Err(Error::setting("poles.angle", why));
        }
        Ok(config)
    }
}
