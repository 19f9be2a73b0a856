//! The membrane: the bottom of an inverted paper cup, cut open in the plane of the needle so that its point can be seen.
//!
//! The sheet dents under the point. Once pierced it springs back, dragged along by the shaft, and the hole stays.

use super::canvas::{Canvas, Mode, angle, at};
use crate::coordinates::vec2;
use crate::material::Material;
use crate::mesh::{MeshKind, SHEET_STATIONS, dent};
use crate::scene::SceneView;
use crate::shape::{Solid, Stroke};
use crate::theme::Color;
use glam::{Vec2, Vec3Swizzles};
use haptics::world::{Hole, Membrane, MembraneState, Shape, State, World};

/// Half the thickness of the paper as drawn, m; its cut face; the height of a cup over no table, m.
const PAPER_M: f32 = 0.00032;
const CUT_Z: [f32; 2] = [-0.0004, 0.00015];
const NO_TABLE_M: f32 = 0.022;
/// Outward lean of the wall: radius at the table over radius at the sheet.
const FLARE: f32 = 1.13;
/// Half the width of a hole, and how far its torn rim hangs down, m.
const HOLE_M: f32 = 0.0009;
const TORN_M: f32 = 0.0011;
/// Steps of the line around the far half of the rim.
const RIM_STEPS: u16 = 24;

/// The sheet as it is now: one dent, and holes.
struct Sheet {
    center: Vec2,
    radius: f32,
    /// Deepest point of the dent, from the middle, m; `depth`: its depth, m, negative if drawn upwards.
    apex: f32,
    depth: f32,
}

impl Sheet {
    /// Height of the sheet at a place along it, in the plane.
    fn point(&self, along: f32) -> Vec2 {
        let rim = if along < self.apex { -self.radius } else { self.radius };
        let share = ((along - self.apex) / (rim - self.apex)).clamp(0.0, 1.0);
        self.center + Vec2::new(along, -self.depth * dent(share))
    }
}

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let Some(membrane) = &view.world.membrane else { return };
    let state = &view.state.membrane;
    let sheet = shape_now(membrane, view.world, view.state);
    let holes: Vec<f32> = touched(state)
        .iter()
        .enumerate()
        .filter(|(_, hole)| hole.history.punctured)
        .map(|(index, hole)| if state.active == Some(index) { sheet.apex } else { hole.along_m as f32 })
        .collect();
    if canvas.mode == Mode::Real {
        back(canvas, &sheet, &holes);
        wall(canvas, &sheet);
    }
    cut(canvas, &sheet, &holes);
}

fn touched(state: &MembraneState) -> &[Hole] {
    &state.holes[..state.touched.min(state.holes.len())]
}

/// The dent under the needle; else the deepest that is left.
fn shape_now(membrane: &Membrane, world: &World, state: &State) -> Sheet {
    let law = &membrane.law;
    let sheet = &state.membrane;
    let left = |hole: &Hole| if hole.history.punctured { 0.0 } else { law.give * hole.history.deepest_m };
    let active = sheet.active.and_then(|index| touched(sheet).get(index));
    let (along, depth) = if let Some(hole) = active {
        let depth = if hole.history.punctured {
            // The rim hangs on the shaft by friction: down on the way in, up on the way out.
            let most = 1.5 * law.friction_n / law.stiffness_n_m;
            (sheet.force_n / law.stiffness_n_m).max(-most).min(most)
        } else {
            sheet.insertion_m.max(left(hole))
        };
        (point_along(membrane, world, state).unwrap_or(hole.along_m), depth)
    } else {
        let deepest = touched(sheet).iter().max_by(|a, b| left(a).total_cmp(&left(b)));
        deepest.map_or((0.0, 0.0), |hole| (hole.along_m, left(hole)))
    };
    let radius = (membrane.half_width_m as f32).max(1e-4);
    let apex = (along as f32).clamp(-0.97 * radius, 0.97 * radius);
    Sheet { center: vec2(membrane.center_m), radius, apex, depth: (depth as f32).clamp(-radius, 2.0 * radius) }
}

/// Position along the sheet of the needle's point, m from the middle: that of the lowest needle.
fn point_along(membrane: &Membrane, world: &World, state: &State) -> Option<f64> {
    let needles = world.blocks.iter().zip(&state.bodies).filter(|(block, _)| block.shape == Shape::Needle);
    let lowest = needles
        .min_by(|(a, p), (b, q)| (p.center_m.y - 0.5 * a.height_m).total_cmp(&(q.center_m.y - 0.5 * b.height_m)));
    lowest.map(|(_, body)| body.center_m.x - membrane.center_m.x)
}

