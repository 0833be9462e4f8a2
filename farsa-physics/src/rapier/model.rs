//! From a description to rapier's bodies, joints and colliders.

use alloc::format;
use alloc::vec;
use alloc::vec::Vec;

use farsa_body::Pose;
use farsa_body::actuators::Law;
use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, Robot, Shape};
use rapier3d::dynamics::{
    GenericJointBuilder, JointAxesMask, JointAxis, MultibodyIndex, RigidBodyBuilder, RigidBodyHandle,
};
use rapier3d::geometry::{ColliderBuilder, ColliderHandle};
use rapier3d::math::Mat3;
use rapier3d::parry::mass_properties::MassProperties;
use rapier3d::pipeline::{ActiveHooks, PhysicsWorld};

use crate::articulated::link::{Link, Motion, WORLD};
use crate::articulated::links::{compose, frame, links_of, set_limits};
use crate::articulated::model::{ModelError, Mount, Options as Stops};
use crate::articulated::spatial::{rotate, sub};
use crate::articulated::view::quaternion;
use crate::rapier::convert::{pose, shape_of, vector};
use crate::rapier::error::RapierError;
use crate::rapier::options::Options;
use crate::rapier::rules::Rules;
use crate::rapier::scene::{Scene, SceneObject, Side};

/// A moving part: a free body, or a link of a multibody.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carrier {
    pub(crate) body: RigidBodyHandle,
    /// The multibody, the link's number there, and the number of its first velocity there.
    pub(crate) link: Option<(MultibodyIndex, usize, usize)>,
    /// About the axis or along it, for joints: rapier's number of it.
    pub(crate) axis: usize,
    /// Damping of the joint itself [N m s/rad or N s/m].
    pub(crate) damping: f32,
    /// Stiffness of the joint's own spring [N m/rad or N/m], and the position at which it exerts no effort.
    pub(crate) spring: [f32; 2],
    /// Mean inertia of the body alone [kg m2].
    pub(crate) inertia: f32,
}

/// Where a body of the ports is: on which carrier (none: the world), and its frame in the carrier's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyFrame {
    pub(crate) carrier: Option<usize>,
    pub(crate) pose: Pose,
}

/// A pair of colliders of the port.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touching {
    pub(crate) colliders: [ColliderHandle; 2],
    pub(crate) bodies: [Option<BodyId>; 2],
    pub(crate) carriers: [Option<usize>; 2],
    pub(crate) rolling_friction: f32,
    /// True if a link of a multibody is among them.
    pub(crate) of_links: bool,
}

/// A joint with its actuators.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drive {
    pub(crate) carrier: usize,
    pub(crate) first: usize,
    pub(crate) count: usize,
}

/// An actuator with its number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motor {
    pub(crate) law: Law<f32>,
    pub(crate) command_range: Option<[f32; 2]>,
    pub(crate) actuator: usize,
}

/// The constant part of a world of rapier.
#[derive(Clone, Debug)]
pub(crate) struct RobotPlan {
    pub(crate) carriers: Vec<Carrier>,
    pub(crate) frames: Vec<BodyFrame>,
    pub(crate) kinds: Vec<JointKind>,
    pub(crate) collider_bodies: Vec<Option<BodyId>>,
    /// The colors of the robot's colliders, objects have none.
    pub(crate) colors: Vec<Option<[f32; 3]>>,
    pub(crate) pairs: Vec<Touching>,
    pub(crate) rules: Rules,
    pub(crate) drives: Vec<Drive>,
    /// The actuators of the drives, drive by drive.
    pub(crate) motors: Vec<Motor>,
    pub(crate) actuators: usize,
    /// The largest speeds of joints, with the numbers of their carriers.
    pub(crate) speed_limits: Vec<(usize, f32)>,
    pub(crate) time_step: f32,
    pub(crate) substeps: u32,
}

/// Mass, center and inertia as rapier has them.
fn mass_of(link: &Link<f64>) -> MassProperties {
    let [xx, yy, zz, xy, xz, yz] = link.inertia.map(|x| x as f32);
    let inertia = Mat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
    MassProperties::with_inertia_matrix(vector(link.centre), link.mass as f32, inertia)
}

