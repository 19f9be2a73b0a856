//! Values of one curve, stored or referenced, with a pyramid of their extremes.

use estimator::log::pyramid::{Band, Pyramid};
use estimator::simulate::Simulation;
use haptics::recording::Recording;
use std::ops::Range;
use std::sync::Arc;

/// Number of samples per chunk when a pyramid is built from values computed on the fly.
const CHUNK: usize = 4096;

/// Values of one curve, stored or referenced, with a pyramid of their extremes: a pixel column over a million samples
/// reads tens of blocks instead of samples.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    source: Source,
    /// Shown value = value × factor + offset; the factor is positive.
    factor: f64,
    offset: f64,
    pyramid: Arc<Pyramid>,
}

#[derive(Clone, Debug)]
enum Source {
    /// Channel of the recording, which holds the values.
    Channel(usize),
    /// Predicted channel of a simulation, which holds the values.
    Simulated(Arc<Simulation>, usize),
    /// One curve minus another, sample by sample.
    Difference(Arc<Levels>, Arc<Levels>),
    /// Values stored here.
    Own(Arc<Vec<f64>>),
}

impl Default for Source {
    fn default() -> Self {
        Self::Own(Arc::default())
    }
}

impl Levels {
    /// Curve that stores its values, in the shown unit.
    pub fn new(values: Vec<f64>) -> Self {
        let pyramid = Arc::new(Pyramid::of(&values));
        Self { pyramid, source: Source::Own(Arc::new(values)), factor: 1.0, offset: 0.0 }
    }

    /// Curve of channel `index` of a recording, which keeps the `values`; shown times `factor`.
    pub fn of_channel(index: usize, values: &[f64], factor: f64) -> Self {
        let pyramid = Arc::new(Pyramid::of(values));
        Self { pyramid, source: Source::Channel(index), factor, offset: 0.0 }
    }

    /// Curve of a predicted channel, whose values stay in the simulation; shown times `factor`.
    pub fn of_simulation(simulation: &Arc<Simulation>, index: usize, factor: f64) -> Self {
        let values = simulation.predicted.get(index).map_or(&[][..], |c| c.values.as_slice());
        let pyramid = Arc::new(Pyramid::of(values));
        Self { pyramid, source: Source::Simulated(Arc::clone(simulation), index), factor, offset: 0.0 }
    }

    /// Difference `of` minus `less`, of which no sample is stored.
    pub fn difference(of: &Arc<Self>, less: &Arc<Self>, recording: &Recording) -> Self {
        let (a, b) = (of.samples(recording), less.samples(recording));
        let n = a.len().min(b.len());
        let mut pyramid = Pyramid::default();
        for first in (0..n).step_by(CHUNK) {
            let part: Vec<f64> = (first..n.min(first + CHUNK)).map(|i| a.value(i) - b.value(i)).collect();
            pyramid.extend(&part);
        }
        let source = Source::Difference(Arc::clone(of), Arc::clone(less));
        Self { pyramid: Arc::new(pyramid), source, factor: 1.0, offset: 0.0 }
    }

    /// The same curve, higher by `offset` in the shown unit; neither samples nor pyramid are copied.
    pub fn shifted(&self, offset: f64) -> Self {
        Self { offset: self.offset + offset, ..self.clone() }
    }

    /// View of the samples, for drawing.
    pub fn samples<'a>(&'a self, recording: &'a Recording) -> Samples<'a> {
        let values = match &self.source {
            Source::Own(values) => Values::Slice(values),
            Source::Channel(index) => {
                Values::Slice(recording.channels.get(*index).map_or(&[][..], |c| c.values.as_slice()))
            }
            Source::Simulated(simulation, index) => {
                Values::Slice(simulation.predicted.get(*index).map_or(&[][..], |c| c.values.as_slice()))
            }
            Source::Difference(a, b) => Values::Difference(a, b, recording),
        };
        Samples { values, levels: self }
    }
}

#[derive(Clone, Copy, Debug)]
enum Values<'a> {
    Slice(&'a [f64]),
    Difference(&'a Levels, &'a Levels, &'a Recording),
}

/// A curve's values with their pyramid.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    values: Values<'a>,
    levels: &'a Levels,
}

impl Samples<'_> {
    /// Number of samples.
    pub fn len(&self) -> usize {
        match &self.values {
            Values::Slice(values) => values.len(),
            Values::Difference(a, b, recording) => a.samples(recording).len().min(b.samples(recording).len()),
        }
    }

    /// True if there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Value of a sample in the shown unit; NaN outside the curve.
    pub fn value(&self, sample: usize) -> f64 {
        let raw = match &self.values {
            Values::Slice(values) => values.get(sample).copied().unwrap_or(f64::NAN),
            Values::Difference(a, b, recording) => {
                a.samples(recording).value(sample) - b.samples(recording).value(sample)
            }
        };
        raw * self.levels.factor + self.levels.offset
    }

    /// Smallest and largest of `first..end` in the shown unit; (∞, −∞) when there is none.
    pub fn range(&self, first: usize, end: usize) -> (f64, f64) {
        let read = |range: Range<usize>| match &self.values {
            Values::Slice(values) => Band::of(values.get(range).unwrap_or_default()),
            Values::Difference(a, b, recording) => {
                let (a, b) = (a.samples(recording), b.samples(recording));
                Band::of(&range.map(|i| a.value(i) - b.value(i)).collect::<Vec<_>>())
            }
        };
        let (factor, offset) = (self.levels.factor, self.levels.offset);
        let band = self.levels.pyramid.band(first..end, &read);
        band.filter(|b| b.low <= b.high)
            .map_or((f64::INFINITY, f64::NEG_INFINITY), |b| (b.low * factor + offset, b.high * factor + offset))
    }
}
