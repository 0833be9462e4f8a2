//! Controller of a robot: its sensors, a network, and its motors.

use std::ops::Range;

use farsa_body::ports::{BodyId, Channels, Contacts, Kinematics, Motor, Sensor};
use farsa_body::{Recorder, record_world};
use farsa_evo::ObservationStatistics;
use farsa_nn::{Controller as _, LeakyLayout};
use farsa_view::Schema;

use crate::error::Error;
use crate::experiment::anatomy::Anatomy;
use crate::experiment::evaluator::Evaluation;
use crate::experiment::interventions::Interventions;
use crate::experiment::network_parameters::{OwnedNetwork, network_parameters, resting_network};
use crate::experiment::normalized_controller::NormalizedController;
use crate::experiment::outcome::{ChannelGroup, Description};
use crate::experiment::parameter::Parameter;
use crate::experiment::protocol::Protocol;

/// Controller of a robot with sensors, a recurrent network and motors. To get an episode, you only need to add the
/// world and the reward.
///
/// Its network has a single hidden layer. All nodes are linked to all nodes ([`LeakyLayout`]). Leaks from 0 to 1 act
/// as filters, and are evolved together with weights and biases. The loop over the steps remains in your hands:
///
/// ```
/// use farsa_body::testing::PointWorld;
/// use farsa_body::motors::TorqueMotor;
/// use farsa_body::ports::{ActuatorId, JointId, World as _};
/// use farsa_body::sensors::JointPosition;
/// use farsa_lab::Neurocontroller;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let sensors = [0, 1].map(|joint| JointPosition::new(JointId(joint), -1.0, 1.0));
/// let sensors = sensors.into_iter().collect::<Result<Vec<_>, _>>()?;
/// let mut control = Neurocontroller::new(sensors, TorqueMotor::new(ActuatorId(0), 1.0)?, 3, 5.0)?;
/// let parameters = vec![1.0; control.parameters().len()]; // from evolution
/// let mut world = PointWorld::new(2);
/// control.load(&parameters);
/// for _ in 0..100 {
///     control.act(&mut world); // reads, computes, drives
///     world.step();
/// }
/// # assert!(control.done()[0] > 0.5);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Neurocontroller<S, M> {
    sensors: S,
    motors: M,
    layout: LeakyLayout,
    range: f64,
    network: NormalizedController<OwnedNetwork>,
    x: Vec<f32>,
    y: Vec<f32>,
    schema: Schema,
    /// Test protocols of any network.
    interventions: Interventions,
}

impl<S: Channels, M: Channels> Neurocontroller<S, M> {
    /// Creates a new controller with `hidden` hidden neurons between sensors and motors.
    ///
    /// Weights and biases range from `-range` to `range`.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the range is negative or not finite, or if there are no sensors or motors.
    pub fn new(sensors: S, motors: M, hidden: usize, range: f64) -> Result<Self, Error> {
        let (inputs, outputs) = (sensors.channels(), motors.channels());
        if inputs == 0 || outputs == 0 {
            return Err(Error::Other(format!("a network of {inputs} sensors and {outputs} motors")));
        }
        // Networks compute in f32, where a larger range is infinite.
        if !(0.0..=f64::from(f32::MAX)).contains(&range) {
            return Err(Error::Other(format!("weights within {range}")));
        }
        let layout = LeakyLayout::new(inputs, hidden, outputs);
        let network = NormalizedController::new(resting_network(&layout)?);
        let (x, y) = (vec![0.0; inputs], vec![0.0; outputs]);
        Ok(Self {
            sensors,
            motors,
            layout,
            range,
            network,
            x,
            y,
            schema: Schema::default(),
            interventions: Interventions::default(),
        }
        .with_schema(Schema::default()))
    }

    /// Gets all parameters of the network, together with their ranges.
    pub fn parameters(&self) -> Vec<Parameter> {
        network_parameters(&self.layout, self.range, [0.0, 1.0], "network.range").unwrap_or_default()
    }

    /// Gets the layout of the network.
    pub fn layout(&self) -> &LeakyLayout {
        &self.layout
    }

    /// Loads the parameters of the network. This also resets sensors, network and motors.
    ///
    /// If the number of parameters is wrong, this returns `false` and changes nothing.
    pub fn load(&mut self, parameters: &[f32]) -> bool {
        if self.network.controller_mut().copy_parameters(parameters).is_err() {
            return false;
        }
        self.reset();
        true
    }

    /// Loads the parameters of an evaluation. If the evaluation has statistics, observations are normalized.
    ///
    /// This returns `false` if the parameters or the statistics do not fit.
    pub fn load_evaluation(&mut self, evaluation: &Evaluation<'_>) -> bool {
        let change = self.interventions.applied(evaluation).into_owned();
        let loaded = self.network.load(evaluation.normalisation) && self.load(&change.edited(evaluation.parameters));
        self.network.intervene(&change, evaluation.id, 0);
        loaded
    }

