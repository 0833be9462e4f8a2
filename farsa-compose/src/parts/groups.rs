//! Groups of equal robots, and their populations.

use farsa_lab::Error;

use crate::check::source::Source;

/// Groups of consecutive robots.
#[derive(Clone, Debug, Default)]
pub(crate) struct Groups {
    /// Name of each group, its first robot and the one after its last.
    groups: Vec<(String, [usize; 2])>,
    /// True if each group is a population.
    apart: bool,
}

impl Groups {
    /// Creates groups of these names and sizes. `apart` makes each a population.
    pub(crate) fn new(sizes: impl IntoIterator<Item = (String, usize)>, apart: bool) -> Self {
        let mut first = 0;
        let group = |(name, size): (String, usize)| {
            first += size;
            (name, [first - size, first])
        };
        Self { groups: sizes.into_iter().map(group).collect(), apart }
    }

    /// Gets the number of robots.
    pub(crate) fn robots(&self) -> usize {
        self.groups.last().map_or(0, |(_, [_, end])| *end)
    }

    /// Returns a named group.
    pub(crate) fn named(&self, name: &str) -> Option<[usize; 2]> {
        self.groups.iter().find(|(known, _)| known == name).map(|(_, range)| *range)
    }

    /// Returns the group of the name at a path.
    pub(crate) fn find(&self, name: &str, path: &str, source: &Source) -> Result<[usize; 2], Error> {
        let names = self.groups.iter().map(|(name, _)| name.as_str());
        self.named(name).ok_or_else(|| Error::unknown(&source.of(path), "group of robots", name, names))
    }

    /// Returns the group of a robot.
    pub(crate) fn of(&self, robot: usize) -> &str {
        let group = self.groups.iter().find(|(_, [first, end])| (*first..*end).contains(&robot));
        group.map_or("", |(name, _)| name)
    }

    /// Lists the names of the populations, empty if all robots have one genome.
    pub(crate) fn populations(&self) -> Vec<String> {
        if self.apart { self.groups.iter().map(|(name, _)| name.clone()).collect() } else { Vec::new() }
    }

    /// Lists the robots of each population.
    pub(crate) fn ranges(&self) -> Vec<[usize; 2]> {
        if self.apart { self.groups.iter().map(|(_, range)| *range).collect() } else { vec![[0, self.robots()]] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robots_are_numbered_through() {
        let sizes = || [("hunter".to_owned(), 2), ("prey".to_owned(), 3)];
        let groups = Groups::new(sizes(), true);
        assert_eq!((groups.robots(), groups.named("prey"), groups.named("p")), (5, Some([2, 5]), None));
        assert_eq!([0, 1, 2, 4].map(|robot| groups.of(robot)), ["hunter", "hunter", "prey", "prey"]);
        assert_eq!(
            (groups.populations(), groups.ranges()),
            (vec!["hunter".into(), "prey".into()], vec![[0, 2], [2, 5]])
        );
        let single = Groups::new(sizes(), false);
        assert_eq!((single.populations(), single.ranges()), (Vec::<String>::new(), vec![[0, 5]]));
    }
}
