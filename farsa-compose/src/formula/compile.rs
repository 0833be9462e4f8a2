//! Compilation of formulas, with checks of units.

use farsa_lab::Error;

use crate::check::completed::complete_term;
use crate::check::source::{Source, key};
use crate::document::RewardKind;
use crate::formula::call::Measures;
use crate::formula::channels::{ChannelNames, Channels, Combination};
use crate::formula::nodes::{Call, FUNCTIONS, Fault, Function, Node, NodeKind, Number, Operator};
use crate::formula::program::{Assembly, Op, Program};
use crate::formula::syntax::parse;
use crate::formula::unit::Unit;
use crate::formula::unknown;

/// A quantity of a formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Quantity {
    /// A measure, with the name of the robots or the body that it is about, unless a key of it names them.
    Measure(RewardKind, Option<String>),
    Channels(Channels),
}

/// A formula with the measures of its quantities.
#[derive(Clone, Debug)]
pub(crate) struct Formula<T> {
    pub(crate) program: Program,
    pub(crate) terms: Vec<T>,
}

/// A condition with the measures of its quantities.
#[derive(Clone, Debug)]
pub(crate) struct CompiledCondition<T> {
    pub(crate) formula: Formula<T>,
    /// Time for which it must hold [s].
    pub(crate) duration: Option<f64>,
}

/// Place and surroundings of a formula.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'s> {
    /// Path of the formula in the document.
    pub(crate) path: &'s str,
    pub(crate) channels: ChannelNames<'s>,
    pub(crate) source: &'s Source,
}

/// Builds the measure of a quantity at a path, with the number of its unit among those of its kind.
pub(crate) type Make<'m, T> = &'m mut dyn FnMut(&Quantity, &str) -> Result<(T, usize), Error>;

/// Type of a part of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Type {
    Truth,
    /// A number without a unit, which takes that of its neighbors.
    Bare,
    Number(Unit),
}

impl Type {
    /// Gets the unit of a factor.
    fn factor(self) -> Unit {
        if let Self::Number(unit) = self { unit } else { Unit::NONE }
    }
}

/// An error of a formula: of its text, or of a quantity at a byte.
enum Wrong {
    Text(Fault),
    Quantity(usize, Error),
}

impl From<Fault> for Wrong {
    fn from(fault: Fault) -> Self {
        Self::Text(fault)
    }
}

/// Quantities with the same values in each trial.
const CONSTANT: [&str; 3] = ["step", "time", "time-left"];

/// Creates an error at a byte.
fn wrong<T>(offset: usize, why: impl Into<String>) -> Result<T, Wrong> {
    Err(Wrong::Text(Fault { offset, why: why.into() }))
}

impl Scope<'_> {
    /// Compiles the formula of a term.
    pub(crate) fn term<T>(&self, text: &str, make: Make<'_, T>) -> Result<Formula<T>, Error> {
        let mut compile = || {
            let syntax = parse(text)?;
            if let Some((_, offset)) = syntax.duration {
                return wrong(offset, "`for` belongs to conditions; a term has a value in each step");
            }
            Ok(Compiler::new(self, make).run(&syntax.nodes)?.0)
        };
        compile().map_err(|error| self.placed(text, error))
    }

    /// Compiles the formula of a condition.
    pub(crate) fn condition<T>(&self, text: &str, make: Make<'_, T>) -> Result<CompiledCondition<T>, Error> {
        let mut compile = || {
            let syntax = parse(text)?;
            let (formula, kind) = Compiler::new(self, make).run(&syntax.nodes)?;
            if kind != Type::Truth {
                let start = text.len() - text.trim_start().len();
                return wrong(start, "the formula is a number; a condition compares, as in `time > 5`");
            }
            Ok(CompiledCondition { formula, duration: syntax.duration.map(|(seconds, _)| seconds) })
        };
        compile().map_err(|error| self.placed(text, error))
    }

    /// Creates the error with file, line, key and column.
    fn placed(&self, text: &str, error: Wrong) -> Error {
        let place = |offset: usize| {
            let column = text.get(..offset).unwrap_or(text).chars().count() + 1;
            format!("{}, column {column} of the formula", self.source.of(self.path))
        };
        match error {
            Wrong::Text(Fault { offset, why }) => Error::Setting { place: place(offset), key: key(self.path), why },
            Wrong::Quantity(offset, Error::Setting { why, .. }) => {
                Error::Setting { place: place(offset), key: key(self.path), why }
            }
            Wrong::Quantity(_, other) => other,
        }
    }
}

