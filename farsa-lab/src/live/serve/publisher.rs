//! Pages and champions of the run in a directory, which may be replaced by another one.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};

use hyper::body::Bytes;

use crate::error::Error;
use crate::live::champion::champions;
use crate::live::http::answer::event;
use crate::live::http::paced::INTERVAL;
use crate::live::page::{self, Chosen, Use};
use crate::live::run_mark::{FileMark, RunMark};
use crate::live::serve::state::{NamedRun, Question, Shared, Unavailable};
use crate::run::catch_panic::catch_printed_panic;
use crate::run::config_file::ConfigFile;
use crate::run::laboratory::Laboratory;
use crate::run::plan::Plan;
use crate::store::directory::Directory;

/// Returns the module for the page of a plan.
pub(crate) type ModuleOf<'s> = dyn Fn(&Plan<'_>) -> Result<&'s [u8], Error> + 's;

/// A directory of runs and the module for their pages.
#[derive(Clone, Copy)]
pub(crate) struct Served<'s, 'e> {
    pub(crate) laboratory: &'s Laboratory<'e>,
    pub(crate) directory: &'s Directory,
    pub(crate) module: &'s ModuleOf<'s>,
}

/// Builder of pages, one at a time.
pub(super) struct Publisher<'s, 'e> {
    served: Served<'s, 'e>,
    shared: Arc<Shared>,
    run: Result<OpenRun<'e>, String>,
    /// Last page, and the files that it was built from.
    page: Option<(Vec<Option<FileMark>>, Bytes)>,
    /// Checkpoint of the last champions.
    checkpoint: Option<FileMark>,
    /// Number of champions that were published.
    published: u64,
}

/// The run that the directory holds.
struct OpenRun<'e> {
    plan: Plan<'e>,
    named: Arc<NamedRun>,
}

impl<'s, 'e> Publisher<'s, 'e> {
    pub(super) fn new(served: Served<'s, 'e>, shared: Arc<Shared>) -> Self {
        Self { served, shared, run: Err(String::new()), page: None, checkpoint: None, published: 0 }
    }

    /// Answers requests, and follows the directory in between, until the other thread ends.
    pub(super) fn answer(mut self, questions: &Receiver<Question>) {
        loop {
            let question = match questions.recv_timeout(INTERVAL) {
                Ok(question) => Some(question),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return,
            };
            self.follow();
            // The experiment's code may panic.
            if self.shared.has_listeners() && catch_printed_panic(|| self.publish()).is_err() {
                self.checkpoint = None;
            }
            // The client may already have gone. Then the answer is not needed.
            match question {
                Some(Question::Page(answer)) if !answer.is_closed() => {
                    let panicked = |()| Err(Unavailable { status: 500, why: "The experiment has panicked.".into() });
                    let _ = answer.send(catch_printed_panic(|| self.page()).unwrap_or_else(panicked));
                }
                Some(Question::Champions(answer)) => {
                    let _ = answer.send(());
                }
                _ => {}
            }
        }
    }

    /// Opens the run in the directory, if it is another one than before.
    fn follow(&mut self) {
        let directory = self.served.directory;
        let mark = RunMark::read(directory);
        if let (Ok(run), Some(mark)) = (&self.run, &mark)
            && run.named.mark == *mark
        {
            return;
        }
        let before = self.run.as_ref().ok().map(|run| run.named.name.clone());
        self.run = match mark {
            Some(mark) => self.open(mark).map_err(|error| error.to_string()),
            None => Err(absence(directory)),
        };
        let named = self.run.as_ref().ok().map(|run| run.named.clone());
        if before.is_none() || before != named.as_ref().map(|named| named.name.clone()) {
            (self.page, self.checkpoint) = (None, None);
            self.shared.update(|current| current.champions = None);
        }
        self.shared.update(|current| current.run = named);
    }

    fn open(&self, mark: RunMark) -> Result<OpenRun<'e>, Error> {
        let Served { laboratory, directory, .. } = self.served;
        let plan = Plan::from_file(laboratory, &ConfigFile::read_regular(&directory.config())?)?;
        let name = mark.name(&plan.identity()?)?;
        Ok(OpenRun { plan, named: Arc::new(NamedRun { name, mark }) })
    }

    /// Publishes the champions of a new checkpoint. A file that is being written is read in the next interval.
    fn publish(&mut self) {
        let Ok(run) = &self.run else { return };
        let directory = self.served.directory;
        let checkpoint = FileMark::read(&directory.checkpoint());
        if checkpoint.is_none() || checkpoint == self.checkpoint {
            return;
        }
        let found = champions(&run.plan, directory).and_then(|champions| event("champions", None, &champions));
        let is_there = RunMark::read(directory).as_ref() == Some(&run.named.mark);
        if let Some(event) = found.ok().filter(|_| is_there) {
            self.checkpoint = checkpoint;
            if self.shared.current().champions.is_none_or(|(_, known)| known != event) {
                self.published += 1;
                let published = self.published;
                self.shared.update(|current| current.champions = Some((published, event)));
            }
        }
    }

    /// Returns the current page of the run, which is built again after each checkpoint.
    fn page(&mut self) -> Result<Bytes, Unavailable> {
        let failed = |error: Error| Unavailable { status: 500, why: error.to_string() };
        let Served { laboratory, directory, module } = self.served;
        let unavailable = |why: &str| Unavailable { status: 503, why: why.into() };
        let run = self.run.as_ref().map_err(|why| unavailable(why))?;
        let marks = [directory.config(), directory.champion(), directory.checkpoint(), directory.genotypes()];
        let marks: Vec<_> = marks.iter().map(|path| FileMark::read(path)).collect();
        if marks[1].is_none() {
            return Err(unavailable("No generation is finished yet."));
        }
        if let Some((_, page)) = self.page.as_ref().filter(|(known, _)| *known == marks) {
            return Ok(page.clone());
        }
        // The old page is not needed while the new one is built.
        self.page = None;
        let module = module(&run.plan).map_err(failed)?;
        let used = Use::Served { run: &run.named.name };
        let page = page::html(laboratory, (&run.plan, directory), Chosen::default(), module, used);
        if RunMark::read(directory).as_ref() != Some(&run.named.mark) {
            return Err(unavailable("Another run replaces this one."));
        }
        let page = Bytes::from(page.map_err(failed)?.html);
        self.page = Some((marks, page.clone()));
        Ok(page)
    }
}

/// Returns the reason why a directory holds no run.
fn absence(directory: &Directory) -> String {
    Directory::open(directory.path()).map_or_else(|error| error.to_string(), |_| "The run has just begun.".into())
}
