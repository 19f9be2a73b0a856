//! Sensor faults applied to a recording: the motion is unchanged, only the force readings change.

use estimator::diagnose::SensorFault;
use haptics::Vec2;
use haptics::recording::Recording;

/// Names of the forces of both fingers, and of a single tool, which has the first finger's sensor.
const FORCES: [(usize, [&str; 2]); 3] = [(0, ["fx1_N", "fy1_N"]), (1, ["fx2_N", "fy2_N"]), (0, ["fx_N", "fy_N"])];

/// Replaces the forces by the readings of such sensors. `held_from_s`: time from which an object is held.
pub fn see_through(recording: &mut Recording, fault: &SensorFault, held_from_s: f64) {
    let Some(times) = recording.time_s.clone().filter(|_| *fault != SensorFault::default()) else { return };
    for (finger, names) in FORCES {
        let (Some(x), Some(y)) = (recording.channel(names[0]), recording.channel(names[1])) else { continue };
        let felt: Vec<Vec2> = x.iter().zip(y).map(|(x, y)| Vec2::new(*x, *y)).collect();
        let drifts_from_s =
            if fault.drifts_once_held { held_from_s } else { times.first().copied().unwrap_or_default() };
        let read = read(&times, &felt, (fault, finger), drifts_from_s);
        for channel in &mut recording.channels {
            let part: fn(&Vec2) -> f64 = match names.iter().position(|name| *name == channel.name) {
                Some(0) => |force| force.x,
                Some(_) => |force| force.y,
                None => continue,
            };
            channel.values = read.iter().map(part).collect();
        }
    }
}

/// Applies the fault to the force along a mechanism's coordinate.
pub fn see_along(recording: &mut Recording, fault: &SensorFault) {
    let Some(times) = recording.time_s.clone().filter(|_| *fault != SensorFault::default()) else { return };
    let Some(channel) = recording.channels.iter_mut().find(|c| ["f_N", "tau_Nm"].contains(&c.name.as_str())) else {
        return;
    };
    let felt: Vec<Vec2> = channel.values.iter().map(|force| Vec2::new(*force, 0.0)).collect();
    let begun_s = times.first().copied().unwrap_or_default();
    let read = |time_s: f64| {
        let drifted_for_s = fault.drifted_for(time_s - begun_s);
        let force = at(&times, &felt, time_s - fault.delay_s).x;
        let stepped: f64 = fault.steps_until(time_s - begun_s).map(|step| step.along).sum();
        (1.0 + fault.gain_error) * force + fault.offset_along + drifted_for_s * fault.drift_along_per_s + stepped
    };
    channel.values = times.iter().map(|time_s| read(*time_s)).collect();
}

/// Reading of a finger's sensor at each time, N.
fn read(times: &[f64], felt: &[Vec2], (fault, finger): (&SensorFault, usize), drifts_from_s: f64) -> Vec<Vec2> {
    let cross = fault.cross[finger];
    let begun_s = times.first().copied().unwrap_or_default();
    times
        .iter()
        .map(|time_s| {
            let force = at(times, felt, time_s - fault.delay_s);
            let crossed = Vec2::new(force.x + cross.x * force.y, force.y + cross.y * force.x);
            let drifts_s = (time_s - drifts_from_s).max(0.0);
            (1.0 + fault.gain_error) * crossed + fault.zero_n(finger, time_s - begun_s, drifts_s)
        })
        .collect()
}

/// Force at a time by linear interpolation; constant before the first sample and after the last.
fn at(times: &[f64], felt: &[Vec2], time_s: f64) -> Vec2 {
    let after = times.partition_point(|t| *t <= time_s);
    match (after.checked_sub(1).and_then(|i| felt.get(i)), felt.get(after)) {
        (Some(before), Some(next)) => {
            let share = (time_s - times[after - 1]) / (times[after] - times[after - 1]);
            before + (next - before) * share
        }
        (Some(only), None) | (None, Some(only)) => *only,
        (None, None) => Vec2::zeros(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    /// Recording of one second with a force that grows linearly in y and is constant in x.
    fn ramp() -> Recording {
        let times: Vec<f64> = (0..101).map(|k| 3.0 + 0.01 * f64::from(k)).collect();
        let channel = |name: &str, of: &dyn Fn(f64) -> f64| Channel {
            name: name.to_owned(),
            unit: "N".to_owned(),
            values: times.iter().map(|t| of(*t - 3.0)).collect(),
        };
        let channels = vec![
            channel("fx1_N", &|_| 2.0),
            channel("fy1_N", &|t| t),
            channel("fx2_N", &|_| -2.0),
            channel("fy2_N", &|t| t),
        ];
        Recording { time_s: Some(times), channels, ..Recording::default() }
    }

    /// Readings at half a second: both axes of the first finger, then of the second.
    fn half_way(fault: &SensorFault) -> [f64; 4] {
        let mut recording = ramp();
        see_through(&mut recording, fault, 3.4);
        ["fx1_N", "fy1_N", "fx2_N", "fy2_N"].map(|name| recording.channel(name).expect("a channel")[50])
    }

    fn near(found: [f64; 4], expected: [f64; 4]) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}, not {expected:?}");
    }

    #[test]
    fn every_fault_changes_what_it_is_about_and_nothing_else() {
        let none = SensorFault::default();
        near(half_way(&none), [2.0, 0.5, -2.0, 0.5]);
        let offset_n = [Vec2::new(0.1, 0.0), Vec2::new(0.0, -0.2)];
        near(half_way(&SensorFault { offset_n, ..none }), [2.1, 0.5, -2.0, 0.3]);
        let drift_n_s = [Vec2::zeros(), Vec2::new(0.0, 0.4)];
        near(half_way(&SensorFault { drift_n_s, ..none }), [2.0, 0.5, -2.0, 0.7]);
        near(half_way(&SensorFault { drift_n_s, drifts_once_held: true, ..none }), [2.0, 0.5, -2.0, 0.54]);
        let cross = [Vec2::new(0.0, 0.1), Vec2::zeros()];
        near(half_way(&SensorFault { cross, ..none }), [2.0, 0.7, -2.0, 0.5]);
        near(half_way(&SensorFault { gain_error: -0.1, ..none }), [1.8, 0.45, -1.8, 0.45]);
        near(half_way(&SensorFault { delay_s: 0.025, ..none }), [2.0, 0.475, -2.0, 0.475]);
    }

    #[test]
    fn along_a_coordinate_an_offset_a_drift_and_a_delay_are_read() {
        let mut recording = ramp();
        recording.channels.retain(|c| c.name == "fy1_N");
        recording.channels[0].name = "f_N".to_owned();
        let fault = SensorFault { offset_along: 0.3, drift_along_per_s: 0.2, delay_s: 0.05, ..SensorFault::default() };
        see_along(&mut recording, &fault);
        let read = recording.channel("f_N").expect("still there")[50];
        assert!((read - (0.45 + 0.3 + 0.1)).abs() < 1e-9, "{read}");
    }
}
