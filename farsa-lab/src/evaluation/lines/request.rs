//! Requests: the content of an input line.

use serde::Deserialize;
use serde_json::value::RawValue;

use crate::error::Error;
use crate::escaped::{OneLine, Quoted, shortened};
use crate::evaluation::lines::parameter_vectors::{ParameterVectors, Vectors};
use crate::experiment::genotype::Genotype;
use crate::experiment::parameter::Parameter;
use crate::limits::Limits;
use crate::run::plan::MAX_SEED;

/// Largest number of an individual.
const MAX_INDIVIDUAL: u32 = 1_000_000_000;

/// Shape of valid requests.
pub(crate) struct RequestSchema {
    pub(crate) experiment: &'static str,
    /// Names of the populations, in their order.
    pub(crate) populations: Vec<String>,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) genotype: Genotype,
    /// Individuals of each of several populations. 0 for a single population, which has no limit.
    pub(crate) size: usize,
    /// Seed of lines without one.
    pub(crate) seed: u64,
    pub(crate) limits: Limits,
}

/// A line before validation.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line<'l> {
    #[serde(borrow)]
    id: Option<&'l RawValue>,
    seed: Option<u64>,
    generation: Option<u32>,
    individual: Option<u32>,
    parameters: Option<ParameterVectors>,
    genes: Option<ParameterVectors>,
    evaluate: Option<Vec<String>>,
}

/// A valid request.
#[derive(Debug, PartialEq)]
pub(crate) struct Request {
    /// Id that the answer repeats.
    pub(crate) id: Option<serde_json::Value>,
    pub(crate) seed: u64,
    pub(crate) generation: u32,
    /// Number of the first individual of each population.
    pub(crate) individual: u32,
    /// Parameters of every individual of each population.
    pub(crate) parameters: Vec<Vec<Vec<f32>>>,
    /// Flag of each evaluated population. The others only serve as opponents.
    pub(crate) evaluated: Vec<bool>,
}

impl Request {
    /// Parses and validates a line.
    ///
    /// # Errors
    /// Returns the fault as text.
    pub(crate) fn from_line(bytes: &[u8], wanted: &RequestSchema) -> Result<Self, String> {
        let text = std::str::from_utf8(bytes).map_err(|error| format!("byte {}: is no UTF-8", error.valid_up_to()))?;
        if text.trim().is_empty() {
            return Err("is empty".into());
        }
        // Fields by position are not part of the format.
        if !text.trim_start().starts_with('{') {
            return Err("is no object of JSON, {..}".into());
        }
        let Line { id, seed, generation, individual, parameters, genes, evaluate } =
            serde_json::from_str(text).map_err(|error| unreadable(text, &error))?;
        let (what, given) = match (parameters, genes) {
            (Some(given), None) => ("parameters", given),
            (None, Some(given)) => ("genes", given),
            (None, None) => return Err("lacks `parameters` or `genes`".into()),
            (Some(_), Some(_)) => return Err("has `parameters` and `genes`: give one of them".into()),
        };
        let id = id.map(read_id).transpose()?;
        let seed = seed.unwrap_or(wanted.seed);
        if seed > MAX_SEED {
            return Err(format!("seed: {seed} is above {MAX_SEED}"));
        }
        let individual = individual.unwrap_or(0);
        if individual > MAX_INDIVIDUAL {
            return Err(format!("individual: {individual} is above {MAX_INDIVIDUAL}"));
        }
        let evaluated = wanted.evaluated(evaluate.as_deref())?;
        let mut rows = Vec::new();
        for (name, vectors) in wanted.populations.iter().zip(wanted.divided(what, given)?) {
            let label = if wanted.populations.len() > 1 { format!("{what} of {}", Quoted(name)) } else { what.into() };
            wanted.counted(vectors.len(), individual).map_err(|why| format!("{label}: {why}"))?;
            let decode = |(number, row): (usize, &[f64])| {
                let decoded = if what == "genes" { wanted.read_genes(row) } else { wanted.read_parameters(row) };
                decoded.map_err(|why| format!("{label}: vector {number}: {why}"))
            };
            rows.push(vectors.iter().enumerate().map(decode).collect::<Result<_, _>>()?);
        }
        Ok(Self { id, seed, generation: generation.unwrap_or(0), individual, parameters: rows, evaluated })
    }
}

