//! Episodes as comma-separated values.

use std::io::{self, Write};

use farsa_body::Recorder;

use crate::recording::schema::Schema;

/// A recorder that writes a table with a line for each tick. Its columns are `trial,step,time [s]` and the columns of
/// the schema.
///
/// Single-precision values are written with the digits that single precision needs. Note that this does not write
/// bodies, contacts, points and images. If you need their numbers, record them as scalars.
pub struct Table<W: Write> {
    out: csv::Writer<W>,
    trial: u32,
    step: u32,
    scalars: Vec<f64>,
    values: Vec<f32>,
    /// First index of neurons and of outputs among the values.
    starts: [usize; 2],
    written: csv::Result<()>,
}

impl<W: Write> Table<W> {
    /// Creates a table, and writes its head.
    ///
    /// # Errors
    /// Returns errors of the writer.
    pub fn new(out: W, schema: &Schema) -> io::Result<Self> {
        let mut out = csv::Writer::from_writer(out);
        let head = ["trial", "step", "time [s]"].map(String::from).into_iter().chain(schema.columns());
        out.write_record(head).map_err(as_io)?;
        let starts = [schema.sensors.len(), schema.sensors.len() + schema.neurons.len()];
        Ok(Self {
            out,
            trial: 0,
            step: 0,
            scalars: vec![f64::NAN; schema.scalars.len()],
            values: vec![f32::NAN; starts[1] + schema.outputs.len()],
            starts,
            written: Ok(()),
        })
    }

    /// Starts a new trial with the given number.
    pub fn begin(&mut self, trial: u32) {
        (self.trial, self.step) = (trial, 0);
    }

    /// Ends the table.
    ///
    /// # Errors
    /// Returns the first error of the writer, including those of earlier ticks.
    pub fn finish(mut self) -> io::Result<()> {
        self.written.map_err(as_io)?;
        self.out.flush()
    }

    fn keep(&mut self, first: usize, end: usize, values: &[f32]) {
        if let Some(to) = self.values.get_mut(first..end) {
            to.iter_mut().zip(values).for_each(|(to, value)| *to = *value);
        }
    }
}

fn as_io(error: csv::Error) -> io::Error {
    let why = error.to_string();
    match error.into_kind() {
        csv::ErrorKind::Io(source) => source,
        _ => io::Error::other(why),
    }
}

impl<W: Write> Recorder for Table<W> {
    fn sensors(&mut self, x: &[f32]) {
        self.keep(0, self.starts[0], x);
    }

    fn neurons(&mut self, states: &[f32]) {
        self.keep(self.starts[0], self.starts[1], states);
    }

    fn outputs(&mut self, y: &[f32]) {
        self.keep(self.starts[1], self.values.len(), y);
    }

    fn scalars(&mut self, values: &[f64]) {
        self.scalars.iter_mut().zip(values).for_each(|(to, value)| *to = *value);
    }

    fn tick(&mut self, time: f64) {
        if self.written.is_ok() {
            let counts = [self.trial.to_string(), self.step.to_string(), digits(time)];
            let values = self.scalars.iter().copied().chain(self.values.iter().copied().map(f64::from));
            self.written = self.out.write_record(counts.into_iter().chain(values.map(digits)));
        }
        self.step += 1;
        self.scalars.fill(f64::NAN);
        self.values.fill(f32::NAN);
    }
}

/// Formats a number with the shortest digits that are read back exactly in its precision.
fn digits(x: f64) -> String {
    let single = x as f32;
    if f64::from(single) == x { format!("{single:?}") } else { format!("{x:?}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_in_the_precision_they_have() {
        assert_eq!(digits(f64::from(0.1_f32)), "0.1");
        assert_eq!(digits(0.1), "0.1");
        assert_eq!(digits(0.1 + 0.2), "0.30000000000000004");
        assert_eq!(digits(-0.0), "-0.0");
        assert_eq!(digits(f64::NAN), "NaN");
    }

    #[test]
    fn a_line_per_tick_in_the_order_of_the_head() {
        let mut schema = Schema::from_scalars(["x [m]"]).with_sensors(["a", "b"]).with_outputs(["c"]);
        schema.neurons = vec![crate::recording::schema::Channel::new("n")];
        let mut bytes = Vec::new();
        let mut table = Table::new(&mut bytes, &schema).unwrap();
        table.begin(2);
        table.outputs(&[0.5, 9.0]);
        table.sensors(&[0.1]);
        table.scalars(&[-1.0]);
        table.tick(0.01);
        table.neurons(&[0.25]);
        table.tick(0.02);
        table.finish().unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "trial,step,time [s],x [m],sensor.a,sensor.b,neuron.n,output.c");
        assert_eq!(lines[1], "2,0,0.01,-1.0,0.1,NaN,NaN,0.5");
        assert_eq!(lines[2], "2,1,0.02,NaN,NaN,NaN,0.25,NaN");
    }
}
