//! Is there a constraint at all? Force that weight, inertia and friction do not explain (thesis, 4.2 and figure 5.12).
//!
//! The force along the motion is fitted: weight, inertia and, if something rubs, friction. The residual of the force
//! *across* the motion after the same weight and inertia is tested twice, each at half the stated rate of false alarms:
//!
//! - its mean, along the path's left normal and along its outward normal, against a standard error that counts the
//!   autocorrelation, the errors of weight and inertia, the sensors' bias and the model error of a grip;
//! - its power, against the power of the residual along the motion: unexplained force is independent of the direction
//!   of an object's motion, unless it is guided.

use crate::regression::linear::{LinearFit, integrated_autocorrelation, least_squares};
use foundation::estimate::{Existence, Sided};
use haptics::Vec2;
use statrs::distribution::{ContinuousCDF, FisherSnedecor, StudentsT};

/// Free motions that are called constrained, at most.
pub const FALSE_ALARMS: f64 = 0.01;
/// Residual by pads, swinging and geometry without any constraint, as a share of the force.
const MODEL_SHARE: f64 = 0.02;
/// A constraint force above this share of the force would matter: absence is only stated when it would have been seen.
const MATTERS_SHARE: f64 = 0.25;
/// Fewer rows tell nothing.
const LEAST_ROWS: usize = 12;
/// Least size of the force on a loaded side, standard deviations.
const SIDE_DEVIATIONS: f64 = 4.0;
/// Least share of the rows with such a force.
const SIDE_SHARE: f64 = 0.05;
/// Quantile of the normal distribution for nineteen of twenty, and for half the rate of false alarms on two means.
const SEEN_95: f64 = 1.645;

/// Motion and force of the held object, at rows that do not share samples of a filter.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// Velocity, m/s, or any vector along the path where there is no clock.
    pub velocity: Vec<Vec2>,
    /// Acceleration, m/s²; zero where there is no clock.
    pub acceleration: Vec<Vec2>,
    /// Net force on the object by the hand, bias taken out, N.
    pub force: Vec<Vec2>,
    /// Unit vector upwards in the plane of motion; shorter when that is tilted, zero when it is level.
    pub up: Vec2,
    /// m/s²: ties inertia to weight for a single body; `None` for a mechanism, whose inertia is its own.
    pub gravity: Option<f64>,
    /// The object rubs on something as it moves.
    pub rubs: bool,
    /// Standard error of the force's bias, N.
    pub bias_error_n: f64,
}

/// Force across the motion that is not explained, row by row.
struct Unexplained {
    along: Vec<f64>,
    across: Vec<f64>,
    /// Mean effect on `across` of one standard error of weight and inertia, N.
    model_error_n: f64,
    rms_n: f64,
}

/// The test; `None` with too few rows.
pub fn existence(rows: &Rows) -> Option<(Existence, Option<Sided>)> {
    if rows.velocity.len() < LEAST_ROWS {
        return None;
    }
    let outward = outward_signs(&rows.velocity);
    let found = unexplained(rows)?;
    let floor = (MODEL_SHARE * found.rms_n).hypot(rows.bias_error_n);
    let left = mean(&found.across)?;
    let sided: Vec<f64> = found.across.iter().zip(&outward).map(|(f, s)| f * s).collect();
    let pull = mean(&sided)?;
    let of_mean = |m: &Mean| m.p_value(found.model_error_n.hypot(floor));
    let (p_left, p_pull) = (of_mean(&left), of_mean(&pull));
    let p_power = power(&found.across, &found.along, floor);
    // Three questions asked: the smallest answer counts three times (Bonferroni).
    let p_value = (3.0 * p_left.min(p_pull).min(p_power)).min(1.0);
    let stronger = if p_left < p_pull { &left } else { &pull };
    let error = stronger.error.hypot(found.model_error_n).hypot(floor);
    let quantile = StudentsT::new(0.0, 1.0, stronger.freedom).map_or(3.0, |t| t.inverse_cdf(1.0 - FALSE_ALARMS / 6.0));
    let detectable_n = (quantile + SEEN_95) * error;
    let exists =
        if p_value < FALSE_ALARMS { Some(true) } else { (detectable_n < MATTERS_SHARE * found.rms_n).then_some(false) };
    let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let sides = (exists == Some(true)).then(|| sides(&sided, rms(&found.along).hypot(floor))).flatten();
    let answer = Existence {
        exists,
        p_value,
        false_alarm_rate: FALSE_ALARMS,
        unexplained_n: pull.value,
        std_error_n: pull.error.hypot(found.model_error_n).hypot(floor),
        unexplained_rms_n: rms(&found.across),
        detectable_n,
        effective_samples: stronger.effective,
        direction: "normal".to_owned(),
    };
    Some((answer, sides))
}

