//! The robot itself: one of ours, or one from a file.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::Robot;
use farsa_body::robots::ArmAndHand;
use farsa_lab::Error;
use farsa_models::{Imported, Limits, Meshes, ReadOptions};

use crate::check::places::Places;
use crate::document::{self, Document, RobotKind};

/// A robot, and where the links or bodies of its file are in it.
pub(crate) struct Body {
    pub(crate) robot: Robot,
    pub(crate) frames: Vec<(String, Option<BodyId>, Pose<f64>)>,
}

/// The most elements of a model.
const MOST_ELEMENTS: usize = 20_000;
/// The most geoms of a model that may touch others.
const MOST_CONTACTS: usize = 200;

impl Body {
    /// The robot of a document, in its place.
    ///
    /// # Errors
    /// [`Error::Setting`] for a file that is missing or no model, and for keys that are for wheels.
    pub(crate) fn new(document: &Document, places: &Places) -> Result<Self, Error> {
        let Some(robot) = &document.robot else { return Err(places.wrong("/robot", "there is none")) };
        let document::Robot { kind, count, radius, speed, infrared_range, file, floating, base } = robot;
        let given = [radius, speed, infrared_range].map(Option::is_some);
        let given = [("count", *count != 1), ("radius", given[0]), ("speed", given[1]), ("infrared_range", given[2])];
        if let Some((key, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(places.wrong(&format!("/robot/{key}"), "is for robots on wheels; this one has joints"));
        }
        let mut body = match (kind, file) {
            (RobotKind::Model, Some(file)) => Self::from_file(file, *floating, document, places)?,
            (RobotKind::Model, None) => return Err(places.wrong("/robot", "lacks the key `file`, that of the model")),
            (_, Some(_)) => return Err(places.wrong("/robot/file", "is for the kind `model`")),
            (_, None) if *floating => return Err(places.wrong("/robot/floating", "is for the kind `model`")),
            (_, None) => {
                let robot = ArmAndHand::default().robot().map_err(|error| places.wrong("/robot", error))?;
                Self { robot, frames: Vec::new() }
            }
        };
        body.place(*base);
        Ok(body)
    }

    fn from_file(name: &str, floating: bool, document: &Document, places: &Places) -> Result<Self, Error> {
        let text = document.files.get(name).map(String::as_str).unwrap_or_default();
        let limits = Limits { elements: MOST_ELEMENTS, contacts: MOST_CONTACTS, depth: 1000, ..Limits::default() };
        // Meshes would be other files: a robot touches things by its other shapes.
        let options = ReadOptions { floating, meshes: Meshes::Leave, limits, ..ReadOptions::default() };
        let read = Imported::from_text(text, &options);
        let Imported { robot, frames, .. } =
            read.map_err(|error| places.wrong("/robot/file", format!("{name}: {error}")))?;
        if robot.joints().next().is_none() && robot.segments.is_empty() {
            return Err(places.wrong("/robot/file", format!("{name}: has nothing that moves")));
        }
        let frames = frames.into_iter().map(|frame| (frame.name, frame.body, frame.placement)).collect();
        Ok(Self { robot, frames })
    }

    /// Moves all that hangs on the world.
    fn place(&mut self, base: [f64; 3]) {
        let moved = |pose: &mut Pose<f64>| {
            for (x, by) in pose.position.iter_mut().zip(base) {
                *x += by;
            }
        };
        let roots = self.robot.segments.iter_mut().filter(|segment| segment.parent.is_none());
        roots.for_each(|segment| moved(&mut segment.joint.placement));
        let standing = self.robot.colliders.iter_mut().filter(|collider| collider.body.is_none());
        standing.for_each(|collider| moved(&mut collider.placement));
        let standing = self.robot.visuals.iter_mut().filter(|visual| visual.body.is_none());
        standing.for_each(|visual| moved(&mut visual.placement));
        let standing = self.frames.iter_mut().filter(|(_, body, _)| body.is_none());
        standing.for_each(|(_, _, placement)| moved(placement));
    }
}
