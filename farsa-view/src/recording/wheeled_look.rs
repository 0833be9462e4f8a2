//! Appearance of wheeled robots: drawn parts within their hull.

use core::f64::consts::{FRAC_1_SQRT_2, TAU};

use farsa_body::Pose;
use farsa_body::robots::MobileRobot;
use farsa_num::{Scalar, sin_cos};

use crate::shape::appearance::Color;
use crate::shape::geometry::Geometry;
use crate::shape::scene_object::screen_color;

/// Color of wheels, tracks and the dark parts between them.
const DARK: Color = [40, 43, 48];
/// Color of the stripe that points ahead, and of bright plastic.
const LIGHT: Color = [250, 250, 245];
/// Color of LEDs in any state.
const LED: Color = [255, 236, 190];
/// Width of wheels, relative to the radius of the hull.
const WIDTH: f64 = 0.22;
/// Width of the narrower wheels of an e-puck.
const NARROW: f64 = 0.1;
/// Rotation of z, the axis of cylinders, to y.
const ON_AXLE: [f64; 4] = [FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];

/// A part in the robot's frame.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Name, empty for the body.
    pub(crate) name: &'static str,
    pub(crate) geometry: Geometry,
    pub(crate) place: Pose<f64>,
    pub(crate) color: Color,
}

/// Lists the parts of a robot, its body first, by the wheels of a Khepera, an e-puck or a `MarXbot`, otherwise a disc.
///
/// All parts are within the hull. Wheels have the size and distance of the robot's as far as the hull permits.
pub(crate) fn parts(robot: &MobileRobot) -> Vec<Part> {
    let drives_as = |known: MobileRobot| [known.wheel_radius, known.track] == [robot.wheel_radius, robot.track];
    let look = Look::new(robot);
    if drives_as(MobileRobot::khepera()) {
        look.khepera()
    } else if drives_as(MobileRobot::e_puck()) {
        look.e_puck()
    } else if drives_as(MobileRobot::marxbot()) {
        look.marxbot()
    } else {
        look.generic()
    }
}

/// Returns the hull only, for large numbers of robots.
pub(crate) fn hull(robot: &MobileRobot) -> Vec<Part> {
    let look = Look::new(robot);
    vec![look.disc("", 1.0, [0.0, 0.98], look.color), look.stripe([0.15, 0.95], 0.98)]
}

/// Returns a lighter color, or a darker one for a negative share.
fn shaded(color: Color, share: f64) -> Color {
    let to = if share < 0.0 { 0.0 } else { 255.0 };
    color.map(|x| (f64::from(x) + (to - f64::from(x)) * share.abs()).round() as u8)
}

/// Lengths of parts [m].
struct Look {
    radius: f64,
    height: f64,
    wheel: f64,
    track: f64,
    color: Color,
}

impl Look {
    fn new(robot: &MobileRobot) -> Self {
        let &MobileRobot { radius, height, wheel_radius, track, color, .. } = robot;
        Self { radius, height, wheel: wheel_radius.min(0.5 * height), track, color: screen_color(color) }
    }

    /// Returns a vertical disc around the center between two heights, relative to the radius and height of the hull.
    fn disc(&self, name: &'static str, radius: f64, [low, high]: [f64; 2], color: Color) -> Part {
        let [low, high] = [low, high].map(|part| part * self.height);
        let geometry = Geometry::Cylinder { radius: radius * self.radius, half_length: 0.5 * (high - low) };
        Part { name, geometry, place: Pose::at([0.0, 0.0, 0.5 * (low + high)]), color }
    }

    /// Returns the mark of the front between two distances from the center at a height, relative to the hull.
    fn stripe(&self, [from, to]: [f64; 2], height: f64) -> Part {
        let [half, at] = [0.5 * (to - from), 0.5 * (from + to)].map(|part| part * self.radius);
        let thick = 0.005 * self.height;
        let geometry = Geometry::Box { half: [half, 0.09 * self.radius, thick] };
        let place = Pose::at([at, 0.0, height * self.height + thick]);
        Part { name: "ahead", geometry, place, color: LIGHT }
    }

    /// Returns the distance of the outer ends of wheels of a width from the center, relative to the radius of the hull.
    fn outside(&self, width: f64) -> f64 {
        let wheel = (self.wheel / self.radius).min(1.0);
        (0.5 * (self.track / self.radius + width)).min(0.999 * Scalar::sqrt(1.0 - wheel * wheel))
    }

