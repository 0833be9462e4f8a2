//! Total of a term in a trial.

use farsa_lab::Error;
use farsa_num::Scalar;

use crate::check::source::Source;
use crate::document::{Over, Reward};
use crate::parts::groups::Groups;

/// A term with its total in this trial.
#[derive(Clone, Debug)]
pub(crate) struct Tally {
    pub(crate) name: String,
    label: Option<String>,
    weight: f64,
    over: Over,
    /// Number of an earlier term that must be positive.
    pub(crate) during: Option<usize>,
    /// Robots that the document names, from the first up to the one after the last. Otherwise all, or those that
    /// evolve.
    about: Option<[usize; 2]>,
    /// Robots of the mean in this trial, and their number.
    range: [usize; 2],
    count: f64,
    /// True if an evolving robot is among them.
    earns: bool,
    clip: Option<[f64; 2]>,
    /// True if the value is measured only after the last step.
    pub(crate) late: bool,
    /// Sum over the steps that count, and the largest and the last value.
    sum: f64,
    most: f64,
    pub(crate) last: f64,
}

impl Tally {
    /// Builds the term at a number of the document. `names` are those of all terms.
    pub(crate) fn new(
        reward: &Reward,
        number: usize,
        names: &[String],
        groups: &Groups,
        source: &Source,
    ) -> Result<Self, Error> {
        let path = format!("/reward/{number}");
        let robots = groups.robots();
        let robot = reward.robot.map(|robot| robot as usize - 1);
        if let Some(robot) = robot.filter(|robot| *robot >= robots) {
            return Err(source.wrong(&format!("{path}/robot"), format!("is robot {} of {robots}", robot + 1)));
        }
        let group = reward.of.as_ref().map(|name| groups.find(name, &format!("{path}/of"), source));
        let about = match (robot, group.transpose()?) {
            (Some(_), Some(_)) => return Err(source.wrong(&format!("{path}/of"), "goes not with `robot`: one of them")),
            (robot, group) => robot.map(|robot| [robot, robot + 1]).or(group),
        };
        if reward.clip.is_some_and(|[low, high]| low > high) {
            return Err(source.wrong(&format!("{path}/clip"), "runs backwards"));
        }
        let during = reward.during.as_ref().map(|name| {
            let path = format!("{path}/during");
            let index = source.position(names.iter().map(String::as_str), ("term", name), &path)?;
            if index >= number {
                return Err(source.wrong(&path, format!("`{name}` has to stand before this term")));
            }
            Ok(index)
        });
        Ok(Self {
            name: names[number].clone(),
            label: reward.label.clone(),
            weight: reward.weight,
            over: reward.over,
            during: during.transpose()?,
            about,
            range: about.unwrap_or([0, robots]),
            count: about.map_or(robots, |[first, end]| end - first) as f64,
            earns: true,
            clip: reward.clip,
            late: false,
            sum: 0.0,
            most: f64::NEG_INFINITY,
            last: 0.0,
        })
    }

    /// Builds a term that only a condition reads, about some robots or those that evolve.
    pub(crate) fn of_condition(groups: &Groups, about: Option<[usize; 2]>) -> Self {
        let robots = groups.robots();
        Self {
            name: String::new(),
            label: None,
            weight: 0.0,
            over: Over::End,
            during: None,
            about,
            range: about.unwrap_or([0, robots]),
            count: about.map_or(robots, |[first, end]| end - first) as f64,
            earns: true,
            clip: None,
            late: false,
            sum: 0.0,
            most: f64::NEG_INFINITY,
            last: 0.0,
        }
    }

    /// Checks if only the last step matters, as far as the aggregation is concerned.
    pub(crate) fn may_be_late(&self) -> bool {
        self.over == Over::End && self.during.is_none()
    }

    /// Resets the total.
    pub(crate) fn reset(&mut self) {
        (self.sum, self.most, self.last) = (0.0, f64::NEG_INFINITY, 0.0);
    }

    /// Computes the value of a robot if it is part of the mean, else 0.
    #[inline]
    pub(crate) fn share(&self, robot: usize, value: f64) -> f64 {
        let [first, end] = self.range;
        if (first..end).contains(&robot) { value } else { 0.0 }
    }

    /// Computes the number of robots of the mean.
    #[inline]
    pub(crate) fn robots(&self) -> f64 {
        self.count
    }

    /// Sets the evolving robots of this trial.
    pub(crate) fn evolve(&mut self, [first, end]: [usize; 2]) {
        self.range = self.about.unwrap_or([first, end]);
        self.count = (self.range[1] - self.range[0]) as f64;
        // The ranges [a, b) and [first, end) intersect.
        self.earns = self.range[0] < end && first < self.range[1];
    }

    /// Adds the value of a step. `others` are the earlier terms.
    #[inline]
    pub(crate) fn count(&mut self, value: f64, others: &[Self]) {
        let value = self.clip.map_or(value, |[low, high]| Scalar::clamp(value, low, high));
        // Conditions look at the last value, even in steps that do not count.
        self.last = value;
        if self.during.is_none_or(|other| others.get(other).is_some_and(|other| other.last > 0.0)) {
            self.sum += value;
            if self.over == Over::Most {
                self.most = Scalar::max(self.most, value);
            }
        }
    }

    /// Computes the reward in a trial of at most the given number of steps.
    pub(crate) fn earned(&self, steps: u32) -> f64 {
        if self.earns { self.weight * self.measured(steps) } else { 0.0 }
    }

    /// Computes the total before the weight.
    pub(crate) fn measured(&self, steps: u32) -> f64 {
        match self.over {
            // Divided by the greatest number of steps, so that steps after an early end count as 0.
            Over::Mean => self.sum / f64::from(steps),
            Over::Sum => self.sum,
            Over::End => self.last,
            Over::Most if self.most == f64::NEG_INFINITY => 0.0,
            Over::Most => self.most,
        }
    }

    /// Returns the name in outcomes and recordings.
    pub(crate) fn label(&self) -> &str {
        self.label.as_ref().unwrap_or(&self.name)
    }

    /// Formats the name of the note with the total before the weight.
    pub(crate) fn note(&self) -> String {
        self.label.clone().unwrap_or_else(|| format!("measured {}", self.name))
    }

    /// Returns true for a term without weight.
    pub(crate) fn is_only_measured(&self) -> bool {
        self.weight == 0.0
    }
}
