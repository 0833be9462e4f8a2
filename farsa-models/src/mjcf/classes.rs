//! MJCF's classes of defaults, and the lookup of missing attributes.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::bounds::effort_from_file;
use crate::error::ReadError;
use crate::warnings::Warnings;
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

/// Classes of a model. A class follows its parent.
pub(crate) struct Classes<'t> {
    names: BTreeMap<String, usize>,
    parents: Vec<Option<usize>>,
    /// Elements of each.
    elements: Vec<Vec<Element<'t>>>,
    /// Outermost class, in the state in which the last section left it.
    main: usize,
    /// Cached answers. Without them, a model with many elements and many defaults would take long.
    answers: RefCell<BTreeMap<Question<'t>, Option<Answer<'t>>>>,
    lists: RefCell<BTreeMap<Question<'t>, Option<Vec<f64>>>>,
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
        let (parents, elements) = (vec![None], vec![Vec::new()]);
        let (answers, lists) = (RefCell::default(), RefCell::default());
        let mut classes = Self { names, parents, elements, main: 0, answers, lists };
        let mut waiting: Vec<(Element<'t>, Option<usize>)> =
            model.all("default").map(|element| (element, None)).collect();
        waiting.reverse();
        let mut count = 0;
        while let Some((element, parent)) = waiting.pop() {
            let class = classes.open(element, parent)?;
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

    /// Returns the class of a `default` element.
    fn open(&mut self, element: Element<'t>, parent: Option<usize>) -> Result<usize, ReadError> {
        let next = self.parents.len();
        let (class, parent) = match (element.attribute("class"), parent) {
            (None, Some(_)) => return Err(element.missing("class")),
            (Some(name), Some(parent)) => (*self.names.entry(name.to_owned()).or_insert(next), parent),
            (name, None) => {
                // A second section of the outermost class does not reach classes that have copied it already.
                let previous = self.main;
                let first = next == 1 && self.elements[previous].is_empty();
                let changes = element.children().any(|child| child.tag() != "default");
                self.main = if first || !changes { previous } else { next };
                for name in [Some("main"), name].into_iter().flatten() {
                    self.names.insert(name.to_owned(), self.main);
                }
                (self.main, previous)
            }
        };
        if class == next {
            self.parents.push(Some(parent));
            self.elements.push(Vec::new());
        }
        Ok(class)
    }

    /// Returns the class of elements without one.
    pub(crate) fn main(&self) -> usize {
        self.main
    }

    /// Iterates over the classes, each with its parent and its own elements.
    pub(crate) fn each(&self) -> impl Iterator<Item = (Option<usize>, &[Element<'t>])> {
        self.parents.iter().copied().zip(self.elements.iter().map(Vec::as_slice))
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
            let says = |element: &Element<'t>| kind == self::kind(element.tag()) && element.has(attribute);
            if let Some(place) = self.elements[current].iter().rposition(says) {
                answer = Some(((current, place), self.elements[current][place]));
            }
            answers.insert((current, kind, attribute), answer);
        }
        answer
    }

    /// Reads the numbers of an attribute in the defaults for a kind of element. A class overwrites the first numbers of
    /// its parent.
    fn list(
        &self,
        class: usize,
        tag: &'t str,
        attribute: &'static str,
        count: [usize; 2],
    ) -> Result<Option<Vec<f64>>, ReadError> {
        let kind = kind(tag);
        let mut lists = self.lists.borrow_mut();
        let (mut list, mut unread, mut next) = (None, Vec::new(), Some(class));
        while let Some(current) = next {
            if let Some(known) = lists.get(&(current, kind, attribute)) {
                list.clone_from(known);
                break;
            }
            unread.push(current);
            next = self.parents[current];
        }
        for current in unread.into_iter().rev() {
            for element in self.elements[current].iter().filter(|element| kind == self::kind(element.tag())) {
                list = overwritten(list, element.list(attribute, count[0], count[1])?);
            }
            lists.insert((current, kind, attribute), list.clone());
        }
        Ok(list)
    }

    /// An element with its own class, or that which its body gives to it.
    pub(crate) fn with<'c>(&'c self, element: Element<'t>, inherited: usize) -> Result<Classed<'t, 'c>, ReadError> {
        let class = element.attribute("class").map_or(Ok(inherited), |name| self.find(element, name))?;
        Ok(Classed { element, classes: self, class })
    }
}

