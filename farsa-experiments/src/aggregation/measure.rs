//! Spread and clusters of robots.

use crate::team::robots::distance;

/// Spread and clusters of robots at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathering {
    /// Sum over the robots of the squared distance to their centroid, in units of the squared diameter of a robot.
    pub dispersion: f64,
    /// Groups of robots with no gap that a robot could pass.
    pub clusters: usize,
    /// Robots in the largest of them.
    pub largest: usize,
}

impl Gathering {
    /// Measures robots of a radius at these places \[m\].
    ///
    /// Source: dispersion and clusters \[Gauci2014\]: two robots are of one cluster if no other fits in between them, their
    /// surfaces less than a diameter apart.
    pub fn new(places: &[[f32; 2]], radius: f64) -> Self {
        let count = places.len().max(1) as f64;
        let sum = |k: usize| places.iter().map(|at| f64::from(at[k])).sum::<f64>() / count;
        let centre = [sum(0), sum(1)];
        let squares: f64 =
            places.iter().flat_map(|at| [0, 1].map(|k| f64::from(at[k]) - centre[k])).map(|x| x * x).sum();
        // Every robot begins as a cluster. Neighbors take the smaller number until nothing changes.
        let mut cluster: Vec<usize> = (0..places.len()).collect();
        let mut changed = true;
        while changed {
            changed = false;
            for (i, a) in places.iter().enumerate() {
                for (j, b) in places.iter().enumerate() {
                    if f64::from(distance(*a, *b)) < 4.0 * radius && cluster[j] < cluster[i] {
                        cluster[i] = cluster[j];
                        changed = true;
                    }
                }
            }
        }
        let size = |number: usize| cluster.iter().filter(|member| **member == number).count();
        let sizes = (0..places.len()).map(size).filter(|size| *size > 0);
        Self {
            dispersion: squares / (4.0 * radius * radius),
            clusters: sizes.clone().count(),
            largest: sizes.max().unwrap_or(0),
        }
    }
}

/// For each robot its mean distance to the others, in units of `whole`, or 0 for a robot that is alone.
pub fn mean_distances(places: &[[f32; 2]], whole: f64) -> Vec<f64> {
    let others = places.len().saturating_sub(1).max(1) as f64;
    let sum = |a: &[f32; 2]| places.iter().map(|b| f64::from(distance(*a, *b))).sum::<f64>();
    places.iter().map(|a| sum(a) / others / whole).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_row_is_one_cluster_and_a_gap_parts_it() {
        let row = |gap: f32| [[0.0, 0.0], [0.3, 0.0], [0.6, 0.0], [0.6 + gap, 0.0]];
        let one = Gathering::new(&row(0.39), 0.1);
        assert_eq!((one.clusters, one.largest), (1, 4));
        let two = Gathering::new(&row(0.41), 0.1);
        assert_eq!((two.clusters, two.largest), (2, 3));
        // Places -1, 1 about the middle: two square meters by 0.04.
        assert!((Gathering::new(&[[0.0, 1.0], [2.0, 1.0]], 0.1).dispersion - 50.0).abs() < 1e-9);
        assert_eq!(Gathering::new(&[[1.0, 1.0]], 0.1), Gathering { dispersion: 0.0, clusters: 1, largest: 1 });
        assert_eq!(mean_distances(&[[0.0, 0.0], [3.0, 4.0], [0.0, 0.0]], 10.0), [0.25, 0.5, 0.25]);
        assert_eq!(mean_distances(&[[0.0, 0.0]], 10.0), [0.0]);
    }

    proptest! {
        /// Clusters against a search from robot to robot, and dispersion against half the mean of all squared distances.
        #[test]
        fn clusters_are_what_a_walk_reaches(places in prop::collection::vec([0.0_f32..3.0, 0.0_f32..3.0], 1..14)) {
            let found = Gathering::new(&places, 0.1);
            let mut seen = vec![false; places.len()];
            let mut sizes = Vec::new();
            for start in 0..places.len() {
                let mut walk = vec![start];
                let mut size = 0;
                while let Some(at) = walk.pop() {
                    if !core::mem::replace(&mut seen[at], true) {
                        size += 1;
                        walk.extend((0..places.len()).filter(|b| f64::from(distance(places[at], places[*b])) < 0.4));
                    }
                }
                sizes.extend((size > 0).then_some(size));
            }
            prop_assert_eq!((found.clusters, Some(found.largest)), (sizes.len(), sizes.into_iter().max()));
            let squares = |a: &[f32; 2]| places.iter().map(|b| f64::from(distance(*a, *b))).map(|d| d * d).sum::<f64>();
            let all: f64 = places.iter().map(squares).sum::<f64>() / (2 * places.len()) as f64 / 0.04;
            prop_assert!((all - found.dispersion).abs() < 1e-3 * (1.0 + all));
        }
    }
}
