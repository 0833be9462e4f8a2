//! A centroidal Voronoi tessellation.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Domain, Stream};

use crate::archives::grid_cells::Cells;
use crate::archives::nearest::Nearest;
use crate::error::{EvoError, check_range, check_setting};
use crate::population::Population;
use crate::real::bounds::{check_bounds, draw_within};

/// The most iterations of k-means.
const ITERATIONS: usize = 50;
/// The largest size of a centroid's coordinate.
const LARGEST: f64 = 1e100;

/// A centroidal Voronoi tessellation. Measures belong to the nearest centroid, and centroids are spread evenly over the
/// ranges of any number of measures.
///
/// The centroids result from k-means \[Lloyd1982\] over points that are uniform within the ranges. It starts with the first
/// points and ends when no point changes its centroid, or after 50 iterations. A centroid without points stays where it is.
/// Point `i` is drawn from the stream (seed, [`Domain::General`], trial 0, `i`, 0). A k-d tree \[Bentley1975\] finds the
/// nearest centroid exactly, the first among equals.
///
/// Source: \[Vassiliades2018\]. Start and end of k-means are ours.
///
/// ```
/// use farsa_evo::archives::{Cells, CvtCells};
///
/// let cells = CvtCells::new(100, &[[-1.0, 1.0]; 2], 5000, 1)?;
/// let centroid = &cells.centroids()[14..16];
/// assert_eq!((cells.cells(), cells.cell(centroid)), (100, 7));
/// # Ok::<(), farsa_evo::EvoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "RawCells", into = "RawCells"))]
pub struct CvtCells {
    d: usize,
    /// [cells x d]
    centroids: Vec<f64>,
    nearest: Nearest,
}

impl CvtCells {
    /// Builds the given number of cells over these ranges \[d\], from low to high. You need at least as many points as
    /// cells, and ten points for each cell are usually enough.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for no ranges, no cells or too many, [`EvoError::OutOfRange`] for other numbers.
    pub fn new(cells: usize, bounds: &[[f64; 2]], points: usize, seed: u64) -> Result<Self, EvoError> {
        check_bounds(cells, bounds)?;
        check_setting(points >= cells, "the number of points", points as f64, "as many as cells, or more")?;
        let mut drawn = Population::new(points, bounds.len())?;
        for (number, point) in drawn.iter_mut().enumerate() {
            draw_within(point, bounds, &mut Stream::new(seed, Domain::General, 0, number as u32, 0));
        }
        let first = drawn.as_slice().iter().take(cells * bounds.len()).copied().collect();
        Self::from_centroids(k_means(first, drawn.as_slice(), bounds.len()), bounds.len())
    }

    /// Creates cells from existing centroids [cells x d]. Use this to reuse a tessellation. Each coordinate can have a
    /// magnitude of up to 10^100.
    ///
    /// # Errors
    /// Returns [`EvoError::Config`] for d = 0, no centroids or too many. [`EvoError::Shape`] for an incomplete last
    /// one. [`EvoError::OutOfRange`] for a coordinate.
    pub fn from_centroids(centroids: Vec<f64>, d: usize) -> Result<Self, EvoError> {
        let cells = centroids.len().checked_div(d).ok_or_else(EvoError::no_genes)?;
        Population::check(cells, d)?;
        if centroids.len() != cells * d {
            return Err(EvoError::score_count(d, centroids.len()));
        }
        for &x in &centroids {
            check_range("a coordinate of a centroid", x, [-LARGEST, LARGEST], "-1e100 to 1e100")?;
        }
        let nearest = Nearest::new(&centroids, d);
        Ok(Self { d, centroids, nearest })
    }

    /// Gets the centroids [cells x d].
    pub fn centroids(&self) -> &[f64] {
        &self.centroids
    }
}

/// Moves centroids [cells x d] to the means of the points [points x d] that are nearest to them, again and again.
fn k_means(mut centroids: Vec<f64>, points: &[f64], d: usize) -> Vec<f64> {
    // No centroid has this number, so the first pass counts as a change.
    let mut owners = vec![usize::MAX; points.len() / d];
    for _ in 0..ITERATIONS {
        let nearest = Nearest::new(&centroids, d);
        let (mut sums, mut counts) = (vec![0.0; centroids.len()], vec![0_u32; centroids.len() / d]);
        let mut changed = false;
        for (point, owner) in points.chunks_exact(d).zip(&mut owners) {
            let found = nearest.find(point);
            changed |= found != *owner;
            *owner = found;
            counts[found] += 1;
            sums[found * d..(found + 1) * d].iter_mut().zip(point).for_each(|(sum, x)| *sum += x);
        }
        if !changed {
            break;
        }
        for ((centroid, sum), &count) in centroids.chunks_exact_mut(d).zip(sums.chunks_exact(d)).zip(&counts) {
            if count > 0 {
                centroid.iter_mut().zip(sum).for_each(|(x, sum)| *x = sum / f64::from(count));
            }
        }
    }
    centroids
}

