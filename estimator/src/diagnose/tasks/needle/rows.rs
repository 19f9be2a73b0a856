//! Rows of a needle's recording: nothing held, held outside, pressing an untouched sheet, unloading it, and in the
//! hole.
//!
//! Time delay of the forces after the motion of a needle, from the shift for which its sheet explains most.

use super::interpolation::Between;
use crate::diagnose::data::interpolation::{mean_step_s, slope_noise};
use crate::diagnose::data::limits::{FILTER_REACH_S, PAUSE_S, SETTLING_S, SURE};
use crate::diagnose::data::regression_data::{Fine, Span};
use crate::diagnose::model_error::twin::{Force, Placed};
use crate::diagnose::recording::delay_scan::{Demands, Late, left_of_fit, look_by_samples};
use crate::diagnose::selection::layout::segments;
use estimation::identify::limits::LEAST_FREE_S;
use estimation::identify::needle::sheet::Sheet;
use estimation::identify::needle::signals::{Along, along};
use estimation::identify::needle::strokes::{Push, pushes};
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::signal::task::{half_width, smooth, times};
use foundation::tasks::SystemState;
use haptics::Vec2;
use haptics::law::object::unloading_n;
use haptics::recording::Recording;
use std::ops::Range;

/// Depth from which a needle is in its hole, height from which it is outside, and distance from another place, as a
/// share of the dent.
/// Choice: halved, 2 of 15 answers change; doubled, 2 of 15 answers change.
const AT_SURFACE: f64 = 0.14;
/// Distance from the surface, as a share of the dent, within which a row belongs to both sides.
/// Choice: halved, 1 of 15 answers change; doubled, 0 of 15 answers change.
const EDGE: f64 = 0.03;

/// Contact phase of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nothing is held.
    Empty,
    /// Held without touch of the sheet.
    Outside,
    /// Indentation deeper than ever before.
    Loading,
    /// Indentation less than before.
    Unloading,
    /// The sheet is pierced.
    Hole,
}

/// One row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Index of the recording, and its start on the common clock.
    pub recording: usize,
    pub start_s: f64,
    pub time_s: f64,
    /// Depth beyond the undisturbed surface, m, without the compression of the pads.
    pub depth_m: f64,
    pub rate_m_s: f64,
    pub acceleration_m_s2: f64,
    /// Position across the needle, m: another place of the sheet.
    pub side_m: f64,
    pub force_n: f64,
    pub phase: Phase,
    /// Number of the hold (grip), and of the place on the sheet.
    pub hold: usize,
    pub push: usize,
    /// Deepest so far at this place, m.
    pub deepest_m: f64,
    pub stretch: usize,
    /// Points of [`Needle::fine`] over which it is averaged, in a hole.
    pub span: Span,
}

impl Row {
    /// Corresponding state of the segmentation.
    pub fn state(&self) -> SystemState {
        match self.phase {
            Phase::Empty | Phase::Outside => SystemState::FreeMotion,
            Phase::Loading => SystemState::Insertion,
            Phase::Unloading => SystemState::Extraction,
            Phase::Hole if self.rate_m_s < 0.0 => SystemState::Extraction,
            Phase::Hole => SystemState::Penetration,
        }
    }
}

/// Puncture of a sheet.
#[derive(Clone, Copy, Debug)]
pub struct Puncture {
    /// Index of the recording, and the time in it, s.
    pub recording: usize,
    pub time_s: f64,
    pub force_n: f64,
    /// Standard error of the force, N: the puncture is between two noisy samples.
    pub error_n: f64,
    pub hold: usize,
}

/// A recording of a needle, or several of the same needle and sheet.
pub struct Needle {
    pub rows: Vec<Row>,
    /// Points between those rows that are in holes; empty if the motion there was not measured.
    pub fine: Vec<Fine>,
    /// Number of recordings, and true if these rows are of more than one.
    pub recordings: usize,
    pub joined: bool,
    pub holds: usize,
    pub period_s: f64,
    pub two_fingered: bool,
    /// Initial stiffness of the sheet, N/m.
    pub stiffness_n_m: f64,
    /// Depth from which a needle is in its hole, height from which it is outside, and distance from another place, m.
    pub at_surface_m: f64,
    /// Noise of the rate, m/s.
    pub rate_noise_m_s: f64,
    /// Part of that noise due to the measured path alone, whatever the motion.
    pub slope_noise_m_s: f64,
    /// Unit vector of insertion in each recording.
    pub directions: Vec<Vec2>,
    /// In order.
    pub punctures: Vec<Puncture>,
    /// Delay of its forces; of several recordings, the best determined one.
    pub late: Option<Late>,
}

