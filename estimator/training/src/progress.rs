//! Progress of a trainee: means of sessions, the power law of practice, proficiency.
//!
//! Pure numbers: the input is attempts at one lesson under the same conditions, in the order in which they were made.

use statrs::distribution::{ContinuousCDF, FisherSnedecor, StudentsT};

/// Time without an attempt after which a session is over, s.
const PAUSE_S: f64 = 3_600.0;
/// Fewer attempts show no curve: it has three parameters.
const LEAST_ATTEMPTS: usize = 6;
/// Exponents that are tried, from hardly any bend to a fall within two attempts, evenly in the logarithm.
const EXPONENTS: (f64, f64, usize) = (0.05, 3.0, 120);
/// Share that an interval is to hold.
const CONFIDENCE: f64 = 0.95;
/// Number of attempts in a row that must meet the criterion.
const IN_A_ROW: usize = 2;

/// One attempt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Try {
    /// Start, s on any clock; one that was set back between two attempts puts no pause between them.
    pub began_s: f64,
    /// Quantity that is followed: a score, or a measure.
    pub value: f64,
    /// True if it met the lesson's criterion.
    pub meets_criterion: bool,
}

/// Attempts without a long pause between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Session {
    /// Its first attempt, and one past its last.
    pub first: usize,
    /// See above.
    pub end: usize,
    /// Mean of its values.
    pub mean: f64,
    /// Half of the 95 % interval of that mean (Student's t); nothing for a single attempt.
    pub half_width: Option<f64>,
}

/// Means of sessions.
pub fn sessions(tries: &[Try]) -> Vec<Session> {
    let mut found: Vec<Session> = Vec::new();
    let mut first = 0;
    for end in 1..=tries.len() {
        let is_over = tries.get(end).is_none_or(|next| next.began_s - tries[end - 1].began_s > PAUSE_S);
        if is_over {
            let values: Vec<f64> = tries[first..end].iter().map(|t| t.value).collect();
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
            let half_width = t_quantile(n - 1.0).map(|t| t * (variance / n).sqrt());
            found.push(Session { first, end, mean, half_width });
            first = end;
        }
    }
    found
}

/// The two-sided quantile of Student's t; nothing without a degree of freedom.
fn t_quantile(freedom: f64) -> Option<f64> {
    let t = StudentsT::new(0.0, 1.0, freedom).ok().filter(|_| freedom >= 1.0)?;
    Some(t.inverse_cdf(0.5 + 0.5 * CONFIDENCE))
}

/// The first attempt after which the trainee is proficient: with it the criterion was met twice in a row.
pub fn proficient_at(tries: &[Try]) -> Option<usize> {
    let together = tries.windows(IN_A_ROW).position(|some| some.iter().all(|t| t.meets_criterion))?;
    Some(together + IN_A_ROW - 1)
}

/// One point of a learning curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Number of the attempt, from 1.
    pub attempt: f64,
    /// The curve there.
    pub value: f64,
    /// 95 % interval of the curve, not of single attempts.
    pub interval: [f64; 2],
}

/// The power law of practice (Newell and Rosenbloom 1981) with an asymptote: y(n) = level + gain · n^−exponent.
///
/// Method: for every exponent of a grid, level and gain are a linear regression; the best exponent is that of least
/// squares. The interval of the exponent holds all whose squares an F test with one degree of freedom does not refuse
/// at 5 % (profile likelihood). The interval of the curve holds everything within the regression's t interval for any
/// of them. Attempts count alike and are taken for independent.
#[derive(Clone, Debug, PartialEq)]
pub struct LearningCurve {
    /// Asymptote after endless practice.
    pub level: f64,
    /// Difference of the first attempt from the asymptote; negative if values rise.
    pub gain: f64,
    /// Exponent of the decay.
    pub exponent: f64,
    /// 95 % interval of the exponent, within the grid.
    pub exponent_interval: [f64; 2],
    /// Scatter of single attempts about it, a standard deviation.
    pub scatter: f64,
    /// True if the values changed at all: an F test against a constant, at 5 %.
    pub is_seen: bool,
    accepted: Vec<Line>,
    t: f64,
}

/// Level and gain for one exponent, with their covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    exponent: f64,
    level: f64,
    gain: f64,
    squares: f64,
    /// Variance of the level, covariance, variance of the gain, in units of the scatter squared.
    spread: [f64; 3],
}

