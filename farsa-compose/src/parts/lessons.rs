//! Demonstrations from CSV files.

use std::collections::BTreeMap;

use farsa_lab::Error;
use farsa_nn::learning::Demonstration;

use crate::check::source::Source;
use crate::document::Learning;
use crate::parts::network_spec::NetworkSpec;

/// Sensor values and target motor values of a trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Lesson {
    x: Vec<f32>,
    wanted: Vec<f32>,
}

impl Lesson {
    pub(crate) fn demonstration(&self) -> Demonstration<'_> {
        Demonstration { x: &self.x, wanted: &self.wanted }
    }

    /// Returns the number of motor values.
    pub(crate) fn values(&self) -> usize {
        self.wanted.len()
    }
}

/// Reads all demonstrations of a document, whose network has these channels.
pub(crate) fn lessons(
    learning: &Learning,
    files: &BTreeMap<String, String>,
    spec: &NetworkSpec,
    source: &Source,
) -> Result<Vec<Lesson>, Error> {
    let mut all = Vec::new();
    for (index, name) in learning.demonstrations.iter().enumerate() {
        let path = format!("/learning/demonstrations/{index}");
        let text = files.get(name).map(String::as_str).unwrap_or_default();
        let read = read(text, spec).map_err(|why| source.wrong(&path, format!("{name}: {why}")))?;
        all.extend(read);
    }
    Ok(all)
}

/// Reads the demonstrations of a file.
fn read(text: &str, spec: &NetworkSpec) -> Result<Vec<Lesson>, String> {
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let head: Vec<String> = table.headers().map_err(|error| error.to_string())?.iter().map(str::to_owned).collect();
    let column = |group: &str, name: &String| {
        let wanted = format!("{group}.{name}");
        let place = head.iter().position(|column| *column == wanted || column == name);
        place.ok_or_else(|| format!("lacks the column `{wanted}`"))
    };
    let columns = |group, names: &[String]| names.iter().map(|name| column(group, name)).collect::<Result<Vec<_>, _>>();
    let (inputs, outputs) = (columns("sensor", &spec.inputs)?, columns("output", &spec.outputs)?);
    let trial = head.iter().position(|column| column == "trial");
    let (mut lessons, mut current): (Vec<Lesson>, Option<String>) = (Vec::new(), None);
    for record in table.records() {
        let record = record.map_err(|error| error.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let value = |column: &usize| {
            let text = record.get(*column).unwrap_or_default();
            let number = text.trim().parse::<f32>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| format!("line {line}: `{}` of column `{}` is no number", text, head[*column]))
        };
        let of = trial.map(|trial| record.get(trial).unwrap_or_default().to_owned()).unwrap_or_default();
        if current.as_ref() != Some(&of) {
            lessons.push(Lesson::default());
            current = Some(of);
        }
        let Some(lesson) = lessons.last_mut() else { continue };
        for column in &inputs {
            lesson.x.push(value(column)?);
        }
        for column in &outputs {
            let wanted = value(column)?;
            if !(0.0..=1.0).contains(&wanted) {
                return Err(format!("line {line}: {wanted} of column `{}` is outside 0 to 1", head[*column]));
            }
            lesson.wanted.push(wanted);
        }
    }
    if lessons.is_empty() { Err("has no lines below its head".into()) } else { Ok(lessons) }
}
