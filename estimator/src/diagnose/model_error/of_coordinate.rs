//! Structured errors of a motion along one coordinate.

use super::smooth::{Discrepancy, field, over_range, over_time, periodic};
use crate::diagnose::data::regression_data::{Place, Row, Track};
use crate::diagnose::hypotheses::axis::Axis;

/// Terms of a function of one variable.
/// Choice: halved, 117 of 244 answers change (1 to right); doubled, 173 of 374 answers change (1 to wrong).
pub(crate) const TERMS: usize = 12;
/// Terms of a function of time or of several variables.
/// Choice: halved, 81 of 374 answers change (1 to right); doubled, 49 of 374 answers change.
pub(super) const MANY_TERMS: usize = 64;
/// Lags of creep and relaxation, s: from the filter of a sensor to the rest between two motions.
/// Choice: halved, 44 of 374 answers change (1 to right); doubled, 42 of 374 answers change.
pub(super) const CREEP_LAGS_S: Axis = Axis::geometric(0.1, 8.0, 5);

/// All discrepancies of the rows of a track. `time_s`: of each row, one recording after the other; `predicted`: force of
/// the base model.
pub fn discrepancies(track: &Track, time_s: &[f64], predicted: &[f64]) -> Vec<Discrepancy> {
    let rows = &track.rows;
    let along: Vec<bool> = rows.iter().map(|r| r.place == Place::Along).collect();
    let of = |value: &dyn Fn(&Row) -> f64| -> Vec<f64> {
        rows.iter().map(|r| if r.place == Place::Along { value(r) } else { 0.0 }).collect()
    };
    let usual = |values: &[f64]| {
        let square: f64 = values.iter().map(|v| v * v).sum();
        (square / along.iter().filter(|a| **a).count().max(1) as f64).sqrt().max(1e-300)
    };
    let unit = |values: Vec<f64>| {
        let scale = usual(&values);
        values.into_iter().map(|v| v / scale).collect::<Vec<f64>>()
    };
    let speed = unit(of(&|r| r.motion.velocity));
    let direction = of(&|r| r.motion.direction);
    let load = track.planar.then(|| unit(of(&|r| r.motion.normal_force_n)));
    let friction: Vec<f64> = match &load {
        Some(load) => direction.iter().zip(load).map(|(d, l)| d * l.abs()).collect(),
        None => direction.clone(),
    };
    let angle = of(&|r| r.angle_rad);
    let turns = track.radius_m.is_some();
    let place = if turns { periodic(&angle, TERMS as u32) } else { over_range(&angle, &along, 0.06, 2 * TERMS) };
    // Nothing centres an unknown force over the position: its mean looks like friction by direction. With means over speed
    // and load as well, one more of 99 right names beside structure is lost.
    let with_mean = [place.as_slice(), &[vec![1.0; rows.len()]]].concat();
    let acts: Vec<f64> = along.iter().map(|a| f64::from(u8::from(*a))).collect();
    let fast: Vec<f64> = speed.iter().map(|v| v.abs()).collect();
    let over_speed = over_range(&fast, &along, 0.15, TERMS);
    let slow = |hz: f64| over_time(time_s, hz, 1.0, MANY_TERMS);
    let (sensor, wear) = (slow(1.5), slow(0.4));
    let mut found = vec![
        Discrepancy::of("position", &acts, &with_mean),
        Discrepancy::of("friction over the position", &friction, &place),
        Discrepancy::of("viscous friction over the position", &speed, &place),
        Discrepancy::of_force("speed", &along, &over_speed),
        Discrepancy::of("friction over the speed", &direction, &over_speed),
        Discrepancy::of("friction over time", &friction, &wear),
        Discrepancy::of("viscous friction over time", &speed, &wear),
        Discrepancy::of("friction over the way since the last reversal", &friction, &since_reversal(track, &along)),
    ];
    if let Some(load) = &load {
        let over_load = over_range(load, &along, 0.15, TERMS);
        found.push(Discrepancy::of("load and position", load, &place));
        found.push(Discrepancy::of_force("load", &along, &over_load));
        found.push(Discrepancy::of("friction over the load", &direction, &over_load));
    }
    found.push(state(&angle, turns, (&speed, load.as_deref()), &along));
    found.push(wander(track, &sensor));
    found.push(creep(track, time_s, predicted));
    found.push(reading(track, predicted));
    found.into_iter().flatten().collect()
}

/// A function of the whole state.
fn state(angle: &[f64], turns: bool, (speed, load): (&[f64], Option<&[f64]>), along: &[bool]) -> Option<Discrepancy> {
    let mut variables: Vec<Vec<f64>> = if turns {
        vec![angle.iter().map(|a| 2.0 * a.cos()).collect(), angle.iter().map(|a| 2.0 * a.sin()).collect()]
    } else {
        let used: Vec<f64> = angle.iter().zip(along).filter(|(_, u)| **u).map(|(a, _)| *a).collect();
        let (low, high) = used.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(*a), h.max(*a)));
        vec![angle.iter().map(|a| 6.0 * (a - low) / (high - low).max(1e-300)).collect()]
    };
    variables.push(speed.to_vec());
    variables.extend(load.map(<[f64]>::to_vec));
    Discrepancy::of_force("position, speed and load together", along, &field(&variables, MANY_TERMS))
}

