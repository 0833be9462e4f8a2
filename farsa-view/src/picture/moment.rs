//! Content of a picture of a moment.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{JointKind, Robot, Visual};

use crate::picture::camera::{Camera, Window};
use crate::shape::appearance::{Color, Instance, OKABE_ITO, Role, as_screens_take_it};
use crate::shape::vector::{Vector, length};

/// A force that acts on a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Point of application, in world coordinates [m].
    pub point: Vector,
    /// Force in world coordinates [N].
    pub force: Vector,
}

/// A ray of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Start of the ray, in world coordinates [m].
    pub from: Vector,
    /// End of the ray, in world coordinates [m].
    pub to: Vector,
    /// This is `true` if the ray hit something at its end.
    pub hit: bool,
}

/// A single moment of a simulation. You can draw it without a browser.
///
/// ```
/// use farsa_body::kinematics::KinematicTree;
/// use farsa_body::robots::ArmAndHand;
/// use farsa_view::{Camera, Picture};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let robot = ArmAndHand::default().robot()?;
/// let tree = KinematicTree::new(&robot)?;
/// let poses = tree.poses(&tree.zero());
/// let mut picture = Picture { caption: Some("at rest".into()), ..Picture::default() };
/// picture.add_robot(&robot, |body| poses[body.index()]);
/// let svg = picture.svg(Camera::named("front")?, [600, 400], "rest-");
/// assert!(svg.contains("at rest"));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// All shapes.
    pub shapes: Vec<Instance>,
    /// Contact forces. They are drawn as arrows, whose length is relative to the largest force.
    pub contacts: Vec<Push>,
    /// Rays of sensors.
    pub rays: Vec<Beam>,
    /// Points with their names, which may be empty. Only SVG shows the names.
    pub points: Vec<(String, Vector)>,
    /// Trails through the world [m], together with their colors.
    pub trails: Vec<(Vec<Vector>, Color)>,
    /// Additional points that the frame must contain [m], for example the corners of an arena. The camera `close`
    /// ignores them.
    pub frame: Vec<Vector>,
    /// Caption with a single line. Only SVG shows it.
    pub caption: Option<String>,
}

const PALM: Color = [122, 143, 166];
/// Colors of a robot's branches. Neighbors differ in lightness.
const BRANCHES: [Color; 5] = [[132, 184, 182], [104, 150, 190], [160, 190, 214], [104, 150, 190], [160, 190, 214]];

/// Finds the body with the most children, at least two, such as a palm.
fn junction(robot: &Robot) -> Option<usize> {
    let children = |body: usize| robot.segments.iter().filter(|s| s.parent.is_some_and(|p| p.index() == body)).count();
    // Among equals the last one, which is nearest to the fingers.
    (0..robot.segments.len()).max_by_key(|body| children(*body)).filter(|body| children(*body) > 1)
}

/// Appearance of a body of a robot in pictures and pages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    pub(crate) role: Role,
    /// Color of shapes without their own, `None` for that of the role.
    pub(crate) color: Option<Color>,
    /// True where the camera `close` looks.
    focus: bool,
}

impl Look {
    /// Appearance of the world.
    pub(crate) const GROUND: Self = Self { role: Role::Ground, color: None, focus: false };
}

/// Returns the appearance of each body.
pub(crate) fn looks(robot: &Robot) -> Vec<Look> {
    let junction = junction(robot);
    let parent = |body: usize| robot.segments[body].parent.map(BodyId::index);
    let branches: Vec<usize> =
        (0..robot.segments.len()).filter(|i| junction.is_some() && parent(*i) == junction).collect();
    let leaf = |body: usize| (0..robot.segments.len()).all(|other| parent(other) != Some(body));
    let moves_freely = |body: BodyId| {
        let floating = robot.segments[body.index()].joint.kind == JointKind::Floating;
        leaf(body.index()) && (floating || robot.sliders(body).is_some())
    };
    let drawn = robot.drawn_colliders().filter_map(|shape| shape.body);
    let mut things: Vec<usize> = Vec::new();
    for body in drawn.chain(robot.visuals.iter().filter_map(|shape| shape.body)) {
        if moves_freely(body) && !things.contains(&body.index()) {
            things.push(body.index());
        }
    }
    let look = |body: usize| {
        if let Some(index) = things.iter().position(|thing| *thing == body) {
            // Blue colors belong to the robot.
            let color = OKABE_ITO[[0, 2, 6, 3][index % 4]];
            return Look { role: Role::Object, color: Some(color), focus: true };
        }
        let mut ancestors = std::iter::successors(Some(body), |body| parent(*body));
        let branch = ancestors.find_map(|body| branches.iter().position(|branch| *branch == body));
        let color = match branch {
            Some(branch) => Some(BRANCHES[branch % BRANCHES.len()]),
            None => (junction == Some(body)).then_some(PALM),
        };
        Look { role: Role::Robot, color, focus: color.is_some() }
    };
    (0..robot.segments.len()).map(look).collect()
}

