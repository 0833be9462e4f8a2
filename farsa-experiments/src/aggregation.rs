//! The experiment `aggregation`: a team gathers on nests.

pub use crate::aggregation_by_hand::BeaconSeeker;
pub use crate::aggregation_life::{AggregationConfig, AggregationLife};
pub use crate::aggregation_measure::{Gathering, mean_distances};

use farsa_body::{BodyId, Kinematics as _, Recorder, World as _};
use farsa_nn::Controller;
use farsa_physics::arena::World;

use crate::error::Error;
use crate::experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape};
use crate::foraging::{MOTORS, eye_groups, eye_names, in_unit, mean, motor_groups};
use crate::life::{Job, Life as _};
use crate::settings::{Setting, Settings};
use crate::stage::{Channel, Stage};
use crate::swarm_config::ROBOTS;
use crate::swarm_team::{NetworkDecoder, OUTPUTS, TeamNetwork};

/// Can robots that feel a nest only when they are on it gather there, with each other's help? \[FARSA2\]
///
/// A team with one genome starts anywhere in an arena; when the time is up, every robot earns 100 if it is on a nest, and up
/// to 1 for being near the others. The condition is the robot: the `MarXbot`s' arena, steps and rewards are the source's; nests
/// and all that the settings call chosen are ours, and sensors and motors are those of `foraging` without energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Aggregation;

impl Experiment for Aggregation {
    fn name(&self) -> &'static str {
        "aggregation"
    }

    fn summary(&self) -> &'static str {
        "a team of robots gathers on nests that each feels only when it is on them"
    }

    fn conditions(&self) -> &'static [&'static str] {
        &ROBOTS
    }

    fn settings(&self, condition: &str) -> Vec<Setting> {
        AggregationConfig::of_condition(condition).table()
    }

    fn prepare(&self, condition: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        Ok(Box::new(Lives::new(AggregationConfig::of_condition(condition).read(settings)?)?))
    }
}

/// The arena with its robots, and the decoder of genomes.
struct Lives {
    world: World,
    life: AggregationLife<TeamNetwork>,
    decoder: NetworkDecoder,
}

impl Lives {
    fn new(config: AggregationConfig) -> Result<Self, Error> {
        let team = &config.team;
        let decoder = NetworkDecoder::new(team.layout(config.inputs(), OUTPUTS), team.weight_range)?;
        let networks = (0..team.robots).map(|_| decoder.network()).collect::<Result<_, _>>()?;
        let mut world = config.world()?;
        let mut life = AggregationLife::new(config, networks)?;
        // Seeds of this kind are neither a run's nor a test's.
        for trial in 0..8 {
            let job = Job { seed: u64::MAX, trial, ..Job::default() };
            life.arrange(&mut world, job).map_err(|error| Error::setting("world.size", error))?;
        }
        Ok(Self { world, life, decoder })
    }

    fn tell(&self, recorder: &mut dyn Recorder) {
        let Self { world, life, .. } = self;
        let team = life.team();
        recorder.sensors(team.sensed(0));
        recorder.neurons(team.controllers()[0].hidden());
        recorder.outputs(team.done(0));
        let bodies = team.robots() + life.config().nests;
        (0..bodies as u16).map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        let Gathering { dispersion, clusters, largest } = life.gathering();
        let home = life.homes().iter().flatten().count() as f64;
        recorder.scalars(&[home, dispersion, clusters as f64, largest as f64, life.fitness()]);
        // Rounded to the nanosecond: 201 steps of 0.1 s print as 20.1.
        recorder.tick((f64::from(life.steps()) * life.config().team.time_step * 1e9).round() / 1e9);
    }

    fn outcome<C: Controller>(life: &AggregationLife<C>) -> Outcome {
        if life.failed() {
            return Outcome { terms: vec![f64::NAN; 2], ..Outcome::default() };
        }
        let gathering = life.gathering();
        let robots = life.homes().len().max(1) as f64;
        let on = |nest: usize| life.homes().iter().filter(|home| **home == Some(nest)).count();
        let fullest = (0..life.config().nests).map(on).max().unwrap_or(0);
        let home = life.homes().iter().flatten().count();
        Outcome {
            terms: life.terms().to_vec(),
            steps: life.steps(),
            success: home == life.homes().len(),
            notes: vec![
                ("share on a nest", Note::from(home as f64 / robots)),
                ("share on the fullest nest", Note::from(fullest as f64 / robots)),
                ("dispersion", Note::from(gathering.dispersion)),
                ("clusters", Note::from(gathering.clusters as f64)),
                ("share in the largest cluster", Note::from(gathering.largest as f64 / robots)),
            ],
        }
    }
}

/// Lives one trial of a team of any controllers and tells what came of it, as an outcome of the experiment does.
pub fn aggregate<C: Controller>(life: &mut AggregationLife<C>, world: &mut World, job: Job) -> Outcome {
    crate::life::live(life, world, job);
    Lives::outcome(life)
}

impl Setup for Lives {
    fn genes(&self) -> usize {
        self.decoder.layout.parameter_count()
    }

    fn trials(&self) -> usize {
        self.life.config().team.trials
    }

    fn terms(&self) -> Vec<String> {
        ["on a nest", "near the others"].map(String::from).to_vec()
    }

    /// Sensors, neurons and outputs are those of the first robot.
    fn stage(&self) -> Stage {
        let config = self.life.config();
        let names = eye_names(config.team.sectors, &["red", "blue"]);
        let scalars = ["robots on a nest", "dispersion", "clusters", "largest cluster"]
            .map(|name| Channel::new(name).group("place"));
        let stage = Stage::of_arena(&config.arena()).with_sensors(names.into_iter().chain(["nest".into()]));
        let stage = in_unit(stage.with_outputs(MOTORS).with_network(&self.decoder.layout));
        Stage { scalars: scalars.into_iter().chain([Channel::new("fitness now").group("fitness")]).collect(), ..stage }
    }

    fn description(&self) -> Description {
        let config = self.life.config();
        let mut sensors = eye_groups(&config.team, "red and blue", 2);
        sensors.push(ChannelGroup::new("ground", 1, "1 on a nest, else 0"));
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
