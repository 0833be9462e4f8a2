//! Another fitness for a task that there is: foraging, where the death of a robot costs.

use farsa_experiments::foraging::{Foraging, ForagingMission};
