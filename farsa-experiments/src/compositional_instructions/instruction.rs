//! Instructions that consist of an action word and an object word.

use core::fmt;
use core::str::FromStr;

use farsa_lab::Error;

/// An action that can be performed on an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// The agent has to turn toward the object without touching anything.
    Indicate,
    /// The agent has to touch the object without moving it.
    Touch,
    /// The agent has to push the object away.
    Move,
    /// The agent has to look at the object first, and then away from all objects.
    Ignore,
}

/// The color that identifies an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Color {
    /// Identifies the red object.
    Red,
    /// Identifies the green object.
    Green,
    /// Identifies the blue object.
    Blue,
}

/// An instruction, such as "TOUCH green".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Action that the agent should perform.
    pub action: Action,
    /// Color of the object on which the action is performed.
    pub color: Color,
}

/// A condition of the experiment. It defines the three actions of the agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Condition {
    /// Actions INDICATE, TOUCH and MOVE.
    #[default]
    WithIndicate,
    /// Actions IGNORE, TOUCH and MOVE.
    WithIgnore,
}

impl Action {
    /// All four actions. Use [`Condition::actions`] to get the three actions of a condition.
    pub const ALL: [Self; 4] = [Self::Indicate, Self::Touch, Self::Move, Self::Ignore];

    /// Returns the action word in capital letters.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Indicate => "INDICATE",
            Self::Touch => "TOUCH",
            Self::Move => "MOVE",
            Self::Ignore => "IGNORE",
        }
    }
}

impl Color {
    /// All colors, in the order of the input channels and of the objects.
    pub const ALL: [Self; 3] = [Self::Red, Self::Green, Self::Blue];

    /// Returns the object word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Red => "red",
            Self::Green => "green",
            Self::Blue => "blue",
        }
    }

    /// Returns the index of the object with this color.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Returns the red, green and blue components (between 0 and 1).
    pub const fn rgb(self) -> [f64; 3] {
        match self {
            Self::Red => [1.0, 0.0, 0.0],
            Self::Green => [0.0, 1.0, 0.0],
            Self::Blue => [0.0, 0.0, 1.0],
        }
    }
}

impl Condition {
    /// The names of the two conditions, as they are used on the command line.
    pub const NAMES: [&'static str; 2] = ["with-indicate", "with-ignore"];

    /// Returns the condition with the given name. An unknown name results in [`Condition::WithIndicate`].
    pub fn from_name(name: &str) -> Self {
        if name == Self::NAMES[1] { Self::WithIgnore } else { Self::WithIndicate }
    }

    /// Returns the actions of this condition, in the order of the input channels.
    pub const fn actions(self) -> [Action; 3] {
        match self {
            Self::WithIndicate => [Action::Indicate, Action::Touch, Action::Move],
            Self::WithIgnore => [Action::Ignore, Action::Touch, Action::Move],
        }
    }

    /// Returns the nine instructions of this condition, grouped by action.
    pub fn instructions(self) -> [Instruction; 9] {
        let actions = self.actions();
        core::array::from_fn(|i| Instruction { action: actions[i / 3], color: Color::ALL[i % 3] })
    }

    /// Returns the index of the input channel for an action. The result is 0 if the action is not part of this
    /// condition.
    pub fn channel(self, action: Action) -> usize {
        self.actions().iter().position(|other| *other == action).unwrap_or(0)
    }

    /// Parses an instruction of this condition.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] with the most similar instruction of this condition if there is no such instruction.
    pub fn parse(self, text: &str) -> Result<Instruction, Error> {
        let instruction = text.parse::<Instruction>().ok();
        instruction.filter(|instruction| self.actions().contains(&instruction.action)).ok_or_else(|| {
            let names = self.instructions().map(|instruction| instruction.to_string());
            Error::unknown("", "instruction", text, names.iter().map(String::as_str))
        })
    }
}

impl Instruction {
    /// Returns an iterator over the instructions of both conditions.
    pub fn all() -> impl Iterator<Item = Self> {
        Action::ALL.into_iter().flat_map(|action| Color::ALL.into_iter().map(move |color| Self { action, color }))
    }
}

impl fmt::Display for Instruction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.action.word(), self.color.word())
    }
}

impl FromStr for Instruction {
    type Err = Error;

    /// Parses an instruction. The case of the letters is ignored.
    ///
    /// # Errors
    /// Returns [`Error::Setting`] with the most similar instruction.
    fn from_str(text: &str) -> Result<Self, Error> {
        let mut words = text.split_whitespace();
        let (first, second, rest) = (words.next(), words.next(), words.next());
        let same = |given: Option<&str>, word: &str| given.is_some_and(|given| given.eq_ignore_ascii_case(word));
        let named = |instruction: &Self| {
            same(first, instruction.action.word()) && same(second, instruction.color.word()) && rest.is_none()
        };
        Self::all().find(named).ok_or_else(|| {
            let names: Vec<String> = Self::all().map(|instruction| instruction.to_string()).collect();
            Error::unknown("", "instruction", text, names.iter().map(String::as_str))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_have_names() {
        for instruction in Instruction::all() {
            assert_eq!(instruction.to_string().parse::<Instruction>().unwrap(), instruction);
            assert_eq!(instruction.to_string().to_lowercase().parse::<Instruction>().unwrap(), instruction);
        }
        for (text, nearest) in [("TOUCH greem", "TOUCH green"), ("MOVE", "MOVE red"), ("TOUCH red red", "TOUCH red")] {
            let error = text.parse::<Instruction>().unwrap_err().to_string();
            assert!(error.contains(text) && error.contains(nearest), "{error}");
        }
    }

    #[test]
    fn each_condition_has_nine_of_the_twelve() {
        for (condition, absent) in
            [(Condition::WithIndicate, Action::Ignore), (Condition::WithIgnore, Action::Indicate)]
        {
            let instructions = condition.instructions();
            assert!(Instruction::all().all(|one| instructions.contains(&one) != (one.action == absent)));
            assert_eq!(
                instructions.map(|one| 3 * condition.channel(one.action) + one.color.index()),
                [0, 1, 2, 3, 4, 5, 6, 7, 8]
            );
            let error = condition.parse(&format!("{} red", absent.word())).unwrap_err().to_string();
            assert!(error.contains("unknown instruction"), "{error}");
            assert_eq!(condition.parse("move blue").unwrap(), instructions[8]);
        }
        assert_eq!(Condition::NAMES.map(Condition::from_name), [Condition::WithIndicate, Condition::WithIgnore]);
    }
}