impl Cells for CvtCells {
    fn cells(&self) -> usize {
        self.centroids.len() / self.d
    }

    fn measures(&self) -> usize {
        self.d
    }

    fn cell(&self, measures: &[f64]) -> usize {
        self.nearest.find(measures)
    }
}

/// Cells as they are saved: the tree follows from the centroids.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "CvtCells")]
struct RawCells {
    d: usize,
    centroids: Vec<f64>,
}

#[cfg(feature = "serde")]
impl From<CvtCells> for RawCells {
    fn from(CvtCells { d, centroids, .. }: CvtCells) -> Self {
        Self { d, centroids }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<RawCells> for CvtCells {
    type Error = EvoError;

    fn try_from(raw: RawCells) -> Result<Self, EvoError> {
        Self::from_centroids(raw.centroids, raw.d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plain Lloyd, comparing with all.
    fn lloyd(mut centroids: Vec<[f64; 2]>, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let square = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
        for _ in 0..ITERATIONS {
            let mut sums = vec![[0.0, 0.0, 0.0]; centroids.len()];
            for point in points {
                let near =
                    |a: &usize, b: &usize| square(centroids[*a], *point).total_cmp(&square(centroids[*b], *point));
                let owner = (0..centroids.len()).min_by(near).unwrap();
                sums[owner] = [sums[owner][0] + point[0], sums[owner][1] + point[1], sums[owner][2] + 1.0];
            }
            for (centroid, [x, y, count]) in centroids.iter_mut().zip(sums) {
                *centroid = if count > 0.0 { [x / count, y / count] } else { *centroid };
            }
        }
        centroids
    }

    #[test]
    fn centroids_are_those_of_plain_k_means() {
        let bounds = [[-2.0, 2.0], [0.0, 1.0]];
        let cells = CvtCells::new(30, &bounds, 900, 5).unwrap();
        let draw = |i: u32| {
            let mut stream = Stream::new(5, Domain::General, 0, i, 0);
            bounds.map(|[low, high]| stream.range_f64(low, high))
        };
        let points: Vec<[f64; 2]> = (0..900).map(draw).collect();
        assert_eq!(cells.centroids(), lloyd(points[..30].to_vec(), &points).as_flattened());
    }

    #[test]
    fn cells_are_of_even_size() {
        let cells = CvtCells::new(50, &[[0.0, 1.0]; 2], 5000, 1).unwrap();
        let mut counts = [0_u32; 50];
        for i in 0..50_000 {
            let mut stream = Stream::from_seed(i);
            counts[cells.cell(&[stream.uniform_f64(), stream.uniform_f64()])] += 1;
        }
        // 1000 each. Without k-means the cells of 50 points would have from 100 to 3000.
        assert!(counts.iter().all(|count| (400..1700).contains(count)), "{counts:?}");
    }

    #[test]
    fn impossible_cells_are_refused() {
        let new = |cells, points| CvtCells::new(cells, &[[0.0, 1.0]], points, 1).unwrap_err();
        assert_eq!(new(0, 10), EvoError::no_individuals());
        assert!(matches!(new(11, 10), EvoError::OutOfRange { field: "the number of points", value: 10.0, .. }));
        assert_eq!(CvtCells::new(1, &[], 10, 1), Err(EvoError::no_genes()));
        let from = |centroids: &[f64], d| CvtCells::from_centroids(centroids.to_vec(), d).unwrap_err();
        assert_eq!((from(&[], 2), from(&[1.0], 0)), (EvoError::no_individuals(), EvoError::no_genes()));
        assert_eq!(from(&[1.0, 2.0, 3.0], 2), EvoError::score_count(2, 3));
        assert!(matches!(from(&[1.0, f64::NAN], 1), EvoError::OutOfRange { field: "a coordinate of a centroid", .. }));
    }
}
