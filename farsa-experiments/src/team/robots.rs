//! Robots with a controller each: what they sense, compute and do.

use core::f32::consts::PI;

use farsa_body::motors::{Leds, SpeedAndTurn};
use farsa_body::ports::{BodyId, Motor as _};
use farsa_body::robots::MobileParts;
use farsa_body::sensors::ColorBand;
use farsa_body::{ChannelError, Pose, Recorder, Twist};
use farsa_lab::Error;
use farsa_nn::Controller;
use farsa_num::Stream;
use farsa_physics::arena::{ArenaError, FreePlace};

use crate::team::config::TeamConfig;
use crate::team::eyes::RobotEyes;
use farsa_lab::advanced::PlanarWorld;

/// The robots of a team in their world, with a controller each.
///
/// The controllers read infrared and camera ([`RobotEyes`]), then the inputs of the experiment. They write speed and turn
/// ([`SpeedAndTurn::forwards`]), then the brightness of the red and the blue LED of robots with LEDs.
#[derive(Clone, Debug)]
pub struct Team<C> {
    members: Vec<Member>,
    controllers: Vec<C>,
    /// Channels that eyes fill.
    seen: usize,
    x: Vec<f32>,
    y: Vec<f32>,
    /// Distance that robots keep from each other and from walls at the start \[m\].
    apart: f32,
    radius: f32,
    size: f32,
}

#[derive(Clone, Debug)]
struct Member {
    parts: MobileParts,
    eyes: RobotEyes,
    wheels: SpeedAndTurn,
    leds: Option<Leds<farsa_body::ports::ActuatorId, 2>>,
}

/// Outputs of a controller: speed, turn, red, blue.
pub(crate) const OUTPUTS: usize = 4;

/// At the start robots keep this part of their radius from each other.
const APART: f64 = 0.1;

impl<C: Controller> Team<C> {
    /// Builds the team of a configuration, with a camera for the colors of each robot by its number. There is one controller for
    /// each robot, of `inputs` inputs and four outputs, or two where no robot has LEDs to drive.
    ///
    /// # Errors
    /// [`Error::Other`] for another number of controllers, controllers of another shape, and sensors that cannot be.
    pub fn new(
        config: &TeamConfig,
        colors: impl Fn(usize) -> &'static [ColorBand],
        [inputs, outputs]: [usize; 2],
        controllers: Vec<C>,
    ) -> Result<Self, Error> {
        let wrong = |error: ChannelError| Error::Other(format!("team: {error}"));
        let arena = config.arena();
        let robot = config.robot();
        if controllers.len() != config.robots {
            return Err(Error::Other(format!("team: {} controllers for {} robots", controllers.len(), config.robots)));
        }
        if let Some(other) = controllers.iter().find(|c| (c.inputs(), c.outputs()) != (inputs, outputs)) {
            let (i, o) = (other.inputs(), other.outputs());
            return Err(Error::Other(format!(
                "team: a controller of {i} inputs and {o} outputs where {inputs} and {outputs} are wanted"
            )));
        }
        let member = |number: usize| {
            let parts = arena.parts(number);
            Ok(Member {
                eyes: RobotEyes::new(config, &parts, colors(number))?,
                wheels: SpeedAndTurn::new(parts.motors, robot.max_wheel_speed as f32)?.forwards(),
                leds: parts.leds.filter(|_| outputs == OUTPUTS).map(|[red, _, blue]| Leds::new([red, blue])),
                parts,
            })
        };
        Ok(Self {
            members: (0..config.robots).map(member).collect::<Result<_, _>>().map_err(wrong)?,
            x: vec![0.0; config.robots * inputs],
            y: vec![0.0; config.robots * outputs],
            seen: config.seen(colors(0).len()),
            controllers,
            apart: (APART * robot.radius) as f32,
            radius: robot.radius as f32,
            size: config.size as f32,
        })
    }

    /// Puts every robot somewhere with a drawn heading: within `within` \[m\] of a place, or anywhere.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries.
    pub(crate) fn scatter<W: PlanarWorld>(
        &self,
        world: &mut W,
        near: Option<([f32; 2], f32)>,
        stream: &mut Stream,
    ) -> Result<(), ArenaError> {
        self.scatter_some(world, near, stream, self.members.len())
    }

