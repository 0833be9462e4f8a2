//! A controller in the formats of boards and of Python: bytes, Rust source, tables.

use std::fmt::{self, Write as _};

use farsa_nn::Leak;
use farsa_nn::block::{Block, Group};
use safetensors::tensor::{Dtype, TensorView};
use serde_json::Value;

use crate::error::Error;
use crate::experiment::controller_export::{ControllerExport, MotorDrive, SensorReading};
use crate::experiment::network_export::NetworkExport;

/// Returns the bytes that `farsa-nn` reads.
pub(crate) fn bytes(controller: &ControllerExport) -> Result<Vec<u8>, Error> {
    controller.network.bytes(controller.channels()).map_err(other)
}

/// Returns a source file of constants for a program without files. `whose` names the champion.
pub(crate) fn rust(controller: &ControllerExport, whose: &str) -> Result<String, Error> {
    let mut text = String::new();
    let written = write!(
        text,
        "//! {whose}: written by `farsa export controller --format rust`.
{}
{}
/// The hash of the names below by `farsa_nn::bytes::channel_hash`.
pub const CHANNELS: u64 = {:#018x};

/// The names of the inputs.
#[rustfmt::skip]
pub const SENSORS: &[&str; {}] = &[
{}];

/// The names of the outputs.
#[rustfmt::skip]
pub const MOTORS: &[&str; {}] = &[
{}];

/// The parameters in the order of the layout.
#[rustfmt::skip]
pub const PARAMETERS: &[f32; {}] = &[
{}];
",
        Scaling(controller),
        Layout(&controller.network),
        controller.channels(),
        controller.sensors.len(),
        List(controller.sensors.iter().map(|sensor| &sensor.name)),
        controller.motors.len(),
        List(controller.motors.iter().map(|motor| &motor.name)),
        ParameterCount(&controller.network),
        List(controller.network.parameters().iter()),
    );
    written.map_err(|error| Error::Other(error.to_string()))?;
    Ok(text)
}

/// Returns safetensors, with `about` without its tables as the metadata `farsa`.
pub(crate) fn safetensors(controller: &ControllerExport, mut about: Value) -> Result<Vec<u8>, Error> {
    let tables = controller.network.tables();
    if let Some(network) = about.get_mut("network").and_then(Value::as_object_mut) {
        network.retain(|name, _| tables.iter().all(|(table, ..)| name != table));
    }
    let data: Vec<Vec<u8>> = tables.iter().map(|(.., table)| little_endian(table)).collect();
    let views = tables
        .into_iter()
        .zip(&data)
        .map(|((name, shape, _), data)| TensorView::new(Dtype::F32, shape, data).map(|view| (name, view)));
    let views: Vec<_> = views.collect::<Result<_, _>>().map_err(other)?;
    // One text, because several would be written in varying order.
    let metadata = [("farsa".to_owned(), about.to_string())].into_iter().collect();
    safetensors::serialize(views, Some(metadata)).map_err(other)
}

/// Channels with quantities, as a table of comments.
struct Scaling<'a>(&'a ControllerExport);

impl fmt::Display for Scaling<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sensors = self.0.sensors.iter().filter_map(|sensor| match &sensor.reads {
            SensorReading::Quantity { quantity, unit, zero, one, linear } => {
                let between = if *linear { "" } else { ", a curve between" };
                Some((&sensor.name, format!("reads {quantity} [{unit}]: 0 at {zero}, 1 at {one}{between}")))
            }
            SensorReading::PreviousOutput { channel, scale } => Some((
                &sensor.name,
                format!("reads output {channel} of the previous step, times {scale}, and 0 in the first step"),
            )),
            _ => None,
        });
        let motors = self.0.motors.iter().filter_map(|motor| match &motor.drives {
            MotorDrive::Quantity { quantity, unit, zero, one } => {
                Some((&motor.name, format!("drives {quantity} [{unit}]: {zero} at 0, {one} at 1")))
            }
            MotorDrive::NextInput { channel } => Some((&motor.name, format!("is input {channel} of the next step"))),
            _ => None,
        });
        for (number, (name, what)) in sensors.chain(motors).enumerate() {
            f.write_str(if number == 0 { "//!\n" } else { "" })?;
            writeln!(f, "//! - `{name}` {what}")?;
        }
        Ok(())
    }
}

/// The layout as constants.
struct Layout<'a>(&'a NetworkExport);

