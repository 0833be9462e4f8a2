//! A single world of wheeled robots in rapier.

use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use farsa_body::ports::{BodyId, JointId, PairContact};
use farsa_body::robots::MobileParts;
use farsa_body::{Pose, Twist};
use farsa_num::Scalar;
use rapier3d::dynamics::{Multibody, MultibodyJoint};
use rapier3d::geometry::ColliderHandle;
use rapier3d::math::Vector;
use rapier3d::pipeline::PhysicsWorld;

use crate::arena::crowd::Crowd;
use crate::arena::model::{Model, POSE_WORDS, VELOCITY, WHEELS, pose_words};
use crate::arena::slab::Slab;
use crate::arena::step::{show_leds_and_signal, turned, wheel_speed};
use crate::arena::view::View;
use crate::rapier::arena_model::{AXLE, ArenaPlan, Vehicle, build, standing, upright};
use crate::rapier::arena_options::ArenaOptions;
use crate::rapier::arena_scene::ArenaScene;
use crate::rapier::contact::{pair_contact, touches};
use crate::rapier::error::RapierError;
use crate::rapier::model::Touching;
use crate::rapier::pushes::Pushes;
use crate::rapier::snapshot::copy;
use crate::rapier::world::LEAST_STIFFNESS;

/// A planar world in rapier whose robots are rigid bodies on wheels. It has the same ports as [`crate::arena::World`],
/// and it can also contain blocks.
///
/// - *Robots*: a hull (upright cylinder) on two wheels and two skids without friction, one of which is on the ground.
///   Wheels touch the ground in one point each. So robots accelerate, slip and stall. The center of mass is between the
///   wheels.
/// - *Motors* turn a wheel with a torque in proportion to its lag behind the commanded speed, and with the full torque
///   from a hundredth of the greatest speed on. NaN stops them.
/// - *Wheels* report the mean speed of the last control step, as encoders do, and positions within +-16 turns.
/// - *Walls, convex obstacles and cylinders* do not move. The smoother of two surfaces decides. Walls and ground are
///   rougher than anything.
/// - *Contacts*: pair `r` is robot `r` and what its hull met hardest in any step of rapier of the last control step,
///   with that force. Then come the pairs of blocks. `None` is a wall, and nothing where it does not touch. The ground
///   is left out.
/// - *Sight* shows robots and cylinders as in the kinematic world. A block appears by the side that is most nearly on
///   the ground, as if it rested on it, in the order of the numbers. Rays in space hit blocks in their actual pose.
/// - *Poses* of robots and blocks are those of rapier: a robot leans by some tenths of a degree on its skids.
/// - *Arranging*: a body keeps its place and heading of a pose, upright and at rest. Overlapping bodies are pushed
///   apart.
///
/// If a world breaks down, it cannot be stepped, and every port returns NaN. You have to clear or restore it before you
/// can continue.
pub struct ArenaWorld {
    pub(crate) model: Model,
    pub(crate) plan: ArenaPlan,
    pub(crate) physics: PhysicsWorld,
    initial: PhysicsWorld,
    /// The words of a kinematic world: places, wheels, commands, LEDs and signals.
    pub(crate) words: Vec<f32>,
    pub(crate) crowd: Crowd,
    /// The other body of each pair, and the contact.
    pub(crate) met: Vec<(Option<BodyId>, PairContact)>,
    /// The blocks as sensors of the plane see them.
    pub(crate) slabs: Vec<Slab>,
    pub(crate) lost: bool,
    /// True if something was placed since colliders and neighbors were brought up to date.
    pub(crate) moved: bool,
    /// Forces from outside that act in the next control step.
    pub(crate) pushes: Pushes,
}

/// A place of a world that has broken down.
const NOWHERE: Pose = Pose { position: [f32::NAN; 3], rotation: [f32::NAN; 4] };

