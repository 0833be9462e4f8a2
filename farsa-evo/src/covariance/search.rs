//! What all searches of one normal distribution do, whatever its covariance.

/// Makes a [`Strategy`](crate::Strategy) that saves its state of a type with `config`, `seed`, `generation`, `distribution` and
/// `population`; the last argument says how many generations of so many genes may lie between two states that are kept.
macro_rules! search {
    ($search:ident, $covariance:ident, $between:expr) => {
        impl Strategy<f64> for $search {
            fn generation(&self) -> u32 {
                self.generation
            }

            fn ask(&self) -> &Population<f64> {
                &self.population
            }

            fn tell(&mut self, fitness: &[Fitness]) -> Result<(), EvoError> {
                self.generation = next_generation(self.generation, self.config.population, fitness)?;
                if fitness.iter().any(|fitness| !fitness.is_failed()) {
                    self.distribution.update(&ranked(fitness));
                }
                self.distribution.sample(self.seed, self.generation, &mut self.population);
                Ok(())
            }

            fn snapshot(&mut self) -> Option<&mut dyn Snapshot> {
                Some(self)
            }

            /// The step size and the axis ratio.
            fn diagnostics(&self) -> Vec<f64> {
                vec![self.sigma(), self.axis_ratio()]
            }
        }

        impl Snapshot for $search {
            fn save(&self) -> Vec<u8> {
                let length = 4 + Distribution::<$covariance>::state_length(self.config.mean.len());
                let mut state = Vec::with_capacity(length);
                state.extend(self.generation.to_le_bytes());
                self.distribution.save(&mut state);
                state
            }

            fn restore(&mut self, state: &[u8]) -> Result<(), EvoError> {
                let length = 4 + Distribution::<$covariance>::state_length(self.config.mean.len());
                let mut reader = StateReader::new(state, length)?;
                let generation = reader.u32()?;
                let mut distribution = self.distribution.clone();
                distribution.restore(&mut reader)?;
                (self.generation, self.distribution) = (generation, distribution);
                self.distribution.sample(self.seed, generation, &mut self.population);
                Ok(())
            }

            fn snapshot_interval(&self) -> u32 {
                $between(self.config.mean.len())
            }
        }
    };
}

pub(super) use search;
