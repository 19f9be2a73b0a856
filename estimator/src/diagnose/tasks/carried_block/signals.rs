//! Signals of a recording of carried blocks for the diagnosis: states from the pipeline, all channels through one
//! filter.

#[cfg(test)]
pub(crate) mod tests;

use crate::diagnose::data::interpolation::mean_step_s;
use crate::diagnose::data::limits::{HAND_REST_HZ, LEAST_PIECES, SIGNIFICANT};
use estimation::identify::block::placement_time::{stands_from, usual_lift};
use estimation::identify::block::signals::{Blocks, MAIN, object};
use estimation::identify::limits::{FREE_ENDS_S, LEAST_FREE_S};
use estimation::segment::Method;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::signal::task::{half_width, smooth};
use foundation::tasks::SystemState;
use haptics::recording::Recording;

/// Share of the usual lift below which part of the weight is supported.
/// Choice: no case of the ablation reads it.
const WHOLE_LIFT_SHARE: f64 = 0.75;
/// Duration for which a block swings behind its pads after the lift, s.
/// Choice: no case of the ablation reads it.
const BLOCK_SWINGS_S: f64 = 0.12;
/// Rows at either end of a carry. The ground may support the block before the first number. Those from the first to
/// the second number define the carried lift, and a lift off it by `END_SHARE` is partly supported.
/// Choice: not varied. Four rows are the time of a landing, and six more give a mean.
const END_ROWS: (usize, usize) = (4, 10);
/// Relative change of the lift that counts, at the ends of a carry and after a block was put down.
/// Choice: no case of the ablation reads it.
const END_SHARE: f64 = 0.025;

/// One recording.
pub struct Seen<'a> {
    pub blocks: Blocks<'a>,
    /// Blocks that were carried.
    pub count: usize,
    /// Recorded force of a finger (first) along an axis (second: x, y), N.
    pub force: [[Vec<f64>; 2]; 2],
    /// Velocity of the grip along x and y, m/s, and its rate, m/s².
    pub velocity: [Vec<f64>; 2],
    pub acceleration: [Vec<f64>; 2],
    /// Middle of the tips, x and y, m.
    pub place: [Vec<f64>; 2],
    /// Time between independent rows, and between samples, s.
    pub period_s: f64,
    pub sample_s: f64,
    /// Standard deviation of the lift of one row by the sensors' noise, N.
    lift_noise_n: f64,
}

impl<'a> Seen<'a> {
    /// Reads a recording; an error in words when no block was carried in it.
    pub fn of(recording: &'a Recording) -> Result<Self, EstimateError> {
        let blocks = Blocks::of(Method::Threshold, recording, None)?;
        let count = blocks.count();
        if count == 0 {
            return Err(EstimateError::Other(format!(
                "no block was carried in {}: there is nothing to diagnose; check the task and the signs of the forces",
                recording.name
            )));
        }
        let time = &blocks.signals.time_s;
        let force = [0, 1].map(|finger: usize| {
            let raw = blocks.signals.tips[finger].force.clone().unwrap_or_default();
            [0, 1].map(|axis| smooth(time, &raw.iter().map(|f| f[axis]).collect::<Vec<f64>>()).value)
        });
        let moving =
            [0, 1].map(|axis| smooth(time, &blocks.signals.velocity.iter().map(|v| v[axis]).collect::<Vec<f64>>()));
        let place = [0, 1]
            .map(|axis| smooth(time, &blocks.signals.position.iter().map(|p| p[axis]).collect::<Vec<f64>>()).value);
        let [x, y] = moving;
        let step_s = mean_step_s(time);
        let period_s = 2.0 * half_width(time) as f64 * step_s;
        let mut seen = Self {
            velocity: [x.value, y.value],
            acceleration: [x.slope, y.slope],
            count,
            force,
            place,
            period_s,
            sample_s: step_s,
            lift_noise_n: 0.0,
            blocks,
        };
        seen.lift_noise_n = seen.lift_noise();
        Ok(seen)
    }

    /// Lift noise from samples without touch, or from fast changes of the lift if there are none.
    fn lift_noise(&self) -> f64 {
        let free = self.free();
        if free.len() < LEAST_PIECES {
            return white_noise(&self.blocks.lift);
        }
        let squares: f64 = free.iter().map(|i| self.blocks.lift[*i].powi(2)).sum();
        (squares / free.len() as f64).sqrt()
    }

