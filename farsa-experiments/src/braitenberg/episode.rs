//! A vehicle of `braitenberg`: its wiring, and a trial beside a lamp.

use core::f32::consts::PI;

use farsa_body::motors::WheelVelocity;
use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Kinematics, Motor as _, PairId, Planar,
    Sensor as _,
};
use farsa_body::robots::{MobileParts, MobileRobot};
use farsa_body::sensors::{Beam, LightSensors};
use farsa_body::{ChannelError, Pose, Recorder, Twist};
use farsa_lab::{Episode, EpisodeId, Error, seconds};
use farsa_nn::Controller;
use farsa_num::{Domain, Scalar, Stream, sin_cos};
use farsa_physics::arena::{Arena, Cylinder};

use crate::wheeled::{place_and_heading, record_step};

/// Light sensors of the robot.
pub const LIGHTS: usize = 8;

/// Which sensors drive which wheel, and how \[Braitenberg1984, vehicles 2 and 3\].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vehicle {
    /// 2a: each side's light drives its own wheel on; it turns away from lamps and flees.
    Fear,
    /// 2b: each side's light drives the other wheel on; it turns to lamps and rushes at them.
    Aggression,
    /// 3a: each side's light slows its own wheel; it turns to a lamp and comes to rest before it.
    Love,
    /// 3b: each side's light slows the other wheel; it lingers near a lamp, turns away and explores.
    Explorer,
}

impl Vehicle {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Fear, Self::Aggression, Self::Love, Self::Explorer];

    /// Its number in the source.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fear => "2a",
            Self::Aggression => "2b",
            Self::Love => "3a",
            Self::Explorer => "3b",
        }
    }

    /// Whether light on one side acts on the wheel of the other.
    pub fn crossed(self) -> bool {
        matches!(self, Self::Aggression | Self::Explorer)
    }

    /// Whether light drives the wheels on, rather than slowing them.
    pub fn excited(self) -> bool {
        matches!(self, Self::Fear | Self::Aggression)
    }
}

/// Two wheels driven by light: `speed_i = clamp(base + sum_j w_ji light_j, 0, 1)` of the greatest wheel speed.
///
/// As a controller it answers `(1 + speed) / 2`, what a [`WheelVelocity`] takes for that speed. The parameters are `w_ji`
/// at `2 j + i` \[8 x 2\], then `base` \[2\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wiring {
    /// The parameters.
    pub parameters: [f32; 2 * LIGHTS + 2],
}

impl Wiring {
    /// The wiring of a vehicle whose light sensors look along these angles \[8\], counter-clockwise from ahead \[rad\].
    ///
    /// `gain` is the size of every weight, `base` the speed in the dark, in parts of the greatest.
    pub fn new(vehicle: Vehicle, angles: &[f64], gain: f64, base: f64) -> Self {
        let mut parameters = [base as f32; 2 * LIGHTS + 2];
        let gain = if vehicle.excited() { gain } else { -gain } as f32;
        for (pair, angle) in parameters[..2 * LIGHTS].chunks_exact_mut(2).zip(angles) {
            let on_the_left = farsa_num::sin_cos(*angle).0 > 0.0;
            pair.copy_from_slice(if on_the_left == vehicle.crossed() { &[0.0, 1.0] } else { &[1.0, 0.0] });
            for weight in pair {
                *weight *= gain;
            }
        }
        Self { parameters }
    }
}

impl Controller for Wiring {
    fn inputs(&self) -> usize {
        LIGHTS
    }
    fn outputs(&self) -> usize {
        2
    }
    fn reset(&mut self) {}
    fn step(&mut self, x: &[f32], y: &mut [f32]) {
        for (i, y) in y.iter_mut().take(2).enumerate() {
            // From the outermost pair of sensors inwards, so that mirror images add the same numbers in the same order.
            let weight = |sensor: usize| self.parameters[2 * sensor + i] * x.get(sensor).copied().unwrap_or(0.0);
            let drive = (0..LIGHTS / 2).map(|k| PAIRS[k]).fold(0.0, |sum, [a, b]| sum + (weight(a) + weight(b)));
            let speed = Scalar::clamp(self.parameters[2 * LIGHTS + i] + drive, 0.0, 1.0);
            *y = 0.5 + 0.5 * speed;
        }
    }
}

