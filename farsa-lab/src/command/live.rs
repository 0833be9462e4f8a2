//! `farsa live` and `farsa serve`.

use std::io::Write as _;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde::Serialize;

use crate::command::arguments::lab::ServeArgs;
use crate::command::arguments::subcommands::LiveArgs;
use crate::command::cli::{say, tell};
use crate::command::invocation::Invocation;
use crate::error::Error;
use crate::json::pretty;
use crate::live::page::{self, Chosen};
use crate::live::serve::{self, Served};
use crate::run::ENGINE;
use crate::run::plan::Plan;
use crate::store::bounded;

/// Most bytes of a module file.
const MAX_MODULE_BYTES: u64 = 100_000_000;
/// First bytes of a gzip file.
const GZIP: &[u8] = &[0x1f, 0x8b];
/// First bytes of a WebAssembly module.
const WASM: &[u8] = b"\0asm";

/// Address of a served page.
#[derive(Serialize)]
struct Address<'a> {
    address: &'a str,
}

impl Invocation<'_, '_> {
    /// Writes an interactive page that runs an agent.
    pub(super) fn live(&self, args: &LiveArgs) -> Result<(), Error> {
        let (directory, plan) = self.existing(&args.directory)?;
        let file = args.module.as_deref().map(module_file).transpose()?;
        let module = self.live_module(file.as_deref(), &plan)?;
        let chosen = Chosen { generations: &args.generations, individual: args.individual };
        let page = page::page(self.laboratory, (&plan, &directory), chosen, module, &args.html)?;
        self.summary(args.json, &format!("{}\n", page.summary), &|| pretty(&page))
    }

    /// Serves this page while the run continues.
    pub(super) fn serve(&self, args: &ServeArgs) -> Result<(), Error> {
        let (directory, plan) = self.existing(&args.directory)?;
        let file = args.module.as_deref().map(module_file).transpose()?;
        self.live_module(file.as_deref(), &plan)?;
        let module = |plan: &Plan<'_>| self.live_module(file.as_deref(), plan);
        let served = Served { laboratory: self.laboratory, directory: &directory, module: &module };
        if let Some(part) = args.print {
            return say(&part.text(served, &plan)?);
        }
        serve::serve(served, args.port, |address| {
            if args.json { say(&pretty(&Address { address })?) } else { tell(&format!("{address}\n")) }
        })
    }

    /// Returns the module of a file or of this program, which may lack the plan's world.
    fn live_module<'m>(&'m self, file: Option<&'m [u8]>, plan: &Plan<'_>) -> Result<&'m [u8], Error> {
        if let Some(module) = file {
            return Ok(module);
        }
        let absent = || Error::Usage("this program has no module for pages: give one with --module".into());
        let (module, lacking) = self.laboratory.live_module().ok_or_else(absent)?;
        let world = plan.settings.word(ENGINE).ok();
        match lacking.iter().find(|lacks| world == Some(**lacks)) {
            Some(world) => Err(Error::Usage(format!(
                "world `{world}`: pages that run an agent are without it; `farsa replay --html` shows recorded trials"
            ))),
            None => Ok(module),
        }
    }
}

/// Reads a module, and compresses one that is not.
fn module_file(path: &Path) -> Result<Vec<u8>, Error> {
    let module = bounded::read_stream(path, MAX_MODULE_BYTES)?;
    if module.starts_with(WASM) {
        let mut compressed = GzEncoder::new(Vec::new(), Compression::best());
        return compressed.write_all(&module).and_then(|()| compressed.finish()).map_err(Error::io("read", path));
    }
    if !module.starts_with(GZIP) {
        let why = "is no WebAssembly module, neither a plain one nor one compressed by gzip";
        return Err(Error::Usage(format!("{}: {why}", path.display())));
    }
    Ok(module)
}
