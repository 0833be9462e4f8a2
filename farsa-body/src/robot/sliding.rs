//! Bodies that slide in a plane, and the ground below them.

use alloc::format;

use crate::ports::{BodyId, JointId};
use crate::pose::{Pose, norm};
use crate::robot::description::{Ground, Robot, Segment};
use crate::robot::joint::{Joint, JointKind};
use crate::robot::mass_properties::MassProperties;
use crate::robot::validation::{Part, RobotError, index};

impl Robot {
    /// Adds a body that slides in the x-y plane of `placement`. If `turns` is true, it can also rotate about the z
    /// axis.
    ///
    /// The body is connected to the world by the sliding joints `NAME.x` and `NAME.y` without limits, and by the joint
    /// `NAME.turn` if it can rotate. Since every moving segment needs a mass, the segments between them have a
    /// billionth of the mass of the body. To move the body, place these joints, which precede it in the list (see
    /// [`Robot::sliders`]).
    pub fn add_sliding_body(&mut self, name: &str, placement: Pose<f64>, body: MassProperties, turns: bool) -> BodyId {
        const ENDLESS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
        let slight = MassProperties::sphere(1e-9 * body.mass, 0.01);
        let part = |part: &str| format!("{name}.{part}");
        let x = Joint::prismatic(&part("x"), [1.0, 0.0, 0.0], placement, ENDLESS);
        let y = Joint::prismatic(&part("y"), [0.0, 1.0, 0.0], Pose::identity(), ENDLESS);
        let first = self.add_segment(Segment::new(&part("slider"), None, x, slight));
        if !turns {
            return self.add_segment(Segment::new(name, Some(first), y, body));
        }
        let second = self.add_segment(Segment::new(&part("crosswise"), Some(first), y, slight));
        let turn = Joint::revolute(&part("turn"), [0.0, 0.0, 1.0], Pose::identity(), ENDLESS);
        self.add_segment(Segment::new(name, Some(second), turn, body))
    }

    /// Adds ground that exerts friction on a sliding body.
    pub fn add_ground(&mut self, ground: Ground) {
        self.grounds.push(ground);
    }

    /// Returns the joints of a body that slides in a plane. These are two perpendicular sliding joints and, if the body
    /// can rotate, a revolute joint.
    pub fn sliders(&self, body: BodyId) -> Option<([JointId; 2], Option<JointId>)> {
        let segment = |body: BodyId| self.segments.get(body.index());
        let turn = (segment(body)?.joint.kind == JointKind::Revolute).then_some(JointId(body.0));
        let second = if turn.is_some() { segment(body)?.parent? } else { body };
        let first = segment(second)?.parent?;
        let axis = |body: BodyId| Some(segment(body)?.joint.placement.rotate(segment(body)?.joint.axis));
        let slides = |body: BodyId| segment(body).is_some_and(|found| found.joint.kind == JointKind::Prismatic);
        // The first axis in the second joint's parent, which is the first body.
        let (one, other) = (segment(first)?.joint.axis, axis(second)?);
        let along = (one[0] * other[0] + one[1] * other[1] + one[2] * other[2]).abs();
        let crosswise = along < 1e-9 * norm(&one) * norm(&other);
        let rooted = segment(first)?.parent.is_none();
        (slides(first) && slides(second) && rooted && crosswise)
            .then_some(([JointId(first.0), JointId(second.0)], turn))
    }

    /// Looks for what is wrong with the grounds.
    pub(super) fn validate_grounds(&self) -> Result<(), RobotError> {
        for (place, ground) in self.grounds.iter().enumerate() {
            index("a ground", "body", ground.body.index(), self.segments.len())?;
            let segment = &self.segments[ground.body.index()];
            let part = Part(&segment.name);
            part.not_negative("friction of the ground", ground.friction)?;
            part.not_negative("load on the ground", ground.load)?;
            part.not_negative("radius of the ground's friction", ground.radius)?;
            if self.grounds[..place].iter().any(|other| other.body == ground.body) {
                return Err(RobotError::Name { name: segment.name.clone() });
            }
            if self.sliders(ground.body).is_none() {
                let name = &segment.name;
                let why = format!("segment {name}: no body that slides in a plane has ground below it");
                return Err(RobotError::Structure { why });
            }
        }
        Ok(())
    }
}
