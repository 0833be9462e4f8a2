//! Named states of a model.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, Robot};

use crate::context::Context;
use crate::error::ReadError;
use crate::xml::tree::Element;

/// A named state at rest.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Keyframe {
    /// Name of the state.
    pub name: String,
    /// Position of each joint [rad or m], in the order of [`Robot::joints`]. Missing positions are 0.
    pub joints: Vec<f64>,
    /// Pose of each floating segment. All other segments follow from the positions of the joints.
    pub bodies: Vec<(BodyId, Pose<f64>)>,
}

impl Keyframe {
    /// The configuration of a file, in which joints are at their `ref`.
    pub(crate) fn of_file(robot: &Robot, references: &[(BodyId, f64)]) -> Self {
        let reference = |joint: BodyId| references.iter().find(|(known, _)| *known == joint).map_or(0.0, |(_, q)| *q);
        let joints = robot.joints().map(|joint| reference(BodyId(joint.0))).collect();
        let floating = robot.segments.iter().enumerate().filter(|(_, one)| one.joint.kind == JointKind::Floating);
        let bodies = floating.map(|(number, one)| (BodyId(number as u16), one.joint.placement)).collect();
        Self { name: String::new(), joints, bodies }
    }
}

/// Reads the keyframes of a model, after the configuration of the file.
///
/// The numbers of `qpos` are in the order of the joints, a position each or the place and quaternion of a free body.
pub(crate) fn keyframes(
    model: Element<'_>,
    robot: &Robot,
    references: &[(BodyId, f64)],
    context: &mut Context<'_>,
) -> Result<Vec<Keyframe>, ReadError> {
    let of_file = Keyframe::of_file(robot, references);
    let mut keyframes = vec![of_file.clone()];
    let ignored = [("qvel", "a keyframe is at rest"), ("time act ctrl mpos mquat", "a keyframe has positions only")];
    for key in model.all("keyframe").flat_map(|section| section.all("key")) {
        key.check(&["name", "qpos"], &ignored, &mut context.warnings)?;
        let name = key.attribute("name").filter(|name| !name.is_empty()).map(str::to_owned);
        let name = name.unwrap_or_else(|| format!("key{}", keyframes.len() - 1));
        let mut keyframe = Keyframe { name, ..of_file.clone() };
        if let Some(text) = key.attribute("qpos") {
            let wanted = of_file.joints.len() + 7 * of_file.bodies.len();
            let list = key.list("qpos", wanted, wanted)?.unwrap_or_default();
            let mut numbers = list.iter().copied();
            let (mut joints, mut bodies) = (keyframe.joints.iter_mut(), keyframe.bodies.iter_mut());
            for segment in &robot.segments {
                let mut next = || numbers.next().unwrap_or(0.0);
                match segment.joint.kind {
                    JointKind::Revolute | JointKind::Prismatic => {
                        if let Some(joint) = joints.next() {
                            *joint = next();
                        }
                    }
                    JointKind::Floating => {
                        let [x, y, z, w, i, j, k] = [(); 7].map(|()| next());
                        let length = farsa_num::Scalar::sqrt(w * w + i * i + j * j + k * k);
                        if !(length > 1e-6 && length.is_finite()) {
                            return Err(key.wrong("qpos", text, "but must have quaternions that are not 0"));
                        }
                        if let Some((_, pose)) = bodies.next() {
                            *pose = Pose { position: [x, y, z], rotation: [i, j, k, w].map(|part| part / length) };
                        }
                    }
                    JointKind::Fixed => {}
                }
            }
            if list.iter().any(|number| !number.is_finite()) {
                return Err(key.wrong("qpos", text, "but must be finite"));
            }
        }
        keyframes.push(keyframe);
    }
    Ok(keyframes)
}
