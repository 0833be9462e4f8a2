//! Experiment files for the command.

use std::path::Path;

use farsa_lab::advanced::{ExperimentFiles, Part, Template, Vocabulary};
use farsa_lab::{Error, Experiment};

use crate::built_in::registry;
use crate::experiment::ComposedExperiment;
use crate::limits::Limits;

/// Support for experiment files. Pass this to a [`Laboratory`](farsa_lab::Laboratory) to make its commands accept
/// them.
///
/// ```no_run
/// use farsa_lab::Laboratory;
///
/// fn main() -> std::process::ExitCode {
///     Laboratory::new(&[]).with_files(farsa_compose::FILES).main()
/// }
/// ```
pub const FILES: ExperimentFiles =
    ExperimentFiles { read, schema: as_text, templates: &TEMPLATES, crate_with_parts: &CRATE_WITH_PARTS, import: None };

/// A sensor and a term, as in docs/guide/own-part.md.
const CRATE_WITH_PARTS: [(&str, &str); 3] = [
    (
        "Cargo.toml",
        concat!(
            "[package]\nname = \"NAME\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n",
            include_str!("../templates/parts/dependencies.toml")
        ),
    ),
    ("src/main.rs", include_str!("../templates/parts/main.rs")),
    ("seek.toml", include_str!("../templates/parts/seek.toml")),
];

const TEMPLATES: [Template; 3] = [
    Template {
        name: "light",
        summary: "a robot finds a lamp and stays near it",
        text: include_str!("../templates/light.toml"),
    },
    Template {
        name: "wander",
        summary: "a robot drives about and turns away from what is in its way",
        text: include_str!("../templates/wander.toml"),
    },
    Template {
        name: "team",
        summary: "robots of a team gather on a nest, with and without lights",
        text: include_str!("../templates/team.toml"),
    },
];

fn read(
    file: &str,
    text: &str,
    folder: Option<&Path>,
    vocabulary: Vocabulary<'_>,
) -> Result<Box<dyn Experiment>, Error> {
    Ok(Box::new(ComposedExperiment::read(Limits::default(), file, text, folder, vocabulary)?))
}

fn as_text(parts: &[Part]) -> Result<String, Error> {
    Ok(format!("{:#}\n", registry(parts)?.schemas[0]))
}
