//! The strategies against direct transcriptions of their papers' formulas, for a few generations.

use farsa_evo::Strategy;
use farsa_evo::gradient::{
    Ars, ArsConfig, OpenAiEs, OpenAiEsConfig, Optimizer, Pgpe, PgpeConfig, PgpeFitness, Snes, SnesConfig, Xnes,
    XnesConfig,
};
use farsa_num::{Domain, Stream, exp, ln};

type Matrix = Vec<Vec<f64>>;

const GENES: usize = 5;
const SEED: u64 = 77;
const GENERATIONS: u32 = 8;

fn start() -> Vec<f64> {
    vec![0.5, -1.0, 2.0, 0.25, -3.0]
}

/// Returns the noise of a row of a generation.
fn noise(row: usize, generation: u32) -> Vec<f64> {
    let domain = if generation == 0 { Domain::InitialGenome } else { Domain::Mutation };
    let mut stream = Stream::new(SEED, domain, 0, row as u32, generation);
    let mut numbers = Vec::new();
    while numbers.len() < GENES {
        numbers.extend(stream.normal_pair_f64());
    }
    numbers.truncate(GENES);
    numbers
}

/// A function without symmetry, so that no two individuals are equal.
fn fitness(x: &[f64]) -> f64 {
    10.0 - x.iter().enumerate().map(|(i, x)| (1.0 + i as f64) * (x - 1.0) * (x - 1.0) + 0.1 * x * x * x).sum::<f64>()
}

fn close(got: &[f64], want: &[f64]) {
    let size = want.iter().fold(1e-3, |size: f64, x| size.max(x.abs()));
    assert_eq!(got.len(), want.len());
    assert!(got.iter().zip(want).all(|(got, want)| (got - want).abs() <= 1e-12 * size), "{got:?}\n{want:?}");
}

/// Compares the current generation with the oracle's, then passes on the oracle's fitness.
fn compare(strategy: &mut impl Strategy<f64>, genomes: &Matrix) -> Vec<f64> {
    for (got, want) in strategy.ask().iter().zip(genomes) {
        close(got, want);
    }
    let values: Vec<f64> = genomes.iter().map(|x| fitness(x)).collect();
    strategy.tell_values(&values).unwrap();
    values
}

/// Counts the better values.
fn rank(values: &[f64], index: usize) -> usize {
    values.iter().filter(|value| **value > values[index]).count()
}

fn utility(values: &[f64], index: usize) -> f64 {
    let lambda = values.len() as f64;
    let raw = |k: usize| (ln(lambda / 2.0 + 1.0) - ln(k as f64)).max(0.0);
    raw(rank(values, index) + 1) / (1..=values.len()).map(raw).sum::<f64>() - 1.0 / lambda
}

/// Pairs that mirror each other.
fn mirrored(mean: &[f64], sigmas: &[f64], pairs: usize, generation: u32) -> (Matrix, Matrix) {
    let noises: Matrix = (0..pairs).map(|k| noise(k, generation)).collect();
    let genome = |sign: f64, s: &[f64]| (0..GENES).map(|i| mean[i] + sign * sigmas[i] * s[i]).collect::<Vec<f64>>();
    (noises.iter().flat_map(|s| [genome(1.0, s), genome(-1.0, s)]).collect(), noises)
}

#[test]
fn snes_follows_its_paper() {
    let config = SnesConfig::new(start(), 0.7);
    assert_eq!((config.population, config.mean_learning_rate), (8, 1.0));
    let rate = (3.0 + ln(5.0_f64)) / (5.0 * f64::sqrt(5.0));
    assert!((config.sigma_learning_rate - rate).abs() < 1e-15);
    let mut strategy = Snes::new(config, SEED).unwrap();
    let (mut mu, mut sigma) = (start(), vec![0.7; GENES]);
    for generation in 0..GENERATIONS {
        let s: Matrix = (0..8).map(|k| noise(k, generation)).collect();
        let z = s.iter().map(|s| (0..GENES).map(|i| mu[i] + sigma[i] * s[i]).collect()).collect();
        let values = compare(&mut strategy, &z);
        for i in 0..GENES {
            let mean_gradient: f64 = (0..8).map(|k| utility(&values, k) * s[k][i]).sum();
            let sigma_gradient: f64 = (0..8).map(|k| utility(&values, k) * (s[k][i] * s[k][i] - 1.0)).sum();
            mu[i] += sigma[i] * mean_gradient;
            sigma[i] *= exp(rate / 2.0 * sigma_gradient);
        }
    }
    close(strategy.mean(), &mu);
    close(strategy.sigmas(), &sigma);
}

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let element = |i: usize, j: usize| (0..GENES).map(|k| a[i][k] * b[k][j]).sum();
    (0..GENES).map(|i| (0..GENES).map(|j| element(i, j)).collect()).collect()
}