    /// Gets the test protocols `lesions` and `noise`, which [`load_evaluation`](Self::load_evaluation) applies.
    ///
    /// The protocol `lesions` cuts each group of sensors of the [`schema`](Self::schema), and silences each hidden
    /// neuron. A sensor without a group is cut by itself. The protocol `noise` adds noise of up to 0.4 to every
    /// input.
    pub fn protocols(&self) -> Vec<Protocol> {
        self.interventions.protocols()
    }

    /// Gets the named parts that tests can change, which [`load_evaluation`](Self::load_evaluation) applies. Sensors
    /// can also be changed by the group names of the [`schema`](Self::schema).
    pub fn anatomy(&self) -> Anatomy {
        let sensors = groups(&self.schema).into_iter().map(|(group, inputs)| {
            // One that is in no group has its own name.
            let sensor = &self.schema.sensors[inputs.start].name;
            let name = if group.strip_prefix("sensor ") == Some(sensor) { sensor } else { &group };
            ChannelGroup::new(name, inputs.len(), "")
        });
        Anatomy::new(&self.schema, &Description { sensors: sensors.collect(), ..Description::default() })
    }

    /// Gets the statistics of all observations since [`load_evaluation`](Self::load_evaluation). This is `None`
    /// unless observations are normalized. Pass the result to [`Outcome::observed`](crate::Outcome::observed).
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.network.observed()
    }

    /// Resets sensors, network and motors, for example at the start of a trial.
    pub fn reset(&mut self) {
        self.sensors.reset();
        self.network.reset();
        self.motors.reset();
    }

    /// Reads the sensors, steps the network and drives the motors.
    ///
    /// Note that this does not step the world, so you have to do it afterwards.
    pub fn act<W>(&mut self, world: &mut W)
    where
        W: ?Sized,
        S: Sensor<W>,
        M: Motor<W>,
    {
        self.sensors.read(world, &mut self.x);
        self.network.step(&self.x, &mut self.y);
        self.motors.drive(&self.y, world);
    }

    /// Records the bodies of the schema and their contacts, and also the most recent values of sensors, neurons and
    /// outputs.
    ///
    /// This does not end the tick. Call [`Recorder::tick`] for this.
    pub fn record<W>(&self, world: &W, recorder: &mut dyn Recorder)
    where
        W: Kinematics<Body = BodyId> + Contacts + ?Sized,
    {
        record_world(world, self.schema.shown(), recorder);
        recorder.sensors(&self.x);
        recorder.neurons(self.network.controller().hidden());
        recorder.outputs(&self.y);
    }

    /// Records the parameters of the network. You need to do this once, before the first tick.
    pub fn record_parameters(&self, recorder: &mut dyn Recorder) {
        recorder.parameters(self.network.controller().parameters());
    }

    /// Replaces the schema, and adds the network to it. If sensors or outputs have no names, they are numbered from
    /// 1.
    #[must_use]
    pub fn with_schema(self, schema: Schema) -> Self {
        let numbered = |count: usize| (1..=count).map(|number| number.to_string()).collect::<Vec<_>>();
        let (inputs, outputs) = (self.x.len(), self.y.len());
        let schema = if schema.sensors.len() == inputs { schema } else { schema.with_sensors(numbered(inputs)) };
        let schema = if schema.outputs.len() == outputs { schema } else { schema.with_outputs(numbered(outputs)) };
        let mut schema = schema.with_network(&self.layout);
        schema.outputs.iter_mut().for_each(|output| output.range = Some([0.0, 1.0]));
        let interventions = interventions(&schema, self.layout.hidden());
        Self { schema, interventions, ..self }
    }

    /// Gets the schema for recordings.
    pub fn schema(&self) -> &Schema {
        &self.schema
    }

    /// Builds the description that `farsa info` prints. A trial takes `steps` steps of `step_seconds` \[s\] each.
    pub fn description(&self, steps: usize, step_seconds: f64) -> Description {
        let (inputs, outputs) = (self.x.len(), self.y.len());
        Description {
            sensors: vec![ChannelGroup::new("sensors", inputs, "inputs of the network")],
            motors: vec![ChannelGroup::new("motors", outputs, "outputs of the network, each 0 to 1")],
            network: format!("{inputs}-{}-{outputs}, recurrent hidden layer, leaks as filters", self.layout.hidden()),
            parameters: self.layout.parameter_count(),
            steps,
            step_seconds,
        }
    }

    /// Gets the sensor values of the last step \[sensors\].
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// Gets the outputs of the last step \[outputs\].
    pub fn done(&self) -> &[f32] {
        &self.y
    }

    /// Gets a mutable reference to the sensors. This is useful to set the noise of a trial, for example.
    pub fn sensors_mut(&mut self) -> &mut S {
        &mut self.sensors
    }
}

