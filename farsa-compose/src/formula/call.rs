//! Quantities of formulas as measures of terms, with the keys of the schema as arguments.

use serde_json::{Map, Value as Json};

use crate::check::schema::{Kind, Part};
use crate::document::RewardKind;
use crate::formula::nodes::{Argument, Call, Fault, Number, Value};
use crate::formula::unit::Unit;
use crate::formula::unknown;

/// Kinds of terms that are no quantities.
const NO_QUANTITIES: [&str; 2] = ["formula", "steps"];
/// Keys for the measured part of a robot, which come first.
const SUBJECTS: [&str; 2] = ["body", "bodies"];
/// Name of the robot that a term measures.
const ROBOT: &str = "robot";

/// Measures of terms that formulas can contain.
pub(crate) struct Measures<'s>(Vec<Measure<'s>>);

/// A measure with its keys and units: one, or one for hinges and one for rails.
struct Measure<'s> {
    name: &'s str,
    units: Vec<Unit>,
    /// Keys, the required ones first, because positional arguments fill them first.
    fields: Vec<Field<'s>>,
}

/// A key of a measure.
#[derive(Clone)]
struct Field<'s> {
    name: &'s str,
    part: Part<'s>,
    required: bool,
    value: Option<Json>,
}

impl Field<'_> {
    /// Checks if the key is without a value and has this type.
    fn is_free(&self, kind: Kind) -> bool {
        self.value.is_none() && self.part.kind() == kind
    }

    /// Checks if the key is a list of this type without a value.
    fn is_free_list(&self, kind: Kind) -> bool {
        self.is_free(Kind::List) && self.part.items().is_some_and(|items| items.kind() == kind)
    }

    fn is_subject(&self) -> bool {
        SUBJECTS.contains(&self.name)
    }
}

impl<'s> Measures<'s> {
    /// Reads the kinds of terms from a schema.
    pub(crate) fn new(schema: &'s Json) -> Self {
        let keys = Part::root(schema).map(|root| root.keys(&|_| None)).unwrap_or_default();
        let reward = keys.named.iter().find(|(name, _)| *name == "reward");
        let Some(terms) = reward.and_then(|(_, part)| part.items()) else { return Self(Vec::new()) };
        let common = terms.keys(&|_| None);
        let names = common.tag.as_ref().map_or(&[][..], |(_, words)| words);
        let measure = |name: &&'s str| {
            let keys = terms.keys(&|tag| (tag == "kind").then_some(*name));
            let is_common = |name: &str| name == "kind" || common.named.iter().any(|(known, _)| *known == name);
            let own = keys.named.iter().filter(|(name, _)| !is_common(name));
            let field = |(name, part): &(&'s str, Part<'s>)| {
                let required = keys.required.contains(name);
                Field { name, part: *part, required, value: None }
            };
            let mut fields: Vec<Field<'s>> = own.map(field).collect();
            fields.sort_by_key(|field| !field.required);
            Measure { name, units: units_of(terms.branch(name).map_or("", Part::description)), fields }
        };
        Self(names.iter().filter(|name| !NO_QUANTITIES.contains(name)).map(measure).collect())
    }

    /// Lists the names of measures.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'s str> + '_ {
        self.0.iter().map(|measure| measure.name)
    }

    fn named(&self, name: &str) -> Option<&Measure<'s>> {
        self.0.iter().find(|measure| measure.name == name)
    }

    /// Checks if a name is that of a measure.
    pub(crate) fn contains(&self, name: &str) -> bool {
        self.named(name).is_some()
    }

    /// Returns the units of a measure: one, or one for hinges and one for rails.
    pub(crate) fn units(&self, name: &str) -> &[Unit] {
        self.named(name).map_or(&[], |measure| &measure.units)
    }

    /// Reads the measure of a call at a byte of the formula, with the name that it is about if no key takes it.
    pub(crate) fn read(&self, call: &Call, offset: usize) -> Result<(RewardKind, Option<String>), Fault> {
        let fault = |offset: usize, why: String| Fault { offset, why };
        let Some(Measure { name, fields, .. }) = self.named(&call.name) else {
            return Err(fault(offset, unknown("quantity", &call.name, self.names())));
        };
        let mut fields = fields.clone();
        let arguments = call.arguments.as_deref().unwrap_or_default();
        for argument in arguments {
            let Some(key) = &argument.key else { continue };
            let Some(field) = fields.iter_mut().find(|field| field.name == key) else {
                let names: Vec<&str> = fields.iter().map(|field| field.name).collect();
                return Err(fault(argument.offset, unknown("key", key, names)));
            };
            if field.value.is_some() {
                return Err(fault(argument.offset, format!("`{key}` is given twice")));
            }
            field.value = Some(json(field.part, argument)?);
        }
        let subject = place(&mut fields, arguments)?;
        let mut table = Map::new();
        table.insert("kind".into(), (*name).into());
        for field in fields {
            match field.value {
                Some(value) => drop(table.insert(field.name.into(), value)),
                None if field.required => {
                    return Err(fault(offset, format!("`{name}` lacks its argument `{}`", field.name)));
                }
                None => {}
            }
        }
        let kind = serde_json::from_value(Json::Object(table)).map_err(|error| fault(offset, error.to_string()))?;
        Ok((kind, subject))
    }
}

