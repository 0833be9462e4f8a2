//! New generations and champions of a running run.

use std::fs;
use std::time::SystemTime;

use serde::Serialize;

use crate::error::Error;
use crate::live::champion::champions;
use crate::live::page_run::PageIndividual;
use crate::run::plan::Plan;
use crate::store::bounded::read_regular_text;
use crate::store::directory::Directory;
use crate::store::log;

/// Most bytes of a log.
const MAX_LOG_BYTES: u64 = 1 << 28;

/// Best and mean fitness of a generation, `None` where every evaluation failed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Row(pub(crate) usize, Option<f64>, Option<f64>);

impl Row {
    /// Builds the row of a generation from its best, mean and worst fitness.
    pub(crate) fn new(generation: usize, [best, mean, _]: log::Row) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        Self(generation, finite(best), finite(mean))
    }
}

/// Part of a run that a listener has already received.
#[derive(Debug, Default)]
pub(crate) struct SeenState {
    /// Number of generations whose fitness was read.
    generations: usize,
    /// Size of the log when it was read [bytes].
    log: u64,
    /// Size and time of the last checkpoint that was read.
    checkpoint: Option<(u64, SystemTime)>,
    /// Generation of the last champions.
    champions: Option<u32>,
}

impl SeenState {
    /// Starts after the given number of generations.
    pub(crate) fn first(generations: usize) -> Self {
        Self { generations, ..Self::default() }
    }

    /// Reads the rows that were added to the log.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::File`] for an invalid log.
    pub(crate) fn rows(&mut self, directory: &Directory) -> Result<Vec<Row>, Error> {
        let path = directory.log();
        let bytes = fs::metadata(&path).map_err(Error::io("read", &path))?.len();
        if bytes == self.log {
            return Ok(Vec::new());
        }
        let text = read_regular_text(&path, MAX_LOG_BYTES)?;
        // The last line may be incomplete.
        let complete = text.rfind('\n').map_or("", |end| &text[..end]);
        let read = self.generations;
        let rows = complete.lines().enumerate().skip(read.saturating_add(1)).map(|(number, line)| {
            let mut cells = line.split(',').skip(1).map_while(|cell| cell.parse().ok());
            let row = [(); 3].map(|()| cells.next());
            let damaged = || Error::damaged(&path, format!("line {}: {line}", number + 1));
            let [Some(best), Some(mean), Some(worst)] = row else { return Err(damaged()) };
            Ok(Row::new(number - 1, [best, mean, worst]))
        });
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        (self.log, self.generations) = (bytes, read + rows.len());
        Ok(rows)
    }

    /// Returns the champions of the checkpoint, one of each population, if they are new.
    ///
    /// # Errors
    /// Errors of [`champions`].
    pub(crate) fn champions(
        &mut self,
        plan: &Plan<'_>,
        directory: &Directory,
    ) -> Result<Option<Vec<PageIndividual>>, Error> {
        let path = directory.checkpoint();
        let metadata = fs::metadata(&path).map_err(Error::io("read", &path))?;
        let mark = metadata.modified().ok().map(|time| (metadata.len(), time));
        if mark.is_some() && mark == self.checkpoint {
            return Ok(None);
        }
        let best = champions(plan, directory)?;
        self.checkpoint = mark;
        let generation = best.first().map(|best| best.generation);
        let changed = self.champions != generation;
        self.champions = generation;
        Ok(changed.then_some(best))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_returned_once_and_when_complete() {
        let folder = tempfile::tempdir().unwrap();
        let directory = Directory::at(folder.path().into());
        let head = "generation,best,mean,worst,evaluations,failed\n";
        let write = |text: &str| fs::write(directory.log(), format!("{head}{text}")).unwrap();
        let mut seen = SeenState::first(1);
        assert!(seen.rows(&directory).is_err());
        write("0,1.5,1.0,0.0,4,0\n");
        assert_eq!(seen.rows(&directory).unwrap(), []);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3");
        assert_eq!(seen.rows(&directory).unwrap(), [Row::new(1, [2.0, f64::NEG_INFINITY, 0.0])]);
        assert_eq!(seen.rows(&directory).unwrap(), []);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3.0,2.0,1.0,4,0\n");
        assert_eq!(seen.rows(&directory).unwrap(), [Row::new(2, [3.0, 2.0, 1.0])]);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3.0,2.0,1.0,4,0\nmine\n");
        assert!(seen.rows(&directory).unwrap_err().to_string().contains("line 5: mine"));
        assert_eq!(SeenState::first(usize::MAX).rows(&directory).unwrap(), []);
    }
}
