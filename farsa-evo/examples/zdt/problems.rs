//! The problems ZDT1 to 4 and 6, as objectives to maximize.

use std::f64::consts::{PI, TAU};

use farsa_evo::pareto::hypervolume;
use farsa_num::{exp, sin_cos};

/// The reference point of the hypervolume, in objectives that are minimized.
pub(crate) const REFERENCE: [f64; 2] = [-1.1, -1.1];

/// One of the problems of \[Zitzler2000\], without ZDT5, whose genes are bit strings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Zdt {
    One,
    Two,
    Three,
    Four,
    Six,
}

impl Zdt {
    pub(crate) const ALL: [Self; 5] = [Self::One, Self::Two, Self::Three, Self::Four, Self::Six];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::One => "zdt1",
            Self::Two => "zdt2",
            Self::Three => "zdt3",
            Self::Four => "zdt4",
            Self::Six => "zdt6",
        }
    }

    /// Returns the range of each gene \[genes\].
    pub(crate) fn bounds(self) -> Vec<[f64; 2]> {
        match self {
            Self::One | Self::Two | Self::Three => vec![[0.0, 1.0]; 30],
            Self::Four => [[0.0, 1.0]].into_iter().chain([[-5.0, 5.0]; 9]).collect(),
            Self::Six => vec![[0.0, 1.0]; 10],
        }
    }

    /// Returns the negated values of both functions.
    pub(crate) fn judge(self, genes: &[f64], row: &mut [f64]) {
        let (x, rest) = (genes[0], &genes[1..]);
        let mean = rest.iter().sum::<f64>() / rest.len() as f64;
        let (f, g) = match self {
            Self::One | Self::Two | Self::Three => (x, 1.0 + 9.0 * mean),
            Self::Four => {
                let rough = |x: &f64| x * x - 10.0 * sin_cos(2.0 * TAU * x).1;
                (x, 1.0 + 10.0 * rest.len() as f64 + rest.iter().map(rough).sum::<f64>())
            }
            Self::Six => (steep(x), 1.0 + 9.0 * mean.sqrt().sqrt()),
        };
        row.copy_from_slice(&[-f, -g * self.shape(f, g)]);
    }

    /// Returns the second function divided by g.
    fn shape(self, f: f64, g: f64) -> f64 {
        let part = f / g;
        match self {
            Self::One | Self::Four => 1.0 - part.sqrt(),
            Self::Two | Self::Six => 1.0 - part * part,
            Self::Three => 1.0 - part.sqrt() - part * sin_cos(10.0 * PI * f).0,
        }
    }

    /// Integrates the hypervolume of the true front over a hundred thousand points.
    pub(crate) fn largest_hypervolume(self) -> f64 {
        let first = |i: u32| {
            let x = f64::from(i) / 1e5;
            if self == Self::Six { steep(x) } else { x }
        };
        let point = |i| [-first(i), -self.shape(first(i), 1.0)];
        hypervolume(&(0..=100_000).map(point).collect::<Vec<_>>(), REFERENCE)
    }
}

/// Returns the first function of ZDT6.
fn steep(x: f64) -> f64 {
    let sine = sin_cos(6.0 * PI * x).0;
    let square = sine * sine;
    1.0 - exp(-4.0 * x) * square * square * square
}