/// Assigns the arguments without keys by their types: a part of the robot, then names, numbers and lists. Returns the
/// name of the part if no key takes it.
fn place(fields: &mut [Field<'_>], arguments: &[Argument]) -> Result<Option<String>, Fault> {
    let is_name = |argument: &&Argument| matches!(argument.value, Value::Name(_));
    let positional: Vec<&Argument> = arguments.iter().filter(|argument| argument.key.is_none()).collect();
    let names = positional.iter().copied().filter(is_name).count();
    let wanted = fields.iter().filter(|field| field.required && field.is_free(Kind::Text)).count();
    let (mut first, mut outer) = (names > wanted, None);
    for argument in positional {
        let of_subject = std::mem::take(&mut first) && is_name(&argument);
        if of_subject && argument.value == Value::Name(ROBOT.into()) {
            continue;
        }
        if let (true, Value::Name(name)) = (of_subject, &argument.value)
            && !fields.iter().any(|field| field.is_subject() || field.is_free_list(Kind::Text))
        {
            outer = Some(name.clone());
            continue;
        }
        let place = match &argument.value {
            Value::Name(_) => {
                let subject = |field: &Field<'_>| field.is_subject() && field.value.is_none();
                let text = |field: &Field<'_>| field.is_free(Kind::Text) && !field.is_subject();
                let subject = fields.iter().position(subject).filter(|_| of_subject);
                subject
                    .or_else(|| fields.iter().position(text))
                    .or_else(|| fields.iter().position(|field| field.is_free_list(Kind::Text) && !field.is_subject()))
            }
            Value::Number(_) => fields.iter().position(|field| field.is_free(Kind::Number)),
            Value::List(items) => {
                let kind = if matches!(items[..], [Value::Name(_), ..]) { Kind::Text } else { Kind::Number };
                fields.iter().position(|field| field.is_free_list(kind))
            }
        };
        let Some(place) = place else {
            let why = "there is no such argument here; write it as `key = value`".to_owned();
            return Err(Fault { offset: argument.offset, why });
        };
        let field = &mut fields[place];
        field.value = Some(json(field.part, argument)?);
    }
    Ok(outer)
}

/// Returns an argument as the value of a key.
fn json(part: Part<'_>, argument: &Argument) -> Result<Json, Fault> {
    let fault = |why: String| Fault { offset: argument.offset, why };
    let units = units_of(part.description());
    let item = |part: Part<'_>, value: &Value| match (part.kind(), value) {
        (Kind::Text, Value::Name(name)) => Ok(Json::from(name.as_str())),
        (Kind::Number, Value::Number(number)) => checked(part, *number, &units).map_err(fault),
        (Kind::Text, _) => Err(fault("a name is needed here".into())),
        _ => Err(fault("a number is needed here".into())),
    };
    let (Kind::List, Some(items)) = (part.kind(), part.items()) else { return item(part, &argument.value) };
    let values = match &argument.value {
        Value::List(values) => values.iter().map(|value| item(items, value)).collect::<Result<Vec<_>, _>>()?,
        // A single name is a list of one.
        value => vec![item(items, value)?],
    };
    let [least, most] = part.lengths();
    let count = values.len() as u64;
    if least.is_some_and(|least| count < least) || most.is_some_and(|most| count > most) {
        let most = most.map_or_else(String::new, |most| format!(", {most} are needed"));
        return Err(fault(format!("the list has {count} values{most}")));
    }
    Ok(Json::Array(values))
}

/// Checks a number against the range and the unit of its key.
fn checked(part: Part<'_>, number: Number, units: &[Unit]) -> Result<Json, String> {
    let Number { value, unit } = number;
    if let Some(unit) = unit.filter(|unit| !units.contains(unit)) {
        let units: Vec<String> = units.iter().map(Unit::to_string).collect();
        return Err(format!("{unit} is where {} is needed", units.join(" or ")));
    }
    let [least, most] = part.range();
    let (least, most) = (least.unwrap_or(f64::MIN), most.unwrap_or(f64::MAX));
    if (least..=most).contains(&value) {
        Ok(value.into())
    } else {
        Err(format!("{value} is outside {least} to {most}"))
    }
}

/// Returns the units in the brackets of a description, in its order.
fn units_of(description: &str) -> Vec<Unit> {
    let inner = description.split_once(" [").and_then(|(_, rest)| rest.split_once(']'));
    let units = inner.map(|(units, _)| units.split(" or ").filter_map(|unit| Some(Unit::parse(unit)?.0)).collect());
    units.unwrap_or_else(|| vec![Unit::NONE])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema;

    /// A term with an unreadable unit would have none in formulas.
    #[test]
    fn each_unit_of_a_term_is_read() {
        let (mut with_units, schema) = (0, schema());
        let measures = Measures::new(&schema);
        for Measure { name, units, .. } in &measures.0 {
            let about = Part::root(&schema).unwrap().about("reward", name);
            let written = about.split_once(" [").and_then(|(_, rest)| rest.split_once(']'));
            let count = written.map_or(1, |(units, _)| units.split(" or ").count());
            assert_eq!(units.len(), count, "{name}: {about}");
            with_units += usize::from(written.is_some());
        }
        assert!(with_units > 12, "{with_units}");
        let text = |name: &str| measures.units(name).iter().map(Unit::to_string).collect::<Vec<_>>().join(" or ");
        assert_eq!(
            ["distance", "speed", "joint-speed", "angle", "near"].map(text),
            ["m", "m/s", "rad/s or m/s", "rad", "no unit"]
        );
    }

    /// Names of functions are no names of terms.
    #[test]
    fn no_term_has_the_name_of_a_function() {
        let schema = schema();
        let measures = Measures::new(&schema);
        for (name, _) in crate::formula::nodes::FUNCTIONS {
            assert!(!measures.contains(name), "{name}");
        }
    }
}
