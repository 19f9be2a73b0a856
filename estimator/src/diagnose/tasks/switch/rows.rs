//! Rows of a switch's recording: a finger that pushes the knob on, one that presses it against its stop, and fingers
//! that touch nothing.

use super::sensor_zero::zeros;
use crate::diagnose::data::interpolation::mean_step_s;
use crate::diagnose::data::limits::{CERTAIN, FAST_ROW_S, GAP_IN_PERIODS, SETTLING_S};
use crate::diagnose::recording::grip_axis_signs::PRESSING;
use crate::diagnose::selection::layout::segments;
use estimation::identify::limits::{SETTLED, TOUCH_SHARE};
use estimation::identify::switch::longest_push_m;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::signal::task::{DERIVATIVE_WINDOW_S, TipSeries, is_two_fingered, tip_series};
use foundation::tasks::SystemState;
use haptics::Vec2;
use haptics::recording::Recording;
use std::ops::Range;

/// Speed below which the knob may rest, in ranges of the touching fingers per second.
/// Choice: halved, 1 of 21 answers change; doubled, 0 of 21 answers change.
pub(crate) const KNOB_REST_HZ: f64 = 0.077;
/// Velocity below which the finger draws back, in such ranges per second. Above it, the knob is on the forward branch.
/// Choice: halved, 4 of 21 answers change (1 to right); doubled, 4 of 21 answers change.
const BACK_HZ: f64 = -0.019;
/// Spacing of free rows, in blocks: neighbours share their noise.
/// Choice: halved, 2 of 21 answers change; doubled, 5 of 21 answers change.
pub(crate) const FREE_EVERY: usize = 10;

/// Kind of a row. Sides and fingers: 0 is the left finger, which pushes to the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The finger of this number pushes the knob on.
    Push(usize),
    /// The finger of this number presses the knob against the stop.
    Stop(usize),
    /// The finger of this number without touch, along this axis.
    Free(usize, usize),
}

/// One row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub recording: usize,
    pub time_s: f64,
    pub place: Place,
    /// Position of the tip, m in the world, its velocity, m/s, and its acceleration along x, m/s².
    pub tip: Vec2,
    pub velocity: Vec2,
    pub acceleration_m_s2: f64,
    /// Force of the finger, N.
    pub force: Vec2,
    /// Force of the finger without its zero, N.
    pub above_zero: Vec2,
}

impl Row {
    /// Corresponding state of the segmentation.
    pub fn state(&self) -> SystemState {
        match self.place {
            Place::Push(_) => SystemState::Turning,
            Place::Stop(_) => SystemState::Holding,
            Place::Free(..) => SystemState::FreeMotion,
        }
    }
}

/// All rows of some recordings of one switch.
pub struct Seen {
    pub rows: Vec<Row>,
    pub stretch: Vec<usize>,
    pub period_s: f64,
    /// Noise of one block's force, N.
    pub noise_n: f64,
    /// Range of the fingers' middle while one of them touches, m.
    pub range_m: f64,
    /// Throws to the right and to the left.
    pub throws: [usize; 2],
    pub recordings: usize,
}

/// Direction in which a finger pushes: +1 to the right.
pub fn direction(side: usize) -> f64 {
    if side == 0 { 1.0 } else { -1.0 }
}

impl Row {
    /// Side of a row on the knob.
    pub fn side(&self) -> Option<usize> {
        match self.place {
            Place::Push(side) | Place::Stop(side) => Some(side),
            Place::Free(..) => None,
        }
    }

    /// Share of a fault of one finger's force along one axis in a row. On the knob the row is the force along the
    /// travel.
    pub fn share(&self, finger: usize, axis: usize) -> f64 {
        match self.place {
            Place::Push(side) if side == finger && axis == 0 => direction(side),
            Place::Free(f, a) if f == finger && a == axis => 1.0,
            _ => 0.0,
        }
    }

    /// Speed along the travel, m/s.
    pub fn speed_m_s(&self) -> f64 {
        self.side().map_or(0.0, |side| direction(side) * self.velocity.x)
    }
}

