//! `farsa lab`: a laboratory in the browser for the experiments and runs of a folder.
//!
//! One thread owns all connections ([`site`]), some workers answer requests ([`calls`]), and one starts waiting processes
//! ([`queue`]). Everything that computes is a process of this program, which continues without the page and the server.

use std::fs;
use std::net::{Ipv4Addr, TcpListener};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

use crate::error::Error;
use crate::live::http::server::Server;
use crate::live::lab::calls::{Bench, Task};
use crate::live::lab::folder::Folder;
use crate::live::lab::names::Refusal;
use crate::live::lab::program::Program;
use crate::live::lab::queue::Queue;
use crate::live::lab::site::Site;
use crate::live::lab::token::Token;
use crate::run::catch_panic::catch_printed_panic;
use crate::store::lock;

pub(crate) use program::ProgramFacts;

/// Requests of the page and their effects.
mod calls;
/// Champions of a run as events.
mod champions;
/// Changes that a request asks of the folder.
mod changes;
/// Command lines of requests.
mod command_line;
/// Summaries of runs, read from their files.
mod facts;
/// Places in the folder.
mod folder;
/// Event stream of a run.
mod follow;
/// Names in requests.
mod names;
/// Processes of this program.
mod program;
/// Processes that wait, run and have ended.
mod queue;
/// Addresses of the server.
mod site;
/// Secret of the address.
mod token;

/// Threads that answer requests.
const WORKERS: usize = 4;
/// Most requests that wait for a worker.
const WAITING: usize = 64;
/// Interval at which ended processes make room for waiting ones.
const INTERVAL: Duration = Duration::from_millis(200);

/// Options of the server.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LabOptions<'o> {
    pub(crate) folder: &'o Path,
    pub(crate) port: u16,
    /// Most processes at once.
    pub(crate) jobs: usize,
    /// Module of interactive pages, instead of the program's.
    pub(crate) module: Option<&'o Path>,
    pub(crate) read_only: bool,
}

/// Answers browsers of this machine until the process ends. The address with its secret is passed to `begun`.
///
/// # Errors
/// [`Error::Usage`] for an unavailable port, a missing folder and a folder of another laboratory, those of `begun`, and
/// [`Error::Io`] when the server cannot start.
pub(crate) fn serve(
    options: LabOptions<'_>,
    facts: ProgramFacts,
    begun: impl FnOnce(&str) -> Result<(), Error>,
) -> Result<(), Error> {
    let LabOptions { folder: path, port, jobs, module, read_only } = options;
    let unusable = |error| Error::Usage(format!("{}: {error}", path.display()));
    let folder = Folder::new(fs::canonicalize(path).map_err(unusable)?);
    if !folder.path().is_dir() {
        return Err(Error::Usage(format!("{}: is not a folder", path.display())));
    }
    let taken = |error| Error::Usage(format!("--port {port}: {error}"));
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(taken)?;
    let address = listener.local_addr().map_err(taken)?;
    let name = address.to_string();
    let failed = || Error::io("listen to", name.as_ref());
    let _claim = if read_only { None } else { Some(claim(&folder)?) };
    let program = Program::here(&folder, module)?;
    let queue = Arc::new(Queue::open(&folder, program.clone(), jobs, read_only)?);
    let bench = Arc::new(Bench::new(folder, program, facts, queue.clone(), read_only));
    let token = Token::new()?;
    let (tasks, asked) = mpsc::sync_channel::<Task>(WAITING);
    let asked = Arc::new(Mutex::new(asked));
    for number in 1..=WORKERS {
        let (asked, bench) = (asked.clone(), bench.clone());
        let work = move || {
            loop {
                let task = asked.lock().unwrap_or_else(PoisonError::into_inner).recv();
                let Ok(Task { call, answer }) = task else { return };
                let reply = catch_printed_panic(|| bench.answer(&call));
                // The client may already have gone. Then the answer is not needed.
                let _ = answer.send(reply.unwrap_or_else(|()| Refusal::new(500, "the request has failed").into()));
            }
        };
        thread::Builder::new().name(format!("lab {number}")).spawn(work).map_err(failed())?;
    }
    let site = Site::new(address.port(), token.clone(), bench, tasks);
    let server = Server::new(listener, site).map_err(failed())?;
    thread::Builder::new().name("http".into()).spawn(move || server.run()).map_err(failed())?;
    begun(&format!("http://{address}/?token={}", token.text()))?;
    loop {
        queue.advance();
        thread::sleep(INTERVAL);
    }
}

/// Locks the folder for one laboratory that changes it.
fn claim(folder: &Folder) -> Result<fs::File, Error> {
    let path = folder.own_directory()?.join("lock");
    let file = lock::open(&path).map_err(Error::io("lock", &path))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(_) => Err(Error::Usage(format!(
            "{}: another `lab` has this folder. Use its page, or look with --read-only",
            folder.path().display()
        ))),
    }
}
