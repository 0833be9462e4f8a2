//! The experiment `foraging`: a team carries food to its nest.

pub use crate::foraging_by_hand::HomingForager;
pub use crate::foraging_field::{Field, Forager};
pub use crate::foraging_life::{ForagingConfig, ForagingLife};
pub use crate::swarm_config::TeamConfig;
pub use crate::swarm_robot::RobotEyes;
pub use crate::swarm_team::{Team, TeamNetwork};

use farsa_body::{BodyId, Kinematics as _, Recorder, World as _};
use farsa_nn::Controller;
use farsa_physics::arena::World;

use crate::error::Error;
use crate::experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape};
use crate::life::{Job, Life as _};
use crate::settings::{Setting, Settings};
use crate::stage::{Channel, Stage};
use crate::swarm_config::{EYES, ROBOTS};
use crate::swarm_team::{NetworkDecoder, OUTPUTS};

/// Can robots that see little and die soon feed a nest together? \[FARSA2\]
///
/// A team with one genome leaves the nest, takes the food that it drives over, and must be back before its energy is
/// used up. The condition is the robot: arenas, nests, energy, steps, sensors, motors and hidden neurons are the source's;
/// the number of robots, the time step, the camera's view and the network's other traits are ours, as the settings say.
/// What a robot carries is not limited. Each infrared channel of a `MarXbot` is the largest of three of its 24 sensors; the
/// source's bias neuron is the network's biases, which only its hidden neurons have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Foraging;

impl Experiment for Foraging {
    fn name(&self) -> &'static str {
        "foraging"
    }

    fn summary(&self) -> &'static str {
        "a team of robots carries food to its nest and must be back there before its energy is used up"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &ROBOTS
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        ForagingConfig::of_condition(condition).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        Ok(Box::new(Lives::new(ForagingConfig::of_condition(condition).read(settings)?)?))
    }
}

/// The field with its robots, and the decoder of genomes.
struct Lives {
    world: World,
    life: ForagingLife<TeamNetwork>,
    decoder: NetworkDecoder,
}

impl Lives {
    fn new(config: ForagingConfig) -> Result<Self, Error> {
        let team = &config.team;
        let decoder = NetworkDecoder::new(team.layout(config.inputs(), OUTPUTS), team.weight_range)?;
        let networks = (0..team.robots).map(|_| decoder.network()).collect::<Result<_, _>>()?;
        let mut world = config.world()?;
        let mut life = ForagingLife::new(config, networks)?;
        // Seeds of this kind are neither a run's nor a test's.
        for trial in 0..8 {
            let job = Job { seed: u64::MAX, trial, ..Job::default() };
            life.arrange(&mut world, job).map_err(|error| Error::setting("team.robots", error))?;
        }
        Ok(Self { world, life, decoder })
    }

    fn tell(&self, recorder: &mut dyn Recorder) {
        let Self { world, life, .. } = self;
        let (team, field) = (life.team(), life.field());
        recorder.sensors(team.sensed(0));
        recorder.neurons(team.controllers()[0].hidden());
        recorder.outputs(team.done(0));
        let bodies = 0..=team.robots() as u16;
        bodies.map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        let mut scalars: Vec<f64> =
            field.robots().iter().flat_map(|forager| [forager.energy, f64::from(forager.carried)]).collect();
        scalars.extend([f64::from(field.collected()), f64::from(field.lost()), field.left() as f64]);
        recorder.scalars(&scalars);
        // Rounded to the nanosecond: 201 steps of 0.1 s print as 20.1.
        recorder.tick((f64::from(life.steps()) * life.config().team.time_step * 1e9).round() / 1e9);
    }

    fn outcome<C: Controller>(life: &ForagingLife<C>) -> Outcome {
        if life.failed() {
            return Outcome::failed();
        }
        let field = life.field();
        let robots = field.robots().len().max(1) as f64;
        let energy: f64 = field.robots().iter().map(|forager| forager.energy).sum();
        Outcome {
            terms: vec![life.fitness()],
            steps: life.steps(),
            success: field.deaths() == 0,
            notes: vec![
                ("food collected", Note::from(f64::from(field.collected()))),
                ("food carried at the end", Note::from(f64::from(field.carried()))),
                ("food lost with the dead", Note::from(f64::from(field.lost()))),
                ("deaths", Note::from(field.deaths() as f64)),
                ("energy at the end", Note::from(energy / robots)),
            ],
        }
    }
}

/// Lives one trial of a team of any controllers and tells what came of it, as an outcome of the experiment does.
pub fn forage<C: Controller>(life: &mut ForagingLife<C>, world: &mut World, job: Job) -> Outcome {
    crate::life::live(life, world, job);
    Lives::outcome(life)
}

