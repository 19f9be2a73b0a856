//! Answers of the program to the questions, and their judgement.

use super::questions::{Expected, Question};
use crate::shared_recordings;
use estimator::diagnose::{Diagnosis, Options, diagnose};
use estimator::estimate::{Fit, Parameter};
use estimator::identify::{mechanism, payload};
use estimator::segment::task_of;
use haptics::recording::{Recording, Task};

/// Judgement of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It agrees with what is known.
    Right,
    /// It says that the recording cannot tell, or is not certain.
    Honest,
    /// It is certain of something else.
    Wrong,
    /// It ends with an error.
    Refused,
}

impl Outcome {
    /// In one word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Honest => "honest",
            Self::Wrong => "**wrong**",
            Self::Refused => "refused",
        }
    }
}

/// An answer and its judgement.
#[derive(Clone, Debug)]
pub struct Judged {
    /// Judgement.
    pub outcome: Outcome,
    /// The answer, short.
    pub said: String,
}

/// Asks one question. `None` if its measurements are not here.
pub fn ask(question: &Question) -> Option<Judged> {
    let recordings = shared_recordings(question.log, question.sidecar)?;
    Some(match &question.expected {
        Expected::Value { parameter, between } => of_fit(&recordings, &|fit| value(fit, parameter, *between)),
        Expected::NotIdentified { parameter } => of_fit(&recordings, &|fit| not_identified(fit, parameter)),
        Expected::Warned { word } => of_fit(&recordings, &|fit| warned(&recordings, fit, word)),
        Expected::Named { any, tolerated } => of_diagnosis(question, &recordings, &|d| named(d, any, tolerated)),
        Expected::NothingCertain { tolerated } => of_diagnosis(question, &recordings, &|d| named(d, &[], tolerated)),
        Expected::NotNone => of_diagnosis(question, &recordings, &not_none),
    })
}

fn of_fit(recordings: &[Recording], judge: &dyn Fn(&Fit) -> Judged) -> Judged {
    let is_payload = recordings.first().is_some_and(|r| task_of(r, None).is_ok_and(|task| task == Task::Payload));
    let fit = if is_payload { payload::fit(&recordings[0]) } else { mechanism::fit(recordings) };
    fit.map_or_else(refused, |fit| judge(&fit))
}

fn of_diagnosis(question: &Question, recordings: &[Recording], judge: &dyn Fn(&Diagnosis) -> Judged) -> Judged {
    let options = Options { baseline: question.baseline.map(str::to_owned), ..Options::default() };
    diagnose(recordings, &options).map_or_else(refused, |found| judge(&found.diagnosis))
}

fn refused(error: impl std::fmt::Display) -> Judged {
    Judged { outcome: Outcome::Refused, said: error.to_string() }
}

fn shown(parameter: &Parameter) -> Option<(f64, f64)> {
    parameter.value.zip(parameter.std_error).filter(|_| parameter.identified)
}

fn find<'a>(fit: &'a Fit, name: &str) -> Option<&'a Parameter> {
    fit.parameters.iter().find(|p| p.name == name)
}

/// Right if the 95 % interval meets what is known.
fn value(fit: &Fit, name: &str, [low, high]: [f64; 2]) -> Judged {
    let Some((value, error)) = find(fit, name).and_then(shown) else {
        return Judged { outcome: Outcome::Honest, said: "not identified".to_owned() };
    };
    let meets = value + 2.0 * error >= low && value - 2.0 * error <= high;
    let outcome = if meets { Outcome::Right } else { Outcome::Wrong };
    Judged { outcome, said: format!("{value:.4} ± {error:.4}") }
}

/// Right if no value is stated, or one whose interval holds zero.
fn not_identified(fit: &Fit, name: &str) -> Judged {
    match find(fit, name).and_then(shown) {
        None => Judged { outcome: Outcome::Right, said: "not identified".to_owned() },
        Some((value, error)) => {
            let outcome = if value.abs() < 2.0 * error { Outcome::Honest } else { Outcome::Wrong };
            Judged { outcome, said: format!("{value:.4} ± {error:.4}") }
        }
    }
}

fn warned(recordings: &[Recording], fit: &Fit, word: &str) -> Judged {
    let of_logs = recordings.iter().flat_map(|r| &r.warnings).map(|w| w.text.as_str());
    match of_logs.chain(fit.warnings.iter().map(String::as_str)).find(|text| text.contains(word)) {
        Some(text) => Judged { outcome: Outcome::Right, said: text.to_owned() },
        None => Judged { outcome: Outcome::Wrong, said: "nothing of it".to_owned() },
    }
}

fn certain(diagnosis: &Diagnosis) -> Vec<&str> {
    diagnosis.certain().into_iter().map(|c| c.id.as_str()).filter(|id| !id.starts_with("other:")).collect()
}

fn told(diagnosis: &Diagnosis) -> String {
    let verdict = serde_json::to_string(&diagnosis.verdict).unwrap_or_default().replace('"', "");
    let causes: Vec<String> =
        diagnosis.causes.iter().map(|c| format!("{} {:.0} %", c.id, 100.0 * c.posterior)).collect();
    if causes.is_empty() { verdict } else { format!("{verdict}: {}", causes.join(", ")) }
}

/// Right if one of `any` is certain and nothing else but what is tolerated.
fn named(diagnosis: &Diagnosis, any: &[&str], tolerated: &[&str]) -> Judged {
    let certain = certain(diagnosis);
    let is_false = |id: &&str| !any.contains(id) && !tolerated.contains(id);
    let outcome = if certain.iter().any(is_false) {
        Outcome::Wrong
    } else if any.is_empty() || certain.iter().any(|id| any.contains(id)) {
        Outcome::Right
    } else if diagnosis.verdict == estimator::diagnose::Verdict::None {
        Outcome::Wrong
    } else {
        Outcome::Honest
    };
    Judged { outcome, said: told(diagnosis) }
}

fn not_none(diagnosis: &Diagnosis) -> Judged {
    let is_none = diagnosis.verdict == estimator::diagnose::Verdict::None;
    Judged { outcome: if is_none { Outcome::Wrong } else { Outcome::Right }, said: told(diagnosis) }
}
