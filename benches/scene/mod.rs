//! The measured scenes: control steps of the loop in two reproducible states, and the kernels below them.

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use farsa::body::actuators::{Law, MusclePair};
use farsa::body::ports::{BodyId, Channels, Contacts, Motor, PairId, Sensor, Snapshot, World as _};
use farsa::body::robot::Robot;
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::nn::{Controller, Leak, LeakyLayout, LeakyNetwork, LeakyParameter};
use farsa::num::{Domain, Instructions, Stream};
use farsa::physics::articulated::{Batch, Model, Options, Scratch, World, accelerations};
use farsa_experiments::reach_grasp_lift::{Config, Motors, Scene, ScriptEpisode, Senses, Statics, Timetable};
use farsa_lab::{Episode, EpisodeId};

type Failure = Box<dyn Error>;

/// Control steps after which the state is restored, so that it stays what it is called.
const WINDOW: usize = 50;

/// Builds a network of this layout with weights in [-6, 6] and leaks in [0, 1], over the instructions of the build, so
/// that counts are equal on every machine.
pub(crate) fn network(layout: LeakyLayout) -> Result<LeakyNetwork<Vec<f32>, Vec<f32>>, Failure> {
    let mut stream = Stream::new(1, Domain::InitialGenome, 0, 0, 0);
    let leaks = |kind| kind == LeakyParameter::Leak;
    let draw = |kind| if leaks(kind) { stream.uniform() } else { stream.range(-6.0, 6.0) };
    let parameters = layout.kinds().map(draw).collect();
    let network = LeakyNetwork::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len()])?;
    Ok(network.with_instructions(Instructions::baseline()))
}

/// The loop of `reach-grasp-lift` with the network in it. Held commands keep the state constant.
pub(crate) struct Loop {
    world: World<f32>,
    senses: Senses,
    network: LeakyNetwork<Vec<f32>, Vec<f32>>,
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
        scene.arrange(&mut world, EpisodeId::default());
        let joints = scene.start(EpisodeId::default()).0;
        let statics = Statics::new(&scene)?;
        let (activations, _) = statics.activations(&joints, &statics.gravity_torques(&joints));
        let muscles = activations.into_iter().flatten().map(|a| a as f32);
        Self::new(&scene, world, muscles.chain([0.0; 9]).collect())
    }

    /// The sphere held in the lifted hand, as the script grasps it from the first start.
    pub(crate) fn grasp() -> Result<Self, Failure> {
        let (scene, mut world) = Self::scene()?;
        let mut script = ScriptEpisode::new(Arc::clone(&scene), Timetable::default())?;
        script.start(&mut world, EpisodeId::default());
        for _ in 0..560 {
            script.act(&mut world);
            world.step();
            Episode::judge(&mut script, &mut world);
        }
        if !script.judge().succeeds() {
            println!("note: the script does not hold the sphere ({:?})", script.judge().trial());
        }
        let held = script.done().to_vec();
        Self::new(&scene, world, held)
    }

    /// Makes one control step of 10 ms: sensors, network, motors, world. The network's output is computed and not used.
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

    /// Returns the numbers of evaluated pairs, touching pairs and touching points.
    pub(crate) fn contacts(&mut self) -> Touching {
        let mut touching = Touching::new(&self.world);
        for _ in 0..WINDOW {
            self.control_step();
            touching.count(&self.world);
        }
        touching
    }
}

/// The numbers of pairs, of pairs with examined surfaces, of touching pairs, and of points. They are least and most
/// over the steps between two restorations.
pub(crate) struct Touching {
    pairs: usize,
    ranges: [[usize; 2]; 3],
}

impl Touching {
    fn new(world: &World<f32>) -> Self {
        Self { pairs: world.pairs(), ranges: [[usize::MAX, 0]; 3] }
    }

    fn count(&mut self, world: &World<f32>) {
        let points = (0..self.pairs as u16).map(|i| world.pair_contact(PairId(i)).points as usize);
        let (touch, points) = points.fold((0, 0), |(pairs, sum), n| (pairs + usize::from(n > 0), sum + n));
        let near = if self.pairs == 0 { 0 } else { world.near_pairs() };
        for (range, n) in self.ranges.iter_mut().zip([near, touch, points]) {
            *range = [range[0].min(n), range[1].max(n)];
        }
    }
}

impl fmt::Display for Touching {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [near, touch, points] = self.ranges.map(|[least, most]| format!("{least} to {most}"));
        write!(f, "of {} pairs {near} are evaluated and {touch} touch, at {points} points", self.pairs)
    }
}

/// The world's step alone, repeated from one state of the loop. It has the pairs of the scene, or none, and the
/// difference is the cost of contacts.
#[allow(dead_code, reason = "instructions are counted of the whole loop")]
pub(crate) struct Step {
    world: World<f32>,
    start: Vec<f32>,
}

#[allow(dead_code, reason = "instructions are counted of the whole loop")]
impl Step {
    /// From the state that a loop is restored to.
    pub(crate) fn new(whole: &mut Loop, pairs: bool) -> Result<Self, Failure> {
        whole.world.restore(&whole.start);
        // Commands that are held are given at every step. Here they stay in the state.
        whole.motors.drive(&whole.held, &mut whole.world);
        let (scene, mut world) = Loop::scene()?;
        if !pairs {
            let robot = Robot { pairs: Vec::new(), ..scene.robot.clone() };
            world = World::new(Model::new(&robot, &scene.config.options())?);
        }
        // Contact points are a state's last words: without them it is the beginning of the same.
        let mut start = vec![0.0; whole.world.snapshot_len()];
        whole.world.save(&mut start);
        start.truncate(world.snapshot_len());
        Ok(Self { world, start })
    }

    /// One control step of 10 ms of the world.
    pub(crate) fn step(&mut self) {
        self.world.restore(&self.start);
        self.world.step();
    }

    /// Returns the numbers of evaluated pairs, touching pairs and touching points.
    pub(crate) fn contacts(&mut self) -> Touching {
        let mut touching = Touching::new(&self.world);
        self.step();
        touching.count(&self.world);
        touching
    }
}

/// The loop in every lane of a batch, each lane at another tick between two restorations.
pub(crate) struct Lanes {
    batch: Batch,
    loops: Vec<Loop>,
}

impl Lanes {
    /// Builds `lanes` lanes, stepped by these instructions.
    pub(crate) fn new(
        made: impl Fn() -> Result<Loop, Failure>,
        lanes: usize,
        instructions: Instructions,
    ) -> Result<Self, Failure> {
        let mut loops = (0..lanes).map(|_| made()).collect::<Result<Vec<_>, _>>()?;
        let mut batch = Batch::new(loops[0].world.model().clone(), lanes, instructions)?;
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
    /// Builds the first `joints` joints of the arm and hand. Beyond their number, arms of seven joints follow, each on
    /// the last.
    pub(crate) fn new(joints: usize) -> Result<Self, Failure> {
        let whole = ArmAndHand::default().robot()?.segments;
        let arm = whole.iter().take(7).cycle().take(joints).enumerate().map(|(index, segment)| {
            let mut segment = segment.clone();
            segment.parent = index.checked_sub(1).map(|parent| BodyId(parent as u16));
            segment.name = format!("link {index}");
            segment.joint.name = format!("joint {index}");
            segment
        });
        let segments = if joints <= whole.len() { whole[..joints].to_vec() } else { arm.collect() };
        let robot = Robot { name: "tree".into(), segments, ..Robot::default() };
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
        self.scratch.forward_kinematics((), &self.model, &self.state);
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
