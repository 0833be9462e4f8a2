//! Keyframes of exported models.

use farsa_body::ports::{Arrange as _, BodyId, Contacts as _, JointId, PairId, World as _};
use farsa_body::robot::JointKind;
use farsa_body::{Pose, Twist};
use farsa_models::{Imported, ReadOptions};
use farsa_physics::articulated::{Model, Options, World};

use crate::tool::{farsa, ok, say, scratch};

/// Greatest depth of a contact at a keyframe [m].
const DEEPEST: f32 = 1e-3;

/// The depth of the forearm in the waist where all joints of an iCub are at 0 [m]. Its experiments start there.
const FOREARM: f32 = 0.0245;

/// Returns the greatest depth of a contact when a model is in the state of a keyframe.
fn deepest(model: &str, state: &[f64]) -> f32 {
    let robot = Imported::from_text(model, &ReadOptions::default()).expect("a model").robot;
    let instant = Options { time_step: 1e-6, substeps: 1, ..Options::default() };
    let mut world = World::new(Model::<f32>::new(&robot, &instant).expect("a world"));
    let mut numbers = state.iter().map(|x| *x as f32);
    let mut next = || numbers.next().expect("a number");
    // The segments of a read model are in the order of `qpos`.
    for (i, segment) in robot.segments.iter().enumerate() {
        match segment.joint.kind {
            JointKind::Fixed => {}
            JointKind::Floating => {
                let [x, y, z, w, i2, j, k] = [(); 7].map(|()| next());
                let pose = Pose { position: [x, y, z], rotation: [i2, j, k, w] };
                world.place_body(BodyId(i as u16), pose, Twist::default());
            }
            _ => world.place_joint(JointId(i as u16), next(), 0.0),
        }
    }
    assert!(numbers.next().is_none(), "more numbers than joints");
    world.finish_placement();
    world.step();
    let pairs = (0..robot.pairs.len()).map(|pair| PairId(pair as u16)).filter(|pair| world.touches(*pair));
    pairs.map(|pair| world.pair_contact(pair).depth).fold(0.0, f32::max)
}

#[test]
fn every_exported_model_has_a_start_without_deep_contacts() {
    let here = scratch("keyframes");
    let mut models = 0;
    for experiment in farsa_experiments::all() {
        let name = experiment.name();
        let said = say(farsa(), &here, &format!("export robot {name} --format mjcf"));
        if said.err.contains("has no robot to export") {
            continue;
        }
        assert_eq!(said.code, Some(0), "{name}: {said:?}");
        models += 1;
        let states = said.out.lines().filter_map(|line| line.split_once(" qpos=\"")?.1.split_once('"'));
        let states: Vec<Vec<f64>> =
            states.map(|(state, _)| state.split(' ').map(|x| x.parse().expect("a number")).collect()).collect();
        assert!(!states.is_empty(), "{name}: no keyframe");
        for state in states {
            let depth = deepest(&said.out, &state);
            let limit = if name.starts_with("icub-") { FOREARM } else { DEEPEST };
            assert!(depth < limit, "{name}: {depth} m deep at {state:?}");
        }
    }
    assert!(models >= 8, "{models}");
    // The body of a champion also has a start.
    ok(farsa(), &here, "run body-evolution --generations 1 --quiet --out r --set trial.steps=2");
    assert!(ok(farsa(), &here, "export robot r --format mjcf").contains("<key name=\"start\""));
}
