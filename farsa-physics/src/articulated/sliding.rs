//! Links that only slide: no joint between them and the world turns.
//!
//! Their rotations are constants, they have no angular velocity, and only forces act on their joints. Spatial vectors
//! reduce to the linear half, and inertias to the linear block. That half is computed as for other links, so that a
//! motion has the same bits either way, except for the signs of zeros. The angular half, which such joints multiply by
//! zero, is left out. A disc that slides in the plane consists of two such links.

use farsa_num::{Real, Scalar};

use crate::articulated::link::{Link, LinkData, Motion, Sliding, WORLD};
use crate::articulated::spatial::{
    Inertia, Matrix, Spatial, Vector, add, dot, product, rotate, scale, splat, splat_matrix, symmetric,
};

impl<R: Real> Sliding<R> {
    /// For a link, given the links before it, or `None` if it may turn.
    pub(crate) fn of(link: &Link<R>, before: &[Link<R>]) -> Option<Self> {
        if link.motion != Motion::Prismatic {
            return None;
        }
        let (rotation, offset) = if link.parent == WORLD {
            (link.rotation, link.offset)
        } else {
            let parent = before.get(usize::from(link.parent))?.sliding?;
            (product(&parent.rotation, &link.rotation), rotate(&parent.rotation, link.offset))
        };
        Some(Self { rotation, offset, arm: rotate(&rotation, link.centre) })
    }

    /// Rotation, origin and center of mass of a link at `q`, from its parent's origin.
    #[inline(always)]
    pub(crate) fn place<S: Scalar<Real = R>>(
        &self,
        simd: S::Simd,
        parent: Option<Vector<S>>,
        q: S,
    ) -> (Matrix<S>, Vector<S>, Vector<S>) {
        let rotation = splat_matrix(simd, self.rotation);
        let offset = splat::<S>(simd, self.offset);
        let origin = parent.map_or(offset, |parent| add(parent, offset));
        let position = add(origin, scale([rotation[0][2], rotation[1][2], rotation[2][2]], q));
        (rotation, position, add(position, splat::<S>(simd, self.arm)))
    }
}

/// A spatial vector of which one half is left.
#[inline(always)]
fn linear<S: Scalar>(simd: S::Simd, linear: Vector<S>) -> Spatial<S> {
    Spatial { angular: [S::splat(simd, S::Real::from_f64(0.0)); 3], linear }
}

/// Subspace, velocity and bias of a link that slides with speed `v`, from its parent's velocity.
#[inline(always)]
pub(crate) fn set_in_motion<S: Scalar>(simd: S::Simd, w: &mut LinkData<S>, parent: Vector<S>, v: S) {
    let axis = [w.rotation[0][2], w.rotation[1][2], w.rotation[2][2]];
    w.subspace = linear(simd, axis);
    w.velocity = linear(simd, add(parent, scale(axis, v)));
    w.bias = Spatial::zero(simd);
}

/// Inertia and bias force of a link that slides: its mass, and none.
#[inline(always)]
pub(crate) fn weigh<S: Scalar>(simd: S::Simd, w: &mut LinkData<S>, mass: S::Real) {
    let (mass, zero) = (S::splat(simd, mass), S::splat(simd, S::Real::from_f64(0.0)));
    w.inertia.linear = [mass, mass, mass, zero, zero, zero];
    w.force = Spatial::zero(simd);
}

/// The pass inwards of the articulated bodies for a link that slides. The part for its parent, which slides, too.
#[inline(always)]
pub(crate) fn inwards<S: Scalar>(simd: S::Simd, w: &mut LinkData<S>, tau: S, diagonal: S) -> ([S; 6], Vector<S>) {
    let axis = w.subspace.linear;
    let column = symmetric(&w.inertia.linear, axis);
    w.reciprocal = S::splat(simd, S::Real::from_f64(1.0)) / (dot(axis, column) + diagonal);
    w.effort = tau - dot(axis, w.force.linear);
    w.column = linear(simd, column);
    let inertia = Inertia::linear_minus_square(&w.inertia.linear, column, scale(column, w.reciprocal));
    (inertia, add(w.force.linear, scale(column, w.effort * w.reciprocal)))
}

/// Adds to a link that slides what a child hands it.
#[inline(always)]
pub(crate) fn take<S: Scalar>(parent: &mut LinkData<S>, inertia: &[S; 6], force: Vector<S>) {
    for k in 0..6 {
        parent.inertia.linear[k] += inertia[k];
    }
    parent.force.linear = add(parent.force.linear, force);
}