impl ArenaWorld {
    /// Creates a world in the initial state of its description.
    ///
    /// # Errors
    /// A fault of the arena ([`RapierError::Arena`]), a robot with an attachment device, a number of chassis that
    /// differs from that of robots, a number out of its range, or a block that overlaps something.
    pub fn new(scene: &ArenaScene, options: &ArenaOptions) -> Result<Self, RapierError> {
        let model = Model::new(&scene.arena)?;
        scene.check()?;
        let (plan, physics) = build(scene, options)?;
        let words = model.initial.clone();
        let crowd = Crowd::new(&model, scene.arena.size);
        let (blocks, pairs) = (plan.parcels.len(), plan.vehicles.len() + plan.parcels.len());
        let mut world = Self {
            model,
            plan,
            initial: copy(&physics),
            physics,
            words,
            crowd,
            met: vec![(None, PairContact::default()); pairs],
            slabs: Vec::with_capacity(blocks),
            lost: false,
            moved: true,
            pushes: Pushes::default(),
        };
        world.settle();
        world.initial = copy(&world.physics);
        Ok(world)
    }

    /// Number of robots in the world.
    pub fn robots(&self) -> usize {
        self.plan.vehicles.len()
    }

    /// Gets the numbers of the parts of a robot. If there is no such robot, the parts of the last one are returned.
    pub fn parts(&self, robot: usize) -> MobileParts {
        self.model.parts(robot)
    }

    /// Checks that the world has not broken down. If this is false, you have to clear or restore the world before it
    /// can be stepped again.
    pub fn is_finite(&self) -> bool {
        !self.lost
    }

    /// Gets the internal state of rapier. Use this for anything that the ports do not report.
    pub fn physics(&self) -> &PhysicsWorld {
        &self.physics
    }

    /// The number of a body among the blocks.
    pub(crate) fn block_of(&self, body: BodyId) -> Option<usize> {
        body.index().checked_sub(self.model.bodies()).filter(|block| *block < self.plan.parcels.len())
    }

    fn multibody(&self, vehicle: &Vehicle) -> Option<&Multibody> {
        self.physics.multibody_joints.get_multibody(vehicle.multibody)
    }

    /// Pose of a robot, from what rapier has.
    pub(crate) fn robot_pose(&self, robot: usize) -> Pose {
        let vehicle = self.plan.vehicles[robot];
        if self.lost {
            return NOWHERE;
        }
        let at = self.physics.bodies[vehicle.body].position();
        let at = Pose { position: at.translation.into(), rotation: at.rotation.into() };
        at.compose(&Pose::at([0.0, 0.0, -vehicle.axle]))
    }

    /// Pose of a block, from what rapier has.
    pub(crate) fn block_pose(&self, block: usize) -> Pose {
        let parcel = &self.plan.parcels[block];
        if self.lost {
            return NOWHERE;
        }
        let at = self.physics.bodies[parcel.body].position();
        let at = Pose { position: at.translation.into(), rotation: at.rotation.into() };
        at.compose(&Pose::at([0.0, 0.0, -parcel.half[2]]))
    }

    /// The velocity of a body's origin, which lies so far below its center of mass in its frame.
    fn below(pose: &Pose, linear: Vector, angular: Vector, depth: f32) -> Twist {
        let arm = Vector::from(pose.rotate([0.0, 0.0, -depth]));
        Twist { linear: (linear + angular.cross(arm)).into(), angular: angular.into() }
    }

    pub(crate) fn robot_velocity(&self, robot: usize) -> Twist {
        let vehicle = self.plan.vehicles[robot];
        let Some(multibody) = self.multibody(&vehicle).filter(|_| !self.lost) else {
            return Twist { linear: [f32::NAN; 3], angular: [f32::NAN; 3] };
        };
        // A link's body has its velocity only from the next step on.
        let v = multibody.generalized_velocity();
        let (linear, angular) = (Vector::new(v[0], v[1], v[2]), Vector::new(v[3], v[4], v[5]));
        Self::below(&self.robot_pose(robot), linear, angular, vehicle.axle)
    }

    pub(crate) fn block_velocity(&self, block: usize) -> Twist {
        let parcel = &self.plan.parcels[block];
        if self.lost {
            return Twist { linear: [f32::NAN; 3], angular: [f32::NAN; 3] };
        }
        let rigid = &self.physics.bodies[parcel.body];
        Self::below(&self.block_pose(block), rigid.linvel(), rigid.angvel(), parcel.half[2])
    }

