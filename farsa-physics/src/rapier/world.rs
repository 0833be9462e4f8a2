//! One world of rapier behind the ports.

use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use farsa_body::actuators::clamp_command;
use farsa_body::ports::{BodyId, JointId};
use farsa_body::robot::{JointKind, Robot};
use farsa_body::{Pose, Twist};
use rapier3d::dynamics::{Multibody, MultibodyJoint, RigidBody, RigidBodyHandle};
use rapier3d::math::{Rotation, Vector};
use rapier3d::pipeline::PhysicsWorld;

use crate::rapier::contact::roll;
use crate::rapier::error::RapierError;
use crate::rapier::model::{Carrier, Motor, RobotPlan, build};
use crate::rapier::options::Options;
use crate::rapier::pushes::Pushes;
use crate::rapier::scene::Scene;
use crate::rapier::snapshot::copy;

/// Stiffness of a joint's spring that only brings a torque in, next to nothing for any joint [N m/rad or N/m].
pub(crate) const LEAST_STIFFNESS: f32 = 1e-6;

/// One world of rapier, from the same description as [`crate::articulated::World`] and with the same ports.
///
/// A world fails if rapier removes a body because of non-finite values, or if an actuator's law returns one. After a
/// failure it does not step, and every port returns NaN, until it is cleared or restored.
pub struct World {
    pub(crate) plan: RobotPlan,
    pub(crate) physics: PhysicsWorld,
    initial: PhysicsWorld,
    pub(crate) commands: Vec<[f32; 2]>,
    pub(crate) lost: bool,
    /// True if something was placed since links, colliders and neighbors were brought up to date.
    pub(crate) moved: bool,
    /// Forces from outside that act in the next control step.
    pub(crate) pushes: Pushes,
}

impl World {
    /// A world at its description's start.
    ///
    /// # Errors
    /// A description that is not valid, an option out of range, a joint without inertia, a plane on a moving body, more
    /// parts than 16 bits can number.
    pub fn new(robot: &Robot, options: &Options) -> Result<Self, RapierError> {
        Self::from_scene(&Scene::new(robot.clone()), options)
    }

    /// A world of a robot and the objects around it, at their start.
    ///
    /// # Errors
    /// As [`World::new`], and objects that cannot be built.
    pub fn from_scene(scene: &Scene, options: &Options) -> Result<Self, RapierError> {
        let (plan, physics) = build(scene, options)?;
        let commands = vec![[0.0; 2]; plan.actuators];
        let mut world = Self {
            plan,
            initial: copy(&physics),
            physics,
            commands,
            lost: false,
            moved: true,
            pushes: Pushes::default(),
        };
        world.settle();
        world.initial = copy(&world.physics);
        Ok(world)
    }

    /// rapier's own state, for what the ports do not report.
    pub fn physics(&self) -> &PhysicsWorld {
        &self.physics
    }

    /// Returns rapier's state for changes. They void all promises of this crate, and rapier's interface is not stable.
    pub fn physics_mut(&mut self) -> &mut PhysicsWorld {
        self.moved = true;
        &mut self.physics
    }

    /// rapier's name of what a body rides on, or `None` for what does not move or exist.
    pub fn body_handle(&self, body: BodyId) -> Option<RigidBodyHandle> {
        self.carrier(body).map(|carrier| carrier.body)
    }

    /// Checks that the world has not broken down.
    pub fn is_finite(&self) -> bool {
        !self.lost
    }

    fn carrier(&self, body: BodyId) -> Option<&Carrier> {
        let frame = self.plan.frames.get(body.index())?;
        frame.carrier.map(|carrier| &self.plan.carriers[carrier])
    }

    /// The carrier of a joint, or `None` for one that has no position.
    fn joint(&self, joint: JointId) -> Option<Carrier> {
        let single = self.plan.kinds.get(joint.index())?.is_single();
        if single { self.carrier(BodyId(joint.0)).copied() } else { None }
    }

    /// The joint's multibody, the link's number there, and the number of its velocity.
    fn multibody(&self, carrier: &Carrier) -> Option<(&Multibody, usize, usize)> {
        let (multibody, link, dof) = carrier.link?;
        Some((self.physics.multibody_joints.get_multibody(multibody)?, link, dof))
    }

    /// Position and speed of a joint, or zero for one that has none.
    pub(crate) fn joint_state(&self, joint: JointId) -> [f32; 2] {
        if self.lost {
            return [f32::NAN; 2];
        }
        self.joint(joint).and_then(|carrier| self.carrier_state(&carrier)).unwrap_or_default()
    }

    fn carrier_state(&self, carrier: &Carrier) -> Option<[f32; 2]> {
        let (multibody, link, dof) = self.multibody(carrier)?;
        Some([multibody.link(link)?.joint().coords()[carrier.axis], multibody.generalized_velocity()[dof]])
    }