/// Reads recordings of one switch.
pub fn seen(recordings: &[Recording], bad: &[Vec<bool>]) -> Result<Seen, EstimateError> {
    let mut all = Seen {
        rows: Vec::new(),
        stretch: Vec::new(),
        period_s: 0.0,
        noise_n: 0.0,
        range_m: 0.0,
        throws: [0; 2],
        recordings: recordings.len(),
    };
    for (number, recording) in recordings.iter().enumerate() {
        one(recording, number, bad.get(number).map_or(&[], Vec::as_slice), &mut all)?;
    }
    if all.throws == [0; 2] {
        return Err(EstimateError::Other(format!(
            "{} shows no push that throws the switch over; push its knob past its snap, and check the signs of the forces",
            recordings.first().map(|r| r.name.clone()).unwrap_or_default()
        )));
    }
    let time: Vec<f64> = all.rows.iter().map(|r| r.time_s).collect();
    let rows = &all.rows;
    let free = |p: Place| matches!(p, Place::Free(..));
    let period = |i: usize| if free(rows[i].place) { FREE_EVERY as f64 } else { 1.0 } * all.period_s;
    let apart = |i: usize| time[i] - time[i - 1] > GAP_IN_PERIODS * period(i) || time[i] <= time[i - 1];
    let other = |i: usize| rows[i].place != rows[i - 1].place || rows[i].recording != rows[i - 1].recording || apart(i);
    all.stretch = segments(&time, f64::INFINITY, other);
    Ok(all)
}

/// One finger in blocks.
struct Finger {
    tip: Vec<Vec2>,
    velocity: Vec<Vec2>,
    force: Vec<Vec2>,
    /// Zero of the force at each block, N.
    zero: Vec<Vec2>,
    touches: Vec<bool>,
    /// Noise of a block, N.
    noise_n: f64,
}

fn one(recording: &Recording, number: usize, bad: &[bool], all: &mut Seen) -> Result<(), EstimateError> {
    let time_s = recording.time_s.as_ref().ok_or_else(|| EstimateError::Clockless {
        what: "the diagnosis of a switch".to_owned(),
        recording: recording.name.clone(),
    })?;
    if !is_two_fingered(recording) {
        return Err(EstimateError::Other(format!(
            "{} has a single tool; a switch is diagnosed from two fingers around its knob (x1_m … fy2_N)",
            recording.name
        )));
    }
    let n = time_s.len();
    let step_s = mean_step_s(time_s);
    let block = (FAST_ROW_S / step_s).round().max(1.0) as usize;
    let usable = |k: usize| !(k * block..(k + 1) * block).any(|i| bad.get(i).copied().unwrap_or(false));
    let blocks = n / block;
    let time: Vec<f64> = (0..blocks).map(|k| mean(&time_s[k * block..(k + 1) * block]) - time_s[0]).collect();
    let fingers = [finger(recording, "1", block, 0)?, finger(recording, "2", block, 1)?];
    all.period_s = all.period_s.max(block as f64 * step_s);
    all.noise_n = all.noise_n.max(fingers[0].noise_n).max(fingers[1].noise_n);
    let row = |finger: &Finger, k: usize, place: Place| Row {
        recording: number,
        time_s: time[k],
        place,
        tip: finger.tip[k],
        velocity: finger.velocity[k],
        acceleration_m_s2: rate(finger, k, &time),
        force: finger.force[k],
        above_zero: finger.force[k] - finger.zero[k],
    };
    let touched = (0..blocks).filter(|k| fingers.iter().any(|finger| finger.touches[*k]));
    let middle = |k: usize| 0.5 * (fingers[0].tip[k].x + fingers[1].tip[k].x);
    let (low, high) = touched.map(middle).fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
    let range_m = (high - low).max(0.0);
    all.range_m = all.range_m.max(range_m);
    let mut found: Vec<Row> = Vec::new();
    let settled_m = SETTLED * fingers.iter().map(Finger::longest_push_m).fold(0.0, f64::max);
    for (side, finger) in fingers.iter().enumerate() {
        for touch in touches(finger, side, &time, [settled_m, range_m]) {
            let place = if touch.throws { Place::Push(side) } else { Place::Stop(side) };
            all.throws[side] += usize::from(touch.throws);
            found.extend(touch.blocks.filter(|k| usable(*k)).map(|k| row(finger, k, place)));
        }
    }
    found.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    for (number, finger) in fingers.iter().enumerate() {
        let margin = (SETTLING_S / all.period_s).ceil() as usize;
        let away = |k: usize| {
            let near = k.saturating_sub(margin)..(k + margin + 1).min(blocks);
            !near.clone().any(|i| finger.touches[i]) && near.len() == 2 * margin + 1
        };
        let blocks: Vec<usize> = (0..blocks).step_by(FREE_EVERY).filter(|k| away(*k) && usable(*k)).collect();
        for axis in [0, 1] {
            found.extend(blocks.iter().map(|k| row(finger, *k, Place::Free(number, axis))));
        }
    }
    all.rows.extend(found);
    Ok(())
}