    /// One control step.
    pub(crate) fn advance(&mut self) {
        if self.moved {
            self.settle();
        }
        for robot in 0..self.plan.vehicles.len() {
            show_leds_and_signal::<f32>((), &self.model, &mut self.words, robot);
        }
        self.count();
        self.met.fill((None, PairContact::default()));
        self.pushes.begin(&mut self.physics);
        for _ in 0..self.plan.substeps {
            if !self.lost {
                self.drive();
            }
            if self.lost {
                break;
            }
            self.physics.step_with_events(&(), &());
            self.examine();
            self.feel();
        }
        self.pushes.end(&mut self.physics);
        self.count();
        self.observe();
    }

    /// Gives rapier the motors' law: a torque in proportion to the speed that a wheel lacks, up to the largest.
    ///
    /// The law is a damping and so part of the multibody's mass. A motor of rapier is a constraint, which works against
    /// the friction of each wheel. With few sweeps wheels slip in proportion to the pushed load. Impulses that start
    /// from the last step's make the wheels of one axle push against each other until the grip is exhausted.
    fn drive(&mut self) {
        for (robot, vehicle) in self.plan.vehicles.iter().enumerate() {
            let most = self.model.kind(robot).max_wheel_speed;
            let Some(multibody) = self.physics.multibody_joints.get_multibody_mut_internal(vehicle.multibody) else {
                continue;
            };
            for (side, (link, dof)) in vehicle.wheels.into_iter().enumerate() {
                let commanded = wheel_speed(self.words[self.model.command(robot, side)], most);
                let lacking = commanded - multibody.generalized_velocity()[dof];
                // A gain that lets the largest torque fade as the wheel comes up to speed, so that it does not overshoot.
                let gain = vehicle.gain.min(vehicle.torque / lacking.abs());
                let Some(found) = multibody.link_mut(link) else { continue };
                let rest = found.joint.coords()[AXLE as usize] + gain * commanded / LEAST_STIFFNESS;
                // rapier would replace an acceleration of NaN by zero and continue.
                self.lost |= !(rest.is_finite() && lacking.is_finite());
                found.joint.set_spring(AXLE as usize, LEAST_STIFFNESS, rest);
                multibody.damping_mut()[dof] = gain;
            }
        }
    }

    /// Looks whether rapier has broken down.
    fn examine(&mut self) {
        let multibodies = self.physics.multibody_joints.multibodies();
        let finite = |m: &Multibody| m.generalized_velocity().iter().all(|v| v.is_finite());
        self.lost |= !self.physics.quarantine().is_empty() || !multibodies.into_iter().all(finite);
    }

    /// Keeps what robots and blocks met hardest.
    fn feel(&mut self) {
        let Self { plan, physics, met, model, .. } = self;
        let hulls = plan.vehicles.iter().map(|vehicle| (vehicle.hull, true));
        let colliders = hulls.chain(plan.parcels.iter().map(|parcel| (parcel.collider, false)));
        for ((collider, of_links), met) in colliders.zip(met) {
            for pair in physics.narrow_phase.contact_pairs_with(collider) {
                let other = if pair.collider1 == collider { pair.collider2 } else { pair.collider1 };
                if other == plan.ground {
                    continue;
                }
                let of_links = of_links || plan.vehicles.iter().any(|vehicle| vehicle.hull == other);
                let pair = touching([collider, other], of_links);
                if touches(physics, &pair) {
                    let contact = pair_contact(physics, &pair);
                    if contact.normal_force > met.1.normal_force {
                        *met = (plan.body_of(other, model.bodies()), contact);
                    }
                }
            }
        }
    }

    /// Writes down where everything is now.
    fn observe(&mut self) {
        for robot in 0..self.plan.vehicles.len() {
            let (pose, twist) = (self.robot_pose(robot), self.robot_velocity(robot));
            let [x, y, _] = pose.position;
            let words = pose_words([x, y], pose.heading());
            self.words[POSE_WORDS * robot..][..POSE_WORDS].copy_from_slice(&words);
            let first = self.model.robot_word(robot, 0);
            let [u, v, _] = twist.linear;
            self.words[first + VELOCITY..][..3].copy_from_slice(&[u, v, twist.angular[2]]);
            if self.lost {
                self.words[first + WHEELS..][..4].fill(f32::NAN);
            }
        }
        self.see_blocks();
        if !self.lost {
            self.crowd.fill(&self.words);
        }
    }

