//! The colliders of the iCub, and the pairs that may touch.

use alloc::format;
use alloc::vec::Vec;

use crate::ports::BodyId;
use crate::robot::description::{Collider, Robot, Surface};
use crate::robot::joint::JointKind;
use crate::robots::hand::Hand;
use crate::robots::icub::chain::Side;
use crate::robots::mirror;

/// Indices of the colliders of waist, chest and head.
pub(super) const TRUNK: [usize; 3] = [0, 1, 2];

/// Indices of the colliders of upper arm, forearm and palm.
pub(super) fn arm(side: Side) -> [usize; 3] {
    [0, 1, 2].map(|i| 3 + 3 * side as usize + i)
}

/// Index of the collider of the thumb's proximal phalange. The fifteen phalanges follow each other.
pub(super) fn first_phalange(side: Side) -> usize {
    9 + 15 * side as usize
}

/// The colliders of waist, chest and head: capsules from left to right and, of the head, from back to front.
pub(super) fn trunk() -> [Collider; 3] {
    let capsule = |name, body, a, b, radius| Collider::capsule_between(name, Some(BodyId(body)), a, b, radius);
    [
        capsule("waist", 0, [-0.027, -0.045, -0.03], [-0.027, 0.045, -0.03], 0.065),
        capsule("chest", 2, [-0.018, -0.015, 0.107], [-0.018, 0.015, 0.107], 0.080),
        capsule("head", 5, [-0.035, 0.0, 0.121], [-0.006, 0.0, 0.121], 0.091),
    ]
}

/// The capsules of a side's upper arm and forearm.
pub(super) fn limbs(side: Side) -> [Collider; 2] {
    let first = side.arm().bodies().start;
    let capsule = |name: &str, body: usize, a: [f64; 3], b: [f64; 3], radius| {
        let [a, b] = [a, b].map(|p| if side == Side::Left { mirror::point(p) } else { p });
        let name = format!("{}{name}", side.prefix());
        Collider::capsule_between(&name, Some(BodyId((first + body) as u16)), a, b, radius)
    };
    [
        capsule("upper_arm", 2, [-0.008, 0.0, -0.037], [-0.002, 0.0, -0.123], 0.037),
        capsule("forearm", 4, [-0.005, 0.0, -0.033], [-0.005, 0.0, -0.107], 0.0325),
    ]
}

/// The pairs of limbs: of each arm with the trunk, of the arms with each other.
fn limb_pairs() -> Vec<[usize; 2]> {
    let mut pairs = Vec::new();
    for side in Side::ALL {
        let [upper_arm, forearm, palm] = arm(side);
        pairs.push([upper_arm, TRUNK[2]]);
        for part in [forearm, palm] {
            pairs.extend(TRUNK.map(|trunk| [part, trunk]));
        }
    }
    let [left, right] = Side::ALL.map(arm);
    for a in left {
        for b in right {
            // The upper arms cannot reach each other past the chest.
            if [a, b] != [left[0], right[0]] {
                pairs.push([a, b]);
            }
        }
    }
    pairs
}

/// Returns the pairs of fingers with parts outside of hand and arm, a list for each. Each hand is paired with waist,
/// chest and head, with the other upper arm, forearm and palm, and with the other hand's fingers.
fn finger_pairs() -> Vec<Vec<[usize; 2]>> {
    let phalanges = |side| first_phalange(side)..first_phalange(side) + 15;
    let [left, right] = Side::ALL.map(phalanges);
    let [left_arm, right_arm] = Side::ALL.map(arm);
    let with = |fingers: core::ops::Range<usize>, parts: [usize; 3]| {
        TRUNK.into_iter().chain(parts).map(move |part| fingers.clone().map(|finger| [finger, part]).collect())
    };
    let pairs = left.clone().flat_map(|a| right.clone().map(move |b| [a, b])).collect();
    with(left, right_arm).chain(with(right, left_arm)).chain([pairs]).collect()
}

/// The segment with which a body moves rigidly: itself, or the next one inwards whose joint moves, none for the world.
pub(super) fn carrier(robot: &Robot, collider: usize) -> Option<BodyId> {
    let mut body = robot.colliders.get(collider)?.body;
    while let Some(segment) = body.and_then(|b| robot.segments.get(b.index())) {
        if segment.joint.kind != JointKind::Fixed {
            break;
        }
        body = segment.parent;
    }
    body
}

/// Appends the pairs whose colliders can move relative to each other.
pub(super) fn add_pairs(robot: &mut Robot, hand: &Hand, skin: Surface) {
    let moves = |robot: &Robot, [a, b]: [usize; 2]| carrier(robot, a) != carrier(robot, b);
    for pair in limb_pairs() {
        // Alone in a group: while they are far, no point of theirs is written, of which two palms have 28.
        if moves(robot, pair) {
            robot.add_pair_group([pair], skin);
        }
    }
    for pair in Side::ALL.into_iter().flat_map(|side| Hand::pairs(arm(side)[2], first_phalange(side))) {
        if moves(robot, pair) {
            robot.add_pair(pair, hand.surface);
        }
    }
    for mut pairs in finger_pairs() {
        pairs.retain(|pair| moves(robot, *pair));
        robot.add_pair_group(pairs, skin);
    }
}
