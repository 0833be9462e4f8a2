//! From an arena with rigid robots and blocks to rapier's bodies, joints and colliders.

use alloc::vec::Vec;

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robots::MobileRobot;
use rapier3d::dynamics::{MultibodyIndex, RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::{Collider, ColliderBuilder, ColliderHandle, Group, InteractionGroups, SharedShape};
use rapier3d::math::{Pose as Frame, Rotation, Vector};
use rapier3d::parry::mass_properties::MassProperties;
use rapier3d::parry::query::contact;
use rapier3d::pipeline::PhysicsWorld;
use rapier3d::prelude::{CoefficientCombineRule, InteractionTestMode, JointAxis};

use crate::arena::convex::{Convex, ConvexForm};
use crate::rapier::arena_options::ArenaOptions;
use crate::rapier::arena_scene::{ArenaScene, Block, Chassis};
use crate::rapier::convert::vector;
use crate::rapier::error::RapierError;

/// The axis of a wheel.
pub(crate) const AXLE: JointAxis = JointAxis::AngX;
/// The lag of a wheel behind its commanded speed at its motor's full torque, in parts of the greatest speed.
const LAG: f64 = 0.01;
/// The ground.
const GROUND: Group = Group::GROUP_1;
/// Hulls, blocks and all other parts on the ground.
const SOLID: Group = Group::GROUP_2;
/// Wheels and skids, which touch the ground alone.
const FEET: Group = Group::GROUP_3;
/// Friction of what is rougher than everything that touches it: of two surfaces the smoother one decides.
const ROUGH: f32 = 1e3;
/// The height of the skids above the ground, in radii of the wheels. A robot rests on its wheels and one skid.
const CLEARANCE: f64 = 0.01;
/// The depth of a block in another part at the start, from rounding [m].
const SLACK: f32 = 1e-6;

/// A robot in rapier: the bodies of its chassis and wheels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vehicle {
    pub(crate) body: RigidBodyHandle,
    pub(crate) hull: ColliderHandle,
    pub(crate) multibody: MultibodyIndex,
    /// The number of each wheel among the links, and that of its velocity.
    pub(crate) wheels: [(usize, usize); 2],
    /// The height of the center of mass and the axle, where the body's origin is [m].
    pub(crate) axle: f32,
    /// The largest torque of each motor [N m].
    pub(crate) torque: f32,
    /// Its torque per speed that its wheel lacks [N m s/rad].
    pub(crate) gain: f32,
}

/// A block in rapier. The body's origin is its middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parcel {
    pub(crate) body: RigidBodyHandle,
    pub(crate) collider: ColliderHandle,
    pub(crate) half: [f32; 3],
    pub(crate) color: [f32; 3],
}

/// The bodies of the ports in rapier.
#[derive(Clone, Debug)]
pub(crate) struct ArenaPlan {
    pub(crate) vehicles: Vec<Vehicle>,
    pub(crate) cylinders: Vec<ColliderHandle>,
    /// Half the height of each cylinder [m].
    pub(crate) cylinder_halves: Vec<f32>,
    pub(crate) parcels: Vec<Parcel>,
    pub(crate) ground: ColliderHandle,
    pub(crate) substeps: u32,
}

impl ArenaPlan {
    /// The body of a collider, if it has one. Blocks are numbered from `first`.
    pub(crate) fn body_of(&self, collider: ColliderHandle, first: usize) -> Option<BodyId> {
        let robots = self.vehicles.len();
        let number = self.vehicles.iter().position(|vehicle| vehicle.hull == collider);
        let number = number.or_else(|| Some(robots + self.cylinders.iter().position(|c| *c == collider)?));
        let number = number.or_else(|| Some(first + self.parcels.iter().position(|p| p.collider == collider)?));
        number.map(|number| BodyId(number as u16))
    }
}

/// A place and a heading on the ground as rapier has them, so much higher.
pub(crate) fn standing(pose: &Pose, height: f32) -> Frame {
    let [x, y, _] = pose.position;
    let upright = Pose::planar([x, y], pose.heading());
    Frame::from_parts(Vector::new(x, y, height), Rotation::from_array(upright.rotation).normalize())
}

/// rapier's cylinders lie along y.
pub(crate) fn upright() -> Rotation {
    Rotation::from_axis_angle(Vector::X, core::f32::consts::FRAC_PI_2)
}

fn groups(of: Group, with: Group) -> InteractionGroups {
    InteractionGroups::new(of, with, InteractionTestMode::And)
}

