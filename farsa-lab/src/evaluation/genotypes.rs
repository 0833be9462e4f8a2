//! External genotypes: `.gen` files of the 2013 program, and plain lists of genes.

use std::fmt;
use std::path::Path;

use crate::error::Error;
use crate::escaped::Quoted;
use crate::experiment::genotype::Genotype;
use crate::store::bounded;
use crate::strategy::any_strategy::Genome;

/// Most bytes that are read of a file of genotypes.
const MAX_BYTES: u64 = 256_000_000;

/// Number and range of the genes of a genotype.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shape {
    /// Number of genes.
    genes: usize,
    /// Largest gene. The smallest is 0.
    largest: u16,
}

/// A fault of a genotype.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum GenotypeError {
    /// A word that is no gene of the experiment.
    Gene { line: Option<usize>, position: usize, text: String, largest: u16 },
    /// A word that is no real gene.
    Real { position: usize, text: String },
    /// Another number of genes than the experiment has.
    Count { line: Option<usize>, found: usize, expected: usize },
    /// The text ends within a genotype.
    Truncated { line: usize, genes: usize },
    /// There is no genotype at all.
    Nothing,
}

impl fmt::Display for GenotypeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |f: &mut fmt::Formatter<'_>, line: &Option<usize>| match line {
            Some(line) => write!(f, "line {line}: "),
            None => Ok(()),
        };
        match self {
            Self::Gene { line, position, text, largest } => {
                place(f, line)?;
                let text = Quoted(text);
                write!(f, "gene {position} (the first is 0) is {text}, not a whole number from 0 to {largest}")
            }
            Self::Real { position, text } => {
                let text = Quoted(text);
                write!(f, "gene {position} (the first is 0) is {text}, not a finite number")
            }
            Self::Count { line, found, expected } => {
                place(f, line)?;
                write!(f, "{found} genes where {expected} are expected")
            }
            Self::Truncated { line, genes } => {
                write!(f, "line {line}: truncated: the genotype has {genes} genes so far and no END")
            }
            Self::Nothing => f.write_str("there is no genotype in it"),
        }
    }
}

impl Shape {
    /// Builds the shape of the genotypes of an experiment.
    pub(crate) fn from_genotype(genotype: &Genotype) -> Self {
        Self::new(genotype.genes(), genotype.bits())
    }

    pub(crate) fn new(genes: usize, gene_bits: u32) -> Self {
        Self { genes, largest: u16::MAX.checked_shr(u16::BITS.saturating_sub(gene_bits)).unwrap_or(0) }
    }

    fn gene(self, line: Option<usize>, position: usize, text: &str) -> Result<u16, GenotypeError> {
        // A sign is no part of a gene.
        let gene = text.parse().ok().filter(|gene| *gene <= self.largest && !text.starts_with('+'));
        gene.ok_or_else(|| GenotypeError::Gene { line, position, text: text.into(), largest: self.largest })
    }

    fn count(self, line: Option<usize>, genes: Vec<u16>) -> Result<Vec<u16>, GenotypeError> {
        let (found, expected) = (genes.len(), self.genes);
        if found == expected { Ok(genes) } else { Err(GenotypeError::Count { line, found, expected }) }
    }

    /// Genes with commas or blanks between them.
    pub(crate) fn list(self, text: &str) -> Result<Vec<u16>, GenotypeError> {
        let mut genes = Vec::new();
        for part in text.split(',') {
            let mut words = part.split_whitespace().peekable();
            if words.peek().is_none() && !text.trim().is_empty() {
                genes.push(self.gene(None, genes.len(), "")?);
            }
            for word in words {
                genes.push(self.gene(None, genes.len(), word)?);
            }
        }
        self.count(None, genes)
    }

