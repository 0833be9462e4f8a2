//! Random and damaged formulas against a second evaluator.

use farsa_lab::Error;
use farsa_num::{Domain, Scalar, Stream, exp, ln, sin_cos, tanh};

use crate::built_in::registry;
use crate::check::source::Source;
use crate::formula::channels::ChannelNames;
use crate::formula::compile::{CompiledCondition, Formula, Quantity, Scope};

/// Quantities with their units and values.
const QUANTITIES: [(&str, &str, f64); 8] = [
    ("distance(lamp)", "m", 0.37),
    ("displacement", "m", -0.21),
    ("time", "s", 1.7),
    ("speed(robot)", "m/s", 0.13),
    ("upright(body = hand)", "", -0.6),
    ("near('the lamp', 0.1 m)", "", 1.0),
    ("max(infrared)", "", 0.83),
    ("'wheels left'", "", 0.25),
];

/// A formula as text with its value.
struct Drawn {
    text: String,
    value: f64,
    /// Binding power of the outermost operator.
    power: u8,
}

struct Draw(Stream);

impl Draw {
    fn below(&mut self, count: u32) -> u32 {
        self.0.below(count)
    }

    fn number(&mut self) -> f64 {
        f64::from(self.below(4000)) / 1000.0
    }

    fn atom(&mut self, unit: &str) -> Drawn {
        let fitting: Vec<_> = QUANTITIES.iter().filter(|(_, known, _)| *known == unit).collect();
        if self.below(3) > 0 && !fitting.is_empty() {
            let (text, _, value) = fitting[self.below(fitting.len() as u32) as usize];
            return Drawn { text: (*text).into(), value: *value, power: 9 };
        }
        let value = self.number();
        if unit == "m" && self.below(3) == 0 {
            return Drawn { text: format!("{value} cm"), value: value * 1.0 / 100.0, power: 9 };
        }
        Drawn { text: format!("{value:?} {unit}"), value, power: 9 }
    }

    /// Draws a number of a unit.
    fn number_of(&mut self, unit: &'static str, depth: u32) -> Drawn {
        if depth == 0 {
            return self.atom(unit);
        }
        let depth = depth - 1;
        match self.below(if unit.is_empty() { 18 } else { 12 }) {
            0 | 1 => {
                let operands = [self.number_of(unit, depth), self.number_of(unit, depth)];
                joined(&operands, "+", 5, |a, b| a + b)
            }
            2 | 3 => {
                let operands = [self.number_of(unit, depth), self.number_of(unit, depth)];
                joined(&operands, "-", 5, |a, b| a - b)
            }
            4 => {
                let operands = [self.number_of("", depth), self.number_of(unit, depth)];
                joined(&operands, "*", 6, |a, b| a * b)
            }
            5 => {
                let (left, right) = match unit {
                    "m/s" => ("m", "s"),
                    "" => ("m", "m"),
                    other => (other, ""),
                };
                let operands = [self.number_of(left, depth), self.number_of(right, depth)];
                joined(&operands, "/", 6, |a, b| a / b)
            }
            6 => {
                let a = self.number_of(unit, depth);
                let text = format!("-{}", inside(&a, 8));
                // A minus sign and a number are one number.
                Drawn { text, value: -a.value, power: 7 }
            }
            7 => {
                let (name, other) = if self.below(2) == 0 { ("min", true) } else { ("max", false) };
                let [a, b] = [self.number_of(unit, depth), self.number_of(unit, depth)];
                let value = match (a.value.is_nan() || b.value.is_nan(), other) {
                    (true, _) => f64::NAN,
                    (_, true) => {
                        if a.value < b.value {
                            a.value
                        } else {
                            b.value
                        }
                    }
                    _ => {
                        if a.value > b.value {
                            a.value
                        } else {
                            b.value
                        }
                    }
                };
                Drawn { text: format!("{name}({}, {})", a.text, b.text), value, power: 9 }
            }
            8 => {
                let a = self.number_of(unit, depth);
                Drawn { text: format!("abs( {})", a.text), value: a.value.abs(), power: 9 }
            }
            9 | 10 => {
                let (condition, [a, b]) =
                    (self.truth(depth), [self.number_of(unit, depth), self.number_of(unit, depth)]);
                let value = if condition.value == 1.0 { a.value } else { b.value };
                Drawn { text: format!("if({}, {}, {})", condition.text, a.text, b.text), value, power: 9 }
            }
            11 => {
                let [a, low] = [self.number_of(unit, depth), self.number_of(unit, 0)];
                let high = self.number();
                let raised = if a.value.is_nan() || a.value > low.value { a.value } else { low.value };
                let value = if raised.is_nan() || raised < high { raised } else { high };
                Drawn { text: format!("clamp({}, {}, {high:?})", a.text, low.text), value, power: 9 }
            }
            12 => {
                let (a, exponent) = (self.number_of("", depth), self.below(7).cast_signed() - 3);
                let mut value = 1.0;
                (0..exponent.abs()).for_each(|_| value *= a.value);
                let value = if exponent < 0 { 1.0 / value } else { value };
                Drawn { text: format!("pow({}, {exponent})", a.text), value, power: 9 }
            }
            kind => {
                let a = self.number_of("", depth);
                let (name, value) = match kind {
                    13 => ("exp", exp(a.value)),
                    14 => ("log", ln(a.value)),
                    15 => ("sin", sin_cos(a.value).0),
                    16 => ("tanh", tanh(a.value)),
                    _ => ("sqrt", Scalar::sqrt(a.value)),
                };
                Drawn { text: format!("{name}({})", a.text), value, power: 9 }
            }
        }
    }

