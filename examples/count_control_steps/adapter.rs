//! The cost of the adapter compared with direct calls of rapier, on the same bodies with bit-equal motion.

use std::error::Error;
use std::time::{Duration, Instant};

use farsa::body::ports::{Actuated, ActuatorId, Arrange, BodyId, JointId, World as _};
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::body::{Pose, Twist};
use farsa::num::{Domain, Stream};
use farsa::physics::rapier::{Options, World};
use rapier3d::geometry::SolverFlags;
use rapier3d::math::Vector;
use rapier3d::pipeline::{ContactModificationContext, PairFilterContext, PhysicsHooks, PhysicsWorld};

/// Steps of rapier: 2.5 s of the default 2.5 ms.
const STEPS: usize = 1000;

/// The four joints that the experiment turns at its first start [deg].
const START: [f32; 4] = [-73.0, -30.0, -40.0, -56.0];

/// Commands that change every 50 ms.
fn commands() -> Vec<[[f32; 2]; 27]> {
    let mut stream = Stream::new(1, Domain::Motor, 0, 0, 0);
    let mut held = [[0.0; 2]; 27];
    (0..STEPS)
        .map(|step| {
            if step % 20 == 0 {
                held = held.map(|_| [stream.uniform(), stream.uniform()]);
            }
            held
        })
        .collect()
}

/// Inputs of a step of rapier: spring and damping of every joint, the torque on the sphere.
struct Told {
    springs: [[f32; 3]; 27],
    torque: Vector,
}

/// Which colliders touch, as a direct caller of rapier has it too.
struct Listed {
    colliders: usize,
    friction: Vec<Option<f32>>,
}

impl Listed {
    fn friction(&self, [a, b]: [u128; 2]) -> Option<f32> {
        self.friction[(a as usize - 1) * self.colliders + b as usize - 1]
    }
}

impl PhysicsHooks for Listed {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let marks = [context.collider1, context.collider2].map(|c| context.colliders[c].user_data);
        self.friction(marks).map(|_| SolverFlags::COMPUTE_RIGID_IMPULSES)
    }
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let marks = [context.collider1, context.collider2].map(|c| context.colliders[c].user_data);
        if let (Some(friction), Some(manifold)) = (self.friction(marks), context.rigid_mut()) {
            *manifold.friction = friction;
        }
    }
}

/// Where a joint's spring is: its link and the number of its velocity are both one more than the joint's and the joint's.
fn told(world: &World) -> Told {
    let physics = world.physics();
    let mut springs = [[0.0; 3]; 27];
    if let Some(multibody) = physics.multibody_joints.multibodies().next() {
        for (joint, spring) in springs.iter_mut().enumerate() {
            let (stiffness, rest) = multibody.link(joint + 1).map_or((0.0, 0.0), |link| link.joint().spring(5));
            *spring = [stiffness, rest, multibody.damping()[joint]];
        }
    }
    let sphere = world.body_handle(Tabletop::SPHERE).map(|body| physics.bodies[body].user_torque());
    Told { springs, torque: sphere.unwrap_or_default() }
}

fn one_step(world: &mut World, commands: &[[f32; 2]; 27]) {
    for (number, command) in commands.iter().enumerate() {
        world.command(ActuatorId(number as u16), *command);
    }
    world.step();
}

#[inline(never)]
fn measured_adapter(world: &mut World, commands: &[[[f32; 2]; 27]]) {
    for commands in commands {
        one_step(world, commands);
    }
}

#[inline(never)]
fn measured_direct(world: &mut World, told: &[Told], hooks: &Listed) {
    let sphere = world.body_handle(Tabletop::SPHERE);
    let root = world.body_handle(BodyId(0));
    let physics: &mut PhysicsWorld = world.physics_mut();
    let found = root.and_then(|root| physics.multibody_joints.rigid_body_link(root)).map(|link| link.multibody);
    let (Some(multibody), Some(sphere)) = (found, sphere) else { return };
    for Told { springs, torque } in told {
        if let Some(multibody) = physics.multibody_joints.get_multibody_mut_internal(multibody) {
            for (joint, [stiffness, rest, damping]) in springs.iter().enumerate() {
                multibody.damping_mut()[joint] = *damping;
                if let Some(link) = multibody.link_mut(joint + 1) {
                    link.joint.set_spring(5, *stiffness, *rest);
                }
            }
        }
        if let Some(body) = physics.bodies.get_mut(sphere) {
            body.reset_torques(false);
            if *torque != Vector::ZERO {
                body.add_torque(*torque, false);
            }
        }
        physics.step_with_events(hooks, &());
    }
}

fn timed(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

/// Steps through the adapter (`adapter`), directly (`direct`), or both, which are then timed (`rapier`).
pub(crate) fn compare(which: &str) -> Result<(), Box<dyn Error>> {
    let robot = Tabletop::default().scene(&ArmAndHand::default())?;
    let options = Options { time_step: 0.0025, substeps: 1, ..Options::default() };
    let mut start = World::new(&robot, &options)?;
    for (joint, degrees) in START.into_iter().enumerate() {
        start.place_joint(JointId(joint as u16), degrees.to_radians(), 0.0);
    }
    // Rolling, so that its resistance has work to do.
    let twist = Twist { linear: [0.05, 0.0, 0.0], angular: [0.0, 2.0, 0.0] };
    start.place_body(Tabletop::SPHERE, Pose::at([0.1, -0.18, 0.025]), twist);
    start.finish_placement();

    let commands = commands();
    let mut recorded = start.clone();
    let all: Vec<Told> = commands
        .iter()
        .map(|commands| {
            one_step(&mut recorded, commands);
            told(&recorded)
        })
        .collect();
    let colliders = robot.colliders.len();
    let mut friction = vec![None; colliders * colliders];
    for pair in &robot.pairs {
        let [a, b] = pair.colliders;
        friction[a * colliders + b] = Some(pair.surface.friction as f32);
        friction[b * colliders + a] = friction[a * colliders + b];
    }
    let hooks = Listed { colliders, friction };

    let is_timed = which == "rapier";
    let runs = if is_timed { 5 } else { 1 };
    let (mut adapter, mut direct) = (Duration::MAX, Duration::MAX);
    for _ in 0..runs {
        let (mut with, mut without) = (start.clone(), start.clone());
        if which != "direct" {
            adapter = adapter.min(timed(|| measured_adapter(&mut with, &commands)));
        }
        if which != "adapter" {
            direct = direct.min(timed(|| measured_direct(&mut without, &all, &hooks)));
            let at =
                |world: &World| world.physics().bodies.iter().map(|(_, body)| *body.position()).collect::<Vec<_>>();
            assert_eq!(at(&without), at(&recorded), "the same motion");
        }
    }
    if is_timed {
        let each = |whole: Duration| whole / STEPS as u32;
        println!("a step of rapier: {:?} through the adapter, {:?} directly", each(adapter), each(direct));
    }
    Ok(())
}
