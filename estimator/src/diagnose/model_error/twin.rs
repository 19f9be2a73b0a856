//! Replays of recordings without any cause: their own motion, with the forces of the null model.

use super::competition::without_causes;
use super::null_model::NullModel;
use crate::diagnose::contract::Cause;
use crate::diagnose::data::regression_data::{Place, Row, Track};
use crate::diagnose::hypotheses::axis_sign;
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::signal::derive::interpolate;
use foundation::signal::task::is_two_fingered;
use haptics::Vec2;
use haptics::recording::Recording;
use haptics::world::MechanismPath;
use rand::Rng;
use std::ops::Range;

/// Forces that recordings would have without any cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Twin {
    forces: Vec<Replayed>,
}

/// Forces of one channel.
#[derive(Clone, Debug, PartialEq)]
struct Replayed {
    null: NullModel,
    rows: Vec<Placed>,
    /// Segment of each row.
    segment: Vec<usize>,
    /// Causes found in these forces, which a replay lacks.
    removed: Vec<&'static str>,
}

/// Time and direction of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    pub recording: usize,
    /// From the start of the recording, s.
    pub time_s: f64,
    pub force: Force,
}

/// Columns of a recording that hold the force of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    /// Force along a coordinate, at a place in m or rad. On the path of a tool it has the path's direction.
    Along(f64),
    /// Force of the tool, or of both fingers together, along a unit vector of the plane.
    Plane(Vec2),
    /// Force of one finger along a unit vector of the plane.
    Finger(usize, Vec2),
    /// No measured force: a displacement in a stick phase.
    None,
}

/// True if the axes of a recording are those of its replay.
pub fn is_upright(faults: &[Cause]) -> bool {
    faults.iter().all(|fault| fault.id != axis_sign::ID)
}

impl Twin {
    /// `None` if the rows do not determine the null model, or have no measured force.
    pub fn of(track: &Track, study: &ChannelFit) -> Option<Self> {
        if track.freely.is_some() {
            return None;
        }
        let force = |row: &Row| match row.place {
            Place::Stuck { .. } => Force::None,
            _ if track.planar => Force::Plane(row.along),
            _ => Force::Along(row.motion.position),
        };
        let placed = |row: &Row| Placed { recording: row.recording, time_s: row.motion.time_s, force: force(row) };
        let segment = track.rows.iter().map(|row| row.segment).collect();
        Some(Self { forces: vec![Replayed::of(study, track.rows.iter().map(placed).collect(), segment)?] })
    }

    /// Of channels with the places of their rows. `None` if no null model is determined.
    pub fn of_channels<'a>(channels: impl IntoIterator<Item = (&'a ChannelFit, Vec<Placed>)>) -> Option<Self> {
        let of = |(study, rows): (&ChannelFit, _)| Replayed::of(study, rows, study.layout.segment.clone());
        let forces: Vec<Replayed> = channels.into_iter().filter_map(of).collect();
        (!forces.is_empty()).then_some(Self { forces })
    }

    /// True if a replay lacks this cause of the recording. Faults of samples and causes of paths, widths and heights
    /// remain.
    pub fn lacks(&self, id: &str) -> bool {
        self.forces.iter().any(|replayed| replayed.removed.contains(&id))
    }

    /// The same recordings with other forces. `paths`: of each tool whose coordinate was not recorded.
    pub fn replay(
        &self,
        recordings: &[Recording],
        paths: &[Option<MechanismPath>],
        rng: &mut impl Rng,
    ) -> Vec<Recording> {
        let mut replayed = recordings.to_vec();
        self.forces.iter().for_each(|force| force.replay(&mut replayed, paths, rng));
        replayed
    }
}

impl Replayed {
    fn of(study: &ChannelFit, rows: Vec<Placed>, segment: Vec<usize>) -> Option<Self> {
        let null = without_causes(study, &study.errors)?;
        let removed = study.picks().into_iter().map(|p| study.candidates[p].id).collect();
        Some(Self { null, rows, segment, removed })
    }

    fn replay(&self, recordings: &mut [Recording], paths: &[Option<MechanismPath>], rng: &mut impl Rng) {
        let change = self.null.change(rng);
        let mut first = 0;
        for rows in self.segment.chunk_by(|a, b| a == b) {
            let range = first..first + rows.len();
            first = range.end;
            let own = self.rows[range.start].recording;
            self.apply(&mut recordings[own], paths[own].as_ref(), range.clone(), &change[range]);
        }
    }

