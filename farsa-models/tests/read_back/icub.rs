//! The iCub, whole and with rigid chains, is the same robot after it was written and read.

use farsa_body::kinematics::KinematicTree;
use farsa_body::robot::{Robot, Visual};
use farsa_body::robots::{Chain, Icub};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_models::urdf;
use farsa_num::{Domain, Stream};

use crate::read;

/// The largest difference of poses, by the segments' names, at random joint positions given by the joints' names.
fn off(written: &Robot, back: &Robot, label: &str) -> f64 {
    assert_eq!(back.segments.len(), written.segments.len(), "{label}");
    let trees = [written, back].map(|robot| KinematicTree::new(robot).unwrap());
    let mut worst = 0.0_f64;
    for draw in 0..50 {
        let mut stream = Stream::new(1, Domain::Sensor, draw, 0, 0);
        let q: Vec<f64> = trees[0].ranges().iter().map(|[low, high]| stream.range_f64(*low, *high)).collect();
        let mut theirs = vec![0.0; q.len()];
        for (joint, angle) in trees[0].joints().iter().zip(&q) {
            let name = &written.segments[joint.index()].joint.name;
            let there = back.joint(name).unwrap_or_else(|| panic!("{label}: no joint {name}"));
            theirs[trees[1].coordinate(there).unwrap()] = *angle;
        }
        let poses = [trees[0].poses(&q), trees[1].poses(&theirs)];
        for (i, segment) in written.segments.iter().enumerate() {
            let j = back.body(&segment.name).unwrap_or_else(|| panic!("{label}: no segment {}", segment.name)).index();
            for point in [[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], segment.centre] {
                let theirs = if point == segment.centre { back.segments[j].centre } else { point };
                let ends = [poses[0][i].transform(point), poses[1][j].transform(theirs)];
                worst = (0..3).fold(worst, |most, k| most.max((ends[0][k] - ends[1][k]).abs()));
            }
            assert!((segment.mass - back.segments[j].mass).abs() < 1e-12, "{label}: {}", segment.name);
        }
    }
    worst
}

/// The visuals of each segment, in their order, are the same but for the last digits of turns.
fn same_looks(written: &Robot, back: &Robot, label: &str) {
    let of = |robot: &Robot, name: &str| -> Vec<Visual> {
        let on = |visual: &&Visual| visual.body.is_some_and(|body| robot.segments[body.index()].name == name);
        robot.visuals.iter().filter(on).copied().collect()
    };
    assert_eq!(back.visuals.len(), written.visuals.len(), "{label}");
    for segment in &written.segments {
        let pairs = of(written, &segment.name).into_iter().zip(of(back, &segment.name));
        for (ours, theirs) in pairs {
            assert_eq!((ours.shape, ours.color), (theirs.shape, theirs.color), "{label}: {}", segment.name);
            for point in [[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]] {
                let ends = [ours, theirs].map(|visual| visual.placement.transform(point));
                assert!((0..3).all(|k| (ends[0][k] - ends[1][k]).abs() < 1e-14), "{label}: {}", segment.name);
            }
        }
    }
}

#[test]
fn the_icub_is_read_as_it_was_written() {
    let sets: [&[Chain]; 4] = [
        &Chain::ALL,
        &[Chain::Torso, Chain::LeftArm],
        &[Chain::Neck, Chain::RightArm, Chain::RightHand],
        &[Chain::LeftHand],
    ];
    for actuated in sets {
        let icub = Icub { actuated: actuated.to_vec(), root: [0.1, -0.2, 0.6], ..Icub::default() };
        let robot = icub.robot().unwrap();
        let texts =
            [("MJCF", mjcf::write(&robot, &MjcfOptions::default()).unwrap()), ("URDF", urdf::write(&robot).unwrap())];
        for (kind, text) in texts {
            let back = read(&text).unwrap().robot;
            let label = format!("{kind} {actuated:?}");
            let worst = off(&robot, &back, &label);
            println!("{label}: {worst:.1e} m");
            assert!(worst < 1e-12, "{label}: {worst} m");
            assert_eq!(back.colliders.len(), robot.colliders.len(), "{label}");
            same_looks(&robot, &back, &label);
            let joints: Vec<_> = robot.joints().map(|joint| robot.segments[joint.index()].joint.clone()).collect();
            for joint in joints {
                let there = back.joint(&joint.name).unwrap();
                assert_eq!(back.segments[there.index()].joint.range, joint.range, "{label}: {}", joint.name);
            }
        }
        let back = read(&mjcf::write(&robot, &MjcfOptions::default()).unwrap()).unwrap().robot;
        assert_eq!((back.pairs.len(), back.actuators.len()), (robot.pairs.len(), robot.actuators.len()));
    }
}
