//! Commands in messages, quoted for a shell.

use std::path::Path;

/// Returns the command that continues a run.
pub(crate) fn resume_command(program: &str, directory: &Path) -> String {
    format!("{} run --resume {}", quoted(program), quoted(&directory.to_string_lossy()))
}

/// Formats the command line of this process, quoted for a shell.
pub(crate) fn again(program: &str) -> String {
    let arguments = std::env::args_os().skip(1).map(|word| quoted(&word.to_string_lossy()));
    std::iter::once(quoted(program)).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// Quotes a word for a shell where necessary.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./=,:+@%".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        return word.into();
    }
    // Only a word with a zero byte cannot be quoted, and no process has such an argument.
    shlex::try_quote(word).map_or_else(|_| word.into(), std::borrow::Cow::into_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_shell_would_change_is_quoted() {
        let words = ["run", "--set", "cart.friction=0.5", "my runs", "it's", "", "a*b"];
        let line = words.map(quoted).join(" ");
        assert!(line.starts_with("run --set cart.friction=0.5 "), "{line}");
        assert_eq!(shlex::split(&line).unwrap(), words);
    }
}
