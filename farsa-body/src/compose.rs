//! Composition of sensors and motors. Tuples, arrays, slices, options, references and boxes of them are again sensors
//! and motors.
//!
//! The parts are processed in order, and each part has its own range of the slice. If the slice is too short, the first
//! parts are served completely and a later part receives the rest.

#[cfg(feature = "alloc")]
use alloc::{boxed::Box, vec::Vec};

use crate::ports::{Channels, Motor, Sensor};

/// Reads one part and returns what its channels leave of the slice.
#[inline]
fn read_part<'a, W: ?Sized, T: Sensor<W> + ?Sized>(part: &mut T, world: &W, out: &'a mut [f32]) -> &'a mut [f32] {
    let (part_out, rest) = out.split_at_mut(part.channels().min(out.len()));
    part.read(world, part_out);
    rest
}

/// Drives one part and returns what its channels leave of the slice.
#[inline]
fn drive_part<'a, W: ?Sized, T: Motor<W> + ?Sized>(part: &mut T, y: &'a [f32], world: &mut W) -> &'a [f32] {
    let (part_in, rest) = y.split_at(part.channels().min(y.len()));
    part.drive(part_in, world);
    rest
}

macro_rules! tuple {
    ($($part:ident $index:tt),*) => {
        impl<$($part: Channels),*> Channels for ($($part,)*) {
            fn channels(&self) -> usize {
                0 $(+ self.$index.channels())*
            }
            fn reset(&mut self) {
                $(self.$index.reset();)*
            }
        }

        impl<W: ?Sized, $($part: Sensor<W>),*> Sensor<W> for ($($part,)*) {
            #[allow(unused_variables, reason = "the empty tuple has nothing to read")]
            fn read(&mut self, world: &W, out: &mut [f32]) {
                $(let out = read_part(&mut self.$index, world, out);)*
            }
        }

        impl<W: ?Sized, $($part: Motor<W>),*> Motor<W> for ($($part,)*) {
            #[allow(unused_variables, reason = "the empty tuple has nothing to drive")]
            fn drive(&mut self, y: &[f32], world: &mut W) {
                $(let y = drive_part(&mut self.$index, y, world);)*
            }
        }
    };
}

tuple!();
tuple!(A 0);
tuple!(A 0, B 1);
tuple!(A 0, B 1, C 2);
tuple!(A 0, B 1, C 2, D 3);
tuple!(A 0, B 1, C 2, D 3, E 4);
tuple!(A 0, B 1, C 2, D 3, E 4, F 5);
tuple!(A 0, B 1, C 2, D 3, E 4, F 5, G 6);
tuple!(A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7);

impl<T: Channels> Channels for [T] {
    fn channels(&self) -> usize {
        self.iter().map(Channels::channels).sum()
    }
    fn reset(&mut self) {
        for part in self {
            part.reset();
        }
    }
}

impl<W: ?Sized, T: Sensor<W>> Sensor<W> for [T] {
    fn read(&mut self, world: &W, mut out: &mut [f32]) {
        for part in self {
            out = read_part(part, world, out);
        }
    }
}

impl<W: ?Sized, T: Motor<W>> Motor<W> for [T] {
    fn drive(&mut self, mut y: &[f32], world: &mut W) {
        for part in self {
            y = drive_part(part, y, world);
        }
    }
}

/// Owners and borrowers of parts forward every call to them.
macro_rules! forward {
    ([$($generics:tt)*] $part:ty, $owner:ty, $this:ident => $inner:expr, $inner_mut:expr) => {
        impl<$($generics)*> Channels for $owner
        where
            $part: Channels,
        {
            fn channels(&$this) -> usize {
                Channels::channels($inner)
            }
            fn reset(&mut $this) {
                Channels::reset($inner_mut);
            }
        }

        impl<W: ?Sized, $($generics)*> Sensor<W> for $owner
        where
            $part: Sensor<W>,
        {
            fn read(&mut $this, world: &W, out: &mut [f32]) {
                Sensor::read($inner_mut, world, out);
            }
        }

        impl<W: ?Sized, $($generics)*> Motor<W> for $owner
        where
            $part: Motor<W>,
        {
            fn drive(&mut $this, y: &[f32], world: &mut W) {
                Motor::drive($inner_mut, y, world);
            }
        }
    };
}

forward!([T: ?Sized] T, &mut T, self => &**self, &mut **self);
forward!([T, const N: usize] T, [T; N], self => self.as_slice(), self.as_mut_slice());
forward!([T] T, Option<T>, self => self.as_slice(), self.as_mut_slice());
#[cfg(feature = "alloc")]
forward!([T: ?Sized] T, Box<T>, self => &**self, &mut **self);
#[cfg(feature = "alloc")]
forward!([T] T, Vec<T>, self => self.as_slice(), self.as_mut_slice());
