//! The entries of the settings of `reach-grasp-lift`, with their limits, units, sources and reasons.

use std::ops::RangeInclusive;

use farsa_body::actuators::MuscleVariant;
use farsa_body::sensors::Axes;
use farsa_lab::advanced::{ENGINE, Source};

use crate::reach_grasp_lift::config::{Config, Displacement, Labels, SphereFrame};
use crate::reach_grasp_lift::fitness::ContactTerm;
use crate::worlds::Engine;

/// The reader and writer of a field of the configuration.
pub(crate) enum Field {
    Number(fn(&mut Config) -> &mut f64, RangeInclusive<f64>),
    Numbers(fn(&mut Config) -> &mut [f64], RangeInclusive<f64>),
    Whole(fn(&mut Config) -> &mut u32, RangeInclusive<i64>),
    Word(&'static [&'static str], fn(&Config) -> &'static str, fn(&mut Config, &str)),
}

pub(crate) struct Entry {
    pub(crate) key: &'static str,
    pub(crate) field: Field,
    pub(crate) unit: &'static str,
    pub(crate) source: Source,
    pub(crate) doc: &'static str,
}

const fn entry(key: &'static str, field: Field, unit: &'static str, source: Source, doc: &'static str) -> Entry {
    Entry { key, field, unit, source, doc }
}

/// The settings of a condition in the order in which they are listed.
pub(crate) fn entries(labels: Labels) -> Vec<Entry> {
    let parts: [fn() -> Vec<Entry>; 4] = [world_entries, start_entries, arm_entries, thing_entries];
    let parts = parts.into_iter().flat_map(|part| part());
    parts.chain(controller_entries(labels)).chain(reward_entries()).collect()
}

fn world_entries() -> Vec<Entry> {
    use Field::{Number, Whole, Word};
    use Source::{Chosen, Given};
    vec![
        entry(
            ENGINE,
            Word(&Engine::NAMES, |c| c.engine.name(), |c, w| c.engine = w.parse().unwrap_or_default()),
            "",
            Chosen,
            "Physics: ours, or rapier's, which has no sweeps, slip, limit frequency, stiffness and damping of contacts.",
        ),
        entry("world.time_step", Number(|c| &mut c.time_step, 0.001..=0.05), "s", Given, "Control step."),
        entry(
            "world.substeps",
            Whole(|c| &mut c.substeps, 1..=100),
            "",
            Chosen,
            "Dynamics steps per control step, made in halves where a link is fast. 2 is the least at which no bound of the physics is broken in 10^6 random steps.",
        ),
        entry("world.gravity", Number(|c| &mut c.gravity, 0.0..=100.0), "m/s2", Chosen, "Gravity, downwards."),
        entry(
            "world.sweeps",
            Whole(|c| &mut c.sweeps, 1..=10_000),
            "",
            Chosen,
            "Sweeps over the contacts per dynamics step.",
        ),
        entry(
            "world.slip",
            Number(|c| &mut c.slip, 0.0..=1e6),
            "m/(s N s)",
            Chosen,
            "Creep of a sticking contact: tangential speed per impulse of a dynamics step.",
        ),
        entry(
            "world.limit_frequency",
            Number(|c| &mut c.limit_frequency, 1.0..=1e6),
            "rad/s",
            Chosen,
            "Natural frequency of a joint's stop, from the joint's own inertia.",
        ),
        entry("trial.steps", Whole(|c| &mut c.steps, 1..=1_000_000), "", Given, "Steps of each of the four trials."),
    ]
}

fn start_entries() -> Vec<Entry> {
    use Field::{Number, Numbers, Word};
    use Source::{Chosen, Given};
    vec![
        entry(
            "start.arm_poses",
            Numbers(|c| &mut c.arm_poses, -180.0..=180.0),
            "deg",
            Given,
            "J1..J4 at the start, trial after trial; J5..J7 and the hand start at 0 (chosen).",
        ),
        entry(
            "start.sphere",
            Numbers(|c| &mut c.sphere_positions, -100.0..=100.0),
            "cm",
            Given,
            "(tx, ty) of the sphere at the start, trial after trial. Pose k goes with position k (chosen).",
        ),
        entry(
            "start.sphere_frame",
            Word(
                &["forward", "icub"],
                |c| match c.sphere_frame {
                    SphereFrame::Forward => "forward",
                    SphereFrame::Icub => "icub",
                },
                |c, w| c.sphere_frame = if w == "icub" { SphereFrame::Icub } else { SphereFrame::Forward },
            ),
            "",
            Chosen,
            "Orientation of tx and ty in the world: forward X = ty, Y = tx, icub X = -tx, Y = -ty, which reverses the pairing with the poses.",
        ),
        entry(
            "start.joint_displacement",
            Number(|c| &mut c.joint_displacement, 0.0..=180.0),
            "deg",
            Given,
            "Largest displacement of a joint at the start, uniform, on all 27 joints, clamped into their ranges (chosen).",
        ),
        entry(
            "start.sphere_displacement",
            Number(|c| &mut c.sphere_displacement, 0.0..=100.0),
            "cm",
            Given,
            "Largest displacement of the sphere at the start along x and y, uniform (chosen).",
        ),
        entry(
            "start.displacement",
            Word(
                &["per-generation", "per-individual"],
                |c| match c.displacement {
                    Displacement::PerGeneration => "per-generation",
                    Displacement::PerIndividual => "per-individual",
                },
                |c, w| {
                    c.displacement =
                        if w == "per-individual" { Displacement::PerIndividual } else { Displacement::PerGeneration };
                },
            ),
            "",
            Chosen,
            "Individuals that share the displacements. Sharing by a generation compares its individuals on equal terms.",
        ),
    ]
}

