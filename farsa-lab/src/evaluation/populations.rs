//! For which of several populations something on the command line is.

use std::path::{Path, PathBuf};

use crate::error::Error;

/// Populations of an experiment by name, in their order.
pub(crate) struct Populations<'n> {
    pub(crate) experiment: &'n str,
    pub(crate) names: &'n [String],
}

/// Something from the command line, with the population that it names.
pub(crate) type Assigned<T> = (Option<usize>, T);

impl Populations<'_> {
    /// Divides `NAME=REST` if there are several populations. Without a name everything is the rest.
    ///
    /// # Errors
    /// [`Error::Setting`] with the nearest population.
    pub(crate) fn split<'t>(&self, option: &str, text: &'t str) -> Result<Assigned<&'t str>, Error> {
        let Some((name, rest)) = text.split_once('=').filter(|_| self.names.len() > 1) else {
            return Ok((None, text));
        };
        self.one(option, Some(name)).map(|found| (Some(found), rest))
    }

    /// Divides the name of a file. A name that is not Unicode names no population.
    ///
    /// # Errors
    /// As for [`split`](Self::split).
    pub(crate) fn file(&self, option: &str, path: &Path) -> Result<Assigned<PathBuf>, Error> {
        let Some(text) = path.to_str() else { return Ok((None, path.into())) };
        self.split(option, text).map(|(population, rest)| (population, rest.into()))
    }

    /// Gets the population of this name, or the only one.
    ///
    /// # Errors
    /// [`Error::Setting`] with the nearest population, [`Error::Usage`] if none of several is named.
    pub(crate) fn one(&self, option: &str, name: Option<&str>) -> Result<usize, Error> {
        match name {
            Some(name) => {
                let unknown = || Error::unknown(option, "population", name, self.names.iter().map(String::as_str));
                self.names.iter().position(|known| known == name).ok_or_else(unknown)
            }
            None if self.names.len() > 1 => Err(Error::Usage(format!("{option}: {}: name one", self.several()))),
            None => Ok(0),
        }
    }

    /// That there are several, and which.
    fn several(&self) -> String {
        format!("{} has {} populations, {}", self.experiment, self.names.len(), self.names.join(" and "))
    }

    /// Groups values by population: by name, or one for each in order.
    ///
    /// # Errors
    /// [`Error::Usage`] for a population that is left without, and for names here and none there.
    pub(crate) fn divide<T>(&self, option: &str, given: Vec<Assigned<T>>) -> Result<Vec<Vec<T>>, Error> {
        let names = self.names;
        let count = names.len();
        let named = given.iter().filter(|(population, _)| population.is_some()).count();
        let mut groups: Vec<Vec<T>> = names.iter().map(|_| Vec::new()).collect();
        if named != 0 && named != given.len() {
            return Err(Error::Usage(format!(
                "{option}: {}: name it everywhere or nowhere, as in {}",
                self.several(),
                self.example()
            )));
        }
        if named == 0 && count > 1 && given.len() != count {
            let count = given.len();
            let example = self.example();
            return Err(Error::Usage(format!(
                "{option}: {count} given: {}; one for each in this order, or {example}",
                self.several()
            )));
        }
        for (place, (population, value)) in given.into_iter().enumerate() {
            groups[population.unwrap_or(if count > 1 { place } else { 0 })].push(value);
        }
        if let Some(without) = groups.iter().position(Vec::is_empty) {
            let name = &names[without];
            return Err(Error::Usage(format!("{option}: none for population `{name}`: {name}=...")));
        }
        Ok(groups)
    }

    /// Each population's name in front of what is given for it.
    fn example(&self) -> String {
        self.names.iter().map(|name| format!("{name}=...")).collect::<Vec<_>>().join(" ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> Vec<String> {
        ["predator", "prey"].map(String::from).to_vec()
    }

    #[test]
    fn names_and_orders_are_told_apart() {
        let names = names();
        let two = Populations { experiment: "hunt", names: &names };
        assert_eq!(two.split("--genes", "prey=1,2").unwrap(), (Some(1), "1,2"));
        assert_eq!(two.split("--genes", "1,2").unwrap(), (None, "1,2"));
        assert_eq!(two.split("FILE", "prey=a=b.gen").unwrap(), (Some(1), "a=b.gen"));
        let error = two.split("--genes", "pray=1,2").unwrap_err().to_string();
        assert_eq!(error, "--genes: unknown population `pray`; the nearest is `prey`");
        let one = Populations { experiment: "walk", names: &names[..1] };
        assert_eq!(one.split("FILE", "a=b.gen").unwrap(), (None, "a=b.gen"));
        assert_eq!(one.divide("FILE", vec![(None, 1), (None, 2)]).unwrap(), [[1, 2]]);
        assert_eq!(two.divide("FILE", vec![(None, 1), (None, 2)]).unwrap(), [[1], [2]]);
        let named = vec![(Some(1), 1), (Some(0), 2), (Some(1), 3)];
        assert_eq!(two.divide("FILE", named).unwrap(), [vec![2], vec![1, 3]]);
    }

    #[test]
    fn who_is_left_without_is_named() {
        let names = names();
        let two = Populations { experiment: "hunt", names: &names };
        let message = |given: Vec<Assigned<u8>>| two.divide("--genes", given).unwrap_err().to_string();
        let order = "--genes: 1 given: hunt has 2 populations, predator and prey; one for each in this order, or \
                     predator=... prey=...";
        assert_eq!(message(vec![(None, 1)]), order);
        assert_eq!(message(vec![(Some(0), 1)]), "--genes: none for population `prey`: prey=...");
        assert!(message(vec![(Some(0), 1), (None, 1)]).contains("name it everywhere or nowhere"));
        assert!(message(vec![(None, 1); 3]).starts_with("--genes: 3 given: "));
    }
}
