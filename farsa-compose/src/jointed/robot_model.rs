//! Robot, built in or from a file.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::Robot;
use farsa_lab::Error;
use farsa_models::mjcf::Keyframe;
use farsa_models::{Imported, Limits, Meshes, ReadOptions};
use farsa_view::shape::SceneMesh;

use crate::check::source::Source;
use crate::document::{self, Document};
use crate::jointed::drawn_meshes;
use crate::part::definition::Maker;

/// A robot with the frames of the links or bodies of its file.
pub(crate) struct RobotModel {
    pub(crate) robot: Robot,
    pub(crate) frames: Vec<(String, Option<BodyId>, Pose<f64>)>,
    /// False if the model disables all contacts.
    pub(crate) touches: bool,
    /// States of its file from which a trial can start. The first is the configuration of the file.
    pub(crate) postures: Vec<Keyframe>,
    /// Meshes that pages draw.
    pub(crate) meshes: Vec<SceneMesh>,
}

/// Most elements of a model.
const MAX_ELEMENTS: usize = 20_000;
/// Most geoms of a model that may have contacts.
const MAX_CONTACTS: usize = 200;

/// Returns the options for models, with limits that suit an experiment.
pub(crate) fn model_options() -> ReadOptions {
    let limits = Limits { elements: MAX_ELEMENTS, contacts: MAX_CONTACTS, depth: 1000, ..Limits::default() };
    ReadOptions { limits, ..ReadOptions::default() }
}

impl RobotModel {
    /// Builds the robot of a document at its base.
    pub(crate) fn new(document: &Document, source: &Source) -> Result<Self, Error> {
        let Some(robot) = &document.robot else { return Err(source.wrong("/robot", "there is none")) };
        let document::Robot { kind, count, radius, speed, infrared_range, file, floating, base } = robot;
        let given = [radius, speed, infrared_range].map(Option::is_some);
        let given = [("count", *count != 1), ("radius", given[0]), ("speed", given[1]), ("infrared_range", given[2])];
        if let Some((key, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(source.wrong(&format!("/robot/{key}"), "is for robots on wheels; this one has joints"));
        }
        let mut body = match (source.registry.robot(kind), file) {
            (Some(Maker::File), Some(file)) => Self::from_file(file, *floating, document, source)?,
            (Some(Maker::File), None) => {
                return Err(source.wrong("/robot", "lacks the key `file`, that of the model"));
            }
            (_, Some(_)) => return Err(source.wrong("/robot/file", "is for the kind `model`")),
            (_, None) if *floating => return Err(source.wrong("/robot/floating", "is for the kind `model`")),
            (Some(Maker::Joints(robot)), None) => {
                let (robot, postures) = ((**robot).clone(), Vec::new());
                Self { robot, frames: Vec::new(), touches: true, postures, meshes: Vec::new() }
            }
            (_, None) => return Err(source.wrong("/robot/kind", "is no robot with joints")),
        };
        body.place(*base);
        Ok(body)
    }

    fn from_file(name: &str, floating: bool, document: &Document, source: &Source) -> Result<Self, Error> {
        let text = document.files.get(name).map(String::as_str).unwrap_or_default();
        // The text of a run contains no mesh, and opens no file.
        let options = ReadOptions { floating, meshes: Meshes::Leave, ..model_options() };
        let read = Imported::from_text(text, &options);
        let Imported { robot, frames, gravity, contacts, keyframes, .. } =
            read.map_err(|error| source.wrong("/robot/file", format!("{name}: {error}")))?;
        check_gravity(gravity, document, source)?;
        if robot.joints().next().is_none() && robot.segments.is_empty() {
            return Err(source.wrong("/robot/file", format!("{name}: has nothing that moves")));
        }
        let frames = frames.into_iter().map(|frame| (frame.name, frame.body, frame.placement)).collect();
        let name_of_meshes = drawn_meshes::text_name(name);
        let meshes = document.files.get(&name_of_meshes);
        let meshes = meshes.map(|text| drawn_meshes::read(text, &robot)).transpose();
        let meshes =
            meshes.map_err(|why| source.wrong("/robot/file", format!("{name_of_meshes}: {why}")))?.unwrap_or_default();
        Ok(Self { robot, frames, touches: contacts, postures: keyframes, meshes })
    }

    /// Moves all segments that are fixed to the world.
    fn place(&mut self, base: [f64; 3]) {
        let shifted = |position: &mut [f64; 3]| position.iter_mut().zip(base).for_each(|(x, by)| *x += by);
        let moved = |pose: &mut Pose<f64>| shifted(&mut pose.position);
        // All other poses are relative to a parent and move with it.
        let roots = self.robot.segments.iter_mut().filter(|segment| segment.parent.is_none());
        roots.for_each(|segment| moved(&mut segment.joint.placement));
        let free = self.postures.iter_mut().flat_map(|posture| &mut posture.bodies);
        free.for_each(|(_, pose)| moved(pose));
        let standing = self.robot.colliders.iter_mut().filter(|collider| collider.body.is_none());
        standing.for_each(|collider| moved(&mut collider.placement));
        let standing = self.robot.visuals.iter_mut().filter(|visual| visual.body.is_none());
        standing.for_each(|visual| moved(&mut visual.placement));
        let standing = self.meshes.iter_mut().filter(|mesh| mesh.body.is_none());
        standing.for_each(|mesh| shifted(&mut mesh.centre));
        let standing = self.frames.iter_mut().filter(|(_, body, _)| body.is_none());
        standing.for_each(|(_, _, placement)| moved(placement));
    }
}

/// Refuses a model with another gravity than that of a world that does not choose one.
fn check_gravity(gravity: Option<[f64; 3]>, document: &Document, source: &Source) -> Result<(), Error> {
    let usual = document::World::default().gravity;
    let Some(gravity) = gravity.filter(|gravity| *gravity != usual && document.world.gravity == usual) else {
        return Ok(());
    };
    let why = format!(
        "is {usual:?} and that of the model {gravity:?}; set `gravity = {gravity:?}`, or remove it from the model"
    );
    Err(source.wrong("/world/gravity", why))
}
