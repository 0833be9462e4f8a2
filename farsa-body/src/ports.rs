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

/// The handles of a world's parts. All worlds of FARSA use [`BodyId`], [`JointId`] and [`ActuatorId`].
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
    /// A muscle pair takes [agonist, antagonist] activations [0..1]. The others read the first value only: a servo its
    /// desired position [rad or m], a torque motor its torque [N m or N], a velocity motor its speed [rad/s or m/s].
    ///
    /// A wheel takes its speed [rad/s], an LED its brightness and a signal its value [0..1]. An attachment device holds
    /// above 0.5.
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
    /// Force and moment about the center of mass keep their direction in that step. Several forces on a body add up. A
    /// body that does not move or does not exist is unaffected. A snapshot does not hold pending forces, and
    /// [`Arrange::clear`] and [`Snapshot::restore`] discard them.
    fn apply_force(&mut self, body: Self::Body, point: [f32; 3], force: [f32; 3]);
}

/// The first surface on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hit<B> {
    /// Distance along the ray [m].
    pub distance: f32,
    /// Outward unit normal of the surface, in the world's axes.
    pub normal: [f32; 3],
    /// The body that was met, or `None` for what does not move.
    pub body: Option<B>,
}

/// Ray casts.
#[diagnostic::on_unimplemented(message = "`{Self}` cannot cast rays (port `Rays`)")]
pub trait Rays: Handles {
    /// The first surface on a ray from `origin` [m] along the unit vector `direction` within `range` [m], in the world's axes.
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<Self::Body>>;
}

/// The first surface on a camera's ray.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Seen<B> {
    /// Distance along the ray [m].
    pub distance: f32,
    /// The body that is met, or `None` for what does not move.
    pub body: Option<B>,
    /// The color it shows, red, green and blue [0..1], or `None` for a surface without a color, which hides what is
    /// behind it.
    pub color: Option<[f32; 3]>,
}

/// Many rays from one place, for cameras with an image.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show itself to cameras (port `Vision`)")]
pub trait Vision: Handles {
    /// The first surface on each ray from `from` [m] along unit vectors within `range` [m], in the world's axes, except
    /// those of `but`. `seen` [directions]. Bodies around `from` are invisible, and the longer slice is used only in
    /// part.
    fn look(
        &self,
        from: [f32; 3],
        directions: &[[f32; 3]],
        range: f32,
        but: Option<Self::Body>,
        seen: &mut [Option<Seen<Self::Body>>],
    );
}

/// The contact of a pair of colliders at the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PairContact {
    /// Number of points that carry a normal force > 0.
    pub points: u32,
    /// Force on the pair's first body, in the world's axes [N]. The second body gets the opposite.
    pub force: [f32; 3],
    /// Sum of the normal forces of the points [N].
    pub normal_force: f32,
    /// Mean of the touching points, weighted by normal force, in the world [m], or zero when none touches.
    pub point: [f32; 3],
    /// The largest penetration of the pair's points [m]. A negative value is the remaining distance, if the world
    /// computes it.
    pub depth: f32,
}

/// Contacts between the pairs of colliders that the robot lists.
#[diagnostic::on_unimplemented(message = "`{Self}` does not report its contacts (port `Contacts`)")]
pub trait Contacts: Handles {
    /// Number of pairs. They are numbered from 0 in the order of the robot's list.
    fn pairs(&self) -> usize;
    /// The two bodies of a pair, or `None` for what does not move.
    fn pair_bodies(&self, pair: PairId) -> [Option<Self::Body>; 2];
    /// Returns the contact of a pair at the end of the last step, all zero for a pair that does not exist.
    fn pair_contact(&self, pair: PairId) -> PairContact;
    /// Returns whether a point of the pair carries a normal force > 0. A world may compute this faster than all of
    /// [`pair_contact`](Self::pair_contact).
    fn touches(&self, pair: PairId) -> bool {
        self.pair_contact(pair).points > 0
    }
}

/// A surface near a place of a planar world, and its point that is nearest to there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NearbySurface<B> {
    /// The body whose surface it is, or `None` for a wall.
    pub body: Option<B>,
    /// The nearest point [m].
    pub point: [f32; 2],
    /// Distance to that point [m]. Negative within a round body, 0 within another one.
    pub distance: f32,
    /// Radius of a round body [m], or 0 for a wall and for a body of another form.
    pub radius: f32,
    /// The color it shows, red, green and blue [0..1]. A robot shows the color of its LEDs.
    pub color: [f32; 3],
    /// The signal of a robot [0..1], or `None` for everything else.
    pub signal: Option<f32>,
}

