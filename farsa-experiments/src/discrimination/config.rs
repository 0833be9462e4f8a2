//! The values of `discrimination` and `discrimination-cylinders`, as settings.

use farsa_body::robots::MobileRobot;
use farsa_lab::{ENGINE, Error, Setting, Settings};
use farsa_physics::arena::{Arena, Cylinder, World};

use crate::infrared::settings::InfraredModel;
use crate::worlds::PlanarEngine;

/// The front infrared sensors that the robot uses, of the Khepera's eight.
pub const EYES: usize = 6;

/// The robots of `discrimination`, the default one first, as its conditions are called.
pub(crate) const ROBOTS: [&str; 2] = [KHEPERA, E_PUCK];
const KHEPERA: &str = "khepera";
const E_PUCK: &str = "e-puck";

/// What a robot does among cylinders; the defaults are those of `discrimination` with a Khepera.
///
/// Lengths are metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The robot.
    pub robot: MobileRobot,
    /// What moves it.
    pub engine: PlanarEngine,
    /// Width and depth of the arena between its walls.
    pub size: [f64; 2],
    /// Control step \[s\].
    pub time_step: f64,
    /// Trials of an evaluation, each with places of its own.
    pub trials: u32,
    /// Steps of a trial.
    pub steps: u32,
    /// Radii of the cylinders: of the one to stay at, and perhaps of another.
    pub radii: Vec<f64>,
    /// Least distance of a cylinder's surface from the walls.
    pub object_to_wall: f64,
    /// Least distance between the surfaces of two cylinders.
    pub object_to_object: f64,
    /// Least distance of the robot's hull from the walls at the start.
    pub robot_to_wall: f64,
    /// Least distance of the robot's hull from the cylinders at the start.
    pub robot_to_object: f64,
    /// The robot is near a cylinder while their surfaces are less than this apart.
    pub near: f64,
    /// What a step near the other cylinder costs, in steps near the first.
    pub cost: f64,
    /// How the infrared sensors read.
    pub infrared: InfraredModel,
    /// Whether the robot senses how fast its wheels turn.
    pub wheel_speeds: bool,
    /// Weights and biases are decoded to plus and minus this.
    pub weight_range: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            robot: MobileRobot::khepera(),
            engine: PlanarEngine::Arena,
            size: [0.4, 0.4],
            time_step: 0.05,
            trials: 25,
            steps: 600,
            radii: vec![0.0125],
            object_to_wall: 0.05,
            object_to_object: 0.0,
            robot_to_wall: 0.01,
            robot_to_object: 0.1,
            near: 0.08,
            cost: 0.0,
            infrared: InfraredModel::Analytic,
            wheel_speeds: false,
            weight_range: 5.0,
        }
    }
}

impl Config {
    /// The defaults of `discrimination` for a robot, by the name of the condition.
    pub fn for_condition(condition: &str) -> Self {
        if condition == E_PUCK { Self::e_puck() } else { Self::default() }
    }

    /// The source's variant with an e-puck: other numbers, the same rules.
    ///
    /// Deviations: the hull's radius is the variant's, 27.5 mm, where [`MobileRobot::e_puck`] has 35 mm; so its sensors of
    /// the ground, which would lie outside, are left away. What the variant's source does not say is that of the Khepera's
    /// experiment: six sensors in front, the network, the places of the start. No tables of its infrared sensors were
    /// measured: by default they are read by rays, of its own 50 mm, for the formula's distances are a Khepera's.
    pub fn e_puck() -> Self {
        Self {
            robot: MobileRobot { radius: 0.0275, ground: Vec::new(), ..MobileRobot::e_puck() },
            time_step: 0.1,
            trials: 10,
            steps: 500,
            near: 0.06,
            infrared: InfraredModel::Rays,
            ..Self::default()
        }
    }

    /// Whether the robot is the one that infrared tables were measured of, and that most numbers of the source are for.
    fn is_khepera(&self) -> bool {
        self.robot.name == MobileRobot::khepera().name
    }

    /// The defaults of `discrimination-cylinders`, all chosen but the radii and those that it shares.
    ///
    /// The arena is as much larger as two cylinders and a way between them need.
    pub fn two_cylinders(wheel_speeds: bool) -> Self {
        Self {
            size: [0.5, 0.5],
            trials: 20,
            radii: vec![0.027, 0.0125],
            object_to_object: 0.17,
            cost: 0.5,
            wheel_speeds,
            ..Self::default()
        }
    }

