//! The names of the channels recorded in `reach-grasp-lift`.

use farsa_body::actuators::{Law, MusclePair};
use farsa_body::ports::{BodyId, Contacts, Handles, JointId, Joints, Kinematics, PairId};
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Recorder, Twist};
use farsa_lab::advanced::{NormalizedController, OwnedNetwork};
use farsa_view::{Channel, Schema};

use crate::reach_grasp_lift::episode::ReachEpisode;
use crate::reach_grasp_lift::look;
use crate::reach_grasp_lift::phase::Phase;
use crate::reach_grasp_lift::scene::Scene;

/// The controller's episode in a trial.
pub(crate) type NetworkEpisode = ReachEpisode<NormalizedController<OwnedNetwork>>;

/// Scalars of a tick: phase, 5 rewards, 6 of the judge's, 3 + 7 of palm and sphere, 27 joints. Then 21 of muscles, 17
/// forces, 27 + 6 speeds of joints and sphere.
pub(crate) const SCALARS: usize = 1 + 5 + 6 + 3 + 7 + 27 + 21 + 17 + 27 + 6;

/// Fills the first places of a slice and returns the others.
fn put<const N: usize>(places: &mut [f64], values: [f64; N]) -> &mut [f64] {
    match places.split_first_chunk_mut::<N>() {
        Some((to, rest)) => {
            *to = values;
            rest
        }
        None => &mut [],
    }
}

/// The pairs of the sphere with the phalanges, the palm and the table.
fn on_sphere(scene: &Scene) -> impl Iterator<Item = PairId> {
    scene.sphere_on_phalanges.into_iter().chain([scene.sphere_on_palm, scene.sphere_on_table])
}

/// Labels in pages of the groups of servos that follow one output.
const GROUP_LABELS: [(&str, &str); 5] = [
    ("J10 J11", "thumb outer"),
    ("J14 J15", "index outer"),
    ("J18 J19", "middle outer"),
    ("J12 J16 J20 J24", "finger abduction"),
    ("J21-J23 J25-J27", "ring and little"),
];

/// Names of the rewards and of what is judged, labels and explanations in pages.
const JUDGED: [(&str, &str, &str); 11] = [
    ("reward.reach", "", "reward of this step in the reach phase"),
    ("reward.grasp", "", "reward of this step in the grasp phase"),
    ("reward.lift", "", "reward of this step in the lift phase"),
    ("reward.bonus", "", "bonus for the phase reached, 300 for grasp and 600 for lift, at the end of the trial"),
    ("reward so far", "", "sum of all rewards of the trial, with its bonus at the end"),
    ("ds [cm]", "palm to target", "distance ds from the palm's center to the point 5 cm above the sphere's center"),
    (
        "graspQ [cm]",
        "grasp to sphere",
        "distance graspQ from the centroid of fingertips and palm to the sphere's center",
    ),
    ("fOpen", "open hand", "mean openness fOpen of the 15 flexion joints, 0 closed, 1 extended"),
    ("pRot", "palm down", "cosine pRot of the angle between the palm's direction and down, 1 down, -1 up"),
    ("height [cm]", "", "height of the sphere's center above the table"),
    ("contacts", "", "number of phalanges that touch the sphere"),
];

/// Labels in pages of the channels of joints, muscles and groups of servos.
fn labels() -> Vec<(String, &'static str)> {
    let groups = GROUP_LABELS.map(|(name, label)| (name.into(), label)).into_iter();
    let muscles = (1..).zip(ArmAndHand::muscle_labels()).flat_map(|(n, [agonist, antagonist])| {
        [(format!("J{n} agonist"), agonist), (format!("J{n} antagonist"), antagonist)]
    });
    let joints = (1..).zip(ArmAndHand::joint_labels()).map(|(n, label)| (format!("J{n}"), label));
    groups.chain(muscles).chain(joints).collect()
}

/// Records the steps of an episode, and names what it records.
pub(crate) struct EpisodeRecorder {
    /// The arm's muscles, for their lengths and torques.
    muscles: Vec<MusclePair<f32>>,
    /// Bodies that have a shape, except for the palm and the sphere.
    other_bodies: Vec<BodyId>,
}