    /// Adds the change of one segment to the force channels of its recording.
    fn apply(&self, recording: &mut Recording, path: Option<&MechanismPath>, rows: Range<usize>, change: &[f64]) {
        let Some(time_s) = recording.time_s.clone() else { return };
        let rows = &self.rows[rows];
        let change = sharpened(change);
        let times: Vec<f64> = rows.iter().map(|row| row.time_s + time_s[0]).collect();
        let (begin, end) = (times[0], times[times.len() - 1]);
        let inside = |t: &f64| (begin..=end).contains(t);
        let (Some(from), Some(to)) = (time_s.iter().position(inside), time_s.iter().rposition(inside)) else { return };
        for (name, axis, share) in channels(recording, path.is_some(), rows[0].force) {
            let Some(channel) = recording.channels.iter_mut().find(|c| c.name == name) else { continue };
            let along: Vec<f64> =
                rows.iter().zip(&change).map(|(row, change)| share * change * direction(row, path)[axis]).collect();
            let added = interpolate(&times, &along, &time_s[from..=to]);
            channel.values[from..=to].iter_mut().zip(added).for_each(|(value, more)| *value += more);
        }
    }
}

/// Values at rows whose linear interpolation has the means `wanted` over the time of one row: without this, noise of a
/// replay would be smaller than it was drawn. The mean of straight lines to both neighbours is an eighth of either and
/// three quarters of the row; the system is solved by elimination (Thomas 1949).
fn sharpened(wanted: &[f64]) -> Vec<f64> {
    let (mut values, last) = (wanted.to_vec(), wanted.len().saturating_sub(1));
    let mut next = vec![0.0; wanted.len()];
    for i in 0..wanted.len() {
        let own = 0.75 + [0, last].iter().filter(|end| i == **end).map(|_| 0.125).sum::<f64>();
        let (before, shared) = if i > 0 { (values[i - 1], next[i - 1]) } else { (0.0, 0.0) };
        let pivot = own - 0.125 * shared;
        next[i] = 0.125 / pivot;
        values[i] = (wanted[i] - 0.125 * before) / pivot;
    }
    for i in (0..last).rev() {
        values[i] -= next[i] * values[i + 1];
    }
    values
}

/// Vector whose product with a force along the coordinate is the force on the tool, 1 or 1/m.
fn direction(row: &Placed, path: Option<&MechanismPath>) -> [f64; 3] {
    match (row.force, path) {
        (Force::Along(position), Some(path)) => path.force_n(position, 1.0),
        (Force::Along(_), None) => [1.0, 0.0, 0.0],
        (Force::Plane(along) | Force::Finger(_, along), _) => [along.x, along.y, 0.0],
        (Force::None, _) => [0.0; 3],
    }
}

