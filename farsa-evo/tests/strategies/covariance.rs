//! Covariance matrix adaptation against a transcription of its equations, on test functions, and against bad input.

use crate::errors;
use farsa_evo::covariance::{CholeskyCmaEs, CmaEs, CmaEsConfig, SeparableCmaEs, SeparableCmaEsConfig};
use farsa_evo::{EvoError, Fitness, RecordKind, Snapshot, Strategy, check_strategy};
use farsa_num::Digest;
use proptest::prelude::*;

type Function = fn(&[f64]) -> f64;

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// The ellipsoid of condition 10^6, with factors that `f64` holds exactly enough.
fn ellipsoid(x: &[f64]) -> f64 {
    let last = (x.len() - 1).max(1) as f64;
    let factor = |index: usize| farsa_num::exp(6.0 * core::f64::consts::LN_10 * index as f64 / last);
    x.iter().enumerate().map(|(index, x)| factor(index) * x * x).sum()
}

fn rosenbrock(x: &[f64]) -> f64 {
    let term = |pair: &[f64]| {
        let (bend, rest) = (pair[1] - pair[0] * pair[0], 1.0 - pair[0]);
        100.0 * bend * bend + rest * rest
    };
    x.windows(2).map(term).sum()
}

/// Counts the evaluations until the function is below 10^-8.
fn evaluations(strategy: &mut dyn Strategy<f64>, limit: usize, function: fn(&[f64]) -> f64) -> usize {
    let mut count = 0;
    while count < limit {
        let values: Vec<f64> = strategy.ask().iter().map(|x| -function(x)).collect();
        count += values.len();
        if values.iter().any(|value| *value > -1e-8) {
            return count;
        }
        strategy.tell_values(&values).unwrap();
    }
    panic!("{limit} evaluations do not suffice");
}

fn cma(mean: f64, genes: usize, sigma: f64) -> CmaEsConfig {
    CmaEsConfig::new(vec![mean; genes], sigma)
}

#[test]
fn test_functions_are_solved_within_the_usual_evaluations() {
    let mean = |config: &CmaEsConfig, function: fn(&[f64]) -> f64| {
        let run = |seed| evaluations(&mut CmaEs::new(config.clone(), seed).unwrap(), 50_000, function);
        (0..5).map(run).sum::<usize>() / 5
    };
    let triangular = |config: &CmaEsConfig, function: fn(&[f64]) -> f64| {
        let run =
            |seed| evaluations(&mut CholeskyCmaEs::with_covariance(config.clone(), seed).unwrap(), 50_000, function);
        (0..5).map(run).sum::<usize>() / 5
    };
    // The expected values are the means of pycma 4.5.0.
    let cases: [(CmaEsConfig, Function, usize); 6] = [
        (cma(1.0, 5, 0.5), sphere, 622),
        (cma(1.0, 10, 0.5), sphere, 1370),
        (cma(1.0, 5, 0.5), ellipsoid, 1443),
        (cma(1.0, 10, 0.5), ellipsoid, 3986),
        (cma(0.0, 5, 0.5), rosenbrock, 1720),
        (cma(0.0, 10, 0.5), rosenbrock, 4860),
    ];
    for (config, function, usual) in &cases {
        for found in [mean(config, *function), triangular(config, *function)] {
            assert!(10 * found <= 11 * usual, "{found} evaluations, usual {usual}");
        }
    }
}

#[test]
fn the_diagonal_learns_many_variances_sooner() {
    let full = evaluations(&mut CmaEs::new(cma(1.0, 30, 0.5), 1).unwrap(), 100_000, ellipsoid);
    let config = SeparableCmaEsConfig::new(vec![1.0; 30], 0.5);
    let mut search = SeparableCmaEs::with_covariance(config, 1).unwrap();
    let separable = evaluations(&mut search, 100_000, ellipsoid);
    assert!(2 * separable < full, "{separable} and {full} evaluations");
    assert!((300.0..3000.0).contains(&search.axis_ratio()), "{}", search.axis_ratio());
    let config = SeparableCmaEsConfig::new(vec![1.0; 10], 0.5);
    let sphere = evaluations(&mut SeparableCmaEs::with_covariance(config, 1).unwrap(), 3000, sphere);
    assert!(sphere <= 1500, "{sphere} evaluations");
}

