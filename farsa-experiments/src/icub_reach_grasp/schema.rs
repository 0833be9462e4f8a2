//! The names of the channels recorded in `icub-reach-grasp`.

use farsa_body::Recorder;
use farsa_body::ports::{PairId, Vision};
use farsa_body::robot::Robot;
use farsa_body::sensors::Camera;
use farsa_lab::advanced::seconds;
use farsa_view::{Channel, Schema};

use crate::icub_reach_grasp::agent::Agent;
use crate::icub_reach_grasp::episode::{GraspEpisode, GraspingWorld};
use crate::icub_reach_grasp::motors::Motors;
use crate::icub_reach_grasp::scene::Scene;
use crate::icub_reach_grasp::senses::Senses;

/// The recorded scalars.
const SCALARS: [(&str, &str); 13] = [
    ("fitness", "nearness so far"),
    ("fitness", "touch so far"),
    ("fitness", "lift so far"),
    ("judged", "distance [m]"),
    ("judged", "height [m]"),
    ("judged", "touching parts"),
    ("judged", "opposition"),
    ("place", "palm x [m]"),
    ("place", "palm y [m]"),
    ("place", "palm z [m]"),
    ("place", "ball x [m]"),
    ("place", "ball y [m]"),
    ("place", "ball z [m]"),
];

/// Explanations of the first sensors in pages.
const OFFSETS: [&str; 2] = [
    "offset dx of the ball from the hand to the left in the left eye's image, in widths of the image",
    "offset dy of the ball from the hand upwards in the left eye's image, in widths of the image",
];
/// Explanation of a judged quantity in pages.
const OPPOSITION: &str =
    "(1 - cos) / 2 of the widest angle between two parts that touch the ball, 1 for opposite sides";

/// Columns and rows of the left eye's image. It is recorded but not visible to the agent.
pub(crate) const IMAGE: [usize; 2] = [32, 24];

/// The schema of episodes in a scene.
pub(crate) fn schema(scene: &Scene) -> Schema {
    let schema = Schema::from_robot(&scene.robot).with_sensors(Senses::names()).with_outputs(Motors::names());
    let mut schema = schema.with_network(&scene.config.layout()).with_image("left eye", IMAGE);
    schema.sensors[..2].iter_mut().for_each(|channel| channel.range = Some([-1.0, 1.0]));
    schema.sensors[2..].iter_mut().chain(&mut schema.outputs).for_each(|channel| channel.range = Some([0.0, 1.0]));
    for (channel, about) in schema.sensors.iter_mut().zip(OFFSETS) {
        about.clone_into(&mut channel.about);
    }
    let scalars = SCALARS.into_iter().map(|(group, name)| {
        let about = if name == "opposition" { OPPOSITION } else { "" };
        Channel::new(name).group(group).about(about)
    });
    let scalars = scalars.collect();
    Schema { scalars, points: vec!["palm's centre".into()], ..schema }
}

/// Records a step that has been judged, and what the left eye sees after it.
pub(crate) fn record<W>(world: &W, episode: &GraspEpisode<Agent>, eye: &Camera, recorder: &mut dyn Recorder)
where
    W: GraspingWorld + Vision + ?Sized,
{
    let (scene, seen) = (episode.scene(), episode.seen());
    recorder.sensors(episode.sensed());
    recorder.neurons(episode.grasper().network().controller().hidden());
    recorder.outputs(episode.done());
    for body in Robot::shaped_bodies(&scene.robot) {
        recorder.pose(body, world.pose(body));
    }
    let mut eye = eye.clone();
    eye.look(world);
    eye.record(0, recorder);
    recorder.point(0, seen.palm.map(|x| x as f32));
    for pair in (0..world.pairs()).map(|pair| PairId(pair as u16)).filter(|pair| world.touches(*pair)) {
        recorder.contact(pair, &world.pair_contact(pair));
    }
    let mut scalars = [0.0; SCALARS.len()];
    let judged = [seen.distance, seen.height, f64::from(seen.touching), seen.opposition];
    let values = episode.terms().into_iter().chain(judged).chain(seen.palm).chain(seen.ball);
    scalars.iter_mut().zip(values).for_each(|(to, x)| *to = x);
    recorder.scalars(&scalars);
    recorder.tick(seconds(episode.score().steps, scene.config.time_step));
}
