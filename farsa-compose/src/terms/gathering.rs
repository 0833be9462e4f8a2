//! Spread and clusters of robots.

use farsa_body::Pose;
use farsa_num::Scalar;

/// Spread and clusters of robots at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gathering {
    /// Sum over the robots of the squared distance to their centroid, in units of the squared diameter of a robot.
    pub(crate) dispersion: f64,
    /// Groups of robots with no gap that a robot could pass.
    pub(crate) clusters: usize,
    /// Robots in the largest of them.
    pub(crate) largest: usize,
}

impl Gathering {
    /// Measures robots of a radius \[m\].
    ///
    /// Source: dispersion and clusters \[Gauci2014\]: two robots are of one cluster if no other fits in between them,
    /// their surfaces less than a diameter apart.
    pub(crate) fn new(robots: &[Pose], radius: f64) -> Self {
        let count = robots.len().max(1) as f64;
        let sum = |k: usize| robots.iter().map(|robot| f64::from(robot.position[k])).sum::<f64>() / count;
        let center = [sum(0), sum(1)];
        let squares: f64 = robots
            .iter()
            .flat_map(|robot| [0, 1].map(|k| f64::from(robot.position[k]) - center[k]))
            .map(|x| x * x)
            .sum();
        // Every robot begins as a cluster. Neighbors take the smaller number until nothing changes.
        let mut cluster: Vec<usize> = (0..robots.len()).collect();
        // Numbers only decrease, so the loop ends.
        let mut changed = true;
        while changed {
            changed = false;
            for (i, a) in robots.iter().enumerate() {
                for (j, b) in robots.iter().enumerate() {
                    // Surfaces less than a diameter apart, |p_i - p_j| - 2 r < 2 r.
                    if f64::from(distance(a, b)) < 4.0 * radius && cluster[j] < cluster[i] {
                        cluster[i] = cluster[j];
                        changed = true;
                    }
                }
            }
        }
        let size = |number: usize| cluster.iter().filter(|member| **member == number).count();
        let sizes = (0..robots.len()).map(size).filter(|size| *size > 0);
        Self {
            // sum |p_i - c|^2 / (2 r)^2 [Gauci2014].
            dispersion: squares / (4.0 * radius * radius),
            clusters: sizes.clone().count(),
            largest: sizes.max().unwrap_or(0),
        }
    }
}

/// Computes the distance between the centers of two robots \[m\].
pub(crate) fn distance(a: &Pose, b: &Pose) -> f32 {
    let [x, y] = [0, 1].map(|k| a.position[k] - b.position[k]);
    Scalar::sqrt(x * x + y * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn gathering(places: &[[f32; 2]]) -> Gathering {
        Gathering::new(&places.iter().map(|at| Pose::planar(*at, 0.0)).collect::<Vec<_>>(), 0.1)
    }

    #[test]
    fn a_row_is_one_cluster_and_a_gap_parts_it() {
        let row = |gap: f32| [[0.0, 0.0], [0.3, 0.0], [0.6, 0.0], [0.6 + gap, 0.0]];
        let near = gathering(&row(0.39));
        assert_eq!((near.clusters, near.largest), (1, 4));
        let far = gathering(&row(0.41));
        assert_eq!((far.clusters, far.largest), (2, 3));
        // Places -1, 1 about the center: two square meters by 0.04.
        assert!((gathering(&[[0.0, 1.0], [2.0, 1.0]]).dispersion - 50.0).abs() < 1e-9);
        assert_eq!(gathering(&[[1.0, 1.0]]), Gathering { dispersion: 0.0, clusters: 1, largest: 1 });
    }

    proptest! {
        /// Clusters against a search from robot to robot, and dispersion against half the mean of all squared distances.
        #[test]
        fn clusters_are_those_of_a_search(places in prop::collection::vec([0.0_f32..3.0, 0.0_f32..3.0], 1..14)) {
            let measured = gathering(&places);
            let far = |a: usize, b: usize| {
                let [x, y] = [0, 1].map(|k| places[a][k] - places[b][k]);
                f64::from(Scalar::sqrt(x * x + y * y))
            };
            let mut seen = vec![false; places.len()];
            let mut sizes = Vec::new();
            for start in 0..places.len() {
                let mut walk = vec![start];
                let mut size = 0;
                while let Some(at) = walk.pop() {
                    if !core::mem::replace(&mut seen[at], true) {
                        size += 1;
                        walk.extend((0..places.len()).filter(|other| far(at, *other) < 0.4));
                    }
                }
                sizes.extend((size > 0).then_some(size));
            }
            prop_assert_eq!((measured.clusters, Some(measured.largest)), (sizes.len(), sizes.into_iter().max()));
            let squares = |a: usize| (0..places.len()).map(|b| far(a, b) * far(a, b)).sum::<f64>();
            let all: f64 = (0..places.len()).map(squares).sum::<f64>() / (2 * places.len()) as f64 / 0.04;
            prop_assert!((all - measured.dispersion).abs() < 1e-3 * (1.0 + all));
        }
    }
}
