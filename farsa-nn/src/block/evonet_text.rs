//! Parsers for the network files `.net` and `.phe` of the original program.

use alloc::vec;
use alloc::vec::Vec;
use core::str::FromStr;

use crate::activation::Activation;
use crate::block::description::{Block, Group, Span};
use crate::block::evonet::EvonetRanges;
use crate::block::layout_buf::BlockLayoutBuf;
use crate::error::Error;
use crate::fault::{ParameterFault, Slice};

/// A network that was read from a file of the original FARSA. Requires the feature `alloc`.
///
/// A `.net` file has these lines:
///
/// | lines | content |
/// |---|---|
/// | `ARCHITECTURE` | |
/// | `nneurons N`, `nsensors n`, `nmotors m`, `nblocks B` | the sensors are the first neurons, the motors the last |
/// | `B` lines of six whole numbers | kind, first and number of the targets, first and number of the sources, unused; kinds are 0 connect, 1 update, 2 gain, 3 gain modulated by the first source |
/// | a line of titles | |
/// | `N` lines of six whole numbers | bias (0, 1), type, gain (0, 1), and three for its display; types are 0 logistic or an input as it is, 1 the same with a leak, 2 step, 3 logistic with slope 0.2 |
/// | `END` | |
///
/// In a `.phe` file there is a line `FREE PARAMETERS P` and `P` additional lines before `END`. Each of these lines
/// contains a parameter, its mutation rate and its name. An asterisk represents a parameter drawn by the evolution or a
/// rate set by it. Older files have no rates and use -99 instead of the asterisk. Empty lines and text after the
/// numbers of a line are ignored.
///
/// Source: `[FARSA2]`. Deviation: an unexpected line is an error, whereas the source continues.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evonet {
    /// Layout of the network.
    pub layout: BlockLayoutBuf,
    /// Parameters in the order of the original program. They are `None` if they are drawn by the evolution. For a
    /// `.net` file the list is empty.
    pub numbers: Vec<Option<f32>>,
    /// Mutation rates of the parameters. They are `None` if they are set by the evolution.
    pub mutations: Vec<Option<f32>>,
}

impl Evonet {
    /// Converts the parameters to the order of a [`BlockLayout`](crate::block::BlockLayout) for the
    /// [`layout`](Self::layout) of this network.
    ///
    /// # Errors
    /// Returns [`Error::Parameter`] if a parameter is drawn by the evolution, or [`Error::Length`] for a `.net` file.
    pub fn parameters(&self, ranges: EvonetRanges) -> Result<Vec<f32>, Error> {
        if let Some(index) = self.numbers.iter().position(Option::is_none) {
            return Err(ParameterFault::NoValue.at(index));
        }
        let layout = self.layout.layout();
        Slice::Parameters.check(layout.parameter_count(), self.numbers.len())?;
        let mut parameters = vec![0.0; self.numbers.len()];
        layout.read_evonet(ranges, self.numbers.iter().flatten().copied(), &mut parameters)?;
        Ok(parameters)
    }
}

impl FromStr for Evonet {
    type Err = Error;