/// State of a compilation.
struct Compiler<'c, 's, T> {
    scope: &'c Scope<'s>,
    measures: Measures<'c>,
    make: Make<'c, T>,
    quantities: Vec<(Quantity, Unit)>,
    terms: Vec<T>,
    program: Assembly,
    /// Types of the values on the stack, with their places.
    types: Vec<(Type, usize)>,
    /// True after the combined channels of a sensor or motor.
    combined: bool,
}

impl<'c, 's, T> Compiler<'c, 's, T> {
    fn new(scope: &'c Scope<'s>, make: Make<'c, T>) -> Self {
        Self {
            scope,
            measures: Measures::new(&scope.source.registry.schemas[0]),
            make,
            quantities: Vec::new(),
            terms: Vec::new(),
            program: Assembly::default(),
            types: Vec::new(),
            combined: false,
        }
    }

    /// Compiles nodes in postfix order, and returns the type of the value.
    fn run(mut self, nodes: &[Node]) -> Result<(Formula<T>, Type), Wrong> {
        for (number, Node { kind, offset }) in nodes.iter().enumerate() {
            match kind {
                NodeKind::Number(Number { value, unit }) => {
                    self.program.push(Op::Constant(*value));
                    self.types.push((unit.map_or(Type::Bare, Type::Number), *offset));
                }
                NodeKind::Call(call) => {
                    let whole = nodes.get(number + 1).and_then(|next| combination(&next.kind));
                    self.call(call, *offset, whole)?;
                }
                NodeKind::Operator(operator) => self.operator(*operator)?,
                NodeKind::Function(function, operands) => {
                    let before = number.checked_sub(1).and_then(|before| nodes.get(before));
                    self.function((*function, *operands), *offset, before)?;
                }
            }
            if !self.program.fits() {
                return wrong(*offset, "the formula holds too many values at once; use fewer parentheses");
            }
        }
        let kind = self.types.pop().map_or(Type::Bare, |(kind, _)| kind);
        Ok((Formula { program: self.program.finish(), terms: self.terms }, kind))
    }

    /// Compiles a quantity. `whole` combines the channels of a sensor or motor.
    fn call(&mut self, call: &Call, offset: usize, whole: Option<Combination>) -> Result<(), Wrong> {
        let Call { name, quoted, arguments } = call;
        let channels = &self.scope.channels;
        let of_part = whole.filter(|_| arguments.is_none()).and_then(|whole| channels.part(name, whole));
        let is_measure = self.measures.contains(name) && !quoted;
        let channel = of_part.or_else(|| channels.channel(name)).filter(|_| arguments.is_none());
        self.combined = of_part.is_some();
        let (quantity, units) = match channel {
            Some(_) if is_measure && of_part.is_none() => {
                let why = format!("`{name}` is a channel and a term; write `'{name}'` or `{name}()`");
                return wrong(offset, why);
            }
            Some(channel) => (Quantity::Channels(channel), &[Unit::NONE][..]),
            None if is_measure => {
                let (mut kind, subject) = self.measures.read(call, offset)?;
                let Scope { path, source, .. } = self.scope;
                complete_term(&mut kind, path, source).map_err(|error| Wrong::Quantity(offset, error))?;
                (Quantity::Measure(kind, subject), self.measures.units(name))
            }
            None => return wrong(offset, self.unknown(call)),
        };
        let known = self.quantities.iter().position(|(known, _)| *known == quantity);
        let number = if let Some(number) = known {
            number
        } else {
            let made = (self.make)(&quantity, self.scope.path);
            let (term, unit) = made.map_err(|error| Wrong::Quantity(offset, error))?;
            self.terms.push(term);
            self.quantities.push((quantity, units.get(unit).copied().unwrap_or(Unit::NONE)));
            self.terms.len() - 1
        };
        self.program.push(Op::Load(number as u32));
        self.types.push((Type::Number(self.quantities[number].1), offset));
        Ok(())
    }

