//! The two files of a network.

use crate::experiment::controller_export::ControllerExport;
use crate::export::c::arithmetic::{FUNCTIONS, INTEGERS, REALS};
use crate::export::c::channels::{comment, inputs_text, outputs_text};
use crate::export::c::code::{Code, Rows, table};
use crate::export::c::rows::ROWS;

/// A network in C99: a header and a source file, without heap and library.
///
/// The functions are `NAME_init`, `NAME_step` and `NAME_selftest`, over a struct that the caller owns. The last one
/// returns the number of 16 rows in which the outputs differ from those of the Rust network.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CFiles {
    /// Content of `NAME.h`.
    pub header: String,
    /// Content of `NAME.c`.
    pub source: String,
}

/// Everything that the two files contain.
pub(super) struct Source<'a> {
    pub(super) name: &'a str,
    pub(super) about: &'a str,
    pub(super) controller: &'a ControllerExport,
    pub(super) code: Code,
    pub(super) rows: Rows,
}

impl Source<'_> {
    /// Writes the header and the source.
    pub(super) fn files(&self) -> CFiles {
        CFiles { header: self.header(), source: self.source() }
    }

    fn header(&self) -> String {
        let Self { name, about, controller, code, .. } = self;
        let Code { number, units, .. } = code;
        let large = name.to_uppercase();
        let [inputs, outputs] = controller.network.shape();
        let (about, step) = (comment(about), controller.time_step);
        let (sensors, motors) = (inputs_text(&controller.sensors), outputs_text(&controller.motors));
        let fields: String = self.fields().map(|field| ["    ", &field, ";\n"].concat()).collect();
        format!(
            "/* {about}.
 * Written by `farsa export controller`. Compile {name}.c as C99.
 *
 * Call {name}_step every {step} s. {units}
 *
 * Inputs:
{sensors} *
 * Outputs:
{motors} */
#ifndef {large}_H
#define {large}_H

#include <stdint.h>

#ifdef __cplusplus
extern \"C\" {{
#endif

#define {large}_INPUTS {inputs}
#define {large}_OUTPUTS {outputs}

/* The memory of the network. */
typedef struct {{
{fields}}} {name}_state;

/* Begins an episode. */
void {name}_init({name}_state *state);

/* Computes the outputs of one step. */
void {name}_step({name}_state *state, const {number} *inputs, {number} *outputs);

/* Returns the number of test rows with other outputs than in Rust: 0 if this compiler computes the same bits. */
int {name}_selftest(void);

#ifdef __cplusplus
}}
#endif

#endif
"
        )
    }

    /// Declares the fields of the state.
    fn fields(&self) -> impl Iterator<Item = String> {
        let none = self.code.fields.is_empty().then(|| String::from("uint8_t none"));
        // An empty array is invalid in C99.
        let field = |(kind, name, count): &(&str, String, usize)| format!("{kind} {name}[{}]", count.max(&1));
        self.code.fields.iter().map(field).chain(none)
    }

    fn source(&self) -> String {
        let Self { name, code, rows, .. } = self;
        let Code { number, tables, functions, init, step, .. } = code;
        let [inputs, outputs] = self.controller.network.shape();
        let begin = if *number == "float" { REALS } else { INTEGERS };
        let unused = if code.fields.is_empty() { "    (void)state;\n" } else { "" };
        let no_inputs = if inputs == 0 { "    (void)inputs;\n" } else { "" };
        let test = self.selftest();
        let main = format!(
            "{functions}void {name}_init({name}_state *state)
{{
{unused}{init}}}

void {name}_step({name}_state *state, const {number} *inputs, {number} *outputs)
{{
{unused}{no_inputs}{step}}}

{}{}{test}",
            table(number, "ROWS_IN", ROWS * inputs, &rows.inputs),
            table(number, "ROWS_OUT", ROWS * outputs, &rows.outputs),
        );
        let functions = FUNCTIONS.iter().rev().fold(main, |code, (call, function)| {
            let calls = code
                .match_indices(call)
                .any(|(at, _)| !code[..at].ends_with(|c: char| c == '_' || c.is_alphanumeric()));
            if calls { format!("{function}{code}") } else { code }
        });
        format!("/* See {name}.h. */\n#include \"{name}.h\"\n\n{begin}{tables}{functions}")
    }

    fn selftest(&self) -> String {
        let Self { name, code, .. } = self;
        let [inputs, outputs] = self.controller.network.shape();
        let number = code.number;
        let copy = match (inputs, number) {
            (0, _) => String::new(),
            (_, "float") => format!("        copy(inputs, ROWS_IN + row * {inputs}, {inputs});\n"),
            _ => format!("        copy_integers(inputs, ROWS_IN + row * {inputs}, {inputs});\n"),
        };
        let compare = match (outputs, number) {
            (0, _) => String::new(),
            (_, "float") => format!(
                "        for (int i = 0; i < {outputs}; i++) {{
            word here, there;
            here.real = outputs[i];
            there.real = READ(ROWS_OUT + row * {outputs} + i);
            if (here.bits != there.bits) differs = 1;
        }}
"
            ),
            _ => format!(
                "        for (int i = 0; i < {outputs}; i++)
            if (outputs[i] != (int16_t)READ(ROWS_OUT + row * {outputs} + i)) differs = 1;
"
            ),
        };
        let (inputs, outputs) = (inputs.max(1), outputs.max(1));
        format!(
            "int {name}_selftest(void)
{{
    {name}_state state;
    {number} inputs[{inputs}], outputs[{outputs}];
    int differing = 0;
    {name}_init(&state);
    for (int row = 0; row < {ROWS}; row++) {{
        int differs = 0;
{copy}        {name}_step(&state, inputs, outputs);
{compare}        differing += differs;
    }}
    return differing;
}}
"
        )
    }
}