impl Line {
    fn fit(values: &[f64], exponent: f64) -> Option<Self> {
        let n = values.len() as f64;
        let x: Vec<f64> = (1..=values.len()).map(|k| (k as f64).powf(-exponent)).collect();
        let (mean_x, mean_y) = (x.iter().sum::<f64>() / n, values.iter().sum::<f64>() / n);
        let sxx: f64 = x.iter().map(|x| (x - mean_x).powi(2)).sum();
        let sxy: f64 = x.iter().zip(values).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        if sxx.is_nan() || sxx <= 1e-12 {
            return None;
        }
        let gain = sxy / sxx;
        let level = mean_y - gain * mean_x;
        let squares = x.iter().zip(values).map(|(x, y)| (y - level - gain * x).powi(2)).sum();
        let spread = [1.0 / n + mean_x * mean_x / sxx, -mean_x / sxx, 1.0 / sxx];
        Some(Self { exponent, level, gain, squares, spread })
    }

    /// The line's value at an attempt, and its variance in units of the scatter squared.
    fn at(&self, attempt: f64) -> (f64, f64) {
        let x = attempt.powf(-self.exponent);
        let [level, both, gain] = self.spread;
        (self.level + self.gain * x, level + 2.0 * both * x + gain * x * x)
    }
}

impl LearningCurve {
    /// The curve through values in the order of the attempts; nothing with fewer than six, or where all are the same.
    pub fn fit(values: &[f64]) -> Option<Self> {
        let n = values.len();
        if n < LEAST_ATTEMPTS || values.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let (low, high, steps) = EXPONENTS;
        let exponent = |k: usize| low * (high / low).powf(k as f64 / (steps - 1) as f64);
        let lines: Vec<Line> = (0..steps).filter_map(|k| Line::fit(values, exponent(k))).collect();
        let best = *lines.iter().min_by(|a, b| a.squares.total_cmp(&b.squares))?;
        let freedom = (n - 3) as f64;
        let variance = best.squares / freedom;
        let mean = values.iter().sum::<f64>() / n as f64;
        let constant: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        if constant <= 1e-18 * (1.0 + mean * mean) {
            return None;
        }
        let within = |first: f64| FisherSnedecor::new(first, freedom).ok().map(|f| f.inverse_cdf(CONFIDENCE));
        let (one, two) = (within(1.0)?, within(2.0)?);
        let accepted: Vec<Line> = lines.into_iter().filter(|l| l.squares <= best.squares + one * variance).collect();
        let exponents = accepted.iter().map(|l| l.exponent);
        let exponent_interval = [exponents.clone().fold(f64::INFINITY, f64::min), exponents.fold(0.0, f64::max)];
        Some(Self {
            level: best.level,
            gain: best.gain,
            exponent: best.exponent,
            exponent_interval,
            scatter: variance.sqrt(),
            is_seen: (constant - best.squares) / 2.0 > two * variance,
            accepted,
            t: t_quantile(freedom)?,
        })
    }