impl EpisodeRecorder {
    /// A recorder of episodes in this scene.
    pub(crate) fn new(scene: &Scene) -> Self {
        let laws = scene.robot.actuators.iter().map(|actuator| actuator.law.cast::<f32>());
        let muscles = laws.map_while(|law| if let Law::MusclePair(pair) = law { Some(pair) } else { None }).collect();
        let named = [Tabletop::SPHERE, ArmAndHand::PALM];
        let other_bodies = scene.robot.shaped_bodies().filter(|body| !named.contains(body)).collect();
        Self { muscles, other_bodies }
    }

    /// The schema of this episode.
    pub(crate) fn schema(episode: &NetworkEpisode) -> Schema {
        let scene = episode.judge().scene();
        let forces = on_sphere(scene).map(|pair| {
            let colliders = scene.robot.pairs[pair.index()].colliders.map(|c| scene.robot.colliders[c].name.as_str());
            let other = if colliders[0] == "sphere" { colliders[1] } else { colliders[0] };
            Channel::new(&format!("force on sphere.{other} [N]")).group("force")
        });
        let phases = Phase::ALL.map(Phase::name);
        let placed = ["palm.x [m]", "palm.y [m]", "palm.z [m]", "sphere.x [m]", "sphere.y [m]", "sphere.z [m]"];
        let turned = ["sphere.qx", "sphere.qy", "sphere.qz", "sphere.qw"];
        let moved = ["sphere.vx [m/s]", "sphere.vy [m/s]", "sphere.vz [m/s]"].into_iter();
        let moved = moved.chain(["sphere.wx [rad/s]", "sphere.wy [rad/s]", "sphere.wz [rad/s]"]);
        let in_group = |group: &'static str| move |name: &str| Channel::new(name).group(group);
        let joints = scene.robot.segments.iter().take(27).enumerate().map(|(i, segment)| {
            let [low, high] = segment.joint.range;
            Channel::new(&format!("J{} [rad]", i + 1)).group("joint").range(low, high)
        });
        let muscles = (1..=7).flat_map(|n| {
            [format!("J{n} agonist length"), format!("J{n} antagonist length"), format!("J{n} torque [N m]")]
        });
        let scalars = core::iter::once(Channel::new("phase").group("phase").words(&phases))
            .chain(JUDGED.map(|(name, label, about)| in_group("fitness")(name).labelled(label).about(about)))
            .chain(placed.into_iter().map(in_group("place")))
            .chain(
                turned
                    .into_iter()
                    .map(|name| in_group("place")(name).about("component of the unit quaternion of its rotation")),
            )
            .chain(joints)
            .chain(muscles.map(|name| in_group("actuator")(&name)))
            .chain(forces)
            .chain((1..=27).map(|n| in_group("speed")(&format!("J{n} [rad/s]"))))
            .chain(moved.map(|name| {
                let about = if name.contains(".w") { "angular velocity about an axis of the world" } else { "" };
                in_group("speed")(name).about(about)
            }))
            .collect();
        let mut schema = Schema::from_robot(&scene.robot)
            .with_sensors(episode.senses().names())
            .with_outputs(scene.output_names(episode.motors()))
            .with_network(&scene.config.layout());
        schema.outputs.iter_mut().for_each(|output| output.range = Some([0.0, 1.0]));
        let schema = Schema {
            scalars,
            objects: look::parts(&scene.arm),
            points: ["palm's target", "palm's centre", "centre of the grasp"].map(String::from).into(),
            ..schema
        };
        schema.with_labels(&labels())
    }

