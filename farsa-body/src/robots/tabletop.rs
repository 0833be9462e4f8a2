//! The table and the sphere of the experiment `reach-grasp-lift`.

use crate::ports::BodyId;
use crate::pose::Pose;
use crate::robot::description::{Collider, Robot, Segment, Surface};
use crate::robot::joint::Joint;
use crate::robot::mass_properties::MassProperties;
use crate::robot::shape::Shape;
use crate::robot::validation::RobotError;
use crate::robots::arm_and_hand::ArmAndHand;
use crate::robots::hand::Finger;

/// A table with a sphere in front of the arm and hand. All values can be changed.
///
/// The table top is at z = 0. The default radius of the sphere is given by the source. All other defaults were chosen.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Tabletop {
    /// The lower and upper ends of the table along X (in meters).
    pub table_x: [f64; 2],
    /// The lower and upper ends of the table along Y (in meters).
    pub table_y: [f64; 2],
    /// Thickness of the solid table (in meters).
    pub table_depth: f64,
    /// Radius of the sphere (in meters).
    pub sphere_radius: f64,
    /// Mass of the solid sphere (in kilograms).
    pub sphere_mass: f64,
    /// Initial X and Y coordinates of the sphere on the table (in meters).
    pub sphere_start: [f64; 2],
    /// Properties of contacts between the hand and the sphere.
    pub hand_on_sphere: Surface,
    /// Properties of contacts between the sphere and the table.
    pub sphere_on_table: Surface,
    /// Properties of contacts of the arm and hand with the table.
    pub arm_on_table: Surface,
}

impl Default for Tabletop {
    fn default() -> Self {
        let surface = ArmAndHand::default().surface;
        Self {
            table_x: [0.03, 0.50],
            table_y: [-0.55, 0.25],
            table_depth: 0.30,
            sphere_radius: 0.025,
            sphere_mass: 0.050,
            sphere_start: [0.10, -0.18],
            hand_on_sphere: surface,
            sphere_on_table: Surface { rolling_friction: 5e-4, ..surface },
            arm_on_table: surface,
        }
    }
}

impl Tabletop {
    /// Body of the sphere in the description returned by [`Tabletop::scene`].
    pub const SPHERE: BodyId = BodyId(27);

    /// Builds a description with the arm, the hand, the sphere and the table. The parts of the arm come first.
    ///
    /// The pairs of the arm come first. They are followed by those of the `sphere` with the palm and the fifteen
    /// phalanges, finger by finger. The last pairs are those of the `table` with the sphere, the forearm, the palm and
    /// the phalanges.
    ///
    /// # Errors
    /// Returns the errors of [`Robot::validate`].
    pub fn scene(&self, arm: &ArmAndHand) -> Result<Robot, RobotError> {
        let mut robot = arm.robot()?;
        let [x, y] = self.sphere_start;
        let start = Joint::floating(Pose::at([x, y, self.sphere_radius]));
        let solid = MassProperties::sphere(self.sphere_mass, self.sphere_radius);
        let body = robot.add_segment(Segment::new("sphere", None, start, solid));
        let shape = Shape::Sphere { radius: self.sphere_radius };
        let sphere = robot.add_collider(Collider::new("sphere", Some(body), shape, Pose::identity()));
        let ([x0, x1], [y0, y1], z0) = (self.table_x, self.table_y, -self.table_depth);
        let half = [(x1 - x0) / 2.0, (y1 - y0) / 2.0, -z0 / 2.0];
        let middle = Pose::at([f64::midpoint(x0, x1), f64::midpoint(y0, y1), z0 / 2.0]);
        let table = robot.add_collider(Collider::new("table", None, Shape::Box { half }, middle));

        let [_, forearm, palm] = ArmAndHand::ARM_COLLIDERS;
        let phalanges = || Finger::ALL.into_iter().flat_map(ArmAndHand::phalange_colliders);
        for part in core::iter::once(palm).chain(phalanges()) {
            robot.add_pair([part, sphere], self.hand_on_sphere);
        }
        robot.add_pair([sphere, table], self.sphere_on_table);
        for part in [forearm, palm].into_iter().chain(phalanges()) {
            robot.add_pair([part, table], self.arm_on_table);
        }
        robot.validate()?;
        Ok(robot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scene_holds_arm_sphere_and_table() {
        let robot = Tabletop::default().scene(&ArmAndHand::default()).expect("a valid scene");
        assert_eq!(robot.segments.len(), 28);
        assert_eq!(robot.body("sphere"), Some(Tabletop::SPHERE));
        assert_eq!(robot.colliders.len(), 20);
        // Thumb with the others' outer phalanges, neighbors, palm with the outer ones. Sphere with palm and phalanges,
        // table.
        assert_eq!(robot.pairs.len(), (2 * 8 + 3 + 6) + 16 + 18);
        assert!(robot.pair("sphere", "little_distal").is_some());
        assert!(robot.pair("table", "sphere").is_some());
        assert!(robot.pair("table", "upper_arm").is_none());
        assert_eq!(robot.pairs[robot.pair("table", "sphere").expect("a pair").index()].surface.rolling_friction, 5e-4);
    }

    #[test]
    fn impossible_tables_are_refused() {
        let flat = Tabletop { table_depth: 0.0, ..Tabletop::default() };
        assert!(flat.scene(&ArmAndHand::default()).is_err());
        let heavy = Tabletop { sphere_mass: f64::INFINITY, ..Tabletop::default() };
        assert!(heavy.scene(&ArmAndHand::default()).is_err());
        let strong = ArmAndHand { moment_arm: f64::NAN, ..ArmAndHand::default() };
        assert!(Tabletop::default().scene(&strong).is_err());
    }
}
