//! The toggle switch: a housing on the table, a bushing with a slot, a lever with a round knob, and a mark at each end
//! of the throw. The marks are a ring at the left end and a bar at the right one, as on real switches; the mark of its
//! present side is lit.

use super::canvas::{Canvas, HALF_DEPTH_M, Mode, at};
use crate::coordinates::vec2;
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::{SceneView, SolidRef};
use crate::shape::{Solid, Stroke};
use crate::theme::{Color, ColorRole, Theme};
use glam::{Vec2, Vec3};
use haptics::world::Switch;

/// Sizes in shares of the lever's length.
const BASE_HALF: Vec2 = Vec2::new(0.62, 0.13);
const BUSHING: Vec2 = Vec2::new(0.20, 0.045);
const LEVER: [f32; 2] = [0.062, 0.045];
/// Steps of the scale, and how far it is outside of the knob, m.
const STEPS: u16 = 24;
const SCALE_M: f32 = 0.0022;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let Some(switch) = &view.world.switch else { return };
    let at_m = view.state.switch.at_m;
    if canvas.mode == Mode::Real {
        housing(canvas, switch);
        marks(canvas, switch, at_m);
        scale(canvas, switch);
    }
    lever(canvas, switch, at_m, view.options.highlight == Some(SolidRef::Knob));
}

/// Both ends of the throw, m along the arc.
fn ends(switch: &Switch) -> [f64; 2] {
    let points = &switch.curve.points;
    [points.first(), points.last()].map(|point| point.map_or(switch.start_m, |p| p.at_m))
}

/// Top of the housing above the axis.
fn top(switch: &Switch) -> f32 {
    2.0 * BASE_HALF.y * switch.lever_m as f32
}

fn housing(canvas: &mut Canvas<'_>, switch: &Switch) {
    let (pivot, size) = (vec2(switch.pivot_m), switch.lever_m as f32);
    let (frame, steel, dark) = (canvas.palette.frame, canvas.palette.steel, canvas.palette.coupler);
    let half = (BASE_HALF * size).extend(HALF_DEPTH_M);
    let center = at(pivot + Vec2::Y * half.y, 0.0);
    canvas.solid(MeshKind::Box, Solid::rounded_box(center, half, 0.0, 0.0014, frame).gloss(0.35));
    let mut drum = |radius: f32, low: f32, high: f32, color, gloss: f32| {
        let center = at(pivot + Vec2::Y * (top(switch) + 0.5 * (low + high)), 0.0);
        let drum = Solid::drum(center, Vec2::splat(radius), 0.5 * (high - low), 0.0, color);
        canvas.solid(MeshKind::Disc, drum.gloss(gloss));
    };
    let bushing = BUSHING * size;
    drum(1.35 * bushing.x, 0.0, 0.5 * bushing.y, dark, 0.4);
    drum(bushing.x, 0.0, bushing.y, steel, 0.7);
    // The slot: as long as the lever needs at this height, at both ends of its throw.
    let height = top(switch) + bushing.y;
    let swing = ends(switch).map(|end| height * (end / switch.lever_m).tan() as f32);
    let reach = LEVER[0] * size + 0.0002;
    let slot = [swing[0] - reach, swing[1] + reach];
    let black = frame.mix(Color::rgb8(0, 0, 0), 0.6);
    let half = 0.5 * (slot[1] - slot[0]).min(1.8 * bushing.x) - reach;
    let middle = pivot + Vec2::new(0.5 * (slot[0] + slot[1]), height);
    let floor = Solid::rounded_box(at(middle, 0.0), Vec3::new(half.max(0.0), 0.00006, reach), 0.0, 0.0, black);
    canvas.solid(MeshKind::Box, floor.gloss(0.0));
    for end in [-half.max(0.0), half.max(0.0)] {
        let round = Solid::drum(at(middle + Vec2::X * end, 0.0), Vec2::splat(reach), 0.00006, 0.0, black);
        canvas.solid(MeshKind::Plate, round.gloss(0.0));
    }
}

