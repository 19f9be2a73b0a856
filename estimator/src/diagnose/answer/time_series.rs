//! Measured and modelled values row by row, for the plots of a diagnosis.

use crate::diagnose::data::regression_data::{Place, Track};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::layout::Use;

/// One instant of the course along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Index of the recording, in the order in which they were given.
    pub recording: usize,
    /// Time from the start of that recording, s.
    pub time_s: f64,
    /// Coordinate along the motion, m or rad.
    pub position: f64,
    /// Angle of the arm, rad, where something turns; else the coordinate again.
    pub angle_rad: f64,
    /// Rate of the coordinate, m/s or rad/s.
    pub velocity: f64,
    /// Force across the motion, N, positive outwards; zero if it was not measured.
    pub normal_force_n: f64,
    /// Measured force along the motion, N or N m.
    pub measured: f64,
    /// Residual of the base model.
    pub left_before: f64,
    /// Residual of the extended model.
    pub left_after: f64,
    /// Weight of the row, 0 … 1: less if the direction of motion is uncertain.
    pub weight: f64,
    /// True if it took part in neither choice nor fit.
    pub is_locked: bool,
    /// True if it follows the instant before it without a gap.
    pub follows: bool,
}

impl Instant {
    /// Force predicted by the base model, N or N m.
    pub fn simulated_before(&self) -> f64 {
        self.measured - self.left_before
    }

    /// Force predicted by the extended model, N or N m.
    pub fn simulated_after(&self) -> f64 {
        self.measured - self.left_after
    }
}

/// Course of all quantities along the motion, at the rate of the comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Course {
    /// In time order, recording after recording.
    pub instants: Vec<Instant>,
    /// True if the object rotates about an axis: [`Instant::angle_rad`] is an angle.
    pub turns: bool,
    /// True if the coordinate is an angle: forces are N m, velocities rad/s.
    pub is_angular: bool,
    /// True if the force across the motion was measured.
    pub has_normal_force: bool,
    /// Source of the forces.
    pub source: Source,
}

/// Source of the forces of a course.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// Measured forces.
    #[default]
    Sensor,
    /// Only the motion was measured: the forces are those that the laws must sum to.
    Motion,
    /// The same per unit of inertia.
    MotionPerInertia,
}

impl Course {
    /// True if only the motion was measured.
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

/// The rows along the motion with their residuals, without and with the chosen causes.
pub(crate) fn course(track: &Track, study: &ChannelFit) -> Course {
    let (before, after) = (study.residual(&[]), study.residual(&study.picks()));
    let instants = track.rows.iter().enumerate().filter(|(_, row)| row.place == Place::Along).map(|(i, row)| Instant {
        recording: row.recording,
        time_s: row.motion.time_s,
        position: row.motion.position,
        angle_rad: row.angle_rad,
        velocity: row.motion.velocity,
        normal_force_n: row.motion.normal_force_n,
        // A free motion has no measured force: the target is the force that its inertia needs.
        measured: if track.freely.is_some() { study.target[i] } else { row.target },
        left_before: before[i],
        left_after: after[i],
        weight: study.layout.weight[i],
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
