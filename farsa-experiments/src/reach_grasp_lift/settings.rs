//! The settings of `reach-grasp-lift`, with their limits, units, sources and reasons.

use std::ops::RangeInclusive;

use farsa_body::actuators::MuscleVariant;
use farsa_body::sensors::Axes;
use farsa_lab::advanced::{ENGINE, Source};
use farsa_lab::{Error, Setting, Settings};

use crate::reach_grasp_lift::config::{Config, Displacement, SphereFrame};
use crate::reach_grasp_lift::fitness::ContactTerm;
use crate::worlds::Engine;

/// The reader and writer of a field of the configuration.
enum Field {
    Number(fn(&mut Config) -> &mut f64, RangeInclusive<f64>),
    Numbers(fn(&mut Config) -> &mut [f64], RangeInclusive<f64>),
    Whole(fn(&mut Config) -> &mut u32, RangeInclusive<i64>),
    Word(&'static [&'static str], fn(&Config) -> &'static str, fn(&mut Config, &str)),
}

struct Entry {
    key: &'static str,
    field: Field,
    unit: &'static str,
    source: Source,
    doc: &'static str,
}

const fn entry(key: &'static str, field: Field, unit: &'static str, source: Source, doc: &'static str) -> Entry {
    Entry { key, field, unit, source, doc }
}

/// The settings in the order in which they are listed.
fn entries() -> Vec<Entry> {
    let parts = [world_entries, start_entries, arm_entries, thing_entries, controller_entries, reward_entries];
    parts.into_iter().flat_map(|part: fn() -> Vec<Entry>| part()).collect()
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
            "Dynamics steps per control step. 4 is the least at which no bound of the physics is broken in 10^6 random steps.",
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

fn controller_entries() -> Vec<Entry> {
    use Field::{Number, Whole, Word};
    use Source::{Chosen, Given};
    vec![
        entry(
            "sensors.touch_saturation",
            Number(|c| &mut c.touch_saturation, 1.0..=1000.0),
            "",
            Chosen,
            "Contacts that saturate a touch sensor: one for each phalanx; 20 is remembered of the original.",
        ),
        entry(
            "sensors.label_amplitude",
            Number(|c| &mut c.label_amplitude, 0.0..=1e6),
            "",
            Given,
            "Value of the label of the present phase; the other two are 0.",
        ),
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
    ]
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
            "success.height",
            Number(|c| &mut c.judgement.success_height, 0.0..=100.0),
            "cm",
            Chosen,
            "Height of the sphere's centre above the table in every step of the last second of a success.",
        ),
    ]
}

impl Config {
    /// Returns the table of settings. The labels' amplitude is listed only where there are labels.
    pub(crate) fn table(&self) -> Vec<Setting> {
        let mut defaults = self.clone();
        let listed = |entry: &Entry| self.labels || entry.key != "sensors.label_amplitude";
        entries()
            .into_iter()
            .filter(listed)
            .map(|Entry { key, field, unit, source, doc }| {
                let setting = match field {
                    Field::Number(at, range) => Setting::number(key, *at(&mut defaults), range),
                    Field::Numbers(at, range) => Setting::numbers(key, at(&mut defaults), range),
                    Field::Whole(at, range) => Setting::whole(key, i64::from(*at(&mut defaults)), range),
                    Field::Word(choices, get, _) => Setting::word(key, get(&defaults), choices),
                };
                let setting = setting.unit(unit).doc(doc);
                match source {
                    Source::Given => setting.given(),
                    Source::Derived => setting.derived(),
                    Source::Chosen => setting,
                }
            })
            .collect()
    }

    /// Reads a configuration from settings that have been checked.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] for settings of another experiment and for an invalid table top.
    pub fn read(labels: bool, settings: &Settings) -> Result<Self, Error> {
        let mut config = Self::for_condition(labels);
        for Entry { key, field, .. } in entries() {
            if key == "sensors.label_amplitude" && !labels {
                continue;
            }
            match field {
                Field::Number(at, _) => *at(&mut config) = settings.number(key)?,
                Field::Numbers(at, _) => {
                    for (to, from) in at(&mut config).iter_mut().zip(settings.numbers(key)?) {
                        *to = *from;
                    }
                }
                Field::Whole(at, _) => {
                    *at(&mut config) =
                        u32::try_from(settings.whole(key)?).map_err(|_| Error::setting(key, "is too large"))?;
                }
                Field::Word(_, _, set) => set(&mut config, settings.word(key)?),
            }
        }
        for (key, [begin, end]) in [("table.x", config.table_x), ("table.y", config.table_y)] {
            if begin >= end {
                return Err(Error::setting(key, format!("begins at {begin} and ends at {end}")));
            }
        }
        Ok(config)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_lab::advanced::Value;

    #[test]
    fn settings_of_the_defaults_read_back_as_the_defaults() {
        for labels in [true, false] {
            let config = Config::for_condition(labels);
            let settings = Settings::new(config.table()).unwrap();
            assert_eq!(Config::read(labels, &settings).unwrap(), config);
            assert!(config.table().iter().all(|setting| !setting.doc_text().is_empty()));
            assert_eq!(config.table().len(), entries().len() - usize::from(!labels));
        }
    }

    #[test]
    fn every_setting_changes_its_own_field() {
        let table = Config::default().table();
        for setting in &table {
            let mut settings = Settings::new(table.clone()).unwrap();
            let other = match setting.default_value() {
                Value::Number(x) => Value::Number(if *x > 0.5 { x * 0.99 } else { x * 1.01 }),
                Value::Numbers(list) => Value::Numbers(list.iter().map(|x| x * 0.99).collect()),
                Value::Whole(n) => Value::Whole(n + 1),
                Value::Word(word) => {
                    let entry = entries().into_iter().find(|entry| entry.key == setting.key()).unwrap();
                    let Field::Word(choices, ..) = entry.field else { panic!("{} is no word", setting.key()) };
                    Value::Word((*choices.iter().find(|choice| *choice != word).unwrap()).into())
                }
                Value::Flag(_) => panic!("no flags here"),
            };
            // A touch sensor saturates at 3 and no lower than 1, and so on: 1 % off the default is inside every range.
            settings.set("", setting.key(), other.clone()).unwrap_or_else(|error| panic!("{error}"));
            let mut config = Config::read(true, &settings).unwrap();
            assert_ne!(config, Config::default(), "{}", setting.key());
            let entry = entries().into_iter().find(|entry| entry.key == setting.key()).unwrap();
            let mut defaults = Config::default();
            match entry.field {
                Field::Number(at, _) => *at(&mut config) = *at(&mut defaults),
                Field::Numbers(at, _) => at(&mut config).copy_from_slice(at(&mut defaults)),
                Field::Whole(at, _) => *at(&mut config) = *at(&mut defaults),
                Field::Word(_, get, set) => set(&mut config, get(&defaults)),
            }
            assert_eq!(config, Config::default(), "{} changes more than its own field", setting.key());
        }
    }

    #[test]
    fn a_table_without_a_top_is_refused() {
        let mut settings = Settings::new(Config::default().table()).unwrap();
        settings.set("", "table.y", Value::Numbers(vec![0.2, 0.2])).unwrap();
        assert_eq!(Config::read(true, &settings).unwrap_err().to_string(), "`table.y`: begins at 0.2 and ends at 0.2");
    }
}
