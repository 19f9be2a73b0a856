//! A made-up history of practice, for pictures.

use crate::history::attempt::{Attempt, Conditions};
use jiff::{SignedDuration, Timestamp};
use std::path::PathBuf;

/// Fictitious attempts of a trainee at one lesson: four sessions, slow and hesitant at first.
pub fn practice() -> Vec<Attempt> {
    let begun: Timestamp = "2026-11-02T17:00:00Z".parse().unwrap_or_default();
    (0..23_u32)
        .map(|k| {
            let session = k / 6;
            let scatter = 5.0 * (2.3 * f64::from(k)).sin() + 3.0 * (5.1 * f64::from(k)).cos();
            let score = 96.0 - 55.0 * (f64::from(k) + 1.0).powf(-0.7) + 0.7 * scatter;
            let met = |score: f64| score >= 88.0;
            let began_s = i64::from(session) * 86_400 + i64::from(k % 6) * 150;
            Attempt {
                trainee: "Ada".to_owned(),
                lesson: "pinch".to_owned(),
                conditions: Conditions::default(),
                began: begun.saturating_add(SignedDuration::from_secs(began_s)).unwrap_or(begun),
                duration_s: 18.0 + 30.0 * (f64::from(k) + 1.0).powf(-0.5),
                completed: k != 1,
                score: (k != 1).then_some(score),
                meets_criterion: met(score),
                proficient: false,
                measures: serde_json::Value::Null,
                measures_version: 1,
                grade_version: 1,
                recording: Some(PathBuf::from(format!(
                    "recordings/2026-11-{:02}_pinch_{}.mcap",
                    2 + session,
                    k % 6 + 1
                ))),
            }
        })
        .collect()
}
