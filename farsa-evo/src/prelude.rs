//! Names that most programs need. Import them with `use farsa_evo::prelude::*`.

pub use crate::archives::{GridCells, MapElites, MapElitesConfig};
pub use crate::covariance::{CmaEs, CmaEsConfig};
pub use crate::words::{GaConfig, GeneRange, TruncationGa, decode};
pub use crate::{Champion, EvoError, Fitness, Population, Record, Scores, Strategy};