    /// The genotypes of a `.gen` file of the original: each has lines that name it, then a gene on each line, then `END`.
    pub(crate) fn original(self, text: &str) -> Result<Vec<Vec<u16>>, GenotypeError> {
        let mut genotypes = Vec::new();
        let mut genes: Vec<u16> = Vec::new();
        // First line of the current genotype.
        let mut begun = None;
        let mut last = 0;
        for (line, text) in (1..).zip(text.lines()) {
            let text = text.trim();
            if text.is_empty() {
                continue;
            }
            last = line;
            let first = *begun.get_or_insert(line);
            if text == "END" {
                genotypes.push(self.count(Some(first), std::mem::take(&mut genes))?);
                begun = None;
            } else if !genes.is_empty() || !is_title(text) {
                genes.push(self.gene(Some(line), genes.len(), text)?);
            }
        }
        match begun {
            Some(_) => Err(GenotypeError::Truncated { line: last, genes: genes.len() }),
            None if genotypes.is_empty() => Err(GenotypeError::Nothing),
            None => Ok(genotypes),
        }
    }

    /// Reads the genotypes of a file: one of the original's, or a list of genes.
    ///
    /// # Errors
    /// [`Error::Usage`] with the line or the position, or for a file that does not end.
    pub(crate) fn read(self, path: &Path) -> Result<Vec<Vec<u16>>, Error> {
        self.words(path, &bounded::read_stream_text(path, MAX_BYTES)?)
    }

    /// Reads the same where genes may also be reals, as [`written_reals`] writes them.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub(crate) fn read_genomes(self, path: &Path) -> Result<Vec<Genome>, Error> {
        self.genomes(path, &bounded::read_stream_text(path, MAX_BYTES)?)
    }

    /// Reads the genomes in the text of a file.
    pub(crate) fn genomes(self, path: &Path, text: &str) -> Result<Vec<Genome>, Error> {
        if are_reals(text) {
            return Ok(vec![Genome::Reals(
                self.reals(text).map_err(|error| Error::damaged(path, error).into_usage())?,
            )]);
        }
        Ok(self.words(path, text)?.into_iter().map(Genome::Words).collect())
    }

    /// Reads the genome in a list of genes, words or reals.
    pub(crate) fn genome(self, text: &str) -> Result<Genome, GenotypeError> {
        if are_reals(text) { self.reals(text).map(Genome::Reals) } else { self.list(text).map(Genome::Words) }
    }

    /// Real genes with commas or blanks between them.
    fn reals(self, text: &str) -> Result<Vec<f64>, GenotypeError> {
        let words = text.split(',').flat_map(|part| part.split_whitespace());
        let real = |(position, text): (usize, &str)| {
            let gene = text.parse().ok().filter(|gene: &f64| gene.is_finite());
            gene.ok_or_else(|| GenotypeError::Real { position, text: text.into() })
        };
        let genes = words.enumerate().map(real).collect::<Result<Vec<f64>, _>>()?;
        let (found, expected) = (genes.len(), self.genes);
        if found == expected { Ok(genes) } else { Err(GenotypeError::Count { line: None, found, expected }) }
    }

    fn words(self, path: &Path, text: &str) -> Result<Vec<Vec<u16>>, Error> {
        let original = text.lines().map(str::trim).find(|line| !line.is_empty()).is_some_and(is_title);
        let read = if original || text.lines().any(|line| line.trim() == "END") {
            self.original(text)
        } else {
            self.list(text).map(|genes| vec![genes])
        };
        read.map_err(|error| Error::damaged(path, error).into_usage())
    }
}

/// Checks whether a list holds real genes: its first gene has a point or an exponent.
fn are_reals(text: &str) -> bool {
    let first = text.split([',', ' ', '\t', '\n', '\r']).find(|word| !word.is_empty()).unwrap_or_default();
    first.contains(['.', 'e']) && first.starts_with(|c: char| c == '-' || c.is_ascii_digit())
}

/// Checks whether a line before the first gene is a title: `**NET : ...`, `DYNAMICAL NN`.
fn is_title(line: &str) -> bool {
    line.starts_with(|c: char| c == '*' || c.is_ascii_alphabetic())
}

/// Reads the genotypes of a file: a `.gen` file of the original FARSA, or one list of genes with commas or blanks between
/// them.
///
/// A `.gen` file holds one or more genotypes, each of lines that name it (`**NET : ...`, `DYNAMICAL NN`), a gene on each
/// line and the line `END`.
///
/// # Errors
/// [`Error::Usage`] for an unreadable file, and with the line if a genotype is truncated, does not have `genes` genes, or has
/// a gene that is not a whole number below 2^`gene_bits`.
pub fn read_genotypes(path: &Path, genes: usize, gene_bits: u32) -> Result<Vec<Vec<u16>>, Error> {
    Shape::new(genes, gene_bits).read(path)
}

