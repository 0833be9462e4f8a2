//! What is measured: control steps of the whole loop in two states that can be kept, and the kernels below them.

use std::error::Error;
use std::sync::Arc;

use farsa::body::{
    ArmAndHand, Channels, Contacts, Law, Motor, MusclePair, PairId, Robot, Sensor, Snapshot, Tabletop, World as _,
};
use farsa::nn::{Controller, Layout, Leak, Network, ParameterKind};
use farsa::num::fearless_simd::Level;
use farsa::num::{Domain, Stream};
use farsa::physics::articulated::{Batch, Model, Options, Scratch, World, accelerations};
use farsa_experiments::reach_grasp_lift::{Config, Motors, Scene, ScriptLife, Senses, Statics, Timetable};
use farsa_experiments::{Job, Life};

type Failure = Box<dyn Error>;

/// Control steps after which the state is restored, so that it stays what it is called.
const WINDOW: usize = 50;

/// A network of this layout with weights in [-6, 6] and leaks in [0, 1], over the instructions that the program is compiled
/// for: they count the same on every machine.
pub(crate) fn network(layout: Layout) -> Result<Network<Vec<f32>, Vec<f32>>, Failure> {
    let mut stream = Stream::new(1, Domain::InitialGenome, 0, 0, 0);
    let leaks = |kind| kind == ParameterKind::Leak;
    let draw = |kind| if leaks(kind) { stream.uniform() } else { stream.range(-6.0, 6.0) };
    let parameters = layout.kinds().map(draw).collect();
    let network = Network::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len()])?;
    Ok(network.with_level(Level::baseline()))
}

/// The whole loop of `reach-grasp-lift` with the network in it; held commands keep the state what it is.
pub(crate) struct Loop {
    world: World<f32>,
    senses: Senses,
    network: Network<Vec<f32>, Vec<f32>>,
    motors: Motors,
    x: Vec<f32>,
    y: Vec<f32>,
    held: Vec<f32>,
    start: Vec<f32>,
    tick: usize,
}

impl Loop {
    fn new(scene: &Scene, world: World<f32>, held: Vec<f32>) -> Result<Self, Failure> {
        let (senses, motors) = (scene.senses()?, scene.motors()?);
        let layout = scene.config.layout();
        let mut start = vec![0.0; world.snapshot_len()];
        world.save(&mut start);
        let (x, y) = (vec![0.0; senses.channels()], vec![0.0; motors.channels()]);
        Ok(Self { world, senses, network: network(layout)?, motors, x, y, held, start, tick: 0 })
    }

    fn scene() -> Result<(Arc<Scene>, World<f32>), Failure> {
        let scene = Arc::new(Scene::new(Config::default())?);
        let world = World::new(Model::new(&scene.robot, &scene.config.options())?);
        Ok((scene, world))
    }

    /// The arm held at its first start posture: nothing touches but the sphere the table.
    pub(crate) fn free() -> Result<Self, Failure> {
        let (scene, mut world) = Self::scene()?;
        scene.arrange(&mut world, Job::default());
        let joints = scene.start(Job::default()).0;
        let statics = Statics::new(&scene)?;
        let (activations, _) = statics.activations(&joints, &statics.gravity_torques(&joints));
        let muscles = activations.into_iter().flatten().map(|a| a as f32);
        Self::new(&scene, world, muscles.chain([0.0; 9]).collect())
    }

    /// The sphere held in the lifted hand, as the script grasps it from the first start.
    pub(crate) fn grasp() -> Result<Self, Failure> {
        let (scene, mut world) = Self::scene()?;
        let mut script = ScriptLife::new(Arc::clone(&scene), Timetable::default())?;
        script.start(&mut world, Job::default());
        for _ in 0..560 {
            script.tick(&mut world);
            world.step();
        }
        if !script.judge().succeeds() {
            println!("note: the script does not hold the sphere ({:?})", script.judge().trial());
        }
        let held = script.done().to_vec();
        Self::new(&scene, world, held)
    }

    /// One control step of 10 ms: sensors, network, motors, world. What the network says is computed and not done.
    pub(crate) fn control_step(&mut self) {
        if self.tick == WINDOW {
            self.tick = 0;
            self.world.restore(&self.start);
        }
        self.tick += 1;
        self.senses.read(&self.world, &mut self.x);
        self.network.step(&self.x, &mut self.y);
        let done = std::hint::black_box(&self.y).len();
        self.motors.drive(&self.held[..done], &mut self.world);
        self.world.step();
    }

