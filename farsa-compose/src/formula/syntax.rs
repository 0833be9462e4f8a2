//! Syntax of formulas: from a text to nodes in postfix order.

use winnow::Parser as _;
use winnow::combinator::{Infix, Prefix, expression};
use winnow::error::ErrMode;
use winnow::stream::{LocatingSlice, Location as _, Stateful, Stream};

use crate::formula::nodes::{
    Argument, Call, FUNCTIONS, Fault, Function, Input, Node, NodeKind, Number, Operator, Parsed, RESERVED, State,
    Syntax, Value, cut,
};
use crate::formula::token::{keyword, number, quoted, space, symbol, word};
use crate::formula::unit::Unit;

/// Most characters of a formula.
const MAX_CHARACTERS: usize = 2000;

/// Reads a formula.
pub(crate) fn parse(text: &str) -> Result<Syntax, Fault> {
    let characters = text.chars().count();
    if characters > MAX_CHARACTERS {
        let why = format!("the formula has {characters} characters; at most {MAX_CHARACTERS}");
        let offset = text.char_indices().nth(MAX_CHARACTERS).map_or(0, |(offset, _)| offset);
        return Err(Fault { offset, why });
    }
    let mut input = Stateful { input: LocatingSlice::new(text), state: State::default() };
    let parsed = formula(&mut input);
    let duration = parsed.map_err(|error| {
        let fault = error.into_inner().unwrap_or(Fault { offset: 0, why: String::new() });
        if fault.why.is_empty() { missing(text, fault.offset) } else { fault }
    })?;
    Ok(Syntax { nodes: input.state.nodes, duration })
}

/// Describes a missing operand.
fn missing(text: &str, offset: usize) -> Fault {
    let rest = text.get(offset..).unwrap_or_default();
    let offset = offset + rest.len() - rest.trim_start().len();
    let why = match rest.trim_start().chars().next() {
        Some(character) => format!("`{character}` is not the start of a number, a name or a parenthesis"),
        None => "the formula ends without a number, a name or a parenthesis".to_owned(),
    };
    Fault { offset, why }
}

/// Parses a whole formula, with the time for which it must hold.
fn formula(input: &mut Input<'_>) -> Parsed<Option<(f64, usize)>> {
    sum(input)?;
    let mut duration = None;
    space(input)?;
    let offset = input.current_token_start();
    if keyword(input, "for") {
        space(input)?;
        let place = input.current_token_start();
        let Some(Number { value, unit }) = number(input)? else {
            return cut(place, "`for` lacks a time such as `1 s`");
        };
        if unit.is_some_and(|unit| unit != Unit::SECOND) {
            return cut(place, "`for` needs a time, such as `1 s`");
        }
        duration = Some((value, offset));
        space(input)?;
    }
    let rest = input.input.as_ref();
    match rest.chars().next() {
        None => Ok(duration),
        Some(_) if duration.is_some() => cut(input.current_token_start(), "`for` is the last part of a condition"),
        Some('=') => cut(offset, "a comparison is written `==`"),
        Some('^') => cut(offset, "a power is written `pow(x, 2)`"),
        Some('<' | '>' | '!') => cut(offset, "two comparisons are joined by `and`"),
        Some(character) => cut(offset, format!("`{character}` follows a complete formula")),
    }
}

/// Parses an expression, from `or` to signs. Returns the offset of its first byte.
fn sum(input: &mut Input<'_>) -> Parsed<usize> {
    expression(operand).prefix(prefix).infix(infix).parse_next(input)
}

fn prefix<'t>(input: &mut Input<'t>) -> Parsed<Prefix<Input<'t>, usize, ErrMode<Fault>>> {
    space(input)?;
    let offset = input.current_token_start();
    if symbol(input, "-") {
        input.state.enter(offset)?;
        return Ok(Prefix(7, |input: &mut Input<'t>, operand| {
            input.state.depth -= 1;
            // The sign of a number is a part of it.
            match input.state.nodes.last_mut() {
                Some(Node { kind: NodeKind::Number(number), offset }) if *offset == operand => {
                    number.value = -number.value;
                }
                _ => input.state.push(NodeKind::Operator(Operator::Negate), operand),
            }
            Ok(operand)
        }));
    }
    if keyword(input, "not") {
        input.state.enter(offset)?;
        return Ok(Prefix(3, |input: &mut Input<'t>, operand| {
            input.state.depth -= 1;
            input.state.push(NodeKind::Operator(Operator::Not), operand);
            Ok(operand)
        }));
    }
    Err(ErrMode::Backtrack(Fault { offset, why: String::new() }))
}

/// Creates the parser result of a binary operator.
macro_rules! binary {
    ($way:ident, $power:expr, $operator:ident) => {
        Ok(Infix::$way($power, |input: &mut Input<'_>, left, right| {
            input.state.push(NodeKind::Operator(Operator::$operator), right);
            Ok(left)
        }))
    };
}

