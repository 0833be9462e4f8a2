//! The capability ports: what a body may ask of a world, and the two sides that use them.

use crate::pose::{Pose, Twist};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub struct $name(pub u16);

        impl $name {
            /// The position in the robot's list.
            pub fn index(self) -> usize {
                usize::from(self.0)
            }
        }
    };
}

id! {
    /// A rigid body: the index of its segment in the robot's description.
    BodyId
}
id! {
    /// A joint: the index of the segment that it carries.
    JointId
}
id! {
    /// An actuator: its index in the robot's list of actuators.
    ActuatorId
}
id! {
    /// A pair of colliders that may touch: its index in the robot's list of pairs.
    PairId
}

/// The names by which a world knows its parts; all worlds of FARSA use [`BodyId`], [`JointId`] and [`ActuatorId`].
#[diagnostic::on_unimplemented(message = "`{Self}` is no world of FARSA: it names no bodies, joints or actuators")]
pub trait Handles {
    /// A rigid body.
    type Body: Copy;
    /// A joint with one degree of freedom.
    type Joint: Copy;
    /// Something that can be commanded.
    type Actuator: Copy;
}

/// A world that moves by itself.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be stepped",
    note = "a lane of a batch and a board have ports but no step"
)]
pub trait World: Handles {
    /// Lets one control step of [`World::time_step`] pass.
    fn step(&mut self);
    /// The control step [s].
    fn time_step(&self) -> f32;
}

/// Where bodies are and how they move.
#[diagnostic::on_unimplemented(message = "`{Self}` does not tell where its bodies are (port `Kinematics`)")]
pub trait Kinematics: Handles {
    /// The pose of a body's frame in the world.
    fn pose(&self, body: Self::Body) -> Pose;
    /// The velocity of a body's origin and its angular velocity, in the world's axes.
    fn velocity(&self, body: Self::Body) -> Twist;
    /// Where the origin of a body's frame is [m]: the same as the pose has, for less where a world turns rotations into quaternions.
    fn origin(&self, body: Self::Body) -> [f32; 3] {
        self.pose(body).position
    }
}

/// Joint angles and speeds.
#[diagnostic::on_unimplemented(message = "`{Self}` does not tell its joints' angles (port `Joints`)")]
pub trait Joints: Handles {
    /// The joint's angle [rad] or displacement [m].
    fn position(&self, joint: Self::Joint) -> f32;
    /// The joint's speed [rad/s or m/s].
    fn speed(&self, joint: Self::Joint) -> f32;
}

/// Actuators that take commands.
#[diagnostic::on_unimplemented(message = "`{Self}` has no actuators to command (port `Actuated`)")]
pub trait Actuated: Handles {
    /// Sets an actuator's command, which holds until the next one.
    ///
    /// A muscle pair takes [agonist, antagonist] activations [0..1]; a servo the desired position [rad or m], a
    /// torque motor its torque [N m or N] and a velocity motor its speed [rad/s or m/s] in the first place, and none of these
    /// reads the second. A wheel takes its speed [rad/s], an
    /// LED its brightness, a signal its value and an attachment device whether it holds (above 0.5) [0..1].
    fn command(&mut self, actuator: Self::Actuator, value: [f32; 2]);
}

/// Forces from outside, such as a hand that pushes.
#[diagnostic::on_unimplemented(
    message = "nothing can push the bodies of `{Self}` (port `ExternalForces`)",
    note = "kinematic worlds know no forces"
)]
pub trait ExternalForces: Handles {
    /// Lets a force [N] act on a body at a point [m], both in the world's axes, during the next control step alone.
    ///
    /// Force and moment about the centre of mass keep their direction in that step; all that is applied to a body before it adds up.
    /// Nothing happens to a body that does not move or exist. A snapshot does not hold what waits for the next step, and
    /// [`Arrange::clear`] and [`Snapshot::restore`] forget it.
    fn apply_force(&mut self, body: Self::Body, point: [f32; 3], force: [f32; 3]);
}

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hit<B> {
    /// Distance along the ray [m].
    pub distance: f32,
    /// Outward unit normal of the surface, in the world's axes.
    pub normal: [f32; 3],
    /// The body that was met; `None` for what does not move.
    pub body: Option<B>,
}

