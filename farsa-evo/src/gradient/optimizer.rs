//! How an estimated gradient becomes a step.

use alloc::vec;
use alloc::vec::Vec;

use super::adam::Adam;
use super::settings::{decay, positive, read};
use crate::error::EvoError;
use crate::snapshot::{StateReader, push_reals};

/// How [`OpenAiEs`](crate::gradient::OpenAiEs) turns a gradient into a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Optimizer {
    /// Adam, \[Kingma2015\] algorithm 1.
    Adam {
        /// Decay of the mean gradient (beta 1), 0 to less than 1.
        first_decay: f64,
        /// Decay of the mean square (beta 2), 0 to less than 1.
        second_decay: f64,
        /// What is added to the root of the mean square (epsilon), 1e-100 to 1e100.
        epsilon: f64,
    },
    /// Gradient ascent with momentum: v = momentum v + (1 - momentum) gradient, the step is the learning rate times v.
    /// Source: the program of the authors of \[Salimans2017\].
    Momentum {
        /// Share of the former velocity, 0 to less than 1.
        momentum: f64,
    },
}

impl Optimizer {
    /// Adam with the decays of \[Kingma2015\], 0.9 and 0.999, and epsilon 1e-8.
    pub const ADAM: Self = Self::Adam { first_decay: 0.9, second_decay: 0.999, epsilon: 1e-8 };

    /// Gradient ascent with a momentum of 0.9.
    pub const MOMENTUM: Self = Self::Momentum { momentum: 0.9 };

    pub(super) fn validate(self) -> Result<(), EvoError> {
        match self {
            Self::Adam { first_decay, second_decay, epsilon } => {
                decay("first_decay", first_decay)?;
                decay("second_decay", second_decay)?;
                positive("epsilon", epsilon)
            }
            Self::Momentum { momentum } => decay("momentum", momentum),
        }
    }
}

/// What an optimizer remembers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Memory {
    Adam(Adam),
    Momentum(Vec<f64>),
}

impl Memory {
    pub(super) fn new(optimizer: Optimizer, genes: usize) -> Self {
        match optimizer {
            Optimizer::Adam { .. } => Self::Adam(Adam::new(genes)),
            Optimizer::Momentum { .. } => Self::Momentum(vec![0.0; genes]),
        }
    }

    /// Turns a gradient \[genes\] into a step.
    pub(super) fn step(&mut self, optimizer: Optimizer, rate: f64, gradient: &mut [f64]) {
        match (self, optimizer) {
            (Self::Adam(adam), Optimizer::Adam { first_decay, second_decay, epsilon }) => {
                adam.step(gradient, rate, [first_decay, second_decay], epsilon);
            }
            (Self::Momentum(velocity), Optimizer::Momentum { momentum }) => {
                for (g, velocity) in gradient.iter_mut().zip(velocity) {
                    *velocity = momentum * *velocity + (1.0 - momentum) * *g;
                    *g = rate * *velocity;
                }
            }
            _ => debug_assert!(false, "the memory of another optimizer"),
        }
    }

    pub(super) fn bytes(optimizer: Optimizer, genes: usize) -> usize {
        match optimizer {
            Optimizer::Adam { .. } => Adam::bytes(genes),
            Optimizer::Momentum { .. } => 8 * genes,
        }
    }

    pub(super) fn push(&self, state: &mut Vec<u8>) {
        match self {
            Self::Adam(adam) => adam.push(state),
            Self::Momentum(velocity) => push_reals(state, velocity),
        }
    }

    pub(super) fn read(optimizer: Optimizer, reader: &mut StateReader<'_>, genes: usize) -> Result<Self, EvoError> {
        Ok(match optimizer {
            Optimizer::Adam { .. } => Self::Adam(Adam::read(reader, genes)?),
            Optimizer::Momentum { .. } => Self::Momentum(read(reader, genes, "a velocity", [-1e110, 1e110])?),
        })
    }
}
