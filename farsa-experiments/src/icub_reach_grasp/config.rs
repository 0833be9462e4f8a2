//! The values of `icub-reach-grasp`.

use farsa_body::robots::{Chain, Icub, IcubPosture, IcubTabletop, Side};
use farsa_lab::Error;
use farsa_nn::LeakyLayout;

use crate::icub_limits::{within, within_limits};

/// Sensory neurons.
pub const SENSORS: usize = 15;
/// Motor neurons.
pub const MOTORS: usize = 10;

/// The area of the ball during evolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Area {
    /// 40 by 40 cm, all that is tested.
    #[default]
    Wide,
    /// 20 by 20 cm.
    Medium,
    /// 10 by 10 cm.
    Narrow,
}

impl Area {
    /// The names of the conditions, as [`Area::from_name`] takes them.
    pub const NAMES: [&str; 3] = ["wide", "medium", "narrow"];

    /// The area of a condition's name, or the widest one.
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

/// Every value of the experiment. `settings` has the reasons.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Trials of an evaluation.
    pub trials: u32,
    /// Control steps of a trial.
    pub steps: u32,
    /// Control step \[s\].
    pub time_step: f64,
    /// Dynamics steps of a control step.
    pub substeps: u32,
    /// Middle of the area in which the ball lies, X and Y \[m\].
    pub area_centre: [f64; 2],
    /// Its extent along X and Y \[m\].
    pub area_size: [f64; 2],
    /// The extent of the area, with the same middle, that is tested part by part \[m\].
    pub tested_size: [f64; 2],
    /// Radius of the ball \[m\].
    pub ball_radius: f64,
    /// Its mass \[kg\].
    pub ball_mass: f64,
    /// Height of the table's top \[m\].
    pub table_top: f64,
    /// Pitch, roll and yaw of the trunk at the start \[deg\].
    pub torso: [f64; 3],
    /// Pitch, roll and yaw of the head at the start \[deg\].
    pub neck: [f64; 3],
    /// The right arm's seven joints at the start \[deg\].
    pub right_arm: [f64; 7],
    /// The left arm's, which are rigid \[deg\].
    pub left_arm: [f64; 7],
    /// Opposition of the thumb while the hand is open and while it is closed \[deg\].
    pub opposition: [f64; 2],
    /// Flexion of the thumb's and of the fingers' joints while the hand is closed \[deg\].
    pub flexion: [f64; 2],
    /// Horizontal field of view of the left eye \[deg\].
    pub field_of_view: f64,
    /// The head follows the ball.
    pub tracking: bool,
    /// Part of the angle to the ball that the head makes up for in a step.
    pub head_gain: f64,
    /// Largest speed of the neck's desired angles \[rad/s\].
    pub head_speed: f64,
    /// Hidden neurons.
    pub hidden: u32,
    /// Weights and biases are decoded to plus and minus this.
    pub weight_range: f64,
    /// The last seconds of a trial, of which touch and height count \[s\].
    pub window: f64,
    /// Height of the ball above the table that earns all there is to earn and counts as lifted \[m\].
    pub height: f64,
    /// Time for which the ball must be up at the end of a successful trial \[s\].
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
    /// The values of a condition.
    pub fn for_area(area: Area) -> Self {
        Self { area_size: [area.size(); 2], ..Self::default() }
    }

    /// The robot with these values: the left arm and hand are rigid.
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

    /// The table with these values.
    pub fn tabletop(&self) -> IcubTabletop {
        let Self { ball_radius, ball_mass, table_top, area_centre, .. } = *self;
        IcubTabletop { ball_radius, ball_mass, table_top, ball_start: area_centre, ..IcubTabletop::default() }
    }

    /// The network of an agent.
    pub fn layout(&self) -> LeakyLayout {
        LeakyLayout::new(SENSORS, self.hidden as usize, MOTORS)
    }

    /// Steps at the end of a trial of which touch and height count, all at most.
    pub fn window_steps(&self) -> u32 {
        self.steps_in(self.window)
    }

    /// Steps that the ball must be up at the end, all at most.
    pub fn hold_steps(&self) -> u32 {
        self.steps_in(self.hold)
    }

    fn steps_in(&self, seconds: f64) -> u32 {
        ((seconds / self.time_step + 0.5) as u32).clamp(1, self.steps)
    }

    /// Rules between values.
    ///
    /// # Errors
    /// [`Error::Setting`] for a start out of the joints' limits, or a ball that does not lie on the table.
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
