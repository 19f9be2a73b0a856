//! What the extension is worth on other recordings: nothing is fitted to them.

use super::force::blur;
use super::report::Validation;
use super::track::{Place, Track};
use haptics::law::{Effect, Memories};

/// Force of the laws along every row, with what they remember; they start anew at every stretch.
fn predicted(track: &Track, effects: &[Effect]) -> Vec<f64> {
    let rows = &track.rows;
    let mut memories = Memories::default();
    (0..rows.len())
        .map(|i| {
            if track.follows(i) {
                let step_s = rows[i].motion.time_s - rows[i - 1].motion.time_s;
                for (k, effect) in effects.iter().enumerate().filter(|(_, e)| e.remembers()) {
                    if let Some(memory) = memories.get_mut(k) {
                        effect.law().advance(&rows[i].motion, &effect.values, memory, step_s);
                    }
                }
            } else {
                memories = Memories::default();
            }
            effects.iter().enumerate().map(|(k, e)| e.force_with(&rows[i].motion, memories.get(k))).sum()
        })
        .collect()
}

/// Unexplained force before and after on another recording. Rows around reversals, whose direction is a guess, count little.
pub fn validate(track: &mut Track, before: &[Effect], after: &[Effect]) -> Validation {
    blur(track);
    let (without, with) = (predicted(track, before), predicted(track, after));
    let rms = |model: &[f64]| {
        let along = track.rows.iter().zip(model).filter(|(r, _)| r.place == Place::Along);
        let (sum, weight) = along.fold((0.0, 0.0), |(s, w), (row, force)| {
            let sure = row.motion.direction.powi(4);
            (s + sure * (row.y - force).powi(2), w + sure)
        });
        (sum / f64::max(weight, 1e-12)).sqrt()
    };
    Validation { rms_before: rms(&without), rms_after: rms(&with) }
}
