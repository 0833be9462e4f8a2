//! A network of any kind as plain data: a layout and parameters.

use farsa_nn::block::{Block, BlockLayoutBuf, BlockParameter, Group};
use farsa_nn::bytes::{BlockNetworkBytes, BytesError, CtrnnBytes, LeakyNetworkBytes, PerceptronBytes};
use farsa_nn::{CtrnnLayout, CtrnnParts, Leak, LeakyLayout, LeakyParts};
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::{Value, json};

/// A network with its parameters, in the order of its layout.
///
/// Written as JSON, it contains everything that another program needs to compute the same numbers. This includes the
/// shape, and named tables of parameters. All variants have a `kind` in JSON, except for the leaky network.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NetworkExport {
    /// [`farsa_nn::LeakyNetwork`], with one hidden layer.
    ///
    /// Its slope s is that of sigma(x) = 1 / (1 + exp(-s x)). The leak d, with y = sigma(net), has three readings.
    /// `filter` is H = d y + (1-d) H(t-1), `two-tap` is d y + (1-d) y(t-1), and `evonet` is d H(t-1) + (1-d) y.
    Leaky {
        /// Layout of the network.
        layout: LeakyLayout,
        /// Interpretation of the leak.
        leak: Leak,
        /// Parameters in the order of the layout.
        parameters: Vec<f32>,
    },
    /// [`farsa_nn::Perceptron`], one layer without memory.
    Perceptron {
        /// Number of inputs.
        inputs: usize,
        /// Number of outputs.
        outputs: usize,
        /// Slope of the logistic function.
        slope: f32,
        /// Parameters in the order of the layout.
        parameters: Vec<f32>,
    },
    /// [`farsa_nn::Ctrnn`], in continuous time.
    Ctrnn {
        /// Layout of the network.
        layout: CtrnnLayout,
        /// Time step \[s\].
        time_step: f32,
        /// Parameters in the order of the layout.
        parameters: Vec<f32>,
    },
    /// [`farsa_nn::block::BlockNetwork`], of any connections between groups of neurons.
    Blocks {
        /// Layout with all groups and blocks.
        layout: BlockLayoutBuf,
        /// Interpretation of the leak.
        leak: Leak,
        /// Parameters in the order of the layout.
        parameters: Vec<f32>,
    },
}

/// A table of parameters: its name, its shape, source by source, and its numbers.
pub(crate) type Table<'a> = (&'static str, Vec<usize>, &'a [f32]);

impl NetworkExport {
    /// Creates the export of a leaky network.
    pub fn leaky(layout: &LeakyLayout, leak: Leak, parameters: &[f32]) -> Self {
        Self::Leaky { layout: *layout, leak, parameters: parameters.into() }
    }

    /// Gets the number of inputs and outputs.
    pub fn shape(&self) -> [usize; 2] {
        match self {
            Self::Leaky { layout, .. } => [layout.sensors(), layout.outputs()],
            Self::Perceptron { inputs, outputs, .. } => [*inputs, *outputs],
            Self::Ctrnn { layout, .. } => [layout.inputs(), layout.outputs()],
            Self::Blocks { layout, .. } => [layout.inputs, layout.outputs],
        }
    }

    /// Gets the parameters in the order of the layout.
    pub fn parameters(&self) -> &[f32] {
        match self {
            Self::Leaky { parameters, .. }
            | Self::Perceptron { parameters, .. }
            | Self::Ctrnn { parameters, .. }
            | Self::Blocks { parameters, .. } => parameters,
        }
    }

    /// Writes the network in the binary format of `farsa-nn` (docs/controller-format.md). It includes the given hash
    /// of the channels.
    ///
    /// # Errors
    /// Returns [`BytesError::Parameters`] if the parameters do not fit the network.
    pub fn bytes(&self, channels: u64) -> Result<Vec<u8>, BytesError> {
        let mut bytes;
        match self {
            Self::Leaky { layout, leak, parameters } => {
                bytes = vec![0; LeakyNetworkBytes::byte_count(*layout)];
                LeakyNetworkBytes::write(*layout, *leak, channels, parameters, &mut bytes)?;
            }
            &Self::Perceptron { inputs, outputs, slope, ref parameters } => {
                bytes = vec![0; PerceptronBytes::byte_count(inputs, outputs)];
                PerceptronBytes::write(inputs, outputs, slope, channels, parameters, &mut bytes)?;
            }
            Self::Ctrnn { layout, time_step, parameters } => {
                bytes = vec![0; CtrnnBytes::byte_count(*layout)];
                CtrnnBytes::write(*layout, *time_step, channels, parameters, &mut bytes)?;
            }
            Self::Blocks { layout, leak, parameters } => {
                let layout = layout.layout();
                bytes = vec![0; BlockNetworkBytes::byte_count(&layout)];
                BlockNetworkBytes::write(layout, *leak, channels, parameters, &mut bytes)?;
            }
        }
        Ok(bytes)
    }

