//! What can be wrong with a network before it takes its first step.

use core::fmt;

/// Why a network could not be built, or given other parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The parameter slice has another length than the layout's parameter count.
    ParameterCount {
        /// Length the layout asks for.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
    /// The state slice has another length than the layout's state.
    StateLen {
        /// Length the layout asks for.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
    /// A parameter is NaN or infinite.
    NotFinite {
        /// Its place among the parameters.
        index: usize,
    },
    /// A leak lies outside [0, 1].
    LeakRange {
        /// Its place among the parameters.
        index: usize,
        /// Its value.
        value: f32,
    },
    /// The slope of the logistic function is NaN or infinite.
    Slope {
        /// Its value.
        value: f32,
    },
    /// A demonstration's sensor values and wanted motor values are not those of so many whole ticks.
    Demonstration {
        /// Number of sensor values.
        values: usize,
        /// Sensors of the layout.
        sensors: usize,
        /// Number of wanted motor values.
        wanted: usize,
        /// Outputs of the layout.
        outputs: usize,
    },
    /// Integers of a fixed-point network are to have so many fraction bits.
    FractionBits {
        /// Which integers: inputs, weights or sums.
        of: &'static str,
        /// The number of fraction bits.
        found: u32,
        /// The fewest there may be.
        least: u32,
        /// The most there may be.
        most: u32,
    },
    /// A weight is too large for a fixed-point network, even without fraction bits.
    WeightRange {
        /// Its place among the parameters.
        index: usize,
        /// Its value times the slope.
        value: f64,
    },
    /// A sum of a fixed-point network could leave 32 bits.
    SumRange {
        /// The target: hidden neurons first, then outputs.
        target: usize,
        /// The largest magnitude that the sum can have, in its units.
        largest: u64,
        /// The largest that it may have.
        limit: u64,
    },
    /// No reading of the leak has this name.
    UnknownLeak,
    /// A time step is not a finite number above zero.
    TimeStep {
        /// Its value [s].
        value: f32,
    },
    /// A time constant is not above zero, or so short that the integrator diverges.
    TimeConstant {
        /// Its place among the parameters.
        index: usize,
        /// Its value [s].
        value: f32,
        /// The smallest with which the integrator is stable [s]; 0 if all above zero are.
        least: f32,
    },
    /// Neurons are named that the layout does not have.
    Neurons {
        /// The first of them.
        first: usize,
        /// How many there are.
        count: usize,
        /// Number of neurons.
        neurons: usize,
    },
    /// A block names neurons that the layout does not have.
    Block {
        /// The block's place among the blocks.
        index: usize,
        /// The first of the neurons.
        first: usize,
        /// How many there are.
        count: usize,
        /// Number of neurons.
        neurons: usize,
    },
    /// A state is NaN or infinite.
    StateNotFinite {
        /// The number of its neuron.
        index: usize,
    },
    /// A parameter has no value, because evolution draws it.
    NoValue {
        /// Its place among the parameters of the text.
        index: usize,
    },
    /// There are other mirror images than inputs or neurons.
    MirrorLen {
        /// Number of inputs or neurons.
        expected: usize,
        /// Number of mirror images.
        found: usize,
    },
    /// The mirror image of an input or of a neuron is not there, or has another mirror image.
    Mirror {
        /// The number of the input or neuron.
        index: usize,
        /// Its mirror image.
        image: usize,
    },
    /// Neurons are to be alike that are so with others already, or whose mirror images are not alike.
    Alike {
        /// The first of them.
        first: usize,
        /// How many there are.
        count: usize,
    },
    /// A line of a text is not what it should be.
    Text {
        /// Its number; the first is 1.
        line: usize,
        /// What should stand there.
        expected: &'static str,
    },
    /// No integrator has this name.
    UnknownIntegrator,
    /// No activation function has this name.
    UnknownActivation,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::ParameterCount { expected, found } => write!(f, "{found} parameters where the layout has {expected}"),
            Self::StateLen { expected, found } => {
                write!(f, "a state of {found} values where the layout needs {expected}")
            }
            Self::NotFinite { index } => write!(f, "parameter {index} is not finite"),
            Self::LeakRange { index, value } => write!(f, "parameter {index}, a leak, is {value}: outside [0, 1]"),
            Self::Slope { value } => write!(f, "the slope of the logistic function is {value}: not finite"),
            Self::Demonstration { values, sensors, wanted, outputs } => write!(
                f,
                "{values} sensor values and {wanted} wanted motor values: not whole ticks of {sensors} and {outputs}"
            ),
            Self::FractionBits { of, found, least, most } => {
                write!(f, "{found} fraction bits of {of}: outside [{least}, {most}]")
            }
            Self::WeightRange { index, value } => {
                write!(f, "parameter {index} times the slope is {value}: outside [-32767, 32767]")
            }
            Self::SumRange { target, largest, limit } => {
                write!(f, "the sum of target {target} can reach {largest} where {limit} is the most")
            }
            Self::UnknownLeak => f.write_str("unknown leak: one of filter, two-tap, evonet"),
            Self::TimeStep { value } => write!(f, "the time step is {value}: not a finite number above 0"),
            Self::TimeConstant { index, value, least } if value > 0.0 => write!(
                f,
                "parameter {index}, a time constant, is {value}: below {least}, where the integrator diverges at this time step"
            ),
            Self::TimeConstant { index, value, .. } => {
                write!(f, "parameter {index}, a time constant, is {value}: not above 0")
            }
            Self::Neurons { first, count, neurons } => {
                write!(f, "{count} neurons from neuron {first} on where the layout has {neurons}")
            }
            Self::Block { index, first, count, neurons } => write!(
                f,
                "block {index} has {count} neurons from neuron {first} on where the layout has {neurons} neurons"
            ),
            Self::StateNotFinite { index } => write!(f, "the state of neuron {index} is not finite"),
            Self::NoValue { index } => write!(f, "parameter {index} has no value: evolution draws it"),
            Self::MirrorLen { expected, found } => write!(f, "{found} mirror images where there are {expected}"),
            Self::Mirror { index, image } => {
                write!(f, "the mirror image of {index} is {image}, which is not there or has another mirror image")
            }
            Self::Alike { first, count } => write!(
                f,
                "{count} alike neurons from neuron {first} on: some are alike with others, or their mirror images are not alike"
            ),
            Self::Text { line, expected } => write!(f, "line {line}: expected {expected}"),
            Self::UnknownIntegrator => {
                f.write_str("unknown integrator: one of euler, exponential-euler, runge-kutta-4")
            }
            Self::UnknownActivation => {
                f.write_str("unknown activation: one of logistic, tanh, linear, step, rectified")
            }
        }
    }
}

impl core::error::Error for Error {}
