//! Episodes of a walker with or without a network. A walk starts with a launch and ends when the walker falls or the
//! time is over.

use farsa_body::motors::TorqueMotor;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Joints, Kinematics, Motor as _, PairId,
    Sensor as _,
};
use farsa_body::sensors::{JointPosition, JointSpeed, Touch};
use farsa_body::wrappers::Scaled;
use farsa_body::{ChannelError, Recorder};
use farsa_evo::ObservationStatistics;
use farsa_lab::advanced::{NormalizedController, OwnedNetwork, seconds};
use farsa_lab::{Episode, EpisodeId, Error};
use farsa_nn::{Controller, Leak, LeakyLayout, LeakyNetwork};
use farsa_num::{Domain, Scalar, Stream};

use crate::walking::gait::{End, Gait, Rules};
use crate::walking::walker::{Posture, Walker, WalkerParts};

/// Number of inputs of a walker's network. They are two angles, two speeds and two touch sensors.
pub const SENSES: usize = 6;
/// The number of last steps in the mean of the pace.
const LAST: usize = 10;
/// Angle that an angle sensor reads 1 at \[rad\], and speed that a speed sensor reads 1 at \[rad/s\].
pub(crate) const FULL: [f32; 2] = [0.6, 3.0];

/// The initial state of a walk. Angles are measured forward from the normal of the ground.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Launch {
    /// Angles of the stance leg and the swing leg (in radians).
    pub angles: [f64; 2],
    /// Angular velocities of the stance leg and the swing leg (in radians per second).
    pub rates: [f64; 2],
}

/// The environment of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walk {
    /// Slope of the ground (in radians). The ground descends in the walking direction.
    pub slope: f64,
    /// Acceleration of gravity (in m/s2).
    pub gravity: f64,
    /// Duration of a tick (in seconds).
    pub time_step: f64,
    /// Largest number of ticks of a walk.
    pub steps: u32,
    /// Largest relative difference between the launch rates of a trial and those of the configuration.
    pub noise: f64,
    /// Rules that a walk must not violate.
    pub rules: Rules,
}

/// Mean values over the last steps of a walk.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Pace {
    /// Backward lean of the leading leg at footfalls (in radians).
    pub angle: f64,
    /// Angular velocity of that leg after the footfalls (in radians per second).
    pub rate: f64,
    /// Angular velocity of the leg that starts to swing (in radians per second).
    pub swing_rate: f64,
    /// Duration of a step in seconds.
    pub period: f64,
    /// Length of a step in meters.
    pub length: f64,
}

type Angle = JointPosition<JointId>;
type Speed = Scaled<JointSpeed<JointId>, Vec<f32>>;
type Sole = Touch<[PairId; 1]>;

/// A network that controls the motor at the hip.
///
/// Its inputs are the lean of the outer legs, the angle between the inner and the outer legs, both angular velocities,
/// and the contacts of the feet.
#[derive(Clone, Debug)]
pub struct Brain {
    network: NormalizedController<OwnedNetwork>,
    senses: ((Angle, Angle), (Speed, Speed), (Sole, Sole)),
    motor: TorqueMotor,
    hinge: JointId,
    largest: f64,
    x: [f32; SENSES],
    y: [f32; 1],
    /// Torque since the last tick, and the hinge's angle then.
    torque: f64,
    angle: f64,
}

