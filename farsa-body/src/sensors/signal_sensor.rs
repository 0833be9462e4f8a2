//! Signals of other robots.

use farsa_num::{Scalar, atan2};

use crate::channel::{ChannelError, groups, positive, unit};
use crate::ports::{BodyId, Channels, Kinematics, NearbySurface, Sensor, Sight};
use crate::sensors::stance::Stance;

/// Reads what other robots signal, in `SECTORS` equal sectors around a robot, one channel each in [0, 1]: the strongest
/// signal.
///
/// After [`SignalSensor::mean`] the mean over the robots of a sector. 0 where no robot is heard. The first sector lies
/// around straight ahead, the others follow counter-clockwise. Four sectors are ahead, left, behind and right. A robot
/// is heard as loudly at every distance within the range, and through everything. It belongs to the sector of its
/// center. Wrap it in [`crate::wrappers::Noisy`] for noise.
#[doc(alias = "communication")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalSensor<const SECTORS: usize, B = BodyId> {
    body: B,
    range: f32,
    mean: bool,
}

impl<const SECTORS: usize, B> SignalSensor<SECTORS, B> {
    /// An ear of `body` for robots whose hull is within `range` [m] of its origin.
    ///
    /// # Errors
    /// [`ChannelError::Value`] if `range` is not a finite number > 0, [`ChannelError::Groups`] if there are no sectors.
    pub fn new(body: B, range: f32) -> Result<Self, ChannelError> {
        groups("sectors", SECTORS, 1)?;
        Ok(Self { body, range: positive("range", range)?, mean: false })
    }

    /// Reads the mean of the signals instead of the strongest.
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