    /// Describes an unknown quantity.
    fn unknown(&self, call: &Call) -> String {
        let Call { name, quoted, arguments } = call;
        let channels = self.scope.channels;
        if let Some(part) = channels.part(name, Combination::Mean).filter(|_| arguments.is_none()) {
            let count = part.count();
            return format!("`{name}` has {count} channels; write `max({name})`, `min({name})` or `mean({name})`");
        }
        if name == "steps" {
            return "the term `steps` is 1 in every step; write `step` for their number".into();
        }
        if *quoted {
            return unknown("channel", name, channels.all());
        }
        let functions = FUNCTIONS.iter().map(|(name, _)| *name);
        let mut names: Vec<&str> = self.measures.names().chain(functions).collect();
        names.extend(channels.all().filter(|_| arguments.is_none()));
        let mut why = unknown("quantity", name, names);
        if name.contains('-') {
            why += "; a minus sign needs spaces";
        }
        why
    }

    /// Takes a value from the types.
    fn pop(&mut self) -> (Type, usize) {
        self.types.pop().unwrap_or((Type::Bare, 0))
    }

    /// Takes a number from the types.
    fn pop_number(&mut self) -> Result<(Type, usize), Wrong> {
        let (kind, offset) = self.pop();
        if kind == Type::Truth {
            return wrong(offset, "a comparison is where a number is needed; write `if(.., 1, 0)`");
        }
        Ok((kind, offset))
    }

    /// Takes a truth from the types.
    fn pop_truth(&mut self) -> Result<usize, Wrong> {
        let (kind, offset) = self.pop();
        if kind != Type::Truth {
            return wrong(offset, "a number is where a comparison is needed, as in `time > 5`");
        }
        Ok(offset)
    }

    /// Takes the given number of numbers of one unit, and returns their type with the first place.
    fn pop_equal(&mut self, count: usize) -> Result<(Type, usize), Wrong> {
        let (mut common, mut first) = (Type::Bare, 0);
        for _ in 0..count {
            let (kind, offset) = self.pop_number()?;
            common = match (kind, common) {
                (Type::Bare, other) | (other, Type::Bare) => other,
                (one, other) if one == other => other,
                (one, other) => {
                    // The place is that of the right one, which was taken before.
                    return wrong(first, format!("{} and {} do not match", one.factor(), other.factor()));
                }
            };
            first = offset;
        }
        Ok((common, first))
    }

    fn operator(&mut self, operator: Operator) -> Result<(), Wrong> {
        let (op, result) = match operator {
            Operator::Not => (Op::Not, (Type::Truth, self.pop_truth()?)),
            Operator::And | Operator::Or => {
                self.pop_truth()?;
                let first = self.pop_truth()?;
                (if operator == Operator::And { Op::And } else { Op::Or }, (Type::Truth, first))
            }
            Operator::Negate => (Op::Negate, self.pop_number()?),
            Operator::Add => (Op::Add, self.pop_equal(2)?),
            Operator::Subtract => (Op::Subtract, self.pop_equal(2)?),
            Operator::Multiply => (Op::Multiply, self.product(Unit::times)?),
            Operator::Divide => (Op::Divide, self.product(Unit::over)?),
            comparison => {
                let (_, first) = self.pop_equal(2)?;
                let op = match comparison {
                    Operator::Less => Op::Less,
                    Operator::LessEqual => Op::LessEqual,
                    Operator::Greater => Op::Greater,
                    Operator::GreaterEqual => Op::GreaterEqual,
                    Operator::Equal => Op::Equal,
                    _ => Op::NotEqual,
                };
                (op, (Type::Truth, first))
            }
        };
        self.program.push(op);
        self.types.push(result);
        Ok(())
    }

    /// Takes two factors.
    fn product(&mut self, combine: fn(Unit, Unit) -> Option<Unit>) -> Result<(Type, usize), Wrong> {
        let (right, place) = self.pop_number()?;
        let (left, first) = self.pop_number()?;
        if (left, right) == (Type::Bare, Type::Bare) {
            return Ok((Type::Bare, first));
        }
        match combine(left.factor(), right.factor()) {
            Some(unit) => Ok((Type::Number(unit), first)),
            None => wrong(place, "the exponent of a unit is too large"),
        }
    }