fn finger(recording: &Recording, name: &str, block: usize, side: usize) -> Result<Finger, EstimateError> {
    let TipSeries { position, velocity, force } = tip_series(recording, name)?;
    let (Some(force), Some(velocity)) = (force, velocity) else {
        return Err(EstimateError::MissingColumn {
            task: "the task switch".to_owned(),
            column: format!("fx{name}_N"),
            recording: recording.name.clone(),
        });
    };
    let noise_n = white_noise(&force.iter().map(|f| f.x).collect::<Vec<_>>());
    let means = |values: &[Vec2]| -> Vec<Vec2> {
        values.chunks_exact(block).map(|c| c.iter().sum::<Vec2>() / block as f64).collect()
    };
    let (tip, velocity, force) = (means(&position), means(&velocity), means(&force));
    let noise_n = noise_n / (block as f64).sqrt();
    let along: Vec<f64> = force.iter().map(|f| direction(side) * f.x).collect();
    let zero = zeros(&force, &along, noise_n);
    let above: Vec<f64> = (0..force.len()).map(|k| along[k] - direction(side) * zero[k].x).collect();
    let strongest = above.iter().fold(0.0_f64, |most, f| most.max(*f));
    let least_n = (TOUCH_SHARE * strongest).max(CERTAIN * noise_n);
    let touches = above.iter().map(|f| *f > least_n).collect();
    Ok(Finger { tip, velocity, force, zero, touches, noise_n })
}

impl Finger {
    fn longest_push_m(&self) -> f64 {
        longest_push_m(&self.tip.iter().map(|tip| tip.x).collect::<Vec<_>>(), &self.touches)
    }
}

/// A finger in touch.
struct Touch {
    blocks: Range<usize>,
    /// True if it moves the knob over; otherwise it presses the knob against a stop.
    throws: bool,
}

/// Touches that move the knob on, and the press on the stop after each of them.
fn touches(finger: &Finger, side: usize, time: &[f64], [settled_m, range_m]: [f64; 2]) -> Vec<Touch> {
    let along = |k: usize| direction(side) * finger.tip[k].x;
    let pressed = |k: usize| direction(side) * (finger.force[k].x - finger.zero[k].x);
    let mut found = Vec::new();
    let mut thrown_to: Option<f64> = None;
    let mut first = 0;
    while first < time.len() {
        if !finger.touches[first] {
            first += 1;
            continue;
        }
        let end = (first..time.len()).find(|k| !finger.touches[*k]).unwrap_or(time.len());
        let way_m = along(end - 1) - along(first);
        if way_m > 2.0 * settled_m && end < time.len() {
            let settled = (first..end).find(|k| along(*k) > along(first) + settled_m).unwrap_or(end);
            let leaving = (settled..end).find(|k| time[end] - time[*k] <= DERIVATIVE_WINDOW_S).unwrap_or(end);
            let moves = |k: &usize| direction(side) * finger.velocity[*k].x > KNOB_REST_HZ * range_m;
            let last = (settled..leaving).rev().find(moves).map_or(settled, |k| k + 1);
            found.push(Touch { blocks: settled..last, throws: true });
            thrown_to = Some(along(end - 1));
        } else if thrown_to.is_some_and(|to| along(first) > to + settled_m) {
            let most = (first..end).map(pressed).fold(0.0, f64::max);
            let hard = |k: &usize| pressed(*k) > PRESSING * most;
            let stays = |k: &usize| direction(side) * finger.velocity[*k].x > BACK_HZ * range_m;
            let start = (first..end).find(hard).unwrap_or(end);
            let last = (start..end).find(|k| !hard(k) || !stays(k)).unwrap_or(end);
            found.push(Touch { blocks: start..last, throws: false });
        }
        first = end;
    }
    found
}

/// Rate of the velocity along x, from one block to the one after the next, m/s².
fn rate(finger: &Finger, k: usize, time: &[f64]) -> f64 {
    let (a, b) = (k.saturating_sub(1), (k + 1).min(time.len() - 1));
    (finger.velocity[b].x - finger.velocity[a].x) / (time[b] - time[a]).max(1e-9)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