fn collider(shape: SharedShape, friction: f64, of: Group, with: Group) -> ColliderBuilder {
    ColliderBuilder::new(shape)
        .density(0.0)
        .friction(friction as f32)
        .friction_combine_rule(CoefficientCombineRule::Min)
        .collision_groups(groups(of, with))
}

/// Builds a fixed part on the ground.
fn obstacle(shape: SharedShape, at: Frame) -> Collider {
    collider(shape, f64::from(ROUGH), SOLID, SOLID).position(at).build()
}

fn planar(centre: [f64; 2], heading: f64) -> Pose {
    Pose::planar(centre, heading).cast()
}

fn prism(number: usize, convex: &Convex) -> Result<SharedShape, RapierError> {
    let points: Vec<Vector> = match &convex.form {
        ConvexForm::Prism { corners, height } => {
            corners.iter().flat_map(|[x, y]| [[*x, *y, 0.0], [*x, *y, *height]]).map(vector).collect()
        }
        ConvexForm::Hull { points } => points.iter().copied().map(vector).collect(),
    };
    let unusable = || RapierError::SceneObject {
        name: alloc::format!("convex obstacle {number}"),
        why: alloc::format!("{} points span no solid", points.len()),
    };
    SharedShape::convex_hull(&points).ok_or_else(unusable)
}

/// A disc about the y axis.
fn wheel_mass(mass: f64, radius: f64) -> MassProperties {
    let about = 0.5 * mass * radius * radius;
    MassProperties::new(Vector::ZERO, mass as f32, vector([0.5 * about, about, 0.5 * about]))
}

/// A solid cylinder about the z axis.
fn hull_mass(mass: f64, radius: f64, height: f64) -> MassProperties {
    let across = mass * (3.0 * radius * radius + height * height) / 12.0;
    MassProperties::new(Vector::ZERO, mass as f32, vector([across, across, 0.5 * mass * radius * radius]))
}

/// A robot: hull and two skids, in one body with its origin between the wheels, and two wheels that touch the ground in
/// one point each.
fn add_vehicle(physics: &mut PhysicsWorld, robot: &MobileRobot, chassis: &Chassis, pose: &Pose) -> Option<Vehicle> {
    let (axle, radius) = (robot.wheel_radius, robot.radius);
    let at = standing(pose, axle as f32);
    let rigid = || RigidBodyBuilder::dynamic().can_sleep(false);
    let hull_share = (1.0 - chassis.wheel_share) * chassis.mass;
    let body = rigid().pose(at).additional_mass_properties(hull_mass(hull_share, radius, robot.height));
    let body = physics.insert_body(body);
    // The hull begins at the height of a skid's middle, so that it does not rest on its rim.
    let bottom = (0.5 * axle).min(0.5 * robot.height);
    let half = 0.5 * (robot.height - bottom);
    let shape = SharedShape::cylinder(half as f32, radius as f32);
    let place = Frame::from_parts(vector([0.0, 0.0, bottom + half - axle]), upright());
    let hull = collider(shape, chassis.friction, SOLID, SOLID | GROUND).position(place);
    let hull = physics.insert_collider(hull, Some(body));
    let skid = 0.25 * axle;
    for ahead in [0.7 * radius, -0.7 * radius] {
        let place = Frame::from_translation(vector([ahead, 0.0, skid + CLEARANCE * axle - axle]));
        let ball = collider(SharedShape::ball(skid as f32), 0.0, FEET, GROUND).position(place);
        physics.insert_collider(ball, Some(body));
    }
    let wheels = [0.5 * robot.track, -0.5 * robot.track].map(|left| {
        let side = vector([0.0, left, 0.0]);
        let mass = wheel_mass(0.5 * chassis.wheel_share * chassis.mass, axle);
        let wheel = rigid().pose(at * Frame::from_translation(side)).additional_mass_properties(mass);
        let wheel = physics.insert_body(wheel);
        let tread = collider(SharedShape::ball(axle as f32), chassis.grip, FEET, GROUND);
        physics.insert_collider(tread, Some(wheel));
        physics.insert_multibody_joint(body, wheel, RevoluteJointBuilder::new(Vector::Y).local_anchor1(side));
        wheel
    });
    let multibody = physics.multibody_joints.rigid_body_link(body)?.multibody;
    let found = physics.multibody_joints.get_multibody_mut(multibody)?;
    // The root gets its six velocities here. They have no damping.
    found.forward_kinematics(&physics.bodies, true);
    found.damping_mut().fill(0.0);
    let mut links = [(0, 0); 2];
    for (link, wheel) in links.iter_mut().zip(wheels) {
        let id = physics.multibody_joints.rigid_body_link(wheel)?.id;
        let found = physics.multibody_joints.get_multibody_mut(multibody)?;
        *link = (id, found.links().take(id).map(|link| link.joint().ndofs()).sum());
        found.armature_mut()[link.1] = chassis.rotor_inertia as f32;
    }
    let gain = chassis.torque / (LAG * robot.max_wheel_speed);
    let [axle, torque, gain] = [axle, chassis.torque, gain].map(|x| x as f32);
    Some(Vehicle { body, hull, multibody, wheels: links, axle, torque, gain })
}

