//! A reflex that turns a head towards a target.

use farsa_num::atan2;

use crate::channel::{ChannelError, finite_range, positive};
use crate::motors::joints::ServoRange;
use crate::ports::{Actuated, ActuatorId, BodyId, Kinematics};
use crate::pose::Pose;

/// Keeps a point of a body in the center of an eye's image by means of two servos.
///
/// In each step, the desired position of each servo is changed by a fraction of the angle between the axis of the
/// camera and the target. The change is limited. One servo turns to the left and the other one upwards. They do not
/// move while the target is behind the camera.
///
/// Note that this type is not a [`Motor`](crate::ports::Motor), because it does not use the values of a controller.
/// Source: the rule was designed for this crate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadTracking<B = BodyId, A = ActuatorId> {
    eye: (B, Pose),
    target: (B, [f32; 3]),
    servos: [ServoRange<A>; 2],
    start: [f32; 2],
    gain: f32,
    most: f32,
    desired: [f32; 2],
}

impl<B, A: Copy> HeadTracking<B, A> {
    /// Creates a reflex for an eye at the given pose on a body. In the frame of the eye, x points forward, y to the
    /// left and z up.
    ///
    /// The target is a point of a body in meters. The first servo turns to the left. Its range contains the rightmost
    /// and the leftmost position. The second servo turns upwards, and its range contains the lowest and the highest
    /// position. The servos start at `start` (in radians). In each step they correct the fraction `gain` of the angles,
    /// but not more than `most` (in radians).
    ///
    /// # Errors
    /// Returns [`ChannelError::Range`] if the range of a servo is empty or not finite. Returns [`ChannelError::Value`]
    /// if a start is out of range, if `gain` is not between 0 and 1, or if `most` is not a finite number > 0.
    pub fn new(
        eye: (B, Pose),
        target: (B, [f32; 3]),
        servos: [ServoRange<A>; 2],
        start: [f32; 2],
        gain: f32,
        most: f32,
    ) -> Result<Self, ChannelError> {
        for (servo, start) in servos.iter().zip(start) {
            finite_range(servo.from, servo.to)?;
            let [low, high] = ends(servo);
            if low == high {
                return Err(ChannelError::Range { from: low, to: high });
            }
            if !(low..=high).contains(&start) {
                return Err(ChannelError::Value { field: "start", value: start });
            }
        }
        if positive("gain", gain)? > 1.0 {
            return Err(ChannelError::Value { field: "gain", value: gain });
        }
        Ok(Self { eye, target, servos, start, gain, most: positive("most", most)?, desired: start })
    }

    /// Gets the desired positions of the two servos in radians.
    pub fn desired(&self) -> [f32; 2] {
        self.desired
    }

    /// Moves the desired positions back to the start.
    pub fn reset(&mut self) {
        self.desired = self.start;
    }

    /// Measures the direction of the target and commands both servos. Call this function once before each step of the
    /// world.
    pub fn step<W>(&mut self, world: &mut W)
    where
        B: Copy,
        W: Kinematics<Body = B> + Actuated<Actuator = A> + ?Sized,
    {
        let angles = self.angles(world).unwrap_or_default();
        for ((servo, desired), angle) in self.servos.iter().zip(&mut self.desired).zip(angles) {
            let turn = (self.gain * angle).clamp(-self.most, self.most);
            let [low, high] = ends(servo);
            let turn = if servo.from < servo.to { turn } else { -turn };
            *desired = (*desired + turn).clamp(low, high);
            world.command(servo.servo, [*desired, 0.0]);
        }
    }

    /// Returns the angles from the axis of the camera to the target, to the left and upwards (in radians). Returns
    /// `None` if the target is not in front of the camera.
    pub fn angles<W>(&self, world: &W) -> Option<[f32; 2]>
    where
        B: Copy,
        W: Kinematics<Body = B> + ?Sized,
    {
        let (body, placement) = &self.eye;
        let place = world.pose(self.target.0).transform(self.target.1);
        let [ahead, left, up] = world.pose(*body).compose(placement).transform_back(place);
        (ahead > 0.0).then(|| [atan2(left, ahead), atan2(up, ahead)])
    }
}

/// The lower and the upper end of a range that may run either way.
fn ends<A>(servo: &ServoRange<A>) -> [f32; 2] {
    if servo.from < servo.to { [servo.from, servo.to] } else { [servo.to, servo.from] }
}
