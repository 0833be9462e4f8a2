//! Wheeled robots, and the identifiers of their parts in a planar world.

use alloc::string::String;
use alloc::vec::Vec;
use core::f64::consts::PI;

use crate::ports::{ActuatorId, BodyId, JointId};

/// A ring of infrared sensors around the hull of a robot.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct InfraredRing {
    /// Directions of the sensors, counter-clockwise from straight ahead (in radians). They also determine the
    /// positions of the sensors on the hull.
    pub angles: Vec<f64>,
    /// Range of the sensors, measured from the hull (in meters).
    pub range: f64,
    /// Half the opening angle of the cone in which a sensor detects objects (in radians).
    pub aperture: f64,
    /// Number of rays that sample the cone of each sensor.
    pub rays: usize,
}

/// A round robot with two wheels. The origin of its frame is on the ground between the wheels, with x pointing ahead, y
/// to the left and z up.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MobileRobot {
    /// Name of the robot.
    pub name: String,
    /// Radius of the hull (in meters).
    pub radius: f64,
    /// Height of the robot in meters.
    pub height: f64,
    /// Radius of the wheels (in meters).
    pub wheel_radius: f64,
    /// Distance between the wheels (in meters).
    pub track: f64,
    /// Largest angular speed of a wheel in both directions, in radians per second.
    pub max_wheel_speed: f64,
    /// Ring of infrared sensors.
    pub infrared: InfraredRing,
    /// Positions of the ground color sensors in the frame of the robot (in meters).
    pub ground: Vec<[f64; 2]>,
    /// Red, green and blue components of the hull's color (between 0 and 1). It is visible when no LED is on.
    pub color: [f64; 3],
    /// True if the robot has LEDs. They are three actuators for red, green and blue.
    pub leds: bool,
    /// True if the robot can send a signal. The signal is an actuator.
    pub signal: bool,
    /// The reach of the attachment device, measured from the hull (in meters), or `None` if there is no such device.
    /// The device is an actuator.
    pub attachment: Option<f64>,
}

fn degrees(angles: &[f64]) -> Vec<f64> {
    angles.iter().map(|angle| angle * (PI / 180.0)).collect()
}

impl MobileRobot {
    /// Returns the Khepera. It has a radius of 35 mm, wheels of 15 mm at a distance of 55 mm that turn at up to 1.1
    /// turns/s, and eight infrared sensors.
    ///
    /// The values are those of FARSA2, except for the height, the color and the aperture. The aperture is
    /// interpreted as half the angle of the cone.
    pub fn khepera() -> Self {
        Self {
            name: "Khepera".into(),
            radius: 0.035,
            height: 0.03,
            wheel_radius: 0.015,
            track: 0.055,
            max_wheel_speed: 1.1 * 2.0 * PI,
            infrared: InfraredRing {
                // Left to right in front, then the two behind.
                angles: degrees(&[60.0, 36.0, 12.0, -12.0, -36.0, -60.0, -160.0, 160.0]),
                range: 0.05,
                aperture: 10.0 * (PI / 180.0),
                rays: 5,
            },
            ground: Vec::from([[0.0, 0.0]]),
            color: [0.2, 0.2, 0.2],
            leds: false,
            signal: false,
            attachment: None,
        }
    }

    /// Returns the e-puck. It has a hull of 35 mm, wheels of 20.5 mm at a distance of 53 mm, and a speed of up to 144
    /// mm/s. It has eight infrared sensors, three ground sensors and LEDs.
    ///
    /// The values are those of FARSA2. The height, the color, the aperture and rays of the infrared sensors, and the
    /// positions of the ground sensors were chosen.
    pub fn e_puck() -> Self {
        Self {
            name: "e-puck".into(),
            radius: 0.035,
            height: 0.05,
            wheel_radius: 0.0205,
            track: 0.053,
            max_wheel_speed: 0.144 / 0.0205,
            infrared: InfraredRing {
                angles: degrees(&[90.0, 54.0, 18.0, -18.0, -54.0, -90.0, -150.0, 150.0]),
                range: 0.05,
                aperture: 10.0 * (PI / 180.0),
                rays: 5,
            },
            ground: Vec::from([[0.03, 0.01], [0.03, 0.0], [0.03, -0.01]]),
            color: [0.1, 0.4, 0.1],
            leds: true,
            signal: true,
            attachment: None,
        }
    }

