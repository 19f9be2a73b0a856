//! Log densities on processors with AVX-512: the states of a model, at most eight, lie side by side in one register.
//!
//! Samples are read as they lie, and the result is the row that Viterbi's step wants. Products are added by fused
//! instructions, so that the last digit may differ from [`super::Gaussian::log_density`].

use super::gaussian::{Gaussian, Whitening};
use super::model::Model;
use std::arch::x86_64::{
    __m512d, _CMP_LT_OQ, _mm512_cmp_pd_mask, _mm512_fmadd_pd, _mm512_mul_pd, _mm512_set1_pd, _mm512_setzero_pd,
    _mm512_sub_pd,
};

/// States of a row.
pub(super) const STATES: usize = 8;
/// One number a state.
pub(super) type Row = [f64; STATES];
/// Number of samples that are computed together, so that one read of the model serves them all.
const TOGETHER: usize = 4;

/// True if the processor has the features that [`Table::fill`] is compiled with.
pub(super) fn is_at_home() -> bool {
    use std::arch::is_x86_feature_detected as has;
    has!("avx512f") && has!("avx512dq") && has!("avx512vl") && has!("avx512bw")
}

/// The emissions of a model, by channel.
pub(super) struct Table {
    means: Vec<Row>,
    /// By channel for independent channels, otherwise by row and channel of the lower triangles.
    whitening: Vec<Row>,
    full: bool,
    /// −½ weight.
    slope: f64,
    /// −weight ½ (d log 2π + log |Σ|).
    offset: Row,
}

impl Table {
    /// `None` for a model with more states than fit a row.
    pub fn new(model: &Model, weight: f64) -> Option<Self> {
        let emissions = &model.emissions[..];
        if emissions.len() > STATES {
            return None;
        }
        let d = model.channels();
        let row = |of: &dyn Fn(&Gaussian) -> f64| {
            let mut row = [0.0; STATES];
            row.iter_mut().zip(emissions).for_each(|(place, emission)| *place = of(emission));
            row
        };
        let full = emissions.iter().any(|e| matches!(e.whitening(), Whitening::Rows(_)));
        let entry = |emission: &Gaussian, a: usize, b: usize| match emission.whitening() {
            Whitening::Channels(inverses) if a == b => inverses[a],
            Whitening::Channels(_) => 0.0,
            Whitening::Rows(rows) => rows[a * d + b],
        };
        let entries = (0..d).flat_map(|a| (if full { 0 } else { a }..=a).map(move |b| (a, b)));
        Some(Self {
            means: (0..d).map(|c| row(&|e| e.mean()[c])).collect(),
            whitening: entries.map(|(a, b)| row(&|e| entry(e, a, b))).collect(),
            full,
            slope: -0.5 * weight,
            offset: row(&|e| -weight * e.log_scale()),
        })
    }

    /// Fills one row a sample.
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
    pub fn fill(&self, values: &[f64], rows: &mut [Row]) {
        let d = self.means.len();
        let mut apart = vec![[_mm512_setzero_pd(); TOGETHER]; d];
        let mut samples = values.chunks_exact(TOGETHER * d);
        let mut groups = rows.chunks_exact_mut(TOGETHER);
        for (values, rows) in (&mut samples).zip(&mut groups) {
            self.group::<TOGETHER>(values, rows, &mut apart);
        }
        for (values, row) in samples.remainder().chunks_exact(d).zip(groups.into_remainder().chunks_exact_mut(1)) {
            self.group::<1>(values, row, &mut apart);
        }
    }

    #[inline]
    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
    fn group<const N: usize>(&self, values: &[f64], rows: &mut [Row], apart: &mut [[__m512d; TOGETHER]]) {
        let d = self.means.len();
        let mut squared = [_mm512_setzero_pd(); N];
        for (channel, (mean, apart)) in self.means.iter().zip(apart.iter_mut()).enumerate() {
            let mean = register(mean);
            for n in 0..N {
                apart[n] = _mm512_sub_pd(_mm512_set1_pd(values[n * d + channel]), mean);
            }
        }
        if self.full {
            let mut weights = self.whitening.iter();
            for row in 0..d {
                let mut term = [_mm512_setzero_pd(); N];
                for (apart, weight) in apart[..=row].iter().zip(&mut weights) {
                    let weight = register(weight);
                    for n in 0..N {
                        term[n] = _mm512_fmadd_pd(weight, apart[n], term[n]);
                    }
                }
                for n in 0..N {
                    squared[n] = _mm512_fmadd_pd(term[n], term[n], squared[n]);
                }
            }
        } else {
            for (apart, weight) in apart.iter().zip(&self.whitening) {
                let weight = register(weight);
                for n in 0..N {
                    let term = _mm512_mul_pd(weight, apart[n]);
                    squared[n] = _mm512_fmadd_pd(term, term, squared[n]);
                }
            }
        }
        let (slope, offset) = (_mm512_set1_pd(self.slope), register(&self.offset));
        for (n, row) in rows.iter_mut().enumerate().take(N) {
            *row = bytemuck::must_cast(_mm512_fmadd_pd(slope, squared[n], offset));
            let finite = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(squared[n], _mm512_set1_pd(f64::INFINITY));
            if finite != 0xff && values[n * d..(n + 1) * d].iter().any(|v| !v.is_finite()) {
                // No evidence for any state.
                *row = [0.0; STATES];
            }
        }
    }
}

#[inline]
#[target_feature(enable = "avx512f")]
fn register(row: &Row) -> __m512d {
    bytemuck::must_cast(*row)
}