/// Slow error of the force sensor, along each of its axes.
fn wander(track: &Track, slow: &[Vec<f64>]) -> Option<Discrepancy> {
    let axis = |row: &Row, k: usize| match row.place {
        Place::Along if track.planar => [row.along.x, row.along.y][k],
        Place::Along | Place::FreeX => f64::from(u8::from(k == 0)),
        Place::FreeY => f64::from(u8::from(k == 1)),
        Place::Stuck { .. } => 0.0,
    };
    let axes = if track.planar { 2 } else { 1 };
    let one =
        |k: usize| slow.iter().map(move |wave| track.rows.iter().zip(wave).map(|(r, w)| axis(r, k) * w).collect());
    Discrepancy::new("time", (0..axes).flat_map(one).collect())
}

/// The sensor's reading as a function of the force, along each of its axes: a bent or coarse scale.
fn reading(track: &Track, predicted: &[f64]) -> Option<Discrepancy> {
    let along: Vec<bool> = track.rows.iter().map(|r| r.place == Place::Along).collect();
    let axis = |k: usize| -> Vec<Vec<f64>> {
        let share = |row: &Row| if track.planar { [row.along.x, row.along.y][k] } else { 1.0 };
        let force: Vec<f64> = track.rows.iter().zip(predicted).map(|(row, p)| force(track, row, *p)[k]).collect();
        let mut waves = over_range(&force, &along, 0.06, 2 * TERMS);
        for wave in &mut waves {
            wave.iter_mut().zip(&track.rows).for_each(|(w, row)| *w *= share(row));
        }
        waves
    };
    Discrepancy::new("force", (0..if track.planar { 2 } else { 1 }).flat_map(axis).collect())
}

/// Predicted force along the motion and measured force across it, along the axes of the sensor.
fn force(track: &Track, row: &Row, predicted: f64) -> [f64; 2] {
    if !track.planar {
        return [predicted, 0.0];
    }
    let across = row.motion.normal_force_n;
    [predicted * row.along.x + across * row.along.y, predicted * row.along.y - across * row.along.x]
}

/// Creep and relaxation: the predicted force, late by first-order lags of a tenth of a second to some seconds.
fn creep(track: &Track, time_s: &[f64], predicted: &[f64]) -> Option<Discrepancy> {
    let late = |lag_s: f64| {
        let mut state = [0.0; 2];
        let mut last: Option<(usize, f64)> = None;
        let value = |(i, row): (usize, &Row)| {
            if row.place != Place::Along {
                return 0.0;
            }
            let force = force(track, row, predicted[i]);
            let passed = last.filter(|(recording, _)| *recording == row.recording).map(|(_, t)| time_s[i] - t);
            let keep = passed.map_or(0.0, |dt| (-dt.max(0.0) / lag_s).exp());
            (0..2).for_each(|k| state[k] = force[k] + keep * (state[k] - force[k]));
            last = Some((row.recording, time_s[i]));
            let behind = [state[0] - force[0], state[1] - force[1]];
            if track.planar { behind[0] * row.along.x + behind[1] * row.along.y } else { behind[0] }
        };
        track.rows.iter().enumerate().map(value).collect::<Vec<f64>>()
    };
    Discrepancy::new("past force", CREEP_LAGS_S.values().map(late).collect())
}

/// Functions of the distance since the last reversal, in which distances far above the usual one are alike.
fn since_reversal(track: &Track, along: &[bool]) -> Vec<Vec<f64>> {
    let (mut way, mut side) = (0.0, 0.0);
    let mut last: Option<(usize, f64)> = None;
    let mut ways = Vec::with_capacity(track.rows.len());
    for (row, along) in track.rows.iter().zip(along) {
        if *along {
            let step = last.filter(|(s, _)| *s == row.segment).map_or(0.0, |(_, p)| row.motion.position - p);
            let turned = row.motion.direction * side < 0.0;
            if row.motion.direction.abs() > 0.5 {
                side = row.motion.direction.signum();
            }
            way = if turned { 0.0 } else { way + step.abs() };
            last = Some((row.segment, row.motion.position));
        }
        ways.push(way);
    }
    let mut sorted: Vec<f64> = ways.iter().zip(along).filter(|(_, a)| **a).map(|(w, _)| *w).collect();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 4).copied().unwrap_or(0.0).max(1e-300);
    let bent: Vec<f64> = ways.iter().map(|w| w / (w + usual)).collect();
    over_range(&bent, along, 0.15, TERMS)
}