fn infix<'t>(input: &mut Input<'t>) -> Parsed<Infix<Input<'t>, usize, ErrMode<Fault>>> {
    space(input)?;
    let offset = input.current_token_start();
    match () {
        () if symbol(input, "+") => binary!(Left, 5, Add),
        () if symbol(input, "-") => binary!(Left, 5, Subtract),
        () if symbol(input, "*") => binary!(Left, 6, Multiply),
        () if symbol(input, "/") => binary!(Left, 6, Divide),
        () if symbol(input, "<=") => binary!(Neither, 4, LessEqual),
        () if symbol(input, ">=") => binary!(Neither, 4, GreaterEqual),
        () if symbol(input, "==") => binary!(Neither, 4, Equal),
        () if symbol(input, "!=") => binary!(Neither, 4, NotEqual),
        () if symbol(input, "<") => binary!(Neither, 4, Less),
        () if symbol(input, ">") => binary!(Neither, 4, Greater),
        () if keyword(input, "and") => binary!(Left, 2, And),
        () if keyword(input, "or") => binary!(Left, 1, Or),
        () => Err(ErrMode::Backtrack(Fault { offset, why: String::new() })),
    }
}

/// Parses a number, a quantity, a function or a parenthesis.
fn operand(input: &mut Input<'_>) -> Parsed<usize> {
    space(input)?;
    let offset = input.current_token_start();
    if let Some(number) = number(input)? {
        input.state.push(NodeKind::Number(number), offset);
        return Ok(offset);
    }
    if symbol(input, "(") {
        input.state.enter(offset)?;
        sum(input)?;
        closed(input, offset)?;
        // A number in parentheses keeps the sign before it, like any other operand.
        return Ok(offset);
    }
    if let Some(name) = quoted(input)? {
        let call = Call { name: name.into(), quoted: true, arguments: None };
        input.state.push(NodeKind::Call(call), offset);
        return Ok(offset);
    }
    let start = input.checkpoint();
    let Some(name) = word(input).filter(|word| !RESERVED.contains(word)) else {
        input.reset(&start);
        return Err(ErrMode::Backtrack(Fault { offset, why: String::new() }));
    };
    let open = input.current_token_start();
    let called = symbol(input, "(");
    if let Some((_, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) {
        if !called {
            return cut(offset, format!("`{name}` is a function and lacks its parentheses"));
        }
        input.state.enter(offset)?;
        let is_extremum = matches!(function, Function::Min | Function::Max);
        let mut operands = 1;
        sum(input)?;
        while symbol(input, ",") {
            sum(input)?;
            operands += 1;
            // The extremum of several numbers is that of the first ones and the next.
            if is_extremum {
                input.state.push(NodeKind::Function(*function, 2), offset);
            }
        }
        closed(input, open)?;
        if operands == 1 || !is_extremum {
            input.state.push(NodeKind::Function(*function, operands), offset);
        }
        return Ok(offset);
    }
    let arguments = if called { Some(arguments(input, open)?) } else { None };
    input.state.push(NodeKind::Call(Call { name: name.into(), quoted: false, arguments }), offset);
    Ok(offset)
}

/// Leaves a parenthesis that opened at an offset.
fn closed(input: &mut Input<'_>, open: usize) -> Parsed<()> {
    input.state.depth -= 1;
    if symbol(input, ")") {
        return Ok(());
    }
    space(input)?;
    let rest = input.input.as_ref();
    match rest.chars().next() {
        Some(character) => cut(input.current_token_start(), format!("`{character}` is where `,` or `)` belongs")),
        None => cut(open, "the parenthesis does not end"),
    }
}

/// Parses the arguments of a quantity after its parenthesis.
fn arguments(input: &mut Input<'_>, open: usize) -> Parsed<Vec<Argument>> {
    let mut arguments = Vec::new();
    input.state.depth += 1;
    if symbol(input, ")") {
        input.state.depth -= 1;
        return Ok(arguments);
    }
    loop {
        space(input)?;
        let offset = input.current_token_start();
        let start = input.checkpoint();
        let key = word(input).filter(|_| symbol(input, "="));
        let key = key.map(str::to_owned);
        if key.is_none() {
            input.reset(&start);
        }
        space(input)?;
        arguments.push(Argument { key, value: value(input, true)?, offset });
        if !symbol(input, ",") {
            closed(input, open)?;
            return Ok(arguments);
        }
    }
}

/// Parses the value of an argument. Lists contain no lists.
fn value(input: &mut Input<'_>, lists: bool) -> Parsed<Value> {
    space(input)?;
    let offset = input.current_token_start();
    if let Some(name) = quoted(input)? {
        return Ok(Value::Name(name.into()));
    }
    if let Some(name) = word(input) {
        return Ok(Value::Name(name.into()));
    }
    let negative = symbol(input, "-");
    space(input)?;
    if let Some(Number { value, unit }) = number(input)? {
        return Ok(Value::Number(Number { value: if negative { -value } else { value }, unit }));
    }
    if lists && !negative && symbol(input, "[") {
        let mut items = vec![value(input, false)?];
        while symbol(input, ",") {
            items.push(value(input, false)?);
        }
        return if symbol(input, "]") { Ok(Value::List(items)) } else { cut(offset, "the list does not end") };
    }
    cut(offset, "a name, a number or a list such as `[1, 0, 0]` is missing")
}
