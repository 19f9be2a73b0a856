//! Decision between a whole motion and a part of one. A person who tries a mechanism starts at rest, moves it and
//! stops, or goes there and back; a part cut out of a motion begins or ends on the move. It decides the meaning of
//! short paths: a hinge that was tried has been turned, a part of a hinge's path may be as short as it likes.

use nalgebra::Vector3;

/// A window over which noise is averaged, as a share of the samples: one in so many.
const WINDOWS: usize = 30;
/// Fewer samples are mostly noise.
const LEAST_SAMPLES: usize = 50;
/// At rest: slower than this share of the median speed.
const REST_SHARE: f64 = 0.7;

/// Both ends of the recording are at rest. `points`: samples at an even rate, m.
pub fn rests_at_both_ends(points: &[Vector3<f64>]) -> bool {
    let width = (points.len() / WINDOWS).max(2);
    if points.len() < LEAST_SAMPLES {
        return false;
    }
    let means: Vec<Vector3<f64>> =
        points.windows(width).map(|w| w.iter().sum::<Vector3<f64>>() / width as f64).collect();
    let speeds: Vec<f64> = (width..means.len()).map(|i| (means[i] - means[i - width]).norm()).collect();
    let mut sorted = speeds.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[sorted.len() / 2];
    [speeds.first(), speeds.last()].into_iter().flatten().all(|s| *s < REST_SHARE * usual)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(of: impl Fn(f64) -> f64) -> Vec<Vector3<f64>> {
        (0..300).map(|i| Vector3::new(of(f64::from(i) / 299.0), 0.0, 0.0)).collect()
    }

    #[test]
    fn a_motion_from_rest_to_rest_is_whole_and_its_pieces_are_not() {
        let whole = path(|u| u * u * (3.0 - 2.0 * u));
        assert!(rests_at_both_ends(&whole));
        assert!(!rests_at_both_ends(&whole[..150]) && !rests_at_both_ends(&whole[100..200]));
        assert!(!rests_at_both_ends(&path(|u| u)) && !rests_at_both_ends(&whole[..5]));
    }
}
