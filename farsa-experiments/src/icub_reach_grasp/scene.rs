//! The scene of `icub-reach-grasp`. It defines the start of a trial and the observations that are made after each step.

use farsa_body::ports::{ActuatorId, Arrange, BodyId, Contacts, Handles, JointId, Kinematics, PairId};
use farsa_body::robot::Robot;
use farsa_body::robots::{Finger, Icub, IcubError, IcubTabletop, Side};
use farsa_body::{Pose, Twist};
use farsa_lab::{EpisodeId, Error};
use farsa_num::{Domain, Scalar, Stream};
use farsa_physics::articulated::Options;

use crate::icub_reach_grasp::config::Config;
use crate::icub_reach_grasp::fitness::{Observation, PARTS, opposition};

/// The parts of the area in which the ball lies in a round of twelve trials, along X and Y.
const GRID: [u32; 2] = [3, 4];

/// Its color in the robot's eye.
const SKIN: [f64; 3] = [0.78, 0.80, 0.84];

/// A part of the hand: its pair with the ball, and a point in its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    on_ball: PairId,
    body: BodyId,
    middle: [f64; 3],
}

/// The description of the robot, together with the identifiers of its parts.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Description of the robot, the ball and the table.
    pub robot: Robot,
    /// The iCub from which the description was built.
    pub icub: Icub,
    /// Configuration from which the scene was built.
    pub config: Config,
    /// Moving joints with their start angles \[rad\].
    start: Vec<(JointId, f32)>,
    parts: [Part; PARTS],
    /// Contact pairs of the ball with everything except the hand.
    others: Vec<PairId>,
}

pub(crate) fn wrong(error: &dyn core::fmt::Display) -> Error {
    Error::Other(format!("icub-reach-grasp: {error}"))
}

impl Scene {
    /// Body of the right palm.
    pub const PALM: BodyId = BodyId(19);
    /// Body of the ball.
    pub const BALL: BodyId = IcubTabletop::BALL;

    /// Builds the scene for a configuration.
    ///
    /// # Errors
    /// Returns the errors of [`Config::check`], or [`Error::Other`] if the robot cannot be simulated.
    pub fn new(config: Config) -> Result<Self, Error> {
        config.check()?;
        let icub = config.icub();
        let mut robot = config.tabletop().scene(&icub).map_err(|error| wrong(&error))?;
        for collider in &mut robot.colliders {
            collider.color.get_or_insert(SKIN);
        }
        debug_assert_eq!(Self::PALM, Icub::palm(Side::Right));
        let ball = robot.colliders.iter().position(|collider| collider.body == Some(Self::BALL));
        let ball = ball.ok_or_else(|| wrong(&"no ball"))?;
        let start = icub.start().into_iter().map(|angle| angle as f32);
        let start = robot.joints().zip(start).collect();
        let hand =
            [Self::PALM].into_iter().chain(Finger::ALL.into_iter().flat_map(|f| Icub::phalanges(Side::Right, f)));
        let hand: Vec<BodyId> = hand.collect();
        let (mut parts, mut others) = (Vec::new(), Vec::new());
        for (number, pair) in robot.pairs.iter().enumerate() {
            let [a, b] = pair.colliders;
            let other = match (a == ball, b == ball) {
                (true, false) => b,
                (false, true) => a,
                _ => continue,
            };
            let on_ball = PairId(number as u16);
            let collider = &robot.colliders[other];
            match collider.body.filter(|body| hand.contains(body)) {
                Some(body) if body == Self::PALM => {
                    parts.push(Part { on_ball, body, middle: icub.palm_centre(Side::Right) });
                }
                Some(body) => parts.push(Part { on_ball, body, middle: collider.placement.position }),
                None => others.push(on_ball),
            }
        }
        let parts = parts.try_into().map_err(|found: Vec<Part>| wrong(&format_args!("{} parts", found.len())))?;
        Ok(Self { robot, icub, config, start, parts, others })
    }

    /// Returns the options of the articulated world.
    pub fn options(&self) -> Options {
        let Config { time_step, substeps, .. } = self.config;
        Options { time_step, substeps, ..Options::default() }
    }

    /// Returns the actuator of the joint with the given name.
    ///
    /// # Errors
    /// Returns [`Error::Other`] if the joint does not exist or is rigid.
    pub fn actuator(&self, joint: &str) -> Result<ActuatorId, Error> {
        self.icub.actuator(joint).map_err(|error| wrong(&error))
    }

