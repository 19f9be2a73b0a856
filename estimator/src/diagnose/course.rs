//! What was measured and what the model says, row by row: for plots of a diagnosis.

use super::geometry::{Study, residual};
use super::system::Use;
use super::track::{Place, Track};

/// One instant of a recording along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Which recording, in the order in which they were given.
    pub recording: usize,
    /// Time from the start of that recording, s.
    pub time_s: f64,
    /// Coordinate along the motion, m or rad.
    pub position: f64,
    /// Angle of the arm, rad, where something turns; else the coordinate again.
    pub angle_rad: f64,
    /// Rate of the coordinate, m/s or rad/s.
    pub velocity: f64,
    /// Force across the motion, N, positive outwards; zero where it was not measured.
    pub normal_force_n: f64,
    /// Measured force along the motion, N or N m.
    pub measured: f64,
    /// What the model leaves of it …
    pub left_before: f64,
    /// … and what the model with the found causes leaves.
    pub left_after: f64,
    /// How far the row is trusted, 0 … 1: less where the direction of motion is a guess.
    pub weight: f64,
    /// It took part in no choice and no fit.
    pub is_locked: bool,
    /// It follows the instant before it without a gap.
    pub follows: bool,
}

impl Instant {
    /// Force that the model says, N or N m.
    pub fn simulated_before(&self) -> f64 {
        self.measured - self.left_before
    }

    /// Force that the model with the found causes says, N or N m.
    pub fn simulated_after(&self) -> f64 {
        self.measured - self.left_after
    }
}

/// Everything along the motion, at the rate of the comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Course {
    /// In time order, recording after recording.
    pub instants: Vec<Instant>,
    /// True when something turns about an axis: [`Instant::angle_rad`] is an angle.
    pub turns: bool,
    /// True when the coordinate is an angle: forces are N m, velocities rad/s.
    pub is_angular: bool,
    /// True when the force across the motion was measured.
    pub has_normal_force: bool,
    /// Where the forces come from.
    pub source: Source,
}

/// Where the forces of a course come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// They were measured.
    #[default]
    Sensor,
    /// Nothing but the motion was measured: they are what the laws must give for it.
    Motion,
    /// The same, per unit of inertia.
    MotionPerInertia,
}

impl Course {
    /// Whether nothing but the motion was measured.
    pub fn is_free(&self) -> bool {
        self.source != Source::Sensor
    }

    /// Unit of the forces, as people write it.
    pub fn force_unit(&self) -> &'static str {
        match (self.is_angular, self.source == Source::MotionPerInertia) {
            (true, false) => "N·m",
            (false, false) => "N",
            (true, true) => "rad/s²",
            (false, true) => "m/s²",
        }
    }
}

/// The rows along the motion with what the model leaves of them, without and with what was chosen.
pub(super) fn course(track: &Track, study: &Study) -> Course {
    let of = |picks: &[usize]| {
        let solved = study.system.solve(picks);
        solved.map_or_else(|| study.y.clone(), |s| residual(&study.y, &study.base, &study.candidates, picks, &s))
    };
    let (before, after) = (of(&[]), of(&study.picks()));
    let instants = track.rows.iter().enumerate().filter(|(_, row)| row.place == Place::Along).map(|(i, row)| Instant {
        recording: row.recording,
        time_s: row.motion.time_s,
        position: row.motion.position,
        angle_rad: row.angle_rad,
        velocity: row.motion.velocity,
        normal_force_n: row.motion.normal_force_n,
        // What moves freely needs what its mass needs, and nothing else is measured.
        measured: if track.freely.is_some() { study.y[i] } else { row.y },
        left_before: before[i],
        left_after: after[i],
        weight: study.weight[i],
        is_locked: matches!(study.system.uses[i], Use::Locked(_)),
        follows: track.follows(i),
    });
    Course {
        instants: instants.collect(),
        turns: track.radius_m.is_some(),
        is_angular: track.coordinate == haptics::law::Coordinate::Angular,
        has_normal_force: track.planar,
        source: track
            .freely
            .map_or(Source::Sensor, |free| if free.is_known { Source::Motion } else { Source::MotionPerInertia }),
    }
}