/// Gets the sensors by their groups, those without one alone.
fn groups(schema: &Schema) -> Vec<(String, Range<usize>)> {
    let mut groups: Vec<(String, Range<usize>)> = Vec::new();
    for (number, sensor) in schema.sensors.iter().enumerate() {
        let grouped = !sensor.group.is_empty() && sensor.group != "sensor";
        match groups.last_mut() {
            Some((group, range)) if grouped && *group == sensor.group => range.end += 1,
            _ if grouped => groups.push((sensor.group.clone(), number..number + 1)),
            _ => groups.push((format!("sensor {}", sensor.name), number..number + 1)),
        }
    }
    groups
}

/// Builds the protocols of a network with these sensors and `hidden` hidden neurons.
fn interventions(schema: &Schema, hidden: usize) -> Interventions {
    let neurons = (0..hidden).map(|neuron| (format!("neuron {}", neuron + 1), neuron));
    Interventions::default().with_lesions(groups(schema), neurons).with_noise(&Interventions::NOISE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::motors::{Muscles, TorqueMotor};
    use farsa_body::ports::{ActuatorId, JointId, World as _};
    use farsa_body::sensors::{JointPosition, JointSpeed};
    use farsa_body::testing::PointWorld;
    use farsa_evo::words::{GeneRange, decode};
    use farsa_nn::{Leak, LeakyNetwork, LeakyParameter};
    use farsa_view::Recording;

    use crate::experiment::genotype::Genotype;

    type Senses = (JointPosition, JointSpeed);

    fn control(hidden: usize, range: f64) -> Result<Neurocontroller<Senses, TorqueMotor>, Error> {
        let sensors = (JointPosition::new(JointId(0), -1.0, 1.0)?, JointSpeed::new(JointId(0)));
        Neurocontroller::new(sensors, TorqueMotor::new(ActuatorId(0), 20.0)?, hidden, range)
    }

    #[test]
    fn it_is_the_loop_written_out() {
        let mut control = control(4, 3.0).unwrap();
        let genes: Vec<u16> = (0..control.parameters().len()).map(|gene| (gene * 9973 % 65536) as u16).collect();
        let decoded = Genotype::new(&control.parameters(), 16).decode(&genes).unwrap();

        // By hand: every kind of parameter by itself.
        let layout = LeakyLayout::new(2, 4, 1);
        let mut parameters = vec![0.0; layout.parameter_count()];
        for kind in LeakyParameter::ALL {
            let (part, [low, high]) =
                (layout.range(kind), if kind == LeakyParameter::Leak { [0.0, 1.0] } else { [-3.0, 3.0] });
            decode(&genes[part.clone()], &[GeneRange::new(part.len(), low, high).unwrap()], &mut parameters[part])
                .unwrap();
        }
        let mut network =
            LeakyNetwork::new(layout, Leak::Filter, &parameters[..], vec![0.0; layout.state_len()]).unwrap();
        let mut sensors = (JointPosition::new(JointId(0), -1.0, 1.0).unwrap(), JointSpeed::new(JointId(0)));
        let mut motor = TorqueMotor::new(ActuatorId(0), 20.0).unwrap();
        let (mut x, mut y) = ([0.0; 2], [0.0; 1]);

        // The second episode does not depend on the first.
        for _life in 0..2 {
            network.reset();
            control = control.with_schema(Schema { bodies: vec!["point".into()], ..Schema::from_scalars(["t"]) });
            assert_eq!(control.schema().columns()[1..4], ["sensor.1", "sensor.2", "neuron.1"]);
            let mut recording = Recording::new(control.schema().clone());
            assert!(control.load(&decoded));
            control.record_parameters(&mut recording);
            let (mut world, mut other) = (PointWorld::new(1), PointWorld::new(1));
            let mut rows = Vec::new();
            for tick in 0..50 {
                control.act(&mut world);
                control.record(&world, &mut recording);
                recording.scalars(&[0.0]);
                recording.tick(f64::from(tick));
                world.step();
                sensors.read(&other, &mut x);
                network.step(&x, &mut y);
                motor.drive(&y, &mut other);
                other.step();
                assert_eq!((control.sensed(), control.done()), (&x[..], &y[..]));
                rows.push([x[0], x[1], y[0]].map(f64::from));
            }
            assert_eq!(recording.controller_parameters(), parameters);
            for (tick, [position, speed, output]) in rows.into_iter().enumerate() {
                let row: Vec<f64> = recording.row(tick).collect();
                assert_eq!((row[1], row[2], row[7]), (position, speed, output));
            }
        }
        assert!(x[1] != 0.0, "nothing moved");
    }

    #[test]
    fn what_cannot_be_is_refused() {
        assert_eq!(control(4, 3.0).unwrap().parameters().len(), 36);
        assert!(!control(4, 3.0).unwrap().load(&[0.0; 3]));
        for (range, text) in [(-1.0, "weights within -1"), (f64::NAN, "weights within NaN")] {
            assert_eq!(control(4, range).unwrap_err().to_string(), text);
        }
        let none = Neurocontroller::new(Vec::<JointSpeed>::new(), Muscles::new(ActuatorId(0)), 1, 1.0);
        assert_eq!(none.unwrap_err().to_string(), "a network of 0 sensors and 2 motors");
    }
}