fn arm_entries() -> Vec<Entry> {
    use Field::{Number, Numbers, Word};
    use Source::{Chosen, Given};
    vec![
        entry(
            "arm.shoulder",
            Numbers(|c| &mut c.shoulder, -10.0..=10.0),
            "m",
            Chosen,
            "Intersection of the axes of J1..J3, the highest place from which the far sphere is in reach.",
        ),
        entry(
            "arm.muscles",
            Word(
                &["thesis", "original"],
                |c| match c.muscles {
                    MuscleVariant::Thesis => "thesis",
                    MuscleVariant::Original => "original",
                },
                |c, w| c.muscles = if w == "original" { MuscleVariant::Original } else { MuscleVariant::Thesis },
            ),
            "",
            Chosen,
            "Muscles as printed (passive tension in full, b 0.9) or as in the original program (halved and reduced, b 1).",
        ),
        entry(
            "arm.moment_arm",
            Number(|c| &mut c.moment_arm, 1e-4..=1.0),
            "m",
            Chosen,
            "Moment arm of the muscles: 3 N m on most joints hold every posture of the task. 1 m reads N as N m.",
        ),
        entry(
            "arm.passive_reduction",
            Number(|c| &mut c.passive_reduction, 0.0..=1.0),
            "",
            Chosen,
            "Further factor on the passive tension of the original program's muscles. Its value there is not published.",
        ),
        entry(
            "arm.damping",
            Number(|c| &mut c.damping, 0.0..=1000.0),
            "s/rad",
            Chosen,
            "Damps each arm joint by this times moment arm * Tmax, beside the muscles' own viscosity; with 0 the arm rings \
             and slams into the table.",
        ),
        entry(
            "arm.armature",
            Number(|c| &mut c.arm_armature, 1e-4..=1.0),
            "kg m2",
            Chosen,
            "Inertia of the arm's drives.",
        ),
        entry(
            "hand.armature",
            Number(|c| &mut c.hand_armature, 1e-5..=1.0),
            "kg m2",
            Chosen,
            "Inertia of the hand's drives.",
        ),
        entry(
            "hand.servo_stiffness",
            Number(|c| &mut c.servo_stiffness, 0.0..=1000.0),
            "N m/rad",
            Chosen,
            "Position gain of the finger servos.",
        ),
        entry(
            "hand.servo_damping",
            Number(|c| &mut c.servo_damping, 0.0..=100.0),
            "N m s/rad",
            Chosen,
            "Speed gain of the finger servos.",
        ),
        entry(
            "hand.servo_force",
            Number(|c| &mut c.servo_force, 0.0..=1e6),
            "N",
            Given,
            "Largest force on a joint of the hand, beyond which it stalls or is pushed back.",
        ),
        entry(
            "hand.tendon_radius",
            Number(|c| &mut c.tendon_radius, 1e-5..=1.0),
            "m",
            Chosen,
            "Turns that force into a torque: about 5 N at a fingertip; 1 cm would mean 46 N on a ball of 50 g.",
        ),
        entry(
            "hand.damping",
            Number(|c| &mut c.hand_damping, 0.0..=10.0),
            "N m s/rad",
            Chosen,
            "Passive damping of the hand's joints.",
        ),
    ]
}

