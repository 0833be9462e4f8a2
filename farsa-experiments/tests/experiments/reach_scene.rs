//! Sensors and motors of the robot, starts and ends of trials.

use std::sync::Arc;

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Channels, Contacts, Handles, JointId, Joints, Kinematics, Motor, Sensor,
    World as _,
};
use farsa_body::robot::Shape;
use farsa_body::robots::{ArmAndHand, Finger, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_experiments::reach_grasp_lift::{Config, Displacement, Judge, Labels, OUTPUTS, Phase, ReachEpisode, Scene};
use farsa_lab::advanced::run_episode;
use farsa_lab::{Episode, EpisodeId};
use farsa_nn::{Controller, LeakyNetwork};
use farsa_physics::articulated::{Model, World};

fn scene(config: Config) -> Arc<Scene> {
    Arc::new(Scene::new(config).expect("a scene"))
}

fn world(scene: &Scene) -> World<f32> {
    World::new(Model::new(&scene.robot, &scene.config.options()).expect("a model"))
}

fn read(scene: &Scene, world: &World<f32>) -> Vec<f32> {
    let mut senses = scene.senses().expect("senses");
    let mut x = vec![f32::NAN; senses.channels()];
    senses.read(world, &mut x);
    x
}

fn near(a: f32, b: f32) -> bool {
    (a - b).abs() < 1e-4
}

#[test]
fn joints_are_sensed_in_their_order_and_scale() {
    let scene = scene(Config::default());
    let mut world = world(&scene);
    world.clear();
    // Every joint at its own fraction of the range, from the lower limit.
    let fraction = |i: usize| 0.2 + 0.02 * i as f32;
    for (i, joint) in ArmAndHand::joints().into_iter().enumerate() {
        let [low, high] = scene.robot.segments[i].joint.range.map(|x| x as f32);
        world.place_joint(joint, low + (high - low) * fraction(i), 0.0);
    }
    world.finish_placement();
    let x = read(&scene, &world);
    assert_eq!(x.len(), 29);
    for i in 0..7 {
        assert!(near(x[i], fraction(i)), "J{} reads {}", i + 1, x[i]);
    }
    // Flexion and opposition count from the upper limit, extended.
    for (channel, number) in [8, 9, 10, 13, 14, 17, 18, 21, 22].into_iter().enumerate() {
        assert!(near(x[7 + channel], 1.0 - fraction(number - 1)), "J{number} reads {}", x[7 + channel]);
    }
    assert!(near(x[16], fraction(15)), "J16 reads {}", x[16]);
    assert_eq!(scene.senses().unwrap().names().len(), 29);
}

#[test]
fn the_sphere_is_sensed_in_the_palms_frame_in_centimetres() {
    let scene = scene(Config::default());
    let mut world = world(&scene);
    world.clear();
    // Elbow and wrist bent, so that the palm's axes are not the world's.
    for (joint, q) in [(0, -0.5), (1, 0.4), (3, -1.0), (5, 0.3)] {
        world.place_joint(JointId(joint), q, 0.0);
    }
    world.finish_placement();
    let palm = world.pose(ArmAndHand::PALM);
    let centre = palm.transform(scene.arm.palm_centre.map(|x| x as f32));
    // 3 cm to the fingertips, 2 to the thumb's side, 6 out of the palm's back.
    let way = palm.rotate([0.03, 0.02, 0.06]);
    world.place_body(Tabletop::SPHERE, Pose::at([0, 1, 2].map(|k| centre[k] + way[k])), Twist::default());
    world.finish_placement();
    let x = read(&scene, &world);
    assert!(near(x[23], 3.0) && near(x[24], 2.0) && near(x[25], 6.0), "{:?}", &x[23..26]);
    let world_axes =
        Scene::new(Config { target_axes: farsa_body::sensors::Axes::World, ..Config::default() }).expect("a scene");
    let x = read(&world_axes, &world);
    assert!((0..3).all(|k| near(x[23 + k], 100.0 * way[k])), "{:?}", &x[23..26]);
}

#[test]
fn labels_name_the_phase_and_only_with_labels() {
    let with = scene(Config::default());
    let world = world(&with);
    let mut senses = with.senses().unwrap();
    let mut x = vec![0.0; 29];
    for (phase, label) in Phase::ALL.into_iter().zip([[50.0, 0.0, 0.0], [0.0, 50.0, 0.0], [0.0, 0.0, 50.0]]) {
        senses.set_label(phase);
        senses.read(&world, &mut x);
        assert_eq!(x[26..], label);
    }
    let without = scene(Config::for_condition(Labels::None));
    let mut senses = without.senses().unwrap();
    assert_eq!(senses.channels(), 26);
    assert_eq!(senses.names().len(), 26);
    senses.set_label(Phase::Lift);
    let mut y = vec![0.0; 26];
    senses.read(&world, &mut y);
    assert_eq!(y, x[..26]);
}

#[test]
fn each_patch_of_skin_feels_its_own_contacts() {
    // One short step: the sphere bounces off within milliseconds.
    let scene = scene(Config { time_step: 0.001, substeps: 1, ..Config::default() });
    let mut world = world(&scene);
    let parts = Finger::ALL.map(|finger| ArmAndHand::phalanges(finger).to_vec());
    for (patch, bodies) in parts.into_iter().chain([vec![ArmAndHand::PALM]]).enumerate() {
        for body in bodies {
            world.clear();
            world.finish_placement();
            // The sphere against the far end of one part from below, a little into it.
            let collider = scene.robot.colliders.iter().find(|c| c.body == Some(body)).expect("a collider");
            let end = match collider.shape {
                Shape::Capsule { half_length, .. } => half_length as f32,
                _ => 0.0,
            };
            let at = world.pose(body).compose(&collider.placement.cast::<f32>()).transform([0.0, 0.0, end]);
            let palm = body == ArmAndHand::PALM;
            let thickness = if palm { 0.010 } else { [0.0065, 0.0060, 0.0055][(body.index() - 8) % 4] };
            let below = [at[0], at[1], at[2] - thickness - 0.0249];
            world.place_body(Tabletop::SPHERE, Pose::at(below), Twist::default());
            world.finish_placement();
            world.step();
            let x = read(&scene, &world);
            assert!(x[17 + patch] > 0.0, "patch {patch} does not feel {body:?}: {:?}", &x[17..23]);
            let pair =
                if palm { scene.sphere_on_palm } else { scene.sphere_on_phalanges[patch * 3 + (body.index() - 8) % 4] };
            assert!(world.pair_contact(pair).points > 0);
            let seen = scene.observe(&world);
            assert_eq!(seen.contacts > 0, seen.on_fingers());
            assert!(palm || seen.contacts > 0);
            assert!(!seen.on_table);
        }
    }
}

/// Stores the commands.
struct Board(Vec<(u16, [f32; 2])>);

impl Handles for Board {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl Actuated for Board {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        self.0.push((actuator.0, value));
    }
}

#[test]
fn outputs_drive_muscles_and_servo_groups() {
    let scene = scene(Config::default());
    let mut motors = scene.motors().unwrap();
    assert_eq!((motors.channels(), motors.names().len()), (OUTPUTS, OUTPUTS));
    let mut board = Board(Vec::new());
    let y: Vec<f32> = (0..23).map(|i| i as f32 / 23.0).collect();
    motors.drive(&y, &mut board);
    for joint in 0..7 {
        assert_eq!(board.0[joint], (joint as u16, [y[2 * joint], y[2 * joint + 1]]));
    }
    let mut servos: Vec<(u16, f32)> = board.0[7..].iter().map(|(id, value)| (*id, value[0].to_degrees())).collect();
    servos.sort_by_key(|(id, _)| *id);
    assert_eq!(servos.len(), 20, "every joint of the hand once");
    let group_of = |number: u16| match number {
        8 => 0,
        9 => 1,
        10 | 11 => 2,
        13 => 3,
        14 | 15 => 4,
        17 => 5,
        18 | 19 => 6,
        12 | 16 | 20 | 24 => 7,
        _ => 8,
    };
    for (id, degrees) in servos {
        let number = id + 1;
        let o = y[14 + group_of(number)];
        let wanted = match number {
            8 => -120.0 * o,
            12 => 15.0 * o,
            16 => 2.0 * (2.0 * o - 1.0),
            20 => -10.0 * o,
            24 => -15.0 * o,
            _ => -90.0 * o,
        };
        assert!((degrees - wanted).abs() < 1e-3, "J{number}: {degrees} instead of {wanted} deg");
    }
}

#[test]
fn starts_are_displaced_within_bounds_and_shared() {
    let shared = scene(Config::default());
    let own = scene(Config { displacement: Displacement::PerIndividual, ..Config::default() });
    let id = EpisodeId { seed: 7, generation: 3, individual: 5, trial: 2 };
    assert_eq!(shared.start(id), shared.start(EpisodeId { individual: 6, ..id }));
    assert_ne!(own.start(id), own.start(EpisodeId { individual: 6, ..id }));
    for other in [EpisodeId { seed: 8, ..id }, EpisodeId { generation: 4, ..id }, EpisodeId { trial: 6, ..id }] {
        assert_ne!(shared.start(id), shared.start(other));
    }
    let (mut largest, mut farthest) = (0.0_f64, 0.0_f64);
    for generation in 0..200 {
        for trial in 0..4 {
            let (joints, sphere) = shared.start(EpisodeId { generation, trial, ..id });
            for (i, q) in joints.iter().enumerate() {
                let pose = if i < 4 { shared.config.arm_poses[4 * trial as usize + i] } else { 0.0 };
                let [low, high] = shared.robot.segments[i].joint.range;
                assert!(low <= *q && *q <= high);
                largest = largest.max((q.to_degrees() - pose).abs());
            }
            let at = shared.config.sphere_start(trial as usize);
            farthest = (0..2).map(|k| (sphere[k] - at[k]).abs()).fold(farthest, f64::max);
        }
    }
    assert!(0.99 < largest && largest <= 1.0 + 1e-9, "{largest} deg");
    assert!(0.0148 < farthest && farthest <= 0.015 + 1e-9, "{farthest} m");
}

#[test]
fn a_world_is_arranged_as_the_start_says() {
    let scene = scene(Config::default());
    let mut world = world(&scene);
    for _ in 0..20 {
        world.step();
    }
    let id = EpisodeId { seed: 1, generation: 2, individual: 0, trial: 3 };
    scene.arrange(&mut world, id);
    let (joints, [x, y]) = scene.start(id);
    for (joint, q) in ArmAndHand::joints().into_iter().zip(joints) {
        assert_eq!((world.position(joint), world.speed(joint)), (q as f32, 0.0));
    }
    assert_eq!(world.pose(Tabletop::SPHERE).position, [x as f32, y as f32, 0.025]);
    let seen = scene.observe(&world);
    assert!((seen.height - 2.5).abs() < 1e-6);
    assert!(!seen.on_fingers());
    // The hand starts extended but for what displacement closes: at most 1 of 90 degrees.
    assert!(seen.openness > 0.988, "{}", seen.openness);
}

#[test]
fn the_first_observation_is_that_of_the_geometry() {
    // Palm down over the far sphere (geometry.md): ds is 0, pRot 1, and the fingertips are straight ahead.
    let scene = scene(Config { joint_displacement: 0.0, sphere_displacement: 0.0, ..Config::default() });
    let mut world = world(&scene);
    scene.arrange(&mut world, EpisodeId { trial: 2, ..EpisodeId::default() });
    let statics = farsa_experiments::reach_grasp_lift::Statics::new(&scene).unwrap();
    let posture = statics.above(scene.config.sphere_start(2), 0.075).unwrap();
    for (joint, q) in ArmAndHand::joints().into_iter().zip(posture) {
        world.place_joint(joint, q as f32, 0.0);
    }
    world.finish_placement();
    let seen = scene.observe(&world);
    assert!(seen.reach_distance < 1e-3, "{}", seen.reach_distance);
    assert!((seen.palm_down - 1.0).abs() < 1e-6);
    assert_eq!(seen.openness, 1.0);
    // By hand, in the palm's frame: tips at x = base + phalanges (thumb .028), y = base (thumb .020 + .010 + .0648), z 0 (thumb
    // -.002). The sphere is 5 cm under the palm's center (.0625, 0, -.010).
    let index = 0.080 + 0.0259 + 0.0220 + 0.0168;
    let middle = 0.080 + 0.0285 + 0.0240 + 0.0168;
    let little = 0.080 + 0.0219 + 0.0190 + 0.0168;
    let x = (0.028 + 2.0 * index + middle + little + 0.0625) / 6.0 - 0.0625;
    let y = (0.020 + 0.010 + 0.0648 + 0.025 + 0.008 - 0.008 - 0.024) / 6.0;
    let z = (-0.002 - 0.010) / 6.0 + 0.060;
    let expected = 100.0 * f64::sqrt(x * x + y * y + z * z);
    assert!((seen.grasp_distance - expected).abs() < 1e-3, "{} instead of {expected}", seen.grasp_distance);
}

#[test]
fn a_sphere_that_falls_ends_the_trial_and_what_was_earned_stays() {
    // Half a meter beyond the table.
    let scene = scene(Config { sphere_positions: [0.0, 90.0, 0.0, 90.0, 0.0, 90.0, 0.0, 90.0], ..Config::default() });
    let mut world = world(&scene);
    let mut judge = Judge::new(Arc::clone(&scene));
    judge.start(&mut world, EpisodeId::default());
    let fitness = loop {
        world.step();
        if let Some(fitness) = judge.judge(&world) {
            break fitness;
        }
    };
    let trial = judge.trial();
    // It falls 2.5 cm: sqrt(2 * 0.025 / 9.81) = 0.0714 s, less half a dynamics step, seen after the seventh step.
    assert_eq!((trial.steps, trial.fallen, trial.phase), (7, true, Phase::Reach));
    assert!(fitness > 0.0 && fitness == trial.rewards.total());
    assert!(!judge.succeeds());
}

#[test]
fn a_world_that_breaks_down_fails_the_trial() {
    let scene = scene(Config::default());
    let mut world = world(&scene);
    let mut judge = Judge::new(Arc::clone(&scene));
    judge.start(&mut world, EpisodeId::default());
    world.place_joint(JointId(3), f32::NAN, 0.0);
    world.finish_placement();
    let fitness = judge.judge(&world).expect("the end");
    assert!(fitness.is_nan());
    assert!(judge.trial().rewards.total().is_nan());
}

/// Returns its inputs: the labels it read.
struct Listener(Vec<[f32; 3]>);

impl Controller for Listener {
    fn inputs(&self) -> usize {
        29
    }
    fn outputs(&self) -> usize {
        OUTPUTS
    }
    fn reset(&mut self) {
        self.0.clear();
    }
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        self.0.push([x[26], x[27], x[28]]);
        y.fill(0.0);
    }
}

