//! Networks in single precision in C.

use farsa_nn::{Ctrnn, CtrnnLayout, Integrator, Leak, LeakyLayout};

use crate::error::Error;
use crate::experiment::network_export::NetworkExport;
use crate::export::c::blocks::block_code;
use crate::export::c::calls::{add, floats, leak_update, response};
use crate::export::c::code::{Code, literals, real, table};

/// Writes constants and functions of a network.
pub(super) fn code(network: &NetworkExport) -> Result<Code, Error> {
    match network {
        NetworkExport::Leaky { layout, leak, .. } => Ok(leaky(layout, *leak, tables(network))),
        NetworkExport::Perceptron { inputs, outputs, slope, .. } => {
            Ok(perceptron(*inputs, *outputs, *slope, tables(network)))
        }
        NetworkExport::Ctrnn { layout, time_step, parameters } => ctrnn(layout, *time_step, parameters, network),
        NetworkExport::Blocks { layout, leak, .. } => block_code(layout, *leak, tables(network)),
    }
}

/// Writes the parameters as constants in their order.
fn tables(network: &NetworkExport) -> String {
    let tables = network.tables().into_iter();
    let text = tables.map(|(name, _, values)| {
        table("float", &name.to_uppercase(), values.len(), &literals(values, |value| real(*value)))
    });
    text.collect()
}

fn leaky(layout: &LeakyLayout, leak: Leak, tables: String) -> Code {
    let (sensors, hidden, outputs, slope) = (layout.sensors(), layout.hidden(), layout.outputs(), real(layout.slope()));
    let mut fields = vec![floats("hidden", hidden), floats("sums", hidden)];
    let mut init = String::from("state->hidden[i] = 0.0f;");
    if leak == Leak::TwoTap {
        fields.push(floats("previous", hidden));
        init.push_str("\n        state->previous[i] = 0.0f;");
    }
    let mut step = Vec::new();
    if hidden > 0 {
        step.push(format!("    copy(state->sums, BIASES, {hidden});\n"));
        step.push(add("state->sums", hidden, "inputs", sensors, "SENSOR_WEIGHTS"));
        step.push(add("state->sums", hidden, "state->hidden", hidden, "RECURRENT_WEIGHTS"));
        let update = leak_update(leak, "state->hidden[i]", "i");
        step.push(format!(
            "    for (int i = 0; i < {hidden}; i++) {{
        float y = logistic({slope} * state->sums[i]), d = READ(LEAKS + i);
{update}    }}
"
        ));
    } else if sensors > 0 {
        step.push(String::from("    (void)inputs;\n"));
    }
    step.push(format!("    for (int i = 0; i < {outputs}; i++) outputs[i] = 0.0f;\n"));
    step.push(add("outputs", outputs, "state->hidden", hidden, "OUTPUT_WEIGHTS"));
    step.push(format!("    for (int i = 0; i < {outputs}; i++) outputs[i] = logistic({slope} * outputs[i]);\n"));
    let init = format!("    for (int i = 0; i < {hidden}; i++) {{\n        {init}\n    }}\n");
    Code { number: "float", tables, fields, functions: String::new(), init, step: step.concat(), units: String::new() }
}

fn perceptron(inputs: usize, outputs: usize, slope: f32, tables: String) -> Code {
    let slope = real(slope);
    let mut step = vec![match outputs {
        0 => String::from("    (void)outputs;\n"),
        _ => format!("    copy(outputs, BIASES, {outputs});\n"),
    }];
    step.push(add("outputs", outputs, "inputs", inputs, "WEIGHTS"));
    if outputs > 0 {
        step.push(format!("    for (int i = 0; i < {outputs}; i++) outputs[i] = logistic({slope} * outputs[i]);\n"));
    } else if inputs > 0 {
        step.push(String::from("    (void)inputs;\n"));
    }
    let (fields, units) = (Vec::new(), String::from("This network has no memory."));
    Code { number: "float", tables, fields, functions: String::new(), init: String::new(), step: step.concat(), units }
}

fn ctrnn(layout: &CtrnnLayout, time_step: f32, parameters: &[f32], network: &NetworkExport) -> Result<Code, Error> {
    let neurons = layout.neurons();
    let rates = rates(layout, time_step, parameters)?;
    let mut tables = Vec::new();
    for (name, _, values) in network.tables() {
        // A step uses the time constants as rates only.
        if name != "time_constants" {
            tables.push(table("float", &name.to_uppercase(), values.len(), &literals(values, |value| real(*value))));
        }
    }
    tables.push(format!("/* By neuron, from its time constant and the step of {time_step} s. */\n"));
    tables.push(table("float", "RATES", neurons, &literals(rates, real)));
    let runge_kutta = layout.integrator() == Integrator::RungeKutta4;
    let mut fields = vec![floats("y", neurons), floats("o", neurons), floats("net", neurons)];
    if layout.direct_inputs().is_none() && layout.inputs() > 0 {
        fields.push(floats("inputs", layout.inputs()));
    }
    if runge_kutta {
        fields.extend([floats("sum", neurons), floats("point", neurons)]);
    }
    let response = response(layout.activation(), "READ(GAINS + i) * (y + READ(BIASES + i))");
    let functions = format!(
        "/* The output of neuron i in state y. */
static float output(int i, float y)
{{
    float o = {response};
    return o == o ? o : 0.0f;
}}

"
    );
    let init = format!(
        "    for (int i = 0; i < {neurons}; i++) {{
        state->y[i] = 0.0f;
        state->o[i] = output(i, 0.0f);
    }}
