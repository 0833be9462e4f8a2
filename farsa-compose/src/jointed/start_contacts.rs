//! Contacts at the start of a trial.

use farsa_body::ports::{Contacts as _, PairId, World as _};
use farsa_lab::{EpisodeId, Error};
use farsa_physics::articulated::{Model, Options, World};

use crate::check::source::Source;
use crate::jointed::episode::JointedEpisode;

/// Greatest depth of a contact at the start [m].
const DEEPEST: f32 = 1e-3;
/// Step that detects contacts, too short to move anything [s].
const INSTANT: f64 = 1e-6;

/// Refuses a start of one of the trials inside the floor or inside a thing.
///
/// Contacts of the robot with itself do not count, because neighboring parts of models often overlap.
pub(crate) fn check_start(
    episode: &mut JointedEpisode,
    options: &Options,
    trials: impl Iterator<Item = EpisodeId>,
    source: &Source,
) -> Result<(), Error> {
    let instant = Options { time_step: INSTANT, substeps: 1, ..*options };
    let model = Model::<f32>::new(&episode.scene().robot, &instant).map_err(|error| source.wrong("/robot", error))?;
    let mut world = World::new(model);
    for id in trials {
        let trial = id.trial + 1;
        if !episode.arrange(&mut world, id) {
            continue;
        }
        world.step();
        let scene = episode.scene();
        for (number, pair) in scene.robot.pairs.iter().enumerate() {
            let Some([part, other]) = scene.parts(pair.colliders) else { continue };
            let id = PairId(number as u16);
            let depth = if world.touches(id) { world.pair_contact(id).depth } else { 0.0 };
            if depth > DEEPEST {
                let why =
                    format!("`{part}` is {:.1} mm inside `{other}` at the start of trial {trial}", 1000.0 * depth);
                return Err(source.wrong(&scene.place_of(pair.colliders), why));
            }
        }
    }
    Ok(())
}