/// Puts the frames of floating links into their centers of mass: the root of one of rapier's multibodies turns about
/// its origin.
fn centre_roots(links: &mut [Link<f64>], mounts: &mut [Mount<f64>]) -> Vec<[f64; 3]> {
    let mut shifts = vec![[0.0; 3]; links.len()];
    for i in 0..links.len() {
        if links[i].motion != Motion::Floating {
            continue;
        }
        shifts[i] = links[i].centre;
        links[i].centre = [0.0; 3];
        for link in links.iter_mut().filter(|link| usize::from(link.parent) == i) {
            link.offset = sub(link.offset, shifts[i]);
        }
        for mount in mounts.iter_mut().filter(|mount| usize::from(mount.link) == i) {
            mount.position = sub(mount.position, shifts[i]);
        }
    }
    shifts
}

/// Builds the bodies, joints and colliders of a scene.
pub(crate) fn build(scene: &Scene, options: &Options) -> Result<(RobotPlan, PhysicsWorld), RapierError> {
    let robot = &scene.robot;
    robot.validate()?;
    options.check()?;
    scene.check()?;
    for (what, count) in [
        ("segments and objects", robot.segments.len() + scene.objects.len()),
        ("colliders and objects", robot.colliders.len() + scene.objects.len()),
        ("pairs", scene.sides().count()),
        ("actuators", robot.actuators.len()),
    ] {
        if count >= usize::from(u16::MAX) {
            return Err(ModelError::TooMany { what, count }.into());
        }
    }
    let (mut links, mut mounts) = links_of(robot);
    check_masses(robot, &mounts, &links)?;
    if let Some(ground) = robot.grounds.first() {
        let body = &robot.segments[ground.body.index()].name;
        let why = format!("body {body}: nothing rubs on the ground that it slides on here");
        return Err(RapierError::Unsupported { why });
    }
    let shifts = centre_roots(&mut links, &mut mounts);
    let mut physics = options.world();
    let mut carriers = add_links(&mut physics, &links, &shifts);

    let body_frame = |mount: &Mount<f64>| BodyFrame {
        carrier: (mount.link != WORLD).then_some(usize::from(mount.link)),
        pose: Pose { position: mount.position, rotation: quaternion(&mount.rotation) }.cast(),
    };
    let mut frames: Vec<_> = mounts.iter().map(body_frame).collect();
    let mut colliders = Vec::new();
    let mut on = Vec::new();
    for (number, collider) in robot.colliders.iter().enumerate() {
        let local = frame(&collider.placement);
        let mount = collider.body.map_or(local, |body| compose(&mounts[body.index()], &local));
        let carrier = (mount.link != WORLD).then_some(usize::from(mount.link));
        if carrier.is_some() && collider.shape == Shape::Plane {
            let why = format!("collider {}: a plane does not move", collider.name);
            return Err(RapierError::Unsupported { why });
        }
        let (shape, local) = shape_of(&collider.shape);
        let built = ColliderBuilder::new(shape)
            .position(pose(&mount) * local)
            .density(0.0)
            .user_data(Rules::mark(number))
            .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS | ActiveHooks::MODIFY_SOLVER_CONTACTS);
        colliders.push(physics.insert_collider(built, carrier.map(|c| carriers[c].body)));
        on.push(carrier);
    }
    let mut bodies: Vec<_> = robot.colliders.iter().map(|c| c.body).collect();
    let mut kinds: Vec<_> = robot.segments.iter().map(|s| s.joint.kind).collect();
    for object in &scene.objects {
        let carrier = object.mass.map(|_| carriers.len());
        bodies.push(Some(BodyId(frames.len() as u16)));
        kinds.push(if carrier.is_some() { JointKind::Floating } else { JointKind::Fixed });
        let pose = if carrier.is_some() { Pose::identity() } else { object.placement.cast() };
        frames.push(BodyFrame { carrier, pose });
        let (added, collider) = add_object(&mut physics, object, colliders.len())?;
        carriers.extend(added);
        colliders.push(collider);
        on.push(carrier);
    }
    let sides: Vec<_> = scene.sides().map(|sides| sides.map(|side| number_of(side, robot.colliders.len()))).collect();
    let surface = |number: usize| robot.pairs.get(number).map(|pair| pair.surface);
    let rules = sides.iter().enumerate().map(|(number, sides)| {
        let object = |number: &usize| Some(scene.objects.get(number.checked_sub(robot.colliders.len())?)?.friction);
        let between = || match (object(&sides[0]), object(&sides[1])) {
            (Some(a), Some(b)) => farsa_num::Scalar::sqrt(a * b),
            (a, b) => a.or(b).unwrap_or(0.0),
        };
        let restitution = robot.pairs.get(number).map_or(0.0, |pair| pair.restitution);
        (*sides, [surface(number).map_or_else(between, |surface| surface.friction), restitution])
    });
    let rules: Vec<_> = rules.collect();
    let pairs = sides.iter().enumerate().map(|(number, sides)| Touching {
        colliders: sides.map(|c| colliders[c]),
        bodies: sides.map(|c| bodies[c]),
        carriers: sides.map(|c| on[c]),
        rolling_friction: surface(number).map_or(0.0, |surface| surface.rolling_friction as f32),
        of_links: sides.iter().any(|c| on[*c].is_some_and(|c| carriers[c].link.is_some())),
    });
    let (drives, motors) = drives_of(robot, &mounts);
    let plan = RobotPlan {
        pairs: pairs.collect(),
        kinds,
        collider_bodies: bodies,
        colors: robot.colliders.iter().map(|c| c.color.map(|color| color.map(|shade| shade as f32))).collect(),
        rules: Rules::new(colliders.len(), &rules),
        carriers,
        frames,
        drives,
        motors,
        actuators: robot.actuators.len(),
        speed_limits: speed_limits_of(robot, &mounts),
        time_step: options.time_step as f32,
        substeps: options.substeps,
    };
    Ok((plan, physics))
}