    /// Returns the `MarXbot`. It has a radius of 85 mm, and wheels of 27 mm at a distance of 126.5 mm that turn at up
    /// to 10 rad/s. It has 24 infrared sensors, twelve ground sensors, LEDs and an attachment device.
    ///
    /// The values are those of FARSA2. The height, the color, the positions of the ground sensors (four in the inner
    /// and eight in the outer ring), and the reach of the attachment device were chosen.
    pub fn marxbot() -> Self {
        let around = |count: usize, radius: f64, first: f64| {
            (0..count).map(move |i| {
                let (sine, cosine) = farsa_num::sin_cos(first + 2.0 * PI * i as f64 / count as f64);
                [radius * cosine, radius * sine]
            })
        };
        Self {
            name: "MarXbot".into(),
            radius: 0.085,
            height: 0.17,
            wheel_radius: 0.027,
            track: 0.1265,
            max_wheel_speed: 10.0,
            infrared: InfraredRing {
                angles: (0..24).map(|i| 2.0 * PI * f64::from(i) / 24.0).collect(),
                range: 0.1,
                aperture: 10.0 * (PI / 180.0),
                rays: 5,
            },
            ground: around(4, 0.03, PI / 4.0).chain(around(8, 0.08, 0.0)).collect(),
            color: [0.3, 0.3, 0.35],
            leds: true,
            signal: true,
            attachment: Some(0.02),
        }
    }

    /// Returns the number of actuators. These are the two wheels, followed by the three LEDs, the signal and the
    /// attachment device if the robot has them.
    pub fn actuators(&self) -> usize {
        2 + 3 * usize::from(self.leds) + usize::from(self.signal) + usize::from(self.attachment.is_some())
    }

    /// Returns the identifiers of all parts, given those of the body, the left wheel and the first actuator.
    pub fn parts(&self, body: BodyId, left_wheel: JointId, first: ActuatorId) -> MobileParts {
        let mut next = first.0;
        let mut actuator = || {
            next += 1;
            ActuatorId(next - 1)
        };
        MobileParts {
            body,
            wheels: [left_wheel, JointId(left_wheel.0 + 1)],
            motors: [actuator(), actuator()],
            leds: self.leds.then(|| [actuator(), actuator(), actuator()]),
            signal: self.signal.then(&mut actuator),
            attachment: self.attachment.map(|_| actuator()),
        }
    }
}

/// The identifiers of the parts of a [`MobileRobot`] in a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MobileParts {
    /// Body of the robot.
    pub body: BodyId,
    /// Left and right wheels.
    pub wheels: [JointId; 2],
    /// Motors of the left and the right wheel. Their commands are speeds, in radians per second.
    pub motors: [ActuatorId; 2],
    /// The red, green and blue LEDs, if the robot has them. Their commands are brightnesses (between 0 and 1).
    pub leds: Option<[ActuatorId; 3]>,
    /// Signal whose command is its value (between 0 and 1).
    pub signal: Option<ActuatorId>,
    /// Attachment device that holds for commands above 0.5.
    pub attachment: Option<ActuatorId>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_numbered_in_a_row() {
        for robot in [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()] {
            let parts = robot.parts(BodyId(4), JointId(8), ActuatorId(20));
            let mut all: Vec<ActuatorId> = parts.motors.to_vec();
            all.extend(parts.leds.into_iter().flatten());
            all.extend(parts.signal);
            all.extend(parts.attachment);
            assert_eq!(all.len(), robot.actuators());
            assert!(all.iter().zip(20..).all(|(actuator, number)| actuator.0 == number), "{}: {all:?}", robot.name);
            assert_eq!((parts.body, parts.wheels), (BodyId(4), [JointId(8), JointId(9)]));
        }
    }

    #[test]
    fn rings_are_symmetric_and_sensors_lie_within_the_hull() {
        for robot in [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()] {
            let turned = |angle: f64| if angle > PI + 1e-9 { angle - 2.0 * PI } else { angle };
            for &angle in &robot.infrared.angles {
                let mirrored = -turned(angle);
                let same = |other: &f64| {
                    let gap = (turned(*other) - mirrored).abs();
                    gap < 1e-9 || (gap - 2.0 * PI).abs() < 1e-9
                };
                assert!(robot.infrared.angles.iter().any(same), "{}: {angle}", robot.name);
            }
            let within = |[x, y]: &[f64; 2]| x * x + y * y <= robot.radius * robot.radius;
            assert!(robot.ground.iter().all(within) && robot.track < 2.0 * robot.radius, "{}", robot.name);
        }
    }
}
