//! Replays of recordings without any cause: their own motion, with the forces of the null model.

use super::competition::without_causes;
use super::null_model::NullModel;
use crate::diagnose::data::regression_data::{Place, Track};
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::signal::derive::interpolate;
use foundation::signal::task::is_two_fingered;
use haptics::Vec2;
use haptics::recording::Recording;
use haptics::world::MechanismPath;
use rand::Rng;
use std::ops::Range;

/// Forces that recordings of one coordinate would have without any cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Twin {
    null: NullModel,
    rows: Vec<Placed>,
    /// Segment of each row.
    segment: Vec<usize>,
    /// Causes found in these forces, which a replay lacks.
    removed: Vec<&'static str>,
    /// True if the force was measured as a vector in the plane of the motion.
    is_planar: bool,
}

/// Time and direction of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    recording: usize,
    time_s: f64,
    /// Coordinate, m or rad.
    position: f64,
    /// Unit vector of the force in the plane.
    along: Vec2,
    /// True if the row is a measured force. A displacement in a stick phase is none.
    is_force: bool,
}

impl Twin {
    /// `None` if the rows do not determine the null model, or have no measured force.
    pub fn of(track: &Track, study: &ChannelFit) -> Option<Self> {
        if track.freely.is_some() {
            return None;
        }
        let null = without_causes(study, &study.errors)?;
        let placed = track.rows.iter().map(|row| Placed {
            recording: row.recording,
            time_s: row.motion.time_s,
            position: row.motion.position,
            along: row.along,
            is_force: !matches!(row.place, Place::Stuck { .. }),
        });
        let segment = track.rows.iter().map(|row| row.segment).collect();
        let removed = study.picks().into_iter().map(|p| study.candidates[p].id).collect();
        Some(Self { null, rows: placed.collect(), segment, removed, is_planar: track.planar })
    }

    /// True if a replay lacks this cause of the recording. Faults of samples and causes of the path remain.
    pub fn lacks(&self, id: &str) -> bool {
        self.removed.contains(&id)
    }

    /// The same recordings with other forces. `paths`: of each tool whose coordinate was not recorded.
    pub fn replay(
        &self,
        recordings: &[Recording],
        paths: &[Option<MechanismPath>],
        rng: &mut impl Rng,
    ) -> Vec<Recording> {
        let change = self.null.change(rng);
        let mut replayed = recordings.to_vec();
        let mut first = 0;
        for rows in self.segment.chunk_by(|a, b| a == b) {
            let range = first..first + rows.len();
            first = range.end;
            let own = self.rows[range.start];
            if own.is_force {
                self.apply(&mut replayed[own.recording], paths[own.recording].as_ref(), range.clone(), &change[range]);
            }
        }
        replayed
    }

    /// Adds the change of one segment to the force channels of its recording.
    fn apply(&self, recording: &mut Recording, path: Option<&MechanismPath>, rows: Range<usize>, change: &[f64]) {
        let Some(time_s) = recording.time_s.clone() else { return };
        let rows = &self.rows[rows];
        let times: Vec<f64> = rows.iter().map(|row| row.time_s + time_s[0]).collect();
        let (begin, end) = (times[0], times[times.len() - 1]);
        let inside = |t: &f64| (begin..=end).contains(t);
        let (Some(from), Some(to)) = (time_s.iter().position(inside), time_s.iter().rposition(inside)) else { return };
        for (name, axis, share) in channels(recording, path.is_some(), self.is_planar) {
            let Some(channel) = recording.channels.iter_mut().find(|c| c.name == name) else { continue };
            let along: Vec<f64> =
                rows.iter().zip(change).map(|(row, change)| share * change * self.direction(row, path)[axis]).collect();
            let added = interpolate(&times, &along, &time_s[from..=to]);
            channel.values[from..=to].iter_mut().zip(added).for_each(|(value, more)| *value += more);
        }
    }

    /// Vector whose product with a force along the coordinate is the force on the tool, 1 or 1/m.
    fn direction(&self, row: &Placed, path: Option<&MechanismPath>) -> [f64; 3] {
        match path {
            Some(path) => path.force_n(row.position, 1.0),
            None if self.is_planar => [row.along.x, row.along.y, 0.0],
            None => [1.0, 0.0, 0.0],
        }
    }
}

/// Names of the channels that hold the force, the axis of each, and the share that it takes.
fn channels(recording: &Recording, is_tool: bool, is_planar: bool) -> Vec<(&'static str, usize, f64)> {
    if !is_planar && !is_tool {
        return vec![("f_N", 0, 1.0), ("tau_Nm", 0, 1.0)];
    }
    if is_planar && is_two_fingered(recording) {
        return vec![("fx1_N", 0, 0.5), ("fy1_N", 1, 0.5), ("fx2_N", 0, 0.5), ("fy2_N", 1, 0.5)];
    }
    vec![("fx_N", 0, 1.0), ("fy_N", 1, 1.0), ("fz_N", 2, 1.0)]
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
    fn twin(along: Vec2, is_planar: bool) -> Twin {
        let null = NullModel {
            predicted: vec![3.0; ROWS],
            errors: Vec::new(),
            noise: Autoregression::default(),
            weight: vec![1.0; ROWS],
            target: vec![1.0; ROWS],
        };
        let place = |k: usize| Placed {
            recording: 0,
            time_s: 0.1 * k as f64,
            position: 0.5 * std::f64::consts::PI,
            along,
            is_force: true,
        };
        Twin { null, rows: (0..ROWS).map(place).collect(), segment: vec![0; ROWS], removed: Vec::new(), is_planar }
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
        let along = Vec2::new(0.6, 0.8);
        let near = |got: &[[f64; 2]], wanted: &[f64]| {
            assert_eq!(got.len(), wanted.len());
            got.iter().zip(wanted).for_each(|([held, after], w)| {
                assert!((held - w).abs() < 1e-6 && *after == 1.0, "{got:?} {wanted:?}");
            });
        };
        near(&values(&twin(along, true), &["x_m", "fx_N", "fy_N"], None), &[1.0, 2.2, 2.6]);
        near(&values(&twin(along, false), &["q_m", "f_N"], None), &[1.0, 3.0]);
        // 2 N m more at a radius of 0.2 m are 10 N more along the tangent, which is -x at a quarter of a turn.
        let path =
            MechanismPath::Revolute { center_m: [0.0; 3], axis: [0.0, 0.0, 1.0], radius_m: 0.2, zero: [1.0, 0.0, 0.0] };
        near(&values(&twin(along, false), &["x_m", "fx_N", "fy_N"], Some(path)), &[1.0, -9.0, 1.0]);
    }

    #[test]
    fn a_displacement_in_a_stick_phase_changes_no_force() {
        let mut twin = twin(Vec2::x(), true);
        twin.rows.iter_mut().for_each(|row| row.is_force = false);
        assert_eq!(values(&twin, &["fx_N"], None), [[1.0, 1.0]]);
    }
}
