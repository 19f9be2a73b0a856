//! A recording made ready to be looked at: task signals, paths, and channels grouped by quantity. Computed once, in the
//! background.

use crate::text::format;
use crate::ui::plots::levels::Levels;
use estimator::segment::task_of;
use estimator::signal::task::{TaskSignals, TipSeries, is_two_fingered, task_signals, times, tip_series};
use haptics::Vec2;
use haptics::recording::{Recording, Task};
use render::ColorRole;
use std::sync::Arc;

/// Points that a path in space is thinned to.
const PATH_POINTS: usize = 4_000;

/// One curve.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Channel name, or the task signal's.
    pub name: String,
    /// For people, short.
    pub label: String,
    /// Its colour.
    pub role: ColorRole,
    /// A lighter shade, to tell y from x of one finger.
    pub second: bool,
    /// Values and their extremes at every zoom.
    pub levels: Arc<Levels>,
}

/// Curves of one quantity, drawn in one plot.
#[derive(Clone, Debug)]
pub struct Group {
    /// Name of the quantity.
    pub title: String,
    /// The shown unit.
    pub unit: String,
    /// Shown value = SI value × factor.
    pub factor: f64,
    /// The curves.
    pub traces: Vec<Trace>,
    /// Shown unless the user hides it.
    pub shown: bool,
}

impl Group {
    /// Key of the group: unique within a recording, and the same in every recording.
    pub fn key(&self) -> String {
        format!("{}/{}", self.title, self.unit)
    }
}

/// A recording and everything that is drawn of it.
#[derive(Debug)]
pub struct Prepared {
    /// The recording itself.
    pub recording: Recording,
    /// Sample times, s, or sample numbers of a clockless log.
    pub times: Vec<f64>,
    /// The task that it is read as, when that is known.
    pub task: Option<Task>,
    /// Fingers, where the recording has two.
    pub tips: Option<[TipSeries; 2]>,
    /// The single tool, where it has one.
    pub tool: Option<TipSeries>,
    /// Source of the velocities that states are told from; `None` without such signals.
    pub velocity_from: Option<String>,
    /// Plots.
    pub groups: Vec<Group>,
    /// Samples that paths in space are drawn through.
    pub path_samples: Vec<usize>,
    /// Median sampling rate, Hz; `None` without a clock. Found once: a picture has no time to sort a million steps.
    pub rate_hz: Option<f64>,
    /// Of every channel, in its unit squared.
    mean_squares: Vec<f64>,
}

impl Prepared {
    /// Derives everything; takes a moment for long logs.
    pub fn new(recording: Recording) -> Self {
        let times = times(&recording);
        let signals = is_two_fingered(&recording).then(|| task_signals(&recording).ok()).flatten();
        let velocity_from = signals.as_ref().map(|s| s.velocity_from.clone());
        // The signals' fingers where there are signals: those are the same, and long.
        let (tips, of_task) = match signals {
            Some(TaskSignals { tips, grip_force_n, net_force_n, .. }) => {
                (Some(tips), Some((grip_force_n, net_force_n)))
            }
            None => (fingers(&recording), None),
        };
        let tool = if tips.is_none() { tip_series(&recording, "").ok() } else { None };
        let task = task_of(&recording, None).ok();
        let groups = groups(&recording, of_task);
        let step = times.len().div_ceil(PATH_POINTS).max(1);
        let path_samples = (0..times.len()).step_by(step).collect();
        let mean_square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>() / v.len().max(1) as f64;
        let mean_squares = recording.channels.iter().map(|c| mean_square(&c.values)).collect();
        let rate_hz = recording.rate_hz();
        Self { recording, times, task, tips, tool, velocity_from, groups, path_samples, rate_hz, mean_squares }
    }

    /// Mean square of a channel, in its unit squared; 0 without it. Found once: a picture has no time for a million samples.
    pub fn mean_square(&self, channel: &str) -> f64 {
        let place = self.recording.channels.iter().position(|c| c.name == channel);
        place.and_then(|k| self.mean_squares.get(k)).copied().unwrap_or(0.0)
    }

