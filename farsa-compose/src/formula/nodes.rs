//! Parts of formulas, and the state of their parser.

use winnow::error::{ErrMode, ModalResult, ParserError};
use winnow::stream::{LocatingSlice, Location as _, Stateful};

use crate::formula::unit::Unit;

/// Most parentheses, functions and signs around a part.
const MAX_DEPTH: usize = 32;

/// An operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operator {
    Or,
    And,
    Not,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
}

/// A function of numbers and truths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Min,
    Max,
    Mean,
    Abs,
    Sign,
    Clamp,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tanh,
    Pow,
    If,
}

/// Functions by their names.
pub(crate) const FUNCTIONS: [(&str, Function); 14] = [
    ("min", Function::Min),
    ("max", Function::Max),
    ("mean", Function::Mean),
    ("abs", Function::Abs),
    ("sign", Function::Sign),
    ("clamp", Function::Clamp),
    ("sqrt", Function::Sqrt),
    ("exp", Function::Exp),
    ("log", Function::Log),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tanh", Function::Tanh),
    ("pow", Function::Pow),
    ("if", Function::If),
];

/// Words that are no names.
pub(crate) const RESERVED: [&str; 4] = ["and", "or", "not", "for"];

/// A number in base units. Without a unit it takes that of its neighbors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    pub(crate) value: f64,
    pub(crate) unit: Option<Unit>,
}

/// A named quantity, with arguments in parentheses if it has any.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Call {
    pub(crate) name: String,
    pub(crate) quoted: bool,
    pub(crate) arguments: Option<Vec<Argument>>,
}

/// An argument of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Argument {
    pub(crate) key: Option<String>,
    pub(crate) value: Value,
    pub(crate) offset: usize,
}

/// The value of an argument.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Name(String),
    Number(Number),
    List(Vec<Self>),
}

/// A part of a formula, after its operands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NodeKind {
    Number(Number),
    Call(Call),
    Operator(Operator),
    /// A function of the given number of operands.
    Function(Function, usize),
}

/// A part of a formula with its place in bytes. The place of an operator is that of its right operand.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) kind: NodeKind,
    pub(crate) offset: usize,
}

/// Nodes in postfix order, and the time for which a condition must hold [s], with its place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Syntax {
    pub(crate) nodes: Vec<Node>,
    pub(crate) duration: Option<(f64, usize)>,
}

/// An error at a byte of the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) offset: usize,
    /// Reason, empty for a missing operand.
    pub(crate) why: String,
}

/// Nodes so far, and the parentheses, functions and signs around the next part.
#[derive(Clone, Debug, Default)]
pub(crate) struct State {
    pub(crate) nodes: Vec<Node>,
    pub(crate) depth: usize,
}

/// Text of a formula with the state of its parser.
pub(crate) type Input<'t> = Stateful<LocatingSlice<&'t str>, State>;
/// Result of a parser.
pub(crate) type Parsed<T> = ModalResult<T, Fault>;

impl ParserError<Input<'_>> for Fault {
    type Inner = Self;

    fn from_input(input: &Input<'_>) -> Self {
        Self { offset: input.current_token_start(), why: String::new() }
    }

    fn into_inner(self) -> Result<Self::Inner, Self> {
        Ok(self)
    }
}

/// Creates an error that ends the parsing.
pub(crate) fn cut<T>(offset: usize, why: impl Into<String>) -> Parsed<T> {
    Err(ErrMode::Cut(Fault { offset, why: why.into() }))
}

impl State {
    /// Appends a node.
    pub(crate) fn push(&mut self, kind: NodeKind, offset: usize) {
        self.nodes.push(Node { kind, offset });
    }

    /// Enters a parenthesis, a function or the operand of a sign.
    pub(crate) fn enter(&mut self, offset: usize) -> Parsed<()> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return cut(offset, format!("the formula is nested more than {MAX_DEPTH} deep"));
        }
        Ok(())
    }
}