/// Writes a genotype as a `.gen` file with a name of one line. [`read_genotypes`] and the 2013 program read it.
pub(crate) fn written(name: &str, genes: &[u16]) -> String {
    let genes: Vec<String> = genes.iter().map(u16::to_string).collect();
    format!("**NET : {name}\nDYNAMICAL NN\n{}\nEND\n", genes.join("\n"))
}

/// Real genes as a list, one on each line, which reads back as the same numbers.
pub(crate) fn written_reals(genes: &[f64]) -> String {
    let genes: Vec<String> = genes.iter().map(|gene| format!("{gene:?}")).collect();
    genes.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn shape() -> Shape {
        Shape::new(3, 8)
    }

    #[test]
    fn the_originals_files_are_read() {
        let text = "**NET : 500_0_0.wts\nDYNAMICAL NN\n90\n93\n0\nEND\n";
        assert_eq!(shape().original(text), Ok(vec![vec![90, 93, 0]]));
        // Windows' line ends, a last line without one, and several genotypes, with or without the first name.
        let two = format!("{}\r\nDYNAMICAL NN\r\n1\r\n2\r\n255\r\nEND", text.replace('\n', "\r\n"));
        assert_eq!(shape().original(&two), Ok(vec![vec![90, 93, 0], vec![1, 2, 255]]));
    }

    #[test]
    fn what_is_wrong_has_a_line() {
        let wrong = |text: &str| shape().original(text).unwrap_err().to_string();
        let head = "**NET : a\nDYNAMICAL NN\n";
        for (rest, why) in [
            ("9\n8\n7\n", "line 5: truncated: the genotype has 3 genes so far and no END"),
            ("9\n8\n", "line 4: truncated: the genotype has 2 genes so far and no END"),
            ("", "line 2: truncated: the genotype has 0 genes so far and no END"),
            ("9\n8\nEND\n", "line 1: 2 genes where 3 are expected"),
            ("END\n", "line 1: 0 genes where 3 are expected"),
            ("9\n8\n7\n6\nEND\n", "line 1: 4 genes where 3 are expected"),
            ("9\n256\n7\nEND\n", "line 4: gene 1 (the first is 0) is `256`, not a whole number from 0 to 255"),
            ("-9\n8\n7\nEND\n", "line 3: gene 0 (the first is 0) is `-9`, not a whole number from 0 to 255"),
            ("9\n8.5\n7\nEND\n", "line 4: gene 1 (the first is 0) is `8.5`, not a whole number from 0 to 255"),
            ("9O\n8\n7\nEND\n", "line 3: gene 0 (the first is 0) is `9O`, not a whole number from 0 to 255"),
            ("9\n8\n7 6\nEND\n", "line 5: gene 2 (the first is 0) is `7 6`, not a whole number from 0 to 255"),
            (
                "9\n8\nDYNAMICAL NN\n",
                "line 5: gene 2 (the first is 0) is `DYNAMICAL NN`, not a whole number from 0 to 255",
            ),
            ("9\n8\n7\nEND\n\nDYNAMICAL NN\n4\n", "line 9: truncated: the genotype has 1 genes so far and no END"),
        ] {
            assert_eq!(wrong(&format!("{head}{rest}")), why, "{rest:?}");
        }
        let (evil, long) =
            (wrong(&format!("{head}\u{1b}[2J\u{9b}\n")), wrong(&format!("{head}{}\n", "9".repeat(1 << 20))));
        assert!(evil.starts_with("line 3: gene 0 (the first is 0) is `\\u{1b}[2J\\u{9b}`, not"), "{evil}");
        assert!(long.len() < 300, "{}", long.len());
        assert_eq!(wrong(" \n\n"), "there is no genotype in it");
    }

    #[test]
    fn lists_say_which_gene_is_wrong() {
        for text in ["90,93,0", " 90, 93 ,0\n", "90 93\n0\n", "90,93\n0"] {
            assert_eq!(shape().list(text), Ok(vec![90, 93, 0]), "{text:?}");
        }
        let wrong = |text: &str| shape().list(text).unwrap_err().to_string();
        assert_eq!(wrong("90,x,0"), "gene 1 (the first is 0) is `x`, not a whole number from 0 to 255");
        assert_eq!(wrong("90,,0"), "gene 1 (the first is 0) is ``, not a whole number from 0 to 255");
        assert_eq!(wrong("90,93,0,"), "gene 3 (the first is 0) is ``, not a whole number from 0 to 255");
        assert_eq!(wrong("90,93,300"), "gene 2 (the first is 0) is `300`, not a whole number from 0 to 255");
        assert_eq!(wrong("90,93"), "2 genes where 3 are expected");
        assert_eq!(wrong(""), "0 genes where 3 are expected");
        assert_eq!(Shape::new(1, 16).list("65535"), Ok(vec![65535]));
        assert!(Shape::new(1, 16).list("65536").is_err() && Shape::new(1, 1).list("2").is_err());
    }

    #[test]
    fn lists_of_reals_are_told_from_words() {
        assert_eq!(shape().genome("0.5, -1e-3 2"), Ok(Genome::Reals(vec![0.5, -0.001, 2.0])));
        assert_eq!(shape().genome("90,93,0"), Ok(Genome::Words(vec![90, 93, 0])));
        let wrong = |text: &str| shape().genome(text).unwrap_err().to_string();
        assert_eq!(wrong("0.5,x,1"), "gene 1 (the first is 0) is `x`, not a finite number");
        assert_eq!(wrong("0.5,inf,1"), "gene 1 (the first is 0) is `inf`, not a finite number");
        assert_eq!(wrong("0.5,1"), "2 genes where 3 are expected");
        assert_eq!(wrong("90.,93,0,4"), "4 genes where 3 are expected");
    }

    #[test]
    fn a_file_is_text_within_limits() {
        let path = std::env::temp_dir().join(format!("farsa genotypes {}", std::process::id()));
        let read = || read_genotypes(&path, 3, 8).map_err(|error| error.to_string());
        std::fs::write(&path, "1, 2,3\n").unwrap();
        assert_eq!(read(), Ok(vec![vec![1, 2, 3]]));
        let name = path.display();
        std::fs::write(&path, b"1\n2\n\xff\n").unwrap();
        assert_eq!(read(), Err(format!("{name}: line 3: the byte 0xff is no text (UTF-8)")));
        std::fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert_eq!(read(), Err(format!("{name}: has more than 256000000 bytes, the most that is read of it")));
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn the_originals_own_files() {
        // The files are not ours to distribute. CI requires them, and other machines skip the test.
        let named = std::env::var_os("FARSA_FIXTURES").map(std::path::PathBuf::from);
        let must_be_there = named.is_some() || std::env::var_os("CI").is_some_and(|value| value == "true");
        let root = named.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"));
        if !root.join("khepera").is_dir() {
            assert!(!must_be_there, "there is no folder khepera in {}; set FARSA_FIXTURES", root.display());
            eprintln!("skipped: the original's genotypes (set FARSA_FIXTURES)");
            return;
        }
        for (name, first) in [("G500S53.gen", [90, 93, 0]), ("G500S54.gen", [75, 96, 124])] {
            let read = read_genotypes(&Path::new(&root).join("khepera").join(name), 14, 8).unwrap();
            assert_eq!((read.len(), &read[0][..3], read[0].len()), (1, &first[..], 14));
        }
    }

    proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "[0-9A-Z*,. \n\r-]{0,60}") {
            let _ = (shape().original(&text), shape().list(&text));
        }

        #[test]
        fn reals_read_back(genes in prop::array::uniform3(prop::num::f64::NORMAL)) {
            prop_assert_eq!(shape().genome(&written_reals(&genes)), Ok(Genome::Reals(genes.to_vec())));
        }

        #[test]
        fn every_truncation_is_found(genes in prop::array::uniform3(0_u16..256), cut in 0..30_usize) {
            let text = format!("**NET : x\nDYNAMICAL NN\n{}\n{}\n{}\nEND\n", genes[0], genes[1], genes[2]);
            prop_assert_eq!(shape().original(&text), Ok(vec![genes.to_vec()]));
            // Without the last line's end it is whole still.
            let cut = cut.min(text.len() - 2);
            prop_assert!(shape().original(&text[..cut]).is_err());
        }
    }
}
