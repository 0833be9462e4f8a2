//! A model's elements as a tree, included files in their places, and how to ask them for names and numbers.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use roxmltree::{Document, ParsingOptions};

use crate::context::Context;
use crate::error::{ReadError, SourceLocation, nearest, repeated};
use crate::files::NamedFile;
use crate::warnings::Warnings;
use crate::xml::check::check;

/// Elements of a model, the root first.
pub(crate) struct Tree {
    files: Vec<String>,
    /// Folders of the files. The model's own is `None`.
    folders: Vec<Option<PathBuf>>,
    nodes: Vec<Node>,
}

struct Node {
    tag: String,
    attributes: Vec<(String, String)>,
    children: Vec<usize>,
    file: usize,
    line: usize,
    reading: Reading,
}

/// Record of the parts of an element that were read.
#[derive(Default)]
struct Reading {
    state: Cell<State>,
    /// A bit for each of the first 128 attributes.
    attributes: Cell<u128>,
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum State {
    #[default]
    Unread,
    /// Its attributes were compared with those of the format.
    Checked,
    /// Left out with its content, with a warning if this changes the robot.
    Left,
}

/// One element.
#[derive(Clone, Copy)]
pub(crate) struct Element<'t> {
    tree: &'t Tree,
    index: usize,
}

impl Tree {
    /// Parses a model and, if it is MJCF, the files that it includes.
    pub(crate) fn parse(file: &str, text: &str, context: &mut Context<'_>) -> Result<Self, ReadError> {
        let mut tree = Self { files: Vec::new(), folders: Vec::new(), nodes: Vec::new() };
        let root = tree.add(file, None, text, context)?;
        let mut included: Vec<(PathBuf, usize)> = Vec::new();
        if tree.nodes[root].tag == "mujoco" {
            tree.include(root, context, &mut included)?;
        }
        Ok(tree)
    }

    /// Appends the elements of a text and returns the root's index.
    fn add(
        &mut self,
        file: &str,
        folder: Option<&Path>,
        text: &str,
        context: &mut Context<'_>,
    ) -> Result<usize, ReadError> {
        let limits = &context.options.limits;
        check(file, text, &mut context.elements, limits)?;
        // Elements have been counted. The rest are comments and the text between them.
        let nodes_limit = u32::try_from(limits.elements.saturating_mul(8)).unwrap_or(u32::MAX);
        let options = ParsingOptions { nodes_limit, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options).map_err(|error| {
            let place = SourceLocation { file: file.into(), line: error.pos().row as usize };
            // The parser's message contains its own place, which ours already has.
            let why = error.to_string().replace(&format!(" at {}", error.pos()), "");
            ReadError::Malformed { place, why }
        })?;
        let starts: Vec<usize> = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i).collect();
        let line = |at: usize| 1 + starts.partition_point(|start| *start < at);
        let number = self.files.len();
        self.files.push(file.into());
        self.folders.push(folder.map(Path::to_owned));
        let root = self.nodes.len();
        let space = document.root_element().tag_name().namespace();
        // Document order: parents come before their children.
        let mut index = vec![0; document.descendants().count() + 1];
        for node in document.descendants().filter(roxmltree::Node::is_element) {
            let name = node.tag_name();
            let prefixed = |space: Option<&str>, name: &str| match space.map(|uri| node.lookup_prefix(uri)) {
                None => name.to_owned(),
                Some(_) if space.is_some_and(|uri| uri.contains("xacro")) => format!("xacro:{name}"),
                Some(prefix) => format!("{}:{name}", prefix.unwrap_or("other")),
            };
            let tag = prefixed(name.namespace().filter(|own| Some(*own) != space), name.name());
            let attributes = node.attributes().map(|a| (prefixed(a.namespace(), a.name()), a.value().to_owned()));
            let own = self.nodes.len();
            self.nodes.push(Node {
                tag,
                attributes: attributes.collect(),
                children: Vec::new(),
                file: number,
                line: line(node.range().start),
                reading: Reading::default(),
            });
            index[node.id().get_usize()] = own;
            if let Some(parent) = node.parent().filter(roxmltree::Node::is_element) {
                self.nodes[index[parent.id().get_usize()]].children.push(own);
            }
        }
        Ok(root)
    }

    /// Puts the content of included files in the places of the `include` elements below `from`.
    fn include(
        &mut self,
        from: usize,
        context: &mut Context<'_>,
        included: &mut Vec<(PathBuf, usize)>,
    ) -> Result<(), ReadError> {
        let mut open = vec![from];
        while let Some(parent) = open.pop() {
            let mut children = Vec::new();
            let mut waiting: Vec<usize> = self.nodes[parent].children.iter().rev().copied().collect();
            while let Some(child) = waiting.pop() {
                if self.nodes[child].tag != "include" {
                    children.push(child);
                    continue;
                }
                let element = self.element(child);
                let place = element.place();
                element.check(&["file"], &[], &mut context.warnings)?;
                let file = element.needed("file")?.to_owned();
                let named = NamedFile { name: &file, assets: "", folder: element.folder() };
                let (path, text) = context.files.text(&place, &named)?;
                if let Some((_, line)) = included.iter().find(|(other, _)| *other == path) {
                    return Err(repeated(place, "include of", &file, *line));
                }
                let root = self.add(&context.files.label(&path), path.parent(), &text, context)?;
                included.push((path, place.line));
                let element = self.element(root);
                if !["mujoco", "mujocoinclude"].contains(&element.tag()) {
                    return Err(element.unknown("root of an included file", element.tag(), ["mujocoinclude"]));
                }
                waiting.extend(self.nodes[root].children.iter().rev());
            }
            open.extend(children.iter());
            self.nodes[parent].children = children;
        }
        Ok(())
    }

    fn element(&self, index: usize) -> Element<'_> {
        Element { tree: self, index }
    }

    /// Checks whether the model includes other files.
    pub(crate) fn has_includes(&self) -> bool {
        self.files.len() > 1
    }

    /// Gets the model's element.
    pub(crate) fn root(&self) -> Element<'_> {
        self.element(0)
    }
}

