//! The values of `reach-grasp-lift` and what is built from them.

use farsa_body::actuators::{MuscleVariant, Servo};
use farsa_body::robot::Surface;
use farsa_body::robots::{ArmAndHand, Tabletop};
use farsa_body::sensors::Axes;
use farsa_nn::{Leak, LeakyLayout};
use farsa_physics::articulated::Options;

use crate::reach_grasp_lift::fitness::Judgement;
use crate::worlds::Engine;

/// Trials of an evaluation, each with its own start \[Ferrauto2010, 2.3.4\].
pub const TRIALS: usize = 4;

/// Which individuals share the random displacements of a trial's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Displacement {
    /// All individuals of a generation: their fitness is compared on equal terms.
    #[default]
    PerGeneration,
    /// None: every individual draws its own.
    PerIndividual,
}

/// The orientation in our world of the source's sphere positions (tx, ty) \[cm\].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SphereFrame {
    /// X = ty, Y = tx: negative tx is towards the right arm.
    #[default]
    Forward,
    /// X = -tx, Y = -ty, the iCub root's axes: the same four places, the pairing with the arm poses reversed.
    Icub,
}

/// The values of `reach-grasp-lift`. The defaults are those of the specification.
///
/// Lengths are in meters and angles in degrees. Other units are SI, with exceptions at their fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The controller senses the phase: condition A `labels`, or B `no-labels`.
    pub labels: bool,
    /// The physics of the bodies.
    pub engine: Engine,
    /// Control step \[s\].
    pub time_step: f64,
    /// Dynamics steps per control step.
    pub substeps: u32,
    /// Gravity, downwards \[m/s2\].
    pub gravity: f64,
    /// Sweeps of the contact solver per dynamics step.
    pub sweeps: u32,
    /// Creep of a sticking contact: tangential speed per impulse of a dynamics step \[m/s per N s\].
    pub slip: f64,
    /// Natural frequency of a joint's stop \[rad/s\].
    pub limit_frequency: f64,
    /// Steps of a trial.
    pub steps: u32,
    /// J1..J4 at the start of each trial \[deg\].
    pub arm_poses: [f64; 4 * TRIALS],
    /// (tx, ty) of the sphere at the start of each trial \[cm\].
    pub sphere_positions: [f64; 2 * TRIALS],
    /// Their orientation in the world.
    pub sphere_frame: SphereFrame,
    /// Largest displacement of a joint at the start \[deg\].
    pub joint_displacement: f64,
    /// Largest displacement of the sphere at the start, along x and y \[cm\].
    pub sphere_displacement: f64,
    /// Which individuals share the displacements.
    pub displacement: Displacement,
    /// The intersection of the axes of J1..J3 \[m\].
    pub shoulder: [f64; 3],
    /// Which reading of the muscle model.
    pub muscles: MuscleVariant,
    /// Moment arm of the muscles \[m\].
    pub moment_arm: f64,
    /// Factor on the passive tension of the original program's muscles.
    pub passive_reduction: f64,
    /// Damping of an arm joint in proportion to its muscles' largest torque, moment arm * Tmax \[s/rad\].
    pub damping: f64,
    /// Armature of the arm's joints \[kg m2\].
    pub arm_armature: f64,
    /// Armature of the hand's joints \[kg m2\].
    pub hand_armature: f64,
    /// Position gain of the finger servos \[N m/rad\].
    pub servo_stiffness: f64,
    /// Speed gain of the finger servos \[N m s/rad\].
    pub servo_damping: f64,
    /// Largest force in a finger's tendon \[N\].
    pub servo_force: f64,
    /// Moment arm of a finger's tendon \[m\].
    pub tendon_radius: f64,
    /// Passive damping of the hand's joints \[N m s/rad\].
    pub hand_damping: f64,
    /// Radius of the sphere \[m\].
    pub sphere_radius: f64,
    /// Mass of the sphere \[kg\].
    pub sphere_mass: f64,
    /// Where the table's top begins and ends along x \[m\].
    pub table_x: [f64; 2],
    /// Where the table's top begins and ends along y \[m\].
    pub table_y: [f64; 2],
    /// Depth of the table, a solid block below z = 0 \[m\].
    pub table_depth: f64,
    /// Coefficient of sliding friction of all surfaces.
    pub friction: f64,
    /// Rolling friction of the sphere on the table \[m\].
    pub rolling_friction: f64,
    /// Normal stiffness of a contact point \[N/m\].
    pub contact_stiffness: f64,
    /// Normal damping of a contact point \[N s/m\].
    pub contact_damping: f64,
    /// Number of contacts that saturates a touch sensor.
    pub touch_saturation: f64,
    /// Value of the label that names the phase.
    pub label_amplitude: f64,
    /// Axes of the sensors of the sphere's position.
    pub target_axes: Axes,
    /// Number of hidden neurons.
    pub hidden: u32,
    /// Slope of the logistic function.
    pub slope: f64,
    /// Which reading of the leak.
    pub leak: Leak,
    /// Weights and biases are decoded to plus and minus this.
    pub weight_range: f64,
    /// The rules of the judge.
    pub judgement: Judgement,
}

impl Default for Config {
    fn default() -> Self {
        let (arm, table, options) = (ArmAndHand::default(), Tabletop::default(), Options::default());
        Self {
            labels: true,
            engine: Engine::default(),
            time_step: options.time_step,
            substeps: options.substeps,
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
    /// The defaults under a condition: with the labels (A), or without (B).
    pub fn for_condition(labels: bool) -> Self {
        Self { labels, ..Self::default() }
    }

    /// The sphere's center at the start of a trial, without displacement, x and y in the world \[m\].
    pub fn sphere_start(&self, trial: usize) -> [f64; 2] {
        let [tx, ty] = [0, 1].map(|k| self.sphere_positions[2 * (trial % TRIALS) + k] / 100.0);
        match self.sphere_frame {
            SphereFrame::Forward => [ty, tx],
            SphereFrame::Icub => [-tx, -ty],
        }
    }

    /// The arm and hand with these values.
    pub fn arm(&self) -> ArmAndHand {
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

    /// The table and the sphere with these values.
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

    /// Options of rapier. The other numbers of [`Config::options`] have no meaning there.
    #[cfg(feature = "rapier")]
    pub fn rapier_options(&self) -> farsa_physics::rapier::Options {
        farsa_physics::rapier::Options {
            time_step: self.time_step,
            substeps: self.substeps,
            gravity: [0.0, 0.0, -self.gravity],
            ..farsa_physics::rapier::Options::default()
        }
    }

    /// Options of our physics.
    pub fn options(&self) -> Options {
        Options {
            time_step: self.time_step,
            substeps: self.substeps,
            gravity: [0.0, 0.0, -self.gravity],
            sweeps: self.sweeps,
            friction_compliance: self.slip,
            limit_frequency: self.limit_frequency,
            ..Options::default()
        }
    }

    /// The shape of the network: 29 sensors with labels or 26 without, 23 outputs.
    pub fn layout(&self) -> LeakyLayout {
        let sensors = if self.labels { 29 } else { 26 };
        LeakyLayout::new(sensors, self.hidden as usize, 23).with_slope(self.slope as f32)
    }

    /// Steps in a second, at least one.
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
        assert_eq!(Config::for_condition(false).layout().parameter_count(), 756);
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