/// The far half of the sheet, and the dark of its holes.
fn back(canvas: &mut Canvas<'_>, sheet: &Sheet, holes: &[f32]) {
    let (paper, dark) = (canvas.palette.paper, canvas.palette.frame.mix(Color::rgb8(0, 0, 0), 0.35));
    let center = at(sheet.center, 0.0);
    canvas.solid(
        MeshKind::Sheet,
        Solid::sheet(center, sheet.radius, sheet.apex, sheet.depth, paper).gloss(0.05).of(Material::Paper),
    );
    for along in holes {
        let place = at(sheet.point(*along) + Vec2::Y * 0.00005, 0.0);
        canvas.solid(MeshKind::Sheet, Solid::sheet(place, HOLE_M, 0.0, 0.0, dark).gloss(0.0).unlit(0.5));
    }
    let rim = |i: u16| center + sheet.radius * angle(0.5 + 0.5 * f32::from(i) / f32::from(RIM_STEPS)).extend(0.0).xzy();
    for i in 0..RIM_STEPS {
        canvas.stroke(Stroke::line(rim(i), rim(i + 1), 1.4, canvas.palette.paper_cut));
    }
}

/// Heights of the wall's lower and upper end, if there is room for one.
fn wall_heights(canvas: &Canvas<'_>, sheet: &Sheet) -> Option<[f32; 2]> {
    let bottom = canvas.table_top_m.unwrap_or(sheet.center.y - NO_TABLE_M);
    (bottom < sheet.center.y).then_some([bottom, sheet.center.y])
}

/// The far half of the wall, seen from inside: in the shade of the sheet.
fn wall(canvas: &mut Canvas<'_>, sheet: &Sheet) {
    let Some(y) = wall_heights(canvas, sheet) else { return };
    let shade = canvas.palette.paper.mix(canvas.palette.frame, 0.30);
    let radii = [FLARE * sheet.radius, sheet.radius];
    canvas.solid(MeshKind::Shell, Solid::shell(sheet.center.x, radii, y, shade).gloss(0.05).of(Material::Paper));
}

/// The cut through the paper: wall, sheet with its dent, gaps with torn rims at the holes.
fn cut(canvas: &mut Canvas<'_>, sheet: &Sheet, holes: &[f32]) {
    let color = canvas.palette.paper_cut;
    let heights = wall_heights(canvas, sheet);
    let mut line = |a: Vec2, b: Vec2, radius: f32| {
        canvas.solid(MeshKind::Plate, Solid::bar(a, b, radius, CUT_Z, color).gloss(0.1).unlit(0.2));
    };
    for side in [-1.0, 1.0] {
        if let Some([bottom, top]) = heights {
            let foot = Vec2::new(sheet.center.x + side * FLARE * sheet.radius, bottom + 2.4 * PAPER_M);
            line(foot, Vec2::new(sheet.center.x + side * sheet.radius, top), PAPER_M);
            // The rolled rim of the cup.
            line(foot, foot, 2.4 * PAPER_M);
        }
    }
    for pair in stations(sheet, holes).windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        if holes.iter().all(|hole| (middle - hole).abs() > HOLE_M) {
            line(sheet.point(pair[0]), sheet.point(pair[1]), PAPER_M);
        }
    }
    let down = if sheet.depth < -0.0001 { 1.0 } else { -1.0 };
    for hole in holes {
        for side in [-1.0, 1.0] {
            let rim = sheet.point(hole + side * HOLE_M);
            line(rim, rim + Vec2::new(-0.35 * side * HOLE_M, down * TORN_M), 0.8 * PAPER_M);
        }
    }
}

/// Places along the sheet where the cut has a corner, from left to right.
fn stations(sheet: &Sheet, holes: &[f32]) -> Vec<f32> {
    let sides = [-sheet.radius, sheet.radius];
    let grid = sides.into_iter().flat_map(|rim| SHEET_STATIONS.map(|share| sheet.apex + share * (rim - sheet.apex)));
    let edges = holes.iter().flat_map(|hole| [hole - HOLE_M, hole + HOLE_M]);
    let within = |x: &f32| x.abs() <= 1.001 * sheet.radius;
    let mut places: Vec<f32> = grid.chain(edges).filter(within).collect();
    places.sort_by(f32::total_cmp);
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cut_passes_through_the_point_and_ends_level() {
        let sheet = Sheet { center: Vec2::new(0.01, 0.02), radius: 0.018, apex: 0.004, depth: 0.003 };
        assert!(sheet.point(0.004).distance(Vec2::new(0.014, 0.017)) < 1e-6);
        for rim in [-0.018, 0.018] {
            assert!((sheet.point(rim).y - 0.02).abs() < 1e-6);
        }
        let places = stations(&sheet, &[-0.006]);
        assert!(places.is_sorted() && places.contains(&(-0.006 - HOLE_M)));
    }
}
