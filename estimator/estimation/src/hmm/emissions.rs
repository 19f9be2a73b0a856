//! Log densities of many samples: blocks of samples lie side by side, one channel after the other, so that the processor works on
//! several at once.

use super::gaussian::Gaussian;
use super::model::Model;
use super::vector::for_this_processor;
#[cfg(target_arch = "x86_64")]
use super::wide;

/// Samples of a block.
pub(super) const LANES: usize = 32;
/// One channel, or one sum, of a block of samples.
pub(super) type Lanes = [f64; LANES];
/// Samples that one task works on: their channels stay in the processor's near memory.
const TASK: usize = 1024;

/// Task of a computation, and the layout of rows of states: `stride` numbers a sample, of which the first ones are
/// filled.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    /// The model.
    pub model: &'a Model,
    /// See [`Model::log_emissions`].
    pub weight: f64,
    /// Numbers from one sample's row to the next.
    pub stride: usize,
}

impl Job<'_> {
    /// Fills the rows of `values` on all processors.
    pub fn fill_together(self, values: &[f64], rows: &mut [f64]) {
        use rayon::prelude::*;
        let (of_values, of_rows) = (TASK * self.model.channels(), TASK * self.stride);
        #[cfg(target_arch = "x86_64")]
        if let Some(table) = wide::is_at_home().then(|| wide::Table::new(self.model, self.weight)).flatten() {
            let parts = rows.par_chunks_mut(of_rows).zip(values.par_chunks(of_values));
            return parts.for_each(|(rows, values)| self.fill_wide(&table, values, rows));
        }
        let parts = rows.par_chunks_mut(of_rows).zip(values.par_chunks(of_values));
        parts.for_each(|(rows, values)| self.fill_plain(values, rows));
    }

    /// On one processor, in the same order of operations as [`Gaussian::log_density`].
    pub(super) fn fill_plain(self, values: &[f64], rows: &mut [f64]) {
        fill(self, values, rows);
    }

    #[cfg(target_arch = "x86_64")]
    fn fill_wide(self, table: &wide::Table, values: &[f64], rows: &mut [f64]) {
        let fill = |values: &[f64], rows: &mut [wide::Row]| {
            // SAFETY: the processor has been asked for every instruction that the function is compiled with.
            #[allow(unsafe_code, reason = "the only way to call a function that not every processor can run")]
            unsafe {
                table.fill(values, rows);
            }
        };
        if self.stride == wide::STATES {
            return fill(values, rows.as_chunks_mut().0);
        }
        let mut wider = vec![[0.0; wide::STATES]; rows.len() / self.stride];
        fill(values, &mut wider);
        for (row, wider) in rows.chunks_exact_mut(self.stride).zip(&wider) {
            row.copy_from_slice(&wider[..self.stride]);
        }
    }
}

for_this_processor! {
    /// Fills the rows of `values`.
    fn fill(job: Job<'_>, values: &[f64], rows: &mut [f64]) => fill_blocks
}

#[inline(always)]
#[allow(clippy::inline_always, reason = "it must be compiled for the processor that its caller is compiled for")]
fn fill_blocks(job: Job<'_>, values: &[f64], rows: &mut [f64]) {
    let d = job.model.channels();
    let mut columns = vec![[0.0; LANES]; d];
    let mut apart = columns.clone();
    for (values, rows) in values.chunks(LANES * d).zip(rows.chunks_mut(LANES * job.stride)) {
        let unknown = side_by_side(values, &mut columns);
        let filled = rows.len() / job.stride;
        for (state, emission) in job.model.emissions.iter().enumerate() {
            let mut densities = log_densities(emission, &columns, &mut apart, filled);
            for (density, unknown) in densities.iter_mut().zip(&unknown) {
                *density = if *unknown == 0.0 { job.weight * *density } else { 0.0 };
            }
            for (row, density) in rows.chunks_exact_mut(job.stride).zip(&densities) {
                row[state] = *density;
            }
        }
    }
}

/// Turns samples into columns; not 0 where a sample has a number that is not finite. Lanes without a sample keep their
/// values.
#[inline(always)]
#[allow(clippy::inline_always, reason = "see `fill_blocks`")]
fn side_by_side(values: &[f64], columns: &mut [Lanes]) -> Lanes {
    let channels = columns.len();
    for (channel, column) in columns.iter_mut().enumerate() {
        // Channel after channel: the other way round becomes scattered stores, which are slow.
        for (place, value) in column.iter_mut().zip(values[channel..].iter().step_by(channels)) {
            *place = *value;
        }
    }
    let mut unknown = [0.0; LANES];
    for column in columns.iter() {
        for (unknown, value) in unknown.iter_mut().zip(column) {
            // 0, and not a number for values that are not finite.
            *unknown += value * 0.0;
        }
    }
    unknown
}

/// [`Gaussian::log_density`] of the `filled` first lanes of a block, in the same order of operations.
#[inline(always)]
#[allow(clippy::inline_always, reason = "see `fill_blocks`")]
fn log_densities(emission: &Gaussian, columns: &[Lanes], apart: &mut [Lanes], filled: usize) -> Lanes {
    let mut squared = [0.0; LANES];
    let means = emission.mean();
    match emission.whitening() {
        super::gaussian::Whitening::Channels(inverses) => {
            for ((column, mean), inverse) in columns.iter().zip(means).zip(inverses) {
                for (sum, value) in squared.iter_mut().zip(column) {
                    let term = (value - mean) * inverse;
                    *sum += term * term;
                }
            }
        }
        super::gaussian::Whitening::Rows(rows) => {
            for ((apart, column), mean) in apart.iter_mut().zip(columns).zip(means) {
                // A length that is not known beforehand keeps the compiler from working across channels, which lie far apart.
                for (apart, value) in apart[..filled].iter_mut().zip(column) {
                    *apart = value - mean;
                }
            }
            for (row, weights) in rows.chunks_exact(apart.len()).enumerate() {
                let mut term = [0.0; LANES];
                for (weight, apart) in weights.iter().zip(&apart[..=row]) {
                    for (term, value) in term.iter_mut().zip(apart) {
                        *term += weight * value;
                    }
                }
                for (sum, term) in squared.iter_mut().zip(&term) {
                    *sum += term * term;
                }
            }
        }
    }
    let log_scale = emission.log_scale();
    for sum in &mut squared {
        *sum = -log_scale - 0.5 * *sum;
    }
    squared
}

impl Model {
    /// Logarithm of every state's density at every sample, one row a sample, times `weight`.
    ///
    /// A weight below 1 is for samples that come faster than their information: of a channel that is correlated over τ
    /// and sampled every Δt, each sample counts as Δt/τ of an independent one.
    pub fn log_emissions(&self, values: &[f64], weight: f64) -> Vec<f64> {
        let (channels, states) = (self.channels(), self.emissions.len());
        let samples = values.len() / channels;
        let mut rows = vec![0.0; samples * states];
        Job { model: self, weight, stride: states }.fill_together(&values[..samples * channels], &mut rows);
        rows
    }
}
