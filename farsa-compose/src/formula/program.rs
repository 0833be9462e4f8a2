//! Compiled formulas.

use farsa_num::{Scalar, exp, ln, sin_cos, tanh};

/// Values that an evaluation can hold, and those of most formulas, both powers of two.
const STACK: usize = 32;
const SMALL_STACK: usize = 8;

/// An instruction of a stack machine. Truths are 1 and 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Op {
    Constant(f64),
    /// Value of a quantity, by number.
    Load(u32),
    Negate,
    Not,
    Add,
    Subtract,
    Multiply,
    Divide,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Min,
    Max,
    Abs,
    Sign,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tanh,
    Power(i8),
    Clamp,
    If,
    /// Operations with a constant on the right.
    AddConstant(f64),
    SubtractConstant(f64),
    MultiplyConstant(f64),
    DivideConstant(f64),
    LessConstant(f64),
    GreaterConstant(f64),
    MinRight(f64),
    MaxRight(f64),
    /// Operations with a constant on the left.
    SubtractFrom(f64),
    DivideInto(f64),
    MinLeft(f64),
    MaxLeft(f64),
}

impl Op {
    /// Returns the number of values that the instruction takes from the stack.
    pub(crate) fn operands(self) -> usize {
        match self {
            Self::Constant(_) | Self::Load(_) => 0,
            Self::Clamp | Self::If => 3,
            Self::Add
            | Self::Subtract
            | Self::Multiply
            | Self::Divide
            | Self::Less
            | Self::LessEqual
            | Self::Greater
            | Self::GreaterEqual
            | Self::Equal
            | Self::NotEqual
            | Self::And
            | Self::Or
            | Self::Min
            | Self::Max => 2,
            _ => 1,
        }
    }

    /// Returns the operation with a constant on the right, if there is one.
    fn with_right(self, x: f64) -> Option<Self> {
        Some(match self {
            Self::Add => Self::AddConstant(x),
            Self::Subtract => Self::SubtractConstant(x),
            Self::Multiply => Self::MultiplyConstant(x),
            Self::Divide => Self::DivideConstant(x),
            Self::Less => Self::LessConstant(x),
            Self::Greater => Self::GreaterConstant(x),
            Self::Min => Self::MinRight(x),
            Self::Max => Self::MaxRight(x),
            _ => return None,
        })
    }

    /// Returns the operation with a constant on the left, if there is one. Sums and products have no order.
    fn with_left(self, x: f64) -> Option<Self> {
        Some(match self {
            Self::Add => Self::AddConstant(x),
            Self::Subtract => Self::SubtractFrom(x),
            Self::Multiply => Self::MultiplyConstant(x),
            Self::Divide => Self::DivideInto(x),
            Self::Less => Self::GreaterConstant(x),
            Self::Greater => Self::LessConstant(x),
            Self::Min => Self::MinLeft(x),
            Self::Max => Self::MaxLeft(x),
            _ => return None,
        })
    }
}

/// Instructions in the order of their evaluation.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Program {
    ops: Vec<Op>,
    store: Store,
}

/// Where values are during an evaluation. Smaller stacks take fewer instructions to clear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Store {
    /// In a register: one quantity, then operations of one operand.
    Register,
    SmallStack,
    #[default]
    Stack,
}

/// A program under construction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Assembly {
    ops: Vec<Op>,
    /// First instruction of each value on the stack.
    starts: Vec<usize>,
    /// Most values on the stack.
    most: usize,
}

impl Assembly {
    /// Appends an instruction. One with a constant operand includes the constant.
    pub(crate) fn push(&mut self, op: Op) {
        let first = self.starts.len().saturating_sub(op.operands());
        let start = self.starts.get(first).copied().unwrap_or(self.ops.len());
        let middle = self.starts.get(first + 1).copied().filter(|_| op.operands() == 2);
        self.starts.truncate(first);
        self.starts.push(start);
        self.most = self.most.max(self.starts.len());
        let (left, right) = match middle {
            Some(middle) => (&self.ops[start..middle], &self.ops[middle..]),
            None => (&[][..], &[][..]),
        };
        let fused = match (left, right) {
            (_, [Op::Constant(x)]) => op.with_right(*x).map(|op| (self.ops.len() - 1, op)),
            ([Op::Constant(x)], _) => op.with_left(*x).map(|op| (start, op)),
            _ => None,
        };
        self.ops.push(fused.map_or(op, |(_, op)| op));
        if let Some((constant, _)) = fused {
            self.ops.remove(constant);
        }
    }

    /// Removes the last instruction, which must be a constant.
    pub(crate) fn pop_constant(&mut self) {
        self.ops.pop();
        self.starts.pop();
    }

    /// Checks if the values fit on the stack.
    pub(crate) fn fits(&self) -> bool {
        self.most <= STACK
    }

    /// Returns the program.
    pub(crate) fn finish(self) -> Program {
        let store = match &self.ops[..] {
            [Op::Load(_), rest @ ..] if rest.iter().all(|op| op.operands() == 1) => Store::Register,
            _ if self.most <= SMALL_STACK => Store::SmallStack,
            _ => Store::Stack,
        };
        Program { ops: self.ops, store }
    }
}

impl Program {
    /// Checks if the value is that of a single quantity.
    pub(crate) fn is_one_quantity(&self) -> bool {
        matches!(self.ops[..], [Op::Load(_)])
    }