impl<'t> Element<'t> {
    fn node(&self) -> &'t Node {
        &self.tree.nodes[self.index]
    }

    pub(crate) fn tag(&self) -> &'t str {
        &self.node().tag
    }

    pub(crate) fn place(&self) -> SourceLocation {
        SourceLocation { file: self.tree.files[self.node().file].clone(), line: self.node().line }
    }

    /// Folder of the included file that contains the element, `None` for the model itself.
    pub(crate) fn folder(&self) -> Option<&'t Path> {
        self.tree.folders[self.node().file].as_deref()
    }

    /// Index of the element in its tree.
    pub(crate) fn index(&self) -> usize {
        self.index
    }

    pub(crate) fn attributes(&self) -> &'t [(String, String)] {
        &self.node().attributes
    }

    pub(crate) fn children(&self) -> impl Iterator<Item = Self> + use<'t> {
        let tree = self.tree;
        self.node().children.iter().map(move |index| Self { tree, index: *index })
    }

    /// Iterates over the children with this tag.
    pub(crate) fn all(&self, tag: &'t str) -> impl Iterator<Item = Self> + use<'t> {
        self.children().filter(move |child| child.tag() == tag)
    }

    /// Gets the child with this tag, of which there may be one.
    pub(crate) fn one(&self, tag: &'t str) -> Result<Option<Self>, ReadError> {
        let mut elements = self.all(tag);
        let first = elements.next();
        match (first, elements.next()) {
            (Some(first), Some(second)) => Err(self.second(tag, second.place(), first.node().line)),
            _ => Ok(first),
        }
    }

    pub(crate) fn attribute(&self, name: &str) -> Option<&'t str> {
        let mut attributes = self.node().attributes.iter().enumerate();
        let (number, (_, value)) = attributes.find(|(_, (attribute, _))| attribute == name)?;
        self.mark(number);
        Some(value.as_str())
    }

    /// Checks whether the element has an attribute, without reading it.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.node().attributes.iter().any(|(attribute, _)| attribute == name)
    }

    fn mark(&self, number: usize) {
        let read = &self.node().reading.attributes;
        read.set(read.get() | 1_u128.checked_shl(number as u32).unwrap_or(0));
    }

    /// Marks attributes as read that have no effect in the format either.
    pub(crate) fn skip(&self, names: &[&str]) {
        for name in names {
            self.attribute(name);
        }
    }

    /// Marks the element as left out. Nothing in it is unread.
    pub(crate) fn leave(&self) {
        self.node().reading.state.set(State::Left);
    }

    /// Warns of each attribute and element within that nothing has read. `named` excludes elements and attributes.
    pub(crate) fn list_unread(self, named: &[&str], warnings: &mut Warnings) {
        let mut open = vec![self];
        while let Some(element) = open.pop() {
            for (number, (name, _)) in element.node().attributes.iter().enumerate().take(128) {
                let read = element.node().reading.attributes.get() >> number & 1 == 1;
                if !read && !named.contains(&name.as_str()) {
                    warnings.add(element.place(), format!("{} `{name}`", element.tag()), "has no effect here");
                }
            }
            for child in element.children().filter(|child| !named.contains(&child.tag())) {
                match child.node().reading.state.get() {
                    State::Unread => {
                        warnings.add(child.place(), child.tag(), format!("is not read in {}", element.tag()));
                    }
                    State::Checked => open.push(child),
                    State::Left => {}
                }
            }
        }
    }

    /// Gets the value of an attribute that must be there.
    pub(crate) fn needed(&self, name: &str) -> Result<&'t str, ReadError> {
        self.attribute(name).ok_or_else(|| self.missing(name))
    }

    /// Formats the element's name for messages.
    pub(crate) fn label(&self) -> String {
        match self.attribute("name") {
            Some(name) => format!("{} `{name}`", self.tag()),
            None => self.tag().to_owned(),
        }
    }

    /// The error of a second part `what` of the element.
    pub(crate) fn second(&self, what: &str, place: SourceLocation, first: usize) -> ReadError {
        match self.attribute("name") {
            Some(name) => repeated(place, &format!("{what} of {}", self.tag()), name, first),
            None => repeated(place, &format!("{what} of"), self.tag(), first),
        }
    }

    pub(crate) fn missing(&self, what: &str) -> ReadError {
        ReadError::Malformed { place: self.place(), why: format!("{} has no {what}", self.label()) }
    }

    pub(crate) fn unsupported(&self, why: impl Into<String>) -> ReadError {
        ReadError::Unsupported { place: self.place(), element: self.label(), why: why.into() }
    }

    pub(crate) fn wrong(&self, attribute: &'static str, value: &str, why: impl Into<String>) -> ReadError {
        let (element, why) = (self.label(), why.into());
        ReadError::Malformed { place: self.place(), why: format!("{element}: {attribute} is {value:?}, {why}") }
    }

    pub(crate) fn unknown<'a>(
        &self,
        what: impl Into<String>,
        name: &str,
        valid: impl IntoIterator<Item = &'a str>,
    ) -> ReadError {
        let nearest =
            nearest(name, valid).map_or("there is none".into(), |(nearest, _)| format!("the nearest is `{nearest}`"));
        let why = format!("unknown {} `{name}`; {nearest}", what.into());
        ReadError::Malformed { place: self.place(), why }
    }

    /// Refuses attributes that the format does not have and warns of those that are not read, each with its reason.
    pub(crate) fn check(
        &self,
        read: &[&str],
        ignored: &[(&str, &str)],
        warnings: &mut Warnings,
    ) -> Result<(), ReadError> {
        self.node().reading.state.set(State::Checked);
        for (number, (name, _)) in self.node().attributes.iter().enumerate() {
            if read.contains(&name.as_str()) {
                continue;
            }
            if let Some((_, why)) = ignored.iter().find(|(other, _)| other.split(' ').any(|other| other == name)) {
                warnings.add(self.place(), format!("{} `{name}`", self.tag()), *why);
                self.mark(number);
                continue;
            }
            let valid = read.iter().copied().chain(ignored.iter().flat_map(|(names, _)| names.split(' ')));
            return Err(self.unknown(format!("attribute of {}", self.tag()), name, valid));
        }
        Ok(())
    }

    /// [`Element::check`] for formats that others extend: only what looks like a slip of the pen is refused.
    pub(crate) fn check_open(&self, read: &[&str], warnings: &mut Warnings) -> Result<(), ReadError> {
        for (name, _) in &self.node().attributes {
            if !read.contains(&name.as_str()) {
                if nearest(name, read.iter().copied()).is_some_and(|(_, distance)| slip(name, distance)) {
                    return Err(self.unknown(format!("attribute of {}", self.tag()), name, read.iter().copied()));
                }
                warnings.add(self.place(), format!("{} `{name}`", self.tag()), "is no attribute of the format");
            }
        }
        Ok(())
    }

    /// Checks the elements within.
    pub(crate) fn check_children(
        &self,
        read: &[&str],
        ignored: &[(&str, &str)],
        warnings: &mut Warnings,
    ) -> Result<(), ReadError> {
        self.node().reading.state.set(State::Checked);
        for child in self.children() {
            let tag = child.tag();
            if read.contains(&tag) {
                continue;
            }
            child.leave();
            if let Some((_, why)) = ignored.iter().find(|(names, _)| names.split(' ').any(|other| other == tag)) {
                warnings.add(child.place(), tag, *why);
                continue;
            }
            let valid = read.iter().copied().chain(ignored.iter().flat_map(|(names, _)| names.split(' ')));
            if nearest(tag, valid.clone()).is_some_and(|(_, distance)| slip(tag, distance)) {
                return Err(child.unknown(format!("element of {}", self.tag()), tag, valid));
            }
            warnings.add(child.place(), tag, format!("is no element of {} in the format", self.tag()));
        }
        Ok(())
    }

    /// Gets the numbers of an attribute, at least `least` and at most `most`.
    pub(crate) fn list(&self, name: &'static str, least: usize, most: usize) -> Result<Option<Vec<f64>>, ReadError> {
        self.attribute(name).map(|text| self.parsed(name, text, least, most)).transpose()
    }

    fn parsed(&self, name: &'static str, text: &str, least: usize, most: usize) -> Result<Vec<f64>, ReadError> {
        let mut numbers = Vec::new();
        for word in text.split_whitespace() {
            let number = word.parse::<f64>().ok().filter(|number| !number.is_nan());
            numbers.push(number.ok_or_else(|| self.wrong(name, text, "but must be of numbers"))?);
            if numbers.len() > most {
                break;
            }
        }
        if (least..=most).contains(&numbers.len()) {
            return Ok(numbers);
        }
        let wanted = if least == most { least.to_string() } else { format!("{least} to {most}") };
        Err(self.wrong(name, text, format!("but must be {wanted} numbers")))
    }

    /// Returns exactly `N` finite numbers of an attribute.
    pub(crate) fn array<const N: usize>(&self, name: &'static str) -> Result<Option<[f64; N]>, ReadError> {
        let Some(list) = self.list(name, N, N)? else { return Ok(None) };
        let mut array = [0.0; N];
        for (to, from) in array.iter_mut().zip(list) {
            if !from.is_finite() {
                return Err(self.wrong(name, self.attribute(name).unwrap_or_default(), "but must be finite"));
            }
            *to = from;
        }
        Ok(Some(array))
    }

    /// Gets the finite number of an attribute.
    pub(crate) fn number(&self, name: &'static str) -> Result<Option<f64>, ReadError> {
        Ok(self.array::<1>(name)?.map(|[number]| number))
    }

    /// One of some words.
    pub(crate) fn word(&self, name: &'static str, valid: &[&'static str]) -> Result<Option<&'static str>, ReadError> {
        let Some(text) = self.attribute(name) else { return Ok(None) };
        let found = valid.iter().find(|word| **word == text);
        found.map(|word| Some(*word)).ok_or_else(|| self.unknown(name, text, valid.iter().copied()))
    }
}

/// Checks whether a name that is so far from a valid one is likely meant to be it.
fn slip(name: &str, distance: usize) -> bool {
    distance <= 2 && name.chars().count() > 2 * distance
}
