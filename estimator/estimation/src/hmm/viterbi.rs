//! The single most probable path of states.

use super::chain::{Chain, HmmError};
use super::emissions::Job;
use super::model::Model;
use super::vector::for_this_processor;

/// States that lie side by side in one step.
const LANES: usize = 8;
type Row = [f64; LANES];
/// Samples between two exchanges of the tasks: one computes densities while the other walks along those that are there.
const STRETCH: usize = 8192;

impl Model {
    /// The most probable path of `values` and its log probability: [`Model::log_emissions`] and [`viterbi`] in one pass that uses all
    /// processors and keeps no densities. `chain` replaces the model's own (same number of states).
    pub fn decode(&self, chain: &Chain, values: &[f64], weight: f64) -> Result<(Vec<u8>, f64), HmmError> {
        let k = chain.states();
        if k != self.emissions.len() {
            return Err(HmmError::Shape {
                what: format!("{} emissions and a chain of {k} states", self.emissions.len()),
            });
        }
        if k > LANES {
            return Ok(viterbi(chain, &self.log_emissions(values, weight)));
        }
        let d = self.channels();
        let values = &values[..values.len() / d * d];
        let job = Job { model: self, weight, stride: LANES };
        let mut walk = Walk::new(chain, values.len() / d);
        let stretch = |number: usize| {
            let first = number * STRETCH * d;
            values.get(first..).map_or(&[][..], |rest| &rest[..rest.len().min(STRETCH * d)])
        };
        rayon::scope(|_| {
            let (mut now, mut next): (Vec<Row>, Vec<Row>) = (Vec::new(), Vec::new());
            let densities = |number: usize, rows: &mut Vec<Row>| {
                let values = stretch(number);
                rows.resize(values.len() / d, [0.0; LANES]);
                job.fill_together(values, rows.as_flattened_mut());
            };
            densities(0, &mut now);
            let mut number = 0;
            while !now.is_empty() {
                number += 1;
                rayon::join(|| walk.along(&now), || densities(number, &mut next));
                std::mem::swap(&mut now, &mut next);
            }
        });
        Ok(walk.path())
    }
}

/// The most probable path, and the logarithm of its probability density together with the sequence; a tie goes to the state with
/// the lower number. `log_emissions` as in [`super::forward_backward`].
pub fn viterbi(chain: &Chain, log_emissions: &[f64]) -> (Vec<u8>, f64) {
    let k = chain.states();
    if k > LANES {
        return plain(chain, log_emissions);
    }
    let mut walk = Walk::new(chain, log_emissions.len() / k);
    let mut rows: Vec<Row> = Vec::new();
    for stretch in log_emissions.chunks(STRETCH * k) {
        rows.clear();
        rows.extend(stretch.chunks_exact(k).map(|states| {
            let mut row = [0.0; LANES];
            row[..k].copy_from_slice(states);
            row
        }));
        walk.along(&rows);
    }
    walk.path()
}

/// The walk along a sequence, for at most [`LANES`] states. States that do not exist are never reached.
struct Walk {
    states: usize,
    /// log A by source; a row holds all targets.
    links: [Row; LANES],
    /// log probability of the best path to each state; before the first sample log π.
    best: Row,
    begun: bool,
    /// Predecessor on the best path to each state, for every sample.
    came_from: Vec<[u8; LANES]>,
}

impl Walk {
    fn new(chain: &Chain, samples: usize) -> Self {
        let k = chain.states();
        let mut links = [[f64::NEG_INFINITY; LANES]; LANES];
        for (row, from) in links.iter_mut().zip(chain.transition().chunks_exact(k)) {
            row.iter_mut().zip(from).for_each(|(link, p)| *link = p.ln());
        }
        let mut best = [f64::NEG_INFINITY; LANES];
        best.iter_mut().zip(chain.start()).for_each(|(value, p)| *value = p.ln());
        Self { states: k, links, best, begun: false, came_from: Vec::with_capacity(samples) }
    }

    /// Continues through the next samples.
    fn along(&mut self, mut rows: &[Row]) {
        if let ([first, rest @ ..], false) = (rows, self.begun) {
            self.best.iter_mut().zip(first).for_each(|(value, density)| *value += density);
            self.came_from.push([0; LANES]);
            (self.begun, rows) = (true, rest);
        }
        let first = self.came_from.len();
        self.came_from.resize(first + rows.len(), [0; LANES]);
        let came_from = &mut self.came_from[first..];
        match self.states {
            1 => steps_1(&self.links, &mut self.best, rows, came_from),
            2 => steps_2(&self.links, &mut self.best, rows, came_from),
            3 => steps_3(&self.links, &mut self.best, rows, came_from),
            4 => steps_4(&self.links, &mut self.best, rows, came_from),
            5 => steps_5(&self.links, &mut self.best, rows, came_from),
            6 => steps_6(&self.links, &mut self.best, rows, came_from),
            7 => steps_7(&self.links, &mut self.best, rows, came_from),
            _ => steps_8(&self.links, &mut self.best, rows, came_from),
        }
    }

    /// Back from the best end.
    fn path(self) -> (Vec<u8>, f64) {
        if self.came_from.is_empty() {
            return (Vec::new(), 0.0);
        }
        let best = &self.best[..self.states];
        let mut state = (0..self.states).reduce(|a, b| if best[b] > best[a] { b } else { a }).unwrap_or(0);
        let log_probability = best[state];
        let mut path = vec![0; self.came_from.len()];
        for (here, from) in path.iter_mut().zip(&self.came_from).rev() {
            *here = state as u8;
            state = usize::from(from[state % LANES]);
        }
        (path, log_probability)
    }
}