    /// Pose of a body's frame. The identity for a body that does not exist.
    pub(crate) fn pose_of(&self, body: BodyId) -> Pose {
        let Some(frame) = self.plan.frames.get(body.index()) else { return Pose::identity() };
        let Some(carrier) = frame.carrier else { return frame.pose };
        if self.lost {
            return Pose { position: [f32::NAN; 3], rotation: [f32::NAN; 4] };
        }
        let at = self.physics.bodies[self.plan.carriers[carrier].body].position();
        Pose { position: at.translation.into(), rotation: at.rotation.into() }.compose(&frame.pose)
    }

    /// Velocity of a body's origin and its angular velocity.
    pub(crate) fn velocity_of(&self, body: BodyId) -> Twist {
        let Some(carrier) = self.carrier(body) else { return Twist::default() };
        if self.lost {
            return Twist { linear: [f32::NAN; 3], angular: [f32::NAN; 3] };
        }
        let rigid = &self.physics.bodies[carrier.body];
        let (centre, angular) = match self.multibody(carrier) {
            // A link's body has its velocity only from the next step on.
            Some((multibody, link, _)) => {
                let v = multibody.body_jacobian(link) * multibody.generalized_velocity();
                (Vector::new(v[0], v[1], v[2]), Vector::new(v[3], v[4], v[5]))
            }
            None => (rigid.linvel(), rigid.angvel()),
        };
        let arm = Vector::from(self.pose_of(body).position) - rigid.center_of_mass();
        Twist { linear: (centre + angular.cross(arm)).into(), angular: angular.into() }
    }

    /// Evaluates the actuators' laws and passes the results, and springs of joints, to rapier: torque and stiffness as
    /// a spring, and damping.
    ///
    /// rapier adds `-k (q - rest) - k h v - d v`. The torque at this instant is all in `rest`.
    fn actuate(&mut self) {
        for drive in &self.plan.drives {
            let carrier = self.plan.carriers[drive.carrier];
            let Some((multibody, link, dof)) = carrier.link else { continue };
            let Some(multibody) = self.physics.multibody_joints.get_multibody_mut_internal(multibody) else { continue };
            let speed = multibody.generalized_velocity()[dof];
            let Some(found) = multibody.link_mut(link) else { continue };
            let position = found.joint.coords()[carrier.axis];
            let [mut stiffness, rest] = carrier.spring;
            let (mut torque, mut damping) = (-stiffness * (position - rest), 0.0);
            for Motor { law, command_range, actuator } in &self.plan.motors[drive.first..drive.first + drive.count] {
                let [first, second] = self.commands[*actuator];
                let command = [command_range.map_or(first, |range| clamp_command(range, first)), second];
                let effort = law.effort(position, speed, command);
                torque += effort.torque;
                stiffness += effort.stiffness;
                damping += effort.damping;
            }
            let stiffness = stiffness.max(LEAST_STIFFNESS);
            let rest = position + (torque + damping * speed) / stiffness;
            // rapier would replace an acceleration of NaN by zero and continue.
            self.lost |= !(rest.is_finite() && stiffness.is_finite() && damping.is_finite());
            found.joint.set_spring(carrier.axis, stiffness, rest);
            multibody.damping_mut()[dof] = carrier.damping + damping;
        }
    }

    /// One control step.
    pub(crate) fn advance(&mut self) {
        self.pushes.begin(&mut self.physics);
        for _ in 0..self.plan.substeps {
            if !self.lost {
                self.actuate();
            }
            if self.lost {
                break;
            }
            roll(&mut self.physics, &self.plan);
            self.physics.step_with_events(&self.plan.rules, &());
            self.limit_speeds();
            self.examine();
        }
        self.pushes.end(&mut self.physics);
    }

    /// Clamps the joints to their largest speeds. rapier has no such constraint.
    fn limit_speeds(&mut self) {
        for &(carrier, limit) in &self.plan.speed_limits {
            let Some((multibody, _, dof)) = self.plan.carriers[carrier].link else { continue };
            if let Some(multibody) = self.physics.multibody_joints.get_multibody_mut_internal(multibody) {
                let speed = &mut multibody.generalized_velocity_mut()[dof];
                *speed = speed.clamp(-limit, limit);
            }
        }
    }

    /// Lets a force act on a body in the next control step.
    pub(crate) fn push(&mut self, body: BodyId, point: [f32; 3], force: [f32; 3]) {
        if let Some(carrier) = self.carrier(body) {
            let carrier = carrier.body;
            self.pushes.add(carrier, point, force);
        }
    }

    /// Looks whether rapier has broken down.
    fn examine(&mut self) {
        let multibodies = self.physics.multibody_joints.multibodies();
        let finite = |m: &Multibody| m.generalized_velocity().iter().all(|v| v.is_finite());
        self.lost |= !self.physics.quarantine().is_empty() || !multibodies.into_iter().all(finite);
    }

    /// Restores the start, without commands, forces or contacts.
    pub(crate) fn reset(&mut self) {
        self.physics = copy(&self.initial);
        self.pushes.clear();
        self.commands.fill([0.0; 2]);
        (self.lost, self.moved) = (false, false);
    }