impl Brain {
    /// Creates a network with [`SENSES`] sensors and one output. An output of 1/2 corresponds to zero torque.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the walker has no motor, if the layout has the wrong shape, or if the parameters are
    /// invalid.
    pub fn new(walker: &Walker, parts: &WalkerParts, layout: LeakyLayout, parameters: Vec<f32>) -> Result<Self, Error> {
        let wrong = |error: ChannelError| Error::Other(format!("walker: {error}"));
        let Some(motor) = parts.motor else { return Err(Error::Other("walker: no motor at the hip".into())) };
        if (layout.sensors(), layout.outputs()) != (SENSES, 1) {
            let shape = format!("{} sensors and {} outputs", layout.sensors(), layout.outputs());
            return Err(Error::Other(format!("walker: a network of {shape} where {SENSES} and 1 are wanted")));
        }
        let network = LeakyNetwork::new(layout, Leak::Filter, parameters, vec![0.0; layout.state_len()]);
        let angle = |joint| JointPosition::new(joint, 0.0, FULL[0]).map_err(wrong);
        let speed = |joint| Scaled::new(JointSpeed::new(joint), 1.0 / FULL[1], 0.0).map_err(wrong);
        let touch = |pair| Touch::new([pair], 1.0).map_err(wrong);
        let [outer, inner] = parts.hinges;
        Ok(Self {
            network: NormalizedController::new(network.map_err(|error| Error::Other(format!("walker: {error}")))?),
            senses: (
                (angle(outer)?, angle(inner)?),
                (speed(outer)?, speed(inner)?),
                (touch(parts.soles[0])?, touch(parts.soles[1])?),
            ),
            motor: TorqueMotor::new(motor, walker.torque as f32).map_err(wrong)?,
            hinge: inner,
            largest: walker.torque,
            x: [0.0; SENSES],
            y: [0.5],
            torque: 0.0,
            angle: 0.0,
        })
    }

    fn reset(&mut self) {
        self.network.reset();
        (self.torque, self.y) = (0.0, [0.5]);
    }

    /// Senses, thinks and commands the torque of the next tick.
    fn act<W>(&mut self, world: &mut W)
    where
        W: Joints + Contacts + Actuated + Handles<Joint = JointId, Actuator = ActuatorId> + ?Sized,
    {
        self.senses.read(world, &mut self.x);
        self.network.step(&self.x, &mut self.y);
        self.motor.drive(&self.y, world);
        // Output y in [0, 1] is a torque in [-largest, largest] (in N m), with rest at 1/2.
        self.torque = (2.0 * f64::from(self.y[0]) - 1.0) * self.largest;
        self.angle = f64::from(world.position(self.hinge));
    }

    /// The work of the motor since the last tick \[J\].
    fn work<W: Joints<Joint = JointId> + ?Sized>(&self, world: &W) -> f64 {
        // W = torque times the turn of the hinge. The torque is constant within a step.
        self.torque * (f64::from(world.position(self.hinge)) - self.angle)
    }

    /// Gets the six inputs of the last step.
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// Returns the activations of the hidden neurons.
    pub fn hidden(&self) -> &[f32] {
        self.network.controller().hidden()
    }

    /// Gets the output of the last step.
    pub fn done(&self) -> &[f32] {
        &self.y
    }

    /// Returns the parameters of the network.
    pub fn parameters(&self) -> &[f32] {
        self.network.controller().parameters()
    }

    /// Normalizes the inputs of the network with earlier statistics, or disables normalization for `None`. Returns
    /// `false` if the statistics have a different number of channels.
    pub fn normalise(&mut self, before: Option<&ObservationStatistics>) -> bool {
        self.network.load(before)
    }

    /// Returns the statistics of the inputs since the last call of [`normalise`](Self::normalise), or `None` if
    /// normalization is disabled.
    pub fn observed(&self) -> Option<&ObservationStatistics> {
        self.network.observed()
    }

    /// Gets the torque that was commanded in the last step (in newton meters).
    pub fn torque(&self) -> f64 {
        self.torque
    }
}

/// An episode in which a walker moves over the ground.
#[derive(Clone, Debug)]
pub struct WalkerEpisode {
    walk: Walk,
    launch: Launch,
    gait: Gait,
    brain: Option<Brain>,
    /// Number of steps whose pace is counted.
    noted: u32,
    known: usize,
    paces: [Pace; LAST],
}

impl WalkerEpisode {
    /// Creates an episode for a walker with the given parts.
    pub fn new(walker: Walker, parts: WalkerParts, walk: Walk, launch: Launch, brain: Option<Brain>) -> Self {
        let gravity = Walker::gravity(walk.gravity, walk.slope);
        let gait = Gait::new(walker, parts, walk.rules, gravity, walk.time_step);
        Self { walk, launch, gait, brain, noted: 0, known: 0, paces: [Pace::default(); LAST] }
    }

    /// Returns the distance between the first stance and the last footfall (in meters). This is NaN after a numerical
    /// failure, and 0 if the walker gained energy from errors of the simulation.
    pub fn distance(&self) -> f64 {
        match self.gait.end() {
            Some(End::Broken) => f64::NAN,
            // A walk on energy that the simulation has created must not pay.
            Some(End::Gained) => 0.0,
            _ => self.gait.distance(),
        }
    }