/// Replaces the first numbers of a list by those of another.
fn overwritten(list: Option<Vec<f64>>, by: Option<Vec<f64>>) -> Option<Vec<f64>> {
    let Some(mut by) = by else { return list };
    by.extend(list.iter().flatten().skip(by.len()));
    Some(by)
}

/// Returns the tag under which an element's defaults are listed.
fn kind(tag: &str) -> &str {
    if ACTUATORS.contains(&tag) { ACTUATORS[0] } else { tag }
}

impl<'t> Classed<'t, '_> {
    /// Returns the class that completes the element.
    pub(crate) fn class(&self) -> usize {
        self.class
    }

    /// Finds the element or default with the attribute: the element itself, else the nearest class.
    pub(crate) fn source(&self, attribute: &'static str) -> Option<Element<'t>> {
        self.source_of(&[attribute])
    }

    /// Finds the nearest one with any of the attributes.
    pub(crate) fn source_of(&self, attributes: &[&'static str]) -> Option<Element<'t>> {
        if attributes.iter().any(|name| self.element.has(name)) {
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

    /// Gets the numbers of an attribute, `least` to `most`. Numbers that the element does not have are those of its class.
    pub(crate) fn list(
        &self,
        attribute: &'static str,
        least: usize,
        most: usize,
    ) -> Result<Option<Vec<f64>>, ReadError> {
        let Self { element, classes, class } = self;
        let defaults = classes.list(*class, element.tag(), attribute, [least, most])?;
        Ok(overwritten(defaults, element.list(attribute, least, most)?))
    }

    pub(crate) fn word(
        &self,
        attribute: &'static str,
        valid: &[&'static str],
    ) -> Result<Option<&'static str>, ReadError> {
        self.source(attribute).map_or(Ok(None), |element| element.word(attribute, valid))
    }

    /// Gets a range that applies, or `None` without a limit.
    ///
    /// MuJoCo 4.0: `limited` decides, which is "auto" by default. Then a range whose ends are equal or reversed is no
    /// limit, and any other is one, if `automatic` ("autolimits") permits it.
    pub(crate) fn limits(
        &self,
        limited: &'static str,
        range: &'static str,
        automatic: bool,
        warnings: &mut Warnings,
    ) -> Result<Option<[f64; 2]>, ReadError> {
        let Self { element, .. } = self;
        let word = self.word(limited, &["true", "false", "auto"])?.unwrap_or("auto");
        let given = self.list(range, 2, 2)?.map(|list| [list[0], list[1]]);
        let wrong = |why: String| {
            let source = self.source(range).unwrap_or(*element);
            source.wrong(range, source.attribute(range).unwrap_or_default(), why)
        };
        match (word, given) {
            ("false", _) | ("auto", None) => Ok(None),
            ("auto", Some([low, high])) if low == 0.0 && high == 0.0 => Ok(None),
            ("auto", Some(_)) if !automatic => {
                Err(wrong(format!("but `{limited}` is not given, and the compiler's `autolimits` is false")))
            }
            (_, None) => Err(element.missing(range)),
            (_, Some([low, high])) if low < high => Ok(Some([low, high])),
            ("auto", Some([low, high])) => {
                if low > high {
                    let what = format!("{} `{range}`", element.tag());
                    warnings.add(element.place(), what, "ends before it begins, which is no limit");
                }
                Ok(None)
            }
            _ => Err(wrong("but must end after it begins".into())),
        }
    }
    /// Gets the larger end of a range of efforts that applies.
    pub(crate) fn largest(
        &self,
        limited: &'static str,
        range: &'static str,
        automatic: bool,
        warnings: &mut Warnings,
    ) -> Result<Option<f64>, ReadError> {
        let Some([low, high]) = self.limits(limited, range, automatic, warnings)? else { return Ok(None) };
        if low != -high {
            let why = "efforts are limited alike in both directions, by the larger end";
            warnings.add(self.element.place(), format!("{} `{range}`", self.element.tag()), why);
        }
        Ok(Some(effort_from_file(low.abs().max(high.abs()))))
    }
}