    /// First and last time.
    pub fn span(&self) -> (f64, f64) {
        match (self.times.first(), self.times.last()) {
            (Some(first), Some(last)) if last > first => (*first, *last),
            (Some(first), _) => (*first, *first + 1.0),
            _ => (0.0, 1.0),
        }
    }

    /// The last sample at or before a time.
    pub fn sample_at(&self, time: f64) -> usize {
        self.times.partition_point(|t| *t <= time).saturating_sub(1)
    }

    /// True when the log has no clock and "times" are sample numbers.
    pub fn clockless(&self) -> bool {
        self.recording.time_s.is_none()
    }

    /// The point that moves through space: the middle of the fingers, or the tool.
    pub fn point_at(&self, sample: usize) -> Option<Vec2> {
        match (&self.tips, &self.tool) {
            (Some([left, right]), _) => Some(0.5 * (left.position.get(sample)? + right.position.get(sample)?)),
            (None, Some(tool)) => tool.position.get(sample).copied(),
            _ => None,
        }
    }

    /// The force on the environment at that point.
    pub fn force_at(&self, sample: usize) -> Option<Vec2> {
        let of = |series: &TipSeries| series.force.as_ref()?.get(sample).copied();
        match (&self.tips, &self.tool) {
            (Some([left, right]), _) => Some(of(left)? + of(right)?),
            (None, Some(tool)) => of(tool),
            _ => None,
        }
    }
}

/// Title of the group that a channel belongs to, its rank, and whether it is shown from the start.
fn kind(name: &str, unit: &str) -> (u8, &'static str, bool) {
    match unit {
        "m" => (0, "Position", true),
        "rad" => (1, "Angle", true),
        "m/s" | "m_s" => (3, "Velocity", false),
        "rad/s" | "rad_s" => (4, "Angular velocity", false),
        "N" => (5, "Force", true),
        "Nm" => (6, "Torque", true),
        _ if name.is_empty() => (9, "Other", false),
        _ => (8, "Other", false),
    }
}

fn fingers(recording: &Recording) -> Option<[TipSeries; 2]> {
    if !is_two_fingered(recording) {
        return None;
    }
    Some([tip_series(recording, "1").ok()?, tip_series(recording, "2").ok()?])
}

/// Grip force and net force of every sample, N.
type OfTask = (Vec<f64>, Vec<Vec2>);

fn groups(recording: &Recording, of_task: Option<OfTask>) -> Vec<Group> {
    let mut ranked: Vec<(u8, Group)> = Vec::new();
    for (index, channel) in recording.channels.iter().enumerate() {
        let (rank, title, shown) = kind(&channel.name, &channel.unit);
        let (unit, factor) = format::channel_unit(&channel.unit);
        let trace = trace(&channel.name, &channel.values, factor, index);
        match ranked.iter_mut().find(|(r, g)| *r == rank && g.unit == unit) {
            Some((_, group)) => group.traces.push(trace),
            None => ranked.push((
                rank,
                Group { title: title.to_owned(), unit: unit.to_owned(), factor, traces: vec![trace], shown },
            )),
        }
    }
    if let Some(of_task) = of_task {
        ranked.push((7, task_group(of_task)));
    }
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, group)| group).collect()
}

/// Signals of the task (thesis, 5.2.2).
fn task_group((grip_n, net_n): OfTask) -> Group {
    let net = |pick: fn(&Vec2) -> f64| net_n.iter().map(pick).collect::<Vec<f64>>();
    let made = |name: &str, label: &str, role, second, values: Vec<f64>| Trace {
        name: name.to_owned(),
        label: label.to_owned(),
        role,
        second,
        levels: Arc::new(Levels::new(values)),
    };
    Group {
        title: "Task signals".to_owned(),
        unit: "N".to_owned(),
        factor: 1.0,
        shown: true,
        traces: vec![
            made("grip_N", "grip force", ColorRole::Measured, false, grip_n),
            made("net_y_N", "net force, up", ColorRole::Block(0), false, net(|f| f.y)),
            made("net_x_N", "net force, right", ColorRole::Block(5), false, net(|f| f.x)),
        ],
    }
}

