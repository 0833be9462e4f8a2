//! `farsa lab`.

use std::thread;

use serde::Serialize;

use crate::command::arguments::lab::LabArgs;
use crate::command::cli::{say, tell};
use crate::command::info::list_as_json;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::json::pretty;
use crate::live::lab::{self, LabOptions, ProgramFacts};

/// Address of the laboratory, with its token.
#[derive(Serialize)]
struct Address<'a> {
    address: &'a str,
}

impl Invocation<'_, '_> {
    /// Serves a laboratory for the browser until the process ends.
    pub(super) fn lab(&self, args: &LabArgs) -> Result<(), Error> {
        let experiments = list_as_json(self.laboratory.experiments())?;
        let experiments = serde_json::from_str(&experiments).map_err(|error| Error::Other(error.to_string()))?;
        let templates = self.laboratory.files().map(|files| files.templates).unwrap_or_default();
        let templates = templates.iter().map(|template| (template.name, template.summary)).collect();
        let facts = ProgramFacts { name: self.program.into(), experiments, templates };
        let processors = || thread::available_parallelism().map_or(1, usize::from);
        let jobs = args.jobs.map_or_else(processors, usize::from);
        let module = args.module.as_deref();
        let options = LabOptions { folder: &args.folder, port: args.port, jobs, module, read_only: args.read_only };
        lab::serve(options, facts, |address| {
            if args.json {
                return say(&pretty(&Address { address })?);
            }
            let note = "Open this address in a browser on this machine. Ctrl-C ends the page, and runs continue.";
            tell(&format!("{address}\n{note}\n"))
        })
    }
}