impl Needle {
    /// Goes on with a recording that was made later: its holds and its places of the sheet are others, and so is its
    /// own surface.
    pub fn then(&mut self, later: Self) {
        let of = |pick: fn(&Row) -> usize| self.rows.iter().map(pick).max().map_or(0, |last| last + 1);
        let (push, stretch, recording) = (of(|r| r.push), of(|r| r.stretch), self.recordings);
        let end_s = self.rows.last().map_or(0.0, |r| r.time_s) + PAUSE_S;
        self.rows.extend(later.rows.into_iter().map(|row| Row {
            recording,
            start_s: end_s,
            time_s: end_s + row.time_s,
            hold: self.holds + row.hold,
            push: push + row.push,
            stretch: stretch + row.stretch,
            ..row
        }));
        // Every hole has its own presliding: one law for several holes has a misfit at their reversals.
        self.joined = true;
        self.fine.clear();
        self.rows.iter_mut().for_each(|row| row.span = Span { start: 0, len: 0, ..row.span });
        let holds = self.holds;
        self.punctures.extend(later.punctures.into_iter().map(|p| Puncture { recording, hold: holds + p.hold, ..p }));
        let weight = self.recordings as f64;
        self.stiffness_n_m = (weight * self.stiffness_n_m + later.stiffness_n_m) / (weight + 1.0);
        self.recordings += 1;
        self.directions.extend(later.directions);
        self.holds += later.holds;
        self.period_s = self.period_s.max(later.period_s);
        self.rate_noise_m_s = self.rate_noise_m_s.max(later.rate_noise_m_s);
        self.slope_noise_m_s = self.slope_noise_m_s.max(later.slope_noise_m_s);
        self.two_fingered &= later.two_fingered;
        let clear = |late: &Late| (late.is_seen, -late.error_s);
        self.late = match (self.late, later.late) {
            (Some(own), Some(other)) if clear(&own) >= clear(&other) => Some(own),
            (own, other) => other.or(own),
        };
    }
}

impl Needle {
    /// Places of rows in their recordings.
    pub fn placed(&self, rows: &[Row]) -> Vec<Placed> {
        let placed = |row: &Row| Placed {
            recording: row.recording,
            time_s: row.time_s - row.start_s,
            force: Force::Plane(self.directions[row.recording]),
        };
        rows.iter().map(placed).collect()
    }
}

/// Reads a recording.
pub fn needle(recording: &Recording) -> Result<Needle, EstimateError> {
    let along = along(recording)?;
    let pushes = pushes(&along);
    demand_a_push(&pushes, recording)?;
    let (sheet, time) = (Sheet::of(&along, &pushes)?, times(recording));
    let (half, step_s) = (half_width(&time), mean_step_s(&time));
    let own: Vec<f64> = along.depth_m.iter().zip(&along.force_n).map(|(d, f)| d - along.give_m_n.0 * f).collect();
    let (depth, force) = (smooth(&time, &own), smooth(&time, &along.force_n));
    let acceleration = smooth(&time, &depth.slope).slope;
    let surface_m = sheet.loading.surface_m;
    let dent_m = pushes.iter().map(|p| p.dent_m).fold(0.0, f64::max);
    let phases = phases((&along, &pushes), &time, (&depth.value, &depth.slope), (surface_m, dent_m));
    let in_hole: Vec<bool> = phases.iter().map(|of| of.is_some_and(|(phase, ..)| phase == Phase::Hole)).collect();
    let between = Between::new(&time, &depth, surface_m, &in_hole, half);
    let row = |(i, of): (usize, &Of)| {
        let (phase, hold, push, deepest) = (*of)?;
        let row = Row {
            recording: 0,
            start_s: 0.0,
            time_s: time[i] - time[0],
            depth_m: depth.value[i] - surface_m,
            rate_m_s: depth.slope[i],
            acceleration_m_s2: acceleration[i],
            side_m: along.side_m[i],
            force_n: force.value[i],
            phase,
            hold,
            push,
            deepest_m: deepest - surface_m,
            stretch: 0,
            span: if phase == Phase::Hole { between.span(i) } else { Span::default() },
        };
        Some((row, i))
    };
    let (mut rows, of_row): (Vec<Row>, Vec<usize>) =
        phases.iter().enumerate().step_by(2 * half).filter_map(row).unzip();
    let period_s = (2 * half) as f64 * step_s;
    number_segments(&mut rows, period_s);
    let step_n = |i: usize| sheet.loading.stiffness_n_m * (depth.slope[i] * step_s).abs();
    let mut seen = Needle {
        rate_noise_m_s: white_noise(&rows.iter().map(|r| r.rate_m_s).collect::<Vec<_>>()),
        rows,
        period_s,
        fine: between.points,
        joined: false,
        recordings: 1,
        holds: along.holds.len(),
        two_fingered: along.two_fingered,
        stiffness_n_m: sheet.loading.stiffness_n_m,
        at_surface_m: AT_SURFACE * dent_m,
        slope_noise_m_s: slope_noise(&own, half, step_s),
        directions: vec![along.direction],
        punctures: pushes.iter().filter_map(|push| puncture(push, &along, (&time, &step_n))).collect(),
        late: None,
    };
    seen.late = late(&seen, &Forces { force_n: &force.value, of_row: &of_row, sample_s: step_s });
    Ok(seen)
}