impl Picture {
    /// Adds a robot or scene at the given poses.
    ///
    /// This draws the visuals of each segment. If a segment has none, its colliders are drawn instead. Fixed bodies
    /// become ground, bodies that move freely become things, and all others belong to the robot.
    ///
    /// If a shape has a color, it keeps this color. Other things get the next color of a list. Branches of a robot
    /// differ in color, and the camera `close` is fitted to them.
    pub fn add_robot(&mut self, robot: &Robot, pose: impl Fn(BodyId) -> Pose<f64>) {
        let looks = looks(robot);
        let drawn = robot.drawn_colliders().map(Visual::from).chain(robot.visuals.iter().copied());
        for Visual { body, shape, placement, color } in drawn {
            let look = body.map_or(Look::GROUND, |body| looks[body.index()]);
            let at = body.map_or(placement, |body| pose(body).compose(&placement));
            let color = color.map(as_screens_take_it).or(look.color);
            self.shapes.push(Instance { color, focus: look.focus, ..Instance::new(shape, at, look.role) });
        }
    }

    /// Computes the corners of the scene [m].
    ///
    /// This is useful if several pictures should have the same view. In this case, add the corners to the
    /// [`frame`](Self::frame) of each picture.
    pub fn extent(&self) -> Vec<Vector> {
        let corners = |(centre, radius): (Vector, f64)| [-radius, radius].map(|r| centre.map(|x| x + r));
        self.interest(false).into_iter().flat_map(corners).collect()
    }

    /// Returns the view of a camera in a frame of width and height [pixels].
    pub(crate) fn window(&self, camera: Camera, size: [u32; 2]) -> Window {
        camera.fit(self.interest(camera.is_close()), size)
    }

    /// Returns balls that contain the scene of a camera: everything except the ground, or the things of `close`.
    pub(crate) fn interest(&self, close: bool) -> Vec<(Vector, f64)> {
        let wanted = |placed: &&Instance| if close { placed.focus } else { placed.role != Role::Ground };
        let hull = |placed: &Instance| {
            let pose = placed.pose;
            placed.geometry.hull().into_iter().map(move |(centre, radius)| (pose.transform(centre), radius))
        };
        let mut balls: Vec<_> = self.shapes.iter().filter(wanted).flat_map(hull).collect();
        if close && !balls.is_empty() {
            return balls;
        }
        let marks = self.points.iter().map(|(_, point)| *point);
        let marks = marks.chain(self.trails.iter().flat_map(|(trail, _)| trail.iter().copied()));
        let marks = marks.chain(self.frame.iter().copied()).chain(self.contacts.iter().map(|push| push.point));
        balls.extend(marks.chain(self.rays.iter().flat_map(|ray| [ray.from, ray.to])).map(|point| (point, 0.0)));
        if balls.is_empty() {
            // Without moving shapes, all shapes.
            balls.extend(self.shapes.iter().flat_map(hull));
        }
        balls.retain(|(centre, radius)| (length(*centre) + radius).is_finite());
        balls
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn visuals_are_drawn_in_place_of_colliders() {
        use farsa_body::kinematics::KinematicTree;
        use farsa_body::robots::Icub;
        let mut robot = Icub::default().robot().unwrap();
        let start = Icub::default().start();
        let poses = KinematicTree::new(&robot).unwrap().poses(&start);
        let drawn = |robot: &Robot| {
            let mut picture = Picture::default();
            picture.add_robot(robot, |body| poses[body.index()]);
            picture
        };
        let dressed = drawn(&robot);
        // Every body with a collider has visuals.
        assert_eq!((robot.drawn_colliders().count(), dressed.shapes.len()), (0, robot.visuals.len()));
        let eye = robot.visuals.iter().position(|visual| visual.placement.position == Icub::EYES[0]).unwrap();
        let at = poses[Icub::HEAD.index()].transform(Icub::EYES[0]);
        assert_eq!(dressed.shapes[eye].pose.position, at);
        assert_eq!(dressed.shapes[eye].color, Some(as_screens_take_it([0.98; 3])));
        if let Some(path) = std::env::var_os("FARSA_LOOK") {
            for camera in ["front", "three-quarter"] {
                let png = dressed.png(Camera::named(camera).unwrap(), [900, 1000]).unwrap();
                std::fs::write(std::path::Path::new(&path).join(format!("icub-{camera}.png")), png).unwrap();
            }
        }
        robot.visuals.clear();
        assert_eq!(drawn(&robot).shapes.len(), robot.colliders.len());
    }
    use farsa_body::kinematics::KinematicTree;
    use farsa_body::robots::{ArmAndHand, Tabletop};

    #[test]
    fn a_scene_is_told_apart() {
        let robot = Tabletop::default().scene(&ArmAndHand::default()).unwrap();
        let tree = KinematicTree::new(&robot).unwrap();
        let poses = tree.poses(&tree.zero());
        let mut picture = Picture::default();
        picture.add_robot(&robot, |body| poses[body.index()]);
        let count = |role| picture.shapes.iter().filter(|placed| placed.role == role).count();
        assert_eq!([Role::Robot, Role::Object, Role::Ground, Role::Area].map(count), [18, 1, 1, 0]);
        // The palm, fifteen phalanges and the sphere.
        assert_eq!(picture.shapes.iter().filter(|placed| placed.focus).count(), 17);
        assert_eq!(picture.shapes[18].color(), OKABE_ITO[0]);
        let index = ArmAndHand::phalange_colliders(farsa_body::robots::Finger::Index)[0];
        assert_ne!(picture.shapes[index].color(), picture.shapes[index + 3].color());
        assert!(picture.interest(true).len() < picture.interest(false).len());
    }
}
