//! Sensors for the color of the ground.

use crate::channel::{ChannelError, finite, groups, unit};
use crate::ports::{BodyId, Channels, Kinematics, Planar, Sensor};
use crate::sensors::stance::Stance;

/// A sensor that reads the color of the ground at several points below a robot. By default there is one channel per
/// point. It is the mean of red, green and blue in [0, 1].
///
/// Use [`GroundColor::rgb`] to read three channels per point. The points are given in the frame of the robot and can be
/// stored in any list. Wrap the sensor in [`crate::wrappers::Noisy`] to add noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundColor<L, B = BodyId> {
    body: B,
    places: L,
    colors: usize,
}

impl<L: AsRef<[[f32; 2]]>, B> GroundColor<L, B> {
    /// Creates a sensor with one channel for each of the given points in the frame of `body` (in meters).
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if there are no points, or [`ChannelError::Value`] if a coordinate is not
    /// finite.
    pub fn new(body: B, places: L) -> Result<Self, ChannelError> {
        groups("places", places.as_ref().len(), 1)?;
        for &x in places.as_ref().iter().flatten() {
            finite("place", x)?;
        }
        Ok(Self { body, places, colors: 1 })
    }

    /// Enables separate channels for red, green and blue.
    pub fn rgb(self) -> Self {
        Self { colors: 3, ..self }
    }
}

impl<L: AsRef<[[f32; 2]]>, B> Channels for GroundColor<L, B> {
    fn channels(&self) -> usize {
        self.colors * self.places.as_ref().len()
    }
}

impl<L, B, W> Sensor<W> for GroundColor<L, B>
where
    L: AsRef<[[f32; 2]]>,
    B: Copy,
    W: Planar<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let stance = Stance::from_world(world, self.body);
        for (values, &place) in out.chunks_mut(self.colors).zip(self.places.as_ref()) {
            let [r, g, b] = world.ground(stance.place(place)).map(unit);
            let color = if self.colors == 3 { [r, g, b] } else { [(r + g + b) / 3.0; 3] };
            for (o, x) in values.iter_mut().zip(color) {
                *o = unit(x);
            }
        }
    }
}
