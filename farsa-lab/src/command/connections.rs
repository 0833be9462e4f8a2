//! Connections of an experiment: sensors with inputs, outputs with motors, terms with the fitness.

use std::fmt::Write as _;

use serde::Serialize;

use crate::command::behaviour::BehaviourInfo;
use crate::error::Error;
use crate::experiment::controller_export::{MotorDrive, SensorReading};
use crate::experiment::evaluator::Task;
use crate::experiment::outcome::{ChannelGroup, Description};
use crate::experiment::parameter::Parameter;
use crate::run::plan::Plan;

/// Parts of an experiment and their channels, with the names of its JSON.
#[derive(Serialize)]
pub(crate) struct Connections {
    experiment: String,
    summary: String,
    condition: String,
    sensors: Vec<Group>,
    network: String,
    parameters: Vec<Searched>,
    motors: Vec<Group>,
    terms: Vec<String>,
    #[serde(flatten)]
    behaviour: BehaviourInfo,
    trials: usize,
    steps: usize,
    step_seconds: f64,
    /// Doubts about the experiment.
    pub(crate) warnings: Vec<String>,
}

/// An evolved parameter with its values for the smallest and the largest gene.
#[derive(Serialize)]
struct Searched {
    name: String,
    ends: [f64; 2],
}

/// A group of channels with their names.
#[derive(Serialize)]
struct Group {
    name: String,
    meaning: String,
    /// First channel and the one after the last.
    channels: [usize; 2],
    names: Vec<String>,
    /// Unit of each channel, or empty.
    units: Vec<String>,
}

impl Group {
    /// Gets the number of channels, and their unit if they share one.
    fn count(&self) -> String {
        let [from, to] = self.channels;
        let count = format!("{} {}", to - from, if to - from == 1 { "channel" } else { "channels" });
        match self.units.first().filter(|unit| !unit.is_empty() && self.units.iter().all(|other| other == *unit)) {
            Some(unit) => format!("{count}, in {unit}"),
            None => count,
        }
    }
}

/// Returns the units of the channels of sensors and motors, where controllers describe them.
fn units(task: &dyn Task) -> [Vec<String>; 2] {
    let middle: Vec<f32> = task.info().parameters.iter().map(|it| (0.5 * (it.ends[0] + it.ends[1])) as f32).collect();
    let Some(controller) = task.exports().and_then(|exports| exports.controller(&middle)) else {
        return [Vec::new(), Vec::new()];
    };
    let text = |unit: &str| if unit == "1" { String::new() } else { unit.into() };
    let sensors = controller.sensors.iter().map(|sensor| match sensor.reads {
        SensorReading::Quantity { unit, .. } => text(unit),
        SensorReading::JointPosition { .. } => "rad".into(),
        SensorReading::Way { .. } => "m".into(),
        _ => String::new(),
    });
    let motors = controller.motors.iter().map(|motor| match motor.drives {
        MotorDrive::Quantity { unit, .. } => text(unit),
        MotorDrive::Servos { .. } => "rad".into(),
        _ => String::new(),
    });
    [sensors.collect(), motors.collect()]
}

/// Returns consecutive groups with the names and units of their channels.
fn groups(groups: &[ChannelGroup], names: &[String], units: &[String]) -> Vec<Group> {
    let mut first = 0;
    let group = |group: &ChannelGroup| {
        let channels = [first, first + group.count];
        first += group.count;
        let [names, units] = [names, units]
            .map(|all| (channels[0]..channels[1]).filter_map(|channel| all.get(channel).cloned()).collect());
        Group { name: group.name.clone(), meaning: group.meaning.clone(), channels, names, units }
    };
    groups.iter().map(group).collect()
}

impl Connections {
    /// Returns the connections of a plan.
    ///
    /// # Errors
    /// Errors of creating the experiment.
    pub(crate) fn new(plan: &Plan<'_>) -> Result<Self, Error> {
        let task = plan.evaluator()?;
        let (schema, Description { sensors, motors, network, steps, step_seconds, .. }) =
            (task.info().schema, task.info().description);
        let names =
            |channels: &[farsa_view::Channel]| channels.iter().map(farsa_view::Channel::title).collect::<Vec<_>>();
        let [of_sensors, of_motors] = units(task.as_ref());
        Ok(Self {
            experiment: plan.experiment.name().into(),
            summary: plan.experiment.summary().into(),
            condition: plan.condition.clone(),
            sensors: groups(&sensors, &names(&schema.sensors), &of_sensors),
            network,
            parameters: task
                .info()
                .parameters
                .into_iter()
                .map(|Parameter { name, ends }| Searched { name, ends })
                .collect(),
            motors: groups(&motors, &names(&schema.outputs), &of_motors),
            terms: task.info().terms,
            behaviour: BehaviourInfo::new(&task.info(), task.behavior()),
            trials: task.info().trials,
            steps,
            step_seconds,
            warnings: task.info().warnings,
        })
    }

