//! Bytes of an episode in a page.

use serde_json::Value;

/// Largest count of a 16-bit quantity. In channels 65535 is NaN.
pub(crate) const COUNTS: f64 = 65534.0;

/// Bytes of an episode in named blocks.
#[derive(Default)]
pub(crate) struct Blocks {
    pub(crate) bytes: Vec<u8>,
    /// Offset of each block.
    pub(crate) starts: serde_json::Map<String, Value>,
}

impl Blocks {
    pub(crate) fn begin(&mut self, name: &str) {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.starts.insert(name.into(), self.bytes.len().into());
    }
    pub(crate) fn float(&mut self, x: f32) {
        self.bytes.extend(x.to_le_bytes());
    }
    pub(crate) fn long(&mut self, x: u32) {
        self.bytes.extend(x.to_le_bytes());
    }
    pub(crate) fn word(&mut self, x: u16) {
        self.bytes.extend(x.to_le_bytes());
    }
}

/// Bounding box of all positions, and the unit of their counts.
pub(crate) struct Space {
    pub(crate) origin: [f64; 3],
    pub(crate) unit: f64,
}

impl Space {
    pub(crate) fn from_positions(positions: impl Iterator<Item = [f32; 3]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for position in positions {
            for k in 0..3 {
                let x = f64::from(position[k]);
                // A diverging body must not spoil the precision of the others.
                if x.abs() < 1e6 {
                    (low[k], high[k]) = (low[k].min(x), high[k].max(x));
                }
            }
        }
        let largest = (0..3).map(|k| high[k] - low[k]).fold(1e-3, f64::max);
        let origin = low.map(|x| if x.is_finite() { x } else { 0.0 });
        Self { origin, unit: largest / COUNTS }
    }

    pub(crate) fn write(&self, position: [f32; 3], blocks: &mut Blocks) {
        for k in 0..3 {
            // NaN becomes 0, and positions outside are clamped.
            blocks.word(((f64::from(position[k]) - self.origin[k]) / self.unit).round() as u16);
        }
    }
}
