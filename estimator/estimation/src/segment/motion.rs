//! Cranks, mechanisms and switches: speed and load, from which the rules tell not touched, held still and moved.

use super::poses::{REST_RAD_S, angular_speed};
use super::rules::beyond;
use super::runs::LEAST_SAMPLES;
use super::single_tool::speed_and_load;
use super::threshold::{Levels, choose, percentile};
use foundation::estimate::EstimateError;
use foundation::signal::task::{TaskSignals, calmed, is_two_fingered, task_signals, times};
use foundation::tasks::definition::Definition;
use foundation::tasks::{Sign, SystemState, Thresholds};
use haptics::Vec2;
use haptics::recording::{Recording, Task};

/// The signals that rest and motion are told from, one entry a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Sample times, s (sample numbers when the log is clockless).
    pub time_s: Vec<f64>,
    /// Speed without sign, m/s or rad/s.
    pub speed: Vec<f64>,
    /// Grip or force of the tool, N; absent for a coordinate without fingers.
    pub load: Option<Vec<f64>>,
    /// Thresholds for both.
    pub thresholds: Thresholds,
    /// Share of the load's threshold below which nothing is touched any more, where its noise asks for less than the task does.
    pub leave_load: f64,
    /// Changes of the load that pass sooner are no contact made or lost, s.
    pub least_change_s: f64,
    /// Sentences about the forces at rest.
    pub warnings: Vec<String>,
}

impl Motion {
    /// The signals of a recording.
    pub fn of(recording: &Recording, given: Option<Thresholds>, task: &Definition) -> Result<Self, EstimateError> {
        let time_s = times(recording);
        if time_s.len() < LEAST_SAMPLES {
            return Err(EstimateError::TooFewSamples {
                recording: recording.name.clone(),
                samples: time_s.len(),
                what: " for a segmentation".to_owned(),
                needed: LEAST_SAMPLES,
            });
        }
        if task.like == Task::Payload {
            let learned = || Thresholds { velocity_m_s: REST_RAD_S, force_n: 0.0 };
            return Ok(Self {
                time_s,
                speed: angular_speed(recording)?,
                load: None,
                thresholds: task.thresholds(given, learned),
                leave_load: task.thresholds.leave,
                least_change_s: 0.0,
                warnings: Vec::new(),
            });
        }
        if !is_two_fingered(recording) {
            return Self::of_single_tool(recording, time_s, given, task);
        }
        let signals = calmed(&task_signals(recording)?);
        let levels = Levels::of(&signals);
        let thresholds = task.thresholds(given, || choose(&signals, &levels));
        let mut load = push_without_bias(&signals, &levels);
        if task.like == Task::Crank {
            let open = levels.opened(&signals, thresholds.force_n);
            load.iter_mut().zip(open).filter(|(_, open)| *open).for_each(|(load, _)| *load = 0.0);
        }
        let speed: Vec<f64> = signals.velocity.iter().map(Vec2::norm).collect();
        let leave_load = task.thresholds.leave;
        Ok(Self {
            time_s,
            speed,
            load: Some(load),
            thresholds,
            leave_load,
            least_change_s: 0.0,
            warnings: levels.warnings(),
        })
    }

    fn of_single_tool(
        recording: &Recording,
        time_s: Vec<f64>,
        given: Option<Thresholds>,
        task: &Definition,
    ) -> Result<Self, EstimateError> {
        let (speed, load) = speed_and_load(recording, &time_s)?;
        let usual = percentile(&mut speed.clone(), 0.95);
        let learned_n = load.as_ref().map_or(0.0, |l| l.force_n);
        let thresholds = task.thresholds(given, || Thresholds { velocity_m_s: 0.1 * usual, force_n: learned_n });
        let (leave_load, least_change_s) = load.as_ref().map_or((1.0, 0.0), |l| (l.leave, l.least_change_s));
        let (load, warnings) = load.map_or((None, Vec::new()), |l| (Some(l.values), l.warnings));
        Ok(Self { time_s, speed, load, thresholds, leave_load, least_change_s, warnings })
    }

