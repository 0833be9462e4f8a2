//! Episodes of `compositional-instructions`, in which an agent receives an instruction that it has to follow.

use std::sync::Arc;

use farsa_body::ports::{Actuated, ActuatorId, Arrange, Handles};
use farsa_lab::{Episode, EpisodeId, Error};
use farsa_nn::Controller;
use farsa_num::{Domain, Stream};

use crate::compositional_instructions::fitness::{Observation, Parts, RewardTotals};
use crate::compositional_instructions::instruction::Instruction;
use crate::compositional_instructions::network::{INPUTS, MOTORS};
use crate::compositional_instructions::scene::Scene;
use crate::compositional_instructions::senses::{ArmWorld, Senses};

/// The channels before the two words.
const WORDS: usize = 14;

fn noise_of(id: EpisodeId) -> Stream {
    Stream::new(id.seed, Domain::Sensor, id.trial, id.individual, id.generation)
}

/// The instructions of one trial. Some tests replace the first instruction while the trial is running.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialInstructions {
    /// Instruction given at the start.
    pub first: Instruction,
    /// Step at which the instruction changes and the new instruction, or `None` if it stays the same.
    pub change: Option<(u32, Instruction)>,
    /// Number of steps of the trial.
    pub steps: u32,
    /// Standard deviation of the noise added to the camera, the touch sensors and the joint angles.
    pub noise: f32,
}

impl TrialInstructions {
    /// Returns the instruction that is active at the given step.
    pub fn at(&self, step: u32) -> Instruction {
        match self.change {
            Some((from, then)) if step >= from => then,
            _ => self.first,
        }
    }
}

/// A trial that is run by a controller. Its result depends on the instruction that is active at the end.
///
/// When the instruction changes, all totals are reset, and displacements are measured from the current places of the
/// objects.
#[derive(Clone, Debug)]
pub struct InstructionEpisode<C> {
    scene: Arc<Scene>,
    senses: Senses,
    controller: C,
    instructions: TrialInstructions,
    /// Where the objects were when the instruction was given \[m\].
    places: [[f64; 2]; 3],
    totals: RewardTotals,
    /// Result of the first instruction when it was withdrawn.
    before_change: Option<(Parts, bool)>,
    steps: u32,
    stream: Stream,
    /// The next inputs, and the last inputs and outputs.
    next: [f32; INPUTS],
    x: [f32; INPUTS],
    y: [f32; MOTORS],
}

impl<C: Controller> InstructionEpisode<C> {
    /// Creates an episode for a controller with 20 inputs and 4 outputs.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the controller has a different number of inputs or outputs, or if the camera is
    /// invalid.
    pub fn new(scene: Arc<Scene>, controller: C) -> Result<Self, Error> {
        let (inputs, outputs) = (controller.inputs(), controller.outputs());
        if inputs != INPUTS || outputs != MOTORS {
            let why = format!("compositional-instructions: a controller of {inputs} inputs and {outputs} outputs");
            return Err(Error::Other(format!("{why} for {INPUTS} sensors and {MOTORS} motors")));
        }
        let senses = Senses::new(&scene)?;
        let first = scene.config.condition.instructions()[0];
        let instructions = TrialInstructions { first, change: None, steps: scene.config.steps, noise: 0.0 };
        Ok(Self {
            scene,
            senses,
            controller,
            instructions,
            places: [[0.0; 2]; 3],
            totals: RewardTotals::default(),
            before_change: None,
            steps: 0,
            stream: noise_of(EpisodeId::default()),
            next: [0.0; INPUTS],
            x: [0.0; INPUTS],
            y: [0.0; MOTORS],
        })
    }

    /// Sets the instructions of the following episodes.
    pub fn instruct(&mut self, instructions: TrialInstructions) {
        self.instructions = instructions;
    }

    /// Gets the instructions of the current trial.
    pub fn instructions(&self) -> &TrialInstructions {
        &self.instructions
    }

    /// Gets the scene in which the episodes take place.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Gets the controller of the arm.
    pub fn controller(&self) -> &C {
        &self.controller
    }

