//! A controller in the formats of boards and of Python: bytes, Rust source, tables.

use std::fmt::{self, Write as _};

use farsa_nn::{CtrnnBytes, Leak, LeakyLayout, LeakyNetworkBytes, channel_hash};
use safetensors::tensor::{Dtype, TensorView};
use serde_json::Value;

use crate::error::Error;
use crate::experiment::controller_export::{ControllerExport, CtrnnExport, NetworkExport};

/// The bytes that [`LeakyNetworkBytes`] reads.
pub(crate) fn bytes(controller: &ControllerExport) -> Result<Vec<u8>, Error> {
    let (layout, leak, parameters) = network(&controller.network)?;
    let mut bytes = vec![0; LeakyNetworkBytes::byte_count(layout)];
    LeakyNetworkBytes::write(layout, leak, channels(controller), &parameters, &mut bytes).map_err(other)?;
    Ok(bytes)
}

/// The bytes that [`CtrnnBytes`] reads.
pub(crate) fn ctrnn_bytes(network: &CtrnnExport) -> Result<Vec<u8>, Error> {
    let CtrnnExport { layout, time_step, parameters, sensors, motors } = network;
    let mut bytes = vec![0; CtrnnBytes::byte_count(*layout)];
    let channels = channel_hash(sensors, motors);
    CtrnnBytes::write(*layout, *time_step, channels, parameters, &mut bytes).map_err(other)?;
    Ok(bytes)
}

/// A source file of constants, for a program without files; `whose` says in words whose it is.
pub(crate) fn rust(controller: &ControllerExport, whose: &str) -> Result<String, Error> {
    let (layout, leak, parameters) = network(&controller.network)?;
    let mut text = String::new();
    let reading = match leak {
        Leak::Filter => "Filter",
        Leak::TwoTap => "TwoTap",
        Leak::Evonet => "Evonet",
    };
    let (sensors, hidden, outputs, slope) = (layout.sensors(), layout.hidden(), layout.outputs(), layout.slope());
    let written = write!(
        text,
        "//! {whose}: written by `farsa export controller --format rust`.

use farsa_nn::{{Leak, LeakyLayout}};

/// Numbers of sensors, hidden neurons and motors.
pub const LAYOUT: LeakyLayout = LeakyLayout::new({sensors}, {hidden}, {outputs}).with_slope({slope:?});

/// The reading of the leak.
pub const LEAK: Leak = Leak::{reading};

/// What `farsa_nn::channel_hash` makes of the names below.
pub const CHANNELS: u64 = {:#018x};

/// What the inputs are called.
#[rustfmt::skip]
pub const SENSORS: &[&str; {sensors}] = &[
{}];

/// What the outputs are called.
#[rustfmt::skip]
pub const MOTORS: &[&str; {outputs}] = &[
{}];

/// The parameters in the order of the layout.
#[rustfmt::skip]
pub const PARAMETERS: &[f32; LAYOUT.parameter_count()] = &[
{}];
",
        channels(controller),
        List(controller.sensors.iter().map(|sensor| &sensor.name)),
        List(controller.motors.iter().map(|motor| &motor.name)),
        List(parameters.iter()),
    );
    written.map_err(|error| Error::Other(error.to_string()))?;
    Ok(text)
}

/// Tables of safetensors, with `about`, less its tables, as the text `farsa` beside them.
pub(crate) fn safetensors(controller: &ControllerExport, mut about: Value) -> Result<Vec<u8>, Error> {
    let network = &controller.network;
    let &NetworkExport { inputs, hidden, outputs, .. } = network;
    let tables = [
        ("sensor_weights", &network.sensor_weights, vec![inputs, hidden]),
        ("recurrent_weights", &network.recurrent_weights, vec![hidden, hidden]),
        ("output_weights", &network.output_weights, vec![hidden, outputs]),
        ("biases", &network.biases, vec![hidden]),
        ("leaks", &network.leaks, vec![hidden]),
    ];
    if let Some(network) = about.get_mut("network").and_then(Value::as_object_mut) {
        network.retain(|name, _| tables.iter().all(|(table, ..)| name != table));
    }
    let data: Vec<Vec<u8>> = tables.iter().map(|(_, table, _)| little_endian(table)).collect();
    let views = tables
        .into_iter()
        .zip(&data)
        .map(|((name, _, shape), data)| TensorView::new(Dtype::F32, shape, data).map(|view| (name, view)));
    let views: Vec<_> = views.collect::<Result<_, _>>().map_err(other)?;
    // One text, because several would be written in an order of their own each time.
    let metadata = [("farsa".to_owned(), about.to_string())].into_iter().collect();
    safetensors::serialize(views, Some(metadata)).map_err(other)
}

fn network(network: &NetworkExport) -> Result<(LeakyLayout, Leak, Vec<f32>), Error> {
    let NetworkExport { sensor_weights, recurrent_weights, output_weights, biases, leaks, .. } = network;
    let layout = LeakyLayout::new(network.inputs, network.hidden, network.outputs).with_slope(network.slope);
    let parameters = [sensor_weights, recurrent_weights, output_weights, biases, leaks].map(Vec::as_slice).concat();
    Ok((layout, network.leak.parse().map_err(other)?, parameters))
}

fn channels(controller: &ControllerExport) -> u64 {
    let sensors = controller.sensors.iter().map(|sensor| &sensor.name);
    channel_hash(sensors, controller.motors.iter().map(|motor| &motor.name))
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