/// A ring and a bar on the front of the housing.
fn marks(canvas: &mut Canvas<'_>, switch: &Switch, at_m: f64) {
    let (pivot, size) = (vec2(switch.pivot_m), switch.lever_m as f32);
    let [left, right] = ends(switch);
    let share = ((at_m - left) / (right - left).max(1e-9)).clamp(0.0, 1.0) as f32;
    // The housing is dark in both themes.
    let lit = Theme::Dark.color(ColorRole::Constraint);
    let (quiet, frame) = (canvas.palette.link_secondary, canvas.palette.frame);
    let radius = 0.62 * BASE_HALF.y * size;
    let z = |raised: f32| [HALF_DEPTH_M - 0.0005, HALF_DEPTH_M + raised];
    for side in [-1.0_f32, 1.0] {
        let middle = pivot + Vec2::new(0.68 * side * BASE_HALF.x, BASE_HALF.y) * size;
        let on = if side < 0.0 { 1.0 - share } else { share };
        // Half way neither is on.
        let on = (2.0 * on - 1.0).clamp(0.0, 1.0);
        let color = quiet.mix(lit, on);
        let unlit = 0.2 + 0.7 * on;
        if side < 0.0 {
            let ring = Solid::disc(middle, radius, z(0.0001), color).gloss(0.1).unlit(unlit);
            canvas.solid(MeshKind::Disc, ring);
            canvas.solid(MeshKind::Disc, Solid::disc(middle, 0.62 * radius, z(0.0002), frame).gloss(0.2));
        } else {
            let reach = Vec2::Y * 0.81 * radius;
            let bar = Solid::bar(middle - reach, middle + reach, 0.21 * radius, z(0.0001), color);
            canvas.solid(MeshKind::Plate, bar.gloss(0.1).unlit(unlit));
        }
    }
}

/// A scale above the knob: the arc of its throw with a tick at each end and in the middle.
fn scale(canvas: &mut Canvas<'_>, switch: &Switch) {
    let color = canvas.palette.grid;
    let [left, right] = ends(switch);
    let pivot = vec2(switch.pivot_m);
    let on_arc = |share: f64, out: f32| {
        let knob = vec2(switch.knob_in_world(left + share * (right - left)));
        let outwards = (knob - pivot).normalize_or(Vec2::Y);
        at(knob + (switch.knob_radius_m as f32 + SCALE_M + out) * outwards, 0.0)
    };
    let share = |i: u16| f64::from(i) / f64::from(STEPS);
    for i in 0..STEPS {
        canvas.stroke(Stroke::line(on_arc(share(i), 0.0), on_arc(share(i + 1), 0.0), 1.4, color));
    }
    for (share, length) in [(0.0, 0.0028), (0.5, 0.0016), (1.0, 0.0028)] {
        canvas.stroke(Stroke::line(on_arc(share, 0.0), on_arc(share, length), 1.8, color));
    }
}

fn lever(canvas: &mut Canvas<'_>, switch: &Switch, at_m: f64, highlighted: bool) {
    let (pivot, knob, size) = (vec2(switch.pivot_m), vec2(switch.knob_in_world(at_m)), switch.lever_m as f32);
    let (color, unlit) = canvas.body_color(ColorRole::Block(0), highlighted);
    let steel = canvas.palette.steel;
    let radius = switch.knob_radius_m as f32;
    let bar = Solid::cone(at(pivot, 0.0), at(knob, 0.0), LEVER.map(|share| share * size), steel);
    canvas.solid(MeshKind::Cone, bar.gloss(0.8).of(Material::Polished));
    let outwards = (knob - pivot).normalize_or(Vec2::Y);
    let collar = knob - outwards * radius;
    let neck = [1.7 * LEVER[1] * size, 1.9 * LEVER[1] * size];
    let neck = Solid::cone(at(collar - 0.0012 * outwards, 0.0), at(collar + 0.0008 * outwards, 0.0), neck, color);
    canvas.solid(MeshKind::Cone, neck.gloss(0.5).unlit(unlit));
    canvas.solid(MeshKind::Ball, Solid::ball(at(knob, 0.0), radius, color).gloss(0.7).unlit(unlit));
}
