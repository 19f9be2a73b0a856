//! The path of a recording in the picture: its extent, the part in view, and the scale of forces beside it.

use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use haptics::Vec2;

/// Bounding rectangle of the path, m.
pub fn bounds(prepared: &Prepared) -> Option<(Vec2, Vec2)> {
    let points = prepared.path_samples.iter().filter_map(|i| prepared.point_at(*i));
    points.fold(None, |so_far, p| {
        let (low, high) = so_far.unwrap_or((p, p));
        Some((low.inf(&p), high.sup(&p)))
    })
}

/// Scale of force arrows: the typical force is a seventh of the path's extent.
pub fn force_scale(prepared: &Prepared) -> f32 {
    let extent = bounds(prepared).map_or(0.1, |(low, high)| (high - low).amax()).max(0.01);
    let mut sizes: Vec<f64> =
        prepared.path_samples.iter().filter_map(|i| Some(prepared.force_at(*i)?.norm())).collect();
    let usual = estimator::segment::threshold::percentile(&mut sizes, 0.9).max(1e-3);
    (0.15 * extent / usual) as f32
}

/// Samples of the path inside the plots' time window.
pub fn window(document: &Document, prepared: &Prepared) -> Vec<usize> {
    let (from, to) = document.view_s;
    let visible = |i: &&usize| prepared.times[**i] >= from && prepared.times[**i] <= to;
    prepared.path_samples.iter().filter(visible).copied().collect()
}
