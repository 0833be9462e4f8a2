//! The command over the experiment of the targets. `tune configurations DIR` writes the configurations of its runs.

use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [word, folder] = words.as_slice() else { return farsa_fuzz::laboratory().main() };
    if word != "configurations" {
        return farsa_fuzz::laboratory().main();
    }
    for (number, (name, text)) in farsa_fuzz::configurations().into_iter().enumerate() {
        if let Err(error) = std::fs::write(format!("{folder}/{number:02}-{name}.toml"), text) {
            eprintln!("{name}: {error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
