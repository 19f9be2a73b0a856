//! Sizes beside the noise: measure, rescale, perform again.

use blind::measure::project_out;

/// A ratio counts as reached within this share of it.
///
/// Choice: ten times closer than the steps between wanted ratios.
const CLOSE: f64 = 0.05;
/// Beyond this share the case is missed, as in the crate `blind`.
///
/// Choice: closer than two wanted ratios stand to each other.
const MISSED: f64 = 0.1;
/// Attempts to reach the wanted sizes.
///
/// Choice: a staircase of three treads needs more than a straight line.
const ATTEMPTS: usize = 8;

/// Sizes of what is hidden, and the ratios that came out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scaled {
    /// Size of each.
    pub sizes: Vec<f64>,
    /// Effect over noise of each.
    pub ratios: Vec<f64>,
    /// One of them could not be had.
    pub is_missed: bool,
}

/// Rescales until each ratio is as wanted: the sizes of the attempt that came closest.
pub fn scaled(
    first: &[f64],
    wanted: &[f64],
    limited: &dyn Fn(usize, f64) -> f64,
    measure: &mut dyn FnMut(&[f64]) -> Vec<f64>,
) -> Scaled {
    let mut sizes: Vec<f64> = first.to_vec();
    let mut last: Vec<Option<(f64, f64)>> = vec![None; first.len()];
    let mut best = Scaled { is_missed: true, ..Scaled::default() };
    let mut least = f64::INFINITY;
    for _ in 0..ATTEMPTS {
        let ratios = measure(&sizes);
        let off = ratios.iter().zip(wanted).map(|(r, w)| (r / w - 1.0).abs()).fold(0.0, f64::max);
        if off < least {
            least = off;
            best = Scaled { sizes: sizes.clone(), ratios: ratios.clone(), is_missed: off > MISSED };
        }
        if off < CLOSE {
            break;
        }
        for (k, size) in sizes.iter_mut().enumerate() {
            let now = ratios[k].max(1e-9);
            // How the ratio grows with the size: proportionally, until two sizes were tried.
            let power = last[k].map_or(1.0, |(s, r)| {
                let slope = (now / r).ln() / (*size / s).ln();
                if slope.is_finite() { slope.clamp(0.35, 2.5) } else { 1.0 }
            });
            last[k] = Some((*size, now));
            *size = limited(k, *size * (wanted[k] / now).powf(1.0 / power).clamp(0.05, 20.0));
        }
    }
    best
}

/// Root mean square of rows after columns took what they can.
pub fn rms_beside(mut rows: Vec<f64>, columns: Vec<Vec<f64>>) -> f64 {
    project_out(&mut rows, columns);
    rms(&rows)
}

/// Root mean square; 0 of none.
pub fn rms(rows: &[f64]) -> f64 {
    (rows.iter().map(|v| v * v).sum::<f64>() / rows.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_come_out_as_wanted_or_are_missed() {
        let any = |_: usize, size: f64| size;
        let mut law = |sizes: &[f64]| vec![3.0 * sizes[0].powf(1.4), (0.5 * sizes[1]).min(2.0)];
        let done = scaled(&[1.0, 1.0], &[4.0, 1.0], &any, &mut law);
        assert!(!done.is_missed && (done.ratios[0] / 4.0 - 1.0).abs() < 0.05, "{done:?}");
        assert!(scaled(&[1.0, 1.0], &[4.0, 3.0], &any, &mut law).is_missed);
    }
}
