//! Our recursive dynamics against Pinocchio's and MuJoCo's (fixtures/make.py), and against each other.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Joint, JointKind, Robot, Segment};
use farsa_physics::articulated::{
    Model, Options, Scratch, accelerations, centre_of_mass, inverse_dynamics, jacobian, kinetic_energy, mass_matrix,
    potential_energy,
};
use serde::Deserialize;
use serde::de::DeserializeOwned;

#[derive(Deserialize)]
struct Body {
    name: String,
    parent: i64,
    joint: String,
    axis: [f64; 3],
    position: [f64; 3],
    rotation: [f64; 4],
    mass: f64,
    centre: [f64; 3],
    inertia: [f64; 6],
    armature: f64,
}

#[derive(Deserialize)]
struct State {
    q: Vec<f64>,
    v: Vec<f64>,
    tau: Vec<f64>,
    acceleration_pinocchio: Vec<f64>,
    acceleration_mujoco: Vec<f64>,
    bias: Vec<f64>,
}

#[derive(Deserialize)]
struct Matrices {
    state: usize,
    mass_matrix: Vec<f64>,
    tip_jacobian: Vec<f64>,
    tip_position: [f64; 3],
    kinetic_energy: f64,
    potential_energy: f64,
    centre_of_mass: [f64; 3],
}

#[derive(Deserialize)]
pub(crate) struct Fixture {
    gravity: [f64; 3],
    bodies: Vec<Body>,
    states: Vec<State>,
    matrices: Vec<Matrices>,
    tip_body: u16,
}

pub(crate) fn read<T: DeserializeOwned>(name: &str) -> T {
    let path = format!("{}/tests/fixtures/{name}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap()
}

/// The robot of a fixture, and its gravity.
pub(crate) fn robot(name: &str, fixture: &Fixture) -> (Robot, [f64; 3]) {
    let segments = fixture
        .bodies
        .iter()
        .map(|b| Segment {
            name: b.name.clone(),
            parent: u16::try_from(b.parent).ok().map(BodyId),
            joint: Joint {
                name: format!("{}_joint", b.name),
                kind: match b.joint.as_str() {
                    "revolute" => JointKind::Revolute,
                    "prismatic" => JointKind::Prismatic,
                    _ => JointKind::Fixed,
                },
                axis: b.axis,
                range: [f64::NEG_INFINITY, f64::INFINITY],
                armature: b.armature,
                ..Joint::fixed(Pose { position: b.position, rotation: unit(b.rotation) })
            },
            mass: b.mass,
            centre: b.centre,
            inertia: b.inertia,
        })
        .collect();
    (Robot { name: name.into(), segments, ..Robot::default() }, fixture.gravity)
}

fn load(name: &str) -> (Fixture, Model<f64>) {
    let fixture: Fixture = read(name);
    let (robot, gravity) = robot(name, &fixture);
    let model = Model::new(&robot, &Options { gravity, ..Options::default() }).unwrap();
    (fixture, model)
}

fn unit(q: [f64; 4]) -> [f64; 4] {
    let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / n)
}

/// max |a - b| / max |b|
pub(crate) fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let top = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0_f64, |m, (x, y)| m.max((x - y).abs())) / top
}

fn agrees(name: &str) {
    let (fixture, model) = load(name);
    let n = model.dofs();
    assert!(fixture.states.len() >= 100);
    let mut scratch = Scratch::new((), &model);
    let armature: Vec<f64> = fixture.bodies.iter().filter(|b| b.joint != "fixed").map(|b| b.armature).collect();
    let (mut pinocchio, mut mujoco, mut bias, mut inverse, mut matrix) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for state in &fixture.states {
        let mut qdd = vec![0.0; n];
        let both = [state.q.clone(), state.v.clone()].concat();
        scratch.forward_kinematics((), &model, &both);
        let (work, roots) = scratch.parts();
        accelerations((), model.links(), model.gravity(), &state.tau, &armature, work, roots, &mut qdd);
        pinocchio = pinocchio.max(difference(&qdd, &state.acceleration_pinocchio));
        mujoco = mujoco.max(difference(&qdd, &state.acceleration_mujoco));
        // The efforts of Pinocchio's accelerations are those that it was given. And so are M qdd and the bias together.
        let (mut tau, mut inertia) = (vec![0.0; n], vec![0.0; n * n]);
        inverse_dynamics((), model.links(), model.gravity(), &state.acceleration_pinocchio, work, &mut tau);
        inverse = inverse.max(difference(&tau, &state.tau));
        mass_matrix((), model.links(), work, &mut inertia);
        let rows = inertia.chunks(n).zip(&state.bias);
        let sum = |row: &[f64]| row.iter().zip(&state.acceleration_pinocchio).map(|(m, a)| m * a).sum::<f64>();
        let efforts: Vec<f64> = rows.map(|(row, bias)| sum(row) + bias).collect();
        matrix = matrix.max(difference(&efforts, &state.tau));
        inverse_dynamics((), model.links(), model.gravity(), &vec![0.0; n], work, &mut tau);
        bias = bias.max(difference(&tau, &state.bias));
    }
    println!("{name}: accelerations to Pinocchio {pinocchio:.1e}, to MuJoCo {mujoco:.1e}; bias {bias:.1e}");
    println!("{name}: efforts of Pinocchio's accelerations {inverse:.1e}, by the mass matrix {matrix:.1e}");
    assert!(pinocchio <= 1e-10 && mujoco <= 1e-10 && bias <= 1e-10 && inverse <= 1e-10 && matrix <= 1e-10);
    for m in &fixture.matrices {
        let state = &fixture.states[m.state];
        scratch.forward_kinematics((), &model, &[state.q.clone(), state.v.clone()].concat());
        let mut matrix = vec![0.0; n * n];
        let work = scratch.links();
        mass_matrix((), model.links(), work, &mut matrix);
        let lower: Vec<f64> = (0..n).flat_map(|i| matrix[i * n..=i * n + i].to_vec()).collect();
        assert!(difference(&lower, &m.mass_matrix) <= 1e-10);
        let kinetic = kinetic_energy((), model.links(), &state.v, work);
        let potential = potential_energy((), model.links(), model.gravity(), work);
        assert!((kinetic - m.kinetic_energy).abs() <= 1e-10 * m.kinetic_energy);
        assert!((potential - m.potential_energy).abs() <= 1e-10 * m.potential_energy.abs().max(1.0));
        assert!(difference(&centre_of_mass((), model.links(), work), &m.centre_of_mass) <= 1e-10);
        let tip = model.link_of(BodyId(fixture.tip_body)).unwrap();
        let mut j = vec![0.0; 6 * n];
        jacobian((), model.links(), work, tip, m.tip_position, &mut j);
        assert!(difference(&j, &m.tip_jacobian) <= 1e-10);
    }
}

#[test]
fn a_chain_of_seven_joints_agrees_with_pinocchio_and_mujoco() {
    agrees("chain7");
}

#[test]
fn a_tree_of_27_joints_agrees_with_pinocchio_and_mujoco() {
    agrees("tree27");
}