    /// Records what was sensed, computed and done before the step that has just been judged, and what it led to.
    pub(crate) fn record<W>(&self, world: &W, episode: &NetworkEpisode, recorder: &mut dyn Recorder)
    where
        W: Kinematics + Joints + Contacts + Handles<Body = BodyId, Joint = JointId>,
    {
        let (judge, scene) = (episode.judge(), episode.judge().scene());
        let (trial, seen, earned) = (judge.trial(), judge.seen(), judge.earned());
        recorder.sensors(episode.sensed());
        recorder.neurons(episode.controller().controller().hidden());
        recorder.outputs(episode.done());
        let (sphere, palm) = (world.pose(Tabletop::SPHERE), world.pose(ArmAndHand::PALM));
        recorder.pose(Tabletop::SPHERE, sphere);
        recorder.pose(ArmAndHand::PALM, palm);
        self.other_bodies.iter().for_each(|body| recorder.pose(*body, world.pose(*body)));
        recorder.point(0, [sphere.position[0], sphere.position[1], sphere.position[2] + 0.05]);
        recorder.point(1, seen.palm.map(|x| x as f32));
        recorder.point(2, seen.grasp_centre.map(|x| x as f32));
        let mut forces = [0.0; 17];
        for pair in (0..world.pairs()).map(|pair| PairId(pair as u16)).filter(|pair| world.touches(*pair)) {
            let contact = world.pair_contact(pair);
            recorder.contact(pair, &contact);
            if let Some(at) = on_sphere(scene).position(|other| other == pair) {
                forces[at] = f64::from(contact.normal_force);
            }
        }

        let mut scalars = [0.0; SCALARS];
        let rest = scalars.as_mut_slice();
        let rest = put(rest, [trial.phase.index() as f64]);
        let rest = put(rest, [earned.reach, earned.grasp, earned.lift, trial.rewards.bonus, trial.rewards.total()]);
        let rest = put(rest, [seen.reach_distance, seen.grasp_distance, seen.openness, seen.palm_down, seen.height]);
        let rest = put(rest, [f64::from(seen.contacts)]);
        let rest = put(rest, palm.position.map(f64::from));
        let rest = put(rest, sphere.position.map(f64::from));
        let rest = put(rest, sphere.rotation.map(f64::from));
        let joints = ArmAndHand::joints();
        let (positions, speeds) = (joints.map(|joint| world.position(joint)), joints.map(|joint| world.speed(joint)));
        let mut rest = put(rest, positions.map(f64::from));
        let driven = positions.into_iter().zip(speeds).zip(episode.done().chunks_exact(2));
        for (muscle, ((q, qdot), done)) in self.muscles.iter().zip(driven) {
            let torque = muscle.effort(q, qdot, [done[0], done[1]]).torque;
            let [agonist, antagonist] = muscle.lengths(q);
            rest = put(rest, [agonist, antagonist, torque].map(f64::from));
        }
        let rest = put(rest, forces);
        let rest = put(rest, speeds.map(f64::from));
        let Twist { linear, angular } = world.velocity(Tabletop::SPHERE);
        let rest = put(put(rest, linear.map(f64::from)), angular.map(f64::from));
        debug_assert!(rest.is_empty(), "{} scalars are missing", rest.len());
        recorder.scalars(&scalars);
        // Rounded to the nanosecond: 201 steps of 0.01 s print as 2.01.
        recorder.tick((f64::from(trial.steps) * scene.config.time_step * 1e9).round() / 1e9);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use farsa_lab::Task as _;

    use crate::reach_grasp_lift::config::Config;
    use crate::reach_grasp_lift::experiment::evaluator;

    #[test]
    fn joints_muscles_and_servos_have_labels_and_nothing_else() {
        let schema = evaluator(Config::default()).unwrap().info().schema;
        let all = [&schema.scalars, &schema.sensors, &schema.neurons, &schema.outputs].into_iter().flatten();
        let mut shown = BTreeSet::new();
        let mut labelled = 0;
        for channel in all {
            let numbered =
                channel.name.strip_prefix('J').is_some_and(|rest| rest.starts_with(|c: char| c.is_numeric()));
            let judged = ["ds", "graspQ", "fOpen", "pRot"].contains(&channel.name.as_str());
            assert_eq!(numbered || judged, !channel.label.is_empty(), "{channel:?}");
            let turns = ["sphere.q", "sphere.w"].iter().any(|start| channel.name.starts_with(start));
            assert_eq!(channel.group == "fitness" || turns, !channel.about.is_empty(), "{channel:?}");
            assert!(!channel.label.contains(char::is_numeric), "{channel:?}");
            let text = if numbered { &channel.label } else { &channel.name };
            assert!(shown.insert((&channel.group, text)), "{channel:?} is in its group twice");
            labelled += usize::from(numbered);
        }
        // Joints and speeds, lengths and torques, sensors, outputs.
        assert_eq!(labelled, 2 * 27 + 21 + 17 + 23);
        let label = |name: &str| schema.outputs.iter().find(|output| output.name == name).unwrap().label.as_str();
        assert_eq!(
            [label("J4 agonist"), label("J10 J11"), label("J13")],
            ["elbow flexor", "thumb outer", "index proximal"]
        );
    }
}