/// The Khepera's sensors and their mirror images.
const PAIRS: [[usize; 2]; LIGHTS / 2] = [[0, 5], [1, 4], [2, 3], [6, 7]];

/// The values of `braitenberg`; all but the lamp's radius are chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Which vehicle.
    pub vehicle: Vehicle,
    /// Side of the square arena, in whose middle the lamp stands \[m\].
    pub size: f64,
    /// Control step \[s\].
    pub time_step: f64,
    /// Trials.
    pub trials: u32,
    /// Steps of a trial.
    pub steps: u32,
    /// Radius of the lamp \[m\].
    pub lamp_radius: f64,
    /// Distance from which a sensor that looks at the lamp reads 1 \[m\].
    pub reference: f64,
    /// Least and greatest distance from the robot's centre to the lamp's at the start \[m\].
    pub start: [f64; 2],
    /// Size of the weights.
    pub gain: f64,
    /// Speed in the dark, in parts of the greatest.
    pub base: f64,
}

impl Config {
    /// The defaults of a vehicle.
    pub fn for_vehicle(vehicle: Vehicle) -> Self {
        Self {
            vehicle,
            size: 2.0,
            time_step: 0.05,
            trials: 20,
            steps: 600,
            lamp_radius: 0.01,
            reference: if vehicle.excited() { 0.25 } else { 0.15 },
            start: [0.15, 0.5],
            gain: 0.5,
            base: if vehicle.excited() { 0.1 } else { 0.5 },
        }
    }

    /// The robot.
    pub fn robot(&self) -> MobileRobot {
        MobileRobot::khepera()
    }

    /// The arena with the lamp in its middle and the robot beside it.
    pub fn arena(&self) -> Arena {
        let mut arena = Arena { time_step: self.time_step, ..Arena::walled(self.size, self.size) };
        let middle = 0.5 * self.size;
        arena.add_robot(self.robot(), [middle - self.start[1], middle], 0.0);
        arena.add_cylinder(Cylinder { lamp: 1.0, ..Cylinder::new([middle; 2], self.lamp_radius) });
        arena
    }
}

/// A vehicle beside a lamp.
#[derive(Clone, Debug)]
pub struct VehicleEpisode {
    config: Config,
    parts: MobileParts,
    lamp: BodyId,
    lights: LightSensors<Vec<Beam>>,
    wheels: WheelVelocity,
    wiring: Wiring,
    x: [f32; LIGHTS],
    y: [f32; 2],
    steps: u32,
    /// From the robot's centre to the lamp's, at the start and now \[m\].
    distances: [f64; 2],
    /// The lamp's bearing from straight ahead, at the start and now \[rad\].
    bearings: [f64; 2],
    collisions: u32,
}

impl VehicleEpisode {
    /// An episode of a vehicle under a configuration.
    ///
    /// # Errors
    /// [`Error::Other`] for values of which no sensor or motor can be built.
    pub fn new(config: Config) -> Result<Self, Error> {
        let wrong = |error: ChannelError| Error::Other(format!("braitenberg: {error}"));
        let (robot, arena) = (config.robot(), config.arena());
        let (parts, lamp) = (arena.parts(0), arena.cylinder(0));
        let lights = LightSensors::for_robot(&robot, parts.body, config.reference as f32).map_err(wrong)?;
        let wheels = WheelVelocity::new(parts.motors, robot.max_wheel_speed as f32).map_err(wrong)?;
        let wiring = Wiring::new(config.vehicle, &robot.infrared.angles, config.gain, config.base);
        let (x, y) = ([0.0; LIGHTS], [0.5; 2]);
        let (distances, bearings) = ([0.0; 2], [0.0; 2]);
        Ok(Self { config, parts, lamp, lights, wheels, wiring, x, y, steps: 0, distances, bearings, collisions: 0 })
    }