/// A p-value as people write it: `= 0.43`, `= 2.5 × 10⁻⁸`, `< 10⁻¹⁵`.
pub fn probability(p: f64) -> String {
    /// Differences of numbers near 1 say no less.
    const LEAST: i32 = -15;
    let power = |exponent: i32| {
        let digits = exponent.unsigned_abs().to_string();
        let raised = digits.chars().filter_map(|c| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(c.to_digit(10)? as usize));
        format!("10⁻{}", raised.collect::<String>())
    };
    if p >= 1e-3 || !p.is_finite() {
        return format!("= {p:.3}");
    }
    let exponent = p.max(f64::MIN_POSITIVE).log10().floor() as i32;
    if exponent < LEAST {
        return format!("< {}", power(LEAST));
    }
    // Rounding must not leave ten of the next power.
    let leading = format!("{:.1}", p / 10_f64.powi(exponent));
    if leading == "10.0" {
        format!("= 1.0 × {}", power(exponent + 1))
    } else {
        format!("= {leading} × {}", power(exponent))
    }
}

/// One sentence about it.
pub fn sentence(found: &Existence) -> String {
    let force = format!(
        "{} ± {:.3} N across the motion are not explained by weight and inertia (p {}, false alarms {:.0} %)",
        format!("{:.3}", found.unexplained_n).replace('-', "−"),
        found.std_error_n,
        probability(found.p_value),
        100.0 * found.false_alarm_rate
    );
    match found.exists {
        Some(true) => format!("{force}: something guides it"),
        Some(false) => format!("{force}: no constraint; one of {:.3} N would have been seen", found.detectable_n),
        None => format!(
            "{force}, and a constraint would have to hold with {:.3} N to be seen: whether there is one stays open",
            found.detectable_n
        ),
    }
}

/// Weight and inertia from the force along the motion, and the residuals in both directions.
fn unexplained(rows: &Rows) -> Option<Unexplained> {
    let tangent: Vec<Vec2> = rows.velocity.iter().map(Vec2::normalize).collect();
    let normal: Vec<Vec2> = tangent.iter().map(|t| Vec2::new(-t.y, t.x)).collect();
    let n = tangent.len();
    let weigh = |axis: &[Vec2]| -> Vec<Vec<f64>> {
        let up: Vec<f64> = axis.iter().map(|a| a.dot(&rows.up)).collect();
        let inertia: Vec<f64> = axis.iter().zip(&rows.acceleration).map(|(a, b)| a.dot(b)).collect();
        match rows.gravity {
            Some(g) => vec![up.iter().zip(&inertia).map(|(u, i)| u + i / g).collect()],
            None => vec![up, inertia],
        }
    };
    let mut columns = weigh(&tangent);
    let model = columns.len();
    if rows.rubs {
        columns.push(vec![1.0; n]);
        columns.push(rows.velocity.iter().map(Vec2::norm).collect());
    }
    let force = |axis: &[Vec2]| axis.iter().zip(&rows.force).map(|(a, f)| a.dot(f)).collect::<Vec<f64>>();
    let (along, mut across) = (force(&tangent), force(&normal));
    let fit = least_squares(&columns, &along, None).ok()?;
    let side = weigh(&normal);
    for (j, column) in side.iter().enumerate() {
        across.iter_mut().zip(column).for_each(|(f, c)| *f -= fit.values[j] * c);
    }
    let square: f64 = rows.force.iter().map(Vec2::norm_squared).sum::<f64>() / n as f64;
    Some(Unexplained {
        model_error_n: model_error(&fit, &side, model),
        along: fit.residuals,
        across,
        rms_n: square.sqrt(),
    })
}