    /// Returns the joint with the given name.
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::actuator`].
    pub fn joint(&self, joint: &str) -> Result<JointId, Error> {
        self.icub.joint(joint).map_err(|error: IcubError| wrong(&error))
    }

    /// Returns the limits of the joint with the given name (in radians).
    ///
    /// # Errors
    /// Returns the same errors as [`Scene::actuator`].
    pub fn range(&self, joint: &str) -> Result<[f64; 2], Error> {
        self.icub.range(joint).map_err(|error| wrong(&error))
    }

    /// Returns the contact pairs of the hand and the ball. The palm comes first, followed by the phalanges from the
    /// thumb to the little finger.
    pub fn on_ball(&self) -> impl Iterator<Item = PairId> + '_ {
        self.parts.iter().map(|part| part.on_ball)
    }

    /// Draws the x and y coordinates of the ball for a trial (in meters). The area is divided into twelve parts, and
    /// twelve consecutive trials use each part once.
    ///
    /// The coordinates are drawn from the stream of [`Domain::Start`], so all individuals of a generation have the same
    /// starts.
    pub fn place(&self, id: EpisodeId) -> [f64; 2] {
        let part = id.trial % (GRID[0] * GRID[1]);
        self.place_of(id, [part / GRID[1], part % GRID[1]], GRID, self.config.area_size)
    }

    /// Draws the position of the ball for a trial from one cell of the tested area (in meters). The argument `cells`
    /// gives the number of cells along x and y.
    pub fn place_in(&self, id: EpisodeId, cell: [u32; 2], cells: [u32; 2]) -> [f64; 2] {
        self.place_of(id, cell, cells, self.config.tested_size)
    }

    fn place_of(&self, id: EpisodeId, cell: [u32; 2], cells: [u32; 2], size: [f64; 2]) -> [f64; 2] {
        let mut stream = Stream::new(id.seed, Domain::Start, id.trial, 0, id.generation);
        [0, 1].map(|k| {
            // A uniform place within cell k of n, as a share (k + u) / n of the side. Sides are centered on the area.
            let share = (f64::from(cell[k]) + stream.range_f64(0.0, 1.0)) / f64::from(cells[k]);
            self.config.area_centre[k] + size[k] * (share - 0.5)
        })
    }

    /// Moves the robot to its initial posture and places the ball on the table at the given coordinates (in meters).
    pub fn arrange<W>(&self, world: &mut W, [x, y]: [f64; 2])
    where
        W: Arrange + Handles<Body = BodyId, Joint = JointId> + ?Sized,
    {
        world.clear();
        for (joint, angle) in &self.start {
            world.place_joint(*joint, *angle, 0.0);
        }
        let z = self.config.table_top + self.config.ball_radius;
        world.place_body(Self::BALL, Pose::at([x, y, z].map(|x| x as f32)), Twist::default());
        world.finish_placement();
    }

    /// Computes an observation from the current state of a world.
    pub fn observe<W>(&self, world: &W) -> Observation
    where
        W: Kinematics + Contacts + Handles<Body = BodyId> + ?Sized,
    {
        let Config { ball_radius, table_top, .. } = self.config;
        let ball = world.pose(Self::BALL).position.map(f64::from);
        let palm = world.pose(Self::PALM).cast::<f64>().transform(self.icub.palm_centre(Side::Right));
        let mut directions = [[0.0; 3]; PARTS];
        let mut touching = 0;
        for part in self.parts.iter().filter(|part| world.touches(part.on_ball)) {
            let at = world.pose(part.body).cast::<f64>().transform(part.middle);
            directions[touching] = [0, 1, 2].map(|k| at[k] - ball[k]);
            touching += 1;
        }
        let apart = [0, 1, 2].map(|k| palm[k] - ball[k]);
        let apart = Scalar::sqrt(apart.iter().fold(0.0, |sum: f64, x| sum + x * x));
        Observation {
            palm,
            ball,
            // From the center of the palm to the surface of the ball, 0 inside.
            distance: (apart - ball_radius).max(0.0),
            // 0 for a ball that rests on the table.
            height: ball[2] - ball_radius - table_top,
            touching: touching as u32,
            opposition: opposition(&directions[..touching]),
            // Contact with anything except the hand, such as the table.
            supported: self.others.iter().any(|pair| world.touches(*pair)),
        }
    }
}
