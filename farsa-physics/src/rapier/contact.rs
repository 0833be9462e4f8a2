//! rapier's contacts as the port reports them.

use farsa_body::ports::PairContact;
use rapier3d::dynamics::{FrictionModel, RigidBodyHandle};
use rapier3d::geometry::{ColliderHandle, Contact, ContactManifold};
use rapier3d::math::Vector;
use rapier3d::pipeline::PhysicsWorld;

use crate::rapier::model::{RobotPlan, Touching};

/// The flag in a contact's number that marks a new contact.
const NEW: u32 = 1 << 31;

/// The manifolds of a pair, and whether its first collider is rapier's second.
fn manifolds(physics: &PhysicsWorld, [a, b]: [ColliderHandle; 2]) -> Option<(&[ContactManifold], bool)> {
    let pair = physics.narrow_phase.contact_pair(a, b)?;
    Some((pair.solver_manifolds(), pair.collider1 != a))
}

/// The points of a manifold that the solver has seen.
fn points(manifold: &ContactManifold) -> impl Iterator<Item = &Contact> {
    manifold.data.solver_contacts.iter().filter_map(|c| manifold.points.get((c.contact_id[0] & !NEW) as usize))
}

/// Returns whether a point of a pair carries a normal force.
pub(crate) fn touches(physics: &PhysicsWorld, pair: &Touching) -> bool {
    let Some((manifolds, _)) = manifolds(physics, pair.colliders) else { return false };
    manifolds.iter().any(|manifold| points(manifold).any(|point| point.data.impulse > 0.0))
}

/// The sum of the normal forces of a pair's points in the last step [N].
fn normal_force(physics: &PhysicsWorld, pair: &Touching) -> f32 {
    let Some((manifolds, _)) = manifolds(physics, pair.colliders) else { return 0.0 };
    let impulse: f32 = manifolds.iter().flat_map(points).map(|point| point.data.impulse).sum();
    impulse / physics.integration_parameters.dt
}

/// The friction impulse of a whole step at a point of a multibody, on rapier's first body.
///
/// rapier keeps it along two directions that it does not expose. Its memory for the next start are the same two numbers
/// of the last iteration and their vector in the world: from these follow the directions.
fn friction_at(point: &Contact, normal: Vector) -> Vector {
    let data = &point.data;
    let (last, world) = (data.warmstart_tangent_impulse, data.warmstart_tangent_world);
    // With t1 and t2 = t1 x n the two directions, `world` is a t1 + b t2 and `across` is a t2 - b t1. In the solution
    // for t1 and t2, the determinant is a^2 + b^2.
    let across = -normal.cross(world);
    let square = last.x * last.x + last.y * last.y;
    if square > 0.0 {
        let first = (world * last.x - across * last.y) / square;
        let second = (world * last.y + across * last.x) / square;
        first * data.tangent_impulse.x + second * data.tangent_impulse.y
    } else {
        Vector::ZERO
    }
}

/// The friction impulse of a whole step at all points of a manifold, on rapier's first body.
///
/// Between bodies that are no links rapier has one friction for all points, of which it keeps that of the last iteration
/// with each of them.
fn friction(manifold: &ContactManifold, at_points: bool, iterations: usize) -> Vector {
    if at_points {
        return points(manifold).map(|point| friction_at(point, manifold.data.normal)).sum();
    }
    points(manifold).next().map_or(Vector::ZERO, |point| point.data.warmstart_tangent_world * iterations as f32)
}

/// Returns the contact of a pair in the last step of rapier. Its depth is that of the bodies' present places.
pub(crate) fn pair_contact(physics: &PhysicsWorld, pair: &Touching) -> PairContact {
    let mut contact = PairContact { depth: f32::NEG_INFINITY, ..PairContact::default() };
    let Some((manifolds, flipped)) = manifolds(physics, pair.colliders) else { return contact };
    let [first, second] = if flipped { [pair.colliders[1], pair.colliders[0]] } else { pair.colliders };
    // From here on rapier's order of the two, whose normal leads from its first to its second.
    let (first, second) = (physics.colliders[first].position(), physics.colliders[second].position());
    let per_second = 1.0 / physics.integration_parameters.dt;
    let parameters = &physics.integration_parameters;
    let at_points = pair.of_links || parameters.friction_model == FrictionModel::Coulomb;
    let (mut force, mut moment) = (Vector::ZERO, Vector::ZERO);
    for manifold in manifolds {
        let normal = manifold.data.normal;
        force += friction(manifold, at_points, parameters.num_solver_iterations) * per_second;
        let first = manifold.subshape_pos1().map_or(*first, |local| *first * *local);
        let second = manifold.subshape_pos2().map_or(*second, |local| *second * *local);
        for point in points(manifold) {
            let (p1, p2) = (first.transform_point(point.local_p1), second.transform_point(point.local_p2));
            contact.depth = contact.depth.max((p1 - p2).dot(normal));
            if point.data.impulse > 0.0 {
                let normal_force = point.data.impulse * per_second;
                contact.points += 1;
                contact.normal_force += normal_force;
                force -= normal * normal_force;
                // The point is the mean of the contacts' middles, weighted by their normal forces.
                moment += (p1 + p2) * (0.5 * normal_force);
            }
        }
    }
    if contact.points > 0 {
        contact.force = (if flipped { -force } else { force }).into();
        contact.point = (moment / contact.normal_force).into();
    }
    contact
}

/// Applies the torques of rolling and spinning resistance, which rapier does not have, to the bodies of the pairs that
/// have any.
///
/// The torque is the surface's rolling friction times the normal force of the previous step, against the relative
/// rotation. It is at most the torque that stops a free body's rotation within the step. A link of a multibody counts
/// as immovable there.
pub(crate) fn roll(physics: &mut PhysicsWorld, plan: &RobotPlan) {
    for pair in plan.pairs.iter().filter(|pair| pair.rolling_friction > 0.0) {
        for carrier in pair.carriers.iter().flatten() {
            reset(physics, plan.carriers[*carrier].body);
        }
    }
    let per_second = 1.0 / physics.integration_parameters.dt;
    for pair in plan.pairs.iter().filter(|pair| pair.rolling_friction > 0.0) {
        let force = normal_force(physics, pair);
        let carriers = pair.carriers.map(|carrier| carrier.map(|c| &plan.carriers[c]));
        let free = |c: &crate::rapier::model::Carrier| if c.link.is_none() { 1.0 / c.inertia } else { 0.0 };
        let inverse: f32 = carriers.iter().flatten().map(|c| free(c)).sum();
        if force <= 0.0 || inverse <= 0.0 {
            continue;
        }
        let rotation = carriers.map(|c| c.map_or(Vector::ZERO, |c| physics.bodies[c.body].angvel()));
        let relative = rotation[0] - rotation[1];
        let speed = relative.length();
        if speed > 0.0 {
            // With dw the relative rotation and 1/I the sum of both inverse inertias, I dw / h is what stops it in one
            // step.
            let torque = (pair.rolling_friction * force).min(speed / inverse * per_second);
            let torque = relative * (-torque / speed);
            for (carrier, sign) in carriers.iter().zip([1.0, -1.0]) {
                if let Some(body) = carrier.and_then(|c| physics.bodies.get_mut(c.body)) {
                    body.add_torque(torque * sign, false);
                }
            }
        }
    }
}

fn reset(physics: &mut PhysicsWorld, body: RigidBodyHandle) {
    if let Some(body) = physics.bodies.get_mut(body) {
        body.reset_torques(false);
    }
}