    /// Returns whether a snapshot is of a world of this description, judged by the numbers of parts.
    pub(crate) fn fits(&self, kept: &crate::rapier::snapshot::Kept) -> bool {
        let parts = |p: &PhysicsWorld| {
            let dofs: Vec<_> = p.multibody_joints.multibodies().map(Multibody::ndofs).collect();
            (p.bodies.len(), p.colliders.len(), dofs)
        };
        kept.commands.len() == self.commands.len() && parts(&kept.physics) == parts(&self.initial)
    }

    /// Puts a joint somewhere.
    pub(crate) fn put_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        let Some(carrier) = self.joint(joint) else { return };
        let Some((multibody, link, dof)) = carrier.link else { return };
        let Some(multibody) = self.physics.multibody_joints.get_multibody_mut(multibody) else { return };
        if let Some(found) = multibody.link_mut(link) {
            found.joint = MultibodyJoint::new(found.joint.data, false);
            found.joint.apply_displacement(&[position]);
        }
        multibody.generalized_velocity_mut()[dof] = speed;
        self.moved = true;
    }

    /// Puts a floating body somewhere, nothing happens to another.
    pub(crate) fn put_body(&mut self, body: BodyId, pose: Pose, twist: Twist) {
        if self.plan.kinds.get(body.index()) != Some(&JointKind::Floating) {
            return;
        }
        let Some(carrier) = self.carrier(body).copied() else { return };
        self.moved = true;
        let local = self.plan.frames[body.index()].pose;
        // The carrier's frame is parallel to the body's.
        let arm = pose.rotate(local.position.map(|x| -x));
        let angular = Vector::from(twist.angular);
        let at = Vector::from(pose.position) + Vector::from(arm);
        let at = rapier3d::math::Pose::from_parts(at, Rotation::from_array(pose.rotation).normalize());
        let mut linear = Vector::from(twist.linear);
        if let Some(rigid) = self.physics.bodies.get_mut(carrier.body) {
            let centre = at.transform_point(rigid.local_center_of_mass());
            linear += angular.cross(centre - Vector::from(pose.position));
            rigid.set_position(at, true);
            rigid.set_linvel(linear, true);
            rigid.set_angvel(angular, true);
        }
        if let Some((multibody, _, dof)) = carrier.link
            && let Some(multibody) = self.physics.multibody_joints.get_multibody_mut(multibody)
        {
            let words: [f32; 3] = linear.into();
            let turns: [f32; 3] = angular.into();
            for k in 0..3 {
                multibody.generalized_velocity_mut()[dof + k] = words[k];
                multibody.generalized_velocity_mut()[dof + 3 + k] = turns[k];
            }
        }
    }

    /// Brings everything that follows from places up to date: links, colliders, which bodies are near.
    pub(crate) fn settle(&mut self) {
        if !core::mem::take(&mut self.moved) {
            return;
        }
        let physics = &mut self.physics;
        let mut speeds = Vec::new();
        for carrier in &self.plan.carriers {
            let Some((multibody, 0 | 1, _)) = carrier.link else { continue };
            if let Some(multibody) = physics.multibody_joints.get_multibody_mut(multibody) {
                multibody.forward_kinematics(&physics.bodies, true);
                // Colliders follow a body only if it is placed by itself.
                for link in multibody.links() {
                    if let Some(body) = physics.bodies.get_mut(link.rigid_body_handle()) {
                        body.set_position(*link.local_to_world(), false);
                    }
                }
                multibody.update_rigid_bodies(&mut physics.bodies, true);
                speeds.extend_from_slice(multibody.generalized_velocity().as_slice());
            }
        }
        let free = |carrier: &&Carrier| carrier.link.is_none();
        let twist = |body: &RigidBody| [body.linvel(), body.angvel()];
        let twists = self.plan.carriers.iter().filter(free).map(|carrier| twist(&physics.bodies[carrier.body]));
        let twists: Vec<_> = twists.collect();
        // A step of no time does only that, but for blows on what is put against something: these are the next step's.
        let dt = core::mem::replace(&mut physics.integration_parameters.dt, 0.0);
        physics.step_with_events(&self.plan.rules, &());
        physics.integration_parameters.dt = dt;
        let mut speeds = speeds.into_iter();
        for carrier in &self.plan.carriers {
            let Some((multibody, 0 | 1, _)) = carrier.link else { continue };
            if let Some(multibody) = physics.multibody_joints.get_multibody_mut(multibody) {
                multibody.generalized_velocity_mut().iter_mut().zip(&mut speeds).for_each(|(to, speed)| *to = speed);
            }
        }
        for (carrier, [linear, angular]) in self.plan.carriers.iter().filter(free).zip(twists) {
            if let Some(body) = physics.bodies.get_mut(carrier.body) {
                body.set_linvel(linear, false);
                body.set_angvel(angular, false);
            }
        }
        self.examine();
    }
}

impl Clone for World {
    fn clone(&self) -> Self {
        Self {
            plan: self.plan.clone(),
            physics: copy(&self.physics),
            initial: copy(&self.initial),
            commands: self.commands.clone(),
            lost: self.lost,
            moved: self.moved,
            pushes: self.pushes.clone(),
        }
    }
}

impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World").field("plan", &self.plan).field("lost", &self.lost).finish_non_exhaustive()
    }
}
