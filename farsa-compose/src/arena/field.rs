//! Food on a field, and robots that forage on it.

use crate::part::moment::Stock;

/// State of a forager.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Forager {
    /// Energy \[0..1\], 0 for a dead robot.
    pub(crate) energy: f64,
    /// False after death.
    pub(crate) alive: bool,
    /// Pieces of food that it carries.
    pub(crate) carried: u32,
    /// Steps since its last visit to the nest.
    away: u32,
}

/// A field of cells with one piece of food each, and a round nest to which robots carry food.
///
/// A robot that enters a cell takes its food. In the nest it delivers its load and its energy returns to 1. Without
/// energy it dies and its load is lost.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    /// Width and depth [m].
    size: [f64; 2],
    /// Cells along each side.
    cells: usize,
    /// Energy cost of a step.
    cost: f64,
    nest: [f64; 2],
    radius: f64,
    /// Food of each cell, row by row.
    food: Vec<bool>,
    robots: Vec<Forager>,
    collected: u32,
    lost: u32,
}

impl Field {
    /// Creates a field of this size \[m\] with `cells` times `cells` cells from the origin. `cost` is the energy cost
    /// of a step and `radius` the radius of the nest \[m\].
    pub(crate) fn new(size: [f64; 2], cells: usize, cost: f64, radius: f64, robots: usize) -> Self {
        let robot = Forager { energy: 1.0, alive: true, carried: 0, away: 0 };
        let (food, robots) = (vec![true; cells * cells], vec![robot; robots]);
        Self { size, cells, cost, nest: [0.0; 2], radius, food, robots, collected: 0, lost: 0 }
    }

    /// Restores all food and the energy of all robots, with the nest at this place \[m\].
    pub(crate) fn begin(&mut self, nest: [f64; 2]) {
        self.nest = nest;
        self.food.fill(true);
        self.robots.fill(Forager { energy: 1.0, alive: true, carried: 0, away: 0 });
        (self.collected, self.lost) = (0, 0);
    }

    /// Returns true for a place in the nest.
    pub(crate) fn in_nest(&self, [x, y]: [f64; 2]) -> bool {
        let [x, y] = [x - self.nest[0], y - self.nest[1]];
        x * x + y * y <= self.radius * self.radius
    }

    /// Steps a robot that has moved to this place \[m\]. It pays for the step, takes food, and delivers it or dies.
    ///
    /// A robot that reaches the nest with its last energy survives. Places outside the field have no food.
    pub(crate) fn step(&mut self, robot: usize, at: [f64; 2]) {
        let nest = self.in_nest(at);
        let Some(forager) = self.robots.get_mut(robot).filter(|forager| forager.alive) else { return };
        forager.away += 1;
        // Computed from the number of steps, so that a hundred times 0.01 is exactly 1.
        forager.energy = (1.0 - self.cost * f64::from(forager.away)).max(0.0);
        // Cell of the place: floor(p / size * cells).
        let [column, row] = [0, 1].map(|k| at[k] / self.size[k] * self.cells as f64);
        // The upper end is excluded, because a robot exactly on it would be in a cell that does not exist.
        let on_field = |x: f64| x >= 0.0 && x < self.cells as f64;
        // A robot that dies in this step takes nothing.
        if on_field(column) && on_field(row) && (nest || forager.energy > 0.0) {
            let food = &mut self.food[row as usize * self.cells + column as usize];
            forager.carried += u32::from(core::mem::take(food));
        }
        if nest {
            self.collected += forager.carried;
            *forager = Forager { energy: 1.0, alive: true, carried: 0, away: 0 };
        } else if forager.energy <= 0.0 {
            self.lost += forager.carried;
            *forager = Forager { energy: 0.0, alive: false, carried: 0, ..*forager };
        }
    }

    /// Gets the states of all robots.
    pub(crate) fn robots(&self) -> &[Forager] {
        &self.robots
    }

    /// Gets the food of each cell, row by row from the origin along x.
    pub(crate) fn food(&self) -> &[bool] {
        &self.food
    }

    /// Returns width and depth [m].
    pub(crate) fn size(&self) -> [f64; 2] {
        self.size
    }

    /// Gets the number of cells along each side.
    pub(crate) fn cells(&self) -> usize {
        self.cells
    }

    /// Gets the number of delivered pieces of food.
    pub(crate) fn collected(&self) -> u32 {
        self.collected
    }

    /// Gets the number of pieces lost with dead robots.
    pub(crate) fn lost(&self) -> u32 {
        self.lost
    }

    /// Gets the number of pieces that robots carry.
    pub(crate) fn carried(&self) -> u32 {
        self.robots.iter().map(|forager| forager.carried).sum()
    }

    /// Gets the number of dead robots.
    pub(crate) fn deaths(&self) -> usize {
        self.robots.iter().filter(|forager| !forager.alive).count()
    }
}

impl Stock for Field {
    fn collected(&self) -> u32 {
        Self::collected(self)
    }

    fn carried(&self) -> u32 {
        Self::carried(self)
    }

    fn lost(&self) -> u32 {
        Self::lost(self)
    }

    fn deaths(&self) -> usize {
        Self::deaths(self)
    }

