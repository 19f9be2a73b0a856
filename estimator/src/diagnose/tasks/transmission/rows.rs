//! Rows of a transmission's recordings.

use super::filtered_columns::Fine;
use crate::diagnose::data::limits::{HALF, SHORTEST_S};
use crate::diagnose::selection::layout::segments;
use foundation::signal::noise::quantum;
use foundation::signal::task::smooth;
use haptics::recording::Recording;

/// One row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub recording: usize,
    pub time_s: f64,
    pub input: f64,
    pub output: f64,
    pub rate: f64,
    pub acceleration: f64,
    /// Force at the input, and at the output if it was recorded.
    pub force: Option<f64>,
    pub load: Option<f64>,
}

/// Names of the channels of one kind of coordinate, and its units.
pub struct Columns {
    pub input: &'static str,
    pub output: &'static str,
    pub force: &'static str,
    pub unit: &'static str,
    pub force_unit: &'static str,
    pub give: &'static str,
}

pub static COLUMNS: [Columns; 2] = [
    Columns { input: "q_rad", output: "q_out_rad", force: "tau_Nm", unit: "rad", force_unit: "N m", give: "rad/(N m)" },
    Columns { input: "q_m", output: "q_out_m", force: "f_N", unit: "m", force_unit: "N", give: "m/N" },
];

pub fn columns(recording: &Recording) -> Option<&'static Columns> {
    COLUMNS.iter().find(|c| recording.channel(c.output).is_some() && recording.channel(c.input).is_some())
}

/// Rows of all recordings, with the signals from which they were made.
pub struct Seen {
    pub rows: Vec<Row>,
    pub fine: Vec<Fine>,
    /// Steps of the output's sensor.
    pub step: f64,
}

impl Seen {
    pub fn of(recordings: &[Recording], names: &Columns) -> Self {
        let (rows, fine): (Vec<Vec<Row>>, Vec<Fine>) =
            recordings.iter().enumerate().filter_map(|(k, r)| rows(r, k, names)).unzip();
        let step = recordings.iter().filter_map(|r| r.channel(names.output)).map(quantum).fold(0.0, f64::max);
        Self { rows: rows.concat(), fine, step }
    }

    /// A regressor made from a series of every recording, at some of the rows.
    pub fn column(&self, kept: &[usize], of: &dyn Fn(&Fine) -> Vec<f64>) -> Vec<f64> {
        let all: Vec<f64> = self.fine.iter().flat_map(of).collect();
        kept.iter().map(|i| all[*i]).collect()
    }

    /// The rows that are wanted, or all rows of a recording with too few of them.
    pub fn kept(&self, wanted: &[bool]) -> Vec<usize> {
        let mut kept = Vec::new();
        let mut first = 0;
        for own in self.rows.chunk_by(|a, b| a.recording == b.recording) {
            let all = first..first + own.len();
            first = all.end;
            let some: Vec<usize> = all.clone().filter(|i| wanted[*i]).collect();
            kept.extend(if (some.len() as f64) < HALF * own.len() as f64 { all.collect() } else { some });
        }
        kept
    }

    pub fn at(&self, kept: &[usize]) -> Vec<Row> {
        kept.iter().map(|i| self.rows[*i]).collect()
    }

    /// Lowest and highest place of the input.
    pub fn ends(&self) -> (f64, f64) {
        self.rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), r| (a.min(r.input), b.max(r.input)))
    }
}

/// Rows of one recording, and its input at its own rate.
fn rows(recording: &Recording, number: usize, names: &Columns) -> Option<(Vec<Row>, Fine)> {
    let time = recording.time_s.as_ref().filter(|t| !t.is_empty())?;
    let (raw, output) = (recording.channel(names.input)?, recording.channel(names.output)?);
    let through = |values: &[f64]| smooth(time, values);
    let (input, output) = (through(raw), through(output));
    let acceleration = through(&input.slope).slope;
    let force = recording.channel(names.force).map(|f| through(f).value);
    let load = load(recording, names).map(|f| through(f).value);
    let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1).max(1) as f64;
    let every = (SHORTEST_S / step_s).round().max(1.0) as usize;
    let row = |i: usize| Row {
        recording: number,
        time_s: time[i],
        input: input.value[i],
        output: output.value[i],
        rate: input.slope[i],
        acceleration: acceleration[i],
        force: force.as_ref().map(|f| f[i]),
        load: load.as_ref().map(|f| f[i]),
    };
    Some(((0..time.len()).step_by(every).map(row).collect(), Fine::new(time, raw, every)))
}

/// Load at the output: an extra channel in the force's unit that is not the force at the input.
fn load<'a>(recording: &'a Recording, names: &Columns) -> Option<&'a [f64]> {
    let ending = names.force.rsplit('_').next()?;
    let other =
        recording.channels.iter().find(|c| c.name != names.force && c.name.rsplit('_').next() == Some(ending))?;
    Some(&other.values)
}

/// One constant per recording, because sensors' zeros differ.
pub fn constants(rows: &[Row]) -> Vec<Vec<f64>> {
    let mut numbers: Vec<usize> = rows.iter().map(|r| r.recording).collect();
    numbers.dedup();
    numbers.iter().map(|k| rows.iter().map(|r| f64::from(u8::from(r.recording == *k))).collect()).collect()
}

/// Rows that follow each other.
pub fn stretches_of(rows: &[Row]) -> Vec<usize> {
    let time: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
    segments(&time, SHORTEST_S, |i| rows[i].recording != rows[i - 1].recording)
}

/// Slope of the output over the input, about the means of each recording.
pub fn ratio(rows: &[Row]) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for own in rows.chunk_by(|a, b| a.recording == b.recording) {
        let mean = |of: fn(&Row) -> f64| own.iter().map(of).sum::<f64>() / own.len() as f64;
        let (input, output) = (mean(|r| r.input), mean(|r| r.output));
        product += own.iter().map(|r| (r.input - input) * (r.output - output)).sum::<f64>();
        square += own.iter().map(|r| (r.input - input).powi(2)).sum::<f64>();
    }
    product / square.max(f64::MIN_POSITIVE)
}
