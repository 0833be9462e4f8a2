//! Recorders that receive the data of an episode and write it to a file, a page or a viewer.

use crate::ports::{BodyId, Contacts, Kinematics, PairContact, PairId};
use crate::pose::Pose;

/// A recorder receives the data of an episode tick by tick, for example to write a table or a page.
///
/// During a tick, the values can be passed in any order. The call of [`tick`](Self::tick) ends the tick. All other
/// methods do nothing by default. Callers may therefore pass all data, and each recorder stores only the data that it
/// needs. The unit type `()` records nothing at no cost. A pair of recorders passes the data to both of them.
///
/// # For implementors
/// An episode must not depend on its recorder. Therefore the methods return nothing and cannot fail. A second value in
/// the same tick replaces the first one or is added to it, as documented by each method. Missing values are written as
/// NaN in tables.
///
/// ```
/// use farsa_body::ports::BodyId;
/// use farsa_body::{Pose, Recorder};
///
/// /// The greatest height that a body reached [m].
/// struct Highest(BodyId, f32);
///
/// impl Recorder for Highest {
///     fn pose(&mut self, body: BodyId, pose: Pose) {
///         if body == self.0 && pose.position[2] > self.1 {
///             self.1 = pose.position[2];
///         }
///     }
///     fn tick(&mut self, _time: f64) {}
/// }
/// ```
pub trait Recorder {
    /// Records the parameters of the controller. It is called once before the first tick.
    fn parameters(&mut self, parameters: &[f32]) {
        let _ = parameters;
    }
    /// Records the pose of a body.
    fn pose(&mut self, body: BodyId, pose: Pose) {
        let _ = (body, pose);
    }
    /// Records a pair of colliders that touch. It is called once per pair.
    fn contact(&mut self, pair: PairId, contact: &PairContact) {
        let _ = (pair, contact);
    }
    /// Records a ray of a sensor from its origin to its end (in meters). The argument `met` is true if it hit
    /// something. It is called once per ray.
    fn ray(&mut self, from: [f32; 3], to: [f32; 3], met: bool) {
        let _ = (from, to, met);
    }
    /// Records a point that is not a body (in meters), such as a point used by the fitness. Points are numbered from 0.
    fn point(&mut self, point: usize, position: [f32; 3]) {
        let _ = (point, position);
    }
    /// Records the color of a pixel in a camera's image, with red, green and blue in [0, 1]. It is called once per
    /// pixel, and pixel 0 is at the upper left.
    fn pixel(&mut self, image: usize, pixel: usize, color: [f32; 3]) {
        let _ = (image, pixel, color);
    }
    /// Records the values of the sensors.
    fn sensors(&mut self, x: &[f32]) {
        let _ = x;
    }
    /// Records the states of the neurons between the sensors and the motors.
    fn neurons(&mut self, states: &[f32]) {
        let _ = states;
    }
    /// Records the outputs of the controller.
    fn outputs(&mut self, y: &[f32]) {
        let _ = y;
    }
    /// Records all other values that have a name.
    fn scalars(&mut self, values: &[f64]) {
        let _ = values;
    }
    /// Ends the tick. The data since the previous tick describe the state at `time` (in seconds).
    fn tick(&mut self, time: f64);
}

/// Records the poses of the given bodies and all pairs that touch.
pub fn record_world<W, R>(world: &W, bodies: impl IntoIterator<Item = BodyId>, recorder: &mut R)
where
    W: Kinematics<Body = BodyId> + Contacts + ?Sized,
    R: Recorder + ?Sized,
{
    for body in bodies {
        recorder.pose(body, world.pose(body));
    }
    for pair in (0..world.pairs()).map(|pair| PairId(pair as u16)) {
        if world.touches(pair) {
            recorder.contact(pair, &world.pair_contact(pair));
        }
    }
}

/// Keeps nothing.
impl Recorder for () {
    fn tick(&mut self, _: f64) {}
}