"
    );
    let step = if runge_kutta { runge_kutta_step(layout) } else { euler_step(layout) };
    Ok(Code { number: "float", tables: tables.concat(), fields, functions, init, step, units: String::new() })
}

/// Computes the coefficients of the time constants in double precision.
fn rates(layout: &CtrnnLayout, time_step: f32, parameters: &[f32]) -> Result<Vec<f32>, Error> {
    let network = Ctrnn::new(*layout, time_step, parameters, vec![0.0; layout.state_len()]);
    let (_, state) = network.map_err(|error| Error::Other(error.to_string()))?.into_parts();
    let neurons = layout.neurons();
    Ok(state.get(2 * neurons..3 * neurons).unwrap_or_default().to_vec())
}

/// Writes the net inputs of the present outputs, indented by `indent`.
fn net(layout: &CtrnnLayout, indent: &str) -> String {
    let (inputs, neurons) = (layout.inputs(), layout.neurons());
    let mut text = vec![format!("    for (int i = 0; i < {neurons}; i++) state->net[i] = 0.0f;\n")];
    if let Some(direct) = layout.direct_inputs() {
        if inputs > 0 {
            let first = direct.start;
            text.push(format!(
                "    for (int k = 0; k < {inputs}; k++) state->net[{first} + k] = clamped(inputs[k]);\n"
            ));
        }
    } else {
        text.push(add("state->net", neurons, "state->inputs", inputs, "INPUT_WEIGHTS"));
    }
    text.push(add("state->net", neurons, "state->o", neurons, "WEIGHTS"));
    let indented = |line: &str| format!("{indent}{line}\n");
    text.concat().lines().map(indented).collect()
}

/// Writes the beginning of a step, which stores weighted inputs, and its end with the outputs.
fn ends(layout: &CtrnnLayout) -> [String; 2] {
    let (inputs, first, outputs) = (layout.inputs(), layout.output_neurons().start, layout.outputs());
    let begin = match layout.direct_inputs() {
        None if inputs > 0 => {
            format!("    for (int k = 0; k < {inputs}; k++) state->inputs[k] = clamped(inputs[k]);\n")
        }
        _ => String::new(),
    };
    [begin, format!("    for (int i = 0; i < {outputs}; i++) outputs[i] = state->o[{first} + i];\n")]
}

fn euler_step(layout: &CtrnnLayout) -> String {
    let neurons = layout.neurons();
    let [begin, end] = ends(layout);
    let net = net(layout, "");
    let update = if layout.integrator() == Integrator::Euler {
        "        y = y + rate * (net - y);\n"
    } else {
        "        /* A negative rate counts from the net input back. */
        if (rate < 0.0f) y = net + -rate * (y - net);
        else y = y + rate * (net - y);\n"
    };
    format!(
        "{begin}{net}    for (int i = 0; i < {neurons}; i++) {{
        float y = state->y[i], net = state->net[i], rate = READ(RATES + i);
{update}        state->y[i] = y;
        state->o[i] = output(i, y);
    }}
{end}"
    )
}

fn runge_kutta_step(layout: &CtrnnLayout) -> String {
    let neurons = layout.neurons();
    let [begin, end] = ends(layout);
    let net = net(layout, "    ");
    format!(
        "{begin}    for (int stage = 0; stage < 4; stage++) {{
{net}        for (int i = 0; i < {neurons}; i++) {{
            float y = state->y[i], next;
            float slope = READ(RATES + i) * (state->net[i] - (stage == 0 ? y : state->point[i]));
            if (stage == 0) state->sum[i] = slope;
            else if (stage < 3) state->sum[i] = state->sum[i] + (slope + slope);
            else state->sum[i] = state->sum[i] + slope;
            if (stage < 2) next = y + slope * 0.5f;
            else if (stage == 2) next = y + slope;
            else next = y + state->sum[i] * {};
            state->point[i] = next;
            state->o[i] = output(i, next);
        }}
    }}
    for (int i = 0; i < {neurons}; i++) state->y[i] = state->point[i];
{end}",
        real((1.0_f64 / 6.0) as f32)
    )
}
