//! What a run that goes on has come to since it was looked at last.

use std::fs;
use std::time::SystemTime;

use crate::error::Error;
use crate::live::champion::champions;
use crate::live::row::Row;
use crate::live::script::Evolved;
use crate::run::plan::Plan;
use crate::store::bounded::read_regular_text;
use crate::store::directory::Directory;

/// Most bytes of a log that is read.
const MOST_LOG: u64 = 1 << 28;

/// What is known of a run already.
#[derive(Debug, Default)]
pub(crate) struct Known {
    /// Generations whose fitness is known.
    generations: usize,
    /// Bytes of the log when it was read.
    log: u64,
    /// Bytes and time of the last checkpoint that was looked at.
    checkpoint: Option<(u64, SystemTime)>,
    /// The generation of the champions that are known.
    champions: Option<u32>,
}

impl Known {
    /// So many generations are known.
    pub(crate) fn first(generations: usize) -> Self {
        Self { generations, ..Self::default() }
    }

    /// The rows of the log that have been added.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::Damaged`] for a log that is none.
    pub(crate) fn rows(&mut self, directory: &Directory) -> Result<Vec<Row>, Error> {
        let path = directory.log();
        let bytes = fs::metadata(&path).map_err(Error::io("read", &path))?.len();
        if bytes == self.log {
            return Ok(Vec::new());
        }
        let text = read_regular_text(&path, MOST_LOG)?;
        // The last line may be written at this moment.
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let known = self.generations;
        let rows = whole.lines().enumerate().skip(known.saturating_add(1)).map(|(number, line)| {
            let mut cells = line.split(',').skip(1).map_while(|cell| cell.parse().ok());
            let row = [(); 3].map(|()| cells.next());
            let damaged = || Error::damaged(&path, format!("line {}: {line}", number + 1));
            let [Some(best), Some(mean), Some(worst)] = row else { return Err(damaged()) };
            Ok(Row::new(number - 1, [best, mean, worst]))
        });
        let rows = rows.collect::<Result<Vec<_>, _>>()?;
        (self.log, self.generations) = (bytes, known + rows.len());
        Ok(rows)
    }

    /// The champions of what is saved, one of each population, if they are others than are known.
    ///
    /// # Errors
    /// What keeps them from being rebuilt.
    pub(crate) fn champions(&mut self, plan: &Plan<'_>, directory: &Directory) -> Result<Option<Vec<Evolved>>, Error> {
        let path = directory.checkpoint();
        let found = fs::metadata(&path).map_err(Error::io("read", &path))?;
        let mark = found.modified().ok().map(|time| (found.len(), time));
        if mark.is_some() && mark == self.checkpoint {
            return Ok(None);
        }
        let best = champions(plan, directory)?;
        self.checkpoint = mark;
        let generation = best.first().map(|best| best.generation);
        let other = self.champions != generation;
        self.champions = generation;
        Ok(other.then_some(best))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_once_and_when_they_are_whole() {
        let folder = tempfile::tempdir().unwrap();
        let directory = Directory::at(folder.path().into());
        let head = "generation,best,mean,worst,evaluations,failed\n";
        let write = |text: &str| fs::write(directory.log(), format!("{head}{text}")).unwrap();
        let mut known = Known::first(1);
        assert!(known.rows(&directory).is_err());
        write("0,1.5,1.0,0.0,4,0\n");
        assert_eq!(known.rows(&directory).unwrap(), []);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3");
        assert_eq!(known.rows(&directory).unwrap(), [Row::new(1, [2.0, f64::NEG_INFINITY, 0.0])]);
        assert_eq!(known.rows(&directory).unwrap(), []);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3.0,2.0,1.0,4,0\n");
        assert_eq!(known.rows(&directory).unwrap(), [Row::new(2, [3.0, 2.0, 1.0])]);
        write("0,1.5,1.0,0.0,4,0\n1,2.0,-inf,-inf,4,1\n2,3.0,2.0,1.0,4,0\nmine\n");
        assert!(known.rows(&directory).unwrap_err().to_string().contains("line 5: mine"));
        assert_eq!(Known::first(usize::MAX).rows(&directory).unwrap(), []);
    }
}