    /// Second derivative of the net force along x and y, N/s².
    pub fn force_curve(&self) -> [Vec<f64>; 2] {
        let time = &self.blocks.signals.time_s;
        [0, 1].map(|axis: usize| {
            let net: Vec<f64> = self.force[0][axis].iter().zip(&self.force[1][axis]).map(|(a, b)| a + b).collect();
            smooth(time, &smooth(time, &net).slope).slope
        })
    }

    pub fn time_s(&self, i: usize) -> f64 {
        self.blocks.signals.time_s[i]
    }

    /// Rows in which a block is carried, from the end of its swinging until something else supports it as well.
    pub fn carried(&self, number: usize) -> Vec<usize> {
        self.carried_and_standing(number).0
    }

    /// The same, with the rows at its end in which the block already stands although the lift is still upwards.
    fn carried_and_standing(&self, number: usize) -> (Vec<usize>, Vec<usize>) {
        let samples = self.blocks.shown(MAIN, number);
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return (Vec::new(), Vec::new()) };
        let (start, end) = (self.time_s(*first) + BLOCK_SWINGS_S, self.time_s(*last));
        let mut rows = self.every(samples.into_iter().filter(|i| (start..=end).contains(&self.time_s(*i))));
        // A block that the ground already supports at either end is no longer carried.
        let light = self.light(&rows, [0.0; 2]);
        let mut standing = rows.split_off(rows.iter().rposition(|i| !light(i)).map_or(0, |k| k + 1));
        rows.drain(..rows.iter().position(|i| !light(i)).unwrap_or(0));
        self.without_ends(&mut rows);
        let mut still = Vec::new();
        if let Some((carried_until, stands_from)) = self.put_down(&rows) {
            still = rows.split_off(stands_from);
            rows.truncate(carried_until);
        }
        still.append(&mut standing);
        (rows, still)
    }

    /// Predicate: the lift of a sample is less than the whole carried weight of `rows`. `cross`: share of each finger's
    /// horizontal force in its vertical channel.
    fn light(&self, rows: &[usize], cross: [f64; 2]) -> impl Fn(&usize) -> bool + use<'_, 'a> {
        let lift = self.lift_without(cross);
        let usual = usual_lift(&self.blocks.signals.time_s, rows, &lift);
        move |i| {
            let whole = usual(self.time_s(*i));
            lift(*i) < (WHOLE_LIFT_SHARE * whole).min(whole - SIGNIFICANT * self.lift_noise_n)
        }
    }

    /// Lift of a sample without the cross-talk of each finger's horizontal force.
    fn lift_without(&self, cross: [f64; 2]) -> impl Fn(usize) -> f64 + use<'_, 'a> {
        move |i| self.blocks.lift[i] - cross[0] * self.force[0][0][i] - cross[1] * self.force[1][0][i]
    }

    /// Start time and samples of the phase in which a block stands after its carry, from the first transfer of load to
    /// the ground. The fingers may then move down further, by compression of their pads or a slip, and only the load
    /// tells that from lowering. `rest`: samples in which the block is known to stand; `cross`: cross-talk as found.
    pub fn put(&self, number: usize, rest: &[usize], cross: [f64; 2]) -> (f64, Vec<usize>) {
        let (carried, mut standing) = self.carried_and_standing(number);
        if cross != [0.0; 2] && !rest.is_empty() {
            // With cross-talk from the grip, the recorded lift falls with the grip force, on the ground or not.
            standing.clear();
        }
        let Some(first) = rest.first().into_iter().chain(standing.first()).min().copied() else {
            return (0.0, Vec::new());
        };
        let known = rest.first().copied().or_else(|| Some(standing.last()? + 1)).unwrap_or(first);
        // The start is in the second half of the carry, without a break after it.
        let least = carried.get(carried.len() / 2).map_or(first, |middle| *middle).min(first);
        let lift = self.lift_without(cross);
        let from = stands_from(&self.blocks, &carried, least..first, &lift);
        // The filter's window still reaches back to samples in the air.
        let settled = if from < known { from + half_width(&self.blocks.signals.time_s) } else { from };
        let rest = rest.iter().copied().filter(|i| *i >= settled);
        (self.time_s(from), (settled..known).chain(rest).collect())
    }

    /// Removes rows at both ends of a carry in which the ground may support part of the weight. A heavy block takes
    /// longer than a row to lift and to put down.
    fn without_ends(&self, rows: &mut Vec<usize>) {
        for _ in 0..2 {
            rows.reverse();
            if rows.len() < 2 * END_ROWS.1 {
                continue;
            }
            let inner: Vec<f64> = rows[END_ROWS.0..END_ROWS.1].iter().map(|i| self.blocks.lift[*i]).collect();
            let usual = inner.iter().sum::<f64>() / inner.len() as f64;
            let partly = |i: usize| (self.blocks.lift[i] - usual).abs() > END_SHARE * usual.abs();
            let taken = (0..END_ROWS.0).rev().find(|k| partly(rows[*k])).map_or(0, |k| k + 1);
            rows.drain(..taken);
        }
    }

    /// Up to which row a block that was lowered is carried, and from which on it rests, with another lift than in the
    /// air.
    fn put_down(&self, rows: &[usize]) -> Option<(usize, usize)> {
        let speed = |i: usize| self.velocity[0][i].hypot(self.velocity[1][i]);
        let rest_m_s = HAND_REST_HZ * self.blocks.signals.object_m();
        let moved = rows.iter().rposition(|i| speed(*i) > rest_m_s)?;
        let from = moved + 1;
        if from + 2 > rows.len() || from < LEAST_PIECES {
            return None;
        }
        let before = &rows[from.saturating_sub(2 * LEAST_PIECES)..from - 2];
        let lowered = before.iter().any(|i| self.velocity[1][*i] < -rest_m_s);
        let mean = |rows: &[usize]| rows.iter().map(|i| self.blocks.lift[*i]).sum::<f64>() / rows.len() as f64;
        let (carried, now) = (mean(before), mean(&rows[from..]));
        let error = self.lift_noise_n * (1.0 / before.len() as f64 + 1.0 / (rows.len() - from) as f64).sqrt();
        let other = (now - carried).abs() > (END_SHARE * carried.abs()).max(SIGNIFICANT * error);
        // A block may hang still just above the ground and then be lowered slowly. It stands once the lift is nearer to
        // the new value.
        let stands = |i: &usize| (self.blocks.lift[*i] - now).abs() < (self.blocks.lift[*i] - carried).abs();
        let first = from + rows[from..].iter().position(stands)?;
        (lowered && other).then_some((from.saturating_sub(2), first))
    }

    /// Rows in which a block is gripped.
    pub fn gripped(&self, number: usize) -> Vec<usize> {
        self.every(self.blocks.gripped(number).into_iter())
    }

    pub fn state(&self, i: usize) -> SystemState {
        let states = &self.blocks.segmentation.states;
        states.get(states.partition_point(|s| s.end <= i)).map_or(SystemState::NoState, |s| s.state)
    }

    /// Rows of free motion.
    pub fn free(&self) -> Vec<usize> {
        let states = self.blocks.segmentation.states.iter();
        let long = states.filter(|i| i.state == SystemState::FreeMotion && i.t1 - i.t0 >= LEAST_FREE_S);
        self.every(long.flat_map(|s| {
            (s.first..s.end).filter(|k| self.time_s(*k) > s.t0 + FREE_ENDS_S && self.time_s(*k) < s.t1 - FREE_ENDS_S)
        }))
    }

    /// Samples a filter window apart, because neighbours share their noise.
    pub fn every(&self, samples: impl Iterator<Item = usize>) -> Vec<usize> {
        let stride = 2 * half_width(&self.blocks.signals.time_s);
        let mut last: Option<usize> = None;
        samples
            .filter(|i| {
                let taken = last.is_none_or(|l| *i >= l + stride);
                if taken {
                    last = Some(*i);
                }
                taken
            })
            .collect()
    }

    /// Value that the sidecar states for a block: `block-1.weight_N`, or `weight_N` of all blocks.
    pub fn known(&self, number: usize, name: &str) -> Option<f64> {
        let known = &self.blocks.recording.meta.known;
        let own = known.get(&format!("{}.{name}", object(number)));
        own.or_else(|| known.get(name)).copied()
    }

    /// Weight that is known of a block, N.
    pub fn known_weight_n(&self, number: usize) -> Option<f64> {
        let gravity = self.blocks.recording.meta.gravity();
        self.known(number, "weight_N").or_else(|| Some(self.known(number, "mass_kg")? * gravity))
    }
}