/// The first surface along a line in a planar world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlanarHit<B> {
    /// Distance along the line [m].
    pub distance: f32,
    /// The body that is seen, or `None` for a wall.
    pub body: Option<B>,
    /// The color it shows, red, green and blue [0..1].
    pub color: [f32; 3],
}

/// A lamp of a planar world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lamp<B> {
    /// The body that shines.
    pub body: B,
    /// Its center [m].
    pub position: [f32; 2],
    /// The intensity, in a unit of the caller's choice.
    pub intensity: f32,
}

/// Surfaces and lines of sight in a plane, of a planar world or at the height of a camera.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show its surfaces and their colours (port `Sight`)")]
pub trait Sight: Handles {
    /// Reports every surface that has a point within `range` [m] of `from` [m], in the order of walls and bodies.
    ///
    /// The robot that asks is reported, too.
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<Self::Body>));
    /// The first surface along the unit vector `direction` from `from` [m] within `range` [m], except that of `but`.
    /// Bodies around `from` are invisible.
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<Self::Body>,
    ) -> Option<PlanarHit<Self::Body>>;
}

/// The ground, lamps and attachments of a planar world, for sensors of mobile robots.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show its ground and lamps (port `Planar`)")]
pub trait Planar: Sight {
    /// The color of the ground at a place [m]: red, green and blue [0..1].
    fn ground(&self, at: [f32; 2]) -> [f32; 3];
    /// Reports every lamp.
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<Self::Body>));
    /// Returns the body that a robot's attachment device holds.
    fn attached(&self, robot: Self::Body) -> Option<Self::Body> {
        let _ = robot;
        None
    }
}

/// The state of a world as numbers.
#[diagnostic::on_unimplemented(message = "`{Self}` cannot be saved and restored (port `Snapshot`)")]
pub trait Snapshot {
    /// Length of a snapshot.
    fn snapshot_len(&self) -> usize;
    /// Writes every word that a step or a port reads and a step or a command wrote. `out` [`snapshot_len`].
    fn save(&self, out: &mut [f32]);
    /// Brings back what [`Snapshot::save`] wrote: what follows has the same bits. `from` [`snapshot_len`].
    fn restore(&mut self, from: &[f32]);
}

/// Setting a world up for a new episode.
#[diagnostic::on_unimplemented(
    message = "the bodies of `{Self}` cannot be put somewhere (port `Arrange`)",
    note = "a board has ports, but no call can move its robot"
)]
pub trait Arrange: Handles {
    /// Restores the description's start: every joint at 0 or the nearest limit, everything at rest, no commands or
    /// contacts.
    fn clear(&mut self);
    /// Puts a joint at a position [rad or m] with a speed [rad/s or m/s].
    fn place_joint(&mut self, joint: Self::Joint, position: f32, speed: f32);
    /// Puts a floating body somewhere with a velocity. Ignored for a body that hangs on a joint.
    fn place_body(&mut self, body: Self::Body, pose: Pose, twist: Twist);
    /// Ends the placement: what the other ports report is true again.
    fn finish_placement(&mut self);
}

/// Something with a fixed number of channels: every sensor and every motor.
pub trait Channels {
    /// Number of values read or driven.
    fn channels(&self) -> usize;
    /// Discards the memory of an earlier episode (noise streams, delays). Called at the start of each.
    fn reset(&mut self) {}
}

/// Something that reads a world.
///
/// A custom sensor names the ports that it needs and works in every world that has them:
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
    /// Writes one value per channel. `out` [channels]. A shorter slice gets the first channels.
    fn read(&mut self, world: &W, out: &mut [f32]);
}

/// Something that commands a world.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot drive a world of type `{W}`",
    note = "the world may lack a port that the motor needs"
)]
pub trait Motor<W: ?Sized>: Channels {
    /// Turns one value per channel into commands. `y` [channels]. A shorter slice drives the first channels.
    fn drive(&mut self, y: &[f32], world: &mut W);
}