/// Ray casts.
#[diagnostic::on_unimplemented(message = "`{Self}` cannot cast rays (port `Rays`)")]
pub trait Rays: Handles {
    /// The first surface on a ray from `origin` [m] along the unit vector `direction` within `range` [m], in the world's axes.
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<Self::Body>>;
}

/// What a ray of an eye meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Seen<B> {
    /// Distance along the ray [m].
    pub distance: f32,
    /// The body that is met; `None` for what does not move.
    pub body: Option<B>,
    /// What colour it shows, red, green and blue [0..1]; `None` for a surface without a colour, which hides what is behind it.
    pub color: Option<[f32; 3]>,
}

/// What many rays from one place meet: the eyes of a camera with an image.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show itself to cameras (port `Vision`)")]
pub trait Vision: Handles {
    /// The first surface on each ray from `from` [m] along unit vectors within `range` [m], in the world's axes, other than those of
    /// `but`; `seen` [directions]. What `from` lies within is not seen, nor is anything beyond the shorter of the two slices.
    fn look(
        &self,
        from: [f32; 3],
        directions: &[[f32; 3]],
        range: f32,
        but: Option<Self::Body>,
        seen: &mut [Option<Seen<Self::Body>>],
    );
}

/// How a pair of colliders touched at the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PairContact {
    /// Number of points that carry a normal force > 0.
    pub points: u32,
    /// Force on the pair's first body, in the world's axes [N]; the second body gets the opposite.
    pub force: [f32; 3],
    /// Sum of the normal forces of the points [N].
    pub normal_force: f32,
    /// Mean of the touching points, weighted by normal force, in the world [m]; zero when none touches.
    pub point: [f32; 3],
    /// The largest penetration of the pair's points [m]; negative is the distance left, as far as the world knows it.
    pub depth: f32,
}

/// Contacts between the pairs of colliders that the robot lists.
#[diagnostic::on_unimplemented(message = "`{Self}` does not report its contacts (port `Contacts`)")]
pub trait Contacts: Handles {
    /// Number of pairs; they are numbered from 0 in the order of the robot's list.
    fn pairs(&self) -> usize;
    /// The two bodies of a pair; `None` for what does not move.
    fn pair_bodies(&self, pair: PairId) -> [Option<Self::Body>; 2];
    /// How a pair touched at the end of the last step; all zero for a pair that does not exist.
    fn pair_contact(&self, pair: PairId) -> PairContact;
    /// Whether a point of the pair carries a normal force > 0; a world may know this faster than all of
    /// [`pair_contact`](Self::pair_contact).
    fn touches(&self, pair: PairId) -> bool {
        self.pair_contact(pair).points > 0
    }
}

/// A surface near a place of a planar world, and its point that is nearest to there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NearbySurface<B> {
    /// The body whose surface it is; `None` for a wall.
    pub body: Option<B>,
    /// The nearest point [m].
    pub point: [f32; 2],
    /// Distance to that point [m]; negative within a round body, 0 within another one.
    pub distance: f32,
    /// Radius of a round body [m]; 0 for a wall and for a body of another form.
    pub radius: f32,
    /// What colour it shows, red, green and blue [0..1]; of a robot that of its LEDs.
    pub color: [f32; 3],
    /// What a robot signals [0..1]; `None` for what is no robot.
    pub signal: Option<f32>,
}

/// What is seen along a line in a planar world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlanarHit<B> {
    /// Distance along the line [m].
    pub distance: f32,
    /// The body that is seen; `None` for a wall.
    pub body: Option<B>,
    /// What colour it shows, red, green and blue [0..1].
    pub color: [f32; 3],
}

/// A lamp of a planar world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lamp<B> {
    /// The body that shines.
    pub body: B,
    /// Its centre [m].
    pub position: [f32; 2],
    /// How strong it is, in a unit of the caller's choice.
    pub intensity: f32,
}