/// Id that the answer repeats.
fn read_id(text: &RawValue) -> Result<serde_json::Value, String> {
    let text = text.get();
    serde_json::from_str(text).map_err(|error| format!("id: {error}"))
}

/// Why a text is no such line, with its column.
fn unreadable(text: &str, error: &serde_json::Error) -> String {
    let place = format!(" at line {} column {}", error.line(), error.column());
    let message = error.to_string();
    let why = OneLine(shortened(message.strip_suffix(&place).unwrap_or(&message)));
    let number = error.is_syntax() && (text.contains("NaN") || text.contains("Infinity"));
    let hint = if number { "; NaN and Infinity are no numbers" } else { "" };
    format!("column {}: {why}{hint}", error.column())
}

impl RequestSchema {
    /// Names of the evaluated populations.
    fn evaluated(&self, named: Option<&[String]>) -> Result<Vec<bool>, String> {
        let Some(named) = named else { return Ok(vec![true; self.populations.len()]) };
        if let Some(other) = named.iter().find(|name| !self.populations.contains(name)) {
            return Err(self.unknown("evaluate", other));
        }
        if named.is_empty() {
            return Err("evaluate: names no population".into());
        }
        Ok(self.populations.iter().map(|name| named.contains(name)).collect())
    }

    fn unknown(&self, place: &str, name: &str) -> String {
        Error::unknown(place, "population", name, self.populations.iter().map(String::as_str)).to_string()
    }

    /// Gets the vectors of each population, in their order.
    fn divided(&self, what: &str, given: ParameterVectors) -> Result<Vec<Vectors>, String> {
        let names = &self.populations;
        match given {
            ParameterVectors::Unnamed(vectors) if names.len() == 1 => Ok(vec![vectors]),
            ParameterVectors::Unnamed(_) => {
                let example = names.iter().map(|name| format!("{name:?}: [..]")).collect::<Vec<_>>().join(", ");
                Err(format!("{what}: {} has {} populations: {{{example}}}", self.experiment, names.len()))
            }
            ParameterVectors::Named(mut all) => {
                if let Some((other, _)) = all.iter().find(|(name, _)| !names.contains(name)) {
                    return Err(self.unknown(what, other));
                }
                let mut take = |name: &String| {
                    let place = all.iter().position(|(own, _)| own == name);
                    place.map(|place| all.swap_remove(place).1).ok_or_else(|| {
                        format!(
                            "{what}: lacks the population {}; those that are only met stand there, too",
                            Quoted(name)
                        )
                    })
                };
                names.iter().map(&mut take).collect()
            }
        }
    }

    /// Checks the number of vectors.
    fn counted(&self, count: usize, first: u32) -> Result<(), String> {
        match count {
            0 => Err("there is no vector".into()),
            count if count > self.limits.vectors => {
                Err(format!("{count} vectors, more than {} in a line", self.limits.vectors))
            }
            count if self.size > 0 && first as usize + count > self.size => Err(format!(
                "individuals {first} to {} of {}; evolution.population says how many there may be",
                first as usize + count - 1,
                self.size
            )),
            _ => Ok(()),
        }
    }

    fn length(&self, found: usize) -> Result<(), String> {
        let wanted = self.parameters.len();
        if found == wanted { Ok(()) } else { Err(format!("has {found} numbers where {wanted} are wanted")) }
    }