    /// Begins a trial with the robot so far from the lamp \[m\], seen from there in a direction, and with a heading \[rad\].
    pub fn place<W>(&mut self, world: &mut W, distance: f32, direction: f32, heading: f32)
    where
        W: Kinematics + Arrange + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        world.clear();
        let (sine, cosine) = sin_cos(direction);
        let middle = (0.5 * self.config.size) as f32;
        let at = [middle + distance * cosine, middle + distance * sine];
        world.place_body(self.parts.body, Pose::planar(at, heading), Twist::default());
        world.finish_placement();
        (self.steps, self.collisions) = (0, 0);
        self.look(world);
        self.distances[0] = self.distances[1];
        self.bearings[0] = self.bearings[1];
    }

    /// Measures where the lamp is.
    fn look<W: Kinematics<Body = BodyId> + ?Sized>(&mut self, world: &W) {
        let pose = world.pose(self.parts.body).cast::<f64>();
        let middle = 0.5 * self.config.size;
        let [x, y, _] = pose.rotate_back([middle - pose.position[0], middle - pose.position[1], 0.0]);
        self.distances[1] = Scalar::sqrt(x * x + y * y);
        self.bearings[1] = farsa_num::atan2(y, x);
    }

    /// How much nearer to the lamp the robot is than at the start \[m\].
    pub fn approach(&self) -> f64 {
        self.distances[0] - self.distances[1]
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// By which numbers the robot's parts are known.
    pub fn parts(&self) -> &MobileParts {
        &self.parts
    }

    /// The body of the lamp.
    pub fn lamp(&self) -> BodyId {
        self.lamp
    }

    /// The wiring.
    pub fn wiring(&self) -> &Wiring {
        &self.wiring
    }

    /// From the robot's centre to the lamp's, at the start and now \[m\].
    pub fn distances(&self) -> [f64; 2] {
        self.distances
    }

    /// The lamp's bearing at the start and now, counter-clockwise from straight ahead \[rad\].
    pub fn bearings(&self) -> [f64; 2] {
        self.bearings
    }

    /// Steps taken, and of these how many ended in a collision.
    pub fn steps(&self) -> [u32; 2] {
        [self.steps, self.collisions]
    }

    /// What was sensed last \[8\].
    pub fn sensed(&self) -> &[f32] {
        &self.x
    }

    /// What was done last \[2\].
    pub fn done(&self) -> &[f32] {
        &self.y
    }
}

impl<W> Episode<W> for VehicleEpisode
where
    W: Planar
        + Kinematics
        + Actuated
        + Contacts
        + Arrange
        + Handles<Body = BodyId, Joint = JointId, Actuator = ActuatorId>
        + ?Sized,
{
    /// Distance, direction and heading are uniform, in this order from the stream of [`Domain::Start`].
    fn start(&mut self, world: &mut W, id: EpisodeId) {
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, id.individual, id.generation);
        let [near, far] = self.config.start.map(|x| x as f32);
        let distance = stream.range(near, far);
        let (direction, heading) = (stream.range(-PI, PI), stream.range(-PI, PI));
        self.place(world, distance, direction, heading);
    }

    fn act(&mut self, world: &mut W) {
        self.lights.read(world, &mut self.x);
        self.wiring.step(&self.x, &mut self.y);
        self.wheels.drive(&self.y, world);
    }

    /// Counts the step that has passed; `Some` ends the trial with how much nearer the robot came \[m\].
    fn judge(&mut self, world: &mut W) -> Option<f64> {
        self.steps += 1;
        self.collisions += u32::from(world.touches(PairId(0)));
        self.look(world);
        (self.steps >= self.config.steps).then(|| self.approach())
    }

    fn record(&self, world: &W, recorder: &mut dyn Recorder) {
        record_step(world, &self.x, &self.y, [self.parts.body, self.lamp], recorder);
        let [x, y, heading] = place_and_heading(world, self.parts.body);
        recorder.scalars(&[x, y, heading, self.distances[1], self.bearings[1], f64::from(self.collisions)]);
        recorder.tick(seconds(self.steps, self.config.time_step));
    }
}
