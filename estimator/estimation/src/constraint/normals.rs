//! Centre of rotation by intersecting normals to the motion (thesis, 5.3.1).

use haptics::Vec2;
use nalgebra::Matrix2;

/// Consecutive samples whose normals are intersected in the thesis.
pub const THESIS_SAMPLES: usize = 12;

/// A window must bend by this much for its normals to meet at all, rad.
const LEAST_BEND_RAD: f64 = 0.15;
/// Share of the path's extent that the window should span: the thesis's twelve samples at 20 Hz did so in slow turning.
const WINDOW_SHARE: f64 = 0.25;

/// Mean of the points where the normals over `window` consecutive samples meet (least squares), m.
///
/// Fast logs are thinned first, evenly, so that a window spans the same share of the path as at the thesis's 50 ms.
/// `None` when no window bends enough.
pub fn normals_center(points: &[Vec2], window: usize) -> Option<Vec2> {
    let thinned = thin(points, window);
    let centers: Vec<Vec2> = thinned.windows(window.max(3)).filter_map(meeting_point).collect();
    if centers.is_empty() {
        return None;
    }
    // The median: a window in which the motion paused throws its intersection far away.
    let median = |pick: fn(&Vec2) -> f64| {
        let mut values: Vec<f64> = centers.iter().map(pick).collect();
        let middle = values.len() / 2;
        *values.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    Some(Vec2::new(median(|c| c.x), median(|c| c.y)))
}

/// Keeps samples at even distance along the path.
fn thin(points: &[Vec2], window: usize) -> Vec<Vec2> {
    let (mut low, mut high) = (Vec2::repeat(f64::MAX), Vec2::repeat(f64::MIN));
    for p in points {
        low = low.inf(p);
        high = high.sup(p);
    }
    let spacing = WINDOW_SHARE * (high - low).norm() / window.max(2) as f64;
    let mut kept: Vec<Vec2> = Vec::new();
    for p in points {
        if kept.last().is_none_or(|last| (p - last).norm() >= spacing) {
            kept.push(*p);
        }
    }
    kept
}

/// Least-squares intersection of the normals to consecutive displacements.
fn meeting_point(points: &[Vec2]) -> Option<Vec2> {
    let (mut matrix, mut right) = (Matrix2::zeros(), Vec2::zeros());
    let mut directions = Vec::with_capacity(points.len());
    for pair in points.windows(2) {
        let along = (pair[1] - pair[0]).try_normalize(1e-12)?;
        let middle = 0.5 * (pair[0] + pair[1]);
        // The centre c satisfies along · (c − middle) = 0.
        matrix += along * along.transpose();
        right += along * along.dot(&middle);
        directions.push(along);
    }
    let (first, last) = (directions.first()?, directions.last()?);
    let bend = (first.x * last.y - first.y * last.x).atan2(first.dot(last));
    if bend.abs() < LEAST_BEND_RAD {
        return None;
    }
    matrix.try_inverse().map(|inverse| inverse * right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_an_arc_meet_in_its_centre_at_any_rate() {
        let center = Vec2::new(0.01, -0.1);
        for samples in [60, 6_000] {
            let points: Vec<Vec2> = (0..samples)
                .map(|i| {
                    let a = 2.0 * f64::from(i) / f64::from(samples);
                    center + 0.02 * Vec2::new(a.cos(), a.sin())
                })
                .collect();
            let found = normals_center(&points, THESIS_SAMPLES).expect("the arc bends");
            assert!((found - center).norm() < 1e-5, "{samples}: {found}");
        }
    }

    #[test]
    fn a_line_has_no_centre() {
        let points: Vec<Vec2> = (0..200).map(|i| Vec2::new(1e-3 * f64::from(i), 0.0)).collect();
        assert!(normals_center(&points, THESIS_SAMPLES).is_none());
    }
}
