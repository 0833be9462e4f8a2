//! Elements that a URDF does not have. Most are notes of other programs, some would be parts of the robot.

use crate::context::Context;
use crate::error::ReadError;
use crate::xml::tree::Element;

/// Elements of other programs, and reasons why they are not read.
pub(super) const NOTED: [(&str, &str); 8] = [
    ("material", "only for show"),
    ("transmission", "joints with an effort limit have a motor each instead"),
    ("gazebo ros2_control plugin sensor force_sensor", OTHERS),
    ("contact surface collision_checking self_collision_checking self_filter verbose", OTHERS),
    ("gravity kinematic static velocity_decay", OTHERS),
    ("mujoco drake compiler", OTHERS),
    ("group group_state end_effector virtual_joint passive_joint disable_collisions", "of a semantic description"),
    ("author license version description", "a remark"),
];
const OTHERS: &str = "another simulator's";

/// Elements that make a robot, each in its own place.
const PARTS: [&str; 18] = [
    "link",
    "joint",
    "inertial",
    "mass",
    "inertia",
    "collision",
    "geometry",
    "parent",
    "child",
    "axis",
    "limit",
    "dynamics",
    "mimic",
    "box",
    "cylinder",
    "sphere",
    "capsule",
    "mesh",
];

/// Checks the elements within one. It refuses those that would make another robot and lists the others.
pub(super) fn check_children(
    within: Element<'_>,
    read: &[&str],
    ignored: &[(&str, &str)],
    context: &mut Context<'_>,
) -> Result<(), ReadError> {
    let known = |tag| read.contains(&tag) || ignored.iter().any(|(names, _)| names.split(' ').any(|name| name == tag));
    let makes = |tag: &str| PARTS.contains(&tag) || ["robot", "joint"].contains(&within.tag());
    if let Some(child) = within.children().find(|child| !known(child.tag()) && makes(child.tag())) {
        return Err(child.unknown(format!("element of {}", within.tag()), child.tag(), read.iter().copied()));
    }
    within.check_children(read, ignored, &mut context.warnings)
}

/// Refuses what xacro has not processed: its elements, and its expressions in attributes.
pub(super) fn check_processed(root: Element<'_>) -> Result<(), ReadError> {
    let mut open = vec![root];
    while let Some(element) = open.pop() {
        let why = "is not processed; `xacro FILE` writes the URDF to read";
        if element.tag().starts_with("xacro:") {
            return Err(element.unsupported(why));
        }
        // Elements of other programs may contain any text.
        if NOTED.iter().any(|(names, _)| names.split(' ').any(|name| name == element.tag())) {
            continue;
        }
        let expression = element.attributes().iter().find(|(_, value)| value.contains("${") || value.contains("$("));
        if let Some((name, value)) = expression {
            return Err(element.unsupported(format!("{name} {value:?} {why}")));
        }
        // The top of the stack is the next element, so children are pushed in reverse.
        let children: Vec<_> = element.children().collect();
        open.extend(children.into_iter().rev());
    }
    Ok(())
}