/// Root mean square over the rows of the error across the motion by the errors of weight and inertia, N.
fn model_error(fit: &LinearFit, side: &[Vec<f64>], model: usize) -> f64 {
    let size = |column: &[f64]| (column.iter().map(|c| c * c).sum::<f64>() / column.len() as f64).sqrt();
    let parts = (0..model).map(|j| {
        // A parameter that the motion does not show is unbounded; a regressor that is zero across does no harm, though.
        let error = if fit.identified[j] { fit.std_errors[j] } else { f64::INFINITY };
        if size(&side[j]) > 0.0 { (error * size(&side[j])).powi(2) } else { 0.0 }
    });
    parts.sum::<f64>().sqrt()
}

/// A mean with its long-run error.
struct Mean {
    value: f64,
    error: f64,
    freedom: f64,
    effective: f64,
}

impl Mean {
    /// Two-sided, with `systematic` error added.
    fn p_value(&self, systematic: f64) -> f64 {
        let t = self.value.abs() / self.error.hypot(systematic).max(f64::MIN_POSITIVE);
        StudentsT::new(0.0, 1.0, self.freedom).map_or(1.0, |s| 2.0 * (1.0 - s.cdf(t)))
    }
}

fn mean(values: &[f64]) -> Option<Mean> {
    let fit = least_squares(&[vec![1.0; values.len()]], values, None).ok()?;
    let effective = fit.effective_samples;
    // The degrees of freedom of the long-run variance, and the inflation by which its error covers 95 % at 1.96, taken back.
    let freedom = (0.4 * effective.powf(2.0 / 3.0)).max(3.0);
    let inflation = StudentsT::new(0.0, 1.0, freedom).map_or(1.0, |t| t.inverse_cdf(0.975) / 1.96);
    Some(Mean { value: fit.values[0], error: fit.std_errors[0] / inflation.max(1.0), freedom, effective })
}

/// One-sided: the power across exceeds that along, by an F test whose degrees of freedom count correlation and heavy tails.
fn power(across: &[f64], along: &[f64], floor: f64) -> f64 {
    let (a, b) = (Power::of(across), Power::of(along));
    let ratio = a.mean_square / (b.mean_square + floor * floor).max(f64::MIN_POSITIVE);
    FisherSnedecor::new(a.freedom, b.freedom).map_or(1.0, |f| 1.0 - f.cdf(ratio))
}

struct Power {
    mean_square: f64,
    freedom: f64,
}

impl Power {
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let squares: Vec<f64> = values.iter().map(|v| v * v).collect();
        let mean_square = squares.iter().sum::<f64>() / n;
        let fourth = squares.iter().map(|s| s * s).sum::<f64>() / n;
        // The relative variance of a mean square is (κ − 1)/n: a χ² with 2 n/(κ − 1) degrees of freedom has the same.
        let kurtosis = (fourth / (mean_square * mean_square).max(f64::MIN_POSITIVE)).max(3.0);
        let time = integrated_autocorrelation(&squares).max(integrated_autocorrelation(values));
        Self { mean_square, freedom: (2.0 * n / (kurtosis - 1.0) / time).max(2.0) }
    }
}

/// Side of the outside of the bend: +1 where the path bends to the right (its outside is on the left), −1 where it
/// bends to the left; on straight parts the sign of the nearest clear bend.
fn outward_signs(velocity: &[Vec2]) -> Vec<f64> {
    let n = velocity.len();
    let turn = |i: usize| {
        let (a, b) = (velocity[i.saturating_sub(2)], velocity[(i + 2).min(n - 1)]);
        (a.x * b.y - a.y * b.x).atan2(a.dot(&b))
    };
    let mut last = 1.0;
    (0..n)
        .map(|i| {
            let bend = turn(i);
            // A reversal is no bend.
            if bend.abs() > 0.02 && bend.abs() < 2.0 {
                last = -bend.signum();
            }
            last
        })
        .collect()
}

/// From which sides the constraint was loaded.
fn sides(outward: &[f64], deviation: f64) -> Option<Sided> {
    let n = outward.len() as f64;
    let share = |sign: f64| outward.iter().filter(|f| sign * **f > SIDE_DEVIATIONS * deviation).count() as f64 / n;
    match (share(1.0) > SIDE_SHARE, share(-1.0) > SIDE_SHARE) {
        (true, true) => Some(Sided::TwoSided),
        (false, false) => None,
        _ => Some(Sided::OneSided),
    }
}
