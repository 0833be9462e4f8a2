//! A table with a ball in front of the iCub.

use crate::ports::BodyId;
use crate::pose::Pose;
use crate::robot::description::{Collider, Robot, Segment, Surface};
use crate::robot::joint::Joint;
use crate::robot::mass_properties::MassProperties;
use crate::robot::shape::Shape;
use crate::robots::icub::chain::Side;
use crate::robots::icub::colliders;
use crate::robots::icub::description::Icub;
use crate::robots::icub::error::IcubError;

/// A table with a ball in front of the iCub. All values can be changed.
///
/// The default values were chosen for this crate.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct IcubTabletop {
    /// The lower and upper ends of the table along X (in meters).
    pub table_x: [f64; 2],
    /// The lower and upper ends of the table along Y (in meters).
    pub table_y: [f64; 2],
    /// Height of the table top in meters.
    pub table_top: f64,
    /// Thickness of the solid table (in meters).
    pub table_depth: f64,
    /// Red, green and blue components of the color of the table (between 0 and 1).
    pub table_color: [f64; 3],
    /// Radius of the ball in meters.
    pub ball_radius: f64,
    /// Mass of the solid ball (in kilograms).
    pub ball_mass: f64,
    /// Red, green and blue components of the color of the ball (between 0 and 1).
    pub ball_color: [f64; 3],
    /// Initial X and Y coordinates of the ball on the table (in meters).
    pub ball_start: [f64; 2],
    /// Properties of contacts between the robot and the ball.
    pub robot_on_ball: Surface,
    /// Properties of contacts between the ball and the table.
    pub ball_on_table: Surface,
    /// Properties of contacts between the robot and the table.
    pub robot_on_table: Surface,
}

impl Default for IcubTabletop {
    fn default() -> Self {
        let Icub { hand, skin, .. } = Icub::default();
        Self {
            table_x: [0.12, 0.60],
            table_y: [-0.45, 0.45],
            table_top: -0.08,
            table_depth: 0.30,
            table_color: [0.85, 0.76, 0.62],
            ball_radius: 0.04,
            ball_mass: 0.080,
            ball_color: [0.90, 0.35, 0.05],
            ball_start: [0.26, -0.11],
            robot_on_ball: hand.surface,
            ball_on_table: Surface { rolling_friction: 8e-4, ..hand.surface },
            robot_on_table: skin,
        }
    }
}

impl IcubTabletop {
    /// Body of the ball in the description returned by [`IcubTabletop::scene`].
    pub const BALL: BodyId = BodyId(60);

    /// Builds a description with the robot, the ball and the table. The parts of the robot come first.
    ///
    /// The pairs of the robot come first. They are followed by those of the `ball`. It can touch the waist, the chest
    /// and the head, and the forearm, the palm and the phalanges of the left and then the right side. The last pairs
    /// are those of the `table`. It can touch the ball, the chest, the head, and the upper arm, the forearm, the palm
    /// and the phalanges of both sides.
    ///
    /// # Errors
    /// Returns the errors of [`Icub::robot`] and of [`Robot::validate`].
    pub fn scene(&self, icub: &Icub) -> Result<Robot, IcubError> {
        let mut robot = icub.robot()?;
        let [x, y] = self.ball_start;
        let start = Joint::floating(Pose::at([x, y, self.table_top + self.ball_radius]));
        let solid = MassProperties::sphere(self.ball_mass, self.ball_radius);
        let body = robot.add_segment(Segment::new("ball", None, start, solid));
        let shape = Shape::Sphere { radius: self.ball_radius };
        let ball = Collider::new("ball", Some(body), shape, Pose::identity()).with_color(self.ball_color);
        let ball = robot.add_collider(ball);
        let ([x0, x1], [y0, y1], z1) = (self.table_x, self.table_y, self.table_top);
        let half = [(x1 - x0) / 2.0, (y1 - y0) / 2.0, self.table_depth / 2.0];
        let middle = Pose::at([f64::midpoint(x0, x1), f64::midpoint(y0, y1), z1 - half[2]]);
        let table = Collider::new("table", None, Shape::Box { half }, middle).with_color(self.table_color);
        let table = robot.add_collider(table);

        let [_, chest, head] = colliders::TRUNK;
        for part in colliders::TRUNK.into_iter().chain(Side::ALL.into_iter().flat_map(|side| limbs(side).skip(1))) {
            robot.add_pair([part, ball], self.robot_on_ball);
        }
        robot.add_pair([ball, table], self.ball_on_table);
        for part in [chest, head].into_iter().chain(Side::ALL.into_iter().flat_map(limbs)) {
            if colliders::carrier(&robot, part).is_some() {
                robot.add_pair([part, table], self.robot_on_table);
            }
        }
        robot.validate()?;
        Ok(robot)
    }
}

/// Upper arm, forearm, palm, phalanges.
fn limbs(side: Side) -> impl Iterator<Item = usize> {
    let first = colliders::first_phalange(side);
    colliders::arm(side).into_iter().chain(first..first + 15)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots::icub::chain::Chain;
    use alloc::vec;

    #[test]
    fn scene_holds_robot_ball_and_table() {
        let robot = IcubTabletop::default().scene(&Icub::default()).expect("a valid scene");
        let own = Icub::default().robot().expect("a valid robot");
        assert_eq!(robot.segments.len(), 61);
        assert_eq!(robot.body("ball"), Some(IcubTabletop::BALL));
        assert_eq!(robot.colliders.len(), own.colliders.len() + 2);
        // Ball with trunk, forearms, palms and phalanges, and the table. Table with chest, head, upper arms and those.
        assert_eq!(robot.pairs.len(), own.pairs.len() + (3 + 2 * 17) + 1 + (2 + 2 * 18));
        assert_eq!(robot.pairs[..own.pairs.len()], own.pairs[..]);
        for name in ["head", "l_forearm", "r_palm", "r_little_distal", "table"] {
            assert!(robot.pair("ball", name).is_some(), "{name}");
        }
        assert!(robot.pair("table", "r_upper_arm").is_some());
        assert!(robot.pair("table", "waist").is_none());
    }

    #[test]
    fn what_is_rigid_has_no_pair_with_the_table() {
        let icub = Icub { actuated: vec![Chain::RightArm], ..Icub::default() };
        let robot = IcubTabletop::default().scene(&icub).expect("a valid scene");
        assert!(robot.pair("table", "l_palm").is_none());
        assert!(robot.pair("ball", "l_palm").is_some() && robot.pair("table", "r_index_middle").is_some());
    }

    #[test]
    fn impossible_tables_are_refused() {
        for wrong in [
            IcubTabletop { table_depth: 0.0, ..IcubTabletop::default() },
            IcubTabletop { ball_mass: f64::INFINITY, ..IcubTabletop::default() },
            IcubTabletop { ball_radius: -0.1, ..IcubTabletop::default() },
        ] {
            assert!(matches!(wrong.scene(&Icub::default()), Err(IcubError::Robot(_))), "{wrong:?}");
        }
    }
}