/// A channel's label and colour from its name: `fx1_N` is the left finger's horizontal force. Channels without a meaning are told apart
/// by their `index` in the recording.
fn trace(name: &str, values: &[f64], factor: f64, index: usize) -> Trace {
    let stem = name.split('_').next().unwrap_or(name);
    let finger = match stem.chars().last() {
        Some('1') => Some(0),
        Some('2') => Some(1),
        _ => None,
    };
    let quantity = stem.trim_end_matches(['1', '2']);
    // `fx_wrist_N` is not `fx_N`: only the program's own names have a meaning.
    let own = matches!(&name[stem.len()..], "_m" | "_m_s" | "_N" | "_rad" | "_rad_s" | "_Nm");
    let quantity = if own { quantity } else { "" };
    let second = matches!(quantity, "y" | "vy" | "fy" | "qt" | "dqt");
    let (label, role) = match (finger, quantity) {
        (Some(finger), "x" | "y" | "vx" | "vy" | "fx" | "fy" | "qb" | "qt" | "dqb" | "dqt") => {
            let axis = match quantity {
                "qb" | "dqb" => "bottom",
                "qt" | "dqt" => "top",
                other if other.ends_with('x') => "x",
                _ => "y",
            };
            (format!("{} {axis}", ["left", "right"][finger]), ColorRole::Finger(finger))
        }
        (None, "x" | "vx" | "fx" | "y" | "vy" | "fy" | "z" | "vz" | "fz") => {
            let (axis, role) = match quantity.chars().last() {
                Some('x') => ("x", ColorRole::Finger(0)),
                Some('y') => ("y", ColorRole::Block(0)),
                _ => ("z", ColorRole::Block(5)),
            };
            (axis.to_owned(), role)
        }
        (None, "q" | "dq" | "ddq") => ("coordinate".to_owned(), ColorRole::Measured),
        (None, "f") => ("force".to_owned(), ColorRole::Measured),
        (None, "tau") => ("torque".to_owned(), ColorRole::Measured),
        _ => (name.to_owned(), ColorRole::Block(index)),
    };
    let second = second && finger.is_some();
    let levels = Arc::new(Levels::of_channel(index, values, factor));
    Trace { name: name.to_owned(), label, role, second, levels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    fn channel(name: &str, unit: &str) -> Channel {
        Channel { name: name.to_owned(), unit: unit.to_owned(), values: vec![0.001, 0.002] }
    }

    #[test]
    fn channels_are_grouped_by_unit_and_named_for_people() {
        let recording = Recording {
            time_s: Some(vec![0.0, 0.5]),
            channels: vec![channel("fx2_N", "N"), channel("x1_m", "m"), channel("y1_m", "m"), channel("motor_A", "A")],
            ..Recording::default()
        };
        let prepared = Prepared::new(recording);
        let titles: Vec<&str> = prepared.groups.iter().map(|g| g.title.as_str()).collect();
        assert_eq!(titles, ["Position", "Force", "Other"]);
        let position = &prepared.groups[0];
        assert_eq!((position.unit.as_str(), position.traces[1].label.as_str()), ("mm", "left y"));
        assert_eq!(position.traces[0].levels.samples(&prepared.recording).value(1), 2.0);
        assert!((prepared.mean_square("x1_m") - 2.5e-6).abs() < 1e-15 && prepared.mean_square("none") == 0.0);
        assert_eq!(prepared.sample_at(0.4), 0);
        assert_eq!(prepared.sample_at(0.5), 1);
    }

    #[test]
    fn an_empty_recording_is_harmless() {
        let prepared = Prepared::new(Recording::default());
        assert_eq!(prepared.span(), (0.0, 1.0));
        assert!(prepared.groups.is_empty() && prepared.point_at(0).is_none());
    }
}
