//! Conversion between the configuration of `icub-reach` and its table of settings.

use farsa_lab::{Error, Setting, Settings};

use crate::icub_reach::config::{Condition, Config, Volume};

fn number(key: &str, value: f64, low: f64, high: f64) -> Setting {
    Setting::number(key, value, low..=high)
}

fn numbers(key: &str, values: &[f64], low: f64, high: f64) -> Setting {
    Setting::numbers(key, values, low..=high)
}

impl Config {
    /// Returns the table of settings with the values of this configuration as defaults.
    pub fn table(&self) -> Vec<Setting> {
        [self.of_trials(), self.of_robot(), self.of_network()].concat()
    }

    fn of_trials(&self) -> Vec<Setting> {
        let Volume { centre, semi_axes } = self.volume;
        vec![
            Setting::whole("evolution.generations", 600, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole("evolution.population", 30, 0..=1_000_000)
                .doc("Individuals of a generation, twice as many as the strategy's own."),
            number("strategy.sigma", 0.2, 1e-6, 10.0).doc(
                "Step size of the first generation, in halves of a range: with large weights neurons are saturated, and nothing is learned.",
            ),
            Setting::whole("trial.targets", i64::from(self.targets), 1..=10_000)
                .doc("Targets of an evaluation, a trial each."),
            Setting::flag("trial.same_targets", self.same_targets).doc(
                "All generations have the same targets. Other targets in each generation select against networks for a few of them.",
            ),
            Setting::whole("trial.steps", i64::from(self.steps), 1..=1_000_000)
                .doc("Control steps of a trial: 10 s at the default step."),
            number("world.time_step", self.time_step, 0.001, 0.2).unit("s").doc("Control step."),
            Setting::whole("world.substeps", i64::from(self.substeps), 1..=1000)
                .doc(
                "Dynamics steps of a control step. Tests compare with shorter ones. Position servos that saturate swing where there are fewer than eight.",
            ),
            numbers("target.centre", &centre, -2.0, 2.0).unit("m").doc(
                "Center of the ellipsoid of targets, relative to the body's center: in front of the left shoulder.",
            ),
            numbers("target.semi_axes", &semi_axes, 0.001, 2.0).unit("m").doc(
                "Its semi-axes. Targets are in its half in front of the center, all of which six joints reach.",
            ),
            number("fitness.window", self.window, 0.001, 1000.0)
                .unit("s")
                .doc("The last seconds of a trial, of which the mean distance is taken."),
            number("fitness.least_start", self.least_start, 1e-3, 1.0)
                .unit("m")
                .doc("Start distances below this count as this. Most are below, so fitness is about the mean distance in parts of it. Near targets would else weigh more than far ones."),
            number("success.distance", self.success, 1e-4, 1.0)
                .unit("m")
                .doc("The mean distance below which a trial is a success."),
        ]
    }

    fn of_robot(&self) -> Vec<Setting> {
        let of_robot = vec![
            numbers("start.torso", &self.torso, -180.0, 180.0)
                .unit("deg")
                .doc("Pitch, roll and yaw of the trunk at the start. Roll is held there."),
            numbers("start.arm", &self.arm, -180.0, 180.0).unit("deg").doc(
                "The left arm's seven joints at the start, from the shoulder on. The wrist's three are held there.",
            ),
        ];
        let of_condition = match self.condition {
            Condition::Steady => vec![
                number("robot.saturation_angle", self.saturation_angle, 1e-3, 10.0)
                    .unit("rad")
                    .doc("The error at which a position servo exerts its joint's effort: the robot's default."),
            ],
            Condition::Velocity => vec![
                number("robot.saturation_speed", self.saturation_speed, 1e-4, 10.0)
                    .unit("rad/s")
                    .doc("The lack of speed at which a motor exerts its joint's effort: the robot's default."),
                number("robot.hold_rate", self.hold_rate, 0.0, 100.0).unit("1/s").doc(
                    "Speed at which a joint that is held returns to its angle, for each radian that it is away from it.",
                ),
                number("motors.speed", self.speed, 0.0, 10.0).unit("rad/s").doc("Largest speed that is commanded."),
                number("sensors.offset", self.offset, 1e-3, 10.0)
                    .unit("m")
                    .doc("The way from hand to target that is sensed as -1 backwards and 1 forwards on each axis."),
            ],
        };
        [of_robot, of_condition].concat()
    }

    fn of_network(&self) -> Vec<Setting> {
        vec![
            number("net.weight_range", self.weight_range, 0.1, 1000.0)
                .doc("Weights and biases are decoded to plus and minus this."),
        ]
    }

    /// Reads a configuration from settings that have been checked.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the values are not compatible with each other.
    pub fn read(condition: Condition, settings: &Settings) -> Result<Self, Error> {
        let number = |key: &str| settings.number(key);
        let count = |key: &str| settings.count(key).map(|count| count as u32);
        let mut config = Self {
            targets: count("trial.targets")?,
            same_targets: settings.flag("trial.same_targets")?,
            steps: count("trial.steps")?,
            time_step: number("world.time_step")?,
            substeps: count("world.substeps")?,
            volume: Volume { centre: settings.array("target.centre")?, semi_axes: settings.array("target.semi_axes")? },
            torso: settings.array("start.torso")?,
            arm: settings.array("start.arm")?,
            window: number("fitness.window")?,
            least_start: number("fitness.least_start")?,
            success: number("success.distance")?,
            weight_range: number("net.weight_range")?,
            ..Self::for_condition(condition)
        };
        match condition {
            Condition::Steady => config.saturation_angle = number("robot.saturation_angle")?,
            Condition::Velocity => {
                config.saturation_speed = number("robot.saturation_speed")?;
                config.hold_rate = number("robot.hold_rate")?;
                config.speed = number("motors.speed")?;
                config.offset = number("sensors.offset")?;
            }
        }
        config.check()?;
        Ok(config)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_lab::advanced::Value;

    #[test]
    fn settings_of_the_defaults_read_back_and_wrong_ones_are_refused_by_name() {
        for condition in [Condition::Steady, Condition::Velocity] {
            let config = Config::for_condition(condition);
            let settings = Settings::new(config.table()).unwrap();
            assert_eq!(Config::read(condition, &settings).unwrap(), config);
            assert!(config.table().iter().all(|setting| !setting.doc_text().is_empty()));
            let refused = |key: &str, value: Value| {
                let mut settings = Settings::new(config.table()).unwrap();
                settings.set("", key, value).and_then(|()| Config::read(condition, &settings)).unwrap_err().to_string()
            };
            let elbow = vec![-30.0, 30.0, 0.0, 120.0, 0.0, 0.0, 0.0];
            let text = refused("start.arm", Value::Numbers(elbow));
            assert_eq!(text, "`start.arm`: l_elbow at 120 deg, not from 5.5 to 106.0");
            assert!(refused("start.torso", Value::Numbers(vec![90.0, 0.0, 0.0])).contains("torso_pitch at 90 deg"));
            assert!(refused("target.centre", Value::Numbers(vec![0.1])).contains("target.centre"));
            assert!(refused("target.semi_axes", Value::Numbers(vec![0.1, 0.1, 0.0])).contains("target.semi_axes"));
            assert!(refused("trial.targets", Value::Whole(0)).contains("trial.targets"));
            assert!(refused("net.weight_range", Value::Number(-1.0)).contains("net.weight_range"));
        }
    }
}
