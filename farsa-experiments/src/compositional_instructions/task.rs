//! The task of `compositional-instructions`. It runs and records episodes of evolved networks.

use std::sync::Arc;

use farsa_body::Recorder;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId};
use farsa_body::robot::Robot;
use farsa_lab::advanced::{Anatomy, ChannelGroup, Description, Intervention, Rollout, mean_of_trials};
use farsa_lab::exports::{ControllerExport, Exports, MotorExport, NetworkExport, SensorExport};
use farsa_lab::{Combination, Episode, EpisodeId, Error, Evaluation, Note, Outcome, Task, TaskInfo};
use farsa_view::Schema;

use crate::compositional_instructions::agent::Agent;
use crate::compositional_instructions::config::Config;
use crate::compositional_instructions::episode::{InstructionEpisode, TrialInstructions};
use crate::compositional_instructions::instruction::{Action, Instruction};
use crate::compositional_instructions::network::{INNER, INPUTS, LAYOUT, MOTORS, Wiring};
use crate::compositional_instructions::protocols::Protocols;
use crate::compositional_instructions::scene::Scene;
use crate::compositional_instructions::schema;
use crate::compositional_instructions::senses::{ArmWorld, channel_names};

/// Runs the trials of a network and defines the channels recorded.
#[derive(Clone)]
pub struct InstructionTask {
    episode: InstructionEpisode<Agent>,
    wiring: Arc<Wiring>,
    trained: Arc<[Instruction]>,
    protocols: Arc<Protocols>,
}

impl InstructionTask {
    /// Creates the task for a scene.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the network cannot be built, or [`Error::Setting`] if all instructions are held out.
    pub fn new(scene: Scene) -> Result<Self, Error> {
        let wiring = Wiring::new(&scene.config.ranges, scene.config.time_step)?;
        let agent = Agent::new(&wiring, scene.config.time_step)?;
        let trained: Arc<[Instruction]> = scene.config.trained().collect();
        let protocols = Arc::new(Protocols::new(&scene.config));
        let episode = InstructionEpisode::new(Arc::new(scene), agent)?;
        Ok(Self { episode, wiring: Arc::new(wiring), trained, protocols })
    }

    fn config(&self) -> &Config {
        &self.episode.scene().config
    }

    /// Gets the current episode.
    pub fn episode(&self) -> &InstructionEpisode<Agent> {
        &self.episode
    }

    /// The instructions of a training trial.
    fn instructions(&self, trial: u32) -> TrialInstructions {
        let Config { starts, steps, .. } = *self.config();
        let number = (trial / starts.max(1)) as usize % self.trained.len().max(1);
        let first = self.trained.get(number).copied().unwrap_or(self.episode.instructions().first);
        TrialInstructions { first, change: None, steps, noise: 0.0 }
    }
}

impl<W> Episode<W> for InstructionTask
where
    W: ArmWorld
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + ?Sized,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.episode.start(world, id);
    }

    fn act(&mut self, world: &mut W) {
        self.episode.act(world);
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.episode.judge(world)
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        schema::record(world, &self.episode, recorder);
    }
}

impl Rollout for InstructionTask {
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let (instructions, mut change) = match evaluation.case {
            None => (self.instructions(evaluation.id.trial), Intervention::default()),
            Some(case) => {
                let Some(probe) = self.protocols.probe(case) else { return false };
                (probe.instructions(), probe.change().clone())
            }
        };
        if let Some(other) = evaluation.intervention {
            change = change.and(other);
        }
        self.episode.instruct(instructions);
        let agent = self.episode.controller_mut();
        agent.load(&self.wiring, evaluation.parameters) && agent.change(&change, evaluation.id)
    }

    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(&schema::in_schema_order(self.episode.controller().network().parameters()));
    }

    fn outcome(&self) -> Outcome {
        let (parts, instruction) = (self.episode.parts(), self.episode.instruction());
        let [target, other] = self.episode.totals().displaced(instruction.color);
        let broken = !self.episode.totals().last().ahead.iter().flatten().all(|x| x.is_finite());
        let before = match self.episode.before_change() {
            None => "none",
            Some((_, true)) => "succeeded",
            Some((_, false)) => "failed",
        };
        Outcome {
            terms: vec![if broken { f64::NAN } else { parts.fitness }],
            steps: self.episode.steps(),
            success: !broken && self.episode.succeeds(),
            notes: vec![
                ("instruction", Note::from(instruction.to_string().as_str())),
                ("find", Note::from(parts.find)),
                ("act", Note::from(parts.act)),
                ("undisturbed", Note::from(parts.undisturbed)),
                ("target moved [m]", Note::from(target)),
                ("other moved [m]", Note::from(other)),
                ("earlier instruction", Note::from(before)),
            ],
            ..Outcome::default()
        }
    }
}

