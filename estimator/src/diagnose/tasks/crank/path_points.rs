//! Samples of a held handle, from which its path is estimated.

use crate::diagnose::hypotheses::sensor_fault::SensorFault;
use haptics::Vec2;

/// One held sample.
pub struct PathPoint {
    /// Row of the signals.
    pub index: usize,
    pub stretch: usize,
    pub time_s: f64,
    pub position: Vec2,
    pub force: Vec2,
    /// ∂position/∂(top joint angle) and ∂position/∂(length of the first link) of each finger, where joints were
    /// recorded.
    pub joints: [Option<[Vec2; 2]>; 2],
    /// Inward offset of a mean of points on an arc, times the radius, m².
    pub inside_m2: f64,
}

/// Data from which the geometry is estimated.
pub struct Path {
    pub points: Vec<PathPoint>,
    pub period_s: f64,
    /// True if two pads hold the handle: their compliance belongs to the model.
    pub two_fingered: bool,
    /// Compliance of a pad along the line of the grip, m/N, whose give is already taken off the positions.
    pub grip_m_n: Option<f64>,
}

impl Path {
    /// Axes (x, y) along which the give of two pads is estimated from the path.
    pub fn pad_axes(&self) -> &'static [usize] {
        match (self.two_fingered, self.grip_m_n) {
            (false, _) => &[],
            (true, Some(_)) => &[1],
            (true, None) => &[0, 1],
        }
    }

    /// Takes errors of the sensors' zeros off the forces, and off the give of the pads.
    pub fn take_off(&mut self, fault: &SensorFault) {
        for point in &mut self.points {
            let error: Vec2 = (0..2).map(|finger| fault.zero_n(finger, point.time_s, point.time_s)).sum();
            point.force -= error;
            point.position.x += 0.5 * self.grip_m_n.unwrap_or(0.0) * error.x;
        }
    }

    pub fn span_s(&self) -> f64 {
        let ends = self.points.first().zip(self.points.last());
        ends.map_or(0.0, |(first, last)| last.time_s - first.time_s)
    }
}
