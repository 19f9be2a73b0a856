//! Thinned curves of the plots over time, kept while the view is unchanged.

use crate::ui::document::prepared::Prepared;
use crate::ui::plots::curves::{Curve, Layer};
use crate::ui::plots::decimate::{Columns, decimate_in};
use crate::ui::plots::plot_input::RowInput;
use crate::ui::plots::residual_plot::BAND_SIGMAS;
use egui_plot::PlotPoint;
use std::collections::HashMap;
use std::sync::Arc;

/// Thinned curves, kept while the view is unchanged.
#[derive(Default)]
pub struct PlotCache {
    curves: HashMap<(usize, usize), Cached>,
    /// Columns of the last view, by recording and offset: all curves of a recording share them.
    columns: HashMap<ColumnsKey, (Arc<Prepared>, Columns)>,
}

/// Recording, visible time range in its own time, number of columns.
type ColumnsKey = (usize, [u64; 2], usize);
/// Limit of the cache, above the number of recordings that are ever overlaid.
const MOST_COLUMNS: usize = 32;

struct Cached {
    key: CacheKey,
    /// Keeps the targets of the key alive.
    _curve: Curve,
    points: Vec<PlotPoint>,
    band: Option<Band>,
}

/// Identity of thinned points: recording, curve, visible time range and offset, columns.
type CacheKey = (usize, usize, [u64; 3], usize, Option<u64>);

/// Noise band: times, lower and upper edge.
pub(super) struct Band {
    pub(super) times: Vec<f64>,
    pub(super) low: Vec<f64>,
    pub(super) high: Vec<f64>,
}

impl PlotCache {
    pub(super) fn update(&mut self, input: &RowInput<'_>, columns: usize) {
        for (place, curve) in input.drawn.curves.iter().enumerate() {
            self.thin((input.index, place), curve, input.view_s, columns);
        }
        let count = input.drawn.curves.len();
        self.curves.retain(|(row, place), _| *row != input.index || *place < count);
    }

    fn thin(&mut self, slot: (usize, usize), curve: &Curve, (from, to): (f64, f64), columns: usize) {
        let key = (
            Arc::as_ptr(&curve.prepared) as usize,
            Arc::as_ptr(&curve.levels) as usize,
            [from, to, curve.offset_s].map(f64::to_bits),
            columns,
            curve.sigma.map(f64::to_bits),
        );
        if self.curves.get(&slot).is_some_and(|cached| cached.key == key) {
            return;
        }
        let (samples, offset) = (curve.levels.samples(&curve.prepared.recording), curve.offset_s);
        let (from, to) = (from - offset, to - offset);
        if self.columns.len() > MOST_COLUMNS {
            self.columns.clear();
        }
        let times = &curve.prepared.times;
        let shared = self.columns.entry((key.0, [from.to_bits(), to.to_bits()], columns));
        let make = || (Arc::clone(&curve.prepared), Columns::new(times, from, to, columns));
        let (_, shared) = shared.or_insert_with(make);
        let mut points = decimate_in(times, samples, shared);
        for point in &mut points {
            point.x += offset;
        }
        let is_model = matches!(curve.layer, Layer::Simulated | Layer::Extended);
        let band = curve.sigma.filter(|_| is_model).map(|sigma| Band::around(&points, BAND_SIGMAS * sigma));
        self.curves.insert(slot, Cached { key, _curve: curve.clone(), points, band });
    }

    pub(super) fn points(&self, input: &RowInput<'_>, place: usize) -> &[PlotPoint] {
        self.curves.get(&(input.index, place)).map_or(&[], |cached| &cached.points)
    }

    pub(super) fn band(&self, input: &RowInput<'_>, place: usize) -> Option<&Band> {
        self.curves.get(&(input.index, place))?.band.as_ref()
    }
}

impl Band {
    /// Band of half-width `reach` around a curve that has one or two points per time.
    fn around(points: &[PlotPoint], reach: f64) -> Self {
        let mut band = Self { times: Vec::new(), low: Vec::new(), high: Vec::new() };
        for at in points.chunk_by(|a, b| a.x == b.x) {
            let (low, high) = at.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.y), high.max(p.y)));
            band.times.push(at[0].x);
            band.low.push(low - reach);
            band.high.push(high + reach);
        }
        band
    }
}
