//! The experiment `predator-prey`: two populations evolve against each other.

pub use crate::predator_prey_by_hand::Chaser;
pub use crate::predator_prey_life::{PredatorPreyConfig, PredatorPreyLife};

use farsa_body::{BodyId, Kinematics as _, Recorder, World as _};
use farsa_nn::Controller;
use farsa_physics::arena::World;

use crate::error::Error;
use crate::experiment::{ChannelGroup, Description, Experiment, Note, Outcome, Setup, Tape};
use crate::foraging::{eye_groups, eye_names, in_unit, mean};
use crate::life::{Job, Life as _};
use crate::predator_prey_life::{OUTPUTS, PREDATOR, PREY};
use crate::settings::{Setting, Settings};
use crate::stage::{Channel, Stage};
use crate::swarm_team::{NetworkDecoder, TeamNetwork};

/// Do a predator and a prey that evolve against each other become better at both? \[FARSA2\]
///
/// Two `MarXbots` of the same abilities in a walled arena. The predators, the first population, earn 1 - t/T for touching
/// the prey at step t of T, else nothing; the prey, the second, earn the rest of 1. Arena, starts, T and rewards are the
/// source's; headings, sensors, network and evolution are ours, as the settings say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PredatorPrey;

impl Experiment for PredatorPrey {
    fn name(&self) -> &'static str {
        "predator-prey"
    }

    fn summary(&self) -> &'static str {
        "a robot chases another one, and both evolve against each other in two populations"
    }

    fn settings(&self, _: &str) -> Vec<Setting> {
        PredatorPreyConfig::default().table()
    }

    fn prepare(&self, _: &str, settings: &Settings) -> Result<Box<dyn Setup>, Error> {
        Ok(Box::new(Lives::new(PredatorPreyConfig::default().read(settings)?)?))
    }
}

/// The arena with the two robots, and a decoder for the genome of each.
struct Lives {
    world: World,
    life: PredatorPreyLife<TeamNetwork>,
    decoders: [NetworkDecoder; 2],
}

impl Lives {
    fn new(config: PredatorPreyConfig) -> Result<Self, Error> {
        let team = &config.team;
        let decoder = NetworkDecoder::new(team.layout(config.inputs(), OUTPUTS), team.weight_range)?;
        let networks = [decoder.network()?, decoder.network()?];
        let world = config.world()?;
        Ok(Self { world, life: PredatorPreyLife::new(config, networks)?, decoders: [decoder.clone(), decoder] })
    }

    fn tell(&self, own: usize, recorder: &mut dyn Recorder) {
        let Self { world, life, .. } = self;
        let team = life.team();
        recorder.sensors(team.sensed(own));
        recorder.neurons(team.controllers()[own].hidden());
        recorder.outputs(team.done(own));
        for body in [PREDATOR, PREY].map(|robot| BodyId(robot as u16)) {
            recorder.pose(body, world.pose(body));
        }
        recorder.scalars(&[life.gap(), life.reward(PREDATOR), life.reward(PREY)]);
        // Rounded to the nanosecond: 201 steps of 0.1 s print as 20.1.
        recorder.tick((f64::from(life.steps()) * life.config().team.time_step * 1e9).round() / 1e9);
    }

    fn outcome<C: Controller>(life: &PredatorPreyLife<C>, own: usize) -> Outcome {
        let captured = life.captured();
        Outcome {
            terms: vec![life.reward(own)],
            steps: life.steps(),
            success: captured == (own == PREDATOR),
            notes: vec![
                ("captures", Note::from(if captured { 1.0 } else { 0.0 })),
                ("time [s]", Note::from(f64::from(life.steps()) * life.config().team.time_step)),
                ("gap at the end [m]", Note::from(life.gap())),
            ],
        }
    }
}

/// Lives one trial of any two controllers and tells what came of it for the predator, as an outcome of the experiment does.
pub fn chase<C: Controller>(life: &mut PredatorPreyLife<C>, world: &mut World, job: Job) -> Outcome {
    crate::life::live(life, world, job);
    Lives::outcome(life, PREDATOR)
}

impl Setup for Lives {
    fn genes(&self) -> usize {
        self.decoders[0].layout.parameter_count()
    }

    fn populations(&self) -> usize {
        2
    }

    fn population_names(&self) -> Vec<String> {
        ["predator", "prey"].map(String::from).to_vec()
    }

    fn trials(&self) -> usize {
        self.life.config().team.trials
    }

    fn terms(&self) -> Vec<String> {
        vec!["reward".into()]
    }

    /// Sensors, neurons and outputs are those of the individual.
    fn stage(&self) -> Stage {
        let config = self.life.config();
        let names = eye_names(config.team.sectors, &["other"]);
        let stage = Stage::of_arena(&config.arena()).with_sensors(names).with_outputs(["speed", "turn"]);
        let stage = in_unit(stage.with_network(&self.decoders[0].layout));
        let rewards = ["predator's reward", "prey's reward"].map(|name| Channel::new(name).group("fitness"));
        let gap = Channel::new("gap [m]").group("place");
        Stage { scalars: [gap].into_iter().chain(rewards).collect(), ..stage }
    }

    fn description(&self) -> Description {
        let config = self.life.config();
        let layout = &self.decoders[0].layout;
        Description {
            sensors: eye_groups(&config.team, "the other robot", 1),
            motors: vec![ChannelGroup::new(
                "wheels",
                OUTPUTS,
                "speed, 0 at rest .. 1 ahead; turn, 0 right .. 1/2 straight on .. 1 left",
            )],
            network: format!("{}-{}-{OUTPUTS}, recurrent hidden layer", config.inputs(), layout.hidden()),
            parameters: layout.parameter_count(),
            steps: config.team.steps as usize,
            step_seconds: config.team.time_step,
        }
    }

    /// Against its like: a life needs two.
    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        self.live_against(genes, &[genes], job, tape)
    }

    fn live_against(&mut self, genes: &[u16], opponents: &[&[u16]], job: Job, tape: &mut Tape<'_>) -> Outcome {
        let own = job.population(self.life.config().population).min(PREY);
        let other = PREDATOR + PREY - own;
        let Some(opponent) = opponents.first() else { return self.live(genes, job, tape) };
        let Self { decoders, life, .. } = self;
        let networks = life.team_mut().controllers_mut();
        for (robot, genes) in [(own, genes), (other, *opponent)] {
            if !decoders[robot].decode_into(genes, &mut networks[robot..=robot]) {
                return Outcome::failed();
            }
        }
        if let Some(recorder) = tape.recorder() {
            recorder.parameters(&self.decoders[own].parameters);
        }
        self.life.start(&mut self.world, job);
        loop {
            self.life.act(&mut self.world);
            if let Some(recorder) = tape.recorder() {
                self.life.team().tell_rays(&self.world, own, recorder);
            }
            self.world.step();
            let end = self.life.judge(&self.world);
            if let Some(recorder) = tape.recorder() {
                self.tell(own, recorder);
            }
            if end.is_some() {
                return Self::outcome(&self.life, own);
            }
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean(trials)
    }
}