/// Names of the channels that hold the force, the axis of each, and the share that it takes.
fn channels(recording: &Recording, is_tool: bool, force: Force) -> Vec<(&'static str, usize, f64)> {
    match force {
        Force::None => Vec::new(),
        Force::Along(_) if !is_tool => vec![("f_N", 0, 1.0), ("tau_Nm", 0, 1.0)],
        Force::Finger(0, _) => vec![("fx1_N", 0, 1.0), ("fy1_N", 1, 1.0)],
        Force::Finger(..) => vec![("fx2_N", 0, 1.0), ("fy2_N", 1, 1.0)],
        Force::Plane(_) if is_two_fingered(recording) => {
            vec![("fx1_N", 0, 0.5), ("fy1_N", 1, 0.5), ("fx2_N", 0, 0.5), ("fy2_N", 1, 0.5)]
        }
        Force::Along(_) | Force::Plane(_) => vec![("fx_N", 0, 1.0), ("fy_N", 1, 1.0), ("fz_N", 2, 1.0)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::model_error::null_model::Autoregression;
    use haptics::recording::Channel;
    use rand::SeedableRng;
    use rand::rngs::StdRng;

    const ROWS: usize = 50;

    /// Rows 0.1 s apart whose force would be 3 N instead of 1 N.
    fn twin(force: Force) -> Twin {
        let null = NullModel {
            predicted: vec![3.0; ROWS],
            errors: Vec::new(),
            noise: Autoregression::default(),
            weight: vec![1.0; ROWS],
            target: vec![1.0; ROWS],
        };
        let place = |k: usize| Placed { recording: 0, time_s: 0.1 * k as f64, force };
        let rows = (0..ROWS).map(place).collect();
        Twin { forces: vec![Replayed { null, rows, segment: vec![0; ROWS], removed: Vec::new() }] }
    }

    fn recording(names: &[&str]) -> Recording {
        let channel =
            |name: &&str| Channel { name: (*name).to_owned(), unit: String::new(), values: vec![1.0; 10 * ROWS] };
        Recording {
            // The clock does not begin at zero, and the last rows are before its end.
            time_s: Some((0..10 * ROWS).map(|k| 7.0 + 0.0105 * k as f64).collect()),
            channels: names.iter().map(channel).collect(),
            ..Recording::default()
        }
    }

    fn values(twin: &Twin, names: &[&str], path: Option<MechanismPath>) -> Vec<[f64; 2]> {
        let replay = twin.replay(&[recording(names)], &[path], &mut StdRng::seed_from_u64(1));
        replay[0].channels.iter().map(|c| [c.values[40], c.values[c.values.len() - 1]]).collect()
    }

    #[test]
    fn the_change_goes_to_the_channels_of_the_force_while_rows_hold_it() {
        let plane = Force::Plane(Vec2::new(0.6, 0.8));
        let quarter = Force::Along(0.5 * std::f64::consts::PI);
        let near = |got: &[[f64; 2]], wanted: &[f64]| {
            assert_eq!(got.len(), wanted.len());
            got.iter().zip(wanted).for_each(|([held, after], w)| {
                assert!((held - w).abs() < 1e-6 && *after == 1.0, "{got:?} {wanted:?}");
            });
        };
        near(&values(&twin(plane), &["x_m", "fx_N", "fy_N"], None), &[1.0, 2.2, 2.6]);
        near(&values(&twin(quarter), &["q_m", "f_N"], None), &[1.0, 3.0]);
        // 2 N m more at a radius of 0.2 m are 10 N more along the tangent, which is -x at a quarter of a turn.
        let path =
            MechanismPath::Revolute { center_m: [0.0; 3], axis: [0.0, 0.0, 1.0], radius_m: 0.2, zero: [1.0, 0.0, 0.0] };
        near(&values(&twin(quarter), &["x_m", "fx_N", "fy_N"], Some(path)), &[1.0, -9.0, 1.0]);
    }

    #[test]
    fn sharpened_values_have_the_means_of_the_rows() {
        let wanted = [1.0, -2.0, 0.5, 3.0, 3.0, -1.0];
        let values = sharpened(&wanted);
        let at = |i: usize, by: isize| values[i.saturating_add_signed(by).min(values.len() - 1)];
        let means: Vec<f64> = (0..wanted.len()).map(|i| 0.125 * (at(i, -1) + at(i, 1)) + 0.75 * values[i]).collect();
        assert!(means.iter().zip(wanted).all(|(m, w)| (m - w).abs() < 1e-12), "{means:?}");
        assert!(sharpened(&[]).is_empty() && (sharpened(&[2.0])[0] - 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_displacement_in_a_stick_phase_changes_no_force() {
        assert_eq!(values(&twin(Force::None), &["fx_N"], None), [[1.0, 1.0]]);
    }

    #[test]
    fn a_finger_of_two_has_a_force_of_its_own() {
        let names = ["x1_m", "x2_m", "fx1_N", "fy1_N", "fx2_N", "fy2_N"];
        let of = |force| values(&twin(force), &names, None).iter().skip(2).map(|v| v[0]).collect::<Vec<f64>>();
        let near = |got: Vec<f64>, wanted: [f64; 4]| {
            assert!(got.iter().zip(wanted).all(|(g, w)| (g - w).abs() < 1e-6), "{got:?} {wanted:?}");
        };
        near(of(Force::Finger(1, Vec2::y())), [1.0, 1.0, 1.0, 3.0]);
        near(of(Force::Plane(Vec2::y())), [1.0, 2.0, 1.0, 2.0]);
    }
}
