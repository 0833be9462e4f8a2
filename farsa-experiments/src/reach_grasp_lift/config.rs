//! Configuration of the experiment `reach-grasp-lift`.

use farsa_body::actuators::{MuscleVariant, Servo};
use farsa_body::robot::Surface;
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::sensors::Axes;
use farsa_nn::{Leak, LeakyLayout};
use farsa_physics::articulated::Options;

use crate::reach_grasp_lift::fitness::Judgement;
use crate::worlds::Engine;

/// Number of trials in an evaluation. Each trial has a different start \[Ferrauto2010, 2.3.4\].
pub const TRIALS: usize = 4;
/// Number of motor channels. There is an activation for each of the 14 muscles, and a position for each of the 9 servo
/// groups.
pub const OUTPUTS: usize = 23;
/// Sensor channels without the labels.
pub(crate) const PLAIN_SENSORS: usize = 26;
/// Labels, one for each phase.
pub(crate) const LABELS: usize = 3;

/// Largest distance by which a link leaves its tangent in a dynamics step before the step is halved (in meters).
const PATH_ERROR: f64 = 1e-4;

/// Defines which individuals share the random displacements at the start of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Displacement {
    /// All individuals of a generation have the same displacements, so their fitness can be compared directly.
    #[default]
    PerGeneration,
    /// Each individual draws different displacements.
    PerIndividual,
}

/// Defines how the positions (tx, ty) of the sphere in the source, in centimeters, are mapped to our world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SphereFrame {
    /// Mapping X = ty, Y = tx. A negative tx is towards the right arm.
    #[default]
    Forward,
    /// Mapping X = -tx, Y = -ty, corresponding to the axes of the iCub's root. It results in the same four
    /// positions, but reverses their assignment to the initial postures of the arm.
    Icub,
}

/// The source of the three label inputs of the network. Each variant is a condition of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Labels {
    /// Labels of the current phase. This is condition A of the source.
    #[default]
    Given,
    /// No label inputs. This is condition B of the source.
    None,
    /// Three further outputs of the network. Their values are the labels of the next step, and 0 in the first step of a
    /// trial.
    Own,
}

impl Labels {
    /// All variants in the order of the conditions.
    pub const ALL: [Self; 3] = [Self::Given, Self::None, Self::Own];
    /// Names of the conditions.
    pub const NAMES: [&'static str; 3] = ["labels", "no-labels", "self-labels"];

    /// Returns the variant of the condition with the given name. An unknown name results in [`Labels::Given`].
    pub fn from_name(name: &str) -> Self {
        Self::ALL.into_iter().find(|labels| labels.name() == name).unwrap_or_default()
    }

    /// Returns the name of the condition.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Returns the number of label inputs.
    pub fn inputs(self) -> usize {
        if self == Self::None { 0 } else { LABELS }
    }

    /// Returns the number of outputs for labels.
    pub fn outputs(self) -> usize {
        if self == Self::Own { LABELS } else { 0 }
    }
}

/// The complete configuration of the experiment. The defaults are those of the specification.
///
/// Lengths are in meters, angles in degrees, and all other quantities in SI units unless stated otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Source of the label inputs.
    pub labels: Labels,
    /// Physics engine that simulates the robot.
    pub engine: Engine,
    /// Duration of a control step (in seconds).
    pub time_step: f64,
    /// Number of dynamics steps in each control step. In rapier there are twice as many, because it halves none.
    pub substeps: u32,
    /// Downward acceleration of gravity (in m/s2).
    pub gravity: f64,
    /// Number of sweeps of the contact solver in each dynamics step.
    pub sweeps: u32,
    /// Creep of a sticking contact, as tangential speed per impulse of a dynamics step (in m/s per N s).
    pub slip: f64,
    /// Natural frequency of a joint's stop (in radians per second).
    pub limit_frequency: f64,
    /// Number of control steps of a trial.
    pub steps: u32,
    /// Initial angles of the joints J1 to J4 in each trial (in degrees).
    pub arm_poses: [f64; 4 * TRIALS],
    /// Initial position (tx, ty) of the sphere in each trial (in centimeters).
    pub sphere_positions: [f64; 2 * TRIALS],
    /// Mapping from these positions to the world.
    pub sphere_frame: SphereFrame,
    /// Largest random displacement of a joint at the start (in degrees).
    pub joint_displacement: f64,
    /// Largest random displacement of the sphere along x and along y at the start (in centimeters).
    pub sphere_displacement: f64,
    /// Defines which individuals share the displacements.
    pub displacement: Displacement,
    /// Position in the world at which the axes of J1 to J3 intersect (in meters).
    pub shoulder: [f64; 3],
    /// Variant of the muscle model.
    pub muscles: MuscleVariant,
    /// Moment arm of the muscles (in meters).
    pub moment_arm: f64,
    /// Factor that reduces the passive tension of the muscles in the original program.
    pub passive_reduction: f64,
    /// Damping of each arm joint, relative to the largest torque of its muscles (in s/rad).
    pub damping: f64,
    /// Armature of the arm joints (in kg m2).
    pub arm_armature: f64,
    /// Armature of the hand joints (in kg m2).
    pub hand_armature: f64,
    /// Position gain of the finger servos (in N m/rad).
    pub servo_stiffness: f64,
    /// Velocity gain of the finger servos (in N m s/rad).
    pub servo_damping: f64,
    /// Largest force of a finger tendon (in newtons).
    pub servo_force: f64,
    /// Moment arm of a finger tendon (in meters).
    pub tendon_radius: f64,
    /// Passive damping of the hand joints (in N m s/rad).
    pub hand_damping: f64,
    /// Radius of the sphere (in meters).
    pub sphere_radius: f64,
    /// Mass of the sphere (in kilograms).
    pub sphere_mass: f64,
    /// Lower and upper ends of the table top along x (in meters).
    pub table_x: [f64; 2],
    /// Lower and upper ends of the table top along y (in meters).
    pub table_y: [f64; 2],
    /// Depth of the table (in meters). The table is a solid block below z = 0.
    pub table_depth: f64,
    /// Coefficient of sliding friction. This is the same for all surfaces.
    pub friction: f64,
    /// Rolling friction between the sphere and the table (in meters).
    pub rolling_friction: f64,
    /// Normal stiffness of each contact point (in N/m).
    pub contact_stiffness: f64,
    /// Normal damping of each contact point (in N s/m).
    pub contact_damping: f64,
    /// Number of contacts at which a touch sensor is saturated.
    pub touch_saturation: f64,
    /// Value of the label input for the current phase. For [`Labels::Own`] it is a factor of the outputs for labels.
    pub label_amplitude: f64,
    /// Axes of the sensors for the position of the sphere.
    pub target_axes: Axes,
    /// Number of hidden neurons in the network.
    pub hidden: u32,
    /// Slope of the logistic function.
    pub slope: f64,
    /// Interpretation of the leak parameters.
    pub leak: Leak,
    /// Largest absolute value of a weight or bias.
    pub weight_range: f64,
    /// Rules that determine the reward and the success of a trial.
    pub judgement: Judgement,
}

