//! Structured errors of a channel in whose view stand the variables that it may go with.

use super::of_coordinate::{CREEP_LAGS_S, MANY_TERMS, TERMS};
use super::smooth::{Discrepancy, field, over_range, over_time};
use crate::diagnose::data::limits::LEAST_ROWS_OF_A_FIT;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::View;
use estimation::regression::linear::{Values, least_squares_values};

/// All discrepancies of the rows of a comparison: functions of each variable, with and without the direction of motion, of
/// time, of all variables together, and of the past. Each sensor has its own.
fn discrepancies(view: &View, own: &[Variable], predicted: &[f64]) -> Vec<Discrepancy> {
    let sensors = sensors(view);
    // Many sensors have few terms each, but enough for a curve.
    let many = (MANY_TERMS / sensors.len().max(1)).max(TERMS / 3);
    let few = TERMS.min(many);
    let acts = |column: &Vec<f64>| column.iter().any(|v| *v != 0.0);
    let each =
        |of: &dyn Fn(&[bool]) -> Vec<Vec<f64>>| sensors.iter().flat_map(|own| of(own)).filter(acts).collect::<Vec<_>>();
    let mut found = Vec::new();
    for (variable, values) in view.over.iter().filter(|(v, _)| !own.contains(v)) {
        let over = variable.word();
        if *variable == Variable::Time {
            let time_s = joined(view, values);
            found.push(Discrepancy::new(over, each(&|own| over_own_time(&time_s, own, many))));
            continue;
        }
        let waves = |own: &[bool]| over_range(values, own, 0.15, few);
        found.push(Discrepancy::new(over, each(&|own| waves(own).iter().map(|w| varying(w, own)).collect())));
        if !view.way.is_empty() {
            let turned = |wave: &Vec<f64>| wave.iter().zip(&view.way).map(|(w, v)| sign(*v) * w).collect();
            found.push(Discrepancy::new(over, each(&|own| waves(own).iter().map(turned).collect())));
        }
    }
    let state: Vec<Vec<f64>> = view
        .over
        .iter()
        .filter(|(v, _)| *v != Variable::Time && !own.contains(v))
        .map(|(_, values)| unit(values))
        .collect();
    if state.len() > 1 {
        let features = field(&state, many);
        let all = each(&|own| features.iter().map(|f| varying(f, own)).collect());
        found.push(Discrepancy::new("all of these together", all));
    }
    if let Some((_, values)) = view.over.iter().find(|(v, _)| *v == Variable::Time) {
        let late = each(&|own| past(predicted, &joined(view, values), own));
        found.push(Discrepancy::new("past force", late));
    }
    found.into_iter().flatten().collect()
}

/// A channel with its structured errors. `own`: variables without a function of their own. One is the target itself, with
/// the same noise, or one whose curve is the law of the channel, which causes describe.
pub fn beside_errors(channel: Channel, view: &View, own: &[Variable]) -> Channel {
    let Channel { target, baseline, layout, .. } = &channel;
    let weight: Vec<f64> = layout.weight.iter().map(|w| w * w).collect();
    let of_model = |fit: Values| target.iter().zip(fit.residuals).map(|(y, r)| y - r).collect();
    let predicted =
        least_squares_values(baseline, target, Some(&weight)).map_or_else(|_| vec![0.0; target.len()], of_model);
    Channel { errors: discrepancies(view, own, &predicted), ..channel }
}

/// Functions of time in these rows alone, over their own span.
fn over_own_time(time_s: &[f64], own: &[bool], most: usize) -> Vec<Vec<f64>> {
    let rows: Vec<usize> = (0..own.len()).filter(|i| own[*i]).collect();
    let times: Vec<f64> = rows.iter().map(|i| time_s[*i]).collect();
    let spread = |wave: Vec<f64>| {
        let mut column = vec![0.0; own.len()];
        rows.iter().zip(wave).for_each(|(i, w)| column[*i] = w);
        column
    };
    over_time(&times, 1.5, 1.0, most).into_iter().map(spread).collect()
}

/// Rows of each sensor that has enough of them.
fn sensors(view: &View) -> Vec<Vec<bool>> {
    let mut all = view.sensor.clone();
    all.sort_unstable();
    all.dedup();
    let rows = |sensor: &usize| view.sensor.iter().map(|s| s == sensor).collect::<Vec<bool>>();
    all.iter().map(rows).filter(|own| own.iter().filter(|o| **o).count() >= LEAST_ROWS_OF_A_FIT).collect()
}

fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// These values in their own rows less their mean.
fn varying(values: &[f64], own: &[bool]) -> Vec<f64> {
    let rows = own.iter().filter(|o| **o).count().max(1) as f64;
    let mean = values.iter().zip(own).filter(|(_, o)| **o).map(|(v, _)| v).sum::<f64>() / rows;
    values.iter().zip(own).map(|(v, o)| if *o { v - mean } else { 0.0 }).collect()
}

/// Values of mean 0 and variance 1.
fn unit(values: &[f64]) -> Vec<f64> {
    let varied = varying(values, &vec![true; values.len()]);
    let power = varied.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64;
    varied.iter().map(|v| v / power.sqrt().max(f64::MIN_POSITIVE)).collect()
}

/// Times of all recordings, one after the other, s.
fn joined(view: &View, time_s: &[f64]) -> Vec<f64> {
    let span_s = time_s.iter().copied().fold(0.0, f64::max) + 1.0;
    let start_s = |i: usize| span_s * view.recording.get(i).copied().unwrap_or(0) as f64;
    time_s.iter().enumerate().map(|(i, t)| t + start_s(i)).collect()
}

/// The predicted force of a sensor behind first-order lags, less that force: creep and relaxation.
fn past(predicted: &[f64], time_s: &[f64], own: &[bool]) -> Vec<Vec<f64>> {
    let mut order: Vec<usize> = (0..own.len()).filter(|i| own[*i]).collect();
    order.sort_by(|a, b| time_s[*a].total_cmp(&time_s[*b]));
    let late = |lag_s: f64| {
        let mut column = vec![0.0; own.len()];
        let mut state = 0.0;
        let mut last: Option<f64> = None;
        for i in &order {
            let keep = last.map_or(0.0, |t| (-(time_s[*i] - t) / lag_s).exp());
            state = predicted[*i] + keep * (state - predicted[*i]);
            last = Some(time_s[*i]);
            column[*i] = state - predicted[*i];
        }
        column
    };
    CREEP_LAGS_S.values().map(late).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sensors, one after the other, whose rows go with time and place.
    fn view() -> View {
        let time_s: Vec<f64> = (0..200).map(|i| 0.05 * f64::from(i)).collect();
        let place = time_s.iter().map(|t| (0.7 * t).sin()).collect();
        let over = vec![(Variable::Time, time_s), (Variable::Place, place)];
        let sensor = (0..200).map(|i| i / 100).collect();
        View { sensor, ..View::of(vec![0; 200], over, |_| Variable::Place) }
    }

    #[test]
    fn each_sensor_has_functions_of_its_own_without_a_mean() {
        let view = view();
        let sensors = sensors(&view);
        assert_eq!(sensors.len(), 2);
        for wave in over_range(&view.over[1].1, &sensors[1], 0.15, TERMS) {
            let column = varying(&wave, &sensors[1]);
            assert!(column[..100].iter().all(|v| *v == 0.0));
            assert!(column.iter().sum::<f64>().abs() < 1e-9);
        }
        let slow = over_own_time(&view.over[0].1, &sensors[1], TERMS);
        assert!(slow.iter().all(|w| w[..100].iter().all(|v| *v == 0.0) && w[100..].iter().any(|v| v.abs() > 0.01)));
    }

    #[test]
    fn a_constant_force_has_no_past_and_a_step_creeps_as_its_lags_do() {
        let own = vec![true; 200];
        let time_s: Vec<f64> = (0..200).map(|i| 0.05 * f64::from(i)).collect();
        assert!(past(&[2.0; 200], &time_s, &own).iter().flatten().all(|v| v.abs() < 1e-12));
        let step: Vec<f64> = (0..200).map(|i| f64::from(u8::from(i >= 100))).collect();
        for (column, lag_s) in past(&step, &time_s, &own).iter().zip(CREEP_LAGS_S.values()) {
            let behind = |i: usize| -(-(time_s[i] - time_s[99]) / lag_s).exp();
            assert!((100..200).all(|i| (column[i] - behind(i)).abs() < 1e-9), "{lag_s}");
        }
    }
}
