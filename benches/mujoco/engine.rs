//! Both engines behind one interface for scripts. A script receives the state after every control step and returns
//! commands.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;

use farsa::body::ports::{ActuatorId, BodyId, Contacts, Handles, JointId, Joints, PairId, World as _};
use farsa::body::robots::{ArmAndHand, Tabletop};
use farsa::physics::articulated;
use farsa_experiments::reach_grasp_lift::Scene;

use crate::held;
use crate::phase::{Failure, JOINTS, Phase, WORDS, command, world};

/// A pair that touches: which, how deep \[m\], with what normal force \[N\].
#[derive(Clone, Copy)]
pub(crate) struct Touching {
    pub(crate) pair: PairId,
    pub(crate) depth: f64,
    pub(crate) force: f64,
}

/// The state of an engine's world.
pub(crate) struct Seen {
    q: [f32; JOINTS],
    v: [f32; JOINTS],
    /// The sphere's center in the palm's frame \[m\].
    pub(crate) held: [f64; 3],
    /// Height of the sphere's center \[m\].
    pub(crate) height: f64,
    pub(crate) touching: Vec<Touching>,
}

impl Handles for Seen {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl Joints for Seen {
    fn position(&self, joint: JointId) -> f32 {
        self.q[joint.index()]
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.v[joint.index()]
    }
}

impl Seen {
    /// Returns the contact of a pair, with depth and force 0 without one.
    pub(crate) fn contact(&self, pair: PairId) -> Touching {
        let none = Touching { pair, depth: 0.0, force: 0.0 };
        self.touching.iter().find(|touching| touching.pair == pair).copied().unwrap_or(none)
    }
}

/// Something that moves the scene.
pub(crate) trait Engine {
    /// Restarts at the beginning of a phase, for `steps` control steps.
    fn start(&mut self, phase: &Phase, steps: usize) -> Result<Seen, Failure>;
    /// Takes a control step.
    fn step(&mut self, words: &[f32; WORDS]) -> Result<Seen, Failure>;
}

/// Our engine.
pub(crate) struct Ours(articulated::World<f32>);

impl Ours {
    pub(crate) fn new(scene: &Scene, substeps: u32) -> Result<Self, Failure> {
        Ok(Self(world(scene, substeps, true)?))
    }

    fn seen(&self) -> Seen {
        let joints = ArmAndHand::joints();
        let pairs = (0..self.0.pairs()).map(|pair| PairId(pair as u16)).filter(|pair| self.0.touches(*pair));
        let touching = pairs.map(|pair| {
            let contact = self.0.pair_contact(pair);
            Touching { pair, depth: f64::from(contact.depth), force: f64::from(contact.normal_force) }
        });
        Seen {
            q: joints.map(|joint| self.0.position(joint)),
            v: joints.map(|joint| self.0.speed(joint)),
            held: held(&self.0),
            height: f64::from(self.0.pose_of(Tabletop::SPHERE).position[2]),
            touching: touching.collect(),
        }
    }
}

impl Engine for Ours {
    fn start(&mut self, phase: &Phase, _: usize) -> Result<Seen, Failure> {
        phase.place(&mut self.0);
        Ok(self.seen())
    }

    fn step(&mut self, words: &[f32; WORDS]) -> Result<Seen, Failure> {
        command(&mut self.0, words);
        self.0.step();
        Ok(self.seen())
    }
}

/// MuJoCo, in the process of `step_mujoco.c`.
pub(crate) struct Theirs {
    scene: Arc<Scene>,
    // The input closes first, which ends the process.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    process: Child,
}

impl Theirs {
    pub(crate) fn new(scene: &Arc<Scene>, substeps: u32, program: &str, model: &str) -> Result<Self, Failure> {
        let mut process = Command::new(program)
            .args([model, "-", "drive", &substeps.to_string(), "0"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let (input, output) = (process.stdin.take(), process.stdout.take().ok_or("no output")?);
        Ok(Self { scene: Arc::clone(scene), input, output: BufReader::new(output), process })
    }

    fn tell(&mut self, text: &str) -> Result<Seen, Failure> {
        let input = self.input.as_mut().ok_or("no input")?;
        input.write_all(text.as_bytes())?;
        input.flush()?;
        let mut line = String::new();
        self.output.read_line(&mut line)?;
        let mut words = line.split_whitespace();
        let mut number = || -> Result<f64, Failure> { Ok(words.next().ok_or("MuJoCo tells too little")?.parse()?) };
        let (mut q, mut v) = ([0.0; JOINTS], [0.0; JOINTS]);
        for (q, v) in q.iter_mut().zip(&mut v) {
            (*q, *v) = (number()? as f32, number()? as f32);
        }
        let held = [number()?, number()?, number()?];
        let mut seen = Seen { q, v, held, height: number()?, touching: Vec::new() };
        let rest: Vec<&str> = words.collect();
        for contact in rest.chunks(4) {
            let &[a, b, depth, force] = contact else { return Err("half a contact".into()) };
            let pair = self.scene.robot.pair(a, b).ok_or("a pair that is not ours")?;
            let (depth, force): (f64, f64) = (depth.parse()?, force.parse()?);
            if force <= 0.0 {
                continue;
            }
            match seen.touching.iter_mut().find(|touching| touching.pair == pair) {
                Some(known) => (known.depth, known.force) = (known.depth.max(depth), known.force + force),
                None => seen.touching.push(Touching { pair, depth, force }),
            }
        }
        Ok(seen)
    }
}

impl Engine for Theirs {
    fn start(&mut self, phase: &Phase, steps: usize) -> Result<Seen, Failure> {
        let text = phase.start(&self.scene, steps);
        self.tell(&text)
    }

    fn step(&mut self, words: &[f32; WORDS]) -> Result<Seen, Failure> {
        let mut text = String::new();
        for word in words {
            // Writing into a string cannot fail.
            let _ = write!(text, "{word:?} ");
        }
        text.push('\n');
        self.tell(&text)
    }
}

impl Drop for Theirs {
    fn drop(&mut self) {
        self.input = None;
        // Nothing is left to do for a process that cannot be waited for.
        let _ = self.process.wait();
    }
}
