//! Slips of the fingers on a standing block: the height of the grip changes although nothing moves it. Plain least
//! squares search everywhere first, then closely around the best place. The fit takes such slips out of heights; a
//! diagnosis names them.

use std::ops::Range;

/// Durations of a slip in the search for the best place, s.
/// Choice: no case of the ablation reads it.
const SEARCHED_S: [f64; 9] = [0.0, 0.02, 0.05, 0.08, 0.1, 0.13, 0.17, 0.23, 0.3];
/// Largest number of starts of that search in one rest.
/// Choice: no case of the ablation reads it.
const MOST_STARTS: usize = 60;
/// Number of rounds in which the best place is approached.
/// Choice: no case of the ablation reads it.
const APPROACH_ROUNDS: usize = 8;
/// Size of a round's steps, as a share of those of the round before.
/// Choice: no case of the ablation reads it.
const SHRINKS: f64 = 0.6;
/// Least share of a slip between the first and the last row of its rest: with less, any slip would fit.
/// Choice: no case of the ablation reads it.
const SEEN_SHARE: f64 = 0.3;
/// Least share of a regressor that is not in the model's own space.
/// Choice: no case of the ablation reads it.
const OWN: f64 = 1e-3;
/// Relative uncertainty (one standard deviation) of the part of a slip before its rest's first row: it need not be
/// even.
/// Choice: no case of the ablation reads it.
const UNSEEN: f64 = 0.3;
/// Deviation of a slip's rows from an even slip, as a share of its way.
/// Choice: no case of the ablation reads it.
const SHAPE: f64 = 0.05;
/// Least way of a slip, as a share of the object's size. Turns of blocks in the grasp and their unevenness stay below it.
/// Choice: no case of the ablation reads it.
pub const LEAST: f64 = 0.015;

/// Largest range of heights, as a share of the object's size: with more the block does not stand in the grip, whatever
/// the states say.
/// Choice: no case of the ablation reads it.
const STANDS: f64 = 0.25;

/// True if heights of the grip can be those over a standing block of this size.
pub fn may_stand(heights_m: impl Iterator<Item = f64>, object_m: f64) -> bool {
    let (low, high) = heights_m.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    high - low < STANDS * object_m
}

/// The ramp of one slip as the rows would show it.
#[derive(Clone, Copy, Debug)]
pub struct Slip {
    /// Index of the rest.
    pub rest: usize,
    /// Beginning, s.
    pub start_s: f64,
    /// Duration, s.
    pub length_s: f64,
}

/// One end of a carry among the rows.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Rows of this end.
    pub rows: Range<usize>,
    /// From when the block stands, s.
    pub from_s: f64,
}

/// Heights of the grip while blocks stand, rest by rest.
pub struct Heights<'a> {
    /// Times of the rows, s.
    pub time_s: &'a [f64],
    /// Heights of the grip, m.
    pub height_m: &'a [f64],
    /// Half of the window that the heights are means over, s.
    pub half_s: f64,
    /// Ends of the carries.
    pub rests: &'a [Stretch],
}

/// A slip that was tried.
#[derive(Clone, Copy, Debug)]
pub struct Tried {
    /// Ramp of the slip.
    pub slip: Slip,
    /// Estimated way of the slip, m.
    pub way_m: f64,
    /// Decrease of the residual sum of squares by the slip, m².
    pub taken_m2: f64,
}

/// Residual of a model of the heights.
pub struct Left {
    own: Vec<Vec<f64>>,
    /// Row by row, m.
    pub left_m: Vec<f64>,
}

impl Slip {
    /// Share of its way that is done at a time.
    pub fn done(self, time_s: f64) -> f64 {
        let since = time_s - self.start_s;
        if self.length_s > 0.0 { (since / self.length_s).clamp(0.0, 1.0) } else { f64::from(u8::from(since >= 0.0)) }
    }

    /// The same in the mean over a filter's window: the part that a row shows.
    pub fn shown(self, time_s: f64, half_s: f64) -> f64 {
        /// Places in the window, as shares of its half, and how much they count.
        /// Derived: the parabola 1 − x² at five evenly spaced places.
        const WINDOW: [(f64, f64); 5] = [(-0.8, 0.36), (-0.4, 0.84), (0.0, 1.0), (0.4, 0.84), (0.8, 0.36)];
        let weights: f64 = WINDOW.iter().map(|(_, w)| w).sum();
        WINDOW.iter().map(|(at, w)| w * self.done(time_s + at * half_s)).sum::<f64>() / weights
    }
}

/// True if enough of the slip lies within the rows; the part before the first row is in the rest's own height.
pub fn is_seen(column: &[f64]) -> bool {
    column.last().zip(column.first()).is_some_and(|(last, first)| last - first > SEEN_SHARE)
}

