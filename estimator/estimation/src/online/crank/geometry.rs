//! Circle of the grip, row by row: Kåsa's algebraic circle first, then the radius residual with the give of the pads,
//! linearised at a centre that moves along as long as it is badly known.

use super::super::change::{Change, ChangeDetector};
use super::super::recursive::Recursive;
use super::super::settings::Settings;
use crate::identify::crank::frame::Handled;
use foundation::estimate::Parameter;
use haptics::Vec2;

/// Rows are so far apart, s: half a derivative's window.
const ROW_S: f64 = 0.016;
/// Relative error of its centre, as a share of the radius, below which the algebraic circle is believed.
const KNOWN: f64 = 0.05;
/// Relative motion of the centre after which the circle is linearised again.
const MOVED: f64 = 0.004;
/// Rows a block of scores.
const BLOCK: u32 = 16;
/// Least jump of each parameter that is a slip of the grasp, m for the centre; radius and give do not jump.
const MATTERS: [f64; 5] = [f64::INFINITY, 2e-4, 2e-4, f64::INFINITY, f64::INFINITY];
/// Sensible radii, m.
const RADII_M: std::ops::Range<f64> = 1e-3..1.0;

/// Centre, radius and give while it is turned.
#[derive(Clone, Debug)]
pub struct Circle {
    every: usize,
    count: usize,
    /// Coordinates count from here.
    origin: Option<Vec2>,
    kasa: Recursive<3>,
    /// R, centre x and y, give x and y.
    fit: Recursive<5>,
    anchor: Option<Vec2>,
    change: ChangeDetector<5>,
    /// Largest and mean size of the force, N.
    force_n: f64,
    force_rows: u64,
}

impl Circle {
    pub(super) fn new(settings: &Settings, period_s: f64) -> Self {
        let every = (ROW_S / period_s).round().max(1.0) as usize;
        let row_s = every as f64 * period_s;
        let memory = settings.memory_s / row_s;
        Self {
            every,
            count: 0,
            origin: None,
            kasa: Recursive::new([0.02, 0.02, 1.0], memory, BLOCK),
            fit: Recursive::new([1.0, 0.5, 0.5, 0.5, 0.5], memory, BLOCK),
            anchor: None,
            change: ChangeDetector::new(settings.false_alarms_per_hour, row_s, MATTERS),
            force_n: 0.0,
            force_rows: 0,
        }
    }

    /// Takes in a sample that turns; says when the centre jumped.
    pub(super) fn push(&mut self, time_s: f64, handled: &Handled) -> Option<Change> {
        self.count += 1;
        if !self.count.is_multiple_of(self.every) {
            return None;
        }
        let origin = *self.origin.get_or_insert(handled.position);
        let p = handled.position - origin;
        self.force_rows += 1;
        self.force_n += (handled.force.norm() - self.force_n) / self.force_rows as f64;
        let Some(anchor) = self.anchor else {
            self.begin(p);
            return None;
        };
        let arm = p - anchor;
        let n = arm.normalize();
        let row = [1.0, n.x, n.y, n.x * handled.force.x, n.y * handled.force.y];
        // |p − a| + n·a = R + n·c + give: absolute, so that the anchor may move.
        let innovation = self.fit.push(&row, arm.norm() + n.dot(&anchor), 1.0)?;
        let [radius, x, y, ..] = self.fit.values();
        if (Vec2::new(x, y) - anchor).norm() > MOVED * radius.abs() && self.fit.rows() > 40 {
            self.restart(Vec2::new(x, y), time_s);
            return None;
        }
        let change = self.change.push(time_s, &row, innovation.residual, innovation.leverage)?;
        self.restart(anchor, time_s);
        Some(change)
    }

    fn begin(&mut self, p: Vec2) {
        self.kasa.push(&[2.0 * p.x, 2.0 * p.y, 1.0], p.norm_squared(), 1.0);
        let [x, y, rest] = self.kasa.values();
        let errors = self.kasa.std_errors();
        let radius = (rest + x * x + y * y).max(0.0).sqrt();
        if RADII_M.contains(&radius) && errors[0].max(errors[1]) < KNOWN * radius {
            self.anchor = Some(Vec2::new(x, y));
        }
    }

    fn restart(&mut self, anchor: Vec2, time_s: f64) {
        self.anchor = Some(anchor);
        self.fit.reset();
        self.change.restart(time_s);
    }

    /// Centre, radius, give, and their standard errors (R, x, y, give x, give y), once they are known well enough to split forces by.
    pub(crate) fn frame(&self) -> Option<(Vec2, f64, Vec2, [f64; 5])> {
        const USABLE: f64 = 0.01;
        let errors = self.fit.std_errors();
        let [radius, x, y, gx, gy] = self.fit.values();
        let known = errors.iter().all(|e| e.is_finite()) && errors[..3].iter().all(|e| *e < USABLE * radius);
        let origin = self.origin?;
        known.then(|| (origin + Vec2::new(x, y), radius, Vec2::new(gx, gy), errors))
    }

    /// The recursion behind it.
    pub(crate) fn fit(&self) -> &Recursive<5> {
        &self.fit
    }

    /// Mean size of the force on the handle, N.
    pub(crate) fn usual_force_n(&self) -> f64 {
        self.force_n
    }

    /// Rows a second while it turns.
    pub(crate) fn rows_per_s() -> f64 {
        1.0 / ROW_S
    }

    pub(super) fn parameters(&self) -> Vec<Parameter> {
        let samples = self.fit.rows() as usize;
        let errors = self.fit.std_errors();
        let [radius, x, y, ..] = self.fit.values();
        let origin = self.origin.unwrap_or_else(Vec2::zeros);
        let how = "circle through the handle's positions, the give of the pads taken out";
        let why = "too little of a turn was seen for the circle; turn it all the way round";
        let known = |error: f64| self.anchor.is_some() && error < KNOWN * radius;
        [
            ("radius_m", radius, errors[0]),
            ("center_x_m", origin.x + x, errors[1]),
            ("center_y_m", origin.y + y, errors[2]),
        ]
        .into_iter()
        .map(|(name, value, error)| {
            if known(error) {
                Parameter::identified("crank", name, value, error, samples, how)
            } else {
                Parameter::unidentified("crank", name, samples, why)
            }
        })
        .collect()
    }
}