    /// Reads how far wheels have turned, from where they were when this was called last. Their positions are kept
    /// within their range.
    fn count(&mut self) {
        for (robot, vehicle) in self.plan.vehicles.iter().enumerate() {
            let first = self.model.robot_word(robot, WHEELS);
            let Some(multibody) = self.physics.multibody_joints.get_multibody_mut_internal(vehicle.multibody) else {
                continue;
            };
            for (side, (link, _)) in vehicle.wheels.into_iter().enumerate() {
                let Some(link) = multibody.link_mut(link) else { continue };
                let position = link.joint.coords()[AXLE as usize];
                self.words[first + 2 + side] = (position - self.words[first + side]) / self.model.time_step;
                let wrapped = turned(position, 0.0, 0.0);
                self.words[first + side] = wrapped;
                if wrapped != position {
                    link.joint = MultibodyJoint::new(link.joint.data, false);
                    link.joint.apply_displacement(&[wrapped]);
                }
            }
        }
    }

    /// Brings the blocks' outlines in the plane up to date.
    fn see_blocks(&mut self) {
        self.slabs.clear();
        for block in 0..self.plan.parcels.len() {
            let slab = self.slab(block);
            self.slabs.push(slab);
        }
    }

    /// Brings what sensors see up to date after the words were brought back.
    pub(crate) fn look_again(&mut self) {
        if self.lost {
            self.observe();
        } else {
            self.see_blocks();
            self.crowd.fill(&self.words);
        }
    }

