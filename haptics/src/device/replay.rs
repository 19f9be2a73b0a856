//! Replay of a recording: the fingers go where they went.
//!
//! A servo that ticks at the recording's own times gets the recorded samples themselves, so that the same world
//! computes the same forces to the bit. At any other rate positions and velocities are interpolated linearly.

use super::interface::{Command, Device, DeviceSpec, Sample};
use crate::Vec2;
use crate::hand::{Finger, JointAngles};
use crate::recording::Recording;

/// A tick that is this close to a sample, relative to the step between samples, is that sample: 0.1 µs at 1 kHz. Times that were
/// added up and times that were rounded into a file differ by less.
const SAME: f64 = 1e-4;

/// Why a recording cannot be replayed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReplayError {
    /// Nothing to interpolate.
    #[error("{0} cannot be replayed: it needs at least two samples of both fingers' positions")]
    TooShort(String),
    /// Times that stand still, go back or are no numbers.
    #[error("{name} cannot be replayed: its time does not increase at sample {sample}; sort the log by time")]
    Time {
        /// The recording.
        name: String,
        /// Counted from 1.
        sample: usize,
    },
    /// No clock at all.
    #[error("{0} has no clock and cannot be replayed; give rate_hz in its sidecar")]
    NoClock(String),
    /// Neither tips nor joints.
    #[error(
        "{name} cannot be replayed: it has no positions ({missing} is missing); a replay needs tip positions (x1_m, y1_m, x2_m, y2_m \
         or x_m, y_m) or joint angles (qb1_rad, qt1_rad, …)"
    )]
    NoPositions {
        /// The recording.
        name: String,
        /// A column that would have been needed.
        missing: String,
    },
    /// A hole in the data.
    #[error("{name} cannot be replayed: {column} is not a number at sample {sample}; cut the log there")]
    NotANumber {
        /// The recording.
        name: String,
        /// Name of the broken column.
        column: String,
        /// Counted from 1.
        sample: usize,
    },
}

/// A device that plays tip positions back on their own clock.
#[derive(Debug)]
pub struct ReplayDevice {
    spec: DeviceSpec,
    time_s: Vec<f64>,
    tips: [Vec<Vec2>; 2],
    velocities: [Vec<Vec2>; 2],
    now_s: f64,
    next: usize,
}

impl ReplayDevice {
    /// `time_s` strictly increasing, tips and velocities one a sample; at least two samples.
    pub fn new(
        name: &str,
        time_s: Vec<f64>,
        tips: [Vec<Vec2>; 2],
        velocities: [Vec<Vec2>; 2],
    ) -> Result<Self, ReplayError> {
        let n = time_s.len();
        if n < 2 || tips.iter().chain(&velocities).any(|c| c.len() != n) {
            return Err(ReplayError::TooShort(name.to_owned()));
        }
        // Written so that not a number counts as broken.
        let broken = time_s.windows(2).position(|pair| !(pair[0] < pair[1] && pair[1].is_finite()));
        if let Some(at) = broken {
            return Err(ReplayError::Time { name: name.to_owned(), sample: at + 2 });
        }
        for (column, series) in
            ["tip 1", "tip 2"].iter().zip(&tips).chain(["velocity 1", "velocity 2"].iter().zip(&velocities))
        {
            if let Some(at) = series.iter().position(|v| !(v.x.is_finite() && v.y.is_finite())) {
                let column = (*column).to_owned();
                return Err(ReplayError::NotANumber { name: name.to_owned(), column, sample: at + 1 });
            }
        }
        let spec = DeviceSpec {
            name: format!("Replay of {name}"),
            force_feedback: false,
            max_force_n: 20.0,
            damping_n_s_m: 0.0,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        };
        let now_s = time_s[0];
        Ok(Self { spec, time_s, tips, velocities, now_s, next: 1 })
    }

    /// Replays a log: tip positions or joint angles with the sidecar's geometry, of two fingers or of a single tool. A single
    /// tool is finger 1; finger 2 is then parked at its base. Velocities that were not recorded are central differences.
    pub fn from_recording(recording: &Recording) -> Result<Self, ReplayError> {
        let time_s = clock(recording)?;
        let n = time_s.len();
        let two = ["x1_m", "qb1_rad"].iter().any(|name| recording.channel(name).is_some());
        let tracks = if two {
            [track(recording, "1", &time_s)?, track(recording, "2", &time_s)?]
        } else {
            let parked = recording.meta.hand().fingers[1].base_m;
            [track(recording, "", &time_s)?, (vec![parked; n], vec![Vec2::zeros(); n])]
        };
        let [one, two] = tracks;
        Self::new(&recording.name, time_s, [one.0, two.0], [one.1, two.1])
    }

    /// Positions of the tips at the beginning, m in the world: a state to start from.
    pub fn start_in_world(&self) -> [Vec2; 2] {
        [self.tips[0][0], self.tips[1][0]]
    }