impl InstructionTask {
    fn schema(&self) -> Schema {
        schema::schema(self.episode.scene())
    }

    fn description(&self) -> Description {
        let Config { arm, time_step, condition, .. } = *self.config();
        let [first, second] = arm.ranges;
        let [fast, faster] = arm.speeds;
        let actions = condition.actions().map(Action::word).join(", ");
        let steps = self.config().steps;
        Description {
            sensors: vec![
                ChannelGroup::new(
                    "camera",
                    9,
                    "sectors left, middle, right, in each red, green, blue: 1 if a ray meets it",
                ),
                ChannelGroup::new("touch", 3, "second segment on an object: left side, tip, right side, 0 or 1"),
                ChannelGroup::new(
                    "joints",
                    2,
                    &format!("0 at -{first} and -{second}, 1 at {first} and {second} degrees"),
                ),
                ChannelGroup::new("action", 3, &format!("{actions}: 1 for the given one")),
                ChannelGroup::new("object", 3, "red, green, blue: 1 for the given one"),
            ],
            motors: vec![ChannelGroup::new(
                "speeds",
                MOTORS,
                &format!("left less right is the speed of J1 and of J2, in parts of {fast} and {faster} rad/s"),
            )],
            network: format!("continuous-time recurrent, {INPUTS} sensory, {INNER} inner, {MOTORS} motor neurons"),
            parameters: self.wiring.parameters().len(),
            steps: steps as usize,
            step_seconds: time_step,
        }
    }

    fn anatomy(&self) -> Anatomy {
        let anatomy = Anatomy::new(&self.schema(), &self.description());
        anatomy.with_parameter_order(LAYOUT.parameter_count(), schema::in_schema_order)
    }
}

impl Task for InstructionTask {
    /// In a test the instruction may change, and as many steps follow.
    fn info(&self) -> TaskInfo {
        TaskInfo {
            combination: Some(Combination::Mean),
            description: self.description(),
            trials: self.config().trials(),
            step_budget: Some(2 * u64::from(self.config().steps)),
            terms: vec!["fitness".into()],
            protocols: self.protocols.list(),
            anatomy: Some(self.anatomy()),
            ..TaskInfo::new(self.wiring.parameters().to_vec(), self.schema())
        }
    }

    /// The mean over the trials.
    fn fitness(&self, trials: &[Outcome]) -> f64 {
        mean_of_trials(trials)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }
}

impl Exports for InstructionTask {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.episode.scene().robot.clone())
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        let Config { arm, time_step, steps, condition, .. } = *self.config();
        let mut agent = self.episode.controller().clone();
        if !agent.load(&self.wiring, parameters) {
            return None;
        }
        let network = agent.network();
        let network = NetworkExport::Ctrnn {
            layout: network.layout(),
            time_step: network.time_step(),
            parameters: network.parameters().to_vec(),
        };
        let sensors = channel_names(condition).into_iter().enumerate().map(|(channel, name)| match channel {
            0..9 => SensorExport::quantity(name, "whether a ray of the sector meets the colour first", "1", [0.0, 1.0]),
            9..12 => SensorExport::quantity(name, "whether the second segment is on an object", "1", [0.0, 1.0]),
            12 | 13 => {
                let range = arm.ranges[channel - 12].to_radians();
                SensorExport::quantity(name, "angle of the joint", "rad", [-range, range])
            }
            _ => SensorExport::quantity(name, "whether this is the word", "1", [0.0, 1.0]),
        });
        let motors = schema::OUTPUTS.into_iter().enumerate().map(|(motor, name)| {
            let speed = arm.speeds[motor / 2];
            let end = if motor % 2 == 0 { speed } else { -speed };
            MotorExport::quantity(name, "part of the joint's speed, of which both are added", "rad/s", [0.0, end])
        });
        Some(ControllerExport::new(network, sensors.collect(), motors.collect(), time_step, steps))
    }
}
