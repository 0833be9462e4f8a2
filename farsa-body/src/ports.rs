//! The ports of a world. Each trait describes one capability that sensors and motors can require.

use crate::pose::{Pose, Twist};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        pub struct $name(pub u16);

        impl $name {
            /// Returns the index in the corresponding list of the robot.
            pub fn index(self) -> usize {
                usize::from(self.0)
            }
        }
    };
}

id! {
    /// Identifies a rigid body by the index of its segment in the description of the robot.
    BodyId
}
id! {
    /// Identifies a joint by the index of the segment that it carries.
    JointId
}
id! {
    /// Identifies an actuator by its index in the robot's list of actuators.
    ActuatorId
}
id! {
    /// Identifies a pair of colliders that may touch by its index in the robot's list of pairs.
    PairId
}

/// The types that identify the parts of a world. All worlds of FARSA use [`BodyId`], [`JointId`] and [`ActuatorId`].
#[diagnostic::on_unimplemented(message = "`{Self}` is no world of FARSA: it names no bodies, joints or actuators")]
pub trait Handles {
    /// The type that identifies a rigid body.
    type Body: Copy;
    /// The type that identifies a joint with one degree of freedom.
    type Joint: Copy;
    /// The type that identifies an actuator.
    type Actuator: Copy;
}

/// A world that can be simulated step by step.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be stepped",
    note = "a lane of a batch and a board have ports but no step"
)]
pub trait World: Handles {
    /// Advances the world by one control step. Its duration is [`World::time_step`].
    fn step(&mut self);
    /// Returns the duration of a control step (in seconds).
    fn time_step(&self) -> f32;
}

/// Access to the poses and velocities of bodies.
#[diagnostic::on_unimplemented(message = "`{Self}` does not tell where its bodies are (port `Kinematics`)")]
pub trait Kinematics: Handles {
    /// Returns the pose of a body's frame in the world.
    fn pose(&self, body: Self::Body) -> Pose;
    /// Returns the velocity of a body's origin and its angular velocity. Both are given in the axes of the world.
    fn velocity(&self, body: Self::Body) -> Twist;
    /// Returns the origin of a body's frame in meters. This can be faster than [`pose`](Self::pose), because no
    /// quaternion is needed.
    fn origin(&self, body: Self::Body) -> [f32; 3] {
        self.pose(body).position
    }
}

/// Access to the positions and speeds of joints.
#[diagnostic::on_unimplemented(message = "`{Self}` does not tell its joints' angles (port `Joints`)")]
pub trait Joints: Handles {
    /// Returns the angle (in radians) or the displacement (in meters) of a joint.
    fn position(&self, joint: Self::Joint) -> f32;
    /// Returns the speed of a joint (in radians or meters per second).
    fn speed(&self, joint: Self::Joint) -> f32;
}

/// Access to actuators that accept commands.
#[diagnostic::on_unimplemented(message = "`{Self}` has no actuators to command (port `Actuated`)")]
pub trait Actuated: Handles {
    /// Sets the command of an actuator. It remains active until the next command. An actuator with a
    /// [`command_range`](crate::robot::Actuator::command_range) clamps the first value.
    ///
    /// A muscle pair uses both values as the activations of agonist and antagonist in [0..1]. Most other actuators
    /// ignore the second value. For a servo, the first value is the desired position (in radians or meters). For a
    /// torque motor it is the torque (in N m or N), and for a velocity motor the speed (in rad/s or m/s). A custom law
    /// ([`Held`](crate::actuators::Held)) uses both.
    ///
    /// For mobile robots, the first value is the speed of a wheel (in rad/s), the brightness of an LED or the value of
    /// a signal (between 0 and 1). An attachment device holds if the value is above 0.5.
    fn command(&mut self, actuator: Self::Actuator, value: [f32; 2]);
}

/// Support for external forces, for example to push a robot by hand.
#[diagnostic::on_unimplemented(
    message = "nothing can push the bodies of `{Self}` (port `ExternalForces`)",
    note = "kinematic worlds know no forces"
)]
pub trait ExternalForces: Handles {
    /// Applies a force (in newtons) to a body at a point (in meters) during the next control step. Both vectors are
    /// given in the axes of the world.
    ///
    /// The force and its moment about the center of mass keep their direction during the step. Several forces on the
    /// same body are added. Forces on bodies that do not move or do not exist have no effect. Snapshots do not contain
    /// pending forces, and [`Arrange::clear`] and [`Snapshot::restore`] discard them.
    fn apply_force(&mut self, body: Self::Body, point: [f32; 3], force: [f32; 3]);
}

