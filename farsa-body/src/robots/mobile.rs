//! Wheeled robots as data, and the numbers of their parts in a planar world.

use alloc::string::String;
use alloc::vec::Vec;
use core::f64::consts::PI;

use crate::ports::{ActuatorId, BodyId, JointId};

/// A ring of infrared sensors.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct InfraredRing {
    /// Where the sensors sit on the hull and look to, counter-clockwise from ahead [rad].
    pub angles: Vec<f64>,
    /// The range of the sensors from the hull [m].
    pub range: f64,
    /// Half the angle of the cone that each sees [rad].
    pub aperture: f64,
    /// Rays by which a cone is sampled.
    pub rays: usize,
}

/// A round robot on two wheels as data. Frame: x ahead, y to the left, z up, the origin on the ground between the
/// wheels.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MobileRobot {
    /// The name.
    pub name: String,
    /// Radius of the hull [m].
    pub radius: f64,
    /// Height [m].
    pub height: f64,
    /// Radius of the wheels [m].
    pub wheel_radius: f64,
    /// Distance between the wheels [m].
    pub track: f64,
    /// The fastest that a wheel turns, either way [rad/s].
    pub max_wheel_speed: f64,
    /// The infrared sensors around it.
    pub infrared: InfraredRing,
    /// Where the sensors of the ground's color are, in the robot's frame [m].
    pub ground: Vec<[f64; 2]>,
    /// Color of the hull, where no LED shines: red, green and blue [0..1].
    pub color: [f64; 3],
    /// True if it has LEDs: three actuators, red, green and blue.
    pub leds: bool,
    /// True if it can signal: an actuator.
    pub signal: bool,
    /// The reach of its attachment device from the hull [m], if it has one. The device is an actuator.
    pub attachment: Option<f64>,
}

fn degrees(angles: &[f64]) -> Vec<f64> {
    angles.iter().map(|angle| angle * (PI / 180.0)).collect()
}

impl MobileRobot {
    /// The Khepera: 35 mm, wheels of 15 mm 55 mm apart, 1.1 turns/s, eight infrared sensors.
    ///
    /// Numbers: FARSA2's. Ours: height, color, aperture as half the cone's angle.
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

    /// The e-puck: hull of 35 mm, wheels of 20.5 mm 53 mm apart, 144 mm/s, eight infrared sensors, three of the ground, LEDs.
    ///
    /// Numbers: FARSA2's. Ours: height, color, aperture and rays of the infrared sensors, places of the ground sensors.
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

    /// The `MarXbot`: 85 mm, wheels of 27 mm 126.5 mm apart, 10 rad/s, 24 infrared sensors, twelve of the ground, LEDs, an
    /// attachment device.
    ///
    /// Numbers: FARSA2's. Ours: height, color, places of the ground sensors (four within, eight around), reach of the
    /// attachment device.
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

    /// Number of its actuators: two wheels, then LEDs (three), signal and attachment device as far as it has them.
    pub fn actuators(&self) -> usize {
        2 + 3 * usize::from(self.leds) + usize::from(self.signal) + usize::from(self.attachment.is_some())
    }

    /// Names for its parts when its body, its left wheel and its first actuator have these numbers.
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

/// The numbers of a [`MobileRobot`]'s parts in a world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MobileParts {
    /// The robot.
    pub body: BodyId,
    /// The wheels, left and right.
    pub wheels: [JointId; 2],
    /// The motors of the wheels, left and right. Commands are speeds [rad/s].
    pub motors: [ActuatorId; 2],
    /// The LEDs, red, green and blue, commands are brightnesses [0..1].
    pub leds: Option<[ActuatorId; 3]>,
    /// The signal [0..1].
    pub signal: Option<ActuatorId>,
    /// The attachment device, which holds above 0.5.
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
