//! Settings of all experiments with many wheeled robots.

use farsa_body::robots::MobileRobot;
use farsa_lab::{Error, Setting, Settings};
use farsa_nn::LeakyLayout;
use farsa_physics::arena::Arena;

/// The robots of a team, their world, their eyes and the network that drives each of them.
///
/// Lengths are in meters.
#[derive(Clone, Debug, PartialEq)]
pub struct TeamConfig {
    /// The robot. All are alike.
    pub robot: MobileRobot,
    /// The number of robots.
    pub robots: usize,
    /// The side of the square arena between its walls.
    pub size: f64,
    /// Control step \[s\].
    pub time_step: f64,
    /// Trials of an evaluation, each with its own places.
    pub trials: usize,
    /// Steps of a trial.
    pub steps: u32,
    /// The fastest that a robot drives \[m/s\].
    pub speed: f64,
    /// Sectors of the camera, from left to right.
    pub sectors: usize,
    /// Field of view of the camera \[rad\].
    pub field_of_view: f64,
    /// Rays in a sector.
    pub rays: usize,
    /// Hidden neurons.
    pub hidden: usize,
    /// Weights and biases are decoded to plus and minus this.
    pub weight_range: f64,
}

/// The robots that a team may be of, the default one first, as conditions are called.
pub(crate) const ROBOTS: [&str; 3] = ["marxbot", "e-puck", "khepera"];

impl TeamConfig {
    /// A team of the robot of a condition: the arenas are the source's, the numbers of robots ours.
    pub fn for_condition(condition: &str) -> Self {
        let (robot, size) = match condition {
            "e-puck" => (MobileRobot::e_puck(), 2.5),
            "khepera" => (MobileRobot::khepera(), 2.0),
            _ => (MobileRobot::marxbot(), 5.0),
        };
        Self {
            speed: robot.wheel_radius * robot.max_wheel_speed,
            robot,
            robots: 10,
            size,
            time_step: 0.1,
            trials: 2,
            steps: 1000,
            sectors: 2,
            field_of_view: 72.0_f64.to_radians(),
            rays: 9,
            hidden: 10,
            weight_range: 5.0,
        }
    }

    /// True if the team is of the robot that the source's numbers are for.
    pub(crate) fn uses_marxbots(&self) -> bool {
        self.robot.name == "MarXbot"
    }

    /// Returns every value as a setting, with these as defaults. `robots` adds the number of robots, and `size_given` marks the
    /// arena's size as the source's.
    pub(crate) fn table(&self, robots: bool, size_given: bool) -> Vec<Setting> {
        let size = Setting::number("world.size", self.size, 0.1..=1000.0).unit("m");
        let size = if size_given { size.given() } else { size };
        let mut table = vec![
            size.doc("Side of the square arena between its walls."),
            Setting::number("world.time_step", self.time_step, 0.001..=0.2)
                .unit("s")
                .doc("Control step. 0.1 s is that of the source's other experiments on these robots."),
            Setting::whole("trial.count", whole(self.trials), 1..=100_000)
                .doc("Trials of an evaluation. A few suffice, because a trial is already a mean over many robots."),
            Setting::whole("trial.steps", i64::from(self.steps), 1..=1_000_000).given().doc("Steps of a trial."),
        ];
        if robots {
            table.push(Setting::whole("team.robots", whole(self.robots), 1..=10_000).doc(
                "Robots of the team, one genome in all of them. 10 fit into the nests and leave room to miss each other.",
            ));
        }
        table.extend([
            Setting::number("camera.field_of_view", self.field_of_view.to_degrees(), 1.0..=360.0)
                .unit("deg")
                .doc("Field of view of the camera, around straight ahead: sectors of 36 degrees as the real e-puck's camera, or all around."),
            Setting::whole("camera.rays", whole(self.rays), 1..=1000)
                .doc("Rays in each sector. A sector reads the share of them that see its color."),
            Setting::number("net.weight_range", self.weight_range, 0.0..=1000.0)
                .doc("Weights and biases are decoded to plus and minus this, for a logistic function of slope 1."),
        ]);
        table
    }

    /// These values with those of checked settings.
    ///
    /// # Errors
    /// [`Error::Setting`] for a robot faster than its world can step.
    pub(crate) fn read(mut self, robots: bool, settings: &Settings) -> Result<Self, Error> {
        self.size = settings.number("world.size")?;
        self.time_step = settings.number("world.time_step")?;
        self.trials = settings.count("trial.count")?;
        self.steps = settings.count("trial.steps")? as u32;
        if robots {
            self.robots = settings.count("team.robots")?;
        }
        self.field_of_view = settings.number("camera.field_of_view")?.to_radians();
        self.rays = settings.count("camera.rays")?;
        self.weight_range = settings.number("net.weight_range")?;
        Ok(self)
    }

    /// The robot with the team's greatest speed.
    pub fn robot(&self) -> MobileRobot {
        MobileRobot { max_wheel_speed: self.speed / self.robot.wheel_radius, ..self.robot.clone() }
    }

    /// The walled arena with the robots parked outside. Every trial places them.
    pub fn arena(&self) -> Arena {
        let mut arena = Arena { time_step: self.time_step, ..Arena::walled(self.size, self.size) };
        let apart = 3.0 * self.robot.radius;
        for number in 0..self.robots {
            arena.add_robot(self.robot(), [self.size + 1.0 + apart * number as f64, 0.0], 0.0);
        }
        arena
    }

    /// Channels of infrared and camera, for the given number of colors.
    pub(crate) fn seen(&self, colors: usize) -> usize {
        EYES + self.sectors * colors
    }

    /// The network between the given numbers of inputs and outputs.
    pub(crate) fn layout(&self, inputs: usize, outputs: usize) -> LeakyLayout {
        LeakyLayout::new(inputs, self.hidden, outputs).with_slope(1.0)
    }
}

/// A count as a setting's default.
pub(crate) fn whole(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// Infrared channels of every robot.
pub(crate) const EYES: usize = 8;

/// The settings of evolution with other defaults: the source's evolve for days.
pub(crate) fn evolution([generations, population, parents]: [i64; 3], mutation_rate: f64) -> Vec<Setting> {
    vec![
        Setting::whole("evolution.generations", generations, 1..=i64::from(u32::MAX) - 1)
            .doc("Generations that are evaluated. Enough for what the results show, in minutes."),
        Setting::whole("evolution.population", population, 1..=1_000_000)
            .doc("Individuals of a generation, of each population where there are two. A multiple of the parents."),
        Setting::whole("evolution.parents", parents, 1..=1_000_000)
            .doc("The best individuals, which make population / parents copies each. The first copy is unchanged."),
        Setting::number("evolution.mutation_rate", mutation_rate, 0.0..=1.0).doc(
            "Probability that mutation hits a bit, which is then drawn again. It is that of the runs in docs/results/swarm.md, and was not tuned.",
        ),
    ]
}
