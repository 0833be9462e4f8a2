//! Configuration of the experiment `icub-reach-grasp`.

use farsa_body::robots::{Chain, Icub, IcubPosture, IcubTabletop, Side};
use farsa_lab::Error;
use farsa_nn::LeakyLayout;

use crate::icub_limits::{within, within_limits};

/// Number of sensory neurons.
pub const SENSORS: usize = 15;
/// Number of motor neurons.
pub const MOTORS: usize = 10;

/// The area in which the ball is placed during evolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Area {
    /// Full area that is used for the tests, 40 by 40 cm.
    #[default]
    Wide,
    /// An area of 20 by 20 cm.
    Medium,
    /// An area of 10 by 10 cm.
    Narrow,
}

impl Area {
    /// Names of the conditions. Use [`Area::from_name`] to convert them.
    pub const NAMES: [&str; 3] = ["wide", "medium", "narrow"];

    /// Returns the area with the given name. An unknown name results in the widest area.
    pub fn from_name(name: &str) -> Self {
        match name {
            "medium" => Self::Medium,
            "narrow" => Self::Narrow,
            _ => Self::Wide,
        }
    }

    /// Its extent along X and Y \[m\].
    fn size(self) -> f64 {
        match self {
            Self::Wide => 0.40,
            Self::Medium => 0.20,
            Self::Narrow => 0.10,
        }
    }
}

/// The complete configuration of the experiment. The reasons for the values are given in the table of settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Number of trials in an evaluation.
    pub trials: u32,
    /// Number of control steps in a trial.
    pub steps: u32,
    /// Duration of a control step (in seconds).
    pub time_step: f64,
    /// Number of dynamics steps in each control step.
    pub substeps: u32,
    /// X and y coordinates of the middle of the area in which the ball is placed (in meters).
    pub area_centre: [f64; 2],
    /// Size of that area along x and y (in meters).
    pub area_size: [f64; 2],
    /// Size of the area used for the tests (in meters). It has the same middle and is divided into cells.
    pub tested_size: [f64; 2],
    /// Radius of the ball in meters.
    pub ball_radius: f64,
    /// Mass of the ball (in kilograms).
    pub ball_mass: f64,
    /// Height of the table top in meters.
    pub table_top: f64,
    /// Initial pitch, roll and yaw of the trunk (in degrees).
    pub torso: [f64; 3],
    /// Initial pitch, roll and yaw of the head (in degrees).
    pub neck: [f64; 3],
    /// Initial angles of the seven joints of the right arm (in degrees).
    pub right_arm: [f64; 7],
    /// Angles of the left arm (in degrees). This arm does not move.
    pub left_arm: [f64; 7],
    /// Opposition of the thumb when the hand is open and when it is closed (in degrees).
    pub opposition: [f64; 2],
    /// Flexion of the joints of the thumb and of the fingers when the hand is closed (in degrees).
    pub flexion: [f64; 2],
    /// Horizontal field of view of the left eye (in degrees).
    pub field_of_view: f64,
    /// If true, the head follows the ball.
    pub tracking: bool,
    /// Fraction of the angle to the ball that the head corrects in each step.
    pub head_gain: f64,
    /// Largest speed at which the desired angles of the neck can change (in radians per second).
    pub head_speed: f64,
    /// Number of hidden neurons.
    pub hidden: u32,
    /// Largest absolute value of a weight or bias.
    pub weight_range: f64,
    /// Length of the period at the end of a trial in which touch and height are rewarded (in seconds).
    pub window: f64,
    /// Height above the table at which the ball counts as lifted and the reward for height is largest (in meters).
    pub height: f64,
    /// Time for which the ball must be held up at the end of a successful trial (in seconds).
    pub hold: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            trials: 12,
            steps: 300,
            time_step: 0.05,
            substeps: 10,
            area_centre: [0.32, -0.08],
            area_size: [0.40, 0.40],
            tested_size: [0.40, 0.40],
            ball_radius: 0.04,
            ball_mass: 0.080,
            table_top: -0.08,
            torso: [0.0; 3],
            neck: [-30.0, 0.0, 0.0],
            right_arm: [-30.0, 45.0, 0.0, 90.0, 0.0, 0.0, 0.0],
            left_arm: [-20.0, 30.0, 0.0, 100.0, 0.0, 0.0, 0.0],
            opposition: [-90.0, -90.0],
            flexion: [60.0, 75.0],
            field_of_view: 60.0,
            tracking: true,
            head_gain: 0.5,
            head_speed: 2.0,
            hidden: 6,
            weight_range: 4.0,
            window: 5.0,
            height: 0.10,
            hold: 1.0,
        }
    }
}

