//! Rows of the heights of held blocks that stand on something.

/// One end of a carry.
pub struct Stand {
    pub recording: usize,
    pub number: usize,
    /// True for the end of the carry.
    pub placed: bool,
    /// Numbers of the blocks below.
    pub below: Vec<usize>,
    pub first: usize,
    pub end: usize,
    /// Start of the standing phase, s, and start of the plain means of its height, s.
    pub from_s: f64,
    pub plain_from_s: f64,
    /// Samples of it.
    pub samples: Vec<usize>,
}

/// Samples of all stands.
#[derive(Default)]
pub struct Rows {
    pub stand: Vec<usize>,
    pub time_s: Vec<f64>,
    pub height_m: Vec<f64>,
    pub lift_n: Vec<f64>,
    /// Its rate, N/s.
    pub lift_rate: Vec<f64>,
    /// Largest shear over normal force of a finger.
    pub ratio: Vec<f64>,
    /// Half of the averaging window of the heights, s.
    pub half_s: f64,
    /// Size of the largest object, m.
    pub object_m: f64,
}
