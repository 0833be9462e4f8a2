//! What a term of the fitness has come to.

use farsa_lab::Error;
use farsa_num::Scalar;

use crate::check::places::Places;
use crate::document::{Over, Reward};
use crate::parts::groups::Groups;

/// A term with what it has come to in this trial, whatever it measures.
#[derive(Clone, Debug)]
pub(crate) struct Tally {
    pub(crate) name: String,
    weight: f64,
    over: Over,
    /// The term before it that has to be more than 0.
    pub(crate) during: Option<usize>,
    /// The robots that it is about by its own, from the first to before the last; all of them, or those that evolve.
    about: Option<[usize; 2]>,
    /// The robots that it is the mean of, in this trial, and how many they are.
    range: [usize; 2],
    count: f64,
    /// Whether those who evolve in this trial are among them.
    earns: bool,
    clip: Option<[f64; 2]>,
    /// Whether its value is asked for after the last step only.
    pub(crate) late: bool,
    /// The sum of all steps that counted, and the largest and the last value of one.
    sum: f64,
    most: f64,
    pub(crate) last: f64,
}

impl Tally {
    /// That of a term that stands at a path of the document; `names` are those of all terms.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a term that there is not, [`Error::Setting`] for what does not go together.
    pub(crate) fn new(
        reward: &Reward,
        number: usize,
        names: &[String],
        groups: &Groups,
        places: &Places,
    ) -> Result<Self, Error> {
        let path = format!("/reward/{number}");
        let robots = groups.robots();
        let robot = reward.robot.map(|robot| robot as usize - 1);
        if let Some(robot) = robot.filter(|robot| *robot >= robots) {
            return Err(places.wrong(&format!("{path}/robot"), format!("is robot {} of {robots}", robot + 1)));
        }
        let group = reward.of.as_ref().map(|name| groups.find(name, &format!("{path}/of"), places));
        let about = match (robot, group.transpose()?) {
            (Some(_), Some(_)) => return Err(places.wrong(&format!("{path}/of"), "goes not with `robot`: one of them")),
            (robot, group) => robot.map(|robot| [robot, robot + 1]).or(group),
        };
        if reward.clip.is_some_and(|[low, high]| low > high) {
            return Err(places.wrong(&format!("{path}/clip"), "runs backwards"));
        }
        let during = reward.during.as_ref().map(|name| {
            let path = format!("{path}/during");
            let found = names.iter().position(|known| known == name);
            let found = found
                .ok_or_else(|| Error::unknown(&places.of(&path), "term", name, names.iter().map(String::as_str)))?;
            if found >= number {
                return Err(places.wrong(&path, format!("`{name}` has to stand before this term")));
            }
            Ok(found)
        });
        Ok(Self {
            name: names[number].clone(),
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

    /// Whether nothing of it depends on the steps before the last, if what it measures does not.
    pub(crate) fn may_be_late(&self) -> bool {
        self.over == Over::End && self.during.is_none()
    }

    /// Forgets an earlier trial.
    pub(crate) fn reset(&mut self) {
        (self.sum, self.most, self.last) = (0.0, f64::NEG_INFINITY, 0.0);
    }

    /// The share that a robot, of so many, has in it.
    #[inline]
    pub(crate) fn share(&self, robot: usize, value: f64) -> f64 {
        let [first, end] = self.range;
        if (first..end).contains(&robot) { value } else { 0.0 }
    }

    /// Of how many robots it is the mean.
    #[inline]
    pub(crate) fn robots(&self) -> f64 {
        self.count
    }

    /// Says which robots evolve in this trial, from the first to before the last.
    pub(crate) fn evolve(&mut self, [first, end]: [usize; 2]) {
        self.range = self.about.unwrap_or([first, end]);
        self.count = (self.range[1] - self.range[0]) as f64;
        self.earns = self.range[0] < end && first < self.range[1];
    }

    /// Counts a step of this value; `others` are the terms before it.
    #[inline]
    pub(crate) fn count(&mut self, value: f64, others: &[Self]) {
        let value = self.clip.map_or(value, |[low, high]| Scalar::clamp(value, low, high));
        self.last = value;
        if self.during.is_none_or(|other| others.get(other).is_some_and(|other| other.last > 0.0)) {
            self.sum += value;
            if self.over == Over::Most {
                self.most = Scalar::max(self.most, value);
            }
        }
    }

    /// What it has earned, in a trial of at most so many steps.
    pub(crate) fn earned(&self, steps: u32) -> f64 {
        if self.earns { self.weight * self.measured(steps) } else { 0.0 }
    }

    /// The same before its weight.
    pub(crate) fn measured(&self, steps: u32) -> f64 {
        match self.over {
            Over::Mean => self.sum / f64::from(steps),
            Over::Sum => self.sum,
            Over::End => self.last,
            Over::Most if self.most == f64::NEG_INFINITY => 0.0,
            Over::Most => self.most,
        }
    }

    /// Whether it earns nothing and is only looked at.
    pub(crate) fn is_only_measured(&self) -> bool {
        self.weight == 0.0
    }
}
