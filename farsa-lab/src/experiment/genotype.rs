//! Decoding of genes into parameters.

use farsa_evo::Population;
use farsa_num::Scalar as _;

use crate::experiment::parameter::Parameter;

/// Encoding of parameters as genes, with one gene for each parameter.
///
/// Integer genes are linear. A gene of 0 is the first end of the parameter's range, and the largest gene is the other
/// end. Real genes map -1 to the first end, and 1 to the other. They are reflected beyond these values.
#[derive(Clone, Debug, PartialEq)]
pub struct Genotype {
    ends: Vec<[f64; 2]>,
    bits: u32,
}

impl Genotype {
    /// Creates an encoding with `bits` bits for each gene, from 1 to 16.
    pub fn new(parameters: &[Parameter], bits: u32) -> Self {
        Self { ends: parameters.iter().map(|parameter| parameter.ends).collect(), bits: bits.clamp(1, u16::BITS) }
    }

    /// Gets the number of genes. It is equal to the number of parameters.
    pub fn genes(&self) -> usize {
        self.ends.len()
    }

    /// Gets the number of bits of a gene.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// Gets the largest integer gene.
    pub fn largest(&self) -> u16 {
        u16::MAX >> (u16::BITS - self.bits)
    }

    /// Decodes all individuals. Returns `None` for genomes of another length.
    pub(crate) fn decode_all(&self, genomes: &Population) -> Option<Vec<Vec<f32>>> {
        genomes.iter().map(|genes| self.decode(genes)).collect()
    }

    /// Finds the integer genes that are nearest to these parameters \[[`genes`](Self::genes)\].
    ///
    /// If a parameter is out of its range, you get the gene at the nearest end. If the number of parameters is wrong,
    /// this returns `None`.
    pub fn encode(&self, parameters: &[f64]) -> Option<Vec<u16>> {
        let largest = self.largest();
        let gene = |(parameter, [first, other]): (&f64, &[f64; 2])| {
            let share = (parameter - first) / (other - first);
            // The conversion to an integer stops at 0 and at its largest value.
            ((share * f64::from(largest)).clamp(-1.0, f64::from(largest)).round_small() as u16).min(largest)
        };
        (parameters.len() == self.ends.len()).then(|| parameters.iter().zip(&self.ends).map(gene).collect())
    }

    /// Computes the parameters of integer genes \[[`genes`](Self::genes)\]. If the number of genes is wrong, this
    /// returns `None`.
    ///
    /// Each parameter is computed as `first + (other - first) * gene / largest` in f64, and then rounded to f32. It
    /// is never outside its range, and exact at both ends.
    pub fn decode(&self, genes: &[u16]) -> Option<Vec<f32>> {
        let largest = self.largest();
        let value = |(&gene, &[first, other]): (&u16, &[f64; 2])| {
            if gene >= largest {
                return other as f32;
            }
            within(first + (other - first) * f64::from(gene) / f64::from(largest), [first, other])
        };
        (genes.len() == self.ends.len()).then(|| genes.iter().zip(&self.ends).map(value).collect())
    }

    /// Computes the parameters of real genes \[[`genes`](Self::genes)\]. If the number of genes is wrong, or if a
    /// gene is not finite, this returns `None`.
    ///
    /// Genes are first reflected into -1 to 1. Each parameter is then computed as
    /// `first + (other - first) * (gene + 1) / 2` in f64, and rounded to f32. It is never outside its range, and exact at both ends.
    pub fn decode_reals(&self, genes: &[f64]) -> Option<Vec<f32>> {
        let value = |(&gene, &[first, other]): (&f64, &[f64; 2])| {
            if !gene.is_finite() {
                return None;
            }
            let share = share(gene);
            Some(if share >= 1.0 { other as f32 } else { within(first + (other - first) * share, [first, other]) })
        };
        if genes.len() != self.ends.len() {
            return None;
        }
        genes.iter().zip(&self.ends).map(value).collect()
    }

    /// Finds the real genes of these parameters \[[`genes`](Self::genes)\].
    ///
    /// If a parameter is out of its range, you get the gene at the nearest end. If both ends are equal, the gene is
    /// 0. If the number of parameters is wrong, this returns `None`.
    pub fn encode_reals(&self, parameters: &[f64]) -> Option<Vec<f64>> {
        let gene = |(parameter, [first, other]): (&f64, &[f64; 2])| {
            let share = (parameter - first) / (other - first);
            if share.is_finite() { (2.0 * share - 1.0).clamp(-1.0, 1.0) } else { 0.0 }
        };
        (parameters.len() == self.ends.len()).then(|| parameters.iter().zip(&self.ends).map(gene).collect())
    }
}

/// Where between the ends of its range a finite gene lies [0..1], after these have reflected it.
fn share(gene: f64) -> f64 {
    if (-1.0..=1.0).contains(&gene) {
        return 0.5 * (gene + 1.0);
    }
    // The remainder is exact. The range forth and back has length 4.
    let place = (gene % 4.0 + 5.0) % 4.0;
    0.5 * if place > 2.0 { 4.0 - place } else { place }
}