/// What is to be seen in a plane: that of a planar world, or of the eyes in another one.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show its surfaces and their colours (port `Sight`)")]
pub trait Sight: Handles {
    /// Reports every surface that has a point within `range` [m] of `from` [m], in the order of walls and bodies.
    ///
    /// The robot that asks is reported, too.
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<Self::Body>));
    /// The first surface along the unit vector `direction` from `from` [m] within `range` [m], other than that of `but`;
    /// what `from` lies within is not seen.
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<Self::Body>,
    ) -> Option<PlanarHit<Self::Body>>;
}

/// What there is to see and to stand on in a world of the plane, for sensors of mobile robots.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show its ground and lamps (port `Planar`)")]
pub trait Planar: Sight {
    /// The colour of the ground at a place [m]: red, green and blue [0..1].
    fn ground(&self, at: [f32; 2]) -> [f32; 3];
    /// Reports every lamp.
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<Self::Body>));
    /// What a robot's attachment device holds.
    fn attached(&self, robot: Self::Body) -> Option<Self::Body> {
        let _ = robot;
        None
    }
}

/// Everything a world remembers, as numbers.
#[diagnostic::on_unimplemented(message = "`{Self}` cannot be saved and restored (port `Snapshot`)")]
pub trait Snapshot {
    /// Length of a snapshot.
    fn snapshot_len(&self) -> usize;
    /// Writes every word that a step or a port reads and a step or a command wrote; `out` [`snapshot_len`].
    fn save(&self, out: &mut [f32]);
    /// Brings back what [`Snapshot::save`] wrote: what follows has the same bits; `from` [`snapshot_len`].
    fn restore(&mut self, from: &[f32]);
}

/// Setting a world up for a new episode.
#[diagnostic::on_unimplemented(
    message = "the bodies of `{Self}` cannot be put somewhere (port `Arrange`)",
    note = "a board has ports, but no call can move its robot"
)]
pub trait Arrange: Handles {
    /// Back to the description's own start: every joint at 0 or the nearest limit, everything at rest, commands and
    /// contacts forgotten.
    fn clear(&mut self);
    /// Puts a joint at a position [rad or m] with a speed [rad/s or m/s].
    fn place_joint(&mut self, joint: Self::Joint, position: f32, speed: f32);
    /// Puts a floating body somewhere with a velocity; ignored for a body that hangs on a joint.
    fn place_body(&mut self, body: Self::Body, pose: Pose, twist: Twist);
    /// Ends the placement: what the other ports report is true again.
    fn finish_placement(&mut self);
}

/// Something with a fixed number of channels: every sensor and every motor.
pub trait Channels {
    /// Number of values read or driven.
    fn channels(&self) -> usize;
    /// Forgets what was remembered of an earlier episode (noise streams, delays); called at the start of each.
    fn reset(&mut self) {}
}

/// Something that reads a world.
///
/// A sensor of one's own names the ports it needs and works in every world that has them:
///
/// ```
/// use farsa_body::ports::{Channels, Kinematics, Sensor};
///
/// /// How upright a body is: 1 upright, -1 upside down.
/// struct Upright<B>(B);
///
/// impl<B> Channels for Upright<B> {
///     fn channels(&self) -> usize {
///         1
///     }
/// }
/// impl<B: Copy, W: Kinematics<Body = B> + ?Sized> Sensor<W> for Upright<B> {
///     fn read(&mut self, world: &W, out: &mut [f32]) {
///         out.iter_mut().zip([world.pose(self.0).rotate([0.0, 0.0, 1.0])[2]]).for_each(|(o, x)| *o = x);
///     }
/// }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot sense a world of type `{W}`",
    note = "the world may lack a port that the sensor needs"
)]
pub trait Sensor<W: ?Sized>: Channels {
    /// Writes one value per channel; `out` [channels]. A shorter slice gets the first channels.
    fn read(&mut self, world: &W, out: &mut [f32]);
}

/// Something that commands a world.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot drive a world of type `{W}`",
    note = "the world may lack a port that the motor needs"
)]
pub trait Motor<W: ?Sized>: Channels {
    /// Turns one value per channel into commands; `y` [channels]. Of a shorter slice the first channels are driven.
    fn drive(&mut self, y: &[f32], world: &mut W);
}