/// The number of a side's collider.
fn number_of(side: Side, colliders: usize) -> usize {
    match side {
        Side::Collider(number) => number,
        Side::SceneObject(number) => colliders + number,
    }
}

/// An object's body, if it moves, and its collider.
fn add_object(
    physics: &mut PhysicsWorld,
    object: &SceneObject,
    number: usize,
) -> Result<(Option<Carrier>, ColliderHandle), RapierError> {
    let (shape, local) = object.shape()?;
    let at = pose(&frame(&object.placement));
    let built = ColliderBuilder::new(shape)
        .user_data(Rules::mark(number))
        .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS | ActiveHooks::MODIFY_SOLVER_CONTACTS);
    let Some(mass) = object.mass else {
        return Ok((None, physics.insert_collider(built.position(at * local), None)));
    };
    let body = physics.insert_body(RigidBodyBuilder::dynamic().can_sleep(false).pose(at));
    let collider = physics.insert_collider(built.position(local).mass(mass as f32), Some(body));
    Ok((Some(Carrier { body, link: None, axis: 0, damping: 0.0, spring: [0.0; 2], inertia: 0.0 }), collider))
}

/// Refuses joints that move no mass and have no armature.
fn check_masses(robot: &Robot, mounts: &[Mount<f64>], links: &[Link<f64>]) -> Result<(), ModelError> {
    let mut links = links.to_vec();
    let (mut initial, mut dofs) = (Vec::new(), 0);
    for link in &links {
        let floating = link.motion == Motion::Floating;
        initial.extend_from_slice(if floating { &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] } else { &[0.0] });
        dofs += if floating { 6 } else { 1 };
    }
    set_limits(robot, mounts, &mut links, &initial, dofs, &Stops::default(), 0.0)
}

