//! Grade of an attempt: its measures beside those of experts. Everything comes from the recording, and the same
//! recording gives the same numbers, to the bit.

use super::advice;
use super::attempt::Attempted;
use super::expert_level::Expert;
use super::format::Lesson;
use super::graded::{Figure, GRADE_VERSION, Grade, Reached};
use super::progress::Progress;
use crate::course::follow;
use crate::definitions::Definition;
use crate::figures::figures;
use crate::{Measures, VERSION, hand};
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use haptics::world::World;
use std::collections::BTreeMap;

/// A measure that is worse than the experts' mean by this many of their units halves the score.
const HALVES: f64 = 5.0;
/// The unit of a measure is the experts' standard deviation, but no less than this share of their mean.
const LEAST_SHARE: f64 = 0.1;
/// One measure alone is never worse than this, nor better than that, in units: nothing outweighs everything else.
const WORST: f64 = 25.0;
const BEST: f64 = -2.0;

/// Facts of an attempt before any comparison.
pub struct SeenAttempt {
    /// Everything that was measured.
    pub measures: Measures,
    /// The goals.
    pub goals: Vec<Reached>,
    /// The rules.
    pub rules: Vec<Reached>,
    /// True if the answer was right.
    pub answered_rightly: Option<bool>,
    /// Everything is as it should be.
    pub completed: bool,
    /// From the first motion to the last goal, s.
    pub completed_s: Option<f64>,
}

/// Plays a recording through its world and looks at goals, rules and measures.
///
/// # Errors
/// Without two fingers, or without a clock.
pub fn see(
    lesson: &Lesson,
    attempted: &Attempted,
    world: &World,
    recording: &Recording,
) -> Result<SeenAttempt, EstimateError> {
    let hand = hand::measure(recording, lesson.limit_n)?;
    let mut progress = Progress::new(lesson, world);
    let begin_s = recording.time_s.as_ref().and_then(|t| t.first().copied()).unwrap_or(0.0);
    let course = follow(world, recording, |time_s, state| progress.see(time_s - begin_s, state))?;
    let goals: Vec<Reached> =
        progress.standings().map(|(goal, s)| Reached { says: goal.says.clone(), reached: s.reached }).collect();
    let rules: Vec<Reached> =
        progress.rules().map(|(rule, kept)| Reached { says: rule.says.clone(), reached: kept }).collect();
    let answered_rightly = lesson.question.as_ref().map(|_| attempted.answer == Some(attempted.variant));
    let completed = progress.is_completed() && progress.broken().is_none() && answered_rightly != Some(false);
    let measures = Measures { version: VERSION, hand, course: Some(course) };
    Ok(SeenAttempt { measures, goals, rules, answered_rightly, completed, completed_s: progress.completed_s() })
}

/// Grades an attempt from its recording, in the world that was touched.
///
/// # Errors
/// Without two fingers or a clock, and for a lesson whose experts were not measured.
pub fn grade(
    lesson: &Lesson,
    attempted: &Attempted,
    world: &World,
    recording: &Recording,
) -> Result<Grade, EstimateError> {
    let expert = lesson.experts(attempted).ok_or_else(|| {
        EstimateError::Other(format!("nobody has measured the experts of the lesson `{}` yet", lesson.id))
    })?;
    let seen = see(lesson, attempted, world, recording)?;
    let mut all = figures(&seen.measures);
    all.extend(seen.completed_s.map(|value| ("completed_s", value)));
    let figures: Vec<Figure> = lesson.judged.iter().filter_map(|j| figure(j, expert, &all)).collect();
    let score = badness(lesson, expert, &all).filter(|_| seen.completed).map(score_of);
    let score_criterion = score_of(expert.badness.mean + expert.badness.sd);
    let mut grade = Grade {
        version: GRADE_VERSION,
        lesson: lesson.id.clone(),
        completed: seen.completed,
        goals: seen.goals,
        rules: seen.rules,
        answered_rightly: seen.answered_rightly,
        score,
        score_criterion,
        meets_criterion: score.is_some_and(|score| score >= score_criterion),
        figures,
        advice: String::new(),
        measures: seen.measures,
        completed_s: seen.completed_s,
    };
    grade.advice = advice::of(&grade);
    Ok(grade)
}

/// 100 for the experts' average; half of it for every [`HALVES`] units that an attempt is worse.
fn score_of(badness: f64) -> f64 {
    100.0 * (-badness / HALVES).exp2()
}

fn figure(judged: &super::format::Judged, expert: &Expert, all: &BTreeMap<&'static str, f64>) -> Option<Figure> {
    let definition = Definition::of(&judged.measure)?;
    let spread = expert.measures.get(&judged.measure)?;
    let value = *all.get(judged.measure.as_str())?;
    let sign = if definition.less_is_better? { 1.0 } else { -1.0 };
    let unit = spread.sd.max(LEAST_SHARE * spread.mean.abs()).max(definition.grain);
    let criterion = spread.mean + sign * spread.sd;
    Some(Figure {
        measure: judged.measure.clone(),
        weight: judged.weight,
        value,
        expert_mean: spread.mean,
        expert_sd: spread.sd,
        criterion,
        meets_criterion: sign * (value - criterion) <= 0.0,
        worse_by: (sign * (value - spread.mean) / unit).clamp(BEST, WORST),
    })
}

/// Number of units by which an attempt is worse than the experts' mean, over all judged measures by their weights;
/// `None` if one was not measured.
pub fn badness(lesson: &Lesson, expert: &Expert, all: &BTreeMap<&'static str, f64>) -> Option<f64> {
    let (mut sum, mut weights) = (0.0, 0.0);
    for judged in &lesson.judged {
        let figure = figure(judged, expert, all)?;
        sum += judged.weight * figure.worse_by;
        weights += judged.weight;
    }
    (weights > 0.0).then(|| sum / weights)
}
