//! Reads and writes the settings of `reach-grasp-lift`.

use farsa_lab::advanced::Source;
use farsa_lab::{Error, Setting, Settings};

use crate::reach_grasp_lift::config::{Config, Labels};
use crate::reach_grasp_lift::entries::{Entry, Field, entries};

impl Config {
    /// Returns the table of settings. The labels' amplitude is listed only where there are labels.
    pub(crate) fn table(&self) -> Vec<Setting> {
        let mut defaults = self.clone();
        entries(self.labels)
            .into_iter()
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
    pub fn read(labels: Labels, settings: &Settings) -> Result<Self, Error> {
        let mut config = Self::for_condition(labels);
        for Entry { key, field, .. } in entries(labels) {
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
        for labels in Labels::ALL {
            let config = Config::for_condition(labels);
            let settings = Settings::new(config.table()).unwrap();
            assert_eq!(Config::read(labels, &settings).unwrap(), config);
            assert!(config.table().iter().all(|setting| !setting.doc_text().is_empty()));
            let listed = config.table().iter().any(|setting| setting.key() == "sensors.label_amplitude");
            assert_eq!(listed, labels != Labels::None);
        }
    }

    #[test]
    fn every_setting_changes_its_own_field() {
        Labels::ALL.into_iter().for_each(every_setting_of);
    }

    fn every_setting_of(labels: Labels) {
        let of_condition = Config::for_condition(labels);
        let table = of_condition.table();
        for setting in &table {
            let mut settings = Settings::new(table.clone()).unwrap();
            let other = match setting.default_value() {
                // One percent of 0 is 0.
                Value::Number(0.0) => Value::Number(0.05),
                Value::Number(x) => Value::Number(if *x > 0.5 { x * 0.99 } else { x * 1.01 }),
                Value::Numbers(list) => Value::Numbers(list.iter().map(|x| x * 0.99).collect()),
                Value::Whole(n) => Value::Whole(n + 1),
                Value::Word(word) => {
                    let entry = entries(labels).into_iter().find(|entry| entry.key == setting.key()).unwrap();
                    let Field::Word(choices, ..) = entry.field else { panic!("{} is no word", setting.key()) };
                    Value::Word((*choices.iter().find(|choice| *choice != word).unwrap()).into())
                }
                Value::Flag(_) => panic!("no flags here"),
            };
            // A touch sensor saturates at 3 and no lower than 1, and so on: 1 % off the default is inside every range.
            settings.set("", setting.key(), other.clone()).unwrap_or_else(|error| panic!("{error}"));
            let mut config = Config::read(labels, &settings).unwrap();
            assert_ne!(config, of_condition, "{}", setting.key());
            let entry = entries(labels).into_iter().find(|entry| entry.key == setting.key()).unwrap();
            let mut defaults = of_condition.clone();
            match entry.field {
                Field::Number(at, _) => *at(&mut config) = *at(&mut defaults),
                Field::Numbers(at, _) => at(&mut config).copy_from_slice(at(&mut defaults)),
                Field::Whole(at, _) => *at(&mut config) = *at(&mut defaults),
                Field::Word(_, get, set) => set(&mut config, get(&defaults)),
            }
            assert_eq!(config, of_condition, "{} changes more than its own field", setting.key());
        }
    }

    #[test]
    fn a_height_for_lifting_outside_its_range_is_refused() {
        let table = Config::default().table();
        for (height, is_in_range) in [(0.0, true), (0.05, true), (1.0, true), (-0.01, false), (1.5, false)] {
            let mut settings = Settings::new(table.clone()).unwrap();
            match settings.set("", "reward.lift_height", Value::Number(height)) {
                Ok(()) => assert!(is_in_range, "{height}"),
                Err(error) => {
                    let text = error.to_string();
                    assert!(!is_in_range && text.contains("`reward.lift_height`"), "{text}");
                    assert!(text.contains(&height.to_string()) && text.contains("1.0"), "{text}");
                }
            }
        }
    }

    #[test]
    fn a_table_without_a_top_is_refused() {
        let mut settings = Settings::new(Config::default().table()).unwrap();
        settings.set("", "table.y", Value::Numbers(vec![0.2, 0.2])).unwrap();
        assert_eq!(
            Config::read(Labels::Given, &settings).unwrap_err().to_string(),
            "`table.y`: begins at 0.2 and ends at 0.2"
        );
    }
}
