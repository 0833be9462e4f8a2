//! Sensors of contact.

use crate::channel::{ChannelError, positive, write};
use crate::ports::{Channels, Contacts, PairId, Sensor};

/// Reads how many pairs of a group touch: min(1, n / saturation), one channel.
///
/// A pair counts once however many points it touches with, and only under a normal force > 0. The group is any list
/// of pairs: an array, a borrowed slice, a `Vec`. For several patches of skin take an array or a `Vec` of these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<L> {
    pairs: L,
    saturation: f32,
}

impl<L: AsRef<[PairId]>> Touch<L> {
    /// A sensor of these pairs that reads 1 as soon as `saturation` of them touch.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if `saturation` is not a finite number > 0.
    pub fn new(pairs: L, saturation: f32) -> Result<Self, ChannelError> {
        Ok(Self { pairs, saturation: positive("saturation", saturation)? })
    }

    /// The pairs of the group.
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

/// Reads the sum of the normal forces of a group of pairs [N], one channel. Wrap it in [`crate::wrappers::Scaled`] for
/// other units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce<L> {
    pairs: L,
}

impl<L: AsRef<[PairId]>> ContactForce<L> {
    /// A sensor of these pairs.
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