    /// Returns the mean of the last ten steps, or `None` if there were fewer steps.
    pub fn pace(&self) -> Option<Pace> {
        let mean = |of: fn(&Pace) -> f64| self.paces.iter().map(of).sum::<f64>() / LAST as f64;
        (self.known >= LAST).then(|| Pace {
            angle: mean(|pace| pace.angle),
            rate: mean(|pace| pace.rate),
            swing_rate: mean(|pace| pace.swing_rate),
            period: mean(|pace| pace.period),
            length: mean(|pace| pace.length),
        })
    }

    /// Computes the unit of time of the walking model in seconds. It is sqrt(leg length / gravity) for the outer legs.
    pub fn unit_of_time(&self) -> f64 {
        Scalar::sqrt(self.gait.walker().legs[0].length / self.walk.gravity)
    }

    /// Gets the recorded movement of the feet.
    pub fn gait(&self) -> &Gait {
        &self.gait
    }

    /// Gets the network, or `None` for a passive walker.
    pub fn brain(&self) -> Option<&Brain> {
        self.brain.as_ref()
    }

    /// Gets the environment of the walk.
    pub fn walk(&self) -> &Walk {
        &self.walk
    }
}

impl<W> Episode<W> for WalkerEpisode
where
    W: Kinematics
        + Joints
        + Contacts
        + Actuated
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + ?Sized,
{
    /// Launches the walker. Its rates are those of the launch times 1 + noise * u, with a u from -1 to 1 for each leg,
    /// the stance leg's first. They are drawn from the stream of [`Domain::Start`] of the id's trial, individual and
    /// generation.
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        // r (1 + noise u), with u uniform in [-1, 1), is a relative disturbance of each rate.
        let rates = self.launch.rates.map(|rate| rate * (1.0 + self.walk.noise * stream.range_f64(-1.0, 1.0)));
        let posture = Posture::standing(self.gait.walker(), 0, self.launch.angles, rates);
        self.gait.start(world, 0, &posture);
        if let Some(brain) = &mut self.brain {
            brain.reset();
        }
        (self.noted, self.known) = (0, 0);
    }

    /// Senses, computes and acts, if there is a network.
    fn act(&mut self, world: &mut W) {
        if let Some(brain) = &mut self.brain {
            brain.act(world);
        }
    }

    /// Judges the tick that has passed. `Some` ends the walk with the distance walked \[m\], NaN for a broken one.
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        let work = self.brain.as_ref().map_or(0.0, |brain| brain.work(world));
        let end = self.gait.judge(world, work);
        let [before, last] = self.gait.footfalls();
        // Rates settle some ticks after their footfall. `noted` is the last step in the ring of paces.
        if let Some([rate, swing_rate]) = last.rates.filter(|_| self.gait.steps() > self.noted) {
            let (period, length) = (last.time - before.time, last.place - before.place);
            self.paces[self.known % LAST] = Pace { angle: last.angle, rate, swing_rate, period, length };
            self.noted = self.gait.steps();
            self.known += 1;
        }
        let over = end.is_some() || self.gait.ticks() >= self.walk.steps;
        over.then(|| self.distance())
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        let gait = &self.gait;
        for body in shown_bodies(gait.parts()) {
            recorder.pose(body, world.pose(body));
        }
        if let Some(brain) = &self.brain {
            recorder.sensors(brain.sensed());
            recorder.neurons(brain.hidden());
            recorder.outputs(brain.done());
        }
        let posture = gait.posture();
        let [work, gained] = gait.energies();
        let [[x, z], [outer, inner], [u, v]] = [posture.hip, posture.angles, posture.rates];
        let stance = gait.stance() as f64;
        recorder.scalars(&[x, z, outer, inner, u, v, stance, f64::from(gait.steps()), gait.distance(), gained, work]);
        recorder.tick(seconds(gait.ticks(), self.walk.time_step));
    }
}

/// The bodies that are recorded.
fn shown_bodies(parts: &WalkerParts) -> [BodyId; 3] {
    [parts.hip, parts.legs[0], parts.legs[1]]
}
