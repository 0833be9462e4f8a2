//! Many lives side by side, one in each lane of a batch of worlds.

use farsa_physics::articulated::{Batch, Lane};

use crate::experiment::life::{Job, Life};

/// Lives life after life in the lanes of a batch until there are no more.
///
/// Each of `lives` has a lane of its own. `begin` makes a life ready for its next job and returns the job, or `None` when
/// there is none left; `end` takes the fitness. A lane is filled again as soon as its life ends, whatever the others are
/// at, so every life is the one that [`live`](crate::live) lives alone: lanes, batches and the order of jobs change
/// nothing but time.
pub fn live_in_lanes<L>(
    lives: &mut [L],
    batch: &mut Batch,
    mut begin: impl FnMut(&mut L) -> Option<Job>,
    mut end: impl FnMut(&mut L, f64),
) where
    L: for<'a> Life<Lane<'a>>,
{
    debug_assert!(lives.len() <= batch.lanes(), "{} lives in {} lanes", lives.len(), batch.lanes());
    let lanes = lives.len().min(batch.lanes());
    let lives = &mut lives[..lanes];
    let mut lived = vec![false; lanes];
    let mut more = true;
    loop {
        for (index, (life, lived)) in lives.iter_mut().zip(&mut lived).enumerate() {
            let mut lane = batch.lane(index);
            loop {
                if !*lived {
                    // Who has said once that there are no more jobs is not asked again.
                    let Some(job) = more.then(|| begin(life)).flatten() else {
                        more = false;
                        break;
                    };
                    life.start(&mut lane, job);
                    *lived = true;
                }
                let Some(fitness) = life.tick(&mut lane) else { break };
                end(life, fitness);
                *lived = false;
            }
        }
        if !lived.contains(&true) {
            return;
        }
        batch.step();
    }
}
