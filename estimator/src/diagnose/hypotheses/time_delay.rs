//! A delay of the force after the motion as a hypothesis.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::hypothesis::{About, Hypothesis};
use super::relations::Relation;
use super::sensor_fault::{SensorFault, add_each, fingers};
use super::variable::Variable;
use crate::diagnose::data::regression_data::{Row, Track};
use foundation::signal::derive::savitzky_golay;
use haptics::law::Kind;
use std::ops::Range;

pub(crate) const ID: &str = "time-delay";

pub(crate) struct TimeDelay;

impl Hypothesis for TimeDelay {
    fn about(&self) -> About {
        About { id: ID, relations: &[Relation::NeedsForce], seen: Variable::ForceRate, ..About::PLAIN }
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        vec![Candidate::one(ID, Kind::Instrument, "tau", "s", late(data))]
    }

    fn add_to_fault(&self, fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
        add_each(candidate, values, |name, value| {
            let is_delay = fingers(name).1 == "tau";
            if is_delay {
                fault.delay_s = value;
            }
            is_delay
        })
    }
}

/// Effect of a force delay of one second along the motion: the rate of the predicted force, and of the load that turns
/// with the arm. The rate of the measured force is not used, because its noise would explain itself.
fn late(data: &Dictionary<'_>) -> Vec<f64> {
    let rows = &data.track.rows;
    let radius = data.track.radius_m.unwrap_or(1.0);
    let turning = |row: &Row| row.motion.normal_force_n * row.motion.velocity / radius;
    let mut column = vec![0.0; rows.len()];
    for range in segments(data.track) {
        for (i, rate) in range.clone().zip(rates(data, range)) {
            column[i] = -(rate + if data.track.planar { turning(&rows[i]) } else { 0.0 });
        }
    }
    column
}

/// Segments of rows along the motion.
fn segments(track: &Track) -> Vec<Range<usize>> {
    let mut segments: Vec<Range<usize>> = Vec::new();
    for i in track.along() {
        match segments.last_mut() {
            Some(segment) if segment.end == i && track.follows(i) => segment.end += 1,
            _ => segments.push(i..i + 1),
        }
    }
    segments
}

/// Rates of the predicted force, through the window through which the acceleration was estimated: the part that this
/// window takes off an inertia's force would otherwise pass for a delay.
fn rates(data: &Dictionary<'_>, range: Range<usize>) -> Vec<f64> {
    let time_s: Vec<f64> = data.track.rows[range.clone()].iter().map(|r| r.motion.time_s).collect();
    let force = &data.predicted[range];
    if let Some((half, order)) = data.track.slope {
        return savitzky_golay(&time_s, force, half, order).first;
    }
    let last = force.len() - 1;
    let rate = |k: usize| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
        let apart_s = time_s[after] - time_s[before];
        if apart_s > 0.0 { (force[after] - force[before]) / apart_s } else { 0.0 }
    };
    (0..force.len()).map(rate).collect()
}
