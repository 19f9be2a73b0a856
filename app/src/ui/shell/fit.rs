//! A window that is smaller than its panels need shows everything smaller: without room, a plot would draw no curve.

use egui::{Context, Id, Vec2};

/// Size in which all panels can be used, points.
const ROOM: Vec2 = Vec2::new(1120.0, 680.0);
/// Smallest size of everything, as a share of the usual one.
/// Derived: text of 13 points is then 8 pixels high.
const SMALLEST: f32 = 0.6;
/// Smallest size of the window, points of the usual size.
pub const LEAST: Vec2 = Vec2::new(ROOM.x * SMALLEST, ROOM.y * SMALLEST);

/// Share of the usual size in which the panels fit into a window.
fn share(window: Vec2) -> f32 {
    (window / ROOM).min_elem().clamp(SMALLEST, 1.0)
}

/// The share that is in force; it is kept beside egui's own zoom, which contains it.
pub fn applied(ctx: &Context) -> f32 {
    let kept = ctx.data_mut(|data| data.get_persisted::<f32>(id()));
    kept.filter(|share| (SMALLEST..=1.0).contains(share)).unwrap_or(1.0)
}

/// Follows the size of the window. The zoom that the user chose stays as a factor.
pub fn follow(ctx: &Context) {
    let before = applied(ctx);
    let now = share(ctx.content_rect().size() * ctx.zoom_factor());
    if (now - before).abs() > 1e-3 {
        ctx.set_zoom_factor(ctx.zoom_factor() * now / before);
        ctx.data_mut(|data| data.insert_persisted(id(), now));
    }
}

fn id() -> Id {
    Id::unique("fit to the window")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Zoom after some frames of a window of this size, points of the usual size.
    fn zoom(ctx: &Context, window: [f32; 2]) -> f32 {
        for _ in 0..3 {
            let size = Vec2::from(window) / ctx.zoom_factor();
            let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
            let input = egui::RawInput { screen_rect: Some(screen), ..Default::default() };
            ctx.run_ui(input, |ui| follow(ui.ctx())).textures_delta.clear();
        }
        ctx.zoom_factor()
    }

    #[test]
    fn a_small_window_shows_everything_smaller_and_a_large_one_as_usual() {
        let ctx = Context::default();
        assert_eq!(zoom(&ctx, [1480.0, 920.0]), 1.0);
        assert!((zoom(&ctx, [800.0, 600.0]) - 800.0 / 1120.0).abs() < 1e-4);
        assert!((zoom(&ctx, [300.0, 200.0]) - SMALLEST).abs() < 1e-4);
        assert!((zoom(&ctx, [1480.0, 920.0]) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn the_zoom_of_the_user_stays_as_a_factor() {
        let ctx = Context::default();
        zoom(&ctx, [1120.0, 680.0]);
        ctx.set_zoom_factor(1.5);
        assert!((zoom(&ctx, [1120.0, 680.0]) - 1.5).abs() < 1e-4);
        assert!((zoom(&ctx, [840.0, 680.0]) - 1.5 * 0.75).abs() < 1e-4);
        assert!((zoom(&ctx, [1120.0, 680.0]) - 1.5).abs() < 1e-4);
    }
}