/// The names of what the eyes of a robot read.
pub(crate) fn eye_names(sectors: usize, colors: &[&str]) -> Vec<String> {
    let sectors = (1..=sectors).flat_map(|sector| colors.iter().map(move |color| format!("camera {sector} {color}")));
    (1..=EYES).map(|eye| format!("infrared {eye}")).chain(sectors).collect()
}

/// The stage's sensors and outputs, between 0 and 1.
pub(crate) fn in_unit(mut stage: Stage) -> Stage {
    stage.outputs.iter_mut().chain(&mut stage.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
    stage
}

/// The sensors of infrared and camera.
pub(crate) fn eye_groups(config: &TeamConfig, colors: &str, count: usize) -> Vec<ChannelGroup> {
    let sectors = config.sectors;
    vec![
        ChannelGroup::new(
            "infrared",
            EYES,
            "eight directions in the robot's order, 0 nothing .. 1 at the hull, by rays",
        ),
        ChannelGroup::new(
            "camera",
            sectors * count,
            &format!("{sectors} sectors from left to right, in each the share of it that is {colors}, 0..1"),
        ),
    ]
}

/// The motors of a team's robot.
pub(crate) fn motor_groups() -> Vec<ChannelGroup> {
    vec![
        ChannelGroup::new("wheels", 2, "speed, 0 at rest .. 1 ahead; turn, 0 right .. 1/2 straight on .. 1 left"),
        ChannelGroup::new("LEDs", 2, "red and blue, 0 dark .. 1; without effect on a robot that has none"),
    ]
}

pub(crate) const MOTORS: [&str; OUTPUTS] = ["speed", "turn", "red", "blue"];

impl Setup for Lives {
    fn genes(&self) -> usize {
        self.decoder.layout.parameter_count()
    }

    fn trials(&self) -> usize {
        self.life.config().team.trials
    }

    fn terms(&self) -> Vec<String> {
        vec!["food".into()]
    }

    /// Sensors, neurons and outputs are those of the first robot.
    fn stage(&self) -> Stage {
        let config = self.life.config();
        let of_robot = |number: usize| {
            let energy = Channel::new(&format!("energy {number}")).group("energy").range(0.0, 1.0);
            [energy, Channel::new(&format!("carried {number}")).group("food")]
        };
        let food = ["collected", "lost", "left"].map(|name| Channel::new(name).group("fitness"));
        let names = eye_names(config.team.sectors, &["red", "blue"]);
        let sensors = names.into_iter().chain(["nest", "energy"].map(String::from));
        let stage = Stage::of_arena(&config.arena()).with_sensors(sensors).with_outputs(MOTORS);
        let stage = in_unit(stage.with_network(&self.decoder.layout));
        Stage { scalars: (1..=config.team.robots).flat_map(of_robot).chain(food).collect(), ..stage }
    }

    fn description(&self) -> Description {
        let config = self.life.config();
        let mut sensors = eye_groups(&config.team, "red and blue", 2);
        sensors.push(ChannelGroup::new("ground", 1, "1 in the nest, else 0"));
        sensors.push(ChannelGroup::new("energy", 1, "1 in the nest .. 0 dead"));
        let layout = &self.decoder.layout;
        Description {
            sensors,
            motors: motor_groups(),
            network: format!(
                "{}-{}-{OUTPUTS}, recurrent hidden layer, the same in all robots",
                config.inputs(),
                layout.hidden()
            ),
            parameters: layout.parameter_count(),
            steps: config.team.steps as usize,
            step_seconds: config.team.time_step,
        }
    }

    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        if !self.decoder.decode_into(genes, self.life.team_mut().controllers_mut()) {
            return Outcome::failed();
        }
        if let Some(recorder) = tape.recorder() {
            recorder.parameters(&self.decoder.parameters);
        }
        self.life.start(&mut self.world, job);
        while !self.life.failed() {
            self.life.act(&mut self.world);
            if let Some(recorder) = tape.recorder() {
                self.life.team().tell_rays(&self.world, 0, recorder);
            }
            self.world.step();
            let end = self.life.judge(&self.world);
            if let Some(recorder) = tape.recorder() {
                self.tell(recorder);
            }
            if end.is_some() {
                break;
            }
        }
        Self::outcome(&self.life)
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean(trials)
    }
}

/// The mean over trials of what they earned.
pub(crate) fn mean(trials: &[Outcome]) -> f64 {
    let sum: f64 = trials.iter().flat_map(|outcome| &outcome.terms).sum();
    sum / trials.len().max(1) as f64
}