    /// Parses the contents of a `.net` or `.phe` file.
    ///
    /// # Errors
    /// Returns [`Error::Text`] with the number of the line, [`Error::Layout`] if neurons are missing, or
    /// [`Error::Length`] if the number of parameters is wrong.
    fn from_str(text: &str) -> Result<Self, Error> {
        let mut lines = Lines { rest: text, line: 0 };
        lines.begins("ARCHITECTURE")?;
        let neurons = lines.number("nneurons", "`nneurons` and a number")?;
        let inputs = lines.number("nsensors", "`nsensors` and a number")?;
        let outputs = lines.number("nmotors", "`nmotors` and a number")?;
        let count = lines.number("nblocks", "`nblocks` and a number")?;
        let mut layout = BlockLayoutBuf { inputs, outputs, ..BlockLayoutBuf::default() };
        for _ in 0..count {
            let block = lines.six("a block: six whole numbers, the first from 0 to 3")?;
            let [kind, first, targets, from, sources, _] = block;
            let (to, from) = (Span::new(first, targets), Span::new(from, sources));
            layout.blocks.push(match kind {
                0 => Block::connect(from, to),
                1 => Block::Update(to),
                2 => Block::Gain(to),
                3 => Block::ModulatedGain { neurons: to, by: from.first },
                _ => return Err(lines.wrong("a block: six whole numbers, the first from 0 to 3")),
            });
        }
        lines.begins("neurons bias")?;
        for neuron in 0..neurons {
            let expected = "a neuron: six whole numbers, bias and gain 0 or 1, type from 0 to 3";
            let group = match lines.six(expected)? {
                [bias @ 0..=1, kind @ 0..=3, gain @ 0..=1, ..] => {
                    let activation = match kind {
                        _ if neuron < inputs => Activation::Linear,
                        2 => Activation::Step,
                        _ => Activation::Logistic,
                    };
                    let slope = if kind == 3 && neuron >= inputs { 0.2 } else { 1.0 };
                    Group { neurons: 1, activation, slope, bias: bias == 1, gain: gain == 1, leak: kind == 1 }
                }
                _ => return Err(lines.wrong(expected)),
            };
            match layout.groups.last_mut() {
                Some(last) if (Group { neurons: 1, ..*last }) == group => last.neurons += 1,
                _ => layout.groups.push(group),
            }
        }
        let mut network = Self { layout, ..Self::default() };
        let last = lines.next("`END` or `FREE PARAMETERS` and their number")?;
        if let Some(found) = last.strip_prefix("FREE PARAMETERS") {
            let found = found.trim().parse().map_err(|_| lines.wrong("`FREE PARAMETERS` and their number"))?;
            network.layout.layout().check()?;
            Slice::Parameters.check(network.layout.layout().parameter_count(), found)?;
            for _ in 0..found {
                let (number, mutation) = lines.parameter()?;
                network.numbers.push(number);
                network.mutations.push(mutation);
            }
            lines.begins("END")?;
        } else if last != "END" {
            return Err(lines.wrong("`END` or `FREE PARAMETERS` and their number"));
        }
        network.layout.layout().check()?;
        Ok(network)
    }
}

/// The lines that are not empty.
struct Lines<'a> {
    rest: &'a str,
    /// Number of the last line read, from 1.
    line: usize,
}

impl<'a> Lines<'a> {
    fn wrong(&self, expected: &'static str) -> Error {
        Error::Text { line: self.line, expected }
    }

    fn next(&mut self, expected: &'static str) -> Result<&'a str, Error> {
        while !self.rest.is_empty() {
            let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
            self.rest = rest;
            self.line += 1;
            if !line.trim().is_empty() {
                return Ok(line.trim());
            }
        }
        self.line += 1;
        Err(self.wrong(expected))
    }

    fn begins(&mut self, word: &'static str) -> Result<(), Error> {
        if self.next(word)?.starts_with(word) { Ok(()) } else { Err(self.wrong(word)) }
    }

    fn number(&mut self, name: &str, expected: &'static str) -> Result<usize, Error> {
        let number = self.next(expected)?.strip_prefix(name).and_then(|rest| rest.trim().parse().ok());
        number.ok_or_else(|| self.wrong(expected))
    }

    fn six(&mut self, expected: &'static str) -> Result<[usize; 6], Error> {
        let mut words = self.next(expected)?.split_whitespace();
        let mut numbers = [0; 6];
        for number in &mut numbers {
            *number = words.next().and_then(|word| word.parse().ok()).ok_or_else(|| self.wrong(expected))?;
        }
        Ok(numbers)
    }

    /// A parameter and its mutation rate.
    fn parameter(&mut self) -> Result<(Option<f32>, Option<f32>), Error> {
        const EXPECTED: &str = "a parameter: a number or `*`, and its mutation rate";
        let mut words = self.next(EXPECTED)?.split_whitespace();
        let mut word = || match words.next() {
            Some("*") => Some(None),
            Some(word) => word.parse().ok().filter(|number: &f32| number.is_finite()).map(Some),
            None => None,
        };
        let number = word().ok_or_else(|| self.wrong(EXPECTED))?;
        Ok(match word() {
            Some(mutation) => (number, mutation),
            // An older file: given parameters do not mutate.
            None if number == Some(-99.0) => (None, None),
            None => (number, Some(0.0)),
        })
    }
}