/// The puncture of a push. `step_n`: change of the force from a sample to the next.
fn puncture(push: &Push, along: &Along, (time, step_n): (&[f64], &dyn Fn(usize) -> f64)) -> Option<Puncture> {
    let i = push.puncture?;
    let error_n = step_n(i).hypot(along.noise_n);
    Some(Puncture { recording: 0, time_s: time[i] - time[0], force_n: along.force_n[i], error_n, hold: push.hold })
}

/// # Errors
/// A recording without a push from outside: in a sentence.
fn demand_a_push(pushes: &[Push], recording: &Recording) -> Result<(), EstimateError> {
    if pushes.is_empty() {
        return Err(EstimateError::Other(format!(
            "no push into an untouched sheet was seen in {}; push the held needle in from outside",
            recording.name
        )));
    }
    Ok(())
}

/// Numbers the segments: rows of one phase and one hold, without a gap.
fn number_segments(rows: &mut [Row], period_s: f64) {
    let at: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
    let numbers = segments(&at, period_s, |i| rows[i].phase != rows[i - 1].phase || rows[i].hold != rows[i - 1].hold);
    rows.iter_mut().zip(numbers).for_each(|(row, number)| row.stretch = number);
}

type Of = Option<(Phase, usize, usize, f64)>;

/// The phase of every sample, with hold, push and the deepest place so far.
fn phases(
    (along, pushes): (&Along, &[Push]),
    time: &[f64],
    (depth_m, rate_m_s): (&[f64], &[f64]),
    (surface_m, dent_m): (f64, f64),
) -> Vec<Of> {
    let at_surface_m = AT_SURFACE * dent_m;
    let mut found: Vec<Of> = vec![None; time.len()];
    let far = |i: usize, to: usize| (time[i] - time[to.min(time.len() - 1)]).abs() > LEAST_FREE_S;
    let mut empty = |range: Range<usize>| {
        for i in range.clone() {
            if (range.start == 0 || far(i, range.start)) && (range.end == time.len() || far(i, range.end)) {
                found[i] = Some((Phase::Empty, 0, 0, f64::MIN));
            }
        }
    };
    let mut last = 0;
    for hold in &along.holds {
        empty(last..hold.start);
        last = hold.end;
    }
    empty(last..time.len());
    for (h, hold) in along.holds.iter().enumerate() {
        let whole = along.holds.len() == 1 && hold.len() == time.len();
        let of: Vec<(usize, &Push)> = pushes.iter().enumerate().filter(|(_, p)| p.hold == h).collect();
        for i in hold.clone() {
            let inner = whole || (far(i, hold.start) && far(i, hold.end));
            let now = of.iter().rev().find(|(_, p)| p.samples.start <= i);
            if depth_m[i] < surface_m - at_surface_m {
                if inner {
                    found[i] = Some((Phase::Outside, h, now.map_or(0, |n| n.0), f64::MIN));
                }
                continue;
            }
            let Some((k, push)) = now else { continue };
            // The filter's window includes the surface, and the fall of the force at a puncture, from either side.
            let meets = (depth_m[i] - surface_m).abs() < EDGE * dent_m + FILTER_REACH_S * rate_m_s[i].abs();
            let falls = push.puncture.is_some_and(|at| i <= at && time[at] - time[i] < FILTER_REACH_S);
            if meets || falls {
                continue;
            }
            let deepest = depth_m[push.samples.start..=i].iter().copied().fold(f64::MIN, f64::max);
            let phase = match push.puncture {
                Some(at) if i > at => {
                    let settled = time[i] - time[at] > SETTLING_S;
                    (settled && depth_m[i] > surface_m + at_surface_m).then_some(Phase::Hole)
                }
                _ if push.samples.contains(&i) && depth_m[i] > push.untouched_from_m => Some(Phase::Loading),
                // Pushed in again above the dent, or drawn back.
                _ => Some(Phase::Unloading),
            };
            found[i] = phase.map(|p| (p, h, *k, deepest.max(push.dented_to_m)));
        }
    }
    found
}

