//! Shared parts of the writers: nested lines, numbers and names in XML.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use farsa_body::robot::{Collider, Robot, Segment, Visual};

/// Deeper lines have no further indent, or the text would grow with the square of a chain's length.
const MAX_INDENT: usize = 32;

/// Lines of XML, each as far in as it is nested, up to 32 levels.
#[derive(Default)]
pub(crate) struct Lines {
    pub(crate) text: String,
    depth: usize,
}

impl Lines {
    /// One whole element or comment.
    pub(crate) fn line(&mut self, line: &str) {
        // Writing into a string cannot fail.
        let _ = writeln!(self.text, "{:1$}{line}", "", 2 * self.depth.min(MAX_INDENT));
    }

    /// An element, name and attributes, that others follow in.
    pub(crate) fn open(&mut self, head: &str) {
        self.line(&format!("<{head}>"));
        self.depth += 1;
    }

    /// The end of the element of this name.
    pub(crate) fn close(&mut self, name: &str) {
        self.depth = self.depth.saturating_sub(1);
        self.line(&format!("</{name}>"));
    }
}

/// Returns the friction of the ground on each sliding and turning joint of a body, by segment [N or N m].
pub(crate) fn friction_of_ground(robot: &Robot) -> Vec<f64> {
    let mut losses = vec![0.0; robot.segments.len()];
    for ground in &robot.grounds {
        let Some((sliders, turn)) = robot.sliders(ground.body) else { continue };
        let most = ground.friction * ground.load;
        for slider in sliders {
            losses[slider.index()] += most;
        }
        if let Some(turn) = turn {
            losses[turn.index()] += most * ground.radius;
        }
    }
    losses
}

/// Comment of a file with grounds.
pub(crate) const GROUND: &str = "<!-- Friction on the ground acts along each sliding joint by itself: aslant up to 1.42 times as much \
    as in the description. -->";

/// Numbers with a space between, each the shortest that reads back the same, zeros without sign.
pub(crate) fn numbers(of: &[f64]) -> String {
    let mut text = String::new();
    for (i, x) in of.iter().enumerate() {
        let _ = write!(text, "{}{:?}", if i == 0 { "" } else { " " }, x + 0.0);
    }
    text
}

/// A name as the value of an attribute, quotes included. U+FFFD for each character that XML does not have.
pub(crate) fn quoted(name: &str) -> String {
    let mut text = String::from("\"");
    for c in name.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            c if (c < ' ' && !"\t\n\r".contains(c)) || "\u{FFFE}\u{FFFF}".contains(c) => text.push('\u{FFFD}'),
            // Line breaks and tabs in attributes are read as spaces otherwise.
            c if c.is_control() => {
                let _ = write!(text, "&#{};", u32::from(c));
            }
            c => text.push(c),
        }
    }
    text.push('"');
    text
}

/// `wanted`, or with as many `_` behind as it takes to be none of the names.
pub(crate) fn unused(wanted: &str, names: &BTreeSet<&str>) -> String {
    let mut name = wanted.to_owned();
    while names.contains(name.as_str()) {
        name.push('_');
    }
    name
}

/// Gets the segments' names, changed where one is `reserved` by the format.
pub(crate) fn segment_names(robot: &Robot, reserved: &str) -> Vec<String> {
    let taken: BTreeSet<&str> = robot.segments.iter().map(|segment| segment.name.as_str()).collect();
    let name = |own: &str| if own == reserved { unused(own, &taken) } else { own.to_owned() };
    robot.segments.iter().map(|segment| name(&segment.name)).collect()
}

/// Checks whether a segment's mass is worth writing.
pub(crate) fn has_inertial(segment: &Segment) -> bool {
    segment.mass > 0.0 || segment.inertia.iter().chain(&segment.centre).any(|x| *x != 0.0)
}

/// Gets the colliders of the world, then those of each segment of a valid robot, in their order.
pub(crate) fn colliders_by_body(robot: &Robot) -> Vec<Vec<&Collider>> {
    let mut children = vec![Vec::new(); robot.segments.len() + 1];
    for collider in &robot.colliders {
        children[collider.body.map_or(0, |body| body.index() + 1)].push(collider);
    }
    children
}

/// Gets the visuals of the world, then those of each segment of a valid robot, in their order.
pub(crate) fn visuals_by_body(robot: &Robot) -> Vec<Vec<&Visual>> {
    let mut indices = vec![Vec::new(); robot.segments.len() + 1];
    for visual in &robot.visuals {
        indices[visual.body.map_or(0, |body| body.index() + 1)].push(visual);
    }
    indices
}

/// Builds an orange ball that slides and turns on the ground, next to a gray one fixed to the world.
#[cfg(test)]
pub(crate) fn ball_on_the_ground() -> Robot {
    use farsa_body::Pose;
    use farsa_body::robot::{Ground, MassProperties, Shape};
    let mut robot = Robot::new("ball");
    let body = robot.add_sliding_body("ball", Pose::identity(), MassProperties::sphere(0.3, 0.06), true);
    let ball = |name, body, x| Collider::new(name, body, Shape::Sphere { radius: 0.06 }, Pose::at([x, 0.0, 0.0]));
    robot.add_collider(ball("ball", Some(body), 0.0).with_color([1.0, 0.5, 0.0]));
    robot.add_collider(ball("post", None, 1.0));
    robot.add_ground(Ground { body, friction: 0.5, load: 3.0, radius: 0.02 });
    robot
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_safe_in_attributes() {
        assert_eq!(quoted("a<b> & \"c\"\n"), "\"a&lt;b&gt; &amp; &quot;c&quot;&#10;\"");
        assert_eq!(quoted("\u{1b}[2J\u{0}\u{FFFF}"), "\"\u{FFFD}[2J\u{FFFD}\u{FFFD}\"");
        assert_eq!(numbers(&[-0.0, 1.0, 1e-7, 0.1]), "0.0 1.0 1e-7 0.1");
        assert_eq!(unused("world", &BTreeSet::from(["world", "world_"])), "world__");
    }
}