    /// A block as if it stood on the side that is most nearly on the ground.
    fn slab(&self, block: usize) -> Slab {
        let parcel = &self.plan.parcels[block];
        let pose = self.block_pose(block);
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| pose.rotate(axis));
        // The last of equals, so that an upright block stays upright.
        let up = (0..3).fold(2, |up, k| if axes[k][2].abs() > axes[up][2].abs() { k } else { up });
        let [along, across] = [[1, 2], [0, 2], [0, 1]][up];
        let [x, y, _] = axes[along];
        let length = Scalar::sqrt(x * x + y * y);
        let axis = [x / length, y / length];
        let half = [parcel.half[along], parcel.half[across]];
        let [a, b] = half;
        let [x, y, _] = pose.transform([0.0, 0.0, parcel.half[2]]);
        let [c, s] = axis.map(f32::abs);
        Slab {
            centre: [x, y],
            axis,
            half,
            around: [a * c + b * s, a * s + b * c],
            height: 2.0 * parcel.half[up],
            color: parcel.color,
        }
    }

    /// Restores the start, without commands, forces or contacts.
    pub(crate) fn reset(&mut self) {
        self.physics = copy(&self.initial);
        self.pushes.clear();
        self.met.fill((None, PairContact::default()));
        (self.lost, self.moved) = (false, false);
        self.observe();
    }

    /// Lets a force act on a robot or block in the next control step.
    pub(crate) fn push(&mut self, body: BodyId, point: [f32; 3], force: [f32; 3]) {
        let robot = self.plan.vehicles.get(body.index()).map(|vehicle| vehicle.body);
        let block = || self.block_of(body).map(|block| self.plan.parcels[block].body);
        if let Some(body) = robot.or_else(block) {
            self.pushes.add(body, point, force);
        }
    }

    /// Puts a wheel somewhere.
    pub(crate) fn put_wheel(&mut self, joint: JointId, position: f32, speed: f32) {
        let (robot, side) = (joint.index() / 2, joint.index() % 2);
        let Some(vehicle) = self.plan.vehicles.get(robot).copied() else { return };
        let (link, dof) = vehicle.wheels[side];
        let Some(multibody) = self.physics.multibody_joints.get_multibody_mut(vehicle.multibody) else { return };
        if let Some(found) = multibody.link_mut(link) {
            found.joint = MultibodyJoint::new(found.joint.data, false);
            found.joint.apply_displacement(&[position]);
        }
        multibody.generalized_velocity_mut()[dof] = speed;
        self.moved = true;
    }

    /// Puts a robot, cylinder or block down, upright and at rest. Areas have nothing in rapier.
    pub(crate) fn put_body(&mut self, body: BodyId, pose: &Pose) {
        let robots = self.plan.vehicles.len();
        self.moved = true;
        if let Some(vehicle) = self.plan.vehicles.get(body.index()).copied() {
            self.met[body.index()] = (None, PairContact::default());
            if let Some(rigid) = self.physics.bodies.get_mut(vehicle.body) {
                rigid.set_position(standing(pose, vehicle.axle), true);
                rigid.set_linvel(Vector::ZERO, true);
                rigid.set_angvel(Vector::ZERO, true);
            }
            if let Some(multibody) = self.physics.multibody_joints.get_multibody_mut(vehicle.multibody) {
                multibody.generalized_velocity_mut().rows_mut(0, 6).fill(0.0);
            }
        } else if let Some(block) = self.block_of(body) {
            self.met[robots + block] = (None, PairContact::default());
            let parcel = &self.plan.parcels[block];
            if let Some(rigid) = self.physics.bodies.get_mut(parcel.body) {
                rigid.set_position(standing(pose, parcel.half[2]), true);
                rigid.set_linvel(Vector::ZERO, true);
                rigid.set_angvel(Vector::ZERO, true);
            }
        } else if let Some(cylinder) = body.index().checked_sub(robots)
            && let Some(handle) = self.plan.cylinders.get(cylinder)
            && let Some(collider) = self.physics.colliders.get_mut(*handle)
        {
            let mut at = standing(pose, self.plan.cylinder_halves[cylinder]);
            at.rotation = upright();
            collider.set_position(at);
        }
    }

    /// Brings everything that follows from places up to date: links, colliders, which bodies are near, what is seen.
    pub(crate) fn settle(&mut self) {
        if core::mem::take(&mut self.moved) {
            let physics = &mut self.physics;
            for vehicle in &self.plan.vehicles {
                if let Some(multibody) = physics.multibody_joints.get_multibody_mut(vehicle.multibody) {
                    multibody.forward_kinematics(&physics.bodies, true);
                    multibody.update_rigid_bodies(&mut physics.bodies, true);
                }
            }
            // A step of no time, without the impulses of the last one, does only that.
            let usual = physics.integration_parameters;
            (physics.integration_parameters.dt, physics.integration_parameters.warmstart_coefficient) = (0.0, 0.0);
            physics.step_with_events(&(), &());
            physics.integration_parameters = usual;
            self.examine();
        }
        self.observe();
    }

    /// Returns whether rapier's state is of a world of this description, judged by the numbers of parts.
    pub(crate) fn fits(&self, physics: &PhysicsWorld) -> bool {
        let parts = |p: &PhysicsWorld| {
            let dofs: Vec<_> = p.multibody_joints.multibodies().map(Multibody::ndofs).collect();
            (p.bodies.len(), p.colliders.len(), dofs)
        };
        parts(physics) == parts(&self.initial)
    }
}

/// Two colliders as a pair.
fn touching(colliders: [ColliderHandle; 2], of_links: bool) -> Touching {
    Touching { colliders, bodies: [None; 2], carriers: [None; 2], rolling_friction: 0.0, of_links }
}

impl View for ArenaWorld {
    fn model(&self) -> &Model {
        &self.model
    }
    #[inline(always)]
    fn word(&self, index: usize) -> f32 {
        self.words[index]
    }
    #[inline(always)]
    fn set_word(&mut self, index: usize, x: f32) {
        self.words[index] = x;
    }
    fn visit(&self, low: [f32; 2], high: [f32; 2], tell: impl FnMut(usize)) {
        self.crowd.visit(&self.model, low, high, tell);
    }
    fn gridded(&self) -> bool {
        self.crowd.grid.is_some()
    }
}

impl Clone for ArenaWorld {
    fn clone(&self) -> Self {
        Self {
            model: self.model.clone(),
            plan: self.plan.clone(),
            physics: copy(&self.physics),
            initial: copy(&self.initial),
            words: self.words.clone(),
            crowd: self.crowd.clone(),
            met: self.met.clone(),
            slabs: self.slabs.clone(),
            lost: self.lost,
            moved: self.moved,
            pushes: self.pushes.clone(),
        }
    }
}

impl fmt::Debug for ArenaWorld {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ArenaWorld").field("plan", &self.plan).field("lost", &self.lost).finish_non_exhaustive()
    }
}
