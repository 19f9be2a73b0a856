//! Accuracy of every parameter, the time that the same motion would still need, and the motion that is missing.
//!
//! What was collected is an information matrix (the inverse of the covariance, errors as reported). A candidate motion adds rows of its
//! own a second, made by the same laws. The seconds that each of them needs for the wanted accuracy follow; the motion that is missing
//! is the one that gets there clearly sooner than going on as before. Names of parameters decide nothing there. Where several are needed, the one that
//! all of them together could least do without is named first. What has no such matrix gets the motion that its fit takes it from
//! (`recommended_motion`), without seconds.

pub(super) mod matrices;
pub(super) mod motion;
pub(super) mod problem;
mod recommended_motion;
pub(super) mod target_accuracy;

pub use motion::Motion;
pub use target_accuracy::Wanted;

use foundation::estimate::Parameter;
use nalgebra::DMatrix;
use problem::Problem;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Time within which continuing as before is fine, s.
const SOON_S: f64 = 8.0;
/// Least ratio of the time of continuing as before to that of the best other motion for that motion to be named.
const CLEARLY: f64 = 2.0;
/// Time over which motions are compared if none gets there alone, s.
const TRIAL_S: f64 = 5.0;
/// It must shrink the error by this share to be named.
const HELPS: f64 = 0.1;

/// What is known of one parameter, and what is missing.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Enough {
    /// The object.
    pub object: String,
    /// The parameter, with its unit.
    pub name: String,
    /// One standard error now, in the unit of the value; absent while it is not known at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std_error: Option<f64>,
    /// Wanted standard error, in the unit of the value; absent where it cannot be said before there is a value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wanted: Option<f64>,
    /// Share of the information that the wanted accuracy needs, 0 to 1.
    pub share: f64,
    /// Further seconds of the same motion, where they would do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub more_seconds: Option<f64>,
    /// The motion that is missing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missing: Option<Missing>,
}

/// A motion that is missing.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Missing {
    /// Which one.
    pub motion: Motion,
    /// In words.
    pub words: String,
    /// Seconds of it that would do; absent where it takes more than that motion alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
}

/// Judges every parameter that an accuracy is wanted of.
pub(super) fn judge(parameters: &[Parameter], problems: &[Problem], wanted: &Wanted) -> Vec<Enough> {
    parameters
        .iter()
        .filter(|p| wanted.asks_for(&p.name))
        .map(|parameter| {
            let place = problems.iter().filter(|p| p.object == parameter.object).find_map(|problem| {
                let column = problem.names.iter().find(|(name, _)| *name == parameter.name)?.1;
                Some((problem, column))
            });
            one(parameter, parameters, place, wanted)
        })
        .collect()
}

fn one(parameter: &Parameter, all: &[Parameter], place: Option<(&Problem, usize)>, wanted: &Wanted) -> Enough {
    let std_error = parameter.std_error.filter(|_| parameter.identified);
    let goal = parameter.value.and_then(|value| wanted.absolute(&parameter.name, value));
    let share = match (goal, std_error) {
        (Some(goal), Some(error)) if error > 0.0 => (goal / error).powi(2).min(1.0),
        (Some(_), Some(_)) => 1.0,
        _ => 0.0,
    };
    let mut enough = Enough {
        object: parameter.object.clone(),
        name: parameter.name.clone(),
        std_error,
        wanted: goal,
        share,
        more_seconds: None,
        missing: None,
    };
    if let (true, Some((problem, column))) = (share < 1.0, place) {
        (enough.more_seconds, enough.missing) = ahead(problem, column, std_error, goal);
    }
    if share < 1.0 && enough.more_seconds.is_none() && enough.missing.is_none() {
        enough.missing = recommended_motion::shows(parameter, all).map(|motion| missing(motion, None));
    }
    enough
}

