//! Time delay of the force by more than a row. A linear regressor in the delay is then inaccurate. The force is shifted
//! back by the delay found and the diagnosis repeated: a Gauss-Newton step with the recording itself. The linear
//! regressor does not detect a delay as long as a hand's movement. A shift of the rows' forces against their motion
//! finds it ([`guess_s`]).
//!
//! Sub-sample offset between force and motion, which is no delay.

use super::delay_scan::{Demands, look};
use crate::diagnose::data::direction::CLOCKS_S;
use crate::diagnose::data::limits::SURE;
use crate::diagnose::data::regression_data::{Model, Place, Row, Track};
use crate::diagnose::data::row_means::{Weights, column};
use crate::diagnose::hypotheses::time_delay;
use crate::diagnose::model_error::of_coordinate::TERMS;
use crate::diagnose::model_error::smooth::{over_range, over_time, periodic};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::gram::gram;
use crate::diagnose::selection::normal_equations::solve;
use crate::diagnose::selection::profile_likelihood::parameters;
use foundation::signal::derive::{interpolate, interpolate_cubic};
use haptics::law::{CoulombFriction, Effect, Inertia, Law};
use haptics::recording::{Recording, Span};

/// Demands on a guess of a delay with which the diagnosis is repeated.
/// Choice: not varied one by one. The limits are the longest delay between two movements of a hand, half of the scan,
/// and evidence beyond doubt; a wrong guess is discarded by the repeated fit.
const GUESS: Demands = Demands { longest_s: 0.09, enough: 0.5, leaves: 0.85, likelier: SURE };

/// The delay with which a plain model, anything that goes with the place and anything slow leave least, if it is one
/// that matters. Whole rows are tried, because a force between two rows is the mean of both, with half of the noise.
pub fn guess_s(track: &Track, model: &Model) -> Option<f64> {
    let moved = Moved::of(track, model);
    let late = look(track.period_s, &GUESS, &|rows| moved.left(rows))?;
    late.is_seen.then_some(late.tau_s)
}

/// Functions of the place, and of time, beside which an offset is looked for.
/// Derived: half of those of a discrepancy; the scan of offsets fits them many times.
const WAVES: usize = TERMS / 2;

/// Rows along the motion whose forces are shifted against it.
struct Moved<'a> {
    track: &'a Track,
    /// Indices of the rows.
    rows: Vec<usize>,
    /// Laws that depend on the load, which moves with the force.
    loads: Vec<Effect>,
    /// Regressors that depend on the motion alone, one entry per row of the track.
    motion: Vec<Vec<f64>>,
}

