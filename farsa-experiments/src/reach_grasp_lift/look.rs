//! Trunk, shoulder, elbow and wrist of the arm in pictures and pages. They touch nothing.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::Collider;
use farsa_body::robots::ArmAndHand;
use farsa_view::shape::{Color, Geometry, Role, SceneObject};

/// Color of the trunk.
const TRUNK: Color = [104, 117, 133];
const UPPER_ARM: BodyId = BodyId(2);
const FOREARM: BodyId = BodyId(4);

/// Builds the parts drawn in addition to the colliders.
pub(crate) fn parts(arm: &ArmAndHand) -> Vec<SceneObject> {
    let [x, y, z] = arm.shoulder;
    let (thick, thin) = (arm.upper_arm_radius, arm.forearm_radius);
    // The trunk is left of the right arm.
    let middle = y + 5.0 * thick;
    let shoulders = capsule("shoulders", None, [[x, y, z], [x, middle, z]], thick);
    let trunk = capsule("trunk", None, [[x, middle, z - 8.0 * thick], [x, middle, z + thick]], 1.8 * thick);
    let palm = [arm.palm_box[0] - 0.5 * arm.palm_half[0], 0.0, 0.0];
    vec![
        shoulders.with_color(TRUNK),
        trunk.with_color(TRUNK),
        ball("shoulder", UPPER_ARM, 1.3 * thick),
        ball("elbow", FOREARM, 1.1 * thick),
        ball("wrist", ArmAndHand::PALM, 1.1 * thin),
        capsule("heel of the hand", Some(ArmAndHand::PALM), [[0.0; 3], palm], 0.8 * thin),
    ]
}

fn ball(name: &str, body: BodyId, radius: f64) -> SceneObject {
    SceneObject::new(name, Geometry::Sphere { radius }, Pose::identity(), Role::Robot).on_body(body)
}

/// A capsule between two points of a body, or of the world.
fn capsule(name: &str, body: Option<BodyId>, [from, to]: [[f64; 3]; 2], radius: f64) -> SceneObject {
    let Collider { shape, placement, .. } = Collider::capsule_between(name, body, from, to, radius);
    SceneObject { body, ..SceneObject::new(name, shape.into(), placement, Role::Robot) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wrist_closes_the_gap_between_forearm_and_palm() {
        let arm = ArmAndHand::default();
        let parts = parts(&arm);
        let named = |name: &str| parts.iter().find(|part| part.name == name).unwrap();
        let (wrist, heel) = (named("wrist"), named("heel of the hand"));
        assert_eq!([wrist.body, heel.body], [Some(ArmAndHand::PALM); 2]);
        // The forearm's axis is 137 mm long and its capsule 130 mm and a cap, the palm begins 20 mm behind the wrist.
        let Geometry::Sphere { radius } = wrist.geometry else { panic!("{wrist:?}") };
        assert!(radius > arm.forearm_length - arm.forearm_axis);
        let Geometry::Capsule { half_length, .. } = heel.geometry else { panic!("{heel:?}") };
        assert!(2.0 * half_length > arm.palm_box[0] - arm.palm_half[0]);
        // The shoulder is where the upper arm turns.
        assert_eq!((named("shoulder").body, named("shoulder").placement), (Some(UPPER_ARM), Pose::identity()));
        let robot = arm.robot().unwrap();
        assert_eq!(
            [UPPER_ARM, FOREARM].map(|body| robot.segments[body.index()].name.as_str()),
            ["upper_arm", "forearm"]
        );
    }
}