    /// The state of every sample by the task's rules alone.
    pub fn states(&self, task: &Definition) -> Vec<SystemState> {
        let (rules, leave) = (task.rules(), task.thresholds.leave);
        let loads = self.load.as_ref().map(|load| {
            let mut before = Sign::Zero;
            let mut signs: Vec<Sign> = load
                .iter()
                .map(|value| {
                    before = beyond(before, *value, self.thresholds.force_n, self.leave_load.min(leave));
                    before
                })
                .collect();
            without_short(&self.time_s, &mut signs, self.least_change_s);
            signs
        });
        let mut speed = Sign::Zero;
        (0..self.time_s.len())
            .map(|i| {
                speed = beyond(speed, self.speed[i], self.thresholds.velocity_m_s, leave);
                rules.state(&[loads.as_ref().map(|l| l[i]), Some(speed)])
            })
            .collect()
    }
}

/// Takes out runs of a sign that are shorter than `least_s` and have others on both sides. Runs without load come
/// first, because a load passes through zero while a crank is turned.
fn without_short(time_s: &[f64], signs: &mut [Sign], least_s: f64) {
    for (short, other) in [(Sign::Zero, Sign::Plus), (Sign::Plus, Sign::Zero)] {
        let mut first = 0;
        for i in 1..signs.len() {
            if signs[i] == signs[first] {
                continue;
            }
            if first > 0 && signs[first] == short && time_s[i] - time_s[first] < least_s {
                signs[first..i].fill(other);
            }
            first = i;
        }
    }
}

/// The larger of the two fingers' forces: a switch is pushed, and a hand that pulls a crank harder than it squeezes still holds it.
fn push_without_bias(signals: &TaskSignals, levels: &Levels) -> Vec<f64> {
    let push = |finger: usize, i: usize| {
        signals.tips[finger].force.as_ref().map_or(0.0, |f| (f[i] - levels.bias_n[finger]).norm())
    };
    (0..signals.len()).map(|i| push(0, i).max(push(1, i))).collect()
}

#[cfg(test)]
mod tests {
    use crate::segment::segment;
    use foundation::tasks::SystemState;
    use haptics::recording::{Channel, Meta, Recording, Task};

    const RATE_HZ: f64 = 200.0;

    /// Two fingers that grip a handle from 1 s to 9 s, turn it, and open in place. The second one's sensor drifts.
    fn turned(drift_n_s: f64) -> Recording {
        let n = 2000;
        let time_s = |i: usize| i as f64 / RATE_HZ;
        let closed = |i: usize| (time_s(i) - 1.0).clamp(0.0, 0.5).min((9.0 - time_s(i)).clamp(0.0, 0.5)) / 0.5;
        let pressed = |i: usize| (5.0 * closed(i) - 4.0).max(0.0);
        let noise = |i: usize, k: usize| 0.004 * (1.3 * (i * i + 7 * k) as f64).sin();
        let angle = |i: usize| 1.2 * (time_s(i).clamp(1.5, 8.5) - 1.5).sin();
        let x = |i: usize, side: f64| 0.02 * angle(i).cos() + side * (0.004 + 0.006 * (1.0 - closed(i)));
        let drift = |i: usize, finger: f64| 0.5 * (finger + 1.0) * drift_n_s * time_s(i);
        let channel = |name: &str, of: &dyn Fn(usize) -> f64| Channel {
            name: name.to_owned(),
            unit: String::new(),
            values: (0..n).map(of).collect(),
        };
        let of_finger = |k: usize, side: f64| {
            vec![
                channel(&format!("x{k}_m"), &|i| x(i, side)),
                channel(&format!("y{k}_m"), &|i| 0.02 * angle(i).sin()),
                channel(&format!("fx{k}_N"), &|i| -side * 2.0 * pressed(i) + noise(i, k)),
                channel(&format!("fy{k}_N"), &|i| 0.2 * pressed(i) + drift(i, side) + noise(i, k + 2)),
            ]
        };
        let channels = [of_finger(1, -1.0), of_finger(2, 1.0)].concat();
        let meta = Meta { task: Some(Task::Crank), ..Meta::default() };
        Recording { time_s: Some((0..n).map(time_s).collect()), channels, meta, ..Recording::default() }
    }

    #[test]
    fn an_opened_hand_is_free_whatever_its_sensor_reads() {
        for drift_n_s in [0.0, 0.03] {
            let found = segment(&turned(drift_n_s), None, None).expect("segments");
            let last = found.states.last().expect("states");
            assert_eq!(last.state, SystemState::FreeMotion, "{drift_n_s}");
            assert!((8.5..8.7).contains(&last.t0), "{drift_n_s}: free from {} s on", last.t0);
        }
    }
}
