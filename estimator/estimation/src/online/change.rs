//! Detection of parameter changes: a likelihood-ratio CUSUM on the innovations of a regression, two-sided, for every
//! parameter.
//!
//! The innovations are whitened by their own AR(1); a change of parameter j by δ adds δ x̃ⱼ to them. Each detector sums
//! the log likelihood ratio of the change to no change over the rows, and starts again at zero whenever the sum is
//! negative (Page 1954). A sum of likelihood ratios reaches h without a change at most once in eʰ rows on average
//! (Lorden 1971), whatever the rows x̃ are: that makes the false-alarm rate a statement, not a tuning. A single row
//! counts no more than [`MOST_A_ROW`], so that a knock is no change.
//!
//! No model is exact. Changes are looked for above a least size that matters; half of it is overlooked for ever.

/// Sizes of changes that are looked for, in standard deviations of the noise by the typical row.
const SIZES: [f64; 2] = [0.4, 1.5];
/// Largest contribution of one row to the logarithm of the likelihood ratio.
const MOST_A_ROW: f64 = 5.0;
/// Innovations beyond this many standard deviations teach nothing about the noise.
const CLIP: f64 = 7.0;
/// Number of rows from which noise and correlation must be known before anything is tested.
const WARM_UP: u32 = 24;
/// Rows over which noise and correlation are remembered.
const MEMORY: f64 = 1500.0;
/// The noise is known to a share of 1/√(2 n) only; taking it for smaller than it is would break the stated rate.
fn caution(rows: u32) -> f64 {
    1.03 + 1.5 / f64::from(rows.max(1)).sqrt()
}

/// A change of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Index of the parameter.
    pub parameter: usize,
    /// Up or down.
    pub grows: bool,
    /// Time of detection, s.
    pub noticed_s: f64,
    /// Time of the beginning, as far as the sums tell, s.
    pub began_s: f64,
}

/// The detectors of P parameters.
#[derive(Clone, Debug)]
pub struct ChangeDetector<const P: usize> {
    limit: f64,
    least: [f64; P],
    /// Sum of each detector, and when it was last at zero.
    sums: [[[f64; 2]; SIZES.len()]; P],
    since: [[[f64; 2]; SIZES.len()]; P],
    /// Mean squares of innovations, their products with the one before, and of whitened columns.
    power: f64,
    lagged: f64,
    columns: [f64; P],
    weight: f64,
    seen: u32,
    before: Option<([f64; P], f64)>,
}

impl<const P: usize> ChangeDetector<P> {
    /// `false_alarms_per_hour`: upper bound of the rate without any change, for rows `row_s` seconds apart. `least`: sizes of changes that
    /// matter, in the units of the parameters; infinite: changes of that one are not looked for.
    pub fn new(false_alarms_per_hour: f64, row_s: f64, least: [f64; P]) -> Self {
        let tests = (P * 2 * SIZES.len()) as f64;
        let rows_an_hour = 3600.0 / row_s.max(1e-6);
        Self {
            limit: (tests * rows_an_hour / false_alarms_per_hour.max(1e-12)).ln().max(1.0),
            least,
            sums: [[[0.0; 2]; SIZES.len()]; P],
            since: [[[0.0; 2]; SIZES.len()]; P],
            power: 0.0,
            lagged: 0.0,
            columns: [0.0; P],
            weight: 0.0,
            seen: 0,
            before: None,
        }
    }

    /// Takes in a row with its innovation (already over √(1 + `leverage`)), and says when something changed.
    pub fn push(&mut self, time_s: f64, row: &[f64; P], residual: f64, leverage: f64) -> Option<Change> {
        let scale = (1.0 + leverage).sqrt();
        let row = row.map(|v| v / scale);
        if !(residual.is_finite() && row.iter().all(|v| v.is_finite())) {
            return None;
        }
        let (row_before, residual_before) = self.before.replace((row, residual))?;
        let rho = if self.power > 0.0 { (self.lagged / self.power).clamp(-0.5, 0.98) } else { 0.0 };
        let noise = (self.power / self.weight.max(1e-9) * (1.0 - rho * rho)).sqrt() * caution(self.seen);
        let white: [f64; P] = std::array::from_fn(|j| row[j] - rho * row_before[j]);
        let found = if self.seen >= WARM_UP && noise > 0.0 {
            self.test(time_s, &white, (residual - rho * residual_before) / noise, noise)
        } else {
            None
        };
        self.learn(&white, residual, residual_before, noise);
        if found.is_some() {
            self.restart(time_s);
        }
        found
    }

    fn learn(&mut self, white: &[f64; P], residual: f64, before: f64, noise: f64) {
        let keep = 1.0 - 1.0 / MEMORY;
        // A knock must not make the detectors deaf.
        let most = if self.seen >= WARM_UP { CLIP * noise.max(1e-300) } else { f64::INFINITY };
        let (residual, before) = (residual.clamp(-most, most), before.clamp(-most, most));
        self.power = keep * self.power + residual * residual;
        self.lagged = keep * self.lagged + residual * before;
        self.weight = keep * self.weight + 1.0;
        for (sum, x) in self.columns.iter_mut().zip(white) {
            *sum = keep * *sum + x * x;
        }
        self.seen = self.seen.saturating_add(1);
    }

    fn test(&mut self, time_s: f64, white: &[f64; P], innovation: f64, noise: f64) -> Option<Change> {
        let mut found: Option<(f64, Change)> = None;
        for (j, x) in white.iter().enumerate() {
            let typical = (self.columns[j] / self.weight).sqrt();
            if typical <= 0.0 || self.least[j].is_infinite() {
                continue;
            }
            for (s, share) in SIZES.iter().enumerate() {
                // In standard deviations by the parameter's own unit.
                let size = (share / typical).max(self.least[j] / noise);
                for (d, way) in [1.0, -1.0].into_iter().enumerate() {
                    let step = way * size * x;
                    let sum = self.sums[j][s][d] + (step * innovation - 0.5 * step * step).min(MOST_A_ROW);
                    if sum <= 0.0 {
                        (self.sums[j][s][d], self.since[j][s][d]) = (0.0, time_s);
                        continue;
                    }
                    self.sums[j][s][d] = sum;
                    if sum > self.limit && found.is_none_or(|(best, _)| sum > best) {
                        let began_s = self.since[j][s][d];
                        found = Some((sum, Change { parameter: j, grows: d == 0, noticed_s: time_s, began_s }));
                    }
                }
            }
        }
        found.map(|(_, change)| change)
    }

    /// All sums at zero again; the estimate of the noise stays.
    pub fn restart(&mut self, time_s: f64) {
        self.sums = [[[0.0; 2]; SIZES.len()]; P];
        self.since = [[[time_s; 2]; SIZES.len()]; P];
        self.before = None;
    }
}
