//! What the extension is worth on other recordings: nothing is fitted to them.

use super::dictionary::{Dictionary, dry_of};
use super::force::{blur, column};
use super::grid::Grid;
use super::kept::Kept;
use super::report::Validation;
use super::track::{Place, Track};
use haptics::law::{Effect, Kind, Memories};

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

/// What the found faults of the sensors put into the rows. `known`: forces of which everything is known.
fn faults(track: &Track, predicted: &[f64], known: &[Effect], kept: &[Kept], left_out: &mut Vec<String>) -> Vec<f64> {
    let mut sum = vec![0.0; track.rows.len()];
    let of_sensors: Vec<&Kept> = kept.iter().filter(|k| k.kind == Kind::Instrument).collect();
    if of_sensors.is_empty() {
        return sum;
    }
    let grid = Grid::coarse(track);
    let fixed: Vec<Vec<f64>> = known.iter().map(|e| column(track, e)).collect();
    let (resisting, dry) = (predicted, &dry_of(track, predicted));
    let dictionary =
        Dictionary { track, predicted, resisting, dry, fixed: &fixed, without: &[], grid: &grid }.candidates();
    for fault in of_sensors {
        match fault.column(&dictionary) {
            Some(column) => sum.iter_mut().zip(column).for_each(|(s, c)| *s += c),
            None => left_out.push(fault.id.to_owned()),
        }
    }
    sum
}

/// Unexplained force before and after on another recording. Rows around reversals, whose direction is a guess, count little.
pub fn validate(track: &mut Track, before: &[Effect], after: &[Effect], known: &[Effect], kept: &[Kept]) -> Validation {
    blur(track);
    let (without, mut with) = (predicted(track, before), predicted(track, after));
    let mut left_out = Vec::new();
    let sensed = faults(track, &with, known, kept, &mut left_out);
    with.iter_mut().zip(sensed).for_each(|(w, s)| *w += s);
    let rms = |model: &[f64]| {
        let along = track.rows.iter().zip(model).filter(|(r, _)| r.place == Place::Along);
        let (sum, weight) = along.fold((0.0, 0.0), |(s, w), (row, force)| {
            let sure = row.motion.direction.powi(4);
            (s + sure * (row.y - force).powi(2), w + sure)
        });
        (sum / f64::max(weight, 1e-12)).sqrt()
    };
    Validation { rms_before: rms(&without), rms_after: rms(&with), left_out, ..Validation::default() }
}
