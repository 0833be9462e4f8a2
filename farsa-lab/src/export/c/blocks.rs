//! A network of blocks in C.

use farsa_nn::Leak;
use farsa_nn::block::{Block, BlockLayoutBuf, Span};

use crate::error::Error;
use crate::export::c::calls::{add, floats, leak_update, real_response};
use crate::export::c::code::Code;

/// Writes constants and functions.
pub(super) fn block_code(layout: &BlockLayoutBuf, leak: Leak, tables: String) -> Result<Code, Error> {
    let neurons = layout.layout().neurons();
    let sources =
        layout.blocks.iter().map(|block| if let Block::Connect { from, .. } = block { from.count } else { 0 });
    let mut fields = vec![floats("activations", neurons), floats("net", neurons), floats("gains", neurons)];
    fields.push(floats("sent", sources.max().unwrap_or(0)));
    let mut init = vec![format!("    for (int i = 0; i < {neurons}; i++) state->activations[i] = 0.0f;\n")];
    if leak == Leak::TwoTap {
        fields.push(floats("previous", neurons));
        init.push(format!("    for (int i = 0; i < {neurons}; i++) state->previous[i] = 0.0f;\n"));
    }
    let mut step = vec![begin(layout)];
    let mut weights = 0;
    for (index, block) in layout.blocks.iter().enumerate() {
        match *block {
            Block::Connect { from, to, delay } => {
                if delay > 0 {
                    let length = delay * from.count;
                    fields.push(("uint32_t", format!("oldest_{index}"), 1));
                    fields.push(floats(&format!("delayed_{index}"), length));
                    init.push(format!(
                        "    state->oldest_{index}[0] = 0;\n    for (int i = 0; i < {length}; i++) state->delayed_{index}[i] = 0.0f;\n"
                    ));
                }
                step.push(connect(index, from, to, delay, weights));
            }
            Block::Update(span) => step.push(update(layout, leak, span)),
            Block::Gain(span) => step.push(gain(span, &format!("state->gains[{}]", span.first))),
            Block::ModulatedGain { neurons, by } => {
                step.push(gain(neurons, &format!("state->activations[{by}]")));
            }
            _ => return Err(Error::Other(String::from("a block of a later version has no form in C"))),
        }
        weights += block.weights();
    }
    let (first, outputs) = (neurons - layout.outputs.min(neurons), layout.outputs);
    step.push(format!("    for (int i = 0; i < {outputs}; i++) outputs[i] = state->activations[{first} + i];\n"));
    if layout.inputs > 0 && !step.iter().any(|part| part.contains("inputs[")) {
        step.insert(0, String::from("    (void)inputs;\n"));
    }
    let (init, step) = (init.concat(), step.concat());
    Ok(Code { number: "float", tables, fields, functions: String::new(), init, step, units: String::new() })
}

/// Writes the first values of a step: biases as net inputs, parameters as gains.
fn begin(layout: &BlockLayoutBuf) -> String {
    let neurons = layout.layout().neurons();
    let mut text = vec![format!(
        "    for (int i = 0; i < {neurons}; i++) {{
        state->net[i] = 0.0f;
        state->gains[i] = 1.0f;
    }}
"
    )];
    for (group, Span { first, count }, [bias, gain, _]) in
        layout.layout().places().filter(|(_, span, _)| span.count > 0)
    {
        if group.bias {
            text.push(format!("    copy(state->net + {first}, BIASES + {bias}, {count});\n"));
        }
        if group.gain {
            text.push(format!("    copy(state->gains + {first}, GAINS + {gain}, {count});\n"));
        }
    }
    text.concat()
}

fn connect(index: usize, from: Span, to: Span, delay: usize, weights: usize) -> String {
    let (first, count) = (from.first, from.count);
    if count == 0 {
        return String::new();
    }
    let value = format!("state->activations[{first} + j] * state->gains[{first} + j]");
    let begin = match delay {
        0 => format!("    for (int j = 0; j < {count}; j++) state->sent[j] = {value};\n"),
        _ => format!(
            "    for (int j = 0; j < {count}; j++) {{
        float *place = state->delayed_{index} + state->oldest_{index}[0] * {count} + j;
        state->sent[j] = *place;
        *place = {value};
    }}
    state->oldest_{index}[0] = (state->oldest_{index}[0] + 1) % {delay};
"
        ),
    };
    let sums = format!("state->net + {}", to.first);
    begin + &add(&sums, to.count, "state->sent", count, &format!("WEIGHTS + {weights}"))
}

/// Writes the new activations of a span, which may cover parts of several groups.
fn update(layout: &BlockLayoutBuf, leak: Leak, span: Span) -> String {
    let mut text = Vec::new();
    for (group, neurons, [_, _, leaks]) in layout.layout().places() {
        let (first, end) = (span.first.max(neurons.first), span.end().min(neurons.end()));
        let inputs = layout.inputs.clamp(first, end.max(first));
        let net = real_response(group.activation, group.slope, "state->net[i]");
        for (first, end, response) in [(first, inputs, "inputs[i]"), (inputs, end, net.as_str())] {
            if first >= end {
                continue;
            }
            let assignment = if group.leak {
                format!(
                    "        float y = {response}, d = READ(LEAKS + (i - {} + {leaks}));\n{}",
                    neurons.first,
                    leak_update(leak, "state->activations[i]", "i")
                )
            } else {
                format!("        state->activations[i] = {response};\n")
            };
            text.push(format!("    for (int i = {first}; i < {end}; i++) {{\n{assignment}    }}\n"));
        }
    }
    text.concat()
}

fn gain(span: Span, value: &str) -> String {
    match span.count {
        0 => String::new(),
        _ => format!(
            "    {{
        float gain = {value};
        for (int i = {}; i < {}; i++) state->gains[i] = gain;
    }}
",
            span.first,
            span.end()
        ),
    }
}
