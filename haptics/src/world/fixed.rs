//! Fixed objects that are solid for fingertips: the wall of the cup under the membrane, and the base of the switch.

use super::fixture::{Membrane, Switch};
use super::rect::{Rect, point_in_rect};
use crate::Vec2;

/// Flare of the cup's wall: its half width on the table over that of the sheet, as paper cups have it.
pub const CUP_FLARE: f64 = 1.13;

/// Half the width and half the height of the switch's base, in shares of the lever's length.
pub const SWITCH_BASE_HALF: [f64; 2] = [0.62, 0.13];

/// Place of a fingertip on a fixed surface, or near enough to touch it within the tick.
pub(super) struct Fixed {
    /// Face of the surface.
    pub feature: u8,
    /// Out of the surface.
    pub normal: Vec2,
    /// Compression, m; negative: how far off.
    pub depth_m: f64,
}

/// The cup's wall, from outside only: it leans from the rim of the sheet out to the table at `floor_m`. `kept` is the
/// side that the finger pressed on in the tick before; a finger deeper inside than `arrival_m` without that came
/// another way.
pub(super) fn cup_wall(
    membrane: &Membrane,
    floor_m: f64,
    tip: Vec2,
    kept: Option<u8>,
    (margin_m, arrival_m): (f64, f64),
) -> Option<Fixed> {
    let height_m = membrane.center_m.y - floor_m;
    let above_floor_m = tip.y - floor_m;
    if height_m <= 0.0 || above_floor_m > height_m || above_floor_m < -margin_m {
        return None;
    }
    let from_middle = tip.x - membrane.center_m.x;
    let side = kept.map_or(from_middle.signum(), |feature| if feature == 0 { 1.0 } else { -1.0 });
    let lean = (CUP_FLARE - 1.0) * membrane.half_width_m / height_m;
    let normal = Vec2::new(side, lean) / (1.0 + lean * lean).sqrt();
    let depth_m = -normal.dot(&(tip - membrane.center_m - Vec2::new(side * membrane.half_width_m, 0.0)));
    let near = depth_m > -margin_m && (kept.is_some() || depth_m < arrival_m);
    near.then(|| Fixed { feature: u8::from(side < 0.0), normal, depth_m })
}

/// The base of the switch: a box on the table below the lever's axis, upright.
pub(super) fn switch_base(switch: &Switch, tip: Vec2, kept: Option<u8>, margin_m: f64) -> Option<Fixed> {
    let half_m = Vec2::from(SWITCH_BASE_HALF) * switch.lever_m;
    let rect = Rect { center_m: switch.pivot_m + Vec2::new(0.0, half_m.y), half_m, axis_x: Vec2::new(1.0, 0.0) };
    let (feature, depth_m) = point_in_rect(&rect, tip, kept, margin_m)?;
    Some(Fixed { feature, normal: rect.face(feature).0, depth_m })
}