/// Seconds of the same motion, or the motion that is missing.
fn ahead(problem: &Problem, column: usize, error: Option<f64>, goal: Option<f64>) -> (Option<f64>, Option<Missing>) {
    let still = DMatrix::zeros(problem.before.len(), problem.before.len());
    let now = problem.variance(column, &still, 0.0);
    // The recursion and the report may differ by errors that no row shows: predictions keep that ratio.
    let ratio = error.map_or(1.0, |e| e * e / now);
    // Ten times better than now, before there is a value to set the wanted accuracy by.
    let wanted = goal.map_or(0.01 * now, |g| g * g / ratio);
    let times: Vec<Option<f64>> = problem.motions.iter().map(|(_, m)| problem.seconds(column, m, wanted)).collect();
    let same = times.first().copied().flatten();
    let best = times
        .iter()
        .enumerate()
        .skip(1)
        .filter_map(|(k, t)| t.map(|t| (k, t)))
        .reduce(|a, b| if b.1 < a.1 { b } else { a });
    match (same, best) {
        (Some(same), Some((_, other))) if same <= SOON_S.max(CLEARLY * other) => (Some(same), None),
        (Some(same), None) => (Some(same), None),
        (_, Some((k, seconds))) => (same, Some(missing(problem.motions[k].0, Some(seconds)))),
        (None, None) => {
            let after = |m: &DMatrix<f64>| problem.variance(column, m, TRIAL_S) / now;
            let usual = problem.motions.first().map_or(1.0, |(_, m)| after(m));
            let helps = problem.motions.iter().skip(1).map(|(motion, m)| (*motion, after(m)));
            let best = helps.reduce(|a, b| if b.1 < a.1 { b } else { a });
            let named = best.filter(|(_, left)| *left < usual && left.sqrt() < 1.0 - HELPS);
            let named = named.map(|(motion, _)| motion).or_else(|| needed_among_all(problem, column, now));
            (None, named.map(|motion| missing(motion, None)))
        }
    }
}

/// Motion that all of them together could least do without, if no motion helps alone.
fn needed_among_all(problem: &Problem, column: usize, now: f64) -> Option<Motion> {
    let others = &problem.motions[1.min(problem.motions.len())..];
    let n = problem.before.len();
    let all = others.iter().fold(DMatrix::zeros(n, n), |sum, (_, m)| sum + m);
    if (problem.variance(column, &all, TRIAL_S) / now).sqrt() > 1.0 - HELPS {
        return None;
    }
    let without = others.iter().map(|(motion, m)| (*motion, problem.variance(column, &(&all - m), TRIAL_S)));
    without.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(motion, _)| motion)
}

fn missing(motion: Motion, seconds: Option<f64>) -> Missing {
    Missing { motion, words: motion.words().to_owned(), seconds }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    /// A constant and a slope: the collected data show the constant only.
    fn problem() -> Problem {
        let per = |rows: &[[f64; 2]]| {
            rows.iter().fold(DMatrix::zeros(2, 2), |sum, r| {
                let x = DVector::from_column_slice(r);
                sum + &x * x.transpose()
            })
        };
        Problem {
            object: "thing".to_owned(),
            names: vec![("weight_N".to_owned(), 0), ("inertia_kg_m2".to_owned(), 1)],
            information: per(&[[1.0, 0.0]]) * 1e4,
            before: vec![10.0, 10.0],
            motions: vec![
                (Motion::GoOn, per(&[[1.0, 0.0]]) * 1e3),
                (Motion::Accelerate, per(&[[1.0, 1.0], [1.0, -1.0]]) * 500.0),
                (Motion::LetGo, per(&[[0.0, 0.0]])),
            ],
        }
    }

    #[test]
    fn the_motion_that_raises_the_weak_direction_is_named() {
        let known = Parameter::identified("thing", "weight_N", 1.0, 0.01, 10, "");
        let unknown = Parameter::unidentified("thing", "inertia_kg_m2", 10, "too even");
        let all = judge(&[known, unknown], &[problem()], &Wanted::default());
        assert_eq!(all.len(), 2);
        assert!(all[0].missing.is_none() && all[0].share > 0.9, "{:?}", all[0]);
        let missing = all[1].missing.as_ref().expect("nothing but accelerating shows it");
        assert!(missing.motion == Motion::Accelerate && all[1].share == 0.0 && all[1].more_seconds.is_none());
    }

    #[test]
    fn going_on_is_counted_in_seconds() {
        let half = Parameter::identified("thing", "weight_N", 0.5, 0.01, 10, "");
        let all = judge(&[half], &[problem()], &Wanted::default());
        // 1 % of 0.5 N is half the error: four times the information, 3e4 more at 1e3 a second.
        assert!((all[0].share - 0.25).abs() < 1e-9);
        let seconds = all[0].more_seconds.expect("it grows");
        assert!((seconds - 30.0).abs() < 1.0, "{seconds}");
    }
}
