//! A sensor for the signals of other robots.

use farsa_num::{Scalar, atan2};

use crate::channel::{ChannelError, groups, positive, unit};
use crate::ports::{BodyId, Channels, Kinematics, NearbySurface, Sensor, Sight};
use crate::sensors::stance::Stance;

/// A sensor that receives the signals of other robots in `SECTORS` equal sectors. Each sector has one channel in [0,
/// 1]. It is the strongest signal in the sector.
///
/// Use [`SignalSensor::mean`] to read the mean signal instead. A channel is 0 if there is no robot in the sector. The
/// first sector is centered straight ahead, and the others follow counter-clockwise. For example, four sectors are
/// ahead, left, behind and right. A signal is not attenuated within the range and passes through all objects. A robot
/// belongs to the sector that contains its center. Wrap the sensor in [`crate::wrappers::Noisy`] to add noise.
#[doc(alias = "communication")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalSensor<const SECTORS: usize, B = BodyId> {
    body: B,
    range: f32,
    mean: bool,
}

impl<const SECTORS: usize, B> SignalSensor<SECTORS, B> {
    /// Creates a sensor on `body` that receives the signals of robots whose hull is within `range` (in meters) of the
    /// origin of the body.
    ///
    /// # Errors
    /// Returns [`ChannelError::Value`] if `range` is not a finite number > 0, or [`ChannelError::Groups`] if there are
    /// no sectors.
    pub fn new(body: B, range: f32) -> Result<Self, ChannelError> {
        groups("sectors", SECTORS, 1)?;
        Ok(Self { body, range: positive("range", range)?, mean: false })
    }

    /// Uses the mean of the signals in a sector instead of the strongest signal.
    pub fn mean(self) -> Self {
        Self { mean: true, ..self }
    }
}

impl<const SECTORS: usize, B> Channels for SignalSensor<SECTORS, B> {
    fn channels(&self) -> usize {
        SECTORS
    }
}

/// The sector of a direction of the robot's frame.
fn sector([x, y]: [f32; 2], sectors: usize) -> usize {
    const FULL: f32 = 2.0 * core::f32::consts::PI;
    let turns = atan2(y, x) / FULL;
    // Half a sector more, because the first lies on both sides of straight ahead. The cast takes NaN for 0.
    let number = libm::floorf(turns * sectors as f32 + 0.5);
    let number = if number < 0.0 { number + sectors as f32 } else { number };
    number as usize % sectors.max(1)
}

impl<const SECTORS: usize, B, W> Sensor<W> for SignalSensor<SECTORS, B>
where
    B: Copy + PartialEq,
    W: Sight<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let stance = Stance::from_world(world, self.body);
        let (mut heard, mut robots) = ([0.0_f32; SECTORS], [0.0_f32; SECTORS]);
        world.query_near(stance.at, self.range, &mut |near: NearbySurface<B>| {
            let Some(signal) = near.signal.filter(|_| near.body != Some(self.body)) else { return };
            let sector = sector(stance.bearing(&near), SECTORS);
            if let (Some(heard), Some(robots)) = (heard.get_mut(sector), robots.get_mut(sector)) {
                let signal = unit(signal);
                *heard = if self.mean { *heard + signal } else { Scalar::max(*heard, signal) };
                *robots += 1.0;
            }
        });
        for ((o, heard), robots) in out.iter_mut().zip(heard).zip(robots) {
            *o = if self.mean && robots > 0.0 { unit(heard / robots) } else { heard };
        }
    }
}