macro_rules! forward {
    ($self:ident, $($to:expr),+) => {
        fn parameters(&mut $self, parameters: &[f32]) {
            $($to.parameters(parameters);)+
        }
        fn pose(&mut $self, body: BodyId, pose: Pose) {
            $($to.pose(body, pose);)+
        }
        fn contact(&mut $self, pair: PairId, contact: &PairContact) {
            $($to.contact(pair, contact);)+
        }
        fn ray(&mut $self, from: [f32; 3], to: [f32; 3], met: bool) {
            $($to.ray(from, to, met);)+
        }
        fn point(&mut $self, point: usize, position: [f32; 3]) {
            $($to.point(point, position);)+
        }
        fn pixel(&mut $self, image: usize, pixel: usize, color: [f32; 3]) {
            $($to.pixel(image, pixel, color);)+
        }
        fn sensors(&mut $self, x: &[f32]) {
            $($to.sensors(x);)+
        }
        fn neurons(&mut $self, states: &[f32]) {
            $($to.neurons(states);)+
        }
        fn outputs(&mut $self, y: &[f32]) {
            $($to.outputs(y);)+
        }
        fn scalars(&mut $self, values: &[f64]) {
            $($to.scalars(values);)+
        }
        fn tick(&mut $self, time: f64) {
            $($to.tick(time);)+
        }
    };
}

impl<R: Recorder + ?Sized> Recorder for &mut R {
    forward!(self, (**self));
}

/// Both keep all.
impl<A: Recorder, B: Recorder> Recorder for (A, B) {
    forward!(self, self.0, self.1);
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use alloc::{string::String, vec, vec::Vec};
    use core::fmt::Write as _;

    #[derive(Default)]
    struct Told(String);

    impl Recorder for Told {
        fn pose(&mut self, body: BodyId, pose: Pose) {
            let _ = write!(self.0, "p{}:{} ", body.0, pose.position[0]);
        }
        fn pixel(&mut self, image: usize, pixel: usize, color: [f32; 3]) {
            let _ = write!(self.0, "i{image}.{pixel}:{} ", color[1]);
        }
        fn sensors(&mut self, x: &[f32]) {
            let _ = write!(self.0, "s{x:?} ");
        }
        fn tick(&mut self, time: f64) {
            let _ = write!(self.0, "t{time};");
        }
    }

    fn tell(recorder: &mut dyn Recorder) {
        recorder.parameters(&[1.0]);
        recorder.pose(BodyId(2), Pose::at([3.0, 0.0, 0.0]));
        recorder.contact(PairId(1), &PairContact::default());
        recorder.ray([0.0; 3], [1.0; 3], true);
        recorder.point(0, [0.0; 3]);
        recorder.pixel(1, 7, [0.0, 0.25, 1.0]);
        recorder.sensors(&[0.5]);
        recorder.neurons(&[0.5]);
        recorder.outputs(&[0.5]);
        recorder.scalars(&[0.5]);
        recorder.tick(0.25);
    }

    #[test]
    fn both_of_a_pair_are_told_and_nobody_must_listen() {
        let (mut one, mut other) = (Told::default(), Told::default());
        tell(&mut (&mut one, (&mut other, ())));
        assert_eq!(one.0, "p2:3 i1.7:0.25 s[0.5] t0.25;");
        assert_eq!(one.0, other.0);
    }

    #[test]
    fn a_world_tells_its_bodies_and_what_touches() {
        use crate::Twist;
        use crate::ports::{ActuatorId, JointId};
        use crate::ports::{Contacts, Handles};

        struct Still;
        impl Handles for Still {
            type Body = BodyId;
            type Joint = JointId;
            type Actuator = ActuatorId;
        }
        impl Kinematics for Still {
            fn pose(&self, body: BodyId) -> Pose {
                Pose::at([f32::from(body.0), 0.0, 0.0])
            }
            fn velocity(&self, _: BodyId) -> Twist {
                Twist::default()
            }
        }
        impl Contacts for Still {
            fn pairs(&self) -> usize {
                3
            }
            fn pair_bodies(&self, _: PairId) -> [Option<BodyId>; 2] {
                [None; 2]
            }
            fn pair_contact(&self, pair: PairId) -> PairContact {
                PairContact { points: u32::from(pair.0 == 1), normal_force: 2.0, ..PairContact::default() }
            }
        }
        struct Seen(Vec<u16>, Vec<u16>);
        impl Recorder for Seen {
            fn pose(&mut self, body: BodyId, pose: Pose) {
                assert_eq!(pose.position[0], f32::from(body.0));
                self.0.push(body.0);
            }
            fn contact(&mut self, pair: PairId, contact: &PairContact) {
                assert_eq!(contact.normal_force, 2.0);
                self.1.push(pair.0);
            }
            fn tick(&mut self, _: f64) {}
        }
        let mut seen = Seen(vec![], vec![]);
        record_world(&Still, [4, 7].map(BodyId), &mut seen);
        assert_eq!((seen.0, seen.1), (vec![4, 7], vec![1]));
    }
}