impl Heights<'_> {
    /// Regressor of a slip in the rows of its own rest.
    pub fn column(&self, slip: Slip) -> Vec<f64> {
        self.rests[slip.rest].rows.clone().map(|i| slip.shown(self.time_s[i], self.half_s)).collect()
    }

    /// The first and the last time at which a slip of a rest may begin, s: the load shows the contact late, and through a filter.
    pub fn bounds(&self, rest: usize) -> (f64, f64) {
        let Stretch { rows, from_s } = &self.rests[rest];
        (from_s - self.half_s, self.time_s[rows.end - 1])
    }

    /// Times in a rest at which a slip may begin: its beginning, and those of its rows.
    pub fn starts(&self, rest: usize, most: usize) -> Vec<f64> {
        let Stretch { rows, from_s } = &self.rests[rest];
        let mut found = vec![from_s - 0.5 * self.half_s];
        found.extend(rows.clone().step_by(rows.len().div_ceil(most).max(1)).map(|i| self.time_s[i]));
        found.dedup();
        found
    }

    /// Residual of `model`, given as its regressors.
    pub fn left(&self, model: &[Vec<f64>]) -> Left {
        let own = orthonormal(model);
        let mut left_m = self.height_m.to_vec();
        for unit in &own {
            let share = dot(unit, &left_m, 0..left_m.len());
            left_m.iter_mut().zip(unit).for_each(|(l, u)| *l -= share * u);
        }
        Left { own, left_m }
    }

    /// A slip beside the model; `None` of which too little would be seen.
    pub fn tried(&self, Left { own, left_m }: &Left, slip: Slip) -> Option<Tried> {
        let range = self.rests[slip.rest].rows.clone();
        let column = self.column(slip);
        let along = |of: &[f64]| column.iter().zip(&of[range.clone()]).map(|(c, v)| c * v).sum::<f64>();
        let whole = column.iter().map(|c| c * c).sum::<f64>();
        let beside = whole - own.iter().map(|unit| along(unit).powi(2)).sum::<f64>();
        let way_m = along(left_m) / beside;
        (is_seen(&column) && beside > OWN * whole).then_some(Tried { slip, way_m, taken_m2: way_m * way_m * beside })
    }

    fn most(&self, left: &Left, slips: impl Iterator<Item = Slip>) -> Option<Tried> {
        slips.filter_map(|slip| self.tried(left, slip)).max_by(|a, b| a.taken_m2.total_cmp(&b.taken_m2))
    }

    /// The slip that decreases the residual sum of squares most; in the rests that are `asked` for.
    pub fn best(&self, left: &Left, asked: &dyn Fn(usize) -> bool) -> Option<Tried> {
        let everywhere = (0..self.rests.len()).filter(|rest| asked(*rest)).flat_map(|rest| {
            let starts = self.starts(rest, MOST_STARTS);
            starts.into_iter().flat_map(move |start_s| SEARCHED_S.map(|length_s| Slip { rest, start_s, length_s }))
        });
        let mut best = self.most(left, everywhere)?;
        let mut step = 1.0;
        for _ in 0..APPROACH_ROUNDS {
            let near = self.most(left, self.about(best.slip, step).into_iter());
            best = near.filter(|b| b.taken_m2 > best.taken_m2).unwrap_or(best);
            step *= SHRINKS;
        }
        Some(best)
    }

    /// A slip's way and its error, m, one standard deviation, with its time and its duration open. Rows a filter window
    /// apart tell its end and its slope better than its beginning, and the part before the first of them is unseen.
    /// `variance_m2`: of the rows' noise.
    pub fn way_m(&self, left: &Left, best: Tried, variance_m2: f64) -> (f64, f64) {
        let variance_m2 = variance_m2 + (SHAPE * best.way_m).powi(2);
        let mut sums = [0.0; 3];
        for slip in self.likely(best.slip) {
            let Some(other) = self.tried(left, slip) else { continue };
            let weight = (-0.5 * (best.taken_m2 - other.taken_m2).max(0.0) / variance_m2.max(1e-30)).exp();
            let before = self.column(slip).first().copied().unwrap_or(0.0);
            let square = other.way_m.powi(2) * (1.0 + (UNSEEN * before).powi(2));
            sums = [sums[0] + weight, sums[1] + weight * other.way_m, sums[2] + weight * square];
        }
        if sums[0] <= 0.0 {
            return (best.way_m, best.way_m.abs());
        }
        let mean = sums[1] / sums[0];
        (mean, (sums[2] / sums[0] - mean * mean).max(0.0).sqrt().hypot(SHAPE * mean))
    }

    /// Slips that begin and end within half a window of this one, and all that begin earlier and end with it.
    fn likely(&self, best: Slip) -> Vec<Slip> {
        /// Number of steps between the first and the latest start.
        /// Choice: no case of the ablation reads it.
        const START_STEPS: usize = 12;
        let (first_s, last_s) = self.bounds(best.rest);
        let latest_s = (best.start_s + 0.5 * self.half_s).min(last_s).max(first_s);
        let start = |k: usize| first_s + (latest_s - first_s) * k as f64 / START_STEPS as f64;
        // A rest is long, and so may be the part before a slip within it.
        let earliest_s = best.start_s - 2.0 * self.half_s - best.length_s;
        let starts = (0..=START_STEPS).map(start).filter(|s| *s >= earliest_s);
        let near = (-4..=2).map(|k| (best.start_s + 0.25 * f64::from(k) * self.half_s).clamp(first_s, latest_s));
        let with = |start_s: f64| {
            [-0.5, -0.25, 0.0, 0.25, 0.5].map(|e| {
                let end_s = best.start_s + best.length_s + e * self.half_s;
                Slip { start_s, length_s: (end_s - start_s).max(0.0), ..best }
            })
        };
        starts.chain(near).flat_map(with).collect()
    }

    /// Slips that begin a little earlier or later and take a little more or less time.
    fn about(&self, slip: Slip, step: f64) -> Vec<Slip> {
        let (first_s, last_s) = self.bounds(slip.rest);
        let starts = [-1.0, 0.0, 1.0].map(|s| (slip.start_s + s * step * self.half_s).clamp(first_s, last_s));
        let lengths = [-0.3, 0.0, 0.3].map(|s| (slip.length_s * (1.0 + s * step)).max(0.0));
        let with = |start_s: f64| lengths.map(|length_s| Slip { start_s, length_s, ..slip });
        starts.into_iter().flat_map(with).collect()
    }
}

