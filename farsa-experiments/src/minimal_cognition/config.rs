//! Configuration of the experiment `minimal-cognition`, and its settings.

use core::f64::consts::FRAC_PI_6;

use farsa_lab::{Error, Setting, Settings};

/// The configuration of the agent, the objects and the network. Settings marked as given have the defaults of
/// \[Beer2003\].
///
/// The source does not specify units for lengths and times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Width of the line on which the agent moves.
    pub width: f64,
    /// Time step of the Euler method. It is used for the network and for all movements.
    pub time_step: f64,
    /// Number of trials in an evaluation. Circles and diamonds alternate.
    pub trials: u32,
    /// Diameter of the agent.
    pub body: f64,
    /// Angle between the two outermost rays in radians.
    pub fan: f64,
    /// Length of the rays, measured from the outline of the agent.
    pub ray_length: f64,
    /// Input from a ray that hits an object at its origin.
    pub input_gain: f64,
    /// Velocity of the agent when the outputs of the two motor neurons differ by 1.
    pub velocity_gain: f64,
    /// Diameter of a circle.
    pub diameter: f64,
    /// Side length of a diamond.
    pub side: f64,
    /// Speed of the falling objects.
    pub speed: f64,
    /// Initial height of the center of an object above the center of the agent.
    pub start_height: f64,
    /// Height of the object at which a trial ends.
    pub end_height: f64,
    /// Largest horizontal distance between the object and the agent at the start.
    pub offset: f64,
    /// Largest distance that is taken into account in the fitness.
    pub clip: f64,
    /// Largest absolute value of a weight.
    pub weight_range: f64,
    /// Largest absolute value of a bias.
    pub bias_range: f64,
    /// Smallest and largest time constant.
    pub time_constants: [f64; 2],
    /// Smallest and largest gain of a sensory neuron.
    pub gains: [f64; 2],
}

impl Default for Config {
    fn default() -> Self {
        Self {
            width: 400.0,
            time_step: 0.1,
            trials: 24,
            body: 30.0,
            fan: FRAC_PI_6,
            ray_length: 220.0,
            input_gain: 10.0,
            velocity_gain: 5.0,
            diameter: 30.0,
            side: 30.0,
            speed: 3.0,
            start_height: 275.0,
            end_height: 30.0,
            offset: 50.0,
            clip: 45.0,
            weight_range: 16.0,
            bias_range: 16.0,
            time_constants: [1.0, 10.0],
            gains: [1.0, 5.0],
        }
    }
}

impl Config {
    /// Returns the number of steps of a trial. It follows from the speed of the objects and the distance that they
    /// fall.
    pub fn steps(&self) -> u32 {
        let steps = (self.start_height - self.end_height) / (self.speed * self.time_step);
        steps.ceil().clamp(1.0, f64::from(u32::MAX)) as u32
    }