/// The first surface hit by a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hit<B> {
    /// Distance along the ray in meters.
    pub distance: f32,
    /// Outward unit normal of the surface, in the axes of the world.
    pub normal: [f32; 3],
    /// Body that was hit, or `None` if the surface belongs to the static environment.
    pub body: Option<B>,
}

/// Support for ray casts.
#[diagnostic::on_unimplemented(message = "`{Self}` cannot cast rays (port `Rays`)")]
pub trait Rays: Handles {
    /// Returns the first surface on a ray from `origin` (in meters) in the direction of the unit vector `direction`.
    /// The ray ends after `range` in meters. All vectors are given in the axes of the world.
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<Self::Body>>;
}

/// The first surface that is visible along a ray of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Seen<B> {
    /// Distance along the ray in meters.
    pub distance: f32,
    /// Body that is visible, or `None` if the surface belongs to the static environment.
    pub body: Option<B>,
    /// Red, green and blue components of its color (between 0 and 1). A surface without a color (`None`) still
    /// hides everything behind it.
    pub color: Option<[f32; 3]>,
}

/// Support for cameras that cast many rays from one point.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show itself to cameras (port `Vision`)")]
pub trait Vision: Handles {
    /// Finds the first surface on each ray that starts at `from` (in meters) in the given directions. The directions
    /// are unit vectors in the axes of the world, and rays end after `range` (in meters). The body `but` is ignored,
    /// and bodies that contain `from` are invisible. The results are written to `seen`. If the slices have different
    /// lengths, only the common part is used.
    fn look(
        &self,
        from: [f32; 3],
        directions: &[[f32; 3]],
        range: f32,
        but: Option<Self::Body>,
        seen: &mut [Option<Seen<Self::Body>>],
    );
}

/// The contact between a pair of colliders at the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PairContact {
    /// Number of contact points with a normal force > 0.
    pub points: u32,
    /// Force on the first body of the pair, in the axes of the world (in newtons). The opposite force acts on the
    /// second body.
    pub force: [f32; 3],
    /// Sum of the normal forces at all points (in newtons).
    pub normal_force: f32,
    /// Mean position of the contact points in the world, weighted by normal force (in meters). It is zero if there
    /// is no contact.
    pub point: [f32; 3],
    /// Largest penetration depth (in meters). A negative value is the remaining distance. Only some worlds
    /// compute it.
    pub depth: f32,
}

/// Access to the contacts between the pairs of colliders in the description of the robot.
#[diagnostic::on_unimplemented(message = "`{Self}` does not report its contacts (port `Contacts`)")]
pub trait Contacts: Handles {
    /// Returns the number of pairs. They are numbered in the order of the robot's list, starting at 0.
    fn pairs(&self) -> usize;
    /// Returns the two bodies of a pair. `None` represents the static environment.
    fn pair_bodies(&self, pair: PairId) -> [Option<Self::Body>; 2];
    /// Returns the contact of a pair at the end of the last step. If the pair does not exist, all values are zero.
    fn pair_contact(&self, pair: PairId) -> PairContact;
    /// Returns true if there is a contact point with a normal force > 0. This can be faster than
    /// [`pair_contact`](Self::pair_contact).
    fn touches(&self, pair: PairId) -> bool {
        self.pair_contact(pair).points > 0
    }
}

/// A surface that is close to a given position in a planar world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NearbySurface<B> {
    /// Body to which the surface belongs, or `None` for a wall.
    pub body: Option<B>,
    /// Nearest point of the surface (in meters).
    pub point: [f32; 2],
    /// Distance to this point in meters. Inside a round body it is negative, and inside any other body it is 0.
    pub distance: f32,
    /// Radius of a round body in meters. It is 0 for walls and for other shapes.
    pub radius: f32,
    /// Red, green and blue components of its color (between 0 and 1). For a robot with LEDs this is the color of
    /// the LEDs.
    pub color: [f32; 3],
    /// Signal of a robot (between 0 and 1), or `None` for everything else.
    pub signal: Option<f32>,
}

