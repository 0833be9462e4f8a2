//! The appearance of the iCub in views. It does not affect the simulation.

use alloc::vec::Vec;

use crate::ports::BodyId;
use crate::pose::Pose;
use crate::robot::description::{Collider, Robot};
use crate::robot::shape::Shape;
use crate::robot::visual::Visual;
use crate::robots::icub::chain::{Chain, Side};
use crate::robots::mirror;

const WHITE: [f64; 3] = [0.92, 0.92, 0.93];
const GREY: [f64; 3] = [0.45, 0.47, 0.50];
const DARK: [f64; 3] = [0.12, 0.12, 0.14];
const RED: [f64; 3] = [0.75, 0.15, 0.12];

/// Shapes of one body, in its frame.
struct Parts(BodyId, Vec<Visual>);

impl Parts {
    fn ball(mut self, at: [f64; 3], radius: f64, color: [f64; 3]) -> Self {
        self.1.push(Visual::new(Some(self.0), Shape::Sphere { radius }, Pose::at(at)).with_color(color));
        self
    }

    fn capsule(mut self, a: [f64; 3], b: [f64; 3], radius: f64, color: [f64; 3]) -> Self {
        let capsule = Collider::capsule_between("", Some(self.0), a, b, radius);
        self.1.push(Visual::from(&capsule.with_color(color)));
        self
    }

    fn block(mut self, at: [f64; 3], size: [f64; 3], color: [f64; 3]) -> Self {
        let half = size.map(|x| 0.5 * x);
        self.1.push(Visual::new(Some(self.0), Shape::Box { half }, Pose::at(at)).with_color(color));
        self
    }

    /// Returns the shapes, or with `left` their mirror images on the left side's body.
    fn on_side(mut self, left: bool) -> Self {
        if left {
            self.1.iter_mut().for_each(|visual| visual.placement = mirror::pose(visual.placement));
        }
        self
    }
}

/// Hips, the joints of the trunk, the chest.
fn trunk() -> [Parts; 3] {
    let [hips, middle, chest] = [0, 1, 2].map(|body| Parts(BodyId(body), Vec::new()));
    [
        hips.capsule([-0.02, -0.045, -0.03], [-0.02, 0.045, -0.03], 0.055, GREY).block(
            [-0.02, 0.0, -0.075],
            [0.09, 0.12, 0.05],
            DARK,
        ),
        middle.ball([0.0, 0.0, 0.0], 0.045, DARK),
        chest
            .capsule([-0.015, -0.035, 0.075], [-0.015, 0.035, 0.075], 0.055, WHITE)
            .capsule([-0.018, -0.05, 0.135], [-0.018, 0.05, 0.135], 0.052, WHITE)
            .block([0.034, 0.0, 0.118], [0.012, 0.06, 0.045], RED)
            .capsule([0.0, 0.0, 0.15], [0.0, 0.0, 0.21], 0.022, DARK),
    ]
}

/// Skull, face, eyes, ears.
fn head(eyes: [[f64; 3]; 2]) -> Parts {
    let mut head = Parts(BodyId(Chain::Neck.bodies().end as u16 - 1), Vec::new())
        .capsule([-0.035, 0.0, 0.125], [-0.012, 0.0, 0.125], 0.083, WHITE)
        .capsule([0.028, -0.026, 0.082], [0.028, 0.026, 0.082], 0.040, WHITE)
        .capsule([0.0, 0.0, 0.0], [0.0, 0.0, 0.06], 0.024, DARK)
        .capsule([0.053, -0.014, 0.052], [0.053, 0.014, 0.052], 0.003, RED);
    for (eye, side) in eyes.into_iter().zip([1.0, -1.0]) {
        let ahead = |by: f64| [eye[0] + by, eye[1], eye[2]];
        head = head
            .ball(ahead(0.0), 0.020, [0.98, 0.98, 0.98])
            .ball(ahead(0.0145), 0.0085, [0.25, 0.15, 0.1])
            .ball(ahead(0.0195), 0.0045, DARK)
            .capsule([0.067, side * 0.02, 0.112], [0.055, side * 0.048, 0.106], 0.003, RED)
            .capsule([-0.025, side * 0.078, 0.1], [-0.025, side * 0.088, 0.1], 0.022, GREY);
    }
    head
}

/// Covers of a side's shoulder, upper arm, elbow, forearm and wrist. The right one's are given.
fn arm(side: Side) -> Vec<Parts> {
    let first = side.arm().bodies().start;
    let part = |body: usize| Parts(BodyId((first + body) as u16), Vec::new());
    let parts = [
        part(0).ball([0.0, 0.0, 0.0], 0.040, DARK),
        part(1).ball([0.0, 0.0, 0.0], 0.036, GREY),
        part(2).capsule([-0.004, 0.0, -0.03], [-0.002, 0.0, -0.105], 0.034, WHITE).ball(
            [-0.004, 0.0, -0.135],
            0.028,
            GREY,
        ),
        part(4).capsule([-0.005, 0.0, -0.03], [-0.005, 0.0, -0.085], 0.031, WHITE).capsule(
            [-0.005, 0.0, -0.1],
            [-0.005, 0.0, -0.118],
            0.024,
            DARK,
        ),
        part(6).capsule([0.0; 3], [0.022, 0.0, 0.0], 0.016, DARK),
    ];
    parts.into_iter().map(|part| part.on_side(side == Side::Left)).collect()
}

/// Palms and fingers are drawn as their colliders, in colors: fingertips are dark.
fn hands(robot: &Robot) -> Vec<Visual> {
    let of_hand = |collider: &&Collider| {
        let segment = collider.body.map_or(0, BodyId::index);
        Side::ALL
            .into_iter()
            .any(|side| segment + 1 == side.arm().bodies().end || side.hand().bodies().contains(&segment))
    };
    let colored = |collider: &Collider| {
        let tip = collider.name.ends_with("_distal");
        Visual::from(collider).with_color(if tip { DARK } else { WHITE })
    };
    robot.colliders.iter().filter(of_hand).map(colored).collect()
}

/// Dresses a robot that has its segments and colliders, with eyes at these places of its head [m].
pub(super) fn dress(robot: &mut Robot, eyes: [[f64; 3]; 2]) {
    let parts = trunk().into_iter().chain([head(eyes)]).chain(Side::ALL.into_iter().flat_map(arm));
    let visuals: Vec<Visual> = parts.flat_map(|Parts(_, visuals)| visuals).collect();
    robot.visuals.extend(visuals);
    robot.visuals.extend(hands(robot));
}