    /// Returns two wheels of a width relative to the radius of the hull, at a distance ahead [m].
    fn wheels(&self, name: &'static str, width: f64, ahead: f64) -> impl Iterator<Item = Part> {
        let (half, middle) = (0.5 * width * self.radius, (self.outside(width) - 0.5 * width) * self.radius);
        let geometry = Geometry::Cylinder { radius: self.wheel, half_length: half };
        let at = move |y: f64| Pose { position: [ahead, y, self.wheel], rotation: ON_AXLE };
        let fits = middle >= half;
        let sides = [middle, -middle].into_iter().filter(move |_| fits);
        sides.map(move |y| Part { name, geometry, place: at(y), color: DARK })
    }

    /// Returns a disc on wheels.
    fn generic(&self) -> Vec<Part> {
        let low = (0.6 * self.wheel / self.height).min(0.3);
        let body = [self.disc("", 1.0, [low, 0.98], self.color), self.stripe([0.15, 0.95], 0.98)];
        body.into_iter().chain(self.wheels("wheel", WIDTH, 0.0)).collect()
    }

    /// Returns a round board over a low body, with the wheels through it.
    fn khepera(&self) -> Vec<Part> {
        let chassis = self.outside(WIDTH) - WIDTH;
        let body = [
            self.disc("", 0.99, [0.66, 0.74], self.color),
            self.disc("chassis", chassis.max(0.4), [0.12, 0.66], shaded(self.color, -0.5)),
            self.disc("processor", 0.34, [0.74, 0.88], shaded(self.color, -0.4)),
            self.stripe([0.4, 0.96], 0.74),
        ];
        body.into_iter().chain(self.wheels("wheel", WIDTH, 0.0)).collect()
    }

    /// Returns a translucent body under a ring of LEDs, with a camera in front.
    fn e_puck(&self) -> Vec<Part> {
        let shell = self.outside(NARROW) - NARROW;
        let (board, top) = (0.66, 0.94);
        let camera = Geometry::Box { half: [0.1, 0.14, 0.1].map(|x| x * self.radius) };
        let camera_at = Pose::at([0.84 * self.radius, 0.0, board * self.height + 0.1 * self.radius]);
        let body = [
            self.disc("", 0.7, [board, top], self.color),
            self.disc("shell", shell.max(0.4), [0.08, 0.6], shaded(self.color, 0.55)),
            self.disc("ring", 0.94, [0.6, board], shaded(self.color, 0.3)),
            self.stripe([0.05, 0.68], top),
            Part { name: "camera", geometry: camera, place: camera_at, color: DARK },
        ];
        // Both ends of a bar through the ring are visible, two of eight LEDs.
        let leds = |number: u8| {
            let (sine, cosine) = sin_cos((f64::from(number) + 0.5) / 16.0 * TAU);
            let half = [0.985 * self.radius, 0.06 * self.radius, 0.024 * self.height];
            let place = Pose { position: [0.0, 0.0, 0.63 * self.height], rotation: [0.0, 0.0, sine, cosine] };
            Part { name: "LEDs", geometry: Geometry::Box { half }, place, color: LED }
        };
        body.into_iter().chain((0..4).map(leds)).chain(self.wheels("wheel", NARROW, 0.0)).collect()
    }

