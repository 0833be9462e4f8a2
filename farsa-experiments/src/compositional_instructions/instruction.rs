//! Instructions of two words: an action and an object.

use core::fmt;
use core::str::FromStr;

use farsa_lab::Error;

/// An action on an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Turn to it and touch nothing.
    Indicate,
    /// Touch it and leave it where it is.
    Touch,
    /// Push it away.
    Move,
    /// Look at it, then away from it and at nothing else.
    Ignore,
}

/// An object, by its color.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Color {
    /// The red one.
    Red,
    /// The green one.
    Green,
    /// The blue one.
    Blue,
}

/// An action word and an object word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// The action.
    pub action: Action,
    /// With which object.
    pub color: Color,
}

/// The three actions of an agent: one of the experiment's two conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Condition {
    /// INDICATE, TOUCH, MOVE.
    #[default]
    WithIndicate,
    /// IGNORE, TOUCH, MOVE.
    WithIgnore,
}

impl Action {
    /// Every action. A condition has three of them, [`Condition::actions`].
    pub const ALL: [Self; 4] = [Self::Indicate, Self::Touch, Self::Move, Self::Ignore];

    /// The word.
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
    /// Every color, in the order of the channels and of the objects.
    pub const ALL: [Self; 3] = [Self::Red, Self::Green, Self::Blue];

    /// The word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Red => "red",
            Self::Green => "green",
            Self::Blue => "blue",
        }
    }

    /// The number of the object that has it.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Red, green and blue \[0..1\].
    pub const fn rgb(self) -> [f64; 3] {
        match self {
            Self::Red => [1.0, 0.0, 0.0],
            Self::Green => [0.0, 1.0, 0.0],
            Self::Blue => [0.0, 0.0, 1.0],
        }
    }
}

impl Condition {
    /// The names of both, in their order.
    pub const NAMES: [&'static str; 2] = ["with-indicate", "with-ignore"];

    /// The condition of this name, or [`Condition::WithIndicate`].
    pub fn from_name(name: &str) -> Self {
        if name == Self::NAMES[1] { Self::WithIgnore } else { Self::WithIndicate }
    }

    /// Its actions, in the order of the channels.
    pub const fn actions(self) -> [Action; 3] {
        match self {
            Self::WithIndicate => [Action::Indicate, Action::Touch, Action::Move],
            Self::WithIgnore => [Action::Ignore, Action::Touch, Action::Move],
        }
    }

    /// Its nine instructions, object by object within each action.
    pub fn instructions(self) -> [Instruction; 9] {
        let actions = self.actions();
        core::array::from_fn(|i| Instruction { action: actions[i / 3], color: Color::ALL[i % 3] })
    }

    /// The number of an action's channel, or 0 for an action of the other condition.
    pub fn channel(self, action: Action) -> usize {
        self.actions().iter().position(|other| *other == action).unwrap_or(0)
    }

    /// The instruction of these two words.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest instruction for one of the other condition.
    pub fn parse(self, text: &str) -> Result<Instruction, Error> {
        let instruction = text.parse::<Instruction>().ok();
        instruction.filter(|instruction| self.actions().contains(&instruction.action)).ok_or_else(|| {
            let names = self.instructions().map(|instruction| instruction.to_string());
            Error::unknown("", "instruction", text, names.iter().map(String::as_str))
        })
    }
}

impl Instruction {
    /// Every instruction of either condition.
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

    /// The instruction of these two words, in any case.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the nearest one.
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
