//! Task of an experiment from a file, in any world.

use farsa_body::Recorder;
use farsa_body::robot::Robot;
use farsa_lab::advanced::{Behavior, Learner, Rollout};
use farsa_lab::exports::{
    ControllerExport, Exports, MotorDrive, MotorExport, NetworkExport, SensorExport, SensorReading,
};
use farsa_lab::{Episode, EpisodeId, Evaluation, Outcome, Task, TaskInfo};
use farsa_models::mjcf::MjcfOptions;
use farsa_nn::{Controller as _, Leak};
use farsa_view::{Channel, Schema};

use crate::document::{MotorKind, SensorKind};
use crate::parts::agents::Agents;
use crate::parts::channel_quantity::ChannelQuantity;
use crate::parts::evonet::EvonetNetwork;
use crate::parts::network::AnyNetwork;

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

    /// Describes the quantity of a sensor channel.
    fn sensed(&self, kind: &SensorKind, channel: usize, robot: usize) -> ChannelQuantity;

    /// Describes the quantity of a motor channel.
    fn driven(&self, kind: &MotorKind, channel: usize, robot: usize) -> ChannelQuantity;
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
        let network = exported(&network, document.world.time_step)?;
        let (sensors, motors) = (self.sensors(robot), self.motors(robot));
        Some(ControllerExport::new(network, sensors, motors, document.world.time_step, document.episode.steps))
    }
}

impl<E: Body> ComposedTask<E> {
    /// Adds the quantity of each sensor and motor to a schema. It is also the label of a joint's channel, unless the
    /// document names it.
    fn explained(&self, mut schema: Schema) -> Schema {
        let Agents { document, spec, .. } = self.0.agents();
        let sensors = document.sensors.iter().filter(|sensor| sensor.enabled).map(|sensor| {
            let of_joint = matches!(sensor.kind, SensorKind::JointPosition { .. } | SensorKind::JointSpeed { .. });
            of_joint && sensor.channels.is_none()
        });
        let motors = document.motors.iter().filter(|motor| motor.enabled).map(|motor| {
            use MotorKind::{JointTorque, JointVelocity, Muscles, Servo};
            let of_joint =
                matches!(motor.kind, JointVelocity { .. } | JointTorque { .. } | Servo { .. } | Muscles { .. });
            of_joint && motor.channels.is_none()
        });
        let each = |labelled: bool, [first, end]: [usize; 2]| std::iter::repeat_n(labelled, end - first);
        let of_sensors = sensors.zip(&spec.sensors).flat_map(|(labelled, (_, span))| each(labelled, *span));
        let of_motors = motors.zip(&spec.motors).flat_map(|(labelled, (_, span))| each(labelled, *span));
        let read = self.sensors(0).into_iter().map(|sensor| match sensor.reads {
            SensorReading::Quantity { quantity, .. } => quantity,
            _ => String::new(),
        });
        let driven = self.motors(0).into_iter().map(|motor| match motor.drives {
            MotorDrive::Quantity { quantity, .. } => quantity,
            _ => String::new(),
        });
        let channels = schema.sensors.iter_mut().chain(&mut schema.outputs);
        for ((channel, quantity), labelled) in channels.zip(read.chain(driven)).zip(of_sensors.chain(of_motors)) {
            if labelled {
                channel.label.clone_from(&quantity);
            }
            channel.about = quantity;
        }
        schema
    }

    fn sensors(&self, robot: usize) -> Vec<SensorExport> {
        let Agents { document, spec, registry, .. } = self.0.agents();
        let sensed = |kind: &SensorKind, channel| match kind {
            SensorKind::Registered { kind, keys } => ChannelQuantity::registered(registry, kind, keys, channel),
            kind => self.0.sensed(kind, channel, robot),
        };
        let enabled = document.sensors.iter().filter(|sensor| sensor.enabled).zip(&spec.sensors);
        let meanings = enabled.flat_map(|(sensor, (_, [first, end]))| {
            (0..end - first)
                .map(move |channel| sensed(&sensor.kind, channel).with_wrappers(sensor.wrappers.iter(), registry))
        });
        let channel =
            |(name, ChannelQuantity { quantity, unit, ends: [zero, one], linear }): (&String, ChannelQuantity)| {
                SensorExport {
                    name: name.clone(),
                    reads: SensorReading::Quantity { quantity, unit, zero, one, linear },
                }
            };
        spec.inputs.iter().zip(meanings).map(channel).collect()
    }

    fn motors(&self, robot: usize) -> Vec<MotorExport> {
        let Agents { document, spec, registry, .. } = self.0.agents();
        let driven = |kind: &MotorKind, channel| match kind {
            MotorKind::Registered { kind, keys } => ChannelQuantity::registered(registry, kind, keys, channel),
            kind => self.0.driven(kind, channel, robot),
        };
        let enabled = document.motors.iter().filter(|motor| motor.enabled).zip(&spec.motors);
        let meanings = enabled.flat_map(|(motor, (_, [first, end]))| {
            (0..end - first)
                .map(move |channel| driven(&motor.kind, channel).with_wrappers(motor.wrappers.iter().rev(), registry))
        });
        let channel =
            |(name, ChannelQuantity { quantity, unit, ends: [zero, one], .. }): (&String, ChannelQuantity)| {
                MotorExport { name: name.clone(), drives: MotorDrive::Quantity { quantity, unit, zero, one } }
            };
        spec.outputs.iter().zip(meanings).map(channel).collect()
    }
}

/// Builds the export of a network.
fn exported(network: &AnyNetwork, time_step: f64) -> Option<NetworkExport> {
    let parameters = network.own_parameters().to_vec();
    let [inputs, outputs] = [network.inputs(), network.outputs()];
    Some(match network {
        AnyNetwork::Perceptron(layer, _) => {
            NetworkExport::Perceptron { inputs, outputs, slope: layer.slope(), parameters }
        }
        AnyNetwork::Leaky(leaky) => NetworkExport::leaky(&leaky.layout(), Leak::Filter, &parameters),
        AnyNetwork::Ctrnn(ctrnn) => {
            NetworkExport::Ctrnn { layout: ctrnn.layout(), time_step: time_step as f32, parameters }
        }
        AnyNetwork::Reflex(_) => return None,
        AnyNetwork::Registered(network) => network.export()?,
        AnyNetwork::HandWired(wired) => {
            NetworkExport::Perceptron { inputs, outputs, slope: 1.0, parameters: wired.as_layer()? }
        }
        AnyNetwork::Block(block) | AnyNetwork::Evonet(EvonetNetwork { network: block, .. }) => {
            NetworkExport::Blocks { layout: block.layout().into(), leak: block.leak(), parameters }
        }
    })
}
