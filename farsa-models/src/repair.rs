//! Masses of segments that were read: what moves needs one, and only some inertias can be.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, MassProperties, Robot};

use crate::error::{ReadError, SourceLocation};
use crate::mesh::principal_axes::principal_axes;
use crate::options::Repair;
use crate::warnings::Warnings;

pub(crate) const CHANGED: &str = "changed to what a body can have, as asked for";

/// Gives each moving segment a mass, if the links fixed to it have one or the caller chose one. Refuses masses that no
/// body can have.
///
/// `locations` are the places of the segments in their files.
pub(crate) fn repair_masses(
    robot: &mut Robot,
    locations: &[SourceLocation],
    repair: &Repair,
    warnings: &mut Warnings,
) -> Result<(), ReadError> {
    move_fixed_masses(robot, locations, warnings);
    check_masses(robot, locations, repair, warnings)
}

/// Repairs masses as asked for, and refuses those that no body can have.
pub(crate) fn check_masses(
    robot: &mut Robot,
    locations: &[SourceLocation],
    repair: &Repair,
    warnings: &mut Warnings,
) -> Result<(), ReadError> {
    for (segment, place) in robot.segments.iter_mut().zip(locations) {
        let moves = segment.joint.kind != JointKind::Fixed;
        let mut body = segment.mass_properties();
        if let Some(changed) = repaired(&body, moves, repair) {
            body = changed;
            MassProperties { mass: segment.mass, centre: segment.centre, inertia: segment.inertia } = body;
            warnings.add(place.clone(), "mass or inertia", CHANGED);
        }
        if !body.is_physical(moves) {
            let MassProperties { mass, inertia, .. } = body;
            return Err(ReadError::Mass { place: place.clone(), body: segment.name.clone(), mass, inertia });
        }
    }
    Ok(())
}

/// A body with the least mass and moments, and balanced, or `None` if nothing changes.
pub(crate) fn repaired(body: &MassProperties, moves: bool, repair: &Repair) -> Option<MassProperties> {
    let mut changed = *body;
    if moves {
        changed.mass = changed.mass.max(repair.least_mass);
        let (moments, rotation) = principal_axes(changed.inertia);
        if repair.least_inertia > 0.0 && moments.iter().any(|moment| *moment < repair.least_inertia) {
            let [xx, yy, zz] = moments.map(|moment| moment.max(repair.least_inertia));
            let turned = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [xx, yy, zz, 0.0, 0.0, 0.0] };
            changed.inertia = turned.placed(&Pose { position: [0.0; 3], rotation }).inertia;
        }
    }
    if repair.balance {
        let [a, b, c] = principal_axes(changed.inertia).0;
        if a + b < c || a + c < b || b + c < a {
            let mean = (changed.inertia[0] + changed.inertia[1] + changed.inertia[2]) / 3.0;
            changed.inertia = [mean, mean, mean, 0.0, 0.0, 0.0];
        }
    }
    (changed != *body).then_some(changed)
}

/// Moves the masses of fixed links to the moving one that carries them, where it has none itself.
pub(crate) fn move_fixed_masses(robot: &mut Robot, locations: &[SourceLocation], warnings: &mut Warnings) {
    let without: Vec<bool> =
        robot.segments.iter().map(|segment| segment.joint.kind != JointKind::Fixed && segment.mass == 0.0).collect();
    // The segment whose motion each shares, and its place in that one's frame.
    let mut carriers: Vec<(usize, Pose<f64>)> = Vec::with_capacity(without.len());
    for i in 0..robot.segments.len() {
        let segment = &robot.segments[i];
        let (carrier, pose) = match (segment.joint.kind, segment.parent.map(BodyId::index)) {
            (JointKind::Fixed, Some(parent)) if parent < i => {
                let (carrier, pose) = carriers[parent];
                (carrier, pose.compose(&segment.joint.placement))
            }
            _ => (i, Pose::identity()),
        };
        carriers.push((carrier, pose));
        if carrier == i || segment.mass == 0.0 || !without[carrier] {
            continue;
        }
        let body = segment.mass_properties().placed(&pose);
        let own = robot.segments[carrier].mass_properties();
        let both = if own.mass == 0.0 { body } else { own.with(&body) };
        let to = &mut robot.segments[carrier];
        MassProperties { mass: to.mass, centre: to.centre, inertia: to.inertia } = both;
        let from = &mut robot.segments[i];
        (from.mass, from.centre, from.inertia) = (0.0, [0.0; 3], [0.0; 6]);
        warnings.add(locations[i].clone(), "mass", "of a fixed link given to the one without mass that carries it");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::robot::{Joint, Segment};

    #[test]
    fn least_moments_and_balance() {
        let thin = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [1.0, 1.0, 0.0, 0.0, 0.0, 0.0] };
        let repair = Repair { least_mass: 0.5, least_inertia: 0.25, balance: true };
        let changed = repaired(&thin, true, &repair).expect("changed");
        assert_eq!((changed.mass, changed.inertia), (0.5, [1.0, 1.0, 0.25, 0.0, 0.0, 0.0]));
        assert_eq!(repaired(&thin, false, &repair), None);
        let impossible = MassProperties { inertia: [1.0, 1.0, 4.0, 0.0, 0.0, 0.0], ..thin };
        assert_eq!(repaired(&impossible, false, &repair).expect("changed").inertia, [2.0, 2.0, 2.0, 0.0, 0.0, 0.0]);
        assert_eq!(repaired(&impossible, true, &Repair::default()), None);
    }

    #[test]
    fn a_moving_link_without_mass_takes_that_of_fixed_ones() {
        let mut robot = Robot::new("r");
        let none = MassProperties { mass: 0.0, centre: [0.0; 3], inertia: [0.0; 6] };
        let ball = MassProperties::sphere(1.0, 0.1);
        let hinge = Joint::revolute("hinge", [0.0, 1.0, 0.0], Pose::identity(), [-1.0, 1.0]);
        let arm = robot.add_segment(Segment::new("arm", None, hinge, none));
        for (name, x) in [("left", -0.5), ("right", 0.5)] {
            robot.add_segment(Segment::new(name, Some(arm), Joint::fixed(Pose::at([x, 0.0, 0.0])), ball));
        }
        let locations = vec![SourceLocation { file: "r".into(), line: 1 }; 3];
        repair_masses(&mut robot, &locations, &Repair::default(), &mut Warnings::default()).expect("a mass");
        let own = robot.segments[0].mass_properties();
        assert_eq!((own.mass, own.centre), (2.0, [0.0; 3]));
        assert!((own.inertia[2] - 2.0 * (0.4 * 0.01 + 0.25)).abs() < 1e-15);
        assert!(robot.segments[1].mass == 0.0 && robot.validate().is_ok());
        robot.segments[0].mass = 0.0;
        let error =
            repair_masses(&mut robot, &locations, &Repair::default(), &mut Warnings::default()).expect_err("no mass");
        assert!(matches!(error, ReadError::Mass { .. }), "{error}");
    }
}
