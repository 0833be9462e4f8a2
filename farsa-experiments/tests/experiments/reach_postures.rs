//! The arm is able to do the task: starts clear of the table, postures with the palm down over every sphere, muscles that
//! hold them and come to rest.

use farsa_body::kinematics::KinematicTree;
use farsa_body::ports::{Actuated, ActuatorId, Arrange, BodyId, Joints, World as _};
use farsa_body::robot::Shape;
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::{Pose, Twist};
use farsa_experiments::reach_grasp_lift::{Config, Scene, Statics, TRIALS};
use farsa_lab::EpisodeId;
use farsa_physics::articulated::{Model, World};

/// The lowest point of arm and hand at joint positions [m].
fn lowest(scene: &Scene, tree: &KinematicTree, joints: &[f64]) -> f64 {
    let poses = tree.poses(joints);
    let mut lowest = f64::INFINITY;
    for collider in &scene.robot.colliders {
        let Some(body) = collider.body.filter(|body| *body != Tabletop::SPHERE) else { continue };
        let pose = poses[body.index()].compose(&collider.placement);
        let bottom = match collider.shape {
            Shape::Capsule { radius, half_length } => [-half_length, half_length]
                .map(|z| pose.transform([0.0, 0.0, z])[2] - radius)
                .into_iter()
                .fold(f64::INFINITY, f64::min),
            Shape::Box { half } => {
                let down = pose.rotate_back([0.0, 0.0, 1.0]);
                pose.position[2] - (0..3).map(|k| down[k].abs() * half[k]).sum::<f64>()
            }
            other => panic!("no {other:?} on the arm"),
        };
        lowest = lowest.min(bottom);
    }
    lowest
}

#[test]
fn start_poses_are_clear_of_the_table() {
    let scene = Scene::new(Config { joint_displacement: 0.0, ..Config::default() }).expect("a scene");
    let displaced = Scene::new(Config::default()).expect("a scene");
    let tree = KinematicTree::new(&scene.robot).expect("a tree");
    for trial in 0..TRIALS as u32 {
        let clearance = lowest(&scene, &tree, &scene.start(EpisodeId { trial, ..EpisodeId::default() }).0);
        let mut worst = f64::INFINITY;
        for generation in 0..500 {
            let id = EpisodeId { seed: 1, generation, individual: 0, trial };
            worst = worst.min(lowest(&displaced, &tree, &displaced.start(id).0));
        }
        println!("start {}: {:.1} mm above the table, displaced {:.1} mm", trial + 1, 1e3 * clearance, 1e3 * worst);
        assert!(worst > 0.0);
    }
}

/// Postures with the palm down, 5 cm above the sphere, for every start of the sphere and the corners of its displacement.
fn postures(scene: &Scene, statics: &Statics) -> Vec<([f64; 2], Vec<f64>)> {
    let mut postures = Vec::new();
    for trial in 0..TRIALS {
        let [x, y] = scene.config.sphere_start(trial);
        for dx in [-0.015, 0.0, 0.015] {
            for dy in [-0.015, 0.0, 0.015] {
                let place = [x + dx, y + dy];
                let height = scene.config.sphere_radius + 0.05;
                postures
                    .push((place, statics.above(place, height).unwrap_or_else(|error| panic!("{place:?}: {error}"))));
            }
        }
    }
    postures
}

#[test]
fn a_posture_exists_over_every_start_of_the_sphere() {
    let scene = Scene::new(Config::default()).expect("a scene");
    let statics = Statics::new(&scene).expect("statics");
    let tree = statics.tree();
    for (place, joints) in postures(&scene, &statics) {
        // Judged by the poses alone.
        let palm = tree.poses(&joints)[ArmAndHand::PALM.index()];
        let centre = palm.transform(scene.arm.palm_centre);
        let miss = (0..3).map(|k| centre[k] - [place[0], place[1], 0.075][k]).map(|d| d * d).sum::<f64>().sqrt();
        assert!(miss < 1e-3, "{place:?} is missed by {miss} m");
        let down = -palm.rotate(ArmAndHand::PALM_NORMAL)[2];
        // cos 2 deg = 0.99939
        assert!(down > 0.999_391, "the palm over {place:?} is not down: {down}");
        for (q, [low, high]) in joints.iter().zip(tree.ranges()) {
            assert!(low <= q && q <= high);
        }
    }
}

