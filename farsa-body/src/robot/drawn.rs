//! The shapes drawn. These are the visuals, and the colliders of segments without visuals.

use alloc::format;

use crate::robot::description::{Collider, Robot};
use crate::robot::validation::{Part, RobotError, index};
use crate::robot::visual::Visual;

impl From<&Collider> for Visual {
    /// The look of a collider.
    fn from(collider: &Collider) -> Self {
        let Collider { body, shape, placement, color, .. } = *collider;
        Self { body, shape, placement, color }
    }
}

impl Robot {
    /// Adds a shape drawn.
    pub fn add_visual(&mut self, visual: Visual) {
        self.visuals.push(visual);
    }

    /// Returns an iterator over the colliders drawn. These are the colliders of the world and of segments that have no
    /// visual.
    pub fn drawn_colliders(&self) -> impl Iterator<Item = &Collider> + '_ {
        let replaced = |body| self.visuals.iter().any(|visual| visual.body == Some(body));
        self.colliders.iter().filter(move |collider| !collider.body.is_some_and(replaced))
    }

    pub(super) fn validate_visuals(&self) -> Result<(), RobotError> {
        for (number, visual) in self.visuals.iter().enumerate() {
            let name = format!("visual {number}");
            if let Some(body) = visual.body {
                index(&name, "body", body.index(), self.segments.len())?;
            }
            Part(&name).shape(&visual.shape)?;
            Part(&name).placement(&visual.placement)?;
            Part(&name).color(visual.color)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ports::BodyId;
    use crate::pose::Pose;
    use crate::robot::description::Segment;
    use crate::robot::joint::Joint;
    use crate::robot::mass_properties::MassProperties;
    use crate::robot::shape::Shape;
    use alloc::string::ToString;
    use alloc::vec::Vec;

    fn ball(body: Option<BodyId>) -> Visual {
        Visual::new(body, Shape::Sphere { radius: 0.1 }, Pose::identity())
    }

    fn dressed() -> Robot {
        let mut robot = Robot::new("dressed");
        for name in ["bare", "covered"] {
            let mass = MassProperties::sphere(1.0, 0.1);
            let body = robot.add_segment(Segment::new(name, None, Joint::fixed(Pose::identity()), mass));
            let shape = Shape::Sphere { radius: 0.1 };
            robot.add_collider(Collider::new(name, Some(body), shape, Pose::identity()));
        }
        robot.add_collider(Collider::new("floor", None, Shape::Plane, Pose::identity()));
        robot.add_visual(ball(Some(BodyId(1))).with_color([1.0, 0.5, 0.0]));
        robot.add_visual(ball(None));
        robot
    }

    #[test]
    fn visuals_replace_colliders_of_their_segment_only_and_move_along_when_merged() {
        let robot = dressed();
        assert_eq!(robot.validate(), Ok(()));
        let drawn: Vec<&str> = robot.drawn_colliders().map(|collider| collider.name.as_str()).collect();
        assert_eq!(drawn, ["bare", "floor"]);
        let mut both = robot.prefixed("a ");
        both.merge(&robot.prefixed("b "));
        assert_eq!(both.validate(), Ok(()));
        let bodies: Vec<Option<BodyId>> = both.visuals.iter().map(|visual| visual.body).collect();
        assert_eq!(bodies, [Some(BodyId(1)), None, Some(BodyId(3)), None]);
        assert_eq!(both.visuals[2].color, Some([1.0, 0.5, 0.0]));
    }

    #[test]
    fn faults_are_named() {
        let fault = |change: fn(&mut Visual)| {
            let mut robot = dressed();
            change(&mut robot.visuals[0]);
            robot.validate().expect_err("a fault").to_string()
        };
        assert_eq!(fault(|visual| visual.body = Some(BodyId(2))), "visual 0: body 2 of 2");
        assert_eq!(fault(|visual| visual.shape = Shape::Sphere { radius: 0.0 }), "visual 0: radius is 0");
        assert_eq!(fault(|visual| visual.color = Some([0.0, 1.5, 0.0])), "visual 0: colour is 1.5");
        assert!(fault(|visual| visual.placement.rotation = [0.0; 4]).contains("length of the rotation"));
    }
}
