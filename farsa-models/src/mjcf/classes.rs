//! MJCF's classes of defaults, and the lookup of missing attributes.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::error::ReadError;
use crate::xml::tree::Element;

/// Elements in which a class may give defaults, apart from actuators.
const DEFAULTS: [&str; 12] = [
    "mesh", "material", "joint", "geom", "site", "camera", "light", "pair", "equality", "tendon", "texture", "default",
];

/// Actuators of MJCF, which share one set of defaults.
pub(crate) const ACTUATORS: [&str; 12] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "orientation",
    "pid",
    "dcmotor",
];

/// Classes of a model.
pub(crate) struct Classes<'t> {
    names: BTreeMap<String, usize>,
    parents: Vec<Option<usize>>,
    /// Elements of each.
    elements: Vec<Vec<Element<'t>>>,
    /// Cached answers. Without them, a model with many elements and many defaults would take long.
    answers: RefCell<BTreeMap<Question<'t>, Option<Answer<'t>>>>,
}

/// A class, a kind of element and an attribute.
type Question<'t> = (usize, &'t str, &'static str);

/// Default with an attribute, after its class and its place there. The larger of two comes first.
type Answer<'t> = ((usize, usize), Element<'t>);

/// An element with the class that completes it.
#[derive(Clone, Copy)]
pub(crate) struct Classed<'t, 'c> {
    pub(crate) element: Element<'t>,
    classes: &'c Classes<'t>,
    class: usize,
}

impl<'t> Classes<'t> {
    /// Reads the classes in the `default` elements of the model.
    ///
    /// There may be no more than `most` elements in them: each question is asked of them one after the other, once.
    pub(crate) fn from_model(model: Element<'t>, most: usize) -> Result<Self, ReadError> {
        let names = BTreeMap::from([("main".to_owned(), 0)]);
        let mut classes = Self { names, parents: vec![None], elements: vec![Vec::new()], answers: RefCell::default() };
        let mut waiting: Vec<(Element<'t>, Option<usize>)> =
            model.all("default").map(|element| (element, None)).collect();
        waiting.reverse();
        let mut count = 0;
        while let Some((element, parent)) = waiting.pop() {
            let name = element.attribute("class");
            let class = match (name, parent) {
                (None, None) => 0,
                (None, Some(_)) => return Err(element.missing("class")),
                // The outermost class may be called something else than main.
                (Some(name), None) => {
                    classes.names.insert(name.to_owned(), 0);
                    0
                }
                (Some(name), Some(parent)) => {
                    let next = classes.parents.len();
                    let class = *classes.names.entry(name.to_owned()).or_insert(next);
                    if class == next {
                        classes.parents.push(Some(parent));
                        classes.elements.push(Vec::new());
                    }
                    class
                }
            };
            let nested: Vec<_> = element.all("default").map(|nested| (nested, Some(class))).collect();
            waiting.extend(nested.into_iter().rev());
            for child in element.children().filter(|child| child.tag() != "default") {
                if !DEFAULTS.contains(&child.tag()) && !ACTUATORS.contains(&child.tag()) {
                    return Err(child.unknown(
                        "element of default",
                        child.tag(),
                        DEFAULTS.into_iter().chain(ACTUATORS),
                    ));
                }
                classes.elements[class].push(child);
                count += 1;
                if count > most {
                    return Err(ReadError::TooMuch { place: child.place(), what: "defaults", limit: most });
                }
            }
        }
        Ok(classes)
    }

    /// All elements that give defaults.
    pub(crate) fn elements(&self) -> impl Iterator<Item = Element<'t>> + '_ {
        self.elements.iter().flatten().copied()
    }

    /// Returns the class with a name in an element.
    pub(crate) fn find(&self, element: Element<'t>, name: &str) -> Result<usize, ReadError> {
        let known = self.names.get(name).copied();
        known.ok_or_else(|| element.unknown("class", name, self.names.keys().map(String::as_str)))
    }

    /// Finds the default with an attribute for a kind of element. It is that of the nearest class, and in this class
    /// the last one, which overrides earlier ones.
    fn answer(&self, class: usize, tag: &'t str, attribute: &'static str) -> Option<Answer<'t>> {
        let kind = kind(tag);
        let mut answers = self.answers.borrow_mut();
        let (mut answer, mut unasked, mut next) = (None, Vec::new(), Some(class));
        while let Some(current) = next {
            if let Some(known) = answers.get(&(current, kind, attribute)) {
                answer = *known;
                break;
            }
            unasked.push(current);
            next = self.parents[current];
        }
        // Back from the outermost class. A class follows its enclosing class.
        for current in unasked.into_iter().rev() {
            let says =
                |element: &Element<'t>| kind == self::kind(element.tag()) && element.attribute(attribute).is_some();
            if let Some(place) = self.elements[current].iter().rposition(says) {
                answer = Some(((current, place), self.elements[current][place]));
            }
            answers.insert((current, kind, attribute), answer);
        }
        answer
    }

