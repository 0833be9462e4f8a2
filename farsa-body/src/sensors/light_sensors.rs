//! Sensors for the light of lamps.

#[cfg(feature = "alloc")]
use alloc::vec::Vec;

use farsa_num::Scalar;

use crate::channel::{ChannelError, groups, positive, unit};
use crate::ports::{BodyId, Channels, Kinematics, Lamp, Planar, Sensor};
#[cfg(feature = "alloc")]
use crate::robots::mobile::MobileRobot;
use crate::sensors::beam::Beam;
use crate::sensors::stance::Stance;

/// A ring of light sensors. Each sensor has one channel in [0, 1]. It is the brightness of all visible lamps.
///
/// A lamp contributes intensity cos(a) (reference / d)^2, where d is the distance from the sensor to the center of the
/// lamp. The angle a is measured between this direction and the axis of the sensor. Lamps with an angle of more than 90
/// degrees have no effect. The sum is limited to 1. A lamp is hidden if another body or a wall is between the sensor
/// and its center. The robot itself does not hide any lamps in front of a sensor, and a lamp on the robot is invisible.
///
/// The positions and axes of the sensors are given as a list of [`Beam`]s. Wrap the sensor in
/// [`crate::wrappers::Noisy`] to add noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSensors<L, B = BodyId> {
    body: B,
    sensors: L,
    reference: f32,
}

impl<L: AsRef<[Beam]>, B> LightSensors<L, B> {
    /// Creates light sensors on `body`. A lamp of intensity 1 that is straight ahead at a distance of `reference` (in
    /// meters) results in a reading of 1.
    ///
    /// # Errors
    /// Returns [`ChannelError::Groups`] if there are no sensors. Returns [`ChannelError::Value`] if a direction is not
    /// a unit vector, if a position is not finite, or if `reference` is not a finite number > 0.
    pub fn new(body: B, sensors: L, reference: f32) -> Result<Self, ChannelError> {
        groups("sensors", sensors.as_ref().len(), 1)?;
        sensors.as_ref().iter().try_for_each(Beam::check)?;
        Ok(Self { body, sensors, reference: positive("reference distance", reference)? })
    }
}

#[cfg(feature = "alloc")]
impl<B> LightSensors<Vec<Beam>, B> {
    /// Creates light sensors at the positions of the robot's infrared sensors. In the Khepera, the same sensors
    /// measure both.
    ///
    /// # Errors
    /// Returns the errors of [`LightSensors::new`].
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