fn identity() -> Matrix {
    (0..GENES).map(|i| (0..GENES).map(|j| f64::from(u8::from(i == j))).collect()).collect()
}

/// The matrix exponential by its power series.
fn matrix_exp(a: &Matrix) -> Matrix {
    let (mut sum, mut term) = (identity(), identity());
    for k in 1..60 {
        term = times(&term, a);
        term.iter_mut().flatten().for_each(|x| *x /= f64::from(k));
        sum.iter_mut().flatten().zip(term.iter().flatten()).for_each(|(sum, x)| *sum += x);
    }
    sum
}

#[test]
fn xnes_follows_its_paper() {
    let config = XnesConfig::new(start(), 0.7);
    assert_eq!((config.population, config.mean_learning_rate), (8, 1.0));
    let rate = 0.6 * (3.0 + ln(5.0_f64)) / (5.0 * f64::sqrt(5.0));
    assert!((config.sigma_learning_rate - rate).abs() < 1e-15 && (config.shape_learning_rate - rate).abs() < 1e-15);
    let mut strategy = Xnes::new(config, SEED).unwrap();
    let (mut mu, mut sigma, mut b) = (start(), 0.7, identity());
    for generation in 0..GENERATIONS {
        let s: Matrix = (0..8).map(|k| noise(k, generation)).collect();
        let turned = |b: &Matrix, s: &[f64], i: usize| (0..GENES).map(|j| b[i][j] * s[j]).sum::<f64>();
        let z = s.iter().map(|s| (0..GENES).map(|i| mu[i] + sigma * turned(&b, s, i)).collect()).collect();
        let values = compare(&mut strategy, &z);
        let delta: Vec<f64> = (0..GENES).map(|i| (0..8).map(|k| utility(&values, k) * s[k][i]).sum()).collect();
        let mut m = vec![vec![0.0; GENES]; GENES];
        for i in 0..GENES {
            for j in 0..GENES {
                let delta = identity()[i][j];
                m[i][j] = (0..8).map(|k| utility(&values, k) * (s[k][i] * s[k][j] - delta)).sum();
            }
        }
        let growth = (0..GENES).map(|i| m[i][i]).sum::<f64>() / GENES as f64;
        for (i, row) in m.iter_mut().enumerate() {
            row[i] -= growth;
            for x in row {
                *x *= rate / 2.0;
            }
        }
        for i in 0..GENES {
            mu[i] += sigma * turned(&b, &delta, i);
        }
        sigma *= exp(rate / 2.0 * growth);
        b = times(&b, &matrix_exp(&m));
    }
    close(strategy.mean(), &mu);
    close(&[strategy.sigma()], &[sigma]);
    close(strategy.shape(), &b.concat());
}

#[test]
fn the_strategy_of_openai_follows_its_paper() {
    let (pairs, sigma, alpha, decay) = (6, 0.1, 0.05, 0.3);
    for optimizer in [Optimizer::ADAM, Optimizer::MOMENTUM] {
        let config =
            OpenAiEsConfig { mean: start(), pairs, sigma, learning_rate: alpha, weight_decay: decay, optimizer };
        let mut strategy = OpenAiEs::new(config, SEED).unwrap();
        let (mut theta, mut m, mut v) = (start(), vec![0.0; GENES], vec![0.0; GENES]);
        for generation in 0..GENERATIONS {
            let (genomes, noises) = mirrored(&theta, &[sigma; GENES], pairs, generation);
            let values = compare(&mut strategy, &genomes);
            let count = values.len() as f64;
            let centred = |index: usize| 0.5 - rank(&values, index) as f64 / (count - 1.0);
            for i in 0..GENES {
                let sum: f64 = (0..pairs).map(|k| (centred(2 * k) - centred(2 * k + 1)) * noises[k][i]).sum();
                let g = sum / (count * sigma) - decay * theta[i];
                m[i] = 0.9 * m[i] + 0.1 * g;
                if optimizer == Optimizer::MOMENTUM {
                    theta[i] += alpha * m[i];
                    continue;
                }
                v[i] = 0.999 * v[i] + 0.001 * g * g;
                let power = |beta: f64| (0..=generation).map(|_| beta).product::<f64>();
                let (m_hat, v_hat) = (m[i] / (1.0 - power(0.9)), v[i] / (1.0 - power(0.999)));
                theta[i] += alpha * m_hat / (v_hat.sqrt() + 1e-8);
            }
        }
        close(strategy.mean(), &theta);
    }
}