    /// Parameters within their ranges, rounded to single precision.
    fn read_parameters(&self, row: &[f64]) -> Result<Vec<f32>, String> {
        self.length(row.len())?;
        let value = |(place, (&x, Parameter { name, ends: [first, other] })): (usize, (&f64, &Parameter))| {
            let (rounded, low, high) = (x as f32, first.min(*other) as f32, first.max(*other) as f32);
            // A number that is not finite is outside, too.
            if low <= rounded && rounded <= high {
                return Ok(rounded);
            }
            let name = Quoted(name);
            Err(format!("number {place}, {name}, is {x:?}, outside {:?} to {:?}", first.min(*other), first.max(*other)))
        };
        row.iter().zip(&self.parameters).enumerate().map(value).collect()
    }

    /// Decodes real genes, with -1 and 1 at the ends of the ranges.
    fn read_genes(&self, row: &[f64]) -> Result<Vec<f32>, String> {
        self.length(row.len())?;
        self.genotype.decode_reals(row).ok_or_else(|| "has a number that is not finite".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanted(populations: &[&str], size: usize) -> RequestSchema {
        let parameters = vec![Parameter::new("gain", [-5.0, 5.0]), Parameter::new("bias", [1.0, 0.0])];
        let genotype = Genotype::new(&parameters, 16);
        let populations = populations.iter().map(|&name| name.into()).collect();
        RequestSchema { experiment: "toy", populations, parameters, genotype, size, seed: 4, limits: Limits::DEFAULT }
    }

    fn read(text: &str, wanted: &RequestSchema) -> Result<Request, String> {
        Request::from_line(text.as_bytes(), wanted)
    }

    #[test]
    fn a_line_has_parameters_or_genes() {
        let one = wanted(&["0"], 0);
        let found = read(r#"{"parameters": [2.5, 0.1]}"#, &one).unwrap();
        let rows = vec![vec![vec![2.5, 0.1]]];
        let expected =
            Request { id: None, seed: 4, generation: 0, individual: 0, parameters: rows, evaluated: vec![true] };
        assert_eq!(found, expected);
        let line = r#"{"id": {"a": [1]}, "seed": 9, "generation": 3, "individual": 7, "genes": [[-1, -1], [0, 1.5]]}"#;
        let found = read(line, &one).unwrap();
        assert_eq!(found.parameters, [[[-5.0, 1.0], [0.0, 0.25]]]);
        assert_eq!((found.seed, found.generation, found.individual), (9, 3, 7));
        assert_eq!(found.id, Some(serde_json::json!({"a": [1]})));
        // 0.1 in single precision is a little more than 0.1.
        let close = RequestSchema { parameters: vec![Parameter::new("x", [0.0, 0.1])], ..wanted(&["0"], 0) };
        assert_eq!(
            read(&format!(r#"{{"parameters": [{:?}]}}"#, f64::from(0.1_f32)), &close).unwrap().parameters[0][0],
            [0.1]
        );
    }

    #[test]
    fn populations_have_names() {
        let two = wanted(&["prey", "hunter"], 3);
        let line = r#"{"parameters": {"hunter": [[1, 0]], "prey": [[2, 0], [3, 1]]}, "evaluate": ["prey"]}"#;
        let found = read(line, &two).unwrap();
        assert_eq!(found.parameters, [vec![vec![2.0, 0.0], vec![3.0, 1.0]], vec![vec![1.0, 0.0]]]);
        assert_eq!(found.evaluated, [true, false]);
        for (line, why) in [
            (r#"{"parameters": [1, 0]}"#, r#"parameters: toy has 2 populations: {"prey": [..], "hunter": [..]}"#),
            (r#"{"parameters": {"prey": [1, 0]}}"#, "parameters: lacks the population `hunter`; those that"),
            (r#"{"genes": {"pray": [1, 0]}}"#, "genes: unknown population `pray`; the nearest is `prey`"),
            (
                r#"{"parameters": {"prey": [1, 0], "hunter": [[1, 0], [1]]}}"#,
                "parameters of `hunter`: vector 1: has 1 numbers where 2 are wanted",
            ),
            (
                r#"{"individual": 2, "genes": {"prey": [1, 0], "hunter": [[1, 0], [1, 0]]}}"#,
                "genes of `hunter`: individuals 2 to 3 of 3; evolution.population says",
            ),
            (
                r#"{"genes": {"prey": [1, 0], "hunter": [1, 0]}, "evaluate": ["huntr"]}"#,
                "evaluate: unknown population `huntr`; the nearest is `hunter`",
            ),
            (r#"{"genes": {"prey": [1, 0], "hunter": [1, 0]}, "evaluate": []}"#, "evaluate: names no population"),
        ] {
            let found = read(line, &two).unwrap_err();
            assert!(found.starts_with(why), "{line}: {found}");
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        let one = wanted(&["0"], 0);
        let many = format!(r#"{{"genes": [{}[0]]}}"#, "[0],".repeat(Limits::DEFAULT.vectors));
        let deep = ["[", "]"].map(|end| end.repeat(200)).concat();
        let deep = format!(r#"{{"id": {deep}, "genes": [0, 0]}}"#);
        for (line, why) in [
            ("", "is empty"),
            ("  ", "is empty"),
            ("[1, 2]", "is no object of JSON"),
            ("[null, null, null, null, null, [1, 0], null]", "is no object of JSON"),
            ("{", "column 1: EOF while parsing an object"),
            ("{}", "lacks `parameters` or `genes`"),
            (r#"{"parameters": [1, 0], "genes": [1, 0]}"#, "has `parameters` and `genes`"),
            (r#"{"parameter": [1, 0]}"#, "column 12: unknown field `parameter`, expected one of"),
            (r#"{"parameters": [1, 0], "parameters": [1, 0]}"#, "column 35: duplicate field `parameters`"),
            (r#"{"parameters": []}"#, "parameters: there is no vector"),
            (r#"{"parameters": [[]]}"#, "parameters: vector 0: has 0 numbers where 2 are wanted"),
            (r#"{"parameters": [1]}"#, "parameters: vector 0: has 1 numbers where 2 are wanted"),
            (r#"{"parameters": [1, 0, 0]}"#, "parameters: vector 0: has 3 numbers where 2 are wanted"),
            (r#"{"parameters": [NaN, 0]}"#, "column 17: expected value; NaN and Infinity are no numbers"),
            (r#"{"parameters": [1, null]}"#, "column 23: invalid type: null, expected a number"),
            (r#"{"parameters": [1e999, 0]}"#, "column "),
            (r#"{"parameters": [1e300, 0]}"#, "parameters: vector 0: number 0, `gain`, is 1e300, outside -5.0 to 5.0"),
            (
                r#"{"parameters": [[1, 0], [1, -0.1]]}"#,
                "parameters: vector 1: number 1, `bias`, is -0.1, outside 0.0 to 1.0",
            ),
            (r#"{"genes": [0, 0], "seed": -1}"#, "column 28: invalid value: integer `-1`"),
            (r#"{"genes": [0, 0], "seed": 9223372036854775808}"#, "seed: 9223372036854775808 is above"),
            (r#"{"genes": [0, 0], "individual": 4000000000}"#, "individual: 4000000000 is above"),
            (many.as_str(), "genes: 65537 vectors, more than 65536 in a line"),
            (r#"{"id": nul, "genes": [0, 0]}"#, "column 11: expected"),
            (deep.as_str(), "id: recursion limit exceeded"),
        ] {
            let found = read(line, &one).unwrap_err();
            assert!(found.starts_with(why), "{line:.200}: {found}");
        }
        let strange = read(r#"{"a\nb": 1}"#, &one).unwrap_err();
        assert!(strange.starts_with(r"column 7: unknown field `a\nb`, expected one of"), "{strange}");
        let strange = read(&format!(r#"{{"{}": 1}}"#, "x".repeat(9999)), &one).unwrap_err();
        assert!(strange.starts_with("column 10002: unknown field `xxx") && strange.len() < 250, "{strange}");
        assert_eq!(Request::from_line(b"{\xff}", &one), Err("byte 1: is no UTF-8".into()));
    }
}
