//! Learning as a search: one individual, which takes a lesson after each generation.

use std::fmt::Write as _;

use farsa_evo::{EvoError, Population};
use serde::{Deserialize, Serialize};

use crate::experiment::evaluator::{Learner, Lesson};
use crate::figures::plot;
use crate::figures::plot::{Chart, Curve};

/// An individual that learns.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Saved", into = "Saved")]
pub(crate) struct Learning {
    words: Vec<f64>,
    lessons: Lessons,
    /// The individual alone.
    population: Population,
}

/// The genomes that all lessons so far led to, and what the lessons were like.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Lessons {
    /// One more than lessons.
    genomes: Vec<Vec<u16>>,
    lessons: Vec<Lesson>,
}

/// The same as it is kept, before anything in it is believed.
#[derive(Serialize, Deserialize)]
struct Saved {
    words: Vec<f64>,
    lessons: Lessons,
}

impl From<Learning> for Saved {
    fn from(Learning { words, lessons, .. }: Learning) -> Self {
        Self { words, lessons }
    }
}

impl TryFrom<Saved> for Learning {
    type Error = EvoError;

    fn try_from(Saved { words, lessons }: Saved) -> Result<Self, EvoError> {
        let population = lessons.latest()?;
        Ok(Self { words, lessons, population })
    }
}

impl Learning {
    /// Before the first lesson.
    pub(crate) fn new(learner: &dyn Learner, seed: u64) -> Result<Self, EvoError> {
        let words = learner.first_words(seed);
        let lessons = Lessons { genomes: vec![learner.learned(&words)], lessons: Vec::new() };
        Self::try_from(Saved { words, lessons })
    }

    /// Number of lessons taken, which is that of the generation to live.
    pub(crate) fn generation(&self) -> u32 {
        self.lessons.taken()
    }

    /// The individual.
    pub(crate) fn ask(&self) -> &Population {
        &self.population
    }

    /// Takes the lesson of the generation.
    ///
    /// # Errors
    /// Words that tell of a lesson that could not be given; nothing is learned then.
    pub(crate) fn study(&mut self, learner: &mut dyn Learner, seed: u64) -> Result<(), String> {
        let (mut words, number) = (self.words.clone(), self.generation());
        let Some(lesson) = learner.lesson(&mut words, seed, number) else {
            return Err(format!("lesson {number}: {} words are none that anything is learned from", words.len()));
        };
        let genes = learner.learned(&words);
        if genes.len() != self.population.genome_len() {
            let (found, expected) = (genes.len(), self.population.genome_len());
            return Err(format!("lesson {number}: what was learned has {found} genes instead of {expected}"));
        }
        self.population.iter_mut().for_each(|genome| genome.copy_from_slice(&genes));
        self.lessons.genomes.push(genes);
        self.lessons.lessons.push(lesson);
        self.words = words;
        Ok(())
    }

    /// All lessons so far.
    pub(crate) fn lessons(&self) -> &Lessons {
        &self.lessons
    }

    /// Whether another one learns as much to as many genes.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        (self.words.len(), self.population.genome_len()) == (other.words.len(), other.population.genome_len())
    }
}

impl Lessons {
    /// Number of lessons taken.
    pub(crate) fn taken(&self) -> u32 {
        self.lessons.len() as u32
    }

    /// The genome \[genes\] after so many lessons.
    pub(crate) fn genome_of(&self, generation: u32, individual: usize) -> Result<Vec<u16>, EvoError> {
        if individual > 0 {
            return Err(EvoError::NoSuchIndividual { individual, population: 1 });
        }
        let none = EvoError::NoSuchGeneration { generation, latest: self.taken() };
        self.genomes.get(generation as usize).cloned().ok_or(none)
    }

    /// The individual after all lessons.
    fn latest(&self) -> Result<Population, EvoError> {
        let genes = self.genome_of(self.taken(), 0)?;
        let mut population = Population::new(1, genes.len())?;
        population.iter_mut().for_each(|genome| genome.copy_from_slice(&genes));
        Ok(population)
    }

    /// `learning.csv`: what every lesson was like.
    pub(crate) fn csv(&self) -> String {
        let mut text = String::from("generation,error before,error after,successes\n");
        for (generation, Lesson { before, after, successes }) in self.lessons.iter().enumerate() {
            // The debug form is the shortest that reads back as the same number. Writing into a string cannot fail.
            let _ = writeln!(text, "{generation},{before:?},{after:?},{successes:?}");
        }
        text
    }
    /// `learning.svg`: the same as a picture.
    ///
    /// # Errors
    /// The backend's words, should it refuse.
    pub(crate) fn plot(&self, title: &str) -> Result<String, String> {
        let curve = |color: usize, name: &str, value: fn(&Lesson) -> f64| Curve {
            name: Some(name.into()),
            color,
            values: self.lessons.iter().map(value).collect(),
            band: Vec::new(),
        };
        let errors =
            vec![curve(0, "before the lesson", |lesson| lesson.before), curve(1, "after it", |lesson| lesson.after)];
        let successes = vec![curve(2, "of the demonstrations", |lesson| lesson.successes)];
        plot::stack(&[
            Chart { title: format!("{title}: error of motor values"), axis: "error", curves: errors },
            Chart { title: format!("{title}: successes while led"), axis: "share", curves: successes },
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    /// Learns from two words, one gene more with each lesson.
    struct Forgetful;

    impl Learner for Forgetful {
        fn first_words(&self, seed: u64) -> Vec<f64> {
            vec![0.0; seed as usize]
        }
        fn lesson(&mut self, words: &mut [f64], _: u64, _: u32) -> Option<Lesson> {
            let [first, _] = words else { return None };
            *first += 1.0;
            Some(Lesson { before: 1.0, after: 0.5, successes: 0.0 })
        }
        fn learned(&self, words: &[f64]) -> Vec<u16> {
            vec![0; 1 + words.first().map_or(0, |word| *word as usize)]
        }
    }

    #[test]
    fn a_lesson_that_cannot_be_given_says_so_and_changes_nothing() {
        for (seed, says) in [(3, "3 words are none that"), (2, "has 2 genes instead of 1")] {
            let mut learning = Learning::new(&Forgetful, seed).unwrap();
            let before = (learning.words.clone(), learning.lessons.clone());
            let error = learning.study(&mut Forgetful, seed).unwrap_err();
            assert!(error.starts_with("lesson 0: ") && error.contains(says), "{error}");
            assert_eq!((learning.words, learning.lessons), before);
        }
    }
}