/// The first surface along a line in a planar world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlanarHit<B> {
    /// Distance along the line in meters.
    pub distance: f32,
    /// Body that is visible, or `None` for a wall.
    pub body: Option<B>,
    /// Red, green and blue components of its color (between 0 and 1).
    pub color: [f32; 3],
}

/// A lamp in a planar world.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lamp<B> {
    /// Body that emits the light.
    pub body: B,
    /// Center of the lamp in meters.
    pub position: [f32; 2],
    /// Intensity of the lamp. You can choose any unit.
    pub intensity: f32,
}

/// Access to surfaces and lines of sight in a plane. It can be a planar world or the plane of a camera.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show its surfaces and their colours (port `Sight`)")]
pub trait Sight: Handles {
    /// Calls `tell` for every surface that has a point within `range` (in meters) of `from` (in meters). Walls are
    /// reported first, followed by bodies.
    ///
    /// Note that the robot at `from` is reported as well.
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<Self::Body>));
    /// Returns the first surface on a line that starts at `from` (in meters) in the direction of the unit vector
    /// `direction`. The line ends after `range` (in meters). The body `but` is ignored, and bodies that contain `from`
    /// are invisible.
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<Self::Body>,
    ) -> Option<PlanarHit<Self::Body>>;
}

/// Access to the ground, the lamps and the attachments of a planar world. It is used by the sensors of mobile robots.
#[diagnostic::on_unimplemented(message = "`{Self}` does not show its ground and lamps (port `Planar`)")]
pub trait Planar: Sight {
    /// Returns the red, green and blue components of the color of the ground at a position (in meters), each in [0..1].
    fn ground(&self, at: [f32; 2]) -> [f32; 3];
    /// Calls `tell` for every lamp.
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<Self::Body>));
    /// Returns the body held by the attachment device of a robot, if any.
    fn attached(&self, robot: Self::Body) -> Option<Self::Body> {
        let _ = robot;
        None
    }
}

/// Support for saving and restoring the state of a world.
#[diagnostic::on_unimplemented(message = "`{Self}` cannot be saved and restored (port `Snapshot`)")]
pub trait Snapshot {
    /// Returns the length of a snapshot.
    fn snapshot_len(&self) -> usize;
    /// Writes a snapshot to `out`. This slice must have [`snapshot_len`](Self::snapshot_len) elements. It then contains
    /// everything that influences later steps or is reported by a port.
    fn save(&self, out: &mut [f32]);
    /// Restores a snapshot that was written by [`Snapshot::save`]. The simulation then continues with identical bits.
    fn restore(&mut self, from: &[f32]);
}

/// Support for preparing a world for a new episode.
#[diagnostic::on_unimplemented(
    message = "the bodies of `{Self}` cannot be put somewhere (port `Arrange`)",
    note = "a board has ports, but no call can move its robot"
)]
pub trait Arrange: Handles {
    /// Restores the initial state of the description. All joints are at 0 or the nearest limit, everything is at rest,
    /// and there are no commands or contacts.
    fn clear(&mut self);
    /// Sets the position (in radians or meters) and the speed (in rad/s or m/s) of a joint.
    fn place_joint(&mut self, joint: Self::Joint, position: f32, speed: f32);
    /// Sets the pose and the velocity of a floating body. Calls for bodies attached to a joint are ignored.
    fn place_body(&mut self, body: Self::Body, pose: Pose, twist: Twist);
    /// Completes the placement. Afterwards all other ports report the new state.
    fn finish_placement(&mut self);
}

/// A component with a fixed number of channels. It is implemented by all sensors and motors.
pub trait Channels {
    /// Returns the number of values read or driven.
    fn channels(&self) -> usize;
    /// Resets the internal state, such as noise streams and delays. It is called at the start of each episode.
    fn reset(&mut self) {}
}

/// A sensor that reads values from a world.
///
/// A custom sensor requires only the ports that it uses. It then works in every world that supports them:
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
    /// Writes one value per channel to `out`. If the slice is too short, it receives only the first channels.
    fn read(&mut self, world: &W, out: &mut [f32]);
}

/// A motor that sends commands to a world.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot drive a world of type `{W}`",
    note = "the world may lack a port that the motor needs"
)]
pub trait Motor<W: ?Sized>: Channels {
    /// Converts one value per channel into commands. If the slice is too short, only the first channels are driven.
    fn drive(&mut self, y: &[f32], world: &mut W);
}