fn dot(a: &[f64], b: &[f64], range: Range<usize>) -> f64 {
    range.map(|i| a[i] * b[i]).sum()
}

/// An orthonormal basis of the space of the columns (Gram and Schmidt, twice); a column nearly in that of the others is
/// left out.
fn orthonormal(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    for column in columns {
        let n = column.len();
        let mut unit = column.clone();
        let size = dot(&unit, &unit, 0..n);
        for _ in 0..2 {
            for other in &found {
                let share = dot(other, &unit, 0..n);
                unit.iter_mut().zip(other).for_each(|(u, o)| *u -= share * o);
            }
        }
        let left = dot(&unit, &unit, 0..n);
        if left > 1e-12 * size {
            for u in &mut unit {
                *u /= left.sqrt();
            }
            found.push(unit);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF_S: f64 = 0.018;

    /// Two rests of twelve rows; in the second one the grip goes down by `way_m` from `start_s` on within `length_s`, slowly at first and at last.
    fn rows(start_s: f64, length_s: f64, way_m: f64) -> (Vec<f64>, Vec<f64>) {
        let time_s: Vec<f64> = (0..24).map(|i| f64::from(i % 12) * 2.0 * HALF_S + f64::from(i / 12) * 3.0).collect();
        let done = |t: f64| {
            let u = ((t - start_s) / length_s).clamp(0.0, 1.0);
            u * u * (3.0 - 2.0 * u)
        };
        let mean = |t: f64| (-4..=4).map(|k| done(t + f64::from(k) * 0.25 * HALF_S)).sum::<f64>() / 9.0;
        // A deterministic stand-in for noise of 5 µm.
        let height = |t: f64| 0.1 + 5e-6 * (t * 1234.567).sin() + way_m * mean(t);
        (time_s.clone(), time_s.into_iter().map(height).collect())
    }

    /// The way that is found of it and its error, m. The second rest stands from 3 s − `HALF_S` on.
    fn found(start_s: f64, length_s: f64, way_m: f64) -> (f64, f64) {
        let (time_s, height_m) = rows(start_s, length_s, way_m);
        let rests = [Stretch { rows: 0..12, from_s: -HALF_S }, Stretch { rows: 12..24, from_s: 3.0 - HALF_S }];
        let heights = Heights { time_s: &time_s, height_m: &height_m, half_s: HALF_S, rests: &rests };
        let of = |rest: usize| (0..24).map(|i| f64::from(u8::from(i / 12 == rest))).collect::<Vec<f64>>();
        let left = heights.left(&[of(0), of(1)]);
        let best = heights.best(&left, &|_| true).expect("a slip");
        assert_eq!(best.slip.rest, 1, "{best:?}");
        heights.way_m(&left, best, 2.5e-11)
    }

    #[test]
    fn a_slip_in_the_middle_of_a_rest_is_known_well() {
        for start_s in [3.1, 3.12, 3.15, 3.2] {
            let (way_m, error_m) = found(start_s, 0.08, -1.3e-3);
            assert!(
                (way_m + 1.3e-3).abs() < 3e-5_f64.max(2.0 * error_m) && error_m < 8e-5,
                "{start_s}: {way_m} {error_m}"
            );
        }
    }

    #[test]
    fn what_a_slip_did_before_its_rest_is_open() {
        for start_s in [2.97, 2.98, 2.99] {
            let (way_m, error_m) = found(start_s, 0.08, -1.3e-3);
            assert!((way_m + 1.3e-3).abs() < 3.0 * error_m, "{start_s}: {way_m} {error_m}");
            assert!((5e-5..4e-4).contains(&error_m), "{start_s}: {error_m}");
        }
    }

    #[test]
    fn what_goes_away_with_the_fingers_does_not_stand() {
        assert!(may_stand([0.1, 0.1012].into_iter(), 0.02) && !may_stand([0.1, 0.13].into_iter(), 0.02));
    }
}