    /// Gets the parameters as tables, which lie one after the other in them.
    pub(crate) fn tables(&self) -> Vec<Table<'_>> {
        match self {
            Self::Leaky { layout, parameters, .. } => {
                let [inputs, hidden, outputs] = [layout.sensors(), layout.hidden(), layout.outputs()];
                let LeakyParts { sensor_weights, recurrent_weights, output_weights, biases, leaks, .. } =
                    layout.split(parameters);
                vec![
                    ("sensor_weights", vec![inputs, hidden], sensor_weights),
                    ("recurrent_weights", vec![hidden, hidden], recurrent_weights),
                    ("output_weights", vec![hidden, outputs], output_weights),
                    ("biases", vec![hidden], biases),
                    ("leaks", vec![hidden], leaks),
                ]
            }
            Self::Perceptron { inputs, outputs, parameters, .. } => {
                let (weights, biases) = parameters.split_at((inputs * outputs).min(parameters.len()));
                vec![("weights", vec![*inputs, *outputs], weights), ("biases", vec![*outputs], biases)]
            }
            Self::Ctrnn { layout, parameters, .. } => {
                let neurons = layout.neurons();
                let CtrnnParts { input_weights, weights, biases, gains, time_constants, .. } = layout.split(parameters);
                vec![
                    ("input_weights", vec![input_weights.len() / neurons.max(1), neurons], input_weights),
                    ("weights", vec![neurons, neurons], weights),
                    ("biases", vec![neurons], biases),
                    ("gains", vec![neurons], gains),
                    ("time_constants", vec![neurons], time_constants),
                ]
            }
            Self::Blocks { layout, parameters, .. } => {
                let names = ["weights", "biases", "gains", "leaks"];
                let parts = BlockParameter::ALL.map(|kind| parameters.get(layout.layout().range(kind)).unwrap_or(&[]));
                names.into_iter().zip(parts).map(|(name, part)| (name, vec![part.len()], part)).collect()
            }
        }
    }

    /// Describes the numbers of each table in the order of all parameters. Weights of blocks are listed block by block.
    fn order(&self) -> Value {
        let mut first = 0;
        let mut entry = |name: &str, shape: &[usize], meaning: String| {
            let entry = json!({"name": name, "first": first, "shape": shape, "meaning": meaning});
            first += shape.iter().product::<usize>();
            entry
        };
        let mut entries = Vec::new();
        for (name, shape, _) in self.tables() {
            match self {
                Self::Blocks { layout, .. } if name == "weights" => {
                    for (index, block) in layout.blocks.iter().enumerate() {
                        let Block::Connect { from, to, .. } = block else { continue };
                        let (source, target) = (from.first, to.first);
                        let meaning =
                            format!("blocks[{index}]: row j, column i from neuron {source} + j to neuron {target} + i");
                        entries.push(entry(name, &[from.count, to.count], meaning));
                    }
                }
                _ => entries.push(entry(name, &shape, meaning(self, name).into())),
            }
        }
        entries.into()
    }

    /// Lists everything except the tables, by name.
    fn facts(&self) -> Vec<(&'static str, Fact)> {
        match self {
            Self::Leaky { layout, leak, .. } => vec![
                ("inputs", layout.sensors().into()),
                ("hidden", layout.hidden().into()),
                ("outputs", layout.outputs().into()),
                ("slope", Fact::Real(layout.slope())),
                ("leak", leak.name().into()),
            ],
            &Self::Perceptron { inputs, outputs, slope, .. } => vec![
                ("kind", "perceptron".into()),
                ("inputs", inputs.into()),
                ("outputs", outputs.into()),
                ("slope", Fact::Real(slope)),
            ],
            Self::Ctrnn { layout, time_step, .. } => vec![
                ("kind", "ctrnn".into()),
                ("inputs", layout.inputs().into()),
                ("neurons", layout.neurons().into()),
                ("outputs", layout.outputs().into()),
                ("first_direct_input", Fact::Other(json!(layout.direct_inputs().map(|neurons| neurons.start)))),
                ("first_output", layout.output_neurons().start.into()),
                ("integrator", layout.integrator().name().into()),
                ("activation", layout.activation().name().into()),
                ("time_step", Fact::Real(*time_step)),
            ],
            Self::Blocks { layout, leak, .. } => vec![
                ("kind", "blocks".into()),
                ("inputs", layout.inputs.into()),
                ("outputs", layout.outputs.into()),
                ("leak", leak.name().into()),
                ("groups", Fact::Other(layout.groups.iter().map(group).collect())),
                ("blocks", Fact::Other(layout.blocks.iter().map(block).collect())),
            ],
        }
    }
}

