//! Crossover of two parents.

use farsa_num::{Stream, exp, ln};

use crate::error::{EvoError, check_range, check_share};
use crate::real::bounds::reflect;

/// Method used to cross two parents. Each child is drawn independently.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Crossover {
    /// No crossover. There is only one parent, and its genes are copied.
    None,
    /// Each gene is one parent's or the other's \[Syswerda1989\].
    Uniform {
        /// Probability (0 to 1) that a gene is the second parent's.
        rate: f64,
    },
    /// BLX-alpha. Each gene is uniform in the interval between the parents' genes, which is widened at both ends by alpha
    /// times its width \[Eshelman1993\]. Genes out of bounds are reflected, where the source has no bounds.
    Blend {
        /// The widening alpha, 0 to 10. 0.5 in the source.
        alpha: f64,
    },
    /// SBX, in the form within bounds of K. Deb's program NSGA-II. Each gene is near one of the parents' genes, as near as
    /// the two are to each other \[Deb1995\]. A gene is crossed with probability 1/2, else it is the first parent's.
    /// Deviations: one child of the pair is made, either with probability 1/2 for each gene. Genes count as equal from
    /// 1e-14 of their range on, not from 1e-14.
    SimulatedBinary {
        /// Distribution index eta, 0 to 1000. With a larger index, children are closer to their parents.
        eta: f64,
    },
}

impl Crossover {
    pub(crate) fn check(self) -> Result<(), EvoError> {
        match self {
            Self::None => Ok(()),
            Self::Uniform { rate } => check_share("the rate of uniform crossover", rate),
            Self::Blend { alpha } => check_range("alpha of blend crossover", alpha, [0.0, 10.0], "0 to 10"),
            Self::SimulatedBinary { eta } => {
                check_range("eta of simulated binary crossover", eta, [0.0, 1000.0], "0 to 1000")
            }
        }
    }

    /// Mixes genes \[genes\], which are the first parent's, with the second's.
    pub(crate) fn apply(self, genes: &mut [f64], second: &[f64], bounds: &[[f64; 2]], stream: &mut Stream) {
        for ((gene, &other), &range) in genes.iter_mut().zip(second).zip(bounds) {
            *gene = match self {
                Self::None => *gene,
                Self::Uniform { rate } => {
                    if stream.uniform_f64() < rate {
                        other
                    } else {
                        *gene
                    }
                }
                Self::Blend { alpha } => {
                    let (low, high) = (gene.min(other), gene.max(other));
                    let beyond = alpha * (high - low);
                    // x = low - alpha d + (1 + 2 alpha) d U with d = high - low. [Eshelman1993].
                    reflect(low - beyond + (high - low + 2.0 * beyond) * stream.uniform_f64(), range)
                }
                Self::SimulatedBinary { eta } => simulated_binary(*gene, other, range, eta, stream),
            };
        }
    }
}

fn simulated_binary(first: f64, second: f64, [low, high]: [f64; 2], eta: f64, stream: &mut Stream) -> f64 {
    let (y1, y2) = (first.min(second), first.max(second));
    let gap = y2 - y1;
    // Equal genes have no spread, and the quotient below needs a gap.
    if stream.uniform_f64() >= 0.5 || gap <= 1e-14 * (high - low) {
        return first;
    }
    let (u, upper) = (stream.uniform_f64(), stream.uniform_f64() < 0.5);
    let room = if upper { high - y2 } else { y1 - low };
    // beta = 1 + 2 room / gap and alpha = 2 - beta^-(eta + 1), which cuts the distribution at the bound.
    let beta = 1.0 + 2.0 * room / gap;
    let alpha = 2.0 - exp(-(eta + 1.0) * ln(beta));
    // beta_q = (u alpha)^(1 / (eta + 1)) if u <= 1 / alpha, else (2 - u alpha)^(-1 / (eta + 1)). [Deb1995].
    let power = if u <= 1.0 / alpha { ln(u * alpha) } else { -ln(2.0 - u * alpha) };
    let spread = exp(power / (eta + 1.0)) * gap;
    (0.5 * (y1 + y2 + if upper { spread } else { -spread })).clamp(low, high)
}
