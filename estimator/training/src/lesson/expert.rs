//! Expert reference of a lesson: mean and spread of each judged measure, without outliers.

use super::attempt::Attempted;
use super::expert_level::{Expert, Spread};
use super::format::{Lesson, Over};
use super::grade::{self, badness};
use super::perform::perform_over;
use crate::figures::figures;
use foundation::estimate::EstimateError;
use haptics::device::Skill;
use haptics::teleop::Delay;
use std::collections::BTreeMap;

/// Attempts that the spread is taken from.
pub const ATTEMPTS: usize = 40;
/// First seed of the experts' attempts: apart from those that tests draw.
const FIRST_SEED: u64 = 0x0e59_e127;
/// Distance from the quartiles, in multiples of theirs, from which a value is an outlier (Tukey 1977).
const FENCE: f64 = 1.5;

/// Lets the scripted expert do a lesson [`ATTEMPTS`] times.
///
/// # Errors
/// The lesson cannot be done, or fewer than half of the attempts come to the goal.
pub fn measure(lesson: &Lesson) -> Result<Expert, EstimateError> {
    measure_over(lesson, &Delay::default())
}

/// Lines that built-in lessons have experts for: round trip, s, and whether a model answers.
pub const LINES: [(f64, bool); 4] = [(0.15, false), (0.15, true), (0.5, false), (0.5, true)];

/// Expert references over each of [`LINES`]; lines over which most attempts fail are left out.
pub fn over_lines(lesson: &Lesson) -> Vec<Over> {
    let over = |(round_trip_s, predicted): (f64, bool)| {
        let expert = measure_over(lesson, &Delay::of(round_trip_s, predicted)).ok()?;
        Some(Over { delay_ms: 1e3 * round_trip_s, predicted, expert })
    };
    LINES.into_iter().filter_map(over).collect()
}

/// The same over a slow line.
///
/// # Errors
/// As [`measure`], and when there is no such line.
pub fn measure_over(lesson: &Lesson, line: &Delay) -> Result<Expert, EstimateError> {
    let mut found: Vec<BTreeMap<&'static str, f64>> = Vec::new();
    for index in 0..ATTEMPTS {
        let variant = index % lesson.variant_count();
        let performance = perform_over(lesson, variant, Skill::expert(), FIRST_SEED + index as u64, line)?;
        let answer = lesson.question.as_ref().map(|_| variant);
        let attempted = Attempted { answer, ..Attempted::at(lesson, variant) };
        let seen = grade::see(lesson, &attempted, &performance.world, &performance.recording("expert"))?;
        if seen.completed {
            let mut all = figures(&seen.measures);
            all.extend(seen.completed_s.map(|value| ("completed_s", value)));
            found.push(all);
        }
    }
    if found.len() < ATTEMPTS / 2 {
        return Err(EstimateError::Other(format!(
            "the expert reached the goals of `{}` in {} of {ATTEMPTS} attempts only; change its goals or its demonstration",
            lesson.id,
            found.len()
        )));
    }
    let mut measures = BTreeMap::new();
    for judged in &lesson.judged {
        let values: Vec<f64> = found.iter().filter_map(|f| f.get(judged.measure.as_str()).copied()).collect();
        let spread = spread_of(&values).ok_or_else(|| {
            EstimateError::Other(format!("`{}` was not measured in the expert's attempts", judged.measure))
        })?;
        measures.insert(judged.measure.clone(), spread);
    }
    let completed = [found.len(), ATTEMPTS];
    let mut expert = Expert { completed, measures_version: crate::VERSION, measures, badness: Spread::default() };
    let bad: Vec<f64> = found.iter().filter_map(|f| badness(lesson, &expert, f)).collect();
    expert.badness = spread_of(&bad).unwrap_or_default();
    Ok(expert)
}

/// Mean and standard deviation of the values within the fences of the quartiles.
pub fn spread_of(values: &[f64]) -> Option<Spread> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    if sorted.len() < 2 {
        return None;
    }
    let quantile = |share: f64| {
        let place = share * (sorted.len() - 1) as f64;
        let (below, part) = (place.floor() as usize, place.fract());
        sorted[below] + part * (sorted[(below + 1).min(sorted.len() - 1)] - sorted[below])
    };
    let (first, third) = (quantile(0.25), quantile(0.75));
    let fence = FENCE * (third - first);
    let kept: Vec<f64> = sorted.iter().copied().filter(|v| (first - fence..=third + fence).contains(v)).collect();
    let mean = kept.iter().sum::<f64>() / kept.len() as f64;
    let square = kept.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (kept.len() - 1).max(1) as f64;
    Some(Spread { mean, sd: square.sqrt() })
}
