//! Conversion between the configuration of `icub-reach-grasp` and its table of settings.

use farsa_lab::{Error, Setting, Settings};

use crate::icub_reach_grasp::config::Config;

fn number(key: &str, value: f64, low: f64, high: f64) -> Setting {
    Setting::number(key, value, low..=high)
}

fn numbers(key: &str, values: &[f64], low: f64, high: f64) -> Setting {
    Setting::numbers(key, values, low..=high)
}

impl Config {
    /// Returns the table of settings with the values of this configuration as defaults.
    pub fn table(&self) -> Vec<Setting> {
        [self.of_trials(), self.of_robot(), self.of_agent(), self.of_fitness()].concat()
    }

    fn of_trials(&self) -> Vec<Setting> {
        vec![
            Setting::whole("evolution.generations", 1000, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole("evolution.population", 40, 0..=1_000_000)
                .doc("Individuals of a generation. 0 for 4 + 3 ln n of n genes."),
            number("strategy.sigma", 0.2, 1e-6, 10.0).doc(
                "Initial standard deviation, in halves of a range: with 0.5 and weights up to 8, 80 generations earned what ten do so.",
            ),
            Setting::whole("trial.trials", i64::from(self.trials), 1..=10_000)
                .doc("Trials of an evaluation. Twelve have a part of the area each."),
            Setting::whole("trial.steps", i64::from(self.steps), 1..=1_000_000)
                .doc("Control steps of a trial: 15 s at the default step."),
            number("world.time_step", self.time_step, 0.001, 0.2).unit("s").doc("Control step."),
            Setting::whole("world.substeps", i64::from(self.substeps), 1..=1000)
                .doc("Dynamics steps of a control step. With half as many the script fails in 2 of 32 trials."),
            numbers("area.centre", &self.area_centre, -2.0, 2.0)
                .unit("m")
                .doc("Middle of the area of the ball, forwards and leftwards of the body's center."),
            numbers("area.size", &self.area_size, 0.0, 2.0).unit("m").doc("Its extent along both axes."),
            numbers("area.tested", &self.tested_size, 0.0, 2.0)
                .unit("m")
                .doc("Extent of the area, with the same middle, of which the protocol `areas` tests every part."),
            number("ball.radius", self.ball_radius, 0.005, 0.2).unit("m").doc("Radius of the ball."),
            number("ball.mass", self.ball_mass, 0.001, 10.0).unit("kg").doc("Its mass, of a solid ball."),
            number("table.top", self.table_top, -0.3, 0.1).unit("m").doc(
                "Height of the table's top: 25 cm below the shoulder. On one 10 cm below it the script grasps in 13 of 32 trials.",
            ),
        ]
    }

    fn of_robot(&self) -> Vec<Setting> {
        vec![
            numbers("start.torso", &self.torso, -180.0, 180.0)
                .unit("deg")
                .doc("Pitch, roll and yaw of the trunk at the start. Roll is held there."),
            numbers("start.neck", &self.neck, -180.0, 180.0)
                .unit("deg")
                .doc("Pitch, roll and yaw of the head at the start: it looks at the table."),
            numbers("start.right_arm", &self.right_arm, -180.0, 180.0)
                .unit("deg")
                .doc("The right arm's seven joints at the start: the hand is above the table."),
            numbers("start.left_arm", &self.left_arm, -180.0, 180.0)
                .unit("deg")
                .doc("The left arm's, which are rigid: it is drawn up, where it strikes nothing when the trunk turns."),
            numbers("hand.opposition", &self.opposition, -180.0, 180.0)
                .unit("deg")
                .doc("Opposition of the thumb at output 0 and 1 of the hand: it is under the palm from the start."),
            numbers("hand.flexion", &self.flexion, 0.0, 180.0).unit("deg").doc(
                "Flexion of each joint of the thumb, and of each of the other fingers, at output 1. It is 0 at output 0.",
            ),
            number("eye.field_of_view", self.field_of_view, 1.0, 170.0)
                .unit("deg")
                .doc("Horizontal field of view of the left eye. Offsets count in its image's width."),
            Setting::flag("head.tracking", self.tracking).doc(
                "The head follows the ball by a reflex. Without it the neck keeps its angles of the start.",
            ),
            number("head.gain", self.head_gain, 1e-3, 1.0)
                .doc("Part of the angle between gaze and ball that the head makes up for in a step."),
            number("head.speed", self.head_speed, 1e-3, 100.0)
                .unit("rad/s")
                .doc("Largest speed of the neck's desired angles."),
        ]
    }

    fn of_agent(&self) -> Vec<Setting> {
        vec![
            Setting::whole("net.hidden", i64::from(self.hidden), 1..=1000)
                .doc("Hidden neurons, leaky and connected to each other."),
            number("net.weight_range", self.weight_range, 0.1, 1000.0)
                .doc("Weights and biases are decoded to plus and minus this."),
        ]
    }

    fn of_fitness(&self) -> Vec<Setting> {
        vec![
            number("fitness.window", self.window, 0.001, 1000.0)
                .unit("s")
                .doc("The last seconds of a trial, of which touch and height count."),
            number("fitness.height", self.height, 0.001, 1.0)
                .unit("m")
                .doc("Height of the ball above the table that earns all there is to earn and counts as lifted."),
            number("success.hold", self.hold, 0.001, 1000.0).unit("s").doc(
                "Time for which the ball must be up, touched by the hand alone, at the end of a successful trial.",
            ),
        ]
    }

    /// Reads a configuration from settings that have been checked.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the values are not compatible with each other.
    pub fn read(settings: &Settings) -> Result<Self, Error> {
        let number = |key: &str| settings.number(key);
        let count = |key: &str| settings.count(key).map(|count| count as u32);
        let config = Self {
            trials: count("trial.trials")?,
            steps: count("trial.steps")?,
            time_step: number("world.time_step")?,
            substeps: count("world.substeps")?,
            area_centre: settings.array("area.centre")?,
            area_size: settings.array("area.size")?,
            tested_size: settings.array("area.tested")?,
            ball_radius: number("ball.radius")?,
            ball_mass: number("ball.mass")?,
            table_top: number("table.top")?,
            torso: settings.array("start.torso")?,
            neck: settings.array("start.neck")?,
            right_arm: settings.array("start.right_arm")?,
            left_arm: settings.array("start.left_arm")?,
            opposition: settings.array("hand.opposition")?,
            flexion: settings.array("hand.flexion")?,
            field_of_view: number("eye.field_of_view")?,
            tracking: settings.flag("head.tracking")?,
            head_gain: number("head.gain")?,
            head_speed: number("head.speed")?,
            hidden: count("net.hidden")?,
            weight_range: number("net.weight_range")?,
            window: number("fitness.window")?,
            height: number("fitness.height")?,
            hold: number("success.hold")?,
        };
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
        let config = Config::default();
        let settings = Settings::new(config.table()).unwrap();
        assert_eq!(Config::read(&settings).unwrap(), config);
        assert!(config.table().iter().all(|setting| !setting.doc_text().is_empty()));
        let refused = |key: &str, value: Value| {
            let mut settings = Settings::new(config.table()).unwrap();
            settings.set("", key, value).and_then(|()| Config::read(&settings)).unwrap_err().to_string()
        };
        let elbow = vec![-30.0, 30.0, 0.0, 120.0, 0.0, 0.0, 0.0];
        let text = refused("start.right_arm", Value::Numbers(elbow));
        assert_eq!(text, "`start.right_arm`: r_elbow at 120 deg, not from 5.5 to 106.0");
        assert!(refused("start.neck", Value::Numbers(vec![90.0, 0.0, 0.0])).contains("neck_pitch at 90 deg"));
        assert!(refused("hand.opposition", Value::Numbers(vec![0.0, 10.0])).contains("J8 at 10 deg"));
        assert!(refused("hand.flexion", Value::Numbers(vec![0.0, 100.0])).contains("J9 at -100 deg"));
        assert!(refused("area.centre", Value::Numbers(vec![0.1])).contains("area.centre"));
        let text = refused("area.centre", Value::Numbers(vec![1.0, 0.0]));
        assert!(text.contains("area.size") && text.contains("x from 0.8 to 1.2 m"), "{text}");
        assert!(refused("trial.trials", Value::Whole(0)).contains("trial.trials"));
        assert!(refused("net.weight_range", Value::Number(-1.0)).contains("net.weight_range"));
    }
}