#[test]
fn a_controller_steps_once_a_step_and_reads_reach_first() {
    let scene = scene(Config { steps: 50, ..Config::default() });
    let mut world = world(&scene);
    let mut episode = ReachEpisode::new(Arc::clone(&scene), Listener(Vec::new())).expect("an episode");
    let fitness = run_episode(&mut episode, &mut world, EpisodeId::default(), None);
    assert_eq!(episode.judge().trial().steps, 50);
    assert_eq!(episode.controller().0.len(), 50);
    assert_eq!(episode.controller().0[0], [50.0, 0.0, 0.0]);
    assert_eq!(fitness, episode.judge().trial().rewards.total());
    // The same episode again, to the same bits, in a world that has been used.
    assert_eq!(run_episode(&mut episode, &mut world, EpisodeId::default(), None), fitness);
}

/// Returns 0 for motors, and a different value for every label in every step.
struct Speaker {
    /// Label inputs and label outputs of every step.
    steps: Vec<[[f32; 3]; 2]>,
}

impl Controller for Speaker {
    fn inputs(&self) -> usize {
        29
    }
    fn outputs(&self) -> usize {
        OUTPUTS + 3
    }
    fn reset(&mut self) {
        self.steps.clear();
    }
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        let step = self.steps.len() as f32;
        let said = [0.1, 0.2, 0.3].map(|label| label + 0.01 * step);
        self.steps.push([[x[26], x[27], x[28]], said]);
        y.fill(0.0);
        y[OUTPUTS..].copy_from_slice(&said);
    }
}

