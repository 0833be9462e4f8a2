//! Task of an experiment from a file, in any world.

use farsa_body::Recorder;
use farsa_body::robot::Robot;
use farsa_lab::advanced::{Behavior, ExternalControl, Learner, Rollout};
use farsa_lab::exports::{ControllerExport, Exports, MotorDrive, MotorExport, SensorExport, SensorReading};
use farsa_lab::{Episode, EpisodeId, Evaluation, Outcome, Task, TaskInfo};
use farsa_models::mjcf::MjcfOptions;
use farsa_view::{Channel, Schema};

use crate::document::{Motor, Sensor};
use crate::part::{PartScene, Quantity};
use crate::parts::agents::Agents;
use crate::parts::network_spec::Spans;
use crate::parts::wrapping::changes;

/// Describes a channel in a scene.
type Describe = Box<dyn Fn(usize, &PartScene<'_>) -> Quantity>;

/// Agents in a world of some kind.
pub(crate) trait Body: Clone + Send + 'static {
    /// Gets the agents.
    fn agents(&self) -> &Agents;

    /// Gets the agents.
    fn agents_mut(&mut self) -> &mut Agents;

    /// Builds the schema with the bodies of a recording.
    fn bodies(&self) -> Schema;

    /// Lists the scalars of a recording, except those of terms.
    fn scalars(&self) -> Vec<Channel>;

    /// Returns the robot for exports.
    fn robot(&self) -> Robot;

    /// Returns the options of a MuJoCo model, if any.
    fn mjcf_options(&self) -> Option<MjcfOptions> {
        None
    }

    /// Calls a function with the scene of a robot's parts.
    fn in_scene(&self, robot: usize, call: &mut dyn FnMut(&PartScene<'_>));
}

/// Task of an experiment over the episode of its world.
#[derive(Clone, Debug)]
pub(crate) struct ComposedTask<E>(pub(crate) E);

impl<W, E: Episode<W>> Episode<W> for ComposedTask<E> {
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        self.0.start(world, id);
    }
    fn has_started(&self) -> bool {
        self.0.has_started()
    }
    #[inline]
    fn act(&mut self, world: &mut W) {
        self.0.act(world);
    }
    #[inline]
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.0.judge(world)
    }
    fn external(&mut self) -> Result<&mut dyn ExternalControl<W>, String> {
        self.0.external()
    }
    fn record_action(&self, world: &W, recorder: &mut dyn Recorder) {
        self.0.record_action(world, recorder);
    }
    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        self.0.record(world, recorder);
    }
}

impl<E: Body> Task for ComposedTask<E> {
    fn info(&self) -> TaskInfo {
        let agents = self.0.agents();
        let schema = self.explained(agents.schema(self.0.bodies(), self.0.scalars()));
        // A network with wires set by hand has inputs and links, but no neurons.
        let anatomy = Some(agents.anatomy(&schema));
        let info = TaskInfo::new(agents.spec.searched.parameters().to_vec(), schema);
        let (populations, robots) = (agents.groups.populations(), agents.groups.robots());
        let robots = info.schema.bodies.iter().take(if robots > 1 { robots } else { 0 }).cloned().collect();
        TaskInfo {
            description: agents.description(),
            trials: agents.document.episode.trials as usize,
            terms: agents.ledger.names(),
            combination: Some(agents.ledger.combination()),
            has_success: agents.ledger.has_success(),
            populations: if populations.is_empty() { info.populations } else { populations },
            robots,
            observations: agents.spec.inputs.len(),
            protocols: agents.interventions.protocols(),
            anatomy,
            warnings: agents.ledger.warnings.clone(),
            ..info
        }
    }

    fn behavior(&self) -> Option<&dyn Behavior> {
        self.0.agents().ledger.behaviour.as_ref().map(|behaviour| behaviour as _)
    }

    fn exports(&self) -> Option<&dyn Exports> {
        Some(self)
    }

    fn fitness(&self, trials: &[Outcome]) -> f64 {
        self.0.agents().ledger.fitness(trials)
    }
}

impl<E: Body> Rollout for ComposedTask<E> {
    /// Loads the networks of the robots.
    fn load(&mut self, evaluation: &Evaluation<'_>) -> bool {
        self.0.agents_mut().load(evaluation)
    }
    fn record_parameters(&self, recorder: &mut dyn Recorder) {
        let agents = self.0.agents();
        recorder.parameters(agents.networks[agents.watched].controller().own_parameters());
    }
    fn outcome(&self) -> Outcome {
        self.0.agents().outcome()
    }
    fn learner(&mut self) -> Option<&mut dyn Learner> {
        self.0.agents_mut().trainee.as_mut().map(|trainee| trainee as _)
    }
}

impl<E: Body> Exports for ComposedTask<E> {
    fn robot(&self, _: Option<&[f32]>) -> Option<Robot> {
        Some(self.0.robot())
    }