impl<'a> Moved<'a> {
    fn of(track: &'a Track, model: &Model) -> Self {
        let has = |id: &str| model.iter().any(|e| e.law().id() == id);
        let missing = [&Inertia as &'static dyn Law, &CoulombFriction].into_iter().filter(|law| !has(law.id()));
        let laws = model.iter().copied().chain(missing.map(|law| Effect::new(law, &[1.0])));
        let (loads, others): (Vec<Effect>, Vec<Effect>) = laws.partition(|e| e.law().feels_load());
        let mut motion: Vec<Vec<f64>> = others.iter().map(|effect| column(track, effect)).collect();
        let of = |value: &dyn Fn(&Row) -> f64| track.rows.iter().map(value).collect::<Vec<f64>>();
        let angle = of(&|row| row.angle_rad);
        let along = track.rows.iter().map(|row| row.place == Place::Along).collect::<Vec<bool>>();
        let turns = track.radius_m.is_some();
        let of_place = if turns { periodic(&angle, WAVES as u32) } else { over_range(&angle, &along, 0.06, 2 * WAVES) };
        motion.extend(of_place);
        motion.extend(over_time(&of(&|row| row.motion.time_s), f64::INFINITY, 1.0, WAVES));
        motion.push(vec![1.0; track.rows.len()]);
        Self { track, rows: track.along().collect(), loads, motion }
    }

    /// The rows with the forces of this many rows later, and their indices.
    fn later(&self, by: isize) -> (Vec<Row>, Vec<usize>) {
        let of = |i: &usize| &self.track.rows[*i];
        let (mut moved, mut picked) = (Vec::new(), Vec::new());
        let together = |a: &usize, b: &usize| of(a).segment == of(b).segment && of(a).recording == of(b).recording;
        for stretch in self.rows.chunk_by(together) {
            for (k, i) in stretch.iter().enumerate() {
                let Some(later) = k.checked_add_signed(by).and_then(|k| stretch.get(k)).map(of) else { continue };
                let mut row = *of(i);
                if self.track.planar {
                    let outward = haptics::Vec2::new(row.along.y, -row.along.x);
                    row.motion.normal_force_n += (later.force - row.force).dot(&outward);
                    row.target = later.force.dot(&row.along);
                } else {
                    row.target = later.target;
                }
                moved.push(row);
                picked.push(*i);
            }
        }
        (moved, picked)
    }

    /// Residual power per row, and number of rows, with the forces of this many rows later.
    fn left(&self, by: isize) -> Option<(f64, f64)> {
        let (moved, picked) = self.later(by);
        // Square of the direction's estimate: weights of the squares are its fourth power.
        let root: Vec<f64> = moved.iter().map(|row| row.motion.direction.powi(2)).collect();
        let weighted = |column: &mut dyn Iterator<Item = f64>| -> Vec<f64> {
            column.zip(&root).map(|(value, root)| value * root).collect()
        };
        let mut columns: Vec<Vec<f64>> =
            self.motion.iter().map(|of| weighted(&mut picked.iter().map(|i| of[*i]))).collect();
        for law in &self.loads {
            let mut weights = Weights::default();
            columns.push(weighted(&mut moved.iter().map(|row| weights.mean(self.track, row, |m| law.force(m)))));
        }
        let target = columns.len();
        columns.push(weighted(&mut moved.iter().map(|row| row.target)));
        let all: Vec<usize> = (0..moved.len()).collect();
        let fit = solve(&gram(&columns, &all), &(0..target).collect::<Vec<_>>(), target)?;
        let weight: f64 = root.iter().map(|root| root * root).sum();
        (moved.len() > target && weight > 0.0).then(|| (fit.rss / weight, moved.len() as f64))
    }
}

/// The recording with its forces shifted earlier, without its end, which has no such forces.
pub fn put_back(recording: &Recording, late_s: f64) -> Recording {
    let Some(time_s) = recording.time_s.as_ref().filter(|t| t.len() > 2 && late_s != 0.0) else {
        return recording.clone();
    };
    let inside = |t: &f64| *t + late_s >= time_s[0] && *t + late_s <= time_s[time_s.len() - 1];
    let (Some(first), Some(last)) = (time_s.iter().position(inside), time_s.iter().rposition(inside)) else {
        return recording.clone();
    };
    let later: Vec<f64> = time_s.iter().map(|t| t + late_s).collect();
    let mut moved = recording.clone();
    for channel in moved.channels.iter_mut().filter(|c| is_force(&c.name)) {
        channel.values = interpolate(time_s, &channel.values, &later);
    }
    moved.slice(Span { first, end: last + 1 })
}

/// The recording with its motion as it was when the force was read that is recorded beside it: the force comes late by
/// `apart_s`, a part of a sample. (A force between two samples has less noise than the others; a place hardly has any.)
pub fn motion_apart(recording: &Recording, apart_s: f64) -> Recording {
    let mut moved = recording.clone();
    let Some(time_s) = recording.time_s.as_ref().filter(|t| t.len() > 2 && apart_s != 0.0) else { return moved };
    let then: Vec<f64> = time_s.iter().map(|t| t - apart_s).collect();
    for channel in moved.channels.iter_mut().filter(|c| is_motion(&c.name)) {
        channel.values = interpolate_cubic(time_s, &channel.values, &then);
    }
    moved
}

fn is_motion(name: &str) -> bool {
    name.split('_').next().is_some_and(|quantity| ["q", "dq", "x", "y", "z", "vx", "vy", "vz"].contains(&quantity))
}

fn is_force(name: &str) -> bool {
    name.split('_').next().is_some_and(|quantity| {
        let of = quantity.trim_end_matches(['1', '2']);
        ["f", "fx", "fy", "fz", "tau"].contains(&of)
    })
}

/// Delay of a command that is held until the next sample, in samples: half a sample with some margin.
/// Derived: a command that is held acts half a sample late on average; 0.2 samples are margin.
const HELD_COMMAND: f64 = 0.7;
/// Difference of the clocks and filters of two instruments, s: a smaller delay of the force is none.
/// Choice: halved or doubled, none of 4 answers changes.
pub(crate) const CLOCKS_DIFFER_S: f64 = 3e-4;

/// Offset between force and motion if sampling alone can explain it, s. A commanded force is recorded when it is given
/// and acts in the sample after. For a late force, only the difference of the clocks is allowed.
pub fn skew(study: &ChannelFit, k: usize, track: &Track) -> Option<f64> {
    if study.candidates[study.chosen[k].candidate].id != time_delay::ID {
        return None;
    }
    let delay = parameters(study, k);
    let found = delay.first()?;
    // A hand's force is measured; a motor's is usually the command.
    let held_s = if track.planar { 0.0 } else { HELD_COMMAND * track.raw_period_s };
    let ahead_s = track.raw_period_s.min(CLOCKS_S).max(held_s);
    let most_s = if found.value < 0.0 { ahead_s } else { CLOCKS_DIFFER_S };
    (found.value.abs() - 2.0 * found.std_error <= most_s).then_some(found.value)
}

/// The same for any chosen causes.
pub fn skewed_s(study: &ChannelFit, track: &Track) -> Option<f64> {
    (0..study.chosen.len()).find_map(|k| skew(study, k, track))
}

/// The offset in words.
pub fn apart(skew_s: f64) -> String {
    let ms = 1e3 * skew_s;
    format!(
        "force and motion are {ms:.2} ms apart, no more than sampling and clocks make of it: it is taken out and not called a delay"
    )
}

/// Delay estimated beside the causes found, and its standard error, s.
pub fn rest_s(study: &ChannelFit, picks: &[usize]) -> Option<[f64; 2]> {
    let is_delay = |c: &usize| study.candidates[*c].id == time_delay::ID;
    let delay = (0..study.candidates.len()).find(is_delay)?;
    let others: Vec<usize> = picks.iter().copied().filter(|c| !is_delay(c)).collect();
    let solved = study.system.solve(&[others.as_slice(), &[delay]].concat())?;
    let last = solved.values.len() - 1;
    Some([solved.values[last], solved.std_error(last, study.system.rows)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    #[test]
    fn forces_are_put_back_and_motion_stays() {
        let time_s: Vec<f64> = (0..1000).map(|k| 0.002 * f64::from(k)).collect();
        let of = |name: &str, late_s: f64| Channel {
            name: name.to_owned(),
            unit: String::new(),
            values: time_s.iter().map(|t| (3.0 * (t - late_s)).sin()).collect(),
        };
        let channels = vec![of("x_m", 0.0), of("fx_N", 0.031), of("tau_Nm", 0.031)];
        let recording = Recording { time_s: Some(time_s.clone()), channels, ..Recording::default() };
        let back = put_back(&recording, 0.031);
        assert_eq!(back.len(), 1000 - 16);
        for channel in &back.channels {
            let off = |(t, v): (&f64, &f64)| (v - (3.0 * t).sin()).abs();
            let worst = back.time_s.as_ref().expect("times").iter().zip(&channel.values).map(off).fold(0.0, f64::max);
            assert!(worst < 1e-5, "{}: {worst}", channel.name);
        }
    }
}