/// The moving bodies and their joints.
fn add_links(physics: &mut PhysicsWorld, links: &[Link<f64>], shifts: &[[f64; 3]]) -> Vec<Carrier> {
    let mut handles = Vec::new();
    for (link, shift) in links.iter().zip(shifts) {
        let at = Mount { link: WORLD, rotation: link.rotation, position: link.offset };
        let body = RigidBodyBuilder::dynamic()
            .can_sleep(false)
            .gyroscopic_forces_enabled(true)
            .additional_mass_properties(mass_of(link));
        if link.motion == Motion::Floating {
            let position = crate::articulated::spatial::add(at.position, rotate(&at.rotation, *shift));
            handles.push(physics.insert_body(body.pose(pose(&Mount { position, ..at }))));
            continue;
        }
        let child = physics.insert_body(body);
        let parent = match handles.get(usize::from(link.parent)) {
            Some(parent) => *parent,
            None => physics.insert_body(RigidBodyBuilder::fixed()),
        };
        let (free, axis) = match link.motion {
            Motion::Prismatic => (JointAxesMask::LIN_Z, JointAxis::LinZ),
            _ => (JointAxesMask::ANG_Z, JointAxis::AngZ),
        };
        let mut joint = GenericJointBuilder::new(JointAxesMask::all() & !free).local_frame1(pose(&at));
        if link.lower.is_finite() || link.upper.is_finite() {
            let bound = |x: f64| x.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32;
            joint = joint.limits(axis, [bound(link.lower), bound(link.upper)]);
        }
        physics.insert_multibody_joint(parent, child, joint.build());
        handles.push(child);
    }
    let mut carriers: Vec<Carrier> = Vec::new();
    // A fixed root only loses its six velocities here, and with them their numbers.
    let joints = &mut physics.multibody_joints;
    let roots: Vec<_> = handles.iter().filter_map(|h| joints.rigid_body_link(*h).map(|l| l.multibody)).collect();
    for root in &roots {
        if let Some(multibody) = joints.get_multibody_mut(*root) {
            multibody.forward_kinematics(&physics.bodies, true);
            multibody.damping_mut().fill(0.0);
        }
    }
    for (link, handle) in links.iter().zip(&handles) {
        let found = physics.multibody_joints.rigid_body_link(*handle).copied();
        let place = found.and_then(|found| {
            let multibody = physics.multibody_joints.get_multibody_mut(found.multibody)?;
            let dof = multibody.links().take(found.id).map(|l| l.joint().ndofs()).sum();
            if link.motion != Motion::Floating {
                multibody.armature_mut()[dof] = link.armature as f32;
                multibody.damping_mut()[dof] = link.damping as f32;
                multibody.frictions_mut()[dof] = link.friction as f32;
                let start = 0.0_f64.max(link.lower).min(link.upper) as f32;
                multibody.link_mut(found.id)?.joint.apply_displacement(&[start]);
            }
            Some((found.multibody, found.id, dof))
        });
        carriers.push(Carrier {
            body: *handle,
            link: place,
            axis: if link.motion == Motion::Prismatic { 2 } else { 5 },
            damping: link.damping as f32,
            spring: [link.stiffness as f32, link.rest as f32],
            inertia: ((link.inertia[0] + link.inertia[1] + link.inertia[2]) / 3.0) as f32,
        });
    }
    carriers
}

/// The largest speeds of joints, with the numbers of their carriers.
fn speed_limits_of(robot: &Robot, mounts: &[Mount<f64>]) -> Vec<(usize, f32)> {
    let joints = robot.segments.iter().zip(mounts).filter(|(segment, _)| segment.joint.kind.is_single());
    joints.filter_map(|(segment, mount)| Some((usize::from(mount.link), segment.joint.speed_limit? as f32))).collect()
}

/// The joints that have actuators or springs, with these actuators.
fn drives_of(robot: &Robot, mounts: &[Mount<f64>]) -> (Vec<Drive>, Vec<Motor>) {
    let (mut drives, mut motors) = (Vec::new(), Vec::new());
    for (segment, mount) in mounts.iter().enumerate() {
        let first = motors.len();
        let actuators = robot.actuators.iter().enumerate().filter(|(_, a)| a.joint.index() == segment);
        motors.extend(actuators.map(|(number, actuator)| Motor {
            law: actuator.law.cast(),
            command_range: actuator.command_range.map(|range| range.map(|end| end as f32)),
            actuator: number,
        }));
        let joint = &robot.segments[segment].joint;
        if motors.len() > first || (joint.kind.is_single() && joint.stiffness > 0.0) {
            drives.push(Drive { carrier: usize::from(mount.link), first, count: motors.len() - first });
        }
    }
    (drives, motors)
}
