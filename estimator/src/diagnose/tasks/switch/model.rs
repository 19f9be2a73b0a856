//! Switch of a world as the model of a recording: position of the knob under a fingertip, and its predicted force.

use super::rows::{Row, direction};
use crate::diagnose::data::limits::ASSUMED_ERROR;
use estimation::identify::switch::OBJECT;
use haptics::Vec2;
use haptics::law::contact::Cushion;
use haptics::law::object::ToggleCurve;
use haptics::world::{Source, Switch, World};

/// Uncertainty of a world's stop that states none, and least uncertainty of one, as a share of the travel: a tip meets a
/// round knob.
/// Choice: halved or doubled, none of 12 answers changes.
const UNKNOWN_END: f64 = 0.0125;
/// Distance from a corner of the curve within which both of its lines count, as a share of the travel.
/// Choice: halved, 9 of 21 answers change; doubled, 17 of 19 answers change (2 to wrong).
const CORNER: f64 = 0.05;
/// Halvings of the search for the knob's position.
/// Derived: 40 halvings of 2.8 levers leave 3e-12 levers, far below the noise of any position.
const KNOB_HALVINGS: usize = 40;

/// Force of a curve along the travel of a side, N, and its derivative by the position on the arc, N/m.
pub fn asked_n(curve: &ToggleCurve, at_m: f64, side: usize) -> (f64, f64) {
    let branch = if side == 0 { 1.0 } else { 0.0 };
    let sign = direction(side);
    (sign * curve.force_n(at_m, branch), sign * curve.stiffness_n_m(at_m, branch, sign))
}

/// Half of the travel of a curve, m.
fn half_way_m(curve: &ToggleCurve) -> f64 {
    match (curve.points.first(), curve.points.last()) {
        (Some(first), Some(last)) => 0.5 * (last.at_m - first.at_m),
        _ => 1.0,
    }
}

/// The switch of a world, and its uncertainty.
pub struct Known<'a> {
    pub switch: &'a Switch,
    pub pad: Cushion,
    gravity_m_s2: f64,
    /// Standard errors of its forces, N, of its stops, m, and of the compliance at the stops, m/N.
    pub error_n: f64,
    pub end_error_m: f64,
    pub give_error_m_n: f64,
    /// Damping of the knob, N s/m, if it is more than an assumption.
    pub damping_n_s_m: f64,
}

impl<'a> Known<'a> {
    /// `None` for a world without a switch.
    pub fn of(world: &'a World) -> Option<Self> {
        let switch = world.switch.as_ref()?;
        let stated = |object: &str, name: &str| {
            let found = world.provenance.iter().find(|p| p.object == object && p.name == name)?;
            found.std_error
        };
        let curve = |name: &str| stated(OBJECT, name);
        let most_n = switch.curve.points.iter().map(|p| p.forward_n.abs().max(p.backward_n.abs())).fold(0.0, f64::max);
        let of_side = |prefix: &str| {
            let value = |name: &str| curve(&format!("{prefix}{name}"));
            let rise = world.provenance.iter().find(|p| p.object == OBJECT && p.name == format!("{prefix}rise_N_m"))?;
            Some(value("peak_force_N")?.hypot(value("snap_position_m")? * rise.value))
        };
        let sides: Vec<f64> = ["", "return_"].iter().filter_map(|prefix| of_side(prefix)).collect();
        let error_n = sides.iter().copied().fold(f64::NAN, f64::max);
        let ends = ["left_end_position_m", "right_end_position_m"].iter().filter_map(|name| curve(name));
        let give = |k: f64, share: f64| share / k.max(f64::MIN_POSITIVE);
        let pad = world.pad.stiffness_n_m;
        let assumed = world.provenance.iter().any(|p| p.name == "damping_N_s_m" && p.source == Source::Assumed);
        Some(Self {
            switch,
            pad: world.pad.elastic(),
            gravity_m_s2: world.gravity_m_s2,
            error_n: if error_n.is_nan() { ASSUMED_ERROR * most_n } else { error_n },
            end_error_m: ends.fold(UNKNOWN_END * 2.0 * half_way_m(&switch.curve), f64::max),
            give_error_m_n: give(
                pad,
                stated("pad", "stiffness_N_m").map_or(ASSUMED_ERROR, |e| e / pad.max(f64::MIN_POSITIVE)),
            ),
            damping_n_s_m: if assumed { 0.0 } else { switch.damping_n_s_m },
        })
    }

    /// Position of the knob under a pressing tip, m along its arc.
    pub fn at_m(&self, row: &Row, side: usize) -> f64 {
        let sign = direction(side);
        let pressed = (sign * row.above_zero.x).max(0.0);
        let reach = self.switch.knob_radius_m - self.pad.depth_m(pressed);
        let ahead = |at: f64| {
            let knob = self.switch.knob_in_world(at);
            let beside = (reach * reach - (knob.y - row.tip.y).powi(2)).max(0.0).sqrt();
            sign * (knob.x - row.tip.x) - beside
        };
        let far = 1.4 * self.switch.lever_m;
        let (mut back, mut front) = (-sign * far, sign * far);
        for _ in 0..KNOB_HALVINGS {
            let middle = 0.5 * (back + front);
            if ahead(middle) < 0.0 { back = middle } else { front = middle }
        }
        0.5 * (back + front)
    }

    /// Driving force on the knob along the travel of a side, N: of the finger and of the knob's own weight.
    pub fn driving_n(&self, force: Vec2, at_m: f64, side: usize) -> f64 {
        let outward = (self.switch.knob_in_world(at_m) - self.switch.pivot_m) / self.switch.lever_m;
        let along = Vec2::new(outward.y, -outward.x);
        let weight = Vec2::new(0.0, -self.switch.mass_kg * self.gravity_m_s2);
        direction(side) * (force + weight).dot(&along)
    }

    /// Predicted force of the knob along the travel of a side, N, and its derivative by the position on the arc, N/m.
    pub fn asked_n(&self, at_m: f64, side: usize) -> (f64, f64) {
        asked_n(&self.switch.curve, at_m, side)
    }

    /// Predicted position of a tip that presses the knob against the stop of a side with a force, m along the travel.
    pub fn stopped_m(&self, side: usize, force_n: f64, height_m: f64) -> f64 {
        let sign = direction(side);
        let points = &self.switch.curve.points;
        let end = if side == 0 { points.last() } else { points.first() }.map_or(0.0, |p| p.at_m);
        let (held, _) = self.asked_n(end, side);
        let at = end + sign * (force_n - held).max(0.0) / self.switch.curve.stop_n_m;
        let knob = self.switch.knob_in_world(at);
        let reach = self.switch.knob_radius_m - self.pad.depth_m(force_n.max(0.0));
        sign * knob.x - (reach * reach - (knob.y - height_m).powi(2)).max(0.0).sqrt()
    }

    /// True if a position is near a corner of the curve.
    pub fn bends_near(&self, at_m: f64) -> bool {
        let points = &self.switch.curve.points;
        points.iter().any(|p| (p.at_m - at_m).abs() < CORNER * 2.0 * self.half_way_m())
    }

    /// Half of the knob's travel, m.
    pub fn half_way_m(&self) -> f64 {
        half_way_m(&self.switch.curve)
    }
}