    /// The curve at an attempt, from 1; between attempts, too.
    pub fn at(&self, attempt: f64) -> CurvePoint {
        let value = self.level + self.gain * attempt.powf(-self.exponent);
        let mut interval = [value, value];
        for line in &self.accepted {
            let (value, spread) = line.at(attempt);
            let half = self.t * self.scatter * spread.max(0.0).sqrt();
            interval = [interval[0].min(value - half), interval[1].max(value + half)];
        }
        CurvePoint { attempt, value, interval }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tries(values: &[(f64, f64, bool)]) -> Vec<Try> {
        let of = |(began_s, value, meets_criterion): &(f64, f64, bool)| Try {
            began_s: *began_s,
            value: *value,
            meets_criterion: *meets_criterion,
        };
        values.iter().map(of).collect()
    }

    #[test]
    fn sessions_end_with_a_long_pause_and_have_students_interval() {
        let found =
            sessions(&tries(&[(0.0, 1.0, false), (600.0, 2.0, false), (1200.0, 3.0, false), (90_000.0, 7.0, false)]));
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].first, found[0].end, found[0].mean), (0, 3, 2.0));
        // t(0.975; 2) = 4.3027, standard deviation 1.
        assert!((found[0].half_width.expect("of three") - 4.302_65 / 3.0_f64.sqrt()).abs() < 1e-4);
        assert_eq!((found[1].mean, found[1].half_width), (7.0, None));
        assert!(sessions(&[]).is_empty());
        // The clock was set back by a day after the first one, and the sitting went on; so did the next one an hour and a half later.
        let back = [(90_000.0, 1.0, false), (4_000.0, 2.0, false), (4_060.0, 3.0, false), (9_500.0, 4.0, false)];
        assert_eq!(sessions(&tries(&back)).iter().map(|s| (s.first, s.end)).collect::<Vec<_>>(), [(0, 3), (3, 4)]);
    }

    #[test]
    fn proficiency_is_the_criterion_met_twice_in_a_row() {
        let met = |met: &[bool]| proficient_at(&tries(&met.iter().map(|m| (0.0, 0.0, *m)).collect::<Vec<_>>()));
        assert_eq!(met(&[true, false, true, true, false]), Some(3));
        assert_eq!(met(&[true, true]), Some(1));
        assert_eq!((met(&[true, false, true]), met(&[true]), met(&[])), (None, None, None));
    }

    /// Normal numbers by twelve even ones, from Lehmer's generator (1951).
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut state = 1 + seed * 7_919 % 0x7FFF_FFFE;
        move || {
            let mut draw = || {
                state = state * 48_271 % 0x7FFF_FFFF;
                state as f64 / f64::from(0x7FFF_FFFF_u32)
            };
            (0..12).map(|_| draw()).sum::<f64>() - 6.0
        }
    }

    #[test]
    fn a_law_without_noise_is_found_whether_values_fall_or_rise() {
        for (level, gain, exponent) in [(20.0, 40.0, 0.5), (95.0, -60.0, 1.0)] {
            let values: Vec<f64> = (1..=30).map(|n| level + gain * f64::from(n).powf(-exponent)).collect();
            let found = LearningCurve::fit(&values).expect("a curve");
            assert!((found.exponent / exponent - 1.0).abs() < 0.03, "{found:?}");
            assert!((found.level - level).abs() < 2.0 && found.is_seen);
            assert!((found.at(30.0).value - values[29]).abs() < 0.05);
        }
    }

    #[test]
    fn intervals_hold_the_truth_as_often_as_they_say() {
        let (level, gain, exponent) = (20.0, 30.0, 0.6);
        let (mut of_exponent, mut of_curve, cases) = (0, 0, 400_u32);
        for seed in 0..cases {
            let mut noise = noise(u64::from(seed) + 1);
            let truth = |n: f64| level + gain * n.powf(-exponent);
            let values: Vec<f64> = (1..=25).map(|n| truth(f64::from(n)) + 2.0 * noise()).collect();
            let found = LearningCurve::fit(&values).expect("a curve");
            let [low, high] = found.exponent_interval;
            of_exponent += u32::from((low..=high).contains(&exponent));
            let last = found.at(25.0);
            of_curve += u32::from((last.interval[0]..=last.interval[1]).contains(&truth(25.0)));
            assert!(last.interval[0] <= last.value && last.value <= last.interval[1]);
        }
        let share = |count: u32| f64::from(count) / f64::from(cases);
        assert!((0.92..=0.99).contains(&share(of_exponent)), "exponent {}", share(of_exponent));
        // The union over exponents is wide rather than narrow.
        assert!(share(of_curve) >= 0.95, "curve {}", share(of_curve));
    }

    #[test]
    fn scatter_alone_is_seldom_taken_for_learning() {
        let cases = 400_u32;
        let seen = (0..cases).filter(|seed| {
            let mut noise = noise(u64::from(*seed) + 1);
            let values: Vec<f64> = (0..20).map(|_| 50.0 + 5.0 * noise()).collect();
            LearningCurve::fit(&values).is_some_and(|curve| curve.is_seen)
        });
        let share = seen.count() as f64 / f64::from(cases);
        assert!(share < 0.09, "{share}");
    }

    #[test]
    fn too_little_makes_no_curve() {
        assert!(LearningCurve::fit(&[5.0, 4.0, 3.0, 2.5, 2.2]).is_none());
        assert!(LearningCurve::fit(&[5.0; 20]).is_none());
        assert!(LearningCurve::fit(&[1.0, 2.0, f64::NAN, 3.0, 4.0, 5.0, 6.0]).is_none());
    }
}
