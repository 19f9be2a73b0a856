//! Samples of a held handle, from which its path is estimated.

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
    /// True if the positions are already without the give of the pads along the line of the grip.
    pub grip_is_corrected: bool,
}

impl Path {
    /// Axes (x, y) along which the give of two pads is estimated from the path.
    pub fn pad_axes(&self) -> &'static [usize] {
        match (self.two_fingered, self.grip_is_corrected) {
            (false, _) => &[],
            (true, true) => &[1],
            (true, false) => &[0, 1],
        }
    }

    pub fn span_s(&self) -> f64 {
        let ends = self.points.first().zip(self.points.last());
        ends.map_or(0.0, |(first, last)| last.time_s - first.time_s)
    }
}
