//! The names of the channels recorded in `compositional-instructions`.

use farsa_body::ports::{Contacts, Handles, PairId};
use farsa_body::{Pose, Recorder};
use farsa_lab::advanced::seconds;
use farsa_nn::CtrnnParts;
use farsa_nn::block::Span;
use farsa_view::shape::{Geometry, OKABE_ITO, Role, SceneObject};
use farsa_view::{Channel, Links, NodeParameters, Schema, View};

use crate::compositional_instructions::agent::Agent;
use crate::compositional_instructions::episode::InstructionEpisode;
use crate::compositional_instructions::instruction::{Action, Color};
use crate::compositional_instructions::network::{INNER, INPUTS, LAYOUT, LINKED, MOTOR_ONES, NEURONS};
use crate::compositional_instructions::scene::Scene;
use crate::compositional_instructions::senses::{ArmWorld, channel_names};

/// The names of the motor neurons.
pub(crate) const OUTPUTS: [&str; 4] = ["J1 left", "J1 right", "J2 left", "J2 right"];

/// The schema of episodes in a scene.
pub(crate) fn schema(scene: &Scene) -> Schema {
    let mut schema =
        Schema::from_robot(&scene.robot).with_sensors(channel_names(scene.config.condition)).with_outputs(OUTPUTS);
    schema.sensors.iter_mut().for_each(|sensor| sensor.range = Some([0.0, 1.0]));
    schema.outputs.iter_mut().for_each(|motor| motor.range = Some([0.0, 1.0]));
    let names = channel_names(scene.config.condition).into_iter().map(|name| format!("of {name}"));
    let names = names.chain((1..=INNER).map(|number| format!("inner {number}")));
    // Nodes are the sensors, then the neurons.
    let node = |neuron: usize| INPUTS + neuron;
    let (mut first, mut links) = (0, Vec::new());
    for (sources, targets) in LINKED {
        let nodes = |span: Span| [node(span.first), node(span.end())];
        links.push(Links { from: nodes(sources), to: nodes(targets), first });
        first += sources.count * targets.count;
    }
    let of_neurons = ["bias", "gain", "time constant"].into_iter().enumerate().map(|(i, name)| NodeParameters {
        name: name.into(),
        nodes: [node(0), node(NEURONS)],
        first: first + i * NEURONS,
    });
    let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
    let words = Channel::new("action").group("instruction").words(&scene.config.condition.actions().map(Action::word));
    let colors = Channel::new("object").group("instruction").words(&Color::ALL.map(Color::word));
    let joints = ["J1 [rad]", "J2 [rad]"].into_iter().zip(scene.config.arm.ranges);
    let joints = joints.map(|(name, range)| in_group("joint")(name).range(-range.to_radians(), range.to_radians()));
    let moved = Color::ALL.map(|color| format!("{} moved [m]", color.word()));
    let parts = ["find", "act", "undisturbed", "fitness so far"];
    let scalars = [words, colors]
        .into_iter()
        .chain(joints)
        .chain(moved.iter().map(|name| in_group("place")(name)))
        .chain(parts.map(|name| in_group("fitness")(name).range(0.0, 1.0)));
    Schema {
        neurons: names.map(|name| in_group("neuron")(&name).range(0.0, 1.0)).collect(),
        scalars: scalars.collect(),
        links,
        direct_links: (0..INPUTS).map(|input| [input, node(input)]).collect(),
        node_parameters: of_neurons.collect(),
        objects: Color::ALL.map(|color| mark(scene, color)).into(),
        points: vec!["tip".into()],
        view: View::Top,
        ..schema
    }
}

/// A disc under the object of the instruction, which pictures without words show, too.
fn mark(scene: &Scene, color: Color) -> SceneObject {
    let radius = scene.config.objects.radius;
    let disc = Geometry::Disc { radius: 2.0 * radius };
    let mark = SceneObject::new("instruction", disc, Pose::at([0.0, 0.0, 1e-3 - radius]), Role::Area);
    let index = color.index() as f64;
    let shown = mark.on_body(scene.objects[color.index()]).with_color(OKABE_ITO[3]);
    shown.shown_while("object", index - 0.4, index + 0.4)
}

/// Records a step that has been judged.
pub(crate) fn record<W>(world: &W, episode: &InstructionEpisode<Agent>, recorder: &mut dyn Recorder)
where
    W: ArmWorld + Contacts + Handles + ?Sized,
{
    let scene = episode.scene();
    recorder.sensors(episode.sensed());
    recorder.neurons(&episode.controller().network().neuron_outputs()[..MOTOR_ONES.first]);
    recorder.outputs(episode.done());
    for body in scene.robot.shaped_bodies() {
        recorder.pose(body, world.pose(body));
    }
    let length = scene.config.arm.lengths[1] as f32;
    recorder.point(0, world.pose(Scene::SECOND).transform([length, 0.0, 0.0]));
    for pair in (0..world.pairs()).map(|pair| PairId(pair as u16)).filter(|pair| world.touches(*pair)) {
        recorder.contact(pair, &world.pair_contact(pair));
    }
    let (instruction, parts) = (episode.instruction(), episode.parts());
    let moved = episode.totals().last().displaced;
    let [first, second] = Scene::JOINTS.map(|joint| f64::from(world.position(joint)));
    recorder.scalars(&[
        scene.config.condition.channel(instruction.action) as f64,
        instruction.color.index() as f64,
        first,
        second,
        moved[0],
        moved[1],
        moved[2],
        parts.find,
        parts.act,
        parts.undisturbed,
        parts.fitness,
    ]);
    recorder.tick(seconds(episode.steps(), scene.config.time_step));
}

/// The parameters in the order of the schema: weights between the layers, biases, gains, time constants.
pub(crate) fn in_schema_order(parameters: &[f32]) -> Vec<f32> {
    let CtrnnParts { weights, biases, gains, time_constants, .. } = LAYOUT.split(parameters);
    let linked = LINKED.into_iter().flat_map(|(sources, targets)| {
        let row = move |from| (targets.first..targets.end()).map(move |to| weights[from * NEURONS + to]);
        (sources.first..sources.end()).flat_map(row)
    });
    linked.chain([biases, gains, time_constants].into_iter().flatten().copied()).collect()
}