/// A value as f32, which may have been rounded beyond an end of its range.
fn within(value: f64, [first, other]: [f64; 2]) -> f32 {
    let value = value as f32;
    let (low, high) = (first.min(other) as f32, first.max(other) as f32);
    if value > high {
        high
    } else if value < low {
        low
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_evo::words::{GeneRange, decode};
    use proptest::prelude::*;

    fn genotype(ends: &[[f64; 2]], bits: u32) -> Genotype {
        let parameters: Vec<Parameter> = ends.iter().map(|&ends| Parameter { name: String::new(), ends }).collect();
        Genotype::new(&parameters, bits)
    }

    #[test]
    fn sixteen_bits_are_those_of_the_library() {
        for [low, high] in [[-6.0, 6.0], [0.0, 1.0], [-0.3, 7.1], [-1e30, 1e-3]] {
            let [low, high] = [low as f32, high as f32];
            let range = GeneRange::new(1, low, high).unwrap();
            let ours = genotype(&[[f64::from(low), f64::from(high)]], 16);
            for gene in (0..=u16::MAX).step_by(7).chain([1, u16::MAX - 1, u16::MAX]) {
                let mut theirs = [0.0];
                decode(&[gene], &[range], &mut theirs).unwrap();
                assert_eq!(ours.decode(&[gene]).unwrap(), theirs, "{gene} of {low} to {high}");
            }
        }
    }

    #[test]
    fn the_nearest_gene_of_what_a_gene_stands_for_is_that_gene() {
        for (ends, bits) in [([-20.0, 20.0], 16), ([0.0, 1.0], 16), ([5.0, -5.0], 8), ([-0.3, 7.1], 3)] {
            let genotype = genotype(&[ends], bits);
            for gene in (0..=genotype.largest()).step_by(if bits > 8 { 11 } else { 1 }) {
                let parameter = f64::from(genotype.decode(&[gene]).unwrap()[0]);
                assert_eq!(genotype.encode(&[parameter]), Some(vec![gene]), "{gene} of {ends:?}");
            }
            let [first, other] = ends;
            let beyond = other - first;
            assert_eq!(genotype.encode(&[first - beyond]), Some(vec![0]));
            assert_eq!(genotype.encode(&[other + 1e9 * beyond]), Some(vec![genotype.largest()]));
            // Half way from one gene to the next, and a little less.
            let step = beyond / f64::from(genotype.largest());
            assert_eq!(genotype.encode(&[first + 1.49 * step]), Some(vec![1]));
            assert_eq!(genotype.encode(&[first + 1.51 * step]), Some(vec![2]));
        }
        assert_eq!(genotype(&[[0.0, 1.0]], 16).encode(&[]), None);
    }

    #[test]
    fn reals_have_the_range_from_minus_one_to_one() {
        let both = genotype(&[[5.0, -5.0], [0.0, 1.0]], 16);
        for (gene, [first, other]) in [
            (-1.0, [5.0, 0.0]),
            (0.0, [0.0, 0.5]),
            (1.0, [-5.0, 1.0]),
            (0.5, [-2.5, 0.75]),
            // Reflected at the ends, as often as it takes.
            (1.5, [-2.5, 0.75]),
            (-1.5, [2.5, 0.25]),
            (3.0, [5.0, 0.0]),
            (4.5, [-2.5, 0.75]),
            (-7.0, [-5.0, 1.0]),
        ] {
            assert_eq!(both.decode_reals(&[gene, gene]).unwrap(), [first, other], "{gene}");
        }
        assert_eq!(both.encode_reals(&[2.5, 0.75]).unwrap(), [-0.5, 0.5]);
        assert_eq!(both.encode_reals(&[9.0, 9.0]).unwrap(), [-1.0, 1.0]);
        assert_eq!(genotype(&[[2.0, 2.0]], 16).encode_reals(&[2.0]).unwrap(), [0.0]);
        assert_eq!((both.decode_reals(&[0.0]), both.encode_reals(&[0.0])), (None, None));
        assert_eq!(both.decode_reals(&[0.0, f64::NAN]), None);
        assert_eq!(both.decode_reals(&[f64::INFINITY, 0.0]), None);
    }

    proptest! {
        #[test]
        fn every_real_stands_for_a_value_of_the_range(gene in prop::num::f64::NORMAL, ends in [-1e3..1e3_f64, -1e3..1e3]) {
            let value = genotype(&[ends], 16).decode_reals(&[gene]).unwrap()[0];
            let (low, high) = (ends[0].min(ends[1]) as f32, ends[0].max(ends[1]) as f32);
            prop_assert!(low <= value && value <= high);
        }

        #[test]
        fn reals_of_parameters_stand_for_them(share in 0.0..=1.0_f64, ends in [-1e3..1e3_f64, -1e3..1e3]) {
            let genotype = genotype(&[ends], 16);
            let parameter = ends[0] + (ends[1] - ends[0]) * share;
            let back = genotype.decode_reals(&genotype.encode_reals(&[parameter]).unwrap()).unwrap()[0];
            prop_assert!((f64::from(back) - parameter).abs() <= 1e-6 * (ends[0].abs() + ends[1].abs()));
        }
    }

    #[test]
    fn a_range_may_fall_and_genes_may_be_short() {
        let bytes = genotype(&[[5.0, -5.0], [0.0, 1.0]], 8);
        assert_eq!((bytes.genes(), bytes.bits(), bytes.largest()), (2, 8, 255));
        assert_eq!(bytes.decode(&[0, 0]).unwrap(), [5.0, 0.0]);
        assert_eq!(bytes.decode(&[255, 255]).unwrap(), [-5.0, 1.0]);
        assert_eq!(bytes.decode(&[51, 51]).unwrap(), [3.0, 0.2]);
        assert_eq!(bytes.decode(&[1]), None);
        assert_eq!(genotype(&[[-1.0, 2.0]], 1).decode(&[1]).unwrap(), [2.0]);
    }
}