    /// Draws a comparison.
    fn truth(&mut self, depth: u32) -> Drawn {
        let yes = |flag: bool| f64::from(u8::from(flag));
        let inner = depth.saturating_sub(1);
        match self.below(if depth == 0 { 2 } else { 5 }) {
            0 | 1 => {
                let unit = ["m", "s", "m/s", ""][self.below(4) as usize];
                let operands = [self.number_of(unit, inner), self.number_of(unit, inner)];
                match self.below(4) {
                    0 => joined(&operands, "<", 4, |a, b| f64::from(u8::from(a < b))),
                    1 => joined(&operands, ">=", 4, |a, b| f64::from(u8::from(a >= b))),
                    2 => joined(&operands, "==", 4, |a, b| f64::from(u8::from(a == b))),
                    _ => joined(&operands, "!=", 4, |a, b| f64::from(u8::from(a != b))),
                }
            }
            2 => {
                let a = self.truth(inner);
                Drawn { text: format!("not {}", inside(&a, 4)), value: yes(a.value != 1.0), power: 3 }
            }
            3 => {
                let operands = [self.truth(inner), self.truth(inner)];
                joined(&operands, "and", 2, |a, b| a * b)
            }
            _ => {
                let operands = [self.truth(inner), self.truth(inner)];
                joined(&operands, "or", 1, |a, b| 1.0 - (1.0 - a) * (1.0 - b))
            }
        }
    }
}

/// Returns a text, in parentheses if its operator binds less than the given power.
fn inside(drawn: &Drawn, power: u8) -> String {
    if drawn.power < power { format!("({})", drawn.text) } else { drawn.text.clone() }
}

fn joined([a, b]: &[Drawn; 2], operator: &str, power: u8, value: fn(f64, f64) -> f64) -> Drawn {
    // Comparisons are not chained. The other operators group from the left.
    let left = if power == 4 { 5 } else { power };
    let text = format!("{} {operator} {}", inside(a, left), inside(b, power + 1));
    Drawn { text, value: value(a.value, b.value), power }
}

