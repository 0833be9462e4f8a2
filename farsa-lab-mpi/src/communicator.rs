//! The ranks of an MPI communicator.

use std::io::{self, Write as _};
use std::thread;
use std::time::{Duration, Instant};

use farsa_lab::Error;
use farsa_lab::advanced::Ranks;
use mpi::Count;
use mpi::collective::CommunicatorCollectives as _;
use mpi::datatype::PartitionMut;
use mpi::point_to_point::{Destination as _, Source as _};
use mpi::request::Request;
use mpi::topology::{Color, Communicator as _, SimpleCommunicator};

/// The largest number of bytes of all ranks together in one MPI call, which counts in 32 bits.
const MOST: usize = 1 << 30;
/// The shortest and the longest pause between two checks for the other ranks.
const PAUSES: [Duration; 2] = [Duration::from_micros(20), Duration::from_millis(1)];

/// The wait after which a rank reports that it waits. Each further report takes twice as long.
const SILENCE: Duration = Duration::from_secs(60);

/// The ranks of an MPI communicator, for one thread. An MPI error ends all processes.
pub struct MpiRanks {
    communicator: SimpleCommunicator,
}

impl MpiRanks {
    /// Creates the ranks of a communicator without other users.
    pub fn new(communicator: SimpleCommunicator) -> Self {
        Self { communicator }
    }

    /// Waits for all ranks. MPI libraries occupy a processor while they wait, so this function polls with pauses.
    fn meet(&self) {
        let since = Instant::now();
        let mut silence = SILENCE;
        let mut here: Request<'static, ()> = self.communicator.immediate_barrier();
        while let Err(waiting) = here.test() {
            here = waiting;
            if since.elapsed() >= silence {
                self.report_wait(silence);
                silence *= 2;
            }
            thread::sleep((since.elapsed() / 8).clamp(PAUSES[0], PAUSES[1]));
        }
    }
}

impl MpiRanks {
    /// Reports a wait on two ranks, of which at most one is the rank that is waited for.
    fn report_wait(&self, silence: Duration) {
        let rank = self.communicator.rank();
        if rank < 2 {
            let seconds = silence.as_secs();
            let why = "one of them is stopped, or its trials take longer";
            // A closed standard error does not end the run.
            let _ = writeln!(io::stderr(), "rank {rank}: has waited {seconds} s for the other ranks: {why}");
        }
    }
}

impl Ranks for MpiRanks {
    fn rank(&self) -> usize {
        self.communicator.rank() as usize
    }

    fn size(&self) -> usize {
        self.communicator.size() as usize
    }

    fn all_gather(&self, bytes: &[u8]) -> Result<Vec<Vec<u8>>, Error> {
        let size = self.size();
        self.meet();
        let mut lengths = vec![0_u64; size];
        self.communicator.all_gather_into(&(bytes.len() as u64), &mut lengths[..]);
        let mut all: Vec<Vec<u8>> = lengths.iter().map(|length| Vec::with_capacity(*length as usize)).collect();
        let (longest, piece) = (lengths.iter().copied().max().unwrap_or(0) as usize, (MOST / size).max(1));
        for first in (0..longest).step_by(piece) {
            let part = |length: usize| first.min(length)..(first + piece).min(length);
            let counts: Vec<Count> = lengths.iter().map(|length| part(*length as usize).len() as Count).collect();
            let starts: Vec<Count> = counts
                .iter()
                .scan(0, |end, count| {
                    *end += count;
                    Some(*end - count)
                })
                .collect();
            let mut received = vec![0_u8; counts.iter().sum::<Count>() as usize];
            let mut parts = PartitionMut::new(&mut received[..], &counts[..], &starts[..]);
            self.communicator.all_gather_varcount_into(&bytes[part(bytes.len())], &mut parts);
            for ((all, start), count) in all.iter_mut().zip(starts).zip(counts) {
                all.extend_from_slice(&received[start as usize..(start + count) as usize]);
            }
        }
        Ok(all)
    }

    fn send(&self, to: usize, message: [u64; 2]) -> Result<(), Error> {
        // The small number of bytes is sent even without a receiver.
        self.communicator.process_at_rank(to as Count).send(&message[..]);
        Ok(())
    }

    fn receive(&self) -> Result<Option<(usize, [u64; 2])>, Error> {
        let Some((message, status)) = self.communicator.any_process().immediate_matched_probe() else {
            return Ok(None);
        };
        let mut found = [0; 2];
        message.matched_receive_into(&mut found[..]);
        Ok(Some((status.source_rank() as usize, found)))
    }

    fn split(&self, group: usize) -> Result<Box<dyn Ranks + '_>, Error> {
        self.meet();
        let color = Color::with_value(group as Count);
        let lost = || Error::Other(format!("MPI gives no communicator to group {group}"));
        let own = self.communicator.split_by_color(color).ok_or_else(lost)?;
        Ok(Box::new(Self::new(own)))
    }
}
