//! A reflex that turns a head towards a thing.

use farsa_num::atan2;

use crate::channel::{ChannelError, finite_range, positive};
use crate::motors::joints::ServoRange;
use crate::ports::{Actuated, ActuatorId, BodyId, Kinematics};
use crate::pose::Pose;

/// Keeps a point of a body in the middle of an eye's image by two servos.
///
/// At each step the desired position of each servo changes by a share of the angle between the camera's axis and the
/// target. One servo turns to the left, the other upwards, each by a limited amount. Both servos stay while the target
/// is not in front of the camera.
///
/// The rule is our own. It is no [`Motor`](crate::ports::Motor): it takes no values of a controller, and moves the servos by itself.
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
    /// A reflex of an eye, the body that it is on and its pose there with x forward, y to the left and z up.
    ///
    /// The target is a point [m] of a body. The first servo turns to the left, with its rightmost and leftmost
    /// position. The second turns upwards, with its lowest and highest position. They start at positions `start` [rad].
    /// At each step they correct the share `gain` of the angles, by at most `most` [rad].
    ///
    /// # Errors
    /// [`ChannelError::Range`] for a range of a servo that is empty or not finite. [`ChannelError::Value`] for a start
    /// out of it, a `gain` that is not within 0 and 1, or a `most` that is not a finite number > 0.
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

    /// The desired positions of the two servos [rad].
    pub fn desired(&self) -> [f32; 2] {
        self.desired
    }

    /// Goes back to the start.
    pub fn reset(&mut self) {
        self.desired = self.start;
    }

    /// Looks, and commands both servos. Once before each step of the world.
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

    /// Returns the angles from the camera's axis to the target, to the left and upwards [rad], or `None` for a target
    /// that is not in front.
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
