//! The content of both files, and literals.

/// Constants and functions of a network in C.
pub(super) struct Code {
    /// Type of an input and of an output.
    pub(super) number: &'static str,
    /// Parameters.
    pub(super) tables: String,
    /// Fields of the state: type, name, length.
    pub(super) fields: Vec<(&'static str, String, usize)>,
    /// Static functions of this network alone.
    pub(super) functions: String,
    /// Body of `NAME_init`.
    pub(super) init: String,
    /// Body of `NAME_step`.
    pub(super) step: String,
    /// Meaning of the numbers of inputs and outputs.
    pub(super) units: String,
}

/// Inputs and outputs of the rows of the self-test, as literals in C.
pub(super) struct Rows {
    pub(super) inputs: String,
    pub(super) outputs: String,
}

/// Returns a constant array of this type, or nothing for an empty one.
pub(super) fn table(kind: &str, name: &str, count: usize, literals: &str) -> String {
    if count == 0 { String::new() } else { format!("STORED {kind} {name}[{count}] = {{\n{literals}}};\n\n") }
}

/// Returns the values as literals in lines of eight.
pub(super) fn literals<T>(values: impl IntoIterator<Item = T>, literal: impl Fn(T) -> String) -> String {
    let literals: Vec<String> = values.into_iter().map(literal).collect();
    let line = |line: &[String]| format!("    {},\n", line.join(", "));
    literals.chunks(8).map(line).collect()
}

/// Returns a number of single precision as a literal with the digits that it needs.
pub(super) fn real(value: f32) -> String {
    format!("{value:?}f")
}