macro_rules! steps {
    ($($name:ident $states:literal),*) => {
        $(for_this_processor! {
            /// One step a row for a given number of states.
            fn $name(links: &[Row; LANES], best: &mut Row, rows: &[Row], came_from: &mut [[u8; LANES]])
                => steps::<$states>, steps_avx512::<$states>
        })*
    };
}
steps!(steps_1 1, steps_2 2, steps_3 3, steps_4 4, steps_5 5, steps_6 6, steps_7 7, steps_8 8);

/// [`steps`], spelled out: a row is one register.
#[cfg(target_arch = "x86_64")]
#[inline]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw")]
fn steps_avx512<const STATES: usize>(
    links: &[Row; LANES],
    best: &mut Row,
    rows: &[Row],
    came_from: &mut [[u8; LANES]],
) {
    use std::arch::x86_64::{
        __m512d, _CMP_GT_OQ, _mm_cvtsi128_si64, _mm512_add_pd, _mm512_cmp_pd_mask, _mm512_cvtepi64_epi8,
        _mm512_mask_mov_epi64, _mm512_max_pd, _mm512_permutexvar_pd, _mm512_set1_epi64, _mm512_set1_pd,
        _mm512_setzero_si512,
    };
    let register = |row: &Row| -> __m512d { bytemuck::must_cast(*row) };
    let links: [__m512d; STATES] = std::array::from_fn(|state| register(&links[state]));
    let mut now = register(best);
    for (row, from) in rows.iter().zip(came_from) {
        let (mut top, mut source) = (_mm512_set1_pd(f64::NEG_INFINITY), _mm512_setzero_si512());
        for (number, link) in (0..).zip(&links) {
            let number = _mm512_set1_epi64(number);
            let candidate = _mm512_add_pd(_mm512_permutexvar_pd(number, now), *link);
            let better = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(candidate, top);
            source = _mm512_mask_mov_epi64(source, better, number);
            // The second one where neither is larger, as below.
            top = _mm512_max_pd(candidate, top);
        }
        now = _mm512_add_pd(top, register(row));
        *from = _mm_cvtsi128_si64(_mm512_cvtepi64_epi8(source)).to_le_bytes();
    }
    *best = bytemuck::must_cast(now);
}

/// All targets at once, source after source.
#[inline(always)]
#[allow(clippy::inline_always, reason = "it must be compiled for the processor that its caller is compiled for")]
fn steps<const STATES: usize>(links: &[Row; LANES], best: &mut Row, rows: &[Row], came_from: &mut [[u8; LANES]]) {
    let mut now = *best;
    for (row, from) in rows.iter().zip(came_from) {
        let (mut top, mut source) = ([f64::NEG_INFINITY; LANES], [0_u64; LANES]);
        for state in 0..STATES {
            for to in 0..LANES {
                let candidate = now[state] + links[state][to];
                let better = candidate > top[to];
                top[to] = if better { candidate } else { top[to] };
                source[to] = if better { state as u64 } else { source[to] };
            }
        }
        for to in 0..LANES {
            now[to] = top[to] + row[to];
            from[to] = source[to] as u8;
        }
    }
    *best = now;
}

/// Any number of states.
pub(super) fn plain(chain: &Chain, log_emissions: &[f64]) -> (Vec<u8>, f64) {
    let k = chain.states();
    let samples = log_emissions.len() / k;
    if samples == 0 {
        return (Vec::new(), 0.0);
    }
    // By target: the sources of one target lie together.
    let log: Vec<f64> = (0..k * k).map(|i| chain.transition()[(i % k) * k + i / k].ln()).collect();
    let mut best: Vec<f64> = (0..k).map(|s| chain.start()[s].ln() + log_emissions[s]).collect();
    let mut next = vec![0.0; k];
    let mut came_from = vec![0_u8; samples * k];
    for (row, from) in log_emissions.chunks_exact(k).zip(came_from.chunks_exact_mut(k)).skip(1) {
        for to in 0..k {
            let (mut top, mut source) = (f64::NEG_INFINITY, 0);
            for (state, (value, link)) in best.iter().zip(&log[to * k..(to + 1) * k]).enumerate() {
                let candidate = value + link;
                if candidate > top {
                    (top, source) = (candidate, state);
                }
            }
            next[to] = top + row[to];
            from[to] = source as u8;
        }
        std::mem::swap(&mut best, &mut next);
    }
    let mut state = (0..k).reduce(|a, b| if best[b] > best[a] { b } else { a }).unwrap_or(0);
    let log_probability = best[state];
    let mut path = vec![0; samples];
    for t in (0..samples).rev() {
        path[t] = state as u8;
        state = usize::from(came_from[t * k + state]);
    }
    (path, log_probability)
}

/// Logarithm of the probability density of a given path together with the sequence; −∞ for a path that is not allowed.
pub fn path_log_probability(chain: &Chain, log_emissions: &[f64], path: &[u8]) -> f64 {
    let k = chain.states();
    let mut total = 0.0;
    let mut before = None;
    for (row, state) in log_emissions.chunks_exact(k).zip(path.iter().map(|s| usize::from(*s))) {
        let link = before.map_or(chain.start()[state], |from: usize| chain.transition()[from * k + state]);
        total += link.ln() + row[state];
        before = Some(state);
    }
    total
}
