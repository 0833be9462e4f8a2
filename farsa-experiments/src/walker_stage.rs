//! What is to be seen and told of a walker.

use farsa_body::{BodyId, Collider, Kinematics, Pose, Recorder, Robot, Shape, Surface};

use crate::stage::{Channel, Stage};
use crate::walker::{Walker, WalkerParts};
use crate::walker_life::WalkerLife;

/// Half the thickness of drawn legs and axle \[m\].
const THICK: f64 = 0.012;

/// The walker as it is drawn and exported: two legs of each pair, each sole with half of the pair's surface, one ground
/// for all and no plates.
///
/// Bodies have the numbers that they have in [`Walker::robot`]; its plates come after them.
pub(crate) fn seen(walker: &Walker) -> Robot {
    let (mut robot, parts) = walker.robot();
    let WalkerParts { hip, legs, plates, .. } = parts;
    robot.segments.truncate(plates[0].index().min(plates[1].index()));
    let surface = robot.pairs.first().map(|pair| pair.surface);
    (robot.colliders, robot.pairs) = (Vec::new(), Vec::new());
    let half = 0.5 * walker.hip_spacing;
    let ends = [[0.0, half, 0.0], [0.0, -half, 0.0]];
    robot.add_collider(Collider::capsule_between("axle", Some(hip), ends[0], ends[1], THICK));
    let ground = robot.add_collider(Collider::new("ground", None, Shape::Plane, Pose::identity()));
    for ((body, legs), (name, out)) in legs.into_iter().zip(&walker.legs).zip([("outer", half), ("inner", 0.5 * half)])
    {
        for (side, y) in [("left", out), ("right", -out)] {
            let centre = [0.0, y, legs.foot_radius - legs.length];
            let leg =
                Collider::capsule_between(&format!("{side} {name} leg"), Some(body), [0.0, y, 0.0], centre, THICK);
            robot.add_collider(leg);
            let sole = Shape::Sphere { radius: legs.foot_radius };
            let sole = Collider::new(&format!("{side} {name} sole"), Some(body), sole, Pose::at(centre));
            let sole = robot.add_collider(sole);
            if let Some(Surface { friction, rolling_friction, stiffness, damping }) = surface {
                let (stiffness, damping) = (0.5 * stiffness, 0.5 * damping);
                robot.add_pair([sole, ground], Surface { friction, rolling_friction, stiffness, damping });
            }
        }
    }
    robot
}

/// The bodies that are told.
fn bodies(parts: &WalkerParts) -> [BodyId; 3] {
    [parts.hip, parts.legs[0], parts.legs[1]]
}

/// The stage of a walker; its scalars are what [`tell`] tells.
pub(crate) fn stage(walker: &Walker) -> Stage {
    let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
    let places = ["hip.x [m]", "hip.z [m]"].map(in_group("place"));
    let joints = ["outer legs [rad]", "inner legs [rad]", "outer legs [rad/s]", "inner legs [rad/s]"];
    let stance = Channel::new("stance").group("phase").words(&["outer", "inner"]);
    let walked = ["steps", "distance [m]", "energy gained [J]", "work of the motor [J]"].map(in_group("fitness"));
    let scalars = places.into_iter().chain(joints.map(in_group("joint"))).chain([stance]).chain(walked);
    Stage { scalars: scalars.collect(), ..Stage::of_robot(&seen(walker)) }
}

/// Tells a tick of a life that has been judged.
pub(crate) fn tell<W>(life: &WalkerLife, world: &W, recorder: &mut dyn Recorder)
where
    W: Kinematics<Body = BodyId> + ?Sized,
{
    let gait = life.gait();
    bodies(gait.parts()).into_iter().for_each(|body| recorder.pose(body, world.pose(body)));
    if let Some(brain) = life.brain() {
        recorder.sensors(brain.sensed());
        recorder.neurons(brain.hidden());
        recorder.outputs(brain.done());
    }
    let posture = gait.posture();
    let [work, gained] = gait.energies();
    let [[x, z], [outer, inner], [u, v]] = [posture.hip, posture.angles, posture.rates];
    let stance = gait.stance() as f64;
    recorder.scalars(&[x, z, outer, inner, u, v, stance, f64::from(gait.steps()), gait.distance(), gained, work]);
    // Rounded to the nanosecond: 201 steps of 0.01 s print as 2.01.
    recorder.tick((f64::from(gait.ticks()) * life.walk().time_step * 1e9).round() / 1e9);
}