impl Default for Config {
    fn default() -> Self {
        let (arm, table, options) = (ArmAndHand::default(), Tabletop::default(), Options::default());
        Self {
            labels: Labels::default(),
            engine: Engine::default(),
            time_step: options.time_step,
            substeps: 2,
            gravity: -options.gravity[2],
            sweeps: options.sweeps,
            slip: options.friction_compliance,
            limit_frequency: options.limit_frequency,
            steps: 600,
            arm_poses: [
                -73.0, -30.0, -40.0, -56.0, //
                -73.0, -30.0, -40.0, -113.0, //
                -6.0, 30.0, -10.0, -56.0, //
                -73.0, -30.0, 45.0, -113.0,
            ],
            sphere_positions: [-18.0, 10.0, -26.0, 18.0, -18.0, 26.0, -10.0, 18.0],
            sphere_frame: SphereFrame::default(),
            joint_displacement: 1.0,
            sphere_displacement: 1.5,
            displacement: Displacement::default(),
            shoulder: arm.shoulder,
            muscles: arm.muscle_variant,
            moment_arm: arm.moment_arm,
            passive_reduction: arm.passive_reduction,
            damping: arm.damping_per_torque,
            arm_armature: arm.arm_armature,
            hand_armature: arm.finger_armature,
            servo_stiffness: arm.servo.stiffness,
            servo_damping: arm.servo.damping,
            servo_force: 300.0,
            tendon_radius: 0.001,
            hand_damping: arm.finger_damping,
            sphere_radius: table.sphere_radius,
            sphere_mass: table.sphere_mass,
            table_x: table.table_x,
            table_y: table.table_y,
            table_depth: table.table_depth,
            friction: arm.surface.friction,
            rolling_friction: table.sphere_on_table.rolling_friction,
            contact_stiffness: arm.surface.stiffness,
            contact_damping: arm.surface.damping,
            touch_saturation: 3.0,
            label_amplitude: 50.0,
            target_axes: Axes::Body,
            hidden: 12,
            slope: 0.2,
            leak: Leak::Filter,
            weight_range: 6.0,
            judgement: Judgement::default(),
        }
    }
}

impl Config {
    /// Returns the default configuration of a condition.
    pub fn for_condition(labels: Labels) -> Self {
        Self { labels, ..Self::default() }
    }

    /// Returns the x and y coordinates of the sphere's center at the start of a trial, without random displacement (in
    /// meters).
    pub fn sphere_start(&self, trial: usize) -> [f64; 2] {
        let [tx, ty] = [0, 1].map(|k| self.sphere_positions[2 * (trial % TRIALS) + k] / 100.0);
        match self.sphere_frame {
            SphereFrame::Forward => [ty, tx],
            SphereFrame::Icub => [-tx, -ty],
        }
    }