fn thing_entries() -> Vec<Entry> {
    use Field::{Number, Numbers};
    use Source::{Chosen, Given};
    vec![
        entry("sphere.radius", Number(|c| &mut c.sphere_radius, 0.005..=0.2), "m", Given, "Radius of the sphere."),
        entry("sphere.mass", Number(|c| &mut c.sphere_mass, 0.001..=10.0), "kg", Chosen, "Mass of the sphere."),
        entry(
            "table.x",
            Numbers(|c| &mut c.table_x, -10.0..=10.0),
            "m",
            Chosen,
            "Where the table's top, at z = 0, begins and ends along x (forward).",
        ),
        entry(
            "table.y",
            Numbers(|c| &mut c.table_y, -10.0..=10.0),
            "m",
            Chosen,
            "Where the table's top begins and ends along y (left).",
        ),
        entry(
            "table.depth",
            Number(|c| &mut c.table_depth, 0.01..=10.0),
            "m",
            Chosen,
            "Depth of the table, a solid block: nothing gets under it.",
        ),
        entry(
            "contact.friction",
            Number(|c| &mut c.friction, 0.0..=10.0),
            "",
            Chosen,
            "Coefficient of sliding friction of all surfaces.",
        ),
        entry(
            "contact.rolling_friction",
            Number(|c| &mut c.rolling_friction, 0.0..=0.1),
            "m",
            Chosen,
            "Rolling friction of the sphere on the table, torque over normal force.",
        ),
        entry(
            "contact.stiffness",
            Number(|c| &mut c.contact_stiffness, 100.0..=1e7),
            "N/m",
            Chosen,
            "Normal stiffness of a contact point: 5 N penetrate by less than 0.5 mm.",
        ),
        entry(
            "contact.damping",
            Number(|c| &mut c.contact_damping, 0.0..=1e5),
            "N s/m",
            Chosen,
            "Normal damping of a contact point.",
        ),
    ]
}

fn controller_entries(labels: Labels) -> Vec<Entry> {
    use Field::{Number, Whole, Word};
    use Source::{Chosen, Given};
    let touch = entry(
        "sensors.touch_saturation",
        Number(|c| &mut c.touch_saturation, 1.0..=1000.0),
        "",
        Chosen,
        "Contacts that saturate a touch sensor: one for each phalanx; 20 is remembered of the original.",
    );
    let amplitude = match labels {
        Labels::None => None,
        Labels::Given => Some((Given, "Value of the label of the present phase; the other two are 0.")),
        Labels::Own => Some((
            Chosen,
            "Factor from an output for a label to the label of the next step, as large as a given label.",
        )),
    };
    let amplitude = amplitude.map(|(source, doc)| {
        entry("sensors.label_amplitude", Number(|c| &mut c.label_amplitude, 0.0..=1e6), "", source, doc)
    });
    let network = vec![
        entry(
            "sensors.target_axes",
            Word(
                &["palm", "world"],
                |c| match c.target_axes {
                    Axes::Body => "palm",
                    Axes::World => "world",
                },
                |c, w| c.target_axes = if w == "world" { Axes::World } else { Axes::Body },
            ),
            "",
            Chosen,
            "Axes in which the sphere's position relative to the palm is sensed, in cm.",
        ),
        entry("network.hidden", Whole(|c| &mut c.hidden, 1..=1000), "", Given, "Number of hidden neurons."),
        entry("network.slope", Number(|c| &mut c.slope, 0.0..=100.0), "", Given, "Slope of the logistic function."),
        entry(
            "network.leak",
            Word(&["filter", "two-tap", "evonet"], |c| c.leak.name(), |c, w| c.leak = w.parse().unwrap_or_default()),
            "",
            Chosen,
            "Reading of the leak: a filter, as the source's words say; two-tap as its equation is printed; evonet as the \
             original program, with leaks |p|/range.",
        ),
        entry(
            "network.range",
            Number(|c| &mut c.weight_range, 0.0..=1e6),
            "",
            Given,
            "Genes are decoded to weights and biases between minus and plus this, to leaks between 0 and 1.",
        ),
    ];
    [touch].into_iter().chain(amplitude).chain(network).collect()
}

fn reward_entries() -> Vec<Entry> {
    use Field::{Number, Word};
    use Source::Chosen;
    vec![
        entry(
            "reward.contact_term",
            Word(
                &["capped", "literal", "saturating"],
                |c| c.judgement.contact_term.name(),
                |c, w| {
                    c.judgement.contact_term = ContactTerm::ALL.into_iter().find(|t| t.name() == w).unwrap_or_default();
                },
            ),
            "",
            Chosen,
            "Reading of the reward for contacts in the phase grasp: capped 0.2 min(1, n/4), literal 0.2/(1 + n/4), \
             saturating 0.2 (1 - 1/(1 + n/4)).",
        ),
        entry(
            "reward.lift_height",
            Number(|c| &mut c.judgement.lift_height, 0.0..=1.0),
            "m",
            Chosen,
            "Least height of the sphere's center above the table at which lifting is rewarded. 0 rewards it at any height, \
             as printed.",
        ),
        entry(
            "success.height",
            Number(|c| &mut c.judgement.success_height, 0.0..=100.0),
            "cm",
            Chosen,
            "Height of the sphere's centre above the table in every step of the last second of a success.",
        ),
    ]
}