/// Describes the rows and columns of a table.
fn meaning(network: &NetworkExport, table: &str) -> &'static str {
    match (network, table) {
        (_, "sensor_weights") => "row j, column i: from sensor j to hidden neuron i",
        (_, "recurrent_weights") => "row j, column i: from hidden neuron j in the previous step to hidden neuron i",
        (_, "output_weights") => "row j, column i: from hidden neuron j to output i",
        (_, "input_weights") => "row j, column i: from input j to neuron i",
        (NetworkExport::Perceptron { .. }, "weights") => "row j, column i: from input j to output i",
        (_, "weights") => "row j, column i: from neuron j to neuron i",
        (NetworkExport::Leaky { .. }, "biases") => "hidden neuron i: first term of its net input",
        (NetworkExport::Leaky { .. }, _) => "hidden neuron i: share d of `leak`",
        (NetworkExport::Perceptron { .. }, _) => "output i: first term of its net input",
        (NetworkExport::Ctrnn { .. }, "biases") => "neuron i: added to its state",
        (NetworkExport::Ctrnn { .. }, "gains") => "neuron i: factor of state plus bias",
        (NetworkExport::Ctrnn { .. }, _) => "neuron i: time constant [s]",
        (NetworkExport::Blocks { .. }, "biases") => "neurons of the groups with `bias`: first term of the net input",
        (NetworkExport::Blocks { .. }, "gains") => "neurons of the groups with `gain`: factor of sent activations",
        (NetworkExport::Blocks { .. }, _) => "neurons of the groups with `leak`: share d of `leak`",
    }
}

/// A value of [`NetworkExport::facts`].
enum Fact {
    /// With the digits that single precision needs.
    Real(f32),
    Other(Value),
}

impl From<usize> for Fact {
    fn from(count: usize) -> Self {
        Self::Other(count.into())
    }
}

impl From<&str> for Fact {
    fn from(word: &str) -> Self {
        Self::Other(word.into())
    }
}

impl Serialize for Fact {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Real(real) => real.serialize(serializer),
            Self::Other(value) => value.serialize(serializer),
        }
    }
}

impl Serialize for NetworkExport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (name, fact) in self.facts() {
            map.serialize_entry(name, &fact)?;
        }
        map.serialize_entry("parameters", &self.order())?;
        for (name, _, table) in self.tables() {
            map.serialize_entry(name, table)?;
        }
        map.end()
    }
}

fn group(group: &Group) -> Value {
    let Group { neurons, activation, slope, bias, gain, leak } = *group;
    // The shortest digits of single precision, as in the other kinds.
    let slope = slope.to_string().parse::<f64>().unwrap_or(f64::from(slope));
    json!({"neurons": neurons, "activation": activation.name(), "slope": slope, "bias": bias, "gain": gain, "leak": leak})
}

/// Describes a block by its effect. Spans are \[first neuron, neurons\].
fn block(block: &Block) -> Value {
    match *block {
        Block::Connect { from, to, delay } => {
            json!({"connect": {"from": [from.first, from.count], "to": [to.first, to.count], "delay": delay}})
        }
        Block::Update(span) => json!({"update": [span.first, span.count]}),
        Block::Gain(span) => json!({"gain": [span.first, span.count]}),
        Block::ModulatedGain { neurons, by } => {
            json!({"modulated-gain": {"neurons": [neurons.first, neurons.count], "by": by}})
        }
        _ => Value::Null,
    }
}