/// Limits of a delay. Beyond the longest one a hand is already at another movement. Other causes in a sheet are not in
/// the plain model and correlate with some delay by chance.
/// Choice: not varied one by one. A delay that it finds must improve the repeated fit, or it is discarded.
const DEMANDS: Demands = Demands { longest_s: 0.1, enough: 0.8, leaves: 0.5, likelier: SURE };

/// The smoothed forces of a recording, one per sample, to which every row refers.
pub struct Forces<'a> {
    pub force_n: &'a [f64],
    /// Sample of each row.
    pub of_row: &'a [usize],
    pub sample_s: f64,
}

/// Delay with the smallest residual of a model with held weight and a sheet that may harden and keep a dent. A sheet
/// with drag looks like a negative delay, which is therefore not reported. A needle between two pads moves in them by
/// more than a hand moves during a delay, so only single tools are tested.
pub fn late(needle: &Needle, forces: &Forces<'_>) -> Option<Late> {
    if needle.two_fingered {
        return None;
    }
    let compared: Vec<usize> = (0..needle.rows.len()).filter(|i| is_compared(needle, &needle.rows[*i])).collect();
    let columns = columns(needle, &compared);
    let late = look_by_samples(forces.sample_s, &DEMANDS, &|by| left(forces, &compared, &columns, by));
    late.map(|late| Late { is_seen: late.is_seen && late.tau_s > 0.0, ..late })
}

/// True for rows outside or on the sheet whose contact phase does not depend on the delay. The force of a hole on a
/// shaft at a reversal is not known well enough.
fn is_compared(needle: &Needle, row: &Row) -> bool {
    let at_surface = row.depth_m.abs() < SETTLING_S * row.rate_m_s.abs();
    let at_puncture = needle.punctures.iter().any(|p| (row.time_s - p.time_s).abs() < 2.0 * SETTLING_S);
    !matches!(row.phase, Phase::Empty | Phase::Hole) && !at_surface && !at_puncture
}

/// Regressors of the plain model over the compared rows.
fn columns(needle: &Needle, compared: &[usize]) -> Vec<Vec<f64>> {
    let of = |f: &dyn Fn(&Row) -> f64| compared.iter().map(|i| f(&needle.rows[*i])).collect::<Vec<f64>>();
    let when = |phases: &'static [Phase], f: &'static dyn Fn(&Row) -> f64| {
        of(&|r: &Row| if phases.contains(&r.phase) && r.depth_m > 0.0 { f(r) } else { 0.0 })
    };
    let mut columns: Vec<Vec<f64>> = (0..needle.holds).map(|h| of(&|r| f64::from(u8::from(r.hold == h)))).collect();
    columns.push(of(&|r| r.time_s));
    let touched: &'static [Phase] = &[Phase::Loading, Phase::Unloading];
    columns.push(when(touched, &|_| 1.0));
    columns.push(when(touched, &|r| r.depth_m));
    columns.push(when(touched, &|r| unloading_n(r.depth_m, r.deepest_m, 0.0, |x| x.powi(3))));
    // Above its deepest indentation, a sheet has another law.
    columns.push(when(&[Phase::Unloading], &|_| 1.0));
    columns.push(when(&[Phase::Unloading], &|r| r.depth_m));
    columns
}

/// Residual power per row, and number of rows, with the forces of this many samples later.
fn left(forces: &Forces<'_>, compared: &[usize], columns: &[Vec<f64>], by: isize) -> Option<(f64, f64)> {
    let later = |i: usize| forces.of_row[i].checked_add_signed(by).and_then(|at| forces.force_n.get(at));
    let (kept, y): (Vec<usize>, Vec<f64>) =
        compared.iter().enumerate().filter_map(|(k, i)| Some((k, *later(*i)?))).unzip();
    left_of_fit(columns.iter().map(|column| kept.iter().map(|k| column[*k]).collect()).collect(), &y)
}
