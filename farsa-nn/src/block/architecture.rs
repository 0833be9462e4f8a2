//! Common network architectures.

use crate::activation::Activation;
use crate::block::description::{Block, Group, Span};
use crate::block::layout::BlockLayout;

/// A named architecture that defines the connections between inputs, hidden neurons and outputs. It can be modified by
/// the methods of this type.
///
/// By default, neurons are logistic with a slope of 1. They have biases, but no gains and leaks.
///
/// ```
/// use farsa_nn::block::{Architecture, BlockPlan};
/// use farsa_nn::LeakyLayout;
///
/// // The network of the manipulation experiment.
/// const PLAN: BlockPlan = Architecture::elman(29, 12, 23).with_slope(0.2).with_leaks().without_output_biases().plan();
/// assert_eq!(PLAN.layout().parameter_count(), LeakyLayout::new(29, 12, 23).parameter_count());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::struct_excessive_bools, reason = "each is a connection that is there or is not")]
pub struct Architecture {
    inputs: usize,
    hidden: Group,
    outputs: Group,
    delay: usize,
    among_hidden: bool,
    outputs_to_hidden: bool,
    among_outputs: bool,
    inputs_to_outputs: bool,
    /// Joins hidden neurons and outputs in one layer.
    together: bool,
}

/// The groups and blocks of an [`Architecture`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockPlan {
    inputs: usize,
    outputs: usize,
    groups: [Group; 3],
    blocks: [Block; BlockPlan::MOST],
    count: usize,
}

impl Architecture {
    /// Creates a feed-forward network without memory. If there are no hidden neurons, the inputs are connected to the
    /// outputs.
    pub const fn feed_forward(inputs: usize, hidden: usize, outputs: usize) -> Self {
        Self {
            inputs,
            hidden: Group::new(hidden, Activation::Logistic).with_biases(),
            outputs: Group::new(outputs, Activation::Logistic).with_biases(),
            delay: 0,
            among_hidden: false,
            outputs_to_hidden: false,
            among_outputs: false,
            inputs_to_outputs: hidden == 0,
            together: false,
        }
    }

    /// Creates an Elman network. This is a feed-forward network with additional connections among the hidden neurons,
    /// which use the activations of the previous step (`[Elman1990]`).
    pub const fn elman(inputs: usize, hidden: usize, outputs: usize) -> Self {
        Self { among_hidden: true, ..Self::feed_forward(inputs, hidden, outputs) }
    }

    /// Creates a Jordan network. This is a feed-forward network with additional connections from the outputs of the
    /// previous step to the hidden neurons (`[Jordan1986]`).
    ///
    /// Deviation: the context units of the source also keep a share of their previous value. Here they contain only the
    /// outputs.
    pub const fn jordan(inputs: usize, hidden: usize, outputs: usize) -> Self {
        Self { outputs_to_hidden: true, ..Self::feed_forward(inputs, hidden, outputs) }
    }

    /// Creates a fully recurrent network. It has a single layer of hidden neurons and outputs. This layer receives the
    /// inputs and the activations of the layer in the previous step.
    pub const fn fully_recurrent(inputs: usize, hidden: usize, outputs: usize) -> Self {
        Self { together: true, ..Self::feed_forward(inputs, hidden, outputs) }
    }

    /// Adds direct connections from the inputs to the outputs.
    pub const fn with_inputs_to_outputs(self) -> Self {
        Self { inputs_to_outputs: true, ..self }
    }

    /// Adds connections among the outputs. They use the activations of the previous step.
    pub const fn with_recurrent_outputs(self) -> Self {
        Self { among_outputs: true, ..self }
    }

    /// Sets the activation functions of the hidden neurons and of the outputs.
    pub const fn with_activations(self, hidden: Activation, outputs: Activation) -> Self {
        Self {
            hidden: Group { activation: hidden, ..self.hidden },
            outputs: Group { activation: outputs, ..self.outputs },
            ..self
        }
    }

    /// Sets the slope of the hidden neurons and of the outputs.
    pub const fn with_slope(self, slope: f32) -> Self {
        Self { hidden: self.hidden.with_slope(slope), outputs: self.outputs.with_slope(slope), ..self }
    }

    /// Adds leaks to the hidden neurons.
    pub const fn with_leaks(self) -> Self {
        Self { hidden: self.hidden.with_leaks(), ..self }
    }

    /// Adds leaks to the outputs.
    pub const fn with_output_leaks(self) -> Self {
        Self { outputs: self.outputs.with_leaks(), ..self }
    }

    /// Adds gains to the hidden neurons.
    pub const fn with_gains(self) -> Self {
        Self { hidden: self.hidden.with_gains(), ..self }
    }

    /// Removes the biases of the outputs.
    pub const fn without_output_biases(self) -> Self {
        Self { outputs: Group { bias: false, ..self.outputs }, ..self }
    }

    /// Removes the biases of the hidden neurons.
    pub const fn without_hidden_biases(self) -> Self {
        Self { hidden: Group { bias: false, ..self.hidden }, ..self }
    }

    /// Delays the inputs by the given number of steps.
    pub const fn with_input_delay(self, steps: usize) -> Self {
        Self { delay: steps, ..self }
    }

    /// Creates the groups and blocks of the network, in the same order as the original program.
    pub const fn plan(&self) -> BlockPlan {
        let inputs = Span::new(0, self.inputs);
        let hidden = Span::new(inputs.end(), self.hidden.neurons);
        let outputs = Span::new(hidden.end(), self.outputs.neurons);
        let all = Span::new(inputs.end(), hidden.count.saturating_add(outputs.count));
        let groups = [Group::new(self.inputs, Activation::Linear), self.hidden, self.outputs];
        let empty = Block::Update(Span::new(0, 0));
        let plan = BlockPlan {
            inputs: self.inputs,
            outputs: outputs.count,
            groups,
            blocks: [empty; BlockPlan::MOST],
            count: 0,
        };
        let plan = plan.and(true, Block::Update(inputs));
        if self.together {
            return plan
                .and(true, Block::connect(inputs, all).delayed(self.delay))
                .and(true, Block::connect(all, all))
                .and(true, Block::Update(all));
        }
        let some = hidden.count > 0;
        plan.and(some, Block::connect(inputs, hidden).delayed(self.delay))
            .and(some && self.among_hidden, Block::connect(hidden, hidden))
            .and(some && self.outputs_to_hidden, Block::connect(outputs, hidden))
            .and(some, Block::Update(hidden))
            .and(self.inputs_to_outputs, Block::connect(inputs, outputs).delayed(self.delay))
            .and(some, Block::connect(hidden, outputs))
            .and(self.among_outputs, Block::connect(outputs, outputs))
            .and(true, Block::Update(outputs))
    }
}

impl BlockPlan {
    /// The largest number of blocks of an architecture.
    const MOST: usize = 9;

    /// Returns a layout that borrows the groups and blocks.
    pub const fn layout(&self) -> BlockLayout<'_> {
        BlockLayout::new(self.inputs, self.outputs, &self.groups, self.blocks.split_at(self.count).0)
    }

    const fn and(mut self, wanted: bool, block: Block) -> Self {
        if wanted && self.count < Self::MOST {
            self.blocks[self.count] = block;
            self.count += 1;
        }
        self
    }
}
