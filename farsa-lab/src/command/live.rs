//! `farsa live` and `farsa serve`.

use std::borrow::Cow;
use std::path::Path;

use serde::Serialize;

use crate::command::arguments::subcommands::{LiveArgs, ServeArgs};
use crate::command::cli::{say, tell};
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::json::pretty;
use crate::live::page;
use crate::live::serve::{self, Served};
use crate::run::ENGINE;
use crate::run::plan::Plan;
use crate::store::bounded;

/// The most bytes of a module.
const MOST_MODULE: u64 = 100_000_000;
/// What begins a file that is compressed by gzip, and one by xz.
const COMPRESSED: [&[u8]; 2] = [&[0x1f, 0x8b], b"\xfd7zXZ\0"];

/// Where a page is served.
#[derive(Serialize)]
struct Address<'a> {
    address: &'a str,
}

impl Invocation<'_, '_> {
    /// Writes a page that runs an agent by itself.
    pub(super) fn live(&self, args: &LiveArgs) -> Result<(), Error> {
        let (directory, plan) = self.existing(&args.directory)?;
        let module = self.live_module(args.module.as_deref(), &plan)?;
        let generations = &args.generations;
        let found = page::page(self.laboratory, (&plan, &directory), generations, &module, &args.html)?;
        self.summary(args.json, &format!("{}\n", found.summary), &|| pretty(&found))
    }

    /// Serves this page while the run goes on.
    pub(super) fn serve(&self, args: &ServeArgs) -> Result<(), Error> {
        let (directory, plan) = self.existing(&args.directory)?;
        let module = self.live_module(args.module.as_deref(), &plan)?;
        let (laboratory, plan, directory, module) = (self.laboratory, &plan, &directory, &module);
        serve::serve(Served { laboratory, plan, directory, module }, args.port, |address| {
            if args.json { say(&pretty(&Address { address })?) } else { tell(&format!("{address}\n")) }
        })
    }

    /// The module of a file, or that of this program, which may lack the plan's world.
    fn live_module(&self, given: Option<&Path>, plan: &Plan<'_>) -> Result<Cow<'_, [u8]>, Error> {
        let Some(path) = given else {
            let none = || Error::Usage("this program has no module for pages: give one with --module".into());
            let (module, lacking) = self.laboratory.live_module().ok_or_else(none)?;
            let world = plan.settings.word(ENGINE).ok();
            return match lacking.iter().find(|lacks| world == Some(**lacks)) {
                Some(world) => Err(Error::Usage(format!(
                    "world `{world}`: pages that run an agent are without it; `farsa replay --html` shows recorded trials"
                ))),
                None => Ok(Cow::Borrowed(module)),
            };
        };
        let module = bounded::read_stream(path, MOST_MODULE)?;
        if !COMPRESSED.iter().any(|begin| module.starts_with(begin)) {
            return Err(Error::Usage("the module is not compressed by gzip or xz".into()));
        }
        Ok(Cow::Owned(module))
    }
}