    /// Builds the description of the arm and the hand.
    pub fn arm(&self) -> ArmAndHand {
        // Torque is force times the radius of the tendon (in N m).
        let limit = self.servo_force * self.tendon_radius;
        ArmAndHand {
            shoulder: self.shoulder,
            moment_arm: self.moment_arm,
            muscle_variant: self.muscles,
            passive_reduction: self.passive_reduction,
            damping_per_torque: self.damping,
            arm_armature: self.arm_armature,
            finger_armature: self.hand_armature,
            servo: Servo { stiffness: self.servo_stiffness, damping: self.servo_damping, limit },
            finger_damping: self.hand_damping,
            surface: self.surface(),
            ..ArmAndHand::default()
        }
    }

    /// Builds the description of the table and the sphere.
    pub fn tabletop(&self) -> Tabletop {
        let surface = self.surface();
        Tabletop {
            table_x: self.table_x,
            table_y: self.table_y,
            table_depth: self.table_depth,
            sphere_radius: self.sphere_radius,
            sphere_mass: self.sphere_mass,
            sphere_start: self.sphere_start(0),
            hand_on_sphere: surface,
            sphere_on_table: Surface { rolling_friction: self.rolling_friction, ..surface },
            arm_on_table: surface,
        }
    }

    fn surface(&self) -> Surface {
        Surface {
            friction: self.friction,
            rolling_friction: 0.0,
            stiffness: self.contact_stiffness,
            damping: self.contact_damping,
        }
    }

    /// Returns the options for simulations in rapier. The other values of [`Config::options`] have no effect there.
    #[cfg(feature = "rapier")]
    pub fn rapier_options(&self) -> farsa_physics::rapier::Options {
        farsa_physics::rapier::Options {
            time_step: self.time_step,
            // Its steps are not halved where links are fast, so all of them are as short as our halves.
            substeps: 2 * self.substeps,
            gravity: [0.0, 0.0, -self.gravity],
            ..farsa_physics::rapier::Options::default()
        }
    }

    /// Returns the options of the articulated world.
    pub fn options(&self) -> Options {
        Options {
            time_step: self.time_step,
            substeps: self.substeps,
            gravity: [0.0, 0.0, -self.gravity],
            sweeps: self.sweeps,
            friction_compliance: self.slip,
            limit_frequency: self.limit_frequency,
            path_error: Some(PATH_ERROR),
            ..Options::default()
        }
    }

    /// Returns the layout of the network. It has 29 sensors with labels and 26 sensors without. There are 26 outputs for
    /// [`Labels::Own`] and 23 outputs otherwise.
    pub fn layout(&self) -> LeakyLayout {
        let (sensors, outputs) = (PLAIN_SENSORS + self.labels.inputs(), OUTPUTS + self.labels.outputs());
        LeakyLayout::new(sensors, self.hidden as usize, outputs).with_slope(self.slope as f32)
    }

    /// Returns the number of control steps per second. It is at least one.
    pub fn steps_per_second(&self) -> u32 {
        (1.0 / self.time_step).round().max(1.0) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_those_of_the_body() {
        let config = Config::default();
        let (arm, default) = (config.arm(), ArmAndHand::default());
        assert!((arm.servo.limit - default.servo.limit).abs() < 1e-12);
        assert_eq!(ArmAndHand { servo: default.servo, ..arm }, default);
        assert_eq!(config.tabletop(), Tabletop::default());
        assert_eq!(config.layout().parameter_count(), 792);
        assert_eq!(Config::for_condition(Labels::None).layout().parameter_count(), 756);
        // 29 and 12 inputs and a bias and a leak for each hidden neuron, 12 inputs for each of the 26 outputs.
        let own = Config::for_condition(Labels::Own).layout();
        assert_eq!((own.sensors(), own.outputs(), own.parameter_count()), (29, 26, 43 * 12 + 12 * 26));
        let undamped = Config { damping: 0.0, ..Config::default() };
        assert_eq!(undamped.arm().robot().unwrap().segments[0].joint.damping, 0.0);
    }

    #[test]
    fn the_spheres_places_in_both_frames() {
        let mut config = Config::default();
        let places =
            |config: &Config| [0, 1, 2, 3].map(|trial| config.sphere_start(trial).map(|x| (x * 100.0).round()));
        let forward = places(&config);
        assert_eq!(forward, [[10.0, -18.0], [18.0, -26.0], [26.0, -18.0], [18.0, -10.0]]);
        config.sphere_frame = SphereFrame::Icub;
        let mut reversed = places(&config);
        reversed.reverse();
        assert_eq!(reversed, forward);
    }
}
