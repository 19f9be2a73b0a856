//! Returns of a path to earlier places: a guide leads back along itself, a free hand crosses its way.

use super::circle::Arc;
use super::frame::Frame;
use haptics::Vec2;

/// Least way between two places that are compared, as a share of the extent.
const APART_SHARE: f64 = 0.12;
/// Largest distance of two such places, as a share of the extent.
const NEAR_SHARE: f64 = 0.06;
/// Length on either side over which the direction of the path is taken, as a share of the extent.
const TANGENT_SHARE: f64 = 0.025;
/// Least such length, in multiples of the noise.
const TANGENT_NOISES: f64 = 8.0;
/// Passes that meet at a larger angle cross, sine.
const CROSSING_SINE: f64 = 0.5;
/// Passes that meet at a smaller one go along each other.
const ALONG_SINE: f64 = 0.3;
/// Fewer meetings tell nothing.
const LEAST_MEETINGS: usize = 12;

/// Places to which the path comes back.
#[derive(Clone, Debug, Default)]
pub struct Retrace {
    /// Share of the points beside which another pass goes along.
    pub along_share: f64,
    /// Root mean square distance between passes there, m.
    pub apart_m: f64,
    /// Places where the path crosses itself.
    pub crossings: usize,
    /// Root mean square over the meetings of the mean of both passes' distance from the arc, m: their common part.
    pub common_m: f64,
    /// Root mean square of half the difference of both passes' distance from the arc, m.
    pub differing_m: f64,
}

impl Retrace {
    /// Compares all passes of the path; `arc` is the circle or line that was fitted.
    pub fn of(frame: &Frame, arc: &Arc) -> Self {
        let points = &frame.flat;
        let travelled = travelled(points);
        let tangents =
            tangents(points, &travelled, (TANGENT_SHARE * frame.extent_m).max(TANGENT_NOISES * frame.noise_m));
        let (apart, near) = (APART_SHARE * frame.extent_m, NEAR_SHARE * frame.extent_m);
        let (mut along, mut crossing) = (Vec::new(), Vec::new());
        for (i, p) in points.iter().enumerate() {
            let Some(tangent) = tangents[i] else { continue };
            let normal = Vec2::new(-tangent.y, tangent.x);
            let mut nearest: Option<(f64, f64, f64)> = None;
            for j in 1..points.len() {
                if (travelled[j] - travelled[i]).abs() < apart || (travelled[j - 1] - travelled[i]).abs() < apart {
                    continue;
                }
                let (a, b) = (points[j - 1] - p, points[j] - p);
                let (s, t) = (tangent.dot(&a), tangent.dot(&b));
                if s * t > 0.0 || s == t {
                    continue;
                }
                let share = s / (s - t);
                let distance = normal.dot(&(a + (b - a) * share));
                let Some(other) = tangents[j] else { continue };
                if distance.abs() < near && nearest.is_none_or(|n| distance.abs() < n.0.abs()) {
                    let q = p + normal * distance;
                    nearest = Some((distance, (tangent.x * other.y - tangent.y * other.x).abs(), arc.distance(q)));
                }
            }
            let Some((distance, sine, other)) = nearest else { continue };
            if sine < ALONG_SINE {
                along.push((distance, arc.distance(*p), other));
            } else if sine > CROSSING_SINE {
                crossing.push(i);
            }
        }
        let n = along.len() as f64;
        if along.len() < LEAST_MEETINGS {
            return Self { crossings: runs(&crossing), ..Self::default() };
        }
        let root = |of: &dyn Fn(&(f64, f64, f64)) -> f64| (along.iter().map(|m| of(m).powi(2)).sum::<f64>() / n).sqrt();
        Self {
            along_share: n / points.len() as f64,
            apart_m: root(&|m| m.0),
            crossings: runs(&crossing),
            common_m: root(&|m| 0.5 * (m.1 + m.2)),
            differing_m: root(&|m| 0.5 * (m.1 - m.2)),
        }
    }
}

fn travelled(points: &[Vec2]) -> Vec<f64> {
    let mut sum = 0.0;
    points
        .iter()
        .enumerate()
        .map(|(i, p)| {
            sum += if i > 0 { (p - points[i - 1]).norm() } else { 0.0 };
            sum
        })
        .collect()
}

/// Directions over `reach` on either side; `None` where the path turns round within that.
fn tangents(points: &[Vec2], travelled: &[f64], reach: f64) -> Vec<Option<Vec2>> {
    (0..points.len())
        .map(|i| {
            let first = travelled.partition_point(|t| *t < travelled[i] - reach);
            let last = travelled.partition_point(|t| *t <= travelled[i] + reach).saturating_sub(1).max(i);
            // At least one neighbour on either side.
            let (first, last) = (first.min(i.saturating_sub(1)), last.max((i + 1).min(points.len() - 1)));
            let chord = points[last] - points[first];
            // A way much longer than its chord is a turning point or a knot.
            (chord.norm() > 0.5 * (travelled[last] - travelled[first])).then(|| chord.normalize())
        })
        .collect()
}

/// Runs of neighbouring indices: one crossing is seen from several points. Each is seen from both passes.
fn runs(indices: &[usize]) -> usize {
    let starts = indices.iter().enumerate().filter(|(k, i)| *k == 0 || **i > indices[k - 1] + 3).count();
    starts.div_ceil(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn retrace(path: impl Fn(f64) -> (f64, f64)) -> Retrace {
        let points: Vec<Vector3<f64>> =
            (0..800).map(|i| path(f64::from(i) / 799.0)).map(|(x, y)| Vector3::new(x, y, 0.0)).collect();
        let frame = Frame::new(&points, true).expect("it moves");
        let arc = super::super::circle::fit(&frame.flat, frame.extent_m).0;
        Retrace::of(&frame, &arc)
    }

    /// 0 → 1 → 0 → 1.
    fn three_times(u: f64) -> f64 {
        let u = 3.0 * u;
        if u < 1.0 {
            u
        } else if u < 2.0 {
            2.0 - u
        } else {
            u - 2.0
        }
    }

    #[test]
    fn a_slot_that_is_followed_three_times_leads_back_along_itself() {
        let slot = |u: f64| (0.3 * u, 0.04 * (6.0 * u).sin());
        let found = retrace(|u| slot(three_times(u)));
        assert!(found.along_share > 0.8 && found.apart_m < 1e-4 && found.crossings == 0, "{found:?}");
        assert!(found.common_m > 20.0 * found.differing_m, "{found:?}");
        let once = retrace(slot);
        assert!(once.along_share < 0.01 && once.crossings == 0, "{once:?}");
    }

    #[test]
    fn a_wandering_hand_crosses_its_way() {
        let found = retrace(|u| (0.1 * (8.0 * u).sin(), 0.06 * (17.0 * u).sin()));
        assert!(found.crossings >= 2, "{found:?}");
    }
}