#[test]
fn pgpe_follows_its_paper() {
    let pairs = 6;
    for fitness in [PgpeFitness::CenteredRanks, PgpeFitness::Raw] {
        let config = PgpeConfig { fitness, ..PgpeConfig::new(start(), 0.4, pairs) };
        let (speed, alpha) = (0.4 * 5.0_f64.sqrt() / 15.0, 0.2 * 5.0_f64.sqrt() / 15.0);
        assert!((config.max_speed - speed).abs() < 1e-15 && (config.step_size - alpha).abs() < 1e-15);
        let mut strategy = Pgpe::new(config, SEED).unwrap();
        let (mut x, mut sigma, mut v) = (start(), vec![0.4; GENES], vec![0.0; GENES]);
        for generation in 0..GENERATIONS {
            let (genomes, noises) = mirrored(&x, &sigma, pairs, generation);
            let values = compare(&mut strategy, &genomes);
            let f: Vec<f64> = match fitness {
                PgpeFitness::Raw => values.clone(),
                _ => (0..values.len()).map(|index| 0.5 - rank(&values, index) as f64 / 11.0).collect(),
            };
            let b = f.iter().sum::<f64>() / 12.0;
            let (mut gradient, mut grown) = (vec![0.0; GENES], vec![0.0; GENES]);
            for i in 0..GENES {
                for k in 0..pairs {
                    let (e, plus, minus) = (sigma[i] * noises[k][i], f[2 * k], f[2 * k + 1]);
                    gradient[i] += (plus - minus) / 2.0 * e / 6.0;
                    grown[i] += (0.5 * (plus + minus) - b) * (e * e - sigma[i] * sigma[i]) / sigma[i] / 6.0;
                }
            }
            let norm = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
            let length = norm(&gradient);
            (0..GENES).for_each(|i| v[i] = 0.9 * v[i] + alpha * gradient[i] / length);
            let length = norm(&v);
            if length > speed {
                for v in &mut v {
                    *v *= speed / length;
                }
            }
            for i in 0..GENES {
                x[i] += v[i];
                sigma[i] = (sigma[i] + 0.1 * grown[i]).max(0.8 * sigma[i]).min(1.2 * sigma[i]);
            }
        }
        close(strategy.mean(), &x);
        close(strategy.sigmas(), &sigma);
    }
}

#[test]
fn ars_follows_its_paper() {
    let (directions, alpha, nu) = (6, 0.2, 0.1);
    for top in [6, 2] {
        let config = ArsConfig { mean: start(), directions, top_directions: top, step_size: alpha, noise: nu };
        let mut strategy = Ars::new(config, SEED).unwrap();
        let mut x = start();
        for generation in 0..GENERATIONS {
            let (genomes, noises) = mirrored(&x, &[nu; GENES], directions, generation);
            let r = compare(&mut strategy, &genomes);
            let best = |k: usize| r[2 * k].max(r[2 * k + 1]);
            let mut order: Vec<usize> = (0..directions).collect();
            order.sort_by(|a, b| best(*b).total_cmp(&best(*a)));
            order.truncate(top);
            let used: Vec<f64> = order.iter().flat_map(|k| [r[2 * k], r[2 * k + 1]]).collect();
            let mean = used.iter().sum::<f64>() / used.len() as f64;
            let sigma = (used.iter().map(|r| (r - mean) * (r - mean)).sum::<f64>() / used.len() as f64).sqrt();
            for i in 0..GENES {
                let sum: f64 = order.iter().map(|k| (r[2 * k] - r[2 * k + 1]) * noises[*k][i]).sum();
                x[i] += alpha / (top as f64 * sigma) * sum;
            }
        }
        close(strategy.mean(), &x);
    }
}
