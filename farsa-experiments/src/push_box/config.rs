//! Configuration of the experiment `push-box`, and its settings.

use farsa_body::robots::MobileRobot;
use farsa_lab::advanced::ENGINE;
use farsa_lab::{Error, Setting, Settings};
use farsa_physics::arena::Arena;

/// The configuration of the robot, the box and the trials. All defaults were chosen for this experiment.
///
/// Lengths are in meters.
#[derive(Clone, Debug, PartialEq)]
pub struct PushConfig {
    /// Robot that pushes the box.
    pub robot: MobileRobot,
    /// Duration of a control step (in seconds).
    pub time_step: f64,
    /// Number of trials in an evaluation. Each trial has a different start.
    pub trials: u32,
    /// Number of steps of a trial.
    pub steps: u32,
    /// Length, width and height of the box.
    pub size: [f64; 3],
    /// Mass of the box in kilograms.
    pub mass: f64,
    /// Coefficient of friction between the box and the ground.
    pub friction: f64,
    /// Smallest and largest initial distance between the hull of the robot and a circle around the box.
    pub apart: [f64; 2],
    /// Displacement of the box required in a successful trial.
    pub far: f64,
    /// Largest absolute value of a weight or bias.
    pub weight_range: f64,
}

impl Default for PushConfig {
    fn default() -> Self {
        Self {
            robot: MobileRobot::e_puck(),
            time_step: 0.1,
            trials: 8,
            steps: 200,
            size: [0.12, 0.12, 0.05],
            mass: 0.1,
            friction: 0.4,
            apart: [0.01, 0.1],
            far: 1.0,
            weight_range: 5.0,
        }
    }
}

impl PushConfig {
    /// Returns the table of settings with the values of this configuration as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let length = |key: &str, default: f64| Setting::number(key, default, 0.0..=100.0).unit("m");
        vec![
            Setting::whole("evolution.generations", 40, 1..=i64::from(u32::MAX) - 1)
                .doc("Generations that are evaluated. A resumed run may change it, and nothing else."),
            Setting::whole("evolution.population", 20, 1..=1_000_000)
                .doc("Individuals of a generation, a multiple of the parents: few, for rapier takes its time."),
            Setting::whole("evolution.parents", 4, 1..=1_000_000)
                .doc("The best individuals, which make population / parents copies each. The first copy is unchanged."),
            Setting::word(ENGINE, "rapier", &["rapier"])
                .doc("Physics of robot and box: in the kinematic arena nothing is pushed."),
            Setting::number("world.time_step", self.time_step, 0.001..=0.2).unit("s").doc("Control step."),
            Setting::whole("trial.count", i64::from(self.trials), 1..=100_000).doc("Trials of an evaluation."),
            Setting::whole("trial.steps", i64::from(self.steps), 1..=1_000_000).doc("Steps of a trial."),
            Setting::numbers("box.size", &self.size, 0.001..=10.0)
                .unit("m")
                .doc("Length, breadth and height of the box: higher than the infrared sensors, wider than the robot."),
            Setting::number("box.mass", self.mass, 1e-6..=1000.0)
                .unit("kg")
                .doc("Mass of the box: its friction is a good half of what the robot's motors push with."),
            Setting::number("box.friction", self.friction, 0.0..=10.0)
                .doc("Coefficient of friction between box and ground."),
            length("start.nearest", self.apart[0])
                .doc("Least distance at the start between the hull and the circle around the box."),
            length("start.farthest", self.apart[1])
                .doc("Greatest distance there: twice as far as the infrared sensors see, at most."),
            length("success.far", self.far).doc("Displacement of the box in a successful trial."),
            Setting::number("net.weight_range", self.weight_range, 0.0..=1000.0)
                .doc("Weights and biases are decoded from gene 0 at plus to the largest gene at minus this."),
        ]
    }

    /// Replaces the values of this configuration by settings that have been checked.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the values are not compatible with each other.
    pub fn read(self, settings: &Settings) -> Result<Self, Error> {
        let size = settings.numbers("box.size")?;
        let apart = [settings.number("start.nearest")?, settings.number("start.farthest")?];
        if apart[1] < apart[0] {
            let why = format!("is {}, below start.nearest, {}", apart[1], apart[0]);
            return Err(Error::setting("start.farthest", why));
        }
        Ok(Self {
            time_step: settings.number("world.time_step")?,
            trials: settings.count("trial.count")? as u32,
            steps: settings.count("trial.steps")? as u32,
            size: [size[0], size[1], size[2]],
            mass: settings.number("box.mass")?,
            friction: settings.number("box.friction")?,
            apart,
            far: settings.number("success.far")?,
            weight_range: settings.number("net.weight_range")?,
            ..self
        })
    }

    /// Builds an unbounded arena with the robot. Each trial moves the robot to its initial position.
    pub fn arena(&self) -> Arena {
        let mut arena = Arena { time_step: self.time_step, ..Arena::new() };
        arena.add_robot(self.robot.clone(), [self.size[0] + self.size[1] + 1.0, 0.0], 0.0);
        arena
    }

    /// Computes the radius of the circle around the box, as seen from above.
    pub fn around(&self) -> f64 {
        let [a, b, _] = self.size;
        0.5 * farsa_num::Scalar::sqrt(a * a + b * b)
    }

    /// Computes the maximum speed of the robot, in meters per second.
    pub fn speed(&self) -> f64 {
        self.robot.max_wheel_speed * self.robot.wheel_radius
    }

    /// Gets the number of infrared sensors. It equals the number of inputs of the controller.
    pub fn inputs(&self) -> usize {
        self.robot.infrared.angles.len()
    }

    /// Builds the arena with the box in the middle.
    #[cfg(feature = "rapier")]
    pub fn scene(&self) -> farsa_physics::rapier::ArenaScene {
        use farsa_physics::rapier::{ArenaScene, Block};
        let mut scene = ArenaScene::new(self.arena());
        let color = [0.8, 0.4, 0.0];
        scene.add_block(Block { friction: self.friction, color, ..Block::new([0.0; 2], self.size, self.mass) });
        scene
    }

    /// Creates a world for this scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the values do not describe a valid world.
    #[cfg(feature = "rapier")]
    pub fn world(&self) -> Result<farsa_physics::rapier::ArenaWorld, Error> {
        use farsa_physics::rapier::{ArenaOptions, ArenaWorld};
        let world = ArenaWorld::new(&self.scene(), &ArenaOptions::default());
        world.map_err(|error| Error::Other(format!("push-box: {error}")))
    }
}
