//! A hash of an episode after each step, which differs from the first different bit on.

use farsa_body::ports::{BodyId, PairContact, PairId};
use farsa_body::{Pose, Recorder};

/// Hashes everything that is recorded, and stores the hash after each tick.
///
/// The hash is the upper half of the 64-bit FNV-1a of all numbers in the order of recording.
#[derive(Debug, Clone)]
pub(crate) struct Digest<R> {
    /// Receives the same calls.
    inner: R,
    state: u64,
    /// Hash after each tick.
    ticks: Vec<u32>,
}

impl<R> Digest<R> {
    pub(crate) fn new(inner: R) -> Self {
        Self { inner, state: 0xcbf2_9ce4_8422_2325, ticks: Vec::new() }
    }

    /// Returns the inner recorder and the hashes.
    pub(crate) fn into_parts(self) -> (R, Vec<u32>) {
        (self.inner, self.ticks)
    }

    fn fold(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.state = (self.state ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn floats<'f>(&mut self, values: impl IntoIterator<Item = &'f f32>) {
        values.into_iter().for_each(|value| self.fold(&value.to_bits().to_le_bytes()));
    }
}

impl<R: Recorder> Recorder for Digest<R> {
    fn parameters(&mut self, parameters: &[f32]) {
        self.floats(parameters);
        self.inner.parameters(parameters);
    }
    fn pose(&mut self, body: BodyId, pose: Pose) {
        self.fold(&body.0.to_le_bytes());
        self.floats(pose.position.iter().chain(&pose.rotation));
        self.inner.pose(body, pose);
    }
    fn contact(&mut self, pair: PairId, contact: &PairContact) {
        self.fold(&pair.0.to_le_bytes());
        self.floats(contact.point.iter().chain([&contact.normal_force]));
        self.inner.contact(pair, contact);
    }
    fn ray(&mut self, from: [f32; 3], to: [f32; 3], met: bool) {
        self.floats(from.iter().chain(&to));
        self.inner.ray(from, to, met);
    }
    fn point(&mut self, point: usize, position: [f32; 3]) {
        self.floats(&position);
        self.inner.point(point, position);
    }
    fn pixel(&mut self, image: usize, pixel: usize, color: [f32; 3]) {
        self.floats(&color);
        self.inner.pixel(image, pixel, color);
    }
    fn sensors(&mut self, x: &[f32]) {
        self.floats(x);
        self.inner.sensors(x);
    }
    fn neurons(&mut self, states: &[f32]) {
        self.floats(states);
        self.inner.neurons(states);
    }
    fn outputs(&mut self, y: &[f32]) {
        self.floats(y);
        self.inner.outputs(y);
    }
    fn scalars(&mut self, values: &[f64]) {
        for value in values {
            self.fold(&value.to_bits().to_le_bytes());
        }
        self.inner.scalars(values);
    }
    fn tick(&mut self, time: f64) {
        self.fold(&time.to_bits().to_le_bytes());
        self.ticks.push((self.state >> 32) as u32);
        self.inner.tick(time);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_view::{Recording, Schema};

    #[test]
    fn a_bit_changes_the_hash_of_its_tick_and_all_later_ones() {
        let recorded = |changed: Option<u32>| {
            let mut digest = Digest::new(Recording::new(Schema::from_scalars(["x"])));
            for tick in 0..5 {
                let flipped = u32::from(changed == Some(tick));
                digest.sensors(&[f32::from_bits(1.5_f32.to_bits() ^ flipped), 2.0]);
                digest.scalars(&[f64::from(tick)]);
                digest.tick(f64::from(tick));
            }
            digest.into_parts()
        };
        let (recording, intact) = recorded(None);
        assert_eq!((recording.times(), intact.len()), (&[0.0, 1.0, 2.0, 3.0, 4.0][..], 5));
        for tick in 0..5 {
            let (_, other) = recorded(Some(tick));
            let same: Vec<bool> = intact.iter().zip(&other).map(|(a, b)| a == b).collect();
            assert_eq!(same, (0..5).map(|at| at < tick).collect::<Vec<_>>());
        }
        // The empty hash of the source's table, folded with one byte `a`.
        let mut digest = Digest::new(());
        digest.fold(b"a");
        assert_eq!(digest.state, 0xaf63_dc4c_8601_ec8c);
    }
}