fn add_block(physics: &mut PhysicsWorld, block: &Block) -> Parcel {
    let half = block.size.map(|x| (0.5 * x) as f32);
    let [a, b, c] = half;
    let at = standing(&planar(block.centre, block.heading), c);
    let body = physics.insert_body(RigidBodyBuilder::dynamic().can_sleep(false).pose(at));
    let collider = collider(SharedShape::cuboid(a, b, c), block.friction, SOLID, SOLID | GROUND);
    let collider = physics.insert_collider(collider.mass(block.mass as f32), Some(body));
    Parcel { body, collider, half, color: block.color.map(|x| x as f32) }
}

/// Looks whether blocks start free of everything but the ground.
fn check_blocks(physics: &PhysicsWorld, plan: &ArenaPlan) -> Result<(), RapierError> {
    for (block, parcel) in plan.parcels.iter().enumerate() {
        let Some(own) = physics.colliders.get(parcel.collider) else { continue };
        for (handle, other) in physics.all_colliders() {
            let solid = other.collision_groups().memberships == SOLID;
            if handle == parcel.collider || !solid {
                continue;
            }
            // Colliders on bodies have their place from the first step on.
            let place = |c: &Collider| {
                let local = c.position_wrt_parent().copied().unwrap_or(Frame::IDENTITY);
                c.parent().and_then(|b| physics.bodies.get(b)).map_or(*c.position(), |b| *b.position() * local)
            };
            let met = contact(&place(own), own.shape(), &place(other), other.shape(), 0.0);
            if let Ok(Some(met)) = met
                && met.dist < -SLACK
            {
                return Err(RapierError::BlockOverlap { block, depth: f64::from(-met.dist) });
            }
        }
    }
    Ok(())
}

/// Builds everything. The arena has been looked at.
pub(crate) fn build(scene: &ArenaScene, options: &ArenaOptions) -> Result<(ArenaPlan, PhysicsWorld), RapierError> {
    let arena = &scene.arena;
    let options = options.options(arena.time_step)?;
    let mut physics = options.world();
    let ground = collider(SharedShape::halfspace(Vector::Z), f64::from(ROUGH), GROUND, SOLID | FEET);
    let ground = physics.insert_collider(ground, None);
    for wall in &arena.walls {
        let [a, b, c] = [0.5 * wall.size[0], 0.5 * wall.size[1], 0.5 * wall.height].map(|x| x as f32);
        let at = standing(&planar(wall.centre, wall.heading), c);
        physics.insert_collider(obstacle(SharedShape::cuboid(a, b, c), at), None);
    }
    for (number, convex) in arena.convexes.iter().enumerate() {
        physics.insert_collider(obstacle(prism(number, convex)?, Frame::IDENTITY), None);
    }
    let cylinder_halves: Vec<f32> = arena.cylinders.iter().map(|cylinder| (0.5 * cylinder.height) as f32).collect();
    let cylinders = arena.cylinders.iter().zip(&cylinder_halves).map(|(cylinder, half)| {
        let at = standing(&planar(cylinder.centre, 0.0), *half);
        let shape = SharedShape::cylinder(*half, cylinder.radius as f32);
        physics.insert_collider(obstacle(shape, Frame::from_parts(at.translation, upright())), None)
    });
    let cylinders = cylinders.collect();
    let vehicles = arena.robots.iter().zip(&scene.chassis).enumerate().map(|(number, (placed, chassis))| {
        let pose = planar(placed.at, placed.heading);
        let vehicle = add_vehicle(&mut physics, &placed.robot, chassis, &pose);
        vehicle.ok_or_else(|| RapierError::SceneObject {
            name: alloc::format!("robot {number}"),
            why: "its wheels cannot be joined to it".into(),
        })
    });
    let vehicles = vehicles.collect::<Result<Vec<_>, _>>()?;
    let parcels = scene.blocks.iter().map(|block| add_block(&mut physics, block)).collect();
    let plan = ArenaPlan { vehicles, cylinders, cylinder_halves, parcels, ground, substeps: options.substeps };
    check_blocks(&physics, &plan)?;
    Ok((plan, physics))
}
