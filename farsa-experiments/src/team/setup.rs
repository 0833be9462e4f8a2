//! A mission of a team as an experiment lives it: from genes to outcomes.

use farsa_body::{BodyId, Kinematics as _, Recorder, World as _};
use farsa_physics::arena::{Arena, World};

use crate::team::robots::OUTPUTS;
use crate::team::{config::EYES, config::TeamConfig};
use crate::team::{life::Mission, life::TeamLife};
use farsa_lab::{ChannelGroup, Description, Error, Job, Life as _, NetworkDecoder, Outcome, Setup, Tape, TeamNetwork};
use farsa_view::Stage;

/// The arena with its robots, and the decoder of genomes.
pub(crate) struct TeamSetup<M> {
    world: World,
    life: TeamLife<M, TeamNetwork>,
    decoder: NetworkDecoder,
    /// Bodies whose poses are told: robots and what is placed beside them.
    bodies: u16,
}

/// A world of an arena whose robots and areas every trial places anew.
pub(crate) fn world(arena: Arena) -> Result<World, Error> {
    World::new(&Arena { size: None, ..arena }).map_err(|error| Error::Other(error.to_string()))
}

impl<M: Mission> TeamSetup<M> {
    /// Ready for a mission.
    ///
    /// # Errors
    /// [`Error::Setting`] for an arena without room for all, [`Error::Other`] for values that make no world or team.
    pub(crate) fn new(mission: M) -> Result<Self, Error> {
        let (config, [inputs, outputs], arena) = (mission.robots(), mission.shape(), mission.arena());
        let decoder = NetworkDecoder::new(config.layout(inputs, outputs), config.weight_range)?;
        let networks = (0..config.robots).map(|_| decoder.network()).collect::<Result<_, _>>()?;
        let bodies = (arena.robots.len() + arena.areas.len()) as u16;
        let mut world = world(arena)?;
        let mut life = TeamLife::on(mission, networks)?;
        // Seeds of this kind are neither a run's nor a test's.
        for trial in 0..8 {
            let job = Job { seed: u64::MAX, trial, ..Job::default() };
            life.arrange(&mut world, job).map_err(|error| Error::setting(life.mission().crowded(), error))?;
        }
        Ok(Self { world, life, decoder, bodies })
    }

    /// Tells what the robot of population `own` sensed, computed and did before the step that has just been judged, and
    /// what that led to.
    fn tell(&self, own: usize, recorder: &mut dyn Recorder) {
        let Self { world, life, bodies, .. } = self;
        let team = life.team();
        recorder.sensors(team.sensed(own));
        recorder.neurons(team.controllers()[own].hidden());
        recorder.outputs(team.done(own));
        (0..*bodies).map(BodyId).for_each(|body| recorder.pose(body, world.pose(body)));
        recorder.scalars(&life.mission().scalars(life.moment()));
        // Rounded to the nanosecond: 201 steps of 0.1 s print as 20.1.
        recorder.tick((f64::from(life.steps()) * life.mission().robots().time_step * 1e9).round() / 1e9);
    }

    /// Gives all robots their networks; of several populations robot p that of population p.
    fn decode(&mut self, own: usize, genes: &[u16], opponents: &[&[u16]]) -> bool {
        let (count, networks) = (self.populations(), self.life.team_mut().controllers_mut());
        if count == 1 {
            return self.decoder.decode_into(genes, networks);
        }
        // Without opponents everybody meets its like. The own parameters come last: a recorder is told them.
        let others = (0..count).filter(|population| *population != own);
        let others = others.enumerate().map(|(i, population)| (population, opponents.get(i).copied().unwrap_or(genes)));
        others.chain([(own, genes)]).all(|(robot, genes)| {
            networks.get_mut(robot..=robot).is_some_and(|network| self.decoder.decode_into(genes, network))
        })
    }
}

impl<M: Mission> Setup for TeamSetup<M> {
    fn genes(&self) -> usize {
        self.decoder.layout.parameter_count()
    }

    fn populations(&self) -> usize {
        self.life.mission().population_names().len()
    }

    fn population_names(&self) -> Vec<String> {
        self.life.mission().population_names().iter().map(|&name| name.into()).collect()
    }

    fn trials(&self) -> usize {
        self.life.mission().robots().trials
    }

    fn terms(&self) -> Vec<String> {
        self.life.mission().terms()
    }

    /// Sensors, neurons and outputs are those of the first robot, or of the individual's where populations meet.
    fn stage(&self) -> Stage {
        let mission = self.life.mission();
        let [_, outputs] = mission.shape();
        let stage = Stage::of_arena(&mission.arena()).with_sensors(mission.input_names());
        let mut stage = stage.with_outputs(MOTORS.into_iter().take(outputs)).with_network(&self.decoder.layout);
        stage.outputs.iter_mut().chain(&mut stage.sensors).for_each(|channel| channel.range = Some([0.0, 1.0]));
        Stage { scalars: mission.channels(), ..stage }
    }

    fn description(&self) -> Description {
        let (mission, layout) = (self.life.mission(), &self.decoder.layout);
        let (config, [inputs, outputs]) = (mission.robots(), mission.shape());
        let whose = if self.populations() == 1 { ", the same in all robots" } else { "" };
        Description {
            sensors: mission.inputs(),
            motors: motor_groups().into_iter().take(outputs / 2).collect(),
            network: format!("{inputs}-{}-{outputs}, recurrent hidden layer{whose}", layout.hidden()),
            parameters: layout.parameter_count(),
            steps: config.steps as usize,
            step_seconds: config.time_step,
        }
    }

    fn live(&mut self, genes: &[u16], job: Job, tape: &mut Tape<'_>) -> Outcome {
        self.live_against(genes, &[], job, tape)
    }

    fn live_against(&mut self, genes: &[u16], opponents: &[&[u16]], job: Job, tape: &mut Tape<'_>) -> Outcome {
        let own = job.population(self.life.mission().population_size()).min(self.populations() - 1);
        if !self.decode(own, genes, opponents) {
            return Outcome::failed();
        }
        if let Some(recorder) = tape.recorder() {
            recorder.parameters(&self.decoder.parameters);
        }
        self.life.start(&mut self.world, job);
        while !self.life.failed() {
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
                break;
            }
        }
        self.life.outcome(own)
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        let sum: f64 = trials.iter().flat_map(|outcome| &outcome.terms).sum();
        sum / trials.len().max(1) as f64
    }
}

const MOTORS: [&str; OUTPUTS] = ["speed", "turn", "red", "blue"];

/// The motors of a team's robot, two channels in each group.
fn motor_groups() -> Vec<ChannelGroup> {
    vec![
        ChannelGroup::new("wheels", 2, "speed, 0 at rest .. 1 ahead; turn, 0 right .. 1/2 straight on .. 1 left"),
        ChannelGroup::new("LEDs", 2, "red and blue, 0 dark .. 1; without effect on a robot that has none"),
    ]
}

/// The names of what the eyes of a robot read.
pub(crate) fn eye_names(sectors: usize, colors: &[&str]) -> Vec<String> {
    let sectors = (1..=sectors).flat_map(|sector| colors.iter().map(move |color| format!("camera {sector} {color}")));
    (1..=EYES).map(|eye| format!("infrared {eye}")).chain(sectors).collect()
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