    /// Compiles a function. `before` is the node of its last operand.
    fn function(
        &mut self,
        (function, operands): (Function, usize),
        offset: usize,
        before: Option<&Node>,
    ) -> Result<(), Wrong> {
        // The channels of a sensor or motor are combined already.
        if std::mem::take(&mut self.combined) && combination(&NodeKind::Function(function, operands)).is_some() {
            return Ok(());
        }
        let wanted = match function {
            // A mean of a part has returned above.
            Function::Mean => return wrong(offset, "`mean` is for the channels of a sensor or motor"),
            Function::Clamp | Function::If => 3,
            Function::Pow | Function::Min | Function::Max => 2,
            _ => 1,
        };
        if operands != wanted {
            return wrong(offset, format!("{operands} values are where the function needs {wanted}"));
        }
        let (op, kind) = match function {
            Function::Min => (Op::Min, self.pop_equal(2)?.0),
            Function::Max => (Op::Max, self.pop_equal(2)?.0),
            Function::Clamp => (Op::Clamp, self.pop_equal(3)?.0),
            Function::If => {
                let (kind, _) = self.pop_equal(2)?;
                self.pop_truth()?;
                (Op::If, kind)
            }
            Function::Pow => return self.power(offset, before),
            Function::Abs => (Op::Abs, self.pop_number()?.0),
            Function::Sign => {
                let (kind, _) = self.pop_number()?;
                (Op::Sign, if kind == Type::Bare { kind } else { Type::Number(Unit::NONE) })
            }
            Function::Sqrt => {
                let (kind, place) = self.pop_number()?;
                match (kind, kind.factor().root()) {
                    (Type::Bare, _) => (Op::Sqrt, Type::Bare),
                    (_, Some(unit)) => (Op::Sqrt, Type::Number(unit)),
                    _ => return wrong(place, format!("{} has no square root", kind.factor())),
                }
            }
            Function::Exp => (Op::Exp, self.plain(false)?),
            Function::Log => (Op::Log, self.plain(false)?),
            Function::Tanh => (Op::Tanh, self.plain(false)?),
            Function::Sin => (Op::Sin, self.plain(true)?),
            _ => (Op::Cos, self.plain(true)?),
        };
        self.program.push(op);
        self.types.push((kind, offset));
        Ok(())
    }

    /// Takes a number without a unit, or an angle.
    fn plain(&mut self, angle: bool) -> Result<Type, Wrong> {
        let (kind, place) = self.pop_number()?;
        match kind {
            Type::Number(unit) if unit != Unit::NONE && !(angle && unit == Unit::RADIAN) => {
                wrong(place, format!("{unit} is where a number without a unit is needed; divide by a number with it"))
            }
            Type::Number(_) => Ok(Type::Number(Unit::NONE)),
            other => Ok(other),
        }
    }

    /// Compiles a power, whose exponent is the node before it.
    fn power(&mut self, offset: usize, exponent: Option<&Node>) -> Result<(), Wrong> {
        let whole = |value: f64| (value.abs() <= 9.0 && value == f64::from(value as i8)).then_some(value as i8);
        let given = exponent.and_then(|node| match node.kind {
            NodeKind::Number(Number { value, unit: None }) => whole(value),
            _ => None,
        });
        let (_, place) = self.pop();
        let Some(exponent) = given else {
            return wrong(place, "an exponent is a whole number from -9 to 9");
        };
        let (kind, _) = self.pop_number()?;
        let kind = match (kind, kind.factor().to_power(exponent)) {
            (Type::Bare, _) => Type::Bare,
            (_, Some(unit)) => Type::Number(unit),
            _ => return wrong(offset, "the exponent of a unit is too large"),
        };
        self.program.pop_constant();
        self.program.push(Op::Power(exponent));
        self.types.push((kind, offset));
        Ok(())
    }
}

/// Checks if a formula has the same value in each trial, because it contains numbers and times only.
pub(crate) fn is_constant(text: &str) -> bool {
    let is_constant = |node: &Node| match &node.kind {
        NodeKind::Call(call) => !call.quoted && CONSTANT.contains(&call.name.as_str()),
        _ => true,
    };
    parse(text).is_ok_and(|syntax| syntax.nodes.iter().all(is_constant))
}

/// Returns the combination of channels for a function of one operand.
fn combination(kind: &NodeKind) -> Option<Combination> {
    match kind {
        NodeKind::Function(Function::Min, 1) => Some(Combination::Least),
        NodeKind::Function(Function::Max, 1) => Some(Combination::Largest),
        NodeKind::Function(Function::Mean, 1) => Some(Combination::Mean),
        _ => None,
    }
}