    /// How many pairs and how many points touch, least and most over the steps between two restorations.
    pub(crate) fn contacts(&mut self) -> [[u32; 2]; 2] {
        let mut range = [[u32::MAX, 0]; 2];
        for _ in 0..WINDOW {
            self.control_step();
            let points = (0..self.world.pairs() as u16).map(|i| self.world.pair_contact(PairId(i)).points);
            let (pairs, points) = points.fold((0, 0), |(pairs, sum), n| (pairs + u32::from(n > 0), sum + n));
            for (range, n) in range.iter_mut().zip([pairs, points]) {
                *range = [range[0].min(n), range[1].max(n)];
            }
        }
        range
    }
}

/// The same loop in every lane of a batch, each lane at another tick of the time between two restorations.
pub(crate) struct Lanes {
    batch: Batch,
    loops: Vec<Loop>,
}

impl Lanes {
    /// So many lanes, stepped by the instructions of a level.
    pub(crate) fn new(made: impl Fn() -> Result<Loop, Failure>, lanes: usize, level: Level) -> Result<Self, Failure> {
        let mut loops = (0..lanes).map(|_| made()).collect::<Result<Vec<_>, _>>()?;
        let mut batch = Batch::new(loops[0].world.model().clone(), lanes, level)?;
        for (lane, alone) in loops.iter_mut().enumerate() {
            (0..3 * lane).for_each(|_| alone.control_step());
            let mut state = vec![0.0; alone.world.snapshot_len()];
            alone.world.save(&mut state);
            batch.lane(lane).restore(&state);
        }
        Ok(Self { batch, loops })
    }

    /// One control step of 10 ms in every lane.
    pub(crate) fn control_step(&mut self) {
        for (lane, alone) in self.loops.iter_mut().enumerate() {
            let mut world = self.batch.lane(lane);
            if alone.tick == WINDOW {
                alone.tick = 0;
                world.restore(&alone.start);
            }
            alone.tick += 1;
            alone.senses.read(&world, &mut alone.x);
            alone.network.step(&alone.x, &mut alone.y);
            let done = std::hint::black_box(&alone.y).len();
            alone.motors.drive(&alone.held[..done], &mut world);
        }
        self.batch.step();
    }
}

/// The articulated-body algorithm on arm or arm and hand, in the start posture, at some speed.
pub(crate) struct Aba {
    model: Model<f32>,
    scratch: Scratch<f32>,
    state: Vec<f32>,
    tau: Vec<f32>,
    diagonal: Vec<f32>,
    qdd: Vec<f32>,
}

impl Aba {
    /// For the first so many joints of the arm and hand.
    pub(crate) fn new(joints: usize) -> Result<Self, Failure> {
        let whole = ArmAndHand::default().robot()?;
        let robot = Robot {
            name: "tree".into(),
            segments: whole.segments.into_iter().take(joints).collect(),
            ..Robot::default()
        };
        let model = Model::new(&robot, &Options::default())?;
        let scratch = Scratch::new((), &model);
        let mut state = vec![0.0; model.state_len()];
        for (i, word) in state.iter_mut().enumerate() {
            *word = 0.01 * i as f32 - 0.3;
        }
        let n = model.dofs();
        Ok(Self { scratch, state, tau: vec![0.1; n], diagonal: vec![0.001; n], qdd: vec![0.0; n], model })
    }

    /// Places the links and computes their accelerations.
    pub(crate) fn accelerations(&mut self) -> f32 {
        self.scratch.place((), &self.model, &self.state);
        let (work, roots) = self.scratch.parts();
        let (links, gravity) = (self.model.links(), self.model.gravity());
        accelerations((), links, gravity, &self.tau, &self.diagonal, work, roots, &mut self.qdd);
        self.qdd[0]
    }
}

/// The muscle pair of J1 in single precision.
pub(crate) fn muscles() -> Result<MusclePair<f32>, Failure> {
    let scene = Tabletop::default().scene(&ArmAndHand::default())?;
    match scene.actuators[0].law.cast() {
        Law::MusclePair(pair) => Ok(pair),
        _ => Err("J1 has no muscles".into()),
    }
}