    fn energy(&self, robot: usize) -> Option<(f64, bool)> {
        self.robots().get(robot).map(|forager| (forager.energy, forager.alive))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    /// Counts the pieces on the field.
    fn left(field: &Field) -> usize {
        field.food().iter().filter(|food| **food).count()
    }

    #[test]
    fn a_robot_lives_a_hundred_steps_away_from_the_nest() {
        let mut field = Field::new([5.0; 2], 20, 0.01, 0.4, 2);
        field.begin([2.5, 2.5]);
        for step in 1..100 {
            field.step(0, [0.1, 0.1]);
            field.step(1, [0.1, 0.1]);
            assert!(field.robots()[0].alive, "{step}");
        }
        // The first reaches the nest with its last step, the second does not.
        field.step(0, [2.5, 2.8]);
        field.step(1, [0.1, 0.1]);
        assert_eq!((field.robots()[0].alive, field.robots()[0].energy, field.deaths()), (true, 1.0, 1));
        // The first took the food of its cell and of the nest's cell. The second found none.
        assert_eq!((field.collected(), field.lost(), left(&field)), (2, 0, 398));
        field.step(1, [2.5, 2.5]);
        assert_eq!((field.deaths(), field.collected(), left(&field)), (1, 2, 398));
    }

    /// Cells of 0.5 m by 0.25 m begin at the origin and end before the far sides.
    #[test]
    fn cells_are_parts_of_the_width_and_of_the_depth() {
        let taken = |at| {
            let mut field = Field::new([2.0, 1.0], 4, 0.01, 0.05, 1);
            field.begin([9.0, 9.0]);
            field.step(0, at);
            field.food().iter().position(|food| !food)
        };
        for (at, cell) in [
            ([0.0, 0.0], Some(0)),
            ([0.49, 0.24], Some(0)),
            ([0.5, 0.24], Some(1)),
            ([0.49, 0.25], Some(4)),
            ([1.3, 0.6], Some(2 + 4 * 2)),
            ([1.99, 0.99], Some(15)),
            ([2.0, 0.5], None),
            ([0.5, 1.0], None),
            ([-0.01, 0.5], None),
            ([0.5, -0.01], None),
        ] {
            assert_eq!(taken(at), cell, "{at:?}");
        }
        // The edge of the nest belongs to it.
        let mut field = Field::new([2.0, 1.0], 4, 0.01, 0.5, 1);
        field.begin([1.0, 0.5]);
        assert!(field.in_nest([1.5, 0.5]) && !field.in_nest([1.5001, 0.5]) && !field.in_nest([1.4, 0.9]));
    }

    proptest! {
        /// Compares with lists that are searched from the beginning in every step.
        #[test]
        fn the_book_agrees_with_the_story_told_from_its_beginning(
            places in prop::collection::vec((0_usize..3, 0_u8..40, 0_u8..40), 1..600),
            cost in prop::sample::select(&[0.01, 0.04, 0.3][..]),
        ) {
            let at = |x: u8, y: u8| [0.05 + 0.1 * f64::from(x), 0.05 + 0.1 * f64::from(y)];
            let mut field = Field::new([4.0; 2], 8, cost, 0.9, 3);
            field.begin([1.0, 2.0]);
            for (robot, x, y) in &places {
                field.step(*robot, at(*x, *y));
            }
            let home = |x: u8, y: u8| {
                let [a, b] = at(x, y);
                farsa_num::Scalar::sqrt((a - 1.0) * (a - 1.0) + (b - 2.0) * (b - 2.0)) <= 0.9
            };
            // Steps that the energy is enough for. The last one only counts if it ends in the nest.
            let lasts = (1.0 / cost - 1e-9).ceil() as usize;
            let mut taken: BTreeSet<(u8, u8)> = BTreeSet::new();
            let (mut bags, mut away, mut dead) = (vec![Vec::new(); 3], [0; 3], [false; 3]);
            let (mut paid, mut lost) = (Vec::new(), Vec::new());
            for (robot, x, y) in places {
                if dead[robot] {
                    continue;
                }
                away[robot] += 1;
                let exhausted = away[robot] >= lasts && !home(x, y);
                if !exhausted && taken.insert((x / 5, y / 5)) {
                    bags[robot].push((x / 5, y / 5));
                }
                if home(x, y) {
                    paid.append(&mut bags[robot]);
                    away[robot] = 0;
                } else if exhausted {
                    lost.append(&mut bags[robot]);
                    dead[robot] = true;
                }
            }
            prop_assert_eq!((field.collected() as usize, field.lost() as usize), (paid.len(), lost.len()));
            prop_assert_eq!(left(&field), 64 - taken.len());
            prop_assert_eq!(left(&field) + (field.collected() + field.lost() + field.carried()) as usize, 64);
            for (robot, forager) in field.robots().iter().enumerate() {
                prop_assert_eq!(forager.carried as usize, bags[robot].len());
                prop_assert_eq!(forager.alive, !dead[robot]);
                let energy = if dead[robot] { 0.0 } else { 1.0 - cost * away[robot] as f64 };
                prop_assert!((forager.energy - energy).abs() < 1e-9);
            }
        }
    }
}