impl Config {
    /// Returns the default configuration for an area.
    pub fn for_area(area: Area) -> Self {
        Self { area_size: [area.size(); 2], ..Self::default() }
    }

    /// Builds the description of the robot. The left arm and hand are rigid.
    pub fn icub(&self) -> Icub {
        let mut posture = IcubPosture {
            torso: self.torso.map(f64::to_radians),
            neck: self.neck.map(f64::to_radians),
            left_arm: self.left_arm.map(f64::to_radians),
            right_arm: self.right_arm.map(f64::to_radians),
            ..IcubPosture::default()
        };
        posture.right_hand[0] = self.opposition[0].to_radians();
        Icub {
            actuated: vec![Chain::Torso, Chain::Neck, Chain::RightArm, Chain::RightHand],
            posture,
            ..Icub::default()
        }
    }

    /// Builds the description of the table and the ball.
    pub fn tabletop(&self) -> IcubTabletop {
        let Self { ball_radius, ball_mass, table_top, area_centre, .. } = *self;
        IcubTabletop { ball_radius, ball_mass, table_top, ball_start: area_centre, ..IcubTabletop::default() }
    }

    /// Returns the layout of the agent's network.
    pub fn layout(&self) -> LeakyLayout {
        LeakyLayout::new(SENSORS, self.hidden as usize, MOTORS)
    }

    /// Returns the number of steps in which touch and height are rewarded. It never exceeds the length of the trial.
    pub fn window_steps(&self) -> u32 {
        self.steps_in(self.window)
    }

    /// Returns the number of steps for which the ball must be held up at the end. It never exceeds the length of the
    /// trial.
    pub fn hold_steps(&self) -> u32 {
        self.steps_in(self.hold)
    }

    fn steps_in(&self, seconds: f64) -> u32 {
        ((seconds / self.time_step + 0.5) as u32).clamp(1, self.steps)
    }

    /// Checks that the values are compatible with each other.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] if the initial posture violates a joint limit, or if the ball would not be on the
    /// table.
    pub fn check(&self) -> Result<(), Error> {
        let icub = self.icub();
        let chains = [
            ("start.torso", Chain::Torso, &self.torso[..]),
            ("start.neck", Chain::Neck, &self.neck[..]),
            ("start.right_arm", Chain::RightArm, &self.right_arm[..]),
            ("start.left_arm", Chain::LeftArm, &self.left_arm[..]),
        ];
        for (key, chain, angles) in chains {
            within_limits(&icub, key, chain, angles)?;
        }
        let hand = icub.ranges(Side::Right.hand());
        for angle in self.opposition {
            within("hand.opposition", "J8", angle, hand[0])?;
        }
        for angle in self.flexion {
            within("hand.flexion", "J9", -angle, hand[1])?;
        }
        let table = self.tabletop();
        for (key, size) in [("area.size", self.area_size), ("area.tested", self.tested_size)] {
            for (axis, [low, high]) in [table.table_x, table.table_y].into_iter().enumerate() {
                let (middle, half) = (self.area_centre[axis], 0.5 * size[axis]);
                if middle - half < low || middle + half > high {
                    let (from, to, axis) = (middle - half, middle + half, ["x", "y"][axis]);
                    let text = format!("{axis} from {from} to {to} m, the table from {low} to {high} m");
                    return Err(Error::setting(key, text));
                }
            }
        }
        Ok(())
    }
}