    /// Returns a body on tracks, each around two wheels, with a ring around it and a camera on its turret.
    fn marxbot(&self) -> Vec<Part> {
        let outside = self.outside(WIDTH);
        let apart = (Scalar::sqrt((1.0 - outside * outside).max(0.0)) * 0.999 * self.radius - self.wheel).max(0.0);
        let bottom = (1.3 * self.wheel / self.height).min(0.4);
        let body = [
            self.disc("", 0.93, [bottom, 0.66], self.color),
            self.disc("ring", 1.0, [0.45, 0.53], shaded(self.color, 0.65)),
            self.disc("turret", 0.3, [0.66, 0.9], shaded(self.color, 0.4)),
            self.disc("camera", 0.36, [0.9, 1.0], DARK),
            self.stripe([0.4, 0.9], 0.66),
        ];
        body.into_iter().chain(self.wheels("track", WIDTH, apart)).chain(self.wheels("track", WIDTH, -apart)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robots() -> Vec<MobileRobot> {
        let known = [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()];
        let cart = MobileRobot { wheel_radius: 0.03, track: 0.1, radius: 0.1, ..MobileRobot::khepera() };
        let others = [
            // The robot of `discrimination`, whose axle is longer than its hull permits.
            MobileRobot { radius: 0.0275, ..MobileRobot::e_puck() },
            MobileRobot { radius: 0.01, ..MobileRobot::e_puck() },
            MobileRobot { radius: 0.03, height: 0.02, ..MobileRobot::marxbot() },
            MobileRobot { radius: 0.3, height: 0.5, ..MobileRobot::khepera() },
            MobileRobot { track: 0.15, ..cart.clone() },
            MobileRobot { track: 0.4, wheel_radius: 0.2, ..cart.clone() },
            cart,
        ];
        known.into_iter().chain(others).collect()
    }

    /// Returns points that bound a part.
    fn corners(part: &Part) -> Vec<[f64; 3]> {
        let local: Vec<[f64; 3]> = match part.geometry {
            Geometry::Cylinder { radius, half_length } => (0..720)
                .flat_map(|i| {
                    let (sine, cosine) = sin_cos(f64::from(i) * TAU / 720.0);
                    [-half_length, half_length].map(|z| [radius * cosine, radius * sine, z])
                })
                .collect(),
            geometry => geometry.hull().into_iter().map(|(corner, _)| corner).collect(),
        };
        local.into_iter().map(|point| part.place.transform(point)).collect()
    }

    #[test]
    fn every_part_lies_within_the_hull() {
        for robot in robots() {
            for part in parts(&robot).into_iter().chain(hull(&robot)) {
                for [x, y, z] in corners(&part) {
                    let inside = x.hypot(y) <= robot.radius + 1e-12;
                    assert!(inside && (-1e-12..=robot.height + 1e-12).contains(&z), "{} {part:?}", robot.name);
                }
            }
        }
    }

    #[test]
    fn wheels_are_the_robots_own() {
        for (robot, count) in robots().into_iter().zip([2, 2, 4]) {
            let wheels: Vec<Part> =
                parts(&robot).into_iter().filter(|part| ["wheel", "track"].contains(&part.name)).collect();
            assert_eq!(wheels.len(), count, "{}", robot.name);
            for wheel in wheels {
                let Geometry::Cylinder { radius, .. } = wheel.geometry else { panic!("{wheel:?}") };
                assert_eq!((radius, wheel.place.position[2]), (robot.wheel_radius, robot.wheel_radius));
                let [_, y, _] = wheel.place.position;
                assert!((y.abs() - 0.5 * robot.track).abs() < 1e-12, "{}: {y}", robot.name);
                let axle = wheel.place.rotate([0.0, 0.0, 1.0]);
                assert!(axle[1].abs() > 1.0 - 1e-12);
            }
        }
    }

    #[test]
    fn looks_differ_and_keep_the_robots_colour_whatever_they_are_called() {
        let names = |robot: &MobileRobot| parts(robot).iter().map(|part| part.name).collect::<Vec<_>>();
        let [khepera, e_puck, marxbot] = [MobileRobot::khepera(), MobileRobot::e_puck(), MobileRobot::marxbot()];
        assert!(names(&khepera).contains(&"processor") && !names(&khepera).contains(&"LEDs"));
        assert_eq!(names(&e_puck).iter().filter(|name| **name == "LEDs").count(), 4);
        assert!(names(&marxbot).contains(&"turret"));
        for robot in robots() {
            let painted = MobileRobot { name: "prey".into(), color: [0.1, 0.25, 0.85], ..robot.clone() };
            assert_eq!(names(&painted), names(&robot));
            let seen = parts(&painted);
            assert_eq!((seen[0].name, seen[0].color), ("", [26, 64, 217]));
            // The front is a unique mark in front of the center.
            let ahead: Vec<&Part> = seen.iter().filter(|part| part.name == "ahead").collect();
            assert!(ahead.len() == 1 && ahead[0].place.position[0] > 0.3 * robot.radius);
        }
        assert_eq!((shaded([100, 0, 255], 0.5), shaded([100, 0, 255], -0.5)), ([178, 128, 255], [50, 0, 128]));
    }
}