    /// Checks if the value is that of a single quantity after operations of one operand.
    pub(crate) fn is_of_one_quantity(&self) -> bool {
        self.store == Store::Register
    }

    /// Computes the value from its single quantity.
    #[inline(always)]
    pub(crate) fn of_one_quantity(&self, quantity: f64) -> f64 {
        let value = self.ops.iter().skip(1).fold(quantity, |x, op| unary(*op, x));
        if quantity.is_finite() { value } else { f64::NAN }
    }

    /// Computes the value, with quantities from `load`. It is NaN if one of them is not finite.
    #[inline(always)]
    pub(crate) fn evaluate(&self, load: impl FnMut(usize) -> f64) -> f64 {
        match self.store {
            Store::Register => self.run_in_register(load),
            Store::SmallStack => self.evaluate_on::<SMALL_STACK>(load),
            Store::Stack => self.evaluate_on::<STACK>(load),
        }
    }

    #[inline(always)]
    fn run_in_register(&self, mut load: impl FnMut(usize) -> f64) -> f64 {
        let Some(Op::Load(number)) = self.ops.first() else { return f64::NAN };
        self.of_one_quantity(load(*number as usize))
    }

    /// Separate, because its stack would slow down formulas without one.
    #[inline(never)]
    fn evaluate_on<const N: usize>(&self, mut load: impl FnMut(usize) -> f64) -> f64 {
        let mut stack = [0.0_f64; N];
        // The number of values, of which `top` is the last. It is in a register, and below it are those of the stack.
        let (mut count, mut top) = (0_usize, 0.0_f64);
        let mut broken = false;
        for op in &self.ops {
            // Programs whose values do not fit are refused when they are compiled, so the mask changes no index.
            let mut below = || {
                count = count.wrapping_sub(1);
                stack[count % N]
            };
            top = match op {
                Op::Constant(_) | Op::Load(_) => {
                    stack[count % N] = top;
                    count = count.wrapping_add(1);
                    if let Op::Load(number) = op {
                        let value = load(*number as usize);
                        broken |= !value.is_finite();
                        value
                    } else if let Op::Constant(x) = op {
                        *x
                    } else {
                        top
                    }
                }
                Op::Add => below() + top,
                Op::Subtract => below() - top,
                Op::Multiply => below() * top,
                Op::Divide => below() / top,
                Op::Less => yes(below() < top),
                Op::LessEqual => yes(below() <= top),
                Op::Greater => yes(below() > top),
                Op::GreaterEqual => yes(below() >= top),
                Op::Equal => yes(below() == top),
                Op::NotEqual => yes(below() != top),
                Op::And => yes(below() == 1.0 && top == 1.0),
                Op::Or => yes(below() == 1.0 || top == 1.0),
                Op::Min => smaller(below(), top),
                Op::Max => larger(below(), top),
                Op::Clamp => {
                    let low = below();
                    smaller(larger(below(), low), top)
                }
                Op::If => {
                    let chosen = below();
                    if below() == 1.0 { chosen } else { top }
                }
                _ => unary(*op, top),
            };
        }
        if broken { f64::NAN } else { top }
    }
}

/// Computes an operation of one operand.
#[inline(always)]
fn unary(op: Op, x: f64) -> f64 {
    match op {
        Op::Negate => -x,
        Op::Not => 1.0 - x,
        Op::AddConstant(y) => x + y,
        Op::SubtractConstant(y) => x - y,
        Op::MultiplyConstant(y) => x * y,
        Op::DivideConstant(y) => x / y,
        Op::LessConstant(y) => yes(x < y),
        Op::GreaterConstant(y) => yes(x > y),
        Op::MinRight(y) => smaller(x, y),
        Op::MaxRight(y) => larger(x, y),
        Op::SubtractFrom(y) => y - x,
        Op::DivideInto(y) => y / x,
        Op::MinLeft(y) => smaller(y, x),
        Op::MaxLeft(y) => larger(y, x),
        Op::Abs => Scalar::abs(x),
        Op::Sign => sign(x),
        Op::Sqrt => Scalar::sqrt(x),
        _ => transcendental(op, x),
    }
}

/// Computes a function of one number. Separate, because it is large and rare.
#[inline(never)]
fn transcendental(op: Op, x: f64) -> f64 {
    match op {
        Op::Exp => exp(x),
        Op::Log => ln(x),
        Op::Sin => sin_cos(x).0,
        Op::Cos => sin_cos(x).1,
        Op::Tanh => tanh(x),
        Op::Power(exponent) => power(x, exponent),
        _ => f64::NAN,
    }
}

fn yes(flag: bool) -> f64 {
    if flag { 1.0 } else { 0.0 }
}

/// Returns the smaller number, or NaN if either is NaN.
fn smaller(a: f64, b: f64) -> f64 {
    if a.is_nan() { a } else { Scalar::min(a, b) }
}

/// Returns the larger number, or NaN if either is NaN.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() { a } else { Scalar::max(a, b) }
}

/// Returns 1, -1, or a zero or NaN as it is.
fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        x
    }
}

/// Multiplies from the left. A negative exponent is the reciprocal of the positive one.
fn power(x: f64, exponent: i8) -> f64 {
    let product = (0..exponent.unsigned_abs()).fold(1.0, |product, _| product * x);
    if exponent < 0 { 1.0 / product } else { product }
}
