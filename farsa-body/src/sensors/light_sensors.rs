//! Sensors of lamps.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::channel::{ChannelError, groups, positive, unit};
use crate::ports::{BodyId, Channels, Kinematics, Lamp, Planar, Sensor};
#[cfg(feature = "alloc")]
use crate::robots::mobile::MobileRobot;
use crate::sensors::beam::Beam;
use crate::sensors::stance::Stance;

/// Reads how brightly lamps shine on a ring of sensors, one channel each in [0, 1].
///
/// Every visible lamp adds intensity cos(a) (reference / d)^2. The distance d is that from the sensor to the lamp's
/// center, and a the angle between that way and the sensor's direction. Behind a sensor (a beyond 90 degrees) a lamp
/// adds nothing, and the sum is cut at 1. A lamp is hidden when the first thing on the way from the sensor to its
/// center is another body or a wall. The robot's own body hides only lamps behind the sensor, and a lamp on the robot
/// itself is invisible.
///
/// The sensors are any list of [`Beam`]s: where they sit and where they look to. Wrap it in [`crate::wrappers::Noisy`] for noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSensors<L, B = BodyId> {
    body: B,
    sensors: L,
    reference: f32,
}

impl<L: AsRef<[Beam]>, B> LightSensors<L, B> {
    /// Sensors on `body` that read 1 of a lamp of intensity 1 straight ahead of them as near as `reference` [m].
    ///
    /// # Errors
    /// [`ChannelError::Groups`] if there are no sensors, [`ChannelError::Value`] if a direction is no unit vector, a place
    /// is not finite or `reference` is not a finite number > 0.
    pub fn new(body: B, sensors: L, reference: f32) -> Result<Self, ChannelError> {
        groups("sensors", sensors.as_ref().len(), 1)?;
        sensors.as_ref().iter().try_for_each(Beam::check)?;
        Ok(Self { body, sensors, reference: positive("reference distance", reference)? })
    }
}

#[cfg(feature = "alloc")]
impl<B> LightSensors<Vec<Beam>, B> {
    /// Sensors where a robot has its infrared sensors, as those of the Khepera measure both.
    ///
    /// # Errors
    /// The errors of [`LightSensors::new`].
    pub fn for_robot(robot: &MobileRobot, body: B, reference: f32) -> Result<Self, ChannelError> {
        let sensor = |&angle: &f64| Beam::in_cone(robot.radius, angle, 0.0, 0, 1);
        Self::new(body, robot.infrared.angles.iter().map(sensor).collect(), reference)
    }
}

impl<L: AsRef<[Beam]>, B> Channels for LightSensors<L, B> {
    fn channels(&self) -> usize {
        self.sensors.as_ref().len()
    }
}

impl<L, B, W> Sensor<W> for LightSensors<L, B>
where
    L: AsRef<[Beam]>,
    B: Copy + PartialEq,
    W: Planar<Body = B> + Kinematics + ?Sized,
{
    fn read(&mut self, world: &W, out: &mut [f32]) {
        let (stance, sensors) = (Stance::from_world(world, self.body), self.sensors.as_ref());
        let channels = sensors.len().min(out.len());
        let out = &mut out[..channels];
        out.fill(0.0);
        world.lamps(&mut |lamp: Lamp<B>| {
            if lamp.body == self.body {
                return;
            }
            for (o, sensor) in out.iter_mut().zip(sensors) {
                let (from, axis) = (stance.place(sensor.from), stance.turn(sensor.direction));
                let way = [lamp.position[0] - from[0], lamp.position[1] - from[1]];
                let square = way[0] * way[0] + way[1] * way[1];
                let distance = Scalar::sqrt(square);
                let towards = way.map(|x| x / distance);
                let cosine = axis[0] * towards[0] + axis[1] * towards[1];
                // False for a lamp at the sensor's very place: there is no way to it.
                if cosine > 0.0 {
                    let hidden = world
                        .cast_planar(from, towards, distance, Some(self.body))
                        .is_some_and(|sight| sight.body != Some(lamp.body));
                    if !hidden {
                        *o += lamp.intensity * cosine * self.reference * self.reference / square;
                    }
                }
            }
        });
        for o in out {
            *o = unit(*o);
        }
    }
}