#[test]
fn own_labels_are_the_outputs_of_the_previous_step() {
    let of_condition = Config { steps: 40, ..Config::for_condition(Labels::Own) };
    for (amplitude, config) in
        [(50.0, of_condition.clone()), (1.0, Config { label_amplitude: 1.0, ..of_condition.clone() })]
    {
        let scene = scene(config);
        let mut world = world(&scene);
        let mut episode = ReachEpisode::new(Arc::clone(&scene), Speaker { steps: Vec::new() }).expect("an episode");
        // Also in a second trial, after the labels of the first.
        for trial in 0..2 {
            run_episode(&mut episode, &mut world, EpisodeId { trial, ..EpisodeId::default() }, None);
            let steps = &episode.controller().steps;
            assert_eq!((steps.len(), steps[0][0]), (40, [0.0; 3]));
            for pair in steps.windows(2) {
                assert_eq!(pair[1][0], pair[0][1].map(|said| amplitude * said));
            }
            assert_eq!(episode.done()[OUTPUTS..], steps[39][1]);
        }
    }
    // The phase does not change them, and they do not change labels that are given.
    for labels in [Labels::Own, Labels::Given] {
        let scene = scene(Config::for_condition(labels));
        let (mut senses, world, mut x) = (scene.senses().unwrap(), world(&scene), vec![f32::NAN; 29]);
        senses.set_own_labels([0.1, 0.2, 0.3]);
        if labels == Labels::Own {
            senses.set_label(Phase::Lift);
        }
        senses.read(&world, &mut x);
        let expected = if labels == Labels::Own { [0.1, 0.2, 0.3].map(|said| 50.0 * said) } else { [50.0, 0.0, 0.0] };
        assert_eq!(x[26..], expected);
    }
}

