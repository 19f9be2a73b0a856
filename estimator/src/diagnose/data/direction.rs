//! Direction of motion: the slower the motion, the less certain a noisy velocity makes its sign.

use super::regression_data::{Place, Row, Track};

/// Least width of the blur of the direction, as a share of the usual speed.
/// Choice: halved, 1 of 43 answers change; doubled, 8 of 43 answers change.
const BLUR: f64 = 0.008;
/// Time over which the direction is blurred if inertia is in the model, whose force jumps together with the friction's.
/// Choice: halved, 0 of 19 answers change; doubled, 1 of 19 answers change.
const BLUR_OF_MASS: f64 = 0.012;
/// Time over which the direction is blurred if there is no force channel whose clock could differ.
/// Choice: no case of the ablation reads it.
const BLUR_OF_FREE: f64 = 0.004;
/// A reversal may be at any point between two rows: standard deviation of its position, in rows.
/// Derived: half a row, the farthest that a reversal can lie from the middle between two rows.
const SKEW: f64 = 0.5;
/// Difference of the clocks of force and motion, s.
/// Choice: halved, 8 of 57 answers change (7 to wrong); doubled, 0 of 62 answers change.
pub(crate) const CLOCKS_S: f64 = 1e-3;
/// Number of sticking rows that count as one observation. Rows of a mechanism overlap, and none of them sticks alone.
/// Choice: halved, 1 of 43 answers change; doubled, 0 of 43 answers change.
pub const STICKING_ROWS_TOGETHER: f64 = 3.0;
/// Uncertainty of the direction above which a row counts as standing.
/// Choice: halved, 0 of 62 answers change; doubled, 1 of 62 answers change.
pub const STANDS: f64 = 0.4;
/// Share of the squared friction that stays uncertain in a row with a reversal at a known position.
/// Choice: halved or doubled, none of 62 answers changes.
const REVERSAL: f64 = 0.05;

/// Sets the direction of motion of each row and its uncertainty, from the noise of the velocity and the clocks of the
/// channels.
pub fn blur(track: &mut Track) {
    let fast = track.quantile(0.9, |r| r.motion.velocity.abs());
    let (noise, period_s) = (track.velocity_noise, track.period_s);
    let together = if track.planar { STICKING_ROWS_TOGETHER } else { 1.0 };
    let (share, clocks_s) = match (track.freely, track.planar) {
        (Some(_), _) => (BLUR_OF_FREE, 0.0),
        (None, true) => (BLUR, CLOCKS_S),
        (None, false) => (BLUR_OF_MASS, CLOCKS_S),
    };
    let width = |skew: f64| 1.2 * (share * fast).hypot(noise).hypot(skew).max(f64::MIN_POSITIVE);
    for k in 0..track.fine.len() {
        let next =
            if k + 1 < track.fine.len() && track.fine[k + 1].segment == track.fine[k].segment { k + 1 } else { k };
        let before = if k > 0 && track.fine[k - 1].segment == track.fine[k].segment { k - 1 } else { k };
        let apart_s = (track.fine[next].time_s - track.fine[before].time_s).max(1e-9);
        let acceleration = (track.fine[next].velocity - track.fine[before].velocity) / apart_s;
        let share = track.fine[k].velocity / width(clocks_s * acceleration);
        track.fine[k].direction = share.tanh();
        track.fine[k].open = 1.0 - share.tanh().powi(2);
    }
    for row in track.rows.iter_mut().filter(|r| r.place == Place::Along) {
        if row.span.len == 0 {
            let share = row.motion.velocity / width(SKEW * row.motion.acceleration * period_s);
            row.motion.direction = share.tanh();
            row.open = 1.0 - share.tanh().powi(2);
            continue;
        }
        let (mut sum, mut open) = (0.0, 0.0);
        for (k, weight) in row.span.weights() {
            sum += weight * track.fine[k].direction;
            open += weight * track.fine[k].open;
        }
        row.motion.direction = sum;
        // The position of a reversal within the row is uncertain because the clocks and filters of the channels differ.
        row.open = open + REVERSAL / together * (1.0 - sum * sum - open).max(0.0);
    }
    stand_together(track, together);
}

/// Part of the dry friction (`dry`, by row) that the blur of the direction removes where the velocity is certain.
pub fn blurred(track: &Track, dry: &[f64]) -> Vec<f64> {
    let of = |(row, dry): (&Row, &f64)| {
        if row.place == Place::Along { dry * track.mean(row, &|m| m.velocity.signum() - m.direction) } else { 0.0 }
    };
    track.rows.iter().zip(dry).map(of).collect()
}

/// Counts consecutive standing rows as one observation, because a hand keeps holding the same load. `together`: number
/// of rows that already count as one.
fn stand_together(track: &mut Track, together: f64) {
    let stands = |row: &Row| row.place == Place::Along && row.open > STANDS;
    let mut first = 0;
    while first < track.rows.len() {
        let mut end = first + 1;
        while end < track.rows.len() && stands(&track.rows[first]) && stands(&track.rows[end]) && track.follows(end) {
            end += 1;
        }
        let more = ((end - first) as f64 / together).max(1.0);
        track.rows[first..end].iter_mut().filter(|r| r.open > STANDS).for_each(|r| r.open *= more);
        first = end;
    }
}