/// Speeds of the pushed joints after a second [rad/s] and how far the arm has moved [rad].
fn after_a_push(scene: &Scene, joints: &[f64], commands: &[[f64; 2]; 7], pushed: impl Fn(usize) -> f32) -> [f32; 2] {
    let mut world = World::new(Model::<f32>::new(&scene.robot, &scene.config.options()).expect("a model"));
    world.clear();
    for (i, joint) in ArmAndHand::joints().into_iter().enumerate() {
        world.place_joint(joint, joints[i] as f32, pushed(i));
    }
    // The sphere out of the way: it is not asked about.
    world.place_body(Tabletop::SPHERE, Pose::at([0.48, 0.2, 0.025]), Twist::default());
    world.finish_placement();
    for (i, command) in commands.iter().enumerate() {
        world.command(ActuatorId(i as u16), command.map(|a| a as f32));
    }
    for (i, joint) in joints.iter().enumerate().take(27).skip(7) {
        world.command(ActuatorId(i as u16), [*joint as f32, 0.0]);
    }
    for _ in 0..100 {
        world.step();
    }
    let joints = ArmAndHand::joints().into_iter().enumerate().map(|(i, joint)| {
        [world.speed(joint).abs(), if i < 7 { (world.position(joint) - joints[i] as f32).abs() } else { 0.0 }]
    });
    joints.fold([0.0; 2], |most: [f32; 2], now: [f32; 2]| [most[0].max(now[0]), most[1].max(now[1])])
}

#[test]
fn muscles_hold_the_postures_and_come_to_rest() {
    let scene = Scene::new(Config::default()).expect("a scene");
    let statics = Statics::new(&scene).expect("statics");
    // All joints at once, and one alone.
    let (mut most, mut fastest, mut alone, mut farthest) = (0.0_f64, 0.0_f32, 0.0_f32, 0.0_f32);
    for (place, mut joints) in postures(&scene, &statics) {
        // The hand half closed: clear of its limits, so that a push moves it.
        for joint in ArmAndHand::flexion_joints() {
            joints[joint.index()] = -0.3;
        }
        let torques = statics.gravity_torques(&joints);
        let (commands, reached) = statics.activations(&joints, &torques);
        assert!(reached, "the muscles are too weak over {place:?}");
        most = commands.iter().flatten().fold(most, |most, a| most.max(*a));
        for only in (0..7).map(Some).chain([None]) {
            let pushed = |i: usize| if only.is_none_or(|only| only == i) { 0.1 } else { 0.0 };
            for sign in [1.0, -1.0] {
                let [speed, moved] = after_a_push(&scene, &joints, &commands, |i| sign * pushed(i));
                if only.is_none() {
                    fastest = fastest.max(speed);
                } else {
                    alone = alone.max(speed);
                }
                farthest = farthest.max(moved);
            }
        }
    }
    println!(
        "largest activation {most:.3}; 1 s after a push of all joints at most {fastest:.4} rad/s, of one {alone:.4}"
    );
    println!("moved by at most {farthest:.3} rad");
    assert!(most <= 0.75, "activation {most}");
    assert!(fastest < 0.01, "{fastest} rad/s");
    // J1 alone, with the arm stretched to the far sphere, swings back: 0.011 rad/s after 1 s, 0.008 after 1.2 s.
    assert!(alone < 0.012, "{alone} rad/s");
}

#[test]
fn the_body_is_the_palm() {
    let scene = Scene::new(Config::default()).expect("a scene");
    assert_eq!(scene.robot.body("palm"), Some(ArmAndHand::PALM));
    assert_eq!(scene.robot.body("sphere"), Some(Tabletop::SPHERE));
    assert_eq!(scene.robot.body("sphere"), Some(BodyId(27)));
}