    /// Returns a mutable reference to the controller, for example to load different parameters.
    pub fn controller_mut(&mut self) -> &mut C {
        &mut self.controller
    }

    /// Gets the 20 sensor values of the last step.
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// Gets the 4 motor values of the last step.
    pub fn done(&self) -> &[f32] {
        &self.y
    }

    /// Gets the number of steps that have been completed.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Returns the instruction that determines the result of the trial.
    pub fn instruction(&self) -> Instruction {
        self.instructions.at(self.steps)
    }

    /// Gets the totals that have been collected so far.
    pub fn totals(&self) -> &RewardTotals {
        &self.totals
    }

    /// Gets the reward and the success of the first instruction, or `None` before the instruction changes.
    pub fn before_change(&self) -> Option<(Parts, bool)> {
        self.before_change
    }

    /// Computes the reward under the assumption that the trial ends now.
    pub fn parts(&self) -> Parts {
        self.totals.parts(self.instruction(), &self.scene.config.judging)
    }

    /// Returns true if the trial would count as a success if it ended now.
    pub fn succeeds(&self) -> bool {
        self.totals.succeeds(self.instruction(), &self.scene.config.judging)
    }

    fn place_of_objects<W: ArmWorld + ?Sized>(&self, world: &W) -> [[f64; 2]; 3] {
        self.scene.objects.map(|object| {
            let [x, y, _] = world.origin(object);
            [x, y].map(f64::from)
        })
    }

    /// Reads the sensors for the step to come.
    fn sense<W: ArmWorld + ?Sized>(&mut self, world: &W) -> Observation {
        let instruction = self.instructions.at(self.steps);
        self.senses.read(world, instruction, &self.places, &mut self.next)
    }
}

impl<W, C> Episode<W> for InstructionEpisode<C>
where
    W: ArmWorld + Actuated + Arrange + Handles<Actuator = ActuatorId> + ?Sized,
    C: Controller,
{
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.scene.arrange(world, &self.scene.start_pose(id));
        self.controller.reset();
        (self.totals, self.before_change, self.steps) = (RewardTotals::default(), None, 0);
        (self.x, self.y) = ([0.0; INPUTS], [0.0; MOTORS]);
        self.stream = noise_of(id);
        self.places = self.place_of_objects(world);
        self.sense(world);
    }

    fn act(&mut self, world: &mut W) {
        self.x = self.next;
        if self.instructions.noise > 0.0 {
            // Words are exact. Only sensors and joints have noise.
            for x in &mut self.x[..WORDS] {
                *x += self.instructions.noise * self.stream.normal();
            }
        }
        self.controller.step(&self.x, &mut self.y);
        let speeds = self.scene.config.arm.speeds;
        for ((motors, actuator), largest) in self.y.chunks_exact(2).zip(Scene::ACTUATORS).zip(speeds) {
            // The difference of two outputs in [0, 1] is a share of the largest speed (in rad/s).
            world.command(actuator, [(motors[0] - motors[1]) * largest as f32, 0.0]);
        }
    }

    fn judge(&mut self, world: &mut W) -> Option<f64> {
        // The instruction of the action. The step number below already belongs to the next one.
        let held = self.instructions.at(self.steps);
        self.steps += 1;
        let now = self.sense(world);
        let window = self.scene.config.window_steps();
        let withdrawn = self.instructions.change.is_some_and(|(at, _)| self.steps == at);
        // The window of late steps precedes the change for the first instruction and the end for the second.
        let end = self
            .instructions
            .change
            .map_or(self.instructions.steps, |(at, _)| if self.steps <= at { at } else { self.instructions.steps });
        self.totals.add(held, now, self.steps + window > end);
        if !now.ahead.iter().flatten().all(|x| x.is_finite()) {
            return Some(f64::NAN);
        }
        if withdrawn {
            let judging = &self.scene.config.judging;
            self.before_change = Some((self.totals.parts(held, judging), self.totals.succeeds(held, judging)));
            // Totals and reference places restart, so the second instruction is judged alone.
            self.totals = RewardTotals::default();
            self.places = self.place_of_objects(world);
        }
        (self.steps >= self.instructions.steps).then(|| self.parts().fitness)
    }
}