#[test]
fn strategies_keep_to_the_contract() {
    for (genes, population) in [(1, 2), (1, 3), (2, 6), (3, 7), (10, 10), (20, 50)] {
        for active in [false, true] {
            let config = CmaEsConfig { population, active, ..cma(0.3, genes, 0.7) };
            check_strategy(|| CmaEs::new(config.clone(), 3), 22).unwrap();
        }
        let config = SeparableCmaEsConfig { population, ..SeparableCmaEsConfig::new(vec![-1.0; genes], 2.0) };
        check_strategy(|| SeparableCmaEs::with_covariance(config.clone(), 3), 22).unwrap();
    }
    for (genes, population) in [(1, 2), (3, 7), (10, 11)] {
        check_strategy(|| CholeskyCmaEs::with_covariance(CmaEsConfig { population, ..cma(0.3, genes, 0.7) }, 3), 22)
            .unwrap();
    }
    // Here c_1 + c_mu is small, so that few generations recompute the axes.
    let config = CmaEsConfig { rank_one_rate: Some(0.003), rank_mu_rate: Some(0.002), ..cma(0.0, 6, 1.0) };
    check_strategy(|| CmaEs::new(config.clone(), 4), 40).unwrap();
    check_strategy(|| CholeskyCmaEs::with_covariance(config.clone(), 4), 40).unwrap();
    let search = CmaEs::new(config, 4).unwrap();
    assert_eq!(search.record_kind(), RecordKind::Values);
}