/// Returns the value of a quantity, as in the list.
fn known(quantity: &Quantity) -> f64 {
    let name = match quantity {
        Quantity::Measure(kind, _) if kind.kind == "distance" => "distance(lamp)",
        Quantity::Measure(kind, _) if kind.kind == "displacement" => "displacement",
        Quantity::Measure(kind, _) if kind.kind == "time" => "time",
        Quantity::Measure(kind, _) if kind.kind == "speed" => "speed(robot)",
        Quantity::Measure(kind, _) if kind.kind == "upright" => "upright(body = hand)",
        Quantity::Measure(kind, _) if kind.kind == "near" => "near('the lamp', 0.1 m)",
        Quantity::Channels(channels) if channels.value(&[0.0; 4], &[1.0; 2]) == 1.0 => "'wheels left'",
        _ => "max(infrared)",
    };
    QUANTITIES.iter().find(|(known, ..)| *known == name).map_or(f64::NAN, |(.., value)| *value)
}

fn with_scope<T>(work: impl FnOnce(Scope<'_>) -> T) -> T {
    let sensors = [("infrared".to_owned(), [0, 3]), ("mark".to_owned(), [3, 4])];
    let motors = [("wheels".to_owned(), [0, 2])];
    let inputs = ["infrared 1", "infrared 2", "infrared 3", "mark"].map(str::to_owned);
    let outputs = ["wheels left", "wheels right"].map(str::to_owned);
    let mut source = Source::new("drawn.toml");
    source.registry = registry(&[]).unwrap();
    let channels = ChannelNames { sensors: &sensors, motors: &motors, inputs: &inputs, outputs: &outputs };
    work(Scope { path: "/reward/0/formula", channels, source: &source })
}

fn term(text: &str) -> Result<Formula<f64>, Error> {
    with_scope(|scope| scope.term(text, &mut |quantity, _| Ok((known(quantity), 0))))
}

fn condition(text: &str) -> Result<CompiledCondition<f64>, Error> {
    with_scope(|scope| scope.condition(text, &mut |quantity, _| Ok((known(quantity), 0))))
}

fn value(formula: &Formula<f64>) -> f64 {
    formula.program.evaluate(|number| formula.terms[number])
}

/// Returns the value of a text, and fails with its error.
fn value_of(text: &str) -> f64 {
    value(&term(text).unwrap_or_else(|error| panic!("{error}\n{text}")))
}

fn draw(number: u32) -> (Drawn, Draw) {
    let mut draw = Draw(Stream::new(20_261_130, Domain::General, number, 0, 0));
    let unit = ["", "m", "s", "m/s"][draw.below(4) as usize];
    let depth = 1 + draw.below(4);
    (draw.number_of(unit, depth), draw)
}

#[test]
fn random_formulas_have_the_value_of_a_second_evaluator() {
    let (mut finite, mut longest) = (0, 0);
    let fitting = (0..).map(|number| draw(number).0).filter(|drawn| drawn.text.chars().count() <= 2000);
    for Drawn { text, value, .. } in fitting.take(1000) {
        let found = value_of(&text);
        let same = found.to_bits() == value.to_bits() || found.is_nan() && value.is_nan();
        assert!(same, "{found} where {value} is wanted\n{text}");
        finite += usize::from(found.is_finite());
        longest = longest.max(text.len());
    }
    assert!(finite > 900 && longest > 500, "{finite} finite values, at most {longest} bytes");
}

/// Truncated texts and texts with a wrong character are valid or refused with a column.
#[test]
fn damaged_formulas_are_refused_with_a_column() {
    let mut refused = 0;
    for number in 0..10_000 {
        let (Drawn { text, .. }, mut draw) = draw(number);
        let characters: Vec<char> = text.chars().take(500).collect();
        let place = draw.below(characters.len() as u32) as usize;
        let damaged: String = if draw.below(2) == 0 {
            characters[..place].iter().collect()
        } else {
            let alphabet: Vec<char> =
                "()[]'+-*/<>=!,.0123456789eEabmskNg_ andorntfx\u{e9}\u{1f916}\u{0}^&\"".chars().collect();
            let other = alphabet[draw.below(alphabet.len() as u32) as usize];
            let replaced = |(at, character): (usize, &char)| if at == place { other } else { *character };
            characters.iter().enumerate().map(replaced).collect()
        };
        for error in [term(&damaged).err(), condition(&damaged).err()].into_iter().flatten() {
            let error = error.to_string();
            let column = error.split_once(", column ").and_then(|(_, rest)| rest.split_once(" of the formula"));
            let column = column.and_then(|(column, _)| column.parse::<usize>().ok());
            let most = damaged.chars().count() + 1;
            assert!(column.is_some_and(|column| (1..=most).contains(&column)), "{error}\n{damaged}");
            refused += 1;
        }
    }
    assert!((10_000..20_000).contains(&refused), "{refused}");
}

/// Nesting, length and the number of values are limited.
#[test]
fn hostile_texts_are_refused() {
    for (part, end) in [("(", ")"), ("-", ""), ("not ", ""), ("abs(", ")"), ("1 + (", ")"), ("if(1 < 2, ", ", 1)")] {
        for count in [1, 30, 33, 200, 1_000_000 / part.len()] {
            let center = if part == "not " { "1 < 2" } else { "1" };
            let text = format!("{}{center}{}", part.repeat(count), end.repeat(count));
            let made = if part == "not " { condition(&text).is_ok() } else { term(&text).is_ok() };
            assert_eq!(made, count < 32, "{part} {count} times");
        }
    }
    let sum = "1 + ".repeat(499) + "1";
    assert_eq!(value_of(&sum), 500.0);
    assert_eq!(value_of(&format!("max({}2)", "1, ".repeat(400))), 2.0);
    let values = format!("{}1{}", "1 s / (time + 1 s * abs(".repeat(15), "))".repeat(15));
    assert!(term(&values).is_err_and(|error| error.to_string().contains("too many values")));
    assert!(term(&" ".repeat(2001)).is_err_and(|error| error.to_string().contains("at most 2000")));
    assert!(term("1e999").is_err() && term("").is_err() && term("\u{0}").is_err());
}

#[test]
fn values_are_those_of_the_field() {
    for (text, wanted) in [
        ("2 + 3 * 4 - 6 / 2 / 3", 13.0),
        ("-2 * -3", 6.0),
        ("8 - 4 - 2", 2.0),
        ("pow(2, -3) + pow(-1.5, 2)", 2.375),
        ("sign(-3) + sign(0) * 7 + sign(2 m)", 0.0),
        ("clamp(5 m, 0, 30 cm) / 1 m", 0.3),
        ("min(3, 2, 5) + max(3, 2, 5)", 7.0),
        ("if(not 1 > 2 and (1 < 2 or 2 < 1), 5, 6)", 5.0),
        ("sqrt(pow(3 m, 2)) / 1 mm", 3000.0),
        ("sin(90 deg) + cos(0)", 2.0),
        ("abs(-2 m/s) * 500 ms / 1 cm", 100.0),
        ("exp(0) + tanh(0) + log(1)", 1.0),
        ("distance(lamp) / time - speed", 0.37 / 1.7 - 0.13),
        ("max(infrared) + mean(wheels) * 0 + mark * 0", 0.83),
    ] {
        assert!((value_of(text) - wanted).abs() < 1e-12, "{text}: {}", value_of(text));
    }
    // A quotient of zeros is NaN, which minima, maxima and limits keep. Comparisons with it are false.
    for text in ["0 / 0", "max(0, 0 / 0)", "min(0 / 0, 1)", "clamp(0 / 0, 0, 1)", "sqrt(-1)", "log(-1)"] {
        assert!(value_of(text).is_nan(), "{text}");
    }
    assert_eq!(value_of("if(0 / 0 < 1 or 0 / 0 >= 1, 1, 2)"), 2.0);
    // A broken quantity breaks the value, even where the formula would ignore it.
    let formula = term("if(1 < 2, 1, time)").unwrap();
    assert!(formula.program.evaluate(|_| f64::INFINITY).is_nan());
    assert_eq!(condition("time > 5 for 250 ms").unwrap().duration, Some(0.25));
}

#[test]
fn errors_have_a_column_and_a_reason() {
    for (text, column, why) in [
        ("distance(lamp) + time", 18, "m and s do not match"),
        ("1 - distance(lamp) / 0.3 + time", 28, "m and s do not match"),
        ("exp(distance(lamp))", 5, "m is where a number without a unit is needed"),
        ("sin(time)", 5, "s is where"),
        ("max(time, 1 m)", 11, "s and m do not match"),
        ("if(time > 1 m, 1, 2)", 11, "s and m do not match"),
        ("sqrt(distance(lamp))", 6, "m has no square root"),
        ("distence(lamp)", 1, "unknown quantity `distence`; the nearest is `distance`"),
        ("1 + tim", 5, "unknown quantity `tim`; the nearest is `time`"),
        ("time-1", 1, "a minus sign needs spaces"),
        ("2 + infrared", 5, "write `max(infrared)`"),
        ("'infrared 4'", 1, "unknown channel `infrared 4`"),
        ("0.3 metre", 5, "unknown unit `metre`"),
        ("near(lamp, 2 s)", 12, "s is where m is needed"),
        ("near(lamp)", 1, "lacks its argument `within`"),
        ("near(lamp, 0.1, 0.2)", 17, "no such argument"),
        ("near(lamp, withn = 0.1)", 12, "unknown key `withn`; the nearest is `within`"),
        ("near(hand, ball, object = lamp, within = 0.1)", 12, "no such argument"),
        ("near(lamp, -1)", 12, "-1 is outside 0 to 1000"),
        ("position([1, 0])", 10, "the list has 2 values, 3 are needed"),
        ("steps > 100", 1, "write `step`"),
        ("formula('1')", 1, "unknown quantity"),
        ("1 +", 4, "the formula ends"),
        ("1 + * 2", 5, "`*` is not the start"),
        ("(1 + 2", 1, "the parenthesis does not end"),
        ("max(1 2)", 7, "`2` is where `,` or `)` belongs"),
        ("1 = 2", 3, "written `==`"),
        ("2 ^ 3", 3, "pow(x, 2)"),
        ("1 < 2 < 3", 7, "joined by `and`"),
        ("1 + (1 < 2)", 6, "a comparison is where a number is needed"),
        ("if(1, 2, 3)", 4, "a number is where a comparison is needed"),
        ("pow(2, 0.5)", 8, "an exponent is a whole number"),
        ("max(1)", 1, "1 values are where the function needs 2"),
        ("sqrt", 1, "lacks its parentheses"),
        ("1 < 2 for 1 s", 7, "`for` belongs to conditions"),
        ("\u{e9} + 1", 1, "is not the start"),
        ("'\u{e9}' + \u{e9}", 7, "is not the start"),
    ] {
        let error = term(text).err().unwrap_or_else(|| panic!("nothing is wrong with {text}")).to_string();
        let place = format!("drawn.toml, column {column} of the formula: `reward.1.formula`: ");
        assert!(error.starts_with(&place) && error.contains(why), "{text}: {error}");
    }
    for (text, why) in [
        ("time", "a condition compares"),
        ("time > 1 for 1 m", "needs a time"),
        ("time > 1 for", "lacks a time"),
        ("time > 1 for 1 s and time < 2", "the last part"),
    ] {
        let error = condition(text).err().unwrap_or_else(|| panic!("nothing is wrong with {text}")).to_string();
        assert!(error.contains(why), "{text}: {error}");
    }
}