/// The pass outwards for a link that slides: the joint's acceleration, from that of its parent.
#[inline(always)]
pub(crate) fn outwards<S: Scalar>(simd: S::Simd, w: &mut LinkData<S>, parent: Vector<S>) -> S {
    let x = (w.effort - dot(w.column.linear, parent)) * w.reciprocal;
    w.acceleration = linear(simd, add(parent, scale(w.subspace.linear, x)));
    x
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use farsa_body::Pose;
    use farsa_body::ports::{Arrange as _, JointId, World as _};
    use farsa_body::robot::{Collider, Ground, Joint, MassProperties, Robot, Segment, Shape, Surface};
    use farsa_num::{Domain, Stream};

    use crate::articulated::{Model, Options, Precision, World};

    /// Builds a scene: a ball, a disc that turns on the ground, and a cart on a tilted rail with a pendulum that
    /// reaches both. A weight slides on the pendulum, and is no sliding link.
    fn scene() -> Robot {
        let mut robot = Robot::new("things that slide");
        let ball = robot.add_sliding_body("ball", Pose::at([0.0, 0.0, 0.1]), MassProperties::sphere(0.3, 0.1), false);
        let disc = MassProperties::sphere(0.5, 0.15);
        let disc = robot.add_sliding_body("disc", Pose::at([0.5, 0.0, 0.1]), disc, true);
        for (body, radius) in [(ball, 0.0), (disc, 0.1)] {
            robot.add_ground(Ground { body, friction: 0.2, load: 2.0, radius });
        }
        let tilt = 0.3_f64;
        let rail = Pose { position: [0.0, 0.4, 0.5], rotation: [0.0, tilt, 0.0, (1.0 - tilt * tilt).sqrt()] };
        let cart = Joint { damping: 0.1, ..Joint::prismatic("rail", [1.0, 0.2, 0.0], rail, [-1.0, 1.0]) };
        let mass = MassProperties { centre: [0.02, -0.05, 0.01], ..MassProperties::sphere(0.4, 0.1) };
        let cart = robot.add_segment(Segment::new("cart", None, cart, mass));
        let lift = Joint::prismatic("lift", [0.0, 0.3, 1.0], Pose::at([0.1, 0.0, 0.0]), [-0.1, 0.1]);
        let lift = robot.add_segment(Segment::new("lift", Some(cart), lift, MassProperties::sphere(0.2, 0.05)));
        let capsule = Collider::capsule_between("pendulum", None, [0.0; 3], [0.0, 0.0, -0.6], 0.04);
        let swing = Joint::revolute("swing", [0.0, 1.0, 0.3], Pose::at([0.0, -0.4, 0.0]), [-2.0, 2.0]);
        let swing = robot.add_segment(Segment::new("pendulum", Some(lift), swing, capsule.mass_properties(0.3)));
        let weight = Joint::prismatic("weight", [0.0, 0.0, 1.0], Pose::at([0.0, 0.0, -0.3]), [-0.2, 0.2]);
        robot.add_segment(Segment::new("weight", Some(swing), weight, MassProperties::sphere(0.1, 0.02)));
        let round = |name, body, radius| Collider::new(name, Some(body), Shape::Sphere { radius }, Pose::identity());
        let shapes = [round("ball", ball, 0.1), round("disc", disc, 0.15), Collider { body: Some(swing), ..capsule }];
        let [a, b, c] = shapes.map(|shape| robot.add_collider(shape));
        let surface = Surface { friction: 0.4, rolling_friction: 0.001, stiffness: 1e4, damping: 10.0 };
        for pair in [[a, b], [a, c], [b, c]] {
            robot.add_pair(pair, surface);
        }
        robot
    }

    fn moves_as_a_link_that_may_turn<R: Precision>() {
        let robot = scene();
        let model = Model::<R>::new(&robot, &Options::default()).expect("a scene in order");
        let slide: Vec<bool> = model.links.iter().map(|link| link.sliding.is_some()).collect();
        assert_eq!(slide, [true, true, true, true, false, true, true, false, false]);
        let mut plain = model.clone();
        plain.links.iter_mut().for_each(|link| link.sliding = None);
        let (mut here, mut there) = (World::new(model), World::new(plain));
        let mut stream = Stream::new(3, Domain::Start, 0, 0, 0);
        let mut touched = 0;
        for _ in 0..20 {
            for world in [&mut here, &mut there] {
                world.clear();
            }
            for joint in robot.joints() {
                let (at, speed) = (0.1 * stream.range(-1.0, 1.0), stream.range(-1.0, 1.0));
                for world in [&mut here, &mut there] {
                    world.place_joint(JointId(joint.0), at, speed);
                    world.finish_placement();
                }
            }
            for step in 0..100 {
                here.step();
                there.step();
                // The sign of a zero is all that may differ.
                assert!(here.is_finite());
                for (i, (a, b)) in here.state().iter().zip(there.state()).enumerate() {
                    assert!(a == b, "step {step}: word {i} is {} and {}", a.to_f64(), b.to_f64());
                }
                touched += here.near_pairs();
            }
        }
        assert!(touched > 200, "{touched}");
    }

    #[test]
    fn a_sliding_link_moves_as_a_link_that_may_turn() {
        moves_as_a_link_that_may_turn::<f32>();
        moves_as_a_link_that_may_turn::<f64>();
    }
}