    /// An element with its own class, or that which its body gives to it.
    pub(crate) fn with<'c>(&'c self, element: Element<'t>, inherited: usize) -> Result<Classed<'t, 'c>, ReadError> {
        let class = element.attribute("class").map_or(Ok(inherited), |name| self.find(element, name))?;
        Ok(Classed { element, classes: self, class })
    }
}

/// Returns the tag under which an element's defaults are listed.
fn kind(tag: &str) -> &str {
    if ACTUATORS.contains(&tag) { ACTUATORS[0] } else { tag }
}

impl<'t> Classed<'t, '_> {
    /// Finds the element or default with the attribute: the element itself, else the nearest class.
    pub(crate) fn source(&self, attribute: &'static str) -> Option<Element<'t>> {
        self.source_of(&[attribute])
    }

    /// Finds the nearest one with any of the attributes.
    pub(crate) fn source_of(&self, attributes: &[&'static str]) -> Option<Element<'t>> {
        if attributes.iter().any(|name| self.element.attribute(name).is_some()) {
            return Some(self.element);
        }
        let answers = attributes.iter().filter_map(|name| self.classes.answer(self.class, self.element.tag(), name));
        answers.max_by_key(|(nearness, _)| *nearness).map(|(_, element)| element)
    }

    pub(crate) fn text(&self, attribute: &'static str) -> Option<&'t str> {
        self.source(attribute)?.attribute(attribute)
    }

    pub(crate) fn number(&self, attribute: &'static str) -> Result<Option<f64>, ReadError> {
        self.source(attribute).map_or(Ok(None), |element| element.number(attribute))
    }

    pub(crate) fn not_negative(&self, attribute: &'static str) -> Result<Option<f64>, ReadError> {
        let number = self.number(attribute)?;
        match (number, self.source(attribute)) {
            (Some(value), Some(source)) if value < 0.0 => {
                let text = source.attribute(attribute).unwrap_or_default();
                Err(source.wrong(attribute, text, "but must not be negative"))
            }
            _ => Ok(number),
        }
    }

    pub(crate) fn array<const N: usize>(&self, attribute: &'static str) -> Result<Option<[f64; N]>, ReadError> {
        self.source(attribute).map_or(Ok(None), |element| element.array(attribute))
    }

    pub(crate) fn list(
        &self,
        attribute: &'static str,
        least: usize,
        most: usize,
    ) -> Result<Option<Vec<f64>>, ReadError> {
        self.source(attribute).map_or(Ok(None), |element| element.list(attribute, least, most))
    }

    pub(crate) fn word(
        &self,
        attribute: &'static str,
        valid: &[&'static str],
    ) -> Result<Option<&'static str>, ReadError> {
        self.source(attribute).map_or(Ok(None), |element| element.word(attribute, valid))
    }

    /// Checks whether a range applies: by the attribute `limited`, else if there is a range and ranges apply by
    /// default.
    pub(crate) fn limited(
        &self,
        limited: &'static str,
        range: &'static str,
        automatic: bool,
    ) -> Result<bool, ReadError> {
        Ok(match self.word(limited, &["true", "false", "auto"])? {
            Some("true") => true,
            Some("false") => false,
            _ => automatic && self.source(range).is_some(),
        })
    }
}