/// Returns the inverse square root of a symmetric matrix, by Jacobi rotations.
fn inverse_root(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let mut a = matrix.to_vec();
    let mut v: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..50 {
        for (p, q) in (0..n).flat_map(|p| (p + 1..n).map(move |q| (p, q))) {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = if theta < 0.0 { -1.0 } else { 1.0 } / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in a.iter_mut().chain(&mut v) {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..n {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
            }
        }
    }
    let element = |i: usize, j: usize| (0..n).map(|k| v[i][k] * v[j][k] / a[k][k].sqrt()).sum();
    (0..n).map(|i| (0..n).map(|j| element(i, j)).collect()).collect()
}

/// Returns the inverse of the lower triangular factor of a symmetric matrix.
fn inverse_factor(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let (mut a, mut inverse) = (vec![vec![0.0; n]; n], vec![vec![0.0; n]; n]);
    for (j, i) in (0..n).flat_map(|j| (j..n).map(move |i| (j, i))) {
        let rest = matrix[i][j] - (0..j).map(|k| a[i][k] * a[j][k]).sum::<f64>();
        a[i][j] = if i == j { rest.sqrt() } else { rest / a[j][j] };
    }
    for (j, i) in (0..n).flat_map(|j| (j..n).map(move |i| (j, i))) {
        let unit = f64::from(u8::from(i == j));
        inverse[i][j] = (unit - (j..i).map(|k| a[i][k] * inverse[k][j]).sum::<f64>()) / a[i][i];
    }
    inverse
}

/// [Hansen2016] appendix A, equation by equation, for the individuals of a strategy.
struct Oracle {
    m: Vec<f64>,
    sigma: f64,
    c: Vec<Vec<f64>>,
    p_sigma: Vec<f64>,
    p_c: Vec<f64>,
    g: i32,
    /// Restricts the covariance to its diagonal, with the larger rates of that case.
    diagonal: bool,
    /// Rotates steps by the inverse of the triangular factor, [Krause2016].
    triangular: bool,
}

impl Oracle {
    fn new(m: Vec<f64>, sigma: f64, diagonal: bool) -> Self {
        let n = m.len();
        let c = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
        Self { sigma, c, p_sigma: vec![0.0; n], p_c: vec![0.0; n], g: 0, diagonal, triangular: false, m }
    }

    #[allow(clippy::disallowed_methods, clippy::manual_midpoint)]
    fn update(&mut self, best_first: &[Vec<f64>]) {
        let (n, lambda) = (self.m.len(), best_first.len());
        let (nf, mu) = (n as f64, lambda / 2);
        let raw: Vec<f64> = (1..=lambda).map(|i| ((lambda as f64 + 1.0) / 2.0).ln() - (i as f64).ln()).collect();
        let eff = |w: &[f64]| w.iter().sum::<f64>().powi(2) / w.iter().map(|w| w * w).sum::<f64>();
        let (mu_eff, mu_eff_minus) = (eff(&raw[..mu]), eff(&raw[mu..]));
        let c_sigma = (mu_eff + 2.0) / (nf + mu_eff + 5.0);
        let d_sigma = 1.0 + 2.0 * (((mu_eff - 1.0) / (nf + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let c_c = (4.0 + mu_eff / nf) / (nf + 4.0 + 2.0 * mu_eff / nf);
        let mut c_1 = 2.0 / ((nf + 1.3).powi(2) + mu_eff);
        let mut c_mu = (2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / ((nf + 2.0).powi(2) + mu_eff)).min(1.0 - c_1);
        if self.diagonal {
            c_1 = (c_1 * (nf + 2.0) / 3.0).min(1.0);
            c_mu = (c_mu * (nf + 2.0) / 3.0).min(1.0 - c_1);
        }
        let alpha =
            (1.0 + c_1 / c_mu).min(1.0 + 2.0 * mu_eff_minus / (mu_eff + 2.0)).min((1.0 - c_1 - c_mu) / (nf * c_mu));
        let alpha = if self.diagonal { 0.0 } else { alpha };
        let plus: f64 = raw.iter().filter(|w| **w > 0.0).sum();
        let minus: f64 = raw.iter().filter(|w| **w < 0.0).map(|w| -w).sum();
        let w: Vec<f64> = raw.iter().map(|w| if *w >= 0.0 { w / plus } else { alpha * w / minus }).collect();
        let chi = nf.sqrt() * (1.0 - 1.0 / (4.0 * nf) + 1.0 / (21.0 * nf * nf));

        let y: Vec<Vec<f64>> =
            best_first.iter().map(|x| x.iter().zip(&self.m).map(|(x, m)| (x - m) / self.sigma).collect()).collect();
        let y_w: Vec<f64> = (0..n).map(|j| (0..mu).map(|i| w[i] * y[i][j]).sum()).collect();
        let root = if self.triangular { inverse_factor(&self.c) } else { inverse_root(&self.c) };
        let times =
            |v: &[f64]| -> Vec<f64> { root.iter().map(|r| r.iter().zip(v).map(|(r, v)| r * v).sum()).collect() };
        let white = times(&y_w);
        let norm = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        for j in 0..n {
            self.m[j] += self.sigma * y_w[j];
            self.p_sigma[j] =
                (1.0 - c_sigma) * self.p_sigma[j] + (c_sigma * (2.0 - c_sigma) * mu_eff).sqrt() * white[j];
        }
        let length = norm(&self.p_sigma);
        let h = length / (1.0 - (1.0 - c_sigma).powi(2 * (self.g + 1))).sqrt() < (1.4 + 2.0 / (nf + 1.0)) * chi;
        let h = f64::from(u8::from(h));
        for j in 0..n {
            self.p_c[j] = (1.0 - c_c) * self.p_c[j] + h * (c_c * (2.0 - c_c) * mu_eff).sqrt() * y_w[j];
        }
        let w_o: Vec<f64> =
            w.iter().zip(&y).map(|(w, y)| if *w >= 0.0 { *w } else { w * nf / norm(&times(y)).powi(2) }).collect();
        let delta = (1.0 - h) * c_c * (2.0 - c_c);
        let keep = 1.0 + c_1 * delta - c_1 - c_mu * w.iter().sum::<f64>();
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let rank_mu: f64 = w_o.iter().zip(&y).map(|(w, y)| w * y[i] * y[j]).sum();
            let new = keep * self.c[i][j] + c_1 * self.p_c[i] * self.p_c[j] + c_mu * rank_mu;
            self.c[i][j] = if self.diagonal && i != j { 0.0 } else { new };
        }
        self.sigma *= ((c_sigma / d_sigma) * (length / chi - 1.0)).exp();
        self.g += 1;
    }

    /// Passes the same fitness to both for some generations and compares mean, sigma and covariance.
    fn follow<S: Strategy<f64>>(&mut self, search: &mut S, state: impl Fn(&S) -> (Vec<f64>, f64, Vec<Vec<f64>>)) {
        for generation in 0..12 {
            let values: Vec<f64> = search.ask().iter().map(|x| -rosenbrock(x)).collect();
            let mut ranked: Vec<(f64, Vec<f64>)> =
                values.iter().copied().zip(search.ask().iter().map(<[f64]>::to_vec)).collect();
            ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
            let best_first: Vec<Vec<f64>> = ranked.into_iter().map(|(_, x)| x).collect();
            search.tell_values(&values).unwrap();
            self.update(&best_first);
            let (mean, sigma, covariance) = state(search);
            let near = |a: f64, b: f64, size: f64| assert!((a - b).abs() <= 1e-12 * size, "{generation}: {a} {b}");
            near(sigma, self.sigma, sigma);
            mean.iter().zip(&self.m).for_each(|(a, b)| near(*a, *b, 1.0));
            covariance.iter().flatten().zip(self.c.iter().flatten()).for_each(|(a, b)| near(*a, *b, 1.0));
        }
    }
}

#[test]
fn updates_are_those_of_the_equations() {
    for (genes, population) in [(2, 6), (3, 7), (5, 8), (8, 30), (12, 11)] {
        let config = CmaEsConfig { population, ..cma(0.2, genes, 0.3) };
        let mut search = CmaEs::new(config, 5).unwrap();
        Oracle::new(vec![0.2; genes], 0.3, false).follow(&mut search, |search| {
            (search.mean().to_vec(), search.sigma(), search.covariance().chunks(genes).map(<[f64]>::to_vec).collect())
        });
        let mut search = CholeskyCmaEs::with_covariance(CmaEsConfig { population, ..cma(0.2, genes, 0.3) }, 5).unwrap();
        let triangular = Oracle { triangular: true, ..Oracle::new(vec![0.2; genes], 0.3, false) };
        { triangular }.follow(&mut search, |search| {
            (search.mean().to_vec(), search.sigma(), search.covariance().chunks(genes).map(<[f64]>::to_vec).collect())
        });
        let config = SeparableCmaEsConfig { population, ..SeparableCmaEsConfig::new(vec![0.2; genes], 0.3) };
        let mut search = SeparableCmaEs::with_covariance(config, 5).unwrap();
        Oracle::new(vec![0.2; genes], 0.3, true).follow(&mut search, |search| {
            let row = |i: usize| (0..genes).map(|j| if i == j { search.variances()[i] } else { 0.0 }).collect();
            (search.mean().to_vec(), search.sigma(), (0..genes).map(row).collect())
        });
    }
}

#[test]
fn only_the_order_counts_and_failures_alone_change_nothing() {
    let (mut plain, mut monotone) =
        (CmaEs::new(cma(1.0, 6, 0.5), 9).unwrap(), CmaEs::new(cma(1.0, 6, 0.5), 9).unwrap());
    for generation in 0..30 {
        if generation == 7 {
            let (mean, sigma, covariance) = (plain.mean().to_vec(), plain.sigma(), plain.covariance());
            let asked = plain.ask().digest();
            plain.tell_values(&[f64::NAN; 9]).unwrap();
            monotone.tell_values(&[f64::NAN; 9]).unwrap();
            assert_eq!((plain.mean(), plain.sigma(), plain.covariance()), (&mean[..], sigma, covariance));
            assert_ne!(plain.ask().digest(), asked);
            continue;
        }
        let values: Vec<f64> = plain.ask().iter().map(|x| -rosenbrock(x)).collect();
        let risen: Vec<f64> = values.iter().map(|value| value * value * value + 7.0 * value - 3.0).collect();
        plain.tell_values(&values).unwrap();
        monotone.tell_values(&risen).unwrap();
    }
    assert_eq!(plain, monotone);
}

#[test]
fn the_axis_ratio_approaches_that_of_the_function() {
    let mut search = CmaEs::new(cma(1.0, 6, 0.5), 2).unwrap();
    evaluations(&mut search, 20_000, ellipsoid);
    // The expected ratio is 10^3, the root of the condition.
    assert!((400.0..2500.0).contains(&search.axis_ratio()), "{}", search.axis_ratio());
    assert_eq!(search.diagnostics(), [search.sigma(), search.axis_ratio()]);
    // The ratio of the factor's diagonal is smaller, because its squares are between the eigenvalues.
    let mut search = CholeskyCmaEs::with_covariance(cma(1.0, 6, 0.5), 2).unwrap();
    evaluations(&mut search, 20_000, ellipsoid);
    assert!((100.0..2500.0).contains(&search.axis_ratio()), "{}", search.axis_ratio());
    assert_eq!(search.diagnostics(), [search.sigma(), search.axis_ratio()]);
}

#[test]
fn impossible_configurations_are_refused() {
    let refused = |change: fn(&mut CmaEsConfig)| {
        let mut config = cma(0.0, 4, 1.0);
        change(&mut config);
        CmaEs::new(config, 0).unwrap_err().to_string()
    };
    assert_eq!(refused(|c| c.mean.clear()), "a genome of zero genes");
    assert_eq!(refused(|c| c.population = 0), "a population of zero individuals");
    assert_eq!(refused(|c| c.population = 1), "population is 1, where at least 2 is possible");
    assert_eq!(refused(|c| c.sigma = 0.0), "sigma is 0, where 1e-100 to 1e100 is possible");
    assert_eq!(refused(|c| c.largest_step = 0.9), "largest_step is 0.9, where sigma to 1e100 is possible");
    assert_eq!(refused(|c| c.sigma = f64::NAN), "sigma is NaN, where 1e-100 to 1e100 is possible");
    assert_eq!(refused(|c| c.mean[2] = f64::INFINITY), "mean is inf, where -1e100 to 1e100 is possible");
    assert_eq!(refused(|c| c.rank_one_rate = Some(1.5)), "rank_one_rate is 1.5, where 0 to 1 is possible");
    let both = |c: &mut CmaEsConfig| (c.rank_one_rate, c.rank_mu_rate) = (Some(0.75), Some(0.5));
    assert_eq!(refused(both), "rank_mu_rate is 0.5, where 0 to 1 - rank_one_rate is possible");
    // The default rate of rank one is about 2 / (4 + 1.3)^2, so that the sum exceeds 1.
    assert_eq!(
        refused(|c| c.rank_mu_rate = Some(0.95)),
        "rank_mu_rate is 0.95, where 0 to 1 - rank_one_rate is possible"
    );
    assert_eq!(refused(|c| c.damping = Some(0.0)), "damping is 0, where 0.001 to 1000 is possible");
    // The matrix has more elements than a population may have genes.
    let large = refused(|c| c.mean = vec![0.0; 20_000]);
    assert_eq!(large, "20000 genomes of 20000 genes are more than 268435456 genes");
    let refused = |sigma, population| {
        let config = SeparableCmaEsConfig { population, ..SeparableCmaEsConfig::new(vec![0.0; 3], sigma) };
        SeparableCmaEs::with_covariance(config, 0).unwrap_err().to_string()
    };
    assert_eq!(refused(-1.0, 4), "sigma is -1, where 1e-100 to 1e100 is possible");
    assert_eq!(refused(1.0, 1), "population is 1, where at least 2 is possible");
    assert!(refused(1.0, usize::MAX).starts_with("18446744073709551615 genomes of 3 genes are more"));
}

#[test]
fn refused_states_change_nothing() {
    let mut search = CmaEs::new(cma(0.0, 2, 1.0), 1).unwrap();
    search.tell_values(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
    let (before, state) = (search.clone(), search.save());
    // Generation, updates, sigma, mean, paths, age, half of C, D, B.
    assert_eq!(state.len(), 4 + 4 + 8 * (1 + 2 + 2 + 2) + 4 + 8 * (3 + 2 + 4));
    assert_eq!(search.restore(&state[1..]), Err(errors::state_length(140, 139)));
    for (place, wrong) in
        [(8, 0.0), (8, f64::NAN), (16, f64::INFINITY), (32, 1e200), (68, 1e120), (92, -1.0), (108, 1.5)]
    {
        let mut state = state.clone();
        state[place..place + 8].copy_from_slice(&wrong.to_le_bytes());
        assert!(matches!(search.restore(&state), Err(EvoError::State { .. })), "{place}");
        assert_eq!(search, before);
    }
    search.restore(&state).unwrap();
    assert_eq!(search, before);

    let mut search = CholeskyCmaEs::with_covariance(cma(0.0, 2, 1.0), 1).unwrap();
    search.tell_values(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap();
    let (before, state) = (search.clone(), search.save());
    // Generation, updates, sigma, mean, paths, age, half of C, half of A.
    assert_eq!(state.len(), 4 + 4 + 8 * (1 + 2 + 2 + 2) + 4 + 8 * (3 + 3));
    for (place, wrong) in [(8, 0.0), (68, f64::NAN), (92, 0.0), (92, -1.0), (100, 1e120), (108, 0.0)] {
        let mut state = state.clone();
        state[place..place + 8].copy_from_slice(&wrong.to_le_bytes());
        assert!(matches!(search.restore(&state), Err(EvoError::State { .. })), "{place}");
        assert_eq!(search, before);
    }
    search.restore(&state).unwrap();
    assert_eq!(search, before);
}

/// Digests fifty generations of Rosenbrock's function with some failed evaluations.
fn digest(mut search: impl Strategy<f64>) -> u64 {
    let mut digest = Digest::new();
    for generation in 0..50 {
        let judge = |(index, x): (usize, &[f64])| if (index + generation) % 9 == 0 { f64::NAN } else { -rosenbrock(x) };
        let values: Vec<f64> = search.ask().iter().enumerate().map(judge).collect();
        digest.add_u64(search.ask().digest());
        search.tell_values(&values).unwrap();
    }
    digest.finish()
}

#[test]
fn the_bits_stay_as_they_are() {
    let full = digest(CmaEs::new(cma(0.1, 11, 0.4), 2016).unwrap());
    let separable = SeparableCmaEsConfig::new(vec![0.1; 11], 0.4);
    let separable = digest(SeparableCmaEs::with_covariance(separable, 2008).unwrap());
    let triangular = digest(CholeskyCmaEs::with_covariance(cma(0.1, 11, 0.4), 2016).unwrap());
    let got = [full, separable, triangular];
    assert_eq!(got, [0x5025_a614_01ca_8e67, 0x7b63_61cc_b9e9_3acb, 0x5b5c_9f65_0a10_07be], "{got:#018x?}");
}

/// Any fitness: common, failed, equal, huge.
fn any_fitness(count: usize) -> impl proptest::strategy::Strategy<Value = Vec<f64>> {
    let fitness = prop_oneof![
        4 => -10.0..10.0_f64,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(0.0),
        1 => any::<f64>(),
    ];
    proptest::collection::vec(fitness, count)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn genes_stay_finite(
        genes in 1..7_usize, population in 2..12_usize, active: bool, seed: u64, exponent in -99..99_i32,
        rates in proptest::option::of((0.0..=1.0_f64, 0.0..=1.0_f64, 0.001..10.0_f64)),
        reported in any_fitness(40 * 12), adverse: bool,
    ) {
        let sigma = farsa_num::exp(f64::from(exponent) * core::f64::consts::LN_10);
        let mut config = CmaEsConfig { population, active, ..cma(sigma, genes, sigma) };
        if let Some((rank_one, mu, damping)) = rates {
            config.rank_one_rate = Some(rank_one);
            config.rank_mu_rate = Some(mu * (1.0 - rank_one));
            config.damping = Some(damping);
        }
        let mut search = CmaEs::new(config, seed).unwrap();
        let separable = SeparableCmaEsConfig { population, ..SeparableCmaEsConfig::new(vec![sigma; genes], sigma) };
        let mut separable = SeparableCmaEs::with_covariance(separable, seed).unwrap();
        for values in reported.chunks(population) {
            // Fitness that grows without bound with the distance.
            let far = |x: &[f64]| x.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
            let values = |asked: &farsa_evo::Population<f64>| -> Vec<Fitness> {
                let judge = |(x, value): (&[f64], &f64)| Fitness::nan_as_failed(if adverse { far(x) } else { *value });
                asked.iter().zip(values.iter().chain(std::iter::repeat(&f64::NAN))).map(judge).collect()
            };
            search.tell(&values(search.ask())).unwrap();
            separable.tell(&values(separable.ask())).unwrap();
            let genes = search.ask().as_slice().iter().chain(separable.ask().as_slice());
            prop_assert!(genes.chain(&search.diagnostics()).chain(&separable.diagnostics()).all(|x| x.is_finite()));
            let state = search.save();
            let mut again = search.clone();
            prop_assert_eq!(again.restore(&state), Ok(()));
            prop_assert_eq!(again, search.clone());
        }
    }
}

#[test]
fn an_unbounded_function_ends_at_the_limits() {
    for direction in [1.0, -1.0] {
        let mut search = CmaEs::new(cma(1.0, 3, 1.0), 6).unwrap();
        for _ in 0..3000 {
            let values: Vec<f64> = search.ask().iter().map(|x| direction * x[0].abs().min(1e300)).collect();
            search.tell_values(&values).unwrap();
            assert!(search.ask().as_slice().iter().all(|x| x.is_finite()));
        }
        assert!((1e-100..=1e100).contains(&search.sigma()));
    }
}
