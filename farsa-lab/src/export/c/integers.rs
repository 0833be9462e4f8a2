//! A leaky network in integers in C.

use farsa_nn::quantized::{QuantizedNetwork, QuantizedScale};
use farsa_nn::{Leak, LeakyLayout, LeakyParameter};

use crate::error::Error;
use crate::experiment::network_export::NetworkExport;
use crate::export::c::code::{Code, Rows, literals, table};
use crate::export::c::rows::{ROWS, inputs};

/// Fraction bits of inputs: 9 cover \[-64, 64).
const INPUT_BITS: u32 = 9;

/// A leaky network whose parameters are integers.
pub(super) struct Quantized {
    layout: LeakyLayout,
    leak: Leak,
    scale: QuantizedScale,
    parameters: Vec<i16>,
}

impl Quantized {
    /// Converts a leaky network.
    pub(super) fn new(network: &NetworkExport) -> Result<Self, Error> {
        let NetworkExport::Leaky { layout, leak, parameters } = network else {
            return Err(Error::Usage(String::from(
                "only a leaky network has a form in integers: choose --format c for this one",
            )));
        };
        let mut integers = vec![0; parameters.len()];
        let scale = QuantizedScale::quantize(layout, INPUT_BITS, parameters, &mut integers).map_err(|error| {
            Error::Usage(format!("the network has no form in integers ({error}): choose --format c"))
        })?;
        Ok(Self { layout: *layout, leak: *leak, scale, parameters: integers })
    }

    /// Steps the network over the rows of the self-test.
    pub(super) fn rows(&self) -> Result<Rows, Error> {
        let Self { layout, leak, scale, parameters } = self;
        let network = QuantizedNetwork::new(*layout, *leak, *scale, &parameters[..], vec![0; layout.state_len()]);
        let mut network = network.map_err(|error| Error::Other(error.to_string()))?;
        let sensors = layout.sensors();
        let x: Vec<i16> = inputs(sensors).into_iter().map(|x| scale.input(x)).collect();
        let mut outputs = Vec::new();
        for row in 0..ROWS {
            let mut y = vec![0; layout.outputs()];
            network.step_quantized(&x[row * sensors..(row + 1) * sensors], &mut y);
            outputs.extend(y);
        }
        let integer = |value: i16| value.to_string();
        Ok(Rows { inputs: literals(x, integer), outputs: literals(outputs, integer) })
    }

    /// Writes constants and functions.
    pub(super) fn code(&self) -> Code {
        let hidden = self.layout.hidden();
        let mut fields = vec![("int32_t", String::from("hidden"), hidden)];
        if self.leak == Leak::TwoTap {
            fields.push(("int32_t", String::from("previous"), hidden));
        }
        fields.push(("int32_t", String::from("sums"), hidden));
        let previous = if self.leak == Leak::TwoTap { "state->previous[i] = " } else { "" };
        Code {
            number: "int16_t",
            tables: self.tables(),
            fields,
            functions: String::new(),
            init: format!("    for (int i = 0; i < {hidden}; i++) {previous}state->hidden[i] = 0;\n"),
            step: self.step(),
            units: format!(
                "An input v is the integer 2^{INPUT_BITS} v,\n * rounded to the nearest (half to even) and clamped to 16 bits, and an output is an integer in units of 2^-15."
            ),
        }
    }

    fn tables(&self) -> String {
        let names = ["SENSOR_WEIGHTS", "RECURRENT_WEIGHTS", "OUTPUT_WEIGHTS", "BIASES", "LEAKS"];
        let parts = LeakyParameter::ALL.map(|kind| &self.parameters[self.layout.range(kind)]);
        let tables = names.into_iter().zip(parts);
        let tables = tables.map(|(name, part)| table("int16_t", name, part.len(), &literals(part, i16::to_string)));
        // The entries of farsa_nn::quantized: 1/(1 + exp(-k/32)) in units of 2^-15.
        let entry = |k: i32| (32768.0 / (1.0 + farsa_num::exp(-f64::from(k) / 32.0)) + 0.5) as u16;
        let entries = literals((0..=384).map(entry), |entry| entry.to_string());
        let bits = self.scale.sum_bits();
        format!(
            "#define SUM_BITS {bits}\n\n{}{}",
            tables.collect::<String>(),
            table("uint16_t", "LOGISTIC", 385, &entries)
        )
    }

    fn step(&self) -> String {
        let Self { layout, leak, scale, .. } = self;
        let (sensors, hidden, outputs) = (layout.sensors(), layout.hidden(), layout.outputs());
        let input = scale.input_bits() + scale.weight_bits() - scale.sum_bits();
        let activation = 15 + scale.weight_bits() - scale.sum_bits();
        let update = match leak {
            Leak::Filter => "state->hidden[i] += share(d, y - state->hidden[i]);",
            Leak::TwoTap => {
                "state->hidden[i] = state->previous[i] + share(d, y - state->previous[i]);\n        state->previous[i] = y;"
            }
            Leak::Evonet => "state->hidden[i] += share(16384 - d, y - state->hidden[i]);",
        };
        let from_inputs = format!(
            "    for (int j = 0; j < {sensors}; j++)
        for (int i = 0; i < {hidden}; i++)
            state->sums[i] += product((int16_t)READ(SENSOR_WEIGHTS + j * {hidden} + i), inputs[j], {input});
"
        );
        let between = format!(
            "    for (int i = 0; i < {hidden}; i++) state->sums[i] = product((int16_t)READ(BIASES + i), 32768, {activation});
    for (int j = 0; j < {hidden}; j++) {{
        int32_t x = source(state->hidden[j]);
        for (int i = 0; i < {hidden}; i++)
            state->sums[i] += product((int16_t)READ(RECURRENT_WEIGHTS + j * {hidden} + i), x, {activation});
    }}
{}    for (int i = 0; i < {hidden}; i++) {{
        int32_t y = sigma(state->sums[i]) * 32768, d = (int16_t)READ(LEAKS + i);
        {update}
    }}
",
            if sensors == 0 { "" } else { &from_inputs }
        );
        let (between, weights) = match hidden {
            0 => (String::from("    (void)inputs;\n"), String::new()),
            _ => (
                between,
                format!(
                    "        for (int j = 0; j < {hidden}; j++)
            sum += product((int16_t)READ(OUTPUT_WEIGHTS + j * {outputs} + i), source(state->hidden[j]), {activation});
"
                ),
            ),
        };
        format!(
            "{between}    for (int i = 0; i < {outputs}; i++) {{
        int32_t sum = 0;
{weights}        sum = sigma(sum);
        outputs[i] = (int16_t)(sum < 32767 ? sum : 32767);
    }}
"
        )
    }
}
