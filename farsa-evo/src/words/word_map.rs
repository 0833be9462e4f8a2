//! Encoding and decoding of parameters as integer genes.

use alloc::vec::Vec;

use crate::error::EvoError;
use crate::words::decode::GeneRange;

/// Code that the bits of a gene are written in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum WordCode {
    /// A plain binary number.
    #[default]
    Plain,
    /// The reflected binary code \[Gray1953\]. The codes of neighboring values differ by one bit.
    Gray,
}

/// Encoding of a single parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum WordGene {
    /// An integer gene. 0 is the low end, the largest number of its bits the high end, linear between.
    Word {
        /// Number of bits, 1 to 16. These are the lowest bits of the gene, and the others are ignored.
        bits: u32,
        /// Low end of the range, in the unit of the parameter.
        low: f32,
        /// High end of the range, which must not be below the low end.
        high: f32,
        /// Code that the bits are written in.
        code: WordCode,
    },
    /// A parameter with a fixed value. It takes no gene.
    Frozen(f32),
}

/// A map between genomes of integers and the parameters that they encode. Each parameter either has its bits, range and
/// code, or it is frozen.
///
/// Where a range has 16 bits and the plain code, the values are those of [`decode`](crate::words::decode).
///
/// ```
/// use farsa_evo::words::{WordCode, WordGene, WordMap};
///
/// let weight = WordGene::Word { bits: 8, low: -5.0, high: 5.0, code: WordCode::Gray };
/// let map = WordMap::new(vec![weight, WordGene::Frozen(1.5), weight])?;
/// assert_eq!((map.words(), map.parameters()), (2, 3));
/// let mut words = [0; 2];
/// map.encode(&[-5.0, 1.5, 3.0], &mut words)?;
/// assert_eq!(words, [0, 204 ^ 204 >> 1]);
/// let mut parameters = [0.0; 3];
/// map.decode(&words, &mut parameters)?;
/// assert_eq!(parameters, [-5.0, 1.5, 3.0]);
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Vec<WordGene>", into = "Vec<WordGene>"))]
pub struct WordMap {
    genes: Vec<WordGene>,
    /// The range of each parameter, of which a frozen one's is that value.
    ranges: Vec<GeneRange>,
    words: usize,
}

impl WordMap {
    /// Creates a map from the encoding of each parameter \[parameters\].
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for no genes, bits outside 1 to 16, and ends or frozen values that are not finite
    /// or not low to high.
    pub fn new(genes: Vec<WordGene>) -> Result<Self, EvoError> {
        if genes.is_empty() {
            return Err(EvoError::no_genes());
        }
        let range = |gene: &WordGene| match *gene {
            WordGene::Word { bits, low, high, .. } => GeneRange::new(1, low, high)?.with_gene_bits(bits),
            WordGene::Frozen(value) => GeneRange::new(0, value, value),
        };
        let ranges: Vec<GeneRange> = genes.iter().map(range).collect::<Result<_, _>>()?;
        let words = ranges.iter().map(|range| range.count()).sum();
        Ok(Self { genes, ranges, words })
    }

    /// Gets the encoding of each parameter \[parameters\].
    pub fn genes(&self) -> &[WordGene] {
        &self.genes
    }

    /// Number of integer genes in a genome. Frozen parameters are not counted.
    pub fn words(&self) -> usize {
        self.words
    }

    /// Number of parameters, including frozen ones.
    pub fn parameters(&self) -> usize {
        self.genes.len()
    }

    /// Decodes integer genes \[words\] into a row of parameters \[parameters\]. This does not allocate.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`]. The row is then unchanged.
    pub fn decode(&self, words: &[u16], parameters: &mut [f32]) -> Result<(), EvoError> {
        self.check(words.len(), parameters.len())?;
        let mut words = words.iter().copied();
        for ((gene, range), parameter) in self.genes.iter().zip(&self.ranges).zip(parameters) {
            *parameter = match *gene {
                WordGene::Frozen(value) => value,
                WordGene::Word { bits, code, .. } => range.decode(number(words.next().unwrap_or_default(), bits, code)),
            };
        }
        Ok(())
    }

    /// Encodes a row of parameters \[parameters\] as the nearest integer genes \[words\]. If a parameter is out of
    /// range, it is set to the nearest end. Ignored bits become 0, and the values of frozen parameters are ignored.
    ///
    /// Decoding the result of an encoding of decoded parameters returns the same parameters. The genes are the same too,
    /// except for ignored bits and for ranges with fewer numbers than genes.
    ///
    /// # Errors
    /// Returns [`EvoError::Shape`], or [`EvoError::OutOfRange`] for a NaN of a parameter that is not frozen. The genes
    /// are then unchanged.
    pub fn encode(&self, parameters: &[f32], words: &mut [u16]) -> Result<(), EvoError> {
        self.check(words.len(), parameters.len())?;
        let pairs = || self.genes.iter().zip(&self.ranges).zip(parameters).filter(|((_, range), _)| range.count() > 0);
        // All parameters are checked before the first word changes.
        if pairs().any(|(_, parameter)| parameter.is_nan()) {
            return Err(EvoError::OutOfRange { field: "a parameter", value: f64::NAN, allowed: "a number" });
        }
        for (((gene, range), &parameter), word) in pairs().zip(words) {
            if let WordGene::Word { bits, low, high, code } = *gene {
                let number = nearest(*range, largest(bits), [low, high], parameter);
                // The Gray code n xor n / 2: successive numbers differ in one bit.
                *word = if code == WordCode::Gray { number ^ number >> 1 } else { number };
            }
        }
        Ok(())
    }

    fn check(&self, words: usize, parameters: usize) -> Result<(), EvoError> {
        let fits = words == self.words && parameters == self.genes.len();
        if fits { Ok(()) } else { Err(EvoError::lengths(words, self.words, parameters)) }
    }
}

fn largest(bits: u32) -> u16 {
    u16::MAX >> u16::BITS.saturating_sub(bits)
}

/// The number that the bits of a word are.
fn number(word: u16, bits: u32, code: WordCode) -> u16 {
    let word = word & largest(bits);
    match code {
        WordCode::Plain => word,
        // Each bit is the exclusive or of all from it upwards.
        WordCode::Gray => [1, 2, 4, 8].into_iter().fold(word, |word, shift| word ^ word >> shift),
    }
}

/// The number whose value is nearest to a parameter.
fn nearest(range: GeneRange, largest: u16, [low, high]: [f32; 2], parameter: f32) -> u16 {
    let parameter = parameter.clamp(low, high);
    let width = f64::from(high) - f64::from(low);
    if width <= 0.0 {
        return 0;
    }
    // The estimate is rounded, so a neighbor may be nearer.
    let about = ((f64::from(parameter) - f64::from(low)) / width * f64::from(largest)) as u16;
    let candidates = about.saturating_sub(1)..=about.saturating_add(2).min(largest);
    let distance = |number: u16| (f64::from(range.decode(number)) - f64::from(parameter)).abs();
    // At a tie `min_by` returns the lower number.
    candidates.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or_default()
}

impl From<WordMap> for Vec<WordGene> {
    fn from(map: WordMap) -> Self {
        map.genes
    }
}

impl TryFrom<Vec<WordGene>> for WordMap {
    type Error = EvoError;

    /// The map of these genes.
    ///
    /// # Errors
    /// Returns the errors of [`WordMap::new`].
    fn try_from(genes: Vec<WordGene>) -> Result<Self, EvoError> {
        Self::new(genes)
    }
}
