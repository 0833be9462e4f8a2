//! Food on a field, and the robots that feed on it.

/// What a robot has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forager {
    /// Energy \[0..1\], 0 when it is dead.
    pub energy: f64,
    /// Whether it is alive.
    pub alive: bool,
    /// Food that it carries.
    pub carried: u32,
    /// Steps since it was in the nest last.
    away: u32,
}

/// Cells with one piece of food each, a round nest, and the records of robots that carry food there.
///
/// A robot that enters a cell takes its food; one in the nest delivers what it carries and gets full energy; one that
/// runs out of energy is dead, and what it carries is lost.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Width and depth [m].
    size: [f64; 2],
    /// Cells along each side.
    cells: usize,
    /// Energy that a step costs.
    cost: f64,
    nest: [f64; 2],
    radius: f64,
    /// Whether a cell has its food, row by row.
    food: Vec<bool>,
    robots: Vec<Forager>,
    collected: u32,
    lost: u32,
}

impl Field {
    /// A field of `cells` times `cells` cells from the origin on without a nest yet, so wide and deep \[m\]; `cost` is the
    /// energy of a step, `radius` that of the nest \[m\].
    pub fn new(size: [f64; 2], cells: usize, cost: f64, radius: f64, robots: usize) -> Self {
        let robot = Forager { energy: 1.0, alive: true, carried: 0, away: 0 };
        let (food, robots) = (vec![true; cells * cells], vec![robot; robots]);
        Self { size, cells, cost, nest: [0.0; 2], radius, food, robots, collected: 0, lost: 0 }
    }

    /// Begins anew with all the food, all robots full of energy, and the nest there \[m\].
    pub fn begin(&mut self, nest: [f64; 2]) {
        self.nest = nest;
        self.food.fill(true);
        self.robots.fill(Forager { energy: 1.0, alive: true, carried: 0, away: 0 });
        (self.collected, self.lost) = (0, 0);
    }

    /// Whether a place lies in the nest.
    pub fn in_nest(&self, [x, y]: [f64; 2]) -> bool {
        let [x, y] = [x - self.nest[0], y - self.nest[1]];
        x * x + y * y <= self.radius * self.radius
    }

    /// One step of a robot that ended there \[m\]: it pays for the step, takes food, and is paid or dies.
    ///
    /// A robot that arrives in the nest with its last energy survives. What is not on the field has no food.
    pub fn step(&mut self, robot: usize, at: [f64; 2]) {
        let nest = self.in_nest(at);
        let Some(forager) = self.robots.get_mut(robot).filter(|forager| forager.alive) else { return };
        forager.away += 1;
        // From the number of steps, so that a hundred times 0.01 is 1.
        forager.energy = (1.0 - self.cost * f64::from(forager.away)).max(0.0);
        let [column, row] = [0, 1].map(|k| at[k] / self.size[k] * self.cells as f64);
        let on_field = |x: f64| x >= 0.0 && x < self.cells as f64;
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

    /// The robots' records.
    pub fn robots(&self) -> &[Forager] {
        &self.robots
    }

    /// Whether each cell still has its food, row by row from the origin, along x.
    pub fn food(&self) -> &[bool] {
        &self.food
    }

    /// Width and depth [m].
    pub(crate) fn size(&self) -> [f64; 2] {
        self.size
    }

    /// Cells along each side.
    pub(crate) fn cells(&self) -> usize {
        self.cells
    }

    /// Food that was carried to the nest.
    pub fn collected(&self) -> u32 {
        self.collected
    }

    /// Food that was lost with the robots that carried it.
    pub fn lost(&self) -> u32 {
        self.lost
    }

    /// Food that is being carried.
    pub fn carried(&self) -> u32 {
        self.robots.iter().map(|forager| forager.carried).sum()
    }

    /// Food that still lies on the field.
    pub fn left(&self) -> usize {
        self.food.iter().filter(|food| **food).count()
    }

    /// Robots that have died.
    pub fn deaths(&self) -> usize {
        self.robots.iter().filter(|forager| !forager.alive).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_robot_lives_a_hundred_steps_away_from_the_nest() {
        let mut field = Field::new([5.0; 2], 20, 0.01, 0.4, 2);
        field.begin([2.5, 2.5]);
        for step in 1..100 {
            field.step(0, [0.1, 0.1]);
            field.step(1, [0.1, 0.1]);
            assert!(field.robots()[0].alive, "{step}");
        }
        // One comes home with its last step, the other does not.
        field.step(0, [2.5, 2.8]);
        field.step(1, [0.1, 0.1]);
        assert_eq!((field.robots()[0].alive, field.robots()[0].energy, field.deaths()), (true, 1.0, 1));
        // The first took the cell's food and that of the cell in the nest; the second found none.
        assert_eq!((field.collected(), field.lost(), field.left()), (2, 0, 398));
        field.step(1, [2.5, 2.5]);
        assert_eq!((field.deaths(), field.collected(), field.left()), (1, 2, 398));
    }

    proptest! {
        /// Against lists that are searched through, with nothing counted on the way.
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
            // Steps that energy lasts for: the last one only if it ends at home.
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
            prop_assert_eq!(field.left(), 64 - taken.len());
            prop_assert_eq!(field.left() + (field.collected() + field.lost() + field.carried()) as usize, 64);
            for (robot, forager) in field.robots().iter().enumerate() {
                prop_assert_eq!(forager.carried as usize, bags[robot].len());
                prop_assert_eq!(forager.alive, !dead[robot]);
                let energy = if dead[robot] { 0.0 } else { 1.0 - cost * away[robot] as f64 };
                prop_assert!((forager.energy - energy).abs() < 1e-9);
            }
        }
    }
}