    /// Puts the first `count` robots somewhere, and the others outside the arena, out of sight.
    ///
    /// # Errors
    /// [`ArenaError::NoFreePlace`] after a thousand tries.
    pub(crate) fn scatter_some<W: PlanarWorld>(
        &self,
        world: &mut W,
        near: Option<([f32; 2], f32)>,
        stream: &mut Stream,
        count: usize,
    ) -> Result<(), ArenaError> {
        for (number, member) in self.members.iter().enumerate().skip(count) {
            let at = [-5.0 * self.size - 4.0 * self.radius * number as f32; 2];
            world.place_body(member.parts.body, Pose::planar(at, 0.0), Twist::default());
            world.finish_placement();
        }
        let margin = self.radius + self.apart;
        let (low, high) = (margin.min(0.5 * self.size), (self.size - margin).max(0.5 * self.size));
        let region = match near {
            None => [[low; 2], [high; 2]],
            Some((at, far)) => [at.map(|x| (x - far).clamp(low, high)), at.map(|x| (x + far).clamp(low, high))],
        };
        let mut others: Vec<(BodyId, f32)> = Vec::new();
        for member in self.members.iter().take(count) {
            // The region is square, what is near is round.
            let free = FreePlace { within: near, ..FreePlace::new(region, self.radius) };
            let at = free.clear_of(&others).find(world, stream)?;
            world.place_body(member.parts.body, Pose::planar(at, stream.range(-PI, PI)), Twist::default());
            world.finish_placement();
            others.push((member.parts.body, self.apart));
        }
        Ok(())
    }

    /// Clears the memory of the controllers.
    pub fn reset(&mut self) {
        self.controllers.iter_mut().for_each(Controller::reset);
    }

    /// Every robot senses, computes and acts. `more` fills the inputs that are not its eyes', and returns false for a dead robot.
    ///
    /// Dead robots rest with their LEDs off, and neither sense nor compute.
    pub fn act<W: PlanarWorld>(
        &mut self,
        world: &mut W,
        mut more: impl FnMut(&W, usize, &MobileParts, &mut [f32]) -> bool,
    ) {
        let Self { members, controllers, seen, x, y, .. } = self;
        let [inputs, outputs] = [x.len(), y.len()].map(|values| values / members.len().max(1));
        // All sense before any acts.
        for (number, (member, x)) in members.iter_mut().zip(x.chunks_exact_mut(inputs)).enumerate() {
            let (eyes, rest) = x.split_at_mut(*seen);
            if more(world, number, &member.parts, rest) {
                member.eyes.read(world, eyes);
            } else {
                x.fill(f32::NAN);
            }
        }
        let rows = x.chunks_exact(inputs).zip(y.chunks_exact_mut(outputs));
        for ((member, controller), (x, y)) in members.iter_mut().zip(controllers).zip(rows) {
            if x[0].is_nan() {
                y.copy_from_slice(&STILL[..outputs]);
            } else {
                controller.step(x, y);
            }
            member.wheels.drive(&y[..2], world);
            if let Some(leds) = &mut member.leds {
                leds.drive(&y[2..], world);
            }
        }
    }

    /// Records the infrared rays of the robots, in the world in which they sensed last: all rays of robot `own`, of
    /// the others those that met something.
    pub fn record_rays<W: PlanarWorld>(&self, world: &W, own: usize, recorder: &mut dyn Recorder) {
        for (robot, member) in self.members.iter().enumerate() {
            member.eyes.record(world, self.sensed(robot), robot != own, recorder);
        }
    }

    /// Where a robot is \[m\].
    pub fn place<W: PlanarWorld>(&self, world: &W, robot: usize) -> [f32; 2] {
        let [x, y, _] = world.pose(self.members[robot].parts.body).position;
        [x, y]
    }

    /// Number of robots.
    pub fn robots(&self) -> usize {
        self.members.len()
    }

    /// The last inputs of a robot \[inputs\], NaN if it is dead.
    pub fn sensed(&self, robot: usize) -> &[f32] {
        let inputs = self.x.len() / self.members.len().max(1);
        &self.x[robot * inputs..(robot + 1) * inputs]
    }

    /// The last outputs of a robot \[4, or 2\].
    pub fn done(&self, robot: usize) -> &[f32] {
        let outputs = self.y.len() / self.members.len().max(1);
        &self.y[robot * outputs..(robot + 1) * outputs]
    }

    /// The controllers, in the order of the robots.
    pub fn controllers(&self) -> &[C] {
        &self.controllers
    }

    /// The controllers, to be changed.
    pub fn controllers_mut(&mut self) -> &mut [C] {
        &mut self.controllers
    }
}

/// The outputs of a dead robot: no speed, no turn, no light.
const STILL: [f32; OUTPUTS] = [0.0, 0.5, 0.0, 0.0];

pub(crate) fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    farsa_num::Scalar::sqrt(x * x + y * y)
}