    /// Every value as a setting, with these as defaults.
    pub fn table(&self) -> Vec<Setting> {
        let several = self.radii.len() > 1;
        let khepera = self.is_khepera();
        // What the source gives for one cylinder is chosen for two.
        let given = |setting: Setting| if several { setting } else { setting.given() };
        // What it gives for the Khepera alone is chosen for other robots.
        let is_khepera = |setting: Setting| if khepera { given(setting) } else { setting };
        let plain = |key: &str, default: f64| Setting::number(key, default, 0.0..=10.0).unit("m");
        let length = |key: &str, default: f64| given(plain(key, default));
        let weights = Setting::number("net.weight_range", self.weight_range, 0.0..=1000.0);
        let weights = if khepera { weights.given() } else { weights };
        let mut table = vec![
            Setting::word(ENGINE, self.engine.name(), &PlanarEngine::NAMES).doc(
                "What moves the robot: wheels that do exactly what is commanded, or rapier, where it has mass and its motors have \
                 a largest torque.",
            ),
            given(Setting::numbers("world.size", &self.size, 0.1..=100.0))
                .unit("m")
                .doc("Width and depth of the arena between its walls."),
            Setting::number("world.time_step", self.time_step, 0.001..=0.2).unit("s").given().doc("Control step."),
            given(Setting::whole("trial.count", i64::from(self.trials), 1..=100_000)).doc("Trials of an evaluation."),
            given(Setting::whole("trial.steps", i64::from(self.steps), 1..=1_000_000))
                .doc("Steps of a trial; a collision ends it before."),
            Setting::numbers("object.radii", &self.radii, 0.001..=1.0)
                .unit("m")
                .given()
                .doc("Radius of the cylinder to stay at, and of the other one where there is one."),
            is_khepera(
                plain("object.to_wall", self.object_to_wall)
                    .doc("Least distance of a cylinder's surface from the walls."),
            ),
            is_khepera(
                plain("start.to_wall", self.robot_to_wall)
                    .doc("Least distance of the robot's hull from the walls at the start."),
            ),
            is_khepera(
                plain("start.to_object", self.robot_to_object)
                    .doc("Least distance of the robot's hull from a cylinder's surface at the start."),
            ),
            length("fitness.near", self.near)
                .doc("A step counts while the surfaces of robot and cylinder are less than this apart."),
            weights.doc("Weights and biases are decoded from gene 0 at plus to the largest gene at minus this."),
        ];
        if several {
            table.push(length("object.to_object", self.object_to_object).doc(
                "Least distance between the cylinders' surfaces: more than twice fitness.near, so that nothing is near both.",
            ));
            table.push(Setting::number("fitness.cost", self.cost, 0.0..=100.0).doc(
                "What a step near the other cylinder costs, in steps near the first; at 1, staying anywhere would gain \
                 nothing, and nothing evolved.",
            ));
        }
        if khepera {
            table.extend(InfraredModel::settings());
        } else {
            table.push(
                Setting::number("robot.radius", self.robot.radius, 0.5 * self.robot.track..=0.1)
                    .unit("m")
                    .given()
                    .doc("Radius of the hull; swarms are of e-pucks of 0.035 m."),
            );
            table.push(self.infrared.without_tables());
        }
        table
    }

    /// These values with those of checked settings, and the tables of the infrared sensors.
    ///
    /// # Errors
    /// [`Error::Setting`] for what does not go together, and those of [`InfraredModel::read`].
    pub fn read(self, settings: &Settings) -> Result<Self, Error> {
        let length = |key: &str| settings.number(key);
        let several = self.radii.len() > 1;
        let size = settings.numbers("world.size")?;
        let radii = settings.numbers("object.radii")?.to_vec();
        Ok(Self {
            engine: settings.word(ENGINE)?.parse()?,
            size: [size[0], size[1]],
            time_step: length("world.time_step")?,
            trials: settings.count("trial.count")? as u32,
            steps: settings.count("trial.steps")? as u32,
            object_to_wall: length("object.to_wall")?,
            object_to_object: if several { length("object.to_object")? } else { self.object_to_object },
            robot_to_wall: length("start.to_wall")?,
            robot_to_object: length("start.to_object")?,
            near: length("fitness.near")?,
            cost: if several { settings.number("fitness.cost")? } else { self.cost },
            robot: if self.is_khepera() {
                self.robot
            } else {
                MobileRobot { radius: length("robot.radius")?, ..self.robot }
            },
            infrared: InfraredModel::read(settings)?,
            weight_range: settings.number("net.weight_range")?,
            radii,
            ..self
        })
    }

    /// The arena with the robot and the cylinders parked beside it: every trial places them anew.
    pub fn arena(&self) -> Arena {
        let mut arena = Arena { time_step: self.time_step, ..Arena::walled(self.size[0], self.size[1]) };
        let mut x = self.size[0] + 1.0;
        arena.add_robot(self.robot.clone(), [x, 0.0], 0.0);
        for radius in &self.radii {
            x += 1.0 + 2.0 * radius;
            arena.add_cylinder(Cylinder::new([x, 0.0], *radius));
        }
        arena
    }

    /// A kinematic world of that arena, whatever the engine.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no world.
    pub fn world(&self) -> Result<World, Error> {
        World::new(&self.parked()).map_err(|error| Error::Other(error.to_string()))
    }

    /// The arena without bounds for what is parked outside before a trial places it.
    pub(crate) fn parked(&self) -> Arena {
        Arena { size: None, ..self.arena() }
    }

    /// A world of that arena in rapier, whatever the engine.
    ///
    /// # Errors
    /// [`Error::Other`] for values that make no world.
    #[cfg(feature = "rapier")]
    pub fn rapier_world(&self) -> Result<farsa_physics::rapier::ArenaWorld, Error> {
        use farsa_physics::rapier::{ArenaOptions, ArenaScene, ArenaWorld};
        let parked = ArenaScene::new(Arena { size: None, ..self.arena() });
        ArenaWorld::new(&parked, &ArenaOptions::default()).map_err(|error| Error::Other(error.to_string()))
    }

    /// Channels that the network reads.
    pub fn inputs(&self) -> usize {
        EYES + 2 * usize::from(self.wheel_speeds)
    }
}