#[test]
fn a_network_without_outputs_for_its_labels_is_refused() {
    let error = ReachEpisode::new(scene(Config::for_condition(Labels::Own)), Listener(Vec::new()));
    let error = error.err().expect("an error").to_string();
    let expected =
        "reach-grasp-lift: a controller of 29 inputs and 23 outputs for 29 sensors and 23 motors and 3 labels";
    assert_eq!(error, expected);
}

#[test]
fn a_network_of_another_shape_is_refused() {
    let layout = Config::for_condition(Labels::None).layout();
    let network =
        LeakyNetwork::new(layout, farsa_nn::Leak::Filter, vec![0.0; 756], vec![0.0; layout.state_len()]).unwrap();
    let error = ReachEpisode::new(scene(Config::default()), network).unwrap_err().to_string();
    assert_eq!(error, "reach-grasp-lift: a controller of 26 inputs and 23 outputs for 29 sensors and 23 motors");
}

#[test]
fn an_episode_that_is_run_is_the_one_written_out() {
    let scene = scene(Config { steps: 30, ..Config::default() });
    let (mut one, mut two) = (world(&scene), world(&scene));
    let mut episodes =
        [(); 2].map(|()| ReachEpisode::new(Arc::clone(&scene), Listener(Vec::new())).expect("an episode"));
    let id = EpisodeId { trial: 1, ..EpisodeId::default() };
    let [first, second] = &mut episodes;
    let fitness = run_episode(first, &mut one, id, None);
    second.start(&mut two, id);
    let other = loop {
        second.act(&mut two);
        two.step();
        if let Some(fitness) = Episode::judge(second, &mut two) {
            break fitness;
        }
    };
    assert_eq!(fitness.to_bits(), other.to_bits());
    assert_eq!(one.state(), two.state());
}