    /// Formats the connections as text.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("{}: {}\n", self.experiment, self.summary);
        let width = self.sensors.iter().chain(&self.motors).map(|group| group.name.chars().count()).max().unwrap_or(0);
        // Writing to a string cannot fail.
        for (what, groups) in [("inputs", &self.sensors), ("outputs", &self.motors)] {
            let _ = writeln!(text, "\n{what} of the network:");
            for Group { name, meaning, channels: [first, end], .. } in groups {
                let _ = writeln!(text, "  {:>9}  {name:width$}  {meaning}", span(*first, *end));
            }
        }
        let seconds = self.steps as f64 * self.step_seconds;
        let _ = writeln!(text, "\nnetwork: {}; {} parameters", self.network, self.parameters.len());
        let _ = writeln!(text, "trials: {}, each of at most {} steps ({seconds:?} s)", self.trials, self.steps);
        text + &self.behaviour.text(&self.terms)
    }

    /// Draws sensors on the left, the network, motors on the right and the terms below.
    pub(crate) fn svg(&self) -> String {
        let rows = self.sensors.len().max(self.motors.len()).max(1);
        let terms = self.terms.len().max(1);
        let height = TOP + ROW * rows as f64 + GAP + ROW * terms as f64 + 20.0;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" \
             viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"13\">\n\
             <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"white\"/>\n"
        );
        let middle = TOP + 0.5 * ROW * rows as f64;
        text_at(&mut svg, [20.0, 26.0], "start", 16, &format!("{} {}", self.experiment, self.condition));
        let network = [NETWORK, middle - 40.0, BOX, 80.0];
        let column = |groups: &[Group], x: f64, svg: &mut String| {
            let first = middle - 0.5 * ROW * groups.len() as f64;
            for (row, group) in groups.iter().enumerate() {
                let y = first + ROW * row as f64;
                let [from, to] = group.channels;
                boxed(svg, [x, y, BOX, ROW - 12.0], [&group.name, &group.count()], "#dbe9f6");
                let (side, end) = if x < NETWORK { (x + BOX, network[0]) } else { (x, network[0] + network[2]) };
                let (y, at) = (y + 0.5 * (ROW - 12.0), middle);
                let (from_to, label) = if x < NETWORK {
                    ([side, y, end, at], format!("in {}", span(from, to)))
                } else {
                    ([end, at, side, y], format!("out {}", span(from, to)))
                };
                arrow(svg, from_to);
                let near = [0.5 * (side + end), 0.75 * y + 0.25 * at - 4.0];
                // Text on a line remains readable.
                let [width, high] = [6.6 * label.len() as f64, 14.0];
                let [x, y] = [near[0] - 0.5 * width, near[1] - 11.0];
                let _ = writeln!(
                    svg,
                    "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{high}\" fill=\"white\"/>"
                );
                text_at(svg, near, "middle", 11, &label);
            }
        };
        column(&self.sensors, SENSORS, &mut svg);
        column(&self.motors, MOTORS, &mut svg);
        let parameters = format!("{} parameters", self.parameters.len());
        boxed(&mut svg, network, [&self.network, &parameters], "#fdebd0");
        let first = TOP + ROW * rows as f64 + GAP;
        let target = first + 0.5 * ROW * terms as f64;
        for (row, term) in self.terms.iter().enumerate() {
            let y = first + ROW * row as f64;
            boxed(&mut svg, [SENSORS, y, BOX, ROW - 12.0], [term, "term"], "#e2f0d9");
            arrow(&mut svg, [SENSORS + BOX, y + 0.5 * (ROW - 12.0), NETWORK, target]);
        }
        let trials = format!("{} trials of at most {} steps", self.trials, self.steps);
        boxed(&mut svg, [NETWORK, target - 25.0, BOX, 50.0], ["fitness", &trials], "#e2f0d9");
        svg.push_str("</svg>\n");
        svg
    }
}

/// Width, rows and columns of the drawing.
const WIDTH: f64 = 900.0;
const TOP: f64 = 50.0;
const ROW: f64 = 56.0;
const GAP: f64 = 50.0;
const BOX: f64 = 210.0;
const SENSORS: f64 = 20.0;
const NETWORK: f64 = 345.0;
const MOTORS: f64 = 670.0;

/// Formats channels counted from 1: `3` or `3-8`.
fn span(first: usize, end: usize) -> String {
    if end == first + 1 { end.to_string() } else { format!("{}-{end}", first + 1) }
}

fn boxed(svg: &mut String, [x, y, width, height]: [f64; 4], lines: [&str; 2], color: &str) {
    let _ = writeln!(
        svg,
        "<rect x=\"{x}\" y=\"{y:.1}\" width=\"{width}\" height=\"{height}\" rx=\"5\" fill=\"{color}\" stroke=\"#555\"/>"
    );
    let middle = x + 0.5 * width;
    // A long line continues in a second one.
    let words = wrapped(lines[0], 32);
    let count = words.len() as f64 + 1.0;
    let first = y + 0.5 * height - 8.0 * (count - 1.0) + 4.0;
    for (row, line) in words.iter().enumerate() {
        text_at(svg, [middle, first + 16.0 * row as f64], "middle", 13, line);
    }
    text_at(svg, [middle, first + 16.0 * (count - 1.0)], "middle", 11, lines[1]);
}

/// Breaks a text between words into at most three lines of the given length.
fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let word: String = word.chars().take(most).collect();
        let last = lines.last().map_or(0, |line| line.chars().count());
        match lines.last_mut() {
            Some(line) if last == 0 => line.push_str(&word),
            Some(line) if last + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    if lines.len() > 3 {
        lines.truncate(3);
        lines[2].push_str(" ...");
    }
    lines
}

fn arrow(svg: &mut String, [x, y, u, v]: [f64; 4]) {
    let _ = writeln!(
        svg,
        "<path d=\"M{x} {y:.1} C{a} {y:.1} {b} {v:.1} {end} {v:.1}\" fill=\"none\" stroke=\"#555\"/>\
         <path d=\"M{u} {v:.1} l-8 -4 v8 z\" fill=\"#555\"/>",
        a = 0.5 * (x + u),
        b = 0.5 * (x + u),
        end = u - 8.0,
    );
}

fn text_at(svg: &mut String, [x, y]: [f64; 2], anchor: &str, size: u32, text: &str) {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let _ =
        writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" font-size=\"{size}\">{text}</text>");
}
