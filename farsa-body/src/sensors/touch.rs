//! Sensors for contacts.

use crate::channel::{ChannelError, positive, write};
use crate::ports::{Channels, Contacts, PairId, Sensor};

/// A sensor with one channel that counts the pairs of a group that touch. The reading is min(1, n / saturation) for n
/// pairs.
///
/// A pair counts once, no matter how many contact points it has, and only if there is a normal force > 0. The pairs can
/// be stored in an array, a borrowed slice or a `Vec`. Use an array or a `Vec` of these sensors for several patches of
/// skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<L> {
    pairs: L,
    saturation: f32,
}

impl<L: AsRef<[PairId]>> Touch<L> {
    /// Creates a sensor that reads 1 if at least `saturation` of the given pairs touch.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if `saturation` is not a finite number > 0.
    pub fn new(pairs: L, saturation: f32) -> Result<Self, ChannelError> {
        Ok(Self { pairs, saturation: positive("saturation", saturation)? })
    }

    /// Gets the pairs of the group.
    pub fn pairs(&self) -> &[PairId] {
        self.pairs.as_ref()
    }
}

impl<L> Channels for Touch<L> {
    fn channels(&self) -> usize {
        1
    }
}

impl<L: AsRef<[PairId]>, W: Contacts + ?Sized> Sensor<W> for Touch<L> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let touching = self.pairs.as_ref().iter().filter(|&&pair| world.touches(pair)).count();
        let fraction = touching as f32 / self.saturation;
        write(out, [if fraction < 1.0 { fraction } else { 1.0 }]);
    }
}

/// A sensor with one channel that measures the sum of the normal forces of several pairs (in newtons). Wrap it in
/// [`crate::wrappers::Scaled`] to use other units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce<L> {
    pairs: L,
}

impl<L: AsRef<[PairId]>> ContactForce<L> {
    /// Creates a sensor for the given pairs.
    pub fn new(pairs: L) -> Self {
        Self { pairs }
    }
}

impl<L> Channels for ContactForce<L> {
    fn channels(&self) -> usize {
        1
    }
}

impl<L: AsRef<[PairId]>, W: Contacts + ?Sized> Sensor<W> for ContactForce<L> {
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let sum = self.pairs.as_ref().iter().fold(0.0, |sum, &pair| sum + world.pair_contact(pair).normal_force);
        write(out, [sum]);
    }
}
