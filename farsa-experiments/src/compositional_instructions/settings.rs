//! Conversion between the configuration of `compositional-instructions` and its table of settings.

use farsa_lab::{Error, Setting, Settings};

use crate::compositional_instructions::config::{Arm, Camera, Config, Judging, Objects, Ranges, Start};
use crate::compositional_instructions::instruction::{Condition, Instruction};

fn number(key: &str, value: f64, low: f64, high: f64) -> Setting {
    Setting::number(key, value, low..=high)
}

fn numbers(key: &str, values: &[f64], low: f64, high: f64) -> Setting {
    Setting::numbers(key, values, low..=high)
}

impl Config {
    /// Returns the table of settings with the values of this configuration as defaults.
    pub fn table(&self) -> Vec<Setting> {
        [self.of_search(), self.of_world(), self.of_start(), self.of_judging(), self.of_network()].concat()
    }

    fn of_search(&self) -> Vec<Setting> {
        let instructions = self.condition.instructions().map(|instruction| instruction.to_string());
        let instructions: Vec<&str> = instructions.iter().map(String::as_str).collect();
        let [one, other] = self.held_out.map(|instruction| instruction.to_string());
        vec![
            Setting::whole("evolution.generations", 20_000, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole("evolution.population", 40, 0..=1_000_000)
                .doc("Individuals of a generation. 0 for 4 + 3 ln n of n genes."),
            number("strategy.sigma", 0.3, 1e-6, 10.0).doc("Initial standard deviation, in halves of a range."),
            number("strategy.sigma_learning_rate", 0.0275, 0.0, 10.0).doc(
                "Learning rate of the standard deviations: a quarter of the source's, with which they shrink too early.",
            ),
            Setting::word("instruction.held_out", &one, &instructions)
                .given()
                .doc("An instruction that is never heard before the test."),
            Setting::word("instruction.held_out_too", &other, &instructions)
                .given()
                .doc("Another, which may be the same one again."),
            Setting::whole("trial.starts", i64::from(self.starts), 1..=10_000)
                .doc("Starts of each trained instruction. Six have each order of the colors once."),
            Setting::whole("trial.steps", i64::from(self.steps), 1..=1_000_000).doc("Control steps of a trial."),
        ]
    }

    fn of_world(&self) -> Vec<Setting> {
        let Self { arm, objects, camera, .. } = self;
        vec![
            number("world.time_step", self.time_step, 0.001, 1.0).unit("s").doc("Control step."),
            Setting::whole("world.substeps", i64::from(self.substeps), 1..=1000)
                .doc("Dynamics steps of a control step."),
            numbers("arm.lengths", &arm.lengths, 0.05, 10.0).unit("m").doc("Lengths of the two segments."),
            numbers("arm.masses", &arm.masses, 0.001, 1000.0).unit("kg").doc("Their masses."),
            number("arm.radius", arm.radius, 0.001, 1.0).unit("m").doc("Their radius. Both are capsules."),
            numbers("arm.ranges", &arm.ranges, 1.0, 175.0)
                .unit("deg")
                .doc("Largest turn of each joint to either side."),
            numbers("arm.speeds", &arm.speeds, 0.0, 10.0)
                .unit("rad/s")
                .doc("Speeds that are commanded by a difference of 1 between two motor neurons."),
            numbers("arm.gains", &arm.gains, 0.0, 10_000.0)
                .unit("N m s/rad")
                .doc("Torque for each rad/s that a joint lacks of the commanded speed."),
            numbers("arm.torques", &arm.torques, 0.0, 10_000.0).unit("N m").doc("Largest torques."),
            number("object.radius", objects.radius, 0.001, 1.0).unit("m").doc("Radius of the objects."),
            number("object.mass", objects.mass, 0.001, 1000.0).unit("kg").doc("Their mass."),
            number("object.ground_friction", objects.ground_friction, 0.0, 10.0)
                .doc("Coefficient of friction on the ground: a light touch does not move an object, a push does."),
            number("object.friction", objects.friction, 0.0, 10.0)
                .doc("Coefficient of friction where the arm or an object touches an object."),
            number("object.distance", objects.distance, 0.05, 20.0)
                .unit("m")
                .doc("Distance from the base: the folded arm passes inside of all, the stretched one reaches all."),
            number("object.distance_spread", objects.distance_spread, 0.0, 10.0)
                .unit("m")
                .doc("By how much that differs at most."),
            numbers("object.bearings", &objects.bearings, -170.0, 170.0)
                .unit("deg")
                .doc("Places of the three objects, from left to right. Their colors are drawn."),
            number("object.bearing_spread", objects.bearing_spread, 0.0, 90.0)
                .unit("deg")
                .doc("By how much each bearing differs at most."),
            number("camera.view", camera.view, 1.0, 180.0).unit("deg").doc("Field of view, in three sectors alike."),
            Setting::whole("camera.rays", i64::from(camera.rays), 1..=1000).doc("Rays of a sector."),
            number("camera.range", camera.range, 0.1, 100.0).unit("m").doc("How far the camera sees."),
            number("touch.margin", self.touch_margin, 0.0, 0.1)
                .unit("m")
                .doc("Surfaces nearer than this count as touching, so that a light touch is not lost."),
        ]
    }

    fn of_start(&self) -> Vec<Setting> {
        let Start { first_spread, second, second_spread, both_sides } = self.start;
        vec![
            number("start.first_spread", first_spread, 0.0, 90.0)
                .unit("deg")
                .doc("The first joint starts at most so far from a direction between two objects."),
            number("start.second", second, 0.0, 175.0)
                .unit("deg")
                .doc("The second joint starts so far to the left, or to a side that is drawn."),
            Setting::flag("start.both_sides", both_sides)
                .doc("That side is drawn. Half of the starts are then stretched by the speed that folds the others."),
            number("start.second_spread", second_spread, 0.0, 90.0)
                .unit("deg")
                .doc("By how much that differs at most."),
        ]
    }

    fn of_judging(&self) -> Vec<Setting> {
        let judging = &self.judging;
        let length = |key: &str, value: f64| number(key, value, 1e-6, 10.0).unit("m");
        vec![
            number("fitness.window", judging.window, 0.001, 1000.0)
                .unit("s")
                .doc("The last seconds of a trial, of which shares are taken."),
            length("fitness.still", judging.still).doc("A displacement that costs nothing."),
            length("fitness.span", judging.span).doc("Distance beyond that at which the share falls to 0."),
            length("fitness.span_touched", judging.span_touched)
                .doc("That distance for the target of TOUCH: an agent that loses all by a push does not learn to touch."),
            length("fitness.far", judging.far).doc("The displacement for which MOVE earns most."),
            length("fitness.reach", judging.reach).doc(
                "Distance of the tip from the centered target below which TOUCH and MOVE earn something for reaching.",
            ),
            number("fitness.reach_share", judging.reach_share, 0.0, 1.0)
                .doc("Weight of reaching in the acts of TOUCH and MOVE: without it no agent learned to stretch."),
            number("fitness.aside_share", judging.aside_share, 0.0, 1.0).doc(
                "Reward of IGNORE for a look past the target: without it a run of 20 000 generations looked at the target.",
            ),
            numbers("success.least_shares", &judging.least_shares, 0.0, 1.0)
                .doc("Least shares of the last seconds: of INDICATE and IGNORE, and of TOUCH."),
            length("success.most_still", judging.most_still)
                .doc("Most displacement of the target, of INDICATE and IGNORE."),
            length("success.most_touched", judging.most_touched).doc("Most displacement of the target, of TOUCH."),
            length("success.least_moved", judging.least_moved).doc("Least displacement of the target, of MOVE."),
            length("success.most_other", judging.most_other).doc("Most displacement of another object."),
        ]
    }

    fn of_network(&self) -> Vec<Setting> {
        let Ranges { weight, bias, time_constant_exponents, gains } = self.ranges;
        vec![
            number("net.weight_range", weight, 0.1, 1000.0).doc("Weights are decoded to plus and minus this."),
            number("net.bias_range", bias, 0.1, 1000.0).doc("Biases are decoded to plus and minus this."),
            numbers("net.time_constant_exponents", &time_constant_exponents, -3.0, 5.0)
                .doc("Least and greatest decimal logarithm of the time constants [s]."),
            numbers("net.gains", &gains, 0.01, 1000.0).doc("Least and greatest gain of the sensory neurons."),
        ]
    }

    /// Reads a configuration from settings that have been checked.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the values are not compatible with each other.
    pub fn read(condition: Condition, settings: &Settings) -> Result<Self, Error> {
        let number = |key: &str| settings.number(key);
        let count = |key: &str| settings.count(key).map(|count| count as u32);
        let two = |key: &str| settings.array::<2>(key);
        let ends = |key: &str| {
            let [low, high] = two(key)?;
            if low > high {
                return Err(Error::setting(key, format!("{low}, {high}: the first must not be greater")));
            }
            Ok([low, high])
        };
        let held_out = |key: &str| -> Result<Instruction, Error> { condition.parse(settings.word(key)?) };
        let config = Self {
            condition,
            held_out: [held_out("instruction.held_out")?, held_out("instruction.held_out_too")?],
            starts: count("trial.starts")?,
            steps: count("trial.steps")?,
            time_step: number("world.time_step")?,
            substeps: count("world.substeps")?,
            arm: Arm {
                lengths: two("arm.lengths")?,
                masses: two("arm.masses")?,
                radius: number("arm.radius")?,
                ranges: two("arm.ranges")?,
                speeds: two("arm.speeds")?,
                gains: two("arm.gains")?,
                torques: two("arm.torques")?,
            },
            objects: Objects {
                radius: number("object.radius")?,
                mass: number("object.mass")?,
                ground_friction: number("object.ground_friction")?,
                friction: number("object.friction")?,
                distance: number("object.distance")?,
                distance_spread: number("object.distance_spread")?,
                bearings: settings.array("object.bearings")?,
                bearing_spread: number("object.bearing_spread")?,
            },
            camera: Camera {
                view: number("camera.view")?,
                rays: count("camera.rays")?,
                range: number("camera.range")?,
            },
            touch_margin: number("touch.margin")?,
            start: Start {
                first_spread: number("start.first_spread")?,
                second: number("start.second")?,
                second_spread: number("start.second_spread")?,
                both_sides: settings.flag("start.both_sides")?,
            },
            judging: Judging {
                window: number("fitness.window")?,
                still: number("fitness.still")?,
                span: number("fitness.span")?,
                span_touched: number("fitness.span_touched")?,
                far: number("fitness.far")?,
                reach: number("fitness.reach")?,
                reach_share: number("fitness.reach_share")?,
                aside_share: number("fitness.aside_share")?,
                least_shares: two("success.least_shares")?,
                most_still: number("success.most_still")?,
                most_touched: number("success.most_touched")?,
                least_moved: number("success.least_moved")?,
                most_other: number("success.most_other")?,
            },
            ranges: Ranges {
                weight: number("net.weight_range")?,
                bias: number("net.bias_range")?,
                time_constant_exponents: ends("net.time_constant_exponents")?,
                gains: ends("net.gains")?,
            },
        };
        config.check()?;
        Ok(config)
    }
}
