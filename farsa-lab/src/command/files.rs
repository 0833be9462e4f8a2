//! `farsa new` and `farsa check`: files that describe experiments.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::PathBuf;

use crate::command::arguments::files::{CheckArgs, NewArgs};
use crate::command::cli::{say, tell};
use crate::command::connections::Connections;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::escaped::{Quoted, escaped};
use crate::json::pretty;
use crate::run::laboratory::{FILE, MAX_BYTES, Template};
use crate::store::own_output::write_outputs;
use crate::store::replace::create_results;

impl Invocation<'_, '_> {
    /// Writes an experiment file from a template.
    pub(super) fn new_file(&self, args: &NewArgs) -> Result<(), Error> {
        if args.parts {
            return self.new_crate(args.name.as_deref().unwrap_or_default());
        }
        let templates = self.laboratory.files()?.templates;
        if args.from.as_deref() == Some("list") {
            return tell(&list(templates));
        }
        let names = || templates.iter().map(|template| template.name);
        let template = match &args.from {
            None => templates.first(),
            Some(name) => templates.iter().find(|template| template.name == name),
        };
        let Some(Template { name, text, .. }) = template else {
            let asked = args.from.as_deref().unwrap_or_default();
            let unknown = Error::unknown("--from", "template", asked, names());
            return Err(Error::Usage(format!("{unknown}\n{}", list(templates).trim_end())));
        };
        let Some(file) = &args.name else {
            return Err(Error::Usage(format!("the file of the template `{name}` has no name: new NAME --from {name}")));
        };
        let path = PathBuf::from(format!("{}{FILE}", file.strip_suffix(FILE).unwrap_or(file)));
        // The file name becomes the name of the experiment, so it is checked first.
        (self.laboratory.files()?.read)(&path.display().to_string(), text, None, self.laboratory.vocabulary())?;
        create_results(&[(path.clone(), text)])?;
        let (program, path) = (self.program, path.display());
        let next = format!("{path}: from `{name}`\n{program} check {path}\n{program} run {path} --generations 20\n");
        if self.quiet { Ok(()) } else { tell(&next) }
    }

    /// Writes a crate with custom parts into a new folder.
    fn new_crate(&self, name: &str) -> Result<(), Error> {
        let files = self.laboratory.files()?.crate_with_parts;
        if files.is_empty() {
            return Err(Error::Usage("--parts: this program has no crate with parts".into()));
        }
        let letter = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || "-_".contains(letter);
        if !name.starts_with(|first: char| first.is_ascii_lowercase()) || !name.chars().all(letter) || name.len() > 40 {
            let why = "is no name of a crate: 1 to 40 lower-case letters, digits, - and _, the first a letter";
            return Err(Error::Usage(format!("{} {why}", Quoted(name))));
        }
        let folder = PathBuf::from(name);
        let taken = |error: io::Error| match error.kind() {
            io::ErrorKind::AlreadyExists => Error::Usage(format!("{name}: there is one already")),
            _ => Error::io("make", &folder)(error),
        };
        fs::create_dir(&folder).map_err(taken)?;
        fs::create_dir(folder.join("src")).map_err(Error::io("make", &folder))?;
        let files = files.iter().map(|(path, text)| (folder.join(path), text.replace("NAME", name)));
        create_results(&files.collect::<Vec<_>>())?;
        let next = format!(
            "{name}: a crate with a sensor and a term\ncd {name}\ncargo run -- run seek.toml --generations 20\n"
        );
        if self.quiet { Ok(()) } else { tell(&next) }
    }

    /// Prints warnings on standard error.
    pub(super) fn warn(&self, warnings: &[String]) {
        for warning in warnings.iter().filter(|_| !self.quiet && !self.exchange.is_follower()) {
            let _ = writeln!(io::stderr(), "warning: {}", escaped(warning));
        }
    }

    /// Checks an experiment, and lists or draws its connections.
    pub(super) fn check(&self, args: &CheckArgs) -> Result<(), Error> {
        let experiment = if args.stdin {
            self.laboratory.experiment_of_text(&args.experiment, &standard_input()?)?
        } else {
            self.laboratory.experiment(&args.experiment, "")?
        };
        let plan = args.variant.plan(experiment)?;
        plan.strategy()?;
        let connections = Connections::new(&plan)?;
        self.warn(&connections.warnings);
        if let Some(path) = &args.graph {
            if path.as_os_str() == "-" {
                return say(&connections.svg());
            }
            write_outputs(&[(path.clone(), connections.svg())])?;
        }
        match (args.json, self.quiet) {
            (true, _) => say(&pretty(&connections)?),
            (false, true) => Ok(()),
            (false, false) => tell(&connections.text()),
        }
    }
}

/// Reads the text of an experiment file from standard input.
fn standard_input() -> Result<String, Error> {
    let mut bytes = Vec::new();
    let read = io::stdin().lock().take(MAX_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(Error::io("read", "standard input".as_ref()))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Error::Usage(format!("standard input has more than {MAX_BYTES} bytes")));
    }
    String::from_utf8(bytes).map_err(|_| Error::Usage("standard input is no text (UTF-8)".into()))
}

/// Formats the templates, one per line.
fn list(templates: &[Template]) -> String {
    let width = templates.iter().map(|template| template.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for Template { name, summary, .. } in templates {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {name:width$}  {summary}");
    }
    text
}
