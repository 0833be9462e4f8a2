//! The channels recorded for a walker, and its shapes in drawings.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Collider, Robot, Shape, Surface};

use farsa_num::sin_cos;
use farsa_view::{Channel, Schema};

use crate::walking::walker::{Walker, WalkerParts};

/// Half the thickness of drawn legs, axle and soles \[m\].
const THICK: f64 = 0.012;
/// Reach of a drawn sole from the leg's end to each side, about its center \[rad\], and its number of straight pieces.
const SOLE: f64 = 0.5;
const PIECES: usize = 6;

/// The axle and the legs of a walker, two of each pair, without contacts and plates. `sole` makes the foot of a leg.
///
/// Bodies have the numbers of [`Walker::robot`]. Its plates come after them.
fn figure(walker: &Walker, mut sole: impl FnMut(&mut Robot, BodyId, &str, [f64; 3], f64)) -> Robot {
    let (mut robot, parts) = walker.robot();
    let WalkerParts { hip, legs, plates, .. } = parts;
    robot.segments.truncate(plates[0].index().min(plates[1].index()));
    (robot.colliders, robot.pairs) = (Vec::new(), Vec::new());
    let half = 0.5 * walker.hip_spacing;
    let ends = [[0.0, half, 0.0], [0.0, -half, 0.0]];
    robot.add_collider(Collider::new("ground", None, Shape::Plane, Pose::identity()));
    robot.add_collider(Collider::capsule_between("axle", Some(hip), ends[0], ends[1], THICK));
    for ((body, legs), (pair, out)) in legs.into_iter().zip(&walker.legs).zip([("outer", half), ("inner", 0.5 * half)])
    {
        for (side, y) in [("left", out), ("right", -out)] {
            let (from, to) = ([0.0, y, 0.0], [0.0, y, THICK - legs.length]);
            let name = format!("{side} {pair}");
            robot.add_collider(Collider::capsule_between(&format!("{name} leg"), Some(body), from, to, THICK));
            sole(&mut robot, body, &name, [0.0, y, legs.foot_radius - legs.length], legs.foot_radius);
        }
    }
    robot
}

/// The walker as it is drawn: its soles are strips as wide as they are used.
pub(crate) fn drawn(walker: &Walker) -> Robot {
    figure(walker, |robot, body, name, centre, radius| {
        let arm = (radius - THICK).max(0.0);
        let at = |piece: usize| {
            let (sine, cosine) = sin_cos(SOLE * (2.0 * piece as f64 / PIECES as f64 - 1.0));
            [arm * sine, centre[1], centre[2] - arm * cosine]
        };
        for piece in 0..PIECES {
            let (name, ends) = (format!("{name} sole {}", piece + 1), [at(piece), at(piece + 1)]);
            robot.add_collider(Collider::capsule_between(&name, Some(body), ends[0], ends[1], THICK));
        }
    })
}

/// The walker as other simulators may have it: each sole a ball with half of the pair's surface, one ground for all and
/// no plates, so that its feet scuff.
pub(crate) fn exported(walker: &Walker) -> Robot {
    let surface = walker.robot().0.pairs.first().map(|pair| pair.surface);
    figure(walker, |robot, body, name, centre, radius| {
        let ball = Shape::Sphere { radius };
        let sole = robot.add_collider(Collider::new(&format!("{name} sole"), Some(body), ball, Pose::at(centre)));
        if let Some(Surface { friction, rolling_friction, stiffness, damping }) = surface {
            let (stiffness, damping) = (0.5 * stiffness, 0.5 * damping);
            // The ground is the first collider.
            robot.add_pair([sole, 0], Surface { friction, rolling_friction, stiffness, damping });
        }
    })
}

/// The schema of a walker as it is drawn or exported. Its scalars are those of
/// [`WalkerEpisode`](crate::walking::episode::WalkerEpisode).
pub(crate) fn schema(robot: &Robot) -> Schema {
    let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
    let places = ["hip.x [m]", "hip.z [m]"].map(in_group("place"));
    let joints = ["outer legs [rad]", "inner legs [rad]", "outer legs [rad/s]", "inner legs [rad/s]"];
    let stance = Channel::new("stance").group("phase").words(&["outer", "inner"]);
    let walked = ["steps", "distance [m]", "energy gained [J]", "work of the motor [J]"].map(in_group("fitness"));
    let scalars = places.into_iter().chain(joints.map(in_group("joint"))).chain([stance]).chain(walked);
    Schema { scalars: scalars.collect(), ..Schema::from_robot(robot) }
}