    fn mjcf_options(&self) -> Option<MjcfOptions> {
        self.0.mjcf_options()
    }

    fn controller(&self, parameters: &[f32]) -> Option<ControllerExport> {
        self.controller_of(0, parameters)
    }

    fn controller_of(&self, population: usize, parameters: &[f32]) -> Option<ControllerExport> {
        let Agents { document, spec, groups, .. } = self.0.agents();
        let [robot, _] = *groups.ranges().get(population)?;
        let mut network = spec.network.clone();
        if !network.load(spec.searched.clone().all(parameters)?) {
            return None;
        }
        let network = network.part().export()?;
        let (sensors, motors) = (self.sensors(robot), self.motors(robot));
        Some(ControllerExport::new(network, sensors, motors, document.world.time_step, document.episode.steps))
    }
}

impl<E: Body> ComposedTask<E> {
    /// Adds the quantity of each sensor and motor to a schema. Some are also labels of channels, unless the document
    /// names them.
    fn explained(&self, mut schema: Schema) -> Schema {
        let document = &self.0.agents().document;
        let named = |channels: &Option<Vec<String>>, quantity: Quantity| Quantity {
            is_label: quantity.is_label && channels.is_none(),
            ..quantity
        };
        let sensors = document.sensors.iter().filter(|sensor| sensor.enabled).zip(self.sensed(0));
        let sensors = sensors.flat_map(|(sensor, read)| read.into_iter().map(|read| named(&sensor.channels, read)));
        let motors = document.motors.iter().filter(|motor| motor.enabled).zip(self.driven(0));
        let motors = motors.flat_map(|(motor, driven)| driven.into_iter().map(|driven| named(&motor.channels, driven)));
        let channels = schema.sensors.iter_mut().chain(&mut schema.outputs);
        for (channel, quantity) in channels.zip(sensors.chain(motors)) {
            if quantity.is_label {
                channel.label.clone_from(&quantity.text);
            }
            channel.about = quantity.text;
        }
        schema
    }

    /// Describes the channels of each sensor of a robot.
    fn sensed(&self, robot: usize) -> Vec<Vec<Quantity>> {
        let Agents { document, spec, registry, .. } = self.0.agents();
        let part = |sensor: &Sensor| -> (Option<Describe>, String) {
            let part = registry.sensor(&sensor.kind);
            let describe =
                part.map(|part| -> Describe { Box::new(move |channel, scene| part.quantity(channel, scene)) });
            (describe, changes(sensor.wrappers.iter(), registry))
        };
        let enabled = document.sensors.iter().filter(|sensor| sensor.enabled);
        self.described(robot, &enabled.map(part).collect::<Vec<_>>(), &spec.sensors)
    }

    /// Describes the channels of each motor of a robot.
    fn driven(&self, robot: usize) -> Vec<Vec<Quantity>> {
        let Agents { document, spec, registry, .. } = self.0.agents();
        let part = |motor: &Motor| -> (Option<Describe>, String) {
            let part = registry.motor(&motor.kind);
            let describe =
                part.map(|part| -> Describe { Box::new(move |channel, scene| part.quantity(channel, scene)) });
            (describe, changes(motor.wrappers.iter().rev(), registry))
        };
        let enabled = document.motors.iter().filter(|motor| motor.enabled);
        self.described(robot, &enabled.map(part).collect::<Vec<_>>(), &spec.motors)
    }

    /// Describes the channels of parts with their changes by wrappers.
    fn described(&self, robot: usize, parts: &[(Option<Describe>, String)], spans: &Spans) -> Vec<Vec<Quantity>> {
        let mut all = Vec::new();
        self.0.in_scene(robot, &mut |scene| {
            all = parts
                .iter()
                .zip(spans)
                .map(|((describe, changes), (_, [first, end]))| {
                    let quantity =
                        |channel| describe.as_ref().map(|describe| describe(channel, scene)).unwrap_or_default();
                    (0..end - first).map(|channel| quantity(channel).with(changes)).collect()
                })
                .collect();
        });
        all
    }

    fn sensors(&self, robot: usize) -> Vec<SensorExport> {
        let channel =
            |(name, Quantity { text, unit, ends: [zero, one], is_linear, .. }): (&String, Quantity)| SensorExport {
                name: name.clone(),
                reads: SensorReading::Quantity { quantity: text, unit, zero, one, linear: is_linear },
            };
        self.0.agents().spec.inputs.iter().zip(self.sensed(robot).into_iter().flatten()).map(channel).collect()
    }

    fn motors(&self, robot: usize) -> Vec<MotorExport> {
        let channel = |(name, Quantity { text, unit, ends: [zero, one], .. }): (&String, Quantity)| MotorExport {
            name: name.clone(),
            drives: MotorDrive::Quantity { quantity: text, unit, zero, one },
        };
        self.0.agents().spec.outputs.iter().zip(self.driven(robot).into_iter().flatten()).map(channel).collect()
    }
}