    /// Length of the recording, s.
    pub fn duration_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or_default() - self.time_s[0]
    }

    fn at(&self, series: &[Vec2]) -> Vec2 {
        let (i, j) = (self.next - 1, self.next);
        let share = ((self.now_s - self.time_s[i]) / (self.time_s[j] - self.time_s[i])).clamp(0.0, 1.0);
        if share < SAME {
            series[i]
        } else if share > 1.0 - SAME {
            series[j]
        } else {
            series[i] + (series[j] - series[i]) * share
        }
    }
}

/// Sample times, s: recorded, or from the sidecar's rate.
fn clock(recording: &Recording) -> Result<Vec<f64>, ReplayError> {
    if let Some(time_s) = &recording.time_s {
        return Ok(time_s.clone());
    }
    match recording.meta.rate_hz {
        Some(rate_hz) if rate_hz > 0.0 && rate_hz.is_finite() => {
            Ok((0..recording.len()).map(|i| i as f64 / rate_hz).collect())
        }
        _ => Err(ReplayError::NoClock(recording.name.clone())),
    }
}

type Track = (Vec<Vec2>, Vec<Vec2>);

/// Positions and velocities of one finger.
fn track(recording: &Recording, finger: &str, time_s: &[f64]) -> Result<Track, ReplayError> {
    let pair = |x: String, y: String| {
        let (x, y) = (recording.channel(&x)?, recording.channel(&y)?);
        // A channel of another length has no meaning beside the clock.
        (x.len() == time_s.len() && y.len() == time_s.len())
            .then(|| x.iter().zip(y).map(|(x, y)| Vec2::new(*x, *y)).collect::<Vec<_>>())
    };
    if let Some(position) = pair(format!("x{finger}_m"), format!("y{finger}_m")) {
        let measured = pair(format!("vx{finger}_m_s"), format!("vy{finger}_m_s"));
        let velocity = measured.unwrap_or_else(|| differences(time_s, &position));
        return Ok((position, velocity));
    }
    let Some(angles) = pair(format!("qb{finger}_rad"), format!("qt{finger}_rad")) else {
        return Err(ReplayError::NoPositions { name: recording.name.clone(), missing: format!("x{finger}_m") });
    };
    let geometry: Finger = recording.meta.hand().fingers[usize::from(finger == "2")];
    let joints = |q: &Vec2| JointAngles { bottom_rad: q.x, top_rad: q.y };
    let position: Vec<Vec2> = angles.iter().map(|q| geometry.tip_in_world(joints(q))).collect();
    let velocity = pair(format!("dqb{finger}_rad_s"), format!("dqt{finger}_rad_s")).map_or_else(
        || differences(time_s, &position),
        |rates| angles.iter().zip(&rates).map(|(q, rate)| geometry.tip_velocity(joints(q), *rate)).collect(),
    );
    Ok((position, velocity))
}

/// Central differences, one-sided at the ends.
fn differences(time_s: &[f64], position: &[Vec2]) -> Vec<Vec2> {
    let last = position.len().saturating_sub(1);
    (0..position.len())
        .map(|i| {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
            let span_s = time_s[b] - time_s[a];
            if span_s > 0.0 { (position[b] - position[a]) / span_s } else { Vec2::zeros() }
        })
        .collect()
}

