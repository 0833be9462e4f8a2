//! The range of each gene, and how what leaves it comes back.

use farsa_num::Stream;

use crate::error::{EvoError, check_range, check_setting};
use crate::population::Population;
use crate::search::Step;

/// The largest size of a bound, so that sums and differences of genes stay finite.
const LARGEST: f64 = 1e100;

/// Refuses sizes of no population, and bounds that are not low to high.
pub(crate) fn check_bounds(population: usize, bounds: &[[f64; 2]]) -> Result<(), EvoError> {
    Population::check(population, bounds.len())?;
    for &[low, high] in bounds {
        for (name, end) in [("the low end of a gene", low), ("the high end of a gene", high)] {
            check_range(name, end, [-LARGEST, LARGEST], "-1e100 to 1e100")?;
        }
        check_setting(low <= high, "the high end of a gene", high, "its low end or more")?;
    }
    Ok(())
}

/// Draws genes \[genes\] uniformly within their bounds.
pub(crate) fn draw_within(genes: &mut [f64], bounds: &[[f64; 2]], stream: &mut Stream) {
    for (gene, &[low, high]) in genes.iter_mut().zip(bounds) {
        *gene = stream.range_f64(low, high);
    }
}

/// Draws the individuals of generation 0 uniformly within their bounds.
pub(crate) fn uniform<C>(step: &Step<'_, C>, size: usize, bounds: &[[f64; 2]]) -> Result<Population<f64>, EvoError> {
    let mut population = Population::new(size, bounds.len())?;
    for (individual, genes) in population.iter_mut().enumerate() {
        draw_within(genes, bounds, &mut step.stream(individual));
    }
    Ok(population)
}

/// Reflects a finite number at the ends of a range as often as necessary. Returns the low end of a range of zero width.
pub(crate) fn reflect(x: f64, [low, high]: [f64; 2]) -> f64 {
    if low <= x && x <= high {
        return x;
    }
    let width = high - low;
    if width <= 0.0 {
        return low;
    }
    // The remainder is exact.
    let rest = (x - low) % (2.0 * width);
    let rest = if rest < 0.0 { rest + 2.0 * width } else { rest };
    // Reflection has the period 2 width: up within the first half, down within the second.
    let within = if rest > width { 2.0 * width - rest } else { rest };
    // The sum may round beyond the high end.
    (low + within).clamp(low, high)
}

/// Checks that the genes of a saved state are within their bounds.
pub(crate) fn check_within(population: &Population<f64>, bounds: &[[f64; 2]]) -> Result<(), EvoError> {
    for genes in population {
        for (&gene, &[low, high]) in genes.iter().zip(bounds) {
            if !(low..=high).contains(&gene) {
                return Err(EvoError::state_content("a gene within its bounds", gene.to_bits()));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_leaves_a_range_is_reflected() {
        let range = [-1.0, 3.0];
        let want =
            [(0.5, 0.5), (3.5, 2.5), (-1.5, -0.5), (7.0, -1.0), (8.0, 0.0), (-5.0, 3.0), (-6.0, 2.0), (11.5, 2.5)];
        for (x, inside) in want {
            assert_eq!(reflect(x, range), inside, "{x}");
        }
        assert_eq!(reflect(9.0, [2.0, 2.0]), 2.0);
    }

    proptest! {
        #[test]
        fn a_reflected_number_is_within(x in -1e101_f64..1e101, low in -1e100_f64..1e100, width in 0.0_f64..1e3) {
            let range = [low, (low + width).min(1e100)];
            let inside = reflect(x, range);
            prop_assert!(range[0] <= inside && inside <= range[1]);
        }
    }
}
