//! Structured errors of a channel that is not a motion along one coordinate.

use super::smooth::{Discrepancy, field, over_range, over_time};
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::selection::comparison::View;

/// Half waves of a function of one variable.
const HALF_WAVES: usize = 8;
/// Half waves of a function of time, of one sensor.
const WAVES_OF_TIME: usize = 32;
/// Fewest rows of a sensor.
const FEWEST_ROWS: usize = 20;

/// All discrepancies of a channel.
pub fn discrepancies(view: &View) -> Vec<Discrepancy> {
    let rows = view.sensor.len();
    let mut sensors: Vec<usize> = view.sensor.clone();
    sensors.sort_unstable();
    sensors.dedup();
    let masks: Vec<Vec<bool>> = sensors.iter().map(|s| view.sensor.iter().map(|o| o == s).collect()).collect();
    let masks: Vec<Vec<bool>> = masks.into_iter().filter(|m| m.iter().filter(|m| **m).count() >= FEWEST_ROWS).collect();
    let on = |mask: &[bool]| mask.iter().map(|m| f64::from(u8::from(*m))).collect::<Vec<f64>>();
    let direction = |mask: &[bool]| -> Vec<f64> {
        view.way.iter().zip(mask).map(|(w, m)| if *m && *w != 0.0 { w.signum() } else { 0.0 }).collect()
    };
    let times = |carrier: &[f64], basis: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let product = |column: Vec<f64>| column.iter().zip(carrier).map(|(a, b)| a * b).collect();
        basis.into_iter().map(product).collect()
    };
    let mut found = Vec::new();
    for (variable, values) in &view.over {
        let word = variable.word();
        if *variable == Variable::Time {
            let time_s = joined(view, values);
            let waves = over_time(&time_s, 1.5, 1.0, WAVES_OF_TIME);
            found.push(Discrepancy::new(word, masks.iter().flat_map(|m| times(&on(m), waves.clone())).collect()));
            continue;
        }
        let of = |m: &Vec<bool>| over_range(values, m, 0.15, HALF_WAVES);
        found.push(Discrepancy::new(word, masks.iter().flat_map(|m| times(&on(m), of(m))).collect()));
        if view.way.len() == rows {
            let columns = masks.iter().flat_map(|m| times(&direction(m), of(m))).collect();
            found.push(Discrepancy::new(word, columns));
        }
    }
    found.push(of_all(view, &masks));
    found.into_iter().flatten().collect()
}

/// A function of all variables but time together, of each sensor.
fn of_all(view: &View, masks: &[Vec<bool>]) -> Option<Discrepancy> {
    const FEATURES: usize = 48;
    let unit = |values: &Vec<f64>| -> Vec<f64> {
        let n = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / n;
        let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt().max(1e-300);
        values.iter().map(|v| (v - mean) / deviation).collect()
    };
    let variables: Vec<Vec<f64>> =
        view.over.iter().filter(|(v, _)| *v != Variable::Time).map(|(_, values)| unit(values)).collect();
    if variables.len() < 2 {
        return None;
    }
    let features = field(&variables, FEATURES);
    let masked = |m: &Vec<bool>| -> Vec<Vec<f64>> {
        let of = |f: &Vec<f64>| f.iter().zip(m).map(|(v, m)| if *m { *v } else { 0.0 }).collect();
        features.iter().map(of).collect()
    };
    Discrepancy::new("state", masks.iter().flat_map(masked).collect())
}

/// Times of several recordings, one after the other.
fn joined(view: &View, time_s: &[f64]) -> Vec<f64> {
    let span_s = time_s.iter().copied().fold(0.0, f64::max) + 1.0;
    let recording = |i: usize| view.recording.get(i).copied().unwrap_or(0) as f64;
    time_s.iter().enumerate().map(|(i, t)| t + span_s * recording(i)).collect()
}
