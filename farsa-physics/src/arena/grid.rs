//! A uniform grid over the places of robots and cylinders: which bodies may be near.

use alloc::vec;
use alloc::vec::Vec;

use crate::arena::model::{Model, POSE_WORDS};

/// Cells for each body, at most.
const CELLS: f32 = 4.0;

/// Which bodies have their center in which cell. Places outside belong to the cells at the border.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    origin: [f32; 2],
    /// Cells per length [1/m].
    per: f32,
    size: [usize; 2],
    /// Where the items of each cell begin, and where those of the last end.
    starts: Vec<u32>,
    items: Vec<u16>,
    /// The distance that a body may move before the cells are filled again [m].
    slack: f32,
}

impl Grid {
    pub(crate) fn new(model: &Model, size: Option<[f64; 2]>) -> Self {
        let poses = model.initial.chunks_exact(POSE_WORDS).take(model.round_bodies());
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for pose in poses {
            for k in 0..2 {
                low[k] = low[k].min(pose[k]);
                high[k] = high[k].max(pose[k]);
            }
        }
        if let Some(size) = size {
            (low, high) = ([0.0; 2], [size[0] as f32, size[1] as f32]);
        }
        let bodies = model.round_bodies() as f32;
        let own = 2.0 * model.largest + model.travel;
        let sides = [high[0] - low[0] + own, high[1] - low[1] + own];
        let fair = farsa_num::Scalar::sqrt(sides[0] / (CELLS * bodies) * sides[1]);
        // A long row has no more cells than bodies, either.
        let cell = own.max(fair).max(sides[0].max(sides[1]) / (CELLS * bodies + 16.0));
        let size = sides.map(|side| ((side / cell) as usize).max(1));
        Self {
            origin: low,
            per: 1.0 / cell,
            size,
            starts: vec![0; size[0] * size[1] + 1],
            items: vec![0; model.round_bodies()],
            slack: 1.01 * model.travel,
        }
    }

    #[inline]
    fn column(&self, axis: usize, x: f32) -> usize {
        // Saturates: 0 below and for a NaN.
        (((x - self.origin[axis]) * self.per) as usize).min(self.size[axis] - 1)
    }

    #[inline]
    fn cell(&self, words: &[f32], body: usize) -> usize {
        let at = POSE_WORDS * body;
        self.column(1, words[at + 1]) * self.size[0] + self.column(0, words[at])
    }

    /// Fills the cells from where the bodies are.
    pub(crate) fn fill(&mut self, words: &[f32]) {
        self.starts.fill(0);
        for body in 0..self.items.len() {
            let cell = self.cell(words, body);
            self.starts[cell + 1] += 1;
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        // From behind, so that the starts end where they belong and items of a cell are in order.
        for body in (0..self.items.len()).rev() {
            let cell = self.cell(words, body);
            self.starts[cell + 1] -= 1;
            self.items[self.starts[cell + 1] as usize] = body as u16;
        }
        // Now the entry after a cell is where the cell begins.
        let cells = self.starts.len() - 1;
        self.starts.copy_within(1.., 0);
        self.starts[cells] = self.items.len() as u32;
    }

    /// Visits every body whose center may be in the rectangle [m], and others.
    #[inline]
    pub(crate) fn visit(&self, low: [f32; 2], high: [f32; 2], mut tell: impl FnMut(usize)) {
        let columns = [self.column(0, low[0] - self.slack), self.column(0, high[0] + self.slack)];
        for row in self.column(1, low[1] - self.slack)..=self.column(1, high[1] + self.slack) {
            let first = row * self.size[0];
            // The cells of a row follow each other, and so do their items.
            let items = self.starts[first + columns[0]] as usize..self.starts[first + columns[1] + 1] as usize;
            for body in &self.items[items] {
                tell(usize::from(*body));
            }
        }
    }
}
