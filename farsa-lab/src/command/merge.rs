//! `farsa merge`: the command.

use std::io::{self, Write as _};

use crate::command::arguments::merge::MergeArgs;
use crate::command::cli::say;
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::escaped::escaped;
use crate::json::pretty;

impl Invocation<'_, '_> {
    /// Merges runs, with their table on standard output by default.
    pub(super) fn merge(&self, args: &MergeArgs) -> Result<(), Error> {
        let summary = args.merge().make(self.laboratory)?;
        if !args.prints() {
            return self.summary(args.json, &summary.text(), &|| pretty(&summary));
        }
        if !self.quiet {
            let _ = write!(io::stderr(), "{}", escaped(&summary.text()));
        }
        say(&summary.table)
    }
}