impl fmt::Display for Layout<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            NetworkExport::Leaky { layout, leak, .. } => {
                let (sensors, hidden, outputs) = (layout.sensors(), layout.hidden(), layout.outputs());
                let (slope, reading) = (layout.slope(), reading(*leak));
                write!(
                    f,
                    "use farsa_nn::{{Leak, LeakyLayout}};

/// Numbers of sensors, hidden neurons and motors.
pub const LAYOUT: LeakyLayout = LeakyLayout::new({sensors}, {hidden}, {outputs}).with_slope({slope:?});

/// The reading of the leak.
pub const LEAK: Leak = Leak::{reading};
"
                )
            }
            NetworkExport::Perceptron { slope, .. } => write!(
                f,
                "use farsa_nn::Perceptron;

/// The slope of the logistic function.
pub const SLOPE: f32 = {slope:?};
"
            ),
            NetworkExport::Ctrnn { layout, time_step, .. } => {
                let (inputs, neurons, outputs) = (layout.inputs(), layout.neurons(), layout.outputs());
                let direct = layout.direct_inputs();
                let direct = direct.map(|to| format!("\n    .with_direct_inputs({})", to.start)).unwrap_or_default();
                let (first, integrator, activation) =
                    (layout.output_neurons().start, layout.integrator(), layout.activation());
                write!(
                    f,
                    "use farsa_nn::{{Activation, CtrnnLayout, Integrator}};

/// Numbers of inputs, neurons and outputs, and how they are integrated.
pub const LAYOUT: CtrnnLayout = CtrnnLayout::new({inputs}, {neurons}, {outputs}){direct}
    .with_outputs_from({first})
    .with_integrator(Integrator::{integrator:?})
    .with_activation(Activation::{activation:?});

/// Time step [s].
pub const TIME_STEP: f32 = {time_step:?};
"
                )
            }
            NetworkExport::Blocks { layout, leak, .. } => {
                let (inputs, outputs) = (layout.inputs, layout.outputs);
                writeln!(
                    f,
                    "use farsa_nn::block::{{Block, BlockLayout, Group, Span}};
use farsa_nn::{{Activation, Leak}};

/// The groups of alike neurons.
#[rustfmt::skip]
pub const GROUPS: &[Group] = &["
                )?;
                layout.groups.iter().try_for_each(|group| write_group(f, group))?;
                writeln!(
                    f,
                    "];

/// The blocks in the order of a step.
#[rustfmt::skip]
pub const BLOCKS: &[Block] = &["
                )?;
                layout.blocks.iter().try_for_each(|block| write_block(f, block))?;
                writeln!(
                    f,
                    "];

/// Numbers of inputs and outputs, groups and blocks.
pub const LAYOUT: BlockLayout<'static> = BlockLayout::new({inputs}, {outputs}, GROUPS, BLOCKS);

/// The reading of the leak.
pub const LEAK: Leak = Leak::{};",
                    reading(*leak)
                )
            }
        }
    }
}

/// The number of parameters of the layout.
struct ParameterCount<'a>(&'a NetworkExport);

impl fmt::Display for ParameterCount<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            NetworkExport::Perceptron { inputs, outputs, .. } => {
                write!(f, "Perceptron::parameter_count({inputs}, {outputs})")
            }
            _ => f.write_str("LAYOUT.parameter_count()"),
        }
    }
}

fn write_group(f: &mut fmt::Formatter<'_>, group: &Group) -> fmt::Result {
    let Group { neurons, activation, slope, bias, gain, leak } = *group;
    write!(f, "    Group::new({neurons}, Activation::{activation:?}).with_slope({slope:?})")?;
    for (has, with) in [(bias, ".with_biases()"), (gain, ".with_gains()"), (leak, ".with_leaks()")] {
        f.write_str(if has { with } else { "" })?;
    }
    f.write_str(",\n")
}

fn write_block(f: &mut fmt::Formatter<'_>, block: &Block) -> fmt::Result {
    match *block {
        Block::Connect { from, to, delay } => {
            let [from, to] = [from, to].map(|span| format!("Span::new({}, {})", span.first, span.count));
            writeln!(f, "    Block::connect({from}, {to}).delayed({delay}),")
        }
        Block::Update(span) => writeln!(f, "    Block::Update(Span::new({}, {})),", span.first, span.count),
        Block::Gain(span) => writeln!(f, "    Block::Gain(Span::new({}, {})),", span.first, span.count),
        Block::ModulatedGain { neurons, by } => {
            let (first, count) = (neurons.first, neurons.count);
            writeln!(f, "    Block::ModulatedGain {{ neurons: Span::new({first}, {count}), by: {by} }},")
        }
        // There is no other kind. A new one would not compile in its reader.
        _ => f.write_str("    compile_error!(\"a block of a later version\"),\n"),
    }
}

/// The reading of the leak as source text has it.
fn reading(leak: Leak) -> &'static str {
    match leak {
        Leak::Filter => "Filter",
        Leak::TwoTap => "TwoTap",
        Leak::Evonet => "Evonet",
    }
}

fn little_endian(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn other(error: impl fmt::Display) -> Error {
    Error::Other(error.to_string())
}

/// Literals in indented lines of eight.
struct List<I>(I);

impl<I: Iterator<Item: fmt::Debug> + Clone> fmt::Display for List<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, value) in self.0.clone().enumerate() {
            f.write_str(if index % 8 == 0 { "    " } else { " " })?;
            write!(f, "{value:?},")?;
            if index % 8 == 7 {
                f.write_str("\n")?;
            }
        }
        if self.0.clone().count().is_multiple_of(8) { Ok(()) } else { f.write_str("\n") }
    }
}
