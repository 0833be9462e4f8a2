//! A life: what an experiment does with a world from the first to the last step.

use farsa_body::World;
use serde::{Deserialize, Serialize};

/// Which life of a run: every random number of a life is drawn from a stream that these numbers name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Job {
    /// Seed of the run.
    pub seed: u64,
    /// Generation, from 0.
    pub generation: u32,
    /// Individual within the generation, from 0.
    pub individual: u32,
    /// First trial of the life, from 0.
    pub trial: u32,
}

impl Job {
    /// The population of the individual, from 0, where each has `size` individuals (`evolution.population`).
    pub fn population(&self, size: usize) -> usize {
        self.individual as usize / size.max(1)
    }
}

/// An experiment as it is lived in a world of type `W`.
///
/// A life steps no world: whoever runs it does, so that the same life runs alone ([`live`]) or in a lane of a batch.
pub trait Life<W: ?Sized> {
    /// Sets the world and the life up for `job`; what an earlier life left behind is forgotten.
    fn start(&mut self, world: &mut W, job: Job);

    /// Judges the step that has just passed (none at the first tick), then senses, thinks and acts.
    ///
    /// `Some(fitness)` ends the life, and the world need not be stepped again. A fitness of NaN says that the life
    /// failed: the world or the controller gave numbers that are no numbers.
    fn tick(&mut self, world: &mut W) -> Option<f64>;
}

/// Lives one life alone in `world` and returns its fitness.
pub fn live<W, L>(life: &mut L, world: &mut W, job: Job) -> f64
where
    W: World + ?Sized,
    L: Life<W> + ?Sized,
{
    life.start(world, job);
    loop {
        if let Some(fitness) = life.tick(world) {
            return fitness;
        }
        world.step();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::{ActuatorId, BodyId, Handles, JointId};

    struct Clock(u32);

    impl Handles for Clock {
        type Body = BodyId;
        type Joint = JointId;
        type Actuator = ActuatorId;
    }

    impl World for Clock {
        fn step(&mut self) {
            self.0 += 1;
        }
        fn time_step(&self) -> f32 {
            0.01
        }
    }

    struct UntilSix(u32);

    impl Life<Clock> for UntilSix {
        fn start(&mut self, world: &mut Clock, job: Job) {
            world.0 = 0;
            self.0 = job.trial;
        }
        fn tick(&mut self, world: &mut Clock) -> Option<f64> {
            (world.0 == 6).then(|| f64::from(world.0 + self.0))
        }
    }

    #[test]
    fn a_life_is_judged_after_every_step_and_starts_afresh() {
        let mut world = Clock(99);
        let mut life = UntilSix(0);
        assert_eq!(live(&mut life, &mut world, Job::default()), 6.0);
        assert_eq!(live(&mut life, &mut world, Job { trial: 4, ..Job::default() }), 10.0);
        assert_eq!(world.0, 6);
    }
}
