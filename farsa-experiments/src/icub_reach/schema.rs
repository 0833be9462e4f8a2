//! The names of the channels recorded in `icub-reach`.

use farsa_body::Recorder;
use farsa_body::ports::{Contacts, Handles, PairId};
use farsa_lab::advanced::seconds;
use farsa_view::{Channel, Links, NodeParameters, Schema};

use crate::icub_reach::config::{Condition, Config, INPUTS, MOTORS};
use crate::icub_reach::episode::{ReachEpisode, ReachingWorld};
use crate::icub_reach::network::{Agent, HIDDEN, HIDDEN_ONES};
use crate::icub_reach::scene::{CONTROLLED, Scene};

/// The names of the sensory neurons.
pub(crate) fn sensors(config: &Config) -> [&'static str; INPUTS] {
    match config.condition {
        Condition::Steady => ["target x", "target y", "target z"],
        Condition::Velocity => ["way x", "way y", "way z"],
    }
}

/// The schema of episodes in a scene.
pub(crate) fn schema(scene: &Scene) -> Schema {
    let mut schema = Schema::from_robot(&scene.robot).with_sensors(sensors(&scene.config)).with_outputs(CONTROLLED);
    let least = if scene.config.condition == Condition::Velocity { -1.0 } else { 0.0 };
    schema.sensors.iter_mut().for_each(|channel| channel.range = Some([least, 1.0]));
    schema.outputs.iter_mut().for_each(|channel| channel.range = Some([0.0, 1.0]));
    let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
    let joints = CONTROLLED.into_iter().zip(scene.ranges());
    let joints = joints.map(|(name, [low, high])| in_group("joint")(&format!("{name} [rad]")).range(low, high));
    let places = ["hand x [m]", "hand y [m]", "hand z [m]", "target x [m]", "target y [m]", "target z [m]"];
    let scalars = [in_group("fitness")("distance [m]"), in_group("fitness")("fitness so far").range(0.0, 1.0)];
    let [first, second, all] = [INPUTS, INPUTS + HIDDEN, INPUTS + HIDDEN + MOTORS];
    Schema {
        neurons: (1..=HIDDEN).map(|i| in_group("neuron")(&format!("hidden {i}")).range(0.0, 1.0)).collect(),
        scalars: scalars.into_iter().chain(places.map(in_group("place"))).chain(joints).collect(),
        links: vec![
            Links { from: [0, first], to: [first, second], first: 0 },
            Links { from: [first, second], to: [second, all], first: INPUTS * HIDDEN },
        ],
        node_parameters: vec![NodeParameters {
            name: "bias".into(),
            nodes: [first, all],
            first: (INPUTS + MOTORS) * HIDDEN,
        }],
        points: vec!["target".into(), "hand".into()],
        ..schema
    }
}

/// Records a step that has been judged.
pub(crate) fn record<W>(world: &W, episode: &ReachEpisode<Agent>, recorder: &mut dyn Recorder)
where
    W: ReachingWorld + Contacts + Handles + ?Sized,
{
    let scene = episode.scene();
    recorder.sensors(episode.sensed());
    let activations = episode.reacher().network().controller().activations();
    recorder.neurons(&activations[HIDDEN_ONES.first..HIDDEN_ONES.end()]);
    recorder.outputs(episode.done());
    for body in scene.robot.shaped_bodies() {
        recorder.pose(body, world.pose(body));
    }
    let (hand, target) = (episode.hand(), episode.target());
    recorder.point(0, target.map(|x| x as f32));
    recorder.point(1, hand.map(|x| x as f32));
    for pair in (0..world.pairs()).map(|pair| PairId(pair as u16)).filter(|pair| world.touches(*pair)) {
        recorder.contact(pair, &world.pair_contact(pair));
    }
    let mut scalars = [0.0; 2 + 6 + MOTORS];
    let joints = scene.controlled.map(|driven| f64::from(world.position(driven.joint)));
    let values = [episode.totals().last(), episode.fitness()].into_iter().chain(hand).chain(target).chain(joints);
    scalars.iter_mut().zip(values).for_each(|(to, x)| *to = x);
    recorder.scalars(&scalars);
    recorder.tick(seconds(episode.steps(), scene.config.time_step));
}