impl Device for ReplayDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, _command: &Command, dt_s: f64) -> Sample {
        while self.next + 1 < self.time_s.len() && self.time_s[self.next] < self.now_s {
            self.next += 1;
        }
        let sample = Sample {
            tip_in_world: [self.at(&self.tips[0]), self.at(&self.tips[1])],
            tip_velocity: [self.at(&self.velocities[0]), self.at(&self.velocities[1])],
            fresh: [true; 2],
        };
        self.now_s += dt_s;
        sample
    }

    fn make_safe(&mut self) {}

    fn finished(&self) -> bool {
        self.time_s.last().is_none_or(|last| self.now_s > *last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{ScriptedOperator, Skill};
    use crate::recording::Channel;
    use crate::servo::recorder::{SensorModel, to_recording};
    use crate::servo::safety::Limits;
    use crate::servo::{Loop, Swap, TickRecord};
    use crate::world::{State, World, presets};

    #[test]
    fn interpolates_on_its_own_clock_and_ends() {
        let path = |x: f64| vec![Vec2::new(x, 0.0), Vec2::new(x + 1.0, 0.0), Vec2::new(x + 3.0, 0.0)];
        let still = || vec![Vec2::zeros(); 3];
        let mut device = ReplayDevice::new("test", vec![0.0, 1.0, 2.0], [path(0.0), path(10.0)], [still(), still()])
            .expect("two fingers, three samples");
        let xs: Vec<f64> = (0..5).map(|_| device.exchange(&Command::default(), 0.5).tip_in_world[0].x).collect();
        assert_eq!(xs, vec![0.0, 0.5, 1.0, 2.0, 3.0]);
        assert!(device.finished());
        assert!(ReplayDevice::new("x", vec![0.0], [still(), still()], [still(), still()]).is_err());
    }

    fn ticks(world: &World, state: State, device: Box<dyn Device>, dt_s: f64) -> Vec<TickRecord> {
        let swap = Swap::at(world.clone(), state);
        let mut servo = Loop::new(swap, device, Limits { max_force_n: 12.0, ..Limits::default() });
        let mut ticks = Vec::new();
        while !servo.finished() {
            ticks.push(servo.tick(dt_s));
        }
        ticks
    }

    #[test]
    fn a_replay_gives_the_same_forces_to_the_bit() {
        // Rates with an exact period, a rounded one, and one that no binary fraction meets.
        for (world, rate_hz) in
            [(presets::stacking(), 1000.0), (presets::crank(), 4000.0), (presets::stacking(), 1300.0)]
        {
            let dt_s = 1.0 / rate_hz;
            let start = State::resting(&world);
            let operator = ScriptedOperator::new(&world, &start, Skill::expert(), 7);
            let first = ticks(&world, start.clone(), Box::new(operator), dt_s);
            let recording = to_recording("run", &world, &first, 1, &SensorModel::IDEAL, 0);
            let replay = ReplayDevice::from_recording(&recording).expect("tips were recorded");
            let second = ticks(&world, start, Box::new(replay), dt_s);
            assert_eq!(first.len(), second.len());
            assert!(first.iter().any(|t| t.tip_force_n[0].norm() > 1.0), "there was something to feel");
            let differs = first.iter().zip(&second).position(|(a, b)| a != b);
            assert_eq!(differs, None, "{rate_hz} Hz: every field of every tick is equal");
        }
    }

    fn recording(columns: &[(&str, f64)]) -> Recording {
        let channel = |(name, rate): &(&str, f64)| Channel {
            name: (*name).to_owned(),
            unit: String::new(),
            values: (0..50).map(|i| 1.0 + rate * f64::from(i) * 0.01).collect(),
        };
        Recording {
            name: "log".to_owned(),
            time_s: Some((0..50).map(|i| f64::from(i) * 0.01).collect()),
            channels: columns.iter().map(channel).collect(),
            ..Recording::default()
        }
    }

    #[test]
    fn joints_single_tools_and_missing_velocities_are_replayed() {
        let joints = recording(&[("qb1_rad", 0.5), ("qt1_rad", -0.3), ("qb2_rad", 0.1), ("qt2_rad", 0.2)]);
        let mut device = ReplayDevice::from_recording(&joints).expect("joint angles of two fingers");
        let hand = crate::hand::Hand::default();
        let tip = hand.fingers[0].tip_in_world(JointAngles { bottom_rad: 1.0, top_rad: 1.0 });
        assert_eq!(device.start_in_world()[0], tip);
        device.exchange(&Command::default(), 0.01);
        let sample = device.exchange(&Command::default(), 0.01);
        let q = JointAngles { bottom_rad: 1.005, top_rad: 0.997 };
        let velocity = hand.fingers[0].tip_velocity(q, Vec2::new(0.5, -0.3));
        assert!((sample.tip_velocity[0] - velocity).norm() < 1e-4, "derived from the positions");

        let tool = recording(&[("x_m", 0.2), ("y_m", 0.0)]);
        let mut device = ReplayDevice::from_recording(&tool).expect("a single tool");
        let sample = device.exchange(&Command::default(), 0.01);
        assert!((sample.tip_velocity[0] - Vec2::new(0.2, 0.0)).norm() < 1e-9);
        assert_eq!(sample.tip_in_world[1], hand.fingers[1].base_m);
    }

    #[test]
    fn what_cannot_be_replayed_says_why() {
        let sentence =
            |recording: &Recording| ReplayDevice::from_recording(recording).expect_err("not replayable").to_string();
        let forces = recording(&[("fx1_N", 1.0), ("fy1_N", 1.0)]);
        assert!(sentence(&forces).contains("no positions"), "{}", sentence(&forces));
        let one = recording(&[("x1_m", 1.0), ("y1_m", 1.0)]);
        assert!(sentence(&one).contains("x2_m"), "{}", sentence(&one));
        let mut clockless = recording(&[("x_m", 1.0), ("y_m", 1.0)]);
        clockless.time_s = None;
        assert!(sentence(&clockless).contains("rate_hz"));
        clockless.meta.rate_hz = Some(100.0);
        assert!(ReplayDevice::from_recording(&clockless).is_ok());
        let mut hole = recording(&[("x_m", 1.0), ("y_m", 1.0)]);
        hole.channels[1].values[16] = f64::NAN;
        assert!(sentence(&hole).contains("sample 17"), "{}", sentence(&hole));
        let mut back = recording(&[("x_m", 1.0), ("y_m", 1.0)]);
        back.time_s.as_mut().expect("a clock")[9] = 0.0;
        assert!(sentence(&back).contains("sample 10"), "{}", sentence(&back));
        assert!(ReplayDevice::from_recording(&Recording::default()).is_err());
    }
}