    /// Returns the table of settings with the values of this configuration as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let length = |key: &str, value: f64| Setting::number(key, value, 1.0..=10_000.0);
        vec![
            Setting::whole("evolution.generations", 200, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole("evolution.population", 100, 1..=1_000_000)
                .doc("Individuals of a generation, a multiple of the parents."),
            Setting::whole("evolution.parents", 20, 1..=1_000_000)
                .doc("The best individuals, which make population / parents copies each. The first copy is unchanged."),
            Setting::number("evolution.mutation_rate", 0.015, 0.0..=1.0).doc("Probability that mutation hits a bit."),
            length("world.width", self.width).given().doc("Width of the line that the agent moves on. It stops at the ends."),
            Setting::number("world.time_step", self.time_step, 0.001..=1.0)
                .given()
                .doc("Step of the Euler method, for the network and for all that moves."),
            Setting::whole("trial.count", i64::from(self.trials), 2..=100_000)
                .given()
                .doc("Trials of an evaluation: a circle, a diamond, and so on."),
            length("agent.diameter", self.body).given().doc("Diameter of the agent."),
            Setting::number("agent.ray_fan", self.fan, 0.0..=3.0)
                .unit("rad")
                .given()
                .doc("Angle between the outermost of the seven rays, which leave the agent's outline upwards."),
            length("agent.ray_length", self.ray_length).given().doc("Length of the rays."),
            Setting::number("agent.input_gain", self.input_gain, 0.0..=1000.0)
                .doc("Input of a ray that is cut at its origin. It falls linearly to 0 at the ray's end."),
            Setting::number("agent.velocity_gain", self.velocity_gain, 0.0..=1000.0)
                .given()
                .doc("Velocity for a difference of 1 between the outputs of the motor neurons."),
            length("object.diameter", self.diameter).given().doc("Diameter of the circles, which are to be caught."),
            length("object.side", self.side).given().doc("Side of the diamonds, squares on their tips, which are to be avoided."),
            Setting::number("object.speed", self.speed, 0.01..=1000.0).given().doc("Speed at which objects fall."),
            length("object.start_height", self.start_height)
                .given()
                .doc("Height of an object's center above the agent's at the start."),
            Setting::number("object.end_height", self.end_height, 0.0..=10_000.0).doc(
                "That height at which the trial ends: a circle straight above then touches the agent and nothing passes \
                 through it.",
            ),
            length("object.offset", self.offset).given().doc(
                "Objects start at most this far to a side of the agent. The distance is uniform in one of trial.count / 2 equal \
                 parts for each shape, the side random; all individuals of a generation meet the same.",
            ),
            length("fitness.clip", self.clip)
                .given()
                .doc("A trial earns d under a diamond, 1 - d under a circle: d is the distance at its end in parts of this, at most 1."),
            Setting::number("net.weight_range", self.weight_range, 0.1..=1000.0)
                .doc("Weights are decoded to plus and minus this."),
            Setting::number("net.bias_range", self.bias_range, 0.1..=1000.0)
                .doc("Biases are decoded to plus and minus this."),
            Setting::numbers("net.time_constants", &self.time_constants, 0.001..=1000.0)
                .doc("Least and greatest time constant; with 30 as the greatest evolution was slower."),
            Setting::numbers("net.gains", &self.gains, 0.01..=1000.0)
                .doc("Least and greatest gain of the sensory neurons; that of the others is 1."),
        ]
    }

    /// Reads a configuration from settings that have been checked.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the values are not compatible with each other.
    pub fn read(settings: &Settings) -> Result<Self, Error> {
        let number = |key: &str| settings.number(key);
        let ends = |key: &str| {
            let ends = settings.numbers(key)?;
            if ends[0] > ends[1] {
                return Err(Error::setting(key, format!("{ends:?}: the first must not be greater")));
            }
            Ok([ends[0], ends[1]])
        };
        let config = Self {
            width: number("world.width")?,
            time_step: number("world.time_step")?,
            trials: settings.count("trial.count")? as u32,
            body: number("agent.diameter")?,
            fan: number("agent.ray_fan")?,
            ray_length: number("agent.ray_length")?,
            input_gain: number("agent.input_gain")?,
            velocity_gain: number("agent.velocity_gain")?,
            diameter: number("object.diameter")?,
            side: number("object.side")?,
            speed: number("object.speed")?,
            start_height: number("object.start_height")?,
            end_height: number("object.end_height")?,
            offset: number("object.offset")?,
            clip: number("fitness.clip")?,
            weight_range: number("net.weight_range")?,
            bias_range: number("net.bias_range")?,
            time_constants: ends("net.time_constants")?,
            gains: ends("net.gains")?,
        };
        if config.end_height >= config.start_height {
            let why = format!("{}: must be less than the start's, {}", config.end_height, config.start_height);
            return Err(Error::setting("object.end_height", why));
        }
        let least = 0.5 * config.time_step;
        if config.time_constants[0] < least {
            let why = format!("{}: at least half a time step, {least}", config.time_constants[0]);
            return Err(Error::setting("net.time_constants", why));
        }
        Ok(config)
    }
}
